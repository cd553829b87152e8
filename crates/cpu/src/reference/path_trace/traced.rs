//! What paths bring, and what of it is in doubt.

use crate::tolerance::near::{Near, Near3, plus};

/// What some paths of a sample bring.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    /// The sum of their light.
    pub light: Near3,
    /// Rays.
    pub rays: Near,
    /// Decisions that are in doubt, of light that has been reflected so often before it is: by samples alone, once besides, more.
    pub doubts: [u32; 3],
    /// What the light is off by for them.
    pub in_doubt: [f64; 3],
    /// Of rays of each, over all places where one was held against the surface, how many cells it had come, and one.
    pub crossed: [f64; 3],
    /// Of which of them it is now.
    pub(super) reflected: usize,
}

impl Default for Traced {
    fn default() -> Self {
        Self {
            light: [Near::ZERO; 3],
            rays: Near::ZERO,
            doubts: [0; 3],
            in_doubt: [0.0; 3],
            crossed: [0.0; 3],
            reflected: 0,
        }
    }
}

impl Traced {
    /// What may or may not be brought, `most` at most: added where it surely is. Where rounding leaves nothing of it, any of that.
    pub(super) fn add(&mut self, light: Near3, is_brought: Option<bool>, most: [f64; 3]) {
        let is_lost = (0..3).any(|c| light[c].off > most[c]);
        match is_brought {
            Some(true) if !is_lost => self.light = plus(self.light, light),
            Some(true) => self.doubt(most),
            None if is_lost => self.doubt(most),
            Some(false) => {}
            None => self.doubt(light.map(Near::most)),
        }
    }

    pub(super) fn doubt(&mut self, most: [f64; 3]) {
        self.doubts[self.reflected] += 1;
        for (c, most) in most.into_iter().enumerate() {
            self.light[c].off += most;
            self.in_doubt[c] += most;
        }
    }

    /// Adds what others bring.
    pub fn join(&mut self, more: &Self) {
        self.light = plus(self.light, more.light);
        self.rays = Near { v: self.rays.v + more.rays.v, off: self.rays.off + more.rays.off };
        for i in 0..3 {
            self.in_doubt[i] += more.in_doubt[i];
            self.doubts[i] += more.doubts[i];
            self.crossed[i] += more.crossed[i];
        }
    }

    pub(super) fn ray(&mut self, is_sent: Option<bool>) {
        let sent = if is_sent == Some(false) { 0.0 } else { 1.0 };
        let off = if is_sent.is_none() { 1.0 } else { 0.0 };
        self.rays = Near { v: self.rays.v + sent, off: self.rays.off + off };
    }
}
