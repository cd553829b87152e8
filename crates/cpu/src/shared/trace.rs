//! `trace.glsl`: the first hit of a ray on the triangulated surface, and whether rounding may decide otherwise.
//!
//! At a crossing, rounding decides whether the ray is above the surface if the height difference is within their
//! combined error. A ray that passes a corner within its position error may be traced through another cell, whose
//! surface differs there by at most the field's relief times that distance: the error of crossings grows by as much.

use super::walk::{Ground, REACH_CELLS, Ray, Walk, cell_rise};
use crate::tolerance::near::{Near, all, any};
use ridgelight::scene::Border;

/// Kind of hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// Left the field, or rose above all of it, or reached its end.
    Free,
    /// The surface.
    Hit,
    /// Left level or falling, where the ground continues level and black.
    Level,
    /// Exceeded the step limit.
    Lost,
}

/// Kind and position of a hit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Met {
    /// None where rounding decides.
    pub what: Option<What>,
    /// Where it was hit.
    pub t: Near,
    /// The cell, within the field.
    pub cell: [i32; 2],
    /// The position in it.
    pub offset: [Near; 2],
    /// Whether in its southern triangle; none where rounding decides the position in the cell.
    pub lower: Option<bool>,
    /// At every test against the surface, the number of cells crossed plus one.
    pub crossed: f64,
}

/// Between two cells' edges: where the ray crosses the diagonal.
fn split(ray: &Ray, from: [Near; 2]) -> Near {
    let apart = ray.advance[0] - ray.advance[1];
    if apart.v.abs() < 1e-30 { -Near::of(1.0) } else { (from[1] - from[0]) / apart }
}

/// First hit of a ray before `t_end`.
pub fn trace(ground: &Ground, ray: &Ray, t_end: Near) -> Met {
    let mut crossed = 0.0;
    let met = followed(ground, ray, t_end, &mut crossed);
    Met { crossed, ..met }
}

fn followed(ground: &Ground, ray: &Ray, t_end: Near, crossed: &mut f64) -> Met {
    let Some(mut walk) = Walk::from(ground, ray) else { return Met::default() };
    let rises = ray.rise.above(Near::ZERO);
    let far = Near::of(1e30);
    let t_over = match rises {
        Some(true) => (ground.highest_m - ray.own).max(Near::ZERO) / ray.rise,
        _ => far,
    };
    let is_periodic = ground.border == Border::Periodic;
    let reach = if is_periodic { Near::of(REACH_CELLS.into()) } else { far };
    let t_end = t_end.min(t_over).min(reach);
    let most_steps =
        3 * if is_periodic { REACH_CELLS } else { ground.size[0].max(ground.size[1]) } + 64;
    // Where the ray may have ended already, or have skipped this block at once.
    let mut may_have_ended = false;
    let mut may_have_passed = f64::NEG_INFINITY;
    for _ in 0..most_steps {
        let is_before_end = t_end.above(walk.t);
        if walk.leaves || is_before_end == Some(false) {
            let meets_ground = match ground.border {
                Border::Plane => walk.leaves,
                Border::Open => false,
                Border::Periodic => t_end.v >= f64::from(REACH_CELLS),
            };
            let what = match (meets_ground, rises) {
                (false, _) | (true, Some(true)) => Some(What::Free),
                (true, Some(false)) => Some(What::Level),
                (true, None) => None,
            };
            return Met { what, ..Met::default() };
        }
        may_have_ended |= is_before_end.is_none();
        let block = walk.block(ground, ray);
        let ahead = block.ahead;
        if walk.level > 0 {
            let top = ground.top(walk.at, walk.level) - ray.own;
            let clear = (walk.t * ray.rise).min(ahead * ray.rise).above(top);
            if clear.is_none() {
                may_have_passed = may_have_passed.max(ahead.v + ahead.off);
            }
            walk.on(ground, ray, &block, clear == Some(true));
            continue;
        }
        match blocked(ground, ray, &walk, ahead, crossed) {
            Some(false) => walk.on(ground, ray, &block, true),
            Some(true) if !may_have_ended && walk.t.v > may_have_passed => {
                return hit(ground, ray, &walk, ahead);
            }
            _ => return Met::default(),
        }
    }
    Met { what: Some(What::Lost), ..Met::default() }
}

/// Whether the surface is not below the ray at the cell's diagonal or its far edge.
fn blocked(ground: &Ground, ray: &Ray, at: &Walk, ahead: Near, crossed: &mut f64) -> Option<bool> {
    let corners = ground.corners(ground.within(at.at));
    let from = from(ray, at);
    let t_split = split(ray, from);
    let over_split = over_diagonal(ground, ray, corners, from, t_split);
    let is_between = all([t_split.above(at.t), ahead.above(t_split)]);
    let in_split = all([is_between, over_split.at_most(Near::ZERO)]);
    let over_exit = over(ground, ray, corners, from, ahead);
    *crossed += 1.0 + ahead.v;
    if is_between != Some(false) {
        *crossed += 1.0 + t_split.v.clamp(0.0, ahead.v);
    }
    any([in_split, all([ahead.above(at.t), over_exit.at_most(Near::ZERO)])])
}

/// Height of the ray over the surface at t.
fn over(ground: &Ground, ray: &Ray, corners: [Near; 4], from: [Near; 2], t: Near) -> Near {
    let place = ray.place(from, t);
    let over = t * ray.rise - cell_rise(corners, ray.own, place);
    over.wider(ground.relief_m * (place[0].off + place[1].off))
}

/// The same on the cell's diagonal.
fn over_diagonal(ground: &Ground, ray: &Ray, corners: [Near; 4], from: [Near; 2], t: Near) -> Near {
    let share = ray.place(from, t)[0];
    let over = t * ray.rise - ((corners[0] - ray.own) + share * (corners[3] - corners[0]));
    over.wider(ground.relief_m * share.off)
}

fn from(ray: &Ray, walk: &Walk) -> [Near; 2] {
    [0, 1].map(|i| ray.offset[i] + Near::given((ray.base[i] - walk.cell[i]) as f32))
}

/// Position in its cell: the surface is linear before and behind the diagonal.
fn hit(ground: &Ground, ray: &Ray, walk: &Walk, t_next: Near) -> Met {
    let (t, cell) = (walk.t, ground.within(walk.at));
    let corners = ground.corners(cell);
    let from = from(ray, walk);
    let over = |t: Near| over(ground, ray, corners, from, t);
    let t_split = split(ray, from);
    let is_split = all([t_split.above(t), t_next.above(t_split)]);
    let (t_middle, over_middle) = if is_split == Some(true) {
        (t_split, over_diagonal(ground, ray, corners, from, t_split))
    } else {
        (t_next, over(t_next))
    };
    let is_first = over_middle.at_most(Near::ZERO);
    let ([t_a, t_b], [over_a, over_b]) = if is_first == Some(true) {
        ([t, t_middle], [over(t), over_middle])
    } else {
        ([t_middle, t_next], [over_middle, over(t_next)])
    };
    // At the start the ray is on the surface, despite rounding.
    let begins = t_a.at_most(Near::ZERO);
    let over_a = if begins == Some(true) { Near::ZERO } else { over_a.max(Near::ZERO) };
    let s = over_a / (over_a - over_b).max(Near::of(1e-30));
    let t_hit = t_a + s.within_one() * (t_b - t_a);
    let middle = Near::of(0.5) * (t_a + t_b);
    let between = [0, 1].map(|i| from[i] + middle * ray.advance[i]);
    let is_sure = [is_split, is_first, begins].iter().all(Option::is_some);
    let lower = between[1].above(between[0]).filter(|_| is_sure);
    let offset = ray.place(from, t_hit);
    Met { what: Some(What::Hit), t: t_hit, cell, offset, lower, crossed: 0.0 }
}
