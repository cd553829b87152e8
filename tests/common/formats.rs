//! Small valid files of every format, built in memory.

use std::io::{Cursor, Write};

/// The heights in every test file: 3 rows of 4, none special.
pub const HEIGHTS: [i16; 12] = [0, 1, 2, 3, 10, 11, 12, 13, 100, 101, 102, 120];
pub const ROWS: usize = 3;
pub const COLS: usize = 4;

/// An NPY array of version 1.
pub fn npy(descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let fortran = if fortran { "True" } else { "False" };
    let header =
        format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

/// A ZIP of members, deflated.
pub fn zip(members: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in members {
        let options = zip::write::SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Deflated);
        zip.start_file(*name, options).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// The colour types of PNG's IHDR.
pub mod colour {
    pub const GREY: u8 = 0;
    pub const RGB: u8 = 2;
    pub const PALETTE: u8 = 3;
    pub const GREY_ALPHA: u8 = 4;
    pub const RGBA: u8 = 6;

    pub const ALL: [u8; 5] = [GREY, RGB, PALETTE, GREY_ALPHA, RGBA];
}

/// A PNG of raw rows, stored, with chunks before them; a palette is black and white.
pub fn png(
    cols: u32,
    rows: u32,
    colour: u8,
    depth: u8,
    chunks: &[(&[u8; 4], &[u8])],
    grid_points: &[u8],
) -> Vec<u8> {
    assert!(colour::ALL.contains(&colour), "PNG knows no colour type {colour}");
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |name: &[u8; 4], data: &[u8]| {
        let named = [name, data].concat();
        bytes.extend((data.len() as u32).to_be_bytes());
        bytes.extend(&named);
        bytes.extend(crc32(&named).to_be_bytes());
    };
    let sizes = [cols.to_be_bytes(), rows.to_be_bytes()].concat();
    chunk(b"IHDR", &[&sizes[..], &[depth, colour, 0, 0, 0]].concat());
    if colour == colour::PALETTE {
        chunk(b"PLTE", &[0, 0, 0, 255, 255, 255]);
    }
    chunks.iter().for_each(|(name, data)| chunk(name, data));
    // Each row behind the number of its filter, none; all in one stored DEFLATE block.
    let rows: Vec<u8> = grid_points
        .chunks(grid_points.len() / rows as usize)
        .flat_map(|row| [&[0], row].concat())
        .collect();
    let length = u16::try_from(rows.len()).unwrap();
    let (a, b) = rows.iter().fold((1, 0), |(a, b), v| {
        let a = (a + u32::from(*v)) % 65_521;
        (a, (a + b) % 65_521)
    });
    let mut data = vec![0x78, 0x01, 1];
    data.extend([length.to_le_bytes(), (!length).to_le_bytes()].concat());
    data.extend(&rows);
    data.extend((b << 16 | a).to_be_bytes());
    chunk(b"IDAT", &data);
    chunk(b"IEND", &[]);
    bytes
}

/// The PNG checksum (ISO 3309), bit by bit.
pub fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, b| {
        (0..8).fold(
            crc ^ u32::from(*b),
            |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 },
        )
    })
}

/// A GeoTIFF tag's value.
pub enum Tag<'a> {
    Doubles(&'a [f64]),
    Shorts(&'a [u16]),
    Text(&'a str),
}

/// A TIFF of one band with tags.
pub fn tiff<C>(
    cols: u32,
    rows: u32,
    grid_points: &[C::Inner],
    compression: tiff::encoder::Compression,
    predictor: tiff::tags::Predictor,
    tags: &[(u16, Tag)],
) -> Vec<u8>
where
    C: tiff::encoder::colortype::ColorType,
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes)
        .unwrap()
        .with_compression(compression)
        .with_predictor(predictor);
    let mut image = encoder.new_image::<C>(cols, rows).unwrap();
    for (tag, value) in tags {
        let tag = tiff::tags::Tag::from_u16_exhaustive(*tag);
        let directory = image.encoder();
        match value {
            Tag::Doubles(v) => directory.write_tag(tag, *v),
            Tag::Shorts(v) => directory.write_tag(tag, *v),
            Tag::Text(v) => directory.write_tag(tag, *v),
        }
        .unwrap();
    }
    image.write_data(grid_points).unwrap();
    bytes.into_inner()
}

/// A TIFF of f32 in uncompressed square tiles of one height each. `None` is a tile without bytes, as GDAL's SPARSE_OK
/// leaves it out.
pub fn sparse_tiff(
    side: u32,
    [across, down]: [u32; 2],
    tiles: &[Option<f32>],
    nodata: Option<&str>,
) -> Vec<u8> {
    assert_eq!(tiles.len(), (across * down) as usize);
    let (short, long, text) = (3_u16, 4_u16, 2_u16);
    // The place of the directory comes last.
    let mut bytes = b"II*\0\0\0\0\0".to_vec();
    let (mut offsets, mut lengths) = (Vec::new(), Vec::new());
    for tile in tiles {
        let values = tile
            .map_or_else(Vec::new, |height| height.to_le_bytes().repeat((side * side) as usize));
        let offset = if values.is_empty() { 0 } else { bytes.len() as u32 };
        offsets.extend(offset.to_le_bytes());
        lengths.extend((values.len() as u32).to_le_bytes());
        bytes.extend(values);
    }
    let longs = |value: u32| value.to_le_bytes().to_vec();
    let shorts = |value: u16| value.to_le_bytes().to_vec();
    let mut entries = vec![
        (256_u16, long, longs(side * across)),
        (257, long, longs(side * down)),
        (258, short, shorts(32)),
        (259, short, shorts(1)),
        (262, short, shorts(1)),
        (277, short, shorts(1)),
        (322, long, longs(side)),
        (323, long, longs(side)),
        (324, long, offsets),
        (325, long, lengths),
        (339, short, shorts(3)),
    ];
    entries.extend(nodata.map(|nodata| (42113, text, format!("{nodata}\0").into_bytes())));
    let mut directory = (entries.len() as u16).to_le_bytes().to_vec();
    for (tag, kind, mut value) in entries {
        let size = [1, 2, 4][[text, short, long].iter().position(|k| *k == kind).unwrap()];
        let count = (value.len() / size) as u32;
        if value.len() > 4 {
            let at = bytes.len() as u32;
            bytes.extend(value);
            value = longs(at);
        }
        value.resize(4, 0);
        directory.extend(tag.to_le_bytes());
        directory.extend(kind.to_le_bytes());
        directory.extend(count.to_le_bytes());
        directory.extend(value);
    }
    directory.extend([0; 4]);
    let at = bytes.len() as u32;
    bytes[4..8].copy_from_slice(&at.to_le_bytes());
    bytes.extend(directory);
    bytes
}

/// A plain GeoTIFF of [`HEIGHTS`] in degrees.
pub fn geotiff() -> Vec<u8> {
    tiff::<tiff::encoder::colortype::GrayI16>(
        COLS as u32,
        ROWS as u32,
        &HEIGHTS,
        tiff::encoder::Compression::Deflate(tiff::encoder::DeflateLevel::Fast),
        tiff::tags::Predictor::Horizontal,
        &[
            (33550, Tag::Doubles(&[0.01, 0.02, 0.0])),
            (33922, Tag::Doubles(&[0.0, 0.0, 0.0, -72.0, 45.0, 0.0])),
            (34735, Tag::Shorts(&[1, 1, 0, 2, 1024, 0, 1, 2, 1025, 0, 1, 1])),
            (42113, Tag::Text("-32768")),
        ],
    )
}

/// An EXR of named f32 channels.
pub fn exr(cols: usize, rows: usize, channels: &[(&str, exr::prelude::FlatSamples)]) -> Vec<u8> {
    use exr::prelude::*;
    let list =
        channels.iter().map(|(name, grid_points)| AnyChannel::new(*name, grid_points.clone()));
    let layer = Layer::new(
        (cols, rows),
        LayerAttributes::default(),
        Encoding { compression: Compression::ZIP16, ..Encoding::UNCOMPRESSED },
        AnyChannels::sort(list.collect()),
    );
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

/// A Radiance picture, uncoded, with extra header lines.
pub fn hdr(cols: usize, rows: usize, lines: &str, texels: &[[u8; 4]]) -> Vec<u8> {
    let mut bytes =
        format!("#?RADIANCE\n{lines}FORMAT=32-bit_rle_rgbe\n\n-Y {rows} +X {cols}\n").into_bytes();
    bytes.extend(texels.iter().flatten());
    bytes
}

/// One valid height field of every format, by name.
pub fn height_files() -> Vec<(&'static str, Vec<u8>)> {
    let be: Vec<u8> = HEIGHTS.iter().flat_map(|h| h.to_be_bytes()).collect();
    let le: Vec<u8> = HEIGHTS.iter().flat_map(|h| h.to_le_bytes()).collect();
    let text: Vec<String> = HEIGHTS.iter().map(|h| h.to_string()).collect();
    let asc = format!(
        "ncols 4\nnrows 3\nxllcorner 1000\nyllcorner 2000\ncellsize 30\nNODATA_value -9999\n{}\n",
        text.join(" ")
    );
    let array = npy("<i2", false, "(3, 4)", &le);
    let floats: Vec<f32> = HEIGHTS.iter().map(|h| f32::from(*h)).collect();
    let number = |v: f64| npy("<f8", false, "()", &v.to_le_bytes());
    vec![
        ("a.png", png(4, 3, colour::GREY, 16, &[], &be)),
        ("a.exr", exr(4, 3, &[("Z", exr::prelude::FlatSamples::F32(floats))])),
        ("a.tif", geotiff()),
        ("N44W072.hgt", be[..18].to_vec()),
        ("a.asc", asc.into_bytes()),
        ("a.npy", array.clone()),
        (
            "a.npz",
            zip(&[("elevation.npy", array), ("dx.npy", number(30.0)), ("dy.npy", number(20.0))]),
        ),
    ]
}
