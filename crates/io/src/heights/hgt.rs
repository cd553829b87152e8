//! SRTM tiles: a square of big-endian 16-bit metres, row 0 in the north, without a header.

use crate::georeference::{GeoKeys, Georeference};
use crate::heights::{Cell, Raster, type_name};
use crate::open;
use ridgelight::{Error, Result};
use std::path::Path;

/// SRTM's value for voids.
const VOID: f64 = -32768.0;

/// A tile of one degree, its edges on the outermost grid points; 1201² and 3601² are usual. Without
/// a latitude in the name (N44W072: the tile's south-west corner) the cell size is unknown, which
/// is an error unless `cell_known`.
pub(crate) fn heights(path: &Path, bytes: &[u8], cell_known: bool) -> Result<Raster> {
    let side = (bytes.len() / 2).isqrt();
    if !bytes.len().is_multiple_of(2) || side < 2 || side * side * 2 != bytes.len() {
        return Err(Error::file(
            path,
            "file size",
            format!("{} bytes", bytes.len()),
            "2·n² bytes for a square tile, as 2 884 802 (n = 1201) or 25 934 402 (n = 3601)",
        ));
    }
    open::size(path, "file size", side as u64, side as u64)?;
    let (cell, georeference) = match corner(path) {
        Some([south, west]) => {
            let cell = [1.0 / (side - 1) as f64; 2];
            let north_west = [west, south + 1.0];
            let keys = GeoKeys::wgs84_points();
            let at = Georeference::at_origin(north_west, cell, keys);
            (Cell::Degrees { cell, latitude: south + 0.5, is_guess: false }, Some(at))
        }
        None if cell_known => (Cell::Unknown, None),
        None => {
            return Err(Error::file(
                path,
                "name",
                "no latitude",
                "the tile's south-west corner, as in N44W072.hgt, or a cell size",
            ));
        }
    };
    let values =
        bytes.chunks_exact(2).map(|b| f64::from(i16::from_be_bytes([b[0], b[1]]))).collect();
    let (nodata, unit_m) = (Some(VOID), Some(1.0));
    let data_type = type_name(b'i', 16);
    let bare = Raster::bare(side, side, values);
    Ok(Raster { data_type, cell, nodata, unit_m, georeference, ..bare })
}

/// Latitude and longitude of the tile's south-west grid point, from a name like `N44W072` or `s05e110`.
fn corner(path: &Path) -> Option<[f64; 2]> {
    let stem = path.file_stem()?.to_str()?.to_ascii_uppercase();
    let rest = stem.strip_prefix(['N', 'S'])?;
    let (latitude, rest) = rest.split_at(rest.find(['W', 'E'])?);
    let latitude = f64::from(latitude.parse::<u8>().ok()?);
    let south = latitude * if stem.starts_with('S') { -1.0 } else { 1.0 };
    let end = rest[1..].find(|c: char| !c.is_ascii_digit()).map_or(rest.len(), |end| 1 + end);
    let longitude = f64::from(rest[1..end].parse::<u8>().ok()?);
    let west = longitude * if rest.starts_with('W') { -1.0 } else { 1.0 };
    ((-90.0..90.0).contains(&south) && (-180.0..180.0).contains(&west)).then_some([south, west])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_corner_from_the_name() {
        for (name, south_west) in [
            ("N44W072.hgt", Some([44.0, -72.0])),
            ("s05e110.hgt", Some([-5.0, 110.0])),
            ("dir/N00E006.SRTMGL1.hgt", Some([0.0, 6.0])),
            ("tile.hgt", None),
            ("N.hgt", None),
            ("NW.hgt", None),
            ("N95E000.hgt", None),
            ("N45E.hgt", None),
            ("N45E180.hgt", None),
            ("Nörd44W072.hgt", None),
        ] {
            assert_eq!(corner(Path::new(name)), south_west, "{name}");
        }
    }

    #[test]
    fn a_tile_of_three_by_three() {
        let bytes: Vec<u8> =
            [1_i16, 2, 3, 4, -32768, 6, 7, 8, 9].iter().flat_map(|h| h.to_be_bytes()).collect();
        let raster = heights(Path::new("N44W072.hgt"), &bytes, false).unwrap();
        assert_eq!((raster.rows, raster.cols, raster.values[5]), (3, 3, 6.0));
        let cell = Cell::Degrees { cell: [0.5, 0.5], latitude: 44.5, is_guess: false };
        assert_eq!(raster.cell, cell);
        // The outermost grid points lie on the tile's edges, so pixels reach half a cell beyond.
        assert_eq!(raster.georeference.unwrap().corner, [-72.25, 45.25]);
        assert!(heights(Path::new("a.hgt"), &bytes, false).is_err());
        assert!(heights(Path::new("a.hgt"), &bytes, true).is_ok());
        assert!(heights(Path::new("N44W072.hgt"), &bytes[1..], false).is_err());
        assert!(heights(Path::new("N44W072.hgt"), &bytes[2..], false).is_err());
    }
}
