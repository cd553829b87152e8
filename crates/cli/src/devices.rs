use ridgelight::Result;
use ridgelight::gpu;
use ridgelight_io as files;

use crate::args::DevicesArgs;
use crate::setup::{self, Outcome};

pub fn run(args: &DevicesArgs) -> Result<Outcome> {
    if let Some(path) = &args.json {
        setup::check_output("--json", path, &["json"])?;
    }
    let all = gpu::devices()?;
    if all.is_empty() {
        crate::say!("no device: the Vulkan loader is there, but no driver answers");
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
            "   images to {} texels and {} layers, storage buffers to {} MiB, allocations to {} MiB, shared memory {} KiB",
            limits.image_side,
            limits.image_layers,
            limits.buffer_bytes >> 20,
            limits.allocation_bytes >> 20,
            limits.shared_bytes >> 10
        );
        let timestamps = match device.timestamp_period_ns {
            0.0 => "no timestamps".to_owned(),
            period => format!("timestamps of {period} ns"),
        };
        crate::say!("   subgroups of {}, {timestamps}", device.subgroup_size);
        match device.missing.as_slice() {
            [] => crate::say!("   will do"),
            missing => crate::say!("   will not do, for want of: {}", missing.join(", ")),
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
                    "shared_bytes": d.limits.shared_bytes,
                })
            })
            .collect();
        files::write_json(path, &rows.into())?;
    }
    Ok(Outcome::Done)
}
