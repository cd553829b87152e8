//! Light scattered between visible points at the extremes: the device's paths, over the oracle's visible points, in
//! f64.

use ridgelight::gpu::shaders::offset;
use std::f64::consts::PI;

use glam::DVec3;
use ridgelight::scene::{
    Albedo, Border, Lights, PhongSpecular, Scene, Specular, Sun, Surface, VisiblePoint,
};
use ridgelight_cpu::scatter_gather::{Gathered, GridPoints};
use ridgelight_cpu::tolerance::{EPSILON, Land, gathered};

use super::points::{Sight, places, renamed};
use super::{About, Asks, Case, Found, Probe, bounces, field, none, specular};

const STEPS: usize = offset("ScatterGatherPush", "steps");

const PLACES: usize = 12;

const EXPECTED: &str = "the mean of the paths' light, each look-up that of what the oracle leaves visible there, least to most where it may be \
     another; its own of each texel the zenith's sun on it, in steps from a quarter to all";
const BOUND: &str = "of each look-up what normals, cosines and lobes err by (`gathered`), of what arrives and of itself; 2 ε a path";

pub fn cases() -> Vec<Case> {
    let is_ground = |case: &Case| !case.name.contains("8191");
    let diffuse = bounces::cases().into_iter().filter(is_ground).map(|case| {
        let name = renamed(&case.name, "scattered");
        scattered(name, case)
    });
    // Black ground whose lobes no direction reaches scatters nothing.
    let is_visible = |case: &Case| !case.name.contains("albedo 0, lobes of 10000");
    let shiny = specular::cases().into_iter().filter(is_visible).map(|case| {
        let name = format!("scattered: {}", case.name);
        let mut case = scattered(name, case);
        // Where paths leave, specular reflects a sky.
        case.scene.lights.sky = Some([1.0; 3]);
        case
    });
    diffuse.chain(shiny).chain([level(), mirrors()]).collect()
}

fn scattered(name: String, case: Case) -> Case {
    Case {
        name,
        about: About::Scattering,
        expected: EXPECTED.to_owned(),
        bound: BOUND.to_owned(),
        asks: Asks::Scatter,
        probes: Box::new(probes),
        unjudged: none,
        is_long: |_| false,
        ..case
    }
}

/// Walls at right angles, which reflect a view from above to each other along level rows, and these to the zenith's
/// sun: lobes at their peaks.
fn mirrors() -> Case {
    let ground = field([6, 16], [1.0, 1.0], |_, c| c.abs_diff(8) as f64);
    let sun =
        Sun { azimuth_rad: 0.0, elevation_rad: 0.5 * PI, diameter_rad: 0.0, irradiance: [1.0; 3] };
    let phong_specular = Specular::Constant(PhongSpecular { exponent: 1e4, scale: 0.25 });
    let albedo = Albedo::Constant([0.5; 3]);
    let surface = Surface { albedo, border: Border::Periodic, specular: Some(phong_specular) };
    let lights = Lights { suns: vec![sun], ..Lights::default() };
    let name = "scattered between walls at right angles, lobes of 10000".to_owned();
    scattered(name, Case { scene: Scene { field: ground, surface, lights }, ..level() })
}

/// White, and no texel sees another: nothing is scattered.
fn level() -> Case {
    let ground = field([33, 33], [1.0, 1.0], |_, _| 8848.0);
    let white = Albedo::Constant([1.0; 3]);
    let surface = Surface { albedo: white, border: Border::Periodic, specular: None };
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    Case {
        name: "scattered by white level ground".to_owned(),
        about: About::Scattering,
        expected: "0: no path is taken".to_owned(),
        bound: "0".to_owned(),
        scene: Scene { field: ground, surface, lights },
        asks: Asks::Scatter,
        probes: Box::new(|found| {
            let all = found.texels(0).into_iter().enumerate();
            let probe = |(i, texel): (usize, [f32; 4])| Probe {
                found: texel[0].into(),
                expected: [0.0; 2],
                bound: 0.0,
                at: [0, i / 33, i % 33],
            };
            all.map(probe).collect()
        }),
        refuses: super::never,
        unjudged: none,
        is_long: |_| false,
    }
}

/// Direct diffuse light of suns in the zenith, in four steps from texel to texel.
pub fn direct(scene: &Scene) -> Vec<[f32; 3]> {
    let grid_points = GridPoints::of(scene);
    let sun: f32 = scene.lights.suns.iter().map(|sun| sun.irradiance[0]).sum();
    let of = |at: usize| {
        let facing = grid_points.albedo(at)[0] * grid_points.normal(at).z / PI;
        [(f64::from(sun) * facing) as f32 * (1 + at % 4) as f32 / 4.0; 3]
    };
    (0..scene.field.heights_m().len()).map(of).collect()
}

/// Least and most of the exit radiance, and the device's bound.
#[derive(Clone, Copy, Default)]
struct Light {
    ends: [f64; 2],
    off: f64,
}

struct Chain<'a> {
    scene: &'a Scene,
    sight: Sight<'a>,
    grid_points: GridPoints<'a>,
    direct: Vec<[f32; 3]>,
    /// Of each path's steps, in order: direction, sky.
    links: Vec<(DVec3, f64)>,
    steps: usize,
    /// Solid angle of all directions.
    weight_sr: f64,
    /// Whether the last hit counts by its direct light alone.
    ends_in_direct: bool,
}

impl Chain<'_> {
    /// The light of texel `at` towards `back` along a path from one of its steps on.
    fn leaving(&self, path: usize, step: usize, at: usize, back: DVec3) -> Light {
        let (e, sky) = self.links[path * self.steps + step];
        let mut light = Light { ends: [f64::MAX, 0.0], off: 0.0 };
        for visible in self.sight.possible(at, e) {
            let arrives = match visible {
                VisiblePoint::GridPoint(there) if step + 1 < self.steps => {
                    self.leaving(path, step + 1, there, -e)
                }
                VisiblePoint::GridPoint(there) if self.ends_in_direct => {
                    let own = f64::from(self.direct[there][0]);
                    Light { ends: [own; 2], off: 0.0 }
                }
                _ => Light::default(),
            };
            // Diffuse light of the sky is part of the direct light, as is the texel's own specular of it.
            let of_sky = match visible {
                VisiblePoint::Sky if step > 0 => sky,
                _ => 0.0,
            };
            let look = |light: f64, sky: f64| {
                let arrives = [[light; 3], [light + sky; 3]];
                self.grid_points.scattered(at, (e, self.weight_sr), back, arrives)
            };
            let ends = arrives.ends.map(|light| look(light, of_sky).light[0]);
            let more = look(arrives.off, 0.0);
            let off = self.off(at, e, &look(arrives.ends[1], of_sky))
                + more.light[0]
                + self.off(at, e, &more);
            light.ends = [light.ends[0].min(ends[0]), light.ends[1].max(ends[1])];
            light.off = light.off.max(off);
        }
        if step > 0 {
            let mut own = f64::from(self.direct[at][0]);
            let mut off = 0.0;
            for sun in
                self.scene.lights.suns.iter().filter(|_| self.scene.surface.specular.is_some())
            {
                // Nothing stands over a texel.
                let arrives = [[0.0; 3], [f64::from(sun.irradiance[0]); 3]];
                let of = self.grid_points.scattered(at, (DVec3::Z, 1.0), back, arrives);
                own += of.light[0];
                off += self.off(at, DVec3::Z, &of);
            }
            light.ends = light.ends.map(|end| end + own);
            light.off += off + 4.0 * EPSILON * light.ends[1];
        }
        light
    }

    /// The error of one look-up besides that of the arriving light.
    fn off(&self, at: usize, e: DVec3, of: &Gathered) -> f64 {
        let (field, border) = (&self.scene.field, self.scene.surface.border);
        let turned = Land::normal_at(field, border, [at / field.cols(), at % field.cols()]);
        let n = self.grid_points.specular(at).map_or(1.0, |phong| f64::from(phong.exponent));
        let [off, ..] = gathered(of, n, turned);
        let normal = self.grid_points.normal(at);
        let apart = 4.0 * turned + 16.0 * EPSILON;
        // A lobe ends at the texel's own plane; for an exponent of 0 at 90° beside its middle, too.
        let on_edge = normal.dot(e).abs() <= apart || (n < 1.0 && of.along.abs() <= apart);
        off + if on_edge { of.mirrored[0] } else { 0.0 }
    }
}

fn probes(found: &Found) -> Vec<Probe> {
    let (scene, field) = (found.scene, &found.scene.field);
    let all = found.texels(0);
    let mut passes = found.plan.passes.iter().filter(|pass| pass.name() == "scatter_gather");
    let pass = passes.next_back().expect("it scatters");
    let bytes = pass.push[STEPS..STEPS + 4].try_into().expect("four");
    let steps = u32::from_ne_bytes(bytes) as usize;
    let texels = found.plan.constants.chunks_exact(8);
    let link = |t: &[f32]| (DVec3::new(t[0].into(), t[1].into(), t[2].into()), t[4].into());
    let traced = found.traced();
    let has_specular = scene
        .surface
        .specular
        .as_ref()
        .is_some_and(|phong_specular| phong_specular.largest().scale > 0.0);
    let chain = Chain {
        scene,
        sight: Sight::of(scene),
        grid_points: GridPoints::of(scene),
        direct: direct(scene),
        links: texels.map(link).collect(),
        steps,
        weight_sr: traced.directions.share_sr() * traced.directions.count() as f64,
        ends_in_direct: !has_specular,
    };
    let probe = |at: usize| {
        let texel = all[at];
        let paths = texel[3] as usize;
        let mut sum = Light::default();
        for path in (0..paths).filter(|_| steps > 0) {
            let of = chain.leaving(path, 0, at, traced.scatter.view);
            sum.ends = [0, 1].map(|end| sum.ends[end] + of.ends[end]);
            sum.off += of.off;
        }
        let n = paths.max(1) as f64;
        let expected = sum.ends.map(|end| end / n);
        let bound = sum.off / n + (2.0 * n + 16.0) * EPSILON * expected[1];
        let (row, col) = (at / field.cols(), at % field.cols());
        Probe { found: texel[0].into(), expected, bound, at: [0, row, col] }
    };
    places(found, PLACES).into_iter().map(probe).collect()
}
