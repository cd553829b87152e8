//! Light scattered by what samples see of each other: what its paths tend to, and closed forms.

use ridgelight::cpu::scatter_gather::expected;
use ridgelight::plan;
use ridgelight::scene::{Albedo, Border, Directions, Scatter, Scene, VisiblePoints};

use crate::reference_page::{
    HALF, WALL, from_the_other_wall, groove_parts, groove_sky, grooves, pit, pit_bounds,
    pit_radiance,
};
use crate::{Device, field, random, under_sky};

fn points(device: &mut Device, scene: &Scene, directions: &Directions) -> VisiblePoints {
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

fn sphere(count: usize) -> Directions {
    Directions::fibonacci(count, -1.0, 0).expect("directions")
}

fn f64s(colours: &[[f32; 3]]) -> Vec<[f64; 3]> {
    colours.iter().map(|c| c.map(f64::from)).collect()
}

/// One bounce by as many paths as directions looks along each once: the mean of all, but for roundings, 16 of each of
/// 24 terms. More bounces are the mean of seeds, within six of their standard errors, and as much as roundings may do.
#[test]
fn paths_tend_to_the_mean_of_all_directions() {
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
        // A seventh of the light less would be seen.
        biased = biased.max((mean - 0.85 * want).abs() / bound);
    }
    println!("{worst:.2} of what is allowed; {biased:.2} of 0.85 of the truth");
    assert!(worst <= 1.0 && biased > 1.0, "{worst} {biased}");
}

/// By how much a sum over N directions may be off, of the radiance that it is over: cells of the directions, 4π/N each, that
/// lie across the edge of what is seen, √(πN) of them along 2π, are wrong by up to a half of their weight, 4/N at most; as
/// if by chance, 0.29 · 4/N · (πN)^¼, thrice.
fn by_directions(count: usize) -> f64 {
    3.0 * 1.16 * std::f64::consts::PI.powf(0.25) * (count as f64).powf(-0.75)
}

/// The pit sees itself evenly, whatever sample stands for what is seen. At the rim a sample of the plain may: within a
/// cell of it, as what the rim's staircase does, once more.
#[test]
fn pits_scatter_as_their_closed_form() {
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
            // Towards the rim N·e is half the chord over the radius, sin α at most; and no place shines brighter than in
            // the limit.
            let most = alpha.sin() * pit_radiance(alpha, rho, 1000);
            let chance = rho * most * by_directions(1024) / (1.0 - again);
            let mut worst = 0.0_f64;
            for (i, bound) in &grid {
                let off = (light[*i][0] - known).abs();
                worst = worst.max(off / (2.0 * bound + chance));
            }
            println!("{alpha}, {albedo}, {bounces} bounces: {worst:.2} of what is allowed");
            assert!(worst <= 1.0, "{alpha} {albedo} {bounces}: {worst}");
            // No light at all is seen to be wrong.
            let least = grid.iter().map(|(_, bound)| 2.0 * bound + chance).fold(f64::MAX, f64::min);
            assert!(known > least, "{known} {least}");
        }
    }
}

/// A wall of a groove at right angles is lit by the other: a closed form for one bounce and for two. The sample that stands
/// for what is seen is up to half a cell of √2 away, where direct light, ½ · (½ + ½ s/√(s² + a²)), differs by 1/4a of that
/// at most; of half of all that is seen.
#[test]
fn grooves_scatter_as_their_closed_form() {
    let mut device = Device::new();
    let mut scene = under_sky(grooves(4), Border::Periodic);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    let s_of = |i: usize| (i % (2 * HALF)).abs_diff(HALF) as f64 * 2_f64.sqrt();
    let count = scene.field.heights_m().len();
    let direct: Vec<[f32; 3]> =
        (0..count).map(|i| [(0.5 * groove_sky(s_of(i))) as f32; 3]).collect();
    let [_, once, twice] = groove_parts();
    // Of an even wall the kernel is half of what is not sky.
    assert!((from_the_other_wall(3.0, |_| 1.0) - (1.0 - groove_sky(3.0))).abs() < 1e-6);
    let points = points(&mut device, &scene, &sphere(1024));
    let grid = 0.5 * 0.5 * (0.5 * 2_f64.sqrt()) / (4.0 * WALL);
    let chance = 0.5 * 0.5 * by_directions(1024);
    let scatter = Scatter { bounces: 1, paths: 1024, ..Scatter::default() };
    let first = scattered(&mut device, &scene, &points, &direct, &scatter);
    let second = expected(&scene, &points, &f64s(&direct), 2);
    for i in (0..count).filter(|i| !(i % HALF).is_multiple_of(HALF)) {
        let (one, two) = (once(s_of(i)), once(s_of(i)) + twice(s_of(i)));
        // A second bounce throws half of half of what the first is off by, too.
        let allowed = grid + chance;
        assert!((first[i][0] - one).abs() <= allowed, "{i}: {} {one} {allowed}", first[i][0]);
        let off = (second[i][0] - two).abs();
        assert!(off <= 1.25 * allowed, "{i}: {} {two} {allowed}", second[i][0]);
        assert!(one > allowed, "{one} {allowed}: all would do");
    }
}

/// Under walls of even direct light each place scatters its albedo's share of what is not sky, whichever sample stands for
/// what is seen: off by the sum over directions alone. In the mean over the walls a tenth less, of the weight of a direction or
/// of its cosine, is seen to be wrong.
#[test]
fn even_walls_scatter_what_is_not_sky() {
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

/// What cannot be scattered is refused by name.
#[test]
fn scattering_is_refused_by_name() {
    use ridgelight::plan::Limits;
    let scene = under_sky(grooves(4), Border::Periodic);
    let said = |scatter: Scatter| {
        let plan = plan::scatter(&scene, &sphere(16), &scatter, &Limits::lavapipe());
        plan.unwrap_err().to_string()
    };
    assert!(said(Scatter { bounces: 0, ..Scatter::default() }).contains("--bounces"));
    assert!(said(Scatter { paths: 5000, ..Scatter::default() }).contains("--paths"));
    assert!(said(Scatter { view: glam::DVec3::ZERO, ..Scatter::default() }).contains("view"));
    let mut device = Device::new();
    let seen = points(&mut device, &scene, &sphere(16));
    let direct = vec![[1.0; 3]; scene.field.heights_m().len()];
    for count in [14, 18] {
        let scatter = Scatter::default();
        let plan = plan::scatter(&scene, &sphere(count), &scatter, &Limits::lavapipe());
        let inputs = plan::scatter_inputs(&plan.expect("a plan"), &scene, &seen, &direct);
        let said = inputs.unwrap_err().to_string();
        assert!(said.contains("directions"), "{said}");
    }
}
