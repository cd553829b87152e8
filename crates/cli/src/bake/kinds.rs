//! The kinds of map. Each has a static entry in [`KINDS`].

mod bent_normal;
mod brdf;
mod brdf_factors;
mod brdf_harmonics;
mod btf;
mod curved_ellipse;
mod ellipse;
mod far_field;
mod harmonics;
mod horizon;
mod light_field;
mod scatter;
mod sky;
mod visible_points;

use std::cell::OnceCell;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{Limits, Plan};
use ridgelight::scene::{Border, Directions, HeightField, Quality, Scatter, Scene};
use ridgelight_bake::{Angles, Encoding, HorizonMap, HorizonSums, Ray};

use super::map::{Format, MapFiles};
pub use far_field::{diffuse, direct_plan, rays};
pub use scatter::paths;

/// All kinds, in the order of --help.
pub static KINDS: [&Kind; 15] = [
    &horizon::KIND,
    &sky::SKY_VIEW,
    &sky::VISIBLE_SKY,
    &bent_normal::KIND,
    &harmonics::SH_VISIBILITY,
    &harmonics::SH_TRANSFER,
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

/// A kind of map.
pub struct Kind {
    /// Its name for `--what`. File names have `_` for `-`.
    pub name: &'static str,
    /// Its description in --help and the manifest.
    pub about: &'static str,
    /// Its encodings; the first is the default.
    pub encodings: &'static [Encoding],
    /// Its default file formats.
    pub formats: &'static [Format],
    /// GLSL that reads the .ktx2, without the constants of a [`Map`].
    pub decoder: &'static str,
    /// Starts a map of this kind.
    pub begin: fn(&Request) -> Result<Making>,
}

/// The request for a kind.
pub struct Request<'a> {
    pub border: Border,
    pub quality: &'a Quality,
    pub directions: &'a Directions,
    pub angles: Angles,
    /// Outward and inward curvature of the base surface, 1/m.
    pub curvature: Option<[f64; 2]>,
    pub encoding: &'static Encoding,
    /// Whether a .ktx2 is written: its components may hold a smaller range than f32.
    pub has_texels: bool,
    /// Whether the surface has Phong specular.
    pub has_specular: bool,
    /// Of the field.
    pub grid_points: usize,
}

/// The layout of a map in its files.
#[derive(Default)]
pub struct Map {
    /// A plane per value: the channel names of an .exr and the order in an .npy.
    pub planes: Vec<String>,
    /// What the planes hold, in turn; one entry where all hold the same.
    pub values: Vec<Value>,
    /// Whether the .ktx2 is an array: one layer for each group of planes that its encoding packs.
    pub is_array: bool,
    /// GLSL constants that the decoder needs.
    pub constants: Vec<String>,
    /// Columns and rows, where they are not the field's.
    pub size: Option<[usize; 2]>,
    /// Axes of an .npy other than planes, rows and columns: names and counts, the fastest last.
    pub axes: Vec<(&'static str, usize)>,
}

impl Map {
    /// Texels of a plane, for a field of `grid_points` grid points.
    pub fn texels(&self, grid_points: usize) -> usize {
        self.size.map_or(grid_points, |[cols, rows]| cols * rows)
    }
}

/// One value of a texel.
pub struct Value {
    pub name: &'static str,
    pub about: &'static str,
    /// "rad", or empty.
    pub unit: &'static str,
    /// Its least and largest possible value.
    pub range: [f64; 2],
}

/// A kind that is being made.
pub struct Making {
    pub map: Map,
    pub source: Source,
}

/// The input of a kind.
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

/// Plans visibility along directions, for base surfaces of two curvatures (outward and inward,
/// 1/m).
pub type PlanOf = fn(&HeightField, Border, &Directions, Option<[f64; 2]>, &Limits) -> Result<Plan>;

/// A kind that the device computes from visibility along directions.
#[derive(Clone, Copy)]
pub struct OfDirections {
    pub plan: PlanOf,
    /// Bytes per texel that wait for the files.
    pub bytes: fn(&Directions) -> u64,
    /// Writes the files.
    pub take: fn(&DirectionsJob, &mut MapFiles) -> Result<()>,
}

/// Reports progress.
pub type Say<'a> = &'a dyn Fn(String);

/// A kind that is light. It needs several plans.
#[derive(Clone, Copy)]
pub struct OfLight {
    /// The plans, to state their memory.
    pub plans: fn(&Lit, &Limits) -> Result<Vec<Plan>>,
    /// Bytes that it holds until the end.
    pub bytes: fn(&Lit) -> u64,
    /// Writes the files and reports progress.
    pub make: fn(&mut Headless, &Lit, &mut MapFiles, Say) -> Result<()>,
}

/// A whole number among a plan's settings; the plan must have it.
fn number(plan: &Plan, name: &str) -> u32 {
    let of = plan.settings.iter().find(|(known, _)| known == name);
    of.and_then(|(_, value)| value.parse().ok()).expect("plans of scattered light state it")
}

/// What light is computed from.
pub struct Lit<'a> {
    pub scene: &'a Scene,
    pub quality: &'a Quality,
    pub limits: Limits,
    /// Scattered light; none without bounces.
    pub scatter: Option<Scatter>,
    /// Directions in which texels find visible points.
    pub around: &'a Directions,
    /// Of lights and views.
    pub angles: Angles,
    /// Curvatures of the base surface.
    pub curvature: Option<[f64; 2]>,
    /// Light and view pairs between the table's angles.
    pub seed: u32,
    /// The table that `brdf`, `brdf-factors` and `brdf-harmonics` share, made on first use.
    pub table: OnceCell<brdf::Table>,
}

/// The result of a plan.
pub struct DirectionsJob<'a> {
    pub field: &'a HeightField,
    pub border: Border,
    pub directions: &'a Directions,
    pub curvature: Option<[f64; 2]>,
    /// Components of each output, 32 bits each.
    pub outputs: &'a [Vec<f32>],
}

/// Makes a map from the horizons of a circle of azimuths.
pub trait Maker {
    /// Bytes that it holds until the end.
    fn bytes(&self) -> u64;

    /// Takes one azimuth, in circle order: elevations (rad) and unit normals of all texels.
    fn add(
        &mut self,
        ray: Ray,
        elevations_rad: &[f32],
        normals: &[DVec3],
        files: &mut MapFiles,
    ) -> Result<()>;

    /// Writes what remains after the last azimuth.
    fn end(self: Box<Self>, normals: &[DVec3], files: &mut MapFiles) -> Result<()>;
}

/// A kind that is a sum over azimuths.
struct Sums {
    summing: HorizonSums,
    bytes: u64,
}

impl Sums {
    fn begin(what: Box<dyn HorizonMap>, request: &Request, map: Map) -> Making {
        // The sums, and the values computed from them.
        let bytes = HorizonSums::bytes(&*what, request.grid_points)
            + 4 * (what.values() * request.grid_points) as u64;
        let summing = HorizonSums::new(what, request.grid_points);
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
