//! Height files written by GDAL: what is read is what GDAL reads.

use super::geotiff::{gdal_values, gdalinfo};
use crate::Folder;
use crate::needs_vulkan::done;
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

/// Absolute heights; whole numbers are exact in a field.
fn absolute(field: &HeightField) -> Vec<f32> {
    field.heights_m().iter().map(|h| (field.base_m() + f64::from(*h)) as f32).collect()
}

fn heights(path: &Path, options: &HeightOptions) -> Vec<f32> {
    let read = read_field(path, options).unwrap_or_else(|error| panic!("{error}"));
    absolute(&read.field)
}

/// Every band of files of several bands, interleaved or one after the other, in strips and in tiles.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_bands_have_the_values_that_gdal_reads() {
    let folder = Folder::new();
    for salt in 0..5 {
        let text = grid([37, 29], [500_000.0, 4_900_000.0], 30.0, salt);
        folder.write(&format!("{salt}.asc"), text.as_bytes());
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
    for kind in kinds {
        for layout in ["PIXEL", "BAND"] {
            for tiles in ["NO", "YES -co BLOCKXSIZE=16 -co BLOCKYSIZE=16"] {
                for packed in ["NONE", "LZW", "LZW -co PREDICTOR=2", "DEFLATE", "ZSTD"] {
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
    assert_eq!(read, 5 * kinds.len() * 20);
}

/// Overviews, which gdaladdo writes into a file or beside it, are not read in place of the heights.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_overviews_leave_the_heights_as_they_are() {
    let folder = Folder::new();
    folder.write("a.asc", grid([333, 277], [500_000.0, 4_900_000.0], 30.0, 0).as_bytes());
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
        folder.write(name, grid([37, 29], [500_000.0, 4_900_000.0], 30.0, salt).as_bytes());
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
    }
}

/// Larger tiles that reach beyond the image, of which `tiff` 0.11 cannot read some (its issue 395).
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_lzw_tiles_beyond_the_edge_are_read() {
    let folder = Folder::new();
    let text = grid([333, 277], [500_000.0, 4_900_000.0], 30.0, 0);
    folder.write("a.asc", text.as_bytes());
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

/// Files whose least value is white, in each of GDAL's byte orders and in BigTIFF.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_values_are_the_stored_ones_where_white_is_zero() {
    let folder = Folder::new();
    folder.write("a.asc", grid([37, 29], [500_000.0, 4_900_000.0], 30.0, 0).as_bytes());
    for kind in ["Byte", "UInt16", "Int16", "Float32"] {
        for packed in ["NONE", "LZW", "DEFLATE"] {
            for layout in ["ENDIANNESS=LITTLE", "ENDIANNESS=BIG", "BIGTIFF=YES", "TILED=YES"] {
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
        let text = grid([9, 7], [500_000.0, 4_900_000.0], 30.0, salt);
        folder.write(&format!("{salt}.asc"), text.as_bytes());
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
    let notes = |name: &str| folder.run_str(&format!("plan {name}")).notes;
    for (name, has_note) in [("plain.tif", false), ("inside.tif", true), ("beside.tif", true)] {
        assert_eq!(notes(name).contains("the mask of this file is not read"), has_note, "{name}");
    }
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
    folder.write("a.asc", grid([9, 7], [500_000.0, 4_900_000.0], 30.0, 0).as_bytes());
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

/// Tiles that GDAL leaves out have the no-data value.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_sparse_tiles_are_voids() {
    let folder = Folder::new();
    let mut text = "ncols 64\nnrows 32\ncellsize 30\nnodata_value -9\n".to_owned();
    for i in 0..64 * 32 {
        text += if i % 64 < 20 { "7 " } else { "-9 " };
    }
    folder.write("half.asc", text.as_bytes());
    let tiles = "-co TILED=YES -co BLOCKXSIZE=16 -co BLOCKYSIZE=16 -co COMPRESS=DEFLATE";
    tool(&folder, &format!("gdal_translate -q -co SPARSE_OK=TRUE {tiles} half.asc sparse.tif"));
    tool(&folder, &format!("gdal_translate -q {tiles} half.asc whole.tif"));
    let [sparse, whole] = ["sparse.tif", "whole.tif"].map(|name| folder.path(name));
    let length = |path: &Path| std::fs::metadata(path).unwrap().len();
    assert!(length(&sparse) < length(&whole), "GDAL left out no tile");
    let read = |path| read_field(path, &HeightOptions::default()).unwrap().field;
    assert_eq!(read(&sparse), read(&whole));
    assert_eq!(read(&sparse).voids().unwrap().iter().filter(|v| **v).count(), 44 * 32);
}

/// Cuts a field into tiles, some of which overlap, and leaves out one corner.
fn tiles_of(folder: &Folder, extra: &str) -> [&'static str; 4] {
    let text = grid([60, 50], [500_000.0, 4_900_000.0], 30.0, 1);
    folder.write("whole.asc", text.as_bytes());
    let srs = "-q -ot Int16 -a_srs EPSG:32618";
    tool(folder, &format!("gdal_translate {srs} {extra} whole.asc whole.tif"));
    let windows = ["0 0 30 25", "28 0 32 25", "0 25 30 20", "30 25 20 20"];
    let names = ["t0.tif", "t1.tif", "t2.tif", "t3.tif"];
    for (window, name) in windows.iter().zip(names) {
        tool(folder, &format!("gdal_translate -q -srcwin {window} whole.tif {name}"));
    }
    names
}

/// GDAL's mosaic of the same files, and of a box of it: same values, voids and positions.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_mosaics_and_boxes_have_the_same_values_and_positions() {
    let boxes = [
        None,
        // On edges of cells; across a gap; one cell.
        Some([500_300.0, 4_900_300.0, 501_200.0, 4_901_200.0]),
        Some([500_900.0, 4_900_150.0, 501_800.0, 4_900_600.0]),
        Some([501_170.0, 4_900_900.0, 501_200.0, 4_900_930.0]),
    ];
    for extra in ["", "-mo AREA_OR_POINT=Point"] {
        let folder = Folder::new();
        let names = tiles_of(&folder, extra);
        tool(&folder, &format!("gdalbuildvrt -q -vrtnodata -9999 all.vrt {}", names.join(" ")));
        for bbox in boxes {
            let window = match bbox {
                Some([west, south, east, north]) => {
                    format!(" -projwin {west} {north} {east} {south}")
                }
                None => String::new(),
            };
            tool(&folder, &format!("gdal_translate -q{window} all.vrt expected.tif"));
            let expected = gdal_values(&folder.path("expected.tif"));
            let options = HeightOptions { bbox, ..Default::default() };
            let paths = names.map(|name| folder.path(name));
            let read = ridgelight_io::read_mosaic(&paths, &options).unwrap();
            let heights = absolute(&read.field);
            let voids = read.field.voids();
            assert_eq!(heights.len(), expected.len(), "{bbox:?}");
            for (i, (height, expected)) in heights.iter().zip(&expected).enumerate() {
                let is_void = voids.is_some_and(|voids| voids[i]);
                assert_eq!(is_void, *expected == -9999.0, "{bbox:?}: {i}");
                assert!(is_void || height == expected, "{bbox:?}: {i}");
            }
            let at = read.georeference.unwrap();
            let info = gdalinfo(&folder.path("expected.tif"));
            assert_eq!(
                info["geoTransform"],
                json!([at.corner[0], 30.0, 0.0, at.corner[1], 0.0, -30.0])
            );
        }
    }
}

/// Outputs of commands lie where GDAL's part of the mosaic lies.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_finds_outputs_of_a_mosaic_in_place() {
    let folder = Folder::new();
    let names = tiles_of(&folder, "").join(" ");
    tool(&folder, "gdal_translate -q -projwin 500300 4901200 501200 4900300 whole.tif part.tif");
    let part = gdalinfo(&folder.path("part.tif"));
    let bbox = "--bbox 500300,4900300,501200,4901200 --azimuths 8";
    done(&folder, &format!("render {names} {bbox} --sky 0.5 -o o.tif"));
    done(&folder, &format!("render {names} {bbox} --sky 0.5 -o o.png"));
    let horizon = succeeded(&folder, &format!("horizon {names} {bbox} -o h.tif"));
    let said = "read without the ground outside --bbox, which casts no shadow into it";
    assert!(horizon.notes.contains(said), "{}", horizon.notes);
    done(&folder, &format!("bake {names} {bbox} --what sky-view --format tif -o baked"));
    done(
        &folder,
        &format!("reference {names} --bbox 500300,4900300,501200,4901200 --spp 128 -o r.tif"),
    );
    for name in ["o.tif", "h.tif", "baked/sky_view.tif", "r.tif", "o.png"] {
        let info = gdalinfo(&folder.path(name));
        assert_eq!(info["geoTransform"], part["geoTransform"], "{name}");
        assert_eq!(info["size"], part["size"], "{name}");
    }
    // Nothing of the field outside the box is left: the same picture as of GDAL's part.
    done(&folder, "render part.tif --azimuths 8 --sky 0.5 -o p.tif");
    assert_eq!(gdal_values(&folder.path("o.tif")), gdal_values(&folder.path("p.tif")));
}

/// Tiles of SRTM share the grid points of their edges.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_joins_srtm_tiles_as_we_do() {
    let folder = Folder::new();
    let names = ["N44W072.hgt", "N44W071.hgt", "N45W072.hgt"];
    // Of 1201 x 1201 points, and the height of a point follows from its place on Earth.
    for (name, [south, west]) in names.iter().zip([[0_u64, 0], [0, 1], [1, 0]]) {
        let place = |i: u64| [south * 1200 + 1200 - i / 1201, west * 1200 + i % 1201];
        let height = |[y, x]: [u64; 2]| ((7 * y + 3 * x) % 2000) as u16;
        let bytes: Vec<u8> =
            (0..1201 * 1201).flat_map(|i| height(place(i)).to_be_bytes()).collect();
        folder.write(name, &bytes);
    }
    tool(&folder, &format!("gdalbuildvrt -q -vrtnodata -32768 all.vrt {}", names.join(" ")));
    let expected = gdal_values(&folder.path("all.vrt"));
    let paths = names.map(|name| folder.path(name));
    let read = ridgelight_io::read_mosaic(&paths, &HeightOptions::default()).unwrap();
    assert_eq!((read.field.rows(), read.field.cols()), (2401, 2401));
    let voids = read.field.voids().unwrap();
    let heights = absolute(&read.field);
    for (i, expected) in expected.iter().enumerate() {
        assert!(
            voids[i] == (*expected == -32768.0) && (voids[i] || heights[i] == *expected),
            "{i}"
        );
    }
    let transform = gdalinfo(&folder.path("all.vrt"))["geoTransform"].clone();
    let at = read.georeference.unwrap();
    for (k, own) in [(0, at.corner[0]), (3, at.corner[1]), (1, at.cell[0])] {
        assert!((transform[k].as_f64().unwrap() - own).abs() < 1e-9, "{transform}");
    }
    assert!(!read.notes.iter().any(|note| note.contains("differ")), "{:?}", read.notes);
    assert!(read.notes.iter().any(|note| note.contains("24.9")), "{:?}", read.notes);
}

#[test]
fn a_scene_file_lists_the_files_of_a_field_and_its_box() {
    let folder = Folder::new();
    for (name, west) in [("t0.asc", 0.0), ("t1.asc", 150.0)] {
        folder.write(name, grid([5, 4], [5e5 + west, 4.9e6], 30.0, 0).as_bytes());
    }
    let scene = r#"{ "field": { "file": ["t0.asc", "t1.asc"], "bbox": [500030, 4900000, 500300, 4900060] } }"#;
    folder.write("scene.json", scene.as_bytes());
    let [own, of_scene] =
        ["t0.asc t1.asc --bbox 500030,4900000,500300,4900060", "--scene scene.json"].map(|args| {
            let run = folder.run_str(&format!("info {args} --json i.json"));
            assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{args}");
            std::fs::read_to_string(folder.path("i.json")).unwrap()
        });
    assert_eq!(own, of_scene);
    let facts: serde_json::Value = serde_json::from_str(&own).unwrap();
    assert_eq!((&facts["cols"], &facts["rows"]), (&json!(9), &json!(2)));
    assert_eq!(facts["extent"], json!([500_030.0, 4_900_000.0, 500_300.0, 4_900_060.0]));
    std::fs::remove_file(folder.path("i.json")).unwrap();
    crate::refused(
        &folder,
        &[
            ("plan t0.asc a.npy", 1, &["a.npy", "georeference"]),
            ("plan a.npy --bbox 0,0,1,1", 1, &["a.npy", "georeference", "--bbox"]),
            (
                "plan t0.asc --bbox 0,0,1,1",
                2,
                &["--bbox", "extent is 500000,4900000,500150,4900120"],
            ),
            ("plan t0.asc --bbox 1,0,0,1", 2, &["--bbox", "each minimum below its maximum"]),
            ("plan t0.asc --bbox 1,2,3", 2, &["--bbox: found 1,2,3, expected XMIN"]),
            ("render t0.asc t1.asc -o t1.asc.png --json t1.asc", 2, &["--json"]),
        ],
    );
}

/// Grey of 8 and of 16 bits, without and with a transparent grey, which marks voids.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_pngs_have_the_values_that_gdal_reads() {
    let folder = Folder::new();
    folder.write("a.asc", grid([37, 29], [500_000.0, 4_900_000.0], 30.0, 0).as_bytes());
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

/// A grid in text has the corner of its first cell or its centre in its header, and one cell size or two.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_places_grids_in_text_where_we_do() {
    let folder = Folder::new();
    // Metres and degrees, exact in binary.
    for ([west, south], cell) in [([500_000.0, 4_900_000.0], 30.0), ([7.5, -46.25], 0.03125)] {
        let of_corner = grid([5, 4], [west, south], cell, 0);
        let [x, y] = [west, south].map(|corner| corner + cell / 2.0);
        let of_centre = of_corner
            .replace(&format!("xllcorner {west}"), &format!("xllcenter {x}"))
            .replace(&format!("yllcorner {south}"), &format!("yllcenter {y}"));
        let sides = format!("dx {cell}\ndy {}", 2.0 * cell);
        let of_two = of_centre.replace(&format!("cellsize {cell}"), &sides);
        assert!(of_centre != of_corner && of_two != of_centre);
        let north = south + 4.0 * cell;
        // Four rows of twice the height; the southern corner is half a row below the centre.
        let north_of_two = y - cell + 8.0 * cell;
        for (text, north) in [(of_corner, north), (of_centre, north), (of_two, north_of_two)] {
            folder.write("placed.asc", text.as_bytes());
            let path = folder.path("placed.asc");
            let read = read_field(&path, &HeightOptions::default()).unwrap();
            let at = read.georeference.unwrap();
            assert_eq!(at.corner, [west, north], "{text}");
            let [width, height] = at.cell;
            let own = json!([at.corner[0], width, 0.0, at.corner[1], 0.0, -height]);
            assert_eq!(gdalinfo(&path)["geoTransform"], own, "{text}");
            assert!(absolute(&read.field) == gdal_values(&path), "{text}");
        }
    }
}

/// The directions of grid north, by GDAL's coordinates of two points, and cells in feet.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_agrees_on_grid_north_and_on_feet() {
    let folder = Folder::new();
    // UTM in both hemispheres, two Lambert conics, the British grid, a polar stereographic.
    let places = [
        (32618, [700_000.0, 4_900_000.0], 1.0),
        (32718, [300_000.0, 6_900_000.0], 1.0),
        (2263, [1_200_000.0, 200_000.0], 1200.0 / 3937.0),
        (2265, [1_500_000.0, 400_000.0], 0.3048),
        (2154, [900_000.0, 6_500_000.0], 1.0),
        (27700, [300_000.0, 200_000.0], 1.0),
        (3413, [-600_000.0, -1_500_000.0], 1.0),
    ];
    for (code, [x, y], unit) in places {
        folder.write("a.asc", grid([4, 4], [x - 60.0, y - 60.0], 30.0, 0).as_bytes());
        tool(&folder, &format!("gdal_translate -q -a_srs EPSG:{code} a.asc a.tif"));
        let run = folder.run_str("info a.tif --json i.json");
        assert_eq!(run.status, Some(0), "{}", run.err);
        let facts = std::fs::read_to_string(folder.path("i.json")).unwrap();
        let facts: serde_json::Value = serde_json::from_str(&facts).unwrap();
        let cell = facts["cell_m"][0].as_f64().unwrap();
        assert!((cell / (30.0 * unit) - 1.0).abs() < 1e-9, "{code}: {cell}");
        // The geographic system of the same datum, by name: no shift.
        let ellipsoid = geographic(&folder, code);
        let place = |y: f64| degrees_of(code, &ellipsoid, [x, y]);
        let ([west, south], [east, north]) = (place(y - 500.0 / unit), place(y + 500.0 / unit));
        // The radii of the ellipsoids of these systems differ by less than 2e-4, their ratio by 1e-5.
        let phi = ((south + north) / 2.0).to_radians();
        let squared = 1.0 - 0.006_694_38 * phi.sin().powi(2);
        let radii = squared / (1.0 - 0.006_694_38);
        let expected = ((east - west) * phi.cos() * radii).atan2(north - south).to_degrees();
        let notes = facts["notes"].to_string();
        let side = if expected > 0.0 { "east" } else { "west" };
        let sign = if expected > 0.0 { '+' } else { '-' };
        let note = format!(
            "grid north, {0:.2} degrees {side} of true north at the centre: true azimuth = azimuth here {sign} {0:.2} degrees",
            expected.abs()
        );
        assert!(notes.contains(&note), "{code}: {note} is not in {notes}");
        assert_eq!(notes.contains("cells are in units of"), unit != 1.0, "{notes}");
        assert_eq!(notes.contains("heights are read as metres"), unit != 1.0, "{notes}");
    }
}

/// The distance on the ellipsoid between two points that are a cell of Web Mercator apart, by GDAL's coordinates of them.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_agrees_on_the_metres_of_web_mercator() {
    let folder = Folder::new();
    let (equator_m, flattening) = (6_378_137.0, 1.0 / 298.257_223_563);
    let squared: f64 = flattening * (2.0 - flattening);
    // North, south and on the equator, and where the projection enlarges by 2.9.
    for [x, y] in [[1.5e6, 5_621_471.0], [-1.3e7, -4e6], [2e6, 0.0], [-5e5, 1.1e7]] {
        folder.write("a.asc", grid([4, 4], [x - 60.0, y - 60.0], 30.0, 0).as_bytes());
        tool(&folder, "gdal_translate -q -a_srs EPSG:3857 a.asc a.tif");
        succeeded(&folder, "info a.tif --json i.json");
        let facts = crate::needs_vulkan::json(&folder.path("i.json"));
        let place = |x: f64, y: f64| degrees_of(3857, "EPSG:4326", [x, y]);
        let ([west, _], [east, _]) = (place(x - 15.0, y), place(x + 15.0, y));
        let ([_, south], [_, north]) = (place(x, y - 15.0), place(x, y + 15.0));
        let phi = place(x, y)[1].to_radians();
        // The radius of the parallel and of curvature of the meridian, in the middle: their change over a cell cancels.
        let w = (1.0 - squared * phi.sin().powi(2)).sqrt();
        let radii = [equator_m * phi.cos() / w, equator_m * (1.0 - squared) / w.powi(3)];
        for (axis, degrees) in [east - west, north - south].into_iter().enumerate() {
            let expected = radii[axis] * degrees.to_radians();
            let found = facts["cell_m"][axis].as_f64().unwrap();
            // The series for a degree is within 0.1 m of these radii, as heights/raster.rs tests. gdaltransform prints 15
            // digits: of 180 degrees 1e-12 degrees, or 1e-7 m, for each of two points.
            let bound = 0.1 * degrees + 2e-7;
            assert!((found - expected).abs() < bound, "{x}, {y}: {found} for {expected}");
            // The comparison can fail: metres on a sphere are beyond the bound, but for the equator's.
            assert!((30.0 * phi.cos() - expected).abs() > 10.0 * bound || axis == 0 && y == 0.0);
        }
    }
}

/// Longitude and latitude by GDAL of a position in a system of the EPSG registry.
fn degrees_of(code: u32, geographic: &str, [x, y]: [f64; 2]) -> [f64; 2] {
    let command = format!("echo {x} {y} | gdaltransform -s_srs EPSG:{code} -t_srs '{geographic}'");
    let output = Command::new("sh").args(["-c", &command]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let numbers: Vec<f64> = text.split_whitespace().map(|n| n.parse().unwrap()).collect();
    [numbers[0], numbers[1]]
}

/// Longitude and latitude on the ellipsoid of a projected system, as PROJ's text.
fn geographic(folder: &Folder, code: u32) -> String {
    let mut command = Command::new("gdalsrsinfo");
    command.current_dir(folder.path("")).args(["-o", "proj4", &format!("EPSG:{code}")]);
    let text = String::from_utf8(command.output().unwrap().stdout).unwrap();
    let is_figure = |term: &&str| term.starts_with("+datum") || term.starts_with("+ellps");
    let figure: Vec<&str> = text.split_whitespace().filter(is_figure).collect();
    format!("+proj=longlat {} +no_defs", figure.join(" "))
}
