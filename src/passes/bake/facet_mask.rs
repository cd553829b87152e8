use std::ops::Range;

use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::blocks::Blocks;
use crate::scene::{Border, HeightField};

/// Directions whose bits share one word, as in `facets.glsl`.
pub const DIRECTIONS_A_WORD: usize = 15;

/// Some layers of the image. `texels` are those of all directions in the buffer "directions".
pub(crate) fn plan(
    builder: &mut Builder,
    (field, border): (&HeightField, Border),
    blocks: &Blocks,
    (layers, texels): (Range<u32>, Range<usize>),
    [directions, image]: [ResourceId; 2],
) {
    let [cells_x, cells_y] = blocks.levels.cells;
    let [cells, maxima] = blocks.of_rays();
    let highest_m = field.heights_m().iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let words = u64::from(cells_x) * u64::from(cells_y) * u64::from(layers.end - layers.start);
    builder.pass(
        shaders::FacetMask { border: border as u32, most_steps: blocks.levels.most_steps() as i32 },
        &format!("layers {}..{}", layers.start, layers.end),
        "which triangles are visible from each direction",
        shaders::FACET_MASK.groups([cells_x, cells_y, layers.end - layers.start]),
        &shaders::FacetMaskPush {
            land: shaders::LandPush::of(field, &blocks.levels),
            highest_m,
            first_layer: layers.start as i32,
            first_direction: texels.start as i32,
            end_direction: texels.end as i32,
        },
        &[("cells", cells), ("maxima", maxima), ("directions", directions), ("facet_mask", image)],
        words * (4 + 16),
        words * 2 * DIRECTIONS_A_WORD as u64,
    );
}
