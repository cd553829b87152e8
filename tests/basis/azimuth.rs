use crate::{ORDERS, noise, number, numbers, project, project_whole, reference, same, within};
use ridgelight::basis::slice::Slices;
use ridgelight::basis::{bands, index};
use ridgelight_cpu::basis::azimuth::{Blend, assemble, assemble_nlp, blend_matrix, circle, swath};
use ridgelight_cpu::basis::from_nlp;
use ridgelight_cpu::basis::nlp_value;
use ridgelight_cpu::basis::rotate_z;
use std::f64::consts::{PI, TAU};

const BLENDS: [Blend; 2] = [Blend::Linear, Blend::BSpline];

#[test]
fn blend_matrices_are_the_reference() {
    for entry in reference("nlp_to_sh").as_array().unwrap() {
        let width = number(&entry["delta_phi"]);
        for (blend, name, columns) in
            [(Blend::Linear, "linear_16x8", 8), (Blend::BSpline, "bspline_16x16", 16)]
        {
            let matrix = blend_matrix(4, blend, width);
            assert_eq!(matrix.len(), 16);
            for (row, expected) in matrix.iter().zip(entry[name].as_array().unwrap()) {
                assert_eq!(row.len(), columns);
                same(row, &numbers(expected));
            }
        }
    }
}

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

/// As in the paper: each wedge's matrix, its turn about z, and the sum of m wedges, the last one from azimuth m - 1
/// back to 0. With one wedge less the result differs.
#[test]
fn weights_all_around_are_wedges_turned_and_summed() {
    for (order, count) in [(1, 3), (2, 5), (4, 8), (4, 32), (6, 7)] {
        let nlps: Vec<Vec<f64>> = (0..count).map(|k| noise(k as u64, order)).collect();
        let width = TAU / count as f64;
        for blend in BLENDS {
            let matrix = blend_matrix(order, blend, width);
            let reach: &[usize] =
                if blend == Blend::Linear { &[0, 1] } else { &[count - 1, 0, 1, 2] };
            let mut sums = [vec![0.0; order * order], vec![0.0; order * order]];
            for j in 0..count {
                let stacked: Vec<f64> =
                    reach.iter().flat_map(|i| nlps[(j + i) % count].clone()).collect();
                let wedge: Vec<f64> = matrix
                    .iter()
                    .map(|row| row.iter().zip(&stacked).map(|(a, b)| a * b).sum())
                    .collect();
                for (i, v) in rotate_z(&wedge, width * j as f64).iter().enumerate() {
                    sums[0][i] += v;
                    sums[1][i] += if j + 1 < count { *v } else { 0.0 };
                }
            }
            let at_once = assemble_nlp(order, &circle(order, Some(blend), count), &nlps);
            within(&at_once, &sums[0], 1e-13);
            let missing: f64 = at_once.iter().zip(&sums[1]).map(|(a, b)| (a - b).abs()).sum();
            assert!(missing > 1e-3, "{missing}");
        }
    }
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
            for blend in BLENDS {
                within(
                    &assemble(order, &circle(order, Some(blend), count), &visible),
                    &expected,
                    1e-13,
                );
            }
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
    for blend in BLENDS {
        let weights = circle(order, Some(blend), count);
        let sum = assemble(order, &weights, &slices);
        within(&assemble_nlp(order, &weights, &nlps), &sum, 1e-13);
        let mut moved = slices.clone();
        moved.rotate_right(1);
        within(&assemble(order, &weights, &moved), &rotate_z(&sum, TAU / count as f64), 1e-13);
    }
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

/// A swath once around, closed by the slice it began with, is the circle (linear: a B-spline stops at its ends).
#[test]
fn a_swath_once_around_is_the_circle() {
    let (order, count) = (6, 12);
    let mut slices: Vec<Vec<f64>> = (0..count).map(|k| noise(90 + k as u64, 21)).collect();
    let all = assemble(order, &circle(order, Some(Blend::Linear), count), &slices);
    slices.push(slices[0].clone());
    let weights = swath(order, Blend::Linear, 0.0, TAU, count + 1);
    within(&assemble(order, &weights, &slices), &all, 1e-13);
}

/// Sizes for every order: n² rows; n columns for each azimuth.
#[test]
fn sizes_follow_the_order() {
    for order in ORDERS {
        for (blend, reach) in [(Blend::Linear, 2), (Blend::BSpline, 4)] {
            let matrix = blend_matrix(order, blend, 0.3);
            assert_eq!(matrix.len(), bands(order).count());
            assert!(matrix.iter().all(|row| row.len() == reach * order));
        }
        assert!(circle(order, Some(Blend::Linear), 5).iter().all(|w| w.len() == 2 * order - 1));
    }
}

/// Slices that turn slower than count - |m| are summed exactly without a blend; with one, m is damped by sinc(mΔφ/2)
/// to the power 2 or 4, as in one wedge's matrix.
#[test]
fn a_blend_all_around_damps_each_turn() {
    let (order, count) = (4, 9);
    // f = (1 + cos 3φ) P̂_0 + sin 2φ P̂_1: turns of 3 at most, 9 - 3 > 3.
    let part = |phi: f64| vec![1.0 + (3.0 * phi).cos(), (2.0 * phi).sin(), 0.0, 0.0];
    let width = TAU / count as f64;
    let nlps: Vec<_> = (0..count).map(|k| part(width * k as f64)).collect();
    let exact = project_whole(order, |theta, phi| nlp_value(&part(phi), theta.cos()));
    within(&assemble_nlp(order, &circle(order, None, count), &nlps), &exact, 1e-13);
    for (blend, power) in [(Blend::Linear, 2), (Blend::BSpline, 4)] {
        let blended = assemble_nlp(order, &circle(order, Some(blend), count), &nlps);
        for ((l, m), got) in bands(order).zip(blended) {
            let x = 0.5 * m as f64 * width;
            let damped = if m == 0 { 1.0 } else { (x.sin() / x).powi(power) };
            within(&[got], &[damped * exact[index(l, m)]], 1e-13);
        }
    }
}

/// With more azimuths a smooth horizon's harmonics converge faster than any power without a blend, and with the square
/// for a linear blend; the test detects a blend's error.
#[test]
fn a_smooth_horizon_converges_fastest_without_a_blend() {
    let order = 4;
    let slices = Slices::new(order);
    let visible = |count: usize, blend| {
        let above = |k| slices.above(0.6 + 0.4 * (TAU * k as f64 / count as f64).cos());
        assemble(order, &circle(order, blend, count), &(0..count).map(above).collect::<Vec<_>>())
    };
    let ground_truth = visible(512, None);
    let apart = |count, blend| -> f64 {
        visible(count, blend)
            .iter()
            .zip(&ground_truth)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
    };
    assert!(apart(32, None) < 1e-13, "{:e}", apart(32, None));
    let linear = Some(Blend::Linear);
    assert!((3.5..4.5).contains(&(apart(32, linear) / apart(64, linear))));
    assert!(apart(32, linear) > 1e-4);
}
