//! Suns: errors and times of the default, of hull sweeps and of their slowest fuse, against brute force.

use std::path::Path;

use ridgelight::Result;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Border, Fuse, HeightField, Lights, Method, Quality, Scene, Sun};

use crate::common::args::Args;
use crate::common::frames::{device, drawn, error_of, in_turn};
use crate::common::{Outcome, head, inputs, median};
use crate::gallery::terrain_of;

/// Degrees above the horizon.
const ELEVATIONS: [f64; 4] = [6.0, 12.0, 25.0, 50.0];
/// Compass degrees.
const AZIMUTH: f64 = 115.0;
const DIAMETER: f64 = 0.53;
const BORDERS: [Border; 3] = [Border::Plane, Border::Open, Border::Periodic];
/// Frames of each setting, drawn in turn.
const TURNS: usize = 15;

fn scene(field: &HeightField, border: Border, elevation: f64) -> Scene {
    let sun = Sun {
        azimuth_rad: (90.0 - AZIMUTH).to_radians(),
        elevation_rad: elevation.to_radians(),
        diameter_rad: DIAMETER.to_radians(),
        irradiance: [1.0; 3],
    };
    let lights = Lights { suns: vec![sun], ..Lights::default() };
    let mut scene = inputs::lit_by(field.clone(), lights);
    scene.surface.border = border;
    scene
}

/// The bundled mountain, also three times as steep, and synthetic fields; real ones of a folder.
fn fields(folder: Option<&Path>) -> Result<Vec<(String, HeightField)>> {
    let mut all = vec![
        ("Mt Washington, 256²".to_owned(), inputs::mountain(1.0)?),
        ("the same, relief x 3".to_owned(), inputs::mountain(3.0)?),
        ("synthetic city, 384²".to_owned(), terrain_of("city", 384, 0.0)?),
        ("synthetic dunes, 384²".to_owned(), terrain_of("dunes", 384, 0.0)?),
    ];
    for name in
        folder.map_or(&[][..], |_| &[inputs::WHITE_MOUNTAINS, inputs::RAINIER, inputs::MOSS])
    {
        let field = inputs::field_of(folder.expect("listed"), name)?;
        all.push((format!("{name}, 384²"), inputs::middle(&field, 384)?));
    }
    Ok(all)
}

pub fn run(mut args: Args) -> Outcome {
    let fields = fields(args.folder().as_deref())?;
    let mut gpu = args.open()?;
    println!(
        "{}: a sun {DIAMETER}° wide, {} slices; RMSE against brute force in the same slices, times of frames as medians of {TURNS}, drawn in turn\n",
        device(&gpu),
        Quality::default().sun_azimuths
    );
    head(
        "| field | border | elevation ° | sweep % | aimed-around % | default % | sweep ms | time of aimed-around | time of the default |",
    );
    let default = Quality::default();
    let sweep = Quality { method: Method::Sweep, ..default };
    let around = Quality { fuse: Fuse::AimedAround, ..sweep };
    for (name, field) in &fields {
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
            let rows = in_turn(&mut gpu, &scene, [&sweep, &around, &default], TURNS)?;
            let ms = median(rows.iter().map(|row| row[0]).collect());
            let ratio = |k: usize| median(rows.iter().map(|row| row[k] / row[0]).collect());
            let border = format!("{border:?}").to_lowercase();
            println!(
                "| {name} | {border} | {elevation} | {} | {ms:.1} | {:.2} x | {:.2} x |",
                errors.join(" | "),
                ratio(1),
                ratio(2)
            );
        }
    }
    // What the default is.
    let plan = plan::picture(
        &scene(&fields[0].1, Border::Plane, 25.0),
        &default,
        &gpu.report().limits,
        Picture::default(),
    )?;
    let names: Vec<&str> = plan.passes.iter().map(|p| p.name()).collect();
    println!("\nPasses of the default: {}", names.join(", "));
    Ok(())
}
