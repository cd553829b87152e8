//! Tips for flags of other programs and for a missing input.

use std::ffi::OsString;
use std::path::Path;

use clap::Command;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Flags of gdaldem as clap reports them (`-az` is the flag `-a`), the id of ours, and the tip.
const OF_GDALDEM: [(&[&str], &str, &str); 3] = [
    (
        &["-a", "--az", "--azimuth", "--alt", "--altitude", "--elevation"],
        "sun",
        "write the sun as --sun AZ,EL; gdaldem's -az 315 -alt 45 are --sun 315,45",
    ),
    (&["-z", "--z", "--z-factor", "--zfactor"], "z_scale", "gdaldem's -z is --z-scale"),
    (&["-s"], "z_scale", "leave out gdaldem's -s: cells in degrees become metres without it"),
];

/// Replaces clap's tip, where we have a better one for the words of a command line.
pub fn add(mut error: clap::Error, parser: &Command, words: &[OsString]) -> clap::Error {
    let tip = match (error.kind(), error.get(ContextKind::InvalidArg)) {
        (ErrorKind::UnknownArgument, Some(ContextValue::String(found))) => {
            let command = words.iter().skip(1).find_map(|word| parser.find_subcommand(word));
            let has = |id: &str| {
                command.is_some_and(|command| command.get_arguments().any(|arg| arg.get_id() == id))
            };
            negative_camera(found, &has, words).or_else(|| of_gdaldem(found, &has))
        }
        (ErrorKind::MissingRequiredArgument, _) => missing_input(words),
        _ => None,
    };
    if let Some(tip) = tip {
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    }
    error
}

fn of_gdaldem(found: &str, has: &dyn Fn(&str) -> bool) -> Option<String> {
    let mut all = OF_GDALDEM.iter();
    let (_, _, tip) = all.find(|(theirs, ours, _)| theirs.contains(&found) && has(ours))?;
    Some((*tip).to_owned())
}

/// `--camera -10,40`: clap takes the value for a flag, and reports `-1`.
fn negative_camera(found: &str, has: &dyn Fn(&str) -> bool, words: &[OsString]) -> Option<String> {
    let at = words.iter().position(|word| word == "--camera")?;
    let value = words.get(at + 1)?.to_str()?;
    let is_it = value.starts_with(found) && value.starts_with('-');
    (is_it && has("camera"))
        .then(|| format!("a value that begins with - needs =: --camera={value}"))
}

/// `info --json dem.tif`: the input was taken for the file to write.
fn missing_input(words: &[OsString]) -> Option<String> {
    let at = words.iter().position(|word| word == "--json")?;
    let file = Path::new(words.get(at + 1)?);
    let is_output = file.as_os_str() == "-" || file.extension().is_some_and(|e| e == "json");
    (!is_output)
        .then(|| format!("--json takes a file name: write `info {} --json`", file.display()))
}
