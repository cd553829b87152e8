//! User input in the window: brushes, lights, settings, keys and the mouse.

use std::process::{Command, Output, Stdio};

use super::{Display, Folder, LIT, apart, assert_same, code, colours, succeed};

/// Strokes are drawn as edits and undone and redone bit for bit. `render` draws the saved field, whose heights are
/// relative to another median and rounded to f32 once more, which may change a code by one.
#[test]
fn gpu_brushes_are_undone_and_saved() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nframes 2\nkey 2\nframes 2\ndrag left 30,20 12,6\nframes 3\ntext raised.txt\n\
        picture raised.png\nscene raised.json\nkey 4\ndrag left 30,20 12,6\nframes 3\npicture eroded.png\n\
        scene eroded.json\nkey z\nkey z\nkey z\nframes 2\ntext undone.txt\npicture undone.png\nscene undone.json\n\
        key y\nkey y\nframes 1\npicture again.png\n";
    folder.view(&display, &format!("hills.asc {LIT} --tint none --size 64x48"), script);
    let text = |name: &str| std::fs::read_to_string(folder.0.path().join(name)).unwrap();
    let said = text("raised.txt");
    assert!(said.contains("undo 1, redo 0") && said.contains("edit of "), "{said}");
    let said = text("undone.txt");
    assert!(said.contains("undo 0, redo 2") && said.contains("nothing to undo"), "{said}");
    folder.done(&format!("render hills.asc {LIT} --tint none -o render.png --quiet"));
    assert_same(&folder, "undone.png", "render.png");
    assert_same(&folder, "again.png", "eroded.png");
    for name in ["raised", "eroded"] {
        folder.done(&format!("render --scene {name}.json -o {name}_r.png --quiet"));
        let [window, render] =
            [".png", "_r.png"].map(|end| folder.picture(&format!("{name}{end}")));
        assert!(apart(&window, &render) <= 1.0, "{name}: {}", apart(&window, &render));
        // The comparison can fail.
        assert!(apart(&window, &folder.picture("undone.png")) > 16.0, "{name}");
    }
    // The file that was read.
    let scene: serde_json::Value = serde_json::from_str(&text("undone.json")).unwrap();
    assert_eq!(scene["field"]["file"], "hills.asc");
}

/// A click places a light, a key colours it, a drag moves it, and its mark is at its place:
/// `render` draws the saved scene to the same bytes. Deletion leaves nothing.
#[test]
fn gpu_lights_are_placed_dragged_coloured_and_deleted() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nkey h\nframes 2\nkey 5\ndrag left 20,30 0,0\nkey t\nkey ]\ndrag left 20,30 12,-8\n\
        key pageup\nframes 2\nscreenshot mark.png\npicture lit.png\nscene lit.json\nkey o\nframes 1\nkey x\nkey x\n\
        frames 2\npicture dark.png\nscene dark.json\nkey h\nkey x\ntext none.txt\n";
    folder.view(&display, &format!("hills.asc {LIT} --size 64x48"), script);
    let scene = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(folder.0.path().join(name)).unwrap()).unwrap()
    };
    let lights = scene("lit.json")["lights"]["sphere_lights"].clone();
    assert_eq!(lights.as_array().map(Vec::len), Some(1), "{lights}");
    // Placed over column 19.5, row 29.5, moved by 12 and 8, of 48 rows.
    let place: Vec<f64> =
        lights[0]["position_m"].as_array().unwrap().iter().filter_map(|v| v.as_f64()).collect();
    assert!((place[0] - 31.5).abs() < 1e-9 && (place[1] - (47.0 - 21.5)).abs() < 1e-9, "{place:?}");
    let [r, g, b] = [0, 1, 2].map(|i| lights[0]["radiance"][i].as_f64().unwrap());
    assert!(r == 8.0 && g < r && b < g, "{lights}");
    folder.done("render --scene lit.json -o lit_r.png --quiet");
    assert_same(&folder, "lit.png", "lit_r.png");
    folder.done(&format!("render hills.asc {LIT} -o first_r.png --quiet"));
    assert_same(&folder, "dark.png", "first_r.png");
    assert!(scene("dark.json")["lights"].get("sphere_lights").is_none(), "{}", scene("dark.json"));
    let said = std::fs::read_to_string(folder.0.path().join("none.txt")).unwrap();
    assert!(said.contains("no light is chosen"), "{said}");
    // The mark's middle has the full brightest channel.
    let (mark, at) = (folder.picture("mark.png"), 22 * 64 + 32);
    let shown = colours(&mark).iter().map(|plane| code(plane[at])).collect::<Vec<_>>();
    assert!(shown[0] == 255.0 && shown[1] < 255.0 && shown[2] < shown[1], "{shown:?}");
}

/// Of the same input, flags and script, in two folders.
#[test]
fn gpu_two_windows_save_the_same_bytes() {
    let display = Display::new();
    let saved = [0, 1].map(|_| {
        let folder = Folder::new();
        let script = "frames 2\npicture saved.png\nscene saved.json\n";
        folder.view(&display, &format!("hills.asc {LIT} --size 64x48"), script);
        ["saved.png", "saved.json"].map(|name| std::fs::read(folder.0.path().join(name)).unwrap())
    });
    for (k, name) in ["picture", "scene"].into_iter().enumerate() {
        assert!(saved[0][k] == saved[1][k], "{name}");
    }
}

/// A wrong setting is refused with the command line's message and leaves the picture; a right one
/// gives `render`'s picture.
#[test]
fn gpu_settings_match_the_command_line() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "frames 2\nkey tab\nkey ,\nkey ,\ntext azimuths.txt\nkey tab\nkey tab\nkey tab\nkey tab\nkey ,\n\
        key ,\nkey ,\ntext lines.txt\nkey tab\nkey ,\nkey shift+tab\nframes 2\nkey h\nkey h\nframes 1\nscreenshot fine.png\n\
        scene fine.json\nkey h\nkey tab\nkey tab\nkey tab\nkey tab\nkey tab\nkey tab\nkey tab\nkey .\ntext idle.txt\n";
    folder.view(&display, &format!("hills.asc {LIT} --size 64x48"), script);
    let text = |name: &str| std::fs::read_to_string(folder.0.path().join(name)).unwrap();
    for (name, flags) in [
        ("azimuths.txt", "--sun 315,30 --sky 0.3 --azimuths 2"),
        ("lines.txt", "--sun 315,30 --sky 0.3 --azimuths 4 --lines exact"),
    ] {
        let mut command = folder.command(&format!("render hills.asc {flags} -o none.png"));
        let Output { status, stderr, .. } = command.output().unwrap();
        let said = String::from_utf8(stderr).unwrap();
        assert_eq!(status.code(), Some(2), "{said}");
        let sentence = said.trim_end().strip_prefix("ridgelight: ").unwrap();
        assert!(text(name).lines().any(|line| line == sentence), "{said} in {}", text(name));
    }
    assert!(text("lines.txt").contains("> lines                 1/4"), "{}", text("lines.txt"));
    let scene: serde_json::Value = serde_json::from_str(&text("fine.json")).unwrap();
    let quality = serde_json::json!({ "azimuths": 4, "lines": "1/4", "fuse": "aimed" });
    assert_eq!(scene["quality"], quality);
    folder.done("render --scene fine.json -o fine_r.png --quiet");
    assert_same(&folder, "fine.png", "fine_r.png");
    let note = "changes nothing without --method pyramid";
    assert!(text("idle.txt").contains(note), "{}", text("idle.txt"));
}

/// Radii of brushes have limits: below, so that strokes have finitely many dabs, and above, at the
/// field's side. A sixteenth of 48 m times 0.8 and 1.25 to the fortieth exceeds both.
#[test]
fn gpu_brushes_have_size_limits() {
    let (folder, display) = (Folder::new(), Display::new());
    let keys = |key: &str| format!("key {key}\n").repeat(40);
    let script = format!(
        "frames 1\n{}text small.txt\n{}{}text large.txt\n",
        keys("["),
        keys("]"),
        keys("]")
    );
    folder.view(&display, &format!("hills.asc {LIT} --size 64x48"), &script);
    for (name, says) in [
        ("small.txt", "the brush is at its smallest, half a cell"),
        ("large.txt", "the brush is at its largest, the field's longer side"),
    ] {
        let text = std::fs::read_to_string(folder.0.path().join(name)).unwrap();
        assert!(text.contains(says), "{text}");
    }
}

/// A shell runs the command line that the panel copies: `render` draws the window's picture, from above and from a camera, of
/// a file whose name must be quoted.
#[test]
fn gpu_copied_commands_draw_the_picture() {
    let (folder, display) = (Folder::new(), Display::new());
    let rename = |from: &str, to: &str| {
        std::fs::rename(folder.0.path().join(from), folder.0.path().join(to)).unwrap();
    };
    rename("hills.asc", "hill's.asc");
    let script = "frames 2\npicture first.png\nkey shift+right\nkey e\nkey .\nframes 2\npicture map.png\n\
        command map.txt\nkey v\nframes 2\npicture camera.png\ncommand camera.txt\n";
    folder.view(&display, &format!("hill's.asc {LIT} --size 96x60"), script);
    for of in ["map", "camera"] {
        let line = std::fs::read_to_string(folder.0.path().join(format!("{of}.txt"))).unwrap();
        let words = line.strip_prefix("ridgelight ").expect("the program's name");
        let mut shell = Command::new("sh");
        let run = format!("\"$0\" {words} --quiet");
        shell.current_dir(folder.0.path()).args(["-c", &run, env!("CARGO_BIN_EXE_ridgelight")]);
        succeed(shell);
        // The command saves under a free name in that folder.
        rename("hill's-view-1.png", &format!("{of}_r.png"));
        assert_same(&folder, &format!("{of}.png"), &format!("{of}_r.png"));
    }
    // The comparison can fail.
    assert!(colours(&folder.picture("first.png")) != colours(&folder.picture("map.png")));
}

/// Real events from another client of the display.
#[test]
fn gpu_real_keys_and_mouse_events_work() {
    let (folder, display) = (Folder::new(), Display::new());
    folder.write("script", b"frames 2\nwait acted\nscene heard.json\n");
    let mut view = folder.command(&format!("view hills.asc {LIT} --size 640x400 --script script"));
    let mut view = view.env("DISPLAY", &display.name).stdout(Stdio::null()).spawn().unwrap();
    // Right of the panel. Without a window manager the window does not get the keyboard by itself.
    let act = "windowfocus --sync mousemove 400 100 key period key m key Tab key Tab key period mousedown 3 mousemove 420 100 mousemove 440 100 mouseup 3 key 2 mousemove 450 200 mousedown 1 mousemove 470 200 mouseup 1";
    // `timeout` ends a wait for a window that never appears.
    let mut xdotool = Command::new("timeout");
    // Its title is this once it has drawn.
    xdotool.args(["1200", "xdotool", "search", "--sync", "--name", "hills.asc - ridgelight - "]);
    let acted = xdotool.args(act.split(' ')).env("DISPLAY", &display.name).status();
    folder.write("acted", b"");
    let ended = view.wait().unwrap();
    assert!(acted.expect("xdotool: run tools/setup --tests").success() && ended.success());
    let text = std::fs::read_to_string(folder.0.path().join("heard.json")).unwrap();
    let scene: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        scene["quality"],
        serde_json::json!({ "azimuths": 16, "method": "sweep", "sun_azimuths": 16 }),
        "{text}"
    );
    let sun = &scene["lights"]["suns"][0]["azimuth_deg"];
    assert_eq!(sun.as_f64(), Some(335.0), "{text}");
    // The brush has changed the field.
    assert_eq!(scene["field"]["file"].as_str(), Some("heard.npy"), "{text}");
    assert!(folder.0.path().join("heard.npy").exists());
}

/// Places of the panel's parts by name: the middle, the width and the height of each.
struct Places(String);

impl Places {
    fn of(&self, name: &str) -> [i32; 4] {
        let line = self.0.lines().find_map(|line| line.strip_prefix(&format!("{name}: ")));
        let line = line.unwrap_or_else(|| panic!("{name} in {}", self.0));
        let all: Vec<i32> = line.split(' ').map(|n| n.parse().unwrap()).collect();
        <[i32; 4]>::try_from(all).unwrap()
    }
}

/// A part of the panel that a test waits for, and the words of xdotool that follow from the places then.
type Act<'a> = (&'a str, &'a dyn Fn(&Places) -> String);

/// A window whose script waits for a part of the panel before each act. Returns the scene that it saves after the last.
fn acted(size: &str, acts: &[Act<'_>]) -> serde_json::Value {
    let (folder, display) = (Folder::new(), Display::new());
    let waits = acts.iter().enumerate().map(|(n, (part, _))| format!("shown places{n} {part}\n"));
    let script = format!(
        "key h\nframes 4\n{}wait acted\nframes 2\nscene scene.json\n",
        waits.collect::<String>()
    );
    folder.write("script", script.as_bytes());
    let flag = if super::is_validated() { " --validate" } else { "" };
    let args = format!("view hills.asc {LIT} --size {size} --exposure 1 --script script{flag}");
    let mut view = folder.command(&args);
    view.env("DISPLAY", &display.name).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut view = view.spawn().unwrap();
    for (n, (part, act)) in acts.iter().enumerate() {
        let file = folder.0.path().join(format!("places{n}"));
        let places = loop {
            if let Ok(text) = std::fs::read_to_string(&file) {
                break Places(text);
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
            assert!(view.try_wait().unwrap().is_none(), "ended before it showed {part}");
        };
        let mut xdotool = Command::new("timeout");
        let title = "hills.asc - ridgelight - ";
        xdotool.args(["1200", "xdotool", "search", "--sync", "--name", title]);
        xdotool.args(["windowfocus", "--sync"]).args(act(&places).split_whitespace());
        let done = xdotool.env("DISPLAY", &display.name).status();
        assert!(done.expect("xdotool: run tools/setup --tests").success());
    }
    folder.write("acted", b"");
    let Output { status, stdout, stderr } = view.wait_with_output().unwrap();
    let [out, said] = [stdout, stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(status.success() && said.is_empty(), "{status}: {said}");
    assert_eq!(super::is_validated(), out.contains("0 validation messages"), "{out}");
    let scene = std::fs::read(folder.0.path().join("scene.json")).unwrap();
    serde_json::from_slice(&scene).unwrap()
}

/// From its place at 315, 30 to the east, halfway to the rim: 90, 45. A pixel is 90 / 48 degrees of
/// elevation, and at half of the radius atan(1 / 24) of azimuth: the places are rounded to one.
#[test]
fn gpu_sun_is_dragged_on_the_compass() {
    let drag = |places: &Places| {
        let [x, y, width, _] = places.of("compass");
        let (from, to) = ([x - width / 4, y - width / 4], [x + width / 4, y]);
        // Faster than frames, and released at once.
        format!(
            "mousemove {} {} mousedown 1 mousemove {} {y} mousemove {} {} mouseup 1",
            from[0], from[1], x, to[0], to[1]
        )
    };
    let scene = acted("700x500", &[("keys (h)", &drag)]);
    let sun = &scene["lights"]["suns"][0];
    let [azimuth, elevation] =
        ["azimuth_deg", "elevation_deg"].map(|name| sun[name].as_f64().unwrap());
    assert!((azimuth - 90.0).abs() <= 1.0_f64.atan2(24.0).to_degrees() + 0.05, "{scene}");
    assert!((elevation - 45.0).abs() <= 90.0 / 48.0 + 0.05, "{scene}");
    // The field below the panel has heard nothing of it.
    assert_eq!(scene["field"]["file"], "hills.asc");
}

/// A list is opened by a click and its next word is clicked; a number is typed into a field, whose
/// digits are no keys of the window: 2 is the key of a brush, which a press on the field would use.
#[test]
fn gpu_settings_are_clicked_and_typed() {
    let click = |places: &Places, name: &str| {
        let [x, y, ..] = places.of(name);
        format!("mousemove {x} {y} click 1")
    };
    let scene = acted(
        "700x500",
        &[
            ("keys (h)", &|places| click(places, "method")),
            ("method sweep", &|places| click(places, "method sweep")),
            ("method = sweep", &|places| click(places, "azimuths value")),
            ("typing", &|_| "key ctrl+a key 2 key 4 key Return".to_owned()),
            ("azimuths = 24", &|_| {
                "mousemove 500 300 mousedown 1 mousemove 520 300 mouseup 1".to_owned()
            }),
        ],
    );
    let quality = &scene["quality"];
    assert_eq!(quality["azimuths"].as_f64(), Some(24.0), "{scene}");
    assert_eq!(quality["method"], "sweep", "{scene}");
    assert_eq!(scene["field"]["file"], "hills.asc", "{scene}");
}
