//! What bounces add to a frame (NS09, table 1): a frame of N² (512) grid points, 2× sub-sampled, with
//! one, two and three bounces over one without; and the error and the time of sub-sampled bounces.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Albedo, Basis, BounceEngine, KeyLight, Quality, Scene, fractal};

use super::ENGINES;
use crate::common::args::Args;
use crate::common::frames::{device, drawn_in_layers, error, in_turn};
use crate::common::{Outcome, head, inputs, median};

/// Of the comparison of sub-sampled bounces.
const SUBSAMPLED_SIDE: usize = 128;

/// NS09's frames per second at 512², 2× sub-sampled, with 1, 2 and 3 bounces, on a GTX 285.
const PAPER_HZ: [f64; 3] = [35.5, 32.0, 30.0];

/// A sky and a key light.
fn scene(side: usize) -> Result<Scene> {
    let key = KeyLight {
        azimuth_rad: 2.0,
        width_rad: 0.8,
        elevations_rad: [0.3, 0.8],
        radiance: [2.0, 1.8, 1.5],
    };
    let mut scene = inputs::under(fractal(side, 1)?, inputs::sky(0.0)?);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    scene.lights.keys = vec![key];
    Ok(scene)
}

fn quality(engine: BounceEngine, azimuths: u32, count: u32) -> Quality {
    let bounces = super::quality(engine, count, azimuths).bounces;
    let (basis, subsample) = (Basis::Sh, 2);
    Quality { basis, azimuths: 32, sun_azimuths: 3, subsample, bounces, ..Quality::default() }
}

pub fn run(mut args: Args) -> Outcome {
    let (side, runs) = (args.number("--side", 512)?, args.number("--runs", 11)?);
    let mut gpu = args.open()?;
    println!("{}\n", device(&gpu));
    table(&mut gpu, side, runs)?;
    Ok(subsampled(&mut gpu)?)
}

fn table(gpu: &mut Headless, side: usize, runs: usize) -> Result<()> {
    let scene = scene(side)?;
    let fine = Quality { subsample: 1, ..quality(BounceEngine::BruteForce, 64, 3) };
    let reference = drawn_in_layers(gpu, &scene, &fine)?;
    println!(
        "NS09 table 1: a fractal of {side}² under the bundled sky in 32 azimuths and a key light in 3, SH of \
         order 4, 2× sub-sampled; a frame over that without bounces, each drawn in turn, medians of {runs} (of brute force \
         and pyramid, 2). Error: three bounces, relative RMSE, %, against brute force in 64 azimuths at every grid point\n"
    );
    head(
        "| engine | bounce azimuths | MB | without, ms | 1 | 2 | 3 bounces | third over first | bounced error | whole error |",
    );
    for (engine, azimuths, turns) in [
        (BounceEngine::Sweep, 32, runs),
        (BounceEngine::Sweep, 16, runs),
        (BounceEngine::Sweep, 8, runs),
        (BounceEngine::Pyramid, 32, 2),
        (BounceEngine::BruteForce, 32, 2),
    ] {
        let all = [0, 1, 2, 3].map(|count| quality(engine, azimuths, count));
        let times = in_turn(gpu, &scene, all.each_ref(), turns)?;
        let ms = [0, 1, 2, 3].map(|count| median(times.iter().map(|turn| turn[count]).collect()));
        let found = drawn_in_layers(gpu, &scene, &all[3])?;
        println!(
            "| {} | {azimuths} | {:.1} | {:.1} | {:.2} | {:.2} | {:.2} | {:.3} | {:.2} | {:.3} |",
            engine,
            found.plan.internal_bytes() as f64 * 1e-6,
            ms[0],
            ms[1] / ms[0],
            ms[2] / ms[0],
            ms[3] / ms[0],
            ms[3] / ms[1],
            error(&found.indirect, &reference.indirect)?,
            error(&found.light, &reference.light)?,
        );
    }
    let [one, two, three] = PAPER_HZ.map(|hz| 1e3 / hz);
    println!(
        "| NS09 table 1, GTX 285 | 32 | 20 | not stated | {one:.1} ms | {two:.1} ms | {three:.1} ms | {:.3} | | |\n",
        three / one
    );
    Ok(())
}

fn subsampled(gpu: &mut Headless) -> Result<()> {
    let field = inputs::middle(&inputs::mountain(1.0)?, SUBSAMPLED_SIDE)?;
    let mut scene = inputs::under(field, inputs::sky(0.0)?);
    scene.surface.albedo = Albedo::Constant([0.8; 3]);
    println!(
        "Sub-sampled bounces, the middle {SUBSAMPLED_SIDE}² grid points of the bundled mountain under the bundled sky, albedo 0.8, \
         32 azimuths: relative RMSE, %, against brute force at every grid point; ms of the bounces over those of the same engine at 1×. \
         At 1×, later bounces of walks are found at every fourth grid point\n"
    );
    head("| engine | bounces | sub-sampling | bounced | whole | ms | over 1× |");
    for (engine, count) in ENGINES.into_iter().flat_map(|engine| [1, 3].map(|n| (engine, n))) {
        let quality = super::quality(engine, count, 32);
        let exact =
            drawn_in_layers(gpu, &scene, &super::quality(BounceEngine::BruteForce, count, 32))?;
        let mut own_ms = None;
        for subsample in [1, 2, 4] {
            let found = drawn_in_layers(gpu, &scene, &Quality { subsample, ..quality })?;
            let ms = found.bounces_ms();
            let over = ms / *own_ms.get_or_insert(ms);
            println!(
                "| {} | {count} | {subsample}× | {:.2} | {:.3} | {:.1} | {:.3} |",
                engine,
                error(&found.indirect, &exact.indirect)?,
                error(&found.light, &exact.light)?,
                ms,
                over
            );
        }
    }
    println!();
    Ok(())
}
