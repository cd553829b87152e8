//! Waves that travel over a field.

use std::f64::consts::TAU;

use ridgelight::Result;
use ridgelight::scene::HeightField;

/// Seconds that pass from frame to frame.
const FRAME_S: f64 = 1.0 / 30.0;

/// Each by its direction (counter-clockwise from east), waves across the field's shorter side, share of the height,
/// and waves that pass a place in a second.
const WAVES: [(f64, f64, f64, f64); 3] =
    [(0.4, 4.0, 0.5, 0.45), (1.9, 7.0, 0.3, 0.6), (3.6, 11.0, 0.2, 0.8)];

/// A field with waves on it.
pub struct Waves {
    still: HeightField,
    /// Of all together, metres.
    height_m: f64,
    frames: u32,
}

impl Waves {
    /// An eighth of the field's relief high, a fortieth of its side where that is more.
    pub fn over(still: HeightField) -> Self {
        let heights = || still.heights_m().iter().copied();
        let (low, high) =
            (heights().fold(f32::INFINITY, f32::min), heights().fold(f32::NEG_INFINITY, f32::max));
        let height_m = (f64::from(high - low) / 8.0).max(side_m(&still) / 40.0);
        Self { still, height_m, frames: 0 }
    }

    /// The field a frame later.
    pub fn next(&mut self) -> Result<HeightField> {
        self.frames += 1;
        let seconds = f64::from(self.frames) * FRAME_S;
        let field = &self.still;
        let (cols, [cell_x, cell_y]) = (field.cols(), field.cell_m());
        let side = side_m(field);
        let height = |i: usize, still: f32| {
            let place = [(i % cols) as f64 * cell_x, -((i / cols) as f64) * cell_y];
            let wave = |&(towards, count, share, passing): &(f64, f64, f64, f64)| {
                let along = place[0] * towards.cos() + place[1] * towards.sin();
                share * (TAU * (along * count / side - passing * seconds)).sin()
            };
            let waves: f64 = WAVES.iter().map(wave).sum();
            field.base_m() + f64::from(still) + waves * self.height_m / 2.0
        };
        let all: Vec<f64> =
            field.heights_m().iter().enumerate().map(|(i, z)| height(i, *z)).collect();
        let voids = field.voids().map(<[bool]>::to_vec);
        HeightField::new(field.rows(), cols, &all, field.cell_m(), voids)
    }

    /// The field as it was.
    pub fn end(self) -> HeightField {
        self.still
    }
}

fn side_m(field: &HeightField) -> f64 {
    let [x, y] = field.cell_m();
    (field.cols() as f64 * x).min(field.rows() as f64 * y)
}
