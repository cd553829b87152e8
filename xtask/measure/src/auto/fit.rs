//! The fit: each part of the error measured alone, least squares on logarithms.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Fuse, Lines, Method, Quality, Scene};
use ridgelight_trade::auto::{FEATURES, PARTS, Part, Statistics};
use ridgelight_trade::error::ImageError;
use ridgelight_trade::trade::start;

use super::{Request, draw, scenes};

/// Added to the squares of the normal equations' features (not of bias and power): as if each weight
/// had been seen to be 0 once, with a spread of 1. Features are of order 1, scenes 24.
const RIDGE: f64 = 1.0;

const LINES: [Lines; 5] =
    [Lines::FourCells, Lines::TwoCells, Lines::Cell, Lines::HalfCell, Lines::QuarterCell];

/// One measured part: features of the scene, fineness of the setting, ln error.
struct Seen {
    features: [f64; FEATURES],
    fineness: f64,
    log: f64,
}

/// Settings that differ in the part alone, and those that they are held against.
fn settings(part: Part) -> (Vec<Quality>, Quality) {
    let plain = start();
    let of = |values: &[u32], set: fn(&mut Quality, u32)| -> Vec<Quality> {
        let one = |v: &u32| {
            let mut quality = plain;
            set(&mut quality, *v);
            quality
        };
        values.iter().map(one).collect()
    };
    match part {
        Part::Geometry => {
            let with = |fuse| LINES.map(|lines| Quality { lines, fuse, ..plain });
            let all = [Fuse::AimedNearest, Fuse::Aimed, Fuse::AimedAround].map(with).concat();
            // Exact lines have azimuths of their own: brute force is the truth in the same ones.
            (all, Quality { method: Method::BruteForce, ..plain })
        }
        Part::Azimuths => {
            let all = of(&[8, 16, 32, 64, 128, 256], |q, v| q.azimuths = v);
            (all, Quality { azimuths: 1024, ..plain })
        }
        Part::Table => {
            let all = of(&[32, 64, 128, 256, 512, 1024], |q, v| q.table_elevations = v);
            (all, Quality { table_elevations: 4096, ..plain })
        }
        Part::Strips => {
            let all = of(&[1, 2, 4, 8, 16, 32], |q, v| q.sun_azimuths = v);
            (all, Quality { sun_azimuths: 256, ..plain })
        }
    }
}

fn measure(gpu: &mut Headless, scene: &Scene, part: Part) -> Result<Vec<(Quality, f64)>> {
    let (all, against) = settings(part);
    let truth = draw(gpu, scene, &against, 0)?.planes;
    let mut seen = Vec::new();
    for quality in all {
        let planes = draw(gpu, scene, &quality, 0)?.planes;
        let off = ImageError::of(&planes.concat(), &truth.concat(), scene.field.cols())?;
        seen.push((quality, off.relative_rmse));
    }
    Ok(seen)
}

/// Solves a symmetric positive definite system by Gauss' elimination.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for i in 0..n {
        let (above, below) = a.split_at_mut(i + 1);
        for (j, row) in below.iter_mut().enumerate() {
            let factor = row[i] / above[i][i];
            row.iter_mut().zip(&above[i]).skip(i).for_each(|(x, pivot)| *x -= factor * pivot);
            b[i + 1 + j] -= factor * b[i];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| a[i][k] * b[k]).sum();
        b[i] = (b[i] - known) / a[i][i];
    }
    b
}

/// Weights of [features, bias, fineness], and the standard deviation of what is left, for as many fewer values
/// as there are weights (a scene's values are alike: of other scenes it is more); where the power is
/// `known` it is held.
fn least_squares(seen: &[Seen], known: Option<f64>) -> (Vec<f64>, f64) {
    let row = |s: &Seen| -> Vec<f64> {
        let fineness = if known.is_some() { None } else { Some(-s.fineness) };
        s.features.iter().copied().chain([1.0]).chain(fineness).collect()
    };
    let target = |s: &Seen| s.log + known.unwrap_or(0.0) * s.fineness;
    let count = FEATURES + 1 + usize::from(known.is_none());
    let (mut a, mut b) = (vec![vec![0.0; count]; count], vec![0.0; count]);
    for s in seen {
        let x = row(s);
        for i in 0..count {
            b[i] += x[i] * target(s);
            (0..count).for_each(|j| a[i][j] += x[i] * x[j]);
        }
    }
    for (i, line) in a.iter_mut().enumerate().take(FEATURES) {
        line[i] += RIDGE;
    }
    // Features that never change would leave bias and weight undecided without.
    a[FEATURES][FEATURES] += 1e-9;
    let weights = solve(a, b);
    let off = |s: &Seen| target(s) - row(s).iter().zip(&weights).map(|(x, w)| x * w).sum::<f64>();
    let free = seen.len().saturating_sub(count).max(1) as f64;
    let left = seen.iter().map(|s| off(s).powi(2)).sum::<f64>() / free;
    (weights, left.sqrt())
}

pub fn fit(gpu: &mut Headless, asked: &Request) -> Result<()> {
    let all = scenes(asked)?;
    println!(
        "// {}, middle {}² of each field, the half that is fitted",
        gpu.report().name,
        asked.side
    );
    let mut seen: [Vec<Seen>; 4] = Default::default();
    let mut geometry = [[0.0; 5]; 3];
    let mut fields = 0.0_f64;
    for (label, scene) in &all {
        let features = Statistics::of(scene).features();
        println!("// {label}: {features:.2?}");
        for (part, seen) in PARTS.iter().zip(&mut seen) {
            if !part.is_in(scene) {
                continue;
            }
            let measured = measure(gpu, scene, *part)?;
            let shown: Vec<String> = measured.iter().map(|m| format!("{:.2e}", m.1)).collect();
            println!("//   {part:?}: {}", shown.join(" "));
            if *part == Part::Geometry {
                fields += 1.0;
                let base = measured[2].1.max(1e-6).ln();
                for (i, (_, error)) in measured.iter().enumerate() {
                    geometry[i / 5][i % 5] += error.max(1e-6).ln() - base;
                }
                seen.push(Seen { features, fineness: 0.0, log: base });
                continue;
            }
            for (quality, error) in measured.iter().filter(|m| m.1 > 1e-6) {
                seen.push(Seen { features, fineness: part.fineness(quality), log: error.ln() });
            }
        }
    }
    println!("pub(super) const FITTED: [Fitted; 4] = [");
    for (part, seen) in PARTS.iter().zip(&seen) {
        let known = (*part == Part::Geometry).then_some(1.0);
        let (weights, spread) = least_squares(seen, known);
        let power = known.unwrap_or_else(|| weights[FEATURES + 1]);
        println!(
            "    Fitted {{ bias: {:.3}, weights: {:.3?}, power: {power:.3}, spread: {spread:.3} }},",
            weights[FEATURES],
            &weights[..FEATURES]
        );
    }
    println!("];");
    let table = geometry.map(|fuse| fuse.map(|sum| sum / fields.max(1.0)));
    println!("pub(super) const GEOMETRY: [[f64; 5]; 3] = {table:.3?};");
    Ok(())
}
