//! `sweep.glsl`: march and lane positions of an azimuth.

use ridgelight::plan::azimuths::{Azimuth, CELL, FLIPS_LANES, FLIPS_MARCH};
use ridgelight::scene::{Border, HeightField};

/// Below every slope of a field, and safe to square.
pub const NO_SLOPE: f32 = -1e9;

/// Values at or below it mean "no horizon".
pub const LOWEST_MET: f32 = -1e8;

/// log2 of [`CELL`].
pub const CELL_SHIFT: u32 = CELL.trailing_zeros();

/// One over [`CELL`]: exact.
pub const PER_CELL: f32 = 1.0 / CELL as f32;

/// The heights as the shaders read them: one texel per grid point.
#[derive(Clone, Copy, Debug)]
pub struct Heights<'a> {
    /// Row-major, row 0 in the north, metres.
    pub heights_m: &'a [f32],
    /// Grid points from west to east.
    pub cols: usize,
    /// Grid points from north to south.
    pub rows: usize,
    /// Spacing of columns and of rows, metres.
    pub cell_m: [f32; 2],
    /// Border beyond the edge.
    pub border: Border,
}

impl<'a> Heights<'a> {
    /// The heights of a field.
    pub fn of(field: &'a HeightField, border: Border) -> Self {
        Self {
            heights_m: field.heights_m(),
            cols: field.cols(),
            rows: field.rows(),
            cell_m: field.cell_m().map(|c| c as f32),
            border,
        }
    }

    /// `texelFetch(heights, ivec2(col, row), 0).x`.
    pub fn at(&self, col: i32, row: i32) -> f32 {
        self.heights_m[row as usize * self.cols + col as usize]
    }
}

/// A field in the frame of one marched azimuth.
#[derive(Clone, Copy, Debug)]
pub struct March<'a> {
    /// The heights marched over.
    pub heights: Heights<'a>,
    /// The direction.
    pub azimuth: Azimuth,
    /// Grid points across the march.
    pub lanes: i32,
    /// Grid points along it.
    pub steps: i32,
}

impl<'a> March<'a> {
    /// The view of `azimuth`.
    pub fn new(heights: Heights<'a>, azimuth: &Azimuth) -> Self {
        let (cols, rows) = (heights.cols as i32, heights.rows as i32);
        let (lanes, steps) = if azimuth.marches_rows() { (cols, rows) } else { (rows, cols) };
        Self { heights, azimuth: *azimuth, lanes, steps }
    }

    /// Whether the field repeats.
    pub fn periodic(&self) -> bool {
        self.heights.border == Border::Periodic
    }

    /// Position along the march axis at a step, and the step at a position: the same flip.
    pub fn march_position(&self, step: i32) -> i32 {
        if self.azimuth.flags & FLIPS_MARCH != 0 { self.steps - 1 - step } else { step }
    }

    /// Position along the lane axis of a lane, and back.
    pub fn lane_position(&self, lane: i32) -> i32 {
        if self.azimuth.flags & FLIPS_LANES != 0 { self.lanes - 1 - lane } else { lane }
    }

    /// Lane and step of the grid point in a column and row.
    pub fn of_grid_point(&self, col: i32, row: i32) -> (i32, i32) {
        let (lane, march) = if self.azimuth.marches_rows() { (col, row) } else { (row, col) };
        (self.lane_position(lane), self.march_position(march))
    }

    /// Column and row of a lane and step, wrapped where the field repeats, else clamped.
    pub fn grid_point(&self, lane: i32, step: i32) -> [i32; 2] {
        let lane = self.lane_position(inside(lane, self.lanes, self.periodic()));
        let step = self.march_position(inside(step, self.steps, self.periodic()));
        if self.azimuth.marches_rows() { [lane, step] } else { [step, lane] }
    }

    /// Height of the grid point of a lane and step.
    pub fn height_at(&self, lane: i32, step: i32) -> f32 {
        let [col, row] = self.grid_point(lane, step);
        self.heights.at(col, row)
    }

    /// Heights of a cell's corners: at a lane and step, one step on, one lane on, and both.
    pub fn cell_heights(&self, lane: i32, step: i32) -> [f32; 4] {
        [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(l, s)| self.height_at(lane + l, step + s))
    }

    /// Height of the surface at a lane position and a step.
    pub fn line_height(&self, y: i32, step: i32) -> f32 {
        let lane = inside(y >> CELL_SHIFT, self.lanes, self.periodic());
        let h = self.height_at(lane, step);
        h + (y & (CELL - 1)) as f32 * PER_CELL * (self.height_at(lane + 1, step) - h)
    }

    /// Whether cell diagonals run from (0, 0) to (1, 1) in march and lane coordinates.
    pub fn split_along(&self) -> bool {
        (self.azimuth.flags & FLIPS_MARCH != 0) == (self.azimuth.flags & FLIPS_LANES != 0)
    }
}

/// `i` modulo `n`, 0 or more.
pub fn wrapped(i: i32, n: i32) -> i32 {
    let r = i % n;
    if r < 0 { r + n } else { r }
}

/// Index `i` of `n`: wrapped where the field repeats, else clamped.
pub fn inside(i: i32, n: i32, repeats: bool) -> i32 {
    if repeats { wrapped(i, n) } else { i.clamp(0, n - 1) }
}

/// Whether a lane position lies on the field.
pub fn on_field(y: i32, lanes: i32) -> bool {
    y >= 0 && y <= (lanes - 1) * CELL
}
