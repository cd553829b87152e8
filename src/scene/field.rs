pub(super) mod finer;
pub(super) mod fractal;
pub(super) mod hash;
pub(super) mod normal;
pub(super) mod voids;

use super::Border;
use crate::{Error, Result};
use voids::fill;

/// Largest magnitude of a height, in the field's length unit: products of a height difference and a distance stay far
/// below the largest f32.
const HEIGHT_LIMIT: f64 = 1e15;
/// Largest slope: height difference over cell size.
const STEEPEST: f64 = 1e18;

/// A grid of heights: row-major, row 0 in the north, column 0 in the west.
///
/// Grid point (r, c) lies at x = c·cell x, y = (rows-1-r)·cell y. Heights are f32 offsets from a base, the median, that
/// is subtracted in f64, so a centimetre survives on an 8 848 m summit. The surface between grid points is two flat
/// triangles per cell, split from (r, c) to (r+1, c+1).
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    rows: usize,
    cols: usize,
    cell_m: [f64; 2],
    base_m: f64,
    heights_m: Vec<f32>,
    voids: Option<Vec<bool>>,
    is_unknown: bool,
}

impl HeightField {
    /// A field of `rows`×`cols` heights, each within ±1e15, in metres or the unit of `cell_m`: row after row, row 0 in the
    /// north, column 0 in the west.
    ///
    /// `cell_m` is the spacing of columns and of rows, each [1e-12..1e12]. `voids`, one mark per grid point, marks heights
    /// without data: their values are ignored and filled from the heights around them.
    ///
    /// # Errors
    /// Sizes that are 0 or do not match; cells that are not positive and finite; a height outside voids that is not finite
    /// or beyond ±1e15, named by row and column; a field of voids only.
    pub fn new(
        rows: usize,
        cols: usize,
        heights_m: &[f64],
        cell_m: [f64; 2],
        voids: Option<Vec<bool>>,
    ) -> Result<Self> {
        if rows == 0 || cols == 0 || rows.checked_mul(cols) != Some(heights_m.len()) {
            return Err(Error::setting(
                "heights",
                format!("{} values for {rows} rows and {cols} columns", heights_m.len()),
                "rows × columns values, at least one",
            ));
        }
        if !cell_m.iter().all(|c| c.is_finite() && *c >= 1e-12 && *c <= 1e12) {
            return Err(Error::setting(
                "cell size",
                format!("{} × {}", cell_m[0], cell_m[1]),
                "two lengths from 1e-12 to 1e12",
            ));
        }
        if voids.as_ref().is_some_and(|v| v.len() != heights_m.len()) {
            return Err(Error::setting(
                "voids",
                format!("{} marks", voids.map_or(0, |v| v.len())),
                format!("{} marks, one per grid point", heights_m.len()),
            ));
        }
        let voids = voids.filter(|v| v.contains(&true));
        let is_void = |i: usize| voids.as_ref().is_some_and(|v| v[i]);
        let mut known = Vec::with_capacity(heights_m.len());
        for (i, &h) in heights_m.iter().enumerate() {
            if is_void(i) {
                continue;
            }
            if !h.is_finite() || h.abs() > HEIGHT_LIMIT {
                return Err(Error::setting(
                    format!("height at row {}, column {}", i / cols, i % cols),
                    format!("{h:?}"),
                    "a finite number within ±1e15, or one marked as no-data (`nodata`)",
                ));
            }
            known.push(h);
        }
        if known.is_empty() {
            return Err(Error::setting("heights", "nothing but no-data", "at least one height"));
        }
        let middle = known.len() / 2;
        let base_m = *known.select_nth_unstable_by(middle, f64::total_cmp).1;
        let mut offsets: Vec<f32> = heights_m.iter().map(|h| (h - base_m) as f32).collect();
        let (low, high) =
            known.iter().fold((f64::MAX, f64::MIN), |(l, h), k| (l.min(*k), h.max(*k)));
        let steepest = (high - low) / cell_m[0].min(cell_m[1]);
        if steepest > STEEPEST {
            return Err(Error::setting(
                "cell size",
                format!("{} × {} for heights of {low} to {high}", cell_m[0], cell_m[1]),
                "slopes up to 1e18, whose squares f32 holds",
            ));
        }
        if let Some(voids) = &voids {
            fill(rows, cols, &mut offsets, voids);
        }
        Ok(Self { rows, cols, cell_m, base_m, heights_m: offsets, voids, is_unknown: false })
    }

    /// A field whose heights only the device knows. The plan assumes level ground at height 0, so the image that the caller
    /// hands in holds the heights themselves, in the unit of `cell_m` (for 16-bit UNORM: of the whole range).
    ///
    /// The following need heights and return an error: a sweep with precision `packed`; [`plan::reference`](crate::plan::reference()),
    /// in bands or at some texels too; [`plan::visible_points`](crate::plan::visible_points()),
    /// [`plan::facet_mask`](crate::plan::facet_mask()), [`plan::ellipses`](crate::plan::ellipses()), also on curved bases, and
    /// [`plan::scatter`](crate::plan::scatter()); [`Curvature::check`](super::Curvature::check) of a base that is not flat;
    /// [`finer`](Self::finer). [`Picture::still`](crate::plan::Picture::still) omits no sweep.
    /// [`light_cutoff`](super::Quality::light_cutoff) limits sphere lights to where they would light level ground; 0 removes
    /// the limit.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn unknown(rows: usize, cols: usize, cell_m: [f64; 2]) -> Result<Self> {
        let corner = Self::new(1, 1, &[0.0], cell_m, None)?;
        let count = rows.checked_mul(cols).filter(|count| *count > 0);
        let Some(count) = count else {
            return Self::new(rows, cols, &[], cell_m, None);
        };
        // Zeros cost no time: planning a frame may make such a field.
        Ok(Self { rows, cols, heights_m: vec![0.0; count], is_unknown: true, ..corner })
    }

    /// Whether only the device knows the heights.
    pub(crate) fn is_unknown(&self) -> bool {
        self.is_unknown
    }

    /// Refuses heights that only the device knows ([`unknown`](Self::unknown)) for `name`, which needs `expected`.
    pub(crate) fn check_known(&self, name: &str, expected: &str) -> Result<()> {
        if self.is_unknown {
            return Err(Error::setting(name, "unknown heights", expected));
        }
        Ok(())
    }

    /// Number of rows (south to north extent).
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns (west to east extent).
    pub fn cols(&self) -> usize {
        self.cols
    }

    /// Spacing of columns and of rows, in metres.
    pub fn cell_m(&self) -> [f64; 2] {
        self.cell_m
    }

    /// The base height of [`heights_m`](Self::heights_m), in metres: the median of the heights at construction.
    pub fn base_m(&self) -> f64 {
        self.base_m
    }

    /// Heights above [`base_m`](Self::base_m), row-major from the north-west corner; voids filled.
    pub fn heights_m(&self) -> &[f32] {
        &self.heights_m
    }

    /// Replaces the heights of a rectangle, given above the same base in rows of `cols`, from a row and a column on. All
    /// other heights keep their bits; voids stay voids.
    ///
    /// # Errors
    /// A rectangle beyond the field; the first height that is NaN or so steep that squared slopes exceed f32.
    pub fn replace(
        &mut self,
        [row, col]: [usize; 2],
        cols: usize,
        heights_m: &[f32],
    ) -> Result<()> {
        let rows = heights_m.len().checked_div(cols).unwrap_or(0);
        let fits = |from: usize, count: usize, all: usize| {
            count > 0 && from.checked_add(count).is_some_and(|end| end <= all)
        };
        let is_whole = rows * cols == heights_m.len();
        if !(is_whole && fits(row, rows, self.rows) && fits(col, cols, self.cols)) {
            return Err(Error::setting(
                "heights",
                format!("{} in rows of {cols}, from row {row}, column {col}", heights_m.len()),
                format!("whole rows within {} × {}", self.cols, self.rows),
            ));
        }
        // With any other accepted height, slopes stay within twice the steepest.
        let most = (STEEPEST * self.cell_m[0].min(self.cell_m[1])).min(HEIGHT_LIMIT);
        let is_one = |h: &f32| f64::from(h.abs()) <= most;
        if let Some(i) = heights_m.iter().position(|h| !is_one(h)) {
            return Err(Error::setting(
                format!("height at row {}, column {}", row + i / cols, col + i % cols),
                format!("{:?}", heights_m[i]),
                format!("a number within ±{most:e} of the base"),
            ));
        }
        for (r, new) in heights_m.chunks_exact(cols).enumerate() {
            let from = (row + r) * self.cols + col;
            self.heights_m[from..from + cols].copy_from_slice(new);
        }
        Ok(())
    }

    /// One mark per grid point, true where the input had no data; `None` without voids.
    pub fn voids(&self) -> Option<&[bool]> {
        self.voids.as_deref()
    }

    /// Whether no edge between two triangles of the surface is a valley. Then no point of the field rises above the plane
    /// of any triangle, and the horizon of a grid point along an azimuth is the slope of its triangle. A `periodic` field is
    /// concave only where it is level. Unknown heights may have valleys.
    ///
    /// An edge and the two vertices across it form a parallelogram on the map. The edge is not a valley if the sum of its
    /// ends is at least the sum of those two, whatever the cell size.
    pub(crate) fn is_concave(&self, border: Border) -> bool {
        if self.is_unknown {
            return false;
        }
        let (rows, cols) = (self.rows, self.cols);
        let h = |r: usize, c: usize| f64::from(self.heights_m[r * cols + c]);
        if border == Border::Periodic {
            return self.heights_m.iter().all(|height| *height == self.heights_m[0]);
        }
        // A field one grid point wide is a line.
        if rows == 1 || cols == 1 {
            let heights = &self.heights_m;
            return heights
                .windows(3)
                .all(|w| 2.0 * f64::from(w[1]) >= f64::from(w[0]) + f64::from(w[2]));
        }
        let no_valley =
            |ends: [f64; 2], across: [f64; 2]| ends[0] + ends[1] >= across[0] + across[1];
        (0..rows).all(|r| {
            (0..cols).all(|c| {
                let along_row = r == 0
                    || r + 1 == rows
                    || c + 1 == cols
                    || no_valley([h(r, c), h(r, c + 1)], [h(r - 1, c), h(r + 1, c + 1)]);
                let along_col = c == 0
                    || c + 1 == cols
                    || r + 1 == rows
                    || no_valley([h(r, c), h(r + 1, c)], [h(r, c - 1), h(r + 1, c + 1)]);
                let diagonal = r + 1 == rows
                    || c + 1 == cols
                    || no_valley([h(r, c), h(r + 1, c + 1)], [h(r, c + 1), h(r + 1, c)]);
                along_row && along_col && diagonal
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f32_offsets_keep_a_centimetre_on_a_summit() {
        let field = HeightField::new(1, 3, &[8848.00, 8848.01, 8848.02], [1.0, 1.0], None).unwrap();
        assert_eq!(field.base_m(), 8848.01);
        for (h, expected) in field.heights_m().iter().zip([-0.01, 0.0, 0.01]) {
            // One rounding of 8848 in f64 (1.8e-12) and one of 0.01 in f32.
            assert!((f64::from(*h) - expected).abs() < 2e-9);
        }
    }

    #[test]
    fn an_error_names_row_and_column_of_a_bad_height() {
        let error =
            HeightField::new(2, 2, &[0.0, 1.0, f64::NAN, 3.0], [1.0, 1.0], None).unwrap_err();
        assert!(error.to_string().contains("row 1, column 0"), "{error}");
        let voids = Some(vec![false, false, true, false]);
        assert!(HeightField::new(2, 2, &[0.0, 1.0, f64::NAN, 3.0], [1.0, 1.0], voids).is_ok());
    }

    #[test]
    fn replace_writes_a_rectangle_or_names_the_bad_height() {
        let mut field = HeightField::new(3, 3, &[5.0; 9], [1.0, 1.0], None).unwrap();
        field.replace([1, 1], 2, &[1.0, 2.0, 3.0, 4.0]).unwrap();
        assert_eq!(field.base_m(), 5.0);
        assert_eq!(field.heights_m(), [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 3.0, 4.0]);
        let message = field.replace([2, 1], 2, &[1.0, f32::NAN]).unwrap_err().to_string();
        assert!(message.contains("row 2, column 2"), "{message}");
        for (at, cols, count) in [([2, 2], 2, 2), ([0, 0], 2, 3), ([0, 0], 0, 0), ([3, 0], 1, 1)] {
            assert!(field.replace(at, cols, &vec![0.0; count]).is_err(), "{at:?} {cols} {count}");
        }
        assert_eq!(field.heights_m()[8], 4.0);
    }

    fn field(
        rows: usize,
        cols: usize,
        cell_m: [f64; 2],
        height: impl Fn(usize, usize) -> f64,
    ) -> HeightField {
        let heights: Vec<f64> = (0..rows * cols).map(|i| height(i / cols, i % cols)).collect();
        HeightField::new(rows, cols, &heights, cell_m, None).unwrap()
    }

    /// A valley along any of the three families of edges is one.
    #[test]
    fn valleys_stay_in_the_plan() {
        let level = |_: usize, _: usize| 0.0;
        assert!(field(5, 5, [1.0, 3.0], level).is_concave(Border::Plane));
        // A dent of one texel, and creases along rows, columns and diagonals.
        let dents: [fn(usize, usize) -> f64; 4] = [
            |r, c| f64::from(u8::from((r, c) != (2, 2))),
            |r, _| (r as f64 - 2.0).abs(),
            |_, c| (c as f64 - 2.0).abs(),
            |r, c| (r as f64 - c as f64).abs(),
        ];
        for (i, dent) in dents.into_iter().enumerate() {
            assert!(!field(5, 5, [1.0, 3.0], dent).is_concave(Border::Plane), "{i}");
            assert!(
                field(5, 5, [1.0, 3.0], |r, c| -dent(r, c)).is_concave(Border::Plane) == (i > 0)
            );
        }
        assert!(field(1, 4, [1.0, 1.0], |_, c| -((c * c) as f64)).is_concave(Border::Open));
        assert!(!field(4, 1, [1.0, 1.0], |r, _| (r * r) as f64).is_concave(Border::Open));
        assert!(!field(5, 5, [1.0, 1.0], |r, _| r as f64).is_concave(Border::Periodic));
    }
}
