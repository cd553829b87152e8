//! Measures the error and the time of horizons and light: the tables of docs/accuracy.md.
//!
//! `cargo run --release --example accuracy -- FIELD [--cell X,Y] [--env FILE] [--samples N] [--pyramids]`
//!
//! Horizons: 64 azimuths at N random samples against the f64 oracle on the triangulated surface.
//! Sky: the light of a uniform sky at N / 8 samples against the oracle in 360 azimuths. Environment:
//! at N / 20 samples against the quadrature of all its pixels. Pyramids: the same as of sweeps, the path of
//! the paper's figure 10 first, each drawn in turn with the default's sweep; `--pyramids`: these alone.

use std::path::PathBuf;

use ridgelight::gpu::{Headless, HeadlessOptions, Timing};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Border, Environment, Fuse, HeightField, Levels, Lights, Lines, Method, Quality, Scene, Surface,
};
use ridgelight::{Error, Result};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::{Horizon, ONE_PLACE_CELLS, Oracle, elevation_of};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;
use ridgelight_trade::error::{HorizonError, ImageError};

struct Request {
    field: HeightField,
    environment: Option<Environment>,
    samples: usize,
    pyramids_alone: bool,
}

fn asked() -> Result<Request> {
    let mut options = HeightOptions::default();
    let (mut path, mut env, mut samples, mut pyramids_alone) = (None, None, 4000, false);
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or_else(|| Error::setting(&arg, "nothing", "a value"));
        match arg.as_str() {
            "--cell" => {
                let text = value()?;
                let parts: Vec<f64> = text.split(',').filter_map(|p| p.parse().ok()).collect();
                let [x, y] = parts.as_slice() else {
                    return Err(Error::setting("--cell", text, "X,Y"));
                };
                options.cell_m = Some([*x, *y]);
            }
            "--pyramids" => pyramids_alone = true,
            "--env" => env = Some(PathBuf::from(value()?)),
            "--samples" => {
                let text = value()?;
                samples = text
                    .parse()
                    .map_err(|_| Error::setting("--samples", text, "a whole number"))?;
            }
            _ => path = Some(PathBuf::from(arg)),
        }
    }
    let path = path.ok_or_else(|| Error::setting("FIELD", "nothing", "a height field"))?;
    let environment = env.map(|e| files::read_environment(&e, 0.0)).transpose()?;
    Ok(Request {
        field: files::read_heights(&path, &options)?,
        environment,
        samples: samples.max(40),
        pyramids_alone,
    })
}

fn pick(field: &HeightField, count: usize) -> Vec<[usize; 2]> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        ((state >> 11) as usize) % below
    };
    (0..count).map(|_| [next(field.rows()), next(field.cols())]).collect()
}

fn ms(times: &[Timing], name: &str) -> f64 {
    times.iter().filter(|t| t.label.starts_with(name)).map(|t| t.ns).sum::<f64>() / 1e6
}

/// Draws four times (the first compiles) and returns the plan's first output and the times of the
/// run in the middle of the others.
fn picture(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
) -> Result<(Vec<f32>, usize, Vec<Timing>)> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let (mut runs, pixels) = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let runs = (0..3).map(|_| gpu.draw(frame)).collect::<Result<Vec<_>>>()?;
        Ok((runs, gpu.pixels(frame, 0)?))
    })?;
    let total = |times: &[Timing]| times.iter().map(|t| t.ns).sum::<f64>();
    runs.sort_by(|a, b| total(a).total_cmp(&total(b)));
    let times = runs.swap_remove(1);
    Ok((pixels.values, pixels.channels, times))
}

/// Elevations at the picked samples, [azimuth][pick], and where asked distances, metres.
fn horizons(
    gpu: &mut Headless,
    field: &HeightField,
    quality: &Quality,
    picks: &[[usize; 2]],
    distances: bool,
) -> Result<[Vec<f32>; 2]> {
    let plane = field.rows() * field.cols();
    let mut found = [0, 1].map(|_| vec![0.0; picks.len() * quality.azimuths as usize]);
    for first in (0..quality.azimuths).step_by(16) {
        let count = 16.min(quality.azimuths - first);
        let limits = gpu.report().limits;
        let part = (first, count);
        let plan = plan::horizons(field, Border::Plane, quality, &limits, part, distances)?;
        let order = plan.layer_azimuths.clone();
        let outputs = gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
            gpu.draw(frame)?;
            (0..1 + usize::from(distances))
                .map(|o| gpu.pixels(frame, o))
                .collect::<Result<Vec<_>>>()
        })?;
        for (output, found) in outputs.iter().zip(&mut found) {
            let values = &output.values;
            for (layer, k) in order.iter().enumerate() {
                for (i, [r, c]) in picks.iter().enumerate() {
                    let at = layer * plane + r * field.cols() + c;
                    found[*k as usize * picks.len() + i] = values[at];
                }
            }
        }
    }
    Ok(found)
}

/// The oracle at the picked samples, [azimuth][pick].
fn truth(oracle: &Oracle, azimuths: &[f64], picks: &[[usize; 2]]) -> Vec<Option<Horizon>> {
    let at =
        |phi: &f64| picks.iter().map(|[r, c]| oracle.horizon(*r, *c, *phi)).collect::<Vec<_>>();
    azimuths.iter().flat_map(at).collect()
}

/// How often an exact sweep names the oracle's occluder, where that is unique.
fn occluders(
    field: &HeightField,
    [angles, distances]: &[Vec<f32>; 2],
    truth: &[Option<Horizon>],
) -> String {
    let one_place_m = ONE_PLACE_CELLS * field.cell_m()[0].max(field.cell_m()[1]);
    let (mut unique, mut same, mut lost) = (0_usize, 0_usize, 0.0_f64);
    for ((angle, distance), truth) in angles.iter().zip(distances).zip(truth) {
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
        "exact: the oracle's occluder at {same} of {unique} places where it is unique; at the others the angle is at most {lost:.1e}° off"
    )
}

/// Levels an octave and the offset of each row, and what is stored.
const PYRAMIDS: [(u32, u32, Levels); 15] = [
    (1, 0, Levels::Stack),
    (2, 1, Levels::Stack),
    (4, 2, Levels::Stack),
    (8, 3, Levels::Stack),
    (16, 4, Levels::Stack),
    (1, 2, Levels::Stack),
    (2, 2, Levels::Stack),
    (8, 2, Levels::Stack),
    (16, 2, Levels::Stack),
    (4, 0, Levels::Stack),
    (4, 1, Levels::Stack),
    (4, 3, Levels::Stack),
    (4, 4, Levels::Stack),
    (4, 2, Levels::Pyramid),
    (16, 4, Levels::Pyramid),
];

/// The table of pyramids.
fn pyramids(
    gpu: &mut Headless,
    sky: &Scene,
    (picks, truth): (&[[usize; 2]], &[Option<Horizon>]),
    (lit, sky_truth): (&[[usize; 2]], &[f64]),
) -> Result<()> {
    println!(
        "\n| k | o | stored | levels MiB | mean ° | median ° | 99 % ° | sky RMSE % | mean shift % | levels ms | march ms | × sweep |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    let field = &sky.field;
    let elevations: Vec<f32> =
        truth.iter().map(|h| elevation_of(Border::Plane, *h) as f32).collect();
    for (level_step, level_offset, levels) in PYRAMIDS {
        let method = Method::Pyramid;
        let quality = Quality { method, level_step, level_offset, levels, ..Quality::default() };
        let [angles, _] = horizons(gpu, field, &quality, picks, false)?;
        let e = HorizonError::of(&angles, &elevations, 1, picks.len())?;
        let (values, channels, times) = picture(gpu, sky, &quality)?;
        let (_, _, beside) = picture(gpu, sky, &Quality::default())?;
        let ours: Vec<f64> =
            lit.iter().map(|[r, c]| f64::from(values[(r * field.cols() + c) * channels])).collect();
        let light = ImageError::of(&ours, sky_truth, lit.len())?;
        let plan = plan::picture(sky, &quality, &gpu.report().limits, Picture::default())?;
        let of_levels = ["height_levels", "level_table", "height_stack"];
        let bytes: u64 = plan
            .resources
            .iter()
            .filter(|r| of_levels.contains(&r.name.as_str()))
            .map(ridgelight::plan::Resource::bytes)
            .sum();
        let made = ms(&times, "height_reduce") + ms(&times, "height_expand");
        let marched = ms(&times, "pyramid_march");
        println!(
            "| {level_step} | {level_offset} | {} | {:.1} | {:.3} | {:.3} | {:.2} | {:.3} | {:+.3} | {made:.1} | {marched:.1} | {:.1} |",
            levels.name(),
            bytes as f64 / 1_048_576.0,
            e.mean,
            e.median,
            e.p99,
            100.0 * light.relative_rmse,
            100.0 * light.relative_mean_shift,
            (made + marched) / ms(&beside, "horizon_sweep")
        );
    }
    println!(
        "ms of 64 azimuths; × sweep: of levels and march over the default sweep's, drawn in turn."
    );
    Ok(())
}

fn main() -> Result<()> {
    let Request { field, environment, samples, pyramids_alone } = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let oracle = Oracle::new(&field, Border::Plane);
    let picks = pick(&field, samples);
    let lit = &picks[..samples / 8];
    let sky_truth: Vec<f64> =
        lit.iter().map(|[r, c]| light::sky_of(&oracle, *r, *c, 360)).collect();
    let scene =
        |lights: Lights| Scene { field: field.clone(), surface: Surface::default(), lights };
    let sky = scene(Lights { sky: Some([1.0; 3]), ..Lights::default() });
    let megasamples = (field.rows() * field.cols()) as f64 / 1e6;
    println!("{} × {} samples, 64 azimuths, {}\n", field.cols(), field.rows(), gpu.report().name);
    let even = truth(&oracle, &plan::circle_rad(&Quality::default(), field.cell_m())?, &picks);
    if pyramids_alone {
        return pyramids(&mut gpu, &sky, (&picks, &even), (lit, &sky_truth));
    }
    println!(
        "| lines | fuse | mean ° | median ° | 99 % ° | 99.9 % ° | worst ° (row, column) | sky RMSE % | sweep ms | shade ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut rows = Vec::new();
    for lines in
        [Lines::FourCells, Lines::TwoCells, Lines::Cell, Lines::HalfCell, Lines::QuarterCell]
    {
        use Fuse::{Aimed, AimedAround, AimedNearest, Nearest, Own, Slopes};
        for fuse in [Nearest, Slopes, Own, AimedNearest, Aimed, AimedAround] {
            rows.push((Method::Sweep, lines, fuse));
        }
    }
    rows.push((Method::Sweep, Lines::Exact, Fuse::AimedNearest));
    // Brute force costs a side's length a sample.
    if megasamples * (field.cols().max(field.rows()) as f64) < 200.0 {
        rows.push((Method::BruteForce, Lines::Cell, Fuse::AimedNearest));
    }
    let mut same_occluders = String::new();
    for (method, lines, fuse) in rows {
        let quality = Quality { method, lines, fuse, ..Quality::default() };
        let is_exact = lines == Lines::Exact;
        let found = horizons(&mut gpu, &field, &quality, &picks, is_exact)?;
        let circle = plan::circle_rad(&quality, field.cell_m())?;
        let own = is_exact.then(|| truth(&oracle, &circle, &picks));
        let met = own.as_ref().unwrap_or(&even);
        let elevations: Vec<f32> =
            met.iter().map(|h| elevation_of(Border::Plane, *h) as f32).collect();
        let e = HorizonError::of(&found[0], &elevations, 1, samples)?;
        if is_exact {
            same_occluders = occluders(&field, &found, met);
        }
        let (values, channels, times) = picture(&mut gpu, &sky, &quality)?;
        let ours: Vec<f64> =
            lit.iter().map(|[r, c]| f64::from(values[(r * field.cols() + c) * channels])).collect();
        let light = ImageError::of(&ours, &sky_truth, lit.len())?;
        let [row, col] = picks[e.worst_at[2]];
        let names = match (method, lines) {
            (Method::BruteForce, _) => "brute | ".to_owned(),
            (_, Lines::Exact) => "exact | ".to_owned(),
            _ => format!("{} | {}", lines.name(), fuse.name()),
        };
        let sweeps =
            ms(&times, "horizon_sweep") + ms(&times, "surface_sweep") + ms(&times, "horizon_march");
        println!(
            "| {names} | {:.5} | {:.5} | {:.4} | {:.4} | {:.4} ({row}, {col}) | {:.4} | {:.2} | {:.2} |",
            e.mean,
            e.median,
            e.p99,
            e.p999,
            e.worst,
            100.0 * light.relative_rmse,
            sweeps / 64.0 / megasamples,
            ms(&times, "sky_shade") / 64.0 / megasamples
        );
    }
    pyramids(&mut gpu, &sky, (&picks, &even), (lit, &sky_truth))?;
    println!(
        "\n{same_occluders}\nms an azimuth and megasample. Exact horizons are in the azimuths of grid vectors near the even ones."
    );
    let Some(environment) = environment else { return Ok(()) };
    let lit = &picks[..samples / 20];
    let truth: Vec<[f64; 3]> =
        lit.iter().map(|[r, c]| light::environment_of(&oracle, *r, *c, &environment)).collect();
    let scene = scene(Lights { environment: Some(environment), ..Lights::default() });
    println!(
        "\n| azimuths | environment RMSE % | mean shift % | tables ms | sweep ms | shade ms | frame ms |"
    );
    println!("|---|---|---|---|---|---|---|");
    for azimuths in [16, 32, 64, 128, 256] {
        let quality = Quality { azimuths, table_elevations: 512, ..Quality::default() };
        let (values, channels, times) = picture(&mut gpu, &scene, &quality)?;
        let at = |[r, c]: &[usize; 2], channel: usize| {
            f64::from(values[(r * field.cols() + c) * channels + channel])
        };
        let ours: Vec<f64> = lit.iter().flat_map(|p| [0, 1, 2].map(|k| at(p, k))).collect();
        let wanted: Vec<f64> = truth.iter().flatten().copied().collect();
        let e = ImageError::of(&ours, &wanted, 3)?;
        println!(
            "| {azimuths} | {:.3} | {:+.3} | {:.1} | {:.1} | {:.1} | {:.1} |",
            100.0 * e.relative_rmse,
            100.0 * e.relative_mean_shift,
            ms(&times, "env_"),
            ms(&times, "horizon_sweep"),
            ms(&times, "sky_shade"),
            times.iter().map(|t| t.ns).sum::<f64>() / 1e6
        );
    }
    Ok(())
}
