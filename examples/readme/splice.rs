//! README.md between its marks, and its links.

use std::path::Path;

use super::{Result, wrong};

/// `readme` with what stands between the marks of `name` replaced.
pub fn with(readme: &str, name: &str, new: &str) -> Result<String> {
    let (begin, end) = (format!("<!-- begin {name} -->\n"), format!("<!-- end {name} -->"));
    let missing = || {
        let expected = format!("{} and {end}, once each", begin.trim_end());
        wrong(Path::new("README.md"), "no marks", &expected)
    };
    let (before, rest) = readme.split_once(&begin).ok_or_else(missing)?;
    let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
    if after.contains(&begin) {
        return Err(missing());
    }
    Ok(format!("{before}{begin}\n{new}\n{end}{after}"))
}

/// What `readme` links to here and is not there.
pub fn broken(readme: &str) -> Option<&str> {
    let links = readme.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0));
    let headings: Vec<String> = readme
        .lines()
        .filter_map(|line| line.strip_prefix("## "))
        .map(|title| title.to_lowercase().replace(' ', "-"))
        .collect();
    let is_there = |link: &&str| match link.strip_prefix('#') {
        Some(anchor) => headings.iter().any(|h| h == anchor),
        None => link.starts_with("http") || Path::new(link).exists(),
    };
    links.into_iter().find(|link| !is_there(link))
}
