//! What is run against the twins: small fields of odd sizes, every form of every pass at least once.

mod bounces;
mod points;

use ridgelight::cpu::visible_points::visible_points;
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{
    Albedo, Basis, Border, Directions, Environment, Fuse, HeightField, Hull, KeyLight, Levels,
    LightBasis, Lights, Lines, Lobe, Method, Phong, Precision, Quality, Receiver, Scatter, Scene,
    SphereLight, Sun, Surface, VisiblePoints, Wedges, Window,
};

pub(super) use bounces::{glosses, nodes, throws, walks};
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
                match scatter.own_lobe {
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

    /// What samples see, by the twin.
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
            if let Some(Lobe::Map(map)) = &self.scene.surface.phong {
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

/// A paraboloid, smooth and with nothing hidden: what is thrown has few places where rounding counts.
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
            Quality { hull: Hull::List, fuse: Fuse::Own, ..base },
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
            Quality { hull: Hull::List, fuse: Fuse::Nearest, ..packed },
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
    let brute = Quality { azimuths: 12, method: Method::Brute, ..Quality::default() };
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

/// Everything that sums light: sky, environment, discs and a point; colours and a map, or all grey.
pub(super) fn pictures() -> Vec<Case> {
    let sun = |azimuth_rad, diameter_rad, irradiance| Sun {
        azimuth_rad,
        elevation_rad: 0.4,
        diameter_rad,
        irradiance,
    };
    let quality = Quality { azimuths: 12, table_elevations: 33, ..Quality::default() };
    let colourful = {
        let field = rough(23, 30, 11);
        let mut next = random(12);
        let map = (0..23 * 30).map(|_| [next() as f32, next() as f32, 1.0]).collect();
        let surface =
            Surface { border: Border::Open, albedo: Albedo::Map(map), ..Surface::default() };
        let lights = Lights {
            sky: Some([0.3, 0.5, 0.9]),
            environment: Some(noisy_environment(13)),
            suns: vec![sun(2.0, 0.2, [3.0, 2.5, 2.0])],
            keys: vec![key(-0.4, 0.5, [1.0, 2.0, 0.5])],
            ..Lights::default()
        };
        Scene { field, surface, lights }
    };
    // Of an odd number of rows the middle one lies on both sides of the ground.
    let on_a_plane = {
        let environment = noisy_environment(15);
        let lights = Lights { environment: Some(environment), ..Lights::default() };
        Scene { field: rough(13, 11, 16), surface: Surface::default(), lights }
    };
    let grey = {
        let surface = Surface {
            border: Border::Plane,
            albedo: Albedo::Constant([0.5; 3]),
            ..Surface::default()
        };
        let suns = vec![sun(-1.1, 0.0, [2.0; 3])];
        let keys = vec![key(0.1, 0.3, [2.0; 3])];
        let lights = Lights { sky: Some([1.0; 3]), suns, keys, ..Lights::default() };
        Scene { field: rough(12, 17, 14), surface, lights }
    };
    let ball =
        |x, y, z, radius_m, radiance| SphereLight { position_m: [x, y, z], radius_m, radiance };
    // Over the ground; cut by it, with samples under and inside; beyond the edge.
    let balls = {
        let spheres = vec![
            ball(20.0, 14.0, 920.0, 4.0, [3.0, 2.0, 1.0]),
            ball(9.5, 6.1, 903.0, 5.0, [0.5, 1.0, 2.0]),
            ball(-30.0, 50.0, 890.0, 12.0, [4.0, 0.0, 1.0]),
        ];
        let lights = Lights { sky: Some([0.3, 0.5, 0.9]), spheres, ..Lights::default() };
        Scene { lights, ..colourful.clone() }
    };
    let balls_alone = {
        let spheres =
            vec![ball(7.0, 4.0, 911.0, 2.0, [5.0; 3]), ball(31.0, 9.0, 908.0, 1.0, [2.0; 3])];
        let surface = Surface { border: Border::Periodic, ..Surface::default() };
        let lights = Lights { spheres, ..Lights::default() };
        Scene { field: rough(9, 8, 17), surface, lights }
    };
    let picture = |name, scene, quality, light_layers, sky_view| Case {
        name,
        scene,
        quality,
        wanted: Wanted::Picture(Picture {
            light_layers,
            sky_view,
            keeps_horizons: true,
            ..Picture::default()
        }),
        loses_lines: false,
    };
    let of_device = Case {
        wanted: Wanted::Picture(Picture { colours_on_device: true, ..Picture::default() }),
        ..picture("colours on the device", grey.clone(), quality, false, false)
    };
    let sh = |sh_order| Quality { basis: Basis::Sh, sh_order, ..quality };
    let nlp = Quality { wedges: Wedges::Nlp, receiver: Receiver::Lobe, ..sh(5) };
    let soft = |sh_order, sun_azimuths| Quality {
        light_basis: LightBasis::Sh,
        sh_order,
        sun_azimuths,
        ..quality
    };
    let soft_table = Quality { wedges: Wedges::Table, wedge_side: 17, ..soft(3, 6) };
    let soft_nlp = Quality {
        wedges: Wedges::Nlp,
        receiver: Receiver::Lobe,
        window: Window::Lanczos,
        ..soft(5, 7)
    };
    let soft_levels = Quality {
        method: Method::Pyramid,
        level_step: 3,
        level_offset: 0,
        levels: Levels::Pyramid,
        ..soft(2, 1)
    };
    let soft_stack = Quality {
        wedges: Wedges::Table,
        receiver: Receiver::Lobe,
        levels: Levels::Stack,
        level_step: 2,
        level_offset: 1,
        ..Quality { sun_azimuths: 8, sh_order: 6, ..soft_levels }
    };
    let windowed = Quality { window: Window::Hann, fuse: Fuse::Own, ..sh(4) };
    let lobe = Quality { receiver: Receiver::Lobe, window: Window::Nonnegative, ..sh(2) };
    let subsampled = |subsample, sh_order| Quality { subsample, ..sh(sh_order) };
    let by_table = Quality { wedges: Wedges::Table, method: Method::Brute, ..subsampled(2, 6) };
    let open_wedges = Quality { wedges: Wedges::Table, wedge_side: 9, ..sh(3) };
    let marched = Quality { method: Method::Brute, ..subsampled(4, 4) };
    let smoothed = Quality { method: Method::Pyramid, level_step: 2, ..subsampled(2, 3) };
    // A lobe under all that it mirrors, and under a sky alone.
    let mirrored = {
        let lights = Lights {
            sky: Some([0.3, 0.5, 0.9]),
            environment: Some(noisy_environment(41)),
            suns: vec![sun(2.0, 0.2, [3.0, 2.5, 2.0]), sun(-1.1, 0.0, [2.0; 3])],
            ..Lights::default()
        };
        let surface = Surface {
            border: Border::Plane,
            albedo: Albedo::Constant([0.5; 3]),
            phong: Some(Lobe::Constant(Phong { exponent: 20.0, scale: 0.4 })),
        };
        Scene { field: rough(14, 11, 42), surface, lights }
    };
    let mirrored_sky = {
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let mut next = random(45);
        let map = (0..9 * 14).map(|i| Phong { exponent: (79 * i) as f32, scale: next() as f32 });
        let phong = Some(Lobe::Map(map.collect()));
        let surface = Surface { border: Border::Open, albedo: Albedo::Constant([0.0; 3]), phong };
        Scene { field: rough(9, 14, 43), surface, lights }
    };
    // Twelve columns: the last is no multiple of 4 from the first; of a field that repeats.
    let repeated = {
        let lights = Lights { environment: Some(noisy_environment(17)), ..Lights::default() };
        let surface = Surface { border: Border::Periodic, ..Surface::default() };
        Scene { field: rough(19, 12, 18), surface, lights }
    };
    vec![
        picture("colours", colourful.clone(), quality, true, false),
        picture("environment on a plane", on_a_plane.clone(), quality, false, false),
        of_device,
        picture("grey", grey, Quality { fuse: Fuse::Aimed, ..quality }, false, true),
        picture("balls of light", balls.clone(), quality, true, false),
        picture(
            "balls in one sum",
            balls.clone(),
            Quality { sun_azimuths: 5, ..quality },
            false,
            false,
        ),
        picture("balls by harmonics", balls.clone(), soft(4, 8), true, false),
        picture("balls by harmonics of order 6", balls.clone(), soft(6, 4), false, false),
        picture("balls by a table of wedges", balls.clone(), soft_table, false, false),
        picture("balls by Legendre, periodic", balls_alone.clone(), soft_nlp, false, false),
        picture("balls by a pyramid's levels", balls, soft_levels, false, false),
        picture("balls by a stack, periodic", balls_alone.clone(), soft_stack, true, false),
        picture("balls alone, periodic", balls_alone, quality, false, false),
        picture("harmonics of order 6", on_a_plane.clone(), sh(6), false, false),
        picture("harmonics beside a sky", colourful.clone(), windowed, true, false),
        picture("harmonics by Legendre", colourful.clone(), nlp, false, false),
        picture("harmonics of order 3", on_a_plane.clone(), sh(3), false, true),
        picture(
            "harmonics at every second sample",
            on_a_plane.clone(),
            subsampled(2, 5),
            false,
            false,
        ),
        picture(
            "harmonics at every fourth sample",
            colourful.clone(),
            subsampled(4, 4),
            false,
            false,
        ),
        picture("harmonics by a table of wedges", on_a_plane.clone(), by_table, false, false),
        picture("harmonics by wedges of a sphere", colourful, open_wedges, false, false),
        picture("harmonics of marches from nodes", on_a_plane.clone(), marched, false, false),
        picture("harmonics of a pyramid's nodes", repeated, smoothed, false, false),
        picture("harmonics of order 2", on_a_plane, lobe, false, false),
        picture("a lobe", mirrored, sh(5), true, false),
        picture("a lobe at every second sample", mirrored_sky, subsampled(2, 3), false, false),
    ]
}

/// Every kind of light on an open field, and a field that repeats, with two levels of blocks.
fn of_all_lights() -> [Scene; 2] {
    let sun = |diameter_rad| Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.6,
        diameter_rad,
        irradiance: [1.0, 0.5, 0.2],
    };
    let ball =
        SphereLight { position_m: [9.0, 7.0, 912.0], radius_m: 3.0, radiance: [0.1, 0.4, 2.0] };
    let mut next = random(21);
    let map = (0..7 * 9).map(|_| [0.8 * next() as f32, 0.5, 0.1]).collect();
    let all = Scene {
        field: rough(7, 9, 22),
        surface: Surface { border: Border::Open, albedo: Albedo::Map(map), phong: None },
        lights: Lights {
            sky: Some([0.3, 0.5, 0.9]),
            environment: Some(noisy_environment(23)),
            suns: vec![sun(0.2), sun(0.0)],
            keys: vec![key(-0.4, 0.5, [1.0, 0.3, 0.0]), key(0.9, 1.2, [0.0, 0.4, 2.0])],
            spheres: vec![ball],
        },
    };
    let repeated = Scene {
        field: rough(6, 10, 24),
        surface: Surface {
            border: Border::Periodic,
            albedo: Albedo::Constant([0.6, 0.3, 0.9]),
            phong: None,
        },
        lights: Lights {
            sky: Some([1.0; 3]),
            suns: vec![sun(0.3)],
            keys: vec![key(-0.4, 0.5, [1.0, 0.3, 2.0])],
            ..Lights::default()
        },
    };
    [all, repeated]
}

fn reference(name: &'static str, scene: Scene, wanted: Wanted) -> Case {
    Case { name, scene, quality: Quality::default(), wanted, loses_lines: false }
}

fn with_lobes(mut scene: Scene) -> Scene {
    let lobe = |i: usize| Phong { exponent: (i % 12) as f32, scale: (i % 3) as f32 * 0.05 };
    let count = scene.field.heights_m().len();
    scene.surface.phong = Some(Lobe::Map((0..count).map(lobe).collect()));
    scene
}

/// Light paths that the quadrature knows: every kind of light, a lobe and a map; a field that repeats.
pub(super) fn references() -> Vec<Case> {
    let [all, repeated] = of_all_lights();
    // The quadrature knows of no lobes that are met.
    let lobes = with_lobes(all.clone());
    vec![
        reference("all lights", all, Wanted::Reference(1)),
        reference("lobes in all lights", lobes, Wanted::Reference(0)),
        reference("periodic", repeated, Wanted::Reference(2)),
    ]
}

/// Light paths that nothing else knows: lobes that are met; batches in parts, by paths and by lights; a list of samples; ground
/// that goes on level; a line.
pub(super) fn paths() -> Vec<Case> {
    let [all, repeated] = of_all_lights();
    let on = |field, border, lights: &Lights| Scene {
        field,
        surface: Surface { border, albedo: Albedo::Constant([0.7, 0.4, 0.2]), phong: None },
        lights: lights.clone(),
    };
    let level = on(rough(17, 13, 25), Border::Plane, &all.lights);
    let line = on(rough(1, 11, 26), Border::Plane, &repeated.lights);
    let mut many = on(rough(5, 4, 27), Border::Open, &Lights::default());
    many.lights.suns = (0..40)
        .map(|i| Sun {
            azimuth_rad: 0.1 + 0.7 * f64::from(i),
            elevation_rad: 0.1 + 0.03 * f64::from(i),
            diameter_rad: 0.01,
            irradiance: [0.01, 0.02, 0.03],
        })
        .collect();
    let mut glossy = with_lobes(level.clone());
    glossy.surface.phong = Some(Lobe::Constant(Phong { exponent: 100.0, scale: 0.05 }));
    vec![
        reference("lobes that are met", with_lobes(all.clone()), Wanted::Reference(1)),
        reference("lobes that repeat", with_lobes(repeated.clone()), Wanted::Reference(1)),
        reference("a sharp lobe on a plane", glossy, Wanted::Reference(1)),
        reference("bounced light of a list", all, Wanted::ReferenceAt(1, 40)),
        reference("many suns", many, Wanted::Reference(1)),
        reference("on a plane", level, Wanted::Reference(2)),
        reference("a line", line, Wanted::Reference(1)),
    ]
}
