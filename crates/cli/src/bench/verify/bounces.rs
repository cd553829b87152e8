//! Compares one bounce with the exact one over visible intervals in f64.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{Albedo, BounceEngine, Bounces, Quality, Scene};
use ridgelight_cpu::bounce_march::bounce_march;
use ridgelight_cpu::oracle::Oracle;

use super::{PLACES, percent, rms, within};

/// Azimuths of the reference.
const TRUE_AZIMUTHS: u32 = 256;

/// Checks the first bounce of a scene that the oracle computes whole, from the device's direct
/// light.
///
/// # Errors
/// An error above its bound.
pub fn check(
    scene: &Scene,
    gpu: &mut Headless,
    quality: &Quality,
    limits: &Limits,
) -> Result<String> {
    // An albedo of 0 has no bounce. Incoming light does not depend on it.
    let scene = &white(scene);
    let [direct, lit] = [0, 1].map(|count| {
        let bounces = Bounces { count, cutoff: 0.0, ..quality.bounces };
        let plan =
            plan::picture(scene, &Quality { bounces, ..*quality }, limits, Picture::default())?;
        let contents = plan::picture_inputs(scene);
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        gpu.with_frame(plan, &contents, |gpu, frame| {
            gpu.draw(frame)?;
            gpu.pixels(frame, 0)
        })
    });
    let (direct, lit) = (direct?, lit?);
    let colour = |pixels: &ridgelight::gpu::Pixels, at: usize| {
        [0, 1, 2]
            .map(|c| f64::from(pixels.values[at * pixels.channels + c.min(pixels.channels - 1)]))
    };
    let count = direct.values.len() / direct.channels;
    let exit: Vec<[f64; 3]> = (0..count).map(|at| colour(&direct, at)).collect();
    let oracle = Oracle::new(&scene.field, scene.surface.border);
    let (cols, step) = (scene.field.cols(), (count / PLACES).max(1) | 1);
    let (mut off, mut all) = (Vec::new(), Vec::new());
    for at in (0..count).step_by(step) {
        let want = bounce_march(&oracle, &exit, TRUE_AZIMUTHS, at / cols, at % cols);
        let got = colour(&lit, at);
        off.extend((0..3).map(|c| got[c] - exit[at][c] - want[c]));
        all.extend(want);
    }
    let error = rms(off.into_iter()) / rms(all.into_iter()).max(f64::MIN_POSITIVE);
    let (error, bound) = within("the bounce", "f64", error, bound(quality), quality)?;
    Ok(format!("bounce error {} against f64 (RMSE; bound {})", percent(error), percent(bound)))
}

fn white(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.surface.albedo = Albedo::Constant([1.0; 3]);
    scene
}

/// A quadrature over azimuths has an error proportional to the squared step where light is smooth
/// and to the step at the edges of bright surfaces: a quarter of the step in radians. Sweeps: twice
/// the error of lines a cell apart on the bundled mountain and on a fractal, 0.015, proportional to
/// their spacing. Pyramids: 1.5 times the error of their coarsest settings on that mountain under a
/// low sun, 0.5; no bounce at all has 1. Sub-sampling: twice the error of every second texel on
/// that mountain, 0.05; every fourth has less than three times as much.
fn bound(quality: &Quality) -> f64 {
    let rule = std::f64::consts::TAU / f64::from(quality.bounces.azimuths) / 4.0;
    // Cells from line to line.
    let apart = f64::from(quality.lines.shift().unwrap_or(15)).exp2() / 32768.0;
    let between = 0.1 * f64::from(quality.subsample - 1);
    rule + between
        + match quality.bounces.engine {
            BounceEngine::BruteForce => 0.0,
            // The planner chooses one of these two.
            BounceEngine::Auto | BounceEngine::Sweep => 0.03 * apart.max(1.0),
            BounceEngine::Pyramid => 0.75,
        }
}
