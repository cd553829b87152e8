use super::*;
use crate::georeference::GeoKeys;
use crate::{Channels, Georeference, HeightOptions, Layer, read_field, write_geotiff};
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

/// Written with this value, which no rounding changes, at a row and column of a band.
fn value(band: usize, row: usize, col: usize) -> f32 {
    if (row + col) % 7 == 3 { f32::NAN } else { (band * 1000 + row) as f32 + col as f32 / 1024.0 }
}

fn plane(band: usize, [cols, rows]: Size) -> Vec<f32> {
    (0..rows * cols).map(|i| value(band, i / cols, i % cols)).collect()
}

fn bands(count: usize) -> Vec<Band> {
    (0..count).map(|i| Band { name: format!("b{i}"), unit: "rad".into() }).collect()
}

/// A file of `count` bands, written in the reverse order.
fn written([cols, rows]: Size, count: usize, big: bool) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tif");
    let mut writer = GeoTiffWriter::create(&path, [rows, cols], bands(count), None).unwrap();
    writer.always_big = big;
    for band in (0..count).rev() {
        writer.write(band, &plane(band, [cols, rows])).unwrap();
    }
    writer.finish(&[("key".into(), "<a & \"b\">\n".into())]).unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    std::fs::read(path).unwrap()
}

/// All images of a file with one band, decoded by the `tiff` crate.
fn images(bytes: &[u8]) -> Vec<(Size, Vec<f32>)> {
    let mut tiff = Decoder::new(Cursor::new(bytes)).unwrap();
    let mut all = Vec::new();
    loop {
        let (cols, rows) = tiff.dimensions().unwrap();
        let DecodingResult::F32(values) = tiff.read_image().unwrap() else { panic!("no f32") };
        all.push(([cols as usize, rows as usize], values));
        if !tiff.more_images() {
            return all;
        }
        tiff.next_image().unwrap();
    }
}

/// Bits, so that NaN equals NaN.
fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|v| v.to_bits()).collect()
}

#[test]
fn another_reader_finds_every_value() {
    // One pixel, one row, one column, less than a tile, a tile, primes around tiles.
    for size in [[1, 1], [5, 1], [1, 521], [17, 31], [512, 512], [523, 1031], [1024, 513]] {
        for big in [false, true] {
            let bytes = written(size, 1, big);
            assert_eq!(&bytes[..4], if big { b"II+\0" } else { b"II*\0" });
            let images = images(&bytes);
            assert_eq!(images.iter().map(|image| image.0).collect::<Vec<_>>(), tiles::levels(size));
            let mut expected = plane(0, size);
            for (i, (size, values)) in images.iter().enumerate() {
                if i > 0 {
                    expected = tiles::halved(&expected, images[i - 1].0);
                }
                assert_eq!(bits(values), bits(&expected), "{size:?}");
            }
        }
    }
}

/// All bands by their names, from files of several tiles.
#[test]
fn planes_are_read_back_with_their_names() {
    for size in [[1, 1], [523, 1031]] {
        for big in [false, true] {
            let bytes = written(size, 3, big);
            let read = crate::parse_planes(Path::new("a.tif"), &bytes).unwrap();
            assert_eq!([read.cols, read.rows], size);
            assert_eq!(read.names, ["b0", "b1", "b2"]);
            for (band, found) in read.planes.iter().enumerate() {
                assert_eq!(bits(found), bits(&plane(band, size)));
            }
        }
    }
}

#[test]
fn the_same_bands_are_the_same_bytes() {
    assert_eq!(written([600, 40], 3, false), written([600, 40], 3, false));
}

/// Places of tiles, from the tags alone: overviews from the smallest, then the image; in each image
/// the bands; without gaps from the last directory to the end of the file.
#[test]
fn tiles_follow_the_directories_in_cog_order() {
    for big in [false, true] {
        let bytes = written([1100, 520], 2, big);
        let mut tiff = Decoder::new(Cursor::new(bytes.as_slice())).unwrap();
        let mut levels = Vec::new();
        loop {
            let offsets = tiff.get_tag_u64_vec(Tag::TileOffsets).unwrap();
            let lengths = tiff.get_tag_u64_vec(Tag::TileByteCounts).unwrap();
            levels.push(offsets.into_iter().zip(lengths).collect::<Vec<_>>());
            if !tiff.more_images() {
                break;
            }
            tiff.next_image().unwrap();
        }
        assert_eq!(levels.iter().map(Vec::len).collect::<Vec<_>>(), [2 * 3 * 2, 2 * 2, 2]);
        let mut at = levels[2][0].0;
        for (offset, length) in levels.iter().rev().flatten() {
            assert_eq!(*offset, at);
            at += length;
        }
        assert_eq!(at, bytes.len() as u64);
        let ghost = if big { 16 } else { 8 };
        assert!(bytes[ghost..].starts_with(b"GDAL_STRUCTURAL_METADATA_SIZE=000055 bytes\nLAYOUT="));
        assert_eq!(LAYOUT.len(), 55);
    }
}

#[test]
fn settings_names_and_units_are_gdals_metadata() {
    let bytes = written([3, 2], 2, false);
    let mut tiff = Decoder::new(Cursor::new(bytes.as_slice())).unwrap();
    let text = tiff.get_tag_ascii_string(Tag::from_u16_exhaustive(42112)).unwrap();
    let expected = "<GDALMetadata>\n  <Item name=\"key\">&lt;a &amp; &quot;b&quot;&gt; </Item>\n  \
        <Item name=\"DESCRIPTION\" sample=\"0\" role=\"description\">b0</Item>\n  \
        <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">rad</Item>\n  \
        <Item name=\"DESCRIPTION\" sample=\"1\" role=\"description\">b1</Item>\n  \
        <Item name=\"UNITTYPE\" sample=\"1\" role=\"unittype\">rad</Item>\n</GDALMetadata>\n";
    assert_eq!(text.trim_end_matches('\0'), expected);
}

/// What the reader of heights finds is what was written, without the vertical reference.
#[test]
fn a_position_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tif");
    let keys = GeoKeys {
        entries: vec![
            [1024, 0, 1, 1],
            [1025, 0, 1, 2],
            [1026, 34737, 6, 0],
            [2057, 34736, 1, 1],
            [3072, 0, 1, 32633],
            [4099, 0, 1, 9002],
        ],
        doubles: vec![0.5, 6_378_137.0],
        ascii: "UTM 3|".into(),
    };
    let at = Georeference::at_origin([500_000.0, 5_100_000.0], [30.0, 20.0], keys.clone());
    let mut writer = GeoTiffWriter::create(&path, [2, 3], bands(1), Some(at)).unwrap();
    writer.write(0, &[1.0; 6]).unwrap();
    writer.finish(&[]).unwrap();
    let crate::FieldFile { field, georeference: at, .. } =
        crate::read_field(&path, &crate::HeightOptions::default()).unwrap();
    let at = at.unwrap();
    assert_eq!(field.cell_m(), [30.0, 20.0]);
    assert_eq!((at.corner, at.cell), ([499_985.0, 5_100_010.0], [30.0, 20.0]));
    assert_eq!(at.keys, keys.horizontal());
}

/// GDAL reads a BigTIFF, its bands and its overview: 1024 x 513 grid points have one. (Written small: a file that must be one has 4 GiB.)
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_reads_a_big_tiff() {
    let folder = tempfile::tempdir().unwrap();
    let size @ [cols, rows] = [1024, 513];
    let path = folder.path().join("big.tif");
    let bytes = written(size, 2, true);
    // Version 43 with offsets of 8 bytes.
    assert_eq!(bytes[..8], [b'I', b'I', 43, 0, 8, 0, 0, 0]);
    std::fs::write(&path, &bytes).unwrap();
    let read = |options: &[&str]| {
        let plain = folder.path().join("plain");
        let mut command = std::process::Command::new("gdal_translate");
        command.args(["-q", "-ot", "Float32", "-of", "ENVI", "-co", "INTERLEAVE=BSQ"]);
        let status = command.args(options).arg(&path).arg(&plain).status();
        assert!(status.expect("gdal_translate: run tools/setup --tests").success());
        let bytes = std::fs::read(plain).unwrap();
        bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect::<Vec<_>>()
    };
    let planes = [plane(0, size), plane(1, size)];
    assert_eq!(bits(&read(&[])), bits(&planes.concat()));
    let overviews = planes.each_ref().map(|plane| tiles::halved(plane, size)).concat();
    assert_eq!(overviews.len(), 2 * (cols / 2) * rows.div_ceil(2));
    assert_eq!(bits(&read(&["-oo", "OVERVIEW_LEVEL=0"])), bits(&overviews));
}

/// A length that 32 bits hold is that of a classic TIFF; from 2^32 on the file is a BigTIFF.
#[test]
fn a_file_of_4_gib_is_big() {
    let limit = 1_u64 << 32;
    for (bytes, is_big) in
        [(0, false), (limit - 2, false), (limit - 1, false), (limit, true), (u64::MAX, true)]
    {
        assert_eq!(needs_64_bits(bytes), is_big, "{bytes}");
    }
}

#[test]
fn wrong_use_is_refused_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tif");
    let create = |size, count| GeoTiffWriter::create(&path, size, bands(count), None);
    assert!(create([0, 1], 1).is_err() && create([1, 1], 0).is_err());
    assert!(create([1, 1], 65_536).is_err());
    let mut writer = create([1, 2], 2).unwrap();
    assert!(writer.write(0, &[0.0]).is_err() && writer.write(2, &[0.0; 2]).is_err());
    writer.write(1, &[0.0; 2]).unwrap();
    let error = writer.write(1, &[0.0; 2]).unwrap_err().to_string();
    assert!(error.contains("band 1 of a GeoTIFF") && error.contains("written twice"), "{error}");
    let error = writer.finish(&[]).unwrap_err().to_string();
    assert!(error.contains("band 0 of a GeoTIFF"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A grid that is wider than any field: its tiles in the box are read, and no others count.
#[test]
fn a_box_of_a_huge_file_is_read_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wide.tif");
    let (rows, cols) = (3, 70_000);
    let height = |row: usize, col: usize| (1000 * row + col % 251) as f32;
    let heights: Vec<f32> = (0..rows * cols).map(|i| height(i / cols, i % cols)).collect();
    let at = Georeference { corner: [0.0, 30.0], cell: [10.0; 2], keys: GeoKeys::default() };
    let layers = [Layer { name: String::new(), channels: Channels::Scalar("heights", &heights) }];
    write_geotiff(&path, [rows, cols], &layers, &[], Some(&at), &[]).unwrap();
    let read = |bbox| read_field(&path, &HeightOptions { bbox, ..HeightOptions::default() });
    let refused = read(None).unwrap_err().to_string();
    assert!(refused.contains("70000 columns") && refused.contains("`bbox` reads"), "{refused}");
    // Across the edge of a tile, and the last columns.
    for first in [500, cols - 24] {
        let west = 10.0 * first as f64;
        let part = read(Some([west, 0.0, west + 240.0, 20.0])).unwrap();
        let found = part.field.heights_m().iter().map(|h| part.field.base_m() as f32 + h);
        let expected = (0..48).map(|i| height(1 + i / 24, first + i % 24));
        assert!(found.eq(expected), "{first}");
        assert_eq!((part.field.rows(), part.field.cols()), (2, 24));
        assert_eq!(part.georeference.unwrap().corner, [west, 20.0]);
    }
}
