mod lights;
mod order;
mod wanted;

use std::ops::Range;

use glam::DVec3;

use super::bend::Bends;
use super::visible_points::{images, one_image, plan_batch, texels};
use crate::graph::bytes_text;
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::blocks::Blocks;
use crate::passes::scatter_gather::{self as pass, Source, Steps};
use crate::plan::Plan;
use crate::scene::{
    Albedo, Curvature, Directions, HeightField, Scatter, Scene, Specular, VisiblePoints, check_view,
};
use crate::{Error, Result};
use lights::sun_texels;
pub(crate) use lights::{sky_of, towards};
use order::order;
use wanted::Wanted;

/// Largest memory, bytes, of the two images that carry paths from step to step. More paths in parallel keep a large device
/// busy on a small field.
const CARRIED_BYTES: u64 = 64 << 20;
/// Largest memory, bytes, of the light scattered towards parallel views.
const VIEWS_BYTES: u64 = 256 << 20;
/// Largest number of parallel paths.
const MOST_AT_ONCE: u64 = 64;

/// Passes that scatter light by the method of dependent tests (Heidrich et al. 2000, §3.1-3.2). Each step of a path is one
/// direction for the whole field and a look-up of each texel's visible point along it, from the far end to the texels.
///
/// Inputs: those of [`scatter_inputs`]. Output: "scattered", the light reflected 1 to `bounces` times before it leaves
/// each texel: the mean of the paths so far, and their number. It excludes direct light. After each pass without a step in
/// its name it is the result of fewer paths.
///
/// Diffuse paths start from the direct light of all lights, including sky and environment, so paths that leave the field
/// add nothing. Phong lobes reflect towards the previous vertex: each vertex adds the specular of suns, as points at their
/// centres, and of the sky where a path leaves the field.
///
/// On a curved base ([`Scatter::curvature`]) each texel has directions of its own: 20 more bytes per texel and direction,
/// in one image. The direct light must then be that on the curved base.
///
/// Paths choose each of `directions` once before any is repeated, in an order that depends on the seed, independently for
/// every step.
///
/// The planner drops what the scene does not need, with a note: bounces within [`Scatter::cutoff`], paths of one step that
/// would repeat all directions, specular of scale 0, specular of dark lights. If nothing scatters, on black ground or
/// where no two points see each other, "scattered" is 0 and there are no inputs.
///
/// A plan with [`Scatter::first_path`] adds paths to those in "scattered"
/// ([`Renderer::replace_plan`](crate::gpu::Renderer::replace_plan)) if both plans have the same number.
///
/// # Errors
/// A number of [`Scatter`] or of its curvature out of range; a field of unknown heights; a plan beyond the memory limits.
pub fn scatter(
    scene: &Scene,
    directions: &Directions,
    scatter: &Scatter,
    limits: &Limits,
) -> Result<Plan> {
    scatter_views(scene, directions, scatter, &[scatter.view], limits)
}

/// As [`scatter`](scatter()), for several views, unit vectors: "scattered" has a layer for each, in order;
/// [`Scatter::view`] is ignored. Only the last step of a path depends on the view: d steps to v views take d - 1 + v
/// look-ups per path and texel instead of d v.
///
/// # Errors
/// As [`scatter`](scatter()); no views, or more than an image has layers; a view that is not a unit vector.
pub fn scatter_views(
    scene: &Scene,
    directions: &Directions,
    scatter: &Scatter,
    views: &[DVec3],
    limits: &Limits,
) -> Result<Plan> {
    let changed = scatter.check(scene)?;
    views.iter().try_for_each(|view| check_view(*view))?;
    let most = limits.image_layers;
    if !(1..=most as usize).contains(&views.len()) {
        let found = views.len().to_string();
        return Err(Error::setting("views", found, format!("1 to {most} on this device")));
    }
    let Scene { field, surface, .. } = scene;
    let size = limits.check_size(field.rows(), field.cols())?;
    super::visible_points::check_field(field)?;
    let mut notes = Vec::new();
    let wanted = Wanted::of(scene, directions.count(), scatter, &mut notes);
    let mut builder = Builder::new(limits);
    let rgba = Format::Rgba32Float;
    let extent = [size[0], size[1], views.len() as u32];
    let scattered = builder.image("scattered", Owner::Output, rgba, extent, true);
    let mut image = |name: &str, owner: Owner, format: Format| {
        builder.image(name, owner, format, [size[0], size[1], 1], false)
    };
    let layers = views.len() as u32;
    let mut at_once = 0;
    let mut carried = Vec::new();
    if wanted.paths == 0 {
        pass::plan_nothing(&mut builder, field, (scattered, layers));
    } else {
        let heights = image("heights", Owner::Input, Format::R32Float);
        let mut bound = vec![("direct", image("direct", Owner::Input, rgba))];
        if matches!(surface.albedo, Albedo::Map(_)) {
            bound.push(("albedo_map", image("albedo", Owner::Input, rgba)));
        }
        if matches!(wanted.specular, Some(Specular::Map(_))) {
            bound.push(("phong_map", image("phong", Owner::Input, rgba)));
        }
        let points = images(&mut builder, size, directions.count(), Owner::Input, limits)?;
        let suns = wanted.towards_suns()?;
        let blocks = Blocks::make(&mut builder, size, surface.border, suns.is_some());
        bound.push(("ground", blocks.ground));
        blocks.plan(&mut builder, field, heights, None);
        let steps = wanted.steps();
        let order = order(directions.vectors(), scatter, wanted.paths, steps);
        let (links, first_link) =
            builder.constants(&link_texels(scene, directions, &order, wanted.mirrors_sky));
        let (_, first_sun) = builder.constants(&sun_texels(&wanted.suns));
        let texels_of_views: Vec<f32> =
            views.iter().flat_map(|v| [v.x as f32, v.y as f32, v.z as f32, 0.0]).collect();
        let (_, first_view) = builder.constants(&texels_of_views);
        bound.push(("links", links));
        if let Some(suns) = &suns {
            let all = images_of_suns(&mut builder, size, suns, limits)?;
            let (_, first) = builder.constants(&texels(suns));
            plan_batch(
                &mut builder,
                (field, surface.border),
                &blocks,
                (links, first),
                suns,
                all.clone(),
            );
            bound.push(("sun_points", all.0));
        }
        if scatter.curvature != Curvature::FLAT {
            let one = one_image(field, directions, &points, limits)?;
            let bends = Bends::make(&mut builder, size, directions, limits)?;
            let ids = [one, blocks.ground];
            bends.plan(&mut builder, (field, surface.border), scatter.curvature, ids);
            bound.push(("bent", bends.bent));
            bound.push(("fan_weights", bends.weigh(&mut builder, field)));
        }
        let grid_points = u64::from(size[0]) * u64::from(size[1]);
        let is_chained = steps > 1;
        let fitting = CARRIED_BYTES / (2 * 16 * grid_points);
        // Parallel paths need one image of visible points.
        let most = match (points.len(), is_chained) {
            (1, true) => fitting.clamp(1, MOST_AT_ONCE).min(limits.image_layers.into()) as u32,
            (1, false) => MOST_AT_ONCE as u32,
            _ => 1,
        };
        at_once = most.min(wanted.paths);
        carried = (0..if is_chained { 2 } else { 0 })
            .map(|k| {
                let extent = [size[0], size[1], at_once];
                builder.image(format!("carried.{k}"), Owner::Internal, rgba, extent, true)
            })
            .collect::<Vec<ResourceId>>();
        let of = Steps {
            field,
            albedo: &surface.albedo,
            specular: wanted.specular,
            suns: wanted.suns.len(),
            texels: [first_link, first_sun, first_view],
            count: steps,
            first_path: scatter.first_path,
            weight_sr: directions.share_sr() * directions.count() as f64,
            views: layers,
            direct_specular: wanted.direct_specular,
            curvature: scatter.curvature,
        };
        let of_layer = if VisiblePoints::is_small(field.rows(), field.cols()) { 2 } else { 1 };
        for first in (0..wanted.paths).step_by(at_once as usize) {
            let paths = first..wanted.paths.min(first + at_once);
            let deepest = steps - 1;
            for step in (0..=deepest).rev() {
                let source = match () {
                    () if step < deepest => Source::Carried,
                    () if wanted.mirrors_lights() => Source::None,
                    () => Source::Direct,
                };
                let direction = order[(first * steps + step) as usize] / of_layer;
                let holds = |(_, layers): &&(ResourceId, Range<u32>)| layers.contains(&direction);
                let (of_direction, layers) =
                    points.iter().find(holds).expect("every direction has a layer");
                let mut bound = bound.clone();
                bound.push(("visible_points", *of_direction));
                if source == Source::Carried {
                    bound.push(("carried_in", carried[(step as usize + 1) % 2]));
                }
                bound.push(match step {
                    0 => ("scattered", scattered),
                    _ => ("carried", carried[step as usize % 2]),
                });
                let what = (step, paths.clone(), source);
                pass::plan(&mut builder, &of, what, of_layer * layers.start, &bound);
            }
        }
    }
    let carried_bytes: u64 = carried.iter().map(|id| builder.bytes_of(*id)).sum();
    let settings = [
        ("method", "scattering by visible points".to_owned()),
        ("border", format!("{:?}", surface.border).to_lowercase()),
        ("directions", directions.count().to_string()),
        ("lowest_direction_z", directions.lowest_z().to_string()),
        ("directions_hash", hash_text(directions)),
        ("bounces", wanted.bounces.to_string()),
        ("bounce_cutoff", scatter.cutoff.to_string()),
        ("paths", wanted.paths.to_string()),
        ("paths_before", scatter.first_path.to_string()),
        ("paths_at_once", at_once.to_string()),
        ("seed", scatter.seed.to_string()),
        ("views", views.len().to_string()),
        ("curvature_per_m", format!("{:?}", scatter.curvature.per_m)),
        ("carried", bytes_text(carried_bytes)),
    ];
    let settings = settings.map(|(name, value)| (name.to_owned(), value)).to_vec();
    if scatter.curvature != Curvature::FLAT && wanted.bounces > 0 {
        notes.push(format!(
            "the base {changed}: error of scattered light about {:.4} or less of the largest direct light, mean over texels",
            changed.scattered(surface.max_reflectance(), wanted.bounces)
        ));
    }
    if directions.lowest_z() > -1.0 && wanted.paths > 0 {
        notes.push(format!(
            "directions reach down to a height of {} alone: slopes lose what light comes from below it",
            directions.lowest_z()
        ));
    }
    Plan::finish(builder, size, Vec::new(), notes, settings, limits)
}

/// Number of `views` in one plan: the scattered light towards them takes at most 256 MiB and fits the layers of an image.
/// The next views need the paths again.
pub fn views_at_once(field: &HeightField, views: usize, limits: &Limits) -> usize {
    let fitting = VIEWS_BYTES / (16 * field.heights_m().len() as u64);
    fitting.clamp(1, limits.image_layers.into()).min(views.max(1) as u64) as usize
}

fn hash_text(directions: &Directions) -> String {
    format!("{:016x}", directions.hash())
}

/// Texels of the inputs of a [`scatter`](scatter()), in the order of its plan: "heights"; "direct", the exit radiance of
/// each texel under all lights without specular; "albedo" and "phong" (exponent, scale) if they are maps; the visible
/// points, in as many images as `plan` has.
///
/// # Errors
/// Points of another field or other directions; direct light without one colour per texel.
pub fn scatter_inputs(
    plan: &Plan,
    scene: &Scene,
    points: &VisiblePoints,
    direct: &[[f32; 3]],
) -> Result<Vec<Vec<f32>>> {
    let Scene { field, surface, .. } = scene;
    points.check(field, surface.border)?;
    let count = points.directions().count();
    let differ = |found: String, expected: &str| {
        Err(Error::setting("directions of the visible points", found, expected))
    };
    let own = hash_text(points.directions());
    let wanted = plan.settings.iter().find(|(name, _)| name == "directions_hash");
    let wanted = wanted.map_or("a plan of scattered light", |(_, value)| value);
    if own != wanted {
        let expected = format!("those of the plan, {wanted}: vectors and lowest height alike");
        return differ(format!("{count} with the hash {own}"), &expected);
    }
    let grid_points = field.rows() * field.cols();
    if direct.len() != grid_points {
        let found = format!("{} colours", direct.len());
        return Err(Error::setting(
            "direct light",
            found,
            format!("{grid_points}, one per grid point"),
        ));
    }
    let four = |texels: &[[f32; 3]]| -> Vec<f32> {
        texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect()
    };
    // A plan that scatters nothing has no inputs.
    if plan.inputs().next().is_none() {
        return Ok(Vec::new());
    }
    let mut all = vec![field.heights_m().to_vec(), four(direct)];
    if let Albedo::Map(map) = &surface.albedo {
        all.push(four(map));
    }
    if let Some(Specular::Map(map)) = &surface.specular
        && plan.inputs().any(|(_, r)| r.name == "phong")
    {
        all.push(map.iter().flat_map(|p| [p.exponent, p.scale, 0.0, 1.0]).collect());
    }
    let mut words = points.words();
    for (_, resource) in plan.inputs().filter(|(_, r)| r.name.starts_with("visible_points")) {
        let wanted = (resource.bytes() / 4) as usize;
        let Some((own, rest)) = words.split_at_checked(wanted) else {
            return differ(count.to_string(), "those of the plan");
        };
        // Words travel as the bits of floats.
        all.push(own.iter().map(|word| f32::from_bits(*word)).collect());
        words = rest;
    }
    if !words.is_empty() {
        return differ(count.to_string(), "those of the plan");
    }
    Ok(all)
}

fn images_of_suns(
    builder: &mut Builder,
    size: [u32; 2],
    suns: &Directions,
    limits: &Limits,
) -> Result<(ResourceId, Range<u32>)> {
    let is_small = VisiblePoints::is_small(size[1] as usize, size[0] as usize);
    let layers = VisiblePoints::layers(suns.count(), is_small) as u32;
    if layers > limits.image_layers {
        return Err(Error::Limit {
            what: format!("specular of {} suns", suns.count()),
            needs: format!("an image of {layers} layers"),
            limit: format!("{} on this device", limits.image_layers),
        });
    }
    let extent = [size[0], size[1], layers];
    let id = builder.image("sun_points", Owner::Internal, Format::R32Uint, extent, true);
    Ok((id, 0..layers))
}

/// Two a step of every path: direction and its number; the light of the sky there.
fn link_texels(
    scene: &Scene,
    directions: &Directions,
    order: &[u32],
    mirrors_sky: bool,
) -> Vec<f32> {
    let sky = match mirrors_sky {
        true => sky_of(scene, directions),
        false => vec![[0.0; 3]; directions.count()],
    };
    let vectors = directions.vectors();
    let link = |i: &u32| {
        let (e, [r, g, b]) = (vectors[*i as usize], sky[*i as usize]);
        [e.x as f32, e.y as f32, e.z as f32, *i as f32, r as f32, g as f32, b as f32, 0.0]
    };
    order.iter().flat_map(link).collect()
}
