//! `sky_shade`, `sun_shade`, the environment's tables and `light_resolve` against the f64 reference.

use crate::horizon::*;
use glam::DVec3;
use ridgelight::plan::azimuths::{Shape, across_key, across_sun, along_grid_vectors, even};
use ridgelight::scene::{Environment, KeyLight, Sun};
use ridgelight_cpu::env_tables::{EnvTables, bottom_sine, env_tables};
use ridgelight_cpu::env_wedges::env_wedges;
use ridgelight_cpu::height_transpose::{heights_by_col, heights_by_row};
use ridgelight_cpu::light;
use ridgelight_cpu::light_resolve::{add_to_radiance, light_resolve};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::shared::gather::{Swept, elevation_moments};
use ridgelight_cpu::sky_shade::{env_shade, sky_shade};
use ridgelight_cpu::sun_shade::sun_shade;
use ridgelight_cpu::tolerance::{EPSILON, march_slope};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Marches the azimuths with all crossings and passes the result to `of`: horizons are exact, so only light is tested.
fn lit<T>(
    field: &HeightField,
    border: Border,
    azimuths: &mut [Azimuth],
    of: impl Fn(&Swept) -> T,
) -> T {
    let warm_up = warm_ups(field, border);
    let lattices = marched(field, border, azimuths, warm_up, true);
    let heights = Heights::of(field, border);
    of(&Swept { heights, azimuths, lattices: &lattices, fuse: None, line_shift: 15, warm_up })
}

fn bumps(rows: usize, cols: usize) -> HeightField {
    field(rows, cols, [2.0, 3.0], |r, c| 4.0 * noise(9, r, c))
}

/// A plane of gradient (east, north), exact in f32.
fn plane(east: f64, north: f64) -> HeightField {
    field(7, 8, [1.0, 2.0], |r, c| east * c as f64 - north * 2.0 * r as f64)
}

#[test]
fn moments_are_the_slices_to_the_zenith() {
    for slope in [-1e9_f64, -50.0, -1.0, -1e-3, 0.0, 0.3, 2.0, 1e4, 1e9] {
        let low = slope.atan();
        let [flat, up] = elevation_moments(slope);
        assert!((flat - light::slice(1.0, 0.0, low, FRAC_PI_2)).abs() < 1e-15);
        assert!((up - light::slice(0.0, 1.0, low, FRAC_PI_2)).abs() < 1e-15);
    }
}

/// Same sums in another order, in f64 with the cell's f32 value.
#[test]
fn normals_are_those_of_the_reference() {
    for (rows, cols) in SIZES {
        let rough = bumps(rows, cols);
        for border in BORDERS {
            let heights = Heights::of(&rough, border);
            for (row, col) in (0..rows).flat_map(|r| (0..cols).map(move |c| (r, c))) {
                let normal = normal_of(field_slope(&heights, col as i32, row as i32));
                let ground_truth = light::normal(&rough, border, row, col);
                assert!(
                    (normal - ground_truth).length() < 1e-14,
                    "{rows} {cols} {border:?} {row} {col}"
                );
            }
        }
    }
}

/// The closed form over the oracle's horizons. A slope's error moves a slice's end, where the
/// integrand is 1 at most: times the wedges' sum 2π, over π. Each wedge's three numbers are rounded to
/// f32: 2 ε of wedges that sum to 2π, times slices of π/2 at most, and directions' cosines.
#[test]
fn the_sky_is_the_closed_form_over_the_oracles_horizons() {
    for border in BORDERS {
        let rough = bumps(9, 8);
        let oracle = Oracle::new(&rough, border);
        let mut azimuths = even(24, rough.cell_m());
        let sky = lit(&rough, border, &mut azimuths, sky_shade);
        let (_, relief) = extent(&rough);
        let tolerance = 2.0 * march_slope(relief, 2.0) + 16.0 * EPSILON;
        // A march misses ground beyond 512 cells, two metres wide or more.
        let hidden = if border == Border::Periodic { relief / (512.0 * 2.0) } else { 0.0 };
        for (i, sky) in sky.into_iter().enumerate() {
            let (row, col) = (i / 8, i % 8);
            let n = light::normal(&rough, border, row, col);
            let ground_truth: f64 = azimuths
                .iter()
                .map(|a| {
                    let (x, y) = (f64::from(a.cos_phi), f64::from(a.sin_phi));
                    let own = (-(n.x * x + n.y * y) / n.z).atan();
                    let low = oracle.elevation_rad(row, col, a.swept_rad(rough.cell_m())).max(own);
                    let flat = n.x * f64::from(a.wedge_cos) + n.y * f64::from(a.wedge_sin);
                    light::slice(flat, n.z * f64::from(a.wedge_rad), low, FRAC_PI_2) / PI
                })
                .sum();
            assert!(
                (sky - ground_truth).abs() <= tolerance + 2.0 * hidden,
                "{border:?} {i} {sky} {ground_truth}"
            );
            // The reference takes the normal at a wedge's centre: a factor sinc(w/2) of its
            // horizontal part; and azimuths as requested, 2.4e-5 rad aside at most in these cells,
            // across which the surface rises by relief / 2 m at most, times the wedges' 2.
            let reference = light::sky_of(&oracle, row, col, 24);
            let aside = 2.0 * 2.4e-5 * relief / 2.0;
            let wedge = (TAU / 24.0 / 2.0_f64).powi(2) / 6.0 * 2.0;
            assert!(
                (ground_truth - reference).abs() <= wedge + aside,
                "{i} {ground_truth} {reference}"
            );
        }
    }
}

/// Flat: 1. A plane inclined by θ sees the sky above its own plane: 1 where the sky continues below horizontal,
/// (1 + cos θ)/2 where it ends there. m wedges with the lowest slope of their centre err by (2π/m)²/6 or less,
/// as the reference's own test derives with a factor of two.
#[test]
fn a_plane_sees_its_share_of_the_sky() {
    for (east, north) in [(0.0, 0.0), (0.5, -0.25), (-2.0, 1.0)] {
        let tilted = plane(east, north);
        let n = DVec3::new(-east, -north, 1.0).normalize();
        for (border, expected) in [(Border::Open, 1.0), (Border::Plane, (1.0 + n.z) / 2.0)] {
            let mut azimuths = even(96, tilted.cell_m());
            let sky = lit(&tilted, border, &mut azimuths, sky_shade);
            let tolerance =
                8.0 * EPSILON + if n.z == 1.0 { 0.0 } else { (TAU / 96.0).powi(2) / 3.0 };
            // A plane that rises from the border's ground is its own horizon towards the rise only.
            for sky in sky {
                assert!((sky - expected).abs() <= tolerance, "{border:?} {east} {north} {sky}");
            }
        }
    }
}

/// Small environments: constant, a gradient in both directions, one bright texel; turned.
fn environments() -> Vec<Environment> {
    let of = |rotation: f64, f: &dyn Fn(usize, usize) -> [f32; 3]| {
        let texels = (0..16 * 8).map(|i| f(i / 16, i % 16)).collect();
        Environment::new(16, 8, texels, rotation).unwrap()
    };
    vec![
        of(0.0, &|_, _| [1.0, 0.5, 2.0]),
        of(0.7, &|r, c| [r as f32, c as f32, (r * c) as f32 / 8.0]),
        of(-2.0, &|r, c| if (r, c) == (2, 5) { [10.0, 20.0, 30.0] } else { [0.0; 3] }),
        of(3.0, &|r, c| if (r, c) == (5, 0) { [10.0; 3] } else { [0.1; 3] }),
    ]
}

fn tables(env: &Environment, azimuths: &[Azimuth], nodes: usize, border: Border) -> EnvTables {
    let rows = env_wedges(env, border, azimuths);
    env_tables(&rows, (env.height(), azimuths), nodes, bottom_sine(border))
}

/// All wedges together are the whole circle, wherever they begin: the tables' sums over azimuths are the
/// texels' own integrals. Wedges are f32: ε of each of their ends, at which radiance jumps by 30.
#[test]
fn tables_of_all_azimuths_add_up_to_the_environment() {
    for env in environments() {
        for border in [Border::Plane, Border::Open] {
            for azimuths in [
                even(4, [1.0; 2]),
                even(23, [1.0; 2]),
                along_grid_vectors(16, [66.0, 92.6]).expect("vectors"),
            ] {
                let nodes = 33;
                let tables = tables(&env, &azimuths, nodes, border);
                for node in [0, 7, nodes - 1] {
                    let low = (tables.bottom_sine + tables.step() * node as f64).asin();
                    let mut ground_truth = [DVec3::ZERO; 3];
                    for (i, texel) in env.texels().iter().enumerate() {
                        let (row, col) = ((i / 16) as f64, (i % 16) as f64);
                        let top = FRAC_PI_2 - PI * row / 8.0;
                        let end = (top - PI / 8.0).max(low);
                        let east = PI - TAU * (col + 1.0) / 16.0 + env.rotation_rad();
                        let west = east + TAU / 16.0;
                        let l = DVec3::from_array(texel.map(f64::from)) / PI;
                        ground_truth[0] +=
                            l * (west.sin() - east.sin()) * light::slice(1.0, 0.0, end, top);
                        ground_truth[1] +=
                            l * (east.cos() - west.cos()) * light::slice(1.0, 0.0, end, top);
                        ground_truth[2] += l * (TAU / 16.0) * light::slice(0.0, 1.0, end, top);
                    }
                    for (moment, ground_truth) in ground_truth.into_iter().enumerate() {
                        let sum: DVec3 =
                            (0..azimuths.len()).map(|k| tables.at(k, moment, node)).sum();
                        let room = azimuths.len() as f64 * 2.0 * PI * EPSILON * 30.0;
                        assert!(
                            (sum - ground_truth).abs().max_element() <= room,
                            "{moment} {node} {sum} {ground_truth}"
                        );
                    }
                }
            }
        }
    }
}

/// Radiance from a node to the next: times wedges and steps it adds up to the texels' own integral, in any one azimuth
/// as in the sum over all.
#[test]
fn radiances_between_nodes_add_up_to_the_environment() {
    for env in environments() {
        for border in [Border::Plane, Border::Open] {
            let azimuths = even(23, [1.0; 2]);
            let tables = tables(&env, &azimuths, 33, border);
            let all = (0..azimuths.len()).flat_map(|k| (0..32).map(move |node| (k, node)));
            let sum: DVec3 = all
                .map(|(k, i)| tables.radiances[k * 33 + i] * tables.wedges[k].z * tables.step())
                .sum();
            let texel = |(i, texel): (usize, &[f32; 3])| {
                let top = FRAC_PI_2 - PI * (i / 16) as f64 / 8.0;
                let height = top.sin().max(tables.bottom_sine)
                    - (top - PI / 8.0).sin().max(tables.bottom_sine);
                DVec3::from_array(texel.map(f64::from)) * (height * TAU / 16.0)
            };
            let expected: DVec3 = env.texels().iter().enumerate().map(texel).sum();
            let room = azimuths.len() as f64 * 2.0 * PI * EPSILON * 30.0;
            assert!((sum - expected).abs().max_element() <= room, "{border:?} {sum} {expected}");
        }
    }
}

/// A constant environment is a sky. Between nodes h apart in the sine, the cosine's mean over the part up to a horizon is taken as
/// falling evenly: h²/6 of its second derivative 1/cos³ too high, over h; of the horizontal moment alone, over wedges of 2π, over π.
#[test]
fn a_constant_environment_is_a_sky() {
    let (rough, env) = (bumps(9, 8), &environments()[0]);
    let steepest = extent(&rough).1 * (1.0_f64 / 2.0).hypot(1.0 / 3.0);
    for border in BORDERS {
        let mut azimuths = even(24, rough.cell_m());
        lit(&rough, border, &mut azimuths, |swept| {
            let tables = tables(env, swept.azimuths, 65, border);
            let per_cos3 = (1.0 + steepest * steepest).powf(1.5);
            let tolerance = 2.0 * tables.step().powi(3) / 6.0 * per_cos3 + 100.0 * EPSILON;
            for (env, sky) in env_shade(swept, &tables).into_iter().zip(sky_shade(swept)) {
                for (channel, radiance) in env.into_iter().zip([1.0, 0.5, 2.0]) {
                    assert!((channel / radiance - sky).abs() <= tolerance, "{channel} {sky}");
                }
            }
        });
    }
}

/// Against the reference on planes: m wedges have the lowest slope of their centre, wrong by the
/// field's gradient g times w/2 at their ends, where N·e is as small: w² g² of the brightest, over
/// 2π/π. Between nodes h apart in the sine radiance is taken as even: up to the lowest direction, the grid point's own plane, from
/// which light arrives at h/cos at most, so h²/(2 cos) of the brightest over 2π/π.
#[test]
fn an_environment_lights_planes_as_the_reference_does() {
    for env in environments() {
        let brightest = env.texels().iter().flatten().fold(0.0_f32, |m, v| m.max(*v));
        for (east, north) in [(0.0, 0.0), (0.5, -0.25)] {
            let tilted = plane(east, north);
            for border in [Border::Plane, Border::Open] {
                let mut azimuths = even(128, tilted.cell_m());
                let got = lit(&tilted, border, &mut azimuths, |swept| {
                    let tables = tables(&env, swept.azimuths, 129, border);
                    env_shade(swept, &tables)[3 * 8 + 4]
                });
                let ground_truth =
                    light::environment_of(&Oracle::one_ray(&tilted, border), 3, 4, &env);
                let (w, g2) = (TAU / 128.0, east * east + north * north);
                let h = if border == Border::Open { 2.0 } else { 1.0 } / 128.0;
                let most = f64::from(brightest);
                // Level ground is a node's elevation under either border, and wedges do not matter.
                let room = if g2 == 0.0 {
                    0.0
                } else {
                    2.0 * (w * w * g2 + h * h / 2.0 * (1.0 + g2).sqrt())
                };
                let strips = (TAU / light::ENVIRONMENT_STRIPS as f64).powi(2);
                for (got, ground_truth) in got.into_iter().zip(ground_truth) {
                    let tolerance = most * (room + strips + 128.0 * 4.0 * EPSILON);
                    assert!(
                        (got - ground_truth).abs() <= tolerance,
                        "{east} {border:?} {got} {ground_truth}"
                    );
                }
            }
        }
    }
}

/// Suns over bumps: a point by the same closed form; a disc in 128 chords against one in 2048. A
/// midpoint rule over n chords of a disc: (1/n)^1.5 of it; where the horizon's edge crosses the disc
/// its slope between chords adds its variation over n.
#[test]
fn suns_are_those_of_the_reference() {
    let rough = bumps(6, 7);
    let (_, relief) = extent(&rough);
    let suns: [(f64, f64, f64); 6] = [
        (40.0, 20.0, 0.0),
        (40.0, 20.0, 10.0),
        (200.0, 0.0, 5.0),
        (10.0, 90.0, 0.0),
        (300.0, 88.0, 20.0),
        (90.0, 45.0, 0.5),
    ];
    for (azimuth, elevation, diameter) in suns {
        let sun = Sun {
            azimuth_rad: azimuth.to_radians(),
            elevation_rad: elevation.to_radians(),
            diameter_rad: diameter.to_radians(),
            irradiance: [1.0; 3],
        };
        for border in [Border::Plane, Border::Open] {
            let (shape, slices) =
                if diameter > 0.0 { (Shape::Disc, 128) } else { (Shape::Point, 1) };
            let mut azimuths = across_sun(&sun, slices, rough.cell_m());
            let got = lit(&rough, border, &mut azimuths, |s| sun_shade(s, shape));
            for (i, got) in got.into_iter().enumerate() {
                let ground_truth =
                    light::sun_of(&Oracle::one_ray(&rough, border), i / 7, i % 7, &sun, 2048)[0];
                let tolerance = if diameter == 0.0 {
                    16.0 * EPSILON
                } else {
                    4.0 / 128.0_f64.powf(1.5) + march_slope(relief, 2.0) / sun.diameter_rad
                };
                assert!(
                    (got - ground_truth).abs() <= tolerance,
                    "{sun:?} {border:?} {i}: {got} {ground_truth}"
                );
            }
        }
    }
}

/// Key lights over bumps, in the reference's own azimuths. The remaining error is that of the march's slope
/// over the wedges; of cosines taken at wedges' middles in one and over them in the other, a share δ²/24 of the
/// light on the normal's horizontal part; and of f32 rounding of wedges and slopes.
#[test]
fn key_lights_are_those_of_the_reference() {
    let rough = bumps(6, 7);
    let (_, relief) = extent(&rough);
    let keys: [[f64; 4]; 5] = [
        [40.0, 30.0, 5.0, 25.0],
        [200.0, 360.0, 0.0, 90.0],
        [-70.0, 120.0, 60.0, 90.0],
        [95.0, 1.0, 10.0, 11.0],
        [300.0, 90.0, -60.0, 20.0],
    ];
    for [azimuth, width, low, high] in keys {
        let key = KeyLight {
            azimuth_rad: azimuth.to_radians(),
            width_rad: width.to_radians(),
            elevations_rad: [low.to_radians(), high.to_radians()],
            radiance: [1.0; 3],
        };
        for (border, slices) in [(Border::Plane, 64), (Border::Open, 7)] {
            let mut azimuths = across_key(&key, slices, rough.cell_m());
            let got = lit(&rough, border, &mut azimuths, |s| sun_shade(s, Shape::Patch));
            let oracle = Oracle::new(&rough, border);
            let wedge = key.width_rad / f64::from(slices);
            let tolerance = key.width_rad / PI
                * (march_slope(relief, 2.0) + wedge * wedge / 24.0 * FRAC_PI_2 + 8.0 * EPSILON);
            for (i, got) in got.into_iter().enumerate() {
                let ground_truth = light::key_of(&oracle, i / 7, i % 7, &key, slices as usize)[0];
                assert!(
                    (got - ground_truth).abs() <= tolerance,
                    "{key:?} {border:?} {i}: {got} {ground_truth}"
                );
            }
        }
    }
}

#[test]
fn layers_are_sums_times_colour_times_albedo() {
    let map = [[0.5, 1.0, 0.0], [0.25, 0.5, 1.0]];
    let layer = light_resolve([[2.0; 3], [4.0; 3]], [1.0, 2.0, 3.0], Some(&map));
    assert_eq!(layer, [[1.0, 4.0, 0.0], [1.0, 4.0, 12.0]]);
    let mut radiance = light_resolve([[1.0, 2.0, 3.0]; 2], [2.0, 1.0, 0.5], None);
    assert_eq!(radiance, [[2.0, 2.0, 1.5]; 2]);
    add_to_radiance(&mut radiance, &layer);
    assert_eq!(radiance, [[3.0, 6.0, 1.5], [3.0, 6.0, 13.5]]);
}

#[test]
fn transposed_heights_have_lanes_side_by_side() {
    let heights = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(heights_by_col(&heights, 3, 2), [1.0, 4.0, 2.0, 5.0, 3.0, 6.0]);
    assert_eq!(heights_by_row(&heights), heights);
}
