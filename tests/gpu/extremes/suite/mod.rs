//! DESIGN §4 as a table: every case under every method, each error beside its bound. The tests run it on the driver at
//! hand; `cargo measure extremes` prints it for several as `out/extremes.md`.

mod bounces;
mod horizons;
pub mod inputs;
mod lights;
pub mod methods;
pub mod page;
mod phong;
mod points;
mod reference;
mod scatters;
mod soft_spheres;
mod specular;
mod sphere_lights;
mod suns;

use ridgelight::gpu::{Headless, Pixels};
use ridgelight::plan::{self, Azimuth, Picture, Plan};
use ridgelight::scene::{Albedo, Border, HeightField, Lights, Scene, Surface, VisiblePoints};

use methods::{Method, Traced};
use reference::CpuReference;

/// The output of a case.
#[derive(Clone, Copy)]
pub enum Asks {
    /// `count` azimuths from number `first` on, of a circle of `of`.
    Horizons { of: u32, first: u32, count: u32 },
    /// A picture and a layer for each light.
    Light,
    /// Visible points along the method's directions.
    Points,
    /// Ellipses of visible sky.
    Ellipses,
    /// Scattered light, of the direct light of [`scatters::direct`].
    Scatter,
}

/// The subject of a case, which selects its methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// Horizons, and the light that is drawn through them.
    Horizons,
    /// Indirect light.
    Bounces,
    /// Sphere lights by spherical harmonics.
    SoftSpheres,
    /// Direct Phong specular.
    Phong,
    /// Indirect Phong specular.
    Specular,
    /// Visible points, direction by direction.
    Points,
    /// Ellipses of visible sky.
    Ellipses,
    /// Light scattered between visible points.
    Scattering,
}

/// A scene at an extreme, and its expected answer.
pub struct Case {
    pub name: String,
    pub about: About,
    /// The right answer and why; for the page.
    pub expected: String,
    /// The bound of a value's error, as a formula; for the page.
    pub bound: String,
    pub scene: Scene,
    pub asks: Asks,
    /// Values of the result beside the expected ones.
    pub probes: Probes,
    /// The sentence with which a method refuses the case.
    pub refuses: fn(&Method) -> Option<&'static str>,
    /// Whether a method's rounding may be as large as the expected value: no bound is meaningful then.
    pub unjudged: fn(&Method) -> bool,
    /// Whether a method takes so long that only `tools/extremes` draws it.
    pub is_long: fn(&Method) -> bool,
}

type Probes = Box<dyn Fn(&Found) -> Vec<Probe>>;

/// A found value and its limits.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    pub found: f64,
    /// The right answer, or the interval that holds it.
    pub expected: [f64; 2],
    /// The accepted distance outside it.
    pub bound: f64,
    /// Azimuth or light, row, column.
    pub at: [usize; 3],
}

impl Probe {
    /// Distance from the expected value; infinite for NaN.
    pub fn error(&self) -> f64 {
        let [low, high] = self.expected;
        let error = (low - self.found).max(self.found - high).max(0.0);
        if self.found.is_finite() { error } else { f64::INFINITY }
    }

    /// Error over bound: above 1 fails.
    pub fn ratio(&self) -> f64 {
        if self.error() == 0.0 { 0.0 } else { self.error() / self.bound }
    }
}

/// A method's output for a case.
pub struct Found<'a> {
    pub scene: &'a Scene,
    pub method: &'a Method,
    /// The azimuths of the requested circle, as the method sweeps them.
    pub azimuths: Vec<Azimuth>,
    /// Radians of each.
    pub azimuths_rad: Vec<f64>,
    /// A pyramid's expected values on ground that is no plane.
    reference: Option<CpuReference<'a>>,
    asks: Asks,
    plan: Plan,
    outputs: Vec<Pixels>,
}

impl Found<'_> {
    /// Elevation of the horizon, radians; `None` where that azimuth was not requested.
    pub fn horizon(&self, k: usize, row: usize, col: usize) -> Option<f64> {
        let Asks::Horizons { first, count, .. } = self.asks else { return None };
        let layer = (k as u32).checked_sub(first).filter(|layer| *layer < count)? as usize;
        let (rows, cols) = (self.scene.field.rows(), self.scene.field.cols());
        Some(f64::from(self.outputs[0].values[(layer * rows + row) * cols + col]))
    }

    /// A horizon with this expected slope: see [`Method::angle_error`].
    pub fn slope(
        &self,
        at: [usize; 3],
        slope: f64,
        (largest_m, near_m): (f64, f64),
    ) -> Option<Probe> {
        self.between(at, [slope; 2], (largest_m, near_m), 0.0)
    }

    /// A horizon with an expected interval of slopes, where rounding may break ties. For a pyramid on uneven ground
    /// the CPU reference's, whatever the slope.
    pub fn between(
        &self,
        at: [usize; 3],
        slopes: [f64; 2],
        rounded: (f64, f64),
        ties: f64,
    ) -> Option<Probe> {
        let [k, row, col] = at;
        let found = self.horizon(k, row, col)?;
        let azimuth = &self.azimuths[k];
        if let Some((reference, bound)) = self.reference_elevation(azimuth, row, col) {
            return Some(Probe { found, expected: [reference; 2], bound, at });
        }
        let bounds = slopes.map(|s| self.method.angle_error(s, rounded, ties, azimuth));
        let expected = slopes.map(f64::atan);
        Some(Probe { found, expected, bound: bounds[0].max(bounds[1]), at })
    }

    /// The expected elevation of a pyramid on uneven ground, and its bound; `None` where the exact one is expected.
    pub fn reference_elevation(
        &self,
        azimuth: &Azimuth,
        row: usize,
        col: usize,
    ) -> Option<(f64, f64)> {
        self.reference.as_ref().map(|reference| reference.elevation(azimuth, row, col))
    }

    /// First channel of a layer at a texel.
    pub fn light(&self, layer: &str, row: usize, col: usize) -> f64 {
        let output = self.outputs.iter().find(|o| o.name == layer);
        let output = output.unwrap_or_else(|| panic!("no output {layer}"));
        f64::from(output.values[(row * self.scene.field.cols() + col) * output.channels])
    }

    /// First channel of a layer, row-major.
    pub fn layer(&self, layer: &str) -> Vec<f64> {
        let cols = self.scene.field.cols();
        let count = self.scene.field.heights_m().len();
        (0..count).map(|i| self.light(layer, i / cols, i % cols)).collect()
    }

    /// An output of four channels, row-major.
    fn texels(&self, output: usize) -> Vec<[f32; 4]> {
        self.outputs[output].values.as_chunks().0.to_vec()
    }

    /// Visible points: the outputs of [`Asks::Points`].
    fn points(&self) -> VisiblePoints {
        points_of(self.scene, self.traced(), &self.outputs)
    }

    /// The method's directions.
    fn traced(&self) -> &Traced {
        self.method.traced()
    }

    /// Whether there is such a layer.
    pub fn has(&self, layer: &str) -> bool {
        self.outputs.iter().any(|o| o.name == layer)
    }

    /// The number of the circle's swept azimuths.
    pub fn count(&self) -> f64 {
        f64::from(self.method.quality.azimuths)
    }
}

/// The result of a case under a method.
pub enum Outcome {
    /// The worst of the values, the largest error of all, and the tightest bound as a share of the largest expected
    /// value, where that is not 0.
    Measured { worst: Probe, largest_error: f64, tightest: f64, values: usize },
    /// The sentence of the refusal.
    Refused(String),
}

impl Outcome {
    /// The number of compared values.
    pub fn values(&self) -> usize {
        match self {
            Outcome::Measured { values, .. } => *values,
            Outcome::Refused(_) => 0,
        }
    }
}

/// A case under a method, by their places in the lists.
pub struct Row {
    pub case: usize,
    pub method: usize,
    pub outcome: Outcome,
}

/// Every case. A new one is enrolled by an entry in one of the lists.
pub fn cases() -> Vec<Case> {
    let of_horizons =
        horizons::cases().into_iter().chain(lights::cases()).chain(sphere_lights::cases());
    let of_their_own = bounces::cases().into_iter().chain(soft_spheres::cases());
    let of_visible_points = points::cases().into_iter().chain(scatters::cases());
    let of_specular = phong::cases().into_iter().chain(specular::cases());
    of_horizons.chain(of_their_own).chain(of_specular).chain(of_visible_points).collect()
}

/// The pairs of cases and methods, by their places in the lists.
pub fn put(cases: &[Case], methods: &[Method]) -> Vec<[usize; 2]> {
    let all = (0..methods.len()).flat_map(|m| (0..cases.len()).map(move |c| [c, m]));
    all.filter(|[c, m]| cases[*c].about == methods[*m].about).collect()
}

/// The outputs of a plan.
fn drawn(gpu: &mut Headless, plan: Plan, contents: &[Vec<f32>]) -> Result<Vec<Pixels>, String> {
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let outputs = plan.outputs().count();
    let pixels = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        (0..outputs).map(|output| gpu.pixels(frame, output)).collect()
    });
    pixels.map_err(|e: ridgelight::Error| e.to_string())
}

fn points_of(scene: &Scene, traced: &Traced, outputs: &[Pixels]) -> VisiblePoints {
    let words = outputs.iter().flat_map(|image| image.values.iter().map(|v| v.to_bits())).collect();
    let points =
        VisiblePoints::new(&scene.field, scene.surface.border, traced.directions.clone(), words);
    points.expect("points of the field")
}

/// The probes of a case under a method on a device, or the sentence of the refusal.
pub fn probes(gpu: &mut Headless, case: &Case, method: &Method) -> Result<Vec<Probe>, String> {
    let (scene, field, border) = (&case.scene, &case.scene.field, case.scene.surface.border);
    let limits = gpu.report().limits;
    let heights = vec![field.heights_m().to_vec()];
    let mut quality = method.quality;
    let visible = || plan::visible_points(field, border, &method.traced().directions, &limits);
    let planned = match case.asks {
        Asks::Horizons { of, first, count } => {
            quality.azimuths = of;
            plan::horizons(field, border, &quality, &limits, (first, count), false)
        }
        Asks::Light => {
            let wanted = Picture { light_layers: true, ..Picture::default() };
            plan::picture(scene, &quality, &limits, wanted)
        }
        Asks::Points => visible(),
        Asks::Ellipses => plan::ellipses(field, border, &method.traced().directions, &limits),
        Asks::Scatter => {
            let Traced { directions, scatter } = method.traced();
            plan::scatter(scene, directions, scatter, &limits)
        }
    };
    let plan = planned.map_err(|e| e.to_string())?;
    let contents = match case.asks {
        Asks::Horizons { .. } | Asks::Points | Asks::Ellipses => heights,
        Asks::Light => plan::picture_inputs(scene),
        Asks::Scatter => {
            let words = drawn(gpu, visible().map_err(|e| e.to_string())?, &heights)?;
            let points = points_of(scene, method.traced(), &words);
            let inputs = plan::scatter_inputs(&plan, scene, &points, &scatters::direct(scene));
            inputs.map_err(|e| e.to_string())?
        }
    };
    let outputs = drawn(gpu, plan.clone(), &contents)?;
    let finds_horizons = case.about == About::Horizons;
    let is_smoothed = finds_horizons && method.is_pyramid() && !is_plane(scene);
    let reference = is_smoothed.then(|| CpuReference::new(scene, &quality));
    let found = Found {
        scene,
        method,
        azimuths: method.azimuths(quality.azimuths, field.cell_m()),
        azimuths_rad: plan::circle_rad(&quality, field.cell_m()).expect("azimuths"),
        reference,
        asks: case.asks,
        plan,
        outputs,
    };
    Ok((case.probes)(&found))
}

/// The worst of some probes.
pub fn outcome(probes: Result<Vec<Probe>, String>) -> Outcome {
    let probes = match probes {
        Ok(probes) => probes,
        Err(sentence) => return Outcome::Refused(sentence),
    };
    let worst = probes.iter().copied().max_by(|a, b| a.ratio().total_cmp(&b.ratio()));
    let largest = probes.iter().fold(0.0_f64, |m, p| p.expected[1].abs().max(m));
    let tightest = probes.iter().fold(f64::INFINITY, |m, p| p.bound.min(m));
    Outcome::Measured {
        worst: worst.expect("a case checks something under every method"),
        largest_error: probes.iter().fold(0.0, |m, p| p.error().max(m)),
        tightest: if largest > ROUNDING_RESIDUE { tightest / largest } else { tightest },
        values: probes.len(),
    }
}

/// Expected values up to here count as 0: two factors that should be 0 but are 2^-53 multiply to 1.2e-32.
const ROUNDING_RESIDUE: f64 = 1e-30;

/// A bound that is hardly meaningful: a tenth of the largest expected value.
const LOOSE: f64 = 0.1;

/// The complaint about a row, if any: a value beyond its bound, or a bound that nothing can miss.
pub fn complaint(row: &Row, cases: &[Case], methods: &[Method]) -> Option<String> {
    let (case, method) = (&cases[row.case], &methods[row.method]);
    let said = match (&row.outcome, (case.refuses)(method)) {
        (Outcome::Measured { largest_error, .. }, None) if (case.unjudged)(method) => {
            if largest_error.is_finite() {
                return None;
            }
            "no number".to_owned()
        }
        (Outcome::Measured { tightest, .. }, None) if *tightest >= LOOSE => {
            format!("every bound is {tightest} of the largest that is to be found, or more")
        }
        (Outcome::Measured { worst, .. }, None) if worst.ratio() <= 1.0 => return None,
        (Outcome::Measured { worst, .. }, None) => {
            let Probe { found, expected: [low, high], bound, at } = worst;
            let ratio = worst.ratio();
            format!("at {at:?}: {found}, expected {low} to {high}: {ratio:.3} of {bound:e}")
        }
        (Outcome::Measured { .. }, Some(_)) => "drawn, and should be refused".to_owned(),
        (Outcome::Refused(said), Some(sentence)) if said == sentence => return None,
        (Outcome::Refused(said), _) => format!("refused: {said}"),
    };
    Some(format!("{}, {}: {said}", case.name, method.name))
}

/// Every case under every method; long ones where requested.
pub fn run(gpu: &mut Headless, cases: &[Case], methods: &[Method], long: bool) -> Vec<Row> {
    let is_drawn = |[c, m]: &[usize; 2]| long || !(cases[*c].is_long)(&methods[*m]);
    let row = |[c, m]: [usize; 2]| {
        let outcome = outcome(probes(gpu, &cases[c], &methods[m]));
        Row { case: c, method: m, outcome }
    };
    put(cases, methods).into_iter().filter(is_drawn).map(row).collect()
}

/// No method refuses.
fn never(_: &Method) -> Option<&'static str> {
    None
}

fn is_pyramid(method: &Method) -> bool {
    method.is_pyramid()
}

/// Every method can be judged.
fn none(_: &Method) -> bool {
    false
}

/// Valid heights without voids.
fn field(
    [rows, cols]: [usize; 2],
    cell_m: [f64; 2],
    height: impl Fn(usize, usize) -> f64,
) -> HeightField {
    let heights: Vec<f64> = (0..rows * cols).map(|i| height(i / cols, i % cols)).collect();
    HeightField::new(rows, cols, &heights, cell_m, None).expect("a good field")
}

/// A white field.
fn white(field: HeightField, border: Border, lights: Lights) -> Scene {
    let surface = Surface { albedo: Albedo::Constant([1.0; 3]), border, specular: None };
    Scene { field, surface, lights }
}

/// Whether the ground is a plane with heights rounded to f32: so is every level of it then.
fn is_plane(scene: &Scene) -> bool {
    let field = &scene.field;
    let (rows, cols) = (field.rows(), field.cols());
    let at = |r: usize, c: usize| f64::from(field.heights_m()[r * cols + c]);
    let by_row = (at(rows - 1, 0) - at(0, 0)) / (rows - 1).max(1) as f64;
    let by_col = (at(0, cols - 1) - at(0, 0)) / (cols - 1).max(1) as f64;
    // Three roundings: of a height and of the two ends that it is compared with.
    let rounding = 3.0 * ridgelight_cpu::tolerance::EPSILON * largest(field);
    let repeats = scene.surface.border == Border::Periodic;
    (!repeats || relief(field) <= rounding)
        && (0..rows * cols).all(|i| {
            let (r, c) = (i / cols, i % cols);
            let plane = at(0, 0) + by_row * r as f64 + by_col * c as f64;
            (at(r, c) - plane).abs() <= rounding
        })
}

/// Highest less lowest.
fn relief(field: &HeightField) -> f64 {
    let all = || field.heights_m().iter().copied().map(f64::from);
    all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min)
}

/// The largest |height above the base|.
fn largest(field: &HeightField) -> f64 {
    field.heights_m().iter().fold(0.0, |m, h| f64::from(h.abs()).max(m))
}
