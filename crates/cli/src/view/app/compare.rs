//! The picture between that without shadows and the reference: two more frames, and the error
//! against the reference.

use std::time::{Duration, Instant};

use ridgelight::gpu::{Frame, Timing};
use ridgelight::plan::{self, Limits, REFERENCE_BATCH};
use ridgelight::scene::Normals;
use ridgelight::{Error, Result};
use ridgelight_viewer::Screen;

use super::super::state::State;
use super::drawing::{after_new_heights, replan};
use crate::reference::root_mean_square;
use crate::render;

/// Paths restart when nothing has changed for so long.
const REST: Duration = Duration::from_millis(250);

/// Rows that one dispatch traces, which limits how long a frame waits.
const BAND_ROWS: u32 = 8;

/// Share of a frame for paths.
const BUDGET_MS: f64 = 12.0;

/// Batches after which the reference is complete: 4096 paths.
const MOST_BATCHES: u32 = 64;

/// Paths per texel of the complete reference.
pub(super) const MOST_PATHS: u32 = MOST_BATCHES * REFERENCE_BATCH;

/// The two pictures beside the main one.
pub struct Compare {
    off: Option<Frame>,
    is_off_stale: bool,
    /// Whether light or settings have also changed since `off` was drawn.
    has_new_light: bool,
    path_traced: Option<PathTraced>,
    is_reference_stale: bool,
    /// When the scene changed last.
    changed: Instant,
    /// The measured error, once requested.
    pub error: Option<String>,
}

/// The path-traced reference, refined in every frame.
struct PathTraced {
    frame: Frame,
    /// The first tracing pass, and the next.
    first_band: usize,
    next: usize,
    /// Bands of a frame.
    bands: usize,
    /// Complete batches.
    batches: u32,
}

impl Compare {
    pub fn new() -> Self {
        Self {
            off: None,
            is_off_stale: true,
            has_new_light: true,
            path_traced: None,
            is_reference_stale: true,
            changed: Instant::now(),
            error: None,
        }
    }

    /// Call it after a change of the field, or also of light, settings or the eye of specular (`has_new_light`).
    pub fn scene_changed(&mut self, has_new_light: bool) {
        (self.is_off_stale, self.is_reference_stale) = (true, true);
        self.has_new_light |= has_new_light;
        self.changed = Instant::now();
        self.error = None;
    }

    /// Makes the frames to show.
    pub fn prepare(&mut self, screen: &mut Screen, state: &State, limits: &Limits) -> Result<()> {
        if self.is_off_stale {
            let is_other = replan(screen, &mut self.off, state.plan_off(limits)?, &state.scene)?;
            self.has_new_light |= is_other;
        }
        if self.is_reference_stale && !state.is_moving() && self.changed.elapsed() > REST {
            if let Some(old) = self.path_traced.take() {
                screen.end(old.frame)?;
            }
            let (scene, bounces) = (&state.scene, state.quality.bounces.count);
            let (normals, eye_m) = (Normals::Smooth, state.eye_m());
            let plan =
                plan::reference_in_bands(scene, bounces, normals, eye_m, 0, limits, BAND_ROWS)?;
            let is_band = |pass: &plan::Pass| pass.name() == "path_trace";
            let first_band = plan.passes.iter().position(is_band).unwrap_or(0);
            let frame = screen.frame(plan, &plan::reference_inputs(scene))?;
            self.path_traced =
                Some(PathTraced { frame, first_band, next: 0, bands: 1, batches: 0 });
            self.is_reference_stale = false;
        }
        Ok(())
    }

    /// The frames, without shadows and the reference, and the passes that they run next.
    pub fn frames(&mut self) -> [Option<(&mut Frame, Vec<usize>)>; 2] {
        let (is_off_stale, has_new_light) = (self.is_off_stale, self.has_new_light);
        let off = self.off.as_mut().map(|frame| {
            let passes = match is_off_stale {
                false => Vec::new(),
                true if has_new_light => (0..frame.plan().passes.len()).collect(),
                true => after_new_heights(frame),
            };
            (frame, passes)
        });
        let path_traced = self.path_traced.as_mut().map(|path_traced| {
            let passes = (path_traced.next..path_traced.end()).collect();
            (&mut path_traced.frame, passes)
        });
        [off, path_traced]
    }

    /// [`frames`](Self::frames) has been recorded; takes times of earlier path passes.
    pub fn drawn(&mut self, times: &[Timing]) {
        (self.is_off_stale, self.has_new_light) = (false, false);
        let Some(path_traced) = &mut self.path_traced else { return };
        let end = path_traced.end();
        if end == path_traced.frame.plan().passes.len() {
            path_traced.batches += u32::from(path_traced.next < end);
            path_traced.next = path_traced.first_band;
        } else {
            path_traced.next = end;
        }
        let traced = || times.iter().filter(|t| t.label.starts_with("path_trace"));
        let ms = traced().map(|t| t.ns).sum::<f64>() / 1e6 / traced().count().max(1) as f64;
        if ms > 0.0 {
            path_traced.bands = (BUDGET_MS / ms).clamp(1.0, 1e4) as usize;
        }
    }

    /// Whether paths are still to be traced.
    pub fn is_busy(&self, state: &State) -> bool {
        let has_all = self.path_traced.as_ref().is_some_and(|t| t.batches >= MOST_BATCHES);
        !state.is_moving() && (self.is_reference_stale || !has_all)
    }

    /// Paths per texel of the current scene.
    pub fn paths(&self) -> u32 {
        let fresh = self.path_traced.as_ref().filter(|_| !self.is_reference_stale);
        fresh.map_or(0, |path_traced| path_traced.batches * REFERENCE_BATCH)
    }

    /// Labels below the three pictures.
    pub fn labels(&self) -> [String; 3] {
        let reference = match self.paths() {
            _ if self.is_reference_stale => "reference: waits".to_owned(),
            paths => format!("reference: {paths} paths"),
        };
        ["no shadows".to_owned(), "ours".to_owned(), reference]
    }

    /// Measures the error against the reference so far.
    pub fn find_error(&mut self, screen: &mut Screen, lit: &Frame, state: &State) -> Result<()> {
        let Some(path_traced) =
            self.path_traced.as_ref().filter(|t| !self.is_reference_stale && t.batches >= 2)
        else {
            let found = format!("{} paths", self.paths());
            let expected = format!("{} or more: wait a moment", 2 * REFERENCE_BATCH);
            return Err(Error::setting("reference", found, expected));
        };
        screen.wait()?;
        let gpu = screen.gpu();
        let ours = render::rgb(&gpu.pixels(lit, 0)?);
        let [light, spread] = [0, 1].map(|output| gpu.pixels(&path_traced.frame, output));
        let [light, spread] = [render::rgb(&light?), render::rgb(&spread?)];
        let is_void = |i: &usize| state.scene.field.voids().is_some_and(|v| v[*i]);
        let estimates: Vec<[[f64; 3]; 3]> = (0..ours.len())
            .filter(|i| !is_void(i))
            .map(|i| [0, 1, 2].map(|c| [ours[i][c], light[i][c], spread[i][c]].map(f64::from)))
            .collect();
        let unsampled =
            plan::unsampled_light_error(&state.scene, state.quality.bounces.count, self.paths());
        let found = distance(&estimates, f64::from(path_traced.batches), unsampled);
        let [rmse, error] = found.map(|share| 100.0 * share);
        self.error = Some(format!("RMSE {rmse:.3} % +- {error:.3} % against the reference"));
        Ok(())
    }

    pub fn end(self, screen: &mut Screen) -> Result<()> {
        let frames = self.off.into_iter().chain(self.path_traced.map(|t| t.frame));
        frames.map(|frame| screen.end(frame)).fold(Ok(()), Result::and)
    }
}

impl PathTraced {
    /// After the last pass of this frame.
    fn end(&self) -> usize {
        let all = self.frame.plan().passes.len();
        match self.next {
            next if self.batches >= MOST_BATCHES => next,
            next if next < self.first_band => (self.first_band + 1).min(all),
            next => (next + self.bands).min(all),
        }
    }
}

/// Root of the mean squared difference over the mean of the reference, and its standard error.
/// Takes the channels of texels: each a light, its reference and the standard error of that, which
/// is from so many batches.
///
/// With d = light - reference + noise of deviation s, d² - s² has the mean (light - reference)² and
/// the variance 4 (light - reference)² s² + 2 s⁴, and 2 s⁴ / (B - 1) more because s² itself is
/// estimated from B batches. Channels of a texel share paths and are correlated: their sums stand
/// for d² and s². Noise of different texels is independent. With k = 1 / (B - 1), the estimated s²
/// squares to s⁴ (1 + 2 k), and d² - s² times it has the mean (light - reference)² s² - 2 k s⁴
/// (normal noise). The root's error is that of its square over twice it, or the square's own root
/// where that is less than its error. Unsampled light, R, G, B, can change the root by its own root
/// mean square.
fn distance(estimates: &[[[f64; 3]; 3]], batches: f64, unsampled: [f64; 3]) -> [f64; 2] {
    let count = 3.0 * estimates.len().max(1) as f64;
    let (mut square, mut mean, mut crossed, mut fourth) = (0.0, 0.0, 0.0, 0.0);
    let own = 1.0 / (batches - 1.0);
    for channels in estimates {
        let difference: f64 = channels.iter().map(|[l, r, _]| (l - r).powi(2)).sum();
        let noise: f64 = channels.iter().map(|[.., s]| s * s).sum();
        let noise_squared = noise * noise / (1.0 + 2.0 * own);
        square += (difference - noise) / count;
        crossed += 4.0 * ((difference - noise) * noise + 2.0 * own * noise_squared);
        fourth += 2.0 * (1.0 + own) * noise_squared;
        mean += channels.iter().map(|[_, r, _]| r / count).sum::<f64>();
    }
    let error = (crossed.max(0.0) + fourth).sqrt() / count;
    let root = square.max(0.0).sqrt();
    let error = if square > error { error / (2.0 * root) } else { error.sqrt() };
    let error = error.hypot(root_mean_square(unsampled));
    match mean > 0.0 {
        true => [root / mean, error / mean],
        false => [if root > 0.0 { f64::INFINITY } else { 0.0 }, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::basis::random::{STEP, mixed, unit};

    /// Of variance 1: a sum of twelve uniform numbers.
    fn noises() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            let mut even = || {
                state = state.wrapping_add(STEP);
                unit(mixed(state)) - 0.5
            };
            (0..12).map(|_| even()).sum()
        }
    }

    /// Without noise it is the RMSE, and its error is unsampled light alone. With noise of ± 0.5,
    /// whose square is subtracted, an error of 0.2 is found to within four of its standard errors,
    /// which is then 0.5² · √(2 + 4 · 0.04 / 0.25) / √n / (2 · 0.2).
    #[test]
    fn noise_of_the_reference_is_subtracted() {
        let exact = [[[1.5, 1.0, 0.0]; 3], [[2.5, 3.0, 0.0]; 3]];
        let [rmse, error] = distance(&exact, 2.0, [0.0; 3]);
        assert!((rmse - 0.25).abs() < 1e-12 && error == 0.0);
        let [rmse, error] = distance(&exact, 2.0, [0.3, 0.0, 0.0]);
        assert!((rmse - 0.25).abs() < 1e-12, "{rmse}");
        // √(0.3² / 3) over a mean of 2.
        assert!((error - 0.3 / 3.0_f64.sqrt() / 2.0).abs() < 1e-12, "{error}");
        let mut noise = noises();
        let estimates: Vec<[[f64; 3]; 3]> =
            (0..40_000).map(|_| [[1.2, 1.0 + 0.5 * noise(), 0.5]; 3]).collect();
        let [rmse, error] = distance(&estimates, f64::INFINITY, [0.0; 3]);
        let known = 0.25 * (2.0 + 4.0 * 0.04 / 0.25_f64).sqrt() / 200.0 / 0.4;
        assert!((error / known - 1.0).abs() < 0.1, "{error}, {known}");
        assert!((rmse - 0.2).abs() < 4.0 * error, "{rmse} +- {error}");
        // Without the deviation, the noise counts.
        let silent: Vec<_> = estimates.iter().map(|s| s.map(|[l, r, _]| [l, r, 0.0])).collect();
        assert!(distance(&silent, f64::INFINITY, [0.0; 3])[0] > 0.5);
    }

    /// Grey light of two batches, each of deviation √½, so that their mean has s = ½, estimated by
    /// half their difference. The square 0.2² of a whole picture then has a standard error of √((4
    /// · 0.04 s² + 2 s⁴ + 2 s⁴ / 1) / n), and so does that of many pictures: to 15 %, three times 1
    /// / √(2 · 400) = 3.5 % and the skew of s⁴. Independent channels and a known s² would give
    /// √(0.165 / 3 / 0.29) = 0.44 of it.
    #[test]
    fn correlated_channels_widen_the_standard_error() {
        let mut noise = noises();
        let count = 400;
        let known = ((4.0 * 0.04 * 0.25 + 4.0 * 0.0625) / f64::from(count)).sqrt();
        let (mut squares, mut stated) = (Vec::new(), 0.0);
        for _ in 0..400 {
            let mut estimate = || {
                let [a, b] = [0; 2].map(|_| 1.0 + 0.5_f64.sqrt() * noise());
                [[1.2, 0.5 * (a + b), 0.5 * (a - b).abs()]; 3]
            };
            let estimates: Vec<_> = (0..count).map(|_| estimate()).collect();
            let [root, error] = distance(&estimates, 2.0, [0.0; 3]);
            let mean = estimates.iter().map(|s| s[0][1]).sum::<f64>() / f64::from(count);
            let [root, error] = [root * mean, error * mean];
            let of_square = if root * root > known { error * 2.0 * root } else { error * error };
            stated += of_square.powi(2) / 400.0;
            let raw = estimates.iter().map(|s| (1.2 - s[0][1]).powi(2) - s[0][2].powi(2));
            squares.push(raw.sum::<f64>() / f64::from(count));
        }
        let spread = (squares.iter().map(|s| (s - 0.04).powi(2)).sum::<f64>() / 400.0).sqrt();
        assert!((spread / known - 1.0).abs() < 0.15, "{spread}, {known}");
        assert!((stated.sqrt() / known - 1.0).abs() < 0.15, "{}, {known}", stated.sqrt());
    }
}
