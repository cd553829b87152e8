//! `bounce_walk` against every step of the texels' own lines, the f64 quadrature, and closed forms.

use crate::horizon::*;
use glam::DVec2;
use ridgelight::plan::azimuths::even;
use ridgelight::scene::Fuse;
use ridgelight::scene::fractal;
use ridgelight_cpu::bounce_march::bounce_march;
use ridgelight_cpu::bounce_walk::{Walked, bounce_walk, walked_along};
use ridgelight_cpu::line_blocks::Ground;
use ridgelight_cpu::shared::bounced::light_and_weight;
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::shared::fuse::{split_crossing, surface_on_line};
use ridgelight_cpu::shared::gather::{Swept, elevation_moments};
use ridgelight_cpu::shared::sweep::March;
use ridgelight_cpu::sky_shade::sky_at;
use ridgelight_cpu::tolerance::EPSILON;
use std::f64::consts::PI;

/// Sweeps a field and passes it to `of`.
fn with_swept<T>(
    field: &HeightField,
    border: Border,
    azimuths: &mut [Azimuth],
    of: impl FnOnce(&Swept) -> T,
) -> T {
    let warm_up = warm_ups(field, border);
    let lattices = swept(field, border, azimuths, warm_up, SweepOptions::default());
    of(&Swept {
        heights: Heights::of(field, border),
        azimuths,
        lattices: &lattices,
        fuse: None,
        line_shift: 15,
        warm_up,
    })
}

/// Indirect light of flat white ground everywhere: the share of ground in a texel's view, by testing every step
/// of its own line.
fn share_of_ground(swept: &Swept, azimuth: &Azimuth, col: i32, row: i32) -> f64 {
    let march = March::new(swept.heights, azimuth);
    let (lane, step) = march.of_grid_point(col, row);
    let own = swept.heights.at(col, row);
    let gradient = field_slope(&swept.heights, col, row);
    let plane = gradient.dot(DVec2::new(azimuth.cos_phi.into(), azimuth.sin_phi.into())) as f32;
    let mut reached = plane;
    let mut back = 1;
    while let Some(h) = surface_on_line(&march, lane * CELL - back * azimuth.shear, step - back) {
        reached = reached.max((h - own) / (back as f32 * azimuth.step_m));
        back += 1;
    }
    if back > 1 {
        let split = split_crossing(&march, (lane, step), own);
        reached = split.map_or(reached, |split| reached.max(split.slope));
    }
    let normal = normal_of(gradient);
    let flat = DVec2::new(azimuth.wedge_cos.into(), azimuth.wedge_sin.into());
    let moments = [plane, reached].map(|s| elevation_moments(s.into()));
    let weight = |m: [f64; 2]| {
        normal.truncate().dot(flat) * m[0] + normal.z * f64::from(azimuth.wedge_rad) * m[1]
    };
    weight(moments[0]) - weight(moments[1])
}

fn rough(rows: usize, cols: usize, relief: f64) -> HeightField {
    field(rows, cols, [3.0, 2.0], |r, c| relief * noise(7, r, c))
}

/// Along the grid and its diagonals every texel's own line is a swept one: the walk matches the test of every
/// step to the last bit, and visible intervals fill the elevations without gap or overlap. In other azimuths
/// the walk uses the neighbouring line: it never finds more.
#[test]
fn walks_match_every_step_along_swept_lines() {
    for (i, (rows, cols)) in SIZES.into_iter().chain([(24, 31)]).enumerate() {
        let rough = rough(rows, cols, 9.0 + i as f64);
        let white = vec![[1.0_f32; 3]; rows * cols];
        for border in [Border::Plane, Border::Open] {
            for mut azimuth in even(16, [3.0, 2.0]) {
                with_swept(&rough, border, std::slice::from_mut(&mut azimuth), |swept| {
                    let azimuth = &swept.azimuths[0];
                    for at in 0..rows * cols {
                        let (col, row) = ((at % cols) as i32, (at / cols) as i32);
                        let walked = bounce_walk(swept, &white, col, row);
                        let want = share_of_ground(swept, azimuth, col, row);
                        let off = walked.light.x - want;
                        let is_own = azimuth.shear == 0 || azimuth.shear == CELL;
                        assert!(off <= 1e-12, "{azimuth:?} {row} {col}: {walked:?} {want}");
                        assert!(!is_own || off >= -1e-12, "{azimuth:?}: {walked:?} {want}");
                        let longest = rows.max(cols) as u32;
                        assert!(walked.turns < longest && walked.visible_intervals <= longest + 1);
                    }
                });
            }
        }
    }
}

/// A block in closed form: an incline of rise R and radiance 1, and behind its top a pit of radiance 0, n steps each. The
/// pit has its additional rise f alone, so the mean is (R + n f) / (R + 2 n f), but for the hidden piece down into the pit,
/// whose radiance is that of both ends. The top lies where the incline ends.
#[test]
fn hidden_ground_hardly_counts_in_a_block() {
    const COLS: usize = 65;
    let (half, rise) = (8, 5.0);
    // From west to east: a pit, then an incline down to the grid point in the east.
    let height = |c: usize| match c {
        0..=7 => -3.0,
        _ => rise * (16.0 - (c as f64).min(16.0)) / f64::from(half),
    };
    let valley = field(2, COLS, [1.0, 1.0], |_, c| height(c));
    let exit: Vec<[f32; 3]> =
        (0..2 * COLS).map(|i| [if i % COLS >= 8 { 1.0 } else { 0.0 }; 3]).collect();
    let azimuths = even(4, [1.0, 1.0]);
    let west = azimuths.iter().find(|a| a.cos_phi < -0.9).expect("one of four");
    let march = March::new(Heights::of(&valley, Border::Plane), west);
    let ground = Ground { march, exit: &exit };
    let (_, end) = march.of_grid_point(16, 0);
    let block = ground.line_block((0, end), 4);
    let flat = f64::from(half) * 1e-3;
    let hidden = 0.5 / f64::from(half);
    let want = (rise + flat + flat * hidden) / (rise + 2.0 * flat);
    assert!((block.light.x - want).abs() < 1e-9, "{} {want}", block.light.x);
    assert_eq!((block.top_m + valley.base_m() as f32, block.top_steps), (rise as f32, half));
}

/// An incline of radiance equal to the height, from flat ground before it: the visible parts of walks fill the
/// elevations, and each has a mean within its radiances. So the light is that of the integral along the line, here by 4,000 trapezoids, but
/// for each part's weight times the range of its radiance. A part at distance x is 2 steps long or at most x / 4, and the
/// incline rises by half of that: the integral of those rises is above the sum of the ranges, but for the roundings of f32.
#[test]
fn walks_up_an_incline_match_the_integral() {
    const COLS: usize = 200;
    let foot = 20.0;
    let height = |c: f64| 0.5 * (180.0 - foot - c).max(0.0);
    let slope = field(2, COLS, [1.0, 1.0], |_, c| height(c as f64));
    let exit: Vec<[f32; 3]> =
        (0..2 * COLS).map(|i| [height((i % COLS) as f64) as f32; 3]).collect();
    let mut azimuths = even(4, [1.0, 1.0]);
    azimuths.retain(|a| a.cos_phi < -0.9);
    with_swept(&slope, Border::Plane, &mut azimuths, |swept| {
        let (all, _) = walked_along(swept, &exit, 180, 0);
        let (light, _) = light_and_weight(&all);
        let casts = &all[0].casts;
        let bound: f64 = casts.iter().map(|c| c.weight * c.spread[0]).sum();
        let azimuth = &swept.azimuths[0];
        let weight =
            |x: f64| f64::from(azimuth.wedge_rad) * elevation_moments(height(180.0 - x) / x)[1];
        const PARTS: usize = 4000;
        let at = |i: usize| foot + (180.0 - foot) * i as f64 / PARTS as f64;
        let want: f64 = (1..=PARTS)
            .map(|i| {
                let [a, b] = [at(i - 1), at(i)];
                0.5 * (height(180.0 - a) + height(180.0 - b)) * (weight(a) - weight(b))
            })
            .sum();
        println!("{} {want}, {bound}", light[0]);
        let longest: f64 = (1..=PARTS)
            .map(|i| {
                let [a, b] = [at(i - 1), at(i)];
                0.5 * (b / 4.0).max(2.0) * (weight(a) - weight(b)).abs()
            })
            .sum();
        let slack = 1.0 + 1e3 * EPSILON;
        assert!(casts.iter().any(|c| c.is_block) && bound < slack * longest, "{bound} {longest}");
        assert!(longest < want, "{longest} {want}");
        assert!((light[0] - want).abs() < bound, "{} {want} {bound}", light[0]);
    });
}

/// RMSE over the mean of the ground truth.
fn relative(got: &[f64], want: &[f64]) -> f64 {
    let squares: f64 = got.iter().zip(want).map(|(a, b)| (a - b).powi(2)).sum();
    let mean = want.iter().sum::<f64>() / want.len() as f64;
    (squares / want.len() as f64).sqrt() / mean
}

/// Walks of every texel.
fn walks(field: &HeightField, border: Border, azimuths: u32, exit: &[[f32; 3]]) -> Vec<Walked> {
    let mut azimuths = even(azimuths, field.cell_m());
    with_swept(field, border, &mut azimuths, |swept| {
        swept.per_grid_point(|col, row| bounce_walk(swept, exit, col, row))
    })
}

/// On a surface divided more finely, the walk, which uses whole steps only, tends to the quadrature over every
/// crossing as the steps halve. The error depends on ridges between steps. The light is linear between heights,
/// like the surface.
#[test]
fn walks_tend_to_the_quadrature() {
    let coarse = fractal(16, 3).unwrap();
    let h = |r: usize, c: usize| f64::from(coarse.heights_m()[r.min(15) * 16 + c.min(15)]);
    let cut = |parts: usize| {
        let side = 15 * parts + 1;
        field(side, side, coarse.cell_m().map(|c| c / parts as f64), |r, c| {
            let (down, right) = ((r % parts) as f64, (c % parts) as f64);
            let (low, high) = (down.min(right) / parts as f64, down.max(right) / parts as f64);
            let (r, c) = (r / parts, c / parts);
            let between = if down > right { h(r + 1, c) } else { h(r, c + 1) };
            (1.0 - high) * h(r, c) + (high - low) * between + low * h(r + 1, c + 1)
        })
    };
    let errors = [1, 2, 4].map(|parts| {
        let field = cut(parts);
        let low = field.heights_m().iter().fold(f32::MAX, |m, h| m.min(*h));
        let exit: Vec<[f32; 3]> = field.heights_m().iter().map(|h| [h - low; 3]).collect();
        let oracle = Oracle::new(&field, Border::Plane);
        let wide: Vec<[f64; 3]> = exit.iter().map(|e| e.map(f64::from)).collect();
        let side = 15 * parts + 1;
        let places: Vec<usize> = (0..256).map(|i| (i / 16 * side + i % 16) * parts).collect();
        let want: Vec<f64> = places
            .iter()
            .map(|at| bounce_march(&oracle, &wide, 96, at / side, at % side)[0])
            .collect();
        let all = walks(&field, Border::Plane, 96, &exit);
        let got: Vec<f64> = places.iter().map(|at| all[*at].radiance()[0]).collect();
        relative(&got, &want)
    });
    println!("off by {errors:?}");
    assert!(errors[1] < 0.8 * errors[0] && errors[2] < 0.8 * errors[1], "{errors:?}");
}

/// A valley between two planes of slope 1, white on one side up to the ridge: a texel on the dark side at s from the
/// bottom sees the whole white side, of length a, over ½ (1 - s/√(s² + a²)) of its hemisphere, 1/8 s² less, as
/// radiance is linear between the bottom and the first white texel. The rule over azimuths is smooth and periodic.
/// Ground beyond 512 rows is not visited: at most 1 - cos of the angle at which the wall ends there, tan = 2a/512.
#[test]
fn a_white_wall_lights_a_black_one() {
    let (rows, half) = (128, 24);
    let cols = 2 * half;
    let valley = field(rows, cols, [1.0, 1.0], |_, c| (c as f64 - half as f64).abs());
    let white = |radiance: f32| -> Vec<[f32; 3]> {
        (0..rows * cols)
            .map(|i| [if i % cols > half || i % cols == 0 { radiance } else { 0.0 }; 3])
            .collect()
    };
    let mut azimuths = even(64, [1.0, 1.0]);
    with_swept(&valley, Border::Periodic, &mut azimuths, |swept| {
        let lit = |exit: &[[f32; 3]], away: usize| {
            bounce_walk(swept, exit, (half - away) as i32, 70).radiance()[0]
        };
        for away in [4, 8, 12, 20] {
            let (s, wall) = (away as f64, half as f64);
            let (got, want) = (lit(&white(1.0), away), 0.5 * (1.0 - s / s.hypot(wall)));
            let bound = 1.0 / (8.0 * s * s) + 1.0 - (2.0 * wall / 512.0_f64).atan().cos();
            println!("{away}: {got:.5} {want:.5}, {bound:.5}");
            assert!((got - want).abs() < bound, "{away}: {got} {want} {bound}");
        }
        assert!((lit(&white(0.5), 12) - 0.5 * lit(&white(1.0), 12)).abs() < 1e-7);
    });
}

/// Equal radiance from all directions, along the grid and its diagonals, where walks and aimed horizons use the
/// same points: the shares of sky and ground sum to one.
#[test]
fn ground_and_sky_shares_sum_to_one() {
    let rough = field(9, 12, [1.0, 1.0], |r, c| 3.0 * noise(7, r, c));
    let white = vec![[1.0_f32; 3]; 9 * 12];
    let mut azimuths = even(8, [1.0, 1.0]);
    with_swept(&rough, Border::Open, &mut azimuths, |swept| {
        let aimed = Swept { fuse: Some(Fuse::AimedNearest), ..*swept };
        for (col, row) in (0..9 * 12).map(|at| (at % 12, at / 12)) {
            let walked = bounce_walk(swept, &white, col, row);
            let sum = walked.light.x + PI * sky_at(&aimed, col, row);
            assert!((sum / walked.whole - 1.0).abs() < 1e-6, "{row} {col}: {sum}");
        }
    });
}
