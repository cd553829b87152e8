//! Bounces at nodes: irradiance is computed at nodes. Every grid point then takes the mean radiance of the
//! ground visible from the nodes around it, times its own share of ground.

use crate::graph::bytes_text;
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::nodes::Nodes;
use crate::scene::{BounceEngine, Quality};

/// Least stride of the nodes of later bounces. On the bundled mountain, the middle of Mt Rainier and moss, under a sky and a low sun, at
/// an albedo of 0.8, in 16 and 32 azimuths, a stride of 2 has 0.82 to 0.99 times the error of all light (commit f8e38f95). Its
/// visibility cache is four times as large.
const LEAST_LATER_STRIDE: u32 = 4;

/// Nodes, and the irradiance there.
#[derive(Clone, Copy)]
pub(crate) struct NodeSum {
    pub nodes: Nodes,
    pub sum: ResourceId,
}

impl NodeSum {
    /// How many nodes a field of this size has.
    pub(crate) fn count(&self, size: [u32; 2]) -> u64 {
        self.nodes.size(size).map(u64::from).iter().product()
    }
}

/// Where bounces are found, and the images for them.
#[derive(Clone, Copy)]
pub(crate) struct BounceNodes {
    /// Nodes of the first bounce; none where it is found at every grid point.
    pub first: Option<NodeSum>,
    /// Nodes of later bounces, where there are any, with two images of their sums, used alternately. They are fewer than those
    /// of the first bounce, since later bounces are weaker and smoother.
    later: Option<[NodeSum; 2]>,
    /// Irradiance of a sky of radiance 1, at every grid point.
    pub sky_share: ResourceId,
    /// Whether the bounces find it themselves, along their own azimuths.
    finds_share: bool,
    /// The visibility cache: what the first bounce found at the later bounces' nodes, one layer per azimuth.
    /// Each holds the positions of four rings, and its weight.
    visibility_cache: Option<ResourceId>,
}

impl BounceNodes {
    /// None where all bounces are found at every grid point, or without bounces. `sky_share` is that of other lights;
    /// walks find their own along their own azimuths. Walks keep a visibility cache if later bounces need one and it fits
    /// `limits`; without limits there is none. Without a cache, walks from every grid point find all bounces.
    pub(crate) fn make(
        builder: &mut Builder,
        size: [u32; 2],
        quality: &Quality,
        (count, sky_share): (u32, Option<ResourceId>),
        limits: Option<&Limits>,
        notes: &mut Vec<String>,
    ) -> Option<Self> {
        let stride = quality.subsample;
        let is_walked = quality.bounces.engine == BounceEngine::Sweep;
        let needs_cache = is_walked && count > 1;
        if count == 0 || stride == 1 && !needs_cache {
            return None;
        }
        let later = Nodes { stride: (2 * stride).max(LEAST_LATER_STRIDE) };
        let visibility_cache =
            needs_cache.then(|| cache(builder, (size, later), quality, limits, notes)).flatten();
        if stride == 1 && visibility_cache.is_none() {
            return None;
        }
        let mut sum = |name: &str, nodes: Nodes| {
            let [cols, rows] = nodes.size(size);
            let extent = [cols, rows, 1];
            let sum = builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false);
            NodeSum { nodes, sum }
        };
        let first = (stride > 1).then(|| sum("node_sum", Nodes { stride }));
        let later = (count > 1).then(|| {
            let one = sum("later_node_sum", later);
            // `cache_gather` reads the divisor of the bounce before.
            [one, if count > 2 { sum("other_node_sum", later) } else { one }]
        });
        let shared = sky_share.filter(|_| !is_walked);
        let share = || {
            let extent = [size[0], size[1], 1];
            builder.image("sky_share", Owner::Internal, Format::R32Float, extent, false)
        };
        let sky_share = shared.unwrap_or_else(share);
        Some(Self { first, later, sky_share, finds_share: shared.is_none(), visibility_cache })
    }

    /// Nodes of bounce `k`, from 1; none where it is found at every grid point.
    pub(crate) fn of_bounce(&self, k: usize) -> Option<NodeSum> {
        self.later.filter(|_| k > 1).map(|later| later[k % 2]).or(self.first)
    }

    /// `sky_share` as the output of `sky_shade`, and as that of `bounce_walk`: at most one is set.
    pub(crate) fn own_share(&self) -> [Option<ResourceId>; 2] {
        let own = Some(self.sky_share).filter(|_| self.finds_share);
        [own.filter(|_| self.first.is_some()), own.filter(|_| self.first.is_none())]
    }

    /// The visibility cache, and its nodes.
    pub(crate) fn cached(&self) -> Option<(ResourceId, Nodes)> {
        Some((self.visibility_cache?, self.later?[0].nodes))
    }
}

/// The visibility cache of some nodes, if it takes at most a quarter of the remaining budget.
fn cache(
    builder: &mut Builder,
    (size, nodes): ([u32; 2], Nodes),
    quality: &Quality,
    limits: Option<&Limits>,
    notes: &mut Vec<String>,
) -> Option<ResourceId> {
    let layers = quality.bounces.azimuths;
    let [across, along] = nodes.size(size);
    let bytes = u64::from(across) * u64::from(along) * u64::from(layers) * 16;
    let why = "no visibility cache, so each bounce repeats the sweep and the walks";
    let needs = format!("{} in {layers} layers", bytes_text(bytes));
    let Some(limits) = limits else {
        notes.push(format!("{why}: with one of {needs} the picture exceeds the memory budget"));
        return None;
    };
    let left = limits.memory_budget.saturating_sub(builder.bytes());
    let room = (left / 4).min(limits.allocation_bytes);
    if bytes > room || layers > limits.image_layers {
        notes.push(format!(
            "{why}: it needs {needs}, and {} in {} are available",
            bytes_text(room),
            limits.image_layers
        ));
        return None;
    }
    notes.push(format!(
        "bounces after the first are interpolated between every {}th grid point and row",
        nodes.stride
    ));
    let extent = [across, along, layers];
    Some(builder.image("visibility_cache", Owner::Internal, Format::Rgba32Uint, extent, true))
}
