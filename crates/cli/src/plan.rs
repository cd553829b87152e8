//! `plan` and `devices`: what would run, and on which device.

pub mod info;
mod start;

use ridgelight::Result;
use ridgelight::gpu;
use ridgelight::plan::{self, Limits, Picture, Plan, View};

use crate::args::{DevicesArgs, GlobalArgs, PlanArgs, PlanFormat};
use crate::idle;
use crate::render::camera;
use crate::setup::{self, Outcome, tuned};

pub fn run(args: &PlanArgs) -> Result<Outcome> {
    let inputs = setup::inputs(&args.input.path, &args.scene);
    setup::check_outputs(&[("--json", args.global.json.as_deref(), &["json"])], &inputs)?;
    let mut quality = args.quality.quality()?;
    let field = setup::field(&args.input.path, &args.scene.field, &args.global)?;
    let scene = setup::scene(
        field,
        &args.scene,
        setup::Unlit::of(&quality, args.camera.eye.compass_deg()),
        args.global.quiet,
    )?;
    let camera_view = camera::requested(&args.camera, &scene, false)?;
    let (name, limits) = limits(&args.global)?;
    let eye_m = camera_view.as_ref().map(|view| view.eye_m(&scene.field));
    setup::suit(&mut quality, &args.quality, (&scene, eye_m));
    let wanted = Picture { eye_m, ..setup::wanted(&[]) };
    let plan = plan::picture(&scene, &quality, &limits, wanted)?;
    let view = match &camera_view {
        Some(camera_view) => {
            let mut view = camera_view.view(&scene, &plan, &limits)?;
            view.settings = camera_view.settings(&view, &scene.field);
            Some(view)
        }
        None => None,
    };
    idle::say(args.global.quiet, &args.quality.written, &plan.settings);
    match args.format {
        _ if args.global.quiet => {}
        PlanFormat::Text => {
            crate::say!("Plan for {name}");
            crate::say!("{}", plan.to_string().trim_end());
            if let Some(view) = &view {
                crate::say!("\n{}", view.to_string().trim_end());
            }
            setup::say_light(&args.scene.lights, &scene, None);
            setup::say_azimuths(&quality, &args.quality);
        }
        PlanFormat::Json => crate::say!("{:#}", json(&plan, view.as_ref())),
        PlanFormat::Dot => crate::say!("{}", dot(&plan, view.as_ref()).trim_end()),
    }
    if let Some(path) = &args.global.json {
        ridgelight_io::write_json(path, &json(&plan, view.as_ref()))?;
    }
    Ok(Outcome::Done)
}

/// `devices`: the Vulkan devices, their limits, and what they lack.
pub fn devices(args: &DevicesArgs) -> Result<Outcome> {
    setup::check_outputs(&[("--json", args.json.as_deref(), &["json"])], &[])?;
    let all = gpu::devices()?;
    if all.is_empty() {
        crate::say!("no device: the Vulkan loader works, but it finds no driver");
    }
    for (i, device) in all.iter().enumerate() {
        crate::say!(
            "{i}  {}  ({}, Vulkan {}, {})",
            device.name,
            device.kind,
            device.api,
            device.driver
        );
        let limits = &device.limits;
        crate::say!(
            "   images to {} texels and {} layers, storage buffers to {} MiB, allocations to {} MiB, workgroups to {} invocations and {} KiB",
            limits.image_side,
            limits.image_layers,
            limits.buffer_bytes >> 20,
            limits.allocation_bytes >> 20,
            limits.group_invocations,
            limits.shared_bytes >> 10
        );
        let timestamps = match device.timestamp_period_ns {
            0.0 => "no timestamps".to_owned(),
            period => format!("timestamps of {period} ns"),
        };
        crate::say!("   subgroups of {}, {timestamps}", device.subgroup_size);
        match device.missing.as_slice() {
            [] => crate::say!("   suitable"),
            missing => crate::say!("   not suitable, missing: {}", missing.join(", ")),
        }
    }
    if let Some(path) = &args.json {
        let rows: Vec<_> = all
            .iter()
            .map(|d| {
                serde_json::json!({
                    "name": d.name, "driver": d.driver, "api": d.api, "kind": d.kind, "missing": d.missing,
                    "subgroup_size": d.subgroup_size, "timestamp_period_ns": d.timestamp_period_ns,
                    "image_side": d.limits.image_side, "image_layers": d.limits.image_layers,
                    "buffer_bytes": d.limits.buffer_bytes, "allocation_bytes": d.limits.allocation_bytes,
                    "shared_bytes": d.limits.shared_bytes, "group_invocations": d.limits.group_invocations,
                })
            })
            .collect();
        ridgelight_io::write_json(path, &rows.into())?;
    }
    Ok(Outcome::Done)
}

/// The device that would run the plan and its limits; without a device, those of the software
/// driver lavapipe.
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
    let budget = global.memory_budget;
    let Some(report) = report else {
        let lavapipe = Limits::lavapipe();
        let memory_budget = budget.unwrap_or(lavapipe.memory_budget);
        return Ok(("lavapipe (no device here)".into(), Limits { memory_budget, ..lavapipe }));
    };
    let limits = tuned::limits(&report, budget);
    Ok((report.name, limits))
}

fn json(plan: &Plan, view: Option<&View>) -> serde_json::Value {
    let name = |id: &plan::ResourceId| plan.resources[id.0].name.clone();
    let mut passes: Vec<_> = plan
        .passes
        .iter()
        .map(|p| {
            serde_json::json!({
                "pass": p.name(), "part": p.part, "why": p.why, "groups": p.groups, "bytes": p.bytes,
                "texels": p.texels, "barrier_before": p.barrier_before,
                "reads": p.reads().map(|r| name(&r)).collect::<Vec<_>>(),
                "writes": p.writes().map(|r| name(&r)).collect::<Vec<_>>(),
            })
        })
        .collect();
    let whose = |owner: plan::Owner| format!("{owner:?}").to_lowercase();
    let mut resources: Vec<_> = plan
        .resources
        .iter()
        .map(|r| serde_json::json!({ "name": r.name, "owner": whose(r.owner), "bytes": r.bytes() }))
        .collect();
    let (mut settings, mut notes) = (plan.settings.clone(), plan.notes.clone());
    let mut bytes = plan.bytes();
    if let Some(view) = view {
        // Each waits for the one before: they draw into the same images.
        passes.extend(view.passes(false).into_iter().map(|d| {
            serde_json::json!({
                "pass": d.pass, "part": "", "why": d.why, "vertices": d.vertices, "bytes": d.bytes,
                "texels": u64::from(view.size[0]) * u64::from(view.size[1]), "barrier_before": true,
                "reads": d.reads, "writes": d.writes,
            })
        }));
        let memory = view.memory(false);
        bytes += memory.iter().map(|d| d.bytes).sum::<u64>();
        resources.extend(memory.into_iter().map(
            |d| serde_json::json!({ "name": d.name, "owner": whose(d.owner), "bytes": d.bytes }),
        ));
        settings.extend(view.settings.clone());
        notes.push(view.tone_note());
    }
    serde_json::json!({
        "size": plan.size, "settings": setup::typed(&settings), "passes": passes,
        "resources": resources, "bytes": bytes, "notes": notes,
    })
}

fn dot(plan: &Plan, view: Option<&View>) -> String {
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
    let Some(view) = view else { return text + "}\n" };
    let mut names: Vec<&str> = plan.resources.iter().map(|r| r.name.as_str()).collect();
    for drawn in view.memory(false) {
        text += &format!("  r{} [label=\"{}\", shape=box];\n", names.len(), drawn.name);
        names.push(drawn.name);
    }
    let node = |name: &str| names.iter().position(|n| *n == name);
    for (i, draw) in (plan.passes.len()..).zip(view.passes(false)) {
        text += &format!("  p{i} [label=\"{}\", shape=ellipse, style=filled];\n", draw.pass);
        for r in draw.reads.iter().filter_map(|name| node(name)) {
            text += &format!("  r{r} -> p{i};\n");
        }
        for w in draw.writes.iter().filter_map(|name| node(name)) {
            text += &format!("  p{i} -> r{w};\n");
        }
    }
    text + "}\n"
}
