//! Numbers found by quadrature independently of this crate (`tests/basis/reference_numbers.json`), against the kernel
//! that computes them: to 1e-6 of the norm of the kernel's vector, unless a test gives a reason.
//!
//! A kernel's result is a sum of n terms of the size of a whole sphere's, each with an error of a few 2⁻²⁴: for n up
//! to 16 that is 1e-6. Where little of a whole sphere is visible, the error is relative to the sphere, not to the
//! result.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::{bands, index, zonal};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Basis, Border, Environment, HeightField, Lights, Method, PhongSpecular, Quality,
    Receiver, Scene, Specular, SphereLight, Surface, Wedges,
};
use ridgelight_cpu::basis::azimuth::Blend;
use ridgelight_cpu::basis::occlusion;
use ridgelight_cpu::basis::receiver as polynomials;
use ridgelight_cpu::basis::rotate_z;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sh_visibility::{Series, visibility_above};
use serde_json::Value;

use crate::{Device, field, random, under_sky};

const NEAR: f64 = 1e-6;

fn reference(name: &str) -> Vec<Value> {
    let all: Value =
        serde_json::from_str(include_str!("../../basis/reference_numbers.json")).expect("JSON");
    all[name].as_array().expect("a list").clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The largest difference over the norm, printed, and checked against `tolerance`.
#[track_caller]
fn near(what: &str, got: &[f64], want: &[f64], scale: f64, tolerance: f64) {
    assert_eq!(got.len(), want.len(), "{what}");
    let larger = |m: f64, v: f64| if v > m || v.is_nan() { v } else { m };
    let off = got.iter().zip(want).map(|(g, w)| (g - w).abs()).fold(0.0, larger) / scale;
    println!("{what}: {off:.2e} of {tolerance:.2e}");
    assert!(off <= tolerance, "{what}: {off:e}: {got:?} for {want:?}");
}

/// Four neighbours in the grid's directions rise that far above the middle, a cell away; the middle's normal is level.
/// One texel where nothing rises.
fn bowl(slope: f64) -> HeightField {
    field(3, 3, [1.0, 1.0], |r, c| if r == 1 && c == 1 { 0.0 } else { slope })
}

fn harmonics(azimuths: u32, sh_order: u32, wedges: Wedges) -> Quality {
    Quality {
        method: Method::BruteForce,
        basis: Basis::Sh,
        receiver: Receiver::Cosine,
        azimuths,
        sh_order,
        wedges,
        ..Quality::default()
    }
}

fn white() -> Environment {
    Environment::new(16, 8, vec![[1.0; 3]; 128], 0.0).expect("an environment")
}

/// Under a white environment.
fn visible_in(field: HeightField, border: Border) -> Scene {
    let lights = Lights { environment: Some(white()), ..Lights::default() };
    Scene { field, surface: Surface { border, ..Surface::default() }, lights }
}

/// The contents of an image of a picture, after the passes up to those that write it: no other shaders compile.
fn image(gpu: &mut Device, scene: &Scene, quality: &Quality, name: &str) -> Vec<f64> {
    let plan = plan::picture(scene, quality, &gpu.limits(), Picture::default());
    let mut plan = plan.expect("a plan");
    let id = plan.find(name).expect(name);
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let last = plan.passes.iter().rposition(|p| p.writes().any(|w| w == id)).expect("written");
    plan.passes.truncate(last + 1);
    let gpu = gpu.gpu.as_mut().expect("alive");
    let words = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        gpu.read(frame, id)
    });
    words.expect("drawn").into_iter().map(|w| f32::from_bits(w).into()).collect()
}

/// The series of the middle texel.
fn series(gpu: &mut Device, scene: &Scene, quality: &Quality) -> Vec<f64> {
    let texels = image(gpu, scene, quality, "visibility");
    let count = scene.field.rows() * scene.field.cols();
    let order = quality.sh_order as usize;
    (0..order * order).map(|k| texels[(k / 4 * count + count / 2) * 4 + k % 4]).collect()
}

/// `nlp_occlusion` through `sh_visibility`: under a horizon at σ all around, the visible Y_l0 is √2π times the NLP
/// coefficients of the part above, (√2, 0, …) less those of the part below. A straight wall is one of 1e6 cells: 1e-12
/// of it is open.
#[test]
fn occlusion_by_legendre_coefficients() {
    let mut gpu = Device::new();
    for entry in reference("nlp_occlusion") {
        let sigma = number(&entry["sigma"]);
        let (ground, border) = match sigma {
            s if s < -1.5 => (field(1, 1, [1.0, 1.0], |_, _| 0.0), Border::Open),
            s if s > 1.5 => (bowl(1e6), Border::Open),
            s => (bowl(s.tan()), Border::Open),
        };
        let scene = visible_in(ground, border);
        let got = series(&mut gpu, &scene, &harmonics(4, 6, Wedges::Nlp));
        let mut want: Vec<f64> = numbers(&entry["order6"]).iter().map(|below| -below).collect();
        want[0] += SQRT_2;
        let got: Vec<f64> = (0..6).map(|l| got[index(l, 0)] / TAU.sqrt()).collect();
        // At the zenith the norm is 0.
        let scale = if sigma > 1.5 { SQRT_2 } else { norm(&want) };
        near(&format!("nlp_occlusion {sigma:.2}"), &got, &want, scale, NEAR);
    }
}

/// `nlp_to_sh` through `sh_visibility`, which takes each azimuth for its whole wedge. A blend from one to the next all
/// around only damps turn m by sinc(mΔφ/2)², by B-splines to the fourth power: so the kernel's series, damped, is the
/// sum of the reference's matrices, each turned to its wedge.
#[test]
fn blend_matrices_all_around() {
    let mut gpu = Device::new();
    let mut next = random(3);
    let noise: Vec<f64> = (0..25).map(|_| next()).collect();
    let scene = visible_in(field(5, 5, [1.0, 1.0], |r, c| noise[r * 5 + c]), Border::Plane);
    let oracle = Oracle::new(&scene.field, Border::Plane);
    for entry in reference("nlp_to_sh") {
        let count = number(&entry["m"]) as usize;
        let width = number(&entry["delta_phi"]);
        let got = series(&mut gpu, &scene, &harmonics(count as u32, 4, Wedges::Nlp));
        let above: Vec<Vec<f64>> = (0..count)
            .map(|k| {
                let (sin, cos) = oracle.elevation_rad(2, 2, width * k as f64).max(0.0).sin_cos();
                let mut above: Vec<f64> = occlusion(4, sin, cos).iter().map(|b| -b).collect();
                above[0] += SQRT_2;
                above
            })
            .collect();
        for (blend, name, reach, power) in [
            (Blend::Linear, "linear_16x8", &[0, 1][..], 2),
            (Blend::BSpline, "bspline_16x16", &[count - 1, 0, 1, 2], 4),
        ] {
            let matrix: Vec<Vec<f64>> =
                entry[name].as_array().expect("rows").iter().map(numbers).collect();
            let mut want = vec![0.0; 16];
            for j in 0..count {
                let stacked: Vec<f64> =
                    reach.iter().flat_map(|i| above[(j + i) % count].clone()).collect();
                let wedge: Vec<f64> = matrix
                    .iter()
                    .map(|row| row.iter().zip(&stacked).map(|(m, v)| m * v).sum())
                    .collect();
                let turned = rotate_z(&wedge, width * j as f64);
                want.iter_mut().zip(turned).for_each(|(w, t)| *w += t);
            }
            let damped: Vec<f64> = bands(4)
                .zip(&got)
                .map(|((_, m), v)| {
                    let x = 0.5 * m as f64 * width;
                    v * if m == 0 { 1.0 } else { (x.sin() / x).powi(power) }
                })
                .collect();
            near(&format!("nlp_to_sh {count} {blend:?}"), &damped, &want, norm(&want), NEAR);
        }
    }
}

/// `zh_clamped_cosine` through `light_matrix`: under light of 1 from everywhere the matrix is diagonal, with the
/// receiver's bands times the factors of Y_lm before their polynomials. A diffuse receiver keeps three bands; the lobe
/// of exponent 1, which is the cosine over π, all six.
#[test]
fn bands_of_the_clamped_cosine() {
    let mut gpu = Device::new();
    let all: Value =
        serde_json::from_str(include_str!("../../basis/reference_numbers.json")).expect("JSON");
    let expected = numbers(&all["zh_clamped_cosine"]);
    let level = || field(1, 1, [1.0, 1.0], |_, _| 0.0);
    let diagonal = |matrix: &[f64], order: usize, rows: usize| -> Vec<f64> {
        (0..rows).map(|i| matrix[4 * (i * order * order + i)]).collect()
    };
    let quality = harmonics(4, 4, Wedges::Slices);
    let matrix = image(&mut gpu, &visible_in(level(), Border::Open), &quality, "light_matrix");
    let normal = DVec3::new(0.3, -0.5, 0.8).normalize();
    let (values, polynomials) = (evaluate(3, normal), polynomials(normal.to_array()));
    let got: Vec<f64> = diagonal(&matrix, 4, 9)
        .iter()
        .zip(bands(3).enumerate())
        .map(|(m, (i, (l, _)))| {
            let before = values[i] / polynomials[i];
            m * PI / before / (4.0 * PI / (2 * l + 1) as f64).sqrt()
        })
        .collect();
    let want: Vec<f64> = bands(3).map(|(l, _)| expected[l]).collect();
    near("zh_clamped_cosine, cosine of 3 bands", &got, &want, norm(&expected), NEAR);
}

/// `zh_cap` through `sh_visibility`: above a level horizon lies a cap about the zenith. Each coefficient is a
/// polynomial in the horizon's sine whose terms nearly cancel for small caps: 8 roundings of terms that sum to √2π ·
/// 1.5 at most, whatever is left. So 1e-6 is relative to the whole sphere's norm, 2√π; for a cap of 0.01 rad itself it
/// would need 1 - sin, which loses no digits, in place of the sine.
///
/// The disc's light on level ground is π sin²a of its radiance, √(4π/3) of its band 1: through `sphere_shade` that is
/// 1e-6 of itself, however small, by a sphere light straight above.
#[test]
fn caps() {
    let mut gpu = Device::new();
    for entry in reference("zh_cap") {
        let half = number(&entry["half_angle"]);
        let zh = numbers(&entry["zh"]);
        let ground = match half {
            a if a > 3.0 => field(1, 1, [1.0, 1.0], |_, _| 0.0),
            a => bowl((FRAC_PI_2 - a).tan()),
        };
        let scene = visible_in(ground, Border::Open);
        let got = series(&mut gpu, &scene, &harmonics(4, 4, Wedges::Slices));
        let mut want = vec![0.0; 16];
        zh.iter().enumerate().for_each(|(l, v)| want[index(l, 0)] = *v);
        near(&format!("zh_cap {half:.2}, of a sphere"), &got, &want, 2.0 * PI.sqrt(), NEAR);
        let off: Vec<f64> = got.iter().zip(&want).map(|(g, w)| g - w).collect();
        println!("zh_cap {half:.2}, of itself: {:.2e}", norm(&off) / norm(&zh));
        if half > 1.5 {
            continue;
        }
        let radius_m = 100.0 * half.sin();
        let sphere_light =
            SphereLight { position_m: [1.0, 1.0, 100.0], radius_m, radiance: [1.0; 3] };
        let mut scene = under_sky(field(3, 3, [1.0, 1.0], |_, _| 0.0), Border::Plane);
        scene.lights = Lights { sphere_lights: vec![sphere_light], ..Lights::default() };
        let light = f64::from(gpu.picture(&scene, &Quality::default()).values[4]);
        let band = light * PI / (4.0 * PI / 3.0).sqrt();
        near(&format!("zh_cap {half:.2}, a sphere light"), &[band], &zh[1..2], zh[1], NEAR);
    }
}

/// `sn08_wedge` through `sh_wedges`: on level ground every wedge lies between two horizons of 0, an entry of the table,
/// and over the circle turns cancel: 32 times its Y_l0 are left. Other horizons lie between texels, where a table errs
/// by [`WedgeTable::error`](ridgelight::basis::wedge::WedgeTable::error), 1e-5 of a wedge at 256 horizons a side: no
/// look-up is exact to 1e-6; the test against the CPU reference checks the kernel's look-up.
#[test]
fn wedges_of_level_horizons() {
    let mut gpu = Device::new();
    let wedge = numbers(&reference("sn08_wedge")[0]["sh16"]);
    let scene = visible_in(field(1, 1, [1.0, 1.0], |_, _| 0.0), Border::Plane);
    let got = series(&mut gpu, &scene, &harmonics(32, 4, Wedges::Table));
    let mut want = vec![0.0; 16];
    (0..4).for_each(|l| want[index(l, 0)] = 32.0 * wedge[index(l, 0)]);
    near("sn08_wedge 0, 0", &got, &want, norm(&want), NEAR);
}

/// `spherical_pit` without bounces through `horizon_march` and `sky_shade`: from its bottom, the rim of a cap of
/// half-angle α stands at α/2 all around. Elsewhere in a pit of triangles the rim is a polygon, and bounces have Monte
/// Carlo noise: neither is exact to 1e-6, and other tests bound both.
#[test]
fn the_bottom_of_a_pit() {
    let mut gpu = Device::new();
    let grid_points = reference("spherical_pit");
    let direct = grid_points.iter().filter(|s| s["bounces"] == 0);
    for entry in direct {
        let rise = (0.5 * number(&entry["alpha"])).tan();
        let mut scene = under_sky(bowl(rise), Border::Plane);
        scene.surface.albedo = Albedo::Constant([number(&entry["albedo"]) as f32; 3]);
        let quality = Quality { method: Method::BruteForce, azimuths: 4, ..Quality::default() };
        let got = f64::from(gpu.picture(&scene, &quality).values[4]);
        let want = number(&entry["radiance"]);
        near("spherical_pit", &[got], &[want], want, NEAR);
    }
}

/// `sh_samples` through `sh_shade`'s specular, which is turned to the mirror direction of the view by its Y_lm: a plane
/// that reflects straight above to the sampled direction, under a sky of radiance 1 and nothing below. The plane's
/// visibility is computed in f64; Y_lm are the reference's.
#[test]
fn values_of_harmonics() {
    let mut gpu = Device::new();
    for entry in reference("sh_samples") {
        let (theta, phi) = (number(&entry["theta"]), number(&entry["phi"]));
        let values = numbers(&entry["Y16"]);
        let tilt = (0.5 * theta).tan();
        let (north, east) = (-tilt * phi.sin(), -tilt * phi.cos());
        let plane = field(3, 3, [1.0, 1.0], |r, c| east * c as f64 + north * (2.0 - r as f64));
        for exponent in [1.0_f32, 2.0, 40.0] {
            let mut scene = under_sky(plane.clone(), Border::Open);
            scene.surface.albedo = Albedo::Constant([0.0; 3]);
            scene.surface.specular =
                Some(Specular::Constant(PhongSpecular { exponent, scale: 1.0 }));
            let quality = harmonics(16, 4, Wedges::Slices);
            let plan = plan::picture(&scene, &quality, &gpu.limits(), Picture::default());
            let along = |a: &plan::Azimuth| {
                let slope = east * f64::from(a.cos_phi) + north * f64::from(a.sin_phi);
                (*a, slope)
            };
            let lowest: Vec<_> = plan.expect("a plan").azimuths.iter().map(along).collect();
            let how = Series { order: 4, wedges: Wedges::Slices, receiver: Receiver::Cosine };
            let visible = visibility_above(how, &lowest);
            let phong_specular = zonal::phong(4, exponent.into());
            let terms: Vec<f64> = bands(4)
                .enumerate()
                .map(|(i, (l, _))| {
                    phong_specular[l]
                        * (4.0 * PI / (2 * l + 1) as f64).sqrt()
                        * values[i]
                        * visible[i]
                })
                .collect();
            let got = image(&mut gpu, &scene, &quality, "specular_sum")[4 * 4];
            let summed = terms.iter().map(|t| t.abs()).sum();
            let name = format!("sh_samples {theta} {phi}, exponent {exponent}");
            near(&name, &[got], &[terms.iter().sum::<f64>().max(0.0)], summed, NEAR);
        }
    }
}

/// An error of 2e-6 of the norm fails.
#[test]
fn the_comparison_can_fail() {
    let off = std::panic::catch_unwind(|| near("x", &[1.0 + 2e-6], &[1.0], 1.0, NEAR));
    let none = std::panic::catch_unwind(|| near("x", &[f64::NAN], &[1.0], 1.0, NEAR));
    assert!(off.is_err() && none.is_err());
}
