//! The spherical pit: a cap of half-angle α of a sphere, sunk into a plain.

use ridgelight::cpu::bounce::Fineness;
use ridgelight::scene::Border;

use crate::reference_page::{PITS, pit, pit_bounds, pit_radiance};
use crate::{reds, under_sky};

#[test]
fn the_closed_form_is_the_quadrature() {
    for (alpha, albedo, bounces, radiance) in PITS {
        let off = pit_radiance(alpha, f64::from(albedo), bounces) - radiance;
        assert!(off.abs() < 1e-7, "f32 of 0.9");
    }
}

/// Bounces 0, 1, 2 and the limit at every sample of the inner half, within what the rim's staircase can
/// do. Half the cells, half the error: order 1, ± 0.3 as the staircase is another one.
#[test]
fn a_pit_is_lit_as_its_closed_form() {
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
