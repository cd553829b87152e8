//! The paper's table 1: 100 directions, 100 paths of one bounce, beside its seconds of the year 2000.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Albedo, Border, Directions, HeightField, Scatter, Scene, Surface};

use crate::seen::points;
use crate::{grooves, lights, scattered};

/// Courses of bricks, 16 by 8 samples each with mortar of one sample, three deep.
fn bricks(side: usize) -> Result<HeightField> {
    let height = |i: usize| {
        let (row, col) = (i / side, i % side);
        let shifted = col + if row / 8 % 2 == 1 { 8 } else { 0 };
        if row % 8 == 0 || shifted % 16 == 0 { 0.0 } else { 3.0 }
    };
    let heights: Vec<f64> = (0..side * side).map(height).collect();
    HeightField::new(side, side, &heights, [1.0; 2], None)
}

/// Round bumps, 16 samples apart.
pub fn bumps(side: usize) -> Result<HeightField> {
    let wave = |n: usize| (std::f64::consts::TAU * n as f64 / 16.0).sin();
    let heights: Vec<f64> =
        (0..side * side).map(|i| 4.0 * wave(i / side) * wave(i % side)).collect();
    HeightField::new(side, side, &heights, [1.0; 2], None)
}

pub fn run(gpu: &mut Headless) -> Result<()> {
    const COUNT: usize = 100;
    println!(
        "{COUNT} directions, {COUNT} paths; ms, the device's own; the paper's seconds beside them: found, by software, by hardware\n"
    );
    println!("| field | MB | found | 1 bounce | 3 bounces | paper: found | software | hardware |");
    println!("|---|---|---|---|---|---|---|---|");
    for (name, field, paper) in [
        ("triangles 32²", grooves(32, 32, 16)?.field, "27 | 10 | 0.48"),
        ("bricks 128²", bricks(128)?, "1029 | 12 | 2.10"),
        ("bumps 32²", bumps(32)?, "109 | 8 | 0.48"),
        ("bumps 128²", bumps(128)?, " | | "),
        ("bumps 1024²", bumps(1024)?, " | | "),
    ] {
        let directions = Directions::fibonacci(COUNT, -1.0, 0)?;
        let (points, found_ms) = points(gpu, &field, Border::Periodic, &directions)?;
        let surface = Surface {
            albedo: Albedo::Constant([0.8; 3]),
            border: Border::Periodic,
            specular: None,
        };
        let direct = vec![[1.0; 3]; field.heights_m().len()];
        let scene = Scene { field, surface, lights: lights() };
        let mut cells = Vec::new();
        for bounces in [1, 3] {
            let scatter = Scatter { bounces, paths: COUNT as u32, ..Scatter::default() };
            let (_, ms) = scattered(gpu, &scene, &points, &direct, &scatter)?;
            cells.push(format!("{ms:.2}"));
        }
        let mb = 4.0 * points.words().len() as f64 / 1e6;
        println!("| {name} | {mb:.1} | {found_ms:.2} | {} | {paper} |", cells.join(" | "));
    }
    println!();
    Ok(())
}
