use crate::Result;
use crate::scene::{Albedo, Border, HeightField, PhongSpecular, Scene, Specular};

/// A grid `times` finer, and for each of its points the corners of the triangle around it with their weights.
struct Finer {
    rows: usize,
    cols: usize,
    times: usize,
    of: [usize; 2],
}

impl Finer {
    fn new(field: &HeightField, border: Border, times: usize) -> Self {
        let finer = |n: usize| match border {
            Border::Periodic => n * times,
            Border::Plane | Border::Open => (n - 1) * times + 1,
        };
        let of = [field.rows(), field.cols()];
        Self { rows: finer(of[0]), cols: finer(of[1]), times, of }
    }

    /// Three grid points of the field and their weights, which sum to 1.
    fn corners(&self, at: usize) -> [(usize, f64); 3] {
        let [row, col] = [at / self.cols, at % self.cols];
        let part = |n: usize| (n % self.times) as f64 / self.times as f64;
        let [first_row, first_col] = [row, col].map(|n| n / self.times);
        let [down, right] = [row, col].map(part);
        let coarse = |down: usize, right: usize| {
            (first_row + down) % self.of[0] * self.of[1] + (first_col + right) % self.of[1]
        };
        // Corners of weight 0 may lie beyond the last grid point: any value serves.
        let (low, middle) =
            if down <= right { (right - down, coarse(0, 1)) } else { (down - right, coarse(1, 0)) };
        let both = down.min(right);
        [(coarse(0, 0), 1.0 - low - both), (middle, low), (coarse(1, 1), both)]
    }

    fn each(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let of = |at| self.corners(at).iter().map(|(i, share)| share * value(*i)).sum();
        (0..self.rows * self.cols).map(of).collect()
    }
}

impl HeightField {
    /// The same surface with `times` as many grid points along both axes. Its triangles are cut into equal ones; heights
    /// are f32. The result has no voids: filled heights are ground.
    ///
    /// # Errors
    /// [Unknown](Self::unknown) heights; a cell size below its range.
    ///
    /// # Panics
    /// 0 times.
    pub fn finer(&self, border: Border, times: usize) -> Result<Self> {
        self.check_known("finer field", "heights: the new ones are linear between them")?;
        let finer = Finer::new(self, border, times);
        let heights = finer.each(|i| self.base_m() + f64::from(self.heights_m()[i]));
        let cell_m = self.cell_m().map(|c| c / times as f64);
        Self::new(finer.rows, finer.cols, &heights, cell_m, None)
    }
}

impl Scene {
    /// [`HeightField::finer`], with albedo and specular maps linear between grid points.
    ///
    /// # Errors
    /// As [`HeightField::finer`].
    ///
    /// # Panics
    /// 0 times.
    pub fn finer(&self, times: usize) -> Result<Self> {
        let border = self.surface.border;
        let finer = Finer::new(&self.field, border, times);
        let f32s = |values: Vec<f64>| values.into_iter().map(|v| v as f32);
        let mut surface = self.surface.clone();
        if let Albedo::Map(map) = &mut surface.albedo {
            let [r, g, b] = [0, 1, 2].map(|c| f32s(finer.each(|i| f64::from(map[i][c]))));
            *map = r.zip(g).zip(b).map(|((r, g), b)| [r, g, b]).collect();
        }
        if let Some(Specular::Map(map)) = &mut surface.specular {
            let exponents = f32s(finer.each(|i| f64::from(map[i].exponent)));
            let scales = f32s(finer.each(|i| f64::from(map[i].scale)));
            *map = exponents
                .zip(scales)
                .map(|(exponent, scale)| PhongSpecular { exponent, scale })
                .collect();
        }
        Ok(Self { field: self.field.finer(border, times)?, surface, lights: self.lights.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Lights, Surface};

    /// Corners stay; the middle of a diagonal is the mean of its ends, the centre of a triangle the mean of its corners,
    /// also across the edge of a periodic field. Whole numbers up to 9 and their thirds are exact within 2⁻²².
    #[test]
    fn the_surface_stays_the_same() {
        let heights: Vec<f64> = vec![0.0, 9.0, 3.0, 6.0, 1.0, 8.0];
        let field = HeightField::new(2, 3, &heights, [3.0, 6.0], None).unwrap();
        let albedo = Albedo::Map(heights.iter().map(|h| [*h as f32 / 10.0; 3]).collect());
        for (border, rows, cols) in [(Border::Plane, 4, 7), (Border::Periodic, 6, 9)] {
            let surface = Surface { albedo: albedo.clone(), border, specular: None };
            let scene = Scene { field: field.clone(), surface, lights: Lights::default() };
            let finer = scene.finer(3).unwrap();
            assert_eq!([finer.field.rows(), finer.field.cols()], [rows, cols]);
            assert_eq!(finer.field.cell_m(), [1.0, 2.0]);
            let Albedo::Map(map) = &finer.surface.albedo else { panic!("no map") };
            let hold = |row: usize, col: usize, known: f64| {
                let at = row * cols + col;
                let height = finer.field.base_m() + f64::from(finer.field.heights_m()[at]);
                assert!((height - known).abs() < 2.4e-7 * 9.0, "{border:?} {row} {col}: {height}");
                assert!((f64::from(map[at][0]) - known / 10.0).abs() < 1e-6);
            };
            hold(0, 3, 9.0);
            hold(3, 6, 8.0);
            hold(2, 2, (0.0 + 2.0 * 1.0) / 3.0);
            // North of the diagonal 0, 9, 1; south of it 0, 6, 1.
            hold(1, 2, 10.0 / 3.0);
            hold(2, 1, 7.0 / 3.0);
            if border == Border::Periodic {
                // North of the diagonal 8; beyond the edges 6 to the east and 0 behind the corner.
                hold(4, 8, 14.0 / 3.0);
            }
        }
    }
}
