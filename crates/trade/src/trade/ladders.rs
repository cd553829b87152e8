//! The settings that trade speed for accuracy, each as a ladder from fast to slow. To add a method
//! or a setting, add its ladder in [`ladders`]; search, frontier and report know none by name.
//!
//! Hull storage has no ladder: it costs time and never changes the result.

use ridgelight::scene::{
    Basis, BounceEngine, BounceSpecular, Fuse, LightBasis, Lights, Lines, Method, Precision,
    Quality, Scene, Values, setting,
};
use std::ops::RangeInclusive;

/// One setting, or two that exclude each other, and the values to search.
#[derive(Clone, Debug)]
pub struct Ladder {
    /// Name of the setting.
    pub name: &'static str,
    /// Its values as settings, "`lines 1`", from fast to slow.
    pub steps: Vec<String>,
    /// The range of a count, of which the steps are a few values; none for a choice, whose steps
    /// are complete.
    pub range: Option<RangeInclusive<u32>>,
    /// Index of the default step.
    pub default: usize,
    /// What the slower end buys.
    pub slower: &'static str,
    /// Applies a step to a quality.
    set: fn(&mut Quality, usize),
    /// Whether it has no effect beside the other settings.
    idle: fn(&Quality) -> bool,
}

const AZIMUTHS: [u32; 6] = [8, 16, 32, 64, 128, 256];
const SUN_AZIMUTHS: [u32; 6] = [1, 2, 4, 8, 16, 32];
const TABLE_ELEVATIONS: [u32; 6] = [32, 64, 128, 256, 512, 1024];
const SH_ORDERS: [u32; 5] = [2, 3, 4, 5, 6];
const SUBSAMPLES: [u32; 3] = [4, 2, 1];
const LINES: [(Lines, &str); 6] = [
    (Lines::FourCells, "4"),
    (Lines::TwoCells, "2"),
    (Lines::Cell, "1"),
    (Lines::HalfCell, "1/2"),
    (Lines::QuarterCell, "1/4"),
    (Lines::Exact, "exact"),
];
const FUSES: [Fuse; 6] =
    [Fuse::Nearest, Fuse::Slopes, Fuse::Own, Fuse::AimedNearest, Fuse::Aimed, Fuse::AimedAround];
const LIGHT_BASES: [LightBasis; 2] = [LightBasis::Sh, LightBasis::Exact];
const PRECISIONS: [Precision; 3] = [Precision::Packed, Precision::F16, Precision::F32];

const BOUNCE_ENGINES: [BounceEngine; 3] =
    [BounceEngine::Pyramid, BounceEngine::Auto, BounceEngine::BruteForce];
const BOUNCE_SPECULARS: [BounceSpecular; 3] =
    [BounceSpecular::Scalar, BounceSpecular::VectorF16, BounceSpecular::Vector];
const BOUNCE_AZIMUTHS: [u32; 4] = [8, 16, 32, 64];
const LEVEL_STEPS: [u32; 5] = [1, 2, 4, 8, 16];
const LEVEL_OFFSETS: [u32; 5] = [0, 1, 2, 3, 4];

/// The range of a setting that counts.
fn range(name: &str) -> Option<RangeInclusive<u32>> {
    match &setting(name)?.values {
        Values::Whole(range) => Some(range.clone()),
        _ => None,
    }
}

fn has_no_lines(quality: &Quality) -> bool {
    matches!(quality.method, Method::BruteForce | Method::Pyramid) || quality.lines == Lines::Exact
}

fn has_no_levels(quality: &Quality) -> bool {
    quality.method != Method::Pyramid
}

/// Whether some lights are integrated in slices: suns that are not points, key lights, sphere lights.
pub(crate) fn have_slices(lights: &Lights) -> bool {
    let have_others = !lights.keys.is_empty() || !lights.sphere_lights.is_empty();
    have_others || lights.suns.iter().any(|s| !s.is_point())
}

/// The lights with radiance above 0: for others no setting changes anything.
fn nonzero_lights(lights: &Lights) -> Lights {
    let is_lit = |c: &[f32; 3]| c.iter().any(|v| *v > 0.0);
    let mut kept = lights.clone();
    kept.sky = lights.sky.filter(is_lit);
    kept.suns.retain(|sun| is_lit(&sun.irradiance));
    kept.keys.retain(|key| is_lit(&key.radiance));
    kept.sphere_lights.retain(|light| is_lit(&light.radiance));
    kept
}

/// Whether the surface has Phong specular.
fn has_specular(scene: &Scene) -> bool {
    scene.surface.specular.as_ref().is_some_and(|specular| specular.largest().scale > 0.0)
}

/// The ladders that affect a scene with this many bounces: no azimuths without a sky, no table
/// without an environment. Phong specular is lit by harmonics only; its bounces use pyramids only,
/// at every texel.
pub fn ladders(scene: &Scene, bounces: u32) -> Vec<Ladder> {
    let (lights, has_specular) = (&nonzero_lights(&scene.lights), has_specular(scene));
    let spell =
        |setting: &str, values: &[u32]| values.iter().map(|v| format!("`{setting} {v}`")).collect();
    let mut all = vec![
        Ladder {
            name: "sweep",
            steps: LINES
                .iter()
                .map(|(_, name)| format!("`lines {name}`"))
                .chain(["pyramid", "brute-force"].map(|method| format!("`method {method}`")))
                .collect(),
            range: None,
            default: 0,
            slower: "closer lines, then every grid point on a line: small occluders; a pyramid of heights, \
                     slower only; brute force",
            set: |quality, step| match LINES.get(step) {
                Some((lines, _)) => (quality.method, quality.lines) = (Method::Sweep, *lines),
                None if step == LINES.len() => quality.method = Method::Pyramid,
                None => quality.method = Method::BruteForce,
            },
            idle: |_| false,
        },
        Ladder {
            name: "fuse",
            steps: FUSES.iter().map(|f| format!("`fuse {}`", f.name())).collect(),
            range: None,
            default: 0,
            slower: "more of the lines' results, then the surface itself, then all around there: horizons of each \
                     grid point",
            set: |quality, step| quality.fuse = FUSES[step],
            idle: has_no_lines,
        },
        Ladder {
            name: "precision",
            steps: PRECISIONS.iter().map(|p| format!("`precision {}`", p.name())).collect(),
            range: None,
            default: 0,
            slower: "more bits: heights on the hull, stored slopes",
            set: |quality, step| quality.precision = PRECISIONS[step],
            idle: has_no_lines,
        },
        Ladder {
            name: "level step",
            steps: spell("level_step", &LEVEL_STEPS),
            range: range("level_step"),
            default: 0,
            slower: "more levels of a pyramid: occluders between two grid points",
            set: |quality, step| quality.level_step = LEVEL_STEPS[step],
            idle: has_no_levels,
        },
        Ladder {
            name: "level offset",
            steps: spell("level_offset", &LEVEL_OFFSETS),
            range: range("level_offset"),
            default: 0,
            slower: "finer levels of a pyramid: sharp distant horizons",
            set: |quality, step| quality.level_offset = LEVEL_OFFSETS[step],
            idle: has_no_levels,
        },
    ];
    // Sphere lights compute their own visibility.
    let are_none_aimed = lights.suns.is_empty() && lights.keys.is_empty();
    if lights.sky.is_none() && lights.environment.is_none() && are_none_aimed {
        all.clear();
    }
    if lights.sky.is_some() || lights.environment.is_some() {
        all.push(Ladder {
            name: "azimuths",
            steps: spell("azimuths", &AZIMUTHS),
            range: range("azimuths"),
            default: 0,
            slower: "more azimuths: sharp silhouettes",
            set: |quality, step| quality.azimuths = AZIMUTHS[step],
            idle: |_| false,
        });
    }
    if have_slices(lights) {
        all.push(Ladder {
            name: "sun azimuths",
            steps: spell("sun_azimuths", &SUN_AZIMUTHS),
            range: range("sun_azimuths"),
            default: 0,
            slower: "more slices of a sun's disc, a key light or a sphere light: soft shadows",
            set: |quality, step| quality.sun_azimuths = SUN_AZIMUTHS[step],
            idle: |_| false,
        });
    }
    if !lights.sphere_lights.is_empty() {
        all.push(Ladder {
            name: "light basis",
            steps: LIGHT_BASES.iter().map(|b| format!("`light_basis {}`", b.name())).collect(),
            range: None,
            default: 0,
            slower: "each slice of a sphere light exact: sharp shadows",
            set: |quality, step| quality.light_basis = LIGHT_BASES[step],
            idle: |_| false,
        });
    }
    if lights.environment.is_some() && !has_specular {
        all.push(Ladder {
            name: "table elevations",
            steps: spell("table_elevations", &TABLE_ELEVATIONS),
            range: range("table_elevations"),
            default: 0,
            slower: "more elevations per table: small bright features",
            set: |quality, step| quality.table_elevations = TABLE_ELEVATIONS[step],
            idle: |quality| quality.basis == Basis::Sh,
        });
    }
    if lights.environment.is_some() || (lights.sky.is_some() && has_specular) {
        let orders = SH_ORDERS.map(|n| format!("`basis sh` `sh_order {n}`"));
        let table = (!has_specular).then(|| "`basis table`".to_owned());
        all.push(Ladder {
            name: "basis",
            steps: orders.into_iter().chain(table).collect(),
            range: None,
            default: 0,
            slower: "higher orders of harmonics, then tables: the environment's detail",
            set: |quality, step| match SH_ORDERS.get(step) {
                Some(order) => (quality.basis, quality.sh_order) = (Basis::Sh, *order),
                None => quality.basis = Basis::Table,
            },
            idle: |_| false,
        });
    }
    let is_sampled_all = has_specular && bounces > 0;
    if (lights.environment.is_some() || bounces > 0) && !is_sampled_all {
        all.push(Ladder {
            name: "sub-sampling",
            steps: spell("subsample", &SUBSAMPLES),
            range: None,
            default: 0,
            slower: "visibility and indirect light at more texels: sharp shadows",
            set: |quality, step| quality.subsample = SUBSAMPLES[step],
            idle: |quality| quality.basis != Basis::Sh && quality.bounces.count == 0,
        });
    }
    if bounces > 0 {
        all.extend(bounce_ladders(has_specular));
    }
    let start = start_of(scene);
    for ladder in &mut all {
        ladder.default = default_step(ladder, &start);
    }
    all
}

fn bounce_ladders(has_specular: bool) -> [Ladder; 2] {
    let by = match has_specular {
        true => Ladder {
            name: "bounce specular",
            steps: BOUNCE_SPECULARS
                .iter()
                .map(|g| format!("`bounce_specular {}`", g.name()))
                .collect(),
            range: None,
            default: 0,
            slower: "radiance by direction, then in full precision: specular bounces",
            set: |quality, step| quality.bounces.specular = BOUNCE_SPECULARS[step],
            idle: |_| false,
        },
        false => Ladder {
            name: "bounce engine",
            steps: BOUNCE_ENGINES.iter().map(|e| format!("`bounce_engine {}`", e.name())).collect(),
            range: None,
            default: 0,
            slower: "one lookup per level of pyramids; every visible interval of the surface",
            set: |quality, step| quality.bounces.engine = BOUNCE_ENGINES[step],
            idle: |_| false,
        },
    };
    [
        by,
        Ladder {
            name: "bounce azimuths",
            steps: BOUNCE_AZIMUTHS.iter().map(|m| format!("`bounce_azimuths {m}`")).collect(),
            range: range("bounce_azimuths"),
            default: 0,
            slower: "more azimuths of bounces: narrow bright features",
            set: |quality, step| quality.bounces.azimuths = BOUNCE_AZIMUTHS[step],
            idle: |_| false,
        },
    ]
}

/// The start of the defaults: sweeps and tables, to which they resolve.
pub fn start() -> Quality {
    Quality { method: Method::Sweep, basis: Basis::Table, ..Quality::default() }
}

/// The start for a scene: Phong specular is lit by harmonics.
pub fn start_of(scene: &Scene) -> Quality {
    let Lights { sky, environment, .. } = nonzero_lights(&scene.lights);
    let is_specular = has_specular(scene) && (sky.is_some() || environment.is_some());
    let basis = if is_specular { Basis::Sh } else { Basis::Table };
    Quality { basis, ..start() }
}

fn default_step(ladder: &Ladder, start: &Quality) -> usize {
    let is_default = |step: &usize| {
        let mut quality = *start;
        (ladder.set)(&mut quality, *step);
        quality == *start
    };
    (0..ladder.steps.len()).find(is_default).expect("every default is on its ladder")
}

/// Settings, and their step on each ladder.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The settings.
    pub quality: Quality,
    /// A step for each ladder; none where it has no effect.
    pub steps: Vec<Option<usize>>,
}

impl Place {
    /// Its settings, as "`lines 1` `azimuths 64`".
    pub fn flags(&self, ladders: &[Ladder]) -> String {
        let each =
            ladders.iter().zip(&self.steps).filter_map(|(k, s)| Some(k.steps[(*s)?].as_str()));
        each.collect::<Vec<_>>().join(" ")
    }
}

/// Every distinct combination of steps, from fast to slow; other settings as in `start`.
pub fn places(ladders: &[Ladder], start: &Quality) -> Vec<Place> {
    let mut all = Vec::new();
    let mut steps = vec![0; ladders.len()];
    'next: loop {
        let mut quality = *start;
        ladders.iter().zip(&steps).for_each(|(k, s)| (k.set)(&mut quality, *s));
        let idle: Vec<bool> = ladders.iter().map(|k| (k.idle)(&quality)).collect();
        let stores_slopes = matches!(quality.fuse, Fuse::Nearest | Fuse::Slopes);
        // Where no slopes are stored, f16 is f32.
        let is_other = quality.precision == Precision::F16 && !stores_slopes;
        let is_repeated = idle.iter().zip(&steps).any(|(idle, s)| *idle && *s > 0);
        if !is_repeated && (!is_other || has_no_lines(&quality)) {
            let mut quality = *start;
            for ((ladder, step), _) in
                ladders.iter().zip(&steps).zip(&idle).filter(|(_, idle)| !**idle)
            {
                (ladder.set)(&mut quality, *step);
            }
            let steps = steps.iter().zip(&idle).map(|(s, idle)| (!idle).then_some(*s)).collect();
            all.push(Place { quality, steps });
        }
        for (step, ladder) in steps.iter_mut().zip(ladders) {
            *step += 1;
            if *step < ladder.steps.len() {
                continue 'next;
            }
            *step = 0;
        }
        return all;
    }
}

#[cfg(test)]
mod tests;
