//! The scene: plain data with checked ranges.
//!
//! A [`Scene`] is a [`HeightField`], a [`Surface`] and [`Lights`]. [`Quality`] trades speed for accuracy. A [`Camera`]
//! defines a view. A constructor checks what its type can check alone, such as finite heights or the size of an
//! environment. The planner ([`plan::picture`](crate::plan::picture())) checks what depends on other parts, such as the
//! size of a map or the elevation of a sun. Each error names the field, the value found and the value expected.
//!
//! ```
//! use ridgelight::scene::{Albedo, Border, HeightField, Lights, Scene, Surface};
//!
//! // Two rows of three grid points, 10 m between columns, 20 m between rows, north first.
//! let heights_m = [5.0, 6.0, 7.0, 5.0, 5.5, 6.0];
//! let field = HeightField::new(2, 3, &heights_m, [10.0, 20.0], None)?;
//! let surface = Surface {
//!     albedo: Albedo::Constant([0.4, 0.35, 0.3]), // diffuse reflectance, linear RGB
//!     border: Border::Open,                       // nothing lies beyond the edge
//!     ..Surface::default()
//! };
//! let lights = Lights { sky: Some([0.2, 0.3, 0.6]), ..Lights::default() }; // radiance, linear RGB
//! let scene = Scene { field, surface, lights };
//! assert_eq!(scene.field.rows(), 2);
//!
//! // Errors name the field and the value.
//! let error = HeightField::new(2, 3, &heights_m, [10.0, 0.0], None).unwrap_err();
//! assert!(error.to_string().starts_with("cell size: found 10 × 0"));
//! # Ok::<(), ridgelight::Error>(())
//! ```
//!
//! Inputs that only the device knows are planned as [`HeightField::unknown`], [`Environment::unknown`],
//! [`Albedo::unknown`] and [`Specular::unknown`].

mod bend;
mod camera;
mod choices;
mod curvature;
mod directions;
mod environment;
mod field;
mod lights;
mod quality;
mod scatter;
mod settings;
mod surface;
mod tone;
pub(crate) mod visible;

pub use bend::{Fans, MAX_TURN_RAD, REACH_CELLS, bent_direction, bent_direction_within};
pub(crate) use camera::corners;
pub use camera::{Camera, Lens};
pub use choices::{
    Basis, BounceEngine, BounceSpecular, Fuse, Hull, Levels, LightBasis, Lines, Method, Precision,
    Receiver, Wedges, Window,
};
pub use curvature::{Curvature, OcclusionChange};
pub use directions::{Directions, least_radius};
pub use environment::Environment;
pub use field::HeightField;
pub use field::fractal::fractal;
pub use field::normal::normal;
pub use field::voids::fill_voids;
pub use lights::key::KeyLight;
pub use lights::*;
pub use quality::{Bounces, Quality, SETTINGS, setting};
pub use scatter::Scatter;
pub(crate) use scatter::check_view;
pub use settings::{Audience, Setting, Values, Word};
pub use surface::{Albedo, Border, Normals, PhongSpecular, Specular, Surface};
pub use tone::Tone;
pub use visible::{LOST_RAY, VisiblePoint, VisiblePoints};

/// A height field, its surface and the lights.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The heights.
    pub field: HeightField,
    /// Reflectance, and the border of the field.
    pub surface: Surface,
    /// All light sources.
    pub lights: Lights,
}
