//! Light of a sphere light at one grid point, in f64: a quadrature over azimuths, exact within each.
//!
//! The vertical plane of an azimuth cuts the sphere in a disc. An elevation of the disc counts where the ray enters
//! the sphere (or, from inside, leaves it) before it hits the surface. Both can change only where the disc's circle
//! crosses the profile, so one test decides between those elevations.

use crate::light::{Site, diffuse_at};
use crate::oracle::Oracle;
use crate::profile::VisibleInterval;
use crate::shared::field::towards_m;
use ridgelight::scene::{HeightField, SphereLight};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// One azimuth of a sphere light.
pub(crate) struct SphereSlice {
    pub azimuth_rad: f64,
    /// Radians for which it stands.
    pub weight: f64,
    /// Elevations of the disc.
    pub ends_rad: [f64; 2],
    /// Visible elevations.
    pub visible_rad: Vec<[f64; 2]>,
}

impl Site<'_> {
    /// Exit radiance of its receivers under a sphere light of radiance 1.
    ///
    /// `strips` azimuths: over the sphere's width, spaced so that the disc's square root is smooth, or over the circle
    /// where the grid point lies below or above it. The sphere is not repeated under `periodic`.
    pub fn sphere(&self, sphere: &SphereLight, strips: usize) -> Vec<f64> {
        let mut sums = vec![0.0; self.receivers.len()];
        for SphereSlice { azimuth_rad, weight, visible_rad, .. } in self.slices(sphere, strips) {
            for (receiver, sum) in self.receivers.iter().zip(&mut sums) {
                let slice = receiver.slice(azimuth_rad);
                let light = visible_rad.iter().map(|[low, high]| weight * slice.light(*low, *high));
                *sum += light.sum::<f64>();
            }
        }
        sums.iter().map(|s| s / PI).collect()
    }

    /// The azimuths of [`sphere`](Self::sphere) that cut the sphere.
    pub(crate) fn slices(
        &self,
        sphere: &SphereLight,
        strips: usize,
    ) -> impl Iterator<Item = SphereSlice> {
        let Self { oracle, place: [row, col], .. } = *self;
        let [east, north] = towards_m(oracle.field(), row, col, sphere);
        let up = sphere.position_m[2] - oracle.field().base_m();
        let up = up - oracle.vertex(row as f64, col as f64);
        let (away, middle) = (east.hypot(north), north.atan2(east));
        let radius_m = sphere.radius_m;
        let widest = (radius_m / away).asin();
        (0..strips).filter_map(move |i| {
            let centre = (i as f64 + 0.5) / strips as f64 * 2.0 - 1.0;
            let (offset, weight) = if radius_m < away {
                let u = FRAC_PI_2 * centre;
                // Narrow discs are cos u wide: midpoints sum cos² exactly, except that a single one counts it twice.
                let alone = if strips > 1 { 1.0 } else { 0.5 };
                (widest * u.sin(), alone * widest * u.cos() * PI / strips as f64)
            } else {
                (PI * centre, TAU / strips as f64)
            };
            let azimuth_rad = middle + offset;
            let across = away * offset.sin();
            let squared = radius_m * radius_m - across * across;
            if squared <= 0.0 {
                return None;
            }
            let disc = Disc { along: away * offset.cos(), up, radius: squared.sqrt() };
            let ends_rad = disc.ends_rad();
            let visible_rad = disc.visible(&oracle.visible_intervals(row, col, azimuth_rad));
            Some(SphereSlice { azimuth_rad, weight, ends_rad, visible_rad })
        })
    }
}

/// Exit radiance of a diffuse grid point of albedo 1 under a sphere light of radiance 1, by `strips` azimuths over
/// the sphere, or four times as many over the circle.
pub fn sphere_of(
    oracle: &Oracle,
    row: usize,
    col: usize,
    sphere: &SphereLight,
    strips: usize,
) -> f64 {
    let strips = strips_of(oracle.field(), [row, col], sphere, strips);
    Site::of(oracle, [row, col], &diffuse_at(oracle, row, col)).sphere(sphere, strips)[0]
}

/// Azimuths across a sphere light, or four times as many where it is wide.
pub(crate) fn strips_of(
    field: &HeightField,
    [row, col]: [usize; 2],
    sphere: &SphereLight,
    strips: usize,
) -> usize {
    let [east, north] = towards_m(field, row, col, sphere);
    let is_narrow = east.hypot(north) > 2.0 * sphere.radius_m;
    if is_narrow { strips } else { 4 * strips }
}

/// The sphere's cut with a vertical plane through the grid point, which is the origin.
struct Disc {
    along: f64,
    up: f64,
    radius: f64,
}

impl Disc {
    /// Elevations of the disc's ends.
    fn ends_rad(&self) -> [f64; 2] {
        let distance = self.along.hypot(self.up);
        if distance > self.radius {
            let (middle, half) = (self.up.atan2(self.along), (self.radius / distance).asin());
            [(middle - half).max(-FRAC_PI_2), (middle + half).min(FRAC_PI_2)]
        } else {
            [-FRAC_PI_2, FRAC_PI_2]
        }
    }

    /// The visible elevations of the disc.
    fn visible(&self, intervals: &[VisibleInterval]) -> Vec<[f64; 2]> {
        let [low, high] = self.ends_rad();
        let mut visible = Vec::new();
        for interval in intervals {
            let mut cuts = vec![interval.low_rad, interval.high_rad, low, high];
            cuts.extend(self.crossings(interval));
            cuts.sort_unstable_by(f64::total_cmp);
            for ends in cuts.windows(2) {
                let middle = 0.5 * (ends[0] + ends[1]);
                let within = |a: f64, b: f64| a < middle && middle < b;
                let hit_m = interval.distance_m(middle) / middle.cos();
                if within(interval.low_rad, interval.high_rad)
                    && within(low, high)
                    && self.met_m(middle) < hit_m
                {
                    visible.push([ends[0], ends[1]]);
                }
            }
        }
        let horizon = intervals.last().map_or(-FRAC_PI_2, |last| last.high_rad);
        if high > horizon.max(low) {
            visible.push([horizon.max(low), high]);
        }
        visible
    }

    /// Distance along an elevation within the disc to where the ray enters it, or leaves it from inside.
    fn met_m(&self, elevation_rad: f64) -> f64 {
        let (sin, cos) = elevation_rad.sin_cos();
        let ahead = self.along * cos + self.up * sin;
        let beside = self.along * sin - self.up * cos;
        let half = (self.radius * self.radius - beside * beside).max(0.0).sqrt();
        if self.along.hypot(self.up) > self.radius { ahead - half } else { ahead + half }
    }

    /// Elevations at which the circle crosses the line of an interval, rise + slope·D.
    fn crossings(&self, interval: &VisibleInterval) -> impl Iterator<Item = f64> {
        let VisibleInterval { rise_m, slope, .. } = *interval;
        // (D - along)² + (rise + slope D - up)² = radius².
        let (a, below) = (1.0 + slope * slope, self.up - rise_m);
        let b = self.along + slope * below;
        let c = self.along * self.along + below * below - self.radius * self.radius;
        let root = (b * b - a * c).max(0.0).sqrt();
        [(b - root) / a, (b + root) / a]
            .into_iter()
            .filter(|d| *d > 0.0)
            .map(move |d| (rise_m + slope * d).atan2(d))
    }
}
