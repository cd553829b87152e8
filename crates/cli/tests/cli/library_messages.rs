//! The library names settings ("azimuths"); only the command line knows flags ("--azimuths").

use std::path::{Path, PathBuf};

/// String literals of Rust source with their lines, without comments and without what follows `#[cfg(test)]`.
fn literals(source: &str) -> Vec<(usize, &str)> {
    let source = source.split("#[cfg(test)]").next().unwrap_or_default();
    let mut all = Vec::new();
    let mut at = 0;
    while let Some(next) = source[at..].find(['"', '/', '\'', 'r']).map(|i| at + i) {
        let rest = &source[next..];
        let skip = |end: &str| rest.find(end).map_or(rest.len(), |i| i + end.len());
        let is_word = source[..next].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let hashes = rest[1..].len() - rest[1..].trim_start_matches('#').len();
        at = next
            + if rest.starts_with("//") {
                skip("\n")
            } else if rest.starts_with("/*") {
                skip("*/")
            } else if rest.starts_with('r') && !is_word && rest[1 + hashes..].starts_with('"') {
                let (open, end) = (2 + hashes, format!("\"{}", "#".repeat(hashes)));
                let length = rest[open..].find(&end).unwrap_or(rest.len() - open);
                all.push((next, &rest[open..open + length]));
                open + length + end.len()
            } else if let Some(inner) = rest.strip_prefix('"') {
                let mut is_escaped = false;
                let close = inner.find(|c| {
                    let closes = c == '"' && !is_escaped;
                    is_escaped = c == '\\' && !is_escaped;
                    closes
                });
                let length = close.unwrap_or(inner.len());
                all.push((next, &inner[..length]));
                (length + 2).min(rest.len())
            } else if rest.starts_with("'\"'") {
                3
            } else if rest.starts_with("'\\") {
                // An escaped character, as '\'' or '\\'.
                3 + rest[3..].find('\'').map_or(0, |i| i + 1)
            } else {
                1
            };
    }
    let line = |at: usize| 1 + source[..at].matches('\n').count();
    all.into_iter().map(|(at, text)| (line(at), text)).collect()
}

/// Whether the text holds `--word`.
fn has_flag(text: &str) -> bool {
    text.match_indices("--").any(|(at, _)| {
        let is_start = !text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '-' || c == '_');
        is_start && text[at + 2..].starts_with(|c: char| c.is_ascii_lowercase())
    })
}

fn sources(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "tests" {
            sources(&path, all);
        } else if name.ends_with(".rs") && name != "tests.rs" {
            all.push(path);
        }
    }
}

#[test]
fn library_messages_name_no_flags() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = Vec::new();
    sources(&root.join("src"), &mut files);
    for entry in std::fs::read_dir(root.join("crates")).unwrap() {
        let folder = entry.unwrap().path();
        if !folder.ends_with("cli") && folder.join("src").is_dir() {
            sources(&folder.join("src"), &mut files);
        }
    }
    assert!(files.len() > 100, "{} files", files.len());
    let mut found = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        for (line, literal) in literals(&text).into_iter().filter(|(_, text)| has_flag(text)) {
            found.push(format!("{}:{line}: {literal}", file.display()));
        }
    }
    let advice = "name the setting instead, as \"azimuths\" or \"`lines exact`\"; `setup::in_flags` makes flags of it";
    assert!(found.is_empty(), "{advice}:\n{}", found.join("\n"));
}

#[test]
fn flags_are_found_in_literals_alone() {
    let source = "// \"--comment\"\nlet c = '\"'; let e = '\\''; f(\"a \\\" --flag\", r#\"--raw \"\"#); /* \"--x\" */ \
                  let r = \"a -- b, ---\"; g::<'a>(\"--last\")\n#[cfg(test)] \"--test\"";
    let found: Vec<_> = literals(source).into_iter().filter(|(_, text)| has_flag(text)).collect();
    assert_eq!(found, [(2, "a \\\" --flag"), (2, "--raw \""), (2, "--last")]);
}
