//! Speed against accuracy: which settings are worth measuring next, which are on the frontier,
//! which to choose. Pure: the caller measures.

mod frontier;
mod ladders;
mod search;
#[cfg(test)]
mod tests;

pub use frontier::{Goal, Recommendation, Value, frontier, recommend};
pub use ladders::{Ladder, Place, ladders, places, refused, start, start_for};
pub(crate) use ladders::{has_no_lines, has_specular, have_slices};
pub use search::{Break, SLACK, Search, Side, Skip};
