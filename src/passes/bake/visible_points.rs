use std::ops::Range;

use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::blocks::Blocks;
use crate::scene::{Border, HeightField};

/// The visible points in the directions of some layers of an image. `texels` are those of the image's
/// directions in the buffer "directions".
pub(crate) fn plan(
    builder: &mut Builder,
    (field, border): (&HeightField, Border),
    blocks: &Blocks,
    (layers, texels, is_small): (Range<u32>, Range<usize>, bool),
    part: &str,
    [directions, image]: [ResourceId; 2],
) {
    let [cols, rows] = [field.cols() as u32, field.rows() as u32];
    let [thin_rows, thin_cols] = blocks.thin(field);
    let [cells, maxima] = blocks.of_rays();
    let highest_m = field.heights_m().iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let count = layers.end - layers.start;
    let words = u64::from(cols) * u64::from(rows) * u64::from(count);
    let rays = words * if is_small { 2 } else { 1 };
    builder.pass(
        shaders::VisiblePoints {
            border: border as u32,
            thin_rows,
            thin_cols,
            most_steps: blocks.levels.most_steps() as i32,
            small: is_small,
        },
        part,
        "the visible point of each grid point in each direction",
        shaders::VISIBLE_POINTS.groups([cols, rows, count]),
        &shaders::VisiblePointsPush {
            land: shaders::LandPush::of(field, &blocks.levels),
            highest_m,
            first_layer: layers.start as i32,
            first_direction: texels.start as i32,
            end_direction: texels.end as i32,
        },
        &[
            ("cells", cells),
            ("maxima", maxima),
            ("ground", blocks.ground),
            ("directions", directions),
            ("visible_points", image),
        ],
        words * (4 + 16),
        rays,
    );
}
