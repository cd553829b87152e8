use crate::{ORDERS, number, numbers, reference, same, within};
use ridgelight::basis::legendre::{associated, value};
use ridgelight::basis::quadrature::{integral, points};
use ridgelight_cpu::basis::nlp;
use ridgelight_cpu::basis::{occlusion, occlusion_polynomials};
use std::f64::consts::{FRAC_PI_2, SQRT_2};

/// ∫ from -1 to 1 of x^k is 2/(k+1) or 0, up to the degree that 32 points reach; not beyond.
#[test]
fn gauss_rule_is_exact_to_its_degree() {
    for k in 0..64 {
        let exact = if k % 2 == 0 { 2.0 / (k + 1) as f64 } else { 0.0 };
        within(&[integral(-1.0, 1.0, |x| x.powi(k))], &[exact], 4e-16 * exact.max(1.0));
    }
    assert!(
        (integral(-1.0, 1.0, |x| (9.0 * x).powi(64)) / 9f64.powi(64) - 2.0 / 65.0).abs() > 1e-19
    );
    // The fastest turn in use: ∫ from 0 to 2π of φ sin 5φ is -2π/5, of cos 5φ is 0.
    let turn = std::f64::consts::TAU;
    within(&[integral(0.0, turn, |x| x * (5.0 * x).sin())], &[-turn / 5.0], 1e-14);
    within(&[integral(0.0, turn, |x| (5.0 * x).cos())], &[0.0], 1e-14);
    assert_eq!(points(0.0, 1.0).count(), 32);
}

#[test]
fn occlusion_is_the_reference() {
    for entry in reference("nlp_occlusion").as_array().unwrap() {
        let (sin, cos) = number(&entry["sigma"]).sin_cos();
        let expected = numbers(&entry["order6"]);
        for order in ORDERS {
            same(&occlusion(order, sin, cos), &expected[..order]);
        }
    }
}

/// NS09 after eq. 13, as printed.
#[test]
fn occlusion_is_the_papers() {
    for sigma in [-1.1_f64, -0.2, 0.0, 0.4, 1.5] {
        let (s, c) = sigma.sin_cos();
        let printed = [
            (s + 1.0) / SQRT_2,
            -3.0 * c * c / (2.0 * 6_f64.sqrt()),
            -5.0 * s * c * c / (2.0 * 10_f64.sqrt()),
            7.0 * c * c * (-4.0 + 5.0 * c * c) / (8.0 * 14_f64.sqrt()),
        ];
        same(&occlusion(4, s, c), &printed);
    }
}

#[test]
fn nlp_are_orthonormal_and_occlusion_is_their_integral() {
    for i in 0..6 {
        for j in 0..6 {
            let dot = integral(-1.0, 1.0, |z| nlp(6, z)[i] * nlp(6, z)[j]);
            within(&[dot], &[f64::from(u8::from(i == j))], 1e-14);
        }
        for sigma in [-1.5, -0.7, 0.3, 1.4_f64] {
            let (sin, cos) = sigma.sin_cos();
            let direct = integral(-1.0, sin, |z| nlp(6, z)[i]);
            within(&[occlusion(6, sin, cos)[i]], &[direct], 1e-14);
        }
    }
}

/// Occlusion up to the zenith is complete: √2 and 0s; below the nadir it is 0. Near both the first number keeps its
/// digits: 1 + sin σ = 2 sin²((σ + π/2)/2).
#[test]
fn occlusion_at_its_ends() {
    let (sin, cos) = FRAC_PI_2.sin_cos();
    within(&occlusion(6, sin, cos), &[SQRT_2, 0.0, 0.0, 0.0, 0.0, 0.0], 1e-15);
    within(&occlusion(6, -sin, cos), &[0.0; 6], 1e-15);
    for above in [1e-7_f64, 1e-3] {
        let first = occlusion(1, -above.cos(), above.sin())[0];
        let exact = SQRT_2 * (0.5 * above).sin().powi(2);
        assert!((first - exact).abs() < 1e-12 * exact, "{first} {exact}");
    }
    assert!(occlusion_polynomials(1).is_empty());
}

/// ∫ Θ_lm Θ_km dz over [-1, 1] is 1 or 0; by z for even 2m.
#[test]
fn associated_functions_are_orthonormal() {
    for m in 0..6 {
        for (l, k) in (m..6).flat_map(|l| (m..6).map(move |k| (l, k))) {
            let (q, p) = (associated(l, m), associated(k, m));
            let dot =
                integral(-1.0, 1.0, |z| value(q, z) * value(p, z) * (1.0 - z * z).powi(m as i32));
            within(&[dot], &[f64::from(u8::from(l == k))], 1e-13);
        }
    }
}
