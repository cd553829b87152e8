//! How often `--max-error` holds, and how near the cheapest settings it comes.
//!
//! `cargo run --release --example auto -- FOLDER [--fit] [--side N] [--seconds S] [--only TEXT] [--json FILE]`
//!
//! FOLDER has height fields in `height/` and environments in `env/`. Every field (its middle N², 256) is
//! paired with every environment and with skies and suns; pairs of an even sum of places are for fitting:
//! `--fit` measures those and prints the table of `crates/trade/src/auto/fitted.rs`. So every field and every
//! light is in both halves, and no pair is. The other half is reported: per error asked for, what was
//! chosen, its true error, and its time over that of the cheapest that truly holds of all that a `trade`
//! walk of S (20) seconds and the choices for all errors drew, in turn. `--only` takes the pairs whose name holds a text; `--json`
//! is for machines, written after each pair; the pairs that FILE has are kept, so that a run can go on.

use std::path::{Path, PathBuf};

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::scene::{Environment, HeightField, Lights, Scene, Sun, Surface};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

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

fn asked() -> Result<Request> {
    let mut asked = Request {
        folder: PathBuf::new(),
        fit: false,
        side: 256,
        seconds: 20.0,
        only: String::new(),
        json: None,
    };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut text = || args.next().ok_or_else(|| Error::setting(&arg, "nothing", "a value"));
        let number =
            |text: String| text.parse::<f64>().map_err(|_| Error::setting(&arg, text, "a number"));
        match arg.as_str() {
            "--fit" => asked.fit = true,
            "--side" => asked.side = number(text()?)? as usize,
            "--seconds" => asked.seconds = number(text()?)?,
            "--only" => asked.only = text()?,
            "--json" => asked.json = Some(PathBuf::from(text()?)),
            _ => asked.folder = PathBuf::from(&arg),
        }
    }
    Ok(asked)
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

/// The scenes of the half that is asked for, by name.
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

#[path = "auto/device.rs"]
mod device;
#[path = "auto/fit.rs"]
mod fit;
#[path = "auto/report.rs"]
mod report;

fn main() -> Result<()> {
    let asked = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    if asked.fit { fit::fit(&mut gpu, &asked) } else { report::report(&mut gpu, &asked) }
}
