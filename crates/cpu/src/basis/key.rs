//! Visible part of key lights as spherical harmonics (NS09 §6, supplement §1). Pictures sum the light itself instead.
//!
//! Horizons are sampled at a few azimuths across the light. The visible elevations of each azimuth are the intersection
//! of [horizon, π/2] with the light's. The light is uniform, so light times visibility is this visibility times a
//! radiance: a sum of slices, without a product of two series.

use super::azimuth::{Blend, assemble, assemble_nlp, swath};
use super::occlusion;
use ridgelight::basis::slice::Slices;
use ridgelight::scene::KeyLight;

/// Azimuths of the horizons: `count` of them, 2 or more, from end to end (NS09: 3).
pub fn azimuths(key: &KeyLight, count: usize) -> Vec<f64> {
    assert!(count >= 2, "{count} azimuths across a light");
    let step = key.width_rad / (count - 1) as f64;
    (0..count).map(|k| first_rad(key) + step * k as f64).collect()
}

/// NLP coefficients of the visible part above a horizon: v̂(high) - v̂(low) (NS09 eq. 11, §6).
pub fn nlp(key: &KeyLight, order: usize, horizon_rad: f64) -> Vec<f64> {
    let below = |elevation: f64| occlusion(order, elevation.sin(), elevation.cos());
    let [low, high] = visible_elevations(key, horizon_rad).map(below);
    high.iter().zip(low).map(|(h, l)| h - l).collect()
}

/// Y_lm of the light of radiance 1 above horizons at [`azimuths`], 2 or more: n² coefficients.
pub fn visible(key: &KeyLight, slices: &Slices, blend: Blend, horizons_rad: &[f64]) -> Vec<f64> {
    let visible = horizons_rad.iter().map(|&horizon| {
        let [low, high] = visible_elevations(key, horizon);
        slices.between(low, high)
    });
    let weights = weights(key, slices.order(), blend, horizons_rad.len());
    assemble(slices.order(), &weights, &visible.collect::<Vec<_>>())
}

/// [`visible`] by NLP, as in the paper.
pub fn visible_nlp(key: &KeyLight, order: usize, blend: Blend, horizons_rad: &[f64]) -> Vec<f64> {
    let visible: Vec<_> = horizons_rad.iter().map(|h| nlp(key, order, *h)).collect();
    assemble_nlp(order, &weights(key, order, blend, horizons_rad.len()), &visible)
}

/// The light's visible elevations above a horizon; two equal values where none is visible.
fn visible_elevations(key: &KeyLight, horizon_rad: f64) -> [f64; 2] {
    let [lowest, highest] = key.elevations_rad;
    let low = lowest.max(horizon_rad).min(highest);
    [low, highest]
}

fn first_rad(key: &KeyLight) -> f64 {
    key.azimuth_rad - key.width_rad / 2.0
}

fn weights(key: &KeyLight, order: usize, blend: Blend, count: usize) -> Vec<Vec<f64>> {
    swath(order, blend, first_rad(key), key.width_rad, count)
}
