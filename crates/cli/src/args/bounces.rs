use clap::{Args, ValueEnum};
use ridgelight::Result;
use ridgelight::scene::{BounceEngine, BounceSpecular, Bounces};

use super::values::whole;

#[derive(Args)]
#[command(next_help_heading = "Quality")]
pub struct BounceArgs {
    /// Bounces of indirect light, 0 to 64; 0 is direct light
    ///
    /// Fewer leave hollows darker; more take time in proportion.
    #[arg(long, value_name = "B", default_value_t = 0, value_parser = whole, allow_negative_numbers = true)]
    pub bounces: u32,
    /// Find the visible surface of a bounce by this method; with --bounces
    #[arg(long, default_value = "auto", help_heading = "Expert")]
    pub bounce_engine: BounceEngineName,
    /// Azimuths of bounces, 4 to 1024; with --bounces
    ///
    /// Fewer show banding; more take time in proportion.
    #[arg(long, value_name = "M", default_value_t = 32, value_parser = whole, allow_negative_numbers = true, help_heading = "Expert")]
    pub bounce_azimuths: u32,
    /// Skip the last bounces below this share of the direct light's energy, 0 to 1, default 1/65536; with --bounces
    ///
    /// Higher is faster and loses more indirect light.
    #[arg(long, value_name = "SHARE", default_value_t = 1.0 / 65536.0, hide_default_value = true, allow_negative_numbers = true, help_heading = "Expert")]
    pub bounce_cutoff: f64,
    /// Light pyramid levels per doubling of distance, 1 to 16; with --bounce-engine pyramid
    ///
    /// Fewer miss more of the surface; more take time in proportion.
    #[arg(long, value_name = "K", default_value_t = 4, value_parser = whole, allow_negative_numbers = true, help_heading = "Expert")]
    pub bounce_level_step: u32,
    /// Doublings of resolution that the light pyramid adds to what distance needs, 0 to 4; with --bounce-engine pyramid
    ///
    /// More are sharper, but miss more between grid points.
    #[arg(long, value_name = "O", default_value_t = 2, value_parser = whole, allow_negative_numbers = true, help_heading = "Expert")]
    pub bounce_level_offset: u32,
    /// Storage of specular light between bounces; with --bounces and --specular
    #[arg(long, default_value = "vector", help_heading = "Expert")]
    pub bounce_gloss: BounceGlossName,
}

impl BounceArgs {
    /// # Errors
    /// A setting out of its range.
    pub fn bounces(&self) -> Result<Bounces> {
        let bounces = Bounces {
            count: self.bounces,
            engine: match self.bounce_engine {
                BounceEngineName::Auto => BounceEngine::Auto,
                BounceEngineName::BruteForce => BounceEngine::BruteForce,
                BounceEngineName::Sweep => BounceEngine::Sweep,
                BounceEngineName::Pyramid => BounceEngine::Pyramid,
            },
            azimuths: self.bounce_azimuths,
            cutoff: self.bounce_cutoff,
            level_step: self.bounce_level_step,
            level_offset: self.bounce_level_offset,
            specular: match self.bounce_gloss {
                BounceGlossName::Vector => BounceSpecular::Vector,
                BounceGlossName::VectorF16 => BounceSpecular::VectorF16,
                BounceGlossName::Scalar => BounceSpecular::Scalar,
            },
        };
        bounces.check().map(|()| bounces)
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub enum BounceGlossName {
    /// Radiance by direction, as spherical harmonics of --sh-order at every texel
    Vector,
    /// The same as f16, in half the memory
    #[value(name = "vector-f16")]
    VectorF16,
    /// Radiance towards the zenith, one colour per texel, as if it were diffuse
    Scalar,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum BounceEngineName {
    /// The planner's choice: sweep where horizons come from a sweep along lines, else brute-force
    Auto,
    /// Every visible interval along each azimuth: exact in each azimuth, and slow
    BruteForce,
    /// The visible intervals at every march step, from the visibility cache of a sweep along lines
    Sweep,
    /// One texel per level of pyramids of heights and light: approximate
    Pyramid,
}
