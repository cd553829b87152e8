//! Ground truth in f64: the brute-force [`oracle`], quadratures of direct and indirect light,
//! and the CPU reference of the `path_trace` pass.

pub mod indirect;
pub mod light;
pub mod lit;
pub(crate) mod maxima;
pub mod oracle;
pub mod path_trace;
pub(crate) mod phong_integral;
pub mod profile;
pub mod sphere;
