//! Paths and names that the pages for contributors give.

use std::collections::BTreeSet;
use std::path::Path;

use crate::source::{Outcome, files, listed, read};

/// Pages whose paths are checked.
const PAGES: [&str; 3] = ["CONTRIBUTING.md", "docs/adding/index.md", "docs/architecture.md"];

/// The heading of the table. The last cell of each row gives a path, then names in that file.
const TABLE: &str = "\n## Where to find what\n";

/// Endings of files. A path with one of them must exist, whatever its first folder is.
const ENDINGS: [&str; 5] = [".rs", ".comp", ".glsl", ".md", ".h"];

/// Fails with each path that does not exist and each name that its file does not contain.
pub fn check(root: &Path) -> Outcome {
    let known = known(root)?;
    let (mut rows_read, mut wrong) = (0, Vec::new());
    for page in PAGES {
        let text = read(&root.join(page))?;
        rows_read += answers(&text).count();
        let found = complaints(&text, &known, |path| read(&root.join(path)))?;
        wrong.extend(found.into_iter().map(|reason| format!("{page}: {reason}")));
    }
    if rows_read == 0 {
        wrong.push(format!("no page has the table {:?}", TABLE.trim()));
    }
    if wrong.is_empty() {
        let pages = PAGES.len();
        return Ok(format!(
            "paths: all of {pages} pages exist, with the names of {rows_read} rows\n"
        ));
    }
    Err(format!("paths:\n  {}", wrong.join("\n  ")))
}

/// Files and folders of the repository, and the files that the trials of docs/adding make.
fn known(root: &Path) -> Result<BTreeSet<String>, String> {
    let mut all = BTreeSet::new();
    for path in listed(root, &["."])?.lines() {
        all.extend(Path::new(path).ancestors().filter_map(Path::to_str).map(str::to_owned));
    }
    for trial in files(&root.join("docs/adding"), &["diff"]) {
        let text = read(&trial)?;
        all.extend(text.lines().filter_map(|line| line.strip_prefix("+++ b/")).map(str::to_owned));
    }
    Ok(all)
}

/// What a page writes between backquotes, outside blocks of code.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split("```").step_by(2).flat_map(|prose| prose.split('`').skip(1).step_by(2))
}

/// The last cells of the table's rows.
fn answers(page: &str) -> impl Iterator<Item = &str> {
    let table = page.split_once(TABLE).map_or("", |(_, rest)| rest);
    let table = table.split_once("\n## ").map_or(table, |(table, _)| table);
    let rows = table.lines().filter_map(|line| line.strip_prefix('|')?.strip_suffix('|'));
    // Head and rule hold no text.
    let cells = rows.filter_map(|row| row.rsplit('|').next());
    cells.filter(|cell| cell.contains(char::is_alphabetic))
}

/// Whether this is a path of the repository, and not a pattern such as `tests/gpu/ROOM/cpu_reference.rs`.
fn is_path(word: &str, known: &BTreeSet<String>) -> bool {
    let Some((first, _)) = word.split_once('/') else { return false };
    let is_pattern = word.contains(['*', ' ']) || word.contains("ROOM");
    let is_file = ENDINGS.iter().any(|ending| word.ends_with(*ending));
    !is_pattern && (is_file || known.contains(first))
}

/// Whether a text contains a name as a whole word.
fn has_name(text: &str, name: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(name).any(|(at, _)| {
        !text[..at].ends_with(is_part) && !text[at + name.len()..].starts_with(is_part)
    })
}

/// What is wrong with the paths and names of a page. `contents` reads a file.
fn complaints(
    page: &str,
    known: &BTreeSet<String>,
    contents: impl Fn(&str) -> Outcome,
) -> Result<Vec<String>, String> {
    // `tools/test --all` is a path with arguments.
    let words = quoted(page).map(|word| word.split(' ').next().unwrap_or(word));
    let missing = words.filter(|path| is_path(path, known) && !known.contains(*path));
    let mut wrong: Vec<_> = missing.map(|path| format!("{path} does not exist")).collect();
    for answer in answers(page) {
        let mut file = None;
        for word in quoted(answer) {
            if is_path(word, known) {
                file = Some(word);
                continue;
            }
            match file {
                None => wrong.push(format!("no file stands before {word}")),
                // Listed above.
                Some(path) if !known.contains(path) => {}
                Some(path) if has_name(&contents(path)?, word) => {}
                Some(path) => wrong.push(format!("{path} does not contain {word}")),
            }
        }
    }
    Ok(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::root;

    #[test]
    fn paths_and_names_of_the_pages_exist() {
        check(root()).unwrap();
        // Something was read at all.
        let page = read(&root().join("docs/architecture.md")).unwrap();
        assert!(answers(&page).count() > 10 && quoted(&page).count() > 50);
        let known = known(root()).unwrap();
        assert!(known.contains("src/plan") && known.contains("src/plan/mod.rs"));
    }

    #[test]
    fn a_path_or_a_name_that_does_not_exist_is_found() {
        let known = BTreeSet::from(["src", "src/a.rs"].map(str::to_owned));
        let of = |page: &str| {
            let contents = |_: &str| Ok("fn place_all() {}\nfn own() {}".to_owned());
            complaints(page, &known, contents).unwrap()
        };
        assert!(
            of("`src/a.rs`, `src/*.rs`, `src/ROOM/a.rs` and `own`\n```\n`src/b.rs`\n```\n")
                .is_empty()
        );
        assert_eq!(of("`src/b`, then `b/a.rs`"), ["src/b does not exist", "b/a.rs does not exist"]);
        assert_eq!(of("`src/b --all`, `src/a.rs --all`"), ["src/b does not exist"]);
        let table = |answer: &str| {
            of(&format!(
                "# A\n\n## Where to find what\n\n| | |\n|---|---|\n| `x` | {answer} |\n\n## B\n\n| `y` | `z` |\n"
            ))
        };
        assert!(table("`src/a.rs`: `own`, `place_all`").is_empty());
        assert_eq!(table("`src/a.rs`: `place`"), ["src/a.rs does not contain place"]);
        assert_eq!(table("`own`"), ["no file stands before own"]);
        assert_eq!(table("`src/b.rs`: `own`"), ["src/b.rs does not exist"]);
    }
}
