//! Finishes a plan: places barriers, checks limits.

use super::Plan;
use crate::graph::Limits;
use crate::graph::{
    Builder, Kind, Pass, Resource, ResourceId, bytes_text, moved_earlier, place_barriers,
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
            (passes, edit_passes) = (moved_earlier(passes), moved_earlier(edit_passes));
        }
        place_barriers(&mut passes);
        place_barriers(&mut edit_passes);
        let plan =
            Plan { size, resources, passes, edit_passes, azimuths, constants, notes, settings };
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

#[cfg(test)]
mod tests {
    use crate::graph::{Limits, Pass, moved_earlier};
    use crate::plan::{self, Picture};
    use crate::scene::{Bounces, Lights, Quality, Scene, Sun, Surface, fractal};

    fn conflict(a: &Pass, b: &Pass) -> bool {
        let touches = |p: &Pass, id| p.bindings.contains(&Some(id));
        a.writes().any(|w| touches(b, w)) || b.writes().any(|w| touches(a, w))
    }

    /// Passes that move keep the order of every pair with a hazard, and need fewer barriers.
    #[test]
    fn moved_passes_keep_the_order_of_hazards() {
        let sun = |azimuth_rad| Sun {
            azimuth_rad,
            elevation_rad: 0.4,
            diameter_rad: 0.02,
            irradiance: [1.0; 3],
        };
        let lights =
            Lights { sky: Some([1.0; 3]), suns: vec![sun(0.8), sun(2.4)], ..Lights::default() };
        let field = fractal(64, 1).unwrap();
        let scene = Scene { field, surface: Surface::default(), lights };
        let bounces = Bounces { count: 2, azimuths: 8, ..Bounces::default() };
        let limits = Limits::lavapipe();
        let kept = Picture { keeps_horizons: true, ..Picture::default() };
        let base = Quality { azimuths: 16, ..Quality::default() };
        let mut moved_any = false;
        for (quality, wanted) in [(Quality { bounces, ..base }, Picture::default()), (base, kept)] {
            let plan = plan::picture(&scene, &quality, &limits, wanted).unwrap();
            for passes in [plan.passes, plan.edit_passes] {
                let moved = moved_earlier(passes.clone());
                let place = |pass: &Pass| {
                    moved.iter().position(|m| m.label() == pass.label() && m.push == pass.push)
                };
                let places: Vec<usize> = passes.iter().map(|p| place(p).unwrap()).collect();
                moved_any |= !places.is_sorted();
                for later in 0..passes.len() {
                    for earlier in 0..later {
                        if conflict(&passes[earlier], &passes[later]) {
                            assert!(places[earlier] < places[later]);
                        }
                    }
                }
            }
        }
        assert!(moved_any);
    }
}
