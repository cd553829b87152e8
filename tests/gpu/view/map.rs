//! Maps for screens: the bits of the CPU reference's, which a PNG of the same light has.

use ridgelight::plan::{self, Map};
use ridgelight::scene::Tone;
use ridgelight_cpu::map_draw::map_draw;

use crate::{Device, random};

/// Every code, values just below, and NaN.
fn light(tone: Tone, count: usize) -> Vec<[f32; 3]> {
    let mut next = random(7);
    let steps = tone.steps();
    let mut value = |i: usize| match i % 8 {
        0 => steps[(next() * 256.0) as usize],
        1 => steps[(next() * 256.0) as usize].next_down(),
        2 => [f32::NAN, f32::INFINITY, -1.0, 0.0, -0.0, f32::MAX][(next() * 6.0) as usize],
        _ => (next() * 20.0 - 14.0).exp() as f32,
    };
    (0..count).map(|i| [value(3 * i), value(3 * i + 1), value(3 * i + 2)]).collect()
}

/// The device's codes.
fn drawn(
    device: &mut Device,
    map: &Map,
    light: &[[f32; 3]],
    voids: Option<&[bool]>,
) -> Vec<[u8; 4]> {
    let gpu = device.gpu.as_mut().expect("alive");
    let plan = plan::map(map, &crate::limits_of(gpu)).expect("a plan");
    let picture = plan.find("picture").expect("its output");
    let radiance: Vec<f32> = if map.has_colour {
        light.iter().flat_map(|c| [c[0], c[1], c[2], 1.0]).collect()
    } else {
        light.iter().map(|c| c[0]).collect()
    };
    let marks: Option<Vec<f32>> =
        voids.map(|v| v.iter().map(|v| f32::from(u8::from(*v))).collect());
    let steps = map.tone.steps();
    let mut contents: Vec<&[f32]> = vec![&radiance, &steps];
    contents.extend(marks.as_deref());
    let mut frame = gpu.frame(plan, &contents).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let words = gpu.read(&frame, picture).expect("read back");
    gpu.end(frame);
    words.into_iter().map(u32::to_le_bytes).collect()
}

#[test]
fn maps_match_the_cpu_reference_to_the_bit() {
    let mut device = Device::new();
    let field = [37, 23];
    let at_once = Map {
        field,
        has_colour: true,
        has_voids: false,
        size: field,
        corner: [0.0; 2],
        grid_points_per_pixel: 1.0,
        is_smooth: false,
        tone: Tone::default(),
        swaps: false,
    };
    let grey = Map { has_colour: false, ..at_once };
    let near = Map {
        has_voids: true,
        size: [61, 40],
        corner: [-3.25, 7.5],
        grid_points_per_pixel: 0.37,
        swaps: true,
        ..at_once
    };
    let far = Map { size: [19, 30], corner: [5.0, -8.0], grid_points_per_pixel: 1.7, ..grey };
    let farther = Map { grid_points_per_pixel: 3.3, size: [13, 9], ..near };
    let smooth = Map { is_smooth: true, ..near };
    let voids: Vec<bool> = (0..37 * 23).map(|i| i % 11 == 3).collect();
    let smooth_ground = Map { has_voids: false, ..smooth };
    let tones = [1.0, 0.0, 3.7, 1e-3, 1e34, f32::MIN_POSITIVE, 0.6, 1.0].map(Tone::picture);
    let clips = |exposure| Tone { exposure, shoulder: 1.0 };
    let maps = [at_once, grey, near, far, grey, grey, smooth, smooth_ground];
    let with_tones = maps.into_iter().zip(tones);
    for (map, tone) in with_tones.chain([(farther, clips(1.3)), (at_once, clips(0.7))]) {
        let map = Map { tone, ..map };
        let mut light = light(tone, 37 * 23);
        if !map.has_colour {
            light.iter_mut().for_each(|c| *c = [c[0]; 3]);
        }
        let voids = map.has_voids.then_some(voids.as_slice());
        let want = map_draw(&map, &light, voids);
        let got = drawn(&mut device, &map, &light, voids);
        assert!(got == want, "{map:?}: {} pixels differ", differing(&got, &want));
        // The comparison can fail.
        let brighter = Map { tone: Tone { exposure: 1.1 * tone.exposure + 0.1, ..tone }, ..map };
        let brighter = map_draw(&brighter, &light, voids);
        assert!(differing(&brighter, &want) > 10, "{map:?}");
    }
}

/// Beyond these exposures devices may flush thresholds or light to 0.
#[test]
fn maps_refuse_exposures_that_they_cannot_draw() {
    let device = Device::new();
    let limits = crate::limits_of(device.gpu.as_ref().expect("alive"));
    let map = |exposure: f32, shoulder: f32| Map {
        field: [4, 4],
        has_colour: false,
        has_voids: false,
        size: [4, 4],
        corner: [0.0; 2],
        grid_points_per_pixel: 1.0,
        is_smooth: false,
        tone: Tone { exposure, shoulder },
        swaps: false,
    };
    let is_drawn = |(exposure, shoulder)| plan::map(&map(exposure, shoulder), &limits).is_ok();
    assert!([(0.0, 0.8), (f32::MIN_POSITIVE, 0.0), (1e34, 1.0)].into_iter().all(is_drawn));
    let (nan, most) = (f32::NAN, f32::INFINITY);
    let beyond =
        [(1e-39, 0.8), (1.1e34, 0.8), (-1.0, 0.8), (nan, 0.8), (most, 0.8), (1.0, 1.1), (1.0, nan)];
    assert!(!beyond.into_iter().any(is_drawn));
}

fn differing(a: &[[u8; 4]], b: &[[u8; 4]]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}
