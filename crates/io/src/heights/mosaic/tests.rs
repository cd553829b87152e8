use super::*;
use crate::georeference::GeoKeys;
use crate::heights::Cell;
use crate::{Channels, HeightOptions, Layer, read_mosaic, write_geotiff};

type Tile = (PathBuf, Raster);

/// Joins tiles, each cut to what is near the box.
fn joined_in(tiles: Vec<Tile>, bbox: Option<[f64; 4]>) -> Result<Raster> {
    joined_of(tiles, bbox, false)
}

fn joined_of(tiles: Vec<Tile>, bbox: Option<[f64; 4]>, is_unit_known: bool) -> Result<Raster> {
    let cut = |(path, mut raster): Tile| {
        let size = [raster.rows, raster.cols];
        let window = match (&raster.georeference, bbox) {
            (Some(at), Some(bbox)) => Window::near(at, size, bbox),
            _ => Window::whole(size),
        };
        window.cut(&mut raster);
        super::Tile { path, raster, window }
    };
    super::joined(tiles.into_iter().map(cut).collect(), bbox, is_unit_known)
}

fn joined(tiles: Vec<Tile>) -> Result<Raster> {
    joined_in(tiles, None)
}

/// The cells of a grid that a box touches.
fn cropped(path: &Path, mut raster: Raster, bbox: [f64; 4]) -> Result<Raster> {
    let size = [raster.rows, raster.cols];
    let window = Window::of(path, raster.georeference.as_ref(), size, bbox)?;
    window.cut(&mut raster);
    Ok(window.placed(raster))
}

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

    let [one, two] = [0, 1].map(|first| {
        let mut tiles = vec![tile("a", [0, 0], [2, 2]), tile("b", [0, 1], [2, 2])];
        tiles[1].1.values[0] = 4.0;
        tiles.rotate_left(first);
        joined(tiles).unwrap()
    });
    assert_eq!((one.values[1], two.values[1]), (1.0, 4.0));
    let note =
        "files differ at 1 of 2 overlapping grid points, by up to 3 m: the first file counts";
    assert_eq!((one.notes, two.notes), (vec![note.to_owned()], vec![note.to_owned()]));
}

#[test]
fn texts_name_their_files_unless_they_are_about_all() {
    let mut tiles =
        [("a", [0, 0]), ("b", [0, 2]), ("c", [2, 0])].map(|(n, at)| tile(n, at, [2, 2]));
    for (i, tile) in tiles.iter_mut().enumerate() {
        tile.1.warnings = vec!["all".to_owned(), ["first", "others", "others"][i].to_owned()];
    }
    let field = joined(tiles.into()).unwrap();
    assert_eq!(field.warnings, ["all", "in a: first", "in b, c: others"]);
    // With a box only one file is read, and named.
    let mut tiles = [tile("a", [0, 0], [2, 2]), tile("b", [0, 2], [2, 2])];
    tiles.iter_mut().for_each(|tile| tile.1.warnings = vec!["all".to_owned()]);
    let field = joined_in(tiles.into(), Some([5021.0, 8961.0, 5039.0, 8999.0])).unwrap();
    assert_eq!(field.warnings, ["in b: all"]);
}

#[test]
fn units_that_only_some_files_state_are_warned_about() {
    let of = |units: [Option<f64>; 3], bbox, is_unit_known| {
        let mut tiles =
            [("a", [0, 0]), ("b", [0, 2]), ("c", [2, 0])].map(|(n, at)| tile(n, at, [2, 2]));
        tiles.iter_mut().zip(units).for_each(|(tile, unit)| tile.1.unit_m = unit);
        joined_of(tiles.into(), bbox, is_unit_known).unwrap().warnings
    };
    let warnings = |units, bbox| of(units, bbox, false);
    let mixed = [None, Some(0.3048), None];
    let [warning] = &warnings(mixed, None)[..] else { panic!("one warning") };
    let begin = "in a, c: no known unit of height, so heights are read as metres; those of b are in units of 0.3048 m;";
    assert!(warning.starts_with(begin), "{warning}");
    // A box without the file in feet, and one without the others.
    assert!(warnings(mixed, Some([5001.0, 8921.0, 5009.0, 8999.0])).is_empty());
    assert!(warnings(mixed, Some([5021.0, 8961.0, 5039.0, 8999.0])).is_empty());
    assert!(of(mixed, None, true).is_empty());
    assert!(warnings([None, Some(1.0), None], None).is_empty());
    assert!(warnings([Some(1.0), Some(0.3048), Some(1.0)], None).is_empty());
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
    whole.cell = Cell::Degrees { cell: [0.1, 0.1], latitude: 55.0, is_guess: false };
    let part = cropped(Path::new("a"), whole, [7.0, 50.0, 8.0, 51.0]).unwrap();
    assert!(matches!(part.cell, Cell::Degrees { latitude, .. } if (latitude - 50.5).abs() < 1e-9));
}

/// Every box of cells of tiles that overlap and leave gaps is that box of the whole.
#[test]
fn a_box_of_tiles_is_that_of_the_whole() {
    // Together 7 x 9 grid points, whose corner is at 4980 m east and 9060 m north.
    let tiles = || {
        vec![
            tile("a", [0, 0], [4, 3]),
            tile("b", [-3, -2], [3, 9]),
            tile("c", [1, 3], [3, 4]),
            tile("d", [-1, -1], [2, 3]),
        ]
    };
    let mut boxes = 0;
    for (top, bottom) in (0..7).flat_map(|top| (top + 1..8).map(move |bottom| (top, bottom))) {
        for (left, right) in (0..9).flat_map(|left| (left + 1..10).map(move |right| (left, right)))
        {
            let [west, east] = [(left, 2.0), (right, -2.0)]
                .map(|(col, inwards)| 4980.0 + 10.0 * f64::from(col) + inwards);
            let [north, south] = [(top, -3.0), (bottom, 3.0)]
                .map(|(row, inwards)| 9060.0 - 20.0 * f64::from(row) + inwards);
            let bbox = [west, south, east, north];
            let found = joined_in(tiles(), Some(bbox)).unwrap();
            let expected = cropped(Path::new("all"), joined(tiles()).unwrap(), bbox).unwrap();
            assert_eq!([found.rows, found.cols], [bottom - top, right - left].map(|n| n as usize));
            assert_eq!([found.rows, found.cols], [expected.rows, expected.cols]);
            assert_eq!((found.values, found.voids), (expected.values, expected.voids), "{bbox:?}");
            assert_eq!(found.georeference, expected.georeference, "{bbox:?}");
            boxes += 1;
        }
    }
    assert_eq!(boxes, 28 * 45);
    let beyond = joined_in(tiles(), Some([0.0, 8930.0, 4985.0, 9e5])).unwrap();
    assert!(beyond.notes.iter().any(|note| note.contains("reaches beyond")), "{:?}", beyond.notes);
    let gap = "57.143 % of the box is in no file: voids there";
    assert!(beyond.notes.iter().any(|note| note == gap), "{:?}", beyond.notes);
    let error = joined_in(tiles(), Some([0.0, 0.0, 1.0, 1.0])).err().unwrap().to_string();
    assert!(error.contains("extent is 4980,8920,5070,9060"), "{error}");
}

/// Files outside the box may state any size: only the box must fit the limits.
#[test]
fn headers_outside_the_box_may_state_any_size() {
    let huge = |name: &str| {
        let (path, mut raster) = tile(name, [10, 10], [1, 1]);
        raster.values.clear();
        (raster.rows, raster.cols) = (u32::MAX as usize, u32::MAX as usize);
        (path, raster)
    };
    let bbox = Some([5000.0, 8960.0, 5020.0, 9000.0]);
    let tiles = vec![tile("a", [0, 0], [2, 2]), huge("b"), huge("c")];
    let part = joined_in(tiles, bbox).unwrap();
    assert_eq!((part.rows, part.cols), (2, 2));
    assert_eq!(part.values, tile("a", [0, 0], [2, 2]).1.values);
}

/// A TIFF outside the box may be damaged behind its header, and the whole may be wider than any field.
#[test]
fn files_outside_the_box_are_not_decoded() {
    let folder = tempfile::tempdir().unwrap();
    let heights: Vec<f32> = (0..400).map(|i| ((i * 7919) % 613) as f32).collect();
    let paths = [("a.tif", 0.0), ("b.tif", 200.0), ("far.tif", 700_000.0)].map(|(name, west)| {
        let path = folder.path().join(name);
        let at = Georeference { corner: [west, 200.0], cell: [10.0; 2], keys: crs(32618) };
        let channels = Channels::Scalar("heights", &heights);
        let layers = [Layer { name: String::new(), channels }];
        write_geotiff(&path, [20, 20], &layers, &[], Some(&at), &[]).unwrap();
        path
    });
    let read = |count: usize, bbox| {
        read_mosaic(&paths[..count], &HeightOptions { bbox, ..HeightOptions::default() })
    };
    let of_a = Some([0.0, 0.0, 150.0, 200.0]);
    let whole = read(2, of_a).unwrap();
    assert_eq!([whole.field.rows(), whole.field.cols()], [20, 15]);
    let refused = read(3, None).unwrap_err().to_string();
    assert!(refused.contains("70020 columns") && refused.contains("`bbox` reads"), "{refused}");

    // 400 heights of many values have more than 200 bytes.
    let bytes = std::fs::read(&paths[1]).unwrap();
    std::fs::write(&paths[1], &bytes[..bytes.len() - 200]).unwrap();
    for count in [2, 3] {
        let part = read(count, of_a).unwrap();
        assert_eq!(part.field.heights_m(), whole.field.heights_m());
        assert_eq!(part.georeference, whole.georeference);
    }
    let far = read(3, Some([700_000.0, 0.0, 700_200.0, 200.0])).unwrap();
    assert_eq!(far.georeference.unwrap().corner, [700_000.0, 200.0]);
    for bbox in [None, Some([0.0, 0.0, 250.0, 200.0])] {
        let error = read(2, bbox).unwrap_err().to_string();
        assert!(error.contains("b.tif"), "{error}");
    }
}

/// A tile of degrees, a cell a degree, its heights the longitudes of its columns from 0 to 359.
fn of_longitudes(west: i64, cols: usize) -> Tile {
    let values = (0..2 * cols).map(|i| (west + (i % cols) as i64).rem_euclid(360) as f64).collect();
    let keys = GeoKeys::of_code(4326, true);
    let at = Georeference { corner: [west as f64, 10.0], cell: [1.0; 2], keys };
    let cell = Cell::Degrees { cell: [1.0; 2], latitude: 9.0, is_guess: false };
    let raster = Raster { cell, georeference: Some(at), ..Raster::bare(2, cols, values) };
    (format!("{west}").into(), raster)
}

/// The west of the joined field modulo 360, and the heights of its first row.
fn from_west(raster: &Raster) -> (f64, Vec<f64>) {
    let corner = raster.georeference.as_ref().unwrap().corner;
    (corner[0].rem_euclid(360.0), raster.values[..raster.cols].to_vec())
}

/// Tiles join by their places on the circle in every order, without a gap that another cut avoids. The first tile keeps its place.
#[test]
fn tiles_join_on_the_circle_in_every_order() {
    let longitudes =
        |west: i64, count: i64| (west..west + count).map(|x| (x % 360) as f64).collect();
    for (tiles, west, count) in [
        ([(170, 10), (-180, 10), (-170, 5)], 170, 25),
        // Three on the whole circle: none moves, as no cut is narrower.
        ([(-180, 120), (-60, 120), (60, 120)], 180, 360),
        ([(-10, 10), (0, 10), (10, 10)], 350, 30),
        ([(-180, 91), (90, 90), (1, 89)], 1, 270),
    ] {
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let chosen = order.map(|i| tiles[i]);
            let all = chosen.map(|(west, cols)| of_longitudes(west, cols));
            let raster = joined(all.into()).unwrap();
            let expected: Vec<f64> = longitudes(west, count);
            assert_eq!(from_west(&raster), (west as f64, expected), "{chosen:?}");
            let corner = raster.georeference.unwrap().corner[0];
            let first = chosen[0].0 as f64;
            assert!((corner..corner + count as f64).contains(&first), "{chosen:?}: {corner}");
        }
    }
    // Cells that do not divide the circle, or are wider, stay where they are.
    for (cell, wests) in [(0.7, [-175.0, 175.0]), (40_000.0, [0.0, 4e9])] {
        let odd = wests.map(|west| {
            let (path, mut raster) = of_longitudes(0, 2);
            raster.cell = Cell::Degrees { cell: [cell; 2], latitude: 9.0, is_guess: false };
            let keys = GeoKeys::of_code(4326, true);
            raster.georeference =
                Some(Georeference { corner: [west, 10.0], cell: [cell; 2], keys });
            (path, raster)
        });
        assert!(joined(odd.into()).is_err(), "{cell}");
    }
}

/// A box is found on either side of longitude 180, whichever tile is first.
#[test]
fn boxes_are_found_across_longitude_180() {
    for [first, second] in [[(170, 10), (-180, 10)], [(-180, 10), (170, 10)]] {
        for (west, east) in [(175.0, 185.0), (-185.0, -175.0)] {
            let tiles = [first, second].map(|(west, cols)| of_longitudes(west, cols));
            let raster = joined_in(tiles.into(), Some([west, 8.0, east, 10.0])).unwrap();
            assert!(!raster.voids.as_ref().unwrap().contains(&true), "{first:?} {west}");
            let expected = (175..185).map(f64::from).collect();
            assert_eq!(from_west(&raster), (175.0, expected), "{first:?} {west}");
        }
        let tiles = [first, second].map(|(west, cols)| of_longitudes(west, cols));
        let raster = joined_in(tiles.into(), Some([-180.0, 8.0, -176.0, 10.0])).unwrap();
        assert_eq!(from_west(&raster), (180.0, vec![180.0, 181.0, 182.0, 183.0]), "{first:?}");
    }
}
