//! Ellipses of visible sky: the properties of a search by scores, whichever of equal paths it took.

use glam::{DVec2, DVec3};
use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::VisiblePoints;
use ridgelight_cpu::ellipse_fit::{
    Ellipse, LAST_STEP, SkyDirection, least_radius, moments, neighbours, score, sky_directions,
};
use ridgelight_cpu::tolerance::{ellipse_moment, ellipse_reach, ellipse_start};

use crate::cpu_reference::{Pair, Run, constant, pushed};

const FIRST_ROW: usize = offset("EllipseFitPush", "first_row");
const LEAST_RADIUS: usize = offset("EllipseFitPush", "least_radius");
const ROWS: usize = offset("EllipseFitPush", "rows");

/// Directions that may lie on either side of an ellipse's edge.
fn on_edge(ellipse: &Ellipse, of: &[SkyDirection], reach: f64) -> f64 {
    of.iter().filter(|(e, _)| (ellipse.reach(*e) - 1.0).abs() <= reach).count() as f64
}

/// The amount by which a score falls short of one with a given error.
fn short(got: f64, than: f64, off: f64) -> Pair {
    Pair { got: (than - off - got).max(0.0), want: 0.0, tolerance: 0.0, at: [0; 3] }
}

/// The score is the CPU reference's score of the ellipse. It is no less than at the CPU reference's start, and no less
/// than that of a neighbour one last step away, where the search ended. The axis is one of the moments'. The search
/// decides by whether a direction is inside, so its path cannot be compared as numbers.
pub(crate) fn ellipse_fit(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let (field, border) = (&run.scene.field, run.border());
    let directions = run.directions();
    let is_bent = constant(pass, "bent") == 1;
    let all: Vec<Vec<SkyDirection>> = if is_bent {
        let aimed = super::curved::at_texels(run, pass, directions.count());
        let above = |of: &Vec<(DVec3, f64)>| {
            of.iter().filter(|(e, _)| e.z > 0.0).map(|(e, what)| (*e, *what == 0.0)).collect()
        };
        aimed.iter().map(above).collect()
    } else {
        let words = run.words(pass, "visible_points").expect("bound");
        let points = VisiblePoints::new(field, border, directions, words).expect("all whole");
        (0..field.heights_m().len())
            .map(|at| sky_directions(&points, points.directions().vectors(), at))
            .collect()
    };
    let least = f64::from(f32::from_bits(pushed(pass, LEAST_RADIUS)));
    let [axes, radii] =
        ["ellipse_axes", "ellipse_radii"].map(|n| run.floats(pass, n).expect("written"));
    let [first, end] = [FIRST_ROW, ROWS].map(|o| pushed(pass, o) as usize);
    let [cols, _] = run.size();
    let mut pairs = Vec::new();
    for at in first * cols..end * cols {
        let [axes, radii] =
            [&axes, &radii].map(|all| <[f32; 4]>::try_from(&all[4 * at..4 * at + 4]).expect("4"));
        let found = Ellipse::of_texels(axes, [radii[0], radii[1]]);
        let [got, step] = [radii[2], radii[3]].map(f64::from);
        let mut own = at_texel(&all[at], least, found, (got, step));
        own.iter_mut().for_each(|pair| pair.at = [0, at / cols, at % cols]);
        pairs.extend(own);
    }
    pairs
}

/// The pairs of a texel with these visible directions, this ellipse, this score and last step.
fn at_texel(
    visible: &[SkyDirection],
    least: f64,
    found: Ellipse,
    (got, step): (f64, f64),
) -> Vec<Pair> {
    let lit = visible.iter().filter(|s| s.1).count();
    let same = |got: f64, want: f64, tolerance: f64| Pair { got, want, tolerance, at: [0; 3] };
    let edge = |e: &Ellipse| on_edge(e, visible, ellipse_reach(e));
    let mut pairs = vec![same(got, score(&found, visible) as f64, edge(&found))];
    let is_known = lit == 0 || lit == visible.len();
    if is_known || step == 0.0 {
        let is_whole = if is_known { lit > 0 } else { found.inverse_radii == [0.0; 2] };
        let want = if is_whole { Ellipse::WHOLE } else { Ellipse::EMPTY };
        let numbers =
            |e: &Ellipse| [e.centre.x, e.centre.y, e.inverse_radii[0], e.inverse_radii[1]];
        pairs.extend(numbers(&found).iter().zip(numbers(&want)).map(|(g, w)| same(*g, w, 0.0)));
    }
    if is_known {
        return pairs;
    }
    // In the device's own axis where it has one: any axis is right where the moments are a circle's.
    let (mean, [xx, xy, yy]) = moments(visible);
    let along = |a: DVec2| a.x * a.x * xx + 2.0 * a.x * a.y * xy + a.y * a.y * yy;
    let moment = ellipse_moment(visible.len());
    if step > 0.0 {
        let (a, b) = (found.axis, found.axis.perp());
        let mixed = a.x * b.x * xx + (a.x * b.y + a.y * b.x) * xy + a.y * b.y * yy;
        pairs.push(same(mixed, 0.0, 4.0 * moment + 1e-6));
        pairs.push(same(a.length(), 1.0, moment));
        pairs.push(short(along(a), along(b), 4.0 * moment + 1e-6));
        let radii = [a, b].map(|a| (2.0 * along(a).max(0.0).sqrt()).max(least));
        let begun = Ellipse { centre: mean, axis: a, inverse_radii: radii.map(|r| 1.0 / r) };
        let off = on_edge(&begun, visible, ellipse_start(&begun, visible.len()));
        pairs.push(short(got, score(&begun, visible) as f64, off));
    }
    pairs.push(short(got, (2 * lit) as f64 - visible.len() as f64, 0.0));
    if step > 0.0 && step < LAST_STEP {
        for other in neighbours(&found, LAST_STEP, least) {
            pairs.push(short(got, score(&other, visible) as f64, edge(&other)));
        }
    }
    pairs
}

/// The comparison fails for a turned and a shifted ellipse, and for another score.
#[test]
fn another_ellipse_fails() {
    use ridgelight::scene::Directions;
    use ridgelight_cpu::ellipse_fit::fit;
    let directions = Directions::fibonacci(64, 0.0, 0).expect("directions");
    let lit = |e: &glam::DVec3| e.x > 0.1 && e.y.abs() < 0.7;
    let visible: Vec<SkyDirection> = directions.vectors().iter().map(|e| (*e, lit(e))).collect();
    let (own, score) = fit(&visible);
    let worst = |found: Ellipse, score: f64| {
        let pairs =
            at_texel(&visible, least_radius(visible.len()), found, (score, 0.5 * LAST_STEP));
        pairs.iter().map(Pair::ratio).fold(0.0, f64::max)
    };
    assert!(worst(own, score as f64) <= 1.0);
    assert!(worst(own, score as f64 - 1.0) > 1.0, "a score");
    let turned = Ellipse { axis: DVec2::from_angle(0.1).rotate(own.axis), ..own };
    assert!(worst(turned, score as f64) > 1.0, "an axis");
    let shifted = Ellipse { centre: own.centre + 0.2, ..own };
    let of_shifted = ridgelight_cpu::ellipse_fit::score(&shifted, &visible) as f64;
    assert!(worst(shifted, of_shifted) > 1.0, "no best");
}
