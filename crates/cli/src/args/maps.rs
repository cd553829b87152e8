//! Flags of `hillshade`, `shadow`, `ao`, `svf` and `openness`.

use std::path::PathBuf;

use clap::Args;
use ridgelight::scene::{Lights, Sun};

use super::{FieldArgs, GlobalArgs, Input, QualityArgs};
use crate::setup::lights::light;

const HILLSHADE_HELP: &str = "\
Values are 1 + 254 max(cos, 0), where cos is that between the normal and the sun: those of `gdaldem hillshade` (Horn), \
not rounded except in a .png. No shadows are cast; `ridgelight render --sun AZ,EL` casts them.

Differences from gdaldem: heights and cells are both in metres, so files in degrees need no -s. Values then differ from \
those of `gdaldem hillshade -s 111120`, which takes cells in degrees as square on the ground. At the edge, slopes come \
from the cells that exist. Beside voids, they come from filled heights. gdaldem has no data in both places; with \
-compute_edges it extrapolates.

Examples:
  ridgelight hillshade dem.tif -o hillshade.tif            # gdaldem hillshade -az 315 -alt 45
  ridgelight hillshade dem.tif --sun 300,30 --z-scale 2 -o relief.png    # -az 300 -alt 30 -z 2";

const SHADOW_HELP: &str = "\
Bands: sun_share, the visible share of the sun's disc at the ground, 0 to 1, without the cosine. lit_above, the height in \
metres from which the whole sun is visible. penumbra, the distance from \
lit_above down to the height at which its occluder hides the whole sun. A .png \
has only sun_share. At a height z in between, that occluder hides (lit_above - z) / penumbra of the disc's height.

`render --sun` uses exact horizons and is more accurate.

Examples:
  ridgelight shadow dem.tif --sun 250,12 -o shadow.tif
  ridgelight shadow dem.tif --sun 250,12,0 -o hard.png      # a point sun";

pub const AO_HELP: &str = "\
The map `sky-view` of `bake`: the cosine-weighted share of the hemisphere about the normal that no ground occludes, for \
occluders at any distance. It equals `render --sky 1 --albedo 1 --bounces 0`. gdaldem has no such map.

A .png maps 0 to 1 to the values 0 to 255, so mountains are nearly white. For full contrast write a .tif, which QGIS \
draws from its lowest to its highest value, or convert it as in the example.

Examples:
  ridgelight ao dem.tif -o ao.tif
  gdal_translate -of PNG -ot Byte -scale ao.tif ao.png      # from the lowest to the highest value";

pub const SVF_HELP: &str = "\
The map `sky-view` of `bake`: flat open ground is 1, a slope of angle a is (1 + cos a)/2. RVT's sky-view factor (Zaksek \
2011) weights all directions above the horizontal equally, up to 10 pixels away; `visible-sky` of `bake` is the same for \
occluders at any distance. gdaldem has no such map.

A .png maps 0.6375 to 1 to the values 0 to 255, as RVT's 8-bit files do; lower values become 0. A .tif has all values.

Examples:
  ridgelight svf dem.tif -o svf.tif
  gdal_translate -of PNG -ot Byte -scale svf.tif svf.png    # from the lowest to the highest value
  ridgelight bake dem.tif --what visible-sky --format tif -o rvt    # RVT's sky-view factor";

const OPENNESS_HELP: &str = "\
The mean over --azimuths of the zenith angle of the horizon: 90 degrees on flat ground, less in a valley, more on a \
summit. Azimuths in which a grid point at the edge has no ground are left out.

Differences from RVT: occluders at any distance count (RVT: 10 pixels); there are 32 azimuths (RVT: 16). By default nothing \
lies beyond the field (--border open), and horizons may be below the horizontal. gdaldem has no such map.

Examples:
  ridgelight openness dem.tif -o openness.tif
  ridgelight openness dem.tif --negative -o negative.tif";

#[derive(Args)]
pub struct MapArgs {
    #[command(flatten)]
    pub input: Input,
    /// Output: .tif, .npy or .exr (f32), or .png (8 bits)
    ///
    /// A .tif is a GeoTIFF with the georeference of the input. A .png is grey and linear, not sRGB: hillshade is stored as it is,
    /// rounded; of the others a fixed range becomes 0 to 255: shadow and ao 0 to 1, svf 0.6375 to 1, openness 60 to 95 degrees. Voids
    /// are transparent in a .png, else NaN.
    #[arg(short, long, value_name = "OUT.{tif,npy,exr,png}", help_heading = "Output")]
    pub output: PathBuf,
    #[command(flatten)]
    pub surface: FieldArgs,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
#[command(after_help = HILLSHADE_HELP)]
pub struct HillshadeArgs {
    #[command(flatten)]
    pub map: MapArgs,
    /// Sun: compass azimuth, elevation (degrees)
    ///
    /// Its diameter and irradiance change nothing here.
    #[arg(
        long,
        value_name = "AZ,EL",
        value_parser = sun,
        default_value = "315,45",
        allow_hyphen_values = true,
        help_heading = "Lights"
    )]
    pub sun: Vec<Sun>,
}

#[derive(Args)]
#[command(after_help = SHADOW_HELP)]
pub struct ShadowArgs {
    #[command(flatten)]
    pub map: MapArgs,
    /// Sun: compass azimuth, elevation, diameter (degrees)
    #[arg(
        long,
        value_name = "AZ,EL[,DIAMETER]",
        value_parser = sun,
        default_value = "315,45",
        allow_hyphen_values = true,
        help_heading = "Lights"
    )]
    pub sun: Vec<Sun>,
}

#[derive(Args)]
pub struct SkyViewArgs {
    #[command(flatten)]
    pub map: MapArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
}

#[derive(Args)]
#[command(
    after_help = OPENNESS_HELP,
    mut_arg("border", |arg| arg.default_value("open"))
)]
pub struct OpennessArgs {
    #[command(flatten)]
    pub of: SkyViewArgs,
    /// Negative openness: that of the negated heights
    #[arg(long, help_heading = "Output")]
    pub negative: bool,
}

fn sun(words: &str) -> Result<Sun, String> {
    let mut lights = Lights::default();
    light("sun")
        .add(&mut lights, words)
        .map_err(|_| "AZ,EL or AZ,EL,DIAMETER in degrees".to_owned())?;
    Ok(lights.suns.remove(0))
}
