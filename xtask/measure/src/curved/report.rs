//! Tables and curves of all bases.

use ridgelight::Result;
use ridgelight::scene::OcclusionChange;

use super::STEPS;
use super::light::BOUNCES;
use crate::common::frames::error_of;
use crate::common::plot::{self, Panel, Style};
use crate::common::{cells, head};

/// Errors on a base, percent.
pub struct Row {
    pub curvature: f64,
    /// Share of lights that arrive.
    pub lit: f64,
    /// By directions unchanged and adapted; by flat ellipses, between five, and fitted here.
    pub shadows: [f64; 5],
    /// Of light scattered once and several times.
    pub light: [Scattered; 2],
    /// Of the device several times; of bases that it does not refuse.
    pub device: Option<f64>,
    /// The prediction of `Curvature::check`.
    pub changed: OcclusionChange,
    pub refused: Option<String>,
}

pub struct Scattered {
    /// Of each compared grid point: path-traced, and by rotated and reweighted directions.
    pub reference: Vec<f64>,
    pub reweighted: Vec<f64>,
    /// The reference's sum over that on the flat base.
    pub over_flat: f64,
    /// By directions unchanged, rotated, and rotated and reweighted.
    pub errors: [f64; 3],
}

/// The error of light interpolated between the three bases that ellipses are fitted at, as on an object
/// whose base varies.
fn between(rows: &[Row], row: &Row, k: usize) -> Result<f64> {
    let end = if row.curvature < 0.0 { -STEPS[1] } else { STEPS[0] };
    let of = |curvature: f64| {
        let at = rows.iter().find(|r| r.curvature == curvature).expect("a row of each");
        &at.light[k].reweighted
    };
    let (share, pairs) = (row.curvature / end, of(0.0).iter().zip(of(end)));
    let mixed: Vec<f64> = pairs.map(|(flat, end)| (flat + share * (end - flat)).max(0.0)).collect();
    error_of(&mixed, &row.light[k].reference)
}

pub fn table(rows: &[Row]) -> Result<()> {
    let radius = |row: &Row| match row.curvature {
        0.0 => "flat".to_owned(),
        k => format!("{:+.0}", 1.0 / k),
    };
    let refused = |row: &Row| if row.refused.is_some() { "refused" } else { "" };
    head(
        "| radius, cells | lit, % | wrong by flat directions, % | adapted | predicted, of lights | by flat ellipses | between five | fitted here | |",
    );
    for row in rows {
        let [flat, adapted, ellipses @ ..] = row.shadows;
        let all = [flat, adapted, 100.0 * row.changed.shadows].into_iter().chain(ellipses);
        println!("| {} | {:.1} | {} | {} |", radius(row), row.lit, cells(2, all), refused(row));
    }
    println!();
    head(&format!(
        "| radius, cells | scattered once, over flat | error by flat directions, % | rotated | rotated and reweighted | between three | predicted, of light | \
         up to {} times, over flat | error by flat directions, % | rotated | rotated and reweighted | between three | device | |",
        BOUNCES[1]
    ));
    for row in rows {
        let part = |k: usize| -> Result<String> {
            let Scattered { over_flat, errors, .. } = &row.light[k];
            let errors = errors.iter().copied().chain([between(rows, row, k)?]);
            Ok(format!("{over_flat:.3} | {}", cells(2, errors)))
        };
        let (radius, light) = (radius(row), 100.0 * row.changed.light);
        let device = row.device.map_or(String::new(), |error| format!("{error:.2}"));
        println!(
            "| {radius} | {} | {light:.2} | {} | {device} | {} |",
            part(0)?,
            part(1)?,
            refused(row)
        );
    }
    Ok(())
}

/// Name, colour, style and value of a curve.
type Line = (&'static str, usize, Style, fn(&Row) -> f64);

const SHADOWS: [Line; 4] = [
    ("directions of the flat field", 0, Style::Dashes, |r| r.shadows[0]),
    ("adapted directions", 0, Style::Dotted, |r| r.shadows[1]),
    ("the flat field's ellipse", 3, Style::Dashes, |r| r.shadows[2]),
    ("between five ellipses", 3, Style::Dotted, |r| r.shadows[3]),
];
const LIGHT: [Line; 5] = [
    ("directions of the flat field", 0, Style::Dashes, |r| r.light[0].errors[0]),
    ("rotated", 1, Style::Dotted, |r| r.light[0].errors[1]),
    ("rotated and reweighted", 2, Style::Dotted, |r| r.light[0].errors[2]),
    ("up to 3 times, flat directions", 3, Style::Dashes, |r| r.light[1].errors[0]),
    ("up to 3 times, rotated and reweighted", 3, Style::Dotted, |r| r.light[1].errors[2]),
];

/// Errors over curvature, outwards and inwards.
pub fn picture(rows: &[Row]) -> Vec<Panel> {
    let panel = |title: &str, is_out: bool, y, lines: &[Line]| {
        let is_own = |r: &&Row| r.curvature != 0.0 && (r.curvature > 0.0) == is_out;
        let own = || rows.iter().filter(is_own);
        let curve = |(name, colour, style, value): &Line| {
            let points = own().map(|r| [1.0 / r.curvature.abs(), value(r)]).collect();
            plot::curve(name, *colour, *style, points)
        };
        let held = own().filter(|r| r.refused.is_none()).map(|r| 1.0 / r.curvature.abs());
        let title = format!("{title}; refused below {:.0}", held.fold(f64::MAX, f64::min));
        Panel::new(title, ["radius of the base, cells", y], lines.iter().map(curve).collect())
    };
    let (shadows, light) = ("lights wrong, %", "scattered light, RMSE, %");
    vec![
        panel("Shadows, bent outwards", true, shadows, &SHADOWS),
        panel("Shadows, bent inwards", false, shadows, &SHADOWS),
        panel("Scattered, outwards", true, light, &LIGHT),
        panel("Scattered, inwards", false, light, &LIGHT),
    ]
}
