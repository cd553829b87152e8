//! Random texels for probes.

use std::ops::Range;

use ridgelight::basis::random::{STEP, mixed, unit};

/// `wanted` of the weights' indices, and 1 / (count · probability) of each. The first third, which [`even_picks`] returns
/// too, is uniform; the rest is by weight. Both are stratified into equal parts in reading order. All once where all
/// are wanted; all uniform where all weights are 0 or one is not finite.
///
/// The probability is that of both parts together (the balance heuristic, Veach & Guibas 1995), so a mean over all
/// picks, each times its factor, is unbiased. Its variance over all picks includes the difference between the means of
/// the parts: the bound is wider, not narrower.
pub(super) fn picks(weights: &[f64], wanted: usize, seed: u64) -> (Vec<usize>, Vec<f64>) {
    let count = weights.len();
    if wanted >= count {
        return ((0..count).collect(), vec![1.0; count]);
    }
    let Some(sum) = usable_sum(weights) else {
        return (parts(count, 0..wanted, seed, |_| 1.0), vec![1.0; wanted]);
    };
    // In units of the mean probability.
    let of = |i: usize| weights[i] / sum * count as f64;
    let mut all = even_picks(count, wanted, seed);
    let even = all.len();
    all.extend(parts(count, even..wanted, seed, of));
    let share = even as f64 / wanted as f64;
    let factors = all.iter().map(|i| 1.0 / (share + (1.0 - share) * of(*i))).collect();
    (all, factors)
}

/// The sum of weights by which [`picks`] can pick. None where all weights are 0 or one is not finite: two pictures with values
/// beyond f32 differ by infinity.
pub(super) fn usable_sum(weights: &[f64]) -> Option<f64> {
    let sum: f64 = weights.iter().sum();
    (sum > 0.0 && sum.is_finite()).then_some(sum)
}

/// The first picks of [`picks`] for any weights that are not all 0.
pub(super) fn even_picks(count: usize, wanted: usize, seed: u64) -> Vec<usize> {
    if wanted >= count {
        (0..count).collect()
    } else {
        parts(count, 0..wanted.div_ceil(3), seed, |_| 1.0)
    }
}

/// An index in each of equal parts of all probability, one for each of the random numbers. `of` is an index's
/// probability, in units of the mean.
fn parts(count: usize, numbers: Range<usize>, seed: u64, of: impl Fn(usize) -> f64) -> Vec<usize> {
    let random = |k: usize| unit(mixed(seed.wrapping_add((k as u64 + 1).wrapping_mul(STEP))));
    let equal = numbers.len() as f64;
    let (mut i, mut until) = (0, of(0));
    let picked = numbers.enumerate().map(|(part, number)| {
        let place = (part as f64 + random(number)) / equal * count as f64;
        while until < place && i + 1 < count {
            i += 1;
            until += of(i);
        }
        i
    });
    picked.collect()
}
