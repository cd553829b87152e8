//! Light through a horizon and onto a surface, against direct integrals.

use crate::{ORDERS, noise, within};
use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::light::{cosine_lobe, fit_above_ground, plane};
use ridgelight::basis::product::triples;
use ridgelight::basis::quadrature::points;
use ridgelight::basis::slice::Slices;
use ridgelight::basis::zonal::{clamped_cosine, phong};
use ridgelight_cpu::basis::azimuth::{assemble, circle};
use ridgelight_cpu::basis::product;
use ridgelight_cpu::basis::{receiver, specular};
use ridgelight_cpu::basis::{reconstruct, turned};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const AZIMUTHS: usize = 64;

/// Elevations of the lowest free direction along even azimuths: a horizon, and a plane of this normal.
fn lowest(normal: DVec3) -> Vec<f64> {
    let horizon = |phi: f64| 0.2 + 0.15 * (2.0 * phi).sin();
    (0..AZIMUTHS)
        .map(|k| TAU * k as f64 / AZIMUTHS as f64)
        .map(|phi| {
            let along = normal.x * phi.cos() + normal.y * phi.sin();
            horizon(phi).max((-along / normal.z).atan())
        })
        .collect()
}

fn visible(order: usize, lowest: &[f64]) -> Vec<f64> {
    let slices = Slices::new(order);
    let all: Vec<Vec<f64>> = lowest.iter().map(|w| slices.above(*w)).collect();
    assemble(order, &circle(order, AZIMUTHS), &all)
}

/// Σ over the same azimuths of 1/π ∫ L N·e cos ω dω, by Simpson's rule in 2000 parts: 1e-12.
fn directly(light: &[f64], lowest: &[f64], normal: DVec3) -> f64 {
    let step = TAU / AZIMUTHS as f64;
    let along = |k: usize, w: f64| {
        let phi = step * k as f64;
        let e = DVec3::new(w.cos() * phi.cos(), w.cos() * phi.sin(), w.sin());
        reconstruct(light, e) * normal.dot(e) * w.cos()
    };
    let parts = 2000;
    let slice = |k: usize| {
        let h = (FRAC_PI_2 - lowest[k]) / f64::from(parts);
        let weight = |i: i32| [1.0, 4.0, 2.0][if i % parts == 0 { 0 } else { 2 - i as usize % 2 }];
        let term = |i: i32| weight(i) * along(k, lowest[k] + h * f64::from(i));
        (0..=parts).map(term).sum::<f64>() * h / 3.0
    };
    (0..AZIMUTHS).map(slice).sum::<f64>() * step / PI
}

fn exit(matrix: &[Vec<f64>], rows: &[f64], visible: &[f64]) -> f64 {
    assert_eq!(matrix.len(), rows.len());
    let row = |row: &[f64]| row.iter().zip(visible).map(|(m, v)| m * v).sum::<f64>();
    matrix.iter().zip(rows).map(|(m, r)| r * row(m)).sum()
}

/// Light of order n - 1 over a plane, through visibility of order n: the series is complete.
#[test]
fn a_plane_receives_all_of_a_light_of_one_order_less() {
    let normal = DVec3::new(0.5, -0.3, 1.0).normalize();
    let rows = &receiver(normal.to_array())[1..4];
    for order in ORDERS.filter(|n| *n > 1) {
        let light = noise(7, (order - 1) * (order - 1));
        let matrix = plane(&triples(order), order, &light);
        let horizons = lowest(normal);
        let want = directly(&light, &horizons, normal);
        let got = exit(&matrix, rows, &visible(order, &horizons));
        within(&[got], &[want], 1e-11);
        // Visibility of one order less loses part of it, but for the constant light's.
        let mut shorter = visible(order, &horizons);
        shorter[(order - 1) * (order - 1)..].fill(0.0);
        assert!((exit(&matrix, rows, &shorter) - want).abs() > 1e-4, "order {order}");
    }
}

/// The lobe's matrix is the product of three series: light, visibility, the clamped cosine about N.
#[test]
fn a_lobe_is_the_triple_product() {
    let normal = DVec3::new(0.2, 0.6, 0.9).normalize();
    for order in ORDERS.filter(|n| *n > 1) {
        let (light, v) = (noise(3, order * order), noise(4, order * order));
        let triples = triples(order);
        let kept = order.min(3);
        let mut about = turned(&clamped_cosine(kept), normal);
        about.resize(order * order, 0.0);
        let want: f64 =
            product(&triples, &light, &v).iter().zip(&about).map(|(a, b)| a * b / PI).sum();
        let rows = &receiver(normal.to_array())[..kept * kept];
        within(&[exit(&cosine_lobe(&triples, order, &light), rows, &v)], &[want], 1e-12);
    }
}

/// Specular likewise, with all bands of a Phong lobe about a direction; it integrates to 1, the whole of an unoccluded
/// light of 1.
#[test]
fn specular_is_the_triple_product() {
    let mirror = DVec3::new(-0.3, 0.7, -0.2).normalize();
    for (order, exponent) in ORDERS.zip([0.0, 1.0, 5.0, 20.0, 1e3, 1e4]) {
        let (light, v) = (noise(3, order * order), noise(4, order * order));
        let triples = triples(order);
        let about = turned(&phong(order, exponent), mirror);
        let want: f64 = product(&triples, &light, &v).iter().zip(&about).map(|(a, b)| a * b).sum();
        within(&[specular(&product(&triples, &light, &v), mirror, exponent)], &[want], 1e-12);
        let mut one = vec![0.0; order * order];
        one[0] = (4.0 * PI).sqrt();
        within(&[specular(&product(&triples, &one, &one), mirror, exponent)], &[1.0], 1e-13);
    }
}

/// The fit's equations in another form: the residual above ground, and 1e-4 of the residual below it to the mean
/// above, is orthogonal to all functions of the fit. A constant is reproduced.
#[test]
fn a_fit_above_ground_is_the_best_there() {
    // Gauss' rule in z, exact here, times even azimuths, exact below 32 turns.
    let directions: Vec<(DVec3, f64)> = points(0.0, 1.0)
        .flat_map(|(z, weight)| {
            (0..32).map(move |k| {
                let (sin, cos) = (TAU / 32.0 * f64::from(k)).sin_cos();
                let r = ((1.0 - z) * (1.0 + z)).sqrt();
                (DVec3::new(r * cos, r * sin, z), weight * TAU / 32.0)
            })
        })
        .collect();
    for order in ORDERS {
        let integrals = |side: f64, f: &dyn Fn(DVec3) -> f64| {
            let mut sums = vec![0.0; order * order];
            for (e, weight) in &directions {
                let e = DVec3::new(e.x, e.y, side * e.z);
                let values = evaluate(order, e);
                sums.iter_mut().zip(values).for_each(|(s, y)| *s += weight * f(e) * y);
            }
            sums
        };
        let fit = fit_above_ground(order);
        let fitted = |b: &[f64]| -> Vec<f64> {
            fit.iter().map(|row| row.iter().zip(b).map(|(f, b)| f * b).sum()).collect()
        };
        let mut constant = vec![0.0; order * order];
        constant[0] = 3.0 * (4.0 * PI).sqrt();
        // Integrals are rounded, and up to 36 of them are multiplied by a condition of 1e4.
        let rounded = 36.0 * 1e4 * 3e-15;
        within(&fitted(&integrals(1.0, &|_| 3.0)), &constant, rounded);
        let sharp = |e: DVec3| if e.x > 0.5 { 5.0 } else { 0.5 + e.z };
        let above = integrals(1.0, &sharp);
        let mean = above[0] * (4.0 * PI).sqrt() / TAU;
        let best = fitted(&above);
        let left = integrals(1.0, &|e| sharp(e) - reconstruct(&best, e));
        let below = integrals(-1.0, &|e| 1e-4 * (mean - reconstruct(&best, e)));
        let both: Vec<f64> = left.iter().zip(below).map(|(a, b)| a + b).collect();
        within(&both, &vec![0.0; order * order], rounded);
        assert!(order < 2 || left.iter().any(|v| v.abs() > 1e-9), "nothing counts below");
    }
}
