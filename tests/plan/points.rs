//! Plans of visible points: memory first, split where a device has less.

use ridgelight::plan::{self, Kind, Limits, Plan, missing_barriers};
use ridgelight::scene::{
    Albedo, Border, Directions, HeightField, Lights, PhongSpecular, Scatter, Scene, Specular, Sun,
    VisiblePoint, VisiblePoints,
};

use super::{flat, under_sky};

fn of(rows: usize, cols: usize, count: usize, limits: &Limits) -> Result<Plan, String> {
    let directions = Directions::fibonacci(count, -1.0, 0).expect("directions");
    let field = flat(rows, cols);
    plan::visible_points(&field, Border::Plane, &directions, limits).map_err(|e| e.to_string())
}

fn layers(plan: &Plan) -> Vec<u32> {
    let extent = |kind| match kind {
        Kind::Image { layers, .. } => layers,
        Kind::Buffer { .. } => 0,
    };
    plan.outputs().map(|(_, r)| extent(r.kind)).collect()
}

/// Two directions a word up to 255 texels a side, else one; an odd last direction fills half a word.
#[test]
fn visible_points_take_the_planned_memory() {
    let limits = Limits::lavapipe();
    let small = of(255, 40, 7, &limits).expect("a plan");
    assert_eq!(layers(&small), [4]);
    let whole = of(256, 40, 7, &limits).expect("a plan");
    assert_eq!(layers(&whole), [7]);
    for plan in [&small, &whole] {
        assert_eq!(missing_barriers(&plan.passes), []);
    }
    let text = whole.to_string();
    assert!(text.contains(&format!("visible_points {:.1} KiB", 7.0 * 256.0 * 40.0 * 4.0 / 1024.0)));
}

/// 2²⁰ texels: sixteen directions a dispatch of 2²⁴ rays. With allocations of 8 MiB an image has two layers;
/// each image has its own directions, all in order.
#[test]
fn too_large_bakes_are_split() {
    let limits = Limits { memory_budget: 8 << 30, ..Limits::lavapipe() };
    let plan = of(1024, 1024, 40, &limits).expect("a plan");
    let labels = |plan: &Plan| -> Vec<String> {
        let points = plan.passes.iter().filter(|p| p.name() == "visible_points");
        points.map(plan::Pass::label).collect()
    };
    let bands = ["0..16", "16..32", "32..40"].map(|b| format!("visible_points directions {b}"));
    assert_eq!((layers(&plan), labels(&plan)), (vec![40], bands.to_vec()));
    let cut = of(1024, 1024, 5, &Limits { allocation_bytes: 32 << 20, image_layers: 2, ..limits });
    let cut = cut.expect("a plan");
    let bands = ["0..2", "2..4", "4..5"].map(|b| format!("visible_points directions {b}"));
    assert_eq!((layers(&cut), labels(&cut)), (vec![2, 2, 1], bands.to_vec()));
    let names: Vec<_> = cut.outputs().map(|(_, r)| r.name.as_str()).collect();
    assert_eq!(names, ["visible_points.0", "visible_points.1", "visible_points.2"]);
    let said = of(1024, 1024, 600, &Limits::lavapipe()).unwrap_err();
    assert!(said.contains("the limit is 2048.0 MiB of `memory_budget`"), "{said}");
    let said = of(1024, 1024, 5, &Limits { allocation_bytes: 2 << 20, ..limits }).unwrap_err();
    assert!(said.contains("one direction") && said.contains("4096.0 KiB"), "{said}");
}

/// With a relief of 1 over cells of 1, some of 40,001 directions are flatter than 1/16384 a cell, which is
/// allowed; an odd number has a level one, which is not.
#[test]
fn level_rays_over_repetitions_are_noted() {
    let field = ridgelight::scene::HeightField::new(2, 2, &[0.0, 1.0, 0.0, 0.0], [1.0; 2], None);
    let field = field.expect("a field");
    for (count, border, noted) in
        [(64, Border::Periodic, 0), (65, Border::Periodic, 1), (65, Border::Open, 0)]
    {
        let directions = Directions::fibonacci(count, -1.0, 0).expect("directions");
        let plan = plan::visible_points(&field, border, &directions, &Limits::lavapipe());
        assert_eq!(plan.expect("a plan").notes.len(), noted, "{count} {border:?}");
    }
}

/// Level but for a pit, which sees itself.
fn pitted(rows: usize, cols: usize) -> HeightField {
    let mut heights = vec![0.0; rows * cols];
    heights[rows / 2 * cols + cols / 2] = -1.0;
    HeightField::new(rows, cols, &heights, [1.0; 2], None).expect("a field")
}

fn scattered(side: usize, bounces: u32, paths: u32, limits: &Limits) -> Plan {
    let directions = Directions::fibonacci(80, -1.0, 0).expect("directions");
    let scatter = Scatter { bounces, paths, ..Scatter::default() };
    let scene = under_sky(pitted(side, side));
    plan::scatter(&scene, &directions, &scatter, limits).expect("a plan")
}

/// Words, and several layers, are not copied from a buffer of texels.
#[test]
fn points_come_in_images_alone() {
    let mut plan = scattered(32, 1, 16, &Limits::lavapipe());
    let (_, points) =
        plan.inputs().find(|(_, r)| r.name.starts_with("visible_points")).expect("it");
    let (name, format) = (points.name.clone(), points.format().expect("an image"));
    let refused = plan.take_buffer(&name, format).unwrap_err().to_string();
    assert!(refused.contains(&format!("{name}: found an image of words, {format:?}")), "{refused}");
    // No plan has numbers in layers: this one is made up.
    let heights = plan.find("heights").expect("an input");
    if let Kind::Image { layers, .. } = &mut plan.resources[heights.0].kind {
        *layers = 2;
    }
    let refused = plan.take_buffer("heights", plan::Format::R32Float).unwrap_err().to_string();
    assert!(
        refused.contains("heights: found an image of 2 layers, expected one layer"),
        "{refused}"
    );
}

/// From the far end of all paths to the texels, paths side by side; one bounce needs no image between. Every
/// barrier is present, and each is needed.
#[test]
fn paths_are_walked_from_their_ends() {
    let limits = Limits::lavapipe();
    let labels = |plan: &Plan| plan.passes.iter().map(plan::Pass::label).collect::<Vec<_>>();
    let of = |part: &str| format!("scatter_gather paths {part}");
    let cells = "height_cells".to_owned();
    let once = scattered(9, 1, 70, &limits);
    assert_eq!(labels(&once), [cells.clone(), of("0..64"), of("64..70")]);
    assert!(once.find("carried.0").is_none());
    let thrice = scattered(9, 3, 5, &limits);
    let walked = [of("0..5 step 2"), of("0..5 step 1"), of("0..5")];
    assert_eq!(labels(&thrice), [&[cells], &walked[..]].concat());
    for plan in [&once, &thrice] {
        assert_eq!(missing_barriers(&plan.passes), []);
        for i in (0..plan.passes.len()).filter(|i| plan.passes[*i].barrier_before) {
            let mut passes = plan.passes.clone();
            passes[i].barrier_before = false;
            assert!(!missing_barriers(&passes).is_empty(), "{i}");
        }
    }
}

/// Images between steps take 64 MiB, or the size for one path: with 1024² texels those of two paths, 2 · 2 · 16
/// MiB; where visible points are split into several images, one path's, as each step reads one of them.
#[test]
fn paths_side_by_side_have_their_room() {
    let limits = Limits { memory_budget: 8 << 30, ..Limits::lavapipe() };
    let carried = |plan: &Plan| {
        let own = plan.resources.iter().filter(|r| r.name.starts_with("carried"));
        own.map(ridgelight::plan::Resource::bytes).sum::<u64>()
    };
    assert_eq!(carried(&scattered(1024, 2, 9, &limits)), 64 << 20);
    assert_eq!(carried(&scattered(2048, 2, 9, &limits)), 128 << 20);
    let cut = scattered(300, 2, 9, &Limits { image_layers: 32, ..limits });
    assert_eq!(carried(&cut), 2 * 16 * 90_000);
    assert_eq!(cut.inputs().filter(|(_, r)| r.name.starts_with("visible_points.")).count(), 3);
}

/// Ellipses need all directions at once: one image, which a device with fewer layers refuses with the missing
/// number; and at least one direction above horizontal.
#[test]
fn ellipses_need_one_image() {
    let limits = Limits::lavapipe();
    let directions = Directions::fibonacci(40, -1.0, 0).expect("directions");
    let of = |directions: &Directions, limits: &Limits| {
        plan::ellipses(&flat(300, 20), Border::Plane, directions, limits)
    };
    let plan = of(&directions, &limits).expect("a plan");
    assert_eq!(missing_barriers(&plan.passes), []);
    assert_eq!(layers(&plan), [1, 1]);
    let last = plan.passes.last().expect("passes");
    assert_eq!((last.name(), last.groups), ("ellipse_fit", [3, 38, 1]));
    let few = of(&directions, &Limits { image_layers: 39, ..limits }).unwrap_err().to_string();
    assert!(few.contains("40 directions") && few.contains("39 layers"), "{few}");
    let down = Directions::from_vectors(vec![-glam::DVec3::Z], -1.0).expect("a direction");
    let none = of(&down, &limits).unwrap_err().to_string();
    assert!(none.contains("above horizontal"), "{none}");
}

/// As many directions of another seed, another depth, or as many words of one fewer, differ from the plan's.
#[test]
fn points_of_other_directions_are_refused() {
    let scene = under_sky(pitted(3, 4));
    let of = |count: usize, lowest_z: f64, seed: u32| {
        Directions::fibonacci(count, lowest_z, seed).expect("directions")
    };
    let own = of(16, -1.0, 1);
    let plan = plan::scatter(&scene, &own, &Scatter::default(), &Limits::lavapipe());
    let plan = plan.expect("a plan");
    let inputs = |directions: Directions| {
        let in_sight = vec![VisiblePoint::Sky; 12 * directions.count()];
        let border = scene.surface.border;
        let points = VisiblePoints::from_points(&scene.field, border, directions, &in_sight);
        let direct = [[1.0; 3]; 12];
        plan::scatter_inputs(&plan, &scene, &points.expect("points"), &direct)
    };
    assert!(inputs(own.clone()).is_ok());
    let deeper = Directions::from_vectors(own.vectors().to_vec(), -0.5).expect("directions");
    for other in [of(16, -1.0, 2), of(16, -0.5, 1), deeper, of(15, -1.0, 1), of(18, -1.0, 1)] {
        let said = inputs(other).unwrap_err().to_string();
        assert!(said.contains("directions of the visible points"), "{said}");
    }
}

/// Rays end above the highest texel: heights that only the device knows have none.
#[test]
fn unknown_heights_are_refused() {
    let field = HeightField::unknown(4, 4, [1.0; 2]).expect("a field");
    let directions = Directions::fibonacci(8, -1.0, 0).expect("directions");
    let limits = Limits::lavapipe();
    let said = plan::visible_points(&field, Border::Plane, &directions, &limits).unwrap_err();
    assert!(said.to_string().contains("unknown heights"), "{said}");
    let scene = under_sky(field);
    let said = plan::scatter(&scene, &directions, &Scatter::default(), &limits).unwrap_err();
    assert!(said.to_string().contains("unknown heights"), "{said}");
}

/// A texel that faces up on a slope sees below horizontal; where nothing is scattered nothing is lost.
#[test]
fn light_from_below_that_is_left_out_is_noted() {
    let notes = |field: HeightField, lowest_z: f64| {
        let directions = Directions::fibonacci(8, lowest_z, 0).expect("directions");
        let limits = Limits::lavapipe();
        let plan = plan::scatter(&under_sky(field), &directions, &Scatter::default(), &limits);
        plan.expect("a plan").notes
    };
    assert_eq!(notes(pitted(4, 4), -1.0), Vec::<String>::new());
    assert!(notes(flat(4, 4), -0.25).iter().all(|note| !note.contains("-0.25")));
    let said = notes(pitted(4, 4), -0.25);
    assert!(said.len() == 1 && said[0].contains("-0.25"), "{said:?}");
}

/// Steps of a path, and names of the passes.
fn parts(plan: &Plan) -> (usize, Vec<&'static str>) {
    let names: Vec<_> = plan.passes.iter().map(plan::Pass::name).collect();
    (names.iter().filter(|name| **name == "scatter_gather").count(), names)
}

/// Black ground, and ground that does not see itself: one pass without inputs. Bounces end where no light is
/// left: the 17th and later bounces at ½ carry less than 2⁻¹⁶. For one bounce no more paths than directions.
#[test]
fn scatter_without_light_takes_one_pass() {
    let directions = Directions::fibonacci(20, -1.0, 0).expect("directions");
    let of = |scene: &Scene, scatter: Scatter| {
        plan::scatter(scene, &directions, &scatter, &Limits::lavapipe()).expect("a plan")
    };
    let grey = |albedo: f32, field: HeightField| {
        let mut scene = under_sky(field);
        scene.surface.albedo = Albedo::Constant([albedo; 3]);
        scene
    };
    let slope: Vec<f64> = (0..16).map(f64::from).collect();
    let slope = HeightField::new(4, 4, &slope, [1.0; 2], None).expect("a field");
    for (scene, why) in [
        (grey(0.0, pitted(5, 5)), "reflects nothing"),
        (grey(0.7, flat(5, 5)), "no ground is visible from other ground"),
        (grey(0.7, slope), "no ground is visible from other ground"),
    ] {
        let plan = of(&scene, Scatter::default());
        assert_eq!(parts(&plan), (1, vec!["scatter_gather"]));
        assert!(plan.notes.iter().any(|note| note.contains(why)), "{:?}", plan.notes);
        let kept: Vec<_> = plan.resources.iter().map(|r| r.name.as_str()).collect();
        assert_eq!((plan.inputs().count(), kept), (0, vec!["scattered"]));
        let in_sight = vec![VisiblePoint::Sky; scene.field.heights_m().len() * 20];
        let points = VisiblePoints::from_points(
            &scene.field,
            scene.surface.border,
            directions.clone(),
            &in_sight,
        );
        let direct = vec![[1.0; 3]; scene.field.heights_m().len()];
        let inputs = plan::scatter_inputs(&plan, &scene, &points.expect("points"), &direct);
        assert_eq!(inputs.expect("inputs"), Vec::<Vec<f32>>::new());
    }
    let deep = |cutoff| Scatter { bounces: 64, paths: 1, cutoff, ..Scatter::default() };
    let scene = grey(0.5, pitted(5, 5));
    let plan = of(&scene, deep(1.0 / 65536.0));
    assert_eq!(parts(&plan).0, 16);
    assert!(plan.notes[0].contains("bounces 17 to 64 dropped"), "{:?}", plan.notes);
    assert_eq!(parts(&of(&scene, deep(0.0))).0, 64);
    let paths = |bounces, paths, first_path| {
        let plan = of(&scene, Scatter { bounces, paths, first_path, ..Scatter::default() });
        plan.settings.iter().find(|(name, _)| name == "paths").expect("it").1.clone()
    };
    assert_eq!([paths(1, 50, 0), paths(2, 50, 0), paths(1, 50, 7)], ["20", "50", "50"]);
}

/// Specular of scale 0 is left out. Other specular takes one more step where hit ground reflects a sun or a
/// sky, gathers suns only where they light the ground, and nothing without light.
#[test]
fn specular_scatter_gathers_from_lit_texels() {
    let directions = Directions::fibonacci(20, -1.0, 0).expect("directions");
    let of = |scale: f32, lights: Lights| {
        let mut scene = Scene { lights, ..under_sky(pitted(5, 5)) };
        scene.surface.albedo = Albedo::Constant([0.5; 3]);
        scene.surface.specular =
            Some(Specular::Map(vec![PhongSpecular { exponent: 9.0, scale }; 25]));
        let scatter = Scatter { bounces: 2, paths: 1, ..Scatter::default() };
        let plan = plan::scatter(&scene, &directions, &scatter, &Limits::lavapipe());
        let plan = plan.expect("a plan");
        let has = |name: &str| plan.resources.iter().any(|r| r.name == name);
        let (steps, names) = parts(&plan);
        (steps, has("phong"), has("sun_points"), names.contains(&"visible_points"))
    };
    let sun = |irradiance: f32| Sun {
        azimuth_rad: 0.0,
        elevation_rad: 1.0,
        diameter_rad: 0.0,
        irradiance: [irradiance; 3],
    };
    let lit = |sky: Option<f32>, irradiance: f32| Lights {
        sky: sky.map(|v| [v; 3]),
        suns: vec![sun(irradiance)],
        ..Lights::default()
    };
    assert_eq!(of(0.0, lit(Some(1.0), 1.0)), (2, false, false, false));
    assert_eq!(of(0.5, lit(Some(0.0), 0.0)), (2, true, false, false));
    assert_eq!(of(0.5, lit(Some(1.0), 0.0)), (3, true, false, false));
    assert_eq!(of(0.5, lit(None, 1.0)), (3, true, true, true));
}
