//! Engines and bases on real scenes: the cheapest of each within an error.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Basis, Fuse, Lines, Method, Quality, Scene, Wedges};
use ridgelight_io::{HeightOptions, read_environment, read_heights};

use crate::middle::middle;
use crate::plot::{Curve, Panel, svg};
use crate::{colours, median, off, truth, under};

/// Errors that are asked for, %.
const TARGETS: [f64; 7] = [20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2];
const FAMILIES: [&str; 5] = [
    "sweep + tables",
    "sweep + harmonics",
    "sweep + harmonics by NLP",
    "pyramid + tables",
    "pyramid + harmonics",
];

/// Settings, their family, error and time over the defaults' drawn in turn.
struct Point {
    family: usize,
    name: String,
    error: f64,
    time: f64,
}

fn scenes(folder: &Path, side: usize) -> Result<Vec<(&'static str, Scene)>> {
    let file = |kind: &str, name: &str| folder.join(kind).join(name);
    let whole = HeightOptions::default();
    let rainier = HeightOptions { cell_m: Some([64.0, 92.6]), nodata: Some(-32768.0), ..whole };
    // 80 cells from black to white.
    let moss = HeightOptions { z_scale: 80.0 / 65535.0, cell_m: Some([1.0; 2]), ..whole };
    let all = [
        ("White Mountains, sky", "N44W072.hgt", whole, "sky_512x256.hdr"),
        ("Mt Rainier, sunlit sky", "mt_rainier_90m.tif", rainier, "spiaggia_di_mondello_1k.hdr"),
        ("moss, windows", "Moss001_1K_Displacement.png", moss, "lab.hdr"),
    ];
    all.into_iter()
        .map(|(name, field, options, env)| {
            let field = read_heights(&file("height", field), &options)?;
            let environment = read_environment(&file("env", env), 0.0)?;
            Ok((name, under(middle(&field, side)?, environment)))
        })
        .collect()
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

/// Time of a frame over that of the defaults', drawn right after it.
fn beside(gpu: &mut Headless, frames: &mut [Frame; 2]) -> Result<f64> {
    let total =
        |frame: &mut Frame| -> Result<f64> { Ok(gpu.draw(frame)?.iter().map(|t| t.ns).sum()) };
    let [settings, defaults] = frames;
    Ok(total(settings)? / total(defaults)?)
}

/// Error and time of some settings; the time of `samples` draws where none of `others` of the family is nearer
/// and faster by half, of one draw where one is.
fn point(
    gpu: &mut Headless,
    scene: &Scene,
    truth: &[f32],
    (family, name, quality): (usize, String, Quality),
    samples: usize,
    others: &[Point],
) -> Result<Point> {
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let frame = |gpu: &mut Headless, quality: &Quality| -> Result<Frame> {
        let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
        let mut frame = gpu.frame(plan, &contents)?;
        gpu.draw(&mut frame)?;
        Ok(frame)
    };
    let mut frames = [frame(gpu, &quality)?, frame(gpu, &Quality::default())?];
    let error = off(&colours(&gpu.pixels(&frames[0], 0)?), truth)?;
    let mut ratios = vec![beside(gpu, &mut frames)?];
    let beaten = |p: &Point| p.family == family && p.error <= error && 1.5 * p.time < ratios[0];
    if !others.iter().any(beaten) {
        for _ in 1..samples {
            ratios.push(beside(gpu, &mut frames)?);
        }
    }
    frames.into_iter().for_each(|frame| gpu.end(frame));
    Ok(Point { family, name, error, time: median(ratios) })
}

fn points(gpu: &mut Headless, scene: &Scene, samples: usize) -> Result<Vec<Point>> {
    let truth = truth(gpu, scene)?;
    let mut all = Vec::new();
    for candidate in candidates() {
        let point = point(gpu, scene, &truth, candidate, samples, &all)?;
        all.push(point);
    }
    Ok(all)
}

/// The cheapest of a family within an error.
fn cheapest(points: &[Point], family: usize, error: f64) -> Option<&Point> {
    let within = points.iter().filter(|p| p.family == family && p.error <= error);
    within.min_by(|a, b| a.time.total_cmp(&b.time))
}

/// Points of a family than which none of it is both cheaper and nearer.
fn frontier(points: &[Point], family: usize) -> Vec<[f64; 2]> {
    let of = || points.iter().filter(|p| p.family == family);
    let best = |p: &&Point| !of().any(|q| q.time < p.time && q.error <= p.error);
    let mut all: Vec<[f64; 2]> = of().filter(best).map(|p| [p.time, p.error]).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all
}

pub fn run(gpu: &mut Headless, folder: &Path, side: usize, samples: usize) -> Result<String> {
    println!(
        "the middle {side}²; time of a frame over that of the defaults (a sweep of 64 azimuths, tables), each \
         drawn in turn with them, medians of {samples} (one draw where another of the same engine and basis is nearer and \
         faster by half); error: RMSE over the mean, beside exact horizons of 256 \
         azimuths and tables\n"
    );
    let (mut panels, mut asked, mut agreed) = (Vec::new(), 0, 0);
    for (name, scene) in scenes(folder, side)? {
        let points = points(gpu, &scene, samples)?;
        println!("| {name}: within % | {} |", FAMILIES.join(" | "));
        println!("|---|---|---|---|---|---|");
        for error in TARGETS {
            let best: Vec<Option<&Point>> =
                (0..FAMILIES.len()).map(|f| cheapest(&points, f, error)).collect();
            let times = best.iter().flatten().map(|p| p.time);
            let least = times.fold(f64::INFINITY, f64::min);
            let cell = |p: &Option<&Point>| match p {
                None => "none".to_owned(),
                Some(p) if p.time == least => format!("**{:.2}** ({})", p.time, p.name),
                Some(p) => format!("{:.2} ({})", p.time, p.name),
            };
            println!("| {error} | {} |", best.iter().map(cell).collect::<Vec<_>>().join(" | "));
            if least < f64::INFINITY {
                asked += 1;
                agreed += usize::from(best[0].is_some_and(|p| p.time == least));
            }
        }
        println!();
        let curve = |family: usize| Curve {
            name: FAMILIES[family].into(),
            points: frontier(&points, family),
            colour: family,
            is_floor: false,
        };
        let curves = (0..FAMILIES.len()).map(curve).collect();
        let (x, y) = ("time over the defaults'", "relative RMSE, %");
        panels.push(Panel { title: name.into(), x, y, curves });
    }
    println!(
        "auto is sweep + tables: the cheapest at {agreed} of the {asked} errors that any reach"
    );
    Ok(svg(&panels))
}
