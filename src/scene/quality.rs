//! Every setting, defined once. See [`Setting`] for what follows from a definition, and docs/adding/index.md for how to add one.

mod suited;

use super::Surface;
use super::choices::{
    Basis, BounceEngine, BounceSpecular, Fuse, Hull, Levels, LightBasis, Lines, Method, Precision,
    Receiver, Wedges, Window,
};
use super::settings::{Audience, Setting, Text, Values, settings};
use crate::Result;

settings! {
    /// Settings that trade speed for accuracy.
    pub struct Quality of Quality::own, with bounces: Bounces, {
        /// Method that finds horizons
        ///
        /// A sweep takes constant time per texel and azimuth. Brute force is exact and slower; the pyramid is approximate.
        Advanced "method" method: Method = Method::Auto, Method::WORDS;

        /// Azimuths of sky and environment, 4 to 1024
        ///
        /// Fewer show banding; more take time and memory in proportion. With specular under a sky or an environment on steep ground,
        /// commands use 64 to 256 by default, depending on the exponent; with `basis sh` they use 32.
        ///
        /// Under an environment they are densest where it is brightest when the plan is made (even with exact lines and
        /// with harmonics); an environment that changes later keeps them.
        Everyone "azimuths" azimuths: u32 = 32, Values::Whole(4..=1024);

        /// Slices across a sun, key light or sphere light, 1 to 256
        ///
        /// Fewer show steps in soft shadows; more take time in proportion. A wide sun needs more.
        ///
        /// A key light has `sun_azimuths` × width / 25° slices, clamped to between half and 4 × `sun_azimuths`. A sphere light has up to
        /// 8 × `sun_azimuths` at texels where its angular width is large, and fewer if it is narrower than a cell.
        Advanced "sun_azimuths" sun_azimuths: u32 = 8, Values::Whole(1..=256);

        /// Basis of an environment's light
        ///
        /// Tables store the light of each azimuth; spherical harmonics are smoother and approximate.
        Advanced "basis" basis: Basis = Basis::Auto, Basis::WORDS;

        /// SH order, 2 to 6; stores order^2 coefficients per texel
        ///
        /// Lower blurs the light; higher takes more time and memory. With `basis sh` or `light_basis sh`, and for
        /// specular with bounces.
        Advanced "sh_order" sh_order: u32 = 4, Values::Whole(2..=6);

        /// Cells between the lines of a sweep
        ///
        /// With wider spacing the sweep is faster and less exact; shading takes as long. "exact" puts every texel on a line and counts every crossing.
        Expert "lines" lines: Lines = Lines::Cell, Lines::WORDS;

        /// Interpolation of the results of lines to texels
        ///
        /// aimed-around is the most exact. On llvmpipe, with lines one cell apart, a frame with aimed-nearest takes 0.4 to 0.8
        /// times as long. aimed-nearest is as fast as nearest, and more exact than nearest, slopes and own. Exact shadows do not
        /// depend on the fuse.
        ///
        /// Times and errors: benches/results/defaults.txt; of nearest, slopes and own: accuracy_N44W072.txt there.
        Expert "fuse" fuse: Fuse = Fuse::AimedAround, Fuse::WORDS;

        /// Precision of what a sweep stores
        ///
        /// f16 and packed take half the memory and lose accuracy. packed holds an f16 height and a u16 distance on the hull.
        Expert "precision" precision: Precision = Precision::F32, Precision::WORDS;

        /// Memory that stores the hull of a sweep
        ///
        /// Changes time and memory, never the result.
        Expert "hull" hull: Hull = Hull::Auto, Hull::WORDS;

        /// Ignore a sphere light below this fraction of the brightest one, 0 to 1, default 1/65536
        ///
        /// Higher is faster and less exact.
        ///
        /// Sphere lights are ignored where together they add less than this fraction of the brightest value that one of
        /// them can give to its nearest grid point. The default is one step of a 16-bit image. 0 ignores none.
        Expert "light_cutoff" light_cutoff: f64 = 1.0 / 65536.0, Values::Share;

        /// Basis of sphere lights
        ///
        /// "sh" is approximate. It uses `sh_order`, `wedges`, `receiver` and `window`, and horizons of `method pyramid`.
        Expert "light_basis" light_basis: LightBasis = LightBasis::Exact, LightBasis::WORDS;

        /// Height pyramid levels per doubling of distance, 1 to 16
        ///
        /// Fewer miss more occluders; more take time in proportion. With `method pyramid`.
        Expert "level_step" level_step: u32 = 4, Values::Whole(1..=16);

        /// Doublings of resolution that a pyramid adds to what the distance needs, 0 to 4
        ///
        /// More make distant horizons sharper, but miss more of them between grid points. With `method pyramid`.
        Expert "level_offset" level_offset: u32 = 2, Values::Whole(0..=4);

        /// Storage of a pyramid's levels
        Expert "levels" levels: Levels = Levels::Stack, Levels::WORDS;

        /// Elevations in an environment's table, 8 to 4096
        ///
        /// Fewer blur the light; more take memory in proportion. With `basis table`.
        Expert "table_elevations" table_elevations: u32 = 256, Values::Whole(8..=4096);

        /// Projection of the visible part of an azimuth to harmonics
        ///
        /// With `basis sh` or `light_basis sh`.
        Expert "wedges" wedges: Wedges = Wedges::Slices, Wedges::WORDS;

        /// Horizons along each side of a table of wedges, 4 to 256
        ///
        /// Fewer are less exact; memory grows with the square. With `wedges table`.
        Expert "wedge_side" wedge_side: u32 = 64, Values::Whole(4..=256);

        /// Cosine at the receiving surface, in harmonics
        ///
        /// With `basis sh` or `light_basis sh`.
        Expert "receiver" receiver: Receiver = Receiver::Plane, Receiver::WORDS;

        /// SH window of a light, against ringing
        ///
        /// A stronger window blurs the light; a weaker one may ring. With `basis sh` or `light_basis sh`.
        Expert "window" window: Window = Window::None, Window::WORDS;

        /// Find visibility at every Nth texel of every Nth row, and light at all texels
        ///
        /// Higher is faster and less exact. With `basis sh` and with `bounces`. At 2 or 4, bounces after the first use every
        /// second of those texels and rows. At 1, those of `bounce_engine sweep` use every fourth.
        ///
        /// Light is computed at every texel with its own normal from the nodes around it. Visibility takes a quarter or a
        /// sixteenth of the memory. RMSE on the bundled mountain under the bundled sky: 0.2 % at 2, 0.4 % at 4
        /// (`cargo measure soft`). Bounces use the same nodes with any basis. On real terrain under a low sun, the
        /// error of light with three bounces is 1.2 to 2.8 times as large at 2 as at 1, and a frame takes 0.74 to 0.93 times as long;
        /// under a sky alone the errors are equal within 8 % (llvmpipe, benches/results/defaults.txt).
        Expert "subsample" subsample: u32 = 1, Values::OneOf(&[1, 2, 4]);
    }

    /// Indirect light: light that the surface reflects onto itself.
    pub struct Bounces of Quality::bounces_mut, {
        /// Bounces of indirect light, 0 to 64; 0 is direct light
        ///
        /// Fewer leave hollows darker; more take longer.
        Everyone "bounces" count: u32 = 0, Values::Whole(0..=64);

        /// Method that finds the visible surface of a bounce; with `bounces`
        Expert "bounce_engine" engine: BounceEngine = BounceEngine::Auto, BounceEngine::WORDS;

        /// Azimuths of bounces, 4 to 1024; with `bounces`
        ///
        /// Fewer show banding; more take time in proportion.
        ///
        /// With fewer, narrow bright features are hit in some azimuths and missed in others.
        Expert "bounce_azimuths" azimuths: u32 = 16, Values::Whole(4..=1024);

        /// Skip the last bounces below this share of the direct light's energy, 0 to 1, default 1/65536; with `bounces`
        ///
        /// Higher is faster and loses more indirect light.
        ///
        /// With the largest reflectance a, all bounces from the k-th on carry at most aᵏ + aᵏ⁺¹ + …; the last ones are
        /// dropped. 0 drops none.
        Expert "bounce_cutoff" cutoff: f64 = 1.0 / 65536.0, Values::Share;

        /// Light pyramid levels per doubling of distance, 1 to 16; with `bounce_engine pyramid`
        ///
        /// Fewer miss more of the surface; more take time in proportion.
        Expert "bounce_level_step" level_step: u32 = 4, Values::Whole(1..=16);

        /// Doublings of resolution that the light pyramid adds to what the distance needs, 0 to 4; with `bounce_engine pyramid`
        ///
        /// More are sharper, but miss more between grid points.
        Expert "bounce_level_offset" level_offset: u32 = 2, Values::Whole(0..=4);

        /// Storage of specular light between bounces; with `bounces` and `specular`
        Expert "bounce_specular" specular: BounceSpecular = BounceSpecular::Vector, BounceSpecular::WORDS;
    }
}

/// The setting of this name.
pub fn setting(name: &str) -> Option<&'static Setting> {
    SETTINGS.iter().find(|setting| setting.name == name)
}

impl Quality {
    fn own(&mut self) -> &mut Self {
        self
    }

    fn bounces_mut(&mut self) -> &mut Bounces {
        &mut self.bounces
    }

    /// Order of the lights' series: with an exact cosine one less than that of visibility.
    pub fn light_order(&self) -> usize {
        match self.receiver {
            Receiver::Plane => self.sh_order as usize - 1,
            Receiver::Cosine => self.sh_order as usize,
        }
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// The first setting out of range.
    pub fn check(&self) -> Result<()> {
        SETTINGS.iter().try_for_each(|setting| setting.check(self))
    }
}

impl Bounces {
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

    /// The settings on which [`needed_bounces`](Self::needed_bounces) depends, besides the count, as plans print them.
    pub(crate) fn used(&self) -> Vec<(String, String)> {
        vec![("bounce_cutoff".to_owned(), self.cutoff.to_string())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At ½, bounces 10 to 12 carry 2⁻¹⁰ + 2⁻¹¹ + 2⁻¹²; from the 9th on, 2⁻⁹ more.
    #[test]
    fn needed_bounces_drops_what_the_cutoff_allows() {
        let of = |count, cutoff| Bounces { count, cutoff, ..Bounces::DEFAULT };
        let late = (0..3).map(|k| 2_f64.powi(-10 - k)).sum::<f64>();
        assert_eq!(of(12, late).needed_bounces(0.5), 9);
        assert_eq!(of(12, 0.999 * late).needed_bounces(0.5), 10);
        assert_eq!(of(12, 0.0).needed_bounces(0.5), 12);
        assert_eq!(of(12, 1.0 / 65536.0).needed_bounces(1.0), 12);
        for cutoff in [0.0, 1.0] {
            assert_eq!(of(12, cutoff).needed_bounces(0.0), 0);
        }
        assert_eq!(of(0, 0.0).needed_bounces(1.0), 0);
    }

    /// Every setting takes its ends, and refuses what lies beyond them by its own name.
    #[test]
    fn settings_take_their_values_and_no_others() {
        for setting in SETTINGS {
            let (good, bad): (Vec<String>, Vec<String>) = match &setting.values {
                Values::Whole(range) => {
                    let below = i64::from(*range.start()) - 1;
                    let beyond = [below.to_string(), (range.end() + 1).to_string()];
                    ([range.start(), range.end()].map(u32::to_string).into(), beyond.into())
                }
                Values::OneOf(all) => (all.iter().map(u32::to_string).collect(), vec!["3".into()]),
                Values::Share => {
                    let beyond = ["-0.1", "1.1", "NaN", "inf"];
                    (vec!["0".into(), "1".into()], beyond.map(str::to_owned).into())
                }
                Values::Words(all) => {
                    (all.iter().map(|word| word.name.to_owned()).collect(), vec!["other".into()])
                }
            };
            let mut quality = Quality::DEFAULT;
            for value in good {
                setting.set(&mut quality, &value).unwrap();
                assert_eq!(setting.get(&quality), value);
                quality.check().unwrap();
            }
            for value in bad.iter().map(String::as_str).chain(["", "1e3"]) {
                let error = setting.set(&mut quality, value).unwrap_err().to_string();
                assert!(error.starts_with(&format!("{}: ", setting.name)), "{error}");
            }
        }
        let wrong = Bounces { cutoff: f64::NAN, ..Bounces::DEFAULT };
        let wrong = Quality { bounces: wrong, ..Quality::DEFAULT };
        assert!(wrong.check().unwrap_err().to_string().contains("bounce_cutoff"));
    }

    /// Flags, JSON and C need a name, a sentence, and a default that the setting takes.
    #[test]
    fn settings_are_described() {
        Quality::DEFAULT.check().unwrap();
        for (i, setting) in SETTINGS.iter().enumerate() {
            assert!(SETTINGS[..i].iter().all(|other| other.name != setting.name));
            assert!(setting.summary().len() > 10, "{}", setting.name);
            if let Values::Words(words) = &setting.values {
                assert!(words.iter().all(|word| word.summary().len() > 5), "{}", setting.name);
            }
        }
        assert!(setting("azimuths").is_some() && setting("azimuth").is_none());
    }
}
