//! A map's files. Values go to all of them layer by layer.

mod entry;
mod textures;

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use ridgelight::Result;
use ridgelight::scene::HeightField;
use ridgelight_bake::Encoding;
use ridgelight_io as files;
use ridgelight_io::{
    Block, Component, DdsWriter, GeoTiffWriter, Georeference, Ktx2Writer, NpyWriter, TexelFormat,
    Texels, Written,
};
use serde_json::Value as Json;

use super::kinds::{Kind, Map};
use textures::Measured;

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Exr,
    Png,
    Npy,
    Ktx2,
    Tif,
    Dds,
}

impl Format {
    pub fn name(self) -> &'static str {
        ["exr", "png", "npy", "ktx2", "tif", "dds"][self as usize]
    }

    /// Whether it holds packed texels for a device.
    pub fn is_texture(self) -> bool {
        matches!(self, Format::Ktx2 | Format::Dds)
    }

    /// Whether it holds the values packed by `--encoding`, not the values themselves.
    pub fn is_packed(self) -> bool {
        self.is_texture() || self == Format::Png
    }

    /// Whether it can hold the encoded kind.
    pub fn takes(self, kind: &Kind, encoding: &Encoding) -> bool {
        let is_picture = encoding.component.is_normalised() && encoding.components < 4;
        self != Format::Png || is_picture || kind.is_scaled()
    }
}

/// A requested kind, its encoding and its formats.
pub struct Wanted {
    pub kind: &'static Kind,
    pub encoding: &'static Encoding,
    pub formats: Vec<Format>,
    /// The block compression of its textures.
    pub block: Option<Block>,
    /// Whether its textures have all mip levels.
    pub has_mips: bool,
}

impl Wanted {
    pub fn layers(&self, map: &Map) -> usize {
        map.planes.len().div_ceil(self.encoding.values)
    }

    /// Whether the manifest's entry of such a file names its planes: a picture holds some of them, and layers of a
    /// texture of horizons are counter-clockwise from east.
    pub fn names_planes(&self, format: Format) -> bool {
        format == Format::Png || format.is_texture() && self.kind.is_of_azimuths()
    }

    /// What its textures hold.
    fn stored(&self) -> Texels {
        self.block.map_or(Texels::Plain(self.texels()), Texels::Blocks)
    }

    /// Sizes of the mip levels of its textures.
    fn level_sizes(&self, size: [usize; 2]) -> Vec<[usize; 2]> {
        let last = size[0].max(size[1]).ilog2() as usize;
        let last = if self.has_mips { last } else { 0 };
        (0..=last).map(|level| size.map(|n| (n >> level).max(1))).collect()
    }

    /// Bytes of all mip levels of a layer of its textures.
    fn layer_bytes(&self, size: [usize; 2]) -> u64 {
        let images = self.level_sizes(size).into_iter();
        let images = images.map(|size| self.stored().image_bytes(size).unwrap_or(u64::MAX));
        images.fold(0, u64::saturating_add)
    }

    fn texels(&self) -> TexelFormat {
        // Three components become four: devices need not sample three-component textures.
        let count = self.encoding.components;
        let count = if count == 3 { 4 } else { count };
        TexelFormat { component: self.encoding.component, count }
    }

    /// The file name of a format; of a layer's picture in PNG.
    fn file(&self, map: &Map, format: Format, layer: usize) -> String {
        let (stem, end) = (self.kind.stem(), format.name());
        let is_layer = map.is_array && format == Format::Png;
        if is_layer { format!("{stem}_{layer:04}.{end}") } else { format!("{stem}.{end}") }
    }

    /// Every file and an upper bound of its bytes.
    pub fn files(&self, map: &Map, field: [usize; 2]) -> Vec<(String, u64)> {
        let size = map.size.unwrap_or(field);
        let (layers, grid_points) = (self.layers(map), (size[0] * size[1]) as u64);
        let (values, texel) =
            (4 * map.planes.len() as u64 * grid_points, self.texels().bytes() as u64);
        // ZIP adds little to incompressible data.
        let zipped = |bytes: u64| bytes / 100 * 101 + 65_536;
        let of = |format: &Format| match format {
            Format::Exr => (1, zipped(values)),
            // With overviews, each a quarter of the one before.
            Format::Tif => (1, zipped(values / 3 * 4)),
            Format::Npy => (1, values + 256),
            Format::Ktx2 | Format::Dds => {
                // Texts and, of a .ktx2, the places of the levels and the gaps before them.
                let head = 1024 + 64 * self.level_sizes(size).len() as u64;
                let layer = self.layer_bytes(size);
                (1, layer.saturating_mul(layers as u64).saturating_add(head))
            }
            Format::Png => (layers, zipped((texel + 2) * grid_points)),
        };
        let all = self.formats.iter().flat_map(|format| {
            let (count, bytes) = of(format);
            (0..count).map(move |k| (self.file(map, *format, k), bytes))
        });
        let decoder = (format!("{}.glsl", self.kind.stem()), self.decoder(map).len() as u64);
        all.chain([decoder]).collect()
    }

    /// Bytes that the files hold before they are written; formats that stream hold one layer.
    pub fn held_bytes(&self, map: &Map, field: [usize; 2]) -> u64 {
        let size = map.size.unwrap_or(field);
        let texel = self.texels().bytes();
        let of = |format: &Format| match format {
            Format::Exr => 4 * map.planes.len(),
            // Pixels, and the compressed copy.
            Format::Png => 2 * (texel + 2),
            // A plane without voids.
            Format::Npy => 4,
            // Both have the same texels, counted below.
            Format::Ktx2 | Format::Dds => 0,
            // A plane and its overviews, and their compressed copies.
            Format::Tif => 12,
        };
        let of_texels = (size[0] * size[1] * self.formats.iter().map(of).sum::<usize>()) as u64;
        if !self.formats.iter().any(|format| format.is_texture()) {
            return of_texels;
        }
        (of_texels + self.coding_bytes(size)).saturating_add(self.layer_bytes(size))
    }

    /// GLSL: comments on what it does not read, the constants, then the decoder.
    fn decoder(&self, map: &Map) -> String {
        let constants: String = map.constants.iter().map(|line| format!("{line}\n")).collect();
        let mut other_files = String::new();
        if self.formats.iter().any(|f| matches!(f, Format::Exr | Format::Npy | Format::Tif)) {
            other_files +=
                "// .exr, .npy and .tif hold the values themselves and need no decoder.\n";
        }
        let component = self.encoding.component;
        if component.is_normalised() && component.is_signed() && self.formats.contains(&Format::Png)
        {
            other_files += "// A .png cannot hold values below 0: of its v, 0 to 1, pass 2v - 1.\n";
        }
        other_files + &constants + self.kind.decoder
    }
}

/// A file that takes all layers; a picture takes one.
enum Open {
    Exr(Vec<Vec<f32>>),
    Npy(NpyWriter),
    Ktx2(Ktx2Writer),
    Dds(DdsWriter),
    Tif(GeoTiffWriter),
    Png,
}

/// A finished file under a temporary name.
struct Waiting {
    file: Written,
    path: PathBuf,
    format: Format,
    /// Scale of a picture's values.
    scale: f64,
    /// Which of the map's planes it holds.
    planes: Range<usize>,
}

/// A map's files, invisible under their final names until [`place`](Self::place).
pub struct MapFiles<'a> {
    wanted: Wanted,
    map: Map,
    field: &'a HeightField,
    folder: PathBuf,
    texts: Vec<(String, String)>,
    open: Vec<Open>,
    waiting: Vec<Waiting>,
    taken: usize,
    /// The place of each plane in an .npy and a .tif.
    places: Vec<usize>,
    /// Count of values outside their stated range, and the largest excess.
    beyond: (u64, f64),
    /// Errors of compressed textures.
    measured: Measured,
    entries: Vec<(&'static str, Json)>,
    remarks: Vec<String>,
}

impl<'a> MapFiles<'a> {
    /// Opens all files.
    pub fn create(
        folder: &Path,
        (wanted, map): (Wanted, Map),
        field: &'a HeightField,
        hash: &str,
        georeference: Option<&Georeference>,
    ) -> Result<Self> {
        let size = map.size.unwrap_or([field.cols(), field.rows()]);
        let mut texts: Vec<(String, String)> = [
            ("ridgelight.kind", wanted.kind.name),
            ("ridgelight.encoding", wanted.encoding.name),
            ("ridgelight.decoding", wanted.encoding.decoding),
            ("ridgelight.field_hash", hash),
        ]
        .map(|(name, text)| (name.to_owned(), text.to_owned()))
        .into();
        if let Some(normals) = map.normals {
            texts.push(("ridgelight.normals".to_owned(), normals.axes()[0].to_owned()));
        }
        let open = wanted.formats.iter().map(|format| {
            let path = folder.join(wanted.file(&map, *format, 0));
            Ok(match format {
                Format::Exr => Open::Exr(Vec::new()),
                Format::Npy => {
                    let mut shape = vec![map.planes.len(), size[1], size[0]];
                    if map.planes.len() == 1 && !map.is_array {
                        shape.remove(0);
                    }
                    if !map.axes.is_empty() {
                        shape = map.axes.iter().map(|axis| axis.1).collect();
                    }
                    Open::Npy(NpyWriter::create(&path, &shape)?)
                }
                Format::Ktx2 => {
                    let layers = map.is_array.then(|| wanted.layers(&map));
                    let count = (layers, wanted.level_sizes(size).len());
                    let stored = wanted.stored();
                    Open::Ktx2(Ktx2Writer::with_levels(&path, stored, size, count, &texts)?)
                }
                Format::Dds => {
                    let count = (wanted.layers(&map), wanted.level_sizes(size).len());
                    Open::Dds(DdsWriter::create(&path, wanted.stored(), size, count)?)
                }
                Format::Tif => {
                    // A table's texels are no places.
                    let place = georeference.filter(|_| map.size.is_none()).cloned();
                    let bands = map.bands(wanted.kind);
                    Open::Tif(GeoTiffWriter::create(&path, [size[1], size[0]], bands, place)?)
                }
                Format::Png => Open::Png,
            })
        });
        Ok(Self {
            open: open.collect::<Result<_>>()?,
            places: map.places(wanted.kind),
            wanted,
            map,
            field,
            folder: folder.to_owned(),
            texts,
            waiting: Vec::new(),
            taken: 0,
            beyond: (0, 0.0),
            measured: Measured::default(),
            entries: Vec::new(),
            remarks: Vec::new(),
        })
    }

    pub fn kind(&self) -> &'static Kind {
        self.wanted.kind
    }

    /// Adds an entry to the kind's part of the manifest.
    pub fn add_entry(&mut self, name: &'static str, what: Json) {
        self.entries.push((name, what));
    }

    /// Adds a note for the terminal.
    pub fn remark(&mut self, what: String) {
        self.remarks.push(what);
    }

    /// The field's voids, if the map has its size.
    fn voids(&self) -> Option<&'a [bool]> {
        self.field.voids().filter(|_| self.map.size.is_none())
    }

    /// Columns and rows.
    fn size(&self) -> [usize; 2] {
        self.map.size.unwrap_or([self.field.cols(), self.field.rows()])
    }

    /// Takes all layers.
    pub fn take_all(&mut self, planes: &[Vec<f32>]) -> Result<()> {
        let planes: Vec<&[f32]> = planes.iter().map(Vec::as_slice).collect();
        planes.chunks(self.wanted.encoding.values).try_for_each(|layer| self.take(layer))
    }

    /// Takes a layer: as many planes as a texel has values, fewer in the last.
    pub fn take(&mut self, planes: &[&[f32]]) -> Result<()> {
        self.count_beyond(planes);
        let scale = if self.is_scaled() { self.largest(planes) } else { 1.0 };
        let levels = self.levels(planes);
        let picture = self.picture(planes, scale);
        let (voids, field) = (self.voids(), self.field);
        let masked = |plane: &&[f32]| match voids {
            Some(_) => crate::setup::masked(field, plane.to_vec()),
            None => plane.to_vec(),
        };
        let first = self.taken * self.wanted.encoding.values;
        let (size, form, texts) = (self.size(), self.picture_form(), self.picture_texts(scale));
        for open in &mut self.open {
            match open {
                Open::Exr(kept) => kept.extend(planes.iter().map(masked)),
                Open::Npy(writer) if self.wanted.kind.is_of_azimuths() => {
                    let mut own = self.places[first..].iter().zip(planes);
                    own.try_for_each(|(at, plane)| writer.write_plane(*at, &masked(plane)))?;
                }
                Open::Npy(writer) => {
                    planes.iter().try_for_each(|plane| writer.write(&masked(plane)))?;
                }
                Open::Ktx2(writer) => {
                    let mut own = levels.iter().enumerate();
                    own.try_for_each(|(level, texels)| writer.write_level(level, texels))?;
                }
                Open::Dds(writer) => levels.iter().try_for_each(|texels| writer.write(texels))?,
                Open::Tif(writer) => {
                    let mut own = self.places[first..].iter().zip(planes);
                    own.try_for_each(|(band, plane)| writer.write(*band, &masked(plane)))?;
                }
                Open::Png => {
                    let name = self.wanted.file(&self.map, Format::Png, self.taken);
                    let path = self.folder.join(name);
                    let file = files::write_codes_aside(&path, size, form, &picture, &texts)?;
                    let planes = first..first + planes.len();
                    self.waiting.push(Waiting { file, path, format: Format::Png, scale, planes });
                }
            }
        }
        self.taken += 1;
        Ok(())
    }

    /// Counts values outside their range.
    fn count_beyond(&mut self, planes: &[&[f32]]) {
        let (values, voids) = (&self.map.values, self.voids());
        let first = self.taken * self.wanted.encoding.values;
        for (at, plane) in planes.iter().enumerate() {
            let [low, high] = values[(first + at) % values.len()].range;
            // Allows f32 rounding, where π/2 is above the real one, and the device's function
            // errors. n terms summed one after another round by at most n half steps of the sum.
            let roundings = f64::from(self.map.roundings.max(8));
            let rounding = roundings * f64::from(f32::EPSILON) * low.abs().max(high.abs());
            for (i, value) in plane.iter().enumerate() {
                let beyond = (f64::from(*value) - high).max(low - f64::from(*value));
                if beyond > rounding && !voids.is_some_and(|v| v[i]) {
                    self.beyond = (self.beyond.0 + 1, self.beyond.1.max(beyond));
                }
            }
        }
    }

    fn has_textures(&self) -> bool {
        self.wanted.formats.iter().any(|format| format.is_texture())
    }

    fn has(&self, format: Format) -> bool {
        self.wanted.formats.contains(&format)
    }

    /// Whether its pictures store floats: 16 bits, scaled to each picture's largest value.
    fn is_scaled(&self) -> bool {
        self.has(Format::Png) && !self.wanted.encoding.component.is_normalised()
    }

    /// The component type of its pictures.
    fn picture_component(&self) -> Component {
        if self.is_scaled() { Component::Unorm16 } else { self.wanted.encoding.component }
    }

    /// Channels and bits of its pictures: components, and alpha where there are voids.
    fn picture_form(&self) -> (usize, u32) {
        let channels = self.wanted.encoding.components + usize::from(self.voids().is_some());
        (channels, 8 * self.picture_component().bytes() as u32)
    }

    /// Text metadata of its pictures.
    fn picture_texts(&self, scale: f64) -> Vec<(String, String)> {
        let mut texts = self.texts.clone();
        if self.is_scaled() {
            texts.retain(|(name, _)| name != "ridgelight.encoding");
            texts.push(("ridgelight.encoding".into(), "unorm16, times ridgelight.scale".into()));
            texts.push(("ridgelight.scale".into(), scale.to_string()));
        }
        texts
    }

    /// The largest finite value of a layer outside voids; 1 if none is positive.
    fn largest(&self, planes: &[&[f32]]) -> f64 {
        let voids = self.voids();
        let own = |plane: &&[f32]| {
            let all = plane.iter().enumerate().filter(|(i, _)| !voids.is_some_and(|v| v[*i]));
            all.map(|(_, v)| *v).filter(|v| v.is_finite()).fold(0.0, f32::max)
        };
        let largest = planes.iter().map(own).fold(0.0, f32::max);
        if largest > 0.0 { largest.into() } else { 1.0 }
    }

    /// The components of a texel from its values.
    fn encode(&self, values: &mut [f64], parts: &mut [f64]) {
        if let Some(normals) = self.map.normals {
            values[1] *= normals.y();
        }
        (self.wanted.encoding.encode)(values, parts);
    }

    /// A picture's pixels: signed components as (v + 1)/2, divided by `scale`, 16 bits big-endian.
    fn picture(&self, planes: &[&[f32]], scale: f64) -> Vec<u8> {
        let (encoding, voids, component) =
            (self.wanted.encoding, self.voids(), self.picture_component());
        if !self.has(Format::Png) {
            return Vec::new();
        }
        let (channels, bits) = self.picture_form();
        let pixel = channels * bits as usize / 8;
        let mut picture = Vec::with_capacity(pixel * self.size().iter().product::<usize>());
        let (mut values, mut parts) = ([0.0; 4], [0.0; 4]);
        let (values, parts) = (&mut values[..encoding.values], &mut parts[..encoding.components]);
        for at in 0..self.size().iter().product() {
            for (value, plane) in values.iter_mut().zip(planes) {
                *value = f64::from(plane[at]);
            }
            self.encode(values, parts);
            let is_void = voids.is_some_and(|v| v[at]);
            for part in parts.iter() {
                let part = part / scale;
                let part = if component.is_signed() { 0.5 + 0.5 * part } else { part };
                put(&mut picture, component, if is_void { 0.0 } else { part });
            }
            if voids.is_some() {
                put(&mut picture, component, if is_void { 0.0 } else { 1.0 });
            }
        }
        picture
    }
}

/// Appends a pixel value with as many bits as the component, 16 bits big-endian.
fn put(picture: &mut Vec<u8>, component: Component, value: f64) {
    match component.bytes() {
        1 => Component::Unorm8.put(value, picture),
        _ => picture.extend((Component::Unorm16.code(value) as u16).to_be_bytes()),
    }
}
