//! The picture of docs/baking.md, maps of the bundled mountain, three times as steep; and the stated
//! error of each encoding with the worst measured error.

pub mod light;

#[expect(dead_code, reason = "its main, which writes a map")]
#[path = "../../../../examples/bake.rs"]
mod example;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use example::{AZIMUTHS, baked, horizons};
use glam::DVec3;
use ridgelight::Result;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::scene::{Environment, HeightField, Tone};
use ridgelight_bake as bake;
use ridgelight_bake::{
    BentNormal, Encoding, HorizonMap, ShTransfer, ShVisibility, SkyView, VisibleSky,
};
use ridgelight_io as files;
use serde_json::{Value, json};

use crate::common::args::Args;
use crate::common::plot::{self, Texels};
use crate::common::{Outcome, head, inputs};

const SIDE: usize = 256;
const STEEPER: f64 = 3.0;
const ORDER: usize = 4;
/// Of fields for maps of light.
const LIT_SIDE: usize = 64;

/// A map, its channels, and its planes.
pub struct Baked {
    kind: &'static str,
    channels: String,
    /// The unit of the number of bytes.
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

fn all(field: &HeightField, horizons: Vec<Vec<f32>>) -> Result<Vec<Baked>> {
    let coefficients = format!("{} of order {ORDER}", ORDER * ORDER);
    let series = &bake::COEFFICIENTS;
    type Map<'a> = (&'static str, &'a str, &'static [Encoding], Box<dyn HorizonMap>);
    let maps: [Map; 5] = [
        ("sky-view", "1", &bake::SHARE, Box::new(SkyView)),
        ("visible-sky", "1", &bake::SHARE, Box::new(VisibleSky)),
        ("bent-normal", "direction, cone", &bake::BENT_NORMAL, Box::new(BentNormal)),
        ("sh-visibility", &coefficients, series, Box::new(ShVisibility::new(ORDER))),
        ("sh-transfer", &coefficients, series, Box::new(ShTransfer::new(ORDER))),
    ];
    let mut all = Vec::new();
    for (kind, channels, encodings, map) in maps {
        let planes = baked(field, &horizons, map)?;
        all.push(Baked::of(kind, channels, "a texel", encodings, planes));
    }
    all.insert(0, Baked::of("horizon", "1", "an azimuth", &bake::HORIZON, horizons));
    Ok(all)
}

/// A row for each encoding: its bounds, and the worst errors found.
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
        let bounds = encoding.bounds.iter().zip(worst).map(|(bound, (error, share))| {
            json!({
                "of": bound.of, "unit": bound.unit, "at_most": bound.absolute(component),
                "and_of_the_value": bound.relative(component), "worst": error, "share": share,
            })
        });
        // Three components have a fourth beside them.
        let components = encoding.components.next_power_of_two();
        let texels = match baked.each {
            "a texel" => baked.planes.len().div_ceil(encoding.values),
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

/// The environment as SH.
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
            (0..3).for_each(|c| sum[c] += weight * y * f64::from(texel[c]));
        }
    }
    sums
}

/// Six pictures; greys are values, not light: the horizon towards the west (white 45°), visible sky, sky
/// view; the bent normal (red east, green north, blue up), the visibility of light from 20° above the
/// south by SH, and the field under the bundled sky by transfer.
fn picture(all: &[Baked], sky: &Environment) -> Vec<Texels> {
    let planes = |kind: &str| &all.iter().find(|b| b.kind == kind).expect("baked").planes;
    let of =
        |texel: &dyn Fn(usize) -> [f32; 3]| -> Texels { (0..SIDE * SIDE).map(texel).collect() };
    let grey = |plane: &[f32], scale: f32| of(&|i| [(plane[i] * scale).max(0.0).powf(2.2); 3]);
    let (bent, visible, transfer) =
        (planes("bent-normal"), planes("sh-visibility"), planes("sh-transfer"));
    let (up, level) = 20_f64.to_radians().sin_cos();
    let towards = evaluate(ORDER, DVec3::new(0.0, -level, up));
    let visibility = |i: usize| visible.iter().zip(&towards).map(|(v, y)| v[i] * *y as f32).sum();
    let visibility: Vec<f32> = (0..SIDE * SIDE).map(visibility).collect();
    let light = series(sky);
    let lit = of(&|i| {
        [0, 1, 2].map(|c| transfer.iter().zip(&light).map(|(t, l)| t[i] * l[c] as f32).sum())
    });
    let mean = lit.as_flattened().iter().sum::<f32>() / (3 * lit.len()) as f32;
    vec![
        grey(&planes("horizon")[AZIMUTHS as usize / 2], 1.0 / std::f32::consts::FRAC_PI_4),
        grey(&planes("visible-sky")[0], 1.0),
        grey(&planes("sky-view")[0], 1.0),
        of(&|i| [0, 1, 2].map(|k| (0.5 + 0.5 * bent[k][i]).powf(2.2))),
        grey(&visibility, 1.0),
        lit.iter().map(|t| t.map(|v| 0.35 * v / mean)).collect(),
    ]
}

pub fn run(mut args: Args) -> Outcome {
    let (output, json) = (args.needed("-o")?, args.needed("--json")?);
    let mut gpu = args.open()?;
    let field = inputs::middle(&inputs::mountain(STEEPER)?, SIDE)?;
    let horizons = horizons(&mut gpu, &field)?;
    let mut all = all(&field, horizons)?;
    all.extend(light::of_directions(&mut gpu, &field)?);
    all.extend(light::lit(&mut gpu, inputs::middle(&field, LIT_SIDE)?)?);
    let rows: Vec<Value> = all.iter().flat_map(rows).collect();
    println!(
        "{}: {SIDE}² grid points, {AZIMUTHS} azimuths, exact in each; maps of light {LIT_SIDE}² grid points that repeat\n",
        gpu.report().name
    );
    head("| kind | encoding | bytes | of | at most | worst here | share of the bound |");
    for row in &rows {
        for bound in row["bounds"].as_array().into_iter().flatten() {
            let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
            let number = |key: &str| bound[key].as_f64().unwrap_or_default();
            println!(
                "| {} | {} | {} | {} | {:.2e} | {:.2e} | {:.3} |",
                word(&row["kind"]),
                word(&row["encoding"]),
                row["bytes"],
                word(&bound["of"]),
                number("at_most"),
                number("worst"),
                number("share")
            );
        }
    }
    let report = gpu.report();
    let figures = json!({
        "device": report.name, "driver": report.driver, "side": SIDE, "steeper": STEEPER, "azimuths": AZIMUTHS,
        "lit_side": LIT_SIDE, "rows": rows,
    });
    files::write_json(&json, &figures)?;
    let pictures = picture(&all, &inputs::sky_without_sun()?);
    let rows: Vec<_> = pictures.chunks(3).map(<[Texels]>::to_vec).collect();
    Ok(plot::png(&output, &rows, SIDE, 1, Tone::default().exposure)?)
}
