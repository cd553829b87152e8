//! What a folder of maps is told by.

use ridgelight::gpu::Timing;
use ridgelight::scene::{HeightField, Method, Quality};
use serde_json::json;

use crate::setup;

/// What the folder holds.
pub fn sheet(
    metadata: &[(String, String)],
    times: &[Timing],
    field: &HeightField,
    quality: &Quality,
    maps: &[serde_json::Value],
) -> serde_json::Value {
    let voids = field.voids().map_or(0, |v| v.iter().filter(|v| **v).count());
    let horizons = match quality.method {
        Method::Brute => {
            "every crossing of a sample's own line along each azimuth: exact there but for rounding in f32"
        }
        _ => {
            "found by the method of the settings, whose own error is besides what is stated of files"
        }
    };
    let mut sheet = setup::as_json(metadata, times);
    let hash = sheet["settings"]["field_hash"].clone();
    sheet["field"] = json!({
        "rows": field.rows(), "cols": field.cols(), "cell_m": field.cell_m(), "base_m": field.base_m(),
        "voids": voids, "hash": hash,
        "hash_is": "FNV-1a of 64 bits of the text ridgelight field 1, rows and columns (u64), cells (f64), the border (a \
                    byte: 0 plane, 1 open, 2 periodic), heights above the base (f32, -0 as 0) and, if any sample is \
                    void, a byte a sample, 1 where it is; little-endian",
        "first_row": "north", "first_column": "west",
    });
    sheet["horizons"] = horizons.into();
    sheet["error_is"] = "of decoding a file: what was computed is in it within at_most plus and_of_the_value times the \
                         value; between the azimuths nothing is looked at, which is besides"
        .into();
    sheet["maps"] = maps.into();
    sheet
}
