//! Occluders that `horizon_sweep` would now find on the lines that an edited rectangle can reach: from where a line
//! meets the rectangle until no hull vertex depends on it.
//!
//! The shader's lines march in groups, from the first line that meets the rectangle to the last that is past it. On
//! the other lines they recompute the same values.

use crate::dirty_mark;
use crate::horizon_sweep::{SweepOptions, pop_hidden, stored};
use crate::lattice::Lattice;
use crate::shared::sweep::{CELL_SHIFT, Heights, March, on_field};
use ridgelight::plan::Rectangle;
use ridgelight::plan::azimuths::{Azimuth, CELL};

/// The rectangle in an azimuth's march coordinates, widened by the distance at which a grid point uses a line: the
/// line's spacing, and the next lane.
struct Reach {
    steps: [i32; 2],
    positions: [i32; 2],
}

impl Reach {
    fn of(march: &March, rectangle: Rectangle, spacing: i32) -> Self {
        let Rectangle { col, row, cols, rows } = rectangle;
        let first = march.of_grid_point(col as i32, row as i32);
        let last = march.of_grid_point((col + cols - 1) as i32, (row + rows - 1) as i32);
        Self {
            steps: [first.1.min(last.1), first.1.max(last.1)],
            positions: [
                (first.0.min(last.0) - 1) * CELL - spacing,
                (first.0.max(last.0) + 1) * CELL + spacing,
            ],
        }
    }

    fn has(&self, y: i32, step: i32) -> bool {
        let within = |v: i32, [low, high]: [i32; 2]| low <= v && v <= high;
        within(step, self.steps) && within(y, self.positions)
    }
}

/// A rectangle with this many grid points more on every side, as far as a field of `cols` × `rows` goes.
pub fn grown(rectangle: Rectangle, by: u32, [cols, rows]: [usize; 2]) -> Rectangle {
    let along = |first: u32, count: u32, all: usize| {
        let start = first.saturating_sub(by);
        (start, (first + count + by).min(all as u32) - start)
    };
    let (col, cols) = along(rectangle.col, rectangle.cols, cols);
    let (row, rows) = along(rectangle.row, rectangle.rows, rows);
    Rectangle { col, row, cols, rows }
}

/// Updates the occluders of one azimuth from a sweep before the edit to one after it. Marks in `dirty` the grid
/// points whose horizon may have changed. Returns the number of line steps swept.
///
/// # Panics
/// For a border that repeats; when the lattice is too small for the field and the options.
pub fn horizon_resweep(
    heights: Heights,
    azimuth: &Azimuth,
    options: &SweepOptions,
    rectangle: Rectangle,
    lattice: &mut Lattice,
    dirty: &mut [u32],
) -> usize {
    let march = March::new(heights, azimuth);
    assert!(!march.periodic(), "lines of a periodic field have no beginning");
    let (lanes, steps, shear) = (march.lanes, march.steps, azimuth.shear);
    let spacing = 1_i32 << options.line_shift;
    let lead = ((steps - 1) * shear + spacing - 1) >> options.line_shift;
    let line_count = (((lanes - 1) * CELL) >> options.line_shift) + 1 + lead;
    let reach = Reach::of(&march, rectangle, spacing);
    let mut swept = 0;
    for line in 0..line_count {
        let y0 = (line - lead) * spacing;
        let stands = |step: i32| on_field(y0 + step * shear, lanes);
        let Some(entered) =
            (reach.steps[0]..=reach.steps[1]).find(|&s| stands(s) && reach.has(y0 + s * shear, s))
        else {
            continue;
        };
        let texel = |lattice: &Lattice, step: i32| {
            let slot = (y0 + step * shear) >> options.line_shift;
            lattice.texel(slot, march.march_position(step), azimuth.layer)
        };
        let vertex = |step: i32| {
            (stored(march.line_height(y0 + step * shear, step), options.packed), step as f32)
        };
        // The hull where the line enters, newest vertex first.
        let mut hull: Vec<(f32, f32)> = Vec::new();
        let mut step = entered - 1;
        while step >= 0 && stands(step) {
            hull.push(vertex(step));
            let back = i32::from(lattice.occluders[texel(lattice, step)]);
            step = if back > 0 { step - back } else { -1 };
        }
        hull.reverse();
        let (mut touched, mut standing) = (-1, -1);
        for step in (entered..steps).take_while(|&s| stands(s)) {
            let y = y0 + step * shear;
            let (h, x) = (march.line_height(y, step), step as f32);
            pop_hidden(&mut hull, h, x);
            let back = hull.last().map_or(0, |top| step - top.1 as i32);
            hull.push(vertex(step));
            swept += 1;
            let at = texel(lattice, step);
            let before = std::mem::replace(&mut lattice.occluders[at], back as u16);
            let changed = i32::from(before) != back;
            let met = if back > 0 { step - back } else { -1 };
            if changed || (met >= 0 && reach.has(y - back * shear, met)) {
                mark(&march, y, step, spacing, dirty);
            }
            if changed || reach.has(y, step) {
                (touched, standing) = (step, step);
            } else if met <= touched {
                standing = met;
            }
            // No changed vertex is on the hull, and none will be.
            let passed = step >= reach.steps[1] || y + shear > reach.positions[1];
            if passed && standing < entered {
                break;
            }
        }
    }
    swept
}

/// Marks the grid points that use a line's occluder at a step.
fn mark(march: &March, y: i32, step: i32, spacing: i32, dirty: &mut [u32]) {
    let first = ((y - spacing + CELL - 1) >> CELL_SHIFT).max(0);
    let last = ((y + spacing) >> CELL_SHIFT).min(march.lanes - 1);
    for lane in first..=last {
        let at = march.grid_point(lane, step).map(|v| v as usize);
        let (word, bit) = dirty_mark::place(at, march.heights.cols);
        dirty[word] |= bit;
    }
}
