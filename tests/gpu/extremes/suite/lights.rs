//! Light at the extremes: on level ground, on slopes, behind an edge.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, PI, TAU};

use glam::DVec3;
use ridgelight::measure::harmonics::{Harmonics, Seen};
use ridgelight::measure::tolerance::{ARC_TANGENT, EPSILON, ShadeError};
use ridgelight::plan::Azimuth;
use ridgelight::scene::{Albedo, Environment, HeightField, Lights, Sun};

use super::{Asks, Case, Found, Method, Probe, field, never, white};

const SIDE: usize = 65;
/// A corner, an edge, the middle.
const PLACES: [[usize; 2]; 3] = [[0, 0], [30, 64], [32, 32]];
/// Columns and rows of every environment here.
const COLUMNS: usize = 64;
const ROWS: usize = 32;

pub fn cases() -> Vec<Case> {
    let mut all = vec![albedo(0.0), albedo(1.0)];
    all.extend([0.0, 1.0, 65_504.0, 1e6, 1e30].map(uniform_environment));
    all.push(peak());
    all.extend([1e-6, 1e6].map(slope_under_the_sky));
    all.push(suns_on_level_ground());
    all.push(suns_along_the_grid());
    all
}

fn light(
    name: impl Into<String>,
    (expected, bound): (&str, &str),
    (field, lights): (HeightField, Lights),
    probes: impl Fn(&Found) -> Vec<Probe> + 'static,
) -> Case {
    Case {
        name: name.into(),
        expected: expected.into(),
        bound: bound.into(),
        scene: white(field, lights),
        asks: Asks::Light,
        probes: Box::new(probes),
        refuses: never,
        is_long: |_| false,
    }
}

fn level() -> HeightField {
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

/// An environment of 64 × 32 texels of `found.count()` wedges, relative to what it gives to level
/// ground. A wedge's ends err by 64 ε columns, of its 64/m: 2 m ε, then 64/m + 2 sums; rows by 6 ε of
/// a moment of 1/2 that is their sum, at either end, 16 of them above ground: 2·2·16 ε; as many
/// sums, m wedges, and 10 ε of products.
fn environment_error(found: &Found) -> f64 {
    let m = found.count();
    (2.0 * m + 64.0 / m + 2.0 + 64.0 + 16.0 + m + 10.0) * EPSILON
}

/// Light of the environment by the same series in f64, and how far a device may be from it: on a plane that
/// rises by `slope` towards east, whose horizons err by `slope_error`. Heights that are whole multiples of a
/// number have gradients without error.
fn series(found: &Found, slope: f64, slope_error: f64) -> [f64; 2] {
    let quality = &found.method.quality;
    let environment = found.scene.lights.environment.as_ref().expect("an environment");
    let harmonics = Harmonics::new(environment, found.scene.surface.border, quality);
    let error = ShadeError::new(slope_error, 0.0, 1.0, found.azimuths.len());
    let rise = |a: &Azimuth| (*a, (slope * f64::from(a.cos_phi)).max(0.0));
    let lowest: Vec<_> = found.azimuths.iter().map(rise).collect();
    let mut seen = harmonics.seen(&lowest, &error);
    if quality.subsample > 1 {
        seen = Seen::between([(&seen, 1.0)].into_iter(), &error);
    }
    let [light, off] = harmonics.light(DVec3::new(-slope, 0.0, 1.0).normalize(), &seen, &error);
    [light.x, off.x]
}

/// [`environment_error`], or of a series that is a constant everywhere.
fn constant_error(found: &Found) -> f64 {
    if found.method.is_soft() { series(found, 0.0, 0.0)[1] } else { environment_error(found) }
}

fn probe(found: f64, expected: f64, bound: f64, at: [usize; 3]) -> Probe {
    Probe { found, expected: [expected; 2], bound, at }
}

/// Level ground gives back its albedo's share of what shines all around: L = ρ (1 + 1).
fn albedo(albedo: f32) -> Case {
    let expected = "under a sky of 1 and an environment of 1, level: 2 ρ";
    let bound =
        "ρ times the sky's and the environment's below, and 2 ε a light; harmonics: the series'";
    let mut case = light(
        format!("albedo {albedo}"),
        (expected, bound),
        (level(), around(uniform(1.0))),
        move |found| {
            let albedo = f64::from(albedo);
            let bound = albedo * (sky_error(found) + constant_error(found) + 4.0 * EPSILON);
            let at = |[r, c]: [usize; 2]| {
                probe(found.light("radiance", r, c), 2.0 * albedo, bound, [0, r, c])
            };
            PLACES.map(at).into()
        },
    );
    case.scene.surface.albedo = Albedo::Constant([albedo; 3]);
    case
}

/// A constant environment is a uniform sky: level ground of albedo 1 gives its radiance. The sky
/// beside it stays what it is.
fn uniform_environment(value: f32) -> Case {
    let name = format!("an environment of {value:e} everywhere");
    let expected = "level: its radiance, and 1 of the sky beside it";
    let bound = "sky: (8 + 2 m) ε; environment: (3 m + 64 / m + 92) ε of its radiance; harmonics: the series'";
    light(name, (expected, bound), (level(), around(uniform(value))), move |found| {
        let value = f64::from(value);
        // A series' is of the light itself.
        let of_light = if found.method.is_soft() { 1.0 } else { value };
        let bound = of_light * constant_error(found);
        let at = |[r, c]: [usize; 2]| {
            [
                probe(found.light("direct.sky", r, c), 1.0, sky_error(found), [0, r, c]),
                probe(found.light("direct.env", r, c), value, bound, [1, r, c]),
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
fn peak() -> Case {
    let mut texels = vec![[0.0; 3]; COLUMNS * ROWS];
    texels[8 * COLUMNS + 10] = [1e6; 3];
    let peak = Environment::new(COLUMNS, ROWS, texels, 0.0).expect("good texels");
    let [a, b] = [8.0, 9.0].map(|row: f64| (PI * row / ROWS as f64).sin().powi(2));
    let expected = "level: L Δφ (sin² b - sin² a) / 2π, no more and no less; harmonics: what the series keeps of it, in f64";
    let bound = "(256 + 12 / (sin² b - sin² a)) ε of it, and the environment's of a constant one; harmonics: the series'";
    light(
        "an environment of one texel of 1e6",
        (expected, bound),
        (level(), around(peak)),
        move |found| {
            let right = 1e6 * (TAU / COLUMNS as f64) * (b - a) / TAU;
            let relative = (256.0 + 12.0 / (b - a)) * EPSILON + environment_error(found);
            let [right, bound] = match found.method.is_soft() {
                true => series(found, 0.0, 0.0),
                false => [right, right * relative],
            };
            let at = |[r, c]: [usize; 2]| {
                probe(found.light("direct.env", r, c), right, bound, [1, r, c])
            };
            PLACES.map(at).into()
        },
    )
}

/// A plane on level ground sees (1 + cos tilt) / 2 of the sky, at any steepness.
///
/// Azimuths: the sum stops at wedge middles where the own plane begins to hide; half a wedge is missed
/// or added at each of two ends, where the light is that of its angle, (π/m)² sin(tilt) in all. Elevations
/// that err by an angle move the slices' ends, where the integrand is at most 1, over 2π / π. The table
/// is read between nodes Δ apart: Δ²/8 of a second derivative of at most 2, three moments, over 2π / π. In
/// harmonics azimuths stand for their wedges: (2π/m)²/24 of what is horizontal.
fn slope_under_the_sky(slope: f64) -> Case {
    let tilted = field([SIDE; 2], [1.0, 1.0], |_, c| slope * c as f64);
    let expected = "(1 + cos tilt) / 2 of the sky of 1 and of the environment of 1";
    let bound = "(π/m)² sin tilt + 2 δ + the level ground's; environment: + 3 Δ² / 2 besides, harmonics: + (2π/m)² / 24 and the series'; δ: the method's, at one cell";
    let name = format!("light on a slope of {slope:e}");
    light(name, (expected, bound), (tilted, around(uniform(1.0))), move |found| {
        let cos_tilt = 1.0 / 1.0_f64.hypot(slope);
        let right = 0.5 * (1.0 + cos_tilt);
        let largest = slope * 32.0;
        let ties = found.method.ties(slope, 1.0);
        let angle = found.method.angle_error(slope, (largest, 1.0), ties, &found.azimuths[0]);
        let wedge = (PI / found.count()).powi(2) * slope.atan().sin();
        let node = FRAC_PI_2 / f64::from(found.method.quality.table_elevations - 1);
        let sky = wedge + 2.0 * (angle + ARC_TANGENT) + sky_error(found);
        let environment = match found.method.is_soft() {
            true => sky + (TAU / found.count()).powi(2) / 24.0 + series(found, slope, angle)[1],
            false => sky + 1.5 * node * node + environment_error(found),
        };
        let (row, col) = (32, 32);
        vec![
            probe(found.light("direct.sky", row, col), right, sky, [0, row, col]),
            probe(found.light("direct.env", row, col), right, environment, [1, row, col]),
        ]
    })
}

fn sun(azimuth_rad: f64, elevation_rad: f64, diameter_rad: f64) -> Sun {
    Sun { azimuth_rad, elevation_rad, diameter_rad, irradiance: [1.0; 3] }
}

/// Suns at 90° and at 0° on level ground, E = 1, exit radiance over π.
///
/// A point at the zenith: 1. A disc there of angular radius a: its directions' mean cosine is that of a
/// surface facing it: 1. A point at 0°: 0. A disc at 0°, of which half stands above the ground, of radiance
/// 1 / (π sin² a): ∫ sin ω over it is ∫ sin² θ dθ ∫ cos ψ dψ = a - sin a cos a, with θ from its middle
/// and ψ around it. Sums over n chords of a disc err by n^-3/2, the disc's own and that of its scale.
fn suns_on_level_ground() -> Case {
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
        light("suns at 90° and at 0°", (expected, bound), (level(), lights), |found| {
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

/// The top of an eastern slope of height 10 and 2.5 a cell: it throws the shadow.
const EDGE: usize = 48;

/// Point suns at 30° in the azimuths 0°, 45° and 90° and hairs beside them: the shadow of the edge reaches
/// H cos φ / tan 30° west. Left out: four cells around its end. A sample looks where a line beside it
/// has met the edge: with lines 2 cells apart 1 cell before it, at 3/4 of its height, which still
/// hides the sun up to 10.2 cells away at 45°; with lines 4 apart one of two stands on the top, up to 4
/// cells behind it, which hides it up to 8.2. The shadow there ends at 12.2.
fn suns_along_the_grid() -> Case {
    const HEIGHT: f64 = 10.0;
    let hairs = [0.0, 1e-12, -1e-12, 1e-6, -1e-6, 1e-3, -1e-3];
    let azimuths: Vec<f64> =
        [0.0, FRAC_PI_4, FRAC_PI_2].iter().flat_map(|a| hairs.map(|h| a + h)).collect();
    let suns = azimuths.iter().map(|&azimuth| sun(azimuth, FRAC_PI_6, 0.0)).collect();
    let edge = field([SIDE; 2], [1.0, 1.0], |_, c| {
        (2.5 * (c as f64 + 4.0 - EDGE as f64)).clamp(0.0, HEIGHT)
    });
    let expected = "west of an edge of height H, in its shadow 0, out of it sin 30° / π, but for four cells around the end at H cos φ / tan 30°";
    let bound = "in the shadow 0, out of it 16 ε of the light; pyramid: all of the light besides";
    let lights = Lights { suns, ..Lights::default() };
    let name = "point suns at 0°, 45°, 90° and a hair beside";
    let case = light(name, (expected, bound), (edge, lights), move |found| {
        let mut probes = Vec::new();
        for (s, azimuth) in azimuths.iter().enumerate() {
            let layer = format!("direct.sun{}", s + 1);
            let reach = HEIGHT * azimuth.cos().max(0.0) / FRAC_PI_6.tan();
            // Level ground, in rows from which a line at 45° meets the edge inside the field.
            for (row, away) in (40..60).flat_map(|row| (6..36).map(move |away| (row, away))) {
                let from_end = away as f64 - reach;
                if from_end.abs() < 4.0 {
                    continue;
                }
                let light = if from_end < 0.0 { 0.0 } else { FRAC_PI_6.sin() / PI };
                let at = [s, row, EDGE - away];
                let value = found.light(&layer, row, EDGE - away);
                // Through levels that are means of heights, an edge's shadow may end anywhere.
                let all = FRAC_PI_6.sin() / PI;
                let smoothed = if found.method.is_pyramid() { all } else { 0.0 };
                probes.push(probe(value, light, 16.0 * EPSILON * light + smoothed, at));
            }
        }
        probes
    });
    Case { refuses: suns_off_the_grid, ..case }
}

fn suns_off_the_grid(method: &Method) -> Option<&'static str> {
    method.is_exact().then_some(
        "--lines exact with --sun: found a sun, whose azimuths are no grid vectors, expected --method brute, which is exact in every azimuth",
    )
}
