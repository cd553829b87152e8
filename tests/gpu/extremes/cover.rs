//! The rows that every test run draws: a fixed, small part of the whole matrix.

use super::suite::methods::Method;
use super::suite::{self, About, Asks, Case};

/// The judgement of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judged {
    Bound,
    /// Finite, no more.
    Number,
    Refusal,
}

pub fn judged(case: &Case, method: &Method) -> Judged {
    if (case.refuses)(method).is_some() {
        Judged::Refusal
    } else if (case.unjudged)(method) {
        Judged::Number
    } else {
        Judged::Bound
    }
}

/// Cases that share methods, but not their passes: horizons are requested, or light.
fn group(case: &Case) -> (About, bool) {
    (case.about, matches!(case.asks, Asks::Light))
}

/// Pairs of case and method by this rule, in this order:
/// 1. each case once by its bound, and once by number where it has such methods: with the method that its group
///    has used least, the first of several;
/// 2. each method that its group has not used by a bound: with the group's first case that it can be judged by;
/// 3. every refusal, for which nothing is drawn.
pub fn cover(cases: &[Case], methods: &[Method]) -> Vec<[usize; 2]> {
    let put: Vec<[usize; 2]> = suite::put(cases, methods)
        .into_iter()
        .filter(|[c, m]| !(cases[*c].is_long)(&methods[*m]))
        .collect();
    let how = |[c, m]: [usize; 2]| judged(&cases[c], &methods[m]);
    let such = |of: Judged| put.iter().copied().filter(move |pair| how(*pair) == of);
    let mut all: Vec<[usize; 2]> = Vec::new();
    for of in [Judged::Bound, Judged::Number] {
        for (c, case) in cases.iter().enumerate() {
            let uses = |m: usize| {
                let is_same =
                    |pair: &&[usize; 2]| pair[1] == m && group(&cases[pair[0]]) == group(case);
                all.iter().filter(is_same).count()
            };
            let least = such(of).filter(|pair| pair[0] == c).min_by_key(|pair| uses(pair[1]));
            all.extend(least);
        }
    }
    for [c, m] in such(Judged::Bound) {
        let is_same = |pair: &[usize; 2]| {
            pair[1] == m
                && group(&cases[pair[0]]) == group(&cases[c])
                && how(*pair) == Judged::Bound
        };
        if !all.iter().any(is_same) {
            all.push([c, m]);
        }
    }
    all.extend(such(Judged::Refusal));
    all
}

#[test]
fn the_selection_has_every_case_method_and_refusal() {
    let (cases, methods) = (suite::cases(), suite::methods::all());
    let (cover, put) = (cover(&cases, &methods), suite::put(&cases, &methods));
    let how = |pair: [usize; 2]| judged(&cases[pair[0]], &methods[pair[1]]);
    for &[c, m] in &put {
        let (case, method) = (&cases[c], &methods[m]);
        if (case.is_long)(method) {
            continue;
        }
        let of = how([c, m]);
        let has = |is_such: &dyn Fn(&[usize; 2]) -> bool| {
            cover.iter().any(|pair| how(*pair) == of && is_such(pair))
        };
        assert!(has(&|pair| pair[0] == c), "{}: none {of:?}", case.name);
        match of {
            Judged::Bound => {
                let is_there = has(&|pair| pair[1] == m && group(&cases[pair[0]]) == group(case));
                assert!(is_there, "{}: none like {}", method.name, case.name);
            }
            Judged::Number => {}
            Judged::Refusal => assert!(has(&|pair| *pair == [c, m]), "{}", case.name),
        }
    }
    let mut once = cover.clone();
    once.sort_unstable();
    once.dedup();
    assert_eq!(once.len(), cover.len(), "a row twice");
    assert!(5 * cover.len() < put.len(), "{} of {} rows are no selection", cover.len(), put.len());
}
