//! Direct light from infinity at one grid point, in f64, by deterministic quadrature over the oracle's horizons.
//!
//! Everything here is exit radiance of a diffuse surface of albedo 1:
//! (1/π) ∫ L(e) V(e) max(N·e, 0) de, so a flat, unoccluded grid point under a sky of radiance 1 gives 1.
//! Along an azimuth φ a direction is e(ω) = (cos ω cos φ, cos ω sin φ, sin ω), de = cos ω dω dφ and
//! N·e = A cos ω + B sin ω with A = N_x cos φ + N_y sin φ, B = N_z. The integrand in ω is therefore
//! A cos²ω + B sin ω cos ω: see [`slice()`]. A Phong lobe has its own: see [`Receiver`].

use crate::oracle::Oracle;
use glam::DVec3;
pub use ridgelight::basis::light::slice;
pub use ridgelight::scene::normal;
use ridgelight::scene::{Border, Environment, HeightField, Sun};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Least number of azimuths of [`environment`]: narrow images have several per column.
pub const ENVIRONMENT_STRIPS: usize = 512;

/// Weight of incident light: over the hemisphere about the normal N, by the cosine to it (diffuse, albedo 1), or by
/// the Phong lobe (n+1)/(2π) max(e·r, 0)ⁿ about a direction r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Unit normal, upwards.
    pub normal: DVec3,
    /// Unit direction r and exponent n of the Phong specular, in place of the cosine.
    pub phong_lobe: Option<(DVec3, f64)>,
}

impl Receiver {
    /// A diffuse surface of albedo 1.
    pub fn diffuse(normal: DVec3) -> Self {
        Self { normal, phong_lobe: None }
    }

    /// A lobe of unit integral about the mirror direction of the zenith, the map view's: r = 2 N_z N - z.
    pub fn specular_from_above(normal: DVec3, exponent: f64) -> Self {
        Self { normal, phong_lobe: Some((2.0 * normal.z * normal - DVec3::Z, exponent)) }
    }

    /// The receiver's share in one azimuth.
    pub(crate) fn slice(&self, azimuth_rad: f64) -> Slice {
        let (sin, cos) = azimuth_rad.sin_cos();
        let along = |v: DVec3| v.x * cos + v.y * sin;
        let Self { normal, phong_lobe } = *self;
        // N·e > 0 where tan ω > -A/B (B > 0 on a height field), for A > 0 below horizontal.
        let low = (-along(normal)).atan2(normal.z);
        match phong_lobe {
            None => Slice { a: along(normal), b: normal.z, low, exponent: None },
            Some((r, n)) => Slice { a: along(r), b: r.z, low, exponent: Some(n) },
        }
    }
}

/// One azimuth at one receiver: N·e (or r·e) = a cos ω + b sin ω, and the elevation of the plane of N.
#[derive(Clone, Copy)]
pub(crate) struct Slice {
    pub(crate) a: f64,
    pub(crate) b: f64,
    pub(crate) low: f64,
    exponent: Option<f64>,
}

impl Slice {
    /// The same, with light only from above an elevation.
    pub(crate) fn above(self, horizon_rad: f64) -> Self {
        Self { low: self.low.max(horizon_rad), ..self }
    }

    /// π times the weight of a direction of elevation ω, 0 below `low`.
    pub(crate) fn at(&self, elevation_rad: f64) -> f64 {
        if elevation_rad <= self.low {
            return 0.0;
        }
        let cosine = (self.a * elevation_rad.cos() + self.b * elevation_rad.sin()).max(0.0);
        match self.exponent {
            // 0 to the power of 0 would be light from behind.
            Some(n) if cosine > 0.0 => 0.5 * (n + 1.0) * cosine.powf(n),
            _ => cosine,
        }
    }

    /// π times the weights' integral over elevations; the lobe's by Gauss' rule of 4 points in panels
    /// half as wide as the lobe, 1/√(n + 1).
    pub(crate) fn light(&self, low: f64, high: f64) -> f64 {
        let low = low.max(self.low);
        let Some(n) = self.exponent else { return slice(self.a, self.b, low, high) };
        if high <= low {
            return 0.0;
        }
        let panels = (2.0 * (high - low) * (n + 1.0).sqrt()).ceil();
        let half = 0.5 * (high - low) / panels;
        (0..panels as usize)
            .flat_map(|i| GAUSS_4.map(|(x, w)| (low + half * ((2 * i + 1) as f64 + x), w)))
            .map(|(elevation, weight)| half * weight * elevation.cos() * self.at(elevation))
            .sum()
    }
}

/// Nodes and weights of Gauss' rule of 4 points on [-1, 1]: x² = 3/7 ± (2/7)√(6/5), w = (18 ± √30)/36.
const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// One azimuth at one grid point: the incident light above its horizon.
pub(crate) fn lit(
    oracle: &Oracle,
    row: usize,
    col: usize,
    receiver: Receiver,
    azimuth_rad: f64,
) -> Slice {
    receiver.slice(azimuth_rad).above(oracle.elevation_rad(row, col, azimuth_rad))
}

/// Exit radiance under a uniform sky of radiance 1: (1/π)(2π/m) Σ of the slices to the zenith.
///
/// Azimuths are φ_k = 2πk/m. The sky continues below horizontal where the border is `open`.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn sky(field: &HeightField, border: Border, row: usize, col: usize, azimuths: usize) -> f64 {
    sky_of(&Oracle::for_one_place(field, border), row, col, azimuths)
}

/// [`sky`] by an existing oracle of the field.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn sky_of(oracle: &Oracle, row: usize, col: usize, azimuths: usize) -> f64 {
    let normal = normal(oracle.field(), oracle.border(), row, col);
    let m = azimuths.max(1);
    let sum: f64 = (0..m)
        .map(|k| {
            let azimuth = TAU * k as f64 / m as f64;
            lit(oracle, row, col, Receiver::diffuse(normal), azimuth).light(-FRAC_PI_2, FRAC_PI_2)
        })
        .sum();
    2.0 / m as f64 * sum
}

/// Exit radiance under an environment, linear RGB: a sum over all its texels.
///
/// One azimuth at the centre of each column of texels or, in images narrower than [`ENVIRONMENT_STRIPS`], at the
/// centres of equal parts of it (midpoint rule). In elevation each texel is clipped at the horizon exactly and
/// integrated in closed form.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn environment(
    field: &HeightField,
    border: Border,
    row: usize,
    col: usize,
    env: &Environment,
) -> [f64; 3] {
    environment_of(&Oracle::for_one_place(field, border), row, col, env)
}

/// [`environment`] by an existing oracle of the field.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn environment_of(oracle: &Oracle, row: usize, col: usize, env: &Environment) -> [f64; 3] {
    let parts = ENVIRONMENT_STRIPS.div_ceil(env.width());
    environment_on(oracle, row, col, &[diffuse_at(oracle, row, col)], env, parts)[0]
}

/// [`environment`] for receivers other than the grid point's diffuse one, with that many equal parts per column of
/// texels.
pub(crate) fn environment_on(
    oracle: &Oracle,
    row: usize,
    col: usize,
    receivers: &[Receiver],
    env: &Environment,
    parts: usize,
) -> Vec<[f64; 3]> {
    let (width, height) = (env.width(), env.height());
    let strips = width * parts;
    let mut sums = vec![[0.0; 3]; receivers.len()];
    for strip in 0..strips {
        // Columns run clockwise from azimuth π; the rotation is counter-clockwise.
        let azimuth = PI - TAU * (strip as f64 + 0.5) / strips as f64 + env.rotation_rad();
        let horizon = oracle.elevation_rad(row, col, azimuth);
        for (receiver, sum) in receivers.iter().zip(&mut sums) {
            let lit = receiver.slice(azimuth).above(horizon);
            for texel_row in 0..height {
                let high = FRAC_PI_2 - PI * texel_row as f64 / height as f64;
                let low = FRAC_PI_2 - PI * (texel_row + 1) as f64 / height as f64;
                if high <= lit.low {
                    break;
                }
                let light = lit.light(low, high);
                let texel = env.texels()[texel_row * width + strip / parts];
                for (s, t) in sum.iter_mut().zip(texel) {
                    *s += f64::from(t) * light;
                }
            }
        }
    }
    sums.iter().map(|sum| sum.map(|s| s * 2.0 / strips as f64)).collect()
}

/// Exit radiance under one sun, linear RGB.
///
/// A disc of angular radius a and radiance L gives a surface that faces it L π sin²a, so L = irradiance / (π sin²a).
/// `strips` azimuths across the disc, each with its chord of elevations clipped at the horizon exactly. Diameter 0: a
/// point, dark where its elevation is not above the horizon.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn sun(
    field: &HeightField,
    border: Border,
    row: usize,
    col: usize,
    sun: &Sun,
    strips: usize,
) -> [f64; 3] {
    sun_of(&Oracle::for_one_place(field, border), row, col, sun, strips)
}

/// [`sun`] by an existing oracle of the field.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn sun_of(oracle: &Oracle, row: usize, col: usize, sun: &Sun, strips: usize) -> [f64; 3] {
    sun_on(oracle, row, col, &[diffuse_at(oracle, row, col)], sun, strips)[0]
}

/// [`sun`] for receivers other than the grid point's diffuse one.
pub(crate) fn sun_on(
    oracle: &Oracle,
    row: usize,
    col: usize,
    receivers: &[Receiver],
    sun: &Sun,
    strips: usize,
) -> Vec<[f64; 3]> {
    let radius = 0.5 * sun.diameter_rad;
    let shares = if radius > 0.0 {
        let mut disc = disc(oracle, row, col, receivers, sun, strips.max(1));
        disc.iter_mut().for_each(|d| *d /= PI * radius.sin().powi(2));
        disc
    } else {
        let horizon = oracle.elevation_rad(row, col, sun.azimuth_rad);
        let lit = receivers.iter().map(|r| r.slice(sun.azimuth_rad).above(horizon));
        lit.map(|l| l.at(sun.elevation_rad)).collect()
    };
    shares.iter().map(|share| sun.irradiance.map(|e| f64::from(e) * share / PI)).collect()
}

/// The diffuse receiver of a grid point.
fn diffuse_at(oracle: &Oracle, row: usize, col: usize) -> Receiver {
    Receiver::diffuse(normal(oracle.field(), oracle.border(), row, col))
}

/// ∫ V max(N·e, 0) de over the sun's disc (for a Phong lobe, π times its weights' integral).
///
/// At azimuth δ from the centre's, a direction of elevation ω is within a of the centre
/// (elevation s) when sin ω sin s + cos ω cos s cos δ = R cos(ω - ω_m) ≥ cos a, with
/// R² = sin²s + cos²s cos²δ and tan ω_m = sin s / (cos s cos δ). The half chord w has
/// sin²w = 1 - cos²a/R² = (sin²a - cos²s sin²δ) / R². A disc that holds the zenith is met along every
/// azimuth; another one up to sin δ = sin a / cos s, where δ = δ_max sin u makes the chord's square
/// root smooth and the midpoint rule in u quick.
fn disc(
    oracle: &Oracle,
    row: usize,
    col: usize,
    receivers: &[Receiver],
    sun: &Sun,
    strips: usize,
) -> Vec<f64> {
    let radius = 0.5 * sun.diameter_rad;
    let (sin_s, cos_s) = sun.elevation_rad.sin_cos();
    let sin_a = radius.sin();
    let holds_zenith = sun.elevation_rad + radius >= FRAC_PI_2;
    let widest = if holds_zenith { PI } else { (sin_a / cos_s).min(1.0).asin() };
    let mut sums = vec![0.0; receivers.len()];
    for i in 0..strips {
        let centre = (i as f64 + 0.5) / strips as f64 * 2.0 - 1.0;
        let (offset, weight) = if holds_zenith {
            (widest * centre, 2.0 * widest / strips as f64)
        } else {
            let u = FRAC_PI_2 * centre;
            (widest * u.sin(), widest * u.cos() * PI / strips as f64)
        };
        let (sin_d, cos_d) = offset.sin_cos();
        let reach = sin_s.hypot(cos_s * cos_d);
        let squared = sin_a.powi(2) - (cos_s * sin_d).powi(2);
        if squared <= 0.0 {
            continue;
        }
        let half = (squared.sqrt() / reach).min(1.0).asin();
        let middle = sin_s.atan2(cos_s * cos_d);
        let azimuth = sun.azimuth_rad + offset;
        let horizon = oracle.elevation_rad(row, col, azimuth);
        for (receiver, sum) in receivers.iter().zip(&mut sums) {
            let lit = receiver.slice(azimuth).above(horizon);
            *sum += weight * lit.light(middle - half, (middle + half).min(FRAC_PI_2));
        }
    }
    sums
}
