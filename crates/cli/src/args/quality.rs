//! Flags of the library's settings, one each.

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args};
use ridgelight::Result;
use ridgelight::scene::{Audience, Quality, SETTINGS, Setting, Values};

use crate::scene_file::SceneFile;
use crate::setup::flags_in;

// A doc comment on this struct would replace the description of a command.
#[derive(Args)]
#[command(args = SETTINGS.iter().map(arg))]
pub struct QualityArgs {
    /// Values of all settings.
    #[arg(skip)]
    values: Vec<(&'static Setting, String)>,
    /// Settings that the user wrote on the command line, and the first value of each.
    #[arg(skip)]
    pub written: Vec<(String, String)>,
    /// Names of the settings that the command line or the scene file gives.
    #[arg(skip)]
    given: Vec<String>,
}

impl QualityArgs {
    /// # Errors
    /// The first value that its setting does not take.
    pub fn quality(&self) -> Result<Quality> {
        debug_assert!(!self.values.is_empty(), "`remember` was not called");
        let mut quality = Quality::default();
        for (setting, value) in &self.values {
            setting.set(&mut quality, value)?;
        }
        Ok(quality)
    }

    /// Whether the command line or the scene file gives a setting.
    pub fn gives(&self, setting: &str) -> bool {
        self.given.iter().any(|given| given == setting)
    }

    /// Stores all values and which settings the user wrote. A value alone does not show whether it comes from the user, a default or a
    /// scene file.
    pub fn remember(&mut self, matches: &ArgMatches, scene: &SceneFile) {
        let value = |setting: &'static Setting| {
            Some((setting, matches.get_one::<String>(setting.name)?.clone()))
        };
        self.values = SETTINGS.iter().filter_map(value).collect();
        let written = matches.ids().map(clap::Id::as_str).filter_map(|id| {
            let is_word = matches.value_source(id) == Some(ValueSource::CommandLine);
            let by_user = is_word && !scene.gave(id);
            let value = matches.get_raw(id).filter(|_| by_user)?.next()?;
            Some((id.to_owned(), value.to_string_lossy().into_owned()))
        });
        self.written = written.collect();
        let is_given = |id: &&str| matches.value_source(id) == Some(ValueSource::CommandLine);
        self.given =
            matches.ids().map(clap::Id::as_str).filter(is_given).map(str::to_owned).collect();
    }
}

/// The flag of a setting, with two dashes.
pub fn flag(setting: &str) -> String {
    format!("--{}", setting.replace('_', "-"))
}

fn arg(setting: &'static Setting) -> Arg {
    let [summary, trade] = [setting.summary(), setting.trade()].map(|text| flags_in(&text));
    let value_name = setting.name.to_uppercase();
    let arg = Arg::new(setting.name)
        .long(setting.name.replace('_', "-"))
        .default_value(setting.get(&Quality::default()))
        .allow_negative_numbers(true)
        .help_heading(if setting.audience == Audience::Expert { "Expert" } else { "Quality" })
        .hide_short_help(setting.audience != Audience::Everyone);
    // Without a second paragraph, the short help is the long one.
    let arg = match trade.is_empty() {
        true => arg,
        false => arg.long_help(format!("{summary}\n\n{trade}")),
    };
    let arg = arg.help(summary);
    // Ranges are checked by the library.
    let expected = move || setting.values.expected();
    match &setting.values {
        Values::Whole(_) => arg.value_name("N").value_parser(move |text: &str| {
            text.parse::<u32>().map(|_| text.to_owned()).map_err(|_| expected())
        }),
        Values::Share => {
            arg.value_name("SHARE").hide_default_value(true).value_parser(move |text: &str| {
                text.parse::<f64>().map(|share| share.to_string()).map_err(|_| expected())
            })
        }
        Values::OneOf(all) => arg
            .value_name(value_name)
            .value_parser(PossibleValuesParser::new(all.iter().map(u32::to_string))),
        Values::Words(all) => arg.value_name(value_name).value_parser(PossibleValuesParser::new(
            all.iter().map(|word| PossibleValue::new(word.name).help(word.summary())),
        )),
    }
}
