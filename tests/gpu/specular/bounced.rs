//! Indirect Phong specular: the path tracer against brute-force paths, bounces against closed forms and against the
//! path tracer.

use ridgelight::basis::zonal::clamped_cosine;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Basis, Border, BounceEngine, BounceSpecular, Bounces, Environment, KeyLight, Lights,
    Method, Normals, PhongSpecular, Quality, Scene, Specular, SphereLight,
};
use ridgelight_cpu::light::normal;
use std::f64::consts::PI;

use crate::brute_force_paths::Paths;
use crate::reference::quadrature::{traced, traced_on};
use crate::{Device, colours, field, random, under_sky};

/// A number of bounces by pyramids whose texels all use the field itself.
fn bounce_quality(count: u32, specular: BounceSpecular, sh_order: u32) -> Quality {
    let bounces = Bounces {
        count,
        engine: BounceEngine::Pyramid,
        azimuths: 16,
        cutoff: 0.0,
        level_offset: 4,
        specular,
        ..Bounces::default()
    };
    let base =
        Quality { azimuths: 16, method: Method::BruteForce, level_offset: 4, ..Quality::default() };
    Quality { basis: Basis::Sh, sh_order, bounces, ..base }
}

/// Layers by name, R, G, B.
fn drawn(gpu: &mut Device, scene: &Scene, quality: &Quality) -> Vec<(String, Vec<[f64; 3]>)> {
    let limits = gpu.limits();
    let all = gpu.light_layers(scene, quality, &limits);
    all.iter().map(|p| (p.name.clone(), colours(p))).collect()
}

fn layer<'a>(all: &'a [(String, Vec<[f64; 3]>)], name: &str) -> &'a [[f64; 3]] {
    &all.iter().find(|(n, _)| n == name).unwrap_or_else(|| panic!("no layer {name}")).1
}

/// A field that sees much of itself, with its own specular at each texel.
fn lobed() -> Scene {
    let mut next = random(61);
    let noise: Vec<f64> = (0..25).map(|_| next()).collect();
    let mut scene =
        under_sky(field(5, 5, [1.0, 1.25], |r, c| 2.5 * noise[r * 5 + c]), Border::Open);
    let phong_specular = |i: usize| PhongSpecular {
        exponent: (i * 7 % 30) as f32,
        scale: 0.3 + 0.1 * (i % 4) as f32,
    };
    scene.surface.albedo = Albedo::Constant([0.3, 0.1, 0.4]);
    scene.surface.specular = Some(Specular::Map((0..25).map(phong_specular).collect()));
    let texels = (0..18_u8).map(|i| [f32::from(i % 5), 1.0, f32::from(i % 3)]).collect();
    let environment = Environment::new(6, 3, texels, 0.9).expect("an environment");
    scene.lights = Lights { environment: Some(environment), ..Lights::default() };
    scene
}

/// The device's paths reflect by the lobe of every hit point, as brute-force paths do: within five standard errors of
/// both (6e-7 a comparison, 24 of them). The comparison fails for brute-force paths whose lobes reflect towards
/// straight above only.
#[test]
fn paths_reflect_by_phong_specular_at_every_hit() {
    let mut gpu = Device::new();
    let scene = lobed();
    let mut apart = [0.0_f64; 2];
    for bounces in [1, 3] {
        let [light, error] = traced(&mut gpu, &scene, bounces, 5, 64);
        for (k, has_specular) in [true, false].into_iter().enumerate() {
            let mut paths = Paths::new(&scene, has_specular);
            for texel in [6, 7, 12, 18] {
                let up = normal(&scene.field, Border::Open, texel / 5, texel % 5);
                let counted = paths.light(texel, up, bounces as usize, 12_000);
                let [mean, sigma] = counted[bounces as usize];
                for c in 0..3 {
                    let both = sigma[c].hypot(error[texel][c]);
                    apart[k] = apart[k].max((light[texel][c] - mean[c]).abs() / both);
                }
            }
        }
    }
    println!("{:.2} standard errors; without the lobes that are met {:.2}", apart[0], apart[1]);
    assert!(apart[0] <= 5.0, "{apart:?}");
    assert!(apart[1] > 8.0, "cannot fail: {apart:?}");
}

/// An eye changes only specular light: diffuse bounces use exit radiance by direction, which does not depend on the view. For an eye
/// far above, all light is that of a view from straight above, as the view directions differ by 1e-6 radians.
#[test]
fn only_specular_light_depends_on_the_eye() {
    let mut gpu = Device::new();
    let (scene, quality) = (lobed(), bounce_quality(2, BounceSpecular::Vector, 4));
    let limits = gpu.limits();
    let mut viewed = |eye_m| {
        let wanted = Picture { light_layers: true, eye_m, ..Picture::default() };
        gpu.outputs(&scene, &quality, &limits, wanted)
    };
    let [above, far, near] =
        [None, Some([2.0, 2.5, 4e6]), Some([12.0, -7.0, 3.0])].map(&mut viewed);
    let specular = ["radiance", "direct.specular", "indirect.specular"];
    for (i, from_above) in above.iter().enumerate() {
        let (name, values) = (&from_above.name, &from_above.values);
        let brightest = values.iter().fold(0.0_f32, |m, v| m.max(*v));
        assert!(brightest > 0.0, "{name}");
        let apart = |other: &[f32]| -> f32 {
            values.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
        };
        let [far, near] = [&far[i], &near[i]].map(|lit| apart(&lit.values));
        println!("{name}: {far:e} from far above, {near:e} from near, of {brightest}");
        if specular.contains(&name.as_str()) {
            // Series of order 4 change by a few times their brightest value per radian.
            assert!(far <= 1e-4 * brightest && near > 0.01 * brightest, "{name}: {far} {near}");
        } else {
            assert_eq!([far, near], [0.0; 2], "{name}");
        }
    }
}

/// A surface that reflects all light, half diffusely and half by Phong specular, in light of 1 from everywhere: no
/// texel is brighter than 1, as lobes cut by the own plane reflect less; level ground is not cut.
#[test]
fn specular_reflects_no_more_than_arrives() {
    let mut gpu = Device::new();
    let rough = field(12, 11, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64 / 3.0);
    let level = field(3, 4, [1.0, 1.0], |_, _| 2.0);
    for (field, is_level) in [(rough, false), (level, true)] {
        let mut scene = under_sky(field, Border::Open);
        scene.surface.albedo = Albedo::Constant([0.5; 3]);
        scene.surface.specular =
            Some(Specular::Constant(PhongSpecular { exponent: 9.0, scale: 0.5 }));
        let [light, _] = traced(&mut gpu, &scene, 64, 3, 2);
        // For each vertex one rounding of density, light and quotient.
        let slack = 64.0 * 1e-6;
        let brightest = light.iter().fold(0.0, |m: f64, l| m.max(l[0]));
        let darkest = light.iter().fold(2.0, |m: f64, l| m.min(l[0]));
        println!("{is_level}: {darkest} to {brightest}");
        assert!(brightest <= 1.0 + slack, "{brightest}");
        assert!(darkest >= if is_level { 1.0 - slack } else { 0.5 }, "{darkest}");
    }
}

/// With bounces, each layer of direct light has the bits that it has without them.
#[test]
fn bounces_leave_direct_light_as_it_is() {
    let mut gpu = Device::new();
    let mut scene = lobed();
    let phong = PhongSpecular { exponent: 20.0, scale: 0.4 };
    scene.surface.specular = Some(Specular::Constant(phong));
    scene.lights.sky = Some([0.5, 1.0, 1.5]);
    for storage in [BounceSpecular::Vector, BounceSpecular::VectorF16, BounceSpecular::Scalar] {
        let mut quality = Quality { basis: Basis::Auto, ..bounce_quality(2, storage, 4) };
        let bounced = drawn(&mut gpu, &scene, &quality);
        assert!(layer(&bounced, "indirect.specular").iter().any(|light| light[1] > 0.0));
        quality.bounces.count = 0;
        let direct = drawn(&mut gpu, &scene, &quality);
        let layers: Vec<_> = direct.iter().filter(|l| l.0.starts_with("direct.")).collect();
        assert_eq!(layers.len(), 3);
        for (name, light) in layers {
            assert!(layer(&bounced, name) == light, "{storage:?} {name}");
        }
    }
}

/// Without specular the plan is the diffuse one, pass for pass and byte for byte, and so is its light.
#[test]
fn specular_of_scale_zero_adds_nothing() {
    let mut gpu = Device::new();
    let mut scene = lobed();
    let quality = bounce_quality(2, BounceSpecular::Vector, 4);
    let mut plans = Vec::new();
    for scale in [None, Some(0.0)] {
        scene.surface.specular =
            scale.map(|scale| Specular::Constant(PhongSpecular { exponent: 5.0, scale }));
        let wanted = Picture { light_layers: true, ..Picture::default() };
        let plan = plan::picture(&scene, &quality, &gpu.limits(), wanted).expect("a plan");
        assert!(plan.find("arriving").is_none() && plan.find("indirect.specular").is_none());
        let passes: Vec<String> = plan.passes.iter().map(plan::Pass::label).collect();
        plans.push((passes, plan.bytes(), plan.constants, drawn(&mut gpu, &scene, &quality)));
    }
    assert!(plans[0] == plans[1]);
}

/// A texel of level ground among diffuse walls: its lobe of exponent 1 about the zenith is a cosine, so it reflects as
/// much of each bounce as diffuse ground, but for the bands of the cosine beyond the series: π times their integral by
/// magnitude, of light of 1 at most. The walls are diffuse, so scalars and vectors are alike.
#[test]
fn phong_exponent_one_is_a_cosine() {
    const MIDDLE: usize = 6 * 12 + 6;
    let mut gpu = Device::new();
    let yard = field(12, 12, [1.0, 1.0], |r, c| {
        if (3..9).contains(&r) && (3..9).contains(&c) { 0.0 } else { 6.0 }
    });
    let mut scene = under_sky(yard, Border::Open);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    let phong_specular =
        |i: usize| PhongSpecular { exponent: 1.0, scale: if i == MIDDLE { 0.25 } else { 0.0 } };
    scene.surface.specular = Some(Specular::Map((0..144).map(phong_specular).collect()));
    for order in [3, 6] {
        let missing = missing_cosine(order as usize);
        let mut first = 0.0;
        for specular in [BounceSpecular::Vector, BounceSpecular::VectorF16, BounceSpecular::Scalar]
        {
            let all = drawn(&mut gpu, &scene, &bounce_quality(2, specular, order));
            let [shiny, one, two] =
                ["indirect.specular", "indirect.1", "indirect.2"].map(|name| layer(&all, name));
            // Of 0.5 diffusely and 0.25 by the lobe; of the bounced light, at most 3/4 of the sky's 1.
            let want = 0.5 * (one[MIDDLE][0] + two[MIDDLE][0]);
            let off = (shiny[MIDDLE][0] - want).abs();
            // f32 is exact to 1e-5, f16 to half a thousandth.
            let rounded = if specular == BounceSpecular::VectorF16 { 1e-3 } else { 1e-5 };
            let bound = 0.25 * missing * 0.75 + rounded;
            println!("order {order}, {}: {off:.5} of {want:.4}, bound {bound:.4}", specular);
            assert!(off <= bound && want > 2.0 * bound, "{off} of {want}");
            let others = shiny.iter().enumerate().filter(|(i, _)| *i != MIDDLE);
            assert!(others.into_iter().all(|(_, v)| v[0] == 0.0), "lobes of nothing");
            first = if first == 0.0 { one[MIDDLE][0] } else { first };
            assert!((one[MIDDLE][0] - first).abs() <= rounded * first, "{first}");
        }
    }
}

/// ∫ |max(cos, 0) / π - its first bands| over the sphere.
fn missing_cosine(order: usize) -> f64 {
    const STEPS: u32 = 2000;
    let zonal = clamped_cosine(order);
    let width = PI / f64::from(STEPS);
    (0..STEPS)
        .map(|i| {
            let theta = width * (f64::from(i) + 0.5);
            let z = theta.cos();
            let polynomials = ridgelight_cpu::basis::nlp(order, z);
            let series: f64 =
                zonal.iter().zip(polynomials).map(|(c, p)| c * p / (2.0 * PI).sqrt()).sum();
            2.0 * theta.sin() * width * (z.max(0.0) - series).abs()
        })
        .sum()
}

/// Hills of specular scale four fifths, whose feet see their sides.
fn hills(lights: Lights) -> Scene {
    let wave = |i: usize| (PI * i as f64 / 4.0).cos();
    let hills = field(17, 17, [1.0, 1.0], |r, c| 1.8 * (wave(r) + wave(c)));
    let mut scene = under_sky(hills, Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.2; 3]);
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent: 5.0, scale: 0.8 }));
    scene.lights = lights;
    scene
}

/// RMSE of all bounced light of each quality, less the paths' noise, and that noise; both over the mean of the path-traced reference.
fn errors(gpu: &mut Device, scene: &Scene, qualities: &[Quality]) -> (Vec<f64>, f64) {
    const BATCHES: usize = 24;
    let [first, first_error] = traced_on(gpu, scene, Normals::Smooth, (0, 1), BATCHES);
    let [all, error] = traced_on(gpu, scene, Normals::Smooth, (2, 1), BATCHES);
    let count = all.len() as f64;
    let mean = |values: &[[f64; 3]]| values.iter().map(|v| v[0]).sum::<f64>() / count;
    let bounced = mean(&all) - mean(&first);
    let noise: f64 = first_error.iter().zip(&error).map(|(a, b)| a[0].powi(2) + b[0].powi(2)).sum();
    let mut off = |quality: &Quality| {
        let layers = drawn(gpu, scene, quality);
        let is_bounced = |name: &str| name.starts_with("indirect.");
        let mut squares = 0.0;
        for i in 0..all.len() {
            let own = layers.iter().filter(|(name, _)| is_bounced(name)).map(|(_, v)| v[i][0]);
            squares += (own.sum::<f64>() - (all[i][0] - first[i][0])).powi(2);
        }
        ((squares - noise).max(0.0) / count).sqrt() / bounced
    };
    let errors = qualities.iter().map(&mut off).collect();
    (errors, (noise / count).sqrt() / bounced)
}

/// Under a sky, bounces by direction have a smaller error than bounces by one number a texel, and either a smaller one than none, by more
/// than the Monte Carlo noise of the path-traced reference. Higher orders have smaller errors. Brute force of order 6 has a
/// smaller error than pyramids of order 4.
#[test]
fn radiance_by_direction_is_nearer_to_the_path_traced_reference() {
    let mut gpu = Device::new();
    let scene = hills(Lights { sky: Some([1.0; 3]), ..Lights::default() });
    let bounce_quality =
        |specular, order| Quality { method: Method::Auto, ..bounce_quality(2, specular, order) };
    let [coarse, vector] = [2, 4].map(|order| bounce_quality(BounceSpecular::Vector, order));
    let scalar = bounce_quality(BounceSpecular::Scalar, 4);
    let mut exact = bounce_quality(BounceSpecular::Vector, 6);
    exact.bounces.engine = BounceEngine::BruteForce;
    let (errors, spread) = errors(&mut gpu, &scene, &[coarse, vector, scalar, exact]);
    let [coarse, vector, scalar, exact] = errors[..] else { panic!("{errors:?}") };
    println!(
        "brute force {exact:.3}, vector {vector:.3}, of order 2 {coarse:.3}, scalar {scalar:.3} off; Monte Carlo noise {spread:.3}"
    );
    assert!(exact + spread < vector, "{exact} {vector}");
    assert!(vector + spread < coarse.min(scalar), "{vector} {coarse} {scalar}");
    assert!(scalar + spread < 1.0, "{scalar}");
}

/// Under key lights and sphere lights, bounces by direction of order 6 have a smaller error than bounces by one number a texel, and that a
/// smaller one than none, by more than the Monte Carlo noise of the path-traced reference.
#[test]
fn key_lights_and_sphere_lights_bounce_by_direction() {
    let mut gpu = Device::new();
    let key = KeyLight {
        azimuth_rad: 0.4,
        width_rad: 1.2,
        elevations_rad: [0.3, 0.9],
        radiance: [3.0; 3],
    };
    let sphere = SphereLight { position_m: [9.0, 5.0, 6.0], radius_m: 1.5, radiance: [5.0; 3] };
    for lights in [
        Lights { keys: vec![key], ..Lights::default() },
        Lights { sphere_lights: vec![sphere], ..Lights::default() },
    ] {
        let of = |specular| {
            let mut quality = Quality { sun_azimuths: 32, ..bounce_quality(2, specular, 6) };
            quality.bounces.engine = BounceEngine::BruteForce;
            quality.bounces.azimuths = 32;
            quality
        };
        let scene = hills(lights);
        let qualities = [of(BounceSpecular::Vector), of(BounceSpecular::Scalar)];
        let (errors, spread) = errors(&mut gpu, &scene, &qualities);
        println!(
            "vector {:.3}, scalar {:.3} off; Monte Carlo noise {spread:.3}",
            errors[0], errors[1]
        );
        assert!(errors[0] + spread < errors[1] && errors[1] + spread < 1.0, "{errors:?}");
    }
}
