//! The light that the oracle computes at some texels of a scene.

use ridgelight::gpu::Pixels;
use ridgelight::scene::{Albedo, HeightField, Lights, Scene, Surface};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere::sphere_of;

use super::{albedo_of, rms};

/// About this many texels are compared, spread over the field.
pub const PLACES: usize = 100;
/// Azimuths of the oracle's sky.
const TRUE_AZIMUTHS: usize = 360;
/// Slices of the oracle's suns and key lights.
const TRUE_STRIPS: usize = 32;
/// Slices of the oracle's sphere lights.
const TRUE_SLICES: usize = 64;

/// The correct light of a scene at some of its texels.
#[derive(Clone)]
pub struct GroundTruth {
    pub places: Vec<usize>,
    /// Of sky, environment, suns and key lights, and sphere lights, each alone.
    pub expected: Vec<[f64; 4]>,
    /// The unoccluded share of a sky's light.
    pub open: Vec<f64>,
    /// Light of suns and key lights on level ground without shadows.
    pub level: f64,
}

impl GroundTruth {
    pub fn of(scene: &Scene) -> Self {
        let field = &scene.field;
        let (cols, count) = (field.cols(), field.rows() * field.cols());
        // A step without common factors visits rows and columns evenly. Includes the corners.
        let step = (count / PLACES).max(1) | 1;
        let mut places: Vec<usize> = (0..count).step_by(step).collect();
        places.extend([cols - 1, count - cols, count - 1]);
        let oracle = Oracle::new(field, scene.surface.border);
        let (expected, open) = places.iter().map(|p| light_at(scene, &oracle, *p)).unzip();
        let level = level(scene, &places);
        Self { places, expected, open, level }
    }

    /// The same of all light but sphere lights'.
    pub fn without_sphere_lights(&self) -> Self {
        let rest = self
            .expected
            .iter()
            .map(|[sky, environment, suns, _]| [*sky, *environment, *suns, 0.0]);
        Self { expected: rest.collect(), ..self.clone() }
    }

    /// The same without the light of suns and key lights.
    pub fn without_aimed(&self) -> Self {
        let rest = self.expected.iter().map(|lights| [lights[0], lights[1], 0.0, lights[3]]);
        Self { expected: rest.collect(), level: 0.0, ..self.clone() }
    }

    /// RMSE of a picture over [`scale`](Self::scale).
    pub fn error(&self, pixels: &Pixels) -> f64 {
        self.error_of(&self.means(pixels))
    }

    /// Radiance of a picture at the places, mean of the colours.
    pub fn means(&self, pixels: &Pixels) -> Vec<f64> {
        let mean = |p: &usize| {
            let texel = &pixels.values[p * pixels.channels..(p + 1) * pixels.channels];
            let colours = &texel[..texel.len().min(3)];
            colours.iter().map(|v| f64::from(*v)).sum::<f64>() / colours.len() as f64
        };
        self.places.iter().map(mean).collect()
    }

    /// The same for radiance at the places alone.
    pub fn error_of(&self, radiance: &[f64]) -> f64 {
        let all = self.expected.iter().map(|lights| lights.iter().sum());
        rms(radiance.iter().zip(all).map(|(a, b): (_, f64)| a - b)) / self.scale()
    }

    /// Root mean squares of each kind of light. For suns and key lights, half of the unshadowed light on level ground if less than a
    /// hundredth of that arrives: all places may be in shadow.
    pub fn scales(&self) -> [f64; 4] {
        let mut scales =
            [0, 1, 2, 3].map(|light| rms(self.expected.iter().map(|lights| lights[light])));
        if scales[2] < 0.01 * self.level {
            scales[2] = 0.5 * self.level;
        }
        scales
    }

    /// Root of the summed squares of [`scales`](Self::scales).
    pub fn scale(&self) -> f64 {
        self.scales().iter().map(|s| s * s).sum::<f64>().sqrt().max(f64::MIN_POSITIVE)
    }

    /// Occluded share of a sky's light.
    pub fn dark(&self) -> f64 {
        1.0 - self.open.iter().sum::<f64>() / self.open.len() as f64
    }
}

/// Light of a scene's suns and key lights on a plane, with the mean albedo of these places.
fn level(scene: &Scene, places: &[usize]) -> f64 {
    let plane = HeightField::new(2, 2, &[0.0; 4], scene.field.cell_m(), None);
    let plane = plane.expect("a cell size that a field has");
    let mut albedo = [0.0_f32; 3];
    for place in places {
        let of_place = albedo_of(scene, *place);
        (0..3).for_each(|c| albedo[c] += of_place[c] as f32 / places.len() as f32);
    }
    let Lights { suns, keys, .. } = scene.lights.clone();
    let scene = Scene {
        surface: Surface { albedo: Albedo::Constant(albedo), ..Surface::default() },
        lights: Lights { suns, keys, ..Lights::default() },
        field: plane,
    };
    light_at(&scene, &Oracle::new(&scene.field, scene.surface.border), 0).0[2]
}

/// Light of sky, environment, suns and key lights, and sphere lights at a place, mean of the
/// colours; and the unoccluded share of a sky's light.
fn light_at(scene: &Scene, oracle: &Oracle, place: usize) -> ([f64; 4], f64) {
    let (row, col) = (place / scene.field.cols(), place % scene.field.cols());
    let albedo = albedo_of(scene, place);
    let tint = |c: [f64; 3]| c.iter().zip(albedo).map(|(c, a)| c * a).sum::<f64>() / 3.0;
    let Lights { sky, environment, suns, keys, .. } = &scene.lights;
    let share = light::sky_of(oracle, row, col, TRUE_AZIMUTHS);
    let sky = sky.map_or(0.0, |colour| tint(colour.map(|c| f64::from(c) * share)));
    let environment =
        environment.as_ref().map_or(0.0, |e| tint(light::environment_of(oracle, row, col, e)));
    let suns = suns.iter().map(|s| tint(light::sun_of(oracle, row, col, s, TRUE_STRIPS)));
    let keys = keys.iter().map(|k| tint(light::key_of(oracle, row, col, k, TRUE_STRIPS)));
    let near = scene.lights.near().map(|light| {
        let share = sphere_of(oracle, row, col, &light.sphere, TRUE_SLICES);
        tint(light.sphere.radiance.map(|c| f64::from(c) * share))
    });
    ([sky, environment, suns.chain(keys).sum(), near.sum()], share)
}
