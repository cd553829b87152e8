//! The plinth under a field, against f64 rays and closed forms.

use ridgelight::plan::ViewOptions;
use ridgelight::scene::{Border, Camera, HeightField, Lens, Scene};
use ridgelight_cpu::plinth_draw::{mean_luminance, plinth_draw};

use super::rays::{LENSES, ROUNDING, SNAP, Shot, around, shoot, uneven};
use crate::{Device, field, under_sky};

/// The rough fields begin at 100.
const BASE_M: f64 = 79.0;

/// Compares every pixel with the rays about its middle, as [`Shot::check`]. Where none meets the plinth, the pixel is that of
/// the picture without it; where all meet one face, it has the face's radiance. Depths are those of the ground everywhere.
/// Returns the number of pixels of the plinth.
fn check(with: &Shot, without: &Shot, tolerance: f64) -> Result<usize, String> {
    let [width, height] = with.options.size;
    let away = SNAP + ROUNDING * f64::from(width.max(height));
    let mean = mean_luminance(&with.scene.field, &with.lit);
    assert_eq!(with.visible.distances_m, without.visible.distances_m);
    let mut count = 0;
    for (i, got) in with.visible.radiance.iter().enumerate() {
        let at = [i % width as usize, i / width as usize].map(|v| v as f64 + 0.5);
        let offsets = [-away, 0.0, away];
        let rays = offsets.iter().flat_map(|y| offsets.map(|x| [at[0] + x, at[1] + *y]));
        let step = (with.options.mesh_step, BASE_M);
        let tones: Vec<_> = rays
            .map(|pixel| plinth_draw(&with.scene, &with.camera, (with.options.size, pixel), step))
            .collect();
        if tones.iter().any(|tone| *tone != tones[0]) {
            continue;
        }
        let want = tones[0].map_or(without.visible.radiance[i].map(f64::from), |t| [t * mean; 3]);
        count += usize::from(tones[0].is_some());
        for (got, want) in got.iter().zip(want) {
            if (f64::from(*got) - want).abs() > tolerance * want {
                return Err(format!("pixel {at:?}: {got} for {want}, {tones:?}"));
            }
        }
    }
    Ok(count)
}

/// A mean of 64 luminances, a tone and their product: each rounds once.
const LIGHT: f64 = 70.0 * f32::EPSILON as f64;

fn both(
    device: &mut Device,
    scene: &Scene,
    camera: Camera,
    (options, base_m): (ViewOptions, f64),
) -> [Shot; 2] {
    [Some(base_m), None].map(|plinth_base_m| {
        shoot(device, scene.clone(), camera, ViewOptions { plinth_base_m, ..options })
    })
}

/// From four sides, low, high and from below; with a reduced mesh and voids, some at the edges.
#[test]
fn plinths_match_ray_casting() {
    let mut device = Device::new();
    let rough = uneven(11);
    let base_m = rough.field.base_m();
    let heights = rough.field.heights_m().iter().map(|h| base_m + f64::from(*h));
    let heights: Vec<f64> = heights.collect();
    let voids = (0..heights.len()).map(|i| (i / 33 + i % 33) % 11 == 5).collect();
    let holed = HeightField::new(29, 33, &heights, rough.field.cell_m(), Some(voids));
    let holed = Scene { field: holed.expect("a field"), ..rough.clone() };
    for (scene, mesh_step) in [(&rough, 1), (&rough, 3), (&holed, 1), (&holed, 3)] {
        let options =
            ViewOptions { size: [32, 24], samples: 1, mesh_step, ..ViewOptions::default() };
        for lens in LENSES {
            for (compass, elevation) in [(20.0, 25.0), (110.0, 4.0), (200.0, 60.0), (290.0, -30.0)]
            {
                let camera = around(scene, compass, elevation, lens, &options);
                let [with, without] = both(&mut device, scene, camera, (options, BASE_M));
                let count = check(&with, &without, LIGHT).unwrap();
                println!("{lens:?}, {compass}°, {elevation}°, step {mesh_step}: {count} pixels");
                assert!(count > 15, "{count}");
            }
        }
    }
}

/// The comparison fails for another depth, and for another light.
#[test]
fn another_plinth_is_refused() {
    let mut device = Device::new();
    let scene = uneven(11);
    let options = ViewOptions { size: [32, 24], samples: 1, ..ViewOptions::default() };
    let camera = around(&scene, 20.0, 25.0, LENSES[0], &options);
    let [_, without] = both(&mut device, &scene, camera, (options, BASE_M));
    let deeper = ViewOptions { plinth_base_m: Some(BASE_M - 3.0), ..options };
    let mut with = shoot(&mut device, scene, camera, deeper);
    assert!(check(&with, &without, LIGHT).is_err());
    with = shoot(
        &mut device,
        with.scene,
        camera,
        ViewOptions { plinth_base_m: Some(BASE_M), ..options },
    );
    assert!(check(&with, &without, LIGHT).is_ok());
    with.scene.lights.suns[0].azimuth_rad += 0.1;
    assert!(check(&with, &without, LIGHT).is_err());
}

/// Level ground of 16 by 16 cells of 2 m, viewed from the south at its own height by an orthographic lens of 24 m: pixels of
/// 0.5 m. The southern wall of 32 m fills the picture of 64 pixels across. It begins in the middle and ends 8 m
/// below, 16 pixels. Radiance is 1 under a sky of 1; without a sun the light comes from 60 degrees left of the
/// camera, so the wall has 0.35 + 0.15 cos 60°.
#[test]
fn a_level_fields_wall_has_its_derived_place() {
    let mut device = Device::new();
    let scene = under_sky(field(17, 17, [2.0, 2.0], |_, _| 5.0), Border::Plane);
    let options =
        ViewOptions { size: [64, 48], samples: 1, background: [3.0; 3], ..ViewOptions::default() };
    let camera = Camera {
        target_m: [16.0, 16.0, 5.0],
        azimuth_rad: -std::f64::consts::FRAC_PI_2,
        elevation_rad: 0.0,
        distance_m: 100.0,
        lens: Lens::Orthographic { height_m: 24.0 },
    };
    let [with, _] = both(&mut device, &scene, camera, (options, -3.0));
    for (row, pixels) in with.visible.radiance.chunks_exact(64).enumerate() {
        let is_wall = (24..40).contains(&row);
        for (col, pixel) in pixels.iter().enumerate() {
            let is_tone = (pixel[0] - 0.425).abs() < 1e-5;
            assert_eq!(is_tone, is_wall, "row {row}, column {col}: {pixel:?}");
        }
    }
}
