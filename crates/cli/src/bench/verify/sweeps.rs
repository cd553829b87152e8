//! Compares a sky through swept horizons with the same sweeps and the same near search on the CPU.
//! They may differ by f32 rounding only.

use ridgelight::Result;
use ridgelight::gpu::{Headless, Pixels};
use ridgelight::plan::azimuths::{Shape, even};
use ridgelight::plan::{self, Axis, Azimuth, Limits, Pass, Picture, Plan};
use ridgelight::scene::{
    Albedo, Border, KeyLight, Lights, Lines, Method, Precision, Quality, Scene, Sun, Surface,
};
use ridgelight_cpu::horizon_sweep::{SweepOptions, horizon_sweep};
use ridgelight_cpu::lattice::{Lattices, number_layers};
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::sky_shade::sky_at;
use ridgelight_cpu::sun_shade::sun_at;
use ridgelight_cpu::tolerance::{EPSILON, ShadeError, device_fused_slope};

use super::{environments, percent, rms, within};

/// A sky of radiance 1 and the scene's suns and key lights on white ground, at some texels. None
/// where the CPU reference does not follow the sweeps: packed horizons are rounded, and lines of a
/// periodic field may be denser than requested.
pub(super) fn check(
    scene: &Scene,
    places: &[usize],
    gpu: &mut Headless,
    quality: &Quality,
    limits: &Limits,
) -> Result<Option<String>> {
    let lines = match quality.lines.shift() {
        Some(shift) if shift <= Lines::Cell.shift().unwrap_or(0) => shift,
        Some(shift) if scene.surface.border != Border::Periodic => shift,
        _ => return Ok(None),
    };
    let is_followed = matches!(quality.method, Method::Auto | Method::Sweep);
    if !is_followed || quality.precision != Precision::F32 {
        return Ok(None);
    }
    let aimed = check_aimed(scene, places, gpu, quality, limits, lines)?;
    let around = environments::check(scene, places, gpu, (quality, lines), limits)?;
    let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let scene = Scene { lights: sky, ..white(scene) };
    let plan = plan::picture(&scene, quality, limits, Picture::default())?;
    if !plan.passes.iter().any(|pass| pass.name() == "horizon_sweep") {
        return Ok(None);
    }
    let picture = gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        gpu.pixels(frame, 0)
    })?;
    let found: Vec<f64> =
        places.iter().map(|p| picture.values[p * picture.channels].into()).collect();
    let (want, bound) = wanted(&scene, places, quality, lines);
    let (error, bound) = judge("the sky at one place", &found, &want, bound, quality)?;
    let of_sky = format!(
        "sky error {} against the CPU reference (RMSE; bound {})",
        percent(error),
        percent(bound)
    );
    let all: Vec<String> = [Some(of_sky), around, aimed].into_iter().flatten().collect();
    Ok(Some(all.join("; ")))
}

/// Light of the CPU reference, and its tolerance at any place.
fn wanted(scene: &Scene, places: &[usize], quality: &Quality, line_shift: u32) -> (Vec<f64>, f64) {
    let azimuths = even(quality.azimuths, scene.field.cell_m());
    let cols = scene.field.cols();
    lit(scene, azimuths, quality, line_shift, |swept, error| {
        let want = places.iter().map(|p| sky_at(swept, (p % cols) as i32, (p / cols) as i32));
        (want.collect(), error.sky())
    })
}

/// Light from sweeps along azimuths, and its tolerance.
pub(super) fn lit<T>(
    scene: &Scene,
    mut azimuths: Vec<Azimuth>,
    quality: &Quality,
    line_shift: u32,
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
        let options = SweepOptions { line_shift, warm_up, ..SweepOptions::default() };
        horizon_sweep(heights, azimuth, &options, lattices.of_mut(azimuth));
    }
    let (fuse, lattices) = (Some(quality.fuse), &lattices);
    let swept = Swept { heights, azimuths: &azimuths, lattices, fuse, line_shift, warm_up };
    let all = || field.heights_m().iter().map(|h| f64::from(*h));
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
    let step = azimuths.iter().map(|a| f64::from(a.step_m)).fold(f64::MAX, f64::min);
    // A lattice's slope has an error of 6 ε of itself, which changes an angle by at most half of
    // that.
    let slope = device_fused_slope(low.abs().max(high.abs()), step) + 3.0 * EPSILON;
    let [x, y] = field.cell_m();
    let error = ShadeError::new(slope, high - low, x.min(y), azimuths.len());
    light(&swept, &error)
}

/// Suns and key lights of a scene, each with irradiance or radiance 1 on white ground, by the same
/// sweeps; none where there are none or where they are not swept like the sky.
fn check_aimed(
    scene: &Scene,
    places: &[usize],
    gpu: &mut Headless,
    quality: &Quality,
    limits: &Limits,
    lines: u32,
) -> Result<Option<String>> {
    let Lights { suns, keys, .. } = &scene.lights;
    let lit_by = |c: &[f32; 3]| c.iter().any(|v| *v > 0.0);
    let suns: Vec<Sun> = suns.iter().filter(|s| lit_by(&s.irradiance)).copied().collect();
    let keys: Vec<KeyLight> = keys.iter().filter(|k| lit_by(&k.radiance)).copied().collect();
    if suns.is_empty() && keys.is_empty() {
        return Ok(None);
    }
    let suns = suns.into_iter().map(|sun| Sun { irradiance: [1.0; 3], ..sun }).collect();
    let keys = keys.into_iter().map(|key| KeyLight { radiance: [1.0; 3], ..key }).collect();
    let scene = &Scene { lights: Lights { suns, keys, ..Lights::default() }, ..white(scene) };
    let wanted = Picture { light_layers: true, ..Picture::default() };
    let plan = plan::picture(scene, quality, limits, wanted)?;
    let (mut found, mut all, mut bound) = (Vec::new(), Vec::new(), 0.0_f64);
    let (layers, plan) = gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        let plan = frame.plan().clone();
        let outputs = plan.outputs().count();
        let layers: Result<Vec<Pixels>> = (0..outputs).map(|o| gpu.pixels(frame, o)).collect();
        Ok((layers?, plan))
    })?;
    for layer in layers.iter().filter(|l| l.name.starts_with("direct.")) {
        let Some((azimuths, shape)) = azimuths_of(&plan, layer.name.trim_start_matches("direct."))
        else {
            continue;
        };
        let (want, most) = aimed(scene, azimuths, places, quality, lines, shape);
        for (place, want) in places.iter().zip(want) {
            let Some(want) = want else { continue };
            found.push(f64::from(layer.values[place * layer.channels]));
            all.push(want);
        }
        bound = bound.max(most);
    }
    let (error, bound) = judge("a sun at one place", &found, &all, bound, quality)?;
    Ok(Some(format!(
        "sun and key light error {} against the CPU reference (RMSE; bound {})",
        percent(error),
        percent(bound)
    )))
}

/// Azimuths that contain a light, and its shape there.
fn azimuths_of(plan: &Plan, light: &str) -> Option<(Vec<Azimuth>, Shape)> {
    let own = |pass: &&Pass| pass.name() == "sun_shade" && pass.part == light;
    let passes: Vec<&Pass> = plan.passes.iter().filter(own).collect();
    let shape = passes.first()?.constant("shape")?;
    let ranges = passes.iter().map(|p| p.azimuths.start as usize..p.azimuths.end as usize);
    let azimuths = ranges.flat_map(|range| plan.azimuths[range].iter().copied()).collect();
    Some((azimuths, [Shape::Disc, Shape::Point, Shape::Patch][shape as usize]))
}

/// A sun's light of the CPU reference at each place, none where a point sun may be visible or not;
/// and its tolerance.
fn aimed(
    scene: &Scene,
    azimuths: Vec<Azimuth>,
    places: &[usize],
    quality: &Quality,
    line_shift: u32,
    shape: Shape,
) -> (Vec<Option<f64>>, f64) {
    let cols = scene.field.cols();
    lit(scene, azimuths, quality, line_shift, |swept, error| {
        let weight = |a: &Azimuth| match shape {
            Shape::Patch => f64::from(a.wedge_rad),
            Shape::Disc | Shape::Point => f64::from(a.weight),
        };
        let at = |p: &usize| {
            let (col, row) = ((p % cols) as i32, (p / cols) as i32);
            let mut grazes = false;
            swept.add_all([col, row], true, |_, azimuth, lowest, _| {
                let off = lowest - f64::from(azimuth.high_slope);
                grazes |= shape == Shape::Point && off.abs() <= error.lowest_slope();
            });
            (!grazes).then(|| sun_at(swept, shape, col, row))
        };
        // Two products and a sum make a layer of a sum.
        let weights = swept.azimuths.iter().map(weight).sum();
        (places.iter().map(at).collect(), error.sun(weights) + 4.0 * EPSILON)
    })
}

/// A scene's ground, white, without lights.
pub(super) fn white(scene: &Scene) -> Scene {
    let white = Surface {
        albedo: Albedo::Constant([1.0; 3]),
        border: scene.surface.border,
        specular: None,
    };
    Scene { field: scene.field.clone(), surface: white, lights: Lights::default() }
}

/// RMSE over the root mean square, and the bound, where every place is within it.
fn judge(
    what: &str,
    found: &[f64],
    want: &[f64],
    bound: f64,
    quality: &Quality,
) -> Result<(f64, f64)> {
    let scale = rms(want.iter().copied()).max(f64::MIN_POSITIVE);
    let off: Vec<f64> = found.iter().zip(want).map(|(a, b)| (a - b) / scale).collect();
    for one in &off {
        within(what, "the CPU reference", one.abs(), bound / scale, quality)?;
    }
    Ok((rms(off.into_iter()), bound / scale))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::Fuse;
    use ridgelight::scene::fractal;

    /// Wrong light is refused: 0.1 % too dark, of another fuse, of lines twice as far apart, of one
    /// more azimuth, of a neighbour, and NaN.
    #[test]
    fn wrong_skies_are_refused() {
        let field = fractal(48, 1).unwrap();
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = Scene { field, surface: Surface::default(), lights };
        let places: Vec<usize> = (3..48 * 48).step_by(61).collect();
        let quality = Quality { azimuths: 16, ..Quality::default() };
        let shift = quality.lines.shift().unwrap();
        let (right, bound) = wanted(&scene, &places, &quality, shift);
        println!("bound {bound:e}");
        assert!(bound < 1e-3, "{bound}");
        assert!(judge("the sky", &right, &right, bound, &quality).is_ok());
        let of = |quality: &Quality, shift| wanted(&scene, &places, quality, shift).0;
        let mut turned = right.clone();
        turned.rotate_left(1);
        let mut holed = right.clone();
        holed[3] = f64::NAN;
        let wrong = [
            ("dim", right.iter().map(|v| 0.999 * v).collect()),
            ("of another fuse", of(&Quality { fuse: Fuse::Nearest, ..quality }, shift)),
            ("of wider lines", of(&quality, shift + 1)),
            ("of an azimuth more", of(&Quality { azimuths: 17, ..quality }, shift)),
            ("of a neighbour", turned),
            ("NaN", holed),
        ];
        for (name, light) in wrong {
            assert!(judge("the sky", &light, &right, bound, &quality).is_err(), "{name} passes");
        }
    }

    /// The same of a sun 2° wide: 10 % too dark, 5° aside, half a degree above, of a neighbour,
    /// NaN.
    #[test]
    fn wrong_suns_are_refused() {
        let field = fractal(48, 1).unwrap();
        let places: Vec<usize> = (3..48 * 48).step_by(61).collect();
        let quality = Quality { sun_azimuths: 8, ..Quality::default() };
        let shift = quality.lines.shift().unwrap();
        let of = |azimuth_rad: f64, elevation_rad: f64| {
            let diameter_rad = 2_f64.to_radians();
            let sun = Sun { azimuth_rad, elevation_rad, diameter_rad, irradiance: [1.0; 3] };
            let lights = Lights { suns: vec![sun], ..Lights::default() };
            let scene = Scene { field: field.clone(), surface: Surface::default(), lights };
            let wanted = Picture { light_layers: true, ..Picture::default() };
            let plan = plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).unwrap();
            let (azimuths, shape) = azimuths_of(&plan, "sun1").expect("a sun");
            let (light, bound) = aimed(&scene, azimuths, &places, &quality, shift, shape);
            (light.into_iter().map(|v| v.expect("no point")).collect::<Vec<f64>>(), bound)
        };
        let (right, bound) = of(1.0, 0.4);
        println!("bound {bound:e}");
        let refused = |light: &[f64]| judge("a sun", light, &right, bound, &quality).is_err();
        assert!(!refused(&right) && bound < 0.01, "{bound}");
        let mut turned = right.clone();
        turned.rotate_left(1);
        let mut holed = right.clone();
        holed[3] = f64::NAN;
        let wrong = [
            ("dim", right.iter().map(|v| 0.9 * v).collect()),
            ("from beside", of(1.0 + 5_f64.to_radians(), 0.4).0),
            ("from above", of(1.0, 0.41).0),
            ("of a neighbour", turned),
            ("NaN", holed),
        ];
        for (name, light) in wrong {
            assert!(refused(&light), "{name} passes");
        }
    }
}
