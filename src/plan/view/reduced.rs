use crate::scene::HeightField;

/// Largest height error of a mesh with a vertex at every `step`th grid point, metres; 0 for
/// [unknown](HeightField::unknown) heights.
///
/// Both surfaces are linear between crossings of their edges, so the largest error is at a crossing. Edges of the reduced
/// mesh lie on the field's own, except for the diagonals of cells that the last row or column cuts short: these are
/// tested where they cross the field's edges.
pub fn mesh_error_m(field: &HeightField, step: u32) -> f64 {
    let step = step.max(1) as usize;
    let (rows, cols) = (field.rows(), field.cols());
    let mut worst = 0.0_f64;
    for north in (0..rows.saturating_sub(1)).step_by(step) {
        for west in (0..cols.saturating_sub(1)).step_by(step) {
            let size = [step.min(rows - 1 - north), step.min(cols - 1 - west)];
            let cell = Cell { field, north, west, size };
            worst = worst.max(cell.error_m());
        }
    }
    worst
}

/// A cell of the reduced mesh.
struct Cell<'a> {
    field: &'a HeightField,
    north: usize,
    west: usize,
    /// Rows and columns.
    size: [usize; 2],
}

impl Cell<'_> {
    fn error_m(&self) -> f64 {
        let [down, right] = self.size;
        if down == 1 && right == 1 {
            return 0.0;
        }
        let places = (0..=down).flat_map(|r| (0..=right).map(move |c| [r as f64, c as f64]));
        let at_grid_points = places.map(|place| self.difference_m(place)).fold(0.0, f64::max);
        if down == right {
            return at_grid_points;
        }
        // Crossings of rows, columns and diagonals with this cell's own diagonal, as shares of it.
        let share = |k: usize, n: usize| k as f64 / n as f64;
        let of_rows = (1..down).map(|k| share(k, down));
        let of_cols = (1..right).map(|k| share(k, right));
        let of_diagonals = (1..down.abs_diff(right)).map(|k| share(k, down.abs_diff(right)));
        let crossings = of_rows.chain(of_cols).chain(of_diagonals);
        let along = crossings.map(|t| self.difference_m([t * down as f64, t * right as f64]));
        along.fold(at_grid_points, f64::max)
    }

    /// Height difference of the two surfaces at rows and columns from the cell's north-western corner.
    fn difference_m(&self, [r, c]: [f64; 2]) -> f64 {
        let own = self.height_m([0, 0], self.size, [r, c]);
        let floor = |v: f64, n: usize| (v.floor() as usize).min(n - 1);
        let cell = [floor(r, self.size[0]), floor(c, self.size[1])];
        let finest = self.height_m(cell, [1, 1], [r - cell[0] as f64, c - cell[1] as f64]);
        (own - finest).abs()
    }

    /// Height on the two triangles over `size` grid points from a corner.
    fn height_m(&self, [r, c]: [usize; 2], [down, right]: [usize; 2], place: [f64; 2]) -> f64 {
        let h = |r: usize, c: usize| {
            let at = (self.north + r) * self.field.cols() + self.west + c;
            f64::from(self.field.heights_m()[at])
        };
        let [y, x] = [place[0] / down as f64, place[1] / right as f64];
        let (nw, se) = (h(r, c), h(r + down, c + right));
        if y > x {
            let sw = h(r + down, c);
            nw + y * (sw - nw) + x * (se - sw)
        } else {
            let ne = h(r, c + right);
            nw + x * (ne - nw) + y * (se - ne)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(rows: usize, cols: usize, height: impl Fn(usize, usize) -> f64) -> HeightField {
        let heights: Vec<f64> = (0..rows * cols).map(|i| height(i / cols, i % cols)).collect();
        HeightField::new(rows, cols, &heights, [1.0; 2], None).unwrap()
    }

    #[test]
    fn planes_and_the_full_mesh_have_no_error() {
        let plane = field(6, 8, |r, c| 2.0 * r as f64 - c as f64);
        let rough = field(6, 8, |r, c| ((r * 5 + c * 3) % 7) as f64);
        assert_eq!(mesh_error_m(&rough, 1), 0.0);
        for step in [2, 3, 4, 16] {
            // Heights are whole numbers, interpolated ones are not.
            assert!(mesh_error_m(&plane, step) < 1e-14, "{step}");
            assert!(mesh_error_m(&rough, step) > 0.5, "{step}");
        }
    }

    /// The reduced mesh misses a single grid point of height 1 without a vertex.
    #[test]
    fn a_spike_between_vertices_is_an_error() {
        let spike = field(5, 5, |r, c| if (r, c) == (1, 2) { 1.0 } else { 0.0 });
        assert_eq!(mesh_error_m(&spike, 2), 1.0);
        let on_a_vertex = field(5, 5, |r, c| if (r, c) == (2, 2) { 1.0 } else { 0.0 });
        // Halfway along an edge from the vertex the surface is at 0, the reduced one at 1/2.
        assert_eq!(mesh_error_m(&on_a_vertex, 2), 0.5);
    }

    /// A cell of 1 × 2: its diagonal crosses the field's column and no grid point. Heights are 0 in the north and 1 in the
    /// south except for its middle. At the crossing, (1/2, 1), the diagonal is at 1/2, the field's column at 0; at the
    /// southern grid point the diagonal mesh is at 1 and the field at 0.
    #[test]
    fn cells_cut_short_are_tested_along_their_diagonal() {
        let cell = field(2, 3, |r, c| if r == 1 && c != 1 { 1.0 } else { 0.0 });
        assert_eq!(mesh_error_m(&cell, 2), 1.0);
        // Here all grid points agree with their triangles, and only the diagonal differs: a saddle. In the lower triangle
        // (0,0), (1,0), (1,2) lies (1,1), in the upper (0,0), (0,2), (1,2) lies (0,1).
        let heights = [0.0, 1.0, 2.0, 0.0, 2.0, 4.0];
        let saddle = HeightField::new(2, 3, &heights, [1.0; 2], None).unwrap();
        // At (1/2, 1): 2 on the own diagonal, (1 + 2) / 2 on the field's column.
        assert_eq!(mesh_error_m(&saddle, 2), 0.5);
    }
}
