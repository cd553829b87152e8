//! Compares the first two bounces with exact ones over visible intervals in f64. Later ones are found as the second.

use ridgelight::Result;
use ridgelight::scene::{Albedo, BounceEngine, Bounces, Quality, Scene, Surface};
use ridgelight_cpu::bounce_march::bounce_march;
use ridgelight_cpu::oracle::Oracle;

use super::{Device, PLACES, colours, rms, sentence, within};

/// Azimuths of the reference.
const TRUE_AZIMUTHS: u32 = 256;

/// Checks the first bounces of a scene that the oracle computes whole, each from the device's light of the one before.
///
/// # Errors
/// An error above its bound.
pub(super) fn check(scene: &Scene, device: &mut Device) -> Result<String> {
    // An albedo of 0 has no bounce. Incoming light does not depend on it.
    let surface = Surface { albedo: Albedo::Constant([1.0; 3]), ..scene.surface.clone() };
    let scene = &Scene { surface, ..scene.clone() };
    let quality = device.quality;
    let mut with = |count: u32| -> Result<Vec<[f64; 3]>> {
        let bounces = Bounces { count, cutoff: 0.0, ..quality.bounces };
        let picture = device.with(&Quality { bounces, ..*quality }).picture(scene)?;
        let all: Vec<usize> = (0..picture.values.len() / picture.channels).collect();
        Ok(colours(&picture, &all).into_iter().map(|v| v.to_array()).collect())
    };
    let oracle = Oracle::new(&scene.field, scene.surface.border);
    let (mut lit, mut sentences) = (with(0)?, Vec::new());
    let mut exit = lit.clone();
    for (k, name) in [(1, "first bounce"), (2, "second bounce")] {
        if k > quality.bounces.count {
            break;
        }
        let more = with(k)?;
        let found: Vec<[f64; 3]> =
            more.iter().zip(&lit).map(|(a, b)| [0, 1, 2].map(|c| a[c] - b[c])).collect();
        let (cols, step) = (scene.field.cols(), (found.len() / PLACES).max(1) | 1);
        let (mut off, mut all) = (Vec::new(), Vec::new());
        for at in (0..found.len()).step_by(step) {
            let want = bounce_march(&oracle, &exit, TRUE_AZIMUTHS, at / cols, at % cols);
            off.extend((0..3).map(|c| found[at][c] - want[c]));
            all.extend(want);
        }
        let error = rms(off.into_iter()) / rms(all.into_iter()).max(f64::MIN_POSITIVE);
        let of = format!("the {name}");
        let errors = within(&of, "f64", error, bound(quality, k > 1), quality)?;
        sentences.push(sentence(name, "f64", errors));
        (lit, exit) = (more, found);
    }
    Ok(sentences.join("; "))
}

/// A quadrature over azimuths has an error proportional to the squared step where light is smooth
/// and to the step at the edges of bright surfaces: a quarter of the step in radians. Sweeps: twice
/// the error of lines a cell apart on the bundled mountain and on a fractal, 0.015, proportional to
/// their spacing. Pyramids: 1.5 times the error of their coarsest settings on that mountain under a
/// low sun, 0.5; no bounce at all has 1. Sub-sampling: twice the error of every second texel on
/// that mountain, 0.05; every fourth has less than three times as much. Later bounces are sub-sampled more.
fn bound(quality: &Quality, is_later: bool) -> f64 {
    let rule = std::f64::consts::TAU / f64::from(quality.bounces.azimuths) / 4.0;
    // Cells from line to line.
    let apart = f64::from(quality.lines.shift().unwrap_or(15)).exp2() / 32768.0;
    let stride = match (quality.bounces.engine, quality.subsample) {
        (_, stride) if !is_later => stride,
        (BounceEngine::BruteForce | BounceEngine::Pyramid, 1) => 1,
        (_, stride) => (2 * stride).max(4),
    };
    let between = 0.1 * f64::from(stride - 1);
    rule + between
        + match quality.bounces.engine {
            BounceEngine::BruteForce => 0.0,
            // The planner chooses one of these two.
            BounceEngine::Auto | BounceEngine::Sweep => 0.03 * apart.max(1.0),
            BounceEngine::Pyramid => 0.75,
        }
}
