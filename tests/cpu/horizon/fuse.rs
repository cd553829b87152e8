//! `sweep_fuse`: every mode against the oracle and against marches along the samples' own lines.

use super::*;
use ridgelight::plan::azimuths::{along_grid_vectors, even};
use ridgelight::scene::Fuse;
use ridgelight::scene::fractal;
use ridgelight_cpu::horizon_march::marched as march_of;
use ridgelight_cpu::lattice::line_position;
use ridgelight_cpu::shared::fuse::{Found, nearest_line};
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::shared::sweep::{March, NO_SLOPE, on_field};
use ridgelight_cpu::surface_sweep::surface_sweep;
use ridgelight_cpu::sweep_fuse::{fused_horizon, sweep_fuse};
use ridgelight_cpu::tolerance::{aimed_slope, march_slope, sweep_slope};

pub(crate) const FUSES: [Fuse; 6] =
    [Fuse::Nearest, Fuse::Slopes, Fuse::Own, Fuse::AimedNearest, Fuse::Aimed, Fuse::AimedAround];

fn aims(fuse: Fuse) -> bool {
    matches!(fuse, Fuse::AimedNearest | Fuse::Aimed | Fuse::AimedAround)
}

/// Sweeps and passes the swept field in one mode after the other to `check`.
fn each_mode(
    field: &HeightField,
    border: Border,
    azimuths: &mut [Azimuth],
    options: SweepOptions,
    mut check: impl FnMut(&Swept, Fuse),
) {
    let warm_up = warm_ups(field, border);
    let lattices = swept(field, border, azimuths, warm_up, options);
    for fuse in FUSES {
        let swept = Swept {
            heights: Heights::of(field, border),
            azimuths,
            lattices: &lattices,
            fuse: Some(fuse),
            line_shift: options.line_shift,
            warm_up,
        };
        check(&swept, fuse);
    }
}

pub(crate) fn texels(field: &HeightField) -> impl Iterator<Item = (i32, i32)> {
    let cols = field.cols();
    (0..field.rows() * cols).map(move |i| ((i % cols) as i32, (i / cols) as i32))
}

/// Aimed modes use points of the surface on the texel's own line: never above the exact horizon, at every
/// border, spacing and size.
#[test]
fn aimed_modes_are_lower_bounds() {
    for (i, (rows, cols)) in SIZES.into_iter().enumerate() {
        for border in BORDERS {
            for line_shift in [14, 15, 16, 17] {
                // A period has to be a whole number of spacings.
                if border == Border::Periodic && line_shift > 15 {
                    continue;
                }
                let rough = field(rows, cols, [3.0, 2.0], |r, c| 9.0 * noise(i as u64, r, c));
                let oracle = Oracle::new(&rough, border);
                let (largest, _) = extent(&rough);
                let options = SweepOptions { line_shift, ..SweepOptions::default() };
                let mut azimuths = even(20, rough.cell_m());
                each_mode(&rough, border, &mut azimuths, options, |swept, fuse| {
                    for (azimuth, (col, row)) in
                        swept.azimuths.iter().flat_map(|a| texels(&rough).map(move |s| (a, s)))
                    {
                        let found = swept.found(azimuth, col, row);
                        let vector = grid_vector(azimuth);
                        let ground_truth = oracle.horizon_along(row as usize, col as usize, vector);
                        let bound = ground_truth.map_or(-1e9, |t| t.slope);
                        let tolerance = aimed_slope(largest, azimuth.step_m.into());
                        assert!(
                            !aims(fuse) || f64::from(found.slope) <= bound + tolerance,
                            "{fuse:?} {border:?} {line_shift} ({row}, {col}) {azimuth:?} {found:?} {ground_truth:?}"
                        );
                    }
                });
            }
        }
    }
}

/// On axes and diagonals a line passes through every texel: each mode finds all that unit steps do; aimed ones
/// also find the first diagonal where it lies across.
#[test]
fn on_axes_and_diagonals_every_mode_is_the_march() {
    for border in BORDERS {
        for (rows, cols) in SIZES {
            let rough = field(rows, cols, [1.0, 2.0], |r, c| 9.0 * noise(5, r, c));
            let (largest, relief) = extent(&rough);
            // Axes of any cell; diagonals of the grid.
            let mut azimuths = along_grid_vectors(4, rough.cell_m()).expect("vectors");
            azimuths.extend(
                along_grid_vectors(8, [1.0, 1.0]).expect("vectors").iter().skip(1).step_by(2),
            );
            let warm_up = warm_ups(&rough, border);
            let unit = marched(&rough, border, &mut azimuths, warm_up, false);
            let all = marched(&rough, border, &mut azimuths.clone(), warm_up, true);
            each_mode(&rough, border, &mut azimuths, SweepOptions::default(), |swept, fuse| {
                for (azimuth, (col, row)) in
                    swept.azimuths.iter().flat_map(|a| texels(&rough).map(move |s| (a, s)))
                {
                    let march = March::new(swept.heights, azimuth);
                    let (lane, step) = march.of_grid_point(col, row);
                    let at = |l: &Lattices| {
                        let l = l.of(azimuth);
                        l.slopes[l.texel(lane, march.march_position(step), azimuth.layer)]
                    };
                    let found = swept.found(azimuth, col, row).slope;
                    let tolerance =
                        (sweep_slope(largest.max(relief), azimuth.step_m.into())) as f32;
                    let low = at(&unit) - tolerance;
                    let high = if aims(fuse) { at(&all) } else { at(&unit) } + tolerance;
                    assert!(
                        (low..=high).contains(&found),
                        "{fuse:?} {border:?} {azimuth:?} {found}"
                    );
                }
            });
        }
    }
}

/// Mean errors of a fractal field, degrees, in the order of the modes, and how they compare to each
/// other. Aimed modes start from the same first crossings, and two proposals are at least as high as
/// one. That interpolating beats the nearer line, and aiming both, is measured on DEMs
/// (0.51, 0.40, 0.38, 0.077, 0.047 degrees on the roughest), not derived.
#[test]
fn errors_fall_from_mode_to_mode() {
    let rough = fractal(128, 3).unwrap();
    let oracle = Oracle::new(&rough, Border::Plane);
    let mut azimuths = even(32, rough.cell_m());
    let picked: Vec<(i32, i32)> = texels(&rough)
        .filter(|(c, r)| (c * 7 + r * 11) % 29 == 0 || (c * r == 0 && (c + r) % 9 == 0))
        .collect();
    let ground_truth: Vec<f64> = azimuths
        .iter()
        .flat_map(|a| {
            picked
                .iter()
                .map(|(c, r)| {
                    let angle = a.swept_rad(rough.cell_m());
                    oracle.elevation_rad(*r as usize, *c as usize, angle)
                })
                .collect::<Vec<_>>()
        })
        .collect();
    let (largest, _) = extent(&rough);
    let tolerance = aimed_slope(largest, 1.0);
    let mut errors = Vec::new();
    each_mode(&rough, Border::Plane, &mut azimuths, SweepOptions::default(), |swept, fuse| {
        let pairs = swept.azimuths.iter().flat_map(|a| picked.iter().map(move |s| (a, s)));
        let mut sum = 0.0;
        for ((azimuth, (col, row)), ground_truth) in pairs.zip(&ground_truth) {
            let off = fused_horizon(swept, azimuth, *col, *row).angle_rad - ground_truth;
            assert!(!aims(fuse) || off <= tolerance, "{fuse:?} ({row}, {col}) {off}");
            sum += off.abs();
        }
        errors.push((sum / ground_truth.len() as f64).to_degrees());
    });
    println!("mean errors {errors:?}");
    let [nearest, slopes, own, aimed_nearest, aimed, around] = errors[..] else { unreachable!() };
    assert!(slopes < nearest && own < nearest);
    assert!(aimed < aimed_nearest && aimed_nearest < 0.5 * slopes.min(own));
    assert!(around < 0.5 * aimed);
}

/// A roof on level ground whose ridge runs along the cells' diagonals: any line rises to where it crosses the ridge and
/// falls from there, so the highest whole step lies next to the crossing. The mode that reads beside the nearer line's
/// occluder matches a march over all crossings wherever the horizon is within a step of it; aiming at whole steps misses
/// some of those crossings.
#[test]
fn a_ridge_between_steps_is_met() {
    let roof =
        field(31, 37, [2.0, 3.0], |r, c| (9.0 - 2.0 * (c as f64 - r as f64 - 3.0).abs()).max(0.0));
    let (_, relief) = extent(&roof);
    let mut azimuths = even(32, roof.cell_m());
    let (mut all, mut beside, mut missed) = (0, 0, 0);
    each_mode(&roof, Border::Plane, &mut azimuths, SweepOptions::default(), |swept, fuse| {
        if !matches!(fuse, Fuse::Aimed | Fuse::AimedAround) {
            return;
        }
        for azimuth in swept.azimuths {
            let march = March::new(swept.heights, azimuth);
            for (col, row) in texels(&roof) {
                let (lane, step) = march.of_grid_point(col, row);
                let options = MarchOptions { all_crossings: true, warm_up: 0 };
                let ground_truth = march_of(&march, lane, step, options);
                let line = nearest_line(swept, &march, (lane * CELL, step));
                let back = line.map_or(0, |(_, i)| swept.lattices.of(azimuth).occluders[i]);
                let is_beside = back > 0 && (ground_truth.steps - f32::from(back)).abs() <= 1.0;
                let found = swept.found(azimuth, col, row).slope;
                let tolerance = march_slope(relief, azimuth.step_m.into());
                // Where nothing rises the horizon is the far edge's.
                let is_met = ground_truth.slope <= 0.0
                    || f64::from((found - ground_truth.slope).abs()) <= tolerance;
                assert!(
                    is_met || fuse == Fuse::Aimed || !is_beside,
                    "({row}, {col}) {azimuth:?} {found} {ground_truth:?}"
                );
                all += usize::from(ground_truth.slope > 0.0);
                beside += usize::from(ground_truth.slope > 0.0 && is_beside);
                missed += usize::from(!is_met && is_beside);
            }
        }
    });
    assert!(missed > 0, "whole steps are enough here");
    assert!(
        5 * beside > 4 * all,
        "{beside} of {all} horizons are beside the nearer line's occluder"
    );
}

/// The lines beside a texel, found by testing all of them: the lower within a spacing or through the texel, the upper
/// within one; the nearer, or the lower of two equally near; where one lies outside the field, the other alone.
#[test]
fn the_lines_beside_a_sample_are_the_nearest_there_are() {
    for border in BORDERS {
        let rough = field(8, 6, [1.0, 2.0], |r, c| 9.0 * noise(7, r, c));
        for line_shift in 13..=16 {
            let options = SweepOptions { line_shift, ..SweepOptions::default() };
            let mut azimuths = even(20, rough.cell_m());
            each_mode(&rough, border, &mut azimuths, options, |swept, fuse| {
                for (azimuth, (col, row)) in
                    swept.azimuths.iter().flat_map(|a| texels(&rough).map(move |s| (a, s)))
                {
                    let march = March::new(swept.heights, azimuth);
                    let (lane, step) = march.of_grid_point(col, row);
                    let lattice = swept.lattices.of(azimuth);
                    let total = step + warm_up_of(swept.warm_up, azimuth);
                    let (y, spacing, period) = (lane * CELL, 1 << line_shift, march.lanes * CELL);
                    // (how far before or after, slope) of every line that exists at this step.
                    let (mut before, mut after) = (None, None);
                    for slot in 0..lattice.width as i32 {
                        let line = line_position(slot, total, azimuth.shear, line_shift);
                        let texel = lattice.texel(slot, march.march_position(step), azimuth.layer);
                        let slope = Some(lattice.slopes[texel]).filter(|s| *s > NO_SLOPE);
                        let repeats: &[i32] = if march.periodic() { &[-1, 0, 1] } else { &[0] };
                        for line in repeats.iter().map(|n| line + n * period) {
                            if !march.periodic() && !on_field(line, march.lanes) {
                                continue;
                            }
                            if line <= y && y - line < spacing {
                                before = Some((y - line, slope));
                            }
                            if line > y && line - y < spacing {
                                after = Some((line - y, slope));
                            }
                        }
                    }
                    let through = before.is_some_and(|(d, _)| d == 0);
                    let after = after.filter(|_| !through);
                    let expected = match fuse {
                        Fuse::Nearest => match (before, after) {
                            (Some((b, _)), Some((a, slope))) if a < b => slope,
                            (Some((_, slope)), _) | (None, Some((_, slope))) => slope,
                            (None, None) => None,
                        },
                        Fuse::Slopes => match (before, after) {
                            (Some((b, Some(low))), Some((_, Some(high)))) => {
                                let t = b as f32 / spacing as f32;
                                Some(low * (1.0 - t) + high * t)
                            }
                            (Some((_, Some(one))), _) | (_, Some((_, Some(one)))) => Some(one),
                            _ => None,
                        },
                        _ => continue,
                    };
                    let found = swept.found(azimuth, col, row).slope;
                    let place = (row, col);
                    assert_eq!(
                        found,
                        expected.unwrap_or(NO_SLOPE),
                        "{fuse:?} {place:?} {azimuth:?}"
                    );
                }
            });
        }
    }
}

/// Flat ground: slope exactly 0 wherever there is an occluder, in every mode.
#[test]
fn flat_ground_is_at_slope_0() {
    let flat = field(6, 5, [2.0, 3.0], |_, _| 17.0);
    for border in BORDERS {
        for line_shift in [13, 14, 15] {
            let options = SweepOptions { line_shift, ..SweepOptions::default() };
            each_mode(&flat, border, &mut even(24, flat.cell_m()), options, |swept, _| {
                for h in sweep_fuse(swept) {
                    let nothing = h.found.slope == NO_SLOPE && border != Border::Periodic;
                    assert!(h.found.slope == 0.0 || nothing);
                    assert!(h.angle_rad == 0.0 || (nothing && border == Border::Open));
                    assert!(h.distance_m == 0.0 || border == Border::Open);
                }
            });
        }
    }
}

/// A ramp has one slope along an azimuth: a mode finds it or nothing, edges included; aimed modes find it
/// wherever the texel's own line stays on the field for a step. `Own` does not: it uses a place on a
/// neighbouring line, higher or lower across the march, and only two equally distant places average out.
#[test]
fn a_ramp_has_its_slope_up_to_the_edge() {
    let ramp = field(9, 12, [1.0, 2.0], |r, c| 0.5 * c as f64 - 0.25 * r as f64);
    let (largest, _) = extent(&ramp);
    for line_shift in [14, 15, 16] {
        let options = SweepOptions { line_shift, ..SweepOptions::default() };
        each_mode(&ramp, Border::Open, &mut even(24, ramp.cell_m()), options, |swept, fuse| {
            for (azimuth, (col, row)) in
                swept.azimuths.iter().flat_map(|a| texels(&ramp).map(move |s| (a, s)))
            {
                let found = swept.found(azimuth, col, row).slope;
                let vector = grid_vector(azimuth);
                let [x, y] = [vector[0], -2.0 * vector[1]];
                let slope = (0.5 * x + 0.125 * y) / x.hypot(y);
                let near = (f64::from(found) - slope).abs()
                    <= 2.0 * sweep_slope(largest, azimuth.step_m.into());
                let march = March::new(swept.heights, azimuth);
                let (lane, step) = march.of_grid_point(col, row);
                let stays = step > 0 && (lane > 0 || azimuth.shear == 0);
                if aims(fuse) {
                    assert_eq!(near, stays, "{fuse:?} ({row}, {col}) {azimuth:?} {found}");
                }
                let passes = near || found == NO_SLOPE || fuse == Fuse::Own;
                assert!(passes, "{fuse:?} ({row}, {col}) {azimuth:?} {found}");
            }
        });
    }
}

/// Horizons of a pass that finds them per texel are passed on unchanged.
#[test]
fn direct_hands_on_slopes_and_distances() {
    let rough = field(8, 6, [1.0, 2.0], |r, c| 9.0 * noise(5, r, c));
    let mut azimuths = along_grid_vectors(12, rough.cell_m()).expect("vectors");
    number_layers(&mut azimuths);
    let heights = Heights::of(&rough, Border::Open);
    let mut lattices = Lattices::new(&azimuths, [6, 8], 15, Border::Open);
    for azimuth in &azimuths {
        surface_sweep(heights, azimuth, 0, lattices.of_mut(azimuth));
    }
    let swept = Swept {
        heights,
        azimuths: &azimuths,
        lattices: &lattices,
        fuse: None,
        line_shift: 15,
        warm_up: [0; 2],
    };
    let oracle = Oracle::new(&rough, Border::Open);
    let (largest, _) = extent(&rough);
    for azimuth in &azimuths {
        for (col, row) in texels(&rough) {
            let Found { slope, steps } = swept.found(azimuth, col, row);
            let tolerance = 10.0 * sweep_slope(largest, azimuth.step_m.into());
            let place = (row as usize, col as usize);
            check_exact(&oracle, place, azimuth, (slope, steps), tolerance, None).unwrap();
        }
    }
}

/// A field turned by half a turn is the same surface, its sweeps the same to the bit; a quarter turn keeps
/// lines but turns the split, which only aimed modes use.
#[test]
fn rotated_fields_have_rotated_horizons() {
    let (rows, cols) = (11, 14);
    let h = |r: usize, c: usize| 9.0 * noise(5, r, c);
    let original = field(rows, cols, [1.0, 2.0], h);
    let half = field(rows, cols, [1.0, 2.0], |r, c| h(rows - 1 - r, cols - 1 - c));
    // Counter-clockwise: texel (r, c) goes to (cols - 1 - c, r).
    let quarter = field(cols, rows, [2.0, 1.0], |r, c| h(c, cols - 1 - r));
    let count = 16_usize;
    let all = |field: &HeightField| {
        let mut answers = Vec::new();
        let mut azimuths = even(count as u32, field.cell_m());
        each_mode(field, Border::Plane, &mut azimuths, SweepOptions::default(), |swept, _| {
            answers.push(sweep_fuse(swept));
        });
        answers
    };
    let (here, turned, quartered) = (all(&original), all(&half), all(&quarter));
    for (mode, fuse) in FUSES.into_iter().enumerate() {
        for k in 0..count {
            for (c, r) in texels(&original).map(|(c, r)| (c as usize, r as usize)) {
                let a = here[mode][(k * rows + r) * cols + c].found.slope;
                let opposite = (k + count / 2) % count;
                let b = turned[mode][(opposite * rows + rows - 1 - r) * cols + cols - 1 - c];
                assert_eq!(a, b.found.slope, "{fuse:?} {k} ({r}, {c})");
                if !aims(fuse) {
                    let next = (k + count / 4) % count;
                    let b = quartered[mode][(next * cols + cols - 1 - c) * rows + r];
                    assert_eq!(a, b.found.slope, "{fuse:?} {k} ({r}, {c})");
                }
            }
        }
    }
}
