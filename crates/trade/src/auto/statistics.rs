use super::FEATURES;
use ridgelight::scene::{Environment, HeightField, Lights, Scene};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::Oracle;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Texels over which the occluded light is averaged; columns and rows of the map of lights there.
const PLACES: usize = 128;
const COLUMNS: usize = 64;
const ROWS: usize = 16;
/// Distance, in texels, of the slopes of the large forms.
const FAR: usize = 8;

/// Statistics that predict the difficulty of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// Root mean square of the occluded light over the mean of the unoccluded, 0 or more.
    pub hidden: f64,
    /// Root mean square slope between neighbouring grid points, rise over run.
    pub slope: f64,
    /// The same over that between grid points 8 apart: the share of fine forms in the spectrum.
    pub roughness: f64,
    /// Highest less lowest height over the longer side.
    pub relief: f64,
    /// Standard deviation over azimuth of the environment's light on level ground, over the mean of
    /// all lights.
    pub azimuth_contrast: f64,
    /// The same over elevation.
    pub elevation_contrast: f64,
    /// Share of the suns and key lights in all light on unoccluded level ground, [0..1].
    pub sun_share: f64,
    /// Mean angular diameter of the suns and width of the key lights, radians; 0 without.
    pub sun_diameter_rad: f64,
}

impl Statistics {
    /// Reads all heights and texels once, and traces 64 azimuths from 128 grid points.
    pub fn of(scene: &Scene) -> Self {
        let field = &scene.field;
        let slope = slope_of(field, 1);
        let has_far = field.rows().max(field.cols()) > FAR;
        let far = if has_far { slope_of(field, FAR) } else { slope };
        let heights = || field.heights_m().iter().copied();
        let (low, high) = (heights().fold(f32::MAX, f32::min), heights().fold(f32::MIN, f32::max));
        let [cell_x, cell_y] = field.cell_m();
        let side = (field.cols() as f64 * cell_x).max(field.rows() as f64 * cell_y);
        let lights = &scene.lights;
        let sky = lights.sky.map_or(0.0, grey);
        let suns = lights.suns.iter().map(|s| grey(s.irradiance) * s.elevation_rad.sin() / PI);
        let keys = lights.keys.iter().map(|k| grey(k.radiance) * k.level_irradiance() / PI);
        let suns: f64 = suns.chain(keys).sum();
        let env = lights.environment.as_ref().map_or([0.0; 3], contrasts);
        let all = (sky + suns + env[0]).max(f64::MIN_POSITIVE);
        let diameters = lights.suns.iter().map(|s| s.diameter_rad);
        let widths = lights.keys.iter().map(|k| k.width_rad);
        let count = (lights.suns.len() + lights.keys.len()).max(1) as f64;
        Self {
            hidden: hidden(scene),
            slope,
            roughness: if far > 0.0 { slope / far } else { 1.0 },
            relief: f64::from(high - low) / side,
            azimuth_contrast: env[1] / all,
            elevation_contrast: env[2] / all,
            sun_share: suns / all,
            sun_diameter_rad: diameters.chain(widths).sum::<f64>() / count,
        }
    }

    /// Features for the model: logarithms, of order 1.
    pub fn features(&self) -> [f64; FEATURES] {
        let ln = |x: f64| x.clamp(1e-4, 1e4).ln();
        [
            ln(self.hidden),
            ln(self.slope),
            ln(self.roughness),
            ln(self.relief),
            self.azimuth_contrast.ln_1p(),
            self.elevation_contrast.ln_1p(),
            self.sun_share,
            ln(self.sun_diameter_rad),
        ]
    }
}

/// Root mean square of the occluded light over the mean of the unoccluded, by horizons at the
/// centres of a coarse map's columns.
fn hidden(scene: &Scene) -> f64 {
    let (field, border) = (&scene.field, scene.surface.border);
    let (oracle, map) = (Oracle::new(field, border), radiance(&scene.lights));
    let count = field.rows() * field.cols();
    let (mut squares, mut sum) = (0.0, 0.0);
    let places = PLACES.min(count);
    for k in 0..places {
        let place = golden(k, count);
        let (row, col) = (place / field.cols(), place % field.cols());
        let normal = light::normal(field, border, row, col);
        let (mut kept_out, mut let_in) = (0.0, 0.0);
        for (column, radiances) in map.chunks(ROWS).enumerate() {
            let azimuth = TAU * (column as f64 + 0.5) / COLUMNS as f64;
            let (sin, cos) = azimuth.sin_cos();
            let across = normal.x * cos + normal.y * sin;
            let own = (-across).atan2(normal.z).max(0.0);
            let horizon = oracle.elevation_rad(row, col, azimuth).max(own);
            for (i, radiance) in radiances.iter().enumerate() {
                let [low, high] = [i, i + 1].map(|i| FRAC_PI_2 * i as f64 / ROWS as f64);
                let above = |edge: f64| light::slice(across, normal.z, low.max(edge), high);
                let_in += radiance * above(horizon);
                kept_out += radiance * (above(own) - above(horizon));
            }
        }
        squares += kept_out * kept_out / places as f64;
        sum += let_in / places as f64;
    }
    if squares > 0.0 { squares.sqrt() / sum.max(f64::MIN_POSITIVE) } else { 0.0 }
}

/// Radiance of all lights above horizontal, mean of the colours: columns counter-clockwise from
/// east, rows of each up from horizontal. A sun fills the cell of its centre, a key light its share
/// of each.
fn radiance(lights: &Lights) -> Vec<f64> {
    let sky = lights.sky.map_or(0.0, grey);
    let mut map = vec![sky; COLUMNS * ROWS];
    let column =
        |azimuth: f64| ((azimuth.rem_euclid(TAU) / TAU * COLUMNS as f64) as usize).min(COLUMNS - 1);
    let row = |elevation: f64| ((elevation / FRAC_PI_2 * ROWS as f64) as usize).min(ROWS - 1);
    if let Some(environment) = &lights.environment {
        let (width, height) = (environment.width(), environment.height());
        let mut sums = vec![[0.0; 2]; map.len()];
        for (i, texel) in environment.texels().iter().enumerate().take(height.div_ceil(2) * width) {
            let azimuth = PI - TAU * ((i % width) as f64 + 0.5) / width as f64;
            let elevation = FRAC_PI_2 - PI * ((i / width) as f64 + 0.5) / height as f64;
            let place =
                column(azimuth + environment.rotation_rad()) * ROWS + row(elevation.max(0.0));
            sums[place] = [sums[place][0] + grey(*texel), sums[place][1] + 1.0];
        }
        map.iter_mut().zip(sums).for_each(|(m, [sum, count])| *m += sum / f64::max(count, 1.0));
    }
    for sun in &lights.suns {
        let row = row(sun.elevation_rad);
        let edge = |i: usize| (FRAC_PI_2 * i as f64 / ROWS as f64).sin();
        let solid_angle = TAU / COLUMNS as f64 * (edge(row + 1) - edge(row));
        map[column(sun.azimuth_rad) * ROWS + row] += grey(sun.irradiance) / solid_angle;
    }
    for key in &lights.keys {
        let cell = [TAU / COLUMNS as f64, FRAC_PI_2 / ROWS as f64];
        let first = (key.azimuth_rad - key.width_rad / 2.0).rem_euclid(TAU);
        let [low, high] = key.elevations_rad;
        for (i, radiance) in map.iter_mut().enumerate() {
            let share = |cell: f64, at: usize, [from, to]: [f64; 2]| {
                let [begins, ends] = [at, at + 1].map(|at| cell * at as f64);
                ((ends.min(to) - begins.max(from)) / cell).max(0.0)
            };
            // A light that crosses east is counted again from there.
            let turns = [0.0, TAU].map(|t| [first - t, first - t + key.width_rad]);
            let across: f64 = turns.iter().map(|part| share(cell[0], i / ROWS, *part)).sum();
            *radiance += grey(key.radiance) * across * share(cell[1], i % ROWS, [low, high]);
        }
    }
    map
}

fn grey(colour: [f32; 3]) -> f64 {
    colour.iter().map(|v| f64::from(*v)).sum::<f64>() / 3.0
}

/// Multiples of the golden ratio's share of the field: no two are close.
fn golden(k: usize, count: usize) -> usize {
    (((k + 1) as f64 * 0.618_033_988_749_895).fract() * count as f64) as usize
}

/// Root mean square slope between grid points `apart`, along rows and columns; 0 where there are
/// none.
fn slope_of(field: &HeightField, apart: usize) -> f64 {
    let (rows, cols, h) = (field.rows(), field.cols(), field.heights_m());
    let [cell_x, cell_y] = field.cell_m().map(|c| c * apart as f64);
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for (i, height) in h.iter().enumerate() {
        let mut add = |other: usize, run: f64| {
            sum += (f64::from(h[other] - height) / run).powi(2);
            count += 1.0;
        };
        if i % cols + apart < cols {
            add(i + apart, cell_x);
        }
        if i / cols + apart < rows {
            add(i + apart * cols, cell_y);
        }
    }
    (sum / count.max(1.0)).sqrt()
}

/// Light of an environment on level ground of albedo 1, and the standard deviations over azimuth
/// and over elevation of each column's and each row's light, in the same unit.
fn contrasts(environment: &Environment) -> [f64; 3] {
    let (width, height) = (environment.width(), environment.height());
    let (mut columns, mut rows) = (vec![0.0; width], Vec::new());
    // (sin²high - sin²low) of a row sums to 1 over the hemisphere: a constant sky gives its
    // radiance.
    for row in 0..height.div_ceil(2) {
        let edge = |r: usize| (FRAC_PI_2 - PI * r as f64 / height as f64).max(0.0).sin().powi(2);
        let weight = edge(row) - edge(row + 1);
        let texels = &environment.texels()[row * width..(row + 1) * width];
        let mut mean = 0.0;
        for (column, texel) in columns.iter_mut().zip(texels) {
            *column += weight * grey(*texel);
            mean += grey(*texel) / width as f64;
        }
        rows.push((weight, mean));
    }
    let mean = columns.iter().sum::<f64>() / width as f64;
    let azimuth = columns.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / width as f64;
    let elevation: f64 = rows.iter().map(|(w, m)| w * (m - mean).powi(2)).sum();
    [mean, azimuth.sqrt(), elevation.sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::auto::tests::lit_by;
    use ridgelight::scene::{KeyLight, Sun};

    /// A plane rising by 0.5 east: mean square of slopes along rows 0.25, along columns 0; the same
    /// roughness at both scales. Relief: 15 steps of 0.5 over a side of 16. Only its own tangent
    /// plane occludes it; a wall in it occludes more.
    #[test]
    fn a_ramp_has_the_slope_it_has() {
        let heights: Vec<f64> = (0..256).map(|i| 0.5 * (i % 16) as f64).collect();
        let of = |heights: &[f64]| {
            let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
            Statistics::of(&lit_by(lights, [16; 2], |i| heights[i]))
        };
        let s = of(&heights);
        assert!((s.slope - 0.125_f64.sqrt()).abs() < 1e-6, "{s:?}");
        assert!((s.roughness - 1.0).abs() < 1e-6 && (s.relief - 7.5 / 16.0).abs() < 1e-6);
        assert!(s.hidden < 1e-9, "{s:?}");
        assert_eq!([s.azimuth_contrast, s.sun_share, s.sun_diameter_rad], [0.0; 3]);
        assert!(s.features().iter().all(|f| f.is_finite()));
        let mut walled = heights;
        walled[7 * 16..8 * 16].fill(20.0);
        assert!(of(&walled).hidden > 0.1, "{:?}", of(&walled));
    }

    /// The map's light on level ground matches the lights: a sky its radiance, an environment its
    /// mean (every texel is in one cell), a sun irradiance · sin elevation / π at some elevation in
    /// a row of 5.6°: within 10 % at 30°.
    #[test]
    fn the_map_of_lights_has_their_light() {
        let texels = (0..64 * 32).map(|i| [i as f32 % 7.0; 3]).collect();
        let environment = Environment::new(64, 32, texels, 0.3).unwrap();
        let [mean, ..] = contrasts(&environment);
        let elevation_rad = 30_f64.to_radians();
        let sun = Sun { azimuth_rad: -2.0, elevation_rad, diameter_rad: 0.0, irradiance: [4.0; 3] };
        let level = |lights: Lights| -> f64 {
            let weight = |i: usize| (FRAC_PI_2 * i as f64 / ROWS as f64).sin().powi(2);
            let map = radiance(&lights);
            let of = |(i, r): (usize, &f64)| r * (weight(i % ROWS + 1) - weight(i % ROWS));
            map.iter().enumerate().map(of).sum::<f64>() / COLUMNS as f64
        };
        let none = Lights::default();
        assert!((level(Lights { sky: Some([2.0; 3]), ..none.clone() }) - 2.0).abs() < 1e-9);
        let lit = level(Lights { environment: Some(environment), ..none.clone() });
        assert!((lit / mean - 1.0).abs() < 1e-6, "{lit} {mean}");
        let lit = level(Lights { suns: vec![sun], ..none });
        let expected = 4.0 * elevation_rad.sin() / PI;
        assert!((lit / expected - 1.0).abs() < 0.1, "{lit} {expected}");
        // Across east and whole rows: exactly its light.
        let rows = FRAC_PI_2 / ROWS as f64;
        let key = KeyLight {
            azimuth_rad: 0.1,
            width_rad: 1.3,
            elevations_rad: [3.0 * rows, 7.0 * rows],
            radiance: [2.0; 3],
        };
        let lit = level(Lights { keys: vec![key], ..Lights::default() });
        let expected = 2.0 * key.level_irradiance() / PI;
        assert!((lit / expected - 1.0).abs() < 1e-9, "{lit} {expected}");
    }

    /// One of 8 columns has 8: mean 1, standard deviation √7; all rows are equal. A sun at 30° of
    /// irradiance 2π gives 1, half of all.
    #[test]
    fn an_environment_has_its_contrast() {
        let texels = (0..32).map(|i| if i % 8 == 3 { [8.0; 3] } else { [0.0; 3] }).collect();
        let environment = Environment::new(8, 4, texels, 0.0).unwrap();
        let [mean, azimuth, elevation] = contrasts(&environment);
        assert!((mean - 1.0).abs() < 1e-12 && (azimuth - 7.0_f64.sqrt()).abs() < 1e-12);
        assert!(elevation < 1e-6);
        let sun = Sun {
            azimuth_rad: 0.0,
            elevation_rad: 30_f64.to_radians(),
            diameter_rad: 0.01,
            irradiance: [std::f32::consts::TAU; 3],
        };
        let lights =
            Lights { environment: Some(environment), suns: vec![sun], ..Lights::default() };
        let s = Statistics::of(&lit_by(lights, [1; 2], |_| 3.0));
        assert!((s.sun_share - 0.5).abs() < 1e-6, "{s:?}");
        assert!((s.azimuth_contrast - 0.5 * 7.0_f64.sqrt()).abs() < 1e-6, "{s:?}");
    }
}
