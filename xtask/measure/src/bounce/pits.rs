//! Spherical pits under a sky of 1 against their closed form.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Border, BounceEngine, HeightField, Lights, Method, Quality, Scene};
use ridgelight_cpu::bounce_march::bounce_march;
use ridgelight_cpu::light::sky_of;
use ridgelight_cpu::oracle::Oracle;

use super::{ENGINES, quality};
use crate::common::frames::{Colours, drawn, rms};
use crate::common::{head, inputs};
use crate::suites::reference_page::{pit, pit_radiance};

/// The pit, but grid points of the plain beside it lie on the cone from its lowest point through its
/// rim, which hides the rim's staircase from the middle.
fn pit_with_cone(rim: f64, alpha: f64) -> Result<HeightField> {
    let pit = pit(rim, alpha);
    let (side, middle) = (pit.cols(), rim.ceil() + 1.0);
    let away = |r: f64, c: f64| (r - middle).hypot(c - middle);
    inputs::field(side, side, |row, col| {
        let (r, c) = (row as f64, col as f64);
        let mut around = (0..9).map(|k| (r + f64::from(k / 3) - 1.0, c + f64::from(k % 3) - 1.0));
        let is_beside = around.any(|(r, c)| away(r, c) <= rim);
        let rise = if is_beside { (away(r, c) - rim).max(0.0) * (0.5 * alpha).tan() } else { 0.0 };
        pit.base_m() + f64::from(pit.heights_m()[row * side + col]) + rise
    })
}

/// Radiance with each number of bounces up to `most` by f64 quadrature on the field, in 32 azimuths:
/// its difference to the closed form is the field's.
fn quadrature(field: &HeightField, albedo: f64, most: u32) -> Vec<Vec<f64>> {
    const AZIMUTHS: u32 = 32;
    let oracle = Oracle::new(field, Border::Plane);
    let places = || (0..field.rows() * field.cols()).map(|i| (i / field.cols(), i % field.cols()));
    let sky = places().map(|(r, c)| [albedo * sky_of(&oracle, r, c, AZIMUTHS as usize); 3]);
    let mut layer: Colours = sky.collect();
    let mut all = vec![layer.iter().map(|l| l[0]).collect::<Vec<f64>>()];
    for _ in 0..most {
        let indirect = places().map(|(r, c)| bounce_march(&oracle, &layer, AZIMUTHS, r, c));
        layer = indirect.map(|l| l.map(|l| albedo * l)).collect();
        let before = all.last().expect("direct light");
        all.push(before.iter().zip(&layer).map(|(sum, l)| sum + l[0]).collect());
    }
    all
}

pub fn run(gpu: &mut Headless, rim: u32) -> Result<()> {
    println!(
        "Spherical pits under a sky of 1, rim {rim} cells away, as it falls on the grid and on a cone that hides its \
         staircase from the middle: RMSE relative to the closed form, %, up to half of the rim's distance; f64: of quadrature \
         on the field, which is the field's own\n"
    );
    head(
        "| half-angle | albedo | rim | bounces | azimuths | f64 | brute force, its own sky | brute force | sweep | pyramid |",
    );
    let rim = f64::from(rim) + 0.5;
    for (alpha, albedo, is_cone) in
        [(0.8, 0.5_f32, false), (0.8, 0.5, true), (1.2, 0.9, false), (1.2, 0.9, true)]
    {
        let field = if is_cone { pit_with_cone(rim, alpha)? } else { pit(rim, alpha) };
        let (side, middle) = (field.cols(), (field.cols() / 2) as f64);
        let in_f64 = quadrature(&field, albedo.into(), 4);
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = Scene { field, surface: inputs::matte([albedo; 3], Border::Plane), lights };
        for (count, azimuths) in [(0, 64), (1, 64), (4, 64), (4, 256)] {
            let expected = pit_radiance(alpha, albedo.into(), count as usize);
            let error = |light: &dyn Fn(usize) -> f64| {
                let away = |n: usize| n as f64 - middle;
                let inner =
                    (0..side * side).filter(|i| away(i / side).hypot(away(i % side)) <= 0.5 * rim);
                format!("{:.3}", 100.0 * rms(inner.map(|i| light(i) - expected)) / expected)
            };
            let mut cells = vec![error(&|i| in_f64[count as usize][i])];
            let ways = [(Method::BruteForce, BounceEngine::BruteForce)];
            for (method, engine) in ways.into_iter().chain(ENGINES.map(|e| (Method::Auto, e))) {
                let quality = Quality { method, ..quality(engine, count, azimuths) };
                let light = drawn(gpu, &scene, &quality, 0)?.light;
                cells.push(error(&|i| light[i][0]));
            }
            let (rim, cells) = (if is_cone { "cone" } else { "grid" }, cells.join(" | "));
            println!("| {alpha} | {albedo} | {rim} | {count} | {azimuths} | {cells} |");
        }
    }
    println!();
    Ok(())
}
