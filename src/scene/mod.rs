//! What is lit and by what: plain data, range-checked when it is made.

mod bounces;
mod camera;
mod directions;
mod environment;
mod field;
mod hash;
mod key;
mod lights;
mod quality;
mod scatter;
mod surface;
mod visible;

pub use bounces::{BounceEngine, BounceGloss, Bounces};
pub(crate) use camera::corners;
pub use camera::{Camera, Lens};
pub use directions::Directions;
pub use environment::Environment;
pub use field::HeightField;
pub use key::KeyLight;
pub use lights::{Lights, POINT_DIAMETER_RAD, SphereLight, Sun};
pub use quality::{
    Basis, Fuse, Hull, Levels, LightBasis, Lines, Method, Precision, Quality, Receiver, Wedges,
    Window,
};
pub use scatter::Scatter;
pub use surface::{Albedo, Border, Lobe, Phong, Surface};
pub use visible::{VisiblePoint, VisiblePoints};

/// A field, what it is made of, and the light that falls on it.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The heights.
    pub field: HeightField,
    /// Reflectance and what lies beyond the field's edge.
    pub surface: Surface,
    /// Everything that shines.
    pub lights: Lights,
}
