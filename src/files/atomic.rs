//! Files that are complete or absent.

use super::open::complaint;
use crate::{Error, Result};
use std::fs;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A file under a temporary name beside its destination; dropped unfinished, it is removed.
#[derive(Debug)]
pub(super) struct Temporary {
    /// As the caller wrote it, for messages.
    path: PathBuf,
    /// Where it goes: `path`, or what `path` links to.
    destination: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl Temporary {
    /// Begins a file that will replace `path`.
    ///
    /// A destination that is there but is no regular file is refused: renaming over a device such
    /// as /dev/null would replace the device.
    pub fn create(path: &Path) -> Result<Self> {
        let destination = match fs::metadata(path) {
            Ok(about) if about.is_file() => {
                fs::canonicalize(path).map_err(|e| Error::io(path, e))?
            }
            Ok(about) => {
                let found = if about.is_dir() { "a directory" } else { "a device or a pipe" };
                return Err(Error::file(path, "output", found, "a file or a name not yet used"));
            }
            Err(_) => path.to_owned(),
        };
        let directory = match destination.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".ridgelight-");
        // Temporary files are private by default; a result is as readable as any new file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(directory).map_err(|e| {
            // The system's reason without the temporary name, which would only puzzle.
            let reason = e.get_ref().and_then(|e| e.source()).map_or(e.to_string(), complaint);
            Error::io(path, std::io::Error::new(e.kind(), reason))
        })?;
        Ok(Self { path: path.to_owned(), destination, file: BufWriter::new(file) })
    }

    /// Appends bytes.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        self.file.write_all(bytes).map_err(|e| Error::io(&self.path, e))
    }

    /// The stream itself, for encoders.
    pub fn stream(&mut self) -> &mut BufWriter<NamedTempFile> {
        &mut self.file
    }

    /// Flushes and renames.
    pub fn finish(self) -> Result<()> {
        let Self { path, destination, file } = self;
        let file = file.into_inner().map_err(|e| Error::io(&path, e.into_error()))?;
        file.persist(&destination).map_err(|e| Error::io(&path, e.error))?;
        Ok(())
    }
}

/// Whether a file can be written at `path`, found out by beginning one there and leaving nothing.
///
/// # Errors
/// A destination that cannot be written to, or that is a directory or a device.
pub fn check_writable(path: &Path) -> Result<()> {
    Temporary::create(path).map(drop)
}

/// Writes UTF-8 text, whole or not at all.
///
/// # Errors
/// A destination that cannot be written to, or that is a directory or a device.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    let mut file = Temporary::create(path)?;
    file.write(text.as_bytes())?;
    file.finish()
}

/// Writes JSON, indented and with a line feed at its end, whole or not at all.
///
/// # Errors
/// A destination that cannot be written to, or that is a directory or a device.
pub fn write_json(path: &Path, value: &serde_json::Value) -> Result<()> {
    // The alternate form of a value's Display is its pretty-printed text.
    write_text(path, &format!("{value:#}\n"))
}
