//! Cells and blocks of heights, which rays traverse.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight_cpu::height_bounds as bounds_reference;
use ridgelight_cpu::height_cells as cells_reference;
use ridgelight_cpu::tolerance::EPSILON;

use crate::cpu_reference::{Pair, Reference, Run, pushed};

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] =
    &[("height_cells", height_cells), ("height_bounds", height_bounds)];

/// Heights are moved, not changed. A slope is a weighted sum of six differences, of which each and its
/// weight, the sums and the quotient round: 12 ε of the relief over a cell, or less.
pub(crate) fn height_cells(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let (field, border) = (&run.scene.field, run.border());
    let [cols, _] = run.size();
    let [_, relief] = run.relief();
    let slope = 12.0 * EPSILON * relief / field.cell_m()[0].min(field.cell_m()[1]);
    let cells = cells_reference::cells(field, border);
    let ground = cells_reference::ground(field, border);
    let mut pairs = Vec::new();
    let mut add = |i: usize, got: f32, want: f64, tolerance: f64| {
        pairs.push(Pair { got: got.into(), want, tolerance, at: [0, i / cols, i % cols] });
    };
    // Without rays there are no cells.
    let got = run.floats(pass, "cells");
    assert_eq!(got.is_some(), pass.constant("writes_cells") == Some(1), "{}", pass.label());
    let got = got.unwrap_or_default();
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

/// The highest is one of the heights, over a plane of two terms.
pub(crate) fn height_bounds(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const CELLS_X: usize = offset("HeightBoundsPush", "cells_x");
    const CELLS_Y: usize = offset("HeightBoundsPush", "cells_y");
    const LEVEL: usize = offset("HeightBoundsPush", "level");
    const PADDED_ROWS: usize = offset("HeightBoundsPush", "padded_rows");
    let [x, y, level, padded] = [CELLS_X, CELLS_Y, LEVEL, PADDED_ROWS].map(|o| pushed(pass, o));
    const TILT: usize = offset("HeightBoundsPush", "tilt");
    let tilt = [TILT, TILT + 4].map(|o| f32::from_bits(pushed(pass, o)));
    let mut cells = cells_reference::cells(&run.scene.field, run.border());
    let [cols, rows] = run.size();
    for (i, corners) in cells.iter_mut().enumerate() {
        for (k, corner) in corners.iter_mut().enumerate() {
            let [c, r] = [i % cols + k % 2, i / cols + k / 2].map(|n| n as f32);
            *corner += tilt[0] * c + tilt[1] * r;
        }
    }
    let plane = f64::from(tilt[0].abs()) * cols as f64 + f64::from(tilt[1].abs()) * rows as f64;
    let tolerance = if plane > 0.0 { 4.0 * EPSILON * (run.relief()[0] + plane) } else { 0.0 };
    let want = bounds_reference::height_bounds(&cells, cols, [x as usize, y as usize], level);
    let across = x.div_ceil(4_u32.pow(level)) as usize;
    let top = (padded / 2 - padded / (2 * 4_u32.pow(level - 1))) as usize;
    let [width, _] = run.extent(pass, "maxima");
    let got = run.floats(pass, "maxima").expect("written");
    let pairs = want.iter().enumerate().map(|(i, want)| {
        let at = [level as usize, i / across, i % across];
        let got = got[(top + at[1]) * width + at[2]];
        Pair { got: got.into(), want: (*want).into(), tolerance, at }
    });
    pairs.collect()
}
