//! Direct and indirect light of small fields, in f64, by deterministic quadrature: the ground truth of the GPU's path
//! tracer, which follows the definition below and shares no code.
//!
//! - A result is the exit radiance of a grid point, towards straight above where there is Phong specular, with the
//!   grid point's normal ([`normal`]) and albedo. Light in directions e with N·e > 0 counts.
//! - Rays hit the triangulated surface. A direction that leads from the grid point straight into the ground hits, at
//!   distance 0, the triangle in its azimuth.
//! - A hit point reflects diffusely. With [`Normals::Flat`] ([`light`]), it has the geometric normal of its triangle and
//!   the albedo interpolated over the triangle's corners. With [`Normals::Smooth`] ([`smooth_light`]), its radiance is
//!   linear between those of the triangle's corners, which have their grid points' normals and albedo. Its specular is
//!   left out, unlike in the path tracer: with Phong specular, bounces here are a lower bound wherever ground is visible
//!   from ground.
//! - Sky and environment are visible where nothing is hit: above horizontal under `plane` and `periodic`, everywhere
//!   under `open`. Rays that leave the field below horizontal under `plane` hit black ground.
//! - Bounce 0 is light straight from its sources; bounce b has been reflected b times before it reaches the grid
//!   point. Results hold all bounces up to b.
//!
//! The unknowns are the radiances at the corners of every triangle; radiance is linear between them. Flat triangles have
//! three each, as a shared corner has another normal on each. With smooth normals, all corners at a grid point share
//! one. All receivers at a grid point share the same profiles
//! ([`profile`](crate::profile)). Every visible interval, or panel of it, adds its cosine weight in closed form; its
//! radiance is taken at the two-point Gauss mean of its distance.
//!
//! Errors of both forms: second order in the step between azimuths. Flat: second order in the triangles' size where
//! light is smooth, first order along shadow edges. Smooth: the definition is linear over the triangles, so their size
//! adds no error; the mean distance adds one of fourth order in the width of a panel. [`ground_truth`] and
//! [`smooth_ground_truth`] measure these errors by halving steps, triangles and panels.

use crate::Rgb;
use crate::light::{Receiver, Site, Slice, albedo_at, normal};
use crate::oracle::Oracle;
use crate::profile::VisibleInterval;
use glam::DVec3;
use ridgelight::scene::{Border, HeightField, Lights, NearLight, Normals, Scene, Specular};
use ridgelight::{Error, Result};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Panels of a visible interval in [`smooth_light`].
const PANELS: usize = 2;

/// Resolution of directions and surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fineness {
    /// Azimuths, at the middles of equal parts of the circle. Multiples of 8 put the directions of the
    /// grid and, in square cells, of their diagonals between two parts.
    pub azimuths: usize,
    /// Parts per side of a cell; the surface stays the same.
    pub divisions: usize,
    /// Azimuths across a sun, a key light, a sphere light, or one texel of an environment.
    pub strips: usize,
}

impl Fineness {
    /// Twice as fine in every setting.
    pub fn doubled(self) -> Self {
        let Self { azimuths, divisions, strips } = self;
        Self { azimuths: 2 * azimuths, divisions: 2 * divisions, strips: 2 * strips }
    }
}

/// Exit radiance of every grid point, linear RGB, row-major.
pub type Picture = Vec<Rgb>;

/// Radiance and its error estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundTruth {
    /// Exit radiance with all bounces up to the index.
    pub radiance: Vec<Picture>,
    /// The difference to half the fineness at each grid point and channel. This is the error where doubling halves
    /// it, and more where doubling does better, as in smooth light. Single grid points can be underestimated, so use
    /// the rms over many.
    pub error: Vec<Picture>,
}

/// [`light`] at twice a fineness, and its difference to that at the fineness.
///
/// # Errors
/// As [`light`].
pub fn ground_truth(scene: &Scene, bounces: usize, fineness: Fineness) -> Result<GroundTruth> {
    let coarse = light(scene, bounces, fineness)?;
    let radiance = light(scene, bounces, fineness.doubled())?;
    Ok(between(coarse, radiance))
}

/// As [`ground_truth`], of [`smooth_light`]: azimuths, strips and panels are doubled.
///
/// # Errors
/// As [`light`].
pub fn smooth_ground_truth(
    scene: &Scene,
    bounces: usize,
    azimuths: usize,
    strips: usize,
) -> Result<GroundTruth> {
    let coarse = smooth_light(scene, bounces, azimuths, strips)?;
    let doubled = Fineness { azimuths: 2 * azimuths, divisions: 1, strips: 2 * strips };
    let radiance = light_of(scene, (Normals::Smooth, 2 * PANELS), bounces, doubled)?;
    Ok(between(coarse, radiance))
}

fn between(coarse: Vec<Picture>, radiance: Vec<Picture>) -> GroundTruth {
    let difference = |(a, b): (&Picture, &Picture)| -> Picture {
        a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|i| (a[i] - b[i]).abs())).collect()
    };
    let error = radiance.iter().zip(&coarse).map(difference).collect();
    GroundTruth { radiance, error }
}

/// Exit radiance of every grid point with all bounces up to 0, 1, … `bounces`.
///
/// Memory: every corner keeps a weight for every corner visible from it. A fractal of 64² at 64 azimuths and 1
/// division takes 0.4 GB. Voids are lit with their filled heights.
///
/// # Errors
/// A scene or a fineness out of range.
pub fn light(scene: &Scene, bounces: usize, fineness: Fineness) -> Result<Vec<Picture>> {
    light_of(scene, (Normals::Flat, 1), bounces, fineness)
}

/// As [`light`], with smooth normals: ground reflects only at grid points, about their [`normal`], and radiance is linear
/// between them. The size of the triangles causes no error, so they are not divided.
/// Each visible interval is cut into 2 panels of equal elevation, with a weight and a mean distance of their own.
///
/// # Errors
/// As [`light`].
pub fn smooth_light(
    scene: &Scene,
    bounces: usize,
    azimuths: usize,
    strips: usize,
) -> Result<Vec<Picture>> {
    let fineness = Fineness { azimuths, divisions: 1, strips };
    light_of(scene, (Normals::Smooth, PANELS), bounces, fineness)
}

/// By normals, and panels of a visible interval.
fn light_of(
    scene: &Scene,
    (normals, panels): (Normals, usize),
    bounces: usize,
    fineness: Fineness,
) -> Result<Vec<Picture>> {
    let Scene { field, surface, lights } = scene;
    let grid_points = field.rows() * field.cols();
    surface.check(grid_points)?;
    lights.check()?;
    let Fineness { azimuths, divisions, strips } = fineness;
    for (name, value) in [("azimuths", azimuths), ("divisions", divisions), ("strips", strips)] {
        if value == 0 {
            return Err(Error::setting(name, "0", "1 or more"));
        }
    }
    let fine = divided_field(field, surface.border, divisions)?;
    let oracle = Oracle::new(&fine, surface.border);
    let unknowns = Unknowns { normals, oracle: &oracle };
    let places = places(unknowns, field, divisions, surface.specular.as_ref());
    let diffuse = unknowns.first_grid_point();
    let lights = moved_lights(lights, field, surface.border, divisions);

    let (rows, mut arrived) = at_all(unknowns, &places, &lights, (fineness, panels));
    let albedo = |at: usize| albedo_at(surface, at);
    let channels = [0, 1, 2].map(|i| divide(field, surface.border, divisions, |at| albedo(at)[i]));
    let unknown_albedo: Vec<Rgb> = (0..unknowns.count())
        .map(|unknown| {
            let at = unknowns.grid_point(unknown);
            [0, 1, 2].map(|i| channels[i][at])
        })
        .collect();
    let towards_above = |arrived: &[Rgb], at: usize| {
        let scale =
            surface.specular.as_ref().map_or(0.0, |specular| f64::from(specular.at(at).scale));
        let reflected = product(albedo(at), arrived[diffuse + at]);
        let mirrored = arrived.get(diffuse + grid_points + at).copied().unwrap_or_default();
        [0, 1, 2].map(|i| reflected[i] + scale * mirrored[i])
    };

    let mut picture: Picture = (0..grid_points).map(|at| towards_above(&arrived, at)).collect();
    let mut pictures = vec![picture.clone()];
    for _ in 0..bounces {
        let leaving: Vec<Rgb> =
            unknown_albedo.iter().zip(&arrived).map(|(a, b)| product(*a, *b)).collect();
        arrived = rows.iter().map(|row| row.of(&leaving)).collect();
        for (at, sum) in picture.iter_mut().enumerate() {
            let more = towards_above(&arrived, at);
            *sum = [0, 1, 2].map(|i| sum[i] + more[i]);
        }
        pictures.push(picture.clone());
    }
    Ok(pictures)
}

fn product(a: Rgb, b: Rgb) -> Rgb {
    [0, 1, 2].map(|i| a[i] * b[i])
}

/// Visibility of one receiver: weights of the unknown radiances and of a sky of radiance 1.
#[derive(Clone, Debug, Default)]
struct Visibility {
    unknowns: Vec<u32>,
    weights: Vec<f64>,
    sky: f64,
}

impl Visibility {
    fn of(&self, radiance: &[Rgb]) -> Rgb {
        self.unknowns.iter().zip(&self.weights).fold([0.0; 3], |sum, (unknown, weight)| {
            [0, 1, 2].map(|c| sum[c] + weight * radiance[*unknown as usize][c])
        })
    }
}

/// Radiances that the ground reflects by, on the divided field: of flat triangles one per corner, three per triangle;
/// with smooth normals one per grid point.
#[derive(Clone, Copy)]
struct Unknowns<'a> {
    normals: Normals,
    oracle: &'a Oracle<'a>,
}

impl Unknowns<'_> {
    fn count(self) -> usize {
        match self.normals {
            Normals::Flat => 3 * self.triangles(),
            Normals::Smooth => self.oracle.field().rows() * self.oracle.field().cols(),
        }
    }

    fn triangles(self) -> usize {
        let [down, across] = self.oracle.cells();
        2 * down * across
    }

    /// The index at a triangle's corner.
    fn at(self, triangle: usize, corner: usize) -> usize {
        match self.normals {
            Normals::Flat => 3 * triangle + corner,
            Normals::Smooth => self.corner(triangle, corner),
        }
    }

    /// Row-major index of the grid point of an unknown.
    fn grid_point(self, unknown: usize) -> usize {
        match self.normals {
            Normals::Flat => self.corner(unknown / 3, unknown % 3),
            Normals::Smooth => unknown,
        }
    }

    fn corner(self, triangle: usize, corner: usize) -> usize {
        let [r, c] = self.oracle.corners(triangle)[corner];
        r * self.oracle.field().cols() + c
    }

    /// The index of the first grid point's light. With smooth normals, which have no divisions, the grid points are the
    /// unknowns.
    fn first_grid_point(self) -> usize {
        match self.normals {
            Normals::Flat => self.count(),
            Normals::Smooth => 0,
        }
    }
}

/// For every grid point of the divided field, the receivers there and the index of their light: first the unknowns, then
/// the undivided field's grid points where these are not the unknowns, then their specular.
fn places(
    unknowns: Unknowns,
    field: &HeightField,
    divisions: usize,
    specular: Option<&Specular>,
) -> Vec<Vec<(usize, Receiver)>> {
    let oracle = unknowns.oracle;
    let fine = oracle.field();
    let mut places = vec![Vec::new(); fine.rows() * fine.cols()];
    if unknowns.normals == Normals::Flat {
        for unknown in 0..unknowns.count() {
            let receiver = Receiver::diffuse(triangle_normal(oracle, unknown / 3));
            places[unknowns.grid_point(unknown)].push((unknown, receiver));
        }
    }
    let diffuse = unknowns.first_grid_point();
    let grid_points = field.rows() * field.cols();
    for at in 0..grid_points {
        let (r, c) = (at / field.cols(), at % field.cols());
        let normal = normal(field, oracle.border(), r, c);
        let place = &mut places[divisions * (r * fine.cols() + c)];
        place.push((diffuse + at, Receiver::diffuse(normal)));
        if let Some(specular) = specular {
            let n = f64::from(specular.at(at).exponent);
            place.push((diffuse + grid_points + at, Receiver::specular_from_above(normal, n)));
        }
    }
    places
}

/// Visibility of every receiver, and its light straight from the sources, each at its index.
fn at_all(
    unknowns: Unknowns,
    places: &[Vec<(usize, Receiver)>],
    lights: &Lights,
    (fineness, panels): (Fineness, usize),
) -> (Vec<Visibility>, Vec<Rgb>) {
    let oracle = unknowns.oracle;
    let count = places.iter().map(Vec::len).sum();
    let (mut rows, mut direct) = (vec![Visibility::default(); count], vec![[0.0; 3]; count]);
    for (at, place) in places.iter().enumerate() {
        let here = [at / oracle.field().cols(), at % oracle.field().cols()];
        let receivers: Vec<Receiver> = place.iter().map(|(_, receiver)| *receiver).collect();
        let site = Site::of(oracle, here, &receivers);
        let visibility = gather(site, unknowns, fineness.azimuths, panels);
        let arriving = arriving(site, &visibility, lights, fineness.strips);
        for (((target, _), visibility), light) in place.iter().zip(visibility).zip(arriving) {
            (rows[*target], direct[*target]) = (visibility, light);
        }
    }
    (rows, direct)
}

/// (-∂h/∂x, -∂h/∂y, 1), normalised.
fn triangle_normal(oracle: &Oracle, triangle: usize) -> DVec3 {
    let [cell_x, cell_y] = oracle.field().cell_m();
    let [first, between, last] =
        oracle.corners(triangle).map(|[r, c]| oracle.vertex(r as f64, c as f64));
    // The corner between lies east of the first and north of the last, or south and west of them.
    let (east, north) = if triangle.is_multiple_of(2) {
        (between - first, between - last)
    } else {
        (last - between, first - between)
    };
    DVec3::new(-east / cell_x, -north / cell_y, 1.0).normalize()
}

/// Surface and sky visibility of the receivers at a grid point.
///
/// Weights of a diffuse receiver are scaled so that those of its whole hemisphere sum to 1. The rule over azimuths
/// alone misses this by less the more azimuths and the gentler the slope. Uniform incident radiance is preserved, and
/// energy is not gained.
fn gather(site: Site, unknowns: Unknowns, azimuths: usize, panels: usize) -> Vec<Visibility> {
    let Site { oracle, place: [row, col], receivers, .. } = site;
    let mut dense = vec![vec![0.0; unknowns.count()]; receivers.len()];
    let mut all = vec![Visibility::default(); receivers.len()];
    let mut totals = vec![0.0; receivers.len()];
    for k in 0..azimuths {
        let azimuth = TAU * (k as f64 + 0.5) / azimuths as f64;
        let intervals = oracle.visible_intervals(row, col, azimuth);
        let met = intervals.last().map_or(-FRAC_PI_2, |last| last.high_rad);
        let horizon = if oracle.border() == Border::Open { met } else { met.max(0.0) };
        for (i, receiver) in receivers.iter().enumerate() {
            let slice = receiver.slice(azimuth);
            all[i].sky += slice.light(horizon, FRAC_PI_2);
            totals[i] += slice.light(-FRAC_PI_2, FRAC_PI_2);
            for panel in intervals.iter().flat_map(|of| of.parts(slice.low, panels)) {
                let weight = slice.light(panel.low_rad, panel.high_rad);
                if weight > 0.0 {
                    let shares = panel.corner_weights(mean_distance_m(&slice, &panel));
                    for (j, share) in shares.into_iter().enumerate().filter(|(_, s)| *s > 0.0) {
                        let unknown = unknowns.at(panel.triangle, j);
                        if dense[i][unknown] == 0.0 {
                            all[i].unknowns.push(unknown as u32);
                        }
                        dense[i][unknown] += weight * share;
                    }
                }
            }
        }
    }
    for (i, visibility) in all.iter_mut().enumerate() {
        let is_specular = receivers[i].phong_lobe.is_some();
        let scale = if is_specular { 2.0 / azimuths as f64 } else { 1.0 / totals[i] };
        visibility.weights =
            visibility.unknowns.iter().map(|u| scale * dense[i][*u as usize]).collect();
        visibility.sky *= scale;
    }
    all
}

/// Distance on a visible interval of its mean radiance, which is linear in the distance: the average by Gauss' rule
/// of two points over the elevations above the slice's plane.
pub(crate) fn mean_distance_m(slice: &Slice, interval: &VisibleInterval) -> f64 {
    let (low, high) = (interval.low_rad.max(slice.low), interval.high_rad);
    let (middle, off) = (0.5 * (low + high), 0.5 * (high - low) / 3_f64.sqrt());
    let [(near, f), (far, g)] =
        [middle - off, middle + off].map(|w| (interval.distance_m(w), w.cos() * slice.at(w)));
    if f + g > 0.0 { (f * near + g * far) / (f + g) } else { 0.5 * (near + far) }
}

/// Light straight from its sources at each receiver of a grid point, for albedo 1.
fn arriving(site: Site, visibility: &[Visibility], lights: &Lights, strips: usize) -> Vec<Rgb> {
    let sky = lights.sky.unwrap_or_default().map(f64::from);
    let mut sums: Vec<Rgb> = visibility.iter().map(|of| sky.map(|s| s * of.sky)).collect();
    let mut add = |more: Vec<Rgb>| {
        for (sum, more) in sums.iter_mut().zip(more) {
            *sum = [0, 1, 2].map(|i| sum[i] + more[i]);
        }
    };
    if let Some(environment) = &lights.environment {
        add(site.environment(environment, strips));
    }
    for sun in &lights.suns {
        add(site.sun(sun, strips));
    }
    for key in &lights.keys {
        let shares = site.key(key, strips);
        add(shares.iter().map(|share| key.radiance.map(|l| share * f64::from(l))).collect());
    }
    for NearLight { sphere, .. } in lights.near() {
        let shares = site.sphere(&sphere, strips);
        add(shares.iter().map(|share| sphere.radiance.map(|l| share * f64::from(l))).collect());
    }
    sums
}

/// Values between the grid points of a field, linear on each of the surface's triangles.
fn divide(
    field: &HeightField,
    border: Border,
    divisions: usize,
    value: impl Fn(usize) -> f64,
) -> Vec<f64> {
    let (rows, cols) = (field.rows(), field.cols());
    let [fine_rows, fine_cols] = divided_size(field, border, divisions);
    let at = |r: usize, c: usize| value(r % rows * cols + c % cols);
    let part = |i: usize| (i / divisions, (i % divisions) as f64 / divisions as f64);
    (0..fine_rows * fine_cols)
        .map(|i| {
            let ((r, down), (c, right)) = (part(i / fine_cols), part(i % fine_cols));
            // Beyond a last row or column only with weight 0.
            if down > right {
                (1.0 - down) * at(r, c) + (down - right) * at(r + 1, c) + right * at(r + 1, c + 1)
            } else {
                (1.0 - right) * at(r, c) + (right - down) * at(r, c + 1) + down * at(r + 1, c + 1)
            }
        })
        .collect()
}

fn divided_size(field: &HeightField, border: Border, divisions: usize) -> [usize; 2] {
    [field.rows(), field.cols()].map(|n| match border {
        Border::Periodic => n * divisions,
        Border::Plane | Border::Open => (n - 1) * divisions + 1,
    })
}

/// The same surface with every cell cut into divisions²; interpolated heights are rounded to f32.
fn divided_field(field: &HeightField, border: Border, divisions: usize) -> Result<HeightField> {
    let height = |at| field.base_m() + f64::from(field.heights_m()[at]);
    let heights = divide(field, border, divisions, height);
    let [rows, cols] = divided_size(field, border, divisions);
    HeightField::new(rows, cols, &heights, field.cell_m().map(|c| c / divisions as f64), None)
}

/// Positions count from the southernmost row, which division of the last, wrapping cells of a `periodic` field moves
/// south.
fn moved_lights(lights: &Lights, field: &HeightField, border: Border, divisions: usize) -> Lights {
    let moved = match border {
        Border::Periodic => field.cell_m()[1] * (1.0 - 1.0 / divisions as f64),
        Border::Plane | Border::Open => 0.0,
    };
    lights.moved([0.0, moved])
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{Albedo, PhongSpecular, Surface};

    fn rough() -> Scene {
        let heights: Vec<f64> =
            (0..30).map(|i| f64::from((i * 7919 + i * i * 31) % 61) * 2.0 / 61.0).collect();
        Scene {
            field: HeightField::new(5, 6, &heights, [1.0; 2], None).unwrap(),
            surface: Surface {
                border: Border::Open,
                albedo: Albedo::Constant([0.8; 3]),
                ..Surface::default()
            },
            lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
        }
    }

    fn smooth(panels: usize) -> Picture {
        let fineness = Fineness { azimuths: 16, divisions: 1, strips: 2 };
        light_of(&rough(), (Normals::Smooth, panels), 1, fineness).unwrap().remove(1)
    }

    /// The mean distance alone: azimuths are fixed. Its error is of fourth order, a 16th for twice the panels in the
    /// limit. Crossings with parallel lines of the grid are equally spaced from the grid point on, so a piece ends at
    /// most at twice the distance at which it begins. The mean of 1/x over [1, 2] has an error of 8.4e-4 with one panel
    /// and 7.0e-5, a 12th, with two. So the difference of a doubling is about 11 times the error that is left, or more;
    /// with a rule of second order, 3 times.
    #[test]
    fn doubled_panels_measure_the_error_of_the_mean_distance() {
        let rms = |a: &Picture, b: &Picture| {
            let squares = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).powi(2));
            (squares.sum::<f64>() / a.len() as f64).sqrt()
        };
        let exact = smooth(64);
        let [one, two, four] = [1, 2, 4].map(smooth);
        let errors = [&one, &two, &four].map(|picture| rms(picture, &exact));
        println!("rms errors of 1, 2 and 4 panels: {errors:?}");
        assert!(errors[0] > 1e-8, "no error to measure: {errors:?}");
        assert!(rms(&one, &two) > 5.0 * errors[1], "{errors:?}");
        assert!(rms(&two, &four) > 5.0 * errors[2], "{errors:?}");
    }

    /// The stated error includes that of the mean distance.
    #[test]
    fn a_smooth_ground_truth_doubles_panels() {
        let expected_light = smooth_ground_truth(&rough(), 1, 8, 1).unwrap();
        assert_eq!(expected_light.radiance[1], smooth(2 * PANELS));
        let coarse = smooth_light(&rough(), 1, 8, 1).unwrap();
        for (i, error) in expected_light.error[1].iter().enumerate() {
            assert_eq!(error[0], (coarse[1][i][0] - expected_light.radiance[1][i][0]).abs());
        }
    }

    /// Flat triangles: a receiver at each corner of 2 · 4 · 5 triangles and one at each of 30 grid points. Smooth
    /// normals: one at each grid point, with and without specular's. Indices are complete and without repetition.
    #[test]
    fn smooth_corners_share_a_receiver() {
        let scene = rough();
        let oracle = Oracle::new(&scene.field, Border::Open);
        let specular = Specular::Constant(PhongSpecular { exponent: 5.0, scale: 0.5 });
        for (normals, specular, count) in [
            (Normals::Flat, None, 3 * 40 + 30),
            (Normals::Flat, Some(&specular), 3 * 40 + 2 * 30),
            (Normals::Smooth, None, 30),
            (Normals::Smooth, Some(&specular), 2 * 30),
        ] {
            let unknowns = Unknowns { normals, oracle: &oracle };
            let places = places(unknowns, &scene.field, 1, specular);
            let mut indices: Vec<usize> =
                places.iter().flatten().map(|(index, _)| *index).collect();
            indices.sort_unstable();
            assert!(indices.into_iter().eq(0..count), "{normals:?}");
            for unknown in 0..unknowns.count() {
                let place = &places[unknowns.grid_point(unknown)];
                assert!(place.iter().any(|(index, _)| *index == unknown), "{normals:?} {unknown}");
            }
            for (triangle, k) in (0..40).flat_map(|t| [(t, 0), (t, 1), (t, 2)]) {
                let [r, c] = oracle.corners(triangle)[k];
                assert_eq!(unknowns.grid_point(unknowns.at(triangle, k)), r * 6 + c);
            }
        }
    }

    /// The panels of an interval have its weight, and one panel is the interval above the slice's plane.
    #[test]
    fn panels_fill_their_interval() {
        let scene = rough();
        let oracle = Oracle::new(&scene.field, scene.surface.border);
        let receiver = Receiver::diffuse(normal(&scene.field, Border::Open, 2, 3));
        for azimuth in [0.3, 2.0, 4.4] {
            let slice = receiver.slice(azimuth);
            for interval in oracle.visible_intervals(2, 3, azimuth) {
                let weight = |count: usize| {
                    let panels = interval.parts(slice.low, count);
                    panels.map(|p| slice.light(p.low_rad, p.high_rad)).sum::<f64>()
                };
                assert_eq!(weight(1), slice.light(interval.low_rad, interval.high_rad));
                assert!((weight(4) - weight(1)).abs() < 1e-14);
                let whole: Vec<_> = interval.parts(-FRAC_PI_2, 1).collect();
                assert_eq!(whole, [interval]);
            }
        }
    }
}
