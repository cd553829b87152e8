//! Numbers found by `cargo run --release --example auto -- FOLDER --fit`, which prints this table: each
//! part of the error measured alone, by frames that differ in its setting only, on half of the scenes
//! of a folder; linear least squares on logarithms (ridge, see there).

use super::model::Fitted;

/// In the order of [`super::PARTS`].
pub(super) const FITTED: [Fitted; 4] = [
    Fitted {
        bias: -1.105,
        weights: [0.972, 0.315, 0.224, -0.436, 0.126, 0.354, 0.036, 0.397],
        power: 1.0,
        spread: 0.64,
    },
    Fitted {
        bias: -8.569,
        weights: [0.753, 1.317, -1.026, -0.697, -0.767, 2.052, 0.176, -0.371],
        power: 0.862,
        spread: 0.966,
    },
    Fitted {
        bias: -8.079,
        weights: [1.346, -0.872, 0.266, -0.497, -1.529, 3.1, 0.0, 0.0],
        power: 1.464,
        spread: 1.334,
    },
    Fitted {
        bias: -5.08,
        weights: [0.689, 0.46, -0.034, -0.355, 0.0, 0.0, -0.003, 0.0],
        power: 0.905,
        spread: 0.213,
    },
];

/// ln of the geometry's error beside that of lines one cell apart with `aimed-nearest`: for 4, 2, 1,
/// 1/2, 1/4 cells, with `aimed-nearest`, with `aimed` and with `aimed-around`; the last of the middle
/// 96² of each field, all else of 256².
pub(super) const GEOMETRY: [[f64; 5]; 3] = [
    [1.38, 0.699, 0.0, -0.323, -0.504],
    [1.179, 0.427, -0.315, -0.589, -0.625],
    [-0.604, -2.221, -3.813, -4.474, -4.686],
];
