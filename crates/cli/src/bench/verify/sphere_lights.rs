//! Compares sphere lights with the same slices or the same series in f64, within f32 rounding. The
//! error of the series itself is reported, not bounded.

use std::collections::BTreeSet;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Levels, Lights, Method, Quality, Scene, SphereLight};
use ridgelight_cpu::light::normal;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::soft_sphere::{SphereShError, device_pyramid_within, device_surface_within};
use ridgelight_cpu::sphere_sh_shade::SphereSh;
use ridgelight_cpu::sphere_shade::sphere_at;
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry, device_pyramid_slope, device_resolved};

use super::sweeps::white;
use super::{Device, GroundTruth, Wanted, albedo_of, colours, percent, rms, sentence};

/// The scene's sphere lights on white ground, at some texels, against slices; none where none has
/// radiance.
pub(super) fn check_slices(
    scene: &Scene,
    places: &[usize],
    device: &mut Device,
) -> Result<Option<String>> {
    let lights = scene.lights.near_and_far()[0].lit();
    if lights.near().next().is_none() {
        return Ok(None);
    }
    let scene = white(scene, lights);
    let found = colours(&device.picture(&scene)?, places);
    let wanted = slices(&scene, places, device.quality);
    let errors = wanted.judge("sphere light at one place", &found, device.quality)?;
    Ok(Some(sentence("sphere light", "f64 slices", errors)))
}

/// Light of slices on white ground.
fn slices(scene: &Scene, places: &[usize], quality: &Quality) -> Wanted {
    let oracle = Oracle::new(&scene.field, scene.surface.border);
    let cols = scene.field.cols();
    summed(scene, places, |light, p| {
        let share = sphere_at(&oracle, light, quality.sun_azimuths, p / cols, p % cols);
        let geometry = SphereGeometry::of(&scene.field, light, p);
        let off = geometry.tolerance() + 4.0 * EPSILON * share;
        [DVec3::splat(share), DVec3::splat(off)]
    })
}

/// The sum over all sphere lights of what `of` finds of each under a radiance of 1.
fn summed(
    scene: &Scene,
    places: &[usize],
    mut of: impl FnMut(&SphereLight, usize) -> [DVec3; 2],
) -> Wanted {
    let lights: Vec<_> = scene.lights.near().map(|light| light.sphere).collect();
    let mut at = |p: &usize| {
        let mut sum = [DVec3::ZERO; 2];
        for light in &lights {
            let radiance = DVec3::from_array(light.radiance.map(f64::from));
            let found = of(light, *p);
            sum = [0, 1].map(|i| sum[i] + radiance * found[i]);
        }
        [sum[0], sum[1] + sum[0].map(|v| device_resolved(v, lights.len()))]
    };
    Wanted(places.iter().map(&mut at).collect())
}

/// A scene's sphere lights alone, at some of its texels, against harmonics.
pub(super) fn check(
    scene: &Scene,
    ground_truth: &GroundTruth,
    device: &mut Device,
) -> Result<String> {
    let [lights, _] = scene.lights.near_and_far();
    let (scene, quality) = (&Scene { lights, ..scene.clone() }, device.quality);
    // The plan bounds the light of culled sphere lights.
    let all = Quality { light_cutoff: 0.0, ..*quality };
    let plan = plan::picture(scene, &all, device.limits, Picture::default())?;
    let (picture, levels) =
        device.gpu.with_frame(plan, &plan::picture_inputs(scene), |gpu, frame| {
            gpu.draw(frame)?;
            // A pyramid's levels are the device's own: only the light from them is compared.
            let names = ["height_stack", "height_levels"];
            let id = names.into_iter().find_map(|name| frame.plan().find(name));
            let words = id.map(|id| gpu.read(frame, id)).transpose()?.unwrap_or_default();
            let levels: Vec<f32> = words.into_iter().map(f32::from_bits).collect();
            Ok((gpu.pixels(frame, 0)?, levels))
        })?;
    let places = &ground_truth.places;
    let (wanted, negative) = series(scene, quality, &levels, places);
    let what = format!("sphere light of order {} at one place", quality.sh_order);
    let errors = wanted.judge(&what, &colours(&picture, places), quality)?;
    let means = ground_truth.means(&picture);
    let sphere_lights = ground_truth.expected.iter().map(|[.., sphere_lights]| *sphere_lights);
    let missed = rms(means.iter().zip(sphere_lights.clone()).map(|(a, b)| a - b));
    let scale = rms(sphere_lights);
    let with_truncation = match scale > 0.0 {
        true => format!("their light's error is {} against the oracle", percent(missed / scale)),
        false => "none of the compared places is lit, according to the oracle".to_owned(),
    };
    Ok(format!(
        "{}, below 0 at {negative} of {} places; including truncation at order {}, {with_truncation}",
        sentence("sphere light harmonics", "f64", errors),
        places.len(),
        quality.sh_order,
    ))
}

/// Light of the series, and the number of places where a light's series rings below 0 and is
/// clamped to 0.
fn series(scene: &Scene, quality: &Quality, levels: &[f32], places: &[usize]) -> (Wanted, usize) {
    let (field, border) = (&scene.field, scene.surface.border);
    let levels = (quality.method == Method::Pyramid).then(|| {
        let pyramid = Pyramid::new(quality, [field.cols() as u32, field.rows() as u32], border);
        let stored = match quality.levels {
            Levels::Stack => Stored::Stack(levels),
            Levels::Pyramid => Stored::Levels(levels),
        };
        (pyramid, stored)
    });
    let reference = SphereSh::new(Oracle::new(field, border), levels, *quality);
    let (errors, mut ringing) = (SphereShError::new(quality), BTreeSet::new());
    let largest = field.heights_m().iter().fold(0.0, |m, h| f64::from(h.abs()).max(m));
    let wanted = summed(scene, places, |sphere_light, place| {
        let (row, col) = (place / field.cols(), place % field.cols());
        let soft = reference.at(sphere_light, row, col);
        if soft.light < 0.0 {
            ringing.insert(place);
        }
        let geometry = SphereGeometry::of(field, sphere_light, place);
        let slope = slope_error(&geometry, quality, largest);
        let normal = normal(field, border, row, col);
        let off = errors.tolerance(&geometry, slope, normal, &soft.visibility);
        let light = soft.light.max(0.0);
        let albedo = DVec3::from_array(albedo_of(scene, place));
        [albedo * light, albedo * (off + 4.0 * EPSILON * light)]
    });
    (wanted, places.iter().filter(|p| ringing.contains(*p)).count())
}

/// Error of slopes towards a sphere light: of the surface, or of a pyramid's levels.
fn slope_error(geometry: &SphereGeometry, quality: &Quality, largest: f64) -> f64 {
    if quality.method != Method::Pyramid {
        return device_surface_within(geometry);
    }
    let (relief, step) = (geometry.relief_m, geometry.cell_m);
    let steepest = relief / step;
    let march = device_pyramid_slope(steepest, largest, relief, step);
    device_pyramid_within(geometry, march, steepest, quality.level_step)
}

/// A scene without its lights near the field; none without other lights.
pub(super) fn without(scene: &Scene) -> Option<Scene> {
    let [_, lights] = scene.lights.near_and_far();
    let Lights { sky, environment, suns, keys, .. } = &lights;
    let shines = sky.is_some() || environment.is_some() || !suns.is_empty() || !keys.is_empty();
    shines.then(|| Scene { lights, ..scene.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::verify::tests::{places, scene};
    use ridgelight::scene::{HeightField, LightBasis, Receiver, Wedges};
    use ridgelight_cpu::sphere::sphere_of;

    /// Wrong light is refused: of fewer slices, of a light a tenth of a cell aside or a tenth wider,
    /// without occlusion.
    #[test]
    fn wrong_sphere_lights_are_refused() {
        let field = scene(48, Lights::default()).field;
        let cell = field.cell_m()[0];
        let highest = f64::from(field.heights_m().iter().fold(0.0_f32, |m, h| m.max(*h)));
        let of = |aside: f64, wider: f64, quality: &Quality, is_flat: bool| {
            let z = field.base_m() + highest + 2.0 * cell;
            let position_m = [(20.0 + aside) * cell, 30.0 * cell, z];
            let radiance = [4.0, 2.0, 1.0];
            let light = SphereLight { position_m, radius_m: wider * cell, radiance };
            let mut scene = scene(48, Lights { sphere_lights: vec![light], ..Lights::default() });
            if is_flat {
                let level = vec![field.base_m(); 48 * 48];
                scene.field = HeightField::new(48, 48, &level, [cell; 2], None).unwrap();
            }
            slices(&scene, &places(), quality)
        };
        let quality = Quality { sun_azimuths: 8, ..Quality::default() };
        let few = Quality { sun_azimuths: 4, ..quality };
        let wrong = [
            ("of fewer slices", of(0.0, 1.0, &few, false).light()),
            ("from beside", of(0.1, 1.0, &quality, false).light()),
            ("wider", of(0.0, 1.1, &quality, false).light()),
            ("on level ground", of(0.0, 1.0, &quality, true).light()),
        ];
        of(0.0, 1.0, &quality, false).refuses(&quality, [0.005, 0.99], &wrong);
    }

    /// Wrong light is refused for every order and form: of a light moved aside, of another order, of
    /// the exact form.
    #[test]
    fn wrong_sphere_light_harmonics_are_refused() {
        let mut scene = scene(32, Lights::default());
        let position_m = [13.0, 17.0, scene.field.base_m() + 9.0];
        let sphere_light = SphereLight { position_m, radius_m: 2.0, radiance: [3.0, 1.0, 0.5] };
        scene.lights.sphere_lights = vec![sphere_light];
        let mut moved = scene.clone();
        moved.lights.sphere_lights[0].position_m[0] += 0.5;
        let oracle = Oracle::new(&scene.field, scene.surface.border);
        let exact = |p: &usize| {
            let share = sphere_of(&oracle, p / 32, p % 32, &sphere_light, 32);
            DVec3::from_array(sphere_light.radiance.map(|r| f64::from(r) * share))
        };
        let places: Vec<usize> = (5..32 * 32).step_by(97).collect();
        let base = Quality { light_basis: LightBasis::Sh, sun_azimuths: 8, ..Quality::default() };
        for (sh_order, wedges, receiver) in [
            (2, Wedges::Slices, Receiver::Plane),
            (4, Wedges::Nlp, Receiver::Plane),
            (4, Wedges::Table, Receiver::Cosine),
            (6, Wedges::Slices, Receiver::Plane),
        ] {
            let quality = Quality { sh_order, wedges, receiver, ..base };
            let of = |scene: &Scene, quality: &Quality| series(scene, quality, &[], &places).0;
            let other = if sh_order == 6 { 5 } else { sh_order + 1 };
            let wrong = [
                ("order", of(&scene, &Quality { sh_order: other, ..quality }).light()),
                ("of a light moved aside", of(&moved, &quality).light()),
                ("of the exact form", places.iter().map(exact).collect()),
            ];
            // f32 cancellation of the fits' weights grows with the order.
            let most = if sh_order > 4 { [0.05, 0.9] } else { [0.01, 0.97] };
            of(&scene, &quality).refuses(&quality, most, &wrong);
        }
    }
}
