//! Results on the first driver.

use std::path::Path;

use ridgelight_io::Planes;

use crate::formats::{colour, hdr, npy, png};
use crate::{Folder, read, succeeded};

/// Runs a command that must succeed with an empty standard error (progress is for terminals) and one line on standard
/// output, beside azimuths, light and tone of a picture.
pub fn done(folder: &Folder, args: &str) {
    let run = succeeded(folder, args);
    let is_result = |line: &&str| {
        !["Azimuths: ", "Light: ", "Picture: "].iter().any(|word| line.starts_with(word))
    };
    let results = run.out.lines().filter(is_result).count();
    assert_eq!(results, usize::from(!args.contains("--quiet")), "{}", run.out);
    let hidden = folder
        .contents()
        .into_keys()
        .find(|p| p.file_name().is_some_and(|n| n.to_string_lossy().starts_with(".ridgelight")));
    assert_eq!(hidden, None, "{args}");
}

pub fn plane<'a>(planes: &'a Planes, name: &str) -> &'a [f32] {
    let at = planes.names.iter().position(|n| n == name);
    &planes.planes[at.unwrap_or_else(|| panic!("{name} in {:?}", planes.names))]
}

/// A square field of f32 heights, unit cells.
pub fn write_field(folder: &Folder, side: usize, height: impl Fn(usize, usize) -> f32) {
    let data: Vec<u8> =
        (0..side * side).flat_map(|i| height(i / side, i % side).to_le_bytes()).collect();
    folder.write("field.npy", &npy("<f4", false, &format!("({side}, {side})"), &data));
}

pub fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The string attributes of an EXR.
pub fn attributes(path: &Path) -> std::collections::BTreeMap<String, String> {
    let meta = exr::meta::MetaData::read_from_file(path, true).unwrap();
    let other = &meta.headers[0].own_attributes.other;
    other
        .iter()
        .filter_map(|(name, value)| match value {
            exr::meta::attribute::AttributeValue::Text(text) => {
                Some((name.to_string(), text.to_string()))
            }
            _ => None,
        })
        .collect()
}

#[test]
fn gpu_voids_are_nan_and_transparent() {
    let folder = Folder::new();
    folder.write("v.asc", b"ncols 4 nrows 3 cellsize 1 nodata_value -9 0 0 0 0 0 5 -9 0 0 0 0 0");
    const VOID: usize = 4 + 2;
    done(&folder, "render v.asc --sky 1 -o v.exr --layers lights,sky-view,horizon");
    let exr = read(&folder.path("v.exr"));
    assert_eq!(
        exr.names,
        ["B", "G", "R", "direct.sky.B", "direct.sky.G", "direct.sky.R", "horizon_mean", "sky_view"]
    );
    done(&folder, "horizon v.asc -o v.npy --azimuths 8 --distances far.npy");
    done(&folder, "horizon v.asc -o h.exr --azimuths 8");
    // Bounces use the filled void and add no note.
    for engine in ["brute-force", "sweep", "pyramid"] {
        let bounces =
            format!("--bounces 2 --bounce-engine {engine} --bounce-cutoff 0 --layers lights");
        done(&folder, &format!("render v.asc -o {engine}.exr --sky 1 {bounces}"));
        assert!(
            read(&folder.path(&format!("{engine}.exr"))).names.contains(&"indirect.2.R".into())
        );
    }
    for file in
        ["v.exr", "v.npy", "far.npy", "h.exr", "brute-force.exr", "sweep.exr", "pyramid.exr"]
    {
        let planes = read(&folder.path(file));
        for (name, plane) in planes.names.iter().zip(&planes.planes) {
            for (i, v) in plane.iter().enumerate() {
                assert_eq!(v.is_nan(), i == VOID, "{file}, {name}, texel {i}: {v}");
            }
        }
    }
    for command in
        ["render --sky 1 --exposure 1 --tint none", "hillshade", "shadow", "ao", "svf", "openness"]
    {
        done(&folder, &format!("{command} v.asc -o v.png"));
        let png = read(&folder.path("v.png"));
        for (i, alpha) in plane(&png, "A").iter().enumerate() {
            assert_eq!(*alpha, if i == VOID { 0.0 } else { 1.0 }, "{command}: texel {i}");
        }
    }
    // Without a void there is no alpha.
    done(&folder, "render a.asc -o a.png --sky 1 --exposure 1 --tint none");
    assert!(!read(&folder.path("a.png")).names.contains(&"A".to_owned()));
    // --nodata marks a void that the file does not: height 101 of 0 to 120.
    done(&folder, "render a.npy -o n.exr --sky 1 --nodata 101");
    let marked = read(&folder.path("n.exr"));
    assert_eq!(marked.planes[0].iter().position(|v| v.is_nan()), Some(9));
}

#[test]
fn gpu_default_sky_is_one() {
    let folder = Folder::new();
    write_field(&folder, 5, |_, _| 7.0);
    done(&folder, "render field.npy -o flat.exr --lines exact");
    // Flat and white under radiance 1 from the whole sky: exit radiance 1.
    for v in read(&folder.path("flat.exr")).planes.concat() {
        assert!((v - 1.0).abs() < 1e-5, "{v}");
    }
    done(&folder, "render field.npy -o red.exr --sky 2,1,0.5 --albedo 0.5 --quiet");
    let red = read(&folder.path("red.exr"));
    for (name, value) in [("R", 1.0), ("G", 0.5), ("B", 0.25)] {
        assert!(plane(&red, name).iter().all(|v| (v - value).abs() < 1e-5), "{name}");
    }
    // Another light replaces the default sky: a sun of irradiance π at the zenith gives 1.
    done(&folder, "render field.npy -o sun.exr --sun 0,90,0,3.14159265");
    for v in read(&folder.path("sun.exr")).planes.concat() {
        assert!((v - 1.0).abs() < 1e-5, "{v}");
    }
}

/// A ridge along north-south, 4 high, falling 1 a cell to both sides, in a field of 17.
#[test]
fn gpu_sun_in_the_east_lights_the_east_side() {
    let folder = Folder::new();
    write_field(&folder, 17, |_, c| (4.0 - (c as f32 - 8.0).abs()).max(0.0));
    done(&folder, "render field.npy -o sun.exr --sun 90,20,0");
    let sun = read(&folder.path("sun.exr"));
    let (sin, cos) = 20_f32.to_radians().sin_cos();
    for row in 0..17 {
        let at = |col: usize| plane(&sun, "R")[row * 17 + col];
        // The normal of the east side is (1, 0, 1)/√2, the sun stands at (cos 20°, 0, sin 20°);
        // white exit radiance of irradiance 1 is N·s/π.
        let east = (cos + sin) / 2_f32.sqrt() / std::f32::consts::PI;
        assert!((at(10) - east).abs() < 1e-5, "row {row}: {} for {east}", at(10));
        // Level ground: sin 20°.
        assert!((at(15) - sin / std::f32::consts::PI).abs() < 1e-5, "row {row}: {}", at(15));
        // The west side faces away; the ground behind it, up to 8 cells from the crest, lies in a
        // shadow of 4/tan 20° = 11 cells.
        for col in 0..8 {
            assert_eq!(at(col), 0.0, "row {row}, column {col}");
        }
    }
}

/// The ridge's shadow under a key light in the east, with its layer and settings.
#[test]
fn gpu_key_in_the_east_lights_the_east_side() {
    let folder = Folder::new();
    write_field(&folder, 17, |_, c| (4.0 - (c as f32 - 8.0).abs()).max(0.0));
    done(&folder, "render field.npy -o key.exr --key 90,20,30,10,2 --layers lights");
    let key = read(&folder.path("key.exr"));
    let [low, high] = [15_f32, 25.0].map(f32::to_radians);
    // Level ground: L width (sin²high - sin²low) / 2 over π.
    let level =
        30_f32.to_radians() * (high.sin().powi(2) - low.sin().powi(2)) / std::f32::consts::PI;
    for row in 4..13 {
        let at = |col: usize| plane(&key, "R")[row * 17 + col];
        assert!((at(15) - level).abs() < 1e-5 * level, "row {row}: {} for {level}", at(15));
        // The east side faces the light; the west side faces away from all of it.
        assert!(at(10) > 2.0 * level, "row {row}: {}", at(10));
        assert_eq!((at(6), at(4)), (0.0, 0.0), "row {row}");
    }
    assert_eq!(plane(&key, "direct.key1.R"), plane(&key, "R"));
    let of = attributes(&folder.path("key.exr"));
    assert_eq!(of.get("key1").map(String::as_str), Some("90,20,30,10,2,2,2"));
    assert!(!of.contains_key("sky"), "a key light takes the default sky's place");
}

/// Sides of a pyramid in the field's middle that are lit: north, east, south, west.
fn sides(folder: &Folder, args: &str) -> [f32; 4] {
    done(folder, &format!("render field.npy -o sides.exr {args}"));
    let exr = read(&folder.path("sides.exr"));
    let at = |r: usize, c: usize| plane(&exr, "R")[r * 17 + c];
    [at(5, 8), at(8, 11), at(11, 8), at(8, 5)]
}

fn write_pyramid(folder: &Folder) {
    write_field(folder, 17, |r, c| {
        6.0 - (r as f32 - 8.0).abs().max((c as f32 - 8.0).abs()).min(6.0)
    });
}

#[test]
fn gpu_suns_azimuth_is_the_compass() {
    let folder = Folder::new();
    write_pyramid(&folder);
    for (azimuth, lit) in [(0, 0), (90, 1), (180, 2), (270, 3), (-90, 3), (360, 0)] {
        let sides = sides(&folder, &format!("--sun {azimuth},30"));
        for (i, side) in sides.iter().enumerate() {
            // Sides of 45°: the one that faces the sun receives (cos 30° + sin 30°)/√2 = 0.97;
            // the neighbours sin 30°/√2 = 0.35; the one behind 0.
            let cosine = match (4 + i - lit) % 4 {
                0 => 0.965_93,
                1 | 3 => 0.353_55,
                _ => 0.0,
            };
            let expected = cosine / std::f32::consts::PI;
            // The disc of half a degree is sliced: within 1 %.
            assert!((side - expected).abs() < 0.01 * 0.31, "{azimuth}: {sides:?}");
        }
    }
}

#[test]
fn gpu_env_rotate_turns_clockwise() {
    let folder = Folder::new();
    write_pyramid(&folder);
    // Light from the picture's middle, 22.5° to both sides and above the horizon: east.
    let mut texels = vec![[0, 0, 0, 0]; 32 * 16];
    for row in 4..8 {
        texels[row * 32 + 14..row * 32 + 18].fill([128, 128, 128, 131]);
    }
    folder.write("env.hdr", &hdr(32, 16, "", &texels));
    for (degrees, lit) in [("0", 1), ("90", 2), ("180", 3), ("-90", 0), ("450", 2)] {
        let sides = sides(&folder, &format!("--env env.hdr --env-rotate {degrees}"));
        for i in (0..4).filter(|i| *i != lit) {
            assert!(sides[lit] > 2.0 * sides[i], "{degrees}°: {sides:?}");
        }
    }
}

/// A wall 10 high along column 12 of a level field.
#[test]
fn gpu_horizons_begin_in_the_north() {
    let folder = Folder::new();
    write_field(&folder, 17, |_, c| if c == 12 { 10.0 } else { 0.0 });
    done(&folder, "horizon field.npy -o h.npy --azimuths 8 --distances far.npy --json h.json");
    let bytes = std::fs::read(folder.path("h.npy")).unwrap();
    let header = String::from_utf8_lossy(&bytes[..128]).into_owned();
    for said in ["'descr': '<f4'", "'fortran_order': False", "'shape': (8, 17, 17,)"] {
        assert!(header.contains(said), "{said} in {header}");
    }
    let (angles, far) = (read(&folder.path("h.npy")), read(&folder.path("far.npy")));
    let at = |k: usize, r: usize, c: usize| angles.planes[k][r * 17 + c];
    for row in 0..17 {
        // East (k = 2) of (row, 4) the wall is 8 away, west (6) there is none; and the other way
        // round.
        assert!((at(2, row, 4) - (10_f32 / 8.0).atan()).abs() < 1e-5, "{}", at(2, row, 4));
        assert!((at(6, row, 15) - (10_f32 / 3.0).atan()).abs() < 1e-5, "{}", at(6, row, 15));
        assert!((far.planes[2][row * 17 + 4] - 8.0).abs() < 1e-3);
        for (k, col) in [(6, 4), (0, 4), (4, 4), (2, 15), (0, 15)] {
            assert_eq!(at(k, row, col), 0.0, "azimuth {k}, row {row}, column {col}");
            assert_eq!(far.planes[k][row * 17 + col], 0.0);
        }
    }
    // Clockwise: k = 1 is the north-east. From the south-west corner's row the wall is met
    // 8 columns east and 8 rows north; from row 4 the diagonal leaves the field before.
    assert!((at(1, 16, 4) - (10_f32 / 128_f32.sqrt()).atan()).abs() < 1e-5, "{}", at(1, 16, 4));
    assert_eq!(at(1, 4, 4), 0.0);
    // k = 3 is the south-east.
    assert!((at(3, 0, 4) - (10_f32 / 128_f32.sqrt()).atan()).abs() < 1e-5, "{}", at(3, 0, 4));
    let mut about = json(&folder.path("h.json"));
    // An .npy has no place for its unit.
    assert_eq!(about["settings"]["values"], "elevation of the horizon, rad");
    let degrees: Vec<f64> = serde_json::from_value(about["azimuths_deg"].take()).unwrap();
    assert_eq!(degrees, [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0]);

    done(&folder, "horizon field.npy -o h.exr --azimuths 8");
    let exr = read(&folder.path("h.exr"));
    let names: Vec<_> = (0..8).map(|k| format!("azimuth_{:03}.0", 45 * k)).collect();
    assert_eq!(exr.names, names);
    assert_eq!(exr.planes, angles.planes);
    done(&folder, "compare h.npy h.npy --horizons");

    // Of 64 azimuths a name has the decimals of its azimuth.
    done(&folder, "horizon field.npy -o many.exr --azimuths 64");
    let names = read(&folder.path("many.exr")).names;
    assert_eq!(names[..3], ["azimuth_000.0", "azimuth_005.625", "azimuth_011.25"]);

    // Exact azimuths are uneven; the JSON file lists them.
    done(&folder, "horizon field.npy -o x.npy --azimuths 8 --lines exact --json x.json");
    assert_eq!(json(&folder.path("x.json"))["azimuths_deg"].as_array().unwrap().len(), 8);
    assert_eq!(read(&folder.path("x.npy")).planes.len(), 8);
}

#[test]
fn gpu_settings_really_used_are_written() {
    let folder = Folder::new();
    done(
        &folder,
        "render a.asc -o out.exr --sun 135,30 --sky 0.25 --albedo 0.5 --z-scale 2 --cell 10,20 --azimuths 16 --json out.json",
    );
    let (exr, json) = (attributes(&folder.path("out.exr")), json(&folder.path("out.json")));
    for (name, value) in [
        ("ridgelight", env!("CARGO_PKG_VERSION")),
        ("input", "a.asc"),
        ("rows", "3"),
        ("cols", "4"),
        ("cell_m", "10,20"),
        ("z_scale", "2"),
        ("border", "plane"),
        ("method", "sweep"),
        ("azimuths", "16"),
        ("sun_azimuths", "8"),
        ("albedo", "0.5"),
        ("sky", "0.25,0.25,0.25"),
        ("sun1", "135,30,0.53,1,1,1"),
    ] {
        assert_eq!(exr.get(name).map(String::as_str), Some(value), "{name}");
    }
    for name in ["commit", "device", "driver", "device_bytes", "lines"] {
        assert!(exr.get(name).is_some_and(|v| !v.is_empty()), "{name} in {exr:?}");
    }
    // Times are in --json only.
    assert!(!exr.keys().any(|name| name.contains("_ms") || name.contains("seconds")), "{exr:?}");
    // The JSON file holds the same as numbers, and each pass's time.
    let plain = |value: &serde_json::Value| match value {
        serde_json::Value::String(text) => text.clone(),
        other => other.to_string().trim_matches(['[', ']']).to_owned(),
    };
    for (name, value) in &exr {
        let found = &json["settings"][name];
        let number = |t: &str| t.parse::<f64>().ok();
        let same = plain(found) == *value || (found.is_number() && found.as_f64() == number(value));
        assert!(same, "{name}: {found} for {value}");
    }
    for name in ["rows", "azimuths", "device_bytes", "gpu_ms", "z_scale", "albedo"] {
        assert!(json["settings"][name].is_number(), "{name}: {}", json["settings"][name]);
    }
    assert_eq!(json["settings"]["cell_m"], serde_json::json!([10, 20]));
    assert_eq!(json["settings"]["lines"], "1");
    let passes = json["passes"].as_array().unwrap();
    assert!(passes.iter().all(|p| p["ns"].as_f64().is_some_and(|ns| ns >= 0.0)), "{passes:?}");
    assert!(passes.iter().any(|p| p["pass"] == "shadow_shade sun1"), "{passes:?}");

    // A .png holds the same without times, and its exposure.
    let exposure = "exposure".to_owned();
    done(
        &folder,
        "render a.asc -o out.png --sun 135,30 --sky 0.25 --albedo 0.5 --z-scale 2 --cell 10,20 --azimuths 16",
    );
    let file = std::io::BufReader::new(std::fs::File::open(folder.path("out.png")).unwrap());
    let png = png::Decoder::new(file).read_info().unwrap();
    let texts = &png.info().uncompressed_latin1_text;
    let texts: std::collections::BTreeMap<_, _> =
        texts.iter().map(|t| (t.keyword.clone(), t.text.clone())).collect();
    let mut names: Vec<_> = exr.keys().chain([&exposure]).collect();
    names.sort();
    assert_eq!(texts.keys().collect::<Vec<_>>(), names);
    for (name, value) in &exr {
        assert_eq!(texts.get(name), Some(value), "{name}");
    }

    done(&folder, "horizon a.asc -o h.exr --azimuths 8 --fuse nearest --precision f16");
    let exr = attributes(&folder.path("h.exr"));
    for (name, value) in [("azimuths", "8"), ("fuse", "nearest"), ("precision", "f16")] {
        assert_eq!(exr.get(name).map(String::as_str), Some(value), "{name}");
    }
}

#[test]
fn gpu_outputs_replace_what_was_there() {
    let folder = Folder::new();
    for name in ["out.png", "out.exr", "out.npy"] {
        folder.write(name, b"what was here before");
    }
    done(&folder, "render a.asc -o out.png --quiet");
    done(&folder, "render a.asc --sky 1 -o out.exr");
    done(&folder, "horizon a.asc -o out.npy --azimuths 4");
    assert_eq!(read(&folder.path("out.png")).names, ["R", "G", "B"]);
    assert_eq!(read(&folder.path("out.exr")).cols, 4);
    assert_eq!(read(&folder.path("out.npy")).planes.len(), 4);
    // A sufficient budget gives the same image.
    done(&folder, "render a.asc --sky 1 -o small.exr --memory-budget 8KiB");
    assert_eq!(read(&folder.path("small.exr")), read(&folder.path("out.exr")));
}

#[test]
fn gpu_devices_are_listed_and_chosen() {
    let folder = Folder::new();
    let run = folder.run(&["devices", "--json", "devices.json"]);
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    let devices = json(&folder.path("devices.json"));
    let name = devices[0]["name"].as_str().unwrap();
    assert!(run.out.contains(name));
    for wanted in [name.to_uppercase().as_str(), "0"] {
        let args = ["render", "a.asc", "-o", "out.png", "--device", wanted];
        assert_eq!(folder.run(&args).status, Some(0), "{wanted}");
        let run = folder.run(&["plan", "a.asc", "--device", wanted]);
        assert!(run.out.starts_with(&format!("Plan for {name}\n")), "{}", run.out);
    }
    std::fs::remove_file(folder.path("out.png")).unwrap();
    let before = folder.contents();
    for command in ["plan a.asc", "render a.asc -o out.png", "horizon a.asc -o out.npy"] {
        let args: Vec<_> = command.split(' ').chain(["--device", "nosuch"]).collect();
        let run = folder.run(&args);
        assert_eq!((run.status, run.err.lines().count()), (Some(1), 1), "{}", run.err);
        assert!(run.err.contains("nosuch") && run.err.contains(name), "{}", run.err);
    }
    assert!(folder.contents() == before);
}

/// The budget sets how many azimuths run together, down to one. A larger budget is never refused where a smaller one
/// works, and the horizons are the same.
#[test]
fn gpu_tight_budgets_are_met_with_fewer_azimuths_at_a_time() {
    let folder = Folder::new();
    write_field(&folder, 64, |r, c| ((7 * r + 3 * c) % 11) as f32);
    let args =
        "horizon field.npy -o h.npy --distances d.npy --azimuths 5 --method brute-force --quiet";
    done(&folder, args);
    let whole = [read(&folder.path("h.npy")), read(&folder.path("d.npy"))];
    let mut refused = 0;
    let mut met = 0;
    // One azimuth takes six planes of 64² f32, 16 KiB each, and its own few bytes: heights as they
    // are and by lanes, angles, distances, and a lattice of two layers.
    for kib in (96..=224).step_by(8) {
        let budgeted = format!("{args} --memory-budget {kib}KiB");
        let run = folder.run_str(&budgeted);
        if run.status == Some(0) {
            met += 1;
            assert!([read(&folder.path("h.npy")), read(&folder.path("d.npy"))] == whole, "{kib}");
        } else {
            refused += 1;
            assert_eq!(met, 0, "{kib} KiB refused, less was not: {}", run.err);
            assert!(run.err.contains("--memory-budget"), "{}", run.err);
        }
    }
    assert!(refused > 0 && met > 0, "{refused} refused, {met} met");
}

/// A field too long for any image is refused by its header: these files have no heights, or wrong ones.
#[test]
fn gpu_fields_beyond_the_device_are_refused_unread() {
    let folder = Folder::new();
    folder.write("long.png", &png(40_000, 3, colour::GREY, 8, &[], &[0; 12]));
    folder.write("long.npy", &npy("<f4", false, "(3, 40000)", &[]));
    folder.write("long.asc", b"ncols 40000 nrows 3 cellsize 1 0 0 0");
    let zeros = || exr::prelude::FlatSamples::F32(vec![0.0; 40_000]);
    let whole = crate::formats::exr(40_000, 1, &[("Z", zeros())]);
    folder.write("long.exr", &whole[..whole.len() - 30]);
    let mut image = std::io::Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut image).unwrap();
    let deflate = tiff::encoder::Compression::Deflate(tiff::encoder::DeflateLevel::Fast);
    encoder = encoder.with_compression(deflate);
    encoder.write_image::<tiff::encoder::colortype::Gray8>(40_000, 1, &[0; 40_000]).unwrap();
    let mut image = image.into_inner();
    image[8..16].fill(0xff);
    folder.write("long.tif", &image);
    let before = folder.contents();
    for name in ["long.png", "long.npy", "long.asc", "long.exr", "long.tif"] {
        for command in ["plan", "render -o o.exr", "horizon -o o.npy", "reference -o o.exr"] {
            let args: Vec<_> = command.split(' ').chain([name]).collect();
            let run = folder.run(&args);
            assert_eq!((run.status, run.err.lines().count()), (Some(1), 1), "{}", run.err);
            let said = format!("ridgelight: {name}: a field of 40000 × ");
            assert!(run.err.starts_with(&said), "{command}: {}", run.err);
            assert!(
                run.err.contains("needs images 40000 texels long, the limit is "),
                "{}",
                run.err
            );
        }
    }
    // A budget too small for the heights is refused without a device.
    let run = folder.run_without_driver(&["plan", "long.npy", "--memory-budget", "300KiB"]);
    let said =
        "long.npy: a field of 40000 × 3: needs 468.8 KiB for its heights, the limit is 300.0 KiB";
    assert!(run.err.contains(said), "{}", run.err);
    assert!(folder.contents() == before);
}
