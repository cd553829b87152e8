//! The window in a display of its own (Xvfb): it shows what `render` writes, survives window
//! events, does not leak memory over many frames, and passes validation.
#![cfg(all(feature = "window", target_os = "linux"))]

mod hands;
mod lost;
mod moving;
mod previews;

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use ridgelight_io::{Planes, read_planes};

/// A display without a screen, removed on drop.
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
        // The server writes its number once it accepts clients.
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
    /// Has a field of hills, 64 columns and 48 rows, as "hills.asc".
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
        // A hang ends with 124.
        let mut command = Command::new("timeout");
        command.current_dir(self.0.path()).args(["1200", env!("CARGO_BIN_EXE_ridgelight")]);
        command.args(args.split(' '));
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        command
    }

    /// Runs a command that must succeed. Returns its standard output.
    /// A command; pictures have the exposure of the window.
    fn done(&self, args: &str) -> String {
        let exposure = if args.contains(".png") { " --exposure 1" } else { "" };
        succeed(self.command(&format!("{args}{exposure}")))
    }

    /// A window driven by a script, under validation where the tests have it.
    fn view(&self, display: &Display, args: &str, script: &str) -> String {
        silent(self.window(display, args, script))
    }

    /// The command of such a window, with exposure 1 unless the arguments give one; "auto" is the default's.
    fn window(&self, display: &Display, args: &str, script: &str) -> Command {
        self.write("script", script.as_bytes());
        let flag = if is_validated() { " --validate" } else { "" };
        let exposure = if args.contains("--exposure") { "" } else { " --exposure 1" };
        let args = args.strip_suffix(" --exposure auto").unwrap_or(args);
        let mut command = self.command(&format!("view {args} --script script{flag}{exposure}"));
        command.env("DISPLAY", &display.name);
        command
    }

    fn picture(&self, name: &str) -> Planes {
        read_planes(&self.0.path().join(name)).unwrap()
    }
}

/// Standard output of a command that must print nothing else.
fn succeed(mut command: Command) -> String {
    let Output { status, stdout, stderr } = command.output().unwrap();
    let said = String::from_utf8_lossy(&stderr);
    assert!(status.success() && said.is_empty(), "{command:?}: {status}: {said}");
    String::from_utf8(stdout).unwrap()
}

/// The same for a window, with no validation messages where validation runs.
fn silent(command: Command) -> String {
    let out = succeed(command);
    assert_eq!(is_validated(), out.lines().last() == Some("0 validation messages"), "{out}");
    out
}

fn is_validated() -> bool {
    std::env::var_os("RIDGELIGHT_VALIDATION").is_some_and(|v| v == "1")
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
fn gpu_window_equals_render() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nkey h\nframes 2\nscreenshot first.png\npicture saved.png\n\
        key shift+right\nkey .\nkey b\nframes 2\nscreenshot second.png\nscene second.json\n\
        drag right 10,10 30,-20\nkey ,\nkey ,\nkey m\nkey m\nframes 1\nscreenshot third.png\n\
        scene third.json\nlose\nframes 1\nscreenshot fourth.png\n";
    folder.view(&display, &format!("hills.asc {LIT} --size 64x48"), script);
    folder.done(&format!("render hills.asc {LIT} -o first_r.png --quiet"));
    assert_same(&folder, "first.png", "first_r.png");
    assert_same(&folder, "saved.png", "first_r.png");
    folder.done("render --scene second.json -o second_r.png --quiet");
    let flags = "--sun 320,30 --sky 0.3 --azimuths 16 --bounces 1";
    folder.done(&format!("render hills.asc {flags} -o second_f.png --quiet"));
    assert_same(&folder, "second.png", "second_r.png");
    assert_same(&folder, "second.png", "second_f.png");
    folder.done("render --scene third.json -o third_r.png --quiet");
    let flags = "--sun 335,35 --sky 0.3 --azimuths 4 --bounces 1 --method pyramid";
    folder.done(&format!("render hills.asc {flags} -o third_f.png --quiet"));
    assert_same(&folder, "third.png", "third_r.png");
    assert_same(&folder, "third.png", "third_f.png");
    // Another surface of the same window.
    assert_same(&folder, "fourth.png", "third.png");
    // The comparison can fail.
    assert!(colours(&folder.picture("first.png")) != colours(&folder.picture("second.png")));
}

/// The window equals `render --bounces 0` under the default light and at night (`--sun 10,-5`).
#[test]
fn gpu_default_window_equals_render() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nkey h\nframes 2\nscreenshot shot.png\n";
    for light in ["", " --sun 10,-5"] {
        folder.view(
            &display,
            &format!("hills.asc{light} --size 64x48 --quiet --exposure auto"),
            script,
        );
        succeed(
            folder.command(&format!("render hills.asc{light} --bounces 0 -o render.png --quiet")),
        );
        assert_same(&folder, "shot.png", "render.png");
    }
}

/// The sun of a scene without lights depends on the camera that `render` begins with; the window's does not turn with its
/// camera. Its scene has the lights in use, from above and from a camera, also after every light of the user is deleted.
#[test]
fn gpu_default_light_is_saved() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nkey h\nframes 2\npicture map.png\nscene map.json\nkey v\nframes 1\npicture camera.png\n\
        scene camera.json\nkey o\nkey x\nframes 1\nscene deleted.json\npicture deleted.png\n";
    folder.view(&display, "hills.asc --size 96x60", script);
    for name in ["map", "camera", "deleted"] {
        folder.done(&format!("render --scene {name}.json -o {name}_r.png --quiet"));
        assert_same(&folder, &format!("{name}.png"), &format!("{name}_r.png"));
    }
    folder.done("render hills.asc --bounces 0 -o default.png --quiet");
    assert_same(&folder, "map.png", "default.png");
}

/// The window shows what is read until it is read, and the picture then. A field that cannot be read gives the error of
/// `render` on standard error, with its status, whether the window is open by then or not.
#[test]
fn gpu_window_opens_before_the_field_is_read() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "opening opening.png\nkey h\nkey h\nframes 2\nscreenshot first.png\n";
    folder.view(&display, &format!("hills.asc {LIT} --size 300x200"), script);
    let opening = folder.picture("opening.png");
    assert_eq!([opening.rows, opening.cols], [200, 300]);
    let lit = colours(&opening)[0].iter().filter(|light| **light > 0.2).count();
    // Letters: some of the picture, at most a tenth of it. The field would fill 256 x 192 of it.
    assert!((50..6000).contains(&lit), "{lit}");
    assert!(colours(&folder.picture("first.png")) != colours(&opening));
    folder.write("torn.asc", b"ncols 64 nrows 48 cellsize 1 0 1 2 3");
    for name in ["torn.asc", "missing.asc"] {
        let [render, view] = [format!("render {name} -o none.png"), format!("view {name}")];
        let [want, got] = [render, view].map(|args| {
            let mut command = folder.command(&args);
            let Output { status, stderr, .. } =
                command.env("DISPLAY", &display.name).output().unwrap();
            (status.code(), String::from_utf8(stderr).unwrap())
        });
        assert!(want.0.is_some_and(|code| code != 0) && got == want, "{got:?}, {want:?}");
    }
}

/// The window and `render --camera` use the same passes. Codes are rounded here by the device after
/// its own power function, there by the host.
#[test]
fn gpu_camera_view_equals_render() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nkey h\nkey v\nframes 2\nscreenshot shot.png\npicture saved.png\n\
        key left\nkey up\nkey +\nkey k\ndrag middle 9,9 5,3\nframes 1\nscreenshot other.png\npicture other_p.png\nscene other.json\nkey home\nlose\n\
        frames 1\nscreenshot again.png\nkey v\nframes 1\nscreenshot map.png\n";
    folder.view(&display, &format!("hills.asc {LIT} --size 96x60"), script);
    let camera = "--camera 180,45 --fov 40 --samples 1 --size 96x60";
    folder.done(&format!("render hills.asc {LIT} {camera} -o camera.png --quiet"));
    assert_same(&folder, "saved.png", "camera.png");
    assert_same(&folder, "again.png", "shot.png");
    folder.done("render --scene other.json -o other_r.png --quiet");
    assert_same(&folder, "other_p.png", "other_r.png");
    let [shot, saved, other] = ["shot.png", "saved.png", "other.png"].map(|n| folder.picture(n));
    assert!(apart(&shot, &saved) <= 1.0, "{} codes", apart(&shot, &saved));
    // The comparison can fail.
    assert!(apart(&other, &saved) > 16.0);
}

/// Specular in a camera view is viewed from the camera, as in `render --camera`. After the camera view it is again viewed from above.
#[test]
fn gpu_camera_view_reflects_towards_the_camera() {
    let (folder, display) = (Folder::new(), Display::new());
    for bounces in ["", " --bounces 1"] {
        let lit = format!("hills.asc {LIT} --albedo 0.4 --specular 20,0.5{bounces}");
        let script = "key h\nkey h\nframes 2\npicture above.png\nkey v\npicture saved.png\n\
            key left\nkey up\nkey +\nframes 1\npicture other.png\nscene other.json\nkey v\npicture again.png\n";
        folder.view(&display, &format!("{lit} --size 96x60"), script);
        let camera = "--camera 180,45 --fov 40 --samples 1 --size 96x60";
        folder.done(&format!("render {lit} {camera} -o camera.png --quiet"));
        assert_same(&folder, "saved.png", "camera.png");
        folder.done("render --scene other.json -o other_r.png --quiet");
        // The file stores the camera in rounded decimals.
        let [other, rendered] = ["other.png", "other_r.png"].map(|name| folder.picture(name));
        assert!(apart(&other, &rendered) <= 1.0, "{} codes", apart(&other, &rendered));
        folder.done(&format!("render {lit} -o map.png --quiet"));
        assert_same(&folder, "above.png", "map.png");
        assert_same(&folder, "again.png", "map.png");
    }
    // So does the reference. On level ground under a point sun, pictures and paths have the same light, and no noise. The sun in
    // the north is mirrored to the camera in the south: with the reference from above the RMSE would be above the mean.
    let level = format!("ncols 16 nrows 12 cellsize 1 {}", ["5"; 16 * 12].join(" "));
    folder.write("level.asc", level.as_bytes());
    let script = "key c\nkey v\nframes 1\npaths 128\nkey r\nframes 1\ntext camera.txt\n\
        key v\nframes 1\npaths 128\nkey r\nframes 1\ntext above.txt\n";
    let lit = "level.asc --sun 0,45,0 --albedo 0.4 --specular 20,0.5 --size 196x60";
    folder.view(&display, lit, script);
    for name in ["camera.txt", "above.txt"] {
        let text = std::fs::read_to_string(folder.0.path().join(name)).unwrap();
        let stated = text.split("RMSE ").nth(1).and_then(|after| after.split(' ').next());
        let rmse: f64 = stated.unwrap_or_else(|| panic!("{name}: {text}")).parse().unwrap();
        // f32 errs by some 1e-6.
        assert!(rmse < 0.1, "{name}: {rmse} %");
    }
}

/// The 8-bit code that a plane's linear light was read from (IEC 61966-2-1).
fn code(light: f32) -> f64 {
    let l = f64::from(light);
    let encoded = if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round()
}

/// Numbers of a report line.
fn reported(line: &str) -> (u64, u64) {
    let number = |text: Option<&str>| text.and_then(|t| t.parse().ok()).expect("a number");
    let frames = line.split(&[' ', ','][..]).nth(1);
    (number(frames), number(line.split(' ').next_back()))
}

/// A library of this folder's C, compiled.
fn compiled(folder: &Folder, name: &str) -> PathBuf {
    let source = format!("{}/tests/view/{name}.c", env!("CARGO_MANIFEST_DIR"));
    let library = folder.0.path().join(format!("lib{name}.so"));
    let mut cc = Command::new("cc");
    cc.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", &source, "-o"]);
    let Output { status, stderr, .. } = cc.arg(&library).output().unwrap();
    assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
    library
}

/// Moving heights. A leak per frame of its heights (48 KiB), its text (460 KiB) or its pixels would be at least
/// 2.3 MiB after fifty frames. Driver threads may grow by 2 MiB, once: not in both of two runs of fifty frames.
/// The heap gives free memory back before it is measured (trim.c); otherwise it would hide 25 MiB. The same with the comparison pictures and paths.
#[test]
fn gpu_frames_leak_nothing() {
    let (folder, display) = (Folder::new(), Display::new());
    let heights = |i: usize| (5.0 * ((i % 128) as f32 / 6.0).sin()).to_string();
    let heights: Vec<String> = (0..128 * 96).map(heights).collect();
    let text = format!("ncols 128 nrows 96 cellsize 1 {}", heights.join(" "));
    folder.write("large.asc", text.as_bytes());
    let script = "key w\nframes 60\nreport\nframes 50\nreport\nframes 50\nreport\n\
        key w\nkey c\npaths 320\nreport\nframes 50\nreport\nframes 50\nreport\n";
    let mut window = folder.window(&display, &format!("large.asc {LIT} --size 160x120"), script);
    window.env("LD_PRELOAD", compiled(&folder, "trim"));
    let out = silent(window);
    let lines: Vec<&str> = out.lines().filter(|line| line.starts_with("frames ")).collect();
    for three in lines.chunks_exact(3) {
        let three = [three[0], three[1], three[2]].map(reported);
        let more = three.windows(2).map(|pair| {
            assert_eq!(pair[1].0 - pair[0].0, 50, "{out}");
            pair[1].1.saturating_sub(pair[0].1)
        });
        assert!(more.min().is_some_and(|kib| kib < 2048), "KiB: {three:?}");
    }
    assert_eq!(lines.len(), 6, "{out}");
}

/// Some columns of a picture.
fn crop(planes: &Planes, first: usize, cols: usize) -> Planes {
    let cut = |plane: &Vec<f32>| -> Vec<f32> {
        let rows = plane.chunks_exact(planes.cols);
        rows.flat_map(|row| &row[first..first + cols]).copied().collect()
    };
    Planes { cols, planes: planes.planes.iter().map(cut).collect(), ..planes.clone() }
}

/// The largest difference of codes.
fn apart(a: &Planes, b: &Planes) -> f64 {
    assert_eq!([a.rows, a.cols], [b.rows, b.cols]);
    let pairs = colours(a).concat().into_iter().zip(colours(b).concat());
    pairs.map(|(a, b)| (code(a) - code(b)).abs()).fold(0.0, f64::max)
}

/// A wall across level ground, with a sun behind it. Without shadows all ground that does not touch the wall has the
/// sky's light and the sun's irradiance times the sine of its elevation over π. The main picture equals `render`'s,
/// the reference `reference`'s, and the error follows from their files.
#[test]
fn gpu_split_window_compares_with_the_reference() {
    let (folder, display) = (Folder::new(), Display::new());
    let height = |i: usize| if (40..43).contains(&(i % 64)) { "12" } else { "0" };
    let heights: Vec<&str> = (0..64 * 24).map(height).collect();
    let text = format!("ncols 64 nrows 24 cellsize 1 {}", heights.join(" "));
    folder.write("wall.asc", text.as_bytes());
    let lit = "--sun 90,30,0 --sky 0.3 --azimuths 8 --albedo 1";
    let script = "key h\nkey h\nkey c\nkey r\nframes 2\npaths 4096\nscreenshot split.png\nkey h\nkey r\nframes 1\n\
        text split.txt\nkey h\nkey h\nkey 2\nframes 2\nkey 1\nkey c\nsize 64,24\nframes 1\nscreenshot one.png\n";
    folder.view(&display, &format!("wall.asc {lit} --size 196x24"), script);
    for end in ["png", "exr"] {
        folder.done(&format!("render wall.asc {lit} -o ours.{end} --quiet"));
    }
    folder
        .done("reference wall.asc --albedo 1 --sun 90,30,0 --sky 0.3 -o ground_truth.exr --spp 4096 --quiet");
    let split = folder.picture("split.png");
    let [off, ours, ground_truth] = [0, 66, 132].map(|first| crop(&split, first, 64));
    assert!(colours(&ours) == colours(&folder.picture("ours.png")), "ours");
    assert_same(&folder, "one.png", "ours.png");
    let level = code((0.3 + 0.5 / std::f64::consts::PI) as f32);
    for (i, light) in colours(&off)[0].iter().enumerate() {
        if !(38..45).contains(&(i % 64)) {
            assert!((code(*light) - level).abs() <= 1.0, "column {}: {}", i % 64, code(*light));
        }
    }
    // In the shadow, 12 / tan 30° long.
    assert!(code(colours(&ours)[0][64 * 10 + 30]) < level - 16.0);
    let exact = folder.picture("ground_truth.exr");
    let named = |planes: &Planes, name: &str| {
        let at = planes.names.iter().position(|n| n == name).expect("a layer");
        planes.planes[at].clone()
    };
    let red = named(&exact, "R");
    for (i, (shown, light)) in colours(&ground_truth)[0].iter().zip(&red).enumerate() {
        assert!((code(*shown) - code(*light)).abs() <= 1.0, "texel {i}");
    }
    let light = folder.picture("ours.exr");
    let ours = named(&light, if light.names.iter().any(|n| n == "Y") { "Y" } else { "R" });
    let (spread, mean) =
        (named(&exact, "standard_error.R"), red.iter().sum::<f32>() / (64.0 * 24.0));
    let square = |a: f32, b: f32| f64::from(a - b).powi(2);
    let noise: f64 = spread.iter().map(|s| f64::from(*s).powi(2)).sum();
    let apart: f64 = ours.iter().zip(&red).map(|(a, b)| square(*a, *b)).sum::<f64>() - noise;
    let rmse = 100.0 * (apart / (64.0 * 24.0)).sqrt() / f64::from(mean);
    let said = std::fs::read_to_string(folder.0.path().join("split.txt")).unwrap();
    // Three digits are shown; sums of f32 and of f64 differ beyond those.
    let expected = format!("RMSE {rmse:.3} % +- ");
    assert!(said.contains(&expected), "{expected} in {said}");
}

#[test]
fn gpu_window_survives_resizing() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "frames 2\nsize 301,203\nframes 2\nkey +\nkey left\nwheel -3 20,20\nsize 64,48\nkey home\n\
        key h\nkey h\nframes 1\nsize 1,1\nframes 2\nsize 64,48\nframes 1\nscreenshot last.png\n";
    folder.view(&display, &format!("hills.asc {LIT}"), script);
    folder.done(&format!("render hills.asc {LIT} -o render.png --quiet"));
    assert_same(&folder, "last.png", "render.png");
}

/// Three pictures and the columns between them take 7 pixels: in 6 only the main one is shown, in
/// full. Paths for a hidden or impossible reference are refused.
#[test]
fn gpu_narrow_window_shows_one_picture() {
    let (folder, display) = (Folder::new(), Display::new());
    let script = "key h\nkey h\nkey c\nframes 2\nsize 6,24\nframes 2\nscreenshot narrow.png\nkey c\nframes 1\n\
        screenshot alone.png\nsize 64,48\nkey c\npaths 64\nscreenshot wide.png\n";
    folder.view(&display, &format!("hills.asc {LIT} --size 64x48"), script);
    assert_same(&folder, "narrow.png", "alone.png");
    assert_eq!(folder.picture("wide.png").cols, 64);
    for (script, says) in [
        ("key c\nframes 1\nsize 6,24\npaths 64\n", "a window 6 pixels wide"),
        ("paths 64\n", "no reference"),
        ("key c\nkey w\npaths 64\n", "a moving field"),
        ("key c\npaths 4097\n", "found 4097, expected 4096 or less"),
    ] {
        folder.write("script", script.as_bytes());
        let mut command =
            folder.command(&format!("view hills.asc {LIT} --size 64x48 --script script"));
        let Output { status, stderr, .. } = command.env("DISPLAY", &display.name).output().unwrap();
        let said = String::from_utf8(stderr).unwrap();
        assert!(!status.success() && said.contains(says), "{script}: {said}");
    }
}

fn refused(mut command: Command, says: &[&str]) {
    let Output { status, stderr, .. } = command.output().unwrap();
    let said = String::from_utf8_lossy(&stderr).into_owned();
    assert_eq!(status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(says.iter().all(|s| said.contains(s)), "{said}");
}

#[test]
fn no_display_gives_one_sentence() {
    let folder = Folder::new();
    refused(folder.command("view hills.asc"), &["ridgelight: view: needs a display: "]);
    let mut elsewhere = folder.command("view hills.asc");
    elsewhere.env("DISPLAY", ":6553");
    refused(elsewhere, &["ridgelight: view: needs a display: "]);
}

#[test]
fn window_without_a_driver_gives_one_sentence() {
    let (folder, display) = (Folder::new(), Display::new());
    let mut command = folder.command("view hills.asc");
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env(name, Path::new("no-driver.json"));
    }
    command.env("DISPLAY", &display.name).env_remove("VK_ADD_DRIVER_FILES");
    refused(command, &["driver"]);
}
