//! Height files written by GDAL: the values that are read are those that GDAL reads.

use super::geotiff::{gdal_values, gdalinfo};
use crate::Folder;
use crate::succeeded;
use ridgelight::scene::HeightField;
use ridgelight_io::{HeightOptions, read_field};
use serde_json::json;
use std::path::Path;
use std::process::Command;

/// Runs a tool of GDAL in the folder, with arguments between blanks.
pub fn tool(folder: &Folder, command: &str) {
    let mut words = command.split_whitespace();
    let name = words.next().unwrap();
    let mut tool = Command::new(name);
    tool.current_dir(folder.path("")).args(words);
    let output = tool.output().unwrap_or_else(|_| panic!("{name}: run tools/setup --tests"));
    assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
}

/// An ESRI grid of whole numbers from 1 to 250, another for each `salt`, as text.
pub fn grid([cols, rows]: [usize; 2], corner: [f64; 2], cell: f64, salt: usize) -> String {
    let [west, south] = corner;
    let mut text = format!(
        "ncols {cols}\nnrows {rows}\nxllcorner {west}\nyllcorner {south}\ncellsize {cell}\n"
    );
    for i in 0..rows * cols {
        text += &format!("{} ", 1 + (i * 7919 + salt * 104_729) % 250);
    }
    text
}

/// Writes such a grid of cells of 30 m.
fn write_grid(folder: &Folder, name: &str, size: [usize; 2], salt: usize) {
    folder.write(name, grid(size, [500_000.0, 4_900_000.0], 30.0, salt).as_bytes());
}

/// Absolute heights; whole numbers are exact in a field.
pub fn absolute(field: &HeightField) -> Vec<f32> {
    field.heights_m().iter().map(|h| (field.base_m() + f64::from(*h)) as f32).collect()
}

fn heights(path: &Path, options: &HeightOptions) -> Vec<f32> {
    let read = read_field(path, options).unwrap_or_else(|error| panic!("{error}"));
    absolute(&read.field)
}

/// Every band of files of several bands, interleaved or one after the other, in strips and in tiles. Each pair of type and
/// compression has two of these four layouts, in turn: both orders of bands, strips and tiles.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_bands_have_the_values_that_gdal_reads() {
    let folder = Folder::new();
    for salt in 0..5 {
        write_grid(&folder, &format!("{salt}.asc"), [37, 29], salt);
        tool(&folder, &format!("gdal_translate -q {salt}.asc odd{salt}.tif"));
    }
    let all = (0..5).map(|salt| format!(" odd{salt}.tif")).collect::<String>();
    tool(&folder, &format!("gdalbuildvrt -q -separate odd.vrt{all}"));
    let mut read = 0;
    let kinds = [
        "Byte",
        "Int16",
        // Beyond the signed types, in multiples of 250 and of 16 million, which f32 holds.
        "UInt16 -scale 0 250 0 62500",
        "UInt32 -scale 0 250 0 4000000000",
        // Floats of 16 bits, in quarters.
        "Float32 -co NBITS=16 -scale 0 250 -31.25 31.25",
        "Float32",
        "Float64",
    ];
    let tilings = ["NO", "YES -co BLOCKXSIZE=16 -co BLOCKYSIZE=16"];
    // Predictor 3 is of floats of 32 and 64 bits.
    let compressions = [
        "NONE",
        "LZW",
        "LZW -co PREDICTOR=2",
        "DEFLATE",
        "ZSTD",
        "DEFLATE -co PREDICTOR=3",
        "ZSTD -co PREDICTOR=3",
    ];
    let floats = ["Float32", "Float64"];
    for (k, kind) in kinds.into_iter().enumerate() {
        for (l, layout) in ["PIXEL", "BAND"].into_iter().enumerate() {
            for (t, tiles) in tilings.into_iter().enumerate() {
                for (p, packed) in compressions.into_iter().enumerate() {
                    if !(k + l + t + p).is_multiple_of(2)
                        || packed.ends_with("=3") && !floats.contains(&kind)
                    {
                        continue;
                    }
                    let options = format!("-co INTERLEAVE={layout} -co TILED={tiles}");
                    let command = format!(
                        "gdal_translate -q -ot {kind} {options} -co COMPRESS={packed} odd.vrt b.tif"
                    );
                    tool(&folder, &command);
                    let path = folder.path("b.tif");
                    let values = gdal_values(&path);
                    let size = values.len() / 5;
                    for band in 0..5 {
                        let options =
                            HeightOptions { band: Some(band as u32 + 1), ..Default::default() };
                        let plane = &values[band * size..(band + 1) * size];
                        assert!(heights(&path, &options) == plane, "{command}: band {band}");
                        // 9 of 37 columns from the 20th, 5 of 29 rows from the 13th.
                        let bbox = [500_600.0, 4_900_330.0, 500_870.0, 4_900_480.0];
                        let part = HeightOptions { bbox: Some(bbox), ..options };
                        let row = |row: usize| &plane[row * 37 + 20..][..9];
                        let expected: Vec<f32> = (13..18).flat_map(row).copied().collect();
                        assert!(heights(&path, &part) == expected, "{command}: box of {band}");
                        read += 1;
                    }
                    assert_ne!(values[..size], values[size..2 * size]);
                }
            }
        }
    }
    assert_eq!(read, 5 * (kinds.len() * 10 + floats.len() * 4));
}

/// The command in the message about 12 and 24 bits keeps the heights.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_converts_12_and_24_bits_as_the_message_says() {
    let folder = Folder::new();
    for (kind, bits, most) in [("UInt16", 12, 4095_u32), ("UInt32", 24, 16_777_215)] {
        folder.write("a.asc", format!("ncols 2 nrows 2 cellsize 30\n0 1 2049 {most}").as_bytes());
        let values = [0.0, 1.0, 2049.0, most as f32];
        tool(&folder, &format!("gdal_translate -q -ot {kind} -co NBITS={bits} a.asc odd.tif"));
        let error = read_field(&folder.path("odd.tif"), &HeightOptions::default()).unwrap_err();
        let error = error.to_string();
        assert!(error.contains(&format!("{bits} bits")), "{error}");
        let command = error.split('`').nth(1).expect("a command");
        tool(&folder, &format!("{command} -q odd.tif whole.tif"));
        let options = HeightOptions { cell_m: Some([30.0; 2]), ..HeightOptions::default() };
        assert_eq!(heights(&folder.path("whole.tif"), &options), values, "{command}");
    }
}

/// Overviews, which gdaladdo writes into a file or beside it, are not read in place of the heights.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_overviews_leave_the_heights_as_they_are() {
    let folder = Folder::new();
    write_grid(&folder, "a.asc", [333, 277], 0);
    for (name, place) in [("inside.tif", ""), ("beside.tif", "-ro ")] {
        let options = "-q -ot Float32 -co TILED=YES -co COMPRESS=DEFLATE";
        tool(&folder, &format!("gdal_translate {options} a.asc {name}"));
        let path = folder.path(name);
        let expected = gdal_values(&path);
        assert_eq!(expected.len(), 333 * 277);
        tool(&folder, &format!("gdaladdo -q {place}-r average {name} 2 4"));
        let overviews = gdalinfo(&path)["bands"][0]["overviews"].clone();
        assert_eq!(overviews, json!([{ "size": [167, 139] }, { "size": [84, 70] }]), "{name}");
        assert_eq!(folder.path(&format!("{name}.ovr")).exists(), !place.is_empty());
        let read = read_field(&path, &HeightOptions::default()).unwrap();
        assert_eq!((read.field.rows(), read.field.cols()), (277, 333), "{name}");
        assert!(absolute(&read.field) == expected, "{name}");
        assert_eq!(read.notes, Vec::<String>::new(), "{name}");
    }
}

/// The scale and the offset of a band change no other band.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_scales_and_offsets_are_those_of_the_band() {
    let folder = Folder::new();
    for (name, salt) in [("plain.asc", 0), ("b.asc", 1)] {
        write_grid(&folder, name, [37, 29], salt);
    }
    tool(&folder, "gdal_translate -q -a_scale 0.5 -a_offset 1000 b.asc scaled.tif");
    tool(&folder, "gdalbuildvrt -q -separate two.vrt plain.asc scaled.tif");
    tool(&folder, "gdal_translate -q -ot Int16 two.vrt two.tif");
    let info = gdalinfo(&folder.path("two.tif"));
    for (band, scale, offset) in [(0_usize, 1.0, 0.0), (1, 0.5, 1000.0)] {
        // GDAL states neither where both are those of the stored values.
        let stated = |name: &str, default| info["bands"][band][name].as_f64().unwrap_or(default);
        assert_eq!([stated("scale", 1.0), stated("offset", 0.0)], [scale, offset]);
        let number = band + 1;
        tool(&folder, &format!("gdal_translate -q -unscale -ot Float32 -b {number} two.tif u.tif"));
        let expected = gdal_values(&folder.path("u.tif"));
        let options = HeightOptions { band: Some(number as u32), ..Default::default() };
        assert!(heights(&folder.path("two.tif"), &options) == expected, "band {number}");
        // From 1 to 250, as stored.
        let run = succeeded(&folder, &format!("info two.tif --band {number} --json i.json"));
        let facts = crate::needs_vulkan::json(&folder.path("i.json"));
        let ends = json!([offset + scale, offset + 250.0 * scale]);
        assert_eq!(facts["heights_m"], ends, "band {number}: {}", run.out);
        let note = format!("scale {scale} and offset {offset} of the file are applied");
        assert_eq!(run.out.contains(&note), scale != 1.0, "band {number}: {}", run.out);
    }
}

/// The unit of a band changes no other band, and comes before that of the vertical system.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_units_are_those_of_the_band() {
    let folder = Folder::new();
    for (name, salt) in [("1.asc", 0), ("2.asc", 1)] {
        write_grid(&folder, name, [9, 7], salt);
    }
    tool(&folder, "gdalbuildvrt -q -separate plain.vrt 1.asc 2.asc");
    let plain = std::fs::read_to_string(folder.path("plain.vrt")).unwrap();
    let differs = "the band's unit is ft, but that of the vertical system is 1 m";
    for (unit, system, unit_m, said) in [
        ("ft", "EPSG:32618", 0.3048, ""),
        ("US survey foot", "EPSG:32618", 1200.0 / 3937.0, ""),
        ("metre", "EPSG:32618", 1.0, ""),
        ("degrees", "EPSG:32618", 1.0, "the band's unit \"degrees\" is not known"),
        ("ft", "EPSG:32618+5703", 0.3048, differs),
    ] {
        let mut text = String::new();
        for line in plain.lines() {
            text += line;
            if line.contains("<VRTRasterBand") && line.contains("band=\"2\"") {
                text += &format!("<UnitType>{unit}</UnitType>");
            }
            text.push('\n');
        }
        folder.write("two.vrt", text.as_bytes());
        tool(&folder, &format!("gdal_translate -q -ot Float32 -a_srs {system} two.vrt two.tif"));
        let path = folder.path("two.tif");
        assert_eq!(gdalinfo(&path)["bands"][1]["unit"], unit, "{system}");
        for band in [1, 2] {
            let unit_m = if band == 2 { unit_m } else { 1.0 };
            let options = HeightOptions { band: Some(band), ..Default::default() };
            let read = read_field(&path, &options).unwrap();
            let expected = gdal_values(&folder.path(&format!("{band}.asc")));
            for (height, stored) in absolute(&read.field).iter().zip(&expected) {
                let error = f64::from(*height) - f64::from(*stored) * unit_m;
                // An offset from the median and a sum, each rounded to f32, of up to 250.
                assert!(error.abs() < 250.0 * f64::from(f32::EPSILON), "{unit} {band}: {height}");
            }
            let said = if band == 2 { said } else { "" };
            let warnings = read.warnings.join("\n");
            assert_eq!(warnings.is_empty(), said.is_empty(), "{unit} {band}: {warnings}");
            assert!(warnings.contains(said), "{unit} {band}: {warnings}");
        }
    }
}

/// Larger tiles that reach beyond the image, of which `tiff` 0.11 cannot read some (its issue 395).
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_lzw_tiles_beyond_the_edge_are_read() {
    let folder = Folder::new();
    write_grid(&folder, "a.asc", [333, 277], 0);
    for kind in ["Byte", "Int16", "Int32", "Float32", "Float64"] {
        for options in ["", "-co PREDICTOR=2", "-co ENDIANNESS=BIG", "-co PREDICTOR=3"] {
            let is_float = kind.starts_with('F');
            if options.ends_with("=3") && !is_float
                || options == "-co PREDICTOR=2" && kind == "Float64"
            {
                continue;
            }
            let tiled = "-co TILED=YES -co COMPRESS=LZW";
            tool(&folder, &format!("gdal_translate -q -ot {kind} {tiled} {options} a.asc b.tif"));
            let path = folder.path("b.tif");
            assert!(
                heights(&path, &HeightOptions::default()) == gdal_values(&path),
                "{kind} {options}"
            );
        }
    }
}

/// Files whose least value is white, in each of GDAL's byte orders and in BigTIFF. Each pair of type and compression has
/// two of the four forms, in turn.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_values_are_the_stored_ones_where_white_is_zero() {
    let folder = Folder::new();
    write_grid(&folder, "a.asc", [37, 29], 0);
    let forms = ["ENDIANNESS=LITTLE", "ENDIANNESS=BIG", "BIGTIFF=YES", "TILED=YES"];
    for (k, kind) in ["Byte", "UInt16", "Int16", "Float32"].into_iter().enumerate() {
        for (p, packed) in ["NONE", "LZW", "DEFLATE"].into_iter().enumerate() {
            let in_turn = forms.into_iter().skip((k + p) % 2).step_by(2);
            for layout in in_turn {
                let options = format!("-co PHOTOMETRIC=MINISWHITE -co COMPRESS={packed}");
                tool(
                    &folder,
                    &format!("gdal_translate -q -ot {kind} {options} -co {layout} a.asc b.tif"),
                );
                let path = folder.path("b.tif");
                assert_eq!(gdalinfo(&path)["metadata"]["IMAGE_STRUCTURE"]["MINISWHITE"], "YES");
                let read = heights(&path, &HeightOptions::default());
                assert!(read == gdal_values(&path), "{kind} {packed} {layout}");
            }
        }
    }
}

/// Without a choice the first band is read with a note; a picture of colours is refused.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_several_bands_get_a_note_and_colours_are_refused() {
    let folder = Folder::new();
    for salt in 0..3 {
        write_grid(&folder, &format!("{salt}.asc"), [9, 7], salt);
    }
    tool(&folder, "gdalbuildvrt -q -separate all.vrt 0.asc 1.asc 2.asc");
    tool(&folder, "gdal_translate -q -ot Float32 all.vrt several.tif");
    tool(&folder, "gdal_translate -q -ot Byte all.vrt colours.tif");
    let run = folder.run_str("plan several.tif");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let note = "several.tif: heights are band 1 of 3; --band chooses another";
    assert!(run.notes.contains(note), "{}", run.notes);
    assert!(!folder.run_str("plan several.tif --band 1").notes.contains("band 1 of"));
    let plane = |name: &str, band| {
        heights(&folder.path(name), &HeightOptions { band, ..Default::default() })
    };
    assert_eq!(plane("several.tif", None), plane("0.asc", None));
    assert_eq!(plane("several.tif", Some(3)), plane("2.asc", None));
    assert_eq!(plane("colours.tif", Some(2)), plane("1.asc", None));
    let says = ["3 colour channels", "one band of heights, or a choice by --band"];
    crate::refused(
        &folder,
        &[
            ("plan colours.tif", 1, &says),
            ("plan several.tif --band 4", 1, &["3 bands", "a band 4"]),
            ("plan 0.asc --band 2", 1, &["1 band,", "a band 2, which --band requests"]),
            ("plan several.tif --band 0", 2, &["--band", "1 or more"]),
        ],
    );
}

/// A mask is not read, with a note, inside of the file or beside it; heights that often mark voids get one, too.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_masks_and_likely_voids_get_a_note() {
    let folder = Folder::new();
    let text = grid([9, 7], [500_000.0, 4_900_000.0], 30.0, 0);
    folder.write("a.asc", text.as_bytes());
    folder.write("marked.asc", text.replacen("\n1 ", "\n-32768 ", 1).as_bytes());
    tool(&folder, "gdal_translate -q a.asc plain.tif");
    let inside = "--config GDAL_TIFF_INTERNAL_MASK YES";
    tool(&folder, &format!("gdal_translate -q -ot Float32 {inside} -mask 1 a.asc inside.tif"));
    tool(&folder, "gdal_translate -q -ot Float32 -mask 1 a.asc beside.tif");
    assert!(folder.path("beside.tif.msk").exists());
    tool(&folder, "gdalwarp -q -dstalpha -s_srs EPSG:32618 -t_srs EPSG:32619 plain.tif alpha.tif");
    let notes = |name: &str| folder.run_str(&format!("plan {name}")).notes;
    for (name, has_note) in [("plain.tif", false), ("inside.tif", true), ("beside.tif", true)] {
        assert_eq!(notes(name).contains("the mask of this file is not read"), has_note, "{name}");
    }
    let said = notes("alpha.tif");
    assert!(said.contains("warning: alpha.tif: the alpha band of this file is not read"), "{said}");
    assert!(!notes("a.asc").contains("often marks a void"));
    let said = notes("marked.asc");
    assert!(said.contains("1 height is -32768, which often marks a void"), "{said}");
    assert!(said.contains("--nodata -32768 makes"), "{said}");
    assert!(!notes("marked.asc --nodata -32768").contains("often marks a void"));
}

/// A compression that is not read is named, with a way out.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_unread_compressions_are_named() {
    let folder = Folder::new();
    write_grid(&folder, "a.asc", [9, 7], 0);
    let mut refused = 0;
    for (kind, packed, name) in
        [("Byte", "JPEG", "JPEG"), ("Float32", "LERC", "LERC"), ("Float32", "LZMA", "LZMA")]
    {
        let options = format!("-ot {kind} -co COMPRESS={packed}");
        tool(&folder, &format!("gdal_translate -q {options} a.asc packed.tif"));
        let run = folder.run_str("plan packed.tif");
        assert_eq!(run.status, Some(1), "{packed}: {}", run.err);
        let says = [&format!("found {name} (compression "), "LZW, DEFLATE or Zstandard"];
        assert!(says.iter().all(|part| run.err.contains(part)), "{packed}: {}", run.err);
        refused += 1;
    }
    assert_eq!(refused, 3);
}

/// A file that is cut off is called so, one without some of its tiles is not.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_files_that_are_cut_off_are_called_so() {
    let folder = Folder::new();
    write_grid(&folder, "a.asc", [100, 60], 0);
    tool(&folder, "gdal_translate -q -ot Float32 a.asc whole.tif");
    let whole = std::fs::read(folder.path("whole.tif")).unwrap();
    folder.write("cut.tif", &whole[..10_000]);
    // 100 x 60 values of 4 bytes.
    let says =
        ["file size: found a file that is cut off: 24000 bytes of values in a file of 10000"];
    crate::refused(&folder, &[("plan cut.tif", 1, &says)]);
    let mut text = "ncols 320\nnrows 320\ncellsize 30\nnodata_value -9\n".to_owned();
    for i in 0..320 * 320 {
        text += if i % 320 < 20 { "7 " } else { "-9 " };
    }
    folder.write("half.asc", text.as_bytes());
    let tiles = "-co TILED=YES -co BLOCKXSIZE=16 -co BLOCKYSIZE=16 -co SPARSE_OK=TRUE";
    tool(&folder, &format!("gdal_translate -q -ot Float32 {tiles} half.asc sparse.tif"));
    let length = std::fs::metadata(folder.path("sparse.tif")).unwrap().len();
    assert!(length < 4 * 320 * 320, "GDAL left out no tile");
    let run = folder.run_str("plan sparse.tif");
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
}

/// The no-data value of a GeoTIFF or of a grid in text marks the grid points that have it in GDAL's reading.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_no_data_values_are_voids() {
    let folder = Folder::new();
    write_grid(&folder, "a.asc", [37, 29], 0);
    for (name, options) in [
        ("int.tif", "-ot Int16"),
        ("float.tif", "-ot Float32"),
        ("double.tif", "-ot Float64"),
        ("text.asc", "-ot Int16 -of AAIGrid"),
    ] {
        tool(&folder, &format!("gdal_translate -q {options} -a_nodata 7 a.asc {name}"));
        let path = folder.path(name);
        assert_eq!(gdalinfo(&path)["bands"][0]["noDataValue"].as_f64(), Some(7.0), "{name}");
        let expected = gdal_values(&path);
        let field = read_field(&path, &HeightOptions::default()).unwrap().field;
        let (heights, voids) = (absolute(&field), field.voids().expect("voids"));
        assert_eq!(heights.len(), expected.len(), "{name}");
        for (i, (height, expected)) in heights.iter().zip(&expected).enumerate() {
            assert_eq!(voids[i], *expected == 7.0, "{name}: {i}");
            assert!(voids[i] || height == expected, "{name}: {i}");
        }
        // The value occurs.
        assert!(voids.contains(&true), "{name}");
        // Another value makes heights of them, with a warning.
        let count = voids.iter().filter(|is_void| **is_void).count();
        let run = succeeded(&folder, &format!("info {name} --nodata 9"));
        let said = format!("--nodata 9 replaces the file's 7, which {count} heights have");
        assert!(run.out.contains(&said), "{name}: {}", run.out);
        assert!(!succeeded(&folder, &format!("info {name} --nodata 7")).out.contains("replaces"));
    }
}

/// Tiles that GDAL leaves out have the no-data value, in compressed and in uncompressed files.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_sparse_tiles_are_voids() {
    let folder = Folder::new();
    let mut text = "ncols 64\nnrows 32\ncellsize 30\nnodata_value -9\n".to_owned();
    for i in 0..64 * 32 {
        text += if i % 64 < 20 { "7 " } else { "-9 " };
    }
    folder.write("half.asc", text.as_bytes());
    for compression in ["DEFLATE", "NONE"] {
        let tiles =
            format!("-co TILED=YES -co BLOCKXSIZE=16 -co BLOCKYSIZE=16 -co COMPRESS={compression}");
        let [sparse, whole] = ["sparse", "whole"].map(|name| format!("{compression}_{name}.tif"));
        tool(&folder, &format!("gdal_translate -q -co SPARSE_OK=TRUE {tiles} half.asc {sparse}"));
        tool(&folder, &format!("gdal_translate -q {tiles} half.asc {whole}"));
        let [sparse, whole] = [sparse, whole].map(|name| folder.path(&name));
        let length = |path: &Path| std::fs::metadata(path).unwrap().len();
        assert!(length(&sparse) < length(&whole), "GDAL left out no tile");
        let read = |path| read_field(path, &HeightOptions::default()).unwrap().field;
        assert_eq!(read(&sparse), read(&whole));
        assert_eq!(read(&sparse).voids().unwrap().iter().filter(|v| **v).count(), 44 * 32);
    }
}

/// Grey of 8 and of 16 bits, without and with a transparent grey, which marks voids.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_pngs_have_the_values_that_gdal_reads() {
    let folder = Folder::new();
    write_grid(&folder, "a.asc", [37, 29], 0);
    for (kind, most) in [("Byte", 250.0_f32), ("UInt16", 62_500.0)] {
        for has_voids in [false, true] {
            let marked = if has_voids { format!("-a_nodata {most}") } else { String::new() };
            let options = format!("-of PNG -ot {kind} -scale 0 250 0 {most} {marked}");
            tool(&folder, &format!("gdal_translate -q {options} a.asc grey.png"));
            let path = folder.path("grey.png");
            assert_eq!(gdalinfo(&path)["bands"][0]["type"], kind);
            let expected = gdal_values(&path);
            let field = read_field(&path, &HeightOptions::default()).unwrap().field;
            let found = absolute(&field);
            assert_eq!(found.len(), expected.len(), "{options}");
            let mut voids = 0;
            for (i, (height, expected)) in found.iter().zip(&expected).enumerate() {
                let is_void = field.voids().is_some_and(|voids| voids[i]);
                assert_eq!(is_void, has_voids && *expected == most, "{options}: {i}");
                assert!(is_void || height == expected, "{options}: {i}");
                voids += usize::from(*expected == most);
            }
            // The greatest value of the grid occurs.
            assert!(voids > 0, "{options}");
        }
    }
}
