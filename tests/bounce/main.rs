//! The f64 truth for direct and bounced light against scenes whose answer has a closed form.

mod energy;
mod grooves;
#[path = "../naive/mod.rs"]
mod naive;
mod paths;
mod pits;
mod profile;
#[path = "../reference_page/mod.rs"]
mod reference_page;
#[path = "../scenes/mod.rs"]
mod scenes;
mod sources;
mod table;

use ridgelight::scene::{Albedo, Border, HeightField, Lights, Scene, Surface};
use ridgelight_cpu::indirect::{Fineness, Picture, light};

const BORDERS: [Border; 3] = [Border::Plane, Border::Open, Border::Periodic];

const COARSE: Fineness = Fineness { azimuths: 32, divisions: 1, strips: 8 };

/// A field from a function of (row, column).
fn field(
    rows: usize,
    cols: usize,
    cell_m: [f64; 2],
    h: impl Fn(usize, usize) -> f64,
) -> HeightField {
    let heights: Vec<f64> = (0..rows * cols).map(|i| h(i / cols, i % cols)).collect();
    HeightField::new(rows, cols, &heights, cell_m, None).unwrap()
}

/// Nothing special: hashed heights from 0 to `relief`.
fn rough(rows: usize, cols: usize, cell_m: [f64; 2], relief: f64) -> HeightField {
    field(rows, cols, cell_m, |r, c| {
        ((r * 7919 + c * 104_729 + r * c * 31) % 61) as f64 * relief / 61.0
    })
}

/// Under a sky of radiance 1, of one albedo.
fn under_sky(field: HeightField, border: Border, albedo: f32) -> Scene {
    Scene {
        field,
        surface: Surface { albedo: Albedo::Constant([albedo; 3]), border, specular: None },
        lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
    }
}

/// The first channel.
fn red(picture: &Picture) -> Vec<f64> {
    picture.iter().map(|rgb| rgb[0]).collect()
}

/// The first channel of all bounces up to 0, 1, …
fn reds(scene: &Scene, bounces: usize, fineness: Fineness) -> Vec<Vec<f64>> {
    light(scene, bounces, fineness).unwrap().iter().map(red).collect()
}
