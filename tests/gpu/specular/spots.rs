//! Phong specular of a small bright spot of an environment.

use std::f64::consts::{PI, TAU};

use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Border, Environment, Lights, PhongSpecular, Quality, Scene, Specular, Surface,
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
#[test]
fn specular_of_a_bright_spot_is_the_phong_function() {
    let mut gpu = Device::new();
    let level = field(SIDE, SIDE, [1.0, 1.0], |_, _| 3.0);
    let middle = (SIDE / 2) as f64;
    let eye = DVec3::new(middle, middle, 3.0 + 14.0);
    for (row, column, exponent) in [(60, 100, 20.0_f32), (71, 301, 100.0), (40, 450, 700.0)] {
        let n = f64::from(exponent);
        let mut texels = vec![[0.0; 3]; ROWS * COLUMNS];
        texels[row * COLUMNS + column] = [RADIANCE as f32; 3];
        let environment = Environment::new(COLUMNS, ROWS, texels, 0.0).expect("an environment");
        let phong = PhongSpecular { exponent, scale: 1.0 };
        let specular = Some(Specular::Constant(phong));
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
        let bound = largest * (1.0 / 2048.0 + n * width * width / 24.0 + 2.25 * cubic);
        let mut worst = 0.0_f64;
        for (i, want) in want.iter().enumerate() {
            worst = worst.max((f64::from(lit.values[i * lit.channels]) - want).abs());
        }
        println!("{n}: {:.2e} of {:.2e}", worst / largest, bound / largest);
        assert!(worst <= bound, "{n}: {worst:e} of {bound:e}");
        // The eye sees the spot's reflection.
        let peak = RADIANCE * (n + 1.0) / TAU * width * height;
        assert!(largest > 0.5 * peak * ((row as f64 + 0.5) * height).sin(), "{n}: {largest}");
    }
}
