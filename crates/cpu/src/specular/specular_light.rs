//! Phong specular reflection of sky and environment: the unoccluded reflection times the share that horizons leave free.

use crate::specular_tables::Tabulated;
use crate::tolerance::{ARC_TANGENT, EPSILON};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A map over the mirror direction, row-major from straight down, column 0 east.
#[derive(Clone, Copy, Debug)]
pub struct Map<'a> {
    /// Stored columns and rows.
    pub size: [usize; 2],
    /// Columns of a whole turn: the stored ones repeat.
    pub columns: usize,
    /// Its texels.
    pub texels: &'a [DVec3],
}

/// Weights of a cubic through four values, between the second and the third (Catmull-Rom).
fn cubic(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [-t3 + 2.0 * t2 - t, 3.0 * t3 - 5.0 * t2 + 2.0, -3.0 * t3 + 4.0 * t2 + t, t3 - t2]
        .map(|w| 0.5 * w)
}

impl Map<'_> {
    /// A texel; past a pole, the one on its other side.
    fn at(&self, x: i64, y: i64) -> DVec3 {
        let [width, height] = self.size.map(|n| n as i64);
        let half = self.columns as i64 / 2;
        let (x, y) = match y {
            y if y < 0 => (x + half, -y),
            y if y >= height => (x + half, 2 * (height - 1) - y),
            y => (x, y),
        };
        self.texels[(y * width + x.rem_euclid(width)) as usize]
    }

    /// The value in a direction that errs by `off_rad`.
    ///
    /// A cubic changes by no more than 1.5 of the range of its texels a cell; its weights sum to 1.25 at most by magnitude and err
    /// by 10 ε. A place errs by the direction over the distance from the axis, an arc tangent and 6 ε of the turn.
    pub fn looked_up(&self, direction: DVec3, off_rad: f64) -> Tabulated {
        let (width, height) = (self.columns, self.size[1]);
        let flat = direction.x.hypot(direction.y);
        let turn = direction.y.atan2(direction.x).rem_euclid(TAU);
        let place_x = turn / TAU * width as f64;
        let place_y = (direction.z.atan2(flat) + FRAC_PI_2) / PI * (height - 1) as f64;
        let (x, y) = (place_x as i64, (place_y as i64).min(height as i64 - 2));
        let (across, up) = (cubic(place_x - x as f64), cubic(place_y - y as f64));
        let (mut light, mut low, mut high) = (DVec3::ZERO, DVec3::MAX, DVec3::MIN);
        for j in 0..4 {
            for i in 0..4 {
                let texel = self.at(x + i - 1, y + j - 1);
                light += across[i as usize] * up[j as usize] * texel;
                (low, high) = (low.min(texel), high.max(texel));
            }
        }
        let angle = ARC_TANGENT + 6.0 * EPSILON * TAU;
        let off_x = ((off_rad / flat.max(1e-9)).min(PI) + angle) / TAU * width as f64;
        let off_y = (off_rad + angle) / PI * (height - 1) as f64;
        let moved = 1.25 * 1.5 * (off_x + off_y) * (high - low);
        Tabulated { light, tolerance: moved + 2.0 * 20.0 * EPSILON * high.max(-low) }
    }
}

/// Unoccluded light at a fractional index, `place`, of `count` exponent levels: Lagrange interpolation through the four nearest, or
/// through all if there are fewer.
///
/// The index errs by `off_place`. Lagrange weights at four equally spaced nodes are at most 1.06 in magnitude, change by at most 3 per
/// level, and have an error of 12 ε.
pub fn between_levels(
    (place, off_place): (f64, f64),
    count: usize,
    level: impl Fn(usize) -> Tabulated,
) -> Tabulated {
    let used = count.min(4);
    let first = (place as usize).saturating_sub(1).min(count - used);
    let mut sum = Tabulated::default();
    let off = if used > 1 { 3.0 * off_place + 12.0 * EPSILON } else { 0.0 };
    for i in 0..used {
        let others = (0..used).filter(|j| *j != i);
        let of = |j: usize| (place - (first + j) as f64) / (i as f64 - j as f64);
        let weight: f64 = others.map(of).product();
        let Tabulated { light, tolerance } = level(first + i);
        sum.light += weight * light;
        sum.tolerance += weight.abs() * tolerance + off * light.abs();
    }
    sum
}

/// The share of a level's light that horizons hide.
pub fn hidden_share(swept: &Tabulated, blocked: DVec3) -> Tabulated {
    let mut all = Tabulated::default();
    for c in 0..3 {
        let (b, t) = (blocked[c], swept.light[c]);
        all.light[c] = if b <= 0.0 { 0.0 } else { b / t.max(b) };
        // The relative error of the share includes that of `swept`, its divisor.
        let off = swept.tolerance[c] / t.max(b).max(1e-30) + 8.0 * EPSILON;
        all.tolerance[c] = (all.light[c] * off).min(1.0);
    }
    all
}

/// Exit radiance for scale 1, from what horizons hide at one level, or at two, a share of `t` from the first to the second, which errs
/// by `off_t`.
pub fn specular_light(
    whole: &Tabulated,
    hidden: &[Tabulated],
    (t, off_t): (f64, f64),
) -> Tabulated {
    let unoccluded = whole.light.max(DVec3::ZERO);
    let of = |of: fn(&Tabulated) -> DVec3| match hidden {
        [one] => of(one),
        [one, above, ..] => of(one).lerp(of(above), t),
        [] => DVec3::ZERO,
    };
    let (share, off) = (of(|one| one.light), of(|one| one.tolerance));
    let between = match hidden {
        [one, above, ..] => (one.light - above.light).abs() * (off_t + 4.0 * EPSILON),
        _ => DVec3::ZERO,
    };
    Tabulated {
        light: unoccluded * (1.0 - share),
        tolerance: whole.tolerance + unoccluded * (off + between + 4.0 * EPSILON),
    }
}
