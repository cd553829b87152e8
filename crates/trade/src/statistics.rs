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

#[cfg(test)]
mod tests {
    use super::*;

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
