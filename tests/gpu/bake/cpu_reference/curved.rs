//! Visible points on curved bases.

use glam::DVec3;
use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::{Curvature, Directions, VisiblePoint, VisiblePoints};
use ridgelight_cpu::bent_directions::ways::{HALF_SIDE, Way, Ways};
use ridgelight_cpu::bent_directions::{Draped, Fans, bent_direction};
use ridgelight_cpu::fan_weights::weight;
use ridgelight_cpu::tolerance::{EPSILON, bent as bent_error, fan_weight, over};

use crate::cpu_reference::{Pair, Run, pushed};

/// Visible points of the flat field, as the device has them.
fn flat(run: &mut Run, pass: &Pass, directions: Directions) -> VisiblePoints {
    let words = run.words(pass, "visible_points").expect("bound");
    VisiblePoints::new(&run.scene.field, run.border(), directions, words).expect("all whole")
}

fn fans_of(directions: &Directions) -> Fans {
    Fans::of(&directions.triangles().expect("a net"), directions.vectors())
}

/// The pass's output for each texel, direction after direction: the direction, and its weight.
pub(crate) fn at_texels(run: &mut Run, pass: &Pass, count: usize) -> Vec<Vec<(DVec3, f64)>> {
    let texels = run.floats(pass, "bent").expect("bound");
    let [cols, rows] = run.size();
    let grid_points = cols * rows;
    let of = |i: usize, at: usize| {
        let [x, y, z, what] =
            std::array::from_fn(|c| f64::from(texels[4 * (i * grid_points + at) + c]));
        (DVec3::new(x, y, z), what)
    };
    (0..grid_points).map(|at| (0..count).map(|i| of(i, at)).collect()).collect()
}

/// The hits that the device may choose: all possible ones up to the first certain one; where none is certain, the
/// nearest misses, or the distance beyond.
fn may_be_met(ways: &Ways, rise_m: f64) -> Vec<Way> {
    // Places err by far less than this of a cell.
    let margin = 1e-3;
    let inner: Vec<Way> = ways.all(HALF_SIDE - margin).collect();
    let (mut possible, mut passed) = (Vec::new(), Vec::new());
    for way in ways.all(HALF_SIDE + margin) {
        let off = over(&way, rise_m);
        if way.over_m <= way.graze_m + off {
            possible.push(way);
        }
        let is_met = |w: &&Way| w.away_m == way.away_m && w.over_m <= w.graze_m - off;
        if inner.iter().any(|w| is_met(&w)) {
            return possible;
        }
        passed.push((way, off));
    }
    if ways.is_cut {
        possible.push(ways.far());
        return possible;
    }
    let least = passed.iter().map(|(w, off)| w.over_m + off).fold(f64::MAX, f64::min);
    possible.extend(passed.iter().filter(|(w, off)| w.over_m - off <= least).map(|(w, _)| *w));
    if possible.is_empty() {
        possible.push(ways.met());
    }
    possible
}

/// The CPU reference's direction, or another of its results where roundings decide with which neighbour a direction
/// moves, or which repetition is visible.
pub(crate) fn bent_directions(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let directions = run.bent_directions();
    let points = flat(run, pass, directions.clone());
    let float = |o: usize| f64::from(f32::from_bits(pushed(pass, o)));
    let curvature = Curvature {
        per_m: [
            const { offset("BentDirectionsPush", "curvature_x") },
            const { offset("BentDirectionsPush", "curvature_y") },
        ]
        .map(float),
    };
    let fans = fans_of(&directions);
    let (field, border) = (&run.scene.field, run.border());
    let draped = Draped { field, border, points: &points, fans: &fans, curvature };
    let got = at_texels(run, pass, directions.count());
    let [cols, rows] = run.size();
    let vectors = directions.vectors();
    let mut pairs = Vec::new();
    for at in 0..rows * cols {
        let own = f64::from(field.heights_m()[at]);
        for (i, e) in vectors.iter().enumerate() {
            let (found, what) = got[at][i];
            let mut possible = Vec::new();
            for (with, there) in draped.movers(i, at, 8.0 * EPSILON) {
                let rise = f64::from(field.heights_m()[there]) - own;
                let ways = Ways::of((field, border), curvature, [at, there], vectors[with]);
                let near = may_be_met(&ways, rise);
                possible.extend(near.iter().map(|w| {
                    let direction = bent_direction(*e, w.away_m, own, curvature);
                    (direction, bent_error(*e, *w, own, curvature))
                }));
            }
            if possible.is_empty() {
                possible.push((*e, 2.0 * EPSILON));
            }
            let off = |(p, tolerance): &(DVec3, f64)| (*p - found).abs().max_element() / tolerance;
            let best = possible.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("some");
            for c in 0..3 {
                let [got, want] = [found[c], best.0[c]];
                pairs.push(Pair { got, want, tolerance: best.1, at: [i, at / cols, at % cols] });
            }
            let want = match points.point(i, at) {
                VisiblePoint::GridPoint(_) => 1.0,
                VisiblePoint::Sky => 0.0,
                VisiblePoint::Ground => -1.0,
            };
            let at = [i, at / cols, at % cols];
            pairs.push(Pair { got: what, want, tolerance: 0.0, at });
        }
    }
    pairs
}

/// From the device's own directions.
pub(crate) fn fan_weights(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let directions = run.bent_directions();
    let fans = fans_of(&directions);
    let first = pushed(pass, const { offset("FanWeightsPush", "first_direction") }) as usize;
    let count = pass.groups[2] as usize;
    let bent = at_texels(run, pass, directions.count());
    let weights = run.floats(pass, "fan_weights").expect("written");
    let [cols, rows] = run.size();
    let grid_points = rows * cols;
    let mut pairs = Vec::new();
    for (at, aimed) in bent.iter().enumerate() {
        let e: Vec<DVec3> = aimed.iter().map(|look| look.0).collect();
        for i in first..first + count {
            let got = weights[i * grid_points + at].into();
            let (want, tolerance) = (weight(&fans, &e, i), fan_weight(&fans, &e, i));
            pairs.push(Pair { got, want, tolerance, at: [i, at / cols, at % cols] });
        }
    }
    pairs
}
