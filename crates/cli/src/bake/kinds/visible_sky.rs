use ridgelight::Result;
use ridgelight_bake as bake;
use ridgelight_bake::VisibleSky;

use super::super::map::Format;
use super::{Kind, Making, Map, Request, Sums, Value};

pub static KIND: Kind = Kind {
    name: "visible-sky",
    about: "the share of the upper hemisphere's solid angle that is free, whatever the normal: the mean of \
            1 - sin(horizon)",
    encodings: &bake::SHARE,
    formats: &[Format::Ktx2, Format::Png],
    decoder: include_str!("../../../../../shaders_glsl/decode/visible_sky.glsl"),
    begin,
};

fn begin(asked: &Request) -> Result<Making> {
    let map = Map {
        planes: vec!["visible_sky".into()],
        values: vec![Value {
            name: "visible_sky",
            about: "1/2π ∫ V de over the upper hemisphere",
            unit: "",
            range: [0.0, 1.0],
        }],
        is_array: false,
        constants: Vec::new(),
        ..Map::default()
    };
    Ok(Sums::begin(Box::new(VisibleSky), asked, map))
}
