use super::{Builder, Format, Limits, Owner, Plan, ResourceId};
use crate::passes::path_trace::{self, BATCH_PATHS, Blocks};
use crate::passes::{height_bounds, height_cells};
use crate::scene::{Albedo, Border, Environment, Lights, Scene};
use crate::{Error, Result};

/// Paths a sample of one batch of a [`reference`](reference()).
pub const REFERENCE_BATCH: u32 = BATCH_PATHS;

/// Light that has been reflected more often is not counted: [0..64].
const MOST_BOUNCES: u32 = 64;

/// Passes that trace one batch of [`REFERENCE_BATCH`] light paths from every sample: what
/// [`cpu::bounce`](crate::cpu::bounce) defines, with all bounces up to `bounces`.
///
/// Inputs: those of [`reference_inputs`]. Outputs: "radiance", the mean of all batches so far, and
/// "standard_error", that of the mean, from the spread between batches, infinite after the first; four
/// channels each. Running the whole plan begins anew; running its last pass alone adds a batch. The
/// same seed gives the same batches on the same device. Buffer "lost_rays" counts rays that were given
/// up: 0 in a right result.
///
/// # Errors
/// Bounces, surface or lights out of range, nothing that shines, or a scene beyond the limits.
pub fn reference(scene: &Scene, bounces: u32, seed: u32, limits: &Limits) -> Result<Plan> {
    let Scene { field, surface, lights } = scene;
    lights.check()?;
    surface.check(field.rows() * field.cols())?;
    if bounces > MOST_BOUNCES {
        let expected = format!("a whole number from 0 to {MOST_BOUNCES}");
        return Err(Error::setting("--bounces", bounces.to_string(), expected));
    }
    let count = lights.suns.len() + lights.spheres.len();
    if count == 0 && lights.sky.is_none() && lights.environment.is_none() {
        let expected = "at least one of sky, environment, sun and local light";
        return Err(Error::setting("lights", "none", expected));
    }
    if count > limits.image_side as usize {
        return Err(Error::Limit {
            what: format!("{count} suns and local lights"),
            needs: format!("an image {count} texels long"),
            limit: format!("{} on this device", limits.image_side),
        });
    }
    let size = limits.check_size(field.rows(), field.cols())?;

    let mut builder = Builder::new();
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
    for output in ["radiance", "standard_error"] {
        bound.push((output, image(output, Owner::Output, rgba, size)));
    }
    let blocks = blocks(size, surface.border);
    let cells = image("cells", Owner::Internal, rgba, size);
    let ground = image("ground", Owner::Internal, rgba, size);
    let batch_mean = image("batch_mean", Owner::Internal, rgba, size);
    let batch_spread = image("batch_spread", Owner::Internal, rgba, size);
    let levels = [blocks.cells[0].div_ceil(4), blocks.padded_rows / 2];
    let maxima = image("maxima", Owner::Internal, Format::R32Float, levels);
    let lost_rays = builder.buffer("lost_rays", 16, false);
    bound.extend([
        ("cells", cells),
        ("ground", ground),
        ("maxima", maxima),
        ("batch_mean", batch_mean),
        ("batch_spread", batch_spread),
        ("lost_rays", lost_rays),
    ]);
    let ids = [heights, cells, ground, batch_mean, lost_rays];
    height_cells::plan(&mut builder, (field, surface.border), ids);
    for level in 1..=blocks.top_level {
        let ids = [cells, maxima];
        height_bounds::plan(&mut builder, blocks.cells, blocks.padded_rows, level, ids);
    }
    path_trace::plan(&mut builder, scene, &blocks, (bounces, seed), &bound);
    let used = vec![
        ("method".to_owned(), "path tracing".to_owned()),
        ("border".to_owned(), format!("{:?}", surface.border).to_lowercase()),
        ("bounces".to_owned(), bounces.to_string()),
        ("seed".to_owned(), seed.to_string()),
        ("paths_of_a_batch".to_owned(), BATCH_PATHS.to_string()),
    ];
    Plan::finish(builder, size, Vec::new(), Vec::new(), Vec::new(), used, limits)
}

/// Levels of 4 by 4 up to one block that holds all cells. A field without cells has one that is not
/// looked at.
fn blocks([cols, rows]: [u32; 2], border: Border) -> Blocks {
    let cells = [cols, rows].map(|n| match border {
        Border::Periodic => n,
        Border::Plane | Border::Open => (n - 1).max(1),
    });
    let longest = cells[0].max(cells[1]);
    let top_level = (1..).find(|l| 4_u32.pow(*l) >= longest).expect("up to 4^15");
    Blocks { cells, padded_rows: cells[1].next_multiple_of(4_u32.pow(top_level)), top_level }
}

/// Texels of the inputs of a [`reference`](reference()), in its plan's order: "heights"; "environment" and
/// its "environment_cdf" where there is one; "lights"; "albedo" where it is a map.
pub fn reference_inputs(scene: &Scene) -> Vec<Vec<f32>> {
    let opaque = |texels: &[[f32; 3]]| -> Vec<f32> {
        texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect()
    };
    let Scene { field, surface, lights } = scene;
    let mut all = vec![field.heights_m().to_vec()];
    if let Some(environment) = &lights.environment {
        all.push(opaque(environment.texels()));
        all.push(environment_cdf(environment, surface.border));
    }
    all.push(light_texels(lights, field.base_m()));
    if let Albedo::Map(map) = &surface.albedo {
        all.push(opaque(map));
    }
    all
}

/// Two texels a light, suns first: see `path_trace.comp`.
fn light_texels(lights: &Lights, base_m: f64) -> Vec<f32> {
    let mut all = Vec::new();
    for sun in &lights.suns {
        // The rounding of π is no direction: along a line of samples its sign would decide everything.
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
    for ball in &lights.spheres {
        let [x, y, z] = ball.position_m;
        all.extend([x, y, z - base_m, ball.radius_m].map(|v| v as f32));
        all.extend(ball.radiance);
        all.push(1.0);
    }
    if all.is_empty() {
        all.resize(8, 0.0);
    }
    all
}

/// How an environment's texels are chosen, in proportion to the light of all channels that they give:
/// rows of width + 1. First column: the share of the rows from the zenith down to this one; then the
/// share, in this row, of the texels up to each. Rows below horizontal count under `open` alone.
fn environment_cdf(environment: &Environment, border: Border) -> Vec<f32> {
    let (width, height) = (environment.width(), environment.height());
    let seen = environment.rows_above_ground(border);
    let rows: Vec<Vec<f64>> = environment
        .texels()
        .chunks_exact(width)
        .map(|row| {
            let light = row.iter().map(|t| t.iter().map(|v| f64::from(*v)).sum());
            running_shares(light)
        })
        .collect();
    let of_row = |row: usize| -> f64 {
        let texels = &environment.texels()[row * width..(row + 1) * width];
        let sum: f64 = texels.iter().flatten().map(|v| f64::from(*v)).sum();
        let middle = std::f64::consts::PI * (row as f64 + 0.5) / height as f64;
        if row < seen { sum * middle.sin() } else { 0.0 }
    };
    let down = running_shares((0..height).map(of_row));
    let texels = down.iter().zip(&rows).flat_map(|(d, row)| std::iter::once(d).chain(row));
    texels.map(|v| *v as f32).collect()
}

/// Running sums over the whole sum; 0 where that is 0.
fn running_shares(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = 0.0;
    let sums: Vec<f64> = values
        .map(|v| {
            sum += v;
            sum
        })
        .collect();
    sums.into_iter().map(|s| if sum > 0.0 { s / sum } else { 0.0 }).collect()
}
