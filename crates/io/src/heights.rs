//! Height fields from files: format by name and signature, then one common path.

mod asc;
pub mod geotiff;
mod hgt;
mod lzw;
mod mosaic;
mod projection;
mod raster;
mod raw;
mod sidecar;
pub mod size;
pub mod tif;
mod unit;
mod unpack;

use crate::arrays::{npy, npz};
use crate::exr;
use crate::georeference::Georeference;
use crate::open::{self, Format};
use crate::png;
use mosaic::{Choose, Tile, Window};
pub use raster::StoredHeights;
pub(crate) use raster::{Cell, Raster, is_nodata, looks_like_degrees, type_name};
use ridgelight::scene::HeightField;
use ridgelight::{Error, Result};
use sidecar::Sidecar;
use std::path::Path;

/// Options that override the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightOptions {
    /// Spacing of columns and of rows, metres, each positive; overrides the file's.
    pub cell_m: Option<[f64; 2]>,
    /// Factor on every height; any finite number, 1 by default.
    pub z_scale: f64,
    /// Whether `z_scale` was chosen for the unit of the heights: leaves out warnings that the file states no unit, or one that is
    /// not known.
    pub is_unit_known: bool,
    /// The file's "no data" value, before `z_scale`; NaN is allowed. Overrides the file's own, with a warning where heights
    /// have that.
    pub nodata: Option<f64>,
    /// The band of a TIFF or the plane of an NPY with three dimensions that holds the heights, from 1
    /// on. By default the first band of a TIFF, with a note where there are more.
    pub band: Option<u32>,
    /// West, south, east and north in the coordinates of the files: what lies outside is cut off.
    /// Cells that the box touches are kept.
    pub bbox: Option<[f64; 4]>,
}

impl Default for HeightOptions {
    fn default() -> Self {
        Self {
            cell_m: None,
            z_scale: 1.0,
            is_unit_known: false,
            nodata: None,
            band: None,
            bbox: None,
        }
    }
}

/// Reads a height field. The name sets the format, and the signature must match.
///
/// | name | heights | cell size | no data |
/// |---|---|---|---|
/// | `.png` | grey, 8 or 16 bits; values are metres | 1 × 1 | alpha 0, or the `tRNS` grey |
/// | `.exr` | the only channel, or the only `height`, `elevation`, `Z`, `Y` or `R`; f16, f32, u32 | 1 × 1 | |
/// | `.tif`, `.tiff` | a band of any integer or float type | GeoTIFF tags | GDAL's tag |
/// | `.hgt` | SRTM: square, 16-bit big-endian | 1/(n-1)° at the latitude in the name | -32768 |
/// | `.asc` | ESRI ASCII grid | header | header |
/// | `.npy` | 2-D, or a plane of 3-D [planes, rows, columns]; integers or floats of any size, order and endianness | 1 × 1 | |
/// | `.npz` | `elevation`, `heights`, `height`, `z` or the only 2-D array | `dx`, `dy` | |
///
/// Any of them may be packed: `.gz`, as `dem.tif.gz`, or a `.zip` that holds one of them, as `N44W072.hgt.zip`. A TIFF's
/// scale and offset (GDAL's metadata) apply to its values.
///
/// A file without a position has that of the world file beside it (`.tfw`, `.pgw`, `.wld`), and one without a coordinate
/// reference system that of the `.prj` beside it. [`parse_heights`] has neither.
///
/// Row 0 is the north. Cells in degrees are converted to metres by the WGS84 ellipsoid at the
/// latitude of the field's centre (one size for the whole field); so are the metres of Web Mercator, which are too long by 1/cos latitude. A header without a unit (`.asc`,
/// `.npz`, a TIFF without GeoKeys) is in degrees when its corners are longitudes and latitudes and
/// its cell is below 0.1, else in metres. A TIFF in feet is converted to
/// metres: its cells by its unit of length or its projected system, its heights by the unit of the band (GDAL's metadata)
/// or by its vertical unit or system.
///
/// # Errors
/// A file that cannot be read ([`Error::Io`]); options out of range ([`Error::Setting`]); an
/// invalid file ([`Error::File`]): more than 65 536 a side or 2³⁰ grid points (of a TIFF: in the box), truncation, colour,
/// rotation, a height that is not finite and not marked as no data.
pub fn read_heights(path: &Path, options: &HeightOptions) -> Result<HeightField> {
    Ok(read_field(path, options)?.field)
}

/// A height field and what its file states or lacks.
///
/// A program may hide the notes, but should show the warnings to its user.
#[derive(Clone, Debug)]
pub struct FieldFile {
    /// The heights.
    pub field: HeightField,
    /// The position: GeoTIFF, `.hgt` with its corner in its name, `.asc`, a world file.
    pub georeference: Option<Georeference>,
    /// How the file stores its heights; of several files, the first.
    pub stored: StoredHeights,
    /// What was chosen or converted, a sentence each.
    pub notes: Vec<String>,
    /// What may be wrong, a sentence each: guesses, and what of the file is not read.
    pub warnings: Vec<String>,
}

impl FieldFile {
    /// A note on a field that is more than 10 km wide, for what depends on distant ground: the Earth's curvature is not modelled.
    pub fn curvature_note(&self) -> Option<String> {
        let [cell_x, cell_y] = self.field.cell_m();
        let [width, height] =
            [cell_x * (self.field.cols() - 1) as f64, cell_y * (self.field.rows() - 1) as f64];
        let widest = width.max(height);
        if widest <= WIDE_M {
            return None;
        }
        let drop = widest * widest / (2.0 * EARTH_M);
        let of = match widest < FLAT_M {
            true => {
                format!(" drops {drop:.0} m over the {:.0} km of this field; it", widest / 1000.0)
            }
            false => ", which this field goes far around,".to_owned(),
        };
        Some(format!("the Earth's curvature{of} is not modelled"))
    }
}

/// [`read_heights`], with the position and what was assumed.
///
/// ```no_run
/// # fn main() -> ridgelight::Result<()> {
/// let field = ridgelight_io::read_field("dem.tif".as_ref(), &Default::default())?.field;
/// // Heights are relative to a base.
/// let heights: Vec<f64> =
///     field.heights_m().iter().map(|height| f64::from(*height) + field.base_m()).collect();
/// # assert_eq!(heights.len(), field.rows() * field.cols());
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// As [`read_heights`].
pub fn read_field(path: &Path, options: &HeightOptions) -> Result<FieldFile> {
    check(options)?;
    finish(path, decoded(path, &open::read(path)?, options, Sidecar::beside(path))?, options)
}

/// Several files as one field, each placed by its position.
///
/// The files have the same coordinate reference system and the same cells, and lie apart by whole
/// cells. Where they overlap, the first that has a height gives it. Grid points in no file are voids. TIFFs outside a box
/// are not decoded.
///
/// # Errors
/// As [`read_heights`]; a file without a position, of another system or of other cells, or shifted by
/// a part of a cell; files that are far apart.
pub fn read_mosaic<P: AsRef<Path>>(paths: &[P], options: &HeightOptions) -> Result<FieldFile> {
    check(options)?;
    let first: &Path = match paths {
        [] => return Err(Error::setting("files", "none", "at least one")),
        [path] => return read_field(path.as_ref(), options),
        [first, ..] => first.as_ref(),
    };
    let tiles =
        paths.iter().map(|path| tile(path.as_ref(), options)).collect::<Result<Vec<_>>>()?;
    finish(first, mosaic::joined(tiles, options.bbox, options.is_unit_known)?, options)
}

/// A file of a mosaic, without the values that are not near the box: it may lie outside some files.
fn tile(path: &Path, options: &HeightOptions) -> Result<Tile> {
    let choose = |at: Option<&Georeference>, size: [usize; 2]| -> Result<Window> {
        Ok(match (at, options.bbox) {
            (Some(at), Some(bbox)) => Window::near(at, size, bbox),
            _ => Window::whole(size),
        })
    };
    let (raster, window) = part(path, &open::read(path)?, options, Sidecar::beside(path), &choose)?;
    Ok(Tile { path: path.to_owned(), raster, window })
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
    finish(name, decoded(name, bytes, options, Sidecar::default())?, options)
}

/// A file's grid, cut to the box, heights in metres.
fn decoded(name: &Path, bytes: &[u8], options: &HeightOptions, sidecar: Sidecar) -> Result<Raster> {
    let choose = |at: Option<&Georeference>, size: [usize; 2]| match options.bbox {
        Some(bbox) => Window::of(name, at, size, bbox),
        None => Ok(Window::whole(size)),
    };
    let (raster, window) = part(name, bytes, options, sidecar, &choose)?;
    Ok(if options.bbox.is_some() { window.placed(raster) } else { raster })
}

/// A file's grid with the values of a window, heights in metres. Its size and position are those of the file.
fn part(
    name: &Path,
    bytes: &[u8],
    options: &HeightOptions,
    sidecar: Sidecar,
    choose: Choose,
) -> Result<(Raster, Window)> {
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
        // Its strips and tiles outside the window are not read.
        Format::Tiff => {
            let (mut raster, window) = tif::heights(name, bytes, options.band, sidecar, choose)?;
            raster.interpret(options);
            return Ok((raster, window));
        }
        Format::Npy | Format::Hdr => npy::heights(name, bytes, options.band),
        _ if options.band.is_some_and(|band| band != 1) => {
            Err(tif::no_band(name, options.band.unwrap_or_default(), 1))
        }
        Format::Png => png::heights(name, bytes),
        Format::Exr => exr::heights(name, bytes),
        Format::Hgt => hgt::heights(name, bytes, options.cell_m.is_some()),
        Format::Asc => asc::heights(name, bytes),
        Format::Npz => npz::heights(name, bytes),
    }?;
    sidecar.complete(&mut raster);
    let window = choose(raster.georeference.as_ref(), [raster.rows, raster.cols])?;
    window.cut(&mut raster);
    raster.interpret(options);
    Ok((raster, window))
}

/// The Earth's mean radius, metres.
const EARTH_M: f64 = 6_371_000.0;
/// Fields as wide as this get a note on the curvature: it drops 7.8 m over them.
const WIDE_M: f64 = 10_000.0;

/// Beyond it the drop is no longer that of a parabola.
const FLAT_M: f64 = 1_000_000.0;

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
    if let Some(bbox) = options.bbox {
        let [west, south, east, north] = bbox;
        if !(bbox.iter().all(|x| x.is_finite()) && west < east && south < north) {
            let found = bbox.map(|x| x.to_string()).join(",");
            let expected = "XMIN,YMIN,XMAX,YMAX: each minimum below its maximum";
            return Err(Error::setting("bbox", found, expected));
        }
    }
    if options.band == Some(0) {
        return Err(Error::setting("band", "0", "a whole number, 1 or more"));
    }
    Ok(())
}

/// Converts cells to metres and makes the field.
fn finish(path: &Path, mut raster: Raster, options: &HeightOptions) -> Result<FieldFile> {
    let mut notes = std::mem::take(&mut raster.notes);
    let mut warnings = std::mem::take(&mut raster.warnings);
    warnings.extend(raster.nodata_warnings(options.nodata));
    let size = [raster.rows, raster.cols];
    let cell_m = match options.cell_m {
        Some(cell) => cell,
        None => {
            notes.extend(raster.cell_notes());
            warnings.extend(raster.cell_warnings());
            let cell_m = raster.cell.metres(path)?;
            let at =
                raster.georeference.as_ref().filter(|_| matches!(raster.cell, Cell::Metres(_)));
            warnings.extend(at.and_then(|at| projection::scale_warning(at, size, cell_m)));
            cell_m
        }
    };
    let has_cell = options.cell_m.is_some();
    let unknown = |at| projection::unknown_warning(at, has_cell);
    warnings.extend(raster.georeference.as_ref().and_then(unknown));
    let stored = raster.stored();
    let Raster { rows, cols, values, voids, georeference, .. } = raster;
    notes.extend(georeference.as_ref().and_then(|at| projection::north_note(at, rows, cols)));
    let field = HeightField::new(rows, cols, &values, cell_m, voids);
    let field = field.map_err(|error| match error {
        Error::Setting { name, found, expected } => {
            let hint = if found == "NaN" { "; `nodata` nan makes voids of NaN" } else { "" };
            Error::file(path, name, found, expected + hint)
        }
        other => other,
    })?;
    if let Some(voids) = field.voids() {
        let share = voids.iter().filter(|v| **v).count() as f64 / voids.len() as f64;
        let text = format!(
            "{:.3} % of the grid points are voids; their heights are filled from those around them, their results left out",
            100.0 * share
        );
        if share >= 0.5 {
            warnings.push(text + "; half of the field or more is empty");
        } else {
            let hint = "; for results there, fill them first: `gdal_fillnodata.py in.tif out.tif`";
            notes.push(text + hint);
        }
    }
    Ok(FieldFile { field, georeference, stored, notes, warnings })
}
