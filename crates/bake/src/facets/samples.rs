//! What triangles and the samples of the field, between which they lie, have of each other.

use super::{ExitRadiance, Facets, corners_of};

impl Facets {
    /// The samples of the field, not the finer one, that a triangle lies between, and their shares of it.
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

    /// Exit radiance of samples that leaves as much as that of triangles: the mean over the slopes that each stands for.
    pub fn to_samples(&self, radiance: &[[f64; 3]]) -> Vec<[f32; 3]> {
        let mut sums = vec![([0.0; 3], 0.0); self.size[0] * self.size[1]];
        for (facet, light) in radiance.iter().enumerate() {
            let area = self.area(facet);
            for (sample, share) in self.between(facet) {
                let (sum, whole) = &mut sums[sample];
                (0..3).for_each(|c| sum[c] += share * area * light[c]);
                *whole += share * area;
            }
        }
        sums.into_iter().map(|(sum, whole)| sum.map(|s| (s / whole) as f32)).collect()
    }

    /// Adds radiance of samples, the same towards all views, linear between them.
    pub fn add_samples(&self, samples: &[[f32; 3]], light: &mut ExitRadiance) {
        for (facet, light) in light.alike.iter_mut().enumerate() {
            for (sample, share) in self.between(facet) {
                (0..3).for_each(|c| light[c] += share * f64::from(samples[sample][c]));
            }
        }
    }

    /// Of each sample as direction `view` shows it: radiance, and the share of the view that it fills over its own cell, masking
    /// counted. The mean over all samples of their product over that of the shares is [`seen_from`](Self::seen_from), and the
    /// shares' mean is v_z where the field repeats. One that ends has half a cell of the samples at its edges, and of those at
    /// its corners a third where a diagonal begins or ends, else a sixth: shares times a cell's area are the area of the view
    /// that is filled.
    ///
    /// # Panics
    /// Where light is not scattered towards that.
    pub fn texels_from(&self, view: usize, light: &ExitRadiance) -> Vec<[f64; 4]> {
        let mut all = vec![[0.0; 4]; self.size[0] * self.size[1]];
        let each = 0.5 / self.times.pow(2) as f64;
        for (facet, filled) in self.shares(view) {
            let radiance = self.towards((view, filled), facet, light);
            for (sample, share) in self.between(facet) {
                let part = share * filled;
                (0..3).for_each(|c| all[sample][c] += part * radiance[c]);
                all[sample][3] += part;
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

    /// The same of all views.
    ///
    /// # Panics
    /// Where light is not scattered towards one of them.
    pub fn texels_from_all(&self, light: &ExitRadiance) -> Vec<Vec<[f64; 4]>> {
        self.of_all(|view| self.texels_from(view, light))
    }
}
