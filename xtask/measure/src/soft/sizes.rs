//! Memory and time, by size, engine, sub-sampling and wedges (NS09, table 1).

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::Picture;
use ridgelight::scene::{Basis, Levels, Method, Quality, Scene, Wedges, fractal};

use crate::common::args::Args;
use crate::common::frames::{bytes, ms, total, with_picture};
use crate::common::{Outcome, cells, head, inputs, median};

/// NS09's settings: 32 azimuths, four levels per octave, order 4.
fn rows() -> Vec<(String, Quality)> {
    let base = Quality { basis: Basis::Sh, azimuths: 32, ..Quality::default() };
    let pyramid = |levels| Quality { method: Method::Pyramid, levels, ..base };
    let engines = [
        ("sweep", base),
        ("pyramid, stack", pyramid(Levels::Stack)),
        ("pyramid, levels", pyramid(Levels::Pyramid)),
    ];
    let subsampled = |(name, quality)| {
        [1, 2, 4].map(|s| (format!("{name}, {s}×"), Quality { subsample: s, ..quality }))
    };
    let mut all: Vec<(String, Quality)> = engines.into_iter().flat_map(subsampled).collect();
    all.push(("sweep, 1×, NLP".into(), Quality { wedges: Wedges::Nlp, ..base }));
    all.push(("sweep, 1×, table of wedges".into(), Quality { wedges: Wedges::Table, ..base }));
    all
}

/// The cells of a row: MB of all internal images, of levels and of visibility; medians of horizons, of a
/// frame, and of a frame whose light alone is new, ms.
fn measured(gpu: &mut Headless, scene: &Scene, quality: &Quality, runs: usize) -> Result<String> {
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    with_picture(gpu, scene, quality, wanted, |gpu, frame| {
        let plan = frame.plan().clone();
        let environment = plan.find("environment").expect("an environment");
        let new_light = plan.passes_after(&plan, &[environment]);
        let mut times = [(); 3].map(|()| Vec::new());
        for _ in 0..runs {
            let whole = gpu.draw(frame)?;
            let horizons = ["height_", "horizon_sweep", "pyramid_march"];
            times[0].push(horizons.iter().map(|name| ms(&whole, name)).sum());
            times[1].push(total(&whole));
            times[2].push(total(&gpu.draw_passes(frame, &new_light)?));
        }
        let levels = bytes(&plan, &["height_levels", "level_table", "height_stack"]);
        let visibility = bytes(&plan, &["visibility", "nodes"]);
        let mb = [plan.internal_bytes(), levels, visibility].map(|b| b as f64 * 1e-6);
        Ok(format!("{} | {}", cells(1, mb), cells(2, times.map(median))))
    })
}

pub fn run(mut args: Args) -> Outcome {
    let (largest, runs) = (args.number("--largest", 1024)?, args.number("--runs", 11)?);
    let mut gpu = args.open()?;
    println!(
        "{}\na fractal field under the bundled sky, 32 azimuths, k = 4, o = 2, order 4; medians of {runs}\n",
        gpu.report().name
    );
    for side in [256, 512, 1024].into_iter().filter(|side| *side <= largest) {
        let scene = inputs::under(fractal(side, 1)?, inputs::sky(0.0)?);
        head(&format!(
            "| {side}² | MB | levels MB | visibility MB | horizons ms | frame ms | new light ms |"
        ));
        for (name, quality) in rows() {
            println!("| {name} | {} |", measured(&mut gpu, &scene, &quality, runs)?);
        }
        println!();
    }
    Ok(())
}
