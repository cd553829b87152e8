//! Searches over models whose whole grid is known.

use super::*;
use ridgelight::basis::random::{STEP, mixed, unit};

/// Numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(STEP);
        unit(mixed(self.0))
    }
}

type Steps = Vec<Option<usize>>;

/// Every combination. The last ladder has no effect on the slowest step of the first, like fuses
/// under brute force.
fn grid(sides: &[usize]) -> Vec<Steps> {
    let mut all = vec![vec![]];
    for side in sides {
        all = (0..*side).flat_map(|s| all.iter().map(move |a| [&a[..], &[s]].concat())).collect();
    }
    let last = sides.len() - 1;
    all.retain(|a| a[0] + 1 < sides[0] || a[last] == 0);
    let idle = |a: &[usize], k: usize| k == last && a[0] + 1 == sides[0];
    all.iter()
        .map(|a| a.iter().enumerate().map(|(k, s)| (!idle(a, k)).then_some(*s)).collect())
        .collect()
}

/// Costs multiply and squared errors add, by steps of random size that never break the order.
fn monotone(sides: &[usize], random: &mut Random) -> impl Fn(&Steps) -> Value + use<> {
    let ladders: Vec<Vec<[f64; 2]>> = sides
        .iter()
        .map(|side| {
            let mut at = [1.0, 1.0];
            (0..*side)
                .map(|_| {
                    let here = at;
                    // A third of the steps change one of the two only.
                    let kind = random.next();
                    if kind > 0.17 {
                        at[0] *= 1.0 + 2.0 * random.next();
                    }
                    if kind < 0.83 {
                        at[1] *= 0.1 + 0.9 * random.next();
                    }
                    here
                })
                .collect()
        })
        .collect();
    move |steps| {
        // A ladder without effect costs nothing and has the error of its best step.
        let at = |(k, s): (usize, &Option<usize>)| s.map_or([1.0, 0.0], |s| ladders[k][s]);
        let each = || steps.iter().enumerate().map(at);
        // The first ladder's last step compensates for any step of the one without effect.
        let idle = steps.iter().any(Option::is_none);
        let factor: f64 = if idle { ladders.last().unwrap().last().unwrap()[0] } else { 1.0 };
        Value {
            cost: factor * each().map(|v| v[0]).product::<f64>(),
            error: each().map(|v| v[1] * v[1]).sum::<f64>().sqrt(),
        }
    }
}

/// Searches until nothing is open, or `most` places are measured.
fn walk(steps: &[Steps], model: impl Fn(&Steps) -> Value, floor: f64, most: usize) -> Search {
    let mut search = Search::new(steps.to_vec(), steps.len() / 2, floor);
    while let Some(place) = search.next().filter(|_| search.order().len() < most) {
        assert_eq!(search.value(place), None, "nothing is measured twice");
        search.measured(place, model(&steps[place]));
        let values: Vec<Value> = search.order().iter().map(|&i| search.value(i).unwrap()).collect();
        let of_all: Vec<usize> = frontier(&values).iter().map(|i| search.order()[*i]).collect();
        assert_eq!(search.frontier(), of_all, "the frontier of what was measured");
    }
    search
}

/// Every point of the whole grid's frontier is among the found values.
fn lost(steps: &[Steps], model: &impl Fn(&Steps) -> Value, floor: f64, search: &Search) -> usize {
    let all: Vec<Value> = steps
        .iter()
        .map(|s| {
            let value = model(s);
            Value { error: value.error.max(floor), ..value }
        })
        .collect();
    let found: Vec<Value> = search.frontier().iter().map(|&i| search.value(i).unwrap()).collect();
    let front = frontier(&all);
    front.iter().filter(|&&i| !found.iter().any(|f| f.covers(&all[i]))).count()
}

#[test]
fn pruning_loses_no_point_of_a_monotone_frontier() {
    let mut pruned = 0;
    for seed in 0..60 {
        let mut random = Random(seed);
        let sides = [&[4, 5, 3][..], &[3, 2, 6, 3], &[7], &[2, 2]][seed as usize % 4];
        let steps = grid(sides);
        let model = monotone(sides, &mut random);
        // With a floor that hides the most accurate third, and without.
        let floor = if seed % 2 == 0 { 0.0 } else { 0.4 };
        let search = walk(&steps, &model, floor, usize::MAX);
        assert_eq!(search.breaks(), [], "seed {seed}");
        assert_eq!(lost(&steps, &model, floor, &search), 0, "seed {seed}");
        for (place, value) in steps.iter().map(&model).enumerate() {
            match search.skip(place) {
                Some(Skip::Covered { by, slower_than, worse_than }) => {
                    let of = |i: usize| search.value(i).unwrap();
                    let error = worse_than.map_or(floor, |i| of(i).error);
                    // The reported reason is true: the bounds hold, and the covering place covers.
                    assert!(of(slower_than).cost <= value.cost && error <= value.error.max(floor));
                    assert!(of(by).cost <= value.cost && of(by).error <= value.error.max(floor));
                    pruned += 1;
                }
                Some(other) => panic!("{other:?}"),
                None => assert!(search.value(place).is_some()),
            }
        }
    }
    assert!(pruned > 300, "{pruned} places were ruled out");
}

/// Tests the check itself: it detects rules that lose a frontier point.
#[test]
fn a_lost_point_is_detected() {
    let sides = [4, 5, 3];
    let model = monotone(&sides, &mut Random(7));
    let steps = grid(&sides);
    let whole = walk(&steps, &model, 0.0, usize::MAX);
    assert!(whole.frontier().len() > 3);
    assert!(lost(&steps, &model, 0.0, &walk(&steps, &model, 0.0, 3)) > 0);
}

/// The first ladder's cost falls where it should rise, the second's error rises at its last step:
/// both are reported, bound nothing from then on, and the frontier is complete.
#[test]
fn a_broken_order_is_detected() {
    let sides = [3, 4, 3];
    let steps = grid(&sides);
    for seed in 0..20 {
        let right = monotone(&sides, &mut Random(100 + seed));
        let wrong = |steps: &Steps| {
            let value = right(steps);
            let first = steps[0].unwrap_or(0) as i32;
            let last = steps[1].unwrap_or(0) == 3;
            Value {
                cost: value.cost * 0.2_f64.powi(first),
                error: value.error * if last { 8.0 } else { 1.0 },
            }
        };
        let search = walk(&steps, wrong, 0.0, usize::MAX);
        let broken = |side, ladder| {
            search.breaks().iter().any(|b| b.side == side && b.ladders.contains(&ladder))
        };
        assert!(broken(Side::Cost, 0) && broken(Side::Error, 1), "seed {seed}");
        for found in search.breaks() {
            let [low, high] = [found.lower, found.higher].map(|i| search.value(i).unwrap());
            assert!(low.cost > high.cost || high.error > low.error, "seed {seed}: {found:?}");
        }
        assert_eq!(lost(&steps, &wrong, 0.0, &search), 0, "seed {seed}");
    }
}

/// On a grid of 1,152 places with realistic ladders, the first 45 give a frontier with small gaps:
/// no point of the whole frontier is better than a found one by more than a factor of 1.5 in both.
#[test]
fn a_short_search_is_close_to_the_whole_frontier() {
    let sides = [6, 4, 6, 8];
    let steps = grid(&sides);
    for seed in 0..10 {
        let model = monotone(&sides, &mut Random(1000 + seed));
        let search = walk(&steps, &model, 0.0, 45);
        let all: Vec<Value> = steps.iter().map(&model).collect();
        let missed = |v: &Value| {
            let found = search.frontier().iter().map(|&i| search.value(i).unwrap());
            found.map(|f| (f.cost / v.cost).max(f.error / v.error)).fold(f64::INFINITY, f64::min)
        };
        let worst = frontier(&all).iter().map(|&i| missed(&all[i])).fold(0.0, f64::max);
        assert!(worst < 1.5, "seed {seed}: {worst}");
    }
}

/// A place abandoned for its cost excludes slower ones, with that reason.
#[test]
fn a_place_too_slow_excludes_slower_ones() {
    let steps = grid(&[4, 4]);
    let mut search = Search::new(steps.clone(), 0, 0.0);
    let at = |a: usize, b: usize| {
        steps.iter().position(|s| s[0] == Some(a) && s[1].is_none_or(|s| s == b)).unwrap()
    };
    search.measured(at(0, 0), Value { cost: 1.0, error: 1.0 });
    search.give_up(at(1, 1), true);
    search.give_up(at(0, 1), false);
    assert_eq!(search.skip(at(2, 1)), Some(Skip::TooSlow { than: at(1, 1) }));
    assert_eq!(search.skip(at(3, 0)), Some(Skip::TooSlow { than: at(1, 1) }));
    assert!(!search.is_open(at(1, 1)) && search.is_open(at(0, 2)) && search.is_open(at(2, 0)));
}

/// A value corrected afterwards has the same result as if it had been first: frontier, breaks,
/// reasons.
#[test]
fn a_corrected_value_replaces_the_first() {
    let sides = [3, 4, 3];
    let steps = grid(&sides);
    for seed in 0..20 {
        let model = monotone(&sides, &mut Random(300 + seed));
        let mut right = walk(&steps, &model, 0.1, 9);
        let mut corrected = Search::new(steps.clone(), steps.len() / 2, 0.1);
        let wrong = right.order()[seed as usize % 9];
        for &place in right.order() {
            let value = model(&steps[place]);
            let share = if place == wrong { 0.01 } else { 1.0 };
            corrected.measured(place, Value { cost: share * value.cost, ..value });
        }
        for search in [&mut right, &mut corrected] {
            search.give_up(0, true);
        }
        assert_ne!(corrected.value(wrong), right.value(wrong));
        corrected.measured_again(wrong, model(&steps[wrong]));
        assert_eq!(corrected.order(), right.order());
        assert_eq!(corrected.frontier(), right.frontier());
        assert_eq!(corrected.breaks(), right.breaks());
        for place in 0..steps.len() {
            assert_eq!(corrected.value(place), right.value(place));
            assert_eq!(corrected.skip(place), right.skip(place));
        }
    }
}

/// A slow place where one ladder has no effect differs from a fast one in a single ladder, too. The
/// change in cost by that ladder is unknown, so the fast place's expectation comes from the start.
#[test]
fn expectations_use_measured_differences() {
    let steps = grid(&[3, 3, 3]);
    let at = |wanted: [Option<usize>; 3]| steps.iter().position(|s| s[..] == wanted).unwrap();
    let start = at([Some(1); 3]);
    let mut search = Search::new(steps.clone(), start, 0.0);
    for (place, cost, error) in [
        (start, 1.0, 1.0),
        (at([Some(1), Some(0), Some(1)]), 0.5, 2.0),
        (at([Some(1), Some(1), Some(0)]), 0.8, 1.5),
        (at([Some(2), Some(0), None]), 1000.0, 0.0),
    ] {
        search.measured(place, Value { cost, error });
    }
    let found = search.predicted(at([Some(1), Some(0), Some(0)]));
    assert!((found.cost - 0.4).abs() < 1e-12, "{found:?}");
    // 2² + 1.5² - 1².
    assert!((found.error - 5.25_f64.sqrt()).abs() < 1e-12, "{found:?}");
}
