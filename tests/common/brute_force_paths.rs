//! A brute-force path tracer: it tests every triangle for every ray, follows the definition, and shares no code
//! with visible intervals, slices and weights, nor with the device's path tracer.

use glam::DVec3;
use ridgelight::scene::{Albedo, Border, PhongSpecular, Scene};
use std::f64::consts::{PI, TAU};

/// A scene's paths.
pub struct Paths<'a> {
    scene: &'a Scene,
    /// Whether hit ground reflects by its Phong lobe, too.
    phong_maps: bool,
    /// Corners of triangles, each counter-clockwise from above, with their texels.
    triangles: Vec<[(DVec3, usize); 3]>,
    state: u64,
}

/// The start of a ray: a texel, or a point inside a triangle.
#[derive(Clone, Copy)]
enum Place {
    Texel(usize),
    Inside(usize),
}

impl<'a> Paths<'a> {
    pub fn new(scene: &'a Scene, phong_maps: bool) -> Self {
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
        Self { scene, phong_maps, triangles, state: 0x9E37_79B9_7F4A_7C15 }
    }

    fn random(&mut self) -> f64 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        (self.state >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A direction with density (n+1)/(2π) cosⁿ about an axis; n = 1 is the cosine's.
    pub fn about(&mut self, axis: DVec3, n: f64) -> DVec3 {
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
                Place::Texel(own) => {
                    let here = corners.iter().any(|(_, grid_point)| *grid_point == own);
                    // In the azimuth of this triangle, and not above it: a hit at once.
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

    pub fn albedo(&self, grid_point: usize) -> [f64; 3] {
        match &self.scene.surface.albedo {
            Albedo::Constant(colour) => colour.map(f64::from),
            Albedo::Map(colours) => <[f32; 3]>::map(colours[grid_point], f64::from),
        }
    }

    /// Exponent and scale.
    pub fn phong_specular(&self, grid_point: usize) -> [f64; 2] {
        let none = PhongSpecular { exponent: 0.0, scale: 0.0 };
        let PhongSpecular { exponent, scale } =
            self.scene.surface.specular.as_ref().map_or(none, |l| l.at(grid_point));
        [exponent, scale].map(f64::from)
    }

    /// The position of a texel.
    pub fn place(&self, grid_point: usize) -> DVec3 {
        let all = self.triangles.iter().flatten();
        all.clone().find_map(|(at, own)| (*own == grid_point).then_some(*at)).expect("a texel")
    }

    /// Values of a triangle's texels, linear between them.
    fn within<const N: usize>(
        &self,
        triangle: usize,
        at: DVec3,
        of: impl Fn(&Self, usize) -> [f64; N],
    ) -> [f64; N] {
        let above = at + DVec3::Z * 1e3;
        let (u, v) = self.meets(triangle, above, -DVec3::Z).map_or((0.0, 0.0), |(_, u, v)| (u, v));
        let [a, b, c] = self.triangles[triangle].map(|(_, grid_point)| of(self, grid_point));
        std::array::from_fn(|i| (1.0 - u - v) * a[i] + u * b[i] + v * c[i])
    }

    /// The light of one path from a first direction: zero, or light after so many bounces.
    pub fn follow(
        &mut self,
        grid_point: usize,
        from: DVec3,
        first: DVec3,
        bounces: usize,
    ) -> (usize, [f64; 3]) {
        let (mut place, mut from, mut e) = (Place::Texel(grid_point), from, first);
        let mut left = [1.0; 3];
        for bounce in 0..=bounces {
            let Some((triangle, at, onto)) = self.met(place, from, e) else {
                let sky = self.sky(e);
                return (bounce, [0, 1, 2].map(|i| left[i] * sky[i]));
            };
            let up = self.up(triangle);
            let [exponent, scale] = self.within(triangle, at, Self::phong_specular);
            let has_specular = self.phong_maps && scale > 0.0;
            let noise = if has_specular { 0.5 } else { 1.0 };
            if has_specular && self.random() < 0.5 {
                e = self.about(e - 2.0 * e.dot(up) * up, exponent);
                if e.dot(up) <= 0.0 {
                    return (0, [0.0; 3]);
                }
                left = left.map(|l| l * scale / noise);
            } else {
                let albedo = self.within(triangle, at, Self::albedo);
                left = [0, 1, 2].map(|i| left[i] * albedo[i] / noise);
                e = self.about(up, 1.0);
            }
            (place, from) = (onto, at);
        }
        (0, [0.0; 3])
    }

    /// Means and their standard errors of so many paths from a texel, for all numbers of bounces up to the given one.
    pub fn light(
        &mut self,
        grid_point: usize,
        up: DVec3,
        bounces: usize,
        paths: u32,
    ) -> Vec<[[f64; 3]; 2]> {
        let (from, albedo, [exponent, scale]) =
            (self.place(grid_point), self.albedo(grid_point), self.phong_specular(grid_point));
        let mut sums = vec![[[0.0; 3]; 2]; bounces + 1];
        for _ in 0..paths {
            let mut brought = vec![[0.0; 3]; bounces + 1];
            let e = self.about(up, 1.0);
            let (bounce, light) = self.follow(grid_point, from, e, bounces);
            (0..3).for_each(|i| brought[bounce][i] += albedo[i] * light[i]);
            if scale > 0.0 {
                let e = self.about(2.0 * up.z * up - DVec3::Z, exponent);
                if e.dot(up) > 0.0 {
                    let (bounce, light) = self.follow(grid_point, from, e, bounces);
                    (0..3).for_each(|i| brought[bounce][i] += scale * light[i]);
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
        let n = f64::from(paths);
        let of = |[sum, squares]: &[[f64; 3]; 2]| {
            let mean = sum.map(|s| s / n);
            let sigma =
                [0, 1, 2].map(|i| ((squares[i] / n - mean[i] * mean[i]) / n).max(0.0).sqrt());
            [mean, sigma]
        };
        sums.iter().map(of).collect()
    }
}
