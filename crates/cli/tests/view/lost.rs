//! Window failures: driver errors, lost surfaces, no area, other programs.

use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use super::{Display, Folder, LIT, assert_same, silent};

/// Vulkan result codes.
const OUT_OF_HOST_MEMORY: i32 = -1;
pub(super) const OUT_OF_DEVICE_MEMORY: i32 = -2;
const SURFACE_LOST: i32 = -1_000_000_000;
const OUT_OF_DATE: i32 = -1_000_001_004;
/// As many calls as there are.
const ALL: u32 = 1_000_000;

/// The compiled layer of faults.c, with its manifest.
fn layer(folder: &Folder) -> PathBuf {
    let layers = folder.0.path().join("layers");
    std::fs::create_dir(&layers).unwrap();
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/view/faults.c");
    let mut cc = Command::new("cc");
    cc.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", source, "-o"]);
    let Output { status, stderr, .. } = cc.arg(layers.join("libfaults.so")).output().unwrap();
    assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
    let manifest = serde_json::json!({
        "file_format_version": "1.2.0",
        "layer": {
            "name": "VK_LAYER_test_faults",
            "type": "GLOBAL",
            "library_path": "./libfaults.so",
            "api_version": "1.3.0",
            "implementation_version": "1",
            "description": "Fails as drivers may",
        }
    });
    std::fs::write(layers.join("faults.json"), manifest.to_string()).unwrap();
    layers
}

/// A fault: a function, the number of the first call that fails, how many do, and the result.
pub(super) type Fault = (&'static str, u32, u32, i32);

/// Adds a fault to a window's command.
pub(super) fn beset(folder: &Folder, command: &mut Command, (name, first, count, result): Fault) {
    let layers = folder.0.path().join("layers");
    let layers = if layers.exists() { layers } else { layer(folder) };
    // Without a layer below ours, loaders lead its calls back to it.
    let others = std::env::var_os("VK_LAYER_PATH");
    let others = others.expect("VK_LAYER_PATH: the validation layer's, as tools/test has it");
    let mut path = layers.into_os_string();
    path.push(":");
    path.push(others);
    command.env("VK_LAYER_PATH", path).env("VK_INSTANCE_LAYERS", "VK_LAYER_test_faults");
    command.env("RIDGELIGHT_FAULT", format!("{name} {first} {count} {result}"));
}

/// Runs a command that must end with 1 and one sentence. Returns the sentence.
fn sentence(mut command: Command) -> String {
    let Output { status, stderr, .. } = command.output().unwrap();
    ended(status.code(), &stderr)
}

fn ended(code: Option<i32>, stderr: &[u8]) -> String {
    let said = String::from_utf8_lossy(stderr).into_owned();
    assert_eq!((code, said.lines().count()), (Some(1), 1), "{said}");
    said
}

/// A device fails once between acquiring and presenting an image: the window shows the error, later frames are right,
/// and validation finds no semaphore or fence in a wrong state. A window that fails again ends with the sentence.
#[test]
fn gpu_failed_frame_is_recovered() {
    let (folder, display) = (Folder::new(), Display::new());
    folder.done(&format!("render hills.asc {LIT} -o render.png --quiet"));
    for (name, result, says) in [
        ("vkResetCommandPool", OUT_OF_DEVICE_MEMORY, "recording a frame"),
        ("vkQueueSubmit2", OUT_OF_DEVICE_MEMORY, "running a frame"),
        ("vkQueuePresentKHR", OUT_OF_HOST_MEMORY, "showing frame"),
    ] {
        let script = "frames 4\ntext said.txt\nkey h\nkey h\nframes 2\nscreenshot still.png\n";
        let run = |first: u32, count: u32| {
            let mut window =
                folder.window(&display, &format!("hills.asc {LIT} --size 64x48"), script);
            beset(&folder, &mut window, (name, first, count, result));
            window
        };
        silent(run(3, 1));
        let text = std::fs::read_to_string(folder.0.path().join("said.txt")).unwrap();
        assert!(text.contains(says), "{name}: {text}");
        assert_same(&folder, "still.png", "render.png");
        let said = sentence(run(3, ALL));
        assert!(said.starts_with(&format!("ridgelight: {says}")), "{said}");
        // There was no earlier light to return to.
        let said = sentence(run(1, 1));
        assert!(said.starts_with(&format!("ridgelight: {says}")), "{said}");
    }
}

/// The next frame applies the changes of a failed one: a brush stroke; paths restart.
#[test]
fn gpu_failed_frame_keeps_its_changes() {
    let (folder, display) = (Folder::new(), Display::new());
    let args = format!("hills.asc {LIT} --size 64x48");
    let script =
        "key h\nkey h\nkey 2\nframes 2\ndrag left 30,20 12,6\nframes 3\npicture raised.png\n";
    folder.view(&display, &args, script);
    let mut window = folder.window(&display, &args, &script.replace("raised", "again"));
    beset(&folder, &mut window, ("vkQueueSubmit2", 3, 1, OUT_OF_DEVICE_MEMORY));
    silent(window);
    assert_same(&folder, "again.png", "raised.png");
    let mut window = folder.window(&display, &args, "key c\npaths 640\nscreenshot split.png\n");
    beset(&folder, &mut window, ("vkQueueSubmit2", 8, 1, OUT_OF_DEVICE_MEMORY));
    silent(window);
}

/// A surface that the driver loses is recreated wherever the loss is reported; also one that is out of date.
#[test]
fn gpu_lost_surface_is_recreated() {
    let (folder, display) = (Folder::new(), Display::new());
    folder.done(&format!("render hills.asc {LIT} -o render.png --quiet"));
    let script = "key h\nkey h\nframes 2\nscreenshot lost.png\nframes 1\nscreenshot after.png\n";
    for (name, result) in [
        ("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", SURFACE_LOST),
        ("vkAcquireNextImageKHR", SURFACE_LOST),
        ("vkAcquireNextImageKHR", OUT_OF_DATE),
        ("vkQueuePresentKHR", SURFACE_LOST),
        ("vkQueuePresentKHR", OUT_OF_DATE),
    ] {
        let args = format!("hills.asc {LIT} --size 64x48");
        let mut window = folder.window(&display, &args, script);
        beset(&folder, &mut window, (name, 3, 1, result));
        silent(window);
        assert_same(&folder, "lost.png", "render.png");
        assert_same(&folder, "after.png", "render.png");
    }
    // Permanently, as for a destroyed window.
    let mut window = folder.window(&display, &format!("hills.asc {LIT}"), "frames 9\n");
    let fault = ("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", 3, ALL, SURFACE_LOST);
    beset(&folder, &mut window, fault);
    let said = sentence(window);
    assert!(
        said.contains("its surface was lost, and so was the next: the window is gone"),
        "{said}"
    );
}

/// A window without area, as some systems give a minimised one, shows nothing and continues once it
/// has one. A script stops waiting after a time.
#[test]
fn gpu_window_without_area_waits() {
    let (folder, display) = (Folder::new(), Display::new());
    folder.done(&format!("render hills.asc {LIT} -o render.png --quiet"));
    let script = "key h\nkey h\nframes 2\nscreenshot shown.png\n";
    let args = format!("hills.asc {LIT} --size 64x48");
    let name = "vkGetPhysicalDeviceSurfaceCapabilitiesKHR";
    for first in [1, 3] {
        let mut window = folder.window(&display, &args, script);
        beset(&folder, &mut window, (name, first, 5, 0));
        silent(window);
        assert_same(&folder, "shown.png", "render.png");
    }
    let mut window = folder.window(&display, &args, "patience 1\nframes 1\nscreenshot none.png\n");
    beset(&folder, &mut window, (name, 2, ALL, 0));
    let said = sentence(window);
    let expected = "--script: screenshot: the window has shown nothing for 1 s: it has no area";
    assert!(said.contains(expected), "{said}");
    assert!(!folder.0.path().join("none.png").exists());
}

/// The result of a window without a script after an X tool has acted on it.
fn treated(folder: &Folder, display: &Display, how: &str) -> Output {
    let mut view = folder.command(&format!("view hills.asc {LIT} --size 300x200"));
    view.env("DISPLAY", &display.name).stdout(Stdio::null()).stderr(Stdio::piped());
    let view = view.spawn().unwrap();
    // `timeout` ends a wait for a window that never appears.
    let mut xdotool = Command::new("timeout");
    // The title changes once it has drawn.
    xdotool.args([
        "1200",
        "xdotool",
        "search",
        "--sync",
        "--name",
        "hills.asc - ridgelight - ",
        how,
    ]);
    let done = xdotool.env("DISPLAY", &display.name).status();
    let ended = view.wait_with_output().unwrap();
    let is_done = done.expect("xdotool: run tools/setup --tests").success();
    assert!(is_done, "{how}: {}", String::from_utf8_lossy(&ended.stderr));
    ended
}

/// Another program destroys the window (XDestroyWindow) or ends its connection to the display
/// (XKillClient): one sentence, no panic, no hang.
#[test]
fn gpu_destroyed_window_gives_one_sentence() {
    let (folder, display) = (Folder::new(), Display::new());
    let Output { status, stderr, .. } = treated(&folder, &display, "windowclose");
    let said = ended(status.code(), &stderr);
    let expected = ["another program has destroyed it", "the window is gone"];
    assert!(expected.iter().any(|e| said.contains(e)), "{said}");
    let Output { status, stderr, .. } = treated(&folder, &display, "windowkill");
    let said = String::from_utf8_lossy(&stderr);
    assert!(status.code() == Some(1) && !said.contains("panicked"), "{status}: {said}");
}
