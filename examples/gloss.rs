//! Light that lobes throw from slope to slope: by direction and as seen from above, beside light paths (Nowrouzezahrai &
//! Snyder 2009, figure 5).
//!
//! `cargo run --release --example gloss -- [SIDE] [--spp N] [-o PICTURE.png]` lights the middle SIDE² (64) samples of the
//! bundled mountain, three times as steep, by the bundled sky without its sun, with two bounces. First lobes alone, whose
//! bounced light is the layer `glossy` and nothing else; then lobes beside diffuse ground. N (1024) light paths a
//! sample are the truth; RMSE holds their noise, which
//! is told beside, at most, as paths without bounces begin alike. The picture: bounced light of lobes alone, a row for each exponent:
//! paths, then radiance by direction of order 4, as seen from above, and by direction of order 6.

#[path = "shared/mountain.rs"]
mod mountain;
#[path = "shared/traced.rs"]
mod traced;

use std::path::{Path, PathBuf};

use mountain::{middle, side_of, sky};
use ridgelight::gpu::{Headless, HeadlessOptions, Pixels};
use ridgelight::plan::{self, Picture, Plan, REFERENCE_BATCH, Resource};
use ridgelight::scene::Tone;
use ridgelight::scene::{
    Albedo, Basis, Border, BounceEngine, BounceSpecular, Bounces, Lights, PhongSpecular, Quality,
    Scene, Specular, Surface,
};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use traced::traced;

const EXPONENTS: [f32; 4] = [1.0, 5.0, 20.0, 80.0];
const BOUNCES: u32 = 2;
/// What is kept, and the order; the first three are drawn.
const FORMS: [(BounceSpecular, u32); 6] = [
    (BounceSpecular::Vector, 4),
    (BounceSpecular::Scalar, 4),
    (BounceSpecular::Vector, 6),
    (BounceSpecular::VectorF16, 4),
    (BounceSpecular::Vector, 2),
    (BounceSpecular::Scalar, 6),
];
const DRAWN: usize = 3;
/// Pixels a sample, and white ones between pictures.
const ZOOM: usize = 2;
const GAP: usize = 4;

/// Linear RGB of all samples.
type Colours = Vec<[f64; 3]>;

struct Request {
    side: usize,
    paths: u32,
    output: Option<PathBuf>,
}

fn asked() -> Result<Request> {
    let mut asked = Request { side: 64, paths: 1024, output: None };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--spp" => {
                let text = args.next().unwrap_or_default();
                let paths = text.parse().ok().filter(|paths| *paths > 0);
                asked.paths = paths
                    .ok_or_else(|| Error::setting("--spp", text, "a whole number, 1 or more"))?;
            }
            "-o" => asked.output = Some(args.next().unwrap_or_default().into()),
            _ => asked.side = side_of(Some(arg), 0)?,
        }
    }
    Ok(asked)
}

fn colours(values: &[f32], channels: usize) -> Colours {
    let channel = |t: &[f32], c: usize| f64::from(t[c.min(t.len() - 1)]);
    values.chunks_exact(channels).map(|t| [0, 1, 2].map(|c| channel(t, c))).collect()
}

/// A sum, or a difference.
fn with(a: &Colours, b: &Colours, sign: f64) -> Colours {
    a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|c| a[c] + sign * b[c])).collect()
}

struct Drawn {
    whole: Colours,
    bounced: Colours,
    ms: f64,
    /// What is kept of the light that is thrown on, bytes.
    kept: u64,
}

/// Drawn three times: the first draw warms up; the shorter of the others.
fn drawn(
    gpu: &mut Headless,
    scene: &Scene,
    (gloss, sh_order): (BounceSpecular, u32),
) -> Result<Drawn> {
    let bounces = Bounces {
        count: BOUNCES,
        engine: BounceEngine::Pyramid,
        cutoff: 0.0,
        specular: gloss,
        ..Bounces::default()
    };
    let quality = Quality { basis: Basis::Sh, sh_order, bounces, ..Quality::default() };
    let wanted = Picture { light_layers: true, ..Picture::default() };
    let plan = plan::picture(scene, &quality, &gpu.report().limits, wanted)?;
    let kept = kept_bytes(&plan);
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let names: Vec<String> = plan.outputs().map(|(_, r)| r.name.clone()).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let mut ms = f64::INFINITY;
        for _ in 0..2 {
            ms = ms.min(gpu.draw(frame)?.iter().map(|t| t.ns).sum::<f64>() / 1e6);
        }
        let of = |pixels: &Pixels| colours(&pixels.values, pixels.channels);
        let whole = of(&gpu.pixels(frame, 0)?);
        let mut bounced = vec![[0.0; 3]; whole.len()];
        for (i, name) in names.iter().enumerate() {
            if name == "indirect.specular" || name.starts_with("indirect.") {
                bounced = with(&bounced, &of(&gpu.pixels(frame, i)?), 1.0);
            }
        }
        Ok(Drawn { whole, bounced, ms, kept })
    })
}

fn kept_bytes(plan: &Plan) -> u64 {
    const KEPT: [&str; 5] =
        ["exit_vectors", "vector_levels", "exit_upward", "shade_levels", "shade_stack"];
    let all = plan.resources.iter().filter(|r| KEPT.contains(&r.name.as_str()));
    all.map(Resource::bytes).sum()
}

/// What paths say: light, and the variance of what is bounced, at most.
struct Truth {
    whole: Colours,
    bounced: Colours,
    noise: f64,
}

fn truth(gpu: &mut Headless, scene: &Scene, paths: u32) -> Result<Truth> {
    let batches = paths.div_ceil(REFERENCE_BATCH).max(2);
    let mut of = |bounces: u32| -> Result<(Colours, f64)> {
        let [light, error] = traced(gpu, scene, bounces, batches)?.map(|v| colours(&v, 4));
        let squares = error.as_flattened().iter().map(|e| e * e).sum::<f64>();
        Ok((light, squares / (3 * error.len()) as f64))
    };
    let ((direct, direct_noise), (whole, whole_noise)) = (of(0)?, of(BOUNCES)?);
    let bounced = with(&whole, &direct, -1.0);
    Ok(Truth { whole, bounced, noise: whole_noise + direct_noise })
}

fn mean(light: &Colours) -> f64 {
    light.as_flattened().iter().sum::<f64>() / (3 * light.len()) as f64
}

/// RMSE over the mean of what is right, %.
fn off(found: &Colours, right: &Colours) -> f64 {
    let squares = with(found, right, -1.0).as_flattened().iter().map(|v| v * v).sum::<f64>();
    100.0 * (squares / (3 * right.len()) as f64).sqrt() / mean(right)
}

fn run() -> Result<()> {
    let asked = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let (field, sky) = (middle(asked.side, 3.0)?, sky()?);
    println!(
        "Middle {0}² of mt_washington_256, three times as steep, under sky_512x256 cut at 20 times its mean; {BOUNCES} \
         bounces, {1} light paths a sample; RMSE over the mean; {2}, {3}\n",
        asked.side,
        asked.paths,
        gpu.report().name,
        gpu.report().driver
    );
    println!(
        "| diffuse | lobe | exponent | kept | order | bounced % | noise % | whole % | ms | kept MB |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    let mut sheet = Vec::new();
    for (albedo, scale) in [(0.0_f32, 0.9_f32), (0.4, 0.5)] {
        for exponent in EXPONENTS {
            let scene = Scene {
                field: field.clone(),
                surface: Surface {
                    albedo: Albedo::Constant([albedo; 3]),
                    border: Border::Plane,
                    specular: Some(Specular::Constant(PhongSpecular { exponent, scale })),
                },
                lights: Lights { environment: Some(sky.clone()), ..Lights::default() },
            };
            let right = truth(&mut gpu, &scene, asked.paths)?;
            let noise = 100.0 * right.noise.sqrt() / mean(&right.bounced);
            let mut row = vec![right.bounced.clone()];
            for (gloss, order) in FORMS {
                let got = drawn(&mut gpu, &scene, (gloss, order))?;
                println!(
                    "| {albedo} | {scale} | {exponent} | {} | {order} | {:.1} | {noise:.1} | {:.2} | {:.1} | {:.2} |",
                    gloss.name(),
                    off(&got.bounced, &right.bounced),
                    off(&got.whole, &right.whole),
                    got.ms,
                    got.kept as f64 / 1e6,
                );
                row.push(got.bounced);
            }
            row.truncate(1 + DRAWN);
            sheet.push(row);
        }
    }
    sheet.truncate(EXPONENTS.len());
    asked.output.map_or(Ok(()), |path| write(&path, &sheet, asked.side))
}

/// Rows of pictures as bright as each other's truth.
fn write(path: &Path, sheet: &[Vec<Colours>], side: usize) -> Result<()> {
    let cell = ZOOM * side + GAP;
    let [width, height] = [(1 + DRAWN) * cell - GAP, sheet.len() * cell - GAP];
    let mut texels = vec![[1.0_f32; 3]; width * height];
    for (y, row) in sheet.iter().enumerate() {
        // The mean is a fifth of white.
        let scale = 0.2 / mean(&row[0]);
        for (x, light) in row.iter().enumerate() {
            for k in 0..(cell - GAP) * (cell - GAP) {
                let [down, across] = [k / (cell - GAP), k % (cell - GAP)];
                let light = light[down / ZOOM * side + across / ZOOM];
                let at = (y * cell + down) * width + x * cell + across;
                texels[at] = light.map(|v| (scale * v) as f32);
            }
        }
    }
    files::write_png(path, height, width, &texels, None, Tone { exposure: 1.0 }, &[])
}

fn main() -> std::process::ExitCode {
    match run() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            std::process::ExitCode::FAILURE
        }
    }
}
