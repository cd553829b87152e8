//! Public items of the core: a listing that is kept, so that a review shows a change of it.

use std::path::Path;

use crate::source::{Outcome, code, files, read};

const KEPT: &str = "xtask/surface.txt";

/// Lines `file: item` of what is declared `pub` outside of private modules' reach, hidden items and re-exports too.
fn listing(root: &Path) -> Result<Vec<String>, String> {
    const KINDS: [&str; 9] = [
        "fn ",
        "const fn ",
        "unsafe fn ",
        "struct ",
        "enum ",
        "trait ",
        "const ",
        "type ",
        "static ",
    ];
    let src = root.join("src");
    let mut all = Vec::new();
    for path in files(&src, &["rs"]) {
        let text = code(&read(&path)?);
        let inside = path.strip_prefix(&src).expect("below it").display().to_string();
        for line in text.lines().map(str::trim) {
            let Some(rest) = line.strip_prefix("pub ") else { continue };
            if KINDS.iter().any(|kind| rest.starts_with(kind)) {
                let end = rest.find(['(', '{', '=', ';', '<', ':']).unwrap_or(rest.len());
                let item = rest[..end].trim();
                // Of a macro: where it is called, the item is in a line of its own.
                if !item.contains('$') {
                    all.push(format!("{inside}: {item}"));
                }
            }
        }
    }
    all.sort();
    Ok(all)
}

fn text(root: &Path) -> Result<String, String> {
    let all = listing(root)?;
    Ok(format!(
        "{} public items of the crate ridgelight (cargo xtask surface)\n{}\n",
        all.len(),
        all.join("\n")
    ))
}

/// Writes the listing.
pub fn write(root: &Path) -> Outcome {
    let text = text(root)?;
    std::fs::write(root.join(KEPT), &text).map_err(|e| format!("{KEPT}: {e}"))?;
    Ok(text.lines().take(1).map(|first| format!("{first}\n")).collect())
}

/// Fails where the kept listing is another.
pub fn check(root: &Path) -> Outcome {
    let (kept, found) = (read(&root.join(KEPT))?, text(root)?);
    if kept == found {
        return Ok(format!("surface: {}\n", found.lines().next().unwrap_or_default()));
    }
    let missing = |a: &str, b: &str, sign: char| {
        let lines = a.lines().filter(|line| !b.lines().any(|other| other == *line));
        lines.map(|line| format!("  {sign} {line}\n")).collect::<String>()
    };
    let (gone, new) = (missing(&kept, &found, '-'), missing(&found, &kept, '+'));
    Err(format!(
        "surface: {KEPT} is another listing; run cargo xtask surface and review it:\n{gone}{new}"
    ))
}
