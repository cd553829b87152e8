//! Vulkan: device, memory, pipelines, barriers, recording, timing. All of the crate's `unsafe`.

pub mod shaders;
