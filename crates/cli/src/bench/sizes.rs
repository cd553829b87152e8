//! Time against the field's size and the number of azimuths.

use std::time::Instant;

use indicatif::ProgressBar;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::fractal;
use ridgelight::scene::{Quality, Scene};

use super::overlapped;
use super::progress::Progress;
use super::rows::{Row, figure};
use super::verify::GroundTruth;
use crate::args::BenchArgs;

/// Whole frames of fractal fields under the scene's lights, for each pair of `--sizes` and `azimuths`, with the relative
/// RMSE against the oracle. Prints each row as soon as it is measured, because a later size may exceed the device's memory.
/// `later` rows of other tables follow.
pub fn run(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
    limits: &Limits,
    (args, azimuths): (&BenchArgs, &[u32]),
    (bar, later): (&ProgressBar, usize),
) -> Result<Vec<Row>> {
    let say = |line: String| {
        if !args.global.quiet {
            bar.suspend(|| crate::say!("{line}"));
        }
    };
    let mut rows = Vec::new();
    let all: Vec<(usize, u32)> = args
        .sizes
        .iter()
        .flat_map(|size| azimuths.iter().map(move |count| (*size, *count)))
        .collect();
    let names = all.iter().map(|(size, count)| format!("{size}², {count} azimuths"));
    let mut progress = Progress::new(bar, names, args.runs, later);
    say(head());
    for &size in &args.sizes {
        let scene = Scene { field: fractal(size, 1)?, ..scene.clone() };
        let ground_truth = GroundTruth::of(&scene);
        let inputs = plan::picture_inputs(&scene);
        for &count in azimuths {
            progress.begin_next();
            let quality = Quality { azimuths: count, ..*quality };
            let plan = plan::picture(&scene, &quality, limits, Picture::default())?;
            let ((count_of_runs, times), run_s, pixels) =
                gpu.with_frame(plan.clone(), &inputs, |gpu, frame| {
                    let begun = Instant::now();
                    let timed = overlapped(gpu, frame, args.runs)?;
                    // One run warms up.
                    let run_s = begun.elapsed().as_secs_f64() / (timed.0 + 1) as f64;
                    Ok((timed, run_s, gpu.pixels(frame, 0)?))
                })?;
            let each_s = run_s / work((size, count));
            progress.runs_take(all.iter().map(|row| each_s * work(*row)));
            let passes: Vec<_> = plan.passes.iter().collect();
            let measured = (count_of_runs, &times[..]);
            let mut row = Row::of("total", "overlapped", &plan, &passes, count, measured);
            row.settings.extend([
                ("device_bytes".into(), plan.bytes().to_string()),
                ("light_error".into(), format!("{:.6}", ground_truth.error(&pixels))),
                ("passes".into(), plan.passes.len().to_string()),
            ]);
            say(text(&row));
            rows.push(row);
        }
    }
    Ok(rows)
}

/// Texels times azimuths, to which times are about proportional.
fn work((size, azimuths): (usize, u32)) -> f64 {
    (size * size) as f64 * f64::from(azimuths)
}

fn head() -> String {
    format!(
        "{:>6} {:>9} {:>12} {:>15} {:>10} {:>11} {:>13} {:>8}",
        "side",
        "azimuths",
        "frame ms",
        "ms/(az·2^20)",
        "device MB",
        "MB/2^20",
        "light error %",
        "runs"
    )
}

fn text(row: &Row) -> String {
    let setting =
        |name: &str| -> Option<f64> { row.settings.iter().find(|s| s.0 == name)?.1.parse().ok() };
    let mb = setting("device_bytes").map(|b| b * 1e-6);
    let mega = f64::from(row.size[0]) * f64::from(row.size[1]) / f64::from(1 << 20);
    format!(
        "{:>6} {:>9} {:>12} {:>15} {:>10} {:>11} {:>13} {:>8}",
        row.size[0],
        row.azimuths,
        figure(row.times.map(|t| t.median * 1e-6), 2),
        figure(row.ms_per_azimuth_and_mega(), 3),
        figure(mb, 1),
        figure(mb.map(|b| b / mega), 1),
        figure(setting("light_error").map(|e| 100.0 * e), 3),
        row.runs
    )
}
