//! Real files: the project's own, and more where development data lies beside the clone.

use crate::absolute;
use ridgelight::scene::{HeightField, fill_voids};
use ridgelight_io::*;
use std::collections::HashMap;
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

/// Fills the voids of heights that are `cols` wide.
fn filled(heights: &[f32], cols: usize, is_void: impl Fn(usize, usize) -> bool) -> Vec<f32> {
    let voids: Vec<bool> = (0..heights.len()).map(|i| is_void(i / cols, i % cols)).collect();
    let mut all = heights.to_vec();
    voids.iter().zip(&mut all).filter(|v| *v.0).for_each(|(_, h)| *h = f32::NAN);
    fill_voids([heights.len() / cols, cols], &mut all, &voids).unwrap();
    all
}

/// Squares of the bundled mountain are made voids, apart and at edges and corners. Each is filled by ground that is no steeper than
/// the steepest ground that was there, and within the range of the known heights around it. (By layers alone it meets in steps of
/// 200 m, where the steepest real one has 83 m, at a side of 8.) A mirrored field has mirrored heights, except for rounding.
#[test]
fn voids_of_a_mountain_are_filled_without_cliffs() {
    let field = read_heights(&asset("mt_washington_256.png"), &HeightOptions::default()).unwrap();
    let (n, real) = (field.cols(), field.heights_m());
    // Sides of squares and the distance from one to the next.
    for (side, pitch) in [(8, 31), (24, 58), (100, 156)] {
        let is_void = |r: usize, c: usize| r % pitch < side && c % pitch < side;
        let found = filled(real, n, is_void);
        let mirrored: Vec<f32> = (0..n * n).map(|i| real[i - i % n + n - 1 - i % n]).collect();
        let mirrored = filled(&mirrored, n, |r, c| is_void(r, n - 1 - c));
        let mut steepest = [0.0_f32; 2];
        let mut ranges = HashMap::new();
        for (i, height) in found.iter().enumerate() {
            let (r, c) = (i / n, i % n);
            assert!((height - mirrored[i - c + n - 1 - c]).abs() <= 4.0 * f32::EPSILON * 2000.0);
            if !is_void(r, c) {
                assert_eq!(height.to_bits(), real[i].to_bits());
                continue;
            }
            let near = [(r.wrapping_sub(1), c), (r + 1, c), (r, c.wrapping_sub(1)), (r, c + 1)];
            for (row, col) in near.into_iter().filter(|(r, c)| *r < n && *c < n) {
                for (most, heights) in steepest.iter_mut().zip([&found[..], real]) {
                    *most = most.max((heights[i] - heights[row * n + col]).abs());
                }
            }
            let corner = [r - r % pitch, c - c % pitch];
            let range = ranges.entry(corner).or_insert_with(|| {
                let around = |first: usize| first.saturating_sub(1)..(first + side + 1).min(n);
                let known = around(corner[0]).flat_map(|r| around(corner[1]).map(move |c| (r, c)));
                let known = known.filter(|(r, c)| !is_void(*r, *c)).map(|(r, c)| real[r * n + c]);
                known.fold([f32::MAX, f32::MIN], |[l, h], z| [l.min(z), h.max(z)])
            });
            assert!((range[0]..=range[1]).contains(height), "side {side}: {height} of {range:?}");
        }
        assert!(0.0 < steepest[0] && steepest[0] <= steepest[1], "side {side}: {steepest:?} m");
    }
    let level = filled(&[5.0; 42], 7, |r, c| r < 3 && c > 1 || r == 5);
    assert_eq!(level, [5.0; 42]);
}

/// Two plains, a void 200 wide between them. What fills it rises evenly, as Laplace's equation has it: at most twice as steep.
#[test]
fn a_wide_void_between_two_plains_has_no_step() {
    let (rows, cols, width) = (9, 240, 200);
    let heights: Vec<f32> =
        (0..rows * cols).map(|i| if i % cols < 120 { 0.0 } else { 1000.0 }).collect();
    let found = filled(&heights, cols, |_, c| (20..20 + width).contains(&c));
    let steepest = found.windows(2).enumerate().filter(|(i, _)| (i + 1) % cols != 0);
    let steepest = steepest.map(|(_, w)| w[1] - w[0]).fold(0.0, f32::max);
    assert!(steepest <= 2.0 * 1000.0 / (width + 1) as f32, "{steepest} m");
}
