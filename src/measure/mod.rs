//! Error metrics and statistics.

pub mod auto;
pub mod error;
pub mod facets;
pub mod flip;
pub mod fractal;
pub mod harmonics;
pub mod scalar_sweep;
pub mod soft_ball;
pub mod statistics;
pub mod tolerance;
pub mod trade;
