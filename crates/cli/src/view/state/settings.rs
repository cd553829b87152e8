//! Settings by keys: the command line's settings, values and errors.

use clap::{Args as _, FromArgMatches as _};
use ridgelight::Result;
use ridgelight::scene::Quality;

use crate::args::{QualityArgs, SETTINGS};
use crate::scene_file::Request;
use crate::setup;

/// A setting and its values.
struct Setting {
    /// The parser's id.
    id: String,
    default: String,
    values: Values,
}

enum Values {
    Words(Vec<String>),
    /// Each twice the one before.
    Doubled,
    /// Each one more.
    Counted,
}

/// Numbers in factors of two.
const DOUBLED: [&str; 7] = [
    "azimuths",
    "sun_azimuths",
    "table_elevations",
    "wedge_side",
    "bounce_azimuths",
    "light_cutoff",
    "bounce_cutoff",
];

/// All settings, and the one that keys change.
pub struct Settings {
    all: Vec<Setting>,
    chosen: usize,
}

/// A refused setting.
pub struct Refused(pub String);

impl Settings {
    pub fn new() -> Self {
        let parser = QualityArgs::augment_args(clap::Command::new("settings"));
        let setting = |id: &str| {
            let arg = parser.get_arguments().find(|arg| arg.get_id() == id)?;
            let words: Vec<String> =
                arg.get_possible_values().iter().map(|v| v.get_name().to_owned()).collect();
            let values = match words.is_empty() {
                false => Values::Words(words),
                true if DOUBLED.contains(&id) => Values::Doubled,
                true => Values::Counted,
            };
            let default = arg.get_default_values().first()?.to_string_lossy().into_owned();
            Some(Setting { id: id.to_owned(), default, values })
        };
        let all: Vec<Setting> =
            ["method"].iter().chain(&SETTINGS).filter_map(|s| setting(s)).collect();
        let chosen = all.iter().position(|s| s.id == "azimuths").unwrap_or(0);
        Self { all, chosen }
    }

    /// Moves to another.
    pub fn choose(&mut self, ahead: bool) {
        let count = self.all.len();
        self.chosen = (self.chosen + if ahead { 1 } else { count - 1 }) % count;
    }

    /// The chosen one's name.
    pub fn chosen(&self) -> &str {
        &self.all[self.chosen].id
    }

    /// Names and values, and whether each is the chosen one.
    pub fn list<'a>(
        &'a self,
        asked: &'a Request,
    ) -> impl Iterator<Item = (&'a str, &'a str, bool)> {
        let all = self.all.iter().enumerate();
        all.map(move |(n, s)| (s.id.as_str(), s.word(asked), n == self.chosen))
    }

    /// Gives a setting its next or previous value.
    ///
    /// # Errors
    /// The command line's error.
    pub fn turn(
        &self,
        id: &str,
        ahead: bool,
        asked: &mut Request,
    ) -> std::result::Result<Quality, Refused> {
        let setting = self.all.iter().find(|s| s.id == id);
        let setting = setting.ok_or_else(|| Refused(format!("no setting {id}")))?;
        let word = setting.next(asked, ahead);
        let mut wanted = asked.clone();
        wanted.set(id, vec![word]);
        let quality = self.quality(&wanted)?;
        *asked = wanted;
        Ok(quality)
    }

    /// Parses the values like the command line.
    fn quality(&self, asked: &Request) -> std::result::Result<Quality, Refused> {
        let flag = |s: &Setting| format!("--{}={}", s.id.replace('_', "-"), s.word(asked));
        let words = std::iter::once("settings".to_owned()).chain(self.all.iter().map(flag));
        let parser = QualityArgs::augment_args(clap::Command::new("settings"));
        let parsed = parser.try_get_matches_from(words);
        let args = parsed.and_then(|matches| QualityArgs::from_arg_matches(&matches));
        let args = args.map_err(|error| {
            let text = error.to_string();
            let line = text.lines().next().unwrap_or_default();
            Refused(line.trim_start_matches("error: ").to_owned())
        })?;
        said(setup::quality(&args))
    }
}

/// The command line's spelling.
pub fn said<T>(result: Result<T>) -> std::result::Result<T, Refused> {
    result.map_err(|error| Refused(setup::in_flags(error).to_string()))
}

impl Setting {
    fn word<'a>(&'a self, asked: &'a Request) -> &'a str {
        asked.first(&self.id).unwrap_or(&self.default)
    }

    fn next(&self, asked: &Request, ahead: bool) -> String {
        let word = self.word(asked);
        match &self.values {
            Values::Words(words) => {
                let at = words.iter().position(|w| w == word).unwrap_or(0);
                let next = at + if ahead { 1 } else { words.len() - 1 };
                words[next % words.len()].clone()
            }
            Values::Doubled => match (word.parse::<u32>(), word.parse::<f64>()) {
                (Ok(n), _) => (if ahead { n.saturating_mul(2) } else { n / 2 }).to_string(),
                (_, Ok(v)) => (if ahead { v * 2.0 } else { v / 2.0 }).to_string(),
                _ => word.to_owned(),
            },
            Values::Counted => {
                let n = word.parse::<u32>().unwrap_or(0);
                (if ahead { n.saturating_add(1) } else { n.saturating_sub(1) }).to_string()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every setting of the command line can be changed either way from its default, or is refused
    /// with its flag's name.
    #[test]
    fn every_setting_changes() {
        let settings = Settings::new();
        assert_eq!(settings.all.len(), SETTINGS.len() + 1);
        for setting in &settings.all {
            for ahead in [true, false] {
                let mut asked = Request::default();
                match settings.turn(&setting.id, ahead, &mut asked) {
                    Ok(_) => assert!(asked.first(&setting.id).is_some()),
                    Err(Refused(why)) => {
                        let flag = format!("--{}", setting.id.replace('_', "-"));
                        assert!(why.contains(&flag), "{}: {why}", setting.id);
                    }
                }
            }
        }
    }

    #[test]
    fn words_go_round_numbers_go_to_their_ends() {
        let (settings, mut asked) = (Settings::new(), Request::default());
        let mut seen = Vec::new();
        for _ in 0..4 {
            assert!(settings.turn("method", true, &mut asked).is_ok());
            seen.extend(asked.first("method").map(str::to_owned));
        }
        assert_eq!(seen, ["sweep", "pyramid", "brute-force", "auto"]);
        for _ in 0..4 {
            assert!(settings.turn("azimuths", true, &mut asked).is_ok());
        }
        let Err(Refused(why)) = settings.turn("azimuths", true, &mut asked) else {
            panic!("2048 azimuths")
        };
        assert_eq!(why, "--azimuths: found 2048, expected a whole number from 4 to 1024");
        assert_eq!(asked.first("azimuths"), Some("1024"));
    }
}
