//! Visibility of a field's flat triangles along a direction, in f64: that of their centroids, which are grid points
//! of the same surface refined threefold (`HeightField::finer`).

use crate::oracle::Oracle;
use crate::visible_points::possible_within;
use glam::DVec3;
use ridgelight::Result;
use ridgelight::plan::DIRECTIONS_A_WORD;
use ridgelight::scene::{Border, Directions, HeightField, VisiblePoint};

/// Row and column, in the threefold finer field, of a triangle's centroid. `facet` counts two per cell, row after
/// row, the one north-east of the diagonal first.
pub fn middle(facet: usize, cells_x: usize) -> [usize; 2] {
    let (cell, is_south) = (facet / 2, facet % 2);
    [3 * (cell / cells_x) + 1 + is_south, 3 * (cell % cells_x) + 2 - is_south]
}

/// Columns and rows of cells.
pub fn cells(field: &HeightField, border: Border) -> [usize; 2] {
    let fewer = usize::from(border != Border::Periodic);
    [field.cols() - fewer, field.rows() - fewer]
}

/// Whether a triangle has a free view along `e`; and the same with an elevation error of so much. `finer` is the
/// oracle of the threefold finer field.
pub fn sky_is_visible(
    finer: &Oracle,
    (facet, cells_x): (usize, usize),
    e: DVec3,
    elevation_rad: f64,
) -> [bool; 2] {
    let all = possible_within(finer, middle(facet, cells_x), e, |_| elevation_rad, 0.0);
    let is_sky = |point: &VisiblePoint| *point == VisiblePoint::Sky;
    let own = is_sky(&all[0]);
    [own, all.iter().any(|point| is_sky(point) != own)]
}

/// The device's words: all triangles, fifteen directions per word.
///
/// # Errors
/// The cells are too small to divide by three.
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
            let [is_visible, _] = sky_is_visible(&oracle, (facet, cells_x), *e, 0.0);
            let bit = 2 * (i % DIRECTIONS_A_WORD) + facet % 2;
            words[i / DIRECTIONS_A_WORD * count + facet / 2] |= u32::from(is_visible) << bit;
        }
    }
    Ok(words)
}
