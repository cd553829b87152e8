//! The passes of a height pyramid.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::pyramid::{Level, Pyramid};
use ridgelight::plan::{Azimuth, Nodes, Pass};
use ridgelight_cpu::lattice::Lattice;
use ridgelight_cpu::pyramid_march::{Stored, pyramid_march as march_reference};
use ridgelight_cpu::shared::levels::LevelTexels;
use ridgelight_cpu::shared::sweep::March;
use ridgelight_cpu::tolerance::{device_level, device_pyramid_slope, device_spline};
use ridgelight_cpu::{height_expand as expand_reference, height_reduce as reduce_reference};

use super::sweep::marched;
use crate::cpu_reference::{Pair, Run, constant, pushed};

impl Run<'_> {
    fn pyramid(&self) -> Pyramid {
        Pyramid::new(&self.quality, self.plan.size, self.border())
    }
}

/// Numbers of the levels that a pass makes.
pub(crate) fn numbers(pass: &Pass) -> std::ops::Range<u32> {
    let first: u32 = pushed(pass, const { offset("ReducePush", "level") });
    let count: u32 = pushed(pass, const { offset("ReducePush", "levels") });
    first..first + count
}

/// The levels of an octave, and their entries in the table.
pub(crate) fn height_reduce(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    numbers(pass).flat_map(|number| height_level(run, pass, number)).collect()
}

fn height_level(run: &mut Run, pass: &Pass, number: u32) -> Vec<Pair> {
    let pyramid = run.pyramid();
    let level = pyramid.level(number);
    let texels = run.floats(pass, "height_levels").expect("written");
    let table = run.words(pass, "level_table").expect("written");
    let want = reduce_reference::height_reduce(&run.heights(), &pyramid, number, &texels);
    let tolerance = device_level(run.relief()[0]);
    let [cols, _] = level.size.map(|n| n as usize);
    let made = texels[level.first as usize..].iter().zip(&want).enumerate();
    let mut pairs: Vec<Pair> = made
        .map(|(i, (got, want))| {
            let at = [number as usize, i / cols, i % cols];
            Pair { got: (*got).into(), want: (*want).into(), tolerance, at }
        })
        .collect();
    pairs.extend(table_pairs(&level, number, &table));
    pairs
}

/// The table's entry of a level.
pub(crate) fn table_pairs(level: &Level, number: u32, table: &[u32]) -> Vec<Pair> {
    let [x, y] = level.per_grid_point.map(f32::to_bits);
    let want = [level.first as u32, level.size[0] | level.size[1] << 16, x, y];
    let pair = |(i, (want, got)): (usize, (&u32, &u32))| Pair {
        got: (*got).into(),
        want: (*want).into(),
        tolerance: 0.0,
        at: [number as usize, 0, i],
    };
    want.iter().zip(&table[4 * (number as usize - 1)..]).enumerate().map(pair).collect()
}

pub(crate) fn height_expand(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let pyramid = run.pyramid();
    let texels = run.floats(pass, "height_levels").expect("written");
    let stack = run.floats(pass, "height_stack").expect("written");
    let levels = LevelTexels { pyramid: &pyramid, texels: &texels };
    let tolerance = device_spline(run.relief()[0]);
    let [cols, rows] = run.size();
    let mut pairs = Vec::new();
    for number in 1..=pyramid.levels() {
        let layer = (number as usize - 1) * cols * rows;
        let want = expand_reference::height_expand(&levels, number);
        pairs.extend(stack[layer..].iter().zip(want).enumerate().map(|(i, (got, want))| Pair {
            got: (*got).into(),
            want: want.into(),
            tolerance,
            at: [number as usize, i / cols, i % cols],
        }));
    }
    pairs
}

pub(crate) fn pyramid_march(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let pyramid = run.pyramid();
    let words = run.words(pass, "slopes").expect("written");
    let [width, height] = run.extent(pass, "slopes");
    let stack = run.floats(pass, "height_stack");
    let levels = run.floats(pass, "height_levels").unwrap_or_default();
    let stored = stack.as_ref().map_or(Stored::Levels(&levels), |s| Stored::Stack(s));
    let [largest, relief] = run.relief();
    let mut pairs = Vec::new();
    for k in pass.azimuths.clone().map(|k| k as usize) {
        let azimuth = run.plan.azimuths[k];
        let alone = Azimuth { layer: 0, ..azimuth };
        let march = March::new(run.heights(), &alone);
        let mut left = Lattice::new(1, march.lanes as usize, march.steps as usize);
        let mut reference = left.clone();
        let warm_up = run.warm_up(azimuth.marches_rows());
        march_reference(run.heights(), &alone, &pyramid, stored, warm_up, &mut reference);
        for ([step, lane], [row, col]) in
            marched(&march, Nodes { stride: constant(pass, "node_stride") })
        {
            let texel = left.texel(lane, march.march_position(step), 0);
            let word = words[(azimuth.layer as usize * height + row) * width + col];
            left.slopes[texel] = f32::from_bits(word);
            let want = f64::from(reference.slopes[texel]);
            let tolerance = device_pyramid_slope(want, largest, relief, azimuth.step_m.into());
            let got = left.slopes[texel].into();
            pairs.push(Pair { got, want, tolerance, at: [k, row, col] });
        }
        run.lattices[k] = Some(left);
    }
    pairs
}
