use super::preview::{Grid, Unoccluded, colour};
use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::Albedo;

/// Takes the slopes out of a coarse grid's light.
pub(crate) fn plan(
    builder: &mut Builder,
    coarse: Grid,
    (of, suffix): (Unoccluded, &str),
    (albedo, grey, without_sun): (&Albedo, bool, bool),
    is_scalar: bool,
    bound: &[(&str, ResourceId)],
) {
    let [r, g, b] = of.most;
    builder.pass(
        shaders::PreviewGather {
            grey,
            without_sun,
            albedo_is_map: matches!(albedo, Albedo::Map(_)),
            is_scalar,
        },
        suffix,
        "light without slopes, on the coarse grid",
        shaders::PREVIEW_GATHER.groups([coarse.size[0], coarse.size[1], 1]),
        &shaders::PreviewGatherPush {
            by_normal: of.by_normal,
            most: [r, g, b, of.ceiling],
            colour: colour(albedo, of.least),
            cols: coarse.size[0] as i32,
            rows: coarse.size[1] as i32,
        },
        bound,
        coarse.texels() * 64,
        coarse.texels(),
    );
}
