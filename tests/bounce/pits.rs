//! The spherical pit: a cap of half-angle α of a sphere, sunk into a plain.
//!
//! Between two points of a sphere the form factor is dA/(4πR²) whatever the points: every point sees
//! the sky with share s = (1 + cos α)/2 and the pit, equally bright everywhere, with 1 - s. With b bounces
//! L = ρ s Σ_{i ≤ b} (ρ(1-s))^i, in the limit ρ s / (1 - ρ(1-s)).

use ridgelight::cpu::bounce::Fineness;
use ridgelight::scene::{Border, HeightField};

use std::f64::consts::TAU;

use crate::{field, reds, under_sky};

/// Independent quadrature to 15 digits (the project's vectors): α, ρ, bounces, radiance.
const VALUES: [(f64, f32, i32, f64); 4] = [
    (0.8, 0.5, 0, 0.424_176_677_336_791_4),
    (0.8, 0.5, 1, 0.456_339_162_408_706_64),
    (1.2, 0.9, 2, 0.839_447_864_111_118_3),
    (1.2, 0.9, 50, 0.859_759_541_651_428_3),
];

fn closed_form(alpha: f64, albedo: f64, bounces: i32) -> f64 {
    let share = 0.5 * (1.0 + alpha.cos());
    let again = albedo * (1.0 - share);
    albedo * share * (1.0 - again.powi(bounces + 1)) / (1.0 - again)
}

/// The pit, its rim `rim` cells from the middle of a field that ends two cells beyond.
fn pit(rim: f64, alpha: f64) -> HeightField {
    let sphere = rim / alpha.sin();
    let middle = rim.ceil() + 1.0;
    let side = 2 * middle as usize + 1;
    field(side, side, [1.0, 1.0], |r, c| {
        let away = (r as f64 - middle).hypot(c as f64 - middle).min(rim);
        -(sphere * sphere - away * away).sqrt()
    })
}

#[test]
fn the_closed_form_is_the_quadrature() {
    for (alpha, albedo, bounces, radiance) in VALUES {
        assert!(
            (closed_form(alpha, f64::from(albedo), bounces) - radiance).abs() < 1e-7,
            "f32 of 0.9"
        );
    }
}

/// How much sky a place of the pit, `away` from its axis, may gain on the grid.
///
/// The plain is met not at the rim, D away, but up to √2 cells farther, where the last cell's surface has
/// risen to it: the horizon ω sinks by up to sin ω cos ω √2/D, and of the slice (N·e) cos ω dω is
/// gained. On a sphere N·e = (chord from here to the rim)/2R. Flat triangles instead of the sphere: second
/// order in a cell over R.
fn sky_gained(away: f64, rim: f64, alpha: f64) -> f64 {
    let sphere = rim / alpha.sin();
    let depth = (sphere * sphere - away * away).sqrt() - sphere * alpha.cos();
    let m = 64;
    let sum: f64 = (0..m)
        .map(|k| {
            let (sin, cos) = (TAU * (f64::from(k) + 0.5) / f64::from(m)).sin_cos();
            let distance = (rim * rim - (away * sin).powi(2)).sqrt() - away * cos;
            let chord = distance.hypot(depth);
            let (sin_w, cos_w) = (depth / chord, distance / chord);
            chord / (2.0 * sphere) * sin_w * cos_w * cos_w * 2_f64.sqrt() / distance
        })
        .sum();
    2.0 / f64::from(m) * sum + 1.0 / (sphere * sphere)
}

/// Bounces 0, 1, 2 and the limit at every sample of the inner half, within what the rim's staircase can
/// do: directions that turn from pit (radiance L of the bounces before) to sky change a bounce by
/// ρ (1 - L) of them, and what the whole pit is off by on average comes back with ρ (1 - s). Half
/// the cells, half the error: order 1, ± 0.3 as the staircase is another one.
#[test]
fn a_pit_is_lit_as_its_closed_form() {
    for (alpha, albedo, limit) in [(0.8, 0.5_f32, 10), (1.2, 0.9_f32, 50)] {
        let share = 0.5 * (1.0 + f64::cos(alpha));
        let rho = f64::from(albedo);
        let errors = [6.5, 12.5].map(|rim| {
            let field = pit(rim, alpha);
            let side = field.cols();
            let away = |i: usize| {
                let middle = (side / 2) as f64;
                ((i / side) as f64 - middle).hypot((i % side) as f64 - middle)
            };
            let scene = under_sky(field, Border::Plane, albedo);
            let fineness = Fineness { azimuths: 32, divisions: 1, strips: 1 };
            let pictures = reds(&scene, limit, fineness);
            let inside: Vec<usize> = (0..side * side).filter(|i| away(*i) < rim - 0.01).collect();
            // No place can gain more than all it does not see.
            let gained = |i: usize| sky_gained(away(i), rim, alpha).min(1.0 - share);
            let gained_mean = inside.iter().map(|i| gained(*i)).sum::<f64>() / inside.len() as f64;
            let (mut before, mut off) = (0.0, 0.0);
            let (mut squares, mut count, mut worst) = (0.0, 0.0, 0.0_f64);
            for (b, picture) in pictures.iter().enumerate() {
                let expected = closed_form(alpha, rho, b as i32);
                for &i in inside.iter().filter(|i| away(**i) < 0.5 * rim) {
                    let tolerance = rho * (gained(i) * (1.0 - before) + (1.0 - share) * off);
                    let error = (picture[i] - expected).abs();
                    assert!(error < tolerance, "{alpha} {rim} {b} {i}: {error} > {tolerance}");
                    worst = worst.max(error / tolerance);
                    squares += error * error;
                    count += 1.0;
                }
                off = rho * (gained_mean * (1.0 - before) + (1.0 - share) * off);
                before = expected;
            }
            let rms = f64::sqrt(squares / count);
            println!("α {alpha}, rim {rim} cells: rms {rms:.2e}, worst {worst:.2} of tolerance");
            rms
        });
        let order = (errors[0] / errors[1]).ln() / (12.5_f64 / 6.5).ln();
        assert!((order - 1.0).abs() < 0.3, "{order}");
    }
}
