//! The half that was not fitted: the choices, whether they meet the goal, and the cheapest settings.

use std::path::Path;
use std::time::Instant;

use ridgelight::gpu::Headless;
use ridgelight::scene::{Fuse, Lines, Method, Quality, Scene};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_trade::auto::{Chosen, Measured, Probes, apart, choose, flags};
use ridgelight_trade::trade::{Goal, Search, Value as Point, ladders, places, recommend, start};
use serde_json::{Value, json};

use super::{Request, draw, ratio, scenes};
use crate::common::head;

const ERRORS: [f64; 5] = [0.05, 0.02, 0.01, 0.005, 0.002];
/// Grid points for true errors: others than those that choose, more, and beside a frame of close lines. More where that
/// frame is not exact enough.
const TRUE_PROBES: usize = 1600;
const MORE_PROBES: usize = 5000;
const TRUE_SEED: u64 = 99;
/// Above this the frame of close lines is no control for 0.2 %, and horizons are exact.
const GOOD: f64 = 0.001;

/// The ground truth of a scene.
struct Truth {
    probes: Probes,
    control: Vec<Vec<f32>>,
    own: Measured,
    needs_exact: bool,
}

impl Truth {
    fn of(gpu: &mut Headless, scene: &Scene) -> Result<Self> {
        let dense = Quality {
            lines: Lines::QuarterCell,
            fuse: Fuse::Aimed,
            azimuths: 1024,
            sun_azimuths: 128,
            table_elevations: 4096,
            ..start()
        };
        let plain = draw(gpu, scene, &start(), 0)?.planes;
        let control = draw(gpu, scene, &dense, 0)?.planes;
        let unsure = apart(&plain, &control, scene.field.cols());
        let probes = Probes::of(scene, TRUE_PROBES, TRUE_SEED, &unsure)?;
        let own = probes.error(&control, None, Probes::ONE_BOUND);
        let mut truth = Self { probes, control, own, needs_exact: own.error > GOOD };
        if truth.needs_exact {
            truth.probes = Probes::of(scene, MORE_PROBES, TRUE_SEED, &unsure)?;
            let exact = if scene.lights.suns.is_empty() {
                Quality { lines: Lines::Exact, azimuths: 512, ..dense }
            } else {
                Quality { method: Method::BruteForce, azimuths: 128, sun_azimuths: 64, ..dense }
            };
            let control = draw(gpu, scene, &exact, 0)?.planes;
            truth.own = truth.probes.error(&truth.control, None, Probes::ONE_BOUND);
            let own = truth.probes.error(&control, None, Probes::ONE_BOUND);
            if own.error < truth.own.error {
                (truth.control, truth.own) = (control, own);
            }
        }
        Ok(truth)
    }

    fn error(&self, planes: &[Vec<f32>]) -> Measured {
        self.probes.error(planes, Some(&self.control), Probes::ONE_BOUND)
    }
}

/// A walk of `trade`: settings with their times and errors.
fn walked(
    gpu: &mut Headless,
    scene: &Scene,
    truth: &Truth,
    seconds: f64,
) -> Result<Vec<(Quality, Point)>> {
    let start = start();
    let ladders = ladders(scene, 0);
    let is_exact = |q: &Quality| q.method == Method::BruteForce || q.lines == Lines::Exact;
    let is_walked = |q: &Quality| truth.needs_exact || !is_exact(q);
    let places: Vec<_> =
        places(&ladders, &start).into_iter().filter(|p| is_walked(&p.quality)).collect();
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
        let value = Point { cost, error: truth.error(&drawn.planes).error };
        search.measured(place, value);
        all.push((quality, value));
    }
    Ok(all)
}

/// A row's number, NaN where it has none.
fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or(f64::NAN)
}

/// A row of the table.
fn text(row: &Value) -> String {
    let percent = |key: &str| format!("{:.3}", 100.0 * number(row, key));
    let word = |key: &str| row[key].as_str().unwrap_or_default();
    let head = format!("| {} | {} |", word("scene"), 100.0 * number(row, "asked"));
    if row["refused"].is_string() {
        return format!("{head} refused: {} | | | | | | | |", word("refused"));
    }
    let ratio = match row["time_over_best"].as_f64() {
        Some(ratio) => format!("{ratio:.2}"),
        None => "none found".to_owned(),
    };
    format!(
        "{head} {} | {} | {} | {} | {} ({:.3}, {}) | {} | {ratio} {} | {} in {:.1} |",
        word("settings"),
        percent("expected"),
        percent("measured"),
        percent("at_most"),
        percent("true"),
        100.0 * (number(row, "true_at_most") - number(row, "true")),
        percent("truth_own_error"),
        if row["holds"] == true { "yes" } else { "no" },
        word("best"),
        row["tried"].as_array().map_or(0, Vec::len),
        number(row, "seconds")
    )
}

/// What is chosen for an error, and the seconds it took; every frame drawn on the way joins `all`.
fn chosen(
    gpu: &mut Headless,
    scene: &Scene,
    truth: &Truth,
    (seed, most): (u64, f64),
    all: &mut Vec<(Quality, Point)>,
) -> Result<(std::result::Result<Chosen, String>, f64)> {
    let begun = Instant::now();
    let probes = (Probes::affordable(scene), seed);
    let found = choose(scene, Goal::MaxError(most), probes, None, |quality| {
        let drawn = draw(gpu, scene, quality, 3)?;
        let cost = drawn.passes.iter().map(|p| p.1).sum();
        all.push((*quality, Point { cost, error: truth.error(&drawn.planes).error }));
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
fn rows(gpu: &mut Headless, label: &str, scene: &Scene, seconds: f64) -> Result<Vec<Value>> {
    let truth = Truth::of(gpu, scene)?;
    let mut all = walked(gpu, scene, &truth, seconds)?;
    let mut choices = Vec::new();
    for (seed, most) in ERRORS.into_iter().enumerate() {
        choices.push((most, chosen(gpu, scene, &truth, (seed as u64, most), &mut all)?));
    }
    let values: Vec<Point> = all.iter().map(|a| a.1).collect();
    let mut rows = Vec::new();
    for (most, (found, seconds)) in choices {
        let best = recommend(&values, Some(Goal::MaxError(most))).filter(|r| r.holds);
        let best = best.map(|b| all[b.point].0);
        let mut row = json!({
            "scene": label, "asked": most, "seconds": seconds, "truth_own_error": truth.own.error,
            "best": best.as_ref().map(|q| flags(q, scene))
        });
        match found {
            Ok(found) => fill(gpu, scene, &truth, best.as_ref(), &found, &mut row)?,
            Err(why) => row["refused"] = why.into(),
        }
        rows.push(row);
    }
    Ok(rows)
}

/// What was chosen, its true error, and its time over that of the best, where there is one.
fn fill(
    gpu: &mut Headless,
    scene: &Scene,
    truth: &Truth,
    best: Option<&Quality>,
    found: &Chosen,
    row: &mut Value,
) -> Result<()> {
    let quality = found.trial.quality;
    let off = truth.error(&draw(gpu, scene, &quality, 0)?.planes);
    let times = match best {
        Some(best) if *best != quality => Some(ratio(gpu, scene, &quality, best)?),
        best => best.map(|_| 1.0),
    };
    let tried = found.trials.iter().map(|t| {
        let Measured { error, at_most } = t.measured;
        let ms = t.ns / 1e6;
        json!({ "settings": flags(&t.quality, scene), "measured": error, "at_most": at_most, "ms": ms })
    });
    let more = json!({
        "settings": flags(&quality, scene), "probes": found.probes, "tried": tried.collect::<Vec<_>>(),
        "expected": found.expected.error, "expected_within_factor": found.expected.factor,
        "measured": found.trial.measured.error, "at_most": found.trial.measured.at_most,
        "true": off.error, "true_at_most": off.at_most, "holds": off.error <= number(row, "asked"),
        "time_over_best": times,
    });
    for (key, value) in more.as_object().into_iter().flatten() {
        row[key] = value.clone();
    }
    Ok(())
}

/// What all rows come to.
fn summary(rows: &[Value]) -> Value {
    let count = |is: &dyn Fn(&Value) -> bool| rows.iter().filter(|r| is(r)).count();
    let is_refused = |r: &Value| r["refused"].is_string();
    // Whether the truth's own bound is on the other side of what was asked.
    let is_close = |r: &Value| {
        let [off, bound, asked] = ["true", "true_at_most", "asked"].map(|key| number(r, key));
        bound - off > (off - asked).abs()
    };
    let holds = |r: &Value| r["holds"] == true;
    let mut ratios: Vec<f64> =
        rows.iter().filter(|r| holds(r)).filter_map(|r| r["time_over_best"].as_f64()).collect();
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios.get((share * (ratios.len() as f64 - 1.0)) as usize).copied();
    json!({
        "asked": rows.len(),
        "chosen": count(&|r| !is_refused(r)),
        "held": count(&holds),
        "close": count(&is_close),
        "within_stated_bound": count(&|r| number(r, "true") <= number(r, "at_most")),
        "refused": count(&is_refused),
        "refused_though_found": count(&|r| is_refused(r) && r["best"].is_string()),
        "ratios": ratios.len(), "ratio_median": at(0.5), "ratio_90": at(0.9), "ratio_worst": at(1.0),
        "within_1.3": ratios.iter().filter(|r| **r <= 1.3).count()
    })
}

/// Rows of an earlier run that are kept: of the same device and side.
fn kept(path: &Path, about: &Value) -> Result<Vec<Value>> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let io = |source| Error::Io { path: path.to_owned(), source };
    let text = std::fs::read_to_string(path).map_err(io)?;
    let old: Value = serde_json::from_str(&text)
        .map_err(|e| Error::setting("--json", e.to_string(), "a report of an earlier run"))?;
    for key in ["device", "side"] {
        if old[key] != about[key] {
            let found = format!("a report of {key} {}", old[key]);
            return Err(Error::setting("--json", found, about[key].to_string()));
        }
    }
    Ok(old["rows"].as_array().cloned().unwrap_or_default())
}

fn write(asked: &Request, about: &mut Value, rows: &[Value]) -> Result<()> {
    let Some(path) = &asked.json else { return Ok(()) };
    about["pairs"] = (rows.len() / ERRORS.len()).into();
    about["summary"] = summary(rows);
    about["rows"] = rows.into();
    files::write_json(path, about)
}

pub fn report(gpu: &mut Headless, asked: &Request) -> Result<()> {
    let scenes = scenes(asked)?;
    let mut about = json!({
        "device": gpu.report().name, "driver": gpu.report().driver, "side": asked.side,
        "trade_seconds": asked.seconds
    });
    println!(
        "{}; middle {}² of each field; pairs that nothing was fitted on; {} s of trade a pair; true \
         errors at {TRUE_PROBES} grid points of the oracle other than those that choose ({MORE_PROBES} \
         where the error of the frame beside them is above {} %)\n",
        gpu.report().name,
        asked.side,
        asked.seconds,
        100.0 * GOOD
    );
    head(
        "| field | light | asked % | chosen | expected % | probed % | at most % | true % (its bound \
         above, error of its control) | holds | time / best, best | tried, s |",
    );
    let mut all = match &asked.json {
        Some(path) => kept(path, &about)?,
        None => Vec::new(),
    };
    all.iter().for_each(|row| println!("{}", text(row)));
    for (label, scene) in &scenes {
        if all.iter().any(|row| row["scene"] == label.as_str()) {
            continue;
        }
        for row in rows(gpu, label, scene, asked.seconds)? {
            println!("{}", text(&row));
            all.push(row);
        }
        // After every pair: a run that is ended early can go on.
        write(asked, &mut about, &all)?;
    }
    write(asked, &mut about, &all)?;
    println!("\n{} pairs: {}", all.len() / ERRORS.len(), summary(&all));
    Ok(())
}
