//! Expected errors and costs of bounces.

use super::statistics::Statistics;
use crate::trade::has_no_lines;
use ridgelight::scene::{BounceEngine, Quality, Scene, Specular};

/// Parts of the error: pyramids instead of exact visibility, azimuths, interpolation between nodes,
/// omitted bounces, SH between specular bounces.
pub(super) const PARTS: usize = 5;

/// Relative error of bounced light by each part at 32 azimuths, 2× sub-sampled. Source: columns
/// "bounced" of `cargo measure bounce` and `cargo measure bounce-table`
/// (`benches/results/bounce.txt`, `bounce_table.txt`). Pyramids: √(pyramid² - noise²) of Mt
/// Washington under the sky, one bounce. Nodes: √(sweep, one bounce, 2×² - 1×²). Azimuths: √(sweep's 32² -
/// sweep's three bounces, 2×²), which removes the error common to both. Omitted bounces: all of
/// their light. SH: the specular share of the light times [`blur`].
///
/// Second number: the standard deviation of the logarithm. It is assumed, not fitted: a factor of
/// two either way (ln 2), or e for omitted bounces, which depend on where light is trapped.
const SHARES: [[f64; 2]; PARTS] = [[0.2, 0.7], [0.017, 0.7], [0.019, 0.7], [1.0, 1.0], [1.0, 1.0]];

/// What a lobe keeps of the first band that an SH order drops: about exp(-order² / (2 (n + 2))), as a Gaussian of the same
/// width. In `benches/results/gloss.txt` brute force has an RMSE of 4 to 97 % of the bounced light, where this is 0.3 to 91 %. It is too small for wide lobes.
fn blur(order: u32, exponent: f64) -> f64 {
    (-f64::from(order * order) / (2.0 * (exponent + 2.0))).exp()
}

/// The engines that can run, in the order of [`work`].
pub(super) const ENGINES: [BounceEngine; 3] =
    [BounceEngine::Sweep, BounceEngine::BruteForce, BounceEngine::Pyramid];

/// A scene's bounced light, estimated.
#[derive(Clone, Copy, Debug)]
pub(super) struct BouncedLight {
    albedo: f64,
    /// First bounce over direct light: the occluded share of the lights, times the albedo.
    share: f64,
    /// Largest Phong exponent, and the specular share of the reflected light; 0 without specular.
    exponent: f64,
    specular: f64,
}

impl BouncedLight {
    pub fn of(scene: &Scene, statistics: &Statistics) -> Self {
        let albedo = scene.surface.max_reflectance();
        let phong = scene.surface.specular.as_ref().map(Specular::largest);
        let [exponent, scale] =
            phong.map_or([0.0; 2], |phong| [phong.exponent, phong.scale].map(f64::from));
        Self {
            albedo,
            share: (albedo * statistics.hidden).clamp(1e-6, 1.0),
            exponent,
            specular: if scale > 0.0 { scale / albedo } else { 0.0 },
        }
    }

    /// ln of each part, and its standard deviation.
    pub fn guess(&self) -> [(f64, f64); PARTS] {
        SHARES.map(|[share, spread]| ((share * self.share).ln(), spread))
    }

    /// Factor of each part for these settings.
    pub fn factors(&self, quality: &Quality) -> [f64; PARTS] {
        let drawn = quality.bounces.needed_bounces(self.albedo);
        // Each bounce is a fixed share of the last. Light trapped in hollows decreases by no more
        // than the albedo.
        let left_out: f64 = (drawn..quality.bounces.count).map(|k| self.share.powi(k as i32)).sum();
        if drawn == 0 {
            return [0.0, 0.0, 0.0, left_out, 0.0];
        }
        let engine = engine(quality);
        let has_levels = engine == BounceEngine::Pyramid;
        let nodes = match quality.subsample {
            1 if engine == BounceEngine::Sweep && drawn > 1 => LATER_NODES,
            1 => 0.0,
            stride => f64::from(stride) / 2.0,
        };
        let azimuths = 32.0 / f64::from(quality.bounces.azimuths);
        let blurred = self.specular * blur(quality.sh_order, self.exponent);
        [f64::from(u8::from(has_levels)), azimuths, nodes, left_out, blurred]
    }
}

/// The planner's choice: see [`BounceEngine::Auto`].
pub(super) fn engine(quality: &Quality) -> BounceEngine {
    match quality.bounces.engine {
        BounceEngine::Auto if has_no_lines(quality) => BounceEngine::BruteForce,
        BounceEngine::Auto => BounceEngine::Sweep,
        chosen => chosen,
    }
}

/// Error where only later bounces are interpolated, with a stride of 4, over that with strides of 2 and 4. Assumed: the later
/// bounces' part of the indirect light.
const LATER_NODES: f64 = 0.2;

/// ns per azimuth and texel: of a walk, of a march per texel of the side, of a gather; on lavapipe.
/// Source: "ms" of one bounce, 1×, of `cargo measure bounce-table`
/// (`benches/results/bounce_table.txt`, sub-sampled bounces) over 32 · 128² · 10⁻⁶, for brute force
/// over 128 more. Measured frames correct each.
const WALK: f64 = 70.0;
const MARCH: f64 = 4.8;
const GATHER: f64 = 330.0;
/// Time of a later bounce, which reads the first bounce's visibility cache, over that
/// of a walk at every texel: sweep, 1×, same file, (three bounces - one) / 2 over one bounce.
const CACHED: f64 = 0.077;

/// Work of walks, marches and gathers; only one of them is above 0.
pub(super) fn work(scene: &Scene, quality: &Quality) -> [f64; ENGINES.len()] {
    let drawn = f64::from(quality.bounces.needed_bounces(scene.surface.max_reflectance()));
    let azimuths = f64::from(quality.bounces.azimuths);
    let side = scene.field.rows().max(scene.field.cols()) as f64;
    // Nodes are fewer by the square of the stride, but each still needs the sweep or levels of all.
    // "over 1×" of one bounce, pyramid. Every eighth: halved once more.
    let nodes = |stride: u32| match stride {
        1 => 1.0,
        2 => 0.38,
        4 => 0.19,
        _ => 0.1,
    };
    let stride = quality.subsample;
    // Sweep and line blocks are those of every texel: "over 1×", sweep, at 2 of one bounce, at 4 of three.
    let walked = match stride {
        1 => 1.0,
        2 => 0.7,
        _ => 0.6,
    };
    let later = nodes(if stride == 1 { 1 } else { 2 * stride });
    let found = nodes(stride) + later * (drawn - 1.0);
    let mut all = [0.0; ENGINES.len()];
    if drawn == 0.0 {
        return all;
    }
    match engine(quality) {
        BounceEngine::BruteForce => all[1] = azimuths * found * MARCH * side,
        BounceEngine::Pyramid => all[2] = azimuths * found * GATHER,
        _ => all[0] = azimuths * WALK * (walked + CACHED * (drawn - 1.0)),
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{Bounces, Lines};

    /// A share of 0.1 and three requested bounces: without any, 1 + 0.1 + 0.01 of the first is
    /// omitted; with one, 0.1 + 0.01. Half the azimuths double the error; every fourth texel has
    /// twice the error of every second, and later bounces alone a fifth.
    #[test]
    fn finer_bounces_err_less() {
        let light = BouncedLight { albedo: 0.5, share: 0.1, exponent: 0.0, specular: 0.0 };
        let of = |cutoff: f64, azimuths: u32, subsample: u32| {
            let bounces = Bounces { count: 3, azimuths, cutoff, ..Bounces::default() };
            light.factors(&Quality { bounces, subsample, ..Quality::default() })
        };
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        // One bounce is found at every texel.
        assert_eq!(of(0.5, 32, 1)[2], 0.0);
        // ½ + ¼ + ⅛ of the energy are all.
        assert!(of(0.9, 32, 1)[..3] == [0.0; 3] && near(of(0.9, 32, 1)[3], 1.11));
        assert!(near(of(0.5, 32, 1)[3], 0.11) && near(of(0.2, 32, 1)[3], 0.01));
        assert_eq!(of(0.0, 32, 1), [0.0, 1.0, 0.2, 0.0, 0.0]);
        assert_eq!(of(0.0, 16, 2), [0.0, 2.0, 1.0, 0.0, 0.0]);
        assert_eq!(of(0.0, 64, 4), [0.0, 0.5, 2.0, 0.0, 0.0]);
        let pyramid = Bounces { count: 3, engine: BounceEngine::Pyramid, ..Bounces::default() };
        let quality = Quality { bounces: pyramid, ..Quality::default() };
        assert_eq!(light.factors(&quality)[0], 1.0);
        // Half of the light is specular; order 6 at exponent 16 loses as much as order 4 at exponent 6.
        let of_order = |exponent: f64, sh_order: u32| {
            let light = BouncedLight { exponent, specular: 0.5, ..light };
            light.factors(&Quality { sh_order, ..quality })[4]
        };
        assert!(near(of_order(6.0, 4), 0.5 * (-1.0_f64).exp()));
        assert!(near(of_order(16.0, 6), of_order(6.0, 4)));
        assert_eq!(light.factors(&quality)[4], 0.0);
        assert_eq!(
            engine(&Quality { lines: Lines::Exact, ..Quality::default() }),
            BounceEngine::BruteForce
        );
    }
}
