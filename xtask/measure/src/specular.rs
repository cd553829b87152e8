//! Errors of Phong specular by SH against the path tracer: of direct light by exponent, receiver and order; and of
//! indirect light by direction and as seen from above (NS09, figure 5).
//!
//! Both light the middle SIDE² (64) grid points of the bundled mountain by the bundled sky without its sun.
//! `gloss`: three times as steep, two bounces, first specular alone, whose indirect light is the layer `glossy` and
//! nothing else, then beside diffuse ground. N (1024) paths per grid point are the ground truth; RMSE contains their
//! noise, which is stated beside, at most, as paths without bounces begin alike. The picture: indirect light of
//! specular alone, a row for each exponent: path-traced, then radiance by direction of order 4, as seen from above,
//! and by direction of order 6.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{Picture, REFERENCE_BATCH};
use ridgelight::scene::{
    Albedo, Basis, Border, BounceEngine, BounceSpecular, Bounces, Environment, HeightField,
    PhongSpecular, Quality, Receiver, Scene, Specular,
};

use crate::common::args::Args;
use crate::common::frames::{
    Colours, add, bytes, colours, device, error, mean, minus, open, total, traced, with_picture,
};
use crate::common::{Outcome, head, inputs, panels};

const EXPONENTS: [f32; 4] = [1.0, 5.0, 20.0, 80.0];
const BOUNCES: u32 = 2;
/// What is kept, and the order; the first three are in the picture.
const FORMS: [(BounceSpecular, u32); 6] = [
    (BounceSpecular::Vector, 4),
    (BounceSpecular::Scalar, 4),
    (BounceSpecular::Vector, 6),
    (BounceSpecular::VectorF16, 4),
    (BounceSpecular::Vector, 2),
    (BounceSpecular::Scalar, 6),
];
const IN_PICTURE: usize = 3;
const LOBE_BATCHES: u32 = 48;

fn scene(
    field: &HeightField,
    sky: &Environment,
    albedo: f32,
    (exponent, scale): (f32, f32),
) -> Scene {
    let mut scene = inputs::under(field.clone(), sky.clone());
    scene.surface.albedo = Albedo::Constant([albedo; 3]);
    scene.surface.border = Border::Plane;
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent, scale }));
    scene
}

fn ground(args: &mut Args, steeper: f64) -> Result<(HeightField, Environment)> {
    let side = args.word().and_then(|text| text.parse().ok()).unwrap_or(64);
    Ok((inputs::middle(&inputs::mountain(steeper)?, side)?, inputs::sky_without_sun()?))
}

pub fn lobe(mut args: Args) -> Outcome {
    let (field, sky) = ground(&mut args, 1.0)?;
    args.end()?;
    let mut gpu = open()?;
    println!(
        "Middle {}² of mt_washington_256 under sky_512x256, cut at 20 times its mean; Phong specular alone, {} paths \
         per grid point; {}\n",
        field.cols(),
        LOBE_BATCHES * REFERENCE_BATCH,
        device(&gpu)
    );
    head(
        "| exponent | receiver | order | RMSE % | ± | paths' noise % | mean shift % | set to 0 % |",
    );
    for exponent in [1.0, 5.0, 20.0] {
        let scene = scene(&field, &sky, 0.0, (exponent, 1.0));
        let truth = traced(&mut gpu, &scene, 0, LOBE_BATCHES)?;
        for receiver in [Receiver::Plane, Receiver::Cosine] {
            for sh_order in 2..=6 {
                let quality =
                    Quality { basis: Basis::Sh, receiver, sh_order, ..Quality::default() };
                let wanted = Picture::default();
                let (light, negative) =
                    with_picture(&mut gpu, &scene, &quality, wanted, |gpu, frame| {
                        gpu.draw(frame)?;
                        let negative = gpu.negative_share(frame)?.unwrap_or(0.0);
                        Ok((colours(&gpu.pixels(frame, 0)?), negative))
                    })?;
                let [rmse, spread, noise, shift] = without_noise(&light, &truth).map(|v| 100.0 * v);
                println!(
                    "| {exponent} | {} | {sh_order} | {rmse:.2} | {spread:.4} | {noise:.3} | {shift:+.2} | {:.2} |",
                    receiver.name(),
                    100.0 * negative
                );
            }
        }
    }
    Ok(())
}

/// RMSE with the paths' noise taken off, its standard error, that noise, and the shift of the mean, as shares of the
/// mean. A square d² of a difference with noise σ has a standard deviation of √(4 d²σ² + 2 σ⁴).
fn without_noise(light: &Colours, [truth, error]: &[Colours; 2]) -> [f64; 4] {
    let (mut shift, mut squares, mut noises, mut spread) = (0.0, 0.0, 0.0, 0.0);
    let values = light.as_flattened().iter().zip(truth.as_flattened()).zip(error.as_flattened());
    for ((got, want), sigma) in values {
        let [square, noise] = [got - want, *sigma].map(|v| v * v);
        shift += got - want;
        squares += square - noise;
        noises += noise;
        spread += 4.0 * square * noise + 2.0 * noise * noise;
    }
    let count = (3 * light.len()) as f64;
    let rmse = (squares.max(0.0_f64) / count).sqrt();
    let of_rmse = spread.sqrt() / count / (2.0 * rmse).max(f64::MIN_POSITIVE);
    [rmse, of_rmse, f64::sqrt(noises / count), shift / count].map(|v| v / mean(truth))
}

/// The whole light, the indirect light, and the shorter of two draws after the first.
fn with_bounces(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
) -> Result<(Colours, Colours, f64, u64)> {
    let wanted = Picture { light_layers: true, ..Picture::default() };
    with_picture(gpu, scene, quality, wanted, |gpu, frame| {
        gpu.draw(frame)?;
        let ms = total(&gpu.draw(frame)?).min(total(&gpu.draw(frame)?));
        let whole = colours(&gpu.pixels(frame, 0)?);
        let names: Vec<String> = frame.plan().outputs().map(|(_, r)| r.name.clone()).collect();
        let mut bounced = vec![[0.0; 3]; whole.len()];
        for (i, name) in names.iter().enumerate() {
            if name == "glossy" || name.starts_with("indirect.") {
                add(&mut bounced, 1.0, &colours(&gpu.pixels(frame, i)?));
            }
        }
        let kept = ["exit_vectors", "vector_levels", "exit_seen", "shade_levels", "shade_stack"];
        Ok((whole, bounced, ms, bytes(frame.plan(), &kept)))
    })
}

pub fn gloss(mut args: Args) -> Outcome {
    let (output, paths) = (args.path("-o")?, args.number("--spp", 1024_u32)?);
    let (field, sky) = ground(&mut args, 3.0)?;
    args.end()?;
    let mut gpu = open()?;
    println!(
        "Middle {}² of mt_washington_256, three times as steep, under sky_512x256 cut at 20 times its mean; {BOUNCES} \
         bounces, {paths} paths per grid point; relative RMSE; {}\n",
        field.cols(),
        device(&gpu)
    );
    head(
        "| diffuse | specular | exponent | kept | order | bounced % | noise % | whole % | ms | kept MB |",
    );
    let batches = paths.div_ceil(REFERENCE_BATCH).max(2);
    let mut picture = Vec::new();
    for (albedo, scale) in [(0.0_f32, 0.9_f32), (0.4, 0.5)] {
        for exponent in EXPONENTS {
            let scene = scene(&field, &sky, albedo, (exponent, scale));
            let [[direct, direct_error], [all, all_error]] = [
                traced(&mut gpu, &scene, 0, batches)?,
                traced(&mut gpu, &scene, BOUNCES, batches)?,
            ];
            let right = minus(&all, &direct);
            let variance = |error: &Colours| {
                let squares: f64 = error.as_flattened().iter().map(|e| e * e).sum();
                squares / (3 * error.len()) as f64
            };
            let noise = (variance(&all_error) + variance(&direct_error)).sqrt();
            let noise = 100.0 * noise / mean(&right);
            let mut row = vec![right.clone()];
            for (specular, sh_order) in FORMS {
                let engine = BounceEngine::Pyramid;
                let bounces =
                    Bounces { count: BOUNCES, engine, cutoff: 0.0, specular, ..Bounces::default() };
                let quality = Quality { basis: Basis::Sh, sh_order, bounces, ..Quality::default() };
                let (whole, bounced, ms, kept) = with_bounces(&mut gpu, &scene, &quality)?;
                println!(
                    "| {albedo} | {scale} | {exponent} | {} | {sh_order} | {:.1} | {noise:.1} | {:.2} | {ms:.1} | {:.2} |",
                    specular.name(),
                    error(&bounced, &right)?,
                    error(&whole, &all)?,
                    kept as f64 / 1e6,
                );
                row.push(bounced);
            }
            // The mean is a fifth of white.
            let white = 5.0 * mean(&right);
            let panel =
                |light: &Colours| light.iter().map(|t| t.map(|v| (v / white) as f32)).collect();
            picture.push(row[..=IN_PICTURE].iter().map(panel).collect::<Vec<_>>());
        }
    }
    picture.truncate(EXPONENTS.len());
    match output {
        Some(path) => Ok(panels::write(&path, &picture, field.cols(), 2, 1.0)?),
        None => Ok(()),
    }
}
