//! For every step of every line of an azimuth, the earlier step of that line with the steepest slope (Timonen &
//! Westerholm 2010, algorithm 1): an upper hull kept as a stack, O(1) amortised.
//!
//! The shader's variants differ only in their hull storage; here it is a vector.

use crate::lattice::Lattice;
use crate::shared::sweep::{CELL_SHIFT, Heights, March, NO_SLOPE, on_field, wrapped};
use half::f16;
use ridgelight::plan::azimuths::{Azimuth, CELL};

/// The settings of a sweep, as the shader's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepOptions {
    /// Lines are 2^line_shift / 32768 cells apart: 13 (a quarter of a cell) to 17 (four cells).
    pub line_shift: u32,
    /// Steps marched before the first that is written: whole periods, or 0.
    pub warm_up: i32,
    /// Hull entries as f16 height, times this, and u16 step.
    pub packed: Option<f32>,
    /// Slopes written as f16.
    pub slopes_f16: bool,
}

impl Default for SweepOptions {
    /// A line a cell, nothing packed.
    fn default() -> Self {
        Self { line_shift: CELL_SHIFT, warm_up: 0, packed: None, slopes_f16: false }
    }
}

/// Scale that brings the largest |height| to 1, for packed entries.
pub fn height_scale(heights: &[f32]) -> f32 {
    let largest = heights.iter().fold(0.0_f32, |m, h| m.max(h.abs()));
    if largest > 0.0 { 1.0 / largest } else { 1.0 }
}

/// The nearest number that f16 holds; 0 below its smallest normal number, which drivers may take for 0.
fn nearest_f16(x: f32) -> f32 {
    if x.abs() < f16::MIN_POSITIVE.to_f32() { 0.0 } else { f16::from_f32(x).to_f32() }
}

/// A height after packing.
pub(crate) fn stored(h: f32, packed: Option<f32>) -> f32 {
    packed.map_or(h, |scale| nearest_f16(h * scale) / scale)
}

/// Pops vertices (height, step) while the deeper one subtends at least the slope of the newer one from height `h` at
/// step `x`.
pub(crate) fn pop_hidden(hull: &mut Vec<(f32, f32)>, h: f32, x: f32) {
    while let [.., under, top] = hull[..] {
        if (under.0 - h) * (x - top.1) < (top.0 - h) * (x - under.1) {
            break;
        }
        hull.pop();
    }
}

/// Sweeps one azimuth into its layer of its march axis's lattice: `occluders` and `slopes`.
pub fn horizon_sweep(
    heights: Heights,
    azimuth: &Azimuth,
    options: &SweepOptions,
    lattice: &mut Lattice,
) {
    let march = March::new(heights, azimuth);
    let (lanes, steps, periodic) = (march.lanes, march.steps, march.periodic());
    let line_shift = options.line_shift;
    let total = options.warm_up + steps;
    let shear = azimuth.shear;
    let spacing = 1_i32 << line_shift;
    let lead = if periodic { 0 } else { ((total - 1) * shear + spacing - 1) >> line_shift };
    let width = if periodic { lanes * CELL - 1 } else { (lanes - 1) * CELL };
    let line_count = (width >> line_shift) + 1 + lead;
    let mut hull: Vec<(f32, f32)> = Vec::new();
    for line in 0..line_count {
        let mut y = (line - lead) * spacing;
        hull.clear();
        for step in 0..total {
            if periodic || on_field(y, lanes) {
                let h = march.line_height(y, step);
                let x = step as f32;
                pop_hidden(&mut hull, h, x);
                if step >= options.warm_up {
                    let slots = lattice.width as i32;
                    let slot = y >> line_shift;
                    let texel = lattice.texel(
                        if periodic { wrapped(slot, slots) } else { slot },
                        march.march_position(if periodic { step % steps } else { step }),
                        azimuth.layer,
                    );
                    let (back, met) = hull.last().map_or((0, NO_SLOPE), |top| {
                        (step - top.1 as i32, (top.0 - h) / ((x - top.1) * azimuth.step_m))
                    });
                    lattice.occluders[texel] = back as u16;
                    lattice.slopes[texel] = if options.slopes_f16 {
                        f16::from_f32(met.clamp(-65504.0, 65504.0)).to_f32()
                    } else {
                        met
                    };
                }
                hull.push((stored(h, options.packed), x));
            }
            y += shear;
        }
    }
}
