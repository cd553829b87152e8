pub(crate) mod ellipse_fit;
pub mod facet_mask;
pub(crate) mod fan_weigh;
pub(crate) mod points_bend;
pub(crate) mod scatter_gather;
pub(crate) mod visible_points;
