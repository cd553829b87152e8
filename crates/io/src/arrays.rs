//! Arrays of NumPy, alone or in an archive, and what is stored as such: planes of values, visible points.

pub(crate) mod npy;
pub(crate) mod npz;
pub(crate) mod planes;
mod visible_points;

pub use npy::{NpyWriter, write_npy_f32, write_npy_heights};
pub use planes::{Planes, parse_planes, read_planes};
pub use visible_points::{read_visible_points, write_visible_points};
