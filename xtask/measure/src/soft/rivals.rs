//! Engines and bases on three real scenes of FOLDER's `height/` and `env/`, their middle N² (192) grid points: the
//! cheapest of each within an error, and whether `auto` is it.

use std::path::{Path, PathBuf};

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};
use ridgelight::scene::{Basis, Fuse, Lines, Method, Quality, Scene, Wedges};

use super::truth;
use crate::common::args::Args;
use crate::common::frames::{self, Colours, colours, error, open, total};
use crate::common::plot::{self, Panel, Style};
use crate::common::{Outcome, head, inputs, median};

/// Goals, %.
const TARGETS: [f64; 7] = [20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2];
const FAMILIES: [&str; 5] =
    ["sweep + tables", "sweep + SH", "sweep + SH by NLP", "pyramid + tables", "pyramid + SH"];

/// Settings, their family, error and time over that of the defaults drawn in turn.
struct Point {
    family: usize,
    name: String,
    error: f64,
    time: f64,
}

fn scenes(folder: &Path, side: usize) -> Result<Vec<(&'static str, Scene)>> {
    let all = [
        ("White Mountains, sky", inputs::WHITE_MOUNTAINS, "sky_512x256.hdr"),
        ("Mt Rainier, sunlit sky", inputs::RAINIER, "spiaggia_di_mondello_1k.hdr"),
        ("moss, windows", inputs::MOSS, "lab.hdr"),
    ];
    let scene = |(name, field, environment)| {
        let field = inputs::middle(&inputs::field_of(folder, field)?, side)?;
        Ok((name, inputs::under(field, inputs::environment_of(folder, environment)?)))
    };
    all.into_iter().map(scene).collect()
}

fn candidates() -> Vec<(usize, String, Quality)> {
    let base = Quality { method: Method::Sweep, ..Quality::default() };
    let sweeps =
        [(Lines::FourCells, base.fuse), (Lines::Cell, base.fuse), (Lines::Cell, Fuse::AimedAround)];
    let sweeps = sweeps.map(|(lines, fuse)| {
        let name = format!("lines {} {}", lines.name(), fuse.name());
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
            let soft = Quality { basis: Basis::Sh, ..quality };
            for (sh_order, subsample) in [(2, 4), (2, 1), (4, 4), (4, 2), (4, 1), (6, 2), (6, 1)] {
                let name = format!("{engine}, order {sh_order}, {subsample}×");
                all.push((family + 1, name, Quality { sh_order, subsample, ..soft }));
            }
            for sh_order in [4, 6].into_iter().filter(|_| family == 0) {
                let name = format!("{engine}, order {sh_order}");
                all.push((2, name, Quality { sh_order, wedges: Wedges::Nlp, ..soft }));
            }
        }
    }
    all
}

/// Error and time of some settings; the time of `runs` draws, but of one draw where one of `others` of the same
/// family has a lower error and two thirds of the time.
fn point(
    gpu: &mut Headless,
    scene: &Scene,
    truth: &Colours,
    (family, name, quality): (usize, String, Quality),
    runs: usize,
    others: &[Point],
) -> Result<Point> {
    let frame = |gpu: &mut Headless, quality: &Quality| -> Result<Frame> {
        let mut frame = frames::frame(gpu, scene, quality)?;
        gpu.draw(&mut frame)?;
        Ok(frame)
    };
    let mut frames = [frame(gpu, &quality)?, frame(gpu, &Quality::default())?];
    let error = error(&colours(&gpu.pixels(&frames[0], 0)?), truth)?;
    let mut beside = || -> Result<f64> {
        let [settings, defaults] = &mut frames;
        Ok(total(&gpu.draw(settings)?) / total(&gpu.draw(defaults)?))
    };
    let mut ratios = vec![beside()?];
    let beaten = |p: &Point| p.family == family && p.error <= error && 1.5 * p.time < ratios[0];
    if !others.iter().any(beaten) {
        for _ in 1..runs {
            ratios.push(beside()?);
        }
    }
    frames.into_iter().for_each(|frame| gpu.end(frame));
    Ok(Point { family, name, error, time: median(ratios) })
}

/// The cheapest of a family within an error.
fn cheapest(points: &[Point], family: usize, error: f64) -> Option<&Point> {
    let within = points.iter().filter(|p| p.family == family && p.error <= error);
    within.min_by(|a, b| a.time.total_cmp(&b.time))
}

/// Points of a family than which none of it is both cheaper and more exact.
fn frontier(points: &[Point], family: usize) -> Vec<[f64; 2]> {
    let of = || points.iter().filter(|p| p.family == family);
    let best = |p: &&Point| !of().any(|q| q.time < p.time && q.error <= p.error);
    let mut all: Vec<[f64; 2]> = of().filter(best).map(|p| [p.time, p.error]).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all
}

pub fn run(mut args: Args) -> Outcome {
    let (side, runs) = (args.number("--side", 192)?, args.number("--runs", 11)?);
    let output = args.path("-o")?;
    let folder = args.word().map(PathBuf::from).ok_or("expected FOLDER")?;
    args.end()?;
    let mut gpu = open()?;
    println!(
        "{}\nthe middle {side}²; time of a frame over that of the defaults (a sweep of 64 azimuths, tables), each \
         drawn in turn with them, medians of {runs} (one draw where another of the same engine and basis is more exact and \
         takes two thirds of the time); error: relative RMSE, beside exact horizons of 256 azimuths and tables\n",
        gpu.report().name
    );
    let (mut panels, mut asked, mut agreed) = (Vec::new(), 0, 0);
    for (name, scene) in scenes(&folder, side)? {
        let truth = truth(&mut gpu, &scene)?;
        let mut points = Vec::new();
        for candidate in candidates() {
            let point = point(&mut gpu, &scene, &truth, candidate, runs, &points)?;
            points.push(point);
        }
        head(&format!("| {name}: within % | {} |", FAMILIES.join(" | ")));
        for error in TARGETS {
            let best: Vec<Option<&Point>> =
                (0..FAMILIES.len()).map(|f| cheapest(&points, f, error)).collect();
            let least = best.iter().flatten().map(|p| p.time).fold(f64::INFINITY, f64::min);
            let cell = |p: &Option<&Point>| match p {
                None => "none".to_owned(),
                Some(p) if p.time == least => format!("**{:.2}** ({})", p.time, p.name),
                Some(p) => format!("{:.2} ({})", p.time, p.name),
            };
            println!("| {error} | {} |", best.iter().map(cell).collect::<Vec<_>>().join(" | "));
            asked += usize::from(least < f64::INFINITY);
            agreed += usize::from(best[0].is_some_and(|p| p.time == least));
        }
        println!();
        let curve = |f: usize| plot::curve(FAMILIES[f], f, Style::Dotted, frontier(&points, f));
        let curves = (0..FAMILIES.len()).map(curve).collect();
        let axes = ["time over that of the defaults", "relative RMSE, %"];
        panels.push(Panel::new(name, axes, curves));
    }
    println!(
        "auto is sweep + tables: the cheapest at {agreed} of the {asked} errors that any reach"
    );
    plot::write(output.as_deref(), &panels)
}
