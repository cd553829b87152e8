//! Lights and surfaces.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, ValueEnum};
use ridgelight::scene::Lights;

use super::values::{SkyArg, SpecularArg, angle, bbox, cell, number, sky, specular};
use crate::setup::lights::LIGHTS;
use crate::setup::tint::Tint;

#[derive(Args)]
#[command(next_help_heading = "Lights")]
pub struct LightArgs {
    /// Sky: clear, or the radiance of a uniform sky
    ///
    /// RADIANCE is one number or R,G,B. Level, unoccluded ground of albedo 1 has the same radiance as the sky. clear is the sky around the first --sun (Preetham 1999, turbidity 2.5), with the
    /// brightness that this model gives for that sun. Without any light, commands use a sun from the north-west and this sky; `bake`, `bench` and
    /// --lines exact use a uniform sky of radiance 1.
    #[arg(long, value_name = "RADIANCE|clear", value_parser = sky, allow_negative_numbers = true)]
    pub sky: Option<SkyArg>,
    /// Environment map: .hdr or .exr
    ///
    /// Equirectangular, angular map, cube cross or cube faces, at infinity.
    #[arg(long, value_name = "FILE")]
    pub env: Option<PathBuf>,
    /// Rotate the environment clockwise, degrees
    ///
    /// At 0 the middle of the map is in the east.
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 0.0,
        value_parser = angle,
        hide_short_help = true,
        requires = "env"
    )]
    pub env_rotate: f64,
    #[command(flatten)]
    pub others: OtherLights,
}

/// Suns, key lights and sphere lights.
#[derive(Default)]
pub struct OtherLights(pub Lights);

impl Args for OtherLights {
    fn augment_args(command: Command) -> Command {
        command.args(LIGHTS.iter().map(|light| {
            Arg::new(light.id)
                .long(light.id.replace('_', "-"))
                .help(light.help)
                .long_help(format!("{}\n\n{}", light.help, light.long_help))
                .help_heading("Lights")
                .value_name(light.value_name)
                .allow_hyphen_values(true)
                .action(ArgAction::Append)
                .value_parser(|words: &str| {
                    light.add(&mut Lights::default(), words).map(|()| words.to_owned())
                })
        }))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for OtherLights {
    fn from_arg_matches(matches: &ArgMatches) -> std::result::Result<Self, clap::Error> {
        let mut lights = Lights::default();
        for light in &LIGHTS {
            for words in matches.get_many::<String>(light.id).into_iter().flatten() {
                light.add(&mut lights, words).expect("the parser has tried it");
            }
        }
        Ok(Self(lights))
    }

    fn update_from_arg_matches(
        &mut self,
        matches: &ArgMatches,
    ) -> std::result::Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl LightArgs {
    /// Whether the command line gives no light.
    pub fn is_empty(&self) -> bool {
        let has_none = LIGHTS.iter().all(|light| light.words(&self.others.0).is_empty());
        self.sky.is_none() && self.env.is_none() && has_none
    }
}

#[derive(Args)]
pub struct SceneArgs {
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub field: FieldArgs,
    /// Diffuse reflectance, 0 to 1. Default 1
    ///
    /// One number, R,G,B, or a .png or .exr image. An image has the size of the field.
    #[arg(
        long,
        value_name = "VALUE|FILE",
        allow_negative_numbers = true,
        help_heading = "Surface"
    )]
    pub albedo: Option<String>,
    /// Albedo by height or slope: none, elevation, slope or land
    ///
    /// Default land for a .png and the window, else none. Colours span the heights from the 2nd to the 98th percentile, and
    /// slopes from 0 to 60 degrees. If the brightest colour plus the scale
    /// of --specular exceeds 1, the tint is darkened to fit.
    #[arg(long, conflicts_with = "albedo", hide_possible_values = true, help_heading = "Surface")]
    pub tint: Option<Tint>,
    /// Phong specular: exponent 0 to 10000, scale 0 to 1
    ///
    /// The Phong lobe is centred on the mirror direction of the view: of --camera or, without it, from straight above. SCALE plus
    /// --albedo is at most 1. A file has the size of the field and holds both: .exr R and G, or .npy [2, rows, cols].
    #[arg(
        long,
        value_name = "EXPONENT,SCALE|FILE",
        value_parser = specular,
        allow_hyphen_values = true,
        hide_short_help = true,
        help_heading = "Surface"
    )]
    pub specular: Option<SpecularArg>,
}

impl SceneArgs {
    /// The text of --albedo, or its default.
    pub fn albedo(&self) -> &str {
        self.albedo.as_deref().unwrap_or("1")
    }
}

#[derive(Args)]
#[command(next_help_heading = "Surface")]
pub struct FieldArgs {
    /// Grid spacing in metres. Default the file's, else 1
    ///
    /// Spacing of columns, and of rows where it differs. Overrides the file's. If the file does not state its unit of
    /// height, give the spacing in that unit.
    #[arg(long, value_name = "X[,Y]", value_parser = cell, allow_negative_numbers = true, help_heading = "Input")]
    pub cell: Option<[f64; 2]>,
    /// Multiply heights by this factor; not 0. Default 1
    ///
    /// PNG values are metres. For a 16-bit PNG that spans a height range R, use R/65535.
    #[arg(
        long,
        value_name = "S",
        value_parser = number::<f64>("a finite number other than 0"),
        hide_short_help = true,
        help_heading = "Input"
    )]
    pub z_scale: Option<f64>,
    /// Whether heights become depths.
    #[arg(skip)]
    pub is_negated: bool,
    /// Height that marks no data, or nan. Default the file's
    #[arg(
        long,
        value_name = "VALUE",
        value_parser = number::<f64>("a height, or nan"),
        hide_short_help = true,
        help_heading = "Input"
    )]
    pub nodata: Option<f64>,
    /// TIFF band that holds the heights, counted from 1. Default 1
    ///
    /// For a 3-D NPY: the plane, counted from 1, without a default.
    #[arg(
        long,
        value_name = "N",
        value_parser = number::<u32>("a whole number, 1 or more"),
        hide_short_help = true,
        help_heading = "Input"
    )]
    pub band: Option<u32>,
    /// Cut the field to a box in the coordinates of its reference system
    ///
    /// Keeps the cells that the box touches. Outputs have the position of the cut field.
    #[arg(
        long,
        value_name = "XMIN,YMIN,XMAX,YMAX",
        value_parser = bbox,
        allow_hyphen_values = true,
        hide_short_help = true,
        help_heading = "Input"
    )]
    pub bbox: Option<[f64; 4]>,
    /// Surface beyond the edge of the field
    #[arg(long, default_value = "plane", hide_short_help = true)]
    pub border: BorderName,
}

impl FieldArgs {
    /// The factor on heights: --z-scale, or its default.
    pub fn factor(&self) -> f64 {
        let sign = if self.is_negated { -1.0 } else { 1.0 };
        sign * self.z_scale.unwrap_or(1.0)
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub enum BorderName {
    /// Level ground: no horizon is below 0
    Plane,
    /// Nothing: light may come from below horizontal
    Open,
    /// The field repeats
    Periodic,
}
