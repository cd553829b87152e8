//! Height fields from files: format by name and signature, then one common path.

mod asc;
pub mod geotiff;
mod hgt;
pub mod size;
pub mod tif;
mod unpack;

use crate::exr;
use crate::georeference::Georeference;
use crate::npy;
use crate::npz;
use crate::open::{self, Format};
use crate::png;
use ridgelight::scene::HeightField;
use ridgelight::{Error, Result};
use std::path::Path;

/// Options that override the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightOptions {
    /// Spacing of columns and of rows, metres, each positive; overrides the file's.
    pub cell_m: Option<[f64; 2]>,
    /// Factor on every height; any finite number, 1 by default.
    pub z_scale: f64,
    /// The file's "no data" value, before `z_scale`; NaN is allowed. Overrides the file's own.
    pub nodata: Option<f64>,
}

impl Default for HeightOptions {
    fn default() -> Self {
        Self { cell_m: None, z_scale: 1.0, nodata: None }
    }
}

/// A decoded grid, before interpretation.
pub(crate) struct Raster {
    pub rows: usize,
    pub cols: usize,
    /// Row-major, row 0 in the north, in the file's unit.
    pub values: Vec<f64>,
    /// Whether the file holds 16- or 32-bit floats. A no-data value printed in decimal is then
    /// rounded to that type before it is compared.
    pub single: bool,
    pub cell: Cell,
    /// Metres in the file's unit of height.
    pub unit_m: f64,
    /// A height is the value times the first, plus the second.
    pub scale: [f64; 2],
    pub nodata: Option<f64>,
    /// The file's own mask of voids, if any.
    pub voids: Option<Vec<bool>>,
    /// Where the grid lies, if the file states it.
    pub georeference: Option<Georeference>,
    /// Whether the values are whole numbers of 8 bits.
    pub is_8_bit: bool,
}

impl Raster {
    /// Values without further information.
    pub fn bare(rows: usize, cols: usize, values: Vec<f64>) -> Self {
        Self {
            rows,
            cols,
            values,
            single: false,
            cell: Cell::Unknown,
            unit_m: 1.0,
            scale: [1.0, 0.0],
            nodata: None,
            voids: None,
            georeference: None,
            is_8_bit: false,
        }
    }
}

impl Raster {
    /// What was assumed or converted.
    fn notes(&self, options: &HeightOptions) -> Vec<String> {
        let mut notes = Vec::new();
        match self.cell {
            _ if options.cell_m.is_some() => {}
            Cell::Unknown => {
                notes.push("the file has no cell size: `cell_m` 1 is assumed".to_owned());
            }
            Cell::Metres(_) => {}
            Cell::Degrees { cell, latitude } => {
                let [east, north] = metres_a_degree(latitude);
                notes.push(format!(
                    "cells of {:.1} x {:.1} m, from degrees or Mercator metres at latitude {latitude:.2}",
                    cell[0] * east,
                    cell[1] * north
                ));
            }
        }
        if self.unit_m != 1.0 {
            notes.push(format!("heights are in units of {} m and become metres", self.unit_m));
        }
        if self.is_8_bit {
            notes.push(
                "heights are whole numbers of 8 bits, as of a picture: slopes have steps"
                    .to_owned(),
            );
        }
        notes
    }
}

/// Reads a height field. The name sets the format, and the signature must match.
///
/// | name | heights | cell size | no data |
/// |---|---|---|---|
/// | `.png` | grey, 8 or 16 bits; values are metres | 1 × 1 | alpha 0, or the `tRNS` grey |
/// | `.exr` | the only channel, or the only `height`, `elevation`, `Z`, `Y` or `R`; f16, f32, u32 | 1 × 1 | |
/// | `.tif`, `.tiff` | one band of any integer or float type | GeoTIFF tags | GDAL's tag |
/// | `.hgt` | SRTM: square, 16-bit big-endian | 1/(n-1)° at the latitude in the name | -32768 |
/// | `.asc` | ESRI ASCII grid | header | header |
/// | `.npy` | 2-D, integers or floats of any size, order and endianness | 1 × 1 | |
/// | `.npz` | `elevation`, `heights`, `height`, `z` or the only 2-D array | `dx`, `dy` | |
///
/// Any of them may be packed: `.gz`, as `dem.tif.gz`, or a `.zip` that holds one of them, as `N44W072.hgt.zip`. A TIFF's
/// scale and offset (GDAL's metadata) apply to its values.
///
/// Row 0 is the north. Cells in degrees are converted to metres by the WGS84 ellipsoid at the
/// latitude of the field's centre (one size for the whole field); so are the metres of Web Mercator, which are too long by 1/cos latitude. A header without a unit (`.asc`,
/// `.npz`, a TIFF without GeoKeys) is in degrees when its corners are longitudes and latitudes and
/// its cell is below 0.1, else in metres. A TIFF whose vertical unit is feet is converted to
/// metres.
///
/// # Errors
/// A file that cannot be read ([`Error::Io`]); options out of range ([`Error::Setting`]); an
/// invalid file ([`Error::File`]): more than 65 536 a side or 2³⁰ grid points, truncation, colour,
/// rotation, a height that is not finite and not marked as no data.
pub fn read_heights(path: &Path, options: &HeightOptions) -> Result<HeightField> {
    parse_heights(path, &open::read(path)?, options)
}

/// A height field and what its file states or lacks.
#[derive(Clone, Debug)]
pub struct FieldFile {
    /// The heights.
    pub field: HeightField,
    /// The position: GeoTIFF, `.hgt` with its corner in its name, `.asc`.
    pub georeference: Option<Georeference>,
    /// What was assumed or converted, a sentence each.
    pub notes: Vec<String>,
}

/// [`read_heights`], with the position and what was assumed.
///
/// # Errors
/// As [`read_heights`].
pub fn read_field(path: &Path, options: &HeightOptions) -> Result<FieldFile> {
    parse_field(path, &open::read(path)?, options)
}

/// [`read_heights`] from bytes in memory. `name` sets the format and appears in messages.
///
/// # Errors
/// As [`read_heights`], except file access.
pub fn parse_heights(name: &Path, bytes: &[u8], options: &HeightOptions) -> Result<HeightField> {
    Ok(parse_field(name, bytes, options)?.field)
}

fn parse_field(name: &Path, bytes: &[u8], options: &HeightOptions) -> Result<FieldFile> {
    check(options)?;
    const ACCEPTED: [Format; 7] = [
        Format::Png,
        Format::Exr,
        Format::Tiff,
        Format::Hgt,
        Format::Asc,
        Format::Npy,
        Format::Npz,
    ];
    let unpacked = unpack::unpacked(name, bytes)?;
    let (name, bytes) = match &unpacked {
        Some((name, bytes)) => (name.as_path(), bytes.as_slice()),
        None => (name, bytes),
    };
    let mut raster = match open::format(name, bytes, &ACCEPTED)? {
        Format::Png => png::heights(name, bytes),
        Format::Exr => exr::heights(name, bytes),
        Format::Tiff => tif::heights(name, bytes),
        Format::Hgt => hgt::heights(name, bytes, options.cell_m.is_some()),
        Format::Asc => asc::heights(name, bytes),
        Format::Npz => npz::heights(name, bytes),
        Format::Npy | Format::Hdr => npy::heights(name, bytes),
    }?;
    let georeference = raster.georeference.take();
    let mut notes = raster.notes(options);
    let field = finish(name, raster, options)?;
    notes.extend(about(&field));
    Ok(FieldFile { field, georeference, notes })
}

/// The Earth's mean radius, metres.
const EARTH_M: f64 = 6_371_000.0;
/// Fields as wide as this get a note on the curvature: it drops 7.8 m over them.
const WIDE_M: f64 = 10_000.0;

/// What a reader of results should know about a field: its voids and its width.
fn about(field: &HeightField) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(voids) = field.voids() {
        let share = voids.iter().filter(|v| **v).count() as f64 / voids.len() as f64;
        let half = if share >= 0.5 { "; half of the field or more is empty" } else { "" };
        notes.push(format!(
            "{:.3} % of the grid points are voids; their heights are filled from neighbours, their results left out{half}",
            100.0 * share
        ));
    }
    let [cell_x, cell_y] = field.cell_m();
    let [width, height] = [cell_x * (field.cols() - 1) as f64, cell_y * (field.rows() - 1) as f64];
    let widest = width.max(height);
    if widest > WIDE_M {
        let drop = widest * widest / (2.0 * EARTH_M);
        notes.push(format!(
            "the Earth's curvature drops {drop:.0} m over the {:.0} km of this field; it is not modelled",
            widest / 1000.0
        ));
    }
    notes
}

fn check(options: &HeightOptions) -> Result<()> {
    if let Some(cell) = options.cell_m
        && !cell.iter().all(|c| (1e-12..=1e12).contains(c))
    {
        let found = format!("{:?} × {:?}", cell[0], cell[1]);
        return Err(Error::setting("cell_m", found, "two lengths from 1e-12 to 1e12"));
    }
    if !options.z_scale.is_finite() {
        return Err(Error::setting("z_scale", options.z_scale.to_string(), "a finite number"));
    }
    Ok(())
}

/// Marks voids, converts heights and cells to metres and makes the field.
fn finish(path: &Path, raster: Raster, options: &HeightOptions) -> Result<HeightField> {
    let Raster { rows, cols, mut values, single, cell, unit_m, scale, nodata, mut voids, .. } =
        raster;
    if let Some(nodata) = options.nodata.or(nodata) {
        let marks = voids.get_or_insert_with(|| vec![false; values.len()]);
        for (mark, value) in marks.iter_mut().zip(&values) {
            *mark |= *value == nodata
                || value.is_nan() && nodata.is_nan()
                || single && nodata.is_finite() && *value as f32 == nodata as f32;
        }
    }
    let cell_m = match (options.cell_m, cell) {
        (Some(cell), _) | (None, Cell::Metres(cell)) => cell,
        (None, Cell::Unknown) => [1.0, 1.0],
        (None, Cell::Degrees { cell, latitude }) => {
            if !(-90.0..=90.0).contains(&latitude) {
                let found = format!("latitude {latitude:?} in the field's middle");
                return Err(Error::file(path, "georeference", found, "a latitude within ±90°"));
            }
            let [east, north] = metres_a_degree(latitude);
            [cell[0] * east, cell[1] * north]
        }
    };
    let factor = unit_m * options.z_scale;
    if factor != 1.0 || scale != [1.0, 0.0] {
        values.iter_mut().for_each(|v| *v = factor * (*v * scale[0] + scale[1]));
    }
    HeightField::new(rows, cols, &values, cell_m, voids).map_err(|error| match error {
        Error::Setting { name, found, expected } => Error::file(path, name, found, expected),
        other => other,
    })
}

/// The cell size in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell {
    /// Not in the file.
    Unknown,
    /// Columns and rows, metres.
    Metres([f64; 2]),
    /// Columns and rows, degrees, on a field whose centre is at this latitude (degrees).
    Degrees { cell: [f64; 2], latitude: f64 },
}

/// Metres in a degree of longitude and in a degree of latitude at `latitude` degrees.
///
/// The Fourier series of the radii of curvature of the WGS84 ellipsoid, as printed by the US
/// National Geospatial-Intelligence Agency; within 0.1 m per degree of the closed form (tested).
pub(crate) fn metres_a_degree(latitude: f64) -> [f64; 2] {
    let phi = latitude.to_radians();
    let east = 111_412.84 * phi.cos() - 93.5 * (3.0 * phi).cos() + 0.118 * (5.0 * phi).cos();
    let north = 111_132.92 - 559.82 * (2.0 * phi).cos() + 1.175 * (4.0 * phi).cos()
        - 0.0023 * (6.0 * phi).cos();
    [east, north]
}

/// Whether a header without a unit is in degrees: every corner is a longitude and latitude (±360,
/// ±90) *and* the cell is below 0.1. A projected grid with so small a cell at the origin of its
/// projection would be mistaken for degrees; the caller can override the cell size.
pub(crate) fn looks_like_degrees(x: [f64; 2], y: [f64; 2], cell: [f64; 2]) -> bool {
    x.iter().all(|x| x.abs() <= 360.0)
        && y.iter().all(|y| y.abs() <= 90.0)
        && cell.iter().all(|c| *c > 0.0 && *c < 0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_degree_follows_the_ellipsoid() {
        // WGS84: a = 6378137 m, 1/f = 298.257223563. Meridian radius a(1-e²)/(1-e² sin²)^1.5,
        // parallel radius a cos/(1-e² sin²)^0.5.
        let (a, f) = (6_378_137.0_f64, 1.0 / 298.257_223_563_f64);
        let e2 = f * (2.0 - f);
        for latitude in [-90.0, -60.0, -30.0, 0.0, 10.0, 44.5, 45.0, 60.0, 80.0, 89.9] {
            let phi = f64::to_radians(latitude);
            let w = 1.0 - e2 * phi.sin().powi(2);
            let degree = std::f64::consts::PI / 180.0;
            let expected =
                [a * phi.cos() / w.sqrt() * degree, a * (1.0 - e2) / w.powf(1.5) * degree];
            for (got, expected) in metres_a_degree(latitude).iter().zip(expected) {
                assert!((got - expected).abs() < 0.1, "{latitude}: {got} for {expected}");
            }
        }
    }
}
