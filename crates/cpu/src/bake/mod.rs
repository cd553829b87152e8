pub mod bent_directions;
pub mod ellipse_fit;
pub mod facet_mask;
pub mod fan_weights;
pub mod scatter_gather;
pub mod visible_points;
