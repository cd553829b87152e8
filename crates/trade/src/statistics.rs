//! Order statistics.

/// Five quantiles of a set of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Smallest.
    pub min: f64,
    /// A tenth of the values is at most this.
    pub p10: f64,
    /// Half of the values is at most this.
    pub median: f64,
    /// Nine tenths of the values are at most this.
    pub p90: f64,
    /// Largest.
    pub max: f64,
}

impl Summary {
    /// Quantiles by linear interpolation; `None` for no values or a NaN.
    pub fn of(samples: &[f64]) -> Option<Self> {
        if samples.is_empty() || samples.iter().any(|s| s.is_nan()) {
            return None;
        }
        let mut sorted = samples.to_vec();
        let [min, p10, median, p90, max] = quantiles(&mut sorted, [0.0, 0.1, 0.5, 0.9, 1.0])?;
        Some(Self { min, p10, median, p90, max })
    }
}

/// The median; `None` for no values or a NaN.
pub fn median(samples: &[f64]) -> Option<f64> {
    Some(Summary::of(samples)?.median)
}

/// Quantiles `shares`, each in [0..1]; sorts the values. `None` for no values.
///
/// Quantile q of n values is at rank q·(n - 1) counted from 0, linear between neighbours (type 7 of
/// Hyndman & Fan 1996). NaN sorts above everything.
pub fn quantiles<const N: usize>(samples: &mut [f64], shares: [f64; N]) -> Option<[f64; N]> {
    samples.sort_unstable_by(f64::total_cmp);
    let last = samples.len().checked_sub(1)?;
    Some(shares.map(|share| {
        let rank = share.clamp(0.0, 1.0) * last as f64;
        let below = rank.floor() as usize;
        let (low, high) = (samples[below], samples[(below + 1).min(last)]);
        // Equal neighbours need no interpolation: an infinity minus itself is NaN.
        if low == high { low } else { low + (rank - below as f64) * (high - low) }
    }))
}

/// The shortest symmetric interval of values that holds the median of their distribution with a probability of at
/// least 95 %, whatever the distribution; `None` for fewer than 6 values, which have none, or a NaN.
///
/// From the k-th smallest to the k-th largest value: independent values miss the median as often as n tosses of a coin
/// show fewer than k heads, on either side (David & Nagaraja, Order Statistics, 2003, section 7.1). Above 1,000 values
/// the binomial distribution is replaced by the normal one, rounded outwards.
pub fn median_interval(samples: &[f64]) -> Option<[f64; 2]> {
    if samples.iter().any(|s| s.is_nan()) {
        return None;
    }
    let n = samples.len();
    let rank = if n > 1000 {
        (n as f64 / 2.0 - 1.96 * (n as f64).sqrt() / 2.0).floor() as usize - 1
    } else {
        let (mut heads, mut below, mut rank) = (0.5_f64.powi(n as i32), 0.0, 0);
        while below + heads <= 0.025 {
            below += heads;
            heads *= (n - rank) as f64 / (rank + 1) as f64;
            rank += 1;
        }
        rank
    };
    let mut sorted = samples.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let low = rank.checked_sub(1)?;
    Some([sorted[low], sorted[n - 1 - low]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::basis::random::{STEP, mixed, unit};

    /// Ranks of published tables for 95 %: n and k (Conover, Practical Nonparametric Statistics, table A3: 6 and 1, 10
    /// and 2, 20 and 6, 30 and 10). Beside 1,000 values both rules agree.
    #[test]
    fn intervals_of_the_median_end_at_the_ranks_of_the_binomial_distribution() {
        let ranks = |n: usize| {
            let values: Vec<f64> = (1..=n).rev().map(|i| i as f64).collect();
            median_interval(&values)
        };
        assert_eq!(ranks(0), None);
        assert_eq!(ranks(5), None);
        for (n, k) in [(6, 1.0), (10, 2.0), (20, 6.0), (30, 10.0)] {
            assert_eq!(ranks(n), Some([k, n as f64 + 1.0 - k]), "{n} values");
        }
        let [below, above] = [1000, 1002].map(|n| ranks(n).unwrap()[0]);
        assert!((below - 1.0..=below + 2.0).contains(&above), "{below} of 1000, {above} of 1002");
        assert_eq!(median_interval(&[f64::NAN; 9]), None);
    }

    /// Of 2,000 sets of 15 draws from a skewed distribution (exponential, median ln 2), at least 95 % less three standard
    /// deviations of that count hold its median, and not all do.
    #[test]
    fn confidence_intervals_cover_the_median() {
        let mut state = 1_u64;
        let mut draw = || {
            state = state.wrapping_add(STEP);
            -(1.0 - unit(mixed(state))).ln()
        };
        let sets = 2000;
        let held = (0..sets)
            .filter(|_| {
                let set: Vec<f64> = (0..15).map(|_| draw()).collect();
                let [low, high] = median_interval(&set).unwrap();
                (low..=high).contains(&std::f64::consts::LN_2)
            })
            .count();
        let least = f64::from(sets) * 0.95 - 3.0 * (f64::from(sets) * 0.95 * 0.05).sqrt();
        assert!(held as f64 >= least && held < sets as usize, "{held} of {sets}");
    }

    /// 0..=10 in any order: rank q·10 is its own value. Two samples: linear between them.
    #[test]
    fn quantiles_stand_at_their_rank() {
        let shuffled = [7.0, 3.0, 10.0, 0.0, 5.0, 1.0, 9.0, 2.0, 8.0, 4.0, 6.0];
        let expected = Summary { min: 0.0, p10: 1.0, median: 5.0, p90: 9.0, max: 10.0 };
        assert_eq!(Summary::of(&shuffled), Some(expected));
        let pair = Summary::of(&[4.0, 2.0]).unwrap();
        assert_eq!((pair.min, pair.median, pair.max), (2.0, 3.0, 4.0));
        assert!((pair.p10 - 2.2).abs() < 1e-15 && (pair.p90 - 3.8).abs() < 1e-15);
        let one = Summary::of(&[3.0]).unwrap();
        assert!([one.min, one.p10, one.median, one.p90, one.max] == [3.0; 5]);
    }

    #[test]
    fn no_samples_and_no_numbers_have_no_summary() {
        assert_eq!(Summary::of(&[]), None);
        assert_eq!(Summary::of(&[1.0, f64::NAN]), None);
        assert_eq!(Summary::of(&[f64::INFINITY; 3]).unwrap().median, f64::INFINITY);
    }
}
