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

/// A JSON file of the results, with readers that name what is missing.
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

    pub fn number(&self, of: &Value, key: &str) -> Result<f64> {
        let missing =
            || wrong(&self.path, &format!("no number {key}"), "one, as tools/bench writes it");
        of[key].as_f64().ok_or_else(missing)
    }

    pub fn word<'a>(&self, of: &'a Value, key: &str) -> Result<&'a str> {
        let missing =
            || wrong(&self.path, &format!("no text {key}"), "one, as tools/bench writes it");
        of[key].as_str().ok_or_else(missing)
    }

    pub fn rows(&self) -> &[Value] {
        self.all["rows"].as_array().map_or(&[], Vec::as_slice)
    }

    /// Device and driver, and when, where and at which commit it was measured.
    pub fn caption(&self) -> Result<String> {
        let device =
            format!("{}, {}", self.word(&self.all, "device")?, self.word(&self.all, "driver")?);
        let made = made(&self.path.with_extension("txt"))?;
        Ok(format!("*{device}{made}*"))
    }
}

/// The line with which tools/bench begins a text: date, cores, load, commit.
pub fn made(path: &Path) -> Result<String> {
    let text = text(path)?;
    let first = text.lines().next().unwrap_or_default();
    let is_dated = first.starts_with(|c: char| c.is_ascii_digit()) && first.contains("load");
    Ok(if is_dated { format!("; {first}") } else { String::new() })
}

/// What is not known is not 0.
pub fn percent(value: Option<f64>) -> String {
    value.map_or_else(|| "error not measured".to_owned(), |v| format!("{:.2} %", 100.0 * v))
}
