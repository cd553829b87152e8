//! Draws, judges, draws again: the whole of a choice, for a caller who can draw.

use super::chooser::{Chooser, Goal, Trial};
use super::model::{Expected, PARTS, Part};
use super::probes::{Measured, Probes, apart};
use super::statistics::Statistics;
use crate::scene::{
    Basis, Fuse, Hull, Levels, Lines, Method, Precision, Quality, Receiver, Scene, Wedges, Window,
};
use crate::{Error, Result};

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
    /// Of the bound; none where the first frames did not fit the device, so that probes are spread evenly
    /// and may miss shadows' edges.
    pub confidence: Option<f64>,
    /// All that was drawn, in order, the chosen among it.
    pub trials: Vec<Trial>,
}

/// Settings that are drawn first: where their pictures differ most probes are taken. The second are the
/// defaults.
const COARSE: Quality = Quality {
    method: Method::Sweep,
    azimuths: 8,
    sun_azimuths: 2,
    lines: Lines::FourCells,
    fuse: Fuse::AimedNearest,
    precision: Precision::F32,
    hull: Hull::Auto,
    table_elevations: 64,
    // Of pyramids alone.
    level_step: 4,
    level_offset: 2,
    levels: Levels::Stack,
    basis: Basis::Auto,
    sh_order: 4,
    wedges: Wedges::Slices,
    receiver: Receiver::Plane,
    window: Window::None,
    subsample: 1,
    wedge_side: 64,
};

/// Where bounds alone stand in the way probes are doubled up to so many, or twice.
const MOST_PROBES: usize = 2000;

/// Probes and all pictures that were drawn: at most 16, of 4 bytes a sample and channel each.
struct Judge {
    probes: Probes,
    pictures: Vec<Vec<Vec<f32>>>,
}

impl Judge {
    /// Judges a frame, and where it is the best control all others once more.
    fn take(&mut self, chooser: &mut Chooser, quality: &Quality, Drawn { planes, passes }: Drawn) {
        self.pictures.push(planes);
        let all = self.all();
        if let Some(last) = all.last() {
            chooser.measured(quality, *last, &passes);
        }
        chooser.judged_anew(&all);
    }

    /// Errors of all pictures, held against that of the least by the probes alone.
    fn all(&self) -> Vec<Measured> {
        let own: Vec<f64> =
            self.pictures.iter().map(|p| self.probes.error(p, None).error).collect();
        let control = (0..own.len()).min_by(|a, b| own[*a].total_cmp(&own[*b]));
        let control = control.map(|i| self.pictures[i].as_slice());
        self.pictures.iter().map(|p| self.probes.error(p, control)).collect()
    }
}

/// Chooses settings for a goal: `draw` draws the scene with what it is told, so many samples of exact
/// light judge, others for another `seed`.
///
/// # Errors
/// A goal out of range; one that nothing reaches, with the nearest that was; what `draw` answers, but for
/// [`Error::Limit`], which leaves out the settings and all that are dearer.
pub fn choose(
    scene: &Scene,
    goal: Goal,
    (probes, seed): (usize, u64),
    mut draw: impl FnMut(&Quality) -> Result<Drawn>,
) -> Result<Chosen> {
    let (name, bound) = match goal {
        Goal::MaxError(most) => ("--max-error", most),
        Goal::MaxCost(ns) => ("--time-budget", ns / 1e6),
    };
    if !(bound > 0.0 && bound.is_finite()) {
        return Err(Error::setting(name, bound.to_string(), "a number above 0"));
    }
    let mut chooser = Chooser::new(scene, &Statistics::of(scene), goal);
    let mut pilots = Vec::new();
    for quality in [Quality { method: Method::Sweep, ..Quality::default() }, COARSE] {
        match draw(&quality) {
            Err(Error::Limit { .. }) => chooser.refuse(&quality),
            drawn => pilots.push((quality, drawn?)),
        }
    }
    let unsure = match pilots.as_slice() {
        [(_, a), (_, b)] => apart(&a.planes, &b.planes, scene.field.cols()),
        _ => Vec::new(),
    };
    let mut judge = Judge { probes: Probes::of(scene, probes, seed, &unsure)?, pictures: vec![] };
    for (quality, drawn) in pilots {
        judge.take(&mut chooser, &quality, drawn);
    }
    loop {
        while let Some(quality) = chooser.next() {
            match draw(&quality) {
                Err(Error::Limit { .. }) => chooser.refuse(&quality),
                drawn => judge.take(&mut chooser, &quality, drawn?),
            }
        }
        let count = judge.probes.len();
        if !chooser.is_undecided() || count >= MOST_PROBES {
            break;
        }
        judge.probes = Probes::of(scene, 2 * count, seed, &unsure)?;
        if judge.probes.len() == count {
            break;
        }
        chooser.judged_anew(&judge.all());
    }
    let probes = judge.probes;
    let is_sure = !unsure.is_empty() || probes.is_whole();
    let confidence = is_sure.then_some(Probes::CONFIDENCE);
    let Some(trial) = chooser.best() else {
        return Err(out_of_reach(goal, &chooser, probes.len(), scene));
    };
    Ok(Chosen {
        trial: *trial,
        expected: chooser.expected(&trial.quality),
        probes: probes.len(),
        confidence,
        trials: chooser.trials().to_vec(),
    })
}

fn out_of_reach(goal: Goal, chooser: &Chooser, probes: usize, scene: &Scene) -> Error {
    let trials = chooser.trials();
    let miss = |t: &Trial| match goal {
        Goal::MaxError(_) => t.measured.at_most,
        Goal::MaxCost(_) => t.ns,
    };
    let Some(nearest) = trials.iter().min_by(|a, b| miss(a).total_cmp(&miss(b))) else {
        return Error::Limit {
            what: "choosing settings".into(),
            needs: "settings that fit the device".into(),
            limit: "its memory".into(),
        };
    };
    let flags = flags(&nearest.quality, scene);
    match goal {
        Goal::MaxError(most) => Error::Limit {
            what: format!("--max-error {most}"),
            needs: chooser.lacks(),
            limit: format!(
                "{}, the nearest found ({flags}; measured {}, by {probes} probes)",
                figures(nearest.measured.at_most),
                figures(nearest.measured.error)
            ),
        },
        Goal::MaxCost(ns) => Error::Limit {
            what: format!("--time-budget {}", ns / 1e6),
            needs: format!("{} ms a frame ({flags})", figures(nearest.ns / 1e6)),
            limit: format!("{} ms", ns / 1e6),
        },
    }
}

/// Three figures, without an exponent.
fn figures(x: f64) -> String {
    let decimals = if x > 0.0 { 2.0 - x.log10().floor() } else { 0.0 };
    format!("{x:.*}", decimals.clamp(0.0, 12.0) as usize)
}

/// Settings that are chosen, as the command line spells them: those that a scene has.
pub fn flags(quality: &Quality, scene: &Scene) -> String {
    let mut all = match (quality.method, quality.lines) {
        (Method::Brute, _) => "--method brute".to_owned(),
        (_, Lines::Exact) => "--lines exact".to_owned(),
        (_, lines) => format!("--lines {} --fuse {}", lines.name(), quality.fuse.name()),
    };
    for part in PARTS.into_iter().filter(|p| p.is_in(scene)) {
        match part {
            Part::Geometry => {}
            Part::Azimuths => all += &format!(" --azimuths {}", quality.azimuths),
            Part::Table => all += &format!(" --table-elevations {}", quality.table_elevations),
            Part::Strips => all += &format!(" --sun-azimuths {}", quality.sun_azimuths),
        }
    }
    all
}
