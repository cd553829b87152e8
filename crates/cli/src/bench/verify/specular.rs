//! Compares Phong specular with the same sums in f64, within f32 rounding: sky and environment by
//! their series through the device's horizons, a sun by the device's own diffuse light, key lights and
//! sphere lights by the plan's slices. Sky and environment by slices of the lobe are compared with the
//! oracle, and so are key lights.

mod keys;
mod spheres;

use std::f64::consts::{LN_2, PI, TAU};

use glam::DVec3;
use ridgelight::Result;
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{
    Albedo, Basis, Environment, HeightField, Lights, PhongSpecular, Quality, Scene, Specular, Sun,
    Surface,
};
use ridgelight_cpu::harmonics::Harmonics;
use ridgelight_cpu::light::{Receiver, Site};
use ridgelight_cpu::mirror_map::mirrored;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sun_specular::{WHOLE, specular_on};
use ridgelight_cpu::tolerance::{
    EPSILON, Land, ShadeError, device_resolved, device_sun_specular, disc_rings,
};

use super::harmonics::{Place, with_nodes};
use super::{Device, Wanted, bounds, colours, heights_m, is_above_ground, rms, sentence, within};

/// Whether the plan reflects sky and environment by slices of the lobe.
fn by_slices(plan: &Plan) -> bool {
    plan.passes.iter().any(|pass| pass.name() == "specular_light")
}

/// The settings with the basis that the plan chooses for the specular surface.
pub(super) fn quality(scene: &Scene, quality: &Quality, limits: &Limits) -> Result<Quality> {
    let plan = plan::picture(scene, quality, limits, Picture::default())?;
    let is_series = plan.settings.iter().any(|(name, value)| name == "basis" && value == "sh");
    Ok(if is_series { Quality { basis: Basis::Sh, ..*quality } } else { *quality })
}

fn shines_around(lights: &Lights) -> bool {
    lights.sky.is_some_and(|c| c.iter().any(|v| *v > 0.0)) || lights.environment.is_some()
}

/// Phong specular of a scene at some of its texels: of sky and environment, suns, key lights and sphere lights.
pub(super) fn check(
    scene: &Scene,
    (places, dark): (&[usize], f64),
    device: &mut Device,
) -> Result<String> {
    if scene.surface.specular.as_ref().is_none_or(|specular| specular.largest().scale <= 0.0) {
        return Ok("the specular scale is 0 everywhere".to_owned());
    }
    let (scene, mut all) = (half(scene), scene.lights.lit());
    all.keys.retain(|key| is_above_ground(key, scene.surface.border));
    let under = |lights: Lights| Scene { lights, ..scene.clone() };
    let suns = Lights { suns: all.suns.clone(), ..Lights::default() };
    let sunlit = Lights { sky: all.sky, environment: all.environment.clone(), ..suns.clone() };
    let around = Lights { suns: Vec::new(), ..sunlit.clone() };
    let keys = Lights { keys: all.keys.clone(), ..Lights::default() };
    // One layer has the specular of all lights. Each frame has those that one reference computes.
    let mut found = Vec::new();
    let mut by_series = suns;
    if shines_around(&around) {
        let around = under(around);
        let plan = plan::picture(&around, device.quality, device.limits, Picture::default())?;
        match by_slices(&plan) {
            true => found.extend(slices(&around, (places, dark), device)?),
            false => by_series = sunlit,
        }
    }
    if shines_around(&by_series) || !by_series.suns.is_empty() {
        found.extend(series(&under(by_series), places, device)?);
    }
    if !keys.keys.is_empty() {
        found.extend(keys::check(&under(keys), (places, dark), device)?);
    }
    if all.near().next().is_some() {
        let [near, _] = all.near_and_far();
        found.push(spheres::check(&under(near), places, device)?);
    }
    match found.is_empty() {
        true => Ok("specular: no light is reflected".to_owned()),
        false => Ok(found.join("; ")),
    }
}

/// Specular of sky and environment by their series, and of suns; `None` where nothing is lit.
fn series(scene: &Scene, places: &[usize], device: &mut Device) -> Result<Option<String>> {
    let (_, layers) = device.layers(scene, true)?;
    let layer = |name: &str| Some(colours(layers.iter().find(|p| p.name == name)?, places));
    let Some(found) = layer("direct.specular") else { return Ok(None) };
    let suns: Vec<_> =
        (1..=scene.lights.suns.len()).map(|n| layer(&format!("direct.sun{n}"))).collect();
    let all = match shines_around(&scene.lights) {
        true => with_nodes(scene, places, device)?,
        false => places.iter().map(|p| Place::of(scene, *p)).collect(),
    };
    let (seeing, nodes) = all.split_at(places.len());
    let wanted = wanted_of(scene, device.quality, [seeing, nodes], &suns);
    let errors = wanted.judge("specular light at one place", &found, device.quality)?;
    Ok(Some(sentence("specular", "f64", errors)))
}

/// Places that the oracle compares: a lobe's integral over each texel of an environment takes long.
const SLICE_PLACES: usize = 12;

/// Specular of sky and environment by slices of the lobe, against the oracle.
fn slices(
    scene: &Scene,
    (places, dark): (&[usize], f64),
    device: &mut Device,
) -> Result<Option<String>> {
    let specular = scene.surface.specular.as_ref().expect("Phong specular");
    let (_, layers) = device.layers(scene, true)?;
    let places: Vec<usize> =
        places.iter().step_by(places.len().div_ceil(SLICE_PLACES)).copied().collect();
    let Some(layer) = layers.iter().find(|p| p.name == "direct.specular") else {
        return Ok(None);
    };
    let error = error_of(&colours(layer, &places), &slices_of(scene, specular, &places));
    let bound = slices_bound(scene, (specular, &places), dark, device.quality);
    let within = within("specular light", "the oracle", error, bound, device.quality)?;
    Ok(Some(sentence("specular", "the oracle", within)))
}

/// Bound of the relative RMSE of specular by slices.
///
/// A horizon is known in each azimuth only, so an edge of what a lobe covers is misplaced by up to half a wedge:
/// 1/√12 of it in the root mean square, at two edges √2 times that. The lobe is √(2π / (n + 1)) rad wide, as a
/// Gaussian of its deviation. Edges are where something is hidden; the light of a hidden share of half the sky has
/// one in every lobe. Horizons err as for the sky. Tables and maps err by 1 % at most (192 × 128 texels an azimuth;
/// nodes a quarter of the lobe apart). The narrowest lobe of the places counts. Between the exponent levels of a map, h = ln 2 apart, the
/// hidden share errs by 0.082 h² / 8. A cubic of light errs by 1.36 (h / 2)⁴ / 24 of the largest peak of its four levels, 2^1.5 of
/// the exponent's own at most.
fn slices_bound(
    scene: &Scene,
    (specular, places): (&Specular, &[usize]),
    dark: f64,
    quality: &Quality,
) -> f64 {
    let wedge = TAU / f64::from(quality.azimuths);
    let exponents = places.iter().map(|p| specular.at(*p).exponent);
    let width = (TAU / (f64::from(exponents.fold(0.0, f32::max)) + 1.0)).sqrt();
    let levels = match specular {
        Specular::Constant(_) => 0.0,
        Specular::Map(_) => {
            0.082 * LN_2.powi(2) / 8.0 + 1.36 * 2.0_f64.powf(1.5) * (0.5 * LN_2).powi(4) / 24.0
        }
    };
    let edges = (2.0 / 12.0_f64).sqrt() * wedge / width * (2.0 * dark).min(1.0).sqrt();
    let [of_sky, ..] = bounds(scene, dark, quality);
    0.01 + levels + edges + of_sky
}

/// RMSE over the root mean square.
fn error_of(found: &[DVec3], wanted: &[DVec3]) -> f64 {
    let scale = rms(wanted.iter().flat_map(|v| v.to_array())).max(f64::MIN_POSITIVE);
    rms(found.iter().zip(wanted).flat_map(|(a, b)| (*a - *b).to_array())) / scale
}

/// The oracle's specular of sky and environment at some places.
fn slices_of(scene: &Scene, specular: &Specular, places: &[usize]) -> Vec<DVec3> {
    let oracle = Oracle::new(&scene.field, scene.surface.border);
    let cols = scene.field.cols();
    let Lights { sky, environment, .. } = &scene.lights;
    let even = Environment::unknown(EVEN_STRIPS, 1, 0.0).expect("an even environment");
    let at = |p: &usize| {
        let (normal, phong) = (Place::of(scene, *p).normal, specular.at(*p));
        let receivers = [Receiver::specular_from_above(normal, phong.exponent.into())];
        let site = Site::of(&oracle, [p / cols, p % cols], &receivers);
        let of = |environment: &Environment| DVec3::from_array(site.environment(environment, 1)[0]);
        let mut light = DVec3::ZERO;
        if let Some(sky) = sky {
            light += DVec3::from_array(sky.map(f64::from)) * of(&even);
        }
        if let Some(environment) = environment {
            light += of(environment);
        }
        f64::from(phong.scale) * light
    };
    places.iter().map(at).collect()
}

/// Half the rounding error of the mirror direction for a view from above, without that of the normal: two products and a
/// difference.
const VIEW_ERROR: f64 = 10.0 * EPSILON;

/// Error of a field's normals, radians.
fn normal_error(field: &HeightField) -> f64 {
    let ([low, high], [x, y]) = (heights_m(field), field.cell_m());
    ShadeError::new(0.0, high - low, x.min(y), 1).normal()
}

/// Azimuths of the oracle's sky.
const EVEN_STRIPS: usize = 720;

/// Albedo of the ground of a [`half`] scene.
const GREY: f32 = 0.5;

/// Half the specular scale on grey ground. Its diffuse light gives each sun's visible share.
/// Specular is linear in its scale, and at half scale never exceeds the energy left beside any
/// albedo.
fn half(scene: &Scene) -> Scene {
    let halved = |phong: &PhongSpecular| PhongSpecular { scale: 0.5 * phong.scale, ..*phong };
    let phong = scene.surface.specular.as_ref().map(|specular| match specular {
        Specular::Constant(phong) => Specular::Constant(halved(phong)),
        Specular::Map(map) => Specular::Map(map.iter().map(halved).collect()),
    });
    let surface = Surface { albedo: Albedo::Constant([GREY; 3]), specular: phong, ..scene.surface };
    Scene { surface, ..scene.clone() }
}

/// Specular light of a [`half`] scene at some places; suns by their diffuse light there.
fn wanted_of(
    scene: &Scene,
    quality: &Quality,
    [places, nodes]: [&[Place]; 2],
    suns: &[Option<Vec<DVec3>>],
) -> Wanted {
    let specular = scene.surface.specular.as_ref().expect("Phong specular");
    let Lights { sky, environment, .. } = &scene.lights;
    let mut all = match shines_around(&scene.lights) {
        true => {
            let border = scene.surface.border;
            let sky = sky.unwrap_or_default();
            let harmonics = Harmonics::of(environment.as_ref(), Some(sky), border, quality);
            Wanted::lit(scene, quality, [places, nodes], &harmonics, |place, visibility, error| {
                harmonics.mirrored(place.normal, specular.at(place.index), visibility, error)
            })
        }
        false => Wanted(vec![[DVec3::ZERO; 2]; places.len()]),
    };
    for (sun, light) in scene.lights.suns.iter().zip(suns) {
        let Some(light) = light else { continue };
        for (i, place) in places.iter().enumerate() {
            let [mirrored, off] = of_sun(scene, sun, place, specular.at(place.index), light[i]);
            all.0[i][0] += mirrored;
            all.0[i][1] += off;
        }
    }
    let lights = 1 + suns.len();
    all.0.iter_mut().for_each(|[light, off]| *off += light.map(|v| device_resolved(v, lights)));
    all
}

/// Specular light of a sun that gives `light` to ground of albedo ½, and its tolerance. That light
/// is rounded three times, and specular light is proportional to it. This check does not know which part of the disc is
/// visible. Where the disc is partly hidden, the tolerance covers any value up to the lobe's maximum over it.
fn of_sun(
    scene: &Scene,
    sun: &Sun,
    place: &Place,
    phong: PhongSpecular,
    light: DVec3,
) -> [DVec3; 2] {
    let irradiance = DVec3::from_array(sun.irradiance.map(f64::from));
    let brightest = irradiance.max_position();
    let sum = light[brightest] / (0.5 * irradiance[brightest]);
    let reflected = irradiance * specular_on((place.normal, DVec3::Z), sun, phong, (sum, None));
    let (field, border) = (&scene.field, scene.surface.border);
    let at = [place.index / field.cols(), place.index % field.cols()];
    let (sin, cos) = sun.elevation_rad.sin_cos();
    let towards = DVec3::new(cos * sun.azimuth_rad.cos(), cos * sun.azimuth_rad.sin(), sin);
    let turned = Land::normal_at(field, border, at);
    let facing = place.normal.dot(towards);
    let exponent = f64::from(phong.exponent);
    let to_mirror = mirrored(place.normal, DVec3::Z).dot(towards);
    let off = device_sun_specular(exponent, turned, facing) + disc_rings(exponent, sun, to_mirror);
    // A hidden sun has no specular light.
    let off = if sum > 0.0 { f64::from(phong.scale) * off } else { 0.0 };
    let radius = 0.5 * sun.diameter_rad;
    let largest = scene.surface.specular.as_ref().map_or(0.0, |s| f64::from(s.largest().exponent));
    // As the planner decides.
    let has_vector = !sun.is_point() && largest * radius * radius > 0.01;
    let visible = PI * sum / facing.max(1e-9);
    let share = match facing > radius {
        // Of cosine and of solid angle: the same to 0.1 % where the whole disc is visible.
        true if visible >= WHOLE => 2.0 * (1.0 - WHOLE),
        true => visible.clamp(0.0, 1.0),
        false => 1.0,
    };
    let nearest = (to_mirror.clamp(-1.0, 1.0).acos() - radius).max(0.0);
    let peak = (exponent + 1.0) / TAU * nearest.cos().max(0.0).powf(exponent);
    let part = if has_vector && sum > 0.0 { share * f64::from(phong.scale) * peak } else { 0.0 };
    [reflected, irradiance * (off + part) + 6.0 * EPSILON * reflected]
}

#[cfg(test)]
mod tests {
    use super::super::harmonics::tests::{places, scene as sunlit};
    use super::*;

    /// Light by slices is refused where it is sharper, duller, of another light, or too bright by a tenth more than the bound; a tenth
    /// less is accepted.
    #[test]
    fn wrong_light_by_slices_is_refused() {
        let quality = Quality::default();
        for (exponent, is_map) in [(5.0, false), (20.0, false), (100.0, false), (20.0, true)] {
            let scene = sunlit();
            // A map of exponents up to this one.
            let of = |exponent: f32| match is_map {
                false => Specular::Constant(PhongSpecular { exponent, scale: 0.5 }),
                true => {
                    let all = (0..scene.field.heights_m().len()).map(|i| PhongSpecular {
                        exponent: exponent * (1 + i % 3) as f32 / 3.0,
                        scale: 0.5,
                    });
                    Specular::Map(all.collect())
                }
            };
            let cols = scene.field.cols();
            let places: Vec<usize> = (0..scene.field.heights_m().len()).step_by(cols + 7).collect();
            let right = slices_of(&scene, &of(exponent), &places);
            let dark = super::super::GroundTruth::of(&scene).dark();
            let bound = slices_bound(&scene, (&of(exponent), &places), dark, &quality);
            assert!(bound > 0.0 && bound < 0.2, "{exponent}: {bound}");
            let mut unlit = scene.clone();
            unlit.lights.environment = None;
            unlit.lights.sky = Some([1.0; 3]);
            let scaled = |factor: f64| right.iter().map(|v| factor * *v).collect::<Vec<_>>();
            let near = error_of(&scaled(1.0 + 0.9 * bound), &right);
            assert!(0.0 < near && near < bound, "{exponent}: {near} of {bound}");
            let wrong = [
                ("sharper", slices_of(&scene, &of(2.0 * exponent), &places)),
                ("duller", slices_of(&scene, &of(0.5 * exponent), &places)),
                ("of another light", slices_of(&unlit, &of(exponent), &places)),
                ("too bright", scaled(1.0 + 1.1 * bound)),
            ];
            for (what, wrong) in wrong {
                let error = error_of(&wrong, &right);
                assert!(error > bound, "{exponent}, {what}: {error} within {bound}");
            }
        }
    }

    /// Wrong light is refused: sharper, without the sun, of the sun alone.
    #[test]
    fn wrong_specular_light_is_refused() {
        let irradiance = [3.0, 2.0, 1.0];
        let sun = Sun { azimuth_rad: 1.0, elevation_rad: 1.2, diameter_rad: 0.0, irradiance };
        let mut scene = sunlit();
        scene.lights.suns = vec![sun];
        let base = Quality { basis: Basis::Sh, azimuths: 16, ..Quality::default() };
        for (exponent, sh_order) in [(5.0, 3), (40.0, 4), (9.0, 2)] {
            let with_specular = |exponent: f32| {
                let phong = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.5 }));
                let surface = Surface { specular: phong, ..scene.surface.clone() };
                half(&Scene { surface, ..scene.clone() })
            };
            let quality = Quality { sh_order, ..base };
            let known = places(&scene, &quality);
            // The whole sun is visible.
            let facing = |p: &Place| {
                let (sin, cos) = sun.elevation_rad.sin_cos();
                let e = DVec3::new(cos * sun.azimuth_rad.cos(), cos * sun.azimuth_rad.sin(), sin);
                let share = 0.5 * p.normal.dot(e).max(0.0) / std::f64::consts::PI;
                share * DVec3::from_array(sun.irradiance.map(f64::from))
            };
            let light: Vec<DVec3> = known.iter().map(facing).collect();
            let of = |scene: &Scene, light: Option<Vec<DVec3>>| {
                wanted_of(scene, &quality, [&known, &known], &[light])
            };
            let right = with_specular(exponent);
            let mut dark = right.clone();
            dark.lights.environment = None;
            let wrong = [
                ("sharper", of(&with_specular(1.5 * exponent), Some(light.clone())).light()),
                ("without the sun", of(&right, None).light()),
                ("of the sun alone", of(&dark, Some(light.clone())).light()),
            ];
            // Sums of n⁴ products of visibility and light, each with its own error.
            of(&right, Some(light)).refuses(&quality, [0.05, 0.9], &wrong);
        }
    }
}
