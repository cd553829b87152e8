//! Spherical pits, bounce by bounce, by every engine against their closed form.

use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Albedo, Border, BounceEngine, Bounces, Method, Quality, Scene};

use crate::reference_page::{pit, pit_bounds, pit_radiance};
use crate::{Device, under_sky};

/// Half-angles and albedos; of two the project's reference numbers know some bounces and the limit, which the
/// closed form meets.
const PITS: [(f64, f32); 4] = [(0.6, 0.7), (0.8, 0.5), (1.2, 0.9), (1.4, 0.3)];
/// Of a millionth of the light and less no more is thrown on by any of them: the limit.
const LIMIT: usize = 12;
/// Cells from the middle to the rim.
const RIM: f64 = 12.5;

fn pit_of(alpha: f64, albedo: f32) -> Scene {
    let mut scene = under_sky(pit(RIM, alpha), Border::Plane);
    scene.surface.albedo = Albedo::Constant([albedo; 3]);
    scene
}

/// Light with no bounce, one, and so on.
fn bounced(gpu: &mut Device, scene: &Scene, bounces: Bounces) -> Vec<Vec<f64>> {
    let Bounces { level_step, level_offset, .. } = bounces;
    let method = match bounces.engine {
        BounceEngine::Brute => Method::Brute,
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

fn thrown(engine: BounceEngine) -> Bounces {
    Bounces { count: LIMIT as u32, engine, azimuths: 32, cutoff: 0.0, ..Bounces::default() }
}

/// RMSE over the closed form, %, of the samples that have a bound.
fn rmse(light: &[f64], bounds: &[(usize, f64)], expected: f64) -> f64 {
    let squares: f64 = bounds.iter().map(|(i, _)| (light[*i] - expected).powi(2)).sum();
    100.0 * (squares / bounds.len() as f64).sqrt() / expected
}

/// Bounces 0 to 4 and the limit, within what the rim's staircase may do.
#[test]
fn pits_are_lit_as_their_closed_form() {
    let mut gpu = Device::new();
    for (alpha, albedo) in PITS {
        let (scene, rho) = (pit_of(alpha, albedo), f64::from(albedo));
        let bounds = pit_bounds(RIM, alpha, rho, LIMIT);
        for engine in [BounceEngine::Brute, BounceEngine::Sweep] {
            let all = bounced(&mut gpu, &scene, thrown(engine));
            let mut said = Vec::new();
            for count in (0..=4).chain([LIMIT]) {
                let expected = match count {
                    LIMIT => pit_radiance(alpha, rho, 1000),
                    count => pit_radiance(alpha, rho, count),
                };
                // What later bounces would add to the limit.
                let left = pit_radiance(alpha, rho, 1000) - pit_radiance(alpha, rho, LIMIT);
                let left = if count == LIMIT { left } else { 0.0 };
                // The rim's own cells throw what is between the pit's light and the plain's, ρ: as much of what is
                // gained of sky, 1 - L, as ρ - L is of that.
                let before = count.checked_sub(1).map_or(1.0, |b| pit_radiance(alpha, rho, b));
                let rim = 1.0 + (rho - before).max(0.0) / (1.0 - before).max(1e-9);
                for (i, bound) in &bounds[count] {
                    let (off, bound) = ((all[count][*i] - expected).abs(), rim * bound + left);
                    assert!(off <= bound, "{engine:?} {alpha} {albedo} {count} {i}: {off} {bound}");
                }
                said.push(format!("{:.2}", rmse(&all[count], &bounds[count], expected)));
            }
            println!("{alpha}, {albedo}, {}: {} %", engine.name(), said.join(", "));
        }
    }
}

/// Pyramids smooth what stands near: they have no bound of their own, but finer levels come nearer, and no sample
/// gets more than all ground at its brightest would give.
#[test]
fn pyramids_come_to_pits() {
    let mut gpu = Device::new();
    for (alpha, albedo) in PITS {
        let (scene, rho) = (pit_of(alpha, albedo), f64::from(albedo));
        let bounds = pit_bounds(RIM, alpha, rho, LIMIT);
        let mut errors = Vec::new();
        for (level_step, level_offset) in [(2, 0), (8, 3)] {
            let bounces = Bounces { level_step, level_offset, ..thrown(BounceEngine::Pyramid) };
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
