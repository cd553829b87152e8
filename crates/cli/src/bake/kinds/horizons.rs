//! Kinds from the horizons of a circle of azimuths.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use ridgelight::scene::Border;
use ridgelight::{Error, Result};
use ridgelight_bake::MAX_TRANSFER_ORDER;
use ridgelight_io::Component;

use super::{Job, Map, Value, Wanted};
use crate::horizon::Compass;
use crate::maps;

pub fn horizon(job: &Job, wanted: &Wanted) -> Result<Map> {
    let (encoding, count) = (wanted.encoding, job.quality.azimuths);
    let is_open = job.border() == Border::Open;
    if is_open && !encoding.component.is_signed() {
        return Err(Error::setting(
            format!("--encoding {}=", wanted.kind.name),
            format!("{} with --border open", encoding.name),
            "snorm16-angle, snorm8-angle or f32: these hold horizons below 0",
        ));
    }
    let is_angle = encoding.component != Component::F32 && !encoding.name.ends_with("-sin");
    let scale = if is_angle { FRAC_PI_2 } else { 1.0 };
    let azimuths: Vec<f64> = (0..count).map(|k| TAU * f64::from(k) / f64::from(count)).collect();
    let compass = Compass::of(&azimuths);
    let names = compass.names();
    Ok(Map {
        planes: compass.layer_of.iter().map(|layer| names[*layer].clone()).collect(),
        values: vec![Value {
            name: "elevation",
            about: "horizon elevation above horizontal, in planes by compass degrees; layer k of a \
                texture, and picture k, along 2π k / azimuths counter-clockwise from east",
            unit: "rad",
            range: [if is_open { -FRAC_PI_2 } else { 0.0 }, FRAC_PI_2],
        }],
        is_array: true,
        constants: vec![
            format!("const int HORIZON_AZIMUTHS = {count};"),
            format!("const float HORIZON_SCALE = {scale:?};"),
        ],
        ..Map::default()
    })
}

/// A share of the sky, 0 to 1.
pub fn share(name: &'static str, about: &'static str) -> Map {
    let values = vec![Value { name, about, unit: "", range: [0.0, 1.0] }];
    Map { planes: vec![name.into()], values, ..Map::default() }
}

/// The device adds one f32 term for each azimuth.
pub fn sky_view(job: &Job, _: &Wanted) -> Result<Map> {
    let map = share(maps::SKY_VIEW, "1/π ∫ V max(N·e, 0) de");
    Ok(Map { roundings: job.quality.azimuths, ..map })
}

pub fn bent_normal(job: &Job, wanted: &Wanted) -> Result<Map> {
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
    let is_octahedral = wanted.encoding.name.ends_with("-octahedral");
    let scale = if wanted.encoding.component == Component::F32 { 1.0 } else { PI };
    Ok(Map {
        planes: ["x", "y", "z", "cone"].map(|name| format!("bent_normal.{name}")).into(),
        values: vec![component("x"), component("y"), component("z"), cone],
        constants: vec![
            format!("const bool BENT_OCTAHEDRAL = {is_octahedral};"),
            format!("const float BENT_CONE_SCALE = {scale:?};"),
            format!("const float BENT_Y = {:?};", job.normals.y()),
        ],
        normals: Some(job.normals),
        ..Map::default()
    })
}

pub fn sh_visibility(job: &Job, wanted: &Wanted) -> Result<Map> {
    let about = "∫ V Y_lm de in plane l(l+1) + m; real, orthonormal, x east, y north, z up, no \
        Condon-Shortley phase";
    // Cauchy-Schwarz: at most the root of the sphere's 4π.
    Ok(coefficients(job, wanted, about, 3.545))
}

pub fn sh_transfer(job: &Job, wanted: &Wanted) -> Result<Map> {
    let order = job.sh_order();
    if order > MAX_TRANSFER_ORDER {
        return Err(Error::setting(
            "--sh-order",
            format!("{order} for sh-transfer"),
            format!("2 to {MAX_TRANSFER_ORDER}: the cosine needs one more band of visibility"),
        ));
    }
    let about = "1/π ∫ V max(N·e, 0) Y_lm de in plane l(l+1) + m; real, orthonormal, x east, y \
        north, z up, no Condon-Shortley phase";
    // Cauchy-Schwarz: at most the root of 1/π² ∫ max(N·e, 0)² de = 2/(3π).
    Ok(coefficients(job, wanted, about, 0.461))
}

/// SH coefficients, four per texel.
fn coefficients(job: &Job, wanted: &Wanted, about: &'static str, most: f64) -> Map {
    let (order, stem) = (job.sh_order(), wanted.kind.stem());
    let bands = (0..order as isize).flat_map(|l| (-l..=l).map(move |m| (l, m)));
    Map {
        planes: bands.map(|(l, m)| format!("{stem}.l{l}m{m}")).collect(),
        values: vec![Value { name: "coefficient", about, unit: "", range: [-most, most] }],
        is_array: true,
        constants: vec![format!("const int SH_COUNT = {};", order * order)],
        ..Map::default()
    }
}
