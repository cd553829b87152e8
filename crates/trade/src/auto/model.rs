//! Expected errors and costs of settings: a first guess from fitted numbers, corrected by every
//! measured frame.

use super::bounced::{self, BouncedLight};
use super::fitted::{FITTED, GEOMETRY};
use super::residuals::{Residual, Residuals};
use super::statistics::Statistics;
use ridgelight::scene::{Fuse, Lines, Method, Quality, Scene};

/// Logarithms of a scene's statistics, the features of the fit.
pub const FEATURES: usize = 8;

/// A part of the error, caused by one kind of setting. Their squares add up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Horizons: lines and fuse.
    Geometry,
    /// Azimuths: of sky and environment.
    Azimuths,
    /// Elevations of an environment's table.
    Table,
    /// Slices of a sun's disc, of a key light or of a sphere light.
    Strips,
}

/// All parts, in the order of the fit.
pub const PARTS: [Part; 4] = [Part::Geometry, Part::Azimuths, Part::Table, Part::Strips];

/// ln error = bias + weights · features - power · ln(setting / its value in the fit). The fit used 64 azimuths,
/// `aimed-nearest` and otherwise the defaults.
pub(super) struct Fitted {
    pub bias: f64,
    pub weights: [f64; FEATURES],
    pub power: f64,
    /// Standard deviation of the residual, in ln.
    pub spread: f64,
}

impl Part {
    /// ln of a setting's fineness relative to the fit, in the part's own measure. ln of the
    /// error falls by this times a fitted power.
    pub fn fineness(self, quality: &Quality) -> f64 {
        let finer = |value: u32, fitted: u32| (f64::from(value) / f64::from(fitted)).ln();
        match self {
            Part::Geometry => {
                if quality.method == Method::Auto {
                    // Suns have exact shadows, and of all direct light they err most.
                    return EXACT_FINENESS;
                }
                let table = GEOMETRY[fuse_row(quality.fuse)];
                table.get(spacing(quality)).map_or(EXACT_FINENESS, |ln| -ln)
            }
            Part::Azimuths => finer(quality.azimuths, 64),
            Part::Table => finer(quality.table_elevations, 256),
            Part::Strips => finer(quality.sun_azimuths, 8),
        }
    }

    /// Whether a scene has this part.
    pub fn is_in(self, scene: &Scene) -> bool {
        let lights = &scene.lights;
        match self {
            Part::Geometry => {
                let are_none_aimed = lights.suns.is_empty() && lights.keys.is_empty();
                Part::Azimuths.is_in(scene) || !are_none_aimed || lights.near().next().is_none()
            }
            Part::Azimuths => {
                lights.sky.is_some_and(|s| s != [0.0; 3]) || lights.environment.is_some()
            }
            Part::Table => lights.environment.is_some(),
            Part::Strips => crate::trade::have_slices(lights),
        }
    }
}

/// For exact horizons: what f32 leaves of the geometry's error, e⁻¹².
const EXACT_FINENESS: f64 = 12.0;

/// Index of a fuse among the candidates.
pub(super) fn fuse_row(fuse: Fuse) -> usize {
    match fuse {
        Fuse::Aimed => 1,
        Fuse::AimedAround => 2,
        _ => 0,
    }
}

/// Index of the line spacing, from 4 cells to a quarter; then exact horizons.
pub(super) fn spacing(quality: &Quality) -> usize {
    match quality.lines {
        _ if quality.method == Method::BruteForce => 5,
        Lines::FourCells => 0,
        Lines::TwoCells => 1,
        Lines::Cell => 2,
        Lines::HalfCell => 3,
        Lines::QuarterCell => 4,
        Lines::Exact => 5,
    }
}

/// Expected error of settings that were not measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Relative RMSE.
    pub error: f64,
    /// A standard deviation in ln, as a factor of at least 1. Before any measurement it is that of
    /// the fitted scenes, which underestimates that of others.
    pub factor: f64,
}

/// Parts of direct light, then those of bounces.
const ALL: usize = PARTS.len() + bounced::PARTS;

/// Errors by settings: each part's ln with its variance, an iterated extended Kalman filter over
/// frames.
#[derive(Clone, Debug)]
pub struct Model {
    /// ln of each part at the settings of the fit, none where the scene does not have it.
    logs: [Option<f64>; ALL],
    covariance: [[f64; ALL]; ALL],
    bounced: Option<BouncedLight>,
    /// Measured settings, and ln of their errors with its variance, in the order of calls of [`learn`](Self::learn).
    measured: Vec<(Quality, f64, f64)>,
    residuals: Residuals,
}

impl Model {
    /// The fitted guess for a scene with this many bounces.
    pub fn of(scene: &Scene, statistics: &Statistics, bounces: u32) -> Self {
        let features = statistics.features();
        let bounced = (bounces > 0).then(|| BouncedLight::of(scene, statistics));
        // No scene of the fit has specular: a factor e more.
        let unfitted = if scene.surface.specular.is_some() { 1.0 } else { 0.0_f64 };
        let mut model = Self {
            logs: [None; ALL],
            covariance: [[0.0; ALL]; ALL],
            bounced,
            measured: Vec::new(),
            residuals: Residuals::default(),
        };
        for (i, (log, spread)) in bounced.iter().flat_map(BouncedLight::guess).enumerate() {
            model.logs[PARTS.len() + i] = Some(log);
            model.covariance[PARTS.len() + i][PARTS.len() + i] = spread.powi(2);
        }
        for (i, (part, fitted)) in PARTS.iter().zip(&FITTED).enumerate() {
            if part.is_in(scene) {
                let sum: f64 = fitted.weights.iter().zip(features).map(|(w, x)| w * x).sum();
                // No part was measured beyond these: a guess outside them extrapolates the fit.
                model.logs[i] = Some((fitted.bias + sum).clamp(1e-6_f64.ln(), 0.0));
                model.covariance[i][i] = fitted.spread.powi(2) + unfitted.powi(2);
            }
        }
        model
    }

    /// Squares of the parts.
    fn squares(&self, quality: &Quality) -> [f64; ALL] {
        let mut squares = [0.0; ALL];
        for (i, (part, fitted)) in PARTS.iter().zip(&FITTED).enumerate() {
            if let Some(log) = self.logs[i] {
                squares[i] = (2.0 * (log - fitted.power * part.fineness(quality))).exp();
            }
        }
        let bounced = self.bounced.iter().flat_map(|b| b.factors(quality)).enumerate();
        for (i, factor) in bounced.map(|(i, f)| (PARTS.len() + i, f)) {
            squares[i] = (self.log(i).exp() * factor).powi(2);
        }
        squares
    }

    /// ∂ ln error / ∂ ln part: each part's share of the square; and the square.
    fn shares(&self, quality: &Quality) -> ([f64; ALL], f64) {
        let squares = self.squares(quality);
        let sum = squares.iter().sum::<f64>();
        (squares.map(|s| s / sum), sum)
    }

    /// Variance of ln error, and covariance of it with each part's ln.
    fn variance(&self, shares: &[f64; ALL]) -> (f64, [f64; ALL]) {
        let with = self.covariance.map(|row| row.iter().zip(shares).map(|(c, s)| c * s).sum());
        (with.iter().zip(shares).map(|(c, s): (&f64, &f64)| c * s).sum(), with)
    }

    /// Expected error of settings.
    pub fn expected(&self, quality: &Quality) -> Expected {
        let (shares, sum) = self.shares(quality);
        let error = sum.sqrt() * self.residuals.at(quality).exp();
        Expected { error, factor: self.variance(&shares).0.max(0.0).sqrt().exp() }
    }

    /// Adds a measured relative RMSE; `spread` is the standard deviation of its ln.
    ///
    /// The parts' ln θ move to θ₀ + K (ln measured - ln expected(θ) - hᵀ(θ₀ - θ)) with K = P h /
    /// (hᵀP h + R), h the shares at θ, recomputed until θ converges (the iterated extended Kalman
    /// filter, Bell & Cathey 1993; with halved steps, as one step overshoots where a small part
    /// becomes the largest). P falls by K hᵀP. Below 1e-6 f32 frames do not resolve errors.
    pub fn learn(&mut self, quality: &Quality, error: f64, spread: f64) {
        let before = self.logs;
        let measured = error.max(1e-6).ln();
        // Squares of parts with fitted powers have an error of about a tenth themselves.
        let noise = spread.powi(2) + 0.1_f64.powi(2);
        for _ in 0..STEPS {
            let (shares, sum) = self.shares(quality);
            let (variance, with) = self.variance(&shares);
            let moved = (0..ALL).map(|i| shares[i] * (before[i].unwrap_or(0.0) - self.log(i)));
            let residual = measured - 0.5 * sum.ln() - moved.sum::<f64>();
            for i in 0..ALL {
                if let (Some(log), Some(first)) = (&mut self.logs[i], before[i]) {
                    let to = first + with[i] / (variance + noise) * residual;
                    *log += 0.5 * (to - *log);
                }
            }
        }
        let (shares, _) = self.shares(quality);
        let (variance, with) = self.variance(&shares);
        for i in 0..ALL {
            for j in 0..ALL {
                self.covariance[i][j] -= with[i] * with[j] / (variance + noise);
            }
        }
        self.measured.push((*quality, measured, spread.powi(2)));
    }

    /// Fits the residuals of the measured errors, so that [`expected`](Self::expected) corrects similar settings.
    pub fn share_residuals(&mut self) {
        let of = |(quality, ln, noise): &(Quality, f64, f64)| Residual {
            quality: *quality,
            ln: ln - 0.5 * self.shares(quality).1.ln(),
            noise: *noise,
        };
        self.residuals = Residuals::of(&self.measured.iter().map(of).collect::<Vec<_>>());
    }

    fn log(&self, part: usize) -> f64 {
        self.logs[part].unwrap_or(0.0)
    }
}

/// Of the filter: halvings of a step, 2⁻²⁰ of which is negligible.
const STEPS: usize = 20;

/// Nanoseconds of each kind of pass: an overhead, and a time per unit of its work.
///
/// Work is proportional to azimuths. Relative costs by spacing and fuse are lavapipe's (README's
/// tables of accuracy and of forms, ms per azimuth and megatexel); measured frames set each kind's
/// scale.
#[derive(Clone, Debug)]
pub struct Costs {
    units_ns: [f64; KINDS],
    /// Of a frame with any such work.
    overheads_ns: [f64; KINDS],
    /// Work and nanoseconds of all frames.
    measured: [Vec<[f64; 2]>; KINDS],
}

/// Sweeps along lines, exact horizons, shading, tables, sphere lights, all else; bounces by each
/// engine.
const KINDS: usize = 6 + bounced::ENGINES.len();

const SWEEP: [f64; 5] = [0.9, 1.65, 2.15, 6.3, 12.7];
/// Lines through all grid points: the more azimuths per side, the longer the grid vectors near them
/// and the shorter the lines. Second: proportional to azimuths over side.
const EXACT: [f64; 2] = [130.0, 480.0];
/// Proportional to the side.
const BRUTE: f64 = 4.7;
const SHADE: [[f64; 6]; 3] = [
    [2.16, 2.16, 2.46, 2.91, 4.22, 2.12],
    [3.2, 3.35, 3.39, 3.97, 5.35, 2.12],
    // 4.1 times those of aimed-nearest: `bench assets/mt_washington_256.png --sky 1 --method sweep` with each, 2026-11-28.
    [8.9, 8.9, 10.1, 11.9, 17.3, 2.12],
];
/// A slice of a sphere light, on a fractal field of 512².
const SLICE: f64 = 200.0;

impl Costs {
    /// lavapipe's costs, before any measurement, for this many texels.
    pub fn guessed(grid_points: usize) -> Self {
        let grid_points = grid_points as f64;
        // Tables: README's 2.2 ms for 64 azimuths of 512 elevations.
        let [one, table, other] = [[grid_points; 3], [67.0, grid_points, 0.0], [grid_points; 3]];
        let units_ns = [one, table, other].as_flattened().try_into().expect("nine kinds");
        Self { units_ns, overheads_ns: [0.0; KINDS], measured: Default::default() }
    }

    fn work(scene: &Scene, quality: &Quality) -> [f64; KINDS] {
        let circle = if Part::Azimuths.is_in(scene) { quality.azimuths } else { 0 };
        let suns = scene.lights.suns.iter();
        let discs: u32 = suns.map(|s| if s.is_point() { 1 } else { quality.sun_azimuths }).sum();
        let keys: u32 = scene.lights.keys.iter().map(|k| k.slices(quality.sun_azimuths)).sum();
        let all = f64::from(circle + discs + keys);
        let table = match &scene.lights.environment {
            Some(_) => f64::from(circle) * f64::from(quality.table_elevations),
            None => 0.0,
        };
        let spacing = spacing(quality);
        let side = scene.field.rows().max(scene.field.cols()) as f64;
        let [sweep, exact] = match SWEEP.get(spacing) {
            Some(each) => [*each, 0.0],
            None if quality.method == Method::BruteForce => [0.0, BRUTE * side],
            None => [0.0, EXACT[0] + EXACT[1] * all / side],
        };
        let shade = SHADE[fuse_row(quality.fuse)][spacing];
        let sphere_slices = f64::from(quality.sun_azimuths) * scene.lights.near().count() as f64;
        let [walk, march, gather] = bounced::work(scene, quality);
        let [sweep, exact] = [sweep, exact].map(|each| all * each);
        // Exact shadows of suns do not depend on the fuse.
        let has_exact = quality.method == Method::Auto;
        let of_discs = if has_exact { SHADE[0][spacing] } else { shade };
        let shade = f64::from(circle + keys) * shade + f64::from(discs) * of_discs;
        [sweep, exact, shade, table, sphere_slices * SLICE, 1.0, walk, march, gather]
    }

    /// Expected nanoseconds of a frame.
    pub fn expected_ns(&self, scene: &Scene, quality: &Quality) -> f64 {
        let work = Self::work(scene, quality);
        let each = work.iter().zip(self.overheads_ns).zip(self.units_ns);
        each.filter(|((w, _), _)| **w > 0.0).map(|((w, overhead), unit)| overhead + w * unit).sum()
    }

    /// Adds a measured frame: nanoseconds by pass label.
    pub fn learn(&mut self, scene: &Scene, quality: &Quality, passes: &[(String, f64)]) {
        let mut sums = [0.0; KINDS];
        let engine = bounced::engine(quality);
        let engine_kind = bounced::ENGINES.iter().position(|e| *e == engine).unwrap_or(0);
        for (label, ns) in passes {
            let kind = match label.split([' ', '.']).next().unwrap_or_default() {
                _ if label.contains("bounce") => 6 + engine_kind,
                "horizon_sweep" | "shadow_sweep" | "sweep_fuse" => 0,
                "surface_sweep" | "horizon_march" => 1,
                "sky_shade" | "sun_shade" | "shadow_shade" | "shadow_settle" => 2,
                "env_tables" => 3,
                "sphere_shade" => 4,
                _ => 5,
            };
            sums[kind] += ns;
        }
        for (kind, work) in Self::work(scene, quality).into_iter().enumerate() {
            if work > 0.0 {
                self.measured[kind].push([work, sums[kind]]);
                [self.overheads_ns[kind], self.units_ns[kind]] = line(&self.measured[kind]);
            }
        }
    }
}

/// Shorter times are as uncertain: a microsecond, some devices' timestamp period.
const TICK_NS: f64 = 1e3;

/// [a, b] of y ≈ a + b x with the least squares of relative errors, neither below 0: a negative one
/// is set to 0. For a single x, b takes everything.
fn line(points: &[[f64; 2]]) -> [f64; 2] {
    let (mut s, mut sx, mut sxx, mut sy, mut sxy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for [x, y] in points {
        let weight = y.max(TICK_NS).powi(-2);
        s += weight;
        sx += weight * x;
        sxx += weight * x * x;
        sy += weight * y;
        sxy += weight * x * y;
    }
    let spread = s * sxx - sx * sx;
    // Rounding leaves some 1e-16 of one x.
    if spread <= 1e-9 * s * sxx {
        return [0.0, sxy / sxx];
    }
    match [(sxx * sy - sx * sxy) / spread, (s * sxy - sx * sy) / spread] {
        [a, _] if a < 0.0 => [0.0, sxy / sxx],
        [_, b] if b < 0.0 => [sy / s, 0.0],
        free => free,
    }
}
