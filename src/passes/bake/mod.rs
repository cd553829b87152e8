pub(crate) mod bent_directions;
pub(crate) mod ellipse_fit;
pub mod facet_mask;
pub(crate) mod fan_weights;
pub(crate) mod scatter_gather;
pub(crate) mod visible_points;
