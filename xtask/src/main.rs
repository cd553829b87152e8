//! Checks and counts of the repository: `cargo xtask layers | words | size | surface [--check]`.

mod layers;
mod size;
mod source;
mod surface;
mod words;

use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask COMMAND
  layers [--check]   crates, modules and their imports, also into docs/architecture.md;
                     --check fails on a circle, an upward import or an old page
  words              coined words that tools/words.txt forbids; fails where there is one
  size               lines of Rust and GLSL, files a folder, README, dependencies of an embedder
  surface [--check]  public items of the core, as kept in tools/surface.txt";

fn main() -> ExitCode {
    let root =
        Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask stands in the repository");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments.as_slice() {
        ["layers"] => layers::print(root),
        ["layers", "--check"] => layers::check(root),
        ["words"] => words::check(root),
        ["size"] => size::print(root),
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
