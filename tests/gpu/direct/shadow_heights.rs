//! Shadow heights, as an engine updates them.

use ridgelight::gpu::Pixels;
use ridgelight::plan::{self, Plan};
use ridgelight::scene::{HeightField, Sun, fractal};

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

/// One renderer per field is enough for all suns, along either axis, one part at a time: the bits are those of a new renderer that draws
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
    gpu.gpu.as_mut().expect("alive").end(kept.expect("a frame"));
}
