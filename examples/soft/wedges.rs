//! How near the series of what is seen is by slices, by Legendre coefficients and by a table of wedges
//! between two azimuths (Snyder & Nowrouzezahrai 2008), from the same horizons.

use ridgelight::basis::slice::Slices;
use ridgelight::basis::wedge::WedgeTable;
use ridgelight::scene::{Border, HeightField};
use ridgelight_cpu::basis::azimuth::{assemble, assemble_nlp, circle};
use ridgelight_cpu::basis::occlusion;
use ridgelight_cpu::basis::rotate_z;
use ridgelight_cpu::basis::wedge::look_up;
use ridgelight_cpu::oracle::Oracle;
use std::f64::consts::{SQRT_2, TAU};

/// Azimuths of the truth.
const MANY: usize = 2048;
const PLACES: usize = 150;
/// The paper's order.
const ORDER: usize = 4;

/// The series by slices of every azimuth.
fn slices(horizons: &[f64]) -> Vec<f64> {
    let slices = Slices::new(ORDER);
    let along: Vec<Vec<f64>> = horizons.iter().map(|h| slices.above(*h)).collect();
    assemble(ORDER, &circle(ORDER, None, horizons.len()), &along)
}

fn nlp(horizons: &[f64]) -> Vec<f64> {
    let above = |h: &f64| {
        let mut above: Vec<f64> =
            occlusion(ORDER, h.sin(), h.cos()).iter().map(|below| -below).collect();
        above[0] += SQRT_2;
        above
    };
    let along: Vec<Vec<f64>> = horizons.iter().map(above).collect();
    assemble_nlp(ORDER, &circle(ORDER, None, horizons.len()), &along)
}

fn table(table: &WedgeTable, horizons: &[f64]) -> Vec<f64> {
    let count = horizons.len();
    let mut sum = vec![0.0; ORDER * ORDER];
    for k in 0..count {
        let wedge = look_up(table, [horizons[k], horizons[(k + 1) % count]]);
        let turned = rotate_z(&wedge, TAU * k as f64 / count as f64);
        sum.iter_mut().zip(turned).for_each(|(s, t)| *s += t);
    }
    sum
}

/// RMSE over the root mean square of the truth, %, of each form, by azimuths.
pub fn run(field: &HeightField) {
    let oracle = Oracle::new(field, Border::Plane);
    let samples = field.rows() * field.cols();
    let step = (samples / PLACES) | 1;
    let places: Vec<Vec<f64>> = (0..samples)
        .step_by(step)
        .map(|i| {
            let at = |k| {
                oracle.elevation_rad(
                    i / field.cols(),
                    i % field.cols(),
                    TAU * k as f64 / MANY as f64,
                )
            };
            (0..MANY).map(at).collect()
        })
        .collect();
    let truth: Vec<Vec<f64>> = places.iter().map(|p| slices(p)).collect();
    println!(
        "{} places, order {ORDER}; RMSE of the series over its root mean square, %, beside {MANY} azimuths\n",
        places.len()
    );
    println!("| azimuths | slices | NLP | table 16² | table 32² | table 64² | table 64² KB |");
    println!("|---|---|---|---|---|---|---|");
    for count in [4, 8, 16, 32, 64] {
        let tables = [16, 32, 64].map(|side| WedgeTable::new(ORDER, side, 0.0, TAU / count as f64));
        let mut squares = [0.0; 5];
        let mut all = 0.0;
        for (place, truth) in places.iter().zip(&truth) {
            let horizons: Vec<f64> = place.iter().step_by(MANY / count).copied().collect();
            let [a, b, c] = &tables;
            let forms = [
                slices(&horizons),
                nlp(&horizons),
                table(a, &horizons),
                table(b, &horizons),
                table(c, &horizons),
            ];
            for (square, form) in squares.iter_mut().zip(&forms) {
                *square += form.iter().zip(truth).map(|(f, t)| (f - t) * (f - t)).sum::<f64>();
            }
            all += truth.iter().map(|t| t * t).sum::<f64>();
        }
        let [a, b, c, d, e] = squares.map(|s| 100.0 * (s / all).sqrt());
        let kb = tables[2].texels.len() as f64 * (ORDER * ORDER) as f64 * 4e-3;
        println!("| {count} | {a:.3} | {b:.3} | {c:.3} | {d:.3} | {e:.3} | {kb:.0} |");
    }
}
