//! Real files: the project's own, and more where development data lies beside the clone.

use crate::absolute;
use ridgelight::scene::HeightField;
use ridgelight_io::*;
use std::path::{Path, PathBuf};

/// A folder of development data beside the clone, if this checkout has one.
fn shared(file: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(file);
    path.exists().then_some(path)
}

/// A file of this project's own assets.
fn asset(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(file)
}

#[test]
fn the_projects_own_assets() {
    let field = read_heights(&asset("mt_washington_256.png"), &HeightOptions::default()).unwrap();
    assert_eq!((field.rows(), field.cols()), (256, 256));
    assert_eq!(range(&field), (287.0, 1908.0));
    let sky = read_environment(&asset("sky_512x256.hdr"), 0.0).unwrap();
    assert_eq!((sky.width(), sky.height()), (512, 256));
    assert_eq!(peak(&sky).0, 23040.0);
    assert_eq!(peak(&sky).1 % 512, 304);
}

fn range(field: &HeightField) -> (f64, f64) {
    let known = field.voids().map(|v| v.to_vec()).unwrap_or(vec![false; field.heights_m().len()]);
    absolute(field)
        .iter()
        .zip(known)
        .filter(|(_, void)| !void)
        .fold((f64::MAX, f64::MIN), |(lo, hi), (h, _)| (lo.min(*h), hi.max(*h)))
}

/// The largest channel and its texel's index.
fn peak(environment: &ridgelight::scene::Environment) -> (f32, usize) {
    let value = |t: &[f32; 3]| t[0].max(t[1]).max(t[2]);
    let texels = environment.texels();
    let i = (0..texels.len()).max_by(|a, b| value(&texels[*a]).total_cmp(&value(&texels[*b])));
    i.map(|i| (value(&texels[i]), i)).unwrap()
}

#[test]
fn real_files_beside_the_clone() {
    let mut skipped = 0;
    // Name, rows, columns, lowest, highest, voids, cell.
    let heights = [
        ("N44W072.hgt", 1201, 1201, 115.0, 1908.0, 0, [66.0, 92.6]),
        ("mt_rainier_90m.tif", 1201, 1201, 263.0, 4371.0, 9033, [64.0, 92.6]),
        ("jacksboro_fault_dem.npz", 344, 403, 236.0, 1076.0, 0, [74.0, 92.5]),
        ("Moss001_1K_Displacement.png", 1024, 1024, 1392.0, 65535.0, 0, [1.0, 1.0]),
        ("mt_washington_256.png", 256, 256, 287.0, 1908.0, 0, [1.0, 1.0]),
        ("west_bijou_escarpment_snippet.asc", 67, 129, 1690.0, 1807.0, 0, [23.8, 30.9]),
    ];
    for (name, rows, cols, lowest, highest, voids, cell) in heights {
        let Some(path) = shared(&format!("height/{name}")) else {
            skipped += 1;
            continue;
        };
        let field = read_heights(&path, &HeightOptions::default()).unwrap();
        assert_eq!((field.rows(), field.cols()), (rows, cols), "{name}");
        assert_eq!(range(&field), (lowest, highest), "{name}");
        let found = field.voids().map_or(0, |v| v.iter().filter(|v| **v).count());
        assert_eq!(found, voids, "{name}");
        for (got, expected) in field.cell_m().iter().zip(cell) {
            assert!((got / expected - 1.0).abs() < 0.01, "{name}: {got} for {expected}");
        }
    }
    let environments: [(&str, f32, Option<usize>); 4] = [
        ("spiaggia_di_mondello_1k.hdr", 72704.0, Some(615)),
        ("lab.hdr", 49.25, None),
        ("sky_512x256.hdr", 23040.0, Some(304)),
        ("KernerEnvLatLong.exr", 1678.0, None),
    ];
    for (name, expected, col) in environments {
        let Some(path) = shared(&format!("env/{name}")) else {
            skipped += 1;
            continue;
        };
        let environment = read_environment(&path, 0.0).unwrap();
        let (value, texel) = peak(&environment);
        assert!((value / expected - 1.0).abs() < 1e-3, "{name}: {value} for {expected}");
        if let Some(col) = col {
            assert_eq!(texel % environment.width(), col, "{name}");
        }
    }
    println!("{skipped} of 10 real files are not beside this clone");
}
