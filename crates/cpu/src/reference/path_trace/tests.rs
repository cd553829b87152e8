use super::*;
use ridgelight::scene::{Environment as Image, HeightField, Lights, Normals, SphereLight, Surface};

/// A level field of 3² grid points in this light.
fn scene(albedo: [f32; 3], lights: Lights) -> Scene {
    let field = HeightField::new(3, 3, &[0.0; 9], [1.0, 1.0], None).unwrap();
    Scene {
        field,
        surface: Surface { albedo: Albedo::Constant(albedo), ..Surface::default() },
        lights,
    }
}

/// Inside a sphere light of radiance 1 a ray adds that, then ground of albedo 0.3 that is in the same sphere: 1 + 0.3
/// · 1; or the sky behind it: 1 + 0.2.
#[test]
fn a_ray_sees_the_ball_that_it_leaves_and_what_is_behind_it() {
    let sphere = SphereLight { position_m: [1.0, 1.0, 0.0], radius_m: 9.0, radiance: [1.0; 3] };
    let lights = Lights { sky: Some([0.2; 3]), sphere_lights: vec![sphere], ..Lights::default() };
    let scene = scene([0.3; 3], lights);
    let tracer = Tracer::of(&scene, vec![[0.0; 3]; 9], (1, Normals::Flat, 0), true);
    assert!(tracer.most_arriving(1)[1] >= 1.3, "{:?}", tracer.most_arriving(1));
    // The last ray's ground is black.
    assert!((tracer.most_arriving(0)[1] - 1.2).abs() < 1e-6, "{:?}", tracer.most_arriving(0));
}

/// Almost straight above, a direction may belong to any column of the highest row, and to no other row: the largest
/// difference among them is in doubt, in any column.
#[test]
fn straight_above_every_column_is_in_doubt() {
    for bright in 0..8 {
        let texel = |i: usize| {
            if i == bright {
                [5.0; 3]
            } else if i < 8 {
                [1.0; 3]
            } else {
                [50.0; 3]
            }
        };
        let image = Image::new(8, 4, (0..32).map(texel).collect(), 0.3).unwrap();
        let scene = scene([0.5; 3], Lights { environment: Some(image), ..Lights::default() });
        let tracer = Tracer::of(&scene, vec![[0.0; 3]; 9], (0, Normals::Flat, 0), true);
        let mut environment = tracer.environment.unwrap();
        // Without importance sampling.
        environment.texels.iter_mut().for_each(|t| t[3] = 0.0);
        let mut traced = Traced::default();
        let e = [Near::ZERO.wider(1e-7), Near::ZERO.wider(1e-7), Near::of(1.0)];
        environment.towards(e, one(), &mut traced);
        assert_eq!(traced.doubts, [1, 0, 0], "{bright}");
        let off = traced.in_doubt[0];
        assert!((4.0..4.01).contains(&off), "column {bright}: {off}");
    }
}
