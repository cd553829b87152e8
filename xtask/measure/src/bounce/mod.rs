//! Errors and times of each bounce engine: on spherical pits against their closed form, on real fields
//! against path-traced references.
//!
//! Fields: the middle N² (64) grid points of FOLDER's under two environments, else of the bundled
//! mountain under the bundled sky; two albedos, one and three bounces, N (8192) paths per grid point.
//! FILE.svg shows three bounces of albedo 0.8 under each field's first environment by azimuths.
//! Milliseconds are those of the passes for bounces, sweeps included.

mod pits;
pub mod table;

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Picture, REFERENCE_BATCH};
use ridgelight::scene::{
    Albedo, BounceEngine, Bounces, Environment, HeightField, Normals, Quality, Scene,
};

use crate::common::args::Args;
use crate::common::frames::{
    Colours, add, device, drawn_in_layers, error, mean, minus, rms_of, traced_at,
};
use crate::common::plot::{self, Panel, Style, curve};
use crate::common::{Outcome, head, inputs};

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::BruteForce, BounceEngine::Sweep, BounceEngine::Pyramid];
/// Most bounces that are drawn.
const MOST: u32 = 3;

/// As many azimuths of direct light as of bounces.
fn quality(engine: BounceEngine, count: u32, azimuths: u32) -> Quality {
    let bounces = Bounces { count, engine, azimuths, cutoff: 0.0, ..Bounces::default() };
    Quality { azimuths, bounces, ..Quality::default() }
}

type Named<T> = Vec<(&'static str, T)>;

fn fields_and_skies(
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

/// Path-traced radiance of a scene of albedo 1, by half of the paths and by all: without bounces, then
/// each bounce alone.
struct Reference([Vec<Colours>; 2]);

impl Reference {
    /// Paths with more bounces begin alike, so what they do not share is the last bounce's own.
    fn of(gpu: &mut Headless, scene: &Scene, paths: u32) -> Result<Self> {
        let half = paths.div_ceil(2 * REFERENCE_BATCH).max(1);
        let all = (0..=MOST)
            .map(|count| traced_at(gpu, scene, (count, Normals::Smooth, 1), &[half, 2 * half]));
        let all = all.collect::<Result<Vec<_>>>()?;
        let layers = |which: usize| {
            let light = |k: usize| &all[k][which][0];
            let later = (1..all.len()).map(|k| minus(light(k), light(k - 1)));
            std::iter::once(light(0).clone()).chain(later).collect()
        };
        Ok(Self([layers(0), layers(1)]))
    }

    /// Light reflected `first` to `last` times again, for an albedo a: a^(k+1) of bounce k; and its
    /// Monte Carlo noise, %. Half of the difference of two halves is the error of all by one.
    fn light(&self, albedo: f32, first: u32, last: u32) -> (Colours, f64) {
        let [half, all] = self.0.each_ref().map(|layers| {
            let mut sum = vec![[0.0; 3]; layers[0].len()];
            for k in first..=last {
                add(&mut sum, f64::from(albedo).powi(k as i32 + 1), &layers[k as usize]);
            }
            sum
        });
        let noise = 100.0 * rms_of(&minus(&half, &all)) / mean(&all);
        (all, noise)
    }
}

/// The planner's choice.
fn picked(gpu: &Headless, scene: &Scene, count: u32) -> Result<String> {
    let auto = quality(BounceEngine::Auto, count, 64);
    let plan = plan::picture(scene, &auto, &gpu.report().limits, Picture::default())?;
    let engine = plan.settings.into_iter().find(|(name, _)| name == "bounce_engine");
    Ok(engine.map_or_else(|| "none".to_owned(), |(_, engine)| engine))
}

fn rows(gpu: &mut Headless, names: &str, scene: &mut Scene, reference: &Reference) -> Result<()> {
    for (albedo, count) in [(0.3_f32, 1), (0.3, MOST), (0.8, 1), (0.8, MOST)] {
        scene.surface.albedo = Albedo::Constant([albedo; 3]);
        let (indirect, indirect_noise) = reference.light(albedo, 1, count);
        let (whole, noise) = reference.light(albedo, 0, count);
        let (picked, mut first) = (picked(gpu, scene, count)?, None);
        for engine in ENGINES {
            let found = drawn_in_layers(gpu, scene, &quality(engine, count, 64))?;
            let ms = found.bounces_ms();
            let mark = if picked == engine.to_string() { ", picked" } else { "" };
            println!(
                "| {names} | {albedo} | {count} | {}{mark} | {:.2} | {indirect_noise:.2} | {:.3} | {noise:.3} | {ms:.1} | {:.3} |",
                engine,
                error(&found.indirect, &indirect)?,
                error(&found.light, &whole)?,
                ms / *first.get_or_insert(ms),
            );
        }
    }
    Ok(())
}

/// Three bounces of albedo 0.8 by azimuths: each engine's error over its time.
fn panel(gpu: &mut Headless, title: &str, scene: &Scene, reference: &Reference) -> Result<Panel> {
    let (indirect, noise) = reference.light(0.8, 1, MOST);
    let (mut curves, mut ends) = (Vec::new(), [f64::MAX, 0.0_f64]);
    for (colour, engine) in ENGINES.into_iter().enumerate() {
        let mut points = Vec::new();
        for azimuths in [8, 16, 32, 64] {
            let found = drawn_in_layers(gpu, scene, &quality(engine, MOST, azimuths))?;
            let ms = found.bounces_ms();
            ends = [ends[0].min(ms), ends[1].max(ms)];
            points.push([ms, error(&found.indirect, &indirect)?]);
        }
        let name = format!("{}, 8 to 64 azimuths", engine);
        curves.push(curve(&name, colour, Style::Dotted, points));
    }
    let points = ends.map(|ms| [ms, noise]).to_vec();
    curves.push(curve("noise of the reference", 4, Style::Dashes, points));
    Ok(Panel::new(title, ["ms of three bounces", "indirect light, relative RMSE %"], curves))
}

pub fn run(mut args: Args) -> Outcome {
    let (side, paths) = (args.number("--side", 64)?, args.number("--spp", 8192)?);
    let (rim, output, folder) = (args.number("--rim", 30)?, args.path("-o")?, args.folder());
    let mut gpu = args.open()?;
    println!("{}\n", device(&gpu));
    pits::run(&mut gpu, rim)?;
    let (fields, environments) = fields_and_skies(folder.as_deref(), side)?;
    println!(
        "The middle {side}² grid points, 64 azimuths, against {paths} paths per grid point: relative RMSE, %; noise: of the \
         paths, by the difference of their halves; picked: by the planner\n"
    );
    head(
        "| field | light | albedo | bounces | engine | bounced | noise | whole | noise | ms | over brute force |",
    );
    let mut panels = Vec::new();
    for (name, field) in &fields {
        for (i, (light, environment)) in environments.iter().enumerate() {
            let mut scene = inputs::under(field.clone(), environment.clone());
            scene.surface.albedo = Albedo::Constant([1.0; 3]);
            let reference = Reference::of(&mut gpu, &scene, paths)?;
            rows(&mut gpu, &format!("{name} | {light}"), &mut scene, &reference)?;
            if i == 0 {
                let title = format!("{name}, {light}");
                panels.push(panel(&mut gpu, &title, &scene, &reference)?);
            }
        }
    }
    Ok(plot::write(output.as_deref(), &panels)?)
}
