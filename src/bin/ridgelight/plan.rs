use ridgelight::Result;
use ridgelight::gpu;
use ridgelight::plan::{self, Limits, Plan};

use crate::args::{GlobalArgs, PlanArgs, PlanFormat};
use crate::idle;
use crate::setup::{self, Outcome};

pub fn run(args: &PlanArgs) -> Result<Outcome> {
    if let Some(json) = &args.global.json {
        setup::check_output("--json", json, &["json"])?;
        let inputs = setup::inputs(&args.input.path, &args.lights, &args.surface);
        setup::check_distinct(&[("--json", Some(json))], &inputs)?;
    }
    let quality = setup::quality(&args.quality)?;
    let field = setup::field(&args.input.path, &args.surface.field, &args.global)?;
    let scene = setup::scene(field, &args.surface, &args.lights)?;
    let (name, limits) = limits(&args.global)?;
    let plan = plan::picture(&scene, &quality, &limits, setup::wanted(&[]))?;
    idle::say(args.global.quiet, &args.quality.written, &plan.settings);
    match args.format {
        _ if args.global.quiet => {}
        PlanFormat::Text => {
            crate::say!("for {name}");
            crate::say!("{}", plan.to_string().trim_end());
        }
        PlanFormat::Json => crate::say!("{:#}", json(&plan)),
        PlanFormat::Dot => crate::say!("{}", dot(&plan).trim_end()),
    }
    if let Some(path) = &args.global.json {
        ridgelight::files::write_json(path, &json(&plan))?;
    }
    Ok(Outcome::Done)
}

/// The device that would run it and its limits; without one, those of the software driver everyone has.
pub fn limits(global: &GlobalArgs) -> Result<(String, Limits)> {
    let devices = gpu::devices();
    let report = match &global.device {
        Some(wanted) => {
            let devices = devices?;
            let index = gpu::choose(&devices, Some(wanted))?;
            devices.into_iter().nth(index)
        }
        None => {
            let devices = devices.unwrap_or_default();
            let index = gpu::choose(&devices, None).ok();
            index.and_then(|index| devices.into_iter().nth(index))
        }
    };
    let mut limits = report.as_ref().map_or_else(Limits::lavapipe, |r| r.limits);
    if let Some(budget) = global.memory_budget {
        limits.memory_budget = budget;
    }
    let name = report.map_or("lavapipe (no device here)".into(), |r| r.name);
    Ok((name, limits))
}

fn json(plan: &Plan) -> serde_json::Value {
    let name = |id: &plan::ResourceId| plan.resources[id.0].name.clone();
    let passes: Vec<_> = plan
        .passes
        .iter()
        .map(|p| {
            serde_json::json!({
                "pass": p.name(), "part": p.part, "why": p.why, "groups": p.groups, "bytes": p.bytes,
                "samples": p.samples, "barrier_before": p.barrier_before,
                "reads": p.reads().map(|r| name(&r)).collect::<Vec<_>>(),
                "writes": p.writes().map(|r| name(&r)).collect::<Vec<_>>(),
            })
        })
        .collect();
    let resources: Vec<_> = plan
        .resources
        .iter()
        .map(|r| serde_json::json!({ "name": r.name, "owner": format!("{:?}", r.owner).to_lowercase(), "bytes": r.bytes() }))
        .collect();
    let settings = setup::typed(&plan.settings);
    serde_json::json!({
        "size": plan.size, "settings": settings, "passes": passes, "resources": resources,
        "bytes": plan.bytes(), "notes": plan.notes,
    })
}

fn dot(plan: &Plan) -> String {
    let mut text =
        String::from("digraph plan {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n");
    for (i, resource) in plan.resources.iter().enumerate() {
        text += &format!("  r{i} [label=\"{}\", shape=box];\n", resource.name);
    }
    for (i, pass) in plan.passes.iter().enumerate() {
        text += &format!("  p{i} [label=\"{}\", shape=ellipse, style=filled];\n", pass.label());
        for r in pass.reads() {
            text += &format!("  r{} -> p{i};\n", r.0);
        }
        for w in pass.writes() {
            text += &format!("  p{i} -> r{};\n", w.0);
        }
    }
    text + "}\n"
}
