//! Sub-sampled bounces: what arrives is found at nodes, and every sample lit by the mean radiance of the ground that
//! they see and its own share of ground.

use super::batch::bytes_text;
use super::{Builder, Format, Limits, Nodes, Owner, ResourceId};
use crate::scene::{BounceEngine, Quality};

/// Where bounces are found, and what is kept there.
#[derive(Clone, Copy)]
pub(crate) struct BounceNodes {
    pub nodes: Nodes,
    /// What arrives at nodes.
    pub sum: ResourceId,
    /// What a sky of radiance 1 gives to every sample.
    pub sky_share: ResourceId,
    /// Whether that is the bounces' own to find, in their azimuths.
    pub finds_share: bool,
    /// What the first bounce has seen, a layer an azimuth: of four rings where, and its weight.
    pub casts: Option<ResourceId>,
}

impl BounceNodes {
    /// None where every sample is a node, or without bounces; `sky_share` is that of other lights, which walks find by
    /// their own azimuths. Of walks, casting sets are kept where later bounces need them and they take no more than a quarter
    /// of what the budget leaves.
    pub fn make(
        builder: &mut Builder,
        size: [u32; 2],
        quality: &Quality,
        (count, sky_share): (u32, Option<ResourceId>),
        limits: &Limits,
        notes: &mut Vec<String>,
    ) -> Option<Self> {
        let nodes = Nodes { stride: quality.subsample };
        if nodes.stride == 1 || count == 0 {
            return None;
        }
        let mut image = |name: &str, format: Format, [cols, rows]: [u32; 2]| {
            builder.image(name, Owner::Internal, format, [cols, rows, 1], false)
        };
        let [across, along] = nodes.size(size);
        let sum = image("node_sum", Format::Rgba32Float, [across, along]);
        let is_walked = quality.bounces.engine == BounceEngine::Sweep;
        let shared = sky_share.filter(|_| !is_walked);
        let sky_share = shared.unwrap_or_else(|| image("sky_share", Format::R32Float, size));
        let layers = quality.bounces.azimuths;
        let bytes = u64::from(across) * u64::from(along) * u64::from(layers) * 16;
        let room =
            (limits.memory_budget.saturating_sub(builder.bytes()) / 4).min(limits.allocation_bytes);
        let are_wanted = is_walked && count > 1;
        let fits = bytes <= room && layers <= limits.image_layers;
        if are_wanted && !fits {
            notes.push(format!(
                "each bounce swept and walked anew: what the first one sees takes {} in {layers} layers, of {} in {}",
                bytes_text(bytes),
                bytes_text(room),
                limits.image_layers
            ));
        }
        let casts = (are_wanted && fits).then(|| {
            let extent = [across, along, layers];
            builder.image("casting_sets", Owner::Internal, Format::Rgba32Uint, extent, true)
        });
        Some(Self { nodes, sum, sky_share, finds_share: shared.is_none(), casts })
    }

    /// How many nodes there are on a field of this size.
    pub fn count(&self, size: [u32; 2]) -> u64 {
        self.nodes.size(size).map(u64::from).iter().product()
    }
}
