//! The BRDFs of whole fields, with and without scattered light, against their own geometry.
//!
//! Fields repeat. A table over a grid of angles: its error of reciprocity, what it reflects, and the
//! error of 64 pairs between its angles by the table itself, by sums of products of functions of one
//! direction, and by SH. Then 50 other pairs: the geometry, path-traced over repetitions of the field
//! and drawn by an orthographic camera, its mean over one repetition; the field's triangles for that
//! pair; the table; factors. The picture is figure 9 of Heidrich et al. 2000: a strip bent across its
//! grooves, as geometry and by its BRDF, without and with scattered light.

use std::path::Path;

use glam::DVec3;
use ridgelight::gpu::Headless;
use ridgelight::plan::Limits;
use ridgelight::scene::{
    Albedo, Border, Curvature, Directions, HeightField, Lights, Scatter, Scene, Surface,
    VisiblePoints,
};
use ridgelight::{Error, Result};
use ridgelight_bake::{Angles, Brdf, BrdfHarmonics, Facets, Factors, facets, pairs};

use super::geometry::Geometry;
use crate::bake::light::lit_from_each;
use crate::common::args::Args;
use crate::common::frames::{device, rms};
use crate::common::{Outcome, cells, head, inputs, plot};

const ANGLES: Angles = Angles { zeniths: 8, azimuths: 16 };
/// Pairs between the angles, and pairs whose geometry is drawn.
const BETWEEN: usize = 64;
const PAIRS: usize = 50;
/// Of scattered light.
const DIRECTIONS: usize = 256;
const SCATTER: Scatter = Scatter {
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
const KEPT: usize = 8;
const ORDERS: [usize; 3] = [2, 4, 6];
/// Below this elevation of a light or view a camera shows many repetitions at once.
const LOWEST_DEG: f64 = 15.0;
/// Direct light and all light.
const KINDS: [(bool, &str); 2] = [(false, "direct"), (true, "all")];

/// A scene whose far field is measured.
struct Aggregate<'a> {
    scene: &'a Scene,
    /// Visible points all around.
    around: VisiblePoints,
    /// Each cell is cut into `times`² more for triangles, and `geometry`² more for its geometry.
    times: usize,
    geometry: usize,
    limits: Limits,
}

impl<'a> Aggregate<'a> {
    fn of(gpu: &mut Headless, scene: &'a Scene, geometry: usize) -> Result<Self> {
        let limits = gpu.report().limits;
        let directions = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
        let ground = (&scene.field, scene.surface.border);
        let around = gpu.visible_points(ground, &directions, &limits)?;
        let times = if scene.field.heights_m().len() > 2048 { 2 } else { 4 };
        Ok(Aggregate { scene, around, times, geometry, limits })
    }

    fn table(&self, gpu: &mut Headless, is_scattered: bool) -> Result<(Brdf, Facets)> {
        let directions = ANGLES.directions()?;
        let facets = facets(gpu, self.scene, self.times, &directions, &self.limits)?;
        facets.check()?;
        let mut values = Vec::new();
        let scatter = is_scattered.then_some((&self.around, &SCATTER));
        lit_from_each(gpu, self.scene, (&facets, ANGLES.count()), scatter, |light, radiance| {
            let z = directions.vectors()[light].z;
            values.extend(facets.radiance_from_all(radiance).into_iter().map(|m| m.map(|v| v / z)));
        })?;
        Ok((Brdf::from_values(directions.vectors().to_vec(), values)?, facets))
    }

    /// f of each pair, 1/sr; lights come first.
    fn pairs(
        &self,
        gpu: &mut Headless,
        pairs: &Directions,
        is_scattered: bool,
    ) -> Result<Vec<[f64; 3]>> {
        let count = pairs.count() / 2;
        let facets = facets(gpu, self.scene, self.times, pairs, &self.limits)?;
        let mut all = Vec::new();
        let scatter = is_scattered.then_some((&self.around, &SCATTER));
        lit_from_each(gpu, self.scene, (&facets, count), scatter, |light, radiance| {
            let z = pairs.vectors()[light].z;
            all.push(facets.radiance_from(count + light, radiance).map(|m| m / z));
        })?;
        Ok(all)
    }

    /// `work` on the geometry, lit from a direction, for a view.
    fn with_geometry<T>(
        &self,
        gpu: &mut Headless,
        pair: [DVec3; 2],
        is_scattered: bool,
        work: impl FnOnce(&Geometry, &mut Headless) -> Result<T>,
    ) -> Result<T> {
        let bounces = if is_scattered { SCATTER.bounces } else { 0 };
        let geometry = Geometry::of(gpu, (self.scene, self.geometry), pair, bounces)?;
        let done = work(&geometry, gpu);
        geometry.end(gpu);
        done
    }
}

/// One groove of the paper's figure 2, 32 wide: walls at right angles, those that face west red, the
/// others white. Many columns and few rows, because nothing changes along it.
fn groove() -> Result<Scene> {
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
fn relative(found: &[[f64; 3]], known: &[[f64; 3]]) -> f64 {
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
    let (output, folder) = (args.path("-o")?, args.folder());
    let mut gpu = args.open()?;
    println!(
        "{}\n\nA table of {} × {} angles for lights and for views, {} bounces by {DIRECTIONS} directions and {} paths\n",
        device(&gpu),
        ANGLES.zeniths,
        ANGLES.azimuths,
        SCATTER.bounces,
        SCATTER.paths
    );
    let groove = groove()?;
    let aggregate = Aggregate::of(&mut gpu, &groove, 1)?;
    one(&mut gpu, "groove", &aggregate)?;
    if let Some(folder) = folder {
        let moss = moss(&folder)?;
        let aggregate = Aggregate::of(&mut gpu, &moss, 4)?;
        one(&mut gpu, "moss", &aggregate)?;
    }
    output.map_or(Ok(()), |path| Ok(picture(&mut gpu, &aggregate, &path)?))
}

fn one(gpu: &mut Headless, name: &str, aggregate: &Aggregate) -> Result<()> {
    let field = &aggregate.scene.field;
    let (between, weights) = (pairs(BETWEEN, 0)?, ANGLES.projected_sr());
    head(&format!(
        "| {name}, {} × {} | not reciprocal, % | reflected, %: least | most | closure, worst % | left of {BETWEEN} pairs between, %: table | {} | {} |",
        field.cols(),
        field.rows(),
        FACTORS.map(|n| format!("{n} factors")).join(" | "),
        ORDERS.map(|n| format!("order {n}")).join(" | ")
    ));
    let mut series = Vec::new();
    for (is_scattered, label) in KINDS {
        let (table, facets) = aggregate.table(gpu, is_scattered)?;
        let reflected = (0..ANGLES.count()).flat_map(|light| table.reflected(light, &weights));
        let [least, most] = reflected.fold([f64::MAX, 0.0_f64], |[l, m], r| [l.min(r), m.max(r)]);
        let closure = (0..ANGLES.count()).map(|i| (facets.closure(i) - 1.0).abs());
        let known = aggregate.pairs(gpu, &between, is_scattered)?;
        let of = |value: &dyn Fn(DVec3, DVec3) -> [f64; 3]| {
            let (lights, views) = between.vectors().split_at(BETWEEN);
            let found: Vec<_> = lights.iter().zip(views).map(|(l, v)| value(*l, *v)).collect();
            relative(&found, &known)
        };
        let mut row = vec![100.0 * least, 100.0 * most, 100.0 * closure.fold(0.0, f64::max)];
        row.push(of(&|l, v| table.between(&ANGLES, l, v)));
        for count in FACTORS {
            let factors = Factors::of(&table, ANGLES, count, false)?;
            row.push(of(&|l, v| factors.at(l, v)));
        }
        for order in ORDERS {
            let harmonics = BrdfHarmonics::of(&table, ANGLES, order, false)?;
            row.push(of(&|l, v| harmonics.at(l, v)));
        }
        println!("| {label} | {:.3} | {} |", 100.0 * table.unreciprocal(), cells(1, row));
        series.push((Factors::of(&table, ANGLES, KEPT, false)?, table));
    }
    println!();
    drawn(gpu, aggregate, &series)
}

/// Mean radiance of pairs that no table contains.
fn drawn(gpu: &mut Headless, aggregate: &Aggregate, series: &[(Factors, Brdf)]) -> Result<()> {
    let pairs = drawn_pairs()?;
    let (lights, views) = pairs.vectors().split_at(PAIRS);
    head(&format!(
        "| {PAIRS} pairs | mean radiance of the geometry | error of triangles, % | rms | of the table, % | rms | of {KEPT} factors, % | rms |"
    ));
    for ((is_scattered, label), (factors, table)) in KINDS.into_iter().zip(series) {
        let own = aggregate.pairs(gpu, &pairs, is_scattered)?;
        let mut means = Vec::new();
        for (i, (l, v)) in lights.iter().zip(views).enumerate() {
            let drawn =
                aggregate.with_geometry(gpu, [*l, *v], is_scattered, |g, gpu| g.mean(gpu, *v))?;
            let by = [own[i], table.between(&ANGLES, *l, *v), factors.at(*l, *v)];
            let [a, b, c] = by.map(|f| f.map(|f| f * l.z));
            means.push([drawn, a, b, c].map(|rgb| rgb.iter().sum::<f64>() / 3.0));
        }
        let mean = |k: usize| means.iter().map(|m| m[k]).sum::<f64>() / PAIRS as f64;
        let cell = |k: usize| {
            let rms = rms(means.iter().map(|m| m[k] - m[0])) / mean(0);
            format!("{:+.2} | {:.2}", 100.0 * (mean(k) / mean(0) - 1.0), 100.0 * rms)
        };
        println!("| {label} | {:.4} | {} | {} | {} |", mean(0), cell(1), cell(2), cell(3));
    }
    println!();
    Ok(())
}

/// Rows of the picture from above: geometry, its mean, and the BRDF's, of direct light; the same of all.
/// Light comes from the upper left, the view from the middle's normal; where the light would be below a
/// patch's horizon the patch is black.
fn picture(gpu: &mut Headless, aggregate: &Aggregate, path: &Path) -> Result<()> {
    /// Patches, and pixels along the edge of each.
    const PATCHES: usize = 16;
    const PIXELS: usize = 48;
    /// Of the first and the last patch's normal, from the middle's.
    const BENT_DEG: f64 = 60.0;
    let width = PATCHES * PIXELS;
    let mut rows = vec![vec![vec![[0.0_f32; 3]; width * PIXELS]]; 6];
    let (light, view) = (DVec3::new(-0.5, 0.3, 0.8).normalize(), DVec3::Z);
    for (kind, (is_scattered, _)) in KINDS.into_iter().enumerate() {
        let (table, _) = aggregate.table(gpu, is_scattered)?;
        for patch in 0..PATCHES {
            let bent = (2.0 * (patch as f64 + 0.5) / PATCHES as f64 - 1.0) * BENT_DEG.to_radians();
            // Into the frame of a patch whose normal is rotated by so much towards the east.
            let [l, v] = [light, view].map(|e| {
                let (sin, cos) = bent.sin_cos();
                DVec3::new(cos * e.x - sin * e.z, e.y, sin * e.x + cos * e.z)
            });
            if l.z <= 0.0 {
                continue;
            }
            let ((picture, places), mean) =
                aggregate.with_geometry(gpu, [l, v], is_scattered, |geometry, gpu| {
                    Ok((geometry.view(gpu, v)?, geometry.mean(gpu, v)?))
                })?;
            let mut place = |row: usize, y: usize, x: usize, colour: [f32; 3]| {
                rows[3 * kind + row][0][y * width + patch * PIXELS + x] = colour;
            };
            for (colour, at) in picture.radiance.iter().zip(places) {
                let Some([x, y]) = at else { continue };
                let pixel = |p: f64| ((p * PIXELS as f64) as usize).min(PIXELS - 1);
                place(0, PIXELS - 1 - pixel(y), pixel(x), *colour);
            }
            let of_table = table.between(&ANGLES, l, v).map(|f| (f * l.z) as f32);
            for i in 0..PIXELS * PIXELS {
                place(1, i / PIXELS, i % PIXELS, mean.map(|m| m as f32));
                place(2, i / PIXELS, i % PIXELS, of_table);
            }
        }
    }
    plot::png(path, &rows, width, 1, 4.0)
}
