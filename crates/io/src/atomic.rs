//! Output files that are complete or absent, and room for them on their disks.

mod leftover;

use crate::open::complaint;
use ridgelight::{Error, Result};
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempPath;

/// Unfinished temporary files and new result folders of this process. Locked while one is made,
/// renamed or removed.
static UNFINISHED: Mutex<Unfinished> =
    Mutex::new(Unfinished { files: Vec::new(), folders: Vec::new(), cleaned: BTreeSet::new() });

struct Unfinished {
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
    /// Folders without files of killed processes.
    cleaned: BTreeSet<PathBuf>,
}

fn unfinished() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes this process's unfinished files and its empty result folders, for a signal handler that
/// then ends the process. Any thread that begins or finishes a file from here on blocks until then.
pub fn abandon_unfinished() {
    let all = unfinished();
    for path in &all.files {
        // A file that cannot be removed stays: nobody is left to report it to.
        let _ = fs::remove_file(path);
    }
    for path in &all.folders {
        let _ = fs::remove_dir(path);
    }
    std::mem::forget(all);
}

/// A folder for results, made if missing. A new folder is removed with this value, or with the
/// process ([`abandon_unfinished`]), if it is still empty.
#[derive(Debug)]
pub struct ResultFolder {
    made: Option<PathBuf>,
}

impl ResultFolder {
    /// # Errors
    /// A folder that cannot be found or made.
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
        // A folder that is not empty is no error.
        let _ = fs::remove_dir(path);
    }
}

/// A file under a temporary name beside its destination. Dropping it unfinished removes it.
#[derive(Debug)]
pub(crate) struct Temporary {
    // Closed before it is removed.
    stream: BufWriter<fs::File>,
    whole: Written,
}

/// A complete, closed file under a temporary name. Dropping it before [`place`](Self::place)
/// removes it.
#[derive(Debug)]
pub struct Written {
    /// The path from the caller, for messages.
    path: PathBuf,
    /// The destination: `path`, or the target of its link.
    destination: PathBuf,
    /// None once it is renamed or removed.
    name: Option<TempPath>,
}

impl Written {
    /// The temporary path.
    pub fn path(&self) -> &Path {
        self.name.as_deref().expect("it has a name until it is placed")
    }

    /// Moves the file to its destination.
    ///
    /// # Errors
    /// A destination that cannot be replaced.
    pub fn place(mut self) -> Result<()> {
        let destination = self.destination.clone();
        self.end(|name| name.persist(destination).map_err(|e| e.error))
            .map_err(|e| Error::io(&self.path, e))
    }

    /// Applies `end` to the temporary name, with the list of such names locked.
    fn end(&mut self, take: impl FnOnce(TempPath) -> std::io::Result<()>) -> std::io::Result<()> {
        let Some(name) = self.name.take() else { return Ok(()) };
        let mut all = unfinished();
        all.files.retain(|path| **path != *name);
        take(name)
    }
}

impl Drop for Written {
    fn drop(&mut self) {
        // As for any temporary file, one that cannot be removed stays.
        let _ = self.end(TempPath::close);
    }
}

impl Temporary {
    /// Begins a file that will replace `path`.
    ///
    /// A destination that exists but is no regular file is refused: renaming over a device such as
    /// /dev/null would replace the device.
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
        let prefix = leftover::prefix();
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix);
        // Temporary files are private by default. A result is as readable as any new file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let folder = folder_of(&destination);
        let mut all = unfinished();
        if all.cleaned.insert(folder.to_owned()) {
            leftover::remove_from(folder);
        }
        let file = builder.tempfile_in(folder).map_err(|e| {
            // The system's reason, without the temporary name.
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

    /// Continues at a place in the file.
    pub fn seek(&mut self, place: u64) -> Result<()> {
        let moved = self.stream.seek(SeekFrom::Start(place));
        moved.map(drop).map_err(|e| Error::io(&self.whole.path, e))
    }

    /// The stream, for encoders.
    pub fn stream(&mut self) -> &mut BufWriter<fs::File> {
        &mut self.stream
    }

    /// The temporary path, for reading back what has been flushed.
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

/// Checks that `path` can be written, by beginning a file there and removing it.
///
/// # Errors
/// A destination that cannot be written, or that is a directory or a device.
pub fn check_writable(path: &Path) -> Result<()> {
    Temporary::create(path).map(drop)
}

/// Writes UTF-8 text, whole or not at all.
///
/// # Errors
/// A destination that cannot be written, or that is a directory or a device.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    let mut file = Temporary::create(path)?;
    file.write(text.as_bytes())?;
    file.finish()
}

/// Writes indented JSON with a final line feed, whole or not at all.
///
/// # Errors
/// A destination that cannot be written, or that is a directory or a device.
pub fn write_json(path: &Path, value: &serde_json::Value) -> Result<()> {
    // The alternate form of a value's Display is its pretty-printed text.
    write_text(path, &format!("{value:#}\n"))
}

pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Refuses files that together exceed the free space of their disks. Each is a destination and its
/// size in bytes. Without information from the system nothing is refused.
///
/// # Errors
/// The first file without room, as [`Error::Limit`].
pub fn check_room(files: &[(&Path, u64)]) -> Result<()> {
    let disks: Vec<_> = files.iter().map(|(path, _)| free(path)).collect();
    for ((path, _), disk) in files.iter().zip(&disks) {
        let Some((id, available)) = disk else { continue };
        let on_it = files.iter().zip(&disks).filter(|(_, d)| d.is_some_and(|d| d.0 == *id));
        let needed = on_it.fold(0_u64, |sum, ((_, bytes), _)| sum.saturating_add(*bytes));
        if needed > *available {
            return Err(Error::Limit {
                what: path.display().to_string(),
                needs: format!("{needed} bytes on its disk"),
                limit: format!("{available} that are free"),
            });
        }
    }
    Ok(())
}

/// The disk of `path`, and its bytes free to this user.
#[cfg(unix)]
fn free(path: &Path) -> Option<(u64, u64)> {
    // A folder that does not exist yet will be on the disk of its nearest existing parent.
    let parents = path.ancestors().skip(1);
    let named = |parent: &'_ Path| parent.as_os_str().is_empty().then_some(Path::new("."));
    let folder = parents.map(|p| named(p).unwrap_or(p)).find(|folder| folder.exists())?;
    let about = rustix::fs::statvfs(folder).ok()?;
    let id = std::os::unix::fs::MetadataExt::dev(&std::fs::metadata(folder).ok()?);
    Some((id, about.f_bavail.saturating_mul(about.f_frsize)))
}

#[cfg(not(unix))]
fn free(_: &Path) -> Option<(u64, u64)> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_fits_is_taken_and_what_does_not_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a.npy", "b.npy"].map(|name| folder.path().join(name));
        check_room(&[(&a, 1), (&b, 1)]).unwrap();
        let said = check_room(&[(&a, 1 << 62)]).unwrap_err().to_string();
        assert!(said.contains("a.npy: needs 4611686018427387904 bytes on its disk"), "{said}");
        // Two files that fit alone do not fit together.
        let (_, free) = free(&a).unwrap();
        let most = free / 4 * 3;
        check_room(&[(&a, most)]).unwrap();
        assert!(check_room(&[(&a, most), (&b, most)]).is_err());
        // A folder that is made later.
        let later = folder.path().join("no/a.npy");
        check_room(&[(&later, most)]).unwrap();
        let said = check_room(&[(&later, 1 << 62)]).unwrap_err().to_string();
        assert!(said.contains("no/a.npy: needs"), "{said}");
        assert_eq!(super::free(Path::new("no/b.npy")), super::free(Path::new("b.npy")));
    }
}
