//! Readers and writers: height fields, environments, albedo maps in; GeoTIFF, EXR, PNG, NPY, KTX2, DDS, JSON
//! and text out.
//!
//! Error messages name the file, the place in it, what was found and what was expected
//! ([`Error::File`](ridgelight::Error::File)). An output is complete or absent: it is written
//! beside its destination under a temporary name and renamed when it is complete.
//!
//! Header claims are checked against the file's size before memory is allocated, so a small file
//! cannot make the program allocate a large buffer.

#![deny(clippy::missing_errors_doc)]

mod arrays;
mod atomic;
mod environment;
mod exr;
mod georeference;
mod geotiff;
mod heights;
mod open;
mod png;
mod textures;

pub use arrays::{
    NpyWriter, Planes, parse_planes, read_georeference, read_planes, write_npy_f32,
    write_npy_heights,
};
pub use atomic::{
    ResultFolder, Written, abandon_unfinished, check_room, check_writable, write_json, write_text,
};
pub use environment::{parse_environment, read_albedo, read_environment, read_specular};
pub use exr::{Channels, Layer, read_metadata, write_exr, write_exr_aside};
pub use georeference::{GeoKeys, Georeference};
pub use geotiff::{Band, GeoTiffWriter, write_geotiff};
pub use heights::size::height_size;
pub use heights::{
    FieldFile, HeightOptions, StoredHeights, parse_heights, read_field, read_heights, read_mosaic,
};
pub use open::bytes_read;
pub use png::{encode_png, write_codes_aside, write_png};
pub use textures::{Block, Component, DdsWriter, Ktx2Writer, TexelFormat, Texels};
