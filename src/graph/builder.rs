use crate::graph::shaders::{Specialise, Specialised};
use crate::graph::{Format, Kind, Owner, Pass, Resource, ResourceId};

/// Collects the resources and passes of a plan.
pub(crate) struct Builder {
    pub(crate) resources: Vec<Resource>,
    pub(crate) passes: Vec<Pass>,
    /// Contents of the buffer "constants".
    pub(crate) constants: Vec<f32>,
    /// Passes of an edit; `None` before [`begin_edits`](Self::begin_edits).
    pub(crate) edit_passes: Option<Vec<Pass>>,
}

impl Builder {
    pub(crate) fn new() -> Self {
        Self { resources: Vec::new(), passes: Vec::new(), constants: Vec::new(), edit_passes: None }
    }

    /// Passes added from here on are those of an edit.
    pub(crate) fn begin_edits(&mut self) {
        self.edit_passes = Some(Vec::new());
    }

    pub(crate) fn image(
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

    pub(crate) fn buffer(&mut self, name: &str, bytes: u64, texels: bool) -> ResourceId {
        self.resources.push(Resource {
            name: name.into(),
            kind: Kind::Buffer { bytes, texels },
            owner: Owner::Internal,
        });
        ResourceId(self.resources.len() - 1)
    }

    /// Adds a dispatch of a shader with its constants. `bound` names the bound resources; other bindings are unused.
    #[expect(clippy::too_many_arguments, reason = "a pass is all of this")]
    pub(crate) fn pass<S: Specialise>(
        &mut self,
        of: S,
        part: &str,
        why: impl Into<String>,
        groups: [u32; 3],
        push: &S::Push,
        bound: &[(&str, ResourceId)],
        bytes: u64,
        texels: u64,
    ) -> &mut Pass {
        let Specialised { shader, constants } = of.into();
        let push = bytemuck::bytes_of(push).to_vec();
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
            texels,
            reach: None,
            indirect: None,
            barrier_before: false,
        });
        passes.last_mut().expect("pushed above")
    }

    /// Appends texels to the buffer "constants", which the host fills; returns the buffer and the first texel.
    pub(crate) fn constants(&mut self, more: &[f32]) -> (ResourceId, usize) {
        let first = self.constants.len() / 4;
        self.constants.extend(more);
        let size = size_of_val(self.constants.as_slice()) as u64;
        let Some(i) = self.resources.iter().position(|r| r.name == "constants") else {
            return (self.buffer("constants", size, true), first);
        };
        self.resources[i].kind = Kind::Buffer { bytes: size, texels: true };
        (ResourceId(i), first)
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.resources.iter().map(Resource::bytes).sum()
    }

    pub(crate) fn bytes_of(&self, id: ResourceId) -> u64 {
        self.resources[id.0].bytes()
    }
}
