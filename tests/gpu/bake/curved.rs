//! Walls on curved bases with known openings: scattered light, ellipses of sky, and views.

use std::f64::consts::PI;

use ridgelight::plan;
use ridgelight::scene::{
    Albedo, Border, Curvature, Directions, HeightField, Scatter, VisiblePoints,
};
use ridgelight_bake::{CurvedEllipses, Ellipse};
use ridgelight_cpu::ellipse_fit::least_radius;

use crate::{Device, field, under_sky};

const HALF: usize = 8;
const BORDER: Border = Border::Periodic;

/// Walls one texel wide and eight cells high on level ground, 16 cells apart.
fn walls() -> HeightField {
    field(2, 2 * HALF, [1.0; 2], |_, c| if c == 0 { HALF as f64 } else { 0.0 })
}

/// Half the angle of sky at the middle between two walls, whose tops stand 8 cells of arc away and 8 over the base: at
/// ((R + 8) sin(8/R), (R + 8) cos(8/R) - R).
fn opening(per_m: f64) -> f64 {
    let half = HALF as f64;
    if per_m == 0.0 {
        return 0.25 * PI;
    }
    let (radius, (sin, cos)) = (1.0 / per_m, (half * per_m).sin_cos());
    ((radius + half) * sin).atan2((radius + half) * cos - radius)
}

/// Walls of equal radiance light the middle but for a lune of twice the opening: 1 - sin a of the light of a
/// hemisphere. The silhouette is two half circles, whose mean height is 2/π cos a; on each side directions stand for
/// what lies within about a quarter of their spacing √(4π/N). The light of the flat field differs from that of the
/// curved ones.
#[test]
fn walls_scatter_as_far_as_the_base_opens_them() {
    const COUNT: usize = 2048;
    let mut device = Device::new();
    let mut scene = under_sky(walls(), BORDER);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    let directions = Directions::fibonacci(COUNT, -1.0, 0).expect("directions");
    let plan = plan::visible_points(&scene.field, BORDER, &directions, &device.limits());
    let visible = device.draw(plan.expect("a plan"), &[scene.field.heights_m()]);
    let words = visible.iter().flat_map(|image| image.values.iter().map(|v| v.to_bits())).collect();
    let points = VisiblePoints::new(&scene.field, BORDER, directions, words).expect("points");
    let direct = vec![[0.5; 3]; 4 * HALF];
    let share = |per_m: f64| 1.0 - opening(per_m).sin();
    for per_m in [0.0, 0.03, -0.02] {
        let curvature = Curvature { per_m: [per_m, 0.0] };
        let paths = COUNT as u32;
        let scatter = Scatter { bounces: 1, paths, curvature, ..Scatter::default() };
        let plan = plan::scatter(&scene, points.directions(), &scatter, &device.report().limits);
        let plan = plan.expect("a plan");
        let contents = plan::scatter_inputs(&plan, &scene, &points, &direct).expect("inputs");
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        let got = f64::from(device.draw(plan, &contents).remove(0).values[4 * HALF]);
        let want = 0.25 * share(per_m);
        let rim = 4.0 * opening(per_m).cos() / PI;
        let allowed = 0.25 * rim * (4.0 * PI / COUNT as f64).sqrt() / 4.0;
        println!("{per_m}: {got} of {want}, within {allowed}");
        assert!((got - want).abs() <= allowed, "{per_m}: {got} {want} {allowed}");
        let flat = 0.25 * share(0.0);
        assert!(
            per_m == 0.0 || (flat - want).abs() > allowed,
            "{per_m}: the flat field's would do"
        );
    }
}

/// The middle sees |x| < z tan a: an ellipse of half axes sin a and 1. It is visible from any view within and from
/// none without, but for views nearer to its edge than a direction's own radius plus the error of linear interpolation
/// of sin a between five bases; likewise for lights.
#[test]
fn views_between_walls_are_those_of_the_opening() {
    const COUNT: usize = 1024;
    let mut device = Device::new();
    let walls = walls();
    let directions = Directions::fibonacci(COUNT, -1.0, 0).expect("directions");
    let steps = [0.03, 0.015];
    let plan = plan::curved_ellipses(&walls, BORDER, &directions, steps, &device.report().limits);
    let images = device.draw(plan.expect("a plan"), &[walls.heights_m()]);
    let texel = |image: usize| <[f32; 4]>::try_from(&images[image].values[4 * HALF..4 * HALF + 4]);
    let five: [Ellipse; 5] = std::array::from_fn(|k| {
        let [axes, radii] = [2 * k, 2 * k + 1].map(|image| texel(image).expect("four"));
        Ellipse::of_texels(axes, [radii[0], radii[1]])
    });
    let between = CurvedEllipses::of(&five, steps);
    let views = Directions::fibonacci(1000, 0.0, 5).expect("views");
    for per_m in [0.03_f64, 0.02, 0.01, 0.0, -0.0075, -0.015] {
        let side = usize::from(per_m < 0.0);
        let end = opening([steps[0], -steps[1]][side]).sin();
        let line = opening(0.0).sin() + per_m.abs() / steps[side] * (end - opening(0.0).sin());
        let half = opening(per_m).sin();
        let off = 2.0 * least_radius(COUNT / 2) + (line - half).abs();
        let curvature = Curvature { per_m: [per_m, 0.0] };
        let (mut held, mut out, mut near) = (0, 0, 0);
        for v in views.vectors() {
            let reach = |by: f64| (v.x / (half + by)).powi(2) + (v.y / (1.0 + by)).powi(2);
            let is_visible = between.holds(curvature, *v);
            if reach(-off) <= 1.0 {
                held += 1;
                assert!(is_visible, "{per_m}: {v} is hidden");
            } else if reach(off) > 1.0 {
                out += 1;
                assert!(!is_visible, "{per_m}: {v} is visible");
            } else {
                near += 1;
            }
        }
        println!("{per_m}: {held} within, {out} without, {near} near the edge");
        assert!(held > 200 && out > 50, "{per_m}: {held} {out} {near}");
    }
}

/// Plans state the effect of curvature with the checked numbers.
#[test]
fn plans_state_the_effect_of_curvature() {
    let limits = plan::Limits::lavapipe();
    let grooves = field(2 * HALF, 2 * HALF, [1.0; 2], |_, c| c.abs_diff(HALF) as f64);
    let mut scene = under_sky(grooves, BORDER);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    let directions = Directions::fibonacci(64, -1.0, 0).expect("directions");
    let curvature = Curvature { per_m: [-0.01, 0.0] };
    let changed = curvature.check(&scene.field, BORDER).expect("a shallow hollow");
    assert!(changed.light > 0.0 && changed.shadows > 0.0);
    // For an albedo of a half, up to three times: 1/2 + 2/4 + 3/8.
    let off = 1.375 * changed.light;
    assert!((changed.scattered(0.5, 3) - off).abs() < 1e-12);
    let scatter = Scatter { curvature, cutoff: 0.0, ..Scatter::default() };
    let plan = plan::scatter(&scene, &directions, &scatter, &limits).expect("a plan");
    let said = format!("the base {changed}: error of scattered light about {off:.4} or less of");
    assert!(plan.notes.iter().any(|note| note.starts_with(&said)), "{said}: {:?}", plan.notes);
    let plan = plan::curved_ellipses(&scene.field, BORDER, &directions, [0.02, 0.01], &limits);
    let said = format!("the base bent east -: {changed}");
    assert!(plan.expect("a plan").notes.contains(&said), "{said}");
}

/// Wrong curvatures are refused by name, before anything is made.
#[test]
fn wrong_curvatures_are_refused_by_name() {
    let limits = plan::Limits::lavapipe();
    let grooves = field(2 * HALF, 2 * HALF, [1.0; 2], |_, c| c.abs_diff(HALF) as f64);
    let scene = under_sky(grooves, BORDER);
    let directions = Directions::fibonacci(64, -1.0, 0).expect("directions");
    let scattered = |per_m: [f64; 2]| {
        let scatter = Scatter { curvature: Curvature { per_m }, ..Scatter::default() };
        plan::scatter(&scene, &directions, &scatter, &limits).err().map(|e| e.to_string())
    };
    assert_eq!(scattered([0.01, 0.0]), None);
    let said = scattered([-0.3, 0.0]).expect("ridges beyond the middle of the hollow");
    assert!(said.contains("curvature of the base"), "{said}");
    let said = scattered([-0.1, -0.1]).expect("a hollow as narrow as the grooves");
    assert!(said.contains("curvature of the base") && said.contains("1/m"), "{said}");
    let fitted = |steps| {
        let plan = plan::curved_ellipses(&scene.field, BORDER, &directions, steps, &limits);
        plan.err().map(|e| e.to_string())
    };
    for steps in [[0.0, 0.01], [0.01, -0.01], [f64::NAN, 0.01]] {
        assert!(fitted(steps).is_some_and(|said| said.contains("curvatures of ellipses")));
    }
    assert!(fitted([1e-3, 0.2]).is_some_and(|said| said.contains("curvature of the base")));
    let mut shiny = scene.clone();
    shiny.surface.albedo = Albedo::Constant([0.8; 3]);
    shiny.surface.specular =
        Some(ridgelight::scene::Specular::Constant(ridgelight::scene::PhongSpecular {
            exponent: 5.0,
            scale: 0.1,
        }));
    let scatter = Scatter { curvature: Curvature { per_m: [1e-3, 0.0] }, ..Scatter::default() };
    let said = plan::scatter(&shiny, &directions, &scatter, &limits).unwrap_err().to_string();
    assert!(said.contains("specular") && said.contains("diffuse"), "{said}");
    // More directions than an image has layers.
    let few = plan::Limits { image_layers: 63, ..limits };
    let plan = plan::curved_ellipses(&scene.field, BORDER, &directions, [1e-3; 2], &few);
    let said = plan.unwrap_err().to_string();
    assert!(said.contains("64 layers") && said.contains("63"), "{said}");
}
