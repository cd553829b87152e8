//! Of what is light.

use super::{Bound, Component, Encoding, SCALAR, farthest, same};

const COLOUR: Encoding = Encoding {
    values: 3,
    components: 3,
    encode: same,
    decode: same,
    decoding: "r, g, b",
    bounds: &[Bound { of: "colour", unit: "", half_steps: 1.0, off: farthest }],
    ..SCALAR
};

const HALF: Encoding = Encoding { name: "f16", component: Component::F16, ..COLOUR };

/// Of radiances, and of their standard errors a layer on.
pub static RADIANCE: [Encoding; 2] = {
    const DECODING: &str = "layer 0: radiance = r, g, b; layer 1: its standard error = r, g, b";
    [Encoding { decoding: DECODING, ..HALF }, Encoding { decoding: DECODING, ..COLOUR }]
};

/// Of a table of what is reflected, 1/sr.
pub static REFLECTED: [Encoding; 2] =
    [Encoding { component: Component::F32, name: "f32", ..COLOUR }, HALF];

/// Of weights of products of harmonics, 1/sr, which cancel each other: halves of a float would leave more than an order does.
pub static HARMONIC_WEIGHTS: [Encoding; 1] =
    [Encoding { component: Component::F32, name: "f32", ..COLOUR }];

/// Of radiance, and the share of a view that a texel fills.
pub static TEXELS: [Encoding; 2] = {
    const TEXEL: Encoding = Encoding {
        values: 4,
        components: 4,
        decoding: "radiance = r, g, b; share of the view = a",
        ..COLOUR
    };
    [Encoding { name: "f16", component: Component::F16, ..TEXEL }, TEXEL]
};
