//! LDR-ꟻLIP: the perceived difference when two pictures alternate.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "ꟻLIP: A
//! Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2),
//! 2020; "§" below is a section of it. An error is from 0 (no visible difference) to 1. It is
//! symmetric in the two pictures and depends on the angular size of a pixel.

mod eye;

use super::statistics::quantiles;
use eye::Eye;
use ridgelight::{Error, Result};
use serde::Serialize;
use std::f64::consts::PI;
use std::sync::Mutex;

/// Pixels per degree in the paper (§4.1.1): 3840 columns over 0.7 m at a distance of 0.7 m:
/// distance · columns / width · π/180.
pub const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * PI / 180.0;

/// Rows per thread and step: small enough for memory, large enough that the rows above and below
/// that the filters reach are a small share.
const BAND: usize = 128;

/// ꟻLIP of every pixel, in [0..1], row-major.
///
/// Pictures are linear light of sRGB primaries as a display shows it: values are clipped to [0..1],
/// infinities too. A pixel that is NaN in any channel of either picture is a void: black in both
/// pictures, NaN in the result. Edge pixels extend outwards. `pixels_per_degree` is in [1..1000],
/// usually [`PIXELS_PER_DEGREE`]; a higher value hides small differences.
///
/// # Errors
/// Pictures of different size or not of whole rows of `cols`; pixels per degree out of range.
pub fn map(
    result: &[[f32; 3]],
    reference: &[[f32; 3]],
    cols: usize,
    pixels_per_degree: f64,
) -> Result<Vec<f32>> {
    if result.len() != reference.len() || cols == 0 || !result.len().is_multiple_of(cols) {
        return Err(Error::setting(
            "comparison",
            format!("{} pixels against {}", result.len(), reference.len()),
            format!("as many, a multiple of {cols}"),
        ));
    }
    if !(1.0..=1000.0).contains(&pixels_per_degree) {
        return Err(Error::setting(
            "pixels per degree",
            pixels_per_degree.to_string(),
            "1 to 1000",
        ));
    }
    let eye = Eye::new(pixels_per_degree);
    let voids: Vec<bool> =
        result.iter().zip(reference).map(|(a, b)| a.iter().chain(b).any(|v| v.is_nan())).collect();
    let mut errors = vec![0.0; result.len()];
    let bands = Mutex::new(errors.chunks_mut(BAND * cols).enumerate());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads.min(result.len().div_ceil(BAND * cols)) {
            scope.spawn(|| {
                loop {
                    let next = bands.lock().ok().and_then(|mut bands| bands.next());
                    let Some((i, band)) = next else { return };
                    let rows = (i * BAND, band.len() / cols);
                    let a = eye.filtered(result, &voids, cols, rows);
                    let b = eye.filtered(reference, &voids, cols, rows);
                    for (error, (a, b)) in band.iter_mut().zip(a.iter().zip(&b)) {
                        *error = eye.difference(a, b) as f32;
                    }
                }
            });
        }
    });
    for (error, void) in errors.iter_mut().zip(voids) {
        if void {
            *error = f32::NAN;
        }
    }
    Ok(errors)
}

/// A picture's [`map`] as statistics, each in [0..1].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FlipError {
    /// Pixels compared.
    pub count: usize,
    /// Pixels without data in one picture or both.
    pub masked: usize,
    /// Mean: the usual figure.
    pub mean: f64,
    /// Quartiles weighted by the error itself (§6): a quarter, half and three quarters of the sum
    /// of all errors lie in pixels of at most this error. Large areas of low error do not hide a
    /// few pixels.
    pub weighted_quartiles: [f64; 3],
    /// 99th percentile.
    pub p99: f64,
    /// Largest.
    pub worst: f64,
    /// Row of the largest, the first in reading order.
    pub worst_row: usize,
    /// Column of the largest.
    pub worst_col: usize,
}

impl FlipError {
    /// Summarizes a map of `cols` columns.
    ///
    /// # Errors
    /// A map without a pixel that has data.
    pub fn of(map: &[f32], cols: usize) -> Result<Self> {
        let (mut worst, mut at) = (-1.0, 0);
        let mut errors = Vec::with_capacity(map.len());
        for (i, error) in map.iter().map(|v| f64::from(*v)).enumerate().filter(|e| !e.1.is_nan()) {
            if error > worst {
                (worst, at) = (error, i);
            }
            errors.push(error);
        }
        let Some([p99]) = quantiles(&mut errors, [0.99]) else {
            let found = format!("{} pixels without data", map.len());
            return Err(Error::setting("comparison", found, "at least one pixel with data"));
        };
        let total: f64 = errors.iter().sum();
        // Sorted by `quantiles`.
        let weighted = |share: f64| {
            let mut sum = 0.0;
            let reached = |e: &&f64| {
                sum += **e;
                sum >= share * total
            };
            errors.iter().find(reached).copied().unwrap_or(worst)
        };
        Ok(Self {
            count: errors.len(),
            masked: map.len() - errors.len(),
            mean: total / errors.len() as f64,
            weighted_quartiles: [0.25, 0.5, 0.75].map(weighted),
            p99,
            worst,
            worst_row: at / cols,
            worst_col: at % cols,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Picture = Vec<[f32; 3]>;

    const COLS: usize = 64;
    const ROWS: usize = 48;

    /// Stripes and checks; the second picture adds a disc and a texture. Values are sRGB codes.
    fn pair() -> [Picture; 2] {
        let light = |code: usize| {
            let v = (code % 256) as f64 / 255.0;
            (if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }) as f32
        };
        let picture = |other: bool| {
            let code = |i: usize, c: usize| {
                let (x, y) = (i % COLS, i / COLS);
                let base = (3 * x + 2 * y * (c + 1) + 40 * ((x / 8 + y / 8) % 2)) % 256;
                let disc = x.abs_diff(40).pow(2) + y.abs_diff(20).pow(2) < 64;
                base + usize::from(other) * (60 * usize::from(disc) + x * y * (c + 1) % 7)
            };
            (0..COLS * ROWS).map(|i| [0, 1, 2].map(|c| light(code(i, c)))).collect()
        };
        [picture(false), picture(true)]
    }

    fn flip(a: &[[f32; 3]], b: &[[f32; 3]], cols: usize) -> Vec<f32> {
        map(a, b, cols, PIXELS_PER_DEGREE).unwrap()
    }

    /// The authors' own program, flip-evaluator 1.7, on the same pair at its default of 67.02
    /// pixels per degree: mean 0.214314. It computes in f32: some 50 roundings of L*a*b* of up to
    /// 100 err by 50 · 6e-8 · 100 = 3e-4, times the steepest slope of the error by it, 0.04 at a
    /// distance of 1.
    #[test]
    fn errors_are_those_of_the_published_program() {
        let [a, b] = pair();
        let errors = flip(&b, &a, COLS);
        let tolerance = 3e-4 * 0.04;
        for (row, col, published) in [
            (0, 0, 0.010_792_24),
            (20, 40, 0.980_837_3),
            (47, 63, 0.054_809_87),
            (13, 37, 0.845_521_45),
            (30, 5, 0.081_302_9),
        ] {
            let ours = errors[row * COLS + col];
            assert!((ours - published).abs() < tolerance, "{row}, {col}: {ours} for {published}");
        }
        let pooled = FlipError::of(&errors, COLS).unwrap();
        assert!((pooled.mean - 0.214_313_72).abs() < f64::from(tolerance), "{pooled:?}");
    }

    #[test]
    fn equal_pictures_have_no_error_and_one_pixel_has() {
        let [a, _] = pair();
        assert!(flip(&a, &a, COLS).iter().all(|e| *e == 0.0));
        let mut b = a.clone();
        b[20 * COLS + 9][1] += 0.1;
        let e = FlipError::of(&flip(&b, &a, COLS), COLS).unwrap();
        assert!(e.mean > 0.0 && e.worst > 0.1, "{e:?}");
        assert!(e.worst_row.abs_diff(20) < 4 && e.worst_col.abs_diff(9) < 4, "{e:?}");
        // Beyond the display's range there is no difference.
        let bright = [[7.0, 1.0, f32::INFINITY], [-3.0, 0.0, f32::NEG_INFINITY]];
        let clipped = [[1.0; 3], [0.0; 3]];
        assert_eq!(flip(&bright, &clipped, 2), [0.0; 2]);
    }

    /// The order of the pictures does not matter, nor does transposing or mirroring both.
    #[test]
    fn order_and_orientation_do_not_matter() {
        let [a, b] = pair();
        let errors = flip(&a, &b, COLS);
        assert_eq!(errors, flip(&b, &a, COLS));
        let transposed = |p: &Picture| -> Picture {
            (0..p.len()).map(|i| p[i % ROWS * COLS + i / ROWS]).collect()
        };
        let mirrored = |p: &Picture| -> Picture {
            p.chunks(COLS).flat_map(|r| r.iter().rev()).copied().collect()
        };
        let turned = flip(&transposed(&a), &transposed(&b), ROWS);
        let mirror = flip(&mirrored(&a), &mirrored(&b), COLS);
        for (i, e) in errors.iter().enumerate() {
            let (row, col) = (i / COLS, i % COLS);
            // Sums in another order, then rounded to f32.
            assert!((e - turned[col * ROWS + row]).abs() < 1e-6, "{row}, {col}");
            assert!((e - mirror[row * COLS + COLS - 1 - col]).abs() < 1e-6, "{row}, {col}");
        }
    }

    /// The same 120 rows, once across a seam between bands and once without.
    #[test]
    fn bands_leave_no_seam() {
        let [a, b] = pair();
        let tall = |p: &Picture| [p.as_slice(); 4].concat();
        let (a, b) = (tall(&a), tall(&b));
        let all = flip(&a, &b, COLS);
        let (from, to) = (70, 190);
        assert!((from..to).contains(&BAND) && a.len() > BAND * COLS);
        let part = flip(&a[from * COLS..to * COLS], &b[from * COLS..to * COLS], COLS);
        // 12 pixels are more than any filter reaches.
        for row in from + 12..to - 12 {
            let range = |row: usize| row * COLS..(row + 1) * COLS;
            assert_eq!(all[range(row)], part[range(row - from)], "row {row}");
        }
    }

    /// As if both pictures were black there, and without a number there.
    #[test]
    fn voids_are_black_and_excluded() {
        let [a, b] = pair();
        let (mut holed, mut black) = (a.clone(), [a.clone(), b.clone()]);
        for i in 100..130 {
            holed[i][2] = f32::NAN;
            black.iter_mut().for_each(|p| p[i] = [0.0; 3]);
        }
        let errors = flip(&holed, &b, COLS);
        let shown = flip(&black[0], &black[1], COLS);
        for (i, (e, s)) in errors.iter().zip(shown).enumerate() {
            assert!(if (100..130).contains(&i) { e.is_nan() } else { *e == s }, "{i}");
        }
        let pooled = FlipError::of(&errors, COLS).unwrap();
        assert_eq!((pooled.count, pooled.masked), (COLS * ROWS - 30, 30));
        assert_eq!(flip(&holed, &a, COLS).iter().filter(|e| **e == 0.0).count(), pooled.count);
        assert!(FlipError::of(&[f32::NAN; 4], 2).is_err());
    }

    /// A pixel-wide checkerboard against its mean grey: plain at 10 pixels a degree, hardly visible
    /// at 200.
    #[test]
    fn smaller_pixels_have_smaller_errors() {
        let board: Picture = (0..32 * 32).map(|i| [((i + i / 32) % 2) as f32; 3]).collect();
        let grey = vec![[0.5; 3]; board.len()];
        let mean = |ppd| FlipError::of(&map(&board, &grey, 32, ppd).unwrap(), 32).unwrap().mean;
        assert!(mean(10.0) > 2.0 * mean(200.0), "{} {}", mean(10.0), mean(200.0));
        for ppd in [1.0, 1000.0] {
            assert!((0.0..=1.0).contains(&mean(ppd)), "{ppd}: {}", mean(ppd));
        }
    }

    #[test]
    fn invalid_sizes_and_resolutions_are_refused() {
        let p = [[0.5; 3]; 6];
        assert!(map(&p, &p[..4], 2, 67.0).is_err());
        assert!(map(&p, &p, 4, 67.0).is_err());
        assert!(map(&p, &p, 0, 67.0).is_err());
        for ppd in [0.0, -67.0, 1001.0, f64::NAN, f64::INFINITY] {
            let error = map(&p, &p, 2, ppd).unwrap_err().to_string();
            assert!(error.contains("pixels per degree: found"), "{error}");
        }
    }

    /// Errors of 1/8 to 4/8: sum 10/8, running sums 1 3 6 10 eighths; quarters of the sum are 2.5, 5
    /// and 7.5, first reached by the second, third and fourth. Rank 0.99 · 3 = 2.97.
    #[test]
    fn statistics_have_their_known_values() {
        let e = FlipError::of(&[0.25, f32::NAN, 0.5, 0.125, 0.375, f32::NAN], 3).unwrap();
        assert_eq!((e.count, e.masked, e.mean), (4, 2, 0.3125));
        assert_eq!(e.weighted_quartiles, [0.25, 0.375, 0.5]);
        assert!((e.p99 - (0.375 + 0.97 * 0.125)).abs() < 1e-15);
        assert_eq!((e.worst, e.worst_row, e.worst_col), (0.5, 0, 2));
        // Running sums 1 3 6 9 12 16 eighths: all quarters, 12 exactly, within the errors of 3/8.
        let e = FlipError::of(&[0.375, 0.125, 0.375, 0.5, 0.25, 0.375], 3).unwrap();
        assert_eq!(e.weighted_quartiles, [0.375; 3]);
        let none = FlipError::of(&[0.0; 4], 2).unwrap();
        assert_eq!((none.mean, none.weighted_quartiles, none.worst), (0.0, [0.0; 3], 0.0));
    }
}
