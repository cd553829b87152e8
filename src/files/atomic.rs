//! Files that are complete or absent.

use super::open::complaint;
use crate::{Error, Result};
use std::fs;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempPath;

/// Temporary files of this process. Locked while one is made, renamed or removed.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file that this process has begun and not finished; for a handler of signals, which
/// ends the process next. Whoever begins or finishes a file from here on waits for that end.
pub fn abandon_unfinished() {
    let files = unfinished();
    for path in files.iter() {
        // What cannot be removed stays: there is no one left to tell.
        let _ = fs::remove_file(path);
    }
    std::mem::forget(files);
}

/// A file under a temporary name beside its destination; dropped unfinished, it is removed.
#[derive(Debug)]
pub(super) struct Temporary {
    /// As the caller wrote it, for messages.
    path: PathBuf,
    /// Where it goes: `path`, or what `path` links to.
    destination: PathBuf,
    stream: BufWriter<fs::File>,
    /// Gone once it is renamed or removed.
    name: Option<TempPath>,
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
        let mut files = unfinished();
        let file = builder.tempfile_in(directory).map_err(|e| {
            // The system's reason without the temporary name, which would only puzzle.
            let reason = e.get_ref().and_then(|e| e.source()).map_or(e.to_string(), complaint);
            Error::io(path, std::io::Error::new(e.kind(), reason))
        })?;
        files.push(file.path().to_owned());
        let (file, name) = file.into_parts();
        let stream = BufWriter::new(file);
        Ok(Self { path: path.to_owned(), destination, stream, name: Some(name) })
    }

    /// Appends bytes.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        self.stream.write_all(bytes).map_err(|e| Error::io(&self.path, e))
    }

    /// The stream itself, for encoders.
    pub fn stream(&mut self) -> &mut BufWriter<fs::File> {
        &mut self.stream
    }

    /// Its name until it is finished, for reading back what has been flushed.
    pub fn name(&self) -> &Path {
        self.name.as_deref().expect("it has one until it is finished")
    }

    /// Flushes and renames.
    pub fn finish(mut self) -> Result<()> {
        self.stream.flush().map_err(|e| Error::io(&self.path, e))?;
        let destination = self.destination.clone();
        self.end(|name| name.persist(destination).map_err(|e| e.error))
            .map_err(|e| Error::io(&self.path, e))
    }

    /// Has the temporary name taken away, with the list of such names locked.
    fn end(&mut self, take: impl FnOnce(TempPath) -> std::io::Result<()>) -> std::io::Result<()> {
        let Some(name) = self.name.take() else { return Ok(()) };
        let mut files = unfinished();
        files.retain(|path| **path != *name);
        take(name)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // As for any temporary file, what cannot be removed stays.
        let _ = self.end(TempPath::close);
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
