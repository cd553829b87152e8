//! Indirect Phong specular, one bounce, at the extremes.
//!
//! Under a point sun in the zenith nothing is in shadow: the arriving light has a closed form at every texel. Its
//! reflection by direction, the pyramids' view of it and the receiving lobes are the CPU reference's in f64, from the
//! heights alone.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::scene::{
    Albedo, Border, BounceSpecular, HeightField, Levels, Lights, PhongSpecular, Receiver, Specular,
    Sun,
};
use ridgelight_cpu::bounce_gather::BounceGather;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::shared::bounced::Cast;
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::specular_exit::{exit_series, reflected};
use ridgelight_cpu::specular_gather::{Series, SpecularGather, arriving};
use ridgelight_cpu::sun_specular::specular_on;
use ridgelight_cpu::tolerance::{
    BounceError, CastError, EPSILON, Gathered, Land, Slices, device_arriving, device_sh_specular,
    device_specular_exit, device_sun_arriving, device_sun_specular,
};
use ridgelight_cpu::vector_reduce::vector_reduce;

use super::bounces::{OfPyramid, rubble};
use super::lights::light;
use super::{About, Case, Found, Probe, field, is_pyramid};

const SIDE: usize = 33;
/// The approximate number of compared texels.
const PLACES: usize = 12;

const EXPECTED: &str = "what the CPU reference sees of the sun's own harmonics, bounced by every texel's specular and diffusely, mirrored to above";
const BOUND: &str = "series: what arrives, leaves and is gathered (`crates/cpu/src/tolerance/specular.rs`), a lobe's sum of them; 4 ε";

const STEEP: &str = "bounced and mirrored by a spike of 1e6 cells, lobes of 0 and 1e4 in turn";

pub fn cases() -> Vec<Case> {
    let square = [1.0, 1.0];
    let middle = |r: usize, c: usize| (r, c) == (SIDE / 2, SIDE / 2);
    let spike =
        |height: f64| field([SIDE; 2], square, move |r, c| if middle(r, c) { height } else { 0.0 });
    let rough = || rubble([13, 17], square, 3.0, 0.0);
    let black = || rubble([SIDE; 2], square, 3.0, 0.0);
    let mut all = Vec::new();
    for exponent in [0.0, 1e4] {
        let of = |name: &str, ground, albedo, scale| {
            let name = format!("{name}, lobes of {exponent}");
            lobed(&name, ground, Border::Plane, albedo, [exponent; 2], scale, 1.0)
        };
        all.push(of("bounced and mirrored in rubble", rough(), 0.5, 0.5));
        all.push(of("mirrored in rubble of albedo 0", black(), 0.0, 1.0));
        all.push(of("bounced and mirrored by a spike of 1 cell", spike(1.0), 0.5, 0.5));
    }
    let of = |name: &str, ground, border, exponents, exit| {
        lobed(name, ground, border, 0.5, exponents, 0.25, exit)
    };
    // A pyramid's levels round by more than the expected value.
    let needle = field([13, 17], square, |r, c| if (r, c) == (6, 8) { 1e6 } else { 0.0 });
    let needle = of(STEEP, needle, Border::Plane, [0.0, 1e4], 1.0);
    all.push(Case { unjudged: is_pyramid, ..needle });
    let mixed = "bounced and mirrored in rubble, lobes of 0 and 1e4 in turn";
    all.push(of(mixed, rough(), Border::Open, [0.0, 1e4], 1.0));
    let bright = "bounced and mirrored in rubble under a sun of 1e30";
    all.push(of(bright, rough(), Border::Plane, [20.0; 2], 1e30));
    let high = field([13, 17], square, |_, _| 1e15);
    all.push(of("mirrored by level ground at 1e15", high, Border::Plane, [20.0; 2], 1.0));
    for (sides, border) in [
        ([1, 1], Border::Plane),
        ([1, 31], Border::Plane),
        ([31, 1], Border::Open),
        ([1, 31], Border::Periodic),
        ([2, 3], Border::Periodic),
    ] {
        let [rows, cols] = sides;
        let name = format!("bounced and mirrored in {rows} × {cols} of rubble");
        all.push(of(&name, rubble(sides, [1.5, 1.0], 3.0, 0.0), border, [20.0; 2], 1.0));
    }
    all.push(without("bounced in white rubble, lobes of scale 0", 1.0, true));
    all.push(without("bounced in black rubble, lobes of scale 0", 0.0, false));
    all
}

/// Ground of an albedo and of lobes whose exponents take turns.
fn lobed(
    name: &str,
    ground: HeightField,
    border: Border,
    albedo: f32,
    exponents: [f32; 2],
    scale: f32,
    irradiance: f32,
) -> Case {
    let sun = Sun {
        azimuth_rad: 0.0,
        elevation_rad: FRAC_PI_2,
        diameter_rad: 0.0,
        irradiance: [irradiance; 3],
    };
    let grid_points = ground.heights_m().len();
    let phong = |i: usize| PhongSpecular { exponent: exponents[i % 2], scale };
    let lights = Lights { suns: vec![sun], ..Lights::default() };
    let mut case = light(name, (EXPECTED, BOUND), (ground, border, lights), both);
    case.about = About::Specular;
    case.scene.surface.albedo = Albedo::Constant([albedo; 3]);
    case.scene.surface.specular = Some(match exponents {
        [a, b] if a == b => Specular::Constant(phong(0)),
        _ => Specular::Map((0..grid_points).map(phong).collect()),
    });
    case
}

/// Specular of scale 0 adds nothing: no layer, and none of a bounce where the ground is black.
fn without(name: &str, albedo: f32, is_bounced: bool) -> Case {
    let ground = rubble([13, 17], [1.0, 1.0], 3.0, 0.0);
    let case = lobed(name, ground, Border::Plane, albedo, [20.0; 2], 0.0, 1.0);
    let expected =
        "no layer of lobes; black: nothing, white: diffuse bounces as without".to_owned();
    let probes = move |found: &Found| {
        assert!(!found.has("indirect.specular"), "{}", found.method.name);
        assert_eq!(found.has("indirect.1"), is_bounced, "{}", found.method.name);
        let [whole, direct] = ["radiance", "direct.sun1"].map(|name| found.layer(name));
        let bounced = if is_bounced { found.layer("indirect.1") } else { vec![0.0; whole.len()] };
        let at = |i: usize| {
            let expected = direct[i] + bounced[i];
            Probe {
                found: whole[i],
                expected: [expected; 2],
                bound: 4.0 * EPSILON * expected,
                at: [0, 0, i],
            }
        };
        (0..whole.len()).step_by(7).map(at).collect()
    };
    Case { expected, bound: "4 ε".to_owned(), probes: Box::new(probes), ..case }
}

/// The light of the sun that texels bounce, and the bound on each coefficient.
struct Exit {
    normals: Vec<DVec3>,
    series: Vec<Series>,
    /// As visible from above.
    visible: Vec<[f64; 3]>,
    off: f64,
    off_visible: f64,
}

impl Exit {
    fn new(found: &Found, order: usize) -> Self {
        let (field, surface) = (&found.scene.field, &found.scene.surface);
        let (heights, sun) = (Heights::of(field, surface.border), &found.scene.lights.suns[0]);
        let (Some(phong_specular), Albedo::Constant([albedo, ..])) =
            (&surface.specular, &surface.albedo)
        else {
            unreachable!("each case has both");
        };
        let (albedo, bright) = (f64::from(*albedo), f64::from(sun.irradiance[0]));
        let above = evaluate(order, DVec3::Z);
        let arriving: Series = above.iter().map(|y| [bright * y; 3]).collect();
        let magnitude: f64 = above.iter().map(|y| y.abs()).sum();
        let mut exit = Self {
            normals: Vec::new(),
            series: Vec::new(),
            visible: Vec::new(),
            off: 0.0,
            off_visible: 0.0,
        };
        for i in 0..field.heights_m().len() {
            let at = [i / field.cols(), i % field.cols()];
            let normal = normal_of(field_slope(&heights, at[1] as i32, at[0] as i32));
            let error = Land::normal_at(field, surface.border, at);
            let (phong, facing) = (phong_specular.at(i), normal.z);
            let diffuse = [bright * albedo * facing / PI; 3];
            let mirrored =
                bright * specular_on((normal, DVec3::Z), sun, phong, (facing / PI, None));
            exit.series.push(exit_series(&arriving, normal, phong, diffuse));
            exit.visible.push(diffuse.map(|d| d + mirrored));
            exit.normals.push(normal);
            let scale = f64::from(phong.scale) * bright;
            // An arriving coefficient is multiplied by at most √(n²) times its error; diffuse light by √4π.
            let arrives = order as f64 * device_sun_arriving(error, facing);
            let of_diffuse = 4.0 * (error * bright * albedo + 16.0 * EPSILON * diffuse[0]);
            let leaves = device_specular_exit(order, error) * magnitude;
            exit.off = exit.off.max(scale * (arrives + leaves) + of_diffuse);
            let of_specular = device_sun_specular(phong.exponent.into(), error, facing);
            exit.off_visible =
                exit.off_visible.max(scale * of_specular + of_diffuse + 16.0 * EPSILON * mirrored);
        }
        exit
    }
}

/// The bounced light, of the diffuse part and of specular.
fn both(found: &Found) -> Vec<Probe> {
    let quality = &found.method.quality;
    let (field, border) = (&found.scene.field, found.scene.surface.border);
    let order = quality.sh_order as usize;
    let exit = Exit::new(found, order);
    let levels = OfPyramid::new(found, &exit.visible);
    let mut texels: Vec<Series> = Vec::new();
    let is_vector = quality.bounces.specular != BounceSpecular::Scalar;
    if is_vector {
        for number in 1..=levels.shade.levels() {
            let level = vector_reduce(&exit.series, &levels.shade, number, &texels);
            texels.extend(level);
        }
    }
    let is_stack = quality.levels == Levels::Stack;
    let gather = BounceGather {
        field,
        heights: Heights::of(field, border),
        pyramid: &levels.heights,
        stored: match is_stack {
            true => Stored::Stack(&levels.stack),
            false => Stored::Levels(&levels.height_texels),
        },
        shade: &levels.shade,
        shade_texels: &levels.shade_texels,
        exit: &exit.visible,
        receiver: Receiver::Plane,
        azimuths: quality.bounces.azimuths,
    };
    let vectors = is_vector.then_some([&exit.series[..], &texels[..]]);
    let reference = SpecularGather { gather, order, vectors };
    let sum = |series: &Series| series.iter().map(|s| s[0].abs()).sum::<f64>();
    // Y_lm of a direction have the norm n / √4π; n² coefficients that err by e each have n e: in any direction a
    // series errs by n² e / √4π, and one of norm |c| is n |c| / √4π at most.
    let in_a_direction = (order * order) as f64 / (4.0 * PI).sqrt();
    let largest = |series: &Series| {
        let norm = series.iter().map(|s| s[0] * s[0]).sum::<f64>().sqrt();
        order as f64 * norm / (4.0 * PI).sqrt()
    };
    let (bright, off) = match is_vector {
        true => (exit.series.iter().map(largest).fold(0.0, f64::max), in_a_direction * exit.off),
        false => (exit.visible.iter().fold(0.0, |m: f64, v| m.max(v[0])), exit.off_visible),
    };
    let land = Land::of(field, border);
    let gathered = Gathered {
        land,
        step_m: land.cell_m,
        is_stack,
        own_levels: true,
        receiver: Receiver::Plane,
        brightest: bright,
        spread: 2.0 * bright,
    };
    let of_exit = |cast: &Cast| {
        let here = gathered.error(cast);
        CastError { radiance: here.radiance + off, ..here }
    };
    let turned = |cast: &Cast| {
        let here = of_exit(cast);
        CastError { radiance: here.radiance + order as f64 * here.elevation_rad * bright, ..here }
    };
    let layers = ["indirect.1", "indirect.specular"].map(|name| found.layer(name));
    let (Some(phong_specular), Albedo::Constant([albedo, ..])) =
        (&found.scene.surface.specular, &found.scene.surface.albedo)
    else {
        return Vec::new();
    };
    let count = exit.normals.len();
    let places = (0..count).step_by((count / PLACES).max(1) | 1).chain([count / 2]);
    places
        .flat_map(|i| {
            let at = [i / field.cols(), i % field.cols()];
            let normal = Land::normal_at(field, border, at);
            let slices = Slices { normal, wedge: 1.0, brightest: bright };
            let all = reference.casts_along(at);
            let want = arriving(order, &all);
            let of_series = device_arriving(&all, |_, cast| of_exit(cast), order, &slices);
            let of_light = BounceError::of(&all, |_, cast| turned(cast), &slices).light[0];
            let phong = phong_specular.at(i);
            let of_view = (exit.normals[i], DVec3::Z);
            let mirror = reflected(&want.series, of_view, phong)[0];
            let coefficients = in_a_direction * of_series;
            let of_specular = coefficients + device_sh_specular(order, normal) * sum(&want.series);
            let albedo = f64::from(*albedo);
            let probes = [
                (albedo * want.diffuse[0], albedo * of_light),
                (mirror, f64::from(phong.scale) * of_specular),
            ];
            let probe = |k: usize| {
                let (expected, bound) = probes[k];
                let bound = bound + 4.0 * EPSILON * expected;
                Probe { found: layers[k][i], expected: [expected; 2], bound, at: [k, at[0], at[1]] }
            };
            // Black ground bounces by specular alone.
            let of_both = [probe(0), probe(1)];
            of_both.into_iter().skip(usize::from(albedo == 0.0)).collect::<Vec<_>>()
        })
        .collect()
}
