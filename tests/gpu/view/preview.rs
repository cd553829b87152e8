//! Light of a coarse grid on the slopes of a finer one.

use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{Albedo, HeightField, Lights, Quality, Scene, Sun, Surface};
use ridgelight_cpu::preview::{self, Coarse, Colours};
use ridgelight_cpu::preview_gather::preview_gather;
use ridgelight_cpu::preview_shade::preview_shade;
use ridgelight_cpu::tolerance::EPSILON;

use crate::{Device, random};

const FINE: [usize; 2] = [22, 19];
const SIDE: usize = 4;

fn field([cols, rows]: [usize; 2], side: f64) -> HeightField {
    let height = |i: usize| {
        let at = [(i % cols) as f64 * side, (i / cols) as f64 * side];
        0.9 * (0.5 * at[0]).sin() + 0.7 * (0.4 * at[1] + 0.2 * at[0]).cos()
    };
    let heights: Vec<f64> = (0..rows * cols).map(height).collect();
    HeightField::new(rows, cols, &heights, [1.5 * side, 2.0 * side], None).expect("a field")
}

/// Colours from 0.2 to 1; grey ones where asked.
fn colours(count: usize, grey: bool, seed: u64) -> Vec<[f32; 3]> {
    let mut next = random(seed);
    (0..count)
        .map(|_| {
            let all = [next(), next(), next()].map(|v| 0.2 + 0.8 * v as f32);
            if grey { [all[0]; 3] } else { all }
        })
        .collect()
}

/// The cosines err by 16 ε: three differences, quotients and squares, and a normalisation. The light of a coarse texel
/// errs by twice that over the least cosine; its place by ε of the coarse columns, over which it changes by the largest
/// light at most; mixing and multiplying by 12 ε more.
#[test]
fn previews_match_the_cpu_reference() {
    let mut device = Device::new();
    let coarse_size = FINE.map(|n| n.div_ceil(SIDE));
    let (fine, coarse) = (field(FINE, 1.0), field(coarse_size, SIDE as f64));
    let sun = Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.8,
        diameter_rad: 0.02,
        irradiance: [2.0, 2.0, 2.0],
    };
    let facing = |i: usize| {
        let cosines = preview::normal(&coarse, i).into_iter().zip(preview::direction(&sun));
        cosines.map(|(a, b)| a * b).sum::<f64>()
    };
    let count = coarse_size[0] * coarse_size[1];
    let least = (0..count).map(facing).fold(1.0, f64::min);
    assert!(least > 0.1, "{least}");
    // The constant colour is none of a grey scene, so that its channels differ.
    let constant = [0.5, 0.3, 0.2];
    for (has_sun, grey, has_map) in [
        (true, true, false),
        (true, false, true),
        (true, false, false),
        (false, false, true),
        (false, false, false),
    ] {
        let colour = if grey { [1.0; 3] } else { [1.0, 0.8, 0.6] };
        // A black sun, which has no image, comes first.
        let black = Sun { azimuth_rad: 0.3, irradiance: [0.0; 3], ..sun };
        let suns = if has_sun { vec![black, sun] } else { Vec::new() };
        let lights = Lights { sky: Some(colour), suns, ..Lights::default() };
        let albedo = |size: [usize; 2], seed: u64| colours(size[0] * size[1], false, seed);
        let [fine_albedo, coarse_albedo] = [albedo(FINE, 3), albedo(coarse_size, 4)];
        let scene = |field: &HeightField, albedo: &[[f32; 3]]| Scene {
            field: field.clone(),
            surface: Surface {
                albedo: match (grey, has_map) {
                    (true, _) => Albedo::Constant([1.0; 3]),
                    (_, true) => Albedo::Map(albedo.to_vec()),
                    _ => Albedo::Constant(constant),
                },
                ..Surface::default()
            },
            lights: lights.clone(),
        };
        let scenes = [scene(&fine, &fine_albedo), scene(&coarse, &coarse_albedo)];
        let gpu = device.gpu.as_mut().expect("alive");
        let limits: Limits = gpu.report().limits;
        let wanted = Picture { light_layers: true, ..Picture::default() };
        let lit = plan::picture(&scenes[1], &Quality::default(), &limits, wanted).expect("a plan");
        let plan = plan::preview(&scenes[0], &scenes[1], &lit, &limits).expect("a plan");

        // A share of the sun at each grid point, as a sun pass gives it, for albedo 0.2 and more.
        let shares = colours(count, true, 5);
        let of_sun: Vec<[f32; 3]> = (0..count)
            .map(|i| {
                let albedo = match (grey, has_map) {
                    (true, _) => [1.0; 3],
                    (_, true) => coarse_albedo[i],
                    _ => constant,
                };
                let lit = sun.irradiance[0] / std::f32::consts::PI * facing(i) as f32;
                albedo.map(|a| if has_sun { shares[i][0] * a * lit } else { 0.0 })
            })
            .collect();
        let radiance: Vec<[f32; 3]> = colours(count, grey, 6)
            .iter()
            .zip(&of_sun)
            .map(|(sky, sun)| [0, 1, 2].map(|c| 0.5 * sky[c] + sun[c]))
            .collect();
        let texels = |colours: &[[f32; 3]], grey: bool| -> Vec<f32> {
            let four = |c: &[f32; 3]| if grey { vec![c[0]] } else { vec![c[0], c[1], c[2], 1.0] };
            colours.iter().flat_map(four).collect()
        };
        let mut contents = vec![fine.heights_m().to_vec()];
        if has_map {
            contents.push(texels(&fine_albedo, false));
        }
        contents.extend([coarse.heights_m().to_vec(), texels(&radiance, grey)]);
        if has_sun {
            contents.push(texels(&of_sun, grey));
        }
        if has_map {
            contents.push(texels(&coarse_albedo, false));
        }
        let pixels = gpu
            .with_frame(plan, &contents, |gpu, frame| {
                gpu.draw(frame)?;
                gpu.pixels(frame, 0)
            })
            .expect("drawn");

        let light = |blend: f64| {
            let radiance: Vec<[f32; 3]> =
                radiance.iter().map(|c| c.map(|v| v * (1.0 + blend) as f32)).collect();
            let sun = has_sun.then_some((of_sun.as_slice(), &sun));
            let colours = |map| match (grey, has_map) {
                (true, _) => Colours::Constant([1.0; 3]),
                (_, true) => Colours::Map(map),
                _ => Colours::Constant(constant),
            };
            let albedo = colours(coarse_albedo.as_slice());
            let coarse = Coarse { field: &coarse, radiance: &radiance, sun, albedo };
            let albedo = colours(fine_albedo.as_slice());
            preview_shade(&fine, albedo, &coarse, &preview_gather(&coarse))
        };
        // No cosine, albedo or light above is more than 1, and the least albedo 0.2.
        let most = 1.0 / 0.2 / least;
        let tolerance = most * EPSILON * (32.0 / least + coarse_size[0] as f64 + 12.0);
        let apart = |want: &[[f64; 3]]| {
            let got = pixels.values.chunks_exact(4);
            let texel = |(got, want): (&[f32], &[f64; 3])| {
                (0..3).map(|c| (f64::from(got[c]) - want[c]).abs()).fold(0.0, f64::max)
            };
            got.zip(want).map(texel).fold(0.0, f64::max)
        };
        let found = apart(&light(0.0));
        assert!(found <= tolerance, "{has_sun} {grey} {has_map}: {found}, {tolerance}");
        // The comparison can fail.
        assert!(apart(&light(1e-3)) > tolerance);
    }
}
