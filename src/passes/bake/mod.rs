//! Maps that are baked: visible points, scattered light, facets, ellipses, bent directions.
//! One file per pass, named after its shader in `shaders_glsl/bake/`.

pub(crate) mod bent_directions;
pub(crate) mod ellipse_fit;
pub mod facet_mask;
pub(crate) mod fan_weights;
pub(crate) mod scatter_gather;
pub(crate) mod visible_points;
