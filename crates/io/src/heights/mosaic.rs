//! Several grids as one, and parts of grids, by their positions.

use super::{Cell, Raster, StoredHeights};
use crate::georeference::Georeference;
use crate::open;
use ridgelight::{Error, Result};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The largest shift from whole cells, in cells: positions and cell sizes are rounded in files.
const SHIFT: f64 = 0.01;
/// Longitudes of the same meridian differ by these, degrees.
const TURNS: [f64; 2] = [360.0, -360.0];
/// The most grid points of a mosaic, for each grid point in its files.
const SPREAD: u64 = 64;

/// A file of a mosaic. Size and position are those of the file, values and voids those of the window.
pub(super) struct Tile {
    pub path: PathBuf,
    pub raster: Raster,
    pub window: Window,
}

/// A grid that holds all tiles, or their part in a box. Its heights are those of the first tile that has one there.
/// `is_unit_known` is that of [`HeightOptions`](super::HeightOptions).
pub(super) fn joined(
    tiles: Vec<Tile>,
    bbox: Option<[f64; 4]>,
    is_unit_known: bool,
) -> Result<Raster> {
    let Tile { path: first, raster: grid, .. } = &tiles[0];
    let (first, at) = (first.clone(), placed(first, grid)?.clone());
    let (cell, cell_unit_m) = (grid.cell, grid.cell_unit_m);
    let StoredHeights { data_type, nodata, scale, unit_m, .. } = grid.stored();
    let mut corners = Vec::with_capacity(tiles.len());
    for Tile { path, raster, .. } in &tiles {
        let own = placed(path, raster)?;
        if std::mem::discriminant(&raster.cell) != std::mem::discriminant(&cell)
            || !own.keys.is_same_crs(&at.keys)
        {
            let name = |at: &Georeference| at.keys.crs().unwrap_or_else(|| "none".to_owned());
            let expected = format!("{} as in {}", name(&at), first.display());
            return Err(Error::file(path, "coordinate reference system", name(own), expected));
        }
        corners.push(whole_cells(path, raster, own, (&first, &at))?);
    }
    if matches!(cell, Cell::Degrees { .. }) {
        cross_antimeridian(&tiles, &mut corners, at.cell[0]);
    }
    let ends = tiles.iter().zip(&corners).map(|(Tile { raster, .. }, corner)| {
        [corner[0] + raster.rows as i64, corner[1] + raster.cols as i64]
    });
    let [top, left] = [0, 1].map(|axis| corners.iter().map(|c| c[axis]).min().unwrap_or(0));
    let [bottom, right] = ends.fold([i64::MIN; 2], |[b, r], [y, x]| [b.max(y), r.max(x)]);
    let size = [bottom.abs_diff(top) as usize, right.abs_diff(left) as usize];
    let window = match bbox {
        Some(bbox) => {
            let at = shifted(&at, [top, left]);
            let of = |turn: f64| Window::of(&first, Some(&at), size, turned(bbox, turn));
            let is_degrees = matches!(cell, Cell::Degrees { .. });
            of(0.0).or_else(|error| {
                let mut turns = TURNS.into_iter().filter(|_| is_degrees);
                turns.find_map(|turn| of(turn).ok()).ok_or(error)
            })?
        }
        None => Window::whole(size),
    };
    let (rows, cols) = size_of_part(&first, "mosaic", [window.rows.len(), window.cols.len()])?;
    // Headers of files outside the box may state any size.
    let held = tiles.iter().fold(0_u64, |held, Tile { raster, .. }| {
        held.saturating_add((raster.rows as u64).saturating_mul(raster.cols as u64))
    });
    if (rows * cols) as u64 > SPREAD.saturating_mul(held) {
        let found = format!("{cols} x {rows} grid points, {held} of them in files");
        let expected = format!("at most {SPREAD} times as many grid points as the files hold");
        return Err(Error::file(&first, "mosaic", found, expected));
    }
    // The grid's first row and column from those of the first tile.
    let [top, left] = [top + window.rows.start as i64, left + window.cols.start as i64];
    let values = open::zeros(&first, rows * cols)?;
    let bare = Raster::bare(rows, cols, values);
    let mut whole = Raster { data_type, cell_unit_m, nodata, scale, unit_m, ..bare };
    let mut sums = Sums::default();
    // Notes and warnings of the files.
    let mut remarks = [Remarks::default(), Remarks::default()];
    let (given, mut units) = (tiles.len(), Vec::new());
    // Whether a file holds the grid point, and whether none has its height.
    let mut is_held = vec![false; rows * cols];
    let mut voids = vec![true; rows * cols];
    for (Tile { path, raster, window }, [row, col]) in tiles.into_iter().zip(corners) {
        let [row, col] =
            [row + window.rows.start as i64 - top, col + window.cols.start as i64 - left];
        let width = window.cols.len();
        let mut is_used = false;
        for (i, value) in raster.values.iter().enumerate() {
            let [y, x] = [row + (i / width) as i64, col + (i % width) as i64];
            if !(0..rows as i64).contains(&y) || !(0..cols as i64).contains(&x) {
                continue;
            }
            let to = y as usize * cols + x as usize;
            (is_held[to], is_used) = (true, true);
            if raster.voids.as_ref().is_some_and(|voids| voids[i]) {
                continue;
            }
            if !value.is_finite() {
                let [y, x] = [window.rows.start + i / width, window.cols.start + i % width];
                let expected = "a finite number, or one marked as no-data (`nodata`)";
                let place = format!("height at row {y}, column {x}");
                return Err(Error::file(&path, place, format!("{value:?}"), expected));
            }
            if voids[to] {
                (whole.values[to], voids[to]) = (*value, false);
            } else {
                sums.overlap(whole.values[to] - value);
            }
        }
        if !is_used {
            continue;
        }
        units.push((path.display().to_string(), raster.unit_m));
        for (own, count) in raster.replaced {
            match whole.replaced.iter_mut().find(|(mark, _)| mark.to_bits() == own.to_bits()) {
                Some((_, sum)) => *sum += count,
                None => whole.replaced.push((own, count)),
            }
        }
        for (all, own) in remarks.iter_mut().zip([raster.notes, raster.warnings]) {
            own.into_iter().for_each(|text| all.add(&path, text));
        }
    }
    [whole.notes, whole.warnings] = remarks.map(|remarks| remarks.texts(given));
    whole.warnings.extend(mixed_units(&units).filter(|_| !is_unit_known));
    let gaps = is_held.iter().filter(|is_held| !**is_held).count();
    whole.notes.extend(sums.note());
    if gaps > 0 {
        let share = 100.0 * gaps as f64 / is_held.len() as f64;
        let of = if bbox.is_some() { "box" } else { "joined extent" };
        whole.notes.push(format!("{share:.3} % of the {of} is in no file: voids there"));
    }
    whole.notes.extend(window.note);
    whole.voids = Some(voids);
    whole.cell = cell;
    Ok(moved(whole, &at, [top, left]))
}

/// A warning if some files have heights in a unit other than metres and others in no known unit: those are read as metres.
fn mixed_units(units: &[(String, Option<f64>)]) -> Option<String> {
    let other = |(name, unit): &(String, Option<f64>)| {
        unit.filter(|unit| *unit != 1.0).map(|unit| (name.clone(), unit))
    };
    let (scaled, unit) = units.iter().find_map(other)?;
    let unknown: Vec<_> =
        units.iter().filter(|(_, unit)| unit.is_none()).map(|(name, _)| name.as_str()).collect();
    (!unknown.is_empty()).then(|| {
        format!(
            "in {}: no known unit of height, so heights are read as metres; those of {scaled} are in units of \
             {unit} m; `z_scale` applies to all files, so state the unit in the file: \
             `gdal_edit.py -units ft FILE`",
            unknown.join(", ")
        )
    })
}

/// The position of a tile.
fn placed<'a>(path: &Path, raster: &'a Raster) -> Result<&'a Georeference> {
    raster.georeference.as_ref().ok_or_else(|| {
        let expected = "a position, as several files become one field by their positions";
        Error::file(path, "georeference", "none", expected)
    })
}

/// Row and column of a tile's north-west corner from that of the first tile.
fn whole_cells(
    path: &Path,
    raster: &Raster,
    own: &Georeference,
    (first, at): (&Path, &Georeference),
) -> Result<[i64; 2]> {
    // A difference of cells adds up along the tile.
    let drift =
        |axis: usize, count: usize| (own.cell[axis] / at.cell[axis] - 1.0).abs() * count as f64;
    if drift(0, raster.cols) > SHIFT || drift(1, raster.rows) > SHIFT {
        let cells = |at: &Georeference| format!("{} x {}", at.cell[0], at.cell[1]);
        let expected = format!("{} as in {}", cells(at), first.display());
        return Err(Error::file(path, "cell size", cells(own), expected));
    }
    let right = (own.corner[0] - at.corner[0]) / at.cell[0];
    let down = (at.corner[1] - own.corner[1]) / at.cell[1];
    let shift = [down, right];
    // Beyond this, a field would be too large whatever its cells.
    if shift.iter().any(|cells| (cells - cells.round()).abs() > SHIFT || cells.abs() > 1e12) {
        let found = format!("{right:.3} columns and {down:.3} rows from {}", first.display());
        return Err(Error::file(path, "position", found, "a shift of whole cells"));
    }
    Ok(shift.map(|cells| cells.round() as i64))
}

/// Shifts tiles by 360 degrees where that makes the joined field narrower, as for tiles on both sides of longitude 180: the circle
/// is cut at its widest gap between tiles. The first tile stays.
fn cross_antimeridian(tiles: &[Tile], corners: &mut [[i64; 2]], cell: f64) {
    let circle = (360.0 / cell).round();
    if circle < 1.0 || (circle * cell - 360.0).abs() > SHIFT * cell {
        return;
    }
    let circle = circle as i64;
    let spans = || {
        let widths = tiles.iter().map(|tile| tile.raster.cols as i64);
        corners.iter().map(|at| at[1].rem_euclid(circle)).zip(widths)
    };
    let mut sorted: Vec<(i64, i64)> = spans().collect();
    sorted.sort_unstable();
    // Where the gap before each tile begins: the farthest end of those before it, around the circle.
    let last = sorted.iter().map(|(start, width)| start + width).max().unwrap_or(0) - circle;
    let mut end = last;
    let mut widest = (i64::MIN, 0);
    for (start, width) in sorted {
        widest = widest.max((start - end, start));
        end = end.max(start + width);
    }
    let (_, cut) = widest;
    let moved: Vec<i64> = spans().map(|(start, _)| (start - cut).rem_euclid(circle)).collect();
    let width = |starts: &[i64]| {
        let ends = tiles.iter().zip(starts).map(|(tile, start)| start + tile.raster.cols as i64);
        ends.max().zip(starts.iter().min()).map(|(end, begin)| end - begin)
    };
    let own: Vec<i64> = corners.iter().map(|at| at[1]).collect();
    if width(&moved) < width(&own) {
        let by = own[0] - moved[0];
        corners.iter_mut().zip(moved).for_each(|(at, start)| at[1] = start + by);
    }
}

/// A box some degrees to the east.
fn turned([west, south, east, north]: [f64; 4], turn: f64) -> [f64; 4] {
    [west + turn, south, east + turn, north]
}

/// The position some rows and columns from `at`.
fn shifted(at: &Georeference, [row, col]: [i64; 2]) -> Georeference {
    let [width, height] = at.cell;
    let corner = [at.corner[0] + col as f64 * width, at.corner[1] - row as f64 * height];
    Georeference { corner, ..at.clone() }
}

/// A grid whose north-west corner lies some rows and columns from that of `at`.
fn moved(mut raster: Raster, at: &Georeference, by: [i64; 2]) -> Raster {
    let at = shifted(at, by);
    raster.cell = raster.cell.about(at.corner[1] - raster.rows as f64 * at.cell[1] / 2.0);
    raster.georeference = Some(at);
    raster
}

/// Rows and columns to read, within the limits of a field.
pub(super) fn size_of_part(
    path: &Path,
    place: &str,
    [rows, cols]: [usize; 2],
) -> Result<(usize, usize)> {
    open::size(path, place, rows as u64, cols as u64).map_err(|error| match error {
        Error::File { path, place, found, expected } => {
            Error::file(&path, place, found, expected + "; `bbox` reads a part")
        }
        other => other,
    })
}

/// Texts about files, and which files each is about.
#[derive(Default)]
struct Remarks(Vec<(String, Vec<String>)>);

impl Remarks {
    fn add(&mut self, path: &Path, text: String) {
        let name = path.display().to_string();
        match self.0.iter_mut().find(|(known, _)| *known == text) {
            Some((_, names)) => names.push(name),
            None => self.0.push((text, vec![name])),
        }
    }

    /// The texts, with the names of their files if they are not about all `given` ones.
    fn texts(self, given: usize) -> Vec<String> {
        let named = |(text, names): (String, Vec<String>)| match names.len() == given {
            true => text,
            false => format!("in {}: {text}", names.join(", ")),
        };
        self.0.into_iter().map(named).collect()
    }
}

/// Overlaps of tiles.
#[derive(Default)]
struct Sums {
    points: u64,
    differing: u64,
    largest_m: f64,
}

impl Sums {
    fn overlap(&mut self, difference_m: f64) {
        self.points += 1;
        self.differing += u64::from(difference_m != 0.0);
        self.largest_m = self.largest_m.max(difference_m.abs());
    }

    fn note(&self) -> Option<String> {
        let Self { points, differing, largest_m } = self;
        (*differing > 0).then(|| {
            format!(
                "files differ at {differing} of {points} overlapping grid points, by up to {largest_m} m: \
                 the first file counts"
            )
        })
    }
}

/// Rows and columns of a grid, and a note on them.
pub(super) struct Window {
    pub rows: Range<usize>,
    pub cols: Range<usize>,
    pub note: Option<String>,
}

/// Finds the window to read from the position, if there is one, and the numbers of rows and columns.
pub(super) type Choose<'a> = &'a dyn Fn(Option<&Georeference>, [usize; 2]) -> Result<Window>;

impl Window {
    /// All rows and columns.
    pub fn whole([rows, cols]: [usize; 2]) -> Self {
        Self { rows: 0..rows, cols: 0..cols, note: None }
    }

    /// What a box touches of a tile, and a cell more on each side: tiles lie up to a part of a cell from the grid of the
    /// first. Empty where the box is elsewhere.
    pub fn near(at: &Georeference, [rows, cols]: [usize; 2], bbox: [f64; 4]) -> Self {
        let [west, south, east, north] = bbox;
        let [left, top] = at.corner;
        let span = |from: f64, to: f64, count: usize| {
            let [start, end] = [(from - 1.0).floor(), (to + 1.0).ceil()];
            start.clamp(0.0, count as f64) as usize..end.clamp(0.0, count as f64) as usize
        };
        let [width, height] = at.cell;
        let columns =
            |turn: f64| span((west + turn - left) / width, (east + turn - left) / width, cols);
        let mut all = columns(0.0);
        // In degrees the box may be given on the other side of longitude 180. Values that are read in vain are cut later.
        let [first, low, last, high] = at.extent(rows, cols);
        if first.abs().max(last.abs()) <= 540.0 && low.abs().max(high.abs()) <= 91.0 {
            for other in TURNS.map(columns).into_iter().filter(|other| !other.is_empty()) {
                let is_first = all.is_empty();
                all = if is_first {
                    other
                } else {
                    all.start.min(other.start)..all.end.max(other.end)
                };
            }
        }
        Self {
            rows: span((top - north) / height, (top - south) / height, rows),
            cols: all,
            note: None,
        }
    }

    /// What a box touches, with a note where it reaches beyond the grid. `bbox` is west, south, east and north in the
    /// coordinates of the grid.
    pub fn of(
        path: &Path,
        at: Option<&Georeference>,
        [rows, cols]: [usize; 2],
        bbox: [f64; 4],
    ) -> Result<Self> {
        let Some(at) = at else {
            let expected = "a position, as `bbox` is in the coordinates of the file";
            return Err(Error::file(path, "georeference", "none", expected));
        };
        let [west, south, east, north] = bbox;
        let [left, top] = at.corner;
        let x = |x: f64| (x - left) / at.cell[0];
        let y = |y: f64| (top - y) / at.cell[1];
        let span = |from: f64, to: f64, count: usize| {
            let start = (from + SHIFT).floor().clamp(0.0, count as f64) as usize;
            let end = (to - SHIFT).ceil().clamp(0.0, count as f64) as usize;
            start..end
        };
        let touched = [span(y(north), y(south), rows), span(x(west), x(east), cols)];
        let extent = at.extent(rows, cols);
        let text = |all: [f64; 4]| all.map(|x| x.to_string()).join(",");
        if touched.iter().any(Range::is_empty) {
            let expected =
                format!("a box that overlaps the field, whose extent is {}", text(extent));
            return Err(Error::setting("bbox", text(bbox), expected));
        }
        let is_beyond = x(west) < -SHIFT
            || x(east) > cols as f64 + SHIFT
            || y(north) < -SHIFT
            || y(south) > rows as f64 + SHIFT;
        let note = is_beyond
            .then(|| format!("`bbox` reaches beyond the field, whose extent is {}", text(extent)));
        let [rows, cols] = touched;
        Ok(Self { rows, cols, note })
    }

    pub fn is_empty(&self) -> bool {
        self.rows.is_empty() || self.cols.is_empty()
    }

    /// Drops the values of a whole grid that lie outside.
    pub fn cut(&self, raster: &mut Raster) {
        fn part<T: Copy>(all: &[T], width: usize, window: &Window) -> Vec<T> {
            let row = |row: usize| &all[row * width..][window.cols.clone()];
            window.rows.clone().flat_map(row).copied().collect()
        }
        if [self.rows.len(), self.cols.len()] != [raster.rows, raster.cols] {
            raster.values = part(&raster.values, raster.cols, self);
            raster.voids = raster.voids.take().map(|voids| part(&voids, raster.cols, self));
        }
    }

    /// The grid of the window alone; `raster` has the window's values and the size and position of the whole.
    pub fn placed(self, mut raster: Raster) -> Raster {
        raster.notes.extend(self.note);
        (raster.rows, raster.cols) = (self.rows.len(), self.cols.len());
        match raster.georeference.take() {
            Some(at) => moved(raster, &at, [self.rows.start as i64, self.cols.start as i64]),
            None => raster,
        }
    }
}

#[cfg(test)]
mod tests;
