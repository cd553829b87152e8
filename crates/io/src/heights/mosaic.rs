//! Several grids as one, and a part of a grid, by their positions.

use super::Raster;
use crate::georeference::Georeference;
use crate::open;
use ridgelight::{Error, Result};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The largest shift from whole cells, in cells: positions and cell sizes are rounded in files.
const SHIFT: f64 = 0.01;
/// The most grid points of a mosaic, for each grid point in its files.
const SPREAD: u64 = 64;

type Tile = (PathBuf, Raster);

/// A grid that holds all tiles. Its heights are those of the first tile that has one there.
pub(super) fn joined(mut tiles: Vec<Tile>) -> Result<Raster> {
    if tiles.len() == 1 {
        return Ok(tiles.remove(0).1);
    }
    let (first, grid) = &tiles[0];
    let (first, at, cell) = (first.clone(), placed(first, grid)?.clone(), grid.cell);
    let mut corners = Vec::with_capacity(tiles.len());
    for (path, raster) in &tiles {
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
    let ends = tiles
        .iter()
        .zip(&corners)
        .map(|((_, tile), corner)| [corner[0] + tile.rows as i64, corner[1] + tile.cols as i64]);
    let [top, left] = [0, 1].map(|axis| corners.iter().map(|c| c[axis]).min().unwrap_or(0));
    let [bottom, right] = ends.fold([i64::MIN; 2], |[b, r], [y, x]| [b.max(y), r.max(x)]);
    let place = "mosaic";
    let size = |end: i64, start: i64| end.abs_diff(start);
    let (rows, cols) = open::size(&first, place, size(bottom, top), size(right, left))?;
    let held: usize = tiles.iter().map(|(_, tile)| tile.values.len()).sum();
    if (rows * cols) as u64 > SPREAD * held as u64 {
        let found = format!("{cols} x {rows} grid points, {held} of them in files");
        let expected = format!("at most {SPREAD} times as many grid points as the files hold");
        return Err(Error::file(&first, place, found, expected));
    }
    let mut whole = Raster::bare(rows, cols, open::zeros(&first, rows * cols)?);
    let mut sums = Sums::default();
    // Whether a file holds the grid point, and whether none has its height.
    let mut is_held = vec![false; rows * cols];
    let mut voids = vec![true; rows * cols];
    for ((path, tile), [row, col]) in tiles.into_iter().zip(corners) {
        let [row, col] = [row.abs_diff(top) as usize, col.abs_diff(left) as usize];
        for (i, value) in tile.values.iter().enumerate() {
            let to = (row + i / tile.cols) * cols + col + i % tile.cols;
            is_held[to] = true;
            if tile.voids.as_ref().is_some_and(|voids| voids[i]) {
                continue;
            }
            if !value.is_finite() {
                let place = format!("height at row {}, column {}", i / tile.cols, i % tile.cols);
                let expected = "a finite number, or one marked as no-data (`nodata`)";
                return Err(Error::file(&path, place, format!("{value:?}"), expected));
            }
            if voids[to] {
                (whole.values[to], voids[to]) = (*value, false);
            } else {
                sums.overlap(whole.values[to] - value);
            }
        }
        for (all, own) in [(&mut whole.notes, tile.notes), (&mut whole.warnings, tile.warnings)] {
            for text in own {
                if !all.contains(&text) {
                    all.push(text);
                }
            }
        }
    }
    let gaps = is_held.iter().filter(|is_held| !**is_held).count();
    whole.notes.extend(sums.note());
    if gaps > 0 {
        let share = 100.0 * gaps as f64 / is_held.len() as f64;
        whole.notes.push(format!("{share:.3} % of the joined extent is in no file: voids there"));
    }
    whole.voids = Some(voids);
    whole.cell = cell;
    Ok(moved(whole, &at, [top, left]))
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

/// A grid whose north-west corner lies some rows and columns from that of `at`.
fn moved(mut raster: Raster, at: &Georeference, [row, col]: [i64; 2]) -> Raster {
    let [width, height] = at.cell;
    let corner = [at.corner[0] + col as f64 * width, at.corner[1] - row as f64 * height];
    raster.cell = raster.cell.about(corner[1] - raster.rows as f64 * height / 2.0);
    raster.georeference = Some(Georeference { corner, ..at.clone() });
    raster
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

/// Rows and columns of a grid that a box touches, and a note where the box reaches beyond the grid.
pub(super) struct Window {
    pub rows: Range<usize>,
    pub cols: Range<usize>,
    pub note: Option<String>,
}

impl Window {
    /// `bbox` is west, south, east and north in the coordinates of the grid.
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

    /// A grid of the window's values, at the window's position in `at`.
    pub fn placed(self, mut raster: Raster, at: &Georeference) -> Raster {
        raster.notes.extend(self.note);
        (raster.rows, raster.cols) = (self.rows.len(), self.cols.len());
        moved(raster, at, [self.rows.start as i64, self.cols.start as i64])
    }
}

/// The cells of a grid that a box touches.
pub(super) fn cropped(path: &Path, mut raster: Raster, bbox: [f64; 4]) -> Result<Raster> {
    fn part<T: Copy>(all: &[T], width: usize, window: &Window) -> Vec<T> {
        let row = |row: usize| &all[row * width..][window.cols.clone()];
        window.rows.clone().flat_map(row).copied().collect()
    }
    let size = [raster.rows, raster.cols];
    let at = raster.georeference.take();
    let window = Window::of(path, at.as_ref(), size, bbox)?;
    let Some(at) = at else { return Ok(raster) };
    raster.values = part(&raster.values, size[1], &window);
    raster.voids = raster.voids.map(|voids| part(&voids, size[1], &window));
    Ok(window.placed(raster, &at))
}

#[cfg(test)]
mod tests;
