//! Direct Phong specular of sphere lights in pictures.

use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Border, Lights, PhongSpecular, Quality, Scene, Specular, SphereLight, Surface,
};
use ridgelight_cpu::sphere_shade::device_sphere_specular;
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry};

use crate::{Device, field};

/// Where the mirror direction points to the centre of a sphere of angular radius a, the lobe over the sphere is 1 - cos^(n + 1) a,
/// whatever the direction. By slices that are h wide in the middle, its error is h² (n + 1) / 12 of it: see `keys`.
#[test]
fn a_mirrored_sphere_has_its_closed_form() {
    const MIDDLE: usize = 4;
    let mut gpu = Device::new();
    let level = field(9, 9, [1.0, 1.0], |_, _| 2.0);
    let radius_m = 3.0;
    let mut checked = 0;
    for (elevation_deg, azimuth_rad) in
        [(90.0_f64, 0.0_f64), (60.0, 0.4), (35.0, 2.5), (35.0, -1.0)]
    {
        let (up, flat) = elevation_deg.to_radians().sin_cos();
        let (sin, cos) = azimuth_rad.sin_cos();
        // The texel in the middle, row 4 and column 4, is at (4, 4, 2).
        let along = |by: f64, turn: f64| {
            [4.0 + turn * by * flat * cos, 4.0 + turn * by * flat * sin, 2.0 + by * up]
        };
        let distance_m = 15.0;
        let sphere =
            SphereLight { position_m: along(distance_m, 1.0), radius_m, radiance: [2.0, 1.0, 0.5] };
        // Straight above the texel the sphere is in front of the eye. Light does not depend on that.
        let eye_m = Some(along(20.0, -1.0));
        for exponent in [1.0_f32, 20.0, 100.0, 1000.0] {
            let n = f64::from(exponent);
            let specular = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.5 }));
            let surface =
                Surface { border: Border::Plane, albedo: Albedo::Constant([0.0; 3]), specular };
            let lights = Lights { sphere_lights: vec![sphere], ..Lights::default() };
            let scene = Scene { field: level.clone(), surface, lights };
            let quality = Quality { sun_azimuths: 64, ..Quality::default() };
            let wanted = Picture { eye_m, ..Picture::default() };
            let plan = plan::picture(&scene, &quality, &gpu.limits(), wanted).expect("a plan");
            let lit = gpu.draw(plan, &[scene.field.heights_m()]).remove(0);
            let texel = MIDDLE * 9 + MIDDLE;
            let share = 1.0 - (1.0 - (radius_m / distance_m).powi(2)).powf(0.5 * (n + 1.0));
            // At least 48 slices over the angular width, eight per cell of the sphere's width; 512 where it surrounds the texel.
            let away_m = distance_m * flat;
            let wedge_rad = if away_m > radius_m {
                std::f64::consts::PI * (radius_m / away_m).asin() / 48.0
            } else {
                std::f64::consts::TAU / 512.0
            };
            let geometry = SphereGeometry::of(&scene.field, &sphere, texel);
            let off = device_sphere_specular(&geometry, n, 40.0 * EPSILON)
                + share * wedge_rad * wedge_rad * (n + 1.0) / 12.0;
            for c in 0..3 {
                let bright = 0.5 * f64::from(sphere.radiance[c]);
                let found = f64::from(lit.values[texel * lit.channels + c]);
                let error = (found - bright * share).abs();
                let bound = bright * off;
                assert!(
                    error <= bound,
                    "{elevation_deg} {n}: {found} for {} ± {bound}",
                    bright * share
                );
                checked += usize::from(share > 10.0 * off);
            }
        }
    }
    // Most comparisons could fail.
    assert!(checked >= 30, "{checked}");
}
