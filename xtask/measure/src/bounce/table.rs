//! What bounces add to a frame (NS09, table 1): a frame of N² (512) grid points, 2× sub-sampled, with one, two and three
//! bounces over one without; and the error and the time of sub-sampled bounces.

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless, Timing};
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::{Albedo, Basis, BounceEngine, Bounces, KeyLight, Quality, Scene, fractal};

use super::{Drawn, ENGINES, drawn};
use crate::common::args::Args;
use crate::common::frames::{device, error, open, slices, total};
use crate::common::{Outcome, head, inputs, median};

/// Of the comparison of sub-sampled bounces.
const SUBSAMPLED_SIDE: usize = 128;

/// Its frames a second at 512², 2× sub-sampled, with 1, 2 and 3 bounces, on a GTX 285.
const PAPER_HZ: [f64; 3] = [35.5, 32.0, 30.0];

/// An environment in 32 azimuths and a key light in 3.
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
    let bounces = Bounces { count, engine, azimuths, cutoff: 0.0, ..Bounces::default() };
    Quality {
        basis: Basis::Sh,
        azimuths: 32,
        sun_azimuths: 3,
        subsample: 2,
        bounces,
        ..Quality::default()
    }
}

/// Frames with 0 to 3 bounces, drawn in turn: times of all draws after the first, by frame.
fn in_turn(
    gpu: &mut Headless,
    scene: &Scene,
    plans: &[Plan],
    runs: usize,
) -> Result<Vec<Vec<Vec<Timing>>>> {
    let contents = plan::picture_inputs(scene);
    let frames = plans.iter().map(|plan| gpu.frame(plan.clone(), &slices(&contents)));
    let mut frames = frames.collect::<Result<Vec<Frame>>>()?;
    let mut times = vec![Vec::new(); plans.len()];
    for turn in 0..=runs {
        for (frame, times) in frames.iter_mut().zip(&mut times) {
            let drawn = gpu.draw(frame)?;
            if turn > 0 {
                times.push(drawn);
            }
        }
    }
    frames.into_iter().for_each(|frame| gpu.end(frame));
    Ok(times)
}

/// Medians of a frame's kinds of passes for bounces, ms, by name.
fn parts(plan: &Plan, runs: &[Vec<Timing>]) -> String {
    let of_bounces = |i: usize| plan.passes[i].part.starts_with("bounce");
    let mut names: Vec<&str> =
        (0..plan.passes.len()).filter(|i| of_bounces(*i)).map(|i| plan.passes[i].name()).collect();
    names.sort_unstable();
    names.dedup();
    let sum = |name: &str, run: &[Timing]| -> f64 {
        let of = (0..run.len()).filter(|i| of_bounces(*i) && plan.passes[*i].name() == name);
        of.map(|i| run[i].ns * 1e-6).sum()
    };
    let part = |name: &&str| {
        let ms = median(runs.iter().map(|run| sum(name, run)).collect());
        let count =
            plan.passes.iter().filter(|p| p.name() == *name && p.part.starts_with("bounce"));
        format!("{name} {ms:.1} in {}", count.count())
    };
    names.iter().map(part).collect::<Vec<_>>().join(", ")
}

pub fn run(mut args: Args) -> Outcome {
    let (side, runs) = (args.number("--side", 512)?, args.number("--runs", 11)?);
    args.end()?;
    let mut gpu = open()?;
    println!("{}\n", device(&gpu));
    table(&mut gpu, side, runs)?;
    Ok(subsampled(&mut gpu)?)
}

fn table(gpu: &mut Headless, side: usize, runs: usize) -> Result<()> {
    let scene = scene(side)?;
    let fine = quality(BounceEngine::Sweep, 64, 3);
    let truth = drawn(gpu, &scene, &Quality { subsample: 1, ..fine })?;
    println!(
        "NS09 table 1: a fractal of {side}² under the bundled sky in 32 azimuths and a key light in 3, SH of \
         order 4, 2× sub-sampled; a frame over that without bounces, each drawn in turn, medians of {runs} (of brute \
         and pyramid, 2). Error: three bounces, relative RMSE, %, beside sweeps of 64 azimuths from every grid point\n"
    );
    head(
        "| engine | bounce azimuths | MB | without, ms | 1 | 2 | 3 bounces | third over first | bounced error | whole error |",
    );
    let mut passes = Vec::new();
    for (engine, azimuths) in [
        (BounceEngine::Sweep, 32),
        (BounceEngine::Sweep, 16),
        (BounceEngine::Sweep, 8),
        (BounceEngine::Pyramid, 32),
        (BounceEngine::BruteForce, 32),
    ] {
        let limits = gpu.report().limits;
        let of = |count| quality(engine, azimuths, count);
        let plans: Vec<Plan> = (0..4)
            .map(|count| plan::picture(&scene, &of(count), &limits, Picture::default()))
            .collect::<Result<_>>()?;
        let draws = if engine == BounceEngine::Sweep { runs } else { 2 };
        let times = in_turn(gpu, &scene, &plans, draws)?;
        let ms = times.iter().map(|runs| median(runs.iter().map(|run| total(run)).collect()));
        let ms: Vec<f64> = ms.collect();
        let Drawn { whole, bounced, .. } = drawn(gpu, &scene, &of(3))?;
        println!(
            "| {} | {azimuths} | {:.1} | {:.1} | {:.2} | {:.2} | {:.2} | {:.3} | {:.2} | {:.3} |",
            engine.name(),
            plans[3].internal_bytes() as f64 * 1e-6,
            ms[0],
            ms[1] / ms[0],
            ms[2] / ms[0],
            ms[3] / ms[0],
            ms[3] / ms[1],
            error(&bounced, &truth.bounced)?,
            error(&whole, &truth.whole)?,
        );
        passes.push(format!("{} {azimuths}: {}", engine.name(), parts(&plans[3], &times[3])));
    }
    let [one, two, three] = PAPER_HZ.map(|hz| 1e3 / hz);
    println!(
        "| the paper, GTX 285 | 32 | 20 | not stated | {one:.1} ms | {two:.1} ms | {three:.1} ms | {:.3} | | |\n",
        three / one
    );
    println!("Three bounces, ms of their passes:\n\n{}\n", passes.join("\n"));
    Ok(())
}

fn subsampled(gpu: &mut Headless) -> Result<()> {
    let field = inputs::middle(&inputs::mountain(1.0)?, SUBSAMPLED_SIDE)?;
    let mut scene = inputs::under(field, inputs::sky(0.0)?);
    scene.surface.albedo = Albedo::Constant([0.8; 3]);
    println!(
        "Sub-sampled bounces, the middle {SUBSAMPLED_SIDE}² grid points of the bundled mountain under the bundled sky, albedo 0.8, \
         32 azimuths: relative RMSE, %, beside every grid point's; ms of the bounces over theirs\n"
    );
    head("| engine | bounces | sub-sampling | bounced | whole | ms | over 1× |");
    for (engine, count) in ENGINES.into_iter().flat_map(|engine| [1, 3].map(|n| (engine, n))) {
        let bounces = Bounces { count, engine, cutoff: 0.0, ..Bounces::default() };
        let quality = super::quality(bounces);
        let mut of = |subsample| drawn(gpu, &scene, &Quality { subsample, ..quality });
        let every = of(1)?;
        for subsample in [1, 2, 4] {
            let got = of(subsample)?;
            println!(
                "| {} | {count} | {subsample}× | {:.2} | {:.3} | {:.1} | {:.3} |",
                engine.name(),
                error(&got.bounced, &every.bounced)?,
                error(&got.whole, &every.whole)?,
                got.ms,
                got.ms / every.ms
            );
        }
    }
    println!();
    Ok(())
}
