//! The stated errors of a curved base, against grooves bent as real geometry: rays and paths at the mesh.

use glam::DVec3;
use ridgelight::scene::{
    Albedo, Border, Curvature, Directions, HeightField, Lights, Scene, Surface, VisiblePoints,
};
use ridgelight_cpu::bent_directions::{Draped, Fans};
use ridgelight_cpu::fan_weights::weight;
use ridgelight_cpu::visible_points::visible_points;

#[path = "../../common/bent_light.rs"]
mod light;
#[path = "../../common/bent_mesh.rs"]
mod mesh;

use light::{ALBEDO, BOUNCES, BentDirections};
use mesh::Mesh;

const PERIOD: usize = 16;
const ROWS: usize = 9;
const COLS: usize = 3 * PERIOD + 1;
const COUNT: usize = 256;
/// The middle row.
const COMPARED: std::ops::Range<usize> = ROWS / 2 * COLS..(ROWS / 2 + 1) * COLS;

/// For every base that is accepted, about as many more lights are wrong than on the flat base as stated. Directions
/// leave lights in mixed triangles, in which the edge between lit and hidden is taken to lie in the middle: a fourth
/// of them is wrong on both bases, within three standard deviations, √(3/16) of the root of their number where each is
/// independent. The three grooves are alike, so a light is wrong in all three together: the root of three times their
/// number. The mean error of scattered light is at most the stated one plus that on the flat base. At the largest
/// curvature, more lights are wrong without adapting, and the light's error is larger everywhere.
#[test]
fn curved_grooves_err_by_about_the_stated_error() {
    let height = |i: usize| ((i % COLS) % PERIOD).abs_diff(PERIOD / 2) as f64;
    let heights: Vec<f64> = (0..ROWS * COLS).map(height).collect();
    let field = HeightField::new(ROWS, COLS, &heights, [1.0; 2], None).expect("a field");
    let border = Border::Open;
    let surface = Surface { border, albedo: Albedo::Constant([ALBEDO as f32; 3]), specular: None };
    let scene = Scene { field: field.clone(), surface, lights: Lights::default() };
    let directions = Directions::fibonacci(COUNT, -1.0, 0).expect("directions");
    let visible = visible_points(&field, border, &directions);
    let net = directions.triangles().expect("a net");
    let fans = Fans::of(&net, directions.vectors());
    let points = VisiblePoints::from_points(&field, border, directions, &visible).expect("points");
    let lights = Directions::fibonacci(200, 0.0, 7).expect("lights");
    let own: Vec<f64> = (0..ROWS * COLS).map(|at| light::emitted(at % COLS, PERIOD)).collect();
    let compared: Vec<usize> = COMPARED.collect();
    let mut level = [0.0; 2];
    let mut on_flat = [0.0; 2];
    for radius in [f64::INFINITY, 100.0, 50.0, 25.0, 16.0, 12.0, -100.0, -70.0, -50.0, -35.0, -18.0]
    {
        let curvature = Curvature { per_m: [1.0 / radius, 0.0] };
        let Ok(said) = curvature.check(&field, border) else {
            assert!([12.0, -18.0].contains(&radius), "{radius} is refused");
            continue;
        };
        assert!(![12.0, -18.0].contains(&radius), "{radius} is not refused");
        let mesh = Mesh::bent(&field, 1.0 / radius);
        let draped =
            |curvature| Draped { field: &field, border, points: &points, fans: &fans, curvature };
        let (adapted, flat) = (draped(curvature), draped(Curvature::FLAT));
        let bent: Vec<Vec<DVec3>> = (0..ROWS * COLS).map(|at| adapted.bent(at)).collect();
        let vectors = points.directions().vectors();
        let (mut wrong, mut wrong_flat, mut unsure) = (0.0, 0.0, 0.0);
        for at in &compared {
            for l in lights.vectors() {
                let is_lit = mesh.met(mesh.over(*at), mesh.frames[*at].out(*l)).is_none();
                let share = adapted.lit_share(&net, &bent[*at], *at, *l).expect("a net all around");
                let as_flat = flat.lit_share(&net, vectors, *at, *l).expect("the same");
                wrong += f64::from(u8::from((share >= 0.5) != is_lit));
                wrong_flat += f64::from(u8::from((as_flat >= 0.5) != is_lit));
                unsure += f64::from(u8::from(share > 0.0 && share < 1.0));
            }
        }
        let all = (compared.len() * lights.count()) as f64;
        if radius.is_infinite() {
            on_flat = [wrong, unsure];
        }
        let alike = (COLS / PERIOD) as f64;
        let noise = 3.0 * (alike * 3.0 / 16.0 * (on_flat[1] + unsure)).sqrt();
        let allowed = on_flat[0] + said.shadows * all + noise;
        println!(
            "{radius}: wrong {:.4}, as flat {:.4}; said {:.4}, allowed {:.4}",
            wrong / all,
            wrong_flat / all,
            said.shadows,
            allowed / all
        );
        assert!(wrong <= allowed, "{radius}: {wrong} lights, {allowed} allowed");
        assert!(
            radius.abs() > 30.0 || wrong_flat > allowed,
            "{radius}: as on the flat base would do"
        );

        let weigh = |bent: &Vec<DVec3>| (0..COUNT).map(|i| weight(&fans, bent, i)).collect();
        let weights = Some(bent.iter().map(weigh).collect());
        let adapted = BentDirections { bent, weights };
        let found = light::scattered(&scene, &points, curvature, &adapted, &own);
        let as_flat = BentDirections { bent: vec![vectors.to_vec(); ROWS * COLS], weights: None };
        let as_flat = light::scattered(&scene, &points, Curvature::FLAT, &as_flat, &own);
        let ground_truth = light::path_traced(&mesh, &field, &compared).expect("rays");
        for (k, bounces) in BOUNCES.into_iter().enumerate() {
            let off = |found: &[f64]| {
                let off =
                    compared.iter().zip(&ground_truth).map(|(at, t)| (found[*at] - t[k]).abs());
                off.sum::<f64>() / compared.len() as f64
            };
            let (off, as_flat) = (off(&found[k]), off(&as_flat[k]));
            if radius.is_infinite() {
                level[k] = off;
            }
            let allowed = level[k] + said.scattered(ALBEDO, bounces as u32);
            println!("  {bounces} times: off {off:.4}, as flat {as_flat:.4}, allowed {allowed:.4}");
            assert!(off <= allowed, "{radius}, {bounces} times: {off}, {allowed} allowed");
            assert!(
                radius.is_infinite() || as_flat > off,
                "{radius}: as on the flat base is nearer"
            );
        }
    }
}
