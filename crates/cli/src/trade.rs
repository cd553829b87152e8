//! `trade`: times settings on the device, measures their error against the ground truth, and
//! recommends one from the frontier of both.

mod baked;
mod ground_truth;
mod html;
mod hull;
mod left_out;
mod picture;
mod plot;
mod point;
mod report;
mod rig;
mod same;
mod walk;
mod why;

use std::path::Path;

use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Bounces, Quality};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_trade::trade::{Place, ladders, places, refused, start_for};

use crate::args::TradeArgs;
use crate::render::auto;
use crate::setup::{self, Outcome};
use ground_truth::GroundTruth;
use report::Report;
use rig::{Budget, Rig};
use walk::Walk;

const FILES: [&str; 3] = ["trade.html", "trade.json", "trade.csv"];

pub fn run(args: &TradeArgs) -> Result<Outcome> {
    let goal = auto::goal(args.max_error, args.time_budget)?;
    let budget = budget(args)?;
    check_folder(&args.output)?;
    if let Some(json) = &args.global.json {
        setup::check_output("--json", json, &["json"])?;
    }
    let mut inputs = setup::inputs(&args.input.path, &args.scene);
    inputs.extend(args.reference.as_deref());
    let written = FILES.map(|name| args.output.join(name));
    let mut outputs: Vec<(&str, Option<&Path>)> =
        written.iter().map(|path| ("-o", Some(path.as_path()))).collect();
    outputs.push(("--json", args.global.json.as_deref()));
    setup::check_distinct(&outputs, &inputs)?;
    let field = setup::field(&args.input.path, &args.scene.field, &args.global)?;
    let scene = setup::scene(field, &args.scene, setup::Unlit::Daylight(None), args.global.quiet)?;
    if args.bounces > 0 && args.reference.is_none() {
        let expected = "--reference with as many bounces: only a path-traced reference has them";
        return Err(Error::setting("--bounces", args.bounces.to_string(), expected));
    }
    let bounces = Bounces { count: args.bounces, ..Bounces::default() };
    let start = Quality { bounces, ..start_for(&scene) };
    start.check()?;
    let planned = |limits: &plan::Limits| plan::picture(&scene, &start, limits, Picture::default());
    setup::check_plan(&args.global, planned)?;
    if let Some(path) = args.reference.as_deref().filter(|p| setup::extension(p) != "exr") {
        let expected = "an .exr: other formats clip bright values";
        return Err(Error::setting("--reference", path.display().to_string(), expected));
    }
    let lit = Some((&args.scene, &scene));
    let mut scene_metadata = setup::asked(&args.input, &args.scene.field, lit);
    if args.bounces > 0 {
        scene_metadata.push(("bounces".to_owned(), args.bounces.to_string()));
    }
    let read = |path: &Path| {
        let ground_truth = GroundTruth::read(path, &scene.field)?;
        same::check(path, &scene, &scene_metadata).map(|()| ground_truth)
    };
    let given = args.reference.as_deref().map(read).transpose()?;
    let (gpu, limits) = setup::device(&args.global)?;

    let bar = crate::setup::terminal::progress(args.global.quiet, "computing the ground truth");
    let mut rig = Rig::new(gpu, limits, &scene, budget);
    let ground_truth = given.map_or_else(|| GroundTruth::draw(&mut rig), Ok)?;
    let ground_truth_s = rig.spent();
    bar.set_message("scattering over visible points");
    let baked = baked::measure(&mut rig, &ground_truth, &start)?;
    let mut ladders = ladders(&scene, args.bounces);
    for step in ladders.iter_mut().flat_map(|ladder| &mut ladder.steps) {
        *step = setup::flags_in(step);
    }
    let places = places(&ladders, &start);
    let why = |place: &Place| match rig.plan(&scene, &place.quality) {
        Err(error @ Error::Setting { .. }) => Some(setup::in_flags(error).to_string()),
        _ => None,
    };
    let refused = refused(&ladders, &places, why);
    let mut walk = Walk::new(&ladders, &places, &start, ground_truth.floor());
    for (place, why) in refused {
        walk.give_up(place, why, false);
    }
    let recommended = walk.run(&mut rig, &ground_truth, goal, &bar)?;
    bar.set_message("timing hull storage of the recommended settings");
    let best = &walk.points[recommended.point];
    let draw_s = best.ratio() * walk.baseline_ns() * 1e-9;
    let hulls = hull::places(&mut rig, &places[best.place].quality, draw_s)?;
    bar.finish_and_clear();
    let (field, device) = (&scene.field, rig.gpu.report());
    let about = [
        ("device", device.name.clone()),
        ("driver", device.driver.clone()),
        ("rows", field.rows().to_string()),
        ("cols", field.cols().to_string()),
        ("cell_m", format!("{},{}", field.cell_m()[0], field.cell_m()[1])),
    ];
    let about = about.map(|(name, value)| (name.to_owned(), value)).into_iter();
    let report = Report {
        about: about.chain(scene_metadata).collect(),
        ground_truth_png: picture::light_png(&scene.field, &ground_truth.planes, &ground_truth)?,
        ground_truth,
        ground_truth_s,
        hulls,
        baked,
        walk,
        goal,
        recommended,
        budget,
        spent_s: rig.spent(),
    };
    write(args, &report)?;
    if !args.global.quiet {
        setup::say_light(&args.scene.lights, &scene, None);
        report.print();
        crate::say!("{}", args.output.join(FILES[0]).display());
    }
    Ok(if recommended.holds { Outcome::Done } else { Outcome::Beyond })
}

fn budget(args: &TradeArgs) -> Result<Budget> {
    if let Some(evaluations) = args.evaluations {
        return Ok(Budget::Evaluations(evaluations as usize));
    }
    if !(args.budget.is_finite() && (1.0..=1e6).contains(&args.budget)) {
        let found = args.budget.to_string();
        return Err(Error::setting("--budget", found, "1 to 1000000 seconds"));
    }
    Ok(Budget::Seconds(args.budget))
}

/// Checks the output folder: missing, empty, or with an earlier report.
fn check_folder(path: &Path) -> Result<()> {
    let shown = || path.display().to_string();
    if !path.is_dir() {
        return crate::bake::check_new(path);
    }
    let wrong = |source| Error::io(path, source);
    for entry in std::fs::read_dir(path).map_err(wrong)? {
        let name = entry.map_err(wrong)?.file_name();
        if !FILES.iter().any(|f| name == *f) {
            let found = format!("{} with {} in it", shown(), name.to_string_lossy());
            let expected = "a folder that is missing, empty or holds an earlier report";
            return Err(Error::setting("-o", found, expected));
        }
    }
    files::check_writable(&path.join(FILES[0]))
}

fn write(args: &TradeArgs, report: &Report) -> Result<()> {
    let (json, csv, page) = (report.json(), report.csv(), html::page(report));
    if let Err(source) = std::fs::create_dir(&args.output)
        && source.kind() != std::io::ErrorKind::AlreadyExists
    {
        return Err(Error::io(&args.output, source));
    }
    files::write_text(&args.output.join(FILES[2]), &csv)?;
    files::write_json(&args.output.join(FILES[1]), &json)?;
    files::write_text(&args.output.join(FILES[0]), &page)?;
    match &args.global.json {
        Some(path) => files::write_json(path, &json),
        None => Ok(()),
    }
}
