//! Indirect light: walks, brute force, pyramids, nodes, Phong specular.

use ridgelight::plan::Picture;
use ridgelight::scene::{
    Albedo, Basis, Border, BounceEngine, BounceSpecular, Bounces, HeightField, Levels, Lights,
    Lines, PhongSpecular, Quality, Receiver, Scene, Specular, Sun, Surface,
};

use super::{Case, Wanted, bowl, noisy_environment, rough};

/// `bounce_walk`: colours and grey, every border, lines half a cell and two cells apart, one sample and lines of them,
/// in batches.
pub(in crate::cpu_reference) fn walks() -> Vec<Case> {
    let base = Quality { azimuths: 8, ..Quality::default() };
    let walked = |count, azimuths, lines| {
        let (engine, cutoff) = (BounceEngine::Sweep, 0.0);
        let bounces = Bounces { count, engine, azimuths, cutoff, ..Bounces::default() };
        Quality { bounces, lines, ..base }
    };
    let of = |field: HeightField, border, albedo| Scene {
        field,
        surface: Surface { border, albedo, specular: None },
        lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
    };
    let colourful = {
        let map = (0..17 * 21).map(|i| [1.0, (i % 5) as f32 / 4.0, (i % 7) as f32 / 6.0]).collect();
        of(rough(17, 21, 31), Border::Open, Albedo::Map(map))
    };
    let grey = |field, border| of(field, border, Albedo::Constant([0.8; 3]));
    let case = |name, scene, quality, keeps_horizons| Case {
        name,
        scene,
        quality,
        wanted: Wanted::Picture(Picture {
            light_layers: true,
            keeps_horizons,
            ..Picture::default()
        }),
        loses_lines: false,
    };
    vec![
        case("walks, colours", colourful, walked(2, 13, Lines::HalfCell), false),
        case("walks, a bowl", grey(bowl(13), Border::Plane), walked(1, 12, Lines::Cell), false),
        case(
            "walks, periodic",
            grey(rough(10, 12, 32), Border::Periodic),
            walked(2, 8, Lines::Cell),
            true,
        ),
        case(
            "walks, wide lines",
            grey(rough(14, 11, 33), Border::Plane),
            walked(1, 12, Lines::TwoCells),
            true,
        ),
        case(
            "walks, one sample",
            grey(rough(1, 1, 34), Border::Plane),
            walked(1, 4, Lines::Cell),
            false,
        ),
        case(
            "walks, a row",
            grey(rough(1, 9, 35), Border::Plane),
            walked(1, 8, Lines::Cell),
            false,
        ),
    ]
}

/// `bounce_march`, and the passes of pyramids of radiance: colours and grey, every border, either storage and
/// receiver; uneven ground, and smooth where tolerances are least.
pub(in crate::cpu_reference) fn bounced_light() -> Vec<Case> {
    let case = |name, field: HeightField, border, engine, levels| {
        let (rows, cols) = (field.rows(), field.cols());
        let map = (0..rows * cols).map(|i| [1.0, (i % 5) as f32 / 4.0, 0.5]).collect();
        let albedo = match border {
            Border::Plane => Albedo::Constant([0.8; 3]),
            _ => Albedo::Map(map),
        };
        // Two of them along columns, along the field's edge too.
        let bounces = Bounces { count: 2, engine, azimuths: 6, cutoff: 0.0, ..Bounces::default() };
        Case {
            name,
            scene: Scene {
                field,
                surface: Surface { border, albedo, specular: None },
                lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
            },
            quality: Quality { azimuths: 8, bounces, levels, ..Quality::default() },
            wanted: Wanted::Picture(Picture { light_layers: true, ..Picture::default() }),
            loses_lines: false,
        }
    };
    use BounceEngine::{BruteForce, Pyramid};
    let rough = |rows, cols| rough(rows, cols, 36);
    let lobe = case("a bowl by a lobe", bowl(13), Border::Plane, Pyramid, Levels::Stack);
    let lobe = Case { quality: Quality { receiver: Receiver::Cosine, ..lobe.quality }, ..lobe };
    vec![
        case("every stretch, grey", rough(7, 9), Border::Plane, BruteForce, Levels::Stack),
        case("every stretch, colours", rough(6, 5), Border::Open, BruteForce, Levels::Stack),
        case("every stretch of a bowl", bowl(13), Border::Plane, BruteForce, Levels::Stack),
        case("radiance by a stack, grey", rough(11, 13), Border::Plane, Pyramid, Levels::Stack),
        case("radiance by a stack", rough(9, 12), Border::Open, Pyramid, Levels::Stack),
        case("radiance by levels", rough(10, 12), Border::Periodic, Pyramid, Levels::Pyramid),
        case("a bowl by levels", bowl(13), Border::Plane, Pyramid, Levels::Pyramid),
        lobe,
    ]
}

/// Bounces at every second or fourth sample, the last ones among them: every engine, colours and grey, visibility caches of
/// one batch and of several.
pub(in crate::cpu_reference) fn nodes() -> Vec<Case> {
    let case = |name, (rows, cols), border, (engine, count, subsample)| {
        let map = (0..rows * cols).map(|i| [1.0, (i % 5) as f32 / 4.0, 0.5]).collect();
        let albedo = match border {
            Border::Open => Albedo::Map(map),
            _ => Albedo::Constant([0.8; 3]),
        };
        let bounces = Bounces { count, engine, azimuths: 12, cutoff: 0.0, ..Bounces::default() };
        Case {
            name,
            scene: Scene {
                field: rough(rows, cols, 37),
                surface: Surface { border, albedo, specular: None },
                lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
            },
            quality: Quality { azimuths: 8, bounces, subsample, ..Quality::default() },
            wanted: Wanted::Picture(Picture { light_layers: true, ..Picture::default() }),
            loses_lines: false,
        }
    };
    use BounceEngine::{BruteForce, Pyramid, Sweep};
    vec![
        case("walks at nodes, colours", (14, 17), Border::Open, (Sweep, 3, 2)),
        case("walks at nodes, grey", (12, 8), Border::Periodic, (Sweep, 2, 4)),
        case("walks at nodes, outside black", (9, 11), Border::Plane, (Sweep, 1, 2)),
        case("every stretch at nodes", (6, 7), Border::Open, (BruteForce, 1, 2)),
        case("pyramids at nodes", (10, 13), Border::Plane, (Pyramid, 1, 4)),
    ]
}

/// Bounced Phong specular: series of odd and even orders, colours and grey, as f32 and f16, and one number a texel.
pub(in crate::cpu_reference) fn specular() -> Vec<Case> {
    let case = |name, field: HeightField, border, specular, sh_order, levels, lights| {
        let samples = field.heights_m().len();
        let is_map = specular == BounceSpecular::Vector;
        let lobe =
            |i: usize| PhongSpecular { exponent: (i % 40) as f32, scale: (i % 3) as f32 * 0.2 };
        let albedo = |i: usize| [0.5, (i % 5) as f32 / 10.0, 0.3];
        let (albedo, phong) = if is_map {
            (
                Albedo::Map((0..samples).map(albedo).collect()),
                Specular::Map((0..samples).map(lobe).collect()),
            )
        } else {
            (
                Albedo::Constant([0.5; 3]),
                Specular::Constant(PhongSpecular { exponent: 6.0, scale: 0.5 }),
            )
        };
        let bounces = Bounces {
            count: 2,
            engine: BounceEngine::Pyramid,
            // None along the field's edge, where a hair decides what is left.
            azimuths: 8,
            cutoff: 0.0,
            level_step: 2,
            level_offset: 0,
            specular,
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
    let sky = || Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let all = Lights {
        environment: Some(noisy_environment(51)),
        suns: vec![sun(2.0, 0.2, [3.0, 2.5, 2.0]), sun(-1.1, 0.0, [2.0; 3])],
        ..sky()
    };
    let alone = Lights { suns: vec![sun(0.4, 0.0, [2.0; 3])], ..Lights::default() };
    use BounceSpecular::{Scalar, Vector, VectorF16};
    let (stack, levels) = (Levels::Stack, Levels::Pyramid);
    vec![
        case("by direction", rough(9, 11, 52), Border::Plane, Vector, 3, stack, all.clone()),
        case(
            "by direction, f16, periodic",
            rough(8, 10, 53),
            Border::Periodic,
            VectorF16,
            4,
            levels,
            sky(),
        ),
        case("as seen from above", rough(10, 9, 54), Border::Open, Scalar, 2, levels, all),
        case("as seen from above, grey", rough(7, 9, 55), Border::Plane, Scalar, 3, stack, alone),
    ]
}
