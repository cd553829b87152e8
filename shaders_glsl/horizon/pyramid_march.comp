// Computes: horizons from a height pyramid: along each azimuth one lookup per level, at distances that grow by
// 2^(1/k) and are rounded to whole march steps. Each lookup gives the angle between heights of one level at both
// ends. The horizon is the largest value of the cubic B-spline over these angles, at its knots and midpoints
// (Nowrouzezahrai & Snyder 2009, eq. 14-17).
// Reads: heights, height_levels or height_stack, level_table, azimuths.
// Writes: slopes (f32 bits) at [layer][step][lane]; nodes at their own texels.
// One invocation is one grid point, or node, in all azimuths of a batch.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
// Levels are stored at every grid point, else at their own texels.
layout(constant_id = 1) const bool STACK = false;
// Levels besides the field itself; may be 0.
layout(constant_id = 2) const int LEVELS = 0;
// Grid points from node to node.
layout(constant_id = 3) const int NODE_STRIDE = 1;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2, r32ui) uniform writeonly uimage2DArray slopes;
layout(binding = 3) uniform texture2D height_levels;
layout(binding = 4) uniform utexture2D level_table;
layout(binding = 5) uniform texture2DArray height_stack;

layout(push_constant) uniform PyramidMarchPush {
    int lanes;
    int steps;
    int warm_up;  // steps marched beyond the field: whole periods, or 0
    uint first_azimuth;
    uint azimuth_count;
    int first_row;  // of nodes
    int fine_samples;  // lookups in the field itself
    int width_shift;
    float growth;      // of distances: 2^(1/k)
};

#include "shared/angle.glsl"
#include "shared/nodes.glsl"
#include "shared/spline.glsl"

Azimuth azimuth;

// The last four angles, the newest in w, and the largest value of the spline so far. The first and last angles
// repeat, so that the spline begins and ends with them.
struct Blocked {
    vec4 angles;
    float highest;
};

Blocked blocked_by(Blocked b, float angle, bool is_first) {
    vec4 shifted = vec4(b.angles.yzw, angle);
    vec4 four = is_first ? vec4(angle) : shifted;
    float knot = (four.y + 4.0 * four.z + four.w) * (1.0 / 6.0);
    float middle = ((four.x + four.w) + 23.0 * (four.y + four.z)) * (1.0 / 48.0);
    float highest = max(b.highest, max(knot, middle));
    return Blocked(four, is_first ? angle : highest);
}

// Texel of a lane and step in images of the field's size.
ivec2 texel_of(int lane, int step) {
    int lane_round = wrapped(lane, lanes);
    int step_round = wrapped(step, steps);
    int lane_held = clamp(lane, 0, lanes - 1);
    lane = lane_position(azimuth, PERIODIC ? lane_round : lane_held, lanes);
    step = march_position(azimuth, PERIODIC ? step_round : step, steps);
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    return ivec2(by_row ? lane : step, by_row ? step : lane);
}

// Height of the field itself where a line is `f` past the lane `cell` at a march step.
float field_height(int cell, float f, int step) {
    float h = texelFetch(heights, texel_of(cell, step), 0).x;
    return h + f * (texelFetch(heights, texel_of(cell + 1, step), 0).x - h);
}

// The same of a level in the stack.
float stack_height(int level, int cell, float f, int step) {
    float h = texelFetch(height_stack, ivec3(texel_of(cell, step), level - 1), 0).x;
    return h + f * (texelFetch(height_stack, ivec3(texel_of(cell + 1, step), level - 1), 0).x - h);
}

// The same of a level by its own spline.
float spline_height(Level level, int cell, float f, int step) {
    float from_end_lane = float(lanes - 1 - cell) - f;
    float from_begin_lane = float(cell) + f;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    float at_lane = flips_lanes ? from_end_lane : from_begin_lane;
    float at_step = float(march_position(azimuth, step, steps));
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    vec2 place = vec2(by_row ? at_lane : at_step, by_row ? at_step : at_lane);
    precise vec2 at = place * level.per_grid_point;
    return spline_at(level, at, width_shift);
}

// The same of a level as it is stored.
float level_height(int level, int cell, float f, int step) {
    if (STACK) {
        return stack_height(level, cell, f, step);
    }
    return spline_height(level_of(texelFetch(level_table, ivec2(level - 1, 0), 0)), cell, f, step);
}

// The same at a grid point.
float own_height(int level, int lane, int step) {
    if (STACK) {
        return texelFetch(height_stack, ivec3(texel_of(lane, step), level - 1), 0).x;
    }
    return level_height(level, lane, 0.0, step);
}

// Per level, the field first; the same in all azimuths.
float own_heights[LEVELS + 1];

// March state: the next lookup, its distance, and whether this invocation is still marching.
int next;
float back;
bool on;
Blocked blocked;

// Adds a rise `at` steps away as this lookup's angle, and as that of the following lookups that round to the same
// number of steps.
void take(float rise, int at, int whole) {
    float angle = arc_tangent(vec4(rise / (float(max(at, 1)) * azimuth.step_m))).x;
    do {
        Blocked with = blocked_by(blocked, angle, next == 0);
        blocked.angles = on ? with.angles : blocked.angles;
        blocked.highest = on ? with.highest : blocked.highest;
        next++;
        back *= growth;
    } while (int(back + 0.5) == whole);
}

// Horizon of a grid point in `azimuth`.
float horizon(int lane, int step, bool exists) {
    // Whole steps until the march leaves the field.
    int across = lane * CELL / max(azimuth.shear, 1);
    int reach = step + warm_up;
    reach = !PERIODIC && azimuth.shear > 0 ? min(reach, across) : reach;
    bool meets = exists && reach > 0;
    on = meets;
    next = 0;
    back = 1.0;
    blocked = Blocked(vec4(0.0), 0.0);
    while (next < fine_samples && on) {
        int whole = int(back + 0.5);
        int at = min(whole, reach);
        int y = lane * CELL - at * azimuth.shear;
        float f = float(y & (CELL - 1)) * (1.0 / float(CELL));
        take(field_height(y >> CELL_SHIFT, f, step - at) - own_heights[0], at, whole);
        on = on && whole < reach;
    }
    while (LEVELS > 0 && on) {
        int whole = int(back + 0.5);
        int at = min(whole, reach);
        int y = lane * CELL - at * azimuth.shear;
        float f = float(y & (CELL - 1)) * (1.0 / float(CELL));
        int level = min(next + 1 - fine_samples, LEVELS);
        take(level_height(level, y >> CELL_SHIFT, f, step - at) - own_heights[level], at, whole);
        on = on && whole < reach;
    }
    float last = blocked.angles.w;
    blocked = blocked_by(blocked, last, false);
    blocked = blocked_by(blocked, last, false);
    return meets ? tangent(blocked.highest) : NO_SLOPE;
}

void main() {
    ivec2 node = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
    bool exists = node.x < node_count(lanes, NODE_STRIDE) && node.y < node_count(steps, NODE_STRIDE);
    int lane_at = node_place(node.x, lanes, NODE_STRIDE);
    int step_at = node_place(node.y, steps, NODE_STRIDE);
    azimuth = azimuth_at(azimuths, first_azimuth);
    int lane = lane_position(azimuth, lane_at, lanes);
    int step = march_position(azimuth, step_at, steps);
    own_heights[0] = texelFetch(heights, texel_of(lane, step), 0).x;
    for (int level = 1; level <= LEVELS; level++) {
        own_heights[level] = own_height(level, lane, step);
    }
    for (uint k = 0u; k < azimuth_count; k++) {
        azimuth = azimuth_at(azimuths, first_azimuth + k);
        lane = lane_position(azimuth, lane_at, lanes);
        step = march_position(azimuth, step_at, steps);
        float slope = horizon(lane, step, exists);
        if (exists) {
            ivec2 texel = ivec2(lane, step);
            texel = NODE_STRIDE > 1 ? node : texel;
            imageStore(slopes, ivec3(texel, int(azimuth.layer)), uvec4(floatBitsToUint(slope)));
        }
    }
}
