//! Choices on a small field whose pictures the oracle draws: no device, and costs that are made up.

use super::*;
use crate::cpu::{light, oracle::Oracle};
use crate::scene::{HeightField, Lights, Lines, Method, Quality, Scene, Surface};
use crate::{Error, Result};

const SIDE: usize = 12;

/// Two peaks under a uniform sky.
fn scene() -> Scene {
    let height = |i: usize| {
        let (r, c) = ((i / SIDE) as f64, (i % SIDE) as f64);
        let peak = |y: f64, x: f64, h: f64| (h - (r - y).hypot(c - x)).max(0.0);
        peak(4.0, 3.0, 5.0).max(peak(8.0, 9.0, 4.0))
    };
    let heights: Vec<f64> = (0..SIDE * SIDE).map(height).collect();
    Scene {
        field: HeightField::new(SIDE, SIDE, &heights, [1.0; 2], None).unwrap(),
        surface: Surface::default(),
        lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
    }
}

/// The sky in so many azimuths, a millisecond each: nothing else changes the picture.
fn draw(scene: &Scene, quality: &Quality) -> Result<Drawn> {
    let oracle = Oracle::new(&scene.field, scene.surface.border);
    let at =
        |i: usize| light::sky_of(&oracle, i / SIDE, i % SIDE, quality.azimuths as usize) as f32;
    let ns = 1e6 * f64::from(quality.azimuths);
    Ok(Drawn {
        planes: vec![(0..SIDE * SIDE).map(at).collect()],
        passes: vec![("sky_shade".to_owned(), ns)],
    })
}

/// Every sample is a probe; any seed.
const WHOLE: (usize, u64) = (SIDE * SIDE, 7);

fn whole(scene: &Scene) -> Probes {
    Probes::of(scene, SIDE * SIDE, 7, &[]).unwrap()
}

fn chosen(goal: Goal) -> Result<Chosen> {
    let scene = scene();
    choose(&scene, goal, WHOLE, |quality| draw(&scene, quality))
}

/// All samples are probed, so that nothing is left to chance: what is chosen holds, and half of its
/// azimuths would not.
#[test]
fn the_cheapest_that_holds_is_chosen() {
    let scene = scene();
    let probes = whole(&scene);
    for most in [0.02, 0.003] {
        let found = chosen(Goal::MaxError(most)).unwrap();
        let Trial { quality, measured, .. } = found.trial;
        assert!(measured.at_most <= most, "{measured:?}");
        assert!(found.expected.error > 0.0 && found.expected.factor >= 1.0);
        let half = Quality { azimuths: quality.azimuths / 2, ..quality };
        if half.azimuths >= 8 {
            let off = probes.error(&draw(&scene, &half).unwrap().planes, None);
            assert!(off.error > most, "{off:?} by half of {quality:?}");
        }
    }
}

#[test]
fn what_nothing_reaches_is_refused() {
    for (goal, says) in [
        (Goal::MaxError(1e-12), ["--max-error 0.000000000001: needs finer", "nearest found"]),
        (Goal::MaxCost(1e6), ["--time-budget 1: needs 8.00 ms", "the limit is 1 ms"]),
    ] {
        let error = chosen(goal).unwrap_err();
        assert!(matches!(error, Error::Limit { .. }), "{error}");
        let text = error.to_string();
        assert!(says.iter().all(|s| text.contains(s)), "{text}");
    }
    for goal in [Goal::MaxError(0.0), Goal::MaxError(f64::NAN), Goal::MaxCost(-1.0)] {
        assert!(matches!(chosen(goal).unwrap_err(), Error::Setting { .. }));
    }
    // A device's own refusal is not one of settings.
    let broken = choose(&scene(), Goal::MaxError(0.1), WHOLE, |_| {
        Err(Error::Device { doing: "drawing".into(), reason: "lost".into() })
    });
    assert!(broken.unwrap_err().to_string().contains("lost"));
}

/// 16 azimuths take 16 ms, 24 take 24: of 20 ms the most is made by 16. A memory that holds no more
/// than 12 azimuths leaves those.
#[test]
fn a_time_budget_is_kept() {
    let found = chosen(Goal::MaxCost(20e6)).unwrap();
    assert!(found.trial.ns <= 20e6);
    assert_eq!(found.trial.quality.azimuths, 16, "{found:?}");
    let scene = scene();
    let full = || Error::Limit { what: "".into(), needs: "".into(), limit: "".into() };
    let small = choose(&scene, Goal::MaxCost(20e6), WHOLE, |quality| {
        if quality.azimuths > 12 { Err(full()) } else { draw(&scene, quality) }
    });
    assert_eq!(small.unwrap().trial.quality.azimuths, 12);
}

/// Finer settings are never expected to be less accurate or cheaper; a measured error moves its own
/// expectation most of the way and makes it surer.
#[test]
fn expectations_are_monotone_and_learn() {
    let scene = scene();
    let statistics = Statistics::of(&scene);
    let mut model = Model::of(&scene, &statistics);
    let costs = Costs::guessed(SIDE * SIDE);
    let of = |azimuths: u32| Quality { azimuths, ..Quality::default() };
    for [few, many] in [[8, 16], [64, 128], [512, 1024]] {
        let [rough, fine] = [few, many].map(|a| model.expected(&of(a)).error);
        assert!(rough >= fine && fine > 0.0 && rough < 2.0, "{rough} {fine}");
        assert!(costs.expected_ns(&scene, &of(few)) < costs.expected_ns(&scene, &of(many)));
    }
    let before = model.expected(&of(16));
    let told = 3.0 * before.error;
    model.learn(&of(16), told, 0.01);
    let after = model.expected(&of(16));
    assert!((after.error / told).ln().abs() < 0.3, "{before:?} {after:?}");
    assert!(after.factor < before.factor);
}

/// 64 azimuths are 0.075 % off, 8 azimuths along lines four cells apart 1.3 % (as two peaks were): no
/// azimuths of the model are then thought worse than what was measured of fewer, and exact horizons in
/// 1024 azimuths still better than 64 were.
#[test]
fn one_bad_frame_does_not_spoil_the_others() {
    let scene = scene();
    let mut model = Model::of(&scene, &Statistics::of(&scene));
    let rough = Quality { azimuths: 8, lines: Lines::FourCells, ..Quality::default() };
    model.learn(&Quality::default(), 0.00075, 0.0);
    model.learn(&rough, 0.0133, 0.0);
    assert!((model.expected(&rough).error / 0.0133).ln().abs() < 0.3, "{model:?}");
    let fine = Quality { azimuths: 1024, method: Method::Brute, ..Quality::default() };
    assert!(model.expected(&fine).error < 0.00075, "{model:?}");
}

/// Of a picture a tenth too bright everywhere: RMSE a tenth of the root mean square of the light. By 64
/// of 144 probes the control leaves less to chance, and does not move the estimate beyond its bound.
#[test]
fn probes_see_a_wrong_picture_and_controls_help() {
    let scene = scene();
    let all = whole(&scene);
    let right = draw(&scene, &Quality { azimuths: 720, ..Quality::default() }).unwrap().planes;
    assert!(all.error(&right, None).at_most < 1e-6);
    let bright: Vec<f32> = right[0].iter().map(|v| 1.1 * v).collect();
    let mean = right[0].iter().sum::<f32>() / right[0].len() as f32;
    let square = right[0].iter().map(|v| v * v).sum::<f32>() / right[0].len() as f32;
    let expected = f64::from(0.1 * square.sqrt() / mean);
    let seen = all.error(std::slice::from_ref(&bright), None);
    assert!((seen.error / expected - 1.0).abs() < 1e-3, "{seen:?} {expected}");
    let few = Probes::of(&scene, 64, 1, &[]).unwrap();
    assert_eq!(few.len(), 64);
    let rough = draw(&scene, &Quality { azimuths: 8, ..Quality::default() }).unwrap().planes;
    let truth = all.error(&rough, None).error;
    let [alone, helped] = [None, Some(right.as_slice())].map(|c| few.error(&rough, c));
    assert!(alone.at_most > alone.error && truth <= alone.at_most, "{alone:?} {truth}");
    assert!((helped.error / truth - 1.0).abs() < 1e-3, "{helped:?} {truth}");
    assert!(helped.at_most - helped.error < 0.1 * (alone.at_most - alone.error));
    // A colour that is off is seen beside grey light.
    let blue = vec![right[0].clone(), right[0].clone(), bright];
    let seen = all.error(&blue, None).error;
    assert!((seen / expected * 3.0_f64.sqrt() - 1.0).abs() < 1e-3, "{seen}");
}
