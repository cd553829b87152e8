//! The moss, coarser, so that it still repeats.

use std::path::Path;

use ridgelight::Result;
use ridgelight::scene::{Albedo, Border, HeightField, Lights, Scene, Surface};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

/// 80 cells of the file from black to white.
pub fn read(folder: &Path) -> Result<HeightField> {
    let options = HeightOptions {
        z_scale: 80.0 / 65535.0,
        cell_m: Some([1.0; 2]),
        ..HeightOptions::default()
    };
    files::read_heights(&folder.join("height/Moss001_1K_Displacement.png"), &options)
}

/// All of it as means over squares, 32 a side.
pub fn tile(folder: &Path) -> Result<Scene> {
    const SIDE: usize = 32;
    let whole = read(folder)?;
    let each = whole.cols() / SIDE;
    let mean = |i: usize| {
        let first = [i / SIDE * each, i % SIDE * each];
        let at = |k: usize| (first[0] + k / each) * whole.cols() + first[1] + k % each;
        (0..each * each).map(|k| f64::from(whole.heights_m()[at(k)])).sum::<f64>()
            / (each * each) as f64
    };
    let heights: Vec<f64> = (0..SIDE * SIDE).map(mean).collect();
    let field = HeightField::new(SIDE, SIDE, &heights, [each as f64; 2], None)?;
    let albedo = Albedo::Constant([0.55, 0.7, 0.25]);
    let surface = Surface { albedo, border: Border::Periodic, specular: None };
    Ok(Scene { field, surface, lights: Lights::default() })
}
