use ridgelight::{Error, Result};
use ridgelight_bake as bake;
use ridgelight_bake::{MAX_TRANSFER_ORDER, ShTransfer};

use super::super::map::Format;
use super::{Kind, Making, Request, Sums, Value, coefficients};

pub static KIND: Kind = Kind {
    name: "sh-transfer",
    about: "diffuse transfer of --sh-order 2 to 5: with light as harmonics, Σ t L is what white ground sends back",
    encodings: &bake::COEFFICIENTS,
    formats: &[Format::Ktx2, Format::Exr],
    decoder: include_str!("../../../../../shaders_glsl/decode/sh_transfer.glsl"),
    begin,
};

fn begin(asked: &Request) -> Result<Making> {
    let order = asked.quality.sh_order as usize;
    if order > MAX_TRANSFER_ORDER {
        return Err(Error::setting(
            "--sh-order",
            format!("{order} for sh-transfer"),
            format!("2 to {MAX_TRANSFER_ORDER}: the cosine takes a band more of what is free"),
        ));
    }
    let value = Value {
        name: "coefficient",
        about: "1/π ∫ V max(N·e, 0) Y_lm de in plane l(l+1) + m; real, orthonormal, x east, y north, z up, no sign of \
                Condon and Shortley",
        unit: "",
        // By Cauchy and Schwarz no more than the root of 1/π² ∫ max(N·e, 0)² de = 2/(3π).
        range: [-0.461, 0.461],
    };
    let map = coefficients(&KIND, order, value);
    Ok(Sums::begin(Box::new(ShTransfer::new(order)), asked, map))
}
