// Computes: shadow heights of a sun over a preview's fine grid: the height from which the whole sun is visible, and the
// height below which none of it is.
// Reads: heights.
// Writes: lit_above, dark_below (metres over the field's base; NOTHING where no ground is ahead): at each grid point those
// of the line that passes through it or of the last line before it, in the order of the lanes.
// One invocation is one line. Lines are a cell apart and run away from the sun's centre. `preview_shade` interpolates them.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 16) in;

layout(constant_id = 0) const bool PERIODIC = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1, r32f) uniform writeonly image2D lit_above;
layout(binding = 2, r32f) uniform writeonly image2D dark_below;

#include "shared/lines.glsl"

layout(push_constant) uniform PreviewShadowPush {
    vec2 rise_m;  // of a march step: rays to the sun's lower and upper edge
    int cols;
    int rows;
    int shear;
    uint flags;   // AZIMUTH_*
};

// No ground.
const float NOTHING = -1e30;

bool has(uint flag) {
    return (flags & flag) != 0u;
}

int inside(int place, int count) {
    return PERIODIC ? wrapped(place, count) : clamp(place, 0, count - 1);
}

// The texel of a lane and a march step, both within the field.
ivec2 texel_of(int lane, int step, int lanes, int steps) {
    int lane_at = has(AZIMUTH_FLIPS_LANES) ? lanes - 1 - lane : lane;
    int step_at = has(AZIMUTH_FLIPS_MARCH) ? steps - 1 - step : step;
    return has(AZIMUTH_MARCHES_ROWS) ? ivec2(lane_at, step_at) : ivec2(step_at, lane_at);
}

void main() {
    int lanes = has(AZIMUTH_MARCHES_ROWS) ? cols : rows;
    int steps = has(AZIMUTH_MARCHES_ROWS) ? rows : cols;
    int lead = lattice_lead(shear, steps, CELL_SHIFT, PERIODIC);
    int line = int(gl_GlobalInvocationID.x);
    if (line >= lattice_lines(lanes, lead, CELL_SHIFT, PERIODIC)) {
        return;
    }
    // The lane position at step 0; a periodic field first gives the ground of one period ahead.
    int y = (line - lead) * CELL;
    int begin = PERIODIC ? -steps : 0;
    int end = steps;
    if (!PERIODIC && shear > 0) {
        // From less than a cell before the first lane to the last one.
        begin = y > -CELL ? 0 : (-CELL - y) / shear + 1;
        end = min(steps, ((lanes - 1) * CELL - y) / shear + 1);
    }
    vec2 top = vec2(NOTHING);
    for (int step = begin; step < end; step++) {
        int at = y + step * shear;
        int cell = at >> CELL_SHIFT;
        int march = inside(step, steps);
        float below = texelFetch(heights, texel_of(inside(cell, lanes), march, lanes, steps), 0).x;
        float above = texelFetch(heights, texel_of(inside(cell + 1, lanes), march, lanes, steps), 0).x;
        float here = mix(below, above, float(at & (CELL - 1)) * (1.0 / float(CELL)));
        top -= rise_m;
        if (step >= 0) {
            int lane = inside((at + CELL - 1) >> CELL_SHIFT, lanes);
            ivec2 texel = texel_of(lane, march, lanes, steps);
            imageStore(lit_above, texel, vec4(top.x));
            imageStore(dark_below, texel, vec4(top.y));
        }
        top = max(top, vec2(here));
    }
}
