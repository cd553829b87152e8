//! Numbers found by `cargo run --release --example auto -- FOLDER --fit`, which prints this table: each
//! part of the error measured alone, by frames that differ in its setting only, on half of the scenes
//! of a folder; linear least squares on logarithms (ridge, see there).

use super::model::Fitted;

/// In the order of [`super::PARTS`].
pub(super) const FITTED: [Fitted; 4] = [
    Fitted {
        bias: -3.9,
        weights: [0.5, 0.0, 0.0, 0.0, 0.3, 0.0, 0.5, 0.0],
        power: 1.0,
        spread: 0.6,
    },
    Fitted {
        bias: -6.0,
        weights: [0.3, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        power: 1.5,
        spread: 0.8,
    },
    Fitted {
        bias: -7.0,
        weights: [0.3, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        power: 1.5,
        spread: 0.8,
    },
    Fitted {
        bias: -5.0,
        weights: [0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        power: 1.5,
        spread: 0.8,
    },
];

/// ln of the geometry's error beside that of lines one cell apart with `aimed-nearest`: for 4, 2, 1,
/// 1/2, 1/4 cells, with `aimed-nearest` and with `aimed`.
pub(super) const GEOMETRY: [[f64; 5]; 2] =
    [[1.65, 0.8, 0.0, -0.47, -0.71], [1.26, 0.4, -0.36, -0.79, -0.8]];
