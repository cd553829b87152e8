//! The scene and the arguments of the host programs in Rust.

use std::ffi::OsString;

use ridgelight::scene::{HeightField, Lights, Scene, Sun, Surface};

/// Rows of the scene.
pub const ROWS: usize = 48;
/// Its columns.
pub const COLS: usize = 64;

/// Heights of small whole numbers under a sky and a sun in the east.
pub fn scene() -> ridgelight::Result<Scene> {
    let height = |i: usize| ((i / COLS * 31 + i % COLS * 17) % 7) as f64 - 3.0;
    let heights: Vec<f64> = (0..ROWS * COLS).map(height).collect();
    let field = HeightField::new(ROWS, COLS, &heights, [1.0; 2], None)?;
    let sun = Sun {
        azimuth_rad: 0.0,
        elevation_rad: 30_f64.to_radians(),
        diameter_rad: 0.5_f64.to_radians(),
        irradiance: [3.0; 3],
    };
    let lights = Lights { sky: Some([0.5; 3]), suns: vec![sun], ..Lights::default() };
    Ok(Scene { field, surface: Surface::default(), lights })
}

/// A number of frames, one by default.
pub fn frames(word: Option<OsString>) -> Result<u32, Box<dyn std::error::Error>> {
    let frames = word.map_or(Ok(1), |word| word.to_string_lossy().parse())?;
    if frames == 0 { Err("0 frames: expected at least 1".into()) } else { Ok(frames) }
}
