//! Keys of a scene file, and the flag that each stands for.

use ridgelight::scene::{SETTINGS, Values};

/// Stands for the positional argument.
pub const INPUT: &str = "path";

/// Type of a key's value.
#[derive(Clone, Copy)]
pub enum Kind {
    /// One of the flag's values, or a number.
    Word,
    /// A path relative to the scene file's folder.
    File,
    Numbers(Numbers),
    /// True sets the flag; false leaves it out.
    Switch,
    /// A colour, or a path.
    ColourOrFile,
    /// An object with the flag's comma-separated values.
    Parts(&'static [Part]),
    /// Such an object, or a path.
    PartsOrFile(&'static [Part]),
    /// A list of such objects, one flag each.
    List(&'static [Part]),
}

/// Count of numbers.
#[derive(Clone, Copy, PartialEq)]
pub enum Numbers {
    One,
    /// One for both axes, or two.
    Pair,
    /// One for grey, or three.
    Colour,
    Three,
    TwoOrThree,
}

/// A member of an object.
pub struct Part {
    pub name: &'static str,
    pub numbers: Numbers,
    /// Value of a missing member, empty to leave it out. None: the member is required.
    pub default: Option<&'static str>,
}

#[derive(Clone, Copy)]
pub struct Key {
    pub name: &'static str,
    /// The id of the argument: the flag with `_` for `-`.
    pub id: &'static str,
    pub kind: Kind,
}

const fn key(name: &'static str, id: &'static str, kind: Kind) -> Key {
    Key { name, id, kind }
}

const fn part(name: &'static str, numbers: Numbers) -> Part {
    Part { name, numbers, default: None }
}

const fn or(part: Part, default: &'static str) -> Part {
    Part { default: Some(default), ..part }
}

const NUMBER: Kind = Kind::Numbers(Numbers::One);
const SPECULAR: [Part; 2] = [part("exponent", Numbers::One), part("scale", Numbers::One)];
const SUN: [Part; 4] = [
    part("azimuth_deg", Numbers::One),
    part("elevation_deg", Numbers::One),
    or(part("diameter_deg", Numbers::One), "0.53"),
    or(part("irradiance", Numbers::Colour), "1"),
];
const PATCH: [Part; 5] = [
    part("azimuth_deg", Numbers::One),
    part("elevation_deg", Numbers::One),
    part("width_deg", Numbers::One),
    part("height_deg", Numbers::One),
    part("radiance", Numbers::Colour),
];
const SPHERE: [Part; 3] = [
    part("position_m", Numbers::Three),
    part("radius_m", Numbers::One),
    part("radiance", Numbers::Colour),
];

const FIELD: [Key; 5] = [
    key("file", INPUT, Kind::File),
    key("cell_m", "cell", Kind::Numbers(Numbers::Pair)),
    key("z_scale", "z_scale", NUMBER),
    key("border", "border", Kind::Word),
    key("nodata", "nodata", Kind::Word),
];
const SURFACE: [Key; 2] = [
    key("albedo", "albedo", Kind::ColourOrFile),
    key("specular", "specular", Kind::PartsOrFile(&SPECULAR)),
];
const LIGHTS: [Key; 6] = [
    key("sky", "sky", Kind::Numbers(Numbers::Colour)),
    key("environment", "env", Kind::File),
    key("environment_rotate_deg", "env_rotate", NUMBER),
    key("suns", "sun", Kind::List(&SUN)),
    key("keys", "key", Kind::List(&PATCH)),
    key("sphere_lights", "sphere_light", Kind::List(&SPHERE)),
];

const EYE: [Part; 3] = [
    part("azimuth_deg", Numbers::One),
    part("elevation_deg", Numbers::One),
    or(part("distance_m", Numbers::One), ""),
];
const CAMERA: [Key; 8] = [
    key("from", "camera", Kind::Parts(&EYE)),
    key("look_at_m", "look_at", Kind::Numbers(Numbers::TwoOrThree)),
    key("fov_deg", "fov", NUMBER),
    key("ortho", "ortho", Kind::Switch),
    key("size", "size", Kind::Word),
    key("samples", "samples", NUMBER),
    key("mesh_step", "mesh_step", NUMBER),
    key("background", "background", Kind::Numbers(Numbers::Colour)),
];

/// All groups but quality, whose keys are the settings.
pub const GROUPS: [(&str, &[Key]); 4] =
    [("field", &FIELD), ("surface", &SURFACE), ("lights", &LIGHTS), ("camera", &CAMERA)];

/// Keys of the quality group: the settings, and how to choose them.
pub fn quality() -> Vec<Key> {
    let keys = SETTINGS.iter().map(|setting| {
        let is_number = matches!(setting.values, Values::Whole(_) | Values::Share);
        key(setting.name, setting.name, if is_number { NUMBER } else { Kind::Word })
    });
    keys.chain(["max_error", "time_budget"].map(|name| key(name, name, NUMBER))).collect()
}
