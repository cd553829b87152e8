use super::Plan;
use crate::graph::{Builder, Format, Kind, Limits, Owner};
use crate::passes::preview::{Grid, Unoccluded};
use crate::passes::{preview_gather, preview_shade};
use crate::scene::{Albedo, HeightField, Scene, Sun};
use crate::{Error, Result};

/// Passes that show the light of coarse grids on a finer one of the same ground: the sun's light is divided by the cosine
/// of the coarse slopes, the rest by its unoccluded irradiance on them; both are interpolated, and multiplied by the same
/// functions of the fine slopes and by the fine albedo. For pictures that must appear at once; exact only where all grids
/// have the same slopes.
///
/// `sky` is a scene on a coarse grid with all lights and its plan, with one image per light
/// ([`Picture::light_layers`](super::Picture)). The first sun with irradiance, number n, is the sun, whose image is
/// `direct.sun{n}`; all other lights count as sky. If there is a sun, `sun` is a scene on a grid of its own, with albedo 1
/// and that sun alone, and its plan. The sun may have another irradiance there. All grids begin at the north-western corner; their cells have the same shape.
///
/// Inputs, in order: "heights" of the fine grid; "environment" if the scene has one, for [`View`](super::View); "albedo"
/// of the fine grid if the scene has a map; four channels of unit normals: "normals" of the fine grid, the means of those that
/// each texel covers, and the coarse grids' own, "sky_normals" and, if there is a sun, "sun_normals"; then "sky_radiance",
/// "sky_sun" if there is a sun, "sky_albedo" if there is a map, and "sun_radiance". Output: "radiance", four channels.
///
/// # Errors
/// A plan of the sky without the sun's layer, a sun without its scene, or scenes beyond the limits.
pub fn preview(
    fine: &Scene,
    (sky, sky_plan): (&Scene, &Plan),
    sun: Option<(&Scene, &Plan)>,
    limits: &Limits,
) -> Result<Plan> {
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
            let lacks =
                || Error::setting("preview: sun", "no scene of it", "one with the sun alone");
            let (scene, plan) = sun.ok_or_else(lacks)?;
            // As the slopes show it, and as its own scene has it.
            let (_, own) = first(scene).ok_or_else(lacks)?;
            Some(([found, own], (scene, plan)))
        }
    };
    let has_albedo = matches!(fine.surface.albedo, Albedo::Map(_));
    let is_grey = |plan: &Plan| {
        let radiance = plan.find("radiance").map(|id| plan.resources[id.0].kind);
        matches!(radiance, Some(Kind::Image { format: Format::R32Float, .. }))
    };

    let mut builder = Builder::new(limits);
    let mut image = |name: &str, owner: Owner, format: Format, of: Grid| {
        let [width, height] = of.size;
        builder.image(name, owner, format, [width, height, 1], false)
    };
    let (one, four) = (Format::R32Float, Format::Rgba32Float);
    let of = |plan: &Plan| if is_grey(plan) { one } else { four };
    // Of views alone.
    image("heights", Owner::Input, one, fine_grid);
    if let Some(environment) = &fine.lights.environment {
        let size = [environment.width() as u32, environment.height() as u32];
        image("environment", Owner::Input, four, Grid { size, cell_m: [1.0; 2] });
    }
    let albedo = has_albedo.then(|| image("albedo", Owner::Input, four, fine_grid));
    let normals = image("normals", Owner::Input, four, fine_grid);
    let sky_normals = image("sky_normals", Owner::Input, four, sky_grid);
    let of_sun = of_sun.map(|(lights, (scene, plan))| {
        let grid = grid(&scene.field);
        (lights, plan, grid, image("sun_normals", Owner::Input, four, grid))
    });
    let mut in_sky = vec![
        ("normals", sky_normals),
        ("coarse_radiance", image("sky_radiance", Owner::Input, of(sky_plan), sky_grid)),
    ];
    if of_sun.is_some() {
        in_sky.push(("coarse_sun", image("sky_sun", Owner::Input, of(sky_plan), sky_grid)));
    }
    if has_albedo {
        in_sky.push(("coarse_albedo", image("sky_albedo", Owner::Input, four, sky_grid)));
    }
    let sky_light = image("sky", Owner::Internal, four, sky_grid);
    in_sky.push(("gathered", sky_light));
    let of_sun = of_sun.map(|(lights, plan, grid, normals)| {
        let made = image("sun", Owner::Internal, one, grid);
        let bound = vec![
            ("normals", normals),
            ("coarse_radiance", image("sun_radiance", Owner::Input, of(plan), grid)),
            ("gathered_scalar", made),
        ];
        (lights.map(Unoccluded::of_sun), grid, is_grey(plan), bound, made)
    });
    let radiance = image("radiance", Owner::Output, four, fine_grid);

    let of_sky = Unoccluded::of_sky(&sky.lights, sky.surface.border);
    let surface = (&sky.surface.albedo, is_grey(sky_plan), of_sun.is_some());
    preview_gather::plan(&mut builder, sky_grid, (of_sky, "sky"), surface, false, &in_sky);
    let mut shaded = vec![("normals", normals)];
    shaded.extend(albedo.map(|albedo| ("albedo", albedo)));
    shaded.push(("sky", sky_light));
    if let Some(([_, unoccluded], grid, grey, bound, made)) = &of_sun {
        let surface = (&Albedo::Constant([1.0; 3]), *grey, false);
        preview_gather::plan(&mut builder, *grid, (*unoccluded, "sun"), surface, true, bound);
        shaded.push(("sun", *made));
    }
    shaded.push(("radiance", radiance));
    let of_sun = of_sun.map(|([unoccluded, _], grid, ..)| (unoccluded, grid));
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
