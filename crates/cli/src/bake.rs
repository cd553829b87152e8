//! `bake`: maps of a static field, for engines.

mod estimate;
mod folder;
mod job;
mod kinds;
mod map;
mod request;
mod stages;

use std::cell::OnceCell;
use std::path::PathBuf;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::{self, Limits, Plan};
use ridgelight::scene::{HeightField, Method, Quality, Scene};
use ridgelight_bake::{Encoding, HorizonSums, Ray, normals};
use ridgelight_io as files;
use serde_json::{Value, json};

use crate::args::BakeArgs;
use crate::setup::{self, Outcome};
use crate::{horizon, idle, maps};
use estimate::Estimate;
pub use folder::check_new;
use folder::{check_folder, check_memory, remove_old, take_manifest};
use job::{HORIZONS, Job, first};
pub use kinds::{Kind, Normals};
use kinds::{Making, Map, Source};
pub use map::Format;
use map::{MapFiles, Wanted};
pub use request::{help, kind_named, packing};
use stages::{FILES, Stages};

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
    let (field, georeference) =
        setup::georeferenced(&args.input.path, &args.scene.field, &args.global)?;
    let scene = setup::scene(field, &args.scene, setup::Unlit::Sky, args.global.quiet)?;
    let around = request::directions(args, args.directions.unwrap_or(request::DIRECTIONS))?;
    let mut specular_quality = quality;
    setup::suit(&mut specular_quality, &args.quality, (&scene, None));
    let mut job = Job {
        scene: &scene,
        quality: &quality,
        specular_quality,
        // Of a machine without a device; the device's own replace them once it is open.
        limits: Limits::boundless(true, u64::MAX),
        scatter: request::scatter(args, &quality),
        around: &around,
        angles: request::angles(args)?,
        curvature: args.curvature,
        normals: args.normals.unwrap_or_default(),
        pairs: kinds::PAIRS,
        seed: args.seed.unwrap_or(0),
        table: OnceCell::new(),
        maps: Vec::new(),
    };
    job.lay_out(wanted)?;
    request::check_uses(args)?;
    let files = job.files();
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| args.output.join(name)).collect();
    let mut outputs: Vec<_> = paths.iter().map(|path| ("-o", Some(path.as_path()))).collect();
    outputs.push(("--json", args.global.json.as_deref()));
    let inputs = setup::inputs(&args.input.path, &args.scene);
    setup::check_distinct(&outputs, &inputs)?;
    setup::check_plan(&args.global, |limits| job.plans(limits).map(first))?;
    if args.plan {
        return say_plan(args, &job);
    }
    let room = paths.iter().zip(&files).map(|(path, (_, bytes))| (path.as_path(), *bytes));
    files::check_room(&room.collect::<Vec<_>>())?;
    let (mut gpu, limits) = setup::device(&args.global)?;
    job.limits = limits;
    job.check_layers(&limits)?;
    check_memory(job.host_bytes(&limits))?;
    let used = job.used(&limits)?;
    let why = |setting: &str| job.idle_reason(setting);
    idle::say_why(args.global.quiet, &args.quality.written, &used, &why);
    if !args.global.quiet {
        request::say_idle_light(args, job.scatter.is_some());
    }
    let _folder = files::ResultFolder::create(&args.output)?;
    bake(args, (job, georeference), &mut gpu, &used)
}

/// A map's files, and its sums over horizons.
type Open<'a> = (MapFiles<'a>, Option<HorizonSums>);

/// Opens the files of all maps.
fn open<'a>(
    args: &BakeArgs,
    job: &Job<'a>,
    maps: Vec<(Wanted, Map)>,
    georeference: Option<&files::Georeference>,
) -> Result<Vec<Open<'a>>> {
    let (field, hash) = (job.field(), job.hash());
    let maps = maps.into_iter().map(|map| {
        let sums = match map.0.kind.source {
            Source::Sums(of) => Some(HorizonSums::new(of(job), job.grid_points())),
            _ => None,
        };
        Ok((MapFiles::create(&args.output, map, field, &hash, georeference)?, sums))
    });
    maps.collect()
}

/// Computes all maps and gives their values to their files, except sums over horizons. Returns the
/// times of passes, the first plan and the normals of texels, which the sums need.
fn compute(
    gpu: &mut Headless,
    job: &Job,
    all: &mut [Open],
    stages: &Stages,
) -> Result<(Vec<Timing>, Plan, Vec<DVec3>)> {
    let Job { quality, limits, .. } = *job;
    let (field, border) = (job.field(), job.border());
    let (mut times, mut plan, mut all_normals) = (Vec::new(), None, Vec::new());
    if all.iter().any(|(files, _)| files.kind().reads_horizons()) {
        stages.of_kind("");
        stages.begin(HORIZONS);
        all_normals = normals(field, border);
        let azimuths = plan::circle_rad(quality, field.cell_m())?;
        let width_rad = std::f64::consts::TAU / azimuths.len() as f64;
        let mut each = |k: u32, elevations: &[f32], _: &[f32]| {
            stages.show(&format!("azimuth {} of {}", k + 1, azimuths.len()));
            let ray = Ray { azimuth_rad: azimuths[k as usize], width_rad };
            all.iter_mut().try_for_each(|(files, sums)| match (files.kind().source, sums) {
                (Source::Horizons, _) => files.take(&[elevations]),
                (_, Some(sums)) => sums.add(ray, elevations, &all_normals),
                _ => Ok(()),
            })
        };
        let found = horizon::for_each(gpu, field, border, quality, &limits, false, &mut each)?;
        (times, plan) = (found.0, Some(found.1));
    }
    for (files, _) in all {
        stages.of_kind(files.kind().name);
        match files.kind().source {
            Source::Horizons | Source::Sums(_) => {}
            Source::SkyView => {
                stages.begin("");
                let own = maps::sky_view_plan(field, border, quality, &limits)?;
                plan.get_or_insert_with(|| own.clone());
                let (texels, own_times) = maps::sky_view(gpu, field, own)?;
                times.extend(own_times);
                files.take(&[&texels])?;
            }
            Source::Directions(of) => {
                stages.begin("");
                let own = (of.plan)(job, &limits)?;
                let count = own.outputs().count();
                plan.get_or_insert_with(|| own.clone());
                let outputs = gpu.with_frame(own, &[field.heights_m()], |gpu, frame| {
                    times.extend(gpu.draw(frame)?);
                    let outputs = (0..count).map(|output| Ok(gpu.pixels(frame, output)?.values));
                    outputs.collect::<Result<Vec<_>>>()
                })?;
                if let Some(probe) = of.probe {
                    stages.begin(kinds::stage::PROBES);
                    probe(job, files);
                    stages.begin("");
                }
                (of.take)(job, &outputs, files)?;
            }
            Source::Light(of) => {
                plan.get_or_insert(first((of.plans)(job, &limits)?));
                (of.make)(&mut Making { gpu, job, stages }, files)?;
            }
        }
    }
    times.extend(gpu.take_timings());
    Ok((times, plan.expect("--what has a kind"), all_normals))
}

/// Finishes all files under temporary names.
fn finish<'a>(
    all: Vec<Open<'a>>,
    normals: &[DVec3],
    metadata: &[(String, String)],
    stages: &Stages,
) -> Result<Vec<MapFiles<'a>>> {
    stages.of_kind("");
    stages.begin(FILES);
    let count = all.len();
    let whole = all.into_iter().enumerate().map(|(i, (mut files, sums))| {
        stages.show(&format!("map {} of {count}", i + 1));
        if let Some(sums) = sums {
            files.take_all(&sums.end(normals)?)?;
        }
        files.complete(metadata)?;
        Ok(files)
    });
    whole.collect()
}

fn bake(
    args: &BakeArgs,
    (mut job, georeference): (Job<'_>, Option<files::Georeference>),
    gpu: &mut Headless,
    used: &[(String, String)],
) -> Result<Outcome> {
    let has_horizons = job.has(Kind::has_horizons);
    let traces_directions = job.has(|kind| !kind.has_horizons());
    let is_light = job.has(Kind::is_light);
    let bar = crate::setup::terminal::progress(args.global.quiet, "estimating the time");
    let is_shown = !args.global.quiet || args.global.json.is_some();
    let estimate = if is_shown { Some(Estimate::of(gpu, args, &job)) } else { None };
    let estimate = estimate.map(estimate::unless_lost).transpose()?;
    if let Some(estimate) = estimate.as_ref().filter(|_| !args.global.quiet) {
        let text = estimate.as_ref().map_or_else(String::clone, Estimate::text);
        bar.suspend(|| setup::note(&text));
    }
    let estimate = estimate.and_then(std::result::Result::ok);
    let stages = Stages::new(bar.clone(), job.stages()?);
    let maps = std::mem::take(&mut job.maps);
    let count = maps.len();
    let started = std::time::Instant::now();
    let mut all = open(args, &job, maps, georeference.as_ref())?;
    let (times, plan, normals) = compute(gpu, &job, &mut all, &stages)?;
    let hash = job.hash();
    let Job { scene, quality, around, .. } = job;
    let field = &scene.field;
    let mut metadata = setup::metadata(gpu, field, &plan);
    // A plan lists the settings of its part only.
    metadata.retain(|(name, _)| {
        let is_part = ["paths", "seed", "azimuths", "sh_order"].contains(&name.as_str());
        !is_part || used.iter().all(|(known, _)| known != name)
    });
    let is_more = |name: &str| metadata.iter().all(|(known, _)| known != name);
    let more: Vec<_> = used.iter().filter(|(name, _)| is_more(name)).cloned().collect();
    metadata.extend(more);
    let lights = is_light.then_some((&args.scene, scene));
    metadata.extend(setup::asked(&args.input, &args.scene.field, lights));
    metadata.push(("field_hash".into(), hash));
    let whole = finish(all, &normals, &metadata, &stages)?;
    if !args.global.quiet {
        bar.suspend(|| say_notes(&whole));
    }
    // An earlier manifest describes files that are about to be replaced.
    let before = take_manifest(&args.output)?;
    let maps = whole.into_iter().map(MapFiles::place).collect::<Result<Vec<_>>>()?;
    let stages = stages.finish();
    bar.finish_and_clear();
    let seconds = started.elapsed().as_secs_f64();
    // Times are in --json only: two runs write the same folder.
    let mut manifest = json!({ "settings": setup::typed(&metadata) });
    describe(&mut manifest, field, has_horizons.then_some(quality));
    manifest["maps"] = maps.into();
    if traces_directions {
        let vectors = around.vectors().iter();
        manifest["directions"] = vectors.map(|e| json!([e.x, e.y, e.z])).collect();
    }
    files::write_json(&args.output.join(MANIFEST), &manifest)?;
    remove_old(&args.output, before)?;
    if let Some(json) = &args.global.json {
        metadata.push(("seconds".into(), format!("{seconds:.3}")));
        let timed = setup::as_json(&metadata, &times);
        for key in ["settings", "passes"] {
            manifest[key] = timed[key].clone();
        }
        manifest["estimate"] = estimate.map(|estimate| estimate.json(&stages)).into();
        files::write_json(json, &manifest)?;
    }
    if !args.global.quiet {
        say_done(args, (scene, quality, count), (&times, has_horizons, seconds), gpu);
    }
    Ok(Outcome::Done)
}

/// Prints the notes of all maps. A note that applies to several kinds is printed once.
fn say_notes(maps: &[MapFiles]) {
    let mut notes: Vec<(String, Vec<&str>)> = Vec::new();
    for files in maps {
        let kind = files.kind().name;
        for note in files.notes() {
            match notes.iter_mut().find(|(known, _)| *known == note) {
                Some((_, kinds)) => kinds.push(kind),
                None => notes.push((note, vec![kind])),
            }
        }
    }
    for (note, kinds) in notes {
        setup::note(&format!("{}: {note}", kinds.join(", ")));
    }
}

/// Adds what holds for all maps to a manifest.
fn describe(manifest: &mut Value, field: &HeightField, horizons: Option<&Quality>) {
    let hash = manifest["settings"]["field_hash"].clone();
    manifest["field"] = json!({
        "rows": field.rows(), "cols": field.cols(), "cell_m": field.cell_m(), "base_m": field.base_m(),
        "voids": field.voids().map_or(0, |v| v.iter().filter(|v| **v).count()), "hash": hash,
        "hash_is": "64-bit FNV-1a of the text ridgelight field 1, rows and columns (u64), cells (f64), the \
            border (a byte: 0 plane, 1 open, 2 periodic), heights above the base (f32, -0 as 0) \
            and, if the field has voids, a byte per grid point, 1 at voids; little-endian",
        "first_row": "north", "first_column": "west",
    });
    manifest["horizons"] = match horizons.map(|quality| quality.method) {
        None => Value::Null,
        Some(Method::BruteForce) => {
            "every crossing along each azimuth from each grid point: exact but for f32 rounding"
                .into()
        }
        Some(_) => {
            "found by the method in settings, whose error is not part of the files' errors".into()
        }
    };
    manifest["error_is"] = "decoding error of a file: the computed value lies within at_most plus \
        and_of_the_value times the value; the error between azimuths is not included"
        .into();
}

fn say_done(
    args: &BakeArgs,
    (scene, quality, count): (&Scene, &Quality, usize),
    (times, has_horizons, seconds): (&[Timing], bool, f64),
    gpu: &Headless,
) {
    let way = match has_horizons {
        true => format!("{} azimuths", quality.azimuths),
        false => format!("{} directions", args.directions.unwrap_or(request::DIRECTIONS)),
    };
    let gpu_s = setup::total_ns(times) / 1e9;
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
    // Kinds of one table share its rays: list them once.
    let first = job.kinds().position(Kind::is_table);
    let own = job.kinds().enumerate().filter(|(i, kind)| !kind.is_table() || first == Some(*i));
    for (count, what) in own.filter_map(|(_, kind)| kinds::rays(job, kind, &limits)) {
        crate::say!("{count:>14}  {what}");
    }
    Ok(Outcome::Done)
}
