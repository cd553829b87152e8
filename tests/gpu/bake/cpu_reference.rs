//! Passes of bakes: all borders, both sizes of words, lines and single texels, prime sides.

pub(crate) mod curved;
pub(crate) mod ellipses;
pub(crate) mod facets;
pub(crate) mod points;
pub(crate) mod scatter;

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use ridgelight::scene::{
    Albedo, Border, Curvature, Directions, HeightField, Lights, PhongSpecular, Quality, Scatter,
    Scene, Specular, Sun, Surface,
};

use crate::cpu_reference::{Case, Reference, Wanted, check_all, noisy_environment, rough};
use crate::{field, random};

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] = &[
    ("visible_points", points::visible_points),
    ("bent_directions", curved::bent_directions),
    ("fan_weights", curved::fan_weights),
    ("ellipse_fit", ellipses::ellipse_fit),
    ("facet_mask", facets::facet_mask),
    ("scatter_gather", scatter::scatter_gather),
];

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

/// With a void in its middle, which is filled: filled ground occludes and is visible.
fn holed() -> HeightField {
    let mut next = random(69);
    let heights: Vec<f64> = (0..130).map(|_| 7.0 * next()).collect();
    let voids =
        (0..130).map(|i| (3..7).contains(&(i / 13)) && (4..9).contains(&(i % 13))).collect();
    HeightField::new(10, 13, &heights, [3.0, 2.0], Some(voids)).expect("a field")
}

pub fn point_cases() -> Vec<Case> {
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
        on("points of one texel", rough(1, 1, 67), Border::Open, sphere(5)),
        on("points of one texel that repeats", rough(1, 1, 68), Border::Periodic, sphere(6)),
        on("points past voids", holed(), Border::Plane, sphere(12)),
        on("points in whole words", long(3, 257), Border::Plane, sphere(9)),
        on("points in whole words of a line", long(263, 1), Border::Periodic, sphere(8)),
    ]
}

/// `ellipse_fit`: all borders, both sizes of words, everything and nothing lit, directions over half a sphere and a
/// whole one.
pub fn ellipse_cases() -> Vec<Case> {
    let of = |name, field, border, directions| Case {
        wanted: Wanted::Ellipses(directions),
        ..on(name, field, border, sphere(4))
    };
    let above = |count| Directions::fibonacci(count, 0.0, 3).expect("directions");
    let bent = |name, field, border, directions, per_m| Case {
        wanted: Wanted::CurvedEllipses(directions, per_m),
        ..on(name, field, border, sphere(4))
    };
    // Shallow, of rounded hills: little is hidden that curvature would open.
    let hills = |rows, cols| {
        field(rows, cols, [1.0, 1.5], |r, c| (0.7 * r as f64).sin() + (0.4 * c as f64).cos())
    };
    let deep = field(9, 9, [1.0, 1.0], |r, c| if (r, c) == (4, 4) { 0.0 } else { 60.0 });
    let long = field(3, 257, [2.0, 2.0], |r, c| ((7 * r + 5 * c) % 11) as f64);
    // Rays from the bump on low hills reach others 100 to 300 cells away, past dozens of repetitions and near a right
    // angle of the base.
    let low = field(7, 40, [1.0, 1.5], |r, c| {
        let bump = if (r, c) == (3, 25) { 0.5 } else { 0.0 };
        0.05 * (TAU * c as f64 / 40.0).sin() + 0.03 * (TAU * r as f64 / 7.0).cos() + bump
    });
    let flat = (0..60).map(|k| {
        let z = [-0.05, -0.004, -0.002, -0.001, 0.4][k % 5];
        DVec2::from_angle(2.4 * k as f64).extend(z).normalize()
    });
    let flat = Directions::from_vectors(flat.collect(), -1.0).expect("unit vectors");
    // Steps 12 m apart in cells a millimetre wide: rays from the foot of one pass 10,000 columns and more to the next.
    // All columns are tested, as steps rise by as much as rays.
    let steps = field(12, 1, [1e-3, 1.0], |r, _| if r == 0 { 1.0 } else { 0.0 });
    let slant = (0..8).map(|k| {
        let k = f64::from(k);
        DVec3::new(1.1 + 0.03 * k, -1.0, 0.03 + 0.003 * k).normalize()
    });
    let slant: Vec<DVec3> = sphere(24).vectors().iter().copied().chain(slant).collect();
    let slant = Directions::from_vectors(slant, -1.0).expect("unit vectors");
    vec![
        bent(
            "ellipses past thousands of repetitions on curved bases",
            steps,
            Border::Periodic,
            slant,
            [1e-3, 1e-3],
        ),
        bent(
            "ellipses of what lies far on curved bases",
            low,
            Border::Periodic,
            flat,
            [0.01, 1e-3],
        ),
        bent(
            "ellipses of one column that repeats on curved bases",
            hills(11, 1),
            Border::Periodic,
            sphere(40),
            [1e-3, 1e-3],
        ),
        bent(
            "ellipses of two rows that repeat on curved bases",
            hills(2, 13),
            Border::Periodic,
            sphere(41),
            [1e-3, 1e-3],
        ),
        of("ellipses on a plane", rough(19, 13, 91), Border::Plane, above(64)),
        of("ellipses of an open field", rough(11, 17, 92), Border::Open, sphere(61)),
        of("ellipses of a field that repeats", rough(7, 11, 93), Border::Periodic, above(33)),
        of("ellipses of a shaft", deep, Border::Plane, above(16)),
        of("ellipses of whole words", long, Border::Plane, above(17)),
        of("an ellipse of one texel", rough(1, 1, 94), Border::Open, sphere(5)),
        bent("ellipses on curved bases", hills(11, 9), Border::Plane, sphere(40), [0.01, 1e-3]),
        bent(
            "ellipses of a field that repeats on curved bases",
            hills(9, 16),
            Border::Periodic,
            above(32),
            [1e-3, 2e-3],
        ),
    ]
}

/// `facet_mask`: all borders, words that are full and not, one periodic cell, steep ground, directions along the grid
/// and below horizontal.
pub fn facet_cases() -> Vec<Case> {
    let of = |name, field, border, directions| Case {
        wanted: Wanted::Facets(directions),
        ..on(name, field, border, sphere(4))
    };
    let above = |count| Directions::fibonacci(count, 0.0, 2).expect("directions");
    let steep = field(6, 5, [1.0, 2.0], |r, c| 40.0 * ((3 * r + 2 * c) % 5) as f64);
    vec![
        of("triangles on a plane", rough(9, 14, 101), Border::Plane, sphere(31)),
        of("triangles of an open field", rough(13, 8, 102), Border::Open, along_the_grid()),
        of("triangles that repeat", rough(7, 11, 103), Border::Periodic, above(30)),
        of("steep triangles", steep, Border::Periodic, above(16)),
        of("triangles past voids", holed(), Border::Plane, above(7)),
        of("one cell that repeats", rough(1, 1, 104), Border::Periodic, above(4)),
        of("one cell", rough(2, 2, 105), Border::Open, sphere(14)),
    ]
}

/// Towards a sun's middle.
pub fn towards(sun: &Sun) -> DVec3 {
    let (sin, cos) = sun.elevation_rad.sin_cos();
    DVec3::new(cos * sun.azimuth_rad.cos(), cos * sun.azimuth_rad.sin(), sin)
}

/// `scatter_gather`: one bounce, and several with more paths than fit side by side; split images, whole words;
/// specular under all lights, exponents of 1 and more.
pub fn scatter_cases() -> Vec<Case> {
    let scatter = |bounces, paths| Scatter { bounces, paths, seed: 5, ..Scatter::default() };
    let of = |name, field, surface, lights, wanted: (usize, Scatter, bool)| Case {
        name,
        scene: Scene { field, surface, lights },
        quality: Quality::default(),
        wanted: Wanted::Scatter(sphere(wanted.0), wanted.1, wanted.2),
        loses_lines: false,
    };
    let mut next = random(72);
    let map = Albedo::Map((0..72).map(|_| [next() as f32, 0.5, 0.9]).collect());
    let grey =
        |border| Surface { border, albedo: Albedo::Constant([0.6, 0.3, 0.9]), specular: None };
    let phong_maps =
        (0..72).map(|i| PhongSpecular { exponent: 1.0 + i as f32, scale: next() as f32 * 0.1 });
    let black = Surface { albedo: Albedo::Constant([0.0; 3]), ..Surface::default() };
    let mapped = Surface { border: Border::Open, albedo: map, specular: None };
    let shiny = Surface {
        border: Border::Plane,
        albedo: Albedo::Constant([0.4, 0.3, 0.2]),
        specular: Some(Specular::Map(phong_maps.collect())),
    };
    let sun = |azimuth_rad, elevation_rad| Sun {
        azimuth_rad,
        elevation_rad,
        diameter_rad: 0.0,
        irradiance: [3.0, 2.0, 1.0],
    };
    let lights = Lights {
        sky: Some([0.3, 0.5, 0.9]),
        environment: Some(noisy_environment(73)),
        suns: vec![sun(2.0, 0.4), sun(-1.0, 0.9), sun(0.3, 0.2)],
        ..Lights::default()
    };
    let none = Lights::default;
    let one = Surface {
        border: Border::Periodic,
        albedo: Albedo::Constant([0.5, 0.3, 0.2]),
        specular: Some(Specular::Constant(PhongSpecular { exponent: 20.0, scale: 0.4 })),
    };
    let long = field(3, 257, [2.0, 2.0], |r, c| ((7 * r + 5 * c) % 11) as f64);
    let bent = |bounces, paths, per_m| Scatter {
        curvature: Curvature { per_m },
        ..scatter(bounces, paths)
    };
    // One groove, whose sides see each other completely.
    let vault = || field(7, 9, [1.0, 1.0], |r, c| (c as f64 - 4.0).abs() + 0.01 * r as f64);
    vec![
        of("one bounce", rough(9, 8, 74), mapped, none(), (71, scatter(1, 70), false)),
        of("nothing", rough(9, 8, 74), black, none(), (11, scatter(2, 70), false)),
        of(
            "three bounces",
            rough(7, 9, 75),
            grey(Border::Periodic),
            none(),
            (13, scatter(3, 70), false),
        ),
        of("cut images", rough(8, 9, 76), grey(Border::Plane), none(), (9, scatter(2, 12), true)),
        of("whole words", long, grey(Border::Plane), none(), (6, scatter(2, 4), false)),
        of(
            "a bend outwards",
            vault(),
            grey(Border::Open),
            none(),
            (65, bent(2, 9, [0.08, 0.02]), false),
        ),
        of(
            "a bend inwards",
            vault(),
            grey(Border::Periodic),
            none(),
            (24, bent(1, 24, [-0.002, 0.001]), false),
        ),
        of(
            "lobes towards views",
            rough(8, 9, 77),
            shiny.clone(),
            lights.clone(),
            (17, Scatter { direct_specular: true, ..scatter(1, 20) }, false),
        ),
        of(
            "their own light alone",
            rough(8, 9, 79),
            shiny.clone(),
            lights.clone(),
            (17, Scatter { direct_specular: true, ..scatter(0, 12) }, false),
        ),
        of("lobes", rough(8, 9, 77), shiny, lights, (17, scatter(2, 20), false)),
        of("a lobe under nothing", rough(5, 7, 78), one, none(), (8, scatter(1, 9), false)),
    ]
}

#[test]
fn points_match() {
    check_all(&point_cases());
}

#[test]
fn scattered_light_matches() {
    check_all(&scatter_cases());
}

#[test]
fn ellipses_match() {
    check_all(&ellipse_cases());
}

#[test]
fn triangles_match() {
    check_all(&facet_cases());
}
