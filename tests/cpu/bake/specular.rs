//! The aggregate BRDF of fields with Phong specular: closed forms and bounds.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use ridgelight::scene::{
    Albedo, Border, Directions, HeightField, Lights, PhongSpecular, Scene, Specular, Surface,
};
use ridgelight_bake::{Angles, Brdf, Facets};
use ridgelight_cpu::facet_mask::facet_mask;

use crate::v_grooves::{groove_bound, wall};

fn scene(
    rows: usize,
    cols: usize,
    (albedo, phong_specular): (f32, Specular),
    height: impl Fn(usize) -> f64,
) -> Scene {
    let all: Vec<f64> = (0..rows * cols).map(|i| height(i % cols)).collect();
    let field = HeightField::new(rows, cols, &all, [1.0; 2], None).expect("a field");
    let albedo = Albedo::Constant([albedo; 3]);
    let surface = Surface { border: Border::Periodic, albedo, specular: Some(phong_specular) };
    Scene { field, surface, lights: Lights::default() }
}

fn one(exponent: f32, scale: f32) -> Specular {
    Specular::Constant(PhongSpecular { exponent, scale })
}

fn facets(scene: &Scene, directions: Directions) -> Facets {
    let words = facet_mask(&scene.field, scene.surface.border, &directions).expect("words");
    Facets::of(scene, 1, directions, words).expect("above horizontal")
}

fn table(facets: &Facets) -> Brdf {
    super::facets::table(facets, |light| facets.lit_from(light))
}

/// (n + 1)/2π cosⁿ about the mirror direction of the view.
fn density(n: f64, normal: DVec3, light: DVec3, view: DVec3) -> f64 {
    let mirror = 2.0 * normal.dot(view) * normal - view;
    let along = mirror.dot(light);
    if along > 0.0 { (n + 1.0) / TAU * along.powf(n) } else { 0.0 }
}

/// The BRDF is ρ/π + s p / l_z. p is reciprocal, so f l_z is and f is not; its closed form gives the
/// difference. Tolerance: a dozen roundings, and n times the rounding of the base of a power of n.
#[test]
fn specular_of_level_ground_matches_its_closed_form() {
    for n in [0.0, 1.0, 20.0, 1000.0] {
        let scene = scene(3, 4, (0.3, one(n as f32, 0.6)), |_| 3.0);
        let facets = facets(&scene, Directions::fibonacci(60, 0.0, 0).expect("directions"));
        let table = table(&facets);
        let e = table.directions();
        let [albedo, scale] = [0.3_f32, 0.6].map(f64::from);
        let (mut apart, mut all) = (0.0, 0.0);
        for (l, v) in (0..3600).map(|i| (i / 60, i % 60)) {
            let of = |l: usize, v: usize| {
                albedo / PI + scale * density(n, DVec3::Z, e[l], e[v]) / e[l].z
            };
            let (got, known) = (table.at(l, v)[1], of(l, v));
            assert!(
                (got - known).abs() < (16.0 + 4.0 * n) * f64::EPSILON * known,
                "{n}: {got} {known}"
            );
            apart += 0.25 * (known - of(v, l)).powi(2);
            all += known * known;
            let exchanged = table.at(v, l)[1] - albedo / PI;
            let off = (got - albedo / PI) * e[l].z - exchanged * e[v].z;
            assert!(off.abs() < (16.0 + 4.0 * n) * f64::EPSILON * (n + 1.0), "{n}: {off}");
        }
        let known = f64::sqrt(apart / all);
        println!("{n}: unreciprocal {known:.3}");
        assert!(
            (table.unreciprocal() - known).abs() < 1e-9 && (known > 0.05 || n > 100.0),
            "{n}: {known}"
        );
    }
}

/// Columns of one wall of a groove.
const WALL: usize = 16;

/// For walls at right angles, each a plane: the jointly visible part of a wall, min(u_l, u_v) of half the plan,
/// reflects s p towards a view that it fills t of. Triangles count it as they count diffuse reflection, but
/// with the light that falls on their own plane.
#[test]
fn specular_of_grooves_matches_its_integral() {
    for n in [2.0, 30.0] {
        let scene = scene(2, 2 * WALL, (0.0, one(n as f32, 0.7)), |c| c.abs_diff(WALL) as f64);
        let facets = facets(&scene, Directions::fibonacci(100, 0.0, 0).expect("directions"));
        let table = table(&facets);
        let e = table.directions();
        let (mut worst, mut bright, mut turned) = (0.0_f64, 0, 0);
        for (l, v) in (0..10_000).map(|i| (i / 100, i % 100)) {
            let (light, view) = (e[l], e[v]);
            let of = |view: DVec3, side: f64| {
                let ([u, s], [v, t]) = (wall(light, side), wall(view, side));
                let normal = DVec3::new(side, 0.0, 1.0).normalize();
                let lit = if s > 0.0 { 0.5 * u.min(v) * t } else { 0.0 };
                f64::from(0.7_f32) * density(n, normal, light, view) * lit
            };
            let all = |view: DVec3| (of(view, 1.0) + of(view, -1.0)) / (light.z * view.z);
            let known = all(view);
            let got = table.at(l, v)[0];
            let allowed = known * (groove_bound(WALL, light, view) + 1e-6);
            worst = worst.max((got - known).abs() / allowed.max(1e-12));
            bright += usize::from(known > 0.1);
            turned += usize::from((got - all(DVec3::new(-view.x, view.y, view.z))).abs() > allowed);
        }
        println!("{n}: {worst:.3} of what is allowed");
        assert!(worst <= 1.0, "{n}: {worst}");
        assert!(bright > 100 && turned > 1000, "{n}: {bright} {turned}");
    }
}

/// Under light of 1 from all sides a view receives ρ + s at most, and exactly that from level ground visible from
/// straight above. Sums over steps of h, of a function that changes within 1/(n + 2) radians, err by (n + 2)²
/// h²/24 of it; grooves also by their triangles' share of the view. A light at grazing angles has no such
/// bound: (n + 1)/(n + 2) of s leaves straight up, more than arrives.
#[test]
fn specular_is_bounded_by_the_view() {
    let angles = Angles { zeniths: 12, azimuths: 32 };
    let (weights, last) = (angles.projected_sr(), angles.count() - 1);
    let step: f64 = TAU / 32.0;
    for n in [1.0, 6.0] {
        let phong_specular = || (0.4, one(n as f32, 0.6));
        let allowed = (n + 2.0_f64).powi(2) * step * step / 24.0;
        let level = scene(2, 2, phong_specular(), |_| 0.0);
        let grooves = scene(2, WALL, phong_specular(), |c| c.abs_diff(WALL / 2) as f64);
        for (name, scene) in [("level", level), ("grooves", grooves)] {
            let facets = facets(&scene, angles.directions().expect("directions"));
            let table = table(&facets);
            let least = (0..=last).map(|i| facets.closure(i)).fold(1.0, f64::min);
            let most = (0..=last).map(|v| table.gathered(v, &weights)[0]).fold(0.0, f64::max);
            let reflected = table.reflected(last, &weights)[0];
            println!(
                "{name}, {n}: a view gathers {most:.4} at most, within {:.4}; of the lowest light {reflected:.3} leaves",
                allowed
            );
            assert!(most <= (1.0 + allowed) / least, "{name} {n}: {most}");
            if name == "level" {
                assert!(most >= 1.0 - allowed, "{n}: {most}");
                assert!(reflected > 1.5, "{n}: {reflected}");
                // The highest light is not quite straight above; the centre of its lobe is as far from it.
                let above = table.reflected(0, &weights)[0];
                let known = 0.4 + 0.6 * (n + 1.0) / (n + 2.0);
                let beside = FRAC_PI_2 / 24.0;
                assert!((above - known).abs() < allowed + beside * beside, "{n}: {above} {known}");
            }
        }
    }
}

/// Sums over angles do not converge for a lobe much narrower than the angles' spacing: its peak density counts
/// for the whole part of π of its direction. Level ground with reflectance 0.9 seems to reflect many times
/// that, by exactly the sum of the closed form; tolerance: a dozen roundings, and those of a power.
#[test]
fn sums_over_directions_undersample_narrow_lobes() {
    let (angles, n) = (Angles { zeniths: 8, azimuths: 16 }, 1000.0);
    let level = scene(2, 2, (0.3, one(n as f32, 0.6)), |_| 0.0);
    let facets = facets(&level, angles.directions().expect("directions"));
    let (table, weights) = (table(&facets), angles.projected_sr());
    let e = table.directions();
    let [albedo, scale] = [0.3_f32, 0.6].map(f64::from);
    let mut most = 0.0_f64;
    for (v, view) in e.iter().enumerate() {
        let of = |(l, w): (&DVec3, &f64)| w * density(n, DVec3::Z, *l, *view) / l.z;
        let known = albedo + scale * e.iter().zip(&weights).map(of).sum::<f64>();
        let got = table.gathered(v, &weights)[1];
        assert!(
            (got - known).abs() < (16.0 + 4.0 * n) * f64::EPSILON * known,
            "{v}: {got} {known}"
        );
        most = most.max(got);
    }
    // At the centre (n + 1)/2π s/cos θ times cos θ sin θ π/16 π/8, the lowest view's sin θ nearly 1.
    let middle = scale * (n + 1.0) / TAU * PI / 16.0 * PI / 8.0;
    assert!(most > 0.9 * middle && middle > 7.0, "{most} {middle}");
}

/// Texels with scale 0 do not count for the exponent, except in a triangle with a specular corner: two corners
/// of exponent 1000 and scale 0 beside one of exponent 2 and scale ½ give (2000 + 2)/3 and a sixth; one of 1000
/// and two of 2 a third.
#[test]
fn the_sharpest_exponent_ignores_texels_without_specular() {
    let sharpest = |of: &dyn Fn(usize) -> PhongSpecular| {
        let map = Specular::Map((0..12).map(|i| of(i % 4)).collect());
        facets(
            &scene(3, 4, (0.2, map), |_| 1.0),
            Directions::fibonacci(4, 0.0, 0).expect("directions"),
        )
        .sharpest()
    };
    let [sharp, broad] =
        [[1000.0, 0.0], [2.0, 0.5]].map(|[exponent, scale]| PhongSpecular { exponent, scale });
    assert_eq!(sharpest(&|_| sharp), None);
    assert_eq!(sharpest(&|_| broad), Some(broad));
    let found = sharpest(&|c| if c == 1 { broad } else { sharp }).expect("a lobe");
    let off = [found.exponent - 2002.0 / 3.0, found.scale - 1.0 / 6.0];
    assert!(off[0].abs() < 1e-3 && off[1].abs() < 1e-6, "{found:?}");
}

/// A specular map on level ground: each triangle has the mean of its corners, and the field the mean of its
/// triangles. Diagonals run from the north-west to the south-east.
#[test]
fn specular_maps_are_averaged_over_corners() {
    let phong_maps: Vec<PhongSpecular> = (0..12)
        .map(|i| PhongSpecular { exponent: 3.0 * (i * 5 % 7) as f32, scale: 0.1 * (i % 5) as f32 })
        .collect();
    let of = |r: usize, c: usize| phong_maps[r % 3 * 4 + c % 4];
    let scene = scene(3, 4, (0.2, Specular::Map(phong_maps.clone())), |_| 1.0);
    let facets = facets(&scene, Directions::fibonacci(20, 0.0, 0).expect("directions"));
    let table = table(&facets);
    let e = table.directions();
    for (l, v) in (0..400).map(|i| (i / 20, i % 20)) {
        let mut known = 0.0;
        for (r, c) in (0..12).map(|i| (i / 4, i % 4)) {
            for beside in [of(r, c + 1), of(r + 1, c)] {
                let corners = [of(r, c), beside, of(r + 1, c + 1)];
                let mean = |of: fn(&PhongSpecular) -> f32| {
                    corners.iter().map(|p| f64::from(of(p))).sum::<f64>() / 3.0
                };
                let p = density(mean(|p| p.exponent), DVec3::Z, e[l], e[v]);
                known += mean(|p| p.scale) * p / 24.0;
            }
        }
        let known = f64::from(0.2_f32) / PI + known / e[l].z;
        let got = table.at(l, v)[2];
        assert!((got - known).abs() < 1e-12 * known, "{l} {v}: {got} {known}");
    }
}
