pub(super) mod choice;

use std::f64::consts::{FRAC_PI_2, TAU};

use super::Plan;
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::blocks::Blocks;
use crate::passes::path_trace::{self, BATCH_PATHS};
use crate::plan::reference::choice::{choice_density, environment_cdf, max_path_light};
use crate::scene::{
    ANY_LIGHT, Albedo, Border, HeightField, KeyLight, Lights, Normals, PhongSpecular, Scene,
    Specular, Sun,
};
use crate::{Error, Result};

/// Paths per texel in one batch of a [`reference`](reference()).
pub const REFERENCE_BATCH: u32 = BATCH_PATHS;

/// Largest number of bounces: [0..64].
const MOST_BOUNCES: u32 = 64;

/// Passes that trace one batch of [`REFERENCE_BATCH`] light paths from every texel, as `cpu::bounce` defines them, with
/// all bounces up to `bounces`. Phong specular reflects at every vertex, about the mirror direction of the incoming path.
/// With smooth [`Normals`], a path that hits a triangle continues from a corner, drawn by barycentric weight.
///
/// The specular of texels is viewed from `eye_m`, as in [`Picture::eye_m`](super::Picture::eye_m). The plan's setting
/// "eye_m" states it where the surface has specular; nothing else depends on it.
///
/// Inputs: those of [`reference_inputs`]. Outputs, four channels each: "radiance", the mean of all batches so far, and
/// "standard_error", that of the mean, infinite after the first batch; its fourth channel counts the traced rays.
///
/// Running the whole plan starts again. Running only its passes `path_trace`, one per band of rows, adds a batch; with
/// many lights several passes, in order, each add a part of one. The same seed gives the same bits on the same device.
/// Buffer "lost_rays" counts lost rays: 0 in a correct result.
///
/// The paths of a batch are one randomised net. Batches are independent: the standard error follows from the spread
/// between them. It does not include unsampled light: see [`unsampled_light_error`].
///
/// # Errors
/// Bounces, eye, surface or lights out of range; no light; a field of unknown heights; a scene beyond the limits.
pub fn reference(
    scene: &Scene,
    bounces: u32,
    normals: Normals,
    eye_m: Option<[f64; 3]>,
    seed: u32,
    limits: &Limits,
) -> Result<Plan> {
    traced(scene, (bounces, normals, eye_m, seed), None, None, limits)
}

/// As [`reference`](reference()), with one dispatch per `band_rows` rows, 1 or more, for hosts that render frames in
/// between. The bits do not depend on the bands.
///
/// # Errors
/// As [`reference`](reference()); 0 rows.
pub fn reference_in_bands(
    scene: &Scene,
    bounces: u32,
    normals: Normals,
    eye_m: Option<[f64; 3]>,
    seed: u32,
    limits: &Limits,
    band_rows: u32,
) -> Result<Plan> {
    if band_rows == 0 {
        return Err(Error::setting("rows of a band", "0", "1 or more"));
    }
    traced(scene, (bounces, normals, eye_m, seed), None, Some(band_rows), limits)
}

/// As [`reference`](reference()), for a list of texels and their indirect light only: light that has been reflected at
/// least once before it reaches them.
///
/// Inputs: those of [`reference_inputs`], then the texels of [`listed_places`]. The outputs have the size of that list.
///
/// # Errors
/// As [`reference`](reference()); an empty list, or more texels than the field has.
pub fn reference_at(
    scene: &Scene,
    bounces: u32,
    normals: Normals,
    eye_m: Option<[f64; 3]>,
    seed: u32,
    places: usize,
    limits: &Limits,
) -> Result<Plan> {
    let all = scene.field.rows() * scene.field.cols();
    if !(1..=all).contains(&places) {
        let expected = format!("1 to {all}, as the field has");
        return Err(Error::setting("places of a reference", places.to_string(), expected));
    }
    traced(scene, (bounces, normals, eye_m, seed), Some(places as u32), None, limits)
}

/// The input list of [`reference_at`]: positions of texels in the field, row-major, in rows as long as the field's. The
/// last row is padded.
///
/// # Errors
/// A position beyond the field, named by its index in the list.
pub fn listed_places(scene: &Scene, places: &[usize]) -> Result<Vec<f32>> {
    let cols = scene.field.cols();
    let count = cols * scene.field.rows();
    if let Some(at) = places.iter().position(|i| *i >= count) {
        let (name, found) = (format!("places of a reference: position {at}"), places[at]);
        return Err(Error::setting(name, found.to_string(), format!("less than {count}")));
    }
    let texel = |i: &usize| [(i % cols) as f32, (i / cols) as f32, 0.0, 0.0];
    let mut all: Vec<f32> = places.iter().flat_map(texel).collect();
    let whole = places.len().next_multiple_of(cols);
    all.extend([-1.0, -1.0, 0.0, 0.0].repeat(whole - places.len()));
    Ok(all)
}

fn traced(
    scene: &Scene,
    (bounces, normals, eye_m, seed): (u32, Normals, Option<[f64; 3]>, u32),
    listed: Option<u32>,
    band_rows: Option<u32>,
    limits: &Limits,
) -> Result<Plan> {
    let Scene { field, surface, lights } = scene;
    lights.check()?;
    surface.check(field.rows() * field.cols())?;
    field.check_known("field of a reference", "heights: paths end above the highest")?;
    if bounces > MOST_BOUNCES {
        let expected = format!("a whole number from 0 to {MOST_BOUNCES}");
        return Err(Error::setting("bounces", bounces.to_string(), expected));
    }
    let eye_m = eye_m.filter(|_| surface.specular.is_some());
    let eye_over_base_m = eye_over_base(field, eye_m, "eye_m")?;
    if let Some(light) = lights.near().find(|light| !light.of.has_paths) {
        let expected = format!("no {}s: the path-traced reference would omit them", light.of.name);
        return Err(Error::setting("lights", light.name(), expected));
    }
    let count = lights.suns.len() + lights.keys.len() + lights.sphere_lights.len();
    if count == 0 && lights.sky.is_none() && lights.environment.is_none() {
        return Err(Error::setting("lights", "none", ANY_LIGHT));
    }
    if count > limits.image_side as usize {
        return Err(Error::Limit {
            what: format!("{count} suns, key lights and sphere lights"),
            needs: format!("an image {count} texels long"),
            limit: format!("{} on this device", limits.image_side),
        });
    }
    let size = limits.check_size(field.rows(), field.cols())?;

    let mut builder = Builder::new(limits);
    let mut image = |name: &str, owner: Owner, format: Format, [width, height]: [u32; 2]| {
        builder.image(name, owner, format, [width, height, 1], false)
    };
    let rgba = Format::Rgba32Float;
    let mut bound: Vec<(&str, ResourceId)> = Vec::new();
    let heights = image("heights", Owner::Input, Format::R32Float, size);
    if let Some(environment) = &lights.environment {
        let [width, height] = [environment.width() as u32, environment.height() as u32];
        bound.push(("environment", image("environment", Owner::Input, rgba, [width, height])));
        let cdf = image("environment_cdf", Owner::Input, Format::R32Float, [width + 1, height]);
        bound.push(("environment_cdf", cdf));
    }
    bound.push(("lights", image("lights", Owner::Input, rgba, [2, count.max(1) as u32])));
    if matches!(surface.albedo, Albedo::Map(_)) {
        bound.push(("albedo_map", image("albedo", Owner::Input, rgba, size)));
    }
    if matches!(surface.specular, Some(Specular::Map(_))) {
        bound.push(("phong_map", image("phong", Owner::Input, rgba, size)));
    }
    let summed = match listed {
        None => size,
        Some(count) => [size[0], count.div_ceil(size[0])],
    };
    if listed.is_some() {
        bound.push(("places", image("places", Owner::Input, rgba, summed)));
    }
    for output in ["radiance", "standard_error"] {
        bound.push((output, image(output, Owner::Output, rgba, summed)));
    }
    let batch_mean = image("batch_mean", Owner::Internal, rgba, summed);
    let batch_spread = image("batch_spread", Owner::Internal, rgba, summed);
    let lost_rays = builder.buffer("lost_rays", 16, false);
    let blocks = Blocks::make(&mut builder, size, surface.border, true);
    let [cells, maxima] = blocks.of_rays();
    bound.extend([
        ("cells", cells),
        ("ground", blocks.ground),
        ("maxima", maxima),
        ("batch_mean", batch_mean),
        ("batch_spread", batch_spread),
        ("lost_rays", lost_rays),
    ]);
    blocks.plan(&mut builder, field, heights, Some([batch_mean, lost_rays]));
    let rows = summed[1];
    let (parts, lookups) = path_trace::parts(scene, &blocks, bounces, limits.lookups);
    let band_rows = band_rows.unwrap_or_else(|| {
        let vertices = u64::from(BATCH_PATHS) * u64::from(bounces.min(3) + 1);
        let cols = u64::from(size[0]);
        let rows = (BAND_VERTICES / (cols * vertices)).min(limits.lookups / (cols * lookups));
        (rows / 8 * 8).clamp(8, 1 << 24) as u32
    });
    if parts.len() > 1 {
        let sum = builder.image("part_sum", Owner::Internal, rgba, [size[0], rows, 1], false);
        bound.push(("part_sum", sum));
    }
    for first in (0..rows).step_by(band_rows as usize) {
        let band = first..rows.min(first + band_rows);
        for part in &parts {
            let dispatch = (band.clone(), (parts.len() > 1).then_some(part), listed);
            path_trace::plan(
                &mut builder,
                scene,
                &blocks,
                (bounces, normals, eye_over_base_m, seed),
                dispatch,
                &bound,
            );
        }
    }
    let mut used = vec![
        ("method".to_owned(), "path tracing".to_owned()),
        ("border".to_owned(), format!("{:?}", surface.border).to_lowercase()),
        ("bounces".to_owned(), bounces.to_string()),
        ("normals".to_owned(), format!("{normals:?}").to_lowercase()),
        ("seed".to_owned(), seed.to_string()),
        ("paths_of_a_batch".to_owned(), BATCH_PATHS.to_string()),
    ];
    used.extend(eye_m.map(|[x, y, z]| ("eye_m".to_owned(), format!("{x},{y},{z}"))));
    Plan::finish(builder, size, Vec::new(), Vec::new(), used, limits)
}

/// An eye over the field's base, as passes read it; the last number is 0 for a view from straight above.
///
/// # Errors
/// An eye out of range, as the setting `name`.
pub(super) fn eye_over_base(
    field: &HeightField,
    eye_m: Option<[f64; 3]>,
    name: &str,
) -> Result<[f32; 4]> {
    let Some(eye) = eye_m else { return Ok([0.0; 4]) };
    if !eye.iter().all(|v| v.abs() <= 1e15) {
        return Err(Error::setting(name, format!("{eye:?}"), "numbers within ±1e15"));
    }
    let [x, y, z] = eye;
    Ok([x as f32, y as f32, (z - field.base_m()) as f32, 1.0])
}

/// Approximate number of path vertices per dispatch. A run can be interrupted between dispatches.
const BAND_VERTICES: u64 = 1 << 24;

/// Standard error of unsampled light after `paths` paths per texel of a [`reference`](reference()), R, G, B. Add it to
/// the standard error of the batches as the root of the sum of squares.
///
/// An event that N paths have not sampled has a share of at most 3/N with 95 % confidence (the rule of three). With the
/// upper bound W of one path's light, its variance is at most 3W²/N².
pub fn unsampled_light_error(scene: &Scene, bounces: u32, paths: u32) -> [f64; 3] {
    max_path_light(scene, bounces).map(|most| 3_f64.sqrt() * most / f64::from(paths))
}

/// Texels of the inputs of a [`reference`](reference()), in the order of its plan: "heights"; "environment" (fourth
/// channel: density of the chosen directions, 1/sr) and "environment_cdf" if there is one; "lights"; "albedo" and "phong"
/// (exponent, scale) if they are maps.
pub fn reference_inputs(scene: &Scene) -> Vec<Vec<f32>> {
    let opaque = |texels: &[[f32; 3]]| -> Vec<f32> {
        texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect()
    };
    let Scene { field, surface, lights } = scene;
    let mut all = vec![field.heights_m().to_vec()];
    if let Some(environment) = &lights.environment {
        let cdf = environment_cdf(environment, surface.border);
        let density = choice_density(environment, &cdf);
        let texels = environment.texels().iter().zip(&density);
        all.push(texels.flat_map(|(t, d)| [t[0], t[1], t[2], *d as f32]).collect());
        all.push(cdf);
    }
    all.push(light_texels(lights, surface.border, field.base_m()));
    if let Albedo::Map(map) = &surface.albedo {
        all.push(opaque(map));
    }
    if let Some(Specular::Map(map)) = &surface.specular {
        all.push(specular_texels(map));
    }
    all
}

/// Four channels a texel: exponent, scale.
pub(super) fn specular_texels(map: &[PhongSpecular]) -> Vec<f32> {
    map.iter().flat_map(|specular| [specular.exponent, specular.scale, 0.0, 1.0]).collect()
}

/// Two texels per light: suns, key lights, sphere lights. See `path_trace.comp`.
fn light_texels(lights: &Lights, border: Border, base_m: f64) -> Vec<f32> {
    let mut all = Vec::new();
    for sun in lights.suns.iter().map(Sun::clamped) {
        // The rounding error of π is not a direction: along a line of grid points its sign would decide the result.
        let level = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
        let (sin, cos) = sun.azimuth_rad.sin_cos();
        let (up, along) = sun.elevation_rad.sin_cos();
        let [sin, cos, along] = [sin, cos, along].map(level);
        let radius = 0.5 * sun.diameter_rad;
        // E = L π sin²r facing; all of the cone gives L 2π (1 - cos r) = E · 2 / (1 + cos r).
        let spread = 2.0 / (1.0 + radius.cos());
        let cone = 2.0 * (0.5 * radius).sin().powi(2);
        all.extend([cos * along, sin * along, up, cone].map(|v| v as f32));
        all.extend(sun.irradiance.map(|e| (spread * f64::from(e)) as f32));
        all.push(1.0);
    }
    for key in lights.keys.iter().map(KeyLight::clamped) {
        let [top, bottom] = visible_part(&key, border);
        let first = (key.azimuth_rad - 0.5 * key.width_rad) / TAU;
        all.extend([first.rem_euclid(1.0), key.width_rad / TAU, top, bottom].map(|v| v as f32));
        let solid_angle = key.width_rad * 2.0 * (bottom - top);
        all.extend(key.radiance.map(|l| (solid_angle * f64::from(l)) as f32));
        all.push(1.0);
    }
    for sphere in &lights.sphere_lights {
        let [x, y, z] = sphere.position_m;
        all.extend([x, y, z - base_m, sphere.radius_m].map(|v| v as f32));
        all.extend(sphere.radiance);
        all.push(1.0);
    }
    if all.is_empty() {
        all.resize(8, 0.0);
    }
    all
}

/// sin² of half the zenith angle, (1 - sin elevation) / 2, of the highest and lowest elevation at which paths can reach a
/// key light: above horizontal if there is ground.
pub(super) fn visible_part(key: &KeyLight, border: Border) -> [f64; 2] {
    let least = if border == Border::Open { -FRAC_PI_2 } else { 0.0 };
    let [low, high] = key.elevations_rad.map(|e| e.max(least));
    [high, low].map(|e| (0.5 * (FRAC_PI_2 - e)).sin().powi(2))
}
