//! Fitted by `cargo measure auto FOLDER --fit`, which prints this table. Each
//! part of the error is measured alone, by frames that differ in its setting only, on half of the
//! scenes of a folder; linear least squares on logarithms (ridge, see there).

use super::model::Fitted;

/// In the order of [`super::PARTS`].
#[expect(clippy::approx_constant, reason = "fitted: one is near 1/π by coincidence")]
pub(super) const FITTED: [Fitted; 4] = [
    Fitted {
        bias: 0.318,
        weights: [0.991, -0.021, 0.333, 0.107, 0.068, 0.338, 0.063, 0.429],
        power: 1.000,
        spread: 0.802,
    },
    Fitted {
        bias: -8.168,
        weights: [0.341, 1.108, 0.521, -0.152, -0.448, 0.657, 0.099, -0.247],
        power: 0.930,
        spread: 0.434,
    },
    Fitted {
        bias: -5.645,
        weights: [1.814, -2.887, 0.911, 0.710, -0.690, 1.323, 0.000, 0.000],
        power: 1.522,
        spread: 0.995,
    },
    Fitted {
        bias: -4.230,
        weights: [0.587, 0.124, 0.398, 0.384, 0.000, 0.000, 0.008, 0.000],
        power: 0.967,
        spread: 0.301,
    },
];

/// ln of the geometry's error over that of lines one cell apart with `aimed-nearest`: for 4, 2, 1,
/// 1/2, 1/4 cells, with `aimed-nearest`, with `aimed` and with `aimed-around`; all of the middle
/// 128² of each field. The last row is of a later fit than the others, on scenes with all borders.
pub(super) const GEOMETRY: [[f64; 5]; 3] = [
    [1.312, 0.598, 0.000, -0.396, -0.529],
    [1.078, 0.347, -0.389, -0.604, -0.649],
    [0.183, -0.984, -2.236, -3.098, -3.377],
];
