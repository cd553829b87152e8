//! `horizon`: writes the horizon of every texel.

mod compass;
mod fourier;

use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::{self, Limits, Plan};
use ridgelight::scene::{Border, HeightField, Lines, Method, Quality};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Band, GeoTiffWriter, Georeference, Layer, NpyWriter};
use std::path::{Path, PathBuf};
use std::time::Instant;

use indicatif::HumanDuration;

use crate::args::HorizonArgs;
use crate::idle;
use crate::render::world;
use crate::setup::{self, Outcome};
pub use compass::Compass;
pub use fourier::Fourier;

/// Limit of the bytes that one batch of azimuths reads back.
const OUTPUT_BYTES: u64 = 256 << 20;

/// Takes an azimuth's number, its elevations, and its distances or nothing.
pub type Each<'a> = dyn FnMut(u32, &[f32], &[f32]) -> Result<()> + 'a;

/// Azimuths whose outputs take at most [`OUTPUT_BYTES`] and a quarter of the budget.
pub fn at_once(field: &HeightField, limits: &Limits) -> u32 {
    let plane = 4 * (field.rows() * field.cols()) as u64;
    (OUTPUT_BYTES.min(limits.memory_budget / 4) / plane).clamp(1, 256) as u32
}

/// Horizons from azimuth `first` on: of `most` azimuths, or of fewer where the limits require it.
pub fn plan_from(
    field: &HeightField,
    border: Border,
    quality: &Quality,
    limits: &Limits,
    (first, most): (u32, u32),
    distances: bool,
) -> Result<Plan> {
    let mut count = most.min(quality.azimuths - first);
    loop {
        match plan::horizons(field, border, quality, limits, (first, count), distances) {
            Err(Error::Limit { .. }) if count > 1 => count /= 2,
            planned => return planned,
        }
    }
}

/// The settings used.
pub fn used(
    field: &HeightField,
    border: Border,
    quality: &Quality,
    limits: &Limits,
    distances: bool,
) -> Result<Vec<(String, String)>> {
    Ok(used_by(&plan_from(field, border, quality, limits, (0, 1), distances)?, quality))
}

fn used_by(plan: &Plan, quality: &Quality) -> Vec<(String, String)> {
    let mut used = plan.settings.clone();
    used.push(("azimuths".into(), quality.azimuths.to_string()));
    used
}

/// Calls `each` for every azimuth k in order: (k, elevations, distances or nothing). Returns the
/// times of all passes and the last plan.
pub fn for_each(
    gpu: &mut Headless,
    field: &HeightField,
    border: Border,
    quality: &Quality,
    limits: &Limits,
    distances: bool,
    each: &mut Each<'_>,
) -> Result<(Vec<Timing>, Plan)> {
    let plane = field.rows() * field.cols();
    let mut at_once = at_once(field, limits);
    let mut times = Vec::new();
    let mut first = 0;
    loop {
        let plan = plan_from(field, border, quality, limits, (first, at_once), distances)?;
        let count = plan.azimuths.len() as u32;
        at_once = count;
        let kept = plan.clone();
        let (angles, far) = gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
            times.extend(gpu.draw(frame)?);
            let angles = gpu.pixels(frame, 0)?.values;
            let far = if distances { gpu.pixels(frame, 1)?.values } else { Vec::new() };
            Ok((angles, far))
        })?;
        for (k, range) in (first..first + count).zip((0..).map(|l| l * plane..(l + 1) * plane)) {
            each(k, &angles[range.clone()], far.get(range).unwrap_or_default())?;
        }
        first += count;
        if first == quality.azimuths {
            return Ok((times, kept));
        }
    }
}

/// A file of one layer for each azimuth.
enum LayerFile {
    Npy(NpyWriter),
    Tif(GeoTiffWriter),
    /// Its path and layers, held until the end.
    Exr(PathBuf, Vec<(String, Vec<f32>)>),
    /// Its path and texels: north, east, south, west.
    Png(PathBuf, Vec<[u8; 4]>),
}

/// An elevation as a channel of Stellarium's horizon maps: sign(s) √|s| of its sine s, mapped from -1..1 to 0..255. A void has elevation
/// 0.
fn channel(elevation_rad: f32) -> u8 {
    let sine = if elevation_rad.is_nan() { 0.0 } else { elevation_rad.sin() };
    (255.0 * (0.5 + 0.5 * sine.abs().sqrt().copysign(sine))).round() as u8
}

impl LayerFile {
    fn create(
        path: &Path,
        [count, rows, cols]: [usize; 3],
        names: Vec<String>,
        unit: &str,
        georeference: Option<&Georeference>,
    ) -> Result<Self> {
        match setup::extension(path).as_str() {
            "npy" => Ok(Self::Npy(NpyWriter::create(path, &[count, rows, cols])?)),
            "exr" => {
                let layers = names.into_iter().map(|name| (name, Vec::new())).collect();
                Ok(Self::Exr(path.to_owned(), layers))
            }
            "png" => Ok(Self::Png(path.to_owned(), vec![[0; 4]; rows * cols])),
            _ => {
                let bands = names.into_iter().map(|name| Band { name, unit: unit.to_owned() });
                let (bands, at) = (bands.collect(), georeference.cloned());
                GeoTiffWriter::create(path, [rows, cols], bands, at).map(Self::Tif)
            }
        }
    }

    fn write(&mut self, layer: usize, plane: Vec<f32>) -> Result<()> {
        match self {
            Self::Npy(file) => file.write_plane(layer, &plane),
            Self::Tif(file) => file.write(layer, &plane),
            Self::Exr(_, layers) => {
                layers[layer].1 = plane;
                Ok(())
            }
            Self::Png(_, texels) => {
                texels.iter_mut().zip(plane).for_each(|(to, angle)| to[layer] = channel(angle));
                Ok(())
            }
        }
    }

    fn finish(self, [rows, cols]: [usize; 2], metadata: &[(String, String)]) -> Result<()> {
        match self {
            Self::Npy(file) => file.finish(),
            Self::Tif(file) => file.finish(metadata),
            Self::Exr(path, layers) => {
                let layers = layers.iter().map(|(name, plane)| Layer::scalar(name, plane));
                files::write_exr(&path, rows, cols, &layers.collect::<Vec<_>>(), metadata)
            }
            Self::Png(path, texels) => {
                let codes = texels.as_flattened();
                files::write_codes_aside(&path, [cols, rows], (4, 8), codes, metadata)?.place()
            }
        }
    }
}

pub fn run(args: &HorizonArgs) -> Result<Outcome> {
    let endings: &[&str] =
        if args.fourier.is_some() { &["ktx2"] } else { &["npy", "tif", "tiff", "exr", "png"] };
    let outputs = [
        ("-o", Some(args.output.as_path()), endings),
        ("--distances", args.distances.as_deref(), &["npy", "tif", "tiff"]),
        ("--json", args.global.json.as_deref(), &["json"]),
    ];
    setup::check_outputs(&outputs, &args.input.paths())?;
    let quality = args.quality.quality()?;
    let is_npy = setup::extension(&args.output) == "npy";
    let is_exact = quality.lines == Lines::Exact && quality.method != Method::BruteForce;
    if is_exact && is_npy && args.global.json.is_none() {
        return Err(Error::setting(
            "--lines exact",
            "an .npy output without --json",
            "--json FILE beside it, or a .tif: exact azimuths are uneven, and a .npy cannot name them",
        ));
    }
    if setup::extension(&args.output) == "png" {
        if is_exact {
            let expected = "evenly spaced azimuths, for a .png";
            return Err(Error::setting("--lines", "exact", expected));
        }
        if quality.azimuths != 4 {
            let expected = "4, for a .png: north, east, south and west";
            return Err(Error::setting("--azimuths", quality.azimuths.to_string(), expected));
        }
    }
    if let Some(fourier) = args.fourier {
        if is_exact {
            let expected = "evenly spaced azimuths, for a Fourier series";
            return Err(Error::setting("--lines", "exact", expected));
        }
        if quality.azimuths <= fourier.coefficients {
            let found = format!("{} coefficients", fourier.coefficients);
            let expected = format!("fewer than the {} azimuths", quality.azimuths);
            return Err(Error::setting("--fourier", found, expected));
        }
    }
    let (field, georeference) =
        setup::georeferenced(&args.input.path, &args.surface, &args.global)?;
    let border = setup::border(&args.surface);
    let distances = args.distances.is_some();
    setup::check_plan(&args.global, |limits| {
        let most = at_once(&field, limits);
        plan_from(&field, border, &quality, limits, (0, most), distances)
    })?;
    let shape = [quality.azimuths as usize, field.rows(), field.cols()];
    let azimuths = plan::circle_rad(&quality, field.cell_m())?;
    let (mut gpu, limits) = setup::device(&args.global)?;
    let mut series = args.fourier.map(|wanted| {
        let size = [field.rows(), field.cols()];
        fourier::Series::new(wanted, azimuths.clone(), size, limits.memory_budget)
    });
    let outputs = [Some(args.output.as_path()), args.distances.as_deref()];
    let bytes = 4 * shape.iter().product::<usize>() as u64;
    let of_file = |path| match (setup::extension(path).as_str(), &series) {
        ("npy", _) => Some((path, bytes)),
        ("ktx2", Some(series)) => Some((path, series.bytes())),
        _ => None,
    };
    files::check_room(&outputs.into_iter().flatten().filter_map(of_file).collect::<Vec<_>>())?;
    let most = at_once(&field, &limits);
    let first = plan_from(&field, border, &quality, &limits, (0, most), distances)?;
    idle::say(args.global.quiet, &args.quality.written, &used_by(&first, &quality));
    // Azimuths that are drawn together.
    let at_once = first.azimuths.len();
    let compass = Compass::of(&azimuths);
    let create = |path: &Path, unit: &str| {
        LayerFile::create(path, shape, compass.names(), unit, georeference.as_ref())
    };
    let has_layers = series.is_none();
    let mut angles_file = has_layers.then(|| create(&args.output, "rad")).transpose()?;
    let mut distances_file = args.distances.as_ref().map(|path| create(path, "m")).transpose()?;
    let bar = crate::setup::terminal::progress(args.global.quiet, "horizons");
    let (begun, mut done, mut left) = (Instant::now(), 0, String::new());
    let mut times = Vec::new();
    let mut metadata = Vec::new();
    loop {
        let [rounds, rounds_done] = series.as_ref().map_or([1, 0], fourier::Series::rounds);
        let (more, plan) = for_each(
            &mut gpu,
            &field,
            border,
            &quality,
            &limits,
            distances,
            &mut |k, angles, distances| {
                let masked = |plane: &[f32]| setup::masked(&field, plane.to_vec());
                let layer = compass.layer_of[k as usize];
                if let Some(series) = &mut series {
                    series.add(k as usize, angles);
                }
                if let Some(file) = &mut angles_file {
                    file.write(layer, masked(angles))?;
                }
                if let Some(file) = &mut distances_file {
                    file.write(layer, masked(distances))?;
                }
                done += 1;
                let azimuth = k as usize + 1;
                if azimuth.is_multiple_of(at_once) || azimuth == shape[0] {
                    let others = (rounds * shape[0] - done) as u32;
                    let duration = HumanDuration(begun.elapsed() * others / done as u32);
                    left = format!(", about {duration} left");
                }
                let round = match rounds {
                    1 => String::new(),
                    _ => format!("round {} of {rounds}, ", rounds_done + 1),
                };
                bar.set_message(format!(
                    "horizons: {round}azimuth {azimuth} of {}{left}",
                    shape[0]
                ));
                Ok(())
            },
        )?;
        times.extend(more);
        if rounds_done == 0 {
            metadata = setup::metadata(&gpu, &field, &plan);
            metadata.push(("azimuths".into(), quality.azimuths.to_string()));
            metadata.extend(setup::asked(&args.input, &args.surface, None));
            let named = "compass degrees, clockwise from north, to the horizon";
            metadata.push(("azimuth_names".into(), named.into()));
        }
        let Some(series) = &mut series else { break };
        let values =
            "Fourier series of the tangent of the elevation over azimuth, for bevy-clipmap";
        let about = [metadata.as_slice(), &[("values".into(), values.into())]].concat();
        if !series.end_round(&args.output, &about)? {
            break;
        }
    }
    bar.finish_and_clear();
    let mut of_series = String::new();
    if let Some(series) = series {
        let left_out = 100.0 * series.finish()?;
        metadata.push(("fourier_error_percent".into(), format!("{left_out:.3}")));
        of_series =
            format!(", of which the series leaves out {left_out:.2} % (RMS of the tangents)");
    }
    let of_angles = match angles_file {
        Some(LayerFile::Png(..)) => {
            "sign(s) √|s|, s the sine of the horizon's elevation; -1..1 is mapped to 0..255; channels R, G, B, A: north, east, south, west"
        }
        _ => "elevation of the horizon, rad",
    };
    let of_distances = "distance to the horizon's occluder, m; 0 without one";
    for (file, values) in [(angles_file, of_angles), (distances_file, of_distances)] {
        let about = [metadata.as_slice(), &[("values".into(), values.into())]].concat();
        file.map_or(Ok(()), |file| file.finish([shape[1], shape[2]], &about))?;
    }
    if setup::extension(&args.output) == "png" {
        world::write(&args.output, &args.input, georeference.as_ref())?;
    }
    if let Some(json) = &args.global.json {
        if has_layers {
            metadata.push(("values".into(), of_angles.into()));
        }
        let mut value = setup::as_json(&metadata, &times);
        value["azimuths_deg"] = compass.degrees.into();
        files::write_json(json, &value)?;
    }
    if !args.global.quiet {
        let ms: f64 = setup::total_ns(&times) / 1e6;
        crate::say!(
            "Wrote {} ({}x{}, {} azimuths{of_series}) in {ms:.1} ms of GPU time on {}.",
            args.output.display(),
            field.cols(),
            field.rows(),
            quality.azimuths,
            gpu.report().name
        );
    }
    Ok(Outcome::Done)
}
