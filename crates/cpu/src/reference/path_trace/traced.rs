//! Contributions of paths, and the part of them in doubt.

use crate::tolerance::near::{Near, Near3, plus};

/// Contribution of some paths of a grid point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Traced {
    /// The sum of their light.
    pub light: Near3,
    /// Rays.
    pub rays: Near,
    /// Branches in doubt, per number of reflections before: once for grid points alone, once more each.
    pub doubts: [u32; 3],
    /// Their error bound of the light.
    pub in_doubt: [f64; 3],
    /// Per ray, the cells crossed plus one at every test against the surface.
    pub crossed: [f64; 3],
    /// Current index in it.
    pub(super) reflected: usize,
}

impl Traced {
    /// A possible contribution, `most` at most: added where it is certain. Where rounding leaves nothing of it, any
    /// of that.
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

    /// Adds the contribution of others.
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
