//! `surface_sweep` is the oracle along grid vectors.

use super::*;
use proptest::prelude::*;
use ridgelight::plan::azimuths::along_grid_vectors;
use ridgelight::scene::fractal;
use ridgelight_cpu::shared::surface::segment_crossings;
use ridgelight_cpu::shared::sweep::March;
use ridgelight_cpu::surface_sweep::surface_sweep;
use ridgelight_cpu::tolerance::surface_slope;

fn swept_surface(
    field: &HeightField,
    border: Border,
    azimuths: &mut [Azimuth],
    warm_up: [i32; 2],
) -> Lattices {
    number_layers(azimuths);
    let mut lattices = Lattices::new(azimuths, [field.cols(), field.rows()], 15, border);
    for azimuth in azimuths.iter() {
        let warm_up = warm_up_of(warm_up, azimuth);
        surface_sweep(Heights::of(field, border), azimuth, warm_up, lattices.of_mut(azimuth));
    }
    lattices
}

/// Every `stride`-th texel against the oracle; the largest error in degrees.
fn check(
    field: &HeightField,
    border: Border,
    azimuths: &mut [Azimuth],
    stride: usize,
) -> Result<f64, String> {
    let warm_up = warm_ups(field, border);
    let lattices = swept_surface(field, border, azimuths, warm_up);
    let oracle = Oracle::new(field, border);
    let (largest, _) = extent(field);
    let mut worst = 0.0_f64;
    for azimuth in azimuths.iter() {
        let march = March::new(Heights::of(field, border), azimuth);
        let lattice = lattices.of(azimuth);
        let tolerance = surface_slope(largest, azimuth.step_m.into());
        let reach = (border == Border::Periodic).then(|| warm_up_of(warm_up, azimuth));
        for i in (0..field.rows() * field.cols()).step_by(stride) {
            let (row, col) = (i / field.cols(), i % field.cols());
            let (lane, step) = march.of_grid_point(col as i32, row as i32);
            let texel = lattice.texel(lane, march.march_position(step), azimuth.layer);
            let found = (lattice.slopes[texel], lattice.distances[texel]);
            check_exact(&oracle, (row, col), azimuth, found, tolerance, reach)?;
            if let Some(ground_truth) = oracle.horizon_along(row, col, grid_vector(azimuth))
                && reach.is_none()
            {
                worst = worst.max((f64::from(found.0).atan() - ground_truth.slope.atan()).abs());
            }
        }
    }
    Ok(worst.to_degrees())
}

/// Crossings strictly between two steps, in whole numbers: with places in 1/q of a cell, a line at k that
/// advances by p crosses the next lane line where k + p > q, diagonals along it where 0 < k < q - p, across it
/// where k + p > 0 and again where k + p > q. f32 must not report one at a step: at no distance from the texel
/// there, it would have any slope. A device's quotients may err by 2.5 ulp (Vulkan's precision of division), so
/// each is tried 3 below and above.
#[test]
fn crossings_between_steps_are_neither_missed_nor_made_up() {
    for q in 1..=60_u16 {
        for p in 0..=q {
            for (k, ulps) in (0..q).flat_map(|k| [(k, 0), (k, -3), (k, 3)]) {
                let part = |n: u16| {
                    let exact = f32::from(n) / f32::from(q);
                    if n == 0 {
                        0.0
                    } else {
                        f32::from_bits((exact.to_bits() as i32 + ulps) as u32)
                    }
                };
                let count = |along| {
                    segment_crossings(part(k), part(p), along).iter().filter(|u| **u <= 1.0).count()
                };
                let lane = usize::from(k + p > q);
                assert_eq!(count(true), lane + usize::from(k > 0 && k + p < q), "{k} {p} {q}");
                assert_eq!(count(false), 2 * lane + usize::from(k + p > 0), "{k} {p} {q}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn grid_vectors_are_the_oracle(
        size in prop::sample::select(&SIZES[..]),
        border in prop::sample::select(&BORDERS[..]),
        cell in prop::sample::select(vec![[1.0, 1.0], [3.0, 1.0], [66.0, 92.6]]),
        seed in any::<u32>(), count in prop::sample::select(vec![4_u32, 8, 12, 30]),
        steep in -6_i32..7,
    ) {
        let rough =
            field(size.0, size.1, cell, |r, c| 10_f64.powi(steep) * noise(seed.into(), r, c));
        let checked = check(&rough, border, &mut along_grid_vectors(count, cell).expect("vectors"), 1);
        prop_assert!(checked.is_ok(), "{:?}", checked);
    }
}

#[test]
fn a_fractal_field_within_a_ten_thousandth_of_a_degree() {
    let rough = fractal(96, 2).unwrap();
    let mut azimuths = along_grid_vectors(16, rough.cell_m()).expect("vectors");
    let worst = check(&rough, Border::Plane, &mut azimuths, 7).unwrap();
    println!("worst {worst:e}°");
    assert!(worst <= 1e-4, "{worst}");
}
