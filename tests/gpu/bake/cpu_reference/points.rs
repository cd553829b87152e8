//! Visible points.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::{Directions, VisiblePoint, VisiblePoints};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::tolerance::{MET_SHARE, crossing_elevation};
use ridgelight_cpu::visible_points::possible_within;

use crate::cpu_reference::{Pair, Run, pushed};

const END_DIRECTION: usize = offset("VisiblePointsPush", "end_direction");
const FIRST_DIRECTION: usize = offset("VisiblePointsPush", "first_direction");

fn number(point: VisiblePoint) -> f64 {
    match point {
        VisiblePoint::GridPoint(at) => at as f64,
        VisiblePoint::Sky => -1.0,
        VisiblePoint::Ground => -2.0,
    }
}

/// The CPU reference's answer, or another of its answers within the error of a ray's elevation and place: a texel
/// beside a boundary between two, or the other side of a silhouette.
pub(crate) fn visible_points(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let (field, border) = (&run.scene.field, run.border());
    let directions = run.directions();
    // Of one image among several, and the last of its dispatches.
    let [first, end] = [FIRST_DIRECTION, END_DIRECTION].map(|o| pushed(pass, o) as usize);
    let first_texel = pushed_first(run);
    let own = first - first_texel..end - first_texel;
    let part = Directions::from_vectors(directions.vectors()[own.clone()].to_vec(), -1.0);
    let words = run.words(pass, "visible_points").expect("written");
    let points = VisiblePoints::new(field, border, part.expect("some"), words).expect("all whole");
    let oracle = Oracle::new(field, border);
    let [cols, rows] = run.size();
    let mut pairs = Vec::new();
    for (i, e) in points.directions().vectors().iter().enumerate() {
        for at in 0..rows * cols {
            let here = [at / cols, at % cols];
            let own = f64::from(field.heights_m()[at]);
            let off = |interval: &_| crossing_elevation(&oracle, interval, own);
            let possible = possible_within(&oracle, here, *e, off, MET_SHARE);
            let got = points.point(i, at);
            let want = if possible.contains(&got) { got } else { possible[0] };
            let [got, want] = [got, want].map(number);
            pairs.push(Pair { got, want, tolerance: 0.0, at: [i, here[0], here[1]] });
        }
    }
    pairs
}

/// The texel of the first direction of all.
fn pushed_first(run: &Run) -> usize {
    let passes = run.plan.passes.iter().filter(|p| p.name() == "visible_points");
    passes.map(|p| pushed(p, FIRST_DIRECTION) as usize).min().expect("a pass")
}
