//! Visibility as harmonics at every second and every fourth texel.

use std::path::Path;

use ridgelight::plan::{self, Limits, Nodes, Picture};
use ridgelight::scene::{
    Basis, Border, Environment, HeightField, Levels, Method, Quality, Scene, Sun,
};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;
use ridgelight_trade::error::ImageError;

use super::harmonics::noisy;
use crate::{Device, field, random, under_sky};

fn harmonics(subsample: u32) -> Quality {
    Quality { azimuths: 16, basis: Basis::Sh, subsample, ..Quality::default() }
}

fn under(environment: Environment, field: HeightField, border: Border) -> Scene {
    let mut scene = under_sky(field, border);
    scene.lights.sky = None;
    scene.lights.environment = Some(environment);
    scene
}

/// The picture's first three channels, row-major.
fn light(gpu: &mut Device, scene: &Scene, quality: &Quality) -> Vec<f32> {
    let picture = gpu.picture(scene, quality);
    picture.values.chunks_exact(picture.channels).flat_map(|t| t[..3].to_vec()).collect()
}

/// On a plane every texel has the same visibility, and every plane contains all of it: weights make no difference.
#[test]
fn a_plane_is_lit_alike_however_it_is_sampled() {
    let mut gpu = Device::new();
    for (rows, cols) in [(1, 1), (1, 7), (13, 18)] {
        let plane = field(rows, cols, [2.0, 1.0], |r, c| 0.7 * c as f64 - 0.4 * r as f64);
        let scene = under(noisy(3), plane, Border::Open);
        let whole = light(&mut gpu, &scene, &harmonics(1));
        let brightest = whole.iter().fold(0.0_f32, |m, v| m.max(*v));
        for stride in [2, 4] {
            let found = light(&mut gpu, &scene, &harmonics(stride));
            for (found, want) in found.iter().zip(&whole) {
                // 16 coefficients, weights and sums, of ε each.
                let off = (found - want).abs();
                assert!(off <= 1e-5 * brightest, "{rows} × {cols}, {stride}: {found} for {want}");
            }
        }
    }
}

/// At a node only its own visibility counts: as for every texel, by every method, the last texels too.
#[test]
fn nodes_are_lit_as_they_are_by_themselves() {
    let mut gpu = Device::new();
    let mut next = random(5);
    let noise: Vec<f64> = (0..23 * 30).map(|_| next()).collect();
    let rough = field(23, 30, [3.0, 2.0], |r, c| 7.0 * noise[r * 30 + c]);
    for (method, border, strides) in [
        (Method::Sweep, Border::Plane, &[2, 4][..]),
        (Method::BruteForce, Border::Plane, &[4]),
        (Method::Pyramid, Border::Periodic, &[2]),
    ] {
        let scene = under(noisy(4), rough.clone(), border);
        let whole = light(&mut gpu, &scene, &Quality { method, ..harmonics(1) });
        for &stride in strides {
            let found = light(&mut gpu, &scene, &Quality { method, ..harmonics(stride) });
            let nodes = Nodes { stride };
            let [across, along] = nodes.size([30, 23]);
            for (y, x) in (0..along).flat_map(|y| (0..across).map(move |x| (y, x))) {
                let [col, row] = [nodes.place(x, 30), nodes.place(y, 23)].map(|i| i as usize);
                let texel = 3 * (row * 30 + col);
                assert_eq!(
                    found[texel..texel + 3],
                    whole[texel..texel + 3],
                    "{method:?}, {stride}: row {row}, column {col}"
                );
            }
        }
    }
}

/// Light interpolated between nodes ignores normals: interpolated visibility has a smaller error, and so have more
/// nodes.
#[test]
fn on_terrain_interpolating_visibility_is_better_than_interpolating_light() {
    let mut gpu = Device::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    let field =
        files::read_heights(&root.join("mt_washington_256.png"), &options).expect("a field");
    let sky = files::read_environment(&root.join("sky_512x256.hdr"), 0.0).expect("a sky");
    let scene = under(sky, field, Border::Plane);
    let whole = light(&mut gpu, &scene, &harmonics(1));
    let mut before = 0.0;
    for stride in [2, 4] {
        let nodes = Nodes { stride };
        let mut between = Vec::new();
        for (row, col) in (0..256).flat_map(|r| (0..256).map(move |c| (r, c))) {
            let (([left, right], x), ([top, bottom], y)) =
                (nodes.around(col, 256), nodes.around(row, 256));
            let at = |node_y, node_x, c: usize| {
                let grid_point = nodes.place(node_y, 256) * 256 + nodes.place(node_x, 256);
                f64::from(whole[3 * grid_point as usize + c])
            };
            between.extend((0..3).map(|c| {
                let along = |r| at(r, left, c) * (1.0 - x) + at(r, right, c) * x;
                (along(top) * (1.0 - y) + along(bottom) * y) as f32
            }));
        }
        let error = |of: &[f32]| ImageError::of(of, &whole, 256).expect("comparable").relative_rmse;
        let [visible, lit] = [error(&light(&mut gpu, &scene, &harmonics(stride))), error(&between)];
        println!("{stride}: {:.3} %, light interpolated {:.3} %", 100.0 * visible, 100.0 * lit);
        assert!(before < visible && visible < lit, "{stride}: {visible} of {lit}");
        before = visible;
    }
}

/// Visibility takes as many texels as there are nodes, and so do marches' horizons where nothing else needs them; a
/// sun does.
#[test]
fn memory_and_work_are_those_of_the_nodes() {
    let level = field(13, 9, [1.0; 2], |_, _| 0.0);
    let mut scene = under(noisy(6), level, Border::Plane);
    let sun = Sun { azimuth_rad: 0.3, elevation_rad: 0.5, diameter_rad: 0.0, irradiance: [1.0; 3] };
    for has_sun in [false, true] {
        scene.lights.suns.extend(has_sun.then_some(sun));
        for (method, stride) in [Method::Sweep, Method::BruteForce, Method::Pyramid]
            .into_iter()
            .flat_map(|m| [1, 2, 4].map(move |s| (m, s)))
        {
            let quality = Quality { method, levels: Levels::Pyramid, ..harmonics(stride) };
            let plan = plan::picture(&scene, &quality, &Limits::lavapipe(), Picture::default());
            let plan = plan.expect("a plan");
            let nodes =
                u64::from(12_u32.div_ceil(stride) + 1) * u64::from(8_u32.div_ceil(stride) + 1);
            let bytes = |name: &str| plan.resources[plan.find(name).expect(name).0].bytes();
            assert_eq!(bytes("visibility"), nodes * 4 * 16);
            assert_eq!(plan.find("nodes").is_some(), stride > 1);
            let grid_points = |name: &str| -> u64 {
                plan.passes.iter().filter(|p| p.name() == name).map(|p| p.texels).sum()
            };
            assert_eq!(grid_points("sh_visibility"), nodes * 16);
            assert_eq!(grid_points("sh_shade"), 13 * 9);
            let marched = if has_sun { 13 * 9 * 17 } else { nodes * 16 };
            match method {
                Method::BruteForce => assert_eq!(grid_points("horizon_march"), marched),
                Method::Pyramid => assert_eq!(grid_points("pyramid_march"), marched),
                Method::Sweep | Method::Auto => {}
            }
            let reported = plan.settings.iter().find(|s| s.0 == "subsample").expect("reported");
            assert_eq!(reported.1, stride.to_string());
        }
    }
    let refused = plan::picture(&scene, &harmonics(3), &Limits::lavapipe(), Picture::default());
    assert!(refused.unwrap_err().to_string().contains("subsample: found 3, expected 1, 2 or 4"));
}
