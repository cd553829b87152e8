use super::preview::{Grid, Unoccluded, colour};
use super::preview_shadow::SunLines;
use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::Albedo;

/// Lights the fine grid's slopes by the sky's light on the coarse grid and, if there is a sun, by its shadow heights.
pub(crate) fn plan(
    builder: &mut Builder,
    fine: Grid,
    (sky, sky_grid): (Unoccluded, Grid),
    sun: Option<(Unoccluded, SunLines)>,
    albedo: &Albedo,
    bound: &[(&str, ResourceId)],
) {
    let of_sun = sun.map_or(sky, |(unoccluded, _)| unoccluded);
    let [r, g, b] = of_sun.most;
    let lines = sun.map(|(_, lines)| lines);
    let [east, north, ..] = of_sun.by_normal;
    let across = east.hypot(north).max(f32::MIN_POSITIVE);
    let cell_m = fine.cell_m.map(|side| side as f32);
    let towards = [east / across, north / across];
    let width_m = (towards[0] * cell_m[0]).hypot(towards[1] * cell_m[1]);
    builder.pass(
        shaders::PreviewShade {
            has_sun: sun.is_some(),
            albedo_is_map: matches!(albedo, Albedo::Map(_)),
            periodic: lines.is_some_and(|of| of.is_periodic),
        },
        "",
        "light of the sky's grid and of the sun on the slopes of the fine grid",
        fine.groups(),
        &shaders::PreviewShadePush {
            sky_by_normal: sky.by_normal,
            sun_by_normal: of_sun.by_normal,
            most: [r, g, b, 1.0],
            colour: colour(albedo, sky.least),
            along_m: towards.map(|v| v * width_m),
            rise_m: lines.map_or(0.0, |of| of.edges[0] * width_m),
            cols: fine.size[0] as i32,
            rows: fine.size[1] as i32,
            sky_cols: sky_grid.size[0] as i32,
            sky_rows: sky_grid.size[1] as i32,
            sky_ratio: (fine.cell_m[0] / sky_grid.cell_m[0]) as f32,
            shear: lines.map_or(0, |of| of.azimuth.shear),
            flags: lines.map_or(0, |of| of.azimuth.flags),
        },
        bound,
        fine.texels() * 56,
        fine.texels(),
    );
}
