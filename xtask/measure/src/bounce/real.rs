//! Real fields under environments, beside the path-traced reference.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Picture, REFERENCE_BATCH};
use ridgelight::scene::{Albedo, BounceEngine, Bounces, Environment, HeightField, Scene};

use super::{ENGINES, drawn, quality};
use crate::common::frames::{Colours, add, error, mean, minus, rms, traced_at};
use crate::common::plot::{Panel, Style, curve};
use crate::common::{head, inputs};

type Named<T> = Vec<(&'static str, T)>;

/// Most bounces that are drawn.
const MOST: usize = 3;

fn inputs_of(
    folder: Option<&Path>,
    side: usize,
) -> Result<(Named<HeightField>, Named<Environment>)> {
    let Some(folder) = folder else {
        let mountain = inputs::middle(&inputs::mountain(1.0)?, side)?;
        return Ok((vec![("Mt Washington", mountain)], vec![("sky", inputs::sky(0.0)?)]));
    };
    let fields = [
        ("Mt Washington", "mt_washington_256.png"),
        ("White Mountains", inputs::WHITE_MOUNTAINS),
        ("Mt Rainier", inputs::RAINIER),
        ("moss", inputs::MOSS),
    ];
    let field = |(name, file)| Ok((name, inputs::middle(&inputs::field_of(folder, file)?, side)?));
    let environment = |(name, file)| Ok((name, inputs::environment_of(folder, file)?));
    let environments = [("sky", "sky_512x256.hdr"), ("room", "lab.hdr")];
    Ok((
        fields.into_iter().map(field).collect::<Result<_>>()?,
        environments.into_iter().map(environment).collect::<Result<_>>()?,
    ))
}

fn scene(field: &HeightField, environment: &Environment, albedo: f32) -> Scene {
    let mut scene = inputs::under(field.clone(), environment.clone());
    scene.surface.albedo = Albedo::Constant([albedo; 3]);
    scene
}

/// Radiance of a scene of albedo 1: without bounces, then each bounce alone.
struct Truth {
    layers: Vec<Colours>,
}

impl Truth {
    /// By half of the paths, and by all. Paths with more bounces begin alike, so that what they do not share is the
    /// last bounce's own.
    fn of(gpu: &mut Headless, scene: &Scene, paths: u32) -> Result<[Self; 2]> {
        let half = paths.div_ceil(2 * REFERENCE_BATCH).max(1);
        let counts = 0..=MOST as u32;
        let all = counts.map(|count| traced_at(gpu, scene, (count, 1), &[half, 2 * half]));
        let all = all.collect::<Result<Vec<_>>>()?;
        Ok([0, 1].map(|which| {
            let light = |k: usize| &all[k][which][0];
            let layer = |k: usize| match k {
                0 => light(0).clone(),
                _ => minus(light(k), light(k - 1)),
            };
            Self { layers: (0..=MOST).map(layer).collect() }
        }))
    }

    /// Light reflected `first` to `last` times again, for an albedo a: a^(k+1) of bounce k.
    fn light(&self, albedo: f64, first: usize, last: usize) -> Colours {
        let mut sum = vec![[0.0; 3]; self.layers[0].len()];
        for k in first..=last {
            add(&mut sum, albedo.powi(k as i32 + 1), &self.layers[k]);
        }
        sum
    }
}

/// Noise of the mean of all paths, %: half of the difference of two halves is the error of all by one.
fn noise([half, all]: &[Truth; 2], albedo: f64, first: usize, last: usize) -> f64 {
    let [half, all] = [half, all].map(|t| t.light(albedo, first, last));
    100.0 * rms(minus(&half, &all).as_flattened().iter().copied()) / mean(&all)
}

/// The planner's choice.
fn picked(gpu: &Headless, scene: &Scene, bounces: Bounces) -> Result<String> {
    let auto = quality(Bounces { engine: BounceEngine::Auto, ..bounces });
    let plan = plan::picture(scene, &auto, &gpu.report().limits, Picture::default())?;
    let engine = plan.settings.into_iter().find(|(name, _)| name == "bounce_engine");
    Ok(engine.map_or_else(|| "none".to_owned(), |(_, engine)| engine))
}

fn rows(
    gpu: &mut Headless,
    names: [&str; 2],
    (field, environment): (&HeightField, &Environment),
    truth: &[Truth; 2],
) -> Result<()> {
    let [name, light] = names;
    for albedo in [0.3_f32, 0.8] {
        let scene = scene(field, environment, albedo);
        let albedo64 = f64::from(albedo);
        for count in [1, MOST] {
            let bounced = truth[1].light(albedo64, 1, count);
            let whole = truth[1].light(albedo64, 0, count);
            let noise = [1, 0].map(|first| noise(truth, albedo64, first, count));
            let mut slowest = None;
            for engine in ENGINES {
                let bounces = Bounces {
                    count: count as u32,
                    engine,
                    azimuths: 64,
                    cutoff: 0.0,
                    ..Bounces::default()
                };
                let got = drawn(gpu, &scene, &quality(bounces))?;
                let over = got.ms / *slowest.get_or_insert(got.ms);
                let is_picked = picked(gpu, &scene, bounces)? == engine.name();
                println!(
                    "| {name} | {light} | {albedo} | {count} | {}{} | {:.2} | {:.2} | {:.3} | {:.3} | {:.1} | {over:.3} |",
                    engine.name(),
                    if is_picked { ", picked" } else { "" },
                    error(&got.bounced, &bounced)?,
                    noise[0],
                    error(&got.whole, &whole)?,
                    noise[1],
                    got.ms,
                );
            }
        }
    }
    Ok(())
}

/// Three bounces of albedo 0.8 by azimuths: each engine's error over its time.
fn panel(
    gpu: &mut Headless,
    names: [&str; 2],
    (field, environment): (&HeightField, &Environment),
    truth: &[Truth; 2],
) -> Result<Panel> {
    let albedo = 0.8_f32;
    let scene = scene(field, environment, albedo);
    let bounced = truth[1].light(albedo.into(), 1, MOST);
    let mut curves = Vec::new();
    for (colour, engine) in ENGINES.into_iter().enumerate() {
        let mut points = Vec::new();
        for azimuths in [8, 16, 32, 64] {
            let count = MOST as u32;
            let bounces = Bounces { count, engine, azimuths, cutoff: 0.0, ..Bounces::default() };
            let got = drawn(gpu, &scene, &quality(bounces))?;
            points.push([got.ms, error(&got.bounced, &bounced)?]);
        }
        let name = format!("{}, 8 to 64 azimuths", engine.name());
        curves.push(curve(&name, colour, Style::Dotted, points));
    }
    let ends = curves.iter().flat_map(|c| &c.points).map(|p| p[0]);
    let [from, to] = ends.fold([f64::MAX, 0.0_f64], |[l, h], x| [l.min(x), h.max(x)]);
    let noise = noise(truth, albedo.into(), 1, MOST);
    let points = vec![[from, noise], [to, noise]];
    curves.push(curve("noise of the reference", 4, Style::Dashes, points));
    let axes = ["ms of three bounces", "indirect light, relative RMSE %"];
    Ok(Panel::new(names.join(", "), axes, curves))
}

/// The tables; and the figure.
pub fn run(
    gpu: &mut Headless,
    folder: Option<&Path>,
    side: usize,
    paths: u32,
) -> Result<Vec<Panel>> {
    let (fields, environments) = inputs_of(folder, side)?;
    println!(
        "The middle {side}² grid points, 64 azimuths, beside {paths} paths per grid point: relative RMSE, %; noise: of the \
         paths, by the difference of their halves; picked: by the planner\n"
    );
    head(
        "| field | light | albedo | bounces | engine | bounced | noise | whole | noise | ms | over brute's |",
    );
    let mut panels = Vec::new();
    for (name, field) in &fields {
        for (i, (light, environment)) in environments.iter().enumerate() {
            let truth = Truth::of(gpu, &scene(field, environment, 1.0), paths)?;
            rows(gpu, [name, light], (field, environment), &truth)?;
            if i == 0 {
                panels.push(panel(gpu, [name, light], (field, environment), &truth)?);
            }
        }
    }
    Ok(panels)
}
