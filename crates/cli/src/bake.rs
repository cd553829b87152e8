//! `bake`: maps of a static field, for engines.

mod folder;
mod job;
mod kinds;
mod manifest;
mod map;
mod request;

use std::io::Write as _;
use std::path::PathBuf;

use ridgelight::Result;
use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::{self, Limits, Plan};
use ridgelight::scene::Quality;
use ridgelight_bake::{Encoding, Ray, normals};
use ridgelight_io as files;
use serde_json::json;

use crate::args::BakeArgs;
use crate::setup::{self, Outcome};
use crate::{horizon, idle};
pub use folder::check_new;
use folder::{check_folder, check_memory, parent, remove_old, take_manifest};
use job::{Job, first};
pub use kinds::Kind;
use kinds::{DirectionsJob, Lit, Request, Source};
pub use map::Format;
use map::{MapFiles, Whole};
pub use request::{help, kind_named, packing};

/// Describes the folder's contents. It is written last.
const MANIFEST: &str = "manifest.json";

/// A kind and its encoding.
#[derive(Clone, Copy)]
pub struct Packing {
    kind: &'static Kind,
    encoding: &'static Encoding,
}

pub fn run(args: &BakeArgs) -> Result<Outcome> {
    let wanted = request::wanted(args)?;
    check_folder(&args.output, &wanted)?;
    if let Some(json) = &args.global.json {
        setup::check_output("--json", json, &["json"])?;
    }
    let quality = request::quality(args)?;
    let field = setup::field(&args.input.path, &args.surface.field, &args.global)?;
    let scene = setup::scene(field, &args.surface, &args.lights)?;
    let (border, grid_points) = (scene.surface.border, scene.field.heights_m().len());
    let (directions, angles) = (request::directions(args)?, request::angles(args)?);
    let has_specular =
        scene.surface.specular.as_ref().is_some_and(|specular| specular.largest().scale > 0.0);
    let making = wanted.iter().map(|w| {
        let (quality, directions, encoding) = (&quality, &directions, w.encoding);
        let curvature = args.curvature;
        (w.kind.begin)(&Request {
            border,
            quality,
            directions,
            angles,
            curvature,
            encoding,
            has_texels: w.formats.contains(&Format::Ktx2),
            has_specular,
            grid_points,
        })
    });
    let making = making.collect::<Result<Vec<_>>>()?;
    request::check_uses(args, making.iter().map(|m| &m.source))?;
    let scatter = request::scatter(args, &quality);
    // Limits for a machine without a device; the device's own replace them once it is open.
    let limits = Limits::boundless(true, u64::MAX);
    let (quality, around) = (&quality, &directions);
    let seed = args.seed.unwrap_or(0);
    let curvature = args.curvature;
    let table = std::cell::OnceCell::new();
    let lit =
        Lit { scene: &scene, quality, limits, scatter, around, angles, curvature, seed, table };
    let mut job = Job { lit, wanted, making };
    let files = job.files();
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| args.output.join(name)).collect();
    let mut outputs: Vec<_> = paths.iter().map(|path| ("-o", Some(path.as_path()))).collect();
    outputs.push(("--json", args.global.json.as_deref()));
    let inputs = setup::inputs(&args.input.path, &args.lights, &args.surface);
    setup::check_distinct(&outputs, &inputs)?;
    setup::check_plan(&args.global, |limits| job.plans(limits).map(first))?;
    if args.plan {
        return say_plan(args, &job);
    }
    let on_disk = if args.output.is_dir() { args.output.as_path() } else { parent(&args.output) };
    let room: Vec<_> = files.iter().map(|(name, bytes)| (on_disk.join(name), *bytes)).collect();
    let room: Vec<_> = room.iter().map(|(path, bytes)| (path.as_path(), *bytes)).collect();
    files::check_room(&room)?;
    let (mut gpu, limits) = setup::device(&args.global)?;
    job.lit.limits = limits;
    job.check_layers(&limits)?;
    check_memory(job.host_bytes(&limits))?;
    let used = job.used(&limits)?;
    let why = |setting: &str| job.idle_reason(setting);
    idle::say_why(args.global.quiet, &args.quality.written, &used, &why);
    if !args.global.quiet {
        request::say_idle_light(args, &job.wanted, job.lit.scatter.is_some());
    }
    let _folder = files::ResultFolder::create(&args.output)?;
    bake(args, job, &mut gpu, &used)
}

fn bake(
    args: &BakeArgs,
    job: Job<'_>,
    gpu: &mut Headless,
    used: &[(String, String)],
) -> Result<Outcome> {
    let (has_horizons, traces_directions) = (job.has_horizons(), job.traces_directions());
    let is_light = job.wanted.iter().any(|w| request::is_light(w.kind));
    let Job { lit, wanted, making } = job;
    let Lit { quality, around: directions, curvature, limits, .. } = lit;
    let (field, border) = (&lit.scene.field, lit.scene.surface.border);
    let hash = format!("{:016x}", field.hash(border));
    let count = wanted.len();
    let mut all = Vec::new();
    for (wanted, making) in wanted.into_iter().zip(making) {
        let files = MapFiles::create(&args.output, wanted, making.map, field, &hash)?;
        all.push((making.source, files));
    }
    let bar = crate::setup::terminal::progress(args.global.quiet, "baking");
    let started = std::time::Instant::now();
    let (mut times, mut plan) = (Vec::new(), None);
    let normals = if has_horizons { normals(field, border) } else { Vec::new() };
    if has_horizons {
        let azimuths = plan::circle_rad(quality, field.cell_m())?;
        let width_rad = std::f64::consts::TAU / azimuths.len() as f64;
        let mut each = |k: u32, elevations: &[f32], _: &[f32]| {
            bar.set_message(format!("baking: azimuth {} of {}", k + 1, azimuths.len()));
            let ray = Ray { azimuth_rad: azimuths[k as usize], width_rad };
            all.iter_mut().try_for_each(|(source, files)| match source {
                Source::Horizons(maker) => maker.add(ray, elevations, &normals, files),
                Source::Directions(_) | Source::Light(_) => Ok(()),
            })
        };
        let found = horizon::for_each(gpu, field, border, quality, &limits, false, &mut each)?;
        (times, plan) = (found.0, Some(found.1));
    }
    for (source, files) in &mut all {
        match source {
            Source::Horizons(_) => {}
            Source::Directions(of) => {
                bar.set_message("baking: visible points".to_owned());
                let own = (of.plan)(field, border, directions, curvature, &limits)?;
                let count = own.outputs().count();
                plan.get_or_insert_with(|| own.clone());
                let outputs = gpu.with_frame(own, &[field.heights_m()], |gpu, frame| {
                    times.extend(gpu.draw(frame)?);
                    let outputs = (0..count).map(|output| Ok(gpu.pixels(frame, output)?.values));
                    outputs.collect::<Result<Vec<_>>>()
                })?;
                let outputs = &outputs;
                let traced = DirectionsJob { field, border, directions, curvature, outputs };
                (of.take)(&traced, files)?;
            }
            Source::Light(of) => {
                let kind = files.kind();
                let say = |what: String| bar.set_message(format!("baking {kind}: {what}"));
                plan.get_or_insert(first((of.plans)(&lit, &limits)?));
                (of.make)(gpu, &lit, files, &say)?;
            }
        }
    }
    times.extend(gpu.take_timings());
    let plan = plan.expect("--what has a kind");
    let mut metadata = setup::metadata(gpu, field, &plan, &times);
    // A plan lists the settings of its part only.
    metadata.retain(|(name, _)| {
        let is_part = ["paths", "seed", "azimuths", "sh_order"].contains(&name.as_str());
        !is_part || used.iter().all(|(known, _)| known != name)
    });
    let is_more = |name: &str| metadata.iter().all(|(known, _)| known != name);
    let more: Vec<_> = used.iter().filter(|(name, _)| is_more(name)).cloned().collect();
    metadata.extend(more);
    let lights = is_light.then_some((&args.lights, &args.surface, lit.scene));
    metadata.extend(setup::asked(&args.input.path, &args.surface.field, lights));
    metadata.push(("field_hash".into(), hash));
    let mut whole = Vec::new();
    // A note that applies to several kinds is printed once.
    let mut notes: Vec<(String, Vec<&str>)> = Vec::new();
    for (i, (source, mut files)) in all.into_iter().enumerate() {
        bar.set_message(format!("writing {} of {count}", i + 1));
        if let Source::Horizons(maker) = source {
            maker.end(&normals, &mut files)?;
        }
        for note in files.notes() {
            match notes.iter_mut().find(|(known, _)| *known == note) {
                Some((_, kinds)) => kinds.push(files.kind()),
                None => notes.push((note, vec![files.kind()])),
            }
        }
        whole.push(files.complete(&metadata)?);
    }
    for (note, kinds) in notes.iter().filter(|_| !args.global.quiet) {
        let say = || writeln!(std::io::stderr(), "note: {}: {note}", kinds.join(", "));
        let _ = bar.suspend(say);
    }
    // An earlier manifest describes files that are about to be replaced.
    let before = take_manifest(&args.output)?;
    let maps = whole.into_iter().map(Whole::place).collect::<Result<Vec<_>>>()?;
    bar.finish_and_clear();
    let seconds = started.elapsed().as_secs_f64();
    metadata.push(("seconds".into(), format!("{seconds:.3}")));
    let mut manifest = manifest::describe(&metadata, &times, field, quality, &maps);
    if !has_horizons {
        manifest["horizons"] = serde_json::Value::Null;
    }
    if traces_directions {
        let vectors = directions.vectors().iter();
        manifest["directions"] = vectors.map(|e| json!([e.x, e.y, e.z])).collect();
    }
    files::write_json(&args.output.join(MANIFEST), &manifest)?;
    remove_old(&args.output, before)?;
    if let Some(json) = &args.global.json {
        files::write_json(json, &manifest)?;
    }
    if !args.global.quiet {
        say_done(args, (lit.scene, quality, count), (&times, has_horizons, seconds), gpu);
    }
    Ok(Outcome::Done)
}

fn say_done(
    args: &BakeArgs,
    (scene, quality, count): (&ridgelight::scene::Scene, &Quality, usize),
    (times, has_horizons, seconds): (&[Timing], bool, f64),
    gpu: &Headless,
) {
    let way = match has_horizons {
        true => format!("{} azimuths", quality.azimuths),
        false => format!("{} directions", args.directions.unwrap_or(request::DIRECTIONS)),
    };
    let gpu_s: f64 = times.iter().map(|t| t.ns).sum::<f64>() / 1e9;
    let of_it =
        if times.is_empty() { String::new() } else { format!(", {gpu_s:.1} s of it GPU time") };
    crate::say!(
        "Wrote {count} map{} to {}/ ({}x{}, {way}) in {seconds:.1} s{of_it} on {}.",
        if count == 1 { "" } else { "s" },
        args.output.display(),
        scene.field.cols(),
        scene.field.rows(),
        gpu.report().name
    );
}

/// Prints the files that a bake would write, and its memory.
fn say_plan(args: &BakeArgs, job: &Job) -> Result<Outcome> {
    let (name, limits) = crate::plan::limits(&args.global)?;
    let plans = job.plans(&limits)?;
    if args.global.quiet {
        return Ok(Outcome::Done);
    }
    if let Some(json) = &args.global.json {
        idle::note("json", &json.display().to_string(), "with --plan");
    }
    crate::say!("{:>14}  at most, bytes of {}", "file", args.output.display());
    for (name, bytes) in job.files() {
        crate::say!("{bytes:>14}  {name}");
    }
    let device = plans.iter().map(Plan::bytes).max().unwrap_or(0);
    crate::say!("{device:>14}  peak memory on {name}, one batch of azimuths or one kind at a time");
    crate::say!("{:>14}  memory of this process", job.host_bytes(&limits));
    let names: Vec<&str> = job.wanted.iter().map(|w| w.kind.name).collect();
    // Kinds of one table share its rays: list them once.
    let is_table = |name: &&str| name.starts_with("brdf");
    let first = names.iter().position(is_table);
    let own = names.iter().enumerate().filter(|(i, name)| !is_table(name) || first == Some(*i));
    let own = own.map(|(_, name)| name);
    for (count, what) in own.filter_map(|name| kinds::rays(&job.lit, name, &limits)) {
        crate::say!("{count:>14}  {what}");
    }
    Ok(Outcome::Done)
}
