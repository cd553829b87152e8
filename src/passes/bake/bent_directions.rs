use std::ops::Range;

use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::REACH_CELLS;
use crate::scene::{Border, Curvature, HeightField, VisiblePoints};

/// Some directions of every grid point, on the curved base surface. `texels` are the first texel of the
/// directions and of the fans. `bound` are the visible points, the ground, both buffers and the output.
pub(crate) fn plan(
    builder: &mut Builder,
    (field, border): (&HeightField, Border),
    (curvature, part): (Curvature, &str),
    directions: Range<u32>,
    [first_texel, first_fan]: [usize; 2],
    bound: &[(&str, ResourceId)],
) {
    let [cols, rows] = [field.cols() as u32, field.rows() as u32];
    let [cell_x, cell_y] = field.cell_m();
    let count = directions.end - directions.start;
    let rays = u64::from(cols) * u64::from(rows) * u64::from(count);
    let is_small = VisiblePoints::is_small(field.rows(), field.cols());
    builder.pass(
        shaders::BentDirections {
            border: border as u32,
            small: is_small,
            reach: REACH_CELLS as i32,
        },
        part,
        "on the curved base, the direction to each visible point of the flat one",
        shaders::BENT_DIRECTIONS.groups([cols, rows, count]),
        &shaders::BentDirectionsPush {
            cols: cols as i32,
            rows: rows as i32,
            first_texel: first_texel as i32,
            first_fan: first_fan as i32,
            first_direction: directions.start as i32,
            cell_x_m: cell_x as f32,
            cell_y_m: cell_y as f32,
            curvature_x: curvature.per_m[0] as f32,
            curvature_y: curvature.per_m[1] as f32,
        },
        bound,
        rays * (4 + 4 + 16),
        rays,
    );
}
