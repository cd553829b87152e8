//! What can be baked: one file a kind, and a line of [`KINDS`].

mod bent_normal;
mod brdf;
mod brdf_factors;
mod brdf_harmonics;
mod btf;
mod curved_ellipse;
mod ellipse;
mod far_field;
mod horizon;
mod light_field;
mod scatter;
mod sh_transfer;
mod sh_visibility;
mod sky_view;
mod visible_points;
mod visible_sky;

use std::cell::OnceCell;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{Limits, Plan};
use ridgelight::scene::{Border, Directions, HeightField, Quality, Scatter, Scene};
use ridgelight_bake::{Angles, Encoding, Ray, Sum, Summing};

use super::map::{Format, MapFiles};
pub use far_field::{diffuse, direct_plan, looks};
pub use scatter::paths;

/// All of them, as --help lists them.
pub static KINDS: [&Kind; 15] = [
    &horizon::KIND,
    &sky_view::KIND,
    &visible_sky::KIND,
    &bent_normal::KIND,
    &sh_visibility::KIND,
    &sh_transfer::KIND,
    &ellipse::KIND,
    &curved_ellipse::KIND,
    &visible_points::KIND,
    &scatter::KIND,
    &brdf::KIND,
    &brdf_factors::KIND,
    &brdf_harmonics::KIND,
    &btf::KIND,
    &light_field::KIND,
];

/// What can be baked.
pub struct Kind {
    /// As `--what` takes it; its files are called so, with `_` for `-`.
    pub name: &'static str,
    /// What it is, for --help and the sheet.
    pub about: &'static str,
    /// How its values are packed; the first is the default.
    pub encodings: &'static [Encoding],
    /// Files that are written where none are asked for.
    pub formats: &'static [Format],
    /// GLSL that reads the .ktx2, less the constants of a [`Map`].
    pub decoder: &'static str,
    /// Begins one.
    pub begin: fn(&Request) -> Result<Making>,
}

/// What is asked of a kind.
pub struct Request<'a> {
    pub border: Border,
    pub quality: &'a Quality,
    pub directions: &'a Directions,
    pub angles: Angles,
    /// Outwards and inwards, 1/m.
    pub curvature: Option<[f64; 2]>,
    pub encoding: &'static Encoding,
    /// Whether a .ktx2 is written, whose components may hold less than f32.
    pub has_texels: bool,
    /// Whether ground reflects by a lobe, too.
    pub has_lobe: bool,
    /// Of the field.
    pub samples: usize,
}

/// A map as it will stand in files.
#[derive(Default)]
pub struct Map {
    /// A plane of values each, as channels of an .exr are called, in the order of an .npy.
    pub planes: Vec<String>,
    /// What the planes hold, one after the other; one entry where all hold the same.
    pub values: Vec<Value>,
    /// Whether the .ktx2 is an array, a layer for as many planes as its encoding takes.
    pub is_array: bool,
    /// Constants that the decoder needs, as lines of GLSL.
    pub constants: Vec<String>,
    /// Columns and rows, where it has not a texel a sample.
    pub size: Option<[usize; 2]>,
    /// Axes of an .npy, where they are others than planes, rows and columns: names and counts, the last the fastest.
    pub axes: Vec<(&'static str, usize)>,
}

impl Map {
    /// Texels of a plane, of a field of so many samples.
    pub fn texels(&self, samples: usize) -> usize {
        self.size.map_or(samples, |[cols, rows]| cols * rows)
    }
}

/// A value of a sample.
pub struct Value {
    pub name: &'static str,
    pub about: &'static str,
    /// "rad", or nothing.
    pub unit: &'static str,
    /// The least and the largest that it can be.
    pub range: [f64; 2],
}

/// A kind on its way.
pub struct Making {
    pub map: Map,
    pub source: Source,
}

/// What a kind is made of.
pub enum Source {
    Horizons(Box<dyn Maker>),
    Directions(OfDirections),
    Light(OfLight),
}

impl Source {
    /// Bytes that it holds until the end.
    pub fn bytes(&self, lit: &Lit) -> u64 {
        match self {
            Source::Horizons(maker) => maker.bytes(),
            Source::Directions(of) => {
                (of.bytes)(lit.around) * lit.scene.field.heights_m().len() as u64
            }
            Source::Light(of) => (of.bytes)(lit),
        }
    }
}

/// What a field's samples see in directions, on bases that are bent outwards and inwards by two curvatures, 1/m.
pub type PlanOf = fn(&HeightField, Border, &Directions, Option<[f64; 2]>, &Limits) -> Result<Plan>;

/// A kind that the device makes of what samples see in directions.
#[derive(Clone, Copy)]
pub struct OfDirections {
    pub plan: PlanOf,
    /// Bytes a sample of what comes off the device and waits for files.
    pub bytes: fn(&Directions) -> u64,
    /// To files.
    pub take: fn(&LookJob, &mut MapFiles) -> Result<()>,
}

/// Takes what is being done, for who waits.
pub type Say<'a> = &'a dyn Fn(String);

/// A kind that is light: the device is asked several things for it.
#[derive(Clone, Copy)]
pub struct OfLight {
    /// What the device is asked, for what it takes.
    pub plans: fn(&Lit, &Limits) -> Result<Vec<Plan>>,
    /// Bytes that it holds until the end.
    pub bytes: fn(&Lit) -> u64,
    /// To files; the last is told what is being done.
    pub make: fn(&mut Headless, &Lit, &mut MapFiles, Say) -> Result<()>,
}

/// A whole number among the settings of a plan, which has it.
fn number(plan: &Plan, name: &str) -> u32 {
    let of = plan.settings.iter().find(|(known, _)| known == name);
    of.and_then(|(_, value)| value.parse().ok()).expect("plans of scattered light tell it")
}

/// What light is made of.
pub struct Lit<'a> {
    pub scene: &'a Scene,
    pub quality: &'a Quality,
    pub limits: Limits,
    /// Of scattered light, none without bounces.
    pub scatter: Option<Scatter>,
    /// In which samples look for each other.
    pub around: &'a Directions,
    /// Of lights and views.
    pub angles: Angles,
    /// Of bent bases.
    pub curvature: Option<[f64; 2]>,
    /// Of the pairs that a table is asked for between its angles.
    pub seed: u32,
    /// That `brdf`, `brdf-factors` and `brdf-harmonics` are of, once one of them has asked for it.
    pub table: OnceCell<brdf::Table>,
}

/// What came of its plan.
pub struct LookJob<'a> {
    pub field: &'a HeightField,
    pub border: Border,
    pub directions: &'a Directions,
    pub curvature: Option<[f64; 2]>,
    /// Components of each output, 32 bits each.
    pub outputs: &'a [Vec<f32>],
}

/// Makes a map of the horizons of a circle.
pub trait Maker {
    /// Bytes that it holds until the end.
    fn bytes(&self) -> u64;

    /// Takes an azimuth, in the order of the circle: elevations, radians, and unit normals of all samples.
    fn add(
        &mut self,
        ray: Ray,
        elevations_rad: &[f32],
        normals: &[DVec3],
        files: &mut MapFiles,
    ) -> Result<()>;

    /// Hands over what is left, after the last azimuth.
    fn end(self: Box<Self>, normals: &[DVec3], files: &mut MapFiles) -> Result<()>;
}

/// A kind that is a sum over azimuths.
struct Sums {
    summing: Summing,
    bytes: u64,
}

impl Sums {
    fn begin(what: Box<dyn Sum>, asked: &Request, map: Map) -> Making {
        // The sums, and the values as they are made of them.
        let bytes =
            Summing::bytes(&*what, asked.samples) + 4 * (what.values() * asked.samples) as u64;
        let summing = Summing::new(what, asked.samples);
        Making { map, source: Source::Horizons(Box::new(Self { summing, bytes })) }
    }
}

impl Maker for Sums {
    fn bytes(&self) -> u64 {
        self.bytes
    }

    fn add(
        &mut self,
        ray: Ray,
        elevations_rad: &[f32],
        normals: &[DVec3],
        _: &mut MapFiles,
    ) -> Result<()> {
        self.summing.add(ray, elevations_rad, normals)
    }

    fn end(self: Box<Self>, normals: &[DVec3], files: &mut MapFiles) -> Result<()> {
        let planes = self.summing.end(normals)?;
        let planes: Vec<&[f32]> = planes.iter().map(Vec::as_slice).collect();
        planes.chunks(files.planes_at_once()).try_for_each(|layer| files.take(layer))
    }
}

/// Coefficients of harmonics, four a texel.
fn coefficients(kind: &Kind, order: usize, value: Value) -> Map {
    let stem = super::map::stem(kind);
    let bands = (0..order as isize).flat_map(|l| (-l..=l).map(move |m| (l, m)));
    Map {
        planes: bands.map(|(l, m)| format!("{stem}.l{l}m{m}")).collect(),
        values: vec![value],
        is_array: true,
        constants: vec![format!("const int SH_COUNT = {};", order * order)],
        ..Map::default()
    }
}
