//! The passes that find horizons.

use half::f16;
use ridgelight::gpu::shaders::offset;
use ridgelight::plan::azimuths::CELL;
use ridgelight::plan::{Azimuth, Nodes, Pass};
use ridgelight::scene::{Border, Fuse};
use ridgelight_cpu::height_transpose::{heights_by_col, heights_by_row};
use ridgelight_cpu::horizon_march as march_reference;
use ridgelight_cpu::horizon_march::MarchOptions;
use ridgelight_cpu::horizon_sweep as sweep_reference;
use ridgelight_cpu::horizon_sweep::{SweepOptions, height_scale};
use ridgelight_cpu::lattice::{Lattice, line_number, line_position, slots};
use ridgelight_cpu::shared::sweep::{LOWEST_MET, March, on_field};
use ridgelight_cpu::surface_sweep as surface_reference;
use ridgelight_cpu::sweep_fuse::fused_horizon;
use ridgelight_cpu::tolerance::{
    EPSILON, device_angle, device_distance, device_fused_slope, device_march_slope, device_slope,
    device_slope_f16, device_slope_packed, device_surface_slope,
};

use crate::cpu_reference::{Pair, Run, constant, fuse_of, pushed};

/// Heights are moved, not changed.
pub(crate) fn height_transpose(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let [cols, rows] = run.size();
    let texels = run.heights().heights_m;
    let by_row = constant(pass, "marches_rows") == 1;
    let (lanes, want) = if by_row {
        (cols, heights_by_row(texels))
    } else {
        (rows, heights_by_col(texels, cols, rows))
    };
    let periodic = run.border() == Border::Periodic;
    let width = lanes.next_multiple_of(4);
    let mut got = run.floats(pass, "lane_heights").expect("written");
    let texels = width * want.len() / lanes;
    assert_eq!(got.len(), texels);
    // The buffer holds the same.
    if constant(pass, "writes_buffer") == 1 {
        let buffer = run.floats(pass, "lane_buffer").expect("written");
        assert_eq!(buffer.len(), texels + 8);
        // Four floats before, and four after.
        assert_eq!(buffer[..4], buffer[4..8]);
        assert_eq!(buffer[texels + 4..], buffer[texels..texels + 4]);
        got.extend(&buffer[4..texels + 4]);
    }
    let pairs = got.iter().enumerate().map(|(i, got)| {
        let i = i % texels;
        let (march, lane) = (i / width, i % width);
        // Beyond the last lane the last one is repeated, or the first follows.
        let from = if periodic { lane % lanes } else { lane.min(lanes - 1) };
        let want = want[march * lanes + from].into();
        Pair { got: (*got).into(), want, tolerance: 0.0, at: [0, march, lane] }
    });
    pairs.collect()
}

/// A lattice of lines as the device stores it: [layer][step][line].
pub(crate) struct Stored {
    words: Vec<u32>,
    /// Texels of a step, each of four lines, and steps of a layer.
    size: [usize; 2],
    /// Words of four lines: 4 of f32, 2 of halves.
    texel: usize,
}

impl Stored {
    pub(crate) fn bits(&self, layer: u32, line: i32, step: i32) -> u32 {
        let line = line as usize;
        let [width, height] = self.size;
        let layer = layer as usize + line / (4 * width);
        let texel = (layer * height + step as usize) * width + line / 4 % width;
        if self.texel == 4 {
            return self.words[texel * 4 + line % 4];
        }
        self.words[texel * 2 + line % 4 / 2] >> (16 * (line % 2)) & 0xffff
    }
}

pub(crate) fn stored(run: &mut Run, pass: &Pass, binding: &str, texel: usize) -> Option<Stored> {
    let words = run.words(pass, binding)?;
    Some(Stored { words, size: run.extent(pass, binding), texel })
}

/// Slope of the texel of a line `back` steps before, in f64; none without an occluder.
fn slope_of(march: &March, y: i32, step: i32, back: i32) -> Option<f64> {
    let at = |n: i32| f64::from(march.line_height(y - n * march.azimuth.shear, step - n));
    (back > 0).then(|| (at(back) - at(0)) / (f64::from(back) * f64::from(march.azimuth.step_m)))
}

pub(crate) fn horizon_sweep(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let in_occluders = constant(pass, "hull_place") == 2;
    let holds_line = constant(pass, "hull_holds_line") == 1;
    if !holds_line && !in_occluders {
        // Complete once the pass that follows has redone its lost lines.
        let lost = run.words(pass, "lost_lines").expect("written");
        run.lost += lost.iter().filter(|w| **w != 0).count();
        return Vec::new();
    }
    let slope_format = constant(pass, "slope_format");
    let occluders =
        stored(run, pass, "occluders", 2).filter(|_| constant(pass, "writes_occluders") == 1);
    let slopes = stored(run, pass, "slopes", if slope_format == 1 { 4 } else { 2 });
    let packed =
        (constant(pass, "hull_packed") == 1).then(|| height_scale(run.heights().heights_m));
    let first = pushed(pass, const { offset("HorizonSweepPush", "first_azimuth") }) as usize;
    let mut pairs = Vec::new();
    for k in first..first + pass.groups[2] as usize {
        let azimuth = run.plan.azimuths[k];
        let options = SweepOptions {
            line_shift: constant(pass, "line_shift"),
            warm_up: run.warm_up(azimuth.marches_rows()),
            packed,
            slopes_f16: slope_format == 2,
        };
        let left = lines_of(run, (k, &azimuth), options, &occluders, &slopes, &mut pairs);
        run.lattices[k] = Some(left);
    }
    pairs
}

/// Pairs one azimuth's lines and returns the device's values, stored like the CPU reference's.
fn lines_of(
    run: &Run,
    (k, azimuth): (usize, &Azimuth),
    options: SweepOptions,
    occluders: &Option<Stored>,
    slopes: &Option<Stored>,
    pairs: &mut Vec<Pair>,
) -> Lattice {
    let heights = run.heights();
    let alone = Azimuth { layer: 0, ..*azimuth };
    let march = March::new(heights, &alone);
    let (shift, border) = (options.line_shift, run.border());
    let slots = slots(march.lanes as usize, shift, border);
    let mut left = Lattice::new(1, slots, march.steps as usize);
    let mut reference = left.clone();
    sweep_reference::horizon_sweep(heights, &alone, &options, &mut reference);
    let [largest, _] = run.relief();
    let step_m = f64::from(azimuth.step_m);
    let total = options.warm_up + march.steps;
    for (row, slot) in (0..march.steps).flat_map(|s| (0..slots as i32).map(move |t| (s, t))) {
        let step = options.warm_up + row;
        let y = line_position(slot, step, azimuth.shear, shift);
        if border != Border::Periodic && !on_field(y, march.lanes) {
            continue;
        }
        let place = (slot, slots as i32);
        let line = line_number(place, (step, total), azimuth.shear, shift, border);
        let texel = left.texel(slot, march.march_position(row), 0);
        let at = [k, row as usize, slot as usize];
        if let Some(occluders) = occluders {
            let got = occluders.bits(azimuth.layer, line, step);
            let want = reference.occluders[texel];
            left.occluders[texel] = got as u16;
            let slope = |back| slope_of(&march, y, step, back);
            pairs.push(match (slope(got as i32), slope(want.into())) {
                // Rounded heights may choose another occluder of the same height.
                (Some(got), Some(want)) if options.packed.is_some() => {
                    Pair { got, want, tolerance: device_slope_packed(largest, step_m), at }
                }
                _ => Pair { got: got.into(), want: want.into(), tolerance: 0.0, at },
            });
        }
        if let Some(slopes) = slopes {
            let bits = slopes.bits(azimuth.layer, line, step);
            let got = match options.slopes_f16 {
                true => f16::from_bits(bits as u16).to_f32(),
                false => f32::from_bits(bits),
            };
            left.slopes[texel] = got;
            let want = f64::from(reference.slopes[texel]);
            let tolerance = match (options.packed, options.slopes_f16) {
                (Some(_), _) => device_slope_packed(largest, step_m),
                (None, true) => device_slope_f16(want),
                (None, false) => device_slope(want),
            };
            pairs.push(Pair { got: got.into(), want, tolerance, at });
        }
    }
    left
}

/// Slope of the surface `back` steps ahead on a texel's own line, in f64.
fn slope_at(march: &March, (lane, step): (i32, i32), back: f64) -> f64 {
    let azimuth = &march.azimuth;
    let shear = if azimuth.vector_march > 0 {
        f64::from(azimuth.vector_lane) / f64::from(azimuth.vector_march)
    } else {
        f64::from(azimuth.shear) / f64::from(CELL)
    };
    let (across, along) = (f64::from(lane) - back * shear, f64::from(step) - back);
    let (cell, at) = (across.floor(), along.floor());
    let (f, u) = (across - cell, along - at);
    let corner = |l: i32, s: i32| f64::from(march.height_at(cell as i32 + l, at as i32 + s));
    let [h00, h10, h01, h11] = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
    let height = match march.split_along() {
        true if f <= u => h00 + u * (h10 - h00) + f * (h11 - h10),
        true => h00 + f * (h01 - h00) + u * (h11 - h01),
        false if u + f <= 1.0 => h00 + u * (h10 - h00) + f * (h01 - h00),
        false => h11 + (1.0 - u) * (h01 - h11) + (1.0 - f) * (h10 - h11),
    };
    (height - f64::from(march.height_at(lane, step))) / (back * f64::from(azimuth.step_m))
}

/// The occluder may differ from the CPU reference's where two are equally high; but its slope must be the CPU
/// reference's, within both errors.
fn place_pair(
    march: &March,
    grid_point: (i32, i32),
    back: f64,
    (want, tolerance): (f32, f64),
    at: [usize; 3],
) -> Pair {
    if want <= LOWEST_MET {
        return Pair { got: back, want: 0.0, tolerance: 0.0, at };
    }
    let got = slope_at(march, grid_point, back);
    Pair { got, want: want.into(), tolerance: 2.0 * tolerance, at }
}

/// Texels, as (step, lane), whose values a march stores, and where in its layer: by step and lane, or of nodes alone
/// at their own places.
pub(crate) fn marched(march: &March, nodes: Nodes) -> Vec<([i32; 2], [usize; 2])> {
    let (steps, lanes) = (march.steps as u32, march.lanes as u32);
    let all = (0..nodes.count(steps)).flat_map(|y| (0..nodes.count(lanes)).map(move |x| [y, x]));
    all.map(|[y, x]| {
        let [row, col] = [nodes.place(y, steps) as i32, nodes.place(x, lanes) as i32];
        let grid_point = [march.march_position(row), march.lane_position(col)];
        let place = if nodes.stride > 1 { [y, x] } else { grid_point.map(|i| i as u32) };
        (grid_point, place.map(|i| i as usize))
    })
    .collect()
}

/// Pairs passes that find one value a texel: [layer][step][lane], distances in the next layer.
fn one_a_texel(
    run: &mut Run,
    pass: &Pass,
    first: u32,
    (has_distances, nodes): (bool, Nodes),
    reference_of: impl Fn(&Run, &Azimuth, &mut Lattice) -> f64,
) -> Vec<Pair> {
    let words = run.floats(pass, "slopes").expect("written");
    let [width, height] = run.extent(pass, "slopes");
    let mut pairs = Vec::new();
    for k in first as usize..(first + pass.groups[2]) as usize {
        let azimuth = run.plan.azimuths[k];
        let alone = Azimuth { layer: 0, ..azimuth };
        let march = March::new(run.heights(), &alone);
        let mut left = Lattice::new(1, march.lanes as usize, march.steps as usize);
        let mut reference = left.clone();
        let tolerance = reference_of(run, &alone, &mut reference);
        for ([step, lane], [row, col]) in marched(&march, nodes) {
            let texel = left.texel(lane, march.march_position(step), 0);
            let stored = |layer: u32| words[(layer as usize * height + row) * width + col];
            left.slopes[texel] = stored(azimuth.layer);
            let (got, want) = (left.slopes[texel].into(), reference.slopes[texel]);
            let at = [k, row, col];
            pairs.push(Pair { got, want: want.into(), tolerance, at });
            if has_distances {
                left.distances[texel] = stored(azimuth.layer + 1);
                let back = left.distances[texel].into();
                pairs.push(place_pair(&march, (lane, step), back, (want, tolerance), at));
            }
        }
        run.lattices[k] = Some(left);
    }
    pairs
}

pub(crate) fn surface_sweep(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let first = pushed(pass, const { offset("MarchPush", "first_azimuth") });
    let stored = (constant(pass, "writes_distances") == 1, Nodes { stride: 1 });
    one_a_texel(run, pass, first, stored, |run, azimuth, reference| {
        let warm_up = run.warm_up(azimuth.marches_rows());
        surface_reference::surface_sweep(run.heights(), azimuth, warm_up, reference);
        let vector = [azimuth.vector_march, azimuth.vector_lane];
        device_surface_slope(run.relief()[0], azimuth.step_m.into(), vector)
    })
}

pub(crate) fn horizon_march(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let first = pushed(pass, const { offset("MarchPush", "first_azimuth") });
    let stored =
        (constant(pass, "writes_distances") == 1, Nodes { stride: constant(pass, "node_stride") });
    one_a_texel(run, pass, first, stored, |run, azimuth, reference| {
        let warm_up = run.warm_up(azimuth.marches_rows());
        let options = MarchOptions { all_crossings: true, warm_up };
        march_reference::horizon_march(run.heights(), azimuth, options, reference);
        device_march_slope(run.relief()[1], azimuth.step_m.into())
    })
}

pub(crate) fn sweep_fuse(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let (fuse, line_shift) = fuse_of(pass);
    let angles = run.floats(pass, "horizon_angles").expect("written");
    let distances = run.floats(pass, "horizon_distances");
    let first = pushed(pass, const { offset("SweepFusePush", "first_azimuth") }) as usize;
    let [cols, rows] = run.size();
    let [largest, _] = run.relief();
    let range = first..first + pass.groups[2] as usize;
    run.swept(range, (fuse, line_shift), |swept| {
        let mut pairs = Vec::new();
        for (k, azimuth) in swept.azimuths.iter().enumerate() {
            // Values that are only read have no error.
            let slope_error = match fuse {
                None | Some(Fuse::Nearest) => 0.0,
                _ => device_fused_slope(largest, azimuth.step_m.into()),
            };
            for i in 0..rows * cols {
                let (row, col) = (i / cols, i % cols);
                let want = fused_horizon(swept, azimuth, col as i32, row as i32);
                let slope = want.found.slope;
                let place = azimuth.horizon_layer as usize * rows * cols + i;
                let at = [k, row, col];
                let tolerance = device_angle(slope.into(), slope_error);
                pairs.push(Pair { got: angles[place].into(), want: want.angle_rad, tolerance, at });
                let Some(distances) = &distances else { continue };
                let (got, want_m) = (f64::from(distances[place]), f64::from(want.distance_m));
                let pair = Pair { got, want: want_m, tolerance: device_distance(want_m), at };
                let on_edge = swept.heights.border != Border::Open
                    && f64::from(slope).abs() <= slope_error
                    && (got == 0.0 || want_m == 0.0);
                if pair.ratio() <= 1.0 || got == 0.0 || want_m == 0.0 {
                    // A slope of 0 may round to either side of the ground.
                    pairs.extend((!on_edge).then_some(pair));
                } else {
                    let march = March::new(swept.heights, azimuth);
                    let grid_point = march.of_grid_point(col as i32, row as i32);
                    let steepest = 2.0 * largest / f64::from(azimuth.step_m);
                    let error = slope_error + 8.0 * EPSILON * steepest;
                    let back = got / f64::from(azimuth.step_m);
                    pairs.push(place_pair(&march, grid_point, back, (slope, error), at));
                }
            }
        }
        pairs
    })
}
