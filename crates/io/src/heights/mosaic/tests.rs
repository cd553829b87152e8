use super::*;
use crate::georeference::GeoKeys;
use crate::heights::Cell;

/// A projected system of this code.
fn crs(code: u16) -> GeoKeys {
    GeoKeys { entries: vec![[1024, 0, 1, 1], [3072, 0, 1, code]], ..GeoKeys::default() }
}

/// The height of a grid point of one large field, by its row and column from the north-west.
fn height(row: i64, col: i64) -> f64 {
    (100 * row + col) as f64
}

/// Cells of 10 x 20 m; the large field's corner is at 5000 m east, 9000 m north.
fn tile(name: &str, [row, col]: [i64; 2], [rows, cols]: [usize; 2]) -> Tile {
    let values = (0..rows * cols)
        .map(|i| height(row + (i / cols) as i64, col + (i % cols) as i64))
        .collect();
    let corner = [5000.0 + 10.0 * col as f64, 9000.0 - 20.0 * row as f64];
    let at = Georeference { corner, cell: [10.0, 20.0], keys: crs(32618) };
    let raster = Raster {
        cell: Cell::Metres([10.0, 20.0]),
        georeference: Some(at),
        ..Raster::bare(rows, cols, values)
    };
    (name.into(), raster)
}

fn refused(tiles: Vec<Tile>, says: &[&str]) {
    let error = joined(tiles).err().expect("an error").to_string();
    assert!(says.iter().all(|said| error.contains(said)), "{error}");
}

#[test]
fn tiles_that_touch_or_overlap_are_the_whole_field() {
    let (_, whole) = tile("whole", [-3, -2], [7, 9]);
    // In any order; the last two overlap the others.
    let tiles = || {
        vec![
            tile("a", [0, 0], [4, 3]),
            tile("b", [-3, -2], [3, 9]),
            tile("c", [0, 3], [4, 4]),
            tile("d", [-1, -2], [5, 3]),
        ]
    };
    for first in 0..4 {
        let mut tiles = tiles();
        tiles.rotate_left(first);
        let field = joined(tiles).unwrap();
        assert_eq!((field.rows, field.cols), (7, 9));
        assert_eq!(field.values, whole.values);
        assert_eq!(field.georeference, whole.georeference);
        assert!(field.notes.is_empty(), "{:?}", field.notes);
        assert!(!field.voids.unwrap().contains(&true));
    }
}

#[test]
fn gaps_and_differences_are_noted() {
    let gap = joined(vec![tile("a", [0, 0], [2, 2]), tile("b", [2, 3], [2, 2])]).unwrap();
    let voids = gap.voids.unwrap();
    // 4 x 5 grid points, 8 of them in files.
    assert_eq!((gap.rows, gap.cols), (4, 5));
    assert_eq!(voids.iter().filter(|v| **v).count(), 12);
    assert!(!voids[0] && voids[2] && !voids[13]);
    assert_eq!(gap.notes, ["60.000 % of the joined extent is in no file: voids there"]);

    let mut other = tile("b", [0, 1], [2, 2]);
    other.1.values[0] = 4.0;
    let [one, two] = [[0, 1], [1, 0]].map(|order| {
        let tiles = [
            tile("a", [0, 0], [2, 2]),
            (other.0.clone(), {
                let mut again = tile("b", [0, 1], [2, 2]).1;
                again.values[0] = 4.0;
                again
            }),
        ];
        let mut tiles: Vec<_> = tiles.into_iter().map(Some).collect();
        joined(order.map(|i: usize| tiles[i].take().unwrap()).into()).unwrap()
    });
    assert_eq!((one.values[1], two.values[1]), (1.0, 4.0));
    let note =
        "files differ at 1 of 2 overlapping grid points, by up to 3 m: the first file counts";
    assert_eq!((one.notes, two.notes), (vec![note.to_owned()], vec![note.to_owned()]));
}

#[test]
fn a_void_takes_the_height_of_another_file() {
    let mut first = tile("a", [0, 0], [2, 2]);
    first.1.voids = Some(vec![false, true, false, true]);
    let field = joined(vec![first, tile("b", [0, 1], [1, 2])]).unwrap();
    assert_eq!(field.values[..3], [0.0, 1.0, 2.0]);
    // Of row 1, column 0 alone is known; column 2 is in no file.
    assert_eq!(field.voids.unwrap(), [false, false, false, false, true, true]);
}

#[test]
fn files_that_do_not_fit_are_named_with_both_values() {
    let a = || tile("a.tif", [0, 0], [2, 2]);
    let with = |change: &dyn Fn(&mut Georeference)| {
        let (name, mut raster) = tile("b.tif", [0, 2], [2, 2]);
        change(raster.georeference.as_mut().unwrap());
        vec![a(), (name, raster)]
    };
    let says = ["b.tif", "EPSG:32619", "EPSG:32618 as in a.tif"];
    refused(with(&|at| at.keys = crs(32619)), &says);
    refused(with(&|at| at.keys = GeoKeys::default()), &["b.tif", "found none", "EPSG:32618"]);
    refused(with(&|at| at.cell = [10.0, 21.0]), &["b.tif", "10 x 21", "10 x 20 as in a.tif"]);
    refused(with(&|at| at.corner[0] += 2.5), &["b.tif", "2.250 columns and 0.000 rows from a.tif"]);
    refused(with(&|at| at.corner[1] += 5.0), &["b.tif", "-0.250 rows", "whole cells"]);
    refused(with(&|at| at.corner[0] += 1e6), &["a.tif", "100004 columns"]);
    refused(with(&|at| at.corner[0] += 4e4), &["a.tif", "4004 x 2 grid points, 8 of them"]);
    refused(with(&|at| at.corner[0] = f64::MAX), &["b.tif", "whole cells"]);
    let mut bare = tile("b.tif", [0, 2], [2, 2]);
    bare.1.georeference = None;
    refused(vec![a(), bare], &["b.tif", "georeference", "found none"]);
    // Rounded positions and cells, and keys that differ in nothing that matters.
    let nearly = |at: &mut Georeference| {
        at.corner[0] += 0.05;
        at.cell[0] *= 1.004;
        at.keys.entries.push([1025, 0, 1, 2]);
        at.keys.entries.push([4099, 0, 1, 9002]);
    };
    assert!(joined(with(&nearly)).is_ok());
    let mut nan = tile("b.tif", [0, 2], [2, 2]);
    nan.1.values[3] = f64::NAN;
    refused(vec![a(), nan], &["b.tif", "row 1, column 1", "NaN"]);
}

#[test]
fn a_box_keeps_the_cells_that_it_touches() {
    let (path, _) = tile("a", [0, 0], [6, 8]);
    let cut = |bbox| cropped(&path, tile("a", [0, 0], [6, 8]).1, bbox);
    let found = |bbox| {
        let part = cut(bbox).unwrap();
        (part.values[0], part.rows, part.cols, part.georeference.unwrap().corner)
    };
    // Edges of cells, edges rounded by a thousandth of a cell, and inside cells.
    for bbox in [
        [5020.0, 8920.0, 5050.0, 8980.0],
        [5019.99, 8919.98, 5050.01, 8980.02],
        [5024.0, 8930.0, 5043.0, 8965.0],
    ] {
        assert_eq!(found(bbox), (height(1, 2), 3, 3, [5020.0, 8980.0]));
    }
    let (value, rows, cols, corner) = found([5061.0, 0.0, 1e6, 8899.0]);
    assert_eq!((value, rows, cols, corner), (height(5, 6), 1, 2, [5060.0, 8900.0]));
    let beyond = cut([5061.0, 0.0, 1e6, 8899.0]).unwrap().notes.remove(0);
    assert!(beyond.contains("extent is 5000,8880,5080,9000"), "{beyond}");
    assert!(cut([5020.0, 8920.0, 5050.0, 8980.0]).unwrap().notes.is_empty());
    for outside in [[0.0, 0.0, 1.0, 1.0], [5080.0, 8880.0, 5090.0, 9000.0]] {
        let error = cut(outside).err().unwrap().to_string();
        assert!(error.contains("bbox") && error.contains("5000,8880,5080,9000"), "{error}");
    }
    let mut bare = tile("a", [0, 0], [6, 8]).1;
    bare.georeference = None;
    assert!(cropped(&path, bare, [0.0, 0.0, 1.0, 1.0]).is_err());
}

/// The cells of a part are those at its own latitude.
#[test]
fn degrees_follow_the_part() {
    let mut whole = tile("a", [0, 0], [100, 2]).1;
    let at = whole.georeference.as_mut().unwrap();
    (at.corner, at.cell) = ([7.0, 60.0], [0.1, 0.1]);
    whole.cell = Cell::Degrees { cell: [0.1, 0.1], latitude: 55.0 };
    let part = cropped(Path::new("a"), whole, [7.0, 50.0, 8.0, 51.0]).unwrap();
    assert!(matches!(part.cell, Cell::Degrees { latitude, .. } if (latitude - 50.5).abs() < 1e-9));
}
