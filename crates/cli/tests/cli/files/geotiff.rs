//! GeoTIFF and world files of maps: read back by this project's reader, and by GDAL.

use super::gdal_inputs::tool;
use crate::needs_vulkan::done;
use crate::{Folder, formats, read};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;

/// UTM zone 33 north, cells of 10 m x 20 m, the first pixel's corner at 500 km east, 5,100 km north.
/// Written by GDAL: see tests/files/gdal/write.sh.
const UTM: &[u8] = include_bytes!("../../../../../tests/files/gdal/utm.tif");
/// The same, PixelIsPoint, with NAVD88 heights in feet as its vertical reference.
const POINT: &[u8] = include_bytes!("../../../../../tests/files/gdal/utm_point_feet.tif");

pub fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("utm.tif", UTM);
    folder.write("point.tif", POINT);
    folder
}

/// Outputs lie where the inputs lie, whichever way the input states positions.
#[test]
fn gpu_maps_lie_where_the_input_lies() {
    let folder = folder();
    for input in ["utm", "point"] {
        done(&folder, &format!("render {input}.tif -o o.tif --layers sky-view --azimuths 8"));
        let of = |name: &str| {
            let options = ridgelight_io::HeightOptions::default();
            let read = ridgelight_io::read_field(&folder.path(name), &options).unwrap();
            (read.field, read.georeference)
        };
        let (field, at) = of(&format!("{input}.tif"));
        let at = at.unwrap();
        assert_eq!((at.corner, at.cell), ([500_000.0, 5_100_000.0], [10.0, 20.0]));
        // A reader of heights refuses several bands, so the horizon of one azimuth set is baked.
        done(
            &folder,
            &format!("bake {input}.tif -o baked --what sky-view --azimuths 8 --format tif"),
        );
        let (map, placed) = of("baked/sky_view.tif");
        let placed = placed.unwrap();
        assert_eq!((placed.corner, placed.cell), (at.corner, at.cell));
        assert_eq!(placed.keys, at.keys.horizontal());
        assert_eq!((map.rows(), map.cols()), (field.rows(), field.cols()));
    }
}

/// Pixels of different places are compared with a note; not the same place in another cut.
#[test]
fn gpu_maps_of_different_places_are_compared_with_a_note() {
    let folder = folder();
    for (name, bbox) in [
        ("a", "500000,5099960,500020,5100000"),
        ("b", "500020,5099960,500040,5100000"),
        ("c", "500001,5099961,500019,5099999"),
    ] {
        done(&folder, &format!("svf utm.tif --bbox {bbox} --azimuths 8 -o {name}.tif"));
    }
    for (pair, notes) in [("a.tif b.tif", true), ("a.tif c.tif", false)] {
        let run = folder.run_str(&format!("compare {pair}"));
        assert_eq!(run.status, Some(0), "{}", run.err);
        let said = "note: the files have different positions";
        assert_eq!(run.err.contains(said), notes, "{pair}: {}", run.err);
    }
}

/// Heights in feet are converted, and a note names their unit.
#[test]
fn heights_in_feet_get_a_note() {
    let folder = folder();
    for (name, unit) in [("utm", 1.0), ("point", 1200.0 / 3937.0)] {
        let info = folder.run_without_driver(&["info", &format!("{name}.tif")]);
        assert_eq!((info.status, info.err.as_str()), (Some(0), ""), "{name}");
        // tests/files/gdal/write.sh: 100 - 9 (col - 3)² - 7 (row - 2)², from -9 to 100.
        let heights = format!("heights    {:.3} to {:.3} m", -9.0 * unit, 100.0 * unit);
        assert!(info.out.contains(&heights), "{heights}: {}", info.out);
        let note = format!("note       heights are in units of {unit} m and become metres");
        assert_eq!(info.out.contains(&note), unit != 1.0, "{}", info.out);
        assert_eq!(info.out.contains("heights are in units of"), unit != 1.0, "{}", info.out);
    }
}

/// A difference GeoTIFF has the channels of the EXR and the georeference of the first input that has one.
#[test]
fn gpu_a_difference_has_the_georeference_of_an_input() {
    let folder = folder();
    for (name, sun) in [("a", 20), ("b", 60)] {
        for kind in ["tif", "exr"] {
            done(&folder, &format!("hillshade utm.tif --sun 200,{sun} -o {name}.{kind}"));
        }
    }
    let at = ridgelight_io::read_georeference(&folder.path("utm.tif")).unwrap().unwrap();
    for (pair, expected) in [
        ("a.tif b.tif", Some(&at)),
        ("a.tif b.exr", Some(&at)),
        ("a.exr b.tif", Some(&at)),
        ("a.exr b.exr", None),
    ] {
        for kind in ["tif", "exr"] {
            done(&folder, &format!("compare {pair} --diff d.{kind} --quiet"));
        }
        let found = ridgelight_io::read_georeference(&folder.path("d.tif")).unwrap();
        assert_eq!(found.as_ref(), expected, "{pair}");
        let [tif, exr] =
            ["d.tif", "d.exr"].map(|name| ridgelight_io::read_planes(&folder.path(name)).unwrap());
        assert_eq!((&tif.names, &tif.planes), (&exr.names, &exr.planes), "{pair}");
        assert!(tif.planes[0].iter().any(|v| *v != 0.0), "{pair}");
    }
}

/// A GeoTIFF and an EXR of one scene have the same channels; another scene differs.
#[test]
fn gpu_geotiffs_are_compared_by_band() {
    let folder = folder();
    let render = "render utm.tif --sky 0.5 --sun 200,20 --azimuths 8 --layers lights,sky-view";
    done(&folder, &format!("{render} -o o.tif"));
    done(&folder, &format!("{render} -o o.exr"));
    for pair in ["o.tif o.exr", "o.exr o.tif"] {
        let run = folder.run_str(&format!("compare {pair} --max-worst 0"));
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{}", run.out);
        assert!(run.out.contains("direct.sun1.G: RMSE 0.000000"), "{}", run.out);
        assert!(!run.out.contains("not compared"), "{}", run.out);
    }
    done(&folder, "render utm.tif --sky 0.5 --sun 100,20 --azimuths 8 -o other.tif");
    assert_eq!(folder.run_str("compare other.tif o.exr --max-worst 0").status, Some(1));
    done(&folder, "horizon utm.tif --azimuths 8 -o h.tif");
    done(&folder, "horizon utm.tif --azimuths 8 -o h.exr");
    done(&folder, "compare h.tif h.exr --horizons --max-worst-deg 0");
    // The planes of an .npy have numbers, those of a .tif names.
    done(&folder, "horizon utm.tif --azimuths 8 -o h.npy");
    for pair in ["h.tif h.npy", "h.npy h.tif"] {
        done(&folder, &format!("compare {pair} --horizons --max-worst-deg 0"));
    }
}

#[test]
fn gpu_a_picture_has_a_world_file() {
    let folder = folder();
    done(&folder, "render utm.tif -o o.png --azimuths 8");
    let world = std::fs::read_to_string(folder.path("o.pgw")).unwrap();
    assert_eq!(world, "10\n0\n0\n-20\n500005\n5099990\n");
    // GDAL finds the reference system of the input, and none once the `.aux.xml` is removed.
    let system = |name: &str| gdalinfo(&folder.path(name))["stac"]["proj:epsg"].clone();
    assert_eq!((system("utm.tif"), system("o.png")), (json!(32633), json!(32633)));
    let beside = folder.path("o.png.aux.xml");
    let kept = std::fs::read(&beside).unwrap();
    std::fs::remove_file(&beside).unwrap();
    assert_eq!(system("o.png"), json!(null));
    std::fs::write(&beside, kept).unwrap();
    done(&folder, "horizon utm.tif -o h.png --azimuths 4");
    assert_eq!(std::fs::read_to_string(folder.path("h.pgw")).unwrap(), world);
    // A picture without a position leaves the file alone and warns.
    let run = folder.run_str("render a.npy -o o.png --azimuths 8");
    assert_eq!(run.status, Some(0), "{}", run.err);
    for file in ["o.pgw", "o.png.aux.xml"] {
        let warning = format!("warning: {file} belongs to another picture");
        assert!(run.err.contains(&warning), "{}", run.notes);
    }
    assert_eq!(std::fs::read_to_string(folder.path("o.pgw")).unwrap(), world);
    let run = folder.run_str("render utm.tif -o o.png --azimuths 8 --camera south --size 32x18");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let note = "warning: o.pgw belongs to another picture, because this one is a camera view";
    assert!(run.err.contains(note), "{}", run.err);
    done(&folder, "render a.npy -o p.png --azimuths 8");
    assert!(!folder.path("p.pgw").exists() && !folder.path("p.png.aux.xml").exists());
    // A position without a system: no file states one, and one of an earlier picture has a warning.
    let grid = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 3\n4 5 6\n";
    folder.write("grid.asc", grid.as_bytes());
    done(&folder, "render grid.asc -o g.png --azimuths 8");
    assert!(folder.path("g.pgw").exists() && !folder.path("g.png.aux.xml").exists());
    folder.write("g.png.aux.xml", b"<PAMDataset/>");
    let run = folder.run_str("render grid.asc -o g.png --azimuths 8");
    let warning = "warning: g.png.aux.xml belongs to another picture, because grid.asc has no coordinate reference system";
    assert!(run.status == Some(0) && run.err.contains(warning), "{}", run.err);
}

pub fn gdalinfo(path: &Path) -> Value {
    let output = Command::new("gdalinfo").arg("-json").arg(path).output();
    let output = output.expect("gdalinfo: run tools/setup --tests");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// All values of all bands, by GDAL: its ENVI driver writes plain floats.
pub fn gdal_values(path: &Path) -> Vec<f32> {
    let plain = path.with_extension("envi");
    let mut command = Command::new("gdal_translate");
    command
        .args(["-q", "-ot", "Float32", "-of", "ENVI", "-co", "INTERLEAVE=BSQ"])
        .arg(path)
        .arg(&plain);
    assert!(command.status().expect("gdal_translate: run tools/setup --tests").success());
    let bytes = std::fs::read(plain).unwrap();
    bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect()
}

/// What GDAL's validator, which Debian's gdal-bin brings, reports of a file; `Ok` without an error or a warning.
fn checked_cog(path: &Path) -> Result<(), String> {
    let mut command = Command::new("/usr/bin/python3");
    command.args(["-m", "osgeo_utils.samples.validate_cloud_optimized_geotiff"]);
    let output = command.arg("--full-check=yes").arg(path).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let is_valid = output.status.success() && !text.contains("warning");
    if is_valid { Ok(()) } else { Err(text) }
}

fn coordinate_system(info: &Value) -> &str {
    info["coordinateSystem"]["wkt"].as_str().unwrap()
}

#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_finds_maps_in_place_with_names_and_units() {
    let folder = folder();
    let input = gdalinfo(&folder.path("utm.tif"));
    for name in ["utm", "point"] {
        done(&folder, &format!("horizon {name}.tif -o h.tif --azimuths 8 --distances d.tif"));
        for (file, unit) in [("h.tif", "rad"), ("d.tif", "m")] {
            let info = gdalinfo(&folder.path(file));
            checked_cog(&folder.path(file)).unwrap();
            assert_eq!(info["geoTransform"], input["geoTransform"], "{name}");
            // Without the vertical reference of point.tif.
            assert_eq!(coordinate_system(&info), coordinate_system(&input), "{name}");
            let kind = if name == "point" { "Point" } else { "Area" };
            assert_eq!(info["metadata"][""]["AREA_OR_POINT"], kind);
            assert!(info["metadata"][""]["commit"].is_string(), "{info}");
            let bands = info["bands"].as_array().unwrap();
            assert_eq!(bands.len(), 8);
            for (k, band) in bands.iter().enumerate() {
                assert_eq!(band["description"], format!("azimuth_{:03}.0", 45 * k));
                assert_eq!((&band["unit"], &band["type"]), (&json!(unit), &json!("Float32")));
                assert_eq!(band["noDataValue"], "NaN");
            }
        }
    }
}

/// GDAL finds the values of the EXR in a file of the layout that docs/command-line.md states: tiles, DEFLATE with predictor 3,
/// overviews.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_reads_every_value_and_overviews() {
    let folder = folder();
    // Beyond one tile, and no multiple of one; heights with voids.
    let (rows, cols) = (521_usize, 1031);
    let heights: Vec<u8> = (0..rows * cols)
        .map(|i| if i % 97 == 5 { f32::NAN } else { ((i * 7919) % 613) as f32 })
        .flat_map(f32::to_le_bytes)
        .collect();
    folder.write("big.npy", &formats::npy("<f4", false, &format!("({rows}, {cols})"), &heights));

    let (none, all) = ("", " --layers lights,sky-view,horizon");
    // The large field once, with every band.
    for (input, overviews, layers) in [
        ("big.npy --nodata nan", 2, &[all][..]),
        ("utm.tif", 0, &[none, all]),
        ("a.npy", 0, &[none, all]),
    ] {
        for layers in layers {
            let command = format!("render {input} --sky 0.5 --sun 200,20 --azimuths 4{layers}");
            done(&folder, &format!("{command} -o o.tif"));
            done(&folder, &format!("{command} -o o.exr"));
            let (path, exr) = (folder.path("o.tif"), read(&folder.path("o.exr")));
            checked_cog(&path).unwrap();
            let (info, values) = (gdalinfo(&path), gdal_values(&path));
            let packed = &info["metadata"]["IMAGE_STRUCTURE"];
            let packed = [&packed["COMPRESSION"], &packed["PREDICTOR"]];
            assert_eq!(packed, [&json!("DEFLATE"), &json!("3")], "{command}");
            // An image within one tile has a tile of its own size, in multiples of 16.
            let tile = if overviews > 0 { 512 } else { 16 };
            let bands = info["bands"].as_array().unwrap();
            assert_eq!(bands.len(), exr.names.len());
            let colours = [0, 1, 2].map(|i| &bands[i]["colorInterpretation"]);
            assert_eq!(colours, [&json!("Red"), &json!("Green"), &json!("Blue")]);
            let plane = exr.rows * exr.cols;
            for (i, band) in bands.iter().enumerate() {
                let name = band["description"].as_str().unwrap();
                let own = exr.names.iter().position(|n| n == name).unwrap();
                let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                let found = bits(&values[i * plane..(i + 1) * plane]);
                assert!(found == bits(&exr.planes[own]), "{command}: {name}");
                let count = band["overviews"].as_array().map_or(0, Vec::len);
                assert_eq!(count, overviews, "{command}");
                assert_eq!(band["block"], json!([tile, tile]), "{command}: {name}");
            }
            if overviews > 0 {
                other_layouts_are_refused(&folder);
            }
        }
    }
}

/// The validator refuses the values of o.tif in strips, in tiles without overviews, and with overviews behind the image.
fn other_layouts_are_refused(folder: &Folder) {
    for (name, layout, has_overviews, says) in [
        ("strips.tif", "", false, "not tiled"),
        ("alone.tif", "-co TILED=YES", false, "internal overviews"),
        ("behind.tif", "-co TILED=YES", true, "image should be after the one of the overview"),
    ] {
        tool(folder, &format!("gdal_translate -q {layout} o.tif {name}"));
        if has_overviews {
            tool(folder, &format!("gdaladdo -q -r average {name} 2 4"));
        }
        let error = checked_cog(&folder.path(name)).unwrap_err();
        assert!(error.contains(says), "{name}: {error}");
    }
}
