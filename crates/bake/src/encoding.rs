//! From values to texels and back, and by how much that may be off.

mod light;

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

pub use ridgelight_io::Component;

pub use light::{HARMONIC_WEIGHTS, RADIANCE, REFLECTED, TEXELS};

/// What a decoder in f32 may add to a component of at most 1: its conversion and a product or two.
const DECODER: f64 = 1.0 / (1 << 22) as f64;

/// A promise: how far a decoded quantity may be from the value that was encoded.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Of what.
    pub of: &'static str,
    /// "rad", or nothing.
    pub unit: &'static str,
    /// Times the half step of a component.
    pub half_steps: f64,
    /// How far values are from others in this, and how large it is of the others.
    pub off: fn(&[f64], &[f64]) -> [f64; 2],
}

/// Of the one at a place.
const fn at<const PLACE: usize>() -> fn(&[f64], &[f64]) -> [f64; 2] {
    |is, was| [(is[PLACE] - was[PLACE]).abs(), was[PLACE].abs()]
}

/// Of all, the one that is farthest off.
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
    /// At most this, and [`relative`](Self::relative) of the value besides; what a decoder in f32 adds is in it.
    pub fn absolute(&self, component: Component) -> f64 {
        match component {
            // Half the least step.
            Component::F16 => self.half_steps / f64::from(1 << 25),
            Component::F32 => 0.0,
            _ => self.half_steps * (component.half_step() + DECODER),
        }
    }

    /// By how much values are beyond what is promised of others: 1 is all of it.
    pub fn share(&self, component: Component, is: &[f64], was: &[f64]) -> f64 {
        let [off, value] = (self.off)(is, was);
        let allowed = self.absolute(component) + self.relative(component) * value;
        if off == 0.0 { 0.0 } else { off / allowed }
    }

    /// A share of the value itself, of floats: half a step and the decoder's.
    pub fn relative(&self, component: Component) -> f64 {
        match component {
            Component::F16 => 1.0 / 2048.0 + DECODER,
            Component::F32 => DECODER,
            _ => 0.0,
        }
    }
}

/// How values of a kind become the components of a texel.
#[derive(Clone, Copy, Debug)]
pub struct Encoding {
    /// As the command line calls it.
    pub name: &'static str,
    /// What holds each.
    pub component: Component,
    /// Values that a texel stands for.
    pub values: usize,
    /// Components that it takes.
    pub components: usize,
    /// Values to components, each in the component's range.
    pub encode: fn(&[f64], &mut [f64]),
    /// Components to values.
    pub decode: fn(&[f64], &mut [f64]),
    /// The same in words, for the sheet; components are r, g, b and a.
    pub decoding: &'static str,
    /// What is promised.
    pub bounds: &'static [Bound],
}

impl Encoding {
    /// Values as they come back from a texel, decoded in f64.
    ///
    /// # Panics
    /// When there are not as many as [`values`](Self::values).
    pub fn packed(&self, values: &[f64]) -> Vec<f64> {
        assert_eq!(values.len(), self.values, "values of a texel");
        let (mut texel, mut back) = (vec![0.0; self.components], vec![0.0; self.values]);
        (self.encode)(values, &mut texel);
        texel.iter_mut().for_each(|t| *t = self.component.rounded(*t));
        (self.decode)(&texel, &mut back);
        back
    }
}

/// The one of that name.
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
    &[Bound { of: "elevation", unit: "rad", half_steps: FRAC_PI_2, off: at::<0>() }];

const ANGLE: Encoding = Encoding {
    encode: |value, texel| texel[0] = value[0] / FRAC_PI_2,
    decode: |texel, value| value[0] = texel[0] * FRAC_PI_2,
    decoding: "elevation = r π/2",
    bounds: ELEVATION,
    ..SCALAR
};

/// Of horizons, radians: fractions of a right angle, whose step is the same at all elevations, or the sine, which
/// light takes without another function but which is coarse near the zenith. A sine and an unsigned fraction hold no
/// horizon below horizontal.
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
        bounds: &[Bound { of: "sine of the elevation", unit: "", half_steps: 1.0, off: sine }],
        ..SCALAR
    },
    Encoding { bounds: ELEVATION, decoding: "elevation = r", ..SCALAR },
];

const SHARES: &[Bound] = &[Bound { of: "share", unit: "", half_steps: 1.0, off: at::<0>() }];

/// Of shares, 0 to 1.
pub static SHARE: [Encoding; 3] = [
    Encoding { name: "unorm16", component: Component::Unorm16, bounds: SHARES, ..SCALAR },
    Encoding { name: "unorm8", component: Component::Unorm8, bounds: SHARES, ..SCALAR },
    Encoding { bounds: SHARES, ..SCALAR },
];

/// The upper half of an octahedron, turned by 45° so that it fills the square (Cigolle et al. 2014, hemi-oct): with
/// p = (x, y)/(|x| + |y| + z), u = p_x + p_y and v = p_x - p_y. Continuous all over, so that it may be filtered.
///
/// Steps δ of u and v move p by at most δ and z = 1 - |p_x| - |p_y| by at most δ, the point on the octahedron by
/// √2 δ; it is at least 1/√3 from the middle, so the direction turns by at most asin(√6 δ). In half steps of components,
/// of which u and v are twice as wide, 2 √6 = 4.899.
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
        Bound { of: "direction", unit: "rad", half_steps: 4.9, off: direction },
        Bound { of: "cone's half-angle", unit: "rad", half_steps: PI, off: at::<3>() },
    ],
    ..SCALAR
};

/// Steps δ of three components move a unit vector by at most √3 δ, so it turns by asin(√3 δ).
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
        Bound { of: "direction", unit: "rad", half_steps: 1.7322, off: direction },
        Bound { of: "cone's half-angle", unit: "rad", half_steps: PI, off: at::<3>() },
    ],
    ..SCALAR
};

/// Of a direction above horizontal and the half-angle of a cone, radians.
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
                off: |is, was| farthest(&is[..3], &was[..3]),
            },
            Bound { of: "cone's half-angle", unit: "rad", half_steps: 1.0, off: at::<3>() },
        ],
        ..SCALAR
    },
];

const FOUR: Encoding = Encoding {
    values: 4,
    components: 4,
    decoding: "coefficients 4k to 4k + 3 of layer k = r, g, b, a",
    bounds: &[Bound { of: "coefficient", unit: "", half_steps: 1.0, off: farthest }],
    ..SCALAR
};

/// Of coefficients, four a texel.
pub static COEFFICIENTS: [Encoding; 2] =
    [Encoding { name: "f16", component: Component::F16, ..FOUR }, FOUR];

const SIX: Encoding = Encoding {
    decoding: "layer 0: centre = (r, g), axis = (b, a); layer 1: 1 / radius along the axis = r, across it = g",
    bounds: &[Bound { of: "number", unit: "", half_steps: 1.0, off: farthest }],
    ..FOUR
};

/// Of ellipses: six numbers in two layers.
pub static ELLIPSE: [Encoding; 2] =
    [Encoding { name: "f16", component: Component::F16, ..SIX }, SIX];

const CURVED: Encoding = Encoding {
    decoding: "layer k from 0 to 4, of a flat base, bent towards east outwards and inwards, towards north outwards and inwards: centre = \
               (r, g), matrix xx = b, yy = a; xy of ellipses 0 to 3 = layer 5, of 4 = r of layer 6; linear in curvature between",
    ..SIX
};

/// Of five ellipses, centre and symmetric matrix: 25 numbers in seven layers.
pub static CURVED_ELLIPSE: [Encoding; 2] =
    [Encoding { name: "f16", component: Component::F16, ..CURVED }, CURVED];

/// Of rows and columns up to 65532, -1 for sky and -2 for ground: whole numbers that come back as they were.
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
    bounds: &[Bound { of: "row and column", unit: "samples", half_steps: 0.0, off: farthest }],
}];

#[cfg(test)]
mod tests;
