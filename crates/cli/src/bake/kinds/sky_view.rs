use ridgelight::Result;
use ridgelight_bake as bake;
use ridgelight_bake::SkyView;

use super::super::map::Format;
use super::{Kind, Making, Map, Request, Sums, Value};

pub static KIND: Kind = Kind {
    name: "sky-view",
    about: "light of a uniform sky of radiance 1 on white ground: the cosine-weighted share of the hemisphere about \
            the normal that is free",
    encodings: &bake::SHARE,
    formats: &[Format::Ktx2, Format::Png],
    decoder: include_str!("../../../../../shaders_glsl/decode/sky_view.glsl"),
    begin,
};

fn begin(asked: &Request) -> Result<Making> {
    let map = Map {
        planes: vec!["sky_view".into()],
        values: vec![Value {
            name: "sky_view",
            about: "1/π ∫ V max(N·e, 0) de",
            unit: "",
            range: [0.0, 1.0],
        }],
        is_array: false,
        constants: Vec::new(),
        ..Map::default()
    };
    Ok(Sums::begin(Box::new(SkyView), asked, map))
}
