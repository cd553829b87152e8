//! The light across the shadow edge of a wall under a key light, with and without its restriction in
//! elevation (NS09, supplement §1), against the path-traced reference: a table and a plot.
//!
//! Ours: sums over 3 slices (NS09's number) and over 8, the default. As in NS09: horizons in 3 azimuths
//! across the light, blended B-splines of normalised Legendre coefficients, SH of order 4, a clamped
//! cosine. All as shares of the light of unshadowed ground.

use std::f64::consts::PI;

use ridgelight::Result;
use ridgelight::basis::zonal::clamped_cosine;
use ridgelight::gpu::Headless;
use ridgelight::plan::REFERENCE_BATCH;
use ridgelight::scene::{Border, KeyLight, Lights, Quality};
use ridgelight_cpu::basis::azimuth::Blend;
use ridgelight_cpu::basis::key;
use ridgelight_cpu::basis::turned;
use ridgelight_cpu::oracle::Oracle;

use crate::common::args::Args;
use crate::common::frames::{Colours, drawn, rms, traced};
use crate::common::plot::{self, Panel, Style, curve};
use crate::common::{Outcome, inputs};

/// Grid points, one metre apart; where the wall stands, and how high it is.
const ROWS: usize = 61;
const COLS: usize = 121;
const WALL: usize = 20;
const HEIGHT_M: f64 = 10.0;
const BATCHES: u32 = 128;
/// NS09's order, and its azimuths across a key light.
const ORDER: usize = 4;
const AZIMUTHS: usize = 3;

/// From straight behind the wall, 20° wide; elevations in degrees.
const LIGHTS: [(&str, [f64; 2]); 2] = [
    ("0° to 90°: no restriction in elevation", [0.0, 90.0]),
    ("20° to 30°: restricted in elevation", [20.0, 30.0]),
];

/// Along the middle row, behind the wall: 3 slices, 8 slices, SH of order 4, the reference and its
/// standard error.
type Profile = [Vec<f64>; 5];

fn profile(gpu: &mut Headless, elevations: [f64; 2]) -> Result<Profile> {
    let key = KeyLight {
        azimuth_rad: PI,
        width_rad: 20_f64.to_radians(),
        elevations_rad: elevations.map(f64::to_radians),
        radiance: [1.0; 3],
    };
    let field = inputs::field(ROWS, COLS, |_, col| if col == WALL { HEIGHT_M } else { 0.0 })?;
    let scene = inputs::lit_by(field, Lights { keys: vec![key], ..Lights::default() });
    let free = key.level_irradiance() / PI;
    // The wall's own foot leans: its slope ends a cell away.
    let columns = || WALL + 2..COLS;
    let middle = |light: &Colours| -> Vec<f64> {
        columns().map(|col| light[ROWS / 2 * COLS + col][0] / free).collect()
    };
    let mut ours = |sun_azimuths: u32| -> Result<Vec<f64>> {
        let quality = Quality { sun_azimuths, ..Quality::default() };
        Ok(middle(&drawn(gpu, &scene, &quality, 0)?.light))
    };
    let (three, eight) = (ours(3)?, ours(8)?);
    let oracle = Oracle::new(&scene.field, Border::Plane);
    let cosine = turned(&clamped_cosine(ORDER), glam::DVec3::Z);
    let by_sh = |col: usize| {
        let azimuths = key::azimuths(&key, AZIMUTHS);
        let horizons: Vec<f64> =
            azimuths.iter().map(|a| oracle.elevation_rad(ROWS / 2, col, *a)).collect();
        let visible = key::visible_nlp(&key, ORDER, Blend::BSpline, &horizons);
        visible.iter().zip(&cosine).map(|(a, b)| a * b).sum::<f64>() / PI / free
    };
    let sh = columns().map(by_sh).collect();
    let [reference, deviation] = traced(gpu, &scene, 0, BATCHES)?.map(|light| middle(&light));
    Ok([three, eight, sh, reference, deviation])
}

/// From the wall, in wall heights.
fn distance(i: usize) -> f64 {
    (i + 2) as f64 / HEIGHT_M
}

fn table(name: &str, profile: &Profile) {
    println!("\n{name}\n\nwall heights  3 slices  8 slices  order 4  reference        ±");
    let count = profile[0].len();
    // Every second grid point near the wall, every tenth farther away.
    for i in (0..count).filter(|i| if *i < 40 { i % 2 == 0 } else { i % 10 == 8 }) {
        let [three, eight, sh, reference, deviation] = profile.each_ref().map(|all| all[i]);
        let x = distance(i);
        println!("{x:12.1} {three:9.4} {eight:9.4} {sh:8.4} {reference:10.4} {deviation:8.4}");
    }
    let [three, eight, sh] =
        [0, 1, 2].map(|k| rms(profile[k].iter().zip(&profile[3]).map(|(a, b)| a - b)));
    println!(
        "RMSE over all {count} grid points: 3 slices {three:.4}, 8 slices {eight:.4}, order 4 {sh:.4}"
    );
}

fn panel(name: &str, profile: &Profile) -> Panel {
    let points = |k: usize, step: usize| {
        let near = (0..profile[k].len()).filter(|i| distance(*i) <= 10.0).step_by(step);
        near.map(|i| [distance(i), profile[k][i]]).collect()
    };
    let curves = vec![
        curve("reference (path-traced)", 4, Style::Circles, points(3, 2)),
        curve("ours, 3 slices", 0, Style::Line, points(0, 1)),
        curve("SH of order 4, as in NS09", 1, Style::Dashes, points(2, 1)),
    ];
    let axes =
        ["distance behind the wall, in wall heights", "share of the light of unshadowed ground"];
    Panel { linear: Some([10.0, 1.2]), ..Panel::new(name, axes, curves) }
}

pub fn run(mut args: Args) -> Outcome {
    let output = args.path("-o")?;
    let mut gpu = args.open()?;
    println!(
        "Wall {HEIGHT_M} m high on level ground, key light behind it, 20° wide; shares of the light of unshadowed ground;\n\
         reference: {} paths per grid point; {}",
        BATCHES * REFERENCE_BATCH,
        gpu.report().name
    );
    let mut panels = Vec::new();
    for (name, elevations) in LIGHTS {
        let profile = profile(&mut gpu, elevations)?;
        table(name, &profile);
        panels.push(panel(name, &profile));
    }
    Ok(plot::write(output.as_deref(), &panels)?)
}
