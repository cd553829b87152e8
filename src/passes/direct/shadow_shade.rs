use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::azimuths::Shape;
use crate::passes::batch::Batch;
use crate::passes::shadows::Shadows;
use crate::scene::Border;

/// Light of a sun where shadow heights decide it; marks the other texels.
pub(crate) fn plan(
    builder: &mut Builder,
    shadows: &Shadows,
    (border, cell_m): (Border, [f64; 2]),
    batch: &Batch,
    (part, shape): (&str, Shape),
    ([lane_heights, azimuths, lattice, sun_sum], light_vector): (
        [ResourceId; 4],
        Option<ResourceId>,
    ),
) {
    let axis = batch.axis;
    let [cols, rows] = axis.size();
    let mut bound = vec![
        ("lane_heights", lane_heights),
        ("azimuths", azimuths),
        ("shadows", lattice),
        ("sun_sum", sun_sum),
        ("doubtful", shadows.doubtful(axis)),
    ];
    bound.extend(light_vector.map(|vector| ("light_vector", vector)));
    let pass = builder.pass(
        shaders::ShadowShade {
            layer_shift: batch.layer_shift as i32,
            border: border as u32,
            marches_rows: axis.marches_rows,
            shape: shape as u32,
            has_vector: light_vector.is_some(),
        },
        part,
        "texels that see all of a chord of the sun, or none of it",
        shaders::SHADOW_SHADE.groups([axis.steps, axis.lanes.div_ceil(4), 1]),
        &shaders::ShadowShadePush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
            azimuth_count: batch.count,
            clears: u32::from(batch.is_first),
        },
        &bound,
        axis.texels()
            * (16 + if light_vector.is_some() { 16 } else { 0 } + u64::from(batch.count) * (4 + 8)),
        axis.texels() * u64::from(batch.count),
    );
    pass.azimuths = batch.azimuths();
}
