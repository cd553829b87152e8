//! Where samples see what they see once the flat field lies on a curved base (Heidrich et al. 2000, §5), in f64.
//!
//! Points that see each other on the flat base are taken to see each other on the curved one; what changes is where. The
//! base rolls along the straight way o between the two samples, so that its frame turns evenly by w = (k_x o_x, k_y o_y) about
//! the horizontal axis across w: after a share s of the way a vector v of the plan stands where the rotation R(s w) takes
//! it. The base is then at ∫ R(s w) o ds: of o the part along w gives |o_w| sin|w| / |w| along w and -|o_w| (1 - cos|w|) / |w|
//! upwards, the part across stays. A height h stands on the end's normal, R(w) (0, 0, h). Along the axis of a cylinder's
//! curvature and everywhere on a sphere that is exact, as ways are geodesics and turn evenly; of others to second order.
//!
//! How far a place is follows from the sample and the direction ([`ways`]).
//!
//! A convex base (above 0) lets all sink by k d²/2 at a distance d, which lowers its direction by k d / 2; heights above the
//! base are drawn apart by 1 + k h.

pub mod ways;

use glam::DVec3;

use ridgelight::basis::triangles::Triangles;
use ridgelight::scene::{Border, Curvature, HeightField, VisiblePoint, VisiblePoints};
use ways::Ways;

pub use ridgelight::scene::{Fans, MOST_TURN, bent_as_far, bent_direction};

/// What bends with what: the flat field and what its samples see.
pub struct Draped<'a> {
    /// The flat field.
    pub field: &'a HeightField,
    /// What lies beyond it.
    pub border: Border,
    /// What its samples see.
    pub points: &'a VisiblePoints,
    /// Their directions beside each other.
    pub fans: &'a Fans,
    /// Of the base.
    pub curvature: Curvature,
}

impl Draped<'_> {
    /// The directions that direction `i` may move with at a sample, itself where the surface is seen, else of its neighbours
    /// that do those within `slack` of the nearest's cosine; none where it stays.
    pub fn movers(&self, i: usize, sample: usize, slack: f64) -> Vec<(usize, usize)> {
        let vectors = self.points.directions().vectors();
        let met = |j: usize| match self.points.seen(j, sample) {
            VisiblePoint::Sample(there) => Some((j, there)),
            VisiblePoint::Sky | VisiblePoint::Ground => None,
        };
        match self.points.seen(i, sample) {
            VisiblePoint::Sample(there) => return vec![(i, there)],
            VisiblePoint::Ground => return Vec::new(),
            VisiblePoint::Sky => {}
        }
        let near = |j: usize| vectors[j].dot(vectors[i]);
        let around = || self.fans.pairs[i].iter().flatten().filter_map(|j| met(*j as usize));
        let nearest = around().map(|(j, _)| near(j)).fold(-2.0, f64::max);
        let mut all = Vec::new();
        for mover in around().filter(|(j, _)| near(*j) >= nearest - slack) {
            if !all.contains(&mover) {
                all.push(mover);
            }
        }
        all
    }

    /// Where a sample sees what it sees, direction after direction.
    pub fn bent(&self, sample: usize) -> Vec<DVec3> {
        let vectors = self.points.directions().vectors();
        let own = f64::from(self.field.heights_m()[sample]);
        let of = |i: usize| match self.movers(i, sample, 0.0).first() {
            Some((with, there)) => {
                let on = (self.field, self.border);
                let ways = Ways::of(on, self.curvature, [sample, *there], vectors[*with]);
                bent_direction(vectors[i], ways.met().away_m, own, self.curvature)
            }
            None => vectors[i],
        };
        (0..vectors.len()).map(of).collect()
    }

    /// How much of a light arrives at a sample whose directions are [`bent`](Self::bent), 0 to 1: the share of the corners
    /// of the triangle that holds it in which the sky is seen, corners at or below horizontal left out; of several triangles,
    /// where the net has folded over, the least. `None` where none holds it.
    pub fn lit_share(
        &self,
        triangles: &Triangles,
        bent: &[DVec3],
        sample: usize,
        light: DVec3,
    ) -> Option<f64> {
        let shares = triangles.corners().iter().filter_map(|face| {
            let [a, b, c] = face.map(|i| bent[i as usize]);
            if light.dot(a + b + c) <= 0.0 {
                return None;
            }
            let of = [light.dot(b.cross(c)), light.dot(c.cross(a)), light.dot(a.cross(b))];
            if of.iter().any(|part| *part < -1e-13) {
                return None;
            }
            let (mut lit, mut all) = (0.0, 0.0);
            for ((i, e), part) in face.iter().zip([a, b, c]).zip(of) {
                let part = if e.z > 0.0 { part.max(0.0) } else { 0.0 };
                all += part;
                if self.points.seen(*i as usize, sample) == VisiblePoint::Sky {
                    lit += part;
                }
            }
            (all > 0.0).then_some(lit / all)
        });
        shares.reduce(f64::min)
    }
}
