//! Results kept as floats in `tests/goldens/`: what changes is seen, and every driver gives the same
//! within its roundings.
//!
//! A failure writes what was got, what was wanted and the difference as EXR, and says where. To accept
//! new results: `RIDGELIGHT_BLESS=1 cargo nextest run --test gpu goldens` on lavapipe, and look at what
//! has changed.

use std::path::{Path, PathBuf};

use ridgelight::files::{self, Channels, Layer, Planes};
use ridgelight::gpu::Pixels;
use ridgelight::measure::tolerance::{
    ShadeError, twin_angle, twin_fused_slope, twin_resolved, two_devices,
};
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::{
    Albedo, Border, Environment, Fuse, HeightField, Lines, Quality, Scene, Sun,
};

use crate::{Device, field, random, under_sky};

const ROWS: usize = 33;
const COLS: usize = 48;
const CELL_M: [f64; 2] = [20.0, 30.0];

/// Two hills, a pit and rubble, by arithmetic that every processor rounds alike.
fn hills() -> HeightField {
    let mut next = random(20);
    let rubble: Vec<f64> = (0..ROWS * COLS).map(|_| 4.0 * next()).collect();
    field(ROWS, COLS, CELL_M, |r, c| {
        let hill = |row: f64, col: f64, height: f64, width: f64| {
            let (y, x) = (r as f64 - row, c as f64 - col);
            height / (1.0 + (x * x + y * y) / width)
        };
        hill(9.0, 12.0, 70.0, 30.0) + hill(22.0, 33.0, 50.0, 12.0) - hill(15.0, 25.0, 30.0, 8.0)
            + rubble[r * COLS + c]
    })
}

/// Planes of an output, one a channel (alpha left out) or a layer.
fn planes(pixels: &Pixels) -> Planes {
    let plane = |channel: usize, layer: &[f32]| -> Vec<f32> {
        layer.iter().skip(channel).step_by(pixels.channels).copied().collect()
    };
    let layers: Vec<&[f32]> = pixels.values.chunks_exact(ROWS * COLS * pixels.channels).collect();
    let (names, planes) = match (pixels.channels, layers.len()) {
        (4, 1) => ["R", "G", "B"]
            .iter()
            .enumerate()
            .map(|(c, name)| (name.to_string(), plane(c, layers[0])))
            .unzip(),
        (1, 1) => (vec!["Y".to_owned()], vec![plane(0, layers[0])]),
        _ => layers.iter().enumerate().map(|(k, l)| (k.to_string(), plane(0, l))).unzip(),
    };
    Planes { rows: ROWS, cols: COLS, names, planes }
}

fn write(path: &Path, planes: &Planes) {
    let all = planes.names.iter().zip(&planes.planes);
    let layer = |name: &String, values| Layer {
        name: name.clone(),
        channels: Channels::Scalar("", values),
    };
    let layers: Vec<Layer> = all.map(|(name, values)| layer(name, values)).collect();
    files::write_exr(path, planes.rows, planes.cols, &layers, &[]).expect("a written EXR");
}

/// The largest |difference| over `tolerance`, or what is wrong with the whole.
fn ratio(got: &Planes, want: &Planes, tolerance: f64) -> Result<f64, String> {
    let shape = |p: &Planes| (p.rows, p.cols, p.names.clone());
    if shape(got) != shape(want) {
        return Err(format!("{:?}, kept are {:?}", shape(got), shape(want)));
    }
    let pairs = got.planes.iter().flatten().zip(want.planes.iter().flatten());
    Ok(pairs.fold(0.0, |worst, (got, want)| {
        let error = f64::from((got - want).abs()) / tolerance;
        if error.is_nan() { f64::INFINITY } else { f64::max(worst, error) }
    }))
}

/// Holds a result against what is kept, and leaves both and their difference to be looked at where it
/// is beyond the tolerance.
fn hold(name: &str, got: &Planes, want: &Planes, tolerance: f64) -> Result<(), String> {
    let wrong = match ratio(got, want, tolerance) {
        Ok(ratio) => {
            println!("{name}: error/tolerance {ratio:.3} of {tolerance:e}");
            if ratio <= 1.0 {
                return Ok(());
            }
            format!("error/tolerance {ratio:.3} of {tolerance:e}")
        }
        Err(wrong) => wrong,
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("goldens");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = |what: &str| folder.join(format!("{name}.{what}.exr"));
    write(&path("got"), got);
    write(&path("want"), want);
    let mut diff = got.clone();
    for (d, w) in diff.planes.iter_mut().flatten().zip(want.planes.iter().flatten()) {
        *d -= w;
    }
    write(&path("diff"), &diff);
    Err(format!("{name}: {wrong}; see {}", path("{got,want,diff}").display()))
}

fn kept(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens").join(file)
}

/// Compares an output with the file kept for it, or keeps it where blessing is asked for.
fn check(device: &Device, file: &str, pixels: &Pixels, tolerance: f64) {
    let got = planes(pixels);
    if std::env::var_os("RIDGELIGHT_BLESS").is_some_and(|v| v == "1") {
        assert!(std::env::var_os("CI").is_none(), "RIDGELIGHT_BLESS: refused where CI is set");
        let name = &device.report().name;
        assert!(name.contains("llvmpipe"), "RIDGELIGHT_BLESS: found {name}, expected llvmpipe");
        let path = kept(file);
        if file.ends_with(".npy") {
            let shape = [got.planes.len(), ROWS, COLS];
            let chunks = got.planes.iter().map(Vec::as_slice);
            files::write_npy_f32(&path, &shape, chunks).expect("a written NPY");
        } else {
            write(&path, &got);
        }
    }
    let want = files::read_planes(&kept(file)).expect("a kept result");
    // Channels of an EXR are stored by name.
    let place = |name: &String| want.names.iter().position(|n| n == name);
    let order: Option<Vec<usize>> = got.names.iter().map(place).collect();
    let order = order.unwrap_or_else(|| panic!("{file} holds {:?}", want.names));
    let sorted = Planes {
        names: order.iter().map(|&i| want.names[i].clone()).collect(),
        planes: order.iter().map(|&i| want.planes[i].clone()).collect(),
        ..want
    };
    if let Err(wrong) = hold(file, &got, &sorted, tolerance) {
        panic!("{wrong}");
    }
}

/// What a picture's horizons err by in `count` azimuths of a plan.
fn shade_error(scene: &Scene, plan: &Plan, count: usize) -> ShadeError {
    let heights = || scene.field.heights_m().iter().map(|h| f64::from(*h));
    let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
    let step_m = plan.azimuths.iter().map(|a| f64::from(a.step_m)).fold(f64::MAX, f64::min);
    let slope_error = twin_fused_slope(low.abs().max(high.abs()), step_m);
    ShadeError::new(slope_error, high - low, CELL_M[0].min(CELL_M[1]), count)
}

fn sun_weights(plan: &Plan) -> f64 {
    plan.azimuths.iter().map(|a| f64::from(a.weight)).sum()
}

fn draw(
    device: &mut Device,
    scene: &Scene,
    quality: &Quality,
    inputs: &[&[f32]],
) -> (Plan, Pixels) {
    let plan = plan::picture(scene, quality, &device.limits(), Picture::default()).expect("a plan");
    let pixels = device.draw(plan.clone(), inputs).remove(0);
    (plan, pixels)
}

#[test]
fn goldens_of_sky_and_sun() {
    let mut device = Device::new();
    let mut scene = under_sky(hills(), Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    scene.lights.suns = vec![Sun {
        azimuth_rad: 2.2,
        elevation_rad: 0.35,
        diameter_rad: 0.2,
        irradiance: [3.0; 3],
    }];
    let quality = Quality { azimuths: 16, ..Quality::default() };
    let (plan, pixels) = draw(&mut device, &scene, &quality, &[scene.field.heights_m()]);
    let sky = 0.5 * shade_error(&scene, &plan, 16).sky();
    let sun = 0.5 * 3.0 * shade_error(&scene, &plan, 8).sun(sun_weights(&plan));
    // At most the whole sky, and the sun from straight above.
    let brightest = 0.5 * (1.0 + 3.0 / std::f64::consts::PI);
    let tolerance = two_devices(sky + sun + twin_resolved(brightest, 2));
    check(&device, "sky_and_sun.exr", &pixels, tolerance);
}

#[test]
fn goldens_of_an_environment() {
    let mut device = Device::new();
    let mut scene = under_sky(hills(), Border::Periodic);
    let mut next = random(21);
    let texels: Vec<[f32; 3]> = (0..24 * 12)
        .map(|i| if i == 76 { [2.0, 1.5, 1.0] } else { [next() as f32, next() as f32, 0.5] })
        .collect();
    scene.lights.sky = None;
    let environment = Environment::new(24, 12, texels, 0.4).expect("an environment");
    let input: Vec<f32> =
        environment.texels().iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    scene.lights.environment = Some(environment);
    let quality =
        Quality { azimuths: 16, table_elevations: 64, fuse: Fuse::Aimed, ..Quality::default() };
    let inputs = [scene.field.heights_m(), input.as_slice()];
    let (plan, pixels) = draw(&mut device, &scene, &quality, &inputs);
    let error = shade_error(&scene, &plan, 16).whole_environment(2.0, [24.0, 12.0, 64.0]);
    let tolerance = two_devices(error + twin_resolved(2.0, 1));
    check(&device, "environment.exr", &pixels, tolerance);
}

#[test]
fn goldens_of_horizons() {
    let mut device = Device::new();
    let field = hills();
    let quality =
        Quality { azimuths: 5, lines: Lines::HalfCell, fuse: Fuse::Own, ..Quality::default() };
    let plan = plan::horizons(&field, Border::Open, &quality, &device.limits(), (0, 5), false)
        .expect("a plan");
    let scene = under_sky(field, Border::Open);
    let largest = scene.field.heights_m().iter().fold(0.0_f64, |m, h| m.max(f64::from(h.abs())));
    let step_m = plan.azimuths.iter().map(|a| f64::from(a.step_m)).fold(f64::MAX, f64::min);
    let pixels = device.draw(plan, &[scene.field.heights_m()]).remove(0);
    let tolerance = two_devices(twin_angle(0.0, twin_fused_slope(largest, step_m)));
    check(&device, "horizons.npy", &pixels, tolerance);
}

/// The comparison is not deaf, and leaves what it promises.
#[test]
fn goldens_that_differ_leave_three_images() {
    let want = Planes {
        rows: 2,
        cols: 3,
        names: vec!["Y".to_owned()],
        planes: vec![vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]],
    };
    assert_eq!(hold("seen", &want, &want, 1e-6), Ok(()));
    let mut got = want.clone();
    got.planes[0][4] += 2e-6;
    let wrong = hold("seen", &got, &want, 1e-6).expect_err("a difference");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("goldens");
    assert!(wrong.contains(&folder.display().to_string()), "{wrong}");
    let read = |what: &str| {
        files::read_planes(&folder.join(format!("seen.{what}.exr"))).expect("written").planes
    };
    assert_eq!((read("got"), read("want")), (got.planes.clone(), want.planes.clone()));
    assert_eq!(read("diff")[0][4], got.planes[0][4] - want.planes[0][4]);
    got.planes[0][4] = f32::NAN;
    hold("seen", &got, &want, 1e-6).expect_err("no number");
    let other = Planes { rows: 3, cols: 2, ..want.clone() };
    assert!(ratio(&other, &want, 1.0).is_err(), "another shape");
}
