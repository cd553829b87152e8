//! Work that one unit of the device limits. All values are exact: no tolerance.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::{Border, Lights, Quality, Scene, Surface};
use ridgelight_cpu::device_peak as peak_reference;

use crate::cpu_reference::{
    Case, Pair, Reference, Run, Wanted, check_all, constant, pushed, rough,
};

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] = &[("device_peak", device_peak)];

/// Of buffers of 1 and of 1/2 MiB.
pub(crate) fn peaks() -> Vec<Case> {
    let case = |name, budget| Case {
        name,
        // Not used.
        scene: Scene {
            field: rough(4, 4, 1),
            surface: Surface { border: Border::Plane, ..Surface::default() },
            lights: Lights::default(),
        },
        quality: Quality::default(),
        wanted: Wanted::DevicePeak(budget),
        loses_lines: false,
    };
    vec![case("peak rates", 16 << 20), case("peak rates of a small budget", 8 << 20)]
}

fn device_peak(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const INVOCATIONS: usize = offset("DevicePeakPush", "invocations");
    const ROUNDS: usize = offset("DevicePeakPush", "rounds");
    const SIDE: usize = offset("DevicePeakPush", "side");
    let [count, rounds, side] = [INVOCATIONS, ROUNDS, SIDE].map(|o| pushed(pass, o) as usize);
    let part = constant(pass, "part");
    let (name, want): (_, Vec<[f32; 4]>) = match part {
        0 => ("source", peak_reference::filled(count, rounds)),
        1 => ("result", peak_reference::filled(count, rounds)),
        2 => ("result", (0..count).map(|i| peak_reference::fetch(i, rounds, side)).collect()),
        3 => ("result", (0..count).map(|i| peak_reference::shared(i, rounds)).collect()),
        _ => ("result", (0..count).map(|i| peak_reference::fma(i, rounds, 0.5, 1.0)).collect()),
    };
    let mut got = run.floats(pass, name).expect("bound");
    got.truncate(4 * want.len());
    let mut want = want.into_flattened();
    if part == 0 {
        let image = run.floats(pass, "filled").expect("bound");
        want.extend((0..image.len()).map(peak_reference::texel));
        got.extend(image);
    }
    assert_eq!(got.len(), want.len());
    let pair = |(i, (got, want)): (usize, (&f32, &f32))| Pair {
        got: (*got).into(),
        want: (*want).into(),
        tolerance: 0.0,
        at: [i % 4, 0, i / 4],
    };
    got.iter().zip(&want).enumerate().map(pair).collect()
}

#[test]
fn work_of_the_peak_rates_is_done() {
    check_all(&peaks());
}
