//! CPU references of the passes that bake views on flat and curved base surfaces:
//! visible points, bent directions, ellipses, facet masks and scattered light.

pub mod bent_directions;
pub mod ellipse_fit;
pub mod facet_mask;
pub mod fan_weights;
pub mod scatter_gather;
pub mod visible_points;
