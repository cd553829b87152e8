use crate::{ORDERS, directions, within};
use glam::DVec3;
use ridgelight::basis::window::{hann, lanczos, nonnegative};
use ridgelight_cpu::basis::{apply_window, reconstruct, turned};
use std::f64::consts::PI;

fn lowest(coefficients: &[f64]) -> f64 {
    directions(20_000).map(|e| reconstruct(coefficients, e)).fold(f64::INFINITY, f64::min)
}

/// A point light's coefficients: Y at its direction, zonal √((2l+1)/4π).
fn point(order: usize, towards: DVec3) -> Vec<f64> {
    let zonal: Vec<f64> = (0..order).map(|l| ((2 * l + 1) as f64 / (4.0 * PI)).sqrt()).collect();
    turned(&zonal, towards)
}

#[test]
fn known_factors() {
    within(&hann(4, 4.0), &[1.0, 0.5 + 0.125_f64.sqrt(), 0.5, 0.5 - 0.125_f64.sqrt()], 1e-15);
    within(&lanczos(3, 2.0), &[1.0, 2.0 / PI, 0.0], 1e-15);
    within(&hann(3, 1.0), &[1.0, 0.0, 0.0], 1e-15);
    within(&hann(6, 1e9), &[1.0; 6], 1e-15);
}

/// The largest mean of z of a polynomial ≥ 0 is the last node of Gauss' rule. 1/3 for degree 1 (1 + z), 1/√3 for
/// degree 2 (two points), (1 + √6)/5 for degree 3 (Radau), √(3/5) for degree 4 (three points).
#[test]
fn the_strongest_window_keeps_the_last_node_of_band_1() {
    assert_eq!(nonnegative(1), [1.0]);
    let nodes = [1.0 / 3.0, 3.0_f64.sqrt().recip(), (1.0 + 6.0_f64.sqrt()) / 5.0, 0.6_f64.sqrt()];
    for (order, node) in (2..).zip(nodes) {
        within(&nonnegative(order)[..2], &[1.0, node], 1e-14);
    }
    assert!(nonnegative(6).windows(2).all(|pair| pair[1] < pair[0]));
}

/// A point light is the worst case: with this window its minimum is 0. Without it, the series rings to a large share
/// of its peak; so it does with Hann of the order's width.
#[test]
fn a_point_light_is_not_negative() {
    for order in ORDERS {
        let light = point(order, DVec3::new(0.48, 0.6, 0.64));
        let peak = light.iter().map(|c| c * c).sum::<f64>();
        let windowed = apply_window(&nonnegative(order), &light);
        assert!(lowest(&windowed) > -1e-14 * peak, "order {order}");
        if order > 1 {
            assert!(lowest(&light) < -0.1 * peak, "order {order}: {}", lowest(&light) / peak);
        }
        if order > 2 {
            assert!(lowest(&apply_window(&hann(order, order as f64), &light)) < -1e-3 * peak);
        }
    }
}
