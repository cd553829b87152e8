//! Light by spherical harmonics: closed forms, and the same series in f64.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use ridgelight::basis::bands;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::slice::Slices;
use ridgelight::basis::zonal::clamped_cosine;
use ridgelight::gpu::Pixels;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Basis, Border, Environment, HeightField, Quality, Receiver, Scene, Window,
};
use ridgelight_cpu::basis::azimuth::{assemble, circle};
use ridgelight_cpu::basis::receiver as polynomials;
use ridgelight_cpu::env_rotation::env_rotation;
use ridgelight_cpu::light_matrix::{light_matrix, series};

use crate::{Device, field, random, under_sky};

const AZIMUTHS: u32 = 64;

fn harmonics(sh_order: u32) -> Quality {
    Quality { azimuths: AZIMUTHS, basis: Basis::Sh, sh_order, ..Quality::default() }
}

fn under(environment: Environment, field: HeightField, border: Border) -> Scene {
    let mut scene = under_sky(field, border);
    scene.lights.environment = Some(environment);
    scene
}

/// A picture's layers of the sky and of the environment.
fn layers(gpu: &mut Device, scene: &Scene, quality: &Quality) -> [Pixels; 2] {
    let wanted = Picture { light_layers: true, ..Picture::default() };
    let plan = plan::picture(scene, quality, &gpu.limits(), wanted).expect("a plan");
    let environment = scene.lights.environment.as_ref().expect("an environment");
    let texels: Vec<f32> =
        environment.texels().iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    let all = gpu.draw(plan, &[scene.field.heights_m(), &texels]);
    ["direct.sky", "direct.env"].map(|n| all.iter().find(|p| p.name == n).expect(n).clone())
}

fn texel(pixels: &Pixels, i: usize) -> DVec3 {
    let t = &pixels.values[i * pixels.channels..];
    DVec3::new(t[0].into(), t[1].into(), t[2].into())
}

fn constant(value: f32) -> Environment {
    Environment::new(24, 12, vec![[value, 0.5 * value, 0.0]; 24 * 12], 0.3).expect("good texels")
}

pub fn noisy(seed: u64) -> Environment {
    let mut next = random(seed);
    let texels = (0..40 * 20).map(|_| [next() as f32, 3.0 * next() as f32, 0.5]).collect();
    Environment::new(40, 20, texels, -2.0).expect("good texels")
}

/// Exit radiance in f64 of the same series: lowest free elevations along even azimuths, and a normal.
fn in_f64(
    environment: &Environment,
    border: Border,
    quality: &Quality,
    lowest: &[f64],
    normal: DVec3,
) -> DVec3 {
    let order = quality.sh_order as usize;
    let is_plane = quality.receiver == Receiver::Plane;
    let fitted = is_plane && quality.window == Window::None && border != Border::Open;
    let light_order = if is_plane { order - 1 } else { order };
    let height = environment.height();
    let rows = if fitted { height.div_ceil(2) } else { height };
    let turns = env_rotation(environment, rows, light_order);
    let matrix = light_matrix(quality, &series(&turns, height, light_order, fitted));
    let slices = Slices::new(order);
    let along: Vec<Vec<f64>> = lowest.iter().map(|w| slices.above(*w)).collect();
    let visible = assemble(order, &circle(order, lowest.len()), &along);
    let all = polynomials(normal.to_array());
    let rows = if is_plane { &all[1..4] } else { &all[..matrix.len()] };
    let share = |row: &[DVec3]| row.iter().zip(&visible).map(|(m, v)| *v * *m).sum::<DVec3>();
    rows.iter().zip(&matrix).map(|(r, row)| *r * share(row)).sum()
}

/// A series of order n - 1 fitted to a constant is that constant: the light of a uniform sky, for any order and
/// radiance.
#[test]
fn level_ground_under_a_constant_environment_is_its_radiance() {
    let mut gpu = Device::new();
    for (rows, cols, border, order, value) in [
        (1, 1, Border::Plane, 2, 1.0),
        (1, 5, Border::Open, 3, 0.0),
        (3, 2, Border::Periodic, 4, 65_504.0),
        (17, 16, Border::Plane, 4, 1e6),
        (5, 4, Border::Plane, 5, 1e30),
        (7, 3, Border::Plane, 6, 1e-6),
    ] {
        let level = field(rows, cols, [1.0, 2.0], |_, _| 7.0);
        let scene = under(constant(value), level, border);
        let [_, found] = layers(&mut gpu, &scene, &harmonics(order));
        let want = DVec3::new(value.into(), 0.5 * f64::from(value), 0.0);
        // A fit's weights exceed the light by this factor: the root of its condition.
        let cancels = [1.0, 4.0, 16.0, 60.0, 100.0][order as usize - 2];
        for i in 0..rows * cols {
            let off = (texel(&found, i) - want).abs().max_element();
            let bound = 1e-6 * cancels * f64::from(value);
            assert!(off <= bound, "order {order}, {border:?}: {off:e} of {value:e}");
        }
    }
}

/// Everything on level ground, in every form, against f64: 1e-6 of the sum of magnitudes.
#[test]
fn level_ground_is_the_same_series_in_f64() {
    let mut gpu = Device::new();
    let mut peak = vec![[0.0; 3]; 40 * 20];
    peak[3 * 40 + 10] = [1e6, 1e6, 3e6];
    let peak = Environment::new(40, 20, peak, 0.0).expect("good texels");
    let forms = [
        (2, Receiver::Cosine, Window::None, Border::Open),
        (3, Receiver::Plane, Window::Lanczos, Border::Plane),
        (4, Receiver::Plane, Window::None, Border::Plane),
        (4, Receiver::Cosine, Window::Nonnegative, Border::Plane),
        (4, Receiver::Plane, Window::None, Border::Open),
        (5, Receiver::Cosine, Window::Hann, Border::Plane),
        (6, Receiver::Plane, Window::None, Border::Plane),
        (5, Receiver::Plane, Window::None, Border::Plane),
    ];
    let both = [noisy(5), peak];
    for (i, (order, receiver, window, border)) in forms.into_iter().enumerate() {
        let environment = &both[i % 2];
        let quality = Quality { receiver, window, ..harmonics(order) };
        let level = field(3, 5, [1.0, 1.0], |_, _| -2.0);
        let scene = under(environment.clone(), level, border);
        let [_, found] = layers(&mut gpu, &scene, &quality);
        let free = vec![0.0; AZIMUTHS as usize];
        let want = in_f64(environment, border, &quality, &free, DVec3::Z);
        let off = (texel(&found, 7) - want).abs().max_element();
        println!("order {order} {receiver:?} {window:?} {border:?}: {off:e} of {want}");
        // Fits of order 4 and 5 have weights 60 and 100 times their light.
        let cancels = if order > 4 { 100.0 } else { 1.0 };
        assert!(off <= 1e-6 * cancels * want.max_element(), "{order} {receiver:?}: {off:e}");
    }
}

/// A tilted plane under an open sky sees the hemisphere about its normal: its light is the environment's
/// series of order n - 1 convolved with the clamped cosine, at the normal.
#[test]
fn a_tilted_plane_has_the_convolved_series_at_its_normal() {
    let mut gpu = Device::new();
    let (width, height) = (64, 32);
    let direction = |row: f64, col: f64| {
        let (theta, phi) = (PI * row / height as f64, PI - TAU * col / width as f64 + 0.4);
        let (sin, cos) = theta.sin_cos();
        (DVec3::new(sin * phi.cos(), sin * phi.sin(), cos), sin)
    };
    let smooth = |d: DVec3| [1.0 + 0.9 * d.y, 2.0 + d.x - d.z + 0.8 * d.x * d.y, 1.0 + d.z * d.z];
    let texels: Vec<[f32; 3]> = (0..width * height)
        .map(|i| smooth(direction((i / width) as f64 + 0.5, (i % width) as f64 + 0.5).0))
        .map(|t| t.map(|v| v as f32))
        .collect();
    let environment = Environment::new(width, height, texels.clone(), 0.4).expect("good texels");
    let order = 4;
    let mut series = vec![DVec3::ZERO; 9];
    // Four midpoints a side of every texel: 1e-3 of Y's change.
    for i in 0..16 * width * height {
        let (row, col) = (i / (4 * width), i % (4 * width));
        let (d, sin) = direction((row as f64 + 0.5) / 4.0, (col as f64 + 0.5) / 4.0);
        let area = sin * (PI / (4 * height) as f64) * (TAU / (4 * width) as f64);
        let texel = DVec3::from_array(texels[row / 4 * width + col / 4].map(f64::from));
        for (sum, y) in series.iter_mut().zip(evaluate(3, d)) {
            *sum += area * y * texel;
        }
    }
    for (slope_x, slope_y) in [(0.8, 0.0), (-0.3, 0.6), (0.0, -1.2)] {
        let plane = field(9, 9, [1.0, 1.0], |r, c| slope_x * c as f64 + slope_y * (8 - r) as f64);
        let scene = under(environment.clone(), plane, Border::Open);
        let quality = Quality { azimuths: 256, ..harmonics(order) };
        let [_, found] = layers(&mut gpu, &scene, &quality);
        let normal = DVec3::new(-slope_x, -slope_y, 1.0).normalize();
        let cosine = clamped_cosine(3);
        let values = evaluate(3, normal);
        let want: DVec3 = bands(3)
            .enumerate()
            .map(|(i, (l, _))| {
                let band = cosine[l] * (4.0 * PI / (2 * l + 1) as f64).sqrt() / PI;
                band * values[i] * series[i]
            })
            .sum();
        let off = (texel(&found, 4 * 9 + 4) - want).abs().max_element();
        // As a uniform sky's: second order in the wedge, of a radiance of 4 at most; and the series' 1e-3.
        let steepest = slope_x.hypot(slope_y);
        let bound = 4.0 * steepest * (PI / 256.0_f64).powi(2) * 2.0 + 2e-3;
        assert!(off < bound, "{slope_x} {slope_y}: {off:e}, {want}");
    }
}

/// A lone bright texel rings below 0 somewhere on the other side, and nowhere with the window that prevents ringing;
/// negative light is clamped to 0, and counted.
#[test]
fn negative_ringing_is_counted() {
    let mut gpu = Device::new();
    let mut texels = vec![[0.0; 3]; 40 * 20];
    texels[6 * 40 + 20] = [900.0, 0.0, 0.0];
    let environment = Environment::new(40, 20, texels.clone(), 0.0).expect("good texels");
    // Its west faces 122° away, where bands 0 to 2 of a clamped cosine are below 0.
    let cone = field(21, 21, [1.0, 1.0], |r, c| -2.0 * (r as f64 - 10.0).hypot(c as f64 - 10.0));
    let scene = under(environment, cone, Border::Open);
    let texels: Vec<f32> = texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    for (window, rings) in [(Window::None, true), (Window::Nonnegative, false)] {
        let quality = Quality { window, ..harmonics(4) };
        let limits = gpu.limits();
        let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
        let device = gpu.gpu.as_mut().expect("alive");
        let contents: [&[f32]; 2] = [scene.field.heights_m(), &texels];
        let (share, pixels) = device
            .with_frame(plan, &contents, |device, frame| {
                device.draw(frame)?;
                Ok((device.negative_share(frame)?, device.pixels(frame, 0)?))
            })
            .expect("drawn");
        let share = share.expect("harmonics");
        assert!((share > 0.05) == rings && (share > 0.0) == rings, "{window:?}: {share}");
        assert!(pixels.values.iter().all(|v| *v >= 0.0));
    }
}

/// A constant environment is a uniform sky, through every horizon, in every form of the plane: azimuths are points
/// here and wedges in closed form, which differ by (2π/m)²/24 of the horizontal part.
#[test]
fn a_constant_environment_is_a_uniform_sky() {
    let mut gpu = Device::new();
    let mut next = random(3);
    let noise: Vec<f64> = (0..31 * 26).map(|_| next()).collect();
    let rough = field(31, 26, [3.0, 2.0], |r, c| {
        // A wall, a pit, and noise.
        7.0 * noise[r * 26 + c] + if c == 20 { 60.0 } else { 0.0 }
            - if r > 20 && c < 9 { 40.0 } else { 0.0 }
    });
    let tilted = |slope: f64| field(31, 26, [1.0, 1.0], |_, c| slope * c as f64);
    for (name, field, border, orders) in [
        ("rough", rough.clone(), Border::Plane, vec![2, 4, 6]),
        ("rough", rough.clone(), Border::Open, vec![3, 5]),
        ("rough", rough, Border::Periodic, vec![4]),
        ("a slope of 1e-6", tilted(1e-6), Border::Plane, vec![4]),
        ("a slope of 1e6", tilted(1e6), Border::Plane, vec![4]),
        ("a slope of 1e6", tilted(1e6), Border::Open, vec![4]),
    ] {
        let scene = under(constant(1.0), field, border);
        for order in orders {
            let [sky, found] = layers(&mut gpu, &scene, &harmonics(order));
            let worst = (0..31 * 26)
                .map(|i| {
                    (texel(&found, i) - texel(&sky, i) * DVec3::new(1.0, 0.5, 0.0))
                        .abs()
                        .max_element()
                })
                .fold(0.0, f64::max);
            let bound = (TAU / f64::from(AZIMUTHS)).powi(2) / 24.0 + 1e-4;
            println!("{name}, {border:?}, order {order}: {worst:e}");
            assert!(worst <= bound, "{name}, {border:?}, order {order}: {worst:e}");
        }
    }
}
