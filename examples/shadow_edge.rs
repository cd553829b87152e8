//! The light across the shadow edge of a wall under a key light, without and with its restriction in
//! elevation (Nowrouzezahrai & Snyder 2009, supplement §1), beside the reference: a table on standard output
//! and a picture.
//!
//! `cargo run --release --example shadow_edge -- [-o PICTURE.svg]`
//!
//! Ours: sums over 3 slices (NS09's number) and over 8, the default. As the paper has it: horizons in 3
//! azimuths from end to end, blended B-splines of normalised Legendre coefficients, harmonics of order 4,
//! a clamped cosine. The reference: light paths. All as shares of the light of free ground.

#[path = "shared/traced.rs"]
mod traced;

use std::fmt::Write as _;
use std::path::Path;

use ridgelight::Result;
use ridgelight::basis::zonal::clamped_cosine;
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture, REFERENCE_BATCH};
use ridgelight::scene::{Border, HeightField, KeyLight, Lights, Quality, Scene, Surface};
use ridgelight_cpu::basis::azimuth::Blend;
use ridgelight_cpu::basis::key::KeyHarmonics;
use ridgelight_cpu::basis::turned;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_io as files;
use std::f64::consts::PI;
use traced::traced;

/// Samples of the field, one metre apart; where its wall stands, and how high it is.
const ROWS: usize = 61;
const COLS: usize = 121;
const WALL: usize = 20;
const HEIGHT_M: f64 = 10.0;
/// Batches of light paths.
const BATCHES: u32 = 128;
/// Order of the paper's harmonics, and its azimuths across a key light.
const ORDER: usize = 4;
const AZIMUTHS: usize = 3;

/// From straight behind the wall, 20° wide.
fn key(elevations: [f64; 2]) -> KeyLight {
    KeyLight {
        azimuth_rad: PI,
        width_rad: 20_f64.to_radians(),
        elevations_rad: elevations.map(f64::to_radians),
        radiance: [1.0; 3],
    }
}

/// Shares of the light of free ground along the middle row, behind the wall.
struct Profile {
    three: Vec<f64>,
    eight: Vec<f64>,
    harmonics: Vec<f64>,
    reference: Vec<f64>,
    error: Vec<f64>,
}

fn profile(gpu: &mut Headless, key: KeyLight) -> Result<Profile> {
    let height = |i: usize| if i % COLS == WALL { HEIGHT_M } else { 0.0 };
    let heights: Vec<f64> = (0..ROWS * COLS).map(height).collect();
    let scene = Scene {
        field: HeightField::new(ROWS, COLS, &heights, [1.0; 2], None)?,
        surface: Surface::default(),
        lights: Lights { keys: vec![key], ..Lights::default() },
    };
    let free = key.level_irradiance() / PI;
    // The wall's own foot leans: its slope ends a sample away.
    let columns = || WALL + 2..COLS;
    let middle = |values: &[f32], channels: usize| -> Vec<f64> {
        let at = |col: usize| f64::from(values[(ROWS / 2 * COLS + col) * channels]);
        columns().map(|col| at(col) / free).collect()
    };
    let limits = gpu.report().limits;
    let mut ours = |sun_azimuths: u32| -> Result<Vec<f64>> {
        let quality = Quality { sun_azimuths, ..Quality::default() };
        let plan = plan::picture(&scene, &quality, &limits, Picture::default())?;
        let heights = scene.field.heights_m();
        let pixels = gpu.with_frame(plan, &[heights], |gpu, frame| {
            gpu.draw(frame)?;
            gpu.pixels(frame, 0)
        })?;
        Ok(middle(&pixels.values, pixels.channels))
    };
    let (three, eight) = (ours(3)?, ours(8)?);
    let oracle = Oracle::new(&scene.field, Border::Plane);
    let cosine = turned(&clamped_cosine(ORDER), glam::DVec3::Z);
    let by_harmonics = |col: usize| {
        let azimuths = key.azimuths(AZIMUTHS);
        let horizons: Vec<f64> =
            azimuths.iter().map(|a| oracle.elevation_rad(ROWS / 2, col, *a)).collect();
        let seen = key.visible_nlp(ORDER, Blend::BSpline, &horizons);
        seen.iter().zip(&cosine).map(|(a, b)| a * b).sum::<f64>() / PI / free
    };
    let [reference, error] = traced(gpu, &scene, 0, BATCHES)?.map(|light| middle(&light, 4));
    Ok(Profile { three, eight, harmonics: columns().map(by_harmonics).collect(), reference, error })
}

/// Behind the wall, in its heights.
fn distance(i: usize) -> f64 {
    (i + 2) as f64 / HEIGHT_M
}

fn table(profiles: &[(&str, Profile)], device: &str) -> String {
    let mut text = format!(
        "Wall {HEIGHT_M} m high on level ground, key light behind it, 20° wide; shares of the light of free ground;\n\
         reference: {} light paths a sample; {device}\n",
        BATCHES * REFERENCE_BATCH
    );
    for (name, profile) in profiles {
        let _ = writeln!(
            text,
            "\n{name}\n\nwall heights  3 slices  8 slices  order 4  reference        ±"
        );
        // Every second sample near the wall, every tenth farther away.
        for i in (0..profile.three.len()).filter(|i| if *i < 40 { i % 2 == 0 } else { i % 10 == 8 })
        {
            let Profile { three, eight, harmonics, reference, error } = profile;
            let _ = writeln!(
                text,
                "{:12.1} {:9.4} {:9.4} {:8.4} {:10.4} {:8.4}",
                distance(i),
                three[i],
                eight[i],
                harmonics[i],
                reference[i],
                error[i]
            );
        }
        let off = |ours: &[f64]| {
            let squares = ours.iter().zip(&profile.reference).map(|(a, b)| (a - b).powi(2));
            (squares.sum::<f64>() / ours.len() as f64).sqrt()
        };
        let [three, eight, harmonics] =
            [&profile.three, &profile.eight, &profile.harmonics].map(|p| off(p));
        let _ = writeln!(
            text,
            "RMSE over all {} samples: 3 slices {three:.4}, 8 slices {eight:.4}, order 4 {harmonics:.4}",
            profile.three.len()
        );
    }
    text
}

const WIDTH: f64 = 860.0;
const TALL: f64 = 420.0;
/// Left, top, right, bottom.
const MARGIN: [f64; 4] = [60.0, 20.0, 20.0, 50.0];
/// What the axes end at: wall heights, share of free light.
const ENDS: [f64; 2] = [10.0, 1.2];
/// Of each light.
const COLOURS: [&str; 2] = ["#b2562b", "#2b5fb2"];

fn place(distance: f64, share: f64) -> [f64; 2] {
    let [left, top, right, bottom] = MARGIN;
    let x = left + (WIDTH - left - right) * distance / ENDS[0];
    [x, TALL - bottom - (TALL - top - bottom) * share / ENDS[1]]
}

fn picture(profiles: &[(&str, Profile)]) -> String {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {TALL}\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"{WIDTH}\" height=\"{TALL}\" fill=\"white\"/>\n"
    );
    let mut line = |from: [f64; 2], to: [f64; 2], style: &str| {
        let [[x1, y1], [x2, y2]] = [from, to];
        let _ = writeln!(
            svg,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" {style}/>"
        );
    };
    for i in 0..=10 {
        line(place(f64::from(i), 0.0), place(f64::from(i), ENDS[1]), "stroke=\"#ddd\"");
    }
    for i in 0..=6 {
        let share = 0.2 * f64::from(i);
        line(place(0.0, share), place(ENDS[0], share), "stroke=\"#ddd\"");
    }
    let mut text = |[x, y]: [f64; 2], anchor: &str, colour: &str, said: &str| {
        let _ = writeln!(
            svg,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{said}</text>"
        );
    };
    for i in 0..=10 {
        let [x, y] = place(f64::from(i), 0.0);
        text([x, y + 18.0], "middle", "#333", &i.to_string());
    }
    for i in 0..=6 {
        let [x, y] = place(0.0, 0.2 * f64::from(i));
        text([x - 8.0, y + 4.0], "end", "#333", &format!("{:.1}", 0.2 * f64::from(i)));
    }
    let [x, y] = place(ENDS[0] / 2.0, 0.0);
    text(
        [x, y + 40.0],
        "middle",
        "#333",
        "distance behind the wall, in its heights; share of the light of free ground",
    );
    for (i, (name, _)) in profiles.iter().enumerate() {
        let [x, y] = place(5.2, 0.42 - 0.08 * i as f64);
        text([x, y], "start", COLOURS[i], name);
    }
    let [x, y] = place(5.2, 0.26);
    text([x, y], "start", "#333", "circles: reference (light paths); lines: ours, 3 slices;");
    let [x, y] = place(5.2, 0.20);
    text([x, y], "start", "#333", "dashes: harmonics of order 4, as in the paper");
    for (i, (_, profile)) in profiles.iter().enumerate() {
        let curve = |shares: &[f64]| {
            let seen = shares.iter().enumerate().filter(|(i, _)| distance(*i) <= ENDS[0]);
            let point = |(i, share): (usize, &f64)| {
                let [x, y] = place(distance(i), share.clamp(0.0, ENDS[1]));
                format!("{x:.1},{y:.1}")
            };
            seen.map(point).collect::<Vec<_>>()
        };
        let colour = COLOURS[i];
        for (shares, style) in
            [(&profile.three, ""), (&profile.harmonics, " stroke-dasharray=\"7 4\"")]
        {
            let points = curve(shares).join(" ");
            let _ = writeln!(
                svg,
                "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"{style}/>"
            );
        }
        for point in curve(&profile.reference).iter().step_by(2) {
            let (x, y) = point.split_once(',').expect("two numbers");
            let _ = writeln!(
                svg,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"3\" fill=\"none\" stroke=\"{colour}\"/>"
            );
        }
    }
    svg + "</svg>\n"
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let lights = [
        ("0° to 90°: no restriction in elevation", key([0.0, 90.0])),
        ("20° to 30°: restricted in elevation", key([20.0, 30.0])),
    ];
    let mut profiles = Vec::new();
    for (name, key) in lights {
        profiles.push((name, profile(&mut gpu, key)?));
    }
    print!("{}", table(&profiles, &gpu.report().name));
    match args.as_slice() {
        [flag, path] if flag == "-o" => files::write_text(Path::new(path), &picture(&profiles)),
        _ => Ok(()),
    }
}
