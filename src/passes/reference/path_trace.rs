use std::ops::Range;

use crate::graph::{Builder, MOST_TURNS, ResourceId, shaders};
use crate::passes::blocks::Blocks;
use crate::scene::{Albedo, Normals, PhongSpecular, Scene, Specular};

/// log2 of the paths per texel and batch, 8 at most. Fewer: more dispatches. More: a net fills its square more
/// evenly, but fewer batches estimate the standard error.
const SET_BITS: u32 = 6;

/// Paths per texel that one run of the pass adds.
pub(crate) const BATCH_PATHS: u32 = 1 << SET_BITS;

/// Lights per part, where there are as many; each part adds one scattered ray.
const LIGHTS_OF_A_PART: u32 = 16;

/// One dispatch of a batch: some of its paths, some of the lights at each vertex.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub paths: Range<u32>,
    pub lights: Range<u32>,
}

/// The parts of a batch; one where all of it is within the device's loop limit, and eight rows of it within `lookups`, if they can
/// be; and the lookups per texel of the largest. Few paths continue beyond a few bounces.
pub(crate) fn parts(
    scene: &Scene,
    blocks: &Blocks,
    bounces: u32,
    most_lookups: u64,
) -> (Vec<Part>, u64) {
    let lights = &scene.lights;
    let all = (lights.suns.len() + lights.keys.len() + lights.sphere_lights.len()) as u32;
    let vertices = bounces.min(3) + 1;
    let of_ray = blocks.levels.usual_steps();
    let others = 1 + u32::from(lights.environment.is_some());
    // One more iteration per light, and one where the scattered ray searches for a sphere light.
    let most_lights = |paths: u32| {
        (MOST_TURNS / (paths * vertices)).saturating_sub(others * of_ray) / (of_ray + 2)
    };
    let halves = (0..=SET_BITS).rev().map(|bits| 1 << bits);
    // A ray on from each vertex, one to an environment, and one to each light of the part.
    let lookups = |paths: u32| {
        let rays = u64::from(others + all.min(most_lights(paths).max(1)));
        u64::from(paths) * u64::from(vertices) * rays * blocks.levels.lookups()
    };
    let eight_rows = 8 * scene.field.cols() as u64;
    let enough = |paths: &u32| {
        most_lights(*paths) >= all.min(LIGHTS_OF_A_PART)
            && eight_rows * lookups(*paths) <= most_lookups
    };
    let paths = halves.into_iter().find(enough).unwrap_or(1);
    let at_once = most_lights(paths).max(1);
    let sets = (0..BATCH_PATHS).step_by(paths as usize).map(|first| first..first + paths);
    let each = lookups(paths);
    let parts = sets.flat_map(|paths| {
        (0..all.max(1)).step_by(at_once as usize).map(move |first| Part {
            paths: paths.clone(),
            lights: first.min(all)..(first + at_once).min(all),
        })
    });
    (parts.collect(), each)
}

/// One batch of paths from every texel of some rows, counted in eights; for `listed` texels, only their bounced
/// light, from some rows of the list. `eye_m` is over the field's base; its last number is 0 for a view from straight
/// above.
pub(crate) fn plan(
    builder: &mut Builder,
    scene: &Scene,
    blocks: &Blocks,
    (bounces, normals, eye_m, seed): (u32, Normals, [f32; 4], u32),
    (band, part, listed): (Range<u32>, Option<&Part>, Option<u32>),
    bound: &[(&str, ResourceId)],
) {
    let Scene { field, surface, lights } = scene;
    let (cols, rows) = (field.cols() as u32, field.rows() as u32);
    let grid_points = u64::from(cols) * u64::from(band.end - band.start);
    let mut label = Vec::new();
    let all_rows = listed.map_or(rows, |count| count.div_ceil(cols));
    if band.end - band.start < all_rows {
        label.push(format!("rows {}..{}", band.start, band.end));
    }
    if let Some(Part { paths, lights }) = part {
        let [path, light] = [paths, lights].map(|of| format!("{}..{}", of.start, of.end));
        label.push(format!("paths {path} lights {light}"));
    }
    let highest_m = field.heights_m().iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let count = lights.suns.len() + lights.keys.len() + lights.sphere_lights.len();
    let whole = Part { paths: 0..BATCH_PATHS, lights: 0..count as u32 };
    let Part { paths, lights: light_range } = part.unwrap_or(&whole);
    let [thin_rows, thin_cols] = blocks.thin(field);
    let four = |[r, g, b]: [f32; 3], w: f32| [r, g, b, w];
    let (albedo, is_map) = match surface.albedo {
        Albedo::Constant(colour) => (colour, false),
        Albedo::Map(_) => ([0.0; 3], true),
    };
    let specular = match &surface.specular {
        Some(Specular::Constant(phong)) => *phong,
        _ => PhongSpecular { exponent: 0.0, scale: 0.0 },
    };
    let turns = |e: &crate::scene::Environment| {
        (e.rotation_rad() / std::f64::consts::TAU).rem_euclid(1.0) as f32
    };
    builder.pass(
        shaders::PathTrace { border: surface.border as u32, thin_rows, thin_cols, set_bits: SET_BITS, albedo_is_map: is_map, has_environment: lights.environment.is_some(), has_specular: surface.specular.is_some(), has_lights: count > 0, has_keys: !lights.keys.is_empty(), has_sphere_lights: !lights.sphere_lights.is_empty(), has_bounces: bounces > 0, most_steps: blocks.levels.most_steps() as i32, in_parts: part.is_some(), specular_is_map: matches!(surface.specular, Some(Specular::Map(_))), at_places: listed.is_some(), smooth_normals: normals == Normals::Smooth },
        &label.join(" "),
        match listed {
            None => format!("{BATCH_PATHS} more paths per texel, up to {bounces} bounces"),
            Some(count) => format!(
                "{BATCH_PATHS} more paths from each of {count} texels: bounced light of up to {bounces} bounces"
            ),
        },
        shaders::PATH_TRACE.groups([cols, band.end - band.start, 1]),
        &shaders::PathTracePush {
            land: shaders::LandPush::of(field, &blocks.levels),
            highest_m,
            rotation_turns: lights.environment.as_ref().map_or(0.0, turns),
            bounces: bounces as i32,
            suns: lights.suns.len() as i32,
            light_count: count as i32,
            seed,
            first_row: band.start as i32,
            keys: lights.keys.len() as i32,
            albedo_exponent: four(albedo, specular.exponent),
            sky_scale: four(lights.sky.unwrap_or_default(), specular.scale),
            eye_m,
            first_path: paths.start as i32,
            last_path: paths.end as i32,
            first_light: light_range.start as i32,
            last_light: light_range.end as i32,
        },
        bound,
        grid_points * 7 * 16,
        grid_points * u64::from(BATCH_PATHS),
    );
}
