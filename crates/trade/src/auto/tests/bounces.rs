//! Choices of bounces, with simulated paths around the quadrature's result.

use super::*;
use ridgelight::scene::{Albedo, BounceEngine, Bounces};
use ridgelight_cpu::indirect::{self, Fineness};

/// Two bounces of an albedo of 0.8, by the f64 quadrature; the simulated paths have a noise of 5 %
/// of it. Pictures are the ground truth except for the settings of bounces: omitted bounces lack
/// all their light, and azimuths leave 32nds / azimuths · 10 % of the second bounce's light. The
/// choice reaches the goal without noise and is faster than the defaults. A goal below the paths'
/// noise is refused, as is one that all bounces do not reach.
#[test]
fn choices_of_bounces_reach_the_goal() {
    let mut scene = scene();
    scene.surface.albedo = Albedo::Constant([0.8; 3]);
    let fineness = Fineness { azimuths: 32, divisions: 1, strips: 1 };
    let all = indirect::light(&scene, 2, fineness).unwrap();
    let lit = Lit::of(&scene);
    let direct: Vec<f64> = (0..SIDE * SIDE).map(|i| lit.at(i / SIDE, i % SIDE)[0]).collect();
    let bounced = |i: usize, count: usize| all[count][i][0] - all[0][i][0];
    let picture = |quality: &Quality| -> Vec<f32> {
        let drawn = quality.bounces.needed_bounces(f64::from(0.8_f32)) as usize;
        let error_share =
            3.2 / f64::from(quality.bounces.azimuths) * f64::from(u8::from(drawn > 0));
        (0..SIDE * SIDE)
            .map(|i| (direct[i] + bounced(i, drawn) + error_share * bounced(i, 1)) as f32)
            .collect()
    };
    let true_error = |quality: &Quality| {
        let ground_truth = |i: usize| direct[i] + bounced(i, 2);
        let squares = picture(quality)
            .iter()
            .enumerate()
            .map(|(i, p)| (f64::from(*p) - ground_truth(i)).powi(2))
            .sum::<f64>();
        (squares * (SIDE * SIDE) as f64).sqrt() / (0..SIDE * SIDE).map(ground_truth).sum::<f64>()
    };
    let cost = |quality: &Quality| {
        let Bounces { azimuths, .. } = quality.bounces;
        let drawn = quality.bounces.needed_bounces(f64::from(0.8_f32));
        1e6 * f64::from(quality.azimuths) + 1e6 * f64::from(drawn * azimuths)
    };
    let found = |most: f64, noise: f64| {
        let mut batches_used = Vec::new();
        let mut trace = |places: &[usize], batches: u32, seed: u32| {
            batches_used.push(batches);
            let error = noise / f64::from(batches).sqrt();
            let of = |(k, i): (usize, &usize)| {
                let turn = (f64::from(seed % 1009) + 1.0) * (k as f64 + 1.0) * 2.399_963;
                // A sine of evenly spread phases has the variance ½.
                let mean = bounced(*i, 2) * (1.0 + error * std::f64::consts::SQRT_2 * turn.sin());
                Traced { mean: [mean; 3], standard_error: [bounced(*i, 2) * error; 3] }
            };
            Ok(places.iter().enumerate().map(of).collect())
        };
        let bounced = Some(Bounced { count: 2, trace: &mut trace });
        let found = choose(&Lit::of(&scene), Goal::MaxError(most), WHOLE, bounced, |quality, _| {
            let mut ns = vec![("sky_shade".to_owned(), 1e6 * f64::from(quality.azimuths))];
            ns.push(("bounce_walk bounce1".to_owned(), cost(quality) - ns[0].1));
            Ok(Drawn { planes: vec![picture(quality)], passes: ns })
        });
        (found, batches_used)
    };
    for most in [0.05, 0.02] {
        let (chosen, batches_used) = found(most, 0.05);
        let chosen = chosen.unwrap();
        let Trial { quality, measured, .. } = chosen.trial;
        assert!(measured.at_most <= most, "{most}: {measured:?}");
        assert!(true_error(&quality) <= most, "{most}: {} of {quality:?}", true_error(&quality));
        let bounces = Bounces { count: 2, ..Bounces::default() };
        assert!(cost(&quality) < cost(&Quality { bounces, ..Quality::default() }));
        // The last count is that of the probes that measured the choice.
        let last = batches_used[batches_used.len() - 1];
        assert_eq!(chosen.paths, last * ridgelight::plan::REFERENCE_BATCH);
        assert!(batches_used.iter().all(|batches| (8..=256).contains(batches)), "{batches_used:?}");
        let azimuths: Vec<u32> = chosen.trials.iter().map(|t| t.quality.bounces.azimuths).collect();
        assert!(azimuths.iter().any(|a| *a != azimuths[0]), "{azimuths:?}");
        let text = flags(&quality, &scene);
        assert!(text.contains("`bounces 2` `bounce_engine"), "{text}");
    }
    // Ten times the bounced light: with 256 batches 60 % of each texel remain.
    let refused = found(0.001, 10.0).0.unwrap_err().to_string();
    let said = "a goal of 0.00100: needs bounced light of that precision";
    assert!(refused.contains(said), "{refused}");
    assert!(refused.contains("16384 paths from each of 144 texels"), "{refused}");
    // 128 azimuths leave 2.5 % of the first bounce.
    let refused = found(1e-4, 0.0).0.unwrap_err().to_string();
    assert!(refused.contains("nearest found"), "{refused}");
}

/// A goal that all settings are expected to reach: exact horizons are the last resort, and with
/// bounces every texel's own visibility, although every second texel and averages of the surface
/// are faster.
#[test]
fn the_last_resort_uses_exact_visibility() {
    let mut scene = scene();
    scene.surface.albedo = Albedo::Constant([0.8; 3]);
    let statistics = Statistics::of(&scene);
    for count in [0, 2] {
        let chooser = Chooser::new(&scene, &statistics, Goal::MaxError(1e6), count);
        let quality = chooser.last_resort(true).unwrap();
        let all = crate::auto::candidates::candidates(&scene, count);
        let exact = all.iter().filter(|q| crate::auto::candidates::is_exact(q));
        let faster = exact.filter(|q| chooser.cost(q) < chooser.cost(&quality));
        if count == 0 {
            assert_eq!(faster.count(), 0);
            continue;
        }
        let is_mean = |q: &Quality| q.subsample > 1 || q.bounces.engine == BounceEngine::Pyramid;
        assert!(!is_mean(&quality), "{quality:?}");
        assert!(faster.filter(|q| is_mean(q)).count() > 0, "averages are no faster");
    }
}

/// Candidates of bounces are valid and none occurs twice; with few bounces no two energies omit the
/// same ones.
#[test]
fn candidates_are_distinct() {
    let mut scene = scene();
    for (albedo, bounces, cutoffs) in [(0.8, 1, 1), (0.3, 4, 3), (0.01, 2, 3)] {
        scene.surface.albedo = Albedo::Constant([albedo; 3]);
        let all = crate::auto::candidates::candidates(&scene, bounces);
        let mut energies: Vec<f64> = all.iter().map(|q| q.bounces.cutoff).collect();
        energies.sort_by(f64::total_cmp);
        energies.dedup();
        assert_eq!(energies.len(), cutoffs, "{energies:?}");
        for (i, quality) in all.iter().enumerate() {
            quality.check().unwrap();
            assert_eq!(quality.bounces.count, bounces);
            assert!(!all[..i].contains(quality), "{quality:?}");
        }
    }
}
