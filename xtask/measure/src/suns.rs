//! Suns: errors and times of the default, of hull sweeps, of their slowest fuse and of shadow-height maps, against brute force.

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Border, Fuse, HeightField, Lights, Method, Quality, Scene};

use crate::common::args::Args;
use crate::common::frames::{device, drawn, error_of, frame, frames_in_turn, with_picture};
use crate::common::terrains::{BORDERS, SIDES, Terrain, border_name, terrains};
use crate::common::{Outcome, head, inputs, median};

/// Degrees above the horizon.
const ELEVATIONS: [f64; 4] = [6.0, 12.0, 25.0, 50.0];
/// Compass degrees.
const AZIMUTH: f64 = 115.0;
/// Frames of each setting, drawn in turn.
const TURNS: usize = 15;

fn scene(field: &HeightField, border: Border, elevation: f64) -> Scene {
    let suns = vec![inputs::sun(90.0 - AZIMUTH, elevation, [1.0; 3])];
    let lights = Lights { suns, ..Lights::default() };
    let mut scene = inputs::lit_by(field.clone(), lights);
    scene.surface.border = border;
    scene
}

/// The frame of a shadow-height map, and the unshadowed light multiplied by the map's `sun_share`.
fn by_shadow_heights(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
) -> Result<(Frame, Vec<f64>)> {
    let unshadowed = Picture { unshadowed: true, ..Picture::default() };
    let lit = with_picture(gpu, scene, quality, unshadowed, |gpu, frame| {
        gpu.draw(frame)?;
        gpu.pixels(frame, 0)
    })?;
    let limits = gpu.report().limits;
    let plan = plan::shadow_heights(&scene.field, &scene.lights.suns[0], None, 1, &limits)?;
    let mut frame = gpu.frame(plan, &[scene.field.heights_m()])?;
    gpu.draw(&mut frame)?;
    let share = gpu.pixels(&frame, 2)?.values;
    let channels = lit.values.len() / share.len();
    let light = lit.values.iter().step_by(channels).zip(share);
    let light = light.map(|(lit, share)| f64::from(*lit) * f64::from(share)).collect();
    Ok((frame, light))
}

pub fn run(mut args: Args) -> Outcome {
    let terrains = terrains(args.folder().as_deref(), SIDES)?;
    let mut gpu = args.open()?;
    println!(
        "{}: a sun 0.53° wide, {} slices; RMSE against brute force in the same slices, without voids, times of frames as medians of {TURNS}, drawn in turn\n",
        device(&gpu),
        Quality::default().sun_azimuths
    );
    head(
        "| field | border | elevation ° | sweep % | aimed-around % | default % | shadow-height map % | sweep ms | time of aimed-around | time of the default | time of the shadow-height map |",
    );
    let default = Quality::default();
    let sweep = Quality { method: Method::Sweep, fuse: Fuse::AimedNearest, ..default };
    let around = Quality { fuse: Fuse::AimedAround, ..sweep };
    for Terrain { name, field, .. } in &terrains {
        for (border, elevation) in BORDERS.into_iter().flat_map(|b| ELEVATIONS.map(|e| (b, e))) {
            let scene = scene(field, border, elevation);
            let exact = Quality { method: Method::BruteForce, ..default };
            let exact = drawn(&mut gpu, &scene, &exact, 0)?.light;
            let grey = |light: &[[f64; 3]]| light.iter().map(|t| t[0]).collect::<Vec<_>>();
            let mut errors = Vec::new();
            for quality in [&sweep, &around, &default] {
                let light = drawn(&mut gpu, &scene, quality, 0)?.light;
                errors.push(format!("{:.3}", error_of(&grey(&light), &grey(&exact))?));
            }
            let mut frames = Vec::new();
            for quality in [&sweep, &around, &default] {
                frames.push(frame(&mut gpu, &scene, quality)?);
            }
            // Shadow-height maps assume level ground beyond the edge, so only this border is comparable.
            if border == Border::Plane {
                let (map, light) = by_shadow_heights(&mut gpu, &scene, &default)?;
                frames.push(map);
                errors.push(format!("{:.3}", error_of(&light, &grey(&exact))?));
            } else {
                errors.push("-".to_owned());
            }
            let maps = frames.len() == 4;
            let rows = frames_in_turn(&mut gpu, frames, TURNS)?;
            let ms = median(rows.iter().map(|row| row[0]).collect());
            let ratio = |k: usize| {
                let ratio = median(rows.iter().map(|row| row[k] / row[0]).collect());
                format!("{ratio:.2} x")
            };
            let border = border_name(border);
            println!(
                "| {name} | {border} | {elevation} | {} | {ms:.1} | {} | {} | {} |",
                errors.join(" | "),
                ratio(1),
                ratio(2),
                if maps { ratio(3) } else { "-".to_owned() }
            );
        }
    }
    // What the default is.
    let plan = plan::picture(
        &scene(&terrains[0].field, Border::Plane, 25.0),
        &default,
        &gpu.report().limits,
        Picture::default(),
    )?;
    let names: Vec<&str> = plan.passes.iter().map(|p| p.name()).collect();
    println!("\nPasses of the default: {}", names.join(", "));
    Ok(())
}
