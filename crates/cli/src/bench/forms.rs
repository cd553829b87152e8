//! Times every method and setting of sweeps, in turn with a scalar sweep on the CPU.

use std::f64::consts::TAU;
use std::time::Instant;

use indicatif::ProgressBar;
use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan::{self, Limits, Pass, Picture, Plan};
use ridgelight::scene::{Fuse, Hull, Levels, Lines, Method, Precision, Quality, Scene};
use ridgelight::{Error, Result};
use ridgelight_cpu::scalar_sweep::ScalarSweep;

use super::progress::Progress;
use super::rows::{Row, figure, sums};
use super::verify::Verifier;
use super::{FEWEST, late, named, stable};

/// Azimuths that the scalar sweep runs between two runs of a form.
const SCALAR_AZIMUTHS: u32 = 8;
/// Slow forms run only some azimuths, starting at a given one; their time is scaled. In brute force
/// all azimuths take the same time.
const BRUTE_AZIMUTHS: u32 = 2;
/// The time of exact lines depends on their grid vectors, which repeat from octant to octant.
const EXACT_CIRCLE_SHARE: u32 = 8;

struct Form {
    /// The pass of the rows.
    name: String,
    quality: Quality,
    /// Whether shading is timed; otherwise the passes before it.
    shades: bool,
    slow: bool,
}

/// Names of the forms.
pub fn names(quality: &Quality) -> Vec<String> {
    forms(quality).into_iter().map(|form| form.name).collect()
}

/// Number of the forms that [`run`] times.
pub fn count(quality: &Quality, only: &[String]) -> usize {
    wanted(quality, only).len()
}

/// The forms with these names, or all.
fn wanted(quality: &Quality, only: &[String]) -> Vec<Form> {
    let is_wanted =
        |form: &Form| only.is_empty() || only.iter().any(|name| named(&form.name, name));
    forms(quality).into_iter().filter(is_wanted).collect()
}

fn forms(quality: &Quality) -> Vec<Form> {
    let base = Quality {
        method: Method::Sweep,
        lines: Lines::Cell,
        precision: Precision::F32,
        ..*quality
    };
    let mut all = Vec::new();
    let mut add = |name: String, quality: Quality, [shades, slow]: [bool; 2]| {
        all.push(Form { name, quality, shades, slow });
    };
    for hull in [Hull::Private, Hull::Shared, Hull::OccluderList] {
        for precision in [Precision::F32, Precision::Packed] {
            let name = format!("horizon_sweep {} {}", hull, precision);
            add(name, Quality { hull, precision, ..base }, [false; 2]);
        }
    }
    use Lines::{Cell, Exact, FourCells, HalfCell, QuarterCell, TwoCells};
    for lines in [QuarterCell, HalfCell, Cell, TwoCells, FourCells] {
        let name = format!("horizon_sweep lines {}", lines);
        add(name, Quality { lines, ..base }, [false; 2]);
    }
    use Fuse::{Aimed, AimedAround, AimedNearest, Nearest, Own, Slopes};
    for fuse in [Nearest, Slopes, Own, AimedNearest, Aimed, AimedAround] {
        add(format!("sky_shade {}", fuse), Quality { fuse, ..base }, [true, false]);
    }
    add("surface_sweep exact".into(), Quality { lines: Exact, ..base }, [false, true]);
    for levels in [Levels::Stack, Levels::Pyramid] {
        let name = format!("pyramid_march {}", levels);
        add(name, Quality { method: Method::Pyramid, levels, ..base }, [false; 2]);
    }
    let brute = Quality { method: Method::BruteForce, ..base };
    add("horizon_march brute".into(), brute, [false, true]);
    all
}

/// Times all forms. Returns the rows of each and of the scalar sweep paired with it, and a warning for each form left out. Forms
/// with the same dispatches are timed once.
pub fn run(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
    limits: &Limits,
    verifier: &Verifier,
    (most, only): (usize, &[String]),
    bar: &ProgressBar,
) -> Result<(Vec<[Row; 2]>, Vec<String>)> {
    let (mut all, mut left_out): (Vec<[Row; 2]>, _) = (Vec::new(), Vec::new());
    let mut scalar = ScalarSweep::new(&scene.field);
    let forms = wanted(quality, only);
    // Of the rows in `all`.
    let mut works: Vec<Work> = Vec::new();
    let mut progress = Progress::new(bar, forms.iter().map(|form| form.name.clone()), most, 0);
    for form in &forms {
        progress.begin_next();
        let work = match Work::of(scene, form, limits) {
            Err(error @ Error::Limit { .. }) => {
                left_out.push(format!("{} left out: {error}", form.name));
                continue;
            }
            planned => planned?,
        };
        if let Some(i) = works.iter().position(|earlier| earlier.is_same(&work)) {
            let rows = again(&all[i], &form.name);
            all.push(rows);
            works.push(work);
            continue;
        }
        progress.show("verifying");
        verifier.check(gpu, &form.quality, limits)?;
        let contents = plan::picture_inputs(scene);
        let inputs = if form.slow { &contents[..1] } else { &contents[..] };
        let count = if form.slow { most.min(FEWEST) } else { most };
        all.push(gpu.with_frame(work.plan.clone(), inputs, |gpu, frame| {
            let timed = (&work.timed[..], work.azimuths, count);
            in_turn(gpu, frame, &mut scalar, timed, form, &progress)
        })?);
        works.push(work);
    }
    Ok((all, left_out))
}

/// The dispatches that a form times.
struct Work {
    plan: Plan,
    /// Positions of the timed passes.
    timed: Vec<usize>,
    azimuths: u32,
}

impl Work {
    fn of(scene: &Scene, form: &Form, limits: &Limits) -> Result<Self> {
        let all_azimuths = form.quality.azimuths;
        let whole = plan::picture(scene, &form.quality, limits, Picture::default())?;
        let (plan, azimuths) = if form.slow {
            let some = match form.quality.method {
                Method::BruteForce => (all_azimuths / 16, BRUTE_AZIMUTHS),
                _ => (0, all_azimuths.div_ceil(EXACT_CIRCLE_SHARE)),
            };
            let border = scene.surface.border;
            (plan::horizons(&scene.field, border, &form.quality, limits, some, false)?, some.1)
        } else {
            (whole, all_azimuths)
        };
        let shade = |p: &Pass| p.name() == "sky_shade";
        let after = |p: &Pass| ["sky_shade", "sweep_fuse", "light_resolve"].contains(&p.name());
        let is_timed = |p: &Pass| if form.shades { shade(p) } else { !after(p) };
        let timed = (0..plan.passes.len()).filter(|i| is_timed(&plan.passes[*i])).collect();
        Ok(Self { plan, timed, azimuths })
    }

    /// Whether the same dispatches are timed, of the same resources.
    fn is_same(&self, other: &Self) -> bool {
        let timed = |work: &Self| -> Vec<_> {
            let of = |i: &usize| {
                let pass = &work.plan.passes[*i];
                let (constants, push) = (pass.constants.clone(), pass.push.clone());
                (pass.name(), pass.groups, constants, push, pass.bindings.clone())
            };
            work.timed.iter().map(of).collect()
        };
        self.plan.resources == other.plan.resources
            && self.plan.azimuths == other.plan.azimuths
            && timed(self) == timed(other)
    }
}

/// On a CPU device, alternates the form and the scalar sweep, so that both meet the same load. On a GPU, runs the form first:
/// the GPU's clocks fall while it idles.
fn in_turn(
    gpu: &Headless,
    frame: &mut Frame,
    scalar: &mut ScalarSweep<'_>,
    (timed, azimuths, most): (&[usize], u32, usize),
    form: &Form,
    progress: &Progress,
) -> Result<[Row; 2]> {
    let (mut runs, mut scalar_ns) = (Vec::new(), Vec::new());
    // Runs all passes once: the timed ones need the others' results and warm pipelines.
    gpu.draw(frame)?;
    scalar.sweep(0.0);
    let mut one_scalar = || {
        let start = Instant::now();
        for k in 0..SCALAR_AZIMUTHS {
            scalar.sweep((f64::from(k) + 0.37) * TAU / f64::from(SCALAR_AZIMUTHS));
        }
        start.elapsed().as_secs_f64() * 1e9
    };
    let alternates = gpu.report().limits.is_cpu;
    let begun = Instant::now();
    for run in 0..most {
        progress.show(&format!("run {} of {most}", run + 1));
        runs.push(gpu.draw_passes(frame, timed)?);
        if alternates {
            scalar_ns.push(one_scalar());
        }
        if late(begun, run + 1) || stable(&sums(&runs, |_| true)) {
            break;
        }
    }
    if !alternates {
        scalar_ns.extend((0..FEWEST).map(|_| one_scalar()));
    }
    let plan = frame.plan();
    let passes: Vec<&Pass> = timed.iter().map(|i| &plan.passes[*i]).collect();
    let times = (runs.len(), &sums(&runs, |_| true)[..]);
    let mut ours = Row::of(&form.name, "isolated", plan, &passes, azimuths, times);
    let scalar_name = scalar_name(&form.name);
    ours.settings.push((SCALAR_BESIDE.into(), scalar_name.clone()));
    let times = (scalar_ns.len(), &scalar_ns[..]);
    let rival = Row {
        settings: vec![("threads".into(), scalar.threads().to_string())],
        work: scalar.points() * u64::from(SCALAR_AZIMUTHS),
        ..Row::of(scalar_name, "isolated", plan, &[], SCALAR_AZIMUTHS, times)
    };
    Ok([ours, rival])
}

/// The setting of a form's row that names the scalar sweep's row.
const SCALAR_BESIDE: &str = "scalar_beside";
/// The setting of both rows that names the form whose times they have.
const TIMES_OF: &str = "times_of";

fn scalar_name(form: &str) -> String {
    format!("scalar_sweep with {form}")
}

/// The rows of an earlier form, for another form with the same dispatches.
fn again(rows: &[Row; 2], name: &str) -> [Row; 2] {
    let [mut ours, mut rival] = rows.clone();
    let times_of = (TIMES_OF.to_owned(), ours.pass.clone());
    ours.settings.retain(|(key, _)| key != SCALAR_BESIDE);
    ours.settings.extend([(SCALAR_BESIDE.to_owned(), scalar_name(name)), times_of.clone()]);
    rival.settings.push(times_of);
    (ours.pass, rival.pass) = (name.to_owned(), scalar_name(name));
    [ours, rival]
}

pub fn print(rows: &[[Row; 2]]) {
    crate::say!(
        "\n{:<34} {:>8} {:>11} {:>13} {:>9} {:>9} {:>9}",
        "form, beside scalar_sweep",
        "azimuths",
        "ms/azimuth",
        "ms/(az·2^20)",
        "scalar's",
        "× scalar",
        "× of minima"
    );
    for [ours, rival] in rows {
        let mega = [ours.ms_per_azimuth_and_mega(), rival.ms_per_azimuth_and_mega()];
        let least = |row: &Row| Some(row.times?.min / f64::from(row.azimuths));
        crate::say!(
            "{:<34} {:>8} {:>11} {:>13} {:>9} {:>9} {:>9}",
            ours.pass,
            ours.azimuths,
            figure(ours.ms_per_azimuth(), 3),
            figure(mega[0], 3),
            figure(mega[1], 3),
            figure(mega[0].zip(mega[1]).map(|(a, b)| a / b), 3),
            figure(least(ours).zip(least(rival)).map(|(a, b)| a / b), 3)
        );
    }
    for [ours, _] in rows {
        if let Some((_, of)) = ours.settings.iter().find(|(key, _)| key == TIMES_OF) {
            crate::say!("({} does the same as {of}: timed once.)", ours.pass);
        }
    }
    crate::say!(
        "(× scalar: ratio of medians. If it differs much from the ratio of minima, the machine \
            was busy.)"
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::rows::tests::plan;
    use crate::bench::verify::tests::scene;
    use ridgelight::scene::Lights;

    /// `lines 1` has the same dispatches as the form of one hull storage: private on lavapipe, or that of `--hull`. No other two forms
    /// have the same dispatches.
    #[test]
    fn only_one_form_does_the_same_as_another() {
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = scene(32, lights);
        let limits = Limits::lavapipe();
        for (hull, same) in [
            (Hull::Auto, "horizon_sweep private f32"),
            (Hull::Private, "horizon_sweep private f32"),
            (Hull::Shared, "horizon_sweep shared f32"),
            (Hull::OccluderList, "horizon_sweep occluder-list f32"),
        ] {
            let forms = wanted(&Quality { hull, azimuths: 16, ..Quality::default() }, &[]);
            let works: Vec<Work> =
                forms.iter().map(|form| Work::of(&scene, form, &limits).unwrap()).collect();
            let mut pairs = Vec::new();
            for (i, work) in works.iter().enumerate() {
                let earlier = works[..i].iter().position(|earlier| earlier.is_same(work));
                pairs.extend(earlier.map(|at| [at, i].map(|i| forms[i].name.as_str())));
            }
            assert_eq!(pairs, [[same, "horizon_sweep lines 1"]]);
        }
        let only = ["horizon_sweep lines 1", "pyramid_march"].map(str::to_owned);
        assert_eq!(count(&Quality::default(), &only), 3);
    }

    /// The second row has the first one's times under its own name, names its own scalar row, and states whose times it has.
    #[test]
    fn times_of_an_earlier_form_are_taken_under_another_name() {
        let plan = plan();
        let row = |name: &str| Row::of(name, "isolated", &plan, &[], 64, (6, &[2e6; 6]));
        let mut ours = row("horizon_sweep a");
        ours.settings.push((SCALAR_BESIDE.into(), scalar_name("horizon_sweep a")));
        let rows = [ours, row(&scalar_name("horizon_sweep a"))];
        let [ours, rival] = again(&rows, "horizon_sweep b");
        assert_eq!(ours.pass, "horizon_sweep b");
        assert_eq!((ours.times, rival.times), (rows[0].times, rows[1].times));
        let setting = |row: &Row, key: &str| {
            let of: Vec<_> = row.settings.iter().filter(|(k, _)| k == key).collect();
            assert!(of.len() < 2, "{key} twice");
            of.first().map(|(_, value)| value.clone())
        };
        assert_eq!(setting(&ours, SCALAR_BESIDE).as_ref(), Some(&rival.pass));
        for row in [&ours, &rival] {
            assert_eq!(setting(row, TIMES_OF).as_deref(), Some("horizon_sweep a"));
        }
    }
}
