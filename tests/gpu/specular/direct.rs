//! Direct Phong specular in pictures: against closed forms and the path-traced reference.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use glam::DVec3;
use ridgelight::basis::legendre::{legendre, value};
use ridgelight::basis::quadrature::integral;
use ridgelight::basis::zonal::phong;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Basis, Border, Environment, HeightField, Lights, Method, PhongSpecular, Quality, Scene,
    Specular, Sun,
};
use ridgelight_cpu::basis::cap;
use ridgelight_cpu::indirect::{Fineness, light};
use ridgelight_cpu::tolerance::{
    EPSILON, ShadeError, device_march_slope, device_sun_specular, disc_rings,
};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

use crate::reference::quadrature::traced;
use crate::{Device, field, random, under_sky};

/// Phong specular without a diffuse part.
fn shiny(field: HeightField, exponent: f32, scale: f32) -> Scene {
    let mut scene = under_sky(field, Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.0; 3]);
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent, scale }));
    scene
}

fn sh(sh_order: u32) -> Quality {
    Quality { basis: Basis::Sh, sh_order, ..Quality::default() }
}

/// Level ground sees the upper hemisphere, a cap about the zenith, and reflects the zenith to the zenith: of a sky of
/// radiance 1 it reflects the sum over bands of lobe times cap. In the picture and in a layer, scaled.
#[test]
fn level_ground_reflects_its_hemisphere() {
    let mut gpu = Device::new();
    let order = 4;
    for exponent in [0.0, 5.0, 20.0, 1e4] {
        let scene = shiny(field(3, 5, [1.0, 2.0], |_, _| 4.0), exponent, 0.25);
        let wanted = Picture { light_layers: true, ..Picture::default() };
        let plan = plan::picture(&scene, &sh(order), &gpu.limits(), wanted).expect("a plan");
        let all = gpu.draw(plan, &[scene.field.heights_m()]);
        let own = all.iter().find(|p| p.name == "direct.specular").expect("a layer");
        let n = order as usize;
        let bands = phong(n, exponent.into()).into_iter().zip(cap(n, FRAC_PI_2));
        let want = 0.25 * bands.map(|(l, c)| l * c).sum::<f64>();
        for pixels in [&all[0], own] {
            let off = (f64::from(pixels.values[7 * pixels.channels]) - want).abs();
            assert!(off <= 1e-6 * want, "{exponent}: {off:e} of {want}");
        }
    }
}

/// For an eye far away, level ground mirrors a direction as far from the zenith as the eye. Under a sky of radiance 1 it reflects
/// the sum over bands of lobe times cap times the Legendre polynomial of that angle's cosine. With one lobe, and with a map.
#[test]
fn level_ground_mirrors_the_eye_by_harmonics() {
    let mut gpu = Device::new();
    let order = 4;
    for exponent in [1.0, 5.0, 20.0] {
        let of_texel = PhongSpecular { exponent, scale: 0.25 };
        let constant = shiny(field(3, 5, [1.0, 2.0], |_, _| 4.0), exponent, 0.25);
        let mut map = constant.clone();
        map.surface.specular = Some(Specular::Map(vec![of_texel; 15]));
        for scene in [constant, map] {
            let quality = sh(order);
            let n = order as usize;
            let bands = phong(n, exponent.into()).into_iter().zip(cap(n, FRAC_PI_2));
            let bands: Vec<f64> = bands.map(|(l, c)| 0.25 * l * c).collect();
            let mut all = Vec::new();
            for (zenith_rad, azimuth) in [(0.0_f64, 0.0_f64), (0.6, 2.0), (1.2, -0.7), (1.5, 4.0)] {
                // From column 2, row 1. Positions of f32 at this distance turn the direction by 1e-7.
                let (sin, cos) = zenith_rad.sin_cos();
                let to_eye = [sin * azimuth.cos(), sin * azimuth.sin(), cos];
                let [x, y, z] = to_eye.map(|v| 1e5 * v);
                let eye_m = Some([2.0 + x, 2.0 + y, 4.0 + z]);
                let wanted = Picture { eye_m, ..Picture::default() };
                let lit = gpu.outputs(&scene, &quality, &gpu.limits(), wanted).remove(0);
                let found = f64::from(lit.values[7 * lit.channels]);
                let want: f64 =
                    bands.iter().enumerate().map(|(l, b)| b * value(&legendre(l), cos)).sum();
                let off = (found - want.max(0.0)).abs();
                assert!(off <= 1e-5, "{exponent} {zenith_rad}: {off:e} of {want}");
                all.push(want);
            }
            // From above they would all be the first.
            assert!(all[1..].iter().all(|want| (want - all[0]).abs() > 1e-3), "{all:?}");
        }
    }
}

/// Share of a lobe that lies above horizontal, for one whose axis rises to `elevation_rad`, by quadrature: around the axis the
/// hemisphere holds the part of each circle of angle a with sin a cos t cos e + cos a sin e > 0.
fn above_horizontal(n: f64, elevation_rad: f64) -> f64 {
    let (sin, cos) = elevation_rad.sin_cos();
    let part = |a: f64| {
        let limit = -(a.cos() * sin) / (a.sin() * cos).max(1e-300);
        limit.clamp(-1.0, 1.0).acos() / PI
    };
    let panels = 2048;
    let width = FRAC_PI_2 / f64::from(panels);
    let at = |a: f64| (n + 1.0) * a.cos().powf(n) * a.sin() * part(a);
    (0..panels).map(|i| integral(width * f64::from(i), width * f64::from(i + 1), at)).sum()
}

/// A tilted plane under an open border and a sky of radiance 1 above horizontal and below: the lobe less the part that the plane
/// itself hides. It is linear in tables of 128 elevations and of peaks
/// no more than 1/4 of the lobe's deviation apart: their second differences over 8, 1/128 of the lobe each, and as much of the maps.
#[test]
fn a_tilted_plane_reflects_what_it_leaves_free() {
    let mut gpu = Device::new();
    for (exponent, tilt_deg) in [(0.0, 60.0), (1.0, 60.0), (5.0, 60.0), (20.0, 80.0), (100.0, 86.0)]
    {
        let tilt = f64::to_radians(tilt_deg);
        let n = f64::from(exponent);
        let plane = field(9, 9, [1.0, 1.0], |_, c| tilt.tan() * c as f64);
        let mut scene = shiny(plane, exponent, 0.5);
        // The mirror direction rises over the plane by 90° less the tilt.
        scene.surface.border = Border::Open;
        let quality = Quality { azimuths: 256, ..Quality::default() };
        let open = gpu.picture(&scene, &quality);
        let want = 0.5 * above_horizontal(n, FRAC_PI_2 - tilt);
        // Nothing rises over the middle of the eastern edge.
        let found = f64::from(open.values[(4 * 9 + 8) * open.channels]);
        let bound = 0.5 * (2.0 / 128.0);
        assert!((found - want).abs() < bound, "{exponent} {tilt_deg}: {found} for {want}");
        // The plane hides more than the bound.
        assert!(want < 0.5 - 2.0 * bound, "{exponent}: {want}");
    }
}

/// In a pit whose walls hide every mirror direction a lobe narrower than the gap between two azimuths reflects next to nothing: of
/// the walls' tops, more than 9 deviations away, e^-40.
#[test]
fn hidden_light_stays_hidden_between_azimuths() {
    let mut gpu = Device::new();
    let side = 33;
    let pit = field(side, side, [1.0, 1.0], |r, c| {
        let away = [r, c].map(|i| (i as f64 - 16.0).abs()).into_iter().fold(0.0, f64::max);
        // A floor that is tilted to mirror the zenith to 30 degrees, between azimuths 0 and 1 of 16; walls up to 70 degrees.
        let tilt = 30.0_f64.to_radians().tan();
        let (x, y) = (c as f64 - 16.0, 16.0 - r as f64);
        let turn = PI / 16.0;
        if away > 4.0 { 45.0 } else { -tilt * (x * turn.cos() + y * turn.sin()) }
    });
    let mut scene = shiny(pit, 1000.0, 0.5);
    for environment in [false, true] {
        if environment {
            let even = Environment::unknown(64, 32, 0.0).expect("an environment");
            scene.lights = Lights { environment: Some(even), ..Lights::default() };
        }
        let quality = Quality { azimuths: 16, method: Method::BruteForce, ..Quality::default() };
        let lit = gpu.picture(&scene, &quality);
        let found = lit.values[(16 * side + 16) * lit.channels];
        println!("{environment}: {found:e}");
        assert!(found.abs() < 1e-3, "{environment}: {found}");
    }
}

/// An environment of one colour is the sky of that colour. Azimuths and tables are the same but for the environment's rows, which
/// sum to the wedge: 1e-5, one rounding a row and piece.
#[test]
fn an_even_environment_is_a_sky() {
    let mut gpu = Device::new();
    let mut next = random(31);
    let noise: Vec<f64> = (0..63).map(|_| next()).collect();
    let rough = field(7, 9, [1.0, 1.3], |r, c| 1.5 * noise[r * 9 + c]);
    for border in [Border::Plane, Border::Open, Border::Periodic] {
        let mut scene = shiny(rough.clone(), 12.0, 0.5);
        scene.surface.border = border;
        // Even azimuths for both: brute force along the same directions.
        let quality = Quality { method: Method::BruteForce, azimuths: 16, ..Quality::default() };
        let of_sky = gpu.picture(&scene, &quality).values;
        let environment = Environment::unknown(64, 32, 0.0).expect("an environment");
        scene.lights = Lights { environment: Some(environment), ..Lights::default() };
        let of_environment = gpu.picture(&scene, &quality);
        let mut worst = 0.0_f64;
        for (i, sky) in of_sky.iter().enumerate() {
            let lit = of_environment.values[i * of_environment.channels];
            worst = worst.max(f64::from((lit - sky).abs()));
        }
        println!("{border:?}: {worst:e}");
        // 0.5, the largest reflection, times the error of both tables.
        assert!(worst < 0.5 * 1e-4, "{border:?}: {worst}");
    }
}

/// The eye sees the sun's reflection where the mirror direction meets the sun: on level ground, of all grid points the one
/// whose view direction is the sun's mirrored one is the brightest.
#[test]
fn a_highlight_follows_the_eye() {
    let mut gpu = Device::new();
    let mut scene = shiny(field(21, 21, [1.0, 1.0], |_, _| 3.0), 200.0, 0.5);
    let sun = Sun { azimuth_rad: 0.0, elevation_rad: 0.8, diameter_rad: 0.0, irradiance: [1.0; 3] };
    scene.lights = Lights { suns: vec![sun], ..Lights::default() };
    for (x, y) in [(5, 10), (12, 3), (16, 17)] {
        // The sun is in the east: it is mirrored to an eye in the west, as high as the sun.
        let away = 6.0;
        let eye_m = Some([x as f64 - away, y as f64, 3.0 + away * 0.8_f64.tan()]);
        let wanted = Picture { eye_m, ..Picture::default() };
        let plan =
            plan::picture(&scene, &Quality::default(), &gpu.limits(), wanted).expect("a plan");
        let lit = gpu.draw(plan, &[scene.field.heights_m()]).remove(0);
        let values = lit.values.iter().step_by(lit.channels).enumerate();
        let brightest = values.max_by(|a, b| a.1.total_cmp(b.1)).expect("texels").0;
        assert_eq!([brightest % 21, 20 - brightest / 21], [x, y]);
    }
}

/// A point sun at the zenith, or `off` beside it, on level ground: E · scale · (n + 1) / 2π · cosⁿ off, for exponents
/// from 0 to 1e4. Directions of f32 err by 3e-7, the power with their angle: n · off · 3e-7, and second order beside
/// it; the exponential by a few ulp.
#[test]
fn the_narrowest_and_the_widest_lobe_keep_their_digits() {
    let mut gpu = Device::new();
    for (off, exponent) in [(0.0, 1e4), (0.004, 1e4), (0.2, 30.0), (0.7, 1.0), (0.5, 0.0)] {
        let mut scene = shiny(field(3, 3, [1.0, 1.0], |_, _| 2.0), exponent, 0.6);
        let sun = Sun {
            azimuth_rad: 1.0,
            elevation_rad: FRAC_PI_2 - off,
            diameter_rad: 0.0,
            irradiance: [3.0; 3],
        };
        scene.lights = Lights { suns: vec![sun], ..Lights::default() };
        let found = f64::from(gpu.picture(&scene, &Quality::default()).values[4]);
        let n = f64::from(exponent);
        let want = 3.0 * f64::from(0.6_f32) * (n + 1.0) / (2.0 * PI) * off.cos().powf(n);
        let bound = want * (4e-6 + n * (off + 1e-3) * 3e-7);
        assert!((found - want).abs() < bound, "{exponent} {off}: {found} for {want} ± {bound}");
    }
}

/// Level ground mirrors a whole disc: the integral of the lobe over it, by a fine grid of azimuths and elevations. The lobe at
/// the disc's centre alone, which lit wide suns before, is refused where the lobe is narrow.
#[test]
fn a_wide_sun_is_mirrored_as_a_disc() {
    let mut gpu = Device::new();
    let (mut checked, mut wrong) = (0, 0);
    for (degrees, elevation_deg) in [(0.53, 88.0), (5.0, 85.0), (5.0, 70.0), (20.0, 75.0)] {
        // Narrower lobes are widened.
        let narrowest = 48.0 / f64::to_radians(0.5 * degrees).powi(2);
        let exponents = [1.0_f32, 20.0, 100.0, 1000.0, 10_000.0];
        for exponent in exponents.into_iter().filter(|n| f64::from(*n) <= narrowest) {
            let sun = Sun {
                azimuth_rad: 0.7,
                elevation_rad: f64::to_radians(elevation_deg),
                diameter_rad: f64::to_radians(degrees),
                irradiance: [3.0; 3],
            };
            let mut scene = shiny(field(4, 4, [1.0; 2], |_, _| 0.0), exponent, 0.5);
            scene.lights = Lights { suns: vec![sun], ..Lights::default() };
            let found = f64::from(gpu.picture(&scene, &Quality::default()).values[0]);
            let radius = 0.5 * sun.diameter_rad;
            let n = f64::from(exponent);
            let centre = DVec3::new(sun.elevation_rad.cos(), 0.0, sun.elevation_rad.sin());
            // Cells around the zenith, to which level ground mirrors, out to beyond the disc.
            let reach = FRAC_PI_2 - sun.elevation_rad + radius;
            let (rings, around) = (2000, 1000);
            let mut sum = 0.0;
            for ring in 0..rings {
                let zenith = reach * (f64::from(ring) + 0.5) / f64::from(rings);
                let cell = zenith.sin() * reach / f64::from(rings) * 2.0 * PI / f64::from(around);
                let density = (n + 1.0) / (2.0 * PI) * zenith.cos().powf(n);
                let inside = (0..around).filter(|k| {
                    let (sin, cos) = (2.0 * PI * f64::from(*k) / f64::from(around)).sin_cos();
                    let e = DVec3::new(zenith.sin() * cos, zenith.sin() * sin, zenith.cos());
                    e.dot(centre) >= radius.cos()
                });
                sum += density * cell * inside.count() as f64;
            }
            let radiance = 3.0 / (PI * radius.sin().powi(2));
            let want = 0.5 * radiance * sum;
            let facing = sun.elevation_rad.sin();
            // Cells at the edge are in or out: half a cell on either side, of a few thousand.
            let tolerance = 3.0
                * 0.5
                * (device_sun_specular(n, 8.0 * EPSILON, facing) + disc_rings(n, &sun, facing))
                + 2e-3 * want;
            assert!(
                (found - want).abs() <= tolerance,
                "{degrees} {n}: {found} for {want} ± {tolerance}"
            );
            let at_centre = 3.0 * 0.5 * (n + 1.0) / (2.0 * PI) * facing.powf(n);
            wrong += usize::from((at_centre - want).abs() > tolerance);
            checked += 1;
        }
    }
    assert!(checked >= 16 && wrong >= 6, "{checked} {wrong}");
}

/// Suns in a lobe match the quadrature: a point to f32's rounding. Where the horizon or the own plane cuts a disc of radius r, its light
/// and the middle of its visible part are known, from chords h = 1/16 of a radius apart: h² of the light. The ellipse's squared
/// widths are off by r²/4 at most, times the lobe's second derivative n. The third-order term is at most 1.38 n^1.5 r³ / 6. Up to a
/// thousandth of the disc may be hidden and go undetected.
#[test]
fn suns_in_a_lobe_are_the_quadratures() {
    let mut gpu = Device::new();
    let mut next = random(9);
    let noise: Vec<f64> = (0..48).map(|_| next()).collect();
    for (diameter_rad, exponent) in [(0.0, 1.0), (0.0, 300.0), (0.1, 20.0), (0.0093, 1000.0)] {
        let n = f64::from(exponent);
        let relief = 1.2 / n.sqrt();
        let rough = field(6, 8, [1.0, 1.5], |r, c| relief * noise[r * 8 + c]);
        let error = ShadeError::new(device_march_slope(relief, 1.0), relief, 1.0, 32);
        let sun = |azimuth_rad, elevation_rad, irradiance| Sun {
            azimuth_rad,
            elevation_rad,
            diameter_rad,
            irradiance,
        };
        let mut scene = shiny(rough, exponent, 0.5);
        // Two, which add up.
        let suns = vec![sun(2.0, 0.3, [2.0, 0.0, 0.0]), sun(-0.4, 1.5, [0.0, 1.0, 3.0])];
        scene.lights = Lights { suns, ..Lights::default() };
        let quality =
            Quality { method: Method::BruteForce, sun_azimuths: 32, ..Quality::default() };
        let picture = gpu.picture(&scene, &quality);
        let fineness = Fineness { azimuths: 8, divisions: 1, strips: 256 };
        let ground_truth = light(&scene, 0, fineness).expect("a ground truth").remove(0);
        let (peak, radius) = ((n + 1.0) / (2.0 * PI), 0.5 * diameter_rad);
        let mut lit = 0;
        for (i, want) in ground_truth.iter().enumerate() {
            for (c, want) in want.iter().enumerate() {
                let got = f64::from(picture.values[i * picture.channels + c]);
                let irradiance: f64 =
                    scene.lights.suns.iter().map(|s| f64::from(s.irradiance[c])).sum();
                // For a sun with a cosine of a tenth or less: ten times f32's share.
                let rounded = device_sun_specular(n, error.normal(), 0.1);
                let widest = scene.lights.suns[0];
                let wide = n * radius * radius;
                let cut = match radius > 0.0 {
                    true => 1.0 / 256.0 + wide / 4.0 + 1.38 / 6.0 * wide.powf(1.5) + 1e-3,
                    false => 0.0,
                };
                let uneven =
                    1.5 * disc_rings(n, &widest, 0.0).max(disc_rings(n, &widest, 1.0)) + peak * cut;
                let of_sum = 10.0 * PI * error.sun(if radius > 0.0 { PI } else { 1.0 }) * peak;
                let bound = 0.5 * irradiance * (rounded + uneven + of_sum);
                let off = (got - want).abs();
                assert!(off <= bound, "{diameter_rad} {n}: texel {i}: {off:e} of {bound:e}");
                lit += usize::from(*want > bound);
            }
        }
        println!(
            "{diameter_rad} {n}: {lit} of {} are above the noise of dark",
            3 * ground_truth.len()
        );
        assert!(lit >= 10, "cannot fail");
    }
}

/// Bundled terrain, its middle, under its sky of radiance 1 from the zenith to horizontal, by the lobe of exponent 5:
/// the higher the order, the smaller the error against the path-traced reference, and by slices of the lobe smaller than by any
/// order, by more than its Monte Carlo noise. Light without specular has a large error.
#[test]
fn higher_orders_are_nearer_to_the_path_traced_reference() {
    const BATCHES: usize = 4;
    const SIDE: usize = 16;
    let mut gpu = Device::new();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mt_washington_256.png");
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    let whole = files::read_heights(&path, &options).expect("the bundled field");
    let height = |r: usize, c: usize| f64::from(whole.heights_m()[(r + 120) * 256 + c + 120]);
    let scene = shiny(field(SIDE, SIDE, whole.cell_m(), height), 5.0, 1.0);
    let [ground_truth, standard] = traced(&mut gpu, &scene, 0, 1, BATCHES);
    let count = ground_truth.len() as f64;
    let noise = standard.iter().map(|e| e[0] * e[0]).sum::<f64>() / count;
    // The mean of squares d² less the noise's σ², and its own standard error from 4 d²σ² + 2 σ⁴.
    let squares = |gpu: &mut Device, quality: &Quality| {
        let got = gpu.picture(&scene, quality).values;
        let (mut sum, mut spread) = (0.0, 0.0);
        for ((got, want), error) in got.iter().zip(&ground_truth).zip(&standard) {
            let (off2, noise2) = ((f64::from(*got) - want[0]).powi(2), error[0] * error[0]);
            sum += off2;
            spread += 4.0 * off2 * noise2 + 2.0 * noise2 * noise2;
        }
        [sum / count - noise, spread.sqrt() / count]
    };
    let mean = ground_truth.iter().map(|t| t[0]).sum::<f64>() / count;
    let all = [sh(2), sh(4), Quality::default()].map(|quality| squares(&mut gpu, &quality));
    for (order, [square, error]) in ["order 2", "order 4", "slices"].iter().zip(all) {
        let rmse = square.max(0.0).sqrt();
        println!("{order}: RMSE {:.4} of the mean, squares ± {error:.1e}", rmse / mean);
    }
    let [[coarse, a], [fine, b], [slices, c]] = all;
    assert!(fine + 3.0 * a.hypot(b) < coarse, "{all:?}");
    assert!(slices + 3.0 * b.hypot(c) < fine, "{all:?}");
    assert!(coarse < 0.25 * mean * mean, "half of the light is missed");
}
