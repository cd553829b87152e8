//! Key lights as spherical harmonics: what is seen of one, between two azimuths and two elevations (NS09
//! §6, supplement §1). Pictures do without: they sum the light itself.
//!
//! Horizons are taken at a few azimuths across it. Of each, what counts is where [horizon, π/2] and the
//! light's elevations meet. The light being uniform, light times visibility is that restricted visibility
//! itself: a sum of slices times a radiance, no product of two series.

use super::KeyLight;
use crate::basis::azimuth::{Blend, assemble, assemble_nlp, swath};
use crate::basis::legendre::occlusion;
use crate::basis::slice::Slices;

impl KeyLight {
    /// Where horizons are taken: `count` azimuths from end to end (NS09: 3).
    ///
    /// # Panics
    /// When `count` is below 2.
    pub fn azimuths(&self, count: usize) -> Vec<f64> {
        assert!(count >= 2, "{count} azimuths across a light");
        let step = self.width_rad / (count - 1) as f64;
        (0..count).map(|k| self.first_rad() + step * k as f64).collect()
    }

    /// The elevations that are seen above a horizon; equal where there are none.
    pub fn seen(&self, horizon_rad: f64) -> [f64; 2] {
        let [lowest, highest] = self.elevations_rad;
        let low = lowest.max(horizon_rad).min(highest);
        [low, highest]
    }

    /// NLP coefficients of what is seen above a horizon: v̂(high) - v̂(low) (NS09 eq. 11, §6).
    pub fn nlp(&self, order: usize, horizon_rad: f64) -> Vec<f64> {
        let below = |elevation: f64| occlusion(order, elevation.sin(), elevation.cos());
        let [low, high] = self.seen(horizon_rad).map(below);
        high.iter().zip(low).map(|(h, l)| h - l).collect()
    }

    /// Y_lm of the light of radiance 1 above horizons at [`azimuths`](Self::azimuths): n² coefficients.
    ///
    /// # Panics
    /// When there are fewer than 2 horizons.
    pub fn visible(&self, slices: &Slices, blend: Blend, horizons_rad: &[f64]) -> Vec<f64> {
        let seen = horizons_rad.iter().map(|&horizon| {
            let [low, high] = self.seen(horizon);
            slices.between(low, high)
        });
        let weights = self.weights(slices.order(), blend, horizons_rad.len());
        assemble(slices.order(), &weights, &seen.collect::<Vec<_>>())
    }

    /// [`visible`](Self::visible) by NLP, as in the paper.
    ///
    /// # Panics
    /// When there are fewer than 2 horizons.
    pub fn visible_nlp(&self, order: usize, blend: Blend, horizons_rad: &[f64]) -> Vec<f64> {
        let seen: Vec<_> = horizons_rad.iter().map(|h| self.nlp(order, *h)).collect();
        assemble_nlp(order, &self.weights(order, blend, horizons_rad.len()), &seen)
    }

    fn first_rad(&self) -> f64 {
        self.azimuth_rad - self.width_rad / 2.0
    }

    fn weights(&self, order: usize, blend: Blend, count: usize) -> Vec<Vec<f64>> {
        swath(order, blend, self.first_rad(), self.width_rad, count)
    }
}
