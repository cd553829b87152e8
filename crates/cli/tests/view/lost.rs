//! What befalls windows: drivers that fail, surfaces that are lost, no area, other programs.

use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use super::{Display, Folder, LIT, assert_same, silent};

/// Vulkan's names of what drivers say, and their numbers.
const OUT_OF_HOST_MEMORY: i32 = -1;
const OUT_OF_DEVICE_MEMORY: i32 = -2;
const SURFACE_LOST: i32 = -1_000_000_000;
const OUT_OF_DATE: i32 = -1_000_001_004;
/// Calls, for as long as there are any.
const ALL: u32 = 1_000_000;

/// The layer of faults.c, compiled, with its manifest.
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

/// A fault: a function, the number of the first call that fails, how many do, and with what.
type Fault = (&'static str, u32, u32, i32);

/// Has a window meet a fault.
fn beset(folder: &Folder, command: &mut Command, (name, first, count, result): Fault) {
    let layers = folder.0.path().join("layers");
    let layers = if layers.exists() { layers } else { layer(folder) };
    // Without a layer below ours loaders lead its calls back to it.
    let others = std::env::var_os("VK_LAYER_PATH");
    let others = others.expect("VK_LAYER_PATH: the validation layer's, as tools/test has it");
    let mut path = layers.into_os_string();
    path.push(":");
    path.push(others);
    command.env("VK_LAYER_PATH", path).env("VK_INSTANCE_LAYERS", "VK_LAYER_test_faults");
    command.env("RIDGELIGHT_FAULT", format!("{name} {first} {count} {result}"));
}

/// Runs what must end with 1 and one sentence, which it returns.
fn sentence(mut command: Command) -> String {
    let Output { status, stderr, .. } = command.output().unwrap();
    ended(status.code(), &stderr)
}

fn ended(code: Option<i32>, stderr: &[u8]) -> String {
    let said = String::from_utf8_lossy(stderr).into_owned();
    assert_eq!((code, said.lines().count()), (Some(1), 1), "{said}");
    said
}

/// A device that fails once between the taking of a picture and its showing: it is said in the window, the frames after it
/// are right, and validation finds no semaphore or fence in a wrong state. A window that fails again ends with the sentence.
#[test]
fn gpu_a_frame_that_fails_is_not_the_last() {
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
        // Nothing had been drawn that could be gone back to.
        let said = sentence(run(1, 1));
        assert!(said.starts_with(&format!("ridgelight: {says}")), "{said}");
    }
}

/// What a frame that fails was to light is lit by the next: a stroke of a brush, as without the failure; and paths that were
/// being traced begin anew.
#[test]
fn gpu_what_a_failed_frame_was_to_light_is_lit_after_it() {
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

/// A surface that the driver has lost while its window lives is made anew, wherever that is met; the same of pictures that
/// are no longer as the window is.
#[test]
fn gpu_a_lost_surface_is_made_anew() {
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
    // For good: of a window that is gone.
    let mut window = folder.window(&display, &format!("hills.asc {LIT}"), "frames 9\n");
    let fault = ("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", 3, ALL, SURFACE_LOST);
    beset(&folder, &mut window, fault);
    let said = sentence(window);
    assert!(
        said.contains("its surface was lost, and so was the next: the window is gone"),
        "{said}"
    );
}

/// A window without area, as a minimised one is on some systems, shows nothing and goes on once it has one; a script does
/// not wait for ever.
#[test]
fn gpu_a_window_without_area_waits() {
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

/// What a window without a script, as people have it, ends with once a tool of X's has done something to it.
fn treated(folder: &Folder, display: &Display, how: &str) -> Output {
    let mut view = folder.command(&format!("view hills.asc {LIT} --size 300x200"));
    view.env("DISPLAY", &display.name).stdout(Stdio::null()).stderr(Stdio::piped());
    let view = view.spawn().unwrap();
    // It waits for a window that never comes, too.
    let mut xdotool = Command::new("timeout");
    // Its title says so once it has drawn.
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

/// Another program destroys the window (XDestroyWindow), or ends its connection to the display (XKillClient): a sentence, no
/// panic, nothing that hangs.
#[test]
fn gpu_a_window_that_others_end_says_so() {
    let (folder, display) = (Folder::new(), Display::new());
    let Output { status, stderr, .. } = treated(&folder, &display, "windowclose");
    let said = ended(status.code(), &stderr);
    let expected = ["another program has destroyed it", "the window is gone"];
    assert!(expected.iter().any(|e| said.contains(e)), "{said}");
    let Output { status, stderr, .. } = treated(&folder, &display, "windowkill");
    let said = String::from_utf8_lossy(&stderr);
    assert!(status.code() == Some(1) && !said.contains("panicked"), "{status}: {said}");
}
