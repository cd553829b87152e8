//! The binary as scripts use it: exit status 0 done, 1 failed, 2 wrong usage. On an error, one line on standard error and no
//! file changed or left behind.

mod arguments {
    mod flags;
    mod help;
    mod inputs;
    mod renamed;
    mod scene_file;
    mod unused;
}
mod bake {
    mod estimate;
    mod files;
    mod light;
    mod manifest;
    mod specular;
    mod textures;
}
mod bench;
mod camera;
mod compare;
mod files {
    pub mod gdal_inputs;
    mod gdal_positions;
    pub mod geotiff;
    mod python;
    mod table;
    mod two_runs;
    mod validators;
}
#[path = "../../../../tests/common/formats.rs"]
mod formats;
mod goals;
mod library_messages;
mod light;
mod maps;
mod needs_vulkan;
mod pictures;
mod plan;
mod reference;
mod signals;
mod trade;
mod tune;
#[path = "../../../../tests/common/v_grooves.rs"]
mod v_grooves;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// How a run ended.
struct Run {
    status: Option<i32>,
    out: String,
    /// Standard error without `notes`.
    err: String,
    /// Notes and warnings on files, notes on set suns and on time.
    notes: String,
}

/// A folder with the files of the cases, removed on drop.
struct Folder(tempfile::TempDir);

impl Folder {
    /// One valid height field of every format ("a.asc", …).
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, bytes) in formats::height_files() {
            folder.write(name, &bytes);
        }
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.path(name), bytes).unwrap();
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ridgelight"));
        command.current_dir(self.0.path()).args(args);
        // Choices of other tests and of the user stay out; Mesa keeps its shaders where they are.
        let caches = std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from);
        let caches =
            caches.or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".cache")));
        if let (Some(caches), None) = (caches, std::env::var_os("MESA_SHADER_CACHE_DIR")) {
            command.env("MESA_SHADER_CACHE_DIR", caches);
        }
        command.env("XDG_CACHE_HOME", self.path("cache"));
        command
    }

    /// Runs with whatever driver is there.
    fn run(&self, args: &[&str]) -> Run {
        ran(self.command(args))
    }

    /// The same with arguments between blanks.
    fn run_str(&self, args: &str) -> Run {
        self.run(&args.split(' ').collect::<Vec<_>>())
    }

    /// Runs without a Vulkan driver, for checks that need no device.
    fn run_without_driver(&self, args: &[&str]) -> Run {
        let mut command = self.command(args);
        for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
            command.env(name, self.path("no-driver.json"));
        }
        command.env_remove("VK_ADD_DRIVER_FILES");
        ran(command)
    }

    /// Every file by its path, hidden ones too; directories without contents.
    fn contents(&self) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let mut all = BTreeMap::new();
        let mut folders = vec![self.0.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path.clone());
                }
                all.insert(path.clone(), std::fs::read(&path).ok());
            }
        }
        all
    }
}

fn ran(mut command: Command) -> Run {
    let output = command.output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    // Notes and warnings on a file, notes on set suns or on time: "note: dem.tif: ...", "note: night: ...". Those on flags and
    // maps stay.
    let is_note = |line: &&str| {
        let rest = line.strip_prefix("note: ").or_else(|| line.strip_prefix("warning: "));
        let what = rest.and_then(|rest| rest.split(' ').next());
        let is_of_file = |what: &str| what.ends_with(':') || line.contains(" more: ");
        what.is_some_and(|what| {
            ["night:", "estimate:", "choice:"].contains(&what)
                || is_of_file(what) && what.contains('.')
        })
    };
    let (notes, err): (Vec<_>, Vec<_>) = text(output.stderr)
        .split_inclusive('\n')
        .map(str::to_owned)
        .partition(|l| is_note(&l.as_str()));
    let status = output.status.code();
    Run { status, out: text(output.stdout), err: err.concat(), notes: notes.concat() }
}

/// Runs a command that must succeed with an empty standard error.
fn succeeded(folder: &Folder, args: &str) -> Run {
    let run = folder.run_str(args);
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{args}: {}", run.out);
    run
}

/// Standard output and error of `plan` as JSON, without a driver.
fn planned(folder: &Folder, args: &str) -> [String; 2] {
    let args: Vec<&str> = ["plan", "--format", "json"].into_iter().chain(args.split(' ')).collect();
    let run = folder.run_without_driver(&args);
    assert_eq!(run.status, Some(0), "{args:?}: {}", run.err);
    [run.out, run.err]
}

/// A wrong request: arguments, the exit status, and texts that the message must contain.
type Case<'a> = (&'a str, i32, &'a [&'a str]);

/// Runs every case without a driver, and fails with the list of all mismatches.
fn refused(folder: &Folder, cases: &[Case]) {
    let before = folder.contents();
    let mut wrong = Vec::new();
    for (args, status, says) in cases {
        let run = folder.run_without_driver(&args.split(' ').collect::<Vec<_>>());
        let mut complain = |what: &str| wrong.push(format!("{args}\n  {what}\n  {}", run.err));
        if run.status != Some(*status) {
            complain(&format!("exit status {:?}, expected {status}", run.status));
        }
        // Arguments that cannot be parsed give clap's usage.
        let is_usage = *status == 2 && run.err.starts_with("error: ");
        if !is_usage && (run.err.lines().count() != 1 || !run.err.starts_with("ridgelight: ")) {
            complain("not one line");
        }
        if run.err.contains("panicked") {
            complain("a panic");
        }
        if !run.out.is_empty() {
            complain("something on stdout");
        }
        for said in says.iter().filter(|said| !run.err.contains(**said)) {
            complain(&format!("does not say {said:?}"));
        }
        if folder.contents() != before {
            complain("files are not as before");
        }
    }
    assert!(wrong.is_empty(), "{} complaints:\n{}", wrong.len(), wrong.join("\n"));
}

/// `refused` fails on a right request and on a wrong expectation.
#[test]
fn the_matrix_can_fail() {
    let folder = Folder::new();
    for case in [
        ("plan a.asc", 2, &[][..]),
        ("plan a.asc --azimuths 3", 1, &[]),
        ("plan a.asc --azimuths 3", 2, &["--border"]),
        ("plan a.asc --azimuths 3 --json p.json", 2, &["--json"]),
    ] {
        let result = std::panic::catch_unwind(|| refused(&folder, &[case]));
        assert!(result.is_err(), "{case:?} passed");
    }
}

/// A valid request without a driver gives one line with advice.
#[test]
fn a_missing_driver_is_reported() {
    let folder = Folder::new();
    refused(
        &folder,
        &[
            ("render a.asc -o out.exr", 1, &["driver"]),
            ("horizon a.asc -o out.npy", 1, &["driver"]),
            ("render a.asc -o out.exr --device nosuch", 1, &["driver"]),
            ("devices", 1, &["driver"]),
        ],
    );
}

fn read(path: &Path) -> ridgelight_io::Planes {
    ridgelight_io::read_planes(path).unwrap()
}

/// A specular map of `side`² texels: exponents 0 to 8, scales 0 to 0.4.
fn specular_map(side: u16) -> Vec<u8> {
    let count = side * side;
    let exponents = (0..count).map(|i| f32::from(i % 9));
    let scales = (0..count).map(|i| f32::from(i % 3) * 0.2);
    let bytes: Vec<u8> = exponents.chain(scales).flat_map(f32::to_le_bytes).collect();
    formats::npy("<f4", false, &format!("(2, {side}, {side})"), &bytes)
}
