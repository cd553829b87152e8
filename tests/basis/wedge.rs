use crate::{number, numbers, project, reference, same, within};
use ridgelight::basis::slice::Slices;
use ridgelight::basis::wedge::{WedgeTable, wedge};
use ridgelight::basis::{bands, index};
use ridgelight_cpu::basis::azimuth::{Blend, assemble, swath};
use ridgelight_cpu::basis::rotate_z;
use ridgelight_cpu::basis::wedge::look_up;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Bound on the error of [`look_up`] against [`wedge`] in a coefficient of band `l`.
///
/// With spacing h, linear interpolation of each of the two horizons errs by h²/8 of the second
/// derivative. The wedge is ∫ Φ_m G((1-t) ω_a + t ω_b) dφ with G' = -Θ_lm cos ω, so that derivative
/// is ∫ Φ_m t² G'' dφ: Δφ/3 · max|Φ_m| · max|G''|. Θ_lm cos ω is a trigonometric polynomial of degree
/// l+1 that does not pass max|Θ_lm|, so by Bernstein |G''| ≤ (l+1) max|Θ_lm|; and by the addition
/// theorem max|Θ_lm| max|Φ_m| ≤ √((2l+1)/4π).
fn look_up_error(table: &WedgeTable, l: usize) -> f64 {
    let spacing = (FRAC_PI_2 - table.lowest_rad) / (table.side - 1) as f64;
    let steepest = (l + 1) as f64 * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
    spacing * spacing / 8.0 * 2.0 * table.width_rad / 3.0 * steepest
}

#[test]
fn wedges_are_the_reference() {
    for entry in reference("sn08_wedge").as_array().unwrap() {
        let horizon = [number(&entry["omega_l"]), number(&entry["omega_r"])];
        let got = wedge(&Slices::new(4), horizon, number(&entry["delta_phi"]));
        same(&got, &numbers(&entry["sh16"]));
    }
}

/// Direct integration over the wedge: θ from 0 to the horizon's, which moves with φ, in a variable u of [0..1].
#[test]
fn wedges_are_their_integrals() {
    let slices = Slices::new(6);
    for (horizon, width) in [
        ([0.2, 0.7], 0.3),
        ([-FRAC_PI_2, FRAC_PI_2], FRAC_PI_2),
        ([1.5, -1.0], 0.05),
        ([0.0, 0.0], TAU),
    ] {
        let mut direct = [0.0; 36];
        let parts = 4;
        for i in 0..parts {
            let phi = [i, i + 1].map(|k| width * f64::from(k) / f64::from(parts));
            let part = ridgelight::basis::quadrature::points(phi[0], phi[1])
                .map(|(p, weight)| {
                    let top = FRAC_PI_2 - horizon[0] - (horizon[1] - horizon[0]) * p / width;
                    let mut line = vec![0.0; 36];
                    for (t, w) in ridgelight::basis::quadrature::points(0.0, top) {
                        let y = ridgelight::basis::harmonics::evaluate(6, crate::direction(t, p));
                        line.iter_mut().zip(y).for_each(|(s, y)| *s += weight * w * t.sin() * y);
                    }
                    line
                })
                .fold(vec![0.0; 36], |a, b| a.iter().zip(b).map(|(x, y)| x + y).collect());
            direct.iter_mut().zip(part).for_each(|(d, p)| *d += p);
        }
        within(&wedge(&slices, horizon, width), &direct, 1e-13);
    }
    // A level horizon is a patch of the sphere.
    let patch = project(6, [0.0, FRAC_PI_2 - 0.4], [0.0, 0.8], |_, _| 1.0);
    within(&wedge(&slices, [0.4, 0.4], 0.8), &patch, 1e-13);
}

/// m wedges under a level horizon are the cap about z.
#[test]
fn wedges_all_around_are_a_cap() {
    for (order, count, elevation) in [(4, 32, 0.25), (6, 5, -0.8), (3, 1, 0.0)] {
        let width = TAU / f64::from(count);
        let one = wedge(&Slices::new(order), [elevation; 2], width);
        let mut sum = vec![0.0; order * order];
        for k in 0..count {
            let turned = rotate_z(&one, width * f64::from(k));
            sum.iter_mut().zip(turned).for_each(|(s, t)| *s += t);
        }
        let cap = ridgelight_cpu::basis::cap(order, FRAC_PI_2 - elevation);
        let expected: Vec<f64> =
            bands(order).map(|(l, m)| if m == 0 { cap[l] } else { 0.0 }).collect();
        within(&sum, &expected, 1e-13);
        assert_eq!(expected[index(0, 0)], cap[0]);
    }
}

/// At the table's own horizons the look-up is the wedge; between them it errs by less than the formula,
/// and by a quarter with half the spacing. Both spans, worst over a grid that avoids the nodes.
#[test]
fn a_tables_error_falls_with_the_square_of_its_spacing() {
    let (order, width) = (4, TAU / 32.0);
    let slices = Slices::new(order);
    for lowest in [0.0, -FRAC_PI_2] {
        let mut worst = Vec::new();
        for side in [9, 17, 33] {
            let table = WedgeTable::new(order, side, lowest, width);
            let node = lowest + (FRAC_PI_2 - lowest) * 3.0 / (side - 1) as f64;
            within(&look_up(&table, [node, lowest]), &wedge(&slices, [node, lowest], width), 1e-15);
            within(
                &look_up(&table, [9.0, -9.0]),
                &wedge(&slices, [FRAC_PI_2, lowest], width),
                1e-15,
            );
            let mut errors = vec![0.0_f64; order];
            let places = 61;
            for i in 0..places * places {
                let horizon = [i / places, i % places].map(|k| {
                    lowest + (FRAC_PI_2 - lowest) * (f64::from(k) + 0.37) / f64::from(places)
                });
                let exact = wedge(&slices, horizon, width);
                for ((l, m), got) in bands(order).zip(look_up(&table, horizon)) {
                    errors[l] = errors[l].max((got - exact[index(l, m)]).abs());
                }
            }
            for (l, error) in errors.iter().enumerate() {
                let most = look_up_error(&table, l);
                assert!(*error <= most, "side {side} band {l}: {error:e} of {most:e}");
                assert!(*error >= 0.02 * most, "a formula far too wide: {error:e} of {most:e}");
            }
            println!("lowest {lowest:.2} side {side}: worst by band {errors:?}");
            worst.push(errors[order - 1]);
        }
        for pair in worst.windows(2) {
            assert!((3.0..5.5).contains(&(pair[0] / pair[1])), "{worst:?}");
        }
    }
}

/// Wedges blend angles, slices blend visibility: both converge with the square of the wedge's width.
#[test]
fn wedges_and_slices_meet_as_azimuths_grow() {
    let order = 4;
    let slices = Slices::new(order);
    let horizon = |phi: f64| 0.5 + 0.3 * (2.0 * phi).cos();
    let apart = |count: usize| {
        let width = TAU / count as f64;
        let visible: Vec<_> =
            (0..=count).map(|k| slices.above(horizon(width * k as f64))).collect();
        let blended = assemble(order, &swath(order, Blend::Linear, 0.0, TAU, count + 1), &visible);
        let mut summed = [0.0; 16];
        for k in 0..count {
            let phi = width * k as f64;
            let one = wedge(&slices, [horizon(phi), horizon(phi + width)], width);
            summed.iter_mut().zip(rotate_z(&one, phi)).for_each(|(s, t)| *s += t);
        }
        blended.iter().zip(summed).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (apart(16), apart(32));
    assert!((3.5..4.5).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
}
