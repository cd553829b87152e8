//! Suns at the extremes: on level ground, beside an edge.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, PI};

use ridgelight::plan::azimuths::across_sun;
use ridgelight::scene::{Border, Lights, Sun};
use ridgelight_cpu::tolerance::{ARC_TANGENT, EPSILON};

use super::lights::{PLACES, SIDE, level, light, probe};
use super::{Case, Method, field};

fn sun(azimuth_rad: f64, elevation_rad: f64, diameter_rad: f64) -> Sun {
    Sun { azimuth_rad, elevation_rad, diameter_rad, irradiance: [1.0; 3] }
}

/// Suns at 90° and at 0° on level ground, E = 1, exit radiance over π.
///
/// A point at the zenith: 1. A disc there of angular radius a: its directions' mean cosine is that of a
/// surface facing it: 1. A point at 0°: 0. A disc at 0°, of which half stands above the ground, of radiance
/// 1 / (π sin² a): ∫ sin ω over it is ∫ sin² θ dθ ∫ cos ψ dψ = a - sin a cos a, with θ from its middle
/// and ψ around it. Sums over n chords of a disc err by n^-3/2, the disc's own and that of its scale.
pub fn suns_on_level_ground(border: Border) -> Case {
    const RADIUS: f64 = 0.0046;
    let suns = vec![
        sun(0.4, FRAC_PI_2, 0.0),
        sun(0.4, FRAC_PI_2, 2.0 * RADIUS),
        sun(0.4, 0.0, 0.0),
        sun(0.4, 0.0, 2.0 * RADIUS),
    ];
    let lights = Lights { suns, ..Lights::default() };
    let expected =
        "points: 1/π and 0; discs of angular radius a: 1/π and (a - sin a cos a) / (π² sin² a)";
    let bound = "16 ε of it for points; 2 n^-3/2 of it for discs of n chords, and ε of their slopes' moments";
    let case =
        light("suns at 90° and at 0°", (expected, bound), (level(), border, lights), |found| {
            let half = (RADIUS - RADIUS.sin() * RADIUS.cos()) / (PI * RADIUS.sin().powi(2));
            let chords = 2.0 * f64::from(found.method.quality.sun_azimuths).powf(-1.5);
            // A chord's moments are differences of numbers of 1/2, weighed by 2 / (π a) over its height.
            let moments = 2.0 / (PI * RADIUS) * 8.0 * EPSILON;
            let right = [
                (1.0, 16.0 * EPSILON),
                (1.0, chords + 16.0 * EPSILON),
                (0.0, 0.0),
                (half, chords * half + moments),
            ];
            let mut probes = Vec::new();
            for (s, (light, bound)) in right.into_iter().enumerate() {
                let layer = format!("direct.sun{}", s + 1);
                probes.extend(PLACES.map(|[r, c]| {
                    probe(found.light(&layer, r, c), light / PI, bound / PI, [s, r, c])
                }));
            }
            probes
        });
    Case { refuses: suns_off_the_grid, ..case }
}

/// The top of an eastern slope of height 10 and 2.5 a cell: it casts the shadow.
const EDGE: usize = 48;

/// Point suns at 30° in the azimuths 0°, 45° and 90° and slightly beside them: the shadow of the edge reaches H cos φ
/// / tan 30° west. At 180°, on a periodic field, that of the plateau before it reaches as far east of its end, a cell
/// before the first column. Left out: four cells around either end. A texel uses the point where a neighbouring line
/// has hit the edge: with lines 2 cells apart 1 cell before it, at 3/4 of its height, which still hides the sun up to
/// 10.2 cells away at 45°; with lines 4 apart one of two stands on the top, up to 4 cells behind it, which hides it up
/// to 8.2. The shadow there ends at 12.2.
pub fn suns_along_the_grid(border: Border) -> Case {
    const HEIGHT: f64 = 10.0;
    let mut hairs = vec![0.0];
    if border == Border::Plane {
        hairs.extend([1e-12, -1e-12, 1e-6, -1e-6, 1e-3, -1e-3]);
    }
    let mut azimuths: Vec<f64> =
        [0.0, FRAC_PI_4, FRAC_PI_2].iter().flat_map(|a| hairs.iter().map(move |h| a + h)).collect();
    azimuths.push(PI);
    let suns: Vec<Sun> = azimuths.iter().map(|&azimuth| sun(azimuth, FRAC_PI_6, 0.0)).collect();
    let edge = field([SIDE; 2], [1.0, 1.0], |_, c| {
        (2.5 * (c as f64 + 4.0 - EDGE as f64)).clamp(0.0, HEIGHT)
    });
    let expected = "west of an edge of height H, in its shadow 0, out of it sin 30° / π, but for four cells around the end at H cos φ / tan 30°; where the field repeats, likewise east of it for a sun in the west";
    let bound = "in the shadow 0, out of it 16 ε of the light; pyramid: where the CPU reference's elevation is as far from the sun as it may err, for suns without a hair";
    let lights = Lights { suns: suns.clone(), ..Lights::default() };
    let beside = if border == Border::Plane { ", a hair beside," } else { "" };
    let name = format!("point suns at 0°, 45°, 90°{beside} and 180°");
    let case = light(name, (expected, bound), (edge, border, lights), move |found| {
        let repeats = found.scene.surface.border == Border::Periodic;
        let mut probes = Vec::new();
        for (s, azimuth) in azimuths.iter().enumerate() {
            let layer = format!("direct.sun{}", s + 1);
            let swept = across_sun(&suns[s], 1, [1.0, 1.0])[0];
            let reach = HEIGHT * azimuth.cos().abs() / FRAC_PI_6.tan();
            // Level ground, in rows from which a line at 45° meets the edge inside the field.
            for (row, col) in (40..60).flat_map(|row| (4..=EDGE - 6).map(move |col| (row, col))) {
                let is_lit = if found.reference.is_some() {
                    if s % hairs.len() != 0 {
                        continue;
                    }
                    found.reference_elevation(&swept, row, col).and_then(|(elevation, error)| {
                        let below = FRAC_PI_6 - elevation;
                        (below.abs() > error + ARC_TANGENT).then_some(below > 0.0)
                    })
                } else {
                    let away = if *azimuth < PI { EDGE - col } else { col + 1 };
                    let from_end = away as f64 - reach;
                    let is_shaded = *azimuth < PI || repeats;
                    (from_end.abs() >= 4.0 || !is_shaded).then_some(!is_shaded || from_end > 0.0)
                };
                let Some(is_lit) = is_lit else { continue };
                let light = if is_lit { FRAC_PI_6.sin() / PI } else { 0.0 };
                let value = found.light(&layer, row, col);
                probes.push(probe(value, light, 16.0 * EPSILON * light, [s, row, col]));
            }
        }
        probes
    });
    Case { refuses: suns_off_the_grid, ..case }
}

fn suns_off_the_grid(method: &Method) -> Option<&'static str> {
    method.is_exact().then_some(
        "`lines exact` with `suns`: found a sun, whose azimuths are no grid vectors, expected `method brute-force`, which is exact in every azimuth",
    )
}
