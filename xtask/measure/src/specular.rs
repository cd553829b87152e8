//! Errors of Phong specular against the path tracer. Direct light by exponent, with slices of the lobe and
//! with SH by receiver and order; then of a specular map and of suns. Indirect light by direction, and as
//! viewed from straight above (NS09, figure 5).
//!
//! Both light the middle SIDE² (64) grid points of the bundled mountain by the bundled sky without its
//! sun. Indirect: three times as steep, two bounces; first specular alone, then with diffuse ground. N
//! (8192) paths per grid point are the reference; the RMSE contains their noise. The stated noise is
//! an upper bound, because paths with and without bounces begin alike. The picture: indirect light of
//! specular alone, a row for each exponent: path-traced, by pyramids of order 4 and by brute force of order 6, scalar.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::REFERENCE_BATCH;
use ridgelight::scene::{
    Basis, Border, BounceEngine, BounceSpecular, Bounces, Environment, HeightField, Lights, Method,
    PhongSpecular, Quality, Receiver, Scene, Specular, Sun,
};

use crate::common::args::Args;
use crate::common::frames::{
    Colours, device, drawn, drawn_in_layers, error, frame, mean, minus, new_heights_in_turn,
    rms_of, to_f32, traced,
};
use crate::common::{Outcome, head, inputs, median, plot};

const EXPONENTS: [f32; 4] = [1.0, 5.0, 20.0, 80.0];
/// Of direct light.
const DIRECT_EXPONENTS: [f32; 5] = [1.0, 5.0, 20.0, 100.0, 1000.0];
const BOUNCES: u32 = 2;
/// The engine, what is kept, and the order; the first three are in the picture.
const FORMS: [(BounceEngine, BounceSpecular, u32); 8] = [
    (BounceEngine::Pyramid, BounceSpecular::Vector, 4),
    (BounceEngine::BruteForce, BounceSpecular::Vector, 6),
    (BounceEngine::Pyramid, BounceSpecular::Scalar, 4),
    (BounceEngine::BruteForce, BounceSpecular::Vector, 4),
    (BounceEngine::Pyramid, BounceSpecular::Vector, 6),
    (BounceEngine::Pyramid, BounceSpecular::VectorF16, 4),
    (BounceEngine::Pyramid, BounceSpecular::Vector, 2),
    (BounceEngine::Pyramid, BounceSpecular::Scalar, 6),
];
const IN_PICTURE: usize = 3;
const DIRECT_BATCHES: u32 = 48;
/// Pairs of frames.
const RUNS: usize = 15;

fn scene(
    (field, sky): &(HeightField, Environment),
    albedo: f32,
    (exponent, scale): (f32, f32),
) -> Scene {
    let specular = Some(Specular::Constant(PhongSpecular { exponent, scale }));
    let mut scene = inputs::under(field.clone(), sky.clone());
    scene.surface = inputs::matte([albedo; 3], Border::Plane);
    scene.surface.specular = specular;
    scene
}

fn ground(args: &mut Args, steeper: f64) -> Result<(HeightField, Environment)> {
    let side = args.word().and_then(|text| text.parse().ok()).unwrap_or(64);
    Ok((inputs::middle(&inputs::mountain(steeper)?, side)?, inputs::sky_without_sun()?))
}

pub fn direct(mut args: Args) -> Outcome {
    let ground = ground(&mut args, 1.0)?;
    let mut gpu = args.open()?;
    println!(
        "Middle {}² of mt_washington_256 under sky_512x256, cut at 20 times its mean; Phong specular alone, {} paths \
         per grid point; RMSE without their noise; {}\n",
        ground.0.cols(),
        DIRECT_BATCHES * REFERENCE_BATCH,
        device(&gpu)
    );
    head("| exponent | azimuths | receiver | order | RMSE % | paths' noise % |");
    for exponent in DIRECT_EXPONENTS {
        let scene = scene(&ground, 0.0, (exponent, 1.0));
        let [reference, deviation] = traced(&mut gpu, &scene, 0, DIRECT_BATCHES)?;
        let noise = 100.0 * rms_of(&deviation) / mean(&reference);
        let rmse = |gpu: &mut Headless, quality: &Quality| -> Result<f64> {
            let light = drawn(gpu, &scene, quality, 0)?.light;
            let error = error(&light, &reference)?;
            Ok((error * error - noise * noise).max(0.0).sqrt())
        };
        for azimuths in [32, 64, 128] {
            let slices = Quality { azimuths, ..Quality::default() };
            let rmse = rmse(&mut gpu, &slices)?;
            println!("| {exponent} | {azimuths} | slices | | {rmse:.2} | {noise:.3} |");
        }
        // Harmonics hold no sharper lobe.
        if exponent > 20.0 {
            continue;
        }
        for receiver in [Receiver::Plane, Receiver::Cosine] {
            for sh_order in 2..=6 {
                let quality =
                    Quality { basis: Basis::Sh, receiver, sh_order, ..Quality::default() };
                let rmse = rmse(&mut gpu, &quality)?;
                println!("| {exponent} | 64 | {receiver} | {sh_order} | {rmse:.2} | {noise:.3} |");
            }
        }
    }
    map(&mut gpu, &ground)?;
    suns(&mut gpu, &ground)
}

/// Specular of this scale whose grid points take the exponents in turn.
fn map_of(exponents: &[f32], grid_points: usize, scale: f32) -> Specular {
    let all = exponents.iter().cycle().take(grid_points);
    Specular::Map(all.map(|&exponent| PhongSpecular { exponent, scale }).collect())
}

/// For each exponent of the map: the error over the grid points with that exponent, relative to their mean.
fn map(gpu: &mut Headless, ground: &(HeightField, Environment)) -> Outcome {
    println!("\nA specular map of all of these exponents:\n");
    head("| exponent | azimuths | basis | RMSE % | paths' noise % |");
    let mut scene = scene(ground, 0.0, (0.0, 1.0));
    let map = map_of(&DIRECT_EXPONENTS, ground.0.heights_m().len(), 1.0);
    scene.surface.specular = Some(map.clone());
    let [reference, deviation] = traced(gpu, &scene, 0, DIRECT_BATCHES)?;
    for basis in [Basis::Table, Basis::Sh] {
        let quality = Quality { basis, ..Quality::default() };
        let light = drawn(gpu, &scene, &quality, 0)?.light;
        for exponent in DIRECT_EXPONENTS {
            let of = |light: &Colours| -> Colours {
                let all = light.iter().enumerate();
                all.filter(|(i, _)| map.at(*i).exponent == exponent).map(|(_, c)| *c).collect()
            };
            let [reference, deviation, light] = [&reference, &deviation, &light].map(of);
            let noise = 100.0 * rms_of(&deviation) / mean(&reference);
            let error = error(&light, &reference)?;
            let rmse = (error * error - noise * noise).max(0.0).sqrt();
            let azimuths = quality.azimuths;
            println!("| {exponent} | {azimuths} | {basis} | {rmse:.2} | {noise:.3} |");
        }
    }
    Ok(())
}

/// Times of frames by light and exponent, with the default settings.
pub fn times(args: Args) -> Outcome {
    let mut gpu = args.open()?;
    let ground = (inputs::mountain(1.0)?, inputs::sky_without_sun()?);
    println!(
        "Frames of new heights of mt_washington_256 under a sky, sky_512x256 cut at 20 times its mean, and a sun 0.53 degrees \
         wide, 40 high, each alone: diffuse with albedo 0.5, and the same with specular of scale 0.4; in turn, medians of \
         {RUNS}; {}\n",
        device(&gpu)
    );
    head("| light | exponent | diffuse ms | with specular ms | ratio |");
    let sun = inputs::sun(-160.0, 40.0, [3.0; 3]);
    let lights = [
        ("sky", Lights { sky: Some([1.0; 3]), ..Lights::default() }),
        ("environment", scene(&ground, 0.5, (1.0, 0.4)).lights),
        ("sun", Lights { suns: vec![sun], ..Lights::default() }),
    ];
    for (name, lights) in lights {
        let all = [1.0, 5.0, 20.0, 100.0, 1000.0, 10_000.0];
        let map = map_of(&all[..5], ground.0.heights_m().len(), 0.4);
        let one = |exponent| Specular::Constant(PhongSpecular { exponent, scale: 0.4 });
        let constant = all.map(|exponent| (exponent.to_string(), one(exponent)));
        for (exponent, specular) in constant.into_iter().chain([("map, 1 to 1000".into(), map)]) {
            let mut scene = scene(&ground, 0.5, (0.0, 0.4));
            scene.surface.specular = Some(specular);
            scene.lights = lights.clone();
            let mut diffuse = scene.clone();
            diffuse.surface.specular = None;
            let quality = Quality::default();
            let mut both =
                [frame(&mut gpu, &diffuse, &quality)?, frame(&mut gpu, &scene, &quality)?];
            let times = new_heights_in_turn(&gpu, &mut both, &[RUNS; 2])?;
            both.into_iter().for_each(|frame| gpu.end(frame));
            let ratios = times[0].iter().zip(&times[1]).map(|(without, with)| with / without);
            let ratio = median(ratios.collect());
            let [without, with] = [&times[0], &times[1]].map(|ms| median(ms.clone()));
            println!("| {name} | {exponent} | {without:.2} | {with:.2} | {ratio:.2} |");
        }
    }
    Ok(())
}

/// Suns alone; by brute-force horizons what is left is the mean over the disc, and the part of it in half-shadow.
fn suns(gpu: &mut Headless, ground: &(HeightField, Environment)) -> Outcome {
    println!();
    head("| exponent | sun, degrees wide | degrees high | method | RMSE % | paths' noise % |");
    for (wide, high) in [(0.53, 60.0), (5.0, 60.0), (0.53, 20.0), (5.0, 20.0)] {
        for exponent in [1.0, 5.0, 20.0, 100.0, 1000.0] {
            let mut scene = scene(ground, 0.0, (exponent, 1.0));
            let sun = inputs::sun(-160.0, high, [3.0; 3]);
            let sun = Sun { diameter_rad: f64::to_radians(wide), ..sun };
            scene.lights = Lights { suns: vec![sun], ..Lights::default() };
            let [reference, deviation] = traced(gpu, &scene, 0, DIRECT_BATCHES)?;
            let noise = 100.0 * rms_of(&deviation) / mean(&reference);
            for method in [Method::Auto, Method::BruteForce] {
                let light = drawn(gpu, &scene, &Quality { method, ..Quality::default() }, 0)?.light;
                let error = error(&light, &reference)?;
                let rmse = (error * error - noise * noise).max(0.0).sqrt();
                println!("| {exponent} | {wide} | {high} | {method} | {rmse:.2} | {noise:.3} |");
            }
        }
    }
    Ok(())
}

pub fn indirect(mut args: Args) -> Outcome {
    let (output, paths) = (args.path("-o")?, args.number("--spp", 8192_u32)?);
    let ground = ground(&mut args, 3.0)?;
    let mut gpu = args.open()?;
    println!(
        "Middle {}² of mt_washington_256, three times as steep, under sky_512x256 cut at 20 times its mean; {BOUNCES} \
         bounces, {paths} paths per grid point; relative RMSE; {}\n",
        ground.0.cols(),
        device(&gpu)
    );
    head(
        "| diffuse | specular | exponent | engine | kept | order | bounced % | noise % | whole % | ms | kept MB |",
    );
    let batches = paths.div_ceil(REFERENCE_BATCH).max(2);
    let kept = ["exit_vectors", "vector_levels", "exit_upward", "shade_levels", "shade_stack"];
    let mut picture = Vec::new();
    for (albedo, scale) in [(0.0_f32, 0.9_f32), (0.4, 0.5)] {
        for exponent in EXPONENTS {
            let scene = scene(&ground, albedo, (exponent, scale));
            let [direct, direct_deviation] = traced(&mut gpu, &scene, 0, batches)?;
            let [all, deviation] = traced(&mut gpu, &scene, BOUNCES, batches)?;
            let reference = minus(&all, &direct);
            let noise = rms_of(&deviation).hypot(rms_of(&direct_deviation));
            let noise = 100.0 * noise / mean(&reference);
            let mut row = vec![reference.clone()];
            for (engine, specular, sh_order) in FORMS {
                let count = BOUNCES;
                let bounces =
                    Bounces { count, engine, cutoff: 0.0, specular, ..Bounces::default() };
                let quality = Quality { sh_order, bounces, ..Quality::default() };
                let found = drawn_in_layers(&mut gpu, &scene, &quality)?;
                println!(
                    "| {albedo} | {scale} | {exponent} | {engine} | {specular} | {sh_order} | {:.1} | {noise:.1} | {:.2} | {:.1} | {:.2} |",
                    error(&found.indirect, &reference)?,
                    error(&found.light, &all)?,
                    found.ms(),
                    found.bytes(&kept) as f64 / 1e6,
                );
                row.push(found.indirect);
            }
            // The mean is a fifth of white.
            let white = (5.0 * mean(&reference)) as f32;
            let texels =
                |light: &Colours| to_f32(light).iter().map(|t| t.map(|v| v / white)).collect();
            picture.push(row[..=IN_PICTURE].iter().map(texels).collect::<Vec<_>>());
        }
    }
    picture.truncate(EXPONENTS.len());
    match output {
        Some(path) => Ok(plot::png(&path, &picture, ground.0.cols(), 2, 1.0)?),
        None => Ok(()),
    }
}
