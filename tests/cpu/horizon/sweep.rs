//! `horizon_sweep` against brute force over its own lines.

use super::*;
use proptest::prelude::*;
use ridgelight::plan::azimuths::even;
use ridgelight_cpu::horizon_sweep::height_scale;
use ridgelight_cpu::lattice;
use ridgelight_cpu::lattice::{line_number, line_position};
use ridgelight_cpu::shared::sweep::{March, NO_SLOPE, on_field};
use ridgelight_cpu::tolerance::{EPSILON, sweep_slope};

/// One line's samples from the horizon's side, as (step of the march, height): those up to a sample.
fn line_samples(march: &March, y: i32, step: i32) -> Vec<(i32, f32)> {
    (0..=step)
        .map(|s| (s, y - (step - s) * march.azimuth.shear))
        .filter(|&(_, y)| march.periodic() || on_field(y, march.lanes))
        .map(|(s, y)| (s, march.line_height(y, s)))
        .collect()
}

/// Calls `check` with the texels of every lattice point and what it holds.
fn every_texel(
    field: &HeightField,
    border: Border,
    azimuths: &mut [Azimuth],
    options: SweepOptions,
    mut check: impl FnMut(&Azimuth, &[(i32, f32)], i32, f32) -> Result<(), String>,
) -> Result<(), String> {
    let warm_up = warm_ups(field, border);
    let lattices = swept(field, border, azimuths, warm_up, options);
    for azimuth in azimuths.iter() {
        let march = March::new(Heights::of(field, border), azimuth);
        let lattice = lattices.of(azimuth);
        let warm_up = warm_up_of(warm_up, azimuth);
        for step in 0..march.steps {
            for slot in 0..lattice.width as i32 {
                let total = step + warm_up;
                let y = line_position(slot, total, azimuth.shear, options.line_shift);
                if !march.periodic() && !on_field(y, march.lanes) {
                    continue;
                }
                let texels = line_samples(&march, y, total);
                let texel = lattice.texel(slot, march.march_position(step), azimuth.layer);
                let back = i32::from(lattice.occluders[texel]);
                check(azimuth, &texels, back, lattice.slopes[texel])
                    .map_err(|e| format!("{azimuth:?} step {step} slot {slot}: {e}"))?;
            }
        }
    }
    Ok(())
}

/// On heights and shears whose lines are exact in f32 every comparison is: the farthest of the
/// highest is met, and its slope has the bits of the formula.
fn exact(azimuth: &Azimuth, texels: &[(i32, f32)], back: i32, slope: f32) -> Result<(), String> {
    let &(step, own) = texels.last().unwrap();
    let rise = |h: f32| f64::from(h) - f64::from(own);
    // Cross products of exact rises with whole distances: ties go to the farther.
    let best = texels[..texels.len() - 1].iter().copied().reduce(|best, new| {
        let (new_d, best_d) = (f64::from(step - new.0), f64::from(step - best.0));
        if rise(new.1) * best_d > rise(best.1) * new_d { new } else { best }
    });
    let expected = best.map_or((0, NO_SLOPE), |(s, h)| {
        (step - s, (h - own) / ((step - s) as f32 * azimuth.step_m))
    });
    let ok = back == expected.0 && slope.to_bits() == expected.1.to_bits();
    if ok { Ok(()) } else { Err(format!("{back} {slope}, expected {expected:?}")) }
}

/// Azimuths of all octants with shears of whole quarters of a cell.
fn quarter_shears(cell_m: [f64; 2]) -> Vec<Azimuth> {
    let mut all = even(64, cell_m);
    for a in &mut all {
        a.shear = (a.shear + (1 << 12)) & !((1 << 13) - 1);
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn exact_lines_have_the_bits_of_brute_force(
        size in prop::sample::select(&SIZES[..]),
        border in prop::sample::select(&BORDERS[..]),
        seed in any::<u32>(), line_shift in 13_u32..=15, levels in 1_u32..256,
    ) {
        // Few levels make plateaus.
        let rough = field(size.0, size.1, [3.0, 2.0], |r, c| {
            (noise(seed.into(), r, c) * f64::from(levels)).floor() / 4.0
        });
        let options = SweepOptions { line_shift, ..SweepOptions::default() };
        let mut azimuths = quarter_shears(rough.cell_m());
        prop_assert_eq!(every_texel(&rough, border, &mut azimuths, options, exact), Ok(()));
    }

    #[test]
    fn any_line_is_brute_force_within_tolerance(
        size in prop::sample::select(&SIZES[..]),
        border in prop::sample::select(&BORDERS[..]),
        seed in any::<u32>(), line_shift in 13_u32..=15, count in 3_u32..40, steep in -6_i32..7,
    ) {
        let rough = field(size.0, size.1, [3.0, 2.0], |r, c| {
            10_f64.powi(steep) * noise(seed.into(), r, c)
        });
        let (largest, _) = extent(&rough);
        let options = SweepOptions { line_shift, ..SweepOptions::default() };
        let near = |azimuth: &Azimuth, texels: &[(i32, f32)], back: i32, slope: f32| {
            let ground_truth = highest(azimuth, texels);
            let tolerance = sweep_slope(largest, azimuth.step_m.into());
            let off = (f64::from(slope) - ground_truth).abs();
            let nothing = texels.len() == 1;
            let ok = if nothing { back == 0 && slope == NO_SLOPE } else { off <= tolerance };
            if ok { Ok(()) } else { Err(format!("{slope} at {back}, ground truth {ground_truth}")) }
        };
        let mut azimuths = even(count, rough.cell_m());
        prop_assert_eq!(every_texel(&rough, border, &mut azimuths, options, near), Ok(()));
    }

    /// Wide spacings where nothing repeats.
    #[test]
    fn wide_spacings_have_their_lines(
        size in prop::sample::select(&SIZES[..]), seed in any::<u32>(), line_shift in 16_u32..=17,
    ) {
        let rough = field(size.0, size.1, [1.0, 1.0], |r, c| noise(seed.into(), r, c));
        let options = SweepOptions { line_shift, ..SweepOptions::default() };
        let mut azimuths = quarter_shears(rough.cell_m());
        prop_assert_eq!(every_texel(&rough, Border::Open, &mut azimuths, options, exact), Ok(()));
    }

    /// An entry's height is rounded to 11 bits of H: off by H/2^11 at most, at both the chosen and
    /// the missed, a step or more away.
    #[test]
    fn packed_entries_cost_their_rounding(
        size in prop::sample::select(&SIZES[..]), seed in any::<u32>(), count in 3_u32..40,
    ) {
        let rough = field(size.0, size.1, [3.0, 2.0], |r, c| 40.0 * noise(seed.into(), r, c));
        let (largest, _) = extent(&rough);
        let options = SweepOptions {
            packed: Some(height_scale(rough.heights_m())),
            ..SweepOptions::default()
        };
        let near = |azimuth: &Azimuth, texels: &[(i32, f32)], back: i32, slope: f32| {
            let step_m = f64::from(azimuth.step_m);
            let tolerance = 2.0 * largest / 2048.0 / step_m + sweep_slope(largest, step_m);
            let ground_truth = highest(azimuth, texels);
            let ok = texels.len() == 1 || (f64::from(slope) - ground_truth).abs() <= tolerance;
            if ok { Ok(()) } else { Err(format!("{slope} at {back}, ground truth {ground_truth}")) }
        };
        let mut azimuths = even(count, rough.cell_m());
        prop_assert_eq!(every_texel(&rough, Border::Plane, &mut azimuths, options, near), Ok(()));
    }
}

/// The highest slope over all earlier texels, in f64 from the line's f32 heights.
fn highest(azimuth: &Azimuth, texels: &[(i32, f32)]) -> f64 {
    let &(step, own) = texels.last().unwrap();
    texels[..texels.len() - 1]
        .iter()
        .map(|&(s, h)| {
            (f64::from(h) - f64::from(own)) / (f64::from(step - s) * f64::from(azimuth.step_m))
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Axis and diagonal lines pass through the texels.
fn check_exact_fields(h: impl Fn(usize, usize) -> f64) {
    let shape = field(31, 37, [1.0, 1.0], h);
    let mut azimuths = even(8, shape.cell_m());
    let checked = every_texel(&shape, Border::Plane, &mut azimuths, SweepOptions::default(), exact);
    assert_eq!(checked, Ok(()));
}

/// -(x² + y²): strictly concave along every line, so every texel stays on the hull and meets the one before it.
#[test]
fn on_a_dome_the_hull_is_as_deep_as_the_line() {
    let dome = |r: usize, c: usize| -((r as f64 - 15.0).powi(2) + (c as f64 - 18.0).powi(2));
    check_exact_fields(dome);
    let shape = field(31, 37, [1.0, 1.0], dome);
    let mut azimuths = even(8, shape.cell_m());
    let lattices = swept(&shape, Border::Open, &mut azimuths, [0; 2], SweepOptions::default());
    assert!(lattices.cols.occluders.iter().chain(&lattices.rows.occluders).all(|b| *b <= 1));
}

/// On a ramp every texel is in line with all before it: ties are popped, the first of the line is
/// met, and the hull stays two deep.
#[test]
fn ties_are_popped() {
    check_exact_fields(|r, c| 3.0 * r as f64 - 2.0 * c as f64);
    check_exact_fields(|r, c| ((r / 5 + c / 7) % 3) as f64);
    let shape = field(4, 9, [1.0, 1.0], |_, _| 5.0);
    let mut azimuths = even(4, shape.cell_m());
    let lattices = swept(&shape, Border::Open, &mut azimuths, [0; 2], SweepOptions::default());
    for march in 0..9 {
        let texel = lattices.cols.texel(0, march, 1);
        assert_eq!(lattices.cols.occluders[texel], march as u16, "looking west");
    }
}

#[test]
fn spikes_and_sawtooth() {
    check_exact_fields(|r, c| if (r, c) == (11, 13) { 1e6 } else { 0.0 });
    check_exact_fields(|r, c| if (r + c) % 2 == 0 { 1.0 } else { -1.0 });
    check_exact_fields(|r, c| ((r * 5 + c * 3) % 11) as f64 * if r % 3 == 0 { -1.0 } else { 0.5 });
}

/// Slopes in f16 are off by a rounding of theirs, 2^-11 relative, or a subnormal step's half, 2^-25.
#[test]
fn slopes_in_f16_are_rounded_once() {
    let rough = field(13, 11, [2.0, 1.0], |r, c| 9.0 * noise(1, r, c));
    let mut azimuths = even(20, rough.cell_m());
    let sweep = |azimuths: &mut [Azimuth], slopes_f16| {
        let options = SweepOptions { slopes_f16, ..SweepOptions::default() };
        swept(&rough, Border::Open, azimuths, [0; 2], options)
    };
    let (whole, halves) = (sweep(&mut azimuths, false), sweep(&mut azimuths, true));
    for (w, h) in whole.cols.slopes.iter().zip(&halves.cols.slopes) {
        let (w, h) = (f64::from(*w), f64::from(*h));
        let bound = w.abs() * EPSILON * 8192.0 + EPSILON / 2.0;
        assert!((w - h).abs() <= bound || (w == -1e9 && h == -65504.0), "{w} {h}");
    }
}

/// A line keeps its number from step to step, and no two lines of a step share one.
#[test]
fn lines_are_numbered_as_the_shaders_number_them() {
    let (lanes, total) = (6, 9);
    for border in BORDERS {
        for line_shift in 13..=16 {
            for shear in [0, 1, 4390, 16384, 20000, CELL] {
                let spacing = 1 << line_shift;
                let slots = lattice::slots(lanes as usize, line_shift, border) as i32;
                for (step, slot) in (0..total).flat_map(|t| (0..slots).map(move |s| (t, s))) {
                    let y = line_position(slot, step, shear, line_shift);
                    let line = line_number((slot, slots), (step, total), shear, line_shift, border);
                    let lead = ((total - 1) * shear + spacing - 1) >> line_shift;
                    if border == Border::Periodic {
                        assert_eq!((line * spacing + step * shear - y) % (lanes * CELL), 0);
                        assert!((0..slots).contains(&line));
                    } else {
                        assert_eq!((line - lead) * spacing + step * shear, y);
                        assert!(line >= 0 && line < slots + lead);
                    }
                }
            }
        }
    }
}
