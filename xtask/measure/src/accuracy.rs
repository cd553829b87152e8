//! Errors and times of horizons and light: the tables of docs/accuracy.md.
//!
//! Horizons: 64 azimuths at N (4000) random grid points against the f64 oracle on the triangulated surface.
//! Sky: the light of a uniform sky at N / 8 points against the oracle in 360 azimuths. Environment: at N / 20
//! points against the quadrature of all its pixels. Pyramids: the same as of sweeps, the path of NS09 figure 10
//! first, each drawn in turn with the default's sweep; `--pyramids`: these alone.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Border, Fuse, HeightField, Levels, Lights, Lines, Method, Quality, Scene, Surface,
};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::{Horizon, ONE_PLACE_CELLS, Oracle, elevation_of};
use ridgelight_io as files;
use ridgelight_trade::error::{HorizonError, ImageError};

use crate::common::args::Args;
use crate::common::frames::{Drawn, bytes, drawn, ms, open};
use crate::common::{Outcome, head, inputs};

type Picks = [[usize; 2]];

/// Of three draws after the first the one in the middle.
const RUNS: usize = 3;

fn middle_run(drawn: &Drawn, name: &str) -> f64 {
    let mut runs: Vec<_> = drawn.runs.iter().collect();
    runs.sort_by(|a, b| ms(a, "").total_cmp(&ms(b, "")));
    ms(runs[runs.len() / 2], name)
}

/// Elevations at the picked grid points, by azimuth and pick, and where wanted distances, metres.
fn horizons(
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
        let order = plan.layer_azimuths.clone();
        let outputs = gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
            gpu.draw(frame)?;
            let outputs = 0..1 + usize::from(distances);
            outputs.map(|o| gpu.pixels(frame, o)).collect::<Result<Vec<_>>>()
        })?;
        for (output, found) in outputs.iter().zip(&mut found) {
            for (layer, k) in order.iter().enumerate() {
                for (i, [r, c]) in picks.iter().enumerate() {
                    let at = layer * plane + r * field.cols() + c;
                    found[*k as usize * picks.len() + i] = output.values[at];
                }
            }
        }
    }
    Ok(found)
}

/// The oracle at the picked grid points, by azimuth and pick.
fn truth(oracle: &Oracle, azimuths: &[f64], picks: &Picks) -> Vec<Option<Horizon>> {
    let at =
        |phi: &f64| picks.iter().map(|[r, c]| oracle.horizon(*r, *c, *phi)).collect::<Vec<_>>();
    azimuths.iter().flat_map(at).collect()
}

fn elevations(horizons: &[Option<Horizon>]) -> Vec<f32> {
    horizons.iter().map(|h| elevation_of(Border::Plane, *h) as f32).collect()
}

/// How often an exact sweep names the oracle's occluder, where that is unique.
fn occluders(field: &HeightField, found: &[Vec<f32>; 2], truth: &[Option<Horizon>]) -> String {
    let one_place_m = ONE_PLACE_CELLS * field.cell_m()[0].max(field.cell_m()[1]);
    let (mut unique, mut same, mut lost) = (0_usize, 0_usize, 0.0_f64);
    for ((angle, distance), truth) in found[0].iter().zip(&found[1]).zip(truth) {
        // Where the ground beyond the edge is the horizon, nothing is met.
        let Some(met) = truth.filter(|h| h.unique && h.slope > 0.0) else { continue };
        unique += 1;
        // A distance is f32 steps times f32 metres a step.
        let rounding = 4.0 * f64::from(f32::EPSILON) * met.distance_m;
        if (f64::from(*distance) - met.distance_m).abs() <= one_place_m + rounding {
            same += 1;
        } else {
            lost = lost.max((met.slope.atan() - f64::from(*angle)).abs().to_degrees());
        }
    }
    format!(
        "exact: the oracle's occluder at {same} of {unique} places where it is unique; at the others the angle error is at most {lost:.1e}°"
    )
}

/// Levels an octave of each row, and its offset; of the last two a pyramid is stored, of the others a stack.
const LEVEL_STEPS: [u32; 15] = [1, 2, 4, 8, 16, 1, 2, 8, 16, 4, 4, 4, 4, 4, 16];
const LEVEL_OFFSETS: [u32; 15] = [0, 1, 2, 3, 4, 2, 2, 2, 2, 0, 1, 3, 4, 2, 4];

/// A field, where its horizons and its light are compared, and their ground truths.
struct Ground {
    field: HeightField,
    picks: Vec<[usize; 2]>,
    even: Vec<Option<Horizon>>,
    sky: Scene,
    sky_truth: Vec<f64>,
}

impl Ground {
    fn sky_error(&self, found: &Drawn) -> Result<ImageError> {
        let count = self.sky_truth.len();
        let of = |[r, c]: &[usize; 2]| found.light[r * self.field.cols() + c][0];
        let ours: Vec<f64> = self.picks[..count].iter().map(of).collect();
        ImageError::of(&ours, &self.sky_truth, count)
    }
}

fn pyramids(gpu: &mut Headless, ground: &Ground) -> Result<()> {
    let Ground { field, picks, sky, .. } = ground;
    println!();
    head(
        "| k | o | stored | levels MiB | mean ° | median ° | 99 % ° | sky RMSE % | mean shift % | levels ms | march ms | × sweep |",
    );
    let elevations = elevations(&ground.even);
    for (i, (level_step, level_offset)) in LEVEL_STEPS.into_iter().zip(LEVEL_OFFSETS).enumerate() {
        let levels = if i < 13 { Levels::Stack } else { Levels::Pyramid };
        let method = Method::Pyramid;
        let quality = Quality { method, level_step, level_offset, levels, ..Quality::default() };
        let [angles, _] = horizons(gpu, field, &quality, picks, false)?;
        let e = HorizonError::of(&angles, &elevations, 1, picks.len())?;
        let found = drawn(gpu, sky, &quality, RUNS)?;
        let beside = drawn(gpu, sky, &Quality::default(), RUNS)?;
        let light = ground.sky_error(&found)?;
        let plan = plan::picture(sky, &quality, &gpu.report().limits, Picture::default())?;
        let mib =
            bytes(&plan, &["height_levels", "level_table", "height_stack"]) as f64 / 1_048_576.0;
        let made = middle_run(&found, "height_reduce") + middle_run(&found, "height_expand");
        let marched = middle_run(&found, "pyramid_march");
        println!(
            "| {level_step} | {level_offset} | {} | {mib:.1} | {:.3} | {:.3} | {:.2} | {:.3} | {:+.3} | {made:.1} | {marched:.1} | {:.1} |",
            levels.name(),
            e.mean_deg,
            e.median_deg,
            e.p99_deg,
            100.0 * light.relative_rmse,
            100.0 * light.relative_mean_shift,
            (made + marched) / middle_run(&beside, "horizon_sweep")
        );
    }
    println!(
        "ms of 64 azimuths; × sweep: of levels and march over the default sweep's, drawn in turn."
    );
    Ok(())
}

fn sweeps(gpu: &mut Headless, ground: &Ground, oracle: &Oracle) -> Result<String> {
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
    // Brute force costs a side's length for each grid point.
    if mega * (field.cols().max(field.rows()) as f64) < 200.0 {
        rows.push((Method::BruteForce, Lines::Cell, Fuse::AimedNearest));
    }
    let mut same_occluders = String::new();
    for (method, lines, fuse) in rows {
        let quality = Quality { method, lines, fuse, ..Quality::default() };
        let is_exact = lines == Lines::Exact;
        let found = horizons(gpu, field, &quality, picks, is_exact)?;
        let circle = plan::circle_rad(&quality, field.cell_m())?;
        let own = is_exact.then(|| truth(oracle, &circle, picks));
        let met = own.as_ref().unwrap_or(&ground.even);
        let e = HorizonError::of(&found[0], &elevations(met), 1, picks.len())?;
        if is_exact {
            same_occluders = occluders(field, &found, met);
        }
        let picture = drawn(gpu, &ground.sky, &quality, RUNS)?;
        let light = ground.sky_error(&picture)?;
        let [row, col] = picks[e.worst_at[2]];
        let names = match (method, lines) {
            (Method::BruteForce, _) => "brute | ".to_owned(),
            (_, Lines::Exact) => "exact | ".to_owned(),
            _ => format!("{} | {}", lines.name(), fuse.name()),
        };
        let of = |name| middle_run(&picture, name) / 64.0 / mega;
        println!(
            "| {names} | {:.5} | {:.5} | {:.4} | {:.4} | {:.4} ({row}, {col}) | {:.4} | {:.2} | {:.2} |",
            e.mean_deg,
            e.median_deg,
            e.p99_deg,
            e.p999_deg,
            e.worst_deg,
            100.0 * light.relative_rmse,
            of("horizon_sweep") + of("surface_sweep") + of("horizon_march"),
            of("sky_shade")
        );
    }
    Ok(same_occluders)
}

fn environment(
    gpu: &mut Headless,
    ground: &Ground,
    oracle: &Oracle,
    path: &Path,
    count: usize,
) -> Result<()> {
    let environment = files::read_environment(path, 0.0)?;
    let (field, picks) = (&ground.field, &ground.picks[..count]);
    let of = |[r, c]: &[usize; 2]| light::environment_of(oracle, *r, *c, &environment);
    let truth: Vec<[f64; 3]> = picks.iter().map(of).collect();
    let scene = inputs::under(field.clone(), environment.clone());
    println!();
    head(
        "| azimuths | environment RMSE % | mean shift % | tables ms | sweep ms | shade ms | frame ms |",
    );
    for azimuths in [16, 32, 64, 128, 256] {
        let quality = Quality { azimuths, table_elevations: 512, ..Quality::default() };
        let found = drawn(gpu, &scene, &quality, RUNS)?;
        let ours: Vec<[f64; 3]> =
            picks.iter().map(|[r, c]| found.light[r * field.cols() + c]).collect();
        let e = ImageError::of(ours.as_flattened(), truth.as_flattened(), 3)?;
        let times = ["env_", "horizon_sweep", "sky_shade", ""].map(|name| middle_run(&found, name));
        println!(
            "| {azimuths} | {:.3} | {:+.3} | {} |",
            100.0 * e.relative_rmse,
            100.0 * e.relative_mean_shift,
            times.map(|ms| format!("{ms:.1}")).join(" | ")
        );
    }
    Ok(())
}

pub fn run(mut args: Args) -> Outcome {
    let env = args.path("--env")?;
    let count = args.number("--points", 4000_usize)?.max(40);
    let pyramids_alone = args.has("--pyramids");
    let field = inputs::field_asked(&mut args)?;
    args.end()?;
    let mut gpu = open()?;
    let oracle = Oracle::new(&field, Border::Plane);
    let mut next = inputs::xorshift(0x9E37_79B9_7F4A_7C15);
    let picks: Vec<[usize; 2]> =
        (0..count).map(|_| [next() % field.rows(), next() % field.cols()]).collect();
    let sky_truth =
        picks[..count / 8].iter().map(|[r, c]| light::sky_of(&oracle, *r, *c, 360)).collect();
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let sky = Scene { field: field.clone(), surface: Surface::default(), lights };
    let [cols, rows] = [field.cols(), field.rows()];
    println!("{cols} × {rows} grid points, 64 azimuths, {}\n", gpu.report().name);
    let even = truth(&oracle, &plan::circle_rad(&Quality::default(), field.cell_m())?, &picks);
    let ground = Ground { field: field.clone(), picks, even, sky, sky_truth };
    if pyramids_alone {
        return Ok(pyramids(&mut gpu, &ground)?);
    }
    let same_occluders = sweeps(&mut gpu, &ground, &oracle)?;
    pyramids(&mut gpu, &ground)?;
    println!(
        "\n{same_occluders}\nms per azimuth and million grid points. Exact horizons are in the azimuths of grid vectors near the even ones."
    );
    match env {
        Some(path) => Ok(environment(&mut gpu, &ground, &oracle, &path, count / 20)?),
        None => Ok(()),
    }
}
