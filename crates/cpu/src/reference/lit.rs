//! All direct light at single grid points of a scene, in f64: the reference for images.

use crate::Rgb;
use crate::light::{self, ENVIRONMENT_STRIPS, Receiver, Site};
use crate::maxima::Maxima;
use crate::oracle::Oracle;
use crate::phong_integral::PhongIntegral;
use crate::sphere::strips_of;
use glam::DVec3;
use ridgelight::scene::{Border, Environment, KeyLight, NearLight, Scene, Specular};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Azimuths of a sky, strips across a sun or a sphere light; the same across a key light, or the sky's density.
const AZIMUTHS: usize = 720;
const STRIPS: usize = 128;
/// Time of the powers and arc tangents of a lobe in one azimuth, in reads from its table.
const SLICE_POINTS: usize = 16;
/// Azimuths distributed among an environment's columns by their light, besides the fixed number of each.
const SHARED: f64 = 1024.0;

/// Grid points of a scene under all of its lights together.
#[derive(Clone, Debug)]
pub struct Lit<'a> {
    scene: &'a Scene,
    eye_m: Option<DVec3>,
    oracle: Oracle<'a>,
    /// Of the oracle's field, where that is not repeated. Clones share them.
    maxima: Option<Arc<Maxima>>,
    columns: Option<Columns<'a>>,
    /// The table of the Phong lobe, where all grid points share one lobe.
    phong: Option<PhongIntegral>,
    azimuths: usize,
    strips: usize,
}

impl<'a> Lit<'a> {
    /// Reads all heights a few times and all texels once.
    pub fn of(scene: &'a Scene) -> Self {
        let oracle = Oracle::new(&scene.field, scene.surface.border);
        let is_repeated = scene.surface.border == Border::Periodic;
        let maxima = (!is_repeated).then(|| Arc::new(Maxima::of(&oracle)));
        let rows = |e: &Environment| e.rows_above_ground(scene.surface.border);
        let columns = scene.lights.environment.as_ref().map(|e| Columns::of(e, rows(e)));
        let phong = match &scene.surface.specular {
            Some(Specular::Constant(phong)) => Some(PhongIntegral::of(phong.exponent.into())),
            Some(Specular::Map(_)) | None => None,
        };
        let (azimuths, strips) = (AZIMUTHS, STRIPS);
        Self { scene, eye_m: None, oracle, maxima, columns, phong, azimuths, strips }
    }

    /// Specular viewed from [`Picture::eye_m`](ridgelight::plan::Picture::eye_m).
    pub fn viewed_from(self, eye_m: Option<[f64; 3]>) -> Self {
        Self { eye_m: eye_m.map(DVec3::from_array), ..self }
    }

    /// The same with half of all rays: the difference estimates the error of the rays in between. A clone and its half
    /// share the environment's texels.
    pub fn halved(mut self) -> Self {
        (self.azimuths, self.strips) = (AZIMUTHS / 2, STRIPS / 2);
        if let Some(columns) = &mut self.columns {
            columns.parts.iter_mut().for_each(|p| *p = p.div_ceil(2));
        }
        self
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Rays of one grid point.
    pub fn rays(&self) -> usize {
        let lights = &self.scene.lights;
        let keys: usize = lights.keys.iter().map(|k| self.key_strips(k)).sum();
        let strips = (lights.suns.len() + lights.near().count()) * self.strips + keys;
        self.sky_rays() + self.environment_rays() + strips
    }

    /// Approximate number of reads from the table of a Phong lobe at one grid point.
    pub fn specular_points(&self) -> usize {
        let largest = self.scene.surface.specular.as_ref().map(Specular::largest);
        let Some(phong) = largest.filter(|phong| phong.scale > 0.0) else { return 0 };
        let in_column = self.columns.as_ref().map_or(0, |columns| {
            let half_rad = light::phong_half_rad(phong.exponent.into());
            let across = 2.0 * half_rad / PI * columns.environment.height() as f64;
            columns.rows.min(across.ceil() as usize)
        });
        let rays = self.sky_rays() + self.environment_rays();
        rays * SLICE_POINTS + self.environment_rays() * in_column
    }

    fn sky_rays(&self) -> usize {
        if self.scene.lights.sky.is_some() { self.azimuths } else { 0 }
    }

    fn environment_rays(&self) -> usize {
        self.columns.as_ref().map_or(0, |columns| columns.parts.iter().sum())
    }

    /// Exit radiance of a grid point including its albedo and specular, linear RGB.
    pub fn at(&self, row: usize, col: usize) -> Rgb {
        let (lights, oracle) = (&self.scene.lights, &self.oracle);
        let (place, index) = ([row, col], row * self.scene.field.cols() + col);
        let [diffuse] = light::diffuse_at(oracle, row, col);
        let mut receivers = vec![(diffuse, light::albedo_at(&self.scene.surface, index))];
        let specular = self.scene.surface.specular.as_ref().map(|specular| specular.at(index));
        if let Some(phong) = specular.filter(|phong| phong.scale > 0.0) {
            let mirrored =
                Receiver::specular(diffuse.normal, self.view(place), phong.exponent.into());
            receivers.push((mirrored, [f64::from(phong.scale); 3]));
        }
        let mut all = [0.0; 3];
        let (receivers, scales): (Vec<_>, Vec<_>) = receivers.into_iter().unzip();
        let site = Site::of(oracle, place, &receivers).skipping(self.maxima.as_deref());
        let mut add = |light: Vec<Rgb>| {
            for (light, scale) in light.iter().zip(&scales) {
                (0..3).for_each(|c| all[c] += light[c] * scale[c]);
            }
        };
        let coloured = |shares: Vec<f64>, colour: [f32; 3]| {
            shares.into_iter().map(|share| colour.map(|c| f64::from(c) * share)).collect()
        };
        if lights.sky.is_some() || self.columns.is_some() {
            let integrals = self.phong_integrals(site);
            if let Some(colour) = lights.sky {
                add(coloured(site.sky_by(self.azimuths, &integrals), colour));
            }
            if let Some(columns) = &self.columns {
                add(columns.light(site, &integrals));
            }
        }
        lights.suns.iter().for_each(|sun| add(site.sun(sun, self.strips)));
        for key in &lights.keys {
            add(coloured(site.key(key, self.key_strips(key)), key.radiance));
        }
        for NearLight { sphere, .. } in lights.near() {
            let strips = strips_of(oracle.field(), place, &sphere, self.strips);
            add(coloured(site.sphere(&sphere, strips), sphere.radiance));
        }
        all
    }

    /// [`Site::phong_integrals`], with a shared table where there is one.
    fn phong_integrals(&self, site: Site<'_>) -> Vec<Option<PhongIntegral>> {
        let Some(phong) = &self.phong else { return site.phong_integrals() };
        let of = |receiver: &Receiver| receiver.phong_lobe.map(|_| phong.clone());
        site.receivers.iter().map(of).collect()
    }

    /// The direction from a grid point towards the eye.
    fn view(&self, [row, col]: [usize; 2]) -> DVec3 {
        let field = &self.scene.field;
        let [cell_x, cell_y] = field.cell_m();
        let height = f64::from(field.heights_m()[row * field.cols() + col]) + field.base_m();
        let north = (field.rows() - 1 - row) as f64;
        let at = DVec3::new(col as f64 * cell_x, north * cell_y, height);
        // An eye at a grid point views it from above.
        self.eye_m.map_or(DVec3::Z, |eye| (eye - at).normalize_or(DVec3::Z))
    }

    /// Azimuths across a key light.
    fn key_strips(&self, key: &KeyLight) -> usize {
        // f32 rounds 2π up. A whole turn divided by 2π is exactly 1.
        let turns = key.width_rad.min(TAU) / TAU;
        ((self.azimuths as f64 * turns).ceil() as usize).max(self.strips)
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
    /// Azimuths of each.
    parts: Vec<usize>,
    /// Shared by all clones: 36 bytes per texel.
    table: Arc<ColumnTable>,
}

/// What does not depend on the number of azimuths.
#[derive(Debug)]
struct ColumnTable {
    /// Of each column, `rows` + 1 entries: sums of what lies above the row, for a and for b.
    sums: Vec<[[f32; 3]; 2]>,
    /// Texels, column after column.
    texels: Vec<[f32; 3]>,
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
        let mut texels = Vec::with_capacity(width * rows);
        for col in 0..width {
            let mut sum = [[0.0_f64; 3]; 2];
            sums.push([[0.0_f32; 3]; 2]);
            for (row, band) in bands.iter().enumerate() {
                let texel = environment.texels()[row * width + col];
                texels.push(texel);
                for (sum, band) in sum.iter_mut().zip(band) {
                    sum.iter_mut().zip(texel).for_each(|(s, t)| *s += f64::from(t) * band);
                }
                sums.push(sum.map(|c| c.map(|v| v as f32)));
            }
            given.push(sum.iter().flatten().map(|v| v.abs()).sum::<f64>());
        }
        let all = given.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        // Two at least, so that half of them is fewer.
        let least = ENVIRONMENT_STRIPS.div_ceil(width).max(2);
        let parts = given.iter().map(|g| least.max((SHARED * g / all).round() as usize)).collect();
        Self { environment, rows, parts, table: Arc::new(ColumnTable { sums, texels }) }
    }

    /// Light of each receiver at a grid point, linear RGB: in each column's azimuths at the centres of equal parts of
    /// it, clipped at the horizon exactly. A lobe has its own weight in each texel.
    fn light(&self, site: Site<'_>, integrals: &[Option<PhongIntegral>]) -> Vec<Rgb> {
        let (width, height) = (self.environment.width(), self.environment.height());
        // Upper ends of the rows, and the lower end of the last.
        let elevations: Vec<f64> =
            (0..=self.rows).map(|row| FRAC_PI_2 - PI * row as f64 / height as f64).collect();
        let row_of = |elevation: f64| (FRAC_PI_2 - elevation) / PI * height as f64;
        let ColumnTable { sums, texels } = &*self.table;
        let mut all = vec![[0.0; 3]; site.receivers.len()];
        let mut first_cells = 0;
        for (column, &parts) in self.parts.iter().enumerate() {
            let texels = &texels[column * self.rows..][..self.rows];
            let weight = 2.0 / (width * parts) as f64;
            for part in 0..parts {
                let across = column as f64 + (part as f64 + 0.5) / parts as f64;
                let azimuth = PI - TAU * across / width as f64 + self.environment.rotation_rad();
                let horizon = site.horizon_rad(azimuth, &mut first_cells);
                let receivers = site.receivers.iter().zip(integrals);
                for ((receiver, integral), all) in receivers.zip(&mut all) {
                    let lit = receiver.slice(azimuth).above(horizon);
                    if let Some(integral) = integral {
                        let arc = integral.along(&lit);
                        let [low, high] = arc.range();
                        let first = row_of(high).max(0.0) as usize;
                        let end =
                            (row_of(low.max(lit.low)).max(0.0).ceil() as usize).min(self.rows);
                        let mut above = arc.up_to(elevations[first.min(self.rows)].max(lit.low));
                        let mut sum = [0.0; 3];
                        for (row, texel) in texels.iter().enumerate().take(end).skip(first) {
                            let below = arc.up_to(elevations[row + 1].max(lit.low));
                            let light = above - below;
                            (0..3).for_each(|c| sum[c] += light * f64::from(texel[c]));
                            above = below;
                        }
                        (0..3).for_each(|c| all[c] += weight * sum[c]);
                        continue;
                    }
                    let mut add = |light: f64, texel: [f32; 3]| {
                        (0..3).for_each(|c| all[c] += weight * light * f64::from(texel[c]));
                    };
                    let above = (row_of(lit.low).max(0.0) as usize).min(self.rows);
                    let [a, b] = sums[column * (self.rows + 1) + above];
                    add(lit.a, a);
                    add(lit.b, b);
                    if above < self.rows {
                        let cut = lit.light(lit.low, elevations[above]);
                        add(cut, texels[above]);
                    }
                }
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{Albedo, HeightField, Lights, PhongSpecular, Specular, Sun, Surface};

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
        let narrow = (Border::Open, 128);
        let wide = [(Border::Plane, 7), (Border::Open, 6), (Border::Periodic, 8)];
        for (border, height) in wide.into_iter().chain([narrow]) {
            let texel = |i: usize| [(i / 16) as f32 + 0.5, 2.0, (i / 16 % 3) as f32];
            let texels = (0..16 * height).map(texel).collect();
            let environment = Environment::new(16, height, texels, 0.4).unwrap();
            let scene = scene(border, environment.clone());
            let lit = Lit::of(&scene);
            assert_eq!(lit.rays(), 1024);
            assert_eq!(lit.clone().halved().rays(), 512);
            for (row, col) in [(0, 0), (4, 4), (8, 3), (2, 7)] {
                let oracle = Oracle::new(&scene.field, border);
                let receivers = light::diffuse_at(&oracle, row, col);
                let all = Site::of(&oracle, [row, col], &receivers).environment(&environment, 64);
                for (got, want) in lit.at(row, col).iter().zip(all[0]) {
                    assert!((got - want).abs() < 1e-6 * (1.0 + want), "{got} {want}");
                }
            }
            // Lobes, too: from their table, against Gauss' rule over each texel.
            let scene = specular(scene, PhongSpecular { exponent: 20.0, scale: 0.5 });
            let [lit, dull] = [&scene, &specular(scene.clone(), DULL)].map(|s| Lit::of(s).at(4, 4));
            let oracle = Oracle::new(&scene.field, border);
            let normal = light::normal(&scene.field, border, 4, 4);
            let mirrored = [Receiver::specular_from_above(normal, 20.0)];
            let all = Site::of(&oracle, [4, 4], &mirrored).environment(&environment, 64);
            for c in 0..3 {
                let (got, want) = (lit[c] - dull[c], 0.5 * all[0][c]);
                // The table has an error of 1e-8 of a slice, times the difference between adjacent texels.
                assert!((got - want).abs() < 1e-7 * (1.0 + want), "{got} {want}");
            }
        }
    }

    /// Light that reads horizons keeps its bits: sky, environment, sun and key light. An oracle that knows no highest point
    /// visits every crossing.
    #[test]
    fn skipping_surface_changes_no_light() {
        let texels = (0..16 * 8).map(|i| [(i % 7) as f32, 2.0, (i % 3) as f32]).collect();
        let environment = Environment::new(16, 8, texels, 0.4).unwrap();
        for border in [Border::Plane, Border::Open, Border::Periodic] {
            let mut scene = scene(border, environment.clone());
            scene.lights.sky = Some([1.0, 2.0, 3.0]);
            scene.lights.suns = vec![Sun {
                azimuth_rad: 0.7,
                elevation_rad: 0.4,
                diameter_rad: 0.1,
                irradiance: [2.0; 3],
            }];
            scene.lights.keys = vec![KeyLight {
                azimuth_rad: 2.0,
                width_rad: 0.8,
                elevations_rad: [0.1, 0.6],
                radiance: [3.0; 3],
            }];
            let scene = specular(scene, PhongSpecular { exponent: 20.0, scale: 0.5 });
            let lit = Lit::of(&scene);
            assert_eq!(lit.maxima.is_some(), border != Border::Periodic);
            let oracle = Oracle::one_ray(&scene.field, border);
            let plain = Lit { maxima: None, oracle, ..lit.clone() };
            for place in [0, 13, 40, 44, 70, 80] {
                let (row, col) = (place / SIDE, place % SIDE);
                assert_eq!(lit.at(row, col), plain.at(row, col), "{border:?} {place}");
            }
        }
    }

    /// 36 bytes per texel are 1.2 GB for 8192 × 4096.
    #[test]
    fn clones_and_halves_share_texels() {
        let environment = Environment::new(4, 4, vec![[1.0; 3]; 16], 0.0).unwrap();
        let scene = scene(Border::Open, environment);
        let lit = Lit::of(&scene);
        let table = |lit: &Lit| Arc::as_ptr(&lit.columns.as_ref().unwrap().table);
        assert_eq!(table(&lit.clone()), table(&lit));
        assert_eq!(table(&lit.clone().halved()), table(&lit));
        let maxima = |lit: &Lit| lit.maxima.as_ref().map(Arc::as_ptr);
        assert_eq!(maxima(&lit.clone().halved()), maxima(&lit));
        assert!(maxima(&lit).is_some());
    }

    const DULL: PhongSpecular = PhongSpecular { exponent: 20.0, scale: 0.0 };

    fn specular(scene: Scene, phong: PhongSpecular) -> Scene {
        let specular = Some(Specular::Constant(phong));
        Scene { surface: Surface { specular, ..scene.surface }, ..scene }
    }

    /// Level ground under a uniform sky. Viewed from above, the whole Phong lobe lies above the ground. A lobe of exponent 1,
    /// tilted by θ from the zenith, weights directions as a diffuse plane of slope θ does: (1 + cos θ) / 2 of its light comes
    /// from above the ground. A sun in the mirror direction gives (n + 1) / 2π of its irradiance.
    #[test]
    fn specular_of_level_ground_has_its_share_of_the_sky() {
        let field = HeightField::new(SIDE, SIDE, &[2.0; SIDE * SIDE], [1.0; 2], None).unwrap();
        let level = |lights: Lights, exponent: f32| {
            let surface = Surface { albedo: Albedo::Constant([0.5; 3]), ..Surface::default() };
            let scene = Scene { field: field.clone(), surface, lights };
            specular(scene, PhongSpecular { exponent, scale: 0.25 })
        };
        let sky = || Lights { sky: Some([1.0; 3]), ..Lights::default() };
        for (exponent, most) in
            [(0.0, 1e-6), (0.1, 1e-4), (0.5, 1e-4), (1.0, 1e-6), (20.0, 1e-6), (1e4, 1e-6)]
        {
            let scene = level(sky(), exponent);
            let got = Lit::of(&scene).at(4, 4)[0];
            assert!((got - 0.75).abs() < most, "{exponent}: {got}");
        }
        let scene = level(sky(), 1.0);
        // From a point to the west of the middle, 60° off the zenith.
        let away = 3.0_f64.sqrt();
        let lit = Lit::of(&scene).viewed_from(Some([4.0 - away, 4.0, 2.0 + 1.0]));
        let got = lit.at(4, 4)[0];
        assert!((got - (0.5 + 0.25 * 0.75)).abs() < 1e-5, "{got}");
        // Mirrored to the east, 30° above the horizon.
        let sun = Sun {
            azimuth_rad: 0.0,
            elevation_rad: 30_f64.to_radians(),
            diameter_rad: 0.0,
            irradiance: [2.0; 3],
        };
        let scene = level(Lights { suns: vec![sun], ..Lights::default() }, 9.0);
        let lit = Lit::of(&scene).viewed_from(Some([4.0 - away, 4.0, 2.0 + 1.0]));
        let (got, want) = (lit.at(4, 4)[0], 2.0 * (0.5 * 0.5 / PI + 0.25 * 10.0 / TAU));
        assert!((got - want).abs() < 1e-6, "{got} {want}");
    }

    /// 720 azimuths of a sky, 1024 of 16 columns of an environment, which has 64 rows above ground, all in the lobe: it
    /// is 2 acos(10^(-10/21)), 141°, wide.
    #[test]
    fn specular_points_count_slices_and_rows() {
        let environment = Environment::new(16, 128, vec![[1.0; 3]; 16 * 128], 0.0).unwrap();
        let both = |phong: PhongSpecular| {
            let mut scene = specular(scene(Border::Plane, environment.clone()), phong);
            let of_environment = Lit::of(&scene).specular_points();
            scene.lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
            [Lit::of(&scene).specular_points(), of_environment]
        };
        let slices = [720, 1024].map(|rays| rays * SLICE_POINTS);
        assert_eq!(both(PhongSpecular { scale: 0.5, ..DULL }), [slices[0], slices[1] + 1024 * 64]);
        assert_eq!(both(DULL), [0, 0]);
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
