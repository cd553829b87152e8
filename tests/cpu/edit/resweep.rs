//! `horizon_resweep` against a sweep of everything.

use crate::horizon::fuse::texels;
use crate::horizon::*;
use proptest::prelude::*;
use ridgelight::plan::Rectangle;
use ridgelight::plan::azimuths::even;
use ridgelight::scene::Fuse;
use ridgelight_cpu::dirty_mark::{dirty_mark, place};
use ridgelight_cpu::horizon_resweep::{grown, horizon_resweep};
use ridgelight_cpu::shared::gather::Swept;

/// Heights of a field with a changed rectangle; a new field would have another base.
fn edited(before: &HeightField, rectangle: Rectangle, by: f64) -> Vec<f32> {
    let mut heights = before.heights_m().to_vec();
    for row in rectangle.row..rectangle.row + rectangle.rows {
        let first = row as usize * before.cols() + rectangle.col as usize;
        heights[first..first + rectangle.cols as usize].iter_mut().for_each(|h| *h += by as f32);
    }
    heights
}

/// Sweeps before an edit and continues from there; returns the swept steps, and those of all lines.
fn resweep(
    before: &HeightField,
    after: &[f32],
    rectangle: Rectangle,
    options: SweepOptions,
) -> Result<[usize; 2], String> {
    let mut azimuths = even(24, before.cell_m());
    let mut lattices = swept(before, Border::Plane, &mut azimuths, [0; 2], options);
    let mut whole = lattices.clone();
    let mut dirty = dirty_mark([before.cols(), before.rows()], rectangle);
    let heights = Heights { heights_m: after, ..Heights::of(before, Border::Plane) };
    let mut count = 0;
    for azimuth in &azimuths {
        horizon_sweep(heights, azimuth, &options, whole.of_mut(azimuth));
        let lattice = lattices.of_mut(azimuth);
        count += horizon_resweep(heights, azimuth, &options, rectangle, lattice, &mut dirty);
    }
    let same = lattices.cols.occluders == whole.cols.occluders
        && lattices.rows.occluders == whole.rows.occluders;
    let all = lattices.cols.occluders.len() + lattices.rows.occluders.len();
    if same { Ok([count, all]) } else { Err(format!("{rectangle:?}: other occluders")) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn an_edit_leaves_the_occluders_of_a_whole_sweep(
        seed in any::<u32>(), levels in 1_u32..256, by in -1.0_f64..1.0, line_shift in 13_u32..=17,
        (rows, cols) in (1_usize..40, 1_usize..40), place in [0.0_f64..1.0, 0.0..1.0, 0.0..1.0, 0.0..1.0],
        packed in any::<bool>(),
    ) {
        // Few levels make plateaus.
        let before = field(rows, cols, [3.0, 2.0], |r, c| {
            (noise(seed.into(), r, c) * f64::from(levels)).floor()
        });
        let within = |t: f64, all: usize| ((t * all as f64) as usize).min(all - 1);
        let (col, row) = (within(place[0], cols), within(place[1], rows));
        let rectangle = Rectangle {
            col: col as u32,
            row: row as u32,
            cols: 1 + within(place[2], cols - col) as u32,
            rows: 1 + within(place[3], rows - row) as u32,
        };
        let after = edited(&before, rectangle, by * f64::from(levels));
        let packed = packed.then_some(1.0 / 512.0);
        let options = SweepOptions { line_shift, packed, ..SweepOptions::default() };
        resweep(&before, &after, rectangle, options).map_err(TestCaseError::fail)?;
    }
}

/// Horizons by `aimed-around` that an edit changes at grid points which it does not mark, where the rectangle of the sweep
/// has `by` grid points more on every side.
fn unmarked(by: u32, border: Border, line_shift: u32) -> usize {
    let mut count = 0;
    for seed in 0..24 {
        let before = field(27, 31, [2.0, 3.0], |r, c| 9.0 * noise(seed, r, c));
        // One grid point or a few.
        let (cols, rows) = if seed % 4 < 2 { (1, 1) } else { (3, 2) };
        let rectangle = Rectangle { col: 12, row: 11, cols, rows };
        let after = edited(&before, rectangle, if seed % 2 == 0 { 3.0 } else { -6.0 });
        let options = SweepOptions { line_shift, ..SweepOptions::default() };
        let mut azimuths = even(24, before.cell_m());
        let old = swept(&before, border, &mut azimuths, [0; 2], options);
        let mut new = old.clone();
        let heights = Heights { heights_m: &after, ..Heights::of(&before, border) };
        let mut dirty = dirty_mark([before.cols(), before.rows()], rectangle);
        let wide = grown(rectangle, by, [before.cols(), before.rows()]);
        for azimuth in &azimuths {
            horizon_resweep(heights, azimuth, &options, wide, new.of_mut(azimuth), &mut dirty);
        }
        let found = |heights, lattices, azimuth, (col, row)| {
            let fuse = Some(Fuse::AimedAround);
            let azimuths = &azimuths;
            Swept { heights, azimuths, lattices, fuse, line_shift, warm_up: [0; 2] }
                .found(azimuth, col, row)
        };
        for (azimuth, at) in azimuths.iter().flat_map(|a| texels(&before).map(move |t| (a, t))) {
            let (word, bit) = place([at.0 as usize, at.1 as usize], before.cols());
            let of_old = found(Heights::of(&before, border), &old, azimuth, at);
            let of_new = found(heights, &new, azimuth, at);
            count += usize::from(dirty[word] & bit == 0 && of_old != of_new);
        }
    }
    count
}

/// `aimed-around` reads heights up to two steps beyond an occluder. With a rectangle grown by two grid points on every side, as in
/// plans, every horizon that changes is marked; one point is too few.
#[test]
fn edits_mark_what_reads_beside_occluders() {
    for border in [Border::Plane, Border::Open] {
        for line_shift in [14, 15, 16, 17] {
            assert_eq!(unmarked(2, border, line_shift), 0, "{border:?} {line_shift}");
        }
    }
    let few = [0, 1].map(|by| unmarked(by, Border::Plane, 15));
    println!("unmarked with 0 and 1 more grid points: {few:?}");
    assert!(few[0] > few[1] && few[1] > 0, "{few:?}: fewer grid points are enough");
}

/// On a dome every texel stays on the hull: an edit stays visible until the dome hides it.
#[test]
fn a_small_edit_of_a_rough_field_sweeps_little_and_of_a_dome_is_still_right() {
    let rough = field(200, 200, [1.0, 1.0], |r, c| 3.0 * noise(5, r, c));
    let dome = field(120, 120, [1.0, 1.0], |r, c| {
        let (x, y) = (r as f64 - 60.0, c as f64 - 60.0);
        (20_000.0 - x * x - y * y).sqrt()
    });
    for (i, before) in [rough, dome].iter().enumerate() {
        for by in [-20.0, -0.5, 0.5, 20.0] {
            let rectangle = Rectangle { col: 50, row: 70, cols: 4, rows: 4 };
            let after = edited(before, rectangle, by);
            let options = SweepOptions::default();
            let [count, all] = resweep(before, &after, rectangle, options).unwrap();
            // Nine lines of 200 an azimuth, and at first only texels behind the edit.
            assert!(i == 1 || count * 20 < all, "{count} of {all} texels, raised by {by}");
        }
    }
}
