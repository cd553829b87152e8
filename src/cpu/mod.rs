//! The twins of the GPU passes in f64, and the brute-force truth they are all judged by.

pub mod light;
pub mod oracle;
