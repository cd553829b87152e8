//! Corrects predicted errors by the residuals of measured settings that are similar.

use super::candidates::is_exact;
use super::model::{fuse_row, spacing};
use ridgelight::scene::{BounceEngine, Quality};

/// Number of settings that errors depend on.
const SETTINGS: usize = 10;
/// Steps of settings over which the correlation falls to 1/e.
const REACH: f64 = 2.0;
/// The part of a residual that similar settings do not share, over the kernel's variance.
const OWN: f64 = 0.05;
/// Variance that the kernel gives a residual, in ln: assumed, a factor of 1.35 either way.
const VARIANCE: f64 = 0.09;

/// A residual is ln of a measured error less ln of the predicted one. Other settings get the posterior mean of a Gaussian process
/// with the kernel exp(-steps / REACH) (Rasmussen & Williams 2006, eq. 2.25). Without it, the search tries many settings that differ
/// only in ways that do not change this scene's error.
#[derive(Clone, Debug, Default)]
pub(super) struct Residuals {
    points: Vec<[f64; SETTINGS]>,
    weights: Vec<f64>,
}

/// A measured residual.
pub(super) struct Residual {
    pub quality: Quality,
    /// ln of the measured error less ln of the predicted one.
    pub ln: f64,
    /// Variance of the ln of the measured error.
    pub noise: f64,
}

impl Residuals {
    pub fn of(all: &[Residual]) -> Self {
        let points: Vec<_> = all.iter().map(|r| point_of(&r.quality)).collect();
        // Cholesky's decomposition of the covariances, in units of the kernel's variance; then both triangles are solved.
        let count = all.len();
        let mut lower = vec![vec![0.0; count]; count];
        for i in 0..count {
            for j in 0..=i {
                let own = if i == j { OWN + all[i].noise / VARIANCE } else { 0.0 };
                let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                let rest = kernel(&points[i], &points[j]) + own - known;
                lower[i][j] = if i == j { rest.sqrt() } else { rest / lower[j][j] };
            }
        }
        let mut weights: Vec<f64> = all.iter().map(|r| r.ln).collect();
        for i in 0..count {
            let known: f64 = (0..i).map(|k| lower[i][k] * weights[k]).sum();
            weights[i] = (weights[i] - known) / lower[i][i];
        }
        for i in (0..count).rev() {
            let known: f64 = (i + 1..count).map(|k| lower[k][i] * weights[k]).sum();
            weights[i] = (weights[i] - known) / lower[i][i];
        }
        Self { points, weights }
    }

    /// The expected residual; 0 far from all measured settings.
    pub fn at(&self, quality: &Quality) -> f64 {
        let here = point_of(quality);
        self.points.iter().zip(&self.weights).map(|(point, w)| w * kernel(point, &here)).sum()
    }
}

fn kernel(a: &[f64; SETTINGS], b: &[f64; SETTINGS]) -> f64 {
    let steps: f64 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
    (-steps / REACH).exp()
}

/// Settings in steps: a step of any of them changes the spatial pattern of the error by about as much.
fn point_of(quality: &Quality) -> [f64; SETTINGS] {
    let steps = |value: u32| f64::from(value).log2();
    let bounces = &quality.bounces;
    // Exact horizons, and sweeps that read lines on both sides, err at other texels than other sweeps.
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
        2.0 * steps(quality.sh_order),
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
    use crate::auto::tests::under_sky;
    use crate::auto::{Model, Statistics};
    use crate::trade::start;
    use ridgelight::scene::{Border, Fuse, Lines};

    fn of(azimuths: u32) -> Quality {
        Quality { azimuths, ..start() }
    }

    fn residual(azimuths: u32, ln: f64, noise: f64) -> Residual {
        Residual { quality: of(azimuths), ln, noise }
    }

    /// One residual r predicts r / (1 + OWN + noise) at its own settings and 1/√e of that a step away: almost nothing where the
    /// error is below the noise of its probes. With several, also of the same settings, the weights satisfy the linear equations.
    #[test]
    fn residuals_are_shared_with_similar_settings() {
        for noise in [0.0, VARIANCE, 9.0] {
            let one = Residuals::of(&[residual(64, -0.4, noise)]);
            let there = -0.4 / (1.0 + OWN + noise / VARIANCE);
            assert!((one.at(&of(64)) - there).abs() < 1e-12);
            assert!((one.at(&of(128)) - there * (-0.5_f64).exp()).abs() < 1e-12);
            assert!(one.at(&of(1 << 30)).abs() < 1e-4);
        }
        let known: Vec<_> = [(8, 0.3), (16, -0.2), (16, -0.1), (12, 0.1), (1024, 0.5)]
            .map(|(azimuths, ln)| residual(azimuths, ln, 0.5 * VARIANCE))
            .into();
        let several = Residuals::of(&known);
        for (residual, weight) in known.iter().zip(&several.weights) {
            let own = (OWN + 0.5) * weight;
            assert!((several.at(&residual.quality) + own - residual.ln).abs() < 1e-12);
        }
        assert_eq!(Residuals::default().at(&of(8)), 0.0);
    }

    /// Finer lines do not lower the error of `aimed-nearest`, as at the steps where a periodic field repeats. Shared residuals move
    /// the prediction for the next finer lines at least a third closer (in ln) to the measured error, and those for distant
    /// settings by less than about 5 %.
    #[test]
    fn shared_residuals_predict_settings_without_effect() {
        let mut scene = under_sky(12, 12);
        scene.surface.border = Border::Periodic;
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
