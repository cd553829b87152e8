//! Writes flags as a scene file.

use clap::ArgMatches;
use clap::parser::ValueSource;
use serde_json::{Map, Value};

use crate::args::flag;

use super::keys::{INPUT, Key, Kind, Numbers, Or, Part, groups};

/// Flags of the command line and the scene file, by id, and the values of each.
#[derive(Clone, Debug, Default)]
pub struct Request(Vec<(String, Vec<String>)>);

impl Request {
    pub fn of(matches: &ArgMatches) -> Self {
        let given = matches.ids().map(clap::Id::as_str).filter_map(|id| {
            let is_given = matches.value_source(id) == Some(ValueSource::CommandLine);
            let words = matches.get_raw(id).filter(|_| is_given)?;
            Some((id.to_owned(), words.map(|w| w.to_string_lossy().into_owned()).collect()))
        });
        Self(given.collect())
    }

    /// Sets the values of a flag.
    pub fn set(&mut self, id: &str, words: Vec<String>) {
        self.clear(id);
        self.0.push((id.to_owned(), words));
    }

    /// First value of a flag, where it was given.
    pub fn first(&self, id: &str) -> Option<&str> {
        let (_, words) = self.0.iter().find(|(known, _)| known == id)?;
        words.first().map(String::as_str)
    }

    /// Removes a flag.
    pub fn clear(&mut self, id: &str) {
        self.0.retain(|(known, _)| known != id);
    }

    /// Words of a command line for the same: files first, then flags.
    pub fn words(&self) -> Vec<String> {
        let keys: Vec<Key> = groups().into_iter().flat_map(|(_, keys)| keys).collect();
        let (mut files, mut flags) = (Vec::new(), Vec::new());
        for (id, words) in &self.0 {
            if id == INPUT {
                files.clone_from(words);
                continue;
            }
            let Some(key) = keys.iter().find(|key| key.id == id) else { continue };
            let flag = flag(id);
            match key.kind {
                Kind::Switch => flags.push(flag),
                _ => flags.extend(words.iter().map(|word| format!("{flag}={word}"))),
            }
        }
        files.into_iter().chain(flags).collect()
    }

    /// The scene file. Paths stay as they are.
    pub fn to_json(&self) -> Value {
        let mut all = Map::new();
        for (name, keys) in groups() {
            let group: Map<_, _> = keys.iter().filter_map(|key| self.member(key)).collect();
            if !group.is_empty() {
                all.insert(name.to_owned(), group.into());
            }
        }
        all.into()
    }

    fn member(&self, key: &Key) -> Option<(String, Value)> {
        let id = if key.id == INPUT { "path" } else { key.id };
        let (_, words) = self.0.iter().find(|(known, _)| known == id)?;
        let first = words.first()?;
        let text = || (key.or != Or::Nothing).then(|| first.as_str().into());
        let value = match key.kind {
            Kind::Files if words.len() > 1 => words.clone().into(),
            Kind::Word | Kind::File | Kind::Files => first.as_str().into(),
            Kind::Numbers(count) => numbers(first, count).or_else(text)?,
            Kind::Switch => true.into(),
            Kind::Parts(parts) => object(first, parts).or_else(text)?,
            Kind::List(parts) => words.iter().map(|w| object(w, parts)).collect::<Option<_>>()?,
        };
        Some((key.name.to_owned(), value))
    }
}

fn parsed(text: &str) -> Option<Vec<Value>> {
    // Keeps the user's spelling where it is valid JSON.
    let kept = |t: &str| Some(Value::Number(serde_json::from_str(t).ok()?));
    let number = |t: &str| kept(t.trim()).or_else(|| Some(t.trim().parse::<f64>().ok()?.into()));
    text.split(',').map(number).collect()
}

fn numbers(text: &str, count: Numbers) -> Option<Value> {
    let all = parsed(text)?;
    match (all.as_slice(), count) {
        ([one], _) => Some(one.clone()),
        (_, Numbers::One) => None,
        _ => Some(all.into()),
    }
}

/// Colours come last and take the rest.
fn object(text: &str, parts: &[Part]) -> Option<Value> {
    let all = parsed(text)?;
    let mut left = all.as_slice();
    let mut members = Map::new();
    for part in parts {
        let count = match part.numbers {
            Numbers::One => 1,
            Numbers::Pair => 2,
            Numbers::Three => 3,
            Numbers::Four => 4,
            Numbers::TwoOrThree | Numbers::Colour => left.len(),
        };
        if left.is_empty() || count > left.len() {
            break;
        }
        let (own, after) = left.split_at(count);
        let value = if let [one] = own { one.clone() } else { own.to_vec().into() };
        members.insert(part.name.to_owned(), value);
        left = after;
    }
    Some(members.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each word stands with its flag, so that none is taken for another; flags that no scene file has are left out.
    #[test]
    fn requests_become_words_of_a_command_line() {
        let mut asked = Request::default();
        asked.set("sun", vec!["315,30".to_owned(), "90,-0".to_owned()]);
        asked.set("path", vec!["a.tif".to_owned(), "b.tif".to_owned()]);
        asked.set("sun_azimuths", vec!["16".to_owned()]);
        asked.set("script", vec!["keys".to_owned()]);
        let words = asked.words();
        assert_eq!(words, ["a.tif", "b.tif", "--sun=315,30", "--sun=90,-0", "--sun-azimuths=16"]);
    }
}
