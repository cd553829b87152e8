//! The slopes of a fine grid, lit by the light of a coarse grid and by a sun with shadow heights.

use ridgelight::plan::azimuths::across_sun;
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{
    Albedo, Border, HeightField, Lights, Quality, Scene, Sun, Surface, normal,
};
use ridgelight_cpu::preview::{Coarse, Colours, Unoccluded};
use ridgelight_cpu::preview_shade::{FineSun, preview_shade, sun_shares};
use ridgelight_cpu::shared::sweep::{Heights, March};
use ridgelight_cpu::tolerance::EPSILON;

use crate::{Device, random};

const FINE: [usize; 2] = [22, 19];
/// Side of the blocks of the sky.
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

fn normals(field: &HeightField) -> Vec<[f64; 3]> {
    let (count, cols) = (field.rows() * field.cols(), field.cols());
    (0..count).map(|i| normal(field, Border::Plane, i / cols, i % cols).to_array()).collect()
}

/// A preview's inputs and the light that it must show.
struct Case {
    has_sun: bool,
    grey: bool,
    has_map: bool,
    border: Border,
    azimuth_rad: f64,
}

/// The cosines err by 16 ε: rounded normals, products and sums. The light of a coarse texel errs by twice that over the
/// sky's function, which is 1 or more on these slopes. Its place errs by ε of the coarse columns, over which it changes by at most
/// the largest light; mixing and multiplying add 12 ε.
///
/// In every march step a shadow height errs by the rounding of its rise and of the difference: 4 ε of the largest height, which is
/// the relief plus the rise of a step. A periodic field has twice the steps. The share of the sun changes by at most 1.5 times that
/// over the height in which a texel goes from dark to lit, by 16 ε for the terms of that height, and by at most 1.
#[test]
fn previews_match_the_cpu_reference() {
    let mut device = Device::new();
    let mut partly = 0;
    for (has_sun, grey, has_map, border, azimuth_rad) in [
        (true, true, false, Border::Plane, 2.0),
        (true, false, true, Border::Plane, 5.6),
        (true, false, false, Border::Periodic, 2.0),
        (true, true, false, Border::Periodic, 3.9),
        (false, false, true, Border::Plane, 0.0),
        (false, false, false, Border::Plane, 0.0),
    ] {
        let case = Case { has_sun, grey, has_map, border, azimuth_rad };
        partly += check(&mut device, &case);
    }
    // Penumbrae are compared too.
    assert!(partly > 20, "{partly}");
}

/// Returns at how many texels a part of the sun is visible.
fn check(device: &mut Device, case: &Case) -> usize {
    let Case { has_sun, grey, has_map, border, azimuth_rad } = *case;
    let [fine, sky_field] =
        [1, SIDE].map(|side| field(FINE.map(|n| n.div_ceil(side)), side as f64));
    let sun =
        Sun { azimuth_rad, elevation_rad: 0.3, diameter_rad: 0.1, irradiance: [2.0, 2.0, 2.0] };
    let in_sky = normals(&sky_field);
    // Means of rough ground are shorter than 1.
    let means: Vec<[f64; 3]> =
        normals(&fine).iter().map(|n| n.map(|v| f64::from((0.9 * v) as f32))).collect();
    // The constant colour is none of a grey scene, so that its channels differ.
    let constant = [0.5, 0.3, 0.2];
    let colour = if grey { [1.0; 3] } else { [1.0, 0.8, 0.6] };
    // A black sun, which has no image, comes first.
    let black = Sun { azimuth_rad: 0.3, irradiance: [0.0; 3], ..sun };
    let suns = if has_sun { vec![black, sun] } else { Vec::new() };
    let lights = Lights { sky: Some(colour), suns, ..Lights::default() };
    let albedo = |field: &HeightField, seed: u64| colours(field.rows() * field.cols(), false, seed);
    let [fine_albedo, sky_albedo] = [albedo(&fine, 3), albedo(&sky_field, 4)];
    let scene = |field: &HeightField, albedo: &[[f32; 3]], border: Border| Scene {
        field: field.clone(),
        surface: Surface {
            albedo: match (grey, has_map) {
                (true, _) => Albedo::Constant([1.0; 3]),
                (_, true) => Albedo::Map(albedo.to_vec()),
                _ => Albedo::Constant(constant),
            },
            border,
            ..Surface::default()
        },
        lights: lights.clone(),
    };
    let fine_scene = scene(&fine, &fine_albedo, border);
    let sky_scene = scene(&sky_field, &sky_albedo, Border::Plane);
    let gpu = device.gpu.as_mut().expect("alive");
    let limits: Limits = crate::limits_of(gpu);
    let wanted = Picture { light_layers: true, ..Picture::default() };
    let sky_plan = plan::picture(&sky_scene, &Quality::default(), &limits, wanted).expect("a plan");
    let plan = plan::preview(&fine_scene, (&sky_scene, &sky_plan), &limits).expect("a plan");

    // A share of the sun at each grid point, as a sun pass gives it.
    let shares = colours(in_sky.len(), true, 5);
    let of_sky = |i: usize| match (grey, has_map) {
        (true, _) => [1.0; 3],
        (_, true) => sky_albedo[i],
        _ => constant,
    };
    let sky_sun: Vec<[f32; 3]> = (0..in_sky.len())
        .map(|i| of_sky(i).map(|a| if has_sun { shares[i][0] * a } else { 0.0 }))
        .collect();
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
    contents.push(texels(&radiance, grey));
    if has_sun {
        contents.push(texels(&sky_sun, grey));
    }
    if has_map {
        contents.push(texels(&sky_albedo, false));
    }
    let pixels = gpu
        .with_frame(plan, &contents, |gpu, frame| {
            gpu.draw(frame)?;
            gpu.pixels(frame, 0)
        })
        .expect("drawn");

    let azimuth = across_sun(&Sun { diameter_rad: 0.0, ..sun }, 1, fine.cell_m())[0];
    let march = March::new(Heights::of(&fine, border), &azimuth);
    let edges = [-0.5, 0.5].map(|half| (sun.elevation_rad + half * sun.diameter_rad).tan());
    let of_edges = |edges: [f64; 2]| FineSun { sun: &sun, march: &march, edges };
    let light = |blend: f64, edges: [f64; 2]| {
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
        let albedo = colours(fine_albedo.as_slice());
        preview_shade((&fine, &means), albedo, &sky, has_sun.then(|| of_edges(edges)).as_ref())
    };
    // The largest light of the sky's grid is 1.5 over the least albedo 0.2; the sun's is less than 1.
    let of_light = 8.5 * EPSILON * (32.0 + sky_field.cols() as f64 + 12.0);
    let steps = f64::from(march.steps) * if march.periodic() { 2.0 } else { 1.0 };
    let largest = 3.2 + edges[1] * f64::from(azimuth.step_m);
    let height_m = 4.0 * EPSILON * (steps + 8.0) * largest;
    let by_texel = sun_shares((&fine, &means), &of_edges(edges));
    let tolerance = |i: usize| {
        let of_edge = (1.5 * height_m / by_texel[i][1] + 16.0 * EPSILON).min(1.0);
        of_light + if has_sun { of_edge } else { 0.0 }
    };
    let worst = |want: &[[f64; 3]]| {
        let got = pixels.values.chunks_exact(4).zip(want).enumerate();
        let texel = |(i, (got, want)): (usize, (&[f32], &[f64; 3]))| {
            let apart = |c: usize| (f64::from(got[c]) - want[c]).abs();
            (0..3).map(apart).fold(0.0, f64::max) / tolerance(i)
        };
        got.map(texel).fold(0.0, f64::max)
    };
    let found = worst(&light(0.0, edges));
    assert!(found <= 1.0, "{has_sun} {grey} {has_map} {border:?}: {found} of the tolerance");
    // The comparison can fail.
    assert!(worst(&light(1e-3, edges)) > 1.0);
    assert!(!has_sun || worst(&light(0.0, edges.map(|edge| 1.01 * edge))) > 1.0);
    let is_part = |[share, _]: &&[f64; 2]| has_sun && (0.05..0.95).contains(share);
    by_texel.iter().filter(is_part).count()
}
