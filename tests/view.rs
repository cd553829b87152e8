//! The window, in a display of its own (Xvfb): what it shows is what `render` writes, it outlives what happens to
//! windows, holds no more memory after many frames, and validation has nothing to say.
#![cfg(all(feature = "window", target_os = "linux"))]

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use ridgelight::files::{Planes, read_planes};

/// A display without a screen, gone with the value.
struct Display {
    server: Child,
    name: String,
}

impl Display {
    fn new() -> Self {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp", "-noreset"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb: run tools/setup --tests");
        // Its number, once it takes clients.
        let mut number = String::new();
        let out = server.stdout.as_mut().expect("piped");
        BufReader::new(out).read_line(&mut number).expect("a display's number");
        Self { server, name: format!(":{}", number.trim()) }
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

struct Folder(tempfile::TempDir);

impl Folder {
    /// With a field of hills, 64 columns and 48 rows, as "hills.asc".
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        let height = |i: usize| {
            let (x, y) = ((i % 64) as f32, (i / 64) as f32);
            5.0 * (x / 6.0).sin() * (y / 5.0).cos() + (x * y / 40.0).sin()
        };
        let heights: Vec<String> = (0..64 * 48).map(|i| height(i).to_string()).collect();
        let text = format!("ncols 64 nrows 48 cellsize 1 {}", heights.join(" "));
        folder.write("hills.asc", text.as_bytes());
        folder
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.0.path().join(name), bytes).unwrap();
    }

    fn command(&self, args: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ridgelight"));
        command.current_dir(self.0.path()).args(args.split(' '));
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        command
    }

    /// Runs what must succeed; its standard output.
    fn done(&self, display: Option<&Display>, args: &str) -> String {
        let mut command = self.command(args);
        command.envs(display.map(|d| ("DISPLAY", &d.name)));
        let Output { status, stdout, stderr } = command.output().unwrap();
        let said = String::from_utf8_lossy(&stderr);
        assert!(status.success() && said.is_empty(), "{args}: {status}: {said}");
        String::from_utf8(stdout).unwrap()
    }

    /// A window driven by a script, under validation where the tests have it.
    fn view(&self, display: &Display, args: &str, script: &str) -> String {
        self.write("script", script.as_bytes());
        let validates = std::env::var_os("RIDGELIGHT_VALIDATION").is_some_and(|v| v == "1");
        let flag = if validates { " --validate" } else { "" };
        self.done(Some(display), &format!("view {args} --script script{flag}"))
    }

    fn picture(&self, name: &str) -> Planes {
        read_planes(&self.0.path().join(name)).unwrap()
    }
}

/// Codes of a picture's colours, 8 bits each.
fn colours(planes: &Planes) -> Vec<&[f32]> {
    let named = |wanted: &str| planes.names.iter().position(|n| n == wanted);
    ["R", "G", "B"].map(|n| planes.planes[named(n).expect(n)].as_slice()).to_vec()
}

fn assert_same(folder: &Folder, got: &str, want: &str) {
    let (a, b) = (folder.picture(got), folder.picture(want));
    assert_eq!([a.rows, a.cols], [b.rows, b.cols], "{got} and {want}");
    assert!(colours(&a) == colours(&b), "{got} is not {want}");
}

const LIT: &str = "--sun 315,30 --sky 0.3 --azimuths 8";

#[test]
fn gpu_a_window_shows_what_render_writes() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nkey h\nframes 2\nscreenshot first.png\npicture saved.png\n\
        key shift+right\nkey .\nkey b\nframes 2\nscreenshot second.png\nscene second.json\n\
        drag right 10,10 30,-20\nkey ,\nkey ,\nkey m\nkey m\nframes 1\nscreenshot third.png\n\
        scene third.json\nlose\nframes 1\nscreenshot fourth.png\n";
    folder.view(&display, &format!("hills.asc {LIT} --size 64x48"), script);
    folder.done(None, &format!("render hills.asc {LIT} -o first_r.png --quiet"));
    assert_same(&folder, "first.png", "first_r.png");
    assert_same(&folder, "saved.png", "first_r.png");
    folder.done(None, "render --scene second.json -o second_r.png --quiet");
    let flags = "--sun 320,30 --sky 0.3 --azimuths 16 --bounces 1";
    folder.done(None, &format!("render hills.asc {flags} -o second_f.png --quiet"));
    assert_same(&folder, "second.png", "second_r.png");
    assert_same(&folder, "second.png", "second_f.png");
    folder.done(None, "render --scene third.json -o third_r.png --quiet");
    let flags = "--sun 335,35 --sky 0.3 --azimuths 4 --bounces 1 --method pyramid";
    folder.done(None, &format!("render hills.asc {flags} -o third_f.png --quiet"));
    assert_same(&folder, "third.png", "third_r.png");
    assert_same(&folder, "third.png", "third_f.png");
    // Another surface of the same window.
    assert_same(&folder, "fourth.png", "third.png");
    // The comparison can fail.
    assert!(colours(&folder.picture("first.png")) != colours(&folder.picture("second.png")));
}

/// What the window draws, and what `render --camera` does: the same passes, whose codes are rounded here by the
/// device after its own power function, there by the host.
#[test]
fn gpu_a_camera_sees_what_render_does() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nkey h\nkey v\nframes 2\nscreenshot shot.png\npicture saved.png\n\
        key left\nkey up\nkey +\nkey k\ndrag middle 9,9 5,3\nframes 1\nscreenshot other.png\npicture other_p.png\nscene other.json\nkey home\nlose\n\
        frames 1\nscreenshot again.png\nkey v\nframes 1\nscreenshot map.png\n";
    folder.view(&display, &format!("hills.asc {LIT} --size 96x60"), script);
    let camera = "--camera 180,45 --fov 40 --samples 1 --size 96x60";
    folder.done(None, &format!("render hills.asc {LIT} {camera} -o camera.png --quiet"));
    assert_same(&folder, "saved.png", "camera.png");
    assert_same(&folder, "again.png", "shot.png");
    folder.done(None, "render --scene other.json -o other_r.png --quiet");
    assert_same(&folder, "other_p.png", "other_r.png");
    let [shot, saved, other] = ["shot.png", "saved.png", "other.png"].map(|n| folder.picture(n));
    let apart = |a: &Planes| {
        let pairs = colours(a).concat().into_iter().zip(colours(&saved).concat());
        pairs.map(|(a, b)| (code(a) - code(b)).abs()).fold(0.0, f64::max)
    };
    assert!(apart(&shot) <= 1.0, "{} codes", apart(&shot));
    // The comparison can fail.
    assert!(apart(&other) > 16.0);
}

/// The 8-bit code that a plane's linear light was read from (IEC 61966-2-1).
fn code(light: f32) -> f64 {
    let l = f64::from(light);
    let encoded = if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round()
}

/// Numbers of a line that a report printed.
fn reported(line: &str) -> (u64, u64) {
    let number = |text: Option<&str>| text.and_then(|t| t.parse().ok()).expect("a number");
    let frames = line.split(&[' ', ','][..]).nth(1);
    (number(frames), number(line.split(' ').next_back()))
}

/// Two hundred frames of moving heights. A frame that left behind anything of its own, its heights (12 KiB), its
/// text (460 KiB) or its pixels, would hold 2.4 MiB more or a multiple; what the allocators keep of themselves and the
/// driver's threads grow into is given 2 MiB.
#[test]
fn gpu_two_hundred_frames_hold_no_memory() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key w\nframes 60\nreport\nframes 200\nreport\n";
    let out = folder.view(&display, &format!("hills.asc {LIT} --size 200x150"), script);
    let lines: Vec<&str> = out.lines().filter(|line| line.starts_with("frames ")).collect();
    let [before, after] = [lines[0], lines[1]].map(reported);
    assert_eq!(after.0 - before.0, 200, "{out}");
    assert!(after.1 < before.1 + 2048, "KiB {} and then {}", before.1, after.1);
}

#[test]
fn gpu_a_window_outlives_its_sizes() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "frames 2\nsize 301,203\nframes 2\nkey +\nkey left\nwheel -3 20,20\nsize 64,48\nkey home\n\
        key h\nkey h\nframes 1\nsize 1,1\nframes 2\nsize 64,48\nframes 1\nscreenshot last.png\n";
    folder.view(&display, &format!("hills.asc {LIT}"), script);
    folder.done(None, &format!("render hills.asc {LIT} -o render.png --quiet"));
    assert_same(&folder, "last.png", "render.png");
}

/// Real events, from another client of the display.
#[test]
fn gpu_keys_and_the_mouse_are_heard() {
    let (folder, display) = (Folder::new(), Display::new());
    folder.write("script", b"frames 2\nwait 6\nscene heard.json\n");
    let mut view = folder.command(&format!("view hills.asc {LIT} --size 300x200 --script script"));
    let mut view = view.env("DISPLAY", &display.name).stdout(Stdio::null()).spawn().unwrap();
    // Nobody manages windows here, so that nobody gives them the keyboard.
    let act = "search --sync --name hills.asc windowfocus --sync sleep 0.5 mousemove 100 100 key period key m mousedown 3 mousemove 120 100 mousemove 140 100 mouseup 3";
    let mut xdotool = Command::new("xdotool");
    let acted = xdotool.env("DISPLAY", &display.name).args(act.split(' ')).status();
    let ended = view.wait().unwrap();
    assert!(acted.expect("xdotool: run tools/setup --tests").success() && ended.success());
    let text = std::fs::read_to_string(folder.0.path().join("heard.json")).unwrap();
    let scene: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        scene["quality"],
        serde_json::json!({ "azimuths": 16, "method": "sweep" }),
        "{text}"
    );
    let sun = &scene["lights"]["suns"][0]["azimuth_deg"];
    assert_eq!(sun.as_f64(), Some(335.0), "{text}");
}

fn refused(mut command: Command, says: &[&str]) {
    let Output { status, stderr, .. } = command.output().unwrap();
    let said = String::from_utf8_lossy(&stderr).into_owned();
    assert_eq!(status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(says.iter().all(|s| said.contains(s)), "{said}");
}

#[test]
fn no_display_is_one_sentence() {
    let folder = Folder::new();
    refused(folder.command("view hills.asc"), &["ridgelight: view: needs a display: "]);
    let mut elsewhere = folder.command("view hills.asc");
    elsewhere.env("DISPLAY", ":6553");
    refused(elsewhere, &["ridgelight: view: needs a display: "]);
}

#[test]
fn a_window_without_a_driver_is_one_sentence() {
    let (folder, display) = (Folder::new(), Display::new());
    let mut command = folder.command("view hills.asc");
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env(name, Path::new("no-driver.json"));
    }
    command.env("DISPLAY", &display.name).env_remove("VK_ADD_DRIVER_FILES");
    refused(command, &["driver"]);
}
