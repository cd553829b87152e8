//! What is lit and by what: plain data, range-checked.
//!
//! A [`Scene`] is a [`HeightField`], a [`Surface`] and [`Lights`]; a [`Quality`] says what speed is traded against
//! accuracy with; a [`Camera`] where a picture is seen from. What a type can check alone it checks when it is made
//! (heights that are no numbers, an environment of odd size); what depends on other parts (a map of as many samples
//! as the field has, an elevation of a sun) where a plan is made of it ([`plan::picture`](crate::plan::picture())).
//! Either way the error names the field, what was found and what was expected.
//!
//! ```
//! use ridgelight::scene::{Albedo, Border, HeightField, Lights, Scene, Surface};
//!
//! // Two rows of three samples, 10 m from column to column, 20 m from row to row, the north first.
//! let heights_m = [5.0, 6.0, 7.0, 5.0, 5.5, 6.0];
//! let field = HeightField::new(2, 3, &heights_m, [10.0, 20.0], None)?;
//! let surface = Surface {
//!     albedo: Albedo::Constant([0.4, 0.35, 0.3]), // share of light that is reflected, linear RGB
//!     border: Border::Open,                       // nothing lies beyond the edge
//!     ..Surface::default()
//! };
//! let lights = Lights { sky: Some([0.2, 0.3, 0.6]), ..Lights::default() }; // radiance, linear RGB
//! let scene = Scene { field, surface, lights };
//! assert_eq!(scene.field.rows(), 2);
//!
//! // What cannot be is refused by name.
//! let error = HeightField::new(2, 3, &heights_m, [10.0, 0.0], None).unwrap_err();
//! assert!(error.to_string().starts_with("cell size: found 10 × 0"));
//! # Ok::<(), ridgelight::Error>(())
//! ```
//!
//! What only the device knows is planned as [`HeightField::unknown`], [`Environment::unknown`],
//! [`Albedo::unknown`].

mod bend;
mod bounces;
mod camera;
mod curvature;
mod directions;
mod environment;
mod field;
mod finer;
mod fractal;
mod hash;
mod key;
mod key_harmonics;
mod lights;
mod normal;
mod quality;
mod scatter;
mod surface;
mod tone;
mod visible;

pub use bend::{Fans, MOST_TURN, REACH_CELLS, bent_as_far, bent_direction};
pub use bounces::{BounceEngine, BounceGloss, Bounces};
pub(crate) use camera::corners;
pub use camera::{Camera, Lens};
pub use curvature::{Changed, Curvature};
pub use directions::{Directions, least_radius};
pub use environment::Environment;
pub use field::{HeightField, fill_voids};
pub use fractal::fractal;
pub use key::KeyLight;
pub use lights::{Lights, POINT_DIAMETER_RAD, SphereLight, Sun};
pub use normal::normal;
pub use quality::{
    Basis, Fuse, Hull, Levels, LightBasis, Lines, Method, Precision, Quality, Receiver, Wedges,
    Window,
};
pub use scatter::Scatter;
pub(crate) use scatter::check_view;
pub use surface::{Albedo, Border, Lobe, Phong, Surface};
pub use tone::{Tone, picture_tone};
pub use visible::{LOST_RAY, VisiblePoint, VisiblePoints};

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
