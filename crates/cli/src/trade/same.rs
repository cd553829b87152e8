//! Checks by the metadata of `render` and `reference` that a reference file shows this scene.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use ridgelight::scene::Scene;
use ridgelight::{Error, Result};
use ridgelight_io as files;

use crate::args::albedo_colour;
use crate::setup::lights::LIGHTS;

/// Tolerance of numbers that were written and read back as text.
const NEAR: f64 = 1e-6;

/// Refuses a file whose metadata states another surface, border or light, or light that no settings
/// here compute. `metadata` is this scene's. A file without metadata is accepted.
pub fn check(path: &Path, scene: &Scene, metadata: &[(String, String)]) -> Result<()> {
    let stated = files::read_metadata(path)?;
    let stated: BTreeMap<String, String> =
        stated.into_iter().map(|(name, value)| (new_key(name), value)).collect();
    if !stated.contains_key("ridgelight") {
        return Ok(());
    }
    let field = &scene.field;
    let mut ours: BTreeMap<String, String> = metadata.iter().cloned().collect();
    ours.insert("cell_m".to_owned(), format!("{},{}", field.cell_m()[0], field.cell_m()[1]));
    ours.insert("base_m".to_owned(), field.base_m().to_string());
    ours.insert("border".to_owned(), format!("{:?}", scene.surface.border).to_lowercase());
    let names: BTreeSet<&String> =
        stated.keys().chain(ours.keys()).filter(|n| is_scene(n)).collect();
    for name in names {
        let [found, expected] = [&stated, &ours].map(|all| all.get(name).map(String::as_str));
        if !is_same(name, found, expected) {
            let expected = match name.as_str() {
                "bounces" => format!("{} (--bounces here)", expected.unwrap_or("0")),
                name if gives_none(name) => format!("none: {NO_SETTINGS}"),
                _ => format!("{} (in this scene)", expected.unwrap_or("none")),
            };
            return Err(Error::File {
                path: path.to_owned(),
                place: format!("header: {name}"),
                found: found.unwrap_or("none").to_owned(),
                expected,
            });
        }
    }
    Ok(())
}

/// The key that replaces one of an earlier release.
fn new_key(name: String) -> String {
    match name.as_str() {
        "phong" => "specular".to_owned(),
        old if is_numbered(old, "light") => format!("sphere_{old}"),
        _ => name,
    }
}

const NO_SETTINGS: &str = "no settings of this search compute such light";

/// Light that no settings compute if the scene has none.
fn gives_none(name: &str) -> bool {
    let is_near = LIGHTS.iter().any(|light| !light.is_aimed && light.is_key(name));
    matches!(name, "bounces" | "specular") || is_near
}

fn is_scene(name: &str) -> bool {
    const NAMES: [&str; 9] =
        ["cell_m", "base_m", "z_scale", "border", "albedo", "tint", "sky", "env", "env_rotate_deg"];
    NAMES.contains(&name) || is_aimed(name) || gives_none(name)
}

/// Lights whose first number is their azimuth.
fn is_aimed(name: &str) -> bool {
    LIGHTS.iter().any(|light| light.is_aimed && light.is_key(name))
}

fn is_numbered(name: &str, word: &str) -> bool {
    name.strip_prefix(word).is_some_and(|rest| rest.parse::<u32>().is_ok())
}

/// Whether two values are equal however they are spelt; a file matches by name, in any folder.
fn is_same(name: &str, found: Option<&str>, expected: Option<&str>) -> bool {
    let numbers = |text: &str| -> Option<Vec<f64>> {
        if name == "albedo" {
            return albedo_colour(text).map(|c| c.map(f64::from).to_vec());
        }
        text.split(',').map(|t| t.parse().ok()).collect()
    };
    let (a, b) = match (found, expected) {
        (None, None) => return true,
        (Some(text), None) if gives_none(name) => {
            return name == "bounces" && text == "0";
        }
        (Some(a), Some(b)) => (a, b),
        _ => return false,
    };
    match (numbers(a), numbers(b)) {
        (Some(a), Some(b)) => {
            // Ignores whole turns.
            let turns = is_aimed(name) || name == "env_rotate_deg";
            a.len() == b.len()
                && (0..a.len()).all(|i| {
                    let off = a[i] - b[i];
                    let off =
                        if turns && i == 0 { off - 360.0 * (off / 360.0).round() } else { off };
                    off.abs() <= NEAR * a[i].abs().max(b[i].abs())
                })
        }
        (None, None) => Path::new(a).file_name() == Path::new(b).file_name(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_of_one_value_are_the_same() {
        for (name, a, b) in [
            ("albedo", Some("0.5"), Some("0.50,0.5,0.5")),
            ("albedo", Some("maps/moss.png"), Some("/else/moss.png")),
            ("sun1", Some("-90,30,0.53,1,1,1"), Some("270,30,0.53,1,1,1")),
            ("key1", Some("0,30,20,10,1,1,1"), Some("360,30,20,10,1,1,1")),
            ("cell_m", Some("30,30"), Some("30,30.000001")),
            ("env", Some("a/sky.hdr"), Some("sky.hdr")),
            ("bounces", Some("0"), None),
            ("specular", None, None),
        ] {
            assert!(is_same(name, a, b) && is_same(name, a, a), "{name}: {a:?} {b:?}");
        }
        for (name, a, b) in [
            ("albedo", Some("0.5"), Some("0.6")),
            ("albedo", Some("0.5"), Some("moss.png")),
            ("sun1", Some("90,30,0.53,1,1,1"), Some("270,30,0.53,1,1,1")),
            ("sun2", Some("90,30,0.53,1,1,1"), None),
            ("key1", None, Some("0,30,20,10,1,1,1")),
            ("sky", None, Some("1,1,1")),
            ("cell_m", Some("30,30"), Some("30,30.001")),
            ("env", Some("sky.hdr"), Some("lab.hdr")),
            ("bounces", Some("2"), None),
            ("specular", Some("9,0.25"), None),
            ("sphere_light1", Some("4,4,9,1,2,3,4"), None),
            ("border", Some("open"), Some("plane")),
        ] {
            assert!(!is_same(name, a, b), "{name}: {a:?} {b:?}");
        }
        assert!(
            ["key1", "sun12", "light3", "phong", "bounces"]
                .iter()
                .all(|name| is_scene(&new_key((*name).to_owned())))
        );
        // A method's settings are not part of the scene.
        assert!(!["sun_azimuths", "lights", "spp", "seed"].iter().any(|name| is_scene(name)));
    }
}
