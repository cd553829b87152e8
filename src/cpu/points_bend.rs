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

use glam::{DVec2, DVec3};

use crate::basis::triangles::Triangles;
use crate::scene::{Border, Curvature, HeightField, VisiblePoint, VisiblePoints};
use ways::Ways;

/// No way turns the frame by more than a right angle, radians.
pub const MOST_TURN: f64 = std::f64::consts::FRAC_PI_2;

/// Towards what stands `away` m off along `e` on the flat field, from a sample at height `own_m`: of length 1, in the
/// sample's own frame. A way that would turn further is taken as far as [`MOST_TURN`].
pub fn bent_direction(e: DVec3, away_m: f64, own_m: f64, curvature: Curvature) -> DVec3 {
    bent_as_far(e, away_m, own_m, (curvature, MOST_TURN))
}

/// The same of ways that turn the frame by up to `most_turn`, radians.
pub(crate) fn bent_as_far(
    e: DVec3,
    away_m: f64,
    own_m: f64,
    (curvature, most_turn): (Curvature, f64),
) -> DVec3 {
    let o = e.truncate();
    let per_m = DVec2::from_array(curvature.per_m) * o;
    let rate = per_m.length();
    if rate == 0.0 {
        return e;
    }
    let way_m = away_m.min(most_turn / rate);
    let height_m = own_m + way_m * e.z;
    let turn = rate * way_m;
    let along = per_m / rate;
    // Per metre of the way, so that what is near keeps a direction: sin(v)/v and (1 - cos v)/v of v = turn.
    let [arc, fall] = match turn {
        0.0 => [1.0, 0.0],
        _ => [turn.sin() / turn, 2.0 * (0.5 * turn).sin().powi(2) / turn],
    };
    let of_o = o.dot(along);
    let plan = o + along * (of_o * (arc - 1.0) + height_m * rate * arc);
    let up = e.z - of_o * fall - height_m * rate * fall;
    DVec3::new(plan.x, plan.y, up).normalize()
}

/// Directions on the flat field beside each other, and what they cover.
pub struct Fans {
    /// Of each direction the two other corners of its triangles, counter-clockwise.
    pub pairs: Vec<Vec<[u32; 2]>>,
    /// Solid angle of those triangles, sr.
    pub flat_sr: Vec<f64>,
}

impl Fans {
    /// Of a net over directions.
    pub fn of(triangles: &Triangles, vectors: &[DVec3]) -> Self {
        let mut pairs = vec![Vec::new(); vectors.len()];
        for [a, b, c] in triangles.corners() {
            for (of, pair) in [(a, [*b, *c]), (b, [*c, *a]), (c, [*a, *b])] {
                pairs[*of as usize].push(pair);
            }
        }
        let flat_sr = triangles.fans_sr(vectors).iter().map(|third| 3.0 * third).collect();
        Self { pairs, flat_sr }
    }
}

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
