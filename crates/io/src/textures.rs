//! Textures that GPUs read: KTX2 and DDS files, their texels and blocks.

mod blocks;
mod component;
mod dds;
mod ktx2;

pub use blocks::Block;
pub use component::Component;
pub use dds::DdsWriter;
pub use ktx2::{Ktx2Writer, TexelFormat, Texels};
