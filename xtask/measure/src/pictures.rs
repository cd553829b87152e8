//! Pictures of the documentation, their times and errors.
//!
//! - `picture`: docs/pictures/demo.png, README's picture: the bundled mountain without shadows, as
//!   Ridgelight lights it, and brute force in 360 azimuths, 64 slices of the sun.
//! - `terrain`: docs/pictures/terrain.png: the bundled mountain before a camera, under the bundled sky
//!   and a sun, with one bounce. Coloured by height: forest, heath above the tree line at 1400 m, rock.
//! - `town`: docs/pictures/town.png: a town under a sky, a key light and three sphere lights, each
//!   without shadows, as Ridgelight lights it, and by the f64 oracle with half of its usual rays.
//! - `bleed`: docs/pictures/bleed.png: a white floor within a red wall under a low sun and a dim sky,
//!   without bounces, as Ridgelight lights it, and path-traced.
//!
//! Without shadows, only a grid point's own plane occludes light.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{Picture, REFERENCE_BATCH, View, ViewOptions};
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, Camera, Fuse, HeightField, KeyLight, Lens, Lights,
    Method, Quality, Scene, SphereLight, Tone,
};
use ridgelight_cpu::light::{Receiver, Site, normal};
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_io as files;

use crate::common::args::Args;
use crate::common::frames::{
    Colours, colours, drawn, error, mean, rms_of, to_f32, total, traced, with_picture,
};
use crate::common::plot::png;
use crate::common::{Outcome, head, inputs, median};

/// Light that only the grid point's own plane occludes; sphere lights keep their shadows.
fn unshadowed(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Colours> {
    let wanted = Picture { unshadowed: true, ..Picture::default() };
    with_picture(gpu, scene, quality, wanted, |gpu, frame| {
        gpu.draw(frame)?;
        Ok(colours(&gpu.pixels(frame, 0)?))
    })
}

pub fn picture(mut args: Args) -> Outcome {
    let (output, json) = (args.needed("-o")?, args.needed("--json")?);
    let mut gpu = args.open()?;
    let mut scene = inputs::under(inputs::mountain(1.0)?, inputs::sky(0.0)?);
    scene.lights.suns = vec![inputs::sun(90.0 - 300.0, 10.0, [15.0; 3])];
    let quality = Quality::default();
    let method = Method::BruteForce;
    let brute = Quality { method, azimuths: 360, sun_azimuths: 64, ..quality };
    let ours = drawn(&mut gpu, &scene, &quality, 1)?;
    // Compiling is short beside brute force.
    let reference = drawn(&mut gpu, &scene, &brute, 0)?;
    let unshadowed = unshadowed(&mut gpu, &scene, &quality)?;
    let row = [&unshadowed, &ours.light, &reference.light].map(|light| to_f32(light)).to_vec();
    png(&output, &[row], scene.field.cols(), 1, 0.2)?;
    let share = |light: &Colours| -> Result<f64> { Ok(error(light, &reference.light)? / 100.0) };
    let report = gpu.report();
    let figures = serde_json::json!({
        "device": report.name, "driver": report.driver, "field": inputs::MOUNTAIN,
        "rows": scene.field.rows(), "cols": scene.field.cols(),
        "azimuths": quality.azimuths, "reference_azimuths": brute.azimuths,
        "ours_ms": ours.ms(), "reference_ms": reference.ms(),
        "off_error": share(&unshadowed)?, "ours_error": share(&ours.light)?,
    });
    Ok(files::write_json(&json, &figures)?)
}

/// Colours by height.
fn vegetation(field: &HeightField) -> Albedo {
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
    Albedo::Map(field.heights_m().iter().map(|h| colour(field.base_m() + f64::from(*h))).collect())
}

pub fn terrain(mut args: Args) -> Outcome {
    /// Frames after the first, which compiles; times are their medians.
    const FRAMES: usize = 9;
    let (output, json) = (args.needed("-o")?, args.needed("--json")?);
    let mut gpu = args.open()?;
    // Rotated so that the sky's bright half, and its own sun behind clouds, is before the camera.
    let sky = inputs::sky(-110_f64.to_radians())?;
    let mut scene = inputs::under(inputs::mountain(1.0)?, sky);
    scene.surface.albedo = vegetation(&scene.field);
    // From the left.
    scene.lights.suns = vec![inputs::sun(90.0 - 185.0, 11.0, [26.0, 19.0, 12.0])];
    let bounces = Bounces { count: 1, engine: BounceEngine::Sweep, ..Bounces::default() };
    let quality = Quality { bounces, ..Quality::default() };
    let options = ViewOptions { size: [1200, 500], ..ViewOptions::default() };
    // From the east, above the ravines.
    let camera = Camera {
        target_m: [8200.0, 12400.0, 1150.0],
        azimuth_rad: 10_f64.to_radians(),
        elevation_rad: 12_f64.to_radians(),
        distance_m: 11500.0,
        lens: Lens::Perspective { fov_rad: 25_f64.to_radians() },
    };
    let limits = gpu.report().limits;
    let wanted = Picture::default();
    let (view, lit, drawn) = with_picture(&mut gpu, &scene, &quality, wanted, |gpu, frame| {
        let view = View::new(&scene, frame.plan(), &camera, &options, &limits)?;
        gpu.draw(frame)?;
        let mut picture = gpu.look(frame, &view, None)?;
        let (mut lit, mut drawn) = (Vec::new(), Vec::new());
        for _ in 0..FRAMES {
            lit.push(total(&gpu.draw(frame)?));
            picture = gpu.look(frame, &view, None)?;
            drawn.push(total(&picture.timings));
        }
        Ok((picture, lit, drawn))
    })?;
    let [cols, rows] = options.size.map(|n| n as usize);
    files::write_png(&output, rows, cols, &view.radiance, None, Tone::picture(0.95), &[])?;
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

/// Grid points a side of the town, a metre apart.
const TOWN: usize = 192;

/// Houses of 5 to 35 m with streets between, every seventh plot a square.
fn houses() -> Result<HeightField> {
    // A block, and the part of it that a house takes, cells.
    const BLOCK: usize = 16;
    const HOUSE: usize = 10;
    // Multiples of the golden ratio: no two neighbours have the same height.
    let height = |i: usize| match i % 7 {
        3 => 0.0,
        _ => 5.0 + (30.0 * (i as f64 * 0.618_034).fract()).round(),
    };
    inputs::field(TOWN, TOWN, |row, col| {
        let is_house = row % BLOCK < HOUSE && col % BLOCK < HOUSE;
        if is_house { height(row / BLOCK * TOWN.div_ceil(BLOCK) + col / BLOCK) } else { 0.0 }
    })
}

/// The lights of each row of the town, and its exposure.
fn town_lights() -> [(&'static str, Lights, f32); 3] {
    let sky = Lights { sky: Some([0.7, 0.85, 1.0]), ..Lights::default() };
    // 40° wide, low in the south-west.
    let key = KeyLight {
        azimuth_rad: 215_f64.to_radians(),
        width_rad: 40_f64.to_radians(),
        elevations_rad: [20_f64.to_radians(), 45_f64.to_radians()],
        radiance: [8.0, 6.4, 4.4],
    };
    let sphere = |position_m, radius_m, radiance| SphereLight { position_m, radius_m, radiance };
    let sphere_lights = vec![
        sphere([61.0, 93.0, 12.0], 3.0, [90.0, 40.0, 14.0]),
        sphere([132.0, 125.0, 45.0], 8.0, [24.0, 30.0, 42.0]),
        sphere([125.0, 45.0, 8.0], 2.0, [20.0, 130.0, 60.0]),
    ];
    [
        ("sky", sky, 1.0),
        ("key light", Lights { keys: vec![key], ..Lights::default() }, 0.8),
        ("three sphere lights", Lights { sphere_lights, ..Lights::default() }, 1.2),
    ]
}

/// Colours of all grid points, on all cores of the processor.
fn on_all_cores(colour: impl Fn(usize, usize) -> [f64; 3] + Sync) -> Colours {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (part, colour) = ((TOWN * TOWN).div_ceil(cores), &colour);
    let mut all = vec![[0.0; 3]; TOWN * TOWN];
    std::thread::scope(|scope| {
        for (k, texels) in all.chunks_mut(part).enumerate() {
            let fill = move |(i, texel): (usize, &mut [f64; 3])| {
                *texel = colour((k * part + i) / TOWN, (k * part + i) % TOWN);
            };
            scope.spawn(move || texels.iter_mut().enumerate().for_each(fill));
        }
    });
    all
}

/// Sphere lights at a grid point that is alone in the world.
fn unshadowed_spheres(scene: &Scene, row: usize, col: usize) -> [f64; 3] {
    let field = &scene.field;
    let receiver = [Receiver::diffuse(normal(field, Border::Plane, row, col))];
    let height = field.base_m() + f64::from(field.heights_m()[row * TOWN + col]);
    let alone = HeightField::new(1, 1, &[height], field.cell_m(), None).expect("one grid point");
    let oracle = Oracle::new(&alone, Border::Open);
    let site = Site::of(&oracle, [0, 0], &receiver);
    let mut sum = [0.0; 3];
    for sphere in &scene.lights.sphere_lights {
        let [x, y, z] = sphere.position_m;
        let position_m = [x - col as f64, y - (TOWN - 1 - row) as f64, z];
        let moved = SphereLight { position_m, ..*sphere };
        let share = site.sphere(&moved, 128)[0];
        (0..3).for_each(|c| sum[c] += share * f64::from(sphere.radiance[c]));
    }
    sum
}

pub fn town(mut args: Args) -> Outcome {
    let output = args.needed("-o")?;
    let mut gpu = args.open()?;
    println!("{}: a town of {TOWN}² in cells of 1 m; relative RMSE, %\n", gpu.report().name);
    head("| lit by | without shadows | ours |");
    // Upright edges need many azimuths across a light, and every crossing.
    let quality = Quality { sun_azimuths: 64, fuse: Fuse::AimedAround, ..Quality::default() };
    let field = houses()?;
    let mut picture = Vec::new();
    for (name, lights, exposure) in town_lights() {
        let scene = inputs::lit_by(field.clone(), lights);
        let unshadowed = if scene.lights.sphere_lights.is_empty() {
            unshadowed(&mut gpu, &scene, &quality)?
        } else {
            on_all_cores(|row, col| unshadowed_spheres(&scene, row, col))
        };
        let ours = drawn(&mut gpu, &scene, &quality, 0)?.light;
        let lit = Lit::of(&scene).halved();
        let oracle = on_all_cores(|row, col| lit.at(row, col));
        println!(
            "| {name} | {:.1} | {:.2} |",
            error(&unshadowed, &oracle)?,
            error(&ours, &oracle)?
        );
        let texels =
            |light: &Colours| to_f32(light).iter().map(|t| t.map(|v| v * exposure)).collect();
        picture.push([&unshadowed, &ours, &oracle].map(texels).to_vec());
    }
    Ok(png(&output, &picture, TOWN, 1, 1.0)?)
}

/// Grid points a side of the floor, a metre apart.
const FLOOR: usize = 160;

/// How far a grid point is inside the foot of the wall, m: half a ring, open to the west.
fn within_wall(row: usize, col: usize) -> f64 {
    let (radius, half_width) = (56.0, 8.0);
    let middle = (FLOOR / 2) as f64;
    let (x, y) = (col as f64 - 0.75 * middle, row as f64 - middle);
    let from_ring = if x > 0.0 { x.hypot(y) - radius } else { x.hypot(y.abs() - radius) };
    half_width - from_ring.abs()
}

/// A wall 30 m high with flanks 3 m wide.
fn red_wall() -> Result<Scene> {
    let height = |row, col| 30.0 * (within_wall(row, col) / 3.0).clamp(0.0, 1.0);
    let suns = vec![inputs::sun(170.0, 20.0, [3.0; 3])];
    let lights = Lights { sky: Some([0.1; 3]), suns, ..Lights::default() };
    let mut scene = inputs::lit_by(inputs::field(FLOOR, FLOOR, height)?, lights);
    // A cell farther out: the normals at the foot lean as the flank does.
    let colour = |i: usize| match within_wall(i / FLOOR, i % FLOOR) > -1.5 {
        true => [0.8, 0.06, 0.04],
        false => [0.8; 3],
    };
    scene.surface.albedo = Albedo::Map((0..FLOOR * FLOOR).map(colour).collect());
    Ok(scene)
}

pub fn bleed(mut args: Args) -> Outcome {
    const BOUNCES: u32 = 3;
    const BATCHES: u32 = 16;
    let output = args.needed("-o")?;
    let (mut gpu, scene) = (args.open()?, red_wall()?);
    let quality = |count| {
        let engine = BounceEngine::Sweep;
        let bounces = Bounces { count, engine, azimuths: 64, ..Bounces::default() };
        Quality { fuse: Fuse::AimedAround, bounces, ..Quality::default() }
    };
    let direct = drawn(&mut gpu, &scene, &quality(0), 1)?;
    let ours = drawn(&mut gpu, &scene, &quality(BOUNCES), 1)?;
    let [reference, deviation] = traced(&mut gpu, &scene, BOUNCES, BATCHES)?;
    println!(
        "{}: a red wall on a white floor, {FLOOR}² grid points, {BOUNCES} bounces, {} paths; relative RMSE, %\n",
        gpu.report().name,
        REFERENCE_BATCH * BATCHES
    );
    head("| picture | whole | ms |");
    for (name, picture) in [("without bounces", &direct), ("ours", &ours)] {
        println!("| {name} | {:.2} | {:.1} |", error(&picture.light, &reference)?, picture.ms());
    }
    let noise = 100.0 * rms_of(&deviation) / mean(&reference);
    println!("\nstandard error of the path-traced picture: {noise:.2} %");
    let row = [&direct.light, &ours.light, &reference].map(|light| to_f32(light)).to_vec();
    Ok(png(&output, &[row], FLOOR, 1, 1.4)?)
}
