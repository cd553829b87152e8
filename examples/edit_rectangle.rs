//! Heights edited in a rectangle, and only the light recomputed that the edit can change. An engine does the same with
//! its own command buffers and images: `Renderer::record_edit` in place of `Renderer::record`.

use ridgelight::gpu::{Headless, HeadlessOptions, Pixels};
use ridgelight::plan::{self, Picture, Rectangle};
use ridgelight::scene::{Lights, Quality, Scene, Surface, fractal};

const SIDE: u32 = 128;

/// The light before the edit, after it, and of a whole frame after it: the last two have the same bits.
pub fn lights() -> ridgelight::Result<[Pixels; 3]> {
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let field = fractal(SIDE as usize, 1)?;
    let scene = Scene { field, surface: Surface::default(), lights };

    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    // Edits continue from the horizons of the last recording, so the plan keeps them.
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let plan = plan::picture(&scene, &Quality::default(), &gpu.report().limits, wanted)?;
    gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
        let (inputs, outputs) = (frame.inputs(), frame.outputs());
        gpu.run(|commands| frame.renderer().record(commands, 0, &inputs, &outputs))?;
        let before = gpu.pixels(frame, 0)?;

        // A hill: heights may change only inside the rectangle.
        let mut heights = scene.field.heights_m().to_vec();
        let hill = Rectangle { col: 40, row: 60, cols: 16, rows: 12 };
        for row in hill.row..hill.row + hill.rows {
            for col in hill.col..hill.col + hill.cols {
                heights[(row * SIDE + col) as usize] += 3.0;
            }
        }
        gpu.refill(frame, 0, &heights)?; // an engine writes the rectangle of its image on the GPU
        gpu.run(|commands| frame.renderer().record_edit(commands, 0, &inputs, &outputs, hill))?;
        let edited = gpu.pixels(frame, 0)?;

        gpu.run(|commands| frame.renderer().record(commands, 0, &inputs, &outputs))?;
        Ok([before, edited, gpu.pixels(frame, 0)?])
    })
}

fn main() -> ridgelight::Result<()> {
    let [before, edited, whole] = lights()?;
    let changed = before.values.iter().zip(&edited.values).filter(|(b, e)| b != e).count();
    println!("the edit changed {changed} of {} texels", edited.values.len());
    println!("same as a whole frame: {}", edited.values == whole.values);
    Ok(())
}
