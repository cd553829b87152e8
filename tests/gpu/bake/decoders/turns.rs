//! Decoders with a number of azimuths that is no power of two, where quotients of whole numbers are not exact:
//! azimuths stay cyclic.

use ridgelight_bake as bake;
use ridgelight_bake::Encoding;
use ridgelight_io::Component;
use ridgelight_io::{Ktx2Writer, TexelFormat};

use super::{Constant, Decoder, decode, decoder};
use crate::Device;

/// Zenith angles and azimuths: as many pairs as an image has layers.
const MANY: [usize; 2] = [8, 41];
const PAIRS: [usize; 2] = [4, 11];
const FACTORS: usize = 3;
const FORMAT: TexelFormat = TexelFormat { component: Component::F32, count: 4 };

/// The direction that lies so many azimuths on, of the same zenith angle.
fn on(i: usize, [_, azimuths]: [usize; 2], steps: usize) -> usize {
    i / azimuths * azimuths + (i + steps) % azimuths
}

/// A texture of numbers: of each layer, row and column.
pub fn texture(
    [cols, rows, layers]: [usize; 3],
    is_array: bool,
    number: impl Fn(usize, usize, usize) -> [f32; 4],
) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("map.ktx2");
    let count = is_array.then_some(layers);
    let mut writer = Ktx2Writer::create(&path, FORMAT, [cols, rows], count, &[]).expect("a file");
    for at in 0..layers * rows * cols {
        let texel = number(at / (rows * cols), at / cols % rows, at % cols);
        let bytes: Vec<u8> = texel.iter().flat_map(|v| v.to_le_bytes()).collect();
        writer.write(&bytes).expect("a texel");
    }
    writer.finish().expect("all of them");
    std::fs::read(&path).expect("a texture")
}

pub fn whole(numbers: &[usize]) -> Vec<u32> {
    numbers.iter().map(|n| Constant::Int(*n as i32).bits()).collect()
}

pub fn none(_: &Encoding) -> Vec<(&'static str, Constant)> {
    Vec::new()
}

/// The largest difference of all pairs of found and known values, and its place.
fn worst(found: &[f32], known: impl Fn(usize) -> f64) -> (f64, usize) {
    let apart = found.iter().enumerate().map(|(i, v)| ((f64::from(*v) - known(i)).abs(), i));
    apart.max_by(|a, b| a.0.total_cmp(&b.0)).expect("some")
}

/// Error of a place between azimuths, in their steps: four roundings of a place up to that number, and of π's
/// decimals.
fn place(azimuths: usize) -> f64 {
    8.0 * azimuths as f64 / f64::from(1 << 24)
}

/// Numbers of azimuths are read at themselves and, halfway on, as the mean of two: of the last and the first, too.
#[test]
fn turns_of_horizons_close() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let count = MANY[1];
    let decoder = decoder!("horizon", "horizon", bake::HORIZON, true, count, none);
    let bits = [Constant::Int(count as i32).bits(), Constant::Float(1.0).bits()];
    let map = texture([1, 1, count], true, |k, _, _| [k as f32; 4]);
    for offset in [0.0_f32, 0.5] {
        let found = decode(gpu, &decoder, &bits, &map, offset);
        let share = f64::from(offset);
        let known = |k: usize| (1.0 - share) * k as f64 + share * ((k + 1) % count) as f64;
        let (off, at) = worst(&found, known);
        // Across the end of the circle numbers change by all of their count.
        let allowed = count as f64 * place(count);
        assert!(off <= allowed, "{offset}: {off} of {allowed} at {at}: {}", found[at]);
    }
}

/// Tables of pairs hold the numbers of light and view: read at their angles, and halfway on in both azimuths.
#[test]
fn turns_of_tables_close() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let [zeniths, azimuths] = MANY;
    let count = zeniths * azimuths;
    let decoder = decoder!("brdf", "brdf", bake::REFLECTED, false, 3, none);
    let bits = whole(&[zeniths, azimuths]);
    // Radiance is texelFetch(map, (view, light)).
    let map =
        texture([count, count, 1], false, |_, light, view| [light as f32, view as f32, 1.0, 0.0]);
    for offset in [0.0_f32, 0.5] {
        let found = decode(gpu, &decoder, &bits, &map, offset);
        let between = |i: usize| match offset {
            0.0 => i as f64,
            _ => 0.5 * (i as f64 + on(i, MANY, 1) as f64),
        };
        let known = |at: usize| {
            let (c, light, view) = (at / count / count, at / count % count, at % count);
            [between(light), between(view), 1.0][c]
        };
        let (off, at) = worst(&found, known);
        // An error of a place takes that share of the next zenith angle's number or of the other end of the circle,
        // along two axes, and 16 shares are sums of products that are rounded.
        let allowed =
            4.0 * azimuths as f64 * place(azimuths) + 16.0 * count as f64 / f64::from(1 << 23);
        assert!(off <= allowed, "{offset}: {off} of {allowed} at {at}: {}", found[at]);
    }
}

/// Functions of one direction hold its number and that of the factor.
#[test]
fn turns_of_factors_close() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let [zeniths, azimuths] = MANY;
    let count = zeniths * azimuths;
    let planes = 3 * FACTORS;
    let decoder = decoder!("brdf_factors", "brdf-factors", bake::REFLECTED, true, planes, none);
    let bits = whole(&[zeniths, azimuths, FACTORS]);
    let map = texture([azimuths, zeniths, FACTORS], true, |k, theta, phi| {
        [(theta * azimuths + phi) as f32, k as f32, 1.0, 0.0]
    });
    for offset in [0.0_f32, 0.5] {
        let found = decode(gpu, &decoder, &bits, &map, offset);
        let known = |at: usize| {
            let (k, c, i) = (at / count / 3, at / count % 3, at % count);
            let next = on(i, MANY, 1);
            let number = if offset == 0.0 { i as f64 } else { 0.5 * (i + next) as f64 };
            [number, k as f64, 1.0][c]
        };
        let (off, at) = worst(&found, known);
        let allowed =
            2.0 * azimuths as f64 * place(azimuths) + 4.0 * count as f64 / f64::from(1 << 23);
        assert!(off <= allowed, "{offset}: {off} of {allowed} at {at}: {}", found[at]);
    }
}

/// With Phong specular the view has functions of its own, after those of the light: sums are of the products of both.
#[test]
fn views_have_factors_of_their_own() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let planes = 3 * FACTORS + 3;
    let decoder = decoder!("brdf_factors", "brdf-factors", bake::REFLECTED, true, planes, none);
    let numbers = |layer: usize| [(layer + 1) as f32, (layer * layer) as f32, 1.0, 0.0];
    for views in [0, FACTORS] {
        let bits = whole(&[2, 4, FACTORS, views]);
        let map = texture([4, 2, FACTORS + views], true, |layer, _, _| numbers(layer));
        let found = decode(gpu, &decoder, &bits, &map, 0.0);
        let known = |at: usize| {
            let plane = at / 8;
            let (k, c) = (plane / 3, plane % 3);
            let product = |k: usize| numbers(k)[c] * numbers(views + k)[c];
            f64::from(if k < FACTORS { numbers(k)[c] } else { (0..FACTORS).map(product).sum() })
        };
        // Whole numbers, all alike in a layer; mixes of four of them round thrice each.
        let largest = (0..found.len()).map(known).fold(0.0, f64::max);
        let (off, at) = worst(&found, known);
        let allowed = 8.0 * largest / f64::from(1 << 23);
        assert!(off <= allowed, "{views}: {off} of {allowed} at {at}: {}", found[at]);
    }
}

/// Pictures of the nearest direction hold its number: two fifths of a step before and behind it give the same.
#[test]
fn turns_of_pictures_close() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let [views, pairs] = [MANY, PAIRS].map(|[zeniths, azimuths]| zeniths * azimuths);
    let field = decoder!("light_field", "light-field", bake::TEXELS, true, 4 * views, none);
    let btf = decoder!("btf", "btf", bake::TEXELS, true, 4 * pairs * pairs, none);
    for (decoder, [zeniths, azimuths], layers) in
        [(field, MANY, views), (btf, PAIRS, pairs * pairs)]
    {
        let bits = whole(&[zeniths, azimuths]);
        let map = texture([1, 1, layers], true, |layer, _, _| [layer as f32; 4]);
        for offset in [-0.4, 0.0, 0.4] {
            let found = decode(gpu, &decoder, &bits, &map, offset);
            let (off, at) = worst(&found, |at| (at / 4) as f64);
            assert!(off == 0.0, "{} {offset}: layer {} for {}", decoder.kind, found[at], at / 4);
        }
    }
}
