//! A flat field's data on curved bases (Heidrich et al. 2000, §5), beside real geometry.
//!
//! `cargo run --release --example curved -- [-o PICTURE.svg]`
//!
//! Three grooves of 16 by 8 cells, walls of 45°, are bent across their length into a cylinder, outwards and inwards, as a mesh
//! whose triangles rays are shot at. Beside it what samples see on the flat field, as it is and adapted to the curvature.
//! Shadows: 200 lights of each sample's own hemisphere. Scattered light: walls that face east shine, all scatter it, once and up to
//! three times.

#[path = "curved/light.rs"]
mod light;
#[path = "curved/mesh.rs"]
mod mesh;
#[path = "soft/plot.rs"]
mod plot;
#[path = "curved/report.rs"]
mod report;
#[path = "shared/seen.rs"]
mod seen;

use std::path::PathBuf;

use glam::DVec3;
use light::{ALBEDO, BOUNCES, Looks, RAYS};
use mesh::Mesh;
use report::{Row, Scattered, picture, rmse, table};
use ridgelight::basis::triangles::Triangles;
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan;
use ridgelight::scene::{
    Albedo, Border, Curvature, Directions, HeightField, Lights, Scatter, Scene, Surface,
    VisiblePoint, VisiblePoints,
};
use ridgelight::{Error, Result};
use ridgelight_bake::CurvedEllipses;
use ridgelight_cpu::bent_directions::{Draped, Fans};
use ridgelight_cpu::ellipse_fit::{Ellipse, bent_sky_directions, fit};
use ridgelight_cpu::fan_weights::weight;

const LIGHTS: usize = 200;
const DIRECTIONS: usize = 1024;
/// Of the device's light that has been scattered several times.
const PATHS: u32 = 1024;
const PERIOD: usize = 16;
const GROOVES: usize = 3;
const ROWS: usize = 33;
/// Rows whose samples are compared: what lies across the grooves is the same in all, but for the ends.
const COMPARED: [usize; 3] = [8, 16, 24];
const RADII: [f64; 9] = [100.0, 70.0, 50.0, 35.0, 25.0, 18.0, 12.0, 8.0, 5.0];
/// What four of five ellipses are fitted at, outwards and inwards, 1/m.
const STEPS: [f64; 2] = [1.0 / 25.0, 1.0 / 100.0];
/// Nothing within a groove lies beyond its end; what does is the field's edge.
const BORDER: Border = Border::Open;

fn grooves() -> Result<HeightField> {
    let cols = GROOVES * PERIOD + 1;
    let half = PERIOD as f64 / 2.0;
    let height = |i: usize| (((i % cols) % PERIOD) as f64 - half).abs();
    let heights: Vec<f64> = (0..ROWS * cols).map(height).collect();
    HeightField::new(ROWS, cols, &heights, [1.0; 2], None)
}

/// Samples that are compared, in the order of everything below.
fn compared(field: &HeightField) -> impl Iterator<Item = usize> + use<> {
    let cols = field.cols();
    COMPARED.into_iter().flat_map(move |row| row * cols..(row + 1) * cols)
}

fn percent(wrong: usize, of: usize) -> f64 {
    100.0 * wrong as f64 / of as f64
}

/// Which lights arrive at compared samples, by rays at the mesh.
fn lit(mesh: &Mesh, samples: &[usize], lights: &Directions) -> Vec<Vec<bool>> {
    let of = |sample: &usize| {
        let arrives =
            |l: &DVec3| mesh.met(mesh.over(*sample), mesh.frames[*sample].out(*l)).is_none();
        lights.vectors().iter().map(arrives).collect()
    };
    samples.iter().map(of).collect()
}

/// Five ellipses of each sample.
fn five(
    gpu: &mut Headless,
    field: &HeightField,
    directions: &Directions,
    steps: [f64; 2],
) -> Result<Vec<[Ellipse; 5]>> {
    let plan = plan::curved_ellipses(field, BORDER, directions, steps, &gpu.report().limits)?;
    gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        let images = (0..10).map(|i| Ok(gpu.pixels(frame, i)?.values));
        let images = images.collect::<Result<Vec<_>>>()?;
        let texel = |image: usize, at: usize| {
            <[f32; 4]>::try_from(&images[image][4 * at..4 * at + 4]).expect("4")
        };
        let ellipse = |k: usize, at: usize| {
            let [along, across, ..] = texel(2 * k + 1, at);
            Ellipse::of_texels(texel(2 * k, at), [along, across])
        };
        let five = |at| [0, 1, 2, 3, 4].map(|k| ellipse(k, at));
        Ok((0..field.heights_m().len()).map(five).collect())
    })
}

/// Light scattered up to so many times, off the device; once by each direction in turn, without chance.
fn off_device(
    gpu: &mut Headless,
    flat: &Flat,
    scene: &Scene,
    (curvature, bounces): (Curvature, usize),
) -> Result<Vec<f64>> {
    let directions = flat.points.directions();
    let paths = if bounces == 1 { DIRECTIONS as u32 } else { PATHS };
    let scatter =
        Scatter { bounces: bounces as u32, paths, curvature, cutoff: 0.0, ..Scatter::default() };
    let plan = plan::scatter(scene, directions, &scatter, &gpu.report().limits)?;
    let direct: Vec<[f32; 3]> = flat.own.iter().map(|own| [*own as f32; 3]).collect();
    let inputs = plan::scatter_inputs(&plan, scene, &flat.points, &direct)?;
    let inputs: Vec<&[f32]> = inputs.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &inputs, |gpu, frame| {
        gpu.draw(frame)?;
        Ok(gpu.pixels(frame, 0)?.values.chunks_exact(4).map(|t| f64::from(t[0])).collect())
    })
}

/// What the flat field tells, whatever the base.
struct Flat {
    field: HeightField,
    points: VisiblePoints,
    fans: Fans,
    net: Triangles,
    lights: Directions,
    five: Vec<[Ellipse; 5]>,
    /// What each sample shines by.
    own: Vec<f64>,
    /// Scattered light by rays, its sum.
    scattered: [f64; 2],
}

impl Flat {
    /// Share of lights wrong of a test, percent; it is asked of the number of a compared sample.
    fn wrong(&self, lit: &[Vec<bool>], holds: impl Fn(usize, DVec3) -> bool) -> f64 {
        let lights = self.lights.vectors();
        let of = |(n, lit): (usize, &Vec<bool>)| {
            lights.iter().zip(lit).filter(|(light, lit)| holds(n, **light) != **lit).count()
        };
        let wrong: usize = lit.iter().enumerate().map(of).sum();
        percent(wrong, lit.len() * lights.len())
    }

    /// By the triangles of directions that stand so, cut at a half; the nearest direction where none holds a light.
    fn by_directions(&self, draped: &Draped, bent: &[DVec3], at: usize, light: DVec3) -> bool {
        let share = draped.lit_share(&self.net, bent, at, light).unwrap_or_else(|| {
            let near = |i: &usize| bent[*i].dot(light);
            let nearest = (0..DIRECTIONS)
                .filter(|i| bent[*i].z > 0.0)
                .max_by(|a, b| near(a).total_cmp(&near(b)));
            let sees_sky = nearest.is_some_and(|i| self.points.point(i, at) == VisiblePoint::Sky);
            f64::from(u8::from(sees_sky))
        });
        share >= 0.5
    }
}

fn row(gpu: &mut Headless, flat: &Flat, scene: &Scene, per_m: f64) -> Result<Row> {
    let field = &flat.field;
    let curvature = Curvature { per_m: [per_m, 0.0] };
    let refused = curvature.check(field, BORDER).err().map(|error| error.to_string());
    let mesh = Mesh::bent(field, per_m);
    let all: Vec<usize> = compared(field).collect();
    let lit = lit(&mesh, &all, &flat.lights);
    let light = light::truth(&mesh, field, &all)?;
    let draped = |curvature| Draped {
        field,
        border: BORDER,
        points: &flat.points,
        fans: &flat.fans,
        curvature,
    };
    let (as_is, adapted) = (draped(Curvature::FLAT), draped(curvature));
    let samples = 0..field.heights_m().len();
    let vectors = flat.points.directions().vectors();
    let bent: Vec<Vec<DVec3>> = samples.map(|at| adapted.bent(at)).collect();
    let here = |at: &usize| fit(&bent_sky_directions(&flat.points, &bent[*at], *at)).0;
    let fitted: Vec<Ellipse> = all.iter().map(here).collect();
    let between: Vec<CurvedEllipses> =
        all.iter().map(|at| CurvedEllipses::of(&flat.five[*at], STEPS)).collect();
    let shadows = [
        flat.wrong(&lit, |n, l| flat.by_directions(&as_is, vectors, all[n], l)),
        flat.wrong(&lit, |n, l| flat.by_directions(&adapted, &bent[all[n]], all[n], l)),
        flat.wrong(&lit, |n, l| flat.five[all[n]][0].holds(l)),
        flat.wrong(&lit, |n, l| between[n].holds(curvature, l)),
        flat.wrong(&lit, |n, l| fitted[n].holds(l)),
    ];
    // The twin, which refuses nothing; the device beside it where it may.
    let weigh = |bent: &Vec<DVec3>| (0..DIRECTIONS).map(|i| weight(&flat.fans, bent, i)).collect();
    let weights = bent.iter().map(weigh).collect();
    let as_is = Looks { bent: vec![vectors.to_vec(); bent.len()], weights: None };
    let turned = Looks { bent, weights: None };
    let twin = |curvature: Curvature, looks: &Looks| {
        let found = light::scattered(scene, &flat.points, curvature, looks, &flat.own);
        found.map(|light| all.iter().map(|at| light[*at]).collect::<Vec<f64>>())
    };
    let kinds = [twin(Curvature::FLAT, &as_is), twin(curvature, &turned)];
    let weighed = twin(curvature, &Looks { weights: Some(weights), ..turned });
    let truth = |k: usize| light.iter().map(|light| light[k]).collect::<Vec<f64>>();
    let mut device = None;
    if refused.is_none() {
        for (k, bounces) in BOUNCES.into_iter().enumerate() {
            let found = off_device(gpu, flat, scene, (curvature, bounces))?;
            let found: Vec<f64> = all.iter().map(|at| found[*at]).collect();
            let off = rmse(&found, &weighed[k]);
            assert!(bounces > 1 || off < 0.1, "the device scatters {off} % off its twin");
            device = Some(rmse(&found, &truth(k)));
        }
    }
    let scattered = |k: usize| Scattered {
        truth: truth(k),
        weighed: weighed[k].clone(),
        over_flat: truth(k).iter().sum::<f64>() / flat.scattered[k],
        off: [&kinds[0], &kinds[1], &weighed].map(|found| rmse(&found[k], &truth(k))),
    };
    let count = lit.iter().flatten().filter(|lit| **lit).count();
    Ok(Row {
        curvature: per_m,
        lit: percent(count, all.len() * LIGHTS),
        shadows,
        light: [0, 1].map(scattered),
        device,
        changed: curvature.occlusion_change(field, BORDER),
        refused,
    })
}

fn run() -> Result<()> {
    let mut args = std::env::args().skip(1);
    let mut output = None::<PathBuf>;
    while let Some(arg) = args.next() {
        match (arg.as_str(), args.next()) {
            ("-o", Some(path)) => output = Some(path.into()),
            _ => return Err(Error::setting("argument", arg, "-o PICTURE.svg")),
        }
    }
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}, {}\n", gpu.report().name, gpu.report().driver);
    let field = grooves()?;
    let directions = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
    let (points, _) = seen::points(&mut gpu, &field, BORDER, &directions)?;
    let net = directions.triangles()?;
    let fans = Fans::of(&net, directions.vectors());
    let lights = Directions::fibonacci(LIGHTS, 0.0, 7)?;
    let five = five(&mut gpu, &field, &directions, STEPS)?;
    let all: Vec<usize> = compared(&field).collect();
    let level = light::truth(&Mesh::bent(&field, 0.0), &field, &all)?;
    let scattered = [0, 1].map(|k| level.iter().map(|light| light[k]).sum());
    let own =
        (0..field.heights_m().len()).map(|at| light::shines(at % field.cols(), PERIOD)).collect();
    let surface =
        Surface { border: BORDER, albedo: Albedo::Constant([ALBEDO as f32; 3]), specular: None };
    let scene = Scene { field: field.clone(), surface, lights: Lights::default() };
    let flat = Flat { field, points, fans, net, lights, five, own, scattered };
    println!(
        "{GROOVES} grooves of {PERIOD} by {} cells, {ROWS} long; {DIRECTIONS} directions over the sphere, {LIGHTS} lights over each sample's \
         hemisphere, {RAYS} rays. A radius above 0: valleys widen. Said: about the shares of a hemisphere's lights and light that the base hides or \
         lays open, of light at most {} % (`Curvature::changed`); beyond, the rows are the twin's, as the renderer refuses. Five: fitted at radii of {} outwards and {} inwards. \
         Off: RMSE over the mean; between three: light of these and the flat base, as straight as ellipses; device: {PATHS} paths.\n",
        PERIOD / 2,
        100.0 * Curvature::MAX_CHANGE,
        1.0 / STEPS[0],
        1.0 / STEPS[1]
    );
    let mut rows = Vec::new();
    let outwards = RADII.iter().rev().map(|r| 1.0 / r);
    let inwards = RADII.iter().map(|r| -1.0 / r);
    for curvature in outwards.chain([0.0]).chain(inwards) {
        rows.push(row(&mut gpu, &flat, &scene, curvature)?);
    }
    table(&rows);
    println!();
    for row in rows.iter().filter(|r| r.refused.is_some()) {
        println!(
            "radius {:+.0}: {}",
            1.0 / row.curvature,
            row.refused.as_deref().unwrap_or_default()
        );
    }
    match output {
        Some(path) => ridgelight_io::write_text(&path, &picture(&rows)),
        None => Ok(()),
    }
}

fn main() -> std::process::ExitCode {
    match run() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            std::process::ExitCode::FAILURE
        }
    }
}
