//! Errors and times of horizons and light: the tables of docs/accuracy.md.
//!
//! Horizons: 64 azimuths at N (4000) random grid points against the f64 oracle on the triangulated
//! surface. Sky: the light of a uniform sky at N / 8 points against the oracle in 360 azimuths.
//! Environment: at N / 20 points against the quadrature of all its pixels. `--pyramids`: the same of
//! pyramids alone, the path of NS09 figure 10 first.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan;
use ridgelight::scene::{Border, Fuse, HeightField, Levels, Lights, Lines, Method, Quality, Scene};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::{Horizon, ONE_PLACE_CELLS, Oracle, elevation_of};
use ridgelight_io as files;
use ridgelight_trade::error::{HorizonError, ImageError};

use crate::common::args::Args;
use crate::common::frames::{Drawn, drawn, ms};
use crate::common::{Outcome, cells, head, inputs, xorshift};

/// The median of three draws after the first.
const RUNS: usize = 3;
/// Of horizons. With fewer, the error of sky light comes more from their number than from the horizons.
const AZIMUTHS: u32 = 64;
/// Grid points, rows and columns.
type Picks = [[usize; 2]];

fn base() -> Quality {
    Quality { azimuths: AZIMUTHS, ..Quality::default() }
}

/// Elevations at the picked grid points, by azimuth and pick, and metres to the occluders if requested.
pub fn horizons(
    gpu: &mut Headless,
    field: &HeightField,
    quality: &Quality,
    picks: &Picks,
    distances: bool,
) -> Result<[Vec<f32>; 2]> {
    let plane = field.rows() * field.cols();
    let mut found = [0, 1].map(|_| vec![0.0; picks.len() * quality.azimuths as usize]);
    for first in (0..quality.azimuths).step_by(16) {
        let part = (first, 16.min(quality.azimuths - first));
        let limits = gpu.report().limits;
        let plan = plan::horizons(field, Border::Plane, quality, &limits, part, distances)?;
        let outputs = gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
            gpu.draw(frame)?;
            let outputs = 0..1 + usize::from(distances);
            outputs.map(|o| gpu.pixels(frame, o)).collect::<Result<Vec<_>>>()
        })?;
        for (output, found) in outputs.iter().zip(&mut found) {
            for layer in 0..part.1 as usize {
                for (i, [r, c]) in picks.iter().enumerate() {
                    let at = layer * plane + r * field.cols() + c;
                    found[(first as usize + layer) * picks.len() + i] = output.values[at];
                }
            }
        }
    }
    Ok(found)
}

/// How often an exact sweep names the oracle's occluder, where that is unique.
fn occluders(field: &HeightField, found: &[Vec<f32>; 2], oracle: &[Option<Horizon>]) -> String {
    let one_place_m = ONE_PLACE_CELLS * field.cell_m()[0].max(field.cell_m()[1]);
    let (mut unique, mut same, mut lost) = (0_usize, 0_usize, 0.0_f64);
    for ((angle, distance), horizon) in found[0].iter().zip(&found[1]).zip(oracle) {
        // Where the ground beyond the edge is the horizon, nothing is hit.
        let Some(hit) = horizon.filter(|h| h.unique && h.slope > 0.0) else { continue };
        unique += 1;
        // A distance is f32 steps times f32 metres per step.
        let rounding = 4.0 * f64::from(f32::EPSILON) * hit.distance_m;
        if (f64::from(*distance) - hit.distance_m).abs() <= one_place_m + rounding {
            same += 1;
        } else {
            lost = lost.max((hit.slope.atan() - f64::from(*angle)).abs().to_degrees());
        }
    }
    format!(
        "exact: the oracle's occluder at {same} of {unique} places where it is unique; at the others the angle error is at most {lost:.1e}°"
    )
}

/// Level step and offset of each row. The last two rows store a pyramid, the others a stack.
const LEVEL_STEPS: [u32; 15] = [1, 2, 4, 8, 16, 1, 2, 8, 16, 4, 4, 4, 4, 4, 16];
const LEVEL_OFFSETS: [u32; 15] = [0, 1, 2, 3, 4, 2, 2, 2, 2, 0, 1, 3, 4, 2, 4];

/// A field, where its horizons and its light are compared, and the oracle's values.
struct Ground<'a> {
    field: &'a HeightField,
    oracle: Oracle<'a>,
    picks: Vec<[usize; 2]>,
    sky: Scene,
    sky_light: Vec<f64>,
}

impl Ground<'_> {
    /// Relative RMSE and mean shift under the sky, %.
    fn sky_error(&self, found: &Drawn) -> Result<[f64; 2]> {
        let count = self.sky_light.len();
        let of = |[r, c]: &[usize; 2]| found.light[r * self.field.cols() + c][0];
        let ours: Vec<f64> = self.picks[..count].iter().map(of).collect();
        let error = ImageError::of(&ours, &self.sky_light, count)?;
        Ok([error.relative_rmse, error.relative_mean_shift].map(|share| 100.0 * share))
    }

    /// The oracle's horizons at the picks in the azimuths of some settings.
    fn horizons(&self, quality: &Quality) -> Result<Vec<Option<Horizon>>> {
        let azimuths = plan::circle_rad(quality, self.field.cell_m())?;
        let at = |phi: &f64| {
            self.picks.iter().map(|[r, c]| self.oracle.horizon(*r, *c, *phi)).collect::<Vec<_>>()
        };
        Ok(azimuths.iter().flat_map(at).collect())
    }

    fn error(&self, angles: &[f32], oracle: &[Option<Horizon>]) -> Result<HorizonError> {
        let elevation = |h: &Option<Horizon>| elevation_of(Border::Plane, *h) as f32;
        let elevations: Vec<f32> = oracle.iter().map(elevation).collect();
        HorizonError::of(angles, &elevations, 1, self.picks.len())
    }
}

fn pyramids(gpu: &mut Headless, ground: &Ground) -> Result<()> {
    println!();
    head(
        "| k | o | stored | levels MiB | mean ° | median ° | 99 % ° | sky RMSE % | mean shift % |",
    );
    let even = ground.horizons(&base())?;
    for (i, (level_step, level_offset)) in LEVEL_STEPS.into_iter().zip(LEVEL_OFFSETS).enumerate() {
        let levels = if i < 13 { Levels::Stack } else { Levels::Pyramid };
        let method = Method::Pyramid;
        let quality = Quality { method, level_step, level_offset, levels, ..base() };
        let [angles, _] = horizons(gpu, ground.field, &quality, &ground.picks, false)?;
        let e = ground.error(&angles, &even)?;
        let found = drawn(gpu, &ground.sky, &quality, 0)?;
        let [rmse, shift] = ground.sky_error(&found)?;
        let bytes = found.bytes(&["height_levels", "level_table", "height_stack"]);
        println!(
            "| {level_step} | {level_offset} | {} | {:.1} | {:.3} | {:.3} | {:.2} | {rmse:.3} | {shift:+.3} |",
            levels,
            bytes as f64 / 1_048_576.0,
            e.mean_deg,
            e.median_deg,
            e.p99_deg
        );
    }
    Ok(())
}

fn sweeps(gpu: &mut Headless, ground: &Ground) -> Result<()> {
    let Ground { field, picks, .. } = ground;
    let mega = (field.rows() * field.cols()) as f64 / 1e6;
    head(
        "| lines | fuse | mean ° | median ° | 99 % ° | 99.9 % ° | worst ° (row, column) | sky RMSE % | sweep ms | shade ms |",
    );
    let mut rows = Vec::new();
    let all = [Lines::FourCells, Lines::TwoCells, Lines::Cell, Lines::HalfCell, Lines::QuarterCell];
    for lines in all {
        use Fuse::{Aimed, AimedAround, AimedNearest, Nearest, Own, Slopes};
        let fuses = [Nearest, Slopes, Own, AimedNearest, Aimed, AimedAround];
        rows.extend(fuses.map(|fuse| (Method::Sweep, lines, fuse)));
    }
    rows.push((Method::Sweep, Lines::Exact, Fuse::AimedNearest));
    // Brute force takes a time proportional to the side for each grid point.
    if mega * (field.cols().max(field.rows()) as f64) < 200.0 {
        rows.push((Method::BruteForce, Lines::Cell, Fuse::AimedNearest));
    }
    let even = ground.horizons(&base())?;
    let mut same_occluders = String::new();
    for (method, lines, fuse) in rows {
        let quality = Quality { method, lines, fuse, ..base() };
        let is_exact = lines == Lines::Exact;
        let found = horizons(gpu, field, &quality, picks, is_exact)?;
        let own = if is_exact { Some(ground.horizons(&quality)?) } else { None };
        let e = ground.error(&found[0], own.as_ref().unwrap_or(&even))?;
        if let Some(own) = &own {
            same_occluders = occluders(field, &found, own);
        }
        let picture = drawn(gpu, &ground.sky, &quality, RUNS)?;
        let [rmse, _] = ground.sky_error(&picture)?;
        let [row, col] = picks[e.worst_at[2]];
        let names = match (method, lines) {
            (Method::BruteForce, _) => "brute | ".to_owned(),
            (_, Lines::Exact) => "exact | ".to_owned(),
            _ => format!("{} | {}", lines, fuse),
        };
        let of = |name| ms(picture.middle(), name) / 64.0 / mega;
        println!(
            "| {names} | {} | {} ({row}, {col}) | {rmse:.4} | {:.2} | {:.2} |",
            cells(5, [e.mean_deg, e.median_deg]),
            cells(4, [e.p99_deg, e.p999_deg, e.worst_deg]),
            of("horizon_sweep") + of("surface_sweep") + of("horizon_march"),
            of("sky_shade")
        );
    }
    println!(
        "\n{same_occluders}\nms per azimuth and million grid points. Exact horizons are in the azimuths of grid vectors near the even ones."
    );
    Ok(())
}

fn environment(gpu: &mut Headless, ground: &Ground, path: &Path, count: usize) -> Result<()> {
    let environment = files::read_environment(path, 0.0)?;
    let picks = &ground.picks[..count];
    let of = |[r, c]: &[usize; 2]| light::environment_of(&ground.oracle, *r, *c, &environment);
    let oracle: Vec<[f64; 3]> = picks.iter().map(of).collect();
    let scene = inputs::under(ground.field.clone(), environment.clone());
    println!();
    head(
        "| azimuths | environment RMSE % | mean shift % | tables ms | sweep ms | shade ms | frame ms |",
    );
    for azimuths in [16, 32, 64, 128, 256] {
        let quality = Quality { azimuths, table_elevations: 512, ..Quality::default() };
        let found = drawn(gpu, &scene, &quality, RUNS)?;
        let ours: Vec<[f64; 3]> =
            picks.iter().map(|[r, c]| found.light[r * ground.field.cols() + c]).collect();
        let e = ImageError::of(ours.as_flattened(), oracle.as_flattened(), 3)?;
        let times = ["env_", "horizon_sweep", "sky_shade", ""].map(|name| ms(found.middle(), name));
        println!(
            "| {azimuths} | {:.3} | {:+.3} | {} |",
            100.0 * e.relative_rmse,
            100.0 * e.relative_mean_shift,
            cells(1, times)
        );
    }
    Ok(())
}

pub fn run(mut args: Args) -> Outcome {
    let (count, env) = (args.number("--points", 4000_usize)?.max(40), args.path("--env")?);
    let has_pyramids = args.has("--pyramids");
    let field = &inputs::requested_field(&mut args)?;
    let mut gpu = args.open()?;
    let oracle = Oracle::new(field, Border::Plane);
    let mut next = xorshift(0x9E37_79B9_7F4A_7C15);
    let picks: Vec<[usize; 2]> =
        (0..count).map(|_| [next() % field.rows(), next() % field.cols()]).collect();
    let sky_light =
        picks[..count / 8].iter().map(|[r, c]| light::sky_of(&oracle, *r, *c, 360)).collect();
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let sky = inputs::lit_by(field.clone(), lights);
    let [cols, rows] = [field.cols(), field.rows()];
    println!("{cols} × {rows} grid points, {AZIMUTHS} azimuths, {}\n", gpu.report().name);
    let ground = Ground { field, oracle, picks, sky, sky_light };
    if has_pyramids {
        return Ok(pyramids(&mut gpu, &ground)?);
    }
    sweeps(&mut gpu, &ground)?;
    match env {
        Some(path) => Ok(environment(&mut gpu, &ground, &path, count / 20)?),
        None => Ok(()),
    }
}
