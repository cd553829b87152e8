//! The f64 quadrature of direct and indirect light, against closed forms.

mod energy;
mod grooves;
mod paths;
mod pits;
mod profile;
mod sources;
mod table;
mod walk;

use ridgelight::scene::{HeightField, Scene};
use ridgelight_cpu::indirect::{Fineness, Picture, light};

use crate::field;
use crate::fields::under_sky;

const COARSE: Fineness = Fineness { azimuths: 32, divisions: 1, strips: 8 };

/// Hashed heights from 0 to `relief`.
fn rough(rows: usize, cols: usize, cell_m: [f64; 2], relief: f64) -> HeightField {
    field(rows, cols, cell_m, |r, c| {
        ((r * 7919 + c * 104_729 + r * c * 31) % 61) as f64 * relief / 61.0
    })
}

/// The first channel.
fn red(picture: &Picture) -> Vec<f64> {
    picture.iter().map(|rgb| rgb[0]).collect()
}

/// The first channel, for 0, 1, … bounces in all.
fn reds(scene: &Scene, bounces: usize, fineness: Fineness) -> Vec<Vec<f64>> {
    light(scene, bounces, fineness).unwrap().iter().map(red).collect()
}
