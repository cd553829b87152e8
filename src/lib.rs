//! Ridgelight lights height fields that change every frame: exact self-shadowing horizons under sky,
//! environment, suns, key lights and balls of light, and what the ground throws back, as Vulkan compute passes
//! that it appends to a command buffer.
//!
//! Data flows one way: a [`scene`] (field, surface, lights) and a [`Quality`](scene::Quality) become a pure
//! [`plan`], the plan becomes commands ([`gpu`]), and the commands leave images and timings behind.
//!
//! # From nothing to a lit texture
//!
//! A Vulkan 1.3 driver (a software one such as lavapipe does) and, to build, a C++ compiler for the shaders'
//! compiler. In `Cargo.toml`:
//!
//! ```toml
//! [dependencies]
//! ridgelight = { path = "../ridgelight" }
//! ```
//!
//! and in `src/main.rs` (`cargo run --example first_light` runs it, as a test does):
//!
#![doc = concat!("```no_run\n", include_str!("../examples/first_light.rs"), "```")]
//!
//! Line by line: a [`HeightField`](scene::HeightField) checks the heights and keeps them as `f32` offsets from
//! their [median](scene::HeightField::base_m), so that 8848 m ± 1 cm survive. [`Lights`](scene::Lights) are linear
//! radiance and irradiance. What is out of its range is refused by name, with what was expected, at the latest by
//! [`plan::picture`], which decides everything: which passes run, how large each image is, how much memory that takes;
//! print it (`println!("{plan}")`) to see why. [`Headless`](gpu::Headless) is a device of its own for tools and
//! tests; [`draw`](gpu::Headless::draw) also returns the GPU time of each pass.
//!
//! # In an engine
//!
//! An engine has its own device, images and command buffers. [`gpu::Renderer`] borrows the device
//! ([`gpu::Host`]), makes all that the plan needs once, and then only appends: no submit, no wait, nothing
//! allocated on the device. Handles are those of `ash = "0.38"`.
//!
//! ```no_run
//! use ash::vk;
//! use ridgelight::gpu::{self, Host, ImageArg, Renderer};
//! use ridgelight::plan::{self, Picture};
//! use ridgelight::scene::{Quality, Scene};
//!
//! fn prepare(host: &Host, scene: &Scene) -> ridgelight::Result<Renderer> {
//!     let limits = gpu::limits(&host.instance, host.physical_device);
//!     let plan = plan::picture(scene, &Quality::default(), &limits, Picture::default())?;
//!     Renderer::new(host, plan, 2) // two frames in flight
//! }
//!
//! fn each_frame(
//!     renderer: &mut Renderer,
//!     (commands, slot): (vk::CommandBuffer, usize),
//!     heights: ImageArg, // with the state that it comes in
//!     light: ImageArg,   // with that, and the one that it is to be left in
//! ) -> ridgelight::Result<()> {
//!     renderer.record(commands, slot, &[heights], &[light])
//! }
//! ```
//!
//! What the device must be made with, [`gpu::requirements`] says before there is one. States, formats, queue
//! families, buffers instead of images, lights that change from frame to frame: [`gpu`] has a section on each.
//! `examples/ash_host.rs` is a whole program by `ash`, `examples/wgpu` one by wgpu, `crates/capi/tests/c/host.c` one in C by
//! `crates/capi/include/ridgelight.h`.
//!
//! # Modules and crates
//!
//! | module | what it is for |
//! |---|---|
//! | [`scene`] | fields, surfaces, lights, cameras, quality: plain data with checked ranges |
//! | [`basis`] | Legendre polynomials, spherical harmonics, quadrature |
//! | [`plan`] | scene and quality to passes, images, bytes and reasons, without a device |
//! | [`gpu`] | plans recorded into command buffers; a device of its own; views from cameras |
//!
//! Crates beside this one: `ridgelight-cpu` (a CPU reference of every pass, the f64 oracle, tolerances),
//! `ridgelight-io` (file formats), `ridgelight-bake` (maps for engines), `ridgelight-trade` (error metrics and the
//! search for settings), `ridgelight-testing` (golden images), `ridgelight-viewer` (windows), `ridgelight-cli` (the
//! program) and `ridgelight-capi` (the C ABI).
//!
//! # Conventions
//!
//! Right-handed; x east = increasing column, y north = decreasing row, z up. Sample (row, column) stands at
//! x = column · cell\[0\], y = (rows − 1 − row) · cell\[1\]. Azimuths are radians counter-clockwise from east (the
//! command line takes compass degrees), elevations radians above horizontal. Heights and cells are in one unit of
//! length. Radiance is linear; level ground of albedo 1 under a sky of radiance 1 has exit radiance 1. The surface is
//! two flat triangles a cell, split from (r, c) to (r + 1, c + 1).
//!
//! # Errors and features
//!
//! Every fallible call returns [`Result`]; each [`Error`] is one sentence that names the file or field, the place,
//! what was found and what was expected. No call of [`scene`], [`plan`] and [`gpu`] panics on what a caller
//! hands in; [`basis`] is mathematics and states its panics.
//!
//! `shaderc`: shaders compiled by shaderc instead of glslang.

// Of the library alone: examples and programs tell their readers otherwise.
#![deny(clippy::missing_errors_doc)]

pub mod basis;
mod error;
pub mod gpu;
mod graph;
mod passes;
pub mod plan;
pub mod scene;

pub use error::Error;

/// What every fallible call of this crate returns.
pub type Result<T> = std::result::Result<T, Error>;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
