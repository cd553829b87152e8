//! Synthetic terrains ([`terrain`]) and golden images for tests: on failure the result, the golden and their difference are written to files.
//!
//! `RIDGELIGHT_BLESS=1` writes the result as the new golden instead. It is refused where `CI` is set.
//!
//! ```no_run
//! use std::path::Path;
//! use ridgelight_testing as golden;
//! # use ridgelight::gpu::Pixels;
//! # fn test(pixels: Pixels) -> ridgelight::Result<()> {
//! // `pixels` from `Headless::pixels`, 64 rows of 64 texels.
//! let lit = golden::planes(&pixels, [64, 64])?;
//! let error = golden::hold(&lit, Path::new("tests/goldens/lit.exr"), 1e-5, Path::new("target/goldens"))?;
//! assert!(error <= 1.0, "the largest error over the tolerance");
//! # Ok(())
//! # }
//! ```
//!
//! Drivers differ by rounding. Prefer a tolerance above it (`ridgelight_cpu::tolerance` has those of
//! single passes) to one golden per driver.

#![deny(clippy::missing_errors_doc)]

pub mod terrain;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use ridgelight::gpu::Pixels;
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Layer, Planes};

/// Planes of an image of `rows` × `cols` texels: R, G and B of a colour without its alpha, Y of one
/// channel, or 0, 1, 2 … of layers.
///
/// # Errors
/// A number of values that is no multiple of a layer's.
pub fn planes(pixels: &Pixels, [rows, cols]: [usize; 2]) -> Result<Planes> {
    let size = rows * cols * pixels.channels;
    if size == 0 || !pixels.values.len().is_multiple_of(size) {
        let found = format!("{} values, {} per texel", pixels.values.len(), pixels.channels);
        return Err(Error::setting(&pixels.name, found, format!("layers of {rows} × {cols}")));
    }
    let layers: Vec<&[f32]> = pixels.values.chunks_exact(size).collect();
    let plane = |layer: &[f32], channel: usize| {
        layer.iter().skip(channel).step_by(pixels.channels).copied().collect()
    };
    let (names, planes) = match (pixels.channels, layers.as_slice()) {
        (1, [layer]) => (vec!["Y".to_owned()], vec![plane(layer, 0)]),
        (4, [layer]) => {
            (["R", "G", "B"].map(str::to_owned).to_vec(), (0..3).map(|c| plane(layer, c)).collect())
        }
        _ => layers.iter().enumerate().map(|(k, l)| (k.to_string(), plane(l, 0))).unzip(),
    };
    Ok(Planes { rows, cols, names, planes })
}

/// Compares a result with a golden, .exr or .npy ([`files::read_planes`]), and returns the largest error over
/// `tolerance`. NaN equals only NaN.
///
/// # Errors
/// - A value beyond the tolerance, another size or other names. The message names the place and the files
///   `GOLDEN.got.exr`, `GOLDEN.want.exr` and, for equal shapes, `GOLDEN.diff.exr`, written to `folder`, which is
///   made if missing.
/// - A missing golden. The result is written beside it as `NAME.new.EXT`.
/// - Files that cannot be read or written.
pub fn hold(got: &Planes, golden: &Path, tolerance: f64, folder: &Path) -> Result<f64> {
    let write = |path: &Path| {
        // The first golden of a project.
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
        parent.map_or(Ok(()), |parent| {
            std::fs::create_dir_all(parent).map_err(|source| Error::io(parent, source))
        })?;
        write(path, got)
    };
    let is_set = |name: &str, value: &str| std::env::var_os(name).is_some_and(|v| v == value);
    if is_set("RIDGELIGHT_BLESS", "1") {
        if std::env::var_os("CI").is_some() {
            return Err(Error::setting("RIDGELIGHT_BLESS", "CI set too", "one of them"));
        }
        write(golden)?;
    } else if !golden.exists() {
        let mut name = golden.file_stem().unwrap_or_default().to_owned();
        name.push(".new");
        if let Some(extension) = golden.extension() {
            name.push(".");
            name.push(extension);
        }
        let new = golden.with_file_name(name);
        write(&new)?;
        let expected = format!(
            "a golden; check {} and rename it, or set RIDGELIGHT_BLESS=1 to write the golden",
            new.display()
        );
        return Err(Error::file(golden, "golden", "no file", expected));
    }
    let want = in_order(files::read_planes(golden)?, &got.names);
    let failure = match worst(got, &want, tolerance) {
        Ok((ratio, _)) if ratio <= 1.0 => return Ok(ratio),
        Ok((_, (plane, i))) => {
            let place =
                format!("{}: row {}, column {}", got.names[plane], i / got.cols, i % got.cols);
            let [found, expected] = [got, &want].map(|p| p.planes[plane][i].to_string());
            (place, found, format!("{expected} within {tolerance:e}"))
        }
        Err((found, expected)) => ("shape".to_owned(), found, expected),
    };
    std::fs::create_dir_all(folder).map_err(|source| Error::io(folder, source))?;
    let name = golden.file_name().unwrap_or(OsStr::new("golden")).to_string_lossy();
    let output = |what: &str| -> PathBuf { folder.join(format!("{name}.{what}.exr")) };
    write_exr(&output("got"), got)?;
    write_exr(&output("want"), &want)?;
    let mut all = "got,want";
    if shape(got) == shape(&want) {
        let mut diff = got.clone();
        for (d, w) in diff.planes.iter_mut().flatten().zip(want.planes.iter().flatten()) {
            *d -= w;
        }
        write_exr(&output("diff"), &diff)?;
        all = "got,want,diff";
    }
    let (place, found, expected) = failure;
    let see = output(&format!("{{{all}}}"));
    Err(Error::file(golden, place, found, format!("{expected}; see {}", see.display())))
}

fn shape(planes: &Planes) -> (usize, usize, &[String]) {
    (planes.rows, planes.cols, &planes.names)
}

type Place = (usize, usize);

/// The largest |difference| over `tolerance`, with its plane and index; else both shapes, where they differ.
fn worst(
    got: &Planes,
    want: &Planes,
    tolerance: f64,
) -> std::result::Result<(f64, Place), (String, String)> {
    if shape(got) != shape(want) {
        let text = |p: &Planes| format!("{} × {} of {}", p.rows, p.cols, p.names.join(", "));
        return Err((text(got), text(want)));
    }
    let mut worst = (0.0, (0, 0));
    for (plane, (got, want)) in got.planes.iter().zip(&want.planes).enumerate() {
        for (i, (got, want)) in got.iter().zip(want).enumerate() {
            let error = match (got.is_nan(), want.is_nan()) {
                (true, true) => 0.0,
                (false, false) if got == want => 0.0,
                (false, false) => (f64::from(*got) - f64::from(*want)).abs() / tolerance,
                _ => f64::INFINITY,
            };
            if error > worst.0 || error.is_nan() {
                worst = (if error.is_nan() { f64::INFINITY } else { error }, (plane, i));
            }
        }
    }
    Ok(worst)
}

/// Planes in the order of `names`: an EXR stores channels by name.
fn in_order(planes: Planes, names: &[String]) -> Planes {
    let place = |name: &String| planes.names.iter().position(|n| n == name);
    let order: Option<Vec<usize>> = names.iter().map(place).collect();
    match order.filter(|order| order.len() == planes.names.len()) {
        Some(order) => Planes {
            names: names.to_vec(),
            planes: order.iter().map(|i| planes.planes[*i].clone()).collect(),
            ..planes
        },
        None => planes,
    }
}

fn write(path: &Path, planes: &Planes) -> Result<()> {
    if path.extension().is_some_and(|e| e == "npy") {
        let shape = [planes.planes.len(), planes.rows, planes.cols];
        return files::write_npy_f32(path, &shape, planes.planes.iter().map(Vec::as_slice));
    }
    write_exr(path, planes)
}

fn write_exr(path: &Path, planes: &Planes) -> Result<()> {
    let all = planes.names.iter().zip(&planes.planes);
    let layers: Vec<Layer> = all.map(|(name, values)| Layer::scalar(name, values)).collect();
    files::write_exr(path, planes.rows, planes.cols, &layers, &[])
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    /// Set in the child process of a test: the golden that it holds a result against.
    const CHILD: &str = "RIDGELIGHT_TESTING_GOLDEN";

    fn two_by_three() -> Planes {
        let values = vec![0.0, 1.0, f32::NAN, 3.0, 4.0, 5.0];
        Planes { rows: 2, cols: 3, names: vec!["Y".to_owned()], planes: vec![values] }
    }

    #[test]
    fn a_difference_writes_three_images() {
        let folder = tempfile::tempdir().unwrap();
        let (golden, output) = (folder.path().join("lit.exr"), folder.path().join("left"));
        let want = two_by_three();
        write(&golden, &want).unwrap();
        assert_eq!(hold(&want, &golden, 1e-6, &output).unwrap(), 0.0);
        assert!(!output.exists());
        let mut got = want.clone();
        got.planes[0][4] += 5e-7;
        // An ulp of 4 is 4.8e-7.
        let ratio = hold(&got, &golden, 1e-6, &output).unwrap();
        assert!(ratio > 0.0 && ratio <= 1.0, "{ratio}");
        got.planes[0][4] = 4.5;
        let wrong = hold(&got, &golden, 1e-6, &output).unwrap_err().to_string();
        for part in [
            "lit.exr: Y: row 1, column 1",
            "found 4.5",
            "expected 4 within 1e-6",
            "{got,want,diff}",
        ] {
            assert!(wrong.contains(part), "{part} in {wrong}");
        }
        let read = |what: &str| {
            files::read_planes(&output.join(format!("lit.exr.{what}.exr"))).unwrap().planes
        };
        assert_eq!((read("got")[0][4], read("want")[0][4], read("diff")[0][4]), (4.5, 4.0, 0.5));
    }

    /// Of two texels beyond the tolerance the message names the one with the larger error, whichever comes first and in whichever
    /// plane it is.
    #[test]
    fn the_larger_of_two_errors_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let golden = folder.path().join("lit.exr");
        let plane = two_by_three().planes.remove(0);
        let names = ["R", "G"].map(str::to_owned).to_vec();
        let want = Planes { names, planes: vec![plane.clone(), plane], ..two_by_three() };
        write(&golden, &want).unwrap();
        for (larger, smaller) in
            [((0, 1), (0, 4)), ((0, 4), (0, 1)), ((1, 3), (0, 3)), ((0, 5), (1, 0))]
        {
            let mut got = want.clone();
            got.planes[larger.0][larger.1] -= 2.0;
            got.planes[smaller.0][smaller.1] += 1.0;
            let message = hold(&got, &golden, 1e-6, folder.path()).unwrap_err().to_string();
            let (name, i) = (&want.names[larger.0], larger.1);
            let [found, expected] = [&got, &want].map(|planes| planes.planes[larger.0][i]);
            let place = format!("{name}: row {}, column {}", i / 3, i % 3);
            let named = format!("{place}: found {found}, expected {expected} within 1e-6");
            assert!(message.contains(&named), "{named} in {message}");
        }
    }

    /// With `RIDGELIGHT_BLESS=1` a result becomes the golden, also over another one. Where `CI` is set too, or for another value,
    /// the golden stays, and none is made. In a process of its own: other tests must not have the variables.
    #[test]
    fn bless_writes_the_golden_except_in_ci() {
        let got = two_by_three();
        if let Some(golden) = std::env::var_os(CHILD) {
            let output = Path::new(&golden).with_extension("output");
            match hold(&got, Path::new(&golden), 1e-6, &output) {
                Ok(ratio) => println!("holds by {ratio}"),
                Err(error) => println!("refused: {error}"),
            }
            return;
        }
        let folder = tempfile::tempdir().unwrap();
        let golden = folder.path().join("lit.exr");
        let mut old = got.clone();
        old.planes[0][4] = 7.0;
        // What the child prints, and the value in the golden after it.
        let held = |has_old: bool, variables: &[(&str, &str)]| {
            if has_old {
                write(&golden, &old).unwrap();
            } else if golden.exists() {
                std::fs::remove_file(&golden).unwrap();
            }
            let mut child = Command::new(std::env::current_exe().unwrap());
            child.args(["--exact", "tests::bless_writes_the_golden_except_in_ci", "--nocapture"]);
            child.env_remove("RIDGELIGHT_BLESS").env_remove("CI").env(CHILD, &golden);
            let run = child.envs(variables.iter().copied()).output().unwrap();
            let said = [run.stdout, run.stderr].map(|s| String::from_utf8_lossy(&s).into_owned());
            let said = said.concat();
            assert!(run.status.success(), "{said}");
            let value = golden.exists().then(|| files::read_planes(&golden).unwrap().planes[0][4]);
            (said, value)
        };
        let bless = ("RIDGELIGHT_BLESS", "1");
        for has_old in [false, true] {
            let (said, value) = held(has_old, &[bless]);
            assert!(said.contains("holds by 0"), "{said}");
            assert_eq!(value, Some(4.0), "{said}");
            for ci in ["true", ""] {
                let (said, value) = held(has_old, &[bless, ("CI", ci)]);
                let refused = "refused: RIDGELIGHT_BLESS: found CI set too, expected one of them";
                assert!(said.contains(refused), "{said}");
                assert_eq!(value, has_old.then_some(7.0), "{said}");
            }
            let others: [&[(&str, &str)]; 3] =
                [&[], &[("CI", "true")], &[("RIDGELIGHT_BLESS", "0")]];
            for variables in others {
                let (said, value) = held(has_old, variables);
                let found = if has_old { "found 4, expected 7 within" } else { "found no file" };
                assert!(said.contains("refused: ") && said.contains(found), "{said}");
                assert_eq!(value, has_old.then_some(7.0), "{said}");
            }
        }
    }

    #[test]
    fn a_missing_golden_is_written_as_new() {
        let folder = tempfile::tempdir().unwrap();
        // The folder of a project's first golden is made, too.
        let (golden, output) =
            (folder.path().join("goldens/lit.exr"), folder.path().join("output"));
        let got = two_by_three();
        let message = hold(&got, &golden, 1e-6, &output).unwrap_err().to_string();
        for part in ["lit.exr: golden: found no file", "lit.new.exr", "RIDGELIGHT_BLESS=1"] {
            assert!(message.contains(part), "{part} in {message}");
        }
        assert!(!golden.exists() && !output.exists());
        std::fs::rename(golden.with_file_name("lit.new.exr"), &golden).unwrap();
        assert_eq!(hold(&got, &golden, 1e-6, &output).unwrap(), 0.0);
    }

    #[test]
    fn nan_size_and_names_are_compared() {
        let folder = tempfile::tempdir().unwrap();
        let golden = folder.path().join("lit.npy");
        let want = Planes { names: vec!["0".to_owned()], ..two_by_three() };
        write(&golden, &want).unwrap();
        let refuses =
            |got: &Planes| hold(got, &golden, f64::MAX, folder.path()).unwrap_err().to_string();
        let mut got = want.clone();
        got.planes[0][0] = f32::NAN;
        assert!(refuses(&got).contains("row 0, column 0: found NaN"), "{}", refuses(&got));
        (got.planes[0][0], got.planes[0][2]) = (0.0, 2.0);
        assert!(refuses(&got).contains("row 0, column 2: found 2"), "{}", refuses(&got));
        let turned = Planes { rows: 3, cols: 2, ..want.clone() };
        assert!(
            refuses(&turned).contains("found 3 × 2 of 0, expected 2 × 3 of 0"),
            "{}",
            refuses(&turned)
        );
        let renamed = Planes { names: vec!["Y".to_owned()], ..want };
        assert!(refuses(&renamed).contains("2 × 3 of Y"), "{}", refuses(&renamed));
    }

    #[test]
    fn planes_are_colours_scalars_or_layers() {
        let of = |channels: usize, values: Vec<f32>, size: [usize; 2]| {
            let pixels = Pixels { name: "lit".into(), channels, values };
            planes(&pixels, size).map(|p| (p.names.join(""), p.planes))
        };
        assert_eq!(of(1, vec![1.0, 2.0], [1, 2]).unwrap(), ("Y".into(), vec![vec![1.0, 2.0]]));
        let colour = of(4, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], [2, 1]).unwrap();
        assert_eq!(colour, ("RGB".into(), vec![vec![1.0, 5.0], vec![2.0, 6.0], vec![3.0, 7.0]]));
        assert_eq!(
            of(1, vec![1.0, 2.0], [1, 1]).unwrap(),
            ("01".into(), vec![vec![1.0], vec![2.0]])
        );
        assert!(of(1, vec![1.0; 3], [1, 2]).is_err());
    }
}
