//! Weights of directions on a curved base surface (Heidrich et al. 2000, §5, figure 8), in f64.
//!
//! Directions that are uniform on the flat field are not uniform on the curved one: a path along a direction is
//! weighted by the growth of the triangles around it. Folded triangles count negative, as they overlap others; the
//! sum over all directions stays that of the sphere.

use crate::bent_directions::Fans;
use glam::DVec3;

/// Solid angle of a direction's triangles over that on the flat field, 0 or more; 1 for a direction without any.
pub fn weight(fans: &Fans, bent: &[DVec3], i: usize) -> f64 {
    let triangles = fans.pairs[i].iter();
    let sum: f64 = triangles
        .map(|pair| area_sr([bent[i], bent[pair[0] as usize], bent[pair[1] as usize]]))
        .sum();
    if fans.flat_sr[i] > 0.0 { (sum / fans.flat_sr[i]).max(0.0) } else { 1.0 }
}

/// Solid angle of a spherical triangle, sr; negative if clockwise (Van Oosterom & Strackee 1983).
pub fn area_sr([a, b, c]: [DVec3; 3]) -> f64 {
    2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
