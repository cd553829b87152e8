use crate::gpu::shaders::{self, same_layout};
use crate::plan::pyramid::Pyramid;
use crate::plan::{Bounce, Builder, ResourceId};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ShadeReducePush {
    size: [i32; 2],
    first: i32,
    source_size: [i32; 2],
    source_first: i32,
    ratio: [f32; 2],
    per_sample: [f32; 2],
    level: i32,
    width_shift: i32,
}

same_layout!(
    ShadeReducePush,
    shade_reduce_push,
    size = COLS,
    first = FIRST,
    source_size = SOURCE_COLS,
    source_first = SOURCE_FIRST,
    ratio = RATIO_X,
    per_sample = PER_SAMPLE_X,
    level = LEVEL,
    width_shift = WIDTH_SHIFT,
);

/// One level of exit radiance from the one an octave finer.
pub(crate) fn plan(
    builder: &mut Builder,
    pyramid: &Pyramid,
    number: u32,
    bounce: &Bounce,
    [levels, table]: [ResourceId; 2],
) {
    let from = pyramid.source(number);
    let (level, source) = (pyramid.level(number), pyramid.level(from));
    let [cols, rows] = level.size;
    let apart = (f64::from(number) / f64::from(pyramid.level_step)).exp2();
    builder.pass(
        &shaders::SHADE_REDUCE,
        &format!("{} level {number}", bounce.name),
        format!("radiance every {apart:.1} samples"),
        [cols.div_ceil(8), rows.div_ceil(8), 1],
        &[(0, u32::from(pyramid.periodic)), (1, u32::from(from == 0)), (2, u32::from(bounce.grey))],
        &ShadeReducePush {
            size: level.size.map(|n| n as i32),
            first: level.first as i32,
            source_size: source.size.map(|n| n as i32),
            source_first: source.first as i32,
            ratio: pyramid.ratio(number),
            per_sample: level.per_sample,
            level: number as i32,
            width_shift: pyramid.width_shift() as i32,
        },
        &[("exit_radiance", bounce.exit), ("shade_levels", levels), ("shade_table", table)],
        16 * (level.texels() + source.texels()),
        level.texels(),
    );
}
