//! Shadow heights, as an engine updates them.

use ridgelight::gpu::Pixels;
use ridgelight::plan::{self, Plan};
use ridgelight::scene::{HeightField, Sun, fractal};

use ridgelight_cpu::shadow_height::segment;

use crate::{Device, field};

/// Suns of a day: all octants, a point and wide discs, rising and in the zenith.
fn day() -> impl Iterator<Item = Sun> {
    (0..9_u8).map(|i| Sun {
        azimuth_rad: 0.3 + 0.7 * f64::from(i),
        elevation_rad: [0.0, 0.2, 0.6, 1.57][usize::from(i % 4)],
        diameter_rad: [0.01, 0.0, 0.2][usize::from(i % 3)],
        irradiance: [1.0; 3],
    })
}

fn bits(outputs: &[Pixels]) -> Vec<u32> {
    outputs.iter().flat_map(|o| &o.values).map(|v| v.to_bits()).collect()
}

/// A coarse field, and a finer one in its middle.
fn levels() -> [HeightField; 2] {
    let coarse = fractal(130, 7).expect("a field");
    let [x, y] = coarse.cell_m();
    let around = |r: usize, c: usize| {
        let at = |r: usize, c: usize| f64::from(coarse.heights_m()[r * 130 + c]);
        coarse.base_m()
            + 0.5 * (at(40 + r / 2, 30 + c / 2) + at(40 + r.div_ceil(2), 30 + c.div_ceil(2)))
    };
    let fine = field(140, 130, [x / 2.0, y / 2.0], around);
    [coarse, fine]
}

/// One renderer per field is enough for all suns and places, along either axis, one part at a time: the bits are those of a new renderer that draws
/// everything at once.
#[test]
fn one_renderer_updates_all_suns_in_parts() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let [coarse, fine] = levels();
    let plan_of = |sun: &Sun, parts: u32| -> [Plan; 2] {
        let outer = Some((&coarse, [30.0, 40.0]));
        [(&coarse, None), (&fine, outer)].map(|(field, outer)| {
            plan::shadow_heights(field, sun, outer, parts, &limits).expect("a plan")
        })
    };
    let mut kept = None;
    for sun in day() {
        let [around, within] = plan_of(&sun, 1);
        let outer = gpu.draw(around, &[coarse.heights_m()]);
        let inputs = [fine.heights_m(), &outer[0].values, &outer[1].values];
        let whole = gpu.draw(within, &inputs);
        assert!(whole.iter().flat_map(|o| &o.values).all(|v| v.is_finite()), "{sun:?}");
        let [_, plan] = plan_of(&sun, 2);
        let device = gpu.gpu.as_mut().expect("alive");
        let frame = match &mut kept {
            Some(frame) => {
                let changed = device.replace_plan(frame, plan).expect("the same passes");
                assert_eq!(changed, [0, 1], "{sun:?}");
                device.draw_passes(frame, &[1]).expect_err("pass 0 of the new sun is pending");
                frame
            }
            none => none.insert(device.frame(plan, &inputs).expect("a frame")),
        };
        for (i, values) in inputs.iter().enumerate() {
            device.refill(frame, i, values).expect("refilled");
        }
        for part in [0, 1] {
            device.draw_passes(frame, &[part]).expect("drawn");
        }
        let of_parts: Vec<_> =
            (0..3).map(|i| device.pixels(frame, i).expect("read back")).collect();
        assert_eq!(bits(&of_parts), bits(&whole), "{sun:?}");
    }
    // Another place in the outer field.
    let (sun, mut frame) = (day().next().expect("a sun"), kept.expect("a frame"));
    let plan = plan::shadow_heights(&fine, &sun, Some((&coarse, [11.5, 2.0])), 2, &limits);
    let device = gpu.gpu.as_mut().expect("alive");
    assert_eq!(device.replace_plan(&mut frame, plan.expect("a plan")).expect("replaced"), [0, 1]);
    device.end(frame);
}

/// In world coordinates: a wall in an outer field of other cells and another base than the inner field's shades it by the closed form.
/// The heights of both are f32 over their bases, and cells are divided in f32: 8 ε of heights, and of distances times the ray's slope.
#[test]
fn a_wall_of_the_outer_field_is_where_it_is() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    // The wall is at x = 30 × 9 m. Bases are the medians: 480 and 500 m.
    let outer = field(60, 40, [9.0, 8.0], |_, c| if c == 30 { 560.0 } else { 480.0 });
    let inner = field(70, 65, [2.0, 1.5], |_, _| 500.0);
    let place = [3.5, 20.25];
    for (degrees, elevation_rad) in [(0.0_f64, 0.35_f64), (14.0, 0.4), (-9.0, 0.38)] {
        let sun = Sun {
            azimuth_rad: degrees.to_radians(),
            elevation_rad,
            diameter_rad: 0.1,
            irradiance: [1.0; 3],
        };
        let plan = plan::shadow_heights(&outer, &sun, None, 1, &limits).expect("a plan");
        let around = gpu.draw(plan, &[outer.heights_m()]);
        let plan = plan::shadow_heights(&inner, &sun, Some((&outer, place)), 1, &limits);
        let inputs = [inner.heights_m(), &around[0].values, &around[1].values];
        let maps = gpu.draw(plan.expect("a plan"), &inputs);
        let [low, high] = [-0.05, 0.05].map(|half| (elevation_rad + half).tan());
        let mut partly = 0;
        for (i, lit_above) in maps[0].values.iter().enumerate() {
            let x = place[0] * 9.0 + (i % 65) as f64 * 2.0;
            // Along the ray; azimuths are rounded to 1.6e-5.
            let distance = (270.0 - x) / degrees.to_radians().cos();
            let found = f64::from(*lit_above) + inner.base_m();
            let tolerance = 8.0 * 2.0_f64.powi(-24) * (560.0 + distance * low) + 3e-5 * distance;
            let expected =
                (560.0 - distance * low).max(500.0 - low * 2.0 / degrees.to_radians().cos());
            assert!((found - expected).abs() < tolerance, "{degrees} {i}: {found} {expected}");
            let horizon = (60.0 / distance).atan();
            let hidden = (horizon - low.atan()) / 0.1;
            let share = f64::from(maps[2].values[i]);
            let expected = segment(hidden);
            // The occluder's slope errs by its height and, by the width of the penumbra, its distance; a share by 4/π of that.
            let slope = tolerance / distance + 1e-4 * 60.0 / distance;
            assert!(
                (share - expected).abs() < 1.3 * slope / 0.1,
                "{degrees} {i}: {share} {expected}"
            );
            // Azimuths turn distances by 3e-5 of them; the outer field's widths are f32 of sums of 40 of its steps.
            let wide = distance * (high - low);
            let found = f64::from(maps[1].values[i]);
            if hidden > 0.0 {
                assert!((found - wide).abs() < 1e-4 * wide, "{degrees} {i}: {found} {wide}");
                partly += usize::from(hidden < 1.0);
            }
        }
        assert!(partly > 1000, "{partly} grid points in the penumbra");
    }
}
