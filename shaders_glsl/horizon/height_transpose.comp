// Computes: a rectangle of the heights (all, or the edited part) transposed for a march axis, four neighbouring lanes
// per texel.
// Reads: heights (one texel per grid point).
// Writes: lane_heights at [march position][lane / 4]; lanes past the last repeat it, or wrap where the field repeats.
// And the same heights to lane_buffer, after four floats that repeat the first four and before four that repeat the last.
// One invocation is four lanes of one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool MARCHES_ROWS = false;
layout(constant_id = 1) const bool PERIODIC = false;
layout(constant_id = 2) const bool WRITES_BUFFER = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1, rgba32f) uniform writeonly image2D lane_heights;
layout(binding = 2) writeonly buffer LaneBuffer { vec4 lane_buffer[]; };

layout(push_constant) uniform HeightTransposePush {
    int lanes;
    int steps;
    int first_col;  // of the rectangle
    int first_row;
    int last_col;
    int last_row;
};

void main() {
    ivec2 first = MARCHES_ROWS ? ivec2(first_col, first_row) : ivec2(first_row, first_col);
    ivec2 last = MARCHES_ROWS ? ivec2(last_col, last_row) : ivec2(last_row, last_col);
    int group = first.x / 4 + int(gl_GlobalInvocationID.x);
    int march = first.y + int(gl_GlobalInvocationID.y);
    if (4 * group > last.x || march > last.y) {
        return;
    }
    vec4 four;
    for (int k = 0; k < 4; k++) {
        int lane = PERIODIC ? (4 * group + k) % lanes : min(4 * group + k, lanes - 1);
        four[k] = texelFetch(heights, MARCHES_ROWS ? ivec2(lane, march) : ivec2(march, lane), 0).x;
    }
    imageStore(lane_heights, ivec2(group, march), four);
    if (WRITES_BUFFER) {
        int groups = (lanes + 3) >> 2;
        int at = march * groups + group;
        lane_buffer[at + 1] = four;
        // Finite heights for reads past the first and the last lane, which have no weight: LANE_BUFFER_PAD of sweep.glsl, one texel.
        if (at == 0) {
            lane_buffer[0] = four;
        }
        if (at == steps * groups - 1) {
            lane_buffer[at + 2] = four;
        }
    }
}
