//! The oracle against closed forms, each derived in a comment.

use proptest::prelude::*;
use ridgelight::scene::{Border, HeightField};
use ridgelight_cpu::oracle::{Oracle, PERIOD_CAP, grid_direction};

use crate::{BORDERS, field};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Uneven heights from an integer hash, 0..1 m in steps of 1/65536: exact in f32.
fn noise(row: usize, col: usize) -> f64 {
    let mut x = (row as u64 * 0x9E37_79B9 + col as u64 * 0x85EB_CA6B) ^ 0x5bd1_e995;
    x = (x ^ (x >> 15)).wrapping_mul(0x2545_F491_4F6C_DD1D);
    ((x >> 40) & 0xffff) as f64 / 65536.0
}

/// Flat ground: every vertex is at slope exactly 0, none is the only one.
#[test]
fn flat_ground_has_its_horizon_at_zero_and_no_unique_occluder() {
    let flat = field(9, 9, [2.0, 3.0], |_, _| 17.0);
    for border in BORDERS {
        for k in 0..16 {
            let met = Oracle::one_ray(&flat, border).horizon(4, 4, TAU * k as f64 / 16.0).unwrap();
            assert_eq!(met.slope, 0.0);
            assert!(!met.unique);
        }
    }
    assert_eq!(
        Oracle::one_ray(&flat, Border::Open).elevation_rad(0, 0, PI),
        -FRAC_PI_2,
        "leaves at once"
    );
    assert_eq!(Oracle::one_ray(&flat, Border::Plane).elevation_rad(0, 0, PI), 0.0);
    assert_eq!(
        Oracle::one_ray(&flat, Border::Plane).horizon(0, 4, FRAC_PI_2),
        None,
        "north of the first row"
    );
    assert!(Oracle::one_ray(&flat, Border::Plane).horizon(0, 4, PI).is_some(), "along the edge");
}

/// A plane of slope s rising towards azimuth u: along azimuth φ, tan h = s·cos(φ - u), also with
/// cells that are not square. Heights are rounded to f32: with |offset| ≤ H each is off by at most
/// H·2⁻²⁴ and a vertex half a cell away or more makes at most 2·H·2⁻²⁴ / (0.5·smallest cell) of it.
#[test]
fn a_ramp_has_slope_times_cosine_at_every_azimuth() {
    for cell in [[1.0, 1.0], [30.0, 22.5], [1e-3, 5e-3]] {
        for (s, up) in [(0.5_f64, 0.3_f64), (2.0, 4.0), (1e-6, 1.0), (1e3, 2.0)] {
            let (rows, cols) = (13, 17);
            let ramp = field(rows, cols, cell, |r, c| {
                let (x, y) = (c as f64 * cell[0], (rows - 1 - r) as f64 * cell[1]);
                s * (x * up.cos() + y * up.sin())
            });
            let extent = (cols as f64 * cell[0]).hypot(rows as f64 * cell[1]) * s;
            let smallest = cell[0].min(cell[1]);
            let tolerance = 2.0 * extent / 2f64.powi(24) / (0.5 * smallest) + 1e-12 * s;
            for k in 0..64 {
                let azimuth = TAU * k as f64 / 64.0;
                let expected = s * (azimuth - up).cos();
                let met = Oracle::one_ray(&ramp, Border::Open).horizon(6, 8, azimuth).unwrap();
                assert!((met.slope - expected).abs() <= tolerance, "{cell:?} {s} {k} {met:?}");
                let plane = Oracle::one_ray(&ramp, Border::Plane).elevation_rad(6, 8, azimuth);
                assert_eq!(plane, met.slope.atan().max(0.0));
            }
        }
    }
}

/// A wall of height H whose foot and top stand at columns 19 and 20: from column c the top is at
/// d = (20 - c)·cell_x / cos φ along φ, so tan h = H·cos φ / ((20 - c)·cell_x). The far side is level
/// with the top, so nothing further competes.
#[test]
fn a_wall_is_seen_at_its_height_over_its_distance() {
    let wall = field(41, 30, [2.0, 0.5], |_, c| if c >= 20 { 8.0 } else { 0.0 });
    for col in [0, 7, 18, 19] {
        for degrees in [-5.0_f64, -1e-6, 0.0, 1e-6, 3.0, 10.0] {
            let azimuth = degrees.to_radians();
            let d = (20 - col) as f64 * 2.0 / azimuth.cos();
            if d * azimuth.tan().abs() > 19.0 * 0.5 {
                continue; // leaves through the north or south edge before the wall
            }
            let met = Oracle::one_ray(&wall, Border::Plane).horizon(20, col, azimuth).unwrap();
            assert!((met.slope - 8.0 / d).abs() < 1e-12 * met.slope, "{col} {degrees} {met:?}");
            // From the foot itself the flank is in line with the top.
            if col != 19 {
                assert!(met.unique);
                assert!((met.distance_m - d).abs() < 1e-12 * d && (met.col - 20.0).abs() < 1e-9);
            }
        }
    }
    // West of the wall nothing: 0 under plane, the flat ground's 0 under open.
    assert_eq!(Oracle::one_ray(&wall, Border::Open).elevation_rad(20, 10, PI), 0.0);
    // On the top, 1 column from the brink, looking west: the brink itself, level.
    assert_eq!(Oracle::one_ray(&wall, Border::Open).horizon(20, 21, PI).unwrap().slope, 0.0);
}

/// One texel of height H on a plain: from any texel on an exact line to it (columns p, rows q
/// away), tan h = H / (its distance): over the last edge before it the surface rises linearly from 0
/// to H, and (rise / distance) grows to the spike.
#[test]
fn a_single_spike_is_seen_from_its_whole_line() {
    let cell = [3.0, 2.0];
    let spike = field(61, 67, cell, |r, c| if (r, c) == (30, 33) { 50.0 } else { 0.0 });
    for (p, q) in [(1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (-3, 2), (5, -7), (-1, -1), (0, -1)] {
        for steps in 1..=4 {
            let (row, col) = (30 - q * steps, 33 - p * steps);
            let met = Oracle::one_ray(&spike, Border::Plane)
                .horizon_along(row as usize, col as usize, [f64::from(p), f64::from(q)])
                .unwrap();
            let d = (f64::from(p * steps) * cell[0]).hypot(f64::from(q * steps) * cell[1]);
            assert!((met.slope - 50.0 / d).abs() < 1e-14 * met.slope, "{p} {q} {steps} {met:?}");
            assert_eq!((met.row, met.col), (30.0, 33.0));
            assert!(met.unique);
        }
    }
    // Beside the line by less than a cell: a lower point of the spike's flank. From 10 columns west,
    // aimed 0.25 rows low at the spike's column: height 50·0.75 there.
    let met = Oracle::one_ray(&spike, Border::Plane).horizon_along(30, 23, [10.0, 0.25]).unwrap();
    assert!(met.slope * (10.0 * 3.0_f64).hypot(0.25 * 2.0) >= 50.0 * 0.75);
}

/// The split runs from (r, c) to (r + 1, c + 1): the middle of a cell whose other two corners are
/// raised by 1 is at height 0, of one whose split corners are raised at height 1. From the corner
/// opposite, along the other diagonal, the middle stands half a diagonal away.
#[test]
fn the_cell_is_split_along_the_row_and_column_diagonal() {
    // Looking from (1, 0) to (0, 1) across the split (0, 0)-(1, 1).
    let ridge = field(2, 2, [1.0, 1.0], |r, c| if r == c { 1.0 } else { 0.0 });
    let met = Oracle::one_ray(&ridge, Border::Open).horizon_along(1, 0, [1.0, -1.0]).unwrap();
    assert!((met.slope - 1.0 / 0.5_f64.sqrt()).abs() < 1e-15 && met.unique);
    assert_eq!((met.row, met.col), (0.5, 0.5));
    // The other way round the split is a valley: the far corner, level with the receiver, wins.
    let valley = field(2, 2, [1.0, 1.0], |r, c| if r == c { 0.0 } else { 1.0 });
    let met = Oracle::one_ray(&valley, Border::Open).horizon_along(1, 0, [1.0, -1.0]).unwrap();
    assert_eq!((met.slope, met.row, met.col), (0.0, 0.0, 1.0));
}

/// A dome of heights strictly concave along every line: the slope of the chord falls with distance,
/// so the first vertex wins, the adjacent texel on axis-aligned lines. h = -x² from texel i to its
/// neighbour i + 1: slope -(2i + 1).
#[test]
fn on_a_dome_the_adjacent_sample_wins() {
    let dome = field(41, 41, [1.0, 1.0], |r, c| {
        let (x, y) = (c as f64 - 20.0, r as f64 - 20.0);
        -(x * x + y * y)
    });
    for col in 0..40_usize {
        let met = Oracle::one_ray(&dome, Border::Open).horizon(20, col, 0.0).unwrap();
        assert_eq!(met.slope, -(2.0 * (col as f64 - 20.0) + 1.0));
        assert_eq!((met.col, met.distance_m), ((col + 1) as f64, 1.0));
        assert!(met.unique);
    }
}

/// A cone -s·ρ of slope s around a texel: from its tip every vertex is at slope -s on axes (linear),
/// and the elevation is -atan s under open, 0 under plane. A funnel s·ρ: atan s along the axes.
#[test]
fn a_funnel_has_the_same_horizon_along_all_axes() {
    for s in [0.25, -0.25] {
        let cone =
            field(21, 21, [4.0, 4.0], |r, c| s * 4.0 * (r as f64 - 10.0).hypot(c as f64 - 10.0));
        // Heights up to 14.2 m are rounded to f32 and met from 2 m on.
        let rounding = 2.0 * 14.2 / 2f64.powi(24) / 2.0;
        for k in 0..4 {
            let met =
                Oracle::one_ray(&cone, Border::Open).horizon(10, 10, FRAC_PI_2 * k as f64).unwrap();
            assert!((met.slope - s).abs() < rounding);
        }
        // Off the axes linear interpolation of a funnel lies above it (of a cone below) by at most
        // its sagitta over a cell's diagonal, |s|·(√2·4)²/(8ρ), which turns the slope by
        // |s|·4/ρ²: |s|/2 at the first vertex, ρ² ≥ 8; |s|·4/1600 at the rim, where the cone,
        // bent down least, has its highest slope or a higher one.
        let most = if s > 0.0 { s / 2.0 } else { -s * 4.0 / 1600.0 };
        for k in 0..32 {
            let met = Oracle::one_ray(&cone, Border::Open)
                .horizon(10, 10, TAU * k as f64 / 32.0)
                .unwrap();
            let steeper = (met.slope - s) * s.signum();
            assert!((-rounding..=most + rounding).contains(&steeper), "{k} {steeper}");
        }
    }
}

/// A field turned by 180° or mirrored in its split diagonal is the same surface: answers move with
/// it. By 90° the split turns and only lines along the axes keep their profile: bit-equal there.
#[test]
fn rotated_and_transposed_fields_have_rotated_horizons() {
    let (rows, cols) = (23, 31);
    let original = field(rows, cols, [1.0, 2.0], noise);
    let half_turn = field(rows, cols, [1.0, 2.0], |r, c| noise(rows - 1 - r, cols - 1 - c));
    let transposed = field(cols, rows, [2.0, 1.0], |r, c| noise(c, r));
    // A quarter turn counter-clockwise: east becomes north, texel (r, c) goes to (cols-1-c, r).
    let quarter = field(cols, rows, [2.0, 1.0], |r, c| noise(c, cols - 1 - r));
    for (row, col) in [(0, 0), (11, 15), (22, 30), (3, 29), (17, 2)] {
        for (p, q) in [(1, 0), (0, -1), (3, 1), (-2, 5), (-1, -1), (1, -1), (7, -4)] {
            let direction = [f64::from(p), f64::from(q)];
            let slope = |f: &HeightField, r, c, d| {
                Oracle::one_ray(f, Border::Open)
                    .horizon_along(r, c, d)
                    .map_or(f64::NEG_INFINITY, |h| h.slope)
            };
            let here = slope(&original, row, col, direction);
            let turned =
                slope(&half_turn, rows - 1 - row, cols - 1 - col, [-direction[0], -direction[1]]);
            let mirrored = slope(&transposed, col, row, [direction[1], direction[0]]);
            // Interpolation starts from the other end: a few roundings of heights below 1.
            for other in [turned, mirrored] {
                assert!(here == other || (here - other).abs() < 1e-13, "{here} {other}");
            }
        }
        for k in 0..4 {
            let azimuth = FRAC_PI_2 * k as f64;
            let here = Oracle::one_ray(&original, Border::Plane).horizon(row, col, azimuth);
            let there = Oracle::one_ray(&quarter, Border::Plane).horizon(
                cols - 1 - col,
                row,
                azimuth + FRAC_PI_2,
            );
            assert_eq!(here.map(|h| h.slope), there.map(|h| h.slope));
        }
    }
}

/// Fields without a cell, and the smallest with some.
#[test]
fn degenerate_sizes_have_horizons() {
    let one = field(1, 1, [1.0, 1.0], |_, _| 5.0);
    let row = field(1, 5, [2.0, 1.0], |_, c| if c == 3 { 3.0 } else { 0.0 });
    let column = field(5, 1, [1.0, 2.0], |r, _| if r == 3 { 3.0 } else { 0.0 });
    for k in 0..32 {
        let azimuth = TAU * k as f64 / 32.0;
        assert_eq!(Oracle::one_ray(&one, Border::Open).horizon(0, 0, azimuth), None);
        assert_eq!(Oracle::one_ray(&one, Border::Periodic).elevation_rad(0, 0, azimuth), 0.0);
        // 3 m at 3 columns of 2 m: only straight east; every other azimuth leaves the line.
        let east = if k == 0 { (0.5_f64).atan() } else { 0.0 };
        assert_eq!(Oracle::one_ray(&row, Border::Plane).elevation_rad(0, 0, azimuth), east);
        let south = if k == 24 { (0.5_f64).atan() } else { 0.0 };
        assert_eq!(Oracle::one_ray(&column, Border::Plane).elevation_rad(0, 0, azimuth), south);
    }
    // 2 × 3, aimed from a corner at the opposite one: 2 columns and 1 row of 1 m, 4 m up.
    let six = field(2, 3, [1.0, 1.0], |r, c| if (r, c) == (0, 2) { 4.0 } else { 0.0 });
    let azimuth = 1_f64.atan2(2.0);
    let met = Oracle::one_ray(&six, Border::Open).horizon(1, 0, azimuth).unwrap();
    assert!((met.slope - 4.0 / 5_f64.sqrt()).abs() < 1e-12, "{met:?}");
}

/// Slopes 1/2, 3/2, 1, 1/4 at the four texels: the best beats the third by 1/2, in either direction
/// of the walk; with 2 in place of 3/2's neighbour the margin is that of the pair.
#[test]
fn the_margin_is_that_over_the_best_other_place() {
    let row = field(1, 5, [1.0, 1.0], |_, c| [0.0, 0.5, 3.0, 3.0, 1.0][c]);
    let met = Oracle::one_ray(&row, Border::Plane).horizon(0, 0, 0.0).unwrap();
    assert_eq!((met.slope, met.col, met.margin, met.unique), (1.5, 2.0, 0.5, true));
    let row = field(1, 5, [1.0, 1.0], |_, c| [0.0, 0.5, 3.0, 4.5, 4.0][c]);
    let met = Oracle::one_ray(&row, Border::Plane).horizon(0, 0, 0.0).unwrap();
    assert_eq!((met.slope, met.margin, met.unique), (1.5, 0.0, false));
}

/// Aimed by its azimuth from a corner at the opposite one, the ray's crossings round to either side
/// of it; the corner is met all the same: tan h = H/d to the rounding of the crossing, which is a few
/// units in the last place of 40 cells of the field's size, on a flank of H a cell.
#[test]
fn corners_are_hit_whatever_the_rounding() {
    for p in 1..=40_usize {
        for q in 1..=40_usize {
            let cell = [0.3, 0.7];
            let corner = field(q + 1, p + 1, cell, |r, c| if (r, c) == (0, p) { 1.0 } else { 0.0 });
            let (x, y) = (p as f64 * cell[0], q as f64 * cell[1]);
            let met = Oracle::one_ray(&corner, Border::Open).horizon(q, 0, y.atan2(x)).unwrap();
            assert!((met.slope * x.hypot(y) - 1.0).abs() < 1e-12, "{p} {q} {met:?}");
        }
    }
}

/// Periodic: a ridge line every 10 columns of height 5, visible from 7 columns west of it at 5/7, from 3 columns east of
/// it looking east at 5/7 too, across the seam. On the ridge everything is at most level: 0.
#[test]
fn a_periodic_field_occludes_across_its_seam() {
    let ridge = field(4, 10, [1.0, 1.0], |_, c| if c == 2 { 5.0 } else { 0.0 });
    let met = Oracle::one_ray(&ridge, Border::Periodic).horizon(1, 5, 0.0).unwrap();
    assert_eq!((met.slope, met.col, met.row), (5.0 / 7.0, 12.0, 1.0));
    assert!(met.unique);
    for k in 0..9 {
        assert_eq!(Oracle::one_ray(&ridge, Border::Periodic).elevation_rad(0, 2, k as f64), 0.0);
    }
    // Shifting the field by any amount changes nothing.
    let shifted = field(7, 9, [1.0, 3.0], |r, c| noise((r + 3) % 7, (c + 4) % 9));
    let original = field(7, 9, [1.0, 3.0], noise);
    for k in 0..40 {
        let azimuth = TAU * (k as f64 + 0.3) / 40.0;
        let a = Oracle::one_ray(&original, Border::Periodic).elevation_rad(5, 6, azimuth);
        let b = Oracle::one_ray(&shifted, Border::Periodic).elevation_rad(2, 2, azimuth);
        // Coordinates up to the cap of 64·27 m are rounded at 2e-13, heights are 1 m a cell.
        assert!((a - b).abs() < 1e-11, "{a} {b}");
    }
    assert_eq!(PERIOD_CAP, 64);
}

/// Voids occlude as what fills them: here the plain's own level.
#[test]
fn voids_occlude_as_they_are_filled() {
    let mut heights = vec![0.0; 49];
    heights[3 * 7 + 6] = 6.0;
    heights[3 * 7 + 2] = f64::NAN;
    let mut voids = vec![false; 49];
    voids[3 * 7 + 2] = true;
    let holed = HeightField::new(7, 7, &heights, [1.0, 1.0], Some(voids)).unwrap();
    let met = Oracle::one_ray(&holed, Border::Plane).horizon(3, 0, 0.0).unwrap();
    assert_eq!((met.slope, met.col), (1.0, 6.0));
}

/// Rounded azimuths of the axes are the axes, small angles beside them are not.
#[test]
fn axis_azimuths_are_exact() {
    let square = field(3, 3, [2.0, 4.0], |_, _| 0.0);
    assert_eq!(grid_direction(&square, PI), [-0.5, 0.0]);
    assert_eq!(grid_direction(&square, 1.5 * PI), [0.0, 0.25]);
    assert!(grid_direction(&square, PI + 1e-12)[1] > 0.0);
}

proptest! {
    /// No vertex is missed: sampling the surface finely along the ray by a different route (barycentric, point by
    /// point) never finds a higher slope, and finds one as close to it as the sampling step allows.
    #[test]
    fn no_point_of_the_surface_is_above_the_horizon(
        row in 0_usize..12, col in 0_usize..9, azimuth in 0.0..TAU, steep in 0.01_f64..100.0,
    ) {
        let cell = [1.5, 0.7];
        let rough = field(12, 9, cell, |r, c| steep * noise(r, c));
        let [dc, dr] = grid_direction(&rough, azimuth);
        let h = |r: usize, c: usize| f64::from(rough.heights_m()[r.min(11) * 9 + c.min(8)]);
        let surface = |r: f64, c: f64| {
            let (r0, c0) = (r.floor().min(10.0), c.floor().min(7.0));
            let (v, u, i, j) = (r - r0, c - c0, r0 as usize, c0 as usize);
            // Two triangles: (0,0) (1,1) and the corner on the point's side of the split.
            if v > u {
                h(i, j) * (1.0 - v) + h(i + 1, j + 1) * u + h(i + 1, j) * (v - u)
            } else {
                h(i, j) * (1.0 - u) + h(i + 1, j + 1) * v + h(i, j + 1) * (u - v)
            }
        };
        let met = Oracle::one_ray(&rough, Border::Open).horizon(row, col, azimuth);
        let oracle = Oracle::new(&rough, Border::Open);
        // Ending early changes no part of the answer.
        prop_assert_eq!(met, oracle.horizon(row, col, azimuth));
        let mut best = f64::NEG_INFINITY;
        for i in 1..40_000 {
            let d = i as f64 * 5e-4;
            let (r, c) = (row as f64 + d * dr, col as f64 + d * dc);
            if !(0.0..=11.0).contains(&r) || !(0.0..=8.0).contains(&c) {
                break;
            }
            best = best.max((surface(r, c) - h(row, col)) / d);
        }
        if let Some(met) = met {
            // Below: rounding of slopes at the first sampled distance. Above: one step of the
            // sampling, over which the profile changes by at most 2·steep per 0.35 m (half a cell),
            // so the slope by twice that share of a step at the occluder's distance.
            prop_assert!(best <= met.slope + 1e-11 * steep);
            let step = 5e-4 * (2.0 * steep / 0.35) * 2.0 / met.distance_m;
            prop_assert!(met.slope - best <= step + 1e-11 * steep, "{:?} {}", met, best);
        } else {
            prop_assert!(best == f64::NEG_INFINITY);
        }
    }
}
