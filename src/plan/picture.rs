mod drawing;
mod images;
mod slices;
mod specular;

use super::Plan;
use super::active_lights::ActiveLights;
use super::reference::{eye_over_base, specular_texels};
use crate::graph::{Builder, Limits};
use crate::passes;
use crate::passes::azimuths;
use crate::passes::azimuths::Shape;
use crate::passes::blocks::Blocks;
use crate::passes::bounce_ground::BounceGround;
use crate::passes::bounce_nodes::BounceNodes;
use crate::passes::bounces;
use crate::passes::bounces::Bouncing;
use crate::passes::edits::Edits;
use crate::passes::line_blocks::LineBlocks;
use crate::passes::nodes::Nodes;
use crate::passes::shadows::Shadows;
use crate::passes::sphere_sh::SphereSh;
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::{Held, Lists, prepare, settings};
use crate::scene::{
    Albedo, Basis, Border, BounceEngine, BounceSpecular, Bounces, Environment, LightBasis, Method,
    Quality, Scene, Specular, Wedges,
};
use crate::{Error, Result};
use drawing::Drawing;
use images::{Harmonics, Images, Tables};
use slices::SpecularSlices;

/// Requested outputs of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Picture {
    /// Also an image for each light and each bounce.
    pub light_layers: bool,
    /// Also the sky-view factor of the tilted surface, [0..1]: exit radiance under a sky of radiance 1 at albedo 1.
    pub sky_view: bool,
    /// Each batch of azimuths keeps its own lattice, so a frame with new light only needs no sweep
    /// ([`Plan::passes_after`]). Memory: the lattices of all azimuths at once; with an environment in spherical harmonics
    /// only the suns' lattices, as the harmonics keep the visibility.
    ///
    /// Sweeps along lines, with any fuse but nearest and slopes, and a border that does not repeat, then also accept edits
    /// ([`Plan::edit_passes`]), but not with spherical harmonics, bounces, specular, sphere lights or
    /// [`still`](Self::still). Memory: a quarter of a byte per texel.
    pub keeps_horizons: bool,
    /// The heights will not change: the planner may drop what they do not need, and there are no passes for edits. It drops
    /// nothing for [unknown](crate::scene::HeightField::unknown) heights.
    pub still: bool,
    /// Only the texel's own ground occludes light, and there are no bounces. Sphere lights keep their shadows.
    pub unshadowed: bool,
    /// Radiances of the sky and of key lights and irradiances of suns come from the caller, on the device: an input
    /// "light_colours", one row of texels: the sky's if the scene has one, then each sun's, then each key light's; linear
    /// RGB, 0 or more. The scene's colours then do not count, except that the sky's beside an environment affects the
    /// azimuths. Not with sphere lights or specular, whose sums contain the colours.
    pub colours_on_device: bool,
    /// Where specular is viewed from: x and y in metres from the south-western grid point, z a height of the field. `None` for
    /// a view from straight above. Diffuse light does not depend on it.
    pub eye_m: Option<[f64; 3]>,
}

/// Passes that light a scene. [`Picture`] requests outputs besides the radiance.
///
/// Inputs, in order: "heights"; "environment", "albedo" and "phong" if the scene has them; "light_colours" if requested.
/// Outputs, in order: "radiance"; if requested one "direct.*" image per light; "direct.specular" (specular of all lights,
/// which the others then exclude); "sky_view"; one "indirect.*" image per bounce; and "indirect.specular" (specular of all bounces,
/// which the others then exclude). Images have one channel if every colour is grey, else four.
///
/// Specular light of sky and environment comes from tables of the lobe's integral over each azimuth's slice. A specular map has tables
/// for several exponents. `basis sh` uses SH instead, whose order limits the lobe's sharpness. With `basis auto`, a specular map whose
/// tables exceed the memory budget or a limit of the device also uses SH. Suns use the mean of the lobe over their disc and their visible part; key
/// lights and sphere lights use the lobe over their slice in each azimuth.
///
/// # Errors
/// Settings or lights out of range; no light; a scene beyond the limits.
pub fn picture(scene: &Scene, quality: &Quality, limits: &Limits, wanted: Picture) -> Result<Plan> {
    let planned = |quality: &Quality| {
        let of = |has_cache| with_cache(scene, quality, limits, (wanted, has_cache));
        match of(true) {
            // Without a visibility cache, bounces take more time and less memory.
            Err(Error::Limit { .. }) if quality.bounces.count > 1 => of(false),
            plan => plan,
        }
    };
    match planned(quality) {
        Err(error @ Error::Limit { .. })
            if quality.basis == Basis::Auto && reflects_around_by_map(scene) =>
        {
            let by_sh = planned(&Quality { basis: Basis::Sh, ..*quality });
            let Ok(mut plan) = by_sh else { return Err(error) };
            plan.notes.push(
                "basis sh: the tables of the specular map exceed the memory budget or a limit of the device; SH blurs the lobe"
                    .into(),
            );
            Ok(plan)
        }
        plan => plan,
    }
}

/// Whether a specular map reflects a sky or an environment.
fn reflects_around_by_map(scene: &Scene) -> bool {
    let lights = scene.lights.lit();
    let has_light = lights.sky.is_some() || lights.environment.is_some();
    let map = scene.surface.specular.as_ref().filter(|s| matches!(s, Specular::Map(_)));
    has_light && map.is_some_and(|map| map.largest().scale > 0.0)
}

/// Plans a picture, with or without a visibility cache for bounces.
fn with_cache(
    scene: &Scene,
    quality: &Quality,
    limits: &Limits,
    (wanted, has_cache): (Picture, bool),
) -> Result<Plan> {
    let Scene { field, surface, lights } = scene;
    quality.check()?;
    lights.check()?;
    surface.check(field.rows() * field.cols())?;
    let size = limits.check_size(field.rows(), field.cols())?;
    let mut notes = Vec::new();
    let active = ActiveLights::of(scene, quality, wanted, &mut notes)?;
    let quality = &active.light_basis(quality, &mut notes);
    let quality = &if wanted.unshadowed { without_bounces(quality) } else { *quality };
    let quality = &specular::quality(quality, &active, &mut notes)?;
    let mut sweep = Sweep::choose(field, surface.border, quality, limits, false, &mut notes)?;
    let quality = &bounces::settled(quality, surface, &sweep, &mut notes);
    let is_walked = quality.bounces.walk_over(surface);
    if is_walked {
        sweep.keep_occluders()?;
    }
    if wanted.unshadowed {
        notes.push("no sweep, no bounces: without shadows".into());
        sweep = Sweep::Crossings;
    } else if wanted.still
        && !is_walked
        && sweep.sees_own_crossings()
        && field.is_concave(surface.border)
    {
        notes.push("no sweep: nothing rises above anything else, the field is concave".into());
        sweep = Sweep::Crossings;
    }
    if matches!(sweep, Sweep::Surface { .. })
        && let Some(aimed) = active.aimed().next()
    {
        let (setting, light) = match aimed.shape {
            Shape::Patch => ("`keys`", "a key light"),
            Shape::Disc | Shape::Point => ("`suns`", "a sun"),
        };
        return Err(Error::setting(
            format!("`lines exact` with {setting}"),
            format!("{light}, whose azimuths are no grid vectors"),
            "`method brute-force`, which is exact in every azimuth",
        ));
    }
    if active.is_grey {
        notes.push("one channel: every colour is grey".into());
    }
    let mut builder = Builder::new(limits);
    let bounces =
        if active.is_dark() { 0 } else { bounces::needed_bounces(scene, quality, &mut notes) };
    // Sub-sampled bounces need the visibility of the sky; walks find it themselves.
    let need_share = bounces > 0 && quality.subsample > 1 && !is_walked;
    let images = Images::make(&mut builder, scene, &active, (wanted, need_share));
    let mut lists = active.lists(
        images.need_circle(),
        quality,
        &sweep,
        (surface.border, field.cell_m()),
        &mut notes,
    )?;
    if is_walked && bounces > 0 {
        // After those of the lights.
        lists.push(azimuths::even(quality.bounces.azimuths, field.cell_m()));
    }
    let (mut tables, mut harmonics) = (None, None);
    let mirrored = active.by_slices(quality);
    // First, as their azimuths are the first constants.
    let slices = mirrored.map(|specular| {
        let lit = (active.environment, surface.border);
        let of = (specular, images.specular_map, lists[0].as_slice());
        SpecularSlices::make(&mut builder, [size[0], size[1]], lit, (quality, limits), of)
    });
    let has_diffuse = active.environment.is_some() && quality.basis == Basis::Sh;
    // The light that arrives at a texel, which its vector of exit radiance reflects.
    let keeps_vectors = bounces > 0 && quality.bounces.specular != BounceSpecular::Scalar;
    let has_specular = active.has_specular_around() && (mirrored.is_none() || keeps_vectors);
    if has_diffuse || has_specular {
        active.environment.map_or(Ok(()), Environment::check_series)?;
        if quality.wedges == Wedges::Table && matches!(sweep, Sweep::Surface { .. }) {
            return Err(Error::setting(
                "`wedges table` with `lines exact`",
                "wedges of uneven widths",
                "`method brute-force`, which is exact in every azimuth",
            ));
        }
        let lit = (active.environment, surface.border);
        let settings = (quality, [has_diffuse, has_specular]);
        harmonics = Some(Harmonics::make(&mut builder, size, lit, settings, &lists[0]));
    }
    if let Some(environment) = active.environment.filter(|_| !has_diffuse) {
        let lit = (environment, surface.border);
        tables = Some(Tables::make(&mut builder, lit, quality));
    }
    let eye_m = eye_over_base(field, wanted.eye_m, "picture: eye_m")?;
    if wanted.eye_m.is_some() && active.specular.is_some() && bounces > 0 {
        specular::check_viewed(quality)?;
    }
    if active.environment.is_none() && active.sky.is_some() && slices.is_none() {
        notes.push("no environment: no table".into());
    }
    let keeps = wanted.keeps_horizons;
    let is_editable = sweep.editable(surface.border).is_some()
        && harmonics.is_none()
        && images.sphere_sum.is_none()
        && images.specular_sum.is_none()
        && bounces == 0;
    let takes_edits = keeps && !wanted.still && is_editable;
    let edits = takes_edits.then(|| Edits::make(&mut builder, size));
    // Harmonics keep the visibility and a sky keeps its sum, so neither needs its lattices.
    let reads_lattices = tables.is_some() || slices.is_some();
    let kept_from = keeps.then_some(usize::from(harmonics.is_some() && !reads_lattices));
    let nodes = marched_nodes(&sweep, harmonics.as_ref(), &active, wanted);
    let (mut held, mut of_lights) =
        (Held { limits, kept_from, nodes, shadows: Vec::new(), later_bytes: 0 }, Vec::new());
    let narrow = active.by_shadow_heights();
    if !narrow.is_empty() && !wanted.unshadowed {
        match Shadows::suit(quality, &sweep, field, surface.border, (limits, builder.bytes())) {
            Ok(()) => of_lights = narrow,
            Err(Some(why)) => notes.push(format!("suns and key lights by hull sweeps: {why}")),
            Err(None) => {}
        }
    }
    let first_aimed = usize::from(images.need_circle());
    held.shadows.extend(of_lights.iter().map(|i| first_aimed + i));
    let shadows = (!of_lights.is_empty()).then(|| {
        let azimuths = held.shadows.iter().flat_map(|l| &lists[*l]);
        let (of, count) = (([size[0], size[1]], surface.border), active.aimed().count());
        // A sun near the zenith has fewer slices. With a sun at least `sun_azimuths`, so that the number does not change as it moves.
        let has_sun = of_lights.iter().any(|i| *i < active.suns.len());
        let least = if has_sun { quality.sun_azimuths } else { 1 };
        let slices = held.shadows.iter().map(|l| lists[*l].len() as u32).fold(least, u32::max);
        Shadows::make(&mut builder, azimuths, of, (&of_lights, count), (slices, limits))
    });
    let walked_azimuths = lists.last().filter(|_| is_walked && bounces > 0);
    let walked = walked_azimuths.map(|azimuths| {
        let of = ([size[0], size[1]], surface.border);
        let ground = BounceGround::make(&mut builder, of.0, active.is_grey);
        let form = (sweep.line_shift(), active.is_grey);
        let line_blocks = LineBlocks::make(&mut builder, azimuths, form, of, limits);
        (ground, line_blocks)
    });
    let shared = (bounces, images.sky_sum);
    let room = has_cache.then_some(limits);
    let at_nodes = BounceNodes::make(&mut builder, size, quality, shared, room, &mut notes);
    let is_soft = quality.light_basis == LightBasis::Sh && images.sphere_sum.is_some();
    // Sphere lights in harmonics over pyramids trace no rays.
    let has_rays = images.sphere_sum.is_some() && !(is_soft && quality.method == Method::Pyramid)
        || bounces > 0 && quality.bounces.engine == BounceEngine::BruteForce;
    let need_ground =
        images.sphere_sum.is_some() || (bounces > 0 && !is_walked) || at_nodes.is_some();
    let blocks = need_ground.then(|| Blocks::make(&mut builder, size, surface.border, has_rays));
    let of_light = (active.is_grey, wanted.light_layers);
    let bouncing = |builder: &mut Builder, levels, notes: &mut Vec<String>| {
        let specular = active.specular.is_some().then_some(notes);
        let (found, read) = ((bounces, at_nodes), (levels, walked));
        Bouncing::make(builder, scene, quality, found, read, of_light, specular)
    };
    if bounces > 0 {
        // Makes the images of bounces in a plan of their own first, to measure their bytes.
        let mut alone = Builder::new(limits);
        let levels = match &sweep {
            Sweep::Pyramid(pyramid) => pyramid.images(&mut alone),
            _ => None,
        };
        let before = alone.bytes();
        bouncing(&mut alone, levels, &mut Vec::new());
        held.later_bytes = alone.bytes() - before;
    }
    let (sweeping, lists) = if lists.is_empty() {
        (None, Lists::default())
    } else {
        let (sweeping, lists) =
            prepare(&mut builder, field, surface.border, sweep, images.heights, lists, &held)?;
        (Some(sweeping), lists)
    };
    let levels = sweeping.as_ref().and_then(|s| s.levels);
    let bouncing = (bounces > 0).then(|| bouncing(&mut builder, levels, &mut notes));
    // Suns by shadow heights alone have no settings of sweeps.
    let has_others = lists.lists.len() > of_lights.len();
    let sweep = sweeping.as_ref().filter(|_| has_others).map(|s| &s.sweep);
    let soft = is_soft.then(|| {
        SphereSh::make(&mut builder, (size, surface.border), quality, images.heights, levels)
    });
    if let Some(soft) = &soft {
        passes::sphere_sh_shade::check(surface.border, field, soft)?;
    }
    let has_series = harmonics.is_some();
    let of_scene = (surface.border, &active, has_series);
    let mut used = used(quality, sweep, of_scene, &images, soft.as_ref());
    if !of_lights.is_empty() && !has_others {
        used.push(("method".into(), Method::Auto.name().into()));
    }
    used.push(("bounces".into(), bouncing.as_ref().map_or(0, Bouncing::count).to_string()));
    if bouncing.is_some() {
        used.extend(quality.bounces.used());
    }
    let of_bounces = bouncing.iter().flat_map(Bouncing::used);
    let more: Vec<_> = of_bounces.filter(|(name, _)| used.iter().all(|u| u.0 != *name)).collect();
    used.extend(more);
    let mut drawing = Drawing {
        builder,
        scene,
        active,
        images,
        tables,
        harmonics,
        slices,
        eye_m,
        sweeping,
        shadows,
        blocks,
        bouncing,
        soft,
        edited: None,
        is_begun: false,
        specular_is_begun: false,
    };
    drawing.fill_tables(quality);
    drawing.light(&lists, quality)?;
    if let Some(edits) = edits {
        drawing.edit(size, &lists, edits);
        drawing.light(&lists, quality)?;
    }
    Plan::finish(drawing.builder, size, lists.lists.concat(), notes, used, limits)
}

fn without_bounces(quality: &Quality) -> Quality {
    Quality { bounces: Bounces { count: 0, ..quality.bounces }, ..*quality }
}

/// Texels of the inputs of a [`picture`](picture()) that the scene holds, in the order of its plan: "heights";
/// "environment" and "albedo", opaque, if the scene has them; "phong", exponent and scale, if it is a map.
pub fn picture_inputs(scene: &Scene) -> Vec<Vec<f32>> {
    let opaque =
        |texels: &[[f32; 3]]| texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    let mut all = vec![scene.field.heights_m().to_vec()];
    if let Some(environment) = &scene.lights.environment {
        all.push(opaque(environment.texels()));
    }
    if let Albedo::Map(map) = &scene.surface.albedo {
        all.push(opaque(map));
    }
    if let Some(Specular::Map(map)) =
        scene.surface.specular.as_ref().filter(|l| l.largest().scale > 0.0)
    {
        all.push(specular_texels(map));
    }
    all
}

/// The nodes at which marching methods run: only the sub-sampled ones if nothing else uses their horizons.
fn marched_nodes(
    sweep: &Sweep,
    harmonics: Option<&Harmonics>,
    active: &ActiveLights<'_>,
    wanted: Picture,
) -> Nodes {
    let is_marched = matches!(sweep, Sweep::March { .. } | Sweep::Pyramid(_));
    let is_alone = active.sky.is_none() && active.aimed().next().is_none() && !wanted.sky_view;
    // A wedge table needs the horizons of all texels.
    let nodes = harmonics.filter(|h| h.wedge_table.is_none() && is_marched && is_alone);
    let nodes = nodes.map(|h| h.sh().nodes);
    nodes.unwrap_or(Nodes { stride: 1 })
}

/// The effective settings.
fn used(
    quality: &Quality,
    sweep: Option<&Sweep>,
    (border, active, has_series): (Border, &ActiveLights<'_>, bool),
    images: &Images,
    soft: Option<&SphereSh>,
) -> Vec<(String, String)> {
    let mut used = settings(sweep, border);
    if images.need_circle() {
        used.push(("azimuths".into(), quality.azimuths.to_string()));
    }
    let mut add = |name: &str, value: &str| used.push((name.into(), value.into()));
    let by_table = active.environment.is_some() && quality.basis != Basis::Sh;
    if by_table || has_series {
        add("basis", if quality.basis == Basis::Sh { "sh" } else { "table" });
    }
    if by_table {
        add("table_elevations", &quality.table_elevations.to_string());
    }
    if has_series {
        add("sh_order", &quality.sh_order.to_string());
        add("wedges", quality.wedges.name());
        add("receiver", quality.receiver.name());
        add("window", quality.window.name());
        add("subsample", &quality.subsample.to_string());
        if quality.wedges == Wedges::Table {
            add("wedge_side", &quality.wedge_side.to_string());
        }
    }
    let has_spheres = !active.near.active.is_empty();
    if has_spheres || active.aimed().any(|light| light.shape != Shape::Point) {
        used.push(("sun_azimuths".into(), quality.sun_azimuths.to_string()));
    }
    if has_spheres {
        // Specular light has no cutoff.
        if active.specular.is_none() {
            used.push(("light_cutoff".into(), quality.light_cutoff.to_string()));
        }
        used.push(("light_basis".into(), quality.light_basis.name().into()));
    }
    for setting in soft.map(|soft| soft.settings(quality)).into_iter().flatten() {
        if used.iter().all(|(name, _)| *name != setting.0) {
            used.push(setting);
        }
    }
    used
}
