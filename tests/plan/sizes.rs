//! Plans as text, at odd sizes and in bands.

use ridgelight::plan::{self, Limits, Picture};

use ridgelight::scene::{
    Border, BounceEngine, Bounces, Hull, Levels, Lights, Lines, Method, Normals, Quality, Scene,
    SphereLight,
};

use super::{flat, is, sky, under_sky};

#[test]
fn a_single_texel() {
    is(
        &sky(1, 1, 4, &Limits::lavapipe()),
        "
          height_transpose cols 1×1×1
          height_transpose rows 1×1×1
        | horizon_sweep sky 0+2 1×1×2
        | sky_shade sky 0+2 1×1×1
        | horizon_sweep sky 2+2 1×1×2
        | sky_shade sky 2+2 1×1×1
        | light_resolve sky 1×1×1
        sky_sum 1×1×1
        azimuths 256
        lane_heights_cols 1×1×1
        lane_windows_cols 4×1×1
        lane_heights_rows 1×1×1
        lane_windows_rows 4×1×1
        lattice_occluders 8×1×2
        ",
    );
}

#[test]
fn one_row_and_one_column() {
    is(
        &sky(1, 9, 4, &Limits::lavapipe()),
        "
          height_transpose cols 1×2×1
          height_transpose rows 1×1×1
        | horizon_sweep sky 0+2 1×1×2
        | sky_shade sky 0+2 2×1×1
        | horizon_sweep sky 2+2 1×1×2
        | sky_shade sky 2+2 1×1×1
        | light_resolve sky 2×1×1
        sky_sum 9×1×1
        azimuths 256
        lane_heights_cols 1×9×1
        lane_windows_cols 4×9×1
        lane_heights_rows 3×1×1
        lane_windows_rows 12×1×1
        lattice_occluders 8×9×2
        ",
    );
    is(
        &sky(9, 1, 4, &Limits::lavapipe()),
        "
          height_transpose cols 1×1×1
          height_transpose rows 1×2×1
        | horizon_sweep sky 0+2 1×1×2
        | sky_shade sky 0+2 1×1×1
        | horizon_sweep sky 2+2 1×1×2
        | sky_shade sky 2+2 2×1×1
        | light_resolve sky 1×2×1
        sky_sum 1×9×1
        azimuths 256
        lane_heights_cols 3×1×1
        lane_windows_cols 12×1×1
        lane_heights_rows 1×9×1
        lane_windows_rows 4×9×1
        lattice_occluders 8×9×2
        ",
    );
}

#[test]
fn two_by_three() {
    is(
        &sky(2, 3, 8, &Limits::lavapipe()),
        "
          height_transpose cols 1×1×1
          height_transpose rows 1×1×1
        | horizon_sweep sky 0+4 1×1×4
        | sky_shade sky 0+4 1×1×1
        | horizon_sweep sky 4+4 1×1×4
        | sky_shade sky 4+4 1×1×1
        | light_resolve sky 1×1×1
        sky_sum 3×2×1
        azimuths 512
        lane_heights_cols 1×3×1
        lane_windows_cols 5×3×1
        lane_heights_rows 1×2×1
        lane_windows_rows 6×2×1
        lattice_occluders 8×3×4
        ",
    );
}

#[test]
fn primes() {
    is(
        &sky(31, 37, 12, &Limits::lavapipe()),
        "
          height_transpose cols 1×5×1
          height_transpose rows 2×4×1
        | horizon_sweep sky 0+6 2×1×6
        | sky_shade sky 0+6 5×1×1
        | horizon_sweep sky 6+6 2×1×6
        | sky_shade sky 6+6 4×1×1
        | light_resolve sky 5×4×1
        sky_sum 37×31×1
        azimuths 768
        lane_heights_cols 8×37×1
        lane_windows_cols 34×37×1
        lane_heights_rows 10×31×1
        lane_windows_rows 40×31×1
        lattice_occluders 8×37×12
        ",
    );
}

#[test]
fn long_and_thin() {
    is(
        &sky(3, 8191, 4, &Limits::lavapipe()),
        "
          height_transpose cols 1×1024×1
          height_transpose rows 256×1×1
        | horizon_sweep sky 0+2 1×1×2
        | horizon_sweep sky 0+2 again 1×1×2
        | sky_shade sky 0+2 1024×1×1
          horizon_sweep sky 2+2 256×1×2
        | horizon_sweep sky 2+2 again 256×1×2
        | sky_shade sky 2+2 1×128×1
        | light_resolve sky 1024×1×1
        sky_sum 8191×3×1
        azimuths 256
        lane_heights_cols 1×8191×1
        lane_windows_cols 6×8191×1
        lane_heights_rows 2048×3×1
        lane_windows_rows 8194×3×1
        lattice_occluders 8×8191×2
        lost_lines 64
        lattice_occluders_across 8×3×512
        lost_lines_across 16384
        ",
    );
    is(
        &sky(8191, 3, 4, &Limits::lavapipe()),
        "
          height_transpose cols 256×1×1
          height_transpose rows 1×1024×1
        | horizon_sweep sky 0+2 256×1×2
        | horizon_sweep sky 0+2 again 256×1×2
        | sky_shade sky 0+2 1×128×1
          horizon_sweep sky 2+2 1×1×2
        | horizon_sweep sky 2+2 again 1×1×2
        | sky_shade sky 2+2 1024×1×1
        | light_resolve sky 1×1024×1
        sky_sum 3×8191×1
        azimuths 256
        lane_heights_cols 2048×3×1
        lane_windows_cols 8194×3×1
        lane_heights_rows 1×8191×1
        lane_windows_rows 6×8191×1
        lattice_occluders 8×3×512
        lost_lines 16384
        lattice_occluders_across 8×8191×2
        lost_lines_across 64
        ",
    );
}

/// Five images of 64 MiB leave 120 MiB for lattices, of 32 MiB an azimuth along an axis and 64 MiB along a diagonal.
#[test]
fn a_large_field_in_bands() {
    let limits = Limits { memory_budget: 440 << 20, ..Limits::lavapipe() };
    let plan = sky(4096, 4096, 8, &limits);
    assert!(plan.bytes() <= limits.memory_budget, "{} bytes", plan.bytes());
    is(
        &plan,
        "
          height_transpose cols 128×512×1
          height_transpose rows 128×512×1
        | horizon_sweep sky 0+2 128×1×2
        | horizon_sweep sky 0+2 again 128×1×2
        | sky_shade sky 0+2 512×64×1
        | horizon_sweep sky 2+1 256×1×1
        | horizon_sweep sky 2+1 again 256×1×1
        | sky_shade sky 2+1 512×64×1
        | horizon_sweep sky 3+1 256×1×1
        | horizon_sweep sky 3+1 again 256×1×1
        | sky_shade sky 3+1 512×64×1
        | horizon_sweep sky 4+2 256×1×2
        | horizon_sweep sky 4+2 again 256×1×2
        | sky_shade sky 4+2 512×64×1
        | horizon_sweep sky 6+2 256×1×2
        | horizon_sweep sky 6+2 again 256×1×2
        | sky_shade sky 6+2 512×64×1
        | light_resolve sky 512×512×1
        sky_sum 4096×4096×1
        azimuths 512
        lane_heights_cols 1024×4096×1
        lane_heights_rows 1024×4096×1
        lattice_occluders 8×4096×384
        lost_lines 12288
        ",
    );
}

/// Only sweeps along lines have a hull in storage of its own.
#[test]
fn sweeps_along_lines_alone_have_a_hull() {
    let base = Quality { method: Method::Sweep, ..Quality::default() };
    let mut scene = under_sky(flat(9, 9));
    let has_hull = |scene: &Scene, quality: &Quality| {
        let limits = Limits::boundless(true, 1 << 30);
        let plan = plan::picture(scene, quality, &limits, Picture::default()).expect("a plan");
        plan.settings.iter().any(|(name, _)| name == "hull")
    };
    for (quality, expected) in [
        (base, true),
        (Quality { hull: Hull::OccluderList, ..base }, true),
        (Quality { lines: Lines::Exact, ..base }, false),
        (Quality { method: Method::BruteForce, ..base }, false),
        (Quality { method: Method::Pyramid, ..base }, false),
    ] {
        assert_eq!(has_hull(&scene, &quality), expected, "{quality:?}");
    }
    // A sphere light marches to its own occluders: no sweep, whatever the method.
    let sphere = SphereLight { position_m: [4.0, 4.0, 3.0], radius_m: 1.0, radiance: [1.0; 3] };
    scene.lights = Lights { sphere_lights: vec![sphere], ..Lights::default() };
    assert!(!has_hull(&scene, &base));
}

/// Lane positions and steps times shears are integers of 32 bits: what would pass them is refused.
#[test]
fn positions_beyond_32_bits_are_refused() {
    let limits = Limits::boundless(true, 1 << 50);
    let planned = |side: usize, border, quality: Quality| {
        let mut scene = under_sky(flat(1, side));
        scene.surface.border = border;
        plan::picture(&scene, &quality, &limits, Picture::default())
    };
    let pyramid = Quality { method: Method::Pyramid, ..Quality::default() };
    assert!(planned(21_000, Border::Periodic, pyramid).is_ok());
    let refused = planned(22_000, Border::Periodic, pyramid).expect_err("65,000 steps");
    assert!(refused.to_string().contains("steps per grid point"), "{refused}");
    assert!(planned(65_000, Border::Plane, pyramid).is_ok(), "it marches over its field once");
    let lines = |lines| Quality { lines, ..Quality::default() };
    assert!(planned(32_767, Border::Plane, lines(Lines::FourCells)).is_ok());
    assert!(planned(32_768, Border::Plane, lines(Lines::TwoCells)).is_ok());
    let refused = planned(32_768, Border::Plane, lines(Lines::FourCells)).expect_err("32 bits");
    assert!(refused.to_string().contains("beyond 32 bits"), "{refused}");
}

/// The 28 levels of 512² are made by octaves: seven dispatches, of which each waits for the one before.
#[test]
fn a_pyramid_is_made_by_octaves() {
    let scene = under_sky(flat(512, 512));
    let quality = Quality { method: Method::Pyramid, ..Quality::default() };
    let limits = Limits::lavapipe();
    let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
    let made: Vec<_> = plan.passes.iter().filter(|pass| pass.name() == "height_reduce").collect();
    assert_eq!(made.len(), 7);
    assert_eq!(
        made.iter().filter(|pass| pass.barrier_before).count(),
        6,
        "the first reads the field"
    );
}

/// Brute force takes half the field's side of lookups per grid point and azimuth, a pyramid some 60 levels of 16 texels: on a
/// GPU neither in one dispatch. The parts cover every grid point and azimuth once.
#[test]
fn dispatches_of_marches_are_short_on_a_gpu() {
    const SIDE: u32 = 2048;
    const MOST: u64 = 1_000_000_000;
    let limits = Limits { lookups: MOST, ..crate::on_gpu(Limits::lavapipe()) };
    let scene = under_sky(flat(SIDE as usize, SIDE as usize));
    for (method, name) in
        [(Method::BruteForce, "horizon_march"), (Method::Pyramid, "pyramid_march")]
    {
        let quality =
            Quality { azimuths: 16, method, levels: Levels::Pyramid, ..Quality::default() };
        let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
        let marches: Vec<_> = plan.passes.iter().filter(|p| p.name() == name).collect();
        let mut covered = vec![0_u64; plan.azimuths.len()];
        for pass in &marches {
            let [across, down, _] = pass.groups.map(u64::from);
            let count = pass.azimuths.len() as u64;
            // A pyramid has at least a level an octave.
            let each = if method == Method::BruteForce { u64::from(SIDE) / 2 } else { 16 * 11 };
            assert!(64 * across * down * count * each <= MOST, "{}", pass.label());
            for k in pass.azimuths.clone() {
                covered[k as usize] += 64 * across * down;
            }
        }
        assert!(marches.len() > 16, "{} dispatches of {name}", marches.len());
        assert!(covered.iter().all(|c| *c == u64::from(SIDE).pow(2)), "{name}: {covered:?}");
        let whole = Limits { lookups: u64::MAX, ..limits };
        let whole = plan::picture(&scene, &quality, &whole, Picture::default()).expect("a plan");
        assert!(whole.passes.iter().filter(|p| p.name() == name).count() < marches.len());
    }
}

/// Bounces, sphere lights and paths take at least their lookups / MOST dispatches, with two lookups a step and 24 steps a level
/// of blocks. Without a limit they take fewer.
#[test]
fn dispatches_of_rays_are_short_on_a_gpu() {
    const SIDE: usize = 1024;
    const MOST: u64 = 1_000_000_000;
    const LEVELS: u64 = 5;
    let limits = Limits { lookups: MOST, ..crate::on_gpu(Limits::lavapipe()) };
    let boundless = Limits { lookups: u64::MAX, ..limits };
    let grid_points = (SIDE * SIDE) as u64;
    let mut scene = under_sky(flat(SIDE, SIDE));
    let light = SphereLight { position_m: [500.0; 3], radius_m: 40.0, radiance: [1.0; 3] };
    scene.lights.sphere_lights = vec![light];
    let bounces =
        Bounces { count: 1, azimuths: 32, engine: BounceEngine::BruteForce, ..Bounces::default() };
    let quality = Quality { bounces, light_cutoff: 0.0, ..Quality::default() };
    let planned = |limits: &Limits, name: &str| {
        let plan = match name {
            "path_trace" => plan::reference(&scene, 1, Normals::Flat, None, 1, limits),
            _ => plan::picture(&scene, &quality, limits, Picture::default()),
        };
        plan.expect("a plan").passes.into_iter().filter(|p| p.name() == name).collect::<Vec<_>>()
    };
    // A path has two vertices. From each go a scattered ray and one to the light.
    let paths = 2 * u64::from(plan::REFERENCE_BATCH) * 2;
    for (name, rays) in [("bounce_march", 32), ("sphere_shade", 8), ("path_trace", paths)] {
        let lookups = grid_points * rays * 2 * 24 * LEVELS;
        let (few, many) = (planned(&boundless, name), planned(&limits, name));
        let least = lookups / MOST;
        // Whole azimuths or eight rows may leave half of a dispatch unused; parts of paths are halves, too.
        let most = 4 * least + 8;
        let count = many.len() as u64;
        assert!((least..=most).contains(&count) && few.len() < many.len(), "{name}: {count}");
        let of_path =
            if name == "path_trace" { paths / u64::from(plan::REFERENCE_BATCH) } else { 1 };
        for pass in &many {
            let each = pass.texels * of_path * 2 * 24 * LEVELS;
            assert!(each <= MOST, "{}: {each}", pass.label());
        }
    }
}
