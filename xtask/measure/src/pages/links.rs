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

/// One sentence for everything that is wrong.
pub fn complaints() -> Result<Vec<String>> {
    let mut pages = all(Path::new("docs"), "md")?;
    pages.extend(TOP.map(PathBuf::from));
    pages.sort();
    let texts = pages.iter().map(|page| text(page)).collect::<Result<Vec<_>>>()?;
    let mut out = Vec::new();

    let mut linked = Vec::new();
    for (page, own) in pages.iter().zip(&texts) {
        for link in links(own) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.clone() } else { beside(page, file) };
            if !target.exists() {
                out.push(format!("{} links to {link}, which does not exist", page.display()));
                continue;
            }
            if !anchor.is_empty() && !headings(&text(&target)?).any(|h| h == anchor) {
                let page = page.display();
                out.push(format!(
                    "{page} links to {link}: {} has no such heading",
                    target.display()
                ));
            }
            linked.push((page.clone(), target));
        }
    }
    for picture in all(Path::new("docs/pictures"), "")? {
        if !linked.iter().any(|(_, target)| *target == picture) {
            out.push(format!("no page shows {}", picture.display()));
        }
    }
    let summary = Path::new("docs/SUMMARY.md");
    for page in pages.iter().filter(|page| page.starts_with("docs") && *page != summary) {
        if !linked.iter().any(|(from, target)| from == summary && target == page) {
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

/// Files under a folder whose extension this is, or of any.
fn all(folder: &Path, extension: &str) -> Result<Vec<PathBuf>> {
    let failed = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            out.extend(all(&path, extension)?);
        } else if extension.is_empty() || path.extension().is_some_and(|e| e == extension) {
            out.push(path);
        }
    }
    Ok(out)
}

/// Links to files of the repository, outside blocks of code.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let prose = text.split("```").step_by(2);
    prose
        .flat_map(|part| part.split("](").skip(1))
        .filter_map(|rest| Some(rest.split_once(')')?.0))
        .filter(|link| !link.starts_with("http"))
}

/// A path as it is written on a page.
fn beside(page: &Path, link: &str) -> PathBuf {
    let mut path = page.parent().unwrap_or(Path::new("")).to_path_buf();
    for part in Path::new(link).components() {
        match part {
            std::path::Component::ParentDir if path.file_name().is_some() => {
                path.pop();
            }
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
