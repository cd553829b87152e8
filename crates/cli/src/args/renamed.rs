//! Old names of flags, values, scene file keys and layers. Each is accepted with a warning for one release.

use std::ffi::OsString;
use std::io::Write as _;

/// Old and new: `--flag`, `--flag value`, or `group.key` of a scene file.
pub const RENAMED: [(&str, &str); 10] = [
    ("--phong", "--specular"),
    ("--light", "--sphere-light"),
    ("--samples", "--runs"),
    ("--method brute", "--method brute-force"),
    ("--bounce-engine brute", "--bounce-engine brute-force"),
    ("--hull list", "--hull occluder-list"),
    ("--receiver lobe", "--receiver cosine"),
    ("--bounce-gloss", "--bounce-specular"),
    ("surface.phong", "surface.specular"),
    ("lights.balls", "lights.sphere_lights"),
];

/// Old and new layer of the Nth sphere light.
const LAYER: (&str, &str) = ("direct.lightN", "direct.sphere_lightN");

/// Old names that were found.
#[derive(Default)]
pub struct Renamed(Vec<(&'static str, &'static str)>);

impl Renamed {
    /// The new name of an old one.
    pub fn new_name(&mut self, name: &str) -> Option<&'static str> {
        let pair = RENAMED.into_iter().find(|(old, _)| *old == name)?;
        self.found(pair);
        Some(pair.1)
    }

    /// The new name of an old channel of a picture, "direct.light1.R".
    pub fn new_channel(&mut self, name: &str) -> Option<String> {
        let [old, new] = [LAYER.0, LAYER.1].map(|layer| layer.trim_end_matches('N'));
        let rest = name.strip_prefix(old)?;
        rest.split('.').next()?.parse::<u32>().ok()?;
        self.found(LAYER);
        Some(format!("{new}{rest}"))
    }

    fn found(&mut self, pair: (&'static str, &'static str)) {
        if !self.0.contains(&pair) {
            self.0.push(pair);
        }
    }

    /// Replaces old flags and values in the words of a command line. A flag is old only where the command has the new
    /// one and not the old: `--samples` is MSAA to `render`, and was the number of runs to `bench`.
    pub fn replace(&mut self, parser: &clap::Command, words: &mut [OsString]) {
        let find = |word: &OsString| parser.find_subcommand(word);
        let Some((at, command)) =
            words.iter().enumerate().skip(1).find_map(|(i, word)| Some((i, find(word)?)))
        else {
            return;
        };
        let has = |flag: &str| {
            command.get_arguments().any(|arg| arg.get_long() == flag.strip_prefix("--"))
        };
        let end = words.iter().position(|word| word == "--").unwrap_or(words.len());
        // The flag whose value the next word is.
        let mut before = None;
        for word in &mut words[(at + 1).min(end)..end] {
            let Some(text) = word.to_str().map(str::to_owned) else {
                before = None;
                continue;
            };
            let value_of: Option<String> = before.take();
            if let Some(new) = value_of.and_then(|f| self.new_name(&format!("{f} {text}"))) {
                *word = new.split(' ').nth(1).expect("flag and value").into();
                continue;
            }
            if !text.starts_with("--") {
                continue;
            }
            let (flag, value) = text.split_once('=').map_or((&*text, None), |(f, v)| (f, Some(v)));
            let is_old = |(old, new): &(&str, &str)| *old == flag && !has(old) && has(new);
            let new = RENAMED.iter().find(|pair| is_old(pair)).and_then(|_| self.new_name(flag));
            match value {
                None => {
                    *word = new.unwrap_or(flag).into();
                    before = Some(flag.to_owned());
                }
                Some(value) => {
                    let pair = self.new_name(&format!("{flag} {value}"));
                    *word = match (pair, new) {
                        (Some(pair), _) => pair.replacen(' ', "=", 1).into(),
                        (None, Some(new)) => format!("{new}={value}").into(),
                        (None, None) => continue,
                    };
                }
            }
        }
    }

    /// A line on standard error for each old name.
    pub fn warn(&self) {
        for (old, new) in &self.0 {
            // A closed standard error is no reason to panic.
            let _ = writeln!(
                std::io::stderr(),
                "warning: {old} is now {new}; the old name goes away in the next release"
            );
        }
    }
}
