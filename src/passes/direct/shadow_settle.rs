use crate::graph::{Builder, MOST_TURNS, ResourceId, shaders};
use crate::passes::azimuths::Shape;
use crate::passes::batch::Batch;
use crate::passes::shadows::{Shadows, Walked};
use crate::scene::{Border, HeightField};

/// Invocations of a workgroup: each is one azimuth of one texel.
const INVOCATIONS: u32 = shaders::SHADOW_SETTLE.group_size()[0];
/// Texels of a workgroup per four lanes: 16 march positions.
const FOUR_TEXELS: u32 = 4 * 16;
const MOST_FOURS: u32 = 8;
/// On a GPU a workgroup takes fewer texels until a dispatch has this many, which spreads the walks evenly: at 1024² and 25 degrees 128 texels
/// were the fastest of three sizes on an NVIDIA H200 (benches/results/nvidia_h200.md).
const BUSY_GROUPS: u64 = 1 << 13;

/// Light of a sun at the marked texels, in as many dispatches as the walks of its azimuths need.
pub(crate) fn plan(
    builder: &mut Builder,
    (shadows, walked): (&Shadows, Walked),
    (field, border): (&HeightField, Border),
    batch: &Batch,
    (part, shape): (&str, Shape),
    ([lane_heights, azimuths, lattice, sun_sum], light_vector): (
        [ResourceId; 4],
        Option<ResourceId>,
    ),
) {
    let axis = batch.axis;
    let mut bound = vec![
        ("lane_heights", lane_heights),
        ("maxima", walked.maxima),
        ("azimuths", azimuths),
        ("doubtful", shadows.doubtful(axis)),
        ("sun_sum", sun_sum),
        ("shadows", lattice),
    ];
    bound.extend(light_vector.map(|vector| ("light_vector", vector)));
    let is_gpu = !shadows.limits.is_cpu;
    let busy_fours = (axis.texels() / (u64::from(FOUR_TEXELS) * BUSY_GROUPS)) as u32;
    let tile_fours = if is_gpu { busy_fours.clamp(1, MOST_FOURS) } else { MOST_FOURS };
    let most_steps = shadows.levels.most_steps();
    // An invocation walks for every so many texels of the workgroup. One walk may be as long as any; of many, most are short.
    let walks = MOST_TURNS.saturating_sub(most_steps) / shadows.levels.usual_steps();
    let at_once = (walks * INVOCATIONS / (FOUR_TEXELS * tile_fours)).clamp(1, INVOCATIONS);
    for first in (0..batch.count).step_by(at_once as usize) {
        let count = at_once.min(batch.count - first);
        let part = match count {
            all if all == batch.count => part.to_owned(),
            _ => format!("{part} azimuths {first}..{}", first + count),
        };
        let pass = builder.pass(
            shaders::ShadowSettle {
                layer_shift: batch.layer_shift as i32,
                border: border as u32,
                marches_rows: axis.marches_rows,
                shape: shape as u32,
                most_steps: most_steps as i32,
                tile_fours: tile_fours as i32,
                branches: is_gpu,
                has_vector: light_vector.is_some(),
            },
            &part,
            "exact horizons of the marked texels",
            [axis.steps.div_ceil(16), axis.lanes.div_ceil(4 * tile_fours), 1],
            &shaders::ShadowSettlePush {
                land: shaders::LandPush::of(field, &shadows.levels),
                first_azimuth: batch.first + first,
                azimuth_count: count,
                clears: u32::from(batch.is_first && first == 0),
                warm_up: axis.warm_up as i32,
                tilt: walked.tilt,
            },
            &bound,
            // The heights decide how many texels are marked and how far their walks go.
            0,
            0,
        );
        pass.azimuths = batch.first + first..batch.first + first + count;
    }
}
