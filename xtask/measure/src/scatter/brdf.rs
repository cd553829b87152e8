//! The BRDFs of whole fields, with and without scattered light, beside their own geometry.
//!
//! Periodic fields. A table over a grid of angles: its error of reciprocity, how much leaves, and the error of 64 pairs
//! between its angles by the table itself, by sums of products of functions of one direction, and by SH. Then 50 other
//! pairs: the geometry, path-traced over repetitions of the field and drawn by an orthographic camera, its mean over one
//! repetition; the field's triangles for that pair; the table; factors.

use std::path::{Path, PathBuf};

use glam::DVec3;
use ridgelight::gpu::Headless;
use ridgelight::plan::Limits;
use ridgelight::scene::{
    Albedo, Border, Curvature, Directions, HeightField, Lights, Scatter, Scene, Surface,
    VisiblePoints,
};
use ridgelight::{Error, Result};
use ridgelight_bake::{
    Angles, Brdf, BrdfHarmonics, ExitRadiance, Facets, Factors, facets, lit_from, pairs,
};

use super::geometry::{Geometry, sun};
use super::strip;
use crate::common::args::Args;
use crate::common::frames::{device, open, rms};
use crate::common::{Outcome, head, inputs};

pub const ANGLES: Angles = Angles { zeniths: 8, azimuths: 16 };
/// Pairs between the angles, and pairs whose geometry is drawn.
const BETWEEN: usize = 64;
const PAIRS: usize = 50;
/// Of scattered light.
const DIRECTIONS: usize = 256;
pub const SCATTER: Scatter = Scatter {
    bounces: 4,
    paths: 256,
    first_path: 0,
    cutoff: 1.0 / 65536.0,
    seed: 0,
    view: DVec3::Z,
    direct_specular: false,
    curvature: Curvature::FLAT,
};
const FACTORS: [usize; 5] = [1, 2, 4, 8, 16];
/// Kept as `bake --what brdf-factors` keeps them.
pub const KEPT: usize = 8;
const ORDERS: [usize; 3] = [2, 4, 6];
/// Lights and views of pairs, lower than which a camera sees many repetitions at once.
const LOWEST_DEG: f64 = 15.0;

/// A scene, and how finely it is sampled.
pub struct Aggregate<'a> {
    pub scene: &'a Scene,
    /// Visible points all around.
    pub around: VisiblePoints,
    /// Triangles that each cell is cut into, along an edge.
    pub times: usize,
    /// And each for its geometry.
    pub geometry: usize,
    pub limits: Limits,
}

impl Aggregate<'_> {
    pub fn of<'a>(gpu: &mut Headless, scene: &'a Scene, geometry: usize) -> Result<Aggregate<'a>> {
        let limits = gpu.report().limits;
        let border = scene.surface.border;
        let directions = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
        let around = gpu.visible_points((&scene.field, border), &directions, &limits)?;
        let times = if scene.field.heights_m().len() > 2048 { 2 } else { 4 };
        Ok(Aggregate { scene, around, times, geometry, limits })
    }

    /// Radiance of all triangles under each light in turn.
    pub fn each(
        &self,
        gpu: &mut Headless,
        facets: &Facets,
        lights: usize,
        is_scattered: bool,
        mut take: impl FnMut(usize, &ExitRadiance),
    ) -> Result<()> {
        let scatter = is_scattered.then_some((&self.around, &SCATTER));
        // What is diffuse leaves towards all views alike.
        let of = (facets, 0..lights, &(|_| 0_usize..0) as &dyn Fn(usize) -> _);
        lit_from(gpu, self.scene, of, scatter, &self.limits, &mut |light, l| {
            take(light, &l);
            Ok(())
        })
    }

    pub fn table(&self, gpu: &mut Headless, is_scattered: bool) -> Result<(Brdf, Facets)> {
        let directions = ANGLES.directions()?;
        let facets = facets(gpu, self.scene, self.times, &directions, &self.limits)?;
        facets.check()?;
        let mut values = Vec::new();
        self.each(gpu, &facets, directions.count(), is_scattered, |light, radiance| {
            let z = directions.vectors()[light].z;
            values.extend(facets.radiance_from_all(radiance).into_iter().map(|m| m.map(|v| v / z)));
        })?;
        Ok((Brdf::from_values(directions.vectors().to_vec(), values)?, facets))
    }

    /// Of pairs, lights first, each its own: f, 1/sr.
    pub fn pairs(
        &self,
        gpu: &mut Headless,
        pairs: &Directions,
        is_scattered: bool,
    ) -> Result<Vec<[f64; 3]>> {
        let count = pairs.count() / 2;
        let facets = facets(gpu, self.scene, self.times, pairs, &self.limits)?;
        let mut all = Vec::new();
        self.each(gpu, &facets, count, is_scattered, |light, radiance| {
            let z = pairs.vectors()[light].z;
            all.push(facets.radiance_from(count + light, radiance).map(|m| m / z));
        })?;
        Ok(all)
    }
}

/// One groove of the paper's figure 2, 32 wide: walls at right angles, those that look west red, the others white. Many columns
/// and few rows, as along it nothing changes.
pub fn groove() -> Result<Scene> {
    const ROWS: usize = 8;
    const COLS: usize = 128;
    let heights: Vec<f64> =
        (0..ROWS * COLS).map(|i| 0.25 * (i % COLS).abs_diff(COLS / 2) as f64).collect();
    // A triangle has the mean colour of its corners: valley and ridge are pink for a cell.
    let colour = |i: usize| if i % COLS > COLS / 2 { [0.8, 0.1, 0.1] } else { [0.8; 3] };
    let albedo = Albedo::Map((0..ROWS * COLS).map(colour).collect());
    let field = HeightField::new(ROWS, COLS, &heights, [0.25, 4.0], None)?;
    let surface = Surface { albedo, border: Border::Periodic, specular: None };
    Ok(Scene { field, surface, lights: Lights::default() })
}

/// Pairs that are not too low, the lights first.
fn drawn_pairs() -> Result<Directions> {
    let many = pairs(2 * PAIRS, 1)?;
    let (lights, views) = many.vectors().split_at(2 * PAIRS);
    let low = LOWEST_DEG.to_radians().sin();
    let kept: Vec<_> =
        lights.iter().zip(views).filter(|(l, v)| l.z.min(v.z) > low).take(PAIRS).collect();
    if kept.len() < PAIRS {
        let found = format!("{} high enough", kept.len());
        return Err(Error::setting("pairs", found, PAIRS.to_string()));
    }
    let all = kept.iter().map(|p| *p.0).chain(kept.iter().map(|p| *p.1));
    Directions::from_vectors(all.collect(), 0.0)
}

/// Rms of differences over rms, %.
fn left(found: &[[f64; 3]], known: &[[f64; 3]]) -> f64 {
    let pairs = found.as_flattened().iter().zip(known.as_flattened());
    let known = rms(known.as_flattened().iter().copied());
    100.0 * rms(pairs.map(|(a, b)| a - b)) / known.max(f64::MIN_POSITIVE)
}

/// All of the moss as means over squares, 32 a side, so that it still repeats.
fn moss(folder: &Path) -> Result<Scene> {
    const SIDE: usize = 32;
    let whole = inputs::field_of(folder, inputs::MOSS)?;
    let each = whole.cols() / SIDE;
    let mean = |i: usize| {
        let first = [i / SIDE * each, i % SIDE * each];
        let at = |k: usize| (first[0] + k / each) * whole.cols() + first[1] + k % each;
        let all = (0..each * each).map(|k| f64::from(whole.heights_m()[at(k)]));
        all.sum::<f64>() / (each * each) as f64
    };
    let heights: Vec<f64> = (0..SIDE * SIDE).map(mean).collect();
    let field = HeightField::new(SIDE, SIDE, &heights, [each as f64; 2], None)?;
    let surface = inputs::matte([0.55, 0.7, 0.25], Border::Periodic);
    Ok(Scene { field, surface, lights: Lights::default() })
}

pub fn run(mut args: Args) -> Outcome {
    let output = args.path("-o")?;
    let folder = args.word().map(PathBuf::from);
    args.end()?;
    let mut gpu = open()?;
    println!(
        "{}\n\nA table of {} × {} angles for lights and for views, {} bounces by {DIRECTIONS} directions and {} paths\n",
        device(&gpu),
        ANGLES.zeniths,
        ANGLES.azimuths,
        SCATTER.bounces,
        SCATTER.paths
    );
    let mut scenes = vec![("groove", groove()?, 1)];
    if let Some(folder) = folder {
        scenes.push(("moss", moss(&folder)?, 4));
    }
    for (name, scene, geometry) in scenes {
        let aggregate = Aggregate::of(&mut gpu, &scene, geometry)?;
        one(&mut gpu, name, &aggregate)?;
    }
    output.map_or(Ok(()), |path| Ok(strip::picture(&mut gpu, &path)?))
}

fn one(gpu: &mut Headless, name: &str, aggregate: &Aggregate) -> Result<()> {
    let scene = aggregate.scene;
    let between = pairs(BETWEEN, 0)?;
    let weights = ANGLES.projected_sr();
    head(&format!(
        "| {name}, {} × {} | not reciprocal, % | reflected, %: least | most | closure, worst % | left of {BETWEEN} pairs between, %: table | {} | {} |",
        scene.field.cols(),
        scene.field.rows(),
        FACTORS.map(|n| format!("{n} factors")).join(" | "),
        ORDERS.map(|n| format!("order {n}")).join(" | ")
    ));
    let mut series = Vec::new();
    for (is_scattered, label) in [(false, "direct"), (true, "all")] {
        let (table, facets) = aggregate.table(gpu, is_scattered)?;
        let reflected = (0..ANGLES.count()).flat_map(|light| table.reflected(light, &weights));
        let [least, most] = reflected.fold([f64::MAX, 0.0_f64], |[l, m], r| [l.min(r), m.max(r)]);
        let closure = (0..ANGLES.count()).map(|i| (facets.closure(i) - 1.0).abs());
        let known = aggregate.pairs(gpu, &between, is_scattered)?;
        let of = |value: &dyn Fn(DVec3, DVec3) -> [f64; 3]| {
            let (lights, views) = between.vectors().split_at(BETWEEN);
            let found: Vec<_> = lights.iter().zip(views).map(|(l, v)| value(*l, *v)).collect();
            format!("{:.1}", left(&found, &known))
        };
        let mut row = vec![of(&|l, v| table.between(&ANGLES, l, v))];
        for count in FACTORS {
            let factors = Factors::of(&table, ANGLES, count, false)?;
            row.push(of(&|l, v| factors.at(l, v)));
        }
        for order in ORDERS {
            let harmonics = BrdfHarmonics::of(&table, ANGLES, order, false)?;
            row.push(of(&|l, v| harmonics.at(l, v)));
        }
        println!(
            "| {label} | {:.3} | {:.1} | {:.1} | {:.1} | {} |",
            100.0 * table.unreciprocal(),
            100.0 * least,
            100.0 * most,
            100.0 * closure.fold(0.0, f64::max),
            row.join(" | ")
        );
        series.push((Factors::of(&table, ANGLES, KEPT, false)?, table));
    }
    println!();
    far(gpu, aggregate, &series)
}

/// Mean radiance of pairs that no table knows.
fn far(gpu: &mut Headless, aggregate: &Aggregate, series: &[(Factors, Brdf)]) -> Result<()> {
    let pairs = drawn_pairs()?;
    let (lights, views) = pairs.vectors().split_at(PAIRS);
    head(&format!(
        "| {PAIRS} pairs | mean radiance of the geometry | error of triangles, % | rms | of the table, % | rms | of {KEPT} factors, % | rms |"
    ));
    for (is_scattered, label) in [(false, "direct"), (true, "all")] {
        let own = aggregate.pairs(gpu, &pairs, is_scattered)?;
        let (factors, table) = &series[usize::from(is_scattered)];
        let mut means = [[0.0; 4]; PAIRS];
        for (i, (l, v)) in lights.iter().zip(views).enumerate() {
            let bounces = if is_scattered { SCATTER.bounces } else { 0 };
            let geometry =
                Geometry::of(gpu, (aggregate.scene, aggregate.geometry), &[*v], sun(*l), bounces)?;
            let drawn = geometry.mean(gpu, *v)?;
            geometry.end(gpu);
            let by = [own[i], table.between(&ANGLES, *l, *v), factors.at(*l, *v)];
            let [a, b, c] = by.map(|f| f.map(|f| f * l.z));
            means[i] = [drawn, a, b, c].map(|rgb| rgb.iter().sum::<f64>() / 3.0);
        }
        let sum = |k: usize| means.iter().map(|m| m[k]).sum::<f64>() / PAIRS as f64;
        let cell = |k: usize| {
            let squares = means.iter().map(|m| (m[k] - m[0]).powi(2)).sum::<f64>();
            let rms = (squares / PAIRS as f64).sqrt() / sum(0);
            format!("{:+.2} | {:.2}", 100.0 * (sum(k) / sum(0) - 1.0), 100.0 * rms)
        };
        println!("| {label} | {:.4} | {} | {} | {} |", sum(0), cell(1), cell(2), cell(3));
    }
    println!();
    Ok(())
}
