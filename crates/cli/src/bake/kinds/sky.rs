//! Visibility of the sky: `sky-view`, weighted by the cosine, and `visible-sky`.

use ridgelight::Result;
use ridgelight_bake as bake;
use ridgelight_bake::{HorizonMap, SkyView, VisibleSky};

use super::super::map::Format;
use super::{Kind, Making, Map, Request, Sums, Value};

pub static SKY_VIEW: Kind = Kind {
    name: "sky-view",
    about: "radiance of white ground under a uniform sky of radiance 1: the unoccluded \
        cosine-weighted share of the hemisphere about the normal",
    encodings: &bake::SHARE,
    formats: &[Format::Ktx2, Format::Png],
    decoder: include_str!("../../../../../shaders_glsl/decode/sky_view.glsl"),
    begin: |request| begin(request, Box::new(SkyView), "sky_view", "1/π ∫ V max(N·e, 0) de"),
};

pub static VISIBLE_SKY: Kind = Kind {
    name: "visible-sky",
    about: "unoccluded share of the upper hemisphere's solid angle, for any normal: the mean of \
        1 - sin(horizon)",
    encodings: &bake::SHARE,
    formats: &[Format::Ktx2, Format::Png],
    decoder: include_str!("../../../../../shaders_glsl/decode/visible_sky.glsl"),
    begin: |request| {
        let about = "1/2π ∫ V de over the upper hemisphere";
        begin(request, Box::new(VisibleSky), "visible_sky", about)
    },
};

fn begin(
    request: &Request,
    sum: Box<dyn HorizonMap>,
    name: &'static str,
    about: &'static str,
) -> Result<Making> {
    let map = Map {
        planes: vec![name.into()],
        values: vec![Value { name, about, unit: "", range: [0.0, 1.0] }],
        ..Map::default()
    };
    Ok(Sums::begin(sum, request, map))
}
