//! The passes of the path tracer.

use ridgelight::cpu::bounce::{Fineness, truth};
use ridgelight::cpu::height_bounds as bounds_twin;
use ridgelight::cpu::height_cells as cells_twin;
use ridgelight::gpu::shaders::offsets;
use ridgelight::measure::tolerance::EPSILON;
use ridgelight::plan::{Pass, REFERENCE_BATCH, unmet_error};

use super::{Pair, Run, pushed};

/// Heights are moved, not changed. A slope is a weighted sum of six differences, of which each and its
/// weight, the sums and the quotient round: 12 ε of the relief over a cell, or less.
pub(super) fn height_cells(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let (field, border) = (&run.scene.field, run.border());
    let [cols, _] = run.size();
    let [_, relief] = run.relief();
    let slope = 12.0 * EPSILON * relief / field.cell_m()[0].min(field.cell_m()[1]);
    let cells = cells_twin::cells(field, border);
    let ground = cells_twin::ground(field, border);
    let mut pairs = Vec::new();
    let mut add = |i: usize, got: f32, want: f64, tolerance: f64| {
        pairs.push(Pair { got: got.into(), want, tolerance, at: [0, i / cols, i % cols] });
    };
    let got = run.floats(pass, "cells").expect("written");
    for (i, corners) in got.chunks_exact(4).enumerate() {
        (0..4).for_each(|k| add(i, corners[k], cells[i][k].into(), 0.0));
    }
    let got = run.floats(pass, "ground").expect("written");
    for (i, texel) in got.chunks_exact(4).enumerate() {
        (0..3).for_each(|k| add(i, texel[k], ground[i][k], if k == 0 { 0.0 } else { slope }));
    }
    if let Some(begun) = run.floats(pass, "batch_mean") {
        begun.iter().enumerate().for_each(|(i, v)| add(i / 4, *v, 0.0, 0.0));
        add(0, run.words(pass, "lost_rays").expect("written")[0] as f32, 0.0, 0.0);
    }
    pairs
}

/// The highest is one of the heights.
pub(super) fn height_bounds(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    use offsets::height_bounds_push::{CELLS_X, CELLS_Y, LEVEL, PADDED_ROWS};
    let [x, y, level, padded] = [CELLS_X, CELLS_Y, LEVEL, PADDED_ROWS].map(|o| pushed(pass, o));
    let cells = cells_twin::cells(&run.scene.field, run.border());
    let [cols, _] = run.size();
    let want = bounds_twin::height_bounds(&cells, cols, [x as usize, y as usize], level);
    let across = x.div_ceil(4_u32.pow(level)) as usize;
    let top = (padded / 2 - padded / (2 * 4_u32.pow(level - 1))) as usize;
    let [width, _] = run.extent(pass, "maxima");
    let got = run.floats(pass, "maxima").expect("written");
    let pairs = want.iter().enumerate().map(|(i, want)| {
        let at = [level as usize, i / across, i % across];
        let got = got[(top + at[1]) * width + at[2]];
        Pair { got: got.into(), want: (*want).into(), tolerance: 0.0, at }
    });
    pairs.collect()
}

/// Against the quadrature, which knows no chance: six standard errors, as `Agreement` takes them and with
/// that of light that no path has met, and what the quadrature itself may be off by, thrice, as single
/// samples may do worse than it states.
pub(super) fn path_trace(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const BATCHES: u32 = 64;
    let last = run.plan.passes.len() - 1;
    for _ in 1..BATCHES {
        run.gpu.draw_passes(&mut run.frame, &[last]).expect("drawn on");
    }
    let bounces = pushed(pass, offsets::path_trace_push::BOUNCES) as usize;
    let fineness = Fineness { azimuths: 24, divisions: 1, strips: 8 };
    let truth = truth(run.scene, bounces, fineness).expect("a truth");
    let (want, stated) = (&truth.radiance[bounces], &truth.error[bounces]);
    let light = run.floats(pass, "radiance").expect("written");
    let error = run.floats(pass, "standard_error").expect("written");
    let [cols, _] = run.size();
    let unmet = unmet_error(run.scene, bounces as u32, BATCHES * REFERENCE_BATCH);
    let pair = |i: usize, c: usize| {
        let (got, want) = (f64::from(light[4 * i + c]), want[i][c]);
        let sigma = f64::from(error[4 * i + c]).hypot(unmet[c]);
        let tolerance = 6.0 * sigma + 3.0 * stated[i][c] + 1e-5 * want;
        Pair { got, want, tolerance, at: [c, i / cols, i % cols] }
    };
    (0..want.len()).flat_map(|i| [0, 1, 2].map(|c| pair(i, c))).collect()
}
