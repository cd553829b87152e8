//! Candidate settings.

use super::model::{Part, fuse_row, spacing};
use crate::trade::{has_specular, start};
use ridgelight::scene::{BounceEngine, Bounces, Fuse, Lines, Method, Quality, Scene};

const AZIMUTHS: [u32; 15] = [8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024];
const TABLES: [u32; 8] = [32, 64, 128, 256, 512, 1024, 2048, 4096];
const STRIPS: [u32; 8] = [1, 2, 4, 8, 16, 32, 64, 128];
const LINES: [Lines; 5] =
    [Lines::FourCells, Lines::TwoCells, Lines::Cell, Lines::HalfCell, Lines::QuarterCell];
const FUSES: [Fuse; 3] = [Fuse::AimedNearest, Fuse::Aimed, Fuse::AimedAround];

/// Bounce engines and sub-sampling strides.
const ENGINES: [(BounceEngine, u32); 6] = [
    (BounceEngine::Pyramid, 2),
    (BounceEngine::Pyramid, 1),
    (BounceEngine::Auto, 4),
    (BounceEngine::Auto, 2),
    (BounceEngine::Auto, 1),
    (BounceEngine::BruteForce, 1),
];
/// Bounce engines and SH orders with specular, for which light between bounces is stored at every texel.
const SPECULAR_ENGINES: [(BounceEngine, u32); 5] = [
    (BounceEngine::Pyramid, 2),
    (BounceEngine::Pyramid, 4),
    (BounceEngine::BruteForce, 3),
    (BounceEngine::BruteForce, 4),
    (BounceEngine::BruteForce, 6),
];
const BOUNCE_AZIMUTHS: [u32; 5] = [8, 16, 32, 64, 128];
/// Bounces are omitted where they carry at most this share of the direct light's energy.
const CUTOFFS: [f64; 5] = [1.0 / 16.0, 1.0 / 64.0, 1.0 / 256.0, 1.0 / 1024.0, 1.0 / 65536.0];

/// Every combination of settings that affects a scene's direct light. Where no lines are close
/// enough, horizons are exact: by brute force, or along grid vectors (faster for large fields),
/// which suns and key lights cannot use. With bounces, which multiply the combinations, every
/// second step of each count.
pub(super) fn candidates(scene: &Scene, bounces: u32) -> Vec<Quality> {
    let plain = start();
    let mut all = vec![plain];
    if Part::Geometry.is_in(scene) {
        all = vec![Quality { method: Method::BruteForce, ..plain }];
        if scene.lights.suns.is_empty() && scene.lights.keys.is_empty() {
            all.push(Quality { lines: Lines::Exact, ..plain });
        }
        let defaults = defaults(scene);
        for lines in LINES {
            all.extend(FUSES.map(|fuse| {
                let is_default = (lines, fuse) == (defaults.lines, defaults.fuse);
                let method = if is_default { defaults.method } else { plain.method };
                Quality { method, lines, fuse, ..plain }
            }));
        }
    }
    let step = if bounces > 0 { 2 } else { 1 };
    let mut times = |part: Part, values: &[u32], set: fn(&mut Quality, u32)| {
        let with = |quality: &Quality| {
            let of = |value: &u32| {
                let mut quality = *quality;
                set(&mut quality, *value);
                quality
            };
            values.iter().step_by(step).map(of).collect::<Vec<_>>()
        };
        if part.is_in(scene) {
            all = all.iter().flat_map(with).collect();
        }
    };
    times(Part::Azimuths, &AZIMUTHS, |q, v| q.azimuths = v);
    times(Part::Table, &TABLES, |q, v| q.table_elevations = v);
    times(Part::Strips, &STRIPS, |q, v| q.sun_azimuths = v);
    if bounces == 0 { all } else { with_bounces(scene, bounces, &all) }
}

/// The defaults: suns have exact shadows.
fn defaults(scene: &Scene) -> Quality {
    let has_suns = !scene.lights.suns.is_empty();
    Quality { method: if has_suns { Method::Auto } else { Method::Sweep }, ..start() }
}

/// Settings of the first frames: the defaults, finer ones and coarse ones. Probes are taken where their pictures differ
/// most ([`unsure`](super::unsure)).
pub(super) fn pilots(scene: &Scene, bounces: u32) -> [Quality; 3] {
    let coarse = Quality {
        azimuths: 8,
        sun_azimuths: 2,
        lines: Lines::FourCells,
        fuse: Fuse::AimedNearest,
        table_elevations: 64,
        subsample: 2,
        bounces: Bounces { azimuths: 8, ..Bounces::default() },
        ..start()
    };
    let defaults = defaults(scene);
    // The exact shadows of suns need the default lines.
    let lines = if defaults.method == Method::Auto { defaults.lines } else { Lines::HalfCell };
    let fine = Quality { azimuths: 48, sun_azimuths: 16, lines, table_elevations: 512, ..defaults };
    [defaults, fine, coarse].map(|mut quality| {
        quality.bounces.count = bounces;
        // Where a setting has no effect, candidates have its default. With another, the search would render the same picture twice.
        let plain = start();
        if bounces == 0 {
            (quality.bounces, quality.subsample) = (plain.bounces, plain.subsample);
        } else if has_specular(scene) {
            (quality.bounces.engine, quality.subsample) = (BounceEngine::Pyramid, 1);
        }
        for (part, setting, value) in [
            (Part::Azimuths, &mut quality.azimuths, plain.azimuths),
            (Part::Table, &mut quality.table_elevations, plain.table_elevations),
            (Part::Strips, &mut quality.sun_azimuths, plain.sun_azimuths),
        ] {
            if !part.is_in(scene) {
                *setting = value;
            }
        }
        quality
    })
}

/// Each candidate with every combination of bounce settings.
fn with_bounces(scene: &Scene, count: u32, all: &[Quality]) -> Vec<Quality> {
    let albedo = scene.surface.max_reflectance();
    let mut cutoffs: Vec<f64> = Vec::new();
    for cutoff in CUTOFFS {
        let drawn = |cutoff| Bounces { count, cutoff, ..Bounces::default() }.needed_bounces(albedo);
        if cutoffs.last().is_none_or(|last| drawn(*last) != drawn(cutoff)) {
            cutoffs.push(cutoff);
        }
    }
    let order = start().sh_order;
    let engines: Vec<(BounceEngine, u32, u32)> = match has_specular(scene) {
        true => SPECULAR_ENGINES.map(|(engine, order)| (engine, 1, order)).into(),
        false => ENGINES.map(|(engine, subsample)| (engine, subsample, order)).into(),
    };
    let mut bounced = Vec::new();
    for cutoff in cutoffs {
        let none = Bounces { count, cutoff, ..Bounces::default() };
        if none.needed_bounces(albedo) == 0 {
            bounced.push((none, 1, order));
            continue;
        }
        for (engine, subsample, order) in &engines {
            for azimuths in BOUNCE_AZIMUTHS {
                bounced.push((Bounces { engine: *engine, azimuths, ..none }, *subsample, *order));
            }
        }
    }
    let mut both = Vec::new();
    for quality in all {
        let is_exact = is_exact(quality);
        for &(bounces, subsample, sh_order) in &bounced {
            // Without lines, `auto` is brute force already; with specular it is the pyramid.
            let is_repeated = is_exact && bounces.engine == BounceEngine::BruteForce;
            if !is_repeated || has_specular(scene) {
                both.push(Quality { bounces, subsample, sh_order, ..*quality });
            }
        }
    }
    both
}

/// Whether horizons are exact.
pub(super) fn is_exact(quality: &Quality) -> bool {
    spacing(quality) == LINES.len()
}

/// Whether `fine` is at least as fine as `coarse` in every setting.
pub(super) fn is_finer(fine: &Quality, coarse: &Quality) -> bool {
    let numbers = |q: &Quality| {
        [
            spacing(q) as u32 + u32::from(q.lines == Lines::Exact),
            match spacing(q) {
                exact if exact == LINES.len() => FUSES.len() as u32,
                // Suns do not depend on the fuse.
                _ if q.method == Method::Auto => FUSES.len() as u32,
                _ => fuse_row(q.fuse) as u32,
            },
            q.azimuths,
            q.table_elevations,
            q.sun_azimuths,
            4 / q.subsample,
            q.sh_order,
            q.bounces.azimuths,
            match q.bounces.engine {
                BounceEngine::Pyramid => 0,
                BounceEngine::Auto | BounceEngine::Sweep => 1,
                BounceEngine::BruteForce => 2,
            },
            // A share of at most 1: smaller values are finer, and the order of their bits is that
            // of the numbers.
            u32::MAX - (q.bounces.cutoff as f32).to_bits(),
        ]
    };
    numbers(fine).iter().zip(numbers(coarse)).all(|(f, c)| *f >= c)
}
