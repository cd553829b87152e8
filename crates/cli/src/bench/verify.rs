//! Compares the light with the oracle's before any time is printed.

mod aimed;
mod bounces;
mod environments;
mod ground_truth;
mod harmonics;
mod specular;
mod sphere_lights;
mod sweeps;

use glam::DVec3;
#[cfg(test)]
use glam::Vec3Swizzles as _;
use ridgelight::gpu::{Headless, Pixels};
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{
    Albedo, Basis, Border, Bounces, Fuse, HeightField, KeyLight, Lights, Method, Precision,
    Quality, Scene, Specular, Surface,
};
use ridgelight::{Error, Result};

pub use ground_truth::GroundTruth;
use ground_truth::PLACES;
use sweeps::AimedLayers;

/// The oracle computes whole fields up to this side, and a piece of [`PIECE`]² of larger ones.
const WHOLE: usize = 128;
pub const PIECE: usize = 96;
/// Root of the mean square.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v * v));
    f64::sqrt(sum / count)
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
            let quality = &specular::quality(&self.scene, quality, limits)?;
            let with_specular = &mut Device { gpu, quality, limits };
            let places = (self.ground_truth.places.as_slice(), self.ground_truth.dark());
            let specular_error = specular::check(&self.scene, places, with_specular)?;
            let surface = Surface { specular: None, ..self.scene.surface.clone() };
            let diffuse = Scene { surface, ..self.scene.clone() };
            let found = Self { scene: diffuse, ground_truth: self.ground_truth.clone() };
            return Ok(format!("{}; {specular_error}", found.check(gpu, quality, limits)?));
        }
        let direct = Quality { bounces: Bounces { count: 0, ..quality.bounces }, ..*quality };
        let found = self.check_direct(&mut Device { gpu, quality: &direct, limits })?;
        match quality.bounces.count {
            0 => Ok(found),
            _ => {
                let bounced = bounces::check(&self.scene, &mut Device { gpu, quality, limits })?;
                Ok(format!("{found}; {bounced}"))
            }
        }
    }

    fn check_direct(&self, device: &mut Device) -> Result<String> {
        let (scene, quality) = (&self.scene, device.quality);
        // The plan bounds the light of culled sphere lights.
        let all = Quality { light_cutoff: 0.0, ..*quality };
        // The plan states `light_basis` only where a light near the field is lit, and `exact` where that light has no series.
        let plan = plan::picture(scene, &all, device.limits, Picture::default())?;
        if plan.settings.contains(&("light_basis".to_owned(), "sh".to_owned())) {
            let found = sphere_lights::check(scene, &self.ground_truth, device)?;
            let Some(scene) = sphere_lights::without(scene) else { return Ok(found) };
            let rest = Self { scene, ground_truth: self.ground_truth.without_sphere_lights() };
            return Ok(format!("{}; {found}", rest.check_direct(device)?));
        }
        let places = &self.ground_truth.places;
        let drawn = AimedLayers::of(scene, device)?;
        let aimed = drawn.as_ref().map(|drawn| aimed::check(drawn, places, quality));
        let aimed = aimed.transpose()?.flatten();
        if quality.basis == Basis::Sh && scene.lights.environment.is_some() {
            let found = [Some(harmonics::check(self, device)?), aimed];
            return Ok(found.into_iter().flatten().collect::<Vec<_>>().join("; "));
        }
        let errors = self.whole(&mut device.with(&all))?;
        let swept = sweeps::check(scene, places, device, drawn.as_ref())?;
        let sphere_lights = sphere_lights::check_slices(scene, places, &mut device.with(&all))?;
        let mut found = vec![swept, sphere_lights];
        if aimed.is_some() {
            let rest = self.without_aimed();
            let rest = rest.map(|rest| rest.whole(&mut device.with(&all))).transpose()?;
            found.extend([rest.map(|errors| sentence("other light", "the oracle", errors)), aimed]);
            // No bound: that of the RMSE allows for wrong shadows at some places. `aimed` judges each place.
            found.push(Some(format!(
                "RMSE of all light, also at shadow edges: {}",
                percent(errors.0)
            )));
        } else {
            found.push(Some(sentence("light", "the oracle", errors)));
        }
        Ok(found.into_iter().flatten().collect::<Vec<_>>().join("; "))
    }

    /// The error of the whole picture and its bound; an error where it exceeds that.
    fn whole(&self, device: &mut Device) -> Result<(f64, f64)> {
        let picture = device.picture(&self.scene)?;
        self.judge(self.ground_truth.error(&picture), device.quality)
    }

    /// The same scene without suns and key lights; `None` if it has no other lights.
    fn without_aimed(&self) -> Option<Self> {
        let lights = Lights { suns: Vec::new(), keys: Vec::new(), ..self.scene.lights.clone() };
        let is_lit =
            lights.sky.is_some() || lights.environment.is_some() || lights.near().next().is_some();
        let ground_truth = self.ground_truth.without_aimed();
        is_lit.then(|| Self { scene: Scene { lights, ..self.scene.clone() }, ground_truth })
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

/// The error of a light, or that the reference lights no place: [`Wanted::judge`] then has an infinite bound.
fn sentence(light: &str, against: &str, (error, bound): (f64, f64)) -> String {
    if bound == f64::INFINITY {
        return format!("{light}: none of the compared places is lit, according to {against}");
    }
    let [error, bound] = [error, bound].map(percent);
    format!("{light} error {error} against {against} (RMSE; bound {bound})")
}

/// A device and the settings to check on it.
struct Device<'a> {
    gpu: &'a mut Headless,
    quality: &'a Quality,
    limits: &'a Limits,
}

impl Device<'_> {
    /// The same with other settings.
    fn with<'b>(&'b mut self, quality: &'b Quality) -> Device<'b> {
        Device { gpu: self.gpu, quality, limits: self.limits }
    }

    /// The plan of a scene's picture and layers, and all of them.
    fn layers(&mut self, scene: &Scene, light_layers: bool) -> Result<(Plan, Vec<Pixels>)> {
        let wanted = Picture { light_layers, ..Picture::default() };
        let plan = plan::picture(scene, self.quality, self.limits, wanted)?;
        self.gpu.with_frame(plan.clone(), &plan::picture_inputs(scene), |gpu, frame| {
            gpu.draw(frame)?;
            let all = (0..plan.outputs().count()).map(|output| gpu.pixels(frame, output));
            Ok((plan, all.collect::<Result<_>>()?))
        })
    }

    fn picture(&mut self, scene: &Scene) -> Result<Pixels> {
        Ok(self.layers(scene, false)?.1.swap_remove(0))
    }
}

/// Light of the CPU reference at each place, R, G, B, and the tolerance of a device.
struct Wanted(Vec<[DVec3; 2]>);

impl Wanted {
    /// RMSE of `found` and RMS of its tolerance, both over the root mean square, if every value is
    /// within its tolerance. Both are infinite where the CPU reference is dark at every place.
    fn judge(&self, what: &str, found: &[DVec3], quality: &Quality) -> Result<(f64, f64)> {
        let [light, bounds] =
            [0, 1].map(|i| self.0.iter().flat_map(|both| both[i].to_array()).collect::<Vec<f64>>());
        let found = found.iter().flat_map(|v| v.to_array());
        if light.iter().all(|v| *v == 0.0) {
            for (found, bound) in found.zip(&bounds) {
                // NaN is above every bound.
                if found.abs() <= *bound {
                    continue;
                }
                let beyond = format!("above the bound of {bound:e}");
                let dark = "where the CPU reference is dark";
                return Err(refused(
                    &format!("{what} has light {found:e} {dark}, {beyond}"),
                    quality,
                ));
            }
            return Ok((f64::INFINITY, f64::INFINITY));
        }
        let scale = rms(light.iter().copied()).max(f64::MIN_POSITIVE);
        let off: Vec<f64> = found.zip(light).map(|(a, b)| (a - b) / scale).collect();
        for (off, bound) in off.iter().zip(&bounds) {
            within(what, "the CPU reference", off.abs(), bound / scale, quality)?;
        }
        let bound = rms(bounds.iter().map(|bound| bound / scale));
        within(what, "the CPU reference", rms(off.into_iter()), bound, quality)
    }
}

/// Whether a part of a key light is above horizontal ground. The plan drops others, and refuses a scene that has only those.
fn is_above_ground(key: &KeyLight, border: Border) -> bool {
    border == Border::Open || key.elevations_rad[1] > 0.0
}

/// The lowest and the highest height over the base.
fn heights_m(field: &HeightField) -> [f64; 2] {
    let all = || field.heights_m().iter().map(|h| f64::from(*h));
    [all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max)]
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
    let [error, bound] = [error, bound].map(|share| format!("{:.2} %", 100.0 * share));
    Err(refused(
        &format!(
            "{what} has an error of {error} against {ground_truth}, above the bound of {bound}"
        ),
        quality,
    ))
}

fn refused(found: &str, quality: &Quality) -> Error {
    let doing = format!("verifying before timing (fuse {})", quality.fuse);
    Error::Device { doing, reason: format!("{found}: times would be meaningless") }
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
/// stay small but squares do not, hence the wide bounds there. The 0.4 of suns is the square root of
/// the share of places, 0.16, that may be lit instead of dark; [`aimed`] judges each place alone.
/// Horizons towards a sphere light are exact; an upright edge in front of it has an error of half a
/// slice, and the widest slice has 2/n of the light.
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

/// The scene, or a piece of its middle where it is too large for the oracle.
pub fn piece(scene: &Scene) -> Result<Scene> {
    if scene.field.rows() <= WHOLE && scene.field.cols() <= WHOLE {
        return Ok(scene.clone());
    }
    middle(scene, PIECE)
}

/// The middle of the scene with its own heights, up to `most` grid points wide and high.
pub fn middle(scene: &Scene, most: usize) -> Result<Scene> {
    let field = &scene.field;
    let (rows, cols) = (field.rows(), field.cols());
    if rows <= most && cols <= most {
        return Ok(scene.clone());
    }
    let range = |side: usize| {
        let kept = side.min(most);
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
    let lights = scene.lights.moved([-west, -south]);
    let size = (range(rows).len(), range(cols).len());
    let field = HeightField::new(size.0, size.1, &heights, field.cell_m(), None)?;
    let surface = Surface { albedo, border: scene.surface.border, specular: phong };
    Ok(Scene { field, surface, lights })
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use ridgelight::scene::fractal;
    use ridgelight_cpu::light;
    use ridgelight_cpu::oracle::Oracle;

    impl Wanted {
        pub fn light(&self) -> Vec<DVec3> {
            self.0.iter().map(|[light, _]| *light).collect()
        }

        /// Takes its own light, with a tolerance below `most`. Refuses that light darker by a
        /// factor of `dim`, black, of a neighbour, of other colours, NaN, and `wrong` light.
        pub fn refuses(
            &self,
            quality: &Quality,
            [most, dim]: [f64; 2],
            wrong: &[(&str, Vec<DVec3>)],
        ) {
            let right = self.light();
            let (error, bound) = self.judge("light", &right, quality).unwrap();
            assert!(error == 0.0 && bound < most, "{error} {bound}");
            let mut turned = right.clone();
            turned.rotate_left(1);
            let mut holed = right.clone();
            holed[3].y = f64::NAN;
            let mut all = wrong.to_vec();
            all.extend([
                ("dim", right.iter().map(|v| dim * *v).collect()),
                ("black", vec![DVec3::ZERO; right.len()]),
                ("of a neighbour", turned),
                ("NaN", holed),
            ]);
            if right.iter().any(|v| v.x != v.z) {
                all.push(("of other colours", right.iter().map(|v| v.zyx()).collect()));
            }
            for (name, light) in all {
                assert!(self.judge("light", &light, quality).is_err(), "{name}: {quality:?}");
            }
        }
    }

    /// Every 61st of 48².
    pub fn places() -> Vec<usize> {
        (3..48 * 48).step_by(61).collect()
    }

    /// The plan of a picture and its layers of lights.
    pub fn layered(scene: &Scene, quality: &Quality) -> Plan {
        let wanted = Picture { light_layers: true, ..Picture::default() };
        plan::picture(scene, quality, &Limits::lavapipe(), wanted).unwrap()
    }

    /// A fractal field of this size.
    pub fn scene(size: usize, lights: Lights) -> Scene {
        Scene { field: fractal(size, 1).unwrap(), surface: Surface::default(), lights }
    }

    /// Relative to a dark reference, all errors would be infinite. Light up to the tolerance passes, and the sentence has no
    /// error; more light and NaN are refused.
    #[test]
    fn a_dark_reference_has_no_lit_place() {
        let dark = Wanted(vec![[DVec3::ZERO, DVec3::splat(1e-6)]; 5]);
        let judged = |light: f64| {
            let mut found = [DVec3::ZERO; 5];
            found[3].y = light;
            dark.judge("a sun at one place", &found, &Quality::default())
        };
        for light in [0.0, 1e-9, 1e-6] {
            let said = sentence("sun", "the CPU reference", judged(light).unwrap());
            assert_eq!(
                said,
                "sun: none of the compared places is lit, according to the CPU reference"
            );
        }
        for light in [1.01e-6, -1.01e-6, f64::INFINITY, f64::NAN] {
            let error = judged(light).unwrap_err().to_string();
            assert!(error.contains("a sun at one place has light"), "{error}");
            assert!(!error.contains('%'), "{error}");
        }
        // A lit place has figures.
        let lit = Wanted(vec![[DVec3::ONE, DVec3::splat(1e-6)]; 5]);
        let errors = lit.judge("a sun", &[DVec3::ONE; 5], &Quality::default()).unwrap();
        let said = sentence("sun", "the CPU reference", errors);
        assert_eq!(said, "sun error 0.000 % against the CPU reference (RMSE; bound 0.000 %)");
    }

    /// A slope that faces away from the sun: the oracle finds no light at any place. The error is then relative to half of the light
    /// of level ground.
    #[test]
    fn a_scene_in_shadow_is_judged_by_the_light_of_level_ground() {
        let heights: Vec<f64> = (0..24 * 24).map(|i| 2.0 * f64::from(i % 24)).collect();
        let field = HeightField::new(24, 24, &heights, [1.0; 2], None).unwrap();
        let sun = ridgelight::scene::Sun {
            azimuth_rad: 0.0,
            elevation_rad: 0.5,
            diameter_rad: 0.01,
            irradiance: [1.0; 3],
        };
        let lights = Lights { suns: vec![sun], ..Lights::default() };
        let scene = Scene { field, surface: Surface::default(), lights };
        let verifier = Verifier::new(&scene).unwrap();
        let ground_truth = &verifier.ground_truth;
        let level = 0.5_f64.sin() / std::f64::consts::PI;
        assert!((ground_truth.level / level - 1.0).abs() < 1e-3, "{} {level}", ground_truth.level);
        let lit = |share: f64| vec![share * level; ground_truth.places.len()];
        let dark = ground_truth.error_of(&lit(0.0));
        assert!(verifier.judge(dark, &Quality::default()).is_ok(), "{dark}");
        let unshadowed = ground_truth.error_of(&lit(1.0));
        assert!((unshadowed - 2.0).abs() < 0.01, "{unshadowed}");
        assert!(verifier.judge(unshadowed, &Quality::default()).is_err());
        assert!(verifier.judge(f64::NAN, &Quality::default()).is_err());
    }

    /// Results of broken passes (no shadows, black, a mirrored field, too dim, NaN) are refused at
    /// the bound of the default settings; the oracle at the settings' number of azimuths is
    /// accepted.
    #[test]
    fn wrong_light_is_refused() {
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        assert_eq!(Verifier::new(&scene(33, lights.clone())).unwrap().scene.field.rows(), 33);
        let verifier = Verifier::new(&scene(300, lights)).unwrap();
        let (quality, field) = (Quality::default(), &verifier.scene.field);
        let cols = field.cols();
        assert_eq!((field.rows(), cols), (PIECE, PIECE));
        let sky = |field: &HeightField, col: fn(usize) -> usize| -> Vec<f64> {
            let oracle = Oracle::new(field, Border::Plane);
            let at = |p: &usize| {
                light::sky_of(&oracle, p / cols, col(p % cols), quality.azimuths as usize)
            };
            verifier.ground_truth.places.iter().map(at).collect()
        };
        let judged = |light: &[f64]| {
            verifier.judge(verifier.ground_truth.error_of(light), &quality).map(|found| found.0)
        };
        let right = sky(field, |col| col);
        assert!(judged(&right).unwrap() < 0.01);
        let flat = HeightField::new(PIECE, PIECE, &[0.0; PIECE * PIECE], field.cell_m(), None);
        let mut holed = right.clone();
        holed[7] = f64::NAN;
        let wrong = [
            sky(field, |col| PIECE - 1 - col),
            sky(&flat.unwrap(), |col| col),
            right.iter().map(|v| 0.9 * v).collect(),
            vec![0.0; right.len()],
            holed,
        ];
        for (i, light) in wrong.iter().enumerate() {
            let error = judged(light).expect_err(&format!("wrong light {i}"));
            assert!(error.to_string().contains("verifying"), "{error}");
        }
    }
}
