//! The fit: each part of the error measured alone, least squares on logarithms.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Fuse, Lines, Method, Quality, Scene};
use ridgelight_trade::auto::{FEATURES, PARTS, Part, Statistics};
use ridgelight_trade::error::ImageError;
use ridgelight_trade::trade::start;

use super::judged;

/// Added to the squares of the normal equations' features (not of bias and power): as if each weight
/// had been measured as 0 once, with a spread of 1. Features are of order 1, scenes 24.
const RIDGE: f64 = 1.0;

const LINES: [Lines; 5] =
    [Lines::FourCells, Lines::TwoCells, Lines::Cell, Lines::HalfCell, Lines::QuarterCell];

/// One measured part: features of the scene, fineness of the setting, ln error.
struct Measurement {
    features: [f64; FEATURES],
    fineness: f64,
    log: f64,
}

/// Settings that differ in the part alone, and their reference.
fn settings(part: Part) -> (Vec<Quality>, Quality) {
    let plain = start();
    let of = |values: [u32; 6], last: u32, set: fn(&mut Quality, u32)| {
        let one = |v: u32| {
            let mut quality = plain;
            set(&mut quality, v);
            quality
        };
        (values.map(one).to_vec(), one(last))
    };
    match part {
        Part::Geometry => {
            let with = |fuse| LINES.map(|lines| Quality { lines, fuse, ..plain });
            let all = [Fuse::AimedNearest, Fuse::Aimed, Fuse::AimedAround].map(with).concat();
            // Exact lines have azimuths of their own; brute force is exact in the same ones.
            (all, Quality { method: Method::BruteForce, ..plain })
        }
        Part::Azimuths => of([8, 16, 32, 64, 128, 256], 1024, |q, v| q.azimuths = v),
        Part::Table => of([32, 64, 128, 256, 512, 1024], 4096, |q, v| q.table_elevations = v),
        Part::Strips => of([1, 2, 4, 8, 16, 32], 256, |q, v| q.sun_azimuths = v),
    }
}

/// Relative RMSE of each setting against the part's reference.
fn measure(gpu: &mut Headless, scene: &Scene, part: Part) -> Result<Vec<(Quality, f64)>> {
    let (all, reference) = settings(part);
    let reference = judged(gpu, scene, &reference)?.planes.concat();
    let of = |quality| {
        let planes = judged(gpu, scene, &quality)?.planes.concat();
        let error = ImageError::of(&planes, &reference, scene.field.cols())?;
        Ok((quality, error.relative_rmse))
    };
    all.into_iter().map(of).collect()
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

/// Weights of [features, bias, fineness], and the standard deviation of the residuals. Its degrees of
/// freedom are values less weights; a scene's values are alike, so of other scenes it is more. A
/// `known` power is held.
fn least_squares(all: &[Measurement], known: Option<f64>) -> (Vec<f64>, f64) {
    let row = |s: &Measurement| -> Vec<f64> {
        let fineness = if known.is_some() { None } else { Some(-s.fineness) };
        s.features.iter().copied().chain([1.0]).chain(fineness).collect()
    };
    let target = |s: &Measurement| s.log + known.unwrap_or(0.0) * s.fineness;
    let count = FEATURES + 1 + usize::from(known.is_none());
    let (mut a, mut b) = (vec![vec![0.0; count]; count], vec![0.0; count]);
    for s in all {
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
    let fitted = |s: &Measurement| row(s).iter().zip(&weights).map(|(x, w)| x * w).sum::<f64>();
    let squares: f64 = all.iter().map(|s| (target(s) - fitted(s)).powi(2)).sum();
    let free = all.len().saturating_sub(count).max(1) as f64;
    (weights, (squares / free).sqrt())
}

pub fn fit(gpu: &mut Headless, (side, scenes): (usize, &[(String, Scene)])) -> Result<()> {
    println!("// {}, middle {side}² of each field, the half that is fitted", gpu.report().name);
    let mut all: [Vec<Measurement>; 4] = Default::default();
    let mut geometry = [[0.0; 5]; 3];
    for (label, scene) in scenes {
        let features = Statistics::of(scene).features();
        println!("// {label}: {features:.2?}");
        for (part, own) in PARTS.iter().zip(&mut all).filter(|(part, _)| part.is_in(scene)) {
            let measured = measure(gpu, scene, *part)?;
            let errors: Vec<String> = measured.iter().map(|m| format!("{:.2e}", m.1)).collect();
            println!("//   {part:?}: {}", errors.join(" "));
            if *part == Part::Geometry {
                let base = measured[2].1.max(1e-6).ln();
                for (i, (_, error)) in measured.iter().enumerate() {
                    geometry[i / 5][i % 5] += error.max(1e-6).ln() - base;
                }
                own.push(Measurement { features, fineness: 0.0, log: base });
                continue;
            }
            for (quality, error) in measured.iter().filter(|m| m.1 > 1e-6) {
                own.push(Measurement {
                    features,
                    fineness: part.fineness(quality),
                    log: error.ln(),
                });
            }
        }
    }
    println!("pub(super) const FITTED: [Fitted; 4] = [");
    for (part, own) in PARTS.iter().zip(&all) {
        let known = (*part == Part::Geometry).then_some(1.0);
        let (weights, spread) = least_squares(own, known);
        let power = known.unwrap_or_else(|| weights[FEATURES + 1]);
        let (bias, weights) = (weights[FEATURES], &weights[..FEATURES]);
        println!(
            "    Fitted {{ bias: {bias:.3}, weights: {weights:.3?}, power: {power:.3}, spread: {spread:.3} }},"
        );
    }
    let fields = all[0].len().max(1) as f64;
    println!("];");
    let table = geometry.map(|fuse| fuse.map(|sum| sum / fields));
    println!("pub(super) const GEOMETRY: [[f64; 5]; 3] = {table:.3?};");
    Ok(())
}
