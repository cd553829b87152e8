use std::path::PathBuf;

use clap::Args;

use super::values::{curvatures, grid, whole};
use super::{GlobalArgs, Input, LightArgs, QualityArgs, SurfaceArgs};
use crate::bake::{self, Format, Kind};

#[derive(Args)]
#[command(
    after_help = bake::help(),
    mut_arg("bounces", |arg| arg.hide_default_value(true).help(
        "Times that light may be reflected on its way to a sample, of kinds that scatter it, 0..64; 0 is direct light alone. Time \
         in proportion [default: 3]"
    ))
)]
pub struct BakeArgs {
    #[command(flatten)]
    pub input: Input,
    /// A folder, made where it is missing, for the maps, a decoder in GLSL beside each, and bake.json, which says what
    /// every channel is, how it is decoded and by how much it may be off. An earlier bake of the same kinds is
    /// replaced, one of others refused
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// What to bake, of the list below
    #[arg(long, value_name = "LIST", value_delimiter = ',', required = true, value_parser = bake::kind_named)]
    pub what: Vec<&'static Kind>,
    /// Files of each: exr and npy hold values in f32, ktx2 and png what --encoding makes of them. An exr is held in memory
    /// until the end, the others are written as they come. Default each kind's
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub format: Vec<Format>,
    /// How a kind's values are packed in .ktx2 and .png, as horizon=unorm16-sin; default the first that is listed below
    #[arg(long, value_name = "KIND=ENCODING,…", value_delimiter = ',', value_parser = bake::packing)]
    pub encoding: Vec<bake::Packing>,
    /// Directions of ellipse, curved-ellipse, visible-points and scattered light, [4..4096]: a spherical Fibonacci set, the upper hemisphere of
    /// ellipses alone, else the whole sphere. More are finer, and each takes a word a sample on the device [default: 256]
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true)]
    pub directions: Option<u32>,
    /// Zenith angles times azimuths of the lights and views of brdf, brdf-factors, brdf-harmonics, btf and light-field, each [2..64]x[4..256], 4096
    /// together: finer tables, whose size grows with the square [default: 8x16, with btf 3x8]
    #[arg(long, value_name = "TxP", value_parser = grid, allow_hyphen_values = true)]
    pub angles: Option<[usize; 2]>,
    /// Curvatures that ellipses of curved-ellipse are fitted at, outwards and inwards, 1/m, each above 0; one number for both. Stronger
    /// ones hold up to stronger bends and are less like what lies between; what would change what is seen is refused
    #[arg(long, value_name = "OUT[,IN]", value_parser = curvatures, allow_hyphen_values = true)]
    pub curvature: Option<[f64; 2]>,
    /// Paths of scattered light, [1..4096]: fewer are faster, and all samples that are alike are wrong alike [default: 256]
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true)]
    pub paths: Option<u32>,
    /// Decides in which order paths take directions, and which pairs a table is asked between its angles for [default: 0]
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true)]
    pub seed: Option<u32>,
    /// Says what would be written, its bytes, and the memory that it takes; runs nothing
    #[arg(long)]
    pub plan: bool,
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub surface: SurfaceArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    #[command(flatten)]
    pub global: GlobalArgs,
}
