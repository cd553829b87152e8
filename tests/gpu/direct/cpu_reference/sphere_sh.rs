//! Sphere lights by spherical harmonics.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::scene::Quality;
use ridgelight_cpu::light::normal;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::soft_sphere::{SphereShError, device_pyramid_within, device_surface_within};
use ridgelight_cpu::sphere_sh_shade::SphereSh;
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry, device_pyramid_slope};

use crate::cpu_reference::{Pair, Run, pushed};

/// The error of slopes, at most the steepest of a pyramid.
pub(crate) fn slope_error(visible: &SphereGeometry, quality: &Quality, is_pyramid: bool) -> f64 {
    if !is_pyramid {
        return device_surface_within(visible);
    }
    let (largest, relief, step) = (visible.largest_m, visible.relief_m, visible.cell_m);
    let steepest = relief / step;
    let march = device_pyramid_slope(steepest, largest, relief, step);
    device_pyramid_within(visible, march, steepest, quality.level_step)
}

/// All azimuths of one sphere light, after the last batch: the sum of the sphere lights so far, and this one's light
/// before it is clamped at 0.
pub(crate) fn sphere_sh_shade(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTHS: usize = offset("SphereShShadePush", "azimuths");
    const LAST_AZIMUTH: usize = offset("SphereShShadePush", "last_azimuth");
    const RADIANCE: usize = offset("SphereShShadePush", "radiance");
    const REACH_M: usize = offset("SphereShShadePush", "reach_m");
    if f32::from_bits(pushed(pass, RADIANCE + 12)) > 0.0 {
        run.sphere_lights = vec![([0.0; 3], 0.0); run.scene.field.heights_m().len()];
    }
    if pushed(pass, LAST_AZIMUTH) < pushed(pass, AZIMUTHS) {
        return Vec::new();
    }
    let sphere_light = super::light::sphere_light_of(run, pass);
    let reach = f64::from(f32::from_bits(pushed(pass, REACH_M)));
    let (quality, border) = (run.quality, run.border());
    let [stack, levels] = ["height_stack", "height_levels"].map(|name| run.floats(pass, name));
    let is_pyramid = Run::bound(pass, "heights").is_some();
    let stored = match (&stack, &levels) {
        (Some(stack), _) => Stored::Stack(stack),
        (None, levels) => Stored::Levels(levels.as_deref().unwrap_or_default()),
    };
    let pyramid = is_pyramid.then(|| (Pyramid::new(&quality, run.plan.size, border), stored));
    let oracle = Oracle::new(&run.scene.field, border);
    let (reference, errors) =
        (SphereSh::new(oracle, pyramid, quality), SphereShError::new(&quality));
    let got = run.floats(pass, "sphere_sum").expect("written");
    let [cols, _] = run.size();
    let mut sphere_lights = std::mem::take(&mut run.sphere_lights);
    let mut pairs = Vec::new();
    for (i, ((sum, tolerance), got)) in
        sphere_lights.iter_mut().zip(got.chunks_exact(4)).enumerate()
    {
        let (visible, row, col) =
            (SphereGeometry::of(&run.scene.field, &sphere_light, i), i / cols, i % cols);
        if visible.distance_m <= reach {
            let by_sh = reference.at(&sphere_light, row, col);
            let n = normal(&run.scene.field, border, row, col);
            let slope = slope_error(&visible, &quality, is_pyramid);
            let off = errors.tolerance(&visible, slope, n, &by_sh.visibility);
            let brightest = sphere_light.radiance.iter().fold(0.0, |m: f32, v| m.max(*v));
            let light = by_sh.light.max(0.0);
            sum.iter_mut().zip(sphere_light.radiance).for_each(|(s, r)| *s += light * f64::from(r));
            *tolerance += f64::from(brightest) * (off + 4.0 * EPSILON * light);
            let at = [1, row, col];
            pairs.push(Pair { got: got[3].into(), want: by_sh.light, tolerance: off, at });
        }
        pairs.extend((0..3).map(|c| {
            let (got, want) = (got[c].into(), sum[c]);
            Pair { got, want, tolerance: *tolerance, at: [0, row, col] }
        }));
    }
    run.sphere_lights = sphere_lights;
    pairs
}
