//! Shadows by precomputed visibility (Heidrich et al. 2000, §4): wrongly lit grid points, and times.
//!
//! 200 lights evenly over the upper hemisphere on a pit, grooves, the middle N² (48) grid points of the bundled mountain
//! and of the moss of FOLDER. The ground truth is a ray for each grid point and light; beside it, visibility
//! interpolated between directions of the sphere and cut at a half, ellipses fitted to those above horizontal, and the
//! exact sweep of a sun. The same of 200 views: visible points that count as hidden, and the other way round, by the area
//! that each shows to a distant camera. The picture: where four grid points see the sky in the plan of the hemisphere,
//! and their ellipses.

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan;
use ridgelight::scene::{
    Border, Directions, HeightField, Lights, Method, Quality, Scene, VisiblePoint,
};
use ridgelight_bake as bake;
use ridgelight_cpu::ellipse_fit::{Ellipse, sky_directions, start};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::visible_points::lit_share;

use crate::common::args::Args;
use crate::common::frames::{device, drawn, ms, open, total, visible};
use crate::common::{Outcome, head, inputs, panels};
use crate::scatter::geometry::sun;

const LIGHTS: usize = 200;
const COUNTS: [usize; 3] = [64, 256, 1024];
/// Elevations between which lights are listed apart, degrees.
const BANDS: [f64; 5] = [0.0, 15.0, 30.0, 60.0, 90.0];

struct Land {
    name: &'static str,
    field: HeightField,
    border: Border,
}

fn lands(folder: Option<&Path>, side: usize) -> Result<Vec<Land>> {
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
        Land { name: "pit", field: pit, border: Border::Plane },
        Land { name: "grooves", field: grooves, border: Border::Periodic },
        Land { name: "mountain, six times as steep", field: mountain, border: Border::Plane },
    ];
    if let Some(folder) = folder {
        let field = inputs::middle(&inputs::field_of(folder, inputs::MOSS)?, side)?;
        all.push(Land { name: "moss", field, border: Border::Plane });
    }
    Ok(all)
}

/// Of every light and grid point: whether it is lit, and the area that it shows to a view from there, over its area in
/// the plan.
struct Truth {
    lit: Vec<Vec<bool>>,
    shown: Vec<Vec<f64>>,
}

impl Truth {
    /// The errors of `is_lit(light, grid point)` as cells, %: over all lights, then by bands; of the area that views see.
    /// And the milliseconds of a light over the field.
    fn errors(&self, lights: &Directions, is_lit: impl Fn(usize, usize) -> bool) -> (String, f64) {
        let points = self.lit[0].len();
        let begun = Instant::now();
        let wrong = |(k, lit): (usize, &Vec<bool>)| {
            lit.iter().enumerate().filter(|(at, lit)| is_lit(k, *at) != **lit).count()
        };
        let counts: Vec<usize> = self.lit.iter().enumerate().map(wrong).collect();
        let ms = begun.elapsed().as_secs_f64() * 1e3 / LIGHTS as f64;
        let (mut masked, mut seen) = (0.0, 0.0);
        for (k, at) in (0..LIGHTS).flat_map(|k| (0..points).map(move |at| (k, at))) {
            let (lit, area) = (self.lit[k][at], self.shown[k][at]);
            seen += if lit { area } else { 0.0 };
            masked += if is_lit(k, at) == lit { 0.0 } else { area };
        }
        let share = |low: f64, high: f64| {
            let elevation = |k: usize| lights.vectors()[k].z.asin().to_degrees();
            let own: Vec<usize> =
                (0..LIGHTS).filter(|k| low <= elevation(*k) && elevation(*k) < high).collect();
            let wrong: usize = own.iter().map(|k| counts[*k]).sum();
            wrong as f64 / (own.len() * points) as f64
        };
        let bands = BANDS.windows(2).map(|b| share(b[0], b[1]));
        let all = std::iter::once(share(0.0, 90.1)).chain(bands).chain([masked / seen]);
        let cells: Vec<String> = all.map(|v| format!("{:.2}", 100.0 * v)).collect();
        (cells.join(" | "), ms)
    }
}

/// Ellipses of all grid points, and the milliseconds of visibility and of the fit.
fn ellipses(
    gpu: &mut Headless,
    land: &Land,
    around: &Directions,
) -> Result<(Vec<Ellipse>, [f64; 2])> {
    let plan = plan::ellipses(&land.field, land.border, around, &gpu.report().limits)?;
    gpu.with_frame(plan, &[land.field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        let times = gpu.draw(frame)?;
        let fit = ms(&times, "ellipse_fit");
        let [axes, radii] = [gpu.pixels(frame, 0)?.values, gpu.pixels(frame, 1)?.values];
        let pairs = axes.chunks_exact(4).zip(radii.chunks_exact(4));
        let of =
            |(a, r): (&[f32], &[f32])| Ellipse::of_texels([a[0], a[1], a[2], a[3]], [r[0], r[1]]);
        Ok((pairs.map(of).collect(), [total(&times) - fit, fit]))
    })
}

/// Milliseconds of a sun's shadows by the exact sweep, whole frames, and the percentage of grid points facing a sun
/// that are wrong; of every tenth light.
fn swept(gpu: &mut Headless, land: &Land, lights: &Directions, truth: &Truth) -> Result<[f64; 2]> {
    let normals = bake::normals(&land.field, land.border);
    let (mut ms, mut wrong, mut facing) = (Vec::new(), 0_usize, 0_usize);
    for k in (0..LIGHTS).step_by(10) {
        let scene = Scene {
            field: land.field.clone(),
            surface: inputs::matte([1.0; 3], land.border),
            lights: Lights { suns: vec![sun(lights.vectors()[k])], ..Lights::default() },
        };
        let quality = Quality { method: Method::Sweep, ..Quality::default() };
        let found = drawn(gpu, &scene, &quality, 1)?;
        ms.push(found.ms());
        for (at, light) in found.light.iter().enumerate() {
            // Rounding decides grid points that hardly face it.
            if truth.shown[k][at] > 1e-3 {
                facing += 1;
                // Half or more of the sun's light.
                let whole = truth.shown[k][at] * normals[at].z / PI;
                wrong += usize::from((light[0] >= 0.5 * whole) != truth.lit[k][at]);
            }
        }
    }
    Ok([ms.iter().sum::<f64>() / ms.len() as f64, 100.0 * wrong as f64 / facing as f64])
}

/// The table of a field; its ellipses of most directions.
fn one(gpu: &mut Headless, land: &Land, lights: &Directions) -> Result<Vec<Ellipse>> {
    let Land { name, field, border } = land;
    let points = field.rows() * field.cols();
    let (exact, exact_ms) = visible(gpu, (field, *border), lights)?;
    let sees_sky = |k: usize, at: usize| exact.point(k, at) == VisiblePoint::Sky;
    let lit: Vec<Vec<bool>> =
        (0..LIGHTS).map(|k| (0..points).map(|at| sees_sky(k, at)).collect()).collect();
    let normals = bake::normals(field, *border);
    let shown = |view: &DVec3| normals.iter().map(|n| n.dot(*view).max(0.0) / n.z).collect();
    let truth = Truth { lit, shown: lights.vectors().iter().map(shown).collect() };
    let lit = truth.lit.iter().flatten().filter(|lit| **lit).count();
    let share = 100.0 * lit as f64 / (LIGHTS * points) as f64;
    println!("{name}, {} × {}; {share:.1} % lit\n", field.cols(), field.rows());
    head(
        "| shadows by | found, ms | fitted, ms | a light, ms | bytes a grid point | wrong, % | 0-15° | 15-30° | 30-60° | 60-90° | of what views see |",
    );
    println!("| rays | | | {:.2} | | | | | | | |", exact_ms / LIGHTS as f64);
    let [ms, wrong] = swept(gpu, land, lights, &truth)?;
    println!("| exact sweep | | | {ms:.2} | | {wrong:.2} | | | | | |");
    let mut last = Vec::new();
    for count in COUNTS {
        let directions = Directions::fibonacci(count, -1.0, 0)?;
        let (found, found_ms) = visible(gpu, (field, *border), &directions)?;
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
        let (cells, ms) = truth.errors(lights, |k, at| lit_share(&found, &around[k], at) >= 0.5);
        let bytes = 4 * found.words().len() / points;
        println!("| {count} directions | {found_ms:.1} | | {ms:.3} | {bytes} | {cells} |");
        let (fitted, [seen_ms, fit_ms]) = ellipses(gpu, land, &directions)?;
        let (cells, ms) = truth.errors(lights, |k, at| fitted[at].holds(lights.vectors()[k]));
        println!("| ellipses of {count} | {seen_ms:.1} | {fit_ms:.1} | {ms:.3} | 12 | {cells} |");
        if count == COUNTS[COUNTS.len() - 1] {
            let begun: Vec<Ellipse> = (0..points)
                .map(|at| start(&sky_directions(&found, found.directions().vectors(), at)))
                .collect();
            let (cells, _) = truth.errors(lights, |k, at| begun[at].holds(lights.vectors()[k]));
            println!("| covariances of {count} | | | | 12 | {cells} |");
        }
        last = fitted;
    }
    println!();
    Ok(last)
}

const PANEL: usize = 150;
const AZIMUTHS: usize = 720;

/// The hemisphere's plan, north up: sky as it is and as the ellipse has it; and the share of the sky that is wrong.
fn panel(land: &Land, at: usize, ellipse: &Ellipse) -> (panels::Panel, f64) {
    const LIT: [f32; 3] = [0.9, 0.8, 0.45];
    const SHADOWED: [f32; 3] = [0.03, 0.04, 0.08];
    const LOST: [f32; 3] = [0.75, 0.05, 0.03];
    const ADDED: [f32; 3] = [0.05, 0.2, 0.9];
    let oracle = Oracle::new(&land.field, land.border);
    let (row, col) = (at / land.field.cols(), at % land.field.cols());
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
            // Of the sphere a pixel covers 1/z of the plan.
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

/// The middle of the pit, the middle of a groove's wall, and the worst of every fourth grid point of the other fields.
fn worst(land: &Land, ellipses: &[Ellipse]) -> panels::Panel {
    let cols = land.field.cols();
    let places: Vec<usize> = match land.name {
        "pit" => vec![16 * cols + 16],
        "grooves" => vec![16 * cols + 12],
        _ => (0..ellipses.len())
            .filter(|at| [at / cols, *at].iter().all(|n| n.is_multiple_of(4)))
            .collect(),
    };
    let all = places.into_iter().map(|at| (at, panel(land, at, &ellipses[at])));
    let worst = all.max_by(|a, b| a.1.1.total_cmp(&b.1.1)).expect("grid points");
    let (at, (pixels, wrong)) = worst;
    println!("{}: grid point {at}, {:.1} % of the sky wrong", land.name, 100.0 * wrong);
    pixels
}

pub fn run(mut args: Args) -> Outcome {
    let (side, output) = (args.number("--side", 48)?, args.path("-o")?);
    let folder = args.word().map(PathBuf::from);
    args.end()?;
    let mut gpu = open()?;
    println!(
        "{}\n\n{LIGHTS} lights evenly over the upper hemisphere; directions evenly over the sphere, half of them above horizontal. \
         Found and fitted: GPU time, as a light by rays; a light of the others: one core of the processor, look-ups \
         alone. Bytes: of ellipses six numbers of 16 bits. Covariances: ellipses before their centres and radii are searched for. Exact sweep: a \
         whole frame under one sun. Of what views see: area that a test takes for visible or hidden wrongly, over the visible area.\n",
        device(&gpu)
    );
    let lights = Directions::fibonacci(LIGHTS, 0.0, 7)?;
    let mut drawn = Vec::new();
    for land in lands(folder.as_deref(), side)? {
        let ellipses = one(&mut gpu, &land, &lights)?;
        drawn.push((land, ellipses));
    }
    let Some(path) = output else { return Ok(()) };
    let row = drawn.iter().map(|(land, ellipses)| worst(land, ellipses)).collect();
    Ok(panels::write(&path, &[row], PANEL, 1, 1.0)?)
}
