//! The visible point of a grid point in a direction, in f64, by testing every surface piece along its azimuth: the
//! ground truth, which shares no code with the device's rays.

use crate::oracle::Oracle;
use crate::profile::VisibleInterval;
use glam::DVec3;
use ridgelight::scene::{Border, Directions, HeightField, VisiblePoint, VisiblePoints};
use std::f64::consts::FRAC_PI_2;

/// Visibility, 0 to 1, of a light [`around`](VisiblePoints::around) which these directions lie: the weight of those in which the
/// sky is visible.
pub fn lit_share(points: &VisiblePoints, around: &[(usize, f64); 3], grid_point: usize) -> f64 {
    let is_sky = |i: usize| points.point(i, grid_point) == VisiblePoint::Sky;
    around.iter().filter(|c| is_sky(c.0)).map(|c| c.1).sum()
}

/// The visible point of each grid point in each direction, direction after direction.
pub fn visible_points(
    field: &HeightField,
    border: Border,
    directions: &Directions,
) -> Vec<VisiblePoint> {
    let oracle = Oracle::new(field, border);
    let grid_points = field.rows() * field.cols();
    let each = directions.vectors().iter().flat_map(|e| (0..grid_points).map(move |at| (*e, at)));
    each.map(|(e, at)| visible_point(&oracle, [at / field.cols(), at % field.cols()], e)).collect()
}

/// The visible point of the grid point (row, column) in one direction.
pub fn visible_point(oracle: &Oracle, here: [usize; 2], e: DVec3) -> VisiblePoint {
    possible_within(oracle, here, e, |_| 0.0, 0.0)[0]
}

/// All possible visible points where the elevation of each visible interval's upper end has an error of
/// `elevation_rad`, and the hit one of `of_way` times its distance along either axis: first the answer without error,
/// then every other within the error.
///
/// Along an azimuth the visible intervals of the surface are stacked in elevation. The elevations within the error
/// cover part of each interval that they cross, and the sky beyond the last.
pub fn possible_within(
    oracle: &Oracle,
    [row, col]: [usize; 2],
    e: DVec3,
    elevation_rad: impl Fn(&VisibleInterval) -> f64,
    of_way: f64,
) -> Vec<VisiblePoint> {
    // Straight up or down there is no azimuth: sky, or the grid point itself.
    if e.x == 0.0 && e.y == 0.0 {
        let own = VisiblePoint::GridPoint(row * oracle.field().cols() + col);
        return vec![if e.z > 0.0 { VisiblePoint::Sky } else { own }];
    }
    let elevation = e.z.atan2(e.x.hypot(e.y));
    let intervals = oracle.visible_intervals(row, col, e.y.atan2(e.x));
    let free = intervals.last().map_or(-FRAC_PI_2, |last| last.high_rad);
    let beyond = |elevation: f64| match oracle.border() {
        Border::Plane | Border::Periodic if elevation <= 0.0 => VisiblePoint::Ground,
        _ => VisiblePoint::Sky,
    };
    let mut all = Vec::new();
    let mut add = |point| {
        if !all.contains(&point) {
            all.push(point);
        }
    };
    // The exact answer first.
    match intervals.iter().find(|interval| elevation < interval.high_rad) {
        Some(interval) => add(met(oracle, interval, interval.distance_m(elevation), [0.0; 2])),
        None => add(beyond(elevation)),
    }
    // Upper end of the interval below, where this one begins.
    let mut below = 0.0_f64;
    for interval in &intervals {
        let above = elevation_rad(interval);
        let ends = [interval.low_rad - below, interval.high_rad + above];
        let off = below.max(above);
        below = above;
        if off == 0.0 || elevation < ends[0] || elevation > ends[1] {
            continue;
        }
        let [near, far] = [elevation - off, elevation + off]
            .map(|e| interval.distance_m(e.clamp(interval.low_rad, interval.high_rad)));
        let [cell_x, cell_y] = oracle.field().cell_m();
        // Steps of a quarter of a cell skip no grid point.
        let steps = (4.0 * (far - near).abs() / cell_x.min(cell_y)).ceil().clamp(1.0, 1e5) as usize;
        for step in 0..=steps {
            let distance = near + (far - near) * step as f64 / steps as f64;
            for (down, right) in (0..9).map(|i| (i / 3 - 1, i % 3 - 1)) {
                let off = of_way * (1.0 + distance / cell_x.min(cell_y));
                add(met(oracle, interval, distance, [down, right].map(|n| f64::from(n) * off)));
            }
        }
    }
    if below > 0.0 && elevation + below >= free {
        add(beyond(elevation + below));
        add(beyond((elevation - below).max(free)));
    }
    all
}

/// The grid point nearest to a position on a visible interval, offset by `off` rows and columns.
fn met(oracle: &Oracle, interval: &VisibleInterval, at_m: f64, off: [f64; 2]) -> VisiblePoint {
    let (rows, cols) = (oracle.field().rows(), oracle.field().cols());
    let [_, second, third] = interval.corner_weights(at_m);
    let [[row, col], ..] = oracle.corners(interval.triangle);
    let is_lower = !interval.triangle.is_multiple_of(2);
    let [down, right] = if is_lower { [second + third, third] } else { [third, second + third] };
    let nearest = |first: usize, along: f64, off: f64, count: usize| {
        let place = (first as f64 + along.clamp(0.0, 1.0) + off + 0.5).floor() as i64;
        match oracle.border() {
            Border::Periodic => place.rem_euclid(count as i64) as usize,
            Border::Plane | Border::Open => place.clamp(0, count as i64 - 1) as usize,
        }
    };
    VisiblePoint::GridPoint(
        nearest(row, down, off[0], rows) * cols + nearest(col, right, off[1], cols),
    )
}
