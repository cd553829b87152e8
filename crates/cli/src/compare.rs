mod pairs;
mod rows;

use std::path::Path;

use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Channels, Georeference, Layer};

use crate::args::{CompareArgs, Renamed};
use crate::setup::{self, Outcome};
use pairs::{Pair, Pairs};
use rows::{Excess, Row};

pub fn run(args: &CompareArgs) -> Result<Outcome> {
    check(args)?;
    let mut renamed = Renamed::default();
    let [a, b] = [&args.result, &args.reference].map(|path| pairs::read(path, &mut renamed));
    let (a, b) = (a?, b?);
    // Before the work: its tags may be invalid.
    let at = match &args.diff {
        Some(path) if setup::is_geotiff(path) => georeference(args)?,
        _ => None,
    };
    if !args.quiet {
        renamed.warn();
        note_elsewhere(args);
    }
    if args.horizons {
        pairs::check_horizons(&args.result, &a)?;
        pairs::check_horizons(&args.reference, &b)?;
    }
    let pairs = Pairs::of(args, &a, &b)?;
    let bar = crate::setup::terminal::progress(args.quiet, "comparing");
    let mut maps = Vec::new();
    let (mut channels, mut pictures) = (Vec::new(), Vec::new());
    if args.horizons {
        channels.push(rows::horizons(args, &pairs)?);
    } else {
        for pair in &pairs.channels {
            channels.push(rows::channel(args, &pairs, pair)?);
        }
        for picture in pairs.pictures() {
            let map = picture.flip(args, &pairs)?;
            pictures.push(rows::picture(args, &pairs, &picture.layer, &map)?);
            maps.push((picture.layer, map));
        }
    }
    bar.finish_and_clear();
    let rows = || channels.iter().chain(&pictures);
    let mut beyond: Vec<Excess> = pairs.lost.iter().map(|name| Excess::lost(name)).collect();
    beyond.extend(rows::beyond(&args.bounds.all(), rows()));
    if !args.quiet {
        for (path, names) in [(&args.result, &pairs.only_a), (&args.reference, &pairs.only_b)] {
            if !names.is_empty() {
                crate::say!("not compared, only in {}: {}", path.display(), names.join(" "));
            }
        }
        rows().for_each(|row| crate::say!("{}: {}", row.name, row.text));
        beyond.iter().for_each(|excess| crate::say!("beyond {excess}"));
    }
    if let Some(path) = &args.diff {
        write_difference(path, at.as_ref(), &pairs, &maps)?;
    }
    if let Some(path) = &args.json {
        let of = |rows: &[Row]| rows.iter().map(|row| row.json.clone()).collect::<Vec<_>>();
        let figures = serde_json::json!({
            "rows": of(&channels),
            "flip": of(&pictures),
            "exposure": args.exposure,
            "pixels_per_degree": pairs::pixels_per_degree(args),
            "only_in_a": pairs.only_a,
            "only_in_b": pairs.only_b,
            "beyond": !beyond.is_empty(),
            "excesses": beyond,
        });
        files::write_json(path, &figures)?;
    }
    Ok(if beyond.is_empty() { Outcome::Done } else { Outcome::Beyond })
}

/// Checks arguments before a file is read.
fn check(args: &CompareArgs) -> Result<()> {
    for path in [&args.result, &args.reference] {
        if setup::extension(path) == "json" {
            let expected = format!(
                "an .exr, .tif, .png, .hdr or .npy; to compare times of `bench --json`, run `ridgelight bench --against {}`",
                path.display()
            );
            return Err(Error::file(path, "name", "the extension .json", expected));
        }
    }
    let outputs = [
        ("--diff", args.diff.as_deref(), &["exr", "tif", "tiff", "npy"][..]),
        ("--json", args.json.as_deref(), &["json"]),
    ];
    setup::check_outputs(&outputs, &[&args.result, &args.reference])?;
    for (flag, bound) in args.bounds.all() {
        if let Some(bound) = bound.filter(|x| x.is_nan() || *x < 0.0) {
            return Err(Error::setting(flag, bound.to_string(), "0 or more"));
        }
    }
    crate::render::check_positive("--exposure", args.exposure)?;
    if args.exposure != 1.0
        && [&args.result, &args.reference].iter().all(|path| setup::extension(path) == "png")
    {
        let expected = "at least one .exr, .tif or .hdr: a .png has no exposure";
        return Err(Error::setting("--exposure", "two .png files", expected));
    }
    Ok(())
}

/// Georeference of the first input that is a GeoTIFF with one.
fn georeference(args: &CompareArgs) -> Result<Option<Georeference>> {
    for path in [&args.result, &args.reference].into_iter().filter(|path| setup::is_geotiff(path)) {
        let at = files::read_georeference(path)?;
        if at.is_some() {
            return Ok(at);
        }
    }
    Ok(None)
}

/// A note where both files have a position, and not the same.
fn note_elsewhere(args: &CompareArgs) {
    let position = |path: &Path| {
        let is_geotiff = setup::is_geotiff(path);
        is_geotiff.then(|| files::read_georeference(path).ok().flatten()).flatten()
    };
    let (Some(a), Some(b)) = (position(&args.result), position(&args.reference)) else { return };
    let is_near = |a: f64, b: f64, cell: f64| (a - b).abs() <= 1e-3 * cell;
    let is_same = (0..2).all(|i| {
        is_near(a.corner[i], b.corner[i], b.cell[i]) && is_near(a.cell[i], b.cell[i], b.cell[i])
    });
    if !is_same || !a.keys.is_same_crs(&b.keys) {
        setup::note(
            "the files have different positions or coordinate reference systems; pixels are compared by row and column",
        );
    }
}

/// A ꟻLIP map per layer, by the layer's name.
fn write_difference(
    path: &Path,
    at: Option<&Georeference>,
    pairs: &Pairs,
    maps: &[(String, Vec<f32>)],
) -> Result<()> {
    // Equal infinities have no difference.
    let difference = |(a, b): (&f32, &f32)| if a == b { 0.0 } else { a - b };
    let of = |pair: &Pair| pair.a.iter().zip(pair.b).map(difference).collect();
    let differences: Vec<Vec<f32>> = pairs.channels.iter().map(of).collect();
    let (rows, cols) = (pairs.rows, pairs.cols);
    if setup::extension(path) == "npy" {
        let shape = [differences.len(), rows, cols];
        return files::write_npy_f32(path, &shape, differences.iter().map(Vec::as_slice));
    }
    let layer = |name: &str, channels| Layer { name: name.to_owned(), channels };
    let planes = pairs.channels.iter().zip(&differences);
    let mut layers: Vec<Layer> = planes
        .map(|(pair, plane)| layer("difference", Channels::Scalar(pair.name, plane)))
        .collect();
    layers.extend(maps.iter().map(|(name, map)| layer("flip", Channels::Scalar(name, map))));
    setup::write_layers(path, [rows, cols], &layers, &[], at, &[])
}
