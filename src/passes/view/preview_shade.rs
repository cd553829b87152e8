use super::preview::{Grid, colour, direction, most};
use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::{Albedo, Sun};

/// Lights the fine grid's slopes.
pub(crate) fn plan(
    builder: &mut Builder,
    [fine, coarse]: [Grid; 2],
    sun: Option<&Sun>,
    albedo: &Albedo,
    bound: &[(&str, ResourceId)],
) {
    builder.pass(
        shaders::PreviewShade {
            has_sun: sun.is_some(),
            albedo_is_map: matches!(albedo, Albedo::Map(_)),
        },
        "",
        "light of the coarse grid on the slopes of the fine one",
        fine.groups(),
        &shaders::PreviewShadePush {
            sun: direction(sun),
            most: most(sun),
            colour: colour(albedo),
            cell_m: fine.cell_m.map(|c| c as f32),
            cols: fine.size[0] as i32,
            rows: fine.size[1] as i32,
            coarse_cols: coarse.size[0] as i32,
            coarse_rows: coarse.size[1] as i32,
            ratio: (fine.cell_m[0] / coarse.cell_m[0]) as f32,
        },
        bound,
        fine.texels() * 36,
        fine.texels(),
    );
}
