//! Scene and quality to passes: pure, without a Vulkan call. What is decided here is all that is
//! ever recorded; [`Plan`] prints it.

pub mod azimuths;
mod batch;
mod blocks;
mod bounce_nodes;
mod bounces;
mod builder;
mod change;
mod choice;
mod edit;
pub(crate) mod glossy;
mod horizons;
mod limits;
mod map;
mod nodes;
mod pass;
mod picture;
mod print;
pub mod pyramid;
mod reference;
mod resource;
pub(crate) mod sh;
mod shining;
pub(crate) mod sphere_sh;
mod spheres;
pub mod sweep;
mod sweeping;
mod view;

pub use azimuths::Azimuth;
pub use batch::{Axis, Batch};
pub(crate) use blocks::Blocks;
pub(crate) use bounce_nodes::BounceNodes;
pub(crate) use bounces::Bounce;
pub(crate) use builder::Builder;
pub use edit::{Reach, Rectangle};
pub use horizons::horizons;
pub use limits::Limits;
pub use map::{Map, map};
pub use nodes::Nodes;
pub use pass::{Pass, ResourceId, missing_barriers};
pub use picture::{Picture, picture, picture_inputs};
pub use reference::{REFERENCE_BATCH, reference, reference_inputs, unmet_error};
pub use resource::{Format, Kind, Owner, Resource};
pub(crate) use spheres::samples_within;
pub use sweeping::circle_rad;
pub use view::{View, ViewOptions, surface_error_m};

/// The passes that light one scene, in order, and everything that they touch.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Columns and rows of the field.
    pub size: [u32; 2],
    /// Images and buffers.
    pub resources: Vec<Resource>,
    /// Dispatches, in order.
    pub passes: Vec<Pass>,
    /// Dispatches, in order, that follow an edit of a rectangle of heights, with the barriers among
    /// them; none where edits need all passes ([`Picture::keeps_horizons`]).
    pub edit_passes: Vec<Pass>,
    /// Contents of the buffer "azimuths".
    pub azimuths: Vec<Azimuth>,
    /// Contents of the buffer "constants", four f32 a texel; none without spherical harmonics.
    pub constants: Vec<f32>,
    /// For horizons: which azimuth k of the circle each layer of the outputs is.
    pub layer_azimuths: Vec<u32>,
    /// What was left out or changed, and why.
    pub notes: Vec<String>,
    /// The settings really used, as (name, value).
    pub settings: Vec<(String, String)>,
}

impl Plan {
    /// Bytes of all internal images and buffers.
    pub fn internal_bytes(&self) -> u64 {
        self.resources.iter().filter(|r| r.owner == Owner::Internal).map(Resource::bytes).sum()
    }

    /// Bytes of everything, inputs and outputs too: what counts against the memory budget.
    pub fn bytes(&self) -> u64 {
        self.resources.iter().map(Resource::bytes).sum()
    }

    /// Passes of a whole recording, then those of an edit.
    pub(crate) fn every_pass(&self) -> impl Iterator<Item = &Pass> {
        self.passes.iter().chain(&self.edit_passes)
    }

    /// The resource of this name.
    pub fn find(&self, name: &str) -> Option<ResourceId> {
        self.resources.iter().position(|r| r.name == name).map(ResourceId)
    }

    /// Names of the images that a caller hands in, in the order of the inputs.
    pub fn inputs(&self) -> impl Iterator<Item = (ResourceId, &Resource)> {
        self.owned(Owner::Input)
    }

    /// The images that a caller has written to, in the order of the outputs.
    pub fn outputs(&self) -> impl Iterator<Item = (ResourceId, &Resource)> {
        self.owned(Owner::Output)
    }

    fn owned(&self, owner: Owner) -> impl Iterator<Item = (ResourceId, &Resource)> {
        let all = self.resources.iter().enumerate();
        all.filter(move |(_, r)| r.owner == owner).map(|(i, r)| (ResourceId(i), r))
    }
}
