//! What directions on a curved base stand for among the others (Heidrich et al. 2000, §5, figure 8), in f64.
//!
//! Directions that were even on the flat field are no longer so: a path along one of them counts as much as the triangles
//! around it have grown. Triangles that have folded over count below 0, as they cover what others cover, too; the sum over
//! all directions stays that of the sphere.

use glam::DVec3;

use crate::bent_directions::Fans;
use ridgelight::basis::triangles::area_sr;

/// Solid angle of a direction's triangles over that on the flat field, 0 or more; 1 of a direction without any.
pub fn weight(fans: &Fans, bent: &[DVec3], i: usize) -> f64 {
    let triangles = fans.pairs[i].iter();
    let sum: f64 = triangles
        .map(|pair| area_sr([bent[i], bent[pair[0] as usize], bent[pair[1] as usize]]))
        .sum();
    if fans.flat_sr[i] > 0.0 { (sum / fans.flat_sr[i]).max(0.0) } else { 1.0 }
}
