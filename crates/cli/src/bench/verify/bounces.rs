//! Compares the first and the second bounce with exact quadrature over visible intervals in f64. The passes of later ones are those of
//! the second.

use ridgelight::Result;
use ridgelight::gpu::Pixels;
use ridgelight::scene::{Albedo, BounceEngine, Bounces, Quality, Scene, Surface};
use ridgelight_cpu::bounce_march::bounce_march;
use ridgelight_cpu::oracle::Oracle;

use super::{Device, PLACES, colours, rms, sentence, within};

/// Azimuths of the reference.
const TRUE_AZIMUTHS: u32 = 256;
/// What the 16-bit weights of a visibility cache may change of a node's share of ground: half a part of π / 2 for each of four rings, over
/// all azimuths, of π.
const CACHE_SHARE: f64 = 1e-4;

/// Checks the first two bounces of a scene that the oracle computes whole. Each reference reads the device's light of the bounce before.
///
/// # Errors
/// An error above its bound.
pub(super) fn check(scene: &Scene, device: &mut Device) -> Result<String> {
    // An albedo of 0 has no bounce. Incoming light does not depend on it.
    let surface = Surface { albedo: Albedo::Constant([1.0; 3]), ..scene.surface.clone() };
    let scene = &Scene { surface, ..scene.clone() };
    let quality = device.quality;
    let of = |count: u32| {
        let bounces = Bounces { count, cutoff: 0.0, ..quality.bounces };
        Quality { bounces, ..*quality }
    };
    let [direct, bounced] = [of(0), of(quality.bounces.count.min(2))];
    let direct = device.with(&direct).picture(scene)?;
    let layers = device.with(&bounced).layers(scene, true)?.1;
    let bounces = layers.iter().filter(|layer| layer.name.starts_with("indirect."));
    let every = |picture: &Pixels| -> Vec<[f64; 3]> {
        let all: Vec<usize> = (0..picture.values.len() / picture.channels).collect();
        colours(picture, &all).into_iter().map(|v| v.to_array()).collect()
    };
    let oracle = Oracle::new(&scene.field, scene.surface.border);
    let (mut exit, mut sentences) = (every(&direct), Vec::new());
    for (name, layer) in [FIRST, SECOND].into_iter().zip(bounces) {
        let found = every(layer);
        let errors = judge((&oracle, scene.field.cols()), name, [&exit, &found], quality)?;
        sentences.push(sentence(name, "f64", errors));
        exit = found;
    }
    Ok(sentences.join("; "))
}

const FIRST: &str = "first bounce";
const SECOND: &str = "second bounce";

/// The error of the light of a bounce, given the exit radiance before it, and its bound.
fn judge(
    (oracle, cols): (&Oracle, usize),
    name: &str,
    [exit, found]: [&[[f64; 3]]; 2],
    quality: &Quality,
) -> Result<(f64, f64)> {
    let step = (found.len() / PLACES).max(1) | 1;
    let (mut off, mut all) = (Vec::new(), Vec::new());
    for at in (0..found.len()).step_by(step) {
        let want = bounce_march(oracle, exit, TRUE_AZIMUTHS, at / cols, at % cols);
        off.extend((0..3).map(|c| found[at][c] - want[c]));
        all.extend(want);
    }
    let size = rms(all.into_iter()).max(f64::MIN_POSITIVE);
    let is_later = name == SECOND;
    let rounded = CACHE_SHARE * rms(exit.iter().flatten().copied()) / size;
    let bound = bound(quality, is_later) + if is_later { rounded } else { 0.0 };
    within(&format!("the {name}"), "f64", rms(off.into_iter()) / size, bound, quality)
}

/// A quadrature over azimuths has an error proportional to the squared step where light is smooth
/// and to the step at the edges of bright surfaces: a quarter of the step in radians. Sweeps: twice
/// the error of lines a cell apart on the bundled mountain and on a fractal, 0.015, proportional to
/// their spacing. Pyramids: 1.5 times the error of their coarsest settings on that mountain under a
/// low sun, 0.5. Sub-sampling: twice the error of every second texel on
/// that mountain, 0.05; every fourth has less than three times as much. Later bounces have strides of
/// up to 8, for which the bound is extrapolated. No bounce at all has an error of 1, above every bound.
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
    let of_engine = match quality.bounces.engine {
        BounceEngine::BruteForce => 0.0,
        // The planner chooses one of these two.
        BounceEngine::Auto | BounceEngine::Sweep => 0.03 * apart.max(1.0),
        BounceEngine::Pyramid => 0.75,
    };
    (rule + between + of_engine).min(0.95)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::verify::tests::scene;
    use ridgelight::scene::Lights;

    /// The light of every visible interval in another number of azimuths passes. No light and twice the light are refused with
    /// every engine, also sub-sampled. Where nothing is interpolated or approximate, so is the light of the texel opposite.
    #[test]
    fn wrong_bounces_are_refused() {
        const SIDE: usize = 12;
        let scene = scene(SIDE, Lights::default());
        let oracle = Oracle::new(&scene.field, scene.surface.border);
        let exit: Vec<[f64; 3]> =
            (0..SIDE * SIDE).map(|i| [1.0, (i % SIDE) as f64 / SIDE as f64, 0.5]).collect();
        let at = |i: usize| bounce_march(&oracle, &exit, 64, i / SIDE, i % SIDE);
        let right: Vec<[f64; 3]> = (0..SIDE * SIDE).map(at).collect();
        let mut opposite = right.clone();
        opposite.reverse();
        let scaled = |by: f64| right.iter().map(|light| light.map(|v| by * v)).collect();
        let wrong: [Vec<[f64; 3]>; 3] = [scaled(0.0), scaled(2.0), opposite];
        use BounceEngine::{BruteForce, Pyramid, Sweep};
        for (engine, subsample) in [(BruteForce, 1), (Sweep, 1), (Sweep, 4), (Pyramid, 4)] {
            let bounces = Bounces { count: 2, engine, azimuths: 32, ..Bounces::default() };
            let quality = Quality { bounces, subsample, ..Quality::default() };
            for name in [FIRST, SECOND] {
                let judged = |found: &[[f64; 3]]| {
                    judge((&oracle, SIDE), name, [&exit, found], &quality).is_ok()
                };
                assert!(judged(&right), "{name} {quality:?}");
                let [none, twice, opposite] = wrong.each_ref().map(|wrong| !judged(wrong));
                assert!(none && twice, "{name} {quality:?}");
                let is_close = subsample == 1;
                assert!(opposite || !is_close, "{name} {quality:?}");
            }
        }
    }
}
