//! Phong specular reflection of a sun towards the view.

use crate::mirror_map::mirrored;
use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::scene::{PhongSpecular, Sun};
use std::f64::consts::{PI, TAU};

/// Exit radiance towards `view` for irradiance 1 at a normal, from the sun's light on diffuse ground there ([`crate::sun_shade`]).
///
/// The mean of the Phong lobe over the disc, times its visible part. Where a grid point's own plane or a horizon cuts the
/// disc, that part is weighted by the cosine and not by the lobe. With a light vector the mean is over the visible part.
pub fn specular_on(
    (normal, view): (DVec3, DVec3),
    sun: &Sun,
    phong: PhongSpecular,
    (sun_sum, vector): (f64, Option<DVec3>),
) -> f64 {
    let [exponent, scale] = [phong.exponent, phong.scale].map(f64::from);
    if let Some(vector) = vector.filter(|vector| vector.length() < WHOLE) {
        // Below it, directions are rounding.
        if vector.length() <= 1e-6 {
            return 0.0;
        }
        let part = visible_part(vector, sun);
        let mirror = mirrored(normal, view);
        return scale * vector.length() * part_density(mirror, sun, exponent, &part);
    }
    let visible = visible(normal, towards(sun), sun_sum);
    if visible == 0.0 {
        return 0.0;
    }
    scale * visible * disc_density(mirrored(normal, view), sun, exponent)
}

/// Integral of a lobe about `mirror` over a sun's disc, for irradiance 1. Lobes narrower than a seventh of the disc's
/// radius are widened to that: n r² is 48 at most.
pub fn disc_density(mirror: DVec3, sun: &Sun, exponent: f64) -> f64 {
    let centre = towards(sun);
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let level = DVec3::new(-sin, cos, 0.0);
    let whole = Ellipse { middle: centre, half_axes: [level, centre.cross(level)] };
    part_density(mirror, sun, exponent, &whole)
}

/// An ellipse on the sphere: its middle, and two half axes in radii of the sun.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse {
    /// A direction.
    pub middle: DVec3,
    /// At right angles to it and to one another.
    pub half_axes: [DVec3; 2],
}

/// Visible part of a sun, from its light vector, as the segment left by a straight edge. The segment's centre is c radii from the
/// sun's. Half axes of the ellipse with nearly its second moments: 1 - c, with an error of 0.05 radii at most, and
/// √((1 - c) (1 + 1.7 c)), with one of 0.01.
pub fn visible_part(vector: DVec3, sun: &Sun) -> Ellipse {
    let (mut middle, radius) = (vector.normalize_or_zero(), (0.5 * sun.diameter_rad).sin());
    let apart = (middle - towards(sun)).reject_from(middle.try_normalize().unwrap_or(DVec3::Z));
    let c = (apart.length() / radius).min(1.0);
    // Of a small share, rounding may move the centre out of the disc.
    if apart.length() > radius {
        middle = (towards(sun) + radius * apart.normalize()).normalize();
    }
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let along = match apart.length() > 1e-4 * radius {
        true => apart.normalize(),
        false => DVec3::new(-sin, cos, 0.0),
    };
    let across = ((1.0 - c) * (1.0 + 1.7 * c)).sqrt();
    Ellipse { middle, half_axes: [(1.0 - c) * along, across * middle.cross(along)] }
}

/// As [`disc_density`], over an ellipse within the disc.
fn part_density(mirror: DVec3, sun: &Sun, exponent: f64, part: &Ellipse) -> f64 {
    let radius = if sun.is_point() { 0.0 } else { 0.5 * sun.diameter_rad };
    let n = exponent.min(WIDEST / (radius * radius));
    let density = |e: DVec3| {
        let cosine = e.dot(mirror);
        // 0 to the power of 0 would be light from behind.
        if cosine <= 0.0 { 0.0 } else { (n + 1.0) / TAU * cosine.powf(n) }
    };
    let Ellipse { middle, half_axes: [along, up] } = *part;
    if radius == 0.0 {
        return density(middle);
    }
    let depth = 2.0 * (0.5 * radius).sin().powi(2);
    // The midpoint rule over 1 - cos of the angle to the centre, with as many directions as lobes need.
    let mut sum = 0.0;
    for ring in 0..RINGS {
        let h = depth * (ring as f64 + 0.5) / RINGS as f64;
        let across = (h * (2.0 - h)).sqrt();
        for k in 0..AROUND {
            let (sin, cos) = (TAU * (k as f64 + 0.5) / AROUND as f64).sin_cos();
            let offset = cos * along + sin * up;
            sum += density((1.0 - h * offset.length_squared()) * middle + across * offset);
        }
    }
    2.0 / (2.0 - depth) * sum / (RINGS * AROUND) as f64
}

/// The magnitude of a light vector above which a sun is wholly visible.
pub const WHOLE: f64 = 0.999;
/// Exponent times the squared radius of a disc, at most.
const WIDEST: f64 = 48.0;
const RINGS: usize = 128;
const AROUND: usize = 48;

/// Incident light of the sun for irradiance 1, as a series of n²: the visible fraction, all of it from the sun's
/// centre.
pub fn arriving(normal: DVec3, sun: &Sun, order: usize, sun_sum: f64) -> Vec<f64> {
    let towards = towards(sun);
    let visible = visible(normal, towards, sun_sum);
    evaluate(order, towards).iter().map(|y| visible * y).collect()
}

fn towards(sun: &Sun) -> DVec3 {
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let (up, along) = sun.elevation_rad.sin_cos();
    DVec3::new(cos * along, sin * along, up)
}

/// The visible fraction of a sun.
fn visible(normal: DVec3, towards: DVec3, sun_sum: f64) -> f64 {
    let facing = normal.dot(towards);
    if facing > 0.0 { (PI * sun_sum / facing).min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tolerance::disc_rings;
    use ridgelight::basis::legendre::{legendre, value};

    /// The part of a disc that a straight edge leaves has the stated centre and nearly the ellipse's squared widths, which are a
    /// quarter of its squared half axes: to 0.025 and 0.01 r². A whole disc in its place would be wrong by more.
    #[test]
    fn a_cut_disc_has_nearly_the_moments_of_its_ellipse() {
        let radius = 0.02;
        let sun = Sun {
            azimuth_rad: 0.3,
            elevation_rad: 0.5,
            diameter_rad: 2.0 * radius,
            irradiance: [1.0; 3],
        };
        let above = towards(&sun).cross(DVec3::new(-(0.3_f64.sin()), 0.3_f64.cos(), 0.0));
        let mut whole_is_wrong = false;
        for edge in -19..19 {
            // Strips across, in radii.
            let (mut area, mut first, mut along, mut across) = (0.0, 0.0, 0.0, 0.0);
            for k in 0..4000 {
                let y = (f64::from(k) + 0.5) / 2000.0 - 1.0;
                if y > f64::from(edge) / 20.0 {
                    let half = (1.0 - y * y).sqrt();
                    area += half;
                    first += half * y;
                    along += half * y * y;
                    across += half * (1.0 - y * y) / 3.0;
                }
            }
            let centre = first / area;
            let [along, across] = [along / area - centre * centre, across / area];
            let part = visible_part(towards(&sun) + centre * radius * above, &sun);
            let [a, b] = part.half_axes.map(|axis| 0.25 * axis.length_squared());
            assert!((a - along).abs() < 0.025, "{centre}: {a} for {along}");
            assert!((b - across).abs() < 0.01, "{centre}: {b} for {across}");
            assert!(part.half_axes[0].cross(above).length() < 0.05, "{centre}: turned");
            whole_is_wrong |= (0.25 - along).abs() > 0.025 && (0.25 - across).abs() > 0.01;
        }
        assert!(whole_is_wrong);
    }

    /// Nodes and weights of Gauss and Legendre on [0..1].
    fn gauss(count: usize) -> Vec<[f64; 2]> {
        if count == 0 {
            return Vec::new();
        }
        let (p, lower) = (legendre(count), legendre(count - 1));
        let slope = |x: f64| count as f64 * (value(&lower, x) - x * value(&p, x)) / (1.0 - x * x);
        let node = |i: usize| {
            let mut x = (PI * (i as f64 + 0.75) / (count as f64 + 0.5)).cos();
            for _ in 0..20 {
                x -= value(&p, x) / slope(x);
            }
            [0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope(x).powi(2))]
        };
        (0..count).map(node).collect()
    }

    /// Mean of cos^n over a disc, by rings of given weights, the first direction of each half a step from the plane of
    /// disc and mirror direction, and `turned` by more.
    fn mean(
        rings: &[[f64; 2]],
        around: usize,
        (radius, n, angle): (f64, f64, f64),
        turned: f64,
    ) -> f64 {
        let depth = 1.0 - radius.cos();
        let (sin, cos) = angle.sin_cos();
        let ring = |[node, weight]: &[f64; 2]| {
            let h = depth * node;
            let across = (h * (2.0 - h)).sqrt();
            let at = |k: usize| {
                let phi = TAU * (k as f64 + 0.5) / around as f64 + turned;
                let cosine = (1.0 - h) * cos + across * phi.cos() * sin;
                if cosine > 0.0 { cosine.powf(n) } else { 0.0 }
            };
            weight / around as f64 * (0..around).map(at).sum::<f64>()
        };
        rings.iter().map(ring).sum()
    }

    /// The rule of sun_specular.comp, in f64: the number of rings; 0: the value at the centre with its second derivatives.
    fn rings(radius: f64, n: f64, angle: f64) -> usize {
        let (wide, to_end) = (n * radius * radius, angle.cos().abs());
        let near = if n >= 1.0 { 4.0 } else { 10.0 };
        match wide {
            _ if to_end < 2.0 * radius.sin() && n >= 1.0 && radius < 0.01 => 1,
            _ if to_end < 2.0 * radius.sin() => 8,
            _ if wide <= 0.05 && to_end >= near * radius.sin() => 0,
            _ if wide <= 0.15 => 1,
            _ if wide <= 2.0 => 2,
            _ if wide <= 11.0 => 4,
            _ => 8,
        }
    }

    /// Rings of the device and of the reference stay within `disc_rings` of 250 rings of 250 directions, from the
    /// narrowest to the widest sun, on both sides of each change of their number. A number too few does not.
    #[test]
    fn rings_are_as_many_as_a_lobe_needs() {
        let fine: Vec<_> = (0..250).map(|i| [(f64::from(i) + 0.5) / 250.0, 1.0 / 250.0]).collect();
        let reference: Vec<_> =
            (0..RINGS).map(|i| [(i as f64 + 0.5) / RINGS as f64, 1.0 / RINGS as f64]).collect();
        let rules: Vec<_> = (0..9).map(gauss).collect();
        let mut too_few = [0; 9];
        for radius in [0.004, 0.0099, 0.03, 0.04, 0.17, 0.4, 0.8, 1.5] {
            let sun = Sun {
                azimuth_rad: 0.0,
                elevation_rad: 0.0,
                diameter_rad: 2.0 * radius,
                irradiance: [1.0; 3],
            };
            let changes = [0.05, 0.15, 2.0, 11.0, 47.0].map(|wide| wide / (radius * radius));
            let exponents = changes.iter().flat_map(|n| [0.999 * n, 1.001 * n]);
            for n in exponents.chain([0.0, 0.1, 0.3, 0.6, 0.9, 1.0, 1.1, 1.5]) {
                if n > 1e4 || n * radius * radius > 48.0 {
                    continue;
                }
                let width = (1.0 / n.max(1.0)).sqrt();
                let near = (0..8).map(|i| f64::from(i) * 0.5 * (radius + width));
                let at_end = (-5..=24).map(|i| 0.5 * PI - 0.5 * radius * f64::from(i));
                for angle in near.chain(at_end).filter(|a| (0.0..=0.5 * PI + radius).contains(a)) {
                    let of = (radius, n, angle);
                    let want = mean(&fine, 250, of, 0.0);
                    let largest = (angle - radius).max(0.0).cos();
                    let is_dark = largest <= 0.0 || largest.powf(n) < 1e-7;
                    let by = |count: usize, turned: f64| match count {
                        _ if is_dark => 0.0,
                        0 if angle.cos() > 0.0 => {
                            let bend = (n - 1.0) * angle.tan().powi(2) - 2.0;
                            angle.cos().powf(n) * (1.0 + n * radius * radius / 8.0 * bend)
                        }
                        0 => 0.0,
                        _ => mean(&rules[count], 4 * count, of, turned),
                    };
                    let bound = disc_rings(n, &sun, angle.cos()) / ((n + 1.0) / TAU);
                    // The finest rings' own share, as derived for those of the reference.
                    let bound = bound * (1.0 + 48.0 / 250.0);
                    let off = (mean(&reference, AROUND, of, 0.0) - want).abs();
                    let count = rings(radius, n, angle);
                    for turned in [0.0, 0.4 / count.max(1) as f64] {
                        let all = off + (by(count, turned) - want).abs();
                        assert!(all <= bound, "{of:?}: {count} rings: {all:e} of {bound:e}");
                    }
                    let fewer = match count {
                        // The centre without its second derivatives.
                        0 if !is_dark => angle.cos().max(0.0).powf(n),
                        _ => by(count / 2, 0.0),
                    };
                    // 3: the ring of a small disc at the lobe's end.
                    let is_at_end = angle.cos().abs() < 2.0 * radius.sin();
                    let case = if is_at_end && count == 1 { 3 } else { count };
                    too_few[case] += usize::from(off + (fewer - want).abs() > bound);
                }
            }
        }
        println!("too few rings are refused at {too_few:?} places");
        assert!([0, 1, 2, 3, 4, 8].iter().all(|case| too_few[*case] > 0), "{too_few:?}");
    }
}
