//! Indirect light at every grid point, exact except for the azimuth count.

use crate::Rgb;
use crate::indirect::mean_distance_m;
use crate::light::{Receiver, normal};
use crate::oracle::Oracle;
use crate::shared::bounced::{Along, Cast, NEARLY_RAD, radiance};
use crate::specular_gather::Series;
use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::scene::Border;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Light of one more bounce at a grid point, for albedo 1, from the exit radiance of all grid points, in `azimuths`
/// at the middles of equal parts of the circle. Weights of a whole hemisphere sum to 1.
pub fn bounce_march(oracle: &Oracle, exit: &[Rgb], azimuths: u32, row: usize, col: usize) -> Rgb {
    radiance(&visible_intervals_along(oracle, exit, azimuths, [row, col]))
}

/// Its visible intervals, azimuth by azimuth.
pub fn visible_intervals_along(
    oracle: &Oracle,
    exit: &[Rgb],
    azimuths: u32,
    place: [usize; 2],
) -> Vec<Along> {
    assert_eq!(exit.len(), oracle.field().rows() * oracle.field().cols());
    intervals_of(oracle, azimuths, place, |at, _| exit[at])
}

/// As [`visible_intervals_along`], with exit radiance by direction: SH series of `order`.
pub fn visible_series_along(
    oracle: &Oracle,
    (order, exit): (usize, &[Series]),
    azimuths: u32,
    place: [usize; 2],
) -> Vec<Along> {
    intervals_of(oracle, azimuths, place, |at, towards| {
        let terms = exit[at].iter().zip(evaluate(order, towards));
        terms.fold([0.0; 3], |sum, (s, y)| [0, 1, 2].map(|c| sum[c] + s[c] * y))
    })
}

/// Visible intervals along all azimuths. `leaving` gives a grid point's exit radiance in a direction; each interval takes the
/// direction from its middle to the receiver.
fn intervals_of(
    oracle: &Oracle,
    azimuths: u32,
    [row, col]: [usize; 2],
    leaving: impl Fn(usize, DVec3) -> Rgb,
) -> Vec<Along> {
    let field = oracle.field();
    let receiver = Receiver::diffuse(normal(field, oracle.border(), row, col));
    let along = |k: u32| {
        let azimuth_rad = TAU * (f64::from(k) + 0.5) / f64::from(azimuths);
        let slice = receiver.slice(azimuth_rad);
        let whole = slice.light(-FRAC_PI_2, FRAC_PI_2);
        let intervals = oracle.nearly_visible([row, col], azimuth_rad, NEARLY_RAD);
        let casts = intervals.iter().filter(|interval| interval.high_rad > slice.low - NEARLY_RAD);
        let cast = |interval: &crate::profile::VisibleInterval| {
            let [low_rad, high_rad] =
                [interval.low_rad, interval.high_rad].map(|w| w.max(slice.low));
            let (up, flat) = (0.5 * (low_rad + high_rad)).sin_cos();
            let (sin, cos) = azimuth_rad.sin_cos();
            let towards = -DVec3::new(flat * cos, flat * sin, up);
            let corners = oracle.corners(interval.triangle);
            let from = corners.map(|[r, c]| leaving(r * field.cols() + c, towards));
            let shares = interval.corner_weights(mean_distance_m(&slice, interval));
            let [rise_m, steepest] = land_around(oracle, interval.triangle, [row, col]);
            let of = |c: usize| from.map(|corner| corner[c]);
            let mean = |c: usize| of(c).iter().zip(shares).map(|(l, s)| l * s).sum::<f64>();
            Cast {
                low_rad,
                high_rad,
                weight: slice.light(interval.low_rad, interval.high_rad).max(0.0),
                facing: slice.at(high_rad) * high_rad.cos(),
                // SH series ring.
                radiance: [0, 1, 2].map(|c| mean(c).max(0.0)),
                spread: [0, 1, 2].map(|c| {
                    of(c).iter().fold(f64::MIN, |m, l| m.max(*l))
                        - of(c).iter().fold(f64::MAX, |m, l| m.min(*l))
                }),
                distance: interval.end_m(),
                rise_m,
                steepest,
                ..Cast::default()
            }
        };
        Along { azimuth_rad, low_rad: slice.low, whole, casts: casts.map(cast).collect() }
    };
    (0..azimuths).map(along).collect()
}

/// The largest rise from a grid point to the corners of a triangle's cell and of those around it, and the steepest
/// slope between neighbours there.
fn land_around(oracle: &Oracle, triangle: usize, [row, col]: [usize; 2]) -> [f64; 2] {
    let field = oracle.field();
    let [[r, c], ..] = oracle.corners(triangle);
    let [cell_x, cell_y] = field.cell_m();
    let own = oracle.vertex(row as f64, col as f64);
    let at = |down: usize, right: usize| {
        let place = |i: usize, more: usize, n: usize| match oracle.border() {
            Border::Periodic => (i + more + n - 1) % n,
            Border::Plane | Border::Open => (i + more).saturating_sub(1).min(n - 1),
        };
        let (r, c) = (place(r, down, field.rows()), place(c, right, field.cols()));
        oracle.vertex(r as f64, c as f64)
    };
    let (mut rise_m, mut steepest) = (0.0_f64, 0.0_f64);
    for (down, right) in (0..16).map(|i| (i / 4, i % 4)) {
        let here = at(down, right);
        rise_m = rise_m.max((here - own).abs());
        for (down, right, distance) in [
            (down, right + 1, cell_x),
            (down + 1, right, cell_y),
            (down + 1, right + 1, cell_x.min(cell_y)),
        ] {
            if down < 4 && right < 4 {
                steepest = steepest.max((at(down, right) - here).abs() / distance);
            }
        }
    }
    [rise_m, steepest]
}
