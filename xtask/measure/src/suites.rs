//! Pages that test suites make on named devices.
//!
//! `reference`: the path tracer against the f64 quadrature and closed forms, as
//! `docs/measured/reference.md`; fails where Monte Carlo noise does not explain a row. See
//! `tools/reference`. `extremes`: every case of `tests/gpu/extremes` with every method, as
//! `out/extremes.md`; fails where a row is beyond its bound. See `tools/extremes`.

#[path = "../../../tests/gpu/extremes/suite/mod.rs"]
mod extreme;
#[path = "../../../tests/common/fields.rs"]
mod fields;
#[path = "../../../tests/common/reference_page.rs"]
pub mod reference_page;
#[path = "../../../tests/common/scenes.rs"]
mod scenes;

use std::path::Path;

use extreme::page::{self, Column};
use extreme::{inputs, methods};
use reference_page::{Closed, FINENESS, MOST_BOUNCES, closed_forms, head, light_names, quadrature};
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::scene::{Normals, Scene};
use ridgelight::{Result, plan};
use ridgelight_cpu::indirect::{GroundTruth, light, smooth_light};
use ridgelight_io as files;
use scenes::{Agreement, scenes};

use crate::common::Outcome;
use crate::common::args::Args;
use crate::common::frames::{self, Colours};
use crate::pages::with;

/// Batches of each picture, and a grid point's paths in them.
const BATCHES: u32 = 64;
const PATHS: f64 = (BATCHES * plan::REFERENCE_BATCH) as f64;
/// f32 rounding, as a share of a value.
const ROUNDING: f64 = 1e-5;

/// The page's prose; only what stands between its marks is written.
const PAGE: &str = "docs/measured/reference.md";
const SCENES: &str = "\
| scene | bounces | light | n | quadrature | stated | paths | ± | z of the mean | rms z | worst z |
|---|---|---|---|---|---|---|---|---|---|---|
";
const CLOSED: &str = "\
| scene | bounces | normals | n | value | grid | quadrature | paths | ± | z |
|---|---|---|---|---|---|---|---|---|---|
";

fn open(name: &str) -> Result<Headless> {
    Headless::new(&HeadlessOptions { device: Some(name.to_owned()), validation: false })
}

/// Writes a page; fails with each complaint.
fn write(path: &str, page: &str, complaints: &[String]) -> Outcome {
    files::write_text(Path::new(path), page)?;
    if complaints.is_empty() { Ok(()) } else { Err(complaints.join("\n").into()) }
}

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
    quadrature: &GroundTruth,
    bounces: usize,
) -> (String, bool) {
    let one = |picture: &[[f64; 3]]| picture.iter().map(|v| [v[channel]]).collect::<Vec<_>>();
    let (light, error) = (one(light), one(error));
    let (right, stated) = (one(&quadrature.radiance[bounces]), one(&quadrature.error[bounces]));
    let of = Agreement::of([&light, &error], [&right, &stated], PATHS, ROUNDING);
    let [mean, sigma] = mean([&light, &error]);
    let z = format!("{:.2} | {:.3} | {:.2} |", of.mean, of.rms, of.worst);
    (format!("{head}{mean:.5} | {sigma:.5} | {z}"), of.holds())
}

/// The row of a closed form; whether noise explains it.
fn closed_row(
    closed: &Closed,
    [light, error]: &[Colours; 2],
    quadrature: &[[f64; 3]],
) -> (String, bool) {
    let of =
        |picture: &[[f64; 3]]| closed.known.iter().map(|k| [picture[k.0][0]]).collect::<Vec<_>>();
    let [found, sigma] = mean([&of(light), &of(error)]);
    let [value, grid] = closed.means();
    let [in_f64, _] = mean([&of(quadrature), &[]]);
    let beyond = ((found - value).abs() - grid - ROUNDING * value).max(0.0);
    let z = if beyond > 0.0 { beyond / sigma } else { 0.0 };
    (format!("{}{in_f64:.6} | {found:.6} | {sigma:.6} | {z:.2} |", closed.head()), z <= 4.0)
}

pub fn reference(mut args: Args) -> Outcome {
    let mut gpu = open(&args.word().ok_or("expected a device")?)?;
    args.end()?;
    let device = frames::device(&gpu);
    let mut wrong = vec!["beyond their bounds:".to_owned()];
    let mut add = |rows: &mut String, (row, holds): (String, bool)| {
        *rows += &row;
        rows.push('\n');
        if !holds {
            wrong.push(row);
        }
    };
    // Each row has a seed of its own: no row shares its paths with another of its scene.
    let mut traced = |scene: &Scene, normals: Normals, bounces: usize| -> Result<[Colours; 2]> {
        let (bounces, is_flat) = (bounces as u32, normals == Normals::Flat);
        let of = (bounces, normals, 1 + 2 * bounces + u32::from(is_flat));
        Ok(frames::traced_at(&mut gpu, scene, of, &[BATCHES])?.remove(0))
    };
    let [mut rows, mut flat_rows] = [SCENES.to_owned(), SCENES.to_owned()];
    for (name, scene) in scenes() {
        // Without bounces, both use the normals of grid points.
        for (rows, normals, fewest) in
            [(&mut rows, Normals::Smooth, 0), (&mut flat_rows, Normals::Flat, 1)]
        {
            let quadrature = quadrature(&scene, normals)?;
            for bounces in fewest..=MOST_BOUNCES {
                let found = traced(&scene, normals, bounces)?;
                for (channel, light) in light_names(&scene).into_iter().enumerate() {
                    let head = head(name, bounces, light, &quadrature, channel);
                    add(rows, row(&head, channel, &found, &quadrature, bounces));
                }
            }
        }
    }
    let mut closed_rows = CLOSED.to_owned();
    for closed in closed_forms() {
        let Closed { scene, bounces, normals, .. } = &closed;
        let found = traced(scene, *normals, *bounces)?;
        let bounces = match normals {
            Normals::Smooth => smooth_light(scene, *bounces, FINENESS.azimuths, FINENESS.strips)?,
            Normals::Flat => light(scene, *bounces, FINENESS)?,
        };
        add(
            &mut closed_rows,
            closed_row(&closed, &found, bounces.last().map_or(&[][..], Vec::as_slice)),
        );
    }
    let complaints = if wrong.len() > 1 { &wrong[..] } else { &[] };
    let path = Path::new(PAGE);
    let device = format!("{PATHS} paths per grid point on *{device}*.\n");
    let mut page = std::fs::read_to_string(path)?;
    let parts = [
        ("device", device),
        ("scenes", rows),
        ("flat scenes", flat_rows),
        ("closed forms", closed_rows),
    ];
    for (name, part) in parts {
        page = with(path, &page, name, &part)?;
    }
    write(PAGE, &page, complaints)
}

pub fn extremes(args: Args) -> Outcome {
    if args.0.is_empty() {
        return Err("expected a device".into());
    }
    let (cases, methods) = (extreme::cases(), methods::all());
    let (mut all, mut complaints) = (Vec::new(), Vec::new());
    for name in args.0 {
        let mut gpu = open(&name)?;
        let driver = frames::device(&gpu);
        let rows = extreme::run(&mut gpu, &cases, &methods, true);
        let values: usize = rows.iter().map(|r| r.outcome.values()).sum();
        println!("{name}: {} rows, {values} values", rows.len());
        let wrong = rows.iter().filter_map(|r| extreme::complaint(r, &cases, &methods));
        complaints.extend(wrong.map(|complaint| format!("{name}: {complaint}")));
        all.push(Column { name, driver, rows });
    }
    for (name, offer, sentence) in inputs::ALL {
        if inputs::said(*offer) != *sentence {
            complaints.push(format!("{name}: {}", inputs::said(*offer)));
        }
    }
    let page = page::text(&cases, &methods, &all);
    let missing = page::missing(&page, &cases, &methods);
    complaints.extend(missing.into_iter().map(|part| format!("the page lacks {part}")));
    std::fs::create_dir_all("out")?;
    write("out/extremes.md", &page, &complaints)
}
