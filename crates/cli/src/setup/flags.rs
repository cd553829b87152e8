//! Flags in place of the settings that library messages name.

use ridgelight::Error;
use ridgelight::scene::setting;

use super::lights::LIGHTS;
use crate::args::flag;

/// Phrases and settings of library messages whose flag has another name.
const FLAGS: [(&str, &str); 20] = [
    ("sky radiance", "--sky"),
    ("specular", "--specular"),
    ("albedo", "--albedo"),
    ("cell_m", "--cell"),
    ("cell size", "--cell"),
    ("environment rotation", "--env-rotate"),
    ("distances to the horizon", "--distances"),
    ("pixels per degree", "--pixels-per-degree"),
    ("camera: look-at point", "--look-at"),
    ("camera: field of view", "--fov"),
    ("camera", "--camera"),
    ("samples a pixel", "--samples"),
    ("samples per pixel", "--samples"),
    ("picture size", "--size"),
    ("mesh step", "--mesh-step"),
    ("background", "--background"),
    ("plinth", "--plinth"),
    ("directions", "--directions"),
    ("curvatures of ellipses", "--curvature"),
    ("z_scale", "--z-scale"),
];

/// Settings whose flag is their name with `-` for `_`, beside those of quality.
const SAME: [&str; 8] =
    ["memory_budget", "max_error", "time_budget", "border", "nodata", "band", "bbox", "paths"];

/// The flag of a library name, as "azimuths" or "sun 2: elevation".
fn flag_of(name: &str) -> Option<String> {
    if setting(name).is_some() || SAME.contains(&name) {
        return Some(flag(name));
    }
    if name == "lights" {
        let all = ["sky", "env"].into_iter().chain(LIGHTS.iter().map(|light| light.id));
        return Some(all.map(flag).collect::<Vec<_>>().join(", "));
    }
    let light = LIGHTS.iter().find_map(|light| {
        let rest = name.strip_prefix(&light.id.replace('_', " "))?;
        let is_numbered = rest.starts_with(' ');
        (is_numbered || rest == "s").then(|| flag(light.id) + rest.trim_start_matches('s'))
    });
    if light.is_some() {
        return light;
    }
    FLAGS.iter().find_map(|(ours, flag)| Some(format!("{flag}{}", name.strip_prefix(ours)?)))
}

/// Replaces settings in backticks by flags: "`lines exact`" by "--lines exact". Leaves other words in backticks.
pub fn flags_in(text: &str) -> String {
    let mut parts = text.split('`');
    let mut all = parts.next().unwrap_or_default().to_owned();
    while let Some(quoted) = parts.next() {
        let (name, value) = quoted.split_at(quoted.find(' ').unwrap_or(quoted.len()));
        match (flag_of(name), parts.next()) {
            (Some(flag), Some(after)) => all += &format!("{flag}{value}{after}"),
            (None, Some(after)) => all += &format!("`{quoted}`{after}"),
            (_, None) => all += &format!("`{quoted}"),
        }
    }
    all
}

/// A library error with the flags of its settings.
pub fn in_flags(error: Error) -> Error {
    match error {
        Error::Setting { name, found, expected } => Error::Setting {
            name: flag_of(&name).unwrap_or_else(|| flags_in(&name)),
            found: flags_in(&found),
            expected: flags_in(&expected),
        },
        Error::Limit { what, needs, limit } => {
            Error::Limit { what: flags_in(&what), needs: flags_in(&needs), limit: flags_in(&limit) }
        }
        // What was found may be a text of the file.
        Error::File { path, place, found, expected } => {
            Error::File { path, place, found, expected: flags_in(&expected) }
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_in_backticks_become_flags() {
        for (text, flags) in [
            ("`lines exact` with `suns`", "--lines exact with --sun"),
            ("64 MiB of `memory_budget`", "64 MiB of --memory-budget"),
            ("`bounce_engine sweep`", "--bounce-engine sweep"),
            ("`reference` and `compare`", "`reference` and `compare`"),
            ("an open ` stays", "an open ` stays"),
            ("`basis sh` `sh_order 4`", "--basis sh --sh-order 4"),
        ] {
            assert_eq!(flags_in(text), flags);
        }
        let named = |name: &str| match in_flags(Error::setting(name, "", "")) {
            Error::Setting { name, .. } => name,
            _ => unreachable!(),
        };
        assert_eq!(named("azimuths"), "--azimuths");
        assert_eq!(named("sun 2: elevation"), "--sun 2: elevation");
        assert_eq!(named("sphere light 1: radius"), "--sphere-light 1: radius");
        assert_eq!(named("specular scale"), "--specular scale");
        assert_eq!(named("heights"), "heights");
    }
}
