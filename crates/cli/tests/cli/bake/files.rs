//! `bake`: refusals, files and their manifest.

use serde_json::Value;
use std::f64::consts::SQRT_2;

use crate::needs_vulkan::{done, json, write_field};
use crate::{Folder, read, refused};

#[test]
fn wrong_requests_are_refused() {
    let folder = Folder::new();
    folder.write("taken", b"");
    #[cfg(unix)]
    std::os::unix::fs::symlink("nowhere", folder.path("link")).unwrap();
    let with = |rest: &str| format!("bake a.asc -o out {rest}");
    let horizon = |rest: &str| with(&format!("--what horizon {rest}"));
    let all = [
        ("bake a.asc --what horizon".to_owned(), 2, &["--output"][..]),
        (with(""), 2, &["--what"]),
        (with("--what horizons"), 2, &["--what: found horizons", "horizon, sky-view, visible-sky"]),
        (horizon(" --what sky-view,horizon").replace("  ", " "), 2, &["horizon twice"]),
        (horizon("--format ktx"), 2, &["ktx", "ktx2"]),
        (horizon("--format npy,npy"), 2, &["--format: found npy twice"]),
        (horizon("--encoding unorm16-sin"), 2, &["KIND=ENCODING"]),
        (
            horizon("--encoding horizon=unorm16"),
            2,
            &["horizon=ENCODING, ENCODING one of", "unorm16-sin"],
        ),
        (horizon("--encoding sky-view=unorm8"), 2, &["found one of sky-view"]),
        (
            horizon("--encoding horizon=f32,horizon=snorm8-angle"),
            2,
            &["--encoding: found two of horizon"],
        ),
        (
            horizon("--encoding horizon=f32 --format png"),
            2,
            &["found png with f32 of horizon", "ktx2"],
        ),
        (
            with("--what bent-normal --encoding bent-normal=snorm8-xyz --format png"),
            2,
            &["found png with snorm8-xyz of bent-normal"],
        ),
        (
            horizon("--encoding horizon=unorm16-sin --border open"),
            2,
            &["found unorm16-sin with --border open", "snorm16-angle"],
        ),
        (with("--what sh-transfer --sh-order 6"), 2, &["--sh-order", "found 6", "2 to 5"]),
        (with("--what sh-visibility --sh-order 7"), 2, &["--sh-order: found 7"]),
        (horizon("--azimuths 3"), 2, &["--azimuths: found 3"]),
        (
            horizon("--method sweep --lines exact"),
            2,
            &["--lines: found exact", "--method brute-force"],
        ),
        (horizon("--memory-budget 0"), 1, &["needs ", "0 bytes of --memory-budget"]),
        (horizon("--directions 8"), 2, &["--directions: found 8", "ellipse, visible-points"]),
        (with("--what ellipse --directions 3"), 2, &["--directions: found 3", "4 to 4096"]),
        (with("--what ellipse --directions -1"), 2, &["--directions: found -1", "a whole number"]),
        (with("--what btf --angles -4x4"), 2, &["--angles: found -4x4", "as 8x16"]),
        (with("--what scatter --paths -1"), 2, &["--paths: found -1", "a whole number"]),
        (with("--what scatter --paths 4097"), 2, &["--paths: found 4097", "1 to 4096"]),
        (with("--what scatter --seed -1"), 2, &["--seed: found -1", "a whole number"]),
        (
            with("--what curved-ellipse --curvature -1"),
            2,
            &["--curvature: found -1.0 and -1.0", "above 0"],
        ),
        (
            with("--what curved-ellipse --curvature 1e300"),
            2,
            &["--curvature: found 1e300 and 1e300"],
        ),
        (with("--what ellipse --format png"), 2, &["found png with f16 of ellipse"]),
        (with("--what ellipse --memory-budget 0"), 1, &["needs ", "0 bytes of --memory-budget"]),
        (with("--what curved-ellipse"), 2, &["--curvature: found none", "OUT[,IN]"]),
        (with("--what curved-ellipse --curvature 1,2,3"), 2, &["--curvature", "OUT,IN"]),
        (with("--what curved-ellipse --curvature 0"), 2, &["--curvature: found 0.0 and 0.0"]),
        (with("--what ellipse --curvature 1"), 2, &["--curvature: found 1,1", "curved-ellipse"]),
        (horizon("--paths 8"), 2, &["--paths: found 8", "scatter, brdf"]),
        (horizon("--seed 8"), 2, &["--seed: found 8"]),
        (with("--what scatter --angles 4x8"), 2, &["--angles: found 4x8", "btf or light-field"]),
        (with("--what btf --angles 1x8"), 2, &["--angles: found 1x8", "2 to 64 zenith angles"]),
        (with("--what btf --angles 64x64 --plan"), 2, &["--angles: found 64x64", "at most 65536"]),
        (with("--what btf --angles 4"), 2, &["--angles", "as 8x16"]),
        (
            with("--what brdf-harmonics --border periodic --sh-order 3 --angles 2x4"),
            2,
            &["--angles: found 2x4 with --sh-order 3", "9 angles or more"],
        ),
        (with("--what brdf"), 2, &["--border: found plane with --what brdf", "periodic"]),
        (
            with("--what scatter --bounces 0"),
            2,
            &["--bounces: found 0 with --what scatter", "1 to 64"],
        ),
        (with("--what scatter --paths 0"), 2, &["--paths: found 0"]),
        (
            with("--what scatter --albedo 0.5 --specular 5,0.1 --sphere-light 1,1,9,1,5"),
            2,
            &["specular and 1 key lights and sphere lights"],
        ),
        (with("--what light-field --sun 0,100"), 2, &["--sun"]),
        (horizon("--json out.txt"), 2, &["--json: found out.txt"]),
        ("bake none.asc -o out --what horizon".to_owned(), 1, &["none.asc"]),
        ("bake a.asc -o taken --what horizon".to_owned(), 2, &["-o", "the file taken"]),
        ("bake a.asc -o o.ktx2 --what horizon --format exr".to_owned(), 2, &["-o", "found o.ktx2"]),
        ("bake a.asc -o link --what horizon".to_owned(), 2, &["-o", "link, a broken link"]),
        ("bake a.asc -o no/out --what horizon".to_owned(), 2, &["-o", "a folder no that exists"]),
        (horizon(""), 1, &["driver"]),
    ];
    let all: Vec<(String, i32, &[&str])> =
        all.map(|(words, status, says)| (words.trim_end().to_owned(), status, says)).into();
    let cases: Vec<_> = all.iter().map(|(words, s, says)| (words.as_str(), *s, *says)).collect();
    refused(&folder, &cases);
    // An output at the input's path would overwrite it.
    std::fs::create_dir(folder.path("in")).unwrap();
    std::fs::rename(folder.path("a.npy"), folder.path("in/horizon.npy")).unwrap();
    let own = "bake in/horizon.npy -o in --what horizon --format npy";
    refused(&folder, &[(own, 2, &["-o", "which is an input"])]);
}

/// `--plan` lists each file with its largest size, and memory of host and device. It runs and writes nothing.
#[test]
fn a_plan_lists_sizes_and_memory() {
    let folder = Folder::new();
    let before = folder.contents();
    let words =
        "bake a.asc -o out --what horizon,sky-view,sh-visibility --azimuths 8 --sh-order 3 --plan";
    let run = folder.run_without_driver(&words.split(' ').collect::<Vec<_>>());
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    let said = |what: &str| -> u64 {
        let line = run.out.lines().find(|l| l.ends_with(what));
        let line = line.unwrap_or_else(|| panic!("{what} in\n{}", run.out));
        line.split_whitespace().next().unwrap().parse().unwrap()
    };
    // 12 texels: 8 layers of 2 bytes; 1 of 2; 3 layers of 4 coefficients of 2.
    for (file, texels) in
        [("horizon.ktx2", 192), ("sky_view.ktx2", 24), ("sh_visibility.ktx2", 288)]
    {
        assert!((texels..texels + 2048).contains(&said(file)), "{file}");
    }
    for file in ["horizon.glsl", "sky_view.png", "sh_visibility.exr", "manifest.json"] {
        assert!(said(file) > 0);
    }
    // Nine sums of 8 bytes are the largest host memory; the device holds the heights at least.
    assert!(said("memory of this process") >= 12 * 9 * 8);
    assert!(run.out.contains("memory on lavapipe"), "{}", run.out);
    assert_eq!(folder.contents(), before);
}

fn map<'a>(manifest: &'a Value, kind: &str) -> &'a Value {
    let all = manifest["maps"].as_array().unwrap();
    all.iter().find(|map| map["kind"] == kind).unwrap_or_else(|| panic!("{kind} in {all:?}"))
}

/// A field of a wall, its maps in every format.
#[test]
fn gpu_every_file_is_there_and_listed() {
    let folder = Folder::new();
    write_field(&folder, 9, |_, c| if c == 6 { 3.0 } else { 0.0 });
    let kinds = "horizon,sky-view,visible-sky,bent-normal";
    done(
        &folder,
        &format!("bake field.npy -o out --what {kinds} --azimuths 8 --format exr,png,npy,ktx2"),
    );
    done(
        &folder,
        "bake field.npy -o out2 --what sh-visibility,sh-transfer --sh-order 2 --azimuths 8",
    );
    done(
        &folder,
        "bake field.npy -o out3 --what ellipse,visible-points --directions 9 --format exr,npy,ktx2",
    );
    let manifests =
        ["out", "out2", "out3"].map(|out| json(&folder.path(&format!("{out}/manifest.json"))));
    for (manifest, out) in manifests.iter().zip(["out", "out2", "out3"]) {
        let mut listed = vec!["manifest.json".to_owned()];
        for map in manifest["maps"].as_array().unwrap() {
            listed.push(map["decoder"].as_str().unwrap().to_owned());
            for file in map["files"].as_array().unwrap() {
                let name = file["file"].as_str().unwrap();
                let length = std::fs::metadata(folder.path(out).join(name)).unwrap().len();
                assert_eq!(file["bytes"], length, "{name}");
                assert!(!file["error"].as_array().unwrap().is_empty(), "{name}");
                assert!(!file["decoding"].as_str().unwrap().is_empty(), "{name}");
                // Vulkan requires these texture formats of no device.
                let holds = file["texels"].as_str().unwrap();
                let is_asked = holds.ends_with("16_UNORM") || holds.ends_with("16_SNORM");
                assert_eq!(file["sampled"].is_string(), is_asked, "{name}: {holds}");
                listed.push(name.to_owned());
            }
            assert!(map["beyond_range"].is_null(), "{map}");
        }
        let entries = std::fs::read_dir(folder.path(out)).unwrap();
        let mut there: Vec<String> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        listed.sort();
        there.sort();
        assert_eq!(listed, there);
        for decoder in there.iter().filter(|name| name.ends_with(".glsl")) {
            let text = std::fs::read_to_string(folder.path(out).join(decoder)).unwrap();
            assert!(text.lines().count() <= 20, "{decoder} has {} lines", text.lines().count());
        }
    }
    // Eight pictures of a horizon's azimuths, one of each other kind.
    let pictures = |kind: &str| {
        let files = map(&manifests[0], kind)["files"].as_array().unwrap().iter();
        files.filter(|f| f["format"] == "png").count()
    };
    assert_eq!(["horizon", "sky-view", "bent-normal"].map(pictures), [8, 1, 1]);
    // Pictures and the texture are counter-clockwise from east, the map's planes by compass.
    let named = map(&manifests[0], "horizon");
    assert_eq!([&named["planes"][0], &named["planes"][1]], ["azimuth_000.0", "azimuth_045.0"]);
    let file = |name: &str| {
        let mut files = named["files"].as_array().unwrap().iter();
        files.find(|file| file["file"] == name).unwrap()
    };
    assert_eq!(file("horizon_0000.png")["planes"], serde_json::json!(["azimuth_090.0"]));
    assert_eq!(file("horizon_0002.png")["planes"], serde_json::json!(["azimuth_000.0"]));
    assert_eq!(file("horizon.ktx2")["planes"][7], "azimuth_135.0");
    // As the decoder says, 2v - 1 of a pixel is the fraction of a right angle, in the plane that the entry names.
    let values = read(&folder.path("out/horizon.npy")).planes;
    for k in 0..8 {
        let name = format!("horizon_{k:04}.png");
        let entry = file(&name);
        let mut names = named["planes"].as_array().unwrap().iter();
        let plane = &values[names.position(|plane| *plane == entry["planes"][0]).unwrap()];
        let most = entry["error"][0]["at_most"].as_f64().unwrap();
        // Not by `read`, which takes codes for sRGB.
        let picture = image::open(folder.path("out").join(&name)).unwrap().into_luma16();
        for (code, want) in picture.iter().zip(plane) {
            let v = f64::from(*code) / 65535.0;
            let found = (2.0 * v - 1.0) * std::f64::consts::FRAC_PI_2;
            assert!((found - f64::from(*want)).abs() <= most, "{name}: {found} for {want}");
        }
    }
    // Only a picture of values below 0 is stored otherwise than a texture.
    let decoder = |name: &str| std::fs::read_to_string(folder.path("out").join(name)).unwrap();
    assert!(decoder("horizon.glsl").contains("pass 2v - 1"));
    assert!(!decoder("sky_view.glsl").contains("2v - 1"));
    assert_eq!(manifests[0]["settings"]["azimuths"], 8);
    assert_eq!(manifests[2]["directions"].as_array().unwrap().len(), 9);
    // A closed net of n points all over the sphere has 2 n - 4 triangles (Euler).
    let net = map(&manifests[2], "visible-points")["triangles"].as_array().unwrap();
    assert_eq!(net.len(), 14, "{net:?}");
    assert!(net.iter().flat_map(|t| t.as_array().unwrap()).all(|i| i.as_u64().unwrap() < 9));
    assert!(manifests[0]["directions"].is_null() && manifests[2]["horizons"].is_null());
    assert_eq!(manifests[0]["settings"]["method"], "sweep");
    // The hash is the field's, whatever is baked, and stands in the files.
    let hash = manifests[0]["field"]["hash"].as_str().unwrap().to_owned();
    assert_eq!(manifests[1]["field"]["hash"], hash.as_str());
    let exr = crate::needs_vulkan::attributes(&folder.path("out/sky_view.exr"));
    assert_eq!(exr["field_hash"], hash);
    assert!(exr.keys().all(|name| name != "ridgelight.field_hash"), "{exr:?}");
    // The same bake again, over the first, is the same bit for bit.
    let kept = |folder: &Folder| std::fs::read(folder.path("out2/sh_transfer.ktx2")).unwrap();
    let first = kept(&folder);
    let again = "bake field.npy -o out2 --what sh-transfer,sh-visibility --sh-order 2 --azimuths 8";
    done(&folder, &format!("{again} --quiet --format ktx2"));
    assert!(kept(&folder) == first);
    // Files of the earlier bake are gone with its manifest; other files stay.
    assert!(!folder.path("out2/sh_transfer.exr").exists());
    folder.write("out/horizon_0009.png", b"somebody's");
    done(&folder, &format!("bake field.npy -o out --what {kinds} --azimuths 4 --format png"));
    let pictures = |k: usize| folder.path(&format!("out/horizon_{k:04}.png")).exists();
    assert_eq!([0, 3, 4, 7, 9].map(pictures), [true, true, false, false, true]);
    // Other kinds would replace its manifest.
    let other = "bake field.npy -o out --what horizon";
    refused(&folder, &[(other, 2, &["-o", "out with sky-view in its manifest.json"])]);
}

/// No file is larger than planned: a manifest of many pictures is long.
#[test]
fn gpu_files_are_no_larger_than_planned() {
    let folder = Folder::new();
    write_field(&folder, 4, |r, c| (r * c) as f32);
    let words = "bake field.npy -o out --what horizon --azimuths 160 --format png,ktx2";
    let plan: Vec<&str> = words.split(' ').chain(["--plan"]).collect();
    let plan = folder.run_without_driver(&plan);
    assert_eq!((plan.status, plan.err.as_str()), (Some(0), ""));
    done(&folder, words);
    let mut count = 0;
    for entry in std::fs::read_dir(folder.path("out")).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let line = plan.out.lines().find(|line| line.ends_with(&format!("  {name}")));
        let most: u64 = line.unwrap().split_whitespace().next().unwrap().parse().unwrap();
        let length = entry.metadata().unwrap().len();
        assert!(length <= most, "{name}: {length} of {most}");
        count += 1;
    }
    // Pictures, texture, decoder, manifest.
    assert_eq!(count, 160 + 3);
}

/// Values are those of `horizon`, and a scene file gives what flags give.
#[test]
fn gpu_horizons_are_those_of_the_command_horizon() {
    let folder = Folder::new();
    write_field(&folder, 8, |r, c| ((r * 31 + c * 17) % 7) as f32);
    folder.write("scene.json", br#"{ "field": { "file": "field.npy", "cell_m": [2, 3] }, "quality": { "azimuths": 8, "method": "brute-force" } }"#);
    done(&folder, "horizon --scene scene.json -o h.npy");
    done(&folder, "bake --scene scene.json -o out --what horizon --format npy,exr,ktx2");
    let (kept, baked) = (read(&folder.path("h.npy")), read(&folder.path("out/horizon.npy")));
    assert_eq!(kept.planes, baked.planes);
    // Also with the defaults.
    let flags = "field.npy --cell 2,3 --azimuths 8";
    done(&folder, &format!("horizon {flags} -o default.npy"));
    done(&folder, &format!("bake {flags} -o default --what horizon --format npy"));
    let of = |name| read(&folder.path(name)).planes;
    assert_eq!(of("default.npy"), of("default/horizon.npy"));
    let layers = read(&folder.path("out/horizon.exr"));
    assert_eq!(layers.names[1], "azimuth_045.0");
    assert_eq!(layers.planes, baked.planes);
}

#[test]
fn gpu_voids_are_nan_transparent_and_filled() {
    let folder = Folder::new();
    folder.write("v.asc", b"ncols 4 nrows 3 cellsize 1 nodata_value -9 0 0 0 0 0 5 -9 0 0 0 0 0");
    const VOID: usize = 4 + 2;
    done(
        &folder,
        "bake v.asc -o out --what horizon,sky-view,bent-normal --azimuths 4 --format exr,npy,png,ktx2",
    );
    let path = |name: &str| folder.path("out").join(name);
    for name in ["horizon", "sky_view", "bent_normal"] {
        for format in ["exr", "npy"] {
            for plane in read(&path(&format!("{name}.{format}"))).planes {
                for (i, v) in plane.iter().enumerate() {
                    assert_eq!(v.is_nan(), i == VOID, "{name}.{format}, texel {i}: {v}");
                }
            }
        }
    }
    for name in ["horizon_0003.png", "sky_view.png", "bent_normal.png"] {
        let picture = read(&path(name));
        let alpha = crate::needs_vulkan::plane(&picture, "A");
        for (i, v) in alpha.iter().enumerate() {
            assert_eq!(*v, if i == VOID { 0.0 } else { 1.0 }, "{name}, texel {i}");
        }
    }
    // In a texture: the value of the filled surface, which filters read, and 0 in the mask component.
    let texels = |name: &str| {
        let bytes = std::fs::read(path(name)).unwrap();
        let reader = ktx2::Reader::new(&bytes).unwrap();
        let level = reader.levels().next().unwrap().data;
        level.as_chunks::<2>().0.iter().map(|b| u16::from_le_bytes(*b)).collect::<Vec<_>>()
    };
    let sky = texels("sky_view.ktx2");
    assert!(sky.iter().all(|code| *code > 0), "{sky:?}");
    let bent = texels("bent_normal.ktx2");
    for (i, texel) in bent.as_chunks::<4>().0.iter().enumerate() {
        assert_eq!(texel[3], if i == VOID { 0 } else { 65535 }, "texel {i}");
    }
    let manifest = json(&path("manifest.json"));
    assert_eq!(manifest["field"]["voids"], 1);
    for file in map(&manifest, "bent-normal")["files"].as_array().unwrap() {
        assert!(file["voids"].is_string(), "{file}");
    }
}

/// One texel, one row, one column, the steepest field allowed: every kind is finite and in range.
#[test]
fn gpu_extremes() {
    let folder = Folder::new();
    folder.write("one.asc", b"ncols 1 nrows 1 cellsize 1 7");
    folder.write("row.asc", b"ncols 5 nrows 1 cellsize 1 0 1e6 0 -1e6 3");
    folder.write("column.asc", b"ncols 1 nrows 3 cellsize 1e-3 0 5 0");
    folder.write("flat.asc", b"ncols 3 nrows 2 cellsize 1e9 0 0 0 0 0 1e-6");
    folder.write("steep.asc", b"ncols 2 nrows 2 cellsize 1 0 1e6 1e6 2e6");
    let kinds =
        "horizon,sky-view,visible-sky,bent-normal,sh-visibility,sh-transfer,ellipse,visible-points";
    for field in ["one", "row", "column", "flat", "steep"] {
        for border in ["plane", "open", "periodic"] {
            let out = format!("{field}_{border}");
            done(
                &folder,
                &format!(
                    "bake {field}.asc -o {out} --border {border} --what {kinds} --azimuths 4 --directions 4 \
                     --format npy,ktx2 --quiet"
                ),
            );
            let manifest = json(&folder.path(&out).join("manifest.json"));
            for map in manifest["maps"].as_array().unwrap() {
                let values = map["values"].as_array().unwrap();
                let name = map["kind"].as_str().unwrap().replace('-', "_");
                let planes = read(&folder.path(&out).join(format!("{name}.npy"))).planes;
                let mut beyond = (0_u64, 0.0_f64);
                for (i, plane) in planes.iter().enumerate() {
                    let range = &values[i.min(values.len() - 1)]["range"];
                    let [low, high] = [0, 1].map(|at| range[at].as_f64().unwrap());
                    for value in plane.iter().map(|v| f64::from(*v)) {
                        assert!(value.is_finite(), "{out}, {name}: {value}");
                        let off = (value - high).max(low - value);
                        // Rounding of f32, also of a sum of four azimuths, and of the device's functions.
                        if off > 8.0 * f64::from(f32::EPSILON) * low.abs().max(high.abs()) {
                            beyond = (beyond.0 + 1, beyond.1.max(off));
                        }
                    }
                }
                // Four azimuths are a coarse sum, which the manifest reports. Σ π/2 Y² is at most twice its integral, as of
                // cos² 2φ at four azimuths: coefficients are within √2 of their ranges, 3.545 at most. Others are within theirs:
                // a sky view integrates the cosine over each azimuth's width, so that no part of it counts twice.
                let most = match name.as_str() {
                    "sh_visibility" | "sh_transfer" => 3.545 * (SQRT_2 - 1.0),
                    _ => 0.0,
                };
                assert!(beyond.1 <= most, "{out}, {name}: {} beyond its range", beyond.1);
                let beyond_range = &map["beyond_range"];
                assert_eq!(beyond_range["values"].as_u64().unwrap_or(0), beyond.0, "{out}, {name}");
                // Ranges and this went through decimals.
                let off = beyond_range["at_most"].as_f64().unwrap_or(0.0) - beyond.1;
                assert!(off.abs() < 1e-12, "{out}, {name}: {off} from {}", beyond.1);
            }
        }
    }
    // The whole sky is visible from a level texel, to the nearest f32.
    let one = |name: &str| read(&folder.path("one_plane").join(name)).planes[0][0];
    assert_eq!([one("sky_view.npy"), one("visible_sky.npy")], [1.0, 1.0]);
    assert_eq!(one("horizon.npy"), 0.0);
}
