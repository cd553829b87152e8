//! Environments, and maps of albedo and Phong specular.

mod cube;
pub mod hdr;

use crate::arrays::planes::{Planes, read_planes};
use crate::exr;
use crate::open::{self, Format};
use crate::png;
use cube::Picture;
use ridgelight::scene::{Albedo, Environment, PhongSpecular, Specular};
use ridgelight::{Error, Result};
use std::path::{Path, PathBuf};

/// Names of a cube's faces in file names, +X -X +Y -Y +Z -Z.
const FACES: [[&str; 6]; 2] =
    [["px", "nx", "py", "ny", "pz", "nz"], ["posx", "negx", "posy", "negy", "posz", "negz"]];

/// Reads an environment from `.hdr` (or `.pic`) and `.exr` pictures, rotated counter-clockwise by
/// `rotation_rad`; at most 2²⁷ texels (16384 × 8192).
///
/// | picture | is read as |
/// |---|---|
/// | width = 2 · height | equirectangular, texels unchanged |
/// | width = height | an angular map (light probe): centre ahead, rim behind |
/// | 4:3 | a horizontal cube cross, behind at the far right |
/// | 3:4 | a vertical cube cross, behind upside down at the foot |
/// | six squares | cube faces: see below |
///
/// Cube faces are any one of six files whose names differ in the word `px nx py ny pz nz` or `posx
/// negx posy negy posz negz` ("sky_px.hdr"), or one name with `*` in that word's place.
///
/// Ahead is +x (east, azimuth 0), up is +z, right is -y (south); the view is from inside and not
/// mirrored. Cube faces follow OpenGL and Vulkan: +Z ahead, +X right, +Y up, first row on top.
///
/// Other projections than equirectangular are resampled once, at a resolution no coarser than the
/// source's finest (a cube of faces n wide: 10n/3 rows; an angular map: width/2 rows). Each texel
/// is the mean of 4 × 4 bilinear lookups. A constant stays exactly constant; the irradiance of a
/// bright patch stays within 1 %.
///
/// # Errors
/// Another shape or format; faces that are missing, not square or unequal; radiance that is
/// negative or not finite (with row and column). `.exr` channels are R, G, B, or Y for grey.
pub fn read_environment(path: &Path, rotation_rad: f64) -> Result<Environment> {
    if let Some(paths) = pattern(path) {
        return six_faces(&paths, rotation_rad);
    }
    let bytes = open::read(path)?;
    if let Some(paths) = siblings(path) {
        let picture = picture(path, &bytes)?;
        if picture.rows == picture.cols {
            drop(picture);
            return six_faces(&paths, rotation_rad);
        }
    }
    parse_environment(path, &bytes, rotation_rad)
}

/// [`read_environment`] for a single picture in memory. `name` sets the format and appears in
/// messages.
///
/// # Errors
/// As [`read_environment`], except file access and cube faces.
pub fn parse_environment(name: &Path, bytes: &[u8], rotation_rad: f64) -> Result<Environment> {
    let picture = picture(name, bytes)?;
    let (rows, cols) = (picture.rows, picture.cols);
    let refused = |found: &str| {
        let expected = "width = 2 · height, a square, or a cube cross of 4:3 or 3:4";
        Err(Error::file(name, "size", format!("{found}{cols} × {rows}"), expected))
    };
    let picture = if cols == 2 * rows {
        check(name, &picture, |_, _| true)?;
        picture
    } else if cols == rows {
        if cols < 2 {
            return refused("an angular map of ");
        }
        let unit = |i: usize| (2.0 * i as f64 + 1.0) / cols as f64 - 1.0;
        check(name, &picture, |r, c| unit(r).hypot(unit(c)) <= 1.0)?;
        cube::from_angular(&picture)
    } else if rows * 4 == cols * 3 || cols * 4 == rows * 3 {
        let side = rows.max(cols) / 4;
        check(name, &picture, |r, c| r / side == 1 || c / side == 1)?;
        limit(name, side)?;
        cube::from_cross(&picture)
    } else {
        return refused("");
    };
    Environment::new(picture.cols, picture.rows, picture.texels, rotation_rad)
}

/// Decodes a picture of any shape.
fn picture(path: &Path, bytes: &[u8]) -> Result<Picture> {
    let (rows, cols, texels) = match open::format(path, bytes, &[Format::Hdr, Format::Exr])? {
        Format::Exr => exr::colour(path, bytes),
        _ => hdr::colour(path, bytes),
    }?;
    if texels.len() as u64 > hdr::TEXEL_LIMIT {
        let expected = format!("at most {} texels", hdr::TEXEL_LIMIT);
        return Err(Error::file(path, "size", format!("{cols} × {rows}"), expected));
    }
    Ok(Picture { rows, cols, texels })
}

/// Radiance must be finite and not negative wherever it is `used`.
fn check(path: &Path, picture: &Picture, used: impl Fn(usize, usize) -> bool) -> Result<()> {
    for (i, texel) in picture.texels.iter().enumerate() {
        let (row, col) = (i / picture.cols, i % picture.cols);
        if !texel.iter().all(|v| v.is_finite() && *v >= 0.0) && used(row, col) {
            let place = format!("row {row}, column {col}");
            let found = format!("radiance {texel:?}");
            return Err(Error::file(path, place, found, "finite numbers, 0 or more"));
        }
    }
    Ok(())
}

/// The resampled cube must be within the limit, too.
fn limit(path: &Path, side: usize) -> Result<()> {
    let rows = cube::cube_rows(side) as u64;
    if 2 * rows * rows > hdr::TEXEL_LIMIT {
        let found = format!("cube faces {side} wide");
        return Err(Error::file(path, "size", found, "faces up to 2457 wide"));
    }
    Ok(())
}

/// The six names of a pattern with one `*`.
fn pattern(path: &Path) -> Option<Vec<[PathBuf; 6]>> {
    let (before, after) = path.file_name()?.to_str()?.split_once('*')?;
    let named = |face: &str| path.with_file_name(format!("{before}{face}{after}"));
    Some(FACES.iter().map(|words| words.map(named)).collect())
}

/// The six names of a set that contains this one: the face's word stands alone in the stem.
fn siblings(path: &Path) -> Option<Vec<[PathBuf; 6]>> {
    let name = path.file_name()?.to_str()?;
    let stem = path.file_stem()?.to_str()?;
    let mut start = 0;
    for word in stem.split(|c: char| !c.is_ascii_alphanumeric()) {
        for words in FACES {
            if words.contains(&word.to_ascii_lowercase().as_str()) {
                let upper = word.chars().all(|c| c.is_ascii_uppercase());
                let named = |face: &str| {
                    let face = if upper { face.to_ascii_uppercase() } else { face.to_owned() };
                    let (before, after) = (&name[..start], &name[start + word.len()..]);
                    path.with_file_name(format!("{before}{face}{after}"))
                };
                return Some(vec![words.map(named)]);
            }
        }
        // The separator may be any character; the rest of the name gives the word's length.
        start += word.len();
        start += stem.get(start..)?.chars().next().map_or(0, char::len_utf8);
    }
    None
}

/// Reads a cube by the first set of names whose first file exists.
fn six_faces(sets: &[[PathBuf; 6]], rotation_rad: f64) -> Result<Environment> {
    let set = sets.iter().find(|set| set[0].exists()).or(sets.first());
    let mut faces: Vec<Picture> = Vec::new();
    for path in set.into_iter().flatten() {
        let face = picture(path, &open::read(path)?)?;
        let side = faces.first().map_or(face.rows, |f| f.rows);
        if face.rows != face.cols || face.rows != side {
            let found = format!("{} × {}", face.cols, face.rows);
            let expected = format!("a cube face of {side} × {side}, as the others");
            return Err(Error::file(path, "size", found, expected));
        }
        limit(path, side)?;
        check(path, &face, |_, _| true)?;
        faces.push(face);
    }
    let faces: [Picture; 6] = faces
        .try_into()
        .map_err(|_| Error::setting("environment", "fewer files", "six faces of a cube"))?;
    let picture = cube::from_cube(&faces);
    Environment::new(picture.cols, picture.rows, picture.texels, rotation_rad)
}

/// Reads a map of diffuse reflectance, one texel for each grid point of a field of `rows` × `cols`.
///
/// `.png` (grey, RGB or palette; alpha is ignored) is sRGB-encoded at 8 and 16 bits and is decoded
/// to linear light. `.exr` (R, G, B, or Y) is already linear.
///
/// # Errors
/// Another size than the field's; a channel outside [0..1] (with row and column); a file that
/// cannot be read or decoded.
pub fn read_albedo(path: &Path, rows: usize, cols: usize) -> Result<Albedo> {
    let bytes = open::read(path)?;
    let (map_rows, map_cols, texels) =
        match open::format(path, &bytes, &[Format::Png, Format::Exr])? {
            Format::Exr => exr::colour(path, &bytes)?,
            _ => {
                let png = png::linear(path, &bytes)?;
                (png.rows, png.cols, png.rgb)
            }
        };
    if (map_rows, map_cols) != (rows, cols) {
        let found = format!("{map_cols} × {map_rows} texels");
        return Err(Error::file(path, "size", found, format!("{cols} × {rows}, as the heights")));
    }
    match texels.iter().position(|t| !t.iter().all(|v| (0.0..=1.0).contains(v))) {
        Some(i) => {
            let place = format!("row {}, column {}", i / cols, i % cols);
            Err(Error::file(path, place, format!("albedo {:?}", texels[i]), "channels from 0 to 1"))
        }
        None => Ok(Albedo::Map(texels)),
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_faces_of_a_name() {
        for (name, first, last) in [
            ("d/sky_px.hdr", "d/sky_px.hdr", "d/sky_nz.hdr"),
            ("sky.negz.hdr", "sky.posx.hdr", "sky.negz.hdr"),
            ("PY.exr", "PX.exr", "NZ.exr"),
            ("äü–ny–2.exr", "äü–px–2.exr", "äü–nz–2.exr"),
        ] {
            let sets = siblings(Path::new(name)).unwrap();
            assert_eq!(
                (sets[0][0].as_path(), sets[0][5].as_path()),
                (Path::new(first), Path::new(last))
            );
        }
        assert!(siblings(Path::new("spx.hdr")).is_none());
        let sets = pattern(Path::new("a/b*.hdr")).unwrap();
        assert_eq!(sets[1][3], Path::new("a/bnegy.hdr"));
        assert!(pattern(Path::new("a*/b.hdr")).is_none());
    }
}
