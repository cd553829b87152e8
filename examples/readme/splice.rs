//! A page between its marks.

use std::path::Path;

use super::{Result, wrong};

/// `page` with what stands between the marks of `name` replaced.
pub fn with(path: &Path, page: &str, name: &str, new: &str) -> Result<String> {
    let (begin, end) = (format!("<!-- begin {name} -->\n"), format!("<!-- end {name} -->"));
    let missing = || {
        let expected = format!("{} and {end}, once each", begin.trim_end());
        wrong(path, "no marks", &expected)
    };
    let (before, rest) = page.split_once(&begin).ok_or_else(missing)?;
    let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
    if after.contains(&begin) {
        return Err(missing());
    }
    Ok(format!("{before}{begin}\n{new}\n{end}{after}"))
}
