use ridgelight::Result;
use ridgelight_bake as bake;
use ridgelight_bake::BentNormal;
use ridgelight_io::Component;
use std::f64::consts::PI;

use super::super::map::Format;
use super::{Kind, Making, Map, Request, Sums, Value};

pub static KIND: Kind = Kind {
    name: "bent-normal",
    about: "mean unoccluded direction, and the half-angle of the cone with the unoccluded solid \
        angle",
    encodings: &bake::BENT_NORMAL,
    formats: &[Format::Ktx2, Format::Png],
    decoder: include_str!("../../../../../shaders_glsl/decode/bent_normal.glsl"),
    begin,
};

fn begin(request: &Request) -> Result<Making> {
    let component = |name| Value {
        name,
        about: "unit vector along ∫ V e de; the zenith where everything is occluded",
        unit: "",
        range: [-1.0, 1.0],
    };
    let cone = Value {
        name: "cone",
        about: "half-angle a: 2π (1 - cos a) = ∫ V de; with an open border also over directions \
            below horizontal",
        unit: "rad",
        range: [0.0, PI],
    };
    let is_octahedral = request.encoding.name.ends_with("-octahedral");
    let scale = if request.encoding.component == Component::F32 { 1.0 } else { PI };
    let map = Map {
        planes: ["x", "y", "z", "cone"].map(|name| format!("bent_normal.{name}")).into(),
        values: vec![component("x"), component("y"), component("z"), cone],
        is_array: false,
        constants: vec![
            format!("const bool BENT_OCTAHEDRAL = {is_octahedral};"),
            format!("const float BENT_CONE_SCALE = {scale:?};"),
        ],
        ..Map::default()
    };
    Ok(Sums::begin(Box::new(BentNormal), request, map))
}
