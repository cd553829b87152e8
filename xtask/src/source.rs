//! Files of the repository, and Rust without what readers of its structure skip.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What a command prints, or why it fails.
pub type Outcome = Result<String, String>;

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask stands in the repository")
}

/// Reads a file as text.
pub fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

/// Every file below a folder with one of these extensions, sorted; build outputs and hidden folders left out.
pub fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if path.is_dir() {
                if name != "target" && name != "out" && !name.starts_with('.') {
                    open.push(path);
                }
            } else if path.extension().is_some_and(|e| extensions.iter().any(|wanted| e == *wanted))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Files that a folder holds at most.
pub const FILES: usize = 15;

/// Paths of the files that match these pathspecs and that git tracks or would add, one per line.
pub fn listed(root: &Path, specs: &[&str]) -> Outcome {
    let mut git = Command::new("git");
    git.current_dir(root)
        .args(["ls-files", "--cached", "--others", "--exclude-standard", "--deduplicate", "--"])
        .args(specs);
    let done = git.output().map_err(|e| format!("git: {e}"))?;
    if !done.status.success() {
        return Err(format!("git ls-files: {}", String::from_utf8_lossy(&done.stderr)));
    }
    let all = String::from_utf8_lossy(&done.stdout);
    // Without files that are deleted and not staged.
    let here = all.lines().filter(|path| root.join(path).symlink_metadata().is_ok());
    Ok(here.map(|path| format!("{path}\n")).collect())
}

/// Folders with more than [`FILES`] files of git, and their number; results of measurements left out.
pub fn crowded(root: &Path) -> Result<Vec<String>, String> {
    Ok(above(&listed(root, &[".", ":!benches/results"])?))
}

/// The same of a list of paths.
fn above(paths: &str) -> Vec<String> {
    let mut folders = BTreeMap::<&str, usize>::new();
    for path in paths.lines() {
        let folder = path.rsplit_once('/').map_or(".", |(folder, _)| folder);
        *folders.entry(folder).or_default() += 1;
    }
    let many = folders.into_iter().filter(|(_, count)| *count > FILES);
    many.map(|(folder, count)| format!("{folder} {count}")).collect()
}

/// Rust without its line comments and without the unit tests at a file's end.
pub fn code(text: &str) -> String {
    let text = text.split("\n#[cfg(test)]\n").next().unwrap_or(text);
    let line = |line: &str| line.split_once("//").map_or(line, |(code, _)| code).to_owned();
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// Names that follow `prefix` in Rust code: of `crate::` the modules that are named after it, also in braces.
pub fn after(code: &str, prefix: &str) -> Vec<String> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let name =
        |text: &str| text.trim_start().chars().take_while(|c| is_name(*c)).collect::<String>();
    let mut names = Vec::new();
    for (at, _) in code.match_indices(prefix) {
        if code[..at].ends_with(|c: char| is_name(c) || c == ':' || c == '$') {
            continue;
        }
        let rest = &code[at + prefix.len()..];
        let Some(inner) = rest.strip_prefix('{') else {
            names.push(name(rest));
            continue;
        };
        // The first name of each part between commas that are in no inner braces.
        let (mut depth, mut begin) = (0, 0);
        for (i, c) in inner.char_indices() {
            if depth == 0 && (c == ',' || c == '}') {
                names.push(name(&inner[begin..i]));
                begin = i + 1;
            }
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                _ => {}
            }
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Files that git tracks or would add; not those that it ignores or that are gone.
    #[test]
    fn files_are_listed_before_git_knows_them() {
        let root = std::env::temp_dir().join(format!("ridgelight-listed-{}", std::process::id()));
        fs::create_dir_all(root.join("a")).unwrap();
        let git = |args: &[&str]| {
            assert!(Command::new("git").current_dir(&root).args(args).status().unwrap().success());
        };
        git(&["init", "--quiet"]);
        for (name, text) in
            [("a/kept", ""), ("a/gone", ""), (".gitignore", "ignored\n"), ("ignored", "")]
        {
            fs::write(root.join(name), text).unwrap();
        }
        git(&["add", "a"]);
        fs::remove_file(root.join("a/gone")).unwrap();
        fs::write(root.join("a/new"), "").unwrap();
        let all = listed(&root, &["."]);
        fs::remove_dir_all(&root).unwrap();
        let mut all: Vec<String> = all.unwrap().lines().map(str::to_owned).collect();
        all.sort();
        assert_eq!(all, [".gitignore", "a/kept", "a/new"]);
    }

    #[test]
    fn names_are_read_from_paths_and_braces() {
        let text = "use crate::plan::{Plan, View};\nuse crate::{Error, passes::{sweep, x}, scene};\nlet a = crate::gpu::f();";
        let names = after(text, "crate::");
        assert_eq!(names, ["plan", "Error", "passes", "scene", "gpu"]);
        assert!(after("$crate::graph::x", "crate::").is_empty());
    }

    #[test]
    fn a_folder_may_hold_fifteen_files() {
        let paths = |count: usize| (0..count).map(|i| format!("a/b/{i}.rs\n")).collect::<String>();
        assert!(above(&(paths(FILES) + "a/x.rs\nx.rs\n")).is_empty());
        assert_eq!(above(&paths(FILES + 1)), ["a/b 16"]);
    }

    #[test]
    fn comments_and_tests_are_no_code() {
        let text = "use crate::a; // crate::b\n\n#[cfg(test)]\nmod tests { use crate::c; }";
        assert_eq!(after(&code(text), "crate::"), ["a"]);
    }
}
