//! Indirect light: walks, brute force, pyramids, nodes.

pub(crate) mod indirect;
pub(crate) mod nodes;

use ridgelight::plan::Picture;
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, HeightField, Levels, Lights, Lines, Quality, Receiver,
    Scene, Surface,
};

use crate::cpu_reference::{Case, Reference, Wanted, bowl, check_all, rough};
use crate::field;

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] = &[
    ("bounce_gather", indirect::bounce_gather),
    ("bounce_ground", indirect::bounce_ground),
    ("bounce_march", indirect::bounce_march),
    ("bounce_shade", nodes::bounce_shade),
    ("bounce_walk", indirect::bounce_walk),
    ("cache_gather", nodes::cache_gather),
    ("line_blocks", indirect::line_blocks),
    ("shade_expand", indirect::shade_expand),
    ("shade_reduce", indirect::shade_reduce),
];

/// `bounce_walk`: colours and grey, every border, lines half a cell and two cells apart, single texels and lines of
/// them, in batches; and valleys whose ground lies in blocks of up to 32 steps.
pub(crate) fn walks() -> Vec<Case> {
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
    let valley = |rows, cols, border| {
        let noise = rough(rows, cols, 38);
        let rise = |c: usize| 0.4 * (2.0 * c as f64 - cols as f64).abs();
        let heights =
            |r: usize, c: usize| rise(c) + 0.2 * f64::from(noise.heights_m()[r * cols + c] - 900.0);
        let map = (0..rows * cols).map(|i| [(i % 4) as f32 / 4.0, 1.0, (i % 9) as f32 / 8.0]);
        of(field(rows, cols, [1.0, 1.5], heights), border, Albedo::Map(map.collect()))
    };
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
            "walks, one texel",
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
        case("walks, a valley", valley(4, 420, Border::Plane), walked(1, 6, Lines::Cell), false),
        case(
            "walks, valleys",
            valley(9, 70, Border::Periodic),
            walked(1, 8, Lines::HalfCell),
            false,
        ),
    ]
}

/// `bounce_march`, and the passes of pyramids of radiance: colours and grey, every border, either storage and
/// receiver; uneven ground, and smooth where tolerances are least.
pub(crate) fn bounced_light() -> Vec<Case> {
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
    let by_cosine =
        case("a bowl, cosine receiver", bowl(13), Border::Plane, Pyramid, Levels::Stack);
    let by_cosine =
        Case { quality: Quality { receiver: Receiver::Cosine, ..by_cosine.quality }, ..by_cosine };
    vec![
        case("every visible interval, grey", rough(7, 9), Border::Plane, BruteForce, Levels::Stack),
        case(
            "every visible interval, colours",
            rough(6, 5),
            Border::Open,
            BruteForce,
            Levels::Stack,
        ),
        case(
            "every visible interval of a bowl",
            bowl(13),
            Border::Plane,
            BruteForce,
            Levels::Stack,
        ),
        case("radiance by a stack, grey", rough(11, 13), Border::Plane, Pyramid, Levels::Stack),
        case("radiance by a stack", rough(9, 12), Border::Open, Pyramid, Levels::Stack),
        case("radiance by levels", rough(10, 12), Border::Periodic, Pyramid, Levels::Pyramid),
        case("a bowl by levels", bowl(13), Border::Plane, Pyramid, Levels::Pyramid),
        by_cosine,
    ]
}

/// Bounces at every second or fourth texel, or from the second on at every fourth, the last ones among them: every engine,
/// colours and grey, visibility caches of one batch and of several.
pub(crate) fn node_cases() -> Vec<Case> {
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
        case("later walks at nodes, colours", (11, 14), Border::Open, (Sweep, 3, 1)),
        case("later walks at nodes, grey", (10, 13), Border::Periodic, (Sweep, 4, 1)),
        case("later walks at nodes, one column", (9, 1), Border::Open, (Sweep, 2, 1)),
        case("later walks at nodes, outside black", (2, 9), Border::Plane, (Sweep, 2, 1)),
        case("walks at nodes, outside black", (9, 11), Border::Plane, (Sweep, 1, 2)),
        case("every visible interval at nodes", (6, 7), Border::Open, (BruteForce, 1, 2)),
        case("pyramids at nodes", (10, 13), Border::Plane, (Pyramid, 1, 4)),
    ]
}

#[test]
fn walks_match_pass_by_pass() {
    check_all(&walks());
}

#[test]
fn bounces_match() {
    check_all(&bounced_light());
}

#[test]
fn bounces_at_nodes_match() {
    check_all(&node_cases());
}
