//! Figures of the repository's size.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::source::{FILES, Outcome, crowded, files, read};

fn lines(
    root: &Path,
    folders: &[&str],
    extensions: &[&str],
    skip: &[&str],
) -> Result<usize, String> {
    let mut count = 0;
    for folder in folders {
        for path in files(&root.join(folder), extensions) {
            let inside = path.strip_prefix(root).expect("below it").to_string_lossy().into_owned();
            if !skip.iter().any(|part| inside.contains(part)) {
                count += read(&path)?.lines().count();
            }
        }
    }
    Ok(count)
}

/// Prints lines, folders with many files, README's size and an embedder's dependencies.
pub fn print(root: &Path) -> Outcome {
    let mut text = String::new();
    let mut row =
        |what: &str, value: String| writeln!(text, "{what:<46} {value}").expect("to a string");
    let rust = lines(root, &["."], &["rs"], &["tests/", "fuzz/"])?;
    row("lines of Rust outside tests/", rust.to_string());
    row("  of the core (src/)", lines(root, &["src"], &["rs"], &[])?.to_string());
    row("  of crates/", lines(root, &["crates"], &["rs"], &["tests/"])?.to_string());
    row(
        "  of generators (examples/, xtask/, build*)",
        lines(root, &["examples", "xtask", "build"], &["rs"], &[])?.to_string(),
    );
    row(
        "lines of Rust in tests/",
        lines(
            root,
            &["."],
            &["rs"],
            &["src/", "examples/", "xtask/", "build", "shaders_glsl", "fuzz/"],
        )?
        .to_string(),
    );
    row(
        "lines of GLSL",
        lines(root, &["shaders_glsl"], &["comp", "vert", "frag", "glsl"], &[])?.to_string(),
    );
    let readme = read(&root.join("README.md"))?;
    row("README.md", format!("{} bytes, {} lines", readme.len(), readme.lines().count()));
    let many = crowded(root)?;
    row(
        &format!("folders with more than {FILES} files"),
        format!("{} {}", many.len(), many.join(", ")),
    );
    let tree = |edges: &str| -> Result<usize, String> {
        let arguments =
            ["tree", "--locked", "--package", "ridgelight", "--prefix", "none", "--edges", edges];
        let done = Command::new("cargo")
            .args(arguments)
            .current_dir(root)
            .output()
            .map_err(|e| e.to_string())?;
        let mut all: Vec<_> =
            String::from_utf8_lossy(&done.stdout).lines().map(|l| l.replace(" (*)", "")).collect();
        all.sort();
        all.dedup();
        Ok(all.len().saturating_sub(1))
    };
    row("crates that an embedder compiles, build aside", tree("normal")?.to_string());
    row("  with those of the build", tree("normal,build")?.to_string());
    Ok(text)
}
