//! The reference for direct light against closed forms.

mod passes;
mod shadow_heights;
mod shadows;
mod suns_and_keys;

use glam::DVec3;
use ridgelight::scene::{Border, Environment, HeightField, Sun};
use ridgelight_cpu::light::{ENVIRONMENT_STRIPS, environment_of, normal, sky_of, slice, sun_of};
use ridgelight_cpu::oracle::Oracle;

use crate::{BORDERS, field};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A plane of gradient (east, north); exact in f32 for small dyadic gradients.
fn plane(rows: usize, cols: usize, cell: [f64; 2], east: f64, north: f64) -> HeightField {
    field(rows, cols, cell, |r, c| {
        east * c as f64 * cell[0] + north * (rows - 1 - r) as f64 * cell[1]
    })
}

/// Error of the midpoint rule on a circle with steps h, for a slice F(φ) with continuous derivative:
/// (1/π)·(h²/8)·(variation of F'). F is at most (π/4)|A| + B/2 with A, B sinusoids of φ, and where the
/// horizon is the hemisphere's limit its own motion adds nothing (the integrand is 0 there):
/// |F''| ≤ 2, variation ≤ 4π, error ≤ h²/2.
fn circle_tolerance(azimuths: usize) -> f64 {
    0.5 * (TAU / azimuths as f64).powi(2)
}

/// The slice against Simpson's rule with 2·1000 steps: error ≤ width·(width/2000)⁴·16/180.
#[test]
fn the_slice_matches_simpsons_rule() {
    for (a, b, low, high) in
        [(0.3, 0.9, -0.4, 1.2), (-0.7, 0.7, 0.1, FRAC_PI_2), (0.5, 0.2, -1.5, 1.5)]
    {
        let f = |w: f64| (a * w.cos() + b * w.sin()) * w.cos();
        let step = (high - low) / 2000.0;
        let sum: f64 = (0..1000)
            .map(|i| {
                let w = low + 2.0 * step * f64::from(i);
                f(w) + 4.0 * f(w + step) + f(w + 2.0 * step)
            })
            .sum();
        assert!((slice(a, b, low, high) - sum * step / 3.0).abs() < 1e-11);
    }
    assert_eq!(slice(1.0, 1.0, 0.5, 0.5), 0.0);
    assert_eq!(slice(1.0, 1.0, 0.6, 0.5), 0.0);
}

/// A plane of gradient g has the normal (-g, 1)/|..| at every texel: inside, edge, corner.
#[test]
fn normals_of_a_plane_are_its_normal_everywhere() {
    let tilted = plane(5, 4, [2.0, 0.5], 0.25, -1.5);
    let expected = DVec3::new(-0.25, 1.5, 1.0).normalize();
    for row in 0..5 {
        for col in 0..4 {
            for border in [Border::Plane, Border::Open] {
                let n = normal(&tilted, border, row, col);
                assert!((n - expected).length() < 1e-15, "{row} {col} {n}");
            }
        }
    }
}

/// Gradients counted by hand. A spike of height 4 at the middle of 3 × 3: at its east neighbour two quads touch the
/// spike, each with an edge falling 4 of its two: mean over 2 quads of (−4 + 0)/2 = −2 east; north they cancel.
/// Periodic adds two quads across the seam that rise towards nothing: their west-side texels are the neighbour itself
/// (0), so −1. A lone row is central inside and one-sided at its ends.
#[test]
fn normals_count_the_quads_that_exist() {
    let spike = field(3, 3, [1.0, 1.0], |r, c| if (r, c) == (1, 1) { 4.0 } else { 0.0 });
    let of = |x: f64, y: f64| DVec3::new(x, y, 1.0).normalize();
    assert_eq!(normal(&spike, Border::Plane, 1, 2), of(2.0, 0.0));
    assert_eq!(normal(&spike, Border::Periodic, 1, 2), of(1.0, 0.0));
    assert_eq!(normal(&spike, Border::Plane, 0, 0), of(-2.0, 2.0), "the only quad: ±4/2");
    assert_eq!(normal(&spike, Border::Open, 1, 1), DVec3::Z);
    let row = field(1, 4, [2.0, 9.0], |_, c| [0.0, 1.0, 4.0, 4.0][c]);
    assert_eq!(normal(&row, Border::Plane, 0, 0), of(-0.5, 0.0));
    assert_eq!(normal(&row, Border::Plane, 0, 1), of(-1.0, 0.0));
    assert_eq!(normal(&row, Border::Plane, 0, 3), of(0.0, 0.0));
    assert_eq!(normal(&row, Border::Periodic, 0, 0), of(0.75, 0.0), "(1 - 4) / (2 · 2)");
    let column = field(4, 1, [9.0, 2.0], |r, _| [0.0, 1.0, 4.0, 4.0][r]);
    assert_eq!(normal(&column, Border::Open, 1, 0), of(0.0, 1.0), "rises southwards");
    assert_eq!(normal(&field(1, 1, [1.0, 1.0], |_, _| 3.0), Border::Plane, 0, 0), DVec3::Z);
}

/// A quarter turn of the field turns its normals: components swap, bit by bit, as no split enters.
#[test]
fn normals_turn_with_the_field() {
    let h = |r: usize, c: usize| ((r * 7 + c * 13 + r * c * 5) % 11) as f64;
    let original = field(5, 6, [1.0, 1.0], h);
    let quarter = field(6, 5, [1.0, 1.0], |r, c| h(c, 5 - r));
    for row in 0..5 {
        for col in 0..6 {
            for border in BORDERS {
                let here = normal(&original, border, row, col);
                let there = normal(&quarter, border, 5 - col, row);
                // East has become north: (x, y) → (-y, x).
                assert!((DVec3::new(-here.y, here.x, here.z) - there).length() < 1e-15);
            }
        }
    }
}

/// Flat and free: (1/π) ∫ cos = 1, under every border, at every size, at corners.
#[test]
fn flat_ground_sees_all_of_the_sky() {
    for (rows, cols) in [(1, 1), (1, 5), (5, 1), (2, 3), (7, 7)] {
        let flat = field(rows, cols, [1.0, 3.0], |_, _| 100.0);
        for border in BORDERS {
            for (row, col) in [(0, 0), (rows - 1, cols - 1), (rows / 2, cols / 2)] {
                for azimuths in [1, 3, 64] {
                    assert!(
                        (sky_of(&Oracle::one_ray(&flat, border), row, col, azimuths) - 1.0).abs()
                            < 1e-14
                    );
                }
            }
        }
    }
}

/// A tilted plane. `open`: its own plane is its horizon both ways and its whole hemisphere is bright: 1.
/// `plane`: the part of the normal's hemisphere above horizontal, (1 + cos tilt) / 2.
#[test]
fn a_tilted_plane_sees_its_share_of_the_sky() {
    for (east, north) in [(0.75, 0.0), (-2.0, 1.0), (0.125, -0.25), (16.0, 0.0)] {
        let tilted = plane(9, 9, [1.0, 1.0], east, north);
        let cos_tilt = 1.0 / (1.0 + east * east + north * north).sqrt();
        let tolerance = circle_tolerance(1024);
        let open = sky_of(&Oracle::one_ray(&tilted, Border::Open), 4, 4, 1024);
        assert!((open - 1.0).abs() < tolerance, "{open}");
        let above = sky_of(&Oracle::one_ray(&tilted, Border::Plane), 4, 4, 1024);
        assert!((above - 0.5 * (1.0 + cos_tilt)).abs() < tolerance, "{above} {cos_tilt}");
    }
}

/// An endless canyon (one periodic row) with rims H over the floor's middle at distance d on both
/// sides: tan h = (H/d)|cos φ|, and the mean over φ of cos²h = 1/(1 + t²cos²φ) is 1/√(1 + t²) = cos b.
/// The rule on a circle converges like q^(m/2), q = ((√(1+t²) - 1)/t)² ≤ 0.38 for t ≤ 2.
#[test]
fn a_canyon_has_the_cosine_of_its_walls() {
    for t in [0.25, 1.0, 2.0] {
        let canyon = field(1, 16, [2.0, 1.0], |_, c| if c == 0 { 16.0 * t } else { 0.0 });
        let answer = sky_of(&Oracle::one_ray(&canyon, Border::Periodic), 0, 8, 256);
        assert!((answer - 1.0 / (1.0 + t * t).sqrt()).abs() < 1e-12, "{t} {answer}");
    }
}

/// One endless wall of elevation b: half the circle is free: (1 + cos b)/2. The wall here ends L to either side:
/// azimuths within ε = atan(d/L) of its line are free too, which adds at most (2/π)∫₀^ε t²φ² dφ ≤ t²ε³ / (1.5π).
#[test]
fn a_wall_leaves_half_of_one_plus_its_cosine() {
    for t in [0.5, 2.0] {
        let wall = field(801, 4, [1.0, 1.0], |_, c| if c == 3 { 2.0 * t } else { 0.0 });
        let answer = sky_of(&Oracle::one_ray(&wall, Border::Plane), 400, 1, 1024);
        let expected = 0.5 * (1.0 + 1.0 / (1.0 + t * t).sqrt());
        let end = t * t * (2.0_f64 / 400.0).powi(3) / (1.5 * PI);
        // cos²h is 1 - t²cos²φ near the wall's line: its derivative is continuous there.
        assert!((answer - expected).abs() < end + circle_tolerance(1024), "{t} {answer}");
    }
}

/// A circular basin of radius R with rim elevation b, visible from the middle of its floor: cos²b.
/// On the grid the rim's crest along a ray is met between R - √2 and R + √2 cells, so its elevation is
/// off by at most Δ = sin b cos b·√2/(R - √2) and cos²b by sin 2b·Δ ≤ (√2/2)/(R - √2).
#[test]
fn a_circular_basin_has_the_squared_cosine() {
    let radius = 60.0_f64;
    for b in [0.3_f64, 0.8, 1.2] {
        let basin = field(127, 127, [1.0, 1.0], |r, c| {
            let rho = (r as f64 - 63.0).hypot(c as f64 - 63.0);
            if rho >= radius { radius * b.tan() } else { 0.0 }
        });
        let answer = sky_of(&Oracle::one_ray(&basin, Border::Plane), 63, 63, 64);
        let tolerance = 0.5 * 2_f64.sqrt() / (radius - 2_f64.sqrt());
        assert!((answer - b.cos().powi(2)).abs() < tolerance, "{b} {answer}");
    }
}

/// The spherical pit: a cap of half-angle α of a sphere of radius R, sunk into a plain.
///
/// The form factor between two points of a sphere is dA / (4πR²) for all points, so any point of the pit sees
/// the pit with share (1 - cos α)/2 and the sky with (1 + cos α)/2. With albedo 0.5, α = 0.8 that is
/// 0.4241766773367914 (an independent quadrature).
///
/// Errors of the grid: (1) the rim along a ray is met within √2 cells of its place at distance D, so its
/// elevation errs by Δ ≤ sin ω cos ω √2/(D - √2) and the slice by 2 cos ω Δ ≤ 2·0.385·√2/(D - √2), sin ω cos²ω
/// being at most 0.385; (2) the normal's gradient by (1/6 + 1/4)·f''' with f''' ≤ 3 sin α/(R² cos⁵α), and light
/// by at most twice that; (3) the rule over azimuths.
#[test]
fn a_spherical_pit_is_lit_the_same_everywhere() {
    let (alpha, albedo, radiance) = (0.8_f64, 0.5, 0.424_176_677_336_791_4);
    assert!((albedo * 0.5 * (1.0 + alpha.cos()) - radiance).abs() < 1e-15);
    let rim = 190.0;
    let sphere = rim / alpha.sin();
    let pit = field(401, 401, [1.0, 1.0], |r, c| {
        let rho = (r as f64 - 200.0).hypot(c as f64 - 200.0).min(rim);
        -(sphere * sphere - rho * rho).sqrt()
    });
    for (row, col) in [(200, 200), (200, 290), (140, 170), (270, 120), (320, 250)] {
        let rho = (row as f64 - 200.0).hypot(col as f64 - 200.0);
        let nearest = rim - rho - 2_f64.sqrt();
        let bent = 2.0 * (5.0 / 12.0) * 3.0 * alpha.sin() / (sphere * alpha.cos().powi(3)).powi(2)
            * alpha.cos();
        let tolerance = 2.0 * 0.385 * 2_f64.sqrt() / nearest + bent + circle_tolerance(128);
        let answer = sky_of(&Oracle::one_ray(&pit, Border::Plane), row, col, 128);
        assert!((albedo * answer - radiance).abs() < albedo * tolerance, "{row} {col} {answer}");
    }
}

/// A constant environment is a uniform sky; its lower half contributes under `open` only.
#[test]
fn a_constant_environment_is_a_sky() {
    let tilted = plane(9, 9, [1.0, 1.0], 0.75, -0.5);
    let env = Environment::new(7, 5, vec![[1.0, 2.0, 0.0]; 35], 0.3).unwrap();
    for border in BORDERS {
        let [r, g, b] = environment_of(&Oracle::one_ray(&tilted, border), 4, 4, &env);
        let expected = sky_of(&Oracle::one_ray(&tilted, border), 4, 4, ENVIRONMENT_STRIPS);
        assert!(
            (r - expected).abs() < 2.0 * circle_tolerance(ENVIRONMENT_STRIPS),
            "{r} {expected}"
        );
        assert!((g - 2.0 * r).abs() < 1e-12 && b == 0.0);
    }
}

/// On flat ground a texel of rows θ₁..θ₂ and width 1/W gives (sin²θ₂ - sin²θ₁)/W, wherever it is; a
/// peak of 1e6 among zeros keeps all its digits.
#[test]
fn an_environment_texel_weighs_its_projected_solid_angle() {
    let flat = field(3, 3, [1.0, 1.0], |_, _| 0.0);
    for (row, col) in [(0, 0), (2, 5), (3, 1), (4, 0), (7, 3)] {
        let mut texels = vec![[0.0; 3]; 6 * 8];
        texels[row * 6 + col] = [1e6, 0.0, 1.0];
        let env = Environment::new(6, 8, texels, 1.0).unwrap();
        let above = |r: usize| (PI * r as f64 / 8.0).min(FRAC_PI_2).sin().powi(2);
        let expected = (above(row + 1) - above(row)) / 6.0;
        let [r, _, b] = environment_of(&Oracle::one_ray(&flat, Border::Plane), 1, 1, &env);
        assert!((r - 1e6 * expected).abs() <= 1e-8 && (b - expected).abs() <= 1e-14, "{row} {col}");
    }
}

/// Orientation. In an image 4 wide, column 1 covers azimuths from π/2 to 0 (it ends at the middle, in
/// the east); turned by ψ, from π/2 + ψ to ψ. On a plane with normal N, gently enough tilted that the
/// upper rows 45°..90° of elevation are wholly above it, the answer is
/// (1/π)[(N_x Δsin - N_y Δcos)·∫cos²ω + N_z Δφ ∫sin ω cos ω] over the texel.
#[test]
fn environment_columns_run_clockwise_from_the_west() {
    for turn in [0.0, 0.7, -2.0] {
        let mut texels = vec![[0.0; 3]; 4 * 4];
        texels[1] = [1.0; 3];
        let env = Environment::new(4, 4, texels, turn).unwrap();
        let n = DVec3::new(-0.25, 0.5, 1.0).normalize();
        let tilted = plane(3, 3, [1.0, 1.0], 0.25, -0.5);
        let (from, to) = (turn, turn + FRAC_PI_2);
        let along = n.x * (to.sin() - from.sin()) - n.y * (to.cos() - from.cos());
        let quarter = FRAC_PI_2 / 2.0;
        // Elevations π/4..π/2: ∫cos² = π/8 - 1/4, ∫sin cos = 1/4.
        let expected = (along * (quarter / 2.0 - 0.25) + n.z * FRAC_PI_2 * 0.25) / PI;
        let [answer, ..] = environment_of(&Oracle::one_ray(&tilted, Border::Plane), 1, 1, &env);
        // Midpoint rule over a quarter circle in steps h: relative h²/24 of a sinusoid.
        let step = TAU / ENVIRONMENT_STRIPS as f64;
        assert!((answer - expected).abs() < step * step / 24.0, "{turn} {answer} {expected}");
    }
}

fn sun_at(azimuth_rad: f64, elevation_rad: f64, diameter_rad: f64) -> Sun {
    Sun { azimuth_rad, elevation_rad, diameter_rad, irradiance: [PI as f32, 0.0, 1.0] }
}

/// Results are finite at extremes: light under a sky of radiance 1 lies within [0, 1] for all accepted heights
/// and cells. Slopes below 1e-5 turn neither normal nor horizon by more than a few times that: 1.
#[test]
fn extremes_give_finite_numbers() {
    for border in BORDERS {
        for (height, cell) in [(1e15, 1e-3), (-1e15, 1e-3), (1e6, 1.0), (1e-6, 1.0), (1e-15, 1e12)]
        {
            let field = field(5, 5, [cell; 2], |r, c| if (r, c) == (2, 2) { height } else { 0.0 });
            for i in 0..25 {
                let light = sky_of(&Oracle::one_ray(&field, border), i / 5, i % 5, 64);
                assert!((0.0..=1.0 + 1e-12).contains(&light), "{border:?} {height} {cell} {light}");
                if height.abs() / cell < 1e-5 {
                    assert!((light - 1.0).abs() < 10.0 * height.abs() / cell);
                }
                let [low, ..] = sun_of(
                    &Oracle::one_ray(&field, border),
                    i / 5,
                    i % 5,
                    &sun_at(1.0, 0.1, 0.01),
                    16,
                );
                assert!((0.0..=1.0 + 1e-6).contains(&low));
            }
        }
    }
}

/// Voids are lit as filled ground: a hole in a level plain is level.
#[test]
fn a_void_is_lit_as_it_is_filled() {
    let mut voids = vec![false; 25];
    voids[12] = true;
    let mut heights = vec![7.0; 25];
    heights[12] = f64::NAN;
    let holed = HeightField::new(5, 5, &heights, [1.0, 1.0], Some(voids)).unwrap();
    assert!((sky_of(&Oracle::one_ray(&holed, Border::Plane), 2, 2, 8) - 1.0).abs() < 1e-14);
    assert!((sky_of(&Oracle::one_ray(&holed, Border::Plane), 2, 1, 8) - 1.0).abs() < 1e-14);
}
