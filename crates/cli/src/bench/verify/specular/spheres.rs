//! Compares specular of sphere lights with the plan's slices in f64, within f32 rounding. Specular raises the number of slices
//! around a texel, so the diffuse light of the same frame is compared, too.

use glam::DVec3;
use ridgelight::gpu::shaders::offset;
use ridgelight::plan::{Pass, Plan};
use ridgelight::scene::Scene;
use ridgelight::{Error, Result};
use ridgelight_cpu::light::{Receiver, normal};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere_shade::{device_sphere_specular, sphere_with};
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry, device_resolved};

use super::super::{Device, Wanted, colours, sentence};
use super::{GREY, VIEW_ERROR, normal_error};

/// Specular and diffuse light of a [`half`](super::half) scene's sphere lights, which are its only lights.
pub(super) fn check(scene: &Scene, places: &[usize], device: &mut Device) -> Result<String> {
    let quality = device.quality;
    let (plan, layers) = device.layers(scene, true)?;
    let drawn = |name: &str| {
        let layer = layers.iter().find(|layer| layer.name == name);
        let missing = || Error::Device {
            doing: "verifying before timing".into(),
            reason: format!("no layer {name}, expected that of a sphere light"),
        };
        layer.map(|layer| colours(layer, places)).ok_or_else(missing)
    };
    let light = wanted(scene, &counts_of(scene, &plan), places);
    let what = "specular of sphere lights at one place";
    let errors = light.specular.judge(what, &drawn("direct.specular")?, quality)?;
    let mut texts = vec![sentence("sphere light specular", "f64 slices", errors)];
    for (i, diffuse) in light.diffuse.iter().enumerate() {
        let number = i + 1;
        let found = drawn(&format!("direct.sphere_light{number}"))?;
        let what = format!("beside specular, sphere light {number} at one place");
        let errors = diffuse.judge(&what, &found, quality)?;
        let what = format!("beside specular, sphere light {number}");
        texts.push(sentence(&what, "f64 slices", errors));
    }
    Ok(texts.join("; "))
}

/// How the plan shades a sphere light.
#[derive(Clone, Copy)]
struct Slices {
    /// Where the sphere is narrow from a texel, and where it surrounds the texel.
    counts: [u32; 2],
    passes: usize,
}

fn counts_of(scene: &Scene, plan: &Plan) -> Vec<Slices> {
    const COUNTS: [usize; 2] =
        [offset("SphereShadePush", "slices"), offset("SphereShadePush", "slices_around")];
    let of = |i: usize| {
        let name = format!("sphere_light{}", i + 1);
        let is_own = |pass: &&Pass| {
            pass.name() == "sphere_shade" && pass.part.split(' ').next() == Some(name.as_str())
        };
        let passes: Vec<&Pass> = plan.passes.iter().filter(is_own).collect();
        let counts = passes.first().map_or([0; 2], |pass| {
            COUNTS
                .map(|at| u32::from_ne_bytes(pass.push[at..at + 4].try_into().expect("four bytes")))
        });
        Slices { counts, passes: passes.len() }
    };
    (0..scene.lights.sphere_lights.len()).map(of).collect()
}

/// Light in f64, and the tolerance of a device.
struct Light {
    /// Of all sphere lights.
    specular: Wanted,
    /// Of each.
    diffuse: Vec<Wanted>,
}

fn wanted(scene: &Scene, slices: &[Slices], places: &[usize]) -> Light {
    let (field, border) = (&scene.field, scene.surface.border);
    let oracle = Oracle::new(field, border);
    let cols = field.cols();
    let specular = scene.surface.specular.as_ref().expect("Phong specular");
    let off_rad = 2.0 * (normal_error(field) + VIEW_ERROR);
    let lights = &scene.lights.sphere_lights;
    let mut sums = vec![[DVec3::ZERO; 2]; places.len()];
    let mut diffuse = Vec::new();
    for (light, Slices { counts, passes }) in lights.iter().zip(slices) {
        let radiance = DVec3::from_array(light.radiance.map(f64::from));
        let mut own = Vec::new();
        for (sum, place) in sums.iter_mut().zip(places) {
            let at = [place / cols, place % cols];
            let normal = normal(field, border, at[0], at[1]);
            let phong = specular.at(*place);
            let n = f64::from(phong.exponent);
            let receivers = [Receiver::diffuse(normal), Receiver::specular_from_above(normal, n)];
            let shares = sphere_with(&oracle, light, *counts, at, &receivers);
            let geometry = SphereGeometry::of(field, light, *place);
            let share = f64::from(GREY) * radiance * shares[0];
            let off = f64::from(GREY) * radiance * geometry.tolerance();
            // A sum of each pass besides.
            let sum_error = (4.0 + *passes as f64) * EPSILON;
            own.push([share, off + share.map(|v| sum_error * v + device_resolved(v, 1))]);
            let scale = f64::from(phong.scale);
            sum[0] += scale * radiance * shares[1];
            // Products with radiance and scale, and sums of each pass.
            let rounded = (10.0 + *passes as f64) * EPSILON * sum[0];
            sum[1] += scale * radiance * device_sphere_specular(&geometry, n, off_rad) + rounded;
        }
        diffuse.push(Wanted(own));
    }
    for [light, off] in &mut sums {
        *off += light.map(|v| device_resolved(v, lights.len()));
    }
    Light { specular: Wanted(sums), diffuse }
}

#[cfg(test)]
mod tests {
    use super::super::half;
    use super::*;
    use crate::bench::verify::tests::{layered, places, scene as fractal};
    use ridgelight::scene::{Lights, PhongSpecular, Quality, Specular, SphereLight, Surface};
    use std::f64::consts::TAU;

    /// Around a texel, slices are at most half a standard deviation of the lobe wide. Wrong light is refused: sharper, duller, of a light moved
    /// by a fifth of a cell or a tenth wider. Sharper specular than that of exponent 20 reaches too few of these places.
    #[test]
    fn wrong_specular_of_sphere_lights_is_refused() {
        let quality = Quality { sun_azimuths: 8, ..Quality::default() };
        let field = fractal(48, Lights::default()).field;
        let cell = field.cell_m()[0];
        let highest = f64::from(field.heights_m().iter().fold(0.0_f32, |m, h| m.max(*h)));
        let of = |aside: f64, wider: f64, exponent: f32| {
            let z = field.base_m() + highest + 6.0 * cell;
            let position_m = [(20.0 + aside) * cell, 30.0 * cell, z];
            let radiance = [4.0, 2.0, 1.0];
            let light = SphereLight { position_m, radius_m: 4.0 * wider * cell, radiance };
            let scene = fractal(48, Lights { sphere_lights: vec![light], ..Lights::default() });
            let phong = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.5 }));
            let surface = Surface { specular: phong, ..scene.surface };
            let scene = half(&Scene { surface, ..scene });
            let slices = counts_of(&scene, &layered(&scene, &quality));
            let [_, around] = slices[0].counts;
            let half_deviations = 2.0 * TAU * (f64::from(exponent) + 1.0).sqrt();
            assert!(f64::from(around) >= half_deviations, "{around} of {half_deviations}");
            wanted(&scene, &slices, &places())
        };
        for exponent in [1.0, 5.0, 20.0] {
            let right = of(0.0, 1.0, exponent);
            let wrong = [
                ("sharper", of(0.0, 1.0, 1.5 * exponent).specular.light()),
                ("duller", of(0.0, 1.0, 0.7 * exponent).specular.light()),
                ("from beside", of(0.2, 1.0, exponent).specular.light()),
                ("wider", of(0.0, 1.1, exponent).specular.light()),
                ("diffuse", right.diffuse[0].light()),
            ];
            right.specular.refuses(&quality, [0.05, 0.9], &wrong);
            let wrong = [
                ("from beside", of(0.2, 1.0, exponent).diffuse[0].light()),
                ("wider", of(0.0, 1.1, exponent).diffuse[0].light()),
                ("specular", right.specular.light()),
            ];
            right.diffuse[0].refuses(&quality, [0.005, 0.99], &wrong);
        }
    }
}
