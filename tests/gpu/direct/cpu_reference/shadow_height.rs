//! Shadow heights.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::plan::azimuths::{CELL, across_sun};
use ridgelight::scene::{Border, HeightField, Lights, Quality, Scene, Sun, Surface};
use ridgelight_cpu::shadow_height::{Disc, shadow_heights};
use ridgelight_cpu::shadow_sweep::lines_of;
use ridgelight_cpu::shared::sweep::{Heights, March};
use ridgelight_cpu::tolerance::{ARC_TANGENT, EPSILON};

use crate::cpu_reference::{Case, Pair, Run, Wanted, check_all, pushed, rough};
use crate::field;

/// Suns in all octants, on an axis and on a diagonal; wide, narrow and points; high, low and cut by the horizontal. Fields alone,
/// in parts, and inside a coarser one.
pub(crate) fn cases() -> Vec<Case> {
    let case = |name,
                field: HeightField,
                (degrees, elevation_rad, diameter_rad): (f64, f64, f64),
                wanted| {
        let azimuth_rad = degrees.to_radians();
        let suns = vec![Sun { azimuth_rad, elevation_rad, diameter_rad, irradiance: [1.0; 3] }];
        let lights = Lights { suns, ..Lights::default() };
        let surface = Surface { border: Border::Plane, ..Surface::default() };
        let scene = Scene { field, surface, lights };
        Case { name, scene, quality: Quality::default(), wanted, loses_lines: false }
    };
    let alone = || Wanted::ShadowHeights(1, None);
    let inside = |parts| {
        let outer = field(20, 24, [9.0, 8.0], |r, c| 905.0 + 3.0 * ((r * 7 + c * 5) % 9) as f64);
        Wanted::ShadowHeights(parts, Some((outer, [1.25, 0.5])))
    };
    vec![
        case("shadow heights, from the east", rough(9, 13, 81), (0.0, 0.3, 0.2), alone()),
        case("shadow heights, on a diagonal", rough(12, 12, 82), (45.0, 0.5, 0.1), alone()),
        case("shadow heights of a point", rough(13, 10, 83), (118.0, 0.2, 0.0), alone()),
        case(
            "shadow heights, cut by the horizontal",
            rough(8, 70, 84),
            (170.0, 0.05, 0.3),
            alone(),
        ),
        case("shadow heights, at the zenith", rough(7, 9, 85), (200.0, 1.5, 0.2), alone()),
        case(
            "shadow heights in parts",
            rough(70, 81, 86),
            (251.0, 0.1, 0.05),
            Wanted::ShadowHeights(2, None),
        ),
        case("shadow heights inside others", rough(70, 64, 87), (290.0, 0.15, 0.1), inside(2)),
        case(
            "shadow heights inside others, from the north",
            rough(9, 65, 88),
            (82.0, 0.3, 0.02),
            inside(1),
        ),
        case("shadow heights of a lane", rough(1, 30, 89), (339.0, 0.4, 0.1), alone()),
    ]
}

/// Rounding errors: an interpolated height, 3 ε of the largest height. The rise of the ray, 2 ε of the rise, which is the shadow height over its
/// top. The interpolation of two lines, 3 ε of both. With an outer field, the position errs by 3 ε, which adds that error times the slope
/// of its shadow heights. Counts of steps err by 3 ε of the most.
pub(crate) fn shadow_height(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const EDGES: usize = offset("ShadowHeightPush", "edges");
    const DIAMETER_RAD: usize = offset("ShadowHeightPush", "diameter_rad");
    const STEP_M: usize = offset("ShadowHeightPush", "step_m");
    const OUTER_SIZE: usize = offset("ShadowHeightPush", "outer_size");
    const OUTER_ORIGIN: usize = offset("ShadowHeightPush", "outer_origin");
    const OUTER_STEP: usize = offset("ShadowHeightPush", "outer_step");
    const OUTER_BASE: usize = offset("ShadowHeightPush", "outer_base");
    const FIRST_GROUP: usize = offset("ShadowHeightPush", "first_group");
    let float = |at: usize| f64::from(f32::from_bits(pushed(pass, at)));
    let two = |at: usize| [float(at), float(at + 4)];
    let point = Sun { diameter_rad: 0.0, ..run.scene.lights.suns[0] };
    let azimuth = across_sun(&point, 1, run.scene.field.cell_m())[0];
    let march = March::new(Heights::of(&run.scene.field, Border::Plane), &azimuth);
    let disc = Disc { edges: two(EDGES), diameter_rad: float(DIAMETER_RAD), step_m: float(STEP_M) };
    let [mut largest, _] = run.relief();
    let [origin, step] = [two(OUTER_ORIGIN), two(OUTER_STEP)];
    let cols = pushed(pass, OUTER_SIZE) as usize;
    let outer = run.floats(pass, "outer_lit_above").zip(run.floats(pass, "outer_penumbra"));
    let mut misplaced = 0.0;
    if let Some((lit, wide)) = &outer {
        let most = lit.iter().chain(wide).fold(0.0, |m: f64, h| m.max(f64::from(h.abs())));
        largest = largest.max(most + float(OUTER_BASE).abs());
        misplaced = 3.0 * EPSILON * (lit.len() / cols + cols) as f64 * 4.0 * most;
    }
    let at = |place: [f64; 2]| {
        let (lit, wide) = outer.as_ref().expect("inside another field");
        let last = [cols - 1, lit.len() / cols - 1].map(|n| n as f64);
        let [x, y] = [0, 1].map(|i| (origin[i] + place[i] * step[i]).clamp(0.0, last[i]));
        let between = |all: &[f32]| {
            let h = |x: f64, y: f64| {
                f64::from(all[y.min(last[1]) as usize * cols + x.min(last[0]) as usize])
            };
            let (a, b) = (x.floor(), y.floor());
            let row = |y: f64| h(a, y) + (x - a) * (h(a + 1.0, y) - h(a, y));
            row(b) + (y - b) * (row(b + 1.0) - row(b))
        };
        [between(lit) + float(OUTER_BASE), between(wide)]
    };
    let wants = shadow_heights(&march, &disc, outer.is_some().then_some(&at));
    let names = ["lit_above", "penumbra", "sun_share"];
    let got = names.map(|name| run.floats(pass, name).expect("written"));
    let [width, _] = run.size();
    let (_, first) = lines_of(&march, march.steps);
    let groups =
        pushed(pass, FIRST_GROUP) as i32..(pushed(pass, FIRST_GROUP) + pass.groups[0]) as i32;
    let [lower, upper] = disc.rise_m();
    let mut pairs = Vec::new();
    let mut tight = 0;
    for (i, want) in wants.iter().enumerate() {
        let (lane, step) = march.of_grid_point((i % width) as i32, (i / width) as i32);
        let line = (lane * CELL - first - step * azimuth.shear).div_euclid(CELL);
        if !groups.contains(&(line / 63)) {
            continue;
        }
        let at = |k| [k, i / width, i % width];
        let error = |height: f64| 12.0 * EPSILON * (largest + height.abs()) + misplaced;
        let lit_above = want.shade_m[0];
        pairs.push(Pair {
            got: got[0][i].into(),
            want: lit_above,
            tolerance: error(lit_above),
            at: at(0),
        });
        // Of steps that an outer field gives as a width.
        let steps = |ahead: f64| 8.0 * EPSILON * ahead + misplaced / (upper - lower).max(1e-30);
        let penumbra = want.penumbra_m(&disc);
        let tolerance = steps(want.ahead[0]) * (upper - lower) + 4.0 * EPSILON * penumbra;
        pairs.push(Pair { got: got[1][i].into(), want: penumbra, tolerance, at: at(1) });
        // An occluder's slope errs by its height and by its distance, relatively; an angle by no more than its slope. The share changes
        // by at most 4/π of what is hidden.
        let slope = |k: usize| {
            let over = (want.shade_m[k] - want.ground_m).abs();
            let of_height = error(want.shade_m[k]) / (want.ahead[k] * disc.step_m);
            let of_steps = over * steps(want.ahead[k]) / (want.ahead[k].powi(2) * disc.step_m);
            of_height + of_steps + 8.0 * EPSILON * over / (want.ahead[k] * disc.step_m)
        };
        let is_zenith = disc.edges[1] > 1e8;
        let hidden = slope(0).max(if is_zenith { 0.0 } else { slope(1) })
            + 2.0 * ARC_TANGENT * disc.diameter_rad;
        let tolerance = match disc.diameter_rad {
            // Lit or not, where rounding does not decide.
            0.0 if (want.ground_m - lit_above).abs() > error(lit_above) => 0.0,
            0.0 => 1.0,
            diameter => 1.3 * hidden / diameter + ARC_TANGENT + 12.0 * EPSILON,
        };
        tight += usize::from(tolerance < 0.01);
        pairs.push(Pair { got: got[2][i].into(), want: want.share(&disc), tolerance, at: at(2) });
    }
    assert!(6 * tight > pairs.len(), "{tight} shares of {}", pairs.len() / 3);
    pairs
}

#[test]
fn shadow_heights_match_the_cpu_reference() {
    check_all(&cases());
}
