use std::ops::Range;

use crate::graph::shaders::{Specialise, Specialised};
use crate::graph::{Format, Kind, Limits, Owner, Pass, Resource, ResourceId};

/// Part of a dispatch.
#[derive(Clone)]
pub(crate) struct Part {
    /// Azimuths, or slices of a sphere light.
    pub azimuths: Range<u32>,
    /// Rows of invocations.
    pub rows: Range<u32>,
}

impl Part {
    /// The label of this part's dispatch: `of`, then its azimuths (called `name`, counted from the first of `all`) and its rows,
    /// each only if the part lacks some.
    pub(crate) fn label(&self, of: &str, name: &str, all: &Range<u32>, height: u32) -> String {
        let mut label = of.to_owned();
        let Self { azimuths, rows } = self;
        if azimuths != all {
            let [from, to] = [azimuths.start, azimuths.end].map(|k| k - all.start);
            label += &format!(" {name} {from}..{to}");
        }
        if *rows != (0..height) {
            label += &format!(" rows {}..{}", rows.start, rows.end);
        }
        label.trim().to_owned()
    }
}

/// Collects the resources and passes of a plan.
pub(crate) struct Builder {
    pub(crate) resources: Vec<Resource>,
    pub(crate) passes: Vec<Pass>,
    /// Contents of the buffer "constants".
    pub(crate) constants: Vec<f32>,
    /// Passes of an edit; `None` before [`begin_edits`](Self::begin_edits).
    pub(crate) edit_passes: Option<Vec<Pass>>,
    /// [`Limits::lookups`].
    pub(crate) lookups: u64,
}

impl Builder {
    pub(crate) fn new(limits: &Limits) -> Self {
        Self {
            resources: Vec::new(),
            passes: Vec::new(),
            constants: Vec::new(),
            edit_passes: None,
            lookups: limits.lookups,
        }
    }

    /// Cuts a dispatch into parts. Each has at most `at_once` azimuths (or slices) and at most [`Limits::lookups`] lookups; the
    /// smallest part is eight rows of one azimuth. Every invocation takes `each` lookups per azimuth.
    pub(crate) fn parts(
        &self,
        azimuths: Range<u32>,
        [width, height]: [u32; 2],
        each: u64,
        at_once: u32,
    ) -> Vec<Part> {
        let of_row = (u64::from(width) * each).max(1);
        let of_azimuth = (of_row * u64::from(height)).max(1);
        let at_once = u64::from(at_once.min(azimuths.len() as u32)).max(1);
        let at_once = (self.lookups / of_azimuth).clamp(1, at_once) as u32;
        // Whole workgroups.
        let at_once_rows = (self.lookups / of_row) / 8 * 8;
        let at_once_rows = at_once_rows.clamp(8, u64::from(height.max(8))) as u32;
        let mut parts = Vec::new();
        for first in azimuths.clone().step_by(at_once as usize) {
            for row in (0..height).step_by(at_once_rows as usize) {
                parts.push(Part {
                    azimuths: first..azimuths.end.min(first + at_once),
                    rows: row..height.min(row + at_once_rows),
                });
            }
        }
        parts
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
