//! Memory and time of each stage, by size, engine, sub-sampling and wedges (NS09, table 1).

use ridgelight::Result;
use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::{Picture, Plan};
use ridgelight::scene::{Basis, Levels, Lines, Method, Quality, Scene, Wedges, fractal};

use crate::common::args::Args;
use crate::common::frames::{bytes, open, total, with_picture};
use crate::common::{Outcome, head, inputs, median};

const MB: f64 = 1e-6;

/// NS09's settings: 32 azimuths, four levels an octave, order 4.
fn rows() -> Vec<(String, Quality)> {
    let base = Quality { basis: Basis::Sh, azimuths: 32, ..Quality::default() };
    let pyramid = |levels| Quality { method: Method::Pyramid, levels, ..base };
    let engines = [
        ("sweep", base),
        ("pyramid, stack", pyramid(Levels::Stack)),
        ("pyramid, levels", pyramid(Levels::Pyramid)),
    ];
    let mut all: Vec<(String, Quality)> = engines
        .into_iter()
        .flat_map(|(name, quality)| {
            [1, 2, 4].map(|s| (format!("{name}, {s}×"), Quality { subsample: s, ..quality }))
        })
        .collect();
    let lines = [(2, Lines::TwoCells), (4, Lines::FourCells)];
    all.extend(lines.map(|(subsample, lines)| {
        let name = format!("sweep, lines {}, {subsample}×", lines.name());
        (name, Quality { subsample, lines, ..base })
    }));
    all.push(("sweep, 1×, NLP".into(), Quality { wedges: Wedges::Nlp, ..base }));
    all.push(("sweep, 1×, table of wedges".into(), Quality { wedges: Wedges::Table, ..base }));
    all
}

/// Medians of a frame's stages, ms: horizons, visibility, the light's matrix, shading; of the whole, and of a
/// frame whose light alone is new.
fn stages(plan: &Plan, whole: &[Vec<Timing>], relit: &[Vec<Timing>]) -> [f64; 6] {
    let horizons =
        ["height_transpose", "height_reduce", "height_expand", "horizon_sweep", "pyramid_march"];
    let of: [&[&str]; 4] = [
        &horizons,
        &["sh_visibility", "sweep_fuse", "sh_wedges"],
        &["env_rotation", "light_matrix"],
        &["sh_shade", "light_resolve"],
    ];
    let sum = |run: &Vec<Timing>, names: &[&str]| -> f64 {
        let all = run.iter().zip(&plan.passes);
        all.filter(|(_, p)| names.contains(&p.name())).map(|(t, _)| t.ns * 1e-6).sum()
    };
    let [a, b, c, d] = of.map(|names| median(whole.iter().map(|run| sum(run, names)).collect()));
    let [e, f] = [whole, relit].map(|runs| median(runs.iter().map(|run| total(run)).collect()));
    [a, b, c, d, e, f]
}

/// One row: stages, and bytes of all internal images, of levels, and of visibility.
fn measured(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
    count: usize,
) -> Result<([f64; 6], [u64; 3])> {
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    with_picture(gpu, scene, quality, wanted, |gpu, frame| {
        let plan = frame.plan().clone();
        let environment = plan.find("environment").expect("an environment");
        let new_light = plan.passes_after(&plan, &[environment]);
        let (mut whole, mut relit) = (Vec::new(), Vec::new());
        for _ in 0..count {
            whole.push(gpu.draw(frame)?);
            relit.push(gpu.draw_passes(frame, &new_light)?);
        }
        let levels = bytes(&plan, &["height_levels", "level_table", "height_stack"]);
        let visibility = bytes(&plan, &["visibility", "nodes"]);
        Ok((stages(&plan, &whole, &relit), [plan.internal_bytes(), levels, visibility]))
    })
}

pub fn run(mut args: Args) -> Outcome {
    let (largest, count) = (args.number("--largest", 1024)?, args.number("--runs", 11)?);
    args.end()?;
    let mut gpu = open()?;
    println!(
        "{}\na fractal field under the bundled sky, 32 azimuths, k = 4, o = 2, order 4; medians of {count}; \
         ratios to the same engine at 1×\n",
        gpu.report().name
    );
    for side in [256, 512, 1024].into_iter().filter(|side| *side <= largest) {
        let scene = inputs::under(fractal(side, 1)?, inputs::sky(0.0)?);
        head(&format!(
            "| {side}² | MB | levels MB | visibility MB | horizons ms | visibility ms | light ms | shade ms | frame ms | \
             new light ms | frame, to 1× | MB, to 1× |"
        ));
        let mut whole = [1.0, 1.0];
        for (name, quality) in rows() {
            let (times, bytes) = measured(&mut gpu, &scene, &quality, count)?;
            let mb = bytes.map(|b| b as f64 * MB);
            if quality.subsample == 1 && quality.wedges == Wedges::Slices {
                whole = [times[4], mb[0]];
            } else if name.starts_with("sweep, lines 2") {
                let (times, bytes) = measured(&mut gpu, &scene, &rows()[0].1, count)?;
                whole = [times[4], bytes[0] as f64 * MB];
            }
            println!(
                "| {name} | {} | {} | {:.2} | {:.2} |",
                mb.map(|mb| format!("{mb:.1}")).join(" | "),
                times.map(|ms| format!("{ms:.2}")).join(" | "),
                times[4] / whole[0],
                mb[0] / whole[1]
            );
        }
        println!();
    }
    Ok(())
}
