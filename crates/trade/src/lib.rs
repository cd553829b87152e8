//! How far results are off, in numbers and to the eye, and how far they may be.
//!
//! - [`error`]: root mean square, mean shift, 99th percentile and worst texel with its place, of light and of horizons;
//! - [`flip`]: ꟻLIP, how far two pictures are apart to an eye;
//! - [`statistics`]: median, percentiles of times and of errors;
//! - [`auto`] and [`trade`]: settings for an error or a time asked for, and the frontier between them;

#![deny(clippy::missing_errors_doc)]

pub mod auto;
pub mod error;
pub mod flip;
pub mod statistics;
pub mod trade;
