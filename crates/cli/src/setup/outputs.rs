//! Output files: their endings, what refuses them before the work, and layers by the ending.

use std::path::{Path, PathBuf};

use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::Georeference;

/// Writes a GeoTIFF or an EXR, by the name.
pub fn write_layers(
    path: &Path,
    [rows, cols]: [usize; 2],
    layers: &[files::Layer],
    units: &[(&str, &str)],
    georeference: Option<&Georeference>,
    metadata: &[(String, String)],
) -> Result<()> {
    if is_geotiff(path) {
        return files::write_geotiff(path, [rows, cols], layers, units, georeference, metadata);
    }
    files::write_exr(path, rows, cols, layers, metadata)
}

pub fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// The folder of a file.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Whether a name is that of a GeoTIFF.
pub fn is_geotiff(path: &Path) -> bool {
    ["tif", "tiff"].contains(&extension(path).as_str())
}

/// ".exr, .npy or .tif"
fn either(kinds: &[&str]) -> String {
    let (last, others) = kinds.split_last().expect("an ending");
    let others = others.join(", .");
    if others.is_empty() { format!(".{last}") } else { format!(".{others} or .{last}") }
}

/// Refuses an output file that cannot be written, before the work.
pub fn check_output(flag: &str, path: &Path, kinds: &[&str]) -> Result<()> {
    let found = extension(path);
    if !kinds.contains(&found.as_str()) {
        return Err(Error::setting(
            flag,
            path.display().to_string(),
            format!("a file ending in {}", either(kinds)),
        ));
    }
    if path.is_dir() {
        return Err(Error::setting(flag, format!("the directory {}", path.display()), "a file"));
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(Error::setting(
            flag,
            path.display().to_string(),
            format!("a folder {} that exists", folder.display()),
        ));
    }
    files::check_writable(path)
}

/// Refuses outputs that cannot be written, and one that is also another output or an input. Each has its flag and the
/// endings that it may have.
pub fn check_outputs(outputs: &[(&str, Option<&Path>, &[&str])], inputs: &[&Path]) -> Result<()> {
    for (flag, path, kinds) in outputs {
        path.map_or(Ok(()), |path| check_output(flag, path, kinds))?;
    }
    let outputs: Vec<_> = outputs.iter().map(|(flag, path, _)| (*flag, *path)).collect();
    check_distinct(&outputs, inputs)
}

/// Refuses an output that is also another output or an input.
pub fn check_distinct(outputs: &[(&str, Option<&Path>)], inputs: &[&Path]) -> Result<()> {
    let place = |path: &Path| -> Option<PathBuf> {
        let in_folder = || Some(folder_of(path).canonicalize().ok()?.join(path.file_name()?));
        path.canonicalize().ok().or_else(in_folder)
    };
    let mut taken: Vec<(&str, Option<PathBuf>)> =
        inputs.iter().map(|path| ("an input", place(path))).collect();
    for (flag, path) in outputs {
        let Some(path) = path else { continue };
        let here = place(path);
        if let Some((other, _)) = taken.iter().find(|(_, p)| p.is_some() && *p == here) {
            let found = format!("{}, which is {other}", path.display());
            return Err(Error::setting(*flag, found, "a file of its own"));
        }
        taken.push((flag, here));
    }
    Ok(())
}
