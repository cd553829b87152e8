//! The page of all results (`out/extremes.md`), and its completeness.

use std::fmt::Write as _;

use super::{Case, Method, Outcome, Row, inputs};

/// The results of one device: a row for every case under every method.
pub struct Column {
    pub name: String,
    pub driver: String,
    pub rows: Vec<Row>,
}

/// The text before the tables.
pub const ABOUT: &str = "\
# The extremes

Every extreme at which numbers must hold, put to every method: what is expected and why, the worst error
found, the bound that it must keep, and the error as a share of the bound. Made by `tools/extremes`; the
test `extremes` of `tests/gpu` holds every row to its bound on the driver at hand.

Angles in radians; lights in exit radiance. Errors are distances from what is expected; *worst* is the
largest of all values, *share* the largest of error over bound, which may stand elsewhere.
Methods are named by their lines' distance in cells and their fuse (`--lines`, `--fuse`), hull and
precision where they are not the default's. ε = 2^-24; m azimuths. *The method's* bound of a
horizon, at the distance d of what makes it, with heights up to H:

| method | bound on the slope |
|---|---|
| brute | (2 + 76 + 208) ε H / d: heights in, march, device |
| exact | (2 + 540 + 40 (1 + march / lane)) ε H / d along the grid vector (march, lane) |
| all others | (2 + 38 + 256) ε H / d and 6 ε of the slope: heights in, sweep, fuse |
| pyramid | on planes (2 + 144) ε H / d: heights in, levels; elsewhere what is expected is not the ground truth but what the CPU reference finds in f32 from the same heights, within the angle (232 H + 12 R) ε / step and 6e-6 of the steepest that it may be, R / step or 1, R highest less lowest |
| f16 besides | 2^-10 of the slope and 2^-24; slopes beyond 65 504 are that |
| packed besides | 2^-9 H / d and 100 ε H / d |
| harmonics | as all others: they change an environment's light alone, by what f32 may do to their *series* (`crates/cpu/src/sh/harmonics.rs`); by *nlp* and *table* what is expected of an environment is what the series keeps of it, in f64 |

*Not judged*: a pyramid's levels are nearly level somewhere whatever they are made from, and the rounding of 1e6
cells alone turns an angle there by anything. In each other row a bound is below a tenth of the largest that is expected in it.

Indirect light (`--bounces`) has three engines of its own: brute force, walks over what sweeps along lines have
met, and pyramids; each with the azimuths of `--bounce-azimuths`.

Visible points are numbers of texels: right, or wrong. Ellipses of the sky and light that is scattered are found from them.

Bounds on a slope are each turned into an angle by 1 / (1 + slope²), and the arc tangent's 4.4e-7 of slopes below 1.
Derived in `crates/cpu/src/tolerance.rs` and `tests/gpu/extremes/suite/methods.rs`.
";

/// The text before the refused inputs.
pub const INPUTS: &str = "\n## Inputs that are refused\n\n| input | what is said |\n|---|---|\n";

/// In place of a bound, and of the share of it.
pub const UNJUDGED: &str = "not judged";

/// The beginning of a case's table.
pub fn heading(case: &Case) -> String {
    let Case { name, expected, bound, .. } = case;
    format!("\n## {name}\n\nExpected: {expected}.\nBound: {bound}.\n")
}

/// The row of a refused input.
pub fn refused(name: &str, sentence: &str) -> String {
    format!("| {name} | {sentence} |")
}

/// The whole page.
pub fn text(cases: &[Case], methods: &[Method], found: &[Column]) -> String {
    let mut out = ABOUT.to_owned();
    for device in found {
        writeln!(out, "\n{}: *{}*", device.name, device.driver).unwrap();
    }
    for (c, case) in cases.iter().enumerate() {
        writeln!(out, "{}", heading(case)).unwrap();
        out += "| method |";
        found.iter().for_each(|f| write!(out, " {}: worst | bound | share |", f.name).unwrap());
        writeln!(out, "\n|---|{}", "---|---|---|".repeat(found.len())).unwrap();
        let of_case = |(_, m): &(usize, &Method)| m.about == case.about;
        for (m, method) in methods.iter().enumerate().filter(of_case) {
            write!(out, "| {} |", method.name).unwrap();
            for device in found {
                let row = device.rows.iter().find(|r| (r.case, r.method) == (c, m));
                let outcome = &row.expect("a row for every case under every method").outcome;
                out += &cells(outcome, (case.unjudged)(method));
            }
            out.push('\n');
        }
    }
    out += INPUTS;
    for (name, offer, _) in inputs::ALL {
        writeln!(out, "{}", refused(name, &inputs::said(*offer))).unwrap();
    }
    out
}

fn cells(outcome: &Outcome, unjudged: bool) -> String {
    match outcome {
        Outcome::Refused(said) => format!(" refused: *{said}* | | |"),
        Outcome::Measured { largest_error, .. } if unjudged => {
            format!(" {largest_error:.2e} | {UNJUDGED} | {UNJUDGED} |")
        }
        Outcome::Measured { worst, largest_error, .. } => {
            format!(" {largest_error:.2e} | {:.2e} | {:.3} |", worst.bound, worst.ratio())
        }
    }
}

/// The missing parts of a page: cases with their expected values, rows of methods with a figure or a refusal in every
/// column, refused inputs.
pub fn missing(page: &str, cases: &[Case], methods: &[Method]) -> Vec<String> {
    let mut missing = Vec::new();
    if !page.starts_with(ABOUT) {
        missing.push("the text before the tables".to_owned());
    }
    for case in cases {
        let Some((_, rest)) = page.split_once(&heading(case)) else {
            missing.push(case.name.clone());
            continue;
        };
        let table = rest.split("\n## ").next().unwrap_or_default();
        for method in methods.iter().filter(|m| m.about == case.about) {
            let begin = format!("| {} | ", method.name);
            let row = table.lines().find_map(|l| l.strip_prefix(&begin));
            let refusal = (case.refuses)(method);
            let holds = row.is_some_and(|r| match refusal {
                Some(sentence) => r.contains(sentence),
                None => r.split(" | ").map(|cell| cell.trim_end_matches(" |")).all(|cell| {
                    cell.parse::<f64>().is_ok() || (cell == UNJUDGED && (case.unjudged)(method))
                }),
            });
            if !holds {
                missing.push(format!("{}, {}", case.name, method.name));
            }
        }
    }
    if !page.contains(INPUTS) {
        missing.push("the inputs that are refused".to_owned());
    }
    let inputs = inputs::ALL.iter().map(|(name, _, sentence)| refused(name, sentence));
    missing.extend(inputs.filter(|row| !page.lines().any(|l| l == row)));
    missing
}
