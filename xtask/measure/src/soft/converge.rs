//! Errors of pyramids by levels an octave and by azimuths, under tables and SH, and the floors that sharp horizons
//! leave (NS09, figure 10); of sub-sampling, too. The middle N² (128) grid points of FIELD.

use std::path::PathBuf;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Basis, Method, Quality, Scene};
use ridgelight_io as files;

use super::truth;
use crate::common::args::Args;
use crate::common::frames::{Colours, drawn, error, open};
use crate::common::plot::{self, Panel, Style, curve};
use crate::common::{Outcome, head, inputs};

/// Levels an octave and the offset that goes with them (figure 10, above).
const STEPS: [(u32, u32); 5] = [(1, 0), (2, 1), (4, 2), (8, 3), (16, 4)];
/// Azimuths (figure 10, below), and those of the row above.
const AZIMUTHS: [u32; 5] = [4, 8, 16, 32, 64];
const MANY: u32 = 128;
/// Of those below.
const STEP: (u32, u32) = (4, 2);

/// Errors of one engine at one number of azimuths: tables and SH beside the ground truth, and SH beside
/// SH of the ground truth's horizons.
struct Errors([f64; 3]);

struct Bench<'a> {
    gpu: &'a mut Headless,
    scene: &'a Scene,
    truth: Colours,
    soft_truth: Colours,
}

impl Bench<'_> {
    fn errors(&mut self, quality: Quality) -> Result<Errors> {
        let mut light = |basis| drawn(self.gpu, self.scene, &Quality { basis, ..quality }, 0);
        let (tables, soft) = (light(Basis::Table)?.light, light(Basis::Sh)?.light);
        let beside = [(&tables, &self.truth), (&soft, &self.truth), (&soft, &self.soft_truth)];
        let [tables, soft, alike] = beside.map(|(light, truth)| error(light, truth));
        Ok(Errors([tables?, soft?, alike?]))
    }

    fn pyramid(&mut self, (level_step, level_offset): (u32, u32), azimuths: u32) -> Result<Errors> {
        let method = Method::Pyramid;
        self.errors(Quality { method, level_step, level_offset, azimuths, ..Quality::default() })
    }

    /// Of exact horizons: what azimuths and the basis leave.
    fn floor(&mut self, azimuths: u32) -> Result<Errors> {
        self.errors(Quality { method: Method::BruteForce, azimuths, ..Quality::default() })
    }
}

fn row(name: &str, Errors([tables, soft, alike]): &Errors) {
    println!("| {name} | {tables:.3} | {soft:.3} | {alike:.3} |");
}

/// Three curves of errors, and those of sharp horizons.
fn panel(title: &str, x: &'static str, rows: &[(f64, Errors)], floors: &[(f64, Errors)]) -> Panel {
    let names = ["tables", "SH", "SH, beside SH of exact horizons"];
    let of = |rows: &[(f64, Errors)], i: usize| rows.iter().map(|(x, e)| [*x, e.0[i]]).collect();
    let mut curves = Vec::new();
    for (i, name) in names.into_iter().enumerate() {
        curves.push(curve(name, i, Style::Dotted, of(rows, i)));
        // Of itself it has none.
        if i < 2 {
            curves.push(curve(&format!("{name}: floor"), i, Style::Dashes, of(floors, i)));
        }
    }
    Panel::new(title, [x, "relative RMSE, %"], curves)
}

pub fn run(mut args: Args) -> Outcome {
    let (env, output) = (args.path("--env")?, args.path("-o")?);
    let side = args.number("--side", 128)?;
    let field = inputs::field_asked(&mut args)?;
    args.end()?;
    let environment =
        files::read_environment(&env.unwrap_or_else(|| PathBuf::from(inputs::SKY)), 0.0)?;
    let scene = inputs::under(inputs::middle(&field, side)?, environment);
    let mut gpu = open()?;
    println!("{}", gpu.report().name);
    let panels = measured(&mut gpu, &scene)?;
    plot::write(output.as_deref(), &panels)
}

fn measured(gpu: &mut Headless, scene: &Scene) -> Result<[Panel; 2]> {
    let method = Method::BruteForce;
    let exact = Quality { method, azimuths: 256, basis: Basis::Sh, ..Quality::default() };
    let soft_truth = drawn(gpu, scene, &exact, 0)?.light;
    let truth = truth(gpu, scene)?;
    let [cols, rows] = [scene.field.cols(), scene.field.rows()];
    println!("{cols} × {rows} grid points; relative RMSE, %; SH of order 4, plane, slices\n");
    let mut bench = Bench { gpu, scene, truth, soft_truth };
    let columns =
        |first: &str| head(&format!("| {first} | tables | SH | SH, beside SH of exact horizons |"));
    columns(&format!("k, o; {MANY} azimuths"));
    let (mut by_step, mut step_floors) = (Vec::new(), Vec::new());
    let floor = bench.floor(MANY)?;
    for step in STEPS {
        let errors = bench.pyramid(step, MANY)?;
        row(&format!("{}, {}", step.0, step.1), &errors);
        by_step.push((f64::from(step.0), errors));
        step_floors.push((f64::from(step.0), Errors(floor.0)));
    }
    row("exact horizons", &floor);
    println!();
    columns(&format!("azimuths; k = {}, o = {}", STEP.0, STEP.1));
    let (mut by_azimuths, mut floors) = (Vec::new(), Vec::new());
    for azimuths in AZIMUTHS {
        let (errors, floor) = (bench.pyramid(STEP, azimuths)?, bench.floor(azimuths)?);
        row(&azimuths.to_string(), &errors);
        row(&format!("{azimuths}, exact horizons"), &floor);
        by_azimuths.push((f64::from(azimuths), errors));
        floors.push((f64::from(azimuths), floor));
    }
    println!();
    head(
        "| sub-sampling; default sweep, 64 azimuths | beside the ground truth | beside every grid point |",
    );
    let soft = Quality { basis: Basis::Sh, ..Quality::default() };
    let whole = drawn(bench.gpu, scene, &soft, 0)?.light;
    for subsample in [1, 2, 4] {
        let light = drawn(bench.gpu, scene, &Quality { subsample, ..soft }, 0)?.light;
        let [all, alone] = [error(&light, &bench.truth)?, error(&light, &whole)?];
        println!("| {subsample} | {all:.3} | {alone:.3} |");
    }
    let title = format!("k = {}, o = {}", STEP.0, STEP.1);
    Ok([
        panel(
            &format!("{MANY} azimuths"),
            "levels an octave, k (o = log2 k)",
            &by_step,
            &step_floors,
        ),
        panel(&title, "azimuths", &by_azimuths, &floors),
    ])
}
