//! The paper's table 1: what bounces add to a frame (Nowrouzezahrai & Snyder 2009).

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless, Timing};
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::fractal;
use ridgelight::scene::{
    Albedo, Basis, BounceEngine, Bounces, KeyLight, Lights, Quality, Scene, Surface,
};
use ridgelight_io::read_environment;

use crate::{Drawn, drawn, median, off};

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
    let environment = Some(read_environment(Path::new("assets/sky_512x256.hdr"), 0.0)?);
    Ok(Scene {
        field: fractal(side, 1)?,
        surface: Surface { albedo: Albedo::Constant([0.5; 3]), ..Surface::default() },
        lights: Lights { environment, keys: vec![key], ..Lights::default() },
    })
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
    samples: usize,
) -> Result<Vec<Vec<Vec<Timing>>>> {
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let frames = plans.iter().map(|plan| gpu.frame(plan.clone(), &contents));
    let mut frames = frames.collect::<Result<Vec<Frame>>>()?;
    let mut times = vec![Vec::new(); plans.len()];
    for turn in 0..=samples {
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

pub fn run(gpu: &mut Headless, side: usize, samples: usize) -> Result<()> {
    let scene = scene(side)?;
    let fine = quality(BounceEngine::Sweep, 64, 3);
    let truth = drawn(gpu, &scene, &Quality { subsample: 1, ..fine })?;
    println!(
        "The paper's table 1: a fractal of {side}² under the bundled sky in 32 azimuths and a key light in 3, harmonics of \
         order 4, 2× sub-sampled; a frame over that without bounces, each drawn in turn, medians of {samples} (of brute \
         and pyramid, 2). Off: three bounces, RMSE over the mean, %, beside walks of 64 azimuths from every sample\n"
    );
    println!(
        "| engine | bounce azimuths | MB | without, ms | 1 | 2 | 3 bounces | third over first | bounced off | whole off |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut told = Vec::new();
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
        let draws = if engine == BounceEngine::Sweep { samples } else { 2 };
        let times = in_turn(gpu, &scene, &plans, draws)?;
        let total = |run: &Vec<Timing>| run.iter().map(|t| t.ns * 1e-6).sum::<f64>();
        let ms = times.iter().map(|runs| median(runs.iter().map(total).collect()));
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
            off(&bounced, &truth.bounced),
            off(&whole, &truth.whole),
        );
        told.push(format!("{} {azimuths}: {}", engine.name(), parts(&plans[3], &times[3])));
    }
    let [one, two, three] = PAPER_HZ.map(|hz| 1e3 / hz);
    println!(
        "| the paper, GTX 285 | 32 | 20 | not told | {one:.1} ms | {two:.1} ms | {three:.1} ms | {:.3} | | |\n",
        three / one
    );
    println!("Three bounces, ms of their passes:\n\n{}\n", told.join("\n"));
    Ok(())
}
