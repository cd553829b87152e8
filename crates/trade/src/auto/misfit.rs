//! What the parts of the error do not explain, shared by similar settings.

use super::candidates::is_exact;
use super::model::{fuse_row, spacing};
use ridgelight::scene::{BounceEngine, Quality};

/// Number of settings that errors depend on.
const SETTINGS: usize = 9;
/// Steps of settings over which the correlation falls to 1/e.
const REACH: f64 = 2.0;
/// Variance of a residual's own part over that of the shared one.
const OWN: f64 = 0.05;
/// Sweeps of Gauss and Seidel over at most 18 equations, whose matrix has 1 + OWN on its diagonal.
const SWEEPS: usize = 200;

/// Residuals of measured settings: ln of the error less the expected ln. Those of other settings are the mean of a Gaussian
/// process with the kernel exp(-steps / REACH) (Rasmussen & Williams 2006, eq. 2.25). Without it a search tries one after the other
/// of settings that differ where the scene has no error.
#[derive(Clone, Debug, Default)]
pub(super) struct Misfit {
    places: Vec<[f64; SETTINGS]>,
    weights: Vec<f64>,
}

impl Misfit {
    pub fn of(residuals: &[(Quality, f64)]) -> Self {
        let places: Vec<_> = residuals.iter().map(|(quality, _)| place(quality)).collect();
        let mut weights = vec![0.0; places.len()];
        for _ in 0..SWEEPS {
            for (i, (_, residual)) in residuals.iter().enumerate() {
                let others = (0..weights.len()).filter(|j| *j != i);
                let known: f64 = others.map(|j| kernel(&places[i], &places[j]) * weights[j]).sum();
                weights[i] = (residual - known) / (1.0 + OWN);
            }
        }
        Self { places, weights }
    }

    /// Expected residual of settings, 0 far from all measured ones; and the share of its variance that is left, by the nearest of
    /// them alone: at most 1.
    pub fn at(&self, quality: &Quality) -> (f64, f64) {
        let here = place(quality);
        let (mut mean, mut nearest) = (0.0, 0.0_f64);
        for (place, weight) in self.places.iter().zip(&self.weights) {
            let shared = kernel(place, &here);
            mean += weight * shared;
            nearest = nearest.max(shared);
        }
        (mean, 1.0 - nearest.powi(2) / (1.0 + OWN))
    }
}

fn kernel(a: &[f64; SETTINGS], b: &[f64; SETTINGS]) -> f64 {
    let steps: f64 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
    (-steps / REACH).exp()
}

/// Settings in steps, so that a step of each changes the kind of error about alike.
fn place(quality: &Quality) -> [f64; SETTINGS] {
    let steps = |value: u32| f64::from(value).log2();
    let bounces = &quality.bounces;
    // Exact horizons, and sweeps that read lines on both sides, err in other places than the rest.
    let exact = if is_exact(quality) { 3.0 } else { 0.0 };
    let fuse = [0.0, 1.0, 4.0][fuse_row(quality.fuse)];
    [
        spacing(quality) as f64 + exact,
        if is_exact(quality) { 0.0 } else { fuse },
        steps(quality.azimuths),
        0.5 * steps(quality.table_elevations),
        steps(quality.sun_azimuths),
        steps(quality.subsample),
        steps(bounces.azimuths),
        match bounces.engine {
            BounceEngine::Pyramid => 0.0,
            BounceEngine::Auto | BounceEngine::Sweep => 4.0,
            BounceEngine::BruteForce => 5.0,
        },
        -0.5 * bounces.cutoff.max(f64::MIN_POSITIVE).log2(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::auto::{Model, Statistics};
    use crate::trade::start;
    use ridgelight::scene::{Border, Fuse, HeightField, Lights, Lines, Scene, Surface};

    fn of(azimuths: u32) -> Quality {
        Quality { azimuths, ..start() }
    }

    /// Of one residual r: r / (1 + OWN) there and 1/√e of that a step beside it. The residuals of several are met but for the share
    /// that is their own: the solution of the equations, checked by putting it in.
    #[test]
    fn residuals_are_shared_with_similar_settings() {
        let one = Misfit::of(&[(of(64), 0.4)]);
        let there = 0.4 / (1.0 + OWN);
        let met = |(mean, left): (f64, f64), wanted: (f64, f64)| {
            assert!(
                (mean - wanted.0).abs() < 1e-12 && (left - wanted.1).abs() < 1e-12,
                "{mean} {left}"
            );
        };
        met(one.at(&of(64)), (there, OWN / (1.0 + OWN)));
        let beside = (-0.5_f64).exp();
        met(one.at(&of(128)), (there * beside, 1.0 - beside.powi(2) / (1.0 + OWN)));
        let (mean, left) = one.at(&of(1 << 30));
        assert!(mean.abs() < 1e-4 && left > 0.9999);
        let known = [(of(8), 0.3), (of(16), -0.2), (of(12), 0.1), (of(1024), 0.5)];
        let several = Misfit::of(&known);
        for ((quality, residual), weight) in known.iter().zip(&several.weights) {
            assert!((several.at(quality).0 + OWN * weight - residual).abs() < 1e-9);
        }
        assert_eq!(Misfit::default().at(&of(8)), (0.0, 1.0));
    }

    /// As at the cliffs where a field repeats: lines do not lower the error of `aimed-nearest`. With residuals shared, the next lines
    /// are expected nearer to that error (in ln), by a third or more; settings far away are as before.
    #[test]
    fn settings_without_effect_are_expected_to_have_none() {
        let heights: Vec<f64> = (0..144).map(|i| f64::from(i * i % 11)).collect();
        let scene = Scene {
            field: HeightField::new(12, 12, &heights, [1.0; 2], None).unwrap(),
            surface: Surface { border: Border::Periodic, ..Surface::default() },
            lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
        };
        let of = |lines: Lines| Quality { azimuths: 8, lines, fuse: Fuse::AimedNearest, ..start() };
        let mut model = Model::of(&scene, &Statistics::of(&scene), 0);
        let measured = 2.0 * model.expected(&of(Lines::FourCells)).error;
        for lines in [Lines::FourCells, Lines::TwoCells, Lines::Cell] {
            model.learn(&of(lines), measured, 0.01);
        }
        let far = Quality { azimuths: 1024, fuse: Fuse::AimedAround, ..start() };
        let expected = |model: &Model, quality: &Quality| model.expected(quality).error;
        let distance =
            |model: &Model| (expected(model, &of(Lines::HalfCell)) / measured).ln().abs();
        let (before, before_far) = (distance(&model), expected(&model, &far));
        model.share_residuals();
        assert!(distance(&model) < before * 2.0 / 3.0, "{} of {before}", distance(&model));
        assert!((expected(&model, &far) / before_far).ln().abs() < 0.05);
    }
}
