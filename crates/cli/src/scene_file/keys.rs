//! What a scene file may hold, and the flag that each of its keys is.

use crate::args::SETTINGS;

/// In the place of a flag: the argument without one.
pub const INPUT: &str = "path";

/// What a key's value is.
#[derive(Clone, Copy)]
pub enum Kind {
    /// One of the flag's words, or a number.
    Word,
    /// A path from the scene file's folder.
    File,
    Numbers(Numbers),
    /// True for a flag that takes nothing, false for none.
    Switch,
    /// A colour, or a path.
    ColourOrFile,
    /// An object: what a flag holds between commas.
    Parts(&'static [Part]),
    /// The same, or a path.
    PartsOrFile(&'static [Part]),
    /// A list of such objects, each a flag.
    List(&'static [Part]),
}

/// How many numbers.
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
    /// What stands for a member that is not there, nothing for the last; none where it must be.
    pub default: Option<&'static str>,
}

#[derive(Clone, Copy)]
pub struct Key {
    pub name: &'static str,
    /// As the parser calls it: `_` for `-`.
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
const LOBE: [Part; 2] = [part("exponent", Numbers::One), part("scale", Numbers::One)];
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
const BALL: [Part; 3] = [
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
const SURFACE: [Key; 2] =
    [key("albedo", "albedo", Kind::ColourOrFile), key("phong", "phong", Kind::PartsOrFile(&LOBE))];
const LIGHTS: [Key; 6] = [
    key("sky", "sky", Kind::Numbers(Numbers::Colour)),
    key("environment", "env", Kind::File),
    key("environment_rotate_deg", "env_rotate", NUMBER),
    key("suns", "sun", Kind::List(&SUN)),
    key("keys", "key", Kind::List(&PATCH)),
    key("balls", "light", Kind::List(&BALL)),
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

/// All groups but quality, whose keys are the settings themselves.
pub const GROUPS: [(&str, &[Key]); 4] =
    [("field", &FIELD), ("surface", &SURFACE), ("lights", &LIGHTS), ("camera", &CAMERA)];

/// The settings, as `render` has them.
pub fn quality(parser: &clap::Command) -> Vec<Key> {
    let render = parser.find_subcommand("render").expect("a command of ours");
    let is_number = |name: &str| {
        let arg = render.get_arguments().find(|arg| arg.get_id() == name);
        arg.expect("a flag of ours").get_possible_values().is_empty()
    };
    SETTINGS
        .into_iter()
        .chain(["method", "max_error", "time_budget"])
        .map(|name| key(name, name, if is_number(name) { NUMBER } else { Kind::Word }))
        .collect()
}
