//! Engines and bases on three real scenes of FOLDER's `height/` and `env/`, their middle N² (192) grid
//! points: the fastest of each within an error, and whether `auto` is it.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Basis, Fuse, Lines, Method, Quality, Scene, Wedges};

use crate::common::args::Args;
use crate::common::frames::{Colours, drawn, error, exact_light, in_turn};
use crate::common::plot::{self, Panel, Style};
use crate::common::{Outcome, head, inputs, median};

/// Goals, %.
const TARGETS: [f64; 7] = [20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2];
const FAMILIES: [&str; 5] =
    ["sweep + tables", "sweep + SH", "sweep + SH by NLP", "pyramid + tables", "pyramid + SH"];
const SCENES: [(&str, &str, &str); 3] = [
    ("White Mountains, sky", inputs::WHITE_MOUNTAINS, "sky_512x256.hdr"),
    ("Mt Rainier, sunlit sky", inputs::RAINIER, "spiaggia_di_mondello_1k.hdr"),
    ("moss, windows", inputs::MOSS, "lab.hdr"),
];

/// Settings, their family, error and time over that of the defaults.
struct Point {
    family: usize,
    name: String,
    error: f64,
    time: f64,
}

fn candidates() -> Vec<(usize, String, Quality)> {
    let base = Quality { method: Method::Sweep, ..Quality::default() };
    let sweeps = [
        (Lines::FourCells, Fuse::AimedNearest),
        (Lines::Cell, Fuse::AimedNearest),
        (Lines::Cell, Fuse::AimedAround),
    ];
    let sweeps = sweeps.map(|(lines, fuse)| {
        let name = format!("lines {} {}", lines, fuse);
        (0, name, Quality { lines, fuse, ..base })
    });
    let pyramids = [(1, 0), (4, 2)].map(|(level_step, level_offset)| {
        let quality =
            Quality { method: Method::Pyramid, level_step, level_offset, ..Quality::default() };
        (3, format!("k {level_step}, o {level_offset}"), quality)
    });
    let mut all = Vec::new();
    for (family, engine, quality) in sweeps.into_iter().chain(pyramids) {
        for azimuths in [8, 16, 32, 64] {
            let quality = Quality { azimuths, ..quality };
            let engine = format!("{engine}, {azimuths} azimuths");
            all.push((family, engine.clone(), Quality { basis: Basis::Table, ..quality }));
            let sh = Quality { basis: Basis::Sh, ..quality };
            for (sh_order, subsample) in [(2, 4), (2, 1), (4, 4), (4, 2), (4, 1), (6, 2), (6, 1)] {
                let name = format!("{engine}, order {sh_order}, {subsample}×");
                all.push((family + 1, name, Quality { sh_order, subsample, ..sh }));
            }
            for sh_order in [4, 6].into_iter().filter(|_| family == 0) {
                let name = format!("{engine}, order {sh_order}");
                all.push((2, name, Quality { sh_order, wedges: Wedges::Nlp, ..sh }));
            }
        }
    }
    all
}

/// Error and time of some settings; the time of `runs` draws, but of one draw where one of `others` of
/// the same family has a lower error and two thirds of the time.
fn point(
    gpu: &mut Headless,
    (scene, exact): (&Scene, &Colours),
    (family, name, quality): (usize, String, Quality),
    runs: usize,
    others: &[Point],
) -> Result<Point> {
    let error = error(&drawn(gpu, scene, &quality, 0)?.light, exact)?;
    let mut time = |runs| -> Result<f64> {
        let turns = in_turn(gpu, scene, [&quality, &Quality::default()], runs)?;
        Ok(median(turns.iter().map(|[own, defaults]| own / defaults).collect()))
    };
    let once = time(1)?;
    let beaten = |p: &Point| p.family == family && p.error <= error && 1.5 * p.time < once;
    let time = if others.iter().any(beaten) { once } else { time(runs)? };
    Ok(Point { family, name, error, time })
}

/// The fastest of a family within an error.
fn fastest(points: &[Point], family: usize, error: f64) -> Option<&Point> {
    let within = points.iter().filter(|p| p.family == family && p.error <= error);
    within.min_by(|a, b| a.time.total_cmp(&b.time))
}

/// Points of a family than which none of it is both faster and more exact.
fn frontier(points: &[Point], family: usize) -> Vec<[f64; 2]> {
    let of = || points.iter().filter(|p| p.family == family);
    let best = |p: &&Point| !of().any(|q| q.time < p.time && q.error <= p.error);
    let mut all: Vec<[f64; 2]> = of().filter(best).map(|p| [p.time, p.error]).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all
}

fn scene(folder: &Path, side: usize, field: &str, environment: &str) -> Result<Scene> {
    let field = inputs::middle(&inputs::field_of(folder, field)?, side)?;
    Ok(inputs::under(field, inputs::environment_of(folder, environment)?))
}

pub fn run(mut args: Args) -> Outcome {
    let (side, runs) = (args.number("--side", 192)?, args.number("--runs", 11)?);
    let (output, folder) = (args.path("-o")?, args.folder().ok_or("expected FOLDER")?);
    let mut gpu = args.open()?;
    println!(
        "{}\nthe middle {side}²; time of a frame over that of the defaults (a sweep of {} azimuths, tables), each \
         drawn in turn with them, medians of {runs} (one draw where another of the same engine and basis is more exact and \
         takes two thirds of the time); error: relative RMSE, against exact horizons of 256 azimuths and tables\n",
        gpu.report().name,
        Quality::default().azimuths
    );
    let (mut panels, mut reached, mut agreed) = (Vec::new(), 0, 0);
    for (name, field, environment) in SCENES {
        let scene = scene(&folder, side, field, environment)?;
        let exact = exact_light(&mut gpu, &scene, 256)?;
        let mut points = Vec::new();
        for candidate in candidates() {
            points.push(point(&mut gpu, (&scene, &exact), candidate, runs, &points)?);
        }
        head(&format!("| {name}: within % | {} |", FAMILIES.join(" | ")));
        for error in TARGETS {
            let best = [0, 1, 2, 3, 4].map(|family| fastest(&points, family, error));
            let least = best.iter().flatten().map(|p| p.time).fold(f64::INFINITY, f64::min);
            let cell = |p: Option<&Point>| match p {
                None => "none".to_owned(),
                Some(p) if p.time == least => format!("**{:.2}** ({})", p.time, p.name),
                Some(p) => format!("{:.2} ({})", p.time, p.name),
            };
            println!("| {error} | {} |", best.map(cell).join(" | "));
            reached += usize::from(least < f64::INFINITY);
            agreed += usize::from(best[0].is_some_and(|p| p.time == least));
        }
        println!();
        let curve = |f: usize| plot::curve(FAMILIES[f], f, Style::Dotted, frontier(&points, f));
        let curves = (0..FAMILIES.len()).map(curve).collect();
        let axes = ["time over that of the defaults", "relative RMSE, %"];
        panels.push(Panel::new(name, axes, curves));
    }
    println!(
        "auto is sweep + tables: the fastest at {agreed} of the {reached} errors that any reaches"
    );
    Ok(plot::write(output.as_deref(), &panels)?)
}
