//! Height files written by GDAL: their positions are those that GDAL reads, for single files and for mosaics.

use super::gdal_inputs::{absolute, grid, tool};
use super::geotiff::{gdal_values, gdalinfo};
use crate::Folder;
use crate::needs_vulkan::done;
use crate::succeeded;
use ridgelight_io::{HeightOptions, read_field};
use serde_json::json;
use std::process::Command;

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

/// `info` states the reference system and the extent that GDAL states: projected, geographic, and none.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_and_info_state_the_same_reference_system_and_extent() {
    let folder = Folder::new();
    folder.write("plain.asc", grid([8, 6], [500_000.0, 4_900_000.0], 30.0, 1).as_bytes());
    for (epsg, place) in [
        (Some(32618), ""),
        (Some(2056), ""),
        (Some(3857), ""),
        (Some(4326), "-a_ullr -71 45 -70.92 44.94"),
        (None, ""),
    ] {
        let srs = epsg.map_or(String::new(), |epsg| format!("-a_srs EPSG:{epsg}"));
        tool(&folder, &format!("gdal_translate -q {srs} {place} plain.asc at.tif"));
        let run = folder.run_without_driver(&["info", "at.tif", "--json", "-"]);
        assert_eq!(run.status, Some(0), "{}", run.err);
        let ours: serde_json::Value = serde_json::from_str(&run.out).unwrap();
        let gdal = gdalinfo(&folder.path("at.tif"));
        assert_eq!(gdal["stac"]["proj:epsg"], json!(epsg), "{epsg:?}");
        let code = epsg.map(|epsg| format!("EPSG:{epsg}"));
        assert_eq!(ours["crs"], json!(code), "{epsg:?}");
        let [low, high] = ["lowerLeft", "upperRight"].map(|at| &gdal["cornerCoordinates"][at]);
        for (k, edge) in [&low[0], &low[1], &high[0], &high[1]].into_iter().enumerate() {
            // gdalinfo prints seven decimals.
            let error = ours["extent"][k].as_f64().unwrap() - edge.as_f64().unwrap();
            assert!(error.abs() < 1e-7, "{epsg:?}: edge {k}: {error}");
        }
    }
}

/// A field across longitude 180, whose files GDAL places at both ends of the map.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_tiles_beside_the_antimeridian_are_one_field() {
    let folder = Folder::new();
    folder.write("whole.asc", grid([60, 50], [0.0, 0.0], 1.0, 1).as_bytes());
    let at = "gdal_translate -q -ot Int16 -a_srs EPSG:4326";
    tool(&folder, &format!("{at} -a_ullr 179.5 -16 180.5 -17 whole.asc whole.tif"));
    tool(&folder, &format!("{at} -srcwin 0 0 30 50 -a_ullr 179.5 -16 180 -17 whole.asc west.tif"));
    tool(
        &folder,
        &format!("{at} -srcwin 30 0 30 50 -a_ullr -180 -16 -179.5 -17 whole.asc east.tif"),
    );
    let [one, two] = [&["whole.tif"][..], &["west.tif", "east.tif"]].map(|names| {
        let paths: Vec<_> = names.iter().map(|name| folder.path(name)).collect();
        ridgelight_io::read_mosaic(&paths, &HeightOptions::default()).unwrap()
    });
    assert_eq!(one.field.heights_m(), two.field.heights_m());
    assert_eq!(one.field.cell_m(), two.field.cell_m());
    assert_eq!(one.georeference.unwrap().corner, two.georeference.unwrap().corner);
    // In the other order the field is the same, 360 degrees farther west.
    let paths = ["east.tif", "west.tif"].map(|name| folder.path(name));
    let turned = ridgelight_io::read_mosaic(&paths, &HeightOptions::default()).unwrap();
    assert_eq!(turned.field.heights_m(), two.field.heights_m());
    assert_eq!(turned.georeference.unwrap().corner, [-180.5, -16.0]);
}

/// Systems without an EPSG code, as GDAL writes them, get a warning instead of an angle and a scale.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_systems_without_a_code_get_a_warning() {
    let folder = Folder::new();
    folder.write("plain.asc", grid([8, 6], [-1_900_000.0, 1_500_000.0], 30.0, 1).as_bytes());
    for (srs, is_warned) in [
        ("ESRI:102003", true),
        ("+proj=merc +datum=WGS84", true),
        ("EPSG:5070", false),
        ("EPSG:3857", false),
    ] {
        let output = Command::new("gdal_translate")
            .current_dir(folder.path("."))
            .args(["-q", "-a_srs", srs, "plain.asc", "at.tif"])
            .status();
        assert!(output.unwrap().success(), "{srs}");
        let read = read_field(&folder.path("at.tif"), &HeightOptions::default()).unwrap();
        let warned = read.warnings.iter().any(|text| text.contains("no EPSG code"));
        assert_eq!(warned, is_warned, "{srs}: {:?}", read.warnings);
    }
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
    let cut = "`gdal_translate -projwin 500300 4901200 501200 4900300 wide.tif out.tif`";
    assert!(horizon.notes.contains(cut), "{}", horizon.notes);
    // Of a box inside of the same cells, and of one beyond the field's north-east corner.
    let inside =
        succeeded(&folder, &format!("svf {names} --bbox 500301,4900310,501190,4901199 -o v.tif"));
    assert!(inside.notes.contains(cut), "{}", inside.notes);
    let beyond =
        succeeded(&folder, &format!("svf {names} --bbox 501201,4901201,600000,5000000 -o v.tif"));
    let cut = "`gdal_translate -projwin 501200 4901500 501800 4901200 wide.tif out.tif`";
    assert!(beyond.notes.contains(cut), "{}", beyond.notes);
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
        let notes = format!("{} {}", facts["notes"], facts["warnings"]);
        let side = if expected > 0.0 { "east" } else { "west" };
        let sign = if expected > 0.0 { '+' } else { '-' };
        let note = format!(
            "grid north, {0:.2} degrees {side} of true north at the centre: true azimuth = azimuth here {sign} {0:.2} degrees",
            expected.abs()
        );
        assert!(notes.contains(&note), "{code}: {note} is not in {notes}");
        assert_eq!(notes.contains("cells are in units of"), unit != 1.0, "{notes}");
        let cells = if code == 2263 { "US survey feet" } else { "feet" };
        let unknown = format!(
            "heights are read as metres, but the cells are in {cells}: if the heights are too, use --z-scale {unit}; if they are metres, --z-scale 1"
        );
        assert_eq!(notes.contains(&unknown), unit != 1.0, "{notes}");
        let known = succeeded(&folder, "info a.tif --z-scale 1").out;
        assert!(!known.contains("heights are read as metres"), "{known}");
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
        let notes = facts["notes"].to_string();
        assert!(notes.contains("m, from Web Mercator metres at latitude "), "{notes}");
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

/// Web Mercator without its code, as ESRI and GDAL write it, has the cells that it has with its code; also by a `.prj`.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_writes_web_mercator_without_a_code() {
    let folder = Folder::new();
    folder.write("a.asc", grid([4, 4], [1.5e6, 5.6e6], 30.0, 0).as_bytes());
    let cells = |name: &str| {
        let run = folder.run_without_driver(&["info", name, "--json", "-"]);
        let facts: serde_json::Value = serde_json::from_str(&run.out).unwrap();
        facts["cell_m"].clone()
    };
    tool(&folder, "gdal_translate -q -a_srs EPSG:3857 a.asc a.tif");
    let expected = cells("a.tif");
    assert!(expected[0].as_f64().unwrap() < 25.0, "{expected}");
    for srs in ["ESRI:102100", "EPSG:900913", "+proj=webmerc"] {
        tool(&folder, &format!("gdal_translate -q -a_srs {srs} a.asc b.tif"));
        assert_eq!(cells("b.tif"), expected, "{srs}");
    }
    for form in ["wkt_esri", "wkt1", "wkt2_2018"] {
        let mut command = Command::new("gdalsrsinfo");
        let output = command.args(["-o", form, "EPSG:3857"]).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("PROJ"), "{text}");
        folder.write("a.prj", text.trim().as_bytes());
        assert_eq!(cells("a.asc"), expected, "{form}");
    }
    folder.write("a.prj", b"");
    assert_ne!(cells("a.asc"), expected);
}

/// Projected metres that are not metres on the ground get a warning with the cells that GDAL's coordinates give.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_agrees_on_the_scale_of_projections() {
    let folder = Folder::new();
    let (equator_m, squared): (f64, f64) = (6_378_137.0, 0.006_694_38);
    for (code, [x, y], warns) in [
        (3395, [-8e6, 5.5e6], true),
        (4087, [-8e6, 4.9e6], true),
        (6933, [-7e6, 5.1e6], true),
        (32618, [5e5, 4.9e6], false),
        (5070, [1.5e6, 2.3e6], false),
    ] {
        folder.write("a.asc", grid([4, 4], [x - 60.0, y - 60.0], 30.0, 0).as_bytes());
        tool(&folder, &format!("gdal_translate -q -a_srs EPSG:{code} a.asc a.tif"));
        let run = folder.run_without_driver(&["info", "a.tif"]);
        assert_eq!(run.status, Some(0), "{}", run.err);
        let said = run.out.lines().find(|line| line.contains("are not metres on the ground"));
        assert_eq!(said.is_some(), warns, "{code}: {}", run.out);
        if !warns {
            continue;
        }
        let (_, hint) = said.and_then(|said| said.split_once("--cell ")).expect("a cell");
        let hint = hint.split(' ').next().expect("two numbers");
        let found: Vec<f64> = hint.split(',').map(|number| number.parse().unwrap()).collect();
        let place = |x: f64, y: f64| degrees_of(code, "EPSG:4326", [x, y]);
        let ends = [
            [place(x - 500.0, y), place(x + 500.0, y)],
            [place(x, y - 500.0), place(x, y + 500.0)],
        ];
        let phi = place(x, y)[1].to_radians();
        let w = (1.0 - squared * phi.sin().powi(2)).sqrt();
        let radii = [equator_m * phi.cos() / w, equator_m * (1.0 - squared) / w.powi(3)];
        let mut differs = false;
        for (found, [from, to]) in found.iter().zip(ends) {
            let [east, north] = [0, 1].map(|k| radii[k] * (to[k] - from[k]).to_radians());
            let expected = 30.0 * east.hypot(north) / 1000.0;
            // Printed with five digits. A line of 1 km bends to third order: less than 1e-6 of it.
            let bound = 5.1e-4 + 1e-5 * expected;
            assert!((found - expected).abs() < bound, "{code}: {found} for {expected}");
            differs |= (expected - 30.0).abs() > 0.02 * 30.0;
        }
        assert!(differs, "{code}");
        let taken = folder.run_without_driver(&["info", "a.tif", "--cell", hint]);
        assert_eq!(taken.status, Some(0), "{}", taken.err);
        assert!(!taken.out.contains("on the ground"), "{}", taken.out);
    }
}

/// Rows from south to north are refused with what to do; a system that only GDAL's own file states is lost with a warning.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_positions_that_are_not_read_are_named() {
    let folder = Folder::new();
    folder.write("a.asc", grid([4, 4], [5e5, 4.9e6], 30.0, 0).as_bytes());
    tool(
        &folder,
        "gdal_translate -q -a_srs EPSG:32618 -a_ullr 500000 4900000 500120 4900120 a.asc up.tif",
    );
    let run = folder.run_without_driver(&["info", "up.tif"]);
    assert_eq!(run.status, Some(1), "{}", run.out);
    assert!(
        run.err.contains("rows from south to north") && run.err.contains("gdalwarp"),
        "{}",
        run.err
    );
    tool(&folder, "gdal_translate -q -a_srs EPSG:8857 a.asc pam.tif");
    let run = folder.run_without_driver(&["info", "pam.tif"]);
    let is_lost = run.out.contains("CRS        not stated");
    let warns = run.out.contains("the coordinate reference system in pam.tif.aux.xml is not read");
    assert_eq!(is_lost, warns, "{}", run.out);
    assert!(folder.path("pam.tif.aux.xml").exists() && is_lost, "{}", run.out);
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
