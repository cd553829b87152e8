//! TIFF heights: one band of any integer or float type; [`geotiff`] reads its position.

use crate::heights::mosaic::{Choose, Window, size_of_part};
use crate::heights::raw::Raw;
use crate::heights::sidecar::Sidecar;
use crate::heights::{Raster, geotiff, lzw, type_name};
use crate::open;
use half::f16;
use ridgelight::{Error, Result};
use std::ops::Range;
use std::path::Path;
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::{ByteOrder, Tag};
use tiff::{ColorType, TiffError};

pub(crate) type Tiff<'a> = Decoder<Raw<'a>>;

/// The first image of a file: strips or tiles, uncompressed, PackBits, LZW, DEFLATE or Zstandard, with
/// any predictor; bands interleaved or one after the other.
pub(crate) struct Image<'a> {
    path: &'a Path,
    pub tiff: Tiff<'a>,
    pub rows: usize,
    pub cols: usize,
    pub bands: usize,
    bits: u8,
    color: ColorType,
    /// Whether each chunk holds samples of one band.
    is_planar: bool,
    /// The file, and the compression by its TIFF number.
    bytes: &'a [u8],
    method: u16,
    /// Interleaved in a strip or tile; the decoder of `tiff` leaves out those behind a colour.
    samples: usize,
    /// Rows and columns of a strip or tile, a strip cut to the image.
    chunk: [usize; 2],
    /// Bytes of its samples.
    chunk_bytes: u64,
    /// Bytes of all samples of a texel.
    texel_bytes: u64,
    /// Of strips and tiles; tags are read before.
    limits: Limits,
    /// Rows and columns to read.
    window: [Range<usize>; 2],
}

impl<'a> Image<'a> {
    /// The header, whose claims are checked against the file's size.
    pub fn open(path: &'a Path, bytes: &'a [u8]) -> Result<Self> {
        let header = |e: TiffError| Error::file(path, "header", open::complaint(e), "a whole TIFF");
        let mut tiff = Decoder::new(Raw::new(bytes)).map_err(header)?;
        let (width, height) = tiff.dimensions().map_err(header)?;
        let (rows, cols) = (height as usize, width as usize);
        let color = tiff.colortype().map_err(header)?;
        let bits = color.bit_depth();
        if ![8, 16, 32, 64].contains(&bits) {
            let found = format!("{bits} bits a sample");
            let expected = "8, 16, 32 or 64 bits; `gdal_translate -ot Float32 -co NBITS=32` writes such a file";
            return Err(Error::file(path, "header", found, expected));
        }
        let mut number = |tag: Tag| tiff.find_tag_unsigned::<u16>(tag).map_err(header);
        let is_planar = number(Tag::PlanarConfiguration)? == Some(2);
        let method = number(Tag::Compression)?.unwrap_or(1);
        let all = number(Tag::SamplesPerPixel)?.unwrap_or(1);
        if let Some(name) = unreadable(method) {
            let found = format!("{name} (compression {method})");
            let expected = "no compression, PackBits, LZW, DEFLATE or Zstandard; `gdal_translate -co COMPRESS=DEFLATE` writes such a file";
            return Err(Error::file(path, "header", found, expected));
        }
        let texel_bytes = u64::from(bits / 8) * u64::from(all);
        // The decoder leaves out interleaved samples behind those of a colour.
        let bands = usize::from(if is_planar { all } else { color.num_samples() });
        let samples = if is_planar {
            1
        } else if method == LZW {
            usize::from(all)
        } else {
            bands
        };
        let (width, height) = tiff.chunk_dimensions();
        let chunk = match tiff.get_chunk_type() {
            // One strip of the whole image may have any number of rows (TIFF 6.0, RowsPerStrip).
            ChunkType::Strip => [rows.min(height as usize), cols],
            ChunkType::Tile => {
                let (rows, cols) = open::size(path, "tile size", height.into(), width.into())?;
                [rows, cols]
            }
        };
        let interleaved = if is_planar { 1 } else { u64::from(all) };
        let chunk_texels = chunk[0] as u64 * chunk[1] as u64;
        let chunk_bytes = chunk_texels.saturating_mul(u64::from(bits / 8) * interleaved);
        let mut limits = Limits::default();
        limits.decoding_buffer_size = usize::try_from(chunk_bytes).unwrap_or(usize::MAX);
        // A compressed strip or tile is part of the file.
        limits.intermediate_buffer_size = bytes.len();
        Ok(Self {
            path,
            tiff,
            rows,
            cols,
            bands,
            bits,
            color,
            is_planar,
            bytes,
            method,
            samples,
            chunk,
            chunk_bytes,
            texel_bytes,
            limits,
            window: [0..rows, 0..cols],
        })
    }

    /// Reads only some rows and columns.
    fn within(self, window: [Range<usize>; 2]) -> Self {
        Self { window, ..self }
    }

    /// The values of some bands in the window, and whether they are 16- or 32-bit floats. Strips and tiles that the
    /// file leaves out have no bytes and hold `empty` (GDAL's SPARSE_OK: gdal.org/drivers/raster/gtiff.html, "Sparse files").
    pub fn read<T: Copy + Default>(
        self,
        bands: Range<usize>,
        empty: f64,
        of: impl Fn(f64) -> T,
    ) -> Result<(Vec<Vec<T>>, bool)> {
        let (path, rows, cols) = (self.path, self.rows, self.cols);
        let [lines, columns] = [0, 1].map(|axis| self.window[axis].len());
        size_of_part(path, "header", [lines, columns])?;
        let claimed = (lines * columns) as u64 * self.texel_bytes;
        let held = self.bytes.len();
        let wrong = |found: String| {
            Error::file(path, "image data", found, "values as the header describes")
        };
        let decoded = |e: TiffError| wrong(open::complaint(e));
        let mut tiff = self.tiff;
        let [lengths, offsets] = match tiff.get_chunk_type() {
            ChunkType::Strip => [Tag::StripByteCounts, Tag::StripOffsets],
            ChunkType::Tile => [Tag::TileByteCounts, Tag::TileOffsets],
        };
        let mut words = |tag: Tag| -> Result<Vec<u64>> {
            Ok(tiff.find_tag_unsigned_vec(tag).map_err(decoded)?.unwrap_or_default())
        };
        if let Err(error) = open::plausible(path, "header", claimed, held, ratio(self.method)) {
            match words(lengths).map(|lengths| lengths.contains(&0)) {
                // A whole file may be short where GDAL left out tiles, which have no bytes.
                Ok(true) => open::plausible(path, "header", claimed, held, SPARSE_RATIO)?,
                Ok(false) if self.method == 1 => {
                    let found = format!(
                        "a file that is cut off: {claimed} bytes of values in a file of {held} bytes"
                    );
                    return Err(Error::file(path, "file size", found, "a whole TIFF"));
                }
                _ => return Err(error),
            }
        }
        let (lengths, offsets) = (words(lengths)?, words(offsets)?);
        let format = words(Tag::SampleFormat)?.first().map_or(1, |f| *f as u16);
        let predictor = words(Tag::Predictor)?.first().map_or(1, |p| *p as u16);
        let is_big_endian = tiff.byte_order() == ByteOrder::BigEndian;
        let mut tiff = tiff.with_limits(self.limits);
        let is_empty = |index: u32| lengths.get(index as usize) == Some(&0);
        let [height, width] = self.chunk;
        // `tiff` and the LZW decoder hold a chunk as packed bytes, as bytes and as samples.
        open::room(path, self.chunk_bytes.saturating_mul(3))?;
        let across = cols.div_ceil(width);
        let a_plane = across.saturating_mul(rows.div_ceil(height));
        let zeros = |_| open::zeros::<T>(path, lines * columns);
        let mut planes = bands.clone().map(zeros).collect::<Result<Vec<_>>>()?;
        let mut single = false;
        let parts = if self.is_planar { bands.clone() } else { 0..1 };
        // Strips or tiles that meet the window, by their place along an axis.
        let within = |axis: usize| {
            let Range { start, end } = self.window[axis];
            start / self.chunk[axis]..end.div_ceil(self.chunk[axis])
        };
        let chunks = within(0).flat_map(|down| within(1).map(move |along| [down, along]));
        for (part, [down, along]) in parts.flat_map(|p| chunks.clone().map(move |c| (p, c))) {
            let chunk = down * across + along;
            let index = part.checked_mul(a_plane).and_then(|first| first.checked_add(chunk));
            let index = index.and_then(|index| u32::try_from(index).ok());
            let index = index.ok_or_else(|| wrong("more than 2^32 strips or tiles".into()))?;
            let corner = [down * height, along * width];
            let (inside, lines) = tiff.chunk_data_dimensions(index);
            let lines = (lines as usize).min(rows - corner[0]);
            let target = Target { corner, inside: inside as usize, lines, window: &self.window };
            let (first, stride) = if self.is_planar { (0, 1) } else { (bands.start, self.samples) };
            let planes = match self.is_planar {
                true => &mut planes[part - bands.start..][..1],
                false => &mut planes[..],
            };
            if is_empty(index) {
                planes.iter_mut().for_each(|plane| target.fill(plane, of(empty)));
                continue;
            }
            // A tile that GDAL leaves out has no bytes, whatever its size.
            let claimed = self.chunk_bytes / height as u64 * lines as u64;
            let held = lengths.get(index as usize).map_or(0, |n| *n as usize);
            open::plausible(path, "a strip or tile", claimed, held, ratio(self.method))?;
            let values = if self.method == LZW {
                let layout = lzw::Layout {
                    width,
                    inside: [target.inside, target.lines],
                    samples: self.samples,
                    bits: self.bits,
                    format,
                    predictor,
                    is_big_endian,
                };
                let at = |all: &[u64]| usize::try_from(*all.get(index as usize)?).ok();
                let chunk = at(&offsets).zip(at(&lengths)).and_then(|(offset, length)| {
                    self.bytes.get(offset..offset.checked_add(length)?)
                });
                let chunk = chunk.ok_or_else(|| wrong("a strip or tile beyond the file".into()))?;
                let needed = layout.needed().ok_or_else(|| wrong("a huge strip or tile".into()))?;
                layout.decode(chunk, open::zeros(path, needed)?).map_err(wrong)?
            } else {
                tiff.read_chunk(index).map_err(decoded)?
            };
            single = matches!(values, DecodingResult::F16(_) | DecodingResult::F32(_));
            let needed = target.inside * target.lines * stride;
            for (plane, first) in planes.iter_mut().zip(first..) {
                let set = |i, value| target.set(plane, i, of(value));
                let count = each(&values, first, stride, set);
                if count < needed {
                    let found = format!("{count} values in a strip or tile of {needed}");
                    return Err(wrong(found));
                }
            }
        }
        Ok((planes, single))
    }

    /// The name of the type of its values; unsigned integers are TIFF's default.
    fn type_name(&mut self) -> String {
        let formats: Option<Vec<u64>> =
            self.tiff.find_tag_unsigned_vec(Tag::SampleFormat).ok().flatten();
        let kind = match formats.and_then(|all| all.first().copied()) {
            Some(2) => b'i',
            Some(3) => b'f',
            _ => b'u',
        };
        type_name(kind, self.bits.into())
    }

    /// The index of the band that holds the heights, and a note where it was not requested.
    fn band(&mut self, wanted: Option<u32>) -> Result<(usize, Option<String>)> {
        let bands = self.bands;
        let is_colour = !matches!(
            self.color,
            ColorType::Gray(_) | ColorType::GrayA(_) | ColorType::Multiband { .. }
        );
        match wanted {
            Some(band) if (1..=bands).contains(&(band as usize)) => Ok((band as usize - 1, None)),
            Some(band) => Err(no_band(self.path, band, bands)),
            None if is_colour => {
                let found = format!("{bands} colour channels ({:?})", self.color);
                let expected = "one band of heights, or a choice by `band`";
                Err(Error::file(self.path, "header", found, expected))
            }
            None if bands == 1 => Ok((0, None)),
            None => {
                let name = geotiff::band_name(self.path, &mut self.tiff, 0)?;
                let name = name.map(|name| format!(" ({name})")).unwrap_or_default();
                let note = format!("heights are band 1{name} of {bands}; `band` chooses another");
                Ok((0, Some(note)))
            }
        }
    }
}

/// The number of a compression in TIFFs.
const LZW: u16 = 5;

/// The error of a band that a file lacks; bands count from 1.
pub(crate) fn no_band(path: &Path, band: u32, bands: usize) -> Error {
    let bands = if bands == 1 { "1 band".to_owned() } else { format!("{bands} bands") };
    Error::file(path, "header", bands, format!("a band {band}, which `band` requests"))
}

/// The heights of a band in a window; strips and tiles outside it are not decoded. The position is that of the file.
pub(super) fn heights(
    path: &Path,
    bytes: &[u8],
    wanted: Option<u32>,
    sidecar: Sidecar,
    choose: Choose,
) -> Result<(Raster, Window)> {
    let mut image = Image::open(path, bytes)?;
    let (band, note) = image.band(wanted)?;
    let (rows, cols) = (image.rows, image.cols);
    let mut raster = Raster {
        data_type: image.type_name(),
        is_8_bit: image.bits == 8,
        notes: note.into_iter().collect(),
        warnings: mask_warning(path, bytes).into_iter().collect(),
        ..Raster::bare(rows, cols, Vec::new())
    };
    geotiff::read(path, &mut image.tiff, band, &mut raster)?;
    let empty = raster.nodata.unwrap_or(0.0);
    sidecar.complete(&mut raster);
    let window = choose(raster.georeference.as_ref(), [rows, cols])?;
    if !window.is_empty() {
        let image = image.within([window.rows.clone(), window.cols.clone()]);
        let (mut planes, single) = image.read(band..band + 1, empty, |value| value)?;
        (raster.values, raster.single) = (planes.swap_remove(0), single);
    }
    Ok((raster, window))
}

/// A compression that is not read, by its TIFF number.
fn unreadable(method: u16) -> Option<&'static str> {
    match method {
        1 | LZW | 8 | 32946 | 32773 | 50000 => None,
        6 | 7 => Some("JPEG"),
        34712 => Some("JPEG 2000"),
        34887 => Some("LERC"),
        34925 => Some("LZMA"),
        50001 => Some("WebP"),
        50002 => Some("JPEG XL"),
        _ => Some("an unknown compression"),
    }
}

/// A warning where the file has a mask of valid texels, which is not read: an alpha band; a mask in a later directory, or in a
/// file beside it, as GDAL writes them.
fn mask_warning(path: &Path, bytes: &[u8]) -> Option<String> {
    const IS_MASK: u32 = 4;
    // Beside a packed file lies the mask of the file in it.
    let path = match path.parent().filter(|packed| packed.is_file()) {
        Some(packed) => &packed.with_file_name(path.file_name().unwrap_or_default()),
        None => path,
    };
    let mut beside = path.as_os_str().to_owned();
    beside.push(".msk");
    let has_mask = || {
        let mut tiff = Decoder::new(Raw::new(bytes)).ok()?;
        while tiff.more_images() {
            tiff.next_image().ok()?;
            let kind = tiff.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten();
            if kind.is_some_and(|kind| kind & IS_MASK != 0) {
                return Some(());
            }
        }
        None
    };
    let has_alpha = || {
        let mut tiff = Decoder::new(Raw::new(bytes)).ok()?;
        let kinds = tiff.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples).ok()??;
        // Associated and unassociated alpha.
        kinds.iter().any(|kind| [1, 2].contains(kind)).then_some(())
    };
    let what = if has_alpha().is_some() {
        "alpha band"
    } else if has_mask().is_some() || Path::new(&beside).exists() {
        "mask"
    } else {
        return None;
    };
    Some(format!(
        "the {what} of this file is not read, so all its heights are used; `gdalwarp -dstnodata -9999 in.tif out.tif` turns \
         masked heights into voids"
    ))
}

/// Where the values of a strip or tile belong in a plane.
struct Target<'a> {
    /// Row and column of its first value.
    corner: [usize; 2],
    /// Columns and rows of it inside the image.
    inside: usize,
    lines: usize,
    /// Rows and columns of the plane.
    window: &'a [Range<usize>; 2],
}

impl Target<'_> {
    /// Sets its value number `i` if the plane has it; those below the image are padding.
    fn set<T>(&self, plane: &mut [T], i: usize, value: T) {
        let (line, col) = (i / self.inside, i % self.inside);
        let [row, col] = [self.corner[0] + line, self.corner[1] + col];
        let [rows, cols] = self.window;
        if line < self.lines && rows.contains(&row) && cols.contains(&col) {
            plane[(row - rows.start) * cols.len() + col - cols.start] = value;
        }
    }

    fn fill<T: Copy>(&self, plane: &mut [T], value: T) {
        (0..self.inside * self.lines).for_each(|i| self.set(plane, i, value));
    }
}

/// The greatest expansion of a file without some of its strips or tiles: it has at least 1/1032 of the bytes of its values.
const SPARSE_RATIO: u64 = open::DEFLATE_RATIO;

/// The greatest expansion of a compression method, by its TIFF number.
fn ratio(method: u16) -> u64 {
    match method {
        1 => 1,
        8 | 32946 => open::DEFLATE_RATIO,
        // PackBits: a run of 128 in two bytes. LZW: 12-bit codes for strings below 4096 bytes.
        32773 => 64,
        // Zstandard: a block of 128 KiB of one byte in 4 bytes (RFC 8878, §3.1.1.2).
        50000 => (128 << 10) / 4,
        _ => 4096 * 8 / 12,
    }
}

/// Calls `take` with the number and the value of every `stride`-th sample from `first` on; returns how many samples there are in all.
fn each(
    values: &DecodingResult,
    first: usize,
    stride: usize,
    mut take: impl FnMut(usize, f64),
) -> usize {
    macro_rules! widened {
        ($samples:expr, $wide:expr) => {{
            for (i, value) in $samples.iter().skip(first).step_by(stride).enumerate() {
                take(i, $wide(*value));
            }
            $samples.len()
        }};
    }
    match values {
        DecodingResult::U8(v) => widened!(v, f64::from),
        DecodingResult::U16(v) => widened!(v, f64::from),
        DecodingResult::U32(v) => widened!(v, f64::from),
        DecodingResult::U64(v) => widened!(v, |s| s as f64),
        DecodingResult::I8(v) => widened!(v, f64::from),
        DecodingResult::I16(v) => widened!(v, f64::from),
        DecodingResult::I32(v) => widened!(v, f64::from),
        DecodingResult::I64(v) => widened!(v, |s| s as f64),
        DecodingResult::F16(v) => widened!(v, f16::to_f64),
        DecodingResult::F32(v) => widened!(v, f64::from),
        DecodingResult::F64(v) => widened!(v, |s| s),
    }
}
