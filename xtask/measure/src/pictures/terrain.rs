//! The picture of docs/getting-started.md: the bundled mountain before a camera, under the bundled sky
//! and a sun, with one bounce. It is coloured by height: forest, heath above the tree line at 1400 m, rock.

use ridgelight::plan::{Picture, View, ViewOptions};
use ridgelight::scene::{
    Albedo, BounceEngine, Bounces, Camera, HeightField, Lens, Quality, Sun, Tone,
};
use ridgelight_io as files;

use crate::common::args::Args;
use crate::common::frames::{open, total, with_picture};
use crate::common::{Outcome, inputs, median};

const SIZE: [u32; 2] = [1200, 500];
const EXPOSURE: f32 = 0.95;
/// Compass azimuth and elevation: from the left.
const SUN: [f64; 2] = [185.0, 11.0];
/// Degrees counter-clockwise: its bright half, and its own sun behind clouds, before the camera.
const SKY_TURNED: f64 = -110.0;
/// Frames after the first, which compiles; times are their medians.
const FRAMES: usize = 9;

fn albedo(field: &HeightField) -> Vec<[f32; 3]> {
    let mix = |a: [f32; 3], b: [f32; 3], t: f32| [0, 1, 2].map(|k| a[k] + t * (b[k] - a[k]));
    let smooth = |low: f64, high: f64, v: f64| {
        let t = ((v - low) / (high - low)).clamp(0.0, 1.0);
        (t * t * (3.0 - 2.0 * t)) as f32
    };
    let (forest, heath, rock) = ([0.045, 0.062, 0.030], [0.15, 0.135, 0.08], [0.21, 0.20, 0.185]);
    let colour = |height: f64| {
        let grown = mix(forest, heath, smooth(1000.0, 1400.0, height));
        mix(grown, rock, smooth(1350.0, 1750.0, height))
    };
    field.heights_m().iter().map(|h| colour(field.base_m() + f64::from(*h))).collect()
}

/// From the east, above the ravines.
fn camera() -> Camera {
    Camera {
        target_m: [8200.0, 12400.0, 1150.0],
        azimuth_rad: 10_f64.to_radians(),
        elevation_rad: 12_f64.to_radians(),
        distance_m: 11500.0,
        lens: Lens::Perspective { fov_rad: 25_f64.to_radians() },
    }
}

pub fn run(mut args: Args) -> Outcome {
    let (output, json) = (args.needed("-o")?, args.needed("--json")?);
    args.end()?;
    let field = inputs::mountain(1.0)?;
    let mut scene = inputs::under(field, inputs::sky(SKY_TURNED.to_radians())?);
    scene.surface.albedo = Albedo::Map(albedo(&scene.field));
    scene.lights.suns = vec![Sun {
        azimuth_rad: (90.0 - SUN[0]).to_radians(),
        elevation_rad: SUN[1].to_radians(),
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [26.0, 19.0, 12.0],
    }];
    let bounces = Bounces { count: 1, engine: BounceEngine::Sweep, ..Bounces::default() };
    let quality = Quality { azimuths: 64, sun_azimuths: 8, bounces, ..Quality::default() };
    let options = ViewOptions { size: SIZE, samples: 4, ..ViewOptions::default() };
    let mut gpu = open()?;
    let limits = gpu.report().limits;
    let wanted = Picture::default();
    let (seen, lit, drawn) = with_picture(&mut gpu, &scene, &quality, wanted, |gpu, frame| {
        let view = View::new(&scene, frame.plan(), &camera(), &options, &limits)?;
        gpu.draw(frame)?;
        let mut seen = gpu.look(frame, &view, None)?;
        let (mut lit, mut drawn) = (Vec::new(), Vec::new());
        for _ in 0..FRAMES {
            lit.push(total(&gpu.draw(frame)?));
            seen = gpu.look(frame, &view, None)?;
            drawn.push(total(&seen.timings));
        }
        Ok((seen, lit, drawn))
    })?;
    let ([cols, rows], tone) = (SIZE.map(|n| n as usize), Tone { exposure: EXPOSURE });
    files::write_png(&output, rows, cols, &seen.radiance, None, tone, &[])?;
    let report = gpu.report();
    let figures = serde_json::json!({
        "device": report.name, "driver": report.driver, "cols": cols, "rows": rows,
        "field_cols": scene.field.cols(), "field_rows": scene.field.rows(),
        "samples": options.samples, "azimuths": quality.azimuths, "bounces": quality.bounces.count,
        "lit_ms": median(lit), "drawn_ms": median(drawn),
    });
    println!("{figures}");
    Ok(files::write_json(&json, &figures)?)
}
