//! Real files: the project's own, and more where development data lies beside the clone.

use crate::absolute;
use ridgelight::scene::{HeightField, fill_voids};
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

/// Squares of the bundled mountain are made voids, which covers rims of all shapes that lie far apart in height. The ground that
/// fills them is no steeper than the ground that was there, keeps to the range of the rim, and the rim keeps its bits.
/// (Layers from the rim alone meet in cliffs: 200 m from one grid point to the next for 83 m, at a side of 8.)
#[test]
fn voids_of_a_mountain_are_filled_without_cliffs() {
    let field = read_heights(&asset("mt_washington_256.png"), &HeightOptions::default()).unwrap();
    let (rows, cols) = (field.rows(), field.cols());
    for side in [1, 8, 24] {
        let in_square = |x: usize| (20..236).contains(&x) && (x - 20) % 48 < side;
        let voids: Vec<bool> =
            (0..rows * cols).map(|i| in_square(i / cols) && in_square(i % cols)).collect();
        assert_eq!(voids.iter().filter(|v| **v).count(), 25 * side * side);
        let mut filled = field.heights_m().to_vec();
        voids.iter().zip(&mut filled).filter(|v| *v.0).for_each(|(_, h)| *h = f32::NAN);
        fill_voids([rows, cols], &mut filled, &voids).unwrap();
        // The steepest step from or to a void.
        let steepest = |heights: &[f32]| {
            let step = |i: usize, n: usize| (heights[i] - heights[n]).abs();
            let all = (0..rows * cols).filter(|i| voids[*i]);
            all.flat_map(|i| [i - 1, i + 1, i - cols, i + cols].map(|n| step(i, n)))
                .fold(0.0, f32::max)
        };
        let (found, real) = (steepest(&filled), steepest(field.heights_m()));
        assert!(found > 0.0 && found <= real, "side {side}: {found} m for {real} m");
        for corner in (0..rows * cols).filter(|i| voids[*i] && !voids[i - 1] && !voids[i - cols]) {
            let [top, left] = [corner / cols, corner % cols];
            let square = |margin: usize| {
                let rows = top - margin..top + side + margin;
                rows.flat_map(move |r| {
                    (left - margin..left + side + margin).map(move |c| r * cols + c)
                })
            };
            let rim = square(1).filter(|i| !voids[*i]).map(|i| filled[i]);
            let (low, high) = rim.fold((f32::MAX, f32::MIN), |(l, h), z| (l.min(z), h.max(z)));
            assert!(square(0).all(|i| (low..=high).contains(&filled[i])), "side {side}: {corner}");
        }
        for (i, h) in filled.iter().enumerate().filter(|(i, _)| !voids[*i]) {
            assert_eq!(h.to_bits(), field.heights_m()[i].to_bits());
        }
    }
}
