//! Errors of pyramids, harmonics and sub-sampling, and what each leaves at its best.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Basis, Method, Quality, Scene};

use crate::plot::{Curve, Panel, svg};
use crate::{drawn, off, truth};

/// Levels an octave and the offset that goes with them (figure 10, above).
const STEPS: [(u32, u32); 5] = [(1, 0), (2, 1), (4, 2), (8, 3), (16, 4)];
/// Azimuths (figure 10, below), and those of the row above.
const AZIMUTHS: [u32; 5] = [4, 8, 16, 32, 64];
const MANY: u32 = 128;
/// Of those below.
const STEP: (u32, u32) = (4, 2);

/// Errors of one engine at one number of azimuths: tables' and harmonics' beside the truth, and harmonics'
/// beside harmonics of the truth's horizons.
struct Errors([f64; 3]);

struct Bench<'a> {
    gpu: &'a mut Headless,
    scene: &'a Scene,
    truth: Vec<f32>,
    soft_truth: Vec<f32>,
}

impl Bench<'_> {
    fn errors(&mut self, quality: Quality) -> Result<Errors> {
        let mut light = |basis| drawn(self.gpu, self.scene, &Quality { basis, ..quality }, 1);
        let (tables, soft) = (light(Basis::Table)?.0, light(Basis::Sh)?.0);
        let all =
            [off(&tables, &self.truth)?, off(&soft, &self.truth)?, off(&soft, &self.soft_truth)?];
        Ok(Errors(all))
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

/// Three curves of errors, and where sharp horizons leave them.
fn panel(title: &str, x: &'static str, rows: &[(f64, Errors)], floors: &[(f64, Errors)]) -> Panel {
    let names = ["tables", "harmonics", "harmonics, beside harmonics of exact horizons"];
    let of = |rows: &[(f64, Errors)], i: usize| rows.iter().map(|(x, e)| [*x, e.0[i]]).collect();
    let mut curves = Vec::new();
    for (i, name) in names.into_iter().enumerate() {
        curves.push(Curve { name: name.into(), points: of(rows, i), colour: i, is_floor: false });
        let floor = format!("{name}: floor");
        // Of itself it has none.
        if i < 2 {
            let points = of(floors, i);
            curves.push(Curve { name: floor, points, colour: i, is_floor: true });
        }
    }
    Panel { title: title.into(), x, y: "relative RMSE, %", curves }
}

pub fn run(gpu: &mut Headless, scene: &Scene) -> Result<String> {
    let exact = Quality {
        method: Method::BruteForce,
        azimuths: 256,
        basis: Basis::Sh,
        ..Quality::default()
    };
    let soft_truth = drawn(gpu, scene, &exact, 1)?.0;
    let truth = truth(gpu, scene)?;
    let (cols, rows) = (scene.field.cols(), scene.field.rows());
    println!(
        "{cols} × {rows} samples; RMSE over the mean, %; harmonics of order 4, plane, slices\n"
    );
    let mut bench = Bench { gpu, scene, truth, soft_truth };
    let head = |first: &str| {
        println!("| {first} | tables | harmonics | harmonics, beside those of exact horizons |");
        println!("|---|---|---|---|");
    };
    head(&format!("k, o; {MANY} azimuths"));
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
    head(&format!("azimuths; k = {}, o = {}", STEP.0, STEP.1));
    let (mut by_azimuths, mut floors) = (Vec::new(), Vec::new());
    for azimuths in AZIMUTHS {
        let (errors, floor) = (bench.pyramid(STEP, azimuths)?, bench.floor(azimuths)?);
        row(&azimuths.to_string(), &errors);
        row(&format!("{azimuths}, exact horizons"), &floor);
        by_azimuths.push((f64::from(azimuths), errors));
        floors.push((f64::from(azimuths), floor));
    }
    println!(
        "\n| sub-sampling; default sweep, 64 azimuths | beside the truth | beside every sample |"
    );
    println!("|---|---|---|");
    let soft = Quality { basis: Basis::Sh, ..Quality::default() };
    let whole = drawn(bench.gpu, scene, &soft, 1)?.0;
    for subsample in [1, 2, 4] {
        let light = drawn(bench.gpu, scene, &Quality { subsample, ..soft }, 1)?.0;
        let [all, alone] = [off(&light, &bench.truth)?, off(&light, &whole)?];
        println!("| {subsample} | {all:.3} | {alone:.3} |");
    }
    let x = "levels an octave, k (o = log2 k)";
    Ok(svg(&[
        panel(&format!("{MANY} azimuths"), x, &by_step, &step_floors),
        panel(&format!("k = {}, o = {}", STEP.0, STEP.1), "azimuths", &by_azimuths, &floors),
    ]))
}
