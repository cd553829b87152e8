//! How often `--max-error` holds, and how near the cheapest settings it comes.
//!
//! `cargo run --release --example auto -- FOLDER [--fit] [--side N] [--seconds S]`
//!
//! FOLDER has height fields in `height/` and environments in `env/`. Every field (its middle N², 256)
//! under every environment, under a uniform sky, and under a sky and a sun. Every other one is for
//! fitting: `--fit` measures those and prints the table of `src/measure/auto/fitted.rs`. The others are
//! reported: per error asked for, what was chosen, its true error, and its time over that of the best of
//! a `trade` walk of S (20) seconds, drawn in turn.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use ridgelight::files::{self, HeightOptions};
use ridgelight::gpu::{Frame, Headless, HeadlessOptions};
use ridgelight::measure::auto::{
    Drawn, FEATURES, Goal, PARTS, Part, Probes, Statistics, choose, flags,
};
use ridgelight::measure::error::ImageError;
use ridgelight::measure::trade::{Rule, Search, Value, knobs, places, recommend};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Environment, Fuse, HeightField, Lights, Lines, Method, Quality, Scene, Sun, Surface,
};
use ridgelight::{Error, Result};

const ERRORS: [f64; 5] = [0.05, 0.02, 0.01, 0.005, 0.002];
const PROBING: Duration = Duration::from_secs(1);
/// A file without a cell size gets one that makes its relief this share of its side.
const RELIEF: f64 = 0.1;
/// Draws that a time is the median of.
const DRAWS: usize = 5;

struct Asked {
    folder: PathBuf,
    fit: bool,
    side: usize,
    seconds: f64,
}

fn asked() -> Result<Asked> {
    let (mut folder, mut fit, mut side, mut seconds) = (None, false, 256, 20.0);
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || {
            let text = args.next().ok_or_else(|| Error::setting(&arg, "nothing", "a number"))?;
            text.parse::<f64>().map_err(|_| Error::setting(&arg, text, "a number"))
        };
        match arg.as_str() {
            "--fit" => fit = true,
            "--side" => side = value()? as usize,
            "--seconds" => seconds = value()?,
            _ => folder = Some(PathBuf::from(arg)),
        }
    }
    let folder = folder.ok_or_else(|| Error::setting("FOLDER", "nothing", "a folder"))?;
    Ok(Asked { folder, fit, side, seconds })
}

fn listed(folder: &Path) -> Result<Vec<PathBuf>> {
    let io = |source| Error::Io { path: folder.to_owned(), source };
    let all = std::fs::read_dir(folder).map_err(io)?;
    let mut paths = all.map(|e| Ok(e.map_err(io)?.path())).collect::<Result<Vec<_>>>()?;
    paths.sort();
    Ok(paths)
}

fn name(path: &Path) -> String {
    path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The middle of a field.
fn cropped(field: &HeightField, side: usize) -> Result<HeightField> {
    let range = |whole: usize| {
        let kept = whole.min(side);
        (whole - kept) / 2..(whole - kept) / 2 + kept
    };
    let (rows, cols) = (range(field.rows()), range(field.cols()));
    let of: Vec<usize> =
        rows.clone().flat_map(|r| cols.clone().map(move |c| r * field.cols() + c)).collect();
    let heights: Vec<f64> = of.iter().map(|i| f64::from(field.heights_m()[*i])).collect();
    let mut cell_m = field.cell_m();
    if cell_m == [1.0; 2] {
        let [low, high] = heights
            .iter()
            .fold([f64::INFINITY, -f64::INFINITY], |[l, h], v| [l.min(*v), h.max(*v)]);
        cell_m = [(high - low) / RELIEF / rows.len().max(cols.len()) as f64; 2];
    }
    let voids = field.voids().map(|v| of.iter().map(|i| v[*i]).collect());
    HeightField::new(rows.len(), cols.len(), &heights, cell_m, voids)
}

/// All scenes by name; those at even places are fitted.
fn scenes(asked: &Asked) -> Result<Vec<(String, Scene)>> {
    let mut lights = Vec::new();
    for path in listed(&asked.folder.join("env"))? {
        let environment: Option<Environment> = Some(files::read_environment(&path, 0.0)?);
        lights.push((name(&path), Lights { environment, ..Lights::default() }));
    }
    let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let sun = Sun {
        azimuth_rad: 2.5,
        elevation_rad: 0.4,
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [8.0; 3],
    };
    lights.push(("sky and sun".to_owned(), Lights { suns: vec![sun], ..sky.clone() }));
    lights.push(("sky".to_owned(), sky));
    let mut all = Vec::new();
    for (i, path) in listed(&asked.folder.join("height"))?.iter().enumerate() {
        let field = cropped(&files::read_heights(path, &HeightOptions::default())?, asked.side)?;
        for (j, (light, lights)) in lights.iter().enumerate() {
            if ((i + j) % 2 == 0) == asked.fit {
                let (field, lights) = (field.clone(), lights.clone());
                let scene = Scene { field, surface: Surface::default(), lights };
                all.push((format!("{} | {light}", name(path)), scene));
            }
        }
    }
    Ok(all)
}

fn frame(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Frame> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
    let env: Option<Vec<f32>> = scene
        .lights
        .environment
        .as_ref()
        .map(|e| e.texels().iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect());
    let mut contents = vec![scene.field.heights_m()];
    contents.extend(env.as_deref());
    gpu.frame(plan, &contents)
}

/// Draws, `times` over after a draw that compiles: planes, and passes of the middle draw.
fn draw(gpu: &mut Headless, scene: &Scene, quality: &Quality, times: usize) -> Result<Drawn> {
    let mut frame = frame(gpu, scene, quality)?;
    let mut runs = vec![gpu.draw(&mut frame)?];
    for _ in 0..times {
        runs.push(gpu.draw(&mut frame)?);
    }
    let pixels = gpu.pixels(&frame, 0)?;
    gpu.end(frame);
    if times > 0 {
        runs.remove(0);
    }
    runs.sort_by(|a, b| total(a).total_cmp(&total(b)));
    let middle = runs.swap_remove(runs.len() / 2);
    let stride = pixels.channels;
    let is_void = |i: usize| scene.field.voids().is_some_and(|v| v[i]);
    let planes = (0..stride.min(3))
        .map(|c| {
            let values = pixels.values.iter().skip(c).step_by(stride).enumerate();
            values.map(|(i, v)| if is_void(i) { f32::NAN } else { *v }).collect()
        })
        .collect();
    Ok(Drawn { planes, passes: middle.into_iter().map(|t| (t.label, t.ns)).collect() })
}

fn total(times: &[ridgelight::gpu::Timing]) -> f64 {
    times.iter().map(|t| t.ns).sum()
}

fn distance(a: &[Vec<f32>], b: &[Vec<f32>], cols: usize) -> Result<f64> {
    Ok(ImageError::of(&a.concat(), &b.concat(), cols)?.relative_rmse)
}

/// Median time of `quality` over that of `other`, drawn in turn.
fn ratio(gpu: &mut Headless, scene: &Scene, quality: &Quality, other: &Quality) -> Result<f64> {
    let mut frames = [frame(gpu, scene, quality)?, frame(gpu, scene, other)?];
    let mut ratios = Vec::new();
    for i in 0..=DRAWS {
        let mut ns = [0.0; 2];
        for (ns, frame) in ns.iter_mut().zip(&mut frames) {
            *ns = total(&gpu.draw(frame)?);
        }
        if i > 0 {
            ratios.push(ns[0] / ns[1]);
        }
    }
    frames.into_iter().for_each(|f| gpu.end(f));
    ratios.sort_by(f64::total_cmp);
    Ok(ratios[DRAWS / 2])
}

/// The best of a walk of `trade`, for all errors: settings with their times and errors.
fn walked(
    gpu: &mut Headless,
    scene: &Scene,
    truth: &[Vec<f32>],
    seconds: f64,
) -> Result<Vec<(Quality, Value)>> {
    let start = Quality { method: Method::Sweep, ..Quality::default() };
    let knobs = knobs(scene);
    let dear = |q: &Quality| q.method == Method::Brute || q.lines == Lines::Exact;
    let places: Vec<_> = places(&knobs, &start).into_iter().filter(|p| !dear(&p.quality)).collect();
    let first = places.iter().position(|p| p.quality == start).expect("the defaults are a place");
    let mut search = Search::new(places.iter().map(|p| p.steps.clone()).collect(), first, 0.0);
    let (begun, mut all) = (Instant::now(), Vec::new());
    while let Some(place) = search.next().filter(|_| begun.elapsed().as_secs_f64() < seconds) {
        let quality = places[place].quality;
        let drawn = draw(gpu, scene, &quality, 1)?;
        let cost = drawn.passes.iter().map(|p| p.1).sum();
        let value = Value { cost, error: distance(&drawn.planes, truth, scene.field.cols())? };
        search.measured(place, value);
        all.push((quality, value));
    }
    Ok(all)
}

fn densest() -> Quality {
    Quality {
        method: Method::Sweep,
        lines: Lines::QuarterCell,
        fuse: Fuse::Aimed,
        azimuths: 1024,
        sun_azimuths: 128,
        table_elevations: 4096,
        ..Quality::default()
    }
}

fn report(gpu: &mut Headless, asked: &Asked) -> Result<()> {
    println!(
        "| field | light | asked % | chosen | expected % | probed % | at most % | true % (its own) | holds | time / best |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let (mut runs, mut held, mut refused, mut ratios) = (0, 0, 0, Vec::new());
    for (label, scene) in scenes(asked)? {
        let cols = scene.field.cols();
        let truth = draw(gpu, &scene, &densest(), 0)?.planes;
        // Other samples than those that choose.
        let own = Probes::of(&scene, PROBING, 99)?.error(&truth, None);
        let all = walked(gpu, &scene, &truth, asked.seconds)?;
        for most in ERRORS {
            let found = choose(&scene, Goal::MaxError(most), (PROBING, 1), |quality| {
                draw(gpu, &scene, quality, 1)
            });
            let chosen = match found {
                Ok(chosen) => chosen,
                Err(error @ Error::Limit { .. }) => {
                    refused += 1;
                    println!("| {label} | {} | refused: {error} | | | | | | |", 100.0 * most);
                    continue;
                }
                Err(error) => return Err(error),
            };
            let quality = chosen.trial.quality;
            let off = distance(&draw(gpu, &scene, &quality, 0)?.planes, &truth, cols)?;
            runs += 1;
            held += usize::from(off <= most);
            let values: Vec<Value> = all.iter().map(|a| a.1).collect();
            let best = recommend(&values, Rule::MaxError(most)).filter(|r| r.holds);
            let times = match best {
                Some(best) if all[best.point].0 != quality => {
                    Some(ratio(gpu, &scene, &quality, &all[best.point].0)?)
                }
                best => best.map(|_| 1.0),
            };
            ratios.extend(times.filter(|_| off <= most));
            println!(
                "| {label} | {} | {} | {:.3} ×{:.1} | {:.3} | {:.3} | {:.3} ({:.3}) | {} | {} |",
                100.0 * most,
                flags(&quality),
                100.0 * chosen.expected.error,
                chosen.expected.factor,
                100.0 * chosen.trial.measured.error,
                100.0 * chosen.trial.measured.at_most,
                100.0 * off,
                100.0 * own.error,
                if off <= most { "yes" } else { "no" },
                times.map_or("none found".to_owned(), |t| format!("{t:.2}"))
            );
        }
    }
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios.get((share * (ratios.len() as f64 - 1.0)) as usize).copied();
    println!(
        "\n{held} of {runs} hold ({:.1} %), {refused} refused; time over the best of the walk: median {:.2}, 90 % {:.2}, worst {:.2}; at most 1.3 in {} of {}",
        100.0 * held as f64 / f64::from(runs).max(1.0),
        at(0.5).unwrap_or(f64::NAN),
        at(0.9).unwrap_or(f64::NAN),
        at(1.0).unwrap_or(f64::NAN),
        ratios.iter().filter(|r| **r <= 1.3).count(),
        ratios.len()
    );
    Ok(())
}

#[path = "auto/fit.rs"]
mod fit;

fn main() -> Result<()> {
    let asked = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!(
        "{}, middle {}² of each field, {}\n",
        gpu.report().name,
        asked.side,
        if asked.fit { "the half that is fitted" } else { "the half that is not fitted" }
    );
    if asked.fit { fit::fit(&mut gpu, &asked) } else { report(&mut gpu, &asked) }
}
