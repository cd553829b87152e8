//! Arrays of NumPy, alone or in an archive, and planes of values.

pub(crate) mod npy;
pub(crate) mod npz;
pub(crate) mod planes;

pub use npy::{NpyWriter, write_npy_f32, write_npy_heights};
pub use planes::{Planes, parse_planes, read_georeference, read_planes};
