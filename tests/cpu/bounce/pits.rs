//! The spherical pit: a cap of half-angle α of a sphere, sunk into a plain.

use std::f64::consts::{FRAC_PI_2, TAU};

use ridgelight::scene::Border;
use ridgelight_cpu::indirect::Fineness;
use ridgelight_cpu::light::slice;

use super::{reds, under_sky};
use crate::reference_page::{PITS, pit, pit_bounds, pit_radiance};

#[test]
fn the_closed_form_matches_the_quadrature() {
    for (alpha, albedo, bounces, radiance) in PITS {
        let off = pit_radiance(alpha, f64::from(albedo), bounces) - radiance;
        assert!(off.abs() < 1e-7, "f32 of 0.9");
    }
}

/// The reference numbers' pits to 1e-12, by slices of visible sphere above and below its rim. Every point of a
/// sphere sees as much sky, and the same radiance from the rest, at every bounce.
#[test]
fn slices_of_a_pit_match_reference_numbers() {
    let all: serde_json::Value =
        serde_json::from_str(include_str!("../../basis/reference_numbers.json")).unwrap();
    for entry in all["spherical_pit"].as_array().unwrap() {
        let number = |name: &str| entry[name].as_f64().unwrap();
        let (alpha, albedo) = (number("alpha"), number("albedo"));
        for from_bottom in [0.0, 0.3 * alpha, 0.9 * alpha] {
            // On a sphere of radius 1 about the origin; its normal points there.
            let (x, z) = (f64::sin(from_bottom), -f64::cos(from_bottom));
            let azimuths = 4096;
            let (mut sky, mut ground) = (0.0, 0.0);
            for k in 0..azimuths {
                let cos = (TAU * f64::from(k) / f64::from(azimuths)).cos();
                let (a, b) = (-x * cos, -z);
                // To the rim's circle of radius sin α in the plane.
                let away = ((x * cos).powi(2) + alpha.sin().powi(2) - x * x).sqrt() - x * cos;
                let rim = (-alpha.cos() - z).atan2(away);
                sky += 2.0 / f64::from(azimuths) * slice(a, b, rim, FRAC_PI_2);
                ground += 2.0 / f64::from(azimuths) * slice(a, b, (-a).atan2(b), rim);
            }
            let direct = albedo * sky;
            let bounces = entry["bounces"].as_u64().unwrap();
            let got = (0..bounces).fold(direct, |light, _| direct + albedo * ground * light);
            let limit = direct / (1.0 - albedo * ground);
            for (got, want) in [(got, number("radiance")), (limit, number("limit"))] {
                assert!((got / want - 1.0).abs() < 1e-12, "{alpha} {from_bottom}: {got} {want}");
            }
        }
    }
}

/// Bounces 0, 1, 2 and the limit at every texel of the inner half, within the error of the rim's staircase.
/// Half the cells, half the error: order 1, ± 0.3 as the staircase differs.
#[test]
fn pits_match_their_closed_form() {
    for (alpha, albedo, limit) in [(0.8, 0.5_f32, 10), (1.2, 0.9_f32, 50)] {
        let rho = f64::from(albedo);
        let errors = [6.5, 12.5].map(|rim| {
            let scene = under_sky(pit(rim, alpha), Border::Plane, albedo);
            let fineness = Fineness { azimuths: 32, divisions: 1, strips: 1 };
            let pictures = reds(&scene, limit, fineness);
            let bounds = pit_bounds(rim, alpha, rho, limit);
            let (mut squares, mut count, mut worst) = (0.0, 0.0, 0.0_f64);
            for (b, (picture, bounds)) in pictures.iter().zip(&bounds).enumerate() {
                let expected = pit_radiance(alpha, rho, b);
                for &(i, tolerance) in bounds {
                    let error = (picture[i] - expected).abs();
                    assert!(error < tolerance, "{alpha} {rim} {b} {i}: {error} > {tolerance}");
                    worst = worst.max(error / tolerance);
                    squares += error * error;
                    count += 1.0;
                }
            }
            let rms = f64::sqrt(squares / count);
            println!("α {alpha}, rim {rim} cells: rms {rms:.2e}, worst {worst:.2} of tolerance");
            rms
        });
        let order = (errors[0] / errors[1]).ln() / (12.5_f64 / 6.5).ln();
        assert!((order - 1.0).abs() < 0.3, "{order}");
    }
}
