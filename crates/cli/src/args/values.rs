//! Parses values of the command line. The library checks ranges unless a function here does.

use crate::horizon::Fourier;

pub fn whole(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| "expected a whole number, 0 or more".to_owned())
}

/// Two counts, as 8x16.
pub fn grid(text: &str) -> Result<[usize; 2], String> {
    let parts: Option<Vec<usize>> = text.split('x').map(|part| part.parse().ok()).collect();
    match parts.unwrap_or_default().as_slice() {
        [first, second] => Ok([*first, *second]),
        _ => Err("expected two whole numbers, as 8x16".into()),
    }
}

pub fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',')
        .map(|part| part.trim().parse::<f64>().map_err(|_| format!("{part:?} is no number")))
        .collect()
}

pub fn colour(text: &str) -> Result<[f32; 3], String> {
    match numbers(text)?.as_slice() {
        [grey] => Ok([*grey as f32; 3]),
        [r, g, b] => Ok([*r as f32, *g as f32, *b as f32]),
        other => Err(format!("{} numbers, expected one or R,G,B", other.len())),
    }
}

/// A sky of one radiance, or the clear sky around the first sun.
#[derive(Clone, Copy, PartialEq)]
pub enum SkyArg {
    Uniform([f32; 3]),
    Clear,
}

pub fn sky(text: &str) -> Result<SkyArg, String> {
    match text {
        "clear" => Ok(SkyArg::Clear),
        numbers => colour(numbers)
            .map(SkyArg::Uniform)
            .map_err(|error| format!("{error}; the word is clear")),
    }
}

pub fn albedo_colour(text: &str) -> Option<[f32; 3]> {
    colour(text).ok()
}

/// Curvatures outwards and inwards; one number is both.
pub fn curvatures(text: &str) -> Result<[f64; 2], String> {
    match numbers(text)?.as_slice() {
        [both] => Ok([*both; 2]),
        [outwards, inwards] => Ok([*outwards, *inwards]),
        other => Err(format!("{} numbers, expected OUT or OUT,IN", other.len())),
    }
}

/// Phong specular: one for the whole field, or a file.
#[derive(Clone)]
pub enum SpecularArg {
    Constant(ridgelight::scene::PhongSpecular),
    File(std::path::PathBuf),
}

/// Anything but a list of numbers is a file.
pub fn specular(text: &str) -> Result<SpecularArg, String> {
    match numbers(text).as_deref() {
        Ok([exponent, scale]) => Ok(SpecularArg::Constant(ridgelight::scene::PhongSpecular {
            exponent: *exponent as f32,
            scale: *scale as f32,
        })),
        Ok(other) => Err(format!("{} numbers, expected EXPONENT,SCALE or a file", other.len())),
        Err(_) => Ok(SpecularArg::File(text.into())),
    }
}

/// Coefficients and the range of heights, as 16,1200.
pub fn fourier(text: &str) -> Result<Fourier, String> {
    let [coefficients, range_m] = numbers(text)?[..] else {
        return Err("expected two numbers, N,RANGE".into());
    };
    let is_count = (2.0..=256.0).contains(&coefficients) && coefficients % 2.0 == 0.0;
    if !is_count {
        return Err(format!("{coefficients} coefficients, expected an even number from 2 to 256"));
    }
    if !(range_m.is_finite() && range_m > 0.0) {
        return Err(format!("a range of {range_m}, expected more than 0"));
    }
    Ok(Fourier { coefficients: coefficients as u32, range_m })
}

pub fn pixels(text: &str) -> Result<[u32; 2], String> {
    let parts: Option<Vec<u32>> = text.split('x').map(|part| part.parse().ok()).collect();
    match parts.unwrap_or_default().as_slice() {
        [width, height] if (1..=16384).contains(width) && (1..=16384).contains(height) => {
            Ok([*width, *height])
        }
        _ => Err("expected WxH, two whole numbers from 1 to 16384".into()),
    }
}

pub fn cell(text: &str) -> Result<[f64; 2], String> {
    match numbers(text)?.as_slice() {
        [both] => Ok([*both; 2]),
        [x, y] => Ok([*x, *y]),
        other => Err(format!("{} numbers, expected X or X,Y", other.len())),
    }
}

/// A box: west, south, east, north.
pub fn bbox(text: &str) -> Result<[f64; 4], String> {
    let all = numbers(text)?;
    let count = all.len();
    all.try_into().map_err(|_| format!("{count} numbers, expected XMIN,YMIN,XMAX,YMAX"))
}

pub fn bytes(text: &str) -> Result<u64, String> {
    let digits = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let number: f64 = number.parse().map_err(|_| format!("{text:?} is no size"))?;
    let factor = match unit.trim().to_lowercase().as_str() {
        "" | "b" => 1.0,
        "k" | "kib" => 1024.0,
        "m" | "mib" => 1024.0 * 1024.0,
        "g" | "gib" => 1024.0 * 1024.0 * 1024.0,
        "kb" => 1e3,
        "mb" => 1e6,
        "gb" => 1e9,
        _ => return Err(format!("{unit:?} is no unit: KiB, MiB, GiB, kB, MB, GB")),
    };
    Ok((number * factor) as u64)
}
