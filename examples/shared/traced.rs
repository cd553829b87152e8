//! What several examples hold pictures against.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan;
use ridgelight::scene::Scene;

/// Radiance by light paths with all bounces up to a number, and its standard error: 64 paths a batch.
pub fn traced(
    gpu: &mut Headless,
    scene: &Scene,
    bounces: u32,
    batches: u32,
) -> Result<[Vec<f32>; 2]> {
    let plan = plan::reference(scene, bounces, 1, &gpu.report().limits)?;
    let paths: Vec<usize> =
        (0..plan.passes.len()).filter(|p| plan.passes[*p].name() == "path_trace").collect();
    let contents = plan::reference_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        for _ in 1..batches {
            gpu.draw_passes(frame, &paths)?;
        }
        Ok([gpu.pixels(frame, 0)?.values, gpu.pixels(frame, 1)?.values])
    })
}
