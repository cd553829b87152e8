//! Fields seen from afar.

use std::f64::consts::PI;

use glam::DVec3;
use ridgelight::cpu::scatter_gather::Samples;
use ridgelight::cpu::visible_points::visible_points;
use ridgelight::measure::facets::{FacetHarmonics, Facets, Shown};
use ridgelight::scene::{Albedo, Border, Directions, HeightField, Scene, VisiblePoints};

use crate::under_sky;

const ALBEDO: [f32; 3] = [0.8, 0.5, 0.0];

fn scene(heights: impl Fn(usize, usize) -> f64, side: usize) -> Scene {
    let all: Vec<f64> = (0..side * side).map(|i| heights(i / side, i % side)).collect();
    let field = HeightField::new(side, side, &all, [1.0; 2], None).expect("a field");
    let mut scene = under_sky(field, Border::Periodic, 1.0);
    scene.surface.albedo = Albedo::Constant(ALBEDO);
    scene
}

fn shown(scene: &Scene, directions: Directions) -> VisiblePoints {
    let (field, border) = (&scene.field, scene.surface.border);
    let seen = visible_points(field, border, &directions);
    VisiblePoints::from_points(field, border, directions, &seen).expect("points")
}

/// The level is diffuse from afar as near: ρ/π, and ρ of all light leaves. A constant is in the first band; the millionth
/// that keeps the others down takes as much off it.
#[test]
fn the_level_is_as_diffuse_from_afar() {
    let scene = scene(|_, _| 3.0, 4);
    let points = shown(&scene, Directions::fibonacci(60, 0.0, 0).expect("directions"));
    let shown = Shown::of(&scene, &points).expect("above horizontal");
    let table = Facets::of(&shown, |light| Ok(shown.lit_from(light))).expect("a table");
    for (light, view) in (0..3600).map(|i| (i / 60, i % 60)) {
        for (got, albedo) in table.at(light, view).into_iter().zip(ALBEDO) {
            assert!((got - f64::from(albedo) / PI).abs() < 1e-12, "{got}");
        }
    }
    for (got, albedo) in table.reflected(7).into_iter().zip(ALBEDO) {
        assert!((got - f64::from(albedo)).abs() < 1e-12, "{got}");
    }
    assert!(table.unreciprocal() < 1e-15, "{}", table.unreciprocal());
    for order in 1..=4 {
        let of = FacetHarmonics::of(&table, order).expect("a series");
        assert!(of.residual < 1e-4, "{order}: {}", of.residual);
        let between = DVec3::new(0.48, 0.6, 0.64);
        let got = of.at(between, DVec3::Z)[0];
        assert!((got - f64::from(ALBEDO[0]) / PI).abs() < 1e-3, "{got}");
    }
    for order in [0, 7, 8, usize::MAX] {
        let said = FacetHarmonics::of(&table, order).unwrap_err().to_string();
        assert!(said.contains("from 1 to 6"), "{said}");
    }
}

/// Direct light and masking are the same test from either end: exchanging light and view changes nothing but the order of
/// a sum's roundings. A table of another light is seen to be none. What leaves is no more than the albedo of what arrives,
/// but for what samples fill less of a view than their cells do, and for what a sum over 80 directions errs by, 4.6 / 80^¾ as
/// in the tests of scattered light; finer harmonics leave less.
#[test]
fn direct_light_is_reciprocal() {
    let scene = scene(|r, c| (0.8 * (r as f64)).sin() + 1.3 * (0.785 * c as f64).cos(), 8);
    let points = shown(&scene, Directions::fibonacci(80, 0.0, 0).expect("directions"));
    let shown = Shown::of(&scene, &points).expect("above horizontal");
    let table = Facets::of(&shown, |light| Ok(shown.lit_from(light))).expect("a table");
    assert!(table.unreciprocal() < 1e-14, "{}", table.unreciprocal());
    let brighter = |light: usize| {
        let more = 1.0 + light as f64 / 80.0;
        Ok(shown.lit_from(light).into_iter().map(|l| l.map(|v| v * more)).collect())
    };
    let wrong = Facets::of(&shown, brighter).expect("a table");
    assert!(wrong.unreciprocal() > 0.05, "{}", wrong.unreciprocal());
    let fills = |view: usize| points.directions().vectors()[view].z / shown.mean_share(view);
    let most = (0..80).map(fills).fold(0.0, f64::max) * (1.0 + 4.6 / 80_f64.powf(0.75));
    for light in 0..80 {
        let reflected = table.reflected(light)[0];
        assert!(reflected > 0.2 && reflected <= 0.8 * most, "{light}: {reflected} {most}");
    }
    // Views weighted as they are counted: a sample reflects its albedo of what it is counted to receive, but for how well the
    // directions sum up the cosines about its normal.
    let samples = Samples::of(&scene);
    let vectors = points.directions().vectors();
    let cosines: f64 = vectors.iter().map(|v| v.z).sum();
    let about = |at: usize| {
        vectors.iter().map(|v| samples.normal(at).dot(*v).max(0.0)).sum::<f64>() / cosines
    };
    let sums = (0..64).map(about).fold(0.0, f64::max);
    for light in 0..80 {
        let counted =
            |view: usize| table.at(light, view)[0] * shown.mean_share(view) * PI / cosines;
        let reflected: f64 = (0..80).map(counted).sum();
        assert!(reflected <= 0.8 * sums * (1.0 + 1e-6), "{light}: {reflected} {sums}");
    }
    println!("{sums} of a cosine's sum");
    let left = [2, 3, 4, 5].map(|n| FacetHarmonics::of(&table, n).expect("a series").residual);
    assert!(left.windows(2).all(|two| two[1] < two[0]) && left[3] < 0.3, "{left:?}");
    println!("{left:?} {most}");
}

/// Teeth that rise by 1 a sample to the east for three and fall back: from the west, nearly level, the slopes that face the
/// light are hidden by the teeth before them, and the tops lean away.
#[test]
fn lights_that_reach_no_sample_are_refused() {
    let scene = scene(|_, c| (c % 4) as f64, 8);
    let low = DVec3::new(-1.0, 0.0, 0.02).normalize();
    let directions = Directions::from_vectors(vec![DVec3::Z, low], 0.0).expect("directions");
    let points = shown(&scene, directions);
    let shown = Shown::of(&scene, &points).expect("above horizontal");
    assert!(shown.mean_share(0) > 0.0 && shown.mean_share(1) == 0.0);
    let said = Facets::of(&shown, |light| Ok(shown.lit_from(light))).unwrap_err().to_string();
    assert!(said.contains("direction 1"), "{said}");
}

#[test]
fn views_from_below_are_refused() {
    let scene = scene(|_, _| 0.0, 2);
    let points = shown(&scene, Directions::fibonacci(8, -1.0, 0).expect("directions"));
    let said = Shown::of(&scene, &points).map(|_| ()).unwrap_err().to_string();
    assert!(said.contains("above horizontal"), "{said}");
}
