//! Candidate settings.

use super::model::{Part, fuse_row, spacing};
use crate::trade::start;
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
const BOUNCE_AZIMUTHS: [u32; 5] = [8, 16, 32, 64, 128];
/// Bounces are omitted where they carry at most this share of the direct light's energy.
const CUTOFFS: [f64; 5] = [1.0 / 16.0, 1.0 / 64.0, 1.0 / 256.0, 1.0 / 1024.0, 1.0 / 65536.0];

/// Every combination of settings that affects a scene's direct light. Where no lines are close
/// enough, horizons are exact: by brute force, or along grid vectors (faster for large fields),
/// which suns and key lights cannot use. With bounces, which multiply the combinations, every
/// second step of each count.
pub(super) fn candidates(scene: &Scene, bounces: u32) -> Vec<Quality> {
    let step = if bounces > 0 { 2 } else { 1 };
    let of = |part: Part, values: &[u32], default: u32| -> Vec<u32> {
        let few = || values.iter().step_by(step).copied().collect();
        if part.is_in(scene) { few() } else { vec![default] }
    };
    let plain = start();
    let mut all = Vec::new();
    if !Part::Geometry.is_in(scene) {
        all.push(plain);
    } else {
        all.push(Quality { method: Method::BruteForce, ..plain });
        if scene.lights.suns.is_empty() && scene.lights.keys.is_empty() {
            all.push(Quality { lines: Lines::Exact, ..plain });
        }
        for lines in LINES {
            all.extend(FUSES.map(|fuse| Quality { lines, fuse, ..plain }));
        }
    }
    let times = |all: Vec<Quality>, values: Vec<u32>, set: fn(&mut Quality, u32)| {
        let with = |quality: Quality| {
            values.iter().map(move |v| {
                let mut quality = quality;
                set(&mut quality, *v);
                quality
            })
        };
        all.into_iter().flat_map(with).collect::<Vec<_>>()
    };
    all = times(all, of(Part::Azimuths, &AZIMUTHS, plain.azimuths), |q, v| q.azimuths = v);
    all = times(all, of(Part::Table, &TABLES, plain.table_elevations), |q, v| {
        q.table_elevations = v;
    });
    all = times(all, of(Part::Strips, &STRIPS, plain.sun_azimuths), |q, v| q.sun_azimuths = v);
    if bounces == 0 { all } else { with_bounces(scene, bounces, &all) }
}

/// Each candidate with every combination of bounce settings.
fn with_bounces(scene: &Scene, count: u32, all: &[Quality]) -> Vec<Quality> {
    let albedo = scene.surface.max_reflectance();
    let mut cutoffs: Vec<f64> = Vec::new();
    for cutoff in CUTOFFS {
        let drawn = |cutoff| Bounces { count, cutoff, ..Bounces::DEFAULT }.needed_bounces(albedo);
        if cutoffs.last().is_none_or(|last| drawn(*last) != drawn(cutoff)) {
            cutoffs.push(cutoff);
        }
    }
    let mut bounced = Vec::new();
    for cutoff in cutoffs {
        let none = Bounces { count, cutoff, ..Bounces::DEFAULT };
        if none.needed_bounces(albedo) == 0 {
            bounced.push((none, 1));
            continue;
        }
        for (engine, subsample) in ENGINES {
            for azimuths in BOUNCE_AZIMUTHS {
                bounced.push((Bounces { engine, azimuths, ..none }, subsample));
            }
        }
    }
    let with = |q: &Quality| {
        let (quality, is_exact) = (*q, is_exact(q));
        // Without lines the planner itself uses brute force.
        let is_other =
            move |b: &&(Bounces, u32)| !is_exact || b.0.engine != BounceEngine::BruteForce;
        bounced
            .iter()
            .filter(is_other)
            .map(move |(bounces, subsample)| Quality {
                bounces: *bounces,
                subsample: *subsample,
                ..quality
            })
            .collect::<Vec<_>>()
    };
    all.iter().flat_map(with).collect()
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
            if spacing(q) == LINES.len() { FUSES.len() as u32 } else { fuse_row(q.fuse) as u32 },
            q.azimuths,
            q.table_elevations,
            q.sun_azimuths,
            4 / q.subsample,
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
