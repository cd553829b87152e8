//! Compares a sky through swept horizons with the same sweeps and the same near search on the CPU.
//! They may differ by f32 rounding only.

use std::collections::BTreeSet;

use glam::DVec3;
use ridgelight::gpu::Pixels;
use ridgelight::plan::azimuths::{Shape, even};
use ridgelight::plan::{Axis, Azimuth, Pass, Plan};
use ridgelight::scene::{
    Albedo, Border, Fuse, KeyLight, Lights, Lines, Method, Precision, Quality, Scene, Sun, Surface,
};
use ridgelight::{Error, Result};
use ridgelight_cpu::horizon_march::{MarchOptions, marched};
use ridgelight_cpu::horizon_sweep::{SweepOptions, horizon_sweep};
use ridgelight_cpu::lattice::{Lattice, Lattices, number_layers};
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::shared::sweep::{CELL_SHIFT, Heights, March};
use ridgelight_cpu::sky_shade::sky_at;
use ridgelight_cpu::sun_shade::{sun_at, weights};
use ridgelight_cpu::tolerance::{EPSILON, ShadeError, device_fused_slope};

use super::{Device, Wanted, colours, environments, heights_m, is_above_ground, sentence};

/// A sky of radiance 1 and the scene's suns and key lights on white ground, at some texels. None
/// where the CPU reference does not [follow](followed) the sweeps.
pub(super) fn check(
    scene: &Scene,
    places: &[usize],
    device: &mut Device,
    aimed: Option<&AimedLayers>,
) -> Result<Option<String>> {
    let quality = device.quality;
    let Some(lines) = followed(scene, quality) else { return Ok(None) };
    let aimed =
        aimed.map(|aimed| check_aimed(aimed, places, quality, lines)).transpose()?.flatten();
    let around = environments::check(scene, places, device, lines)?;
    let scene = white(scene, Lights { sky: Some([1.0; 3]), ..Lights::default() });
    let (plan, layers) = device.layers(&scene, false)?;
    if !plan.passes.iter().any(|pass| pass.name() == "horizon_sweep") {
        return Ok(None);
    }
    let wanted = wanted(&scene, places, quality, lines);
    let errors = wanted.judge("the sky at one place", &colours(&layers[0], places), quality)?;
    let of_sky = Some(sentence("sky", "the CPU reference", errors));
    let all: Vec<String> = [of_sky, around, aimed].into_iter().flatten().collect();
    Ok(Some(all.join("; ")))
}

/// The spacing of lines where the CPU reference follows the sweeps. It does not where packed horizons
/// are rounded or where lines of a periodic field may be denser than requested.
pub(super) fn followed(scene: &Scene, quality: &Quality) -> Option<u32> {
    let is_swept = matches!(quality.method, Method::Auto | Method::Sweep);
    if !is_swept || quality.precision != Precision::F32 {
        return None;
    }
    match quality.lines.shift() {
        Some(shift) if shift <= Lines::Cell.shift().unwrap_or(0) => Some(shift),
        Some(shift) if scene.surface.border != Border::Periodic => Some(shift),
        _ => None,
    }
}

/// Light of the CPU reference.
fn wanted(scene: &Scene, places: &[usize], quality: &Quality, line_shift: u32) -> Wanted {
    let azimuths = even(quality.azimuths, scene.field.cell_m());
    let cols = scene.field.cols();
    lit(scene, azimuths, quality.fuse, line_shift, |swept, error| {
        let at = |p: &usize| sky_at(swept, (p % cols) as i32, (p / cols) as i32);
        let both = |p| [at(p), error.sky()].map(DVec3::splat);
        Wanted(places.iter().map(both).collect())
    })
}

/// Light from sweeps along azimuths, and its tolerance.
pub(super) fn lit<T>(
    scene: &Scene,
    azimuths: Vec<Azimuth>,
    fuse: Fuse,
    line_shift: u32,
    light: impl FnOnce(&Swept, &ShadeError) -> T,
) -> T {
    let sweep = |heights: Heights, azimuth: &Azimuth, warm_up, lattice: &mut Lattice| {
        let options = SweepOptions { line_shift, warm_up, ..SweepOptions::default() };
        horizon_sweep(heights, azimuth, &options, lattice);
    };
    lit_by(scene, azimuths, (Some(fuse), line_shift), sweep, light)
}

/// Light from exact horizons at some texels, and its tolerance.
fn exactly_lit<T>(
    scene: &Scene,
    azimuths: Vec<Azimuth>,
    places: &[usize],
    light: impl FnOnce(&Swept, &ShadeError) -> T,
) -> T {
    let cols = scene.field.cols();
    let march_to = |heights: Heights, azimuth: &Azimuth, warm_up, lattice: &mut Lattice| {
        let march = March::new(heights, azimuth);
        for place in places {
            let (lane, step) = march.of_grid_point((place % cols) as i32, (place / cols) as i32);
            let texel = lattice.texel(lane, march.march_position(step), azimuth.layer);
            let options = MarchOptions { all_crossings: true, warm_up };
            lattice.slopes[texel] = marched(&march, lane, step, options).slope;
        }
    };
    lit_by(scene, azimuths, (None, CELL_SHIFT), march_to, light)
}

fn lit_by<T>(
    scene: &Scene,
    mut azimuths: Vec<Azimuth>,
    (fuse, line_shift): (Option<Fuse>, u32),
    fill: impl Fn(Heights, &Azimuth, i32, &mut Lattice),
    light: impl FnOnce(&Swept, &ShadeError) -> T,
) -> T {
    let (field, border) = (&scene.field, scene.surface.border);
    let (rows, cols) = (field.rows(), field.cols());
    let heights = Heights::of(field, border);
    number_layers(&mut azimuths);
    let size = [cols as u32, rows as u32];
    let warm_up = [false, true].map(|by_row| Axis::of(by_row, size, border).warm_up as i32);
    let mut lattices = Lattices::new(&azimuths, [cols, rows], line_shift, border);
    for azimuth in &azimuths {
        let warm_up = warm_up[usize::from(azimuth.marches_rows())];
        fill(heights, azimuth, warm_up, lattices.of_mut(azimuth));
    }
    let lattices = &lattices;
    let swept = Swept { heights, azimuths: &azimuths, lattices, fuse, line_shift, warm_up };
    let [low, high] = heights_m(field);
    let step = azimuths.iter().map(|a| f64::from(a.step_m)).fold(f64::MAX, f64::min);
    // A lattice's slope has an error of 6 ε of itself, which changes an angle by at most half of
    // that.
    let slope = device_fused_slope(low.abs().max(high.abs()), step) + 3.0 * EPSILON;
    let [x, y] = field.cell_m();
    let error = ShadeError::new(slope, high - low, x.min(y), azimuths.len());
    light(&swept, &error)
}

/// Layers of suns and key lights, each with irradiance or radiance 1 on white ground, and the plan of
/// the frame that drew them.
pub(super) struct AimedLayers {
    pub scene: Scene,
    pub plan: Plan,
    pub layers: Vec<Pixels>,
}

impl AimedLayers {
    /// Draws the suns and key lights of a scene; none where all are dark or below the ground.
    pub(super) fn of(scene: &Scene, device: &mut Device) -> Result<Option<Self>> {
        let Some(scene) = aimed_alone(scene) else { return Ok(None) };
        let (plan, layers) = device.layers(&scene, true)?;
        Ok(Some(Self { scene, plan, layers }))
    }
}

/// Suns and key lights by the same sweeps; none where no place can be compared.
pub(super) fn check_aimed(
    AimedLayers { scene, plan, layers }: &AimedLayers,
    places: &[usize],
    quality: &Quality,
    lines: u32,
) -> Result<Option<String>> {
    let (mut found, mut all, mut most) = (Vec::new(), Vec::new(), DVec3::ZERO);
    let mut checked = 0;
    for layer in layers {
        let of = layer.name.strip_prefix("direct.").and_then(|light| azimuths_of(plan, light));
        let Some((azimuths, shaded)) = of else { continue };
        checked += 1;
        let wanted = aimed(scene, azimuths, places, lines, shaded);
        for (got, wanted) in colours(layer, places).into_iter().zip(wanted) {
            let Some([light, bound]) = wanted else { continue };
            found.push(got);
            all.push([light, bound]);
            most = most.max(bound);
        }
    }
    let shaded = shaded_lights(plan);
    if checked != shaded.len() {
        return Err(Error::Device {
            doing: "verifying before timing".into(),
            reason: format!("{checked} of {} suns and key lights were compared", shaded.len()),
        });
    }
    // Point suns that may be visible or not everywhere.
    if found.is_empty() {
        return Ok(None);
    }
    // One tolerance for all of them.
    all.iter_mut().for_each(|[_, bound]| *bound = most);
    let errors = Wanted(all).judge("a sun at one place", &found, quality)?;
    Ok(Some(sentence("sun and key light", "the CPU reference", errors)))
}

/// Suns and key lights of a scene, each with irradiance or radiance 1 on white ground; none where all are dark or
/// below the ground.
fn aimed_alone(scene: &Scene) -> Option<Scene> {
    let Lights { suns, keys, .. } = &scene.lights;
    let lit_by = |c: &[f32; 3]| c.iter().any(|v| *v > 0.0);
    let suns = suns.iter().filter(|s| lit_by(&s.irradiance));
    let suns: Vec<_> = suns.map(|sun| Sun { irradiance: [1.0; 3], ..*sun }).collect();
    let border = scene.surface.border;
    let keys = keys.iter().filter(|k| lit_by(&k.radiance) && is_above_ground(k, border));
    let keys: Vec<_> = keys.map(|key| KeyLight { radiance: [1.0; 3], ..*key }).collect();
    let is_dark = suns.is_empty() && keys.is_empty();
    (!is_dark).then(|| white(scene, Lights { suns, keys, ..Lights::default() }))
}

/// How a light is shaded.
#[derive(Clone, Copy)]
pub(super) struct Shaded {
    pub shape: Shape,
    /// By shadow heights, which give the light of exact horizons.
    pub is_exact: bool,
    /// Of its sweep.
    pub fuse: Fuse,
}

/// In the order of the shaders' numbers.
const FUSES: [Fuse; 6] =
    [Fuse::Nearest, Fuse::Slopes, Fuse::Own, Fuse::AimedNearest, Fuse::Aimed, Fuse::AimedAround];

/// Passes that light a sun or a key light.
const AIMED_PASSES: [&str; 2] = ["sun_shade", "shadow_shade"];

/// Names of the suns and key lights that a plan lights.
fn shaded_lights(plan: &Plan) -> BTreeSet<&str> {
    let passes = plan.passes.iter().filter(|p| AIMED_PASSES.contains(&p.name()));
    passes.filter_map(|p| p.part.split(' ').next()).collect()
}

/// Azimuths that contain a light, and how it is shaded there.
pub(super) fn azimuths_of(plan: &Plan, light: &str) -> Option<(Vec<Azimuth>, Shaded)> {
    // "sun1", or "sun1 4+4" where one of several batches.
    let is_of = |part: &str| {
        part.strip_prefix(light).is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    let own = |pass: &&Pass| AIMED_PASSES.contains(&pass.name()) && is_of(&pass.part);
    let passes: Vec<&Pass> = plan.passes.iter().filter(own).collect();
    let first = passes.first()?;
    let is_exact = first.name() == "shadow_shade";
    let shape = [Shape::Disc, Shape::Point, Shape::Patch][first.constant("shape")? as usize];
    let ranges = passes.iter().map(|p| p.azimuths.start as usize..p.azimuths.end as usize);
    let azimuths = ranges.flat_map(|range| plan.azimuths[range].iter().copied()).collect();
    // FUSE of the shaders; 0 and 7 mean that there is no sweep along lines.
    let mode = first.constant("fuse").unwrap_or_default() as usize;
    let fuse = mode.checked_sub(1).and_then(|mode| FUSES.get(mode).copied()).unwrap_or_default();
    Some((azimuths, Shaded { shape, is_exact, fuse }))
}

/// A sun's light of the CPU reference at each place and its tolerance, none where a point sun may be
/// visible or not.
fn aimed(
    scene: &Scene,
    azimuths: Vec<Azimuth>,
    places: &[usize],
    line_shift: u32,
    Shaded { shape, is_exact, fuse }: Shaded,
) -> Vec<Option<[DVec3; 2]>> {
    let cols = scene.field.cols();
    let light = |swept: &Swept, error: &ShadeError| {
        // Two products and a sum make a layer of a sum.
        let off = error.sun(weights(swept.azimuths, shape)) + 4.0 * EPSILON;
        let at = |p: &usize| {
            let (col, row) = ((p % cols) as i32, (p / cols) as i32);
            let mut grazes = false;
            swept.add_all([col, row], true, |_, azimuth, lowest, _| {
                let beside = lowest - f64::from(azimuth.high_slope);
                grazes |= shape == Shape::Point && beside.abs() <= error.lowest_slope();
            });
            (!grazes).then(|| [sun_at(swept, shape, col, row), off].map(DVec3::splat))
        };
        places.iter().map(at).collect()
    };
    if is_exact {
        exactly_lit(scene, azimuths, places, light)
    } else {
        lit(scene, azimuths, fuse, line_shift, light)
    }
}

/// A scene's ground, white, under other lights.
pub(super) fn white(scene: &Scene, lights: Lights) -> Scene {
    let albedo = Albedo::Constant([1.0; 3]);
    let surface = Surface { albedo, border: scene.surface.border, specular: None };
    Scene { field: scene.field.clone(), surface, lights }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::verify::tests::{layered, places, scene};
    use ridgelight::plan::{self, Limits, Picture};

    /// Wrong light is refused: of another fuse, of lines twice as far apart, of one more azimuth.
    #[test]
    fn wrong_skies_are_refused() {
        let scene = scene(48, Lights { sky: Some([1.0; 3]), ..Lights::default() });
        let quality = Quality { azimuths: 16, ..Quality::default() };
        let shift = quality.lines.shift().unwrap();
        let of = |quality: &Quality, shift| wanted(&scene, &places(), quality, shift);
        let wrong = [
            ("fuse", of(&Quality { fuse: Fuse::Nearest, ..quality }, shift).light()),
            ("wider lines", of(&quality, shift + 1).light()),
            ("an azimuth more", of(&Quality { azimuths: 17, ..quality }, shift).light()),
        ];
        of(&quality, shift).refuses(&quality, [1e-3, 0.999], &wrong);
    }

    /// The same of a sun 2° wide: 5° aside, half a degree above.
    #[test]
    fn wrong_suns_are_refused() {
        let quality = Quality { sun_azimuths: 8, ..Quality::default() };
        let shift = quality.lines.shift().unwrap();
        let of = |azimuth_rad: f64, elevation_rad: f64| {
            let diameter_rad = 2_f64.to_radians();
            let sun = Sun { azimuth_rad, elevation_rad, diameter_rad, irradiance: [1.0; 3] };
            let scene = scene(48, Lights { suns: vec![sun], ..Lights::default() });
            let (azimuths, shaded) =
                azimuths_of(&layered(&scene, &quality), "sun1").expect("a sun");
            let all = aimed(&scene, azimuths, &places(), shift, shaded);
            Wanted(all.into_iter().map(|both| both.expect("no point")).collect())
        };
        let wrong = [
            ("from beside", of(1.0 + 5_f64.to_radians(), 0.4).light()),
            ("from above", of(1.0, 0.41).light()),
        ];
        of(1.0, 0.4).refuses(&quality, [0.01, 0.9], &wrong);
    }

    /// A key light that reaches up to the horizontal lights an open field alone. Elsewhere the plan refuses a frame of that light, so
    /// none is drawn.
    #[test]
    fn key_lights_below_the_ground_are_not_drawn() {
        let key = |high| KeyLight {
            azimuth_rad: 1.0,
            width_rad: 0.5,
            elevations_rad: [-0.5, high],
            radiance: [2.0; 3],
        };
        for border in [Border::Plane, Border::Open, Border::Periodic] {
            for (high, is_lit) in [(0.0, border == Border::Open), (0.1, true)] {
                let mut scene = scene(48, Lights { keys: vec![key(high)], ..Lights::default() });
                scene.surface.border = border;
                let limits = Limits::lavapipe();
                let plan = plan::picture(&scene, &Quality::default(), &limits, Picture::default());
                assert_eq!(plan.is_ok(), is_lit, "{border:?} {high}");
                assert_eq!(aimed_alone(&scene).is_some(), is_lit, "{border:?} {high}");
            }
        }
    }

    /// A sun between two axes has a batch of azimuths along each: all are checked. A light of another number is none of them.
    #[test]
    fn all_batches_of_a_sun_are_checked() {
        let [azimuth_rad, elevation_rad] = [45.0_f64, 20.0].map(f64::to_radians);
        let diameter_rad = 2_f64.to_radians();
        let sun = Sun { azimuth_rad, elevation_rad, diameter_rad, irradiance: [1.0; 3] };
        let scene = scene(48, Lights { suns: vec![sun; 10], ..Lights::default() });
        let quality = Quality { sun_azimuths: 8, ..Quality::default() };
        let plan = layered(&scene, &quality);
        let split = plan.passes.iter().filter(|p| p.part.starts_with("sun1 ")).count();
        assert!(split > 1, "{split}");
        for light in ["sun1", "sun10"] {
            assert_eq!(azimuths_of(&plan, light).expect("a sun").0.len(), 8, "{light}");
        }
        assert!(azimuths_of(&plan, "sun11").is_none());
        let all: BTreeSet<String> = (1..=10).map(|i| format!("sun{i}")).collect();
        assert!(shaded_lights(&plan).into_iter().eq(all.iter().map(String::as_str)));
    }
}
