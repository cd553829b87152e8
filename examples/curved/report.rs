//! What was found on each base: tables and curves.

use ridgelight::scene::OcclusionChange;

use super::STEPS;
use super::light::BOUNCES;
use super::plot::{self, Curve, Panel};

/// Shares of something wrong, percent, on a base.
pub struct Row {
    pub curvature: f64,
    /// Share of lights that arrive.
    pub lit: f64,
    /// By directions as they are and adapted; by flat ellipses, between five, and fitted here.
    pub shadows: [f64; 5],
    /// Of light scattered once and several times.
    pub light: [Scattered; 2],
    /// Off the device several times, RMSE; of bases that it does not refuse.
    pub device: Option<f64>,
    /// What [`Curvature::check`] finds.
    pub changed: OcclusionChange,
    pub refused: Option<String>,
}

pub struct Scattered {
    /// On the base, by rays, of each compared sample; and turned and weighed.
    pub truth: Vec<f64>,
    pub weighed: Vec<f64>,
    /// Their sum over that on the flat base.
    pub over_flat: f64,
    /// RMSE by directions as they are, turned, and turned and weighed.
    pub off: [f64; 3],
}

/// Percent of the mean.
pub fn rmse(found: &[f64], truth: &[f64]) -> f64 {
    let squares: f64 = found.iter().zip(truth).map(|(f, t)| (f - t).powi(2)).sum();
    let count = truth.len() as f64;
    100.0 * (squares / count).sqrt() / (truth.iter().sum::<f64>() / count)
}

/// RMSE of light between that of three bases, those that ellipses are fitted at, as a base that bends on along an object has it.
fn between(rows: &[Row], row: &Row, k: usize) -> f64 {
    let end = if row.curvature < 0.0 { -STEPS[1] } else { STEPS[0] };
    let of = |curvature: f64| {
        let at = rows.iter().find(|r| r.curvature == curvature).expect("a row of each");
        &at.light[k].weighed
    };
    let share = row.curvature / end;
    let mixed =
        of(0.0).iter().zip(of(end)).map(|(flat, end)| (flat + share * (end - flat)).max(0.0));
    rmse(&mixed.collect::<Vec<_>>(), &row.light[k].truth)
}

pub fn table(rows: &[Row]) {
    let radius = |row: &Row| match row.curvature {
        0.0 => "flat".to_owned(),
        k => format!("{:+.0}", 1.0 / k),
    };
    let told = |row: &Row| if row.refused.is_some() { "refused" } else { "" };
    println!(
        "| radius, cells | lit, % | wrong by flat directions, % | adapted | said, of lights | by flat ellipses | between five | fitted here | |\n\
         |---|---|---|---|---|---|---|---|---|"
    );
    for row in rows {
        let [by_flat, adapted, ellipses @ ..] = row.shadows.map(|v| format!("{v:.2}"));
        println!(
            "| {} | {:.1} | {by_flat} | {adapted} | {:.2} | {} | {} |",
            radius(row),
            row.lit,
            100.0 * row.changed.shadows,
            ellipses.join(" | "),
            told(row)
        );
    }
    println!(
        "\n| radius, cells | scattered once, over flat | off by flat directions, % | turned | turned and weighed | between three | said, of light | \
         up to {} times, over flat | off by flat directions, % | turned | turned and weighed | between three | device | |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|",
        BOUNCES[1]
    );
    for row in rows {
        let [once, more] = [0, 1].map(|k| {
            let Scattered { over_flat, off, .. } = &row.light[k];
            let off = off.map(|v| format!("{v:.2}")).join(" | ");
            format!("{over_flat:.3} | {off} | {:.2}", between(rows, row, k))
        });
        let device = row.device.map_or(String::new(), |off| format!("{off:.2}"));
        println!(
            "| {} | {once} | {:.2} | {more} | {device} | {} |",
            radius(row),
            100.0 * row.changed.light,
            told(row)
        );
    }
}

/// What is wrong over curvature, outwards and inwards.
pub fn picture(rows: &[Row]) -> String {
    let panel = |title: &str, is_out: bool, is_light: bool| {
        let own: Vec<&Row> =
            rows.iter().filter(|r| r.curvature != 0.0 && (r.curvature > 0.0) == is_out).collect();
        let curve = |name: &str, colour: usize, is_floor: bool, of: &dyn Fn(&Row) -> f64| Curve {
            name: name.into(),
            points: own.iter().map(|r| [1.0 / r.curvature.abs(), of(r)]).collect(),
            colour,
            is_floor,
        };
        let curves = if is_light {
            vec![
                curve("directions of the flat field", 0, true, &|r| r.light[0].off[0]),
                curve("turned", 1, false, &|r| r.light[0].off[1]),
                curve("turned and weighed", 2, false, &|r| r.light[0].off[2]),
                curve("up to 3 times, flat directions", 3, true, &|r| r.light[1].off[0]),
                curve("up to 3 times, turned and weighed", 3, false, &|r| r.light[1].off[2]),
            ]
        } else {
            vec![
                curve("directions of the flat field", 0, true, &|r| r.shadows[0]),
                curve("adapted directions", 0, false, &|r| r.shadows[1]),
                curve("the flat field's ellipse", 3, true, &|r| r.shadows[2]),
                curve("between five ellipses", 3, false, &|r| r.shadows[3]),
            ]
        };
        let y = if is_light { "scattered light, RMSE, %" } else { "lights wrong, %" };
        let told = own.iter().filter(|r| r.refused.is_none()).map(|r| 1.0 / r.curvature.abs());
        let title = format!("{title}; refused below {:.0}", told.fold(f64::MAX, f64::min));
        Panel { title, x: "radius of the base, cells", y, curves }
    };
    plot::svg(&[
        panel("Shadows, bent outwards", true, false),
        panel("Shadows, bent inwards", false, false),
        panel("Scattered, outwards", true, true),
        panel("Scattered, inwards", false, true),
    ])
}
