use std::f64::consts::{PI, TAU};
use std::fmt;

use glam::{DVec2, DVec3};

use super::bend::{MAX_TURN_RAD, REACH_CELLS, bent_direction, bent_direction_within};
use super::normal;
use super::{Border, HeightField};
use crate::{Error, Result};

/// Curvature of the base surface under a field, with principal directions east and north, at the field's
/// [`base_m`](HeightField::base_m), its median height.
///
/// A field that does not repeat lies on the base once, as a whole. For a periodic field, the base around each texel
/// reaches as far as it rises or falls by the relief: √(2 relief / curvature), whatever the size of the tile. Beyond lies
/// the object's own shape, whose occlusion the field does not know; visible points there are placed as if the base went
/// on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    /// One over the radius towards east and towards north, 1/m; above 0 where the base bends down (the outside
    /// of a sphere, where valleys widen), below 0 where it is hollow.
    pub per_m: [f64; 2],
}

/// Estimated occlusion change caused by a curved base, as shares of a hemisphere, mean over texels. The visible points of
/// the flat field do not model it.
///
/// Points visible on the flat field are placed correctly on any base. Errors come from points that the base newly
/// occludes or reveals. A direction's light has at most the error of the largest light, so light errors are about these
/// shares of it or less, in addition to the error of the number of directions. These are estimates from some texels and
/// azimuths, not bounds: in hollows more lights have errors (`cargo measure curved`). Bounces spread the error no farther
/// than light, as visibility is mutual.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OcclusionChange {
    /// Share of directions whose light wrongly counts as unoccluded: the error of shadows.
    pub shadows: f64,
    /// Share of a hemisphere's cosine-weighted light that comes from other points.
    pub light: f64,
}

impl OcclusionChange {
    /// Estimated error of light scattered up to `bounces` times, mean over texels, relative to the largest direct light:
    /// [`light`](Self::light) times the sum of j aʲ; 3.6 for an albedo a of 0.8 and three bounces.
    ///
    /// At most L (1 + a + … + aⁿ⁻¹) arrives after n - 1 bounces, and the share c of it comes from elsewhere. The rest has the
    /// error of n - 1 bounces: Eₙ = a (c L (1 + … + aⁿ⁻¹) + Eₙ₋₁), the sum of c L j aʲ up to n.
    pub fn scattered(self, albedo: f64, bounces: u32) -> f64 {
        self.light * (1..=bounces).map(|n| f64::from(n) * albedo.powf(n.into())).sum::<f64>()
    }
}

impl fmt::Display for OcclusionChange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [shadows, light] = [self.shadows, self.light].map(|share| 100.0 * share);
        write!(
            f,
            "changes the occlusion of about {light:.2} % of a hemisphere's light and {shadows:.2} % of its lights"
        )
    }
}

/// Grid points at which the change is estimated.
const PROBES: usize = 512;
/// Azimuths per grid point.
const AZIMUTHS: usize = 16;
/// Distance, in cells, from which steps grow to the distance over this number. A step then misses, in the sine of an
/// elevation, at most the relief over this many cells.
const ALL_CELLS: u32 = 128;
/// Smallest rise above the horizon, in the sine of an elevation, at which a point counts as visible.
const LEAST_RISE: f64 = 1e-9;

impl Curvature {
    /// A flat base.
    pub const FLAT: Self = Self { per_m: [0.0; 2] };
    /// Largest [`OcclusionChange::light`] that is accepted. A choice: up to here bending adds about as much to the error of
    /// shadows in grooves as the limit of 1024 directions does on the flat base (`cargo measure curved`).
    pub const MAX_CHANGE: f64 = 0.02;
    /// Smallest horizontal scale at any height: 1 + curvature times height over the base.
    pub const MIN_SCALE: f64 = 0.25;

    /// Largest rotation of the base across a field that does not repeat, radians.
    const MAX_TURN_ACROSS_RAD: f64 = PI;

    /// The curvature times `factor`.
    #[must_use]
    pub(crate) fn times(self, factor: f64) -> Self {
        Self { per_m: self.per_m.map(|k| factor * k) }
    }

    /// Checks the curvature for a field and returns the estimated occlusion change.
    ///
    /// # Errors
    /// A value that is not finite; [unknown](HeightField::unknown) heights; heights too near the centre of a hollow's
    /// curvature; a base that turns by more than half a circle across a field that does not repeat;
    /// [`occlusion_change`](Self::occlusion_change) above [`MAX_CHANGE`](Self::MAX_CHANGE): the message states the curvature
    /// that reaches it.
    pub fn check(&self, field: &HeightField, border: Border) -> Result<OcclusionChange> {
        const NAME: &str = "curvature of the base";
        let shown = |of: &Self| {
            format!("{:.3e} towards east and {:.3e} towards north, 1/m", of.per_m[0], of.per_m[1])
        };
        if !self.per_m.iter().all(|k| k.is_finite()) {
            return Err(Error::setting(NAME, format!("{:?}", self.per_m), "two numbers, 1/m"));
        }
        if *self == Self::FLAT {
            return Ok(OcclusionChange::default());
        }
        field.check_known(NAME, "heights: they decide how much occlusion changes")?;
        let heights = field.heights_m().iter().map(|h| f64::from(*h));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(l, h), z| (l.min(z), h.max(z)));
        for k in self.per_m {
            let least = 1.0 + (k * low).min(k * high);
            if least < Self::MIN_SCALE {
                let found = format!(
                    "{}, which pushes the field together to {least:.2} of its width",
                    shown(self)
                );
                let expected = format!(
                    "{} of it or more: radii well beyond the heights, {low:.4} to {high:.4} m about the median",
                    Self::MIN_SCALE
                );
                return Err(Error::setting(NAME, found, expected));
            }
        }
        let [cols, rows] = [field.cols(), field.rows()].map(|n| n as f64);
        let across_m = [cols * field.cell_m()[0], rows * field.cell_m()[1]];
        let turned = (self.per_m[0] * across_m[0]).abs().max((self.per_m[1] * across_m[1]).abs());
        if border != Border::Periodic && turned > Self::MAX_TURN_ACROSS_RAD {
            let found =
                format!("{}, which turns by {turned:.2} radians across the field", shown(self));
            let expected =
                "at most half a circle: beyond it the two ends face each other around the base";
            return Err(Error::setting(NAME, found, expected));
        }
        let changed = self.occlusion_change(field, border);
        if changed.light <= Self::MAX_CHANGE {
            return Ok(changed);
        }
        // Bisect between flat, which changes nothing, and this curvature.
        let (mut fits, mut breaks) = (0.0, 1.0);
        for _ in 0..8 {
            let middle = 0.5 * (fits + breaks);
            if self.times(middle).occlusion_change(field, border).light <= Self::MAX_CHANGE {
                fits = middle;
            } else {
                breaks = middle;
            }
        }
        Err(Error::setting(
            NAME,
            format!("{}, which {changed}", shown(self)),
            format!(
                "at most {}: there it is about {} % of the light",
                shown(&self.times(fits)),
                100.0 * Self::MAX_CHANGE
            ),
        ))
    }

    /// Estimated occlusion change of the base, mean over texels: points that nearer ones newly occlude, and points newly
    /// revealed behind them.
    ///
    /// Along an azimuth, a point is visible from the horizon of all points before it up to its own elevation; sines of
    /// elevations are shares of the hemisphere. Curvature lowers a point at distance d by about k d/2. The stored visibility
    /// places each point visible on the flat field at its elevation on the base, from the last such point on; the actual
    /// visible part begins at the horizon of all points before it, which is as high or higher. The difference is the error;
    /// for shadows it is what rises above the horizon of all stored points. Rounding to the nearest grid point moves that
    /// horizon by up to half a cell, which is added to both.
    ///
    /// At most 512 grid points and 16 azimuths each are chosen evenly. Steps are one cell, beyond 128 cells a 128th of the
    /// distance. They end at the field's edge; in a periodic field where the base has risen or fallen by the relief, at
    /// least one cell and at most half a circle away.
    pub fn occlusion_change(&self, field: &HeightField, border: Border) -> OcclusionChange {
        let grid_points = field.rows() * field.cols();
        let count = grid_points.min(PROBES);
        // Multiples of the golden section are even and match no pattern of the field.
        let golden = 0.5 * (5_f64.sqrt() - 1.0);
        let heights = field.heights_m().iter();
        let (low, high) = heights.fold((f32::MAX, f32::MIN), |(l, h), z| (l.min(*z), h.max(*z)));
        let relief_m = f64::from(high) - f64::from(low);
        let of = |i: usize| {
            let at = match count == grid_points {
                true => i,
                false => ((i as f64 * golden).fract() * grid_points as f64) as usize,
            };
            let azimuths = (0..AZIMUTHS).map(|k| TAU * (k as f64 + 0.5) / AZIMUTHS as f64);
            azimuths.map(move |azimuth| {
                let o = DVec2::from_angle(azimuth);
                self.change_along(field, border, at, (o, self.reach_m(field, relief_m, o)))
            })
        };
        let all = (0..count).flat_map(of);
        let [shadows, light] =
            all.fold([0.0; 2], |[s, l], [shadow, light]| [s + shadow, l + light]);
        let rays = (count * AZIMUTHS) as f64;
        OcclusionChange { shadows: shadows / rays, light: light / rays }
    }

    /// How far a periodic field extends over this base along o, m.
    fn reach_m(&self, field: &HeightField, relief_m: f64, o: DVec2) -> f64 {
        let per_m = DVec2::from_array(self.per_m);
        let level_m = (2.0 * relief_m / per_m.dot(o * o).abs()).sqrt();
        let [cell_x, cell_y] = field.cell_m();
        level_m.min(Self::MAX_TURN_ACROSS_RAD / (per_m * o).length()).max(cell_x.min(cell_y))
    }

    /// Shadows and light of one grid point and azimuth, in a periodic field up to a reach, m.
    fn change_along(
        &self,
        field: &HeightField,
        border: Border,
        at: usize,
        (o, reach_m): (DVec2, f64),
    ) -> [f64; 2] {
        let own = f64::from(field.heights_m()[at]);
        let [cell_x, cell_y] = field.cell_m();
        let step_m = cell_x.min(cell_y);
        let turn = (DVec2::from_array(self.per_m) * o).length();
        let n = normal(field, border, at / field.cols(), at % field.cols());
        let facing = o.dot(n.truncate());
        // Twice the cosine to the normal at the centre of two sines of elevation, times their difference: an azimuth's share
        // of 2π of the hemisphere's ∫ cos = π.
        let light = |low: f64, high: f64| {
            let sine = 0.5 * (low + high);
            2.0 * (high - low)
                * (n.z * sine + facing * (1.0 - sine * sine).max(0.0).sqrt()).max(0.0)
        };
        // Horizons so far: on the flat field; on the base, of all points and of stored ones. `last`: the last stored point.
        let (mut flat, mut bent, mut stored) = (-1.0, -1.0, -1.0_f64);
        let mut last = -1.0;
        let mut changed = 0.0;
        let mut k = 1;
        while k <= REACH_CELLS {
            let distance_m = step_m * f64::from(k);
            if border == Border::Periodic && distance_m > reach_m {
                break;
            }
            let Some(height) = height_at(field, border, at, o * distance_m) else { break };
            let to = DVec3::new(o.x * distance_m, o.y * distance_m, height - own);
            let (away_m, e) = (to.length(), to.normalize());
            let now = bent_direction_within(e, away_m, own, (*self, PI)).z;
            if e.z > flat + LEAST_RISE {
                // Points beyond a right angle of the base are stored as if at the right angle.
                let here = bent_direction(e, away_m, own, *self).z;
                let as_stored = light(last, here.max(last));
                let is_right = turn * distance_m <= MAX_TURN_RAD;
                let right = if is_right { light(bent, now.max(bent)).min(as_stored) } else { 0.0 };
                changed += as_stored - right;
                (flat, last, stored) = (e.z, here, here.max(stored));
            }
            bent = now.max(bent);
            k += (k / ALL_CELLS).max(1);
        }
        // Half a cell along the path turns the direction by half as much.
        let half_cell_m = 0.5 * (o.x.abs() * cell_x + o.y.abs() * cell_y);
        let moved = stored + 0.5 * turn * half_cell_m * (1.0 - stored * stored).sqrt();
        let over = (bent - stored).max(0.0) + (moved - stored);
        [(stored + over).max(0.0) - stored.max(0.0), changed + light(stored, stored + over)]
    }
}

/// Height of the surface above the median at an offset east and north of a grid point; `None` outside the field.
fn height_at(field: &HeightField, border: Border, at: usize, away: DVec2) -> Option<f64> {
    let (rows, cols) = (field.rows(), field.cols());
    let [cell_x, cell_y] = field.cell_m();
    let (right, down) = (away.x / cell_x, -away.y / cell_y);
    let is_periodic = border == Border::Periodic;
    let (x, y) = ((at % cols) as f64 + right, (at / cols) as f64 + down);
    let is_off = |place: f64, count: usize| place < 0.0 || place > (count - 1) as f64;
    if !is_periodic && (is_off(x, cols) || is_off(y, rows)) {
        return None;
    }
    let (col, row) = (x.floor(), y.floor());
    let (u, v) = (x - col, y - row);
    let wrapped = |place: f64, count: usize| match is_periodic {
        true => (place as i64).rem_euclid(count as i64) as usize,
        false => (place as usize).min(count - 1),
    };
    let h = |down: f64, right: f64| {
        f64::from(field.heights_m()[wrapped(row + down, rows) * cols + wrapped(col + right, cols)])
    };
    // Two triangles per cell, split from the north-west.
    let (north_west, south_east) = (h(0.0, 0.0), h(1.0, 1.0));
    Some(match u > v {
        true => north_west + u * (h(0.0, 1.0) - north_west) + v * (south_east - h(0.0, 1.0)),
        false => north_west + v * (h(1.0, 0.0) - north_west) + u * (south_east - h(1.0, 0.0)),
    })
}
