//! Fields as geometry beside what is kept of them as an aggregate, of `benches/results/brdf.txt`.

use std::path::Path;

use super::Result;
use super::figures::{cells, text, wrong};

/// A row for each field and light: mean radiance, and the error of each.
pub fn brdf() -> Result<String> {
    let path = Path::new("benches/results/brdf.txt");
    let text = text(path)?;
    let missing = |what: &str| wrong(path, "another text", what);
    let mut out = String::from(
        "| field | light | mean radiance of the geometry | error of its triangles, % | of the table, % | of 8 factors, % | \
         reflected, at most % | not reciprocal, % | table between its directions, % | 8 factors between them, % |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    let (mut name, mut first) = ("", Vec::new());
    for line in text.lines().filter(|line| line.starts_with('|') && !line.starts_with("|---")) {
        let row = cells(line);
        match (row[0], row.len()) {
            ("direct" | "all", 8) => {
                let own = first.iter().find(|own: &&Vec<&str>| own[0] == row[0]);
                let own = own.ok_or_else(|| missing("a table before its pairs"))?;
                let all = [row[1], row[2], row[4], row[6], own[3], own[1], own[5], own[9]];
                out += &format!("| {name} | {} | {} |\n", row[0], all.join(" | "));
            }
            ("direct" | "all", 14) => first.push(row),
            ("direct" | "all", _) => return Err(missing("rows of 8 or 14 cells")),
            (head, _) if head.ends_with("pairs") => {}
            (head, _) => (name, first) = (head, Vec::new()),
        }
    }
    if first.is_empty() {
        return Err(missing("rows of pairs"));
    }
    let mut lines = text.lines();
    let (when, device) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    out += &format!("\n50 pairs of light and view (`cargo measure brdf`). {device}; {when}.\n");
    Ok(out)
}
