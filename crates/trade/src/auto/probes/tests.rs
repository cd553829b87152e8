use super::*;
use crate::auto::picks::even_picks;
use crate::auto::tests::lit_by;
use ridgelight::basis::random::{STEP, mixed, unit};
use ridgelight::scene::Lights;

const SIDE: usize = 64;
const SEEDS: u64 = 200;

fn noise(k: u64) -> f64 {
    let z =
        k.wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(31).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    ((z ^ (z >> 29)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
}

/// Probes of some of the texels, under an even light.
fn of(light: f64, (places, factors): (Vec<usize>, Vec<f64>), noise: f64) -> Probes {
    let (light, noise) = (vec![[light; 3]; places.len()], vec![noise; places.len()]);
    Probes { is_whole: false, noise, places, factors, light, own_rms: 0.0 }
}

/// Shares of seeds whose bound, and whose bare estimate, is at least the true error of a picture of
/// light 1 with an `error` at each texel; and the mean of the estimate's square over it.
fn covered(
    error_at: impl Fn(usize) -> f64,
    probes: usize,
    control: Option<f64>,
    unsure: &[f64],
) -> [f64; 3] {
    let count = SIDE * SIDE;
    let square = (0..count).map(|i| error_at(i).powi(2)).sum::<f64>() / count as f64;
    let drawn = |scale: f64| vec![(0..count).map(|i| (1.0 + scale * error_at(i)) as f32).collect()];
    let picture: Vec<Vec<f32>> = drawn(1.0);
    let control: Option<Vec<Vec<f32>>> = control.map(drawn);
    let mut sums = [0.0; 3];
    for seed in 0..SEEDS {
        let probes = of(1.0, picks(unsure, probes, seed), 0.0);
        let measured = probes.error(&picture, control.as_deref(), Probes::FOUR_BOUNDS);
        sums[0] += f64::from(u8::from(measured.at_most >= square.sqrt()));
        sums[1] += f64::from(u8::from(measured.error >= square.sqrt()));
        sums[2] += measured.error.powi(2) / square;
    }
    sums.map(|s| s / SEEDS as f64)
}

/// The share of seeds whose bound must hold: that of one of four bounds, less three standard
/// deviations of that many seeds.
fn promised() -> f64 {
    let confidence = 1.0 - (1.0 - Probes::CONFIDENCE) / 4.0;
    confidence - 3.0 * (confidence * (1.0 - confidence) / SEEDS as f64).sqrt()
}

/// Uniform errors, errors in a twentieth of the texels (like shadow edges), errors that grow across
/// the field. The bound holds as often as stated, less three standard deviations of that many
/// seeds. The estimate's square is unbiased (for the twentieth its standard error is √(19 /
/// probes), here at most 0.55, and that of its mean 0.55/√200). The bare estimate would fail as a
/// bound, except for the growing errors, where stratification leaves no sampling error.
#[test]
fn the_bound_covers_as_often_as_stated() {
    let everywhere = |i: usize| 0.02 * noise(i as u64);
    let edges = |i: usize| if noise(i as u64) > 0.45 { 0.1 * noise(!i as u64) } else { 0.0 };
    let across = |i: usize| 0.03 * (i / SIDE) as f64 / SIDE as f64;
    for (name, error_at) in
        [("everywhere", everywhere as fn(usize) -> f64), ("edges", edges), ("across", across)]
    {
        for (probes, control) in [(200, None), (400, None), (200, Some(0.3)), (64, Some(-0.2))] {
            let [bound, bare, mean] = covered(error_at, probes, control, &vec![0.0; SIDE * SIDE]);
            let text = format!("{name}, {probes} probes, {control:?}: {bound} {bare} {mean}");
            assert!(bound >= promised(), "{text}");
            assert!(bare < 0.8 || name == "across", "{text}");
            assert!((mean - 1.0).abs() < 3.0 * 0.55 / (SEEDS as f64).sqrt(), "{text}");
        }
    }
    // Weights that say nothing of the errors, in a quarter of the texels: the bound holds, though only a third of the probes is
    // elsewhere.
    let misled: Vec<f64> = (0..SIDE * SIDE).map(|i| f64::from(u8::from(i % 4 == 0))).collect();
    for probes in [64, 200] {
        let [bound, ..] = covered(everywhere, probes, None, &misled);
        assert!(bound >= promised(), "{probes} probes: {bound}");
    }
}

/// All of the error in 9 of 4096 texels, like the edge of a short shadow: uniform probes mostly
/// miss them, and their bound fails. Where pictures differ within 2 texels of them (and in 300
/// texels elsewhere), two thirds of the probes are there, and the bound holds.
#[test]
fn errors_of_few_texels_are_found_where_pictures_differ() {
    let is_edge = |i: usize| i / SIDE == 20 && (30..39).contains(&(i % SIDE));
    let error_at = |i: usize| if is_edge(i) { 0.5 } else { 0.0 };
    let even = covered(error_at, 300, None, &vec![0.0; SIDE * SIDE]);
    assert!(even[0] < 0.8, "{even:?}");
    let drawn = |scale: f32| -> Vec<f32> {
        let at = |i| if is_edge(i) || (1000..1300).contains(&i) { scale } else { 0.0 };
        (0..SIDE * SIDE).map(at).collect()
    };
    let unsure = apart(&[drawn(0.3)], &[drawn(0.5)], SIDE);
    let touched = unsure.iter().filter(|u| **u > 0.0).count();
    assert!((5 * 13 + 300..5 * 13 + 1000).contains(&touched), "{touched}");
    let aimed = covered(error_at, 300, None, &unsure);
    assert!(aimed[0] >= promised(), "{aimed:?}");
}

/// A picture far better than its control is its own control: no noise of the control, no estimate
/// of 0.
#[test]
fn a_better_picture_than_its_control_has_an_error() {
    let count = SIDE * SIDE;
    let error_at = |i: usize| 1e-4 * noise(i as u64);
    let rough = vec![(0..count).map(|i| (1.0 + 0.1 * noise(!i as u64)) as f32).collect()];
    let fine = vec![(0..count).map(|i| (1.0 + error_at(i)) as f32).collect::<Vec<f32>>()];
    let rms = ((0..count).map(|i| error_at(i).powi(2)).sum::<f64>() / count as f64).sqrt();
    for seed in 0..SEEDS {
        let probes = of(1.0, picks(&vec![0.0; count], 200, seed), 0.0);
        let measured = probes.error(&fine, Some(&rough), Probes::FOUR_BOUNDS);
        assert!((measured.error / rms - 1.0).abs() < 0.3 && measured.at_most < 1.5 * rms);
    }
}

/// One in each of as many equal parts, the same for the same seed; all where all are wanted. With
/// weights, the factors' mean over draws is 1 and heavy texels are drawn often.
#[test]
fn probes_are_spread() {
    let even = vec![0.0; 1000];
    let (places, factors) = picks(&even, 10, 5);
    assert!(places.iter().enumerate().all(|(k, p)| p / 100 == k), "{places:?}");
    assert_eq!(factors, vec![1.0; 10]);
    assert_eq!(places, picks(&even, 10, 5).0);
    assert_ne!(places, picks(&even, 10, 6).0);
    assert_eq!(picks(&even, 5000, 1).0, (0..1000).collect::<Vec<_>>());
    let weights: Vec<f64> = (0..1000).map(|i| f64::from(u8::from(i >= 900))).collect();
    let (places, factors) = picks(&weights, 200, 1);
    // Two thirds of all draws, and a tenth of the other third.
    let heavy = places.iter().filter(|p| **p >= 900).count();
    assert!((139..=140).contains(&heavy), "{heavy}");
    let mean = factors.iter().sum::<f64>() / 200.0;
    assert!((mean - 1.0).abs() < 0.02, "{mean}");
}

/// The first third does not depend on the weights, so its light can be computed before pictures exist. The rest
/// does. Of 101 picks the first 34 are uniform: an index that has all of the weight of 1000 has the probability
/// (34 + 67 · 1000) / 101 of the mean.
#[test]
fn a_third_of_the_picks_needs_no_weights() {
    let heavy =
        |at: usize| -> Vec<f64> { (0..1000).map(|i| f64::from(u8::from(i == at))).collect() };
    for wanted in [1, 2, 100, 101, 999] {
        let even = even_picks(1000, wanted, 3);
        assert_eq!(even.len(), wanted.div_ceil(3));
        for at in [0, 400, 999] {
            let (places, factors) = picks(&heavy(at), wanted, 3);
            assert_eq!((places.len(), factors.len()), (wanted, wanted));
            assert_eq!(places[..even.len()], even);
            assert!(places[even.len()..].iter().all(|place| *place == at), "{wanted} {at}");
        }
    }
    let factors = picks(&heavy(400), 101, 3).1;
    assert!((factors[100] - 101.0 / (34.0 + 67_000.0)).abs() < 1e-12, "{}", factors[100]);
    assert_eq!(even_picks(10, 10, 3), picks(&[1.0; 10], 10, 3).0);
}

/// Weights that are not finite give uniform picks, whose factors are finite.
#[test]
fn infinite_weights_are_uniform() {
    let even = picks(&[0.0; 1000], 100, 3);
    for weight in [f64::INFINITY, f64::NAN] {
        let mut weights = [1.0; 1000];
        weights[400] = weight;
        assert_eq!(picks(&weights, 100, 3), even, "{weight}");
    }
}

/// Texel 7 differs in the coarse picture, texel 3 in the fine one: both pictures have the same share of the weights, however small
/// the difference. Where the first two are equal the fine one decides, and nothing where all are. A picture with a
/// value beyond f32 gives no weights if it is one of the first two, and has none if it is the fine one.
#[test]
fn a_fine_picture_directs_as_many_probes_as_a_coarse_one() {
    let scene = lit_by(Lights::default(), [1, 20], |_| 0.0);
    let with = |at: usize, more: f32| {
        let mut light = vec![1.0; 20];
        light[at] += more;
        vec![light]
    };
    let (plain, coarse, fine) = (with(0, 0.0), with(7, 2.0), with(3, 1e-4));
    let of = |coarse: &[Vec<f32>], fine: &[Vec<f32>]| unsure(&scene, [&plain, coarse], Some(fine));
    let both = of(&coarse, &fine);
    assert_eq!(unsure(&scene, [&plain, &coarse], None)[3], 0.0);
    let of_coarse: f64 = both[5..10].iter().sum();
    assert!((both[3] / of_coarse - 1.0).abs() < 1e-9 && both[4] == 0.0, "{both:?}");
    let alone = of(&plain, &fine);
    assert_eq!(alone.iter().position(|u| *u > 0.0), Some(3));
    assert_eq!(usable_sum(&of(&plain, &plain)), None);
    assert_eq!(usable_sum(&of(&with(7, f32::INFINITY), &fine)), None);
    assert_eq!(of(&coarse, &with(3, f32::INFINITY)), unsure(&scene, [&plain, &coarse], None));
}

/// A random number of mean 0 and variance 1, near to normal: the sum of twelve uniform ones.
fn normal(k: u64) -> f64 {
    let even = |j: u64| unit(mixed((12 * k + j + 1).wrapping_mul(STEP))) - 0.5;
    (0..12).map(even).sum()
}

/// Where every texel is a probe only the path tracing is random, and its noise alone lifts the
/// bound above the estimate: a picture with an error of 0.04 everywhere, of a light of 1 with a
/// noise of 0.02. The prediction for four times the probes and half the variance matches a
/// measurement.
#[test]
fn path_noise_predicts_the_bound() {
    let count = SIDE * SIDE;
    let whole = |count: usize, noise: f64| {
        let all = ((0..count).collect(), vec![1.0; count]);
        Probes { is_whole: true, ..of(1.0, all, noise) }
    };
    // The mean of a square is that of the error and that of the noise.
    let offset = (0.04_f64.powi(2) + 4e-4).sqrt();
    let picture = vec![vec![(1.0 + offset) as f32; count]];
    let probes = whole(count, 4e-4);
    let measured = probes.error(&picture, None, Probes::FOUR_BOUNDS);
    let expected = probes.path_noise(0.04, 1.0, count, Probes::FOUR_BOUNDS);
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
    near(measured.error, 0.04);
    near(measured.at_most, 0.04_f64.hypot(expected));
    let few = whole(count / 4, 8e-4).path_noise(0.04, 0.5, count, Probes::FOUR_BOUNDS);
    near(few, expected);
}

/// Direct light of 1 with an error of 0.01, bounced light of 0.3 of which 0.008 may be unsampled:
/// 0.008 / 1.3 of all. Over the mean of direct light alone the oracle's share would exceed it, and
/// nothing would remain.
#[test]
fn unsampled_light_is_relative_to_all_light() {
    let direct = Probes { own_rms: 0.01, ..of(1.0, (vec![0, 1], vec![1.0; 2]), 0.0) };
    let mut all = direct.clone();
    let traced = Traced { mean: [0.3; 3], standard_error: [0.0; 3] };
    all.add_bounced(&[traced; 2], [0.008; 3]);
    assert!(all.own_error() < direct.own_error());
    let unsampled = all.unsampled_error(&direct);
    assert!((unsampled - 0.008 / 1.3).abs() < 1e-12, "{unsampled}");
    assert_eq!(direct.unsampled_error(&direct), 0.0);
}

/// Eight bounds of 5 %/8 each: the normal distribution's tail beyond z, by Simpson's rule, and the
/// unsampled light.
#[test]
fn eight_bounds_share_the_confidence() {
    let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    let tail = |z: f64| {
        let step = (12.0 - z) / 4000.0;
        let weight = |k: u32| if k == 0 || k == 4000 { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
        (0..=4000).map(|k| weight(k) * density(z + f64::from(k) * step)).sum::<f64>() * step / 3.0
    };
    // To the last written digit of each.
    for (z, count) in
        [(Probes::ONE_BOUND, 1.0), (Probes::FOUR_BOUNDS, 4.0), (Probes::EIGHT_BOUNDS, 8.0)]
    {
        let slack = 0.0005 * density(z);
        assert!((tail(z) - 0.05 / count).abs() <= slack, "{z}: {}", tail(z));
    }
    let all = 4.0 * (tail(Probes::EIGHT_BOUNDS) + Probes::UNSAMPLED_PROBABILITY);
    assert!((all - (1.0 - Probes::CONFIDENCE)).abs() < 1e-4, "{all}");
}

/// Noise as large as the picture's error: its variance, known to √(2 / 7) of itself from eight
/// batches, is subtracted. Otherwise the square would be twice as large. The bound holds as often
/// as stated, for a part of the texels and for all, where only the path tracing is random.
#[test]
fn noise_does_not_bias_the_error() {
    const NOISE: f64 = 0.02;
    let count = SIDE * SIDE;
    let error_at = |i: usize| 0.07 * noise(i as u64);
    let rms = ((0..count).map(|i| error_at(i).powi(2)).sum::<f64>() / count as f64).sqrt();
    let drawn = |scale: f64| vec![(0..count).map(|i| (1.0 + scale * error_at(i)) as f32).collect()];
    let (picture, control): (Vec<Vec<f32>>, Vec<Vec<f32>>) = (drawn(1.0), drawn(0.5));
    for (wanted, control) in [(300, None), (300, Some(&control[..])), (count, None)] {
        let (mut held, mut mean, mut bare) = (0_u64, 0.0, 0.0);
        for seed in 0..SEEDS {
            let mut probes = of(0.75, picks(&vec![0.0; count], wanted, seed), 0.0);
            probes.is_whole = wanted == count;
            let traced = |k: usize| {
                let of = |j: u64| normal((seed << 24) + 9 * k as u64 + j);
                let batches = (0..7).map(|j| of(j).powi(2)).sum::<f64>() / 7.0;
                let mean = [0.25 + NOISE * of(7); 3];
                Traced { mean, standard_error: [NOISE * batches.sqrt(); 3] }
            };
            let traced: Vec<Traced> = (0..probes.count()).map(traced).collect();
            probes.add_bounced(&traced, [0.0; 3]);
            let measured = probes.error(&picture, control, Probes::FOUR_BOUNDS);
            held += u64::from(measured.at_most >= rms);
            mean += measured.error.powi(2) / rms.powi(2) / SEEDS as f64;
            let steady = Probes { noise: vec![0.0; probes.count()], ..probes.clone() };
            bare += steady.error(&picture, None, 0.0).error.powi(2) / rms.powi(2) / SEEDS as f64;
            // √(z √(4 (d² s² + s⁴) / probes)), of a mean light of 1, s⁴ as of eight batches (1 +
            // 2/7) times as much. χ² / 7 of seven has a fourth moment of 7·9·11·13 / 7⁴: the
            // standard error of its square is 1.13 of itself, that of the fourth root of a mean a
            // quarter of 1.13 / √probes, that of s² less, and that of the mean light s / √probes.
            // Five of these.
            let squared: f64 = 1.0 + 2.0 / 7.0;
            let one = (9009.0_f64 / 2401.0 - squared.powi(2)).sqrt() / squared;
            let slack = 5.0 * (0.25 * one + NOISE) / (wanted as f64).sqrt();
            for error in [0.0, 2.0 * NOISE] {
                let square = 4.0 * ((error * NOISE).powi(2) + squared * NOISE.powi(4));
                let expected = (Probes::FOUR_BOUNDS * (square / wanted as f64).sqrt()).sqrt();
                let found = probes.path_noise(error, 1.0, wanted, Probes::FOUR_BOUNDS);
                assert!((found / expected - 1.0).abs() < slack, "{found} {expected}");
            }
        }
        let text = format!("{wanted}: {held} held, mean {mean}, bare {bare}");
        assert!(held as f64 >= promised() * SEEDS as f64, "{text}");
        // The standard error of one square is a fifth or less of 300 or more.
        assert!((mean - 1.0).abs() < 3.0 * 0.2 / (SEEDS as f64).sqrt(), "{text}");
        // d² + s²; the standard error of one mean is √((4 d² s² + 2 s⁴ + 0.8 d⁴) / probes): a
        // uniform d² varies by 0.8 d⁴.
        let (d, s) = (rms.powi(2), NOISE.powi(2));
        let one = ((4.0 * d * s + 2.0 * s * s + 0.8 * d * d) / wanted as f64).sqrt() / d;
        assert!((bare - (1.0 + s / d)).abs() < 3.0 * one / (SEEDS as f64).sqrt(), "{text}");
    }
}
