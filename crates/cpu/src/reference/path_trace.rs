//! Single paths of the `path_trace` pass: the same random numbers and the same maths in f64, with the f32 error bound
//! of every value.
//!
//! Rounding decides some branches: whether a ray passes over an edge, which of two triangles it hits, diffuse or
//! specular. The CPU reference knows which ([`Near`]) and adds the possible contribution of such a branch to the
//! error bound of the sum. Where the path continues differently, that is the largest contribution of any path from
//! there on.

mod lights;
mod place;

use crate::shared::random::{net_point, shuffled, words_of};
use crate::shared::trace::{Met, What, trace};
use crate::shared::walk::{Ground, Ray, ray_from};
use crate::tolerance::near::{Near, Near3, all, any, dot, minus, plus, product};
use lights::Environment;
use place::Place;
use ridgelight::plan::{REFERENCE_BATCH, max_path_light, reference_inputs};
use ridgelight::scene::{Albedo, Normals, Scene, Specular};
use std::ops::Range;

const BITS: u32 = REFERENCE_BATCH.ilog2();

/// Below this f32 may flush to 0 where f64 does not: whether a ray is traced at all is in doubt.
const FAINTEST: f64 = 1e-30;

/// All inputs of the shader.
pub struct Tracer<'a> {
    scene: &'a Scene,
    ground: Ground,
    grid_points: Vec<[f32; 3]>,
    /// Two texels a light: suns, key lights, sphere lights.
    lights: Vec<[f32; 4]>,
    environment: Option<Environment>,
    albedo: Vec<[f32; 3]>,
    specular: Vec<[f32; 2]>,
    bounces: u32,
    normals: Normals,
    seed: u32,
    /// Where specular is viewed from, over the field's base; none for a view from straight above.
    eye_m: Option<Near3>,
    /// Whether direct light counts.
    counts_direct: bool,
    /// The largest contribution of a path after that many reflections.
    most: Vec<[f64; 3]>,
    /// Bounds on radiance from outside the surface: sky and environment; and all sphere lights, which a ray adds on
    /// its way wherever it ends.
    far: [f64; 3],
    spheres: [f64; 3],
}

fn given<const N: usize>(of: [f32; N]) -> [Near; N] {
    of.map(Near::given)
}

fn colour(of: [f32; 4]) -> Near3 {
    given([of[0], of[1], of[2]])
}

fn largest(of: Near3) -> Near {
    of[0].max(of[1]).max(of[2])
}

/// Beyond every field.
fn far() -> Near {
    Near::of(1e30)
}

fn one() -> Near {
    Near::of(1.0)
}

/// Where a contribution is so faint that f32 may flush it to 0, possibly no ray is traced.
fn is_some(of: Near3) -> Option<bool> {
    let of = largest(of);
    let is_faint = of.v > 0.0 && of.v < FAINTEST;
    of.above(Near::ZERO).filter(|_| !is_faint)
}

impl<'a> Tracer<'a> {
    /// For a scene, with height and slopes of the ground as the device has them. `counts_direct`: false for a list of
    /// grid points, where direct light does not count.
    pub fn of(
        scene: &'a Scene,
        grid_points: Vec<[f32; 3]>,
        (bounces, normals, seed): (u32, Normals, u32),
        counts_direct: bool,
    ) -> Self {
        let Scene { field, surface, lights } = scene;
        let mut inputs = reference_inputs(scene).into_iter().skip(1);
        let four = |texels: Vec<f32>| -> Vec<[f32; 4]> {
            texels.chunks_exact(4).map(|t| [t[0], t[1], t[2], t[3]]).collect()
        };
        let environment = lights.environment.as_ref().map(|of| Environment {
            size: [of.width() as i32, of.height() as i32],
            texels: four(inputs.next().expect("texels")),
            cdf: inputs.next().expect("shares"),
            rotation_turns: Near::given(
                (of.rotation_rad() / std::f64::consts::TAU).rem_euclid(1.0) as f32,
            ),
        });
        let count = grid_points.len();
        let pair = |phong: ridgelight::scene::PhongSpecular| [phong.exponent, phong.scale];
        let sky = lights.sky.unwrap_or_default();
        let texels = lights.environment.iter().flat_map(|e| e.texels());
        let brightest = texels.fold([0.0_f32; 3], |m, t| [0, 1, 2].map(|c| m[c].max(t[c])));
        let spheres = |c: usize| {
            lights.sphere_lights.iter().map(|sphere| f64::from(sphere.radiance[c])).sum()
        };
        Self {
            far: [0, 1, 2].map(|c| f64::from(sky[c]) + f64::from(brightest[c])),
            spheres: [0, 1, 2].map(spheres),
            ground: Ground::of(field, surface.border),
            lights: four(inputs.next().expect("lights")),
            environment,
            albedo: match &surface.albedo {
                Albedo::Constant(colour) => vec![*colour; count],
                Albedo::Map(map) => map.clone(),
            },
            specular: match &surface.specular {
                None => Vec::new(),
                Some(Specular::Constant(phong)) => vec![pair(*phong); count],
                Some(Specular::Map(map)) => map.iter().map(|p| pair(*p)).collect(),
            },
            most: (0..=bounces).map(|b| max_path_light(scene, b)).collect(),
            scene,
            grid_points,
            bounces,
            normals,
            seed,
            eye_m: None,
            counts_direct,
        }
    }

    /// The same, with specular viewed from an eye in f32 over the field's base, as on the device.
    pub fn viewed_from(self, eye_m: Option<[f32; 3]>) -> Self {
        Self { eye_m: eye_m.map(given), ..self }
    }

    /// Bounds on the radiance along a scattered ray with that many more bounces: sphere lights that it leaves, then
    /// the far field or ground.
    fn most_arriving(&self, left: u32) -> [f64; 3] {
        let later = left.checked_sub(1).map_or([0.0; 3], |l| self.most[l as usize]);
        [0, 1, 2].map(|c| self.spheres[c] + self.far[c].max(later[c]))
    }

    /// Suns, key lights, sphere lights.
    fn counts(&self) -> [usize; 3] {
        let lights = &self.scene.lights;
        [lights.suns.len(), lights.keys.len(), lights.sphere_lights.len()]
    }

    /// Contribution of some of a batch's paths to a grid point with some of the lights; `slot` is its index among the
    /// sums.
    pub fn traced(
        &self,
        grid_point: usize,
        (slot, batch): (u32, u32),
        (paths, lights): (Range<u32>, Range<u32>),
    ) -> Traced {
        let mut all = Traced::default();
        for path in paths {
            let words = [slot, batch, self.seed];
            self.path_light(self.first(grid_point), path, words, &lights, &mut all);
        }
        all
    }

    fn ray(&self, from: &Place, e: Near3) -> Ray {
        ray_from(&self.ground, from.base, from.offset, from.own, e)
    }

    fn followed(&self, ray: &Ray, t_end: Near, sum: &mut Traced) -> Met {
        let met = trace(&self.ground, ray, t_end);
        sum.crossed[sum.reflected] += met.crossed;
        met
    }

    /// Adds the contribution of one path.
    fn path_light(
        &self,
        mut place: Place,
        index: u32,
        [slot, batch, seed]: [u32; 3],
        lights: &Range<u32>,
        sum: &mut Traced,
    ) {
        let count: u32 = self.counts().iter().sum::<usize>() as u32;
        let mut carried = [one(); 3];
        for bounce in 0..=self.bounces {
            let is_first = bounce == 0;
            sum.reflected = bounce.min(2) as usize;
            let counts = Some(self.counts_direct || !is_first);
            let first_ray = bounce * (count + 2);
            let points = |r: u32| {
                let of_u = words_of([slot, batch, 2 * r, seed]);
                let of_v = words_of([slot, batch, 2 * r + 1, seed]);
                let order = if is_first { index } else { shuffled(index, BITS, of_u[2]) };
                let u = net_point(order, BITS, of_u);
                [u, net_point(shuffled(index, BITS, of_v[2]), BITS, of_v)].map(given)
            };
            // Possible contribution of a path that continues differently, and its rays.
            let left = self.bounces - bounce;
            let most = |carried: Near3, left: u32| {
                [0, 1, 2].map(|c| carried[c].most() * self.most[left as usize][c])
            };
            let parts = |sum: &mut Traced, carried: Near3, left: u32| {
                sum.doubt(most(carried, left));
                sum.rays.off += f64::from((left + 1) * (lights.end - lights.start + 2));
            };
            let Some(centre) = self.centre(&place) else { return parts(sum, carried, left) };
            for r in lights.clone() {
                let [u, _] = points(first_ray + r);
                let Some(light) = self.light(&place, centre, r as usize, u) else {
                    return parts(sum, carried, left);
                };
                let is_sent = all([counts, light.shines, light.reflected, is_some(light.brought)]);
                if is_sent == Some(false) {
                    continue;
                }
                sum.ray(is_sent);
                let ray = self.ray(&place, light.e);
                let t_end = light.end_m.map_or(far(), |end| end * ray.scale.min(Near::of(1e6)));
                let met = self.followed(&ray, t_end, sum);
                let is_free = met.what.map(|what| what == What::Free);
                let in_view = match light.end_m {
                    None => is_free,
                    Some(_) => match met.what {
                        Some(What::Hit) => t_end.at_most(met.t),
                        Some(_) => Some(true),
                        None => None,
                    },
                };
                let brought = product(carried, light.brought);
                sum.add(brought, all([is_sent, in_view]), most(carried, 0));
            }
            let has_sky = lights.start == 0;
            if let Some(environment) = self.environment.as_ref().filter(|_| has_sky) {
                let [u, v] = points(first_ray + count);
                let (e, from_there) = environment.towards_light(u, v);
                let of = self.reflected(&place, e);
                let chosen = (Near::given(from_there[3]) + of.density).max(Near::of(1e-30));
                let brought = product(of.light, colour(from_there)).map(|l| l / chosen);
                let is_sent = all([counts, of.facing.above(Near::ZERO), is_some(brought)]);
                if is_sent != Some(false) {
                    sum.ray(is_sent);
                    let met = self.followed(&self.ray(&place, e), far(), sum);
                    let is_free = met.what.map(|what| what == What::Free);
                    let brought = product(carried, brought);
                    sum.add(brought, all([is_sent, is_free]), most(carried, 0));
                }
            }
            let [u, v] = points(first_ray + count + 1);
            let Some(e) = self.scattered(&place, u, v) else { return parts(sum, carried, left) };
            let of = self.reflected(&place, e);
            match all([of.facing.above(Near::ZERO), is_some(of.scattered)]) {
                Some(false) => return,
                None => return parts(sum, carried, left),
                // Scattered light is at most the incident light.
                Some(true) if of.scattered.iter().any(|s| s.off > 1.0) => {
                    return parts(sum, carried, left);
                }
                Some(true) => sum.ray(Some(true)),
            }
            let ray = self.ray(&place, e);
            let met = self.followed(&ray, far(), sum);
            let scattered = product(carried, of.scattered);
            let Some(what) = met.what else {
                let (arriving, all) = (self.most_arriving(left), most(carried, left));
                sum.doubt([0, 1, 2].map(|c| (scattered[c].most() * arriving[c]).min(all[c])));
                sum.rays.off += f64::from(left * (lights.end - lights.start + 2));
                return;
            };
            let mut arriving = Traced::default();
            if has_sky && what == What::Free {
                let sky = self.scene.lights.sky.unwrap_or_default();
                arriving.light = given(sky);
                if let Some(environment) = &self.environment {
                    environment.towards(e, of.density, &mut arriving);
                }
            }
            let [suns, keys, _] = self.counts();
            for i in (suns + keys).max(lights.start as usize)..lights.end as usize {
                let sphere = given(self.lights[2 * i]);
                let to = minus([sphere[0], sphere[1], sphere[2]], centre);
                let ahead = dot(to, e);
                let inside = sphere[3] * sphere[3] - dot(to, to);
                let exit_m = ahead + (ahead * ahead + inside).max(Near::ZERO).sqrt();
                let is_before = any([Some(what != What::Hit), (exit_m * ray.scale).at_most(met.t)]);
                let in_view = all([Near::ZERO.at_most(inside), is_before]);
                let radiance = colour(self.lights[2 * i + 1]);
                arriving.add(radiance, in_view, radiance.map(Near::most));
            }
            if counts == Some(true) {
                let light = product(scattered, arriving.light);
                sum.light = plus(sum.light, light);
                sum.doubts[sum.reflected] += arriving.doubts[0];
                (0..3).for_each(|c| sum.in_doubt[c] += scattered[c].most() * arriving.in_doubt[c]);
            }
            if left == 0 || what != What::Hit {
                return;
            }
            carried = scattered;
            let next = met.lower.and_then(|is_lower| self.place_of(&met, is_lower, e, v[1]));
            let Some(next) = next else { return parts(sum, carried, left - 1) };
            place = next;
        }
    }
}

/// Contribution of some paths of a grid point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Traced {
    /// The sum of their light.
    pub light: Near3,
    /// Rays.
    pub rays: Near,
    /// Branches in doubt, per number of reflections before: once for grid points alone, once more each.
    pub doubts: [u32; 3],
    /// Their error bound of the light.
    pub in_doubt: [f64; 3],
    /// Per ray, the cells crossed plus one at every test against the surface.
    pub crossed: [f64; 3],
    /// Current index in it.
    reflected: usize,
}

impl Traced {
    /// A possible contribution, `most` at most: added where it is certain. Where rounding leaves nothing of it, any
    /// of that.
    fn add(&mut self, light: Near3, is_brought: Option<bool>, most: [f64; 3]) {
        let is_lost = (0..3).any(|c| light[c].off > most[c]);
        match is_brought {
            Some(true) if !is_lost => self.light = plus(self.light, light),
            Some(true) => self.doubt(most),
            None if is_lost => self.doubt(most),
            Some(false) => {}
            None => self.doubt(light.map(Near::most)),
        }
    }

    fn doubt(&mut self, most: [f64; 3]) {
        self.doubts[self.reflected] += 1;
        for (c, most) in most.into_iter().enumerate() {
            self.light[c].off += most;
            self.in_doubt[c] += most;
        }
    }

    /// Adds the contribution of others.
    pub fn join(&mut self, more: &Self) {
        self.light = plus(self.light, more.light);
        self.rays = Near { v: self.rays.v + more.rays.v, off: self.rays.off + more.rays.off };
        for i in 0..3 {
            self.in_doubt[i] += more.in_doubt[i];
            self.doubts[i] += more.doubts[i];
            self.crossed[i] += more.crossed[i];
        }
    }

    fn ray(&mut self, is_sent: Option<bool>) {
        let sent = if is_sent == Some(false) { 0.0 } else { 1.0 };
        let off = if is_sent.is_none() { 1.0 } else { 0.0 };
        self.rays = Near { v: self.rays.v + sent, off: self.rays.off + off };
    }
}

#[cfg(test)]
mod tests;
