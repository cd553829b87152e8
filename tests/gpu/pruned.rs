//! Parts that a scene cannot show are not in its plan, and forcing them back changes nothing.

use ridgelight::plan::{self, Kind, Limits, Picture, Plan};
use ridgelight::scene::fractal;
use ridgelight::scene::{Border, Environment, Lights, Quality, Scene, Sun, Surface};

use crate::{Device, field, random};

fn scene(lights: Lights) -> Scene {
    let field = fractal(64, 4).expect("a field");
    Scene { field, surface: Surface::default(), lights }
}

fn sky(radiance: [f32; 3]) -> Lights {
    Lights { sky: Some(radiance), ..Lights::default() }
}

fn quality() -> Quality {
    Quality { azimuths: 8, table_elevations: 512, ..Quality::default() }
}

fn planned(scene: &Scene) -> Plan {
    let limits = Limits::lavapipe();
    plan::picture(scene, &quality(), &limits, Picture::default()).expect("a plan")
}

fn names(plan: &Plan) -> Vec<&str> {
    plan.passes.iter().map(|p| p.name()).collect()
}

fn noise(seed: u64, height: usize) -> Vec<[f32; 3]> {
    let mut next = random(seed);
    (0..2 * height * height).map(|_| [next() as f32, next() as f32, next() as f32]).collect()
}

fn environment(texels: Vec<[f32; 3]>, height: usize) -> Environment {
    Environment::new(2 * height, height, texels, 0.0).expect("an environment")
}

/// Grey lights on grey ground take one channel; a colour so close to grey that only the last of 24 bits differs takes
/// three, and gives the same picture.
#[test]
fn grey_is_one_channel() {
    let grey = scene(sky([1.0; 3]));
    let nearly = scene(sky([1.0, 1.0, 1.0 + f32::EPSILON]));
    let bytes = |s: &Scene| {
        let plan = planned(s);
        plan.outputs().map(|(_, r)| r.bytes()).sum::<u64>()
    };
    assert_eq!(bytes(&nearly), 4 * bytes(&grey));
    let mut gpu = Device::new();
    let one = gpu.picture(&grey, &quality());
    let four = gpu.picture(&nearly, &quality());
    assert_eq!((one.channels, four.channels), (1, 4));
    for (one, four) in one.values.iter().zip(four.values.chunks_exact(4)) {
        assert_eq!((four[0], four[1]), (*one, *one));
        assert!((four[2] - one).abs() <= 2.0 * f32::EPSILON * one);
    }
}

/// A uniform sky needs no environment and no table. As an environment it goes through one: its nodes hold cos² and sin
/// cos integrals, and between two of them, Δ = (π/2)/511 apart, interpolation errs by at most Δ²/8 of the integrand's
/// largest second derivative, 1: 1.2e-6, times π of azimuth over π.
#[test]
fn a_uniform_sky_has_no_table() {
    let plain = scene(sky([0.5, 0.6, 0.7]));
    assert!(names(&planned(&plain)).iter().all(|n| !n.starts_with("env_")));
    assert!(planned(&plain).find("env_tables").is_none());
    let all = vec![[0.5, 0.6, 0.7]; 2 * 32 * 32];
    let through_table =
        scene(Lights { environment: Some(environment(all, 32)), ..Lights::default() });
    let mut gpu = Device::new();
    let a = gpu.picture(&plain, &quality()).values;
    let b = gpu.picture(&through_table, &quality()).values;
    let step = std::f32::consts::FRAC_PI_2 / 511.0;
    // Sums of 8 azimuths of f32 terms of order 1 on either side.
    let tolerance = step * step / 8.0 * 2.0 + 64.0 * f32::EPSILON;
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() <= tolerance, "{a} {b}");
    }
}

/// A sun alone sweeps its own azimuths. A sky that is nearly black brings the circle back, and nothing else.
#[test]
fn a_sun_alone_sweeps_its_own_azimuths() {
    let sun = Sun { azimuth_rad: 0.7, elevation_rad: 0.3, diameter_rad: 0.0, irradiance: [2.0; 3] };
    let alone = scene(Lights { suns: vec![sun], ..Lights::default() });
    let with_sky = scene(Lights { suns: vec![sun], ..sky([1e-30; 3]) });
    assert_eq!(planned(&alone).azimuths.len(), 1);
    assert_eq!(planned(&with_sky).azimuths.len(), 9);
    assert!(!names(&planned(&alone)).contains(&"sky_shade"));
    let mut gpu = Device::new();
    let a = gpu.picture(&alone, &quality()).values;
    let b = gpu.picture(&with_sky, &quality()).values;
    assert!(a.iter().any(|v| *v > 0.0));
    // Where the sun is hidden only the sky is left, 1e-30 at most.
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-30));
}

/// Environment rows below horizontal are invisible from a plane: they are not summed, and their contents do not change
/// a bit. Under an open border they are summed, and they do.
#[test]
fn environment_rows_below_any_horizon_are_left_out() {
    let mut gpu = Device::new();
    for height in [16, 17] {
        let bright = noise(3, height);
        let mut dark_below = bright.clone();
        // The middle row of an odd number lies on both sides of horizontal.
        dark_below[height.div_ceil(2) * 2 * height..].fill([0.0; 3]);
        let lit = |texels: &[[f32; 3]], border| {
            let mut scene = scene(Lights {
                environment: Some(environment(texels.to_vec(), height)),
                ..Lights::default()
            });
            scene.surface.border = border;
            scene
        };
        let rows = |border| {
            let plan = planned(&lit(&bright, border));
            let wedges = plan.find("wedge_rows").expect("wedges");
            match plan.resources[wedges.0].kind {
                Kind::Buffer { bytes, .. } => bytes / 48 / 8,
                Kind::Image { .. } => unreachable!("a buffer"),
            }
        };
        assert_eq!(rows(Border::Plane), height.div_ceil(2) as u64);
        assert_eq!(rows(Border::Periodic), height.div_ceil(2) as u64);
        assert_eq!(rows(Border::Open), height as u64);
        for (border, shows) in [(Border::Plane, false), (Border::Open, true)] {
            let a = gpu.picture(&lit(&bright, border), &quality()).values;
            let b = gpu.picture(&lit(&dark_below, border), &quality()).values;
            assert_eq!(a != b, shows, "{border:?}, {height} rows");
        }
    }
}

/// Lights of radiance 0 have no pass, and the other lights have the same result without them.
#[test]
fn lights_without_radiance_have_no_pass() {
    let sun = Sun { azimuth_rad: 0.7, elevation_rad: 0.3, diameter_rad: 0.0, irradiance: [0.0; 3] };
    let dark = scene(Lights { suns: vec![sun], ..sky([1.0; 3]) });
    assert!(!names(&planned(&dark)).contains(&"shadow_shade"));
    let mut gpu = Device::new();
    let a = gpu.picture(&dark, &quality()).values;
    assert!(a == gpu.picture(&scene(sky([1.0; 3])), &quality()).values);
}

/// On a concave field nothing occludes: a level one, a dome, a slope with a ridge. A forced sweep finds the first
/// crossings.
#[test]
fn a_concave_field_that_stays_is_not_swept() {
    let mut gpu = Device::new();
    let field = |height: fn(f64, f64) -> f64| {
        field(40, 50, [1.0, 2.0], |r, c| height(r as f64 - 20.0, c as f64 - 25.0))
    };
    let level = field(|_, _| 7.0);
    // In 64ths, which f32 holds exactly: its diagonals are level, and rounding would crease them.
    let dome = field(|r, c| -(r * r + c * c) / 64.0);
    let ridge = field(|r, c| 0.5 * r - 0.25 * c.abs());
    let sun = Sun { azimuth_rad: 0.7, elevation_rad: 0.3, diameter_rad: 0.1, irradiance: [2.0; 3] };
    for (field, border) in [
        (&level, Border::Plane),
        (&level, Border::Periodic),
        (&dome, Border::Plane),
        (&dome, Border::Open),
        (&ridge, Border::Open),
    ] {
        let lights = Lights { suns: vec![sun], ..sky([0.5, 0.6, 0.7]) };
        let surface = Surface { border, ..Surface::default() };
        let scene = Scene { field: field.clone(), surface, lights };
        let wanted = Picture { still: true, ..Picture::default() };
        let still = plan::picture(&scene, &quality(), &Limits::lavapipe(), wanted).expect("a plan");
        assert!(names(&still).iter().all(|n| *n != "horizon_sweep"), "{:?}", names(&still));
        assert!(still.resources.iter().all(|r| !r.name.starts_with("lattice")));
        assert!(names(&planned(&scene)).contains(&"horizon_sweep"), "it may change");
        let without = gpu.draw(still, &[scene.field.heights_m()]).remove(0).values;
        let swept = gpu.picture(&scene, &quality()).values;
        // An occluder in the plane of the first crossing differs by the rounding of two heights over two steps; light
        // changes by no more than the slopes, and the sun by that over its disc.
        let highest = scene.field.heights_m().iter().fold(0.0_f32, |m, h| m.max(h.abs()));
        let tolerance = 4.0 * f32::EPSILON * (highest + 1.0) * (1.0 + 2.0 / 0.1);
        for (a, b) in without.iter().zip(&swept) {
            assert!((a - b).abs() <= tolerance, "{a} {b} {tolerance}");
        }
    }
}
