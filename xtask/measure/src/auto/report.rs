//! The half that was not fitted: the choices, whether they meet the goal, and the fastest settings.

use std::path::Path;
use std::time::Instant;

use ridgelight::gpu::Headless;
use ridgelight::scene::{Fuse, Lines, Method, Quality, Scene};
use ridgelight::{Error, Result};
use ridgelight_cpu::lit::Lit;
use ridgelight_io as files;
use ridgelight_trade::auto::{
    Chosen, Drawn, Measured, OracleThreads, Probes, choose, flags, unsure,
};
use ridgelight_trade::statistics::quantiles;
use ridgelight_trade::trade::{Goal, Search, Value as Point, ladders, places, recommend, start};
use serde_json::{Value, json};

use super::{judged, judged_while};
use crate::common::frames::in_turn;
use crate::common::{head, median};

const ERRORS: [f64; 5] = [0.05, 0.02, 0.01, 0.005, 0.002];
/// Grid points for true errors: others than those that choose, more, and compared with a frame of
/// close lines as a control variate. More where that frame is not exact enough.
const TRUE_PROBES: usize = 1600;
const MORE_PROBES: usize = 5000;
const TRUE_SEED: u64 = 99;
/// Above this error the frame of close lines is no control for 0.2 %, and horizons are exact.
const GOOD: f64 = 0.001;

/// A scene, its ground truth, and all settings drawn with their times and errors.
struct Measuring<'a> {
    scene: &'a Scene,
    probes: Probes,
    control: Vec<Vec<f32>>,
    /// The control's own error.
    own: Measured,
    all: Vec<(Quality, Point)>,
}

impl<'a> Measuring<'a> {
    fn of(gpu: &mut Headless, scene: &'a Scene) -> Result<Self> {
        let dense = Quality {
            lines: Lines::QuarterCell,
            fuse: Fuse::AimedAround,
            azimuths: 1024,
            sun_azimuths: 128,
            table_elevations: 4096,
            ..start()
        };
        let plain = judged(gpu, scene, &start())?.planes;
        let control = judged(gpu, scene, &dense)?.planes;
        let unsure = unsure(scene, [&control, &plain], None);
        let probes = Probes::of(&Lit::of(scene), TRUE_PROBES, TRUE_SEED, &unsure)?;
        let own = probes.error(&control, None, Probes::ONE_BOUND);
        let mut found = Self { scene, probes, control, own, all: Vec::new() };
        if own.error > GOOD {
            found.probes = Probes::of(&Lit::of(scene), MORE_PROBES, TRUE_SEED, &unsure)?;
            // Azimuths of suns and key lights are no grid vectors.
            let exact = if scene.lights.suns.is_empty() && scene.lights.keys.is_empty() {
                Quality { lines: Lines::Exact, azimuths: 512, ..dense }
            } else {
                Quality { method: Method::BruteForce, azimuths: 128, sun_azimuths: 64, ..dense }
            };
            let control = judged(gpu, scene, &exact)?.planes;
            found.own = found.probes.error(&found.control, None, Probes::ONE_BOUND);
            let own = found.probes.error(&control, None, Probes::ONE_BOUND);
            if own.error < found.own.error {
                (found.control, found.own) = (control, own);
            }
        }
        Ok(found)
    }

    fn error(&self, planes: &[Vec<f32>]) -> Measured {
        self.probes.error(planes, Some(&self.control), Probes::ONE_BOUND)
    }

    /// Draws `runs` frames after one that compiles, and keeps what `pause` returns meanwhile.
    fn draw<P>(
        &mut self,
        gpu: &mut Headless,
        quality: &Quality,
        runs: usize,
        pause: impl FnOnce() -> P,
    ) -> Result<Drawn> {
        let drawn = judged_while(gpu, self.scene, quality, runs, pause)?;
        let cost = drawn.passes.iter().map(|p| p.1).sum();
        let error = self.error(&drawn.planes).error;
        self.all.push((*quality, Point { cost, error }));
        Ok(drawn)
    }

    /// A walk of `trade`.
    fn walk(&mut self, gpu: &mut Headless, seconds: f64) -> Result<()> {
        let needs_exact = self.own.error > GOOD;
        let is_exact = |q: &Quality| q.method == Method::BruteForce || q.lines == Lines::Exact;
        let mut places = places(&ladders(self.scene, 0), &start());
        places.retain(|p| needs_exact || !is_exact(&p.quality));
        let first = places.iter().position(|p| p.quality == start());
        let first = first.expect("the defaults are a place");
        let steps = places.iter().map(|p| p.steps.clone()).collect();
        let (mut search, begun) = (Search::new(steps, first, 0.0), Instant::now());
        while let Some(place) = search.next().filter(|_| begun.elapsed().as_secs_f64() < seconds) {
            match self.draw(gpu, &places[place].quality, 1, || ()) {
                Err(Error::Limit { .. } | Error::Setting { .. }) => search.give_up(place, false),
                drawn => {
                    drawn?;
                    search.measured(place, self.all[self.all.len() - 1].1);
                }
            }
        }
        Ok(())
    }

    /// The choice for an error, or why there is none.
    fn choose(
        &mut self,
        gpu: &mut Headless,
        seed: u64,
        most: f64,
    ) -> Result<std::result::Result<Chosen, String>> {
        let lit = Lit::of(self.scene);
        let probes = (Probes::affordable(&lit), seed);
        let draw = |quality: &Quality, threads: &OracleThreads| {
            self.draw(gpu, quality, 3, || threads.pause())
        };
        match choose(&lit, Goal::MaxError(most), probes, None, draw) {
            Ok(chosen) => Ok(Ok(chosen)),
            Err(error @ Error::Limit { .. }) => Ok(Err(error.to_string())),
            Err(error) => Err(error),
        }
    }

    /// The row of a choice: its true error, and its time over that of the best settings.
    fn row(
        &self,
        gpu: &mut Headless,
        (most, seconds): (f64, f64),
        found: &std::result::Result<Chosen, String>,
    ) -> Result<Value> {
        let scene = self.scene;
        let values: Vec<Point> = self.all.iter().map(|a| a.1).collect();
        let best = recommend(&values, Some(Goal::MaxError(most))).filter(|r| r.holds);
        let best = best.map(|b| self.all[b.point].0);
        let best_flags = best.as_ref().map(|q| flags(q, scene));
        let found = match found {
            Ok(found) => found,
            Err(why) => return Ok(json!({ "asked": most, "best": best_flags, "refused": why })),
        };
        let quality = found.trial.quality;
        let trials: Vec<Value> = (found.trials.iter())
            .map(|t| {
                let Measured { error, at_most } = t.measured;
                json!({ "settings": flags(&t.quality, scene), "measured": error, "at_most": at_most, "ms": t.ns / 1e6 })
            })
            .collect();
        let error = self.error(&judged(gpu, scene, &quality)?.planes);
        let ratio = match best {
            Some(best) if best != quality => {
                let turns = in_turn(gpu, scene, [&quality, &best], 7)?;
                Some(median(turns.iter().map(|[own, best]| own / best).collect()))
            }
            best => best.map(|_| 1.0),
        };
        Ok(json!({
            "asked": most, "best": best_flags, "settings": flags(&quality, scene),
            "expected": found.expected.error, "measured": found.trial.measured.error,
            "at_most": found.trial.measured.at_most, "true": error.error,
            "true_at_most": error.at_most, "reference_error": self.own.error,
            "holds": error.error <= most, "time_over_best": ratio, "tried": trials.len(),
            "trials": trials, "probes": found.probes,
            "seconds": seconds,
        }))
    }
}

/// A row's number, NaN where it has none.
fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or(f64::NAN)
}

fn print(row: &Value) {
    let word = |key: &str| row[key].as_str().unwrap_or_default();
    let head = format!("| {} | {} |", word("scene"), 100.0 * number(row, "asked"));
    if row["refused"].is_string() {
        println!("{head} refused: {} | | | | | | | |", word("refused"));
        return;
    }
    let [expected, measured, at_most, error, bound, own] =
        ["expected", "measured", "at_most", "true", "true_at_most", "reference_error"]
            .map(|key| 100.0 * number(row, key));
    let ratio = row["time_over_best"].as_f64().map(|ratio| format!("{ratio:.2}"));
    println!(
        "{head} {} | {expected:.3} | {measured:.3} | {at_most:.3} | {error:.3} ({:.3}, {own:.3}) | {} | {} {} | {} in {:.1} |",
        word("settings"),
        bound - error,
        if row["holds"] == true { "yes" } else { "no" },
        ratio.as_deref().unwrap_or("none found"),
        word("best"),
        row["tried"],
        number(row, "seconds")
    );
}

/// Counts and time ratios of all rows.
fn summary(rows: &[Value]) -> Value {
    let count = |is: &dyn Fn(&Value) -> bool| rows.iter().filter(|r| is(r)).count();
    let is_refused = |r: &Value| r["refused"].is_string();
    let holds = |r: &Value| r["holds"] == true;
    let held = rows.iter().filter(|r| holds(r));
    let mut ratios: Vec<f64> = held.filter_map(|r| r["time_over_best"].as_f64()).collect();
    let quantiles = quantiles(&mut ratios, [0.5, 0.9, 1.0]);
    json!({
        "asked": rows.len(),
        "chosen": count(&|r| !is_refused(r)),
        "held": count(&holds),
        "within_stated_bound": count(&|r| number(r, "true") <= number(r, "at_most")),
        "refused": count(&is_refused),
        "refused_though_found": count(&|r| is_refused(r) && r["best"].is_string()),
        "ratios": ratios.len(), "ratio_median": quantiles.map(|q| q[0]),
        "ratio_90": quantiles.map(|q| q[1]), "ratio_worst": quantiles.map(|q| q[2]),
        "within_1.3": ratios.iter().filter(|r| **r <= 1.3).count()
    })
}

pub fn report(
    gpu: &mut Headless,
    (side, scenes): (usize, &[(String, Scene)]),
    seconds: f64,
    json: Option<&Path>,
) -> Result<()> {
    let (device, driver) = (gpu.report().name.clone(), gpu.report().driver.clone());
    println!(
        "{device}; middle {side}² of each field; pairs that the model of errors was not fitted on; {seconds} s of trade a pair; true \
         errors at {TRUE_PROBES} grid points of the oracle other than those that choose ({MORE_PROBES} \
         where the error of the frame beside them is above {} %)\n",
        100.0 * GOOD
    );
    head(
        "| field | light | requested % | chosen | expected % | probed % | at most % | true % (its bound \
         above, error of its control) | holds | time / best, best | tried, s |",
    );
    let mut rows = Vec::new();
    for (label, scene) in scenes {
        let mut measuring = Measuring::of(gpu, scene)?;
        measuring.walk(gpu, seconds)?;
        let mut choices = Vec::new();
        for (seed, most) in ERRORS.into_iter().enumerate() {
            let begun = Instant::now();
            let found = measuring.choose(gpu, seed as u64, most)?;
            choices.push(((most, begun.elapsed().as_secs_f64()), found));
        }
        for (of, found) in choices {
            let mut row = measuring.row(gpu, of, &found)?;
            row["scene"] = label.as_str().into();
            print(&row);
            rows.push(row);
        }
    }
    let (pairs, summary) = (scenes.len(), summary(&rows));
    let of = |key: &str| number(&summary, key);
    println!(
        "\n{pairs} pairs, {} requests: {} chosen, of which {} hold and {} are within their bound; {} refused, {} of them though \
         settings that hold were drawn. Time over the best: median {:.2}, 90th percentile {:.2}, worst {:.2}; at most 1.3 in {} \
         of {}.",
        of("asked"),
        of("chosen"),
        of("held"),
        of("within_stated_bound"),
        of("refused"),
        of("refused_though_found"),
        of("ratio_median"),
        of("ratio_90"),
        of("ratio_worst"),
        of("within_1.3"),
        of("ratios"),
    );
    let Some(path) = json else { return Ok(()) };
    let figures = json!({
        "device": device, "driver": driver, "side": side, "trade_seconds": seconds,
        "pairs": pairs, "summary": summary, "rows": rows,
    });
    files::write_json(path, &figures)
}
