//! The GeoTIFF tags for the cell size (OGC 19-008r4), and GDAL's no-data tag.

use crate::georeference::{
    GeoKeys, Georeference, KEY_DOUBLES, LINEAR_UNIT, MODEL_TYPE, PROJECTED_CRS, RASTER_TYPE,
};
use crate::heights::tif::Tiff;
use crate::heights::{Cell, Raster, looks_like_degrees, projection, unit};
use crate::open;
use ridgelight::{Error, Result};
use std::path::Path;
use tiff::{decoder::ifd::Value, tags::Tag};

const PIXEL_SCALE: u16 = 33550;
const TIEPOINT: u16 = 33922;
const TRANSFORMATION: u16 = 34264;
const KEY_DIRECTORY: u16 = 34735;
const KEY_ASCII: u16 = 34737;
const GDAL_METADATA: u16 = 42112;
const GDAL_NODATA: u16 = 42113;

const ANGULAR_UNIT: u16 = 2054;
const LINEAR_UNIT_SIZE: u16 = 3077;
const VERTICAL_CRS: u16 = 4096;
const VERTICAL_UNIT: u16 = 4099;

/// Grid coordinates of a north-up raster.
struct Grid {
    cell: [f64; 2],
    /// World position of raster position (0, 0), if there is a tie point.
    origin: Option<[f64; 2]>,
}

/// Fills `raster` from the tags of a file, with scale, offset and unit of a band; bands count from 0.
pub(crate) fn read(path: &Path, tiff: &mut Tiff, band: usize, raster: &mut Raster) -> Result<()> {
    raster.nodata = nodata(path, tiff)?;
    raster.scale = scale(path, tiff, band)?;
    let keys = keys(path, tiff)?;
    let of_crs = keys.short(VERTICAL_CRS).and_then(vertical_unit);
    let of_system = length(path, &keys, VERTICAL_UNIT)?.or(of_crs);
    let name = unit_name(path, tiff, band)?;
    let of_band = name.as_deref().and_then(unit::metres);
    raster.unit_m = of_band.or(of_system);
    let about_name = name.and_then(|name| unit::warning(&name, of_band, of_system));
    match raster.unit_m {
        Some(_) => raster.warnings.extend(about_name),
        None => raster.unit_warning = about_name,
    }
    let Some(grid) = grid(path, tiff)? else { return Ok(()) };
    // Raster position (0, 0) is the corner of the first pixel, or its centre (RasterType 2).
    let last = |n: usize| if keys.short(RASTER_TYPE) == Some(2) { n - 1 } else { n } as f64;
    let span = [last(raster.cols) * grid.cell[0], last(raster.rows) * grid.cell[1]];
    let degrees = |is_guess: bool| -> Result<Cell> {
        let Some([_, north]) = grid.origin else {
            let expected = "the latitude of a grid in degrees";
            return Err(wrong(path, TIEPOINT, "nothing", expected));
        };
        Ok(Cell::Degrees { cell: grid.cell, latitude: north - span[1] / 2.0, is_guess })
    };
    raster.cell = match keys.short(MODEL_TYPE) {
        Some(2) => match keys.short(ANGULAR_UNIT) {
            // EPSG: degree, degree (supplier to define representation).
            None | Some(9102 | 9122) => degrees(false)?,
            Some(unit) => {
                let place = format!("GeoKey {ANGULAR_UNIT}");
                return Err(Error::file(path, place, format!("unit {unit}"), "9102 (degree)"));
            }
        },
        // GDAL writes 32767 for a model of one's own.
        Some(1 | 32767) if keys.is_web_mercator() => {
            let Some([_, north]) = grid.origin else {
                let expected = "the northing of a grid in Web Mercator";
                return Err(wrong(path, TIEPOINT, "nothing", expected));
            };
            Cell::Mercator { cell: grid.cell, northing_m: north - span[1] / 2.0 }
        }
        Some(1) => {
            let of_crs = keys.short(PROJECTED_CRS).and_then(projection::unit_m);
            let unit_m = length(path, &keys, LINEAR_UNIT)?.or(of_crs).unwrap_or(1.0);
            if unit_m != 1.0 && raster.unit_m.is_none() {
                raster.unit_warning.get_or_insert_with(|| unit::of_cells(unit_m));
            }
            raster.cell_unit_m = unit_m;
            Cell::Metres(grid.cell.map(|c| c * unit_m))
        }
        None | Some(0 | 32767) => match grid.origin {
            Some([west, north])
                if looks_like_degrees(
                    [west, west + span[0]],
                    [north, north - span[1]],
                    grid.cell,
                ) =>
            {
                degrees(true)?
            }
            _ => Cell::Metres(grid.cell),
        },
        Some(model) => {
            let expected = "1 (projected) or 2 (geographic)";
            let place = format!("GeoKey {MODEL_TYPE}");
            return Err(Error::file(path, place, format!("model type {model}"), expected));
        }
    };
    raster.georeference = grid.georeference(keys);
    Ok(())
}

/// Georeference of a file, if it has one.
pub(crate) fn georeference(path: &Path, tiff: &mut Tiff) -> Result<Option<Georeference>> {
    let Some(grid) = grid(path, tiff)? else { return Ok(None) };
    Ok(grid.georeference(keys(path, tiff)?))
}

impl Grid {
    fn georeference(self, keys: GeoKeys) -> Option<Georeference> {
        Some(Georeference::at_origin(self.origin?, self.cell, keys))
    }
}

/// Metres in the unit of a vertical coordinate reference system of the EPSG registry (v10.076), `None` for private
/// systems. All but these are in metres.
fn vertical_unit(crs: u16) -> Option<f64> {
    match crs {
        // US survey feet: NGVD29, NAVD88 and mean sea level, heights and depths.
        5702 | 6358 | 6359 | 6360 | 8052 | 8053 => Some(unit::US_SURVEY_FOOT_M),
        // Feet: the Cayman Islands, mean sea level, NAVD88, and the well datum of Kuwait.
        6130..=6132 | 8050 | 8051 | 8228 | 5614 => Some(unit::FOOT_M),
        // British feet of 1936: Poolbeg.
        5754 => Some(0.304_800_749_1),
        1..32767 => Some(1.0),
        _ => None,
    }
}

fn wrong(path: &Path, tag: u16, found: impl Into<String>, expected: &str) -> Error {
    Error::file(path, format!("tag {tag}"), found, expected)
}

/// A tag's value, `None` where absent. Its count is checked against the file's size before the
/// decoder allocates memory.
fn find(path: &Path, tiff: &mut Tiff, tag: u16, expected: &str) -> Result<Option<Value>> {
    let wrong = |found: String| wrong(path, tag, found, expected);
    let held = tiff.inner().size() as u64;
    let tag = Tag::from_u16_exhaustive(tag);
    match tiff.image_ifd().directory().get(tag) {
        Some(entry) if entry.count() > held => {
            Err(wrong(format!("a claim of {} values in {held} bytes", entry.count())))
        }
        Some(_) => tiff.find_tag(tag).map_err(|e| wrong(open::complaint(e))),
        None => Ok(None),
    }
}

/// The numbers of a tag, `None` where absent.
fn doubles(path: &Path, tiff: &mut Tiff, tag: u16) -> Result<Option<Vec<f64>>> {
    let wrong = |e| wrong(path, tag, open::complaint(e), "numbers");
    let value = find(path, tiff, tag, "numbers")?;
    value.map(|v| v.into_f64_vec().map_err(wrong)).transpose()
}

/// The grid from the transformation, or from scale and tie point; `None` where both are absent.
fn grid(path: &Path, tiff: &mut Tiff) -> Result<Option<Grid>> {
    let (tag, cell, origin) = if let Some(m) = doubles(path, tiff, TRANSFORMATION)? {
        let &[xi, xj, _, x0, yi, yj, _, y0, ..] = m.as_slice() else {
            let found = format!("{} numbers", m.len());
            return Err(wrong(path, TRANSFORMATION, found, "16 numbers"));
        };
        if xj != 0.0 || yi != 0.0 {
            let expected = "columns to the east and rows to the south (warp it first)";
            return Err(wrong(path, TRANSFORMATION, "a rotated or sheared grid", expected));
        }
        if yj > 0.0 {
            let expected = "rows from north to south (warp it first, with gdalwarp)";
            return Err(wrong(path, TRANSFORMATION, "rows from south to north", expected));
        }
        (TRANSFORMATION, [xi, -yj], Some([x0, y0]))
    } else if let Some(scale) = doubles(path, tiff, PIXEL_SCALE)? {
        let &[x, y, ..] = scale.as_slice() else {
            let found = format!("{} numbers", scale.len());
            return Err(wrong(path, PIXEL_SCALE, found, "3 numbers"));
        };
        let origin = match doubles(path, tiff, TIEPOINT)?.as_deref() {
            None => None,
            Some([i, j, _, east, north, ..]) => Some([east - i * x, north + j * y]),
            Some(other) => {
                let found = format!("{} numbers", other.len());
                return Err(wrong(path, TIEPOINT, found, "6 numbers"));
            }
        };
        (PIXEL_SCALE, [x, y], origin)
    } else {
        return Ok(None);
    };
    if !cell.iter().all(|c| c.is_finite() && *c > 0.0) {
        let found = format!("cells of {:?} × {:?}", cell[0], cell[1]);
        let expected = "positive sizes: columns to the east and rows from north to south (warp it first, with gdalwarp)";
        return Err(wrong(path, tag, found, expected));
    }
    Ok(Some(Grid { cell, origin }))
}

/// GDAL's metadata: `<Item name="SCALE" sample="0" role="scale">0.1</Item>`.
fn metadata(path: &Path, tiff: &mut Tiff) -> Result<String> {
    let value = find(path, tiff, GDAL_METADATA, "text")?;
    Ok(value.and_then(|value| value.into_string().ok()).unwrap_or_default())
}

/// What the metadata states of a band in a role: "scale", "offset", "unittype", "description".
fn item(metadata: &str, band: usize, role: &str) -> Option<String> {
    let [role, sample] = [format!("role=\"{role}\""), format!("sample=\"{band}\"")];
    let is_it = |item: &&str| {
        let head = item.split('>').next().unwrap_or_default();
        head.contains(&role) && head.contains(&sample)
    };
    let item = metadata.split("<Item ").find(is_it)?;
    let mut text = item.split(['>', '<']).nth(1)?.trim().to_owned();
    // The ampersand last: "&amp;lt;" stands for "&lt;".
    for (code, c) in
        [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")]
    {
        text = text.replace(code, c);
    }
    Some(text)
}

/// Scale and offset of a band.
pub(crate) fn scale(path: &Path, tiff: &mut Tiff, band: usize) -> Result<[f64; 2]> {
    let text = metadata(path, tiff)?;
    let number = |role: &str, default: f64| {
        let Some(body) = item(&text, band, role) else { return Ok(default) };
        let number = body.parse().ok().filter(|n: &f64| n.is_finite());
        let short = open::shortened(&body, 24);
        let expected = "numbers for scale and offset";
        number.ok_or_else(|| wrong(path, GDAL_METADATA, format!("{role} {short:?}"), expected))
    };
    Ok([number("scale", 1.0)?, number("offset", 0.0)?])
}

/// The description of a band; bands count from 0.
pub(crate) fn band_name(path: &Path, tiff: &mut Tiff, band: usize) -> Result<Option<String>> {
    Ok(item(&metadata(path, tiff)?, band, "description").filter(|name| !name.is_empty()))
}

/// The name of a band's unit, `None` where the file states none.
fn unit_name(path: &Path, tiff: &mut Tiff, band: usize) -> Result<Option<String>> {
    let name = item(&metadata(path, tiff)?, band, "unittype");
    Ok(name.map(|name| open::shortened(&name, 24)).filter(|name| !name.is_empty()))
}

pub(crate) fn nodata(path: &Path, tiff: &mut Tiff) -> Result<Option<f64>> {
    let expected = "a number, or nan";
    let wrong = |found: String| wrong(path, GDAL_NODATA, found, expected);
    let Some(value) = find(path, tiff, GDAL_NODATA, expected)? else { return Ok(None) };
    let text = value.into_string().map_err(|e| wrong(open::complaint(e)))?;
    let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
    let short = open::shortened(text, 24);
    text.parse().map(Some).map_err(|_| wrong(format!("{short:?}")))
}

/// All keys of the GeoKey directory, for files to write too. Text that cannot be read is left out with its keys.
fn keys(path: &Path, tiff: &mut Tiff) -> Result<GeoKeys> {
    let expected = "GeoKeys: four shorts each";
    let shorts = match find(path, tiff, KEY_DIRECTORY, expected)? {
        Some(value) => value
            .into_u16_vec()
            .map_err(|e| wrong(path, KEY_DIRECTORY, open::complaint(e), expected))?,
        None => Vec::new(),
    };
    let doubles = doubles(path, tiff, KEY_DOUBLES)?.unwrap_or_default();
    let text = find(path, tiff, KEY_ASCII, "text").ok().flatten();
    let ascii = text.and_then(|text| text.into_string().ok()).unwrap_or_default();
    let ascii = ascii.trim_end_matches('\0').to_owned();
    let is_held = |[_, location, count, value]: &[u16; 4]| {
        let end = usize::from(*count) + usize::from(*value);
        match *location {
            0 => true,
            KEY_DOUBLES => end <= doubles.len(),
            KEY_ASCII => end <= ascii.len() + 1,
            // Some writers keep shorts behind the entries.
            _ => false,
        }
    };
    // The first four are version and count.
    let (entries, _) = shorts.as_chunks::<4>();
    let entries = entries.iter().skip(1).copied().filter(is_held).collect();
    Ok(GeoKeys { entries, doubles, ascii })
}

/// Metres in the EPSG unit of length of a key; `None` where the key is absent.
fn length(path: &Path, keys: &GeoKeys, key: u16) -> Result<Option<f64>> {
    let Some(unit) = keys.short(key) else { return Ok(None) };
    let user_size = || {
        let is_size = |e: &&[u16; 4]| e[0] == LINEAR_UNIT_SIZE && e[1] == KEY_DOUBLES;
        let entry = keys.entries.iter().find(is_size)?;
        let size = *keys.doubles.get(usize::from(entry[3]))?;
        (size.is_finite() && size > 0.0).then_some(size)
    };
    let metres = match unit {
        9001 => Some(1.0),
        9002 => Some(unit::FOOT_M),
        9003 => Some(unit::US_SURVEY_FOOT_M),
        9036 => Some(1000.0),
        32767 if key == LINEAR_UNIT => user_size(),
        // Undefined.
        0 => Some(1.0),
        _ => None,
    };
    metres.map(Some).ok_or_else(|| {
        let expected = "9001 (metre), 9002 (foot), 9003 (US survey foot) or 9036 (kilometre)";
        Error::file(path, format!("GeoKey {key}"), format!("unit {unit}"), expected)
    })
}
