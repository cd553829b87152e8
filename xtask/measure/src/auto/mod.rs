//! How often `--max-error` meets its goal, and the time of its choice over that of the fastest
//! settings.
//!
//! FOLDER has height fields in `height/` and environments in `env/`. Every field (its middle N²,
//! 256) is paired with every environment and with skies, suns, key lights and sphere lights. `--fit`
//! measures the pairs whose places have an even sum and prints the table of
//! `crates/trade/src/auto/fitted.rs`. The report uses the other pairs, with all three borders: every
//! field and every light is in both halves, and no pair is. For each error it prints the choice, its
//! true error, and its time over that of the fastest settings that truly meet the goal. These are
//! the best of a `trade` walk of S (20) seconds and of all choices.
//! `--specular N` gives the ground an albedo of 0.5 and specular of exponent N and scale 0.4. `--only TEXT` measures only the
//! pairs whose names contain TEXT.

mod fit;
mod report;

use std::path::{Path, PathBuf};

use ridgelight::gpu::Headless;
use ridgelight::plan::Picture;
use ridgelight::scene::{
    Albedo, Border, HeightField, KeyLight, Lights, PhongSpecular, Quality, Scene, Specular,
    SphereLight,
};
use ridgelight::{Error, Result};
use ridgelight_io::{HeightOptions, read_environment, read_heights};
use ridgelight_trade::auto::Drawn;

use crate::common::args::Args;
use crate::common::frames::drawn_as;
use crate::common::terrains::{BORDERS, border_name};
use crate::common::{Outcome, inputs};

/// A file without a cell size gets one that makes its relief this share of its side.
const RELIEF: f64 = 0.1;

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

/// Two sphere lights over a field: one wide and high over its middle, one small beside its highest ground.
fn sphere_lights(field: &HeightField) -> Vec<SphereLight> {
    let [width_m, depth_m] = [
        field.cell_m()[0] * (field.cols() - 1) as f64,
        field.cell_m()[1] * (field.rows() - 1) as f64,
    ];
    let highest_m = field.heights_m().iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let highest_m = field.base_m() + f64::from(highest_m);
    let at = |x: f64, y: f64, over: f64, radius: f64, radiance: f32| SphereLight {
        position_m: [x * width_m, y * depth_m, highest_m + over * width_m],
        radius_m: radius * width_m,
        radiance: [radiance; 3],
    };
    vec![at(0.5, 0.5, 0.3, 0.1, 20.0), at(0.2, 0.7, 0.05, 0.02, 100.0)]
}

/// Every environment, the last also rotated, and skies alone, with a sun, with a key light and with the sphere lights of
/// `field`. Similar lights are an even number of places apart, so they are in the same half for each field.
fn lights(folder: &Path, field: &HeightField) -> Result<Vec<(String, Lights)>> {
    let sky = |radiance: f32| Lights { sky: Some([radiance; 3]), ..Lights::default() };
    let sun = |elevation_rad: f64, irradiance: f32| {
        vec![inputs::sun(2.5_f64.to_degrees(), elevation_rad.to_degrees(), [irradiance; 3])]
    };
    let of = |path: &Path, rotation_rad: f64| -> Result<Lights> {
        let environment = Some(read_environment(path, rotation_rad)?);
        Ok(Lights { environment, ..Lights::default() })
    };
    let paths = listed(&folder.join("env"))?;
    let mut all = Vec::new();
    for path in &paths {
        all.push((name(path), of(path, 0.0)?));
    }
    all.push(("sky and sun".to_owned(), Lights { suns: sun(0.4, 8.0), ..sky(1.0) }));
    if let Some(path) = paths.last() {
        all.push((format!("{}, turned 120°", name(path)), of(path, 120_f64.to_radians())?));
    }
    all.push(("sky".to_owned(), sky(1.0)));
    all.push(("low sun".to_owned(), Lights { suns: sun(0.14, 4.0), ..sky(0.2) }));
    let keys = vec![KeyLight {
        azimuth_rad: 2.5,
        width_rad: 0.2,
        elevations_rad: [0.3, 0.5],
        radiance: [50.0; 3],
    }];
    all.push(("sky and key light".to_owned(), Lights { keys, ..sky(0.5) }));
    let sphere_lights = sphere_lights(field);
    all.push(("sky and sphere lights".to_owned(), Lights { sphere_lights, ..sky(0.2) }));
    Ok(all)
}

/// The scenes of one half, by name.
fn scenes(
    folder: &Path,
    side: usize,
    is_fitted: bool,
    exponent: Option<f32>,
) -> Result<Vec<(String, Scene)>> {
    let mut all = Vec::new();
    // From the last: the steepest of the data, which takes longest, is the first by name.
    for (i, path) in listed(&folder.join("height"))?.iter().enumerate().rev() {
        let field = cropped(&read_heights(path, &HeightOptions::default())?, side)?;
        for (j, (light, lights)) in lights(folder, &field)?.into_iter().enumerate() {
            if ((i + j) % 2 == 0) == is_fitted {
                // The table is of level ground around each field. The pairs of the report take the borders in turn.
                let border = if is_fitted { Border::Plane } else { BORDERS[(i + j / 2) % 3] };
                let label = format!("{} | {light}, {} border", name(path), border_name(border));
                let mut scene = inputs::lit_by(field.clone(), lights);
                scene.surface.border = border;
                if let Some(exponent) = exponent {
                    let phong = PhongSpecular { exponent, scale: 0.4 };
                    scene.surface.specular = Some(Specular::Constant(phong));
                    scene.surface.albedo = Albedo::Constant([0.5; 3]);
                }
                all.push((label, scene));
            }
        }
    }
    Ok(all)
}

/// A picture as `trade` judges it, drawn once.
fn judged(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Drawn> {
    judged_while(gpu, scene, quality, 0, || ())
}

/// A picture as `trade` judges it: planes, NaN at voids, and the passes of the median of `runs`, as [`drawn_as`] draws them.
fn judged_while<P>(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
    runs: usize,
    pause: impl FnOnce() -> P,
) -> Result<Drawn> {
    let found = drawn_as(gpu, scene, (quality, runs), Picture::default(), pause)?;
    let plane = |c: usize| found.light.iter().map(|t| t[c] as f32).collect();
    let passes = found.middle().iter().map(|t| (t.label.clone(), t.ns)).collect();
    Ok(Drawn { planes: [0, 1, 2].map(plane).into(), passes })
}

pub fn run(mut args: Args) -> Outcome {
    let (is_fitted, side) = (args.has("--fit"), args.number("--side", 256)?);
    let (seconds, json) = (args.number("--seconds", 20.0)?, args.path("--json")?);
    let (exponent, only) = (args.value("--specular")?, args.value::<String>("--only")?);
    let folder = args.folder().ok_or("expected FOLDER")?;
    let mut gpu = args.open()?;
    let mut scenes = scenes(&folder, side, is_fitted, exponent)?;
    scenes.retain(|(name, _)| only.as_ref().is_none_or(|only| name.contains(only)));
    if scenes.is_empty() {
        return Err("--only: no pair has a name with that text".into());
    }
    let of = (side, &scenes[..]);
    match is_fitted {
        true => Ok(fit::fit(&mut gpu, of)?),
        false => Ok(report::report(&mut gpu, of, seconds, json.as_deref())?),
    }
}
