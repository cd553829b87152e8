//! Direct light from infinity, suns and key lights at one grid point, in f64, by deterministic quadrature over the oracle's horizons.
//!
//! Everything here is exit radiance of a diffuse surface of albedo 1:
//! (1/π) ∫ L(e) V(e) max(N·e, 0) de, so a flat, unoccluded grid point under a sky of radiance 1 gives 1.
//! Along an azimuth φ a direction is e(ω) = (cos ω cos φ, cos ω sin φ, sin ω), de = cos ω dω dφ and
//! N·e = A cos ω + B sin ω with A = N_x cos φ + N_y sin φ, B = N_z. The integrand in ω is therefore
//! A cos²ω + B sin ω cos ω: see [`slice()`]. A Phong lobe has its own: see [`Receiver`].

use crate::Rgb;
use crate::maxima::Maxima;
use crate::mirror_map::mirrored;
use crate::oracle::Oracle;
use crate::phong_integral::PhongIntegral;
use glam::DVec3;
pub use ridgelight::basis::light::slice;
pub use ridgelight::scene::normal;
use ridgelight::scene::{Albedo, Environment, KeyLight, Sun, Surface};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Least number of azimuths of [`environment_of`]: narrow images have several per column.
pub const ENVIRONMENT_STRIPS: usize = 512;

/// Albedo of a grid point.
pub(crate) fn albedo_at(surface: &Surface, grid_point: usize) -> Rgb {
    match &surface.albedo {
        Albedo::Constant(colour) => colour.map(f64::from),
        Albedo::Map(map) => map[grid_point].map(f64::from),
    }
}

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

    /// A lobe of unit integral about the mirror direction of the zenith, the map view's.
    pub fn specular_from_above(normal: DVec3, exponent: f64) -> Self {
        Self::specular(normal, DVec3::Z, exponent)
    }

    /// The same about the mirror direction of a unit `view`, towards the eye.
    pub fn specular(normal: DVec3, view: DVec3, exponent: f64) -> Self {
        Self { normal, phong_lobe: Some((mirrored(normal, view), exponent)) }
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
        let (sin, cos) = elevation_rad.sin_cos();
        let cosine = (self.a * cos + self.b * sin).max(0.0);
        match self.exponent {
            // 0 to the power of 0 would be light from behind.
            Some(n) if cosine > 0.0 => 0.5 * (n + 1.0) * cosine.powf(n),
            _ => cosine,
        }
    }

    /// Elevations at which the lobe is not negligible. Beyond the cosine c lies cⁿ⁺¹ of it. a cos ω + b sin ω is
    /// √(a² + b²) cos(ω - ω_0).
    fn phong_range(&self, exponent: f64) -> [f64; 2] {
        let least = LOBE.powf(1.0 / (exponent + 1.0));
        let across = (least / self.a.hypot(self.b)).min(1.0).acos();
        let middle = self.b.atan2(self.a);
        [middle - across, middle + across]
    }

    /// π times the weights' integral over elevations; the lobe's by Gauss' rule of 4 points in panels
    /// ([`panels_a_rad`]), within [`LOBE`].
    pub(crate) fn light(&self, low: f64, high: f64) -> f64 {
        let low = low.max(self.low);
        let Some(n) = self.exponent else { return slice(self.a, self.b, low, high) };
        let [least, most] = self.phong_range(n);
        let (low, high) = (low.max(least), high.min(most));
        if high <= low {
            return 0.0;
        }
        let panels = ((high - low) * panels_a_rad(n)).ceil();
        let half = 0.5 * (high - low) / panels;
        (0..panels as usize)
            .flat_map(|i| GAUSS_4.map(|(x, w)| (low + half * ((2 * i + 1) as f64 + x), w)))
            .map(|(elevation, weight)| half * weight * elevation.cos() * self.at(elevation))
            .sum()
    }
}

/// Share of a lobe that is left out, about its rim.
pub(crate) const LOBE: f64 = 1e-10;

/// Panels of a lobe: half as wide as it, 1/√(n + 1). Below the exponent 1 the rim is steep, and 24 keep the error of a sky at 1e-4.
fn panels_a_rad(exponent: f64) -> f64 {
    let wanted = 2.0 * (exponent + 1.0).sqrt();
    if exponent > 0.0 && exponent < 1.0 { wanted.max(24.0) } else { wanted }
}

/// The largest angle to the middle of a lobe at which it is not negligible.
pub(crate) fn phong_half_rad(exponent: f64) -> f64 {
    LOBE.powf(1.0 / (exponent + 1.0)).acos()
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
    [row, col]: [usize; 2],
    receiver: Receiver,
    azimuth_rad: f64,
) -> Slice {
    receiver.slice(azimuth_rad).above(oracle.elevation_rad(row, col, azimuth_rad))
}

/// Exit radiance under a uniform sky of radiance 1: (1/π)(2π/m) Σ of the slices to the zenith.
///
/// Azimuths are φ_k = 2πk/m. The sky continues below horizontal where the border is `open`.
pub fn sky_of(oracle: &Oracle, row: usize, col: usize, azimuths: usize) -> f64 {
    Site::of(oracle, [row, col], &diffuse_at(oracle, row, col)).sky(azimuths)[0]
}

/// Exit radiance under an environment, linear RGB: [`Site::environment`] with at least [`ENVIRONMENT_STRIPS`] azimuths.
pub fn environment_of(oracle: &Oracle, row: usize, col: usize, env: &Environment) -> Rgb {
    let parts = ENVIRONMENT_STRIPS.div_ceil(env.width());
    Site::of(oracle, [row, col], &diffuse_at(oracle, row, col)).environment(env, parts)[0]
}

/// Exit radiance under one sun, linear RGB: [`Site::sun`].
pub fn sun_of(oracle: &Oracle, row: usize, col: usize, sun: &Sun, strips: usize) -> Rgb {
    Site::of(oracle, [row, col], &diffuse_at(oracle, row, col)).sun(sun, strips)[0]
}

/// Exit radiance under a key light, linear RGB: [`Site::key`].
pub fn key_of(oracle: &Oracle, row: usize, col: usize, key: &KeyLight, strips: usize) -> Rgb {
    let share = Site::of(oracle, [row, col], &diffuse_at(oracle, row, col)).key(key, strips)[0];
    key.radiance.map(|l| share * f64::from(l))
}

/// The diffuse receiver of a grid point.
pub(crate) fn diffuse_at(oracle: &Oracle, row: usize, col: usize) -> [Receiver; 1] {
    [Receiver::diffuse(normal(oracle.field(), oracle.border(), row, col))]
}

/// Receivers at one grid point, which share its horizons.
#[derive(Clone, Copy)]
pub struct Site<'a> {
    pub(crate) oracle: &'a Oracle<'a>,
    pub(crate) place: [usize; 2],
    pub(crate) receivers: &'a [Receiver],
    maxima: Option<&'a Maxima>,
}

impl<'a> Site<'a> {
    /// At a row and column.
    pub fn of(oracle: &'a Oracle, place: [usize; 2], receivers: &'a [Receiver]) -> Self {
        Self { oracle, place, receivers, maxima: None }
    }

    /// The same. With maxima of the oracle's field, horizons are found in less time, with the same bits.
    pub(crate) fn skipping(self, maxima: Option<&'a Maxima>) -> Self {
        Self { maxima, ..self }
    }

    /// [`Oracle::elevation_rad`] along an azimuth. `first_cells` is 0 for the first azimuth; kept for an azimuth nearby, it saves
    /// time: see [`Maxima::elevation_rad`].
    pub(crate) fn horizon_rad(&self, azimuth_rad: f64, first_cells: &mut usize) -> f64 {
        let Self { oracle, place, .. } = *self;
        match self.maxima {
            Some(maxima) => maxima.elevation_rad(oracle, place, azimuth_rad, first_cells),
            None => oracle.elevation_rad(place[0], place[1], azimuth_rad),
        }
    }

    /// π times each receiver's light of radiance 1, of azimuths with their weights and the light's elevations there:
    /// these are clipped at the horizon exactly.
    fn sums(&self, strips: impl Iterator<Item = (f64, f64, [f64; 2])>) -> Vec<f64> {
        self.sums_by(strips, |_, slice, [low, high]| slice.light(low, high))
    }

    /// The same by another integral over elevations, of the receiver's index, its slice and the elevations.
    fn sums_by(
        &self,
        strips: impl Iterator<Item = (f64, f64, [f64; 2])>,
        light: impl Fn(usize, &Slice, [f64; 2]) -> f64,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; self.receivers.len()];
        let mut first_cells = 0;
        for (azimuth, weight, elevations) in strips {
            let horizon = self.horizon_rad(azimuth, &mut first_cells);
            for (i, (receiver, sum)) in self.receivers.iter().zip(&mut sums).enumerate() {
                *sum += weight * light(i, &receiver.slice(azimuth).above(horizon), elevations);
            }
        }
        sums
    }

    /// Tables of the receivers' lobes, `None` for diffuse ones.
    pub(crate) fn phong_integrals(&self) -> Vec<Option<PhongIntegral>> {
        let of = |receiver: &Receiver| receiver.phong_lobe.map(|(_, n)| PhongIntegral::of(n));
        self.receivers.iter().map(of).collect()
    }

    /// Light of a uniform sky of radiance 1: see [`sky_of`].
    pub fn sky(&self, azimuths: usize) -> Vec<f64> {
        self.sky_by(azimuths, &self.phong_integrals())
    }

    /// The same with given [`phong_integrals`](Self::phong_integrals) of the receivers.
    pub(crate) fn sky_by(&self, azimuths: usize, integrals: &[Option<PhongIntegral>]) -> Vec<f64> {
        let m = azimuths.max(1);
        let all = (0..m).map(|k| (TAU * k as f64 / m as f64, 1.0, [-FRAC_PI_2, FRAC_PI_2]));
        let sums = self.sums_by(all, |i, slice, elevations| match &integrals[i] {
            Some(integral) => integral.light(slice, elevations),
            None => slice.light(elevations[0], elevations[1]),
        });
        sums.iter().map(|sum| 2.0 / m as f64 * sum).collect()
    }

    /// Light of a key light of radiance 1: `strips` azimuths in the middles of equal parts of the light.
    ///
    /// Without occlusion, the rule over azimuths has an error of (width / strips)² / 24 of the contribution of the
    /// normal's horizontal part, and none for its vertical one.
    pub fn key(&self, key: &KeyLight, strips: usize) -> Vec<f64> {
        // f32 rounds 2π and π/2 up.
        let across = key.width_rad.min(TAU);
        let elevations = key.elevations_rad.map(|rad| rad.clamp(-FRAC_PI_2, FRAC_PI_2));
        let width = across / strips as f64;
        let azimuth = |i| key.azimuth_rad + width * (i as f64 + 0.5) - across / 2.0;
        let sums = self.sums((0..strips).map(|i| (azimuth(i), width, elevations)));
        sums.iter().map(|s| s / PI).collect()
    }

    /// Light of an environment, linear RGB: a sum over all its texels.
    ///
    /// One azimuth at the centre of each of `parts` equal parts of a column of texels (midpoint rule). In elevation
    /// each texel is clipped at the horizon exactly and integrated in closed form.
    pub fn environment(&self, env: &Environment, parts: usize) -> Vec<Rgb> {
        let (width, height) = (env.width(), env.height());
        let strips = width * parts;
        let mut sums = vec![[0.0; 3]; self.receivers.len()];
        let mut first_cells = 0;
        for strip in 0..strips {
            // Columns run clockwise from azimuth π; the rotation is counter-clockwise.
            let azimuth = PI - TAU * (strip as f64 + 0.5) / strips as f64 + env.rotation_rad();
            let horizon = self.horizon_rad(azimuth, &mut first_cells);
            for (receiver, sum) in self.receivers.iter().zip(&mut sums) {
                let lit = receiver.slice(azimuth).above(horizon);
                for texel_row in 0..height {
                    let high = FRAC_PI_2 - PI * texel_row as f64 / height as f64;
                    let low = FRAC_PI_2 - PI * (texel_row + 1) as f64 / height as f64;
                    if high <= lit.low {
                        break;
                    }
                    let light = lit.light(low, high);
                    let texel = env.texels()[texel_row * width + strip / parts];
                    (0..3).for_each(|c| sum[c] += f64::from(texel[c]) * light);
                }
            }
        }
        sums.iter().map(|sum| sum.map(|s| s * 2.0 / strips as f64)).collect()
    }

    /// Light of one sun, linear RGB.
    ///
    /// A disc of angular radius a and radiance L gives a surface that faces it L π sin²a, so L = irradiance / (π
    /// sin²a). `strips` azimuths across the disc. Diameter 0: a point, dark where its elevation is not above the
    /// horizon.
    pub fn sun(&self, sun: &Sun, strips: usize) -> Vec<Rgb> {
        // f32 rounds π/2 up.
        let [elevation_rad, diameter_rad] =
            [sun.elevation_rad, sun.diameter_rad].map(|rad| rad.min(FRAC_PI_2));
        let sun = &Sun { elevation_rad, diameter_rad, ..*sun };
        let radius = 0.5 * sun.diameter_rad;
        let shares = if radius > 0.0 {
            let mut disc = self.disc(sun, strips.max(1));
            disc.iter_mut().for_each(|d| *d /= PI * radius.sin().powi(2));
            disc
        } else {
            let at = |r: &Receiver| lit(self.oracle, self.place, *r, sun.azimuth_rad);
            self.receivers.iter().map(|r| at(r).at(sun.elevation_rad)).collect()
        };
        shares.iter().map(|share| sun.irradiance.map(|e| f64::from(e) * share / PI)).collect()
    }

    /// ∫ V max(N·e, 0) de over the sun's disc (for a Phong lobe, π times its weights' integral).
    ///
    /// At azimuth δ from the centre's, a direction of elevation ω is within a of the centre (elevation s) when sin ω
    /// sin s + cos ω cos s cos δ = R cos(ω - ω_m) ≥ cos a, with R² = sin²s + cos²s cos²δ and tan ω_m = sin s / (cos s
    /// cos δ). The half chord w has sin²w = 1 - cos²a/R² = (sin²a - cos²s sin²δ) / R². A disc that holds the zenith is
    /// met along every azimuth; another one up to sin δ = sin a / cos s, where δ = δ_max sin u makes the chord's
    /// square root smooth and the midpoint rule in u quick.
    fn disc(&self, sun: &Sun, strips: usize) -> Vec<f64> {
        let radius = 0.5 * sun.diameter_rad;
        let (sin_s, cos_s) = sun.elevation_rad.sin_cos();
        let sin_a = radius.sin();
        let holds_zenith = sun.elevation_rad + radius >= FRAC_PI_2;
        let widest = if holds_zenith { PI } else { (sin_a / cos_s).min(1.0).asin() };
        self.sums((0..strips).filter_map(|i| {
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
            let half = (squared.max(0.0).sqrt() / reach).min(1.0).asin();
            let middle = sin_s.atan2(cos_s * cos_d);
            let ends = [middle - half, (middle + half).min(FRAC_PI_2)];
            (squared > 0.0).then_some((sun.azimuth_rad + offset, weight, ends))
        }))
    }
}
