//! How fast `ridgelight reference` follows light paths, and how long it takes to an error of 1 %.
//!
//! `cargo run --release --example paths -- FIELD [--cell X,Y] --env FILE [--side N] [--truth N]`: the
//! middle N × N samples of a field (512), and a fractal field of 256², of albedo 0.7, under a constant sky and
//! under the environment. Each error is against a run of another seed and N paths a sample (4096), whose
//! own standard error stands beside it.

use std::path::PathBuf;
use std::time::Instant;

use ridgelight::gpu::{Frame, Headless, HeadlessOptions};
use ridgelight::plan::{self, REFERENCE_BATCH};
use ridgelight::scene::fractal;
use ridgelight::scene::{Albedo, HeightField, Lights, Scene, Surface};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;
use ridgelight_trade::error::ImageError;

const ERROR: f64 = 0.01;
/// Of this length at least is the run whose rates are told, seconds.
const LEAST_S: f64 = 2.0;

struct Request {
    field: PathBuf,
    options: HeightOptions,
    environment: PathBuf,
    side: usize,
    truth: u32,
}

fn asked() -> Result<Request> {
    let (mut field, mut environment) = (None, None);
    let mut options = HeightOptions::default();
    let (mut side, mut truth) = (512, 4096);
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value =
            |what: &str| args.next().ok_or_else(|| Error::setting(arg.as_str(), "nothing", what));
        let whole = |text: String| {
            let number = text.parse::<u32>().ok().filter(|n| *n > 0);
            number.ok_or_else(|| Error::setting(arg.as_str(), text, "a whole number, 1 or more"))
        };
        match arg.as_str() {
            "--cell" => {
                let text = value("two lengths")?;
                let both: Vec<f64> = text.split(',').filter_map(|p| p.parse().ok()).collect();
                let both = both.try_into();
                let wrong = |_| Error::setting("--cell", text, "two lengths, parted by a comma");
                options.cell_m = Some(both.map_err(wrong)?);
            }
            "--env" => environment = Some(PathBuf::from(value("a file")?)),
            "--side" => side = whole(value("samples")?)? as usize,
            "--truth" => truth = whole(value("paths a sample")?)?,
            _ => field = Some(PathBuf::from(&arg)),
        }
    }
    let missing = |what: &str| Error::setting(what, "nothing", "a file");
    Ok(Request {
        field: field.ok_or_else(|| missing("FIELD"))?,
        environment: environment.ok_or_else(|| missing("--env"))?,
        options,
        side,
        truth,
    })
}

/// The middle of a field.
fn middle(field: &HeightField, side: usize) -> Result<HeightField> {
    let [rows, cols] = [field.rows(), field.cols()].map(|n| n.min(side));
    let [top, left] = [(field.rows() - rows) / 2, (field.cols() - cols) / 2];
    let at = |i: usize| (top + i / cols) * field.cols() + left + i % cols;
    let all = 0..rows * cols;
    let heights = all.clone().map(|i| field.base_m() + f64::from(field.heights_m()[at(i)]));
    let voids = field.voids().map(|voids| all.clone().map(|i| voids[at(i)]).collect());
    HeightField::new(rows, cols, &heights.collect::<Vec<_>>(), field.cell_m(), voids)
}

/// A frame that adds batches.
struct Tracer<'a> {
    gpu: &'a mut Headless,
    frame: &'a mut Frame,
    bands: Vec<usize>,
}

impl Tracer<'_> {
    /// The first batch, with all that paths need.
    fn begin(&mut self) -> Result<()> {
        self.gpu.draw(self.frame).map(|_| ())
    }

    fn add(&mut self) -> Result<()> {
        let mut bands = self.bands.iter();
        bands.try_for_each(|band| self.gpu.draw_passes(self.frame, &[*band]).map(|_| ()))
    }

    /// Texels of R, G, B, and a fourth value.
    fn output(&mut self, output: usize) -> Result<Vec<[f32; 4]>> {
        let values = self.gpu.pixels(self.frame, output)?.values;
        Ok(values.chunks_exact(4).map(|t| [t[0], t[1], t[2], t[3]]).collect())
    }
}

/// `work` on a scene with its pipelines made.
fn traced<T>(
    gpu: &mut Headless,
    scene: &Scene,
    (bounces, seed): (u32, u32),
    work: impl FnOnce(&mut Tracer) -> Result<T>,
) -> Result<T> {
    let plan = plan::reference(scene, bounces, seed, &gpu.report().limits)?;
    let contents = plan::reference_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let bands = (0..plan.passes.len()).filter(|p| plan.passes[*p].name() == "path_trace").collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        let mut tracer = Tracer { gpu, frame, bands };
        tracer.begin()?;
        work(&mut tracer)
    })
}

fn colours(texels: &[[f32; 4]]) -> Vec<f32> {
    texels.iter().flat_map(|t| [t[0], t[1], t[2]]).collect()
}

/// One row of the table.
fn row(
    gpu: &mut Headless,
    name: &str,
    scene: &Scene,
    bounces: u32,
    most_paths: u32,
) -> Result<String> {
    let cols = 3 * scene.field.cols();
    let samples = (scene.field.rows() * scene.field.cols()) as f64;
    let (truth, truth_error) = traced(gpu, scene, (bounces, 2), |tracer| {
        for _ in 1..most_paths.div_ceil(REFERENCE_BATCH).max(2) {
            tracer.add()?;
        }
        Ok((colours(&tracer.output(0)?), colours(&tracer.output(1)?)))
    })?;
    let none = vec![0.0_f32; truth.len()];
    let mean = ImageError::of(&truth, &none, cols)?.mean_shift;
    if mean <= 0.0 {
        return Err(Error::setting(name, "no light", "light to follow"));
    }
    let truth_error = ImageError::of(&truth_error, &none, cols)?.rmse / mean;
    traced(gpu, scene, (bounces, 1), |tracer| {
        // Once more, now that it is compiled.
        let start = Instant::now();
        tracer.begin()?;
        let mut spent_s = start.elapsed().as_secs_f64();
        let mut batches = 1;
        let mut reached = None;
        while reached.is_none() || spent_s < LEAST_S {
            if batches * REFERENCE_BATCH > most_paths {
                return Err(Error::Limit {
                    what: format!("1 % in {name}"),
                    needs: format!("more than {most_paths} paths a sample"),
                    limit: "those of its truth (--truth)".into(),
                });
            }
            if reached.is_none() {
                let light = colours(&tracer.output(0)?);
                let both = ImageError::of(&light, &truth, cols)?.relative_rmse;
                // Two independent runs differ by the errors of both.
                let own = (both.powi(2) - truth_error.powi(2)).max(0.0).sqrt();
                reached = (own <= ERROR).then_some((batches, spent_s, own));
            }
            let start = Instant::now();
            tracer.add()?;
            spent_s += start.elapsed().as_secs_f64();
            batches += 1;
        }
        let (at, at_s, own) = reached.expect("the loop's end");
        let rays: f64 = tracer.output(1)?.iter().map(|t| f64::from(t[3])).sum();
        let rate = samples * f64::from(batches * REFERENCE_BATCH) / spent_s;
        Ok(format!(
            "| {name} | {bounces} | {:.1} | {:.1} | {} paths, {at_s:.2} s, {:.3} % | {:.2} | {:.3} % |",
            rate * 1e-6,
            rays / spent_s * 1e-6,
            at * REFERENCE_BATCH,
            100.0 * own,
            at_s * (own / ERROR).powi(2),
            100.0 * truth_error
        ))
    })
}

fn main() -> Result<()> {
    let asked = asked()?;
    let whole = files::read_heights(&asked.field, &asked.options)?;
    let field = middle(&whole, asked.side)?;
    let environment = files::read_environment(&asked.environment, 0.0)?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}, {}\n", gpu.report().name, gpu.report().driver);
    println!(
        "| scene | bounces | M samples/s | M rays/s | first at or below 1 % relative RMSE | s to 1 % | own error of the truth |"
    );
    println!("|---|---|---|---|---|---|---|");
    let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let environment = Lights { environment: Some(environment), ..Lights::default() };
    let surface = Surface { albedo: Albedo::Constant([0.7; 3]), ..Surface::default() };
    let scene = |field: &HeightField, lights: &Lights| Scene {
        field: field.clone(),
        surface: surface.clone(),
        lights: lights.clone(),
    };
    let name = asked.field.file_stem().unwrap_or_default().to_string_lossy();
    let name = format!("{name}, middle {} × {}", field.cols(), field.rows());
    let small = fractal(256, 5)?;
    for (name, scene) in [
        ("fractal 256 × 256, sky".to_owned(), scene(&small, &sky)),
        (format!("{name}, sky"), scene(&field, &sky)),
        (format!("{name}, environment"), scene(&field, &environment)),
    ] {
        for bounces in [0, 1] {
            println!("{}", row(&mut gpu, &name, &scene, bounces, asked.truth)?);
        }
    }
    println!(
        "\nA sample is one path. \"s to 1 %\": its seconds times (error / 1 %)², the square root's law, which nets beat.\n\
         Beside it, measured elsewhere on two cores and not in this run: Mitsuba 3.9 llvm_ad_rgb on a fractal mesh of\n\
         256², albedo 0.7: 8.9 M samples/s for one sky ray each, 7 M for one bounce; 3.3 s and 2.2 s to 1 %. Its\n\
         samples also hold a ray from the camera; these begin on the surface."
    );
    Ok(())
}
