//! Frames on the device.

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless, Timing};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Quality, Scene};
use ridgelight_trade::auto::Drawn;

/// Draws in turn that a ratio is the median of.
const DRAWS: usize = 7;

fn frame(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Frame> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.frame(plan, &contents)
}

/// A draw that takes so long is not repeated: compiling is little of it.
const LONG_NS: f64 = 1e10;

/// Draws, `times` over after a draw that compiles: planes, and passes of the middle draw.
pub fn draw(gpu: &mut Headless, scene: &Scene, quality: &Quality, times: usize) -> Result<Drawn> {
    let mut frame = frame(gpu, scene, quality)?;
    let mut runs = vec![gpu.draw(&mut frame)?];
    for _ in 0..times {
        if total(&runs[0]) < LONG_NS {
            runs.push(gpu.draw(&mut frame)?);
        }
    }
    let pixels = gpu.pixels(&frame, 0)?;
    gpu.end(frame);
    if runs.len() > 1 {
        runs.remove(0);
    }
    runs.sort_by(|a, b| total(a).total_cmp(&total(b)));
    let middle = runs.swap_remove(runs.len() / 2);
    let stride = pixels.channels;
    let is_void = |i: usize| scene.field.voids().is_some_and(|v| v[i]);
    let planes = (0..stride.min(3))
        .map(|c| {
            let values = pixels.values.iter().skip(c).step_by(stride).enumerate();
            values.map(|(i, v)| if is_void(i) { f32::NAN } else { *v }).collect()
        })
        .collect();
    Ok(Drawn { planes, passes: middle.into_iter().map(|t| (t.label, t.ns)).collect() })
}

fn total(times: &[Timing]) -> f64 {
    times.iter().map(|t| t.ns).sum()
}

/// Median time of `quality` over that of `other`, drawn in turn.
pub fn ratio(gpu: &mut Headless, scene: &Scene, quality: &Quality, other: &Quality) -> Result<f64> {
    let mut frames = [frame(gpu, scene, quality)?, frame(gpu, scene, other)?];
    let mut ratios = Vec::new();
    for i in 0..=DRAWS {
        let mut ns = [0.0; 2];
        for (ns, frame) in ns.iter_mut().zip(&mut frames) {
            *ns = total(&gpu.draw(frame)?);
        }
        if i > 0 {
            ratios.push(ns[0] / ns[1]);
        }
    }
    frames.into_iter().for_each(|f| gpu.end(f));
    ratios.sort_by(f64::total_cmp);
    Ok(ratios[DRAWS / 2])
}
