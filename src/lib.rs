//! Ridgelight lights height fields that change every frame.
//!
//! Data flows one way: a [`scene`] (field, surface, lights) and a quality become a pure plan, the
//! plan becomes commands in a command buffer, and the commands leave images and timings behind.

pub mod bake;
pub mod basis;
pub mod cpu;
mod error;
pub mod files;
pub mod golden;
pub mod gpu;
pub mod measure;
mod passes;
pub mod plan;
pub mod scene;

pub use error::Error;

/// What every fallible call of this crate returns.
pub type Result<T> = std::result::Result<T, Error>;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
