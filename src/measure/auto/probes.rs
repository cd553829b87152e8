use crate::cpu::light;
use crate::cpu::oracle::Oracle;
use crate::scene::Scene;
use crate::{Error, Result};
use std::time::{Duration, Instant};

/// Probes: as many as the time allows, within these.
const FEWEST: usize = 64;
const MOST: usize = 400;
/// The oracle's azimuths of a sky and strips across a sun.
const AZIMUTHS: usize = 720;
const STRIPS: usize = 128;
/// Quantile of the normal distribution that 1 % lie beyond. Settings are chosen among some five that
/// are judged near the bound by the same probes: 1 % each is 5 % of all (Bonferroni), hence
/// [`Probes::CONFIDENCE`].
const DEVIATIONS: f64 = 2.326;

/// Samples all over a field, and their light by the f64 oracle.
#[derive(Clone, Debug)]
pub struct Probes {
    count: usize,
    places: Vec<usize>,
    light: Vec<[f64; 3]>,
}

/// A relative RMSE as probes tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The estimate: RMSE over all samples and channels, over the mean of the truth.
    pub error: f64,
    /// With [`Probes::CONFIDENCE`] it is no more than this.
    pub at_most: f64,
}

impl Probes {
    /// One-sided, of what is chosen; by the normal approximation of a mean of 64 or more.
    pub const CONFIDENCE: f64 = 0.95;

    /// 64 to 400 samples without void, in about so much time on all cores; the same `seed` and number
    /// give the same samples.
    ///
    /// # Errors
    /// A field of voids alone.
    pub fn of(scene: &Scene, most: Duration, seed: u64) -> Result<Self> {
        let field = &scene.field;
        let known: Vec<usize> = (0..field.rows() * field.cols())
            .filter(|i| field.voids().is_none_or(|v| !v[*i]))
            .collect();
        if known.is_empty() {
            return Err(Error::setting("field", "voids alone", "samples to light"));
        }
        let oracle = Oracle::new(field, scene.surface.border);
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let light = |places: &[usize]| -> Vec<[f64; 3]> {
            let at = |i: usize| {
                let (row, col) = (i / field.cols(), i % field.cols());
                light::scene_of(&oracle, scene, row, col, AZIMUTHS, STRIPS)
            };
            let each = places.len().div_ceil(threads).max(1);
            std::thread::scope(|scope| {
                let all: Vec<_> = places
                    .chunks(each)
                    .map(|part| {
                        scope.spawn(move || part.iter().map(|i| at(*i)).collect::<Vec<_>>())
                    })
                    .collect();
                all.into_iter().flat_map(|t| t.join().unwrap_or_default()).collect()
            })
        };
        let begun = Instant::now();
        let pilot = stratified(&known, 2 * threads, seed);
        light(&pilot);
        let each = begun.elapsed().as_secs_f64() / pilot.len() as f64;
        let affordable = (most.as_secs_f64() / each.max(1e-9)) as usize;
        let places = stratified(&known, affordable.clamp(FEWEST, MOST), seed);
        let light = light(&places);
        Ok(Self { count: known.len(), places, light })
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Never: a field of voids alone has none to give.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The relative RMSE of a picture: planes of one or three channels, row-major, NaN at voids.
    ///
    /// A `control` is a better picture of the same scene, of which all samples are known: with T, C and
    /// L for picture, control and truth, mean (T-L)² = mean of (T-C)² over all samples + mean of
    /// (T-L)² - (T-C)² over the probes (the difference estimator, Cochran 1977 §7.9 with slope 1). The
    /// nearer the control is to the truth, the less is left to chance. Without one the picture is its own.
    pub fn error(&self, picture: &[Vec<f32>], control: Option<&[Vec<f32>]>) -> Measured {
        let control = control.unwrap_or(picture);
        let at =
            |planes: &[Vec<f32>], c: usize, i: usize| f64::from(planes[c.min(planes.len() - 1)][i]);
        let (mut squares, mut sum, mut values) = (0.0, 0.0, 0.0_f64);
        for c in 0..3 {
            for i in 0..picture[0].len() {
                let (t, k) = (at(picture, c, i), at(control, c, i));
                if !k.is_nan() {
                    squares += (t - k).powi(2);
                    sum += k;
                    values += 1.0;
                }
            }
        }
        let count = self.places.len() as f64;
        let (mut rest, mut shift) = (Vec::new(), 0.0);
        for (i, light) in self.places.iter().zip(&self.light) {
            let mut square = 0.0;
            for (c, l) in light.iter().enumerate() {
                let (t, k) = (at(picture, c, *i), at(control, c, *i));
                square += ((t - l).powi(2) - (t - k).powi(2)) / 3.0;
                shift += (l - k) / (3.0 * count);
            }
            rest.push(square);
        }
        let mean_rest = rest.iter().sum::<f64>() / count;
        let variance =
            rest.iter().map(|r| (r - mean_rest).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
        // Of a field that is probed whole nothing is left to chance.
        let unseen = 1.0 - count / self.count as f64;
        let deviation = (unseen.max(0.0) * variance / count).sqrt();
        let square = (squares / values.max(1.0) + mean_rest).max(0.0);
        let mean = (sum / values.max(1.0) + shift).abs();
        let relative = |s: f64| if s == 0.0 { 0.0 } else { s.sqrt() / mean };
        Measured { error: relative(square), at_most: relative(square + DEVIATIONS * deviation) }
    }
}

/// `wanted` of the samples, one in each of as many equal parts of the reading order; within a part by
/// chance.
fn stratified(known: &[usize], wanted: usize, seed: u64) -> Vec<usize> {
    let wanted = wanted.min(known.len());
    // SplitMix64 (Steele, Lea & Flood 2014).
    let chance = |k: u64| {
        let mut z = seed.wrapping_add((k + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..wanted)
        .map(|k| {
            let from = k * known.len() / wanted;
            let to = (k + 1) * known.len() / wanted;
            known[from + (chance(k as u64) * (to - from) as f64) as usize]
        })
        .collect()
}
