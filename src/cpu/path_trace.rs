//! Light paths one by one, as `path_trace` follows them: the same random numbers, the same maths in f64, and what f32 may be off
//! by beside every value.
//!
//! Rounding decides some things: whether a ray passes over an edge, which of two triangles it meets, lobe or not. The twin knows
//! where ([`Near`]): what such a decision may bring or not bring is added to what the sum may be off by. Where the path goes on
//! differently afterwards, that is the most which any path may bring from there on.

use std::ops::Range;

use super::shared::lobe::lobe_density;
use super::shared::random::{direction_about, net_point, on_circle, shuffled, words_of};
use super::shared::trace::{Met, What, trace};
use super::shared::walk::{Ground, ray_from};
use crate::measure::tolerance::near::{
    Near, Near3, all, angle, any, dot, minus, normalize, plus, product, times,
};
use crate::plan::{REFERENCE_BATCH, most_light, reference_inputs};
use crate::scene::{Albedo, Border, Lobe, Scene};
use std::f64::consts::PI;

const BITS: u32 = REFERENCE_BATCH.ilog2();

/// Below this f32 may have nothing where f64 has something: whether a ray is sent at all is in doubt.
const FAINTEST: f64 = 1e-30;

/// Radiance, its density of choice.
struct Environment {
    size: [i32; 2],
    texels: Vec<[f32; 4]>,
    cdf: Vec<f32>,
    rotation_turns: Near,
}

/// All that the shader is given.
pub struct Tracer<'a> {
    scene: &'a Scene,
    ground: Ground,
    samples: Vec<[f32; 3]>,
    /// Two texels a light: suns, key lights, balls.
    lights: Vec<[f32; 4]>,
    environment: Option<Environment>,
    albedo: Vec<[f32; 3]>,
    lobes: Vec<[f32; 2]>,
    bounces: u32,
    seed: u32,
    /// Light that has not been reflected counts.
    counts_direct: bool,
    /// The most that a path brings which is reflected so many times.
    most: Vec<[f64; 3]>,
    /// Radiance of what a ray sees that leaves the ground, sky and environment; and of all balls, which it passes on its way,
    /// wherever that ends.
    far: [f64; 3],
    balls: [f64; 3],
}

/// What some paths of a sample bring.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    /// The sum of their light.
    pub light: Near3,
    /// Rays.
    pub rays: Near,
    /// Decisions that are in doubt, of light that has been reflected so often before it is: by samples alone, once besides, more.
    pub doubts: [u32; 3],
    /// What the light is off by for them.
    pub in_doubt: [f64; 3],
    /// Of rays of each, over all places where one was held against the surface, how many cells it had come, and one.
    pub crossed: [f64; 3],
    /// Of which of them it is now.
    reflected: usize,
}

impl Default for Traced {
    fn default() -> Self {
        Self {
            light: [Near::ZERO; 3],
            rays: Near::ZERO,
            doubts: [0; 3],
            in_doubt: [0.0; 3],
            crossed: [0.0; 3],
            reflected: 0,
        }
    }
}

impl Traced {
    /// What may or may not be brought, `most` at most: added where it surely is. Where rounding leaves nothing of it, any of that.
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

    /// Adds what others bring.
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

/// Where a path stands.
struct Place {
    base: [i32; 2],
    offset: [Near; 2],
    own: Near,
    normal: Near3,
    albedo: Near3,
    lobe: [Near; 2],
    mirror: Near3,
}

/// What a place reflects: see the shader.
struct Reflected {
    facing: Near,
    light: Near3,
    density: Near,
    scattered: Near3,
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

fn one() -> Near {
    Near::of(1.0)
}

/// Where brought light is so faint that f32 may have none, no ray may be sent.
fn is_some(of: Near3) -> Option<bool> {
    let of = largest(of);
    let is_faint = of.v > 0.0 && of.v < FAINTEST;
    of.above(Near::ZERO).filter(|_| !is_faint)
}

impl<'a> Tracer<'a> {
    /// Of a scene, with height and slopes of every sample's ground as the device has them. `counts_direct`: of a list of samples
    /// what has not been reflected does not count.
    pub fn of(
        scene: &'a Scene,
        samples: Vec<[f32; 3]>,
        (bounces, seed): (u32, u32),
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
        let count = samples.len();
        let lobe = |phong: crate::scene::Phong| [phong.exponent, phong.scale];
        let sky = lights.sky.unwrap_or_default();
        let texels = lights.environment.iter().flat_map(|e| e.texels());
        let brightest = texels.fold([0.0_f32; 3], |m, t| [0, 1, 2].map(|c| m[c].max(t[c])));
        let balls = |c: usize| lights.spheres.iter().map(|ball| f64::from(ball.radiance[c])).sum();
        Self {
            far: [0, 1, 2].map(|c| f64::from(sky[c]) + f64::from(brightest[c])),
            balls: [0, 1, 2].map(balls),
            ground: Ground::of(field, surface.border),
            lights: four(inputs.next().expect("lights")),
            environment,
            albedo: match &surface.albedo {
                Albedo::Constant(colour) => vec![*colour; count],
                Albedo::Map(map) => map.clone(),
            },
            lobes: match &surface.phong {
                None => Vec::new(),
                Some(Lobe::Constant(phong)) => vec![lobe(*phong); count],
                Some(Lobe::Map(map)) => map.iter().map(|p| lobe(*p)).collect(),
            },
            most: (0..=bounces).map(|b| most_light(scene, b)).collect(),
            scene,
            samples,
            bounces,
            seed,
            counts_direct,
        }
    }

    /// The most that a scattered ray sees where so many more may follow: balls that it leaves, and then what is far or ground.
    fn most_seen(&self, left: u32) -> [f64; 3] {
        let later = left.checked_sub(1).map_or([0.0; 3], |l| self.most[l as usize]);
        [0, 1, 2].map(|c| self.balls[c] + self.far[c].max(later[c]))
    }

    /// Suns, key lights, balls.
    fn counts(&self) -> [usize; 3] {
        let lights = &self.scene.lights;
        [lights.suns.len(), lights.keys.len(), lights.spheres.len()]
    }

    /// What some of a batch's paths bring to a sample with some of the lights, `slot` being its place among the sums.
    ///
    /// # Panics
    /// When the sample lies outside the field.
    pub fn traced(
        &self,
        sample: usize,
        (slot, batch): (u32, u32),
        (paths, lights): (Range<u32>, Range<u32>),
    ) -> Traced {
        let mut all = Traced::default();
        for path in paths {
            let words = [slot, batch, self.seed];
            self.path_light(self.first(sample), path, words, &lights, &mut all);
        }
        all
    }

    /// Of what stands at a sample.
    fn first(&self, sample: usize) -> Place {
        let cols = self.scene.field.cols();
        let [own, east, north] = given(self.samples[sample]);
        let normal = normalize([-east, -north, one()]);
        let mirror = times(Near::of(2.0) * normal[2], normal);
        Place {
            base: [(sample % cols) as i32, (sample / cols) as i32],
            offset: [Near::ZERO; 2],
            own,
            normal,
            albedo: given(self.albedo[sample]),
            lobe: self.lobes.get(sample).map_or([Near::ZERO; 2], |l| given(*l)),
            mirror: minus(mirror, [Near::ZERO, Near::ZERO, one()]),
        }
    }

    /// Of what a ray along e has met.
    fn place_of(&self, met: &Met, is_lower: bool, e: Near3) -> Place {
        let [nw, ne, sw, se] = self.ground.corners(met.cell);
        let [east, south] = if is_lower { [se - sw, sw - nw] } else { [ne - nw, se - ne] };
        let [x, y] = self.ground.cell_m;
        let normal = normalize([-east / x, south / y, one()]);
        let (cols, rows) = (self.scene.field.cols(), self.scene.field.rows());
        let at = met.cell.map(|i| i as usize);
        let next = [(at[0] + 1) % cols, (at[1] + 1) % rows];
        let third = if is_lower { [at[0], next[1]] } else { [next[0], at[1]] };
        let [far, along] = if is_lower { met.offset } else { [met.offset[1], met.offset[0]] };
        let near = one() - along;
        let rest = one() - near - far;
        let samples = [(near, at), (far, next), (rest, third)].map(|(w, [c, r])| (w, r * cols + c));
        let between = |of: &dyn Fn(usize) -> Near| {
            let [a, b, c] = samples.map(|(weight, sample)| weight * of(sample));
            a + b + c
        };
        let is_map = matches!(self.scene.surface.albedo, Albedo::Map(_));
        let lobe_is_map = matches!(self.scene.surface.phong, Some(Lobe::Map(_)));
        let channel = |c: usize| between(&|i| Near::given(self.albedo[i][c]));
        let lobe = |c: usize| match (lobe_is_map, self.lobes.first()) {
            (true, _) => between(&|i| Near::given(self.lobes[i][c])).max(Near::ZERO),
            (false, Some(lobe)) => Near::given(lobe[c]),
            (false, None) => Near::ZERO,
        };
        Place {
            base: met.cell,
            offset: met.offset,
            own: nw + met.offset[0] * east + met.offset[1] * south,
            normal,
            albedo: if is_map { [0, 1, 2].map(channel) } else { given(self.albedo[0]) },
            lobe: [0, 1].map(lobe),
            mirror: minus(e, times(Near::of(2.0) * dot(e, normal), normal)),
        }
    }

    /// Share of scattered rays that the lobe sends.
    fn lobe_choice(place: &Place) -> Near {
        place.lobe[1] / (largest(place.albedo) + place.lobe[1]).max(Near::of(1e-30))
    }

    fn reflected(&self, place: &Place, e: Near3) -> Reflected {
        let facing = dot(place.normal, e);
        let density = facing / Near::of(PI);
        let light = times(density, place.albedo);
        if self.lobes.is_empty() {
            return Reflected { facing, light, density, scattered: place.albedo };
        }
        let lobe = lobe_density(minus(e, place.mirror), place.lobe[0]);
        let choice = Self::lobe_choice(place);
        let density = density * (one() - choice) + lobe * choice;
        let more = place.lobe[1] * lobe;
        let light = light.map(|l| l + more);
        let scattered = light.map(|l| l / density.max(Near::of(1e-30)));
        Reflected { facing, light, density, scattered }
    }

    /// Adds what one path brings.
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
            // What a path that goes on differently may bring, and its rays.
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
                let ray = ray_from(&self.ground, place.base, place.offset, place.own, light.e);
                let far = Near::of(1e30);
                let t_end = light.end_m.map_or(far, |end| end * ray.scale.min(Near::of(1e6)));
                let met = trace(&self.ground, &ray, t_end);
                sum.crossed[sum.reflected] += met.crossed;
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
                    let ray = ray_from(&self.ground, place.base, place.offset, place.own, e);
                    let met = trace(&self.ground, &ray, Near::of(1e30));
                    sum.crossed[sum.reflected] += met.crossed;
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
                // What is scattered is no more than arrives.
                Some(true) if of.scattered.iter().any(|s| s.off > 1.0) => {
                    return parts(sum, carried, left);
                }
                Some(true) => sum.ray(Some(true)),
            }
            let ray = ray_from(&self.ground, place.base, place.offset, place.own, e);
            let met = trace(&self.ground, &ray, Near::of(1e30));
            sum.crossed[sum.reflected] += met.crossed;
            let scattered = product(carried, of.scattered);
            let Some(what) = met.what else {
                let (seen, all) = (self.most_seen(left), most(carried, left));
                sum.doubt([0, 1, 2].map(|c| (scattered[c].most() * seen[c]).min(all[c])));
                sum.rays.off += f64::from(left * (lights.end - lights.start + 2));
                return;
            };
            let mut seen = Traced::default();
            if has_sky && what == What::Free {
                let sky = self.scene.lights.sky.unwrap_or_default();
                seen.light = given(sky);
                if let Some(environment) = &self.environment {
                    environment.towards(e, of.density, &mut seen);
                }
            }
            let [suns, keys, _] = self.counts();
            for i in (suns + keys).max(lights.start as usize)..lights.end as usize {
                let ball = given(self.lights[2 * i]);
                let to = minus([ball[0], ball[1], ball[2]], centre);
                let ahead = dot(to, e);
                let inside = ball[3] * ball[3] - dot(to, to);
                let exit_m = ahead + (ahead * ahead + inside).max(Near::ZERO).sqrt();
                let is_before = any([Some(what != What::Hit), (exit_m * ray.scale).at_most(met.t)]);
                let in_view = all([Near::ZERO.at_most(inside), is_before]);
                let radiance = colour(self.lights[2 * i + 1]);
                seen.add(radiance, in_view, radiance.map(Near::most));
            }
            if counts == Some(true) {
                let light = product(scattered, seen.light);
                sum.light = plus(sum.light, light);
                sum.doubts[sum.reflected] += seen.doubts[0];
                (0..3).for_each(|c| sum.in_doubt[c] += scattered[c].most() * seen.in_doubt[c]);
            }
            if left == 0 || what != What::Hit {
                return;
            }
            carried = scattered;
            let Some(is_lower) = met.lower else { return parts(sum, carried, left - 1) };
            place = self.place_of(&met, is_lower, e);
        }
    }

    /// Where the place lies in the world; none where rounding decides whether a field that repeats begins again there.
    fn centre(&self, place: &Place) -> Option<Near3> {
        let (cols, rows) = (self.scene.field.cols(), self.scene.field.rows());
        let mut from = [0, 1].map(|i| Near::given(place.base[i] as f32) + place.offset[i]);
        if self.scene.surface.border == Border::Periodic {
            for (from, side) in from.iter_mut().zip([cols, rows]) {
                if !Near::given(side as f32).above(*from)? {
                    *from = Near::ZERO;
                }
            }
        }
        let [x, y] = self.ground.cell_m;
        Some([from[0] * x, (Near::given((rows - 1) as f32) - from[1]) * y, place.own])
    }

    /// What a light may bring; none where rounding decides where on it a ray goes.
    fn light(&self, place: &Place, centre: Near3, r: usize, u: [Near; 2]) -> Option<Shining> {
        let [suns, keys, _] = self.counts();
        let source = given(self.lights[2 * r]);
        let colour = colour(self.lights[2 * r + 1]);
        let axis = [source[0], source[1], source[2]];
        let mut end_m = None;
        let mut shines = Some(true);
        let mut solid = one();
        let e = if (suns..suns + keys).contains(&r) {
            towards_key(source, u)
        } else {
            let is_far = r < suns;
            let to = if is_far { axis } else { minus(axis, centre) };
            let away = dot(to, to).sqrt();
            let sine = source[3] / away;
            let sine2 = sine * sine;
            let root = (one() - sine2).max(Near::ZERO).sqrt();
            let cone = if is_far { source[3] } else { sine2 / (one() + root) };
            let off = u[0] * cone;
            let is_apart = away.above(Near::ZERO)?;
            let above = [Near::ZERO, Near::ZERO, one()];
            let towards = if is_apart { to.map(|t| t / away) } else { above };
            if !is_far {
                shines = one().above(sine2);
                let two = Near::of(2.0);
                let beside2 = off * (two - off) * away * away;
                let half = (source[3] * source[3] - beside2).max(Near::ZERO).sqrt();
                end_m = Some(((one() - off) * away - half).max(Near::ZERO));
                solid = Near::of(2.0 * PI) * cone;
                // From inside no ray is sent, whichever way.
                if shines == Some(false) {
                    let (e, brought) = (above, [Near::ZERO; 3]);
                    return Some(Shining { e, brought, reflected: Some(false), shines, end_m });
                }
            }
            direction_about(towards, off, u[1])?
        };
        let of = self.reflected(place, e);
        let brought = product(of.light, colour).map(|l| l * solid);
        let reflected = of.facing.above(Near::ZERO);
        Some(Shining { e, brought, reflected, shines, end_m })
    }

    /// Where the scattered ray goes; none where rounding decides whether by the lobe.
    fn scattered(&self, place: &Place, u: [Near; 2], v: [Near; 2]) -> Option<Near3> {
        let by_lobe =
            if self.lobes.is_empty() { false } else { Self::lobe_choice(place).above(v[0])? };
        if by_lobe {
            let power = one() / (place.lobe[0] + one());
            let near_mirror = u[0].max(Near::of(1e-30)).powf(power);
            return direction_about(place.mirror, one() - near_mirror, u[1]);
        }
        let two = Near::of(2.0);
        let side = (Near::of(4.0) * u[0] * (one() - u[0])).sqrt();
        let [cos, sin] = on_circle(u[1]).map(|c| c * side);
        Some(normalize(plus(place.normal, [cos, sin, one() - two * u[0]])))
    }
}

/// A direction of a light and what it may bring.
struct Shining {
    e: Near3,
    brought: Near3,
    /// Whether it faces the place.
    reflected: Option<bool>,
    shines: Option<bool>,
    /// Where the light begins, of balls.
    end_m: Option<Near>,
}

/// A direction of `turn` turns, at 1 - cos of its zenith angle.
fn at_turn(turn: Near, below: Near) -> Near3 {
    let root = (below * (Near::of(2.0) - below)).max(Near::ZERO).sqrt();
    let [cos, sin] = on_circle(turn - Near::of(turn.v.floor())).map(|c| c * root);
    [cos, sin, one() - below]
}

fn mix(a: Near, b: Near, share: Near) -> Near {
    a * (one() - share) + b * share
}

/// A direction of a key light, evenly over its solid angle.
fn towards_key(key: [Near; 4], u: [Near; 2]) -> Near3 {
    at_turn(key[0] + key[1] * u[1], Near::of(2.0) * mix(key[2], key[3], u[0]))
}

impl Environment {
    /// First entry above u of n entries of the shares from `at` on, `step` apart: f32 as the shader's.
    fn picked(&self, u: Near, at: usize, step: usize, n: i32) -> i32 {
        let (mut low, mut high) = (0, n - 1);
        while low < high {
            let middle = (low + high) >> 1;
            if f64::from(self.cdf[at + middle as usize * step]) > u.v {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        low
    }

    /// A direction by the light of its texels, and its texel.
    fn towards_light(&self, u: [Near; 2], v: [Near; 2]) -> (Near3, [f32; 4]) {
        let [width, height] = self.size;
        let across = width as usize + 1;
        let row = self.picked(u[0], 0, across, height);
        let col = self.picked(u[1], row as usize * across + 1, 1, width);
        let half_row = Near::of(0.25) / Near::given(height as f32);
        let sine2 = |row: i32| {
            let [_, sine] = on_circle(Near::given(row as f32) * half_row);
            sine * sine
        };
        let below = Near::of(2.0) * mix(sine2(row), sine2(row + 1), v[1]);
        let across = (Near::given(col as f32) + v[0]) / Near::given(width as f32);
        let turn = Near::of(0.5) - across + self.rotation_turns;
        (at_turn(turn, below), self.texels[(row * width + col) as usize])
    }

    /// Adds what is seen along e, weighed by the balance heuristic: where rounding decides between texels, that of f64, and the
    /// largest difference to any other of them is in doubt. Straight above, e may be of any column.
    fn towards(&self, e: Near3, density: Near, seen: &mut Traced) {
        let [width, height] = self.size;
        let length = (e[0] * e[0] + e[1] * e[1]).sqrt();
        let [azimuth, zenith] = [angle(e[1], e[0]), angle(length, e[2])];
        let turn = Near::of(0.5) - azimuth / Near::of(2.0 * PI) + self.rotation_turns;
        let down = zenith / Near::of(PI);
        let texels = |of: Near, n: i32| {
            let place = of * Near::given(n as f32);
            [0.0, -1.0, 1.0].map(|side| (place.v + side * place.off).floor() as i32)
        };
        let [col, west, east] = texels(turn, width);
        let [row, top, bottom] = texels(down, height).map(|row| row.clamp(0, height - 1));
        let at = |col: i32, row: i32| {
            let from_there = self.texels[(row * width + col.rem_euclid(width)) as usize];
            let weight = density / (density + Near::given(from_there[3])).max(Near::of(1e-30));
            times(weight, colour(from_there))
        };
        let light = at(col, row);
        seen.light = plus(seen.light, light);
        let mut apart = [0.0_f64; 3];
        // Once around is all of them.
        let cols = west..=east.min(west.saturating_add(width - 1));
        for other in cols.flat_map(|c| (top..=bottom).map(move |r| (c, r))) {
            let other = at(other.0, other.1);
            for c in 0..3 {
                let more_off = (other[c].off - light[c].off).max(0.0);
                apart[c] = apart[c].max((light[c].v - other[c].v).abs() + more_off);
            }
        }
        if apart != [0.0; 3] {
            seen.doubt(apart);
        }
    }
}

#[cfg(test)]
mod tests;
