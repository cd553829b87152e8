//! README's list of modes: exact or approximate, and the error that benches/results has of each.

use std::path::PathBuf;

use super::Result;
use super::figures::{RESULTS, cells, fill, result, wrong};

/// Mode | kind | file of benches/results | measured error. `{A;B@2}` is cell 2, counted from 0, of the first row
/// that begins with the cells A and B; `{max@2}` the largest number of column 2; `{after TEXT}` the word
/// after a text.
const MODES: [&str; 17] = [
    "horizons: `--lines exact` | exact | accuracy_mt_washington_256 | worst horizon {exact@6}°",
    "horizons: `--method brute-force` | exact but for rounding | accuracy_mt_washington_256 | worst horizon {brute@6}°",
    "horizons: sweep, the default | approximate, never too high | accuracy_mt_washington_256 | horizons {1;aimed-around@2}° mean, \
     {1;aimed-around@5}° at 99.9 %; sky light {1;aimed-around@7} % with 64 azimuths",
    "horizons: `--method pyramid` | approximate | pyramids_mt_washington_256 | horizons {4;2;stack@4}° mean; sky light \
     {4;2;stack@7} %",
    "environment by tables | approximate | accuracy_mt_washington_256 | {64@1} % with 64 azimuths",
    "environment by SH, order 4 | approximate | soft_converge | {exact horizons@2} %",
    "sun, 0.53° wide, 8 slices: the default | exact but for its slices | suns | at most {max@5} % against brute force in the \
     same slices",
    "the same sun, `--method sweep --fuse aimed-nearest` | approximate | suns | {Mt Washington, 256²;plane;12@3} % at 12° over a mountain",
    "key light, 3 slices | exact but for its slices | shadow_edge | {after 3 slices } of the unshadowed light",
    "sphere light, 8 slices | exact but for its slices | lights | at most {max@4} %",
    "sphere light by SH, order 4 | approximate | lights_cones | {;surface;across;32@6} %",
    "3 bounces, `sweep` | approximate | bounce | {Mt Rainier;sky;0.8;3;sweep, picked@5} % of the indirect light (noise \
     {Mt Rainier;sky;0.8;3;sweep, picked@6} %), {Mt Rainier;sky;0.8;3;sweep, picked@7} % of all light",
    "3 bounces, `brute-force` | approximate | bounce | {Mt Rainier;sky;0.8;3;brute-force@5} % of the indirect light (noise \
     {Mt Rainier;sky;0.8;3;brute-force@6} %), {Mt Rainier;sky;0.8;3;brute-force@7} % of all light",
    "3 bounces, `pyramid` | approximate | bounce | {Mt Rainier;sky;0.8;3;pyramid@5} % of the indirect light (noise \
     {Mt Rainier;sky;0.8;3;pyramid@6} %), {Mt Rainier;sky;0.8;3;pyramid@7} % of all light",
    "Phong specular, exponent 5, 20, 1,000 | approximate | lobe | {5;32;slices@4}, {20;32;slices@4}, {1000;32;slices@4} %",
    "with 2 bounces, exponent 5 | approximate | gloss | {0.4;0.5;5;pyramid;vector;4@8} % of all light; brute force \
     {0.4;0.5;5;brute-force;vector;6@8} %",
    "edit of a rectangle | exact | edits | the same bits as a whole frame",
];

/// The figure of a place between braces.
fn figure(file: &str, place: &str) -> Result<String> {
    let (text, _) = result(&format!("{file}.txt"))?;
    let missing = || wrong(&PathBuf::from(RESULTS).join(format!("{file}.txt")), "nothing", place);
    if let Some(before) = place.strip_prefix("after ") {
        let rest = text.rsplit_once(before).ok_or_else(missing)?.1;
        return Ok(rest.split([' ', ',']).next().unwrap_or_default().to_owned());
    }
    let (begin, column) = place.split_once('@').ok_or_else(missing)?;
    let column: usize = column.parse().map_err(|_| missing())?;
    let mut rows = text.lines().filter(|line| line.starts_with('|')).map(cells);
    if begin == "max" {
        let values = rows.filter_map(|row| row.get(column)?.parse::<f64>().ok());
        // Three decimals below 0.01, so that small errors do not print as 0.
        let digits = |v: f64| if v < 0.01 { format!("{v:.3}") } else { format!("{v:.2}") };
        return values.max_by(f64::total_cmp).map(digits).ok_or_else(missing);
    }
    let begin: Vec<&str> = begin.split(';').collect();
    let row = rows.find(|row| row.starts_with(&begin)).ok_or_else(missing)?;
    let value = row.get(column).ok_or_else(missing)?;
    Ok(value.split(" (").next().unwrap_or_default().to_owned())
}

/// A row for each mode.
pub fn features() -> Result<String> {
    let mut out = String::from("| mode | exact or approximate | measured error |\n|---|---|---|\n");
    for mode in MODES {
        let parts: Vec<&str> = mode.splitn(4, " | ").collect();
        let [mode, kind, file, error] = parts[..] else { unreachable!("four parts: {mode}") };
        let measured = fill(error, |place| figure(file, place))?;
        out += &format!("| {mode} | {kind} | [{measured}](benches/results/{file}.txt) |\n");
    }
    Ok(out)
}
