//! Frames, their times, and their errors.

use std::time::{Duration, Instant};

use ridgelight::gpu::{Frame, Headless, Pixels, Timing};
use ridgelight::plan::{self, Pass, Picture, Plan, Resource};
use ridgelight::scene::{HeightField, Method, Normals, Quality, Scene};
use ridgelight::{Error, Result};
use ridgelight_trade::error::ImageError;

use super::median;

/// Linear RGB of all grid points.
pub type Colours = Vec<[f64; 3]>;

/// The device's name and driver.
pub fn device(gpu: &Headless) -> String {
    format!("{}, {}", gpu.report().name, gpu.report().driver)
}

pub fn frame(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Frame> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
    gpu.frame(plan, &plan::picture_inputs(scene))
}

/// `work` on a picture's frame.
pub fn with_picture<T>(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
    wanted: Picture,
    work: impl FnOnce(&mut Headless, &mut Frame) -> Result<T>,
) -> Result<T> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, wanted)?;
    gpu.with_frame(plan, &plan::picture_inputs(scene), work)
}

/// No more runs once they took so long together.
const LONGEST: Duration = Duration::from_secs(20);

/// A picture, and the passes of each run after the first, which compiles; of the first where it is
/// alone.
pub struct Drawn {
    pub light: Colours,
    /// All bounces; black without [`drawn_in_layers`].
    pub indirect: Colours,
    pub runs: Vec<Vec<Timing>>,
    pub plan: Plan,
}

impl Drawn {
    /// The median of whole frames.
    pub fn ms(&self) -> f64 {
        median(self.runs.iter().map(|run| total(run)).collect())
    }

    /// The run of median time.
    pub fn middle(&self) -> &[Timing] {
        let mut runs: Vec<_> = self.runs.iter().collect();
        runs.sort_by(|a, b| total(a).total_cmp(&total(b)));
        runs[runs.len() / 2]
    }

    /// The median of the passes that are not of direct light from a sky or an environment. On a GPU they may come first.
    pub fn bounces_ms(&self) -> f64 {
        let is_direct = |pass: &Pass| {
            let of = |text: &str, prefixes: &[&str]| prefixes.iter().any(|p| text.starts_with(p));
            of(&pass.part, &["env", "sky"]) || of(pass.name(), &["env_", "height_transpose"])
        };
        let indirect = |run: &[Timing]| -> f64 {
            let timed = run.iter().zip(&self.plan.passes);
            timed.filter(|(_, pass)| !is_direct(pass)).map(|(t, _)| t.ns).sum::<f64>() / 1e6
        };
        median(self.runs.iter().map(|run| indirect(run)).collect())
    }

    /// Bytes of the resources of these names.
    pub fn bytes(&self, names: &[&str]) -> u64 {
        bytes(&self.plan, names)
    }
}

/// Leaves out the texels that are voids: NaN, as in files.
fn mask_voids(light: &mut Colours, field: &HeightField) {
    for (texel, _) in light.iter_mut().zip(field.voids().unwrap_or_default()).filter(|t| *t.1) {
        *texel = [f64::NAN; 3];
    }
}

/// Draws a picture once and then `runs` times. Keeps what `pause` returns from the end of the first run on. NaN at voids.
pub fn drawn_as<P>(
    gpu: &mut Headless,
    scene: &Scene,
    (quality, runs): (&Quality, usize),
    wanted: Picture,
    pause: impl FnOnce() -> P,
) -> Result<Drawn> {
    with_picture(gpu, scene, quality, wanted, |gpu, frame| {
        let first = gpu.draw(frame)?;
        let _pause = pause();
        let (begun, mut all) = (Instant::now(), Vec::new());
        while all.len() < runs && begun.elapsed() < LONGEST {
            all.push(gpu.draw(frame)?);
        }
        let runs = if all.is_empty() { vec![first] } else { all };
        let (plan, mut light) = (frame.plan().clone(), colours(&gpu.pixels(frame, 0)?));
        mask_voids(&mut light, &scene.field);
        let mut indirect = vec![[0.0; 3]; light.len()];
        for (i, (_, output)) in plan.outputs().enumerate() {
            if output.name.starts_with("indirect.") {
                add(&mut indirect, 1.0, &colours(&gpu.pixels(frame, i)?));
            }
        }
        mask_voids(&mut indirect, &scene.field);
        Ok(Drawn { light, indirect, runs, plan })
    })
}

pub fn drawn(gpu: &mut Headless, scene: &Scene, quality: &Quality, runs: usize) -> Result<Drawn> {
    drawn_as(gpu, scene, (quality, runs), Picture::default(), || ())
}

/// A picture of five runs with its indirect light.
pub fn drawn_in_layers(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Drawn> {
    let wanted = Picture { light_layers: true, ..Picture::default() };
    drawn_as(gpu, scene, (quality, 5), wanted, || ())
}

/// Milliseconds of frames of these settings, drawn in turn: a row for each turn after the first.
pub fn in_turn<const N: usize>(
    gpu: &mut Headless,
    scene: &Scene,
    all: [&Quality; N],
    turns: usize,
) -> Result<Vec<[f64; N]>> {
    let mut frames = Vec::new();
    for quality in all {
        frames.push(frame(gpu, scene, quality)?);
    }
    let rows = frames_in_turn(gpu, frames, turns)?;
    Ok(rows.into_iter().map(|row| row.try_into().expect("a time of each frame")).collect())
}

/// The same for frames of any plans. Ends the frames.
pub fn frames_in_turn(
    gpu: &mut Headless,
    mut frames: Vec<Frame>,
    turns: usize,
) -> Result<Vec<Vec<f64>>> {
    let mut rows = Vec::new();
    for _ in 0..=turns {
        let row = frames.iter_mut().map(|frame| Ok(total(&gpu.draw(frame)?)));
        rows.push(row.collect::<Result<Vec<_>>>()?);
    }
    frames.into_iter().for_each(|frame| gpu.end(frame));
    Ok(rows.split_off(1))
}

/// Milliseconds of frames of new heights, drawn in turn, frame `k` in the first `turns[k]` of all turns: without the passes
/// whose tables depend on lights and settings alone. A list for each frame.
pub fn new_heights_in_turn(
    gpu: &Headless,
    frames: &mut [Frame],
    turns: &[usize],
) -> Result<Vec<Vec<f64>>> {
    let mut needed = Vec::new();
    for frame in frames.iter_mut() {
        gpu.draw(frame)?;
        let plan = frame.plan();
        let heights: Vec<_> = plan.find("heights").into_iter().collect();
        needed.push(plan.passes_after(plan, &heights));
    }
    let mut times = vec![Vec::new(); frames.len()];
    for turn in 0..turns.iter().copied().max().unwrap_or(0) {
        for (k, frame) in frames.iter_mut().enumerate().filter(|(k, _)| turn < turns[*k]) {
            times[k].push(total(&gpu.draw_passes(frame, &needed[k])?));
        }
    }
    Ok(times)
}

/// The light of exact horizons: every crossing in these azimuths, by tables of 1024 elevations.
pub fn exact_light(gpu: &mut Headless, scene: &Scene, azimuths: u32) -> Result<Colours> {
    let method = Method::BruteForce;
    let quality = Quality { method, azimuths, table_elevations: 1024, ..Quality::default() };
    Ok(drawn(gpu, scene, &quality, 0)?.light)
}

/// Milliseconds of a frame.
pub fn total(run: &[Timing]) -> f64 {
    ms(run, "")
}

/// Milliseconds of the passes whose names begin so.
pub fn ms(run: &[Timing], name: &str) -> f64 {
    run.iter().filter(|t| t.label.starts_with(name)).map(|t| t.ns).sum::<f64>() / 1e6
}

/// The texels' first three channels; one channel is grey.
pub fn colours(pixels: &Pixels) -> Colours {
    let channel = |t: &[f32], c: usize| f64::from(t[c.min(t.len() - 1)]);
    pixels.values.chunks_exact(pixels.channels).map(|t| [0, 1, 2].map(|c| channel(t, c))).collect()
}

pub fn to_f32(light: &[[f64; 3]]) -> Vec<[f32; 3]> {
    light.iter().map(|t| t.map(|v| v as f32)).collect()
}

/// Bytes of a plan's resources of these names.
pub fn bytes(plan: &Plan, names: &[&str]) -> u64 {
    let own = plan.resources.iter().filter(|r| names.contains(&r.name.as_str()));
    own.map(Resource::bytes).sum()
}

/// Path-traced radiance and its standard error after each number of batches, of 64 paths each, that
/// `stops` lists in rising order.
///
/// # Errors
/// Also where a ray was lost.
pub fn traced_at(
    gpu: &mut Headless,
    scene: &Scene,
    (bounces, normals, seed): (u32, Normals, u32),
    stops: &[u32],
) -> Result<Vec<[Colours; 2]>> {
    let plan = plan::reference(scene, bounces, normals, None, seed, &gpu.report().limits)?;
    let is_path = |p: &usize| plan.passes[*p].name() == "path_trace";
    let paths: Vec<usize> = (0..plan.passes.len()).filter(is_path).collect();
    let lost = plan.find("lost_rays");
    gpu.with_frame(plan, &plan::reference_inputs(scene), |gpu, frame| {
        gpu.draw(frame)?;
        let (mut done, mut all) = (1, Vec::new());
        for stop in stops {
            while done < *stop {
                gpu.draw_passes(frame, &paths)?;
                done += 1;
            }
            all.push([colours(&gpu.pixels(frame, 0)?), colours(&gpu.pixels(frame, 1)?)]);
        }
        let lost = lost.map(|lost| gpu.read(frame, lost)).transpose()?;
        if lost.is_some_and(|lost| lost.first() != Some(&0)) {
            let reason = "rays took more steps than a field can need".into();
            return Err(Error::Device { doing: "tracing paths".into(), reason });
        }
        Ok(all)
    })
}

pub fn traced(
    gpu: &mut Headless,
    scene: &Scene,
    bounces: u32,
    batches: u32,
) -> Result<[Colours; 2]> {
    Ok(traced_at(gpu, scene, (bounces, Normals::Smooth, 1), &[batches])?.remove(0))
}

pub fn minus(a: &Colours, b: &Colours) -> Colours {
    a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|c| a[c] - b[c])).collect()
}

pub fn add(sum: &mut Colours, share: f64, light: &Colours) {
    let values = sum.as_flattened_mut().iter_mut().zip(light.as_flattened());
    values.for_each(|(sum, v)| *sum += share * v);
}

pub fn mean(light: &Colours) -> f64 {
    light.as_flattened().iter().sum::<f64>() / (3 * light.len()) as f64
}

pub fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    let (squares, count) = values.into_iter().fold((0.0, 0.0), |(s, n), v| (s + v * v, n + 1.0));
    f64::sqrt(squares / f64::max(count, 1.0))
}

/// The rms of all channels.
pub fn rms_of(light: &Colours) -> f64 {
    rms(light.as_flattened().iter().copied())
}

/// RMSE relative to the mean of the reference, %.
pub fn error(found: &Colours, reference: &Colours) -> Result<f64> {
    error_of(found.as_flattened(), reference.as_flattened())
}

/// The same of values.
pub fn error_of(found: &[f64], reference: &[f64]) -> Result<f64> {
    Ok(100.0 * ImageError::of(found, reference, reference.len())?.relative_rmse)
}
