//! The table of input files in docs/command-line.md. What can be read off a file of each format is.

use crate::formats;
use ridgelight_io::{HeightOptions, parse_heights, read_field};

/// A format whose files differ only in what follows.
struct Row {
    file: &'static str,
    /// Its name among the files of the tests.
    example: &'static str,
    heights: &'static str,
    nodata: &'static str,
    unit: &'static str,
    /// What tests compare, and with what: GDAL (`gdal_...` in gdal_inputs.rs and gdal_positions.rs), NumPy (`numpy_...` in python.rs)
    /// or OpenEXR (validators.rs).
    compared: &'static str,
}

const ROWS: [Row; 7] = [
    Row {
        file: "`.tif`, `.tiff`",
        example: "utm.tif",
        heights: "a band of 8- to 64-bit integers or 16- to 64-bit floats, with GDAL's scale and offset; strips or tiles; \
                  uncompressed, LZW, DEFLATE, Zstandard or PackBits, any predictor; BigTIFF",
        nodata: "GDAL's tag",
        unit: "unit of the band, vertical unit, or feet by vertical EPSG code",
        compared: "values, bands and their units, no data, position, feet, Web Mercator, grid north",
    },
    Row {
        file: "`.hgt`",
        example: "N44W072.hgt",
        heights: "16-bit integers; the name gives the corner",
        nodata: "-32768",
        unit: "metres",
        compared: "values, position",
    },
    Row {
        file: "`.asc`",
        example: "a.asc",
        heights: "text",
        nodata: "header",
        unit: "metres",
        compared: "values, no data, position",
    },
    Row {
        file: "`.npy`",
        example: "a.npy",
        heights: "2-D, or a plane of 3-D; integers or floats of any size",
        nodata: "no",
        unit: "metres",
        compared: "values",
    },
    Row {
        file: "`.npz`",
        example: "a.npz",
        heights: "the array `elevation`, `heights`, `height`, `z`, or the only one; `dx` and `dy`; degrees if `xmin`, `xmax`, `ymin` and `ymax` are longitudes and latitudes, and cells are below 0.1 or the grid spans the Earth",
        nodata: "no",
        unit: "metres",
        compared: "values, cell size",
    },
    Row {
        file: "`.exr`",
        example: "a.exr",
        heights: "the channel `height`, `elevation`, `Z`, `Y` or `R`, or the only one",
        nodata: "no",
        unit: "metres",
        compared: "values",
    },
    Row {
        file: "`.png`",
        example: "a.png",
        heights: "grey of 8 or 16 bits",
        nodata: "alpha 0, or a transparent grey",
        unit: "metres",
        compared: "values, voids",
    },
];

fn table() -> String {
    let files = formats::height_files();
    let folder = tempfile::tempdir().unwrap();
    let names = "file | heights | cell size | position | reference system | no data | unit of height | compared with GDAL, NumPy or OpenEXR";
    let mut table = format!("\n| {names} |\n|{}\n", "---|".repeat(8));
    for row in &ROWS {
        let utm = include_bytes!("../../../../../tests/files/gdal/utm.tif");
        let found = files.iter().find(|file| file.0 == row.example);
        let bytes = found.map_or(utm.as_slice(), |file| file.1.as_slice());
        let path = folder.path().join(row.example);
        std::fs::write(&path, bytes).unwrap();
        let read = read_field(&path, &HeightOptions::default()).unwrap();
        let yes_or_no = |is_it| if is_it { "yes" } else { "no" };
        let at = read.georeference;
        let cells = [
            row.file,
            row.heights,
            yes_or_no(read.field.cell_m() != [1.0, 1.0]),
            yes_or_no(at.is_some()),
            yes_or_no(at.is_some_and(|at| at.keys.crs().is_some())),
            row.nodata,
            row.unit,
            row.compared,
        ];
        table += &format!("| {} |\n", cells.join(" | "));
    }
    table + "\n"
}

#[test]
fn the_page_of_the_command_line_lists_the_input_files() {
    // Every format of the tests has its row.
    for (name, _) in formats::height_files() {
        let extension = name.rsplit('.').next().unwrap();
        assert!(ROWS.iter().any(|row| row.example.ends_with(extension)), "{name}");
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/command-line.md");
    let page = std::fs::read_to_string(path).unwrap();
    let (before, rest) = page.split_once("<!-- begin inputs -->\n").unwrap();
    let (_, after) = rest.split_once("<!-- end inputs -->").unwrap();
    let text = [before, "<!-- begin inputs -->\n", &table(), "<!-- end inputs -->", after].concat();
    if std::env::var_os("RIDGELIGHT_BLESS").is_some_and(|v| v == "1") {
        std::fs::write(path, &text).unwrap();
    }
    let kept = std::fs::read_to_string(path).unwrap();
    assert!(kept == text, "docs/command-line.md is out of date: RIDGELIGHT_BLESS=1 writes it");
}

/// The column of no data: a file of each format that has one marks one grid point.
#[test]
fn each_no_data_of_the_table_makes_a_void() {
    let tile: Vec<u8> = [1_i16, -32768, 3, 4].iter().flat_map(|h| h.to_be_bytes()).collect();
    let grey: [(&[u8; 4], &[u8]); 1] = [(b"tRNS", &[0, 7])];
    for (name, bytes) in [
        ("N44W072.hgt", tile),
        ("a.asc", b"ncols 2 nrows 1 cellsize 1 nodata_value 7 7 5".to_vec()),
        ("a.png", formats::png(2, 1, formats::colour::GREY, 8, &grey, &[7, 5])),
    ] {
        let field = parse_heights(name.as_ref(), &bytes, &HeightOptions::default()).unwrap();
        let voids = field.voids().unwrap_or_else(|| panic!("{name}"));
        assert_eq!(voids.iter().filter(|v| **v).count(), 1, "{name}");
    }
}
