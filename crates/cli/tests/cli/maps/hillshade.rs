//! `hillshade`: derived answers, and gdaldem's.

use serde_json::json;

use super::codes;
use crate::files::gdal_inputs::{grid, tool};
use crate::files::geotiff::{gdal_values, gdalinfo};
use crate::needs_vulkan::{done, write_field};
use crate::{Folder, read};

const SIDE: usize = 17;
const SUN: [f64; 2] = [200.0, 30.0];

/// 1 + 254 max(cos, 0) of a plane with gradient `p` to the east and `q` to the north.
fn lambert([p, q]: [f64; 2]) -> f64 {
    let [azimuth, elevation] = SUN.map(f64::to_radians);
    let [x, y] = [azimuth.sin(), azimuth.cos()].map(|part| part * elevation.cos());
    let cos = (elevation.sin() - p * x - q * y) / (1.0 + p * p + q * q).sqrt();
    1.0 + 254.0 * cos.max(0.0)
}

/// Every texel of a plane, the edges too, without a device.
#[test]
fn hillshade_of_a_plane_is_its_formula() {
    let folder = Folder::new();
    for gradient @ [p, q] in [[0.0, 0.0], [0.5, 0.0], [0.0, -2.0], [-0.25, 0.75]] {
        write_field(&folder, SIDE, |row, col| (p * col as f64 - q * row as f64) as f32);
        for (name, scale) in [("o.npy", 1.0), ("o.exr", 1.0), ("o.tif", 2.0), ("o.png", 2.0)] {
            let sun = format!("{},{}", SUN[0], SUN[1]);
            let scale_word = scale.to_string();
            let words =
                ["hillshade", "field.npy", "-o", name, "--sun", &sun, "--z-scale", &scale_word];
            let run = folder.run_without_driver(&words);
            assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{name}");
            assert_eq!(run.out, format!("Wrote {name} ({SIDE}x{SIDE}).\n"));
            let expected = lambert(gradient.map(|part| scale * part));
            if name == "o.png" {
                let (kind, codes) = codes(&folder.path(name));
                assert_eq!(kind, png::ColorType::Grayscale);
                assert_eq!(codes, [expected.round() as u8; SIDE * SIDE], "{gradient:?}");
                continue;
            }
            for value in read(&folder.path(name)).planes.concat() {
                // A half step of f32 at 255.
                assert!((f64::from(value) - expected).abs() < 1e-5, "{name} {gradient:?}: {value}");
            }
        }
    }
    assert_eq!(lambert([0.0, -2.0]), 1.0, "the slope to the north faces away from the sun");
}

/// The default is gdaldem's sun. A void is NaN, or transparent.
#[test]
fn hillshade_has_voids_and_a_sun_from_the_north_west() {
    let folder = Folder::new();
    folder.write("v.asc", b"ncols 3 nrows 2 cellsize 1 nodata_value -9 0 0 0 0 -9 0");
    let level = 1.0 + 254.0 * 45_f32.to_radians().sin();
    let words = ["hillshade", "v.asc", "-o", "v.tif", "--json", "v.json"];
    assert_eq!(folder.run_without_driver(&words).status, Some(0));
    for (i, value) in read(&folder.path("v.tif")).planes[0].iter().enumerate() {
        assert!(if i == 4 { value.is_nan() } else { (value - level).abs() < 1e-4 }, "{i}: {value}");
    }
    let settings = crate::needs_vulkan::json(&folder.path("v.json"));
    assert_eq!(settings["settings"]["sun1"], json!([315, 45]));
    let plain = folder.run_without_driver(&["hillshade", "v.asc", "-o", "v.png"]);
    assert!(plain.status == Some(0) && !plain.err.contains("--device"), "{}", plain.err);
    let words = ["hillshade", "v.asc", "-o", "v.png", "--device", "none"];
    let noted = folder.run_without_driver(&words);
    let note = "note: --device none changes nothing for hillshade, which always runs on the CPU";
    assert!(noted.status == Some(0) && noted.err.contains(note), "{}", noted.err);
    let (kind, codes) = codes(&folder.path("v.png"));
    let lit = [level.round() as u8, 255];
    assert_eq!(kind, png::ColorType::GrayscaleAlpha);
    assert_eq!(codes, [lit, lit, lit, lit, [0, 0], lit].concat());
}

/// A hillshade needs no distant ground, so its field gets no note on the Earth's curvature. Light and horizons do.
#[test]
fn hillshade_has_no_note_on_the_curvature() {
    let folder = Folder::new();
    write_field(&folder, SIDE, |row, _| row as f32);
    let said = "the Earth's curvature";
    // All read the field before they open a device. Only `plan` and `hillshade` need none.
    for (command, cell, status, is_noted) in [
        ("plan", "1000", 0, true),
        ("render", "1000", 1, true),
        ("svf", "1000", 1, true),
        ("hillshade", "1000", 0, false),
        // 16 cells of 625 m are 10 km, which is not wide.
        ("plan", "625", 0, false),
    ] {
        let mut words = vec![command, "field.npy", "--cell", cell];
        if command != "plan" {
            words.extend(["-o", "o.tif"]);
        }
        let run = folder.run_without_driver(&words);
        assert_eq!(run.status, Some(status), "{words:?}: {}", run.err);
        assert_eq!(run.notes.contains(said), is_noted, "{words:?}: {}", run.notes);
    }
}

/// A box has other slopes at its edges than the field has there, and the same inside. The note of a hillshade states that;
/// the one on shadows is for other commands.
#[test]
fn a_hillshade_of_a_box_has_a_note_on_its_edges() {
    let folder = Folder::new();
    let heights: String = (0..25).map(|i| format!("{} ", 5 * (i % 5) * (i % 5))).collect();
    let head = "ncols 5\nnrows 5\nxllcorner 1000\nyllcorner 2000\ncellsize 10\n";
    folder.write("a.asc", (head.to_owned() + &heights).as_bytes());
    let run = |words: &[&str]| {
        let run = folder.run_without_driver(words);
        assert_eq!(run.status, Some(0), "{words:?}: {}", run.err);
        run.notes
    };
    let bbox = ["--bbox", "1010,2010,1040,2040"];
    let whole = run(&["hillshade", "a.asc", "-o", "whole.npy"]);
    let part = run(&["hillshade", "a.asc", "-o", "part.npy", bbox[0], bbox[1]]);
    let said = "a.asc: read without the ground outside --bbox, so slopes at its edges are computed from the cells inside; \
                for those of the whole field, use a box that is wider by a cell and cut the result: `gdal_translate -projwin 1010 2040 1040 2010";
    assert!(part.contains(said) && !part.contains("shadow"), "{part}");
    assert!(!whole.contains("--bbox"), "{whole}");
    let plan = run(&["plan", "a.asc", bbox[0], bbox[1]]);
    let said =
        "outside --bbox, which casts no shadow into it; for its shadows, use a wider box and cut";
    assert!(plan.contains(said), "{plan}");
    let [whole, part] = ["whole.npy", "part.npy"].map(|name| read(&folder.path(name)));
    assert_eq!((part.rows, part.cols), (3, 3));
    // The middle of both, and the texel west of it.
    assert_eq!(part.planes[0][4], whole.planes[0][12]);
    assert_ne!(part.planes[0][3], whole.planes[0][11]);
}

/// Inside the field, gdaldem has the same values, rounded. Maps lie where the input lies.
#[test]
#[ignore = "needs GDAL: Debian's gdal-bin"]
fn gdal_hillshade_has_the_same_values() {
    let folder = Folder::new();
    let [cols, rows] = [37, 29];
    let text = grid([cols, rows], [500_000.0, 4_900_000.0], 30.0, 0);
    folder.write("a.asc", text.as_bytes());
    // Cells of 30 m x 60 m.
    let corners = "500000 4901740 501110 4900000";
    tool(&folder, &format!("gdal_translate -q -a_srs EPSG:32618 -a_ullr {corners} a.asc a.tif"));
    let is_inside =
        |i: usize| (1..rows - 1).contains(&(i / cols)) && (1..cols - 1).contains(&(i % cols));
    let largest = |ours: &[f32], theirs: &[f32]| {
        let pairs = ours.iter().zip(theirs).enumerate().filter(|(i, _)| is_inside(*i));
        pairs.map(|(_, (a, b))| (a - b).abs()).fold(0.0, f32::max)
    };
    for (azimuth, elevation, scale) in [(315, 45, 1), (90, 10, 1), (200, 70, 3), (0, 90, 2)] {
        let theirs = format!("-q -compute_edges -az {azimuth} -alt {elevation} -z {scale}");
        tool(&folder, &format!("gdaldem hillshade {theirs} a.tif g.tif"));
        let theirs = gdal_values(&folder.path("g.tif"));
        let sun = format!("--sun {azimuth},{elevation} --z-scale {scale}");
        done(&folder, &format!("hillshade a.tif -o o.tif {sun}"));
        let ours = gdal_values(&folder.path("o.tif"));
        // gdaldem rounds to whole numbers, from f32.
        assert!(largest(&ours, &theirs) <= 0.5 + 1e-4, "{sun}: {}", largest(&ours, &theirs));
        done(&folder, &format!("hillshade a.tif -o o.png {sun}"));
        let codes: Vec<f32> = codes(&folder.path("o.png")).1.into_iter().map(f32::from).collect();
        // A value halfway between two may be rounded to either.
        assert!(largest(&codes, &theirs) <= 1.0, "{sun}");
        // Another sun differs.
        done(&folder, "hillshade a.tif -o o.tif --sun 45,30");
        assert!(largest(&gdal_values(&folder.path("o.tif")), &theirs) > 10.0);
    }
    let place = &gdalinfo(&folder.path("a.tif"))["geoTransform"];
    for (command, name, unit) in [
        ("hillshade", "hillshade", json!(null)),
        ("ao", "sky_view", json!(null)),
        ("openness", "openness", json!("deg")),
        ("openness --negative", "negative_openness", json!("deg")),
    ] {
        done(&folder, &format!("{command} a.tif -o o.tif"));
        let info = gdalinfo(&folder.path("o.tif"));
        assert_eq!(&info["geoTransform"], place, "{command}");
        let band = &info["bands"][0];
        assert_eq!((&band["description"], &band["unit"]), (&json!(name), &unit), "{command}");
        done(&folder, &format!("{command} a.tif -o o.png"));
        let world = std::fs::read_to_string(folder.path("o.pgw")).unwrap();
        assert_eq!(world, "30\n0\n0\n-60\n500015\n4901710\n", "{command}");
    }
}
