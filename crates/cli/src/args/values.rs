//! Parses values of the command line. An error holds only what was expected; [`Cli::read`](super::Cli::read) adds the flag
//! and the value. The library checks ranges unless a function here does.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

use crate::horizon::Fourier;

/// Expected of an error relative to the mean.
pub const ERROR: &str = "a number above 0, without %: 0.01 is 1 %";
pub const MILLISECONDS: &str = "a number of milliseconds above 0";
pub const FACTOR: &str = "a number above 0";
pub const BOUNCES: &str = "a whole number from 0 to 64";
pub const SEED: RangeInclusive<u32> = 0..=u32::MAX;
pub const AZIMUTHS: RangeInclusive<u32> = 4..=1024;
/// Sides of the fractal field of `bench`. The largest needs 8 GiB of heights while it is made.
pub const SIDE: RangeInclusive<usize> = 1..=32_768;

/// A parser of one number.
pub fn number<T: FromStr + 'static>(
    expected: &'static str,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static {
    move |text| text.parse().map_err(|_| expected.to_owned())
}

/// A parser of a whole number within a range.
pub fn whole<T>(
    range: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| format!("a whole number from {} to {}", range.start(), range.end()))
    }
}

/// An angle in degrees, within what the library accepts: a million radians.
pub fn angle(text: &str) -> Result<f64, String> {
    let within = |degrees: &f64| degrees.abs() <= 5.7e7;
    text.parse().ok().filter(within).ok_or_else(|| "an angle within ±5.7e7 degrees".to_owned())
}

/// A number of things, at least one.
pub fn count(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| *n > 0).ok_or_else(|| "a whole number, 1 or more".to_owned())
}

/// Two numbers with a mark between them, as 8x16.
pub fn sides<T: FromStr>(text: &str, marks: &[char]) -> Option<[T; 2]> {
    let parts: Option<Vec<T>> = text.split(marks).map(|part| part.parse().ok()).collect();
    parts?.try_into().ok()
}

/// Two counts, as 8x16.
pub fn grid(text: &str) -> Result<[usize; 2], String> {
    sides(text, &['x']).ok_or_else(|| "two whole numbers, as 8x16".to_owned())
}

/// Numbers separated by commas; none if a part is not a number.
pub fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|part| part.trim().parse().ok()).collect()
}

pub fn grey_or_colour(text: &str) -> Option<[f32; 3]> {
    match numbers(text)?.as_slice() {
        [grey] => Some([*grey as f32; 3]),
        [r, g, b] => Some([*r as f32, *g as f32, *b as f32]),
        _ => None,
    }
}

pub fn colour(text: &str) -> Result<[f32; 3], String> {
    grey_or_colour(text).ok_or_else(|| "one number or R,G,B".to_owned())
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
        numbers => grey_or_colour(numbers)
            .map(SkyArg::Uniform)
            .ok_or_else(|| "clear, or a radiance: one number or R,G,B".to_owned()),
    }
}

/// Two numbers; one number is both.
fn one_or_two(text: &str, expected: &str) -> Result<[f64; 2], String> {
    match numbers(text).as_deref() {
        Some([both]) => Ok([*both; 2]),
        Some([first, second]) => Ok([*first, *second]),
        _ => Err(expected.to_owned()),
    }
}

/// Curvatures outwards and inwards.
pub fn curvatures(text: &str) -> Result<[f64; 2], String> {
    one_or_two(text, "OUT or OUT,IN, numbers above 0 in 1/m")
}

pub fn cell(text: &str) -> Result<[f64; 2], String> {
    one_or_two(text, "X or X,Y in metres")
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
        Some([exponent, scale]) => Ok(SpecularArg::Constant(ridgelight::scene::PhongSpecular {
            exponent: *exponent as f32,
            scale: *scale as f32,
        })),
        Some(_) => Err("EXPONENT,SCALE, two numbers, or a file".into()),
        None => Ok(SpecularArg::File(text.into())),
    }
}

/// Coefficients and the range of heights, as 16,1200.
pub fn fourier(text: &str) -> Result<Fourier, String> {
    let is_count = |n: f64| (2.0..=256.0).contains(&n) && n % 2.0 == 0.0;
    match numbers(text).as_deref() {
        Some(&[n, range_m]) if is_count(n) && range_m.is_finite() && range_m > 0.0 => {
            Ok(Fourier { coefficients: n as u32, range_m })
        }
        _ => Err("N,RANGE: an even number from 2 to 256, and metres above 0".into()),
    }
}

pub fn pixels(text: &str) -> Result<[u32; 2], String> {
    let is_side = |side: &u32| (1..=16384).contains(side);
    let both = sides(text, &['x']).filter(|both: &[u32; 2]| both.iter().all(is_side));
    both.ok_or_else(|| "WxH, two whole numbers from 1 to 16384".to_owned())
}

/// A box: west, south, east, north.
pub fn bbox(text: &str) -> Result<[f64; 4], String> {
    let all = numbers(text).and_then(|all| all.try_into().ok());
    all.ok_or_else(|| "XMIN,YMIN,XMAX,YMAX, four numbers".to_owned())
}

/// A size in bytes, as 512MiB.
pub fn bytes(text: &str) -> Result<u64, String> {
    let digits = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let expected =
        || "a size, as 512MiB or 2GiB; units are B, kB, MB, GB, KiB, MiB, GiB".to_owned();
    let number: f64 = number.parse().map_err(|_| expected())?;
    let factor = match unit.trim().to_lowercase().as_str() {
        "" | "b" => 1.0,
        "k" | "kib" => 1024.0,
        "m" | "mib" => 1024.0 * 1024.0,
        "g" | "gib" => 1024.0 * 1024.0 * 1024.0,
        "kb" => 1e3,
        "mb" => 1e6,
        "gb" => 1e9,
        _ => return Err(expected()),
    };
    Ok((number * factor) as u64)
}

#[cfg(test)]
mod tests {
    use clap::Arg;
    use clap::error::ErrorKind;

    use super::whole;
    use crate::args::{of_value, parser};

    #[test]
    fn whole_numbers_end_where_their_range_does() {
        let parse = whole(4..=1024_u32);
        assert!(parse("4") == Ok(4) && parse("1024") == Ok(1024));
        for text in ["3", "1025", "-4", "4.5", "x", ""] {
            assert_eq!(parse(text), Err("a whole number from 4 to 1024".to_owned()), "{text}");
        }
    }

    /// Each flag of numbers explains what it expects instead of `1%`, and takes `-5` for its value.
    #[test]
    fn wrong_numbers_are_explained() {
        let words = ["--what", "--encoding"];
        let mut count = 0;
        // Building it takes longer than reading a command line.
        let mut reader = parser();
        for command in parser().get_subcommands() {
            let name = command.get_name();
            for flag in command.get_arguments().filter_map(Arg::get_long) {
                let flag = format!("--{flag}");
                let mut refused = |value: &str| {
                    let words = ["ridgelight", name, &flag, value];
                    reader.try_get_matches_from_mut(words).err()
                };
                let is_value = |e: &clap::Error| e.kind() == ErrorKind::ValueValidation;
                let Some(error) = refused("1%").filter(is_value) else { continue };
                let message = of_value(&error).expect("a value").to_string();
                let start = format!("{flag}: found 1%, expected ");
                assert!(message.starts_with(&start), "{name}: {message}");
                assert!(!message.contains("invalid"), "{name}: {message}");
                let is_unknown = |e: clap::Error| e.kind() == ErrorKind::UnknownArgument;
                let is_flag = refused("-5").is_some_and(is_unknown);
                assert!(!is_flag || words.contains(&&*flag), "{name} {flag} -5");
                count += 1;
            }
        }
        assert!(count > 100, "{count} flags");
    }
}
