//! Memory and time by size, engine, sub-sampling and wedges.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::{self, Picture, Plan, Resource};
use ridgelight::scene::fractal;
use ridgelight::scene::{Basis, Levels, Lines, Method, Quality, Scene, Wedges};
use ridgelight_io::read_environment;

use crate::{median, under};

const MB: f64 = 1e-6;

/// The paper's settings: 32 azimuths, four levels an octave, order 4.
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

/// Medians of a frame's stages, ms: horizons, what is seen, the light's matrix, shading; of the whole, and of
/// a frame whose light alone is new.
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
    let total = |run: &Vec<Timing>| run.iter().map(|t| t.ns * 1e-6).sum::<f64>();
    let [a, b, c, d] = of.map(|names| median(whole.iter().map(|run| sum(run, names)).collect()));
    let [e, f] = [whole, relit].map(|runs| median(runs.iter().map(total).collect()));
    [a, b, c, d, e, f]
}

/// One row: stages, and bytes of all internal images, of levels, and of what is seen.
fn measured(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
    samples: usize,
) -> Result<([f64; 6], [u64; 3])> {
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let plan = plan::picture(scene, quality, &gpu.report().limits, wanted)?;
    let kept = plan.clone();
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let environment = kept.find("environment").expect("an environment");
    let new_light = kept.passes_after(&kept, &[environment]);
    let times = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let (mut whole, mut relit) = (Vec::new(), Vec::new());
        for _ in 0..samples {
            whole.push(gpu.draw(frame)?);
            relit.push(gpu.draw_passes(frame, &new_light)?);
        }
        Ok(stages(&kept, &whole, &relit))
    })?;
    let of = |names: &[&str]| {
        let all = kept.resources.iter().filter(|r| names.contains(&r.name.as_str()));
        all.map(Resource::bytes).sum()
    };
    let levels = of(&["height_levels", "level_table", "height_stack"]);
    Ok((times, [kept.internal_bytes(), levels, of(&["visibility", "nodes"])]))
}

pub fn run(gpu: &mut Headless, largest: usize, samples: usize) -> Result<()> {
    println!(
        "a fractal field under the bundled sky, 32 azimuths, k = 4, o = 2, order 4; medians of {samples}; \
         ratios to the same engine at 1×\n"
    );
    for side in [256, 512, 1024].into_iter().filter(|side| *side <= largest) {
        let sky = read_environment(Path::new("assets/sky_512x256.hdr"), 0.0)?;
        let scene = under(fractal(side, 1)?, sky);
        println!(
            "| {side}² | MB | levels MB | seen MB | horizons ms | seen ms | light ms | shade ms | frame ms | \
             new light ms | frame, to 1× | MB, to 1× |"
        );
        println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
        let mut whole = [1.0, 1.0];
        for (name, quality) in rows() {
            let (times, bytes) = measured(gpu, &scene, &quality, samples)?;
            let mb = bytes.map(|b| b as f64 * MB);
            if quality.subsample == 1 && quality.wedges == Wedges::Slices {
                whole = [times[4], mb[0]];
            } else if name.starts_with("sweep, lines 2") {
                let (times, bytes) = measured(gpu, &scene, &rows()[0].1, samples)?;
                whole = [times[4], bytes[0] as f64 * MB];
            }
            let [horizons, seen, light, shade, frame, relit] = times;
            println!(
                "| {name} | {:.1} | {:.1} | {:.1} | {horizons:.2} | {seen:.2} | {light:.2} | {shade:.2} | \
                 {frame:.2} | {relit:.2} | {:.2} | {:.2} |",
                mb[0],
                mb[1],
                mb[2],
                frame / whole[0],
                mb[0] / whole[1]
            );
        }
        println!();
    }
    Ok(())
}
