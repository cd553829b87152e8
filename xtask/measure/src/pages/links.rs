//! What must hold of all pages: README.md's size, links, the list of pages, pictures that are shown.

use std::path::{Path, PathBuf};

use super::Result;
use super::figures::text;

/// Most bytes and lines of README.md.
const README_BYTES: usize = 12 * 1024;
const README_LINES: usize = 250;

/// Pages of the repository whose links are checked, besides those of docs/.
const TOP: [&str; 4] =
    ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "benches/results/README.md"];

/// A sentence for each error.
pub fn complaints() -> Result<Vec<String>> {
    let mut pages = files_in(Path::new("docs"), "md")?;
    pages.extend(TOP.map(PathBuf::from));
    pages.sort();
    let (mut out, mut linked) = (Vec::new(), Vec::new());
    for page in &pages {
        let (name, own) = (page.display(), text(page)?);
        // Links to files of the repository, outside blocks of code.
        let prose = own.split("```").step_by(2).flat_map(|part| part.split("](").skip(1));
        let links = prose.filter_map(|rest| Some(rest.split_once(')')?.0));
        for link in links.filter(|link| !link.starts_with("http")) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.clone() } else { beside(page, file) };
            if !target.exists() {
                out.push(format!("{name} links to {link}, which does not exist"));
            } else if !anchor.is_empty() && !headings(&text(&target)?).any(|h| h == anchor) {
                let target = target.display();
                out.push(format!("{name} links to {link}: {target} has no such heading"));
            } else {
                linked.push((page, target));
            }
        }
    }
    for picture in files_in(Path::new("docs/pictures"), "")? {
        if !linked.iter().any(|(_, target)| *target == picture) {
            out.push(format!("no page shows {}", picture.display()));
        }
    }
    let summary = Path::new("docs/SUMMARY.md");
    for page in pages.iter().filter(|page| page.starts_with("docs") && *page != summary) {
        if !linked.iter().any(|(from, target)| *from == summary && target == page) {
            out.push(format!("{} does not list {}", summary.display(), page.display()));
        }
    }
    let readme = text(Path::new("README.md"))?;
    let (bytes, lines) = (readme.len(), readme.lines().count());
    if bytes > README_BYTES || lines > README_LINES {
        out.push(format!(
            "README.md: found {bytes} bytes in {lines} lines, expected at most {README_BYTES} in {README_LINES}"
        ));
    }
    Ok(out)
}

/// Files under a folder with this extension, or with any.
fn files_in(folder: &Path, extension: &str) -> Result<Vec<PathBuf>> {
    let failed = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            out.extend(files_in(&path, extension)?);
        } else if extension.is_empty() || path.extension().is_some_and(|e| e == extension) {
            out.push(path);
        }
    }
    Ok(out)
}

/// The path of a link on a page.
fn beside(page: &Path, link: &str) -> PathBuf {
    let mut path = page.parent().unwrap_or(Path::new("")).to_path_buf();
    for part in Path::new(link).components() {
        match part {
            std::path::Component::ParentDir if path.file_name().is_some() => _ = path.pop(),
            other => path.push(other),
        }
    }
    path
}

/// Anchors of a page's headings, as code hosts and mdBook make them.
fn headings(text: &str) -> impl Iterator<Item = String> {
    let titles = text.lines().filter(|line| line.starts_with('#'));
    titles.map(|line| {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
        title.chars().filter(kept).map(|c| if c == ' ' { '-' } else { c }).collect()
    })
}
