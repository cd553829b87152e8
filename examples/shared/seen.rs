//! What samples see, off the device.

use ridgelight::Result;
use ridgelight::gpu::Headless;
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
        // The first draw warms up.
        gpu.draw(frame)?;
        let ms = gpu.draw(frame)?.iter().map(|t| t.ns).sum::<f64>() / 1e6;
        let mut words = Vec::new();
        for output in 0..outputs {
            words.extend(gpu.pixels(frame, output)?.values.iter().map(|v| v.to_bits()));
        }
        Ok((words, ms))
    })?;
    Ok((VisiblePoints::new(field, border, directions.clone(), words)?, ms))
}
