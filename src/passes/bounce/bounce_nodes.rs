//! Sub-sampled bounces: what arrives is found at nodes, and every sample lit by the mean radiance of the ground that
//! they see and its own share of ground.

use crate::graph::bytes_text;
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::nodes::Nodes;
use crate::scene::{BounceEngine, Quality};

/// Nodes, and what arrives there.
#[derive(Clone, Copy)]
pub(crate) struct NodeSum {
    pub nodes: Nodes,
    pub sum: ResourceId,
}

impl NodeSum {
    /// How many nodes there are on a field of this size.
    pub fn count(&self, size: [u32; 2]) -> u64 {
        self.nodes.size(size).map(u64::from).iter().product()
    }
}

/// Where bounces are found, and what is kept there.
#[derive(Clone, Copy)]
pub(crate) struct BounceNodes {
    /// Of the first bounce.
    pub first: NodeSum,
    /// Of later ones, every second of those, where there are any: what has been thrown twice is less, and smoother.
    pub later: Option<NodeSum>,
    /// What a sky of radiance 1 gives to every sample.
    pub sky_share: ResourceId,
    /// Whether that is the bounces' own to find, in their azimuths.
    pub finds_share: bool,
    /// What the first bounce has seen from the later ones' nodes, a layer an azimuth: of four rings where, and its
    /// weight.
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
        let stride = quality.subsample;
        if stride == 1 || count == 0 {
            return None;
        }
        let mut sum = |name: &str, stride: u32| {
            let nodes = Nodes { stride };
            let [cols, rows] = nodes.size(size);
            let extent = [cols, rows, 1];
            NodeSum {
                nodes,
                sum: builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false),
            }
        };
        let first = sum("node_sum", stride);
        let later = (count > 1).then(|| sum("later_node_sum", 2 * stride));
        let is_walked = quality.bounces.engine == BounceEngine::Sweep;
        let shared = sky_share.filter(|_| !is_walked);
        let share = || {
            let extent = [size[0], size[1], 1];
            builder.image("sky_share", Owner::Internal, Format::R32Float, extent, false)
        };
        let sky_share = shared.unwrap_or_else(share);
        let kept = later.filter(|_| is_walked);
        let casts = kept.and_then(|later| {
            let layers = quality.bounces.azimuths;
            let bytes = later.count(size) * u64::from(layers) * 16;
            let room = (limits.memory_budget.saturating_sub(builder.bytes()) / 4)
                .min(limits.allocation_bytes);
            if bytes > room || layers > limits.image_layers {
                notes.push(format!(
                    "each bounce swept and walked anew: what the first one sees takes {} in {layers} layers, of {} in {}",
                    bytes_text(bytes),
                    bytes_text(room),
                    limits.image_layers
                ));
                return None;
            }
            let [across, along] = later.nodes.size(size);
            let extent = [across, along, layers];
            let format = Format::Rgba32Uint;
            Some(builder.image("casting_sets", Owner::Internal, format, extent, true))
        });
        Some(Self { first, later, sky_share, finds_share: shared.is_none(), casts })
    }
}
