//! The light across the shadow edge of a wall under a key light, without and with its restriction in
//! elevation (NS09, supplement §1), beside the reference: a table and a plot.
//!
//! Ours: sums over 3 slices (NS09's number) and over 8, the default. As in NS09: horizons in 3 azimuths from
//! end to end, blended B-splines of normalised Legendre coefficients, SH of order 4, a clamped cosine. The
//! reference: path-traced. All as shares of the light of free ground.

use std::f64::consts::PI;

use ridgelight::Result;
use ridgelight::basis::zonal::clamped_cosine;
use ridgelight::gpu::Headless;
use ridgelight::plan::REFERENCE_BATCH;
use ridgelight::scene::{Border, KeyLight, Lights, Quality, Scene, Surface};
use ridgelight_cpu::basis::azimuth::Blend;
use ridgelight_cpu::basis::key;
use ridgelight_cpu::basis::turned;
use ridgelight_cpu::oracle::Oracle;

use crate::common::args::Args;
use crate::common::frames::{Colours, drawn, open, rms, traced};
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

/// Shares of the light of free ground along the middle row, behind the wall: 3 slices, 8 slices, SH of
/// order 4, the reference and its standard error.
type Profile = [Vec<f64>; 5];

fn profile(gpu: &mut Headless, elevations: [f64; 2]) -> Result<Profile> {
    let key = KeyLight {
        azimuth_rad: PI,
        width_rad: 20_f64.to_radians(),
        elevations_rad: elevations.map(f64::to_radians),
        radiance: [1.0; 3],
    };
    let scene = Scene {
        field: inputs::field(ROWS, COLS, |_, col| if col == WALL { HEIGHT_M } else { 0.0 })?,
        surface: Surface::default(),
        lights: Lights { keys: vec![key], ..Lights::default() },
    };
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
    let by_harmonics = |col: usize| {
        let azimuths = key::azimuths(&key, AZIMUTHS);
        let horizons: Vec<f64> =
            azimuths.iter().map(|a| oracle.elevation_rad(ROWS / 2, col, *a)).collect();
        let visible = key::visible_nlp(&key, ORDER, Blend::BSpline, &horizons);
        visible.iter().zip(&cosine).map(|(a, b)| a * b).sum::<f64>() / PI / free
    };
    let harmonics = columns().map(by_harmonics).collect();
    let [reference, error] = traced(gpu, &scene, 0, BATCHES)?.map(|light| middle(&light));
    Ok([three, eight, harmonics, reference, error])
}

/// Behind the wall, in its heights.
fn distance(i: usize) -> f64 {
    (i + 2) as f64 / HEIGHT_M
}

fn table(name: &str, profile: &Profile) {
    println!("\n{name}\n\nwall heights  3 slices  8 slices  order 4  reference        ±");
    let count = profile[0].len();
    // Every second grid point near the wall, every tenth farther away.
    for i in (0..count).filter(|i| if *i < 40 { i % 2 == 0 } else { i % 10 == 8 }) {
        let [three, eight, harmonics, reference, error] = [0, 1, 2, 3, 4].map(|k| profile[k][i]);
        println!(
            "{:12.1} {three:9.4} {eight:9.4} {harmonics:8.4} {reference:10.4} {error:8.4}",
            distance(i)
        );
    }
    let [three, eight, harmonics] =
        [0, 1, 2].map(|k| rms(profile[k].iter().zip(&profile[3]).map(|(a, b)| a - b)));
    println!(
        "RMSE over all {count} grid points: 3 slices {three:.4}, 8 slices {eight:.4}, order 4 {harmonics:.4}"
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
    let axes = ["distance behind the wall, in its heights", "share of the light of free ground"];
    Panel { linear: Some([10.0, 1.2]), ..Panel::new(name, axes, curves) }
}

pub fn run(mut args: Args) -> Outcome {
    let output = args.path("-o")?;
    args.end()?;
    let mut gpu = open()?;
    println!(
        "Wall {HEIGHT_M} m high on level ground, key light behind it, 20° wide; shares of the light of free ground;\n\
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
    plot::write(output.as_deref(), &panels)
}
