//! Writes GeoTIFF: f32 bands in tiles with overviews, laid out as a Cloud Optimized GeoTIFF.
//!
//! Why a writer of its own, as of November 2026:
//! - `tiff` 0.11 reads tiles and the floating-point predictor. Its encoder writes strips only, and refuses that predictor.
//! - `geotiff-writer` 0.10 writes both, in COG order, but not GDAL's metadata, which holds the names and units of bands.
//! - `gdal` binds GDAL's C library, which users would have to install.

mod directory;
mod layers;
mod tiles;

use crate::atomic::{Temporary, Written, folder_of};
use crate::georeference::Georeference;
use directory::{Directory, Values};
pub use layers::write_geotiff;
use ridgelight::{Error, Result};
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tiles::Size;

/// Announces the layout (GDAL's "COG ghost area"). The blank lets an editor that breaks the layout
/// write YES.
const LAYOUT: &str = "LAYOUT=IFDS_BEFORE_DATA\nKNOWN_INCOMPATIBLE_EDITION=NO\n ";

/// What a band holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Band {
    /// GDAL's description of the band, as "azimuth_000.0".
    pub name: String,
    /// The unit of its values, as "rad"; empty where there is none.
    pub unit: String,
}

/// Place and length of a compressed tile among the others.
type Place = (u64, u64);

/// Writes a GeoTIFF band by band, in any order.
///
/// - f32, deflated with predictor 3, no-data NaN, one plane per band.
/// - Tiles of 512 x 512 and overviews (means) down to one tile; a smaller image has one tile.
/// - Laid out as a Cloud Optimized GeoTIFF: directories, then overviews from the smallest, then the
///   image. BigTIFF from 4 GiB on.
/// - Band names, units and settings in GDAL's metadata.
///
/// Memory holds one band and its compressed tiles; the other tiles wait in an unnamed file beside
/// the destination. The destination is untouched until [`finish`](Self::finish).
#[derive(Debug)]
pub struct GeoTiffWriter {
    file: Temporary,
    path: PathBuf,
    /// Compressed tiles in the order of writing.
    waiting: File,
    length: u64,
    levels: Vec<Size>,
    bands: Vec<Band>,
    /// Tiles of each band, for each level; empty before the band is written.
    places: Vec<Vec<Vec<Place>>>,
    georeference: Option<Georeference>,
    /// Offsets of 64 bits whatever the size, to test them on small files.
    always_big: bool,
}

impl GeoTiffWriter {
    /// Begins a file of these bands. Where the first three are named R, G and B, readers show them as
    /// a colour.
    ///
    /// # Errors
    /// No columns, rows or bands, or more than TIFF can count; a directory that cannot be written.
    pub fn create(
        path: &Path,
        [rows, cols]: [usize; 2],
        bands: Vec<Band>,
        georeference: Option<Georeference>,
    ) -> Result<Self> {
        let limit = u32::MAX as usize;
        if !(1..=limit).contains(&rows) || !(1..=limit).contains(&cols) {
            let found = format!("{rows} rows and {cols} columns");
            return Err(Error::setting("GeoTIFF", found, format!("1 to {limit} of each")));
        }
        if !(1..=usize::from(u16::MAX)).contains(&bands.len()) {
            let found = format!("{} bands", bands.len());
            return Err(Error::setting("GeoTIFF", found, format!("1 to {} bands", u16::MAX)));
        }
        let file = Temporary::create(path)?;
        let waiting = tempfile::tempfile_in(folder_of(file.name()));
        Ok(Self {
            waiting: waiting.map_err(|e| Error::io(path, e))?,
            file,
            path: path.to_owned(),
            length: 0,
            levels: tiles::levels([cols, rows]),
            places: vec![Vec::new(); bands.len()],
            bands,
            georeference,
            always_big: false,
        })
    }

    /// Writes a band, row-major from the north-west; each band once, in any order. NaN is no data.
    ///
    /// # Errors
    /// Another number of values than rows times columns; a band twice; a write error.
    pub fn write(&mut self, band: usize, values: &[f32]) -> Result<()> {
        let [cols, rows] = self.levels[0];
        let wrong = |found: String, expected: String| {
            Error::setting(format!("band {band} of a GeoTIFF"), found, expected)
        };
        if values.len() != rows * cols {
            let found = format!("{} values", values.len());
            return Err(wrong(found, format!("{rows} rows of {cols} columns")));
        }
        match self.places.get(band) {
            Some(places) if places.is_empty() => {}
            Some(_) => return Err(wrong("written twice".into(), "each band once".into())),
            None => return Err(wrong("no such band".into(), format!("{}", self.bands.len()))),
        }
        let mut smaller: Vec<f32>;
        let mut values = values;
        for (i, size) in self.levels.clone().into_iter().enumerate() {
            if i > 0 {
                smaller = tiles::halved(values, self.levels[i - 1]);
                values = &smaller;
            }
            let tiles = tiles::compressed(values, size).map_err(|e| Error::io(&self.path, e))?;
            let mut places = Vec::with_capacity(tiles.len());
            for tile in tiles {
                self.waiting.write_all(&tile).map_err(|e| Error::io(&self.path, e))?;
                places.push((self.length, tile.len() as u64));
                self.length += tile.len() as u64;
            }
            self.places[band].push(places);
        }
        Ok(())
    }

    /// Moves the file to its destination. `metadata` holds settings: names and texts.
    ///
    /// # Errors
    /// As [`close`](Self::close); a destination that cannot be replaced.
    pub fn finish(self, metadata: &[(String, String)]) -> Result<()> {
        self.close(metadata)?.place()
    }

    /// Ends the file, which waits beside its destination.
    ///
    /// # Errors
    /// A band that was not written; a write error.
    pub fn close(mut self, metadata: &[(String, String)]) -> Result<Written> {
        if let Some(band) = self.places.iter().position(Vec::is_empty) {
            let what = format!("band {band} of a GeoTIFF");
            return Err(Error::setting(what, "no values", "each band before the end"));
        }
        let ghost = format!("GDAL_STRUCTURAL_METADATA_SIZE={:06} bytes\n{LAYOUT}", LAYOUT.len());
        let mut directories: Vec<Directory> =
            (0..self.levels.len()).map(|level| self.directory(level, metadata)).collect();
        let start = |big: bool| {
            let head = directory::header(big, 0).len() + ghost.len().next_multiple_of(2);
            let all = directories.iter().map(|directory| directory.size(big)).sum::<usize>();
            (head as u64, (head + all) as u64)
        };
        let big = self.always_big || needs_64_bits(start(false).1 + self.length);
        let (first, data) = start(big);
        self.set_places(&mut directories, data);

        let mut head = directory::header(big, first);
        head.extend(ghost.as_bytes());
        head.resize(first as usize, b' ');
        let mut at = first;
        for (i, directory) in directories.iter().enumerate() {
            let end = at + directory.size(big) as u64;
            let next = if i + 1 < directories.len() { end } else { 0 };
            head.extend(directory.bytes(big, at, next));
            at = end;
        }
        self.file.write(&head)?;
        self.copy_tiles().map_err(|e| Error::io(&self.path, e))?;
        self.file.close()
    }

    /// The order of tiles in the file: levels from the smallest, in each the bands.
    fn tiles(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let levels = (0..self.levels.len()).rev();
        levels.flat_map(|level| (0..self.bands.len()).map(move |band| (level, band)))
    }

    /// Sets each tile's place in the file, whose tiles begin at `data`.
    fn set_places(&self, directories: &mut [Directory], data: u64) {
        let (mut at, mut offsets) = (data, vec![Vec::new(); directories.len()]);
        for (level, band) in self.tiles() {
            for (_, length) in &self.places[band][level] {
                offsets[level].push(at);
                at += length;
            }
        }
        for (directory, offsets) in directories.iter_mut().zip(offsets) {
            directory.0.insert(324, Values::Offset(offsets));
        }
    }

    fn copy_tiles(&mut self) -> io::Result<()> {
        let order: Vec<_> = self.tiles().collect();
        for (level, band) in order {
            // A level's tiles of one band are consecutive.
            let places = &self.places[band][level];
            let length = places.iter().map(|place| place.1).sum();
            self.waiting.seek(SeekFrom::Start(places[0].0))?;
            let mut part = io::Read::take(&self.waiting, length);
            io::copy(&mut part, self.file.stream())?;
        }
        Ok(())
    }

    /// Tags of a level; places of tiles are 0.
    fn directory(&self, level: usize, metadata: &[(String, String)]) -> Directory {
        let size = self.levels[level];
        let [cols, rows] = size.map(|side| side as u32);
        let [width, height] = tiles::tile_size(size).map(|side| side as u32);
        let bands = self.bands.len();
        let lengths: Vec<u64> = self.places.iter().flat_map(|p| &p[level]).map(|p| p.1).collect();
        let is_colour = bands >= 3
            && ["R", "G", "B"].iter().zip(&self.bands).all(|(name, band)| band.name == *name);
        let colours = if is_colour { 3 } else { 1 };
        let mut tags = Directory::default();
        let mut add = |tag: u16, values: Values| _ = tags.0.insert(tag, values);
        let short = |value: u16| Values::Short(vec![value]);
        let long = |value: u32| Values::Long(vec![value]);
        add(254, long(u32::from(level > 0))); // NewSubfileType: 1 is an overview
        add(256, long(cols));
        add(257, long(rows));
        add(258, Values::Short(vec![32; bands])); // BitsPerSample
        add(259, short(8)); // Compression: deflate
        add(262, short(if is_colour { 2 } else { 1 })); // Photometric: RGB, or 0 is black
        add(277, short(bands as u16)); // SamplesPerPixel
        add(284, short(if bands > 1 { 2 } else { 1 })); // PlanarConfiguration: separate
        add(317, short(3)); // Predictor: floating point
        add(322, long(width));
        add(323, long(height));
        add(324, Values::Offset(vec![0; lengths.len()])); // TileOffsets
        add(325, Values::Offset(lengths)); // TileByteCounts
        if bands > colours {
            add(338, Values::Short(vec![0; bands - colours])); // ExtraSamples: unspecified
        }
        add(339, Values::Short(vec![3; bands])); // SampleFormat: floats
        add(42113, Values::Ascii("nan".into())); // GDAL_NODATA
        if level > 0 {
            return tags;
        }
        add(305, Values::Ascii(format!("Ridgelight {}", env!("CARGO_PKG_VERSION")))); // Software
        add(42112, Values::Ascii(gdal_metadata(&self.bands, metadata)));
        if let Some(georeference) = &self.georeference {
            let [width, height] = georeference.cell;
            let [east, north] = georeference.origin();
            add(33550, Values::Double(vec![width, height, 0.0])); // ModelPixelScale
            add(33922, Values::Double(vec![0.0, 0.0, 0.0, east, north, 0.0])); // ModelTiepoint
            let keys = georeference.keys.horizontal();
            if !keys.entries.is_empty() {
                let head = [[1, 1, 0, keys.entries.len() as u16]];
                add(34735, Values::Short([&head, keys.entries.as_slice()].concat().concat()));
            }
            if !keys.entries.is_empty() && !keys.doubles.is_empty() {
                add(34736, Values::Double(keys.doubles));
            }
            if !keys.entries.is_empty() && !keys.ascii.is_empty() {
                add(34737, Values::Ascii(keys.ascii));
            }
        }
        tags
    }
}

/// Whether a file must be a BigTIFF; `bytes` is its length as a classic TIFF. All offsets of a file of 2^32 bytes fit in 32 bits, but its
/// last tile ends at 2^32, and readers may store that end in 32 bits.
fn needs_64_bits(bytes: u64) -> bool {
    bytes > u64::from(u32::MAX)
}

/// GDAL's metadata (tag 42112): settings of the file, and the name and unit of each band.
fn gdal_metadata(bands: &[Band], metadata: &[(String, String)]) -> String {
    let mut xml = String::from("<GDALMetadata>\n");
    for (name, text) in metadata {
        xml += &format!("  <Item name=\"{}\">{}</Item>\n", escaped(name), escaped(text));
    }
    for (i, band) in bands.iter().enumerate() {
        let roles =
            [("DESCRIPTION", "description", &band.name), ("UNITTYPE", "unittype", &band.unit)];
        for (name, role, text) in roles.into_iter().filter(|(_, _, text)| !text.is_empty()) {
            let text = escaped(text);
            xml +=
                &format!("  <Item name=\"{name}\" sample=\"{i}\" role=\"{role}\">{text}</Item>\n");
        }
    }
    xml + "</GDALMetadata>\n"
}

/// Text in XML, which cannot hold control characters.
fn escaped(text: &str) -> String {
    let mut all = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => all += "&amp;",
            '<' => all += "&lt;",
            '>' => all += "&gt;",
            '"' => all += "&quot;",
            c if c.is_control() => all.push(' '),
            c => all.push(c),
        }
    }
    all
}

#[cfg(test)]
mod tests;
