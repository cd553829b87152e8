//! Bakes for curved base surfaces, against cylinders and spheres of known geometry.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use ridgelight::scene::{
    Border, Curvature, Directions, HeightField, OcclusionChange, VisiblePoint, VisiblePoints,
};
use ridgelight_bake::CurvedEllipses;
use ridgelight_cpu::bent_directions::ways::Ways;
use ridgelight_cpu::bent_directions::{Draped, Fans, bent_direction};
use ridgelight_cpu::ellipse_fit::{Ellipse, SkyDirection, fit, least_radius};
use ridgelight_cpu::fan_weights::weight;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::visible_points::{visible_point, visible_points};

const HALF: usize = 8;

/// Periodic grooves of 45° walls, eight cells deep; their median height is 4.
fn grooves(rows: usize) -> HeightField {
    let height = |i: usize| (i % (2 * HALF)).abs_diff(HALF) as f64;
    let heights: Vec<f64> = (0..rows * 2 * HALF).map(height).collect();
    HeightField::new(rows, 2 * HALF, &heights, [1.0; 2], None).expect("a field")
}

/// Walls one texel wide and eight cells high on level ground, 16 cells apart.
fn walls(rows: usize) -> HeightField {
    let height = |i: usize| if i.is_multiple_of(2 * HALF) { HALF as f64 } else { 0.0 };
    let heights: Vec<f64> = (0..rows * 2 * HALF).map(height).collect();
    HeightField::new(rows, 2 * HALF, &heights, [1.0; 2], None).expect("a field")
}

/// Half the angle of sky at the middle between two [`walls`] on a cylinder: they stand 8 cells of arc away.
fn opening(per_m: f64) -> f64 {
    if per_m == 0.0 {
        return 0.25 * PI;
    }
    let (radius, half) = (1.0 / per_m, HALF as f64);
    let (sin, cos) = (half / radius).sin_cos();
    ((radius + half) * sin).atan2((radius + half) * cos - radius)
}

/// Against positions on a cylinder along north and on a sphere. A height h over the place x along the base of radius R
/// is at ((R + h) sin(x/R), (R + h) cos(x/R) - R). Tolerance: 16 roundings of sums of R, over the distance.
#[test]
fn directions_match_cylinders_and_spheres() {
    let directions = Directions::fibonacci(100, -1.0, 0).expect("directions");
    for radius in [3.0_f64, -8.0, 50.0, -1e4, 1e7] {
        for (own, away) in [(0.0, 1e-3), (0.5, 1.0), (-1.0, 2.0), (1.0, 4.0)] {
            for e in directions.vectors() {
                let (o, height) = (e.truncate() * away, own + e.z * away);
                let allowed = 16.0 * f64::EPSILON * (radius.abs() + 8.0) / away;
                let along = |arc: f64, r: f64| {
                    let (sin, cos) = (arc / r).sin_cos();
                    [(r + height) * sin, (r + height) * cos - r - own]
                };
                let [x, z] = along(o.x, radius);
                let cylinder = DVec3::new(x, o.y, z).normalize();
                let [across, z] = along(o.length(), radius);
                let sphere = (o.normalize() * across).extend(z).normalize();
                for (per_m, want) in [([1.0 / radius, 0.0], cylinder), ([1.0 / radius; 2], sphere)]
                {
                    let got = bent_direction(*e, away, own, Curvature { per_m });
                    assert!(
                        (got - want).length() <= allowed,
                        "{radius} {own} {away} {e}: {got} {want}"
                    );
                }
                let still = bent_direction(*e, away, own, Curvature::FLAT);
                assert_eq!(still, *e);
            }
        }
    }
}

/// The texel of the peak of [`hills`].
fn peak(rows: usize, cols: usize) -> usize {
    rows / 2 * cols + 5 * cols / 8
}

/// Low periodic hills, each with a peak: rays from the peak at a slope of -1/100 travel a hundred cells.
fn hills(rows: usize, cols: usize) -> HeightField {
    let height = |i: usize| {
        let (row, col) = ((i / cols) as f64, (i % cols) as f64);
        let peak = if i == peak(rows, cols) { 0.5 } else { 0.0 };
        let wave = |place: f64, count: usize| 2.0 * PI * place / count as f64;
        0.05 * wave(col, cols).sin() + 0.03 * wave(row, rows).cos() + peak
    };
    let heights: Vec<f64> = (0..rows * cols).map(height).collect();
    HeightField::new(rows, cols, &heights, [1.0, 1.5], None).expect("a field")
}

/// A ray's hit is found in the repetition that it reaches, however many it passes over: within half a cell each
/// way of where the oracle, which follows the surface piece by piece, hits it; or in an earlier one, which the
/// ray clears by less than the tolerance. Some rays of the lists go beyond two repetitions and 128 cells, on
/// wide fields and on lines one or two texels wide.
#[test]
fn repetitions_match_ray_tracing() {
    let (mut met, mut far, mut grazed) = (0, 0, 0);
    for [rows, cols] in [[7, 40], [40, 7], [2, 30], [31, 1]] {
        let (field, border) = (hills(rows, cols), Border::Periodic);
        let oracle = Oracle::new(&field, border);
        let peak = peak(rows, cols);
        let flat = [-0.08, -0.01, -0.004, -0.002, 1e-4, 0.01];
        for (k, z) in (0..100).flat_map(|k| flat.map(|z| (k, z))) {
            let azimuth = 2.0 * PI * (f64::from(k) + 0.3) / 100.0;
            let e = DVec2::from_angle(azimuth).extend(z).normalize();
            let plan = e.truncate().length();
            for here in [peak, (peak + 1) % (rows * cols), 0] {
                let at = [here / cols, here % cols];
                let VisiblePoint::GridPoint(there) = visible_point(&oracle, at, e) else {
                    continue;
                };
                let intervals = oracle.visible_intervals(at[0], at[1], e.y.atan2(e.x));
                let elevation = e.z.atan2(plan);
                let interval = intervals.iter().find(|s| elevation < s.high_rad).expect("met");
                let want = interval.distance_m(elevation);
                let ways = Ways::of((&field, border), Curvature::FLAT, [here, there], e);
                let way = ways.met();
                let found = plan * way.away_m;
                let off = 0.5 * 1.0_f64.hypot(1.5) + 1e-6;
                // Closer to the surface than f32 can resolve.
                if way.over_m > 1e-9 {
                    let (over, graze) = (way.over_m, way.graze_m);
                    assert!(over <= graze, "{rows} {cols} {at:?} {e}: {over} over, {graze} grazes");
                    assert!(found <= want + off, "{rows} {cols} {at:?} {e}: {found} beyond {want}");
                    grazed += 1;
                    continue;
                }
                assert!((found - want).abs() <= off, "{rows} {cols} {at:?} {e}: {found} {want}");
                met += 1;
                far += usize::from(want > 1.5 * 128.0);
            }
        }
    }
    println!("{far} of {met} beyond 128 cells, {grazed} grazed");
    assert!(met > 3000 && far > 100 && 100 * grazed < met, "{far} of {met}, {grazed} grazed");
}

/// On a base that turns by a right angle within the distance, points beyond count as that far, and the search
/// ends there.
#[test]
fn points_turned_away_by_the_base_are_not_moved_nearer() {
    let (field, border) = (hills(7, 40), Border::Periodic);
    let (oracle, peak) = (Oracle::new(&field, border), peak(7, 40));
    let e = DVec3::new(1.0, 0.17, -0.001).normalize();
    let VisiblePoint::GridPoint(there) = visible_point(&oracle, [peak / 40, peak % 40], e) else {
        panic!("it falls")
    };
    let away = |k: f64| {
        let curvature = Curvature { per_m: [k; 2] };
        Ways::of((&field, border), curvature, [peak, there], e).met().away_m
    };
    let flat = away(0.0);
    assert!((150.0..1e4).contains(&flat), "{flat}");
    for k in [1e-4, 0.5 / flat, 1.5 / flat] {
        assert_eq!(away(k), flat, "{k}");
    }
    for k in [2.0 / flat, 0.1, 1.0] {
        assert_eq!(away(k), f64::INFINITY, "{k}");
    }
}

/// Level ground on a flat or a convex base does not see itself. In a concave sphere of radius R a point at distance d
/// rises to an elevation of d/2R: up to the edge of the field it sends the squared sine of that elevation of the
/// ground's light. The first step is visible on the flat ground, too, where half a cell turns it by half as much.
#[test]
fn a_concave_base_sees_its_own_ground() {
    let side = 21;
    let level =
        HeightField::new(side, side, &vec![7.0; side * side], [1.0; 2], None).expect("a field");
    for border in [Border::Plane, Border::Open] {
        assert_eq!(
            Curvature { per_m: [0.05; 2] }.occlusion_change(&level, border),
            OcclusionChange::default()
        );
        for radius in [30.0, 200.0] {
            let hollow = Curvature { per_m: [-1.0 / radius; 2] };
            let mut sum = 0.0;
            for at in 0..side * side {
                for k in 0..16 {
                    let o = DVec2::from_angle(2.0 * PI * (k as f64 + 0.5) / 16.0);
                    let (x, y) = ((at % side) as f64, (at / side) as f64);
                    let last = (side - 1) as f64;
                    let upto = |place: f64, pace: f64| {
                        if pace > 0.0 { (last - place) / pace } else { -place / pace }
                    };
                    let steps = upto(x, o.x).min(upto(y, -o.y)).floor();
                    let sine = |steps: f64| (0.5 * steps / radius).sin();
                    let half_cell = 0.5 * (o.x.abs() + o.y.abs());
                    let moved = 0.5 * half_cell / radius * (0.5 / radius).cos();
                    sum += match steps {
                        0.0 => 0.0,
                        _ => (sine(steps) + moved).powi(2) - sine(1.0).powi(2),
                    };
                }
            }
            let want = sum / (16 * side * side) as f64;
            let found = hollow.occlusion_change(&level, border).light;
            assert!((found - want).abs() <= 1e-9 * want, "{border:?} {radius}: {found} {want}");
        }
    }
}

/// Beyond the limit the message names the limit; at the limit the curvature is accepted.
#[test]
fn strong_curvatures_are_refused_by_name() {
    let field = grooves(16);
    let said = |x: f64, y: f64| {
        Curvature { per_m: [x, y] }.check(&field, Border::Periodic).err().map(|e| e.to_string())
    };
    assert_eq!(said(0.001, 0.0), None);
    assert_eq!(said(0.0, 0.0), None);
    let near = said(-0.2, 0.0).expect("the ridges are 4 over a base of radius 5");
    assert!(near.contains("curvature of the base") && near.contains("0.20 of its width"), "{near}");
    let strong = said(-0.1, -0.1).expect("a hollow");
    let limit = strong.split("at most ").nth(1).and_then(|t| t.split(' ').next()).expect("a limit");
    let limit: f64 = limit.parse().expect("a number");
    assert!((-0.1..0.0).contains(&limit), "{strong}");
    let changed =
        |k: f64| Curvature { per_m: [k; 2] }.occlusion_change(&field, Border::Periodic).light;
    // The limit is printed with four figures and found to 1/256.
    assert!(changed(0.99 * limit - 1e-4) <= 1.02 * Curvature::MAX_CHANGE, "{strong}");
    assert!(changed(1.01 * limit - 5e-4) > Curvature::MAX_CHANGE, "{strong}");
    assert!(said(f64::NAN, 0.0).is_some_and(|e| e.contains("two numbers")));
}

/// Grooves along the rows are the same with fewer and with more rows, and so is the effect of curvature.
/// Periodic level ground has no relief besides the base's own shape: only the next cell counts, which turns by
/// half a cell, in tiles of any side.
#[test]
fn curvature_does_not_change_the_tile() {
    for k in [-0.08, 0.1] {
        let of = |rows| {
            Curvature { per_m: [k, 0.0] }.occlusion_change(&grooves(rows), Border::Periodic).light
        };
        let many = of(32);
        assert!(many > 0.005, "{k}: {many}");
        for rows in [2, 16] {
            assert!((of(rows) - many).abs() <= 1e-9, "{k}, {rows} rows: {} {many}", of(rows));
        }
    }
    let radius = 30.0_f64;
    let along = |k: usize| {
        let o = DVec2::from_angle(2.0 * PI * (k as f64 + 0.5) / 16.0);
        let (sine, half_cell) = ((0.5 / radius).sin(), 0.5 * (o.x.abs() + o.y.abs()));
        let moved = 0.5 * half_cell / radius * (0.5 / radius).cos();
        (sine + moved).powi(2) - sine.powi(2)
    };
    let want = (0..16).map(along).sum::<f64>() / 16.0;
    for side in [4, 8, 16] {
        let level = HeightField::new(side, side, &vec![7.0; side * side], [1.0; 2], None);
        let level = level.expect("a field");
        let hollow = Curvature { per_m: [-1.0 / radius; 2] };
        let found = hollow.check(&level, Border::Periodic).expect("nothing hidden").light;
        assert!((found - want).abs() <= 1e-9 * want, "{side}: {found} {want}");
    }
}

/// By the weights, the middle between two walls of equal radiance receives the light of its hemisphere less a
/// lune of twice the opening, π (1 - sin a). The silhouette is two half circles of length π, whose mean height
/// is 2/π cos a; on each side directions stand for what lies within about a quarter of their spacing √(4π/N).
/// Without weights the light is that of other walls. On the flat base each weight is 1.
#[test]
fn fan_weights_are_solid_angles_between_curved_walls() {
    let (field, count) = (walls(2), 2048);
    let directions = Directions::fibonacci(count, -1.0, 0).expect("directions");
    let net = directions.triangles().expect("a net");
    let fans = Fans::of(&net, directions.vectors());
    let border = Border::Periodic;
    let visible = visible_points(&field, border, &directions);
    let share = directions.share_sr();
    let points = VisiblePoints::from_points(&field, border, directions, &visible).expect("points");
    for per_m in [0.0, 0.05, 0.02, -0.02, -0.05] {
        let curvature = Curvature { per_m: [per_m, 0.0] };
        let draped = Draped { field: &field, border, points: &points, fans: &fans, curvature };
        let bent = draped.bent(HALF);
        let sees = |i: &usize| points.point(*i, HALF) != VisiblePoint::Sky;
        let of = |weigh: bool| -> f64 {
            let light = |i: usize| {
                let weight = if weigh { weight(&fans, &bent, i) } else { 1.0 };
                share * weight * bent[i].z.max(0.0)
            };
            (0..count).filter(sees).map(light).sum()
        };
        let want = PI * (1.0 - opening(per_m).sin());
        let allowed = 4.0 * opening(per_m).cos() * (4.0 * PI / count as f64).sqrt() / 4.0;
        let (got, unweighed) = (of(true), of(false));
        println!("{per_m}: {got} of {want}, within {allowed}; without weights {unweighed}");
        assert!((got - want).abs() <= allowed, "{per_m}: {got} {want}");
        if per_m == 0.05 || per_m == -0.05 {
            assert!((unweighed - want).abs() > allowed, "{per_m}: without weights would do");
        }
        if per_m == 0.0 {
            assert!((0..count).all(|i| (weight(&fans, &bent, i) - 1.0).abs() < 1e-9));
        }
    }
}

/// A periodic field with more rows or columns than a base may turn by is the same surface; a field that is not
/// periodic is refused.
#[test]
fn long_tiles_are_the_same_surface() {
    let height = |i: usize| if i.is_multiple_of(8) { 0.1 } else { 0.0 };
    let curvature = Curvature { per_m: [0.0, 0.05] };
    let of = |rows: usize, border| {
        let heights: Vec<f64> = (0..2 * rows).map(|i| height(i / 2)).collect();
        let field = HeightField::new(rows, 2, &heights, [1.0; 2], None).expect("a field");
        curvature.check(&field, border)
    };
    let short = of(8, Border::Periodic).expect("low steps");
    let long = of(16 * 8, Border::Periodic).expect("the same steps");
    let [shadows, light] = [short.shadows - long.shadows, short.light - long.light];
    assert!(shadows.abs() <= 1e-9 && light.abs() <= 1e-9, "{short:?} {long:?}");
    let across = of(16 * 8, Border::Open).expect_err("a turn of 6.4").to_string();
    assert!(across.contains("6.40 radians") && across.contains("half a circle"), "{across}");
}

/// On the flat base the lighting is unchanged, whichever of two triangles has an edge.
#[test]
fn a_flat_base_changes_nothing() {
    let field = grooves(2);
    let directions = Directions::fibonacci(200, -1.0, 0).expect("directions");
    let net = directions.triangles().expect("a net");
    let fans = Fans::of(&net, directions.vectors());
    let visible = visible_points(&field, Border::Periodic, &directions);
    let points =
        VisiblePoints::from_points(&field, Border::Periodic, directions, &visible).expect("points");
    let draped = Draped {
        field: &field,
        border: Border::Periodic,
        points: &points,
        fans: &fans,
        curvature: Curvature::FLAT,
    };
    for at in 0..2 * HALF {
        let bent = draped.bent(at);
        assert_eq!(bent, points.directions().vectors());
        for light in Directions::fibonacci(60, 0.0, 1).expect("lights").vectors() {
            let before = points
                .around(&net, *light)
                .map(|around| ridgelight_cpu::visible_points::lit_share(&points, &around, at));
            let now = draped.lit_share(&net, &bent, at, *light);
            match (before, now) {
                (Some(before), Some(now)) => {
                    assert!((before - now).abs() < 1e-9, "{light}: {before} {now}")
                }
                (None, None) => {}
                other => panic!("{light}: {other:?}"),
            }
        }
    }
}

fn visible(lit: impl Fn(DVec3) -> bool) -> Vec<SkyDirection> {
    let directions = Directions::fibonacci(1000, 0.0, 0).expect("directions");
    directions.vectors().iter().map(|e| (*e, lit(*e))).collect()
}

/// The middle between walls sees |x| < z tan a: an ellipse with half axes sin a and 1, on every base. Between
/// five fitted curvatures the half axis errs by the fit's own error and by the curve of sin a in between.
#[test]
fn ellipses_widen_and_narrow_with_curvature() {
    let step = 0.02;
    let fitted = |k: f64| fit(&visible(|e| e.x.abs() < e.z * opening(k).tan())).0;
    let five = [fitted(0.0), fitted(step), fitted(-step), fitted(0.0), fitted(0.0)];
    let between = CurvedEllipses::of(&five, [step; 2]);
    for k in [-0.02, -0.013, -0.005, 0.0, 0.004, 0.01, 0.02] {
        let [x, y, across, along, mixed] = between.at(Curvature { per_m: [k, 0.03] });
        let want = opening(k).sin();
        let end = opening(step.copysign(k)).sin();
        let straight =
            (want - (opening(0.0).sin() + k.abs() / step * (end - opening(0.0).sin()))).abs();
        let off = least_radius(1000) + straight;
        assert!((across - want).abs() <= off, "{k}: {across} {want} {off}");
        assert!(along > 0.9 && mixed.abs() <= off && DVec2::new(x, y).length() <= off, "{k}");
    }
    let wide = between.at(Curvature { per_m: [step, 0.0] })[2]
        - between.at(Curvature { per_m: [-step, 0.0] })[2];
    assert!(wide > 2.0 * least_radius(1000), "nothing opens: {wide}");
}

/// On the flat base the test is that of its own ellipse. A whole and an empty sky stay so; between an empty sky
/// and a patch lies a smaller patch about the same middle.
#[test]
fn a_flat_base_changes_no_ellipse() {
    let patch = Ellipse {
        centre: DVec2::new(0.3, -0.1),
        axis: DVec2::from_angle(0.7),
        inverse_radii: [2.0, 5.0],
    };
    let lights = visible(|_| true);
    for own in [patch, Ellipse::WHOLE, Ellipse::EMPTY] {
        let between =
            CurvedEllipses::of(&[own, patch, Ellipse::EMPTY, Ellipse::WHOLE, patch], [0.1, 0.2]);
        for (light, _) in lights.iter().filter(|l| (own.reach(l.0) - 1.0).abs() > 1e-9) {
            assert_eq!(
                between.holds(Curvature::FLAT, *light),
                own.holds(*light),
                "{own:?} {light}"
            );
        }
    }
    let between = CurvedEllipses::of(&[Ellipse::EMPTY, patch, patch, patch, patch], [0.1, 0.2]);
    let half = Ellipse { inverse_radii: [4.0, 10.0], ..patch };
    for (light, _) in lights.iter().filter(|l| (half.reach(l.0) - 1.0).abs() > 1e-9) {
        for per_m in [[0.05, 0.0], [0.0, -0.1]] {
            let now = between.holds(Curvature { per_m }, *light);
            assert_eq!(now, half.holds(*light), "{per_m:?} {light}");
        }
    }
}
