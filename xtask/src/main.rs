//! Checks and counts of the repository:
//! `cargo xtask layers | paths | words | size | surface | gallery | performance | install`.

mod install;
mod layers;
mod paths;
mod size;
mod source;
mod surface;
mod words;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask COMMAND
  layers [--check]   crates, modules and their imports, also into docs/architecture.md;
                     --check fails on a circle, an upward import, an old page or a folder of
                     more than 15 files
  paths              paths in CONTRIBUTING.md, docs/architecture.md and docs/adding; fails where one does not
                     exist, or where a file does not contain a name that the table in docs/architecture.md
                     gives after it
  words              coined words that tools/words.txt forbids; fails where there is one
  size               lines of Rust and GLSL, files a folder, README, dependencies of an embedder
  surface [--check]  public items of the core, as kept in xtask/surface.txt
  gallery [FOLDER]   docs/gallery/index.md and its pictures, by the release program, and the contrast of real terrain in FOLDER
  performance        measures this device: docs/measured/performance.md and its plot
  install --prefix DIR
                     the release program to DIR/bin, the C library to DIR/lib, its headers to DIR/include,
                     with files for CMake and pkg-config";

fn main() -> ExitCode {
    let root = source::root();
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments.as_slice() {
        ["layers"] => layers::print(root),
        ["layers", "--check"] => layers::check(root),
        ["paths"] => paths::check(root),
        ["words"] => words::check(root),
        ["size"] => size::print(root),
        ["gallery", data @ ..] => gallery(root, data),
        ["performance"] => performance(root),
        ["install", "--prefix", prefix] => install::install(root, Path::new(prefix)),
        ["surface"] => surface::write(root),
        ["surface", "--check"] => surface::check(root),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(text) => {
            print!("{text}");
            ExitCode::SUCCESS
        }
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

fn gallery(root: &Path, data: &[&str]) -> Result<String, String> {
    measure(root, "gallery", data)?;
    Ok("wrote docs/gallery/index.md\n".to_owned())
}

fn performance(root: &Path) -> Result<String, String> {
    let json = "benches/results/performance.json";
    measure(root, "performance", &["-o", "docs/pictures/performance.svg", "--json", json])?;
    cargo(root, &[MEASURE.as_slice(), &["pages"]].concat())?;
    Ok("wrote docs/measured/performance.md\n".to_owned())
}

/// Arguments of cargo that run `ridgelight-measure`.
const MEASURE: [&str; 6] = ["run", "--release", "--quiet", "--package", "ridgelight-measure", "--"];

/// Builds the program and the one that calls it, and runs them.
fn measure(root: &Path, name: &str, words: &[&str]) -> Result<(), String> {
    cargo(root, &["build", "--release", "--locked", "--package", "ridgelight-cli"])?;
    let program = target(root).join("release/ridgelight");
    let program = program.to_str().ok_or("the target folder is no UTF-8")?;
    cargo(root, &[MEASURE.as_slice(), &[name, program], words].concat())
}

/// Runs cargo in the repository.
fn cargo(root: &Path, words: &[&str]) -> Result<(), String> {
    let mut command = std::process::Command::new(env!("CARGO"));
    command.args(words).current_dir(root);
    let status = command.status().map_err(|e| format!("cargo {}: {e}", words.join(" ")))?;
    if status.success() { Ok(()) } else { Err(format!("cargo {} failed", words.join(" "))) }
}

/// The folder of builds.
fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), |set| root.join(set))
}
