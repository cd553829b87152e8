//! A sky through horizons of sweeps along lines, beside the same sweeps and the same look around each sample on the
//! processor: what f32 may do is all that may lie between.

use ridgelight::Result;
use ridgelight::cpu::horizon_sweep::{SweepOptions, horizon_sweep};
use ridgelight::cpu::lattice::{Lattices, number_layers};
use ridgelight::cpu::shared::gather::Swept;
use ridgelight::cpu::shared::sweep::Heights;
use ridgelight::cpu::sky_shade::sky_at;
use ridgelight::gpu::Headless;
use ridgelight::measure::tolerance::{EPSILON, ShadeError, twin_fused_slope};
use ridgelight::plan::azimuths::even;
use ridgelight::plan::{self, Axis, Limits, Picture};
use ridgelight::scene::{
    Albedo, Border, Lights, Lines, Method, Precision, Quality, Scene, Surface,
};

use super::{percent, rms, within};

/// A sky of radiance 1 on a scene's ground, white, at some of its samples; nothing where it is not swept along lines
/// that the twin follows: packed horizons are rounded, and where a field repeats lines may stand closer than asked
/// for.
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
    let white =
        Surface { albedo: Albedo::Constant([1.0; 3]), border: scene.surface.border, phong: None };
    let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let scene = Scene { field: scene.field.clone(), surface: white, lights: sky };
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
    let (error, bound) = judge(&found, &want, bound, quality)?;
    Ok(Some(format!(
        "a sky {} off the same sweeps' on the processor (RMSE; bound {})",
        percent(error),
        percent(bound)
    )))
}

/// Light of the twin, and what a device's may be off by at any place.
fn wanted(scene: &Scene, places: &[usize], quality: &Quality, line_shift: u32) -> (Vec<f64>, f64) {
    let (field, border) = (&scene.field, scene.surface.border);
    let (rows, cols) = (field.rows(), field.cols());
    let heights = Heights::of(field, border);
    let mut azimuths = even(quality.azimuths, field.cell_m());
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
    let want = places.iter().map(|p| sky_at(&swept, (p % cols) as i32, (p / cols) as i32));
    let all = || field.heights_m().iter().map(|h| f64::from(*h));
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
    let step = azimuths.iter().map(|a| f64::from(a.step_m)).fold(f64::MAX, f64::min);
    // A lattice's slope is 6 ε of itself off, which turns an angle by half of that at most.
    let slope = twin_fused_slope(low.abs().max(high.abs()), step) + 3.0 * EPSILON;
    let [x, y] = field.cell_m();
    let error = ShadeError::new(slope, high - low, x.min(y), azimuths.len());
    (want.collect(), error.sky())
}

/// RMSE over the root mean square, and the bound, where every place is within it.
fn judge(found: &[f64], want: &[f64], bound: f64, quality: &Quality) -> Result<(f64, f64)> {
    let scale = rms(want.iter().copied()).max(f64::MIN_POSITIVE);
    let off: Vec<f64> = found.iter().zip(want).map(|(a, b)| (a - b) / scale).collect();
    for one in &off {
        within("a sky at one place is", "the twin's", one.abs(), bound / scale, quality)?;
    }
    Ok((rms(off.into_iter()), bound / scale))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::measure::fractal::fractal;
    use ridgelight::scene::Fuse;

    /// What broken passes would give is refused: light a thousandth dim, of another fuse, of lines twice as far apart,
    /// of an azimuth more, of a neighbour, and NaN.
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
        assert!(judge(&right, &right, bound, &quality).is_ok());
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
            assert!(judge(&light, &right, bound, &quality).is_err(), "{name} passes");
        }
    }
}
