use super::oracle_light::{OracleLight, Rays};
use super::picks::{even_picks, picks, usable_sum};
use ridgelight::plan::max_path_light;
use ridgelight::scene::{Border, Scene};
use ridgelight::{Error, Result};
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::oracle::PERIOD_CAP;

/// Probes: as many as [`CELLS`] allow, within these.
const MIN_PROBES: usize = 64;
const MOST: usize = 1000;
/// Cells that the oracle's rays may cross: some seconds of one core.
const CELLS: usize = 1 << 29;
/// Share of the light that counts as unsure beside specular.
const SPECULAR_DOUBT: f64 = 0.02;
/// Cost of one read from the table of Phong specular, in crossed cells. A read takes less time than this. Under an
/// environment every texel of a lobe is a read: the higher cost leaves fewer probes, so the choice takes seconds.
const POINT_CELLS: usize = 8;
/// Probes that measure the oracle's own error.
const SELF_PROBES: usize = 64;
/// Radius about a difference of pictures, in texels, within which other settings' errors are
/// expected: a shadow of 40 cells moves its edge by this much for the 3° of 64 azimuths.
const REACH: usize = 2;

/// Texels spread over a field, and their radiance by the f64 oracle.
#[derive(Clone, Debug)]
pub struct Probes {
    is_whole: bool,
    places: Vec<usize>,
    /// 1 / (count · probability of the texel): 1 where all have the same probability.
    factors: Vec<f64>,
    light: Vec<[f64; 3]>,
    /// Variance of the path-traced part, mean of the channels; 0 without bounces.
    noise: Vec<f64>,
    /// Root mean square error of the oracle: its difference to half its rays, and unsampled light.
    own_rms: f64,
}

/// Path-traced bounced light of a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traced {
    /// Exit radiance, linear RGB, after at least one earlier reflection.
    pub mean: [f64; 3],
    /// Of the mean, from independent batches of paths.
    pub standard_error: [f64; 3],
}

/// A relative RMSE measured at probes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The estimate: RMSE over all texels and channels, over the mean of the ground truth.
    pub error: f64,
    /// Upper bound: see [`Probes::error`].
    pub at_most: f64,
}

impl Measured {
    /// Not yet measured, or with values beyond f32.
    pub(super) const UNKNOWN: Self = Self { error: f64::INFINITY, at_most: f64::INFINITY };
}

/// Texels without void, by row-major index.
fn known(scene: &Scene) -> Result<Vec<usize>> {
    let field = &scene.field;
    let known: Vec<usize> =
        (0..field.rows() * field.cols()).filter(|i| field.voids().is_none_or(|v| !v[*i])).collect();
    if known.is_empty() {
        return Err(Error::setting("field", "voids only", "at least one height"));
    }
    Ok(known)
}

/// The weights of known texels, for [`picks`].
fn weights(known: &[usize], unsure: &[f64]) -> Vec<f64> {
    known.iter().map(|i| unsure.get(*i).copied().unwrap_or(0.0)).collect()
}

/// A mean square with its bound, and the mean of the ground truth.
#[derive(Clone, Copy)]
struct Square {
    estimate: f64,
    at_most: f64,
    mean: f64,
}

impl Probes {
    /// One-sided, by the normal approximation of a mean of 64 or more, corrected for its skewness
    /// (Chen 1995).
    pub const CONFIDENCE: f64 = 0.95;

    /// Standard normal deviate with 5 % beyond: for a single bound.
    pub const ONE_BOUND: f64 = 1.645;

    /// With 5 %/4 beyond: four bounds hold together with [`CONFIDENCE`](Self::CONFIDENCE)
    /// (Bonferroni).
    pub const FOUR_BOUNDS: f64 = 2.241;

    /// With 5 %/8 beyond: with bounces each of four bounds may fail by its probes or by unsampled
    /// light ([`UNSAMPLED_PROBABILITY`](Self::UNSAMPLED_PROBABILITY)), so eight bounds hold
    /// together.
    pub const EIGHT_BOUNDS: f64 = 2.498;

    /// Probability that more light is unsampled than estimated, for one of four bounds: the other 5
    /// %/8.
    pub const UNSAMPLED_PROBABILITY: f64 = (1.0 - Self::CONFIDENCE) / 8.0;

    /// `wanted` texels without void, or all. The same `seed`, count and probabilities give the same
    /// texels. Runs on all cores.
    ///
    /// `unsure`, where errors are expected ([`unsure`]), directs two thirds of the probes
    /// to where errors are: few texels at shadow edges have nearly all of the error. Empty:
    /// uniform.
    ///
    /// # Errors
    /// A field of voids only.
    pub fn of(lit: &Lit<'_>, wanted: usize, seed: u64, unsure: &[f64]) -> Result<Self> {
        OracleLight::with(lit, |oracle| Self::by(oracle, wanted, seed, unsure))
    }

    /// The same, with an oracle that keeps the light of earlier probes.
    pub(super) fn by(
        oracle: &OracleLight<'_>,
        wanted: usize,
        seed: u64,
        unsure: &[f64],
    ) -> Result<Self> {
        let known = known(oracle.scene())?;
        let (picks, factors) = picks(&weights(&known, unsure), wanted, seed);
        let places: Vec<usize> = picks.into_iter().map(|k| known[k]).collect();
        let light = oracle.light(&places, Rays::All);
        let stride = places.len().div_ceil(SELF_PROBES);
        let some: Vec<usize> = places.iter().copied().step_by(stride).collect();
        let halves = oracle.light(&some, Rays::Half);
        let squares = halves.iter().enumerate().map(|(i, half)| {
            let whole = light[i * stride];
            let square: f64 = half.iter().zip(whole).map(|(h, w)| (h - w).powi(2) / 3.0).sum();
            factors[i * stride] * square
        });
        let own_rms = (squares.sum::<f64>() / some.len() as f64).sqrt();
        let noise = vec![0.0; places.len()];
        Ok(Self { is_whole: places.len() == known.len(), places, factors, light, noise, own_rms })
    }

    /// Starts to compute the light of the texels of [`by`](Self::by). Before `unsure` is known, only of those that do not
    /// depend on it.
    ///
    /// # Errors
    /// Those of [`by`](Self::by).
    pub(super) fn request(
        oracle: &OracleLight<'_>,
        wanted: usize,
        seed: u64,
        unsure: Option<&[f64]>,
    ) -> Result<()> {
        let known = known(oracle.scene())?;
        let picks = match unsure {
            Some(unsure) => picks(&weights(&known, unsure), wanted, seed).0,
            None => even_picks(known.len(), wanted, seed),
        };
        let places: Vec<usize> = picks.into_iter().map(|k| known[k]).collect();
        oracle.request(&places, Rays::All);
        // The first texels are the same, so every `stride`-th is, too.
        let stride = wanted.min(known.len()).div_ceil(SELF_PROBES).max(1);
        let some: Vec<usize> = places.into_iter().step_by(stride).collect();
        oracle.request(&some, Rays::Half);
        Ok(())
    }

    /// Row-major indices of the texels; some may occur twice.
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    /// Adds path-traced bounced light to the oracle's. `unsampled` is the root mean square error of
    /// each channel from light that no path has sampled.
    ///
    /// # Panics
    /// Another number of texels.
    pub fn add_bounced(&mut self, traced: &[Traced], unsampled: [f64; 3]) {
        assert_eq!(traced.len(), self.count(), "one per probe");
        for ((light, noise), more) in self.light.iter_mut().zip(&mut self.noise).zip(traced) {
            light.iter_mut().zip(more.mean).for_each(|(l, m)| *l += m);
            *noise += more.standard_error.iter().map(|e| e * e).sum::<f64>() / 3.0;
        }
        let unsampled = unsampled.iter().map(|u| u * u).sum::<f64>() / 3.0;
        self.own_rms = (self.own_rms.powi(2) + unsampled).sqrt();
    }

    /// Relative RMSE that Monte Carlo noise alone may add to the bound, at this many `deviations`,
    /// for a picture with a uniform relative `error`. The bound is the root of the sum of both
    /// squares. For `count` probes like these, whose paths leave a `share` of these probes'
    /// variance.
    pub fn path_noise(&self, error: f64, share: f64, count: usize, deviations: f64) -> f64 {
        let square = (error * self.mean()).powi(2);
        let each = self.noise.iter().zip(&self.factors);
        let sum: f64 = each.map(|(n, f)| f.powi(2) * noise_variance(square, share * n)).sum();
        self.relative(deviations * (sum / self.count() as f64 / count as f64).sqrt())
    }

    /// Mean radiance.
    fn mean(&self) -> f64 {
        let each = self.light.iter().zip(&self.factors);
        let sum: f64 = each.map(|(l, f)| f * l.iter().sum::<f64>() / 3.0).sum();
        (sum / self.count() as f64).abs()
    }

    /// The root of a mean square over the mean radiance.
    fn relative(&self, square: f64) -> f64 {
        if square == 0.0 { 0.0 } else { square.sqrt() / self.mean() }
    }

    /// Adds probes of another seed and the same `unsure`; nothing where all texels are known.
    pub fn extend(&mut self, others: &Self) {
        if self.is_whole {
            return;
        }
        if others.is_whole {
            *self = others.clone();
            return;
        }
        let [own, more] = [self.count(), others.count()].map(|n| n as f64);
        self.own_rms =
            ((own * self.own_rms.powi(2) + more * others.own_rms.powi(2)) / (own + more)).sqrt();
        self.places.extend(&others.places);
        self.factors.extend(&others.factors);
        self.light.extend(&others.light);
        self.noise.extend(&others.noise);
    }

    /// Number of probes for some seconds of one core: 64 to 1000, fewer for larger fields.
    pub fn affordable(lit: &Lit<'_>) -> usize {
        let scene = lit.scene();
        let side = scene.field.rows().max(scene.field.cols());
        // Rays over a periodic field may continue through that many periods.
        let periods = if scene.surface.border == Border::Periodic { PERIOD_CAP } else { 1 };
        let cells = lit.rays() * side * periods + POINT_CELLS * lit.specular_points();
        (CELLS / cells.max(1)).clamp(MIN_PROBES, MOST)
    }

    /// The oracle's own error, over the mean radiance.
    pub fn own_error(&self) -> f64 {
        self.relative(self.own_rms.powi(2))
    }

    /// The part of the own error that [`add_bounced`](Self::add_bounced) has added since the `same`
    /// probes: unsampled light, over the mean radiance.
    pub(super) fn unsampled_error(&self, same: &Self) -> f64 {
        // Below 0 by rounding only: both are sums of squares.
        self.relative((self.own_rms.powi(2) - same.own_rms.powi(2)).max(0.0))
    }

    /// Number of probes, 1 or more.
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// Whether they are all texels without void.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// The relative RMSE of a picture: planes of one or three channels, row-major, NaN at voids.
    /// Its bound lies `deviations` standard deviations above, plus the oracle's own error: its
    /// difference to half its rays, as errors fall at least in proportion to their number.
    ///
    /// A `control` is a better picture of the same scene, known at all texels. With T, C and L for
    /// picture, control and ground truth, mean (T-L)² = mean of (T-C)² over all texels + mean of
    /// (T-L)² - (T-C)² over the probes (the difference estimator, Cochran 1977 §7.9 with slope 1),
    /// each weighted by its probability (Hansen & Hurwitz 1943). The closer the control is to the
    /// ground truth, the smaller the sampling error. The picture is its own control where none is
    /// given, where the probes find the control worse, or where the sum, a difference, is not
    /// positive.
    ///
    /// Path-traced bounced light makes L noisy. Its variance is subtracted from (T-L)²: the mean is
    /// unbiased, its spread over the probes is in the bound, and an estimate below 0 is reported as
    /// 0.
    pub fn error(
        &self,
        picture: &[Vec<f32>],
        control: Option<&[Vec<f32>]>,
        deviations: f64,
    ) -> Measured {
        let own = self.square(picture, picture, deviations);
        let better = control.map(|c| (c, self.square(c, c, deviations)));
        let better = better.filter(|(_, of_control)| of_control.estimate <= own.estimate);
        let square = better.map(|(c, _)| self.square(picture, c, deviations));
        let square = square.filter(|s| s.estimate > 0.0).unwrap_or(own);
        let relative = |s: f64| if s == 0.0 { 0.0 } else { s.sqrt() / square.mean };
        let own = relative(self.own_rms.powi(2));
        let [error, at_most] = [square.estimate, square.at_most].map(|s| relative(s.max(0.0)));
        let measured = Measured { error, at_most: at_most + own };
        // Nothing is known of a picture with values beyond f32.
        if measured.at_most.is_finite() { measured } else { Measured::UNKNOWN }
    }

    fn square(&self, picture: &[Vec<f32>], control: &[Vec<f32>], deviations: f64) -> Square {
        let at =
            |planes: &[Vec<f32>], c: usize, i: usize| f64::from(planes[c.min(planes.len() - 1)][i]);
        let (mut squares, mut sum, mut values) = (0.0, 0.0, 0.0_f64);
        let all = (0..3).flat_map(|c| (0..picture[0].len()).map(move |i| (c, i)));
        let both = all.map(|(c, i)| (at(picture, c, i), at(control, c, i)));
        for (t, k) in both.filter(|(_, k)| !k.is_nan()) {
            squares += (t - k).powi(2);
            sum += k;
            values += 1.0;
        }
        let count = self.places.len() as f64;
        let (mut rest, mut shift, mut path_variance) = (Vec::new(), 0.0, 0.0);
        let lights = self.light.iter().zip(&self.noise);
        for ((i, factor), (light, noise)) in self.places.iter().zip(&self.factors).zip(lights) {
            let (mut square, mut of_control) = (-noise, 0.0);
            for (c, l) in light.iter().enumerate() {
                let (t, k) = (at(picture, c, *i), at(control, c, *i));
                square += (t - l).powi(2) / 3.0;
                of_control += (t - k).powi(2) / 3.0;
                shift += factor * (l - k) / (3.0 * count);
            }
            rest.push(factor * (square - of_control));
            path_variance += factor.powi(2) * self::noise_variance(square.max(0.0), *noise);
        }
        let mean_rest = rest.iter().sum::<f64>() / count;
        let variance =
            rest.iter().map(|r| (r - mean_rest).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
        // Where every texel is a probe only the path tracing is random.
        let variance = if self.is_whole { path_variance / count } else { variance };
        let deviation = (variance / count).sqrt();
        let cubes = rest.iter().map(|r| (r - mean_rest).powi(3)).sum::<f64>() / count;
        let is_spread = variance > 0.0 && !self.is_whole;
        let skew = if is_spread { cubes / variance.powf(1.5) } else { 0.0 };
        let estimate = squares / values.max(1.0) + mean_rest;
        let mean = (sum / values.max(1.0) + shift).abs();
        let quantile = quantile(deviations, skew, count);
        Square { estimate, at_most: estimate + quantile * deviation, mean }
    }
}

/// Variance of (d + ε)² - s², for d² and the variance of ε, of fully correlated channels: 4 d² ε² +
/// 2 ε⁴, and 2 ε⁴ of s², its estimate, as two batches leave it.
fn noise_variance(square: f64, noise: f64) -> f64 {
    4.0 * (square * noise + noise.powi(2))
}

/// Standard deviations from a mean of `count` values to its bound: z, more for a skewed
/// distribution (Chen 1995, eq. for upper-tailed tests of positively skewed means).
fn quantile(z: f64, skew: f64, count: f64) -> f64 {
    let a = skew.max(0.0) / (6.0 * count.sqrt());
    z + a * (1.0 + 2.0 * z * z) + 4.0 * a * a * (z + 2.0 * z.powi(3))
}

/// Where errors are expected. The weight of a texel is the largest difference between a picture and a coarser one within 2 texels.
/// Beside specular it grows in proportion to the light, as suns' highlights and tables of the lobe have errors that two
/// pictures share. With a `fine` picture, its difference from the first at the texel itself is added, scaled to the same sum: under
/// a small bright light, ten of 16,384 texels can hold nearly all of the error of fine settings, while a coarse picture
/// differs nearly everywhere.
pub fn unsure(
    scene: &Scene,
    [picture, coarse]: [&[Vec<f32>]; 2],
    fine: Option<&[Vec<f32>]>,
) -> Vec<f64> {
    let mut unsure = apart(picture, coarse, scene.field.cols());
    if scene.surface.specular.is_some() {
        let last = picture.len() - 1;
        for (i, unsure) in unsure.iter_mut().enumerate() {
            let light = (0..3).map(|c| f64::from(picture[c.min(last)][i])).sum::<f64>();
            // Voids are NaN.
            *unsure += if light.is_finite() { SPECULAR_DOUBT * light.abs() } else { 0.0 };
        }
    }
    let Some(more) = fine.map(|fine| differences(picture, fine)) else { return unsure };
    match (usable_sum(&unsure), usable_sum(&more)) {
        (Some(sum), Some(of_more)) => {
            unsure.iter_mut().zip(more).for_each(|(u, m)| *u += m * sum / of_more);
            unsure
        }
        (None, Some(_)) if unsure.iter().all(|u| *u == 0.0) => more,
        _ => unsure,
    }
}

/// Difference of two pictures at each texel, over the channels; 0 at voids.
fn differences(a: &[Vec<f32>], b: &[Vec<f32>]) -> Vec<f64> {
    let last = |planes: &[Vec<f32>], c: usize, i: usize| planes[c.min(planes.len() - 1)][i];
    (0..a[0].len())
        .map(|i| (0..3).map(|c| f64::from((last(a, c, i) - last(b, c, i)).abs())).sum::<f64>())
        // Voids are NaN.
        .map(|d| if d.is_nan() { 0.0 } else { d })
        .collect()
}

/// Difference of two pictures at each texel, the largest within 2 texels.
pub fn apart(a: &[Vec<f32>], b: &[Vec<f32>], cols: usize) -> Vec<f64> {
    let count = a[0].len();
    let differences = differences(a, b);
    let farthest = |values: &[f64], i: usize, at: usize, length: usize, stride: usize| {
        let (from, to) = (at.saturating_sub(REACH), (at + REACH).min(length - 1));
        (from..=to).map(|j| values[i - at * stride + j * stride]).fold(0.0, f64::max)
    };
    let along: Vec<f64> =
        (0..count).map(|i| farthest(&differences, i, i % cols, cols, 1)).collect();
    (0..count).map(|i| farthest(&along, i, i / cols, count / cols, cols)).collect()
}

/// As [`unsampled_light_error`](ridgelight::plan::unsampled_light_error), for the indirect light of all texels of a
/// [`reference_at`](ridgelight::plan::reference_at) together: the root mean square over them, except with a `probability` in (0, 1). An event that no path has sampled has a share of at most
/// -ln(probability) / (N · texels) of all (the rule of three: 3 for 5 %). Its variance is W²/N times its mean share, with W
/// the upper bound of a path's light after one reflection.
pub fn unsampled_bounce_error(
    scene: &Scene,
    bounces: u32,
    (paths, texels): (u32, usize),
    probability: f64,
) -> [f64; 3] {
    let Some(later) = bounces.checked_sub(1) else { return [0.0; 3] };
    let most = max_path_light(scene, later);
    let share = -probability.ln() / texels as f64;
    let scale = share.sqrt() * scene.surface.max_reflectance() / f64::from(paths);
    most.map(|most| scale * most)
}

#[cfg(test)]
mod tests;
