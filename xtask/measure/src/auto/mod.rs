//! How often `--max-error` meets its goal, and the time of its choice over that of the cheapest settings.
//!
//! FOLDER has height fields in `height/` and environments in `env/`. Every field (its middle N², 256) is paired with every
//! environment and with skies and suns; pairs of an even sum of places are for fitting: `--fit` measures those and prints
//! the table of `crates/trade/src/auto/fitted.rs`. So every field and every light is in both halves, and no pair is. The
//! other half is reported: for each error the choice, its true error, and its time over that of the cheapest setting that
//! truly meets the goal, of all that a `trade` walk of S (20) seconds and the choices for all errors drew, in turn. `--only`
//! takes the pairs whose name holds a text; `--json` is for machines, written after each pair; the pairs that FILE has are
//! kept, so that a run can go on.

mod fit;
mod report;

use std::path::{Path, PathBuf};

use ridgelight::gpu::Headless;
use ridgelight::scene::{Environment, HeightField, Lights, Quality, Scene, Sun, Surface};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;
use ridgelight_trade::auto::Drawn;

use crate::common::args::Args;
use crate::common::frames::{frame, open, total};
use crate::common::{Outcome, inputs, median};

/// A file without a cell size gets one that makes its relief this share of its side.
const RELIEF: f64 = 0.1;

struct Request {
    folder: PathBuf,
    fit: bool,
    side: usize,
    seconds: f64,
    only: String,
    json: Option<PathBuf>,
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

/// The middle of a field, in cells that give it a relief where its file has none.
fn cropped(field: &HeightField, side: usize) -> Result<HeightField> {
    let part = inputs::cut(field, side)?;
    if part.cell_m() != [1.0; 2] {
        return Ok(part);
    }
    let heights: Vec<f64> = part.heights_m().iter().map(|h| f64::from(*h)).collect();
    let [low, high] =
        heights.iter().fold([f64::INFINITY, -f64::INFINITY], |[l, h], v| [l.min(*v), h.max(*v)]);
    let (rows, cols) = (part.rows(), part.cols());
    let cell_m = [(high - low) / RELIEF / rows.max(cols) as f64; 2];
    HeightField::new(rows, cols, &heights, cell_m, part.voids().map(<[bool]>::to_vec))
}

/// Every environment, the last also turned, and skies with and without a sun. Lights that are alike are
/// an even number of places apart, so that they are in the same half for each field.
fn lights(folder: &Path) -> Result<Vec<(String, Lights)>> {
    let sky = |radiance: f32| Lights { sky: Some([radiance; 3]), ..Lights::default() };
    let sun = |elevation_rad: f64, irradiance: f32| Sun {
        azimuth_rad: 2.5,
        elevation_rad,
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [irradiance; 3],
    };
    let of = |path: &Path, turned_rad: f64| -> Result<Lights> {
        let environment: Option<Environment> = Some(files::read_environment(path, turned_rad)?);
        Ok(Lights { environment, ..Lights::default() })
    };
    let paths = listed(&folder.join("env"))?;
    let mut all = Vec::new();
    for path in &paths {
        all.push((name(path), of(path, 0.0)?));
    }
    all.push(("sky and sun".to_owned(), Lights { suns: vec![sun(0.4, 8.0)], ..sky(1.0) }));
    if let Some(path) = paths.last() {
        all.push((format!("{}, turned 120°", name(path)), of(path, 120_f64.to_radians())?));
    }
    all.push(("sky".to_owned(), sky(1.0)));
    all.push(("low sun".to_owned(), Lights { suns: vec![sun(0.14, 4.0)], ..sky(0.2) }));
    Ok(all)
}

/// The scenes of the half for fitting or for reporting, by name.
fn scenes(asked: &Request) -> Result<Vec<(String, Scene)>> {
    let lights = lights(&asked.folder)?;
    let mut all = Vec::new();
    let fields = listed(&asked.folder.join("height"))?;
    // From the last: the steepest of the data, which takes longest, is the first by name.
    for (i, path) in fields.iter().enumerate().rev() {
        let field = cropped(&files::read_heights(path, &HeightOptions::default())?, asked.side)?;
        for (j, (light, lights)) in lights.iter().enumerate() {
            let label = format!("{} | {light}", name(path));
            if ((i + j) % 2 == 0) == asked.fit && label.contains(&asked.only) {
                let (field, lights) = (field.clone(), lights.clone());
                all.push((label, Scene { field, surface: Surface::default(), lights }));
            }
        }
    }
    Ok(all)
}

/// A draw that takes so long is not repeated: compiling is little of it.
const LONG_MS: f64 = 1e4;

/// Draws, `times` over after a draw that compiles: planes, and passes of the middle draw.
fn draw(gpu: &mut Headless, scene: &Scene, quality: &Quality, times: usize) -> Result<Drawn> {
    let mut frame = frame(gpu, scene, quality)?;
    let mut runs = vec![gpu.draw(&mut frame)?];
    while runs.len() <= times && total(&runs[0]) < LONG_MS {
        runs.push(gpu.draw(&mut frame)?);
    }
    let pixels = gpu.pixels(&frame, 0)?;
    gpu.end(frame);
    if runs.len() > 1 {
        runs.remove(0);
    }
    runs.sort_by(|a, b| total(a).total_cmp(&total(b)));
    let middle = runs.swap_remove(runs.len() / 2);
    let is_void = |i: usize| scene.field.voids().is_some_and(|v| v[i]);
    let plane = |c: usize| {
        let values = pixels.values.iter().skip(c).step_by(pixels.channels).enumerate();
        values.map(|(i, v)| if is_void(i) { f32::NAN } else { *v }).collect()
    };
    let planes = (0..pixels.channels.min(3)).map(plane).collect();
    Ok(Drawn { planes, passes: middle.into_iter().map(|t| (t.label, t.ns)).collect() })
}

/// Median time of `quality` over that of `other`, drawn in turn seven times after a first.
fn ratio(gpu: &mut Headless, scene: &Scene, quality: &Quality, other: &Quality) -> Result<f64> {
    let mut frames = [frame(gpu, scene, quality)?, frame(gpu, scene, other)?];
    let mut ratios = Vec::new();
    for i in 0..=7 {
        let [own, beside] = frames.each_mut().map(|frame| gpu.draw(frame).map(|run| total(&run)));
        let ratio = own? / beside?;
        if i > 0 {
            ratios.push(ratio);
        }
    }
    frames.into_iter().for_each(|f| gpu.end(f));
    Ok(median(ratios))
}

pub fn run(mut args: Args) -> Outcome {
    let asked = Request {
        fit: args.has("--fit"),
        side: args.number("--side", 256)?,
        seconds: args.number("--seconds", 20.0)?,
        only: args.text("--only")?.unwrap_or_default(),
        json: args.path("--json")?,
        folder: args.word().map(PathBuf::from).ok_or("expected FOLDER")?,
    };
    args.end()?;
    let mut gpu = open()?;
    let work = if asked.fit { fit::fit } else { report::report };
    Ok(work(&mut gpu, &asked)?)
}
