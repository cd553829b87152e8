//! Path tracing.

use ridgelight::scene::{
    Albedo, Border, Lights, PhongSpecular, Quality, Scene, Specular, SphereLight, Sun, Surface,
};

use super::{Case, Wanted, key, noisy_environment, rough};
use crate::random;

/// Every kind of light on an open field, and a field that repeats, with two levels of blocks.
fn of_all_lights() -> [Scene; 2] {
    let sun = |diameter_rad| Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.6,
        diameter_rad,
        irradiance: [1.0, 0.5, 0.2],
    };
    let sphere_light =
        SphereLight { position_m: [9.0, 7.0, 912.0], radius_m: 3.0, radiance: [0.1, 0.4, 2.0] };
    let mut next = random(21);
    let map = (0..7 * 9).map(|_| [0.8 * next() as f32, 0.5, 0.1]).collect();
    let all = Scene {
        field: rough(7, 9, 22),
        surface: Surface { border: Border::Open, albedo: Albedo::Map(map), specular: None },
        lights: Lights {
            sky: Some([0.3, 0.5, 0.9]),
            environment: Some(noisy_environment(23)),
            suns: vec![sun(0.2), sun(0.0)],
            keys: vec![key(-0.4, 0.5, [1.0, 0.3, 0.0]), key(0.9, 1.2, [0.0, 0.4, 2.0])],
            sphere_lights: vec![sphere_light],
        },
    };
    let repeated = Scene {
        field: rough(6, 10, 24),
        surface: Surface {
            border: Border::Periodic,
            albedo: Albedo::Constant([0.6, 0.3, 0.9]),
            specular: None,
        },
        lights: Lights {
            sky: Some([1.0; 3]),
            suns: vec![sun(0.3)],
            keys: vec![key(-0.4, 0.5, [1.0, 0.3, 2.0])],
            ..Lights::default()
        },
    };
    [all, repeated]
}

fn reference(name: &'static str, scene: Scene, wanted: Wanted) -> Case {
    Case { name, scene, quality: Quality::default(), wanted, loses_lines: false }
}

fn with_lobes(mut scene: Scene) -> Scene {
    let lobe = |i: usize| PhongSpecular { exponent: (i % 12) as f32, scale: (i % 3) as f32 * 0.05 };
    let count = scene.field.heights_m().len();
    scene.surface.specular = Some(Specular::Map((0..count).map(lobe).collect()));
    scene
}

/// Paths whose light the quadrature also computes: every kind of light, a lobe and a map; a field that repeats.
pub(in crate::cpu_reference) fn references() -> Vec<Case> {
    let [all, repeated] = of_all_lights();
    // The quadrature knows of no lobes that are met.
    let lobes = with_lobes(all.clone());
    vec![
        reference("all lights", all, Wanted::Reference(1)),
        reference("lobes in all lights", lobes, Wanted::Reference(0)),
        reference("periodic", repeated, Wanted::Reference(2)),
    ]
}

/// Paths whose light nothing else computes: lobes that are met; batches in parts, by paths and by lights; a list of samples; ground
/// that goes on level; a line.
pub(in crate::cpu_reference) fn paths() -> Vec<Case> {
    let [all, repeated] = of_all_lights();
    let on = |field, border, lights: &Lights| Scene {
        field,
        surface: Surface { border, albedo: Albedo::Constant([0.7, 0.4, 0.2]), specular: None },
        lights: lights.clone(),
    };
    let level = on(rough(17, 13, 25), Border::Plane, &all.lights);
    let line = on(rough(1, 11, 26), Border::Plane, &repeated.lights);
    let mut many = on(rough(5, 4, 27), Border::Open, &Lights::default());
    many.lights.suns = (0..40)
        .map(|i| Sun {
            azimuth_rad: 0.1 + 0.7 * f64::from(i),
            elevation_rad: 0.1 + 0.03 * f64::from(i),
            diameter_rad: 0.01,
            irradiance: [0.01, 0.02, 0.03],
        })
        .collect();
    let mut glossy = with_lobes(level.clone());
    glossy.surface.specular =
        Some(Specular::Constant(PhongSpecular { exponent: 100.0, scale: 0.05 }));
    vec![
        reference("lobes that are met", with_lobes(all.clone()), Wanted::Reference(1)),
        reference("lobes that repeat", with_lobes(repeated.clone()), Wanted::Reference(1)),
        reference("a sharp lobe on a plane", glossy, Wanted::Reference(1)),
        reference("bounced light of a list", all, Wanted::ReferenceAt(1, 40)),
        reference("many suns", many, Wanted::Reference(1)),
        reference("on a plane", level, Wanted::Reference(2)),
        reference("a line", line, Wanted::Reference(1)),
    ]
}
