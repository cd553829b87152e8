//! The order of directions along paths.

use glam::DVec3;

use crate::basis::random::{STEP, mixed, unit};
use crate::scene::Scatter;

/// The direction of each path at each of its steps, path after path.
///
/// At every step each direction occurs once before any is repeated, and is equally likely at every place, independently for
/// every step: that makes the mean of paths unbiased. The order of the first step is even over the sphere in every part.
/// Those of later steps are even too but shuffled, as they must be independent of the first. A path's directions depend
/// on its number only, not on which other paths are computed.
pub(super) fn order(directions: &[DVec3], scatter: &Scatter, paths: u32, steps: u32) -> Vec<u32> {
    let (count, first_path) = (directions.len(), scatter.first_path as usize);
    let paths = first_path..first_path + paths as usize;
    let mut all = vec![0; paths.len() * steps as usize];
    for step in 0..steps as usize {
        for cycle in paths.start / count..paths.end.div_ceil(count) {
            let mut random = Random::new(scatter.seed, step as u64, cycle as u64);
            let list: Vec<u32> = (0..count as u32).collect();
            let mut part = spread(directions, list, &mut random);
            if step > 0 {
                // Fisher & Yates.
                for at in 0..part.len() {
                    let left = (part.len() - at) as f64;
                    part.swap(at, at + (random.next() * left) as usize);
                }
            }
            for (path, i) in (cycle * count..).zip(part).filter(|(path, _)| paths.contains(path)) {
                all[(path - paths.start) * steps as usize + step] = i;
            }
        }
    }
    all
}

/// Directions in an order whose every beginning is even over the sphere.
///
/// The list is halved across its widest extent, and each half is ordered in the same way. Of halves of l and r, with
/// n = l + r, the j-th is of the first where ⌊(j + 1) l/n + u⌋ exceeds ⌊j l/n + u⌋, u uniform in [0..1): l of n in all,
/// and l/n of all u at every j, so each direction is equally likely at every place.
fn spread(directions: &[DVec3], mut list: Vec<u32>, random: &mut Random) -> Vec<u32> {
    let count = list.len();
    if count < 2 {
        return list;
    }
    let of = |i: &u32, axis: usize| directions[*i as usize][axis];
    let extent = |axis: usize| {
        let ends = list.iter().map(|i| of(i, axis));
        let (low, high) = ends.fold((f64::MAX, f64::MIN), |(l, h), v| (v.min(l), v.max(h)));
        high - low
    };
    let widest = (0..3).max_by(|a, b| extent(*a).total_cmp(&extent(*b))).expect("three axes");
    list.sort_by(|a, b| of(a, widest).total_cmp(&of(b, widest)));
    let right = list.split_off(count / 2);
    let share = list.len() as f64 / count as f64;
    let offset = random.next();
    let [left, right] = [list, right].map(|half| spread(directions, half, random));
    let (mut left, mut right) = (left.into_iter(), right.into_iter());
    let upto = |j: usize| (j as f64 * share + offset).floor();
    let next = |j: usize| {
        let halves =
            if upto(j + 1) > upto(j) { [&mut left, &mut right] } else { [&mut right, &mut left] };
        // If rounding takes one half too often, the other supplies the rest.
        halves.into_iter().find_map(Iterator::next).expect("as many as both halves")
    };
    (0..count).map(next).collect()
}

/// Uniform random numbers in [0..1), determined by seed, step and cycle: splitmix64 (Steele, Lea & Flood 2014).
struct Random(u64);

impl Random {
    fn new(seed: u32, step: u64, cycle: u64) -> Self {
        let mut random = Self(u64::from(seed) << 32 ^ step << 16 ^ cycle);
        // Consecutive seeds become states far apart.
        random.0 = random.word();
        random
    }

    fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        mixed(self.0)
    }

    fn next(&mut self) -> f64 {
        unit(self.word())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Directions;

    /// Each direction occurs once per cycle, at every step, and equally often in any place, over seeds: 13 directions in 5,200
    /// orders 400 times each, within five standard deviations of √400.
    #[test]
    fn directions_are_equally_likely_everywhere() {
        let directions = Directions::fibonacci(13, -1.0, 0).expect("directions");
        let mut found = vec![[0_u32; 13]; 2 * 20];
        for seed in 0..5200 {
            let scatter = Scatter { paths: 20, seed, ..Scatter::default() };
            let order = order(directions.vectors(), &scatter, 20, 2);
            for (place, i) in order.iter().enumerate() {
                found[place][*i as usize] += 1;
            }
            for step in 0..2 {
                let mut cycle: Vec<u32> = (0..13).map(|path| order[2 * path + step]).collect();
                cycle.sort_unstable();
                assert!(cycle.into_iter().eq(0..13), "{seed} {step}");
            }
        }
        for (place, counts) in found.iter().enumerate() {
            assert!(counts.iter().all(|n| n.abs_diff(400) <= 100), "{place}: {counts:?}");
        }
    }

    /// Paths 5 to 40 of 13 directions equal those of all 45, computed in parts or at once.
    #[test]
    fn a_path_does_not_depend_on_the_others_computed() {
        let directions = Directions::fibonacci(13, -1.0, 0).expect("directions");
        let of = |first_path, paths| {
            let scatter = Scatter { first_path, ..Scatter::default() };
            order(directions.vectors(), &scatter, paths, 3)
        };
        let all = of(0, 45);
        let parts = [of(0, 5), of(5, 35), of(40, 5)].concat();
        assert_eq!(all, parts);
    }

    /// The first 32 of 1,024 directions lie one in each of the 32 parts of the halving: their mean is nearer to the sphere's
    /// centre than that of 32 random directions, about 1/√32.
    #[test]
    fn the_first_directions_are_even() {
        let directions = Directions::fibonacci(1024, -1.0, 0).expect("directions");
        for seed in 0..8 {
            let scatter = Scatter { paths: 32, seed, ..Scatter::default() };
            let order = order(directions.vectors(), &scatter, 32, 1);
            let sum: DVec3 = order.iter().map(|i| directions.vectors()[*i as usize]).sum();
            assert!(sum.length() / 32.0 < 0.1, "{sum}");
        }
    }
}
