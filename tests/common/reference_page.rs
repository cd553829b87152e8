//! The device-independent parts of docs/measured/reference.md: closed forms, and the heads of its rows.

use std::f64::consts::{SQRT_2, TAU};

use ridgelight::Result;
use ridgelight::scene::{Border, Environment, HeightField, Lights, Normals, Scene};
use ridgelight_cpu::indirect::{Fineness, GroundTruth, ground_truth, smooth_ground_truth};

use super::fields::under_sky;

/// The fineness of the page's quadrature, before it is doubled.
pub const FINENESS: Fineness = Fineness { azimuths: 24, divisions: 1, strips: 12 };

/// Bounces of the page's scenes: none, one, two.
pub const MOST_BOUNCES: usize = 2;

/// The quadrature of a scene of the page's first two tables.
pub fn quadrature(scene: &Scene, normals: Normals) -> Result<GroundTruth> {
    match normals {
        Normals::Smooth => {
            smooth_ground_truth(scene, MOST_BOUNCES, FINENESS.azimuths, FINENESS.strips)
        }
        Normals::Flat => ground_truth(scene, MOST_BOUNCES, FINENESS),
    }
}

/// The light of each of a scene's three channels.
pub fn light_names(scene: &Scene) -> [&'static str; 3] {
    match scene.lights.environment {
        Some(_) => ["environment, red", "environment, green", "environment, blue"],
        None => ["sky", "sun", "sphere light"],
    }
}

/// The row of a scene up to the quadrature's columns: its mean, and the mean of its stated error.
pub fn head(
    name: &str,
    bounces: usize,
    light: &str,
    ground_truth: &GroundTruth,
    channel: usize,
) -> String {
    let count = ground_truth.radiance[bounces].len();
    let mean =
        |picture: &[[f64; 3]]| picture.iter().map(|v| v[channel]).sum::<f64>() / count as f64;
    let [light_mean, stated] =
        [&ground_truth.radiance[bounces], &ground_truth.error[bounces]].map(|p| mean(p));
    format!("| {name} | {bounces} | {light} | {count} | {light_mean:.5} | {stated:.5} | ")
}

/// A scene whose radiance is known at some of its texels.
pub struct Closed {
    pub name: String,
    pub scene: Scene,
    pub bounces: usize,
    /// The normals for which its formula holds.
    pub normals: Normals,
    /// Texels, the radiance of each, and the largest error of the grid against the formula.
    pub known: Vec<(usize, f64, f64)>,
}

impl Closed {
    /// Means over the known texels: radiance, and the grid's error.
    pub fn means(&self) -> [f64; 2] {
        let count = self.known.len() as f64;
        let sum =
            |of: fn(&(usize, f64, f64)) -> f64| self.known.iter().map(of).sum::<f64>() / count;
        [sum(|k| k.1), sum(|k| k.2)]
    }

    /// Its row up to the formula's columns.
    pub fn head(&self) -> String {
        let [value, grid] = self.means();
        let Self { name, bounces, known, .. } = self;
        let normals = match self.normals {
            Normals::Smooth => "smooth",
            Normals::Flat => "flat",
        };
        format!("| {name} | {bounces} | {normals} | {} | {value:.6} | {grid:.6} | ", known.len())
    }
}

fn field(rows: usize, cols: usize, h: impl Fn(usize, usize) -> f64) -> HeightField {
    super::fields::field(rows, cols, [1.0, 1.0], h)
}

/// Every scene of the page's last table.
pub fn closed_forms() -> Vec<Closed> {
    let mut all = furnaces();
    all.push(tilted_plane());
    all.extend((0..=2).map(grooves_lit));
    all.extend(PITS.map(|(alpha, albedo, bounces, _)| pit_lit(alpha, albedo, bounces)));
    all
}

/// White ground in light of radiance 1 from all other directions has radiance 1, whatever its normals. After 64 bounces on the rough
/// field no path is left: at each bounce it ends with a probability above a third.
fn furnaces() -> Vec<Closed> {
    let whole = |name: &str, scene: Scene, bounces| Closed {
        name: name.to_owned(),
        known: (0..scene.field.heights_m().len()).map(|i| (i, 1.0, 0.0)).collect(),
        scene,
        bounces,
        normals: Normals::Smooth,
    };
    let level = under_sky(field(5, 7, |_, _| 8.0), Border::Plane, 1.0);
    let rough = field(12, 11, |r, c| ((r * 31 + c * 17) % 7) as f64 / 3.0);
    let sky = under_sky(rough, Border::Open, 1.0);
    // As an environment, directions are sampled or hit: each path's share is right in the mean alone.
    let white = Environment::new(6, 5, vec![[1.0; 3]; 30], 0.5).unwrap();
    let lights = Lights { environment: Some(white), ..Lights::default() };
    let environment = Scene { lights, ..sky.clone() };
    vec![
        whole("furnace, level", level, 1),
        whole("furnace, rough, sky", sky, 64),
        whole("furnace, rough, environment", environment, 64),
    ]
}

/// Tilted by t, under `plane`: directions below horizontal are black, (1 + cos t)/2 of the sky is left.
fn tilted_plane() -> Closed {
    let tilted = field(6, 6, |r, c| 0.5 * c as f64 + r as f64);
    let cos = (1.0_f64 + 0.25 + 1.0).sqrt().recip();
    Closed {
        name: "tilted plane".to_owned(),
        known: (0..36).map(|i| (i, 0.5 * (1.0 + cos), 0.0)).collect(),
        scene: under_sky(tilted, Border::Plane, 1.0),
        bounces: 0,
        normals: Normals::Smooth,
    }
}

/// Texels from a groove's bottom to its ridge.
pub const HALF: usize = 8;
/// Length of a wall.
pub const WALL: f64 = HALF as f64 * SQRT_2;

/// Endless V-shaped grooves with slopes of 1, the bottom at column 8, ridges at column 0.
pub fn grooves(rows: usize) -> HeightField {
    field(rows, 2 * HALF, |_, c| (c as f64 - HALF as f64).abs())
}

/// ∫ over the other wall of a radiance as a function of the distance from the bottom; midpoint rule
/// in t = s·tan u, where the kernel is ½ sin u du: error below (step²/24)·variation, under 1e-8.
pub fn from_the_other_wall(s: f64, radiance: impl Fn(f64) -> f64) -> f64 {
    let end = (WALL / s).atan();
    let steps = 4000;
    (0..steps)
        .map(|i| (i as f64 + 0.5) / steps as f64 * end)
        .map(|u| 0.5 * u.sin() * radiance(s * u.tan()) * end / steps as f64)
        .sum()
}

/// The share of sky at s: all but the other wall, 1 - ½ (1 - s/√(s² + a²)).
pub fn groove_sky(s: f64) -> f64 {
    0.5 + 0.5 * s / s.hypot(WALL)
}

/// The light of bounces 0, 1 and 2 at s, for albedo ½ and a sky of 1.
pub fn groove_parts() -> [Box<dyn Fn(f64) -> f64>; 3] {
    let once = |s: f64| 0.5 * from_the_other_wall(s, |t| 0.5 * groove_sky(t));
    // Once reflected light at 200 points of the wall, linear between them.
    let table: Vec<f64> = (0..=200).map(|i| once(f64::from(i).max(1e-6) * WALL / 200.0)).collect();
    let twice = move |s: f64| {
        0.5 * from_the_other_wall(s, |t| {
            let place = (t / WALL * 200.0).clamp(0.0, 199.999_999);
            let (i, share) = (place as usize, place.fract());
            table[i] + share * (table[i + 1] - table[i])
        })
    };
    [Box::new(|s| 0.5 * groove_sky(s)), Box::new(once), Box::new(twice)]
}

/// On its walls; normals at bottom and ridge are not a wall's. Flat triangles are the walls: the grid adds no error.
fn grooves_lit(bounces: usize) -> Closed {
    let parts = groove_parts();
    let rows = 4;
    let known = (0..rows * 2 * HALF)
        .filter_map(|i| {
            let away = (i % (2 * HALF)).abs_diff(HALF);
            let s = away as f64 * SQRT_2;
            let light = || parts[..=bounces].iter().map(|part| part(s)).sum();
            (!away.is_multiple_of(HALF)).then(|| (i, light(), 0.0))
        })
        .collect();
    Closed {
        name: "V-shaped grooves, walls at right angles".to_owned(),
        scene: under_sky(grooves(rows), Border::Periodic, 0.5),
        bounces,
        normals: Normals::Flat,
        known,
    }
}

/// Spherical pits by independent quadrature to 15 digits (`spherical_pit` of
/// tests/basis/reference_numbers.json): α, ρ, bounces, radiance.
pub const PITS: [(f64, f32, usize, f64); 4] = [
    (0.8, 0.5, 0, 0.424_176_677_336_791_4),
    (0.8, 0.5, 1, 0.456_339_162_408_706_64),
    (1.2, 0.9, 2, 0.839_447_864_111_118_3),
    (1.2, 0.9, 50, 0.859_759_541_651_428_3),
];

/// Between two points of a sphere the form factor is dA/(4πR²) whatever the points: every point of a cap of
/// half-angle α sees the sky with share s = (1 + cos α)/2 and the pit, equally bright everywhere, with 1 - s.
/// With b bounces L = ρ s Σ_{i ≤ b} (ρ(1-s))^i, in the limit ρ s / (1 - ρ(1-s)).
pub fn pit_radiance(alpha: f64, albedo: f64, bounces: usize) -> f64 {
    let share = 0.5 * (1.0 + alpha.cos());
    let again = albedo * (1.0 - share);
    albedo * share * (1.0 - again.powi(bounces as i32 + 1)) / (1.0 - again)
}

/// The pit, its rim `rim` cells from the middle of a field that ends two cells beyond.
pub fn pit(rim: f64, alpha: f64) -> HeightField {
    let sphere = rim / alpha.sin();
    let middle = rim.ceil() + 1.0;
    let side = 2 * middle as usize + 1;
    field(side, side, |r, c| {
        let away = (r as f64 - middle).hypot(c as f64 - middle).min(rim);
        -(sphere * sphere - away * away).sqrt()
    })
}

/// The sky that a point of the pit, `away` from its axis, may gain on the grid.
///
/// The plain is met not at the rim, D away, but up to √2 cells farther, where the last cell's surface has risen
/// to it: the horizon ω sinks by up to sin ω cos ω √2/D, and (N·e) cos ω dω of the slice is gained. On a sphere
/// N·e = (chord from here to the rim)/2R. Flat triangles instead of the sphere: second order in a cell over R.
fn sky_gained(away: f64, rim: f64, alpha: f64) -> f64 {
    let sphere = rim / alpha.sin();
    let depth = (sphere * sphere - away * away).sqrt() - sphere * alpha.cos();
    let m = 64;
    let sum: f64 = (0..m)
        .map(|k| {
            let (sin, cos) = (TAU * (f64::from(k) + 0.5) / f64::from(m)).sin_cos();
            let distance = (rim * rim - (away * sin).powi(2)).sqrt() - away * cos;
            let chord = distance.hypot(depth);
            let (sin_w, cos_w) = (depth / chord, distance / chord);
            chord / (2.0 * sphere) * sin_w * cos_w * cos_w * 2_f64.sqrt() / distance
        })
        .sum();
    2.0 / f64::from(m) * sum + 1.0 / (sphere * sphere)
}

/// For bounces 0, 1, … the texels of the pit's inner half, and the largest error of each against the closed
/// form due to the rim's staircase: directions that turn from pit (radiance L of the bounces before) to sky
/// change a bounce by ρ (1 - L) of them, and the mean error of the whole pit returns with ρ (1 - s).
pub fn pit_bounds(rim: f64, alpha: f64, albedo: f64, bounces: usize) -> Vec<Vec<(usize, f64)>> {
    let side = pit(rim, alpha).cols();
    let share = 0.5 * (1.0 + alpha.cos());
    let away = |i: usize| {
        let middle = (side / 2) as f64;
        ((i / side) as f64 - middle).hypot((i % side) as f64 - middle)
    };
    // No point gains more than all that it does not see.
    let gained = |i: &usize| sky_gained(away(*i), rim, alpha).min(1.0 - share);
    let inside: Vec<usize> = (0..side * side).filter(|i| away(*i) < rim - 0.01).collect();
    let gained_mean = inside.iter().map(gained).sum::<f64>() / inside.len() as f64;
    let (mut before, mut off) = (0.0, 0.0);
    (0..=bounces)
        .map(|b| {
            let bound = |i: &usize| albedo * (gained(i) * (1.0 - before) + (1.0 - share) * off);
            let inner = inside.iter().filter(|i| away(**i) < 0.5 * rim);
            let all = inner.map(|i| (*i, bound(i))).collect();
            off = albedo * (gained_mean * (1.0 - before) + (1.0 - share) * off);
            before = pit_radiance(alpha, albedo, b);
            all
        })
        .collect()
}

fn pit_lit(alpha: f64, albedo: f32, bounces: usize) -> Closed {
    let rim = 12.5;
    let rho = f64::from(albedo);
    let value = pit_radiance(alpha, rho, bounces);
    let bounds = pit_bounds(rim, alpha, rho, bounces).pop().unwrap_or_default();
    Closed {
        name: format!("spherical pit, half-angle {alpha}, albedo {albedo}"),
        scene: under_sky(pit(rim, alpha), Border::Plane, albedo),
        bounces,
        normals: Normals::Flat,
        known: bounds.into_iter().map(|(i, bound)| (i, value, bound)).collect(),
    }
}
