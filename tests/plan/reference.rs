//! Plans of the path-traced reference, and its importance sampling.

use ridgelight::plan::{self, Limits, Plan};
use ridgelight::scene::{
    Albedo, Border, Environment, KeyLight, Lights, Normals, PhongSpecular, Scene, Specular, Sun,
};

use super::{flat, under_sky};

/// Blocks of 4, 16 and 64 cells up to one that holds all; another light restarts the paths.
#[test]
fn a_reference() {
    let of = |rows, cols, bounces, seed| {
        let scene = under_sky(flat(rows, cols));
        plan::reference(&scene, bounces, Normals::Smooth, None, seed, &Limits::lavapipe())
            .expect("a plan")
    };
    let labels = |plan: &Plan| plan.passes.iter().map(plan::Pass::label).collect::<Vec<_>>();
    let [cells, trace] = ["height_cells", "path_trace"];
    let level = |l: u32| format!("height_bounds level {l}");
    assert_eq!(labels(&of(1, 1, 0, 0)), [cells, &level(1), trace]);
    assert_eq!(labels(&of(5, 2, 0, 0)), [cells, &level(1), trace]);
    assert_eq!(labels(&of(5, 18, 0, 0)), [cells, &level(1), &level(2), &level(3), trace]);
    let before = of(5, 5, 0, 0);
    assert_eq!(before.passes_after(&before, &[]), [0_usize; 0]);
    for after in [of(5, 5, 1, 0), of(5, 5, 0, 1)] {
        assert_eq!(after.passes_after(&before, &[]), [0, 1, 2]);
    }
    // In bands of 2^24 paths' vertices, in eights of rows: 512 texels a row, 64 paths, two vertices.
    let bands = of(515, 512, 1, 0);
    let parts =
        ["rows 0..256", "rows 256..512", "rows 512..515"].map(|p| format!("path_trace {p}"));
    assert_eq!(labels(&bands)[labels(&bands).len() - 3..], parts);
    let dark = Scene { lights: Lights::default(), ..under_sky(flat(2, 2)) };
    let refused = plan::reference(&dark, 0, Normals::Smooth, None, 0, &Limits::lavapipe())
        .unwrap_err()
        .to_string();
    assert!(refused.contains("lights: found none"), "{refused}");
}

/// Only specular depends on the eye: without it the plan is that of a view from straight above. Another eye restarts the
/// paths.
#[test]
fn an_eye_changes_the_plan_where_there_is_specular() {
    let dull = under_sky(flat(5, 5));
    let mut shiny = dull.clone();
    shiny.surface.albedo = Albedo::Constant([0.5; 3]);
    shiny.surface.specular = Some(Specular::Constant(PhongSpecular { exponent: 9.0, scale: 0.25 }));
    let of = |scene: &Scene, eye_m| {
        plan::reference(scene, 0, Normals::Smooth, eye_m, 0, &Limits::lavapipe())
    };
    let stated = |plan: &Plan| {
        plan.settings.iter().find(|(name, _)| name == "eye_m").map(|(_, value)| value.clone())
    };
    let (eye, other) = (Some([1.0, -2.5, 9.0]), Some([1.0, -2.5, 8.0]));
    let [above, near] = [None, eye].map(|eye_m| of(&dull, eye_m).expect("a plan"));
    assert_eq!(near.passes_after(&above, &[]), [0_usize; 0]);
    assert_eq!([stated(&above), stated(&near)], [None, None]);
    let [above, near, lower] = [None, eye, other].map(|eye_m| of(&shiny, eye_m).expect("a plan"));
    assert_eq!(near.passes_after(&near, &[]), [0_usize; 0]);
    let trace = near.passes.len() - 1;
    assert!(near.passes_after(&above, &[]).contains(&trace));
    assert!(lower.passes_after(&near, &[]).contains(&trace));
    assert_eq!(stated(&above), None);
    assert_eq!(stated(&near).as_deref(), Some("1,-2.5,9"));
    for wrong in [f64::NAN, 2e15] {
        let refused = of(&shiny, Some([0.0, wrong, 0.0])).unwrap_err().to_string();
        assert!(refused.contains("eye_m: found"), "{refused}");
        assert!(of(&dull, Some([0.0, wrong, 0.0])).is_ok());
    }
}

/// Three columns and rows of an environment: the shares of its light, by hand.
#[test]
fn environments_are_importance_sampled() {
    let grey = |v: f32| [v / 3.0; 3];
    let texels = [1.0, 0.0, 3.0, 0.0, 0.0, 0.0, 2.0, 2.0, 4.0].map(grey).to_vec();
    let mut scene = under_sky(flat(2, 2));
    scene.surface.border = Border::Open;
    scene.lights.environment = Some(Environment::new(3, 3, texels, 0.0).expect("an environment"));
    let close = |got: &[f32], want: &[f32]| {
        assert_eq!(got.len(), want.len());
        // Rounded to f32.
        assert!(got.iter().zip(want).all(|(g, w)| (g - w).abs() < 1e-7), "{got:?} for {want:?}");
    };
    // Rows of 4 and 8, as wide as each other, around a dark one.
    let third = 1.0 / 3.0;
    let rows = [[third, 0.25, 0.25, 1.0], [third, 0.0, 0.0, 0.0], [1.0, 0.25, 0.5, 1.0]];
    close(&plan::reference_inputs(&scene)[2], &rows.concat());
    // The row below horizontal gives no light.
    scene.surface.border = Border::Plane;
    let rows = [[1.0, 0.25, 0.25, 1.0], [1.0, 0.0, 0.0, 0.0], [1.0, 0.25, 0.5, 1.0]];
    close(&plan::reference_inputs(&scene)[2], &rows.concat());
}

/// A list of 600 texels of a field 512 wide takes two rows; its sums have that size, the heights that of the field.
#[test]
fn a_reference_at_some_texels() {
    let scene = under_sky(flat(515, 512));
    let of = |grid_points| {
        plan::reference_at(&scene, 1, Normals::Smooth, None, 0, grid_points, &Limits::lavapipe())
    };
    let plan = of(600).expect("a plan");
    let size = |name: &str| match plan.resources[plan.find(name).expect("there").0].kind {
        plan::Kind::Image { width, height, .. } => [width, height],
        plan::Kind::Buffer { .. } => panic!("{name} is a buffer"),
    };
    for name in ["places", "radiance", "standard_error", "batch_mean"] {
        assert_eq!(size(name), [512, 2], "{name}");
    }
    assert_eq!(size("cells"), [512, 515]);
    let last = plan.passes.last().expect("passes");
    assert_eq!((last.label().as_str(), last.groups), ("path_trace", [64, 1, 1]));
    let texels = plan::listed_places(&scene, &[0, 513, 513]).expect("of the field");
    assert_eq!(texels[..12], [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
    assert_eq!((texels.len(), &texels[12..14]), (4 * 512, &[-1.0, -1.0][..]));
    for grid_points in [0, 515 * 512 + 1] {
        let refused = of(grid_points).unwrap_err().to_string();
        assert!(refused.contains("1 to 263680"), "{refused}");
    }
    let refused = plan::listed_places(&scene, &[263_679, 263_680]).unwrap_err().to_string();
    assert!(refused.contains("position 1: found 263680, expected less than 263680"), "{refused}");
    let bands =
        plan::reference_in_bands(&scene, 1, Normals::Smooth, None, 0, &Limits::lavapipe(), 0);
    let refused = bands.unwrap_err().to_string();
    assert!(refused.contains("rows of a band: found 0, expected 1 or more"), "{refused}");
}

/// f32's π/2 and 2π, which are above π/2 and 2π, aim and weigh paths like the exact angles.
#[test]
fn f32_right_angles_are_traced_like_exact_ones() {
    use std::f64::consts::{FRAC_PI_2, TAU};
    let rounded = [std::f32::consts::FRAC_PI_2, std::f32::consts::TAU].map(f64::from);
    for border in [Border::Open, Border::Plane] {
        let of = |[right, turn]: [f64; 2]| {
            let suns = [0.0, right].map(|diameter_rad| Sun {
                azimuth_rad: 0.4,
                elevation_rad: right,
                diameter_rad,
                irradiance: [1.0; 3],
            });
            let elevations_rad = [-right, right];
            let key =
                KeyLight { azimuth_rad: 0.4, width_rad: turn, elevations_rad, radiance: [1.0; 3] };
            let mut scene = under_sky(flat(2, 2));
            scene.surface.border = border;
            scene.lights = Lights { suns: suns.to_vec(), keys: vec![key], ..Lights::default() };
            plan::reference(&scene, 1, Normals::Smooth, None, 0, &Limits::lavapipe())
                .expect("a plan");
            (plan::reference_inputs(&scene), plan::unsampled_light_error(&scene, 1, 64))
        };
        assert_eq!(of(rounded), of([FRAC_PI_2, TAU]), "{border:?}");
    }
}
