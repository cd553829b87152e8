//! Phong specular beside the diffuse reflection at the extremes: from straight above, under suns and under a sky.

use std::f64::consts::{FRAC_PI_2, PI};

use ridgelight::basis::zonal::phong;
use ridgelight::scene::{Albedo, Border, HeightField, Lights, PhongSpecular, Specular, Sun};
use ridgelight_cpu::basis::cap;
use ridgelight_cpu::tolerance::{
    EPSILON, Land, ShadeError, device_sh_specular, device_sun_specular,
};

use super::lights::{PLACES, SIDE, filled_voids, level, light, probe};
use super::{About, Case, Found, Probe, field};

/// Specular scale; the rest is black.
const SCALE: f32 = 0.25;

pub fn cases() -> Vec<Case> {
    let high = field([SIDE; 2], [1.0, 1.0], |_, _| 1e15);
    let mut all = vec![
        sky("a lobe of 0 under a sky", level(), Border::Plane, 0.0, 1.0),
        sky("a lobe of 1e4 under a sky", level(), Border::Plane, 1e4, 1.0),
        sky("a lobe of 20 under a sky of 1e30", level(), Border::Periodic, 20.0, 1e30),
        sky("a lobe of 20 over level ground at 1e15", high, Border::Plane, 20.0, 1.0),
        sky(
            "a lobe of 20 beside voids of NaN and infinities",
            filled_voids(),
            Border::Plane,
            20.0,
            1.0,
        ),
        none(),
    ];
    for [rows, cols] in [[1, 1], [1, 31], [31, 1]] {
        let ground = field([rows, cols], [1.0, 1.0], |_, _| 3.0);
        let name = format!("a lobe of 20 over level ground of {rows} × {cols}");
        all.push(sky(&name, ground, Border::Plane, 20.0, 1.0));
    }
    for exponent in [0.0, 1.0, 1e4] {
        all.push(suns(exponent));
        for slope in [1e-6, 2.0_f64.sqrt() - 1.0] {
            all.push(mirrored(exponent, slope));
        }
    }
    all
}

fn case(
    name: &str,
    about: (&str, &str),
    (ground, border): (HeightField, Border),
    exponent: f32,
    lights: Lights,
    probes: impl Fn(&Found) -> Vec<Probe> + 'static,
) -> Case {
    let mut case = light(name, about, (ground, border, lights), probes);
    case.about = About::Phong;
    case.scene.surface.albedo = Albedo::Constant([0.0; 3]);
    case.scene.surface.specular =
        Some(Specular::Constant(PhongSpecular { exponent, scale: SCALE }));
    case
}

/// Level ground sees the upper hemisphere, a cap about the zenith, and reflects the zenith to the zenith: of a sky it
/// reflects the sum over bands of lobe times cap.
fn sky(name: &str, ground: HeightField, border: Border, exponent: f32, radiance: f32) -> Case {
    let expected = "scale · L · Σ lobe_l cap_l over the bands of its order, of a cap of 90°";
    let bound =
        "lobe_l times what a coefficient errs by, and (110 + 3 n²) ε of all products of order n";
    let lights = Lights { sky: Some([radiance; 3]), ..Lights::default() };
    let (rows, cols) = (ground.rows(), ground.cols());
    case(name, (expected, bound), (ground, border), exponent, lights, move |found| {
        let quality = &found.method.quality;
        let n = quality.sh_order as usize;
        let error = ShadeError::new(0.0, 0.0, 1.0, quality.azimuths as usize);
        let bands = || phong(n, exponent.into()).into_iter().zip(cap(n, FRAC_PI_2)).enumerate();
        let all = f64::from(SCALE) * f64::from(radiance);
        let expected: f64 = bands().map(|(_, (phong_specular, cap))| phong_specular * cap).sum();
        let off: f64 = bands()
            .map(|(l, (phong_specular, cap))| {
                let visible = error.series(l, quality.wedges) + error.node_weight() * cap.abs();
                phong_specular.abs() * (visible + device_sh_specular(n, error.normal()) * cap.abs())
            })
            .sum();
        let places = match (rows, cols) {
            (SIDE, SIDE) => vec![[64, 64], [27, 12], [5, 0]],
            _ => vec![[0, 0], [rows / 2, cols / 2], [rows - 1, cols - 1]],
        };
        let at = |[r, c]: [usize; 2]| {
            probe(found.light("direct.specular", r, c), all * expected, all * off, [0, r, c])
        };
        places.into_iter().map(at).collect()
    })
}

/// Specular of scale 0 adds nothing: the picture is black and has no specular layer.
fn none() -> Case {
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let about = ("0, and no layer of it", "0");
    let mut case =
        case("a lobe of scale 0", about, (level(), Border::Plane), 20.0, lights, |found| {
            assert!(!found.has("direct.specular"), "{}", found.method.name);
            PLACES.map(|[r, c]| probe(found.light("radiance", r, c), 0.0, 0.0, [0, r, c])).into()
        });
    case.scene.surface.specular =
        Some(Specular::Constant(PhongSpecular { exponent: 20.0, scale: 0.0 }));
    case
}

const OF_SUNS: (&str, &str) = (
    "E · scale · (n + 1) / 2π · cosⁿ of the sun's angle to the mirrored zenith; 0 of suns that stand at 0°",
    "what f32 does to directions, powers and quotients (`device_sun_specular`), and 16 ε of a sun's light",
);

fn sun(azimuth_rad: f64, elevation_rad: f64) -> Sun {
    Sun { azimuth_rad, elevation_rad, diameter_rad: 0.0, irradiance: [1.0; 3] }
}

/// Specular light of ground with cosine `facing` to a sun, whose mirrored zenith is `off` beside the sun.
fn reflected(exponent: f64, off: f64, facing: f64, normal_error: f64) -> [f64; 2] {
    let peak = (exponent + 1.0) / (2.0 * PI);
    let right = peak * off.cos().max(0.0).powf(exponent);
    let bound = device_sun_specular(exponent, normal_error, facing) + 16.0 * EPSILON * right;
    [right, bound].map(|v| f64::from(SCALE) * v)
}

/// Level ground under a sun in the zenith, one so far beside it that the lobe is down to e^(-1/2), one at 0°.
fn suns(exponent: f32) -> Case {
    let n = f64::from(exponent);
    let off = 1.0 / (n + 1.0).sqrt();
    let suns = vec![sun(0.0, FRAC_PI_2), sun(1.0, FRAC_PI_2 - off), sun(2.0, 0.0)];
    let lights = Lights { suns, ..Lights::default() };
    let name = format!("a lobe of {exponent} under suns at 90° and 0°");
    case(&name, OF_SUNS, (level(), Border::Plane), exponent, lights, move |found| {
        let normal = 8.0 * EPSILON;
        let both = [reflected(n, 0.0, 1.0, normal), reflected(n, off, off.cos(), normal)];
        let [right, bound] = [0, 1].map(|i| both[0][i] + both[1][i]);
        let at = |[r, c]: [usize; 2]| {
            probe(found.light("direct.specular", r, c), right, bound, [0, r, c])
        };
        PLACES.map(at).into()
    })
}

/// A slope that falls towards the sun and reflects the zenith right into it: the lobe's peak.
fn mirrored(exponent: f32, slope: f64) -> Case {
    let tilt = slope.atan();
    let ground = field([SIDE; 2], [1.0, 1.0], |_, c| -slope * c as f64);
    let lights = Lights { suns: vec![sun(0.0, FRAC_PI_2 - 2.0 * tilt)], ..Lights::default() };
    let name = format!("a lobe of {exponent} on a slope of {slope:.6} towards its sun");
    case(&name, OF_SUNS, (ground, Border::Plane), exponent, lights, move |found| {
        let at = |[r, c]: [usize; 2]| {
            let field = &found.scene.field;
            // Heights are rounded as well, at two ends: a gradient errs by 2 ε of them over a cell.
            let rounded = 2.0 * EPSILON * super::largest(field);
            let normal = Land::normal_at(field, Border::Plane, [r, c]) + rounded;
            let [right, bound] = reflected(f64::from(exponent), 0.0, tilt.cos(), normal);
            probe(found.light("direct.specular", r, c), right, bound, [0, r, c])
        };
        [[32, 32], [20, 41], [37, 9]].map(at).into()
    })
}
