//! Ellipses of visible sky, fitted to sets of known shape, and visibility between directions.

use glam::{DVec2, DVec3};
use ridgelight::scene::{Border, Directions, HeightField, VisiblePoints};
use ridgelight_cpu::ellipse_fit::{
    Ellipse, SkyDirection, fit, least_radius, moments, score, start,
};
use ridgelight_cpu::visible_points::visible_points;

const COUNT: usize = 1000;

fn visible(lit: impl Fn(DVec3) -> bool) -> Vec<SkyDirection> {
    let directions = Directions::fibonacci(COUNT, 0.0, 0).expect("directions");
    directions.vectors().iter().map(|e| (*e, lit(*e))).collect()
}

/// Directions that the ellipse classifies wrongly.
fn wrong(ellipse: &Ellipse, visible: &[SkyDirection]) -> usize {
    visible.iter().filter(|(e, is_lit)| ellipse.holds(*e) != *is_lit).count()
}

/// The fitted ellipse matches the given one: its ends along the axes, and every wrong direction, lie within one
/// direction's own radius of it.
fn close(found: &Ellipse, ground_truth: &Ellipse, visible: &[SkyDirection]) {
    let off = least_radius(COUNT);
    assert!((found.centre - ground_truth.centre).length() <= off, "{found:?} {ground_truth:?}");
    for (found, ground_truth) in found.inverse_radii.iter().zip(ground_truth.inverse_radii) {
        assert!((1.0 / found - 1.0 / ground_truth).abs() <= off, "{found} {ground_truth}");
    }
    let grown = |by: f64| Ellipse {
        inverse_radii: ground_truth.inverse_radii.map(|r| 1.0 / (1.0 / r + by)),
        ..*ground_truth
    };
    let near =
        visible.iter().filter(|(e, _)| grown(off).holds(*e) && !grown(-off).holds(*e)).count();
    assert!(wrong(found, visible) <= near, "{} of {near}", wrong(found, visible));
}

/// A pit's centre sees a cone of half-angle a about the zenith: a disc of radius sin a.
#[test]
fn a_pit_is_a_disc() {
    for a in [0.3_f64, 0.8, 1.3] {
        let visible = visible(|e| e.z > a.cos());
        let (found, of) = fit(&visible);
        let ground_truth =
            Ellipse { centre: DVec2::ZERO, axis: DVec2::X, inverse_radii: [1.0 / a.sin(); 2] };
        close(&found, &ground_truth, &visible);
        assert_eq!(of, score(&found, &visible));
    }
}

/// A groove's bottom sees |x| < z tan a between its walls, x across: x² < (1 - x² - y²) tan²a, which is
/// x²/sin²a + y² < 1, an ellipse however steep.
#[test]
fn a_groove_is_an_ellipse() {
    for (a, azimuth) in [(0.3_f64, 0.0_f64), (0.8, 0.7), (1.2, 2.0)] {
        let across = DVec2::from_angle(azimuth);
        let visible = visible(|e| across.dot(e.truncate()).abs() < e.z * a.tan());
        let ground_truth = Ellipse {
            centre: DVec2::ZERO,
            axis: across.perp(),
            inverse_radii: [1.0, 1.0 / a.sin()],
        };
        assert!(wrong(&ground_truth, &visible) <= 1, "one on the edge");
        let (found, _) = fit(&visible);
        close(&found, &ground_truth, &visible);
        assert!(found.axis.dot(across).abs() <= least_radius(COUNT), "{found:?}");
    }
}

/// At the foot of an endless wall half of the disc is lit, which is no ellipse. Its middle is 4/3π away from
/// the wall, its variances are 1/4 - (4/3π)² across and 1/4 along it. The sums' errors are those of the half's
/// edges, √(πN) of N directions long. The search leaves no more wrong directions than before, and still some,
/// in two corners of the half disc.
#[test]
fn a_wall_is_no_ellipse() {
    use std::f64::consts::PI;
    let middle = 4.0 / (3.0 * PI);
    let allowed = 2.0 / (COUNT as f64 * PI).sqrt();
    for azimuth in [0.0, 0.7, 2.0, 4.0] {
        let towards = DVec2::from_angle(azimuth);
        let visible = visible(|e| towards.dot(e.truncate()) < 0.0);
        let (mean, [xx, xy, yy]) = moments(&visible);
        assert!((mean + middle * towards).length() <= allowed, "{mean}");
        let along = |a: DVec2| a.x * a.x * xx + 2.0 * a.x * a.y * xy + a.y * a.y * yy;
        assert!((along(towards) - (0.25 - middle * middle)).abs() <= allowed);
        assert!((along(towards.perp()) - 0.25).abs() <= allowed);
        let begun = start(&visible);
        let (found, _) = fit(&visible);
        let [first, last] = [begun, found].map(|e| wrong(&e, &visible));
        println!("{azimuth}: {first}, then {last} of {COUNT} wrong; {found:?}");
        assert!(0 < last && last <= first, "{first} {last}");
        assert!(found.centre.dot(towards) < 0.0, "{found:?}");
        // A whole or an empty sky has half of it wrong.
        assert!(4 * last < COUNT, "{last}");
    }
}

/// A whole and an empty sky are recognised. Two patches of sky low in the east and in the west are wrong: an
/// ellipse that holds parts of both also holds what lies between them, which is not lit.
#[test]
fn a_whole_and_an_empty_sky_are_exact_ellipses() {
    assert_eq!(fit(&visible(|_| true)), (Ellipse::WHOLE, COUNT as i64));
    assert_eq!(fit(&visible(|_| false)), (Ellipse::EMPTY, 0));
    for e in visible(|_| true) {
        assert!(Ellipse::WHOLE.holds(e.0) && !Ellipse::EMPTY.holds(e.0));
    }
    let two = visible(|e| e.x.abs() > 0.9);
    let (found, _) = fit(&two);
    assert!(wrong(&found, &two) > 0, "{found:?}");
}

/// A light along one of the directions is as visible as that direction; between directions that agree it is as
/// visible as they are. On level ground all light is visible.
#[test]
fn visibility_is_interpolated_between_directions() {
    let heights: Vec<f64> = (0..63).map(|i| if i % 9 == 6 { 5.0 } else { 0.0 }).collect();
    let wall = HeightField::new(7, 9, &heights, [1.0; 2], None).expect("a field");
    let level = HeightField::new(3, 3, &[2.0; 9], [1.0; 2], None).expect("a field");
    let directions = Directions::fibonacci(100, -1.0, 0).expect("directions");
    let triangles = directions.triangles().expect("a net");
    let points = |field: &HeightField| {
        let visible = visible_points(field, Border::Plane, &directions);
        VisiblePoints::from_points(field, Border::Plane, directions.clone(), &visible)
            .expect("points")
    };
    let (of_wall, of_level) = (points(&wall), points(&level));
    let above = Directions::fibonacci(200, 0.0, 1).expect("lights");
    let own = directions.vectors().iter().filter(|e| e.z > 0.0);
    let mut between = 0;
    for light in own.chain(above.vectors()) {
        // Nearly horizontal lights lie among directions below.
        let Some(around) = of_wall.around(&triangles, *light) else {
            assert!(light.z < 0.2, "{light}");
            continue;
        };
        let sum: f64 = around.iter().map(|c| c.1).sum();
        assert!((sum - 1.0).abs() < 1e-12 && around.iter().all(|c| c.1 >= 0.0));
        assert!(
            (ridgelight_cpu::visible_points::lit_share(&of_level, &around, 4) - 1.0).abs() < 1e-12
        );
        for texel in 0..63 {
            let share = ridgelight_cpu::visible_points::lit_share(&of_wall, &around, texel);
            let own = directions.vectors().iter().position(|e| e == light);
            if let Some(own) = own {
                let is_lit = of_wall.point(own, texel) == ridgelight::scene::VisiblePoint::Sky;
                assert!((share - f64::from(u8::from(is_lit))).abs() < 1e-9, "{share}");
            } else if share > 1e-9 && share < 1.0 - 1e-9 {
                between += 1;
            }
        }
    }
    assert!(between > 0, "no penumbra");
}
