//! Plans of maps: visible points, visible triangles, ellipses of horizons, scattered light.

mod bend;
mod ellipses;
mod facet_mask;
pub(crate) mod scatter;
mod visible_points;

pub use ellipses::{curved_ellipses, ellipses};
pub use facet_mask::facet_mask;
pub use scatter::{scatter, scatter_inputs, scatter_views, views_at_once};
pub use visible_points::visible_points;
