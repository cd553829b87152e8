use crate::{ORDERS, number, numbers, project, reference, same, within};
use ridgelight::basis::index;
use ridgelight::basis::quadrature::integral;
use ridgelight::basis::zonal::*;
use ridgelight_cpu::basis::nlp;
use ridgelight_cpu::basis::{cap, sky, sphere};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

#[test]
fn clamped_cosine_is_the_reference() {
    let expected = numbers(&reference("zh_clamped_cosine"));
    for order in ORDERS {
        same(&clamped_cosine(order), &expected[..order]);
    }
}

#[test]
fn caps_are_the_reference() {
    for entry in reference("zh_cap").as_array().unwrap() {
        let half = number(&entry["half_angle"]);
        let expected = numbers(&entry["zh"]);
        same(&cap(4, half), &expected);
        // Small discs keep their digits.
        if half < 0.1 {
            for (got, exact) in cap(4, half).iter().zip(expected) {
                assert!((got - exact).abs() < 1e-12 * exact);
            }
        }
    }
}

/// Thesis appendix A, as printed.
#[test]
fn caps_are_the_thesis() {
    for half in [0.05, 0.7, 1.9, 3.0_f64] {
        let c = half.cos();
        let printed = [
            -PI.sqrt() * (c - 1.0),
            0.5 * (3.0 * PI).sqrt() * half.sin().powi(2),
            -0.5 * (5.0 * PI).sqrt() * c * (c - 1.0) * (1.0 + c),
            -0.125 * (7.0 * PI).sqrt() * 2.0 * (c - 1.0) * (1.0 + c) * (5.0 * c * c - 1.0),
        ];
        same(&cap(4, half)[..3], &printed[..3]);
        let direct = TAU.sqrt() * integral(half.cos(), 1.0, |z| nlp(4, z)[3]);
        within(&[cap(4, half)[3]], &[direct], 1e-14);
    }
}

/// From a distance a sphere light is a point: its solid angle π (r/d)² times Y_l0(z); at 1e9 radii and more.
#[test]
fn a_distant_sphere_light_is_a_point() {
    for distance in [1e4_f64, 1e9, 1e150] {
        let solid_angle = PI / distance / distance;
        for (l, z) in sphere(6, 1.0, distance).iter().enumerate() {
            let point = solid_angle * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
            // 1 - cos a = a²/2 (1 - a²/12 …) and P_l'(cos a): relative l(l+1) a²/4 at most, 30/4.
            let tolerance = (7.5 / distance / distance + 1e-14) * point;
            assert!((z - point).abs() <= tolerance, "{distance}: {z:e} {point:e}");
        }
    }
    assert_eq!(sphere(3, 0.0, 0.0), [0.0; 3], "a point visible from nowhere");
    assert_eq!(sphere(3, 1.0, f64::INFINITY), [0.0; 3]);
}

/// Outside, sin a = r/d; on the surface half of all directions; inside all of them.
#[test]
fn a_sphere_light_around_its_receiver_is_the_whole_sphere() {
    same(&sphere(6, 2.0, 4.0), &cap(6, PI / 6.0));
    within(&sphere(6, 2.0, 2.0), &cap(6, FRAC_PI_2), 1e-15);
    for distance in [1.9999999, 1.0, 0.0] {
        let whole = sphere(6, 2.0, distance);
        within(&whole, &[2.0 * PI.sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0], 1e-15);
        within(&whole, &cap(6, PI), 1e-14);
    }
}

/// A flat diffuse receiver gets π sin²a from a disc at the zenith: the product of an order beyond the first three
/// bands has zeros there, and the series converges to it.
#[test]
fn a_disc_at_the_zenith_lights_by_its_sine_squared() {
    let half = 0.6_f64;
    let exact = PI * half.sin().powi(2);
    let lit: f64 = cap(6, half).iter().zip(clamped_cosine(6)).map(|(a, b)| a * b).sum();
    // The remainder: bands 6 and on, of |disc| ≤ √(2π(1-cos a)) and |cosine| beyond band 5, by Schwarz.
    let rest = 2.0 * PI / 3.0 - clamped_cosine(6).iter().map(|c| c * c).sum::<f64>();
    let disc = TAU * (1.0 - half.cos()) - cap(6, half).iter().map(|c| c * c).sum::<f64>();
    assert!((lit - exact).abs() <= (rest * disc).sqrt(), "{lit} {exact}");
    assert!((rest * disc).sqrt() < 0.1 * exact, "a bound that says something");
}

/// The sky against quadrature; all coefficients that are not zonal are 0.
#[test]
fn the_sky_is_the_upper_half() {
    let direct = project(4, [0.0, FRAC_PI_2], [0.0, TAU], |_, _| 1.0);
    for l in 0..4 {
        within(&[sky(4)[l]], &[direct[index(l, 0)]], 1e-14);
    }
}

/// Against quadrature in panels about the lobe's peak, exponents 0 to 1e4; of unit integral, and of 0: the
/// half-space's mean.
#[test]
fn phong_is_its_lobe() {
    for exponent in [0.0, 1.0, 2.5, 30.0, 1e4_f64] {
        let phong_specular = phong(6, exponent);
        within(&[phong_specular[0]], &[1.0 / (4.0 * PI).sqrt()], 1e-16);
        for (l, coefficient) in phong_specular.iter().enumerate() {
            let width = (8.0 / (exponent + 1.0).sqrt()).min(FRAC_PI_2);
            let direct: f64 = (0..8)
                .map(|i| {
                    let [a, b] = [i, i + 1].map(|k| width * f64::from(k) / 8.0);
                    integral(a, b, |t| {
                        t.sin() * (exponent + 1.0) * t.cos().powf(exponent) * nlp(6, t.cos())[l]
                    })
                })
                .sum();
            within(&[*coefficient], &[direct / TAU.sqrt()], 1e-12);
        }
    }
    // Exponent 1 is the cosine over π.
    let cosine: Vec<f64> = clamped_cosine(6).iter().map(|c| c / PI).collect();
    within(&phong(6, 1.0), &cosine, 1e-15);
}
