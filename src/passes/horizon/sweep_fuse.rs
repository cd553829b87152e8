use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::Lanes;
use crate::scene::Border;

/// Horizons at grid points, as elevations.
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &Sweep,
    border: Border,
    batch: &Batch,
    part: &str,
    [azimuths, angles]: [ResourceId; 2],
    (lanes, lattice, distances): (Lanes, Option<ResourceId>, Option<ResourceId>),
) {
    let axis = batch.axis;
    let [cols, rows] = axis.size();
    let mut bound =
        vec![("lane_heights", lanes.read()), ("azimuths", azimuths), ("horizon_angles", angles)];
    bound.extend(lattice.map(|l| (sweep.lattice_binding(), l)));
    bound.extend(distances.map(|d| ("horizon_distances", d)));
    let pass = builder.pass(
        shaders::SweepFuse {
            layer_shift: batch.layer_shift as i32,
            fuse: sweep.fuse_mode(),
            lattice: sweep.lattice_content(),
            line_shift: sweep.line_shift() as i32,
            border: border as u32,
            writes_distances: distances.is_some(),
            lattice_has_distances: sweep.lattice_has_distances(),
            marches_rows: axis.marches_rows,
            reads_lane_windows: lanes.windows.is_some(),
        },
        part,
        "from the lines back to grid points",
        shaders::SWEEP_FUSE.groups([axis.steps, axis.lanes.div_ceil(4), batch.count]),
        &shaders::SweepFusePush {
            cols: cols as i32,
            rows: rows as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
        },
        &bound,
        axis.texels() * u64::from(batch.count) * (8 + sweep.lattice_bytes()),
        axis.texels() * u64::from(batch.count),
    );
    pass.azimuths = batch.azimuths();
}
