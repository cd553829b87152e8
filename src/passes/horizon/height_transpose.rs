use crate::graph::{Axis, Builder, Reach, Rectangle, ResourceId, shaders};
use crate::passes::sweeping::Lanes;
use crate::scene::Border;

/// Heights transposed for one axis, four lanes per texel; and the same as a buffer, or four lanes from each lane on, where passes
/// read that.
pub(crate) fn plan(
    builder: &mut Builder,
    axis: Axis,
    border: Border,
    heights: ResourceId,
    lanes: Lanes,
) {
    let quads = axis.lanes.div_ceil(4);
    let [first_col, first_row, last_col, last_row] = Rectangle::whole(axis.size()).words();
    let mut bound = vec![("heights", heights), ("lane_heights", lanes.heights)];
    bound.extend(lanes.buffer.map(|b| ("lane_buffer", b)));
    bound.extend(lanes.windows.map(|w| ("lane_windows", w)));
    let pass = builder.pass(
        shaders::HeightTranspose {
            marches_rows: axis.marches_rows,
            periodic: border == Border::Periodic,
            writes_buffer: lanes.buffer.is_some(),
            writes_windows: lanes.windows.is_some(),
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
        (8 + if lanes.buffer.is_some() { 4 } else { 0 }
            + if lanes.windows.is_some() { 16 } else { 0 })
            * axis.texels(),
        axis.texels(),
    );
    // A window begins up to three lanes before the heights that it holds.
    let margin = if lanes.windows.is_some() { 3 } else { 0 };
    pass.reach = Some(Reach::Quads { axis, margin });
}
