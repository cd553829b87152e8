use glam::DVec3;
use ridgelight::scene::Border;
use ridgelight::{Error, Result};
use ridgelight_bake as bake;
use ridgelight_bake::Ray;
use ridgelight_io::Component;
use std::f64::consts::FRAC_PI_2;

use super::super::map::{Format, MapFiles};
use super::{Kind, Maker, Making, Map, Request, Source, Value};

pub static KIND: Kind = Kind {
    name: "horizon",
    about: "horizon elevations along --azimuths directions: a layer each",
    encodings: &bake::HORIZON,
    formats: &[Format::Ktx2],
    decoder: include_str!("../../../../../shaders_glsl/decode/horizon.glsl"),
    begin,
};

fn begin(request: &Request) -> Result<Making> {
    let (encoding, count) = (request.encoding, request.quality.azimuths);
    let component = encoding.component;
    if request.border == Border::Open && !component.is_signed() {
        return Err(Error::setting(
            format!("--encoding {}=", KIND.name),
            format!("{} with --border open", encoding.name),
            "snorm16-angle, snorm8-angle or f32: these hold horizons below 0",
        ));
    }
    let lowest = if request.border == Border::Open { -FRAC_PI_2 } else { 0.0 };
    let is_angle = component != Component::F32 && !encoding.name.ends_with("-sin");
    let scale = if is_angle { FRAC_PI_2 } else { 1.0 };
    let map = Map {
        planes: (0..count)
            .map(|k| format!("horizon.{:07.3}", 360.0 * f64::from(k) / f64::from(count)))
            .collect(),
        values: vec![Value {
            name: "elevation",
            about: "horizon elevation above horizontal, along 2π k / azimuths counter-clockwise \
                from east in plane or layer k",
            unit: "rad",
            range: [lowest, FRAC_PI_2],
        }],
        is_array: true,
        constants: vec![
            format!("const int HORIZON_AZIMUTHS = {count};"),
            format!("const float HORIZON_SCALE = {scale:?};"),
        ],
        ..Map::default()
    };
    Ok(Making { map, source: Source::Horizons(Box::new(Horizon)) })
}

struct Horizon;

impl Maker for Horizon {
    fn bytes(&self) -> u64 {
        0
    }

    fn add(
        &mut self,
        _: Ray,
        elevations_rad: &[f32],
        _: &[DVec3],
        files: &mut MapFiles,
    ) -> Result<()> {
        files.take(&[elevations_rad])
    }

    fn end(self: Box<Self>, _: &[DVec3], _: &mut MapFiles) -> Result<()> {
        Ok(())
    }
}
