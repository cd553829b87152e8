//! Light of a sun or a narrow key light by exact horizons: what `shadow_shade` and `shadow_settle` give together.

use super::sun_shade::{sun_at, vector_at};
use crate::horizon_march::{MarchOptions, horizon_march};
use crate::lattice::{Lattices, number_layers};
use crate::shared::gather::Swept;
use crate::shared::sweep::Heights;
use glam::DVec3;
use ridgelight::plan::azimuths::{Azimuth, Shape};

/// Exit radiance of every grid point of albedo 1, row-major, as [`sun_at`], and its light vector; none where a point sun is within `slope_error`
/// of the ground. `warm_up`: steps marched before the field's own, along columns and along rows.
pub fn settled(
    heights: Heights,
    azimuths: &[Azimuth],
    warm_up: [i32; 2],
    (shape, slope_error): (Shape, f64),
) -> Vec<Option<(f64, DVec3)>> {
    let mut azimuths = azimuths.to_vec();
    number_layers(&mut azimuths);
    let mut lattices = Lattices::new(&azimuths, [heights.cols, heights.rows], 15, heights.border);
    for azimuth in &azimuths {
        let warm_up = warm_up[usize::from(azimuth.marches_rows())];
        let options = MarchOptions { all_crossings: true, warm_up };
        horizon_march(heights, azimuth, options, lattices.of_mut(azimuth));
    }
    let (azimuths, lattices) = (azimuths.as_slice(), &lattices);
    let swept = Swept { heights, azimuths, lattices, fuse: None, line_shift: 15, warm_up };
    swept.per_grid_point(|col, row| {
        let mut grazes = false;
        swept.add_all([col, row], true, |_, azimuth, lowest, _| {
            let off = lowest - f64::from(azimuth.high_slope);
            grazes |= shape == Shape::Point && off.abs() <= slope_error;
        });
        (!grazes).then(|| (sun_at(&swept, shape, col, row), vector_at(&swept, col, row)))
    })
}
