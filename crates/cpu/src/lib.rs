//! CPU references of the GPU passes, the ground truth that both are tested against, and the tolerances between them.
//!
//! The CPU reference of a pass has its shader's name and structure: `shaders_glsl/ROOM/NAME.comp` and `cpu::NAME`.
//! Geometry (sweeps, fusing) repeats the shader's f32 operations in its order, so a driver that fuses no operations
//! gives equal bits. Light is summed in f64 and compared within a [`tolerance`].
//!
//! [`path_trace`] follows the same random paths as its shader and carries the f32 error bound of every value along.
//! The ground truth is independent of the shaders: [`oracle`] tests every triangle by brute force, [`indirect`]
//! computes direct and indirect light by quadrature, without Monte Carlo noise.
//!
//! Functions panic where arguments do not fit together: a grid point outside its field, levels or lattices that lack
//! texels, a series whose length is not a square. Their own pages name only other panics.

#![deny(clippy::missing_errors_doc)]

mod bake;
pub mod basis;
mod bounce;
mod device;
mod direct;
mod edit;
mod horizon;
mod rays;
mod reference;
mod sh;
pub mod shared;
mod specular;
pub mod tolerance;
mod view;

/// Linear red, green and blue.
pub type Rgb = [f64; 3];

pub use bake::*;
pub use bounce::*;
pub use device::*;
pub use direct::*;
pub use edit::*;
pub use horizon::*;
pub use rays::*;
pub use reference::*;
pub use sh::*;
pub use specular::*;
pub use view::*;
