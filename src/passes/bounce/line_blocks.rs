use crate::graph::{Axis, Builder, Format, Limits, Owner, ResourceId, shaders};
use crate::passes::azimuths::{Azimuth, CELL};
use crate::passes::batch::Batch;
use crate::passes::bounce_walk;
use crate::passes::bounce_walk::Swept;
use crate::passes::bounces::Bounce;
use crate::scene::Border;
use std::ops::Range;

/// Steps of the longest block, 2^MOST_LEVEL of the shaders.
pub(crate) const LONGEST: u32 = 256;
/// Blocks of several azimuths are made at once while an image takes no more than this, and than an eighth of the budget
/// that is left; of more azimuths a dispatch would hardly be faster. 72 MiB hold eight azimuths of grey light at 1024².
const AT_ONCE_BYTES: u64 = 72 << 20;
/// The same on a processor, whose cache then holds them: at 512² a frame with a bounce takes 0.96 of the time that it takes with
/// 64 MiB, at 1024² 1.02 (llvmpipe, 2 cores).
const AT_ONCE_BYTES_CPU: u64 = 4 << 20;
const MOST_AT_ONCE: u32 = 8;
/// Format of a block: largest height, its place, and radiance in one channel if grey, else three.
fn format(grey: bool) -> Format {
    if grey { Format::Rgba16Uint } else { Format::Rgba32Uint }
}

/// Blocks along the swept lines of some azimuths at a time, of each axis that is marched: columns, rows. One image
/// serves both where it takes no more than one for each.
#[derive(Clone, Copy)]
pub(crate) struct LineBlocks {
    of_axes: [Option<Lines>; 2],
    line_shift: u32,
    grey: bool,
}

#[derive(Clone, Copy)]
struct Lines {
    image: ResourceId,
    /// How many azimuths have room, and the layers of one.
    at_once: u32,
    layers: u32,
}

/// Rows and layers of one azimuth.
#[derive(Clone, Copy, PartialEq)]
struct Shape {
    rows: u32,
    layers: u32,
}

impl Shape {
    /// A block at every step, of one length or another; by 32, the lines that are on the field at a step, and
    /// one beside it at each end.
    fn of(axis: Axis, line_shift: u32) -> Self {
        let across = u64::from(axis.lanes - 1) * CELL as u64;
        let layers = ((across >> line_shift) as u32 + 3).div_ceil(32);
        Self { rows: axis.steps + axis.warm_up, layers }
    }

    fn blocks(&self) -> u64 {
        32 * u64::from(self.rows) * u64::from(self.layers)
    }
}

impl LineBlocks {
    /// With room for one azimuth, and for more where blocks are small.
    pub(crate) fn make(
        builder: &mut Builder,
        azimuths: &[Azimuth],
        (line_shift, grey): (u32, bool),
        (size, border): ([u32; 2], Border),
        limits: &Limits,
    ) -> Self {
        let shapes = [false, true].map(|by_row| {
            let count = azimuths.iter().filter(|a| a.marches_rows() == by_row).count() as u32;
            let shape = Shape::of(Axis::of(by_row, size, border), line_shift);
            (count > 0).then_some((shape, count))
        });
        let left = limits.memory_budget.saturating_sub(builder.bytes());
        let at_once = if limits.is_cpu { AT_ONCE_BYTES_CPU } else { AT_ONCE_BYTES };
        // In blocks.
        let room = at_once.min(left / 8) / format(grey).bytes();
        let mut image = |shape: Shape, count: u32, suffix: &str| {
            let at_once = ((room / shape.blocks()) as u32)
                .min(limits.image_layers / shape.layers)
                .clamp(1, count.min(MOST_AT_ONCE));
            let extent = [32, shape.rows, shape.layers * at_once];
            let name = format!("line_blocks{suffix}");
            let image = builder.image(name, Owner::Internal, format(grey), extent, true);
            Lines { image, at_once, layers: shape.layers }
        };
        let of_axes = match shapes {
            [Some((a, of_a)), Some((b, of_b))] => {
                let both = Shape { rows: a.rows.max(b.rows), layers: a.layers.max(b.layers) };
                if both.blocks() <= a.blocks() + b.blocks() {
                    [Some(image(both, of_a.max(of_b), "")); 2]
                } else {
                    [Some(image(a, of_a, "")), Some(image(b, of_b, "_across"))]
                }
            }
            one => one.map(|of| of.map(|(shape, count)| image(shape, count, ""))),
        };
        Self { of_axes, line_shift, grey }
    }

    fn lines(&self, axis: Axis) -> Lines {
        self.of_axes[usize::from(axis.marches_rows)].expect("made for every axis used")
    }

    /// The azimuths of a batch in groups that have room.
    pub(crate) fn groups(&self, batch: &Batch) -> Vec<Range<u32>> {
        let most = self.lines(batch.axis).at_once.min(bounce_walk::most_azimuths(batch.axis));
        let all = batch.azimuths();
        let group = |first: u32| first..all.end.min(first + most);
        all.clone().step_by(most as usize).map(group).collect()
    }

    /// The name of their binding.
    pub(crate) fn binding(grey: bool) -> &'static str {
        if grey { "grey_blocks" } else { "line_blocks" }
    }

    /// Image of the azimuths along an axis, and the layers of one.
    pub(crate) fn of(&self, axis: Axis) -> (ResourceId, u32) {
        let Lines { image, layers, .. } = self.lines(axis);
        (image, layers)
    }

    /// Makes the blocks of a group.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        border: Border,
        (batch, azimuths, part): (&Batch, &Range<u32>, &str),
        swept: &Swept,
        bounce: &Bounce,
    ) {
        let axis = batch.axis;
        let [cols, rows] = axis.size();
        let count = azimuths.len() as u32;
        let steps = axis.steps + axis.warm_up;
        let (image, block_layers) = self.of(axis);
        let found = u64::from(count) * u64::from(axis.lanes) * u64::from(steps);
        let pass = builder.pass(
            shaders::LineBlocks {
                line_shift: self.line_shift as i32,
                border: border as u32,
                marches_rows: axis.marches_rows,
                grey: self.grey,
            },
            part,
            format!("{}, blocks along {count} azimuths", bounce.why),
            shaders::LINE_BLOCKS.groups([batch.most_lines, steps.div_ceil(LONGEST), count]),
            &shaders::LineBlocksPush {
                cols: cols as i32,
                rows: rows as i32,
                warm_up: axis.warm_up as i32,
                first_azimuth: azimuths.start,
                block_layers: block_layers as i32,
            },
            &[
                swept.ground.bound(),
                ("azimuths", swept.azimuths),
                (Self::binding(self.grey), image),
            ],
            // Of two lanes; and as many blocks as steps.
            found * (2 * swept.ground.texel_bytes() + format(self.grey).bytes()),
            found,
        );
        pass.azimuths = azimuths.clone();
    }
}
