//! `shadow`, `ao`, `svf` and `openness`: derived answers. Notes and errors of all maps.

mod hillshade;

use std::path::Path;

use crate::needs_vulkan::{done, plane, write_field};
use crate::{Folder, read, refused, succeeded};

const SIDE: usize = 17;

/// Bytes of the pixels of a .png.
pub(crate) fn codes(path: &Path) -> (png::ColorType, Vec<u8>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    assert_eq!(reader.info().source_gamma, None, "viewers would change the codes");
    (reader.info().color_type, bytes)
}

/// A degree of longitude is shorter than one of latitude: 76.1 km and 111.2 km at 47 degrees.
#[test]
fn pictures_in_degrees_have_a_note_on_their_proportions() {
    let folder = Folder::new();
    let rows = "1 2 3\n4 5 6\n7 8 9\n";
    let grid = |corner: [f64; 2], cell: f64| {
        format!(
            "ncols 3\nnrows 3\nxllcorner {}\nyllcorner {}\ncellsize {cell}\n{rows}",
            corner[0], corner[1]
        )
    };
    folder.write("degrees.asc", grid([8.0, 47.0], 0.001).as_bytes());
    folder.write("metres.asc", grid([5e5, 5.2e6], 30.0).as_bytes());
    let said = "each pixel covers 76.1 x 111.2 m; the picture is 1.46 times too wide";
    for (name, output, is_noted) in
        [("degrees", "o.png", true), ("degrees", "o.tif", false), ("metres", "o.png", false)]
    {
        let run = folder.run_without_driver(&["hillshade", &format!("{name}.asc"), "-o", output]);
        assert_eq!(run.notes.contains(said), is_noted, "{name}, {output}: {}", run.notes);
    }
    // With a reference system the note has a command.
    folder.write(
        "degrees.prj",
        br#"GEOGCS["GCS_WGS_1984",DATUM["D"],UNIT["Degree",0.0174532925199433]]"#,
    );
    let run = folder.run_without_driver(&["hillshade", "degrees.asc", "-o", "o.png"]);
    assert!(run.notes.contains("`gdalwarp -t_srs EPSG:32632`"), "{}", run.notes);
}

/// A value of a sun that a map ignores gets a note.
#[test]
fn maps_have_a_note_on_what_they_do_not_use_of_a_sun() {
    let folder = Folder::new();
    write_field(&folder, SIDE, |row, _| row as f32);
    for (map, sun, note) in [
        ("hillshade", "315,45", ""),
        ("hillshade", "315,45,3", "note: --sun: hillshade ignores the diameter"),
        (
            "hillshade",
            "315,45,3,2",
            "note: --sun: hillshade ignores the diameter and the irradiance",
        ),
        ("shadow", "315,45,3", ""),
        ("shadow", "315,45,3,2", "note: --sun: shadow ignores the irradiance"),
    ] {
        let words = [map, "field.npy", "--cell", "1", "-o", "o.npy", "--sun", sun];
        let said = |more: &[&str]| {
            let err = folder.run_without_driver(&[&words[..], more].concat()).err;
            // Without a driver a map of shadows then fails.
            err.lines().filter(|line| line.contains(" ignores ")).collect::<String>()
        };
        assert_eq!([said(&[]), said(&["-q"])], [note, ""], "{words:?}");
    }
}

#[test]
fn wrong_maps_are_refused() {
    let folder = Folder::new();
    refused(
        &folder,
        &[
            ("hillshade a.asc -o o.txt", 2, &["-o: found o.txt", ".npy, .exr or .png"]),
            ("hillshade a.asc -o a.asc", 2, &["-o"]),
            ("hillshade a.npy -o a.npy", 2, &["which is an input"]),
            ("hillshade a.asc -o o.tif --sun 0,91", 2, &["--sun 1: elevation: found 91°"]),
            (
                "hillshade a.asc -o o.tif --sun 0,-1",
                2,
                &["--sun 1: elevation: found -1°", "expected 0° to 90°, as in --sun AZ,EL"],
            ),
            ("hillshade a.asc -o o.tif --sun 0", 2, &["--sun", "expected AZ,EL"]),
            ("hillshade a.asc -o o.tif --sun 0,9 --sun 1,9", 2, &["--sun 2: found another sun"]),
            ("hillshade a.asc -o o.tif --azimuths 8", 2, &["--azimuths", "unexpected"]),
            ("hillshade a.asc -o o.tif --cell 0", 2, &["--cell: found 0"]),
            ("ao a.asc -o o.ktx2", 2, &["-o: found o.ktx2"]),
            ("ao a.asc -o o.png --azimuths 3", 2, &["--azimuths: found 3"]),
            ("svf a.asc -o o.png --json o.png", 2, &["--json"]),
            ("svf a.asc -o o.tif", 1, &["driver"]),
            ("openness a.asc -o o.tif --z-scale 0 --negative", 2, &["--z-scale: found"]),
            ("openness a.asc -o o.tif --sun 0,45", 2, &["--sun", "unexpected"]),
            ("openness a.asc -o o.tif", 1, &["driver"]),
        ],
    );
}

/// Flat ground has openness 90° and sky view 1 in every texel, at the edges too.
#[test]
fn gpu_flat_ground_is_open() {
    let folder = Folder::new();
    write_field(&folder, 9, |_, _| 7.0);
    for method in ["sweep", "brute-force", "pyramid"] {
        for negative in ["", " --negative"] {
            for cell in ["0.001", "1", "20000"] {
                let words = format!("--method {method}{negative} --cell {cell}");
                done(&folder, &format!("openness field.npy -o o.npy {words}"));
                assert_eq!(read(&folder.path("o.npy")).planes[0], [90.0; 81], "{words}");
            }
        }
    }
    for command in ["ao", "svf"] {
        done(&folder, &format!("{command} field.npy -o o.npy"));
        for value in read(&folder.path("o.npy")).planes.concat() {
            assert!((value - 1.0).abs() < 1e-5, "{command}: {value}");
        }
        done(&folder, &format!("{command} field.npy -o o.png"));
        assert_eq!(codes(&folder.path("o.png")).1, [255; 81], "{command}");
    }
    // 60 to 95 degrees are 0 to 255.
    done(&folder, "openness field.npy -o o.png");
    assert_eq!(codes(&folder.path("o.png")).1, [(255.0 * 30.0_f64 / 35.0).round() as u8; 81]);
    // One grid point has no ground around it.
    write_field(&folder, 1, |_, _| 7.0);
    done(&folder, "openness field.npy -o o.npy");
    assert!(read(&folder.path("o.npy")).planes[0][0].is_nan());
}

/// A .png of `svf` has the range of RVT's 8-bit files, one of `ao` 0 to 1, whatever the values. Standard output states it.
#[test]
fn gpu_pictures_of_sky_view_have_fixed_ranges() {
    let folder = Folder::new();
    // A pit, which is darker than the range, in level ground beside a slope.
    write_field(&folder, SIDE, |row, col| match [row, col] {
        [8, 8] => 0.0,
        _ => 40.0 - 0.5 * col.saturating_sub(12) as f32,
    });
    done(&folder, "svf field.npy -o o.npy");
    let values = read(&folder.path("o.npy")).planes.concat();
    let between = values.iter().filter(|v| (0.65..0.99).contains(*v)).count();
    assert!(values[8 * SIDE + 8] < 0.5 && values[0] > 0.99 && between > 0, "{values:?}");
    for (command, [black, white], said) in [
        ("svf", [0.6375, 1.0], ". Pixel values 0 to 255 stand for 0.6375 to 1.\n"),
        ("ao", [0.0, 1.0], ". Pixel values 0 to 255 stand for 0 to 1.\n"),
    ] {
        let run = succeeded(&folder, &format!("{command} field.npy -o o.png"));
        assert!(run.out.ends_with(said), "{}", run.out);
        let codes = codes(&folder.path("o.png")).1;
        for (i, (code, value)) in codes.iter().zip(&values).enumerate() {
            let share: f64 = (f64::from(*value) - black) / (white - black);
            let expected = 255.0 * share.clamp(0.0, 1.0);
            // The share is rounded to f32, 255 times of it to a whole number.
            assert!((f64::from(*code) - expected).abs() < 0.5 + 1e-3, "{command} {i}: {code}");
        }
    }
    let run = succeeded(&folder, "openness field.npy -o o.png");
    assert!(run.out.ends_with(". Pixel values 0 to 255 stand for 60 to 95 deg.\n"), "{}", run.out);
    let run = succeeded(&folder, "openness field.npy -o o.tif");
    assert!(!run.out.contains("stand for"), "{}", run.out);
}

/// On a slope of angle a, (1 + cos a)/2 of the cosine-weighted hemisphere is above the horizontal and the slope.
#[test]
fn gpu_sky_view_of_a_slope_is_its_formula() {
    let folder = Folder::new();
    for slope in [0.5_f64, 1.0, 2.0] {
        write_field(&folder, 65, |_, col| (slope * col as f64) as f32);
        done(&folder, "svf field.npy -o o.npy --azimuths 64");
        let found = f64::from(read(&folder.path("o.npy")).planes[0][32 * 65 + 32]);
        let expected = (1.0 + slope.atan().cos()) / 2.0;
        // The trapezoidal rule over an integrand with kinks: 1/azimuths².
        assert!((found - expected).abs() < 1.0 / 4096.0, "{slope}: {found} for {expected}");
    }
}

/// On the axis of a V-shaped ditch along north-south, the horizon is atan(tan a |sin azimuth|) at any distance. On the
/// ridge of the negated heights it is below the horizontal by as much.
#[test]
fn gpu_openness_of_a_ditch_is_its_formula() {
    let folder = Folder::new();
    const AZIMUTHS: usize = 32;
    for slope in [0.25_f64, 1.0, 3.0] {
        write_field(&folder, 33, |_, col| (slope * (col as f64 - 16.0).abs()) as f32);
        let angle = |k: usize| {
            let azimuth = std::f64::consts::TAU * k as f64 / AZIMUTHS as f64;
            (slope * azimuth.sin().abs()).atan()
        };
        let mean = ((0..AZIMUTHS).map(angle).sum::<f64>() / AZIMUTHS as f64).to_degrees();
        for (more, expected) in [("", 90.0 - mean), (" --negative", 90.0 + mean)] {
            let exact = format!("--azimuths {AZIMUTHS} --method brute-force{more}");
            done(&folder, &format!("openness field.npy -o o.npy {exact}"));
            let found = f64::from(read(&folder.path("o.npy")).planes[0][16 * 33 + 16]);
            // As for `horizon`: 1e-5 rad an azimuth.
            assert!(
                (found - expected).abs() < 1e-5_f64.to_degrees(),
                "{slope}{more}: {found} for {expected}"
            );
        }
    }
}

/// The sums of bevy-clipmap's transform in f64, of the horizons that a .npy holds; angles from east over south, as in its
/// shader. Before a wall in the south its sum is higher towards south than towards north.
#[test]
fn gpu_fourier_series_are_the_transform_of_the_horizons() {
    let folder = Folder::new();
    const AZIMUTHS: usize = 24;
    const HALF: usize = 8;
    const RANGE: f64 = 50.0;
    // 140² texels exceed one block of 2^14.
    const SIDE: usize = 140;
    write_field(&folder, SIDE, |row, col| {
        let rough = ((row * 7919 + col * 104_729) % 613) as f32 * 0.005;
        rough + if row > 12 { 9.0 } else { 0.0 }
    });
    done(&folder, "horizon field.npy -o h.npy --azimuths 24");
    done(&folder, "horizon field.npy -o h.ktx2 --azimuths 24 --fourier 16,50 --json h.json");
    let tangents: Vec<Vec<f64>> = read(&folder.path("h.npy"))
        .planes
        .iter()
        .map(|plane| plane.iter().map(|angle| f64::from(*angle).max(0.0).tan()).collect())
        .collect();
    let bytes = std::fs::read(folder.path("h.ktx2")).unwrap();
    let reader = ktx2::Reader::new(&bytes).unwrap();
    let header = reader.header();
    assert_eq!(header.format, Some(ktx2::Format::R32_SFLOAT));
    assert_eq!((header.pixel_width, header.layer_count), (SIDE as u32, 2 * HALF as u32 + 1));
    let level = reader.levels().next().unwrap();
    let values: Vec<f64> =
        level.data.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b).into()).collect();
    // From compass degrees.
    let theta = |layer: usize| std::f64::consts::TAU * (layer as f64 / AZIMUTHS as f64 - 0.25);
    let unit = 360.0 / AZIMUTHS as f64 / RANGE;
    let mut held = 0.0;
    for layer in 0..=2 * HALF {
        let weight = |azimuth: usize| match layer.checked_sub(HALF + 1) {
            None => (layer as f64 * theta(azimuth)).cos(),
            Some(before) => -((before + 1) as f64 * theta(azimuth)).sin(),
        };
        for texel in 0..SIDE * SIDE {
            let terms = |azimuth: usize| tangents[azimuth][texel] * unit;
            let expected: f64 = (0..AZIMUTHS).map(|a| weight(a) * terms(a)).sum();
            let size: f64 = (0..AZIMUTHS).map(terms).sum();
            let found = values[layer * SIDE * SIDE + texel];
            // Each term, its product, weight and sum are rounded.
            let bound = (AZIMUTHS + 4) as f64 * f64::from(f32::EPSILON) * 0.5 * size;
            assert!((found - expected).abs() <= bound, "{layer} {texel}: {found} for {expected}");
            held += (found * RANGE / 360.0).powi(2) * if layer == 0 { 1.0 } else { 2.0 };
        }
    }
    let all: f64 = tangents.iter().flatten().map(|t| t * t).sum::<f64>() / AZIMUTHS as f64;
    let left_out = 100.0 * (1.0 - held / all).sqrt();
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path("h.json")).unwrap()).unwrap();
    let said = json["settings"]["fourier_error_percent"].as_f64().unwrap();
    assert!((said - left_out).abs() < 0.01 && said > 1.0, "{said} for {left_out}");

    // 17 layers take 1.3 MiB, so a budget of 600 KiB needs three rounds.
    let few = "horizon field.npy -o few.ktx2 --azimuths 24 --fourier 16,50 --memory-budget 600KiB --json few.json";
    done(&folder, few);
    let bytes = std::fs::read(folder.path("few.ktx2")).unwrap();
    let reader = ktx2::Reader::new(&bytes).unwrap();
    assert!(reader.levels().next().unwrap().data == level.data, "rounds change the texels");
    let few: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path("few.json")).unwrap()).unwrap();
    let error = few["settings"]["fourier_error_percent"].as_f64().unwrap();
    assert!((error - said).abs() < 0.01, "{error} for {said}");
    // One azimuth fits into a quarter of the budget, so each round has a pass for each.
    let fused = |json: &serde_json::Value| {
        let passes = json["passes"].as_array().expect("times");
        passes
            .iter()
            .filter(|pass| pass["pass"].as_str().unwrap().starts_with("sweep_fuse"))
            .count()
    };
    assert_eq!(fused(&few), 3 * AZIMUTHS, "passes in three rounds");

    // As the shader sums, to the south and to the north of a texel before the wall.
    let at = 11 * SIDE + 8;
    let sum = |theta: f64| {
        let of = |layer: usize| values[layer * SIDE * SIDE + at];
        let waves = (1..=HALF).map(|k| {
            let angle = k as f64 * theta;
            of(k) * angle.cos() - of(k + HALF) * angle.sin()
        });
        (of(0) + 2.0 * waves.sum::<f64>()) / 360.0 * RANGE
    };
    let south = std::f64::consts::FRAC_PI_2;
    assert!(sum(south) > 3.0 && sum(-south) < 1.0, "{} {}", sum(south), sum(-south));
    let start = "horizon field.npy -o x.ktx2 --fourier";
    let [odd, one, flat, many] =
        ["7,50", "8", "8,0", "64,50 --azimuths 64"].map(|wrong| format!("{start} {wrong}"));
    refused(
        &folder,
        &[
            (&odd, 2, &["even number"]),
            (&one, 2, &["--fourier: found 8, expected N,RANGE"]),
            (&flat, 2, &["metres above 0"]),
            (&many, 2, &["fewer than the 64 azimuths"]),
            ("horizon field.npy -o x.npy --fourier 8,50", 2, &["ktx2"]),
        ],
    );
}

/// Behind a wall of 40 m the shadow reaches 40 m less the rise of the ray over the distance, in heights of the file; in every format.
#[test]
fn gpu_shadow_heights_behind_a_wall() {
    let folder = Folder::new();
    // Columns of 2 m; the wall is the last but one.
    write_field(&folder, SIDE, |_, col| if col == SIDE - 2 { 940.0 } else { 900.0 });
    let sun = "--cell 2 --sun 90,60,4";
    for name in ["o.npy", "o.exr", "o.tif", "o.png"] {
        done(&folder, &format!("shadow field.npy {sun} -o {name}"));
    }
    let [lower, upper] = [58.0_f64, 62.0].map(|degrees| 2.0 * degrees.to_radians().tan());
    let (mut dark, mut partly) = (0, 0);
    for name in ["o.npy", "o.exr", "o.tif"] {
        let found = read(&folder.path(name));
        let order =
            [("sun_share", 0), ("lit_above", 1), ("penumbra", 2)].map(|(channel, layer)| {
                let at = found.names.iter().position(|n| n == channel);
                &found.planes[at.unwrap_or(layer)]
            });
        for col in 0..SIDE {
            let at = SIDE + col;
            let steps = (SIDE - 2).saturating_sub(col) as f64;
            let is_wall = steps > 0.0 && 940.0 - steps * lower > 900.0 - lower;
            let ahead = if is_wall { steps } else { 1.0 };
            let top = if is_wall { 940.0 } else { 900.0 };
            // Offsets of the field and absolute heights are f32.
            for (plane, expected) in
                order[1..].iter().zip([top - ahead * lower, ahead * (upper - lower)])
            {
                let value = f64::from(plane[at]);
                assert!((value - expected).abs() < 2e-4, "{name} {col}: {value}");
            }
            let share = f64::from(order[0][at]);
            let horizon =
                if steps > 0.0 { (40.0 / (2.0 * steps)).atan().to_degrees() } else { 0.0 };
            let is_right = match horizon {
                all if all >= 62.0 => share == 0.0,
                none if none <= 58.0 => share == 1.0,
                _ => share > 0.0 && share < 1.0,
            };
            assert!(is_right, "{name} {col}: {share} behind a horizon of {horizon}");
            dark += usize::from(share == 0.0);
            partly += usize::from(share > 0.0 && share < 1.0);
        }
    }
    assert!(dark > 3 && partly > 3, "{dark} {partly}");
    let (kind, codes) = codes(&folder.path("o.png"));
    assert_eq!((kind, codes[SIDE - 3], codes[0]), (png::ColorType::Grayscale, 0, 255));
    refused(
        &folder,
        &[
            ("shadow field.npy -o o.tif --border periodic", 2, &["--border", "periodic field"]),
            ("shadow field.npy -o o.tif --sun 1,9 --sun 2,9", 2, &["one sun"]),
            ("shadow field.npy -o o.tif --sun 1,91", 2, &["elevation"]),
        ],
    );
}

/// Stellarium's shader takes the square of c = 2 code / 255 - 1, with its sign, as the sine s of the elevation. Codes are rounded to the
/// nearest: c errs by 1 / 255, its square by 2 √s / 255 + 1 / 255².
#[test]
fn gpu_four_azimuths_make_a_stellarium_horizon_map() {
    let folder = Folder::new();
    // Rises towards the east; a wall in the south.
    write_field(&folder, SIDE, |row, col| {
        2.0 * col as f32
            + if row > 12 { 9.0 } else { 0.0 }
            + ((row * 7919 + col * 104_729) % 613) as f32 * 0.001
    });
    done(&folder, "horizon field.npy -o h.npy --azimuths 4 --border open");
    done(&folder, "horizon field.npy -o h.png --azimuths 4 --border open");
    let map = image::open(folder.path("h.png")).unwrap();
    let image::DynamicImage::ImageRgba8(map) = map else { panic!("RGBA of 8 bits") };
    let horizons = read(&folder.path("h.npy"));
    let mut worst = 0.0_f64;
    for (i, texel) in map.pixels().enumerate() {
        for (layer, code) in texel.0.into_iter().enumerate() {
            let c = 2.0 * f64::from(code) / 255.0 - 1.0;
            let sine = f64::from(horizons.planes[layer][i]).sin();
            let bound = 2.0 * sine.abs().sqrt() / 255.0 + 1.0 / (255.0 * 255.0);
            worst = worst.max((c * c.abs() - sine).abs() / bound);
        }
    }
    assert!(worst > 0.5 && worst <= 1.0, "{worst} of the bound");
    let [north, east, south, west] = map.get_pixel(8, 11).0;
    assert!(
        east > 200 && west < 60 && south > 230 && north < south,
        "{north} {east} {south} {west}"
    );
    refused(
        &folder,
        &[
            ("horizon field.npy -o h.png", 2, &["--azimuths: found 32", "4, for a .png"]),
            ("horizon field.npy -o h.png --azimuths 4 --lines exact", 2, &["--lines: found exact"]),
            ("horizon field.npy -o h.png --azimuths 4 --fourier 2,5", 2, &["ktx2"]),
        ],
    );
}

#[test]
fn gpu_negative_openness_is_that_of_the_negated_field() {
    let folder = Folder::new();
    let height = |row: usize, col: usize| ((row * 7919 + col * 104_729) % 613) as f32 * 0.01;
    let bytes = |name: &str| std::fs::read(folder.path(name)).unwrap();
    write_field(&folder, SIDE, |row, col| -height(row, col));
    done(&folder, "openness field.npy -o negated.npy");
    write_field(&folder, SIDE, height);
    done(&folder, "openness field.npy -o negative.npy --negative");
    done(&folder, "openness field.npy -o positive.npy");
    assert!(bytes("negative.npy") == bytes("negated.npy"));
    assert!(bytes("negative.npy") != bytes("positive.npy"));
}

/// `ao` and `svf` are the layer `sky_view` of `render`, and its light under a sky of radiance 1.
#[test]
fn gpu_ambient_occlusion_is_the_light_of_a_uniform_sky() {
    let folder = Folder::new();
    write_field(&folder, SIDE, |row, col| ((row * 7919 + col * 104_729) % 613) as f32 * 0.01);
    done(&folder, "render field.npy -o r.exr --sky 1 --layers sky-view --azimuths 16");
    let rendered = read(&folder.path("r.exr"));
    for command in ["ao", "svf"] {
        done(&folder, &format!("{command} field.npy -o o.exr --azimuths 16"));
        let map = read(&folder.path("o.exr"));
        assert_eq!(map.names, ["sky_view"]);
        assert_eq!(map.planes[0], plane(&rendered, "sky_view"), "{command}");
        for (share, light) in map.planes[0].iter().zip(plane(&rendered, "R")) {
            assert!((share - light).abs() < 1e-5, "{command}: {share}, {light}");
        }
    }
    let run = folder.run_str("svf field.npy -o o.exr --bounces 2");
    assert!(run.err.contains("note: --bounces 2 changes nothing for this map"), "{}", run.err);
}
