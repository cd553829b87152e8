//! Settings by keys and by the panel: the command line's settings, values and errors.

use ridgelight::scene::{Quality, SETTINGS, Setting, Values, setting};

use crate::scene_file::Request;
use crate::setup;

/// The setting that keys change; the panel chooses what it changes.
pub struct Settings {
    chosen: usize,
    /// Values of the settings that the user does not give.
    default: Quality,
}

impl Settings {
    pub fn new(default: Quality) -> Self {
        let chosen = SETTINGS.iter().position(|setting| setting.name == "azimuths").unwrap_or(0);
        Self { chosen, default }
    }

    /// Moves to another.
    pub fn choose(&mut self, ahead: bool) {
        let step = if ahead { 1 } else { SETTINGS.len() - 1 };
        self.chosen = (self.chosen + step) % SETTINGS.len();
    }

    /// The chosen one's name.
    pub fn chosen(&self) -> &'static str {
        SETTINGS[self.chosen].name
    }

    /// All with their values, and whether each is the chosen one.
    pub fn list(&self, asked: &Request) -> impl Iterator<Item = (&'static Setting, String, bool)> {
        let all = SETTINGS.iter().enumerate();
        all.map(move |(n, setting)| (setting, self.word(setting, asked), n == self.chosen))
    }

    /// Gives a setting its next or previous value.
    ///
    /// # Errors
    /// The command line's error.
    pub fn turn(&self, name: &str, ahead: bool, asked: &mut Request) -> Result<Quality, String> {
        let setting = setting(name).ok_or_else(|| format!("no setting {name}"))?;
        self.valued(name, next(setting, &self.word(setting, asked), ahead), asked)
    }

    /// Gives a setting a value, and chooses it.
    ///
    /// # Errors
    /// The command line's error.
    pub fn set(
        &mut self,
        name: &str,
        value: String,
        asked: &mut Request,
    ) -> Result<Quality, String> {
        let at = SETTINGS.iter().position(|setting| setting.name == name);
        self.chosen = at.ok_or_else(|| format!("no setting {name}"))?;
        self.valued(name, value, asked)
    }

    fn valued(&self, name: &str, value: String, asked: &mut Request) -> Result<Quality, String> {
        let mut wanted = asked.clone();
        wanted.set(name, vec![value]);
        let mut quality = Quality::default();
        for setting in SETTINGS {
            let set = setting.set(&mut quality, &self.word(setting, &wanted));
            set.map_err(|error| setup::in_flags(error).to_string())?;
        }
        *asked = wanted;
        Ok(quality)
    }

    /// A setting's value: the user's, or the default.
    fn word(&self, setting: &Setting, asked: &Request) -> String {
        asked.first(setting.name).map_or_else(|| setting.get(&self.default), str::to_owned)
    }

    /// Adds the defaults that depend on the scene.
    pub fn write_default(&self, asked: &mut Request) {
        let count = self.default.azimuths;
        if count != Quality::default().azimuths && asked.first("azimuths").is_none() {
            asked.set("azimuths", vec![count.to_string()]);
        }
    }
}

/// The value after, or before. Long ranges go in factors of two.
fn next(setting: &Setting, word: &str, ahead: bool) -> String {
    let cycled = |all: Vec<String>| {
        let at = all.iter().position(|w| w == word).unwrap_or(0);
        all[(at + if ahead { 1 } else { all.len() - 1 }) % all.len()].clone()
    };
    match &setting.values {
        Values::Words(words) => cycled(words.iter().map(|w| w.name.to_owned()).collect()),
        Values::OneOf(all) => cycled(all.iter().map(u32::to_string).collect()),
        Values::Share => {
            let share = word.parse().unwrap_or(0.0);
            (if ahead { share * 2.0 } else { share / 2.0 }).to_string()
        }
        Values::Whole(range) => {
            let n = word.parse::<u32>().unwrap_or(0);
            let next = match (*range.end() >= 256, ahead) {
                (true, true) => n.saturating_mul(2),
                (true, false) => n / 2,
                (false, true) => n.saturating_add(1),
                (false, false) => n.saturating_sub(1),
            };
            next.to_string()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::flag;

    /// Every setting of the command line can be changed either way from its default, or is refused
    /// with its flag's name.
    #[test]
    fn every_setting_changes() {
        let settings = Settings::new(Quality::default());
        for setting in SETTINGS {
            for ahead in [true, false] {
                let mut asked = Request::default();
                match settings.turn(setting.name, ahead, &mut asked) {
                    Ok(_) => assert!(asked.first(setting.name).is_some()),
                    Err(why) => {
                        assert!(why.contains(&flag(setting.name)), "{}: {why}", setting.name);
                    }
                }
            }
        }
    }

    /// Azimuths chosen for the scene stay when another setting changes, and are written into the command line.
    #[test]
    fn the_scenes_azimuths_stay() {
        let settings = Settings::new(Quality { azimuths: 128, ..Quality::default() });
        let mut asked = Request::default();
        assert_eq!(settings.turn("lines", true, &mut asked).map(|q| q.azimuths), Ok(128));
        let mut written = asked.clone();
        settings.write_default(&mut written);
        assert_eq!(written.first("azimuths"), Some("128"));
        assert_eq!(settings.turn("azimuths", true, &mut asked).map(|q| q.azimuths), Ok(256));
        settings.write_default(&mut asked);
        assert_eq!(asked.first("azimuths"), Some("256"));
    }

    #[test]
    fn words_go_round_numbers_go_to_their_ends() {
        let (settings, mut asked) = (Settings::new(Quality::default()), Request::default());
        let mut visited = Vec::new();
        for _ in 0..4 {
            assert!(settings.turn("method", true, &mut asked).is_ok());
            visited.extend(asked.first("method").map(str::to_owned));
        }
        assert_eq!(visited, ["sweep", "pyramid", "brute-force", "auto"]);
        for _ in 0..5 {
            assert!(settings.turn("azimuths", true, &mut asked).is_ok());
        }
        let Err(why) = settings.turn("azimuths", true, &mut asked) else { panic!("2048 azimuths") };
        assert_eq!(why, "--azimuths: found 2048, expected a whole number from 4 to 1024");
        assert_eq!(asked.first("azimuths"), Some("1024"));
    }
}
