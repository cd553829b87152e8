//! Scene files: field, surface, lights, camera and quality as JSON. Each key stands for a flag of the command line, and
//! takes effect where the user did not write that flag. Errors give line and key.

mod json;
mod keys;
#[cfg(test)]
mod schema;
#[cfg_attr(not(feature = "window"), expect(dead_code, reason = "windows save scenes"))]
mod write;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::error::{ContextKind, ContextValue};
use clap::parser::ValueSource;
use ridgelight::{Error, Result};

use crate::args::{Renamed, flag};
use json::Found;
use keys::Kind;
pub use keys::{Numbers, Part, or, part};
pub use write::Request;

/// A flag from a scene file.
struct Given {
    /// The id of its argument.
    id: &'static str,
    value: OsString,
    /// Whether it takes no value.
    is_switch: bool,
    line: usize,
    key: String,
}

/// The flags of a scene file; empty without one.
#[derive(Default)]
pub struct SceneFile {
    path: PathBuf,
    given: Vec<Given>,
}

/// Largest scene file, bytes.
const LARGEST: u64 = 1 << 24;

impl SceneFile {
    /// Reads the file of `--scene`, if any, and adds its flags to the words.
    ///
    /// # Errors
    /// File, line and key of a mistake.
    pub fn add_to(
        parser: &clap::Command,
        words: &mut Vec<OsString>,
        renamed: &mut Renamed,
    ) -> Result<Self> {
        let partial = parser.clone().ignore_errors(true);
        let Ok(matches) = partial.try_get_matches_from(words.iter()) else {
            return Ok(Self::default());
        };
        let Some((name, matches)) = matches.subcommand() else { return Ok(Self::default()) };
        let path = matches.try_get_one::<PathBuf>("scene").ok().flatten();
        let (Some(path), Some(command)) = (path, parser.find_subcommand(name)) else {
            return Ok(Self::default());
        };
        let mut scene = Self { path: path.clone(), given: all(path, renamed)? };
        let input = command.get_positionals().next().map(|arg| arg.get_id().as_str());
        scene.given.retain(|given| {
            if given.is_switch && given.value == "false" {
                return false;
            }
            let id = if given.id == keys::INPUT { input } else { Some(given.id) };
            let known = id.filter(|id| command.get_arguments().any(|arg| arg.get_id() == id));
            known.is_some_and(|id| matches.value_source(id) != Some(ValueSource::CommandLine))
        });
        let at = words.iter().position(|word| word == name).map_or(words.len(), |i| i + 1);
        let new = scene.given.iter().map(|given| match given.id {
            keys::INPUT => given.value.clone(),
            id => {
                let mut word = OsString::from(format!("--{}", id.replace('_', "-")));
                if !given.is_switch {
                    word.push("=");
                    word.push(&given.value);
                }
                word
            }
        });
        let new: Vec<OsString> = new.collect();
        words.splice(at..at, new);
        Ok(scene)
    }

    /// Whether the file gave the argument of this id.
    pub fn gave(&self, id: &str) -> bool {
        self.given.iter().any(|given| given.id == id)
    }

    /// The parser's error on a flag of the file, by line and key.
    pub fn explain(&self, error: &clap::Error) -> Option<Error> {
        let text = |kind| match error.get(kind)? {
            ContextValue::String(text) => Some(text.clone()),
            ContextValue::Strings(all) => Some(all.join(", ")),
            _ => None,
        };
        let flag = text(ContextKind::InvalidArg)?;
        let id = flag.trim_start_matches("--").split([' ', '=']).next()?.replace('-', "_");
        let value = text(ContextKind::InvalidValue);
        let of_flag = || self.given.iter().filter(|given| given.id == id);
        let is_it = |given: &&Given| value.as_ref().is_some_and(|v| given.value == v.as_str());
        let given = of_flag().find(is_it).or_else(|| of_flag().next())?;
        let expected = text(ContextKind::ValidValue)
            .map(|all| format!("one of {all}"))
            .or_else(|| Some(std::error::Error::source(error)?.to_string()))
            .or_else(|| Some(format!("none beside {}", text(ContextKind::PriorArg)?)));
        Some(self.wrong(given, "", value.unwrap_or_default(), expected?))
    }

    /// A command's error on a flag of the file, by line and key.
    pub fn place(&self, error: Error) -> Error {
        let Error::Setting { name, found, expected } = error else { return error };
        let Some((given, rest)) = self.named(&name) else {
            return Error::Setting { name, found, expected };
        };
        self.wrong(given, rest, found, expected)
    }

    /// The argument that `--flag`, `--flag 2` or `--flag 2 elevation` names, and the rest.
    fn named<'n>(&self, name: &'n str) -> Option<(&Given, &'n str)> {
        let (flag, rest) = name.strip_prefix("--")?.split_once(' ').unwrap_or((&name[2..], ""));
        let (number, after) = rest.split_once([' ', ':']).unwrap_or((rest, ""));
        let id = flag.replace('-', "_");
        let mut of_flag = self.given.iter().filter(|given| given.id == id);
        match number.parse::<usize>() {
            Ok(number) => Some((of_flag.nth(number.checked_sub(1)?)?, after)),
            Err(_) => Some((of_flag.next()?, rest)),
        }
    }

    fn wrong(&self, given: &Given, rest: &str, found: String, expected: String) -> Error {
        let place = format!("line {}, {} {rest}", given.line, given.key);
        Error::file(&self.path, place.trim_end(), found, expected)
    }
}

/// All flags of a file, also those that the command does not have.
fn all(path: &Path, renamed: &mut Renamed) -> Result<Vec<Given>> {
    let text = read(path)?;
    let root = Found::root(path, &text)?;
    let folder = crate::setup::folder_of(path);
    let (mut given, groups) = (Vec::new(), keys::groups());
    for group in root.members()? {
        if group.key == "$schema" {
            continue;
        }
        let Some((_, keys)) = groups.iter().find(|(name, _)| *name == group.key) else {
            let known: Vec<&str> = groups.iter().map(|(name, _)| *name).collect();
            return Err(group.unknown(&format!("{} or $schema", known.join(", "))));
        };
        for found in group.members()? {
            // Keys of quality are renamed as their flags are.
            let old = match group.key.as_str() {
                "quality" => flag(found.name()),
                _ => found.key.clone(),
            };
            let name = match renamed.new_name(&old) {
                Some(new) => {
                    let key = new.rsplit('.').next().expect("group.key");
                    key.trim_start_matches('-').replace('-', "_")
                }
                None => found.name().to_owned(),
            };
            let Some(key) = keys.iter().find(|key| key.name == name) else {
                let known: Vec<&str> = keys.iter().map(|key| key.name).collect();
                return Err(found.unknown(&known.join(", ")));
            };
            let items = match key.kind {
                Kind::List(_) => Some(found.items()?),
                Kind::Files => found.items().ok().filter(|items| !items.is_empty()),
                _ => None,
            };
            for found in items.unwrap_or_else(|| vec![found]) {
                given.push(Given {
                    id: key.id,
                    is_switch: matches!(key.kind, Kind::Switch),
                    value: found.value(key, folder)?,
                    line: found.line(),
                    key: found.key,
                });
            }
        }
    }
    Ok(given)
}

fn read(path: &Path) -> Result<String> {
    let io = |source| Error::io(path, source);
    let bytes = std::fs::metadata(path).map_err(io)?.len();
    if bytes > LARGEST {
        return Err(Error::Limit {
            what: path.display().to_string(),
            needs: format!("{bytes} bytes"),
            limit: format!("{LARGEST} for a scene file"),
        });
    }
    std::fs::read_to_string(path).map_err(io)
}
