//! What examples of lobes light and what by.

use std::path::Path;

use ridgelight::scene::{Environment, HeightField};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

/// A whole number of grid points a side, as it was asked for.
pub fn side_of(text: Option<String>, default: usize) -> Result<usize> {
    let side = text.as_ref().map_or(Ok(default), |text| text.parse());
    let found = text.unwrap_or_default();
    side.ok()
        .filter(|side| (2..=256).contains(side))
        .ok_or_else(|| Error::setting("SIDE", found, "a whole number from 2 to 256"))
}

/// The middle side² samples of the bundled mountain, so much steeper.
pub fn middle(side: usize, z_scale: f64) -> Result<HeightField> {
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), z_scale, ..HeightOptions::default() };
    let whole = files::read_heights(Path::new("assets/mt_washington_256.png"), &options)?;
    let first = (256 - side) / 2;
    let height = |i: usize| whole.heights_m()[(first + i / side) * 256 + first + i % side];
    let heights: Vec<f64> = (0..side * side).map(|i| f64::from(height(i))).collect();
    HeightField::new(side, side, &heights, whole.cell_m(), None)
}

/// The bundled sky, its texels cut at 20 times their mean: of so small a light as its sun harmonics keep next to nothing, and
/// suns belong in suns.
pub fn sky() -> Result<Environment> {
    let sky = files::read_environment(Path::new("assets/sky_512x256.hdr"), 0.0)?;
    let texels = sky.texels();
    let most = 20.0 * texels.as_flattened().iter().sum::<f32>() / (3 * texels.len()) as f32;
    let cut = texels.iter().map(|t| t.map(|v| v.min(most))).collect();
    Environment::new(sky.width(), sky.height(), cut, 0.0)
}
