use std::f64::consts::{PI, TAU};
use std::fmt;

use glam::{DVec2, DVec3};

use super::bend::{MOST_TURN, REACH_CELLS, bent_as_far, bent_direction};
use super::normal;
use super::{Border, HeightField};
use crate::{Error, Result};

/// Curvature of the base that a field lies on, whose principal directions are east and north: that of a surface through
/// the field's [`base_m`](HeightField::base_m), its median height.
///
/// A field that does not repeat lies on it once, as a whole. Of one that repeats, each sample has around it as much of the base as
/// rises or falls by no more than the relief, √(2 relief / curvature) far, whatever the tile that it is told by. What lies beyond
/// is the object's own shape, whose rim hides what it hides beside the field; what a sample sees there is told, all the same,
/// where a base that goes on takes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    /// One over the radius towards east and towards north, 1/m; above 0 where the base bends down (a ball from outside, on
    /// which valleys widen), below 0 where it is hollow.
    pub per_m: [f64; 2],
}

/// About what a base changes of what samples see, shares of a hemisphere in the mean over samples: what the flat field's visible
/// points do not tell of.
///
/// Places that are seen on the flat field are found where they stand on the base, however it is bent; what errs are places
/// that it hides or lays open. A direction's light is off by at most the largest that there is, so that errors are
/// about these shares of it or less, beside those that the number of directions leaves on any base. They are estimates, by some
/// samples and azimuths, and no bounds: in hollows more lights are wrong (`examples/curved`). Means over samples stand for means
/// over the surface, over which what is off spreads by bounces no farther than light does, as places see each other alike.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Changed {
    /// Of the directions over a sample those from which light is taken to arrive and does not: the share of lights of
    /// shadows that is wrong by it.
    pub shadows: f64,
    /// Of the light of a hemisphere, by the cosine to the sample's normal, that which comes from elsewhere.
    pub light: f64,
}

impl Changed {
    /// By about how much light that is scattered up to so many times may be off in the mean over samples, over the largest direct
    /// light: [`light`](Self::light) times the sum of j aʲ, at an albedo a of 0.8 and three times 3.6.
    ///
    /// Of light that arrives, at most L (1 + a + … + aⁿ⁻¹) of the albedo a after n - 1 times, the share c comes from
    /// elsewhere; the rest is off by what n - 1 times are: Eₙ = a (c L (1 + … + aⁿ⁻¹) + Eₙ₋₁), the sum of c L j aʲ up to n.
    pub fn scattered(self, albedo: f64, bounces: u32) -> f64 {
        self.light * (1..=bounces).map(|n| f64::from(n) * albedo.powf(n.into())).sum::<f64>()
    }
}

impl fmt::Display for Changed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [shadows, light] = [self.shadows, self.light].map(|share| 100.0 * share);
        write!(
            f,
            "hides or lays open about {light:.2} % of a hemisphere's light and {shadows:.2} % of its lights"
        )
    }
}

/// Samples whose views are compared.
const SAMPLES: usize = 512;
/// Azimuths of each.
const AZIMUTHS: usize = 16;
/// From here on places are looked at as far apart as their distance over this, cells. What stands between two of them is passed
/// over: of the sine of an elevation at most the relief over so many cells, where nothing nearer is as high.
const ALL_CELLS: u32 = 128;
/// By how much, in the sine of an elevation, a place must stand over those before it to be seen on the flat field.
const LEAST_RISE: f64 = 1e-9;

impl Curvature {
    /// A flat base.
    pub const FLAT: Self = Self { per_m: [0.0; 2] };
    /// The largest [`Changed::light`] that is not refused: a choice, as of any bound on an error. Up to here bending adds about
    /// as much to what shadows of grooves are wrong by as 1024 directions leave of them on the flat base (`examples/curved`).
    pub const MOST_CHANGED: f64 = 0.02;
    /// The least that a height may be drawn apart or pushed together by, 1 + curvature times height over the base.
    pub const LEAST_STRETCH: f64 = 0.25;

    /// The most that the base may turn by across a field that does not repeat, radians.
    pub const MOST_ACROSS: f64 = PI;

    /// The same, so many times as strong.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { per_m: self.per_m.map(|k| factor * k) }
    }

    /// Refuses a base that is bent more than what samples see on the flat field tells of; of others, what it changes.
    ///
    /// # Errors
    /// No number; heights too near to the centre of a hollow's curvature; a base that turns by more than half a circle across
    /// a field that does not repeat; [`changed`](Self::changed) beyond
    /// [`MOST_CHANGED`](Self::MOST_CHANGED): the message names about the curvature at which it is reached.
    pub fn check(&self, field: &HeightField, border: Border) -> Result<Changed> {
        const NAME: &str = "curvature of the base";
        let shown = |of: &Self| {
            format!("{:.3e} towards east and {:.3e} towards north, 1/m", of.per_m[0], of.per_m[1])
        };
        if !self.per_m.iter().all(|k| k.is_finite()) {
            return Err(Error::setting(NAME, format!("{:?}", self.per_m), "two numbers, 1/m"));
        }
        if *self == Self::FLAT {
            return Ok(Changed::default());
        }
        let heights = field.heights_m().iter().map(|h| f64::from(*h));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(l, h), z| (l.min(z), h.max(z)));
        for k in self.per_m {
            let least = 1.0 + (k * low).min(k * high);
            if least < Self::LEAST_STRETCH {
                let found = format!(
                    "{}, which pushes the field together to {least:.2} of its width",
                    shown(self)
                );
                let expected = format!(
                    "{} of it or more: radii well beyond the heights, {low:.4} to {high:.4} m about the median",
                    Self::LEAST_STRETCH
                );
                return Err(Error::setting(NAME, found, expected));
            }
        }
        let [cols, rows] = [field.cols(), field.rows()].map(|n| n as f64);
        let across_m = [cols * field.cell_m()[0], rows * field.cell_m()[1]];
        let turned = (self.per_m[0] * across_m[0]).abs().max((self.per_m[1] * across_m[1]).abs());
        if border != Border::Periodic && turned > Self::MOST_ACROSS {
            let found =
                format!("{}, which turns by {turned:.2} radians across the field", shown(self));
            let expected =
                "at most half a circle: beyond it the two ends face each other around the base";
            return Err(Error::setting(NAME, found, expected));
        }
        let changed = self.changed(field, border);
        if changed.light <= Self::MOST_CHANGED {
            return Ok(changed);
        }
        // Between none, where nothing changes, and this.
        let (mut fits, mut breaks) = (0.0, 1.0);
        for _ in 0..8 {
            let middle = 0.5 * (fits + breaks);
            if self.times(middle).changed(field, border).light <= Self::MOST_CHANGED {
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
                100.0 * Self::MOST_CHANGED
            ),
        ))
    }

    /// About what the base changes of what samples see, in the mean over samples: of places that come to be hidden by nearer ones,
    /// and of places that come out behind them.
    ///
    /// Along an azimuth a place is seen where it stands over all before it, as high as from their horizon to itself; sines of
    /// elevations are shares of the hemisphere. Curvature lowers it by k d/2 or so, each by its own distance. What is seen on the flat
    /// field is told to stand, each place from the last, where the base takes it. It stands there from the horizon of all before it,
    /// which is as high or higher: what is told too much is the error, of shadows what comes out over the horizon of all that is
    /// told; of both also by how much that horizon may be off, as places are kept to the nearest sample: half a cell nearer or
    /// farther. At most 512 samples and 16 azimuths of each are picked evenly, and places a cell apart, beyond 128 cells a 128th of
    /// their distance. The field is looked at to its edge; one that repeats as far as the base belongs to it: to where that
    /// has risen or fallen by the relief, but a cell at least and half a circle at most.
    pub fn changed(&self, field: &HeightField, border: Border) -> Changed {
        let samples = field.rows() * field.cols();
        let count = samples.min(SAMPLES);
        // Multiples of the golden section lie evenly, in step with no pattern of the field.
        let golden = 0.5 * (5_f64.sqrt() - 1.0);
        let heights = field.heights_m().iter();
        let (low, high) = heights.fold((f32::MAX, f32::MIN), |(l, h), z| (l.min(*z), h.max(*z)));
        let relief_m = f64::from(high) - f64::from(low);
        let of = |i: usize| {
            let at = match count == samples {
                true => i,
                false => ((i as f64 * golden).fract() * samples as f64) as usize,
            };
            let azimuths = (0..AZIMUTHS).map(|k| TAU * (k as f64 + 0.5) / AZIMUTHS as f64);
            azimuths.map(move |azimuth| {
                let o = DVec2::from_angle(azimuth);
                self.changed_along(field, border, at, (o, self.reach_m(field, relief_m, o)))
            })
        };
        let all = (0..count).flat_map(of);
        let [shadows, light] =
            all.fold([0.0; 2], |[s, l], [shadow, light]| [s + shadow, l + light]);
        let looks = (count * AZIMUTHS) as f64;
        Changed { shadows: shadows / looks, light: light / looks }
    }

    /// How far a field that repeats lies on this base, along o.
    fn reach_m(&self, field: &HeightField, relief_m: f64, o: DVec2) -> f64 {
        let per_m = DVec2::from_array(self.per_m);
        let level_m = (2.0 * relief_m / per_m.dot(o * o).abs()).sqrt();
        let [cell_x, cell_y] = field.cell_m();
        level_m.min(Self::MOST_ACROSS / (per_m * o).length()).max(cell_x.min(cell_y))
    }

    /// Of one sample and azimuth, of a field that repeats up to a reach, m: shadows and light.
    fn changed_along(
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
        // Twice the cosine to the normal, in the middle between two sines of elevation, times their difference: of the
        // hemisphere's ∫ cos = π, an azimuth's share of 2π.
        let light = |low: f64, high: f64| {
            let sine = 0.5 * (low + high);
            2.0 * (high - low)
                * (n.z * sine + facing * (1.0 - sine * sine).max(0.0).sqrt()).max(0.0)
        };
        // Horizons so far: on the flat field; on the base, of all and of what is told. And where the last of these stands.
        let (mut flat, mut bent, mut told) = (-1.0, -1.0, -1.0_f64);
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
            let now = bent_as_far(e, away_m, own, (*self, PI)).z;
            if e.z > flat + LEAST_RISE {
                // What lies beyond a right angle of the base is told as if it were there.
                let here = bent_direction(e, away_m, own, *self).z;
                let as_told = light(last, here.max(last));
                let is_right = turn * distance_m <= MOST_TURN;
                let right = if is_right { light(bent, now.max(bent)).min(as_told) } else { 0.0 };
                changed += as_told - right;
                (flat, last, told) = (e.z, here, here.max(told));
            }
            bent = now.max(bent);
            k += (k / ALL_CELLS).max(1);
        }
        // Half a cell along the way turns what stands there by half as much.
        let half_cell_m = 0.5 * (o.x.abs() * cell_x + o.y.abs() * cell_y);
        let moved = told + 0.5 * turn * half_cell_m * (1.0 - told * told).sqrt();
        let over = (bent - told).max(0.0) + (moved - told);
        [(told + over).max(0.0) - told.max(0.0), changed + light(told, told + over)]
    }
}

/// The surface so far east and north of a sample, over the median; `None` off a field that does not repeat.
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
    // Two triangles a cell, split from the north-west.
    let (north_west, south_east) = (h(0.0, 0.0), h(1.0, 1.0));
    Some(match u > v {
        true => north_west + u * (h(0.0, 1.0) - north_west) + v * (south_east - h(0.0, 1.0)),
        false => north_west + v * (h(1.0, 0.0) - north_west) + u * (south_east - h(1.0, 0.0)),
    })
}
