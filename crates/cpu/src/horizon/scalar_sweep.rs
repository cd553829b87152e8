//! A hull sweep on the CPU in plain scalar code, as the competitor in timings of the device's sweeps.
//!
//! Timonen & Westerholm 2010 §4 line by line: unit steps along lines rotated to the azimuth, heights bilinear between
//! four grid points, the hull as a stack, results in a lattice rotated with the lines. All cores, f32, no manual
//! vectorisation, no rotation back.

use ridgelight::scene::HeightField;
use std::f64::consts::TAU;
use std::sync::Mutex;

/// Lines per work item of a thread.
const BAND: usize = 8;

/// Sweeps of one field, one azimuth at a time.
#[derive(Debug)]
pub struct ScalarSweep<'a> {
    field: &'a HeightField,
    side: usize,
    slopes: Vec<f32>,
    spans: Vec<[u32; 2]>,
    /// One per thread: height and step of a hull's vertices.
    stacks: Vec<Vec<[f32; 2]>>,
    lattice: Lattice,
}

/// Placement of the rotated lattice: position (x, y) in columns and rows of step `a` on line `j`.
#[derive(Clone, Copy, Debug, Default)]
struct Lattice {
    middle: [f32; 2],
    half: f32,
    dx: f32,
    dy: f32,
    step_m: f32,
}

impl Lattice {
    /// Start of a line. Lines are a cell apart, across the march.
    fn start(&self, line: usize) -> [f32; 2] {
        let off = line as f32 - self.half;
        [
            self.middle[0] - off * self.dy - self.half * self.dx,
            self.middle[1] + off * self.dx - self.half * self.dy,
        ]
    }

    /// Steps of a line within the field: from the first up to, not including, the second.
    ///
    /// x0 + a·dx rounds monotonically, so if both ends are inside, everything between is.
    fn span(&self, [x0, y0]: [f32; 2], side: usize, [last_x, last_y]: [f32; 2]) -> [u32; 2] {
        let (mut low, mut high) = (0.0_f64, side as f64);
        for (start, step, last) in [(x0, self.dx, last_x), (y0, self.dy, last_y)] {
            let (start, step, last) = (f64::from(start), f64::from(step), f64::from(last));
            if step == 0.0 {
                if start < 0.0 || start >= last {
                    return [0, 0];
                }
                continue;
            }
            let (a, b) = (-start / step, (last - start) / step);
            low = low.max(a.min(b));
            high = high.min(a.max(b));
        }
        let inside = |i: u32| {
            let (x, y) = (x0 + i as f32 * self.dx, y0 + i as f32 * self.dy);
            x >= 0.0 && y >= 0.0 && x < last_x && y < last_y
        };
        if high <= low {
            return [0, 0];
        }
        let end = (high as u32 + 2).min(side as u32);
        let first = (low as u32..end).find(|i| inside(*i)).unwrap_or(end);
        [first, (first..end).rev().find(|i| inside(*i)).map_or(first, |last| last + 1)]
    }
}

impl<'a> ScalarSweep<'a> {
    /// Makes room for the lattice: a square of the field's diagonal.
    pub fn new(field: &'a HeightField) -> Self {
        let side = (field.rows() as f64).hypot(field.cols() as f64).ceil() as usize + 2;
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        Self {
            field,
            side,
            slopes: vec![f32::NEG_INFINITY; side * side],
            spans: vec![[0, 0]; side],
            stacks: vec![vec![[0.0; 2]; side]; threads],
            lattice: Lattice::default(),
        }
    }

    /// Threads used: one per core.
    pub fn threads(&self) -> usize {
        self.stacks.len()
    }

    /// Slopes of the horizons in one azimuth (radians, counter-clockwise from east), for
    /// [`line`](Self::line).
    pub fn sweep(&mut self, azimuth_rad: f64) {
        let [cell_x, cell_y] = self.field.cell_m();
        // Away from the horizon; y counts rows, southwards.
        let turned = azimuth_rad.rem_euclid(TAU);
        let (east, north) = (-turned.cos() / cell_x, -turned.sin() / cell_y);
        let length = east.hypot(north);
        self.lattice = Lattice {
            middle: [(self.field.cols() - 1) as f32 * 0.5, (self.field.rows() - 1) as f32 * 0.5],
            half: self.side as f32 * 0.5,
            dx: (east / length) as f32,
            dy: (-north / length) as f32,
            step_m: (1.0 / length) as f32,
        };
        let (lattice, side, field) = (self.lattice, self.side, self.field);
        let bands = self.slopes.chunks_mut(BAND * side).zip(self.spans.chunks_mut(BAND));
        let work = Mutex::new(bands.enumerate());
        std::thread::scope(|scope| {
            for stack in &mut self.stacks {
                let work = &work;
                scope.spawn(move || {
                    let next = || work.lock().map_or(None, |mut bands| bands.next());
                    while let Some((band, (slopes, spans))) = next() {
                        let lines = slopes.chunks_mut(side).zip(spans).enumerate();
                        for (i, (slopes, span)) in lines {
                            *span = sweep_line(field, &lattice, band * BAND + i, stack, slopes);
                        }
                    }
                });
            }
        });
    }

    /// The first step of a line that lies on the field, and the slopes from there on: the steepest slope to an
    /// earlier step, -∞ where there is none.
    pub fn line(&self, line: usize) -> (usize, &[f32]) {
        let [first, end] = self.spans[line].map(|i| i as usize);
        (first, &self.slopes[line * self.side..][first..end])
    }

    /// Column and row of a step of a line.
    pub fn place(&self, line: usize, step: usize) -> [f32; 2] {
        let [x, y] = self.lattice.start(line);
        [x + step as f32 * self.lattice.dx, y + step as f32 * self.lattice.dy]
    }

    /// Steps on the field, of all lines of the last azimuth.
    pub fn points(&self) -> u64 {
        self.spans.iter().map(|[first, end]| u64::from(end - first)).sum()
    }
}

/// Bilinear between four grid points.
#[inline(always)]
fn height(heights: &[f32], cols: usize, x: f32, y: f32) -> f32 {
    let (ix, iy) = (x as i32, y as i32);
    let (tx, ty) = (x - ix as f32, y - iy as f32);
    // One bounds check for all four.
    let four = &heights[iy as usize * cols + ix as usize..][..cols + 2];
    let (north, south) = (&four[..2], &four[cols..]);
    (north[0] * (1.0 - tx) + north[1] * tx) * (1.0 - ty)
        + (south[0] * (1.0 - tx) + south[1] * tx) * ty
}

fn sweep_line(
    field: &HeightField,
    lattice: &Lattice,
    line: usize,
    stack: &mut [[f32; 2]],
    slopes: &mut [f32],
) -> [u32; 2] {
    let (cols, heights) = (field.cols(), field.heights_m());
    let [x0, y0] = lattice.start(line);
    let last = [(cols - 1) as f32, (field.rows() - 1) as f32];
    let span = lattice.span([x0, y0], slopes.len(), last);
    let per_step = 1.0 / lattice.step_m;
    let Some((first, rest)) = slopes[span[0] as usize..span[1] as usize].split_first_mut() else {
        return span;
    };
    let height_at = |a: f32| height(heights, cols, x0 + a * lattice.dx, y0 + a * lattice.dy);
    // The top of the hull stays in registers; the rest is on the stack.
    let mut a = span[0] as f32;
    let (mut top_h, mut top_a, mut below) = (height_at(a), a, 0);
    *first = f32::NEG_INFINITY;
    for slope in rest {
        a += 1.0;
        let h = height_at(a);
        // A vertex that is no steeper than the one behind it is hidden from here on.
        while below > 0 {
            let [under_h, under_a] = stack[below - 1];
            if (under_h - h) * (a - top_a) < (top_h - h) * (a - under_a) {
                break;
            }
            (top_h, top_a) = (under_h, under_a);
            below -= 1;
        }
        *slope = (top_h - h) / (a - top_a) * per_step;
        stack[below] = [top_h, top_a];
        below += 1;
        (top_h, top_a) = (h, a);
    }
    span
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::fractal;

    /// Every earlier step of the line as an occluder, in f64. Heights and steps are f32: a slope over
    /// d steps carries at most 2 ulp of the heights / d, and a hull test may choose a tie's other side.
    fn check(field: &HeightField, azimuth_rad: f64) -> u64 {
        let mut sweep = ScalarSweep::new(field);
        sweep.sweep(azimuth_rad);
        let highest = field.heights_m().iter().fold(0.0_f32, |m, h| m.max(h.abs()));
        let tolerance = 16.0 * f32::EPSILON * (highest / sweep.lattice.step_m).max(1.0);
        for line in 0..sweep.side {
            let (first, slopes) = sweep.line(line);
            let heights: Vec<f64> = (0..slopes.len())
                .map(|i| {
                    let [x, y] = sweep.place(line, first + i);
                    f64::from(height(field.heights_m(), field.cols(), x, y))
                })
                .collect();
            for (i, slope) in slopes.iter().enumerate() {
                let step_m = f64::from(sweep.lattice.step_m);
                let expected = (0..i)
                    .map(|j| (heights[j] - heights[i]) / ((i - j) as f64 * step_m))
                    .fold(f64::NEG_INFINITY, f64::max);
                let same = *slope == expected as f32
                    || (f64::from(*slope) - expected).abs() <= f64::from(tolerance);
                assert!(same, "line {line} step {i}: {slope}, expected {expected}");
            }
        }
        sweep.points()
    }

    #[test]
    fn sweep_is_the_brute_force_scan() {
        let square = fractal(37, 3).unwrap();
        let heights: Vec<f64> = (0..13 * 29).map(|i| f64::from(i * 7 % 31) * 0.3).collect();
        let oblong = HeightField::new(13, 29, &heights, [2.0, 5.0], None).unwrap();
        for field in [&square, &oblong] {
            for k in 0..16 {
                // Axes, diagonals, and places between.
                let points = check(field, TAU * f64::from(k) / 16.0 + f64::from(k % 3) * 0.1);
                let cells = ((field.rows() - 1) * (field.cols() - 1)) as f64;
                // Lines a cell apart, steps a cell long: a grid point a cell, but for the rim.
                let rim = 2.0 * (field.rows() + field.cols()) as f64;
                assert!((points as f64 - cells).abs() < rim, "{points} of {cells}");
            }
        }
    }

    #[test]
    fn fields_without_cells_have_no_points() {
        for (rows, cols) in [(1, 1), (1, 9), (9, 1)] {
            let flat = HeightField::new(rows, cols, &vec![1.0; rows * cols], [1.0; 2], None);
            assert_eq!(check(&flat.unwrap(), 0.3), 0);
        }
    }
}
