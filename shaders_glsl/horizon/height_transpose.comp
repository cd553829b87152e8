// Computes: a rectangle of the heights (all, or the edited part) transposed for a march axis, four neighbouring lanes
// per texel, or four from each lane on.
// Reads: heights (one texel per grid point).
// Writes: lane_heights at [march position][lane / 4]; lanes past the last repeat it, or wrap where the field repeats.
// Writes: lane_windows at [march position][lane + 3]: that lane and the three after it.
// And the same heights to lane_buffer, after four floats that repeat the first four and before four that repeat the last.
// One invocation is four lanes of one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool MARCHES_ROWS = false;
layout(constant_id = 1) const bool PERIODIC = false;
layout(constant_id = 2) const bool WRITES_BUFFER = false;
layout(constant_id = 3) const bool WRITES_WINDOWS = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1, rgba32f) uniform writeonly image2D lane_heights;
layout(binding = 2) writeonly buffer LaneBuffer { vec4 lane_buffer[]; };

layout(binding = 3, rgba32f) uniform writeonly image2D lane_windows;

layout(push_constant) uniform HeightTransposePush {
    int lanes;
    int steps;
    int first_col;  // of the rectangle
    int first_row;
    int last_col;
    int last_row;
};

// Of a lane from 0 on.
float height_of(int lane, int march) {
    lane = PERIODIC ? lane % lanes : min(lane, lanes - 1);
    return texelFetch(heights, MARCHES_ROWS ? ivec2(lane, march) : ivec2(march, lane), 0).x;
}

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
        four[k] = height_of(4 * group + k, march);
    }
    imageStore(lane_heights, ivec2(group, march), four);
    if (WRITES_WINDOWS) {
        // The windows that end here; from the last group also those that only begin here.
        bool is_last = 4 * group + 4 >= lanes;
        vec4 window = vec4(0.0);
        for (int k = -3; k < (is_last ? 7 : 4); k++) {
            int lane = 4 * group + k;
            lane = PERIODIC ? lane + 3 * lanes : max(lane, 0);
            window = vec4(window.yzw, height_of(lane, march));
            if (k >= 0 && 4 * group + k < lanes + 3) {
                imageStore(lane_windows, ivec2(4 * group + k, march), window);
            }
        }
    }
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
