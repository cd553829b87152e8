//! What errors and costs are expected of bounces.

use super::statistics::Statistics;
use ridgelight::scene::{BounceEngine, Lines, Method, Quality, Scene};

/// Parts of the error: pyramids in place of what is seen, azimuths, nodes between samples, bounces that are left out.
pub(super) const PARTS: usize = 4;

/// Shares of bounced light that each part is off at 32 azimuths, 2× sub-sampled, from columns "bounced" that
/// `cargo run --release --example bounce` and the same with `-- table` print (`benches/results/bounce.txt`,
/// `bounce_table.txt`). Pyramids: √(pyramid² - chance²) of Mt Washington under the sky, one bounce; nodes: sweep, one
/// bounce, 2×; azimuths: √(sweep's 32² - sweep's three bounces, 2×²), as what is off there are both. Of what is left
/// out, all. Second: the standard deviation of their ln, no fit: a factor of two either way (ln 2), of what is left
/// out, which depends on where light stays, e.
const SHARES: [[f64; 2]; PARTS] = [[0.2, 0.7], [0.018, 0.7], [0.03, 0.7], [1.0, 1.0]];

/// The engines that an engine can come to, in the order of [`work`].
pub(super) const ENGINES: [BounceEngine; 3] =
    [BounceEngine::Sweep, BounceEngine::Brute, BounceEngine::Pyramid];

/// What of a scene says how much its bounces matter.
#[derive(Clone, Copy, Debug)]
pub(super) struct BouncedLight {
    albedo: f64,
    /// Light of the first bounce over direct light: what the ground hides of the lights, thrown by an albedo.
    share: f64,
}

impl BouncedLight {
    pub fn of(scene: &Scene, statistics: &Statistics) -> Self {
        let albedo = scene.surface.most_reflected();
        Self { albedo, share: (albedo * statistics.hidden).clamp(1e-6, 1.0) }
    }

    /// ln of each part, and its standard deviation.
    pub fn guess(&self) -> [(f64, f64); PARTS] {
        SHARES.map(|[share, spread]| ((share * self.share).ln(), spread))
    }

    /// What each part is of that with some settings.
    pub fn factors(&self, quality: &Quality) -> [f64; PARTS] {
        let drawn = quality.bounces.worth_drawing(self.albedo);
        // Each bounce is the last one's share of it; light that stays in hollows loses the albedo alone, no less.
        let left_out: f64 = (drawn..quality.bounces.count).map(|k| self.share.powi(k as i32)).sum();
        if drawn == 0 {
            return [0.0, 0.0, 0.0, left_out];
        }
        let has_levels = engine(quality) == BounceEngine::Pyramid;
        let nodes = match quality.subsample {
            1 => 0.0,
            stride => f64::from(stride) / 2.0,
        };
        let azimuths = 32.0 / f64::from(quality.bounces.azimuths);
        [f64::from(u8::from(has_levels)), azimuths, nodes, left_out]
    }
}

/// What the planner takes: see [`BounceEngine::Auto`].
pub(super) fn engine(quality: &Quality) -> BounceEngine {
    let has_lines =
        quality.lines != Lines::Exact && !matches!(quality.method, Method::Brute | Method::Pyramid);
    match quality.bounces.engine {
        BounceEngine::Auto if has_lines => BounceEngine::Sweep,
        BounceEngine::Auto => BounceEngine::Brute,
        chosen => chosen,
    }
}

/// ns an azimuth and sample of a walk, of a march and each sample of the side, of a gather, on lavapipe: "ms" of one
/// bounce, 1×, of `cargo run --release --example bounce -- table` (`benches/results/bounce_table.txt`, sub-sampled
/// bounces) over 32 · 128² · 10⁻⁶, of brute force over 128 more. The frames that are drawn correct each.
const WALK: f64 = 110.0;
const MARCH: f64 = 4.8;
const GATHER: f64 = 330.0;
/// Of a walk's time at every sample what a later, sub-sampled bounce takes that reads what the first has met: sweep, 2×,
/// there, (three bounces - one) / 2 over one bounce's 1×.
const CAST: f64 = 0.033;

/// Work of walks, marches and gathers, one of which there is where bounces are drawn.
pub(super) fn work(scene: &Scene, quality: &Quality) -> [f64; ENGINES.len()] {
    let drawn = f64::from(quality.bounces.worth_drawing(scene.surface.most_reflected()));
    let azimuths = f64::from(quality.bounces.azimuths);
    let side = scene.field.rows().max(scene.field.cols()) as f64;
    // Nodes are the square of it fewer, but each still costs the sweep or levels of all: "over 1×" of one bounce, sweep;
    // every eighth sample by halving once more.
    let nodes = |stride: u32| match stride {
        1 => 1.0,
        2 => 0.42,
        4 => 0.2,
        _ => 0.1,
    };
    let stride = quality.subsample;
    let later = nodes(if stride == 1 { 1 } else { 2 * stride });
    let found = nodes(stride) + later * (drawn - 1.0);
    let mut all = [0.0; ENGINES.len()];
    if drawn == 0.0 {
        return all;
    }
    match engine(quality) {
        BounceEngine::Brute => all[1] = azimuths * found * MARCH * side,
        BounceEngine::Pyramid => all[2] = azimuths * found * GATHER,
        _ if stride == 1 => all[0] = azimuths * found * WALK,
        _ => all[0] = azimuths * WALK * (nodes(stride) + CAST * (drawn - 1.0)),
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::Bounces;

    /// Shares of 0.1 with three bounces asked: all is left out 1 + 0.1 + 0.01 of the first, of one drawn 0.1 + 0.01.
    /// Half the azimuths err twice as much, every fourth sample twice every second, every sample not at all.
    #[test]
    fn finer_bounces_err_less() {
        let light = BouncedLight { albedo: 0.5, share: 0.1 };
        let of = |cutoff: f64, azimuths: u32, subsample: u32| {
            let bounces = Bounces { count: 3, azimuths, cutoff, ..Bounces::default() };
            light.factors(&Quality { bounces, subsample, ..Quality::default() })
        };
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        // ½ + ¼ + ⅛ of the energy are all.
        assert!(of(0.9, 32, 1)[..3] == [0.0; 3] && near(of(0.9, 32, 1)[3], 1.11));
        assert!(near(of(0.5, 32, 1)[3], 0.11) && near(of(0.2, 32, 1)[3], 0.01));
        assert_eq!(of(0.0, 32, 1), [0.0, 1.0, 0.0, 0.0]);
        assert_eq!(of(0.0, 16, 2), [0.0, 2.0, 1.0, 0.0]);
        assert_eq!(of(0.0, 64, 4), [0.0, 0.5, 2.0, 0.0]);
        let pyramid = Bounces { count: 3, engine: BounceEngine::Pyramid, ..Bounces::default() };
        let quality = Quality { bounces: pyramid, ..Quality::default() };
        assert_eq!(light.factors(&quality)[0], 1.0);
        assert_eq!(
            engine(&Quality { lines: Lines::Exact, ..Quality::default() }),
            BounceEngine::Brute
        );
    }
}
