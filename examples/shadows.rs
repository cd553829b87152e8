//! Shadows of what was precomputed (Heidrich et al. 2000, §4): how many samples are lit wrongly, and what it costs.
//!
//! `cargo run --release --example shadows -- [FOLDER] [--side N] [-o PICTURE.png]`
//!
//! Two hundred lights evenly over the upper hemisphere on a pit, grooves, the middle N² (48) samples of the bundled mountain
//! and of the moss of FOLDER's `height/` where there is one. The truth is a ray a sample and light; beside it, visibility
//! interpolated between N directions of the sphere and cut at a half, ellipses fitted to those above horizontal, and the exact
//! sweep of a sun. The same of 200 views: what a camera far off would see of samples that it does not see, and the other way
//! round, by the area that each sample shows it.
//! The picture: where four samples see the sky in the plan of the hemisphere, and what their ellipses make of it.

#[path = "shadows/picture.rs"]
mod picture;
#[path = "shared/seen.rs"]
mod seen;

use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Border, Directions, HeightField, Lights, Method, Quality, Scene, Sun, Surface,
    VisiblePoint,
};
use ridgelight::{Error, Result};
use ridgelight_bake as bake;
use ridgelight_cpu::ellipse_fit::{Ellipse, sky_directions as sky_of, start};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;
use seen::{points, timed};

const LIGHTS: usize = 200;
const COUNTS: [usize; 3] = [64, 256, 1024];
/// Elevations between which lights are told apart, degrees.
const BANDS: [f64; 5] = [0.0, 15.0, 30.0, 60.0, 90.0];

/// Of the moss: 80 cells from black to white.
const MOSS_HEIGHT: f64 = 80.0 / 65535.0;

struct Land {
    name: &'static str,
    field: HeightField,
    border: Border,
}

fn lands(folder: Option<&Path>, side: usize) -> Result<Vec<Land>> {
    let of = |rows: usize, cols: usize, height: &dyn Fn(f64, f64) -> f64| {
        let heights: Vec<f64> =
            (0..rows * cols).map(|i| height((i / cols) as f64, (i % cols) as f64)).collect();
        HeightField::new(rows, cols, &heights, [1.0; 2], None)
    };
    // A cap of a sphere of 57° half-angle, sunk into a plain; its rim 12.5 samples from its middle.
    let (rim, angle) = (12.5_f64, 1.0_f64);
    let radius = rim / angle.sin();
    let pit = of(33, 33, &|r, c| {
        let away = (r - 16.0).hypot(c - 16.0).min(rim);
        radius * angle.cos() - (radius * radius - away * away).sqrt()
    })?;
    let grooves = of(32, 32, &|_, c| (c % 16.0 - 8.0).abs())?;
    let mut all = vec![
        Land { name: "pit", field: pit, border: Border::Plane },
        Land { name: "grooves", field: grooves, border: Border::Periodic },
    ];
    let mut add = |name, path: &Path, cell_m, z_scale| -> Result<()> {
        let options = HeightOptions { cell_m: Some(cell_m), z_scale, ..HeightOptions::default() };
        let whole = files::read_heights(path, &options)?;
        let field = middle(&whole, side)?;
        all.push(Land { name, field, border: Border::Plane });
        Ok(())
    };
    add(
        "mountain, six times as steep",
        Path::new("assets/mt_washington_256.png"),
        [66.0, 92.6],
        6.0,
    )?;
    let moss = folder.map(|f| f.join("height/Moss001_1K_Displacement.png"));
    if let Some(path) = moss.filter(|path| path.exists()) {
        add("moss", &path, [1.0; 2], MOSS_HEIGHT)?;
    }
    Ok(all)
}

/// The middle side² samples.
fn middle(whole: &HeightField, side: usize) -> Result<HeightField> {
    let [row, col] = [whole.rows(), whole.cols()].map(|n| (n - side.min(n)) / 2);
    let at = |i: usize| (row + i / side) * whole.cols() + col + i % side;
    let heights: Vec<f64> = (0..side * side).map(|i| f64::from(whole.heights_m()[at(i)])).collect();
    HeightField::new(side, side, &heights, whole.cell_m(), None)
}

/// Of every light and sample.
struct Truth {
    lit: Vec<Vec<bool>>,
    /// As a view: the area that the sample shows it, over its area in the plan.
    shown: Vec<Vec<f64>>,
}

/// Wrong samples by light.
struct Wrong {
    counts: Vec<usize>,
    /// As of views: area that is taken for seen or for hidden, over that which is seen.
    masked: f64,
}

impl Wrong {
    /// Of `is_lit(light, sample)`, and the milliseconds of a light over the field.
    fn of(truth: &Truth, is_lit: impl Fn(usize, usize) -> bool) -> (Self, f64) {
        let Truth { lit: truth, shown } = truth;
        let begun = Instant::now();
        let wrong = |(k, truth): (usize, &Vec<bool>)| {
            truth.iter().enumerate().filter(|(at, lit)| is_lit(k, *at) != **lit).count()
        };
        let counts: Vec<usize> = truth.iter().enumerate().map(wrong).collect();
        let ms = begun.elapsed().as_secs_f64() * 1e3 / truth.len() as f64;
        let (mut wrong, mut seen) = (0.0, 0.0);
        for (k, lit) in truth.iter().enumerate() {
            for (at, lit) in lit.iter().enumerate() {
                seen += if *lit { shown[k][at] } else { 0.0 };
                wrong += if is_lit(k, at) == *lit { 0.0 } else { shown[k][at] };
            }
        }
        (Self { counts, masked: wrong / seen }, ms)
    }

    /// Percent of samples: over all lights, then by bands; of the area that views see.
    fn row(&self, lights: &Directions, samples: usize) -> String {
        let share = |low: f64, high: f64| {
            let within = |k: &usize| {
                let elevation = lights.vectors()[*k].z.asin().to_degrees();
                low <= elevation && elevation < high
            };
            let own: Vec<usize> = (0..self.counts.len()).filter(within).collect();
            let wrong: usize = own.iter().map(|k| self.counts[*k]).sum();
            format!("{:.2}", 100.0 * wrong as f64 / (own.len() * samples) as f64)
        };
        let bands = BANDS.windows(2).map(|b| share(b[0], b[1]));
        let masked = format!("{:.2}", 100.0 * self.masked);
        let all = std::iter::once(share(0.0, 90.1)).chain(bands).chain([masked]);
        all.collect::<Vec<_>>().join(" | ")
    }
}

/// Ellipses of all samples, and the milliseconds of what is seen and of the fit.
fn ellipses(
    gpu: &mut Headless,
    land: &Land,
    directions: &Directions,
) -> Result<(Vec<Ellipse>, [f64; 2])> {
    let plan = plan::ellipses(&land.field, land.border, directions, &gpu.report().limits)?;
    gpu.with_frame(plan, &[land.field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        let times = gpu.draw(frame)?;
        let of = |is_fit: bool| {
            let own = times.iter().filter(|t| t.label.starts_with("ellipse_fit") == is_fit);
            own.map(|t| t.ns).sum::<f64>() / 1e6
        };
        let ms = [of(false), of(true)];
        let [axes, radii] = [gpu.pixels(frame, 0)?.values, gpu.pixels(frame, 1)?.values];
        let pairs = axes.chunks_exact(4).zip(radii.chunks_exact(4));
        let all = pairs
            .map(|(a, r)| Ellipse::of_texels([a[0], a[1], a[2], a[3]], [r[0], r[1]]))
            .collect();
        Ok((all, ms))
    })
}

/// Milliseconds of a sun's shadows by the exact sweep, whole frames, and the percent of samples that face a sun and that it has
/// wrong; of every tenth light.
fn swept(
    gpu: &mut Headless,
    land: &Land,
    lights: &Directions,
    truth: &Truth,
) -> Result<(f64, f64)> {
    let normals = bake::normals(&land.field, land.border);
    let (mut ms, mut count, mut wrong, mut facing) = (0.0, 0.0, 0, 0);
    for k in (0..LIGHTS).step_by(10) {
        let e = lights.vectors()[k];
        let sun = Sun {
            azimuth_rad: e.y.atan2(e.x),
            elevation_rad: e.z.asin(),
            diameter_rad: 0.0,
            irradiance: [1.0; 3],
        };
        let surface =
            Surface { border: land.border, albedo: Albedo::Constant([1.0; 3]), specular: None };
        let lights = Lights { suns: vec![sun], ..Lights::default() };
        let scene = Scene { field: land.field.clone(), surface, lights };
        let quality = Quality { method: Method::Sweep, ..Quality::default() };
        let limits = gpu.report().limits;
        let plan = plan::picture(&scene, &quality, &limits, Picture::default())?;
        let inputs = plan::picture_inputs(&scene);
        let inputs: Vec<&[f32]> = inputs.iter().map(Vec::as_slice).collect();
        let (took, radiance) = gpu.with_frame(plan, &inputs, |gpu, frame| {
            Ok((timed(gpu, frame)?, gpu.pixels(frame, 0)?))
        })?;
        (ms, count) = (ms + took, count + 1.0);
        for (at, texel) in radiance.values.chunks_exact(radiance.channels).enumerate() {
            // Of those that hardly face it a rounding tells.
            if truth.shown[k][at] > 1e-3 {
                facing += 1;
                // Half or more of the sun's light.
                let whole = truth.shown[k][at] * normals[at].z / PI;
                wrong += usize::from((f64::from(texel[0]) >= 0.5 * whole) != truth.lit[k][at]);
            }
        }
    }
    Ok((ms / count, 100.0 * wrong as f64 / facing as f64))
}

/// The table of a field; its ellipses of most directions.
fn one(gpu: &mut Headless, land: &Land, lights: &Directions) -> Result<Vec<Ellipse>> {
    let Land { name, field, border } = land;
    let samples = field.rows() * field.cols();
    let (exact, exact_ms) = points(gpu, field, *border, lights)?;
    let sees_sky = |k: usize, at: usize| exact.point(k, at) == VisiblePoint::Sky;
    let lit: Vec<Vec<bool>> =
        (0..LIGHTS).map(|k| (0..samples).map(|at| sees_sky(k, at)).collect()).collect();
    let normals = bake::normals(field, *border);
    let shown = |view: &DVec3| normals.iter().map(|n| n.dot(*view).max(0.0) / n.z).collect();
    let truth = Truth { lit, shown: lights.vectors().iter().map(shown).collect() };
    let lit = truth.lit.iter().flatten().filter(|lit| **lit).count();
    println!(
        "{name}, {} × {}; {:.1} % lit\n",
        field.cols(),
        field.rows(),
        100.0 * lit as f64 / (LIGHTS * samples) as f64
    );
    println!(
        "| shadows by | found, ms | fitted, ms | a light, ms | bytes a sample | wrong, % | 0-15° | 15-30° | 30-60° | 60-90° | of what views see |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    println!("| rays | | | {:.2} | | | | | | | |", exact_ms / LIGHTS as f64);
    let (ms, wrong) = swept(gpu, land, lights, &truth)?;
    println!("| exact sweep | | | {ms:.2} | | {wrong:.2} | | | | | |");
    let mut last = Vec::new();
    for count in COUNTS {
        let directions = Directions::fibonacci(count, -1.0, 0)?;
        let (points, found_ms) = points(gpu, field, *border, &directions)?;
        let triangles = directions.triangles()?;
        let nearest = |light: glam::DVec3| {
            let above = (0..count).filter(|i| directions.vectors()[*i].z > 0.0);
            let of = |i: usize| directions.vectors()[i].dot(light);
            let nearest = above.max_by(|a, b| of(*a).total_cmp(&of(*b))).expect("some above");
            [(nearest, 1.0), (nearest, 0.0), (nearest, 0.0)]
        };
        let around: Vec<_> = lights
            .vectors()
            .iter()
            .map(|light| points.around(&triangles, *light).unwrap_or_else(|| nearest(*light)))
            .collect();
        let (wrong, ms) = Wrong::of(&truth, |k, at| {
            ridgelight_cpu::visible_points::lit_share(&points, &around[k], at) >= 0.5
        });
        let bytes = 4 * points.words().len() / samples;
        println!(
            "| {count} directions | {found_ms:.1} | | {ms:.3} | {bytes} | {} |",
            wrong.row(lights, samples)
        );
        let (found, [seen_ms, fit_ms]) = ellipses(gpu, land, &directions)?;
        let (wrong, ms) = Wrong::of(&truth, |k, at| found[at].holds(lights.vectors()[k]));
        println!(
            "| ellipses of {count} | {seen_ms:.1} | {fit_ms:.1} | {ms:.3} | 12 | {} |",
            wrong.row(lights, samples)
        );
        if count == COUNTS[COUNTS.len() - 1] {
            let begun: Vec<Ellipse> = (0..samples).map(|at| start(&sky_of(&points, at))).collect();
            let (wrong, _) = Wrong::of(&truth, |k, at| begun[at].holds(lights.vectors()[k]));
            println!("| covariances of {count} | | | | 12 | {} |", wrong.row(lights, samples));
        }
        last = found;
    }
    println!();
    Ok(last)
}

fn run() -> Result<()> {
    let (mut folder, mut side, mut output) = (None::<PathBuf>, 48, None::<PathBuf>);
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--side" => {
                let text = args.next().unwrap_or_default();
                let number = text.parse().ok().filter(|n| (8..=256).contains(n));
                side = number
                    .ok_or_else(|| Error::setting(arg, text, "a whole number from 8 to 256"))?;
            }
            "-o" => output = args.next().map(PathBuf::from),
            other if other.starts_with('-') => {
                return Err(Error::setting("argument", arg, "FOLDER, --side N, -o PICTURE.png"));
            }
            _ => folder = Some(arg.into()),
        }
    }
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}, {}\n", gpu.report().name, gpu.report().driver);
    println!(
        "{LIGHTS} lights evenly over the upper hemisphere; directions evenly over the sphere, half of them above horizontal. \
         Found and fitted: the device's own ms, as a light by rays; a light of the others: one core of the processor, look-ups \
         alone. Bytes: of ellipses six numbers of 16 bits. Covariances: ellipses before their centres and radii are searched for. Exact sweep: a \
         whole frame under one sun. Of what views see: area that a test takes for seen or hidden wrongly, over that which is seen.\n"
    );
    let lights = Directions::fibonacci(LIGHTS, 0.0, 7)?;
    let mut drawn = Vec::new();
    for land in lands(folder.as_deref(), side)? {
        let ellipses = one(&mut gpu, &land, &lights)?;
        drawn.push((land, ellipses));
    }
    match output {
        Some(path) => picture::write(&path, &drawn),
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
