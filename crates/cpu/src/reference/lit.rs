//! All direct light at single grid points of a scene, in f64: the reference for images.

use crate::Rgb;
use crate::light::{self, ENVIRONMENT_STRIPS};
use crate::oracle::Oracle;
use crate::sphere::sphere_of;
use ridgelight::scene::{Environment, KeyLight, NearLight, Scene};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Azimuths of a sky, strips across a sun or a sphere light; the same across a key light, or the sky's density.
const AZIMUTHS: usize = 720;
const STRIPS: usize = 128;
/// Azimuths distributed among an environment's columns by their light, besides the fixed number of each.
const SHARED: f64 = 1024.0;

/// Grid points of a scene under all of its lights together.
#[derive(Clone, Debug)]
pub struct Lit<'a> {
    scene: &'a Scene,
    oracle: Oracle<'a>,
    columns: Option<Columns<'a>>,
    azimuths: usize,
    strips: usize,
}

impl<'a> Lit<'a> {
    /// Reads all heights and texels once.
    pub fn of(scene: &'a Scene) -> Self {
        let oracle = Oracle::new(&scene.field, scene.surface.border);
        let rows = |e: &Environment| e.rows_above_ground(scene.surface.border);
        let columns = scene.lights.environment.as_ref().map(|e| Columns::of(e, rows(e)));
        Self { scene, oracle, columns, azimuths: AZIMUTHS, strips: STRIPS }
    }

    /// The same with half of all rays: the difference estimates the error of the rays in between.
    pub fn halved(mut self) -> Self {
        (self.azimuths, self.strips) = (AZIMUTHS / 2, STRIPS / 2);
        if let Some(columns) = &mut self.columns {
            columns.parts.iter_mut().for_each(|p| *p = p.div_ceil(2));
        }
        self
    }

    /// Rays of one grid point.
    pub fn rays(&self) -> usize {
        let lights = &self.scene.lights;
        let sky = if lights.sky.is_some() { self.azimuths } else { 0 };
        let environment = self.columns.as_ref().map_or(0, |c| c.parts.iter().sum());
        let keys: usize = lights.keys.iter().map(|k| self.key_strips(k)).sum();
        sky + environment + (lights.suns.len() + lights.near().count()) * self.strips + keys
    }

    /// Exit radiance of a grid point including its albedo, linear RGB.
    pub fn at(&self, row: usize, col: usize) -> Rgb {
        let (lights, oracle) = (&self.scene.lights, &self.oracle);
        let sky = lights.sky.map(|colour| {
            let share = light::sky_of(oracle, row, col, self.azimuths);
            colour.map(|c| f64::from(c) * share)
        });
        let environment = self.columns.as_ref().map(|c| c.light(oracle, row, col));
        let suns = lights.suns.iter().map(|s| light::sun_of(oracle, row, col, s, self.strips));
        let keys =
            lights.keys.iter().map(|k| light::key_of(oracle, row, col, k, self.key_strips(k)));
        let near = lights.near().map(|NearLight { sphere, .. }| {
            let share = sphere_of(oracle, row, col, &sphere, self.strips);
            sphere.radiance.map(|c| f64::from(c) * share)
        });
        let albedo = light::albedo_at(&self.scene.surface, row * self.scene.field.cols() + col);
        let mut all = [0.0; 3];
        for light in sky.into_iter().chain(environment).chain(suns).chain(keys).chain(near) {
            (0..3).for_each(|c| all[c] += light[c] * albedo[c]);
        }
        all
    }

    /// Azimuths across a key light.
    fn key_strips(&self, key: &KeyLight) -> usize {
        ((self.azimuths as f64 * key.width_rad / TAU).ceil() as usize).max(self.strips)
    }
}

/// An environment by columns, each summed from the zenith down, so that the light above a horizon takes one lookup
/// instead of a loop over texels.
///
/// A slice of elevations gives a ∫cos² + b ∫sin cos (see [`light::slice`]): the texels' sums of both are kept
/// separately. Bright columns use many azimuths.
#[derive(Clone, Debug)]
struct Columns<'a> {
    environment: &'a Environment,
    rows: usize,
    /// Of each column, `rows` + 1 entries: sums of what lies above the row, for a and for b.
    sums: Vec<[[f32; 3]; 2]>,
    /// Azimuths of each.
    parts: Vec<usize>,
}

impl<'a> Columns<'a> {
    fn of(environment: &'a Environment, rows: usize) -> Self {
        let (width, height) = (environment.width(), environment.height());
        let elevation = |row: usize| FRAC_PI_2 - PI * row as f64 / height as f64;
        let bands: Vec<[f64; 2]> = (0..rows)
            .map(|r| {
                let (low, high) = (elevation(r + 1), elevation(r));
                [light::slice(1.0, 0.0, low, high), light::slice(0.0, 1.0, low, high)]
            })
            .collect();
        let mut sums = Vec::with_capacity(width * (rows + 1));
        let mut given = Vec::with_capacity(width);
        for col in 0..width {
            let mut sum = [[0.0_f64; 3]; 2];
            sums.push([[0.0_f32; 3]; 2]);
            for (row, band) in bands.iter().enumerate() {
                let texel = environment.texels()[row * width + col];
                for (sum, band) in sum.iter_mut().zip(band) {
                    sum.iter_mut().zip(texel).for_each(|(s, t)| *s += f64::from(t) * band);
                }
                sums.push(sum.map(|c| c.map(|v| v as f32)));
            }
            given.push(sum.iter().flatten().map(|v| v.abs()).sum::<f64>());
        }
        let all = given.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let least = ENVIRONMENT_STRIPS.div_ceil(width);
        let parts = given.iter().map(|g| least.max((SHARED * g / all).round() as usize)).collect();
        Self { environment, rows, sums, parts }
    }

    /// Exit radiance of a white diffuse grid point, linear RGB: in each column's azimuths at the centres of equal
    /// parts of it, clipped at the horizon exactly.
    fn light(&self, oracle: &Oracle, row: usize, col: usize) -> Rgb {
        let (width, height) = (self.environment.width(), self.environment.height());
        let [receiver] = light::diffuse_at(oracle, row, col);
        let mut all = [0.0; 3];
        for (column, &parts) in self.parts.iter().enumerate() {
            let weight = 2.0 / (width * parts) as f64;
            for part in 0..parts {
                let across = column as f64 + (part as f64 + 0.5) / parts as f64;
                let azimuth = PI - TAU * across / width as f64 + self.environment.rotation_rad();
                let lit = light::lit(oracle, [row, col], receiver, azimuth);
                let low = ((FRAC_PI_2 - lit.low) / PI * height as f64).max(0.0);
                let above = (low as usize).min(self.rows);
                let [a, b] = self.sums[column * (self.rows + 1) + above];
                let cut = if above < self.rows {
                    lit.light(lit.low, FRAC_PI_2 - PI * above as f64 / height as f64)
                } else {
                    0.0
                };
                let texel = self.environment.texels()[above.min(self.rows - 1) * width + column];
                for (c, sum) in all.iter_mut().enumerate() {
                    let whole = lit.a * f64::from(a[c]) + lit.b * f64::from(b[c]);
                    *sum += weight * (whole + f64::from(texel[c]) * cut);
                }
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Site;
    use ridgelight::scene::{Border, HeightField, Lights, Surface};

    const SIDE: usize = 9;

    fn scene(border: Border, environment: Environment) -> Scene {
        let heights: Vec<f64> = (0..SIDE * SIDE).map(|i| ((i * i) % 11) as f64 * 0.4).collect();
        Scene {
            field: HeightField::new(SIDE, SIDE, &heights, [1.0, 1.5], None).unwrap(),
            surface: Surface { border, ..Surface::default() },
            lights: Lights { environment: Some(environment), ..Lights::default() },
        }
    }

    /// Columns alike have azimuths alike: 16 of 64 each are those of the sum over texels, and the light
    /// is equal but for f32's rounding of the sums. Odd heights cut the row at the horizon.
    #[test]
    fn columns_give_the_light_of_their_texels() {
        for (border, height) in [(Border::Plane, 7), (Border::Open, 6), (Border::Periodic, 8)] {
            let texel = |i: usize| [(i / 16) as f32 + 0.5, 2.0, (i / 16 % 3) as f32];
            let texels = (0..16 * height).map(texel).collect();
            let environment = Environment::new(16, height, texels, 0.4).unwrap();
            let scene = scene(border, environment.clone());
            let lit = Lit::of(&scene);
            assert_eq!(lit.rays(), 1024);
            for (row, col) in [(0, 0), (4, 4), (8, 3), (2, 7)] {
                let oracle = Oracle::new(&scene.field, border);
                let receivers = light::diffuse_at(&oracle, row, col);
                let all = Site::of(&oracle, [row, col], &receivers).environment(&environment, 64);
                for (got, want) in lit.at(row, col).iter().zip(all[0]) {
                    assert!((got - want).abs() < 1e-6 * (1.0 + want), "{got} {want}");
                }
            }
        }
    }

    /// Nearly all light comes of one column of 16: it has nearly all the azimuths that are shared out, and
    /// the light is that of 1024 azimuths in every column. Both are within a part's share of it, 1/1024.
    #[test]
    fn bright_columns_are_looked_along_often() {
        let bright = |i: usize| if i == 16 + 5 { [1e5; 3] } else { [0.5; 3] };
        let environment = Environment::new(16, 6, (0..16 * 6).map(bright).collect(), 0.0).unwrap();
        let scene = scene(Border::Plane, environment.clone());
        let lit = Lit::of(&scene);
        assert!((1024 + 15 * 32..1024 + 16 * 33).contains(&lit.rays()), "{}", lit.rays());
        let oracle = Oracle::new(&scene.field, Border::Plane);
        for place in [10, 40, 44, 70] {
            let (row, col) = (place / SIDE, place % SIDE);
            let receivers = light::diffuse_at(&oracle, row, col);
            let want = Site::of(&oracle, [row, col], &receivers).environment(&environment, 1024);
            let free = 2.0 / 16.0 * 1e5;
            let got = lit.at(row, col)[0];
            assert!((got - want[0][0]).abs() < free / 1024.0, "{got} {}", want[0][0]);
        }
    }
}
