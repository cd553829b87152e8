use super::azimuths::Azimuth;
use super::batch::bytes_text;
use super::pass::place_barriers;
use super::{Format, Kind, Limits, Owner, Pass, Plan, Resource, ResourceId};
use crate::gpu::shaders::Specialised;
use crate::{Error, Result};

/// Collects a plan.
pub(crate) struct Builder {
    resources: Vec<Resource>,
    passes: Vec<Pass>,
    /// Contents of the buffer "constants".
    pub(super) constants: Vec<f32>,
    /// Of an edit; none until [`edits`](Self::edits).
    edit_passes: Option<Vec<Pass>>,
}

impl Builder {
    pub(super) fn new() -> Self {
        Self { resources: Vec::new(), passes: Vec::new(), constants: Vec::new(), edit_passes: None }
    }

    /// From here on, passes are those of an edit.
    pub(super) fn begin_edits(&mut self) {
        self.edit_passes = Some(Vec::new());
    }

    pub(super) fn image(
        &mut self,
        name: impl Into<String>,
        owner: Owner,
        format: Format,
        [width, height, layers]: [u32; 3],
        layered: bool,
    ) -> ResourceId {
        self.resources.push(Resource {
            name: name.into(),
            kind: Kind::Image { format, width, height, layers, layered },
            owner,
        });
        ResourceId(self.resources.len() - 1)
    }

    pub(super) fn buffer(&mut self, name: &str, bytes: u64, texels: bool) -> ResourceId {
        self.resources.push(Resource {
            name: name.into(),
            kind: Kind::Buffer { bytes, texels },
            owner: Owner::Internal,
        });
        ResourceId(self.resources.len() - 1)
    }

    /// Adds a dispatch of a shader with its constants; `bound` names its bindings, all others are unused.
    #[expect(clippy::too_many_arguments, reason = "a pass is all of this")]
    pub(crate) fn pass<P: bytemuck::Pod>(
        &mut self,
        of: impl Into<Specialised>,
        part: &str,
        why: impl Into<String>,
        groups: [u32; 3],
        push: &P,
        bound: &[(&str, ResourceId)],
        bytes: u64,
        samples: u64,
    ) -> &mut Pass {
        let Specialised { shader, constants } = of.into();
        let push = bytemuck::bytes_of(push).to_vec();
        assert_eq!(push.len(), shader.push_bytes as usize, "{}: push constants", shader.name);
        for (name, id) in bound {
            let binding = shader.bindings.iter().find(|b| b.name == *name);
            let binding = binding.unwrap_or_else(|| panic!("{} binds no {name}", shader.name));
            let resource = &self.resources[id.0];
            assert!(
                resource.fits(binding.kind),
                "{}: {} is no {:?}",
                shader.name,
                resource.name,
                binding.kind
            );
        }
        let bindings = shader
            .bindings
            .iter()
            .map(|b| bound.iter().find(|(name, _)| b.name == *name).map(|(_, id)| *id))
            .collect();
        let passes = self.edit_passes.as_mut().unwrap_or(&mut self.passes);
        passes.push(Pass {
            shader,
            part: part.to_owned(),
            why: why.into(),
            groups,
            constants,
            push,
            bindings,
            azimuths: 0..0,
            bytes,
            samples,
            reach: None,
            indirect: None,
            barrier_before: false,
        });
        passes.last_mut().expect("pushed above")
    }

    /// Adds texels to the buffer that the host fills with constants; where they begin.
    pub(super) fn constants(&mut self, more: &[f32]) -> (ResourceId, usize) {
        let first = self.constants.len() / 4;
        self.constants.extend(more);
        let size = size_of_val(self.constants.as_slice()) as u64;
        let Some(i) = self.resources.iter().position(|r| r.name == "constants") else {
            return (self.buffer("constants", size, true), first);
        };
        self.resources[i].kind = Kind::Buffer { bytes: size, texels: true };
        (ResourceId(i), first)
    }

    pub(super) fn bytes(&self) -> u64 {
        self.resources.iter().map(Resource::bytes).sum()
    }

    pub(super) fn bytes_of(&self, id: ResourceId) -> u64 {
        self.resources[id.0].bytes()
    }
}

impl Plan {
    /// What was collected as a plan, with its barriers; `notes` and `settings` are its own.
    ///
    /// # Errors
    /// More memory than the budget or the device has.
    pub(super) fn finish(
        builder: Builder,
        size: [u32; 2],
        azimuths: Vec<Azimuth>,
        layer_azimuths: Vec<u32>,
        notes: Vec<String>,
        settings: Vec<(String, String)>,
        limits: &Limits,
    ) -> Result<Plan> {
        let Builder { resources, mut passes, constants, edit_passes } = builder;
        let all = edit_passes.iter().flatten().chain(&passes);
        for pass in all {
            let binds = pass.shader.bindings.iter().zip(&pass.bindings);
            let reads = binds.filter(|(b, id)| b.name == "azimuths" && id.is_some()).count() > 0;
            assert!(
                pass.azimuths.is_empty() != reads && pass.azimuths.end as usize <= azimuths.len(),
                "{}: azimuths {:?} of {}",
                pass.label(),
                pass.azimuths,
                azimuths.len()
            );
        }
        let mut edit_passes = edit_passes.unwrap_or_default();
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
                limit: format!("{} of --memory-budget", bytes_text(limits.memory_budget)),
            });
        }
        plan.resources.iter().try_for_each(|resource| check_resource(resource, limits))?;
        plan.passes.iter().try_for_each(|pass| check_groups(pass, limits))?;
        Ok(plan)
    }
}

/// Whether the device can make a resource.
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

/// Whether the device can dispatch a pass.
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
