//! Results read back as plain planes, for comparison.

use super::npy::Array;
use crate::environment::hdr;
use crate::exr;
use crate::georeference::Georeference;
use crate::heights::{geotiff, is_nodata, tif};
use crate::open::{self, Format};
use crate::png;
use ridgelight::{Error, Result};
use std::path::Path;

/// Named channels of one size, row-major. Values are arbitrary, NaN included.
#[derive(Clone, Debug, PartialEq)]
pub struct Planes {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub cols: usize,
    /// One name per plane.
    pub names: Vec<String>,
    /// One value per pixel.
    pub planes: Vec<Vec<f32>>,
}

/// Reads every plane of a result.
///
/// `.exr`: all channels under their names ("direct.sky.R"), at full resolution. `.npy`: a 2-D array
/// as the plane "0", a 3-D one [k, rows, cols] as "0" to "k-1". `.hdr`: "R", "G", "B". `.png`: "R",
/// "G", "B" or "Y" decoded from sRGB to linear light, and "A" (0 to 1) where there is alpha. `.tif`: the
/// bands under their names in GDAL's metadata, else "band1" and so on; scale and offset apply, and no
/// data is NaN.
///
/// # Errors
/// A file that cannot be read or decoded; other dimensions; sizes beyond 65 536 a side or 2³⁰
/// values per plane.
pub fn read_planes(path: &Path) -> Result<Planes> {
    parse_planes(path, &open::read(path)?)
}

/// [`read_planes`] from bytes in memory. `name` sets the format and appears in messages.
///
/// # Errors
/// As [`read_planes`], except file access.
pub fn parse_planes(name: &Path, bytes: &[u8]) -> Result<Planes> {
    const ACCEPTED: [Format; 5] =
        [Format::Exr, Format::Tiff, Format::Npy, Format::Png, Format::Hdr];
    match open::format(name, bytes, &ACCEPTED)? {
        Format::Exr => {
            let file = exr::ExrFile::open(name, bytes)?;
            let names: Vec<String> = file.names().into_iter().map(str::to_owned).collect();
            let all: Vec<usize> = (0..names.len()).collect();
            let (rows, cols, planes) = file.planes(&all, |v| v as f32)?;
            Ok(Planes { rows, cols, names, planes })
        }
        Format::Tiff => from_tiff(name, bytes),
        Format::Npy => from_npy(name, bytes),
        Format::Hdr => {
            let (rows, cols, rgb) = hdr::colour(name, bytes)?;
            let (names, planes) = channels(&rgb, false, None);
            Ok(Planes { rows, cols, names, planes })
        }
        _ => {
            let png = png::linear(name, bytes)?;
            let (names, planes) = channels(&png.rgb, png.grey, png.alpha);
            Ok(Planes { rows: png.rows, cols: png.cols, names, planes })
        }
    }
}

/// Names and planes of a picture.
fn channels(rgb: &[[f32; 3]], grey: bool, alpha: Option<Vec<f32>>) -> (Vec<String>, Vec<Vec<f32>>) {
    let colours: &[&str] = if grey { &["Y"] } else { &["R", "G", "B"] };
    let mut names: Vec<String> = colours.iter().map(|n| (*n).to_owned()).collect();
    let mut planes: Vec<Vec<f32>> =
        (0..names.len()).map(|i| rgb.iter().map(|t| t[i]).collect()).collect();
    if let Some(alpha) = alpha {
        names.push("A".to_owned());
        planes.push(alpha);
    }
    (names, planes)
}

/// Georeference of a `.tif`; `None` if it has none.
///
/// # Errors
/// A file that is no `.tif`, that cannot be read, or whose tags are invalid.
pub fn read_georeference(path: &Path) -> Result<Option<Georeference>> {
    let bytes = open::read(path)?;
    open::format(path, &bytes, &[Format::Tiff])?;
    geotiff::georeference(path, &mut tif::Image::open(path, &bytes)?.tiff)
}

fn from_tiff(path: &Path, bytes: &[u8]) -> Result<Planes> {
    let mut image = tif::Image::open(path, bytes)?;
    let (rows, cols, bands) = (image.rows, image.cols, image.bands);
    let nodata = geotiff::nodata(path, &mut image.tiff)?;
    let mut names = Vec::with_capacity(bands);
    let mut scales = Vec::with_capacity(bands);
    for band in 0..bands {
        let name = geotiff::band_name(path, &mut image.tiff, band)?;
        names.push(name.unwrap_or_else(|| format!("band{}", band + 1)));
        scales.push(geotiff::scale(path, &mut image.tiff, band)?);
    }
    let is_void = |value: f64| nodata.is_some_and(|nodata| is_nodata(value, nodata, true));
    let known = |value: f64| if is_void(value) { f32::NAN } else { value as f32 };
    let (mut planes, _) = image.read(0..bands, nodata.unwrap_or(0.0), known)?;
    for (plane, [scale, offset]) in planes.iter_mut().zip(scales) {
        if [scale, offset] != [1.0, 0.0] {
            let scaled = |v: &mut f32| *v = (f64::from(*v) * scale + offset) as f32;
            plane.iter_mut().for_each(scaled);
        }
    }
    Ok(Planes { rows, cols, names, planes })
}

fn from_npy(path: &Path, bytes: &[u8]) -> Result<Planes> {
    let array = Array::parse(path, "", bytes)?;
    let (count, rows, cols) = match *array.shape.as_slice() {
        [rows, cols] => (1, rows, cols),
        [count, rows, cols] => (count, rows, cols),
        _ => {
            let found = format!("{} dimensions", array.shape.len());
            return Err(Error::file(path, "header: shape", found, "two or three"));
        }
    };
    let (rows, cols) = open::size(path, "header: shape", rows as u64, cols as u64)?;
    let mut values = array.values().map(|v| v as f32);
    let planes = (0..count).map(|_| values.by_ref().take(rows * cols).collect()).collect();
    Ok(Planes { rows, cols, names: (0..count).map(|i| i.to_string()).collect(), planes })
}
