use super::Surface;
use super::quality::{Quality, within};
use crate::{Error, Result};
use std::ops::RangeInclusive;

/// Light that comes from the surface itself: each sample sees what others throw at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounces {
    /// Times that light may be reflected on its way to a sample, [0..64], default 0: direct light alone.
    /// Time grows in proportion.
    pub count: u32,
    /// How what a sample sees of the surface is found.
    pub engine: BounceEngine,
    /// Azimuths that each sample looks along, [4..1024], default 32. Fewer: faster; narrow things that
    /// shine are seen in some azimuths and missed in others.
    pub azimuths: u32,
    /// Share of the direct light's energy that may be left out, [0..1], default 1/65536. Of a surface that
    /// reflects at most the share a, all bounces from the k-th on carry at most aᵏ + aᵏ⁺¹ + …: the last
    /// ones are dropped. More: faster, darker hollows. 0: none is dropped.
    pub cutoff: f64,
    /// Levels an octave of the pyramid of exit radiance, k, [1..16], default 4. Fewer: less memory, colours of
    /// what stands between two distances smeared. Only with [`BounceEngine::Pyramid`], as is the next.
    pub level_step: u32,
    /// Octaves by which samples look at finer levels of it than their distance asks for, o, [0..4], default 2.
    /// Fewer: soft colours of what is far; more: narrow bright things seen or missed by chance.
    pub level_offset: u32,
    /// What is kept of the light that lobes throw on. Only where the surface has a lobe.
    pub gloss: BounceGloss,
}

impl Default for Bounces {
    fn default() -> Self {
        Self::NONE
    }
}

impl Bounces {
    /// The default: direct light alone.
    pub const NONE: Self = Self {
        count: 0,
        engine: BounceEngine::Auto,
        azimuths: 32,
        cutoff: 1.0 / 65536.0,
        level_step: 4,
        level_offset: 2,
        gloss: BounceGloss::Vector,
    };
    /// What [`count`](Self::count) may be.
    pub const COUNT: RangeInclusive<u32> = 0..=64;
    /// What [`azimuths`](Self::azimuths) may be.
    pub const AZIMUTHS: RangeInclusive<u32> = 4..=1024;

    /// Checks every range.
    ///
    /// # Errors
    /// The first setting out of range, by its name on the command line.
    pub fn check(&self) -> Result<()> {
        within("--bounces", self.count, Self::COUNT)?;
        within("--bounce-azimuths", self.azimuths, Self::AZIMUTHS)?;
        if !(0.0..=1.0).contains(&self.cutoff) {
            let found = self.cutoff.to_string();
            return Err(Error::setting("--bounce-cutoff", found, "a share from 0 to 1"));
        }
        within("--bounce-level-step", self.level_step, Quality::LEVEL_STEP)?;
        within("--bounce-level-offset", self.level_offset, Quality::LEVEL_OFFSET)
    }

    /// Whether what a sweep along lines has met is walked over for the light that such a surface throws.
    pub(crate) fn walk_over(&self, surface: &Surface) -> bool {
        let albedo = surface.most_reflected();
        self.engine == BounceEngine::Sweep && self.worth_drawing(albedo) > 0
    }

    /// How many of them are drawn on a surface that reflects at most the share `albedo`: the fewest that
    /// leave out no more than [`cutoff`](Self::cutoff).
    pub fn worth_drawing(&self, albedo: f64) -> u32 {
        let mut left = 0.0;
        let is_worth = |k: &u32| {
            left += albedo.powi(*k as i32);
            left > self.cutoff
        };
        (1..=self.count).rev().find(is_worth).unwrap_or(0)
    }
}

/// How what a sample sees of the surface is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BounceEngine {
    /// The planner's choice: [`Sweep`](Self::Sweep) where horizons come from a sweep along lines, else
    /// [`Brute`](Self::Brute). On four real fields under two environments the former took 0.1 to 0.4 of the latter's
    /// time and was as near to light paths (`examples/bounce`).
    #[default]
    Auto,
    /// Every stretch of the surface that a sample sees along each azimuth, in closed form: exact but for the
    /// azimuths, and slower in proportion to the side.
    Brute,
    /// Those stretches of the surface that a sample sees on its own lines at every march step, found through what
    /// a sweep along lines has met: a hull tree (Timonen 2012). Needs such a sweep.
    Sweep,
    /// One sample a level of a pyramid of heights, as [`Method::Pyramid`](super::Method::Pyramid) with its levels,
    /// and of one of exit radiance (Nowrouzezahrai & Snyder 2009): time in proportion to the samples and the
    /// logarithm of the side, error whatever the settings.
    Pyramid,
}

impl BounceEngine {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            BounceEngine::Auto => "auto",
            BounceEngine::Brute => "brute",
            BounceEngine::Sweep => "sweep",
            BounceEngine::Pyramid => "pyramid",
        }
    }
}

/// What is kept of the light that lobes throw on, at every texel of the pyramid of exit radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BounceGloss {
    /// Exit radiance by direction, as spherical harmonics of the order that what is seen has: each sample is lit by what
    /// shines towards it (Nowrouzezahrai & Snyder 2009, §5.3). Memory: n² colours a texel.
    #[default]
    Vector,
    /// The same as f16: half the memory, radiance rounded to 1/2048 of itself and held below 65504.
    VectorF16,
    /// Exit radiance as seen from above, as if it were diffuse: one colour a texel, wrong by direction.
    Scalar,
}

impl BounceGloss {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            BounceGloss::Vector => "vector",
            BounceGloss::VectorF16 => "vector-f16",
            BounceGloss::Scalar => "scalar",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At ½ the 10th and later of 12 carry 2⁻¹⁰ + 2⁻¹¹ + 2⁻¹², those from the 9th on 2⁻⁹ more.
    #[test]
    fn what_is_dropped_is_what_may_be_left_out() {
        let of = |count, cutoff| Bounces { count, cutoff, ..Bounces::default() };
        let late = (0..3).map(|k| 2_f64.powi(-10 - k)).sum::<f64>();
        assert_eq!(of(12, late).worth_drawing(0.5), 9);
        assert_eq!(of(12, 0.999 * late).worth_drawing(0.5), 10);
        assert_eq!(of(12, 0.0).worth_drawing(0.5), 12);
        assert_eq!(of(12, 1.0 / 65536.0).worth_drawing(1.0), 12);
        for cutoff in [0.0, 1.0] {
            assert_eq!(of(12, cutoff).worth_drawing(0.0), 0);
        }
        assert_eq!(of(0, 0.0).worth_drawing(1.0), 0);
        assert!(of(65, 0.0).check().unwrap_err().to_string().contains("--bounces"));
        assert!(of(1, f64::NAN).check().unwrap_err().to_string().contains("--bounce-cutoff"));
    }
}
