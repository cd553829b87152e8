//! Windows on heights by lanes change times, never the light.

use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{Border, HeightField, Method, Quality, Scene, fractal};

use crate::{Device, field, under_sky};

fn rough(rows: usize, cols: usize) -> HeightField {
    let all = fractal(64, 3).expect("a field");
    let heights = all.heights_m();
    field(rows, cols, [1.0, 1.5], |r, c| heights[r * 64 + c].into())
}

fn window_bytes(plan: &Plan) -> u64 {
    let windows = plan.resources.iter().filter(|r| r.name.starts_with("lane_windows"));
    windows.map(|r| r.bytes()).sum()
}

/// With a memory budget that leaves the windows out, every bit of the light stays. Odd sizes, and fields narrower than a window.
#[test]
fn light_is_the_same_without_windows() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let limits = crate::limits_of(gpu);
    let mut compared = 0;
    for (rows, cols) in [(53, 41), (2, 37), (3, 3), (1, 5)] {
        for border in [Border::Plane, Border::Open, Border::Periodic] {
            for method in [Method::Sweep, Method::BruteForce] {
                let scene: Scene = under_sky(rough(rows, cols), border);
                let quality = Quality { azimuths: 8, method, ..Quality::default() };
                let planned = |limits: &Limits| {
                    plan::picture(&scene, &quality, limits, Picture::default()).expect("a plan")
                };
                let with = planned(&limits);
                let bytes = window_bytes(&with);
                // Drivers that sweep one line per invocation have none.
                if bytes == 0 {
                    continue;
                }
                // 16: WINDOWS_DIVISOR. The rest of the plan needs this, too.
                let budget = with.bytes().max(16 * bytes - 1);
                let without = planned(&Limits { memory_budget: budget, ..limits });
                if window_bytes(&without) > 0 {
                    assert!(with.bytes() > 16 * bytes - 1, "{rows} × {cols}");
                    continue;
                }
                let [a, b] = [with, without].map(|plan| {
                    let mut frame = gpu.frame(plan, &[scene.field.heights_m()]).expect("a frame");
                    gpu.draw(&mut frame).expect("drawn");
                    let bits = crate::bits(gpu, &frame);
                    gpu.end(frame);
                    bits
                });
                assert_eq!(a, b, "{rows} × {cols} {border:?} {method:?}");
                compared += 1;
            }
        }
    }
    let is_swiftshader = gpu.report().name.contains("SwiftShader");
    assert!(compared >= if is_swiftshader { 1 } else { 12 }, "{compared} compared");
}
