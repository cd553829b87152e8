//! Ridgelight computes the light on height fields that may change every frame: sky, environment, suns, key lights, sphere
//! lights and bounces, with shadows from horizons. It appends Vulkan compute passes to a command buffer.
//!
//! Data flows one way: a [`scene`] (field, surface, lights) and a [`Quality`](scene::Quality) become a pure [`plan`].
//! [`gpu`] records the plan as commands, which write images and timings.
//!
//! # From nothing to a lit texture
//!
//! You need a Vulkan 1.1 driver (a software driver such as lavapipe is enough) and, to build, a C++ compiler for the
//! shader compiler. In `Cargo.toml`:
//!
//! ```toml
//! [dependencies]
//! ridgelight = { path = "../ridgelight" }
//! ```
//!
//! and in `src/main.rs` (`cargo run --example first_light` runs it; a test does too):
//!
#![doc = concat!("```no_run\n", include_str!("../examples/first_light.rs"), "```")]
//!
//! [`HeightField`](scene::HeightField) checks the heights and stores them as `f32` offsets from their
//! [median](scene::HeightField::base_m), so 8848 m ± 1 cm survive. [`Lights`](scene::Lights) are linear radiance and
//! irradiance. An error names the value out of range and the expected one, at the latest in [`plan::picture`].
//! [`plan::picture`] decides everything: which passes run, how large each image is, how much memory that takes. Print it
//! (`println!("{plan}")`) for the reasons. [`Headless`](gpu::Headless) owns a device for tools and tests;
//! [`draw`](gpu::Headless::draw) also returns the GPU time of each pass.
//!
//! # In an engine
//!
//! An engine has its own device, images and command buffers. [`gpu::Renderer`] borrows the device ([`gpu::Host`]) and
//! creates all resources of the plan once. Afterwards it only appends commands: it neither submits, waits nor allocates
//! on the device. Handles are those of `ash = "0.38"`.
//!
//! ```no_run
//! use ash::vk;
//! use ridgelight::gpu::{self, Host, ImageArg, Renderer};
//! use ridgelight::plan::{self, Picture};
//! use ridgelight::scene::{Quality, Scene};
//!
//! fn prepare(host: &Host, scene: &Scene) -> ridgelight::Result<Renderer> {
//!     let limits = gpu::limits(&host.instance, host.physical_device);
//!     let plan = plan::picture(scene, &Quality::for_scene(scene, None), &limits, Picture::default())?;
//!     Renderer::new(host, plan, 2) // two frames in flight
//! }
//!
//! fn each_frame(
//!     renderer: &mut Renderer,
//!     (commands, slot): (vk::CommandBuffer, usize),
//!     heights: ImageArg, // with its current state
//!     light: ImageArg,   // with its current state and the one to leave it in
//! ) -> ridgelight::Result<()> {
//!     renderer.record(commands, slot, &[heights], &[light])
//! }
//! ```
//!
//! [`gpu::requirements`] lists what the device needs. [`gpu`] has a section each on states, formats, queue
//! families, buffers instead of images, and lights that change from frame to frame. Complete programs:
//! `examples/ash_host.rs` with ash, `hosts/ridgelight-wgpu` with wgpu, `hosts/bevy_ridgelight` with Bevy, and `crates/capi/tests/c/host.c` in C with
//! `crates/capi/include/ridgelight.h`.
//!
//! # Modules and crates
//!
//! | module | contents |
//! |---|---|
//! | [`scene`] | fields, surfaces, lights, cameras, quality: plain data with checked ranges |
//! | [`basis`] | Legendre polynomials, spherical harmonics, quadrature |
//! | [`plan`] | from scene and quality to passes, images, bytes and reasons, without a device |
//! | [`gpu`] | records plans into command buffers; headless device; camera views |
//!
//! Other crates: `ridgelight-cpu` (CPU references of all passes, the f64 oracle, tolerances),
//! `ridgelight-io` (file formats), `ridgelight-bake` (maps for engines), `ridgelight-trade` (error metrics and the
//! search for settings), `ridgelight-testing` (golden images), `ridgelight-viewer` (windows), `ridgelight-cli` (the
//! program) and `ridgelight-capi` (the C ABI).
//!
//! # Conventions
//!
//! Right-handed; x east = increasing column, y north = decreasing row, z up. Grid point (row, column) lies at
//! x = column · cell\[0\], y = (rows − 1 − row) · cell\[1\]. Azimuths are radians counter-clockwise from east (the command
//! line takes compass degrees), elevations radians above horizontal. Heights and cells are in one unit of length. Radiance
//! is linear; level ground of albedo 1 under a sky of radiance 1 has exit radiance 1. The surface is two flat triangles
//! per cell, split from (r, c) to (r + 1, c + 1).
//!
//! # Errors and features
//!
//! Every fallible call returns [`Result`]. Each [`Error`] is one sentence that names the file or field, the place, what
//! was found and what was expected. [`scene`], [`plan`] and [`gpu`] never panic on a caller's input; [`basis`] is
//! mathematics and documents its panics.
//!
//! Feature `shaderc`: compiles the shaders with shaderc instead of glslang.

// For the library only: examples and programs document errors in their help.
#![deny(clippy::missing_errors_doc)]

pub mod basis;
mod error;
pub mod gpu;
mod graph;
mod passes;
pub mod plan;
pub mod scene;

pub use error::Error;

/// Result of every fallible call of this crate.
pub type Result<T> = std::result::Result<T, Error>;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
