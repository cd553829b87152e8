//! Rows of errors for channels, pictures and horizons, and their bounds.

use std::fmt;

use ridgelight::{Error, Result};
use ridgelight_trade::error::{HorizonError, ImageError};
use ridgelight_trade::flip::FlipError;
use serde::Serialize;
use serde_json::{Value, json};

use super::pairs::{Pair, Pairs, unlike};
use crate::args::CompareArgs;

pub struct Row {
    pub name: String,
    pub text: String,
    pub json: Value,
    /// The values that bounds apply to, each with its unit and perhaps its place.
    figures: Vec<(&'static str, f64, String)>,
    /// Voids in one file only; a picture's are those of its channels.
    mismatched: usize,
}

/// A value above its bound.
#[derive(Serialize)]
pub struct Excess {
    /// None for what no bound allows: voids in one file only, a missing channel.
    bound: Option<&'static str>,
    limit: Option<f64>,
    /// Name of the row.
    of: String,
    /// None for a missing channel.
    found: Option<f64>,
    #[serde(skip)]
    unit: String,
}

impl Excess {
    /// For a channel of the reference that the result lacks.
    pub fn lost(channel: &str) -> Self {
        let (of, unit) = (channel.to_owned(), String::new());
        Self { bound: None, limit: None, of, found: None, unit }
    }
}

impl fmt::Display for Excess {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.bound.zip(self.limit) {
            Some((flag, limit)) => write!(f, "{flag} {limit}")?,
            None => write!(f, "any bound")?,
        }
        match self.found {
            Some(found) => write!(f, ": {} has {found}{}", self.of, self.unit),
            None => write!(f, ": {} is not in A", self.of),
        }
    }
}

pub fn beyond<'a>(
    bounds: &[(&'static str, Option<f64>)],
    rows: impl Iterator<Item = &'a Row>,
) -> Vec<Excess> {
    let mut all = Vec::new();
    for row in rows {
        let mut excess = |bound, limit, found, unit: &str| {
            let (of, unit) = (row.name.clone(), unit.to_owned());
            all.push(Excess { bound, limit, of, found: Some(found), unit });
        };
        if row.mismatched > 0 {
            excess(None, None, row.mismatched as f64, " masked in one only");
        }
        for (flag, found, unit) in &row.figures {
            let limit = bounds.iter().find(|bound| bound.0 == *flag).and_then(|bound| bound.1);
            // NaN exceeds every bound.
            if limit.is_some_and(|limit| found.is_nan() || *found > limit) {
                excess(Some(*flag), limit, *found, unit);
            }
        }
    }
    all
}

pub fn channel(args: &CompareArgs, pairs: &Pairs, pair: &Pair) -> Result<Row> {
    let name = pair.name;
    let e = ImageError::of(pair.a, pair.b, pairs.cols)
        .map_err(|e| nothing(args, &format!("channel {name}"), e))?;
    let both = |x: f64, share: f64| format!("{} ({} %", number(x), number(100.0 * share));
    let text = format!(
        "RMSE {} of the mean)  mean shift {})  99 % {})  worst {}) at row {}, column {}; {} compared, {} masked, {} masked in one only",
        both(e.rmse, e.relative_rmse),
        both(e.mean_shift, e.relative_mean_shift),
        both(e.p99, e.relative_p99),
        both(e.worst, e.relative_worst),
        e.worst_row,
        e.worst_col,
        e.count,
        e.masked,
        e.mismatched
    );
    let json = named("channel", name, &e);
    let unit = " of the mean of B";
    let place = format!("{unit}, at row {}, column {}", e.worst_row, e.worst_col);
    let figures = vec![
        ("--max-rmse", e.relative_rmse, unit.to_owned()),
        ("--max-mean-shift", e.relative_mean_shift.abs(), unit.to_owned()),
        ("--max-p99", e.relative_p99, unit.to_owned()),
        ("--max-worst", e.relative_worst, place),
    ];
    Ok(Row { name: name.to_owned(), text, json, figures, mismatched: e.mismatched })
}

pub fn picture(args: &CompareArgs, pairs: &Pairs, layer: &str, map: &[f32]) -> Result<Row> {
    let name = if layer.is_empty() { "FLIP".to_owned() } else { format!("FLIP of {layer}") };
    let e = FlipError::of(map, pairs.cols).map_err(|e| nothing(args, &name, e))?;
    let [q1, q2, q3] = e.weighted_quartiles;
    let text = format!(
        "mean {:.6}  weighted quartiles {q1:.4} {q2:.4} {q3:.4}  99 % {:.4}  worst {:.4} at row {}, column {}; {} compared, {} masked",
        e.mean, e.p99, e.worst, e.worst_row, e.worst_col, e.count, e.masked
    );
    let json = named("layer", layer, &e);
    let figures = vec![("--max-flip", e.mean, String::new())];
    Ok(Row { name, text, json, figures, mismatched: 0 })
}

pub fn horizons(args: &CompareArgs, pairs: &Pairs) -> Result<Row> {
    let all = |side: fn(&Pair) -> Vec<f32>| -> Vec<f32> {
        pairs.channels.iter().flat_map(side).collect()
    };
    let (a, b) = (all(|pair| pair.a.to_vec()), all(|pair| pair.b.to_vec()));
    let e = HorizonError::of(&a, &b, pairs.rows, pairs.cols)
        .map_err(|e| nothing(args, "horizons", e))?;
    let [azimuth, row, col] = e.worst_at;
    let text = format!(
        "mean {:.5}°  median {:.5}°  99 % {:.4}°  99.9 % {:.4}°  worst {:.4}° at azimuth {azimuth}, row {row}, column {col}; {} compared, {} masked, {} masked in one only",
        e.mean_deg,
        e.median_deg,
        e.p99_deg,
        e.p999_deg,
        e.worst_deg,
        e.count,
        e.masked,
        e.mismatched
    );
    let json = json!(e);
    let place = format!("°, at azimuth {azimuth}, row {row}, column {col}");
    let figures = vec![
        ("--max-median-deg", e.median_deg, "°".to_owned()),
        ("--max-p999-deg", e.p999_deg, "°".to_owned()),
        ("--max-worst-deg", e.worst_deg, place),
    ];
    Ok(Row { name: "horizons".to_owned(), text, json, figures, mismatched: e.mismatched })
}

/// The figures of a channel or layer.
fn named(kind: &str, name: &str, figures: &impl Serialize) -> Value {
    let mut json = json!(figures);
    json[kind] = name.into();
    json
}

/// The error of a channel without shared data, which is the files' fault.
fn nothing(args: &CompareArgs, place: &str, error: Error) -> Error {
    match error {
        Error::Setting { found, expected, .. } => unlike(args, place, found, expected),
        other => other,
    }
}

/// Six decimals, or four and an exponent.
fn number(x: f64) -> String {
    let plain = x == 0.0 || (1e-3..1e6).contains(&x.abs());
    if plain { format!("{x:.6}") } else { format!("{x:.4e}") }
}
