//! The aggregate BRDF of diffuse fields: level ground, grooves with a closed form, energy, reciprocity.

use std::f64::consts::PI;

use glam::DVec3;
use ridgelight::scene::{
    Albedo, Border, Directions, HeightField, Lights, Scene, Surface, VisiblePoint, VisiblePoints,
};
use ridgelight_bake::{Angles, Brdf, ExitRadiance, Facets};
use ridgelight_cpu::facet_mask::facet_mask;
use ridgelight_cpu::light::normal;
use ridgelight_cpu::scatter_gather::expected;
use ridgelight_cpu::visible_points::visible_points;

use crate::v_grooves::{groove_bound, groove_brdf};

const ALBEDO: [f32; 3] = [0.8, 0.5, 0.0];

fn scene(rows: usize, cols: usize, heights: impl Fn(usize, usize) -> f64) -> Scene {
    let all: Vec<f64> = (0..rows * cols).map(|i| heights(i / cols, i % cols)).collect();
    let field = HeightField::new(rows, cols, &all, [1.0; 2], None).expect("a field");
    let albedo = Albedo::Constant(ALBEDO);
    let surface = Surface { border: Border::Periodic, albedo, specular: None };
    Scene { field, surface, lights: Lights::default() }
}

fn facets(scene: &Scene, times: usize, directions: Directions) -> Facets {
    let border = scene.surface.border;
    let finer = scene.field.finer(border, times).expect("a finer field");
    let words = facet_mask(&finer, border, &directions).expect("words");
    Facets::of(scene, times, directions, words).expect("above horizontal")
}

/// For all pairs of directions: `radiance` is that of all triangles under a light of irradiance 1 facing it.
pub fn table(facets: &Facets, radiance: impl Fn(usize) -> ExitRadiance) -> Brdf {
    facets.check().expect("a plane in the aggregate");
    let directions = facets.directions().vectors().to_vec();
    let of = |(light, e): (usize, &DVec3)| {
        let visible = facets.radiance_from_all(&radiance(light));
        visible.into_iter().map(|mean| mean.map(|m| m / e.z)).collect::<Vec<_>>()
    };
    let values = directions.iter().enumerate().flat_map(of).collect();
    Brdf::from_values(directions, values).expect("a table")
}

fn direct(facets: &Facets) -> Brdf {
    table(facets, |light| facets.lit_from(light))
}

fn above(count: usize) -> Directions {
    Directions::fibonacci(count, 0.0, 0).expect("directions")
}

/// Parts of ∫ cos θ dω of evenly spaced directions on the hemisphere.
fn projected_sr(directions: &Directions) -> Vec<f64> {
    let sum: f64 = directions.vectors().iter().map(|v| v.z).sum();
    directions.vectors().iter().map(|v| PI * v.z / sum).collect()
}

/// The BRDF of level ground is ρ/π for all directions of light and view, and its albedo is ρ, to a dozen roundings.
#[test]
fn level_ground_in_the_aggregate_is_lambertian() {
    let scene = scene(3, 4, |_, _| 3.0);
    for times in [1, 2] {
        let facets = facets(&scene, times, above(60));
        let table = direct(&facets);
        for (light, view) in (0..3600).map(|i| (i / 60, i % 60)) {
            for (got, albedo) in table.at(light, view).into_iter().zip(ALBEDO) {
                assert!((got - f64::from(albedo) / PI).abs() < 16.0 * f64::EPSILON, "{got}");
            }
        }
        let weights = projected_sr(facets.directions());
        for (got, albedo) in table.reflected(7, &weights).into_iter().zip(ALBEDO) {
            assert!((got - f64::from(albedo)).abs() < 64.0 * f64::EPSILON, "{got}");
        }
        assert!((0..60).all(|i| (facets.closure(i) - 1.0).abs() < 16.0 * f64::EPSILON));
    }
}

/// Columns of one wall of a groove.
const WALL: usize = 16;

/// Walls at right angles, along the columns.
fn grooves() -> Scene {
    scene(2, 2 * WALL, |_, c| c.abs_diff(WALL) as f64)
}

#[test]
fn grooves_match_their_closed_form() {
    let facets = facets(&grooves(), 1, above(100));
    let table = direct(&facets);
    let vectors = table.directions();
    let (mut worst, mut caught, mut tight) = (0.0_f64, 0, 0);
    for (light, view) in (0..10_000).map(|i| (i / 100, i % 100)) {
        let known = f64::from(ALBEDO[0]) * groove_brdf(vectors[light], vectors[view]);
        let allowed = known * (groove_bound(WALL, vectors[light], vectors[view]) + 1e-6);
        let got = table.at(light, view)[0];
        let off = |got: f64| (got - known).abs() / allowed.max(1e-12);
        worst = worst.max(off(got));
        // A plane that receives the counted cosines of triangles, not cos θ; and one that receives all of the light.
        caught += usize::from(off(got / facets.closure(light)) > 1.0);
        tight += usize::from(off(got * vectors[light].z) > 1.0);
    }
    println!(
        "{worst:.3} of what is allowed; other irradiances are visible in {caught} and {tight}"
    );
    assert!(worst <= 1.0, "{worst}");
    assert!(caught > 100 && tight > 5000, "{caught} {tight}");
    // Light and view are not exchanged: from the east the eastern walls are dark.
    let low = DVec3::new(0.9, 0.3, (1.0_f64 - 0.9).sqrt()).normalize();
    assert!(groove_brdf(low, low) > 2.0 * groove_brdf(low, DVec3::new(-low.x, low.y, low.z)));
}

fn waves() -> Scene {
    scene(8, 8, |r, c| (0.785 * r as f64).sin() + 1.3 * (0.785 * c as f64).cos())
}

/// The most of its incident light that any triangle can reflect into a set of views: Σ w (n·v)⁺ / (π v_z) over
/// the views that see it, each filled as the plane fills it. It does not depend on the light.
fn max_reflectance(scene: &Scene, times: usize, weights: &[f64], facets: &Facets) -> f64 {
    let field = scene.field.finer(Border::Periodic, times).expect("a finer field");
    let (rows, cols) = (field.rows(), field.cols());
    let [x, y] = field.cell_m();
    let h = |r: usize, c: usize| f64::from(field.heights_m()[r % rows * cols + c % cols]);
    let mut most = 0.0_f64;
    for (r, c) in (0..rows * cols).map(|i| (i / cols, i % cols)) {
        let [a, b, d, e] = [h(r, c), h(r, c + 1), h(r + 1, c), h(r + 1, c + 1)];
        for [east, south] in [[b - a, e - b], [e - d, d - a]] {
            let normal = DVec3::new(-east / x, south / y, 1.0).normalize();
            let views = facets.directions().vectors().iter().zip(weights).enumerate();
            let sum =
                views.map(|(i, (v, w))| w * normal.dot(*v).max(0.0) / v.z / facets.closure(i));
            most = most.max(sum.sum::<f64>() / PI);
        }
    }
    most
}

/// The largest reflectance by texels instead of triangles: with the texels' own visibility and smoothed
/// normals, and the plane's share of light.
fn most_of_texels(scene: &Scene, directions: &Directions, weights: &[f64]) -> f64 {
    let field = &scene.field;
    let visible = visible_points(field, Border::Periodic, directions);
    let count = field.heights_m().len();
    let normals: Vec<DVec3> = (0..count)
        .map(|i| normal(field, Border::Periodic, i / field.cols(), i % field.cols()))
        .collect();
    let share = |direction: usize, at: usize| {
        let is_visible = visible[direction * count + at] == VisiblePoint::Sky;
        let towards = normals[at].dot(directions.vectors()[direction]).max(0.0) / normals[at].z;
        if is_visible { towards } else { 0.0 }
    };
    let means: Vec<f64> = (0..directions.count())
        .map(|i| (0..count).map(|at| share(i, at)).sum::<f64>() / count as f64)
        .collect();
    let reflected = (0..directions.count()).map(|light| {
        let of = |view: usize| {
            let both = |at: usize| share(light, at) * share(view, at) * normals[at].z;
            let sum: f64 = (0..count).map(both).sum();
            weights[view] * sum / (count as f64 * PI * means[light] * means[view])
        };
        (0..directions.count()).map(of).sum::<f64>()
    });
    reflected.fold(0.0, f64::max)
}

/// At most the albedo of the incident light leaves, down to two degrees above horizontal, but for the largest
/// sum of cosines of a triangle over these views, which does not depend on the light. Texels in place of
/// triangles exceed that. The BRDF is exactly reciprocal.
#[test]
fn reflected_energy_is_at_most_incident_energy() {
    for (name, scene, times) in [("grooves", grooves(), 1), ("waves", waves(), 2)] {
        let angles = Angles { zeniths: 22, azimuths: 4 };
        let facets = facets(&scene, times, angles.directions().expect("directions"));
        let table = direct(&facets);
        let weights = angles.projected_sr();
        assert!((weights.iter().sum::<f64>() - PI).abs() < 1e-12);
        let most = max_reflectance(&scene, times, &weights, &facets);
        let albedo = f64::from(ALBEDO[0]);
        let reflected: Vec<f64> =
            (0..angles.count()).map(|light| table.reflected(light, &weights)[0]).collect();
        let largest = reflected.iter().copied().fold(0.0, f64::max);
        let closure = (0..angles.count()).map(|i| facets.closure(i));
        let [least, widest] = closure.fold([f64::MAX, 0.0_f64], |[l, m], c| [l.min(c), m.max(c)]);
        println!(
            "{name}: {largest:.4} of {albedo}, at most {most:.4} of it; closure {least:.3} to {widest:.3}"
        );
        assert!(
            largest <= albedo * most * (1.0 + 1e-12) && largest > 0.5 * albedo,
            "{name}: {largest} {most}"
        );
        if name == "grooves" {
            let at_texels = most_of_texels(&scene, facets.directions(), &weights);
            assert!(at_texels > 1.01 * most, "cannot fail: {at_texels} {most}");
        }
        assert!(table.unreciprocal() < 1e-14, "{name}: {}", table.unreciprocal());
    }
}

/// Over 10,000 pairs direct light is reciprocal up to roundings. A table with wrong light intensities fails:
/// the difference is up to the whole value, half of it in the mean.
#[test]
fn brdf_is_reciprocal() {
    let facets = facets(&waves(), 1, above(100));
    let table = direct(&facets);
    assert!(table.unreciprocal() < 1e-14, "{}", table.unreciprocal());
    // Only the irradiance omitted: ½ |l_z - v_z| of values, a sixth in the mean for z uniform from 0 to 1.
    let of_wrong = |light: usize| {
        let z = facets.directions().vectors()[light].z;
        let light = facets.lit_from(light);
        Vec::into(light.alike().iter().map(|l| l.map(|v| v * z)).collect())
    };
    let wrong = self::table(&facets, of_wrong);
    assert!(wrong.unreciprocal() > 0.05, "{}", wrong.unreciprocal());
}

/// For triangles of a white field, each of radiance 1: the shares of their light that leave over some views,
/// directly and by scattering between visible texels. These sums belong to the test alone and run from the last
/// bounce to the first.
struct Shares {
    /// Of each triangle, over π times its projected area.
    of_facets: Vec<f64>,
    /// The largest error of that, as a share of all emitted light.
    off: Vec<f64>,
}

impl Shares {
    fn of(scene: &Scene, points: &VisiblePoints, facets: &Facets, weights: &[f64]) -> Self {
        const BOUNCES: usize = 20;
        let field = &scene.field;
        let grid_points = field.heights_m().len();
        let share = points.directions().share_sr() / PI;
        // gathered[i][j]: the light that texel i reflects where texel j has radiance 1.
        let mut gathered = vec![vec![0.0; grid_points]; grid_points];
        for (i, row) in gathered.iter_mut().enumerate() {
            let n = normal(field, Border::Periodic, i / field.cols(), i % field.cols());
            for (d, e) in points.directions().vectors().iter().enumerate() {
                if let VisiblePoint::GridPoint(j) = points.point(d, i) {
                    row[j] += share * n.dot(*e).max(0.0);
                }
            }
        }
        let count = facets.count();
        let only = |facet: usize| {
            let mut radiance = vec![[0.0; 3]; count];
            radiance[facet] = [1.0; 3];
            radiance
        };
        let visible = |light: &ExitRadiance| -> f64 {
            facets.radiance_from_all(light).iter().zip(weights).map(|(l, w)| w * l[0]).sum()
        };
        let at_texel = |grid_point: usize| {
            let mut grid_points = vec![[0.0; 3]; grid_points];
            grid_points[grid_point] = [1.0; 3];
            let mut light = ExitRadiance::from(vec![[0.0; 3]; count]);
            facets.add_grid_points(&grid_points, &mut light);
            light
        };
        let left: Vec<f64> = (0..grid_points).map(|j| visible(&at_texel(j))).collect();
        let before = |later: &[f64]| -> Vec<f64> {
            let of = |j: usize| (0..grid_points).map(|i| gathered[i][j] * later[i]).sum();
            (0..grid_points).map(of).collect()
        };
        let (mut step, mut scattered) = (left.clone(), vec![0.0; grid_points]);
        for _ in 0..BOUNCES {
            step = before(&step);
            scattered.iter_mut().zip(&step).for_each(|(sum, step)| *sum += step);
        }
        // Walls at right angles: the area is √2 of the plan, counted by triangles and by texels.
        let sent = |of: usize| PI * 2_f64.sqrt() / of as f64;
        let of_others = before(&vec![1.0; grid_points]);
        let unsent: Vec<f64> = of_others
            .iter()
            .zip(&left)
            .map(|(o, l)| (o + l / sent(grid_points) - 1.0).abs())
            .collect();
        // The share that is not sent, at once and in what others gather later.
        let mut later = unsent.clone();
        for _ in 0..2 * BOUNCES {
            later = before(&later).iter().zip(&unsent).map(|(l, u)| l + u).collect();
        }
        let unsent_later = before(&later);
        let most = of_others.iter().copied().fold(0.0, f64::max);
        let each = sent(grid_points) / sent(count);
        let of_facet = |facet: usize| {
            let radiance = only(facet);
            let reflected: Vec<f64> =
                facets.to_grid_points(&radiance).iter().map(|l| f64::from(l[0])).collect();
            let sum = |of: &[f64]| reflected.iter().zip(of).map(|(l, s)| l * s).sum::<f64>();
            let at_once = visible(&ExitRadiance::from(radiance)) / sent(count);
            let all = at_once + sum(&scattered) / sent(count);
            let unsent = (at_once + each * sum(&of_others) - 1.0).abs();
            (all, unsent + each * sum(&unsent_later) + most.powi(BOUNCES as i32))
        };
        let (of_facets, off) = (0..count).map(of_facet).unzip();
        Self { of_facets, off }
    }
}

/// Grooves with white walls, twenty bounces: the light that leaves matches the same sums from the last bounce
/// to the first, but for three roundings of scattered light to f32 and the sums' own, 8 · 2^-24. Nearly all
/// incident light leaves: texels and views gather shares of a texel's light by sums over directions; where
/// these are not complete the rest counts as not sent, in later bounces too, and twenty bounces leave out κ^20,
/// where others gather κ at most. The test needs that to be less than half of the scattered light.
#[test]
fn scattered_light_conserves_energy() {
    const AROUND: usize = 512;
    const VIEWS: usize = 60;
    let mut scene = scene(2, 16, |_, c| c.abs_diff(8) as f64);
    scene.surface.albedo = Albedo::Constant([1.0; 3]);
    let around = Directions::fibonacci(AROUND, -1.0, 0).expect("directions");
    let visible = visible_points(&scene.field, Border::Periodic, &around);
    let points = VisiblePoints::from_points(&scene.field, Border::Periodic, around, &visible);
    let points = points.expect("points");
    let facets = facets(&scene, 3, above(VIEWS));
    let lit = |light: usize, bounces: u32| {
        let mut radiance = facets.lit_from(light);
        let grid_points = facets.to_grid_points(radiance.alike());
        let direct: Vec<_> = grid_points.iter().map(|s| s.map(f64::from)).collect();
        let more = expected(&scene, &points, &direct, bounces);
        let more: Vec<_> = more.iter().map(|s| s.map(|v| v as f32)).collect();
        facets.add_grid_points(&more, &mut radiance);
        radiance
    };
    let table = self::table(&facets, |light| lit(light, 20));
    let weights = projected_sr(facets.directions());
    let leaving = Shares::of(&scene, &points, &facets, &weights);
    let mean = |light: usize, of: &[f64]| {
        let arrives = facets.lit_from(light);
        let all = arrives.alike().iter().zip(of);
        let sums = all.fold([0.0; 2], |[l, a], (e, g)| [l + e[0] * g, a + e[0]]);
        sums[0] / sums[1]
    };
    let largest = |of: &dyn Fn(usize) -> f64| (0..VIEWS).map(of).fold(f64::MIN, f64::max);
    let reflected = |table: &Brdf, light| table.reflected(light, &weights)[0];
    let off = |table: &Brdf| {
        largest(&|light| (reflected(table, light) - mean(light, &leaving.of_facets)).abs())
    };
    let rounded = 8.0 / f64::from(1 << 24);
    let allowed = |light: usize| mean(light, &leaving.off);
    println!(
        "{:.4} to {:.4} of all, within {:.4}; {:e} off the same sums; exchanged {:.4}",
        -largest(&|light| -reflected(&table, light)),
        largest(&|light| reflected(&table, light)),
        largest(&allowed),
        off(&table),
        table.unreciprocal()
    );
    assert!(off(&table) <= rounded, "{}", off(&table));
    let beyond = |light: usize| (reflected(&table, light) - 1.0).abs() - allowed(light);
    assert!(largest(&beyond) <= rounded, "{}", largest(&beyond));
    // Two directions of one path differ by the directions' sums of either, of which only the unsent part does
    // not cancel.
    assert!(table.unreciprocal() <= largest(&allowed), "{}", table.unreciprocal());
    let dark = direct(&facets);
    let scattered = largest(&|light| 1.0 - reflected(&dark, light));
    assert!(largest(&allowed) < 0.5 * scattered, "cannot fail: {scattered}");
    let fewer = self::table(&facets, |light| lit(light, 8));
    assert!(off(&fewer) > rounded && off(&dark) > largest(&allowed), "cannot fail");
}

/// A texture holds the visible shares of a view in the aggregate: shares sum to v_z, and their mean light is
/// that of the triangles.
#[test]
fn textures_hold_the_visible_share() {
    let mut scene = waves();
    let albedo = (0..64).map(|i| [0.1 + 0.01 * i as f32, 0.5, 1.0]).collect();
    scene.surface.albedo = Albedo::Map(albedo);
    for times in [1, 2] {
        let facets = facets(&scene, times, above(20));
        let radiance = facets.lit_from(3);
        for view in 0..20 {
            let texels = facets.texels_from(view, &radiance);
            let whole: f64 = texels.iter().map(|t| t[3]).sum();
            let z = facets.directions().vectors()[view].z;
            assert!((whole / 64.0 - z).abs() < 1e-12, "{view}: {whole} {z}");
            let own = facets.radiance_from(view, &radiance);
            for c in 0..3 {
                let mean = texels.iter().map(|t| t[3] * t[c]).sum::<f64>() / whole;
                assert!((mean - own[c]).abs() < 1e-12, "{view}: {mean} {}", own[c]);
            }
        }
    }
}

/// Level ground with an edge fills as much of a view as its own area does, v_z for each cell: texels inside
/// hold a whole cell, at edges half, at corners a third or, where no diagonal ends, a sixth, as each triangle
/// is split evenly among its corners. Irradiance is the cosine itself, not scaled.
#[test]
fn fields_with_an_edge_hold_parts_of_cells() {
    let mut scene = scene(4, 6, |_, _| 2.0);
    for (border, times) in [(Border::Plane, 1), (Border::Open, 2)] {
        scene.surface.border = border;
        let facets = facets(&scene, times, above(9));
        let radiance = facets.lit_from(3);
        let z = facets.directions().vectors()[3].z;
        let known = f64::from(ALBEDO[0]) / PI * z;
        assert!(radiance.alike().iter().all(|l| (l[0] - known).abs() < 1e-12));
        for (view, e) in facets.directions().vectors().iter().enumerate() {
            let texels = facets.texels_from(view, &radiance);
            for (at, texel) in texels.iter().enumerate() {
                let (row, col) = (at / 6, at % 6);
                let part = match (row == 0 || row == 3, col == 0 || col == 5) {
                    (false, false) => 1.0,
                    (true, true) if (row == 0) == (col == 0) => 1.0 / 3.0,
                    (true, true) => 1.0 / 6.0,
                    _ => 0.5,
                };
                assert!((texel[3] - part * e.z).abs() < 1e-12, "{view}: {row} {col} {}", texel[3]);
                assert!((texel[0] - known).abs() < 1e-12);
            }
            let whole: f64 = texels.iter().map(|t| t[3]).sum();
            assert!((whole - 15.0 * e.z).abs() < 1e-12, "{view}: {whole}");
        }
    }
}

/// A ramp that rises by 10 a cell towards the east and ends shows only back faces to the east: nothing is
/// visible or lit from there, values are 0 and no quotient of zeros.
#[test]
fn back_faces_are_not_counted() {
    let mut scene = scene(4, 4, |_, c| 10.0 * c as f64);
    scene.surface.border = Border::Plane;
    let east = DVec3::new(1.0, 0.0, 1.0).normalize();
    let two = Directions::from_vectors(vec![DVec3::Z, east], 0.0).expect("directions");
    let facets = facets(&scene, 1, two);
    assert_eq!([0, 1].map(|i| facets.shows(i)), [true, false]);
    assert_eq!(facets.closure(1), 0.0);
    let from_above = facets.lit_from(0);
    assert!(from_above.alike().iter().all(|l| l[0] > 0.0));
    assert!(facets.texels_from(1, &from_above).into_iter().flatten().all(|v| v == 0.0));
    assert!(facets.lit_from(1).alike().iter().flatten().all(|v| *v == 0.0));
}

#[test]
fn fields_that_are_no_plane_in_the_aggregate_are_refused() {
    let mut scene = waves();
    let said = |scene: &Scene, directions: Directions| {
        let border = scene.surface.border;
        let words = facet_mask(&scene.field, border, &directions).expect("words");
        let checked = Facets::of(scene, 1, directions, words).and_then(|f| f.check());
        checked.unwrap_err().to_string()
    };
    let below = Directions::fibonacci(8, -1.0, 0).expect("directions");
    assert!(said(&scene, below).contains("above horizontal"));
    // Teeth that rise by 1 a texel for three texels and fall back: from the west, nearly level, the middles of
    // the facing triangles are hidden.
    let low = DVec3::new(-1.0, 0.0, 0.02).normalize();
    let two = Directions::from_vectors(vec![DVec3::Z, low], 0.0).expect("directions");
    assert!(said(&self::scene(4, 8, |_, c| (c % 4) as f64), two).contains("direction 1"));
    scene.surface.border = Border::Plane;
    assert!(said(&scene, above(8)).contains("border: found a field that ends"));
    let words = Facets::of(&scene, 1, above(8), vec![0; 3]).unwrap_err().to_string();
    assert!(words.contains("found 3 words"), "{words}");
    let lost = Facets::of(&scene, 1, above(8), vec![1 << 31; 49]).unwrap_err().to_string();
    assert!(lost.contains("exceeded the step limit"), "{lost}");
}

/// Weights of a grid of angles sum to π. A direction of the grid has one entry, a direction halfway has two
/// halves, and the azimuths are cyclic.
#[test]
fn angles_are_evenly_spaced() {
    let angles = Angles { zeniths: 5, azimuths: 8 };
    let directions = angles.directions().expect("directions");
    for (i, e) in directions.vectors().iter().enumerate() {
        let own: f64 = angles.around(*e).iter().filter(|a| a.0 == i).map(|a| a.1).sum();
        assert!((own - 1.0).abs() < 1e-9, "{i}: {own}");
    }
    let (a, b) = (directions.vectors()[2 * 8], directions.vectors()[2 * 8 + 7]);
    let between = (a + b).normalize();
    let shares = angles.around(
        DVec3::new(between.x, between.y, 0.0).normalize() * a.truncate().length() + DVec3::Z * a.z,
    );
    for i in [16, 23] {
        let own: f64 = shares.iter().filter(|s| s.0 == i).map(|s| s.1).sum();
        assert!((own - 0.5).abs() < 1e-9, "{i}: {own}");
    }
    for (zeniths, azimuths) in [(1, 8), (8, 3), (64, 65)] {
        let said = Angles { zeniths, azimuths }.check().unwrap_err().to_string();
        assert!(said.contains("angles: found"), "{said}");
    }
}
