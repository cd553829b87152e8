//! Where the pixels of a PNG map lie: the files beside it, and notes.

use std::path::{Path, PathBuf};

use ridgelight::Result;
use ridgelight::scene::HeightField;
use ridgelight_io as files;
use ridgelight_io::Georeference;

use crate::args::Input;
use crate::setup;

/// Writes the world file of a PNG and, if the coordinate reference system has an EPSG code, the `.aux.xml` from which GDAL and QGIS
/// read the code.
pub fn write(picture: &Path, input: &Input, georeference: Option<&Georeference>) -> Result<()> {
    let input = input.first().display();
    let [world, system] = files_of(picture);
    let Some(at) = georeference else {
        warn_of_stale(picture, &format!("{input} states no position"));
        return Ok(());
    };
    files::write_text(&world, &at.world_file())?;
    match at.pam() {
        Some(text) => files::write_text(&system, &text),
        None => {
            let why = format!("{input} has no coordinate reference system with an EPSG code");
            warn_of(&system, &why);
            Ok(())
        }
    }
}

/// The world file beside a PNG, and the file of its coordinate reference system.
fn files_of(picture: &Path) -> [PathBuf; 2] {
    let mut name = picture.as_os_str().to_owned();
    name.push(".aux.xml");
    [picture.with_extension("pgw"), name.into()]
}

/// Warns if files of an earlier picture lie beside one that gets none.
pub fn warn_of_stale(picture: &Path, why: &str) {
    files_of(picture).iter().for_each(|path| warn_of(path, why));
}

fn warn_of(path: &Path, why: &str) {
    if path.exists() {
        setup::warning(&format!("{} belongs to another picture, because {why}", path.display()));
    }
}

/// Cells whose sides differ by less are square: a hundred pixels are then long by one.
const SQUARE: f64 = 0.01;

/// A note where a map's pixels have other proportions than the ground.
pub fn note_shape(
    picture: &Path,
    field: &HeightField,
    georeference: Option<&Georeference>,
    quiet: bool,
) {
    let [width, height] = field.cell_m();
    if (width / height - 1.0).abs() < SQUARE || quiet {
        return;
    }
    let shape = if height > width {
        format!("{:.2} times too wide", height / width)
    } else {
        format!("{:.2} times too tall", width / height)
    };
    let utm = georeference.and_then(|at| utm_of(at, field)).map_or_else(String::new, |code| {
        format!("; to get square cells, reproject the input with `gdalwarp -t_srs EPSG:{code}`")
    });
    setup::note(&format!(
        "{}: each pixel covers {width:.1} x {height:.1} m; the picture is {shape}{utm}",
        picture.display(),
    ));
}

/// The UTM zone in the middle of a field in longitude and latitude.
fn utm_of(at: &Georeference, field: &HeightField) -> Option<u16> {
    let [west, south, east, north] = at.extent(field.rows(), field.cols());
    let [longitude, latitude] = [(west + east) / 2.0, (south + north) / 2.0];
    if at.keys.epsg() != Some(4326) || !(-180.0..180.0).contains(&longitude) {
        return None;
    }
    let zone = ((longitude + 180.0) / 6.0).floor() as u16 + 1;
    Some(if latitude < 0.0 { 32700 } else { 32600 } + zone)
}
