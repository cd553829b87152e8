use crate::graph::{Axis, Builder, Reach, Rectangle, ResourceId, shaders};
use crate::scene::Border;

/// Heights transposed for one axis, four lanes per texel; and the same as a buffer, where a sweep reads that.
pub(crate) fn plan(
    builder: &mut Builder,
    axis: Axis,
    border: Border,
    heights: ResourceId,
    lane_heights: ResourceId,
    lane_buffer: Option<ResourceId>,
) {
    let quads = axis.lanes.div_ceil(4);
    let [first_col, first_row, last_col, last_row] = Rectangle::whole(axis.size()).words();
    let mut bound = vec![("heights", heights), ("lane_heights", lane_heights)];
    bound.extend(lane_buffer.map(|b| ("lane_buffer", b)));
    let pass = builder.pass(
        shaders::HeightTranspose {
            marches_rows: axis.marches_rows,
            periodic: border == Border::Periodic,
            writes_buffer: lane_buffer.is_some(),
        },
        axis.name(),
        "so that one fetch reads four neighbouring lanes",
        shaders::HEIGHT_TRANSPOSE.groups([quads, axis.steps, 1]),
        &shaders::HeightTransposePush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            first_col,
            first_row,
            last_col,
            last_row,
        },
        &bound,
        if lane_buffer.is_some() { 12 } else { 8 } * axis.texels(),
        axis.texels(),
    );
    pass.reach = Some(Reach::Quads(axis));
}
