//! Specular scattering towards several views: each alone, closed forms, and one light after the other.

use std::f64::consts::PI;

use ridgelight::plan::{self, Limits};
use ridgelight::scene::{
    Albedo, Border, Directions, Lights, PhongSpecular, Scatter, Scene, Specular, Sun, VisiblePoints,
};
use ridgelight_bake::ExitRadiance;

use super::scatter::{points, sphere};
use crate::{Device, field, random, under_sky};

fn towards_views(
    device: &mut Device,
    scene: &Scene,
    points: &VisiblePoints,
    scatter: &Scatter,
    views: &[glam::DVec3],
) -> Vec<Vec<[f64; 3]>> {
    let (directions, limits) = (points.directions(), device.limits());
    let plan = plan::scatter_views(scene, directions, scatter, views, &limits).expect("a plan");
    let count = scene.field.heights_m().len();
    let direct = vec![[1.0, 0.5, 2.0]; count];
    let contents = plan::scatter_inputs(&plan, scene, points, &direct).expect("inputs");
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let values = device.draw(plan, &contents).remove(0).values;
    let texels: Vec<_> =
        values.chunks_exact(4).map(|t| [t[0], t[1], t[2]].map(f64::from)).collect();
    texels.chunks_exact(count).map(<[_]>::to_vec).collect()
}

/// Views side by side have each its own bits: the same terms in the same order. And they differ.
#[test]
fn views_side_by_side_are_each_alone() {
    let mut device = Device::new();
    let mut next = random(83);
    let noise: Vec<f64> = (0..63).map(|_| 2.0 * next()).collect();
    let mut scene = under_sky(field(7, 9, [1.0; 2], |r, c| noise[9 * r + c]), Border::Periodic);
    scene.surface.albedo = Albedo::Constant([0.4, 0.3, 0.2]);
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent: 12.0, scale: 0.5 }));
    let points = points(&mut device, &scene, &sphere(30));
    let views = [glam::DVec3::Z, glam::DVec3::X, glam::DVec3::new(-0.48, 0.6, 0.64)];
    for (direct_specular, bounces) in [(false, 2), (true, 1), (true, 0)] {
        let scatter = Scatter { bounces, paths: 70, direct_specular, ..Scatter::default() };
        let all = towards_views(&mut device, &scene, &points, &scatter, &views);
        assert_eq!(all.len(), 3);
        for (view, of_view) in views.iter().zip(&all) {
            let alone = towards_views(&mut device, &scene, &points, &scatter, &[*view]);
            assert!(alone[0] == *of_view, "{direct_specular} {bounces} {view}");
        }
        assert!(all[0] != all[1] && all[1] != all[2], "cannot fail");
    }
}

/// Direct specular of level ground under a sky of 1 and a sun: s times the sum of p over the directions above, and s p
/// E of the sun, from each view, without bounces. f32 of directions turns a lobe's angle by 2⁻²³, which changes cosⁿ
/// by n 2⁻²³ of itself at the steepest; sums of 200 terms, rounded within 16 ε each.
#[test]
fn direct_specular_of_level_ground_matches_its_closed_form() {
    let mut device = Device::new();
    let mut scene = under_sky(field(4, 5, [1.0; 2], |_, _| 2.0), Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.25; 3]);
    scene.lights.sky = Some([1.0, 0.5, 0.0]);
    scene.lights.suns = vec![Sun {
        azimuth_rad: 0.4,
        elevation_rad: 0.9,
        diameter_rad: 0.0,
        irradiance: [2.0, 1.0, 3.0],
    }];
    let towards = glam::DVec3::new(
        0.9_f64.cos() * 0.4_f64.cos(),
        0.9_f64.cos() * 0.4_f64.sin(),
        0.9_f64.sin(),
    );
    let directions = sphere(200);
    let points = points(&mut device, &scene, &directions);
    let views = [glam::DVec3::Z, glam::DVec3::new(-0.6, 0.0, 0.8)];
    for n in [1.0, 25.0] {
        scene.surface.specular =
            Some(Specular::Constant(PhongSpecular { exponent: n as f32, scale: 0.75 }));
        let scatter =
            Scatter { bounces: 0, paths: 4096, direct_specular: true, ..Scatter::default() };
        let all = towards_views(&mut device, &scene, &points, &scatter, &views);
        for (view, of_view) in views.iter().zip(&all) {
            let mirror = glam::DVec3::new(-view.x, -view.y, view.z);
            let p = |e: glam::DVec3| 0.75 * (n + 1.0) / (2.0 * PI) * mirror.dot(e).max(0.0).powf(n);
            let above = directions.vectors().iter().filter(|e| e.z > 0.0);
            let of_sky = above.map(|e| p(*e)).sum::<f64>() * directions.share_sr();
            let known = [2.0 * p(towards) + of_sky, p(towards) + 0.5 * of_sky, 3.0 * p(towards)];
            for (got, known) in of_view.iter().flat_map(|got| got.iter().zip(known)) {
                let allowed = (n + 1.0) * (8.0 * n + 16.0 * 200.0) / f64::from(1 << 24);
                assert!((got - known).abs() <= allowed * known.max(0.1), "{n}: {got} {known}");
            }
            assert!(of_sky > 0.3 && p(towards) > 1e-4, "cannot fail: {of_sky} {}", p(towards));
        }
    }
}

/// Triangles under lights in turn, towards all views by a few at a time and towards one alone: each has the bits of
/// that light and view alone, whatever lights the scene has and whatever was computed before.
#[test]
fn lights_in_turn_are_each_alone() {
    let mut device = Device::new();
    let mut next = random(84);
    let noise: Vec<f64> = (0..56).map(|_| next()).collect();
    let mut scene = under_sky(field(7, 8, [1.0; 2], |r, c| noise[8 * r + c]), Border::Periodic);
    scene.surface.albedo = Albedo::Constant([0.4, 0.3, 0.2]);
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent: 5.0, scale: 0.5 }));
    let points = points(&mut device, &scene, &sphere(30));
    let scatter = Scatter { bounces: 2, paths: 40, ..Scatter::default() };
    let above = Directions::fibonacci(8, 0.0, 0).expect("directions");
    let limits = Limits { image_layers: 3, ..device.limits() };
    let gpu = device.gpu.as_mut().expect("alive");
    let facets = ridgelight_bake::facets(gpu, &scene, 2, &above, &limits).expect("triangles");
    let wanted = |light: usize| if light == 4 { 6..7 } else { 0..8 };
    let mut all: Vec<(usize, ExitRadiance)> = Vec::new();
    ridgelight_bake::lit_from(
        gpu,
        &scene,
        (&facets, 2..6, &wanted),
        Some((&points, &scatter)),
        &limits,
        &mut |light, leaving| {
            all.push((light, leaving));
            Ok(())
        },
    )
    .expect("light");
    assert_eq!(all.len(), 4);
    let mut brightest = 0.0_f64;
    for (light, leaving) in all {
        let e = above.vectors()[light];
        let sun = Sun {
            azimuth_rad: e.y.atan2(e.x),
            elevation_rad: e.z.atan2(e.truncate().length()),
            diameter_rad: 0.0,
            irradiance: [1.0; 3],
        };
        let lights = Lights { suns: vec![sun], ..Lights::default() };
        let lit = Scene { lights, ..scene.clone() };
        let direct = facets.lit_from(light);
        let grid_points = facets.to_grid_points(direct.alike());
        for view in wanted(light) {
            let towards = Scatter { view: above.vectors()[view], ..scatter };
            let more =
                gpu.scattered(&lit, &points, &grid_points, &towards, &limits).expect("light");
            let alone = direct.clone().scattering(view, vec![more]);
            let [got, known] = [&leaving, &alone].map(|light| facets.radiance_from(view, light));
            assert_eq!(got, known, "{light} {view}");
            brightest = brightest.max(known[0] - facets.radiance_from(view, &direct)[0]);
        }
    }
    assert!(brightest > 0.01, "cannot fail: {brightest}");
}
