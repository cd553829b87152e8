//! Light scattered between visible texels: the limit of its paths, and closed forms.

use std::f64::consts::PI;

use ridgelight::plan;
use ridgelight::scene::{
    Albedo, Border, Directions, Lights, PhongSpecular, Scatter, Scene, Specular, Sun, VisiblePoints,
};
use ridgelight_cpu::scatter_gather::expected;

use crate::reference_page::{
    HALF, WALL, from_the_other_wall, groove_parts, groove_sky, grooves, pit, pit_bounds,
    pit_radiance,
};
use crate::{Device, field, random, under_sky};

pub fn points(device: &mut Device, scene: &Scene, directions: &Directions) -> VisiblePoints {
    let (field, border) = (&scene.field, scene.surface.border);
    let plan = plan::visible_points(field, border, directions, &device.limits()).expect("a plan");
    let drawn = device.draw(plan, &[field.heights_m()]);
    let words = drawn.iter().flat_map(|image| image.values.iter().map(|v| v.to_bits())).collect();
    VisiblePoints::new(field, border, directions.clone(), words).expect("points")
}

fn scattered(
    device: &mut Device,
    scene: &Scene,
    points: &VisiblePoints,
    direct: &[[f32; 3]],
    scatter: &Scatter,
) -> Vec<[f64; 3]> {
    let plan = plan::scatter(scene, points.directions(), scatter, &device.limits());
    let plan = plan.expect("a plan");
    let contents = plan::scatter_inputs(&plan, scene, points, direct).expect("inputs");
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let values = device.draw(plan, &contents).remove(0).values;
    values.chunks_exact(4).map(|t| [t[0], t[1], t[2]].map(f64::from)).collect()
}

pub fn sphere(count: usize) -> Directions {
    Directions::fibonacci(count, -1.0, 0).expect("directions")
}

fn f64s(colours: &[[f32; 3]]) -> Vec<[f64; 3]> {
    colours.iter().map(|c| c.map(f64::from)).collect()
}

/// One bounce with as many paths as directions uses each direction once: the mean of all, but for 16 roundings of each
/// of 24 terms. More bounces are the mean of seeds, within six of their standard errors plus roundings.
#[test]
fn scatter_paths_tend_to_the_mean_of_all_directions() {
    let mut device = Device::new();
    let mut next = random(81);
    let noise: Vec<f64> = (0..72).map(|_| next()).collect();
    let mut scene =
        under_sky(field(8, 9, [1.0, 1.5], |r, c| 2.0 * noise[9 * r + c]), Border::Periodic);
    scene.surface.albedo = Albedo::Map((0..72).map(|_| [0.9, next() as f32, 0.5]).collect());
    let direct: Vec<[f32; 3]> = (0..72).map(|_| [next() as f32, 1.0, 0.1]).collect();
    let points = points(&mut device, &scene, &sphere(24));
    let rounding = 16.0 * 24.0 / f64::from(1 << 24);
    let once = Scatter { bounces: 1, paths: 24, ..Scatter::default() };
    let got = scattered(&mut device, &scene, &points, &direct, &once);
    let want = expected(&scene, &points, &f64s(&direct), 1);
    for (got, want) in got.as_flattened().iter().zip(want.as_flattened()) {
        assert!((got - want).abs() <= rounding * want, "{got} {want}");
    }
    const SEEDS: u32 = 40;
    let want = expected(&scene, &points, &f64s(&direct), 3);
    let mut sums = vec![[0.0; 2]; 3 * 72];
    for seed in 0..SEEDS {
        let scatter = Scatter { bounces: 3, paths: 30, seed, ..Scatter::default() };
        let got = scattered(&mut device, &scene, &points, &direct, &scatter);
        for (sum, v) in sums.iter_mut().zip(got.as_flattened()) {
            *sum = [sum[0] + v, sum[1] + v * v];
        }
    }
    let n = f64::from(SEEDS);
    let (mut worst, mut biased) = (0.0_f64, 0.0_f64);
    for ([sum, squares], want) in sums.iter().zip(want.as_flattened()) {
        let mean = sum / n;
        let sigma = ((squares / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
        let bound = 6.0 * sigma + 3.0 * rounding * want;
        worst = worst.max((mean - want).abs() / bound);
        // A seventh of the light less would fail.
        biased = biased.max((mean - 0.85 * want).abs() / bound);
    }
    println!("{worst:.2} of what is allowed; {biased:.2} of 0.85 of the ground truth");
    assert!(worst <= 1.0 && biased > 1.0, "{worst} {biased}");
}

/// Error of a sum over N directions, of the radiance: cells of the directions, 4π/N each, that lie across a
/// silhouette, √(πN) of them along 2π, are wrong by up to a half of their weight, 4/N at most; if independent, 0.29 ·
/// 4/N · (πN)^¼, three times.
fn by_directions(count: usize) -> f64 {
    3.0 * 1.16 * std::f64::consts::PI.powf(0.25) * (count as f64).powf(-0.75)
}

/// The pit sees itself evenly, whichever texel a ray ends in. At the rim it may be one of the plain: within a cell of
/// it, once more the error of the rim's staircase.
#[test]
fn scattering_in_pits_matches_its_closed_form() {
    let mut device = Device::new();
    let rim = 12.5;
    for (alpha, albedo) in [(0.8, 0.5_f32), (1.2, 0.9)] {
        let rho = f64::from(albedo);
        let mut scene = under_sky(pit(rim, alpha), Border::Plane);
        scene.surface.albedo = Albedo::Constant([albedo; 3]);
        let side = scene.field.cols();
        let away = |i: usize| {
            let middle = (side / 2) as f64;
            ((i / side) as f64 - middle).hypot((i % side) as f64 - middle)
        };
        let own = |i: usize| if away(i) < rim { pit_radiance(alpha, rho, 0) } else { rho };
        let direct: Vec<[f32; 3]> = (0..side * side).map(|i| [own(i) as f32; 3]).collect();
        let points = points(&mut device, &scene, &sphere(1024));
        for bounces in [1, 2, 40] {
            let scatter = Scatter { bounces, paths: 1024, ..Scatter::default() };
            let light = match bounces {
                1 => scattered(&mut device, &scene, &points, &direct, &scatter),
                _ => expected(&scene, &points, &f64s(&direct), bounces),
            };
            let known = pit_radiance(alpha, rho, bounces as usize) - pit_radiance(alpha, rho, 0);
            let grid = pit_bounds(rim, alpha, rho, bounces as usize).pop().expect("bounds");
            let again = rho * 0.5 * (1.0 - alpha.cos());
            // Towards the rim N·e is half the chord over the radius, sin α at most; and no point is brighter than in
            // the limit.
            let most = alpha.sin() * pit_radiance(alpha, rho, 1000);
            let spread = rho * most * by_directions(1024) / (1.0 - again);
            let mut worst = 0.0_f64;
            for (i, bound) in &grid {
                let off = (light[*i][0] - known).abs();
                worst = worst.max(off / (2.0 * bound + spread));
            }
            println!("{alpha}, {albedo}, {bounces} bounces: {worst:.2} of what is allowed");
            assert!(worst <= 1.0, "{alpha} {albedo} {bounces}: {worst}");
            // The comparison fails without light.
            let least = grid.iter().map(|(_, bound)| 2.0 * bound + spread).fold(f64::MAX, f64::min);
            assert!(known > least, "{known} {least}");
        }
    }
}

/// The pit's second bounce, texel by texel: the mean of seeds is within six of their standard errors of the paths'
/// limit, and that within the bounds of the test before of the closed form.
#[test]
fn two_bounces_in_pits_match_their_closed_form() {
    const SEEDS: u32 = 8;
    let mut device = Device::new();
    let (rim, alpha, rho) = (12.5, 1.2, f64::from(0.9_f32));
    let mut scene = under_sky(pit(rim, alpha), Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.9; 3]);
    let side = scene.field.cols();
    let middle = (side / 2) as f64;
    let away = |i: usize| ((i / side) as f64 - middle).hypot((i % side) as f64 - middle);
    let own = |i: usize| if away(i) < rim { pit_radiance(alpha, rho, 0) } else { rho };
    let direct: Vec<[f32; 3]> = (0..side * side).map(|i| [own(i) as f32; 3]).collect();
    let points = points(&mut device, &scene, &sphere(4096));
    let mut sums = vec![[0.0; 2]; side * side];
    for seed in 0..SEEDS {
        let scatter = Scatter { bounces: 2, paths: 256, seed, ..Scatter::default() };
        let light = scattered(&mut device, &scene, &points, &direct, &scatter);
        for (sum, light) in sums.iter_mut().zip(light) {
            *sum = [sum[0] + light[0], sum[1] + light[0] * light[0]];
        }
    }
    let twice = pit_radiance(alpha, rho, 2) - pit_radiance(alpha, rho, 0);
    let grid = pit_bounds(rim, alpha, rho, 2).pop().expect("bounds");
    let again = rho * 0.5 * (1.0 - alpha.cos());
    let most = alpha.sin() * pit_radiance(alpha, rho, 1000);
    let by_directions = rho * most * by_directions(4096) / (1.0 - again);
    let n = f64::from(SEEDS);
    let mut worst = [0.0_f64; 2];
    for (i, bound) in &grid {
        let mean = sums[*i][0] / n;
        let sigma = ((sums[*i][1] / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
        let allowed = 2.0 * bound + by_directions + 6.0 * sigma;
        worst[0] = worst[0].max((mean - twice).abs() / allowed);
        worst[1] = worst[1].max((0.67 * mean - twice).abs() / allowed);
    }
    println!("{:.2} of what is allowed; {:.2} of two thirds of it", worst[0], worst[1]);
    assert!(worst[0] <= 1.0 && worst[1] > 1.0, "{worst:?}");
}

/// A wall of a groove at right angles is lit by the other: a closed form for one bounce and for two. The texel of a
/// hit is up to half a cell of √2 away, where direct light, ½ · (½ + ½ s/√(s² + a²)), differs by 1/4a of that at most;
/// of half of all visible ground.
#[test]
fn scattering_in_grooves_matches_its_closed_form() {
    let mut device = Device::new();
    let mut scene = under_sky(grooves(4), Border::Periodic);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    let s_of = |i: usize| (i % (2 * HALF)).abs_diff(HALF) as f64 * 2_f64.sqrt();
    let count = scene.field.heights_m().len();
    let direct: Vec<[f32; 3]> =
        (0..count).map(|i| [(0.5 * groove_sky(s_of(i))) as f32; 3]).collect();
    let [_, once, twice] = groove_parts();
    // For an even wall the kernel is half of the share that is not sky.
    assert!((from_the_other_wall(3.0, |_| 1.0) - (1.0 - groove_sky(3.0))).abs() < 1e-6);
    let points = points(&mut device, &scene, &sphere(1024));
    let grid = 0.5 * 0.5 * (0.5 * 2_f64.sqrt()) / (4.0 * WALL);
    let spread = 0.5 * 0.5 * by_directions(1024);
    let scatter = Scatter { bounces: 1, paths: 1024, ..Scatter::default() };
    let first = scattered(&mut device, &scene, &points, &direct, &scatter);
    let second = expected(&scene, &points, &f64s(&direct), 2);
    for i in (0..count).filter(|i| !(i % HALF).is_multiple_of(HALF)) {
        let (one, two) = (once(s_of(i)), once(s_of(i)) + twice(s_of(i)));
        // A second bounce also carries a quarter of the first one's error.
        let allowed = grid + spread;
        assert!((first[i][0] - one).abs() <= allowed, "{i}: {} {one} {allowed}", first[i][0]);
        let off = (second[i][0] - two).abs();
        assert!(off <= 1.25 * allowed, "{i}: {} {two} {allowed}", second[i][0]);
        assert!(one > allowed, "{one} {allowed}: all would do");
    }
}

/// Under walls of even direct light each place scatters its albedo's share of directions that are not sky, whichever
/// texel a ray ends in: the sum over directions is the only error. The comparison fails for a tenth less of the weight
/// of a direction or of its cosine, in the mean over the walls.
#[test]
fn even_walls_scatter_the_share_that_is_not_sky() {
    let mut device = Device::new();
    let mut scene = under_sky(grooves(4), Border::Periodic);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    let count = scene.field.heights_m().len();
    let points = points(&mut device, &scene, &sphere(4096));
    // Each direction once.
    let scatter = Scatter { bounces: 1, paths: 4096, ..Scatter::default() };
    let light = scattered(&mut device, &scene, &points, &vec![[0.5; 3]; count], &scatter);
    let (mut got, mut known, mut walls) = (0.0, 0.0, 0.0);
    for i in (0..count).filter(|i| !(i % HALF).is_multiple_of(HALF)) {
        let s = (i % (2 * HALF)).abs_diff(HALF) as f64 * 2_f64.sqrt();
        got += light[i][0];
        known += 0.5 * 0.5 * (1.0 - groove_sky(s));
        walls += 1.0;
    }
    let (got, known) = (got / walls, known / walls);
    let allowed = 0.5 * 0.5 * by_directions(4096);
    println!("{got} of {known}, within {allowed}");
    assert!((got - known).abs() <= allowed, "{got} {known} {allowed}");
    assert!((0.9 * got - known).abs() > allowed, "{got} {known}: a tenth less would do");
}

/// For walls at right angles: the eastern one faces a sun and reflects it by Phong specular alone; the western one,
/// which the sun does not reach, scatters that diffusely and towards a view that faces it. With directions u from its
/// plane up across the groove and v along it, a texel sees the other wall's lit texels between u₀ and u₁ and all v, dω
/// = cos v du dv; the cosine to its own normal is sin u cos v, and the cosine of the other wall's lobe, back to its
/// sun, is cos u cos v. Bottom and ridge are black: the texels next to them are on no wall.
///
/// A sum over N directions of w = 4π/N errs at the edges, arcs of v with √(N/4π) directions a radian each of which is
/// wrong by up to a half, independently: three times √(w² √(N/4π) ∮ f² / 12); and by its rule over a function that
/// changes within 1/(n + 2) radians, w (n + 2)² / 24 of itself.
#[test]
fn specular_scattering_of_walls_matches_its_integral() {
    const COUNT: usize = 4096;
    let mut device = Device::new();
    let (irradiance, albedo) = (2.0_f32, 0.5_f32);
    let towards = glam::DVec3::new(-0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt());
    for (exponent, share) in [(1.0_f32, 0.0_f32), (5.0, 0.0), (1.0, 0.4), (6.0, 0.4)] {
        let n = f64::from(exponent);
        let mut scene = under_sky(grooves(4), Border::Periodic);
        scene.lights = Lights {
            suns: vec![Sun {
                azimuth_rad: PI,
                elevation_rad: 0.25 * PI,
                diameter_rad: 0.0,
                irradiance: [irradiance; 3],
            }],
            ..Lights::default()
        };
        let count = scene.field.heights_m().len();
        let scale = |i: usize| match i % (2 * HALF) {
            0 | HALF => 0.0,
            column if column < HALF => share,
            _ => 0.25,
        };
        let phong_maps = (0..count).map(|i| PhongSpecular { exponent, scale: scale(i) }).collect();
        scene.surface.albedo = Albedo::Constant([albedo; 3]);
        scene.surface.specular = Some(Specular::Map(phong_maps));
        let points = points(&mut device, &scene, &sphere(COUNT));
        let view = glam::DVec3::new(-towards.x, 0.0, towards.z);
        let paths = COUNT as u32;
        let scatter = Scatter { bounces: 1, paths, view, ..Scatter::default() };
        let light = scattered(&mut device, &scene, &points, &vec![[0.0; 3]; count], &scatter);
        let peak = (n + 1.0) / (2.0 * PI);
        let lit = 0.25 * peak * f64::from(irradiance);
        let reflected = |own: f64, other: f64| {
            let phong_specular = f64::from(share) * peak * own.powf(n);
            (f64::from(albedo) / PI * own + phong_specular) * lit * other.powf(n)
        };
        let at = |u: f64, v: f64| reflected(u.sin() * v.cos(), u.cos() * v.cos());
        // Midpoints.
        let sum = |low: f64, high: f64, of: &dyn Fn(f64) -> f64| -> f64 {
            let step = (high - low) / 256.0;
            (0..256).map(|k| of(low + (f64::from(k) + 0.5) * step) * step).sum()
        };
        let along = |of: &dyn Fn(f64) -> f64| sum(-0.5 * PI, 0.5 * PI, of);
        let (mut got, mut known, mut most) = (0.0, 0.0, 0.0_f64);
        for i in (0..count).filter(|i| (1..HALF).contains(&(i % (2 * HALF)))) {
            let cells = (HALF - i % (2 * HALF)) as f64;
            let ends = [0.5, HALF as f64 - 0.5].map(|t| (t / cells).atan());
            let want = sum(ends[0], ends[1], &|u| along(&|v| at(u, v) * v.cos()));
            let edges: f64 = ends.iter().map(|u| along(&|v| at(*u, v).powi(2))).sum();
            let w = 4.0 * PI / COUNT as f64;
            let by_edges = 3.0 * w * (edges / w.sqrt() / 12.0).sqrt();
            let allowed = by_edges + want * w * (n + 2.0).powi(2) / 24.0;
            let off = (light[i][0] - want).abs();
            assert!(off <= allowed, "{exponent} {share} {i}: {} {want} {allowed}", light[i][0]);
            (got, known, most) = (got + light[i][0], known + want, most.max(allowed));
        }
        let grid_points = (4 * (HALF - 1)) as f64;
        let (got, known) = (got / grid_points, known / grid_points);
        println!("{exponent}, {share}: {got:.6} of {known:.6}, within {most:.6} each");
        // The comparison fails for a tenth less of specular, of cosine or of the weight of a direction.
        assert!((0.9 * got - known).abs() > 0.5 * most, "{exponent}: a tenth less would do");
    }
}

/// 50 paths and 50 more by a plan that replaces the first are 100: sums of terms in another order, each rounded within
/// 16 ε. Restarted paths would be 50.
#[test]
fn paths_are_added_to_those_before() {
    let mut device = Device::new();
    let mut next = random(82);
    let noise: Vec<f64> = (0..63).map(|_| 2.0 * next()).collect();
    let mut scene = under_sky(field(7, 9, [1.0; 2], |r, c| noise[9 * r + c]), Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.8, 0.5, 0.3]);
    let points = points(&mut device, &scene, &sphere(30));
    let direct = vec![[1.0, 0.5, 2.0]; 63];
    let all = |first_path, paths| Scatter { bounces: 2, first_path, paths, ..Scatter::default() };
    let want = scattered(&mut device, &scene, &points, &direct, &all(0, 100));
    let limits = device.limits();
    let plan = |scatter| plan::scatter(&scene, points.directions(), &scatter, &limits);
    let [first, more] = [all(0, 50), all(50, 50)].map(|scatter| plan(scatter).expect("a plan"));
    let contents = plan::scatter_inputs(&first, &scene, &points, &direct).expect("inputs");
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = gpu.frame(first, &contents).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let before = gpu.pixels(&frame, 0).expect("texels").values;
    gpu.replace_plan(&mut frame, more).expect("a plan of the same passes");
    gpu.draw(&mut frame).expect("drawn");
    let got = gpu.pixels(&frame, 0).expect("texels").values;
    gpu.end(frame);
    let mut moved = 0.0_f64;
    for (i, want) in want.iter().enumerate() {
        assert_eq!((before[4 * i + 3], got[4 * i + 3]), (50.0, 100.0));
        for (c, want) in want.iter().enumerate() {
            let [had, got] = [&before, &got].map(|v| f64::from(v[4 * i + c]));
            assert!(
                (got - want).abs() <= 16.0 / f64::from(1 << 24) * want,
                "{i} {c}: {got} {want}"
            );
            moved = moved.max((had - got).abs() / got.max(1e-30));
        }
    }
    assert!(moved > 0.01, "half of the paths are as good: {moved}");
}

/// Black ground scatters 0, whatever occludes it, and the plan states 0 paths.
#[test]
fn black_ground_scatters_nothing() {
    let mut device = Device::new();
    let mut scene = under_sky(grooves(4), Border::Periodic);
    scene.surface.albedo = Albedo::Constant([0.0; 3]);
    let plan = plan::scatter(&scene, &sphere(16), &Scatter::default(), &device.limits());
    let drawn = device.draw(plan.expect("a plan"), &[]).remove(0);
    assert!(drawn.values.iter().all(|v| *v == 0.0));
}

/// Wrong arguments of scattering are refused by name.
#[test]
fn scattering_is_refused_by_name() {
    use ridgelight::plan::Limits;
    let scene = under_sky(grooves(4), Border::Periodic);
    let said = |scatter: Scatter| {
        let plan = plan::scatter(&scene, &sphere(16), &scatter, &Limits::lavapipe());
        plan.unwrap_err().to_string()
    };
    assert!(said(Scatter { bounces: 0, ..Scatter::default() }).contains("bounces"));
    assert!(said(Scatter { paths: 5000, ..Scatter::default() }).contains("paths"));
    assert!(
        said(Scatter { bounces: 65, direct_specular: true, ..Scatter::default() })
            .contains("bounces")
    );
    assert!(said(Scatter { view: glam::DVec3::ZERO, ..Scatter::default() }).contains("view"));
    let mut device = Device::new();
    let visible = points(&mut device, &scene, &sphere(16));
    let direct = vec![[1.0; 3]; scene.field.heights_m().len()];
    for count in [14, 18] {
        let scatter = Scatter::default();
        let plan = plan::scatter(&scene, &sphere(count), &scatter, &Limits::lavapipe());
        let inputs = plan::scatter_inputs(&plan.expect("a plan"), &scene, &visible, &direct);
        let said = inputs.unwrap_err().to_string();
        assert!(said.contains("directions"), "{said}");
    }
}
