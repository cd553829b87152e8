//! Fields as geometry beside what is kept of them as an aggregate, of `benches/results/brdf.txt`.

use std::fmt::Write as _;
use std::path::Path;

use super::Result;

/// A row for each field and light: mean radiance, and the error of each.
pub fn brdf() -> Result<String> {
    let path = Path::new("benches/results/brdf.txt");
    let text = super::text(path)?;
    let missing = |what: &str| super::wrong(path, "another text", what);
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let mut out = String::from(
        "| field | light | mean radiance of the geometry | error of its triangles, % | of the table, % | of 8 factors, % | \
         reflected, at most % | not reciprocal, % | table between its directions, % | 8 factors between them, % |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    let (mut name, mut first, mut count) = (String::new(), Vec::new(), 0);
    for line in text.lines().filter(|line| line.starts_with('|') && !line.starts_with("|---")) {
        let cells = cells(line);
        match cells[0].as_str() {
            "direct" | "all" if cells.len() == 8 => {
                let own: &Vec<String> = first
                    .iter()
                    .find(|own: &&Vec<String>| own[0] == cells[0])
                    .ok_or_else(|| missing("a table before its pairs"))?;
                writeln!(
                    out,
                    "| {name} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
                    cells[0],
                    cells[1],
                    cells[2],
                    cells[4],
                    cells[6],
                    own[3],
                    own[1],
                    own[5],
                    own[9]
                )
                .unwrap();
                count += 1;
            }
            "direct" | "all" if cells.len() == 14 => first.push(cells),
            "direct" | "all" => return Err(missing("rows of 8 or 14 cells")),
            head if head.ends_with("pairs") => {}
            head => (name, first) = (head.to_owned(), Vec::new()),
        }
    }
    if count == 0 {
        return Err(missing("rows of pairs"));
    }
    let mut lines = text.lines();
    let (when, device) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    writeln!(out, "\n50 pairs of light and view (`examples/scatter brdf`). {device}; {when}.")
        .unwrap();
    Ok(out)
}
