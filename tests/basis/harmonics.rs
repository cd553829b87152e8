use crate::within;
use crate::{
    ORDERS, direction, directions, noise, number, numbers, project_whole, reference, same,
};
use glam::{DQuat, DVec3};
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::{bands, index};
use ridgelight_cpu::basis::rotate_z;
use ridgelight_cpu::basis::{reconstruct, turned};
use std::f64::consts::PI;

#[test]
fn values_are_the_reference() {
    for entry in reference("sh_samples").as_array().unwrap() {
        let at = direction(number(&entry["theta"]), number(&entry["phi"]));
        same(&evaluate(4, at), &numbers(&entry["Y16"]));
    }
}

/// Band 5 at θ = 1.2, φ = 2.9 from its definition with 30 digits: sums of derivatives of P_5, no recurrence.
#[test]
fn the_highest_band_is_its_definition() {
    let expected = [
        0.431_608_699_616_287_33,
        -0.467_025_008_746_105_7,
        0.047_724_206_080_507_38,
        0.212_447_023_678_733_02,
        -0.048_096_676_988_238_17,
        0.292_192_458_154_195_17,
        0.195_193_279_712_497_56,
        -0.404_918_431_551_468_69,
        -0.053_891_742_142_454_9,
        0.322_552_559_470_544_8,
        -0.163_856_253_539_563_96,
    ];
    same(&evaluate(6, direction(1.2, 2.9))[25..], &expected);
}

/// Y_1 is √(3/4π) (y, z, x): no sign of Condon and Shortley.
#[test]
fn band_1_is_the_direction() {
    let e = DVec3::new(0.36, -0.48, 0.8);
    let scale = (0.75 / PI).sqrt();
    same(&evaluate(2, e)[1..], &[scale * e.y, scale * e.z, scale * e.x]);
}

#[test]
fn they_are_orthonormal() {
    for (l, m) in bands(6) {
        let i = index(l, m);
        let mut unit = [0.0; 36];
        unit[i] = 1.0;
        within(&project_whole(6, |t, p| evaluate(6, direction(t, p))[i]), &unit, 1e-14);
    }
}

/// Σ_m Y_lm² = (2l+1)/4π everywhere, the poles included.
#[test]
fn a_bands_squares_sum_to_a_constant() {
    for e in directions(50).chain([DVec3::Z, -DVec3::Z, DVec3::X]) {
        let values = evaluate(6, e);
        for l in 0..6 {
            let squares: f64 =
                (-(l as isize)..=l as isize).map(|m| values[index(l, m)].powi(2)).sum();
            same(&[squares], &[(2 * l + 1) as f64 / (4.0 * PI)]);
        }
    }
}

/// Parseval: ∫ f² is the sum of squares.
#[test]
fn the_integral_of_a_square_is_the_sum_of_squares() {
    let coefficients = noise(1, 36);
    let f = |t, p| reconstruct(&coefficients, direction(t, p));
    let whole = project_whole(1, |t, p| f(t, p).powi(2))[0] * (4.0 * PI).sqrt();
    same(&[whole], &[coefficients.iter().map(|c| c * c).sum()]);
}

#[test]
fn turning_about_z_turns_the_function() {
    let coefficients = noise(2, 36);
    for angle in [0.0, 0.3, -2.0, 9.0, PI] {
        let turned = rotate_z(&coefficients, angle);
        for e in directions(40) {
            let back = DQuat::from_rotation_z(-angle) * e;
            let error = reconstruct(&turned, e) - reconstruct(&coefficients, back);
            assert!(error.abs() < 1e-13, "{angle} {error}");
        }
    }
}

/// A zonal function about any axis is one of the angle to the axis: Σ z_l √((2l+1)/4π) P_l(axis·e), which about the
/// vertical is Σ z_l Y_l0. Its band norms do not change.
#[test]
fn a_turned_zonal_function_is_one_of_the_angle_to_its_axis() {
    for order in ORDERS {
        let zonal = noise(3, order);
        let mut upright = vec![0.0; order * order];
        (0..order).for_each(|l| upright[index(l, 0)] = zonal[l]);
        for axis in directions(12).chain([DVec3::Z, -DVec3::Z]) {
            let about = turned(&zonal, axis);
            for e in directions(20) {
                let same_angle = direction(axis.dot(e).clamp(-1.0, 1.0).acos(), 0.7);
                let error = reconstruct(&about, e) - reconstruct(&upright, same_angle);
                assert!(error.abs() < 1e-12, "{order} {axis} {error}");
            }
            for l in 0..order {
                let norm: f64 =
                    (-(l as isize)..=l as isize).map(|m| about[index(l, m)].powi(2)).sum();
                same(&[norm.sqrt()], &[zonal[l].abs()]);
            }
        }
        same(&turned(&zonal, DVec3::Z), &upright);
    }
}

#[test]
#[should_panic(expected = "order 7: 1 to 6")]
fn an_order_that_is_not_offered_is_named() {
    evaluate(7, DVec3::Z);
}
