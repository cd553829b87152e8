use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{Border, HeightField};
use crate::cpu::light::normal;
use crate::cpu::points_bend::{MOST_TURN, bent_direction};
use crate::{Error, Result};

/// Curvature of the base that a field lies on, whose principal directions are east and north: that of a surface through
/// the field's [`base_m`](HeightField::base_m), its median height.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    /// One over the radius towards east and towards north, 1/m; above 0 where the base bends down (a ball from outside, on
    /// which valleys widen), below 0 where it is hollow.
    pub per_m: [f64; 2],
}

/// Samples whose views are compared.
const SAMPLES: usize = 512;
/// Azimuths of each.
const AZIMUTHS: usize = 16;
/// By how much, in the sine of an elevation, a place must stand over those before it to be seen.
const LEAST_RISE: f64 = 1e-9;

impl Curvature {
    /// A flat base.
    pub const FLAT: Self = Self { per_m: [0.0; 2] };
    /// The largest share of a hemisphere's light that a sample may receive from elsewhere than the flat field's visible points say,
    /// in the mean over samples. Fitted: up to here adapted shadows of bent grooves are wrong of up to 2.2 % more lights than those
    /// of flat ones, and well beyond it of 6 % and more (`examples/curved` finds it again).
    pub const MOST_CHANGED: f64 = 0.02;
    /// The least that a height may be drawn apart or pushed together by, 1 + curvature times height over the base.
    pub const LEAST_STRETCH: f64 = 0.25;

    /// The same, so many times as strong.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { per_m: self.per_m.map(|k| factor * k) }
    }

    /// Refuses a base that is bent more than what samples see on the flat field tells of.
    ///
    /// # Errors
    /// No number; heights too near to the centre of a hollow's curvature; [`changed`](Self::changed) beyond
    /// [`MOST_CHANGED`](Self::MOST_CHANGED): the message names the curvature at which it is reached.
    pub fn check(&self, field: &HeightField, border: Border) -> Result<()> {
        const NAME: &str = "curvature of the base";
        let shown = |of: &Self| {
            format!("{:.3e} towards east and {:.3e} towards north, 1/m", of.per_m[0], of.per_m[1])
        };
        if !self.per_m.iter().all(|k| k.is_finite()) {
            return Err(Error::setting(NAME, format!("{:?}", self.per_m), "two numbers, 1/m"));
        }
        if *self == Self::FLAT {
            return Ok(());
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
        let changed = self.changed(field, border);
        if changed <= Self::MOST_CHANGED {
            return Ok(());
        }
        // Between none, where nothing changes, and this.
        let (mut fits, mut breaks) = (0.0, 1.0);
        for _ in 0..8 {
            let middle = 0.5 * (fits + breaks);
            if self.times(middle).changed(field, border) <= Self::MOST_CHANGED {
                fits = middle;
            } else {
                breaks = middle;
            }
        }
        Err(Error::setting(
            NAME,
            format!(
                "{}, which changes what is seen in {:.1} % of the hemisphere",
                shown(self),
                100.0 * changed
            ),
            format!(
                "at most {}: there it is {} %, and the flat field's visible points tell of no more",
                shown(&self.times(fits)),
                100.0 * Self::MOST_CHANGED
            ),
        ))
    }

    /// From what share of the hemisphere, by the cosine to its normal, a sample receives light of something else than the flat
    /// field's visible points say, in the mean over samples: of places that come to be hidden by nearer ones, and of places that come
    /// out behind them.
    ///
    /// Along an azimuth a place is seen where it stands over all before it. Curvature lowers it by k d/2 or so, each by its own
    /// distance: a place is lost where it stood over those before it and stands under one, by as much as it stood over
    /// them; one is laid open the other way round, by as much as it stands over them now. Differences of the sine
    /// of the elevation are shares of the hemisphere. Samples and azimuths are picked evenly; the field is looked at as far as
    /// it reaches, one that repeats for one repetition.
    pub fn changed(&self, field: &HeightField, border: Border) -> f64 {
        let samples = field.rows() * field.cols();
        let count = samples.min(SAMPLES);
        // Multiples of the golden section lie evenly, in step with no pattern of the field.
        let golden = 0.5 * (5_f64.sqrt() - 1.0);
        let of = |i: usize| {
            let at = match count == samples {
                true => i,
                false => ((i as f64 * golden).fract() * samples as f64) as usize,
            };
            (0..AZIMUTHS)
                .map(|k| {
                    self.changed_along(field, border, at, TAU * (k as f64 + 0.5) / AZIMUTHS as f64)
                })
                .sum::<f64>()
        };
        (0..count).map(of).sum::<f64>() / (count * AZIMUTHS) as f64
    }

    /// Of one sample and azimuth.
    fn changed_along(
        &self,
        field: &HeightField,
        border: Border,
        at: usize,
        azimuth_rad: f64,
    ) -> f64 {
        let own = f64::from(field.heights_m()[at]);
        let [cell_x, cell_y] = field.cell_m();
        let o = DVec2::from_angle(azimuth_rad);
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
        let (mut flat, mut bent) = (-1.0, -1.0);
        let mut changed = 0.0;
        for k in 1.. {
            let distance_m = step_m * k as f64;
            let Some(height) = height_at(field, border, at, o * distance_m) else { break };
            let to = DVec3::new(o.x * distance_m, o.y * distance_m, height - own);
            let (away_m, e) = (to.length(), to.normalize());
            let now = bent_direction(e, away_m, own, *self).z;
            let (stood, stands) = (e.z - flat, now - bent);
            // What the base turns away by more than a right angle is not told of.
            let is_told = turn * distance_m <= MOST_TURN;
            let was = || light(flat, e.z);
            let is = || light(bent, now);
            changed += match (stood > LEAST_RISE, stands > LEAST_RISE) {
                (true, false) => was(),
                (false, true) => is(),
                (true, true) if !is_told => was().max(is()),
                _ => 0.0,
            };
            (flat, bent) = (e.z.max(flat), now.max(bent));
        }
        changed
    }
}

/// The surface so far east and north of a sample, over the median; `None` off the field, of one that repeats beyond its
/// longer side.
fn height_at(field: &HeightField, border: Border, at: usize, away: DVec2) -> Option<f64> {
    let (rows, cols) = (field.rows(), field.cols());
    let [cell_x, cell_y] = field.cell_m();
    let (right, down) = (away.x / cell_x, -away.y / cell_y);
    let is_periodic = border == Border::Periodic;
    // Not its own side each: so few rows as grooves are told by would end what runs along the columns.
    let reach = cols.max(rows) as f64;
    if is_periodic && (right.abs() > reach || down.abs() > reach) {
        return None;
    }
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
