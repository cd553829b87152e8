//! The words after a program's name.

use std::path::PathBuf;
use std::str::FromStr;

use ridgelight::{Error, Result};

pub struct Args(pub Vec<String>);

impl Args {
    /// Whether a flag is there; takes it.
    pub fn has(&mut self, flag: &str) -> bool {
        let at = self.0.iter().position(|word| word == flag);
        at.map(|at| self.0.remove(at)).is_some()
    }

    /// The word after a flag; takes both.
    pub fn text(&mut self, flag: &str) -> Result<Option<String>> {
        let Some(at) = self.0.iter().position(|word| word == flag) else { return Ok(None) };
        if at + 1 == self.0.len() {
            return Err(Error::setting(flag, "nothing", "a value"));
        }
        self.0.remove(at);
        Ok(Some(self.0.remove(at)))
    }

    pub fn path(&mut self, flag: &str) -> Result<Option<PathBuf>> {
        Ok(self.text(flag)?.map(PathBuf::from))
    }

    /// The same of a flag that must be there.
    pub fn needed(&mut self, flag: &str) -> Result<PathBuf> {
        self.path(flag)?.ok_or_else(|| Error::setting(flag, "nothing", "a path"))
    }

    pub fn number<T: FromStr>(&mut self, flag: &str, default: T) -> Result<T> {
        let Some(text) = self.text(flag)? else { return Ok(default) };
        text.parse().map_err(|_| Error::setting(flag, text, "a number"))
    }

    /// Numbers with commas between them.
    pub fn numbers<const N: usize>(&mut self, flag: &str) -> Result<Option<[f64; N]>> {
        let Some(text) = self.text(flag)? else { return Ok(None) };
        let all: Vec<f64> = text.split(',').filter_map(|part| part.parse().ok()).collect();
        let wrong = |_| Error::setting(flag, text, format!("{N} numbers with commas between"));
        all.try_into().map(Some).map_err(wrong)
    }

    /// The next word that stands alone; ask for flags first.
    pub fn word(&mut self) -> Option<String> {
        (!self.0.is_empty()).then(|| self.0.remove(0))
    }

    /// Fails where a word is left over.
    pub fn end(self) -> Result<()> {
        match self.0.as_slice() {
            [] => Ok(()),
            left => Err(Error::setting("arguments", left.join(" "), "none beyond the usage")),
        }
    }
}
