//! Phong specular of a small bright spot of an environment, and of a sun that an edge cuts.

use std::f64::consts::{LN_2, PI, TAU};

use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Border, Environment, Lights, Method, PhongSpecular, Quality, Scene, Specular, Sun,
    Surface,
};
use ridgelight_cpu::mirror_map::mirrored;

use crate::{Device, field};
use glam::DVec3;

const SIDE: usize = 33;
const ROWS: usize = 256;
const COLUMNS: usize = 512;
const RADIANCE: f64 = 1000.0;

/// Level ground below an eye reflects one bright texel: (n + 1) / 2π cosⁿ of the angle between it and each mirror direction,
/// integrated over the texel.
///
/// Errors, as shares of the largest reflection: lobes are linear between peaks a sixteenth of a deviation apart, 1/2,048; a column's
/// light is in its middle, n w² / 24, w radians wide; and the map is a cubic between texels h = 1/4 of a deviation apart along two
/// directions. Its slopes err by h² / 6 of the third derivative, at most 1.38 of a Gaussian's, so that its values err by 0.0962 h³ / 6
/// of it; by h⁴ 3 / 128 of the fourth, at most 3. The weights of the second direction sum to 1.25 at most by magnitude.
///
/// The exponent levels of a specular map are at most h = ln 2 / 2 apart in ln(n + 1). The error of a cubic through four of them is at most
/// h⁴ / 24 times the fourth derivative by ln(n + 1). That is (n + 1) e^-t (1 - 15 t + 25 t² - 10 t³ + t⁴), with t = (n + 1) ln(1 / cos): at
/// most 1.36 times the peak, which is 2^1.5 times that of n in the highest of the four. Below n = 3 the lobe's end is no Gaussian's.
#[test]
fn specular_of_a_bright_spot_is_the_phong_function() {
    let mut gpu = Device::new();
    let level = field(SIDE, SIDE, [1.0, 1.0], |_, _| 3.0);
    let middle = (SIDE / 2) as f64;
    let eye = DVec3::new(middle, middle, 3.0 + 14.0);
    for (row, column, exponent, most) in [
        (60, 100, 20.0_f32, None),
        (71, 301, 100.0, None),
        (40, 450, 700.0, None),
        (60, 200, 3.0, Some(5.0)),
        (60, 100, 20.0, Some(23.0)),
        (71, 301, 100.0, Some(285.0)),
    ] {
        let n = f64::from(exponent);
        let mut texels = vec![[0.0; 3]; ROWS * COLUMNS];
        texels[row * COLUMNS + column] = [RADIANCE as f32; 3];
        let environment = Environment::new(COLUMNS, ROWS, texels, 0.0).expect("an environment");
        let phong = PhongSpecular { exponent, scale: 1.0 };
        // A map's largest exponent, at a texel that the reflection does not reach, decides its levels.
        let specular = Some(match most {
            None => Specular::Constant(phong),
            Some(exponent) => {
                let mut map = vec![phong; SIDE * SIDE];
                map[0] = PhongSpecular { exponent, ..phong };
                Specular::Map(map)
            }
        });
        let albedo = Albedo::Constant([0.0; 3]);
        let scene = Scene {
            field: level.clone(),
            surface: Surface { border: Border::Plane, albedo, specular },
            lights: Lights { environment: Some(environment), ..Lights::default() },
        };
        let wanted = Picture { eye_m: Some(eye.to_array()), ..Picture::default() };
        let plan =
            plan::picture(&scene, &Quality::default(), &gpu.limits(), wanted).expect("a plan");
        let contents = plan::picture_inputs(&scene);
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        let lit = gpu.draw(plan, &contents).remove(0);

        // Columns run clockwise from the west, rows from the zenith.
        let (width, height) = (TAU / COLUMNS as f64, PI / ROWS as f64);
        let reflected = |mirror: DVec3| {
            let mut sum = 0.0;
            for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
                let place = |k: usize, part: usize| k as f64 + (part as f64 + 0.5) / 8.0;
                let azimuth = PI - width * place(column, j);
                let elevation = PI / 2.0 - height * place(row, i);
                let flat = elevation.cos();
                let towards =
                    DVec3::new(flat * azimuth.cos(), flat * azimuth.sin(), elevation.sin());
                sum += towards.dot(mirror).max(0.0).powf(n) * flat / 64.0;
            }
            RADIANCE * (n + 1.0) / TAU * width * height * sum
        };
        let want: Vec<f64> = (0..SIDE * SIDE)
            .map(|i| {
                let at = DVec3::new((i % SIDE) as f64, (SIDE - 1 - i / SIDE) as f64, 3.0);
                reflected(mirrored(DVec3::Z, (eye - at).normalize()))
            })
            .collect();
        let largest = want.iter().copied().fold(0.0, f64::max);
        let h = 0.25_f64;
        let cubic = h.powi(3) * 1.38 * 0.0962 / 6.0 + h.powi(4) * 3.0 * 3.0 / 128.0;
        let levels = most.map_or(0.0, |_| 1.36 * 2.0_f64.powf(1.5) * (0.5 * LN_2).powi(4) / 24.0);
        let bound = largest * (1.0 / 2048.0 + n * width * width / 24.0 + 2.25 * cubic + levels);
        let mut worst = 0.0_f64;
        for (i, want) in want.iter().enumerate().skip(1) {
            worst = worst.max((f64::from(lit.values[i * lit.channels]) - want).abs());
        }
        println!("{n}: {:.2e} of {:.2e}", worst / largest, bound / largest);
        assert!(worst <= bound, "{n}: {worst:e} of {bound:e}");
        // The spot's reflection lies within the field.
        let peak = RADIANCE * (n + 1.0) / TAU * width * height;
        assert!(largest > 0.5 * peak * ((row as f64 + 0.5) * height).sin(), "{n}: {largest}");
    }
}

/// Level ground mirrors a sun that rises behind a long wall: the lobe's integral over what is above the wall. The mirror
/// direction of the eye is at the sun or a few degrees beside it.
///
/// Errors, of the largest value: the ellipse's squared widths are off by 0.025 r² and 0.01 r². Half of each, times the second
/// derivative n, bounds that error. The third moment is 0.1 r³ at most. A sixth of it, times the third derivative of at most 1.38 n^1.5,
/// bounds the next. Chords h = 1/32 of a radius apart err by h². Up to a thousandth of the disc may be hidden and go undetected.
#[test]
fn a_sun_behind_a_wall_is_reflected_by_its_visible_part() {
    const COLS: usize = 40;
    const WALL: usize = 36;
    let mut gpu = Device::new();
    let ground = field(17, COLS, [1.0, 1.0], |_, c| if c == WALL { 10.0 } else { 0.0 });
    let (elevation, diameter) = (20.0_f64.to_radians(), 5.0_f64.to_radians());
    let sun = Sun {
        azimuth_rad: 0.0,
        elevation_rad: elevation,
        diameter_rad: diameter,
        irradiance: [1.0; 3],
    };
    let (mut cut, mut wrong) = (0, 0);
    for (n, beside, method) in [
        (20.0_f64, 3.0_f64, Method::Auto),
        (100.0, 3.0, Method::Auto),
        (100.0, -4.0, Method::Sweep),
        (100.0, 0.0, Method::BruteForce),
    ] {
        let specular = Some(Specular::Constant(PhongSpecular { exponent: n as f32, scale: 1.0 }));
        let albedo = Albedo::Constant([0.0; 3]);
        let scene = Scene {
            field: ground.clone(),
            surface: Surface { border: Border::Plane, albedo, specular },
            lights: Lights { suns: vec![sun], ..Lights::default() },
        };
        // So far in the west that all grid points mirror one direction.
        let (up, along) = (elevation + beside.to_radians()).sin_cos();
        let eye_m = Some([-1e5 * along, 8.0, 1e5 * up]);
        let mirror = DVec3::new(along, 0.0, up);
        let quality = Quality { method, sun_azimuths: 64, ..Quality::default() };
        let wanted = Picture { eye_m, ..Picture::default() };
        let plan = plan::picture(&scene, &quality, &gpu.limits(), wanted).expect("a plan");
        let lit = gpu.draw(plan, &[scene.field.heights_m()]).remove(0);

        let radius = 0.5 * diameter;
        let (sin, cos) = elevation.sin_cos();
        let centre = DVec3::new(cos, 0.0, sin);
        let (side, above) = (DVec3::Y, DVec3::new(-sin, 0.0, cos));
        let phong = |e: DVec3| (n + 1.0) / TAU * e.dot(mirror).max(0.0).powf(n);
        // Of 250 rings of 250 directions each; and the share of them that is visible.
        let visible = |distance: f64| {
            let (mut sum, mut share) = (0.0, 0.0);
            for (i, k) in (0..250).flat_map(|i| (0..250).map(move |k| (i, k))) {
                let h = (1.0 - radius.cos()) * (f64::from(i) + 0.5) / 250.0;
                let across = (h * (2.0 - h)).sqrt();
                let (y, x) = (TAU * (f64::from(k) + 0.5) / 250.0).sin_cos();
                let e = (1.0 - h) * centre + across * (x * side + y * above);
                // The wall's top is a line across.
                if e.z / e.x > 10.0 / distance {
                    sum += phong(e);
                    share += 1.0;
                }
            }
            // Radiance π⁻¹ sin⁻² r times the solid angle 2 π (1 - cos r).
            let whole = 2.0 * (1.0 - radius.cos()) / radius.sin().powi(2);
            [whole * sum / 62_500.0, share / 62_500.0]
        };
        let [whole, _] = visible(1e9);
        let wide = n * radius * radius;
        let shape = 0.5 * (0.025 + 0.01) * wide + 1.38 / 6.0 * 0.1 * wide.powf(1.5);
        let bound = (n + 1.0) / TAU * (shape + 1.0 / 1024.0 + 1e-3);
        // Columns whose normal the wall does not affect.
        for c in 1..WALL - 2 {
            let [want, share] = visible((WALL - c) as f64);
            let got = f64::from(lit.values[(8 * COLS + c) * lit.channels]);
            let off = (got - want).abs();
            assert!(
                off <= bound,
                "{n} {beside} {method:?}: column {c}: {got} for {want} ± {bound}"
            );
            if 0.01 < share && share < 0.99 {
                cut += 1;
                // The mean over the whole disc, times the visible share.
                wrong += usize::from((share * whole - want).abs() > bound);
            }
        }
    }
    println!(
        "the wall partly hides the sun in {cut} columns; the mean over the whole disc is out of bounds in {wrong}"
    );
    assert!(cut > 20 && wrong > 10, "{cut} {wrong}");
}
