//! Compares specular of key lights with the plan's slices of the lobe: through the oracle's horizons, within the range of the
//! method's, and through the same sweeps in f64, within f32 rounding. Specular changes the slices of a key light, so the diffuse
//! light of the same frame is compared, too.

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Pixels;
use ridgelight::plan::{Azimuth, Plan};
use ridgelight::scene::{PhongSpecular, Quality, Scene, Specular};
use ridgelight_cpu::key_specular::key_specular;
use ridgelight_cpu::mirror_map::mirrored;
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::tolerance::{EPSILON, ShadeError, device_resolved};

use super::super::aimed::{self, Allowed, Horizons, Judged, allowed_by, horizons, judge_each};
use super::super::sweeps::{AimedLayers, Shaded, azimuths_of, check_aimed, followed, lit};
use super::super::{Device, Wanted, bounds, colours, percent, rms, sentence, within};
use super::{GREY, VIEW_ERROR, normal_error};

/// Specular and diffuse light of a [`half`](super::half) scene's key lights, which are its only lights and above the ground; `None`
/// without a layer of specular.
pub(super) fn check(
    scene: &Scene,
    (places, dark): (&[usize], f64),
    device: &mut Device,
) -> Result<Option<String>> {
    let quality = device.quality;
    let (plan, layers) = device.layers(scene, true)?;
    let Some(layer) = layers.iter().find(|layer| layer.name == "direct.specular") else {
        return Ok(None);
    };
    let (found, keys) = (colours(layer, places), keys_of(scene, &plan));
    let all = allowed(scene, &keys, places, quality);
    let mut texts = vec![judge(&found, &all, quality)?.text("key specular")];
    if keys.iter().any(|key| horizons(quality, key.shaded) == Horizons::Near) {
        let [of_sky, ..] = bounds(scene, dark, quality);
        let more = || {
            let places = more_places(scene);
            (colours(layer, &places), allowed(scene, &keys, &places, quality))
        };
        texts.extend(judge_enough((&found, &all), more, of_sky, quality)?);
    }
    let is_swept = plan.passes.iter().any(|pass| pass.name() == "horizon_sweep");
    let lines = followed(scene, quality).filter(|_| is_swept);
    if let Some(lines) = lines {
        let wanted = wanted(scene, &keys, places, lines);
        let errors = wanted.judge("specular of key lights at one place", &found, quality)?;
        texts.push(sentence("key specular", "the CPU reference", errors));
    }
    let diffuse = AimedLayers { layers: on_white(scene, layers), scene: scene.clone(), plan };
    let beside = |text: String| format!("beside specular, {text}");
    texts.extend(aimed::check(&diffuse, places, quality)?.map(beside));
    if let Some(lines) = lines {
        texts.extend(check_aimed(&diffuse, places, quality, lines)?.map(beside));
    }
    Ok(Some(texts.join("; ")))
}

/// A key light as the plan lights it.
struct Key {
    radiance: DVec3,
    azimuths: Vec<Azimuth>,
    shaded: Shaded,
}

fn keys_of(scene: &Scene, plan: &Plan) -> Vec<Key> {
    let keys = scene.lights.keys.iter().enumerate();
    keys.filter_map(|(i, key)| {
        let (azimuths, shaded) = azimuths_of(plan, &format!("key{}", i + 1))?;
        let radiance = DVec3::from_array(key.radiance.map(f64::from));
        Some(Key { radiance, azimuths, shaded })
    })
    .collect()
}

fn specular_of(scene: &Scene) -> &Specular {
    scene.surface.specular.as_ref().expect("Phong specular")
}

/// Light and tolerance of one azimuth for radiance and scale 1, viewed from straight above.
fn slice(
    phong: PhongSpecular,
    azimuth: &Azimuth,
    lowest: f64,
    (normal, off): (DVec3, [f64; 2]),
) -> [f64; 2] {
    let mirror = mirrored(normal, DVec3::Z);
    key_specular(phong.exponent.into(), azimuth, (mirror, lowest), off)
}

/// Specular light of all key lights at one place, R, G, B.
type Reflected = Allowed<DVec3>;

/// What the plan's slices of the key lights allow at each place. The error of a horizon is in the range, not in the tolerance.
fn allowed(scene: &Scene, keys: &[Key], places: &[usize], quality: &Quality) -> Vec<Reflected> {
    let specular = specular_of(scene);
    let off = [2.0 * (normal_error(&scene.field) + VIEW_ERROR), 0.0];
    let mut all = vec![Reflected::default(); places.len()];
    for Key { radiance, azimuths, shaded } in keys {
        let of_slice = |place: usize, azimuth: &Azimuth, lowest: f64, normal: DVec3| {
            slice(specular.at(place), azimuth, lowest, (normal, off))
        };
        let of_key = allowed_by(scene, azimuths, *shaded, places, quality, of_slice);
        for ((sum, one), place) in all.iter_mut().zip(of_key).zip(places) {
            let factor = *radiance * f64::from(specular.at(*place).scale);
            let [least, most] = one.range;
            // Sums of the azimuths, products with radiance and scale, and a sum.
            let rounded = (azimuths.len() as f64 + 4.0) * EPSILON * most;
            sum.light += factor * one.light;
            sum.range = [sum.range[0] + factor * least, sum.range[1] + factor * most];
            sum.tolerance += factor * (one.tolerance + rounded);
        }
    }
    for sum in &mut all {
        sum.tolerance += sum.range[1].map(|most| device_resolved(most, keys.len()));
    }
    all
}

fn judge(found: &[DVec3], all: &[Reflected], quality: &Quality) -> Result<Judged> {
    judge_each("specular of key lights at one place is", found, all, quality)
}

/// Share of equally bright places that may be lit instead of dark, or dark instead of lit: that of suns in [`bounds`].
const WRONG_SHARE: f64 = 0.16;

/// About this many texels are compared where too few of the usual ones are bright.
const MORE_PLACES: usize = 1600;

/// These texels, spread over the field as the usual ones.
fn more_places(scene: &Scene) -> Vec<usize> {
    let count = scene.field.rows() * scene.field.cols();
    (0..count).step_by((count / MORE_PLACES).max(1) | 1).collect()
}

/// [`judge_all`], at `more` places where too few of these are bright. Those are then judged one by one, too.
fn judge_enough(
    (found, all): (&[DVec3], &[Reflected]),
    more: impl FnOnce() -> (Vec<DVec3>, Vec<Reflected>),
    of_sky: f64,
    quality: &Quality,
) -> Result<Option<String>> {
    // Where no place is lit, the bound is NaN or infinite.
    if bound_of(all, of_sky) < BLACK {
        return judge_all(found, all, of_sky, quality);
    }
    let (found, all) = more();
    judge(&found, &all, quality)?;
    judge_all(&found, &all, of_sky, quality)
}

/// The relative error of an image without light.
const BLACK: f64 = 1.0;

/// Judges all places together where the range of each reaches down to 0; `None` where the oracle finds no light.
fn judge_all(
    found: &[DVec3],
    all: &[Reflected],
    of_sky: f64,
    quality: &Quality,
) -> Result<Option<String>> {
    let values = |v: DVec3| v.to_array();
    let light = rms(all.iter().flat_map(|place| values(place.light)));
    if light <= 0.0 {
        return Ok(None);
    }
    let errors = found.iter().zip(all).map(|(found, place)| *found - place.light);
    let error = rms(errors.flat_map(values)) / light;
    let bound = bound_of(all, of_sky);
    let errors = within("specular of key lights", "the oracle", error, bound, quality)?;
    if bound >= BLACK {
        let error = percent(error);
        return Ok(Some(format!(
            "key specular at all places is not judged, as too few of them are bright: error {error} against the oracle"
        )));
    }
    Ok(Some(sentence("key specular at all places", "the oracle", errors)))
}

/// Bound of the relative RMSE where horizons may be too high or too low.
///
/// Horizons err as for the sky. A place at a shadow's edge is wrong by all of its unshadowed light at most, whose square counts. Few
/// places are bright: with squares q they count as (Σ q)² / Σ q² places that are equally bright. Of N such places more than
/// [`WRONG_SHARE`] can be wrong, by three standard deviations √(w (1 - w) / N) of the share w.
fn bound_of(all: &[Reflected], of_sky: f64) -> f64 {
    let squares: Vec<f64> = all.iter().map(|place| place.range[1].length_squared()).collect();
    let unshadowed: f64 = squares.iter().sum();
    let lit: f64 = all.iter().map(|place| place.light.length_squared()).sum();
    let count = unshadowed * unshadowed / squares.iter().map(|q| q * q).sum::<f64>();
    let share = WRONG_SHARE + 3.0 * (WRONG_SHARE * (1.0 - WRONG_SHARE) / count).sqrt();
    of_sky + (share.min(1.0) * unshadowed / lit).sqrt()
}

/// Specular light of the CPU reference, by the same sweeps.
fn wanted(scene: &Scene, keys: &[Key], places: &[usize], lines: u32) -> Wanted {
    let (specular, cols) = (specular_of(scene), scene.field.cols());
    let mut all = vec![[DVec3::ZERO; 2]; places.len()];
    for Key { radiance, azimuths, shaded } in keys {
        let of_key = lit(scene, azimuths.clone(), shaded.fuse, lines, |swept, error| {
            let at = |place: &usize| swept_at(swept, error, (*place, cols), specular.at(*place));
            places.iter().map(at).collect::<Vec<_>>()
        });
        for ((sum, [light, off]), place) in all.iter_mut().zip(of_key).zip(places) {
            let factor = *radiance * f64::from(specular.at(*place).scale);
            sum[0] += factor * light;
            // Products with radiance and scale, and a sum.
            let rounded = 4.0 * EPSILON * sum[0];
            sum[1] += factor * off + rounded;
        }
    }
    for [light, off] in &mut all {
        *off += light.map(|v| device_resolved(v, keys.len()));
    }
    Wanted(all)
}

/// The light of all azimuths at a place for radiance and scale 1, and its tolerance.
fn swept_at(
    swept: &Swept,
    error: &ShadeError,
    (place, cols): (usize, usize),
    phong: PhongSpecular,
) -> [f64; 2] {
    let off = [2.0 * (error.normal() + VIEW_ERROR), error.lowest_slope()];
    let mut sum = [0.0; 2];
    swept.add_all(
        [(place % cols) as i32, (place / cols) as i32],
        true,
        |_, azimuth, lowest, normal| {
            let one = slice(phong, azimuth, lowest, (normal, off));
            sum = [sum[0] + one[0], sum[1] + one[1]];
        },
    );
    [sum[0], sum[1] + swept.azimuths.len() as f64 * EPSILON * sum[0]]
}

/// Layers of key lights on ground of albedo [`GREY`] as for radiance 1 on white ground, by each light's brightest channel.
fn on_white(scene: &Scene, layers: Vec<Pixels>) -> Vec<Pixels> {
    let key_of = |layer: &Pixels| -> Option<usize> {
        layer.name.strip_prefix("direct.key")?.parse::<usize>().ok()?.checked_sub(1)
    };
    let of = |layer: Pixels| {
        let key = scene.lights.keys.get(key_of(&layer)?)?;
        let radiance = DVec3::from_array(key.radiance.map(f64::from));
        let brightest = radiance.max_position().min(layer.channels - 1);
        let factor = 1.0 / (f64::from(GREY) * radiance.max_element());
        let texels = layer.values.chunks_exact(layer.channels);
        let values = texels.map(|texel| (factor * f64::from(texel[brightest])) as f32).collect();
        Some(Pixels { channels: 1, values, ..layer })
    };
    layers.into_iter().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::half;
    use super::*;
    use crate::bench::verify::tests::{layered, places, scene as fractal};
    use ridgelight::scene::{Fuse, KeyLight, Lights, Surface};

    /// A fractal under a key light, and the same by the plan.
    fn lit_by(azimuth_rad: f64, exponent: f32, quality: &Quality) -> (Scene, Vec<Key>) {
        let (width_rad, elevations_rad) = (1.5, [0.05, 1.3]);
        let radiance = [4.0, 2.0, 1.0];
        let key = KeyLight { azimuth_rad, width_rad, elevations_rad, radiance };
        let scene = fractal(48, Lights { keys: vec![key], ..Lights::default() });
        let phong = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.5 }));
        let scene = half(&Scene { surface: Surface { specular: phong, ..scene.surface }, ..scene });
        let keys = keys_of(&scene, &layered(&scene, quality));
        assert_eq!(keys.len(), 1);
        (scene, keys)
    }

    /// By the same sweeps, wrong light is refused: sharper, duller, of a light turned by 0.3 rad, without shadows.
    #[test]
    fn wrong_specular_of_swept_key_lights_is_refused() {
        let quality = Quality { sun_azimuths: 8, ..Quality::default() };
        let lines = followed(&lit_by(1.0, 5.0, &quality).0, &quality).expect("swept");
        for exponent in [5.0, 20.0] {
            let of = |azimuth_rad: f64, exponent: f32| {
                let (scene, keys) = lit_by(azimuth_rad, exponent, &quality);
                wanted(&scene, &keys, &places(), lines)
            };
            let (scene, keys) = lit_by(1.0, exponent, &quality);
            let open = allowed(&scene, &keys, &places(), &quality);
            let wrong = [
                ("sharper", of(1.0, 1.5 * exponent).light()),
                ("duller", of(1.0, 0.7 * exponent).light()),
                ("turned", of(1.3, exponent).light()),
                ("without shadows", open.iter().map(|place| place.range[1]).collect()),
            ];
            of(1.0, exponent).refuses(&quality, [0.05, 0.9], &wrong);
        }
    }

    /// Light outside a place's range is refused in each channel. The range ends at the unshadowed light. It begins at the oracle's
    /// light where a method misses occluders at most, else at 0.
    #[test]
    fn wrong_specular_of_key_lights_is_refused_at_each_place() {
        let aimed = Quality { sun_azimuths: 8, ..Quality::default() };
        let near = Quality { fuse: Fuse::Nearest, ..aimed };
        for (quality, may_be_dark) in [(aimed, false), (near, true)] {
            let (scene, keys) = lit_by(1.0, 5.0, &quality);
            let all = allowed(&scene, &keys, &places(), &quality);
            let right: Vec<DVec3> = all.iter().map(|place| place.light).collect();
            let judged = judge(&right, &all, &quality).unwrap();
            assert_eq!((judged.others, judged.error), (0, 0.0));
            assert!(judged.bound < 0.05 * judged.brightest, "{judged:?}");
            for (i, Reflected { range: [least, most], tolerance, .. }) in all.iter().enumerate() {
                for (c, end) in [(0, *most + 2.0 * *tolerance), (2, *least - 2.0 * *tolerance)] {
                    for wrong in [end[c], f64::NAN] {
                        let mut found = right.clone();
                        found[i][c] = wrong;
                        let error = judge(&found, &all, &quality).unwrap_err().to_string();
                        assert!(error.contains("specular of key lights at one place"), "{error}");
                    }
                }
            }
            let brightest =
                (0..all.len()).max_by(|a, b| right[*a].x.total_cmp(&right[*b].x)).expect("a place");
            let mut dark = right.clone();
            dark[brightest] = DVec3::ZERO;
            assert_eq!(judge(&dark, &all, &quality).is_ok(), may_be_dark);
        }
    }

    /// Of one bright place nothing is known, so black would pass. It is refused at more places, which are not computed where
    /// they are not needed.
    #[test]
    fn more_places_are_compared_where_too_few_are_bright() {
        let quality = Quality { fuse: Fuse::Nearest, ..Quality::default() };
        let bright = |count: usize| {
            let place = Reflected {
                light: DVec3::ONE,
                range: [DVec3::ZERO, DVec3::ONE],
                tolerance: DVec3::splat(1e-6),
            };
            vec![place; count]
        };
        let judged = |count: usize, light: f64| {
            let [few, many] = [bright(count), bright(100)];
            let found = vec![DVec3::ONE; count];
            let more = || (vec![DVec3::splat(light); 100], many);
            judge_enough((&found, &few), more, 0.1, &quality)
        };
        for count in [0, 1, 2] {
            let text = judged(count, 1.0).unwrap().expect("lit");
            assert!(text.starts_with("key specular at all places error 0.000 %"), "{text}");
            let error = judged(count, 0.0).unwrap_err().to_string();
            assert!(error.contains("specular of key lights has an error of 100.00 %"), "{error}");
            // More than unshadowed at each of them.
            let error = judged(count, 1.1).unwrap_err().to_string();
            assert!(error.contains("specular of key lights at one place"), "{error}");
        }
        // Enough of them are bright: what `more` would find does not count.
        assert!(judged(100, 0.0).unwrap().is_some());
        // All texels of a small field, and about as many of a larger one.
        let of = |size: usize| more_places(&fractal(size, Lights::default())).len();
        assert_eq!((of(32), of(128)), (32 * 32, (128 * 128_usize).div_ceil(11)));
    }

    /// Where each place may be dark, all of them may not: black is refused, and so is light that is wrong by more than the bound.
    #[test]
    fn black_specular_of_key_lights_is_refused() {
        let quality = Quality { sun_azimuths: 8, fuse: Fuse::Nearest, ..Quality::default() };
        let (scene, keys) = lit_by(1.0, 5.0, &quality);
        let places: Vec<usize> = (0..48 * 48).step_by(11).collect();
        let all = allowed(&scene, &keys, &places, &quality);
        let bound = bound_of(&all, 0.1);
        assert!(bound < 1.0, "{bound}");
        let scaled =
            |factor: f64| -> Vec<DVec3> { all.iter().map(|place| factor * place.light).collect() };
        let judged = |found: Vec<DVec3>| judge_all(&found, &all, 0.1, &quality);
        assert!(judged(scaled(1.0)).unwrap().is_some());
        assert!(judged(scaled(1.0 - 0.9 * bound)).is_ok());
        for wrong in [0.0, 1.0 - 1.1 * bound, 1.0 + 1.1 * bound, f64::NAN] {
            let error = judged(scaled(wrong)).unwrap_err().to_string();
            assert!(error.contains("specular of key lights has an error"), "{error}");
        }
        // Of a single bright place nothing is known: it may be at a shadow's edge.
        let range = [DVec3::ZERO, DVec3::ONE];
        let single = Reflected { light: DVec3::ONE, range, ..Reflected::default() };
        let text = judge_all(&[DVec3::ZERO], &[single], 0.1, &quality).unwrap().expect("lit");
        assert!(
            text.ends_with("too few of them are bright: error 100.000 % against the oracle"),
            "{text}"
        );
        let dark = vec![Reflected::default(); 3];
        assert!(judge_all(&[DVec3::ZERO; 3], &dark, 0.1, &quality).unwrap().is_none());
    }
}
