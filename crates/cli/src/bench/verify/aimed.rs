//! Compares suns and key lights with the light of the same slices through the oracle's horizons, place by place.
//!
//! A horizon with an error moves a shadow's edge, and the places that the edge passes may differ by all of their light. So
//! every place has a range, from the light through the highest horizon that the method may find to that through the lowest.
//! Places within their range that differ by more than rounding are counted separately.

use glam::{DVec2, DVec3};
use ridgelight::Result;
use ridgelight::plan::Azimuth;
use ridgelight::plan::azimuths::Shape;
use ridgelight::scene::{Border, Fuse, Method, Precision, Quality, Scene};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::sun_shade::{sun_slice, weights};
use ridgelight_cpu::tolerance::{EPSILON, ShadeError, aimed_slope, device_fused_slope};

use super::sweeps::{AimedLayers, Shaded, azimuths_of};
use super::{colours, heights_m, percent, refused, sentence};

/// Checks the light of suns and key lights at some texels; `None` without such lights.
pub(super) fn check(
    AimedLayers { scene, plan, layers }: &AimedLayers,
    places: &[usize],
    quality: &Quality,
) -> Result<Option<String>> {
    let (mut found, mut all) = (Vec::new(), Vec::new());
    for layer in layers {
        let of = layer.name.strip_prefix("direct.").and_then(|light| azimuths_of(plan, light));
        let Some((azimuths, shaded)) = of else { continue };
        found.extend(colours(layer, places));
        all.extend(allowed(scene, &azimuths, shaded, places, quality));
    }
    if all.is_empty() {
        return Ok(None);
    }
    Ok(Some(judge(&found, &all, quality)?.text("sun and key light")))
}

/// The horizons that a method finds, apart from rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Horizons {
    /// Those of the surface.
    Exact,
    /// Those of points on the surface, perhaps not the highest: see the test `aimed_modes_are_lower_bounds`.
    NeverAbove,
    /// Too high or too low.
    Near,
}

pub(super) fn horizons(quality: &Quality, shaded: Shaded) -> Horizons {
    let is_aimed = matches!(shaded.fuse, Fuse::AimedNearest | Fuse::Aimed | Fuse::AimedAround);
    let is_swept = matches!(quality.method, Method::Auto | Method::Sweep)
        && quality.lines.shift().is_some()
        && quality.precision == Precision::F32;
    match shaded.is_exact {
        true => Horizons::Exact,
        false if is_swept && is_aimed => Horizons::NeverAbove,
        false => Horizons::Near,
    }
}

/// Light at one place: of one sun or key light, or R, G, B.
#[derive(Clone, Copy, Default)]
pub(super) struct Allowed<T = f64> {
    /// Through the oracle's horizons.
    pub light: T,
    /// Least and most, by the method's horizons.
    pub range: [T; 2],
    /// Of rounding.
    pub tolerance: T,
}

/// The allowed light at each place, of a sun of irradiance 1 or a key light of radiance 1 on white ground, in the plan's slices.
fn allowed(
    scene: &Scene,
    azimuths: &[Azimuth],
    shaded: Shaded,
    places: &[usize],
    quality: &Quality,
) -> Vec<Allowed> {
    let [low, high] = heights_m(&scene.field);
    let [x, y] = scene.field.cell_m();
    let tolerance = tolerance(azimuths, shaded.shape, high - low, x.min(y));
    let slice = |_, azimuth: &Azimuth, lowest: f64, normal: DVec3| {
        [sun_slice(azimuth, shaded.shape, lowest, normal), 0.0]
    };
    let all = allowed_by(scene, azimuths, shaded, places, quality, slice);
    all.into_iter().map(|place| Allowed { tolerance, ..place }).collect()
}

/// The allowed light at each place, as a sum over azimuths. `slice` returns light and tolerance of one azimuth at a place, above a
/// slope, for a normal. Neither may grow with the slope.
pub(super) fn allowed_by(
    scene: &Scene,
    azimuths: &[Azimuth],
    shaded: Shaded,
    places: &[usize],
    quality: &Quality,
    slice: impl Fn(usize, &Azimuth, f64, DVec3) -> [f64; 2],
) -> Vec<Allowed> {
    let (field, border) = (&scene.field, scene.surface.border);
    let oracle = Oracle::new(field, border);
    let heights = Heights::of(field, border);
    let [low, high] = heights_m(field);
    let largest = low.abs().max(high.abs());
    let step = azimuths.iter().map(|a| f64::from(a.step_m)).fold(f64::MAX, f64::min);
    // The CPU reference's horizon against the oracle's, and a device's against the CPU reference's.
    let rounding = aimed_slope(largest, step) + device_fused_slope(largest, step) + 3.0 * EPSILON;
    let [x, y] = field.cell_m();
    // As in `bounds`: two periods are marched.
    let side = (field.cols() as f64 * x).min(field.rows() as f64 * y);
    let beyond = if border == Border::Periodic { largest / side } else { 0.0 };
    let ground = if border == Border::Open { f64::NEG_INFINITY } else { 0.0 };
    let at = |place: &usize| {
        let (row, col) = (place / field.cols(), place % field.cols());
        let gradient = field_slope(&heights, col as i32, row as i32);
        let normal = normal_of(gradient);
        // Slopes of the lowest directions without other ground, and above the horizon.
        let lowest = |azimuth: &Azimuth| {
            let towards = DVec2::new(azimuth.cos_phi.into(), azimuth.sin_phi.into());
            let own = gradient.dot(towards).max(ground);
            let horizon = oracle.elevation_rad(row, col, azimuth.swept_rad([x, y])).tan();
            [own, own.max(horizon)]
        };
        let lowest: Vec<[f64; 2]> = azimuths.iter().map(lowest).collect();
        let sums = |which: usize, off: f64| {
            let slices = azimuths.iter().zip(&lowest);
            let all = slices.map(|(a, slopes)| slice(*place, a, slopes[which] + off, normal));
            all.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]])
        };
        let light = |which: usize, off: f64| -> f64 { sums(which, off)[0] };
        let (own, other) = (0, 1);
        let right = light(other, 0.0);
        let [open, tolerance] = sums(own, -rounding);
        let [least, most] = match horizons(quality, shaded) {
            Horizons::Exact => [light(other, rounding), light(other, -rounding - beyond)],
            Horizons::NeverAbove => [light(other, rounding), open],
            Horizons::Near => [0.0, open],
        };
        Allowed { light: right, range: [least.min(right), most.max(right)], tolerance }
    };
    places.iter().map(at).collect()
}

/// Tolerance of a light in slices, where no slice's end moves.
fn tolerance(azimuths: &[Azimuth], shape: Shape, relief_m: f64, cell_m: f64) -> f64 {
    let weights = weights(azimuths, shape);
    // A wedge of radiance 1 gives at most its width times the difference of two sines.
    let irradiance = if shape == Shape::Patch { 2.0 * weights } else { 1.0 };
    let error = ShadeError::new(0.0, relief_m, cell_m, azimuths.len());
    // Two products and a sum make a layer of a sum.
    error.unmoved_sun(weights, irradiance) + 4.0 * EPSILON
}

/// What was found at all places, where each is within its range.
#[derive(Debug, Default)]
pub(super) struct Judged {
    pub places: usize,
    /// Places that differ by more than rounding.
    pub others: usize,
    /// The largest error of the rest, and its tolerance.
    pub error: f64,
    pub bound: f64,
    /// The most light that any place may have.
    pub brightest: f64,
}

fn judge(found: &[DVec3], all: &[Allowed], quality: &Quality) -> Result<Judged> {
    let grey = |Allowed { light, range, tolerance }: &Allowed| Allowed {
        light: DVec3::splat(*light),
        range: range.map(DVec3::splat),
        tolerance: DVec3::splat(*tolerance),
    };
    let all: Vec<_> = all.iter().map(grey).collect();
    judge_each("a sun or key light at one place has light", found, &all, quality)
}

/// Judges each place by its own range.
pub(super) fn judge_each(
    what: &str,
    found: &[DVec3],
    all: &[Allowed<DVec3>],
    quality: &Quality,
) -> Result<Judged> {
    let mut judged = Judged { places: all.len(), ..Judged::default() };
    for (found, Allowed { light, range: [least, most], tolerance }) in found.iter().zip(all) {
        for c in 0..3 {
            let [wrong, start, end] = [found[c], least[c] - tolerance[c], most[c] + tolerance[c]];
            // NaN is in no range.
            if !(start..=end).contains(&wrong) {
                let what = format!("{what} {wrong:e}, expected {start:e} to {end:e}");
                return Err(refused(&what, quality));
            }
        }
        let error = (*found - *light).abs();
        if error.cmpgt(*tolerance).any() {
            judged.others += 1;
        } else {
            judged.error = judged.error.max(error.max_element());
        }
        judged.bound = judged.bound.max(tolerance.max_element());
        judged.brightest = judged.brightest.max(most.max_element());
    }
    Ok(judged)
}

impl Judged {
    pub fn text(&self, light: &str) -> String {
        let Self { places, others, error, bound, brightest } = *self;
        if brightest <= 0.0 {
            return sentence(light, "the oracle", (f64::INFINITY, f64::INFINITY));
        }
        let [error, bound] = [error, bound].map(|value| percent(value / brightest));
        let alike = places - others;
        format!(
            "{light} error {error} against the oracle at {alike} of {places} places (largest; bound {bound} of the \
             brightest place's light), other shadow edges at {others}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::verify::tests::{layered, scene};
    use ridgelight::scene::{Lights, Sun};

    fn sun(diameter_rad: f64) -> Sun {
        let [azimuth_rad, elevation_rad] = [1.0, 6.0_f64.to_radians()];
        Sun { azimuth_rad, elevation_rad, diameter_rad, irradiance: [1.0; 3] }
    }

    /// The allowed light of a low sun at every 5th texel of a fractal. The slices come from a plan with exact shadows, whatever
    /// `is_exact` is.
    fn of(quality: &Quality, is_exact: bool) -> Vec<Allowed> {
        let sun = sun(2_f64.to_radians());
        let scene = scene(48, Lights { suns: vec![sun], ..Lights::default() });
        let plan = layered(&scene, quality);
        let (azimuths, shaded) = azimuths_of(&plan, "sun1").expect("a sun");
        let places: Vec<usize> = (0..48 * 48).step_by(5).collect();
        allowed(&scene, &azimuths, Shaded { is_exact, ..shaded }, &places, quality)
    }

    fn light(all: &[Allowed]) -> Vec<DVec3> {
        all.iter().map(|place| DVec3::splat(place.light)).collect()
    }

    /// Light with exact shadows has a tight bound even under a low sun, in the open, in shadow and where the disc is partly hidden.
    /// An error of a hundredth of the brightest light, up or down, is refused at each kind of place.
    #[test]
    fn wrong_light_is_refused_away_from_edges_and_at_them() {
        let quality = Quality { sun_azimuths: 8, ..Quality::default() };
        let all = of(&quality, true);
        let right = light(&all);
        let judged = judge(&right, &all, &quality).unwrap();
        assert_eq!((judged.others, judged.error), (0, 0.0));
        assert!(judged.bound < 0.01 * judged.brightest, "{judged:?}");
        let open = of(&Quality { method: Method::Sweep, ..quality }, false);
        let brightest = judged.brightest;
        // Dark, partly hidden, unshadowed.
        let kind = |i: usize| -> usize {
            match (all[i].light, open[i].range[1]) {
                (0.0, _) => 0,
                (light, most) if light < 0.95 * most => 1,
                _ => 2,
            }
        };
        let mut kinds = [0; 3];
        for (i, place) in all.iter().enumerate() {
            kinds[kind(i)] += 1;
            let [least, most] = place.range;
            for wrong in [least - 0.01 * brightest, most + 0.01 * brightest, f64::NAN] {
                let mut found = right.clone();
                found[i].y = wrong;
                let error = judge(&found, &all, &quality).unwrap_err().to_string();
                assert!(error.contains("a sun or key light at one place has light"), "{error}");
            }
            // All of the light, or none, where a part of the disc is visible.
            if kind(i) == 1 && open[i].range[1] - most > 0.01 * brightest {
                let mut found = right.clone();
                found[i] = DVec3::splat(open[i].range[1]);
                assert!(judge(&found, &all, &quality).is_err(), "{i} without a shadow");
            }
        }
        assert!(kinds.iter().all(|count| *count > 0), "{kinds:?}");
        let dim: Vec<DVec3> = right.iter().map(|v| 0.97 * *v).collect();
        assert!(judge(&dim, &all, &quality).is_err());
        let mut turned = right.clone();
        turned.rotate_left(1);
        assert!(judge(&turned, &all, &quality).is_err());
    }

    /// Sweeps may miss an occluder, so a place may be brighter up to its unshadowed light, but not darker. Without an aimed
    /// mode it may be dark. The places that differ are counted.
    #[test]
    fn other_shadows_of_sweeps_are_counted_apart() {
        let swept = Quality { method: Method::Sweep, sun_azimuths: 8, ..Quality::default() };
        let near = Quality { fuse: Fuse::Nearest, ..swept };
        for (quality, may_be_dark) in [(swept, false), (near, true)] {
            let all = of(&quality, false);
            let right = light(&all);
            let hidden: Vec<usize> = (0..all.len())
                .filter(|i| all[*i].range[1] > all[*i].light + all[*i].tolerance)
                .collect();
            assert!(!hidden.is_empty());
            let mut found = right.clone();
            hidden.iter().for_each(|i| found[*i] = DVec3::splat(all[*i].range[1]));
            let judged = judge(&found, &all, &quality).unwrap();
            assert_eq!(judged.others, hidden.len());
            assert_eq!((judged.places, judged.error), (all.len(), 0.0));
            let text = judged.text("sun");
            assert!(text.ends_with(&format!("other shadow edges at {}", hidden.len())), "{text}");
            found[hidden[0]] += DVec3::splat(2.0 * all[hidden[0]].tolerance);
            assert!(judge(&found, &all, &quality).is_err(), "more than unshadowed");
            let lit = (0..all.len()).max_by(|a, b| all[*a].light.total_cmp(&all[*b].light));
            let mut dark = right.clone();
            dark[lit.expect("a place")] = DVec3::ZERO;
            assert_eq!(judge(&dark, &all, &quality).is_ok(), may_be_dark, "{quality:?}");
        }
    }

    /// A point sun on the horizon may be visible or not: values from dark to lit are accepted there, and no others.
    #[test]
    fn only_a_place_at_an_edge_may_differ_by_all_of_its_light() {
        let quality = Quality::default();
        let place = |range| Allowed { light: 1.0, range, tolerance: 1e-3 };
        let judged = |range, light: f64| judge(&[DVec3::splat(light)], &[place(range)], &quality);
        for light in [0.0, 0.5, 1.0] {
            let others = judged([0.0, 1.0], light).unwrap().others;
            assert_eq!(others, usize::from(light < 1.0), "{light}");
        }
        assert!(judged([1.0, 1.0], 0.9995).is_ok() && judged([1.0, 1.0], 1.0005).is_ok());
        for (range, light) in [
            ([1.0, 1.0], 0.998),
            ([1.0, 1.0], 1.002),
            ([0.0, 1.0], -0.002),
            ([0.0, 1.0], 1.002),
            ([0.0, 1.0], f64::NAN),
            ([0.0, 1.0], f64::INFINITY),
        ] {
            assert!(judged(range, light).is_err(), "{light} in {range:?}");
        }
    }

    /// Only shadow heights are exact, and only aimed modes of f32 sweeps return points of the surface.
    #[test]
    fn horizons_are_as_the_method_finds_them() {
        let [by_heights, by_sweeps] = [true, false].map(|is_exact| Shaded {
            shape: Shape::Disc,
            is_exact,
            fuse: Fuse::Aimed,
        });
        let base = Quality::default();
        assert_eq!(horizons(&base, by_heights), Horizons::Exact);
        assert_eq!(horizons(&base, by_sweeps), Horizons::NeverAbove);
        let by_slopes = Shaded { fuse: Fuse::Slopes, ..by_sweeps };
        assert_eq!(horizons(&base, by_slopes), Horizons::Near);
        for quality in [
            Quality { precision: Precision::Packed, ..base },
            Quality { method: Method::Pyramid, ..base },
        ] {
            assert_eq!(horizons(&quality, by_sweeps), Horizons::Near, "{quality:?}");
        }
    }
}
