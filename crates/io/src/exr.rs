//! OpenEXR: reads any channel of any flat file; writes one part with f32 channels and ZIP.

mod attributes;
mod layer;

use crate::atomic::{Temporary, Written};
use crate::heights::{Raster, type_name};
use crate::open;
use ::exr::block::{self, UncompressedBlock, reader::ChunksReader, writer::ChunksWriter};
use ::exr::meta::attribute::{AttributeValue, ChannelDescription, LineOrder, SampleType, Text};
use ::exr::meta::{BlockDescription, MetaData, header::Header};
use ::exr::prelude::{Compression, Error as ExrError, Vec2};
use half::f16;
pub use layer::{Channels, Layer};
use ridgelight::{Error, Result};
use std::{collections::HashSet, io::Cursor, path::Path};

/// An opened file: its channels by name, before any pixel is decoded.
pub(crate) struct ExrFile<'a> {
    path: &'a Path,
    reader: block::reader::Reader<Cursor<&'a [u8]>>,
    /// Header (part), channel in it, full name: "direct.sky.R", prefixed by the part's name where
    /// there are several parts.
    channels: Vec<(usize, usize, String)>,
}

impl<'a> ExrFile<'a> {
    pub fn open(path: &'a Path, bytes: &'a [u8]) -> Result<Self> {
        let reader = block::read(Cursor::new(bytes), false).map_err(|e| {
            Error::file(path, "header", open::complaint(e), "a whole and valid OpenEXR file")
        })?;
        let headers = reader.headers();
        let mut channels = Vec::new();
        for (part, header) in headers.iter().enumerate() {
            check_claims(path, header, bytes.len())?;
            let prefix = match &header.own_attributes.layer_name {
                Some(name) if headers.len() > 1 => format!("{name}."),
                _ => String::new(),
            };
            for (i, channel) in header.channels.list.iter().enumerate() {
                let name = format!("{prefix}{}", channel.name);
                channels.push((part, i, name.chars().filter(|c| !c.is_control()).collect()));
            }
        }
        Ok(Self { path, reader, channels })
    }

    pub fn names(&self) -> Vec<&str> {
        self.channels.iter().map(|(_, _, name)| name.as_str()).collect()
    }

    /// The index of the channel with this name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.channels.iter().position(|(_, _, n)| n == name)
    }

    /// The first part's string attributes.
    fn texts(&self) -> Vec<(String, String)> {
        let attributes = self.reader.headers().iter().take(1).flat_map(|h| &h.own_attributes.other);
        attributes
            .filter_map(|(name, value)| match value {
                AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
                _ => None,
            })
            .collect()
    }

    /// The sample type of a channel.
    fn sample_type(&self, index: usize) -> SampleType {
        let (part, channel, _) = self.channels[index];
        self.reader.headers()[part].channels.list[channel].sample_type
    }

    /// Decodes the requested channels at full resolution: rows, columns and one plane each. Every
    /// sample type fits an f64, which `narrow` converts.
    pub fn planes<T: Copy + Default>(
        self,
        wanted: &[usize],
        narrow: impl Fn(f64) -> T,
    ) -> Result<(usize, usize, Vec<Vec<T>>)> {
        let Self { path, reader, channels } = self;
        let headers = reader.headers().to_vec();
        let Some(&first) = wanted.first() else {
            return Err(Error::file(path, "header", "no channels", "at least one"));
        };
        let layer_size = headers[channels[first].0].layer_size;
        for &i in wanted {
            let (part, channel, name) = &channels[i];
            let place = format!("channel {name}");
            if headers[*part].channels.list[*channel].sampling != Vec2(1, 1) {
                let found = "a sub-sampled channel";
                return Err(Error::file(path, place, found, "one sample a pixel"));
            }
            if headers[*part].layer_size != layer_size {
                let found = "another size than the first channel's";
                return Err(Error::file(path, place, found, "parts of one size"));
            }
        }
        let Vec2(cols, rows) = layer_size;
        let (rows, cols) = open::size(path, "header", rows as u64, cols as u64)?;
        let mut planes = vec![vec![T::default(); rows * cols]; wanted.len()];
        let plane_of = |part: usize, channel: usize| {
            wanted.iter().position(|&w| (channels[w].0, channels[w].1) == (part, channel))
        };
        let wrong = |e: ExrError| {
            Error::file(path, "image data", open::complaint(e), "blocks as the header describes")
        };
        let parts: HashSet<usize> = wanted.iter().map(|&w| channels[w].0).collect();
        let mut blocks = reader
            .filter_chunks(false, |_, _, block| {
                parts.contains(&block.layer) && block.level == Vec2(0, 0)
            })
            .map_err(wrong)?
            .sequential_decompressor(false);
        let mut found = HashSet::new();
        let mut filled = 0;
        while let Some(block) = blocks.decompress_next_block() {
            let block = block.map_err(wrong)?;
            let at = block.index;
            if !parts.contains(&at.layer) || at.level != Vec2(0, 0) {
                continue;
            }
            if !found.insert((at.layer, at.pixel_position.0, at.pixel_position.1)) {
                let found = format!("the block at row {} twice", at.pixel_position.1);
                return Err(Error::file(path, "image data", found, "every block once"));
            }
            let list = &headers[at.layer].channels;
            for line in block.lines(list) {
                let at = line.location;
                let Some(plane) = plane_of(at.layer, at.channel) else { continue };
                let start = at.position.1 * cols + at.position.0;
                let target =
                    planes[plane].get_mut(start..start + at.sample_count).ok_or_else(|| {
                        let found = format!("a block beyond row {}", at.position.1);
                        Error::file(path, "image data", found, "blocks inside the picture")
                    })?;
                unpack(line.value, list.list[at.channel].sample_type, target, &narrow);
                filled += at.sample_count;
            }
        }
        let needed = wanted.len() * rows * cols;
        if filled != needed {
            let found = format!("{filled} of {needed} samples");
            return Err(Error::file(path, "image data", found, "every block of the picture"));
        }
        Ok((rows, cols, planes))
    }
}

/// Samples of one line, in native byte order as the decoder leaves them.
fn unpack<T>(bytes: &[u8], kind: SampleType, target: &mut [T], narrow: &impl Fn(f64) -> T) {
    let (halves, words) = (bytes.as_chunks::<2>().0, bytes.as_chunks::<4>().0);
    for (i, t) in target.iter_mut().enumerate() {
        *t = narrow(match kind {
            SampleType::F16 => f16::from_ne_bytes(halves[i]).to_f64(),
            SampleType::F32 => f64::from(f32::from_ne_bytes(words[i])),
            SampleType::U32 => f64::from(u32::from_ne_bytes(words[i])),
        });
    }
}

/// Checks a part's claimed sizes against the file's size.
fn check_claims(path: &Path, header: &Header, held: usize) -> Result<()> {
    if header.deep {
        return Err(Error::file(path, "header", "deep data", "one sample a pixel"));
    }
    let Vec2(cols, rows) = header.layer_size;
    open::size(path, "header", rows as u64, cols as u64)?;
    // Each block has an entry of 8 bytes in the offset table and 8 of its own header.
    open::plausible(path, "header: blocks", 16 * header.chunk_count as u64, held, 1)?;
    let ratio = match header.compression {
        Compression::Uncompressed => 1,
        // Runs of 128 in two bytes.
        Compression::RLE => 64,
        // PXR24 keeps three bytes of four, then deflates.
        Compression::PXR24 => open::DEFLATE_RATIO * 4 / 3,
        Compression::ZIP1 | Compression::ZIP16 => open::DEFLATE_RATIO,
        // Wavelets of a constant compress blocks of up to 2 MiB to some 30 bytes.
        _ => 1 << 16,
    };
    let samples = rows as u64 * cols as u64;
    let bytes: u64 = header
        .channels
        .list
        .iter()
        .map(|c| {
            samples * c.sample_type.bytes_per_sample() as u64 / c.sampling.area().max(1) as u64
        })
        .sum();
    open::plausible(path, "header", bytes, held, ratio)
}

/// Heights from the only channel, or from the only one with a height's name.
pub(crate) fn heights(path: &Path, bytes: &[u8]) -> Result<Raster> {
    let file = ExrFile::open(path, bytes)?;
    let names = file.names();
    let Some(index) = height_channel(&names) else {
        let found = format!("the channels {}", names.join(", "));
        let expected = "one channel, or one called height, elevation, Z, Y or R that is no part of a colour or vector";
        return Err(Error::file(path, "header", found, expected));
    };
    let sample_type = file.sample_type(index);
    let single = sample_type != SampleType::U32;
    let bits = 8 * sample_type.bytes_per_sample();
    let data_type = type_name(if single { b'f' } else { b'u' }, bits);
    let (rows, cols, mut planes) = file.planes(&[index], |v| v)?;
    Ok(Raster { data_type, single, ..Raster::bare(rows, cols, planes.swap_remove(0)) })
}

/// R beside G or B is red, Y beside RY or BY a luminance, and any name beside X a vector's
/// component: none of these is a height.
fn height_channel(names: &[&str]) -> Option<usize> {
    let has = |all: &[&str]| all.iter().any(|n| names.contains(n));
    let is_height = |name: &str| match name {
        "height" | "heights" | "elevation" => true,
        "Z" => !has(&["X"]),
        "Y" | "R" => !has(&["X", "G", "B", "RY", "BY"]),
        _ => false,
    };
    match (names, names.iter().filter(|name| is_height(name)).count()) {
        ([_], _) => Some(0),
        (_, 1) => names.iter().position(|name| is_height(name)),
        _ => None,
    }
}

/// Colour in linear light from R, G and B, or grey from Y or the only channel.
pub(crate) fn colour(path: &Path, bytes: &[u8]) -> Result<(usize, usize, Vec<[f32; 3]>)> {
    let file = ExrFile::open(path, bytes)?;
    let names = file.names();
    let wanted = match ["R", "G", "B"].map(|n| file.find(n)) {
        [Some(r), Some(g), Some(b)] => vec![r, g, b],
        _ => match file.find("Y") {
            Some(y) => vec![y],
            None if names.len() == 1 => vec![0],
            None => {
                let found = format!("the channels {}", names.join(", "));
                return Err(Error::file(path, "header", found, "R, G and B, or Y"));
            }
        },
    };
    let (rows, cols, planes) = file.planes(&wanted, |v| v as f32)?;
    let last = planes.len() - 1;
    let texel = |i: usize| [planes[0][i], planes[1.min(last)][i], planes[last][i]];
    Ok((rows, cols, (0..rows * cols).map(texel).collect()))
}

/// The file's string attributes, in no order: what [`write_exr`] received as `metadata`.
///
/// # Errors
/// A file that cannot be read or is no OpenEXR file.
pub fn read_metadata(path: &Path) -> Result<Vec<(String, String)>> {
    Ok(ExrFile::open(path, &open::read(path)?)?.texts())
}

/// Writes all layers as channels of one part, f32, ZIP-compressed, so that every viewer opens it.
///
/// `metadata` becomes string attributes of the file, in UTF-8.
///
/// # Errors
/// Layers that are not `rows`·`cols`, duplicate channels or attributes, names that OpenEXR does not
/// allow (empty, over 255 bytes, or reserved for another type), a destination that cannot be
/// written.
pub fn write_exr(
    path: &Path,
    rows: usize,
    cols: usize,
    layers: &[Layer],
    metadata: &[(String, String)],
) -> Result<()> {
    write_exr_aside(path, rows, cols, layers, metadata)?.place()
}

/// [`write_exr`], but the file waits beside its destination.
///
/// # Errors
/// As [`write_exr`].
pub fn write_exr_aside(
    path: &Path,
    rows: usize,
    cols: usize,
    layers: &[Layer],
    metadata: &[(String, String)],
) -> Result<Written> {
    let count = rows.checked_mul(cols).filter(|n| *n > 0);
    let mut columns = Vec::new();
    for layer in layers {
        if Some(layer.channels.len()) != count {
            let found = format!("{} pixels for {rows} × {cols}", layer.channels.len());
            let place = format!("layer \"{}\"", layer.name);
            return Err(Error::setting(place, found, "rows × columns pixels"));
        }
        let full = |name: &str| layer.channel(name);
        match layer.channels {
            Channels::Rgb(_) => {
                columns
                    .extend(["R", "G", "B"].iter().enumerate().map(|(i, n)| (full(n), layer, i)));
            }
            Channels::Scalar(name, _) => columns.push((full(name), layer, 0)),
        }
    }
    // OpenEXR stores channels in the order of their names.
    columns.sort_by(|a, b| a.0.as_bytes().cmp(b.0.as_bytes()));
    let header = header(rows, cols, &columns, metadata)?;

    let mut file = Temporary::create(path)?;
    let wrong = |e: ExrError| match e {
        ExrError::Io(e) => Error::io(path, e),
        other => Error::file(path, "header", open::complaint(other), "what OpenEXR can hold"),
    };
    block::write(file.stream(), [header].into_iter().collect(), true, |meta, chunks| {
        let headers = meta.headers.clone();
        let blocks = block::enumerate_ordered_header_block_indices(&headers).map(|(i, at)| {
            let block = UncompressedBlock::from_lines(&headers[0].channels, at, |line| {
                let (_, layer, component) = &columns[line.location.channel];
                let start = line.location.position.1 * cols + line.location.position.0;
                let range = start..start + line.location.sample_count;
                let targets = line.value.as_chunks_mut::<4>().0;
                match layer.channels {
                    Channels::Rgb(texels) => targets
                        .iter_mut()
                        .zip(&texels[range])
                        .for_each(|(t, v)| *t = v[*component].to_ne_bytes()),
                    Channels::Scalar(_, values) => targets
                        .iter_mut()
                        .zip(&values[range])
                        .for_each(|(t, v)| *t = v.to_ne_bytes()),
                }
            });
            (i, block)
        });
        chunks.on_progress(|_| ()).compress_all_blocks_parallel(&meta, blocks)
    })
    .map_err(wrong)?;
    // An attribute with a reserved name and the wrong type would make the file unreadable, so the
    // file is read back first.
    std::io::Write::flush(file.stream()).map_err(|e| Error::io(path, e))?;
    attributes::sort(file.stream().get_mut()).map_err(|e| Error::io(path, e))?;
    MetaData::read_from_file(file.name(), true).map_err(wrong)?;
    file.close()
}

fn header(
    rows: usize,
    cols: usize,
    columns: &[(String, &Layer, usize)],
    metadata: &[(String, String)],
) -> Result<Header> {
    let mut names = HashSet::new();
    let mut text = |place: &str, name: &str| {
        if !(1..=255).contains(&name.len()) || name.contains('\0') || !names.insert(name.to_owned())
        {
            let found = format!("the name \"{name}\"");
            return Err(Error::setting(place, found, "distinct names of 1 to 255 bytes"));
        }
        Ok(Text::from_slice_unchecked(name.as_bytes()))
    };
    let channels = columns
        .iter()
        .map(|(name, _, _)| Ok(ChannelDescription::named(text("channel", name)?, SampleType::F32)))
        .collect::<Result<_>>()?;
    let mut header = Header::new(Text::from_slice_unchecked(b"main"), Vec2(cols, rows), channels)
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing);
    header.own_attributes.layer_name = None;
    for (name, value) in metadata {
        let value = AttributeValue::Text(Text::from_slice_unchecked(value.as_bytes()));
        header.own_attributes.other.insert(text("metadata", name)?, value);
    }
    Ok(header)
}
