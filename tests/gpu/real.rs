//! Real terrain against the oracle. The bundled field always; the larger ones where they are.

use std::path::Path;

use ridgelight::cpu::{light, oracle::Oracle};
use ridgelight::files::{self, HeightOptions};
use ridgelight::measure::error::{HorizonError, ImageError};
use ridgelight::plan;
use ridgelight::scene::{Border, Fuse, HeightField, Lines, Quality};

use crate::{Device, random, under_sky};

fn bundled() -> HeightField {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mt_washington_256.png");
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    files::read_heights(&path, &options).expect("the bundled field")
}

/// Elevations at some samples of all azimuths against the oracle in the azimuths really asked for.
fn errors(
    gpu: &mut Device,
    field: &HeightField,
    quality: &Quality,
    samples: usize,
) -> HorizonError {
    let found = gpu.horizons(field, Border::Plane, quality);
    let azimuths = plan::circle_rad(quality, field.cell_m()).expect("azimuths");
    let oracle = Oracle::new(field, Border::Plane);
    let mut next = random(1);
    let plane = field.rows() * field.cols();
    let picks: Vec<usize> = (0..samples).map(|_| (next() * plane as f64) as usize).collect();
    let (mut ours, mut truth) = (Vec::new(), Vec::new());
    for (k, phi) in azimuths.iter().enumerate() {
        for &i in &picks {
            ours.push(found[k * plane + i]);
            truth.push(oracle.elevation_rad(i / field.cols(), i % field.cols(), *phi) as f32);
        }
    }
    HorizonError::of(&ours, &truth, 1, samples).expect("comparable")
}

#[test]
fn horizons_of_bundled_terrain_hold_what_the_readme_says() {
    let mut gpu = Device::new();
    let field = bundled();
    let base = Quality { azimuths: 16, ..Quality::default() };
    let check = |gpu: &mut Device, quality: Quality, mean: f64| {
        let e = errors(gpu, &field, &quality, 300);
        println!(
            "{:?} {:?}: mean {:.4}° worst {:.2}°",
            quality.lines, quality.fuse, e.mean, e.worst
        );
        assert!(e.mean <= mean, "{:?} {:?}: mean {}°", quality.lines, quality.fuse, e.mean);
    };
    // The bounds: 0.3° by default, 0.1° denser, 1e-4° exact.
    check(&mut gpu, base, 0.3);
    check(&mut gpu, Quality { lines: Lines::TwoCells, ..base }, 0.3);
    check(&mut gpu, Quality { fuse: Fuse::Aimed, ..base }, 0.1);
    let exact = errors(&mut gpu, &field, &Quality { lines: Lines::Exact, ..base }, 300);
    assert!(exact.worst <= 1e-4, "exact: worst {}°", exact.worst);
}

#[test]
fn the_sky_over_bundled_terrain_is_the_oracles() {
    let mut gpu = Device::new();
    let field = bundled();
    let picture = gpu.picture(&under_sky(field.clone(), Border::Plane), &Quality::default());
    let oracle = Oracle::new(&field, Border::Plane);
    let mut next = random(2);
    let picks: Vec<usize> = (0..100).map(|_| (next() * 65_536.0) as usize).collect();
    let ours: Vec<f32> = picks.iter().map(|&i| picture.values[i]).collect();
    let truth: Vec<f32> =
        picks.iter().map(|&i| light::sky_of(&oracle, i / 256, i % 256, 360) as f32).collect();
    let e = ImageError::of(&ours, &truth, 10).expect("comparable");
    println!("sky: relative RMSE {:.5} %", 100.0 * e.relative_rmse);
    assert!(e.relative_rmse <= 0.003, "{}", e.relative_rmse);
}
