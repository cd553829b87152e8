//! Fields and lights: the bundled ones, those of a folder with `height/` and `env/`, and parts of them.

use std::path::Path;

use ridgelight::scene::{Albedo, Border, Environment, HeightField, Lights, Scene, Sun, Surface};
use ridgelight::{Error, Result};
use ridgelight_io::{HeightOptions, read_environment, read_heights};

use super::args::Args;

pub const MOUNTAIN: &str = "assets/mt_washington_256.png";
pub const SKY: &str = "assets/sky_512x256.hdr";
pub const MOSS: &str = "Moss001_1K_Displacement.png";
pub const RAINIER: &str = "mt_rainier_90m.tif";
pub const WHITE_MOUNTAINS: &str = "N44W072.hgt";
const MOUNTAIN_CELL_M: [f64; 2] = [66.0, 92.6];

/// The bundled mountain, `steeper` times as steep. PNG values are metres.
pub fn mountain(steeper: f64) -> Result<HeightField> {
    let cell_m = Some(MOUNTAIN_CELL_M);
    let options = HeightOptions { cell_m, z_scale: steeper, ..HeightOptions::default() };
    read_heights(Path::new(MOUNTAIN), &options)
}

/// The bundled sky, rotated counter-clockwise.
pub fn sky(rotation_rad: f64) -> Result<Environment> {
    read_environment(Path::new(SKY), rotation_rad)
}

/// The bundled sky, its texels at most 20 times their mean: SH keep next to nothing of a light as
/// small as its sun, which belongs in `suns`.
pub fn sky_without_sun() -> Result<Environment> {
    let sky = sky(0.0)?;
    let texels = sky.texels();
    let most = 20.0 * texels.as_flattened().iter().sum::<f32>() / (3 * texels.len()) as f32;
    let cut = texels.iter().map(|t| t.map(|v| v.min(most))).collect();
    Environment::new(sky.width(), sky.height(), cut, 0.0)
}

/// A sun of 0.53°; degrees counter-clockwise from east, and above the horizon.
pub fn sun(azimuth_deg: f64, elevation_deg: f64, irradiance: [f32; 3]) -> Sun {
    Sun {
        azimuth_rad: azimuth_deg.to_radians(),
        elevation_rad: elevation_deg.to_radians(),
        diameter_rad: 0.53_f64.to_radians(),
        irradiance,
    }
}

/// A field of a folder's `height/`, by its file's name. The moss spans 80 cells from black to white.
pub fn field_of(folder: &Path, name: &str) -> Result<HeightField> {
    let plain = HeightOptions::default();
    let options = match name {
        MOSS => HeightOptions { z_scale: 80.0 / 65535.0, cell_m: Some([1.0; 2]), ..plain },
        RAINIER => HeightOptions { cell_m: Some([64.0, 92.6]), nodata: Some(-32768.0), ..plain },
        "mt_washington_256.png" => HeightOptions { cell_m: Some(MOUNTAIN_CELL_M), ..plain },
        _ => plain,
    };
    read_heights(&folder.join("height").join(name), &options)
}

/// An environment of a folder's `env/`.
pub fn environment_of(folder: &Path, name: &str) -> Result<Environment> {
    read_environment(&folder.join("env").join(name), 0.0)
}

/// The field of FIELD and `--cell X,Y`.
pub fn requested_field(args: &mut Args) -> Result<HeightField> {
    let cell_m = match args.value::<String>("--cell")? {
        None => None,
        Some(text) => {
            let sides: Vec<f64> = text.split(',').filter_map(|part| part.parse().ok()).collect();
            let wrong = |_| Error::setting("--cell", text, "two numbers: X,Y");
            Some(sides.try_into().map_err(wrong)?)
        }
    };
    let path = args.word().ok_or_else(|| Error::setting("FIELD", "nothing", "a height field"))?;
    read_heights(Path::new(&path), &HeightOptions { cell_m, ..HeightOptions::default() })
}

/// The middle of a field, at most `side`² grid points, with its voids.
pub fn cut(field: &HeightField, side: usize) -> Result<HeightField> {
    let [rows, cols] = [field.rows(), field.cols()].map(|n| n.min(side));
    let [top, left] = [(field.rows() - rows) / 2, (field.cols() - cols) / 2];
    let of = |i: usize| (top + i / cols) * field.cols() + left + i % cols;
    let heights: Vec<f64> = (0..rows * cols).map(|i| f64::from(field.heights_m()[of(i)])).collect();
    let voids = field.voids().map(|voids| (0..rows * cols).map(|i| voids[of(i)]).collect());
    HeightField::new(rows, cols, &heights, field.cell_m(), voids)
}

/// The middle of a field without its voids: their filled heights count as ground.
pub fn middle(field: &HeightField, side: usize) -> Result<HeightField> {
    let part = cut(field, side)?;
    let heights: Vec<f64> = part.heights_m().iter().map(|h| f64::from(*h)).collect();
    HeightField::new(part.rows(), part.cols(), &heights, part.cell_m(), None)
}

/// A field in cells of 1 m, its heights by row and column.
pub fn field(
    rows: usize,
    cols: usize,
    height: impl Fn(usize, usize) -> f64,
) -> Result<HeightField> {
    let heights: Vec<f64> = (0..rows * cols).map(|i| height(i / cols, i % cols)).collect();
    HeightField::new(rows, cols, &heights, [1.0; 2], None)
}

/// A field under some lights.
pub fn lit_by(field: HeightField, lights: Lights) -> Scene {
    Scene { field, surface: Surface::default(), lights }
}

/// A field under one environment.
pub fn under(field: HeightField, environment: Environment) -> Scene {
    lit_by(field, Lights { environment: Some(environment), ..Lights::default() })
}

pub fn matte(albedo: [f32; 3], border: Border) -> Surface {
    Surface { albedo: Albedo::Constant(albedo), border, specular: None }
}

/// A grid point for each k: multiples of the golden ratio, no two near each other.
pub fn spread(k: usize, count: usize) -> usize {
    ((k as f64 * 0.618_033_988_749_895).fract() * count as f64) as usize
}
