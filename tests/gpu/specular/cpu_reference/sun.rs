//! Direct Phong specular of suns, and the light of suns that bounces reflect.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::Sun;
use ridgelight_cpu::mirror_map::mirrored;
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::sun_specular::{self as specular_reference, WHOLE};
use ridgelight_cpu::tolerance::{EPSILON, device_sun_arriving, device_sun_specular, disc_rings};

use super::bounced::paired;
use super::slices::{eye_of, view_from};
use crate::cpu_reference::{Pair, Run, constant, pushed};
use crate::direct::cpu_reference::light::{Rgb, rgb};

impl Run<'_> {
    /// Light vectors of all texels, where a pass has them.
    pub(crate) fn vectors(&mut self, pass: &Pass) -> Option<Vec<Rgb>> {
        let texels = self.floats(pass, "light_vector")?;
        Some(texels.chunks_exact(4).map(rgb).collect())
    }
}

/// From the device's own sun, added to what is there.
pub(crate) fn sun_specular(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const COLOUR: usize = offset("SunSpecularPush", "colour");
    const EYE_M: usize = offset("SunSpecularPush", "eye_m");
    let number: usize =
        pass.part.strip_prefix("sun").and_then(|n| n.parse().ok()).expect("sun and its number");
    let sun = run.scene.lights.suns[number - 1];
    let sums = run.floats(pass, "sun_sum").expect("read");
    let got = run.floats(pass, "specular_sum").expect("written");
    let eye_m = eye_of(pass, EYE_M);
    let (heights, error) = (run.heights(), run.texel_error());
    let [cols, _] = run.size();
    if f32::from_bits(pushed(pass, COLOUR + 12)) > 0.0 {
        run.specular = vec![[0.0; 3]; sums.len()];
    }
    let towards = {
        let (sin, cos) = sun.azimuth_rad.sin_cos();
        let (up, along) = sun.elevation_rad.sin_cos();
        glam::DVec3::new(cos * along, sin * along, up)
    };
    let vectors = (constant(pass, "has_vector") == 1).then(|| run.vectors(pass).expect("read"));
    let mut pairs = sun_arriving(run, pass, &sun, towards);
    let mut skipped = 0;
    for (i, got) in got.chunks_exact(4).enumerate() {
        let normal = normal_of(field_slope(&heights, (i % cols) as i32, (i / cols) as i32));
        let phong = run.phong_specular(i);
        let view = view_from(&heights, eye_m, i);
        let vector = vectors.as_ref().map(|vectors| vectors[i]);
        let magnitude = vector.map_or(1.0, glam::DVec3::length);
        // Either branch.
        if (magnitude - WHOLE).abs() <= 8.0 * EPSILON {
            run.specular[i] = [0, 1, 2].map(|c| f64::from(got[c]));
            skipped += 1;
            continue;
        }
        let light =
            specular_reference::specular_on((normal, view), &sun, phong, (sums[i].into(), vector));
        let n = phong.exponent.into();
        let tolerance = match vector.filter(|_| magnitude < WHOLE) {
            // Centre and axes err by 16 ε, 64 ε of a radius where the centres nearly agree. Half axes reach 1.05 radii. The
            // rings' error grows with their eighth power at most: a factor of 1.5.
            Some(vector) => {
                let to_mirror = mirrored(normal, view).dot(vector.normalize_or_zero());
                magnitude
                    * (device_sun_specular(n, error.normal() + 80.0 * EPSILON, 1.0)
                        + 1.5 * disc_rings(n, &sun, to_mirror))
            }
            None => {
                let to_mirror = mirrored(normal, view).dot(towards);
                device_sun_specular(n, error.normal(), normal.dot(towards))
                    + disc_rings(n, &sun, to_mirror)
            }
        };
        for (c, (got, sum)) in got.iter().zip(&mut run.specular[i]).enumerate() {
            let colour = f64::from(sun.irradiance[c]);
            let want = *sum + colour * light;
            *sum = f64::from(*got);
            let tolerance = colour * tolerance + 2.0 * EPSILON * want;
            pairs.push(Pair { got: *sum, want, tolerance, at: [c, i / cols, i % cols] });
        }
    }
    assert!(skipped * 50 <= sums.len(), "{skipped} of {} are not compared", sums.len());
    pairs
}

/// The same pass's series of the light that arrives, where it is bounced.
fn sun_arriving(run: &mut Run, pass: &Pass, sun: &Sun, towards: Rgb) -> Vec<Pair> {
    let order = constant(pass, "order") as usize;
    if order == 0 {
        return Vec::new();
    }
    let sums = run.floats(pass, "sun_sum").expect("read");
    let got = run.all_series(pass, "arriving", order);
    if f32::from_bits(pushed(pass, const { offset("SunSpecularPush", "colour") } + 12)) > 0.0 {
        run.arriving = vec![vec![[0.0; 3]; order * order]; sums.len()];
    }
    let (heights, error) = (run.heights(), run.texel_error());
    let [cols, _] = run.size();
    let mut pairs = Vec::new();
    for (i, (got, before)) in got.iter().zip(&run.arriving).enumerate() {
        let normal = normal_of(field_slope(&heights, (i % cols) as i32, (i / cols) as i32));
        let more = specular_reference::arriving(normal, sun, order, sums[i].into());
        let want: Vec<_> = before
            .iter()
            .zip(&more)
            .map(|(b, y)| [0, 1, 2].map(|c| b[c] + f64::from(sun.irradiance[c]) * y))
            .collect();
        let largest = sun.irradiance.iter().fold(0.0, |m: f32, v| m.max(*v));
        let off = f64::from(largest) * device_sun_arriving(error.normal(), normal.dot(towards));
        let tolerance = |want: f64| off + 2.0 * EPSILON * want.abs();
        pairs.extend(paired((got, &want), tolerance, [i / cols, i % cols]));
    }
    run.arriving = got;
    pairs
}
