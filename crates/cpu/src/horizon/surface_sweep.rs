//! Exact horizons of the triangulated surface in azimuths along grid vectors (a, b). Every grid point lies on a line,
//! and the hull includes every crossing of a line with grid lines and diagonals.

use crate::lattice::Lattice;
use crate::shared::surface::{segment_crossings, surface_rise};
use crate::shared::sweep::{Heights, March, NO_SLOPE, wrapped};
use ridgelight::plan::azimuths::Azimuth;

/// Rise over `own` of the surface `u` past step `step`, for a line at lane position y (in 1/march
/// of a cell) at that step.
fn rise_over(march: &March, own: f32, y: i32, step: i32, u: f32) -> f32 {
    let whole = march.azimuth.vector_march;
    let mut cell = y.div_euclid(whole);
    let mut f = (y - cell * whole) as f32 / whole as f32
        + u * march.azimuth.vector_lane as f32 / whole as f32;
    if f > 1.0 {
        f -= 1.0;
        cell += 1;
    }
    surface_rise(march.cell_heights(cell, step), own, u, f, march.split_along())
}

/// A vertex of the hull: height, and position as whole step and fraction, so that differences of near positions stay
/// exact.
#[derive(Clone, Copy)]
struct Vertex {
    h: f32,
    step: f32,
    rest: f32,
}

/// Sweeps one azimuth: `slopes` and `distances` of its layer, one slot a lane.
///
/// # Panics
/// When the lattice is not one slot a lane, or the azimuth has no grid vector.
pub fn surface_sweep(heights: Heights, azimuth: &Azimuth, warm_up: i32, lattice: &mut Lattice) {
    let march = March::new(heights, azimuth);
    let (lanes, steps, periodic) = (march.lanes, march.steps, march.periodic());
    let (whole, shear) = (azimuth.vector_march, azimuth.vector_lane);
    assert!(whole > 0, "an azimuth along a grid vector");
    let total = warm_up + steps;
    let width = if periodic { lanes * whole - 1 } else { (lanes - 1) * whole };
    let lead = if periodic { 0 } else { (total - 1) * shear };
    let split_along = march.split_along();
    let advance = shear as f32 / whole as f32;
    let mut hull: Vec<Vertex> = Vec::new();
    for line in 0..=width + lead {
        let bounded = shear > 0 && !periodic;
        let begin = if bounded { ((lead - line + shear - 1) / shear).max(0) } else { 0 };
        let end = if bounded { total.min((width - (line - lead)) / shear + 1) } else { total };
        hull.clear();
        for step in begin..end {
            let y = line - lead + step * shear;
            // The segment that ends here, from its crossings to the step itself.
            let y0 = y - shear;
            let f0 = y0.rem_euclid(whole) as f32 / whole as f32;
            let [a, b, c] = segment_crossings(f0, advance, split_along);
            for (place, u) in [a, b, c, 1.0].into_iter().enumerate() {
                // Off the field: before the first step, or before the line entered across the first
                // lane.
                let outside = !periodic && y0 as f32 + u * (shear as f32) < -1e-3;
                if u > 1.0 || (place < 3 && (step == 0 || outside)) {
                    continue;
                }
                let h = if place < 3 {
                    rise_over(&march, 0.0, y0, step - 1, u)
                } else {
                    let h = march.height_at(y.div_euclid(whole), step);
                    let f = y.rem_euclid(whole) as f32 / whole as f32;
                    let next = march.height_at(y.div_euclid(whole) + 1, step);
                    h + if f > 0.0 { f * (next - h) } else { 0.0 }
                };
                while let [.., under, top] = hull[..] {
                    let x1 = ((step - 1) as f32 - top.step) + (u - top.rest);
                    let x2 = ((step - 1) as f32 - under.step) + (u - under.rest);
                    if (under.h - h) * x1 < (top.h - h) * x2 {
                        break;
                    }
                    hull.pop();
                }
                if place == 3 && y % whole == 0 && step >= warm_up {
                    let (mut slope, mut back) = (NO_SLOPE, 0.0);
                    if let Some(top) = hull.last() {
                        let met_step = top.step as i32;
                        back = (step - met_step) as f32 - top.rest;
                        let met_y = y - (step - met_step) * shear;
                        slope = rise_over(&march, h, met_y, met_step, top.rest)
                            / (back * azimuth.step_m);
                    }
                    let (lane, at) = if periodic {
                        (wrapped(y / whole, lanes), step % steps)
                    } else {
                        (y / whole, step)
                    };
                    let texel = lattice.texel(lane, march.march_position(at), azimuth.layer);
                    lattice.slopes[texel] = slope;
                    lattice.distances[texel] = back;
                }
                hull.push(Vertex { h, step: (step - 1) as f32, rest: u });
            }
        }
    }
}
