use glam::DVec3;

use super::{Border, Directions, HeightField};
use crate::basis::triangles::Triangles;
use crate::{Error, Result};

/// The visible point of each grid point in each of a set of directions (Heidrich et al. 2000, §3).
///
/// The layout is that of the device: one word per texel and layer. A layer is one direction, and a word is
/// `row << 16 | column` of the grid point nearest to the hit. In fields of at most 255 by 255, a layer is two directions,
/// each `row << 8 | column`, the even one in the lower half of the word.
#[derive(Clone, Debug, PartialEq)]
pub struct VisiblePoints {
    directions: Directions,
    /// Rows and columns of the field.
    size: [usize; 2],
    /// [`HeightField::hash`] of the field.
    field_hash: u64,
    words: Vec<u32>,
}

/// The visible point in one direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VisiblePoint {
    /// The surface, nearest to the grid point row · columns + column.
    GridPoint(usize),
    /// No surface.
    Sky,
    /// The level, black ground beyond the field under `plane`; under `periodic` everything beyond the traced repetitions.
    Ground,
}

/// Marks: words, or halves of words, whose upper bits are all 1, as in `points.glsl`.
pub(crate) const SKY: u32 = 0xffff_ffff;
pub(crate) const GROUND: u32 = 0xffff_fffe;
pub(crate) const LOST: u32 = 0xffff_fffd;

/// Why a ray was lost on the device.
pub const LOST_RAY: &str = "a ray exceeded the step limit: the relief is too many cells high; use lower heights or larger cells";

impl VisiblePoints {
    /// Largest side of a field with one byte per axis; 255 itself is a mark.
    const SMALL_SIDE: usize = 255;
    /// Largest side of any field: a larger row in 16 bits would equal a mark.
    pub(crate) const LARGEST_SIDE: usize = 65_533;

    /// Whether two directions share a word.
    pub(crate) fn is_small(rows: usize, cols: usize) -> bool {
        rows.max(cols) <= Self::SMALL_SIDE
    }

    /// Number of layers.
    pub(crate) fn layers(directions: usize, is_small: bool) -> usize {
        if is_small { directions.div_ceil(2) } else { directions }
    }

    /// From the words that [`plan::visible_points`](crate::plan::visible_points) writes, layer after layer.
    ///
    /// # Errors
    /// A side beyond 65,533 grid points, a wrong number of words, a point outside the field, a ray lost on
    /// the device.
    pub fn new(
        field: &HeightField,
        border: Border,
        directions: Directions,
        mut words: Vec<u32>,
    ) -> Result<Self> {
        let size = [field.rows(), field.cols()];
        check_sides(size)?;
        let is_small = Self::is_small(size[0], size[1]);
        let layers = Self::layers(directions.count(), is_small);
        let wanted = layers * size[0] * size[1];
        if words.len() != wanted {
            let found = format!("{} words", words.len());
            return Err(Error::setting("visible points", found, format!("{wanted} words")));
        }
        if is_small && directions.count() % 2 == 1 {
            // Clear the unused half, so that equal points compare equal.
            let last = (layers - 1) * size[0] * size[1];
            words[last..].iter_mut().for_each(|word| *word &= 0xffff);
        }
        let points = Self { directions, size, field_hash: field.hash(border), words };
        for direction in 0..points.directions.count() {
            for grid_point in 0..size[0] * size[1] {
                let word = points.word(direction, grid_point);
                let [row, col] = [word >> 16, word & 0xffff].map(|n| n as usize);
                let at =
                    || format!("visible points: direction {direction}, grid point {grid_point}");
                if word == LOST {
                    return Err(Error::Device { doing: at(), reason: LOST_RAY.to_owned() });
                }
                if word < LOST && (row >= size[0] || col >= size[1]) {
                    let found = format!("row {row}, column {col}");
                    let expected = format!("a grid point of {} × {}", size[1], size[0]);
                    return Err(Error::setting(at(), found, expected));
                }
            }
        }
        Ok(points)
    }

    /// From points, direction after direction.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_points(
        field: &HeightField,
        border: Border,
        directions: Directions,
        points: &[VisiblePoint],
    ) -> Result<Self> {
        let (rows, cols) = (field.rows(), field.cols());
        check_sides([rows, cols])?;
        let (grid_points, is_small) = (rows * cols, Self::is_small(rows, cols));
        if points.len() != directions.count() * grid_points {
            let expected = format!("{} points", directions.count() * grid_points);
            return Err(Error::setting("visible points", points.len().to_string(), expected));
        }
        let mut words = vec![0; Self::layers(directions.count(), is_small) * grid_points];
        for (i, point) in points.iter().enumerate() {
            let (direction, grid_point) = (i / grid_points, i % grid_points);
            let word = match *point {
                VisiblePoint::GridPoint(at) if at >= grid_points => {
                    let name =
                        format!("visible points: direction {direction}, grid point {grid_point}");
                    let expected = format!("one of {grid_points}, {cols} × {rows}");
                    return Err(Error::setting(name, format!("grid point {at}"), expected));
                }
                VisiblePoint::GridPoint(at) => (((at / cols) << 16) | (at % cols)) as u32,
                VisiblePoint::Sky => SKY,
                VisiblePoint::Ground => GROUND,
            };
            if is_small {
                let half = if word >= LOST { word & 0xffff } else { word >> 16 << 8 | word & 0xff };
                words[direction / 2 * grid_points + grid_point] |= half << (16 * (direction % 2));
            } else {
                words[direction * grid_points + grid_point] = word;
            }
        }
        Self::new(field, border, directions, words)
    }

    /// Checks that the points belong to a field.
    ///
    /// # Errors
    /// Other heights, cells or border than those of the points.
    pub fn check(&self, field: &HeightField, border: Border) -> Result<()> {
        let hash = field.hash(border);
        if self.size == [field.rows(), field.cols()] && self.field_hash == hash {
            return Ok(());
        }
        let [rows, cols] = self.size;
        Err(Error::setting(
            "visible points",
            format!("points of a field of {cols} × {rows} with hash {:016x}", self.field_hash),
            format!(
                "those of this one, {} × {} with {hash:016x}: heights, cells and border must be the same",
                field.cols(),
                field.rows()
            ),
        ))
    }

    /// The directions, in the order of the points.
    pub fn directions(&self) -> &Directions {
        &self.directions
    }

    /// The words, layer after layer, row after row.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// The visible point of grid point `grid_point` = row · columns + column in direction `direction`.
    ///
    /// # Panics
    /// Outside the field or the directions.
    pub fn point(&self, direction: usize, grid_point: usize) -> VisiblePoint {
        match self.word(direction, grid_point) {
            SKY => VisiblePoint::Sky,
            GROUND => VisiblePoint::Ground,
            word => {
                let [row, col] = [word >> 16, word & 0xffff].map(|n| n as usize);
                VisiblePoint::GridPoint(row * self.size[1] + col)
            }
        }
    }

    /// The three directions around a light with their weights, which sum to 1: the corners of its triangle, without those at
    /// or below horizontal, where the ground occludes whatever the field (Heidrich et al. 2000, §4). The same for all texels.
    /// `None` where no triangle covers the light, or where none of its corners is above horizontal.
    pub fn around(&self, triangles: &Triangles, light: DVec3) -> Option<[(usize, f64); 3]> {
        let vectors = self.directions.vectors();
        let mut corners = triangles.around(vectors, light)?.map(|(i, share)| (i as usize, share));
        let is_above = |i: usize| vectors[i].z > 0.0;
        let sum: f64 = corners.iter().filter(|c| is_above(c.0)).map(|c| c.1).sum();
        if sum <= 0.0 {
            return None;
        }
        corners.iter_mut().for_each(|c| c.1 = if is_above(c.0) { c.1 / sum } else { 0.0 });
        Some(corners)
    }

    /// In the layout of a large field.
    fn word(&self, direction: usize, grid_point: usize) -> u32 {
        let [rows, cols] = self.size;
        if !Self::is_small(rows, cols) {
            return self.words[direction * rows * cols + grid_point];
        }
        let half =
            self.words[direction / 2 * rows * cols + grid_point] >> (16 * (direction % 2)) & 0xffff;
        if half >= LOST & 0xffff { 0xffff_0000 | half } else { half >> 8 << 16 | half & 0xff }
    }
}

/// # Errors
/// A side too large for 16 bits per coordinate.
fn check_sides([rows, cols]: [usize; 2]) -> Result<()> {
    if rows.max(cols) <= VisiblePoints::LARGEST_SIDE {
        return Ok(());
    }
    let expected = format!("at most {} grid points a side", VisiblePoints::LARGEST_SIDE);
    Err(Error::setting("visible points", format!("a field of {cols} × {rows}"), expected))
}
