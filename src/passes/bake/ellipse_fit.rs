use std::ops::Range;

use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::least_radius;
use crate::scene::{Directions, HeightField, VisiblePoints};

/// The ellipses of some rows. `bound` are the visible points, the directions (flat or on a curved base surface)
/// and the output. `base` names the base in the label.
pub(crate) fn plan(
    builder: &mut Builder,
    field: &HeightField,
    (directions, first): (&Directions, usize),
    (rows, base): (Range<u32>, &str),
    bound: &[(&str, ResourceId)],
) {
    let [cols, height] = [field.cols() as u32, rows.end - rows.start];
    let grid_points = u64::from(cols) * u64::from(height);
    let is_small = VisiblePoints::is_small(field.rows(), field.cols());
    let is_bent = bound.iter().any(|(name, _)| *name == "bent");
    let above = directions.vectors().iter().filter(|e| e.z > 0.0).count();
    builder.pass(
        shaders::EllipseFit { small: is_small, bent: is_bent },
        &format!("{base}rows {}..{}", rows.start, rows.end),
        "the ellipse of directions in which the sky is visible",
        shaders::ELLIPSE_FIT.groups([cols, height, 1]),
        &shaders::EllipseFitPush {
            cols: cols as i32,
            rows: rows.end as i32,
            first_direction: first as i32,
            end_direction: (first + directions.count()) as i32,
            first_row: rows.start as i32,
            least_radius: least_radius(above) as f32,
        },
        bound,
        grid_points * (4 * directions.count() as u64 + 32),
        grid_points,
    );
}
