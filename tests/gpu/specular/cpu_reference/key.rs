//! Phong specular of key lights, which `sun_shade` adds, and their light that bounces reflect.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::PhongSpecular;
use ridgelight_cpu::key_arriving as arriving_reference;
use ridgelight_cpu::key_specular as key_reference;
use ridgelight_cpu::mirror_map::mirrored;
use ridgelight_cpu::tolerance::{EPSILON, ShadeError};

use super::bounced::paired;
use super::slices::{VIEW_ERROR, eye_of, view_from};
use crate::cpu_reference::{Pair, Run, constant, fuse_of, pushed};

fn radiance_of(run: &Run, pass: &Pass) -> [f64; 3] {
    let number = pass.part.split(' ').next().and_then(|part| part.strip_prefix("key"));
    let number: usize = number.and_then(|n| n.parse().ok()).expect("key and its number");
    run.scene.lights.keys[number - 1].radiance.map(f64::from)
}

/// The device's own earlier sum, plus what a batch of a key light's azimuths adds to it; empty without specular.
pub(crate) fn key_specular(run: &mut Run, pass: &Pass, error: &ShadeError) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("ShadePush", "azimuth_count");
    const COLOUR: usize = offset("ShadePush", "colour");
    const EYE_M: usize = offset("ShadePush", "eye_m");
    const FIRST_AZIMUTH: usize = offset("ShadePush", "first_azimuth");
    let Some(got) = run.floats(pass, "specular_sum") else { return Vec::new() };
    let radiance = radiance_of(run, pass);
    let eye_m = eye_of(pass, EYE_M);
    let texels = got.len() / 4;
    if f32::from_bits(pushed(pass, COLOUR + 12)) > 0.0 {
        run.specular = vec![[0.0; 3]; texels];
    }
    let phongs: Vec<PhongSpecular> = (0..texels).map(|i| run.phong_specular(i)).collect();
    let [cols, _] = run.size();
    let off = [2.0 * (error.normal() + VIEW_ERROR), error.lowest_slope()];
    let [first, count] = [FIRST_AZIMUTH, AZIMUTH_COUNT].map(|o| pushed(pass, o) as usize);
    let added = run.swept(first..first + count, fuse_of(pass), |swept| {
        let at = |i: usize| {
            let view = view_from(&swept.heights, eye_m, i);
            let n = f64::from(phongs[i].exponent);
            let mut sum = [0.0; 2];
            let place = [(i % cols) as i32, (i / cols) as i32];
            swept.add_all(place, true, |_, azimuth, lowest, normal| {
                let of = (mirrored(normal, view), lowest);
                let one = key_reference::key_specular(n, azimuth, of, off);
                sum = [sum[0] + one[0], sum[1] + one[1]];
            });
            [sum[0], sum[1] + count as f64 * EPSILON * sum[0]]
        };
        (0..texels).map(at).collect::<Vec<[f64; 2]>>()
    });
    let mut pairs = Vec::new();
    for (i, (got, [light, tolerance])) in got.chunks_exact(4).zip(added).enumerate() {
        let scale = f64::from(phongs[i].scale);
        for (c, (got, sum)) in got.iter().zip(&mut run.specular[i]).enumerate() {
            let want = *sum + radiance[c] * scale * light;
            *sum = f64::from(*got);
            // Products with radiance and scale, and a sum.
            let tolerance = radiance[c] * scale * tolerance + 4.0 * EPSILON * want + 1e-30;
            pairs.push(Pair { got: *sum, want, tolerance, at: [c, i / cols, i % cols] });
        }
    }
    pairs
}

/// The device's own earlier series, plus what a batch of a key light's azimuths adds to it.
pub(crate) fn key_arriving(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("ShadePush", "azimuth_count");
    const COLOUR: usize = offset("ShadePush", "colour");
    const FIRST_AZIMUTH: usize = offset("ShadePush", "first_azimuth");
    let order = constant(pass, "order") as usize;
    let got = run.all_series(pass, "arriving", order);
    let radiance = radiance_of(run, pass);
    if f32::from_bits(pushed(pass, COLOUR + 12)) > 0.0 {
        run.arriving = vec![vec![[0.0; 3]; order * order]; got.len()];
    }
    let (error, [cols, _]) = (run.texel_error(), run.size());
    let [first, count] = [FIRST_AZIMUTH, AZIMUTH_COUNT].map(|o| pushed(pass, o) as usize);
    let texels = got.len();
    let added = run.swept(first..first + count, fuse_of(pass), |swept| {
        let at = |i: usize| {
            let mut sum = (vec![0.0; order * order], 0.0);
            let place = [(i % cols) as i32, (i / cols) as i32];
            swept.add_all(place, true, |_, azimuth, lowest, _| {
                let slope = error.lowest_slope();
                let (one, off) = arriving_reference::key_arriving(order, azimuth, lowest, slope);
                sum.0.iter_mut().zip(one).for_each(|(sum, y)| *sum += y);
                sum.1 += off;
            });
            sum
        };
        (0..texels).map(at).collect::<Vec<_>>()
    });
    let largest = radiance.iter().fold(0.0, |m: f64, v| m.max(*v));
    let mut pairs = Vec::new();
    for (i, ((got, before), (more, off))) in got.iter().zip(&run.arriving).zip(added).enumerate() {
        let sum = |(before, y): (&[f64; 3], &f64)| [0, 1, 2].map(|c| before[c] + radiance[c] * y);
        let want: Vec<_> = before.iter().zip(&more).map(sum).collect();
        let tolerance = |want: f64| {
            largest * (off + count as f64 * EPSILON) + (2.0 + count as f64) * EPSILON * want.abs()
        };
        pairs.extend(paired((got, &want), tolerance, [i / cols, i % cols]));
    }
    run.arriving = got;
    pairs
}
