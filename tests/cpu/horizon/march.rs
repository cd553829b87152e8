//! `horizon_march` with all crossings is the oracle in f32.

use super::*;
use proptest::prelude::*;
use ridgelight::plan::azimuths::even;
use ridgelight::scene::fractal;
use ridgelight_cpu::tolerance::march_slope;
use std::f64::consts::FRAC_PI_2;

fn check(field: &HeightField, border: Border, count: u32) -> Result<(), String> {
    let mut azimuths = even(count, field.cell_m());
    let warm_up = warm_ups(field, border);
    let lattices = marched(field, border, &mut azimuths, warm_up, true);
    let oracle = Oracle::new(field, border);
    let (_, relief) = extent(field);
    for azimuth in &azimuths {
        let march = ridgelight_cpu::shared::sweep::March::new(Heights::of(field, border), azimuth);
        let lattice = lattices.of(azimuth);
        let tolerance = march_slope(relief, azimuth.step_m.into());
        let reach = (border == Border::Periodic).then(|| warm_up_of(warm_up, azimuth));
        for (row, col) in (0..field.rows()).flat_map(|r| (0..field.cols()).map(move |c| (r, c))) {
            let (lane, step) = march.of_grid_point(col as i32, row as i32);
            let texel = lattice.texel(lane, march.march_position(step), azimuth.layer);
            let found = (lattice.slopes[texel], lattice.distances[texel]);
            check_exact(&oracle, (row, col), azimuth, found, tolerance, reach)?;
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn all_crossings_are_the_oracle(
        size in prop::sample::select(&SIZES[..]),
        border in prop::sample::select(&BORDERS[..]),
        cell in prop::sample::select(vec![[1.0, 1.0], [3.0, 1.0], [66.0, 92.6]]),
        seed in any::<u32>(), count in 3_u32..20, steep in -6_i32..7,
    ) {
        let rough =
            field(size.0, size.1, cell, |r, c| 10_f64.powi(steep) * noise(seed.into(), r, c));
        prop_assert_eq!(check(&rough, border, count), Ok(()));
    }
}

#[test]
fn a_summit_of_cells_a_metre_wide_at_8848_m() {
    let summit = field(9, 9, [1.0, 1.0], |r, c| 8848.0 + 0.01 * noise(3, r, c));
    assert_eq!(check(&summit, Border::Open, 24), Ok(()));
}

#[test]
fn flat_ground_is_at_slope_0_and_outside_is_nothing() {
    let flat = field(5, 7, [2.0, 3.0], |_, _| 17.0);
    for border in BORDERS {
        for all in [false, true] {
            let mut azimuths = even(24, flat.cell_m());
            let warm_up = warm_ups(&flat, border);
            let lattices = marched(&flat, border, &mut azimuths, warm_up, all);
            for slope in lattices.cols.slopes.iter().chain(&lattices.rows.slopes) {
                assert!(*slope == 0.0 || (*slope == -1e9 && border != Border::Periodic));
            }
        }
    }
}

/// On a fractal field angles agree to far better than the tolerance's worst case.
#[test]
fn a_fractal_field_within_a_ten_thousandth_of_a_degree() {
    let rough = fractal(40, 5).unwrap();
    let mut azimuths = even(12, rough.cell_m());
    let lattices = marched(&rough, Border::Plane, &mut azimuths, [0; 2], true);
    let oracle = Oracle::new(&rough, Border::Plane);
    for azimuth in &azimuths {
        let march =
            ridgelight_cpu::shared::sweep::March::new(Heights::of(&rough, Border::Plane), azimuth);
        for i in (0..1600).step_by(3) {
            let (row, col) = (i / 40, i % 40);
            let (lane, step) = march.of_grid_point(col as i32, row as i32);
            let lattice = lattices.of(azimuth);
            let slope =
                lattice.slopes[lattice.texel(lane, march.march_position(step), azimuth.layer)];
            let angle = if slope <= -1e9 { -FRAC_PI_2 } else { f64::from(slope).atan() };
            let ground_truth = oracle.elevation_rad(row, col, azimuth.swept_rad(rough.cell_m()));
            assert!(
                (angle.max(0.0) - ground_truth).abs().to_degrees() < 1e-4,
                "{row} {col} {azimuth:?}"
            );
        }
    }
}
