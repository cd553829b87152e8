//! Which of a field's flat triangles are seen from a direction, in f64: what stands at their middles, three samples of the
//! same surface with three samples for each (`HeightField::finer`), sees of it.

use crate::oracle::Oracle;
use crate::visible_points::possible_points;
use glam::DVec3;
use ridgelight::Result;
use ridgelight::plan::DIRECTIONS_A_WORD;
use ridgelight::scene::{Border, Directions, HeightField, VisiblePoint};

/// The sample of the threefold finer field in the middle of a triangle: its row and column. `facet` counts two a cell, row
/// after row, first the one north-east of the diagonal.
pub fn middle(facet: usize, cells_x: usize) -> [usize; 2] {
    let (cell, is_south) = (facet / 2, facet % 2);
    [3 * (cell / cells_x) + 1 + is_south, 3 * (cell % cells_x) + 2 - is_south]
}

/// Columns and rows of cells.
pub fn cells(field: &HeightField, border: Border) -> [usize; 2] {
    let fewer = usize::from(border != Border::Periodic);
    [field.cols() - fewer, field.rows() - fewer]
}

/// Whether a triangle sees the sky along `e`; and whether it might as well where the elevation is off by so much. `finer` is
/// the oracle of the threefold finer field.
pub fn sees_sky(
    finer: &Oracle,
    (facet, cells_x): (usize, usize),
    e: DVec3,
    elevation_rad: f64,
) -> [bool; 2] {
    let all = possible_points(finer, middle(facet, cells_x), e, elevation_rad, 0.0);
    let is_sky = |point: &VisiblePoint| *point == VisiblePoint::Sky;
    let own = is_sky(&all[0]);
    [own, all.iter().any(|point| is_sky(point) != own)]
}

/// The device's words: all triangles, fifteen directions a word.
///
/// # Errors
/// Cells too small to be a third.
pub fn facet_mask(
    field: &HeightField,
    border: Border,
    directions: &Directions,
) -> Result<Vec<u32>> {
    let finer = field.finer(border, 3)?;
    let oracle = Oracle::new(&finer, border);
    let [cells_x, cells_y] = cells(field, border);
    let count = cells_x * cells_y;
    let mut words = vec![0; directions.count().div_ceil(DIRECTIONS_A_WORD) * count];
    for (i, e) in directions.vectors().iter().enumerate() {
        for facet in 0..2 * count {
            let [is_seen, _] = sees_sky(&oracle, (facet, cells_x), *e, 0.0);
            let bit = 2 * (i % DIRECTIONS_A_WORD) + facet % 2;
            words[i / DIRECTIONS_A_WORD * count + facet / 2] |= u32::from(is_seen) << bit;
        }
    }
    Ok(words)
}
