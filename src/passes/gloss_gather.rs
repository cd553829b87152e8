use super::bounce_gather::{Pyramids, ShadeImages};
use super::pyramid_march;
use super::sphere_shade::MOST_TURNS;
use crate::gpu::shaders::{self, same_layout};
use crate::plan::glossy::{Glossy, Thrown, Vectors};
use crate::plan::sweep::WARM_UP_PERIODS;
use crate::plan::{Bounce, Builder, ResourceId};
use crate::scene::{HeightField, Levels};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct GlossGatherPush {
    cols: i32,
    rows: i32,
    cell_x_m: f32,
    cell_y_m: f32,
    azimuths: i32,
    first_azimuth: i32,
    last_azimuth: i32,
    warm_up: i32,
    fine_samples: i32,
    width_shift: i32,
    growth: f32,
    shade_fine: i32,
    shade_shift: i32,
    step_shade: i32,
    step_height: i32,
}

same_layout!(
    GlossGatherPush,
    gloss_gather_push,
    cols = COLS,
    rows = ROWS,
    cell_x_m = CELL_X_M,
    cell_y_m = CELL_Y_M,
    azimuths = AZIMUTHS,
    first_azimuth = FIRST_AZIMUTH,
    last_azimuth = LAST_AZIMUTH,
    warm_up = WARM_UP,
    fine_samples = FINE_SAMPLES,
    width_shift = WIDTH_SHIFT,
    growth = GROWTH,
    shade_fine = SHADE_FINE,
    shade_shift = SHADE_SHIFT,
    step_shade = STEP_SHADE,
    step_height = STEP_HEIGHT,
);

/// What every sample sees of the surface by its pyramids, for diffuse ground and for its lobe.
pub(crate) fn plan(
    builder: &mut Builder,
    field: &HeightField,
    (of, glossy): (&Pyramids, &Glossy),
    azimuths: u32,
    bounce: &Bounce,
    [heights, ground]: [ResourceId; 2],
) {
    let (cols, rows) = (field.cols() as u32, field.rows() as u32);
    let samples = u64::from(cols) * u64::from(rows);
    let mut bound = vec![
        ("heights", heights),
        ("ground", ground),
        ("bounce_sum", bounce.sum),
        ("arriving", glossy.arriving),
    ];
    match of.height_images {
        Some(pyramid_march::Images { stack: Some(stack), .. }) => {
            bound.push(("height_stack", stack));
        }
        Some(pyramid_march::Images { levels, table, stack: None }) => {
            bound.extend([("height_levels", levels), ("level_table", table)]);
        }
        None => {}
    }
    match (glossy.thrown, of.shade_images) {
        (Thrown::Vectors(Vectors { exit, levels, .. }), _) => {
            bound.push(("exit_vectors", exit));
            let of_levels =
                levels.into_iter().flat_map(|[l, t]| [("vector_levels", l), ("shade_table", t)]);
            bound.extend(of_levels);
        }
        (Thrown::Seen(exit), shade) => {
            bound.push(("exit_radiance", exit));
            match shade {
                Some(ShadeImages { stack: Some(stack), .. }) => bound.push(("shade_stack", stack)),
                Some(ShadeImages { levels, table, stack: None }) => {
                    bound.extend([("shade_levels", levels), ("shade_table", table)]);
                }
                None => {}
            }
        }
    }
    let has_vectors = matches!(glossy.thrown, Thrown::Vectors(_));
    // The march, and inside it samples that round to one distance; then for each sample that is seen, and for the
    // end, the sums over its coefficients.
    let looked_at = of.heights.samples();
    // Beyond the last distance less than an octave more rounds to it, and two knots end the spline.
    let knots = looked_at + of.heights.level_step + 2;
    let layers = glossy.layers();
    let of_each = glossy.order * glossy.order + if has_vectors { layers + layers } else { 0 };
    let turns = 3 * knots + 1 + (knots + 1) * of_each;
    let at_once = ((MOST_TURNS - 8 * layers) / turns).max(1);
    for first in (0..azimuths).step_by(at_once as usize) {
        let last = azimuths.min(first + at_once);
        let count = last - first;
        let part = match count == azimuths {
            true => bounce.name.clone(),
            false => format!("{} azimuths {first}..{last}", bounce.name),
        };
        let looks = u64::from(looked_at) * u64::from(count);
        let of_look = if has_vectors { 4 * glossy.texel_bytes() * u64::from(layers) } else { 16 };
        builder.pass(
            &shaders::GLOSS_GATHER,
            &part,
            format!(
                "{} along {count} azimuths, {looked_at} samples each, {}; as a series besides",
                bounce.why,
                if has_vectors {
                    "radiance towards the sample"
                } else {
                    "radiance as seen from above"
                }
            ),
            [cols.div_ceil(8), rows.div_ceil(8), 1],
            &[
                (0, u32::from(of.heights.periodic)),
                (1, u32::from(of.heights.stored == Levels::Stack)),
                (2, of.heights.levels()),
                (3, of.shade.levels()),
                (4, u32::from(bounce.grey)),
                (5, u32::from(has_vectors)),
                (6, glossy.order),
                (7, knots),
            ],
            &GlossGatherPush {
                cols: cols as i32,
                rows: rows as i32,
                cell_x_m: field.cell_m()[0] as f32,
                cell_y_m: field.cell_m()[1] as f32,
                azimuths: azimuths as i32,
                first_azimuth: first as i32,
                last_azimuth: last as i32,
                warm_up: if of.heights.periodic { WARM_UP_PERIODS as i32 } else { 0 },
                fine_samples: of.heights.fine_samples() as i32,
                width_shift: of.heights.width_shift() as i32,
                growth: of.heights.growth(),
                shade_fine: of.shade.fine_samples() as i32,
                shade_shift: of.shade.width_shift() as i32,
                step_shade: of.shade.level_step as i32,
                step_height: of.heights.level_step as i32,
            },
            &bound,
            samples * (2 * 16 + 2 * 16 * u64::from(layers) + looks * (4 + of_look)),
            samples * u64::from(count),
        );
    }
}
