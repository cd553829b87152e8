//! Indirect light at the extremes, by every bounce engine.
//!
//! A point sun in the zenith casts no shadow, and an albedo of c / N_z gives all ground the same radiance under it. A
//! texel's light of one bounce is then its share of visible ground, whose radiance is the same everywhere: between its
//! own plane and its horizon, known from the oracle.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;
use ridgelight::plan::azimuths::even;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::scene::{Albedo, Border, BounceEngine, HeightField, Levels, Lights, Sun};
use ridgelight_cpu::bounce_gather::BounceGather;
use ridgelight_cpu::bounce_march::visible_intervals_along;
use ridgelight_cpu::height_expand::height_expand;
use ridgelight_cpu::height_reduce::height_levels;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::shade_reduce::shade_levels;
use ridgelight_cpu::shared::bounced::{Along, Cast, radiance};
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::shared::gather::elevation_moments;
use ridgelight_cpu::shared::levels::LevelTexels;
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::tolerance::{
    BounceError, CastError, EPSILON, Gathered, Land, Slices, march_error, walk_error,
};

use super::lights::light;
use super::{About, Case, Found, Probe, field, is_pyramid};

const SIDE: usize = 33;
const MIDDLE: usize = 16;
/// The approximate number of compared texels.
const PLACES: usize = 40;

const EXPECTED: &str = "all ground of one exit radiance: of that, least to most, the share that the oracle's horizons leave above the own plane; pyramid: what the CPU reference sees";
const BOUND: &str = "the engine's, from what the CPU reference sees (`crates/cpu/src/tolerance/bounce.rs`), at most all exit radiance; 4 ε";

pub fn cases() -> Vec<Case> {
    let square = [1.0, 1.0];
    let at = |r: usize, c: usize| (r, c) == (MIDDLE, MIDDLE);
    let one =
        |height: f64, cell| field([SIDE; 2], cell, move |r, c| if at(r, c) { height } else { 0.0 });
    let ramp = |slope: f64| field([SIDE; 2], square, move |_, c| slope * c as f64);
    let plain = |name: &str, ground| bounced(name, ground, Border::Plane, 1.0);
    let mut all = vec![
        plain("bounced by 8848 m ± 1 cm of rubble", rubble([SIDE; 2], square, 0.01, 8848.0)),
        plain("bounced by a spike of 1 cell", one(1.0, square)),
        steep(plain("bounced by a spike of 1e6 cells", one(1e6, square))),
        steep(plain("bounced in a pit of 1e6 cells", one(-1e6, square))),
        plain("bounced in cells of 1 × 1000", one(3.0, [1.0, 1000.0])),
        nothing(plain("bounced by a slope of 1", ramp(1.0))),
        steep(nothing(plain("bounced by a slope of 1e6", ramp(1e6)))),
        plain(
            "bounced by teeth",
            field([SIDE; 2], square, |_, c| 0.25 * c as f64 - if c % 2 == 0 { 0.0 } else { 3.0 }),
        ),
        plain(
            "bounced by a plateau",
            field([SIDE; 2], square, |r, c| {
                if (8..=24).contains(&r) && (8..=24).contains(&c) { 2.0 } else { 0.0 }
            }),
        ),
        plain("bounced beside voids of NaN and infinities", with_voids()),
        steep(plain("bounced under a hemisphere whose hull is as deep as the line", dome())),
        bounced(
            "bounced in rubble of exit radiance 1e30",
            rubble([13, 17], square, 3.0, 0.0),
            Border::Plane,
            1e30,
        ),
        faint(plain("bounced by a spike of 1e-6 cells", one(1e-6, square))),
        faint(plain("bounced by a slope of 1e-6", ramp(1e-6))),
        black(),
        Case {
            is_long: |_| true,
            ..plain("bounced in 8191 × 3 of rubble", rubble([8191, 3], square, 3.0, 0.0))
        },
    ];
    for border in [Border::Plane, Border::Open, Border::Periodic] {
        all.push(bounced(
            "bounced by level ground at 1e15",
            field([SIDE; 2], square, |_, _| 1e15),
            border,
            1.0,
        ));
        let sides: &[[usize; 2]] = match border {
            Border::Plane => &[[1, 1], [1, 31], [31, 1], [2, 3], [13, 17]],
            Border::Open => &[[2, 3], [13, 17]],
            Border::Periodic => &[[1, 31], [2, 3], [13, 17]],
        };
        for &[rows, cols] in sides {
            let name = format!("bounced in {rows} × {cols} of rubble");
            all.push(bounced(&name, rubble([rows, cols], [1.5, 1.0], 3.0, 0.0), border, 1.0));
        }
    }
    all
}

pub(super) fn rubble(
    sides: [usize; 2],
    cell_m: [f64; 2],
    relief_m: f64,
    base_m: f64,
) -> HeightField {
    field(sides, cell_m, |r, c| base_m + relief_m * ((r * 37 + c * 101) % 11) as f64 / 10.0)
}

fn with_voids() -> HeightField {
    let is_void = |i: &usize| (12..=15).contains(&(i / SIDE)) && (4..20).contains(&(i % SIDE));
    let marks: Vec<bool> = (0..SIDE * SIDE).map(|i| is_void(&i)).collect();
    let whole = rubble([SIDE; 2], [1.0, 1.0], 3.0, 0.0);
    let height = |i: usize| match marks[i] {
        true => [f64::NAN, f64::INFINITY][i % 2],
        false => f64::from(whole.heights_m()[i]),
    };
    let heights: Vec<f64> = (0..SIDE * SIDE).map(height).collect();
    HeightField::new(SIDE, SIDE, &heights, [1.0, 1.0], Some(marks)).expect("a good field")
}

/// A quarter of a circle before a climb, as among the horizons.
fn dome() -> HeightField {
    const DOME: usize = 140;
    field([5, 161], [1.0, 1.0], |_, c| match c.checked_sub(DOME) {
        None => ((DOME * DOME - c * c) as f64).sqrt(),
        Some(past) => 7.0 * past as f64,
    })
}

/// A plane has no indirect light.
fn nothing(case: Case) -> Case {
    let expected = "a plane has no indirect light: 0".to_owned();
    let probes = |found: &Found| {
        let nothing = |probe| Probe { expected: [0.0; 2], ..probe };
        both(found).into_iter().map(nothing).collect()
    };
    Case { expected, probes: Box::new(probes), ..case }
}

/// A pyramid's levels round by more than the expected value.
fn steep(case: Case) -> Case {
    Case { unjudged: is_pyramid, ..case }
}

fn normals(ground: &HeightField, border: Border) -> Vec<f64> {
    let heights = Heights::of(ground, border);
    let at = |i: usize| {
        normal_of(field_slope(&heights, (i % ground.cols()) as i32, (i / ground.cols()) as i32)).z
    };
    (0..ground.heights_m().len()).map(at).collect()
}

fn bounced(name: &str, ground: HeightField, border: Border, exit: f32) -> Case {
    let up = normals(&ground, border);
    let least = up.iter().fold(1.0_f64, |m, z| m.min(*z));
    let albedo = Albedo::Map(up.iter().map(|z| [(least / z) as f32; 3]).collect());
    let irradiance = [exit * (PI / least) as f32; 3];
    let sun = Sun { azimuth_rad: 0.0, elevation_rad: FRAC_PI_2, diameter_rad: 0.0, irradiance };
    let lights = Lights { suns: vec![sun], ..Lights::default() };
    let mut case = light(name, (EXPECTED, BOUND), (ground, border, lights), both);
    case.scene.surface.albedo = albedo;
    case.about = About::Bounces;
    case
}

/// So flat that f32 does not resolve the indirect light beside the direct: the sum is the direct light.
fn faint(case: Case) -> Case {
    let expected = "the sun alone: indirect light is 1e-12 of it".to_owned();
    let bound =
        "8 ε and a walk's moments, 4 wedges of (0.5 arc tangents and 9 ε), of all exit radiance"
            .to_owned();
    let probes = |found: &Found| {
        let (whole, direct) = (found.layer("radiance"), found.layer("direct.sun1"));
        let bound = 8.0 * EPSILON + 2.0 * 4.0 * walk_error(TAU / 4.0, &Cast::default()).end;
        let at = |i: usize| {
            let [row, col] = [i / SIDE, i % SIDE];
            Probe {
                found: whole[i],
                expected: [direct[i]; 2],
                bound: bound * direct[i],
                at: [0, row, col],
            }
        };
        (0..SIDE * SIDE).step_by((SIDE * SIDE / PLACES) | 1).map(at).collect()
    };
    Case { expected, bound, probes: Box::new(probes), ..case }
}

/// Black ground bounces nothing, and no bounce is drawn.
fn black() -> Case {
    let mut case = bounced(
        "bounced by rubble of albedo 0",
        rubble([13, 17], [1.0, 1.0], 3.0, 0.0),
        Border::Plane,
        1.0,
    );
    case.scene.surface.albedo = Albedo::Constant([0.0; 3]);
    (case.expected, case.bound) = ("0, and no layer of a bounce".to_owned(), "0".to_owned());
    case.probes = Box::new(|found| {
        assert!(!found.has("indirect.1"), "{}", found.method.name);
        let all = found.layer("radiance");
        all.iter()
            .map(|v| Probe { found: *v, expected: [0.0; 2], bound: 0.0, at: [0; 3] })
            .collect()
    });
    case
}

/// Both bounces, each by the exit radiance before it.
fn both(found: &Found) -> Vec<Probe> {
    let layers = ["direct.sun1", "indirect.1", "indirect.2"].map(|name| found.layer(name));
    let cols = found.scene.field.cols();
    let count = layers[0].len();
    let chosen = (0..count).step_by((count / PLACES).max(1) | 1).map(|i| [i / cols, i % cols]);
    // And the middle, where spikes and pits stand.
    let chosen = chosen.chain([[count / cols / 2, cols / 2]]);
    let chosen = chosen.filter(|at| at.iter().all(|lane| found.method.has_line_at(*lane)));
    let places: Vec<[usize; 2]> = chosen.collect();
    let bounces = layers.windows(2).enumerate();
    bounces.flat_map(|(k, two)| one(found, &places, k, [&two[0], &two[1]])).collect()
}

fn one(
    found: &Found,
    places: &[[usize; 2]],
    bounce: usize,
    [exit, light]: [&[f64]; 2],
) -> Vec<Probe> {
    let ends =
        [exit.iter().fold(f64::MAX, |m, v| m.min(*v)), exit.iter().fold(0.0, |m, v| v.max(m))];
    let ground = Ground::new(found, exit, ends);
    let Albedo::Map(albedo) = &found.scene.surface.albedo else { return Vec::new() };
    let probe = |&[row, col]: &[usize; 2]| {
        let i = row * found.scene.field.cols() + col;
        let albedo = f64::from(albedo[i][0]);
        let (all, error) = ground.visible([row, col]);
        let visible = radiance(&all)[0];
        let expected = match ground.levels.is_some() {
            true => [visible; 2],
            false => ends.map(|end| visible * end),
        };
        let bound = error.light[0].min(ends[1]) + 4.0 * EPSILON * visible.max(expected[1]);
        let expected = expected.map(|e| albedo * e);
        Probe { found: light[i], expected, bound: albedo * bound, at: [bounce + 1, row, col] }
    };
    places.iter().map(probe).collect()
}

/// The ground that texels see.
struct Ground<'a> {
    found: &'a Found<'a>,
    oracle: Oracle<'a>,
    land: Land,
    exit: Vec<[f64; 3]>,
    /// Least and most of it.
    ends: [f64; 2],
    levels: Option<OfPyramid>,
}

/// The levels that a pyramid uses.
pub(super) struct OfPyramid {
    pub heights: Pyramid,
    pub shade: Pyramid,
    pub height_texels: Vec<f32>,
    pub stack: Vec<f32>,
    pub shade_texels: Vec<[f64; 3]>,
}

impl OfPyramid {
    pub fn new(found: &Found, exit: &[[f64; 3]]) -> Self {
        let (quality, field, border) =
            (&found.method.quality, &found.scene.field, found.scene.surface.border);
        let heights = Pyramid::new(quality, [field.cols() as u32, field.rows() as u32], border);
        let bounces = quality.bounces;
        let shade = Pyramid {
            level_step: bounces.level_step,
            level_offset: bounces.level_offset,
            ..heights
        };
        let height_texels = height_levels(&Heights::of(field, border), &heights);
        let of = LevelTexels { pyramid: &heights, texels: &height_texels };
        let stack = (1..=heights.levels()).flat_map(|n| height_expand(&of, n)).collect();
        let shade_texels = shade_levels(exit, &shade);
        Self { heights, shade, height_texels, stack, shade_texels }
    }
}

impl<'a> Ground<'a> {
    fn new(found: &'a Found<'a>, exit: &[f64], ends: [f64; 2]) -> Self {
        let (field, border) = (&found.scene.field, found.scene.surface.border);
        let exit: Vec<[f64; 3]> = exit.iter().map(|v| [*v; 3]).collect();
        let levels = (found.method.quality.bounces.engine == BounceEngine::Pyramid)
            .then(|| OfPyramid::new(found, &exit));
        let exit = if levels.is_some() { exit } else { vec![[1.0; 3]; exit.len()] };
        Self {
            found,
            oracle: Oracle::new(field, border),
            land: Land::of(field, border),
            exit,
            ends,
            levels,
        }
    }

    /// With radiance 1 on all ground; for pyramids with its own radiance. And the error of the light, relative to it.
    fn visible(&self, [row, col]: [usize; 2]) -> (Vec<Along>, BounceError) {
        let (field, border) = (&self.found.scene.field, self.found.scene.surface.border);
        let bounces = self.found.method.quality.bounces;
        let normal = Land::normal_at(field, border, [row, col]);
        let slices = |wedge: f64, brightest: f64| Slices { normal, wedge, brightest };
        match bounces.engine {
            BounceEngine::BruteForce => {
                let all =
                    visible_intervals_along(&self.oracle, &self.exit, bounces.azimuths, [row, col]);
                let error = |along: &Along, cast: &Cast| march_error(field.cell_m(), along, cast);
                let error = BounceError::of(&all, error, &slices(1.0, 1.0));
                (all, error.times(self.ends[1]))
            }
            BounceEngine::Auto | BounceEngine::Sweep => {
                let all = self.along_the_grid([row, col]);
                let wedge = TAU / f64::from(bounces.azimuths);
                // A rise from the exact heights, rounded once, instead of the CPU reference's.
                let error = |_: &Along, cast: &Cast| {
                    let of = walk_error(wedge, cast);
                    CastError { elevation_rad: 1.25 * of.elevation_rad, ..of }
                };
                let error = BounceError::of(&all, error, &slices(wedge, 1.0));
                (all, error.times(self.ends[1]))
            }
            BounceEngine::Pyramid => self.by_pyramid([row, col], &slices(1.0, self.ends[1])),
        }
    }

    /// In the four azimuths along the grid, where lines through texels cross nothing else.
    fn along_the_grid(&self, [row, col]: [usize; 2]) -> Vec<Along> {
        let (field, border) = (&self.found.scene.field, self.found.scene.surface.border);
        let heights = Heights::of(field, border);
        let gradient = field_slope(&heights, col as i32, row as i32);
        let normal = normal_of(gradient);
        let along = |(azimuth, direction): (_, [f64; 2])| {
            let azimuth: ridgelight::plan::Azimuth = azimuth;
            let towards = DVec2::new(azimuth.cos_phi.into(), azimuth.sin_phi.into());
            let plane = gradient.dot(towards);
            let met = self.oracle.horizon_along(row, col, direction);
            let horizon = met.map_or(plane, |met| met.slope.max(plane));
            let flat = DVec2::new(azimuth.wedge_cos.into(), azimuth.wedge_sin.into());
            let faces =
                DVec2::new(normal.truncate().dot(flat), normal.z * f64::from(azimuth.wedge_rad));
            let above = |slope: f64| faces.dot(DVec2::from_array(elevation_moments(slope)));
            let [low_rad, high_rad] = [plane, horizon].map(f64::atan);
            let (sin, cos) = high_rad.sin_cos();
            let cast = Cast {
                low_rad,
                high_rad,
                weight: above(plane) - above(horizon),
                facing: (faces.x * cos + faces.y * sin).abs() * cos,
                radiance: [1.0; 3],
                spread: [0.0; 3],
                distance: met.map_or(1.0, |met| met.distance_m),
                ..Cast::default()
            };
            let azimuth_rad = f64::from(azimuth.sin_phi).atan2(azimuth.cos_phi.into());
            Along { azimuth_rad, low_rad, whole: above(plane), casts: vec![cast] }
        };
        let directions = [[1.0, 0.0], [0.0, -1.0], [-1.0, 0.0], [0.0, 1.0]];
        even(4, field.cell_m()).into_iter().zip(directions).map(along).collect()
    }

    fn by_pyramid(&self, [row, col]: [usize; 2], slices: &Slices) -> (Vec<Along>, BounceError) {
        let (field, border) = (&self.found.scene.field, self.found.scene.surface.border);
        let quality = &self.found.method.quality;
        let of = self.levels.as_ref().expect("of a pyramid");
        let is_stack = quality.levels == Levels::Stack;
        let reference = BounceGather {
            field,
            heights: Heights::of(field, border),
            pyramid: &of.heights,
            stored: match is_stack {
                true => Stored::Stack(&of.stack),
                false => Stored::Levels(&of.height_texels),
            },
            shade: &of.shade,
            shade_texels: &of.shade_texels,
            exit: &self.exit,
            receiver: quality.receiver,
            azimuths: quality.bounces.azimuths,
        };
        let [least, most] = self.ends;
        let gathered = Gathered {
            land: self.land,
            step_m: self.land.cell_m,
            is_stack,
            own_levels: true,
            receiver: quality.receiver,
            brightest: most,
            spread: most - least,
        };
        let all = reference.casts_along([row, col]);
        let error = BounceError::of(&all, |_, cast| gathered.error(cast), slices);
        (all, error)
    }
}
