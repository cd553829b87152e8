use super::preview::{Grid, Unoccluded, colour};
use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::Albedo;

/// Lights the fine grid's slopes: by the sky on its grid, and by the sun, if any, on its own.
pub(crate) fn plan(
    builder: &mut Builder,
    fine: Grid,
    (sky, sky_grid): (Unoccluded, Grid),
    sun: Option<(Unoccluded, Grid)>,
    albedo: &Albedo,
    bound: &[(&str, ResourceId)],
) {
    let (of_sun, sun_grid) = sun.unwrap_or((sky, sky_grid));
    let ratio = |coarse: Grid| (fine.cell_m[0] / coarse.cell_m[0]) as f32;
    let [r, g, b] = of_sun.most;
    builder.pass(
        shaders::PreviewShade {
            has_sun: sun.is_some(),
            albedo_is_map: matches!(albedo, Albedo::Map(_)),
        },
        "",
        "light of the coarse grids on the slopes of the fine one",
        shaders::PREVIEW_SHADE.groups([fine.size[0], fine.size[1], 1]),
        &shaders::PreviewShadePush {
            sky_by_normal: sky.by_normal,
            sun_by_normal: of_sun.by_normal,
            most: [r, g, b, 1.0],
            colour: colour(albedo, sky.least),
            cols: fine.size[0] as i32,
            rows: fine.size[1] as i32,
            sky_cols: sky_grid.size[0] as i32,
            sky_rows: sky_grid.size[1] as i32,
            sun_cols: sun_grid.size[0] as i32,
            sun_rows: sun_grid.size[1] as i32,
            sky_ratio: ratio(sky_grid),
            sun_ratio: ratio(sun_grid),
        },
        bound,
        fine.texels() * 48,
        fine.texels(),
    );
}
