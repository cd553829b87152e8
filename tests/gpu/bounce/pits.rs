//! Spherical pits, bounce by bounce, by every engine against their closed form.

use std::f64::consts::TAU;

use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, HeightField, Method, Quality, Scene,
};

use crate::reference_page::{pit, pit_bounds, pit_radiance};
use crate::{Device, field, under_sky};

/// Half-angles and albedos; for two of them the reference numbers have some bounces and the limit, which match the
/// closed form.
const PITS: [(f64, f32); 4] = [(0.6, 0.7), (0.8, 0.5), (1.2, 0.9), (1.4, 0.3)];
/// After this many bounces each of them bounces a millionth of the light or less: the limit.
const LIMIT: usize = 12;
/// Cells from the middle to the rim.
const RIM: f64 = 12.5;

fn pit_of(field: HeightField, albedo: f32) -> Scene {
    let mut scene = under_sky(field, Border::Plane);
    scene.surface.albedo = Albedo::Constant([albedo; 3]);
    scene
}

/// Light with no bounce, one, and so on.
fn bounced(gpu: &mut Device, scene: &Scene, bounces: Bounces) -> Vec<Vec<f64>> {
    let Bounces { level_step, level_offset, .. } = bounces;
    let method = match bounces.engine {
        BounceEngine::BruteForce => Method::BruteForce,
        _ => Method::Sweep,
    };
    let azimuths = bounces.azimuths;
    let quality =
        Quality { method, azimuths, bounces, level_step, level_offset, ..Quality::default() };
    let wanted = Picture { light_layers: true, ..Picture::default() };
    let plan = plan::picture(scene, &quality, &gpu.limits(), wanted).expect("a plan");
    let outputs = gpu.draw(plan, &[scene.field.heights_m()]);
    let layers = outputs.iter().filter(|p| p.name != "radiance");
    let mut all: Vec<Vec<f64>> = Vec::new();
    for layer in layers {
        let values = layer.values.iter().step_by(layer.channels).map(|v| f64::from(*v));
        let sum = match all.last() {
            Some(before) => before.iter().zip(values).map(|(a, b)| a + b).collect(),
            None => values.collect(),
        };
        all.push(sum);
    }
    assert_eq!(all.len(), bounces.count as usize + 1);
    all
}

fn bounces_of(engine: BounceEngine) -> Bounces {
    Bounces { count: LIMIT as u32, engine, azimuths: 32, cutoff: 0.0, ..Bounces::default() }
}

/// RMSE over the closed form, %, of the texels that have a bound.
fn rmse(light: &[f64], bounds: &[(usize, f64)], expected: f64) -> f64 {
    let squares: f64 = bounds.iter().map(|(i, _)| (light[*i] - expected).powi(2)).sum();
    100.0 * (squares / bounds.len() as f64).sqrt() / expected
}

/// Bounces 0 to 4 and the limit, within the error of the rim's staircase.
#[test]
fn exact_engines_match_the_closed_form_of_pits() {
    let mut gpu = Device::new();
    for (alpha, albedo) in PITS {
        let (scene, rho) = (pit_of(pit(RIM, alpha), albedo), f64::from(albedo));
        let bounds = pit_bounds(RIM, alpha, rho, LIMIT);
        for engine in [BounceEngine::BruteForce, BounceEngine::Sweep] {
            let all = bounced(&mut gpu, &scene, bounces_of(engine));
            let mut said = Vec::new();
            for count in (0..=4).chain([LIMIT]) {
                let expected = match count {
                    LIMIT => pit_radiance(alpha, rho, 1000),
                    count => pit_radiance(alpha, rho, count),
                };
                // Later bounces up to the limit.
                let left = pit_radiance(alpha, rho, 1000) - pit_radiance(alpha, rho, LIMIT);
                let left = if count == LIMIT { left } else { 0.0 };
                // The rim's own cells bounce between the pit's light and the plain's, ρ: as much of the gained sky, 1
                // - L, as ρ - L is of that.
                let before = count.checked_sub(1).map_or(1.0, |b| pit_radiance(alpha, rho, b));
                let rim = 1.0 + (rho - before).max(0.0) / (1.0 - before).max(1e-9);
                for (i, bound) in &bounds[count] {
                    let (off, bound) = ((all[count][*i] - expected).abs(), rim * bound + left);
                    assert!(off <= bound, "{engine:?} {alpha} {albedo} {count} {i}: {off} {bound}");
                }
                said.push(format!("{:.2}", rmse(&all[count], &bounds[count], expected)));
            }
            println!("{alpha}, {albedo}, {}: {} %", engine, said.join(", "));
        }
    }
}

/// A pit whose rim has no staircase as visible from its middle: texels of the plain beside the pit's stand on the cone
/// from the pit's lowest point through its rim, which rises by tan(α/2).
fn rimmed_pit(rim: f64, alpha: f64) -> HeightField {
    let (sphere, middle) = (rim / alpha.sin(), rim.ceil() + 1.0);
    let side = 2 * middle as usize + 1;
    let away = |r: f64, c: f64| (r - middle).hypot(c - middle);
    let around = (0..9).map(|i| [f64::from(i / 3) - 1.0, f64::from(i % 3) - 1.0]);
    field(side, side, [1.0; 2], |r, c| {
        let (r, c) = (r as f64, c as f64);
        let beyond = away(r, c) - rim;
        let is_beside = around.clone().any(|[down, right]| away(r + down, c + right) <= rim);
        match beyond {
            ..=0.0 => -(sphere * sphere - away(r, c).powi(2)).sqrt(),
            _ if is_beside => beyond * (0.5 * alpha).tan() - sphere * alpha.cos(),
            _ => -sphere * alpha.cos(),
        }
    })
}

/// The change of sky at a point of that pit, `away` from its axis, on the grid.
///
/// A ray leaves the pit's texels between two of the cone's, δ ≤ √2 cells behind the rim. The surface is as high there
/// as the cone, δ tan(α/2), and a chord's arrow of s² / 8D more, s² ≤ 2, times the same slope. The rim, at D, is visible
/// at ω: ground that stands by h over its line of sight at D changes the horizon by h cos²ω / D, and the sky by N·e
/// cos ω of that. Flat triangles instead of the sphere: second order in a cell over R.
fn sky_changed(away: f64, rim: f64, alpha: f64) -> f64 {
    let (sphere, rise) = (rim / alpha.sin(), (0.5 * alpha).tan());
    let depth = (sphere * sphere - away * away).sqrt() - sphere * alpha.cos();
    let m = 64;
    let of = |k: i32| {
        let (sin, cos) = (TAU * (f64::from(k) + 0.5) / f64::from(m)).sin_cos();
        let distance = (rim * rim - (away * sin).powi(2)).sqrt() - away * cos;
        let chord = distance.hypot(depth);
        let slope = depth / distance;
        let over = 2_f64.sqrt() * (rise - slope).abs() + rise / (4.0 * rim);
        chord / (2.0 * sphere) * (distance / chord).powi(3) * over / distance
    };
    2.0 / f64::from(m) * (0..m).map(of).sum::<f64>() + 1.0 / (sphere * sphere)
}

/// Brute force is exact: at 64 and at 256 azimuths it is within 0.2 % of the closed form where the field has no
/// staircase. The staircase of a rim 30 cells away alone takes more, in the f64 quadrature, too (`cargo measure bounce`).
/// Every texel's sky is within its bound.
#[test]
fn exact_bounces_of_pits_are_within_a_five_hundredth() {
    const FAR: f64 = 30.5;
    const MOST: f64 = 0.2;
    let mut gpu = Device::new();
    // The deep pit is the worse one; the other is as exact with fewer azimuths, which costs less.
    for (alpha, albedo, azimuths) in [(0.8, 0.5, 64), (1.2, 0.9, 256)] {
        let rho = f64::from(albedo);
        let side = pit(FAR, alpha).cols();
        let middle = (side / 2) as f64;
        let away = |i: usize| ((i / side) as f64 - middle).hypot((i % side) as f64 - middle);
        let inner = (0..side * side).filter(|i| away(*i) <= 0.5 * FAR);
        let bounds: Vec<(usize, f64)> =
            inner.map(|i| (i, rho * sky_changed(away(i), FAR, alpha))).collect();
        let of =
            |count, azimuths| Bounces { count, azimuths, ..bounces_of(BounceEngine::BruteForce) };
        let all = bounced(&mut gpu, &pit_of(rimmed_pit(FAR, alpha), albedo), of(2, azimuths));
        let errors: Vec<f64> = (0..=2)
            .map(|count| rmse(&all[count], &bounds, pit_radiance(alpha, rho, count)))
            .collect();
        println!("{alpha}, {albedo}: {errors:.3?} %");
        assert!(errors.iter().all(|error| *error <= MOST), "{alpha} {albedo}: {errors:?}");
        for (i, bound) in &bounds {
            let off = (all[0][*i] - pit_radiance(alpha, rho, 0)).abs();
            assert!(off <= *bound, "{alpha} {albedo} {i}: {off} {bound}");
        }
        let stairs = bounced(&mut gpu, &pit_of(pit(FAR, alpha), albedo), of(0, 64));
        let error = rmse(&stairs[0], &bounds, pit_radiance(alpha, rho, 0));
        assert!(error > MOST, "{alpha} {albedo}: the staircase is not visible: {error}");
    }
}

/// Pyramids smooth near ground: they have no bound of their own, but finer levels have smaller errors, and no texel
/// gets more than all ground at its brightest would give.
#[test]
fn pyramids_tend_to_the_closed_form_of_pits() {
    let mut gpu = Device::new();
    for (alpha, albedo) in PITS {
        let (scene, rho) = (pit_of(pit(RIM, alpha), albedo), f64::from(albedo));
        let bounds = pit_bounds(RIM, alpha, rho, LIMIT);
        let mut errors = Vec::new();
        for (level_step, level_offset) in [(2, 0), (8, 3)] {
            let bounces = Bounces { level_step, level_offset, ..bounces_of(BounceEngine::Pyramid) };
            let all = bounced(&mut gpu, &scene, bounces);
            let mut said = Vec::new();
            for count in (0..=4).chain([LIMIT]) {
                let expected = pit_radiance(alpha, rho, count);
                said.push(rmse(&all[count], &bounds[count], expected));
            }
            println!("{alpha}, {albedo}, k {level_step}, o {level_offset}: {said:.2?} %");
            let most = |of: &[f64]| of.iter().fold(0.0_f64, |m, v| m.max(*v));
            for two in all.windows(3) {
                let [before, now]: [Vec<f64>; 2] =
                    [0, 1].map(|k| two[k + 1].iter().zip(&two[k]).map(|(a, b)| a - b).collect());
                assert!(most(&now) <= rho * most(&before) * (1.0 + 1e-5), "{alpha} {albedo}");
            }
            errors.push(said[5]);
        }
        assert!(errors[1] < errors[0], "{alpha} {albedo}: {errors:?}");
    }
}
