//! Bakes the bundled mountain, three times as steep: the picture of docs/baking.md, of what `ridgelight bake` makes, and what each way
//! of packing may be off by and is.
//!
//! `cargo run --release --example bake -- -o PICTURE.png --json FIGURES.json`

#[path = "bake/looked.rs"]
mod looked;
#[path = "shared/mountain.rs"]
#[expect(dead_code, reason = "sides are for others to ask")]
mod mountain;

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;

use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan;
use ridgelight::scene::Tone;
use ridgelight::scene::{Border, Environment, HeightField, Method, Quality};
use ridgelight::{Error, Result};
use ridgelight_bake as bake;
use ridgelight_bake::{
    BentNormal, Encoding, HorizonMap, HorizonSums, Ray, ShTransfer, ShVisibility, SkyView,
    VisibleSky,
};
use ridgelight_io as files;
use serde_json::{Value, json};

const SIDE: usize = 256;
const STEEPER: f64 = 3.0;
const AZIMUTHS: u32 = 64;
const ORDER: usize = 4;
/// White texels between pictures.
const GAP: usize = 4;

/// Of fields that are looked at from afar.
const LIT_SIDE: usize = 64;

/// A kind, what it is of each sample, and its planes.
struct Baked {
    kind: &'static str,
    channels: String,
    /// What of it takes so many bytes.
    each: &'static str,
    encodings: &'static [Encoding],
    planes: Vec<Vec<f32>>,
}

impl Baked {
    fn of(
        kind: &'static str,
        channels: &str,
        each: &'static str,
        encodings: &'static [Encoding],
        planes: Vec<Vec<f32>>,
    ) -> Self {
        Self { kind, channels: channels.to_owned(), each, encodings, planes }
    }
}

/// Elevations along even azimuths, exact in each.
fn horizons(gpu: &mut Headless, field: &HeightField) -> Result<Vec<Vec<f32>>> {
    let quality = Quality { azimuths: AZIMUTHS, method: Method::BruteForce, ..Quality::default() };
    let limits = gpu.report().limits;
    let plan = plan::horizons(field, Border::Plane, &quality, &limits, (0, AZIMUTHS), false)?;
    let order = plan.layer_azimuths.clone();
    let values = gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        Ok(gpu.pixels(frame, 0)?.values)
    })?;
    let layers: Vec<&[f32]> = values.chunks_exact(SIDE * SIDE).collect();
    let layer_of = |k| order.iter().position(|o| *o == k).expect("every azimuth has its layer");
    Ok((0..AZIMUTHS).map(|k| layers[layer_of(k)].to_vec()).collect())
}

fn summed(field: &HeightField, horizons: &[Vec<f32>], what: Box<dyn HorizonMap>) -> Vec<Vec<f32>> {
    let normals = bake::normals(field, Border::Plane);
    let width_rad = TAU / f64::from(AZIMUTHS);
    let mut sums = HorizonSums::new(what, SIDE * SIDE);
    for (k, elevations) in horizons.iter().enumerate() {
        sums.add(Ray { azimuth_rad: width_rad * k as f64, width_rad }, elevations, &normals)
            .expect("memory");
    }
    sums.end(&normals).expect("memory")
}

fn all(field: &HeightField, horizons: Vec<Vec<f32>>) -> Vec<Baked> {
    let mut all = Vec::new();
    let mut add = |kind, channels: &str, encodings, what: Box<dyn HorizonMap>| {
        let planes = summed(field, &horizons, what);
        all.push(Baked::of(kind, channels, "a sample", encodings, planes));
    };
    let coefficients = format!("{} of order {ORDER}", ORDER * ORDER);
    add("sky-view", "1", &bake::SHARE, Box::new(SkyView));
    add("visible-sky", "1", &bake::SHARE, Box::new(VisibleSky));
    add("bent-normal", "direction, cone", &bake::BENT_NORMAL, Box::new(BentNormal));
    let series = &bake::COEFFICIENTS;
    add("sh-visibility", &coefficients, series, Box::new(ShVisibility::new(ORDER)));
    add("sh-transfer", &coefficients, series, Box::new(ShTransfer::new(ORDER)));
    all.insert(0, Baked::of("horizon", "1", "an azimuth", &bake::HORIZON, horizons));
    all
}

/// A row a way of packing: what is promised, and the most that was found here.
fn rows(baked: &Baked) -> Vec<Value> {
    let row = |encoding: &Encoding| {
        let mut worst = vec![(0.0_f64, 0.0_f64); encoding.bounds.len()];
        let (mut values, component) = (vec![0.0; encoding.values], encoding.component);
        for layer in baked.planes.chunks(encoding.values) {
            for i in 0..layer[0].len() {
                for (value, plane) in values.iter_mut().zip(layer) {
                    *value = f64::from(plane[i]);
                }
                let back = encoding.packed(&values);
                for (worst, bound) in worst.iter_mut().zip(encoding.bounds) {
                    worst.0 = worst.0.max((bound.error)(&back, &values)[0]);
                    worst.1 = worst.1.max(bound.share(component, &back, &values));
                }
            }
        }
        let bounds = encoding.bounds.iter().zip(worst).map(|(bound, (off, share))| {
            json!({
                "of": bound.of, "unit": bound.unit, "at_most": bound.absolute(component),
                "and_of_the_value": bound.relative(component), "worst": off, "share": share,
            })
        });
        // Three components have a fourth beside them.
        let components = encoding.components.next_power_of_two();
        let texels = match baked.each {
            "a sample" => baked.planes.len().div_ceil(encoding.values),
            _ => 1,
        };
        json!({
            "kind": baked.kind, "channels": baked.channels, "encoding": encoding.name,
            "bytes": texels * components * component.bytes(), "each": baked.each,
            "bounds": bounds.collect::<Vec<_>>(),
        })
    };
    baked.encodings.iter().map(row).collect()
}

/// Light as harmonics.
fn series(sky: &Environment) -> Vec<[f64; 3]> {
    let (width, height) = (sky.width(), sky.height());
    let mut sums = vec![[0.0; 3]; ORDER * ORDER];
    for (i, texel) in sky.texels().iter().enumerate() {
        let elevation = FRAC_PI_2 - PI * ((i / width) as f64 + 0.5) / height as f64;
        let azimuth = PI - TAU * ((i % width) as f64 + 0.5) / width as f64 + sky.rotation_rad();
        let ((sin, cos), (up, level)) = (azimuth.sin_cos(), elevation.sin_cos());
        let weight = level * PI / height as f64 * TAU / width as f64;
        let y = evaluate(ORDER, DVec3::new(level * cos, level * sin, up));
        for (sum, y) in sums.iter_mut().zip(y) {
            for (s, t) in sum.iter_mut().zip(texel) {
                *s += weight * y * f64::from(*t);
            }
        }
    }
    sums
}

/// Six pictures, two rows, greys as they are, not as light: the horizon towards the west (white 45°), visible sky, sky view; the bent normal (red east,
/// green north, blue up), what of the light from 20° above the south is seen as visibility keeps it, and ground under
/// the bundled sky by transfer.
fn picture(all: &[Baked], sky: &Environment) -> Vec<[f32; 3]> {
    let planes = |kind: &str| &all.iter().find(|b| b.kind == kind).expect("baked").planes;
    let grey = |plane: &[f32], scale: f32| {
        plane.iter().map(|v| [(v * scale).max(0.0).powf(2.2); 3]).collect::<Vec<_>>()
    };
    let west = &planes("horizon")[AZIMUTHS as usize / 2];
    let bent = planes("bent-normal");
    let normals: Vec<[f32; 3]> = (0..SIDE * SIDE)
        .map(|i| [0, 1, 2].map(|k| 0.5 + 0.5 * bent[k][i]).map(|v: f32| v.powf(2.2)))
        .collect();
    let towards = {
        let (up, level) = 20_f64.to_radians().sin_cos();
        evaluate(ORDER, DVec3::new(0.0, -level, up))
    };
    let visible = planes("sh-visibility");
    let seen: Vec<f32> = (0..SIDE * SIDE)
        .map(|i| visible.iter().zip(&towards).map(|(v, y)| v[i] * *y as f32).sum())
        .collect();
    let (transfer, light) = (planes("sh-transfer"), series(sky));
    let lit: Vec<[f32; 3]> = (0..SIDE * SIDE)
        .map(|i| {
            [0, 1, 2]
                .map(|c| transfer.iter().zip(&light).map(|(t, l)| t[i] * l[c] as f32).sum::<f32>())
        })
        .collect();
    let mean = lit.as_flattened().iter().sum::<f32>() / (3 * lit.len()) as f32;
    let lit: Vec<[f32; 3]> = lit.iter().map(|t| t.map(|v| 0.35 * v / mean)).collect();
    let panels = [
        grey(west, 1.0 / std::f32::consts::FRAC_PI_4),
        grey(&planes("visible-sky")[0], 1.0),
        grey(&planes("sky-view")[0], 1.0),
        normals,
        grey(&seen, 1.0),
        lit,
    ];
    let width = 3 * SIDE + 2 * GAP;
    let mut out = Vec::new();
    for (number, row) in panels.chunks(3).enumerate() {
        if number > 0 {
            out.extend(vec![[1.0; 3]; GAP * width]);
        }
        for y in 0..SIDE {
            for (i, panel) in row.iter().enumerate() {
                if i > 0 {
                    out.extend([[1.0; 3]; GAP]);
                }
                out.extend_from_slice(&panel[y * SIDE..(y + 1) * SIDE]);
            }
        }
    }
    out
}

fn run(picture_path: &Path, json_path: &Path) -> Result<()> {
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let field = mountain::middle(SIDE, STEEPER)?;
    let horizons = horizons(&mut gpu, &field)?;
    let mut all = all(&field, horizons);
    all.extend(looked::looked(&mut gpu, &field)?);
    all.extend(looked::lit(&mut gpu, mountain::middle(LIT_SIDE, STEEPER)?)?);
    let rows: Vec<Value> = all.iter().flat_map(rows).collect();
    let name = &gpu.report().name;
    println!(
        "{name}: {SIDE}² samples, {AZIMUTHS} azimuths, exact in each; kinds of light {LIT_SIDE}² samples that repeat\n"
    );
    println!("| kind | encoding | bytes | of | at most | worst here | share of what is promised |");
    println!("|---|---|---|---|---|---|---|");
    for row in &rows {
        for bound in row["bounds"].as_array().expect("bounds") {
            println!(
                "| {} | {} | {} | {} | {:.2e} | {:.2e} | {:.3} |",
                row["kind"].as_str().unwrap_or_default(),
                row["encoding"].as_str().unwrap_or_default(),
                row["bytes"],
                bound["of"].as_str().unwrap_or_default(),
                bound["at_most"].as_f64().unwrap_or_default(),
                bound["worst"].as_f64().unwrap_or_default(),
                bound["share"].as_f64().unwrap_or_default()
            );
        }
    }
    let report = gpu.report();
    let figures = json!({
        "device": report.name, "driver": report.driver, "side": SIDE, "steeper": STEEPER, "azimuths": AZIMUTHS, "lit_side": LIT_SIDE,
        "rows": rows,
    });
    files::write_json(json_path, &figures)?;
    let texels = picture(&all, &mountain::sky()?);
    let size = [2 * SIDE + GAP, 3 * SIDE + 2 * GAP];
    files::write_png(picture_path, size[0], size[1], &texels, None, Tone::default(), &[])
}

fn main() -> std::process::ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = args.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["-o", picture, "--json", json] => run(Path::new(picture), Path::new(json)),
        _ => Err(Error::setting("words", args.join(" "), "-o PICTURE.png --json FIGURES.json")),
    };
    match done {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            std::process::ExitCode::FAILURE
        }
    }
}
