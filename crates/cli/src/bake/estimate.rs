//! How long a bake will take, from a small part of its work on a piece of the field.

use std::cell::OnceCell;

use indicatif::ProgressBar;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Quality, Scatter};
use ridgelight::{Error, Result};
use ridgelight_bake::Angles;
use serde_json::{Value, json};

use super::job::Job;
use super::stages::{Stage, Stages, total};
use super::{compute, finish, open, request};
use crate::args::BakeArgs;
use crate::bench::verify::{self, PIECE};
use crate::setup::{self, terminal::digits};

/// A trial has one in so many directions, paths, and pairs of light and view.
const PART: usize = 16;
/// A trial has one in so many azimuths. With fewer, the start of a frame would take more time than they do.
const AZIMUTHS_PART: u32 = 4;
/// A trial should take so many seconds: in a few milliseconds the start of each pass counts too much.
const TRIAL_SECONDS: f64 = 0.5;
/// A longer estimate gets one more trial, on a smaller piece.
const LONG_SECONDS: f64 = 10.0;
/// The largest piece of a trial.
const PIECE_AT_MOST: usize = 512;

/// The expected time of a bake.
pub struct Estimate {
    /// The bake's stages with estimated seconds.
    stages: Vec<Stage>,
    /// The same stages of the trial, as measured.
    trial: Vec<Stage>,
    /// Seconds that the bake spends once, for example on pipelines, whatever its work.
    once: f64,
    /// Seconds of all trials.
    took: f64,
    /// Upper bound of the bytes on disk.
    bytes: u64,
}

impl Estimate {
    /// Runs a part of the bake on a piece of the field, twice: only the first run makes pipelines. Then twice on a larger piece where
    /// these runs were short: its sweeps can have another form and other pipelines. Times are scaled by the
    /// work. If the estimate is long, a smaller piece shows the part that does not grow with the work.
    ///
    /// # Errors
    /// Those of the bake. Some may apply to the piece alone.
    pub fn of(gpu: &mut Headless, args: &BakeArgs, job: &Job) -> Result<Self> {
        let cold = total(&trial(gpu, args, job, PIECE)?);
        let mut trials = trial(gpu, args, job, PIECE)?;
        let warm = total(&trials);
        let (mut took, mut once) = (cold + warm, cold - warm);
        let side = (PIECE as f64 * (TRIAL_SECONDS / warm).sqrt()) as usize;
        let longest = job.scene.field.rows().max(job.scene.field.cols());
        if side > 2 * PIECE && longest > 2 * PIECE {
            let first = total(&trial(gpu, args, job, side.min(PIECE_AT_MOST))?);
            trials = trial(gpu, args, job, side.min(PIECE_AT_MOST))?;
            took += first + total(&trials);
            once = once.max(first - total(&trials));
        }
        let mut stages = job.stages()?;
        for (stage, measured) in stages.iter_mut().zip(&trials) {
            stage.seconds = scaled(stage.work, measured, None);
        }
        // Some drivers compile the shaders of each frame again. That time does not depend on the size of the field.
        if total(&stages) > LONG_SECONDS && longest > PIECE / 2 {
            took += total(&trial(gpu, args, job, PIECE / 2)?);
            let smaller = trial(gpu, args, job, PIECE / 2)?;
            took += total(&smaller);
            for ((stage, measured), less) in stages.iter_mut().zip(&trials).zip(&smaller) {
                stage.seconds = scaled(stage.work, measured, Some(less));
            }
        }
        let bytes = job.files().iter().map(|(_, bytes)| bytes).sum();
        Ok(Self { stages, trial: trials, once: once.max(0.0), took, bytes })
    }

    fn seconds(&self) -> f64 {
        self.once + total(&self.stages)
    }

    /// For the terminal.
    pub fn text(&self) -> String {
        let megabytes = self.bytes as f64 / 1e6;
        let [seconds, megabytes] = [self.seconds(), megabytes].map(digits);
        format!("estimate: about {seconds} s, at most {megabytes} MB on disk")
    }

    /// For --json, with the seconds that each stage then took.
    pub fn json(&self, ran: &[Stage]) -> Value {
        let stages = self.stages.iter().zip(&self.trial).zip(ran);
        let stages = stages.map(|((stage, trial), ran)| {
            json!({
                "stage": stage.name, "unit": stage.unit, "work": stage.work, "estimated_s": stage.seconds,
                "seconds": ran.seconds, "trial": { "work": trial.work, "seconds": trial.seconds },
            })
        });
        json!({
            "seconds": self.seconds(), "seconds_once": self.once, "bytes_at_most": self.bytes,
            "trial_seconds": self.took, "stages": stages.collect::<Vec<_>>(),
        })
    }
}

/// Seconds of a stage, scaled by the work of a trial. With `less`, a trial of less work, the fixed part is not scaled.
fn scaled(work: f64, trial: &Stage, less: Option<&Stage>) -> f64 {
    // A trial of less work that took longer shows noise alone.
    let less = less.filter(|less| less.work < trial.work && less.seconds < trial.seconds);
    let fixed = less.map_or(0.0, |less| {
        let rate = (trial.seconds - less.seconds) / (trial.work - less.work);
        (trial.seconds - rate * trial.work).max(0.0)
    });
    if trial.work > 0.0 { fixed + (trial.seconds - fixed) / trial.work * work } else { 0.0 }
}

/// What a trial found, or a note why there is no estimate: some errors apply to the piece of the field alone.
///
/// # Errors
/// Those of the device, on which the bake would fail, too.
pub fn unless_lost<T>(found: Result<T>) -> Result<std::result::Result<T, String>> {
    match found {
        Ok(found) => Ok(Ok(found)),
        Err(error @ Error::Device { .. }) => Err(error),
        Err(error) => Ok(Err(format!("no estimate: {}", setup::in_flags(error)))),
    }
}

/// One run of a part of the bake on a piece of the field up to `side` wide. Its files never get their names.
fn trial(gpu: &mut Headless, args: &BakeArgs, job: &Job, side: usize) -> Result<Vec<Stage>> {
    let piece = verify::middle(job.scene, side)?;
    let part = |count: u32, part: u32, least: u32| count.div_ceil(part).max(least).min(count);
    let azimuths = part(job.quality.azimuths, AZIMUTHS_PART, 4);
    let quality = Quality { azimuths, ..*job.quality };
    let azimuths = part(job.specular_quality.azimuths, AZIMUTHS_PART, 4);
    let specular_quality = Quality { azimuths, ..job.specular_quality };
    // An odd number of directions would have a horizontal one. Curved ellipses take the same time with fewer.
    let directions = match job.curvature {
        None => part(job.around.count() as u32, PART as u32, 4).next_multiple_of(2),
        Some(_) => job.around.count() as u32,
    };
    let around = request::directions(args, directions)?;
    let scatter = job.scatter.map(|s| Scatter { paths: part(s.paths, PART as u32, 8), ..s });
    let mut small = Job {
        scene: &piece,
        quality: &quality,
        specular_quality,
        scatter,
        around: &around,
        angles: fewer(job),
        pairs: job.pairs.div_ceil(PART),
        table: OnceCell::new(),
        maps: Vec::new(),
        ..*job
    };
    small.lay_out(request::wanted(args)?)?;
    let stages = Stages::new(ProgressBar::hidden(), small.stages()?);
    let maps = std::mem::take(&mut small.maps);
    let mut all = open(args, &small, maps, None)?;
    let (_, _, normals) = compute(gpu, &small, &mut all, &stages)?;
    finish(all, &normals, &[], &stages)?;
    // The bake's own passes are counted from here.
    gpu.take_timings();
    Ok(stages.finish())
}

/// About one in [`PART`] of the angles, and as many as the kinds need.
fn fewer(job: &Job) -> Angles {
    let wanted = (job.angles.count() / PART).max(job.least_angles());
    let few = Angles { zeniths: 2, azimuths: wanted.div_ceil(2).max(4) };
    if few.count() < job.angles.count() { few } else { job.angles }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 s of compilation and 0.5 s per unit of work: work 60 takes 32 s; plain scaling gives 50 s.
    #[test]
    fn what_does_not_grow_with_the_work_is_counted_once() {
        let of = |work, seconds| Stage { seconds, ..Stage::new("stage", work, "") };
        assert_eq!(scaled(60.0, &of(6.0, 5.0), None), 50.0);
        assert_eq!(scaled(60.0, &of(6.0, 5.0), Some(&of(2.0, 3.0))), 32.0);
        // Noise: the smaller one took longer, or has as much work.
        assert_eq!(scaled(60.0, &of(6.0, 5.0), Some(&of(2.0, 6.0))), 50.0);
        assert_eq!(scaled(1.0, &of(1.0, 5.0), Some(&of(1.0, 6.0))), 5.0);
        assert_eq!(scaled(60.0, &of(0.0, 5.0), None), 0.0);
    }

    #[test]
    fn a_failed_trial_gets_a_note_and_a_lost_device_ends_the_bake() {
        assert_eq!(unless_lost(Ok(7)).expect("no error"), Ok(7));
        let refused = Error::setting("cell_m", "0", "`lines exact`");
        let note = unless_lost::<()>(Err(refused)).expect("no error of the device");
        assert_eq!(note, Err("no estimate: --cell: found 0, expected --lines exact".to_owned()));
        let lost = Error::Device { doing: "a submission".into(), reason: "lost".into() };
        assert!(matches!(unless_lost::<()>(Err(lost)), Err(Error::Device { .. })));
    }
}
