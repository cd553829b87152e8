//! Texel encodings of baked values, with error bounds.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

pub use ridgelight_io::Component;

/// Error that an f32 decoder may add to a component of at most 1: a conversion and one or two
/// products.
const DECODER: f64 = 1.0 / (1 << 22) as f64;

/// Guaranteed bound on the error of a decoded quantity.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Name of the quantity.
    pub of: &'static str,
    /// "rad", or empty.
    pub unit: &'static str,
    /// Half steps of a component.
    pub half_steps: f64,
    /// Error of decoded values against the originals, and the original's magnitude.
    pub error: fn(&[f64], &[f64]) -> [f64; 2],
}

/// Error of the value at one index.
const fn at<const PLACE: usize>() -> fn(&[f64], &[f64]) -> [f64; 2] {
    |is, was| [(is[PLACE] - was[PLACE]).abs(), was[PLACE].abs()]
}

/// Largest error of all values.
fn farthest(is: &[f64], was: &[f64]) -> [f64; 2] {
    let all = is.iter().zip(was).map(|(i, w)| [(i - w).abs(), w.abs()]);
    all.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or_default()
}

fn sine(is: &[f64], was: &[f64]) -> [f64; 2] {
    let (is, was) = (is[0].sin(), was[0].sin());
    [(is - was).abs(), was.abs()]
}

fn direction(is: &[f64], was: &[f64]) -> [f64; 2] {
    let [is, was] = [is, was].map(DVec3::from_slice);
    [is.cross(was).length().atan2(is.dot(was)), 0.0]
}

impl Bound {
    /// Absolute bound, which adds to [`relative`](Self::relative) times the value. Includes the
    /// error of an f32 decoder.
    pub fn absolute(&self, component: Component) -> f64 {
        match component {
            // Half the smallest subnormal step.
            Component::F16 => self.half_steps / f64::from(1 << 25),
            Component::F32 => 0.0,
            _ => self.half_steps * (component.half_step() + DECODER),
        }
    }

    /// Error of decoded values as a share of the bound; 1 is the bound itself.
    pub fn share(&self, component: Component, is: &[f64], was: &[f64]) -> f64 {
        let [error, value] = (self.error)(is, was);
        let allowed = self.absolute(component) + self.relative(component) * value;
        if error == 0.0 { 0.0 } else { error / allowed }
    }

    /// Relative bound of float components: half a step, and the error of an f32 decoder.
    pub fn relative(&self, component: Component) -> f64 {
        match component {
            Component::F16 => 1.0 / 2048.0 + DECODER,
            Component::F32 => DECODER,
            _ => 0.0,
        }
    }
}

/// How values become the components of a texel.
#[derive(Clone, Copy, Debug)]
pub struct Encoding {
    /// Name on the command line.
    pub name: &'static str,
    /// Format of each component.
    pub component: Component,
    /// Values per texel.
    pub values: usize,
    /// Components per texel.
    pub components: usize,
    /// Values to components, each in the component's range.
    pub encode: fn(&[f64], &mut [f64]),
    /// Components to values.
    pub decode: fn(&[f64], &mut [f64]),
    /// The decoding formula, for the manifest; components are r, g, b and a.
    pub decoding: &'static str,
    /// Guaranteed error bounds.
    pub bounds: &'static [Bound],
}

impl Encoding {
    /// Encodes to the component's precision and decodes in f64.
    ///
    /// # Panics
    /// Another number of values than [`values`](Self::values).
    pub fn packed(&self, values: &[f64]) -> Vec<f64> {
        assert_eq!(values.len(), self.values, "values of a texel");
        let (mut texel, mut back) = (vec![0.0; self.components], vec![0.0; self.values]);
        (self.encode)(values, &mut texel);
        texel.iter_mut().for_each(|t| *t = self.component.rounded(*t));
        (self.decode)(&texel, &mut back);
        back
    }
}

/// The encoding of that name.
pub fn encoding_named(all: &'static [Encoding], name: &str) -> Option<&'static Encoding> {
    all.iter().find(|encoding| encoding.name == name)
}

fn same(from: &[f64], to: &mut [f64]) {
    to.copy_from_slice(from);
}

const SCALAR: Encoding = Encoding {
    name: "f32",
    component: Component::F32,
    values: 1,
    components: 1,
    encode: same,
    decode: same,
    decoding: "r",
    bounds: &[],
};

const ELEVATION: &[Bound] =
    &[Bound { of: "elevation", unit: "rad", half_steps: FRAC_PI_2, error: at::<0>() }];

const ANGLE: Encoding = Encoding {
    encode: |value, texel| texel[0] = value[0] / FRAC_PI_2,
    decode: |texel, value| value[0] = texel[0] * FRAC_PI_2,
    decoding: "elevation = r π/2",
    bounds: ELEVATION,
    ..SCALAR
};

/// Horizon elevation, radians: a fraction of a right angle with a uniform step, or the sine.
/// Lighting needs no further function of the sine, which is coarse near the zenith. The sine and
/// the unsigned fraction cannot store horizons below horizontal.
pub static HORIZON: [Encoding; 5] = [
    Encoding { name: "snorm16-angle", component: Component::Snorm16, ..ANGLE },
    Encoding { name: "snorm8-angle", component: Component::Snorm8, ..ANGLE },
    Encoding { name: "unorm8-angle", component: Component::Unorm8, ..ANGLE },
    Encoding {
        name: "unorm16-sin",
        component: Component::Unorm16,
        encode: |value, texel| texel[0] = value[0].sin(),
        decode: |texel, value| value[0] = texel[0].min(1.0).asin(),
        decoding: "sine of the elevation = r",
        bounds: &[Bound { of: "sine of the elevation", unit: "", half_steps: 1.0, error: sine }],
        ..SCALAR
    },
    Encoding { bounds: ELEVATION, decoding: "elevation = r", ..SCALAR },
];

const SHARES: &[Bound] = &[Bound { of: "share", unit: "", half_steps: 1.0, error: at::<0>() }];

/// Shares, 0 to 1.
pub static SHARE: [Encoding; 3] = [
    Encoding { name: "unorm16", component: Component::Unorm16, bounds: SHARES, ..SCALAR },
    Encoding { name: "unorm8", component: Component::Unorm8, bounds: SHARES, ..SCALAR },
    Encoding { bounds: SHARES, ..SCALAR },
];

/// The upper half of an octahedron, rotated by 45° to fill the square (Cigolle et al. 2014,
/// hemi-oct): with p = (x, y)/(|x| + |y| + z), u = p_x + p_y and v = p_x - p_y. It is continuous,
/// so textures may be filtered.
///
/// Steps δ of u and v move p by at most δ and z = 1 - |p_x| - |p_y| by at most δ, the point on the
/// octahedron by √2 δ. It is at least 1/√3 from the centre, so the direction turns by at most
/// asin(√6 δ). In half steps of components, of which u and v are twice as wide, 2 √6 = 4.899.
const OCTAHEDRAL: Encoding = Encoding {
    values: 4,
    components: 3,
    encode: |value, texel| {
        let sum = value[0].abs() + value[1].abs() + value[2].abs();
        let (x, y) = (value[0] / sum, value[1] / sum);
        texel[0] = 0.5 + 0.5 * (x + y);
        texel[1] = 0.5 + 0.5 * (x - y);
        texel[2] = value[3] / PI;
    },
    decode: |texel, value| {
        let (u, v) = (2.0 * texel[0] - 1.0, 2.0 * texel[1] - 1.0);
        let (x, y) = (0.5 * (u + v), 0.5 * (u - v));
        let z = 1.0 - x.abs() - y.abs();
        let length = (x * x + y * y + z * z).sqrt();
        value.copy_from_slice(&[x / length, y / length, z / length, texel[2] * PI]);
    },
    decoding: "u = 2r - 1, v = 2g - 1, x = (u + v)/2, y = (u - v)/2, direction = normalize(x, y, 1 - |x| - |y|), \
               cone's half-angle = b π",
    bounds: &[
        Bound { of: "direction", unit: "rad", half_steps: 4.9, error: direction },
        Bound { of: "cone's half-angle", unit: "rad", half_steps: PI, error: at::<3>() },
    ],
    ..SCALAR
};

/// Steps δ of three components move a unit vector by at most √3 δ, so it turns by at most asin(√3
/// δ).
const XYZ: Encoding = Encoding {
    values: 4,
    components: 4,
    encode: |value, texel| {
        texel[..3].copy_from_slice(&value[..3]);
        texel[3] = value[3] / PI;
    },
    decode: |texel, value| {
        let length = (texel[0] * texel[0] + texel[1] * texel[1] + texel[2] * texel[2]).sqrt();
        for (v, t) in value[..3].iter_mut().zip(texel) {
            *v = t / length;
        }
        value[3] = texel[3] * PI;
    },
    decoding: "direction = normalize(r, g, b), cone's half-angle = a π",
    bounds: &[
        Bound { of: "direction", unit: "rad", half_steps: 1.7322, error: direction },
        Bound { of: "cone's half-angle", unit: "rad", half_steps: PI, error: at::<3>() },
    ],
    ..SCALAR
};

/// A direction above horizontal and a cone's half-angle, radians.
pub static BENT_NORMAL: [Encoding; 5] = [
    Encoding { name: "unorm16-octahedral", component: Component::Unorm16, ..OCTAHEDRAL },
    Encoding { name: "unorm8-octahedral", component: Component::Unorm8, ..OCTAHEDRAL },
    Encoding { name: "snorm16-xyz", component: Component::Snorm16, ..XYZ },
    Encoding { name: "snorm8-xyz", component: Component::Snorm8, ..XYZ },
    Encoding {
        values: 4,
        components: 4,
        decoding: "direction = (r, g, b), cone's half-angle = a",
        bounds: &[
            Bound {
                of: "components of the direction",
                unit: "",
                half_steps: 1.0,
                error: |is, was| farthest(&is[..3], &was[..3]),
            },
            Bound { of: "cone's half-angle", unit: "rad", half_steps: 1.0, error: at::<3>() },
        ],
        ..SCALAR
    },
];

const FOUR: Encoding = Encoding {
    values: 4,
    components: 4,
    decoding: "coefficients 4k to 4k + 3 of layer k = r, g, b, a",
    bounds: &[Bound { of: "coefficient", unit: "", half_steps: 1.0, error: farthest }],
    ..SCALAR
};

/// SH coefficients, four per texel.
pub static COEFFICIENTS: [Encoding; 2] =
    [Encoding { name: "f16", component: Component::F16, ..FOUR }, FOUR];

const SIX: Encoding = Encoding {
    decoding: "layer 0: centre = (r, g), axis = (b, a); layer 1: 1 / radius along the axis = r, across it = g",
    bounds: &[Bound { of: "number", unit: "", half_steps: 1.0, error: farthest }],
    ..FOUR
};

/// Visibility ellipses: six numbers in two layers.
pub static ELLIPSE: [Encoding; 2] =
    [Encoding { name: "f16", component: Component::F16, ..SIX }, SIX];

const CURVED: Encoding = Encoding {
    decoding: "layer k from 0 to 4, of a flat base, bent towards east outwards and inwards, towards north outwards and inwards: centre = \
               (r, g), matrix xx = b, yy = a; xy of ellipses 0 to 3 = layer 5, of 4 = r of layer 6; linear in curvature between",
    ..SIX
};

/// Five ellipses as centre and symmetric matrix: 25 numbers in seven layers.
pub static CURVED_ELLIPSE: [Encoding; 2] =
    [Encoding { name: "f16", component: Component::F16, ..CURVED }, CURVED];

/// Rows and columns up to 65532, -1 for sky and -2 for ground. The integers are exact.
pub static POINTS: [Encoding; 1] = [Encoding {
    name: "unorm16",
    component: Component::Unorm16,
    values: 2,
    components: 2,
    encode: |value, texel| {
        for (t, v) in texel.iter_mut().zip(value) {
            *t = (v + 2.0) / 65535.0;
        }
    },
    decode: |texel, value| {
        for (v, t) in value.iter_mut().zip(texel) {
            *v = (65535.0 * t).round() - 2.0;
        }
    },
    decoding: "row = round(65535 r) - 2, column = round(65535 g) - 2",
    bounds: &[Bound {
        of: "row and column",
        unit: "grid points",
        half_steps: 0.0,
        error: farthest,
    }],
}];

const COLOUR: Encoding = Encoding {
    values: 3,
    components: 3,
    encode: same,
    decode: same,
    decoding: "r, g, b",
    bounds: &[Bound { of: "colour", unit: "", half_steps: 1.0, error: farthest }],
    ..SCALAR
};

const HALF: Encoding = Encoding { name: "f16", component: Component::F16, ..COLOUR };

/// Radiance, and its standard error in the next layer.
pub static RADIANCE: [Encoding; 2] = {
    const DECODING: &str = "layer 0: radiance = r, g, b; layer 1: its standard error = r, g, b";
    [Encoding { decoding: DECODING, ..HALF }, Encoding { decoding: DECODING, ..COLOUR }]
};

/// A BRDF table, 1/sr.
pub static REFLECTED: [Encoding; 2] =
    [Encoding { component: Component::F32, name: "f32", ..COLOUR }, HALF];

/// Weights of products of harmonics, 1/sr. They cancel each other, so f16 would leave too large an
/// error.
pub static HARMONIC_WEIGHTS: [Encoding; 1] =
    [Encoding { component: Component::F32, name: "f32", ..COLOUR }];

/// Radiance, and the part of the view that a texel fills.
pub static TEXELS: [Encoding; 2] = {
    const TEXEL: Encoding = Encoding {
        values: 4,
        components: 4,
        decoding: "radiance = r, g, b; share of the view = a",
        ..COLOUR
    };
    [Encoding { name: "f16", component: Component::F16, ..TEXEL }, TEXEL]
};

#[cfg(test)]
mod tests;
