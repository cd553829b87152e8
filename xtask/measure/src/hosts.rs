//! Hosts: frame times of the example programs, and of the same passes without a host.

use std::process::Command;
use std::time::Instant;

use ridgelight::plan::{self, Picture};
use ridgelight::scene::Quality;
use ridgelight::{Error, Result};

use crate::common::args::Args;
use crate::common::frames::{device, total};
use crate::common::{Outcome, head, median};

#[expect(dead_code, reason = "of the host programs only their scene")]
#[path = "../../../examples/host/scene.rs"]
mod host_scene;

/// Frames that are timed. A run of one frame is timed too, and subtracted with its start-up.
const FRAMES: u32 = 400;
const RUNS: usize = 5;

fn failed(program: &str, reason: impl ToString) -> Error {
    Error::Device { doing: format!("running {program}"), reason: reason.to_string() }
}

/// What a program prints.
fn run_of(program: &str, args: &[&str]) -> Result<String> {
    let done = Command::new(program).args(args).output();
    let done = done.map_err(|error| failed(program, error))?;
    if !done.status.success() {
        return Err(failed(program, String::from_utf8_lossy(&done.stderr)));
    }
    Ok(String::from_utf8_lossy(&done.stdout).into_owned())
}

/// Milliseconds per frame after the first, of `PROGRAM OUT FRAMES`.
fn frame_ms(program: &str, out: &str) -> Result<f64> {
    let mut seconds = [0.0; 2];
    for (seconds, frames) in seconds.iter_mut().zip([1, 1 + FRAMES]) {
        let begun = Instant::now();
        run_of(program, &[out, &frames.to_string()])?;
        *seconds = begun.elapsed().as_secs_f64();
    }
    Ok(1e3 * (seconds[1] - seconds[0]) / f64::from(FRAMES))
}

/// Milliseconds that new heights add to a Bevy frame. The program prints the time of a frame with new heights, then without.
fn added_ms(program: &str) -> Result<f64> {
    let printed = run_of(program, &[&FRAMES.to_string()])?;
    let ms: Vec<f64> = printed.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match ms[..] {
        [with, without] => Ok(with - without),
        _ => Err(failed(
            program,
            format!(
                "printed {printed:?}, expected two numbers: ms per frame with and without new heights"
            ),
        )),
    }
}

/// Takes one `HOST=CRATES=PROGRAM` per host. A program named `frames` is measured as Bevy's.
pub fn run(mut args: Args) -> Outcome {
    let mut hosts = Vec::new();
    while let Some(word) = args.word() {
        let parts: Vec<String> = word.splitn(3, '=').map(str::to_owned).collect();
        let [name, crates, program] = parts
            .try_into()
            .map_err(|_| Error::setting("a host", format!("{word:?}"), "HOST=CRATES=PROGRAM"))?;
        hosts.push((name, crates, program));
    }
    let mut gpu = args.open()?;
    let (scene, folder) = (host_scene::scene()?, tempfile::tempdir()?);
    let out = folder.path().join("light.exr");
    let out = out.to_str().unwrap_or_default();
    let limits = gpu.report().limits;
    // Bevy's plan has the light in layers, and takes edits.
    let of_bevy = Picture { light_layers: true, keeps_horizons: true, ..Picture::default() };
    let mut frames = Vec::new();
    for wanted in [Picture::default(), of_bevy] {
        let plan = plan::picture(&scene, &Quality::default(), &limits, wanted)?;
        frames.push(gpu.frame(plan, &[scene.field.heights_m()])?);
    }
    let bytes = [0, 1].map(|i| frames[i].plan().bytes() as f64 * 1e-6);
    let mut rows = vec![Vec::new(); hosts.len()];
    let mut passes = [const { Vec::new() }; 2];
    for _ in 0..RUNS {
        for (frame, passes) in frames.iter_mut().zip(&mut passes) {
            for _ in 0..FRAMES {
                passes.push(total(&gpu.draw(frame)?));
            }
        }
        for (row, (_, _, program)) in rows.iter_mut().zip(&hosts) {
            let is_bevy = program.ends_with("/frames");
            row.push(if is_bevy { added_ms(program)? } else { frame_ms(program, out)? });
        }
    }
    frames.into_iter().for_each(|frame| gpu.end(frame));
    let passes = passes.map(median);
    println!(
        "Each frame uploads 48 × 64 heights, computes the light of a sky and a sun, reads the light back and waits for the device. \
         Without a host, the same passes take {:.1} ms by device timestamps; the plan's images and buffers take {:.2} MB. For Bevy the \
         time is a difference: a frame with new heights minus a frame without, in `examples/frames.rs`, without a window and built with \
         the dev profile (`opt-level = 1`). It reads nothing back. Its plan also keeps horizons for edits: without a host, its passes \
         take {:.1} ms, and its images and buffers {:.2} MB. Each time is the median of {RUNS} runs of {FRAMES} frames, without start-up; the hosts run in turn. \
         Device: {}.\n",
        passes[0],
        bytes[0],
        passes[1],
        bytes[1],
        device(&gpu)
    );
    head("| host | crates added | ms per frame | lowest and highest run |");
    for ((name, crates, _), row) in hosts.iter().zip(rows) {
        let low = row.iter().copied().fold(f64::INFINITY, f64::min);
        let high = row.iter().copied().fold(0.0, f64::max);
        println!("| {name} | {crates} | {:.1} | {low:.1} to {high:.1} |", median(row));
    }
    Ok(())
}
