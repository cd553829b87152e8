use std::path::PathBuf;

use clap::Args;
use ridgelight::scene::Scatter;

use super::values::{SEED, curvatures, grid, number, whole};
use super::{GlobalArgs, Input, QualityArgs, SceneArgs};
use crate::bake::{self, Format, Kind, Normals};

#[derive(Args)]
#[command(
    after_help = bake::help(),
    mut_arg("bounces", |arg| {
        let help = "Bounces of scattered light, 0 to 64; 0 is direct light [default: 3]";
        arg.hide_default_value(true).help(help).long_help(format!(
            "{help}\n\nFewer leave hollows darker; more take time in proportion."
        ))
    })
)]
pub struct BakeArgs {
    #[command(flatten)]
    pub input: Input,
    /// Output folder for maps, GLSL decoders and manifest.json
    ///
    /// Created if it is missing. manifest.json describes every channel, its decoding and its largest error. An earlier bake
    /// of the same kinds is replaced; any other content is refused.
    #[arg(short, long, value_name = "DIR", help_heading = "Output")]
    pub output: PathBuf,
    /// Kinds of maps to bake, from the list below
    #[arg(long, value_name = "LIST", value_delimiter = ',', required = true, value_parser = bake::kind_named, help_heading = "Output")]
    pub what: Vec<&'static Kind>,
    /// File formats of each map. Default each kind's
    ///
    /// exr, tif (GeoTIFF) and npy hold values in f32; ktx2, dds and png hold the values of --encoding. An exr stays in memory until the end;
    /// the others are written as they are computed.
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = "Output")]
    pub format: Vec<Format>,
    /// Packing of a kind in .ktx2, .dds and .png, as horizon=unorm16-sin; default the first in the list below
    #[arg(long, value_name = "KIND=ENCODING,…", value_delimiter = ',', value_parser = bake::packing, help_heading = "Output", hide_short_help = true)]
    pub encoding: Vec<bake::Packing>,
    /// Compress textures in blocks: BC4 for one component, BC7 for bent-normal, BC6H for scatter and brdf
    ///
    /// Applies to ktx2 and dds, whose encoding is then unorm8 or f16. A texel takes 1/2 to 1 byte. The error is measured, printed and
    /// put into manifest.json.
    #[arg(long, help_heading = "Output", hide_short_help = true)]
    pub compress: bool,
    /// Write all mip levels of textures, each the mean of the one before
    ///
    /// For kinds from horizons, and for scatter. Adds a third to the size.
    #[arg(long, help_heading = "Output", hide_short_help = true)]
    pub mips: bool,
    /// Axes of bent-normal in textures and pictures: +y points to the first row with opengl (Unity, Godot), to the last row
    /// with directx (Unreal) [default: opengl]
    ///
    /// In both, +x points east and +z up. In exr, npy and tif, +y always points to the first row, which is north.
    #[arg(long, value_name = "WORD", help_heading = "Output", hide_short_help = true)]
    pub normals: Option<Normals>,
    /// Directions of ellipse, curved-ellipse, visible-points and scattered light, 4 to 4096 [default: 256]
    ///
    /// A spherical Fibonacci set: on the upper hemisphere for ellipses alone, else on the whole sphere. Fewer are coarser;
    /// each takes one word per texel on the device.
    #[arg(long, value_name = "N", value_parser = number::<u32>("a whole number from 4 to 4096"), help_heading = "Quality", hide_short_help = true)]
    pub directions: Option<u32>,
    /// Zenith angles times azimuths of lights and views, 2..64 x 4..256, 4096 in all [default: 8x16, with btf 3x8]
    ///
    /// For brdf, brdf-factors, brdf-harmonics, btf and light-field. Fewer are coarser; the size of a table grows with the
    /// square.
    #[arg(long, value_name = "TxP", value_parser = grid, allow_hyphen_values = true, help_heading = "Quality", hide_short_help = true)]
    pub angles: Option<[usize; 2]>,
    /// Curvatures that curved-ellipse is fitted at, outwards and inwards, 1/m, above 0; one number for both
    ///
    /// Ellipses fitted at stronger curvatures are more accurate on strongly curved surfaces, and less accurate on slightly curved ones. A curvature that would change
    /// visibility is refused.
    #[arg(long, value_name = "OUT[,IN]", value_parser = curvatures, allow_hyphen_values = true, help_heading = "Quality", hide_short_help = true)]
    pub curvature: Option<[f64; 2]>,
    /// Paths of scattered light, 1 to 4096 [default: 256]
    ///
    /// Fewer are faster and less exact. Texels with the same surroundings have the same error.
    #[arg(long, value_name = "N", value_parser = whole(Scatter::PATHS), help_heading = "Quality", hide_short_help = true)]
    pub paths: Option<u32>,
    /// Seed of path directions and of the angle pairs that check a table [default: 0]
    #[arg(long, value_name = "N", value_parser = whole(SEED), help_heading = "Expert")]
    pub seed: Option<u32>,
    /// Print the files, their bytes and the memory needed; runs nothing
    #[arg(long, help_heading = "Output")]
    pub plan: bool,
    #[command(flatten)]
    pub scene: SceneArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    #[command(flatten)]
    pub global: GlobalArgs,
}
