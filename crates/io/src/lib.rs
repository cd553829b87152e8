//! Readers and writers: height fields, environments, albedo maps in; EXR, PNG, NPY, KTX2, JSON and text out.
//!
//! A wrong input is one sentence that names the file, the place in it, what was found and what
//! was expected ([`Error::File`](ridgelight::Error::File)). An output is complete or absent: it is
//! written beside its destination under a temporary name and renamed when it is whole.
//!
//! What a header claims is held against the size of the file before memory is asked for, so a
//! small file cannot make the program ask for a large buffer that the file could never fill.

#![deny(clippy::missing_errors_doc)]

mod asc;
mod atomic;
mod codes;
mod component;
mod cube;
mod environment;
mod exr;
mod geo;
mod geotiff;
mod hdr;
mod heights;
mod hgt;
mod ktx2;
mod lobe;
mod npy;
mod npz;
mod open;
mod planes;
mod png;
mod room;
mod size;
mod tif;
mod visible;

pub use atomic::{
    ResultFolder, Written, abandon_unfinished, check_writable, write_json, write_text,
};
pub use codes::write_codes_aside;
pub use component::Component;
pub use environment::{parse_environment, read_albedo, read_environment};
pub use exr::{Channels, Layer, read_metadata, write_exr, write_exr_aside};
pub use heights::{HeightOptions, parse_heights, read_heights};
pub use ktx2::{Ktx2Writer, TexelFormat};
pub use lobe::read_lobes;
pub use npy::{NpyWriter, write_npy_f32, write_npy_heights};
pub use planes::{Planes, parse_planes, read_planes};
pub use png::{encode_png, write_png};
pub use room::check_room;
pub use size::height_size;
pub use visible::{read_visible_points, write_visible_points};
