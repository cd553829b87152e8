//! The output folder of `bake`.

use std::path::Path;

use clap::ValueEnum;
use ridgelight::{Error, Result};
use ridgelight_io as files;

use super::MANIFEST;
use super::map::{Format, Wanted};
use crate::setup;

/// A kind and its files.
type FileNotes = (String, Vec<String>);

/// Kinds and files that a manifest lists; none where there is no manifest.
///
/// # Errors
/// A manifest that cannot be read or has no list of kinds and files.
fn listed(path: &Path) -> Result<Vec<FileNotes>> {
    let text = match std::fs::read(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        text => text.map_err(|source| Error::io(path, source))?,
    };
    let kinds = serde_json::from_slice(&text).ok().and_then(|manifest| kinds(&manifest));
    kinds.ok_or_else(|| {
        let expected = "a manifest that `bake` wrote, or a folder without this file";
        Error::file(path, "maps", "no list of kinds and their files", expected)
    })
}

/// Reads the manifest of an earlier bake and removes it.
pub fn take_manifest(folder: &Path) -> Result<Vec<FileNotes>> {
    let path = folder.join(MANIFEST);
    let before = listed(&path)?;
    match std::fs::remove_file(&path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(Error::Io { path, source })
        }
        _ => Ok(before),
    }
}

fn kinds(manifest: &serde_json::Value) -> Option<Vec<FileNotes>> {
    let word = |value: &serde_json::Value| value.as_str().map(str::to_owned);
    let of = |map: &serde_json::Value| {
        let files = map["files"].as_array()?.iter().map(|file| word(&file["file"]));
        Some((word(&map["kind"])?, files.collect::<Option<_>>()?))
    };
    manifest["maps"].as_array()?.iter().map(of).collect()
}

/// Checks that the output folder exists or can be made, and that it holds no bake of other kinds,
/// whose manifest would be lost.
pub fn check_folder(path: &Path, wanted: &[Wanted]) -> Result<()> {
    let shown = || path.display().to_string();
    if path.is_dir() {
        let is_other = |kind: &String| wanted.iter().all(|w| w.kind.name != kind);
        let listed = listed(&path.join(MANIFEST))?;
        if let Some((kind, _)) = listed.iter().find(|(kind, _)| is_other(kind)) {
            let found = format!("{} with {kind} in its {MANIFEST}", shown());
            let expected = "a folder without another bake, or all its kinds among --what";
            return Err(Error::setting("-o", found, expected));
        }
        return files::check_writable(&path.join(MANIFEST));
    }
    // A folder "maps.ktx2" would be taken for a file.
    if Format::value_variants().iter().any(|format| setup::extension(path) == format.name()) {
        let expected = "a folder name without a file extension; --what and --format name its files";
        return Err(Error::setting("-o", shown(), expected));
    }
    check_new(path)
}

/// Checks that a folder can be made.
pub fn check_new(path: &Path) -> Result<()> {
    let shown = || path.display().to_string();
    if path.is_symlink() && !path.exists() {
        return Err(Error::setting("-o", format!("{}, a broken link", shown()), "a folder"));
    }
    if path.exists() {
        return Err(Error::setting("-o", format!("the file {}", shown()), "a folder"));
    }
    let parent = setup::folder_of(path);
    if !parent.is_dir() {
        let expected = format!("a folder {} that exists", parent.display());
        return Err(Error::setting("-o", shown(), expected));
    }
    files::check_writable(path)
}

/// Refuses a bake that needs more memory than the machine has.
pub fn check_memory(bytes: u64) -> Result<()> {
    let wanted = usize::try_from(bytes).unwrap_or(usize::MAX);
    Vec::<u8>::new().try_reserve_exact(wanted).map_err(|_| Error::Limit {
        what: "bake --what".into(),
        needs: format!("{bytes} bytes of memory in this process (see --plan)"),
        limit: "what this machine has".into(),
    })
}

/// Removes files of an earlier bake that this one has not written: surplus azimuths, other formats.
pub fn remove_old(folder: &Path, before: Vec<FileNotes>) -> Result<()> {
    let now: Vec<String> =
        listed(&folder.join(MANIFEST))?.into_iter().flat_map(|(_, files)| files).collect();
    for (kind, names) in before {
        let is_own = |name: &&String| name.starts_with(&kind.replace('-', "_"));
        for name in names.iter().filter(is_own).filter(|name| !now.contains(name)) {
            if Path::new(name).file_name().is_some_and(|own| *own == **name) {
                // A file that cannot be removed stays, unlisted.
                let _ = std::fs::remove_file(folder.join(name));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_the_machine_has_is_refused() {
        assert!(check_memory(1 << 16).is_ok());
        let said = check_memory(1 << 62).expect_err("beyond any machine").to_string();
        assert!(said.contains("needs 4611686018427387904 bytes"), "{said}");
    }
}
