//! The frontier of cost and error, and the choice of one of its points.

/// Cost and error of settings. Both finite, 0 or more; less is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// Time, in any unit.
    pub cost: f64,
    /// Error, in any unit.
    pub error: f64,
}

impl Value {
    /// Whether this is no slower and no less accurate than `other`.
    pub fn covers(&self, other: &Value) -> bool {
        self.cost <= other.cost && self.error <= other.error
    }

    /// Natural logarithms of cost and error, 0 as the smallest positive number.
    pub(super) fn logs(&self) -> [f64; 2] {
        [self.cost, self.error].map(|x| x.max(f64::MIN_POSITIVE).ln())
    }
}

/// Indices of the values that no other covers, from fast to slow: costs rise, errors fall. Of equal
/// ones the first.
pub fn frontier(values: &[Value]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    let key = |i: usize| (values[i].cost, values[i].error);
    order.sort_by(|&a, &b| {
        let ((ca, ea), (cb, eb)) = (key(a), key(b));
        ca.total_cmp(&cb).then(ea.total_cmp(&eb))
    });
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let better = values[i].error < least;
        least = least.min(values[i].error);
        better
    });
    order
}

/// What settings have to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// The fastest of at most this error (relative RMSE), above 0.
    MaxError(f64),
    /// The most accurate of at most this cost (time per frame, ns), above 0.
    MaxCost(f64),
}

/// A point of the frontier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recommendation {
    /// Its index in the values.
    pub point: usize,
    /// Whether it reaches the goal; where none does it is the nearest one.
    pub holds: bool,
}

/// Picks for a `goal`; none for no values. Without a goal it picks the knee, the least product of
/// cost and error: the tangent of slope -1 on log axes. From there, twice the cost nowhere halves
/// the error, and half the cost nowhere only doubles it.
pub fn recommend(values: &[Value], goal: Option<Goal>) -> Option<Recommendation> {
    let front = frontier(values);
    let mut all = front.iter().copied();
    let product = |i: usize| values[i].logs().iter().sum::<f64>();
    let (found, nearest) = match goal {
        None => (all.min_by(|a, b| product(*a).total_cmp(&product(*b))), front.first()),
        Some(Goal::MaxError(most)) => (all.find(|i| values[*i].error <= most), front.last()),
        Some(Goal::MaxCost(most)) => (all.rfind(|i| values[*i].cost <= most), front.first()),
    };
    Some(Recommendation { point: found.unwrap_or(*nearest?), holds: found.is_some() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(all: &[(f64, f64)]) -> Vec<Value> {
        all.iter().map(|&(cost, error)| Value { cost, error }).collect()
    }

    /// By hand: none covers (1, 9), (2, 4), (4, 3) and (9, 0); (2, 5) and (5, 3) are covered; of
    /// the two (4, 3) the first stays.
    #[test]
    fn the_frontier_has_no_covered_point() {
        let all = values(&[
            (9.0, 0.0),
            (4.0, 3.0),
            (2.0, 5.0),
            (1.0, 9.0),
            (4.0, 3.0),
            (5.0, 3.0),
            (2.0, 4.0),
        ]);
        let front = frontier(&all);
        assert_eq!(front, [3, 6, 1, 0]);
        for i in 0..all.len() {
            let covered = (0..all.len()).any(|j| all[j] != all[i] && all[j].covers(&all[i]));
            assert_eq!(front.iter().any(|&f| all[f] == all[i]), !covered, "{i}");
        }
        assert!(frontier(&[]).is_empty());
    }

    /// Products 8, 6, 7.5, 8: the knee is the second. Halving both units changes nothing.
    #[test]
    fn the_knee_is_the_least_product() {
        let all = values(&[(1.0, 8.0), (2.0, 3.0), (3.0, 2.5), (8.0, 1.0)]);
        assert_eq!(recommend(&all, None), Some(Recommendation { point: 1, holds: true }));
        let halved: Vec<Value> =
            all.iter().map(|v| Value { cost: v.cost / 2.0, error: v.error / 2.0 }).collect();
        assert_eq!(recommend(&halved, None), recommend(&all, None));
        // A result without error is worth any time; of several the fastest.
        let exact = values(&[(1.0, 8.0), (5.0, 0.0), (9.0, 0.0)]);
        assert_eq!(recommend(&exact, None).unwrap().point, 1);
        assert_eq!(recommend(&[], None), None);
    }

    #[test]
    fn broken_bounds_are_reported() {
        let all = values(&[(1.0, 8.0), (2.0, 3.0), (3.0, 2.5), (8.0, 1.0), (4.0, 2.6)]);
        let pick = |goal| recommend(&all, goal).map(|r| (r.point, r.holds)).unwrap();
        assert_eq!(pick(Some(Goal::MaxError(2.7))), (2, true));
        assert_eq!(pick(Some(Goal::MaxError(2.5))), (2, true));
        assert_eq!(pick(Some(Goal::MaxError(0.5))), (3, false));
        assert_eq!(pick(Some(Goal::MaxCost(7.9))), (2, true));
        assert_eq!(pick(Some(Goal::MaxCost(0.5))), (0, false));
    }
}
