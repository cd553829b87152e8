//! Direct light of a sphere light by spherical harmonics: visibility up to the sphere's distance, times the sphere,
//! times the receiver. In f64 and directly from the basis: no rotated frame, no list of products.

use crate::basis::sphere;
use crate::basis::turned;
use crate::light::normal;
use crate::light_matrix::light_matrix;
use crate::oracle::Oracle;
use crate::pyramid_march::{LevelHeights, Stored};
use crate::sh_shade::light_on;
use crate::sh_visibility::{Series, visibility_along};
use crate::sh_wedges::wedges_around;
use crate::shared::field::towards_m;
use glam::{DVec2, DVec3};
use ridgelight::basis::wedge::WedgeTable;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::scene::{Quality, Receiver, SphereLight, Wedges};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Wedges from one end of the azimuths across a sphere around to the other: the shader's value.
pub const BEYOND: usize = 32;

/// How sphere lights are shaded.
#[derive(Clone, Debug)]
pub struct SphereSh<'a> {
    /// Of the field.
    pub oracle: Oracle<'a>,
    /// The levels from which horizons come, if not from the surface itself.
    pub pyramid: Option<(Pyramid, Stored<'a>)>,
    /// Its order, wedges, receiver, window and azimuths.
    pub quality: Quality,
    table: Option<WedgeTable>,
}

/// Light of a grid point from a sphere light of radiance 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Soft {
    /// Exit radiance of albedo 1, negative where harmonics ring.
    pub light: f64,
    /// Visibility series, n² coefficients.
    pub visibility: Vec<f64>,
}

impl<'a> SphereSh<'a> {
    /// Horizons of the surface, or of a pyramid's levels.
    pub fn new(
        oracle: Oracle<'a>,
        pyramid: Option<(Pyramid, Stored<'a>)>,
        quality: Quality,
    ) -> Self {
        let (order, side) = (quality.sh_order as usize, quality.wedge_side as usize);
        let width = TAU / f64::from(quality.sun_azimuths);
        let table = (quality.wedges == Wedges::Table)
            .then(|| WedgeTable::new(order, side, -FRAC_PI_2, width));
        Self { oracle, pyramid, quality, table }
    }

    /// The light of one grid point.
    pub fn at(&self, sphere: &SphereLight, row: usize, col: usize) -> Soft {
        let field = self.oracle.field();
        let [east, north] = towards_m(field, row, col, sphere);
        let own = self.oracle.vertex(row as f64, col as f64);
        let to = DVec3::new(east, north, sphere.position_m[2] - field.base_m() - own);
        let normal = normal(field, self.oracle.border(), row, col);
        let visibility = self.visibility(sphere.radius_m, to, normal, [row, col]);
        let light = light_of(&self.quality, sphere.radius_m, to, normal, &visibility);
        Soft { light, visibility }
    }

    /// The visibility series up to the sphere's distance.
    fn visibility(&self, radius_m: f64, to: DVec3, normal: DVec3, place: [usize; 2]) -> Vec<f64> {
        let Quality { sh_order, wedges, receiver, sun_azimuths, .. } = self.quality;
        let (away, towards) = (to.x.hypot(to.y), to.y.atan2(to.x));
        let within = within_m(radius_m, to);
        let own_slope = -DVec2::new(normal.x, normal.y) / normal.z;
        let hidden = |phi: f64, free: f64| match receiver {
            Receiver::Plane => free.max(own_slope.dot(DVec2::from_angle(phi))),
            Receiver::Cosine => free,
        };
        let count = sun_azimuths as usize;
        if let Some(table) = &self.table {
            let even = (0..count).map(|i| towards - PI + TAU * i as f64 / count as f64);
            let angle = |phi: f64| hidden(phi, self.free(place, phi, within)).atan();
            return wedges_around(table, even.map(|p| [turn(p), angle(p)]).collect());
        }
        let half = half_width(radius_m, away);
        let mut rays = Vec::new();
        let mut ends = [0.0; 2];
        for i in 0..count {
            let phi = towards + half * ((2 * i + 1) as f64 / count as f64 - 1.0);
            let free = self.free(place, phi, within);
            rays.push([phi, 2.0 * half / count as f64, hidden(phi, free)]);
            ends = [if i == 0 { free } else { ends[0] }, free];
        }
        let width = (PI - half) / (BEYOND / 2) as f64;
        for k in 0..BEYOND / 2 {
            let turn = half + width * (k as f64 + 0.5);
            for (phi, free) in [(towards - turn, ends[0]), (towards + turn, ends[1])] {
                rays.push([phi, width, hidden(phi, free)]);
            }
        }
        visibility_along(Series { order: sh_order as usize, wedges, receiver }, &rays)
    }

    fn free(&self, [row, col]: [usize; 2], azimuth_rad: f64, within_m: f64) -> f64 {
        match &self.pyramid {
            None => self.oracle.slope_within(row, col, azimuth_rad, within_m),
            Some((pyramid, stored)) => {
                LevelHeights { field: self.oracle.field(), pyramid, stored: *stored }.slope(
                    [row, col],
                    azimuth_rad,
                    within_m,
                )
            }
        }
    }
}

/// Exit radiance of albedo 1 from a visibility series, of a sphere at that position.
pub fn light_of(
    quality: &Quality,
    radius_m: f64,
    to: DVec3,
    normal: DVec3,
    visibility: &[f64],
) -> f64 {
    let order = quality.light_order();
    let axis = if to == DVec3::ZERO { DVec3::Z } else { to.normalize() };
    let light = turned(&sphere(order, radius_m, to.length()), axis);
    let series: Vec<DVec3> = light.into_iter().map(DVec3::splat).collect();
    light_on(normal, visibility, &light_matrix(quality, &series)).x
}

/// In [-π, π).
fn turn(phi: f64) -> f64 {
    (phi + PI).rem_euclid(TAU) - PI
}

/// Half of the azimuth range for a sphere that far away in the plane: asin(r/away), continuous to π where it is
/// overhead or around.
pub fn half_width(radius_m: f64, away_m: f64) -> f64 {
    if away_m <= radius_m {
        return PI;
    }
    let half_angle_sin = radius_m / away_m;
    half_angle_sin.asin().max(PI * half_angle_sin.powi(3))
}

/// Distance up to which ground may hide part of a sphere: its centre's in the plane, or that of the farthest point
/// where a ray touches it, t cos(ω - a), t the tangents' length; from inside its radius.
pub fn within_m(radius_m: f64, to: DVec3) -> f64 {
    let (away, distance) = (to.x.hypot(to.y), to.length());
    if distance < radius_m {
        return radius_m;
    }
    let tangent = ((distance - radius_m) * (distance + radius_m)).sqrt();
    let touched = tangent * (tangent * away + radius_m * to.z.abs()) / (distance * distance);
    away.max(touched)
}
