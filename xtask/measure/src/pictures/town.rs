//! docs/pictures/town.png: a town under a sky, under a key light and under three sphere lights, each without
//! shadows, as Ridgelight lights it, and its ground truth; and the errors.
//!
//! Without shadows: every grid point sees all that is above the horizontal and its own plane (a sphere light:
//! its own plane), in f64. The ground truth: the f64 oracle's light, of half of its usual rays.

use ridgelight::Result;
use ridgelight::scene::{
    Border, Fuse, HeightField, KeyLight, Lights, Quality, Scene, SphereLight, Surface,
};
use ridgelight_cpu::light::{Receiver, Site, normal};
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::oracle::Oracle;

use crate::common::args::Args;
use crate::common::frames::{Colours, drawn, error, open, to_f32};
use crate::common::{Outcome, inputs, panels};

/// Grid points a side, a metre apart.
const SIDE: usize = 192;
/// A block of the town and its part that a house takes, cells.
const BLOCK: usize = 16;
const HOUSE: usize = 10;
/// Azimuths across a light that is no sky: upright edges need many, and every crossing.
const ACROSS: u32 = 64;
/// Strips of unshadowed light.
const STRIPS: usize = 128;

/// Houses of 5 to 35 m with streets between, every seventh plot a square.
fn town() -> Result<HeightField> {
    // Multiples of the golden ratio's share: no two neighbours alike.
    let height = |i: usize| match i % 7 {
        3 => 0.0,
        _ => 5.0 + (30.0 * (i as f64 * 0.618_034).fract()).round(),
    };
    inputs::field(SIDE, SIDE, |row, col| {
        let is_house = row % BLOCK < HOUSE && col % BLOCK < HOUSE;
        if is_house { height(row / BLOCK * SIDE.div_ceil(BLOCK) + col / BLOCK) } else { 0.0 }
    })
}

/// The lights of each row of the picture, and its exposure.
fn rows() -> [(&'static str, Lights, f32); 3] {
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

/// Colours of all grid points, shared out among the processor's cores.
fn pixels(colour: impl Fn(usize, usize) -> [f64; 3] + Sync) -> Colours {
    let part = (SIDE * SIDE).div_ceil(std::thread::available_parallelism().map_or(1, usize::from));
    let mut all = vec![[0.0; 3]; SIDE * SIDE];
    let colour = &colour;
    std::thread::scope(|scope| {
        for (k, texels) in all.chunks_mut(part).enumerate() {
            scope.spawn(move || {
                for (i, texel) in texels.iter_mut().enumerate() {
                    *texel = colour((k * part + i) / SIDE, (k * part + i) % SIDE);
                }
            });
        }
    });
    all
}

/// Light where nothing is in the way but the grid point's own plane.
fn unshadowed(scene: &Scene, row: usize, col: usize) -> [f64; 3] {
    let Scene { field, lights, .. } = scene;
    let facing = normal(field, Border::Plane, row, col);
    let receiver = [Receiver::diffuse(facing)];
    // Alone in the world.
    let height = field.base_m() + f64::from(field.heights_m()[row * SIDE + col]);
    let alone = HeightField::new(1, 1, &[height], field.cell_m(), None).expect("one grid point");
    let oracle = Oracle::new(&alone, Border::Open);
    let site = Site::of(&oracle, [0, 0], &receiver);
    let mut sum = [0.0; 3];
    let mut add = |share: f64, colour: [f32; 3]| {
        (0..3).for_each(|c| sum[c] += share * f64::from(colour[c]));
    };
    if let Some(colour) = lights.sky {
        // The upper half of the sky, less what the plane cuts off.
        add((1.0 + facing.z) / 2.0, colour);
    }
    for key in &lights.keys {
        add(site.key(key, STRIPS)[0], key.radiance);
    }
    for sphere in &lights.sphere_lights {
        let [x, y, z] = sphere.position_m;
        let away = [x - col as f64, y - (SIDE - 1 - row) as f64, z];
        let moved = SphereLight { position_m: away, ..*sphere };
        add(site.sphere(&moved, STRIPS)[0], sphere.radiance);
    }
    sum
}

pub fn run(mut args: Args) -> Outcome {
    let output = args.needed("-o")?;
    args.end()?;
    let mut gpu = open()?;
    println!("{}: a town of {SIDE}² in cells of 1 m; relative RMSE, %\n", gpu.report().name);
    println!("| lit by | without shadows | ours |\n|---|---|---|");
    let quality = Quality { sun_azimuths: ACROSS, fuse: Fuse::AimedAround, ..Quality::default() };
    let field = town()?;
    let mut picture = Vec::new();
    for (name, lights, exposure) in rows() {
        let scene = Scene { field: field.clone(), surface: Surface::default(), lights };
        let off = pixels(|row, col| unshadowed(&scene, row, col));
        let ours = drawn(&mut gpu, &scene, &quality, 0)?.light;
        let lit = Lit::of(&scene).halved();
        let truth = pixels(|row, col| lit.at(row, col));
        println!("| {name} | {:.1} | {:.2} |", error(&off, &truth)?, error(&ours, &truth)?);
        let panel =
            |light: &Colours| to_f32(light).iter().map(|t| t.map(|v| v * exposure)).collect();
        picture.push([&off, &ours, &truth].map(panel).to_vec());
    }
    Ok(panels::write(&output, &picture, SIDE, 1, 1.0)?)
}
