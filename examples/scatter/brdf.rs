//! What a field is seen from afar: its BRDF by visible points, with and without scattered light.
//!
//! Two periodic fields. A table of 100 × 100 lights and views, its reciprocity and energy, what harmonics of each order
//! leave; then 50 lights and views of their own, drawn at random: the mean radiance of what is seen by light paths, by the
//! same visible points for that pair, and by the harmonics.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::measure::facets::{FacetHarmonics, Facets, Shown};
use ridgelight::plan;
use ridgelight::scene::{
    Albedo, Border, Curvature, Directions, HeightField, Lights, Scatter, Scene, Sun, Surface,
    VisiblePoints,
};

use crate::seen::points;
use crate::traced::traced;
use crate::{colours, grooves};

/// Directions of the table, for lights and for views.
const TABLE: usize = 100;
const PAIRS: usize = 50;
/// Of scattered light.
const DIRECTIONS: usize = 256;
const SCATTER: Scatter = Scatter {
    bounces: 4,
    paths: 256,
    first_path: 0,
    cutoff: 1.0 / 65536.0,
    seed: 0,
    view: glam::DVec3::Z,
    curvature: Curvature::FLAT,
};
/// Of 64 light paths.
const BATCHES: u32 = 16;

fn waves() -> Result<Scene> {
    let wave = |n: usize| (std::f64::consts::TAU * n as f64 / 16.0).sin();
    let heights: Vec<f64> = (0..32 * 32).map(|i| 3.0 * wave(i / 32) * wave(i % 32)).collect();
    let field = HeightField::new(32, 32, &heights, [1.0; 2], None)?;
    let albedo = Albedo::Constant([0.8; 3]);
    let surface = Surface { albedo, border: Border::Periodic, phong: None };
    Ok(Scene { field, surface, lights: Lights::default() })
}

/// Radiance of all samples under each light in turn: direct, and scattered besides.
fn lit_by_all(
    gpu: &mut Headless,
    scene: &Scene,
    shown: &Shown,
    lights: usize,
    points: &VisiblePoints,
) -> Result<Vec<[Vec<[f64; 3]>; 2]>> {
    let plan = plan::scatter(scene, points.directions(), &SCATTER, &gpu.report().limits)?;
    let f32s =
        |all: &[[f64; 3]]| -> Vec<[f32; 3]> { all.iter().map(|v| v.map(|v| v as f32)).collect() };
    let direct = shown.lit_from(0);
    let contents = plan::scatter_inputs(&plan, scene, points, &f32s(&direct))?;
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        let mut all = Vec::new();
        for light in 0..lights {
            let direct = shown.lit_from(light);
            let texels: Vec<f32> =
                f32s(&direct).iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
            gpu.refill(frame, 1, &texels)?;
            gpu.draw(frame)?;
            let more = colours(&gpu.pixels(frame, 0)?.values);
            let whole = direct.iter().zip(&more);
            let whole = whole.map(|(a, b)| [0, 1, 2].map(|c| a[c] + f64::from(b[c]))).collect();
            all.push([direct, whole]);
        }
        Ok(all)
    })
}

/// Lights and views above 10°, evenly over the hemisphere above.
fn at_random(count: usize) -> Result<Directions> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let low = 10_f64.to_radians().sin();
    let vectors = (0..count).map(|_| {
        let (z, turn) = (low + (1.0 - low) * next(), std::f64::consts::TAU * next());
        let across = (1.0 - z * z).sqrt();
        glam::DVec3::new(across * turn.cos(), across * turn.sin(), z)
    });
    Directions::from_vectors(vectors.collect(), 0.0)
}

fn percent(of: [f64; 3]) -> f64 {
    100.0 * of.iter().sum::<f64>() / 3.0
}

pub fn run(gpu: &mut Headless) -> Result<()> {
    println!("Seen from afar: {TABLE} × {TABLE} lights and views, {} bounces\n", SCATTER.bounces);
    for (name, scene) in [("grooves", grooves(4, 64, 64)?), ("waves", waves()?)] {
        one(gpu, name, &scene)?;
    }
    Ok(())
}

fn one(gpu: &mut Headless, name: &str, scene: &Scene) -> Result<()> {
    let (field, border) = (&scene.field, scene.surface.border);
    let (around, _) = points(gpu, field, border, &Directions::fibonacci(DIRECTIONS, -1.0, 0)?)?;
    let (above, _) = points(gpu, field, border, &Directions::fibonacci(TABLE, 0.0, 0)?)?;
    let shown = Shown::of(scene, &above)?;
    let radiance = lit_by_all(gpu, scene, &shown, TABLE, &around)?;
    println!(
        "| {name} | not reciprocal, % | reflected, %: least | most | left by harmonics of order 2 | 3 | 4 | 5 | 6 |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut series = Vec::new();
    for (what, label) in [(0, "direct"), (1, "all")] {
        let table = Facets::of(&shown, |light| Ok(radiance[light][what].clone()))?;
        let reflected = (0..TABLE).map(|light| percent(table.reflected(light)));
        let (least, most) = reflected.fold((f64::MAX, 0.0), |(l, m), v| (v.min(l), v.max(m)));
        let mut left = Vec::new();
        for order in 2..=6 {
            let of = FacetHarmonics::of(&table, order)?;
            left.push(format!("{:.2}", 100.0 * of.residual));
            if order == 6 {
                series.push(of);
            }
        }
        println!(
            "| {label} | {:.3} | {least:.1} | {most:.1} | {} |",
            100.0 * table.unreciprocal(),
            left.join(" | ")
        );
    }
    println!();
    far(gpu, scene, &around, &series)
}

/// Means over what is seen, of pairs that no table knows.
fn far(
    gpu: &mut Headless,
    scene: &Scene,
    around: &VisiblePoints,
    series: &[FacetHarmonics],
) -> Result<()> {
    let (field, border) = (&scene.field, scene.surface.border);
    let pairs = at_random(2 * PAIRS)?;
    let (above, _) = points(gpu, field, border, &pairs)?;
    let shown = Shown::of(scene, &above)?;
    let radiance = lit_by_all(gpu, scene, &shown, PAIRS, around)?;
    // By what is direct and by all: traced, the pair's own points, harmonics.
    let mut means = vec![[[0.0; 3]; PAIRS]; 2];
    for light in 0..PAIRS {
        let (e, view) = (pairs.vectors()[light], PAIRS + light);
        let sun = Sun {
            azimuth_rad: e.y.atan2(e.x),
            elevation_rad: e.z.asin(),
            diameter_rad: 0.0,
            irradiance: [1.0; 3],
        };
        let lights = Lights { suns: vec![sun], ..Lights::default() };
        let lit = Scene { lights, ..scene.clone() };
        for (what, bounces) in [(0, 0), (1, SCATTER.bounces)] {
            let batches = if bounces == 0 { 1 } else { BATCHES };
            let [light_paths, _] = traced(gpu, &lit, bounces, batches)?;
            let traced: Vec<[f64; 3]> =
                colours(&light_paths).iter().map(|v| v.map(f64::from)).collect();
            let own = shown.mean_from(view, &radiance[light][what]);
            let of = series[what].at(e, pairs.vectors()[view]).map(|f| f * e.z);
            means[what][light] = [shown.mean_from(view, &traced), own, of]
                .map(|mean| mean.iter().sum::<f64>() / 3.0);
        }
    }
    println!(
        "| {PAIRS} pairs | mean radiance by light paths | visible points, % off | rms | harmonics of order 6, % off | rms |"
    );
    println!("|---|---|---|---|---|---|");
    for (what, label) in [(0, "direct"), (1, "all")] {
        let sum = |k: usize| means[what].iter().map(|m| m[k]).sum::<f64>() / PAIRS as f64;
        let traced = sum(0);
        let off = |k: usize| 100.0 * (sum(k) / traced - 1.0);
        let rms = |k: usize| {
            let squares = means[what].iter().map(|m| (m[k] - m[0]).powi(2)).sum::<f64>();
            100.0 * (squares / PAIRS as f64).sqrt() / traced
        };
        println!(
            "| {label} | {traced:.4} | {:+.2} | {:.2} | {:+.2} | {:.2} |",
            off(1),
            rms(1),
            off(2),
            rms(2)
        );
    }
    println!();
    Ok(())
}
