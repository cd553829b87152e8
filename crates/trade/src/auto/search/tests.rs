use super::*;
use crate::auto::tests::under_sky;

/// The texels that confirm a choice are the requested ones; where more are wanted, also some of a new seed; or all texels, each
/// once.
#[test]
fn requested_texels_confirm_the_choice() {
    let scene = under_sky(8, 10);
    let unsure: Vec<f64> = (0..80).map(|i| f64::from(i % 7)).collect();
    OracleLight::with(&Lit::of(&scene), |oracle| {
        let of = |count: usize, seed: u64| Probes::by(oracle, count, seed, &unsure).unwrap();
        let goal = Goal::MaxError(0.1);
        let mut judge = Judge::new(oracle, (20, 3), unsure.clone(), None, goal).unwrap();
        let requested = judge.request(16).unwrap();
        assert_ne!(of(20, requested.seed).places(), judge.probes.places());
        let own = of(16, requested.seed);
        assert_eq!(judge.confirming(requested, 16).unwrap().places(), own.places());
        let more = judge.confirming(requested, 24).unwrap();
        let others = of(8, judge.seed);
        assert_eq!(more.places(), [own.places(), others.places()].concat());
        assert_ne!(others.places(), of(8, requested.seed).places());
        let all = judge.confirming(requested, 80).unwrap();
        assert_eq!(all.places(), (0..80).collect::<Vec<usize>>());
    });
}

/// With 3000 probes the bound's square lies 3e-4 above the error's, and so does the square of 2 %, halfway to a goal of 3 %.
/// The square of half the way to the second goal lies half as far above: four times the probes. A goal far away takes
/// the fewest, one as near as the bound all.
#[test]
fn the_distance_to_the_goal_decides_how_many_probes_confirm() {
    let measured = Measured { error: 0.01, at_most: 0.02 };
    let expected = Expected { error: 0.005, factor: 1.9 };
    let most = 30_000;
    let count = |measured: Measured, goal: Goal| {
        confirming_count(measured, 3000, (goal, expected), Probes::ONE_BOUND, most)
    };
    assert_eq!(count(measured, Goal::MaxError(0.03)), 3000);
    let nearer = count(measured, Goal::MaxError(2.0 * 2.5e-4_f64.sqrt() - 0.01));
    // Rounded up.
    assert!((12_000..=12_001).contains(&nearer), "{nearer}");
    assert_eq!(count(measured, Goal::MaxError(0.5)), FEWEST_CONFIRMING);
    assert_eq!(count(measured, Goal::MaxError(0.0101)), most);
    assert_eq!(count(measured, Goal::MaxCost(1.0)), most);
    let sure = Measured { error: 0.01, at_most: 0.0101 };
    assert_eq!(count(sure, Goal::MaxCost(1.0)), FEWEST_CONFIRMING);
    // More was expected: the earlier probes may have missed texels.
    let more = Expected { factor: 2.1, ..expected };
    let all = |goal| confirming_count(sure, 3000, (goal, more), Probes::ONE_BOUND, most);
    assert_eq!(all(Goal::MaxCost(1.0)), most);
    assert_eq!(all(Goal::MaxError(0.0104)), most);
    assert_eq!(all(Goal::MaxError(0.5)), FEWEST_CONFIRMING);
    // Where nothing differs, or nothing is known.
    assert_eq!(count(Measured { error: 0.0, at_most: 0.0 }, Goal::MaxCost(1.0)), most);
    assert_eq!(count(Measured::UNKNOWN, Goal::MaxError(0.1)), most);
}
