//! Light of coarse grids on the slopes of a finer one.

use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{
    Albedo, Border, HeightField, Lights, Quality, Scene, Sun, Surface, normal,
};
use ridgelight_cpu::preview::{Coarse, Colours, Unoccluded};
use ridgelight_cpu::preview_shade::preview_shade;
use ridgelight_cpu::tolerance::EPSILON;

use crate::{Device, random};

const FINE: [usize; 2] = [22, 19];
/// Sides of the blocks of the sky and of the sun.
const SIDES: [usize; 2] = [4, 2];

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

fn normals(field: &HeightField) -> Vec<[f64; 3]> {
    let (count, cols) = (field.rows() * field.cols(), field.cols());
    (0..count).map(|i| normal(field, Border::Plane, i / cols, i % cols).to_array()).collect()
}

/// The cosines err by 16 ε: rounded normals, products and sums. The light of a coarse texel
/// errs by twice that over the least cosine; its place by ε of the coarse columns, over which it changes by the largest
/// light at most; mixing and multiplying by 12 ε more.
#[test]
fn previews_match_the_cpu_reference() {
    let mut device = Device::new();
    let sizes = SIDES.map(|side| FINE.map(|n| n.div_ceil(side)));
    let fine = field(FINE, 1.0);
    let [sky_field, sun_field] = [0, 1].map(|n| field(sizes[n], SIDES[n] as f64));
    let sun = Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.8,
        diameter_rad: 0.02,
        irradiance: [2.0, 2.0, 2.0],
    };
    let of_sun = Unoccluded::of_sun(&sun);
    let facing =
        |normal: &[f64; 3]| -> f64 { normal.iter().zip(of_sun.vector).map(|(a, b)| a * b).sum() };
    let [in_sky, in_sun] = [&sky_field, &sun_field].map(normals);
    let least = in_sky.iter().chain(&in_sun).map(facing).fold(1.0, f64::min);
    assert!(least > 0.1, "{least}");
    // Means of rough ground are shorter than 1.
    let means: Vec<[f64; 3]> =
        normals(&fine).iter().map(|n| n.map(|v| f64::from((0.9 * v) as f32))).collect();
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
        let [fine_albedo, sky_albedo] = [albedo(FINE, 3), albedo(sizes[0], 4)];
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
        let (fine_scene, sky_scene) = (scene(&fine, &fine_albedo), scene(&sky_field, &sky_albedo));
        // On its own grid the sun has no colour, and another irradiance.
        let own_sun = Sun { irradiance: [0.7; 3], ..sun };
        let sun_scene = Scene {
            field: sun_field.clone(),
            surface: Surface::default(),
            lights: Lights { suns: vec![own_sun], ..Lights::default() },
        };
        let gpu = device.gpu.as_mut().expect("alive");
        let limits: Limits = crate::limits_of(gpu);
        let planned = |scene: &Scene, light_layers: bool| {
            let wanted = Picture { light_layers, ..Picture::default() };
            plan::picture(scene, &Quality::default(), &limits, wanted).expect("a plan")
        };
        let plans = [planned(&sky_scene, true), planned(&sun_scene, false)];
        let suns = has_sun.then_some((&sun_scene, &plans[1]));
        let plan = plan::preview(&fine_scene, (&sky_scene, &plans[0]), suns, &limits);
        let plan = plan.expect("a plan");

        // A share of the sun at each grid point, as a sun pass gives it, for albedo 0.2 and more.
        let lit = |normals: &[[f64; 3]], albedo: &dyn Fn(usize) -> [f32; 3], seed: u64| {
            let shares = colours(normals.len(), true, seed);
            let light = |i: usize| {
                let lit = (of_sun.most[0] * facing(&normals[i])) as f32;
                albedo(i).map(|a| if has_sun { shares[i][0] * a * lit } else { 0.0 })
            };
            (0..normals.len()).map(light).collect::<Vec<[f32; 3]>>()
        };
        let of_sky = |i: usize| match (grey, has_map) {
            (true, _) => [1.0; 3],
            (_, true) => sky_albedo[i],
            _ => constant,
        };
        let sky_sun = lit(&in_sky, &of_sky, 5);
        let sun_light = lit(&in_sun, &|_| [1.0; 3], 7);
        let radiance: Vec<[f32; 3]> = colours(in_sky.len(), grey, 6)
            .iter()
            .zip(&sky_sun)
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
        let rounded = |normals: &[[f64; 3]]| -> Vec<[f32; 3]> {
            normals.iter().map(|n| n.map(|v| v as f32)).collect()
        };
        contents.extend([&means, &in_sky].map(|normals| texels(&rounded(normals), false)));
        if has_sun {
            contents.push(texels(&rounded(&in_sun), false));
        }
        contents.push(texels(&radiance, grey));
        if has_sun {
            contents.push(texels(&sky_sun, grey));
        }
        if has_map {
            contents.push(texels(&sky_albedo, false));
        }
        if has_sun {
            // One sun of one colour on white ground is grey.
            let own_light: Vec<[f32; 3]> = sun_light.iter().map(|c| c.map(|v| 0.35 * v)).collect();
            contents.push(texels(&own_light, true));
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
            let colours = |map| match (grey, has_map) {
                (true, _) => Colours::Constant([1.0; 3]),
                (_, true) => Colours::Map(map),
                _ => Colours::Constant(constant),
            };
            let sky = Coarse {
                field: &sky_field,
                radiance: &radiance,
                without: has_sun.then_some(sky_sun.as_slice()),
                albedo: colours(sky_albedo.as_slice()),
                unoccluded: Unoccluded::of_sky(),
            };
            let sun = Coarse {
                field: &sun_field,
                radiance: &sun_light,
                without: None,
                albedo: Colours::Constant([1.0; 3]),
                unoccluded: of_sun,
            };
            let albedo = colours(fine_albedo.as_slice());
            preview_shade((&fine, &means), albedo, &sky, has_sun.then_some(&sun))
        };
        // No cosine, albedo or light above is more than 1, and the least albedo 0.2; there are two lights.
        let most = 2.0 / 0.2 / least;
        let tolerance = most * EPSILON * (32.0 / least + sizes[1][0] as f64 + 12.0);
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
