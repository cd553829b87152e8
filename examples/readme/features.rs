//! README's list of modes: exact or approximate, and the error that benches/results has of each.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::Result;
use super::figures::{RESULTS, text, wrong};

/// Cells of a table's row.
fn cells(line: &str) -> Vec<&str> {
    let line = line.trim();
    let line = line.strip_prefix('|').unwrap_or(line);
    line.strip_suffix('|').unwrap_or(line).split('|').map(str::trim).collect()
}

fn path(name: &str) -> PathBuf {
    PathBuf::from(RESULTS).join(format!("{name}.txt"))
}

/// A cell of the first row that begins with these; without what stands in brackets.
fn cell(name: &str, begin: &[&str], column: usize) -> Result<String> {
    let path = path(name);
    let text = text(&path)?;
    let mut rows = text.lines().filter(|line| line.starts_with('|')).map(cells);
    let row = rows.find(|row| row.starts_with(begin));
    let value = row.as_ref().and_then(|row| row.get(column)).copied();
    let missing = || wrong(&path, "no such row", &format!("| {} | …", begin.join(" | ")));
    let value = value.ok_or_else(missing)?;
    Ok(value.split(" (").next().unwrap_or_default().to_owned())
}

/// The word that follows some text.
fn after(name: &str, begin: &str) -> Result<String> {
    let path = path(name);
    let text = text(&path)?;
    let word = text.rsplit_once(begin).and_then(|(_, rest)| rest.split([' ', ',']).next());
    word.map(str::to_owned).ok_or_else(|| wrong(&path, "another text", begin))
}

/// The error of a setting that `trade` measured: `15.1 ms  3.81 %  SETTINGS`.
fn traded(name: &str, settings: &str) -> Result<String> {
    let path = path(name);
    let text = text(&path)?;
    let line = text.lines().find(|line| line.contains(settings));
    let error = line.and_then(|line| line.split_whitespace().nth(2));
    error.map(str::to_owned).ok_or_else(|| wrong(&path, "no such setting", settings))
}

/// The largest number of a column.
fn largest(name: &str, column: usize) -> Result<f64> {
    let path = path(name);
    let text = text(&path)?;
    let rows = text.lines().filter(|line| line.starts_with('|')).map(cells);
    let values = rows.filter_map(|row| row.get(column)?.parse::<f64>().ok());
    values.max_by(f64::total_cmp).ok_or_else(|| wrong(&path, "no number", "a table"))
}

/// A row for each mode.
pub fn features() -> Result<String> {
    let whole_field = "accuracy_N44W072";
    let default = |column| cell(whole_field, &["1", "aimed-nearest"], column);
    let small_field = "accuracy_mt_washington_256";
    let pyramid = |column| cell("pyramids_mt_washington_256", &["4", "2", "stack"], column);
    let bounced =
        |engine: &str, column| cell("bounce", &["Mt Rainier", "sky", "0.8", "3", engine], column);
    let indirect = |engine: &str| -> Result<String> {
        let (own, noise, all) = (bounced(engine, 5)?, bounced(engine, 6)?, bounced(engine, 7)?);
        Ok(format!(
            "{own} % of the indirect light (reference noise {noise} %), {all} % of all light"
        ))
    };
    let three = |name: &str, exponents: [&[&str]; 3], column| -> Result<String> {
        let all = exponents.map(|begin| cell(name, begin, column));
        let [first, second, third] = all;
        Ok(format!("{}, {}, {} %", first?, second?, third?))
    };
    let rows = [
        (
            "horizons: `--lines exact`",
            "exact",
            format!("worst horizon {}°", cell(small_field, &["exact"], 6)?),
            small_field,
        ),
        (
            "horizons: `--method brute-force`",
            "exact",
            format!("worst horizon {}°", cell(small_field, &["brute"], 6)?),
            small_field,
        ),
        (
            "horizons: sweep, the default",
            "approximate, never too high",
            format!(
                "horizons {}° mean, {}° at 99.9 %; sky light {} %",
                default(2)?,
                default(5)?,
                default(7)?
            ),
            whole_field,
        ),
        (
            "horizons: `--method pyramid`",
            "approximate",
            format!("horizons {}° mean; sky light {} %", pyramid(4)?, pyramid(7)?),
            "pyramids_mt_washington_256",
        ),
        (
            "environment by tables",
            "approximate",
            format!("{} % with 64 azimuths", cell(whole_field, &["64"], 1)?),
            whole_field,
        ),
        (
            "environment by SH, order 4",
            "approximate",
            format!("{} %", cell("soft_converge", &["exact horizons"], 2)?),
            "soft_converge",
        ),
        (
            "sun alone, 0.53° wide, 2 slices, sweep `aimed`",
            "approximate",
            format!(
                "{} %",
                traded(
                    "trade_mountain_sun",
                    "--lines 1 --fuse aimed --precision f32 --sun-azimuths 2"
                )?
            ),
            "trade_mountain_sun",
        ),
        (
            "the same sun, brute-force",
            "exact but for its slices",
            format!("{} %", traded("trade_mountain_sun", "--method brute --sun-azimuths 2")?),
            "trade_mountain_sun",
        ),
        (
            "key light, 3 slices",
            "exact but for its slices",
            format!("{} of the unshadowed light", after("shadow_edge", "3 slices ")?),
            "shadow_edge",
        ),
        (
            "sphere light, 8 slices",
            "exact but for its slices",
            format!("at most {:.2} %", largest("lights", 4)?),
            "lights",
        ),
        (
            "sphere light by SH, order 4",
            "approximate",
            format!("{} %", cell("lights_cones", &["", "surface", "across", "32"], 6)?),
            "lights_cones",
        ),
        ("3 bounces, `sweep`", "approximate", indirect("sweep, picked")?, "bounce"),
        ("3 bounces, `brute-force`", "approximate", indirect("brute")?, "bounce"),
        ("3 bounces, `pyramid`", "approximate", indirect("pyramid")?, "bounce"),
        (
            "Phong specular, exponent 1, 5, 20",
            "approximate",
            three("lobe", [&["1", "plane", "4"], &["5", "plane", "4"], &["20", "plane", "4"]], 3)?,
            "lobe",
        ),
        (
            "Phong specular bounced, exponent 1, 5, 20",
            "approximate",
            three(
                "gloss",
                [
                    &["0", "0.9", "1", "vector", "4"],
                    &["0", "0.9", "5", "vector", "4"],
                    &["0", "0.9", "20", "vector", "4"],
                ],
                5,
            )?,
            "gloss",
        ),
        ("edit of a rectangle", "exact", "the same bits as a whole frame".to_owned(), "edits"),
    ];
    let mut out = String::from("| mode | exact or approximate | measured error |\n|---|---|---|\n");
    for (mode, kind, error, source) in rows {
        writeln!(out, "| {mode} | {kind} | [{error}](benches/results/{source}.txt) |").unwrap();
    }
    Ok(out)
}
