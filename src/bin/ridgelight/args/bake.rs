use std::path::PathBuf;

use clap::Args;

use super::{FieldArgs, GlobalArgs, Input, QualityArgs};
use crate::bake::{self, Format, Kind};

#[derive(Args)]
#[command(after_help = bake::help())]
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
    /// Files of each: exr and npy hold values in f32, ktx2 and png what --encoding makes of them. Default each kind's
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub format: Vec<Format>,
    /// How a kind's values are packed in .ktx2 and .png, as horizon=unorm16-sin; default the first that is listed below
    #[arg(long, value_name = "KIND=ENCODING,…", value_delimiter = ',', value_parser = bake::packing)]
    pub encoding: Vec<bake::Packing>,
    /// Directions of ellipse and visible-points, [4..4096]: a spherical Fibonacci set, the upper hemisphere of ellipses alone,
    /// the whole sphere where visible-points is baked. More are finer, and each takes a word a sample on the device [default:
    /// 256]
    #[arg(long, value_name = "N")]
    pub directions: Option<usize>,
    /// Says what would be written, its bytes, and the memory that it takes; runs nothing
    #[arg(long)]
    pub plan: bool,
    #[command(flatten)]
    pub surface: FieldArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    #[command(flatten)]
    pub global: GlobalArgs,
}
