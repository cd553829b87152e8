//! Look-up in the table of wedges, as `sh_wedges` does it.

use ridgelight::basis::wedge::WedgeTable;
use std::f64::consts::FRAC_PI_2;

/// A table of wedges at two horizons: interpolates the four nearest texels bilinearly. Horizons outside the table are clamped to its edge.
pub fn look_up(table: &WedgeTable, horizon_rad: [f64; 2]) -> Vec<f64> {
    let last = table.side - 1;
    let [(row, u), (col, v)] = horizon_rad.map(|horizon| {
        let place = (horizon - table.lowest_rad) / (FRAC_PI_2 - table.lowest_rad) * last as f64;
        let node = (place.max(0.0) as usize).min(last - 1);
        (node, (place - node as f64).clamp(0.0, 1.0))
    });
    let texel = |r: usize, c: usize| &table.texels[(row + r) * table.side + col + c];
    let (near, far) = ([texel(0, 0), texel(0, 1)], [texel(1, 0), texel(1, 1)]);
    (0..near[0].len())
        .map(|i| {
            let across = |pair: [&Vec<f64>; 2]| pair[0][i] * (1.0 - v) + pair[1][i] * v;
            across(near) * (1.0 - u) + across(far) * u
        })
        .collect()
}
