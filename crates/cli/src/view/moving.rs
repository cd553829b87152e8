//! Waves or a ridge that travel over a field.

use std::f64::consts::TAU;

use ridgelight::Result;
use ridgelight::scene::HeightField;

/// Seconds from frame to frame.
const FRAME_S: f64 = 1.0 / 30.0;

/// Each: direction (counter-clockwise from east), waves across the field's shorter side, share of
/// the height, and waves per second at a place.
const WAVES: [(f64, f64, f64, f64); 3] =
    [(0.4, 4.0, 0.5, 0.45), (1.9, 7.0, 0.3, 0.6), (3.6, 11.0, 0.2, 0.8)];

/// A ridge: direction counter-clockwise from east; seconds from one end of the field to the other;
/// half width as a share of the field's shorter side.
const RIDGE_TOWARDS: f64 = 0.3;
const RIDGE_S: f64 = 6.0;
const RIDGE_WIDTH: f64 = 0.06;

/// The moving shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Waves,
    Ridge,
}

/// A field with a moving shape.
pub struct Moving {
    pub kind: Kind,
    /// The field without movement.
    pub still: HeightField,
    /// Height of all waves together, or of the ridge, metres.
    height_m: f64,
    frames: u32,
}

impl Moving {
    /// Waves an eighth of the field's relief high, or a fortieth of its side where that is more; a
    /// ridge twice that.
    pub fn over(still: HeightField, kind: Kind) -> Self {
        let heights = || still.heights_m().iter().copied();
        let (low, high) =
            (heights().fold(f32::INFINITY, f32::min), heights().fold(f32::NEG_INFINITY, f32::max));
        let height_m = (f64::from(high - low) / 8.0).max(side_m(&still) / 40.0);
        let height_m = if kind == Kind::Ridge { 2.0 * height_m } else { height_m };
        Self { kind, still, height_m, frames: 0 }
    }

    /// The same movement over another grid of the field.
    pub fn over_other(&self, still: HeightField) -> Self {
        Self { still, ..*self }
    }

    /// Moves on by one frame.
    pub fn step(&mut self) {
        self.frames += 1;
    }

    /// Moves to another's frame.
    pub fn follow(&mut self, other: &Self) {
        self.frames = other.frames;
    }

    /// The field at the current frame.
    pub fn field(&self) -> Result<HeightField> {
        let seconds = f64::from(self.frames) * FRAME_S;
        let field = &self.still;
        let (cols, [cell_x, cell_y]) = (field.cols(), field.cell_m());
        let rise = match self.kind {
            Kind::Waves => waves(side_m(field), seconds),
            Kind::Ridge => ridge(field, seconds),
        };
        let height = |i: usize, still: f32| {
            let place = [(i % cols) as f64 * cell_x, -((i / cols) as f64) * cell_y];
            field.base_m() + f64::from(still) + rise(place) * self.height_m
        };
        let all: Vec<f64> =
            field.heights_m().iter().enumerate().map(|(i, z)| height(i, *z)).collect();
        let voids = field.voids().map(<[bool]>::to_vec);
        HeightField::new(field.rows(), cols, &all, field.cell_m(), voids)
    }
}

/// A field's shorter side.
pub fn side_m(field: &HeightField) -> f64 {
    let [x, y] = field.cell_m();
    (field.cols() as f64 * x).min(field.rows() as f64 * y)
}

/// Waves of height 1, by the position from the north-western corner.
fn waves(side: f64, seconds: f64) -> Box<dyn Fn([f64; 2]) -> f64> {
    Box::new(move |place: [f64; 2]| {
        let wave = |&(towards, count, share, passing): &(f64, f64, f64, f64)| {
            let along = place[0] * f64::cos(towards) + place[1] * f64::sin(towards);
            share * (TAU * (along * count / side - passing * seconds)).sin()
        };
        WAVES.iter().map(wave).sum::<f64>() / 2.0
    })
}

/// The same for a ridge: a bell-shaped cross section that enters at one end and leaves at the
/// other, repeatedly.
fn ridge(field: &HeightField, seconds: f64) -> Box<dyn Fn([f64; 2]) -> f64> {
    let (sin, cos) = RIDGE_TOWARDS.sin_cos();
    let [cell_x, cell_y] = field.cell_m();
    let (length, height) = ((field.cols() - 1) as f64 * cell_x, (field.rows() - 1) as f64 * cell_y);
    let width = RIDGE_WIDTH * side_m(field);
    // Along the direction of travel the south-western corner comes first and the north-eastern
    // last.
    let (first, last) = (-height * sin - 3.0 * width, length * cos + 3.0 * width);
    let middle = first + (seconds / RIDGE_S).fract() * (last - first);
    Box::new(move |place: [f64; 2]| {
        let off = (place[0] * cos + place[1] * sin - middle) / width;
        (-0.5 * off * off).exp()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After half of the time it is halfway: on a row along x, in its middle.
    #[test]
    fn a_ridge_is_where_it_has_come_to() {
        let still = HeightField::new(1, 201, &[5.0; 201], [1.0; 2], None).unwrap();
        let mut moving = Moving::over(still.clone(), Kind::Ridge);
        let mut field = still.clone();
        for _ in 0..90 {
            moving.step();
            field = moving.field().unwrap();
        }
        let heights: Vec<f64> =
            field.heights_m().iter().map(|h| f64::from(*h) + field.base_m() - 5.0).collect();
        let highest = (0..201).max_by(|a, b| heights[*a].total_cmp(&heights[*b])).unwrap();
        assert_eq!(highest, 100, "{heights:?}");
        assert!(moving.still == still);
    }
}
