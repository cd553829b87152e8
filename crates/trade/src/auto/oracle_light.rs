//! Light of texels by the f64 oracle, for probes.

use std::collections::HashMap;

use ridgelight::scene::Scene;
use ridgelight_cpu::lit::Lit;

/// Radiance of texels by the f64 oracle and by half of its rays. Each texel is computed once. Probes of different seeds have
/// texels in common: on small fields, most of them.
#[derive(Clone, Debug)]
pub(super) struct OracleLight<'a> {
    lit: Lit<'a>,
    halved: Lit<'a>,
    /// By texel.
    whole: HashMap<usize, [f64; 3]>,
    half: HashMap<usize, [f64; 3]>,
}

impl<'a> OracleLight<'a> {
    pub fn of(lit: &Lit<'a>) -> Self {
        let halved = lit.clone().halved();
        Self { lit: lit.clone(), halved, whole: HashMap::new(), half: HashMap::new() }
    }

    pub fn scene(&self) -> &'a Scene {
        self.lit.scene()
    }

    /// Radiance of texels, by row-major index. Runs on all cores.
    pub fn whole(&mut self, places: &[usize]) -> Vec<[f64; 3]> {
        lights(&self.lit, &mut self.whole, places)
    }

    /// The same by half of the rays.
    pub fn half(&mut self, places: &[usize]) -> Vec<[f64; 3]> {
        lights(&self.halved, &mut self.half, places)
    }
}

/// Light of texels, in their order. Computes those that are not in `known`, and adds them there.
fn lights(lit: &Lit<'_>, known: &mut HashMap<usize, [f64; 3]>, places: &[usize]) -> Vec<[f64; 3]> {
    let cols = lit.scene().field.cols();
    let mut new: Vec<usize> = places.iter().copied().filter(|i| !known.contains_key(i)).collect();
    new.sort_unstable();
    new.dedup();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let at = |i: &usize| (*i, lit.at(i / cols, i % cols));
    std::thread::scope(|scope| {
        let parts = new.chunks(new.len().div_ceil(threads).max(1));
        let all: Vec<_> = parts
            .map(|part| scope.spawn(move || part.iter().map(at).collect::<Vec<_>>()))
            .collect();
        for joined in all.into_iter().map(std::thread::ScopedJoinHandle::join) {
            known.extend(joined.unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
    });
    places.iter().map(|i| known[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{HeightField, Lights, Surface};

    /// The light of texels is the oracle's, whichever are known, in the order of the request. A known texel is not computed
    /// again: one with another value keeps it.
    #[test]
    fn each_texel_is_computed_once() {
        let heights: Vec<f64> = (0..35).map(|i| f64::from(i * i % 11)).collect();
        let scene = Scene {
            field: HeightField::new(5, 7, &heights, [1.0; 2], None).unwrap(),
            surface: Surface::default(),
            lights: Lights { sky: Some([1.0, 2.0, 3.0]), ..Lights::default() },
        };
        let lit = Lit::of(&scene);
        let mut light = OracleLight::of(&lit);
        let at = |i: usize| lit.at(i / 7, i % 7);
        assert!(light.whole(&[]).is_empty());
        assert_eq!(light.whole(&[9, 3, 9]), [at(9), at(3), at(9)]);
        assert_eq!(light.whole.len(), 2);
        light.whole.insert(3, [7.0; 3]);
        assert_eq!(light.whole(&[30, 3, 9]), [at(30), [7.0; 3], at(9)]);
        let halved = lit.clone().halved();
        assert_eq!(light.half(&[3]), [halved.at(0, 3)]);
        assert_ne!(light.half(&[3]), [at(3)]);
    }
}
