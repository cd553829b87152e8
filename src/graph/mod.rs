//! Building blocks of plans: shaders, resources, passes, limits.

mod builder;
mod limits;
mod pass;
mod place_barriers;
mod reach;
mod resource;
pub mod shaders;

pub(crate) use builder::{Builder, Part};
pub(crate) use limits::{GPU_LOOKUPS, MOST_TURNS, bytes_text};
pub use limits::{Limits, SweepForm};
pub use pass::{Pass, ResourceId};
pub use place_barriers::missing_barriers;
pub(crate) use place_barriers::{moved_earlier, place_barriers};
pub(crate) use reach::GROUP_LINES;
pub use reach::{Axis, CELL, Reach, Rectangle};
pub use resource::{Format, Kind, Owner, Resource};
