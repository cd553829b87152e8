//! The cheapest settings that hold an error, or the most accurate within a time. Pure but for the
//! oracle on the processor: the caller draws, and traces bounced light, [`Probes`] judge, [`Chooser`] says what to draw
//! next; [`choose`] is all three.
//!
//! [`Statistics`] of the scene give a first guess of each part of the error ([`Model`]); every frame
//! that is measured corrects the guess, and the costs.

mod bounced;
mod candidates;
mod chooser;
mod fitted;
mod model;
mod probes;
mod statistics;
#[cfg(test)]
mod tests;
mod walk;

pub use chooser::{Chooser, Goal, Trial};
pub use model::{Costs, Expected, FEATURES, Model, PARTS, Part};
pub use probes::{Measured, Probes, Traced, apart};
pub use statistics::Statistics;
pub use walk::{Bounced, Chosen, Drawn, Trace, choose, flags};
