//! A decoded grid: values, cells and position, before they become a height field.

use super::HeightOptions;
use crate::georeference::Georeference;
use ridgelight::{Error, Result};
use std::path::Path;

/// How a file stores its heights.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredHeights {
    /// `int16`, `float32` and so on; `text` for an `.asc`.
    pub data_type: String,
    /// The file's value for no data, before scale and offset.
    pub nodata: Option<f64>,
    /// A height is the value times the first, plus the second, in the file's unit.
    pub scale: [f64; 2],
    /// Metres in the file's unit of height; `None` where the file states none that is known, and the unit is read as a metre.
    pub unit_m: Option<f64>,
    /// Whether the file states the size of its cells.
    pub has_cell_size: bool,
}

/// The name of a type of values: `kind` is that of NumPy, `i`, `u` or `f`.
pub(crate) fn type_name(kind: u8, bits: usize) -> String {
    let name = match kind {
        b'i' => "int",
        b'u' => "uint",
        _ => "float",
    };
    format!("{name}{bits}")
}

/// A decoded grid, before interpretation.
pub(crate) struct Raster {
    pub rows: usize,
    pub cols: usize,
    /// Row-major, row 0 in the north, in the file's unit.
    pub values: Vec<f64>,
    /// The type of the file's values.
    pub data_type: String,
    /// Whether the file holds 16- or 32-bit floats. A no-data value printed in decimal is then
    /// rounded to that type before it is compared.
    pub single: bool,
    pub cell: Cell,
    /// Metres in the file's unit of cells; 1 where it states none.
    pub cell_unit_m: f64,
    /// Metres in the file's unit of height, where the file states one that is known.
    pub unit_m: Option<f64>,
    /// What is assumed of that unit, where the file does not.
    pub unit_warning: Option<String>,
    /// A height is the value times the first, plus the second.
    pub scale: [f64; 2],
    pub nodata: Option<f64>,
    /// No-data values of the file that another one replaces, and how many heights have them.
    pub replaced: Vec<(f64, usize)>,
    /// The file's own mask of voids, if any.
    pub voids: Option<Vec<bool>>,
    /// Where the grid lies, if the file states it.
    pub georeference: Option<Georeference>,
    /// Whether the values are 8-bit integers.
    pub is_8_bit: bool,
    /// What the reader chose or converted.
    pub notes: Vec<String>,
    /// What may be wrong: guesses, and parts of the file that are not read.
    pub warnings: Vec<String>,
}

impl Raster {
    /// Values without further information.
    pub fn bare(rows: usize, cols: usize, values: Vec<f64>) -> Self {
        Self {
            rows,
            cols,
            values,
            data_type: String::new(),
            single: false,
            cell: Cell::Unknown,
            cell_unit_m: 1.0,
            unit_m: None,
            unit_warning: None,
            scale: [1.0, 0.0],
            nodata: None,
            replaced: Vec::new(),
            voids: None,
            georeference: None,
            is_8_bit: false,
            notes: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

impl Raster {
    /// How the file stores the heights.
    pub fn stored(&self) -> StoredHeights {
        let Self { nodata, scale, unit_m, .. } = *self;
        let has_cell_size = self.cell != Cell::Unknown;
        StoredHeights { data_type: self.data_type.clone(), nodata, scale, unit_m, has_cell_size }
    }

    /// Marks voids and converts heights to metres, with notes on what was converted and warnings of what may be wrong.
    pub fn interpret(&mut self, options: &HeightOptions) {
        let own = self.nodata;
        if let Some(nodata) = options.nodata.or(own) {
            let single = self.single;
            let is_marked = |value: f64, nodata: f64| is_nodata(value, nodata, single);
            let marks = self.voids.get_or_insert_with(|| vec![false; self.values.len()]);
            for (mark, value) in marks.iter_mut().zip(&self.values) {
                *mark |= is_marked(*value, nodata);
            }
            let is_lost = |value: f64, own: f64| is_marked(value, own) && !is_marked(value, nodata);
            let count = |own| self.values.iter().filter(|value| is_lost(**value, own)).count();
            let lost = own.map(|own| (own, count(own)));
            self.replaced.extend(lost.filter(|(_, count)| *count > 0));
        }
        if options.nodata.is_none()
            && let Some((mark, count)) = self.likely_voids()
        {
            let of = if count == 1 { "1 height is" } else { &format!("{count} heights are") };
            self.warnings.push(format!(
                "{of} {mark}, which often marks a void, and the file does not state it as no data; `nodata` {mark} makes voids of them"
            ));
        }
        let unit_m = self.unit_m.unwrap_or(1.0);
        let (factor, [scale, offset]) = (unit_m * options.z_scale, self.scale);
        if factor != 1.0 || self.scale != [1.0, 0.0] {
            self.values.iter_mut().for_each(|v| *v = factor * (*v * scale + offset));
        }
        if self.scale != [1.0, 0.0] {
            let text = format!("scale {scale} and offset {offset} of the file are applied");
            self.notes.push(text);
        }
        if unit_m != 1.0 {
            self.notes.push(format!("heights are in units of {unit_m} m and become metres"));
        }
        let unit_warning = self.unit_warning.take();
        let is_unit_open =
            self.unit_m.is_none() && unit_warning.is_none() && !options.is_unit_known;
        self.warnings.extend(unit_warning.filter(|_| !options.is_unit_known));
        if self.is_8_bit {
            let text = "heights are 8-bit integers, as in a picture: slopes have steps";
            self.warnings.push(text.to_owned());
        }
        if is_unit_open {
            self.warnings.extend(self.likely_codes());
        }
    }

    /// A warning about heights that are probably pixel values, not metres. Marks of voids that no one states have their own warning.
    fn likely_codes(&self) -> Option<String> {
        let is_void = |i: usize| self.voids.as_ref().is_some_and(|voids| voids[i]);
        let is_mark = |v: f64| MARKS.contains(&v) || self.replaced.iter().any(|(own, _)| *own == v);
        let all = self.values.iter().enumerate().filter(|(i, v)| !is_void(*i) && !is_mark(**v));
        let (mut low, mut high, mut is_whole) = (f64::MAX, f64::MIN, true);
        for (_, v) in all {
            (low, high) = (low.min(*v), high.max(*v));
            is_whole &= v.fract() == 0.0;
        }
        let is_code = !self.is_8_bit && is_whole && self.scale == [1.0, 0.0];
        let what = if is_code && [low, high] == [0.0, 255.0] {
            "heights are whole numbers from 0 to 255, as in an 8-bit picture".to_owned()
        } else if high - low > LARGEST_RELIEF_M && high.abs().max(low.abs()) < HUGE {
            format!("heights span {:.0} m, more than the relief of any planet", high - low)
        } else {
            return None;
        };
        Some(format!(
            "{what}, and the file states no unit: set `z_scale` to the metres per unit, or to 1 if they are metres"
        ))
    }

    /// Warnings of heights with a no-data value of the file that `nodata` replaces.
    pub fn nodata_warnings(&self, nodata: Option<f64>) -> Vec<String> {
        // All digits of the largest floats are no help.
        let short = |value: f64| {
            let is_long = value.is_finite() && value.abs() >= 1e15;
            if is_long { format!("{value:e}") } else { value.to_string() }
        };
        let warning = |nodata: f64, own: f64, count: usize| {
            let have = if count == 1 { "1 height has" } else { &format!("{count} heights have") };
            format!("`nodata {}` replaces the file's {}, which {have}", short(nodata), short(own))
        };
        let all = nodata.into_iter().flat_map(|nodata| {
            self.replaced.iter().map(move |(own, count)| (nodata, *own, *count))
        });
        all.map(|(nodata, own, count)| warning(nodata, own, count)).collect()
    }

    /// The lowest value and how often it occurs, where it is one of the usual marks of voids.
    fn likely_voids(&self) -> Option<(f64, usize)> {
        let is_void = |i: usize| self.voids.as_ref().is_some_and(|voids| voids[i]);
        let heights =
            || self.values.iter().enumerate().filter(|(i, _)| !is_void(*i)).map(|(_, v)| *v);
        let lowest = heights().fold(f64::INFINITY, f64::min);
        let count = || heights().filter(|v| *v == lowest).count();
        MARKS.contains(&lowest).then(|| (lowest, count()))
    }

    /// How cells become metres.
    pub fn cell_notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.cell_unit_m != 1.0 {
            let unit_m = self.cell_unit_m;
            notes.push(format!("cells are in units of {unit_m} m and become metres"));
        }
        let Some((latitude, cell)) = self.cell.degrees() else { return notes };
        let [east, north] = metres_a_degree(latitude);
        let of = match self.cell {
            Cell::Mercator { .. } => "Web Mercator metres",
            Cell::Degrees { .. } => "degrees",
            Cell::Unknown | Cell::Metres(_) => return notes,
        };
        notes.push(format!(
            "cells of {:.1} x {:.1} m, from {of} at latitude {latitude:.2}",
            cell[0] * east,
            cell[1] * north
        ));
        notes
    }

    /// Warnings of assumed cell sizes and units, and of the error of one cell width for all rows.
    pub fn cell_warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        match self.cell {
            Cell::Unknown => {
                warnings.push("the file has no cell size: `cell_m` 1 is assumed".to_owned());
            }
            Cell::Degrees { is_guess: true, .. } => warnings.push(
                "no reference system: read as degrees, as its numbers fit; otherwise use `cell_m`"
                    .to_owned(),
            ),
            Cell::Metres(_) => {
                let unknown = self.georeference.as_ref().filter(|at| at.keys.entries.is_empty());
                if unknown
                    .is_some_and(|at| could_be_degrees(at.extent(self.rows, self.cols), at.cell))
                {
                    warnings.push(
                        "no reference system: cells are read as metres, but the corners could be longitudes and latitudes; \
                         if they are, write the system into a file: `gdal_translate -a_srs EPSG:4326 in.asc out.tif`"
                            .to_owned(),
                    );
                }
            }
            _ => {}
        }
        let error = self.cell.width_error(self.rows);
        if let Some(error) = error.filter(|error| *error > WIDTH_NOTED) {
            warnings.push(format!(
                "all rows take the cell width of the centre: in the first or the last row the error is {:.0} %; to avoid it, \
                 reproject with `gdalwarp -t_srs` to a local system such as UTM",
                100.0 * error
            ));
        }
        warnings
    }
}

/// The usual marks of voids.
const MARKS: [f64; 3] = [-9999.0, -32768.0, -99999.0];

/// Above that of Mars, from Olympus Mons to Hellas: 29.5 km.
const LARGEST_RELIEF_M: f64 = 30_000.0;

/// No height is so large. Floats near the largest mark voids, often written with few digits.
const HUGE: f64 = 1e30;

/// Whether a value is a file's value for no data. `single`: values are f32, or are compared as such.
pub(crate) fn is_nodata(value: f64, nodata: f64, single: bool) -> bool {
    value == nodata
        || value.is_nan() && nodata.is_nan()
        || single && nodata.is_finite() && value as f32 == nodata as f32
        || nodata.abs() > HUGE && value.abs() > HUGE && value.signum() == nodata.signum()
}

/// The cell size in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell {
    /// Not in the file.
    Unknown,
    /// Columns and rows, metres.
    Metres([f64; 2]),
    /// Columns and rows, degrees, on a field whose centre is at this latitude (degrees). A guess where the file has no
    /// reference system.
    Degrees { cell: [f64; 2], latitude: f64, is_guess: bool },
    /// Columns and rows in the metres of Web Mercator, on a field whose centre has this northing.
    Mercator { cell: [f64; 2], northing_m: f64 },
}

/// An error of the width of cells up to which there is no warning.
const WIDTH_NOTED: f64 = 0.02;

/// The radius of Web Mercator's sphere.
const EQUATOR_M: f64 = 6_378_137.0;

impl Cell {
    /// The same cells in a field whose centre has this northing, in the file's unit.
    pub fn about(self, northing: f64) -> Self {
        match self {
            Self::Degrees { cell, is_guess, .. } => {
                Self::Degrees { cell, latitude: northing, is_guess }
            }
            Self::Mercator { cell, .. } => Self::Mercator { cell, northing_m: northing },
            other => other,
        }
    }

    /// The latitude of the centre in degrees, and the cells in degrees.
    fn degrees(self) -> Option<(f64, [f64; 2])> {
        match self {
            Self::Degrees { cell, latitude, .. } => Some((latitude, cell)),
            // y is R asinh(tan φ), so a step of y is one of φ times R / cos φ.
            Self::Mercator { cell, northing_m } => {
                let latitude = (northing_m / EQUATOR_M).sinh().atan();
                let degrees = (1.0 / EQUATOR_M).to_degrees();
                let cell = [cell[0] * degrees, cell[1] * degrees * latitude.cos()];
                Some((latitude.to_degrees(), cell))
            }
            Self::Unknown | Self::Metres(_) => None,
        }
    }

    /// By how much the width of cells in the middle differs from that in the first or the last of so many rows, over the latter.
    fn width_error(self, rows: usize) -> Option<f64> {
        let half = (rows.max(1) - 1) as f64 / 2.0;
        let (middle, _) = self.degrees()?;
        let ends = [-half, half].map(|step| match self {
            Self::Degrees { cell, latitude, .. } => Some(latitude + step * cell[1]),
            Self::Mercator { cell, northing_m } => {
                let moved = Self::Mercator { cell, northing_m: northing_m + step * cell[1] };
                moved.degrees().map(|(latitude, _)| latitude)
            }
            Self::Unknown | Self::Metres(_) => None,
        });
        let width = |latitude: f64| metres_a_degree(latitude.clamp(-90.0, 90.0))[0];
        let error = |latitude: &f64| (width(middle) / width(*latitude) - 1.0).abs();
        ends.iter().flatten().map(error).reduce(f64::max)
    }

    /// Metres, 1 where unknown.
    pub fn metres(self, path: &Path) -> Result<[f64; 2]> {
        match (self, self.degrees()) {
            (Self::Metres(cell), _) => Ok(cell),
            (_, Some((latitude, cell))) if (-90.0..=90.0).contains(&latitude) => {
                let [east, north] = metres_a_degree(latitude);
                Ok([cell[0] * east, cell[1] * north])
            }
            (_, Some((latitude, _))) => {
                let found = format!("latitude {latitude:?} in the field's middle");
                Err(Error::file(path, "georeference", found, "a latitude within ±90°"))
            }
            (_, None) => Ok([1.0, 1.0]),
        }
    }
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

/// Whether the corners of cells of 0.1 to 5 units, without a reference system, could be longitudes and latitudes. Local grids often
/// begin at (0, 0) or lie about it.
fn could_be_degrees([west, south, east, north]: [f64; 4], cell: [f64; 2]) -> bool {
    let is_on_earth = [west, east].iter().all(|x| x.abs() <= 360.0)
        && [south, north].iter().all(|y| y.abs() <= 90.0);
    let has_origin = (west - cell[0]..=east + cell[0]).contains(&0.0)
        && (south - cell[1]..=north + cell[1]).contains(&0.0);
    cell.iter().all(|c| (0.1..=5.0).contains(c)) && is_on_earth && !has_origin
}

/// Whether a header without a unit is in degrees: every corner is a longitude and latitude (±360, ±90) *and* either the cell is
/// below 0.1, or the grid goes round the Earth. A projected grid with so small a cell at the origin of its projection would be
/// mistaken for degrees; the caller can override the cell size.
pub(crate) fn looks_like_degrees(x: [f64; 2], y: [f64; 2], cell: [f64; 2]) -> bool {
    let is_fine = cell.iter().all(|c| *c > 0.0 && *c < 0.1);
    // A column more or less than the circle; grids of centres reach half a cell beyond.
    let is_round = ((x[1] - x[0]).abs() - 360.0).abs() <= cell[0].abs()
        && (y[1] - y[0]).abs() >= 100.0
        && cell.iter().all(|c| *c > 0.0 && *c <= 30.0);
    let beyond = if is_round { cell.map(|c| 0.5 * c) } else { [0.0; 2] };
    x.iter().all(|x| x.abs() <= 360.0 + beyond[0])
        && y.iter().all(|y| y.abs() <= 90.0 + beyond[1])
        && (is_fine || is_round)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fine cells, or a grid round the Earth, also of centres; neither a coarse part of it nor a grid beyond the poles.
    #[test]
    fn degrees_are_guessed_from_numbers() {
        for (x, y, cell, is_guessed) in [
            ([7.0, 8.0], [46.0, 47.0], [0.01; 2], true),
            ([7.0, 8.0], [46.0, 47.0], [0.1; 2], false),
            ([-180.0, 180.0], [-90.0, 90.0], [10.0; 2], true),
            ([-0.5, 359.5], [-90.5, 90.5], [1.0; 2], true),
            ([0.0, 300.0], [0.0, 80.0], [1.0; 2], false),
            ([0.0, 360.0], [0.0, 120.0], [1.0; 2], false),
            ([-1.25, 361.25], [-90.0, 90.0], [2.5, 1.0], true),
            ([-360.0, 360.0], [-90.0, 90.0], [1.0; 2], false),
            ([-200.0, 200.0], [-75.0, 75.0], [1.0; 2], false),
            ([500_000.0, 500_360.0], [-90.0, 90.0], [1.0; 2], false),
        ] {
            assert_eq!(looks_like_degrees(x, y, cell), is_guessed, "{x:?} {y:?} {cell:?}");
        }
    }

    /// From 59.5 to 60.5 degrees: cos 59.5° / cos 60° is 1.015. From 57.5 to 62.5: 1.075. Of Web Mercator the same.
    #[test]
    fn one_width_for_all_rows_has_its_error() {
        let of = |cell, rows| Raster { cell, ..Raster::bare(rows, 2, vec![0.0; 2 * rows]) };
        let northing = |latitude: f64| EQUATOR_M * latitude.to_radians().tan().asinh();
        for (half_deg, rows) in [(0.5, 100), (2.5, 100)] {
            let degrees = Cell::Degrees {
                cell: [0.01, 2.0 * half_deg / 100.0],
                latitude: 60.0,
                is_guess: false,
            };
            let middle = (northing(60.0 + half_deg) + northing(60.0 - half_deg)) / 2.0;
            let cell_y = (northing(60.0 + half_deg) - northing(60.0 - half_deg)) / 100.0;
            let mercator = Cell::Mercator { cell: [100.0, cell_y], northing_m: middle };
            for cell in [degrees, mercator] {
                let (centre, _) = cell.degrees().unwrap();
                let of_rows = 99.0 / 100.0;
                let ends = [60.0 - of_rows * half_deg, 60.0 + of_rows * half_deg];
                let error =
                    |end: f64| (centre.to_radians().cos() / end.to_radians().cos() - 1.0).abs();
                let expected = f64::max(error(ends[0]), error(ends[1]));
                let found = cell.width_error(rows).unwrap();
                // The ellipsoid changes widths by less than e² of their change.
                assert!((found / expected - 1.0).abs() < 0.01, "{cell:?}: {found} for {expected}");
                let warns = of(cell, rows).cell_warnings().concat().contains("width of the centre");
                assert_eq!(warns, half_deg > 1.0, "{cell:?}");
            }
        }
        assert_eq!(Cell::Metres([1.0; 2]).width_error(100), None);
    }

    /// GDAL's tools write the least f32 with few digits. Values of such a size are no heights, so nothing else is lost.
    #[test]
    fn the_largest_floats_mark_voids_with_few_digits() {
        let least = f64::from(f32::MIN);
        let mut raster = Raster {
            nodata: Some(-3.4e38),
            single: true,
            ..Raster::bare(1, 3, vec![least, 5.0, -least])
        };
        raster.interpret(&HeightOptions::default());
        assert_eq!(raster.voids, Some(vec![true, false, false]));
    }

    /// A usual mark that the file does not name gets a warning, also where it names another; not where the user names one.
    #[test]
    fn likely_voids_get_a_warning() {
        let warned = |own: Option<f64>, given: Option<f64>| {
            let mut raster =
                Raster { nodata: own, ..Raster::bare(1, 4, vec![-9999.0, 40.0, -1.0, -9999.0]) };
            raster.interpret(&HeightOptions { nodata: given, ..HeightOptions::default() });
            raster.warnings.iter().any(|text| text.starts_with("2 heights are -9999"))
        };
        assert_eq!([warned(None, None), warned(Some(-1.0), None)], [true; 2]);
        assert_eq!([warned(Some(-9999.0), None), warned(None, Some(-1.0))], [false; 2]);
    }

    /// Whole numbers from 0 to 255 and a span above the largest relief get a warning, unless the user or the file states a unit.
    #[test]
    fn likely_codes_get_a_warning() {
        let warned = |values: &[f64], unit_m: Option<f64>, is_unit_known: bool| {
            let mut raster = Raster { unit_m, ..Raster::bare(1, values.len(), values.to_vec()) };
            raster.interpret(&HeightOptions { is_unit_known, ..HeightOptions::default() });
            raster.warnings.iter().any(|text| text.contains("the file states no unit"))
        };
        for (values, is_likely) in [
            (&[0.0, 17.0, 255.0][..], true),
            (&[0.0, 17.5, 255.0], false),
            (&[1.0, 17.0, 255.0], false),
            (&[0.0, 65_535.0], true),
            (&[0.0, 32_767.0], true),
            (&[-10_900.0, 8_849.0], false),
            // Mars, from MOLA.
            (&[-8_201.0, 21_241.0], false),
            (&[-32_768.0, 8_849.0], false),
            (&[0.0, -3e38], false),
        ] {
            assert_eq!(warned(values, None, false), is_likely, "{values:?}");
            assert!(!warned(values, Some(1.0), false) && !warned(values, None, true), "{values:?}");
        }
        let mut unknown = Raster {
            unit_warning: Some("mGal".to_owned()),
            ..Raster::bare(1, 2, vec![0.0, 65_535.0])
        };
        unknown.interpret(&HeightOptions::default());
        assert_eq!(unknown.warnings, ["mGal"]);
    }

    /// Corners on the Earth and cells of a tenth of a degree or more; neither about the origin nor of fine cells.
    #[test]
    fn coarse_degrees_get_a_warning() {
        for (extent, cell, could_be) in [
            ([7.0, 46.0, 9.5, 48.5], [0.25; 2], true),
            ([-125.0, 25.0, -65.0, 50.0], [0.25; 2], true),
            ([0.0, 0.0, 9.5, 48.5], [0.25; 2], false),
            ([-0.5, -0.5, 9.5, 48.5], [1.0; 2], false),
            ([-30.0, -30.0, 30.0, 30.0], [0.5; 2], false),
            ([7.0, 46.0, 9.5, 95.0], [0.25; 2], false),
            ([500.0, 46.0, 510.0, 48.5], [1.0; 2], false),
            ([7.0, 46.0, 47.0, 86.0], [10.0; 2], false),
            ([7.0, 46.0, 8.0, 47.0], [0.05; 2], false),
        ] {
            assert_eq!(could_be_degrees(extent, cell), could_be, "{extent:?}");
        }
        let text = |west: f64| {
            format!("ncols 2\nnrows 1\nxllcorner {west}\nyllcorner 46\ncellsize 0.25\n1 2\n")
        };
        for (west, is_warned) in [(7.0, true), (500_000.0, false)] {
            let file = std::path::Path::new("a.asc");
            let read =
                crate::heights::parse_field(file, text(west).as_bytes(), &HeightOptions::default());
            let warnings = read.unwrap().warnings.concat();
            assert_eq!(warnings.contains("could be longitudes"), is_warned, "{west}: {warnings}");
        }
    }

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
