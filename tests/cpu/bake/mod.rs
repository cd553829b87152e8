//! Baked maps against closed forms for known horizons (level ground, a basin, a wall, a canyon, planes), and
//! against the f64 quadrature on fields.

mod curved;
mod curved_grooves;
mod ellipses;
mod facets;
mod specular;

use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::zonal;
use ridgelight::scene::fractal;
use ridgelight::scene::{Border, HeightField, Receiver, Wedges};
use ridgelight_bake::{
    BentNormal, HorizonMap, HorizonSums, MAX_TRANSFER_ORDER, Ray, ShTransfer, ShVisibility,
    SkyView, VisibleSky, normals,
};
use ridgelight_cpu::basis::turned;
use ridgelight_cpu::light::{normal, sky_of};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sh_visibility::{Series, visibility_along};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Azimuths of a circle.
const COUNT: usize = 512;

/// The values of one texel whose horizon is a function of azimuth.
fn of(what: Box<dyn HorizonMap>, normal: DVec3, horizon: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut sums = HorizonSums::new(what, 1);
    let width_rad = TAU / COUNT as f64;
    for k in 0..COUNT {
        let azimuth_rad = width_rad * k as f64;
        sums.add(Ray { azimuth_rad, width_rad }, &[horizon(azimuth_rad) as f32], &[normal])
            .unwrap();
    }
    sums.end(&[normal]).unwrap().iter().map(|plane| f64::from(plane[0])).collect()
}

/// Error of `COUNT` even azimuths: (2π/COUNT)²/8 times a kink's change of slope, of which these horizons have
/// two, of up to 2 times `steep`; f32 elevations and values add 2^-22 or less.
fn tolerance(steep: f64) -> f64 {
    2.0 * steep * (TAU / COUNT as f64).powi(2) / 8.0 * 2.0 + 1.0 / f64::from(1 << 21)
}

fn close(found: f64, expected: f64, allowed: f64, what: &str) {
    assert!((found - expected).abs() <= allowed, "{what}: {found} for {expected} ± {allowed:e}");
}

const ELEVATIONS: [f64; 6] = [0.0, 1e-3, 0.3, 0.8, 1.3, 1.57];

/// A rim of elevation b all around. Uniform light on level ground: sin² of the free cone's half-angle, cos²b.
/// Solid angle 1 - sin b. The mean direction is up, and the cone's half-angle is π/2 - b.
#[test]
fn maps_of_a_basin() {
    for b in ELEVATIONS {
        let allowed = tolerance(0.0);
        let up = DVec3::Z;
        close(of(Box::new(SkyView), up, |_| b)[0], b.cos().powi(2), allowed, "sky view");
        close(of(Box::new(VisibleSky), up, |_| b)[0], 1.0 - b.sin(), allowed, "visible sky");
        let bent = of(Box::new(BentNormal), up, |_| b);
        for (found, expected) in bent.iter().zip([0.0, 0.0, 1.0, FRAC_PI_2 - b]) {
            // A direction of a small cone is a quotient of small numbers, its half-angle a root.
            close(*found, expected, allowed + 1e-7, "bent normal");
        }
        for order in 1..=6 {
            let cap = turned(&ridgelight_cpu::basis::cap(order, FRAC_PI_2 - b), up);
            let found = of(Box::new(ShVisibility::new(order)), up, |_| b);
            for (f, e) in found.iter().zip(&cap) {
                close(*f, *e, 4.0 * allowed, "visibility");
            }
        }
    }
}

/// An infinite wall of elevation b due east: along φ its horizon is atan(tan b cos φ). The free sky is a lune
/// between the western horizon and the wall's edge plane, π - b wide: light (1 + cos b)/2, solid angle 2 (π -
/// b) of 2π, middle b/2 west of up; the cone of equal size has 1 - cos a = 1 - b/π.
#[test]
fn maps_of_a_wall() {
    for b in [1e-3_f64, 0.3, 0.8, 1.3] {
        let horizon = |phi: f64| (b.tan() * phi.cos()).max(0.0).atan();
        let allowed = tolerance(b.tan());
        let up = DVec3::Z;
        close(of(Box::new(SkyView), up, horizon)[0], 0.5 * (1.0 + b.cos()), allowed, "sky view");
        close(of(Box::new(VisibleSky), up, horizon)[0], 1.0 - b / PI, allowed, "visible sky");
        let bent = of(Box::new(BentNormal), up, horizon);
        let (sin, cos) = (b / 2.0).sin_cos();
        for (found, expected) in bent.iter().zip([-sin, 0.0, cos, (b / PI).acos()]) {
            close(*found, expected, 4.0 * allowed, "bent normal");
        }
    }
}

/// Walls of elevation b on both sides: cos b, and 1 - 2b/π.
#[test]
fn maps_of_a_canyon() {
    for b in [0.1_f64, 0.7, 1.2] {
        let horizon = |phi: f64| (b.tan() * phi.cos()).abs().atan();
        let allowed = 2.0 * tolerance(b.tan());
        close(of(Box::new(SkyView), DVec3::Z, horizon)[0], b.cos(), allowed, "sky view");
        let visible = of(Box::new(VisibleSky), DVec3::Z, horizon)[0];
        close(visible, 1.0 - 2.0 * b / PI, allowed, "visible sky");
        // The two maps differ: where half the light is left, a third of the sky is.
        if b > 0.5 {
            assert!((visible - b.cos()).abs() > 0.1);
        }
    }
}

/// A plane of slope s, rising to the east. Infinite, with its own horizon above and below: 1, its whole hemisphere;
/// its transfer is the clamped cosine over π about its normal. Above level ground alone: (1 + cos tilt)/2.
#[test]
fn maps_of_a_plane() {
    for slope in [0.0_f64, 0.5, 1.0, 4.0] {
        let tilt = slope.atan();
        let up = DVec3::new(-tilt.sin(), 0.0, tilt.cos());
        let own = |phi: f64| (slope * phi.cos()).atan();
        let allowed = tolerance(slope.max(1.0));
        close(of(Box::new(SkyView), up, own)[0], 1.0, allowed, "free");
        let above = |phi: f64| own(phi).max(0.0);
        let half = 0.5 * (1.0 + tilt.cos());
        close(of(Box::new(SkyView), up, above)[0], half, allowed, "above ground");
        // Wherever the horizon lies below the plane, only light from above the plane arrives.
        close(of(Box::new(SkyView), up, |_| -FRAC_PI_2)[0], 1.0, allowed, "nothing but itself");
        for order in 1..=MAX_TRANSFER_ORDER {
            let cosine = turned(&zonal::clamped_cosine(order), up);
            for horizon in [&own as &dyn Fn(f64) -> f64, &|_| -FRAC_PI_2] {
                let found = of(Box::new(ShTransfer::new(order)), up, horizon);
                for (f, e) in found.iter().zip(&cosine) {
                    close(*f, e / PI, 4.0 * allowed, "transfer");
                }
            }
        }
    }
}

/// The transfer of a uniform sky of radiance 1 above horizontal matches the sky view up to the series' error at
/// the step of the horizon. The first coefficient alone, Y_00 = 1/√4π of all directions, is exact where no
/// light comes from below: t_0 = sky view/√4π.
#[test]
fn transfer_and_sky_view_agree() {
    let horizon = |phi: f64| 0.4 + 0.3 * (2.0 * phi).sin();
    let up = DVec3::new(0.3, -0.2, 0.8).normalize();
    let view = of(Box::new(SkyView), up, horizon)[0];
    for order in 1..=MAX_TRANSFER_ORDER {
        let first = of(Box::new(ShTransfer::new(order)), up, horizon)[0];
        close(first * (4.0 * PI).sqrt(), view, 1e-6, "first coefficient");
    }
    let visible = of(Box::new(ShVisibility::new(3)), up, horizon)[0];
    let share = of(Box::new(VisibleSky), up, horizon)[0];
    close(visible * (4.0 * PI).sqrt() / TAU, share, 1e-6, "of all that is free");
}

/// Coefficients against quadrature over directions without slices: Gauss' rule above the horizon in elevation;
/// in azimuth the same rays, so their rule does not enter the difference.
#[test]
fn coefficients_are_integrals() {
    let horizon = |phi: f64| f64::from((0.2 + 0.5 * (phi - 1.0).sin()) as f32);
    let up = DVec3::new(-0.5, 0.3, 0.7).normalize();
    let (visible, transfer) = (
        of(Box::new(ShVisibility::new(6)), up, horizon),
        of(Box::new(ShTransfer::new(5)), up, horizon),
    );
    let (mut direct, mut lit) = (vec![0.0; 36], vec![0.0; 25]);
    let width = TAU / COUNT as f64;
    for k in 0..COUNT {
        let phi = width * k as f64;
        let along =
            |omega: f64| DVec3::new(omega.cos() * phi.cos(), omega.cos() * phi.sin(), omega.sin());
        let own = (-(up.x * phi.cos() + up.y * phi.sin())).atan2(up.z);
        for (low, is_lit) in [(horizon(phi), false), (horizon(phi).max(own), true)] {
            for (omega, weight) in ridgelight::basis::quadrature::points(low, FRAC_PI_2) {
                let e = along(omega);
                let weight = weight * width * omega.cos();
                if is_lit {
                    let cosine = weight * up.dot(e) / PI;
                    lit.iter_mut().zip(evaluate(5, e)).for_each(|(sum, y)| *sum += cosine * y);
                } else {
                    direct.iter_mut().zip(evaluate(6, e)).for_each(|(sum, y)| *sum += weight * y);
                }
            }
        }
    }
    for (found, expected) in visible.iter().zip(&direct).chain(transfer.iter().zip(&lit)) {
        // Values in f32, and a rule of polynomials on sines.
        close(*found, *expected, 1e-6, "coefficient");
    }
}

/// On a field: the sky view by the oracle's horizons matches the oracle's light of a uniform sky in as many
/// azimuths, and the coefficients match the CPU reference of `sh_visibility`.
#[test]
fn maps_agree_with_cpu_references() {
    let rough = fractal(17, 5).unwrap();
    let heights: Vec<f64> = rough.heights_m().iter().map(|h| 3.0 * f64::from(*h)).collect();
    let field = HeightField::new(17, 17, &heights, [1.0, 1.5], None).unwrap();
    for border in [Border::Plane, Border::Open, Border::Periodic] {
        let (oracle, normals) = (Oracle::new(&field, border), normals(&field, border));
        let (count, texels) = (16, 17 * 17);
        let width_rad = TAU / count as f64;
        let kinds: [Box<dyn HorizonMap>; 2] = [Box::new(SkyView), Box::new(ShVisibility::new(4))];
        let mut sums = kinds.map(|kind| HorizonSums::new(kind, texels));
        let mut horizons = vec![Vec::new(); texels];
        for k in 0..count {
            let azimuth_rad = width_rad * f64::from(k);
            let at = |i: usize| oracle.elevation_rad(i / 17, i % 17, azimuth_rad) as f32;
            let elevations: Vec<f32> = (0..texels).map(at).collect();
            for (i, elevation) in elevations.iter().enumerate() {
                let elevation = f64::from(*elevation).clamp(-FRAC_PI_2, FRAC_PI_2);
                horizons[i].push([azimuth_rad, width_rad, elevation.tan()]);
            }
            let ray = Ray { azimuth_rad, width_rad };
            sums.iter_mut().for_each(|sum| sum.add(ray, &elevations, &normals).unwrap());
        }
        let [view, series] = sums.map(|sum| sum.end(&normals).unwrap());
        for i in (0..texels).step_by(7) {
            let (row, col) = (i / 17, i % 17);
            assert_eq!(normals[i], normal(&field, border, row, col));
            // Elevations of f32, 2^-23 of at most π/2, change a sum by no more than twice that, besides its own
            // rounding.
            let expected = sky_of(&Oracle::one_ray(&field, border), row, col, count as usize);
            close(view[0][i].into(), expected, 1e-6, "sky view");
            let reference = Series { order: 4, wedges: Wedges::Slices, receiver: Receiver::Cosine };
            for (plane, expected) in series.iter().zip(visibility_along(reference, &horizons[i])) {
                close(plane[i].into(), expected, 2e-6, "visibility");
            }
        }
    }
}

/// Extreme horizons: all free, nothing free, a tiny cone. Values are finite and in their ranges.
#[test]
fn extreme_horizons_have_finite_maps() {
    for elevation in [-FRAC_PI_2, -1e-30, 0.0, 1e-30, FRAC_PI_2 - 3e-7, FRAC_PI_2] {
        for up in [DVec3::Z, DVec3::X, DVec3::new(-1.0, 1e-9, 1e-9).normalize()] {
            let horizon = |_| elevation;
            for share in
                [of(Box::new(SkyView), up, horizon)[0], of(Box::new(VisibleSky), up, horizon)[0]]
            {
                assert!((0.0..=1.000_001).contains(&share), "{elevation} {up}: {share}");
            }
            let bent = of(Box::new(BentNormal), up, horizon);
            let length = DVec3::new(bent[0], bent[1], bent[2]).length();
            assert!((length - 1.0).abs() < 1e-6 && bent[2] >= 0.0, "{elevation}: {bent:?}");
            assert!((0.0..=PI + 1e-6).contains(&bent[3]), "{elevation}: {bent:?}");
            let all = of(Box::new(ShTransfer::new(2)), up, horizon);
            assert!(all.iter().all(|t| t.abs() < 0.461), "{elevation} {up}: {all:?}");
        }
    }
    // The whole sphere: a cone of π, upward by the order of the sum.
    let open = of(Box::new(BentNormal), DVec3::Z, |_| -FRAC_PI_2);
    close(open[3], PI, 1e-3, "the whole sphere");
}
