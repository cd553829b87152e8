use crate::{ORDERS, directions, noise, within};
use glam::DVec3;
use ridgelight::basis::window::{hann, lanczos, nonnegative};
use ridgelight_cpu::basis::window::{apply, mildest};
use ridgelight_cpu::basis::{reconstruct, turned};
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
        let windowed = apply(&nonnegative(order), &light);
        assert!(lowest(&windowed) > -1e-14 * peak, "order {order}");
        if order > 1 {
            assert!(lowest(&light) < -0.1 * peak, "order {order}: {}", lowest(&light) / peak);
        }
        if order > 2 {
            assert!(lowest(&apply(&hann(order, order as f64), &light)) < -1e-3 * peak);
        }
    }
}

/// Lights of discs and points: the mildest window gives a lowest value of 0 where the series rings, and leaves the
/// series unchanged where it does not.
#[test]
fn the_mildest_window_just_reaches_0() {
    for order in 2..=6 {
        for seed in 0..6 {
            let places = noise(seed, 12);
            let mut light = vec![0.0; order * order];
            for place in places.chunks(3) {
                let towards = DVec3::from_slice(place).normalize();
                let disc =
                    turned(&ridgelight_cpu::basis::cap(order, 0.3 + place[0].abs()), towards);
                let sky = turned(&ridgelight_cpu::basis::sky(order), DVec3::Z);
                for (sum, (d, s)) in light.iter_mut().zip(disc.iter().zip(sky)) {
                    *sum += d + 0.01 * s;
                }
            }
            let rang = lowest(&light);
            let factors = mildest(&light);
            let left = lowest(&apply(&factors, &light));
            assert!(left > -1e-9, "order {order} seed {seed}: {left}");
            if rang < 0.0 {
                // 20000 directions stand 0.03 rad apart: near a minimum f'' 0.02²/2, f'' ≤ n² 4.
                assert!(left < 2e-4 * (order * order) as f64 * 4.0, "milder would do: {left}");
                assert!(factors[1] < 1.0);
            } else {
                within(&factors, &vec![1.0; order], 1e-9);
            }
        }
    }
}

/// A series that is negative on average gets the whole window.
#[test]
fn a_series_below_0_gets_the_whole_window() {
    let dark: Vec<f64> = point(4, DVec3::Z).iter().map(|c| -c).collect();
    within(&mildest(&dark), &nonnegative(4), 1e-15);
}
