//! Real fields under environments, beside light paths.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Picture, REFERENCE_BATCH};
use ridgelight::scene::{
    Albedo, BounceEngine, Bounces, Environment, HeightField, Lights, Scene, Surface,
};
use ridgelight_io::{HeightOptions, read_environment, read_heights};

use crate::middle::middle;
use crate::plot::{Curve, Panel, svg};
use crate::{Colours, ENGINES, colours, drawn, mean, off, quality, rms};

type Named<T> = Vec<(&'static str, T)>;

/// Most bounces that are drawn.
const MOST: usize = 3;

fn inputs(folder: Option<&Path>, side: usize) -> Result<(Named<HeightField>, Named<Environment>)> {
    let plain = HeightOptions::default();
    let washington = HeightOptions { cell_m: Some([66.0, 92.6]), ..plain };
    let Some(folder) = folder else {
        let mountain = read_heights(Path::new("assets/mt_washington_256.png"), &washington)?;
        let sky = read_environment(Path::new("assets/sky_512x256.hdr"), 0.0)?;
        return Ok((vec![("Mt Washington", middle(&mountain, side)?)], vec![("sky", sky)]));
    };
    let rainier = HeightOptions { cell_m: Some([64.0, 92.6]), nodata: Some(-32768.0), ..plain };
    // 80 cells from black to white.
    let moss = HeightOptions { z_scale: 80.0 / 65535.0, cell_m: Some([1.0; 2]), ..plain };
    let fields = [
        ("Mt Washington", "mt_washington_256.png", washington),
        ("White Mountains", "N44W072.hgt", plain),
        ("Mt Rainier", "mt_rainier_90m.tif", rainier),
        ("moss", "Moss001_1K_Displacement.png", moss),
    ];
    let fields = fields.into_iter().map(|(name, file, options)| {
        let field = read_heights(&folder.join("height").join(file), &options)?;
        Ok((name, middle(&field, side)?))
    });
    let environments = [("sky", "sky_512x256.hdr"), ("room", "lab.hdr")];
    let environments = environments
        .into_iter()
        .map(|(name, file)| Ok((name, read_environment(&folder.join("env").join(file), 0.0)?)));
    Ok((fields.collect::<Result<_>>()?, environments.collect::<Result<_>>()?))
}

fn scene(field: &HeightField, environment: &Environment, albedo: f32) -> Scene {
    Scene {
        field: field.clone(),
        surface: Surface { albedo: Albedo::Constant([albedo; 3]), ..Surface::default() },
        lights: Lights { environment: Some(environment.clone()), ..Lights::default() },
    }
}

/// Light paths' mean radiance: by half of them, and by all.
fn traced(gpu: &mut Headless, scene: &Scene, bounces: u32, paths: u32) -> Result<[Colours; 2]> {
    let plan = plan::reference(scene, bounces, 1, &gpu.report().limits)?;
    let contents = plan::reference_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let passes = plan.passes.iter().enumerate();
    let bands: Vec<usize> = passes.filter(|(_, p)| p.name() == "path_trace").map(|b| b.0).collect();
    let half = paths.div_ceil(2 * REFERENCE_BATCH).max(1);
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        for _ in 1..half {
            gpu.draw_passes(frame, &bands)?;
        }
        let first = colours(&gpu.pixels(frame, 0)?);
        for _ in 0..half {
            gpu.draw_passes(frame, &bands)?;
        }
        Ok([first, colours(&gpu.pixels(frame, 0)?)])
    })
}

fn less(a: &Colours, b: &Colours) -> Colours {
    a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|c| a[c] - b[c])).collect()
}

/// What a scene of albedo 1 throws: without bounces, then each bounce alone.
struct Truth {
    layers: Vec<Colours>,
}

impl Truth {
    /// By half of the paths, and by all. Paths with more bounces begin alike, so that what they do not share is the
    /// last bounce's own.
    fn of(gpu: &mut Headless, scene: &Scene, paths: u32) -> Result<[Self; 2]> {
        let mut all = Vec::new();
        for count in 0..=MOST {
            all.push(traced(gpu, scene, count as u32, paths)?);
        }
        Ok([0, 1].map(|which| {
            let layer = |k: usize| match k {
                0 => all[0][which].clone(),
                _ => less(&all[k][which], &all[k - 1][which]),
            };
            Self { layers: (0..=MOST).map(layer).collect() }
        }))
    }

    /// Light that has been thrown from `first` to `last` times, for an albedo a: a^(k+1) of bounce k.
    fn light(&self, albedo: f64, first: usize, last: usize) -> Colours {
        let mut sum = vec![[0.0; 3]; self.layers[0].len()];
        for k in first..=last {
            let share = albedo.powi(k as i32 + 1);
            for (sum, layer) in sum.iter_mut().zip(&self.layers[k]) {
                *sum = [0, 1, 2].map(|c| sum[c] + share * layer[c]);
            }
        }
        sum
    }
}

/// How far the mean of all paths is off by chance, %: half of what two halves differ by is what all is off one by.
fn chance([half, all]: &[Truth; 2], albedo: f64, first: usize, last: usize) -> f64 {
    let [half, all] = [half, all].map(|t| t.light(albedo, first, last));
    let apart = less(&half, &all);
    100.0 * rms(apart.as_flattened().iter().copied()) / mean(&all)
}

/// What the planner takes.
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
            let noise = [1, 0].map(|first| chance(truth, albedo64, first, count));
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
                    off(&got.bounced, &bounced),
                    noise[0],
                    off(&got.whole, &whole),
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
            points.push([got.ms, off(&got.bounced, &bounced)]);
        }
        let name = format!("{}, 8 to 64 azimuths", engine.name());
        curves.push(Curve { name, points, colour, is_floor: false });
    }
    let ends = curves.iter().flat_map(|c| &c.points).map(|p| p[0]);
    let [from, to] = ends.fold([f64::MAX, 0.0_f64], |[l, h], x| [l.min(x), h.max(x)]);
    let noise = chance(truth, albedo.into(), 1, MOST);
    let points = vec![[from, noise], [to, noise]];
    curves.push(Curve { name: "chance in the truth".into(), points, colour: 4, is_floor: true });
    Ok(Panel {
        title: format!("{}, {}", names[0], names[1]),
        x: "ms of three bounces",
        y: "bounced light, RMSE %",
        curves,
    })
}

/// The tables; and the figure.
pub fn run(gpu: &mut Headless, folder: Option<&Path>, side: usize, paths: u32) -> Result<String> {
    let (fields, environments) = inputs(folder, side)?;
    println!(
        "The middle {side}² samples, 64 azimuths, beside {paths} paths a sample: RMSE over the mean, %; chance: by how much \
         the paths are off, as their halves tell; picked: by the planner\n"
    );
    println!(
        "| field | light | albedo | bounces | engine | bounced | chance | whole | chance | ms | over brute's |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
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
    Ok(svg(&panels))
}
