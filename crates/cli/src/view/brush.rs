//! Brushes that change heights.

use ridgelight::Result;
use ridgelight::plan::Rectangle;
use ridgelight::scene::HeightField;

/// A brush's effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Raise,
    Lower,
    /// Slopes above [`TALUS_DEG`] slide.
    Erode,
}

/// A round brush with a soft rim.
#[derive(Clone, Copy, Debug)]
pub struct Brush {
    pub radius_m: f64,
    /// For a dab's centre: the share of the radius by which heights rise or fall, (0..1]; for
    /// erosion, ten times the share of the excess height that moves, limited for stability.
    pub strength: f64,
}

/// Talus angle of loose ground.
const TALUS_DEG: f64 = 30.0;

/// Iterations of erosion per dab.
const ROUNDS: u32 = 8;

/// Share of the excess height that crosses one of a texel's eight edges. All eight together move
/// half of it, so that no texel falls below its neighbour.
const RATE: f64 = 1.0 / 16.0;

impl Brush {
    /// Changes heights around a place. Returns the changed rectangle; none where the brush reaches
    /// no texel.
    pub fn dab(
        &self,
        field: &mut HeightField,
        action: Action,
        [x, y]: [f64; 2],
    ) -> Result<Option<Rectangle>> {
        let [cell_x, cell_y] = field.cell_m();
        let middle = [x / cell_x, (field.rows() - 1) as f64 - y / cell_y];
        let reach = [self.radius_m / cell_x, self.radius_m / cell_y];
        let sides = [field.cols(), field.rows()];
        let [(col, last_col), (row, last_row)] = [0, 1].map(|i| {
            let first = (middle[i] - reach[i]).ceil().max(0.0);
            (first, (middle[i] + reach[i]).floor().min((sides[i] - 1) as f64))
        });
        if last_col < col || last_row < row {
            return Ok(None);
        }
        let [col, row, last_col, last_row] = [col, row, last_col, last_row].map(|v| v as usize);
        let (cols, rows) = (last_col - col + 1, last_row - row + 1);
        let place = |i: usize| [col + i % cols, row + i / cols];
        let index = |i: usize| {
            let [c, r] = place(i);
            r * sides[0] + c
        };
        let weight = |i: usize| {
            let off = [0, 1].map(|k| (place(i)[k] as f64 - middle[k]) / reach[k]);
            let near = (1.0 - off[0] * off[0] - off[1] * off[1]).max(0.0);
            if field.voids().is_some_and(|v| v[index(i)]) { 0.0 } else { near * near }
        };
        let weights: Vec<f64> = (0..cols * rows).map(weight).collect();
        let mut heights: Vec<f64> =
            (0..cols * rows).map(|i| f64::from(field.heights_m()[index(i)])).collect();
        let lift_m = self.strength * self.radius_m;
        match action {
            Action::Raise => heights.iter_mut().zip(&weights).for_each(|(h, w)| *h += lift_m * w),
            Action::Lower => heights.iter_mut().zip(&weights).for_each(|(h, w)| *h -= lift_m * w),
            Action::Erode => {
                let rate = RATE * (10.0 * self.strength).min(1.0);
                (0..ROUNDS)
                    .for_each(|_| erode(&mut heights, &weights, cols, [cell_x, cell_y], rate));
            }
        }
        let new: Vec<f32> = heights.iter().map(|h| *h as f32).collect();
        field.replace([row, col], cols, &new)?;
        let [col, row, cols, rows] = [col, row, cols, rows].map(|v| v as u32);
        Ok(Some(Rectangle { col, row, cols, rows }))
    }
}

/// One iteration of thermal erosion (after Musgrave, Kolb & Mace 1989): each edge steeper than the
/// talus moves a share of the excess height down. The sum of heights is constant but for rounding.
fn erode(heights: &mut [f64], weights: &[f64], cols: usize, [x, y]: [f64; 2], rate: f64) {
    let talus = TALUS_DEG.to_radians().tan();
    let mut change = vec![0.0; heights.len()];
    let steps = [(1, 0, x), (0, 1, y), (1, 1, x.hypot(y)), (-1, 1, x.hypot(y))];
    for i in 0..heights.len() {
        for (right, down, length) in steps {
            let col = (i % cols) as isize + right;
            let j = i as isize + down * cols as isize + right;
            if col < 0 || col >= cols as isize || j >= heights.len() as isize {
                continue;
            }
            let j = j as usize;
            let drop = heights[i] - heights[j];
            let excess = drop.abs() - talus * length;
            if excess > 0.0 {
                let moved = rate * weights[i].min(weights[j]) * excess * drop.signum();
                change[i] -= moved;
                change[j] += moved;
            }
        }
    }
    heights.iter_mut().zip(&change).for_each(|(h, c)| *h += c);
}

/// The smallest rectangle that contains both; if one is `None`, the other.
pub fn together(a: Option<Rectangle>, b: Option<Rectangle>) -> Option<Rectangle> {
    let (Some(a), Some(b)) = (a, b) else { return a.or(b) };
    let (col, row) = (a.col.min(b.col), a.row.min(b.row));
    let end = |a: (u32, u32), b: (u32, u32)| (a.0 + a.1).max(b.0 + b.1);
    let cols = end((a.col, a.cols), (b.col, b.cols)) - col;
    let rows = end((a.row, a.rows), (b.row, b.rows)) - row;
    Some(Rectangle { col, row, cols, rows })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(height: impl Fn(f64, f64) -> f64) -> HeightField {
        let heights: Vec<f64> =
            (0..31 * 33).map(|i| height((i % 33) as f64 - 16.0, (i / 33) as f64 - 15.0)).collect();
        HeightField::new(31, 33, &heights, [1.0, 1.0], None).unwrap()
    }

    fn sum(field: &HeightField) -> f64 {
        field.heights_m().iter().map(|h| f64::from(*h)).sum()
    }

    const BRUSH: Brush = Brush { radius_m: 12.0, strength: 0.1 };

    /// Each height is rounded to f32 once per dab: by at most half a unit in the last place, 2^-24
    /// of it.
    #[test]
    fn erosion_keeps_the_sum_and_flattens_steep_slopes() {
        let mut field = field(|x, y| (20.0 - 2.0 * x.hypot(y)).max(0.0) + (3.0 * x).sin());
        let steepest = |f: &HeightField| {
            let at = |c: usize| f64::from(f.heights_m()[15 * 33 + c]);
            (10..22).map(|c| (at(c + 1) - at(c)).abs()).fold(0.0, f64::max)
        };
        let (before, steep) = (sum(&field), steepest(&field));
        let largest = field.heights_m().iter().fold(0.0_f32, |l, h| l.max(h.abs()));
        let dabs = 60;
        for _ in 0..dabs {
            BRUSH.dab(&mut field, Action::Erode, [16.0, 15.0]).unwrap().unwrap();
        }
        let within = f64::from(dabs) * 31.0 * 33.0 * f64::from(largest) * 2_f64.powi(-24);
        assert!((sum(&field) - before).abs() <= within, "{} of {before}", sum(&field));
        assert!(steepest(&field) < steep / 2.0, "{} of {steep}", steepest(&field));
    }

    /// No edge is steeper than the talus: slopes of 0.5 along the steepest direction, tan 30° being
    /// 0.577.
    #[test]
    fn erosion_leaves_gentle_ground_as_it_is() {
        let mut field = field(|x, y| 0.3 * x + 0.4 * y);
        let before = field.clone();
        BRUSH.dab(&mut field, Action::Erode, [16.0, 15.0]).unwrap().unwrap();
        assert!(field == before);
    }

    /// The centre rises by a tenth of the radius, nothing beyond the rim; lowering restores the
    /// heights to within a rounding of each.
    #[test]
    fn what_is_raised_is_lowered_again() {
        let mut field = field(|_, _| 7.0);
        let before = field.clone();
        let at = BRUSH.dab(&mut field, Action::Raise, [16.0, 15.0]).unwrap().unwrap();
        assert_eq!(at, Rectangle { col: 4, row: 3, cols: 25, rows: 25 });
        assert!((field.heights_m()[15 * 33 + 16] - 1.2).abs() < 1e-6);
        assert_eq!(field.heights_m()[3 * 33 + 4], 0.0);
        BRUSH.dab(&mut field, Action::Lower, [16.0, 15.0]).unwrap();
        let off = |(a, b): (&f32, &f32)| (a - b).abs();
        let pairs = field.heights_m().iter().zip(before.heights_m());
        assert!(pairs.map(off).fold(0.0, f32::max) <= 1.2 * 2_f32.powi(-23));
        assert_eq!(BRUSH.dab(&mut field, Action::Raise, [-20.0, 15.0]).unwrap(), None);
    }

    #[test]
    fn the_rectangle_of_two_holds_both() {
        let a = Some(Rectangle { col: 3, row: 4, cols: 2, rows: 9 });
        let b = Some(Rectangle { col: 1, row: 6, cols: 10, rows: 2 });
        assert_eq!(together(a, b), Some(Rectangle { col: 1, row: 4, cols: 10, rows: 9 }));
        assert_eq!((together(a, None), together(None, b)), (a, b));
    }
}
