//! Free disk space, checked before the work.

use ridgelight::{Error, Result};
use std::path::Path;

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
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
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
        // A missing folder is reported when the file is made.
        check_room(&[(&folder.path().join("no/a.npy"), 1 << 62)]).unwrap();
    }
}
