use super::Surface;
use super::quality::{Quality, within};
use crate::{Error, Result};
use std::ops::RangeInclusive;

/// Indirect light: light that the surface reflects onto itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounces {
    /// Number of bounces, [0..64], default 0: direct light only. Time grows in proportion.
    pub count: u32,
    /// How the surface visible from each texel is found.
    pub engine: BounceEngine,
    /// Azimuths per texel, [4..1024], default 32. Fewer: faster; narrow bright features are hit in some azimuths and missed
    /// in others.
    pub azimuths: u32,
    /// Share of the direct light's energy that may be dropped, [0..1], default 1/65536. With the largest reflectance a, all
    /// bounces from the k-th on carry at most aᵏ + aᵏ⁺¹ + …; the last ones are dropped. Higher: faster, darker hollows. 0
    /// drops none.
    pub cutoff: f64,
    /// Levels per octave of the pyramid of exit radiance, k, [1..16], default 4. Fewer: less memory, colours between two
    /// distances blur. Used by [`BounceEngine::Pyramid`] only, like the next field.
    pub level_step: u32,
    /// Octaves by which the level is finer than the distance requires, o, [0..4], default 2. Fewer: distant colours blur;
    /// more: narrow bright features alias.
    pub level_offset: u32,
    /// How specular exit radiance is stored for the next bounce. Only where the surface has a specular lobe.
    pub specular: BounceSpecular,
}

impl Default for Bounces {
    fn default() -> Self {
        Self::NONE
    }
}

impl Bounces {
    /// The default: direct light only.
    pub const NONE: Self = Self {
        count: 0,
        engine: BounceEngine::Auto,
        azimuths: 32,
        cutoff: 1.0 / 65536.0,
        level_step: 4,
        level_offset: 2,
        specular: BounceSpecular::Vector,
    };
    /// Range of [`count`](Self::count).
    pub const COUNT: RangeInclusive<u32> = 0..=64;
    /// Range of [`azimuths`](Self::azimuths).
    pub const AZIMUTHS: RangeInclusive<u32> = 4..=1024;

    /// Checks every range.
    ///
    /// # Errors
    /// The first setting out of range, by its name on the command line.
    pub fn check(&self) -> Result<()> {
        within("bounces", self.count, Self::COUNT)?;
        within("bounce_azimuths", self.azimuths, Self::AZIMUTHS)?;
        if !(0.0..=1.0).contains(&self.cutoff) {
            let found = self.cutoff.to_string();
            return Err(Error::setting("bounce_cutoff", found, "a share from 0 to 1"));
        }
        within("bounce_level_step", self.level_step, Quality::LEVEL_STEP)?;
        within("bounce_level_offset", self.level_offset, Quality::LEVEL_OFFSET)
    }

    /// Whether bounces on this surface walk over the occluders of a sweep along lines.
    pub(crate) fn walk_over(&self, surface: &Surface) -> bool {
        let albedo = surface.max_reflectance();
        self.engine == BounceEngine::Sweep && self.needed_bounces(albedo) > 0
    }

    /// Bounces to compute at the largest reflectance `albedo`: the fewest that drop no more than [`cutoff`](Self::cutoff).
    pub fn needed_bounces(&self, albedo: f64) -> u32 {
        let mut left = 0.0;
        let is_worth = |k: &u32| {
            left += albedo.powi(*k as i32);
            left > self.cutoff
        };
        (1..=self.count).rev().find(is_worth).unwrap_or(0)
    }
}

/// How the surface visible from each texel is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BounceEngine {
    /// The planner's choice: [`Sweep`](Self::Sweep) where horizons come from a sweep along lines, else
    /// [`BruteForce`](Self::BruteForce). On four real fields under two environments `Sweep` took 0.1 to 0.4 of the time of
    /// `BruteForce` with the same error against the path-traced reference (`examples/bounce`).
    #[default]
    Auto,
    /// Every visible interval along each azimuth, in closed form: exact but for the azimuths. Time per texel grows with the
    /// side of the field.
    BruteForce,
    /// The visible intervals on the texel's own lines at every march step, found in the hull tree of a sweep along lines
    /// (Timonen 2012). Needs such a sweep.
    Sweep,
    /// One sample per level of a height pyramid, as [`Method::Pyramid`](super::Method::Pyramid) with its levels, and of a
    /// pyramid of exit radiance (Nowrouzezahrai & Snyder 2009). Time is proportional to the texels and to the logarithm of
    /// the side. Approximate at any setting.
    Pyramid,
}

impl BounceEngine {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            BounceEngine::Auto => "auto",
            BounceEngine::BruteForce => "brute-force",
            BounceEngine::Sweep => "sweep",
            BounceEngine::Pyramid => "pyramid",
        }
    }
}

/// How specular exit radiance is stored at every texel of its pyramid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BounceSpecular {
    /// By direction, as spherical harmonics of the order of visibility: each texel receives what leaves towards it
    /// (Nowrouzezahrai & Snyder 2009, §5.3). Memory: n² colours per texel.
    #[default]
    Vector,
    /// As `Vector` in f16: half the memory, rounded to 1/2048, below 65504.
    VectorF16,
    /// As seen from above, treated as diffuse: one colour per texel, with an error that depends on direction.
    Scalar,
}

impl BounceSpecular {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            BounceSpecular::Vector => "vector",
            BounceSpecular::VectorF16 => "vector-f16",
            BounceSpecular::Scalar => "scalar",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At ½, bounces 10 to 12 carry 2⁻¹⁰ + 2⁻¹¹ + 2⁻¹²; from the 9th on, 2⁻⁹ more.
    #[test]
    fn needed_bounces_drops_what_the_cutoff_allows() {
        let of = |count, cutoff| Bounces { count, cutoff, ..Bounces::default() };
        let late = (0..3).map(|k| 2_f64.powi(-10 - k)).sum::<f64>();
        assert_eq!(of(12, late).needed_bounces(0.5), 9);
        assert_eq!(of(12, 0.999 * late).needed_bounces(0.5), 10);
        assert_eq!(of(12, 0.0).needed_bounces(0.5), 12);
        assert_eq!(of(12, 1.0 / 65536.0).needed_bounces(1.0), 12);
        for cutoff in [0.0, 1.0] {
            assert_eq!(of(12, cutoff).needed_bounces(0.0), 0);
        }
        assert_eq!(of(0, 0.0).needed_bounces(1.0), 0);
        assert!(of(65, 0.0).check().unwrap_err().to_string().contains("bounces"));
        assert!(of(1, f64::NAN).check().unwrap_err().to_string().contains("bounce_cutoff"));
    }
}
