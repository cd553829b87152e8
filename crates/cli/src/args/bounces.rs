use clap::{Args, ValueEnum};
use ridgelight::Result;
use ridgelight::scene::{BounceEngine, BounceGloss, Bounces};

use super::values::whole;

#[derive(Args)]
#[command(next_help_heading = "Quality")]
pub struct BounceArgs {
    /// Times that light may be reflected on its way to a sample, 0..64: colour bleeds, hollows brighten; 0 is
    /// direct light alone. Time in proportion
    #[arg(long, value_name = "B", default_value_t = 0, value_parser = whole, allow_negative_numbers = true)]
    pub bounces: u32,
    /// How what a sample sees of the surface is found; with --bounces
    #[arg(long, default_value = "auto")]
    pub bounce_engine: BounceEngineName,
    /// Azimuths of bounces, 4..1024; with --bounces
    #[arg(long, value_name = "M", default_value_t = 32, value_parser = whole, allow_negative_numbers = true)]
    pub bounce_azimuths: u32,
    /// Share of the direct light's energy that the last bounces may carry to be left out, 0..1, default 1/65536; with
    /// --bounces
    #[arg(long, value_name = "SHARE", default_value_t = 1.0 / 65536.0, hide_default_value = true, allow_negative_numbers = true)]
    pub bounce_cutoff: f64,
    /// Levels a doubling of distance of the pyramid of light, 1..16; with --bounce-engine pyramid
    #[arg(long, value_name = "K", default_value_t = 4, value_parser = whole, allow_negative_numbers = true)]
    pub bounce_level_step: u32,
    /// Doublings of resolution by which its levels are finer than distance asks for, 0..4; with --bounce-engine pyramid
    #[arg(long, value_name = "O", default_value_t = 2, value_parser = whole, allow_negative_numbers = true)]
    pub bounce_level_offset: u32,
    /// What is kept of the light that lobes throw on; with --bounces and --phong
    #[arg(long, default_value = "vector")]
    pub bounce_gloss: BounceGlossName,
}

impl BounceArgs {
    /// Checked.
    pub fn bounces(&self) -> Result<Bounces> {
        let bounces = Bounces {
            count: self.bounces,
            engine: match self.bounce_engine {
                BounceEngineName::Auto => BounceEngine::Auto,
                BounceEngineName::Brute => BounceEngine::Brute,
                BounceEngineName::Sweep => BounceEngine::Sweep,
                BounceEngineName::Pyramid => BounceEngine::Pyramid,
            },
            azimuths: self.bounce_azimuths,
            cutoff: self.bounce_cutoff,
            level_step: self.bounce_level_step,
            level_offset: self.bounce_level_offset,
            gloss: match self.bounce_gloss {
                BounceGlossName::Vector => BounceGloss::Vector,
                BounceGlossName::VectorF16 => BounceGloss::VectorF16,
                BounceGlossName::Scalar => BounceGloss::Scalar,
            },
        };
        bounces.check().map(|()| bounces)
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub enum BounceGlossName {
    /// Radiance by direction, spherical harmonics of --sh-order at every texel
    Vector,
    /// The same in half the memory, as f16
    #[value(name = "vector-f16")]
    VectorF16,
    /// Radiance as seen from above, one colour a texel: as if it were diffuse
    Scalar,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum BounceEngineName {
    /// The planner's choice: sweep where horizons come from a sweep along lines, else brute
    Auto,
    /// Every stretch that it sees along each azimuth: exact but for the azimuths, and slow
    Brute,
    /// Those that it sees at every march step, through what a sweep along lines has met
    Sweep,
    /// One sample a level of pyramids of heights and of light: soft, in error whatever the settings
    Pyramid,
}
