//! Files that are complete or absent.

use super::open::complaint;
use ridgelight::{Error, Result};
use std::fs;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempPath;

/// What this process leaves unfinished: temporary files, and folders that it has made for results. Locked while a file is
/// made, renamed or removed, and a folder made or removed.
static UNFINISHED: Mutex<Unfinished> =
    Mutex::new(Unfinished { files: Vec::new(), folders: Vec::new() });

struct Unfinished {
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
}

fn unfinished() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file that this process has begun and not finished, and folders that it has made and that are empty; for a
/// handler of signals, which ends the process next. Whoever begins or finishes one from here on waits for that end.
pub fn abandon_unfinished() {
    let all = unfinished();
    for path in &all.files {
        // What cannot be removed stays: there is no one left to tell.
        let _ = fs::remove_file(path);
    }
    for path in &all.folders {
        let _ = fs::remove_dir(path);
    }
    std::mem::forget(all);
}

/// A folder for results, made where it was missing. One that was made goes with this, or with the process
/// ([`abandon_unfinished`]), unless something lies in it by then.
#[derive(Debug)]
pub struct ResultFolder {
    made: Option<PathBuf>,
}

impl ResultFolder {
    /// # Errors
    /// A folder that can neither be found nor made.
    pub fn create(path: &Path) -> Result<Self> {
        let mut all = unfinished();
        match fs::create_dir(path) {
            Ok(()) => {
                all.folders.push(path.to_owned());
                Ok(Self { made: Some(path.to_owned()) })
            }
            Err(_) if path.is_dir() => Ok(Self { made: None }),
            Err(error) => Err(Error::io(path, error)),
        }
    }
}

impl Drop for ResultFolder {
    fn drop(&mut self) {
        let Some(path) = self.made.take() else { return };
        let mut all = unfinished();
        all.folders.retain(|other| *other != path);
        // It is no error that it has something in it.
        let _ = fs::remove_dir(path);
    }
}

/// A file under a temporary name beside its destination; dropped unfinished, it is removed.
#[derive(Debug)]
pub(super) struct Temporary {
    // Closed before it is removed.
    stream: BufWriter<fs::File>,
    whole: Written,
}

/// A file that is whole and closed, but under a temporary name still; dropped before [`place`](Self::place), it is removed.
#[derive(Debug)]
pub struct Written {
    /// As the caller wrote it, for messages.
    path: PathBuf,
    /// Where it goes: `path`, or what `path` links to.
    destination: PathBuf,
    /// Gone once it is renamed or removed.
    name: Option<TempPath>,
}

impl Written {
    /// Where it lies until then.
    pub fn path(&self) -> &Path {
        self.name.as_deref().expect("it has a name until it is placed")
    }

    /// Puts it at its destination.
    ///
    /// # Errors
    /// A destination that cannot be replaced.
    pub fn place(mut self) -> Result<()> {
        let destination = self.destination.clone();
        self.end(|name| name.persist(destination).map_err(|e| e.error))
            .map_err(|e| Error::io(&self.path, e))
    }

    /// Has the temporary name taken away, with the list of such names locked.
    fn end(&mut self, take: impl FnOnce(TempPath) -> std::io::Result<()>) -> std::io::Result<()> {
        let Some(name) = self.name.take() else { return Ok(()) };
        let mut all = unfinished();
        all.files.retain(|path| **path != *name);
        take(name)
    }
}

impl Drop for Written {
    fn drop(&mut self) {
        // As for any temporary file, what cannot be removed stays.
        let _ = self.end(TempPath::close);
    }
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
        let mut all = unfinished();
        let file = builder.tempfile_in(directory).map_err(|e| {
            // The system's reason without the temporary name, which would only puzzle.
            let reason = e.get_ref().and_then(|e| e.source()).map_or(e.to_string(), complaint);
            let reason = reason.split(" at path ").next().unwrap_or_default().to_owned();
            Error::io(path, std::io::Error::new(e.kind(), reason))
        })?;
        all.files.push(file.path().to_owned());
        let (file, name) = file.into_parts();
        let stream = BufWriter::new(file);
        let whole = Written { path: path.to_owned(), destination, name: Some(name) };
        Ok(Self { stream, whole })
    }

    /// Appends bytes.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        self.stream.write_all(bytes).map_err(|e| Error::io(&self.whole.path, e))
    }

    /// The stream itself, for encoders.
    pub fn stream(&mut self) -> &mut BufWriter<fs::File> {
        &mut self.stream
    }

    /// Its name until it is finished, for reading back what has been flushed.
    pub fn name(&self) -> &Path {
        self.whole.path()
    }

    /// Flushes and closes.
    pub fn close(mut self) -> Result<Written> {
        self.stream.flush().map_err(|e| Error::io(&self.whole.path, e))?;
        Ok(self.whole)
    }

    /// Flushes and renames.
    pub fn finish(self) -> Result<()> {
        self.close()?.place()
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
