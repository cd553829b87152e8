//! Draws, judges, draws again: the whole of a choice, for a caller who can draw.

use super::chooser::{Chooser, Goal, Trial};
use super::model::Expected;
use super::probes::Probes;
use super::statistics::Statistics;
use crate::scene::{Quality, Scene};
use crate::{Error, Result};
use std::time::Duration;

/// A frame that was drawn with some settings.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Radiance: one plane or three, row-major, NaN at voids.
    pub planes: Vec<Vec<f32>>,
    /// Nanoseconds by label of each pass: of a typical draw, not of one that compiles.
    pub passes: Vec<(String, f64)>,
}

/// Settings that reach a goal, and what is known of them.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// The settings, their error on the probes, their time.
    pub trial: Trial,
    /// The error that the scene's statistics alone had led to expect.
    pub expected: Expected,
    /// How many samples were held against the oracle.
    pub probes: usize,
    /// All that was drawn, in order, the chosen among it.
    pub trials: Vec<Trial>,
}

/// Chooses settings for a goal: `draw` draws the scene with what it is told; probing takes about `most`.
///
/// # Errors
/// A goal out of range; one that nothing reaches, with the nearest that was; what `draw` answers, but for
/// [`Error::Limit`], which leaves out the settings and all that are dearer.
pub fn choose(
    scene: &Scene,
    goal: Goal,
    (most, seed): (Duration, u64),
    mut draw: impl FnMut(&Quality) -> Result<Drawn>,
) -> Result<Chosen> {
    let (name, bound) = match goal {
        Goal::MaxError(most) => ("--max-error", most),
        Goal::MaxCost(ns) => ("--time-budget", ns / 1e6),
    };
    if !(bound > 0.0 && bound.is_finite()) {
        return Err(Error::setting(name, bound.to_string(), "a number above 0"));
    }
    let probes = Probes::of(scene, most, seed)?;
    let mut chooser = Chooser::new(scene, &Statistics::of(scene), goal);
    let mut control: Option<(f64, Vec<Vec<f32>>)> = None;
    while let Some(quality) = chooser.next() {
        let Drawn { planes, passes } = match draw(&quality) {
            Err(Error::Limit { .. }) => {
                chooser.refuse(&quality);
                continue;
            }
            drawn => drawn?,
        };
        let measured = probes.error(&planes, control.as_ref().map(|c| c.1.as_slice()));
        chooser.measured(&quality, measured, &passes);
        if control.as_ref().is_none_or(|c| measured.error < c.0) {
            control = Some((measured.error, planes));
        }
    }
    let Some(trial) = chooser.best() else {
        return Err(out_of_reach(goal, chooser.trials(), probes.len()));
    };
    Ok(Chosen {
        trial: *trial,
        expected: chooser.expected(&trial.quality),
        probes: probes.len(),
        trials: chooser.trials().to_vec(),
    })
}

fn out_of_reach(goal: Goal, trials: &[Trial], probes: usize) -> Error {
    let nearest = trials.iter().min_by(|a, b| {
        let miss = |t: &Trial| match goal {
            Goal::MaxError(_) => t.measured.at_most,
            Goal::MaxCost(_) => t.ns,
        };
        miss(a).total_cmp(&miss(b))
    });
    let Some(nearest) = nearest else {
        return Error::Limit {
            what: "choosing settings".into(),
            needs: "settings that fit the device".into(),
            limit: "its memory".into(),
        };
    };
    let flags = flags(&nearest.quality);
    match goal {
        Goal::MaxError(most) => Error::Limit {
            what: format!("--max-error {most}"),
            needs: "finer settings than are chosen among".into(),
            limit: format!(
                "a relative RMSE of at most {:.2e} on {probes} probes ({flags})",
                nearest.measured.at_most
            ),
        },
        Goal::MaxCost(ns) => Error::Limit {
            what: format!("--time-budget {}", ns / 1e6),
            needs: format!("{:.3} ms a frame ({flags})", nearest.ns / 1e6),
            limit: format!("{} ms", ns / 1e6),
        },
    }
}

/// Settings that are chosen, as the command line spells them.
pub fn flags(quality: &Quality) -> String {
    format!(
        "--lines {} --fuse {} --azimuths {} --table-elevations {} --sun-azimuths {}",
        quality.lines.name(),
        quality.fuse.name(),
        quality.azimuths,
        quality.table_elevations,
        quality.sun_azimuths
    )
}
