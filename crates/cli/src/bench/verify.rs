//! Compares the light with the oracle's before any time is printed.

mod bounces;
mod environments;
mod harmonics;
mod specular;
mod sphere_lights;
mod spheres;
mod sweeps;

use glam::DVec3;
use ridgelight::gpu::{Headless, Pixels};
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{
    Albedo, Basis, Border, Bounces, Fuse, HeightField, LightBasis, Lights, Method, Precision,
    Quality, Scene, Specular, SphereLight, Surface,
};
use ridgelight::{Error, Result};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere::sphere_of;

/// The oracle computes whole fields up to this side, and a piece of [`PIECE`]² of larger ones.
const WHOLE: usize = 128;
const PIECE: usize = 96;
/// About this many texels are compared, spread over the field.
const PLACES: usize = 100;
/// Azimuths of the oracle's sky.
const TRUE_AZIMUTHS: usize = 360;
/// Slices of the oracle's suns and key lights.
const TRUE_STRIPS: usize = 32;
/// Slices of the oracle's sphere lights.
const TRUE_SLICES: usize = 64;

/// The correct light of a scene at some of its texels.
#[derive(Clone)]
pub struct GroundTruth {
    places: Vec<usize>,
    /// Of sky, environment, suns and key lights, and sphere lights, each alone.
    expected: Vec<[f64; 4]>,
    /// The unoccluded share of a sky's light.
    open: Vec<f64>,
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
        Self { places, expected, open }
    }

    /// The same of all light but sphere lights'.
    fn without_sphere_lights(&self) -> Self {
        let rest = self
            .expected
            .iter()
            .map(|[sky, environment, suns, _]| [*sky, *environment, *suns, 0.0]);
        Self { places: self.places.clone(), expected: rest.collect(), open: self.open.clone() }
    }

    /// RMSE of a picture over the root mean square of the expected light.
    pub fn error(&self, pixels: &Pixels) -> f64 {
        self.error_of(&self.means(pixels))
    }

    /// Radiance of a picture at the places, mean of the colours.
    fn means(&self, pixels: &Pixels) -> Vec<f64> {
        let mean = |p: &usize| {
            let texel = &pixels.values[p * pixels.channels..(p + 1) * pixels.channels];
            let colours = &texel[..texel.len().min(3)];
            colours.iter().map(|v| f64::from(*v)).sum::<f64>() / colours.len() as f64
        };
        self.places.iter().map(mean).collect()
    }

    /// The same for radiance at the places alone.
    fn error_of(&self, radiance: &[f64]) -> f64 {
        let all = self.expected.iter().map(|lights| lights.iter().sum());
        rms(radiance.iter().zip(all).map(|(a, b): (_, f64)| a - b)) / self.scale()
    }

    /// Root mean squares of each kind of light.
    fn scales(&self) -> [f64; 4] {
        [0, 1, 2, 3].map(|light| rms(self.expected.iter().map(|lights| lights[light])))
    }

    fn scale(&self) -> f64 {
        self.scales().iter().map(|s| s * s).sum::<f64>().sqrt().max(f64::MIN_POSITIVE)
    }

    /// Occluded share of a sky's light.
    fn dark(&self) -> f64 {
        1.0 - self.open.iter().sum::<f64>() / self.open.len() as f64
    }
}

/// Root of the mean square.
fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

/// Light of sky, environment, suns and key lights, and sphere lights at a place, mean of the
/// colours; and the unoccluded share of a sky's light.
fn light_at(scene: &Scene, oracle: &Oracle, place: usize) -> ([f64; 4], f64) {
    let (row, col) = (place / scene.field.cols(), place % scene.field.cols());
    let albedo = albedo_of(scene, place);
    let tint = |c: [f64; 3]| c.iter().zip(albedo).map(|(c, a)| c * a).sum::<f64>() / 3.0;
    let Lights { sky, environment, suns, keys, sphere_lights: spheres } = &scene.lights;
    let share = light::sky_of(oracle, row, col, TRUE_AZIMUTHS);
    let sky = sky.map_or(0.0, |colour| tint(colour.map(|c| f64::from(c) * share)));
    let environment =
        environment.as_ref().map_or(0.0, |e| tint(light::environment_of(oracle, row, col, e)));
    let suns = suns.iter().map(|s| tint(light::sun_of(oracle, row, col, s, TRUE_STRIPS)));
    let keys = keys.iter().map(|k| tint(light::key_of(oracle, row, col, k, TRUE_STRIPS)));
    let sphere_light = |s: &SphereLight| {
        let share = sphere_of(oracle, row, col, s, TRUE_SLICES);
        tint(s.radiance.map(|c| f64::from(c) * share))
    };
    ([sky, environment, suns.chain(keys).sum(), spheres.iter().map(sphere_light).sum()], share)
}

fn albedo_of(scene: &Scene, place: usize) -> [f64; 3] {
    match &scene.surface.albedo {
        Albedo::Constant(c) => c.map(f64::from),
        Albedo::Map(map) => map[place].map(f64::from),
    }
}

/// A scene, or a piece from the middle of a large one, and its light.
pub struct Verifier {
    scene: Scene,
    ground_truth: GroundTruth,
}

impl Verifier {
    pub fn new(scene: &Scene) -> Result<Self> {
        let scene = piece(scene)?;
        let ground_truth = GroundTruth::of(&scene);
        Ok(Self { scene, ground_truth })
    }

    /// Lights the piece on the device with these settings. Returns a sentence with the error.
    ///
    /// Light by harmonics differs from the oracle's. There, horizons are compared with the oracle,
    /// and light with f64.
    ///
    /// # Errors
    /// An error above its bound.
    pub fn check(&self, gpu: &mut Headless, quality: &Quality, limits: &Limits) -> Result<String> {
        if self.scene.surface.specular.is_some() {
            let quality = specular::quality(&self.scene, quality);
            let specular_error =
                specular::check(&self.scene, &self.ground_truth.places, gpu, &quality, limits)?;
            let surface = Surface { specular: None, ..self.scene.surface.clone() };
            let diffuse = Scene { surface, ..self.scene.clone() };
            let found = Self { scene: diffuse, ground_truth: self.ground_truth.clone() };
            return Ok(format!("{}; {specular_error}", found.check(gpu, &quality, limits)?));
        }
        let direct = Quality { bounces: Bounces { count: 0, ..quality.bounces }, ..*quality };
        let found = self.check_direct(gpu, &direct, limits)?;
        match quality.bounces.count {
            0 => Ok(found),
            _ => Ok(format!("{found}; {}", bounces::check(&self.scene, gpu, quality, limits)?)),
        }
    }

    fn check_direct(
        &self,
        gpu: &mut Headless,
        quality: &Quality,
        limits: &Limits,
    ) -> Result<String> {
        if quality.light_basis == LightBasis::Sh && !self.scene.lights.sphere_lights.is_empty() {
            let found =
                sphere_lights::check(&self.scene, &self.ground_truth, gpu, quality, limits)?;
            let Some(scene) = sphere_lights::without(&self.scene) else { return Ok(found) };
            let rest = Self { scene, ground_truth: self.ground_truth.without_sphere_lights() };
            return Ok(format!("{}; {found}", rest.check_direct(gpu, quality, limits)?));
        }
        if quality.basis == Basis::Sh && self.scene.lights.environment.is_some() {
            return harmonics::check(self, gpu, quality, limits);
        }
        // The plan bounds the light of culled sphere lights.
        let all = Quality { light_cutoff: 0.0, ..*quality };
        let plan = plan::picture(&self.scene, &all, limits, Picture::default())?;
        let contents = plan::picture_inputs(&self.scene);
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        let picture = gpu.with_frame(plan, &contents, |gpu, frame| {
            gpu.draw(frame)?;
            gpu.pixels(frame, 0)
        })?;
        let (error, bound) = self.judge(self.ground_truth.error(&picture), quality)?;
        let of_oracle = format!(
            "light error {} against the oracle (RMSE; bound {})",
            percent(error),
            percent(bound)
        );
        let places = &self.ground_truth.places;
        let swept = sweeps::check(&self.scene, places, gpu, quality, limits)?;
        let sphere_lights = spheres::check(&self.scene, places, gpu, &all, limits)?;
        let found: Vec<String> =
            [swept, sphere_lights, Some(of_oracle)].into_iter().flatten().collect();
        Ok(found.join("; "))
    }

    /// A relative error and its bound, where it is within.
    fn judge(&self, error: f64, quality: &Quality) -> Result<(f64, f64)> {
        let shares = bounds(&self.scene, self.ground_truth.dark(), quality);
        let sum: f64 = self.ground_truth.scales().iter().zip(shares).map(|(s, b)| s * b).sum();
        within("light", "the oracle", error, sum / self.ground_truth.scale(), quality)
    }
}

fn percent(share: f64) -> String {
    format!("{:.3} %", 100.0 * share)
}

/// RMSE of `found` and RMS of its tolerance, both over the root mean square, if every value is
/// within its tolerance. `wanted` holds values of the CPU reference and tolerances.
fn judge(
    what: &str,
    found: impl Iterator<Item = f64>,
    wanted: &[[f64; 2]],
    quality: &Quality,
) -> Result<(f64, f64)> {
    let scale = rms(wanted.iter().map(|w| w[0])).max(f64::MIN_POSITIVE);
    let off: Vec<f64> = found.zip(wanted).map(|(found, w)| (found - w[0]) / scale).collect();
    for (off, [_, bound]) in off.iter().zip(wanted) {
        within(what, "the CPU reference", off.abs(), bound / scale, quality)?;
    }
    Ok((rms(off.into_iter()), rms(wanted.iter().map(|w| w[1] / scale))))
}

/// R, G, B of a picture at some places; a grey one has one channel.
fn colours(pixels: &Pixels, places: &[usize]) -> Vec<DVec3> {
    let channel =
        |p: &usize, c: usize| pixels.values[p * pixels.channels + c.min(pixels.channels - 1)];
    places.iter().map(|p| DVec3::from_array([0, 1, 2].map(|c| channel(p, c).into()))).collect()
}

/// An error and its bound, where it is within.
fn within(
    what: &str,
    ground_truth: &str,
    error: f64,
    bound: f64,
    quality: &Quality,
) -> Result<(f64, f64)> {
    // NaN is above every bound.
    if error <= bound {
        return Ok((error, bound));
    }
    Err(Error::Device {
        doing: format!("verifying before timing (fuse {})", quality.fuse.name()),
        reason: format!(
            "{what} has an error of {:.2} % against {ground_truth}, above the bound of {:.2} %: times \
                would be meaningless",
            100.0 * error,
            100.0 * bound
        ),
    })
}

/// Bounds of the relative RMSE of sky, environment, suns and key lights, and sphere lights.
///
/// A line sweep: twice the error measured for each fuse and spacing on the roughest of four fields
/// (a displacement map of moss that occludes half of the sky), proportional to the occluded share,
/// because only occlusion can be wrong. Three elevation models also stay below that line. Azimuths:
/// 0.36 % on the moss with 64, proportional to their spacing; four times that. Packed heights are
/// within 2^-11 of the highest: the slope changes by at most twice that over the cell, and light by
/// no more than the slope. A periodic field is marched for two periods, which misses at most relief
/// / (2·side). An environment's bright texels and a sun are visible or hidden whole: mean errors
/// stay small but squares do not, hence the wide bounds there. Horizons towards a sphere light are
/// exact; an upright edge in front of it has an error of half a slice, and the widest slice has 2/n
/// of the light.
fn bounds(scene: &Scene, dark: f64, quality: &Quality) -> [f64; 4] {
    let transfer = match (quality.method, quality.lines.shift()) {
        (Method::BruteForce, _) | (_, None) => 0.001,
        (Method::Pyramid, _) => {
            // Offsets 0, 1, 2 and more, on the same moss with one level per octave, the fewest.
            2.0 * [0.46, 0.35, 0.28][quality.level_offset.min(2) as usize]
        }
        (_, Some(shift)) => {
            // 1/4, 1/2, 1, 2, 4 cells between lines.
            let measured = match quality.fuse {
                Fuse::Nearest => [0.042, 0.047, 0.056, 0.084, 0.131],
                Fuse::Slopes => [0.043, 0.048, 0.059, 0.094, 0.160],
                Fuse::Own => [0.038, 0.038, 0.039, 0.051, 0.082],
                Fuse::AimedNearest => [0.014, 0.016, 0.024, 0.062, 0.133],
                // The latter includes all occluders of the former and adds none above the horizon.
                Fuse::Aimed | Fuse::AimedAround => [0.013, 0.014, 0.017, 0.038, 0.095],
            };
            2.0 * measured[(shift as usize).saturating_sub(13).min(4)]
        }
    };
    let azimuths = 4.0 * 0.0036 * 64.0 / f64::from(quality.azimuths);
    let heights = scene.field.heights_m();
    let highest = f64::from(heights.iter().fold(0.0_f32, |m, h| m.max(h.abs())));
    let cell = scene.field.cell_m()[0].min(scene.field.cell_m()[1]);
    let packed = match quality.precision {
        Precision::Packed => 2.0 * highest / cell / 2048.0,
        // A stored slope is within 2^-11 of itself.
        Precision::F16 => 1.0 / 2048.0,
        Precision::F32 => 0.0,
    };
    let side = scene.field.rows().min(scene.field.cols()) as f64 * cell;
    let periods = match scene.surface.border {
        Border::Periodic => 2.0 * highest / (2.0 * side),
        _ => 0.0,
    };
    // A floor, because f32 sums and normals have errors even without occlusion.
    let dark = dark.clamp(0.01, 0.5) / 0.5;
    let sky = dark * (transfer + azimuths) + packed + periods;
    let sphere_light = 0.001 + 1.0 / f64::from(quality.sun_azimuths);
    [sky, 2.0 * sky + 0.05, sky + 0.4, sphere_light]
}

/// The scene, or a piece of its middle with its own heights where it is too large for the oracle.
pub fn piece(scene: &Scene) -> Result<Scene> {
    let field = &scene.field;
    let (rows, cols) = (field.rows(), field.cols());
    if rows <= WHOLE && cols <= WHOLE {
        return Ok(scene.clone());
    }
    let range = |side: usize| {
        let kept = side.min(PIECE);
        (side - kept) / 2..(side - kept) / 2 + kept
    };
    let of: Vec<usize> = range(rows).flat_map(|r| range(cols).map(move |c| r * cols + c)).collect();
    let heights: Vec<f64> =
        of.iter().map(|i| field.base_m() + f64::from(field.heights_m()[*i])).collect();
    let albedo = match &scene.surface.albedo {
        Albedo::Map(map) => Albedo::Map(of.iter().map(|i| map[*i]).collect()),
        constant => constant.clone(),
    };
    let phong = scene.surface.specular.as_ref().map(|specular| match specular {
        Specular::Map(map) => Specular::Map(of.iter().map(|i| map[*i]).collect()),
        constant => constant.clone(),
    });
    // Lights of the piece are relative to its western column and southern row.
    let west = range(cols).start as f64 * field.cell_m()[0];
    let south = (rows - range(rows).end) as f64 * field.cell_m()[1];
    let mut lights = scene.lights.clone();
    for sphere_light in &mut lights.sphere_lights {
        sphere_light.position_m[0] -= west;
        sphere_light.position_m[1] -= south;
    }
    Ok(Scene {
        field: HeightField::new(
            range(rows).len(),
            range(cols).len(),
            &heights,
            field.cell_m(),
            None,
        )?,
        surface: Surface { albedo, border: scene.surface.border, specular: phong },
        lights,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::fractal;

    fn scene(size: usize) -> Scene {
        Scene {
            field: fractal(size, 1).unwrap(),
            surface: Surface::default(),
            lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
        }
    }

    /// Results of broken passes (no shadows, black, a mirrored field, horizons too high, NaN) are
    /// refused at the bound of the default settings; the oracle at the settings' number of azimuths
    /// is accepted.
    #[test]
    fn wrong_light_is_refused() {
        let verifier = Verifier::new(&scene(300)).unwrap();
        let quality = Quality::default();
        let field = &verifier.scene.field;
        assert_eq!((field.rows(), field.cols()), (PIECE, PIECE));
        let cols = field.cols();
        let oracle = Oracle::new(field, Border::Plane);
        let right: Vec<f64> = verifier
            .ground_truth
            .places
            .iter()
            .map(|p| light::sky_of(&oracle, p / cols, p % cols, 64))
            .collect();
        let (error, _) = verifier.judge(verifier.ground_truth.error_of(&right), &quality).unwrap();
        assert!(error < 0.01, "{error}");
        let mirrored: Vec<f64> = verifier
            .ground_truth
            .places
            .iter()
            .map(|p| light::sky_of(&oracle, p / cols, cols - 1 - p % cols, 64))
            .collect();
        let flat = vec![0.0; field.heights_m().len()];
        let flat = HeightField::new(field.rows(), cols, &flat, field.cell_m(), None).unwrap();
        let free = Oracle::new(&flat, Border::Plane);
        let unshadowed: Vec<f64> = verifier
            .ground_truth
            .places
            .iter()
            .map(|p| light::sky_of(&free, p / cols, p % cols, 64))
            .collect();
        let dim: Vec<f64> = right.iter().map(|v| 0.9 * v).collect();
        let black = vec![0.0; right.len()];
        let mut holed = right.clone();
        holed[7] = f64::NAN;
        let wrong = [mirrored, unshadowed, dim, black, holed];
        for (i, light) in wrong.iter().enumerate() {
            let error = verifier.judge(verifier.ground_truth.error_of(light), &quality);
            let error = error.expect_err(&format!("wrong light {i}"));
            assert!(error.to_string().contains("verifying"), "{error}");
        }
    }

    #[test]
    fn small_fields_are_verified_whole() {
        let verifier = Verifier::new(&scene(33)).unwrap();
        assert_eq!(verifier.scene.field.rows(), 33);
        assert!(verifier.ground_truth.expected.len() >= PLACES);
    }
}
