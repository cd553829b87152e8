//! Every form of the sweep, and the passes of a height pyramid.

pub(crate) mod pyramid;
pub(crate) mod sweep;

use ridgelight::scene::{
    Border, Fuse, HeightField, Hull, Levels, Lights, Lines, Method, Precision, Quality, Scene,
    Surface,
};

use crate::cpu_reference::{Case, Reference, Wanted, check, check_all, rough};
use crate::{Device, field};

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] = &[
    ("height_expand", pyramid::height_expand),
    ("height_reduce", pyramid::height_reduce),
    ("pyramid_march", pyramid::pyramid_march),
    ("height_transpose", sweep::height_transpose),
    ("horizon_sweep", sweep::horizon_sweep),
    ("surface_sweep", sweep::surface_sweep),
    ("horizon_march", sweep::horizon_march),
    ("sweep_fuse", sweep::sweep_fuse),
];

/// A dome, whose texels all stay on the hull, before a cliff that pops them: deeper than the 64 entries that a line
/// keeps in shared memory.
fn dome(rows: usize, cols: usize) -> HeightField {
    let middle = cols as f64 / 2.0;
    field(rows, cols, [1.0, 1.0], |r, c| {
        let x = (c as f64 - middle) / middle;
        let cliff = if c + 6 > cols { 9.0 * (c + 6 - cols) as f64 } else { 0.0 };
        (2.0 - x * x).sqrt() * middle + cliff + 0.25 * (r % 3) as f64
    })
}

fn horizons(
    name: &'static str,
    field: HeightField,
    border: Border,
    quality: Quality,
    distances: bool,
) -> Case {
    let surface = Surface { border, ..Surface::default() };
    let scene = Scene { field, surface, lights: Lights::default() };
    Case { name, scene, quality, wanted: Wanted::Horizons { distances }, loses_lines: false }
}

/// `horizon_sweep`: three hull storages, both kinds of entries, both kinds of slopes, all fuses.
pub(crate) fn sweeps() -> Vec<Case> {
    let base = Quality { azimuths: 12, ..Quality::default() };
    let packed = Quality { precision: Precision::Packed, ..base };
    let shared_slopes = Quality { hull: Hull::Shared, fuse: Fuse::Slopes, ..base };
    vec![
        horizons("private f32", rough(37, 23, 1), Border::Plane, base, true),
        horizons(
            "aimed-nearest, lines that follow lanes",
            rough(23, 37, 9),
            Border::Open,
            Quality { method: Method::Sweep, fuse: Fuse::AimedNearest, ..base },
            true,
        ),
        Case {
            loses_lines: true,
            ..horizons("shared f32", dome(13, 97), Border::Plane, shared_slopes, false)
        },
        horizons(
            "list f32",
            rough(18, 31, 2),
            Border::Periodic,
            Quality { hull: Hull::OccluderList, fuse: Fuse::Own, ..base },
            false,
        ),
        horizons(
            "private packed",
            rough(21, 26, 3),
            Border::Open,
            Quality { lines: Lines::HalfCell, fuse: Fuse::Aimed, ..packed },
            true,
        ),
        horizons(
            "shared packed",
            rough(29, 19, 4),
            Border::Plane,
            // Between lines two cells apart, every second texel is equally near to both.
            Quality { hull: Hull::Shared, lines: Lines::TwoCells, fuse: Fuse::Nearest, ..packed },
            false,
        ),
        horizons(
            "list packed",
            rough(14, 33, 5),
            Border::Plane,
            Quality { hull: Hull::OccluderList, fuse: Fuse::Nearest, ..packed },
            false,
        ),
        horizons(
            "aimed around",
            rough(23, 30, 7),
            Border::Plane,
            Quality { fuse: Fuse::AimedAround, ..base },
            true,
        ),
        horizons(
            "aimed around, periodic",
            rough(14, 16, 8),
            Border::Periodic,
            Quality { lines: Lines::TwoCells, fuse: Fuse::AimedAround, ..base },
            true,
        ),
        // At the edges lines cross nothing, and steps of kilometres must not make a slope of that.
        horizons(
            "aimed around, cells of kilometres",
            field(19, 22, [20_000.0, 15_000.0], |r, c| 9e3 * ((r * r + 5 * c) % 7) as f64),
            Border::Open,
            Quality { fuse: Fuse::AimedAround, ..base },
            true,
        ),
        horizons(
            "private f32, slopes f16",
            rough(25, 34, 6),
            Border::Open,
            Quality {
                lines: Lines::TwoCells,
                fuse: Fuse::Slopes,
                precision: Precision::F16,
                ..base
            },
            false,
        ),
    ]
}

/// `horizon_sweep` with one line per invocation: private and shared hulls, lines one and two cells apart, every border, and hulls that overflow their
/// storage.
pub(crate) fn one_line_sweeps() -> Vec<Case> {
    let base = Quality { azimuths: 12, ..Quality::default() };
    let private = Quality { hull: Hull::Private, ..base };
    let wide = Quality { lines: Lines::TwoCells, ..base };
    let case = |name, field, border, quality| Case {
        wanted: Wanted::GpuHorizons,
        ..horizons(name, field, border, quality, false)
    };
    vec![
        case("a line each", rough(37, 23, 41), Border::Plane, base),
        case("a line each, open", rough(26, 71, 42), Border::Open, private),
        case("a line each, periodic", rough(14, 18, 43), Border::Periodic, base),
        case("a line each, two cells apart", rough(43, 38, 44), Border::Plane, wide),
        case("a line each, one row", rough(1, 9, 45), Border::Plane, base),
        Case { loses_lines: true, ..case("a line each, lost", dome(13, 201), Border::Plane, base) },
        Case {
            loses_lines: true,
            ..case("a line each, lost in private memory", dome(13, 201), Border::Plane, private)
        },
    ]
}

/// `surface_sweep` and `horizon_march`: one value a texel, with its occluder.
pub(crate) fn texels() -> Vec<Case> {
    let exact = Quality { azimuths: 12, lines: Lines::Exact, ..Quality::default() };
    let brute = Quality { azimuths: 12, method: Method::BruteForce, ..Quality::default() };
    vec![
        horizons("exact", rough(17, 22, 7), Border::Plane, exact, true),
        horizons("exact, periodic", rough(9, 10, 8), Border::Periodic, exact, true),
        horizons("brute", rough(19, 14, 9), Border::Open, brute, true),
        horizons("brute, periodic", rough(10, 9, 10), Border::Periodic, brute, true),
    ]
}

/// The passes of a height pyramid: both stores, all borders, few and many levels an octave, and fields one or a few
/// texels wide, or with no level but themselves.
pub(crate) fn pyramids() -> Vec<Case> {
    let base = Quality { azimuths: 12, method: Method::Pyramid, ..Quality::default() };
    let steps =
        |levels, level_step, level_offset| Quality { levels, level_step, level_offset, ..base };
    let on = |name, field, border, quality| horizons(name, field, border, quality, false);
    use Levels::{Pyramid, Stack};
    vec![
        on("stack", rough(37, 23, 31), Border::Plane, steps(Stack, 3, 0)),
        on("stack, periodic", rough(11, 14, 32), Border::Periodic, steps(Stack, 2, 1)),
        on("levels", rough(23, 41, 33), Border::Open, steps(Pyramid, 4, 1)),
        on("levels, periodic", rough(13, 9, 34), Border::Periodic, steps(Pyramid, 5, 0)),
        on("levels, 16 an octave", rough(17, 31, 35), Border::Plane, steps(Pyramid, 16, 0)),
        // An octave of more workgroups than a row of its dispatch has.
        on(
            "levels, many workgroups",
            rough(19, 2500, 38),
            Border::Plane,
            Quality { azimuths: 4, ..steps(Pyramid, 4, 1) },
        ),
        on("levels, one texel across", rough(1, 29, 36), Border::Plane, steps(Pyramid, 1, 0)),
        on(
            "stack of a column that repeats",
            rough(23, 1, 37),
            Border::Periodic,
            steps(Stack, 1, 0),
        ),
        on("the field alone", rough(2, 3, 38), Border::Plane, steps(Stack, 4, 2)),
        on("one texel", rough(1, 1, 39), Border::Open, steps(Stack, 1, 0)),
    ]
}

#[test]
fn sweeps_in_every_form_match() {
    let mut device = Device::new();
    for case in sweeps().into_iter().chain(one_line_sweeps()) {
        let lost = check(&mut device, &case);
        assert_eq!(lost > 0, case.loses_lines, "{}: {lost} groups of lines redone", case.name);
    }
}

#[test]
fn sweeps_of_one_value_per_texel_match() {
    let mut device = Device::new();
    for case in texels() {
        check(&mut device, &case);
    }
}

#[test]
fn pyramids_match() {
    check_all(&pyramids());
}
