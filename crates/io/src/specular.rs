//! Maps of Phong specular.

use crate::open::Format;
use crate::planes::{Planes, read_planes};
use ridgelight::scene::{PhongSpecular, Specular};
use ridgelight::{Error, Result};
use std::path::Path;

/// Reads the Phong exponent and scale of each of `rows` × `cols` grid points: `.exr` channels "R"
/// and "G", other channels ignored, or an `.npy` array [2, rows, cols]. A `.png` is refused: its
/// values end at 1, exponents do not.
///
/// # Errors
/// Another format, size or number of channels; an exponent or a scale out of range (with row and
/// column).
pub fn read_specular(path: &Path, rows: usize, cols: usize) -> Result<Specular> {
    if !matches!(Format::of_name(path), Some(Format::Exr | Format::Npy)) {
        let found = path.extension().map_or("none".into(), |e| format!(".{}", e.display()));
        let expected = ".exr or .npy, which hold exponents above 1";
        return Err(Error::file(path, "extension", found, expected));
    }
    // The signature is checked here.
    let Planes { rows: map_rows, cols: map_cols, names, planes } = read_planes(path)?;
    let of = |wanted: [&str; 2]| wanted.map(|name| names.iter().position(|n| n == name));
    let places = match of(["R", "G"]) {
        [None, None] if names.len() == 2 => of(["0", "1"]),
        places => places,
    };
    let [Some(exponents), Some(scales)] = places else {
        let expected = "R (exponent) and G (scale), or two planes of an array";
        return Err(Error::file(path, "channels", names.join(", "), expected));
    };
    if (map_rows, map_cols) != (rows, cols) {
        let found = format!("{map_cols} × {map_rows} texels");
        return Err(Error::file(path, "size", found, format!("{cols} × {rows}, as the heights")));
    }
    let all = planes[exponents].iter().zip(&planes[scales]);
    let map: Vec<PhongSpecular> =
        all.map(|(e, s)| PhongSpecular { exponent: *e, scale: *s }).collect();
    match map.iter().enumerate().find_map(|(i, phong)| Some((i, phong.out_of_range()?))) {
        Some((i, (what, found, expected))) => {
            let place = format!("row {}, column {}", i / cols, i % cols);
            Err(Error::file(path, place, format!("{what} {found}"), expected))
        }
        None => Ok(Specular::Map(map)),
    }
}
