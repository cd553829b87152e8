//! The words after a program's name.

use std::path::PathBuf;
use std::str::FromStr;

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::{Error, Result};

pub struct Args(pub Vec<String>);

impl Args {
    /// Whether a flag is there; takes it.
    pub fn has(&mut self, flag: &str) -> bool {
        let at = self.0.iter().position(|word| word == flag);
        at.map(|at| self.0.remove(at)).is_some()
    }

    /// The value of a flag; takes both.
    pub fn value<T: FromStr>(&mut self, flag: &str) -> Result<Option<T>> {
        let Some(at) = self.0.iter().position(|word| word == flag) else { return Ok(None) };
        self.0.remove(at);
        let text = if at < self.0.len() { self.0.remove(at) } else { String::new() };
        let wrong = |_| Error::setting(flag, format!("{text:?}"), "a value");
        text.parse().map(Some).map_err(wrong)
    }

    /// The path of a flag.
    pub fn path(&mut self, flag: &str) -> Result<Option<PathBuf>> {
        self.value(flag)
    }

    /// The path of a required flag.
    pub fn needed(&mut self, flag: &str) -> Result<PathBuf> {
        self.path(flag)?.ok_or_else(|| Error::setting(flag, "nothing", "a path"))
    }

    pub fn number<T: FromStr>(&mut self, flag: &str, default: T) -> Result<T> {
        Ok(self.value(flag)?.unwrap_or(default))
    }

    /// The next word without a flag; take flags first.
    pub fn word(&mut self) -> Option<String> {
        (!self.0.is_empty()).then(|| self.0.remove(0))
    }

    /// The next word as a path.
    pub fn folder(&mut self) -> Option<PathBuf> {
        self.word().map(PathBuf::from)
    }

    /// Fails where a word is left over.
    pub fn end(self) -> Result<()> {
        match self.0.as_slice() {
            [] => Ok(()),
            left => Err(Error::setting("arguments", left.join(" "), "none beyond the usage")),
        }
    }

    /// Fails where a word is left over; opens the device that the environment offers first.
    pub fn open(self) -> Result<Headless> {
        self.end()?;
        Headless::new(&HeadlessOptions::default())
    }
}
