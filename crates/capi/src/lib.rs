//! Ridgelight for C: implements `include/ridgelight.h` by the library's public API.
//!
//! Every struct begins with its size, so that a struct of an older header is read as far as it goes; 0 selects
//! the default. Plans and renderers are opaque. Functions that can fail return a [`RidgelightResult`], and
//! leave a sentence for [`ridgelight_last_error`].

mod allocator;
mod errors;
mod plan;
mod quality;
mod read;
mod renderer;
mod scene;
mod types;
mod view;
mod voids;

/// The type under its C name; null is none.
#[expect(non_camel_case_types, reason = "C's name")]
type PFN_vkGetInstanceProcAddr = Option<ash::vk::PFN_vkGetInstanceProcAddr>;

pub use allocator::*;
pub use errors::*;
pub use plan::*;
pub use quality::*;
pub use renderer::*;
pub use scene::*;
pub use types::*;
pub use view::*;
pub use voids::*;
