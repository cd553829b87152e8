use crate::{ORDERS, nlp_value, noise, project, project_whole, within};
use ridgelight::basis::slice::Slices;
use ridgelight::basis::{bands, index};
use ridgelight_cpu::basis::azimuth::{Blend, assemble, assemble_nlp, circle, swath};
use ridgelight_cpu::basis::{from_nlp, rotate_z};
use std::f64::consts::{PI, TAU};

const BLENDS: [Blend; 2] = [Blend::Linear, Blend::BSpline];

/// Weights of a blend sum to 1 everywhere, and those of a B-spline are 1/6, 2/3, 1/6 at a knot.
#[test]
fn blends_share_out_the_whole() {
    for blend in BLENDS {
        for t in [0.0, 0.2, 0.5, 1.0] {
            within(&[blend.weights(t).iter().sum()], &[1.0], 1e-15);
        }
    }
    within(&Blend::BSpline.weights(0.0), &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0, 0.0], 1e-15);
    let (a, b) = (1.0 / 48.0, 23.0 / 48.0);
    within(&Blend::BSpline.weights(0.5), &[a, b, b, a], 1e-15);
}

/// A level horizon is a cap about z: every zonal coefficient the cap's, all others 0, for any number of wedges.
#[test]
fn a_level_horizon_is_a_cap() {
    for order in ORDERS {
        for (count, elevation) in [(order, 0.3), (8, -0.9), (31, 1.2), (32, 0.0)] {
            let visible = vec![Slices::new(order).above(elevation); count];
            let cap = ridgelight_cpu::basis::cap(order, PI / 2.0 - elevation);
            let mut expected = vec![0.0; order * order];
            (0..order).for_each(|l| expected[index(l, 0)] = cap[l]);
            within(&assemble(order, &circle(order, count), &visible), &expected, 1e-13);
        }
    }
}

/// Slices and NLP agree on functions that NLP represent, and a sum over azimuths that is turned by one azimuth is the
/// sum of slices moved on by one.
#[test]
fn slices_turn_with_their_azimuths() {
    let (order, count) = (5, 9);
    let nlps: Vec<Vec<f64>> = (0..count).map(|k| noise(40 + k as u64, order)).collect();
    let matrix = from_nlp(order);
    let slices: Vec<Vec<f64>> = nlps
        .iter()
        .map(|v| matrix.iter().map(|row| row.iter().zip(v).map(|(e, c)| e * c).sum()).collect())
        .collect();
    let weights = circle(order, count);
    let sum = assemble(order, &weights, &slices);
    within(&assemble_nlp(order, &weights, &nlps), &sum, 1e-13);
    let mut moved = slices.clone();
    moved.rotate_right(1);
    within(&assemble(order, &weights, &moved), &rotate_z(&sum, TAU / count as f64), 1e-13);
}

/// A swath against quadrature wedge by wedge; a B-spline repeats the slices at its ends.
#[test]
fn a_swath_is_its_wedges() {
    let (order, start, width) = (4, 2.5, 1.3);
    for count in [2, 3, 6] {
        let nlps: Vec<Vec<f64>> = (0..count).map(|k| noise(70 + k as u64, order)).collect();
        let step = width / (count - 1) as f64;
        for blend in BLENDS {
            let mut direct = [0.0; 16];
            for j in 0..count - 1 {
                let first = start + step * j as f64;
                let part = project(order, [0.0, PI], [first, first + step], |theta, phi| {
                    let weights = blend.weights((phi - first) / step);
                    (0..4_usize)
                        .map(|i| {
                            let k = (j + i).saturating_sub(1).min(count - 1);
                            weights[i] * nlp_value(&nlps[k], theta.cos())
                        })
                        .sum()
                });
                direct.iter_mut().zip(part).for_each(|(d, p)| *d += p);
            }
            let weights = swath(order, blend, start, width, count);
            within(&assemble_nlp(order, &weights, &nlps), &direct, 1e-13);
        }
    }
}

/// A swath once around, closed by the slice that it began with, is the circle with each turn m damped by sinc²(mΔφ/2), the
/// Fourier transform of a linear blend.
#[test]
fn a_swath_once_around_damps_each_turn() {
    let (order, count) = (6, 12);
    let mut slices: Vec<Vec<f64>> = (0..count).map(|k| noise(90 + k as u64, 21)).collect();
    let all = assemble(order, &circle(order, count), &slices);
    slices.push(slices[0].clone());
    let weights = swath(order, Blend::Linear, 0.0, TAU, count + 1);
    let damped = bands(order).zip(&all).map(|((_, m), c)| {
        let x = 0.5 * m as f64 * TAU / count as f64;
        if m == 0 { *c } else { c * (x.sin() / x).powi(2) }
    });
    within(&assemble(order, &weights, &slices), &damped.collect::<Vec<_>>(), 1e-13);
}

/// 2n - 1 weights of each azimuth.
#[test]
fn sizes_follow_the_order() {
    for order in ORDERS {
        assert!(circle(order, 5).iter().all(|w| w.len() == 2 * order - 1));
    }
}

/// Slices that turn slower than count - |m| are summed exactly.
#[test]
fn slices_that_turn_slowly_are_summed_exactly() {
    let (order, count) = (4, 9);
    // f = (1 + cos 3φ) P̂_0 + sin 2φ P̂_1: turns of 3 at most, 9 - 3 > 3.
    let part = |phi: f64| vec![1.0 + (3.0 * phi).cos(), (2.0 * phi).sin(), 0.0, 0.0];
    let nlps: Vec<_> = (0..count).map(|k| part(TAU * k as f64 / count as f64)).collect();
    let exact = project_whole(order, |theta, phi| nlp_value(&part(phi), theta.cos()));
    within(&assemble_nlp(order, &circle(order, count), &nlps), &exact, 1e-13);
}

/// With more azimuths a smooth horizon's harmonics converge faster than any power without a blend, and with the square
/// for a linear blend; the test detects a blend's error.
#[test]
fn a_smooth_horizon_converges_fastest_without_a_blend() {
    let order = 4;
    let slices = Slices::new(order);
    let above =
        |count: usize, k: usize| slices.above(0.6 + 0.4 * (TAU * k as f64 / count as f64).cos());
    let plain = |count: usize| {
        let all: Vec<_> = (0..count).map(|k| above(count, k)).collect();
        assemble(order, &circle(order, count), &all)
    };
    let blended = |count: usize| {
        let all: Vec<_> = (0..=count).map(|k| above(count, k)).collect();
        assemble(order, &swath(order, Blend::Linear, 0.0, TAU, count + 1), &all)
    };
    let ground_truth = plain(512);
    let apart = |found: Vec<f64>| -> f64 {
        found.iter().zip(&ground_truth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let exact = apart(plain(32));
    assert!(exact < 1e-13, "{exact:e}");
    let [coarse, fine] = [32, 64].map(|count| apart(blended(count)));
    assert!((3.5..4.5).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    assert!(coarse > 1e-4);
}
