//! TIFFs in which some tiles have no bytes, as GDAL's SPARSE_OK writes them.

use crate::formats::sparse_tiff;
use crate::{absolute, one_sentence, parse};
use ridgelight_io::parse_planes;
use std::path::Path;

const SIDE: usize = 16;
const ACROSS: usize = 4;
const DOWN: usize = 3;

/// Tiles without bytes are no data, or 0 where the file names no such value
/// (gdal.org/drivers/raster/gtiff.html, "Sparse files").
#[test]
fn tiles_without_bytes_are_no_data() {
    let mut tiles = [None; ACROSS * DOWN];
    (tiles[1], tiles[6]) = (Some(7.0_f32), Some(9.0));
    for nodata in [Some("-9999"), None] {
        let bytes = sparse_tiff(SIDE as u32, [ACROSS as u32, DOWN as u32], &tiles, nodata);
        let values = 4 * SIDE * SIDE * tiles.len();
        assert!(4 * bytes.len() < values, "{} bytes for {values}", bytes.len());
        let field = parse("a.tif", &bytes).unwrap();
        assert_eq!((field.rows(), field.cols()), (SIDE * DOWN, SIDE * ACROSS));
        let planes = parse_planes(Path::new("a.tif"), &bytes).unwrap().planes;
        for (i, height) in absolute(&field).into_iter().enumerate() {
            let [row, col] = [i / field.cols(), i % field.cols()];
            let tile = tiles[row / SIDE * ACROSS + col / SIDE];
            let is_void = field.voids().is_some_and(|voids| voids[i]);
            assert_eq!(is_void, tile.is_none() && nodata.is_some(), "{nodata:?} {row} {col}");
            let expected = f64::from(tile.unwrap_or(0.0));
            // Offsets from the base of the field are f32.
            let is_right = (height - expected).abs() < 16.0 * f64::from(f32::EPSILON);
            assert!(is_void || is_right, "{nodata:?} {row} {col}: {height}");
            let plane = f64::from(planes[0][i]);
            assert!(
                if is_void { plane.is_nan() } else { plane == expected },
                "{row} {col}: {plane}"
            );
        }
    }
}

/// A small file cannot claim any size: it has at least 1/1032 of the bytes of its values.
#[test]
fn a_claim_without_any_bytes_is_refused() {
    let bytes = sparse_tiff(4096, [2, 1], &[None; 2], Some("-9999"));
    let error = parse("a.tif", &bytes).unwrap_err().to_string();
    one_sentence(&error, "a.tif");
    let held = format!(" in {} bytes, ", bytes.len());
    assert!(error.contains("a claim of 134217728 bytes") && error.contains(&held), "{error}");
}
