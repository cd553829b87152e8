//! Shadows by precomputed visibility (Heidrich et al. 2000, §4): wrongly lit grid points.
//!
//! 200 lights evenly over the upper hemisphere, on a pit, grooves, the middle N² (48) grid points of
//! the bundled mountain and of the moss of FOLDER. The reference is a ray for each grid point and
//! light. Compared are visibility interpolated between directions of the sphere and cut at a half, and
//! ellipses fitted to those above horizontal. The picture: the sky of four grid points in the plan of
//! the hemisphere, and their ellipses.

use std::f64::consts::TAU;
use std::path::Path;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan;
use ridgelight::scene::{Border, Directions, HeightField, VisiblePoint};
use ridgelight_cpu::ellipse_fit::Ellipse;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::visible_points::lit_share;

use crate::bake::light::outputs;
use crate::common::args::Args;
use crate::common::frames::device;
use crate::common::plot::{self, Texels};
use crate::common::{Outcome, cells, head, inputs};

const LIGHTS: usize = 200;
const COUNTS: [usize; 3] = [64, 256, 1024];
/// Elevations between which lights are listed apart, degrees.
const BANDS: [f64; 5] = [0.0, 15.0, 30.0, 60.0, 90.0];

struct Ground {
    name: &'static str,
    field: HeightField,
    border: Border,
}

fn grounds(folder: Option<&Path>, side: usize) -> Result<Vec<Ground>> {
    // A cap of a sphere of 57° half-angle, sunk into a plain; its rim 12.5 cells from its middle.
    let (rim, angle) = (12.5_f64, 1.0_f64);
    let radius = rim / angle.sin();
    let pit = inputs::field(33, 33, |r, c| {
        let away = (r as f64 - 16.0).hypot(c as f64 - 16.0).min(rim);
        radius * angle.cos() - (radius * radius - away * away).sqrt()
    })?;
    let grooves = inputs::field(32, 32, |_, c| (c % 16).abs_diff(8) as f64)?;
    let mountain = inputs::middle(&inputs::mountain(6.0)?, side)?;
    let mut all = vec![
        Ground { name: "pit", field: pit, border: Border::Plane },
        Ground { name: "grooves", field: grooves, border: Border::Periodic },
        Ground { name: "mountain, six times as steep", field: mountain, border: Border::Plane },
    ];
    if let Some(folder) = folder {
        let field = inputs::middle(&inputs::field_of(folder, inputs::MOSS)?, side)?;
        all.push(Ground { name: "moss", field, border: Border::Plane });
    }
    Ok(all)
}

/// The errors of `is_lit(light, grid point)` as cells, %: over all lights, then by bands of elevation.
fn errors(
    lights: &Directions,
    reference: &[Vec<bool>],
    is_lit: impl Fn(usize, usize) -> bool,
) -> String {
    let points = reference[0].len();
    let wrong = |(k, lit): (usize, &Vec<bool>)| {
        lit.iter().enumerate().filter(|(at, lit)| is_lit(k, *at) != **lit).count()
    };
    let counts: Vec<usize> = reference.iter().enumerate().map(wrong).collect();
    let share = |[low, high]: [f64; 2]| {
        let elevation = |k: &usize| lights.vectors()[*k].z.asin().to_degrees();
        let own = (0..LIGHTS).filter(|k| low <= elevation(k) && elevation(k) < high);
        let (count, wrong) = own.fold((0, 0), |(n, sum), k| (n + 1, sum + counts[k]));
        100.0 * wrong as f64 / (count * points) as f64
    };
    let bands = BANDS.windows(2).map(|b| [b[0], b[1]]);
    cells(2, std::iter::once([0.0, 90.1]).chain(bands).map(share))
}

/// Ellipses of all grid points.
fn ellipses(gpu: &mut Headless, ground: &Ground, around: &Directions) -> Result<Vec<Ellipse>> {
    let plan = plan::ellipses(&ground.field, ground.border, around, &gpu.report().limits)?;
    let images = outputs(gpu, plan, &ground.field)?;
    let pairs = images[0].chunks_exact(4).zip(images[1].chunks_exact(4));
    let of = |(a, r): (&[f32], &[f32])| Ellipse::of_texels([a[0], a[1], a[2], a[3]], [r[0], r[1]]);
    Ok(pairs.map(of).collect())
}

/// The table of a field; its ellipses of most directions.
fn one(gpu: &mut Headless, ground: &Ground, lights: &Directions) -> Result<Vec<Ellipse>> {
    let Ground { name, field, border } = ground;
    let (points, limits) = (field.rows() * field.cols(), gpu.report().limits);
    let exact = gpu.visible_points((field, *border), lights, &limits)?;
    let is_sky = |k: usize, at: usize| exact.point(k, at) == VisiblePoint::Sky;
    let lit: Vec<Vec<bool>> =
        (0..LIGHTS).map(|k| (0..points).map(|at| is_sky(k, at)).collect()).collect();
    let count = lit.iter().flatten().filter(|lit| **lit).count();
    let share = 100.0 * count as f64 / (LIGHTS * points) as f64;
    println!("{name}, {} × {}; {share:.1} % lit\n", field.cols(), field.rows());
    head("| shadows by | bytes per grid point | wrong, % | 0-15° | 15-30° | 30-60° | 60-90° |");
    let mut last = Vec::new();
    for count in COUNTS {
        let directions = Directions::fibonacci(count, -1.0, 0)?;
        let found = gpu.visible_points((field, *border), &directions, &limits)?;
        let triangles = directions.triangles()?;
        let nearest = |light: DVec3| {
            let of = |i: usize| directions.vectors()[i].dot(light);
            let above = (0..count).filter(|i| directions.vectors()[*i].z > 0.0);
            let nearest = above.max_by(|a, b| of(*a).total_cmp(&of(*b))).expect("some above");
            [(nearest, 1.0), (nearest, 0.0), (nearest, 0.0)]
        };
        let around =
            |light: &DVec3| found.around(&triangles, *light).unwrap_or_else(|| nearest(*light));
        let around: Vec<_> = lights.vectors().iter().map(around).collect();
        let cells = errors(lights, &lit, |k, at| lit_share(&found, &around[k], at) >= 0.5);
        println!("| {count} directions | {} | {cells} |", 4 * found.words().len() / points);
        last = ellipses(gpu, ground, &directions)?;
        let cells = errors(lights, &lit, |k, at| last[at].holds(lights.vectors()[k]));
        println!("| ellipses of {count} | 12 | {cells} |");
    }
    println!();
    Ok(last)
}

const PANEL: usize = 150;
const AZIMUTHS: usize = 720;

/// The hemisphere's plan, north up: the sky, and the ellipse's sky; and the share of the sky that is
/// wrong.
fn panel(ground: &Ground, at: usize, ellipse: &Ellipse) -> (Texels, f64) {
    const LIT: [f32; 3] = [0.9, 0.8, 0.45];
    const SHADOWED: [f32; 3] = [0.03, 0.04, 0.08];
    const LOST: [f32; 3] = [0.75, 0.05, 0.03];
    const ADDED: [f32; 3] = [0.05, 0.2, 0.9];
    let oracle = Oracle::new(&ground.field, ground.border);
    let (row, col) = (at / ground.field.cols(), at % ground.field.cols());
    let slope = |k: usize| {
        let horizon = oracle.horizon(row, col, TAU * k as f64 / AZIMUTHS as f64);
        horizon.map_or(0.0, |h| h.slope.max(0.0))
    };
    let slopes: Vec<f64> = (0..AZIMUTHS).map(slope).collect();
    let mut wrong = 0.0;
    let pixel = |i: usize| {
        let to = |n: usize| (2 * n + 1) as f64 / PANEL as f64 - 1.0;
        let (x, y) = (to(i % PANEL), -to(i / PANEL));
        let level = 1.0 - x * x - y * y;
        if level <= 0.0 {
            return [1.0; 3];
        }
        let e = DVec3::new(x, y, level.sqrt());
        let turn = (e.y.atan2(e.x) / TAU).rem_euclid(1.0) * AZIMUTHS as f64;
        let is_lit = e.z > slopes[turn as usize % AZIMUTHS] * e.x.hypot(e.y);
        let holds = ellipse.holds(e);
        if is_lit != holds {
            // A pixel covers 1/z of its area in the plan on the sphere.
            wrong += (2.0 / PANEL as f64).powi(2) / (TAU * e.z);
        }
        match (is_lit, holds) {
            (true, true) => LIT,
            (false, false) => SHADOWED,
            (true, false) => LOST,
            (false, true) => ADDED,
        }
    };
    let pixels = (0..PANEL * PANEL).map(pixel).collect();
    (pixels, wrong)
}

/// The middle of the pit, the middle of a groove's wall, and the worst of every fourth grid point of the
/// other fields.
fn worst(ground: &Ground, ellipses: &[Ellipse]) -> Texels {
    let cols = ground.field.cols();
    let is_fourth = |at: &usize| (at / cols).is_multiple_of(4) && at.is_multiple_of(4);
    let places: Vec<usize> = match ground.name {
        "pit" => vec![16 * cols + 16],
        "grooves" => vec![16 * cols + 12],
        _ => (0..ellipses.len()).filter(is_fourth).collect(),
    };
    let all = places.into_iter().map(|at| (at, panel(ground, at, &ellipses[at])));
    let worst = all.max_by(|a, b| a.1.1.total_cmp(&b.1.1)).expect("grid points");
    let (at, (pixels, wrong)) = worst;
    println!("{}: grid point {at}, {:.1} % of the sky wrong", ground.name, 100.0 * wrong);
    pixels
}

pub fn run(mut args: Args) -> Outcome {
    let (side, output) = (args.number("--side", 48)?, args.path("-o")?);
    let folder = args.folder();
    let mut gpu = args.open()?;
    println!(
        "{}\n\n{LIGHTS} lights evenly over the upper hemisphere; directions evenly over the sphere, half of them above \
         horizontal. Bytes of ellipses: six numbers of 16 bits.\n",
        device(&gpu)
    );
    let lights = Directions::fibonacci(LIGHTS, 0.0, 7)?;
    let mut all = Vec::new();
    for ground in grounds(folder.as_deref(), side)? {
        let ellipses = one(&mut gpu, &ground, &lights)?;
        all.push((ground, ellipses));
    }
    let Some(path) = output else { return Ok(()) };
    let row = all.iter().map(|(ground, ellipses)| worst(ground, ellipses)).collect();
    Ok(plot::png(&path, &[row], PANEL, 1, 1.0)?)
}
