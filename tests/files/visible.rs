//! Visible points from points and from words, and the field that they belong to.

use ridgelight::scene::{Border, Directions, HeightField, VisiblePoint, VisiblePoints};
use ridgelight_cpu::visible_points::visible_points;

use super::one_sentence;

fn waves(rows: usize, cols: usize, cell: f64) -> HeightField {
    let height = |i: usize| ((i / cols * 3 + i % cols * 5) % 7) as f64;
    let heights: Vec<f64> = (0..rows * cols).map(height).collect();
    HeightField::new(rows, cols, &heights, [cell, 1.0], None).expect("a field")
}

/// A byte an axis and two; with sky and ground among the points.
#[test]
fn visible_points_round_trip() {
    for (rows, cols) in [(5, 7), (2, 256), (1, 1)] {
        let (field, border) = (waves(rows, cols, 1.0), Border::Plane);
        let directions = Directions::fibonacci(9, -1.0, 2).expect("directions");
        let visible = visible_points(&field, border, &directions);
        let texels = rows * cols;
        assert!(visible.contains(&VisiblePoint::Sky) && visible.contains(&VisiblePoint::Ground));
        let of = directions.clone();
        let points = VisiblePoints::from_points(&field, border, of, &visible).unwrap();
        for (i, point) in visible.iter().enumerate() {
            assert_eq!(points.point(i / texels, i % texels), *point);
        }
        let words = points.words().to_vec();
        assert_eq!(VisiblePoints::new(&field, border, directions, words).unwrap(), points);
    }
}

/// The largest field with one byte an axis has a texel (254, 254), which is no marker; neither is the last row or
/// column.
#[test]
fn the_last_texel_of_a_small_field_is_no_void_marker() {
    for side in [255, 256] {
        let field = HeightField::new(side, side, &vec![0.0; side * side], [1.0; 2], None).unwrap();
        let directions = Directions::fibonacci(5, -1.0, 0).expect("directions");
        let kinds = [side * side - 1, side * side - side, side - 1].map(VisiblePoint::GridPoint);
        let kinds = [&kinds[..], &[VisiblePoint::Sky, VisiblePoint::Ground]].concat();
        let visible: Vec<_> = (0..5 * side * side).map(|i| kinds[i % 5]).collect();
        let points = VisiblePoints::from_points(&field, Border::Plane, directions, &visible)
            .expect("points");
        for (i, point) in visible.iter().enumerate() {
            assert_eq!(points.point(i / (side * side), i % (side * side)), *point);
        }
    }
}

#[test]
fn points_of_another_field_are_refused() {
    let (field, border) = (waves(5, 7, 1.0), Border::Open);
    let directions = Directions::fibonacci(4, -1.0, 0).expect("directions");
    let visible = visible_points(&field, border, &directions);
    let points = VisiblePoints::from_points(&field, border, directions, &visible).unwrap();
    let mut heights: Vec<f64> = field.heights_m().iter().map(|h| f64::from(*h)).collect();
    heights[3] += 1.0;
    let raised = HeightField::new(5, 7, &heights, [1.0; 2], None).expect("a field");
    for (other, border) in [
        (&raised, border),
        (&waves(5, 7, 2.0), border),
        (&waves(7, 5, 1.0), border),
        (&field, Border::Periodic),
    ] {
        let said = points.check(other, border).unwrap_err().to_string();
        one_sentence(&said, "visible points");
        assert!(said.contains("hash"), "{said}");
    }
    assert!(points.check(&field, border).is_ok());
}

#[test]
fn malformed_visible_points_are_refused() {
    let field = waves(5, 7, 1.0);
    let directions = Directions::fibonacci(4, -1.0, 0).expect("directions");
    let of = |words: Vec<u32>| {
        VisiblePoints::new(&field, Border::Plane, directions.clone(), words)
            .map_err(|e| e.to_string())
    };
    assert!(of(vec![0xffff_fffe; 70]).is_ok());
    assert!(of(vec![0; 69]).unwrap_err().contains("70 words"));
    // Row 5 of 5; a lost ray in the second of a pair.
    assert!(of(vec![0x0500; 70]).unwrap_err().contains("row 5, column 0"));
    assert!(of(vec![0xfffd_0000; 70]).unwrap_err().contains("direction 1"));
    // Row 256 has the same byte as row 0.
    for outside in [35, 7 * 256, usize::MAX] {
        let mut visible = vec![VisiblePoint::Sky; 4 * 35];
        visible[36] = VisiblePoint::GridPoint(outside);
        let said = VisiblePoints::from_points(&field, Border::Plane, directions.clone(), &visible);
        let said = said.unwrap_err().to_string();
        assert!(said.contains("direction 1, grid point 1"), "{said}");
    }
    let long = waves(1, 65_534, 1.0);
    for said in [
        VisiblePoints::new(&long, Border::Plane, directions.clone(), vec![0; 4 * 65_534]),
        VisiblePoints::from_points(&long, Border::Plane, directions.clone(), &[]),
    ] {
        let said = said.unwrap_err().to_string();
        assert!(said.contains("at most 65533 grid points a side"), "{said}");
    }
}

/// For an odd number of directions the upper half of the last word does not count.
#[test]
fn visible_points_compare_by_visibility() {
    let field = waves(2, 2, 1.0);
    let directions = Directions::fibonacci(5, -1.0, 0).expect("directions");
    let of = |padding: u32| {
        let words = [vec![0; 8], vec![padding << 16 | 0x0101; 4]].concat();
        VisiblePoints::new(&field, Border::Plane, directions.clone(), words).expect("points")
    };
    assert_eq!(of(0xffff), of(0));
    assert_eq!(of(0).point(4, 2), VisiblePoint::GridPoint(3));
}
