//! What readers note and warn of, and the units by which they convert heights.

use crate::formats::*;
use crate::{absolute, one_sentence, parse};
use ridgelight_io::{FieldFile, HeightOptions, read_field, read_mosaic};
use tiff::encoder::{Compression, colortype};
use tiff::tags::Predictor;

/// A north-up grid with cells of 30 x 20 units.
const SCALE: (u16, Tag) = (33550, Tag::Doubles(&[30.0, 20.0, 0.0]));
const TIE: (u16, Tag) = (33922, Tag::Doubles(&[0.0, 0.0, 0.0, 500_000.0, 4_900_000.0, 0.0]));
/// The directory of GeoKeys.
const KEYS: u16 = 34735;
/// GDAL's metadata.
const METADATA: u16 = 42112;

/// A TIFF of the heights with tags.
fn with(tags: &[(u16, Tag)]) -> Vec<u8> {
    let (none, plain) = (Predictor::None, Compression::Uncompressed);
    tiff::<colortype::Gray32Float>(4, 3, &HEIGHTS.map(f32::from), plain, none, tags)
}

fn item(name: &str, text: &str) -> String {
    let role = name.to_lowercase();
    format!(
        "<GDALMetadata><Item name=\"{name}\" sample=\"0\" role=\"{role}\">{text}</Item></GDALMetadata>"
    )
}

fn read_bytes(bytes: &[u8], name: &str, options: &HeightOptions) -> FieldFile {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    read_field(&path, options).unwrap_or_else(|error| panic!("{error}"))
}

fn read(bytes: &[u8]) -> FieldFile {
    read_bytes(bytes, "a.tif", &HeightOptions::default())
}

/// The unit of the band comes before that of the vertical system; a name that is not known is in a warning.
#[test]
fn the_unit_of_the_band_converts_heights() {
    const UTM: [u16; 12] = [1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 32618];
    let survey = 1200.0 / 3937.0;
    let differs =
        "the band's unit is ft, but that of the vertical system is 1 m: heights are read in ft";
    let no_unit = "the band's unit \"degrees\" is not known: heights are read as metres";
    let of_system = format!("heights are read in units of {survey} m, that of the vertical system");
    for (name, vertical, unit, said) in [
        ("ft", None, 0.3048, ""),
        ("US survey foot", None, survey, ""),
        ("m", None, 1.0, ""),
        ("", None, 1.0, ""),
        ("", Some(6360), survey, ""),
        ("degrees", None, 1.0, no_unit),
        ("ft", Some(5703), 0.3048, differs),
        ("ft", Some(8050), 0.3048, ""),
        ("degrees", Some(6360), survey, of_system.as_str()),
    ] {
        let mut keys = UTM.to_vec();
        if let Some(code) = vertical {
            keys[3] = 3;
            keys.extend([4096, 0, 1, code]);
        }
        let text = item("UNITTYPE", name);
        let read =
            read(&with(&[SCALE, TIE, (KEYS, Tag::Shorts(&keys)), (METADATA, Tag::Text(&text))]));
        // A height of 100, whose offset from the median is rounded to f32.
        let height = absolute(&read.field)[8];
        let error = (height - 100.0 * unit).abs();
        assert!(error < 100.0 * f64::from(f32::EPSILON), "{name} {vertical:?}: {height}");
        let [notes, warnings] = [read.notes, read.warnings].map(|all| all.join("\n"));
        let note = format!("heights are in units of {unit} m and become metres");
        assert_eq!(notes.contains(&note), unit != 1.0, "{name} {vertical:?}: {notes}");
        assert_eq!(warnings.is_empty(), said.is_empty(), "{name} {vertical:?}: {warnings}");
        assert!(warnings.contains(said), "{name} {vertical:?}: {warnings}");
    }
}

/// Heights without a unit over cells in feet: the warning names both units, unless the caller knows that of the heights.
#[test]
fn a_known_unit_of_heights_needs_no_warning() {
    let us = "heights are read as metres, but the cells are in US survey feet: if the heights are too, use \
              `z_scale 0.3048006096012192`; if they are metres, `z_scale 1`";
    let feet = "heights are read as metres, but the cells are in feet: if the heights are too, use \
                `z_scale 0.3048`; if they are metres, `z_scale 1`";
    for (unit, said) in [(9003, us), (9002, feet)] {
        let keys = [1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, unit];
        let bytes = with(&[SCALE, TIE, (KEYS, Tag::Shorts(&keys))]);
        assert_eq!(read(&bytes).warnings, [said]);
        let known = HeightOptions { is_unit_known: true, ..HeightOptions::default() };
        assert_eq!(read_bytes(&bytes, "a.tif", &known).warnings, Vec::<String>::new());
        // A band in feet states its unit; one in degrees gets the warning of its name alone.
        let [ft, other] = ["ft", "degrees"].map(|name| {
            let text = item("UNITTYPE", name);
            let tags = [SCALE, TIE, (KEYS, Tag::Shorts(&keys)), (METADATA, Tag::Text(&text))];
            let bytes = with(&tags);
            (read(&bytes).warnings, read_bytes(&bytes, "a.tif", &known).warnings)
        });
        assert_eq!([ft.0.len(), ft.1.len(), other.0.len(), other.1.len()], [0, 0, 1, 0]);
        assert!(other.0[0].contains("\"degrees\" is not known"), "{:?}", other.0);
    }
}

/// Cells in the unit of a `.prj` beside the file become metres, with a note. Heights do not: the warning states that, unless
/// the file states their unit.
#[test]
fn cells_in_the_unit_of_a_prj_get_a_note() {
    let prj = |unit: &str| {
        format!(
            r#"PROJCS["mine",GEOGCS["x",UNIT["Degree",0.0174532925199433]],PROJECTION["y"],UNIT[{unit}]]"#
        )
    };
    let [metre, foot] = [r#""Meter",1.0"#, r#""Foot",0.3048"#].map(prj);
    let folder = tempfile::tempdir().unwrap();
    let text = "ncols 2\nnrows 2\nxllcorner 1000\nyllcorner 2000\ncellsize 30\n1 2\n3 4\n";
    std::fs::write(folder.path().join("a.asc"), text).unwrap();
    let metres = item("UNITTYPE", "metre");
    std::fs::write(folder.path().join("open.tif"), with(&[SCALE, TIE])).unwrap();
    let stated = with(&[SCALE, TIE, (METADATA, Tag::Text(&metres))]);
    std::fs::write(folder.path().join("stated.tif"), stated).unwrap();
    let note = "cells are in units of 0.3048 m and become metres";
    let warning = "heights are read as metres, but the cells are in feet: if the heights are too, use \
                   `z_scale 0.3048`; if they are metres, `z_scale 1`";
    for (name, text, unit_m, is_open) in [
        ("a.asc", &metre, 1.0, true),
        ("a.asc", &foot, 0.3048, true),
        ("open.tif", &metre, 1.0, true),
        ("open.tif", &foot, 0.3048, true),
        ("stated.tif", &foot, 0.3048, false),
    ] {
        let path = folder.path().join(name);
        std::fs::write(path.with_extension("prj"), text).unwrap();
        let read = |is_unit_known| {
            let options = HeightOptions { is_unit_known, ..HeightOptions::default() };
            read_field(&path, &options).unwrap()
        };
        let [open, known] = [false, true].map(read);
        let cell = open.field.cell_m()[0];
        assert!((cell / (30.0 * unit_m) - 1.0).abs() < 1e-12, "{name}: {cell}");
        let is_feet = unit_m != 1.0;
        let count = |all: &[String], text: &str| all.iter().filter(|one| *one == text).count();
        assert_eq!(count(&open.notes, note), usize::from(is_feet), "{name}: {:?}", open.notes);
        let warned = usize::from(is_feet && is_open);
        assert_eq!(count(&open.warnings, warning), warned, "{name}: {:?}", open.warnings);
        assert_eq!(count(&known.warnings, warning), 0, "{name}: {:?}", known.warnings);
        assert_eq!(open.field.heights_m(), known.field.heights_m(), "{name}");
    }
}

/// The note on cells in feet is on those of the file: there is none where the caller replaces them. A mosaic has one.
#[test]
fn cells_that_are_replaced_get_no_note() {
    let folder = tempfile::tempdir().unwrap();
    let foot = r#"PROJCS["mine",GEOGCS["x",UNIT["Degree",0.0174532925199433]],PROJECTION["y"],UNIT["Foot",0.3048]]"#;
    let [west, east] = [("west", 1000), ("east", 1060)].map(|(name, x)| {
        let path = folder.path().join(name).with_extension("asc");
        let head = format!("ncols 2\nnrows 2\nxllcorner {x}\nyllcorner 2000\ncellsize 30\n");
        std::fs::write(&path, head + "1 2\n3 4\n").unwrap();
        std::fs::write(path.with_extension("prj"), foot).unwrap();
        path
    });
    let tif = folder.path().join("a.tif");
    let keys = [1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9002];
    std::fs::write(&tif, with(&[SCALE, TIE, (KEYS, Tag::Shorts(&keys))])).unwrap();
    let note = "cells are in units of 0.3048 m and become metres";
    for paths in [vec![tif], vec![west.clone()], vec![west, east]] {
        for cell_m in [None, Some([2.0, 3.0])] {
            let options = HeightOptions { cell_m, ..HeightOptions::default() };
            let read = read_mosaic(&paths, &options).unwrap();
            let count = read.notes.iter().filter(|one| *one == note).count();
            assert_eq!(count, usize::from(cell_m.is_none()), "{paths:?}: {:?}", read.notes);
            let is_replaced = read.field.cell_m() == [2.0, 3.0];
            assert_eq!(is_replaced, cell_m.is_some(), "{paths:?}");
        }
    }
}

/// The no-data value of the file stays in the heights where another replaces it: the warning counts them.
#[test]
fn a_replaced_no_data_value_is_counted() {
    let grid = |west: u32, heights: &str| {
        format!(
            "ncols 4\nnrows 1\nxllcorner {west}\nyllcorner 0\ncellsize 30\nnodata_value -32768\n{heights}"
        )
    };
    let [one, two] = [(1000, "-32768 2 -9999 4"), (1120, "-32768 2 3 -32768")]
        .map(|(west, heights)| grid(west, heights));
    let of = |nodata| HeightOptions { nodata, ..HeightOptions::default() };
    let warnings = |nodata| read_bytes(one.as_bytes(), "a.asc", &of(nodata)).warnings;
    let once = "`nodata -9999` replaces the file's -32768, which 1 height has";
    assert_eq!(warnings(Some(-9999.0)), [once]);
    assert_eq!(warnings(Some(-32768.0)), Vec::<String>::new());
    // The file has another value that often marks voids.
    let likely = "1 height is -9999, which often marks a void, and the file does not state it as no data; `nodata` -9999 makes \
                  voids of them";
    assert_eq!(warnings(None), [likely]);
    // Files of a mosaic count together.
    let folder = tempfile::tempdir().unwrap();
    let paths = [("one.asc", &one), ("two.asc", &two)].map(|(name, text)| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    });
    let all = "`nodata -9999` replaces the file's -32768, which 3 heights have";
    assert_eq!(read_mosaic(&paths, &of(Some(-9999.0))).unwrap().warnings, [all]);
    assert_eq!(read_mosaic(&paths, &of(Some(-32768.0))).unwrap().warnings, Vec::<String>::new());
    // A file whose heights do not have its value.
    let none = read_bytes(grid(1000, "1 2 3 -9999").as_bytes(), "a.asc", &of(Some(-9999.0)));
    assert_eq!(none.warnings, Vec::<String>::new());
}

/// The note on cells names the unit that they come from; a warning states that the unit is a guess.
#[test]
fn the_note_on_cells_names_their_unit() {
    const SMALL: (u16, Tag) = (33550, Tag::Doubles(&[0.01, 0.01, 0.0]));
    const NORTH: (u16, Tag) = (33922, Tag::Doubles(&[0.0, 0.0, 0.0, 10.0, 60.015, 0.0]));
    let wgs84 = [1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326];
    let mercator = [1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 3857];
    let guess = "no reference system: read as degrees, as its numbers fit; otherwise use `cell_m`";
    let degrees = "m, from degrees at latitude 60.00";
    let metres = "m, from Web Mercator metres at latitude 40.";
    for (bytes, said, is_guess) in [
        (with(&[SMALL, NORTH]), degrees, true),
        (with(&[SMALL, NORTH, (KEYS, Tag::Shorts(&wgs84))]), degrees, false),
        (with(&[SCALE, TIE, (KEYS, Tag::Shorts(&mercator))]), metres, false),
    ] {
        let read = read(&bytes);
        let count = read.notes.iter().filter(|note| note.contains(said)).count();
        assert_eq!(count, 1, "{:?}", read.notes);
        let guesses = read.warnings.iter().any(|warning| warning == guess);
        assert_eq!(guesses, is_guess, "{said}: {:?}", read.warnings);
    }
}

#[test]
fn a_scale_and_an_offset_get_a_note() {
    let of = |name, text| {
        let text = item(name, text);
        let read = read(&with(&[SCALE, TIE, (METADATA, Tag::Text(&text))]));
        (absolute(&read.field)[8], read.notes)
    };
    let (height, notes) = of("OFFSET", "100");
    assert_eq!(
        (height, notes),
        (200.0, vec!["scale 1 and offset 100 of the file are applied".to_owned()])
    );
    let (height, notes) = of("SCALE", "0.5");
    assert_eq!(
        (height, notes),
        (50.0, vec!["scale 0.5 and offset 0 of the file are applied".to_owned()])
    );
    assert_eq!(of("OFFSET", "0").1, Vec::<String>::new());
}

/// A file that is shorter than its uncompressed values is called cut off, with both sizes.
#[test]
fn the_sizes_of_a_file_that_is_cut_off_are_named() {
    let mut bytes = with(&[]);
    let directory = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    // 300 rows in one strip: ImageLength and RowsPerStrip, each a long.
    for tag in [257_u16, 278] {
        let mut all = (0..).map(|i| directory + 2 + 12 * i);
        let at = all.find(|at| bytes[*at..at + 2] == tag.to_le_bytes()).unwrap();
        let value = [&4_u16.to_le_bytes()[..], &1_u32.to_le_bytes(), &300_u32.to_le_bytes()];
        bytes[at + 2..at + 12].copy_from_slice(&value.concat());
    }
    let error = parse("a.tif", &bytes).unwrap_err().to_string();
    one_sentence(&error, "a.tif");
    let held = bytes.len();
    let said =
        format!("found a file that is cut off: 4800 bytes of values in a file of {held} bytes");
    assert!(error.contains(&said), "{error}");
}
