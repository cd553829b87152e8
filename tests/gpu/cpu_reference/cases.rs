//! What is run against the CPU reference: small fields of odd sizes, every form of every pass at least once.

mod bounces;
mod paths;
mod pictures;
mod points;

use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{
    Albedo, Border, Directions, Environment, Fuse, HeightField, Hull, KeyLight, Levels, Lights,
    Lines, Method, Precision, Quality, Scatter, Scene, Specular, Surface, VisiblePoints,
};
use ridgelight_cpu::visible_points::visible_points;

pub(super) use bounces::{bounced_light, nodes, specular, walks};
pub(super) use paths::{paths, references};
pub(super) use pictures::pictures;
pub(super) use points::{ellipses, facets, points, scatters, towards};

use crate::{field, random};

/// Of what lobes scatter towards several.
const VIEWS: [glam::DVec3; 2] = [glam::DVec3::Z, glam::DVec3::new(0.6, 0.0, 0.8)];

pub(super) enum Wanted {
    Horizons {
        distances: bool,
    },
    Picture(Picture),
    /// Bounces.
    Reference(u32),
    /// Bounces; bounced light alone of so many samples.
    ReferenceAt(u32, usize),
    Points(Directions),
    Ellipses(Directions),
    Facets(Directions),
    /// Of five bases.
    CurvedEllipses(Directions, [f64; 2]),
    /// Whether images hold no more than two layers.
    Scatter(Directions, Scatter, bool),
}

pub(super) struct Case {
    pub name: &'static str,
    pub scene: Scene,
    pub quality: Quality,
    pub wanted: Wanted,
    /// Whether some hull is deeper than the memory that it is kept in.
    pub loses_lines: bool,
}

impl Case {
    pub fn plan(&self, limits: &Limits) -> Plan {
        match &self.wanted {
            Wanted::Horizons { distances } => plan::horizons(
                &self.scene.field,
                self.scene.surface.border,
                &self.quality,
                limits,
                (0, self.quality.azimuths),
                *distances,
            ),
            Wanted::Picture(wanted) => plan::picture(&self.scene, &self.quality, limits, *wanted),
            Wanted::Reference(bounces) => plan::reference(&self.scene, *bounces, 1, limits),
            Wanted::ReferenceAt(bounces, count) => {
                plan::reference_at(&self.scene, *bounces, 1, *count, limits)
            }
            Wanted::Points(directions) => plan::visible_points(
                &self.scene.field,
                self.scene.surface.border,
                directions,
                limits,
            ),
            Wanted::Ellipses(directions) => {
                plan::ellipses(&self.scene.field, self.scene.surface.border, directions, limits)
            }
            Wanted::Facets(directions) => {
                plan::facet_mask(&self.scene.field, self.scene.surface.border, directions, limits)
            }
            Wanted::CurvedEllipses(directions, per_m) => {
                let (field, border) = (&self.scene.field, self.scene.surface.border);
                plan::curved_ellipses(field, border, directions, *per_m, limits)
            }
            Wanted::Scatter(directions, scatter, is_cut) => {
                let image_layers = if *is_cut { 2 } else { limits.image_layers };
                let limits = Limits { image_layers, ..*limits };
                match scatter.direct_specular {
                    true => plan::scatter_views(&self.scene, directions, scatter, &VIEWS, &limits),
                    false => plan::scatter(&self.scene, directions, scatter, &limits),
                }
            }
        }
        .expect("a plan")
    }

    pub fn directions(&self) -> Option<Directions> {
        match &self.wanted {
            Wanted::Points(directions)
            | Wanted::Ellipses(directions)
            | Wanted::Facets(directions)
            | Wanted::CurvedEllipses(directions, _) => Some(directions.clone()),
            Wanted::Scatter(..) => {
                let e = self.scene.lights.suns.iter().map(towards).collect();
                Directions::from_vectors(e, -1.0).ok()
            }
            _ => None,
        }
    }

    /// Samples of a list: every third from the last on, some twice.
    pub fn listed(&self) -> Option<Vec<usize>> {
        let Wanted::ReferenceAt(_, count) = self.wanted else { return None };
        let all = self.scene.field.heights_m().len();
        Some((1..=count).map(|i| (3 * all - 3 * i) % all).collect())
    }

    /// What samples see, by the CPU reference.
    pub fn points(&self) -> Option<VisiblePoints> {
        let Wanted::Scatter(directions, ..) = &self.wanted else { return None };
        let (field, border) = (&self.scene.field, self.scene.surface.border);
        let seen = visible_points(field, border, directions);
        let points = VisiblePoints::from_points(field, border, directions.clone(), &seen);
        Some(points.expect("points of the field"))
    }

    /// Texels of the plan's inputs, in its order.
    pub fn contents(&self) -> Vec<Vec<f32>> {
        if let Wanted::Reference(_) | Wanted::ReferenceAt(..) = self.wanted {
            let list = self.listed().map(|list| plan::listed_places(&self.scene, &list));
            let mut all = plan::reference_inputs(&self.scene);
            all.extend(list.map(|texels| texels.expect("of the field")));
            return all;
        }
        if let Wanted::Scatter(..) = self.wanted {
            let mut next = random(71);
            let samples = self.scene.field.heights_m().len();
            let direct: Vec<_> = (0..samples).map(|_| [next() as f32, 1.0, 0.2]).collect();
            let (plan, points) = (self.plan(&Limits::lavapipe()), self.points().expect("points"));
            return plan::scatter_inputs(&plan, &self.scene, &points, &direct).expect("inputs");
        }
        let mut all = vec![self.scene.field.heights_m().to_vec()];
        if let Wanted::Picture(_) = self.wanted {
            let four = |texels: &[[f32; 3]]| -> Vec<f32> {
                texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect()
            };
            all.extend(self.scene.lights.environment.as_ref().map(|e| four(e.texels())));
            if let Albedo::Map(map) = &self.scene.surface.albedo {
                all.push(four(map));
            }
            if let Some(Specular::Map(map)) = &self.scene.surface.specular {
                all.push(map.iter().flat_map(|p| [p.exponent, p.scale, 0.0, 1.0]).collect());
            }
        }
        if let Wanted::Picture(Picture { colours_on_device: true, .. }) = self.wanted {
            let Lights { sky, suns, keys, .. } = &self.scene.lights;
            let (mut next, count) =
                (random(73), usize::from(sky.is_some()) + suns.len() + keys.len());
            all.push((0..4 * count).map(|_| 3.0 * next() as f32).collect());
        }
        all
    }
}

/// Heights without two alike, so that no tie hides a wrong choice, over a few cells.
fn rough(rows: usize, cols: usize, seed: u64) -> HeightField {
    let mut next = random(seed);
    let noise: Vec<f64> = (0..rows * cols).map(|_| next()).collect();
    field(rows, cols, [3.0, 2.0], |r, c| 900.0 + 7.0 * noise[r * cols + c])
}

/// A paraboloid, smooth and with nothing hidden: few of its bounces hang on rounding.
fn bowl(side: usize) -> HeightField {
    let middle = (side / 2) as f64;
    field(side, side, [1.0, 1.0], |r, c| {
        0.06 * ((r as f64 - middle).powi(2) + (c as f64 - middle).powi(2))
    })
}

/// A dome, whose samples all stay on the hull, before a cliff that pops them: deeper than the 64
/// entries that a line keeps in shared memory.
fn dome(rows: usize, cols: usize) -> HeightField {
    let middle = cols as f64 / 2.0;
    field(rows, cols, [1.0, 1.0], |r, c| {
        let x = (c as f64 - middle) / middle;
        let cliff = if c + 6 > cols { 9.0 * (c + 6 - cols) as f64 } else { 0.0 };
        (2.0 - x * x).sqrt() * middle + cliff + 0.25 * (r % 3) as f64
    })
}

fn horizons(
    name: &'static str,
    field: HeightField,
    border: Border,
    quality: Quality,
    distances: bool,
) -> Case {
    let surface = Surface { border, ..Surface::default() };
    let scene = Scene { field, surface, lights: Lights::default() };
    Case { name, scene, quality, wanted: Wanted::Horizons { distances }, loses_lines: false }
}

/// `horizon_sweep`: three places of the hull, both kinds of entries, both kinds of slopes, all fuses.
pub(super) fn sweeps() -> Vec<Case> {
    let base = Quality { azimuths: 12, ..Quality::default() };
    let packed = Quality { precision: Precision::Packed, ..base };
    let shared_slopes = Quality { hull: Hull::Shared, fuse: Fuse::Slopes, ..base };
    vec![
        horizons("private f32", rough(37, 23, 1), Border::Plane, base, true),
        Case {
            loses_lines: true,
            ..horizons("shared f32", dome(13, 97), Border::Plane, shared_slopes, false)
        },
        horizons(
            "list f32",
            rough(18, 31, 2),
            Border::Periodic,
            Quality { hull: Hull::OccluderList, fuse: Fuse::Own, ..base },
            false,
        ),
        horizons(
            "private packed",
            rough(21, 26, 3),
            Border::Open,
            Quality { lines: Lines::HalfCell, fuse: Fuse::Aimed, ..packed },
            true,
        ),
        horizons(
            "shared packed",
            rough(29, 19, 4),
            Border::Plane,
            // Between lines two cells apart, every second sample is equally near to both.
            Quality { hull: Hull::Shared, lines: Lines::TwoCells, fuse: Fuse::Nearest, ..packed },
            false,
        ),
        horizons(
            "list packed",
            rough(14, 33, 5),
            Border::Plane,
            Quality { hull: Hull::OccluderList, fuse: Fuse::Nearest, ..packed },
            false,
        ),
        horizons(
            "aimed around",
            rough(23, 30, 7),
            Border::Plane,
            Quality { fuse: Fuse::AimedAround, ..base },
            true,
        ),
        horizons(
            "aimed around, periodic",
            rough(14, 16, 8),
            Border::Periodic,
            Quality { lines: Lines::TwoCells, fuse: Fuse::AimedAround, ..base },
            true,
        ),
        horizons(
            "private f32, slopes f16",
            rough(25, 34, 6),
            Border::Open,
            Quality {
                lines: Lines::TwoCells,
                fuse: Fuse::Slopes,
                precision: Precision::F16,
                ..base
            },
            false,
        ),
    ]
}

/// `surface_sweep` and `horizon_march`: one value a sample, with what is met.
pub(super) fn samples() -> Vec<Case> {
    let exact = Quality { azimuths: 12, lines: Lines::Exact, ..Quality::default() };
    let brute = Quality { azimuths: 12, method: Method::BruteForce, ..Quality::default() };
    vec![
        horizons("exact", rough(17, 22, 7), Border::Plane, exact, true),
        horizons("exact, periodic", rough(9, 10, 8), Border::Periodic, exact, true),
        horizons("brute", rough(19, 14, 9), Border::Open, brute, true),
        horizons("brute, periodic", rough(10, 9, 10), Border::Periodic, brute, true),
    ]
}

/// The passes of a height pyramid: both stores, all borders, few and many levels an octave, and fields
/// with one sample across, few of them, or no level but themselves.
pub(super) fn pyramids() -> Vec<Case> {
    let base = Quality { azimuths: 12, method: Method::Pyramid, ..Quality::default() };
    let looks =
        |levels, level_step, level_offset| Quality { levels, level_step, level_offset, ..base };
    let on = |name, field, border, quality| horizons(name, field, border, quality, false);
    use Levels::{Pyramid, Stack};
    vec![
        on("stack", rough(37, 23, 31), Border::Plane, looks(Stack, 3, 0)),
        on("stack, periodic", rough(11, 14, 32), Border::Periodic, looks(Stack, 2, 1)),
        on("levels", rough(23, 41, 33), Border::Open, looks(Pyramid, 4, 1)),
        on("levels, periodic", rough(13, 9, 34), Border::Periodic, looks(Pyramid, 5, 0)),
        on("levels, 16 an octave", rough(17, 31, 35), Border::Plane, looks(Pyramid, 16, 0)),
        on("levels, one sample across", rough(1, 29, 36), Border::Plane, looks(Pyramid, 1, 0)),
        on(
            "stack of a column that repeats",
            rough(23, 1, 37),
            Border::Periodic,
            looks(Stack, 1, 0),
        ),
        on("the field alone", rough(2, 3, 38), Border::Plane, looks(Stack, 4, 2)),
        on("one sample", rough(1, 1, 39), Border::Open, looks(Stack, 1, 0)),
    ]
}

fn noisy_environment(seed: u64) -> Environment {
    let mut next = random(seed);
    let texels = (0..18 * 9).map(|i| {
        let peak = if i == 40 { 30.0 } else { 0.0 };
        [next() as f32, next() as f32 + peak, 0.5]
    });
    Environment::new(18, 9, texels.collect(), 0.7).expect("an environment")
}

/// Across both axes of a field.
fn key(low: f64, high: f64, radiance: [f32; 3]) -> KeyLight {
    KeyLight { azimuth_rad: 2.6, width_rad: 1.7, elevations_rad: [low, high], radiance }
}
