//! Phong specular of sphere lights, which `sphere_shade` adds.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::{SphereLight, normal};
use ridgelight_cpu::light::Receiver;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere_shade::{device_sphere_specular, sphere_with};
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry};

use super::slices::{VIEW_ERROR, eye_of, view_from};
use crate::cpu_reference::{Pair, Run, pushed};

/// Empties the sum where the first light begins it.
pub(crate) fn begin(run: &mut Run, pass: &Pass) {
    const SPECULAR_BEGINS: usize = offset("SphereShadePush", "specular_begins");
    if f32::from_bits(pushed(pass, SPECULAR_BEGINS)) > 0.0 {
        run.specular = vec![[0.0; 3]; run.scene.field.heights_m().len()];
    }
}

/// The device's own earlier sum, plus what all slices of a sphere light add to it; empty without specular.
pub(crate) fn specular(
    run: &mut Run,
    pass: &Pass,
    light: &SphereLight,
    counts: [u32; 2],
) -> Vec<Pair> {
    const EYE_M: usize = offset("SphereShadePush", "eye_m");
    let Some(got) = run.floats(pass, "specular_sum") else { return Vec::new() };
    let eye_m = eye_of(pass, EYE_M);
    let (field, border) = (&run.scene.field, run.border());
    let (oracle, heights) = (Oracle::new(field, border), run.heights());
    let off_rad = 2.0 * (run.normal_error() + VIEW_ERROR);
    let [cols, _] = run.size();
    let mut pairs = Vec::new();
    for (i, got) in got.chunks_exact(4).enumerate() {
        let place = [i / cols, i % cols];
        let phong = run.phong_specular(i);
        let n = f64::from(phong.exponent);
        let of = normal(field, border, place[0], place[1]);
        let receivers = [Receiver::specular(of, view_from(&heights, eye_m, i), n)];
        let one = sphere_with(&oracle, light, counts, place, &receivers)[0];
        let off = device_sphere_specular(&SphereGeometry::of(field, light, i), n, off_rad);
        let scale = f64::from(phong.scale);
        for (c, (got, sum)) in got.iter().zip(&mut run.specular[i]).enumerate() {
            let radiance = f64::from(light.radiance[c]);
            let want = *sum + radiance * scale * one;
            *sum = f64::from(*got);
            let tolerance = radiance * scale * off + 10.0 * EPSILON * want + 1e-30;
            pairs.push(Pair { got: *sum, want, tolerance, at: [c, place[0], place[1]] });
        }
    }
    pairs
}
