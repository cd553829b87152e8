//! Adds a bounce to default pictures where it changes them.

use ridgelight::Result;
use ridgelight::plan::Plan;
use ridgelight::scene::{Albedo, Border, Quality, Scene};
use ridgelight_cpu::light::sky_of;
use ridgelight_cpu::oracle::Oracle;

/// Number of grid points in the estimate, and of azimuths at each.
const GRID_POINTS: usize = 256;
const AZIMUTHS: usize = 16;
/// Smallest change, relative to the exit radiance of level ground. At middle grey (18 %) one 8-bit sRGB code is a change of 1.8 %.
const LEAST_GAIN: f64 = 0.02;
/// Share of the ground that must change by at least [`LEAST_GAIN`].
const GAINING_SHARE: f64 = 0.05;
/// Azimuths of the bounce, unless the user gives them. On Mt Rainier (1201², llvmpipe, measured by `compare` on 2026-11-29) 8 azimuths
/// instead of the default 32 change the light by less than 1.4 %, which is below one 8-bit code, at 99 % of the grid points.
const BOUNCE_AZIMUTHS: u32 = 8;

/// Estimates whether one bounce adds at least 2 % of the exit radiance of level ground at 5 % of the grid points.
///
/// At a grid point, other ground of the field fills a share of the cosine-weighted hemisphere. The estimate gives that ground the mean
/// albedo and the irradiance of level ground. In shadow the relative change is larger than the estimate, because there is less direct
/// light.
pub fn changes_picture(scene: &Scene) -> bool {
    gain(scene) >= LEAST_GAIN
}

/// Plans the picture with one bounce. `None` if the settings or the memory do not allow one, or if it would use brute force, which
/// takes far longer than the picture.
pub fn plan_with_bounce(
    quality: &Quality,
    has_azimuths: bool,
    plan: impl Fn(&Quality) -> Result<Plan>,
) -> Option<(Quality, Plan)> {
    let mut bounced = *quality;
    bounced.bounces.count = 1;
    if !has_azimuths {
        bounced.bounces.azimuths = BOUNCE_AZIMUTHS;
    }
    let plan = plan(&bounced).ok()?;
    let swept = ("bounce_engine".to_owned(), "sweep".to_owned());
    plan.settings.contains(&swept).then_some((bounced, plan))
}

/// Smallest gain among the 5 % of grid points that gain most, relative to the exit radiance of level ground.
fn gain(scene: &Scene) -> f64 {
    let field = &scene.field;
    let (rows, cols) = (field.rows(), field.cols());
    // With border `open`, everything that is not sky is ground of the field. The estimate ignores ground beyond the border: with
    // `plane` it reflects no light; with `periodic` this underestimates the bounce.
    let oracle = Oracle::new(field, Border::Open);
    let is_known = |[row, col]: &[usize; 2]| !field.voids().is_some_and(|v| v[row * cols + col]);
    let occluded = |[row, col]: [usize; 2]| 1.0 - sky_of(&oracle, row, col, AZIMUTHS);
    let points = (0..GRID_POINTS).map(|k| grid_point(k, [rows, cols])).filter(is_known);
    let mut shares: Vec<f64> = points.map(occluded).collect();
    shares.sort_unstable_by(f64::total_cmp);
    let gaining = (GAINING_SHARE * shares.len() as f64).ceil() as usize;
    let least = shares.len().checked_sub(gaining).and_then(|at| shares.get(at));
    least.map_or(0.0, |share| share * mean(&scene.surface.albedo))
}

/// Row and column of a grid point of the estimate, by the R2 sequence (Roberts 2018), which spreads evenly over a rectangle of any size.
fn grid_point(k: usize, [rows, cols]: [usize; 2]) -> [usize; 2] {
    let at = |step: f64, side: usize| (((k + 1) as f64 * step).fract() * side as f64) as usize;
    [at(0.754_877_666_246_692_7, rows), at(0.569_840_290_998_053_3, cols)]
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

    /// In a long valley whose sides meet at 90°, the mean view factor between the sides is 1 - sin 45° = 0.29 (Hottel's crossed
    /// strings). At the bottom it is 0.5.
    #[test]
    fn gain_is_occluded_share_times_albedo() {
        assert!(gain(&scene(|_, _| 5.0, 1.0)).abs() < 1e-9);
        let valley = |albedo| gain(&scene(|_, col| (col - 31.5).abs(), albedo));
        let white = valley(1.0);
        assert!((0.29..0.5).contains(&white), "{white}");
        assert!((valley(0.5) - white / 2.0).abs() < 1e-9 && valley(0.0) == 0.0);
        assert!(changes_picture(&scene(|_, col| (col - 31.5).abs(), 0.5)));
        // Between valley sides of slope 0.03 the view factor is at most 0.03².
        let shallow = scene(|row, _| 0.03 * (row - 31.5).abs(), 0.8);
        assert!(!changes_picture(&shallow), "{}", gain(&shallow));
        // A ramp has no other ground to reflect light to it.
        let ramp = scene(|row, col| 0.5 * row + 0.3 * col, 1.0);
        assert!(gain(&ramp).abs() < 1e-9, "{}", gain(&ramp));
    }

    /// No gap between the rows or columns of the 256 grid points exceeds 4/256 of the side, plus one, also where the side is a Fibonacci
    /// number.
    #[test]
    fn grid_points_are_spread_over_a_field_of_any_size() {
        for size in [[610, 900], [1597, 2584], [4181, 16_384], [64, 64], [1, 1], [2, 1000]] {
            let points: Vec<_> = (0..GRID_POINTS).map(|k| grid_point(k, size)).collect();
            for (axis, side) in size.into_iter().enumerate() {
                let mut all: Vec<usize> = points.iter().map(|point| point[axis]).collect();
                all.extend([0, side]);
                all.sort_unstable();
                let widest = all.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
                assert!(widest <= 1 + 4 * side / GRID_POINTS, "{size:?}, axis {axis}: {widest}");
                assert!(points.iter().all(|point| point[axis] < side));
            }
        }
    }
}
