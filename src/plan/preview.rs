use super::Plan;
use crate::graph::{Builder, Format, Kind, Limits, Owner};
use crate::passes::preview::{Grid, Unoccluded};
use crate::passes::preview_shadow::SunLines;
use crate::passes::{preview_gather, preview_shade, preview_shadow};
use crate::scene::{Albedo, HeightField, Scene, Sun};
use crate::{Error, Result};

/// Passes that light a fine grid: by the light of a coarse grid of the same ground, and by a sun with shadow heights of the fine
/// grid. The coarse light is divided by its unoccluded irradiance on the coarse slopes, interpolated, and multiplied by the same
/// function of the fine slopes and by the fine albedo. Use it for pictures that must appear at once. It is exact only where both
/// grids have the same slopes and the whole sun is visible everywhere.
///
/// `sky` is a scene on a coarse grid with all lights and its plan, with one image per light
/// ([`Picture::light_layers`](super::Picture)). The sun is the first one with irradiance. Its number is n, and its image
/// `direct.sun{n}`. All other lights count as sky. Both grids begin at the north-western corner; their cells have the same
/// shape.
///
/// Inputs, in order: "heights" of the fine grid; "environment" if the scene has one, for [`View`](super::View); "albedo"
/// of the fine grid if the scene has a map; four channels of unit normals: "normals" of the fine grid, the means of those that
/// each texel covers, and "sky_normals", the coarse grid's own; then "sky_radiance", "sky_sun" if there is a sun, and
/// "sky_albedo" if there is a map. Output: "radiance", four channels.
///
/// # Errors
/// `sky_plan` has no layer of the sun, or a scene exceeds the limits.
pub fn preview(fine: &Scene, (sky, sky_plan): (&Scene, &Plan), limits: &Limits) -> Result<Plan> {
    let size = limits.check_size(fine.field.rows(), fine.field.cols())?;
    let grid = |field: &HeightField| Grid {
        size: [field.cols() as u32, field.rows() as u32],
        cell_m: field.cell_m(),
    };
    let [fine_grid, sky_grid] = [grid(&fine.field), grid(&sky.field)];
    let of_sun = match first(sky) {
        None => None,
        Some((n, found)) => {
            check_sun(sky_plan, n)?;
            let border = fine.surface.border;
            let lines = SunLines::new(found, fine_grid.cell_m, border);
            Some((Unoccluded::of_sun(found, border), lines))
        }
    };
    let has_albedo = matches!(fine.surface.albedo, Albedo::Map(_));
    let radiance = sky_plan.find("radiance").map(|id| sky_plan.resources[id.0].kind);
    let is_grey = matches!(radiance, Some(Kind::Image { format: Format::R32Float, .. }));

    let mut builder = Builder::new(limits);
    let mut image = |name: &str, owner: Owner, format: Format, of: Grid| {
        let [width, height] = of.size;
        builder.image(name, owner, format, [width, height, 1], false)
    };
    let (one, four) = (Format::R32Float, Format::Rgba32Float);
    let of_light = if is_grey { one } else { four };
    let heights = image("heights", Owner::Input, one, fine_grid);
    // Of views alone.
    if let Some(environment) = &fine.lights.environment {
        let size = [environment.width() as u32, environment.height() as u32];
        image("environment", Owner::Input, four, Grid { size, cell_m: [1.0; 2] });
    }
    let albedo = has_albedo.then(|| image("albedo", Owner::Input, four, fine_grid));
    let normals = image("normals", Owner::Input, four, fine_grid);
    let mut in_sky = vec![
        ("normals", image("sky_normals", Owner::Input, four, sky_grid)),
        ("coarse_radiance", image("sky_radiance", Owner::Input, of_light, sky_grid)),
    ];
    if of_sun.is_some() {
        in_sky.push(("coarse_sun", image("sky_sun", Owner::Input, of_light, sky_grid)));
    }
    if has_albedo {
        in_sky.push(("coarse_albedo", image("sky_albedo", Owner::Input, four, sky_grid)));
    }
    let sky_light = image("sky", Owner::Internal, four, sky_grid);
    in_sky.push(("gathered", sky_light));
    let shadows = of_sun.map(|(_, lines)| {
        let names = ["lit_above", "dark_below"];
        (lines, names.map(|name| (name, image(name, Owner::Internal, one, fine_grid))))
    });
    let radiance = image("radiance", Owner::Output, four, fine_grid);

    let of_sky = Unoccluded::of_sky(&sky.lights, sky.surface.border);
    let surface = (&sky.surface.albedo, is_grey, of_sun.is_some());
    preview_gather::plan(&mut builder, sky_grid, of_sky, surface, &in_sky);
    let mut shaded = vec![("normals", normals)];
    shaded.extend(albedo.map(|albedo| ("albedo", albedo)));
    shaded.push(("sky", sky_light));
    if let Some((lines, written)) = shadows {
        let [lit_above, dark_below] = written;
        let bound = [("heights", heights), lit_above, dark_below];
        preview_shadow::plan(&mut builder, fine_grid, lines, &bound);
        shaded.extend(bound);
    }
    shaded.push(("radiance", radiance));
    let albedo = &fine.surface.albedo;
    preview_shade::plan(&mut builder, fine_grid, (of_sky, sky_grid), of_sun, albedo, &shaded);
    Plan::finish(builder, size, Vec::new(), Vec::new(), Vec::new(), limits)
}

/// The first sun with irradiance, and its number, from 1.
fn first(scene: &Scene) -> Option<(usize, &Sun)> {
    let mut suns = (1..).zip(&scene.lights.suns);
    suns.find(|(_, sun)| sun.irradiance.iter().any(|e| *e > 0.0))
}

/// Whether a plan has the image of the sun of this number.
///
/// # Errors
/// A plan without it.
fn check_sun(lit: &Plan, n: usize) -> Result<()> {
    let name = format!("direct.sun{n}");
    let found = lit.outputs().any(|(_, output)| output.name == name);
    found
        .then_some(())
        .ok_or_else(|| Error::setting("coarse plan", "no image of its sun", "`light_layers`"))
}
