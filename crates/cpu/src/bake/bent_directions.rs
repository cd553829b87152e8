//! Directions of the visible points once the flat field is bent over a curved base surface (Heidrich et al. 2000,
//! §5), in f64.
//!
//! Points visible to each other on the flat base are assumed to stay so on the curved one; only the directions
//! change. The base rolls along the straight path o between the two grid points: its frame turns evenly by w = (k_x
//! o_x, k_y o_y) about the horizontal axis across w. After a fraction s of the path a vector v of the plan is rotated
//! to R(s w) v. The base is then at ∫ R(s w) o ds: the part of o along w gives |o_w| sin|w| / |w| along w and -|o_w|
//! (1 - cos|w|) / |w| upwards, the part across is unchanged. A height h stands on the normal at the end, R(w) (0, 0,
//! h). This is exact along the axis of a cylinder's curvature and everywhere on a sphere, where paths are geodesics
//! and turn evenly; elsewhere it is exact to second order.
//!
//! The distance of a visible point follows from the grid point and the direction ([`ways`]).
//!
//! A convex base (k above 0) lowers everything at a distance d by k d²/2, and its direction by k d / 2. Heights h
//! above the base diverge by 1 + k h.

pub mod ways;

use glam::DVec3;
use ridgelight::basis::triangles::Triangles;
use ridgelight::scene::{Border, Curvature, HeightField, VisiblePoint, VisiblePoints};
use ways::Ways;

pub use ridgelight::scene::{Fans, MAX_TURN_RAD, bent_direction, bent_direction_within};

/// Inputs of the bending: the flat field and its visible points.
pub struct Draped<'a> {
    /// The flat field.
    pub field: &'a HeightField,
    /// Border beyond the field.
    pub border: Border,
    /// Visible points of its grid points.
    pub points: &'a VisiblePoints,
    /// The triangulation of their directions.
    pub fans: &'a Fans,
    /// Curvature of the base.
    pub curvature: Curvature,
}

impl Draped<'_> {
    /// The directions that direction `i` may move with at a grid point: itself where the surface is visible, else the
    /// neighbours with visible surface that are within `slack` of the nearest's cosine; empty where it stays.
    pub fn movers(&self, i: usize, grid_point: usize, slack: f64) -> Vec<(usize, usize)> {
        let vectors = self.points.directions().vectors();
        let met = |j: usize| match self.points.point(j, grid_point) {
            VisiblePoint::GridPoint(there) => Some((j, there)),
            VisiblePoint::Sky | VisiblePoint::Ground => None,
        };
        match self.points.point(i, grid_point) {
            VisiblePoint::GridPoint(there) => return vec![(i, there)],
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

    /// The bent directions of a grid point, direction after direction.
    pub fn bent(&self, grid_point: usize) -> Vec<DVec3> {
        let vectors = self.points.directions().vectors();
        let own = f64::from(self.field.heights_m()[grid_point]);
        let of = |i: usize| match self.movers(i, grid_point, 0.0).first() {
            Some((with, there)) => {
                let on = (self.field, self.border);
                let ways = Ways::of(on, self.curvature, [grid_point, *there], vectors[*with]);
                bent_direction(vectors[i], ways.met().away_m, own, self.curvature)
            }
            None => vectors[i],
        };
        (0..vectors.len()).map(of).collect()
    }

    /// Visibility of a light, 0 to 1, at a grid point whose directions are [`bent`](Self::bent): the share of the
    /// corners with visible sky of the triangle around the light, ignoring corners at or below horizontal. Where the
    /// triangulation has folded and several triangles contain it, the smallest share. `None` where no triangle does.
    pub fn lit_share(
        &self,
        triangles: &Triangles,
        bent: &[DVec3],
        grid_point: usize,
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
                if self.points.point(*i as usize, grid_point) == VisiblePoint::Sky {
                    lit += part;
                }
            }
            (all > 0.0).then_some(lit / all)
        });
        shares.reduce(f64::min)
    }
}
