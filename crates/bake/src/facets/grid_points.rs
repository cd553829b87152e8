//! Transfers between triangles and the grid points of the field.

use super::{ExitRadiance, Facets, corners_of};

impl Facets {
    /// The field's grid points (not the refined field's) around a triangle, and their weights.
    pub(super) fn between(&self, facet: usize) -> [(usize, f64); 3] {
        let times = self.times as f64;
        let cell = facet / 2;
        let middle = if facet.is_multiple_of(2) { [2.0, 1.0] } else { [1.0, 2.0] };
        let place = [cell % self.cells[0], cell / self.cells[0]];
        let [right, down] = [0, 1].map(|i| {
            let within = (place[i] % self.times) as f64 + middle[i] / 3.0;
            within / times
        });
        let [col, row] = place.map(|n| n / self.times);
        let cells = self.cells[0] / self.times;
        let coarse = 2 * (row * cells + col) + usize::from(down > right);
        let corners = corners_of(coarse, cells, self.size);
        let both = down.min(right);
        let one = (down - right).abs();
        [(corners[0], 1.0 - both - one), (corners[1], one), (corners[2], both)]
    }

    /// Exit radiance of grid points with the same total as the triangles': the area-weighted mean.
    pub fn to_grid_points(&self, radiance: &[[f64; 3]]) -> Vec<[f32; 3]> {
        let mut sums = vec![([0.0; 3], 0.0); self.size[0] * self.size[1]];
        for (facet, light) in radiance.iter().enumerate() {
            let area = self.area(facet);
            for (point, share) in self.between(facet) {
                let (sum, whole) = &mut sums[point];
                (0..3).for_each(|c| sum[c] += share * area * light[c]);
                *whole += share * area;
            }
        }
        sums.into_iter().map(|(sum, whole)| sum.map(|s| (s / whole) as f32)).collect()
    }

    /// Adds radiance of grid points, the same towards all views, linearly interpolated.
    pub fn add_grid_points(&self, points: &[[f32; 3]], light: &mut ExitRadiance) {
        for (facet, light) in light.alike.iter_mut().enumerate() {
            for (point, share) in self.between(facet) {
                (0..3).for_each(|c| light[c] += share * f64::from(points[point][c]));
            }
        }
    }

    /// Each grid point from direction `view`: radiance, and its visible part of the view over its
    /// own cell. The mean product of both over the mean part is [`radiance_from`](Self::radiance_from), and
    /// the mean part is v_z where the field repeats. In a bounded field a grid point at an edge has
    /// half a cell; one at a corner a third where a diagonal begins or ends, else a sixth. Parts
    /// times a cell's area are the filled area of the view.
    ///
    /// # Panics
    /// Indirect light that does not cover this view.
    pub fn texels_from(&self, view: usize, light: &ExitRadiance) -> Vec<[f64; 4]> {
        let mut all = vec![[0.0; 4]; self.size[0] * self.size[1]];
        let each = 0.5 / self.times.pow(2) as f64;
        for (facet, filled) in self.shares(view) {
            let radiance = self.towards((view, filled), facet, light);
            for (point, share) in self.between(facet) {
                let part = share * filled;
                (0..3).for_each(|c| all[point][c] += part * radiance[c]);
                all[point][3] += part;
            }
        }
        for texel in &mut all {
            let whole = texel[3];
            if whole > 0.0 {
                (0..3).for_each(|c| texel[c] /= whole);
                texel[3] = whole * each * self.scales[view];
            }
        }
        all
    }

    /// [`texels_from`](Self::texels_from) for all views.
    ///
    /// # Panics
    /// Indirect light that does not cover every view.
    pub fn texels_from_all(&self, light: &ExitRadiance) -> Vec<Vec<[f64; 4]>> {
        self.of_all(|view| self.texels_from(view, light))
    }
}
