use crate::graph::{Builder, GROUP_LINES, Reach, Rectangle, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::sweep::LineSweep;
use crate::scene::Fuse;

/// What the sweep of an edit reads and writes.
pub(crate) struct Images {
    pub heights: ResourceId,
    pub azimuths: ResourceId,
    pub occluders: ResourceId,
    pub dirty: ResourceId,
    pub list: ResourceId,
}

/// Distance from an occluder, in grid points, within which fuse `aimed-around` reads heights.
const MARGIN: u32 = 2;

/// Sweeps the lines of a batch that an edited rectangle can reach.
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &LineSweep,
    batch: &Batch,
    part: &str,
    images: &Images,
) {
    let axis = batch.axis;
    let margin = if sweep.fuse == Fuse::AimedAround { MARGIN } else { 0 };
    let [first_col, first_row, last_col, last_row] = Rectangle::whole(axis.size()).words();
    let pass = builder.pass(
        shaders::HorizonResweep {
            layer_shift: batch.layer_shift as i32,
            line_shift: sweep.line_shift as i32,
            hull_packed: sweep.packed,
        },
        part,
        "lines that cross the edit, until it has left their hulls",
        [batch.most_lines.div_ceil(GROUP_LINES), 1, batch.count],
        &shaders::HorizonResweepPush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            first_azimuth: batch.first,
            height_scale: sweep.height_scale,
            first_col,
            first_row,
            last_col,
            last_row,
        },
        &[
            ("heights", images.heights),
            ("azimuths", images.azimuths),
            ("occluders", images.occluders),
            ("dirty_texels", images.dirty),
            ("edit_list", images.list),
        ],
        batch.line_texels * 8,
        batch.line_texels,
    );
    pass.azimuths = batch.azimuths();
    pass.reach = Some(Reach::Lines { axis, line_shift: sweep.line_shift, margin });
}
