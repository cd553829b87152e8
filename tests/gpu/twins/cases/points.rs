//! What samples see: all borders, both kinds of words, lines and single samples, prime sides.

use glam::DVec3;
use ridgelight::scene::{Border, Directions, HeightField, Lights, Quality, Scene, Surface};

use super::{Case, Wanted, rough};
use crate::field;

fn on(name: &'static str, field: HeightField, border: Border, directions: Directions) -> Case {
    let surface = Surface { border, ..Surface::default() };
    let scene = Scene { field, surface, lights: Lights::default() };
    let wanted = Wanted::Points(directions);
    Case { name, scene, quality: Quality::default(), wanted, loses_lines: false }
}

fn sphere(count: usize) -> Directions {
    Directions::fibonacci(count, -1.0, 1).expect("directions")
}

/// Along rows, columns and diagonals, level and steep, straight up and down.
fn along_the_grid() -> Directions {
    let mut all = vec![DVec3::Z, -DVec3::Z];
    for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, -1.0), (-1.0, 1.0)] {
        for z in [0.3, -0.3, 1e-3] {
            all.push(DVec3::new(x, y, z).normalize());
        }
    }
    Directions::from_vectors(all, -1.0).expect("unit vectors")
}

pub fn points() -> Vec<Case> {
    let long = |rows: usize, cols: usize| {
        field(rows, cols, [2.0, 2.0], |r, c| ((7 * r + 5 * c) % 11) as f64 + 0.1 * c as f64)
    };
    vec![
        on("points on a plane", rough(23, 29, 61), Border::Plane, sphere(33)),
        on("points of an open field", rough(17, 31, 62), Border::Open, sphere(24)),
        on("points of a field that repeats", rough(7, 11, 63), Border::Periodic, sphere(40)),
        on("points along the grid", rough(9, 8, 64), Border::Open, along_the_grid()),
        on("points of a line", rough(1, 29, 65), Border::Plane, sphere(16)),
        on("points of a column that repeats", rough(13, 1, 66), Border::Periodic, sphere(16)),
        on("points of one sample", rough(1, 1, 67), Border::Open, sphere(5)),
        on("points of one sample that repeats", rough(1, 1, 68), Border::Periodic, sphere(6)),
        on("points in whole words", long(3, 257), Border::Plane, sphere(9)),
        on("points in whole words of a line", long(263, 1), Border::Periodic, sphere(8)),
    ]
}
