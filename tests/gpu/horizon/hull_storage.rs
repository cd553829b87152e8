//! Hull storage and the split of a plan into batches never change a bit of the result.

use ridgelight::plan::{self, Limits, Picture, SweepForm};
use ridgelight::scene::fractal;
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, Fuse, HeightField, Hull, LightBasis, Lights, Lines,
    Method, PhongSpecular, Precision, Quality, Scene, Specular, SphereLight, Sun, Surface,
};

use crate::{Device, field, random, under_sky};

/// A dome: every texel stays on the hull of a line across it, until a wall behind pops them all.
fn dome_and_wall(side: usize) -> HeightField {
    let middle = (side as f64 - 1.0) / 2.0;
    field(side, side, [1.0, 1.0], |r, c| {
        let (x, y) = ((c as f64 - middle) / middle, (r as f64 - middle) / middle);
        let dome = (2.5 - x * x - y * y).sqrt() * middle;
        // A climb at the east edge uncovers the dome vertex by vertex.
        dome + if c + 40 > side { 3.0 * (c + 40 - side) as f64 } else { 0.0 }
    })
}

fn all_forms(gpu: &mut Device, field: &HeightField, border: Border, base: Quality) {
    let plain = gpu.horizons(field, border, &Quality { hull: Hull::Private, ..base });
    for hull in [Hull::Shared, Hull::OccluderList] {
        let other = gpu.horizons(field, border, &Quality { hull, ..base });
        let differing =
            plain.iter().zip(&other).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        assert_eq!(differing, 0, "{hull:?} against private, {border:?}, {:?}", base.fuse);
    }
}

#[test]
fn hulls_deeper_than_their_storage_lose_nothing() {
    let mut gpu = Device::new();
    // 300 texels a line, more than the 128 entries of private and the 64 of shared memory.
    let deep = dome_and_wall(300);
    let base = Quality { azimuths: 8, fuse: Fuse::Slopes, ..Quality::default() };
    all_forms(&mut gpu, &deep, Border::Plane, base);
    // The common result is right: along rows, columns and diagonals lines pass through every texel, so slopes are
    // those of the texels themselves.
    let swept = gpu.horizons(&deep, Border::Open, &base);
    let brute = Quality { method: Method::BruteForce, ..base };
    let exact = gpu.horizons(&deep, Border::Open, &brute);
    for k in [0, 2, 4, 6] {
        let plane = 300 * 300;
        for i in 0..plane {
            let (a, b) = (swept[k * plane + i], exact[k * plane + i]);
            // Heights of 500 in f32 (3e-5) over one cell, twice: both round.
            assert!((a - b).abs() < 2.0 * 3.1e-5, "azimuth {k}, texel {i}: {a} {b}");
        }
    }
}

#[test]
fn hull_storages_agree_to_the_bit_on_random_fields() {
    let mut gpu = Device::new();
    let mut next = random(11);
    for (i, (rows, cols)) in [(1, 1), (1, 7), (2, 3), (31, 37), (64, 5)].into_iter().enumerate() {
        let values: Vec<f64> = (0..rows * cols).map(|_| (next() * 40.0).floor()).collect();
        let f = field(rows, cols, [2.0, 3.0], |r, c| values[r * cols + c]);
        let fuse = [Fuse::Slopes, Fuse::Aimed, Fuse::AimedNearest][i % 3];
        all_forms(
            &mut gpu,
            &f,
            Border::Plane,
            Quality { azimuths: 12, fuse, ..Quality::default() },
        );
        if i < 3 {
            continue;
        }
        all_forms(&mut gpu, &f, Border::Periodic, Quality { azimuths: 12, ..Quality::default() });
        let packed = Quality { azimuths: 12, precision: Precision::Packed, ..Quality::default() };
        all_forms(&mut gpu, &f, Border::Open, packed);
    }
}

#[test]
fn batches_and_the_whole_are_the_same_to_the_bit() {
    let mut gpu = Device::new();
    let scene = under_sky(fractal(1024, 3).expect("a field"), Border::Plane);
    let quality = Quality { azimuths: 8, ..Quality::default() };
    let limits = Limits { memory_budget: 1 << 30, ..crate::of_kind(true, gpu.report().limits) };
    // Three images of 4 MiB, the heights by lanes of each axis, and room for one azimuth's lattice.
    let tight = Limits { memory_budget: 28_000_000, ..limits };
    let count = |l: &Limits| {
        let plan = plan::picture(&scene, &quality, l, Picture::default()).expect("a plan");
        plan.passes.iter().filter(|p| p.name() == "sky_shade").count()
    };
    assert_eq!(count(&limits), 2, "one batch an axis");
    assert!(count(&tight) >= 4, "{} batches", count(&tight));
    let whole = gpu.picture_within(&scene, &quality, &limits).values;
    let banded = gpu.picture_within(&scene, &quality, &tight).values;
    assert!(whole.iter().zip(&banded).all(|(a, b)| a.to_bits() == b.to_bits()));
}

#[test]
fn packed_entries_err_by_their_rounding() {
    let mut gpu = Device::new();
    let f = fractal(128, 5).expect("a field");
    let base = Quality { azimuths: 16, fuse: Fuse::Slopes, ..Quality::default() };
    let exact = gpu.horizons(&f, Border::Plane, &base);
    let packed = gpu.horizons(&f, Border::Plane, &Quality { precision: Precision::Packed, ..base });
    let half = gpu.horizons(&f, Border::Plane, &Quality { precision: Precision::F16, ..base });
    let highest = f.heights_m().iter().fold(0.0_f32, |m, h| m.max(h.abs()));
    // A height errs by at most half an f16 step of [0.5..1] (2^-12) of the largest; at a neighbour one cell away that
    // is an angle, and the choice of occluder changes the slope by no more.
    let bound = highest * 2.0_f32.powi(-12) * 2.0;
    let worst = exact.iter().zip(&packed).fold(0.0_f32, |m, (a, b)| m.max((a - b).abs()));
    assert!(worst > 0.0 && worst <= bound, "packed {worst}, bound {bound}");
    // An f16 slope errs by 2^-11 of itself; the arc tangent divides that by 1 + slope².
    let worst = exact.iter().zip(&half).fold(0.0_f32, |m, (a, b)| m.max((a - b).abs()));
    assert!(worst > 0.0 && worst <= 0.5 * 2.0_f32.powi(-11) * 1.01, "f16 {worst}");
}

/// A GPU's plans have groups of 32 invocations, of one line or four each: on any driver they give the same bits as a processor's, in
/// every layer and for lines that are redone.
#[test]
fn wide_groups_and_narrow_ones_are_the_same_to_the_bit() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let narrow = crate::of_kind(true, limits);
    let wide = crate::of_kind(false, limits);
    let rough = fractal(150, 9).expect("a field");
    let deep = dome_and_wall(150);
    for (field, hull) in [(&rough, Hull::Auto), (&rough, Hull::Private), (&deep, Hull::Shared)] {
        let quality = Quality { azimuths: 16, hull, ..Quality::default() };
        let a = gpu.horizons_within(field, Border::Plane, &quality, &narrow);
        let b = gpu.horizons_within(field, Border::Plane, &quality, &wide);
        let differing = a.iter().zip(&b).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        assert_eq!(differing, 0, "{hull:?}");
    }
}

/// Splitting the lines of a sun gives the same bits of its light. `shadow_sweep` of `direct::cpu_reference` compares the words of each line.
#[test]
fn segments_of_a_line_are_the_whole_line_to_the_bit() {
    let mut gpu = Device::new();
    let limits = crate::of_kind(false, gpu.limits());
    let sun = |degrees: f64, diameter_rad| Sun {
        azimuth_rad: degrees.to_radians(),
        elevation_rad: 0.12,
        diameter_rad,
        irradiance: [1.0; 3],
    };
    for (border, suns) in [
        (Border::Plane, vec![sun(38.0, 0.3), sun(100.0, 0.0)]),
        (Border::Periodic, vec![sun(215.0, 0.05), sun(300.0, 0.0)]),
        (Border::Open, vec![sun(0.0, 0.0), sun(180.0, 0.1)]),
    ] {
        let mut scene = under_sky(fractal(96, 9).expect("a field"), border);
        scene.lights = Lights { suns, ..Lights::default() };
        let mut of = |most: u32| {
            let group_invocations = limits.group_invocations.min(most);
            let limits = Limits { group_invocations, ..limits };
            let plan = plan::picture(&scene, &Quality::default(), &limits, Picture::default());
            let passes = plan.expect("a plan").passes;
            let sweeps = passes.iter().filter(|p| p.name() == "shadow_sweep");
            let segments: Vec<u32> = sweeps.filter_map(|p| p.constant("local_size_y")).collect();
            (segments, gpu.picture_within(&scene, &Quality::default(), &limits).values)
        };
        let (segments, whole) = of(32);
        assert!(!segments.is_empty() && segments.iter().all(|n| *n == 1), "{segments:?}");
        for most in [64, u32::MAX] {
            let (segments, cut) = of(most);
            assert!(!segments.is_empty() && segments.iter().all(|n| *n > 1), "{segments:?}");
            assert!(whole.iter().zip(&cut).all(|(a, b)| a.to_bits() == b.to_bits()), "{border:?}");
        }
    }
}

/// Maps of shadow heights, of which a near tie of two occluders may be decided by rounding: 12 ε of the largest height, as in the CPU reference.
#[test]
fn segments_of_a_map_are_the_whole_line() {
    let mut gpu = Device::new();
    let limits = crate::of_kind(false, gpu.limits());
    let field = fractal(130, 5).expect("a field");
    let largest = field.heights_m().iter().fold(0.0_f32, |m, h| m.max(h.abs()));
    for degrees in [0.0_f64, 38.0, 111.0, 250.0] {
        let sun = Sun {
            azimuth_rad: degrees.to_radians(),
            elevation_rad: 0.15,
            diameter_rad: 0.02,
            irradiance: [1.0; 3],
        };
        let mut of = |most: u32| {
            let group_invocations = limits.group_invocations.min(most);
            let limits = Limits { group_invocations, ..limits };
            let plan = plan::shadow_heights(&field, &sun, None, 1, &limits).expect("a plan");
            let segments = plan.passes[0].constant("local_size_y").expect("a constant");
            (segments, gpu.draw(plan, &[field.heights_m()]))
        };
        let (one, whole) = of(64);
        let (several, cut) = of(u32::MAX);
        assert!(one == 1 && several > 1, "{several}");
        let lit_above = whole[0].values.iter().zip(&cut[0].values);
        let most = lit_above.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(most <= 12.0 * f32::EPSILON * 2.0 * largest, "{most} {largest}");
    }
}

/// A field so large that a GPU's workgroups settle 128 texels each; a CPU device's settle 512, and read all corners.
#[test]
fn tiles_of_a_gpu_give_the_bits_of_a_processors() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let rough = field(1024, 1024, [1.0, 1.0], |r, c| ((r / 9 * 31 + c / 7 * 17) % 13) as f64);
    let mut scene = under_sky(rough, Border::Plane);
    let sun =
        Sun { azimuth_rad: 0.7, elevation_rad: 0.4, diameter_rad: 0.02, irradiance: [1.0; 3] };
    scene.lights = Lights { suns: vec![sun], ..Lights::default() };
    let quality = Quality { sun_azimuths: 2, ..Quality::default() };
    let mut of = |is_cpu| {
        let limits = crate::of_kind(is_cpu, limits);
        let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
        let settles = plan.passes.iter().find(|p| p.name() == "shadow_settle");
        let fours = settles.and_then(|p| p.constant("tile_fours"));
        (fours, gpu.picture_within(&scene, &quality, &limits).values)
    };
    let ((of_cpu, a), (of_gpu, b)) = (of(true), of(false));
    assert_eq!([of_cpu, of_gpu], [Some(8), Some(2)]);
    assert!(a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits()));
}

/// `ridgelight tune` may choose any of these.
#[test]
fn every_form_of_the_sweep_renders_identical_bits() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let deep = under_sky(dome_and_wall(150), Border::Plane);
    let quality = Quality { azimuths: 16, ..Quality::default() };
    let whole = gpu.picture_within(&deep, &quality, &limits).values;
    for lines_each in [1, 4] {
        for (lines, shares_hull, hull_depth) in
            [(32, false, 32), (64, true, 8), (128, true, 1024), (128, false, 128)]
        {
            let group_size = lines / lines_each;
            let azimuths = if lines == 32 { 3 } else { u32::MAX };
            let private_depth = 4 * hull_depth.min(16);
            let sweep = SweepForm {
                lines_each,
                group_size,
                shares_hull,
                hull_depth,
                private_depth,
                azimuths,
            };
            let tuned = Limits { sweep, ..limits };
            let plan = plan::picture(&deep, &quality, &tuned, Picture::default()).expect("a plan");
            assert!(plan.notes.iter().any(|n| n.starts_with("tuned sweep: ")), "{:?}", plan.notes);
            let of = |name: &str| plan.passes.iter().find_map(|p| p.constant(name));
            assert_eq!(of("one_line"), Some(u32::from(lines_each == 1)));
            assert_eq!(of("local_size_x"), Some(group_size));
            let sweeps = plan.passes.iter().filter(|p| p.name() == "sky_shade").count();
            assert_eq!(sweeps, if azimuths == 3 { 6 } else { 2 });
            let tuned = gpu.picture_within(&deep, &quality, &tuned).values;
            assert!(whole.iter().zip(&tuned).all(|(a, b)| a.to_bits() == b.to_bits()), "{sweep:?}");
        }
    }
}

/// No device is tuned before `tune`. SwiftShader sweeps one line per invocation, lavapipe four.
#[test]
fn an_untuned_device_has_its_own_form() {
    let gpu = Device::new();
    let limits = gpu.report().limits;
    let scene = under_sky(fractal(32, 1).expect("a field"), Border::Plane);
    let plan = plan::picture(&scene, &Quality::default(), &limits, Picture::default());
    let plan = plan.expect("a plan");
    assert!(!plan.notes.iter().any(|n| n.starts_with("tuned sweep")), "{:?}", plan.notes);
    let driver = gpu.report().driver.clone();
    let is_one = plan.passes.iter().find_map(|p| p.constant("one_line")) == Some(1);
    assert_eq!(is_one, !driver.contains("llvmpipe"), "{driver}");
}

/// GPU plans sweep one line per invocation, fetch heights ahead and from buffers, and have one lattice per batch, with wider
/// layers where images may have few; their picture must equal that of CPU plans.
#[test]
fn gpu_and_cpu_plans_render_identical_bits() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let [on_cpu, on_gpu] = [true, false].map(|is_cpu| crate::of_kind(is_cpu, limits));
    // An azimuth needs 6 layers of 32 lines, or 12 of a periodic field.
    let few = Limits { image_layers: 20, ..on_gpu };
    let sun = |elevation: f64, diameter: f64| Sun {
        azimuth_rad: 0.7,
        elevation_rad: elevation,
        diameter_rad: diameter,
        irradiance: [3.0; 3],
    };
    for border in [Border::Plane, Border::Open, Border::Periodic] {
        let mut scene = under_sky(fractal(96, 4).expect("a field"), border);
        scene.lights.suns = vec![sun(0.4, 0.0), sun(0.9, 0.02)];
        let bounces = Bounces { count: 2, azimuths: 8, ..Bounces::default() };
        let quality = Quality { azimuths: 16, bounces, ..Quality::default() };
        let [ours, theirs, wide] = [&on_cpu, &on_gpu, &few].map(|limits| {
            let plan = plan::picture(&scene, &quality, limits, Picture::default()).expect("a plan");
            let one_line = plan.passes.iter().any(|p| p.constant("one_line") == Some(1));
            assert_eq!(one_line, !limits.is_cpu, "{border:?}");
            let has_wide_layers = plan.passes.iter().any(|p| p.constant("layer_shift") > Some(5));
            assert_eq!(has_wide_layers, limits.image_layers == 20, "{border:?}");
            gpu.picture_within(&scene, &quality, limits).values
        });
        for other in [theirs, wide] {
            let differing = ours.iter().zip(&other).filter(|(a, b)| a.to_bits() != b.to_bits());
            assert_eq!(differing.count(), 0, "{border:?}");
        }
    }
}

/// On a GPU, exact lines of more than 256 steps keep their hull in a buffer. If it is too small for all lines of an azimuth, several
/// dispatches sweep them. Private hulls of that length are tested only on CPU devices.
#[test]
fn exact_lines_with_their_hull_in_a_buffer_have_the_same_bits() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let [on_cpu, on_gpu] = [true, false].map(|is_cpu| crate::of_kind(is_cpu, limits));
    // 12 bytes for each of up to four crossings a step.
    let lines = 24;
    let few = Limits { buffer_bytes: 12 * 4 * 300 * lines, ..on_gpu };
    let quality = Quality { azimuths: 8, lines: Lines::Exact, ..Quality::default() };
    let rough = fractal(40, 7).expect("a field");
    let sweeps = |field: &HeightField, border: Border, limits: &Limits| {
        let scene = under_sky(field.clone(), border);
        let plan = plan::picture(&scene, &quality, limits, Picture::default()).expect("a plan");
        let sweeps = plan.passes.iter().filter(|p| p.name() == "surface_sweep");
        sweeps.map(|p| p.constant("hull_in_buffer") == Some(1)).collect::<Vec<_>>()
    };
    assert!(sweeps(&rough, Border::Plane, &on_gpu).iter().all(|in_buffer| !in_buffer));
    let dome = dome_and_wall(300);
    for (field, border) in
        [(&dome, Border::Plane), (&dome, Border::Open), (&rough, Border::Periodic)]
    {
        let [whole, parts] = [&on_gpu, &few].map(|limits| {
            let in_buffer = sweeps(field, border, limits);
            assert!(in_buffer.iter().all(|in_buffer| *in_buffer), "{border:?}");
            (in_buffer.len(), gpu.horizons_within(field, border, &quality, limits))
        });
        assert!(whole.0 < parts.0, "{border:?}");
        let mut others = vec![parts.1];
        if gpu.report().limits.is_cpu {
            assert!(sweeps(field, border, &on_cpu).iter().all(|in_buffer| !in_buffer));
            others.push(gpu.horizons_within(field, border, &quality, &on_cpu));
        }
        for other in others {
            let differing = whole.1.iter().zip(&other).filter(|(a, b)| a.to_bits() != b.to_bits());
            assert_eq!(differing.count(), 0, "{border:?}");
        }
    }
}

/// Brute force and pyramids in parts: azimuth by azimuth, and rows of them.
#[test]
fn dispatches_in_parts_and_whole_are_the_same_to_the_bit() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let field = fractal(67, 2).expect("a field");
    for method in [Method::BruteForce, Method::Pyramid] {
        for border in [Border::Plane, Border::Periodic] {
            let quality = Quality { azimuths: 8, method, ..Quality::default() };
            let [whole, by_azimuth, by_rows] = [u64::MAX, 200_000, 20_000].map(|lookups| {
                let limits = Limits { lookups, ..limits };
                let all = (0, quality.azimuths);
                let plan = plan::horizons(&field, border, &quality, &limits, all, false);
                let count = plan.expect("a plan").passes.len();
                (gpu.horizons_within(&field, border, &quality, &limits), count)
            });
            assert!(by_rows.1 > whole.1 + 16, "{} passes, {}", by_rows.1, whole.1);
            for (parts, _) in [by_azimuth, by_rows] {
                let differing =
                    parts.iter().zip(&whole.0).filter(|(a, b)| a.to_bits() != b.to_bits());
                assert_eq!(differing.count(), 0, "{method:?}, {border:?}");
            }
        }
    }
}

/// Bounces in parts are the same to the bit: a part continues the sum of the part before. Sphere lights are added in another
/// order. A texel gets at most `PARTS` parts, one for each of 64 slices of two lights, with two roundings each, and no sum exceeds
/// the brightest texel.
#[test]
fn bounces_and_sphere_lights_in_parts_are_those_of_the_whole() {
    const PARTS: usize = 128;
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let light = |x: f64, y: f64| SphereLight {
        position_m: [x, y, 14.0],
        radius_m: 2.5,
        radiance: [9.0, 7.0, 5.0],
    };
    let bounced = |engine| Quality {
        azimuths: 8,
        bounces: Bounces { count: 2, azimuths: 8, engine, ..Bounces::default() },
        ..Quality::default()
    };
    let near =
        |light_basis| Quality { light_basis, azimuths: 8, light_cutoff: 0.3, ..Quality::default() };
    let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    // The second reaches only some rows.
    let spheres =
        Lights { sphere_lights: vec![light(30.0, 20.0), light(12.0, 41.0)], ..Lights::default() };
    let dull = Surface::default();
    let phong = PhongSpecular { exponent: 8.0, scale: 0.4 };
    let albedo = Albedo::Constant([0.5; 3]);
    let specular = Some(Specular::Constant(phong));
    let shiny = Surface { albedo, specular, ..Surface::default() };
    for (name, lights, surface, quality, is_exact) in [
        ("bounce_march", &sky, &dull, bounced(BounceEngine::BruteForce), true),
        ("bounce_gather", &sky, &dull, bounced(BounceEngine::Pyramid), true),
        ("specular_gather", &sky, &shiny, bounced(BounceEngine::Pyramid), true),
        ("sphere_shade", &spheres, &dull, near(LightBasis::Exact), false),
        ("sphere_sh_shade", &spheres, &dull, near(LightBasis::Sh), false),
    ] {
        let field = fractal(67, 2).expect("a field");
        let scene = Scene { field, surface: surface.clone(), lights: lights.clone() };
        let [whole, by_azimuth, by_rows] = [u64::MAX, 2_000_000, 200_000].map(|lookups| {
            let limits = Limits { lookups, ..limits };
            let plan = plan::picture(&scene, &quality, &limits, Picture::default());
            let passes = plan.expect("a plan").passes;
            let count = passes.iter().filter(|p| p.name() == name).count();
            (gpu.picture_within(&scene, &quality, &limits).values, count)
        });
        assert!(whole.1 < by_azimuth.1 && by_azimuth.1 < by_rows.1, "{name}: {} passes", by_rows.1);
        let brightest = whole.0.iter().fold(0.0_f32, |most, value| most.max(*value));
        let most = if is_exact { 0.0 } else { PARTS as f32 * f32::EPSILON * brightest };
        for (parts, _) in [by_azimuth, by_rows] {
            let apart = parts.iter().zip(&whole.0).map(|(a, b)| (a - b).abs());
            let apart = apart.fold(0.0, f32::max);
            assert!(apart <= most, "{name}: {apart:e} of {most:e}");
        }
    }
}
