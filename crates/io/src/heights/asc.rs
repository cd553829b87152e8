//! ESRI ASCII grids: `key value` lines, then rows from north to south.

use crate::georeference::{GeoKeys, Georeference};
use crate::heights::{Cell, Raster, looks_like_degrees};
use crate::open;
use ridgelight::{Error, Result};
use std::collections::HashMap;
use std::path::Path;

/// The header's keys, case-insensitive, with "center" also spelled "centre"; `cellsize` is both
/// `dx` and `dy`. Positions are those of the south-west cell's south-west corner, or of its centre.
const KEYS: [&str; 10] = [
    "ncols",
    "nrows",
    "xllcorner",
    "yllcorner",
    "xllcenter",
    "yllcenter",
    "dx",
    "dy",
    "cellsize",
    "nodata_value",
];

/// Values by key.
struct Header(HashMap<String, f64>);

impl Header {
    fn get(&self, key: &str) -> Option<f64> {
        self.0.get(key).copied()
    }

    /// West and south of the outer corner, where the header has them.
    fn corner(&self, cell: [f64; 2]) -> Option<[f64; 2]> {
        let corner = |axis: &str, cell: f64| {
            let centre = self.get(&format!("{axis}llcenter"));
            self.get(&format!("{axis}llcorner")).or(centre.map(|c| c - cell / 2.0))
        };
        Some([corner("x", cell[0])?, corner("y", cell[1])?])
    }

    /// The position; the header names no coordinate reference system.
    fn georeference(&self, rows: usize) -> Option<Georeference> {
        let cell = [self.get("dx")?, self.get("dy")?];
        let [west, south] = self.corner(cell)?;
        let corner = [west, south + rows as f64 * cell[1]];
        Some(Georeference { corner, cell, keys: GeoKeys::default() })
    }

    /// Cells of unknown unit are degrees where [`looks_like_degrees`] holds, else metres.
    fn cell(&self, path: &Path, rows: usize, cols: usize) -> Result<Cell> {
        let cell = match [self.get("dx"), self.get("dy")] {
            [None, None] => return Ok(Cell::Unknown),
            [Some(x), Some(y)] => [x, y],
            _ => {
                let place = "header: dx, dy";
                return Err(Error::file(path, place, "one of them", "both, or cellsize"));
            }
        };
        if !cell.iter().all(|c| *c > 0.0 && c.is_finite()) {
            let found = format!("{:?} × {:?}", cell[0], cell[1]);
            return Err(Error::file(path, "header: cellsize", found, "positive lengths"));
        }
        let Some([west, south]) = self.corner(cell) else { return Ok(Cell::Metres(cell)) };
        let (width, height) = (cols as f64 * cell[0], rows as f64 * cell[1]);
        if looks_like_degrees([west, west + width], [south, south + height], cell) {
            let latitude = south + height / 2.0;
            return Ok(Cell::Degrees { cell, latitude, is_guess: true });
        }
        Ok(Cell::Metres(cell))
    }
}

/// The grid. The count of numbers must match the header.
pub(crate) fn heights(path: &Path, bytes: &[u8]) -> Result<Raster> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        Error::file(path, format!("byte {}", e.valid_up_to()), "bytes that are no text", "text")
    })?;
    let mut words = text.split_ascii_whitespace().peekable();
    let mut header = Header(HashMap::new());
    while let Some(key) =
        words.next_if(|w| w.starts_with(|c: char| c.is_ascii_alphabetic()) && number(w).is_none())
    {
        let place = || format!("header: {}", shortened(key));
        let word = words.next().unwrap_or("the end of the file");
        let value =
            number(word).ok_or_else(|| Error::file(path, place(), shortened(word), "a number"))?;
        let lower = key.to_ascii_lowercase().replace("centre", "center");
        if !KEYS.contains(&lower.as_str()) {
            let expected = "ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, \
                            cellsize or dx and dy, NODATA_value";
            let found = format!("the key {}", shortened(key));
            return Err(Error::file(path, "header", found, expected));
        }
        match lower.as_str() {
            "cellsize" => header.0.extend(["dx", "dy"].map(|key| (key.to_owned(), value))),
            _ => _ = header.0.insert(lower, value),
        }
    }
    let count = |name: &str| match header.get(name) {
        Some(v) if v.fract() == 0.0 && (0.0..1e15).contains(&v) => Ok(v as u64),
        Some(v) => Err(Error::file(path, format!("header: {name}"), format!("{v:?}"), "a count")),
        None => Err(Error::file(path, "header", format!("no {name}"), "ncols and nrows")),
    };
    let (rows, cols) = (count("nrows")?, count("ncols")?);
    let (rows, cols) = open::size(path, "header", rows, cols)?;
    // Each number takes at least a digit and a blank: 8 bytes of memory for 2 of text.
    let claimed = 8 * rows as u64 * cols as u64;
    open::plausible(path, "header", claimed, bytes.len() + 1, 4)?;
    let mut values = Vec::with_capacity(rows * cols);
    for row in 0..rows {
        for col in 0..cols {
            let word = words.next().unwrap_or("the end of the file");
            values.push(number(word).ok_or_else(|| {
                Error::file(path, format!("row {row}, column {col}"), shortened(word), "a number")
            })?);
        }
    }
    if let Some(word) = words.next() {
        let expected = format!("the end after {rows} rows of {cols} columns");
        return Err(Error::file(path, "after the last row", shortened(word), expected));
    }
    let cell = header.cell(path, rows, cols)?;
    let georeference = header.georeference(rows);
    let nodata = header.get("nodata_value");
    let data_type = "text".to_owned();
    Ok(Raster { data_type, cell, nodata, georeference, ..Raster::bare(rows, cols, values) })
}

/// A number as these files write them; `nan` is accepted, so that it can mark no data.
fn number(word: &str) -> Option<f64> {
    word.parse().ok()
}

/// A word, shortened for messages.
fn shortened(word: &str) -> String {
    word.chars().take(24).filter(|c| !c.is_control()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Raster> {
        heights(Path::new("a.asc"), text.as_bytes())
    }

    #[test]
    fn metres_degrees_and_centres() {
        let grid = "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 4900000\ncellsize 30\n\
                    NODATA_value -9999\n1 2 3\n4 -9999 6.5\n";
        let raster = parse(grid).unwrap();
        assert_eq!((raster.rows, raster.cols), (2, 3));
        assert_eq!(raster.values, [1.0, 2.0, 3.0, 4.0, -9999.0, 6.5]);
        assert_eq!((raster.cell, raster.nodata), (Cell::Metres([30.0; 2]), Some(-9999.0)));

        let grid = "NCOLS 2 NROWS 4 XLLCENTER -72 YLLCENTER 44 DX 0.03125 DY 0.0625 \
                    nodata_value nan 1 2 3 4 5 6 7 nan";
        let raster = parse(grid).unwrap();
        // Centre of the south row at 44, four rows of 1/16 degree: the middle is 1.5 rows up.
        let cell = [0.03125, 0.0625];
        let expected = Cell::Degrees { cell, latitude: 44.09375, is_guess: true };
        assert_eq!(raster.cell, expected);
        assert!(raster.nodata.unwrap().is_nan() && raster.values[7].is_nan());

        assert_eq!(parse("ncols 1 nrows 1 7").unwrap().cell, Cell::Unknown);
    }

    #[test]
    fn each_mistake_is_named() {
        for (text, said) in [
            ("ncols 2 nrows 2 1 2 3", "row 1, column 1: found the end of the file"),
            ("ncols 2 nrows 2 1 2 3 4 5", "after the last row: found 5"),
            ("ncols 2 nrows 2 1 x 3 4", "row 0, column 1: found x"),
            ("ncols 2 1 2", "no nrows"),
            ("ncols 1.5 nrows 1 2", "ncols: found 1.5"),
            ("ncols -1 nrows 1 2", "ncols: found -1"),
            ("ncols 60000 nrows 10000 2", "no more than the file can hold"),
            ("ncols 1e6 nrows 1 2", "1000000 columns"),
            ("ncols", "ncols: found the end of the file"),
            ("colour 3", "the key colour"),
            ("ncols 1 nrows 1 cellsize 0 2", "cellsize: found 0"),
            ("ncols 1 nrows 1 dx 1 2", "one of them"),
        ] {
            let error = parse(text).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
