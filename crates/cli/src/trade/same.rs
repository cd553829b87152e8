//! Checks by the metadata of `render` and `reference` that a reference file shows this scene.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use ridgelight::scene::Scene;
use ridgelight::{Error, Result};
use ridgelight_io as files;

use crate::args::grey_or_colour;
use crate::setup::lights::LIGHTS;

/// Tolerance of numbers that were written and read back as text.
const NEAR: f64 = 1e-6;

/// Refuses a file whose metadata states another surface, border, eye or light, or light that no settings
/// here compute, as bounces about flat normals. `metadata` is this scene's. A file without metadata is
/// accepted.
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
                "eye_m" => {
                    "none: `trade` views specular from straight above; trace the file again \
                            without --camera"
                        .to_owned()
                }
                name if gives_none(name) => format!("none: {NO_SETTINGS}"),
                _ => format!("{} (in this scene)", expected.unwrap_or("none")),
            };
            let found = found.unwrap_or("none");
            return Err(Error::file(path, format!("header: {name}"), found, expected));
        }
    }
    if has_flat_bounces(&stated) {
        let found = stated.get("normals").map_or("none, which is flat", String::as_str);
        let expected = "smooth, as --bounces here: trace the file again without --normals flat";
        return Err(Error::file(path, "header: normals", found, expected));
    }
    Ok(())
}

/// Whether the file is of `reference` with bounces about flat normals. Files of earlier versions do not state their
/// normals, which were flat. Direct light does not depend on them, and pictures have smooth ones only.
fn has_flat_bounces(stated: &BTreeMap<String, String>) -> bool {
    let of = |name: &str| stated.get(name).map(String::as_str);
    of("method") == Some("path tracing")
        && !matches!(of("bounces"), None | Some("0"))
        && of("normals") != Some("smooth")
}

/// The key that replaces one of an earlier release.
fn new_key(name: String) -> String {
    match name.as_str() {
        "phong" => "specular".to_owned(),
        old if old.strip_prefix("light").is_some_and(|n| n.parse::<u32>().is_ok()) => {
            format!("sphere_{old}")
        }
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
    const NAMES: [&str; 10] = [
        "cell_m",
        "base_m",
        "z_scale",
        "border",
        "albedo",
        "tint",
        "sky",
        "env",
        "env_rotate_deg",
        "eye_m",
    ];
    NAMES.contains(&name) || is_aimed(name) || gives_none(name)
}

/// Lights whose first number is their azimuth.
fn is_aimed(name: &str) -> bool {
    LIGHTS.iter().any(|light| light.is_aimed && light.is_key(name))
}

/// Whether two values are equal however they are spelt; a file matches by name, in any folder.
fn is_same(name: &str, found: Option<&str>, expected: Option<&str>) -> bool {
    let numbers = |text: &str| -> Option<Vec<f64>> {
        if name == "albedo" {
            return grey_or_colour(text).map(|c| c.map(f64::from).to_vec());
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
    use ridgelight::scene::{HeightField, Lights, Surface};
    use ridgelight_io::{Channels, Layer};

    /// Only bounces of `reference` depend on normals; a file that does not state them has flat ones.
    #[test]
    fn bounces_about_flat_normals_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let field = HeightField::new(1, 2, &[0.0; 2], [1.0; 2], None).unwrap();
        let scene = Scene { field, surface: Surface::default(), lights: Lights::default() };
        let text = |(name, value): (&str, &str)| (name.to_owned(), value.to_owned());
        let checked = |method, bounces, normals: Option<&str>| {
            let path = folder.path().join("file.exr");
            let stated = [
                ("ridgelight", "1"),
                ("cell_m", "1,1"),
                ("base_m", "0"),
                ("border", "plane"),
                ("method", method),
                ("bounces", bounces),
            ];
            let stated: Vec<_> =
                stated.into_iter().chain(normals.map(|n| ("normals", n))).map(text).collect();
            let layer = Layer { name: String::new(), channels: Channels::Rgb(&[[1.0; 3]; 2]) };
            files::write_exr(&path, 1, 2, &[layer], &stated).unwrap();
            check(&path, &scene, &[text(("bounces", bounces))])
        };
        for (method, bounces, normals) in [
            ("path tracing", "2", Some("smooth")),
            ("path tracing", "0", Some("flat")),
            ("path tracing", "0", None),
            ("brute force", "2", None),
        ] {
            checked(method, bounces, normals).unwrap();
        }
        for (normals, found) in [(Some("flat"), "flat"), (None, "none, which is flat")] {
            let message = checked("path tracing", "2", normals).unwrap_err().to_string();
            let expected = format!("header: normals: found {found}, expected smooth");
            assert!(message.contains(&expected), "{message}");
        }
    }

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
            ("eye_m", None, None),
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
            ("eye_m", Some("1,-2.5,9"), None),
            ("eye_m", Some("1,-2.5,9"), Some("1,-2.5,8")),
        ] {
            assert!(!is_same(name, a, b), "{name}: {a:?} {b:?}");
        }
        assert!(
            ["key1", "sun12", "light3", "phong", "bounces", "eye_m"]
                .iter()
                .all(|name| is_scene(&new_key((*name).to_owned())))
        );
        // A method's settings are not part of the scene.
        assert!(!["sun_azimuths", "lights", "spp", "seed"].iter().any(|name| is_scene(name)));
    }
}
