//! Inputs that are no numbers, or beyond what is accepted: each refused in a sentence that names the place.

use ridgelight::Result;
use ridgelight::scene::{Albedo, Environment, HeightField, Lights, Sun, Surface};

/// An input, a function that passes it, and the sentence that refuses it.
pub type Input = (&'static str, fn() -> Result<()>, &'static str);

/// Every input that is refused. A new one is enrolled by an entry here.
pub const ALL: &[Input] = &[
    (
        "a height of NaN",
        || height(f64::NAN),
        "height at row 1, column 2: found NaN, expected a finite number within ±1e15, or one marked as no-data (`nodata`)",
    ),
    (
        "an infinite height",
        || height(f64::INFINITY),
        "height at row 1, column 2: found inf, expected a finite number within ±1e15, or one marked as no-data (`nodata`)",
    ),
    (
        "an infinite depth",
        || height(f64::NEG_INFINITY),
        "height at row 1, column 2: found -inf, expected a finite number within ±1e15, or one marked as no-data (`nodata`)",
    ),
    (
        "a height of 2e15",
        || height(2e15),
        "height at row 1, column 2: found 2000000000000000.0, expected a finite number within ±1e15, or one marked as no-data (`nodata`)",
    ),
    (
        "nothing but voids",
        || HeightField::new(1, 2, &[f64::NAN; 2], [1.0; 2], Some(vec![true; 2])).map(|_| ()),
        "heights: found nothing but no-data, expected at least one height",
    ),
    (
        "no texels",
        || HeightField::new(0, 3, &[], [1.0; 2], None).map(|_| ()),
        "heights: found 0 values for 0 rows and 3 columns, expected rows × columns values, at least one",
    ),
    (
        "a cell of NaN",
        || cell(f64::NAN),
        "cell size: found 1 × NaN, expected two lengths from 1e-12 to 1e12",
    ),
    (
        "a cell of 0",
        || cell(0.0),
        "cell size: found 1 × 0, expected two lengths from 1e-12 to 1e12",
    ),
    (
        "an infinite cell",
        || cell(f64::INFINITY),
        "cell size: found 1 × inf, expected two lengths from 1e-12 to 1e12",
    ),
    (
        "an environment with a NaN",
        || texel(f32::NAN),
        "environment at row 1, column 3: found [1.0, NaN, 1.0], expected finite radiance, 0 or more",
    ),
    (
        "an infinite environment",
        || texel(f32::INFINITY),
        "environment at row 1, column 3: found [1.0, inf, 1.0], expected finite radiance, 0 or more",
    ),
    (
        "a negative environment",
        || texel(-1.0),
        "environment at row 1, column 3: found [1.0, -1.0, 1.0], expected finite radiance, 0 or more",
    ),
    (
        "a sky of NaN",
        || Lights { sky: Some([f32::NAN, 0.0, 0.0]), ..Lights::default() }.check(),
        "sky radiance: found [NaN, 0.0, 0.0], expected numbers from 0 to 1e36",
    ),
    (
        "a sun below the ground",
        || sun(|s| s.elevation_rad = -0.5_f64.to_radians()),
        "sun 1: elevation: found -0.5°, expected 0° to 90°",
    ),
    (
        "a sun at an elevation of NaN",
        || sun(|s| s.elevation_rad = f64::NAN),
        "sun 1: elevation: found NaN°, expected 0° to 90°",
    ),
    (
        "a sun at an infinite azimuth",
        || sun(|s| s.azimuth_rad = f64::INFINITY),
        "sun 1: azimuth: found inf, expected an angle within ±1e6 radians",
    ),
    (
        "an infinite sun",
        || sun(|s| s.irradiance = [f32::INFINITY; 3]),
        "sun 1: irradiance: found [inf, inf, inf], expected numbers from 0 to 1e36",
    ),
    (
        "an albedo above 1",
        || albedo(Albedo::Constant([0.5, 1.5, 0.5])),
        "albedo: found [0.5, 1.5, 0.5], expected channels from 0 to 1",
    ),
    (
        "an albedo map with a NaN",
        || albedo(Albedo::Map(vec![[0.5; 3], [f32::NAN; 3]])),
        "albedo map, texel 1: found [NaN, NaN, NaN], expected channels from 0 to 1",
    ),
];

/// The refusal of an input.
pub fn said(offer: fn() -> Result<()>) -> String {
    offer().map_or_else(|e| e.to_string(), |()| "nothing: it was taken".to_owned())
}

/// Level ground in which row 1, column 2 has another height.
fn height(odd: f64) -> Result<()> {
    let mut heights = [5.0; 12];
    heights[6] = odd;
    HeightField::new(3, 4, &heights, [1.0, 1.0], None).map(|_| ())
}

fn cell(north_m: f64) -> Result<()> {
    HeightField::new(1, 2, &[0.0, 1.0], [1.0, north_m], None).map(|_| ())
}

/// An environment in which row 1, column 3 has another green.
fn texel(odd: f32) -> Result<()> {
    let mut texels = vec![[1.0; 3]; 8];
    texels[7][1] = odd;
    Environment::new(4, 2, texels, 0.0).map(|_| ())
}

fn sun(change: fn(&mut Sun)) -> Result<()> {
    let mut sun =
        Sun { azimuth_rad: 0.0, elevation_rad: 1.0, diameter_rad: 0.0, irradiance: [1.0; 3] };
    change(&mut sun);
    Lights { suns: vec![sun], ..Lights::default() }.check()
}

fn albedo(albedo: Albedo) -> Result<()> {
    Surface { albedo, ..Surface::default() }.check(2)
}
