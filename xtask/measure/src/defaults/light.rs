//! The lights under which the default is compared, and horizons without light: settings, exact results and goals.

use std::path::Path;

use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan;
use ridgelight::scene::{
    Border, BounceEngine, Bounces, Fuse, HeightField, KeyLight, Lights, Lines, Method, Quality,
    Scene,
};
use ridgelight::{Error, Result};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_trade::error::HorizonError;

use super::Errors;
use crate::common::frames::{Colours, colours, drawn, error, exact_light, frame};
use crate::common::inputs;
use crate::common::terrains::Ground;

/// Of a folder's `env/`: a low sun.
pub const LOW_SUN: &str = "spiaggia_di_mondello_1k.hdr";
/// Slices of a key light's exact result over those of the default.
pub const FINER: u32 = 8;
/// Azimuths of the exact result of a sky or an environment, and fewer with border `periodic`, where brute force is slowest. At
/// least twice those of every setting compared.
pub const FINE_AZIMUTHS: u32 = 256;
pub const PERIODIC_AZIMUTHS: u32 = 128;
/// Grid points whose horizons by `--lines exact` are compared with the oracle.
pub const PICKS: usize = 256;
/// Turns of most settings, and of those that take about ten times as long as the default or longer.
pub const TURNS: usize = 7;
const FEW_TURNS: usize = 1;
/// Bounces, the albedo of the ground under them, and azimuths of the exact ones.
pub const BOUNCES: u32 = 3;
pub const BOUNCED_ALBEDO: f32 = 0.5;
pub const FINE_BOUNCE_AZIMUTHS: u32 = 64;

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Sky,
    Environment,
    Key,
    /// Direct and indirect light.
    Bounces,
    /// Horizons alone, without light.
    Horizons,
}

impl Kind {
    /// The most that the default's errors may be.
    pub fn goal(self, ground: Ground) -> Errors {
        match (self, ground) {
            (Self::Sky, Ground::Steeper) => [0.25, 0.0],
            (Self::Sky, _) => [0.1, 0.0],
            (Self::Environment, _) => [0.7, 0.0],
            (Self::Key, _) => [0.3, 0.0],
            (Self::Bounces, _) => [0.5, 0.0],
            (Self::Horizons, _) => [0.05, 2.0],
        }
    }
}

/// Settings by their flags.
pub struct Mode {
    pub flags: &'static str,
    pub quality: Quality,
    pub turns: usize,
}

pub struct Light {
    pub name: &'static str,
    pub kind: Kind,
    pub lights: Lights,
}

/// A patch of radiance 1 with its centre 35° south of west; degrees.
fn key(name: &'static str, width: f64, elevations: [f64; 2]) -> Light {
    let key = KeyLight {
        azimuth_rad: 215_f64.to_radians(),
        width_rad: width.to_radians(),
        elevations_rad: elevations.map(f64::to_radians),
        radiance: [1.0; 3],
    };
    Light { name, kind: Kind::Key, lights: Lights { keys: vec![key], ..Lights::default() } }
}

/// The same for bounces, with every border.
fn of_bounces() -> Vec<Mode> {
    let mode = |flags, turns, subsample, bounces: Bounces| {
        let bounces = Bounces { count: BOUNCES, ..bounces };
        Mode { flags, quality: Quality { subsample, bounces, ..Quality::default() }, turns }
    };
    let default = Bounces::default();
    let of = |azimuths| Bounces { azimuths, ..default };
    let by = |engine| Bounces { engine, ..default };
    let own = Quality::default().subsample;
    vec![
        mode("default", TURNS, own, default),
        mode("--subsample 2", TURNS, 2, default),
        mode("--subsample 4", TURNS, 4, default),
        mode("--bounce-azimuths 8", TURNS, own, of(8)),
        mode("--bounce-azimuths 12", TURNS, own, of(12)),
        mode("--bounce-azimuths 32", TURNS, own, of(32)),
        mode("--bounce-azimuths 64", TURNS, own, of(64)),
        mode("--subsample 2 --bounce-azimuths 32", TURNS, 2, of(32)),
        mode(
            "--subsample 2 --bounce-engine brute-force",
            FEW_TURNS,
            2,
            by(BounceEngine::BruteForce),
        ),
        mode("--bounce-engine brute-force", FEW_TURNS, own, by(BounceEngine::BruteForce)),
    ]
}

/// The default, which is first, and the settings that it is compared with. With border `plane` these are all. The other borders
/// have those that may be faster, and the other fuses.
pub fn modes(kind: Kind, border: Border) -> Vec<Mode> {
    let default = Quality::default();
    let swept = |flags, quality| Mode { flags, quality, turns: TURNS };
    let slow = |flags, quality| Mode { flags, quality, turns: FEW_TURNS };
    if kind == Kind::Bounces {
        return of_bounces();
    }
    // A key light has slices of its own in place of azimuths. Fewer or more horizons are another output.
    let [fewer, more] = match kind {
        Kind::Key => [
            Some(swept("--sun-azimuths 4", Quality { sun_azimuths: 4, ..default })),
            Some(swept("--sun-azimuths 16", Quality { sun_azimuths: 16, ..default })),
        ],
        Kind::Sky | Kind::Environment => [
            Some(swept("--azimuths 16", Quality { azimuths: 16, ..default })),
            Some(swept("--azimuths 64", Quality { azimuths: 64, ..default })),
        ],
        Kind::Bounces | Kind::Horizons => [None, None],
    };
    let nearest = Quality { fuse: Fuse::AimedNearest, ..default };
    let mut all = vec![
        swept("default", default),
        swept("--fuse aimed-nearest", nearest),
        swept("--fuse aimed", Quality { fuse: Fuse::Aimed, ..default }),
        swept("--lines 2", Quality { lines: Lines::TwoCells, ..default }),
    ];
    if matches!(kind, Kind::Sky | Kind::Environment) {
        all.push(swept("--fuse aimed-nearest --azimuths 64", Quality { azimuths: 64, ..nearest }));
    }
    all.extend(fewer);
    if border != Border::Plane {
        return all;
    }
    all.extend([
        swept("--lines 1/2", Quality { lines: Lines::HalfCell, ..default }),
        slow("--method brute-force", Quality { method: Method::BruteForce, ..default }),
    ]);
    all.extend(more);
    // Slices of a key light follow no grid vectors, so `--lines exact` refuses it.
    if kind != Kind::Key {
        all.push(slow("--lines exact", Quality { lines: Lines::Exact, ..default }));
    }
    all
}

/// All lights; the second environment only with a folder.
pub fn all(folder: Option<&Path>) -> Result<Vec<Light>> {
    let under = |name, environment| {
        let lights = Lights { environment: Some(environment), ..Lights::default() };
        Light { name, kind: Kind::Environment, lights }
    };
    let sky = || Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let suns = vec![inputs::sun(135.0, 20.0, [3.0; 3])];
    let low_sun = Lights { suns, sky: Some([0.1; 3]), ..Lights::default() };
    let mut all = vec![
        Light { name: "sky", kind: Kind::Sky, lights: sky() },
        under("bundled environment", inputs::sky(0.0)?),
    ];
    if let Some(folder) = folder {
        all.push(under("environment with a low sun", inputs::environment_of(folder, LOW_SUN)?));
    }
    all.extend([
        key("key light 4° wide, 20° to 30° high", 4.0, [20.0, 30.0]),
        key("key light 50° wide, 4° to 16° high", 50.0, [4.0, 16.0]),
        Light { name: "sky and bounces", kind: Kind::Bounces, lights: sky() },
        Light { name: "low sun, sky and bounces", kind: Kind::Bounces, lights: low_sun },
        Light { name: "horizons", kind: Kind::Horizons, lights: Lights::default() },
    ]);
    Ok(all)
}

/// Exact results, NaN at voids.
pub enum Exact {
    Light(Colours),
    /// Elevations in even azimuths, whose number is a multiple of that of every setting.
    Horizons(Vec<f32>),
}

impl Light {
    /// A frame of all light, or of all horizons.
    pub fn frame(&self, gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Frame> {
        if self.kind != Kind::Horizons {
            return frame(gpu, scene, quality);
        }
        let Scene { field, surface, .. } = scene;
        let (limits, azimuths) = (gpu.report().limits, (0, quality.azimuths));
        let plan = plan::horizons(field, surface.border, quality, &limits, azimuths, false)?;
        gpu.frame(plan, &[field.heights_m()])
    }

    /// By brute force. For light it has more azimuths, table elevations or slices than any of `modes`, so that their errors include
    /// those of few azimuths.
    pub fn exact(&self, gpu: &mut Headless, scene: &Scene, modes: &[Mode]) -> Result<Exact> {
        let exact = Quality { method: Method::BruteForce, ..Quality::default() };
        Ok(match self.kind {
            Kind::Sky | Kind::Environment => {
                let is_periodic = scene.surface.border == Border::Periodic;
                let azimuths = if is_periodic { PERIODIC_AZIMUTHS } else { FINE_AZIMUTHS };
                Exact::Light(exact_light(gpu, scene, azimuths)?)
            }
            Kind::Bounces => {
                let engine = BounceEngine::BruteForce;
                let azimuths = FINE_BOUNCE_AZIMUTHS;
                let bounces =
                    Bounces { count: BOUNCES, engine, azimuths, cutoff: 0.0, ..Bounces::default() };
                let finer = Quality { azimuths: FINE_AZIMUTHS, subsample: 1, bounces, ..exact };
                Exact::Light(drawn(gpu, scene, &finer, 0)?.light)
            }
            Kind::Key => {
                let finer = Quality { sun_azimuths: FINER * exact.sun_azimuths, ..exact };
                Exact::Light(drawn(gpu, scene, &finer, 0)?.light)
            }
            Kind::Horizons => {
                let all = modes.iter().map(|mode| mode.quality.azimuths);
                let azimuths = all.max().unwrap_or(exact.azimuths);
                let finest = Quality { azimuths, ..exact };
                let mut frame = self.frame(gpu, scene, &finest)?;
                gpu.draw(&mut frame)?;
                let mut elevations = gpu.pixels(&frame, 0)?.values;
                gpu.end(frame);
                if let Some(voids) = scene.field.voids() {
                    let marks = voids.iter().cycle();
                    elevations.iter_mut().zip(marks).filter(|v| *v.1).for_each(|v| *v.0 = f32::NAN);
                }
                Exact::Horizons(elevations)
            }
        })
    }
}

impl Exact {
    /// Exact results are NaN at voids and nowhere else: the errors must not leave out anything else.
    fn check_voids(&self, voids: &[bool]) -> Result<()> {
        let is_void = |i: usize| voids.get(i % voids.len().max(1)) == Some(&true);
        let marks: Vec<bool> = match self {
            Self::Light(light) => light.iter().map(|t| t.iter().any(|v| v.is_nan())).collect(),
            Self::Horizons(elevations) => elevations.iter().map(|e| e.is_nan()).collect(),
        };
        let wrong = marks.iter().enumerate().find(|(i, is_nan)| **is_nan != is_void(*i));
        match wrong {
            None => Ok(()),
            Some((i, _)) => Err(Error::Device {
                doing: "drawing exact results".into(),
                reason: format!("value {i} is wrong: expected NaN at voids, numbers elsewhere"),
            }),
        }
    }

    /// Errors of a frame that was drawn with some settings, outside voids.
    pub fn errors(
        &self,
        gpu: &mut Headless,
        (scene, quality): (&Scene, &Quality),
        frame: &Frame,
    ) -> Result<Errors> {
        let found = gpu.pixels(frame, 0)?;
        // Errors leave out pairs with NaN, which only the exact results have, at voids.
        if let Some(i) = found.values.iter().position(|v| v.is_nan()) {
            return Err(Error::Device {
                doing: "comparing with exact results".into(),
                reason: format!("value {i} of {} is NaN, expected numbers", found.name),
            });
        }
        self.check_voids(scene.field.voids().unwrap_or_default())?;
        let elevations = match self {
            Self::Light(exact) => return Ok([error(&colours(&found), exact)?, 0.0]),
            Self::Horizons(elevations) => elevations,
        };
        let Scene { field, surface, .. } = scene;
        let (rows, cols) = (field.rows(), field.cols());
        let degrees = if quality.lines == Lines::Exact {
            let oracle = Oracle::new(field, surface.border);
            let azimuths = plan::circle_rad(quality, field.cell_m())?;
            at_picks(&oracle, &azimuths, &found.values, field)?
        } else {
            // Azimuth k of M is azimuth k · N / M of all N.
            let step = elevations.len() / (rows * cols) / quality.azimuths as usize;
            let own = elevations.chunks_exact(rows * cols).step_by(step);
            let own: Vec<f32> = own.flatten().copied().collect();
            HorizonError::of(&found.values, &own, rows, cols)?
        };
        Ok([degrees.mean_deg, degrees.p999_deg])
    }
}

/// Errors of elevations against the oracle: `--lines exact` has azimuths along grid vectors, in which there is no brute force.
fn at_picks(
    oracle: &Oracle,
    azimuths: &[f64],
    elevations: &[f32],
    field: &HeightField,
) -> Result<HorizonError> {
    let (plane, cols) = (field.rows() * field.cols(), field.cols());
    let is_void = |pick: &usize| field.voids().is_some_and(|v| v[*pick]);
    let places = (1..).map(|k| inputs::spread(k, plane));
    let picks: Vec<usize> = places.filter(|p| !is_void(p)).take(PICKS).collect();
    let (mut found, mut exact) = (Vec::new(), Vec::new());
    for (layer, phi) in azimuths.iter().enumerate() {
        for pick in &picks {
            found.push(elevations[layer * plane + pick]);
            exact.push(oracle.elevation_rad(pick / cols, pick % cols, *phi));
        }
    }
    HorizonError::of(&found, &exact, 1, picks.len())
}
