pub mod ellipse_fit;
pub mod facet_mask;
pub mod fan_weigh;
pub mod points_bend;
pub mod scatter_gather;
pub mod visible_points;
