//! NumPy archives: a ZIP of `.npy` members with heights, and their cell size in scalars.

use super::npy::{self, Array};
use crate::heights::{Cell, Raster, looks_like_degrees};
use crate::open;
use ridgelight::{Error, Result};
use std::io::{Cursor, Read};
use std::path::Path;
use zip::ZipArchive;

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

/// Members that hold heights, in order of preference; else the only 2-D array is used.
const HEIGHTS: [&str; 4] = ["elevation", "heights", "height", "z"];

/// Heights with the cell size of the scalars `dx` and `dy`. `xmin` to `ymax` distinguish degrees
/// from metres; `ymin` may be the northern one.
pub(crate) fn heights(path: &Path, bytes: &[u8]) -> Result<Raster> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|e| {
        Error::file(path, "archive", open::complaint(e), "a whole ZIP archive of arrays")
    })?;
    let names: Vec<String> = archive
        .file_names()
        .filter_map(|n| n.ok().map(|n| n.into_owned()))
        .filter(|n| n.ends_with(".npy"))
        .collect();
    let named = HEIGHTS.iter().map(|n| format!("{n}.npy")).find(|n| names.contains(n));
    let mut raster = match named {
        Some(name) => {
            let member = member(path, &mut archive, bytes.len(), &name)?;
            let inside = format!("{name}: ");
            npy::raster(path, &inside, &Array::parse(path, &inside, &member)?)?
        }
        None => only_plane(path, &mut archive, bytes.len(), &names)?,
    };
    let mut scalar = |key: &str| -> Result<Option<f64>> {
        let name = format!("{key}.npy");
        if !names.contains(&name) {
            return Ok(None);
        }
        let member = member(path, &mut archive, bytes.len(), &name)?;
        let inside = format!("{name}: ");
        let array = Array::parse(path, &inside, &member)?;
        let mut values = array.values();
        match (values.next(), values.next()) {
            (Some(value), None) => Ok(Some(value)),
            _ => {
                let found = format!("the shape {:?}", array.shape);
                Err(Error::file(path, format!("{inside}header"), found, "one number"))
            }
        }
    };
    let (Some(dx), Some(dy)) = (scalar("dx")?, scalar("dy")?) else { return Ok(raster) };
    let cell = [dx.abs(), dy.abs()];
    if !cell.iter().all(|c| c.is_finite() && *c > 0.0) {
        return Err(Error::file(
            path,
            "dx, dy",
            format!("{dx:?} and {dy:?}"),
            "lengths other than 0",
        ));
    }
    let mut edges = [0.0; 4];
    let mut all = true;
    for (edge, key) in edges.iter_mut().zip(["xmin", "xmax", "ymin", "ymax"]) {
        match scalar(key)? {
            Some(value) => *edge = value,
            None => all = false,
        }
    }
    let [x0, x1, y0, y1] = edges;
    raster.cell = if all && looks_like_degrees([x0, x1], [y0, y1], cell) {
        Cell::Degrees { cell, latitude: (y0 + y1) / 2.0, is_guess: true }
    } else {
        Cell::Metres(cell)
    };
    Ok(raster)
}

/// The one member with two dimensions.
fn only_plane(path: &Path, archive: &mut Archive, held: usize, names: &[String]) -> Result<Raster> {
    let mut found: Option<Raster> = None;
    for name in names {
        let member = member(path, archive, held, name)?;
        let inside = format!("{}: ", open::shortened(name, 40));
        let Ok(array) = Array::parse(path, &inside, &member) else { continue };
        if array.shape.len() != 2 {
            continue;
        }
        if found.is_some() {
            let expected = format!("one, or one named {}", HEIGHTS.join(", "));
            return Err(Error::file(path, "archive", "several 2-D arrays", expected));
        }
        found = Some(npy::raster(path, &inside, &array)?);
    }
    found.ok_or_else(|| Error::file(path, "archive", "no 2-D array", "an array of heights"))
}

/// A member's bytes. A claimed size beyond what the file could hold is refused, as is a member
/// larger than its claim.
fn member(path: &Path, archive: &mut Archive, held: usize, name: &str) -> Result<Vec<u8>> {
    let place = open::shortened(name, 40);
    let wrong =
        |found: String| Error::file(path, place.as_str(), found, "a stored or deflated array");
    let file = archive.by_name(name).map_err(|e| wrong(open::complaint(e)))?;
    let claimed = file.size();
    open::plausible(path, &place, claimed, held, open::DEFLATE_RATIO)?;
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(usize::try_from(claimed).unwrap_or(usize::MAX))
        .map_err(|_| wrong(format!("{claimed} bytes, more than there is memory")))?;
    // One more byte: checksums are only verified at the end.
    let read = file.take(claimed.saturating_add(1)).read_to_end(&mut bytes);
    read.map_err(|e| wrong(open::complaint(e)))?;
    if bytes.len() as u64 != claimed {
        return Err(wrong(format!("more than the {claimed} bytes that it says")));
    }
    Ok(bytes)
}
