//! How far results are off, in numbers and to the eye, and how far they may be.
//!
//! - [`error`]: root mean square, mean shift, 99th percentile and worst texel with its place, of light and of horizons;
//! - [`flip`]: ꟻLIP, how far two pictures are apart to an eye;
//! - [`tolerance`]: by how much each pass may differ from its CPU twin, as formulas with their reasons;
//! - [`statistics`]: median, percentiles of times and of errors;
//! - [`fractal`]: fixed fractal fields, which benchmarks are of;
//! - [`auto`] and [`trade`]: settings for an error or a time asked for, and the frontier between them;
//! - [`scalar_sweep`], [`soft_ball`], [`harmonics`]: rivals and closed forms that others are measured beside.

pub mod auto;
pub mod error;
pub mod flip;
pub mod fractal;
pub mod harmonics;
pub mod scalar_sweep;
pub mod soft_ball;
pub mod statistics;
pub mod tolerance;
pub mod trade;
