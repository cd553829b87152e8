//! From slices along azimuths to spherical harmonics: blending, rotation and summation in one step (NS09 §6, appendix).
//!
//! A wedge lies between two azimuths Δφ apart; across it the slices are blended with weights β_i(φ/Δφ),
//! and the result is projected. Every Y_lm is a product, so the projection of the sum over all wedges is
//! Σ_k slice_k(l, |m|) w_k(m), w_k(m) = ∫ Φ_m times the bump that belongs to azimuth k. The 2n - 1
//! weights of an azimuth take the place of NS09's blend matrix, a rotation about z and a sum.

use super::from_nlp;
use ridgelight::basis::azimuth::around;
use ridgelight::basis::bands;
use ridgelight::basis::quadrature::points;
use ridgelight::basis::slice::slice_index;
use std::f64::consts::TAU;

/// How slices are blended from one azimuth to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// Between two azimuths, (1 - t, t).
    Linear,
    /// Cubic B-spline over four: smoother, with a blur of more than a wedge.
    BSpline,
}

impl Blend {
    /// Weights at t in [0..1] between azimuths j and j + 1, of j - 1, j, j + 1 and j + 2.
    pub fn weights(self, t: f64) -> [f64; 4] {
        let u = 1.0 - t;
        match self {
            Blend::Linear => [0.0, u, t, 0.0],
            Blend::BSpline => {
                let middle = |v: f64| (4.0 + v * v * (3.0 * v - 6.0)) / 6.0;
                [u * u * u / 6.0, middle(t), middle(u), t * t * t / 6.0]
            }
        }
    }

    /// The contributing ones of the four.
    fn taking_part(self) -> std::ops::Range<usize> {
        match self {
            Blend::Linear => 1..3,
            Blend::BSpline => 0..4,
        }
    }
}

/// ∫ β_i Φ_m over the wedge from `start_rad` on, `width_rad` wide: `[i][m + n - 1]`, i = 0..4.
fn wedge(order: usize, blend: Blend, start_rad: f64, width_rad: f64) -> [Vec<f64>; 4] {
    let mut moments = std::array::from_fn(|_| vec![0.0; 2 * order - 1]);
    for (t, weight) in points(0.0, 1.0) {
        let turns = around(order, start_rad + t * width_rad);
        for (moment, share) in moments.iter_mut().zip(blend.weights(t)) {
            moment.iter_mut().zip(&turns).for_each(|(sum, turn)| *sum += weight * (share * turn));
        }
    }
    moments.map(|moment| moment.into_iter().map(|sum| width_rad * sum).collect())
}

fn place(order: usize, m: isize) -> usize {
    (order - 1).wrapping_add_signed(m)
}

/// Weights `[k][m + n - 1]` of azimuths φ_k = 2πk/count, all around, without a blend: exact for slices with frequencies below
/// count - |m|, and with a smaller error than a blend wherever horizons are smooth.
pub fn circle(order: usize, count: usize) -> Vec<Vec<f64>> {
    let width = TAU / count as f64;
    let weights = |k: usize| around(order, width * k as f64).into_iter().map(move |w| w * width);
    (0..count).map(|k| weights(k).collect()).collect()
}

/// Weights `[k][m + n - 1]` of azimuths φ_k = start + k · width/(count - 1): count - 1 wedges, nothing beyond the two ends
/// (NS09 §6, partial swaths). Where a B-spline would reach beyond, it repeats the slice of the end.
///
/// # Panics
/// When `count` is below 2.
pub fn swath(
    order: usize,
    blend: Blend,
    start_rad: f64,
    width_rad: f64,
    count: usize,
) -> Vec<Vec<f64>> {
    assert!(count >= 2, "{count} azimuths across a swath");
    let step = width_rad / (count - 1) as f64;
    let mut weights = vec![vec![0.0; 2 * order - 1]; count];
    for j in 0..count - 1 {
        let moments = wedge(order, blend, start_rad + j as f64 * step, step);
        for i in blend.taking_part() {
            let k = (j + i).saturating_sub(1).min(count - 1);
            for (sum, moment) in weights[k].iter_mut().zip(&moments[i]) {
                *sum += moment;
            }
        }
    }
    weights
}

/// Spherical harmonics of slices along azimuths, each with its weights: n² coefficients.
pub fn assemble(order: usize, weights: &[Vec<f64>], slices: &[Vec<f64>]) -> Vec<f64> {
    assert_eq!(weights.len(), slices.len(), "weights and slices");
    bands(order)
        .map(|(l, m)| {
            let (part, turn) = (slice_index(l, m.unsigned_abs()), place(order, m));
            weights.iter().zip(slices).map(|(w, slice)| w[turn] * slice[part]).sum()
        })
        .collect()
}

/// [`assemble`] from NLP coefficients: weighted and summed first, n (2n-1) products per azimuth, and converted to slices
/// once.
pub fn assemble_nlp(order: usize, weights: &[Vec<f64>], nlps: &[Vec<f64>]) -> Vec<f64> {
    assert_eq!(weights.len(), nlps.len(), "weights and NLP vectors");
    let elevations = from_nlp(order);
    let sums: Vec<Vec<f64>> = (0..2 * order - 1)
        .map(|turn| {
            let sum = |c: usize| weights.iter().zip(nlps).map(|(w, v)| w[turn] * v[c]).sum();
            (0..order).map(sum).collect()
        })
        .collect();
    bands(order)
        .map(|(l, m)| {
            let row = &elevations[slice_index(l, m.unsigned_abs())];
            row.iter().zip(&sums[place(order, m)]).map(|(e, s)| e * s).sum()
        })
        .collect()
}
