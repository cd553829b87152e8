//! Exit radiance and height of every grid point, side by side.

use crate::Rgb;

/// R, G, B and the height of every grid point.
pub fn bounce_ground(exit: &[Rgb], heights_m: &[f32]) -> Vec<[f64; 4]> {
    let both = exit.iter().zip(heights_m);
    both.map(|([r, g, b], height)| [*r, *g, *b, f64::from(*height)]).collect()
}
