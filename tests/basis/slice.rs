use crate::{ORDERS, nlp_value, within};
use ridgelight::basis::legendre::{associated, value};
use ridgelight::basis::quadrature::integral;
use ridgelight::basis::slice::{Slices, parts, slice_index};
use ridgelight_cpu::basis::{from_nlp, nlp, occlusion};
use std::f64::consts::{FRAC_PI_2, PI};

fn direct(l: usize, m: usize, low: f64, high: f64) -> f64 {
    let q = associated(l, m);
    integral(low, high, |w| value(q, w.sin()) * w.cos().powi(m as i32 + 1))
}

/// The slice of a function of elevation, smooth in θ, from its values at z.
fn project(order: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let part = |(l, m): (usize, usize)| {
        let q = associated(l, m);
        integral(0.0, PI, |theta| {
            let (sin, cos) = theta.sin_cos();
            f(cos) * value(q, cos) * sin.powi(m as i32 + 1)
        })
    };
    parts(order).map(part).collect()
}

#[test]
fn closed_forms_are_the_integrals() {
    let slices = Slices::new(6);
    for step in 0..=32 {
        let low = -FRAC_PI_2 + PI * f64::from(step) / 32.0;
        let above = slices.above(low);
        for (l, m) in parts(6) {
            let error = above[slice_index(l, m)] - direct(l, m, low, FRAC_PI_2);
            assert!(error.abs() < 2e-14, "l {l} m {m} {low}: {error:e}");
        }
        within(
            &slices.between(low, 0.4),
            &parts(6).map(|(l, m)| direct(l, m, low.min(0.4), 0.4)).collect::<Vec<_>>(),
            3e-14,
        );
    }
}

/// An order's parts are the first of the next order's, and at m = 0 they are the NLP coefficients.
#[test]
fn slices_hold_nlp_and_nest() {
    let all = Slices::new(6).above(0.3);
    for order in ORDERS {
        let some = Slices::new(order).above(0.3);
        assert_eq!(some, all[..some.len()]);
    }
    let (sin, cos) = 0.3_f64.sin_cos();
    let below = occlusion(6, sin, cos);
    for l in 0..6 {
        let whole = if l == 0 { 2.0_f64.sqrt() } else { 0.0 };
        within(&[all[slice_index(l, 0)]], &[whole - below[l]], 1e-14);
    }
}

/// A function that is a combination of NLP goes to its slice by `from_nlp` without loss.
#[test]
fn nlp_go_to_slices() {
    let coefficients = [0.3, -1.0, 0.7, 0.2, -0.4, 0.9];
    for order in ORDERS {
        let matrix = from_nlp(order);
        let by_matrix: Vec<f64> = matrix
            .iter()
            .map(|row| row.iter().zip(&coefficients).map(|(e, c)| e * c).sum())
            .collect();
        within(&by_matrix, &project(order, |z| nlp_value(&coefficients[..order], z)), 1e-14);
        for (l, m) in parts(order) {
            for (c, &entry) in matrix[slice_index(l, m)].iter().enumerate() {
                if m == 0 {
                    within(&[entry], &[f64::from(u8::from(l == c))], 1e-14);
                }
                // Even m: the integrand is a polynomial in z.
                if m % 2 == 0 {
                    let (p, q) = (associated(c, 0), associated(l, m));
                    let by_z = integral(-1.0, 1.0, |z| {
                        value(p, z) * value(q, z) * (1.0 - z * z).powi(m as i32 / 2)
                    });
                    within(&[entry], &[by_z], 1e-14);
                }
            }
        }
    }
}

/// ∫ P̂_0 Θ_11 dz = ∫ (√3/2) (1/√2) sin²θ dθ = (√3/2) (1/√2) π/2, by hand.
#[test]
fn an_odd_entry_is_known() {
    let exact = 3.0_f64.sqrt() / 2.0 / 2.0_f64.sqrt() * FRAC_PI_2;
    within(&[from_nlp(2)[slice_index(1, 1)][0]], &[exact], 1e-15);
    within(&[nlp(1, 0.2)[0]], &[0.5_f64.sqrt()], 1e-16);
}

/// The part of visibility in odd m that NLP of order n lose falls with the order (Θ_11's part).
#[test]
fn nlp_lose_part_of_odd_m_and_less_with_order() {
    let mut last = f64::INFINITY;
    for order in 2..=6 {
        let exact = Slices::new(order).above(0.5);
        let (sin, cos) = 0.5_f64.sin_cos();
        let mut visible: Vec<f64> = occlusion(order, sin, cos).iter().map(|b| -b).collect();
        visible[0] += 2.0_f64.sqrt();
        let row = &from_nlp(order)[slice_index(1, 1)];
        let lost =
            row.iter().zip(&visible).map(|(e, c)| e * c).sum::<f64>() - exact[slice_index(1, 1)];
        assert!(lost.abs() <= last, "order {order}: {lost}");
        last = lost.abs();
        if order == 2 {
            assert!(last > 1e-3, "the loss is visible: {last}");
        }
    }
}
