//! The manifest: a description of the folder's maps.

use ridgelight::gpu::Timing;
use ridgelight::scene::{HeightField, Method, Quality};
use serde_json::json;

use crate::setup;

/// The manifest of all maps.
pub fn describe(
    metadata: &[(String, String)],
    times: &[Timing],
    field: &HeightField,
    quality: &Quality,
    maps: &[serde_json::Value],
) -> serde_json::Value {
    let voids = field.voids().map_or(0, |v| v.iter().filter(|v| **v).count());
    let horizons = match quality.method {
        Method::BruteForce => {
            "every crossing along each azimuth from each grid point: exact but for f32 rounding"
        }
        _ => "found by the method in settings, whose error is not part of the files' errors",
    };
    let mut manifest = setup::as_json(metadata, times);
    let hash = manifest["settings"]["field_hash"].clone();
    manifest["field"] = json!({
        "rows": field.rows(), "cols": field.cols(), "cell_m": field.cell_m(), "base_m": field.base_m(),
        "voids": voids, "hash": hash,
        "hash_is": "64-bit FNV-1a of the text ridgelight field 1, rows and columns (u64), cells (f64), the \
            border (a byte: 0 plane, 1 open, 2 periodic), heights above the base (f32, -0 as 0) \
            and, if the field has voids, a byte per grid point, 1 at voids; little-endian",
        "first_row": "north", "first_column": "west",
    });
    manifest["horizons"] = horizons.into();
    manifest["error_is"] = "decoding error of a file: the computed value lies within at_most plus \
        and_of_the_value times the value; the error between azimuths is not included"
        .into();
    manifest["maps"] = maps.into();
    manifest
}
