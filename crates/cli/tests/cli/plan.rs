//! `plan`: needs no device and runs nothing.

use std::collections::HashSet;
use std::io::Write as _;
use std::process::{Command, Stdio};

use crate::formats::{HEIGHTS, Tag, colour, exr, png, sparse_tiff, tiff};
use crate::{Folder, refused, succeeded};
use ::exr::prelude::FlatSamples;
use ::tiff::encoder::{Compression, colortype};
use ::tiff::tags::Predictor;
use ridgelight::scene::HeightField;
use serde_json::{Value, json};

const LIT: [&str; 6] = ["plan", "a.asc", "--sky", "1", "--sun", "135,30"];

fn planned(folder: &Folder, format: &str) -> String {
    let run = folder.run_without_driver(&[&LIT[..], &["--format", format]].concat());
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{format}");
    run.out
}

#[test]
fn text_names_passes_and_memory() {
    let folder = Folder::new();
    let text = planned(&folder, "text");
    for said in
        ["lavapipe", "4 × 3", "azimuths 32", "horizon_sweep sky", "shadow_shade sun1", "why"]
    {
        assert!(text.contains(said), "{said:?} in\n{text}");
    }
    let quiet = folder.run_without_driver(&[&LIT[..], &["--quiet"]].concat());
    assert_eq!((quiet.status, quiet.out.as_str(), quiet.err.as_str()), (Some(0), "", ""));
}

#[test]
fn json_is_whole_and_refers_to_what_is_there() {
    let folder = Folder::new();
    let plan: serde_json::Value = serde_json::from_str(&planned(&folder, "json")).unwrap();
    let names: HashSet<&str> =
        plan["resources"].as_array().unwrap().iter().map(|r| r["name"].as_str().unwrap()).collect();
    assert!(names.contains("heights") && names.contains("radiance"), "{names:?}");
    let passes = plan["passes"].as_array().unwrap();
    for pass in passes {
        for used in ["reads", "writes"].iter().flat_map(|k| pass[*k].as_array().unwrap()) {
            assert!(names.contains(used.as_str().unwrap()), "{used} of {pass}");
        }
        assert!(!pass["writes"].as_array().unwrap().is_empty(), "{pass}");
        assert!(!pass["why"].as_str().unwrap().is_empty(), "{pass}");
    }
    assert!(passes.iter().any(|p| p["pass"] == "shadow_shade"));
    let bytes = |v: &serde_json::Value| v["bytes"].as_u64().unwrap();
    let sum: u64 = plan["resources"].as_array().unwrap().iter().map(bytes).sum();
    assert_eq!(bytes(&plan), sum);
    assert_eq!(plan["size"], serde_json::json!([4, 3]));
    assert_eq!(plan["settings"]["azimuths"], 32);

    let run = folder.run_without_driver(&[&LIT[..], &["--json", "plan.json"]].concat());
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    let file = std::fs::read(folder.path("plan.json")).unwrap();
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&file).unwrap(), plan);
}

const VISIBLE: [&str; 6] = ["--camera", "200,30", "--size", "20x10", "--samples", "4"];

/// 20 × 10 pixels of 4 MSAA samples: 16 bytes of colour and 4 of depth per sample, and per pixel. The field of 4 × 3 is one
/// tile of 17 × 17 vertices.
#[test]
fn a_camera_adds_its_passes_and_their_memory() {
    let folder = Folder::new();
    let run = |more: &[&str]| {
        let run = folder.run_without_driver(&[&LIT[..], &VISIBLE, more].concat());
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
        run.out
    };
    let text = run(&[]);
    for said in
        ["terrain_draw", "sky_draw", "no picture_tone", "289", "lens perspective 40", "depth"]
    {
        assert!(text.contains(said), "{said:?} in\n{text}");
    }
    let plan: serde_json::Value = serde_json::from_str(&run(&["--format", "json"])).unwrap();
    let all = |key: &str| plan[key].as_array().unwrap().clone();
    let names: HashSet<String> =
        all("resources").iter().map(|r| r["name"].as_str().unwrap().to_owned()).collect();
    let passes = all("passes");
    let drawn: Vec<_> = passes.iter().filter(|p| p["vertices"].is_u64()).collect();
    let names_drawn: Vec<_> = drawn.iter().map(|p| &p["pass"]).collect();
    assert_eq!(names_drawn, ["terrain_draw", "sky_draw", "depth_resolve"]);
    assert_eq!((&drawn[0]["vertices"], &drawn[1]["vertices"]), (&289.into(), &3.into()));
    for used in drawn.iter().flat_map(|p| [&p["reads"], &p["writes"]]) {
        for name in used.as_array().unwrap() {
            assert!(names.contains(name.as_str().unwrap()), "{name} in {names:?}");
        }
    }
    // Colour and depth of 800 MSAA samples, 289 heights of 4 bytes, radiance of 12 texels, one channel.
    assert_eq!(drawn[0]["bytes"], 800 * 20 + 289 * 4 + 12 * 4);
    let bytes = |v: &serde_json::Value| v["bytes"].as_u64().unwrap();
    assert_eq!(bytes(&plan), all("resources").iter().map(bytes).sum::<u64>());
    let of = |name: &str| all("resources").iter().find(|r| r["name"] == name).map(bytes);
    assert_eq!((of("picture"), of("depth")), (Some(200 * 16), Some(200 * 4)));
    assert_eq!((of("picture_samples"), of("picture_depth")), (Some(800 * 16), Some(800 * 4)));
    assert_eq!(plan["settings"]["picture_size"], "20x10");
    assert!(all("notes").iter().any(|n| n.as_str().unwrap().contains("picture_tone")));
    let dot = run(&["--format", "dot"]);
    for label in ["terrain_draw", "sky_draw", "picture_samples"] {
        assert!(dot.contains(&format!("label=\"{label}\"")), "{label} in\n{dot}");
    }
    is_graph(&dot);
}

#[test]
fn dot_is_a_graph_of_declared_nodes() {
    is_graph(&planned(&Folder::new(), "dot"));
}

fn is_graph(dot: &str) {
    let mut lines = dot.lines();
    assert_eq!(lines.next(), Some("digraph plan {"));
    assert_eq!(lines.next_back(), Some("}"));
    let mut nodes = HashSet::new();
    let mut edges = 0;
    for line in lines {
        let line = line.trim().strip_suffix(';').expect("statements end in semicolons");
        if let Some((from, to)) = line.split_once(" -> ") {
            assert!(nodes.contains(from) && (nodes.contains(to) || to.starts_with('p')), "{line}");
            // One end is a pass, the other an image or buffer.
            assert_ne!(from.starts_with('p'), to.starts_with('p'), "{line}");
            edges += 1;
        } else if let Some((node, rest)) = line.split_once(" [") {
            assert!(rest.ends_with(']') && rest.matches('"').count() % 2 == 0, "{line}");
            nodes.insert(node);
        }
    }
    assert!(edges > nodes.len() / 2, "{edges} edges among {} nodes", nodes.len());
    // Graphviz checks it too, where installed.
    let mut graphviz = Command::new("dot");
    graphviz.arg("-Tplain").stdin(Stdio::piped()).stdout(Stdio::null());
    if let Ok(mut child) = graphviz.spawn() {
        child.stdin.take().unwrap().write_all(dot.as_bytes()).unwrap();
        assert!(child.wait().unwrap().success(), "graphviz refuses\n{dot}");
    }
}

/// `| head -1`, closed before the first write.
#[test]
fn a_reader_that_goes_away_is_no_panic() {
    let folder = Folder::new();
    for args in [&LIT[..], &["plan", "a.asc", "--format", "dot"], &["--help"]] {
        let mut child =
            folder.command(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let err = String::from_utf8_lossy(&output.stderr);
        assert!(err.is_empty(), "{args:?}: {err}");
        assert_ne!(output.status.code(), Some(101), "{args:?}");
    }
}

/// Level ground with a void at its first grid point, in degrees at the equator: a cell of 0.01 degrees is 1.113 km wide.
#[test]
fn info_states_what_a_file_holds() {
    let folder = Folder::new();
    let rows: Vec<String> = (0..4)
        .map(|row| {
            (0..6).map(|col| if row + col == 0 { "-9" } else { "7" }.to_owned() + " ").collect()
        })
        .collect();
    let head = "ncols 6\nnrows 4\nxllcorner 10\nyllcorner -0.02\ncellsize 0.01\nNODATA_value -9\n";
    folder.write("level.asc", (head.to_owned() + &rows.join("\n")).as_bytes());
    let run = folder.run_without_driver(&["info", "level.asc", "--json", "info.json"]);
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    for said in [
        "level.asc: 6 x 4 grid points",
        "extent     10 to 10.06 east, -0.02 to 0.02 north",
        "heights    7.000 to 7.000 m",
        "voids      4.167 %",
        "m, from degrees at latitude 0.00",
        "warning    no reference system: read as degrees, as its numbers fit; otherwise use --cell",
        "note       4.167 % of the grid points are voids",
        "Start with: ridgelight render level.asc -o picture.png",
    ] {
        assert!(run.out.contains(said), "{said}: {}", run.out);
    }
    let text = std::fs::read_to_string(folder.path("info.json")).unwrap();
    let facts: serde_json::Value = serde_json::from_str(&text).unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!((number(&facts["cell_m"][0]) - 1113.2).abs() < 0.1, "{}", facts["cell_m"]);
    assert_eq!((number(&facts["void_share"]), number(&facts["steep_share"])), (1.0 / 24.0, 0.0));
    let bytes = |job: &str| number(&facts["device_bytes"][job]);
    assert!(bytes("render") > 0.0 && bytes("render_bounces_1") > bytes("render"));

    // A pyramid of pixels: all slopes are 2 m a metre; the heights of an 8-bit picture are marked.
    let steep: Vec<u8> = (0..25).map(|i| 10 * (i % 5)).collect();
    image::GrayImage::from_raw(5, 5, steep).unwrap().save(folder.path("steep.png")).unwrap();
    let run = folder.run_without_driver(&["info", "steep.png", "--cell", "5"]);
    assert!(run.out.contains("100.000 % beyond 45 degrees"), "{}", run.out);
    assert!(run.out.contains("8-bit integers"), "{}", run.out);
    let run = folder.run_without_driver(&["info", "steep.png"]);
    assert!(
        run.out.contains("warning    the file has no cell size: --cell 1 is assumed"),
        "{}",
        run.out
    );
    let start = "Start with: ridgelight render steep.png --cell X,Y -o picture.png\nwhere X,Y is";
    assert!(run.out.contains(start), "{}", run.out);
    // Four cells of 16.7 km: (66.8 km)² / (2 · 6371 km) = 350 m.
    let run = folder.run_without_driver(&["info", "steep.png", "--cell", "16700"]);
    assert!(run.out.contains("drops 350 m over the 67 km"), "{}", run.out);
}

/// Type, no-data value, scale, offset and unit are those of the file, whatever the flags.
#[test]
fn info_states_how_a_file_stores_heights() {
    let folder = Folder::new();
    let text = "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item>\
                <Item name=\"OFFSET\" sample=\"0\" role=\"offset\">7</Item>\
                <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">ft</Item></GDALMetadata>";
    let scaled = tiff::<colortype::Gray64Float>(
        4,
        3,
        &HEIGHTS.map(f64::from),
        Compression::Uncompressed,
        Predictor::None,
        &[(42112, Tag::Text(text)), (42113, Tag::Text("nan"))],
    );
    folder.write("scaled.tif", &scaled);
    let (none, unsigned) = (Predictor::None, HEIGHTS.map(|h| h as u8));
    let plain = Compression::Uncompressed;
    folder.write("u8.tif", &tiff::<colortype::Gray8>(4, 3, &unsigned, plain, none, &[]));
    folder.write("u8.png", &png(4, 3, colour::GREY, 8, &[], &unsigned));
    let sparse = sparse_tiff(16, [2, 2], &[None, Some(1.0), Some(2.0), Some(3.0)], Some("-9999"));
    folder.write("sparse.tif", &sparse);
    let whole = FlatSamples::U32(HEIGHTS.map(|h| h as u32).to_vec());
    folder.write("whole.exr", &exr(4, 3, &[("Z", whole)]));
    let null = Value::Null;
    for (name, data_type, nodata, scale, unit_m, said) in [
        ("a.png", "uint16", null.clone(), [1.0, 0.0], null.clone(), "uint16, unit not stated"),
        ("u8.png", "uint8", null.clone(), [1.0, 0.0], null.clone(), "uint8, unit not stated"),
        ("a.exr", "float32", null.clone(), [1.0, 0.0], null.clone(), "float32, unit not stated"),
        ("whole.exr", "uint32", null.clone(), [1.0, 0.0], null.clone(), "uint32, unit not stated"),
        ("a.npy", "int16", null.clone(), [1.0, 0.0], null.clone(), "int16, unit not stated"),
        ("a.npz", "int16", null.clone(), [1.0, 0.0], null.clone(), "int16, unit not stated"),
        ("u8.tif", "uint8", null.clone(), [1.0, 0.0], null.clone(), "uint8, unit not stated"),
        (
            "a.tif",
            "int16",
            json!(-32768.0),
            [1.0, 0.0],
            null.clone(),
            "int16, no data -32768, unit not stated",
        ),
        (
            "N44W072.hgt",
            "int16",
            json!(-32768.0),
            [1.0, 0.0],
            json!(1.0),
            "int16, no data -32768, unit 1 m",
        ),
        (
            "sparse.tif",
            "float32",
            json!(-9999.0),
            [1.0, 0.0],
            null.clone(),
            "float32, no data -9999, unit not stated",
        ),
        ("a.asc", "text", json!(-9999.0), [1.0, 0.0], null, "text, no data -9999, unit not stated"),
        (
            "scaled.tif",
            "float64",
            json!("NaN"),
            [0.5, 7.0],
            json!(0.3048),
            "float64, no data NaN, scale 0.5, offset 7, unit 0.3048 m",
        ),
    ] {
        for flags in [&["--z-scale", "2", "--nodata", "100"][..], &[]] {
            let printed = ["info", name, "--json", "-"];
            let run = folder.run_without_driver(&[&printed[..], flags].concat());
            assert_eq!(run.status, Some(0), "{name}: {}", run.err);
            let facts: Value = serde_json::from_str(&run.out).unwrap();
            let found = ["data_type", "nodata", "scale", "offset", "vertical_unit_m"]
                .map(|key| facts.get(key).unwrap_or_else(|| panic!("{name}: no {key}")).clone());
            let [factor, offset] = scale;
            let expected =
                [json!(data_type), nodata.clone(), json!(factor), json!(offset), unit_m.clone()];
            assert_eq!(found, expected, "{name} {flags:?}");
        }
        let run = folder.run_without_driver(&["info", name]);
        assert!(run.out.contains(&format!("  values     {said}\n")), "{}", run.out);
    }
}

/// `info --json -` prints what it would write to a file, and nothing else. Warnings also go to standard error, as with --quiet.
#[test]
fn info_prints_its_json() {
    let folder = Folder::new();
    crate::needs_vulkan::write_field(&folder, 4, |_, _| 1.0);
    let [file, printed, quiet] = ["--json i.json", "--json -", "--json - --quiet"].map(|json| {
        let args = format!("info field.npy {json}");
        let run = folder.run_without_driver(&args.split(' ').collect::<Vec<_>>());
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{args}");
        run
    });
    assert_eq!(printed.out, std::fs::read_to_string(folder.path("i.json")).unwrap());
    assert_eq!(quiet.out, printed.out);
    assert!(file.out.contains("4 x 4 grid points"), "{}", file.out);
    let warning = "warning: field.npy: the file has no cell size: --cell 1 is assumed\n";
    assert!(printed.notes.contains(warning), "{}", printed.notes);
    assert_eq!(quiet.notes, printed.notes);
    assert!(!folder.path("-").exists());
}

/// A note states the share of voids. From one half on it is a warning, which adds that half of the field or more is empty.
#[test]
fn a_field_that_is_half_empty_gets_a_warning() {
    let folder = Folder::new();
    for (voids, share, is_half) in
        [(9, "45.000 %", false), (10, "50.000 %", true), (12, "60.000 %", true)]
    {
        let head = "ncols 5\nnrows 4\ncellsize 10\nNODATA_value -9\n";
        let cells: String = (0..20).map(|i| if i < voids { "-9 " } else { "7 " }).collect();
        folder.write("holes.asc", (head.to_owned() + &cells).as_bytes());
        let info = folder.run_without_driver(&["info", "holes.asc"]);
        let plan = folder.run_without_driver(&["plan", "holes.asc", "--sky", "1"]);
        let of_share = format!("{share} of the grid points are voids");
        let word = if is_half { "warning" } else { "note" };
        for (run, text, start) in [
            (&info, &info.out, format!("{word:<10} ")),
            (&plan, &plan.notes, format!("{word}: holes.asc: ")),
        ] {
            assert_eq!(run.status, Some(0), "{voids}: {}", run.err);
            assert!(text.contains(&format!("{start}{of_share}")), "{voids}: {text}");
            let has_half = text.contains("; half of the field or more is empty");
            assert_eq!(has_half, is_half, "{voids}: {text}");
            let has_cure = text.contains("`gdal_fillnodata.py in.tif out.tif`");
            assert_eq!(has_cure, !is_half, "{voids}: {text}");
        }
    }
}

/// Notes go to standard error, so that a program can read standard output.
#[test]
fn notes_leave_standard_output_to_results() {
    let folder = Folder::new();
    crate::needs_vulkan::write_field(&folder, 4, |_, _| 1.0);
    for sun in ["", " --sun 10,-5"] {
        let args = format!("plan field.npy --format json --sky 1{sun}");
        let run = folder.run_without_driver(&args.split(' ').collect::<Vec<_>>());
        serde_json::from_str::<serde_json::Value>(&run.out).unwrap();
        let warning = "warning: field.npy: the file has no cell size: --cell 1 is assumed\n";
        assert!(run.notes.contains(warning), "{}", run.notes);
        assert_eq!(run.notes.contains("note: night: "), !sun.is_empty(), "{}", run.notes);
    }
}

/// `--quiet` leaves out results and notes. Warnings stay, on standard error; without a warning there is no output.
#[test]
fn quiet_commands_print_warnings() {
    let folder = Folder::new();
    crate::needs_vulkan::write_field(&folder, 4, |_, _| 1.0);
    // Degrees become metres, with a note. That they are degrees is a guess without a reference system, which is a warning.
    let head = "ncols 4\nnrows 4\nxllcorner 10\nyllcorner 50\ncellsize 0.01\n";
    folder.write("level.asc", (head.to_owned() + &"7 ".repeat(16)).as_bytes());
    let guess = "warning: level.asc: no reference system: read as degrees, as its numbers fit; otherwise use --cell\n";
    let warning = "warning: field.npy: the file has no cell size: --cell 1 is assumed\n";
    for (file, expected) in
        [("field.npy", warning), ("field.npy --cell 5", ""), ("level.asc", guess)]
    {
        for command in [
            format!("plan {file} --sky 1 --sun 10,-5 -q"),
            format!("info {file} --quiet"),
            format!("hillshade {file} -o h.tif -q"),
        ] {
            let run = folder.run_without_driver(&command.split(' ').collect::<Vec<_>>());
            assert_eq!(run.status, Some(0), "{command}: {}", run.err);
            let all = [run.out.as_str(), run.err.as_str(), run.notes.as_str()];
            assert_eq!(all, ["", "", expected], "{command}");
        }
    }
    // Without the flag the same commands print notes.
    let loud = folder.run_without_driver(&["plan", "level.asc", "--sky", "1"]);
    assert!(loud.notes.contains("note: level.asc: cells of "), "{}", loud.notes);
    assert!(!loud.out.is_empty());
}

/// Wider than an image of any device: what needs no image reads it.
#[test]
fn gpu_fields_beyond_the_device_have_hillshades() {
    let folder = Folder::new();
    let field = HeightField::new(2, 33_000, &[1.0; 66_000], [1.0; 2], None).unwrap();
    ridgelight_io::write_npy_heights(&folder.path("wide.npy"), &field).unwrap();
    succeeded(&folder, "hillshade wide.npy -o shade.npy");
    let info = succeeded(&folder, "info wide.npy");
    assert!(info.out.contains("cannot render the whole field by default"), "{}", info.out);
    assert!(info.out.contains("Reduce the grid first: "), "{}", info.out);
    refused(&folder, &[("ao wide.npy -o ao.npy", 1, &["33000"])]);
}

/// With too little memory for the whole field, the command has a box that fits.
#[test]
fn gpu_the_recommended_command_runs() {
    let folder = Folder::new();
    let head = "ncols 200\nnrows 96\nxllcorner 500\nyllcorner 0\ncellsize 10\n";
    folder.write("dem.asc", (head.to_owned() + &"5 ".repeat(200 * 96)).as_bytes());
    succeeded(&folder, "info dem.asc --json info.json");
    let facts = crate::needs_vulkan::json(&folder.path("info.json"));
    let needed = facts["device_bytes"]["render"].as_u64().unwrap();
    succeeded(&folder, &format!("render dem.asc --memory-budget {needed} -o p.png"));
    let short = needed - 1;
    let short = format!(" --memory-budget {short}");
    for (words, has_box) in [("", false), (short.as_str(), true)] {
        let info = succeeded(&folder, &format!("info dem.asc{words}"));
        let command =
            info.out.lines().find_map(|line| line.strip_prefix("Start with: ridgelight "));
        let command = command.unwrap_or_else(|| panic!("{}", info.out));
        assert_eq!(command.contains("--bbox 1000,240,2000,720"), has_box, "{command}");
        assert_eq!(info.out.contains("cannot render the whole field"), has_box, "{}", info.out);
        succeeded(&folder, command);
    }
    let whole = format!("render dem.asc{short} -o p.png");
    refused(&folder, &[(whole.as_str(), 1, &["of --memory-budget"])]);
}
