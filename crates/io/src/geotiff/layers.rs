//! The layers of a picture as bands.

use super::{Band, GeoTiffWriter};
use crate::exr::{Channels, Layer};
use crate::georeference::Georeference;
use ridgelight::Result;
use std::path::Path;

/// Writes layers as a GeoTIFF, in their order: the bands have the names of the channels that
/// [`write_exr`](crate::write_exr) would write. `units` are pairs of a scalar's name and its unit.
///
/// # Errors
/// As [`GeoTiffWriter`].
pub fn write_geotiff(
    path: &Path,
    size: [usize; 2],
    layers: &[Layer],
    units: &[(&str, &str)],
    georeference: Option<&Georeference>,
    metadata: &[(String, String)],
) -> Result<()> {
    let unit = |name: &str| units.iter().find(|unit| unit.0 == name).map_or("", |unit| unit.1);
    let band = |name: String, unit: &str| Band { name, unit: unit.to_owned() };
    let bands = layers.iter().flat_map(|layer| match layer.channels {
        Channels::Rgb(_) => ["R", "G", "B"].map(|name| band(layer.channel(name), "")).to_vec(),
        Channels::Scalar(name, _) => vec![band(layer.channel(name), unit(name))],
    });
    let mut writer = GeoTiffWriter::create(path, size, bands.collect(), georeference.cloned())?;
    let mut next = 0..;
    for layer in layers {
        match layer.channels {
            Channels::Rgb(texels) => {
                for (component, band) in next.by_ref().take(3).enumerate() {
                    let plane: Vec<f32> = texels.iter().map(|texel| texel[component]).collect();
                    writer.write(band, &plane)?;
                }
            }
            Channels::Scalar(_, values) => {
                for band in next.by_ref().take(1) {
                    writer.write(band, values)?;
                }
            }
        }
    }
    writer.finish(metadata)
}
