// Computes: the heights laid out for sweeps, one copy a march axis, lanes contiguous.
// Reads: heights (one texel a sample). Writes: heights_by_col (marches along columns: [col][row]),
// heights_by_row (marches along rows: [row][col]); those that the plan asks for.
// One invocation is one sample.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool WRITES_BY_COL = true;
layout(constant_id = 1) const bool WRITES_BY_ROW = true;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) writeonly buffer HeightsByCol { float heights_by_col[]; };
layout(binding = 2) writeonly buffer HeightsByRow { float heights_by_row[]; };

layout(push_constant) uniform HeightTransposePush { int cols; int rows; };

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    float h = texelFetch(heights, at, 0).x;
    if (WRITES_BY_COL) {
        heights_by_col[at.x * rows + at.y] = h;
    }
    if (WRITES_BY_ROW) {
        heights_by_row[at.y * cols + at.x] = h;
    }
}
