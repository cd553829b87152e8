//! Light of the whole sky at the extremes: on level ground, on slopes, in a trench.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use ridgelight::plan::Azimuth;
use ridgelight::scene::{Albedo, Border, Environment, HeightField, Lights};
use ridgelight_cpu::harmonics::{Harmonics, Visibility};
use ridgelight_cpu::tolerance::{ARC_TANGENT, EPSILON, ShadeError};

use super::{About, Asks, Case, Found, Probe, field, never, none, suns, white};

pub const SIDE: usize = 65;
/// A corner, an edge, the middle.
pub const PLACES: [[usize; 2]; 3] = [[0, 0], [30, 64], [32, 32]];
/// Columns and rows of every environment here.
const COLUMNS: usize = 64;
const ROWS: usize = 32;

/// Every kind of light on every border, all its values on one of them. Periodic slopes are trenches.
pub fn cases() -> Vec<Case> {
    let mut all = vec![albedo(0.0), albedo(1.0)];
    all.extend([0.0, 1.0, 65_504.0, 1e6].map(|of| uniform_environment(of, Border::Plane)));
    all.push(slope_under_the_sky(1e-6, [SIDE; 2], Border::Plane));
    all.push(level_of([1, 1], Border::Plane));
    for border in [Border::Plane, Border::Open, Border::Periodic] {
        all.push(uniform_environment(1e30, border));
        if border == Border::Periodic {
            all.extend([[1, 31], [31, 1]].map(|of| level_of(of, border)));
        } else {
            all.push(peak(border));
            all.push(slope_under_the_sky(1e6, [SIDE; 2], border));
            all.extend([[1, 31], [31, 1]].map(|of| slope_under_the_sky(0.5, of, border)));
        }
        all.push(voids(border));
        all.push(trench(border));
        all.push(suns::suns_on_level_ground(border));
        all.push(suns::suns_along_the_grid(border));
    }
    all
}

pub fn light(
    name: impl Into<String>,
    (expected, bound): (&str, &str),
    (field, border, lights): (HeightField, Border, Lights),
    probes: impl Fn(&Found) -> Vec<Probe> + 'static,
) -> Case {
    let border_name = match border {
        Border::Plane => "",
        Border::Open => ", nothing beyond",
        Border::Periodic => ", repeated",
    };
    Case {
        name: format!("{}{border_name}", name.into()),
        about: About::Horizons,
        expected: expected.into(),
        bound: bound.into(),
        scene: white(field, border, lights),
        asks: Asks::Light,
        probes: Box::new(probes),
        refuses: never,
        unjudged: none,
        is_long: |_| false,
    }
}

pub fn level() -> HeightField {
    field([SIDE; 2], [1.0, 1.0], |_, _| 3.0)
}

fn uniform(value: f32) -> Environment {
    Environment::new(COLUMNS, ROWS, vec![[value; 3]; COLUMNS * ROWS], 1.0).expect("good texels")
}

/// A sky of radiance 1 and an environment, together: one pass lights both.
fn around(environment: Environment) -> Lights {
    Lights { sky: Some([1.0; 3]), environment: Some(environment), ..Lights::default() }
}

/// The sky on level ground: wedges sum to 2π, each of four products and a sum of at most 1.
fn sky_error(found: &Found) -> f64 {
    (8.0 + 2.0 * found.count()) * EPSILON
}

/// An environment of 64 × 32 texels in `found.count()` wedges, relative to its light on level ground. A wedge's ends
/// err by 64 ε columns, of its 64/m: 2 m ε, then 64/m + 2 sums; rows by 6 ε of a moment of 1/2 that is their sum, at
/// either end, 16 of them above ground: 2·2·16 ε; as many sums, m wedges, and 10 ε of products. Under an open border
/// there are 16 more below.
fn environment_error(found: &Found) -> f64 {
    let m = found.count();
    let rows = if is_open(found) { 160.0 } else { 80.0 };
    (2.0 * m + 64.0 / m + 2.0 + rows + m + 10.0) * EPSILON
}

fn is_open(found: &Found) -> bool {
    found.scene.surface.border == Border::Open
}

/// A table of an even environment that is read between nodes Δ apart in the sine, above directions of at most this slope. The
/// part between them is right for the vertical moment; for the horizontal one it takes the cosine to fall evenly: off by Δ²/6 of its
/// second derivative, 1/cos³, but by no more than √(8Δ/9), the cosine's mean in the highest step; over Δ, over 2π / π. Nodes stand
/// from the horizon, or under an open border from straight below, up to the zenith.
fn between_nodes(found: &Found, slope: f64) -> f64 {
    let range = if is_open(found) { 2.0 } else { 1.0 };
    let step: f64 = range / f64::from(found.method.quality.table_elevations - 1);
    let falls = step.powi(2) / 6.0 * 1.0_f64.hypot(slope).powi(3);
    2.0 * step * falls.min((8.0 / 9.0 * step).sqrt())
}

/// The same where level ground is the lowest visible elevation: a node, but under an open border.
fn at_level(found: &Found) -> f64 {
    if is_open(found) { between_nodes(found, 0.0) } else { 0.0 }
}

/// Light of the environment by the same series in f64, and the device's bound: on a plane with these slopes to east
/// and north, whose horizons err by `slope_error`.
fn series(found: &Found, [east, north]: [f64; 2], slope_error: f64) -> [f64; 2] {
    let least = if is_open(found) { f64::NEG_INFINITY } else { 0.0 };
    let rise = |a: &Azimuth| east * f64::from(a.cos_phi) + north * f64::from(a.sin_phi);
    let lowest: Vec<_> = found.azimuths.iter().map(|a| (*a, rise(a).max(least))).collect();
    series_above(found, DVec3::new(-east, -north, 1.0).normalize(), &lowest, slope_error)
}

/// The same above these slopes. Heights that are whole multiples of a number have gradients without error.
fn series_above(
    found: &Found,
    normal: DVec3,
    lowest: &[(Azimuth, f64)],
    slope_error: f64,
) -> [f64; 2] {
    let quality = &found.method.quality;
    let environment = found.scene.lights.environment.as_ref().expect("an environment");
    let harmonics = Harmonics::of(Some(environment), None, found.scene.surface.border, quality);
    let error = ShadeError::new(slope_error, 0.0, 1.0, found.azimuths.len());
    let mut visible = harmonics.visibility(lowest, &error);
    if quality.subsample > 1 {
        visible = Visibility::between([(&visible, 1.0)].into_iter(), &error);
    }
    let [light, off] = harmonics.light(normal, &visible, &error);
    [light.x, off.x]
}

/// The light of a constant environment on level ground, and its bound: all of its radiance, by [`environment_error`]
/// and interpolation between nodes; of a series, by that; where wedges smooth it, the part that the series keeps.
fn constant(found: &Found, radiance: f64) -> [f64; 2] {
    if !found.method.is_soft() {
        return [radiance, radiance * (environment_error(found) + at_level(found))];
    }
    let [light, bound] = series(found, [0.0; 2], 0.0);
    [if found.method.rounds_wedges() { light } else { radiance }, bound]
}

pub fn probe(found: f64, expected: f64, bound: f64, at: [usize; 3]) -> Probe {
    Probe { found, expected: [expected; 2], bound, at }
}

/// Level ground reflects its albedo's share of light from all around: L = ρ (1 + 1).
fn albedo(albedo: f32) -> Case {
    let expected = "under a sky of 1 and an environment of 1, level: 2 ρ";
    let bound =
        "ρ times the sky's and the environment's below, and 2 ε a light; harmonics: the series'";
    let mut case = light(
        format!("albedo {albedo}"),
        (expected, bound),
        (level(), Border::Plane, around(uniform(1.0))),
        move |found| {
            let albedo = f64::from(albedo);
            let [light, error] = constant(found, 1.0);
            let bound = albedo * (sky_error(found) + error + 4.0 * EPSILON);
            let right = albedo * (1.0 + light);
            let at =
                |[r, c]: [usize; 2]| probe(found.light("radiance", r, c), right, bound, [0, r, c]);
            PLACES.map(at).into()
        },
    );
    case.scene.surface.albedo = Albedo::Constant([albedo; 3]);
    case
}

/// A constant environment is a uniform sky: level ground of albedo 1 has its radiance. The sky beside it is unchanged.
fn uniform_environment(value: f32, border: Border) -> Case {
    let name = format!("an environment of {value:e} everywhere");
    let expected = "level: its radiance, and 1 of the sky beside it";
    let bound = "sky: (8 + 2 m) ε; environment: (3 m + 64 / m + 92) ε of its radiance; open: 80 ε and the table's between two elevations more; harmonics: the series'";
    light(name, (expected, bound), (level(), border, around(uniform(value))), move |found| {
        let value = f64::from(value);
        let [right, bound] = constant(found, value);
        let at = |[r, c]: [usize; 2]| {
            [
                probe(found.light("direct.sky", r, c), 1.0, sky_error(found), [0, r, c]),
                probe(found.light("direct.env", r, c), right, bound, [1, r, c]),
            ]
        };
        PLACES.map(at).as_flattened().to_vec()
    })
}

/// One texel between the zenith angles a and b: ∫∫ L cos θ sin θ dθ dφ / π = L Δφ (sin² b - sin² a) / 2π.
///
/// It is 1/64 of a turn wide, in two wedges perhaps, whose ends each err by 64 ε columns: 4·64 ε. Its row
/// is the difference of two moments of at most 1/2 that err by 6 ε each, in a bend that errs by as much:
/// 12 ε / (sin² b - sin² a).
fn peak(border: Border) -> Case {
    let mut texels = vec![[0.0; 3]; COLUMNS * ROWS];
    texels[8 * COLUMNS + 10] = [1e6; 3];
    let peak = Environment::new(COLUMNS, ROWS, texels, 0.0).expect("good texels");
    let [a, b] = [8.0, 9.0].map(|row: f64| (PI * row / ROWS as f64).sin().powi(2));
    let expected = "level: L Δφ (sin² b - sin² a) / 2π, no more and no less; harmonics: what the series keeps of it, in f64";
    let bound = "(256 + 12 / (sin² b - sin² a)) ε of it, and the environment's of a constant one; harmonics: the series'";
    light(
        "an environment of one texel of 1e6",
        (expected, bound),
        (level(), border, around(peak)),
        move |found| {
            let right = 1e6 * (TAU / COLUMNS as f64) * (b - a) / TAU;
            let relative = (256.0 + 12.0 / (b - a)) * EPSILON + environment_error(found);
            let [right, bound] = match found.method.is_soft() {
                true => series(found, [0.0; 2], 0.0),
                false => [right, right * relative],
            };
            let at = |[r, c]: [usize; 2]| {
                probe(found.light("direct.env", r, c), right, bound, [1, r, c])
            };
            PLACES.map(at).into()
        },
    )
}

/// A plane on level ground sees (1 + cos tilt) / 2 of the sky, at any steepness; without surroundings, and with light
/// from below, all of its own hemisphere.
///
/// Azimuths: the sum stops at wedge middles where the own plane begins to occlude; half a wedge is missed or added at
/// each of two ends, where the light is that of its angle, (π/m)² sin(tilt) in all. Elevations that err by an angle
/// move the slices' ends, where the integrand is at most 1, over 2π / π. The table is interpolated between nodes. In
/// harmonics azimuths represent their wedges: (2π/m)²/24 of the horizontal part.
fn slope_under_the_sky(slope: f64, [rows, cols]: [usize; 2], border: Border) -> Case {
    // Uphill east, or north in a single column.
    let uphill = if cols > 1 { [slope, 0.0] } else { [0.0, slope] };
    let tilted = field([rows, cols], [1.0, 1.0], |r, c| {
        uphill[0] * c as f64 + uphill[1] * (rows - 1 - r) as f64
    });
    let expected = match border {
        Border::Open => "all of the sky of 1 and of the environment of 1 above its own plane: 1",
        _ => "(1 + cos tilt) / 2 of the sky of 1 and of the environment of 1",
    };
    let bound = "(π/m)² sin tilt + 2 δ + the level ground's; environment: + the table's between two elevations besides, harmonics: + (2π/m)² / 24 and the series'; δ: the method's, at one cell";
    let name = match [rows, cols] {
        [SIDE, SIDE] => format!("light on a slope of {slope:e}"),
        _ => format!("light on a slope of {slope:e} of {rows} × {cols}"),
    };
    let (row, col) = (rows / 2, cols / 2);
    light(name, (expected, bound), (tilted, border, around(uniform(1.0))), move |found| {
        let cos_tilt = 1.0 / 1.0_f64.hypot(slope);
        let right = if is_open(found) { 1.0 } else { 0.5 * (1.0 + cos_tilt) };
        let largest = slope * (rows.max(cols) / 2) as f64;
        // A single line of texels has no neighbour.
        let ties = if rows.min(cols) == 1 { 0.0 } else { found.method.ties(slope, 1.0) };
        let angle = found.method.angle_error(slope, (largest, 1.0), ties, &found.azimuths[0]);
        let wedge = (PI / found.count()).powi(2) * slope.atan().sin();
        let sky = wedge + 2.0 * (angle + ARC_TANGENT) + sky_error(found);
        let [light, environment] = match found.method.is_soft() {
            true if found.method.rounds_wedges() => series(found, uphill, angle),
            true => {
                let error = series(found, uphill, angle)[1];
                [right, sky + (TAU / found.count()).powi(2) / 24.0 + error]
            }
            false => [right, sky + between_nodes(found, slope) + environment_error(found)],
        };
        vec![
            probe(found.light("direct.sky", row, col), right, sky, [0, row, col]),
            probe(found.light("direct.env", row, col), light, environment, [1, row, col]),
        ]
    })
}

/// Level ground of any size reflects the light from all around.
fn level_probes(found: &Found, places: &[[usize; 2]]) -> Vec<Probe> {
    let [right, bound] = constant(found, 1.0);
    let at = |&[r, c]: &[usize; 2]| {
        [
            probe(found.light("direct.sky", r, c), 1.0, sky_error(found), [0, r, c]),
            probe(found.light("direct.env", r, c), right, bound, [1, r, c]),
        ]
    };
    places.iter().flat_map(at).collect()
}

const LEVEL: (&str, &str) = (
    "under a sky of 1 and an environment of 1, level: 1 of each",
    "the sky's and the environment's of level ground; harmonics: the series'",
);

fn level_of([rows, cols]: [usize; 2], border: Border) -> Case {
    let places = [[0, 0], [rows / 2, cols / 2], [rows - 1, cols - 1]];
    let ground = field([rows, cols], [1.0, 1.0], |_, _| 3.0);
    let name = format!("light on level ground of {rows} × {cols}");
    light(name, LEVEL, (ground, border, around(uniform(1.0))), move |found| {
        level_probes(found, &places)
    })
}

/// Level ground with voids, which are filled from it; their contents are never read.
pub fn filled_voids() -> HeightField {
    let is_void = |r: usize, c: usize| (28..=36).contains(&r) && (4..20).contains(&c) || r < 5;
    let marks: Vec<bool> = (0..SIDE * SIDE).map(|i| is_void(i / SIDE, i % SIDE)).collect();
    let height = |i: usize| if marks[i] { [f64::NAN, f64::INFINITY][i % 2] } else { 3.0 };
    let heights: Vec<f64> = (0..SIDE * SIDE).map(height).collect();
    HeightField::new(SIDE, SIDE, &heights, [1.0, 1.0], Some(marks)).expect("a good field")
}

fn voids(border: Border) -> Case {
    let name = "light beside voids of NaN and infinities";
    light(name, LEVEL, (filled_voids(), border, around(uniform(1.0))), |found| {
        level_probes(found, &[[5, 0], [32, 3], [32, 20], [27, 12], [64, 64]])
    })
}

/// A plateau of height 10 west of level ground, whose edge stands 28 cells west of the texel and, on a periodic field,
/// another as far east. In an azimuth φ that reaches it inside the field it stands at tan ω = 10 |cos φ| / 28, and
/// cos² ω of the sky is visible: a wedge's share of the circle times that, summed.
///
/// A sweep uses points of lines: it hits the top up to a step, one cell, beyond its edge, from a line up to half their
/// distance aside. The interval covers both.
fn trench(border: Border) -> Case {
    const SIDE: usize = 64;
    const HEIGHT: f64 = 10.0;
    const AWAY: f64 = 28.0;
    const PLACE: [usize; 2] = [32, 36];
    let ground = field([SIDE; 2], [1.0, 1.0], |_, c| if c <= 8 { HEIGHT } else { 0.0 });
    let expected = match border {
        Border::Periodic => {
            "level between two edges of height H, each D away: the sum over azimuths of their share times 1 / (1 + (H cos φ / D)²), D within a step and half the lines' distance for sweeps"
        }
        _ => {
            "level beside an edge of height H, D away: as between two, but for azimuths that leave the field before it, which see all"
        }
    };
    let bound = "2 δ + the level ground's; environment: + the table's between two elevations besides, harmonics: the series'; δ: the method's, at D; pyramid: as the CPU reference's elevations see";
    let name = "light in a trench";
    light(name, (expected, bound), (ground, border, around(uniform(1.0))), move |found| {
        let [row, col] = PLACE;
        let periodic = found.scene.surface.border == Border::Periodic;
        let aside = found.method.aside();
        let mut angle = found.method.angle_error(
            HEIGHT / AWAY,
            (HEIGHT, AWAY - aside),
            0.0,
            &found.azimuths[0],
        );
        // The slope of the edge in an azimuth, so far away.
        let slope = |azimuth: &Azimuth, away: f64| {
            let (sin, cos) = azimuth.swept_rad([1.0, 1.0]).sin_cos();
            // 32 rows north, 31 south.
            let is_inside = cos < -1e-9 && AWAY * (sin / cos).abs() < 31.0;
            let meets = if periodic { cos.abs() > 1e-9 } else { is_inside };
            if meets { HEIGHT * cos.abs() / away } else { 0.0 }
        };
        let ends = [AWAY - aside, AWAY + aside];
        let mut right = [0.0; 2];
        for azimuth in &found.azimuths {
            let share = f64::from(azimuth.wedge_rad) / TAU;
            if let Some((elevation, error)) = found.reference_elevation(azimuth, row, col) {
                angle = angle.max(error);
                right.iter_mut().for_each(|sum| *sum += share * elevation.cos().powi(2));
                continue;
            }
            for (sum, away) in right.iter_mut().zip(ends) {
                *sum += share / (1.0 + slope(azimuth, away).powi(2));
            }
        }
        let sky = 2.0 * (angle + ARC_TANGENT) + sky_error(found);
        let series = |away: f64| {
            let lowest: Vec<_> = found.azimuths.iter().map(|a| (*a, slope(a, away))).collect();
            series_above(found, DVec3::Z, &lowest, angle)
        };
        let (light, environment) = match found.method.is_soft() {
            // The nearer the edge, the less sky is visible.
            true if found.method.rounds_wedges() => {
                let [near, far] = ends.map(series);
                ([near[0], far[0]], near[1].max(far[1]))
            }
            true => (right, sky + series(AWAY)[1]),
            false => {
                (right, sky + between_nodes(found, HEIGHT / ends[0]) + environment_error(found))
            }
        };
        let of = |layer: &str, expected, bound, at| Probe {
            found: found.light(layer, row, col),
            expected,
            bound,
            at,
        };
        vec![
            of("direct.sky", right, sky, [0, row, col]),
            of("direct.env", light, environment, [1, row, col]),
        ]
    })
}
