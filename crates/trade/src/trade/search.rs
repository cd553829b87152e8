//! The search over the ladders: what to measure next, and what can be skipped.
//!
//! First each ladder alone from the start, outwards; then, of the rest, the settings expected to
//! lie farthest beyond the frontier. Places are skipped by proof, under one assumption: a slower
//! step never costs less and is never less accurate. The slowest measured settings below a place
//! then bound its cost, the most inaccurate above it its error. Where one measured point is within
//! both, the place cannot improve the frontier. Every measured pair tests the assumption; a ladder
//! that breaks it loses its bounds, and the places skipped by it are open again.

use super::frontier::{Value, frontier};

/// A slower step that is worse by no more than this share counts as no worse, because of timing
/// noise and errors dominated by other settings. A skipped place may be better by as much per step.
pub const SLACK: f64 = 0.05;

/// What a ladder bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Slower steps cost no less.
    Cost,
    /// Slower steps are no less accurate.
    Error,
}

/// Two measured places that break a ladder's order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Break {
    /// The ladders in which they differ.
    pub ladders: Vec<usize>,
    /// Which order is broken.
    pub side: Side,
    /// The place that should be faster and less accurate.
    pub lower: usize,
    /// The place that should be slower and more accurate.
    pub higher: usize,
}

/// Why a place need not be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skip {
    /// It costs at least as much as `slower_than` and has at least the error of `worse_than` (none:
    /// of the ground truth itself), and `by` undercuts both.
    Covered {
        /// The measured place that is better.
        by: usize,
        /// The measured place below.
        slower_than: usize,
        /// The measured place above.
        worse_than: Option<usize>,
    },
    /// It costs at least as much as `than`, which was abandoned.
    TooSlow {
        /// The abandoned place.
        than: usize,
    },
}

/// Steps on every ladder; none where it has no effect.
type Steps = Vec<Option<usize>>;

/// The state of the search.
#[derive(Clone, Debug)]
pub struct Search {
    steps: Vec<Steps>,
    start: usize,
    /// The error of the ground truth itself: smaller differences are not resolved.
    floor: f64,
    values: Vec<Option<Value>>,
    given_up: Vec<bool>,
    /// Measured places, in order.
    measured: Vec<usize>,
    /// Abandoned for their cost.
    too_slow: Vec<usize>,
    /// Whether each ladder bounds cost, and error.
    trusted: [Vec<bool>; 2],
    breaks: Vec<Break>,
    /// For each place the largest lower bound and its source: cost, error.
    bounds: Vec<[Option<(f64, usize)>; 2]>,
    front: Vec<usize>,
    /// For each ladder, by its step + 1 (0: no effect), the measurement with all others as at the
    /// start.
    alone: Vec<Vec<Option<Value>>>,
}

impl Search {
    /// A search over `steps` from index `start`; errors below `floor` are equal.
    ///
    /// # Panics
    /// `start` out of range, or places of different numbers of ladders.
    pub fn new(steps: Vec<Steps>, start: usize, floor: f64) -> Self {
        let (count, ladders) = (steps.len(), steps[start].len());
        assert!(steps.iter().all(|s| s.len() == ladders), "one step per ladder");
        let most = |ladder: usize| steps.iter().filter_map(|s| s[ladder]).max();
        let alone = (0..ladders).map(|k| vec![None; most(k).map_or(1, |s| s + 2)]).collect();
        Self {
            steps,
            start,
            floor,
            values: vec![None; count],
            given_up: vec![false; count],
            measured: Vec::new(),
            too_slow: Vec::new(),
            trusted: [vec![true; ladders], vec![true; ladders]],
            breaks: Vec::new(),
            bounds: vec![[None; 2]; count],
            front: Vec::new(),
            alone,
        }
    }

    /// The place to measure next; none where every place is measured, abandoned or skipped.
    pub fn next(&self) -> Option<usize> {
        if self.is_open(self.start) {
            return Some(self.start);
        }
        let open: Vec<usize> = (0..self.steps.len()).filter(|&i| self.is_open(i)).collect();
        let alone = open.iter().copied().filter(|&i| self.differing(i, self.start).count() == 1);
        if let Some(place) = alone.min_by_key(|&i| self.distance(i, self.start)) {
            return Some(place);
        }
        let scored = open.into_iter().map(|i| (self.merit(i), i));
        scored.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1))).map(|(_, i)| i)
    }

    /// Records a measurement.
    pub fn measured(&mut self, place: usize, value: Value) {
        let value = Value { cost: value.cost, error: value.error.max(self.floor) };
        self.values[place] = Some(value);
        self.measured.push(place);
        for ladder in 0..self.alone.len() {
            if self.differing(place, self.start).all(|k| k == ladder) {
                let step = self.steps[place][ladder].map_or(0, |s| s + 1);
                self.alone[ladder][step].get_or_insert(value);
            }
        }
        if self.find_breaks(place) {
            self.bounds.fill([None; 2]);
            for i in self.measured.clone() {
                self.bound_by(i);
            }
        } else {
            self.bound_by(place);
        }
        let values: Vec<Value> = self.measured.iter().filter_map(|&i| self.values[i]).collect();
        self.front = frontier(&values).into_iter().map(|i| self.measured[i]).collect();
    }

    /// Replaces the measurement of a place, as if it had been the first.
    pub fn measured_again(&mut self, place: usize, value: Value) {
        let steps = std::mem::take(&mut self.steps);
        let fresh = Self::new(steps, self.start, self.floor);
        let old = std::mem::replace(self, fresh);
        (self.given_up, self.too_slow) = (old.given_up, old.too_slow);
        for i in old.measured {
            let known = if i == place { Some(value) } else { old.values[i] };
            if let Some(value) = known {
                self.measured(i, value);
            }
        }
    }

    /// Records that a place cannot be measured; with `too_slow`, nor can slower ones.
    pub fn give_up(&mut self, place: usize, too_slow: bool) {
        self.given_up[place] = true;
        if too_slow {
            self.too_slow.push(place);
        }
    }

    /// The measurement of a place, its error at least that of the ground truth.
    pub fn value(&self, place: usize) -> Option<Value> {
        self.values[place]
    }

    /// Measured places that no other covers, from fast to slow.
    pub fn frontier(&self) -> &[usize] {
        &self.front
    }

    /// Measured places, in the order of measurement.
    pub fn order(&self) -> &[usize] {
        &self.measured
    }

    /// The broken orders found.
    pub fn breaks(&self) -> &[Break] {
        &self.breaks
    }

    /// Whether a place is neither measured, nor abandoned, nor skipped.
    pub fn is_open(&self, place: usize) -> bool {
        self.values[place].is_none() && !self.given_up[place] && self.skip(place).is_none()
    }

    /// Why a place that was neither measured nor abandoned can be skipped; none where it cannot.
    pub fn skip(&self, place: usize) -> Option<Skip> {
        if self.values[place].is_some() || self.given_up[place] {
            return None;
        }
        let than = self.too_slow.iter().copied().find(|&p| self.is_below(p, place, Side::Cost));
        if let Some(than) = than {
            return Some(Skip::TooSlow { than });
        }
        let [cost, error] = self.bounds[place];
        let (cost, slower_than) = cost?;
        let (error, worse_than) = error.map_or((self.floor, None), |(e, by)| (e, Some(by)));
        let best = Value { cost, error };
        let by =
            self.front.iter().copied().find(|&i| self.values[i].is_some_and(|v| v.covers(&best)));
        by.map(|by| Skip::Covered { by, slower_than, worse_than })
    }

    /// The expected value of a place: the nearest measured one's, changed by each differing ladder
    /// as at the start. Costs multiply; squares of errors add, as for independent causes. Nearest
    /// are those whose every difference was measured at the start.
    pub fn predicted(&self, place: usize) -> Value {
        let alone = |ladder: usize, i: usize| {
            self.alone[ladder][self.steps[i][ladder].map_or(0, |s| s + 1)]
        };
        let near = self.measured.iter().copied().min_by_key(|&i| {
            let unmeasured = self
                .differing(i, place)
                .filter(|&ladder| alone(ladder, i).is_none() || alone(ladder, place).is_none());
            let differing = self.differing(i, place).count();
            (unmeasured.count(), differing, self.distance(i, place), usize::MAX - i)
        });
        let Some((near, value)) = near.and_then(|i| Some((i, self.values[i]?))) else {
            return Value { cost: 0.0, error: self.floor };
        };
        let (mut cost, mut squared) = (value.cost, value.error.powi(2));
        for ladder in self.differing(near, place) {
            if let (Some(from), Some(to)) = (alone(ladder, near), alone(ladder, place)) {
                cost *= to.cost / from.cost.max(f64::MIN_POSITIVE);
                squared += to.error.powi(2) - from.error.powi(2);
            }
        }
        // Where causes do not add up, a gain is limited to a factor of ten.
        let error = squared.max((0.1 * value.error).powi(2)).sqrt().max(self.floor);
        Value { cost, error }
    }

    /// Expected distance beyond the frontier: the natural logarithm of the factor by which some
    /// point of it would have to improve, in cost or in error, to cover the place. Below 0:
    /// covered.
    pub fn merit(&self, place: usize) -> f64 {
        let [cost, error] = self.predicted(place).logs();
        let past = |i: &usize| {
            let [c, e] = self.values[*i].map_or([f64::INFINITY; 2], |v| v.logs());
            (c - cost).max(e - error)
        };
        self.front.iter().map(past).fold(f64::INFINITY, f64::min)
    }

    /// Ladders on different steps in two places; one without effect is on every step.
    fn differing(&self, a: usize, b: usize) -> impl Iterator<Item = usize> + '_ {
        let pairs = self.steps[a].iter().zip(&self.steps[b]).enumerate();
        pairs.filter(|(_, (a, b))| matches!((a, b), (Some(a), Some(b)) if a != b)).map(|(k, _)| k)
    }

    fn distance(&self, a: usize, b: usize) -> usize {
        let pairs = self.steps[a].iter().zip(&self.steps[b]);
        pairs.map(|(a, b)| a.zip(*b).map_or(0, |(a, b)| a.abs_diff(b))).sum()
    }

    /// Whether no ladder of `a` is on a slower step than in `b`, and none that lost its bounds on
    /// another.
    fn is_below(&self, a: usize, b: usize, side: Side) -> bool {
        let trusted = &self.trusted[side as usize];
        let mut pairs = self.steps[a].iter().zip(&self.steps[b]).zip(trusted);
        pairs.all(|((a, b), trusted)| a.zip(*b).is_none_or(|(a, b)| a == b || (*trusted && a < b)))
    }

    /// Updates the bounds of all places by a measured one.
    fn bound_by(&mut self, from: usize) {
        let Some(value) = self.values[from] else { return };
        for place in 0..self.steps.len() {
            let costs_more = self.is_below(from, place, Side::Cost);
            let errs_more = self.is_below(place, from, Side::Error);
            let found = [costs_more.then_some(value.cost), errs_more.then_some(value.error)];
            for (bound, new) in self.bounds[place].iter_mut().zip(found) {
                if new.is_some_and(|new| bound.is_none_or(|(old, _)| new > old)) {
                    *bound = new.map(|new| (new, from));
                }
            }
        }
    }

    /// Checks a new value against all others; returns whether a ladder lost its bounds.
    fn find_breaks(&mut self, new: usize) -> bool {
        let mut any = false;
        // Nearest pairs first: they identify the ladder best.
        let mut others = self.measured.clone();
        others.sort_by_key(|&i| self.differing(i, new).count());
        let pairs = others.into_iter().flat_map(|other| [(new, other), (other, new)]);
        for (lower, higher) in pairs {
            let ladders: Vec<usize> = self.differing(lower, higher).collect();
            let Some((low, high)) = self.values[lower].zip(self.values[higher]) else { continue };
            for side in [Side::Cost, Side::Error] {
                let is_broken = match side {
                    Side::Cost => low.cost > high.cost * (1.0 + SLACK),
                    Side::Error => high.error > low.error * (1.0 + SLACK),
                };
                if is_broken && !ladders.is_empty() && self.is_below(lower, higher, side) {
                    ladders.iter().for_each(|k| self.trusted[side as usize][*k] = false);
                    self.breaks.push(Break { ladders: ladders.clone(), side, lower, higher });
                    any = true;
                }
            }
        }
        any
    }
}
