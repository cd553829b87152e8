//! The scenes that the path tracer is compared on, as the quadrature sees them.

use ridgelight::cpu::bounce::{Fineness, truth};

use crate::scenes::scenes;

/// Prints mean radiance and stated error of every scene, and asks that the truth be worth comparing with:
/// the stated errors' rms is below 1 % of the mean.
#[test]
fn stated_errors_are_small_on_every_scene() {
    println!("{:34} bounces  mean radiance (sky, sun, ball)      rms of stated error", "scene");
    for (name, scene) in scenes() {
        let truth = truth(&scene, 2, Fineness { azimuths: 24, divisions: 1, strips: 12 }).unwrap();
        for (b, (picture, error)) in truth.radiance.iter().zip(&truth.error).enumerate() {
            let n = picture.len() as f64;
            let mean = [0, 1, 2].map(|i| picture.iter().map(|v| v[i]).sum::<f64>() / n);
            let rms =
                [0, 1, 2].map(|i| (error.iter().map(|v| v[i] * v[i]).sum::<f64>() / n).sqrt());
            println!("{name:34} {b}        {mean:.5?}  {rms:.5?}");
            for i in 0..3 {
                assert!(rms[i] < 0.01 * mean[i] || rms[i] == 0.0, "{name} {b} {i}");
            }
        }
    }
}
