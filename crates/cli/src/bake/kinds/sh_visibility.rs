use ridgelight::Result;
use ridgelight_bake as bake;
use ridgelight_bake::ShVisibility;

use super::super::map::Format;
use super::{Kind, Making, Request, Sums, Value, coefficients};

pub static KIND: Kind = Kind {
    name: "sh-visibility",
    about: "what is free as spherical harmonics of --sh-order: ∫ V Y de",
    encodings: &bake::COEFFICIENTS,
    formats: &[Format::Ktx2, Format::Exr],
    decoder: include_str!("../../../../../shaders_glsl/decode/sh_visibility.glsl"),
    begin,
};

fn begin(asked: &Request) -> Result<Making> {
    let order = asked.quality.sh_order as usize;
    let value = Value {
        name: "coefficient",
        about: "∫ V Y_lm de in plane l(l+1) + m; real, orthonormal, x east, y north, z up, no sign of Condon and Shortley",
        unit: "",
        // By Cauchy and Schwarz no more than the root of the sphere's 4π.
        range: [-3.545, 3.545],
    };
    let map = coefficients(&KIND, order, value);
    Ok(Sums::begin(Box::new(ShVisibility::new(order)), asked, map))
}
