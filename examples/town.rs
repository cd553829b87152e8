//! Draws docs/pictures/town.png, a town: under a sky, under a key light and under three balls of light, each without
//! shadows, as Ridgelight lights it, and its truth, side by side; and prints how far from the truth they are.
//!
//! `cargo run --release --example town -- -o PICTURE.png`
//!
//! Without shadows: every sample sees all that is above the horizontal and its own plane (a ball: its own plane),
//! in f64. The truth: the f64 oracle's light, of half of its usual rays.

use std::path::Path;

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::Tone;
use ridgelight::scene::{
    Border, Fuse, HeightField, KeyLight, Lights, Quality, Scene, SphereLight, Surface,
};
use ridgelight::{Error, Result};
use ridgelight_cpu::key::key_on;
use ridgelight_cpu::light::{Receiver, normal};
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere::sphere_on;
use ridgelight_io as files;
use ridgelight_trade::error::ImageError;

/// Samples a side, a metre apart.
const SIDE: usize = 192;
/// A block of the town and its part that a house takes, samples.
const BLOCK: usize = 16;
const HOUSE: usize = 10;
/// White columns and rows between pictures.
const GAP: usize = 4;
/// Azimuths across a light that is no sky, in what is called ours: upright edges want many, and every crossing.
const ACROSS: u32 = 64;
/// Strips of what has no shadows.
const STRIPS: usize = 128;

/// Houses of 5 to 35 m with streets between, every seventh plot a square.
fn town() -> Result<HeightField> {
    let plots = SIDE.div_ceil(BLOCK);
    // Multiples of the golden ratio's share: no two neighbours alike.
    let storeys = |i: usize| {
        if i % 7 == 3 { 0.0 } else { 5.0 + (30.0 * (i as f64 * 0.618_034).fract()).round() }
    };
    let height = |i: usize| {
        let (row, col) = (i / SIDE, i % SIDE);
        let is_house = row % BLOCK < HOUSE && col % BLOCK < HOUSE;
        if is_house { storeys(row / BLOCK * plots + col / BLOCK) } else { 0.0 }
    };
    let heights: Vec<f64> = (0..SIDE * SIDE).map(height).collect();
    HeightField::new(SIDE, SIDE, &heights, [1.0; 2], None)
}

/// What each row of the picture is lit by, and the exposure that it is shown at.
fn rows() -> [(&'static str, Lights, f32); 3] {
    let sky = Lights { sky: Some([0.7, 0.85, 1.0]), ..Lights::default() };
    // 40° wide, low in the south-west.
    let key = KeyLight {
        azimuth_rad: 215_f64.to_radians(),
        width_rad: 40_f64.to_radians(),
        elevations_rad: [20_f64.to_radians(), 45_f64.to_radians()],
        radiance: [8.0, 6.4, 4.4],
    };
    let ball = |position_m: [f64; 3], radius_m: f64, radiance: [f32; 3]| SphereLight {
        position_m,
        radius_m,
        radiance,
    };
    let balls = vec![
        ball([61.0, 93.0, 12.0], 3.0, [90.0, 40.0, 14.0]),
        ball([132.0, 125.0, 45.0], 8.0, [24.0, 30.0, 42.0]),
        ball([125.0, 45.0, 8.0], 2.0, [20.0, 130.0, 60.0]),
    ];
    [
        ("sky", sky, 1.0),
        ("key light", Lights { keys: vec![key], ..Lights::default() }, 0.8),
        ("three balls", Lights { sphere_lights: balls, ..Lights::default() }, 1.2),
    ]
}

/// Colours of all samples, rows shared out among the processor's cores.
fn pixels(colour: impl Fn(usize, usize) -> [f64; 3] + Sync) -> Vec<[f32; 3]> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut all = vec![[0.0; 3]; SIDE * SIDE];
    let colour = &colour;
    std::thread::scope(|scope| {
        for (k, part) in all.chunks_mut(SIDE * SIDE.div_ceil(threads)).enumerate() {
            scope.spawn(move || {
                let first = k * SIDE.div_ceil(threads);
                for (i, pixel) in part.iter_mut().enumerate() {
                    *pixel = colour(first + i / SIDE, i % SIDE).map(|v| v as f32);
                }
            });
        }
    });
    all
}

/// A sample's light where nothing is in the way but its own plane.
fn unshadowed(scene: &Scene, row: usize, col: usize) -> [f64; 3] {
    let Scene { field, lights, .. } = scene;
    let facing = normal(field, Border::Plane, row, col);
    let receiver = [Receiver::diffuse(facing)];
    // Alone in the world.
    let height = field.base_m() + f64::from(field.heights_m()[row * SIDE + col]);
    let alone = HeightField::new(1, 1, &[height], field.cell_m(), None).expect("one sample");
    let oracle = Oracle::new(&alone, Border::Open);
    let mut sum = [0.0; 3];
    let mut add = |share: f64, colour: [f32; 3]| {
        (0..3).for_each(|c| sum[c] += share * f64::from(colour[c]));
    };
    if let Some(colour) = lights.sky {
        // The upper half of the sky, less what the plane cuts off.
        add((1.0 + facing.z) / 2.0, colour);
    }
    for key in &lights.keys {
        add(key_on(&oracle, 0, 0, &receiver, key, STRIPS)[0], key.radiance);
    }
    for ball in &lights.sphere_lights {
        let [x, y, z] = ball.position_m;
        let away = [x - col as f64, y - (SIDE - 1 - row) as f64, z];
        let ball = SphereLight { position_m: away, ..*ball };
        add(sphere_on(&oracle, 0, 0, &receiver, &ball, STRIPS)[0], ball.radiance);
    }
    sum
}

/// The picture that the device draws.
fn ours(gpu: &mut Headless, scene: &Scene) -> Result<Vec<[f32; 3]>> {
    let quality = Quality { sun_azimuths: ACROSS, fuse: Fuse::AimedAround, ..Quality::default() };
    let plan = plan::picture(scene, &quality, &gpu.report().limits, Picture::default())?;
    let drawn = gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        gpu.pixels(frame, 0)
    })?;
    Ok(drawn.values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect())
}

/// RMSE over the mean of the truth.
fn error(light: &[[f32; 3]], truth: &[[f32; 3]]) -> Result<f64> {
    let flat = |all: &[[f32; 3]]| all.iter().flatten().map(|v| f64::from(*v)).collect::<Vec<_>>();
    Ok(ImageError::of(&flat(light), &flat(truth), 3)?.relative_rmse)
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [flag, out] = args.as_slice() else {
        return Err(Error::setting("-o", args.join(" "), "a picture's name, .png"));
    };
    if flag != "-o" {
        return Err(Error::setting("-o", flag, "a picture's name, .png, after it"));
    }
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}: a town of {SIDE}² in cells of 1 m; RMSE over the mean, %", gpu.report().name);
    println!();
    println!("| lit by | without shadows | ours |");
    println!("|---|---|---|");
    let field = town()?;
    let width = 3 * SIDE + 2 * GAP;
    let mut picture = Vec::new();
    for (name, lights, exposure) in rows() {
        let scene = Scene { field: field.clone(), surface: Surface::default(), lights };
        let off = pixels(|row, col| unshadowed(&scene, row, col));
        let drawn = ours(&mut gpu, &scene)?;
        let lit = Lit::of(&scene).halved();
        let truth = pixels(|row, col| lit.at(row, col));
        let [bare, near] = [&off, &drawn].map(|p| error(p, &truth));
        println!("| {name} | {:.1} | {:.2} |", 100.0 * bare?, 100.0 * near?);
        if !picture.is_empty() {
            picture.extend(std::iter::repeat_n([1.0; 3], GAP * width));
        }
        for row in 0..SIDE {
            for (i, panel) in [&off, &drawn, &truth].into_iter().enumerate() {
                if i > 0 {
                    picture.extend([[1.0; 3]; GAP]);
                }
                let line = &panel[row * SIDE..(row + 1) * SIDE];
                picture.extend(line.iter().map(|p| p.map(|v| v * exposure)));
            }
        }
    }
    let height = picture.len() / width;
    files::write_png(Path::new(out), height, width, &picture, None, Tone { exposure: 1.0 }, &[])
}
