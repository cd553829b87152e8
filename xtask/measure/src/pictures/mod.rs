//! Pictures of the documentation.

pub mod bleed;
pub mod picture;
pub mod terrain;
pub mod town;
