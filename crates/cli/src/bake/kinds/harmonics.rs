//! Visibility as spherical harmonics: `sh-visibility`, and `sh-transfer` with the cosine.

use ridgelight::{Error, Result};
use ridgelight_bake as bake;
use ridgelight_bake::{MAX_TRANSFER_ORDER, ShTransfer, ShVisibility};

use super::super::map::{Format, stem};
use super::{Kind, Making, Map, Request, Sums, Value};

pub static SH_VISIBILITY: Kind = Kind {
    name: "sh-visibility",
    about: "visibility as SH of --sh-order: ∫ V Y de",
    encodings: &bake::COEFFICIENTS,
    formats: &[Format::Ktx2, Format::Exr],
    decoder: include_str!("../../../../../shaders_glsl/decode/sh_visibility.glsl"),
    begin: begin_visibility,
};

fn begin_visibility(request: &Request) -> Result<Making> {
    let order = request.quality.sh_order as usize;
    let value = Value {
        name: "coefficient",
        about: "∫ V Y_lm de in plane l(l+1) + m; real, orthonormal, x east, y north, z up, no \
            Condon-Shortley phase",
        unit: "",
        // Cauchy-Schwarz: at most the root of the sphere's 4π.
        range: [-3.545, 3.545],
    };
    let map = coefficients(&SH_VISIBILITY, order, value);
    Ok(Sums::begin(Box::new(ShVisibility::new(order)), request, map))
}

pub static SH_TRANSFER: Kind = Kind {
    name: "sh-transfer",
    about: "diffuse transfer of --sh-order 2 to 5: with SH light L, Σ t L is the radiance of \
        white ground",
    encodings: &bake::COEFFICIENTS,
    formats: &[Format::Ktx2, Format::Exr],
    decoder: include_str!("../../../../../shaders_glsl/decode/sh_transfer.glsl"),
    begin: begin_transfer,
};

fn begin_transfer(request: &Request) -> Result<Making> {
    let order = request.quality.sh_order as usize;
    if order > MAX_TRANSFER_ORDER {
        return Err(Error::setting(
            "--sh-order",
            format!("{order} for sh-transfer"),
            format!("2 to {MAX_TRANSFER_ORDER}: the cosine needs one more band of visibility"),
        ));
    }
    let value = Value {
        name: "coefficient",
        about: "1/π ∫ V max(N·e, 0) Y_lm de in plane l(l+1) + m; real, orthonormal, x east, y \
            north, z up, no Condon-Shortley phase",
        unit: "",
        // Cauchy-Schwarz: at most the root of 1/π² ∫ max(N·e, 0)² de = 2/(3π).
        range: [-0.461, 0.461],
    };
    let map = coefficients(&SH_TRANSFER, order, value);
    Ok(Sums::begin(Box::new(ShTransfer::new(order)), request, map))
}

/// SH coefficients, four per texel.
fn coefficients(kind: &Kind, order: usize, value: Value) -> Map {
    let stem = stem(kind);
    let bands = (0..order as isize).flat_map(|l| (-l..=l).map(move |m| (l, m)));
    Map {
        planes: bands.map(|(l, m)| format!("{stem}.l{l}m{m}")).collect(),
        values: vec![value],
        is_array: true,
        constants: vec![format!("const int SH_COUNT = {};", order * order)],
        ..Map::default()
    }
}
