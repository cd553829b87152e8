//! Compares sphere lights by harmonics with the same series in f64, within f32 rounding. The error
//! of the series itself is reported, not bounded.

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{Levels, Lights, Method, Quality, Scene, SphereLight};
use ridgelight_cpu::light::normal;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::soft_sphere::{SphereShError, device_pyramid_within, device_surface_within};
use ridgelight_cpu::sphere_sh_shade::SphereSh;
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry, device_pyramid_slope, device_resolved};

use super::{GroundTruth, albedo_of, colours, judge, percent, rms};

/// A scene's sphere lights alone, at some of its texels.
pub(super) fn check(
    scene: &Scene,
    ground_truth: &GroundTruth,
    gpu: &mut Headless,
    quality: &Quality,
    limits: &Limits,
) -> Result<String> {
    let lights = Lights { sphere_lights: scene.lights.sphere_lights.clone(), ..Lights::default() };
    let scene = &Scene { lights, ..scene.clone() };
    // The plan bounds the light of culled sphere lights.
    let all = Quality { light_cutoff: 0.0, ..*quality };
    let plan = plan::picture(scene, &all, limits, Picture::default())?;
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let (picture, levels) = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        // A pyramid's levels are the device's own: only the light from them is compared.
        let names = ["height_stack", "height_levels"];
        let id = names.into_iter().find_map(|name| frame.plan().find(name));
        let words = id.map(|id| gpu.read(frame, id)).transpose()?.unwrap_or_default();
        let levels: Vec<f32> = words.into_iter().map(f32::from_bits).collect();
        Ok((gpu.pixels(frame, 0)?, levels))
    })?;
    let wanted = Wanted::of(scene, quality, &levels, &ground_truth.places);
    let (error, bound) = wanted.judge(&colours(&picture, &ground_truth.places), quality)?;
    let means = ground_truth.means(&picture);
    let sphere_lights = ground_truth.expected.iter().map(|[.., sphere_lights]| *sphere_lights);
    let missed = rms(means.iter().zip(sphere_lights.clone()).map(|(a, b)| a - b));
    let scale = rms(sphere_lights).max(f64::MIN_POSITIVE);
    Ok(format!(
        "sphere light harmonics {} against f64 (RMSE; bound {}), below 0 at {} of {} places; \
            including truncation at order {}, their light's error is {} against the oracle",
        percent(error),
        percent(bound),
        wanted.negative,
        ground_truth.places.len(),
        quality.sh_order,
        percent(missed / scale),
    ))
}

/// Sphere light at each place by the same series in f64, and the tolerance of a device.
struct Wanted {
    light: Vec<[[f64; 2]; 3]>,
    /// Places where a light's series rings below 0 and is clamped to 0.
    negative: usize,
}

impl Wanted {
    fn of(scene: &Scene, quality: &Quality, levels: &[f32], places: &[usize]) -> Self {
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
        let (errors, mut negative) = (SphereShError::new(quality), 0);
        let largest = field.heights_m().iter().fold(0.0, |m, h| f64::from(h.abs()).max(m));
        let mut at = |place: &usize| {
            let (row, col) = (place / field.cols(), place % field.cols());
            let normal = normal(field, border, row, col);
            let albedo = albedo_of(scene, *place);
            let mut all = [[0.0; 2]; 3];
            let mut rings = false;
            for sphere_light in &scene.lights.sphere_lights {
                let soft = reference.at(sphere_light, row, col);
                rings |= soft.light < 0.0;
                let geometry = SphereGeometry::of(field, sphere_light, *place);
                let off = errors.tolerance(
                    &geometry,
                    slope_error(&geometry, quality, largest),
                    normal,
                    &soft.visibility,
                );
                let light = soft.light.max(0.0);
                for (c, [want, bound]) in all.iter_mut().enumerate() {
                    let radiance = f64::from(sphere_light.radiance[c]) * albedo[c];
                    *want += radiance * light;
                    *bound += radiance * (off + 4.0 * EPSILON * light);
                }
            }
            negative += usize::from(rings);
            let sphere_lights = scene.lights.sphere_lights.len();
            all.map(|[want, bound]| [want, bound + device_resolved(want, sphere_lights)])
        };
        let light = places.iter().map(&mut at).collect();
        Self { light, negative }
    }

    fn judge(&self, found: &[DVec3], quality: &Quality) -> Result<(f64, f64)> {
        let what = format!("sphere light of order {} at one place", quality.sh_order);
        let found = found.iter().flat_map(|v| v.to_array());
        judge(&what, found, self.light.as_flattened(), quality)
    }
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

/// A scene without its sphere lights; none without other lights.
pub(super) fn without(scene: &Scene) -> Option<Scene> {
    let lights = Lights { sphere_lights: Vec::<SphereLight>::new(), ..scene.lights.clone() };
    let Lights { sky, environment, suns, keys, .. } = &lights;
    let shines = sky.is_some() || environment.is_some() || !suns.is_empty() || !keys.is_empty();
    shines.then(|| Scene { lights, ..scene.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::fractal;
    use ridgelight::scene::{LightBasis, Receiver, Surface, Wedges};

    /// Wrong light is refused for every order and form: slightly too dark, of a light moved aside,
    /// of another order, of the exact form, of a neighbour, of swapped colours, and NaN.
    #[test]
    fn wrong_sphere_light_harmonics_are_refused() {
        let field = fractal(32, 1).unwrap();
        let up = field.base_m() + 9.0;
        let sphere_light =
            SphereLight { position_m: [13.0, 17.0, up], radius_m: 2.0, radiance: [3.0, 1.0, 0.5] };
        let lights = Lights { sphere_lights: vec![sphere_light], ..Lights::default() };
        let scene = Scene { field, surface: Surface::default(), lights };
        let places: Vec<usize> = (5..32 * 32).step_by(97).collect();
        let base = Quality { light_basis: LightBasis::Sh, sun_azimuths: 8, ..Quality::default() };
        for (sh_order, wedges, receiver) in [
            (2, Wedges::Slices, Receiver::Plane),
            (4, Wedges::Nlp, Receiver::Plane),
            (4, Wedges::Table, Receiver::Cosine),
            (6, Wedges::Slices, Receiver::Plane),
        ] {
            let quality = Quality { sh_order, wedges, receiver, ..base };
            let light = |scene: &Scene, quality: &Quality| -> Vec<DVec3> {
                let wanted = Wanted::of(scene, quality, &[], &places);
                let value = |all: &[[f64; 2]; 3]| DVec3::from_array(all.map(|[want, _]| want));
                wanted.light.iter().map(value).collect()
            };
            let wanted = Wanted::of(&scene, &quality, &[], &places);
            let right = light(&scene, &quality);
            let (error, bound) = wanted.judge(&right, &quality).unwrap();
            println!("order {sh_order} {wedges:?} {receiver:?}: bound {bound:e}");
            // f32 cancellation of the fits' weights grows with the order.
            let [most, dim] = if sh_order > 4 { [0.05, 0.9] } else { [0.01, 0.97] };
            assert!(error == 0.0 && bound < most, "{error} {bound}");
            let mut moved = scene.clone();
            moved.lights.sphere_lights[0].position_m[0] += 0.5;
            let oracle = Oracle::new(&scene.field, scene.surface.border);
            let exact = |p: &usize| {
                let share =
                    ridgelight_cpu::sphere::sphere_of(&oracle, p / 32, p % 32, &sphere_light, 32);
                DVec3::from_array(sphere_light.radiance.map(|r| f64::from(r) * share))
            };
            let mut turned = right.clone();
            turned.rotate_left(1);
            let mut holed = right.clone();
            holed[3][1] = f64::NAN;
            let other =
                Quality { sh_order: if sh_order == 6 { 5 } else { sh_order + 1 }, ..quality };
            let wrong = [
                ("dim", right.iter().map(|v| dim * *v).collect()),
                ("black", vec![DVec3::ZERO; right.len()]),
                ("of another order", light(&scene, &other)),
                ("of a light moved aside", light(&moved, &quality)),
                ("of the exact form", places.iter().map(exact).collect()),
                ("of a neighbour", turned),
                ("of other colours", right.iter().map(|v| DVec3::new(v.z, v.y, v.x)).collect()),
                ("NaN", holed),
            ];
            for (name, light) in wrong {
                let refused = wanted.judge(&light, &quality);
                assert!(refused.is_err(), "{name} passes: {quality:?}");
            }
        }
    }
}
