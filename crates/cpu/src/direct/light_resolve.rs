//! Exit radiance of one light: its sum, clamped at 0, times its colour and the surface's albedo.

use crate::Rgb;

/// A light's sum over azimuths, one value per grid point.
#[derive(Clone, Copy, Debug)]
pub enum LightSum<'a> {
    /// `scalar_sum`.
    Scalar(&'a [f64]),
    /// `colour_sum`.
    Colour(&'a [Rgb]),
}

/// The layer of one light, row-major. `colour`: of the light, where the sum has none; includes a constant albedo.
pub fn light_resolve(sum: LightSum, colour: [f32; 3], albedo_map: Option<&[[f32; 3]]>) -> Vec<Rgb> {
    let resolve = |i: usize, light: Rgb| -> Rgb {
        std::array::from_fn(|c| {
            let albedo = albedo_map.map_or(1.0, |map| f64::from(map[i][c]));
            let shown = if light[c] < 0.0 { 0.0 } else { light[c] };
            shown * f64::from(colour[c]) * albedo
        })
    };
    match sum {
        LightSum::Scalar(s) => s.iter().enumerate().map(|(i, &l)| resolve(i, [l; 3])).collect(),
        LightSum::Colour(s) => s.iter().enumerate().map(|(i, &l)| resolve(i, l)).collect(),
    }
}

/// Adds a layer to the radiance of the lights before it.
pub fn add_to_radiance(radiance: &mut [Rgb], layer: &[Rgb]) {
    for (sum, light) in radiance.iter_mut().zip(layer) {
        for (s, l) in sum.iter_mut().zip(light) {
            *s += l;
        }
    }
}
