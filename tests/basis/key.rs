use crate::{project, within};
use ridgelight::basis::index;
use ridgelight::basis::slice::Slices;
use ridgelight::basis::zonal::clamped_cosine;
use ridgelight::scene::KeyLight;
use ridgelight_cpu::basis::azimuth::Blend;
use ridgelight_cpu::basis::key::{azimuths, nlp, visible, visible_nlp};
use ridgelight_cpu::basis::turned;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const KEY: KeyLight =
    KeyLight { azimuth_rad: 2.4, width_rad: 0.8, elevations_rad: [0.3, 0.9], radiance: [1.0; 3] };

fn free() -> Vec<f64> {
    project(4, [FRAC_PI_2 - 0.9, FRAC_PI_2 - 0.3], [2.0, 2.8], |_, _| 1.0)
}

/// Horizons below the light leave its whole rectangle, for any number of azimuths.
#[test]
fn a_free_light_is_its_rectangle() {
    for count in [2, 3, 9] {
        for blend in [Blend::Linear, Blend::BSpline] {
            let in_sight = visible(&KEY, &Slices::new(4), blend, &vec![0.1; count]);
            within(&in_sight, &free(), 1e-14);
        }
    }
    assert_eq!(azimuths(&KEY, 3), [2.0, 2.4, 2.8]);
}

/// A level horizon within it cuts it there; one above it leaves nothing, with NLP as well.
#[test]
fn a_horizon_cuts_the_light() {
    let slices = Slices::new(4);
    let cut = project(4, [FRAC_PI_2 - 0.9, FRAC_PI_2 - 0.6], [2.0, 2.8], |_, _| 1.0);
    within(&visible(&KEY, &slices, Blend::Linear, &[0.6; 3]), &cut, 1e-14);
    for horizon in [0.9, 1.2, FRAC_PI_2] {
        assert_eq!(visible(&KEY, &slices, Blend::Linear, &[horizon; 3]), [0.0; 16]);
        assert_eq!(visible_nlp(&KEY, 4, Blend::Linear, &[horizon; 3]), [0.0; 16]);
    }
    assert_eq!(nlp(&KEY, 4, -1.0), nlp(&KEY, 4, 0.3));
}

/// As one horizon rises the light never increases, and band 0 falls linearly with the slices' share.
#[test]
fn light_falls_as_a_horizon_rises() {
    let slices = Slices::new(4);
    let mut last = f64::INFINITY;
    for step in 0..40 {
        let horizon = 0.2 + 0.02 * f64::from(step);
        let solid = visible(&KEY, &slices, Blend::Linear, &[0.4, horizon, 0.7])[0];
        assert!(solid <= last + 1e-15, "{horizon}");
        last = solid;
    }
}

/// NLP agree with slices at even m, where they lose nothing (both are the same polynomials there).
#[test]
fn nlp_lose_nothing_zonal() {
    let horizons = [0.2, 0.5, 0.8];
    let exact = visible(&KEY, &Slices::new(4), Blend::Linear, &horizons);
    let by_nlp = visible_nlp(&KEY, 4, Blend::Linear, &horizons);
    for l in 0..4 {
        within(&[by_nlp[index(l, 0)]], &[exact[index(l, 0)]], 1e-14);
    }
    let apart = exact.iter().zip(&by_nlp).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart > 1e-4, "what NLP lose at odd m is visible: {apart}");
}

/// All around and from horizontal to the zenith it is the sky, whose cosine-weighted integral is π: the cosine's
/// odd bands end at 1, the half-sphere's even ones at 0, so two products, π/2 each, hold all of it.
#[test]
fn the_whole_sky_is_a_key_light() {
    let elevations_rad = [0.0, FRAC_PI_2];
    let whole = KeyLight { azimuth_rad: PI, width_rad: TAU, elevations_rad, ..KEY };
    let in_sight = visible(&whole, &Slices::new(6), Blend::Linear, &[-0.3; 9]);
    let sky = ridgelight_cpu::basis::sky(6);
    for l in 0..6 {
        within(&[in_sight[index(l, 0)]], &[sky[l]], 1e-13);
    }
    let cosine = turned(&clamped_cosine(6), glam::DVec3::Z);
    let exit: f64 = in_sight.iter().zip(&cosine).map(|(a, b)| a * b).sum::<f64>() / PI;
    within(&[exit], &[1.0], 1e-13);
}
