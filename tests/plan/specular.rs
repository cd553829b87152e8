//! Passes and memory of bounced Phong specular; passes of its tables.

use ridgelight::plan::{self, Limits, Picture, Plan, missing_barriers};
use ridgelight::scene::fractal;
use ridgelight::scene::{
    Albedo, Basis, Border, BounceEngine, BounceSpecular, Bounces, Environment, HeightField, Lights,
    PhongSpecular, Quality, Scene, Specular, Surface,
};

const SIDE: usize = 128;

/// A grey surface with specular under a sky.
fn grey() -> Scene {
    let surface = Surface {
        albedo: Albedo::Constant([0.3; 3]),
        border: Border::Plane,
        specular: Some(Specular::Constant(PhongSpecular { exponent: 5.0, scale: 0.5 })),
    };
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    Scene { field: fractal(SIDE, 1).expect("a field"), surface, lights }
}

/// Two bounces on that surface.
fn planned(specular: BounceSpecular, sh_order: u32) -> Plan {
    let scene = grey();
    let engine = BounceEngine::Pyramid;
    let bounces = Bounces { count: 2, engine, cutoff: 0.0, specular, ..Bounces::default() };
    let quality =
        Quality { azimuths: 8, basis: Basis::Sh, sh_order, bounces, ..Quality::default() };
    let wanted = Picture { light_layers: true, ..Picture::default() };
    plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).expect("a plan")
}

/// One number per texel holds light towards the zenith only, so it is refused with an eye. Accepted are series by direction, and one
/// number without an eye, without bounces or without specular.
#[test]
fn light_towards_the_zenith_is_no_view_from_an_eye() {
    let scene = grey();
    let mut diffuse = scene.clone();
    diffuse.surface.specular = None;
    let planned = |scene: &Scene, specular, count, eye_m| {
        let bounces = Bounces { count, specular, ..Bounces::default() };
        let quality = Quality { azimuths: 8, bounces, ..Quality::default() };
        let wanted = Picture { eye_m, ..Picture::default() };
        plan::picture(scene, &quality, &Limits::lavapipe(), wanted)
    };
    let eye_m = Some([1.0, 2.0, 1e3]);
    use BounceSpecular::{Scalar, Vector, VectorF16};
    let refused = planned(&scene, Scalar, 1, eye_m).expect_err("towards the zenith").to_string();
    assert!(refused.contains("`bounce_specular`") && refused.contains("vector-f16"), "{refused}");
    for (scene, specular, count, eye_m) in [
        (&scene, Vector, 1, eye_m),
        (&scene, VectorF16, 1, eye_m),
        (&scene, Scalar, 1, None),
        (&scene, Scalar, 0, eye_m),
        (&diffuse, Scalar, 1, eye_m),
    ] {
        planned(scene, specular, count, eye_m).expect("a plan");
    }
}

fn bytes(plan: &Plan, names: &[&str]) -> u64 {
    let all = plan.resources.iter().filter(|r| names.contains(&r.name.as_str()));
    all.map(plan::Resource::bytes).sum()
}

/// Arriving light is reflected once a bounce; the last bounce is only gathered. Without vectors no direct light
/// is needed as a series.
#[test]
fn each_bounce_is_computed_once() {
    let has = |plan: &Plan, label: &str| plan.passes.iter().any(|p| p.label() == label);
    for specular in [BounceSpecular::Vector, BounceSpecular::VectorF16, BounceSpecular::Scalar] {
        let plan = planned(specular, 4);
        let is_vector = specular != BounceSpecular::Scalar;
        for label in [
            "specular_exit direct",
            "specular_exit bounce1",
            "specular_exit bounce2",
            "light_resolve bounces specular",
        ] {
            assert!(has(&plan, label), "{label}");
        }
        assert_eq!(has(&plan, "specular_visibility"), is_vector);
        assert_eq!(has(&plan, "vector_reduce bounce1 levels 1 to 4"), is_vector);
        assert_eq!(has(&plan, "shade_reduce bounce2 levels 1 to 4"), !is_vector);
        assert!(!has(&plan, "bounce_gather bounce1"));
        assert_eq!(missing_barriers(&plan.passes), vec![]);
        assert!(plan.settings.contains(&("bounce_specular".into(), specular.to_string())));
        let outputs: Vec<&str> = plan.outputs().map(|(_, r)| r.name.as_str()).collect();
        assert_eq!(outputs[outputs.len() - 3..], ["indirect.1", "indirect.2", "indirect.specular"]);
    }
}

/// Order 4 of one channel is 16 numbers, four texels of four; order 3 is 9, three texels. f16 takes half. The
/// note states the images' bytes, but for the last row of all levels, which need not be full.
#[test]
fn vectors_take_the_planned_memory() {
    let vectors = |plan: &Plan| bytes(plan, &["exit_vectors", "vector_levels"]);
    let [four, three] = [4, 3].map(|order| vectors(&planned(BounceSpecular::Vector, order)));
    let half = planned(BounceSpecular::VectorF16, 4);
    assert_eq!(four, 2 * vectors(&half));
    assert_eq!(4 * three, 3 * four);
    let exit = bytes(&planned(BounceSpecular::Vector, 4), &["exit_vectors"]);
    assert_eq!(exit, (SIDE * SIDE * 4 * 16) as u64);
    let note = half.notes.iter().find(|n| n.starts_with("radiance by direction")).expect("a note");
    let mebibytes = |at: usize| -> f64 {
        let words: Vec<&str> = note.split([' ', ';']).filter(|w| !w.is_empty()).collect();
        let units: Vec<usize> =
            (0..words.len()).filter(|i| ["MiB", "KiB"].contains(&words[*i])).collect();
        let size: f64 = words[units[at] - 1].parse().expect("a number");
        size * if words[units[at]] == "KiB" { 1.0 / 1024.0 } else { 1.0 }
    };
    let [here, there] = [0, 1].map(mebibytes);
    // The note rounds to a tenth.
    assert!((there - 2.0 * here).abs() <= 0.2, "{note}");
    let of_images = vectors(&half) as f64 / 1_048_576.0;
    assert!(here <= of_images + 0.1 && here > 0.98 * of_images, "{note}: {of_images}");
    let scalar = bytes(&planned(BounceSpecular::Scalar, 4), &["exit_upward", "shade_levels"]);
    assert!(scalar < vectors(&half) / 2, "{scalar}");
}

/// New heights leave the tables of lights and lobes as they are, and rewrite every output.
#[test]
fn new_heights_need_no_tables() {
    let environment = Environment::new(16, 8, vec![[0.5, 0.4, 0.3]; 128], 0.3);
    let environment = environment.expect("an environment");
    let phong = PhongSpecular { exponent: 1000.0, scale: 0.5 };
    let mut scene = crate::under_sky(fractal(SIDE, 1).expect("a field"));
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    scene.surface.specular = Some(Specular::Constant(phong));
    let wanted = Picture { light_layers: true, sky_view: true, ..Picture::default() };
    let cases: [(_, _, &[&str]); 4] = [
        (Basis::Auto, true, &["env_tables", "env_wedges", "mirror_map", "specular_tables"]),
        (Basis::Auto, false, &["mirror_map", "specular_tables"]),
        (Basis::Sh, true, &["env_rotation", "light_matrix"]),
        (Basis::Sh, false, &["light_matrix"]),
    ];
    for limits in [Limits::lavapipe(), Limits::boundless(false, 8 << 30)] {
        for (basis, has_environment, tables) in cases {
            scene.lights.environment = has_environment.then(|| environment.clone());
            let quality = Quality { basis, ..Quality::default() };
            let plan = plan::picture(&scene, &quality, &limits, wanted).expect("a plan");
            let heights = plan.find("heights").expect("an input");
            let needed = plan.passes_after(&plan, &[heights]);
            let others = plan.passes.iter().enumerate().filter(|(i, _)| !needed.contains(i));
            let others: Vec<_> = others.map(|(_, pass)| pass).collect();
            let mut names: Vec<&str> = others.iter().map(|pass| pass.name()).collect();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names, tables, "{basis:?}");
            let outputs: Vec<_> = plan.outputs().map(|(id, _)| id).collect();
            let written = others.iter().flat_map(|pass| pass.writes());
            assert_eq!(written.filter(|id| outputs.contains(id)).count(), 0, "{basis:?}");
        }
    }
}

/// A specular map has tables of several exponents under a sky and under an environment. Where they exceed the memory budget, the
/// planner's choice is harmonics, with a note, and `basis table` is refused.
#[test]
fn a_map_has_tables_where_they_fit() {
    let environment = Environment::new(16, 8, vec![[0.5, 0.4, 0.3]; 128], 0.3);
    let mut scene = crate::under_sky(fractal(SIDE, 1).expect("a field"));
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    let phong = |i: usize| PhongSpecular { exponent: (i % 1000) as f32, scale: 0.5 };
    scene.surface.specular = Some(Specular::Map((0..SIDE * SIDE).map(phong).collect()));
    let of = |scene: &Scene, basis, budget| {
        let quality = Quality { basis, ..Quality::default() };
        plan::picture(scene, &quality, &Limits::boundless(true, budget), Picture::default())
    };
    let (large, small) = (8 << 30, 100 << 20);
    let has = |plan: &Plan, pass: &str| plan.passes.iter().any(|p| p.name() == pass);
    // A sky has one table for all azimuths.
    for budget in [large, small] {
        let plan = of(&scene, Basis::Auto, budget).expect("a plan");
        assert!(has(&plan, "specular_light") && !has(&plan, "light_matrix"));
        assert!(plan.notes.iter().any(|n| n.contains("from tables of 21 exponents")));
        assert_eq!(missing_barriers(&plan.passes), vec![]);
    }
    scene.lights.environment = Some(environment.expect("an environment"));
    let plan = of(&scene, Basis::Auto, large).expect("a plan");
    assert!(has(&plan, "specular_light") && !has(&plan, "light_matrix"));
    let plan = of(&scene, Basis::Auto, small).expect("a plan");
    assert!(!has(&plan, "specular_light") && has(&plan, "light_matrix"));
    assert!(plan.notes.iter().any(|n| n.starts_with("basis sh: the tables of the specular map")));
    of(&scene, Basis::Table, small).expect_err("beyond the budget");
}

/// Documentation states what the tables and maps of a specular map take at 32 azimuths under an environment 512 texels wide.
#[test]
fn tables_of_a_map_take_the_stated_memory() {
    let environment = Environment::new(512, 256, vec![[0.5; 3]; 512 * 256], 0.0);
    let mut scene = crate::under_sky(fractal(SIDE, 1).expect("a field"));
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    scene.lights.environment = Some(environment.expect("an environment"));
    let tables = ["specular_tables", "fine_specular_tables", "swept_map", "unoccluded_map"];
    for (exponent, border, mebibytes, last_digit) in [
        (20.0, Border::Plane, 77.0, 1.0),
        (1e4, Border::Plane, 900.0, 10.0),
        (1e4, Border::Open, 1450.0, 10.0),
    ] {
        scene.surface.border = border;
        let texel = PhongSpecular { exponent, scale: 0.5 };
        scene.surface.specular = Some(Specular::Map(vec![texel; SIDE * SIDE]));
        let quality = Quality { azimuths: 32, ..Quality::default() };
        let limits = Limits::boundless(true, 8 << 30);
        let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
        let found = bytes(&plan, &tables) as f64 / 1_048_576.0;
        // Rounded to the last digit.
        assert!((found - mebibytes).abs() <= 0.5 * last_digit, "{exponent} {border:?}: {found}");
    }
}

/// The tables of the default azimuths under an environment. Border open has the largest.
#[test]
fn default_tables_take_a_gibibyte_at_most() {
    let steep = |r: usize| 2.0 * 40_f64.to_radians().tan() * (7 - r) as f64;
    let of = |exponent| PhongSpecular { exponent, scale: 0.4 };
    let environment = Environment::new(8, 4, vec![[1.0; 3]; 32], 0.0).expect("an environment");
    for (specular, azimuths) in [
        (Specular::Constant(of(3e3)), 128),
        (Specular::Constant(of(1e4)), 128),
        (Specular::Map(vec![of(1e3); 64]), 64),
        (Specular::Map(vec![of(1e4); 64]), 32),
    ] {
        let mut scene = grey();
        let heights: Vec<f64> = (0..64).map(|i| steep(i / 8)).collect();
        scene.field = HeightField::new(8, 8, &heights, [2.0; 2], None).expect("a field");
        scene.surface.border = Border::Open;
        scene.surface.specular = Some(specular.clone());
        scene.lights = Lights { environment: Some(environment.clone()), ..Lights::default() };
        let quality = Quality::for_scene(&scene, None);
        assert_eq!(quality.azimuths, azimuths);
        let limits = Limits::boundless(true, 1 << 40);
        let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
        let tables = plan.resources.iter().find(|r| r.name == "specular_tables");
        let bytes = tables.expect("tables, not SH").bytes();
        println!("{azimuths} azimuths: {} MiB", bytes >> 20);
        assert!(bytes <= 1 << 30, "{azimuths} azimuths: {bytes} bytes");
    }
}
