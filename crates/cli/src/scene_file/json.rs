//! JSON values with their line and key.

use std::ffi::OsString;
use std::fmt;
use std::path::Path;

use ridgelight::{Error, Result};
use serde::de::{Deserializer as _, MapAccess, Visitor};
use serde_json::value::RawValue;

use super::keys::{Key, Kind, Numbers, Or, Part};

/// A value, or a member with its value.
pub struct Found<'t> {
    path: &'t Path,
    text: &'t str,
    raw: &'t RawValue,
    /// Its keys from the root: `lights.suns[0]`.
    pub key: String,
}

struct Members;

impl<'de> Visitor<'de> for Members {
    type Value = Vec<(String, &'de RawValue)>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(
        self,
        mut map: A,
    ) -> std::result::Result<Self::Value, A::Error> {
        let mut all = Vec::new();
        while let Some(member) = map.next_entry()? {
            all.push(member);
        }
        Ok(all)
    }
}

impl<'t> Found<'t> {
    /// The root of a text.
    ///
    /// # Errors
    /// Line and column where the text is not JSON.
    pub fn root(path: &'t Path, text: &'t str) -> Result<Self> {
        let raw = serde_json::from_str(text).map_err(|error| {
            let place = format!("line {}, column {}", error.line(), error.column());
            let error = error.to_string();
            let reason = error.split(" at line").next().unwrap_or_default();
            Error::file(path, place, format!("invalid JSON ({reason})"), "valid JSON")
        })?;
        Ok(Self { path, text, raw, key: String::new() })
    }

    /// Line number, from 1.
    pub fn line(&self) -> usize {
        let before = self.raw.get().as_ptr() as usize - self.text.as_ptr() as usize;
        1 + self.text[..before].matches('\n').count()
    }

    /// The last of its keys.
    pub fn name(&self) -> &str {
        self.key.rsplit('.').next().unwrap_or_default()
    }

    fn error(&self, found: &str, expected: &str) -> Error {
        let key = if self.key.is_empty() { "the whole" } else { &self.key };
        Error::file(self.path, format!("line {}, {key}", self.line()), found, expected)
    }

    fn wrong(&self, expected: &str) -> Error {
        let found: String = self.raw.get().chars().take(40).collect();
        self.error(&found, expected)
    }

    /// An error: the key is unknown.
    pub fn unknown(&self, known: &str) -> Error {
        self.error("an unknown key", known)
    }

    /// Members of an object, in order.
    ///
    /// # Errors
    /// Not an object, or a key twice.
    pub fn members(&self) -> Result<Vec<Self>> {
        let mut text = serde_json::Deserializer::from_str(self.raw.get());
        let all = text.deserialize_map(Members).map_err(|_| self.wrong("an object"))?;
        let dot = if self.key.is_empty() { "" } else { "." };
        let all: Vec<Self> = all
            .into_iter()
            .map(|(key, raw)| Self { raw, key: format!("{}{dot}{key}", self.key), ..*self })
            .collect();
        match (1..all.len()).find(|i| all[..*i].iter().any(|other| other.key == all[*i].key)) {
            Some(again) => Err(all[again].error("the same key again", "it once")),
            None => Ok(all),
        }
    }

    /// Values of a list.
    ///
    /// # Errors
    /// Not a list.
    pub fn items(&self) -> Result<Vec<Self>> {
        let all: Vec<&'t RawValue> =
            serde_json::from_str(self.raw.get()).map_err(|_| self.wrong("a list"))?;
        let item = |(i, raw)| Self { raw, key: format!("{}[{i}]", self.key), ..*self };
        Ok(all.into_iter().enumerate().map(item).collect())
    }

    fn number(&self) -> Option<String> {
        let number: serde_json::Number = serde_json::from_str(self.raw.get()).ok()?;
        Some(number.to_string())
    }

    fn string(&self) -> Option<String> {
        serde_json::from_str(self.raw.get()).ok()
    }

    /// Numbers, comma-separated.
    fn numbers(&self, numbers: Numbers) -> Result<String> {
        let (counts, expected): (&[usize], _) = match numbers {
            Numbers::One => (&[], "a number"),
            Numbers::Pair => (&[2], "a number, or 2 in a list"),
            Numbers::Colour => (&[3], "a number, or 3 in a list"),
            Numbers::Three => (&[3], "3 numbers in a list"),
            Numbers::Four => (&[4], "4 numbers in a list"),
            Numbers::TwoOrThree => (&[2, 3], "2 or 3 numbers in a list"),
        };
        let is_list = matches!(numbers, Numbers::Three | Numbers::Four | Numbers::TwoOrThree);
        if let Some(number) = self.number().filter(|_| !is_list) {
            return Ok(number);
        }
        let items = self.items().ok().filter(|all| counts.contains(&all.len()));
        let all = items.and_then(|all| all.iter().map(Self::number).collect::<Option<Vec<_>>>());
        all.map(|all| all.join(",")).ok_or_else(|| self.wrong(expected))
    }

    /// The comma-separated values of a flag.
    ///
    /// # Errors
    /// A member that is missing, unknown or not a number.
    pub fn parts(&self, parts: &[Part]) -> Result<String> {
        let members = self.members()?;
        let is_part = |found: &&Self| !parts.iter().any(|part| part.name == found.name());
        if let Some(found) = members.iter().find(is_part) {
            let known: Vec<&str> = parts.iter().map(|part| part.name).collect();
            return Err(found.unknown(&known.join(", ")));
        }
        let value = |part: &Part| match members.iter().find(|found| found.name() == part.name) {
            Some(found) => found.numbers(part.numbers),
            None => {
                let missing = || self.error(&format!("no {}", part.name), "it");
                part.default.map(str::to_owned).ok_or_else(missing)
            }
        };
        let mut all = parts.iter().map(value).collect::<Result<Vec<_>>>()?;
        all.retain(|text| !text.is_empty());
        Ok(all.join(","))
    }

    /// As the text of a flag; paths relative to `folder`.
    ///
    /// # Errors
    /// A value of another kind.
    pub fn value(&self, key: &Key, folder: &Path) -> Result<OsString> {
        let file = || self.string().map(|name| folder.join(name).into_os_string());
        let text = match key.or {
            Or::Nothing => None,
            Or::File => file(),
            Or::Word(word) => self.string().filter(|text| text == word).map(OsString::from),
        };
        if let Some(text) = text {
            return Ok(text);
        }
        match key.kind {
            Kind::Numbers(numbers) => match self.numbers(numbers) {
                Ok(text) => Ok(text.into()),
                Err(error) => Err(match key.or {
                    Or::Nothing => error,
                    Or::File => self.wrong("a number, 3 in a list, or a file's name"),
                    Or::Word(word) => {
                        self.wrong(&format!("a number, 3 in a list, or the word {word}"))
                    }
                }),
            },
            Kind::Word => self
                .string()
                .or_else(|| self.number())
                .map(OsString::from)
                .ok_or_else(|| self.wrong("a word or a number")),
            Kind::File => file().ok_or_else(|| self.wrong("a file's name")),
            Kind::Files => file().ok_or_else(|| self.wrong("a file's name, or several in a list")),
            Kind::Parts(parts) | Kind::List(parts) => Ok(self.parts(parts)?.into()),
            Kind::Switch => match serde_json::from_str(self.raw.get()) {
                Ok(is_on) => Ok(if is_on { "true" } else { "false" }.into()),
                Err(_) => Err(self.wrong("true or false")),
            },
        }
    }
}
