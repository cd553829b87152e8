//! Commands that a signal ends early.

// coreutils' `env` restores signals that a background script ignores.
#![cfg(target_os = "linux")]

use std::io::Read;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::needs_vulkan::write_field;
use crate::{Folder, read};

/// Longer than any step here, on a busy machine too.
const PATIENCE: Duration = Duration::from_secs(600);

/// Waits until `is_so`; false where it never is.
fn wait_until(mut is_so: impl FnMut() -> bool) -> bool {
    let begin = Instant::now();
    while begin.elapsed() < PATIENCE {
        if is_so() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    false
}

/// A command in `folder` that signals end as they do by default.
fn started(folder: &Folder, args: &str) -> Child {
    let mut command = Command::new("env");
    command.args(["--default-signal=INT,TERM,HUP", env!("CARGO_BIN_EXE_ridgelight")]);
    command.current_dir(folder.path("")).args(args.split(' '));
    command.stderr(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap()
}

/// Waits until `is_so` of a command that runs on.
///
/// # Panics
/// Where the command ends first, with what it printed, and where `is_so` never comes.
fn wait_while_running(child: &mut Child, what: &str, mut is_so: impl FnMut() -> bool) {
    let mut ended = None;
    let came = wait_until(|| {
        ended = child.try_wait().unwrap();
        ended.is_some() || is_so()
    });
    if let Some(status) = ended {
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        panic!("{what} is waited for, and the command ended with {status}: {said}");
    }
    if !came {
        child.kill().unwrap();
    }
    assert!(came, "{what} never came");
}

/// Sends a signal and waits for the end.
fn ended_by(signal: &str, mut child: Child) -> Output {
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-s", signal, &pid]).status().unwrap().success());
    let ended = wait_until(|| child.try_wait().unwrap().is_some());
    if !ended {
        child.kill().unwrap();
    }
    let output = child.wait_with_output().unwrap();
    assert!(ended, "{signal} is not heard");
    assert_eq!(output.status.code(), Some(130), "{signal}");
    output
}

/// Brute force in 512 azimuths of 256², 268 MB of results: seconds on a software driver.
#[test]
fn gpu_an_interrupted_command_leaves_no_file() {
    let folder = Folder::new();
    write_field(&folder, 256, |r, c| ((7 * r + 3 * c) % 11) as f32);
    folder.write("out.npy", b"what was here before");
    let before = folder.contents();
    for signal in ["INT", "TERM"] {
        let args = "horizon field.npy --cell 1 -o out.npy --distances far.npy --azimuths 512 --method brute-force";
        let mut child = started(&folder, args);
        // Both files are begun, so that the comparison below can fail.
        wait_while_running(&mut child, "the beginning of both files", || {
            folder.contents().len() == before.len() + 2
        });
        let output = ended_by(signal, child);
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "ridgelight: interrupted\n");
        assert!(output.stdout.is_empty());
        assert!(folder.contents() == before, "{signal} left files");
    }
}

/// Pictures of azimuths are written as they come. An interrupt removes them and a new folder; an existing folder stays as it was,
/// with its manifest.
#[test]
fn gpu_an_interrupted_bake_leaves_nothing() {
    let folder = Folder::new();
    write_field(&folder, 256, |r, c| ((7 * r + 3 * c) % 11) as f32);
    let words = "--what horizon --azimuths 512 --method sweep --format png,ktx2";
    for signal in ["INT", "TERM"] {
        let before = folder.contents();
        let mut child = started(&folder, &format!("bake field.npy --cell 1 -o out {words}"));
        // The folder, the texture and more than one picture.
        wait_while_running(&mut child, "the second picture", || {
            folder.contents().len() >= before.len() + 4
        });
        let output = ended_by(signal, child);
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "ridgelight: interrupted\n");
        let left = folder.contents();
        let more: Vec<_> = left.keys().filter(|path| !before.contains_key(*path)).collect();
        assert!(left == before, "{signal} left {more:?}");
        if signal == "INT" {
            crate::needs_vulkan::done(
                &folder,
                "bake field.npy -o out --what horizon --azimuths 4 --quiet",
            );
        }
    }
}

/// A billion paths of 64 bounces a texel: more than any device traces before the signal.
#[test]
fn gpu_an_interrupted_reference_writes_what_it_has() {
    let folder = Folder::new();
    write_field(&folder, 16, |r, c| ((7 * r + 3 * c) % 11) as f32);
    let args = "reference field.npy --cell 1 --sky 1 -o out.exr --spp 1000000000 --bounces 64 --json out.json";
    let mut child = started(&folder, args);
    // The handler is installed before the device opens.
    let maps = format!("/proc/{}/maps", child.id());
    let opens = || std::fs::read_to_string(&maps).is_ok_and(|m| m.contains("libvulkan"));
    wait_while_running(&mut child, "a device", opens);
    let output = ended_by("INT", child);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.starts_with("Wrote out.exr (16x16, ") && said.lines().count() == 1, "{said}");
    let exr = read(&folder.path("out.exr"));
    assert_eq!(exr.names.len(), 6);
    assert!(exr.planes.concat().iter().all(|v| v.is_finite()));
    assert!(folder.path("out.json").exists());
    let hidden = |p: &std::path::PathBuf| p.to_string_lossy().contains(".ridgelight");
    assert!(!folder.contents().keys().any(hidden));
}
