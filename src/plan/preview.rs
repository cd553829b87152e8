use super::Plan;
use crate::graph::{Builder, Format, Kind, Limits, Owner};
use crate::passes::preview::Grid;
use crate::passes::{preview_gather, preview_shade};
use crate::scene::{Albedo, HeightField, Scene};
use crate::{Error, Result};

/// Passes that show the light of a coarse grid on a finer one of the same ground: the sun's light and the rest are
/// divided by the cosines of the coarse slopes, interpolated, and multiplied by those of the fine slopes and by the fine
/// albedo. For pictures that must appear at once; exact only where both grids have the same slopes.
///
/// `coarse` is the plan of the coarse scene with one image per light ([`Picture::light_layers`](super::Picture)). The
/// first sun with irradiance, number n, is the sun, whose image is `direct.sun{n}`; other lights count as sky. Cells of the coarse grid are a whole number of fine ones wide, and
/// both begin at the north-western corner.
///
/// Inputs, in order: "heights" of the fine grid; "environment" if the scene has one, for [`View`](super::View); "albedo"
/// of the fine grid if the scene has a map; then of the coarse grid "coarse_heights", "coarse_radiance", "coarse_sun" if there is
/// a sun, "coarse_albedo" if there is a map. Output: "radiance", four channels.
///
/// # Errors
/// A coarse plan without the sun's layer, or scenes beyond the limits.
pub fn preview(fine: &Scene, coarse: &Scene, lit: &Plan, limits: &Limits) -> Result<Plan> {
    let size = limits.check_size(fine.field.rows(), fine.field.cols())?;
    let grid = |field: &HeightField| Grid {
        size: [field.cols() as u32, field.rows() as u32],
        cell_m: field.cell_m(),
    };
    let grids = [grid(&fine.field), grid(&coarse.field)];
    let mut suns = (1..).zip(&coarse.lights.suns);
    let sun = suns.find(|(_, sun)| sun.irradiance.iter().any(|e| *e > 0.0));
    sun.map_or(Ok(()), |(n, _)| check_sun(lit, n))?;
    let sun = sun.map(|(_, sun)| sun);
    let has_albedo = matches!(fine.surface.albedo, Albedo::Map(_));
    let radiance = lit.find("radiance").map(|id| lit.resources[id.0].kind);
    let grey = matches!(radiance, Some(Kind::Image { format: Format::R32Float, .. }));

    let mut builder = Builder::new();
    let mut image = |name: &str, owner: Owner, format: Format, of: Grid| {
        let [width, height] = of.size;
        builder.image(name, owner, format, [width, height, 1], false)
    };
    let (one, four) = (Format::R32Float, Format::Rgba32Float);
    let of_coarse = if grey { one } else { four };
    let [fine_grid, coarse_grid] = grids;
    let heights = image("heights", Owner::Input, one, fine_grid);
    if let Some(environment) = &fine.lights.environment {
        let size = [environment.width() as u32, environment.height() as u32];
        let of = Grid { size, cell_m: [1.0; 2] };
        image("environment", Owner::Input, four, of);
    }
    let albedo = has_albedo.then(|| image("albedo", Owner::Input, four, fine_grid));
    let mut gathered = vec![
        ("heights", image("coarse_heights", Owner::Input, one, coarse_grid)),
        ("coarse_radiance", image("coarse_radiance", Owner::Input, of_coarse, coarse_grid)),
    ];
    if sun.is_some() {
        gathered.push(("coarse_sun", image("coarse_sun", Owner::Input, of_coarse, coarse_grid)));
    }
    if has_albedo {
        gathered.push(("coarse_albedo", image("coarse_albedo", Owner::Input, four, coarse_grid)));
    }
    let gathered_light = image("gathered", Owner::Internal, four, coarse_grid);
    let radiance = image("radiance", Owner::Output, four, fine_grid);
    gathered.push(("gathered", gathered_light));
    let coarse_albedo = (&coarse.surface.albedo, grey);
    preview_gather::plan(&mut builder, coarse_grid, sun, coarse_albedo, &gathered);
    let mut shaded = vec![("heights", heights)];
    shaded.extend(albedo.map(|albedo| ("albedo", albedo)));
    shaded.extend([("gathered", gathered_light), ("radiance", radiance)]);
    preview_shade::plan(&mut builder, grids, sun, &fine.surface.albedo, &shaded);
    Plan::finish(builder, size, Vec::new(), Vec::new(), Vec::new(), Vec::new(), limits)
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
