//! Where the files of `bake` go.

use std::path::Path;

use ridgelight::{Error, Result};
use ridgelight_io as files;

use super::SHEET;
use super::map::Wanted;

/// A kind and its files.
type FileNotes = (String, Vec<String>);

/// The kinds that a sheet tells of, each with its files; none where there is no sheet.
///
/// # Errors
/// One that cannot be read, or does not tell: what lies beside it is unknown.
fn told(path: &Path) -> Result<Vec<FileNotes>> {
    let text = match std::fs::read(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        text => text.map_err(|source| Error::Io { path: path.to_owned(), source })?,
    };
    let kinds = serde_json::from_slice(&text).ok().and_then(|sheet| kinds(&sheet));
    kinds.ok_or_else(|| Error::File {
        path: path.to_owned(),
        place: "maps".into(),
        found: "no list of kinds and their files".into(),
        expected: "what a bake wrote, whole, or a folder without this file".into(),
    })
}

/// What the sheet of an earlier bake tells of, and removes it.
pub fn take_sheet(folder: &Path) -> Result<Vec<FileNotes>> {
    let path = folder.join(SHEET);
    let before = told(&path)?;
    match std::fs::remove_file(&path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(Error::Io { path, source })
        }
        _ => Ok(before),
    }
}

fn kinds(sheet: &serde_json::Value) -> Option<Vec<FileNotes>> {
    let word = |value: &serde_json::Value| value.as_str().map(str::to_owned);
    let of = |map: &serde_json::Value| {
        let files = map["files"].as_array()?.iter().map(|file| word(&file["file"]));
        Some((word(&map["kind"])?, files.collect::<Option<_>>()?))
    };
    sheet["maps"].as_array()?.iter().map(of).collect()
}

/// Where files go: a folder that is there, or can be made. A bake of other kinds there would lose its sheet.
pub fn check_folder(path: &Path, wanted: &[Wanted]) -> Result<()> {
    let shown = || path.display().to_string();
    if path.is_dir() {
        let is_other = |kind: &String| wanted.iter().all(|w| w.kind.name != kind);
        let told = told(&path.join(SHEET))?;
        if let Some((kind, _)) = told.iter().find(|(kind, _)| is_other(kind)) {
            let found = format!("{} with {kind} in its {SHEET}", shown());
            let expected = "a folder without another bake, or all its kinds among --what";
            return Err(Error::setting("-o", found, expected));
        }
        return files::check_writable(&path.join(SHEET));
    }
    if path.is_symlink() && !path.exists() {
        return Err(Error::setting("-o", format!("{}, a link to nothing", shown()), "a folder"));
    }
    if path.exists() {
        return Err(Error::setting("-o", format!("the file {}", shown()), "a folder"));
    }
    let parent = parent(path);
    if !parent.is_dir() {
        let expected = format!("a folder {} that exists", parent.display());
        return Err(Error::setting("-o", shown(), expected));
    }
    files::check_writable(path)
}

/// Refuses what this machine has no memory for, before it is begun.
pub fn check_memory(bytes: u64) -> Result<()> {
    let wanted = usize::try_from(bytes).unwrap_or(usize::MAX);
    Vec::<u8>::new().try_reserve_exact(wanted).map_err(|_| Error::Limit {
        what: "a bake of --what".into(),
        needs: format!("{bytes} bytes of this program's memory, see --plan"),
        limit: "what this machine gives".into(),
    })
}

pub fn parent(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Removes what an earlier bake told of and this one does not: azimuths beyond the last, other formats.
pub fn remove_old(folder: &Path, before: Vec<FileNotes>) -> Result<()> {
    let now: Vec<String> =
        told(&folder.join(SHEET))?.into_iter().flat_map(|(_, files)| files).collect();
    for (kind, names) in before {
        let is_own = |name: &&String| name.starts_with(&kind.replace('-', "_"));
        for name in names.iter().filter(is_own).filter(|name| !now.contains(name)) {
            if Path::new(name).file_name().is_some_and(|own| *own == **name) {
                // What cannot be removed stays, untold of.
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
