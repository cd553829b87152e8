//! The half that was not fitted: what was chosen, whether it holds, and what would have been cheapest.

use std::time::Instant;

use ridgelight::files;
use ridgelight::gpu::Headless;
use ridgelight::measure::auto::{Chosen, Goal, Measured, Probes, apart, choose, flags};
use ridgelight::measure::trade::{Rule, Search, Value, knobs, places, recommend};
use ridgelight::scene::{Fuse, Lines, Method, Quality, Scene};
use ridgelight::{Error, Result};

use super::device::{draw, ratio};
use super::{Asked, scenes};

const ERRORS: [f64; 5] = [0.05, 0.02, 0.01, 0.005, 0.002];
/// Samples that true errors are told by: others than those that choose, more, and beside a frame that is
/// as good as any. More where that frame is not as good as it should be.
const TRUE_PROBES: usize = 1600;
const MORE_PROBES: usize = 5000;
const TRUE_SEED: u64 = 99;
/// Above this the frame of close lines is no control for 0.2 %, and horizons are exact.
const GOOD: f64 = 0.001;

/// What pictures of a scene are held against.
struct Truth {
    probes: Probes,
    control: Vec<Vec<f32>>,
    own: Measured,
    needs_exact: bool,
}

impl Truth {
    fn of(gpu: &mut Headless, scene: &Scene) -> Result<Self> {
        let dense = Quality {
            method: Method::Sweep,
            lines: Lines::QuarterCell,
            fuse: Fuse::Aimed,
            azimuths: 1024,
            sun_azimuths: 128,
            table_elevations: 4096,
            ..Quality::default()
        };
        let plain = Quality { method: Method::Sweep, ..Quality::default() };
        let plain = draw(gpu, scene, &plain, 0)?.planes;
        let control = draw(gpu, scene, &dense, 0)?.planes;
        let unsure = apart(&plain, &control, scene.field.cols());
        let probes = Probes::of(scene, TRUE_PROBES, TRUE_SEED, &unsure)?;
        let own = probes.error(&control, None);
        let mut truth = Self { probes, control, own, needs_exact: own.error > GOOD };
        if truth.needs_exact {
            truth.probes = Probes::of(scene, MORE_PROBES, TRUE_SEED, &unsure)?;
            let exact = if scene.lights.suns.is_empty() {
                Quality { lines: Lines::Exact, azimuths: 512, ..dense }
            } else {
                Quality { method: Method::Brute, azimuths: 128, sun_azimuths: 64, ..dense }
            };
            let control = draw(gpu, scene, &exact, 0)?.planes;
            truth.own = truth.probes.error(&truth.control, None);
            let own = truth.probes.error(&control, None);
            if own.error < truth.own.error {
                (truth.control, truth.own) = (control, own);
            }
        }
        Ok(truth)
    }

    fn error(&self, planes: &[Vec<f32>]) -> Measured {
        self.probes.error(planes, Some(&self.control))
    }
}

/// A walk of `trade`: settings with their times and errors.
fn walked(
    gpu: &mut Headless,
    scene: &Scene,
    truth: &Truth,
    seconds: f64,
) -> Result<Vec<(Quality, Value)>> {
    let start = Quality { method: Method::Sweep, ..Quality::default() };
    let knobs = knobs(scene);
    let is_exact = |q: &Quality| q.method == Method::Brute || q.lines == Lines::Exact;
    let is_walked = |q: &Quality| truth.needs_exact || !is_exact(q);
    let places: Vec<_> =
        places(&knobs, &start).into_iter().filter(|p| is_walked(&p.quality)).collect();
    let first = places.iter().position(|p| p.quality == start).expect("the defaults are a place");
    let mut search = Search::new(places.iter().map(|p| p.steps.clone()).collect(), first, 0.0);
    let (begun, mut all) = (Instant::now(), Vec::new());
    while let Some(place) = search.next().filter(|_| begun.elapsed().as_secs_f64() < seconds) {
        let quality = places[place].quality;
        let drawn = match draw(gpu, scene, &quality, 1) {
            Err(Error::Limit { .. } | Error::Setting { .. }) => {
                search.give_up(place, false);
                continue;
            }
            drawn => drawn?,
        };
        let cost = drawn.passes.iter().map(|p| p.1).sum();
        let value = Value { cost, error: truth.error(&drawn.planes).error };
        search.measured(place, value);
        all.push((quality, value));
    }
    Ok(all)
}

/// One error asked for of one scene.
struct Row<'a> {
    label: String,
    scene: &'a Scene,
    most: f64,
    seconds: f64,
    /// What was chosen and its true error, or why nothing was.
    found: std::result::Result<(Chosen, Measured), String>,
    own: Measured,
    best: Option<Quality>,
    /// Time over that of the best, where there is one.
    times: Option<f64>,
}

impl Row<'_> {
    fn holds(&self) -> bool {
        self.found.as_ref().is_ok_and(|(_, off)| off.error <= self.most)
    }

    /// Whether the truth's own bound is on the other side of what was asked.
    fn is_close(&self) -> bool {
        let close = |off: &Measured| (off.at_most - off.error) > (off.error - self.most).abs();
        self.found.as_ref().is_ok_and(|(_, off)| close(off))
    }

    fn text(&self) -> String {
        let percent = |x: f64| format!("{:.3}", 100.0 * x);
        let head = format!("| {} | {} |", self.label, 100.0 * self.most);
        let (chosen, off) = match &self.found {
            Ok(found) => found,
            Err(why) => return format!("{head} refused: {why} | | | | | | | |"),
        };
        let Measured { error, at_most } = chosen.trial.measured;
        format!(
            "{head} {} | {} ×{:.1} | {} | {} | {} ({}, {}) | {} | {} {} | {} in {:.1} |",
            flags(&chosen.trial.quality, self.scene),
            percent(chosen.expected.error),
            chosen.expected.factor,
            percent(error),
            percent(at_most),
            percent(off.error),
            percent(off.at_most - off.error),
            percent(self.own.error),
            if self.holds() { "yes" } else { "no" },
            self.times.map_or("none found".to_owned(), |t| format!("{t:.2}")),
            self.best.as_ref().map(|q| flags(q, self.scene)).unwrap_or_default(),
            chosen.trials.len(),
            self.seconds
        )
    }

    fn json(&self) -> serde_json::Value {
        let mut row = serde_json::json!({
            "scene": self.label, "asked": self.most, "seconds": self.seconds,
            "truth_own_error": self.own.error
        });
        match &self.found {
            Err(why) => row["refused"] = why.as_str().into(),
            Ok((chosen, off)) => {
                row["settings"] = flags(&chosen.trial.quality, self.scene).into();
                row["expected"] = chosen.expected.error.into();
                row["measured"] = chosen.trial.measured.error.into();
                row["at_most"] = chosen.trial.measured.at_most.into();
                row["probes"] = chosen.probes.into();
                let tried = chosen.trials.iter().map(|t| {
                    let Measured { error, at_most } = t.measured;
                    serde_json::json!({
                        "settings": flags(&t.quality, self.scene), "measured": error, "at_most": at_most,
                        "ms": t.ns / 1e6
                    })
                });
                row["tried"] = tried.collect();
                row["true"] = off.error.into();
                row["true_at_most"] = off.at_most.into();
                row["holds"] = self.holds().into();
                row["best"] = self.best.as_ref().map(|q| flags(q, self.scene)).into();
                row["time_over_best"] = self.times.into();
            }
        }
        row
    }
}

/// What is chosen for an error, and the seconds it took; every frame drawn on the way joins `all`.
fn chosen(
    gpu: &mut Headless,
    scene: &Scene,
    truth: &Truth,
    (seed, most): (u64, f64),
    all: &mut Vec<(Quality, Value)>,
) -> Result<(std::result::Result<Chosen, String>, f64)> {
    let begun = Instant::now();
    let probes = (Probes::affordable(scene), seed);
    let found = choose(scene, Goal::MaxError(most), probes, |quality| {
        let drawn = draw(gpu, scene, quality, 1)?;
        let cost = drawn.passes.iter().map(|p| p.1).sum();
        all.push((*quality, Value { cost, error: truth.error(&drawn.planes).error }));
        Ok(drawn)
    });
    let seconds = begun.elapsed().as_secs_f64();
    match found {
        Ok(chosen) => Ok((Ok(chosen), seconds)),
        Err(error @ Error::Limit { .. }) => Ok((Err(error.to_string()), seconds)),
        Err(error) => Err(error),
    }
}

/// All errors asked of one scene: what was chosen beside the cheapest that truly holds of all that the
/// walk and the choices drew.
fn rows<'a>(
    gpu: &mut Headless,
    (label, scene): (&str, &'a Scene),
    seconds: f64,
) -> Result<Vec<Row<'a>>> {
    let truth = Truth::of(gpu, scene)?;
    let mut all = walked(gpu, scene, &truth, seconds)?;
    let mut choices = Vec::new();
    for (seed, most) in ERRORS.into_iter().enumerate() {
        choices.push((most, chosen(gpu, scene, &truth, (seed as u64, most), &mut all)?));
    }
    let values: Vec<Value> = all.iter().map(|a| a.1).collect();
    let mut rows = Vec::new();
    for (most, (found, seconds)) in choices {
        let best = recommend(&values, Rule::MaxError(most)).filter(|r| r.holds);
        let best = best.map(|b| all[b.point].0);
        let mut row = Row {
            label: label.to_owned(),
            scene,
            most,
            seconds,
            found: Err(String::new()),
            own: truth.own,
            best,
            times: None,
        };
        row.found = match found {
            Ok(chosen) => {
                let quality = chosen.trial.quality;
                let off = truth.error(&draw(gpu, scene, &quality, 0)?.planes);
                row.times = match best {
                    Some(best) if best != quality => Some(ratio(gpu, scene, &quality, &best)?),
                    best => best.map(|_| 1.0),
                };
                Ok((chosen, off))
            }
            Err(why) => Err(why),
        };
        rows.push(row);
    }
    Ok(rows)
}

/// What all rows come to, for people and machines.
fn summary(rows: &[Row]) -> (String, serde_json::Value) {
    let found: Vec<&Row> = rows.iter().filter(|r| r.found.is_ok()).collect();
    let held = found.iter().filter(|r| r.holds()).count();
    let close = found.iter().filter(|r| r.is_close()).count();
    // The bound that was stated, not what was asked.
    let covered = found
        .iter()
        .filter(|r| r.found.as_ref().is_ok_and(|(c, off)| off.error <= c.trial.measured.at_most));
    let covered = covered.count();
    // Refused although settings that hold were drawn.
    let reached = |r: &&Row| r.found.is_err() && r.best.is_some();
    let wrongly = rows.iter().filter(reached).count();
    let mut ratios: Vec<f64> = found.iter().filter(|r| r.holds()).filter_map(|r| r.times).collect();
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios.get((share * (ratios.len() as f64 - 1.0)) as usize).copied();
    let [median, ninety, worst] = [0.5, 0.9, 1.0].map(|s| at(s).unwrap_or(f64::NAN));
    let within = ratios.iter().filter(|r| **r <= 1.3).count();
    let text = format!(
        "{held} of {} hold ({:.1} %; {close} are nearer to what was asked than the truth's own bound; \
         {covered} are within the bound that was stated), {} refused \
         ({wrongly} of them where settings that hold were drawn); time over the cheapest drawn that holds: \
         median {median:.2}, 90 % {ninety:.2}, worst {worst:.2}; at most 1.3 in {within} of {}",
        found.len(),
        100.0 * held as f64 / found.len().max(1) as f64,
        rows.len() - found.len(),
        ratios.len()
    );
    let json = serde_json::json!({
        "asked": rows.len(), "chosen": found.len(), "held": held, "close": close, "within_stated_bound": covered,
        "refused": rows.len() - found.len(), "refused_though_found": wrongly,
        "ratios": ratios.len(), "ratio_median": median, "ratio_90": ninety,
        "ratio_worst": worst, "within_1.3": within
    });
    (text, json)
}

pub fn report(gpu: &mut Headless, asked: &Asked) -> Result<()> {
    let scenes = scenes(asked)?;
    let (device, driver) = (gpu.report().name.clone(), gpu.report().driver.clone());
    println!(
        "{device}; middle {}² of each field; {} pairs that nothing was fitted on; {} s of trade a pair; \
         true errors by {TRUE_PROBES} samples of the oracle other than those that choose ({MORE_PROBES} \
         where the frame beside them is more than {} % off)\n",
        asked.side,
        scenes.len(),
        asked.seconds,
        100.0 * GOOD
    );
    println!(
        "| field | light | asked % | chosen | expected % | probed % | at most % | true % (its bound \
         above, error of its control) | holds | time / best, best | tried, s |\n\
         |---|---|---|---|---|---|---|---|---|---|---|"
    );
    let mut all: Vec<Row> = Vec::new();
    for (done, (label, scene)) in scenes.iter().enumerate() {
        for row in rows(gpu, (label, scene), asked.seconds)? {
            println!("{}", row.text());
            all.push(row);
        }
        // After every pair: a run that is ended early has told what it found.
        let Some(path) = &asked.json else { continue };
        let json = serde_json::json!({
            "device": device, "driver": driver, "side": asked.side, "pairs": done + 1,
            "trade_seconds": asked.seconds, "summary": summary(&all).1,
            "rows": all.iter().map(Row::json).collect::<Vec<_>>()
        });
        files::write_json(path, &json)?;
    }
    println!("\n{}", summary(&all).0);
    Ok(())
}
