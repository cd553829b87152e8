//! Phong specular: the suns' direct, and that of bounces.

pub(crate) mod bounced;
pub(crate) mod key;
pub(crate) mod slices;
pub(crate) mod sphere;
pub(crate) mod sun;

use ridgelight::plan::Picture;
use ridgelight::scene::{
    Albedo, Basis, Border, BounceEngine, BounceSpecular, Bounces, HeightField, Levels, Lights,
    PhongSpecular, Quality, Scene, Specular, SphereLight, Sun, Surface,
};

use crate::cpu_reference::{Case, Reference, Wanted, check_all, key, noisy_environment, rough};

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] = &[
    ("specular_tables", slices::specular_tables),
    ("mirror_map", slices::mirror_map),
    ("specular_light", slices::specular_light),
    ("sun_specular", sun::sun_specular),
    ("key_arriving", key::key_arriving),
    ("specular_exit", bounced::specular_exit),
    ("specular_gather", bounced::specular_gather),
    ("specular_visibility", bounced::specular_visibility),
    ("vector_reduce", bounced::vector_reduce),
];

/// Bounced Phong specular: series of odd and even orders, colours and grey, as f32 and f16, and one number a texel.
pub(crate) fn cases() -> Vec<Case> {
    let mut all = of_engine(
        BounceEngine::Pyramid,
        [
            "by direction",
            "by direction, f16, periodic",
            "by direction, with an eye",
            "by direction, f16, grey, with an eye",
            "as visible from above",
            "as visible from above, grey",
            "by direction, of a key light",
        ],
    );
    all.extend(of_engine(
        BounceEngine::BruteForce,
        [
            "by direction, brute force",
            "by direction, f16, periodic, brute force",
            "by direction, with an eye, brute force",
            "by direction, f16, grey, with an eye, brute force",
            "as visible from above, brute force",
            "as visible from above, grey, brute force",
            "by direction, of a key light, brute force",
        ],
    ));
    all
}

fn of_engine(engine: BounceEngine, names: [&'static str; 7]) -> Vec<Case> {
    let case = |name, field: HeightField, border, specular, sh_order, levels, lights| {
        let texels = field.heights_m().len();
        let is_map = specular == BounceSpecular::Vector;
        let phong_specular =
            |i: usize| PhongSpecular { exponent: (i % 40) as f32, scale: (i % 3) as f32 * 0.2 };
        let albedo = |i: usize| [0.5, (i % 5) as f32 / 10.0, 0.3];
        let (albedo, phong) = if is_map {
            (
                Albedo::Map((0..texels).map(albedo).collect()),
                Specular::Map((0..texels).map(phong_specular).collect()),
            )
        } else {
            (
                Albedo::Constant([0.5; 3]),
                Specular::Constant(PhongSpecular { exponent: 6.0, scale: 0.5 }),
            )
        };
        let all = Bounces { cutoff: 0.0, ..Bounces::default() };
        let bounces = Bounces {
            count: 2,
            engine,
            // None along the field's edge, where rounding decides.
            azimuths: 8,
            level_step: 2,
            level_offset: 0,
            specular,
            ..all
        };
        let base = Quality { azimuths: 8, level_step: 3, level_offset: 0, ..Quality::default() };
        Case {
            name,
            scene: Scene {
                field,
                surface: Surface { border, albedo, specular: Some(phong) },
                lights,
            },
            quality: Quality { basis: Basis::Sh, sh_order, levels, bounces, ..base },
            wanted: Wanted::Picture(Picture { light_layers: true, ..Picture::default() }),
            loses_lines: false,
        }
    };
    let sun = |azimuth_rad, diameter_rad, irradiance| Sun {
        azimuth_rad,
        elevation_rad: 0.6,
        diameter_rad,
        irradiance,
    };
    // Over the ground, which it may cut.
    let sphere = |x: f64, radius_m: f64, radiance| SphereLight {
        position_m: [x, 5.0, 906.0],
        radius_m,
        radiance,
    };
    let sky = || Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let all = Lights {
        environment: Some(noisy_environment(51)),
        suns: vec![sun(2.0, 0.2, [3.0, 2.5, 2.0]), sun(-1.1, 0.0, [2.0; 3])],
        keys: vec![key(0.2, 0.9, [1.0, 2.0, 0.5])],
        sphere_lights: vec![sphere(4.0, 3.5, [3.0, 2.0, 1.0]), sphere(14.0, 6.0, [0.5, 1.0, 2.0])],
        ..sky()
    };
    let alone = Lights { suns: vec![sun(0.4, 0.0, [2.0; 3])], ..Lights::default() };
    let keys = Lights { keys: vec![key(-0.5, 1.1, [2.0, 1.0, 0.5])], ..Lights::default() };
    let spheres = [sphere(5.0, 4.0, [2.0; 3]), sphere(-3.0, 8.0, [1.0; 3])];
    let spheres = Lights { sphere_lights: spheres.to_vec(), ..Lights::default() };
    let eye_m = Some([30.0, -40.0, 960.0]);
    let with_an_eye = |case: Case| Case {
        wanted: Wanted::Picture(Picture { light_layers: true, eye_m, ..Picture::default() }),
        ..case
    };
    use BounceSpecular::{Scalar, Vector, VectorF16};
    let (stack, levels) = (Levels::Stack, Levels::Pyramid);
    vec![
        case(names[0], rough(9, 11, 52), Border::Plane, Vector, 3, stack, all.clone()),
        case(names[1], rough(8, 10, 53), Border::Periodic, VectorF16, 4, levels, sky()),
        with_an_eye(case(names[2], rough(9, 11, 56), Border::Open, Vector, 4, levels, all.clone())),
        with_an_eye(case(names[3], rough(8, 9, 57), Border::Plane, VectorF16, 3, stack, spheres)),
        case(names[4], rough(10, 9, 54), Border::Open, Scalar, 2, levels, all),
        case(names[5], rough(7, 9, 55), Border::Plane, Scalar, 3, stack, alone),
        case(names[6], rough(8, 11, 58), Border::Periodic, Vector, 6, stack, keys),
    ]
}

#[test]
fn bounced_specular_matches() {
    check_all(&cases());
}
