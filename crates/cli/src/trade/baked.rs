//! Bounces over visible points that are found once: the alternative for a static field to bounces
//! that are computed every frame.

use std::time::Instant;

use ridgelight::gpu::Frame;
use ridgelight::plan;
use ridgelight::scene::{Bounces, Directions, Quality, Scatter, VisiblePoints};
use ridgelight::{Error, Result};
use ridgelight_trade::error::ImageError;
use ridgelight_trade::statistics::median;
use serde::Serialize;
use serde_json::{Value, json};

use super::ground_truth::GroundTruth;
use super::point::Point;
use super::report::{Report, ms};
use super::rig::Rig;
use crate::render::rgb;
use crate::setup::terminal::{digits, percent};
use crate::setup::{self, total_ns};

const DIRECTIONS: [usize; 3] = [64, 256, 1024];
const PATHS: [u32; 3] = [40, 100, 400];
/// Timed draws of each, paired with the baseline's, after one to warm up.
const DRAWS: usize = 5;
/// Share of the budget for all of them; longer ones are left out.
const SHARE: f64 = 0.2;

/// Direct light by the baseline's settings, and bounces over so many directions by so many paths.
pub struct Baked {
    pub directions: usize,
    pub paths: u32,
    /// Seconds in total to find the visible points.
    pub found_s: f64,
    /// Memory of the visible points.
    pub bytes: u64,
    /// Median of a frame's time over that of the baseline drawn next to it.
    pub ratio: f64,
    pub distance: ImageError,
}

/// A variant that the device or the memory budget refused.
#[derive(Serialize)]
pub struct Refused {
    pub what: String,
    pub why: String,
}

/// Measured variants, in ascending order, and refused ones.
#[derive(Default)]
pub struct Tried {
    pub measured: Vec<Baked>,
    pub refused: Vec<Refused>,
}

impl Tried {
    /// The made value; none, with a note, where it was refused. Other errors end the command.
    fn made<T>(&mut self, what: String, of: Result<T>) -> Result<Option<T>> {
        match of {
            Ok(made) => Ok(Some(made)),
            Err(error) if is_refusal(&error) => {
                self.refused.push(Refused { what, why: setup::in_flags(error).to_string() });
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }
}

/// Whether the request was too large for a device that still works; false for a lost device or a
/// failed driver.
fn is_refusal(error: &Error) -> bool {
    use ash::vk::Result as Answer;
    match error {
        Error::Setting { .. } | Error::Limit { .. } => true,
        Error::Device { reason, .. } => {
            let full = [Answer::ERROR_OUT_OF_DEVICE_MEMORY, Answer::ERROR_OUT_OF_HOST_MEMORY];
            *reason == gpu_allocator::AllocationError::OutOfMemory.to_string()
                || full.iter().any(|answer| *reason == answer.to_string())
        }
        _ => false,
    }
}

/// Measures variants in ascending order while the share of the budget lasts. The first always runs,
/// because its time is unknown. There are none without bounces, and none with specular, whose
/// direct light depends on the view. A refusal is noted and ends the larger variants.
pub fn measure(rig: &mut Rig, ground_truth: &GroundTruth, start: &Quality) -> Result<Tried> {
    let mut tried = Tried::default();
    if start.bounces.count == 0 || rig.scene.surface.specular.is_some() {
        return Ok(tried);
    }
    let bounces = Bounces { count: 0, ..start.bounces };
    rig.with_frame(start, |rig, own| {
        let direct = rig.frame(&Quality { bounces, ..*start });
        if let Some(mut direct) = tried.made("direct light".to_owned(), direct)? {
            let frames = [own, &mut direct];
            let filled = fill(rig, ground_truth, start.bounces, frames, &mut tried);
            rig.gpu.end(direct);
            filled?;
        }
        Ok(())
    })?;
    Ok(tried)
}

fn fill(
    rig: &mut Rig,
    ground_truth: &GroundTruth,
    bounces: Bounces,
    [own, direct]: [&mut Frame; 2],
    tried: &mut Tried,
) -> Result<()> {
    let scene = rig.scene;
    let (begun, most_s) = (Instant::now(), rig.share(SHARE));
    let fits = |more_s: f64| begun.elapsed().as_secs_f64() + more_s <= most_s;
    rig.gpu.draw(own)?;
    rig.gpu.draw(direct)?;
    let light = rgb(&rig.gpu.pixels(direct, 0)?);
    let mut found_s = 0.0;
    for count in DIRECTIONS {
        // Time is proportional to the number of directions.
        if !fits(4.0 * found_s) {
            break;
        }
        let since = Instant::now();
        let directions = Directions::fibonacci(count, -1.0, 0)?;
        let land = (&scene.field, scene.surface.border);
        let points = rig.gpu.visible_points(land, &directions, &rig.limits);
        let Some(points) = tried.made(format!("{count} directions"), points)? else { break };
        found_s = since.elapsed().as_secs_f64();
        let mut frame_s = 0.0;
        for paths in PATHS {
            if !fits(4.0 * frame_s) {
                break;
            }
            let since = Instant::now();
            let scatter = Scatter {
                bounces: bounces.count,
                cutoff: bounces.cutoff,
                paths,
                ..Scatter::default()
            };
            let drawn = scattered(rig, &scatter, &points, [own, direct], &light);
            let what = format!("{count} directions, {paths} paths");
            let Some((ratio, planes)) = tried.made(what, drawn)? else { break };
            tried.measured.push(Baked {
                directions: count,
                paths,
                found_s,
                bytes: 4 * points.words().len() as u64,
                ratio,
                distance: ground_truth.distance(&planes)?,
            });
            frame_s = since.elapsed().as_secs_f64();
        }
    }
    Ok(())
}

/// Time of a frame of scattered light plus one of direct light, relative to the baseline's, and
/// their radiance.
fn scattered(
    rig: &mut Rig,
    scatter: &Scatter,
    points: &VisiblePoints,
    [own, direct]: [&mut Frame; 2],
    light: &[[f32; 3]],
) -> Result<(f64, Vec<Vec<f32>>)> {
    let plan = plan::scatter(rig.scene, points.directions(), scatter, &rig.limits)?;
    let contents = plan::scatter_inputs(&plan, rig.scene, points, light)?;
    let (ratios, scattered) = rig.gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let scattered = rgb(&gpu.pixels(frame, 0)?);
        let mut ratios = Vec::new();
        for _ in 0..DRAWS {
            let beside = total_ns(&gpu.draw(own)?);
            let both = total_ns(&gpu.draw(direct)?) + total_ns(&gpu.draw(frame)?);
            ratios.push(both / beside);
        }
        Ok((ratios, scattered))
    })?;
    let plane = |c: usize| light.iter().zip(&scattered).map(|(a, b)| a[c] + b[c]).collect();
    let mut planes: Vec<Vec<f32>> = (0..3).map(plane).collect();
    planes.iter_mut().for_each(|plane| setup::mask_voids(&rig.scene.field, plane, 1));
    Ok((median(&ratios).unwrap_or(1.0), planes))
}

impl Report<'_> {
    /// Sentences about the baked variants; none where none were tried.
    pub fn baked_text(&self, recommended: &Point) -> Vec<String> {
        let refused = self.baked.refused.iter().map(|r| format!("{}: refused: {}", r.what, r.why));
        if self.baked.measured.is_empty() {
            return refused.collect();
        }
        // Errors are at least the ground truth's own.
        let off = |baked: &Baked| baked.distance.relative_rmse.max(self.ground_truth.floor());
        let row = |baked: &Baked| {
            format!(
                "{} directions, {} paths: {} per frame, error {}; visible points take {} once, \
                    {} MB",
                baked.directions,
                baked.paths,
                ms(baked.ratio * self.walk.baseline_ns()),
                percent(off(baked)),
                ms(1e9 * baked.found_s),
                digits(baked.bytes as f64 * 1e-6)
            )
        };
        let error = self.error(recommended);
        let as_near = self.baked.measured.iter().filter(|b| off(b) <= error);
        let cheapest = as_near.min_by(|a, b| a.ratio.total_cmp(&b.ratio));
        let nearest = percent(self.baked.measured.iter().map(off).fold(f64::INFINITY, f64::min));
        let verdict = match cheapest {
            Some(Baked { directions, paths, ratio, .. }) => format!(
                "{directions} directions with {paths} paths are as accurate as the recommended \
                    settings, in {} × the time",
                digits(ratio / recommended.ratio())
            ),
            None => format!(
                "none is as accurate as the recommended settings; the best has an error of {nearest}"
            ),
        };
        let about = format!(
            "For a static field, visible points can be found once and bounces scattered over \
                them (`plan::scatter`), added to direct light by the defaults: {verdict}."
        );
        let rows = self.baked.measured.iter().map(row);
        std::iter::once(about).chain(rows).chain(refused).collect()
    }

    pub fn baked_json(&self) -> Vec<Value> {
        let of = |baked: &Baked| {
            json!({
                "directions": baked.directions, "paths": baked.paths, "found_once_ns": 1e9 * baked.found_s, "bytes": baked.bytes,
                "time_ns": baked.ratio * self.walk.baseline_ns(),
                "relative_rmse": baked.distance.relative_rmse.max(self.ground_truth.floor()),
                "mean_shift": baked.distance.relative_mean_shift,
            })
        };
        self.baked.measured.iter().map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use ash::vk::Result as Answer;

    use super::*;

    /// Too large a request is left out; a lost device, a failed driver and a missing file end the
    /// command.
    #[test]
    fn only_what_is_too_large_is_refused() {
        let device = |reason: String| Error::Device { doing: "making it".into(), reason };
        let [what, needs, limit] = ["it", "2 bytes", "1 byte"].map(String::from);
        for error in [
            device(Answer::ERROR_OUT_OF_DEVICE_MEMORY.to_string()),
            device(Answer::ERROR_OUT_OF_HOST_MEMORY.to_string()),
            device(gpu_allocator::AllocationError::OutOfMemory.to_string()),
            Error::Limit { what, needs, limit },
        ] {
            let mut tried = Tried::default();
            let made = tried.made::<()>("it".to_owned(), Err(error));
            assert!(matches!(made, Ok(None)) && tried.refused.len() == 1);
        }
        let source = std::io::ErrorKind::NotFound.into();
        for error in [
            device(Answer::ERROR_DEVICE_LOST.to_string()),
            device(Answer::ERROR_INITIALIZATION_FAILED.to_string()),
            Error::Io { path: "it".into(), source },
        ] {
            let mut tried = Tried::default();
            let made = tried.made::<()>("it".to_owned(), Err(error));
            assert!(made.is_err() && tried.refused.is_empty());
        }
    }
}
