//! The path tracer's specular viewed from an eye: against the f64 oracle, which has no Monte Carlo noise, and against
//! pictures from the same eye.

use glam::DVec3;
use ridgelight::gpu::Pixels;
use ridgelight::plan::{Picture, REFERENCE_BATCH, unsampled_light_error};
use ridgelight::scene::{
    Albedo, Border, HeightField, Lights, PhongSpecular, Quality, Scene, Specular, Sun,
};
use ridgelight_cpu::light::normal;
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::tolerance::{EPSILON, device_sun_specular, disc_rings};

use crate::reference::quadrature::traced_from;
use crate::scenes::Agreement;
use crate::{Device, field, random, under_sky};

/// Batches of a comparison, and a texel's paths in them.
const BATCHES: usize = 64;
const PATHS: u32 = BATCHES as u32 * REFERENCE_BATCH;

/// A sun in the east.
fn sun(diameter_rad: f64, irradiance: [f32; 3]) -> Sun {
    Sun { azimuth_rad: 0.0, elevation_rad: 0.6, diameter_rad, irradiance }
}

/// Phong specular over ground of a grey albedo, under a sky of radiance 1.
fn shiny(field: HeightField, albedo: f32, exponent: f32) -> Scene {
    let mut scene = under_sky(field, Border::Plane);
    scene.surface.albedo = Albedo::Constant([albedo; 3]);
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.5 }));
    scene
}

/// Rough ground from an eye in the west, so low that some texels face away from it. The sky is red, the sun green, blue is
/// both. The comparison fails against a view from straight above.
#[test]
fn paths_view_specular_from_the_eye_as_the_oracle_does() {
    const SIDE: usize = 9;
    let mut device = Device::new();
    let mut next = random(61);
    let noise: Vec<f64> = (0..SIDE * SIDE).map(|_| next()).collect();
    let rough = field(SIDE, SIDE, [1.0, 1.3], |r, c| 900.0 + 1.5 * noise[r * SIDE + c]);
    let mut scene = shiny(rough, 0.3, 20.0);
    scene.lights.sky = Some([1.0, 0.0, 0.5]);
    scene.lights.suns = vec![sun(0.2, [0.0, 1.0, 0.5])];
    let eye_m = [-6.0, 5.0, 902.5];
    let texels = || (0..SIDE * SIDE).map(|i| (i / SIDE, i % SIDE));
    let of_field = &scene.field;
    let faces_away = |(row, col): (usize, usize)| {
        let height = of_field.base_m() + f64::from(of_field.heights_m()[row * SIDE + col]);
        let at = DVec3::new(col as f64, (SIDE - 1 - row) as f64 * 1.3, height);
        normal(of_field, Border::Plane, row, col).dot(DVec3::from_array(eye_m) - at) < 0.0
    };
    assert!(texels().any(faces_away), "every texel faces the eye");
    let [light, error] = traced_from(&mut device, &scene, eye_m, BATCHES);
    let agreement = |eye_m: Option<[f64; 3]>| {
        let lit = Lit::of(&scene).viewed_from(eye_m);
        let half = lit.clone().halved();
        let fine: Vec<[f64; 3]> = texels().map(|(row, col)| lit.at(row, col)).collect();
        let coarse: Vec<[f64; 3]> = texels().map(|(row, col)| half.at(row, col)).collect();
        let stated: Vec<[f64; 3]> = fine
            .iter()
            .zip(&coarse)
            .map(|(fine, coarse)| [0, 1, 2].map(|c| (fine[c] - coarse[c]).abs()))
            .collect();
        Agreement::of([&light, &error], [&fine, &stated], f64::from(PATHS), 1e-5)
    };
    let [viewed, above] = [Some(eye_m), None].map(agreement);
    println!("{viewed:?}, from above {above:?}");
    assert!(viewed.holds(), "{viewed:?}");
    assert!(!above.holds(), "cannot fail: {above:?}");
}

/// Level ground, where nothing hides light: paths agree with the picture from the same eye. The tolerance is six standard errors,
/// that of unsampled light included, and the picture's own error: 2/128 of the lobe for tables and maps of the sky, and the rings
/// of the sun's disc. The picture from straight above differs.
#[test]
fn paths_agree_with_the_picture_from_the_same_eye() {
    const SIDE: usize = 12;
    let mut device = Device::new();
    let mut scene = shiny(field(SIDE, SIDE, [1.0, 1.0], |_, _| 3.0), 0.0, 20.0);
    let sun = sun(0.1, [1.0; 3]);
    scene.lights.suns = vec![sun];
    let eye_m = [0.0, 6.0, 3.0 + 6.0 * 0.6_f64.tan()];
    let [light, error] = traced_from(&mut device, &scene, eye_m, BATCHES);
    let unsampled = unsampled_light_error(&scene, 0, PATHS)[0];
    let rings = disc_rings(20.0, &sun, 0.0).max(disc_rings(20.0, &sun, 1.0));
    let of_sun = device_sun_specular(20.0, 8.0 * EPSILON, sun.elevation_rad.sin()) + rings;
    let bound = 0.5 * (2.0 / 128.0 + of_sun);
    let worst = |picture: &Pixels| {
        let ratio = |i: usize| {
            let want = f64::from(picture.values[i * picture.channels]);
            let sigma = error[i][0].hypot(unsampled);
            (light[i][0] - want).abs() / (6.0 * sigma + bound + 1e-5 * want)
        };
        // `f64::max` would leave out NaN.
        let larger = |a: f64, b: f64| if a.is_nan() || b <= a { a } else { b };
        (0..SIDE * SIDE).map(ratio).fold(0.0, larger)
    };
    let limits = device.limits();
    let mut picture = |eye_m| {
        let wanted = Picture { eye_m, ..Picture::default() };
        device.outputs(&scene, &Quality::default(), &limits, wanted).remove(0)
    };
    let [viewed, above] = [Some(eye_m), None].map(|eye_m| worst(&picture(eye_m)));
    println!("{viewed:.3} of the tolerance, from above {above:.1}");
    assert!(viewed <= 1.0, "{viewed}");
    assert!(above > 10.0, "cannot fail: {above}");
}

/// On level ground the brightest texel is the one whose view direction mirrors the sun, as in pictures. A point sun and black
/// ground: one path has all light.
#[test]
fn a_highlight_of_paths_follows_the_eye() {
    const SIDE: usize = 21;
    let mut device = Device::new();
    let mut scene = shiny(field(SIDE, SIDE, [1.0, 1.0], |_, _| 3.0), 0.0, 200.0);
    scene.lights = Lights { suns: vec![sun(0.0, [1.0; 3])], ..Lights::default() };
    for (x, y) in [(5, 10), (12, 3), (16, 17)] {
        // The sun is in the east: it is mirrored to an eye in the west, as high as the sun.
        let away = 6.0;
        let eye_m = [x as f64 - away, y as f64, 3.0 + away * 0.6_f64.tan()];
        let [light, _] = traced_from(&mut device, &scene, eye_m, 1);
        let texels = light.iter().enumerate();
        let brightest = texels.max_by(|a, b| a.1[0].total_cmp(&b.1[0])).expect("texels").0;
        assert_eq!([brightest % SIDE, SIDE - 1 - brightest / SIDE], [x, y]);
    }
}
