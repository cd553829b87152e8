//! Exit radiance of one light: its sum, clamped at 0, times its colour and the surface's albedo.

use crate::Rgb;

/// The layer of one light, row-major, from its sums over azimuths (`scalar_sum` in each channel, or `colour_sum`).
/// `colour`: of the light, where the sum has none; includes a constant albedo.
pub fn light_resolve(
    sum: impl IntoIterator<Item = Rgb>,
    colour: [f32; 3],
    albedo_map: Option<&[[f32; 3]]>,
) -> Vec<Rgb> {
    let resolve = |(i, light): (usize, Rgb)| {
        [0, 1, 2].map(|c| {
            let albedo = albedo_map.map_or(1.0, |map| f64::from(map[i][c]));
            let shown = if light[c] < 0.0 { 0.0 } else { light[c] };
            shown * f64::from(colour[c]) * albedo
        })
    };
    sum.into_iter().enumerate().map(resolve).collect()
}

/// Adds a layer to the radiance of the lights before it.
pub fn add_to_radiance(radiance: &mut [Rgb], layer: &[Rgb]) {
    for (sum, light) in radiance.iter_mut().zip(layer) {
        for (s, l) in sum.iter_mut().zip(light) {
            *s += l;
        }
    }
}
