//! Error metrics, and the search for settings.
//!
//! - [`error`]: root mean square, mean shift, 99th percentile and worst texel, of radiance and of
//!   horizons;
//! - [`flip`]: ꟻLIP, the perceived difference of two pictures;
//! - [`statistics`]: median and percentiles of times and of errors;
//! - [`auto`]: settings for a given error or time, chosen while rendering;
//! - [`trade`]: the frontier of speed and accuracy.

#![deny(clippy::missing_errors_doc)]

pub mod auto;
pub mod error;
pub mod flip;
pub mod statistics;
pub mod trade;
