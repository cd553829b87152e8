//! Maps that are baked: visible points, scattered light, facets, ellipses, bent directions.
//! One file per pass, named after its shader in `shaders_glsl/bake/`.

/// Where each visible point lies on a curved base surface.
pub(crate) mod bent_directions;
/// The ellipse of directions in which the sky is visible from a grid point (HDKS00).
pub(crate) mod ellipse_fit;
/// Which flat triangles are visible from each of a set of directions above.
pub mod facet_mask;
/// The solid angle of each direction on a curved base surface.
pub(crate) mod fan_weights;
/// Paths over visible points; each step is one direction for the whole field (method of dependent tests, HDKS00).
pub(crate) mod scatter_gather;
/// The grid point that is visible from each grid point in each of a set of directions (HDKS00).
pub(crate) mod visible_points;
