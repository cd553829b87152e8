use super::preview::{Grid, colour, direction, most};
use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::{Albedo, Sun};

/// Takes the slopes out of the coarse grid's light.
pub(crate) fn plan(
    builder: &mut Builder,
    coarse: Grid,
    sun: Option<&Sun>,
    (albedo, grey): (&Albedo, bool),
    bound: &[(&str, ResourceId)],
) {
    builder.pass(
        shaders::PreviewGather {
            grey,
            has_sun: sun.is_some(),
            albedo_is_map: matches!(albedo, Albedo::Map(_)),
        },
        "",
        "light without slopes, on the coarse grid",
        coarse.groups(),
        &shaders::PreviewGatherPush {
            sun: direction(sun),
            most: most(sun),
            colour: colour(albedo),
            cell_m: coarse.cell_m.map(|c| c as f32),
            cols: coarse.size[0] as i32,
            rows: coarse.size[1] as i32,
        },
        bound,
        coarse.texels() * 68,
        coarse.texels(),
    );
}
