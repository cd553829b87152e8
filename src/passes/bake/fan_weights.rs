use std::ops::Range;

use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::HeightField;

/// Some directions of every grid point. `bound` are the directions on the curved base surface, the fans from
/// texel `first_fan`, and the output.
pub(crate) fn plan(
    builder: &mut Builder,
    field: &HeightField,
    (directions, part): (Range<u32>, &str),
    first_fan: usize,
    bound: &[(&str, ResourceId)],
) {
    let [cols, rows] = [field.cols() as u32, field.rows() as u32];
    let count = directions.end - directions.start;
    let rays = u64::from(cols) * u64::from(rows) * u64::from(count);
    builder.pass(
        shaders::FanWeights {},
        part,
        "the solid angle of each direction on the curved base",
        shaders::FAN_WEIGHTS.groups([cols, rows, count]),
        &shaders::FanWeightsPush {
            cols: cols as i32,
            rows: rows as i32,
            first_fan: first_fan as i32,
            first_direction: directions.start as i32,
        },
        bound,
        rays * (7 * 16 + 4),
        rays,
    );
}
