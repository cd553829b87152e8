//! The far-field BRDF of a height field, tabulated for pairs of directions.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::brdf_harmonics::weighted;
use ridgelight::scene::Directions;
use ridgelight::{Error, Result};

/// A grid of directions over the upper hemisphere. Direction k · azimuths + j has the zenith angle
/// (k + ½) π/2 / zeniths and the azimuth 2π j / azimuths, counter-clockwise from east.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Angles {
    /// Zenith angles from 0 to π/2, [2..64].
    pub zeniths: usize,
    /// Azimuths of a full circle, [4..256].
    pub azimuths: usize,
}

impl Angles {
    /// # Errors
    /// Counts out of range, or more than [`Directions::COUNT`] in total.
    pub fn check(&self) -> Result<()> {
        let count = self.zeniths.saturating_mul(self.azimuths);
        let is_right = (2..=64).contains(&self.zeniths) && (4..=256).contains(&self.azimuths);
        if is_right && count <= *Directions::COUNT.end() {
            return Ok(());
        }
        let expected = format!(
            "2 to 64 zenith angles times 4 to 256 azimuths, {} together at most",
            Directions::COUNT.end()
        );
        Err(Error::setting("angles", format!("{}x{}", self.zeniths, self.azimuths), expected))
    }

    /// Number of directions.
    pub fn count(&self) -> usize {
        self.zeniths * self.azimuths
    }

    /// The directions, in order.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn directions(&self) -> Result<Directions> {
        self.check()?;
        let vectors = (0..self.count()).map(|i| {
            let zenith = (i / self.azimuths) as f64 + 0.5;
            let (sin, cos) = (zenith * FRAC_PI_2 / self.zeniths as f64).sin_cos();
            let (y, x) = (TAU * (i % self.azimuths) as f64 / self.azimuths as f64).sin_cos();
            DVec3::new(sin * x, sin * y, cos)
        });
        Directions::from_vectors(vectors.collect(), 0.0)
    }

    /// ∫ cos θ dω over each direction's cell of the hemisphere. The sum is π.
    pub fn projected_sr(&self) -> Vec<f64> {
        let edge = |k: usize| (k as f64 * FRAC_PI_2 / self.zeniths as f64).sin().powi(2);
        let of = |i: usize| {
            let k = i / self.azimuths;
            PI / self.azimuths as f64 * (edge(k + 1) - edge(k))
        };
        (0..self.count()).map(of).collect()
    }

    /// The four neighbours of a direction above horizontal, and their bilinear weights. Zenith
    /// angles beyond the first and the last are clamped.
    pub fn around(&self, e: DVec3) -> [(usize, f64); 4] {
        let zenith = e.z.clamp(-1.0, 1.0).acos() / FRAC_PI_2 * self.zeniths as f64 - 0.5;
        let zenith = zenith.clamp(0.0, (self.zeniths - 1) as f64);
        let turn = (e.y.atan2(e.x) / TAU).rem_euclid(1.0) * self.azimuths as f64;
        let (k, j) = (zenith.floor(), turn.floor());
        let (down, on) = (zenith - k, turn - j);
        let at = |k: usize, j: usize| k.min(self.zeniths - 1) * self.azimuths + j % self.azimuths;
        let (k, j) = (k as usize, j as usize);
        [
            (at(k, j), (1.0 - down) * (1.0 - on)),
            (at(k, j + 1), (1.0 - down) * on),
            (at(k + 1, j), down * (1.0 - on)),
            (at(k + 1, j + 1), down * on),
        ]
    }
}

/// Pairs of light and view directions; all lights come first. A four-dimensional low-discrepancy
/// sequence (additive recurrence by the powers of the root of x⁵ = x + 1: Roberts 2018), whose
/// start `seed` sets. Lights and views are each distributed in proportion to cos θ dω.
///
/// # Errors
/// A count of 0, or above half of what [`Directions::COUNT`] allows.
pub fn pairs(count: usize, seed: u32) -> Result<Directions> {
    const ROOT: f64 = 1.167_303_978_261_418_7;
    let most = Directions::COUNT.end() / 2;
    if !(1..=most).contains(&count) {
        return Err(Error::setting("pairs", count.to_string(), format!("1 to {most}")));
    }
    let begin = f64::from(seed) * 2_f64.sqrt();
    let place = |i: usize, axis: i32| (begin + (i + 1) as f64 / ROOT.powi(axis)).fract();
    let of = |i: usize, axis: i32| {
        let (height, turn) = (1.0 - place(i, axis), TAU * place(i, axis + 1));
        let across = (1.0 - height).sqrt();
        DVec3::new(across * turn.cos(), across * turn.sin(), height.sqrt())
    };
    let lights = (0..count).map(|i| of(i, 1));
    Directions::from_vectors(lights.chain((0..count).map(|i| of(i, 3))).collect(), 0.0)
}

/// A square table over the same directions for lights and views, R, G, B, 1/sr: see [`Facets`](super::Facets).
#[derive(Clone, Debug, PartialEq)]
pub struct Brdf {
    directions: Vec<DVec3>,
    values: Vec<[f64; 3]>,
}

impl Brdf {
    /// A table of known values, all views of the first light first.
    ///
    /// # Errors
    /// Another number of values than pairs.
    pub fn from_values(directions: Vec<DVec3>, values: Vec<[f64; 3]>) -> Result<Self> {
        let pairs = directions.len().pow(2);
        if values.len() == pairs {
            return Ok(Self { directions, values });
        }
        Err(Error::setting("values of pairs", values.len().to_string(), pairs.to_string()))
    }

    /// Directions of the lights and of the views.
    pub fn directions(&self) -> &[DVec3] {
        &self.directions
    }

    /// Value for a light and a view, by index.
    ///
    /// # Panics
    /// An index outside the table.
    pub fn at(&self, light: usize, view: usize) -> [f64; 3] {
        self.values[light * self.directions.len() + view]
    }

    /// Interpolated value for unit vectors above horizontal. `angles` must be those of the table.
    ///
    /// # Panics
    /// More angles than the table has.
    pub fn between(&self, angles: &Angles, light: DVec3, view: DVec3) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (l, of_light) in angles.around(light) {
            for (v, of_view) in angles.around(view) {
                let value = self.at(l, v);
                (0..3).for_each(|c| sum[c] += of_light * of_view * value[c]);
            }
        }
        sum
    }

    /// Share of a light's irradiance that leaves again, R, G, B: the sum over all views, weighted
    /// by `projected_sr`, which adds up to π. With Phong specular it may exceed 1: see
    /// [`Facets`](super::Facets). It is a sum, not an integral: it is meaningless for a Phong lobe
    /// narrower than the spacing of the directions.
    pub fn reflected(&self, light: usize, projected_sr: &[f64]) -> [f64; 3] {
        weighted((0..projected_sr.len()).map(|view| self.at(light, view)), projected_sr)
    }

    /// Radiance of a view under a light of 1 from all sides, R, G, B: the sum over all lights,
    /// weighted by `projected_sr`, which adds up to π. Where [`closure`](super::Facets::closure) is
    /// 1, the integral is at most the sum of diffuse and specular reflectance. The sum differs from
    /// the integral where a Phong lobe is much narrower than the spacing of the directions: such a
    /// lobe counts for its density times a direction's solid angle, many times 1 at its centre and
    /// 0 beside it.
    pub fn gathered(&self, view: usize, projected_sr: &[f64]) -> [f64; 3] {
        weighted((0..projected_sr.len()).map(|light| self.at(light, view)), projected_sr)
    }

    /// Fails unless the table is one over `angles`.
    pub(crate) fn check_angles(&self, angles: Angles) -> Result<()> {
        let (own, count) = (self.directions.len(), angles.count());
        if own == count {
            return Ok(());
        }
        let found = format!("{own} directions");
        Err(Error::setting("angles of a table", found, count.to_string()))
    }

    /// Departure from reciprocity: rms of half the difference when light and view are exchanged,
    /// over the rms of all values, all channels.
    pub fn unreciprocal(&self) -> f64 {
        let (mut apart, mut all) = (0.0, 0.0);
        let count = self.directions.len();
        for (light, view) in (0..count * count).map(|i| (i / count, i % count)) {
            for (a, b) in self.at(light, view).into_iter().zip(self.at(view, light)) {
                apart += 0.25 * (a - b).powi(2);
                all += a * a;
            }
        }
        (apart / f64::max(all, f64::MIN_POSITIVE)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::pairs;

    /// Refused before any memory is allocated.
    #[test]
    fn pairs_are_bounded() {
        for count in [0, 2049, usize::MAX] {
            assert!(pairs(count, 0).unwrap_err().to_string().contains("1 to 2048"), "{count}");
        }
        assert_eq!(pairs(2048, 0).unwrap().count(), 4096);
    }
}
