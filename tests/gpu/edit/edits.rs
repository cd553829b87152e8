//! Edits of a rectangle, drawn incrementally: the same bits as drawing everything.

use ridgelight::gpu::{Frame, Headless, ImageArg, Renderer};
use ridgelight::plan::{self, Picture, Plan, Rectangle, missing_barriers};
use ridgelight::scene::fractal;
use ridgelight::scene::{
    Border, Environment, Fuse, HeightField, KeyLight, Lights, Lines, Method, Precision, Quality,
    Scene, Sun, Surface,
};

use crate::{Device, bits, field, random, under_sky};

fn scene(field: HeightField, border: Border) -> Scene {
    let mut next = random(5);
    let texels = (0..32 * 16).map(|_| [next() as f32, next() as f32, 4.0 * next() as f32]);
    let environment = Environment::new(32, 16, texels.collect(), 0.3).expect("an environment");
    let sun = |azimuth_rad, diameter_rad| Sun {
        azimuth_rad,
        elevation_rad: 0.4,
        diameter_rad,
        irradiance: [2.0, 1.5, 1.0],
    };
    let lights = Lights {
        sky: Some([1.0, 0.9, 0.8]),
        environment: Some(environment),
        suns: vec![sun(1.0, 0.05), sun(4.0, 0.0)],
        keys: vec![KeyLight {
            azimuth_rad: 2.2,
            width_rad: 0.8,
            elevations_rad: [0.1, 0.5],
            radiance: [0.5, 0.7, 0.9],
        }],
        ..Lights::default()
    };
    Scene { field, surface: Surface { border, ..Surface::default() }, lights }
}

fn rough(rows: usize, cols: usize, cell_m: [f64; 2]) -> HeightField {
    let all = fractal(rows.max(cols).next_power_of_two(), 3).expect("a field");
    let (side, heights) = (all.cols(), all.heights_m());
    field(rows, cols, cell_m, |r, c| heights[r * side + c].into())
}

/// Every texel stays on the hull of a line across it: more than a sweep keeps in private memory.
fn dome(rows: usize, cols: usize) -> HeightField {
    let middle = (rows.max(cols) as f64 - 1.0) / 2.0;
    field(rows, cols, [1.0, 1.0], |r, c| {
        let (x, y) = ((c as f64 - middle) / middle, (r as f64 - middle) / middle);
        (2.5 - x * x - y * y).sqrt() * middle
    })
}

/// Few heights: everything ties.
fn plateaus(rows: usize, cols: usize) -> HeightField {
    field(rows, cols, [3.0, 2.0], |r, c| ((r / 9 * 5 + c / 7 * 3) % 4) as f64)
}

fn planned(gpu: &Headless, scene: &Scene, quality: &Quality, keeps_horizons: bool) -> Plan {
    let wanted =
        Picture { keeps_horizons, light_layers: true, sky_view: true, ..Picture::default() };
    plan::picture(scene, quality, &crate::limits_of(gpu), wanted).expect("a plan")
}

fn made(gpu: &mut Headless, scene: &Scene, plan: Plan) -> Frame {
    let environment = scene.lights.environment.iter().flat_map(Environment::texels);
    let texels: Vec<f32> = environment.flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    let contents = [scene.field.heights_m(), &texels];
    let inputs = plan.inputs().count();
    let mut frame = gpu.frame(plan, &contents[..inputs]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    frame
}

/// A rectangle of any size, often at an edge or in a corner, sometimes one texel or all.
fn any_rectangle(next: &mut impl FnMut() -> f64, [cols, rows]: [usize; 2]) -> Rectangle {
    let mut side = |all: usize| {
        let count = match (next() * 6.0) as usize {
            0 => 1,
            1 => all,
            _ => 1 + (next().powi(3) * all as f64) as usize,
        };
        let free = all - count.min(all);
        let first = match (next() * 4.0) as usize {
            0 => 0,
            1 => free,
            _ => (next() * (free + 1) as f64) as usize,
        };
        (first as u32, count.min(all) as u32)
    };
    let ((col, cols), (row, rows)) = (side(cols), side(rows));
    Rectangle { col, row, cols, rows }
}

/// Raises, lowers, levels or roughens.
fn change(
    heights: &mut [f32],
    width: usize,
    rectangle: Rectangle,
    relief: f32,
    next: &mut impl FnMut() -> f64,
) {
    let kind = (next() * 5.0) as usize;
    let by = relief * (next() as f32 - 0.5);
    let Rectangle { col, row, cols, rows } = rectangle;
    for r in row..row + rows {
        for c in col..col + cols {
            let h = &mut heights[r as usize * width + c as usize];
            *h = match kind {
                0 | 1 => *h + by,
                2 => by,
                3 => *h + 0.1 * relief * next() as f32,
                _ => (*h * 0.5).floor(),
            };
        }
    }
}

/// Draws edits one after the other, then every resulting field from scratch: outputs must have equal bits.
fn edits(device: &mut Device, scene: &Scene, quality: &Quality, count: usize, seed: u64) {
    let gpu = device.gpu.as_mut().expect("alive");
    let plan = planned(gpu, scene, quality, true);
    assert_eq!(missing_barriers(&plan.edit_passes), []);
    assert!(!plan.edit_passes.is_empty());
    let mut frame = made(gpu, scene, plan);
    let mut heights = scene.field.heights_m().to_vec();
    let (low, high) = heights.iter().fold((f32::MAX, f32::MIN), |m, h| (m.0.min(*h), m.1.max(*h)));
    let size = [scene.field.cols(), scene.field.rows()];
    let mut next = random(seed);
    let mut found = Vec::new();
    for _ in 0..count {
        let rectangle = any_rectangle(&mut next, size);
        change(&mut heights, size[0], rectangle, (high - low).max(8.0), &mut next);
        gpu.refill(&frame, 0, &heights).expect("refilled");
        gpu.draw_edit(&mut frame, rectangle).expect("drawn");
        found.push((rectangle, heights.clone(), bits(gpu, &frame)));
    }
    for (i, (rectangle, heights, got)) in found.iter().enumerate() {
        gpu.refill(&frame, 0, heights).expect("refilled");
        gpu.draw(&mut frame).expect("drawn");
        let want = bits(gpu, &frame);
        let differing = got.iter().zip(&want).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "edit {i}, {rectangle:?}, {size:?}, {quality:?}");
    }
    gpu.end(frame);
}

/// Eight edits a case, or RIDGELIGHT_EDITS.
#[test]
fn edits_give_the_bits_of_all() {
    let mut device = Device::new();
    let base =
        Quality { azimuths: 12, sun_azimuths: 3, table_elevations: 16, ..Quality::default() };
    let (plane, open) = (Border::Plane, Border::Open);
    let cases = [
        (rough(70, 90, [30.0, 20.0]), plane, base),
        (dome(150, 140), plane, Quality { method: Method::Sweep, fuse: Fuse::Aimed, ..base }),
        (plateaus(61, 50), open, Quality { fuse: Fuse::Own, lines: Lines::HalfCell, ..base }),
        (rough(50, 83, [1.0, 3.0]), open, Quality { lines: Lines::TwoCells, ..base }),
        (rough(33, 9, [2.0, 2.0]), plane, Quality { precision: Precision::Packed, ..base }),
        (
            rough(61, 47, [2.0, 1.0]),
            open,
            Quality { method: Method::Sweep, fuse: Fuse::AimedNearest, ..base },
        ),
        (
            plateaus(50, 64),
            plane,
            Quality { fuse: Fuse::AimedAround, lines: Lines::TwoCells, ..base },
        ),
    ];
    let asked = std::env::var("RIDGELIGHT_EDITS").ok();
    let count = asked.map_or(8, |n| n.parse().expect("RIDGELIGHT_EDITS is a whole number"));
    for (i, (field, border, quality)) in cases.into_iter().enumerate() {
        let mut scene = scene(field, border);
        if i > 0 {
            // Software drivers take seconds to compile each pipeline.
            scene.lights.environment = None;
            scene.lights.suns.remove(i % 2);
        }
        edits(&mut device, &scene, &quality, count, i as u64);
    }
}

/// The comparison fails for an edit whose rectangle lacks one row or column.
#[test]
fn an_edit_with_too_small_a_rectangle_is_detected() {
    let mut device = Device::new();
    let quality = Quality { azimuths: 8, table_elevations: 16, ..Quality::default() };
    let scene = under_sky(rough(40, 40, [2.0, 2.0]), Border::Plane);
    let gpu = device.gpu.as_mut().expect("alive");
    let plan = planned(gpu, &scene, &quality, true);
    let mut frame = made(gpu, &scene, plan);
    let stated = Rectangle { col: 9, row: 9, cols: 10, rows: 10 };
    for (wide, high) in [(10, 10), (11, 10), (10, 11)] {
        let mut heights = scene.field.heights_m().to_vec();
        (9..9 + high)
            .for_each(|r| heights[r * 40 + 9..][..wide].iter_mut().for_each(|h| *h += 9.0));
        gpu.refill(&frame, 0, scene.field.heights_m()).expect("refilled");
        gpu.draw(&mut frame).expect("drawn");
        gpu.refill(&frame, 0, &heights).expect("refilled");
        gpu.draw_edit(&mut frame, stated).expect("drawn");
        let edited = bits(gpu, &frame);
        gpu.draw(&mut frame).expect("drawn");
        assert_eq!(edited == bits(gpu, &frame), (wide, high) == (10, 10), "{wide} × {high}");
    }
    gpu.end(frame);
}

#[test]
fn edits_that_cannot_be_are_refused() {
    let mut device = Device::new();
    let quality = Quality { azimuths: 8, table_elevations: 16, ..Quality::default() };
    let scene = under_sky(rough(24, 20, [1.0, 1.0]), Border::Plane);
    let gpu = device.gpu.as_mut().expect("alive");
    let all = Rectangle { col: 0, row: 0, cols: 20, rows: 24 };
    let plan = planned(gpu, &scene, &quality, true);
    let mut frame = made(gpu, &scene, plan.clone());
    let before = bits(gpu, &frame);
    for beyond in [
        Rectangle { cols: 21, ..all },
        Rectangle { row: 1, ..all },
        Rectangle { cols: 0, ..all },
        Rectangle { col: u32::MAX, ..all },
    ] {
        let error = gpu.draw_edit(&mut frame, beyond).expect_err("not within the field");
        assert!(error.to_string().contains("within 20 × 24"), "{error}");
    }
    assert!(bits(gpu, &frame) == before, "after an error nothing has been recorded");
    gpu.draw_edit(&mut frame, all).expect("drawn");
    assert!(bits(gpu, &frame) == before, "nothing was edited");
    let mut brighter = scene.clone();
    brighter.lights.sky = Some([9.0; 3]);
    let other = planned(gpu, &brighter, &quality, true);
    let passes = gpu.replace_plan(&mut frame, other).expect("the same passes");
    let error = gpu.draw_edit(&mut frame, all).expect_err("the new sky is nowhere yet");
    assert!(error.to_string().contains("must be recorded first"), "{error}");
    gpu.draw_passes(&mut frame, &passes).expect("drawn");
    gpu.draw_edit(&mut frame, all).expect("drawn");

    // No base to continue from: nothing recorded, or outputs whose contents are not kept.
    let mut other = Renderer::new(gpu.host(), plan, 1).expect("a renderer");
    let (inputs, mut outputs) = (frame.inputs(), frame.outputs());
    let refused = |other: &mut Renderer, outputs: &[ImageArg]| {
        let error = gpu.run(|commands| other.record_edit(commands, 0, &inputs, outputs, all));
        error.expect_err("nothing to go on from").to_string()
    };
    let error = refused(&mut other, &outputs);
    assert!(error.contains("a recording of all passes"), "{error}");
    gpu.run(|commands| other.record(commands, 0, &inputs, &outputs)).expect("drawn");
    outputs[0].before.layout = ash::vk::ImageLayout::UNDEFINED;
    let error = refused(&mut other, &outputs);
    assert!(error.contains("radiance") && error.contains("last recording"), "{error}");
    other.destroy();
    gpu.end(frame);

    // Horizons not kept; slopes instead of occluders; lines without a beginning; no lines.
    let periodic = Scene {
        surface: Surface { border: Border::Periodic, ..Surface::default() },
        ..scene.clone()
    };
    for (scene, quality, keeps) in [
        (&scene, quality, false),
        (&scene, Quality { fuse: Fuse::Slopes, ..quality }, true),
        (&periodic, quality, true),
        (&scene, Quality { method: Method::BruteForce, ..quality }, true),
        (&scene, Quality { method: Method::Pyramid, ..quality }, true),
    ] {
        let plan = planned(gpu, scene, &quality, keeps);
        let error = plan.check_edit(all).expect_err("no passes for edits");
        assert!(error.to_string().contains("keeps_horizons"), "{error}");
    }
}
