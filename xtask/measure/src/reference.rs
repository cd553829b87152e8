//! Holds the path tracer to the f64 quadrature and to closed forms, and writes what was found as
//! `docs/measured/reference.md`. See `tools/reference`.
//! Fails where Monte Carlo noise does not explain a row.

#[path = "../../../tests/common/fields.rs"]
mod fields;
#[path = "../../../tests/common/reference_page.rs"]
mod reference_page;
#[path = "../../../tests/common/scenes.rs"]
mod scenes;

use std::path::Path;

use reference_page::{Closed, FINENESS, MOST_BOUNCES, closed_forms, head, light_names};
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::scene::Scene;
use ridgelight::{Result, plan};
use ridgelight_cpu::indirect;
use ridgelight_cpu::indirect::GroundTruth;
use ridgelight_io as files;
use scenes::{Agreement, scenes};

use crate::common::Outcome;
use crate::common::args::Args;
use crate::common::frames::{self, Colours};

/// Batches of each picture, and a grid point's paths in them.
const BATCHES: u32 = 64;
const PATHS: f64 = (BATCHES * plan::REFERENCE_BATCH) as f64;
/// What f32 may take from a value.
const ROUNDING: f64 = 1e-5;

const ABOUT: &str = "\
# The reference against the oracle and closed forms

`ridgelight reference` is a path tracer on the device. This page compares it with an f64 quadrature, which shares no
code with it, and with scenes whose radiance is a formula. `tools/reference` makes this page. The test
`tests/gpu/reference/quadrature.rs` makes the same comparison on the driver at hand, and `tests/cpu/bounce` checks that the quadrature's
figures here are those of the code.
";

const SCENES: &str = "
## Against the quadrature

Scenes of `tests/common/scenes.rs`. Sky, sun and a sphere light each light a colour channel of their own, so each light is judged
alone. *paths* is the mean radiance over all grid points. *±* is one standard error of that mean: √(Σσ²)/n, with σ of each
grid point from the spread between its batches. *quadrature* is the same mean in f64. *stated* is the mean of its stated
error, the difference to half the fineness.

z of a grid point = (|paths - quadrature| - stated, at least 0) / σ; z of the mean likewise, with the sums. σ also holds
events too rare to have been sampled, which no spread contains: σ² + W·|difference| / 3N for N paths per grid point that
carry W at most (Bernstein's inequality; W: the brightest grid point). Expected of n grid points with normal noise:

| | expected | bound |
|---|---|---|
| rms z | 1, or less where *stated* or rare events are not small beside σ | 1 + 4 / √(2n), four of its own standard deviations |
| worst z | about √(2 ln n): 2.4 of 16, 3.3 of 200 | 6: one in 50,000 tables of 10,000 grid points |
| z of the mean | below 1 in two of three rows | 4 |

0 in every column: the light has no noise there, or reaches no grid point.
";

const CLOSED: &str = "
## Against closed forms

Derived in `tests/common/reference_page.rs`. *grid* bounds the difference between flat triangles and the formula's surface;
it is 0 except for the pit, whose rim is a staircase. *quadrature* is of the same triangles in f64; its own error is that
of its 24 azimuths. z = (|paths - value| - grid, at least 0) / ±; bound 4.
";

/// Mean of a channel and one standard error of it.
fn mean([light, error]: [&[[f64; 1]]; 2]) -> [f64; 2] {
    let count = light.len() as f64;
    let variance: f64 = error.iter().map(|e| e[0] * e[0]).sum();
    [light.iter().map(|v| v[0]).sum::<f64>() / count, variance.sqrt() / count]
}

/// The row of one channel; whether noise explains it.
fn row(
    head: &str,
    channel: usize,
    [light, error]: &[Colours; 2],
    truth: &GroundTruth,
    bounces: usize,
) -> (String, bool) {
    let one = |picture: &[[f64; 3]]| picture.iter().map(|v| [v[channel]]).collect::<Vec<_>>();
    let (light, error) = (one(light), one(error));
    let (right, stated) = (one(&truth.radiance[bounces]), one(&truth.error[bounces]));
    let of = Agreement::of([&light, &error], [&right, &stated], PATHS, ROUNDING);
    let [mean, off] = mean([&light, &error]);
    let row =
        format!("{head}{mean:.5} | {off:.5} | {:.2} | {:.3} | {:.2} |", of.mean, of.rms, of.worst);
    (row, of.holds())
}

/// The row of a closed form; whether noise explains it.
fn closed_row(
    closed: &Closed,
    [light, error]: &[Colours; 2],
    quadrature: &[[f64; 3]],
) -> (String, bool) {
    let of =
        |picture: &[[f64; 3]]| closed.known.iter().map(|k| [picture[k.0][0]]).collect::<Vec<_>>();
    let [found, off] = mean([&of(light), &of(error)]);
    let [value, grid] = closed.means();
    let [in_f64, _] = mean([&of(quadrature), &[]]);
    let z = match (found - value).abs() - grid - ROUNDING * value {
        beyond if beyond <= 0.0 => 0.0,
        beyond => beyond / off,
    };
    (format!("{}{in_f64:.6} | {found:.6} | {off:.6} | {z:.2} |", closed.head()), z <= 4.0)
}

pub fn run(mut args: Args) -> Outcome {
    let device = args.word().ok_or("expected a device")?;
    args.end()?;
    let options = HeadlessOptions { device: Some(device), validation: false };
    let mut gpu = Headless::new(&options)?;
    let mut page = format!(
        "{ABOUT}\n{PATHS} paths per grid point on *{}*.\n{SCENES}\n\
         | scene | bounces | light | n | quadrature | stated | paths | ± | z of the mean | rms z | worst z |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
        frames::device(&gpu)
    );
    let mut wrong = Vec::new();
    let mut add = |page: &mut String, (row, holds): (String, bool)| {
        *page += &row;
        page.push('\n');
        if !holds {
            wrong.push(row);
        }
    };
    // Seeds of their own: no row shares its paths with another of its scene.
    let mut traced = |scene: &Scene, bounces: usize| -> Result<[Colours; 2]> {
        let seed = 1 + bounces as u32;
        Ok(frames::traced_at(&mut gpu, scene, (bounces as u32, seed), &[BATCHES])?.remove(0))
    };
    for (name, scene) in scenes() {
        let truth = indirect::ground_truth(&scene, MOST_BOUNCES, FINENESS)?;
        for bounces in 0..=MOST_BOUNCES {
            let found = traced(&scene, bounces)?;
            for (channel, light) in light_names(&scene).into_iter().enumerate() {
                let head = head(name, bounces, light, &truth, channel);
                add(&mut page, row(&head, channel, &found, &truth, bounces));
            }
        }
    }
    page += CLOSED;
    page += "\n| scene | bounces | n | value | grid | quadrature | paths | ± | z |\n|---|---|---|---|---|---|---|---|---|\n";
    for closed in closed_forms() {
        let found = traced(&closed.scene, closed.bounces)?;
        let bounces = indirect::light(&closed.scene, closed.bounces, FINENESS)?;
        let last = bounces.last().map_or(&[][..], Vec::as_slice);
        add(&mut page, closed_row(&closed, &found, last));
    }
    files::write_text(Path::new("docs/measured/reference.md"), &page)?;
    let all = wrong.join("\n");
    if wrong.is_empty() { Ok(()) } else { Err(format!("beyond their bounds:\n{all}").into()) }
}
