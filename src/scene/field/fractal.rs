//! A fixed fractal height field for benchmarks: the same bits on every machine.
//!
//! Only integer hashing and IEEE addition, multiplication and division enter (no libm, no fused
//! operations), so timings from different machines are of the same field.

use crate::basis::random::{STEP, mixed, unit};
use crate::scene::HeightField;
use crate::{Error, Result};

/// Spacing of the finest octave's lattice, in cells. It doubles from octave to octave.
const FINEST_TEXELS: f64 = 2.0;
/// 2^0.8: amplitude of an octave over that of the next finer. The spectrum is that of a self-affine
/// surface of Hurst exponent 0.8, between eroded (0.9) and young (0.7) mountains.
const PER_OCTAVE: f64 = 1.741_101_126_592_248_2;
/// Half the range of the finest octave's lattice values, metres. Fitted for an rms slope near 0.5
/// (the test `relief_and_slopes_are_those_of_mountains` prints it): relief comes to about a tenth of
/// the side.
const FINEST_AMPLITUDE_M: f64 = 1.25;

/// `size`×`size` grid points of rough mountains, cells of 1 m, different for every `seed`.
///
/// A sum of octaves, each a uniform cubic B-spline over a lattice of hashed values: smooth to the second derivative,
/// without the terraces of value noise. Lattice spacings are fixed in cells (2, 4, 8, … up to a quarter of the side), so
/// slopes are equal at every size and relief grows like size^0.8. Cost is size² · log₂(size).
///
/// # Errors
/// Size 0, or one whose square exceeds the address space.
pub fn fractal(size: usize, seed: u64) -> Result<HeightField> {
    let grid_points = size.checked_mul(size).filter(|&n| n > 0 && n <= isize::MAX as usize / 8);
    let Some(grid_points) = grid_points else {
        return Err(Error::setting(
            "fractal size",
            size.to_string(),
            "1 or more grid points a side",
        ));
    };
    let mut heights = vec![0.0; grid_points];
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let band = size.div_ceil(threads);
    std::thread::scope(|scope| {
        for (i, rows) in heights.chunks_mut(band * size).enumerate() {
            scope.spawn(move || {
                let (mut spacing, mut amplitude, mut octave) =
                    (FINEST_TEXELS, FINEST_AMPLITUDE_M, 0);
                while octave == 0 || 4.0 * spacing <= size as f64 {
                    add_octave(rows, size, i * band, spacing, amplitude, mix(seed, octave));
                    spacing *= 2.0;
                    amplitude *= PER_OCTAVE;
                    octave += 1;
                }
            });
        }
    });
    HeightField::new(size, size, &heights, [1.0, 1.0], None)
}

/// Adds one octave to the rows from `first_row` on.
fn add_octave(
    rows: &mut [f64],
    size: usize,
    first_row: usize,
    spacing: f64,
    amplitude: f64,
    key: u64,
) {
    // A shift of its own keeps an octave's lattice off those of the others.
    let [shift_x, shift_y] = [unit(mix(key, 1)), unit(mix(key, 2))];
    let place = |i: usize, shift: f64| {
        let t = i as f64 / spacing + shift;
        let knot = t as usize; // t ≥ 0
        (knot, basis(t - knot as f64))
    };
    let across: Vec<(usize, [f64; 4])> = (0..size).map(|c| place(c, shift_x)).collect();
    let knots = across.last().map_or(0, |last| last.0) + 4;
    let lattice_row = |row: usize| -> Vec<f64> {
        let key = mix(key, row as u64 + 3);
        (0..knots).map(|k| amplitude * (2.0 * unit(mix(key, k as u64)) - 1.0)).collect()
    };
    let mut held: Option<(usize, [Vec<f64>; 4])> = None;
    let mut line = vec![0.0; knots];
    for (r, row) in rows.chunks_mut(size).enumerate() {
        let (knot, weights) = place(first_row + r, shift_y);
        let lattice = match held.take() {
            Some((at, lattice)) if at == knot => lattice,
            _ => std::array::from_fn(|k| lattice_row(knot + k)),
        };
        for (k, value) in line.iter_mut().enumerate() {
            *value = weights[0] * lattice[0][k]
                + weights[1] * lattice[1][k]
                + weights[2] * lattice[2][k]
                + weights[3] * lattice[3][k];
        }
        for (height, (knot, w)) in row.iter_mut().zip(&across) {
            let v = &line[*knot..knot + 4];
            *height += w[0] * v[0] + w[1] * v[1] + w[2] * v[2] + w[3] * v[3];
        }
        held = Some((knot, lattice));
    }
}

/// The four uniform cubic B-splines that overlap at share `t` of a knot span; they sum to 1.
fn basis(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    let (t2, s2) = (t * t, s * s);
    [
        s2 * s / 6.0,
        (4.0 - 6.0 * t2 + 3.0 * t2 * t) / 6.0,
        (4.0 - 6.0 * s2 + 3.0 * s2 * s) / 6.0,
        t2 * t / 6.0,
    ]
}

/// Hashes a value into a key.
fn mix(key: u64, value: u64) -> u64 {
    mixed(key.wrapping_add(value.wrapping_add(1).wrapping_mul(STEP)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hash(field: &HeightField) -> u64 {
        field.heights_m().iter().fold(0, |key, h| mix(key, u64::from(h.to_bits())))
    }

    /// Weights sum to 1 and reproduce a straight line: Σ w_k·(k - 1) = t.
    #[test]
    fn basis_reproduces_lines() {
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            let w = basis(t);
            assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            assert!((w[2] + 2.0 * w[3] - w[0] - t).abs() < 1e-15);
        }
    }

    /// The bits are the contract: every machine times the same field. Bands and threads do not enter.
    #[test]
    fn same_bits_on_every_machine() {
        let field = fractal(97, 7).unwrap();
        assert_eq!(hash(&field), PINNED, "{:#x}", hash(&field));
        let (mut whole, mut bands) = (vec![0.0; 61 * 61], vec![0.0; 61 * 61]);
        add_octave(&mut whole, 61, 0, 8.0, 1.0, 5);
        for (i, band) in bands.chunks_mut(7 * 61).enumerate() {
            add_octave(band, 61, i * 7, 8.0, 1.0, 5);
        }
        assert_eq!(whole, bands);
        assert_ne!(hash(&field), hash(&fractal(97, 8).unwrap()));
    }

    /// Recorded, not derived: a change of it changes what every benchmark was timed on.
    const PINNED: u64 = 0x396d_4f07_59bf_5f86;

    #[test]
    fn any_size_has_a_field() {
        for size in [1, 2, 3, 5, 31, 64, 101] {
            let field = fractal(size, 1).unwrap();
            assert_eq!((field.rows(), field.cols(), field.cell_m()), (size, size, [1.0, 1.0]));
        }
        assert!(fractal(0, 1).is_err());
        assert!(fractal(usize::MAX, 1).is_err());
    }

    /// The rms slope is that of steep mountains, 22° to 35°, at every size, and the relief 0.05 to 0.2
    /// of the side: few large octaves make it vary between sizes and seeds.
    #[test]
    fn relief_and_slopes_are_those_of_mountains() {
        for size in [128_usize, 331, 512, 1024] {
            let field = fractal(size, 1).unwrap();
            let h = field.heights_m();
            let (low, high) =
                h.iter().fold((f32::MAX, f32::MIN), |(l, u), &x| (l.min(x), u.max(x)));
            let steps = h.windows(2).enumerate().filter(|(i, _)| (i + 1) % size != 0);
            let sum: f64 = steps.map(|(_, p)| f64::from(p[1] - p[0]).powi(2)).sum();
            let slope = (2.0 * sum / (size * (size - 1)) as f64).sqrt();
            let relief = f64::from(high - low) / size as f64;
            println!("{size}: relief {relief:.3} of the side, rms slope {slope:.2}");
            assert!((0.4..0.7).contains(&slope), "{slope}");
            assert!((0.05..0.2).contains(&relief), "{relief}");
        }
    }
}
