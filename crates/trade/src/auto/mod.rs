//! The fastest settings within an error (`--max-error`), or the most accurate within a time (`--time-budget`).
//!
//! Pure except for the oracle, which computes on threads of its own. The caller renders and traces bounced light, [`Probes`]
//! measure errors, [`Chooser`] selects what to render next; [`choose`] combines all three.
//! [`Statistics`] of the scene give a first guess of each part of the error ([`Model`]); every
//! measured frame corrects it, and the costs.

mod bounced;
mod candidates;
mod chooser;
mod fitted;
mod model;
mod oracle_light;
mod picks;
mod probes;
mod residuals;
mod search;
mod statistics;
#[cfg(test)]
mod tests;

pub use crate::trade::Goal;
pub use chooser::{Chooser, Trial};
pub use model::{Costs, Expected, FEATURES, Model, PARTS, Part};
pub use oracle_light::{OracleThreads, Pause};
pub use probes::{Measured, Probes, Traced, unsampled_bounce_error, unsure};
pub use search::{Bounced, Chosen, Drawn, Trace, choose, flags};
pub use statistics::Statistics;
