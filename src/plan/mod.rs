//! Scene and quality to passes: pure, without a Vulkan call.

pub mod azimuths;
