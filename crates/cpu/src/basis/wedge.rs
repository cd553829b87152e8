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

/// Bound on the error of [`look_up`] against [`wedge`](ridgelight::basis::wedge::wedge) in a coefficient of band `l`.
///
/// With spacing h, linear interpolation of each of the two horizons errs by h²/8 of the second
/// derivative. The wedge is ∫ Φ_m G((1-t) ω_a + t ω_b) dφ with G' = -Θ_lm cos ω, so that derivative
/// is ∫ Φ_m t² G'' dφ: Δφ/3 · max|Φ_m| · max|G''|. Θ_lm cos ω is a trigonometric polynomial of degree
/// l+1 that does not pass max|Θ_lm|, so by Bernstein |G''| ≤ (l+1) max|Θ_lm|; and by the addition
/// theorem max|Θ_lm| max|Φ_m| ≤ √((2l+1)/4π).
pub fn look_up_error(table: &WedgeTable, l: usize) -> f64 {
    let spacing = (FRAC_PI_2 - table.lowest_rad) / (table.side - 1) as f64;
    let steepest = (l + 1) as f64 * ((2 * l + 1) as f64 / (4.0 * std::f64::consts::PI)).sqrt();
    spacing * spacing / 8.0 * 2.0 * table.width_rad / 3.0 * steepest
}
