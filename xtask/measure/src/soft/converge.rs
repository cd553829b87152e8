//! Errors of pyramids by levels per octave and by azimuths, with tables and SH, and the floors that
//! exact horizons leave (NS09, figure 10); and of sub-sampling. The middle N² (128) grid points of
//! FIELD.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Basis, Method, Quality, Scene};
use ridgelight_io as files;

use crate::common::args::Args;
use crate::common::frames::{Colours, drawn, error, exact_light};
use crate::common::plot::{self, Panel, Style, curve};
use crate::common::{Outcome, cells, head, inputs};

/// Levels per octave and the offset that belongs to them (figure 10, above).
const STEPS: [(u32, u32); 5] = [(1, 0), (2, 1), (4, 2), (8, 3), (16, 4)];
/// Azimuths (figure 10, below), and those of the row above.
const AZIMUTHS: [u32; 5] = [4, 8, 16, 32, 64];
const MANY: u32 = 128;
/// Of those below.
const STEP: (u32, u32) = (4, 2);

/// Errors of one engine at one number of azimuths: tables and SH against exact horizons with tables,
/// and SH against exact horizons with SH.
type Errors = [f64; 3];

struct Bench<'a> {
    gpu: &'a mut Headless,
    scene: &'a Scene,
    exact: Colours,
    exact_sh: Colours,
}

impl Bench<'_> {
    fn light(&mut self, quality: &Quality) -> Result<Colours> {
        Ok(drawn(self.gpu, self.scene, quality, 0)?.light)
    }

    fn errors(&mut self, quality: Quality) -> Result<Errors> {
        let tables = self.light(&Quality { basis: Basis::Table, ..quality })?;
        let sh = self.light(&Quality { basis: Basis::Sh, ..quality })?;
        Ok([error(&tables, &self.exact)?, error(&sh, &self.exact)?, error(&sh, &self.exact_sh)?])
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

fn row(name: &str, errors: &Errors) {
    println!("| {name} | {} |", cells(3, *errors));
}

/// Three curves of errors, and those of exact horizons.
fn panel(title: &str, x: &'static str, rows: &[(u32, Errors, Errors)]) -> Panel {
    let names = ["tables", "SH", "SH, against SH of exact horizons"];
    let mut curves = Vec::new();
    for (i, name) in names.into_iter().enumerate() {
        let own = rows.iter().map(|(x, e, _)| [f64::from(*x), e[i]]).collect();
        curves.push(curve(name, i, Style::Dotted, own));
        // The third has no error of its own.
        if i < 2 {
            let floors = rows.iter().map(|(x, _, e)| [f64::from(*x), e[i]]).collect();
            curves.push(curve(&format!("{name}: floor"), i, Style::Dashes, floors));
        }
    }
    Panel::new(title, [x, "relative RMSE, %"], curves)
}

pub fn run(mut args: Args) -> Outcome {
    let (env, output) = (args.path("--env")?, args.path("-o")?);
    let side = args.number("--side", 128)?;
    let field = inputs::requested_field(&mut args)?;
    let mut gpu = args.open()?;
    let environment =
        files::read_environment(env.as_deref().unwrap_or(Path::new(inputs::SKY)), 0.0)?;
    let scene = inputs::under(inputs::middle(&field, side)?, environment);
    println!("{}", gpu.report().name);
    let panels = measured(&mut gpu, &scene)?;
    Ok(plot::write(output.as_deref(), &panels)?)
}

fn measured(gpu: &mut Headless, scene: &Scene) -> Result<[Panel; 2]> {
    let method = Method::BruteForce;
    let exact_sh = Quality { method, azimuths: 256, basis: Basis::Sh, ..Quality::default() };
    let exact_sh = drawn(gpu, scene, &exact_sh, 0)?.light;
    let exact = exact_light(gpu, scene, 256)?;
    let mut bench = Bench { gpu, scene, exact, exact_sh };
    let [cols, rows] = [scene.field.cols(), scene.field.rows()];
    println!("{cols} × {rows} grid points; relative RMSE, %; SH of order 4, plane, slices\n");
    let columns = |first: &str| {
        head(&format!("| {first} | tables | SH | SH, against SH of exact horizons |"))
    };
    columns(&format!("k, o; {MANY} azimuths"));
    let floor = bench.floor(MANY)?;
    let mut by_step = Vec::new();
    for step in STEPS {
        let errors = bench.pyramid(step, MANY)?;
        row(&format!("{}, {}", step.0, step.1), &errors);
        by_step.push((step.0, errors, floor));
    }
    row("exact horizons", &floor);
    println!();
    let title = format!("k = {}, o = {}", STEP.0, STEP.1);
    columns(&format!("azimuths; {title}"));
    let mut by_azimuths = Vec::new();
    for azimuths in AZIMUTHS {
        let (errors, floor) = (bench.pyramid(STEP, azimuths)?, bench.floor(azimuths)?);
        row(&azimuths.to_string(), &errors);
        row(&format!("{azimuths}, exact horizons"), &floor);
        by_azimuths.push((azimuths, errors, floor));
    }
    println!();
    head("| sub-sampling; default sweep | against exact horizons | against every grid point |");
    let sh = Quality { basis: Basis::Sh, ..Quality::default() };
    let whole = bench.light(&sh)?;
    for subsample in [1, 2, 4] {
        let light = bench.light(&Quality { subsample, ..sh })?;
        let [all, alone] = [error(&light, &bench.exact)?, error(&light, &whole)?];
        println!("| {subsample} | {all:.3} | {alone:.3} |");
    }
    let step = "levels per octave, k (o = log2 k)";
    let many = format!("{MANY} azimuths");
    Ok([panel(&many, step, &by_step), panel(&title, "azimuths", &by_azimuths)])
}
