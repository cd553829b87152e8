//! Finishes a plan: places barriers, checks limits.

use super::Plan;
use crate::graph::Limits;
use crate::graph::{
    Builder, Kind, Pass, Resource, ResourceId, bytes_text, moved_forward, place_barriers,
};
use crate::passes::azimuths::Azimuth;
use crate::{Error, Result};

impl Plan {
    /// Makes a plan from the collected resources and passes.
    ///
    /// # Errors
    /// A plan that exceeds the memory budget or the limits of the device.
    pub(super) fn finish(
        builder: Builder,
        size: [u32; 2],
        azimuths: Vec<Azimuth>,
        layer_azimuths: Vec<u32>,
        notes: Vec<String>,
        settings: Vec<(String, String)>,
        limits: &Limits,
    ) -> Result<Plan> {
        let Builder { resources, mut passes, constants, edit_passes, lookups: _ } = builder;
        let all = edit_passes.iter().flatten().chain(&passes);
        for pass in all {
            let binds = pass.shader.bindings.iter().zip(&pass.bindings);
            // Directions that no sweep follows are constants.
            let is_swept = |id: ResourceId| resources[id.0].name != "constants";
            let reads =
                binds.filter(|(b, id)| b.name == "azimuths" && id.is_some_and(is_swept)).count()
                    > 0;
            assert!(
                pass.azimuths.is_empty() != reads && pass.azimuths.end as usize <= azimuths.len(),
                "{}: azimuths {:?} of {}",
                pass.label(),
                pass.azimuths,
                azimuths.len()
            );
        }
        let mut edit_passes = edit_passes.unwrap_or_default();
        if !limits.is_cpu {
            (passes, edit_passes) = (moved_forward(passes), moved_forward(edit_passes));
        }
        place_barriers(&mut passes);
        place_barriers(&mut edit_passes);
        let plan = Plan {
            size,
            resources,
            passes,
            edit_passes,
            azimuths,
            constants,
            layer_azimuths,
            notes,
            settings,
        };
        if plan.bytes() > limits.memory_budget {
            return Err(Error::Limit {
                what: "images and buffers of this picture".into(),
                needs: bytes_text(plan.bytes()),
                limit: format!("{} of `memory_budget`", bytes_text(limits.memory_budget)),
            });
        }
        plan.resources.iter().try_for_each(|resource| check_resource(resource, limits))?;
        plan.passes.iter().try_for_each(|pass| check_groups(pass, limits))?;
        Ok(plan)
    }
}

/// Checks that the device can create a resource.
fn check_resource(resource: &Resource, limits: &Limits) -> Result<()> {
    let beyond = |needs: String, limit: String| {
        let limit = format!("{limit} on this device");
        Err(Error::Limit { what: resource.name.clone(), needs, limit })
    };
    let bytes = match resource.kind {
        Kind::Image { width, height, layers, .. } => {
            let side = width.max(height);
            if side > limits.image_side {
                return beyond(format!("{side} texels a side"), limits.image_side.to_string());
            }
            if layers > limits.image_layers {
                return beyond(format!("{layers} layers"), limits.image_layers.to_string());
            }
            limits.allocation_bytes
        }
        Kind::Buffer { texels: true, bytes } => {
            if bytes / 16 > u64::from(limits.texels) {
                return beyond(format!("{} texels", bytes / 16), limits.texels.to_string());
            }
            limits.allocation_bytes
        }
        Kind::Buffer { .. } => limits.allocation_bytes.min(limits.buffer_bytes),
    };
    if resource.bytes() > bytes {
        return beyond(bytes_text(resource.bytes()), bytes_text(bytes));
    }
    Ok(())
}

/// Checks that the device can dispatch a pass.
fn check_groups(pass: &Pass, limits: &Limits) -> Result<()> {
    match pass.groups.into_iter().find(|groups| *groups > limits.groups) {
        Some(groups) => Err(Error::Limit {
            what: pass.label(),
            needs: format!("{groups} workgroups along an axis"),
            limit: format!("{} on this device", limits.groups),
        }),
        None => Ok(()),
    }
}
