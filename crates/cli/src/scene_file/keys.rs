//! Keys of a scene file, and the flag that each stands for.

use ridgelight::scene::{SETTINGS, Values};

use crate::setup::lights::LIGHTS;

/// Stands for the positional argument.
pub const INPUT: &str = "path";

/// Type of a key's value.
#[derive(Clone, Copy)]
pub enum Kind {
    /// One of the flag's values, or a number.
    Word,
    /// A path relative to the scene file's folder.
    File,
    /// One path, or several in a list.
    Files,
    Numbers(Numbers),
    /// True sets the flag; false leaves it out.
    Switch,
    /// An object with the flag's comma-separated values.
    Parts(&'static [Part]),
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
    Four,
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
    /// What may stand in place of such a value.
    pub or: Or,
}

/// A text in place of numbers or parts.
#[derive(Clone, Copy, PartialEq)]
pub enum Or {
    Nothing,
    /// A path.
    File,
    Word(&'static str),
}

const fn key(name: &'static str, id: &'static str, kind: Kind) -> Key {
    Key { name, id, kind, or: Or::Nothing }
}

pub const fn part(name: &'static str, numbers: Numbers) -> Part {
    Part { name, numbers, default: None }
}

pub const fn or(part: Part, default: &'static str) -> Part {
    Part { default: Some(default), ..part }
}

const NUMBER: Kind = Kind::Numbers(Numbers::One);
const SPECULAR: [Part; 2] = [part("exponent", Numbers::One), part("scale", Numbers::One)];
const FIELD: [Key; 7] = [
    key("file", INPUT, Kind::Files),
    key("cell_m", "cell", Kind::Numbers(Numbers::Pair)),
    key("z_scale", "z_scale", NUMBER),
    key("border", "border", Kind::Word),
    key("nodata", "nodata", Kind::Word),
    key("band", "band", NUMBER),
    key("bbox", "bbox", Kind::Numbers(Numbers::Four)),
];
const SURFACE: [Key; 3] = [
    Key { or: Or::File, ..key("albedo", "albedo", Kind::Numbers(Numbers::Colour)) },
    Key { or: Or::File, ..key("specular", "specular", Kind::Parts(&SPECULAR)) },
    key("tint", "tint", Kind::Word),
];
const LIGHT: [Key; 3] = [
    Key { or: Or::Word("clear"), ..key("sky", "sky", Kind::Numbers(Numbers::Colour)) },
    key("environment", "env", Kind::File),
    key("environment_rotate_deg", "env_rotate", NUMBER),
];

const EYE: [Part; 3] = [
    part("azimuth_deg", Numbers::One),
    part("elevation_deg", Numbers::One),
    or(part("distance_m", Numbers::One), ""),
];
const CAMERA: [Key; 9] = [
    key("from", "camera", Kind::Parts(&EYE)),
    key("look_at_m", "look_at", Kind::Numbers(Numbers::TwoOrThree)),
    key("fov_deg", "fov", NUMBER),
    key("ortho", "ortho", Kind::Switch),
    key("size", "size", Kind::Word),
    key("samples", "samples", NUMBER),
    key("mesh_step", "mesh_step", NUMBER),
    key("background", "background", Kind::Numbers(Numbers::Colour)),
    key("plinth", "plinth", NUMBER),
];

/// Every group and its keys. Those of quality are the settings, and how to choose them.
pub fn groups() -> Vec<(&'static str, Vec<Key>)> {
    let lights = LIGHTS.iter().map(|light| key(light.list, light.id, Kind::List(light.parts)));
    let settings = SETTINGS.iter().map(|setting| {
        let is_number = matches!(setting.values, Values::Whole(_) | Values::Share);
        key(setting.name, setting.name, if is_number { NUMBER } else { Kind::Word })
    });
    let goals = ["max_error", "time_budget"].map(|name| key(name, name, NUMBER));
    vec![
        ("field", FIELD.to_vec()),
        ("surface", SURFACE.to_vec()),
        ("lights", LIGHT.into_iter().chain(lights).collect()),
        ("camera", CAMERA.to_vec()),
        ("quality", settings.chain(goals).collect()),
    ]
}
