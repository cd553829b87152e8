//! Errors of a result against a reference: pure functions on planes.
//!
//! NaN marks voids. A value that is NaN on both sides is masked and ignored. NaN on one side only
//! is a mismatch: it is counted and excluded from the statistics. An
//! infinity on one side only is an infinite error.

use super::statistics::quantiles;
use ridgelight::{Error, Result};
use serde::Serialize;

/// What [`ImageError`] and [`HorizonError`] compare: f32 and f64.
pub trait Number: Copy + Into<f64> {}

impl<T: Copy + Into<f64>> Number for T {}

/// Error of a plane of radiance, in its own unit unless stated otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ImageError {
    /// Values compared.
    pub count: usize,
    /// Values that are NaN in both.
    pub masked: usize,
    /// Values that are NaN in exactly one: data where there should be none, or the reverse.
    pub mismatched: usize,
    /// Mean of the reference over the values compared.
    pub mean_reference: f64,
    /// Root of the mean squared difference.
    pub rmse: f64,
    /// `rmse` over |`mean_reference`|. 0 when `rmse` is 0, else infinite when the mean is 0 or not
    /// finite.
    pub relative_rmse: f64,
    /// Mean of (result - reference): above 0 the result is too bright.
    pub mean_shift: f64,
    /// `mean_shift` over |`mean_reference`|, as for `relative_rmse`.
    pub relative_mean_shift: f64,
    /// 99th percentile of |difference|.
    pub p99: f64,
    /// `p99` over |`mean_reference`|, as for `relative_rmse`.
    pub relative_p99: f64,
    /// Largest |difference|.
    pub worst: f64,
    /// `worst` over |`mean_reference`|, as for `relative_rmse`.
    pub relative_worst: f64,
    /// Row of the largest |difference|, the first in reading order.
    pub worst_row: usize,
    /// Column of the largest |difference|.
    pub worst_col: usize,
}

impl ImageError {
    /// Compares row-major planes of `cols` columns.
    ///
    /// # Errors
    /// Planes of different size, not of whole rows, or without a value that both have.
    pub fn of(result: &[impl Number], reference: &[impl Number], cols: usize) -> Result<Self> {
        let mut pairs = Pairs::of(result, reference, cols)?;
        let count = pairs.differences.len();
        let mean_reference = pairs.reference_sum / count as f64;
        let mean_shift = pairs.differences.iter().sum::<f64>() / count as f64;
        let (worst, at) = pairs.worst;
        let (masked, mismatched) = (pairs.masked, pairs.mismatched);
        let magnitudes = pairs.magnitudes();
        // In units of the worst, squares neither overflow nor vanish.
        let rmse = if worst > 0.0 && worst.is_finite() {
            let squares: f64 = magnitudes.iter().map(|d| (d / worst).powi(2)).sum();
            worst * (squares / count as f64).sqrt()
        } else {
            worst
        };
        let relative = |x: f64| match x {
            0.0 => 0.0,
            x if mean_reference.is_finite() => x / mean_reference.abs(),
            // An infinity on both sides is no error, and must not hide those of the others.
            x => x * f64::INFINITY,
        };
        let [p99] = quantiles(magnitudes, [0.99]).unwrap_or_default();
        Ok(Self {
            count,
            masked,
            mismatched,
            mean_reference,
            rmse,
            relative_rmse: relative(rmse),
            mean_shift,
            relative_mean_shift: relative(mean_shift),
            p99,
            relative_p99: relative(p99),
            worst,
            relative_worst: relative(worst),
            worst_row: at / cols,
            worst_col: at % cols,
        })
    }
}

/// Error of horizons, in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HorizonError {
    /// Horizons compared.
    pub count: usize,
    /// Horizons that are NaN in both.
    pub masked: usize,
    /// Horizons that are NaN in exactly one.
    pub mismatched: usize,
    /// Mean of |difference|.
    pub mean_deg: f64,
    /// Median of |difference|.
    pub median_deg: f64,
    /// 99th percentile of |difference|.
    pub p99_deg: f64,
    /// 99.9th percentile of |difference|.
    pub p999_deg: f64,
    /// Largest |difference|.
    pub worst_deg: f64,
    /// Azimuth (index), row and column of the largest |difference|.
    pub worst_at: [usize; 3],
}

impl HorizonError {
    /// Compares elevations in radians, laid out [azimuths, `rows`, `cols`].
    ///
    /// # Errors
    /// Arrays of different size, not of whole planes, or without a horizon that both have.
    pub fn of(
        result: &[impl Number],
        reference: &[impl Number],
        rows: usize,
        cols: usize,
    ) -> Result<Self> {
        let plane = rows.saturating_mul(cols);
        let mut pairs = Pairs::of(result, reference, plane)?;
        let (worst, at) = pairs.worst;
        let (masked, mismatched) = (pairs.masked, pairs.mismatched);
        let magnitudes = pairs.magnitudes();
        let count = magnitudes.len();
        let mean = magnitudes.iter().sum::<f64>() / count as f64;
        let [median_deg, p99_deg, p999_deg] =
            quantiles(magnitudes, [0.5, 0.99, 0.999]).unwrap_or_default().map(f64::to_degrees);
        Ok(Self {
            count,
            masked,
            mismatched,
            mean_deg: mean.to_degrees(),
            median_deg,
            p99_deg,
            p999_deg,
            worst_deg: worst.to_degrees(),
            worst_at: [at / plane, at % plane / cols, at % cols],
        })
    }
}

/// Differences of all pairs of numbers.
struct Pairs {
    differences: Vec<f64>,
    reference_sum: f64,
    masked: usize,
    mismatched: usize,
    worst: (f64, usize),
}

impl Pairs {
    fn of(result: &[impl Number], reference: &[impl Number], stride: usize) -> Result<Self> {
        if result.len() != reference.len() || stride == 0 || !result.len().is_multiple_of(stride) {
            return Err(Error::setting(
                "comparison",
                format!("{} values against {}", result.len(), reference.len()),
                format!("as many, a multiple of {stride}"),
            ));
        }
        let mut pairs = Self {
            differences: Vec::with_capacity(result.len()),
            reference_sum: 0.0,
            masked: 0,
            mismatched: 0,
            worst: (-1.0, 0),
        };
        for (i, (&a, &b)) in result.iter().zip(reference).enumerate() {
            let (a, b): (f64, f64) = (a.into(), b.into());
            match (a.is_nan(), b.is_nan()) {
                (true, true) => pairs.masked += 1,
                (false, false) => {
                    // Equal infinities are no error, though their difference is NaN.
                    let difference = if a == b { 0.0 } else { a - b };
                    pairs.differences.push(difference);
                    pairs.reference_sum += b;
                    if difference.abs() > pairs.worst.0 {
                        pairs.worst = (difference.abs(), i);
                    }
                }
                _ => pairs.mismatched += 1,
            }
        }
        if pairs.differences.is_empty() {
            return Err(Error::setting(
                "comparison",
                format!("{} masked, {} mismatched", pairs.masked, pairs.mismatched),
                "at least one texel with data on both sides",
            ));
        }
        Ok(pairs)
    }

    /// Absolute differences, in place.
    fn magnitudes(&mut self) -> &mut [f64] {
        self.differences.iter_mut().for_each(|d| *d = d.abs());
        &mut self.differences
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAN: f64 = f64::NAN;

    /// Reference 2 everywhere, errors +3, -1, 0, 0 over 4 values: rmse √(10/4), shift 2/4, mean 2;
    /// |errors| sorted 0 0 1 3: rank 0.99·3 = 2.97 is at 1 + 0.97·2.
    #[test]
    fn known_differences_have_their_known_errors() {
        let e = ImageError::of(&[5.0_f32, 1.0, 2.0, 2.0], &[2.0_f64; 4], 2).unwrap();
        assert_eq!((e.count, e.masked, e.mismatched), (4, 0, 0));
        assert!((e.rmse - 2.5_f64.sqrt()).abs() < 1e-15);
        assert!((e.relative_rmse - 2.5_f64.sqrt() / 2.0).abs() < 1e-15);
        assert_eq!((e.mean_reference, e.mean_shift, e.relative_mean_shift), (2.0, 0.5, 0.25));
        assert!((e.p99 - 2.94).abs() < 1e-14 && (e.relative_p99 - 1.47).abs() < 1e-14);
        assert_eq!((e.worst, e.relative_worst, e.worst_row, e.worst_col), (3.0, 1.5, 0, 0));
    }

    #[test]
    fn identical_planes_have_no_error_and_one_changed_value_has() {
        let reference = [0.5_f32, 0.25, f32::NAN, 8.0, 1e-30, 0.0];
        let same = ImageError::of(&reference, &reference, 3).unwrap();
        assert_eq!((same.rmse, same.mean_shift, same.worst, same.masked), (0.0, 0.0, 0.0, 1));
        let mut wrong = reference;
        wrong[4] = 1e-3;
        let e = ImageError::of(&wrong, &reference, 3).unwrap();
        assert_eq!((e.worst_row, e.worst_col), (1, 1));
        assert!(e.rmse > 0.0 && e.worst > 0.0 && e.p99 > 0.0 && e.mean_shift > 0.0);
    }

    /// NaN on one side is counted; an infinity on one side is an infinite error.
    #[test]
    fn holes_and_infinities_are_reported() {
        for (a, b) in [([NAN, 1.0, 1.0], [1.0; 3]), ([1.0; 3], [NAN, 1.0, 1.0])] {
            let e = ImageError::of(&a, &b, 3).unwrap();
            assert_eq!((e.count, e.masked, e.mismatched, e.rmse), (2, 0, 1, 0.0));
        }
        let e = ImageError::of(&[1.0, f64::INFINITY], &[1.0, 1.0], 2).unwrap();
        assert_eq!((e.rmse, e.worst, e.worst_col), (f64::INFINITY, f64::INFINITY, 1));
        let e = ImageError::of(&[f64::INFINITY, 1.5], &[f64::INFINITY, 1.0], 2).unwrap();
        assert_eq!(
            (e.worst, e.relative_worst, e.relative_mean_shift),
            (0.5, f64::INFINITY, f64::INFINITY)
        );
        assert!(ImageError::of(&[NAN, 1.0], &[1.0, NAN], 2).is_err(), "nothing in common");
        assert!(ImageError::of(&[1.0, 1.0], &[1.0], 1).is_err());
        assert!(ImageError::of(&[1.0, 1.0, 1.0], &[1.0; 3], 2).is_err());
    }

    /// One peak of 1e200 among 1e6 values: rmse 1e200/1e3, though its square overflows. With a
    /// black reference any error is relatively infinite, and none is 0.
    #[test]
    fn peaks_and_black_references_are_safe() {
        let reference = vec![0.0; 1_000_000];
        let mut result = reference.clone();
        result[123_456] = 1e200;
        let e = ImageError::of(&result, &reference, 1000).unwrap();
        assert!((e.rmse / 1e197 - 1.0).abs() < 1e-12);
        assert_eq!((e.relative_rmse, e.worst_row, e.worst_col), (f64::INFINITY, 123, 456));
        assert_eq!(e.p99, 0.0);
        assert_eq!(ImageError::of(&reference, &reference, 1000).unwrap().relative_rmse, 0.0);
    }

    /// 2 azimuths of 10 × 50: |difference| of horizon i is i thousandths of a degree, signs mixed.
    #[test]
    fn horizons_are_compared_in_degrees() {
        let reference: Vec<f64> = (0..1000).map(|i| f64::from(i % 7) * 0.1).collect();
        let off = |i: usize| [1.0, -1.0][i % 2] * i as f64 * 1e-3;
        let result: Vec<f64> =
            reference.iter().enumerate().map(|(i, r)| r + off(i).to_radians()).collect();
        let e = HorizonError::of(&result, &reference, 10, 50).unwrap();
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(e.mean_deg, 0.4995) && near(e.median_deg, 0.4995), "{e:?}");
        assert!(
            near(e.p99_deg, 0.98901) && near(e.p999_deg, 0.998001) && near(e.worst_deg, 0.999),
            "{e:?}"
        );
        assert_eq!(e.worst_at, [1, 9, 49]);
        let mut holed = result;
        holed[7] = NAN;
        let e = HorizonError::of(&holed, &reference, 10, 50).unwrap();
        assert_eq!(e.mismatched, 1);
        assert!(HorizonError::of(&holed[..999], &reference[..999], 10, 50).is_err());
    }
}
