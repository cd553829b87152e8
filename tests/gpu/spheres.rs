//! Balls of light: against the f64 oracle, against answers derived by hand, and moving.

use ridgelight::cpu::oracle::Oracle;
use ridgelight::cpu::sphere_shade::sphere_at;
use ridgelight::measure::fractal::fractal;
use ridgelight::scene::{Border, HeightField, Lights, Quality, Scene, SphereLight, Surface};

use crate::{Device, field};

fn probe(name: &str, device: &mut Device, scene: &Scene, slices: u32) {
    let quality = Quality { sun_azimuths: slices, light_cutoff: 0.0, ..Quality::default() };
    let picture = device.picture(scene, &quality);
    let oracle = Oracle::new(&scene.field, scene.surface.border);
    let cols = scene.field.cols();
    let ball = &scene.lights.spheres[0];
    let (mut worst, mut at, mut sq, mut sqt, mut sum) = (0.0_f64, 0, 0.0, 0.0, 0.0);
    let step = (picture.values.len() / 2000).max(1);
    let mut n = 0.0;
    for i in (0..picture.values.len()).step_by(step) {
        let got = f64::from(picture.values[i]) / f64::from(ball.radiance[0]);
        let twin = sphere_at(&oracle, ball, slices, i / cols, i % cols);
        let truth = sphere_at(&oracle, ball, 256, i / cols, i % cols);
        if !((got - twin).abs() <= worst) {
            worst = (got - twin).abs();
            at = i;
        }
        sq += (got - twin).powi(2);
        sqt += (got - truth).powi(2);
        sum += truth;
        n += 1.0;
    }
    let i = at;
    println!(
        "{name}: worst {worst:.2e} at {} {}: {} {}; rel rmse twin {:.3e} truth {:.3e}",
        i / cols,
        i % cols,
        picture.values[i] / ball.radiance[0],
        sphere_at(&oracle, ball, slices, i / cols, i % cols),
        (sq / n as f64).sqrt() / (sum / n),
        (sqt / n as f64).sqrt() / (sum / n)
    );
}

#[test]
fn probe_all() {
    let mut device = Device::new();
    for (name, mut scene) in crate::scenes::scenes() {
        if scene.lights.spheres.is_empty() {
            continue;
        }
        scene.lights.spheres[0].radiance = [9.0; 3];
        scene.surface = Surface { border: scene.surface.border, ..Surface::default() };
        scene.lights = Lights { spheres: scene.lights.spheres, ..Lights::default() };
        for slices in [8, 16, 64] {
            probe(name, &mut device, &scene, slices);
        }
    }
    let big = fractal(128, 1).unwrap();
    let top =
        big.base_m() + f64::from(*big.heights_m().iter().max_by(|a, b| a.total_cmp(b)).unwrap());
    let cell = big.cell_m()[0];
    println!("fractal cell {cell} top {top} base {}", big.base_m());
    for (x, y, z, r) in [
        (64.0, 64.0, 5.0, 4.0),
        (30.0, 80.0, 0.0, 3.0),
        (200.0, 40.0, 30.0, 20.0),
        (64.0, 64.0, -30.0, 10.0),
        (64.2, 63.7, -10.0, 0.1),
    ] {
        let ball = SphereLight {
            position_m: [x * cell, y * cell, top + z * cell],
            radius_m: r * cell,
            radiance: [1.0; 3],
        };
        let scene = Scene {
            field: big.clone(),
            surface: Surface::default(),
            lights: Lights { spheres: vec![ball], ..Lights::default() },
        };
        for slices in [4, 8, 16, 32] {
            probe(&format!("fractal {x} {y} {z} {r} {slices}"), &mut device, &scene, slices);
        }
    }
    let _ = (
        field as fn(usize, usize, [f64; 2], fn(usize, usize) -> f64) -> HeightField,
        Border::Plane,
    );
}
