//! `walk.glsl`: traversal of the field's cells by a ray, with block skipping.

use crate::height_bounds::height_bounds;
use crate::height_cells::cells;
use crate::tolerance::near::{Near, Near3};
use ridgelight::scene::{Border, HeightField};

const LEVEL_BITS: i32 = 2;
/// A ray over a repeating field stops after this many cells.
pub(super) const REACH_CELLS: i32 = 16384;

/// The surface that rays traverse.
pub struct Ground {
    pub(super) border: Border,
    /// Four corners of every cell, in rows of the field's grid points.
    pub(super) cells: Vec<[f32; 4]>,
    pub(super) cols: usize,
    /// Columns and rows of cells.
    pub(super) size: [i32; 2],
    /// Maxima of blocks of 4^level cells, from level 1 on.
    levels: Vec<Vec<f32>>,
    pub(super) top_level: i32,
    /// One grid point wide along rows, along columns.
    thin: [bool; 2],
    pub(super) highest_m: Near,
    /// Highest less lowest.
    pub(super) relief_m: f64,
    /// A cell's sides.
    pub cell_m: [Near; 2],
}

impl Ground {
    /// Of a field.
    pub fn of(field: &HeightField, border: Border) -> Self {
        let is_periodic = border == Border::Periodic;
        let sides = [field.cols(), field.rows()];
        let size = sides.map(|n| if is_periodic { n } else { (n - 1).max(1) });
        let longest = size[0].max(size[1]);
        let top_level = (1..).find(|l| 4_usize.pow(*l) >= longest).expect("up to 4^15");
        let cells = cells(field, border);
        let level = |l| height_bounds(&cells, field.cols(), size, l);
        let levels = (1..=top_level).map(level).collect();
        let heights = field.heights_m().iter();
        let ends = heights.fold([f32::MAX, f32::MIN], |e, h| [e[0].min(*h), e[1].max(*h)]);
        Self {
            border,
            cols: field.cols(),
            size: size.map(|n| n as i32),
            levels,
            top_level: top_level as i32,
            thin: [field.rows(), field.cols()].map(|n| !is_periodic && n == 1),
            highest_m: Near::given(ends[1]),
            relief_m: f64::from(ends[1]) - f64::from(ends[0]),
            cell_m: field.cell_m().map(|m| Near::given(m as f32)),
            cells,
        }
    }

    /// Corners of the cell in this column and row.
    pub fn corners(&self, [x, y]: [i32; 2]) -> [Near; 4] {
        self.cells[y as usize * self.cols + x as usize].map(Near::given)
    }

    /// The highest of the block of a level, 1 or more, that holds a cell.
    pub(super) fn top(&self, [x, y]: [i32; 2], level: i32) -> Near {
        let shift = LEVEL_BITS * level;
        let across = (self.size[0] as usize).div_ceil(1 << shift);
        let at = (y >> shift) as usize * across + (x >> shift) as usize;
        Near::given(self.levels[level as usize - 1][at])
    }

    fn is_beyond(&self, at: [i32; 2]) -> bool {
        (0..2).any(|i| at[i] < 0 || at[i] >= self.size[i])
    }

    /// Clamped.
    pub(super) fn within(&self, at: [i32; 2]) -> [i32; 2] {
        [0, 1].map(|i| at[i].clamp(0, self.size[i] - 1))
    }
}

/// A ray from a point on the surface.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub(super) base: [i32; 2],
    pub(super) offset: [Near; 2],
    pub(super) own: Near,
    /// Cells per unit of t, towards east and south; the larger is 1 or -1.
    pub(super) advance: [Near; 2],
    /// Height per unit of t.
    pub(super) rise: Near,
    /// t per metre.
    pub scale: Near,
}

/// From a cell, a position in it and a height over the base, along a direction.
pub fn ray_from(ground: &Ground, base: [i32; 2], offset: [Near; 2], own: Near, e: Near3) -> Ray {
    let [x, y] = ground.cell_m;
    let direction = [e[0] / x, -e[1] / y];
    let least = Near::of(1e-9) / x.max(y);
    let along = direction[0].abs().max(direction[1].abs()).max(least);
    let advance = direction.map(|d| d / along);
    let advance = advance.map(|a| if a.most() < 1e-20 { Near::ZERO } else { a });
    Ray { base, offset, own, advance, rise: e[2] / along, scale: along }
}

impl Ray {
    /// Whether it runs forwards along either axis; none where rounding decides that.
    pub(super) fn onward(&self) -> [Option<bool>; 2] {
        self.advance.map(|a| Near::ZERO.above(a).map(|is_back| !is_back))
    }

    /// `from` + t · `advance`, within the cell.
    pub(super) fn place(&self, from: [Near; 2], t: Near) -> [Near; 2] {
        [0, 1].map(|i| (from[i] + t * self.advance[i]).within_one())
    }
}

/// Height over `own` at a position in a cell with these corners.
pub(super) fn cell_rise(corners: [Near; 4], own: Near, [u, v]: [Near; 2]) -> Near {
    let [nw, ne, sw, se] = corners;
    if v.v <= u.v {
        (nw - own) + u * (ne - nw) + v * (se - ne)
    } else {
        (nw - own) + v * (sw - nw) + u * (se - sw)
    }
}

/// Traversal state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
    pub cell: [i32; 2],
    pub at: [i32; 2],
    pub t: Near,
    pub level: i32,
    pub leaves: bool,
    pub onward: [bool; 2],
}

/// The current block.
pub(super) struct Block {
    /// Its cells, as the traversal counts them: not wrapped.
    low: [i32; 2],
    high: [i32; 2],
    pub ahead: Near,
    by_x: bool,
}

impl Walk {
    /// None where rounding decides in which cell it begins.
    pub fn from(ground: &Ground, ray: &Ray) -> Option<Self> {
        let [Some(east), Some(south)] = ray.onward() else { return None };
        let onward = [east, south];
        let mut cell = ray.base;
        for i in 0..2 {
            let is_on_line = !ray.offset[i].above(Near::ZERO)?;
            cell[i] -= i32::from(is_on_line && !onward[i]);
        }
        let mut at = cell;
        let mut leaves = false;
        if ground.border == Border::Periodic {
            (0..2).for_each(|i| at[i] += if at[i] < 0 { ground.size[i] } else { 0 });
        } else {
            for (i, at) in at.iter_mut().enumerate() {
                *at -= i32::from(ray.advance[i].v == 0.0 && *at == ground.size[i]);
            }
            cell = at;
            let [across, along] = ray.advance.map(|a| a.v != 0.0);
            leaves =
                (ground.thin[0] && along) || (ground.thin[1] && across) || ground.is_beyond(at);
        }
        Some(Self { cell, at, t: Near::ZERO, level: 0, leaves, onward })
    }

    pub fn block(&self, ground: &Ground, ray: &Ray) -> Block {
        let bits = LEVEL_BITS * self.level;
        let first = self.at.map(|at| (at >> bits) << bits);
        let is_periodic = ground.border == Border::Periodic;
        let wrap = [0, 1].map(|i| if is_periodic { self.at[i] - self.cell[i] } else { 0 });
        let low = [0, 1].map(|i| first[i] - wrap[i]);
        let high = [0, 1].map(|i| (first[i] + (1 << bits)).min(ground.size[i]) - wrap[i]);
        let to_edge = [0, 1].map(|i| {
            let edge = if self.onward[i] { high[i] } else { low[i] } - ray.base[i];
            if ray.advance[i].v == 0.0 {
                return Near::of(1e30);
            }
            (Near::given(edge as f32) - ray.offset[i]) * (Near::of(1.0) / ray.advance[i])
        });
        let ahead = to_edge[0].min(to_edge[1]).max(self.t);
        Block { low, high, ahead, by_x: to_edge[0].v <= to_edge[1].v }
    }

    /// Steps to the next block of the level where this one is `clear`. Goes to a coarser level on entering a coarser
    /// block, else to a finer one.
    pub fn on(&mut self, ground: &Ground, ray: &Ray, block: &Block, clear: bool) {
        let bits = LEVEL_BITS * self.level;
        let mut next = self.cell;
        if clear {
            for (i, to) in next.iter_mut().enumerate() {
                let [low, high] = [block.low[i], block.high[i]];
                let across = if self.onward[i] { high } else { low - 1 };
                let place = (ray.offset[i].v + block.ahead.v * ray.advance[i].v).floor() as i32;
                let other = (place + ray.base[i]).clamp(low, high - 1);
                let other =
                    if self.onward[i] { other.max(self.cell[i]) } else { other.min(self.cell[i]) };
                *to = if block.by_x == (i == 0) { across } else { other };
            }
        }
        let is_periodic = ground.border == Border::Periodic;
        let mut at = next;
        if is_periodic {
            at = [0, 1].map(|i| (self.at[i] + (next[i] - self.cell[i])).rem_euclid(ground.size[i]));
        }
        let changed = [0, 1].map(|i| (self.at[i] ^ at[i]) >> (bits + LEVEL_BITS));
        let coarser = (self.level + i32::from(changed != [0, 0])).min(ground.top_level);
        self.level = if clear { coarser } else { self.level - 1 };
        if clear {
            self.t = block.ahead;
            self.leaves |= !is_periodic && ground.is_beyond(at);
        }
        (self.cell, self.at) = (next, at);
    }
}
