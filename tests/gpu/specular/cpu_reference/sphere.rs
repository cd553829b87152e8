//! Phong specular of sphere lights, and their light that bounces reflect, which `sphere_shade` adds.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::{SphereLight, normal};
use ridgelight_cpu::light::Receiver;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere_shade::{
    arriving, device_sphere_arriving, device_sphere_specular, sphere_with,
};
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry};

use super::bounced::paired;
use super::slices::{VIEW_ERROR, eye_of, view_from};
use crate::cpu_reference::{Pair, Run, constant, pushed};

/// Empties the sums where the first light begins them.
pub(crate) fn begin(run: &mut Run, pass: &Pass) {
    const SPECULAR_BEGINS: usize = offset("SphereShadePush", "specular_begins");
    if f32::from_bits(pushed(pass, SPECULAR_BEGINS)) > 0.0 {
        let (order, texels) = (constant(pass, "order") as usize, run.scene.field.heights_m().len());
        run.specular = vec![[0.0; 3]; texels];
        run.arriving = vec![vec![[0.0; 3]; order * order]; texels];
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

/// The device's own earlier series, plus what all slices of a sphere light add to it; empty where none are kept.
pub(crate) fn series(
    run: &mut Run,
    pass: &Pass,
    light: &SphereLight,
    (counts, reach_m): ([u32; 2], f64),
) -> Vec<Pair> {
    let order = constant(pass, "order") as usize;
    if order == 0 {
        return Vec::new();
    }
    let got = run.all_series(pass, "arriving", order);
    let field = &run.scene.field;
    let oracle = Oracle::new(field, run.border());
    let [cols, _] = run.size();
    let brightest = light.radiance.iter().fold(0.0, |m: f32, v| m.max(*v));
    let mut pairs = Vec::new();
    for (i, (got, before)) in got.iter().zip(&run.arriving).enumerate() {
        let place = [i / cols, i % cols];
        let geometry = SphereGeometry::of(field, light, i);
        let mut want = before.clone();
        if geometry.distance_m <= reach_m {
            let more = arriving(&oracle, light, counts, place, order);
            for (sum, y) in want.iter_mut().zip(more) {
                for (sum, radiance) in sum.iter_mut().zip(light.radiance) {
                    *sum += f64::from(radiance) * y;
                }
            }
        }
        let off = f64::from(brightest) * device_sphere_arriving(&geometry);
        let tolerance = |want: f64| off + 4.0 * EPSILON * want.abs();
        pairs.extend(paired((got, &want), tolerance, place));
    }
    run.arriving = got;
    pairs
}
