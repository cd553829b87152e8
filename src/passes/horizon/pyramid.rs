//! The levels of a height pyramid: how many a scene needs, their sizes and places.

use std::ops::RangeInclusive;

use crate::graph::{Builder, Format, Owner, ResourceId, shaders};
use crate::passes::sweep;
use crate::passes::{self, pyramid_march::Images};
use crate::scene::{Border, Levels, Quality};

/// Horizons from a pyramid of filtered heights (Nowrouzezahrai & Snyder 2009, §5.2).
///
/// Pyramid sample i of a march is 2^(i/k) march steps away, rounded to whole steps. It reads level i - k·o, or
/// the field itself (level 0) where that is below 1: the paper's f_(i + k o) counts levels from the coarsest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pyramid {
    /// Levels per octave, k.
    pub level_step: u32,
    /// Octaves by which levels are finer than the distance needs, o.
    pub level_offset: u32,
    /// How levels are stored.
    pub stored: Levels,
    /// Columns and rows of the field.
    pub size: [u32; 2],
    /// Whether the field repeats.
    pub periodic: bool,
}

/// One level above the field itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Index of its first texel among those of all levels.
    pub first: u64,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Texels per grid point along columns and along rows: 0 for a single texel.
    pub per_grid_point: [f32; 2],
}

/// Most workgroups in a row of a dispatch; devices have at least 65,535.
const GROUPS_ACROSS: u32 = 1024;

/// Levels that one dispatch makes.
pub(crate) struct Octave<'a> {
    pub pyramid: &'a Pyramid,
    numbers: RangeInclusive<u32>,
    /// The buffer with [`Pyramid::reductions`].
    pub constants: ResourceId,
    pub push: shaders::ReducePush,
}

impl<'a> Octave<'a> {
    /// `constants` are the buffer and the first texel of [`Pyramid::reductions`].
    pub(crate) fn new(
        pyramid: &'a Pyramid,
        numbers: RangeInclusive<u32>,
        (constants, first): (ResourceId, usize),
    ) -> Self {
        let mut first_group = [0; 16];
        let mut groups = 0;
        for (first, number) in first_group.iter_mut().zip(numbers.clone()) {
            *first = groups;
            let [cols, rows] = pyramid.level(number).size;
            let [across, down, _] = shaders::HEIGHT_REDUCE.groups([cols, rows, 1]);
            groups += (across * down) as i32;
        }
        let push = shaders::ReducePush {
            level: *numbers.start() as i32,
            levels: numbers.clone().count() as i32,
            levels_at: first as i32,
            width_shift: pyramid.width_shift() as i32,
            groups,
            first_group,
        };
        Self { pyramid, numbers, constants, push }
    }

    pub(crate) fn reads_field(&self) -> bool {
        self.pyramid.source(*self.numbers.start()) == 0
    }

    /// Grid points from texel to texel, of the finest and of the coarsest level.
    pub(crate) fn apart(&self) -> [f64; 2] {
        let octaves = |level: u32| f64::from(level) / f64::from(self.pyramid.level_step);
        [*self.numbers.start(), *self.numbers.end()].map(|level| octaves(level).exp2())
    }

    pub(crate) fn part(&self) -> String {
        format!("levels {} to {}", self.numbers.start(), self.numbers.end())
    }

    /// Workgroups of all levels, in rows, for each layer.
    pub(crate) fn groups(&self, layers: u32) -> [u32; 3] {
        let all = self.push.groups as u32;
        let across = all.min(GROUPS_ACROSS);
        [across, all.div_ceil(across), layers]
    }

    /// Texels of all levels, and with those of their sources.
    pub(crate) fn texels(&self) -> [u64; 2] {
        let of = |number: u32| self.pyramid.level(number).texels();
        let made = self.numbers.clone().map(of).sum();
        let read: u64 = self.numbers.clone().map(|number| of(self.pyramid.source(number))).sum();
        [made, made + read]
    }
}

impl Level {
    /// Texels of the level.
    pub(crate) fn texels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

impl Pyramid {
    /// The pyramid for a quality.
    pub fn new(quality: &Quality, size: [u32; 2], border: Border) -> Self {
        Self {
            level_step: quality.level_step,
            level_offset: quality.level_offset,
            stored: quality.levels,
            size,
            periodic: border == Border::Periodic,
        }
    }

    /// Samples of the longest march; the last one is where the march leaves the field.
    pub fn samples(&self) -> u32 {
        let longest = |n: u32| if self.periodic { n + sweep::warm_up(n) } else { n };
        let reach = self.size.map(longest).into_iter().max().unwrap_or(1) - 1;
        // Counted as the march does.
        let (mut samples, mut back) = (u32::from(reach > 0), 1.0_f32);
        while ((back + 0.5) as u32) < reach {
            back *= self.growth();
            samples += 1;
        }
        samples
    }

    /// Samples that read the field itself.
    pub fn fine_samples(&self) -> u32 {
        self.level_step * self.level_offset + 1
    }

    /// Levels above the field itself that some sample of the longest march reads.
    pub fn levels(&self) -> u32 {
        self.samples().saturating_sub(self.fine_samples())
    }

    /// Ratio of the distances of consecutive samples, 2^(1/k).
    pub fn growth(&self) -> f32 {
        (1.0 / f64::from(self.level_step)).exp2() as f32
    }

    /// The level that `level` is made from: an octave finer, or the field itself (0).
    pub fn source(&self, level: u32) -> u32 {
        level.saturating_sub(self.level_step)
    }

    /// Levels that are made together, as each needs only the one an octave finer.
    pub(crate) fn octaves(&self) -> Vec<RangeInclusive<u32>> {
        let last = self.levels();
        let firsts = (1..=last).step_by(self.level_step as usize);
        firsts.map(|first| first..=last.min(first + self.level_step - 1)).collect()
    }

    /// What the passes that make levels read: columns, rows and first texel (in 16-bit parts) of each level and of its
    /// source; ratios; texels per grid point.
    pub(crate) fn reductions(&self) -> Vec<f32> {
        let place = |level: &Level| {
            let [high, low] = [level.first >> 16, level.first & 0xffff].map(|part| part as f32);
            [level.size[0] as f32, level.size[1] as f32, high, low]
        };
        let of = |number: u32| {
            let (level, source) = (self.level(number), self.level(self.source(number)));
            let scale = [self.ratio(number), level.per_grid_point].concat();
            [&place(&level)[..], &place(&source), &scale].concat()
        };
        (1..=self.levels()).flat_map(of).collect()
    }

    /// Texels of its source per texel of `level`, along columns and along rows.
    pub fn ratio(&self, level: u32) -> [f32; 2] {
        let (size, source) = (self.size_of(level), self.size_of(self.source(level)));
        [0, 1].map(|axis| {
            let ends = u32::from(!self.periodic);
            let [of, to] = [source[axis] - ends, size[axis] - ends].map(f64::from);
            if to > 0.0 { (of / to) as f32 } else { 1.0 }
        })
    }

    /// Level 0 is the field itself, which is not stored again.
    pub fn level(&self, level: u32) -> Level {
        let first = (1..level).map(|l| self.size_of(l).map(u64::from)).map(|[w, h]| w * h).sum();
        let size = self.size_of(level);
        let per_grid_point = [0, 1].map(|axis| {
            let (grid_points, texels) = (f64::from(self.size[axis]), f64::from(size[axis]));
            let [gaps, of] = if self.periodic {
                [texels, grid_points]
            } else {
                [texels - 1.0, grid_points - 1.0]
            };
            if of > 0.0 { (gaps / of) as f32 } else { 0.0 }
        });
        Level { first, size, per_grid_point }
    }

    /// Texels 2^(l/k) grid points apart, or as near as possible so that the first and the last lie on the
    /// field's first and last grid points, or a whole number of them makes a period.
    fn size_of(&self, level: u32) -> [u32; 2] {
        let scale = (-f64::from(level) / f64::from(self.level_step)).exp2();
        self.size.map(|grid_points| {
            let texels = |n: u32| ((f64::from(n) * scale).round() as u32).max(1);
            match (self.periodic, grid_points) {
                (true, _) => texels(grid_points),
                (false, 1) => 1,
                (false, _) => texels(grid_points - 1) + 1,
            }
        })
    }

    /// log2 of the width of the image of all levels, which is about square.
    pub(crate) fn width_shift(&self) -> u32 {
        let texels: u64 = self.all_texels();
        texels.max(1).next_power_of_two().trailing_zeros().div_ceil(2)
    }

    /// Texels of all levels above the field itself.
    pub(crate) fn all_texels(&self) -> u64 {
        let last = self.level(self.levels());
        if self.levels() == 0 { 0 } else { last.first + last.texels() }
    }

    /// Images of the levels; none where no march reads any.
    pub(crate) fn images(&self, builder: &mut Builder) -> Option<Images> {
        let count = self.levels();
        if count == 0 {
            return None;
        }
        let mut image = |name: &str, format: Format, extent: [u32; 3], layered: bool| {
            builder.image(name, Owner::Internal, format, extent, layered)
        };
        let width = 1 << self.width_shift();
        let height = self.all_texels().div_ceil(u64::from(width)) as u32;
        let levels = image("height_levels", Format::R32Float, [width, height, 1], false);
        let table = image("level_table", Format::Rgba32Uint, [count, 1, 1], false);
        let [cols, rows] = self.size;
        let stack = (self.stored == Levels::Stack)
            .then(|| image("height_stack", Format::R32Float, [cols, rows, count], true));
        Some(Images { levels, table, stack })
    }

    /// Passes that fill them from the heights.
    pub(crate) fn plan(&self, builder: &mut Builder, heights: ResourceId, images: &Images) {
        let Images { levels, table, stack } = *images;
        let constants = builder.constants(&self.reductions());
        for octave in self.octaves() {
            let octave = Octave::new(self, octave, constants);
            passes::height_reduce::plan(builder, &octave, [heights, levels, table]);
        }
        if let Some(stack) = stack {
            passes::height_expand::plan(builder, self, [levels, table, stack]);
        }
    }
}
