//! Tolerances of light through horizons, and of sphere lights.

use super::{ARC_TANGENT, EPSILON, device_table, device_wedge_row};
use crate::basis::from_nlp;
use crate::basis::occlusion_polynomials;
use crate::env_tables::EnvTables;
use crate::sh_shade::OFF_PLANE;
use crate::shared::field::towards_m;
use glam::DVec3;
use ridgelight::basis::MAX_ORDER;
use ridgelight::basis::slice::{Slices, slice_index};
use ridgelight::scene::{HeightField, SphereLight, Wedges};
use std::f64::consts::PI;

/// Error of the raised ground of `shadow_sweep` over a plane, on a field whose largest |height| is `largest_m`. `plane_m` is the
/// plane's height at the end of a line.
///
/// Heights over the plane are sums of two terms and are raised by four: 10 ε of the largest.
pub fn shadow_ground(largest_m: f64, plane_m: f64) -> f64 {
    10.0 * EPSILON * (largest_m + plane_m.abs())
}

/// Error of a stored height of `shadow_sweep`, whose ground has an error of `ground`.
///
/// The shader adds 1e-6, which is 17 ε, of the sizes of its terms, so that a shadow is never too low. A half of an f32 has 7 bits.
pub fn shadow_stored(height_m: f64, ground: f64) -> f64 {
    height_m.abs() / 128.0 + 5.0 * ground
}

/// Errors of a grid point's light through its horizons.
#[derive(Clone, Copy, Debug)]
pub struct ShadeError {
    lowest_slope: f64,
    normal: f64,
    count: f64,
}

impl ShadeError {
    /// For horizons whose slopes err by `slope_error`, on a field of `relief_m` in cells of at least
    /// `cell_m`, in `count` azimuths.
    ///
    /// A component of the gradient: differences 1, weighted exactly and summed 2, a quotient 5: 8 ε R / c;
    /// two of them turn the normal by √2 of that, `inversesqrt` and products by 8 ε. The slope of the
    /// grid point's own plane is 3 roundings of the gradient besides, √2 R / c at most.
    pub fn new(slope_error: f64, relief_m: f64, cell_m: f64, count: usize) -> Self {
        let gradient = 2.0_f64.sqrt() * 8.0 * EPSILON * relief_m / cell_m;
        let own_plane = gradient + 3.0 * EPSILON * 2.0_f64.sqrt() * relief_m / cell_m;
        Self {
            lowest_slope: slope_error.max(own_plane),
            normal: gradient + 8.0 * EPSILON,
            count: count as f64,
        }
    }

    /// `sky_shade`, the sky's sum.
    ///
    /// Wedges sum to 2 π, over π. A slice's end moves by the slope's error, where the integrand is at most
    /// 1; moments are at most π/2 + 1/2 for the normal to turn, and err by half an arc tangent and 10 ε;
    /// terms, 4.2 in all, by 5 ε; each sum by ε of at most 2.
    pub fn sky(&self) -> f64 {
        2.0 * self.lowest_slope
            + 5.0 * self.normal
            + ARC_TANGENT
            + (41.0 + 2.0 * self.count) * EPSILON
    }

    /// `sky_shade`, the environment's sum, from given tables; `brightest` is its largest radiance.
    ///
    /// As [`sky`](Self::sky), by tables: three components, √3 at most, change by 1 a unit of sine (2 √3 over all
    /// wedges), are at most π/2 (√3 π), and stand at a sine that errs as the slope does. The part up to it, which is of the
    /// same sizes, is off by as much again.
    pub fn environment(&self, brightest: f64) -> f64 {
        let rest = (33.0 + 5.5 * self.count) * EPSILON;
        brightest * (3.5 * self.sine() + 5.5 * self.normal + 2.0 * rest)
    }

    /// Of the sine of a lowest direction: it changes by no more than the slope does; a square, a sum, `inversesqrt` (2 ULP) and a
    /// product, 8 ε.
    fn sine(&self) -> f64 {
        self.lowest_slope + 8.0 * EPSILON
    }

    /// The environment's sum of at most `brightest`, from an image of `columns` × `rows` by tables of `nodes`
    /// made on the device.
    ///
    /// As [`environment`](Self::environment); and three components of every table, √3 at most, that err
    /// themselves and by their rows, over moments of at most π/2, over π.
    pub fn whole_environment(&self, brightest: f64, [columns, rows, nodes]: [f64; 3]) -> f64 {
        let wedge = std::f64::consts::TAU / self.count;
        let row = device_wedge_row(brightest, wedge, columns / self.count + 2.0);
        let largest = brightest * wedge;
        let table = device_table(rows * largest, largest, rows + nodes) + 0.5 * row;
        self.environment(brightest) + 3.0_f64.sqrt() * self.count * table
    }

    /// What an azimuth's wedge of an environment gives a grid point of this normal above a slope, from tables made on the device, of
    /// which each moment has an error of `table` and the part between two nodes, as a moment, of `part`.
    ///
    /// Each component of the normal times its moment, at a sine that errs as the slope does; the normal's turn moves it by the
    /// moments' length. Two products and a sum of each moment round 8 times, those of the part up to the sine 16 times of the
    /// moment at the node, and sums of all azimuths once each.
    pub fn wedge_looked_up(
        &self,
        tables: &EnvTables,
        (azimuth, lowest, normal): (usize, f64, DVec3),
        (table, part): &([DVec3; 3], DVec3),
    ) -> DVec3 {
        let sine = lowest / lowest.hypot(1.0);
        let changes = tables.change(azimuth, sine, self.sine());
        // At the node below, of which the part up to the sine is less.
        let below = tables.looked_up(azimuth, sine - tables.step());
        let mut off = DVec3::ZERO;
        let mut squared = DVec3::ZERO;
        for (m, moment) in tables.looked_up(azimuth, sine).into_iter().enumerate() {
            let largest = moment.abs().max(below[m].abs());
            let rounded = (24.0 + self.count) * EPSILON * largest;
            off += normal[m].abs() * (table[m] + *part + changes[m] + rounded);
            squared += moment * moment;
        }
        off + self.normal * DVec3::new(squared.x.sqrt(), squared.y.sqrt(), squared.z.sqrt())
    }

    /// `sun_shade`, of slices whose weights sum to `weights`, where both agree on what is lit.
    ///
    /// As [`sky`](Self::sky), between two slopes, with weights over π instead of wedges.
    pub fn sun(&self, weights: f64) -> f64 {
        let slice = self.lowest_slope + 2.1 * self.normal + ARC_TANGENT + 33.0 * EPSILON;
        weights / PI * slice + self.count * EPSILON
    }

    /// The same where no slice's end moves, of a light that gives at most `irradiance` to a surface that faces it.
    ///
    /// The normal turns against the light's vector irradiance, not against the moments of all elevations.
    pub fn unmoved_sun(&self, weights: f64, irradiance: f64) -> f64 {
        let slice = ARC_TANGENT + 33.0 * EPSILON;
        (weights * slice + irradiance * self.normal) / PI + self.count * EPSILON
    }

    /// A coefficient of band `l` of `sh_visibility`.
    ///
    /// Azimuths' weights sum to 2 √π at most and err by 26 ε: five complex products of 4 ε from the cosine
    /// and sine. A slice's end moves by the slope's error, where Θ_lm is √((2l+1)/2) at most. Its
    /// polynomial of degree 6, of coefficients that sum to C, errs by 12 ε C itself, by 6 · 7 ε C of the
    /// sine (`inversesqrt`, two products, a sum) and by 6 ε C of the cosine and sum; its angle by an arc
    /// tangent. By Legendre coefficients, it is a sum of up to six such. Sums of √2 · 2 √π at most round
    /// once an azimuth.
    pub fn series(&self, l: usize, wedges: Wedges) -> f64 {
        let magnitude = |c: &[f64]| c.iter().map(|v| v.abs()).sum::<f64>();
        let sharpest = |l: usize| (l as f64 + 0.5).sqrt();
        let slices = Slices::new(l + 1);
        let of_band = slice_index(l, 0)..slice_index(l + 1, 0);
        let [end, sum, angle] = match wedges {
            Wedges::Slices => {
                let parts = &slices.parts()[of_band];
                let angle = parts.iter().map(|p| p.whole.abs()).fold(0.0, f64::max);
                let sum = parts.iter().map(|p| magnitude(&p.polynomial)).fold(0.0, f64::max);
                [sharpest(l), sum + PI * angle, angle]
            }
            // Horizons of a wedge move it as they move slices; texels of at most √2 · √2 Φ, weights between
            // them and turns by powers of cosine and sine err by 60 ε.
            Wedges::Table => [sharpest(l), 2.0 * sharpest(l).max(1.0), sharpest(l)],
            Wedges::Nlp => {
                // Whatever the order is, up to the highest.
                let occlusion = occlusion_polynomials(MAX_ORDER);
                let kept = |c: usize| {
                    c.checked_sub(1).map_or(2.0_f64.sqrt(), |i| magnitude(&occlusion[i]))
                };
                let worst = |of: &dyn Fn(usize) -> f64| {
                    let rows = &from_nlp(MAX_ORDER)[of_band.clone()];
                    let sum = |row: &Vec<f64>| (0..MAX_ORDER).map(|c| row[c].abs() * of(c)).sum();
                    rows.iter().map(sum).fold(0.0, f64::max)
                };
                [worst(&sharpest), 2.0 * worst(&kept), 0.0]
            }
        };
        let slice = end * self.lowest_slope + 60.0 * EPSILON * sum + ARC_TANGENT * angle;
        let weights = 2.0 * PI.sqrt();
        weights * (slice + 2.0_f64.sqrt() * (26.0 + self.count) * EPSILON)
    }

    /// What `sh_shade` counts a node for, relative to that.
    ///
    /// Off each other's planes a grid point and a node have an error of two gradients' errors and two of the rise's 3
    /// roundings, a quarter of a gradient's each at most, over their distance; of 1 / (1 + x²) the relative
    /// change is below dx, x in units of [`OFF_PLANE`]. Hats, squares and quotients err by 30 ε. Weights are
    /// divided by their sum, which errs as they do.
    pub fn node_weight(&self) -> f64 {
        2.0 * (2.0 * 1.25 * self.normal / OFF_PLANE + 30.0 * EPSILON)
    }

    /// Error of a normal, radians.
    pub fn normal(&self) -> f64 {
        self.normal
    }

    /// Distance of a horizon from a point sun within which the two may disagree on visibility.
    pub fn lowest_slope(&self) -> f64 {
        self.lowest_slope
    }
}

/// Geometry of a sphere light relative to a grid point, and its field.
#[derive(Clone, Copy, Debug)]
pub struct SphereGeometry {
    /// Distance from the grid point to the sphere's centre.
    pub distance_m: f64,
    /// The same in the plane.
    pub away_m: f64,
    /// Radius of the sphere.
    pub radius_m: f64,
    /// Largest height of the sphere's centre and of the field over the base.
    pub largest_m: f64,
    /// Highest less lowest height.
    pub relief_m: f64,
    /// The smaller side of a cell.
    pub cell_m: f64,
    /// Whether the surface may intersect the sphere.
    pub is_cut: bool,
}

impl SphereGeometry {
    /// For a grid point, by its index in the field's heights.
    pub fn of(field: &HeightField, sphere: &SphereLight, grid_point: usize) -> Self {
        let (cols, heights) = (field.cols(), field.heights_m());
        let [cell_x, cell_y] = field.cell_m();
        let [east, north] = towards_m(field, grid_point / cols, grid_point % cols, sphere);
        let over = sphere.position_m[2] - field.base_m();
        let up = over - f64::from(heights[grid_point]);
        let all = heights.iter().map(|h| f64::from(*h));
        let (low, high) = all.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        Self {
            distance_m: east.hypot(north).hypot(up),
            away_m: east.hypot(north),
            radius_m: sphere.radius_m,
            largest_m: low.abs().max(high.abs()).max(over.abs()),
            relief_m: high - low,
            cell_m: cell_x.min(cell_y),
            is_cut: over - sphere.radius_m < high,
        }
    }

    /// `sphere_shade` against its CPU reference, for radiance 1.
    ///
    /// A slope errs as a march's at its first crossing, 38 ε R / c, and by places further on: a direction
    /// turned by 24 ε and a position that errs by 8 ε of the distance, across which the surface rises by
    /// R / c: 70 ε R / c together. The sphere's centre errs by 4 ε of the distance and ε of its height, as an
    /// angle 4 ε (1 + H/d); the ends of its disc by 2 (d/t)² of that, t the tangent's length, but never by
    /// more than √(8 ε), what is left of a tangent that is nothing; directions, arc tangents and sums by
    /// 40 ε and [`ARC_TANGENT`]. The circle's half chord on a piece of surface has a square that errs by
    /// 16 ε r²: 4 √ε r where they just touch, from d - r or from within. Slices' weights sum to
    /// π asin(r / away) at most, or to 2 π; two ends a slice, a normal that turns both its parts, over π.
    pub fn tolerance(&self) -> f64 {
        let [weights, angle, touch] = self.of_slices();
        let normal = ShadeError::new(0.0, self.relief_m, self.cell_m, 1).normal();
        weights / PI * (2.0 * angle + 2.0 * normal + touch)
    }

    /// Sum of the slices' weights, the error of an elevation, and that of an end where the sphere's circle touches the surface.
    pub(crate) fn of_slices(&self) -> [f64; 3] {
        let Self { distance_m: d, away_m, radius_m: r, .. } = *self;
        let steepness = self.relief_m / self.cell_m;
        let place = 4.0 * EPSILON * (1.0 + self.largest_m / d.max(1e-3 * r));
        let tangent2 = (1.0 - (r / d).powi(2)).abs();
        let ends = (2.0 * place / tangent2).min((8.0 * EPSILON).sqrt() + place);
        let angle = 70.0 * EPSILON * steepness + place + ends + ARC_TANGENT + 40.0 * EPSILON;
        let from = (d - r).abs().max(1e-3 * r);
        let touch = if self.is_cut { 4.0 * EPSILON.sqrt() * (r / from).min(1.0) } else { 0.0 };
        let weights = if away_m > r { PI * (r / away_m).asin() } else { 2.0 * PI };
        [weights, angle, touch]
    }

    /// The largest extent of a slice of the sphere in elevation.
    pub(crate) fn height_rad(&self) -> f64 {
        if self.distance_m > self.radius_m {
            2.0 * (self.radius_m / self.distance_m).asin()
        } else {
            PI
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Light of radiance 1 in a wedge of 1 rad, above a horizon whose sine has an error of 3 of 256 nodes: (1 - s²) / (2 π) of a level
    /// normal, which changes by s times the error and half its square.
    #[test]
    fn a_sine_that_is_off_by_nodes_is_off_by_all_of_them() {
        let nodes = 257;
        let light = |node: usize| DVec3::splat((1.0 - (node as f64 / 256.0).powi(2)) / (2.0 * PI));
        let moments = (0..3 * nodes).map(|i| light(i % nodes)).collect();
        let (radiances, wedges) = (vec![DVec3::ONE; nodes], vec![DVec3::ONE]);
        let tables = EnvTables { nodes, bottom_sine: 0.0, moments, radiances, wedges };
        let (off, s) = (3.0 / 256.0, 0.5 / 1.25_f64.sqrt());
        let error = ShadeError { lowest_slope: off, normal: 0.0, count: 1.0 };
        let found =
            error.wedge_looked_up(&tables, (0, 0.5, DVec3::Z), &([DVec3::ZERO; 3], DVec3::ZERO));
        let expected = (s + 0.5 * off) * off / PI;
        assert!((expected..expected + 100.0 * EPSILON).contains(&found.x), "{found} {expected}");
    }
}
