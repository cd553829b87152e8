//! Whether a picture of the default light has a bounce.

use ridgelight::Result;
use ridgelight::plan::Plan;
use ridgelight::scene::{Albedo, Quality, Scene};
use ridgelight_cpu::light::sky_of;
use ridgelight_cpu::oracle::Oracle;

/// Grid points of the estimate, and azimuths of each.
const PLACES: usize = 256;
const AZIMUTHS: usize = 16;
/// The least change that counts, over the light of level ground: in sRGB, one code of 255 at middle grey (18 %) is 2 % of its light.
const CODE: f64 = 0.02;
/// The share of the ground that must gain so much.
const SHARE: f64 = 0.05;
/// Azimuths of the bounce: over Mt Rainier, 1201², they change the light by less than that of a code at 99 % of the grid points, and
/// take half the time of the default's 32.
const BOUNCE_AZIMUTHS: u32 = 8;

/// Whether one bounce changes at least one code of 255 on a twentieth of the ground, by an estimate.
///
/// A grid point sees other ground in the part of its hemisphere, weighted by the cosine, that is not sky. The estimate takes
/// that ground to be as bright as the mean albedo under the light of level ground. In shadow, where there is less other light, the
/// change is larger than this.
pub fn is_visible(scene: &Scene) -> bool {
    gain(scene) >= CODE
}

/// The settings with one bounce, and their plan. `None` where other settings or the memory forbid a bounce, or where it would
/// march every azimuth of every grid point, which takes many times the picture's time.
pub fn planned(
    quality: &Quality,
    plan: impl Fn(&Quality) -> Result<Plan>,
) -> Option<(Quality, Plan)> {
    let mut bounced = *quality;
    bounced.bounces.count = 1;
    bounced.bounces.azimuths = quality.bounces.azimuths.min(BOUNCE_AZIMUTHS);
    let plan = plan(&bounced).ok()?;
    let swept = ("bounce_engine".to_owned(), "sweep".to_owned());
    plan.settings.contains(&swept).then_some((bounced, plan))
}

/// What a bounce adds to the ground that gains most, over the light of level ground.
fn gain(scene: &Scene) -> f64 {
    let (field, count) = (&scene.field, scene.field.rows() * scene.field.cols());
    let oracle = Oracle::new(field, scene.surface.border);
    let places = PLACES.min(count);
    // Steps of the golden ratio spread over the field whatever its size.
    let place = |k: usize| ((k as f64 * 0.618_033_988_749_895).fract() * count as f64) as usize;
    let is_known = |i: &usize| !field.voids().is_some_and(|voids| voids[*i]);
    let sees = |i: usize| 1.0 - sky_of(&oracle, i / field.cols(), i % field.cols(), AZIMUTHS);
    let mut ground: Vec<f64> = (0..places).map(place).filter(is_known).map(sees).collect();
    ground.sort_unstable_by(f64::total_cmp);
    let most = ground.len() - (SHARE * ground.len() as f64) as usize;
    ground.get(most.saturating_sub(1)).map_or(0.0, |sees| sees * mean(&scene.surface.albedo))
}

/// The mean over channels and grid points.
fn mean(albedo: &Albedo) -> f64 {
    let all = match albedo {
        Albedo::Constant(colour) => std::slice::from_ref(colour),
        Albedo::Map(colours) => colours,
    };
    let sum: f64 = all.as_flattened().iter().map(|v| f64::from(*v)).sum();
    sum / all.as_flattened().len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{HeightField, Lights, Surface};

    fn scene(heights: impl Fn(f64, f64) -> f64, albedo: f32) -> Scene {
        const SIDE: usize = 64;
        let at = |i: usize| heights((i / SIDE) as f64, (i % SIDE) as f64);
        let heights: Vec<f64> = (0..SIDE * SIDE).map(at).collect();
        let field = HeightField::new(SIDE, SIDE, &heights, [1.0; 2], None).unwrap();
        let albedo = Albedo::Constant([albedo; 3]);
        let surface = Surface { albedo, ..Surface::default() };
        Scene { field, surface, lights: Lights::default() }
    }

    /// Between two long sides at an angle of 90° from edge to edge, each sees of the other, in the mean, 1 - sin 45° = 0.29 of its
    /// hemisphere (Hottel's crossed strings), more towards the bottom: half of it there.
    #[test]
    fn ground_gains_by_what_it_sees() {
        assert!(gain(&scene(|_, _| 5.0, 1.0)).abs() < 1e-9);
        let valley = |albedo| gain(&scene(|_, col| (col - 31.5).abs(), albedo));
        let white = valley(1.0);
        assert!((0.29..0.5).contains(&white), "{white}");
        assert!((valley(0.5) - white / 2.0).abs() < 1e-9 && valley(0.0) == 0.0);
        assert!(is_visible(&scene(|_, col| (col - 31.5).abs(), 0.5)));
        // Hills of a slope of 0.03 hide at most 0.03² of a hemisphere's light from one another.
        let hills = scene(|row, _| 0.03 * (row - 31.5).abs(), 0.8);
        assert!(!is_visible(&hills), "{}", gain(&hills));
    }
}
