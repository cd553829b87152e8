//! Notes on flags that change nothing. None is an error.

use std::io::Write as _;

use ridgelight::scene::setting as setting_of;

use crate::args::flag;

/// Prints a note for each `written` setting that is not among the `used`.
pub fn say(quiet: bool, written: &[(String, String)], used: &[(String, String)]) {
    say_why(quiet, written, used, &|_| None);
}

/// The same, with reasons of the command itself.
pub fn say_why(
    quiet: bool,
    written: &[(String, String)],
    used: &[(String, String)],
    why: &dyn Fn(&str) -> Option<String>,
) {
    if !quiet {
        notes(written, used, why).iter().for_each(|line| print(line));
    }
}

/// One line per note.
pub fn notes(
    written: &[(String, String)],
    used: &[(String, String)],
    why: &dyn Fn(&str) -> Option<String>,
) -> Vec<String> {
    let mut lines = Vec::new();
    for (setting, value) in written.iter().filter(|(s, _)| s != "method" && setting_of(s).is_some())
    {
        let by_name = |(name, used): &(String, String)| {
            // The planner may choose another value of these two.
            let is_kept = !matches!(name.as_str(), "lines" | "precision") || used == value;
            name == setting && is_kept
        };
        if !used.iter().any(by_name) {
            let why = why(setting).unwrap_or_else(|| reason(setting, used));
            lines.push(line(setting, value, &why));
        }
    }
    lines
}

/// Prints one note.
pub fn note(setting: &str, value: &str, reason: &str) {
    print(&line(setting, value, reason));
}

fn line(setting: &str, value: &str, reason: &str) -> String {
    format!("note: {} {value} changes nothing {reason}", flag(setting))
}

fn print(line: &str) {
    // A closed standard error is no reason to panic.
    let _ = writeln!(std::io::stderr(), "{line}");
}

fn reason(setting: &str, used: &[(String, String)]) -> String {
    let of = |name: &str| used.iter().find(|(n, _)| n == name).map(|(_, value)| value.as_str());
    match (setting, of("method"), of("lines")) {
        ("azimuths", ..) => "without a sky or an environment".into(),
        ("sun_azimuths", ..) => {
            "without a sun wider than 0.01°, a key light or a sphere light".into()
        }
        ("light_cutoff", ..) if of("light_basis").is_some() => "with --specular".into(),
        ("light_cutoff" | "light_basis", ..) => "without a sphere light".into(),
        (
            "lines" | "fuse" | "precision" | "hull" | "level_step" | "level_offset" | "levels",
            None,
            _,
        ) => "without a sky, an environment, a sun or a key light".into(),
        ("bounces", ..) => "for horizons".into(),
        ("bounce_level_step" | "bounce_level_offset", ..) => {
            "without --bounces and --bounce-engine pyramid".into()
        }
        ("bounce_specular", ..) => "without --bounces and --specular".into(),
        (name, ..) if name.starts_with("bounce_") => "without --bounces".into(),
        ("level_step" | "level_offset" | "levels", ..) => "without --method pyramid".into(),
        (
            "table_elevations" | "basis" | "sh_order" | "wedges" | "receiver" | "window"
            | "subsample" | "wedge_side",
            ..,
        ) => match (setting, of("basis")) {
            ("sh_order" | "wedges" | "receiver" | "window", None)
                if of("light_basis").is_some() =>
            {
                "without an environment or --light-basis sh".into()
            }
            ("subsample", None) => "without an environment or --bounces".into(),
            (_, None) => "without an environment".into(),
            ("wedge_side", Some("sh")) => "without --wedges table".into(),
            ("subsample", _) => {
                "without --basis sh or --bounces: tables light each texel through its own horizons"
                    .into()
            }
            ("table_elevations", _) => "with --basis sh".into(),
            _ => "without --basis sh".into(),
        },
        (_, Some("pyramid"), _) => "with --method pyramid".into(),
        (_, Some("brute-force"), _) => "with --method brute-force".into(),
        (_, Some("first crossings"), _) => "where nothing rises above anything else".into(),
        (_, Some("auto"), _) => "where all light has exact shadows".into(),
        (_, _, Some("exact")) => "with --lines exact".into(),
        ("precision", ..) => format!("with --fuse {}", of("fuse").unwrap_or_default()),
        _ => "with --border periodic: they do not divide this field".into(),
    }
}
