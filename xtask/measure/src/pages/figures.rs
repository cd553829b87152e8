//! Figures of benches/results, with readers that name what is missing.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::Result;

pub const RESULTS: &str = "benches/results";

pub fn text(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

pub fn wrong(path: &Path, found: &str, expected: &str) -> String {
    format!("{}: found {found}, expected {expected}", path.display())
}

/// Cells of a table's row.
pub fn cells(line: &str) -> Vec<&str> {
    let line = line.trim();
    let line = line.strip_prefix('|').unwrap_or(line);
    line.strip_suffix('|').unwrap_or(line).split('|').map(str::trim).collect()
}

/// A JSON file of the results.
pub struct Figures {
    pub path: PathBuf,
    pub all: Value,
}

impl Figures {
    pub fn read(name: &str) -> Result<Self> {
        let path = Path::new(RESULTS).join(format!("{name}.json"));
        let all = serde_json::from_str(&text(&path)?)
            .map_err(|e| wrong(&path, &e.to_string(), "JSON, as tools/bench writes it"))?;
        Ok(Self { path, all })
    }

    fn missing(&self, key: &str) -> String {
        wrong(&self.path, &format!("no {key}"), "one, as tools/bench writes it")
    }

    pub fn number(&self, of: &Value, key: &str) -> Result<f64> {
        of[key].as_f64().ok_or_else(|| self.missing(key))
    }

    /// Of as many keys, with spaces between.
    pub fn numbers<const N: usize>(&self, of: &Value, keys: &str) -> Result<[f64; N]> {
        let all = keys.split(' ').map(|key| self.number(of, key)).collect::<Result<Vec<_>>>()?;
        Ok(all.try_into().expect("as many names as keys"))
    }

    /// A text whose places `{KEY}` are numbers, `{KEY:2}` with two decimals, `{KEY%2}` times 100; and the
    /// caption.
    pub fn fill(&self, of: &Value, text: &str) -> Result<String> {
        let filled = fill(text, |place| {
            let at = place.find([':', '%']).unwrap_or(place.len());
            let (value, form) = (self.number(of, &place[..at])?, &place[at..]);
            let decimals = |text: &str| text.parse::<usize>().map_err(|e| format!("{place}: {e}"));
            Ok(match form.split_at(form.len().min(1)) {
                (":", digits) => format!("{value:.*}", decimals(digits)?),
                ("%", digits) => format!("{:.*}", decimals(digits)?, 100.0 * value),
                _ => value.to_string(),
            })
        })?;
        Ok(filled + &self.caption()?)
    }

    /// A text in today's words.
    pub fn now(&self, text: &str) -> String {
        in_todays_words(&self.path, text.to_owned()).unwrap_or_default()
    }

    pub fn word<'a>(&self, of: &'a Value, key: &str) -> Result<&'a str> {
        of[key].as_str().ok_or_else(|| self.missing(key))
    }

    pub fn rows(&self) -> &[Value] {
        self.all["rows"].as_array().map_or(&[], Vec::as_slice)
    }

    /// Device and driver, and when, where and at which commit it was measured.
    pub fn caption(&self) -> Result<String> {
        let [device, driver] = ["device", "driver"].map(|key| self.word(&self.all, key));
        Ok(format!("*{}, {}{}*\n", device?, driver?, made(&self.path.with_extension("txt"))?))
    }
}

/// The line with which tools/bench begins a text: date, cores, load, commit.
pub fn made(path: &Path) -> Result<String> {
    let text = text(path)?;
    let first = text.lines().next().unwrap_or_default();
    let is_dated = first.starts_with(|c: char| c.is_ascii_digit()) && first.contains("load");
    Ok(if is_dated { format!("; {first}") } else { String::new() })
}

/// A text with each `{PLACE}` replaced.
pub fn fill(text: &str, value: impl Fn(&str) -> Result<String>) -> Result<String> {
    let mut pieces = text.split('{');
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (place, rest) = piece.split_once('}').unwrap_or((piece, ""));
        out += &value(place)?;
        out += rest;
    }
    Ok(out)
}

/// Replaces the words that have changed since a result was made, which `benches/results/words.tsv` lists: file,
/// old words, today's.
fn in_todays_words(path: &Path, mut text: String) -> Result<String> {
    let list = Path::new(RESULTS).join("words.tsv");
    for line in self::text(&list)?.lines() {
        let parts: Vec<&str> = line.split('\t').collect();
        let [name, old, new] = parts[..] else { return Err(wrong(&list, line, "three columns")) };
        if path.ends_with(name) {
            text = text.replace(old, new);
        }
    }
    Ok(text)
}

/// A text of the results in today's words, without its first line; and that line.
pub fn result(name: &str) -> Result<(String, String)> {
    let path = Path::new(RESULTS).join(name);
    let whole = text(&path)?;
    let body = whole.split_once('\n').unwrap_or_default().1;
    Ok((in_todays_words(&path, body.to_owned())?, made(&path)?))
}
