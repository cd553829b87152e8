//! What samples see, off the device.

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan;
use ridgelight::scene::{Border, Directions, HeightField, VisiblePoints};

/// What samples see, and the milliseconds of finding it, hierarchy and all.
pub fn points(
    gpu: &mut Headless,
    field: &HeightField,
    border: Border,
    directions: &Directions,
) -> Result<(VisiblePoints, f64)> {
    let plan = plan::visible_points(field, border, directions, &gpu.report().limits)?;
    let outputs = plan.outputs().count();
    let (words, ms) = gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
        let ms = timed(gpu, frame)?;
        let mut words = Vec::new();
        for output in 0..outputs {
            words.extend(gpu.pixels(frame, output)?.values.iter().map(|v| v.to_bits()));
        }
        Ok((words, ms))
    })?;
    Ok((VisiblePoints::new(field, border, directions.clone(), words)?, ms))
}

/// Milliseconds of the device for a frame; of small ones, which a first draw's warming up would tell in, for a second.
pub fn timed(gpu: &mut Headless, frame: &mut Frame) -> Result<f64> {
    let [cols, rows] = frame.plan().size;
    if cols * rows < 1 << 18 {
        gpu.draw(frame)?;
    }
    Ok(gpu.draw(frame)?.iter().map(|t| t.ns).sum::<f64>() / 1e6)
}
