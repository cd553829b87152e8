//! Plans: from scene and quality to passes, without a Vulkan call. A renderer records exactly what the plan states.
//! [`Plan`] prints it.
//!
//! | function | result of its passes |
//! |---|---|
//! | [`picture()`] | exit radiance of every texel; optionally a layer for each light and bounce ([`Picture`]) |
//! | [`horizons()`] | horizon elevations of every texel along every azimuth |
//! | [`reference()`] | the path-traced reference, slowly, with its standard error |
//! | [`shadow_heights()`] | shadow heights of a sun at each grid point |
//! | [`map()`] | the lit field from above, tone mapped |
//! | [`preview()`] | the light of a coarse grid on the slopes of a fine one |
//! | [`device_peak()`] | peak rates of the device, by their times |
//! | [`View::new`] | a camera view of the lit field; graphics passes of [`ViewRenderer`](crate::gpu::ViewRenderer) |
//!
//! Each takes [`Limits`], of a device ([`gpu::limits`](crate::gpu::limits)) or fixed ones:
//!
//! ```
//! use ridgelight::plan::{self, Limits, Picture};
//! use ridgelight::scene::{HeightField, Lights, Quality, Scene, Surface};
//!
//! let field = HeightField::new(64, 64, &[0.0; 64 * 64], [1.0, 1.0], None)?;
//! let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
//! let scene = Scene { field, surface: Surface::default(), lights };
//! let plan = plan::picture(&scene, &Quality::default(), &Limits::lavapipe(), Picture::default())?;
//! println!("{plan}"); // passes with groups, traffic and reasons; images and buffers with bytes
//! for pass in &plan.passes {
//!     println!("{}: {}", pass.label(), pass.why);
//! }
//! let [inputs, outputs] =
//!     [plan.inputs().count(), plan.outputs().count()];
//! assert_eq!((inputs, outputs), (1, 1)); // "heights" in, "radiance" out
//! # Ok::<(), ridgelight::Error>(())
//! ```
//!
//! After a change of the scene, make a new plan. [`Plan::passes_after`] lists the passes that a frame then needs, and
//! [`Renderer::replace_plan`](crate::gpu::Renderer::replace_plan) switches to it if images and passes are the same.
//! After an edit of a rectangle of heights, [`Plan::edit_passes`] suffice.

mod active_lights;
mod bake;
mod change;
mod device_peak;
mod difference;
mod finish;
mod horizons;
mod map;
mod picture;
mod preview;
mod print;
mod reference;
mod shadow_heights;
mod view;

pub use bake::{
    curved_ellipses, ellipses, facet_mask, scatter, scatter_inputs, scatter_views, views_at_once,
    visible_points,
};
pub use device_peak::device_peak;
pub use horizons::horizons;
pub use map::map;
pub use picture::{Picture, picture, picture_inputs};
pub use preview::preview;
#[doc(hidden)]
pub use reference::choice::max_path_light;
pub use reference::{
    REFERENCE_BATCH, listed_places, reference, reference_at, reference_in_bands, reference_inputs,
    unsampled_light_error,
};
pub use shadow_heights::shadow_heights;
pub use view::{View, ViewOptions, ViewPass, ViewResource, mesh_error_m};

pub use crate::graph::{
    Axis, Format, Kind, Limits, Owner, Pass, Reach, Rectangle, Resource, ResourceId, SweepForm,
    missing_barriers,
};
pub use crate::passes::azimuths::{self, Azimuth};
pub use crate::passes::batch::Batch;
pub use crate::passes::facet_mask::DIRECTIONS_A_WORD;
pub use crate::passes::map_draw::Map;
pub use crate::passes::nodes::Nodes;
pub use crate::passes::sh_layout::lowest_rad;
pub use crate::passes::sweeping::circle_rad;
pub use crate::passes::{pyramid, sweep};

use crate::{Error, Result};

/// The passes of one scene, in order, with all their resources.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Columns and rows of the field.
    pub size: [u32; 2],
    /// Images and buffers.
    pub resources: Vec<Resource>,
    /// Dispatches, in order.
    pub passes: Vec<Pass>,
    /// Dispatches, in order, after an edit of a rectangle of heights, with their barriers. Empty where edits need all passes
    /// ([`Picture::keeps_horizons`]).
    pub edit_passes: Vec<Pass>,
    /// Contents of the buffer "azimuths", each list sorted by octant.
    pub azimuths: Vec<Azimuth>,
    /// Contents of the buffer "constants", four f32 per texel; empty without spherical harmonics.
    pub constants: Vec<f32>,
    /// Notes on what the planner dropped or changed, and why.
    pub notes: Vec<String>,
    /// The effective settings, as (name, value).
    pub settings: Vec<(String, String)>,
}

impl Plan {
    /// Bytes of all images and buffers that the renderer creates.
    pub fn internal_bytes(&self) -> u64 {
        let is_own = |r: &&Resource| matches!(r.owner, Owner::Internal | Owner::InputBuffer);
        self.resources.iter().filter(is_own).map(Resource::bytes).sum()
    }

    /// Bytes of all resources, including inputs and outputs: the part of the memory budget that the plan uses.
    pub fn bytes(&self) -> u64 {
        self.resources.iter().map(Resource::bytes).sum()
    }

    /// Passes of a whole recording, then those of an edit.
    pub(crate) fn every_pass(&self) -> impl Iterator<Item = &Pass> {
        self.passes.iter().chain(&self.edit_passes)
    }

    /// Whether it traces the paths of a [`reference`](reference()), which reads only the formats of the plan.
    pub(crate) fn is_traced(&self) -> bool {
        self.find("batch_mean").is_some()
    }

    /// The resource of this name.
    pub fn find(&self, name: &str) -> Option<ResourceId> {
        self.resources.iter().position(|r| r.name == name).map(ResourceId)
    }

    /// Images and texel buffers that the caller hands in, in order.
    pub fn inputs(&self) -> impl Iterator<Item = (ResourceId, &Resource)> {
        self.owned(|owner| matches!(owner, Owner::Input | Owner::InputBuffer))
    }

    /// Images that are written for the caller, in order.
    pub fn outputs(&self) -> impl Iterator<Item = (ResourceId, &Resource)> {
        self.owned(|owner| owner == Owner::Output)
    }

    fn owned(&self, is: fn(Owner) -> bool) -> impl Iterator<Item = (ResourceId, &Resource)> {
        let all = self.resources.iter().enumerate();
        all.filter(move |(_, r)| is(r.owner)).map(|(i, r)| (ResourceId(i), r))
    }

    /// Takes an input from a buffer of the caller instead of an image: rows of `texels`, in the input's own format or another
    /// with as many channels (one: [`Format::R32Float`], [`Format::R16Float`], [`Format::R16Unorm`]; four:
    /// [`Format::Rgba32Float`], [`Format::Rgba16Float`], [`Format::Rgba8Unorm`], [`Format::Rgba8Srgb`]). Shaders fetch from
    /// images, so each recording begins with a copy to an image of the renderer in the format `texels`, which
    /// [`internal_bytes`](Self::internal_bytes) includes.
    ///
    /// # Errors
    /// An unknown input, or one of words or of several layers; texels of another kind. A
    /// [`reference`](crate::plan::reference()) accepts only its own formats.
    pub fn take_buffer(&mut self, input: &str, texels: Format) -> Result<()> {
        let names: Vec<_> = self.inputs().map(|(_, r)| r.name.clone()).collect();
        let is_traced = self.is_traced();
        let found = self
            .resources
            .iter_mut()
            .find(|r| r.name == input && matches!(r.owner, Owner::Input | Owner::InputBuffer));
        let Some(resource) = found else {
            return Err(Error::setting("input", input, names.join(" or ")));
        };
        let may_differ = !is_traced && resource.may_be_narrow();
        let Kind::Image { format, layers, .. } = &mut resource.kind else {
            return Err(Error::setting(input, "a buffer of words", "an image"));
        };
        if format.is_uint() {
            let found = format!("an image of words, {format:?}");
            return Err(Error::setting(input, found, "an image of numbers"));
        }
        if *layers > 1 {
            return Err(Error::setting(input, format!("an image of {layers} layers"), "one layer"));
        }
        let one = [Format::R32Float, Format::R16Float, Format::R16Unorm];
        let four =
            [Format::Rgba32Float, Format::Rgba16Float, Format::Rgba8Unorm, Format::Rgba8Srgb];
        let alike = [&one[..], &four[..]].into_iter().find(|all| all.contains(format));
        let alike = alike.filter(|_| may_differ).map_or(vec![*format], <[Format]>::to_vec);
        if !alike.contains(&texels) {
            let all: Vec<_> = alike.iter().map(|f| format!("{f:?}")).collect();
            let found = format!("{texels:?}");
            return Err(Error::setting(format!("{input}: texels"), found, all.join(" or ")));
        }
        *format = texels;
        resource.owner = Owner::InputBuffer;
        Ok(())
    }
}
