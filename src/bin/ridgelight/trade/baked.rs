//! Bounces over what samples see of each other, found once: what a field that does not move may take instead of bounces that
//! are found in every frame.

use std::time::Instant;

use ridgelight::Result;
use ridgelight::gpu::{Frame, Timing};
use ridgelight::measure::statistics::Summary;
use ridgelight::plan;
use ridgelight::scene::{Bounces, Directions, Quality, Scatter, Scene, VisiblePoints};
use serde_json::{Value, json};

use super::point::Point;
use super::report::{Report, ms};
use super::rig::Rig;
use super::truth::{Distance, Truth};
use crate::setup;
use crate::terminal::{digits, percent};

const DIRECTIONS: [usize; 3] = [64, 256, 1024];
const PATHS: [u32; 3] = [40, 100, 400];
/// Draws of each, beside the baseline's, after one that warms up.
const DRAWS: usize = 5;
/// Share of the budget that all of them may take; what would take more is left out.
const SHARE: f64 = 0.2;

/// Direct light by the baseline's settings, bounces over so many directions by so many paths.
pub struct Baked {
    pub directions: usize,
    pub paths: u32,
    /// Nanoseconds of finding what samples see, once.
    pub found_ns: f64,
    /// What that is kept in.
    pub bytes: u64,
    /// Median of a frame's time over that of the baseline drawn beside it.
    pub ratio: f64,
    pub distance: Distance,
}

/// From few directions and paths on, as many as the share of the budget holds; none without bounces, and none of lobes, whose
/// direct light is no colour a sample.
pub fn measure(rig: &mut Rig, truth: &Truth, start: &Quality) -> Result<Vec<Baked>> {
    let scene = rig.scene;
    if start.bounces.count == 0 || scene.surface.phong.is_some() {
        return Ok(Vec::new());
    }
    let bounces = Bounces { count: 0, ..start.bounces };
    let mut own = rig.frame(start)?;
    let mut all = Vec::new();
    let measured = rig.frame(&Quality { bounces, ..*start }).and_then(|mut direct| {
        let measured = fill(rig, truth, start.bounces, [&mut own, &mut direct], &mut all);
        rig.gpu.end(direct);
        measured
    });
    rig.gpu.end(own);
    measured.map(|()| all)
}

fn fill(
    rig: &mut Rig,
    truth: &Truth,
    bounces: Bounces,
    [own, direct]: [&mut Frame; 2],
    all: &mut Vec<Baked>,
) -> Result<()> {
    let scene = rig.scene;
    let (begun, most_s) = (Instant::now(), SHARE * rig.budget.as_secs_f64());
    let fits = |more_s: f64| begun.elapsed().as_secs_f64() + more_s <= most_s;
    rig.gpu.draw(own)?;
    rig.gpu.draw(direct)?;
    let light = colours(rig, direct)?;
    let mut found_s = 0.0;
    for count in DIRECTIONS {
        // Time goes with the number of directions.
        if !fits(4.0 * found_s) {
            break;
        }
        let since = Instant::now();
        let directions = Directions::fibonacci(count, -1.0, 0)?;
        let Ok((points, found_ns)) = found(rig, scene, &directions) else { break };
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
            let Ok(plan) = plan::scatter(scene, &directions, &scatter, &rig.limits) else { break };
            let contents = plan::scatter_inputs(&plan, scene, &points, &light)?;
            let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
            let mut frame = rig.gpu.frame(plan, &contents)?;
            let drawn = timed(rig, &mut frame, [own, direct], &light);
            rig.gpu.end(frame);
            let (ratio, planes) = drawn?;
            all.push(Baked {
                directions: count,
                paths,
                found_ns,
                bytes: 4 * points.words().len() as u64,
                ratio,
                distance: truth.distance(&planes)?,
            });
            frame_s = since.elapsed().as_secs_f64();
        }
    }
    Ok(())
}

fn sum(times: &[Timing]) -> f64 {
    times.iter().map(|t| t.ns).sum()
}

/// The first output of a frame, filled voids and all.
fn colours(rig: &mut Rig, frame: &Frame) -> Result<Vec<[f32; 3]>> {
    let pixels = rig.gpu.pixels(frame, 0)?;
    let texel = |t: &[f32]| [0, 1, 2].map(|c: usize| t[c.min(t.len() - 1)]);
    Ok(pixels.values.chunks_exact(pixels.channels).map(texel).collect())
}

/// What samples see, and the device's nanoseconds of finding it.
fn found(rig: &mut Rig, scene: &Scene, directions: &Directions) -> Result<(VisiblePoints, f64)> {
    let (field, border) = (&scene.field, scene.surface.border);
    let plan = plan::visible_points(field, border, directions, &rig.limits)?;
    let outputs = plan.outputs().count();
    let mut frame = rig.gpu.frame(plan, &[field.heights_m()])?;
    let drawn = rig.gpu.draw(&mut frame).and_then(|times| {
        let mut words = Vec::new();
        for output in 0..outputs {
            words.extend(rig.gpu.pixels(&frame, output)?.values.iter().map(|v| v.to_bits()));
        }
        Ok((words, sum(&times)))
    });
    rig.gpu.end(frame);
    let (words, ns) = drawn?;
    Ok((VisiblePoints::new(field, border, directions.clone(), words)?, ns))
}

/// What a frame of both takes in the baseline's, and its radiance.
fn timed(
    rig: &mut Rig,
    frame: &mut Frame,
    [own, direct]: [&mut Frame; 2],
    light: &[[f32; 3]],
) -> Result<(f64, Vec<Vec<f32>>)> {
    rig.gpu.draw(frame)?;
    let scattered = colours(rig, frame)?;
    let mut ratios = Vec::new();
    for _ in 0..DRAWS {
        let beside = sum(&rig.gpu.draw(own)?);
        let both = sum(&rig.gpu.draw(direct)?) + sum(&rig.gpu.draw(frame)?);
        ratios.push(both / beside);
    }
    let plane = |c: usize| light.iter().zip(&scattered).map(|(a, b)| a[c] + b[c]).collect();
    let mut planes: Vec<Vec<f32>> = (0..3).map(plane).collect();
    planes.iter_mut().for_each(|plane| setup::mask_voids(&rig.scene.field, plane, 1));
    Ok((Summary::of(&ratios).map_or(1.0, |s| s.median), planes))
}

impl Report<'_> {
    /// What may be baked, beside what is recommended; nothing where nothing was.
    pub fn baked_text(&self, recommended: &Point) -> Vec<String> {
        if self.baked.is_empty() {
            return Vec::new();
        }
        // The truth's own error at least, as of all others.
        let off = |baked: &Baked| baked.distance.rmse.max(self.truth.floor());
        let row = |baked: &Baked| {
            format!(
                "{} directions, {} paths: {} a frame, {} off, found once in {}, {} MB",
                baked.directions,
                baked.paths,
                ms(baked.ratio * self.walk.baseline_ns()),
                percent(off(baked)),
                ms(baked.found_ns),
                digits(baked.bytes as f64 * 1e-6)
            )
        };
        let error = self.error(recommended);
        let as_near = self.baked.iter().filter(|b| off(b) <= error);
        let cheapest = as_near.min_by(|a, b| a.ratio.total_cmp(&b.ratio));
        let verdict = match cheapest {
            Some(b) => format!(
                "as near as what is recommended are {} directions with {} paths, in {} × its time",
                b.directions,
                b.paths,
                digits(b.ratio / recommended.ratio)
            ),
            None => {
                let nearest = self.baked.iter().map(off).fold(f64::INFINITY, f64::min);
                format!(
                    "none is as near as what is recommended; the nearest is {} off",
                    percent(nearest)
                )
            }
        };
        let about = format!(
            "Of a field that does not move, bounces may be scattered over visible points that are found once \
             (`plan::scatter`), beside direct light by the defaults: {verdict}."
        );
        std::iter::once(about).chain(self.baked.iter().map(row)).collect()
    }

    pub fn baked_json(&self) -> Vec<Value> {
        let of = |baked: &Baked| {
            json!({
                "directions": baked.directions, "paths": baked.paths, "found_once_ns": baked.found_ns, "bytes": baked.bytes,
                "time_ns": baked.ratio * self.walk.baseline_ns(),
                "relative_rmse": baked.distance.rmse.max(self.truth.floor()),
                "mean_shift": baked.distance.mean_shift,
            })
        };
        self.baked.iter().map(of).collect()
    }
}
