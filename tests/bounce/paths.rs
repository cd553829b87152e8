//! The quadrature against counting paths: a naive tracer that tests every triangle for every ray, follows
//! the definition word by word and shares nothing with profiles, slices and weights.

use glam::DVec3;
use ridgelight::cpu::bounce::{Fineness, truth};
use ridgelight::cpu::light::normal;
use ridgelight::scene::{Albedo, Border, Environment, Lights, Phong, Scene};
use std::f64::consts::{PI, TAU};

use crate::{rough, under_sky};

struct Paths<'a> {
    scene: &'a Scene,
    /// Corners of triangles, each counter-clockwise from above, with their samples.
    triangles: Vec<[(DVec3, usize); 3]>,
    state: u64,
}

/// Where a path stands: at a sample, or inside a triangle.
#[derive(Clone, Copy)]
enum Place {
    Sample(usize),
    Inside(usize),
}

impl<'a> Paths<'a> {
    fn new(scene: &'a Scene) -> Self {
        let field = &scene.field;
        let (rows, cols) = (field.rows(), field.cols());
        let [cell_x, cell_y] = field.cell_m();
        let corner = |r: usize, c: usize| {
            let h = f64::from(field.heights_m()[r * cols + c]);
            (DVec3::new(c as f64 * cell_x, (rows - 1 - r) as f64 * cell_y, h), r * cols + c)
        };
        let triangles = (0..(rows - 1) * (cols - 1))
            .map(|i| (i / (cols - 1), i % (cols - 1)))
            .flat_map(|(r, c)| {
                let [nw, ne] = [corner(r, c), corner(r, c + 1)];
                let [sw, se] = [corner(r + 1, c), corner(r + 1, c + 1)];
                [[nw, se, ne], [nw, sw, se]]
            })
            .collect();
        Self { scene, triangles, state: 0x9E37_79B9_7F4A_7C15 }
    }

    fn random(&mut self) -> f64 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        (self.state >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A direction with density (n+1)/(2π) cosⁿ about an axis; n = 1 is the cosine's.
    fn about(&mut self, axis: DVec3, n: f64) -> DVec3 {
        let cos = self.random().powf(1.0 / (n + 1.0));
        let sin = (1.0 - cos * cos).sqrt();
        let (s, c) = (TAU * self.random()).sin_cos();
        let (x, y) = axis.any_orthonormal_pair();
        x * (sin * c) + y * (sin * s) + axis * cos
    }

    fn up(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.triangles[triangle].map(|(at, _)| at);
        (b - a).cross(c - a).normalize()
    }

    /// Möller & Trumbore: distance and the weights of the second and third corner.
    fn meets(&self, triangle: usize, from: DVec3, e: DVec3) -> Option<(f64, f64, f64)> {
        let [a, b, c] = self.triangles[triangle].map(|(at, _)| at);
        let (ab, ac) = (b - a, c - a);
        let p = e.cross(ac);
        let inverse = 1.0 / ab.dot(p);
        let u = (from - a).dot(p) * inverse;
        let q = (from - a).cross(ab);
        let (v, t) = (e.dot(q) * inverse, ac.dot(q) * inverse);
        (t > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some((t, u, v))
    }

    fn met(&self, place: Place, from: DVec3, e: DVec3) -> Option<(usize, DVec3, Place)> {
        let mut nearest: Option<(f64, usize)> = None;
        for (i, corners) in self.triangles.iter().enumerate() {
            let own = match place {
                Place::Inside(own) => own == i,
                Place::Sample(own) => {
                    let here = corners.iter().any(|(_, sample)| *sample == own);
                    // In the azimuth of this triangle, and not above it: met at once.
                    let beside = from + DVec3::new(e.x, e.y, 0.0) * 1e-6;
                    let towards = self.meets(i, beside + DVec3::Z * 1e3, -DVec3::Z).is_some();
                    if here && towards && e.dot(self.up(i)) <= 0.0 {
                        return Some((i, from, place));
                    }
                    here
                }
            };
            if !own
                && let Some((t, ..)) = self.meets(i, from, e)
                && nearest.is_none_or(|(best, _)| t < best)
            {
                nearest = Some((t, i));
            }
        }
        nearest.map(|(t, i)| (i, from + e * t, Place::Inside(i)))
    }

    fn sky(&self, e: DVec3) -> [f64; 3] {
        if self.scene.surface.border != Border::Open && e.z <= 0.0 {
            return [0.0; 3];
        }
        let sky = self.scene.lights.sky.unwrap_or_default().map(f64::from);
        let Some(env) = &self.scene.lights.environment else { return sky };
        let clockwise = (PI - e.y.atan2(e.x) + env.rotation_rad()).rem_euclid(TAU);
        let col = (clockwise / TAU * env.width() as f64) as usize % env.width();
        let row = (e.z.clamp(-1.0, 1.0).acos() / PI * env.height() as f64) as usize;
        let texel = env.texels()[row.min(env.height() - 1) * env.width() + col];
        [0, 1, 2].map(|i| sky[i] + f64::from(texel[i]))
    }

    fn albedo(&self, sample: usize) -> [f64; 3] {
        match &self.scene.surface.albedo {
            Albedo::Constant(colour) => colour.map(f64::from),
            Albedo::Map(colours) => <[f32; 3]>::map(colours[sample], f64::from),
        }
    }

    fn albedo_at(&self, triangle: usize, at: DVec3) -> [f64; 3] {
        let above = at + DVec3::Z * 1e3;
        let (u, v) = self.meets(triangle, above, -DVec3::Z).map_or((0.0, 0.0), |(_, u, v)| (u, v));
        let colours = self.triangles[triangle].map(|(_, sample)| self.albedo(sample));
        [0, 1, 2].map(|i| (1.0 - u - v) * colours[0][i] + u * colours[1][i] + v * colours[2][i])
    }

    /// What one path brings from a first direction: zero, or light after so many bounces.
    fn follow(
        &mut self,
        sample: usize,
        from: DVec3,
        first: DVec3,
        bounces: usize,
    ) -> (usize, [f64; 3]) {
        let (mut place, mut from, mut e) = (Place::Sample(sample), from, first);
        let mut left = [1.0; 3];
        for bounce in 0..=bounces {
            let Some((triangle, at, onto)) = self.met(place, from, e) else {
                let sky = self.sky(e);
                return (bounce, [0, 1, 2].map(|i| left[i] * sky[i]));
            };
            let albedo = self.albedo_at(triangle, at);
            left = [0, 1, 2].map(|i| left[i] * albedo[i]);
            e = self.about(self.up(triangle), 1.0);
            (place, from) = (onto, at);
        }
        (0, [0.0; 3])
    }
}

/// Bounces 0 and up to 3 at some samples of a rough field, diffuse with a map of albedos and with a lobe,
/// under a sky or an environment: within four standard errors of the paths and the stated error of the
/// quadrature. (4 σ: 6e-5 a comparison; 72 comparisons, one seed.)
#[test]
fn paths_bring_what_the_quadrature_says() {
    let field = || rough(5, 5, [1.0, 1.25], 2.5);
    let map = Albedo::Map((0..25_u8).map(|i| [0.8, f32::from(i % 4) / 4.0, 0.3]).collect());
    let mut plane = under_sky(field(), Border::Plane, 0.0);
    plane.surface.albedo = map.clone();
    let texels = (0..18_u8).map(|i| [f32::from(i % 5), 1.0, f32::from(i % 3)]).collect();
    let mut open = under_sky(field(), Border::Open, 0.0);
    open.surface.albedo = map;
    open.surface.phong = Some(Phong { exponent: 5.0, scale: 0.2 });
    open.lights = Lights {
        environment: Some(Environment::new(6, 3, texels, 0.9).unwrap()),
        ..Lights::default()
    };
    let bounces = 3;
    for (name, scene) in [("plane", plane), ("open", open)] {
        let said =
            truth(&scene, bounces, Fineness { azimuths: 32, divisions: 1, strips: 16 }).unwrap();
        let mut paths = Paths::new(&scene);
        for sample in [6, 12, 19] {
            let up = normal(&scene.field, scene.surface.border, sample / 5, sample % 5);
            let from = paths
                .triangles
                .iter()
                .flatten()
                .find_map(|(at, own)| (*own == sample).then_some(*at))
                .unwrap();
            let albedo = paths.albedo(sample);
            let n = 12_000;
            let mut sums = [[[0.0; 3]; 2]; 4];
            for _ in 0..n {
                let mut brought = [[0.0; 3]; 4];
                let e = paths.about(up, 1.0);
                let (bounce, light) = paths.follow(sample, from, e, bounces);
                for i in 0..3 {
                    brought[bounce][i] += albedo[i] * light[i];
                }
                if let Some(Phong { exponent, scale }) = scene.surface.phong {
                    let e = paths.about(2.0 * up.z * up - DVec3::Z, f64::from(exponent));
                    if e.dot(up) > 0.0 {
                        let (bounce, light) = paths.follow(sample, from, e, bounces);
                        for i in 0..3 {
                            brought[bounce][i] += f64::from(scale) * light[i];
                        }
                    }
                }
                let mut all = [0.0; 3];
                for (brought, sums) in brought.iter().zip(&mut sums) {
                    for i in 0..3 {
                        all[i] += brought[i];
                        sums[0][i] += all[i];
                        sums[1][i] += all[i] * all[i];
                    }
                }
            }
            for (b, [sum, squares]) in sums.iter().enumerate() {
                for i in 0..3 {
                    let mean = sum[i] / f64::from(n);
                    let sigma = ((squares[i] / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
                    let off = mean - said.radiance[b][sample][i];
                    let stated = said.error[b][sample][i];
                    println!(
                        "{name} {sample} bounce {b} channel {i}: {mean:.4} off {off:+.4}, σ {sigma:.4}, stated {stated:.4}"
                    );
                    assert!(off.abs() <= 4.0 * sigma + stated, "{name} {sample} {b} {i}");
                }
            }
        }
    }
}
