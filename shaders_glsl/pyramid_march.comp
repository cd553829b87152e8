// Computes: horizons from a height pyramid: along each azimuth one sample a level, at distances that
// grow by 2^(1/k), each the angle between heights of one level at both ends; then the largest value of
// the cubic B-spline over them, at its knots and midpoints (Nowrouzezahrai & Snyder 2009, eq. 14-17).
// Reads: heights, height_levels or height_stack, level_table, azimuths.
// Writes: slopes (f32 bits) at [layer][step][lane].
// One invocation is one sample in one azimuth.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

#include "shared/surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
// Levels are there at every sample, else at their own texels.
layout(constant_id = 1) const bool STACK = false;
// Levels beside the field itself; may be none.
layout(constant_id = 2) const int LEVELS = 0;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2) uniform writeonly uimage2DArray slopes;
layout(binding = 3) uniform texture2D height_levels;
layout(binding = 4) uniform utexture2D level_table;
layout(binding = 5) uniform texture2DArray height_stack;

layout(push_constant) uniform PyramidMarchPush {
    int lanes;
    int steps;
    int warm_up;  // steps marched beyond the field: whole periods, or 0
    uint first_azimuth;
    int fine_samples;  // that look at the field itself
    int width_shift;
    float growth;      // of distances: 2^(1/k)
};

#include "shared/angle.glsl"
#include "shared/heights.glsl"
#include "shared/spline.glsl"

// The last four angles, the newest in w, and the largest value of the spline so far. Before the first
// and after the last, angles go on as they are, so that the spline begins and ends with them.
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

// Rise over `own` of the surface `back` steps along the march from a sample.
float surface_rise_at(int lane, int step, float own, float back, bool split_along) {
    precise float aside = back * (float(azimuth.shear) * (1.0 / float(CELL)));
    int whole = int(ceil(back));
    int lower = int(ceil(aside));
    int cell = lane - lower;
    int at = step - whole;
    return surface_rise(height_at(cell, at), height_at(cell, at + 1), height_at(cell + 1, at),
                        height_at(cell + 1, at + 1), own, float(whole) - back, float(lower) - aside, split_along);
}

// Column and row that lie `back` steps along the march from a sample.
vec2 place_at(int lane, int step, float back) {
    precise float aside = back * (float(azimuth.shear) * (1.0 / float(CELL)));
    float from_lane = float(lane_position(azimuth, lane, lanes));
    float from_step = float(march_position(azimuth, step, steps));
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    bool flips_march = (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u;
    float lane_after = from_lane + aside;
    float lane_before = from_lane - aside;
    float step_after = from_step + back;
    float step_before = from_step - back;
    float at_lane = flips_lanes ? lane_after : lane_before;
    float at_step = flips_march ? step_after : step_before;
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    return vec2(by_row ? at_lane : at_step, by_row ? at_step : at_lane);
}

float stack_texel(int x, int y, ivec2 size, int level) {
    ivec2 held = clamp(ivec2(x, y), ivec2(0), size - 1);
    ivec2 round = ivec2(wrapped(x, size.x), wrapped(y, size.y));
    return texelFetch(height_stack, ivec3(PERIODIC ? round : held, level - 1), 0).x;
}

// Height of a level at a column and row: of the stack bilinearly.
float level_height(int level, vec2 place, ivec2 size) {
    if (!STACK) {
        Level l = level_of(texelFetch(level_table, ivec2(level - 1, 0), 0));
        precise vec2 at = place * l.per_sample;
        return spline_at(l, at, width_shift);
    }
    vec2 cell = floor(place);
    ivec2 c = ivec2(cell);
    vec2 t = place - cell;
    float nw = stack_texel(c.x, c.y, size, level);
    float ne = stack_texel(c.x + 1, c.y, size, level);
    float sw = stack_texel(c.x, c.y + 1, size, level);
    float se = stack_texel(c.x + 1, c.y + 1, size, level);
    float north = nw + t.x * (ne - nw);
    float south = sw + t.x * (se - sw);
    return north + t.y * (south - north);
}

float own_height(int level, vec2 place, ivec2 size) {
    return STACK ? texelFetch(height_stack, ivec3(ivec2(place), level - 1), 0).x : level_height(level, place, size);
}

void main() {
    azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    int lane = int(gl_GlobalInvocationID.x);
    int step = int(gl_GlobalInvocationID.y);
    bool exists = lane < lanes && step < steps;
    lane = min(lane, lanes - 1);
    step = min(step, steps - 1);
    bool split_along = splits_along();
    // Steps until the march leaves the field.
    float across = float(lane) * float(CELL) / float(max(azimuth.shear, 1));
    float reach = float(step + warm_up);
    reach = !PERIODIC && azimuth.shear > 0 ? min(reach, across) : reach;
    float own = height_at(lane, step);
    Blocked blocked = Blocked(vec4(0.0), 0.0);
    bool on = exists && reach > 0.0;
    bool any_met = on;
    float back = 1.0;
    for (int i = 0; i < fine_samples; i++) {
        // Left by all lanes together, as in horizon_sweep.
        if (!subgroupAny(on)) {
            break;
        }
        bool is_last = back >= reach * (1.0 - HAIR);
        float at = is_last ? reach : back;
        float rise = surface_rise_at(lane, step, own, at, split_along);
        float angle = arc_tangent(vec4(rise / (at * azimuth.step_m))).x;
        Blocked with = blocked_by(blocked, angle, i == 0);
        blocked.angles = on ? with.angles : blocked.angles;
        blocked.highest = on ? with.highest : blocked.highest;
        on = on && !is_last;
        back *= growth;
    }
    if (LEVELS > 0) {
        vec2 here = place_at(lane, step, 0.0);
        bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
        ivec2 size = by_row ? ivec2(lanes, steps) : ivec2(steps, lanes);
        for (int i = 1;; i++) {
            if (!subgroupAny(on)) {
                break;
            }
            int level = min(i, LEVELS);
            bool is_last = back >= reach * (1.0 - HAIR);
            float at = is_last ? reach : back;
            float rise = level_height(level, place_at(lane, step, at), size) - own_height(level, here, size);
            float angle = arc_tangent(vec4(rise / (at * azimuth.step_m))).x;
            Blocked with = blocked_by(blocked, angle, false);
            blocked.angles = on ? with.angles : blocked.angles;
            blocked.highest = on ? with.highest : blocked.highest;
            on = on && !is_last;
            back *= growth;
        }
    }
    float last = blocked.angles.w;
    blocked = blocked_by(blocked, last, false);
    blocked = blocked_by(blocked, last, false);
    if (exists) {
        float slope = any_met ? tangent(blocked.highest) : NO_SLOPE;
        imageStore(slopes, ivec3(lane, step, int(azimuth.layer)), uvec4(floatBitsToUint(slope)));
    }
}
