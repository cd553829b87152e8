//! Light of texels by the f64 oracle, for probes: computed by threads while frames are compiled and drawn.

use std::any::Any;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use ridgelight::scene::Scene;
use ridgelight_cpu::lit::Lit;

/// Which share of the oracle's rays to use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Rays {
    All,
    Half,
}

/// A texel by row-major index.
type Key = (usize, Rays);

/// Radiance of texels by the f64 oracle and by half of its rays. Each texel is computed once. Probes of different seeds have
/// texels in common: on small fields, most of them.
///
/// A texel's light depends on nothing but the scene, so the order in which threads compute it changes no result.
pub(super) struct OracleLight<'a> {
    lit: Lit<'a>,
    halved: Lit<'a>,
    threads: OracleThreads,
}

/// The threads that compute exact light for [`choose`](super::choose) while frames are compiled and drawn.
#[derive(Default)]
pub struct OracleThreads {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// Texels to compute, in this order.
    waiting: VecDeque<Key>,
    /// Every requested texel; `None` while it waits or is being computed.
    light: HashMap<Key, Option<[f64; 3]>>,
    /// Number of texels that are being computed.
    running: usize,
    /// Number of [`Pause`]s.
    pauses: usize,
    /// Whether the threads must end.
    is_over: bool,
    /// The panic of a thread.
    panic: Option<Box<dyn Any + Send>>,
}

/// While it exists, [`OracleThreads`] compute nothing.
#[must_use = "the threads go on when it is dropped"]
pub struct Pause<'a>(&'a OracleThreads);

/// Ends the threads when it is dropped, also during a panic.
struct End<'a>(&'a OracleThreads);

impl OracleThreads {
    /// Waits until no texel is being computed; then the cores are free, so that a frame can be timed.
    pub fn pause(&self) -> Pause<'_> {
        let mut state = self.lock();
        state.pauses += 1;
        while state.running > 0 {
            state = self.wait(state);
        }
        drop(state);
        Pause(self)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'s>(&self, state: MutexGuard<'s, State>) -> MutexGuard<'s, State> {
        self.changed.wait(state).unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Pause<'_> {
    fn drop(&mut self) {
        self.0.lock().pauses -= 1;
        self.0.changed.notify_all();
    }
}

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.lock().is_over = true;
        self.0.changed.notify_all();
    }
}

impl<'a> OracleLight<'a> {
    /// Runs `work` with the light of texels, which all cores compute: one thread fewer than there are cores, and the caller's
    /// thread while it waits for light.
    pub fn with<T>(lit: &Lit<'a>, work: impl FnOnce(&Self) -> T) -> T {
        let halved = lit.clone().halved();
        let own = Self { lit: lit.clone(), halved, threads: OracleThreads::default() };
        let cores = thread::available_parallelism().map_or(1, usize::from);
        thread::scope(|scope| {
            let _end = End(&own.threads);
            for _ in 1..cores {
                scope.spawn(|| own.run());
            }
            work(&own)
        })
    }

    pub fn scene(&self) -> &'a Scene {
        self.lit.scene()
    }

    pub fn threads(&self) -> &OracleThreads {
        &self.threads
    }

    /// Requests texels that will be needed, after all earlier ones; does not wait.
    pub fn request(&self, places: &[usize], rays: Rays) {
        let mut state = self.threads.lock();
        let State { waiting, light, .. } = &mut *state;
        for key in places.iter().map(|place| (*place, rays)) {
            if let Entry::Vacant(entry) = light.entry(key) {
                entry.insert(None);
                waiting.push_back(key);
            }
        }
        self.threads.changed.notify_all();
    }

    /// Radiance of texels, in their order. They are computed before all others that wait.
    pub fn light(&self, places: &[usize], rays: Rays) -> Vec<[f64; 3]> {
        self.request(places, rays);
        let keys: Vec<Key> = places.iter().map(|place| (*place, rays)).collect();
        let needed: HashSet<Key> = keys.iter().copied().collect();
        let mut state = self.threads.lock();
        let (first, rest): (Vec<Key>, Vec<Key>) =
            state.waiting.drain(..).partition(|key| needed.contains(key));
        state.waiting.extend(first);
        state.waiting.extend(rest);
        // Only this thread requests texels: those in front are the needed ones.
        while let Some(key) = state.waiting.front().copied().filter(|key| needed.contains(key)) {
            state.waiting.pop_front();
            state = self.compute(state, key);
        }
        loop {
            if let Some(panic) = state.panic.take() {
                drop(state);
                resume_unwind(panic);
            }
            let all: Option<Vec<_>> = keys.iter().map(|key| state.light[key]).collect();
            match all {
                Some(all) => return all,
                None => state = self.threads.wait(state),
            }
        }
    }

    /// The loop of a thread.
    fn run(&self) {
        let mut state = self.threads.lock();
        while !state.is_over {
            let next = if state.pauses == 0 { state.waiting.pop_front() } else { None };
            state = match next {
                Some(key) => self.compute(state, key),
                None => self.threads.wait(state),
            };
        }
    }

    /// Computes a texel that no longer waits. Does not hold the lock meanwhile.
    fn compute<'s>(
        &'s self,
        mut state: MutexGuard<'s, State>,
        (place, rays): Key,
    ) -> MutexGuard<'s, State> {
        state.running += 1;
        drop(state);
        let lit = match rays {
            Rays::All => &self.lit,
            Rays::Half => &self.halved,
        };
        let cols = self.scene().field.cols();
        let light = catch_unwind(AssertUnwindSafe(|| lit.at(place / cols, place % cols)));
        let mut state = self.threads.lock();
        state.running -= 1;
        match light {
            Ok(light) => {
                state.light.insert((place, rays), Some(light));
            }
            Err(panic) => state.panic = Some(panic),
        }
        self.threads.changed.notify_all();
        state
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::auto::probes::Probes;
    use crate::auto::tests::under_sky;
    use ridgelight::scene::Lights;

    fn scene() -> Scene {
        let lights = Lights { sky: Some([1.0, 2.0, 3.0]), ..Lights::default() };
        Scene { lights, ..under_sky(5, 7) }
    }

    /// The light of texels is the oracle's, in the order of the request, whichever texels are known. A known texel is not computed
    /// again: a different stored value is kept.
    #[test]
    fn each_texel_is_computed_once() {
        let scene = scene();
        let lit = Lit::of(&scene);
        let at = |i: usize| lit.at(i / 7, i % 7);
        OracleLight::with(&lit, |light| {
            assert!(light.light(&[], Rays::All).is_empty());
            assert_eq!(light.light(&[9, 3, 9], Rays::All), [at(9), at(3), at(9)]);
            assert_eq!(light.threads.lock().light.len(), 2);
            light.threads.lock().light.insert((3, Rays::All), Some([7.0; 3]));
            assert_eq!(light.light(&[30, 3, 9], Rays::All), [at(30), [7.0; 3], at(9)]);
            let halved = lit.clone().halved();
            assert_eq!(light.light(&[3], Rays::Half), [halved.at(0, 3)]);
            assert_ne!(light.light(&[3], Rays::Half), [at(3)]);
        });
    }

    /// Requests are answered with the light that a single thread computes, whatever waits before them and whether or not
    /// the threads pause. During a pause the caller still gets what it waits for, and nothing else is computed.
    #[test]
    fn requests_ahead_change_no_light() {
        let scene = scene();
        let lit = Lit::of(&scene);
        let at = |i: usize| lit.at(i / 7, i % 7);
        OracleLight::with(&lit, |light| {
            let pause = light.threads().pause();
            light.request(&(0..35).collect::<Vec<_>>(), Rays::All);
            light.request(&[4, 4, 8], Rays::Half);
            assert_eq!(light.light(&[34, 20], Rays::All), [at(34), at(20)]);
            let known = || light.threads.lock().light.values().filter(|l| l.is_some()).count();
            assert_eq!(known(), 2);
            assert_eq!(light.threads.lock().waiting.len(), 33 + 2);
            drop(pause);
            let all: Vec<usize> = (0..35).rev().collect();
            let wanted: Vec<_> = all.iter().map(|i| at(*i)).collect();
            assert_eq!(light.light(&all, Rays::All), wanted);
        });
    }

    /// With their weights all texels of probes are requested, without them the uniform third. Where all texels of the field are
    /// wanted, both request all.
    #[test]
    fn probes_take_the_texels_that_were_requested() {
        let scene = scene();
        let lit = Lit::of(&scene);
        let unsure: Vec<f64> = (0..35).map(|i| f64::from(i % 5)).collect();
        for (wanted, given, are_all) in
            [(20, Some(unsure.as_slice()), true), (20, None, false), (40, None, true)]
        {
            OracleLight::with(&lit, |light| {
                Probes::request(light, wanted, 3, given).unwrap();
                let requested = light.threads.lock().light.len();
                let probes = Probes::by(light, wanted, 3, &unsure).unwrap();
                assert_eq!(probes.count(), wanted.min(35));
                let taken = light.threads.lock().light.len();
                assert_eq!(taken == requested, are_all, "{wanted}: {requested} of {taken}");
            });
        }
    }

    /// A panic of the oracle, here beyond the field, reaches the caller; the threads end.
    #[test]
    fn panics_reach_the_caller() {
        let scene = scene();
        let lit = Lit::of(&scene);
        let met = catch_unwind(AssertUnwindSafe(|| {
            OracleLight::with(&lit, |light| light.light(&[3, 35, 4], Rays::All).len())
        }));
        assert!(met.is_err());
    }
}
