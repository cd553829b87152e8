//! Errors of horizons stored as truncated Fourier series over azimuth, as bevy-clipmap reads them.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan;
use ridgelight::scene::{HeightField, Quality};

use crate::accuracy::horizons;
use crate::common::args::Args;
use crate::common::frames::device;
use crate::common::terrains::{SIDES, Terrain, terrains};
use crate::common::{Outcome, cells, head, xorshift};

/// The azimuths of bevy-clipmap's own baker.
const AZIMUTHS: u32 = 360;
/// Besides the mean.
const COEFFICIENTS: [usize; 4] = [8, 16, 32, 64];
/// Random grid points of each field.
const PICKS: usize = 4000;

/// For each number of coefficients: the RMS error of the tangents, % of their RMS, and the mean, the 99.9th percentile and the
/// maximum of the absolute error in elevation, degrees.
fn errors(gpu: &mut Headless, field: &HeightField) -> Result<Vec<[f64; 4]>> {
    let quality = Quality { azimuths: AZIMUTHS, ..Quality::default() };
    let azimuths = plan::circle_rad(&quality, field.cell_m())?;
    let mut next = xorshift(7);
    let picks: Vec<[usize; 2]> =
        (0..PICKS).map(|_| [next() % field.rows(), next() % field.cols()]).collect();
    let [elevations, _] = horizons(gpu, field, &quality, &picks, false)?;
    let most = COEFFICIENTS[COEFFICIENTS.len() - 1] / 2;
    let turns: Vec<Vec<[f64; 2]>> = azimuths
        .iter()
        .map(|phi| (0..=most).map(|k| (k as f64 * phi).sin_cos()).map(|(s, c)| [c, s]).collect())
        .collect();
    let mut found = vec![(0.0, Vec::new()); COEFFICIENTS.len()];
    let mut energy = 0.0;
    for pick in 0..PICKS {
        let at = |azimuth: usize| f64::from(elevations[azimuth * PICKS + pick]).max(0.0);
        let tangents: Vec<f64> = (0..azimuths.len()).map(|a| at(a).tan()).collect();
        energy += tangents.iter().map(|t| t * t).sum::<f64>();
        let mut sums = vec![[0.0; 2]; most + 1];
        for (tangent, turns) in tangents.iter().zip(&turns) {
            for (sum, turn) in sums.iter_mut().zip(turns) {
                *sum = [sum[0] + tangent * turn[0], sum[1] + tangent * turn[1]];
            }
        }
        for (tangent, turns) in tangents.iter().zip(&turns) {
            let term = |k: usize| sums[k][0] * turns[k][0] + sums[k][1] * turns[k][1];
            let mut series = term(0);
            let mut held = 0;
            for (coefficients, (left_out, degrees)) in COEFFICIENTS.iter().zip(&mut found) {
                series += 2.0 * (held + 1..=coefficients / 2).map(term).sum::<f64>();
                held = coefficients / 2;
                let series = series / azimuths.len() as f64;
                *left_out += (series - tangent).powi(2);
                degrees.push((series.max(0.0).atan() - tangent.atan()).abs().to_degrees());
            }
        }
    }
    let of = |(left_out, mut degrees): (f64, Vec<f64>)| {
        degrees.sort_by(f64::total_cmp);
        let mean = degrees.iter().sum::<f64>() / degrees.len() as f64;
        let high = degrees[degrees.len() * 999 / 1000];
        [100.0 * (left_out / energy).sqrt(), mean, high, degrees[degrees.len() - 1]]
    };
    Ok(found.into_iter().map(of).collect())
}

pub fn run(mut args: Args) -> Outcome {
    let terrains = terrains(args.folder().as_deref(), SIDES)?;
    let mut gpu = args.open()?;
    println!(
        "{}: horizons at {AZIMUTHS} azimuths of {PICKS} random grid points, by sweeps, and Fourier series of their tangents",
        device(&gpu)
    );
    head(
        "| field | coefficients | tangent error % | mean error ° | 99.9th percentile ° | maximum ° |",
    );
    for Terrain { name, field, .. } in &terrains {
        for (coefficients, errors) in COEFFICIENTS.iter().zip(errors(&mut gpu, field)?) {
            println!("| {name} | {coefficients} | {} |", cells(2, errors));
        }
    }
    Ok(())
}
