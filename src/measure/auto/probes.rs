use crate::cpu::lit::Lit;
use crate::scene::Scene;
use crate::{Error, Result};

/// Probes: as many as [`CELLS`] allow, within these.
const FEWEST: usize = 64;
const MOST: usize = 1000;
/// Cells that the oracle's rays may cross: some seconds of one core.
const CELLS: usize = 1 << 29;
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

    /// So many samples without void, or all; the same `seed` and number give the same samples. On all
    /// cores.
    ///
    /// # Errors
    /// A field of voids alone.
    pub fn of(scene: &Scene, wanted: usize, seed: u64) -> Result<Self> {
        let field = &scene.field;
        let known: Vec<usize> = (0..field.rows() * field.cols())
            .filter(|i| field.voids().is_none_or(|v| !v[*i]))
            .collect();
        if known.is_empty() {
            return Err(Error::setting("field", "voids alone", "samples to light"));
        }
        let lit = Lit::of(scene);
        let places = stratified(&known, wanted, seed);
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let light = std::thread::scope(|scope| {
            let at = |i: &usize| lit.at(i / field.cols(), i % field.cols());
            let parts = places.chunks(places.len().div_ceil(threads).max(1));
            let all: Vec<_> = parts
                .map(|part| scope.spawn(move || part.iter().map(at).collect::<Vec<_>>()))
                .collect();
            all.into_iter().flat_map(|t| t.join().unwrap_or_default()).collect()
        });
        Ok(Self { count: known.len(), places, light })
    }

    /// How many to take so that they cost some seconds of one core: 64 to 1000, fewer the larger the field.
    pub fn affordable(scene: &Scene) -> usize {
        let side = scene.field.rows().max(scene.field.cols());
        (CELLS / (Lit::of(scene).rays() * side).max(1)).clamp(FEWEST, MOST)
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

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 64;
    const SEEDS: u64 = 200;

    fn noise(k: u64) -> f64 {
        let z = k
            .wrapping_mul(0x9E37_79B9_7F4A_7C15)
            .rotate_left(31)
            .wrapping_mul(0xD6E8_FEB8_6659_FD93);
        ((z ^ (z >> 29)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }

    /// Shares of seeds whose bound, and whose bare estimate, is no less than the true error of a picture
    /// of light 1 with `off` at each sample; and the mean of the estimate over it.
    fn covered(off: fn(usize) -> f64, probes: usize, control: Option<f64>) -> [f64; 3] {
        let count = SIDE * SIDE;
        let square = (0..count).map(|i| off(i).powi(2)).sum::<f64>() / count as f64;
        let of = |scale: f64| vec![(0..count).map(|i| (1.0 + scale * off(i)) as f32).collect()];
        let picture: Vec<Vec<f32>> = of(1.0);
        let control: Option<Vec<Vec<f32>>> = control.map(of);
        let known: Vec<usize> = (0..count).collect();
        let mut sums = [0.0; 3];
        for seed in 0..SEEDS {
            let places = stratified(&known, probes, seed);
            let light = vec![[1.0; 3]; places.len()];
            let seen = Probes { count, places, light }.error(&picture, control.as_deref());
            sums[0] += f64::from(u8::from(seen.at_most >= square.sqrt()));
            sums[1] += f64::from(u8::from(seen.error >= square.sqrt()));
            sums[2] += seen.error.powi(2) / square;
        }
        sums.map(|s| s / SEEDS as f64)
    }

    /// Errors everywhere, errors along a twentieth of the samples (as shadows' edges make), errors that
    /// grow across the field: the bound holds as often as it says, less three standard deviations of so
    /// many seeds; the estimate's square is right in the mean (that of the twentieth wavers by
    /// √(19 / probes), here by no more than 0.55, and its mean by 0.55/√200); and the bare estimate
    /// would not do as a bound, but across, where equal parts leave nothing to chance.
    #[test]
    fn the_bound_covers_as_often_as_it_says() {
        let everywhere = |i: usize| 0.02 * noise(i as u64);
        let edges = |i: usize| if noise(i as u64) > 0.45 { 0.1 * noise(!i as u64) } else { 0.0 };
        let across = |i: usize| 0.03 * (i / SIDE) as f64 / SIDE as f64;
        let confidence = Probes::CONFIDENCE;
        let slack = 3.0 * (confidence * (1.0 - confidence) / SEEDS as f64).sqrt();
        for (name, off) in
            [("everywhere", everywhere as fn(usize) -> f64), ("edges", edges), ("across", across)]
        {
            for (probes, control) in [(200, None), (400, None), (200, Some(0.3)), (64, Some(-0.2))]
            {
                let [bound, bare, mean] = covered(off, probes, control);
                let said = format!("{name}, {probes} probes, {control:?}: {bound} {bare} {mean}");
                assert!(bound >= confidence - slack, "{said}");
                assert!(bare < 0.8 || name == "across", "{said}");
                assert!((mean - 1.0).abs() < 3.0 * 0.55 / (SEEDS as f64).sqrt(), "{said}");
            }
        }
    }

    /// One in each of as many equal parts, the same for the same seed; all where all are wanted.
    #[test]
    fn probes_are_spread() {
        let known: Vec<usize> = (0..1000).map(|i| 3 * i).collect();
        let places = stratified(&known, 10, 5);
        assert!(places.iter().enumerate().all(|(k, p)| p / 300 == k), "{places:?}");
        assert_eq!(places, stratified(&known, 10, 5));
        assert_ne!(places, stratified(&known, 10, 6));
        assert_eq!(stratified(&known, 5000, 1), known);
    }
}
