//! Sphere lights at the extremes: whole over level ground and slopes, half in the ground, around all of it, behind a
//! wall. They do not use the horizons of any method.

use std::f64::consts::PI;

use glam::DVec3;
use ridgelight::scene::{Border, HeightField, Lights, SphereLight};
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry};

use super::lights::{PLACES, SIDE, filled_voids, level, light};
use super::{Case, Found, Probe, field};

/// A whole, half or hidden sphere light is a sum over slices with a closed form.
const BOUND: &str = "the CPU reference's; what the rule over n slices leaves, (r/away)^2n of a whole sphere light, n^-3/2 of one that stands in the ground, n^-2 behind a wall; and, less, the cutoff's share of the brightest";

pub fn cases() -> Vec<Case> {
    let small = sphere_light([20.3, 40.2, 12.0], 1.5);
    let tiny = sphere_light([32.2, 31.9, 3.5], 1e-5);
    let far = sphere_light([2e6, -1e6, 3e5], 1e5);
    let farthest = sphere_light([1e15; 3], 1e15);
    let near = [[32, 32], [30, 34], [33, 31]];
    let high = field([SIDE; 2], [1.0, 1.0], |_, _| 8848.0);
    let mut all = vec![
        whole(
            "a sphere light over level ground",
            [0.0; 2],
            (level(), Border::Plane),
            small,
            PLACES,
        ),
        whole("a sphere light of 1e-5", [0.0; 2], (level(), Border::Plane), tiny, near),
        whole("a sphere light of 1e5, 2e6 away", [0.0; 2], (level(), Border::Plane), far, PLACES),
        whole(
            "a sphere light of 1e15, 1e15 away",
            [0.0; 2],
            (level(), Border::Plane),
            farthest,
            PLACES,
        ),
        whole(
            "8848 m: a sphere light of 1 cm, 2 cm above ground",
            [0.0; 2],
            (high, Border::Plane),
            sphere_light([32.03, 32.02, 8848.02], 0.01),
            near,
        ),
        whole(
            "a sphere light of 1e30 beside voids of NaN and infinities",
            [0.0; 2],
            (filled_voids(), Border::Plane),
            SphereLight { radiance: [1e30; 3], ..small },
            [[5, 0], [32, 20], [64, 64]],
        ),
        around(),
        buried(),
    ];
    for slope in [1e-6, 1.0] {
        let tilted = field([SIDE; 2], [1.0, 1.0], |_, c| slope * c as f64);
        let over = sphere_light([20.3, 40.2, 20.3 * slope + 9.0], 1.5);
        let name = format!("a sphere light over a slope of {slope:e}");
        all.push(whole(&name, [slope, 0.0], (tilted, Border::Plane), over, PLACES));
    }
    for [rows, cols] in [[1, 1], [1, 31], [31, 1]] {
        let ground = field([rows, cols], [1.0, 1.0], |_, _| 3.0);
        let beside = sphere_light([0.5 * cols as f64, 0.5 * rows as f64 + 4.0, 8.0], 1.0);
        let name = format!("a sphere light over level ground of {rows} × {cols}");
        let places = [[0, 0], [rows / 2, cols / 2], [rows - 1, cols - 1]];
        all.push(whole(&name, [0.0; 2], (ground, Border::Plane), beside, places));
    }
    all.extend([Border::Plane, Border::Open, Border::Periodic].map(halves));
    all.extend([Border::Plane, Border::Open, Border::Periodic].map(behind_a_wall));
    all
}

fn sphere_light(position_m: [f64; 3], radius_m: f64) -> SphereLight {
    SphereLight { position_m, radius_m, radiance: [1.0; 3] }
}

fn case(
    name: &str,
    expected: &str,
    (ground, border): (HeightField, Border),
    sphere_light: SphereLight,
    probes: impl Fn(&Found) -> Vec<Probe> + 'static,
) -> Case {
    let lights = Lights { sphere_lights: vec![sphere_light], ..Lights::default() };
    light(name, (expected, BOUND), (ground, border, lights), probes)
}

/// Slices of a sphere light that is narrow from a texel: no more than eight a cell of its width.
fn slices(found: &Found, sphere_light: &SphereLight) -> f64 {
    let most = (16.0 * sphere_light.radius_m).ceil().max(4.0);
    f64::from(found.method.quality.sun_azimuths).min(most)
}

fn visible(found: &Found, sphere_light: &SphereLight, [row, col]: [usize; 2]) -> SphereGeometry {
    let field = &found.scene.field;
    SphereGeometry::of(field, sphere_light, row * field.cols() + col)
}

/// `share` of the sphere light's radiance is expected, with an error of `rule` of the rule over slices. A texel may
/// lose the cutoff's share of the sphere light's light at the texel nearest to its foot.
fn probe(
    found: &Found,
    sphere_light: &SphereLight,
    at: [usize; 2],
    share: f64,
    rule: f64,
) -> Probe {
    let (rows, cols) = (found.scene.field.rows(), found.scene.field.cols());
    let radiance = f64::from(sphere_light.radiance[0]);
    let [x, y, _] = sphere_light.position_m;
    let nearest = |place: f64, count: usize| place.round().clamp(0.0, (count - 1) as f64) as usize;
    let foot = [rows - 1 - nearest(y, rows), nearest(x, cols)];
    let brightest =
        (sphere_light.radius_m / visible(found, sphere_light, foot).distance_m).powi(2).min(1.0);
    let lost = found.method.quality.light_cutoff * brightest;
    // A hidden sphere light has no rounding.
    let error = if share > 0.0 { visible(found, sphere_light, at).tolerance() } else { 0.0 };
    Probe {
        found: found.light("direct.sphere_light1", at[0], at[1]),
        expected: [(share - lost).max(0.0), share].map(|s| radiance * s),
        bound: radiance * (error + rule * share + 4.0 * EPSILON * share),
        at: [0, at[0], at[1]],
    }
}

/// A sphere light above a texel's plane that is not hidden: (r/d)² of its radiance times the cosine between its middle
/// and the normal, as if all of it came from there.
fn whole(
    name: &str,
    [east, north]: [f64; 2],
    ground: (HeightField, Border),
    sphere_light: SphereLight,
    places: [[usize; 2]; 3],
) -> Case {
    let expected = "L (r/d)² cos between the normal and its middle";
    let normal = DVec3::new(-east, -north, 1.0).normalize();
    case(name, expected, ground, sphere_light, move |found| {
        let field = &found.scene.field;
        let at = |[row, col]: [usize; 2]| {
            let [x, y, z] = sphere_light.position_m;
            let height = f64::from(field.heights_m()[row * field.cols() + col]);
            let up = z - field.base_m() - height;
            let towards = DVec3::new(x - col as f64, y - (field.rows() - 1 - row) as f64, up);
            let share = (sphere_light.radius_m / towards.length()).powi(2)
                * normal.dot(towards.normalize());
            let away = towards.truncate().length();
            let rule = (sphere_light.radius_m / away).powf(2.0 * slices(found, &sphere_light));
            probe(found, &sphere_light, [row, col], share, rule)
        };
        places.map(at).into()
    })
}

/// Its middle lies in level ground: half of its disc is above. With a = asin(r/d), half a cap gives along the normal ∫
/// sin²θ dθ ∫ cos φ dφ = a - sin a cos a, over π. From within the whole hemisphere is bright.
fn halves(border: Border) -> Case {
    let sphere_light = sphere_light([32.3, 31.8, 3.0], 4.4);
    let name = "a sphere light half in level ground";
    let expected = "L (a - sin a cos a) / π with sin a = r/d; from within: L";
    case(name, expected, (level(), border), sphere_light, move |found| {
        let at = |place: [usize; 2]| {
            let a = (sphere_light.radius_m / visible(found, &sphere_light, place).distance_m)
                .min(1.0)
                .asin();
            let is_inside = visible(found, &sphere_light, place).distance_m < sphere_light.radius_m;
            let share = if is_inside { 1.0 } else { (a - a.sin() * a.cos()) / PI };
            let rule = if is_inside { 0.0 } else { slices(found, &sphere_light).powf(-1.5) };
            probe(found, &sphere_light, place, share, rule)
        };
        [[32, 32], [30, 34], [32, 40], [0, 0]].map(at).into()
    })
}

/// The whole field is within it.
fn around() -> Case {
    let sphere_light = sphere_light([32.3, 31.8, 4.0], 3e6);
    let name = "a sphere light of 3e6 around all";
    case(name, "from within: L", (level(), Border::Plane), sphere_light, move |found| {
        PLACES.map(|place| probe(found, &sphere_light, place, 1.0, 0.0)).into()
    })
}

fn buried() -> Case {
    let sphere_light = sphere_light([32.3, 31.8, -17.0], 4.0);
    let name = "a sphere light under level ground";
    case(name, "0", (level(), Border::Plane), sphere_light, move |found| {
        PLACES.map(|place| probe(found, &sphere_light, place, 0.0, 0.0)).into()
    })
}

/// A long wall's top and the texel span a plane through the sphere light's middle: it cuts its disc in half. Half a
/// cap of radius a about c, on the side of n, gives c π sin²a / 2 + n (a - sin a cos a). From half as far the wall
/// hides it.
fn behind_a_wall(border: Border) -> Case {
    const ROWS: usize = 81;
    // Twice as far from column 10 as the wall is, and twice as high.
    let sphere_light = sphere_light([30.0, 40.0, 8.0], 2.0);
    let wall = field([ROWS, 41], [1.0, 1.0], |_, c| if c == 20 { 4.0 } else { 0.0 });
    let name = "a sphere light behind a wall";
    let expected = "half hidden: L (sin ω sin²a / 2 + cos ω (a - sin a cos a) / π) with sin a = r/d, ω its middle's elevation; hidden: 0";
    case(name, expected, (wall, border), sphere_light, move |found| {
        let distance = visible(found, &sphere_light, [40, 10]).distance_m;
        let a = (sphere_light.radius_m / distance).asin();
        let half =
            8.0 / distance * PI * a.sin().powi(2) / 2.0 + 20.0 / distance * (a - a.sin() * a.cos());
        let rule = slices(found, &sphere_light).powi(-2);
        vec![
            probe(found, &sphere_light, [40, 10], half / PI, rule),
            probe(found, &sphere_light, [40, 17], 0.0, 0.0),
        ]
    })
}
