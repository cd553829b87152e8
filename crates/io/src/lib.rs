//! Readers and writers: height fields, environments, albedo maps in; EXR, PNG, NPY, KTX2, JSON and text out.
//!
//! Error messages name the file, the place in it, what was found and what was expected
//! ([`Error::File`](ridgelight::Error::File)). An output is complete or absent: it is written
//! beside its destination under a temporary name and renamed when it is complete.
//!
//! Header claims are checked against the file's size before memory is allocated, so a small file
//! cannot make the program allocate a large buffer.

#![deny(clippy::missing_errors_doc)]

mod environment;
mod exr;
mod heights;
mod npy;
mod npz;
mod open;
mod planes;
mod png;
mod specular;
mod visible_points;
mod write;

pub use environment::{parse_environment, read_albedo, read_environment};
pub use exr::{Channels, Layer, read_metadata, write_exr, write_exr_aside};
pub use heights::size::height_size;
pub use heights::{HeightOptions, parse_heights, read_heights};
pub use npy::{NpyWriter, write_npy_f32, write_npy_heights};
pub use planes::{Planes, parse_planes, read_planes};
pub use png::{encode_png, write_png};
pub use specular::read_specular;
pub use visible_points::{read_visible_points, write_visible_points};
pub use write::atomic::{
    ResultFolder, Written, abandon_unfinished, check_writable, write_json, write_text,
};
pub use write::codes::write_codes_aside;
pub use write::component::Component;
pub use write::ktx2::{Ktx2Writer, TexelFormat};
pub use write::room::check_room;
