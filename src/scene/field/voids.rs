//! Voids: grid points without data. Their heights are filled from those around them before anything is computed.

use super::HEIGHT_LIMIT;
use crate::{Error, Result};

/// Fills voids as [`HeightField::new`](super::HeightField::new) does, for a caller that writes heights to the device
/// itself ([`HeightField::unknown`](super::HeightField::unknown)). `heights_m` are row after row from the north-west,
/// `voids` one mark per grid point. Heights of voids may have any value; all others keep their bits.
///
/// # Errors
/// Sizes that do not match; a height outside voids that is not finite or beyond ±1e15; voids only.
pub fn fill_voids([rows, cols]: [usize; 2], heights_m: &mut [f32], voids: &[bool]) -> Result<()> {
    let count = rows.checked_mul(cols).filter(|count| *count == heights_m.len());
    if count != Some(voids.len()) {
        let found = format!(
            "{} and {} voids for {rows} × {cols} grid points",
            heights_m.len(),
            voids.len()
        );
        return Err(Error::setting("heights", found, "rows × columns of both"));
    }
    let is_wrong =
        |(h, void): (&f32, &bool)| !void && (h.is_nan() || f64::from(h.abs()) > HEIGHT_LIMIT);
    if let Some(i) = heights_m.iter().zip(voids).position(is_wrong) {
        return Err(Error::setting(
            format!("height at row {}, column {}", i / cols, i % cols),
            format!("{:?}", heights_m[i]),
            "a finite number within ±1e15, or a void",
        ));
    }
    if !voids.contains(&false) {
        return Err(Error::setting("heights", "nothing but voids", "at least one height"));
    }
    fill(rows, cols, heights_m, voids);
    Ok(())
}

/// Fewest iterations of [`smooth`] and most updates of a void, over all iterations: about a tenth of a second.
const FEWEST_ITERATIONS: usize = 32;
const MOST_UPDATES: usize = 1 << 25;

/// Fills voids layer by layer from the known heights around them, then smooths them: layers that come from opposite sides meet in
/// steps, four times as steep as real ground in what was measured. No height leaves the range of the known heights around its void.
///
/// Iterations halve the difference to the solution of Laplace's equation in about d², where d is the number of layers, so that 4 d²
/// leave a tenth. Where these are too many, steps of voids wider than some 20 grid points remain: after 32 iterations up to a tenth
/// of the former step.
pub(super) fn fill(rows: usize, cols: usize, heights: &mut [f32], voids: &[bool]) {
    let layers = fill_layers(rows, cols, heights, voids);
    let count = voids.iter().filter(|v| **v).count();
    let affordable = (MOST_UPDATES / count.max(1)).max(FEWEST_ITERATIONS);
    smooth(
        [rows, cols],
        heights,
        voids,
        (4 * layers * layers).clamp(FEWEST_ITERATIONS, affordable),
    );
}

/// Jacobi's iteration for Laplace's equation on the grid, whatever its cells: each void takes the mean of its four neighbours. A
/// neighbour beyond the edge of the field counts as the void's own height. The last iteration keeps half of the height,
/// which removes what alternates from point to point.
fn smooth([rows, cols]: [usize; 2], heights: &mut [f32], voids: &[bool], iterations: usize) {
    // Voids side by side along a row.
    let mut runs: Vec<[usize; 2]> = Vec::new();
    for row in 0..rows {
        let mut at = row * cols;
        for run in voids[at..at + cols].chunk_by(|a, b| a == b) {
            if run[0] {
                runs.push([at, at + run.len()]);
            }
            at += run.len();
        }
    }
    let mut means = Vec::with_capacity(runs.iter().map(|[start, end]| end - start).sum());
    for iteration in 1..=iterations {
        means.clear();
        for [start, end] in &runs {
            let (row, first) = (start / cols, start - start % cols);
            for i in *start..*end {
                let own = f64::from(heights[i]);
                let at = |on_field: bool, n: usize| match on_field {
                    true => f64::from(heights[n]),
                    false => own,
                };
                let across = at(i > first, i.wrapping_sub(1)) + at(i + 1 < first + cols, i + 1);
                let along = at(row > 0, i.wrapping_sub(cols)) + at(row + 1 < rows, i + cols);
                let mean = 0.25 * (across + along);
                let is_last = iteration == iterations;
                means.push(if is_last { 0.5 * (mean + own) } else { mean } as f32);
            }
        }
        let mut at = 0;
        for [start, end] in &runs {
            let count = end - start;
            heights[*start..*end].copy_from_slice(&means[at..at + count]);
            at += count;
        }
    }
}

/// Each void takes the mean of its known neighbours (of eight), from the outside inwards. Returns the number of layers.
fn fill_layers(rows: usize, cols: usize, heights: &mut [f32], voids: &[bool]) -> usize {
    let mut known: Vec<bool> = voids.iter().map(|v| !v).collect();
    let neighbours = |i: usize| {
        let (r, c) = (i / cols, i % cols);
        let (r0, r1) = (r.saturating_sub(1), (r + 1).min(rows - 1));
        let (c0, c1) = (c.saturating_sub(1), (c + 1).min(cols - 1));
        (r0..=r1).flat_map(move |r| (c0..=c1).map(move |c| r * cols + c))
    };
    let mut rim: Vec<usize> =
        (0..heights.len()).filter(|&i| !known[i] && neighbours(i).any(|n| known[n])).collect();
    let mut layers = 0;
    while !rim.is_empty() {
        layers += 1;
        let layer: Vec<f32> = rim
            .iter()
            .map(|&i| {
                let (sum, count) = neighbours(i)
                    .filter(|&n| known[n])
                    .fold((0.0_f64, 0_u32), |(s, k), n| (s + f64::from(heights[n]), k + 1));
                (sum / f64::from(count)) as f32
            })
            .collect();
        for (&i, &h) in rim.iter().zip(&layer) {
            heights[i] = h;
            known[i] = true;
        }
        let mut next: Vec<usize> =
            rim.iter().flat_map(|&i| neighbours(i)).filter(|&n| !known[n]).collect();
        next.sort_unstable();
        next.dedup();
        rim = next;
    }
    layers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::HeightField;

    /// The filled heights equal those of the field, whose base is 0. Each error names its cause.
    #[test]
    fn fill_voids_equals_the_filling_of_a_field() {
        let heights: Vec<f32> = (0..30).map(|i| ((i * 7) % 5) as f32 - 2.0).collect();
        let voids: Vec<bool> = (0..30).map(|i| i % 4 == 1 || (10..15).contains(&i)).collect();
        let of_field: Vec<f64> = heights.iter().map(|h| f64::from(*h)).collect();
        let field = HeightField::new(5, 6, &of_field, [1.0, 1.0], Some(voids.clone())).unwrap();
        assert_eq!(field.base_m(), 0.0);
        let mut filled = heights.clone();
        voids.iter().zip(&mut filled).filter(|v| *v.0).for_each(|(_, h)| *h = f32::NAN);
        fill_voids([5, 6], &mut filled, &voids).unwrap();
        assert_eq!(filled, field.heights_m());
        let refuse = |heights: &mut [f32], voids: &[bool], expected: &str| {
            let message = fill_voids([5, 6], heights, voids).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        };
        refuse(&mut filled[1..], &voids, "29 and 30 voids for 5 × 6 grid points");
        refuse(&mut filled, &[true; 30], "nothing but voids");
        filled[8] = f32::INFINITY;
        refuse(&mut filled, &[false; 30], "height at row 1, column 2: found inf");
    }

    #[test]
    fn fills_a_void_between_equal_neighbours_with_their_height() {
        let mut heights = [5.0; 25];
        let mut voids = vec![false; 25];
        for i in [6, 7, 8, 11, 12, 13, 16, 17, 18] {
            heights[i] = f64::INFINITY;
            voids[i] = true;
        }
        let field = HeightField::new(5, 5, &heights, [1.0, 1.0], Some(voids)).unwrap();
        assert!(field.heights_m().iter().all(|h| *h == 0.0));
    }
}
