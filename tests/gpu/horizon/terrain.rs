//! Real terrain against the oracle: the bundled field always, larger ones where they exist.

use ridgelight::plan;
use ridgelight::scene::{Border, Fuse, HeightField, Lines, Method, Quality};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::Oracle;

use crate::{Device, bundled, random, under_sky};

/// The published figures of the bundled field, which `cargo measure accuracy` measures.
const PUBLISHED: &str = include_str!("../../../benches/results/accuracy_mt_washington_256.txt");
/// The number of texels behind them: for horizons, for the sky.
const PUBLISHED_TEXELS: [f64; 2] = [4000.0, 500.0];

/// A figure of a row of the published table, by its column's name.
fn published(lines: Lines, fuse: Fuse, column: &str) -> f64 {
    let cells = |line: &'static str| line.split('|').map(str::trim).collect::<Vec<_>>();
    let rows: Vec<_> = PUBLISHED.lines().filter(|l| l.starts_with('|')).map(cells).collect();
    let at = rows[0].iter().position(|name| *name == column).expect("a column");
    let is_row = |row: &&Vec<&str>| [row[1], row[2]] == [lines.to_string(), fuse.to_string()];
    rows.iter().find(is_row).expect("a row")[at].parse().expect("a figure")
}

/// A mean with its standard error, of values that are drawn independently.
struct Estimate {
    mean: f64,
    standard_error: f64,
}

impl Estimate {
    fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0);
        Self { mean, standard_error: (variance / count).sqrt() }
    }

    /// Whether it exceeds a figure from another number of values by less than three standard errors of both.
    fn is_within(&self, figure: f64, count: f64, of: f64) -> bool {
        self.mean <= figure + 3.0 * self.standard_error * (1.0 + count / of).sqrt()
    }
}

/// Mean error of a texel's elevations in all azimuths against the oracle's in the requested ones, degrees, of some
/// texels; and the largest of all.
fn errors(
    gpu: &mut Device,
    field: &HeightField,
    quality: &Quality,
    texels: usize,
) -> (Vec<f64>, f64) {
    let found = gpu.horizons(field, Border::Plane, quality);
    let azimuths = plan::circle_rad(quality, field.cell_m()).expect("azimuths");
    let oracle = Oracle::new(field, Border::Plane);
    let mut next = random(1);
    let plane = field.rows() * field.cols();
    let mut worst = 0.0_f64;
    let mean = |_| {
        let i = (next() * plane as f64) as usize;
        let error = |(k, phi): (usize, &f64)| {
            let ground_truth = oracle.elevation_rad(i / field.cols(), i % field.cols(), *phi);
            (f64::from(found[k * plane + i]) - ground_truth).abs().to_degrees()
        };
        let all: Vec<f64> = azimuths.iter().enumerate().map(error).collect();
        worst = all.iter().copied().fold(worst, f64::max);
        all.iter().sum::<f64>() / all.len() as f64
    };
    ((0..texels).map(mean).collect(), worst)
}

/// The published errors of the default and its neighbours hold, within three standard errors. A form with three times the error fails.
#[test]
fn horizons_of_bundled_terrain_match_the_published_errors() {
    const TEXELS: usize = 200;
    let mut gpu = Device::new();
    let field = bundled();
    // As many azimuths as in the published table: those along the grid err less.
    let base = Quality { azimuths: 64, method: Method::Sweep, ..Quality::default() };
    let mut estimate = |lines: Lines, fuse: Fuse, texels: usize| {
        let (all, worst) = errors(&mut gpu, &field, &Quality { lines, fuse, ..base }, texels);
        let of = Estimate::of(&all);
        println!(
            "{lines:?} {fuse:?}: mean {:.4}° ± {:.4}°, published {}°, worst {worst:.2}°",
            of.mean,
            of.standard_error,
            published(lines, fuse, "mean °")
        );
        of
    };
    let holds = |of: &Estimate, figure: f64, texels: usize| {
        of.is_within(figure, texels as f64, PUBLISHED_TEXELS[0])
    };
    // The error of `aimed-around` lies in fewer texels.
    for (lines, fuse, texels) in [
        (Lines::Cell, Fuse::AimedNearest, TEXELS),
        (Lines::TwoCells, Fuse::AimedNearest, TEXELS),
        (Lines::Cell, Fuse::Aimed, TEXELS),
        (Lines::Cell, Fuse::AimedAround, 10 * TEXELS),
    ] {
        let (of, figure) = (estimate(lines, fuse, texels), published(lines, fuse, "mean °"));
        assert!(holds(&of, figure, texels), "{lines:?} {fuse:?}: mean {}°", of.mean);
        assert!(
            !holds(&of, figure / 3.0, texels),
            "{lines:?} {fuse:?}: passes three times the error"
        );
    }
    let nearest = published(Lines::Cell, Fuse::AimedNearest, "mean °");
    let sparse = estimate(Lines::FourCells, Fuse::AimedNearest, TEXELS);
    assert!(!holds(&sparse, nearest, TEXELS), "passes lines 4 cells apart");
    // The published mean is 0; f32 resolves 1e-4° of a steep angle.
    let exact = Quality { lines: Lines::Exact, azimuths: 16, ..base };
    let (_, worst) = errors(&mut gpu, &field, &exact, 300);
    assert!(worst <= 1e-4, "exact: worst {worst}°");
}

/// The light of a uniform sky likewise, by its mean square.
#[test]
fn the_sky_over_bundled_terrain_is_the_oracles() {
    const TEXELS: usize = 400;
    let mut gpu = Device::new();
    let field = bundled();
    // `aimed-around` has errors at too few texels to estimate from 400.
    let fuse = Fuse::AimedNearest;
    let quality = Quality { azimuths: 64, fuse, ..Quality::default() };
    let picture = gpu.picture(&under_sky(field.clone(), Border::Plane), &quality);
    let oracle = Oracle::new(&field, Border::Plane);
    let mut next = random(2);
    let picks: Vec<usize> = (0..TEXELS).map(|_| (next() * 65_536.0) as usize).collect();
    // The oracle is slow unoptimised: on all cores.
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let ground_truth: Vec<f64> = std::thread::scope(|scope| {
        let sky = |i: &usize| light::sky_of(&oracle, i / 256, i % 256, 360);
        let parts = picks.chunks(TEXELS.div_ceil(threads));
        let all: Vec<_> = parts
            .map(|part| scope.spawn(move || part.iter().map(sky).collect::<Vec<_>>()))
            .collect();
        all.into_iter().flat_map(|t| t.join().expect("lit")).collect()
    });
    let squares: Vec<f64> = picks
        .iter()
        .zip(&ground_truth)
        .map(|(&i, ground_truth)| (f64::from(picture.values[i]) - ground_truth).powi(2))
        .collect();
    let of = Estimate::of(&squares);
    let mean = ground_truth.iter().sum::<f64>() / TEXELS as f64;
    let figure = published(Lines::Cell, Fuse::AimedNearest, "sky RMSE %") / 100.0;
    println!("sky: relative RMSE {:.5} %", 100.0 * of.mean.sqrt() / mean);
    let square = (figure * mean).powi(2);
    assert!(of.is_within(square, TEXELS as f64, PUBLISHED_TEXELS[1]), "{}", of.mean.sqrt());
    assert!(
        !of.is_within(square / 9.0, TEXELS as f64, PUBLISHED_TEXELS[1]),
        "passes three times the error"
    );
}
