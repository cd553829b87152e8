// Computes: exact horizons of the triangulated surface in azimuths along grid vectors (a, b): every
// sample lies on a line, and every crossing of a line with grid lines and diagonals is on its hull.
// Reads: heights, azimuths. Writes: slopes (f32 bits) at [layer][step][lane], and in the
// next layer, where asked, the march steps to what is met (f32 bits).
// One invocation is one line, from the horizon's side to the other end.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

#include "shared/sweep.glsl"
#include "shared/surface.glsl"

layout(local_size_x_id = 0) in;
// Every crossing of a line: a hull can be no deeper.
layout(constant_id = 1) const int HULL_DEPTH = 1;
layout(constant_id = 2) const bool PERIODIC = false;
layout(constant_id = 3) const bool WRITES_DISTANCES = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2) uniform writeonly uimage2DArray slopes;

layout(push_constant) uniform SurfaceSweepPush {
    int lanes;
    int steps;
    int warm_up;
    uint first_azimuth;
};

Azimuth azimuth;

float height_at(int lane, int step) {
    lane = lane_position(azimuth, PERIODIC ? wrapped(lane, lanes) : clamp(lane, 0, lanes - 1), lanes);
    step = march_position(azimuth, PERIODIC ? wrapped(step, steps) : clamp(step, 0, steps - 1), steps);
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    return texelFetch(heights, by_row ? ivec2(lane, step) : ivec2(step, lane), 0).x;
}

// Rise over `own` of the surface `u` past step `step`, for a line at lane position y (in 1/march
// of a cell) at that step.
float rise_over(float own, int y, int step, float u) {
    int march = azimuth.vector_march;
    int cell = (y + march * 65536) / march - 65536;
    float f = float(y - cell * march) / float(march) + u * float(azimuth.vector_lane) / float(march);
    if (f > 1.0) {
        f -= 1.0;
        cell++;
    }
    bool split_along = ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) == ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
    return surface_rise(height_at(cell, step), height_at(cell, step + 1), height_at(cell + 1, step),
                        height_at(cell + 1, step + 1), own, u, f, split_along);
}

void main() {
    azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    int march = azimuth.vector_march;
    int shear = azimuth.vector_lane;
    int total = warm_up + steps;
    int width = PERIODIC ? lanes * march - 1 : (lanes - 1) * march;
    int lead = PERIODIC ? 0 : (total - 1) * shear;
    int line = int(gl_GlobalInvocationID.x);
    bool split_along = ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) == ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
    float advance = float(shear) / float(march);
    // All lines of a group march together, over the steps at which any of them is on the field.
    int first = int(gl_WorkGroupID.x * gl_WorkGroupSize.x) - lead;
    int last = first + int(gl_WorkGroupSize.x) - 1;
    int begin = shear > 0 && !PERIODIC ? max(0, (-last + shear - 1) / shear) : 0;
    int end = shear > 0 && !PERIODIC ? min(total, (width - first) / shear + 1) : total;

    // Hull vertices: height, and place as whole step and the rest of one, so that differences of
    // near places keep their digits.
    float hull_h[HULL_DEPTH];
    float hull_step[HULL_DEPTH];
    float hull_rest[HULL_DEPTH];
    int depth = 0;
    for (int step = begin; step < end; step++) {
        int y = line - lead + step * shear;
        bool on = PERIODIC ? line <= width : y >= 0 && y <= width;
        // The segment that ends here, from its crossings to the step itself.
        int y0 = y - shear;
        int cell0 = (y0 + march * 65536) / march - 65536;
        float f0 = float(y0 - cell0 * march) / float(march);
        vec4 places = vec4(segment_crossings(f0, advance, split_along), 1.0);
        [[unroll]] for (int c = 0; c < 4; c++) {
            float u = places[c];
            // Off the field: before the first step, or before the line entered across the first lane.
            bool exists = on && u <= 1.0 && (c == 3 || (step > 0 && (PERIODIC || float(y0) + u * float(shear) >= -1e-3)));
            float h = rise_over(0.0, y0, step - 1, u);
            if (c == 3) {
                int cell = y0 + shear + march * 65536;
                h = height_at(cell / march - 65536, step);
                float f = float(cell % march) / float(march);
                h += f > 0.0 ? f * (height_at(cell / march - 65535, step) - h) : 0.0;
            }
            // Left by all lanes together, as in horizon_sweep.
            bool pops = exists;
            do {
                int newest = max(depth - 1, 0);
                int deeper_one = max(depth - 2, 0);
                float x1 = (float(step - 1) - hull_step[newest]) + (u - hull_rest[newest]);
                float x2 = (float(step - 1) - hull_step[deeper_one]) + (u - hull_rest[deeper_one]);
                precise float deeper = (hull_h[deeper_one] - h) * x1;
                precise float newer = (hull_h[newest] - h) * x2;
                pops = pops && depth > 1 && deeper >= newer;
                depth -= pops ? 1 : 0;
            } while (subgroupAny(pops));
            if (exists && c == 3 && y % march == 0 && step >= warm_up) {
                float slope = NO_SLOPE;
                float back = 0.0;
                if (depth > 0) {
                    int met_step = int(hull_step[depth - 1]);
                    float met_rest = hull_rest[depth - 1];
                    back = float(step - met_step) - met_rest;
                    slope = rise_over(h, y - (step - met_step) * shear, met_step, met_rest) / (back * azimuth.step_m);
                }
                int lane = y / march;
                ivec2 texel = ivec2(PERIODIC ? wrapped(lane, lanes) : lane, PERIODIC ? step - warm_up : step);
                int layer = int(azimuth.layer);
                imageStore(slopes, ivec3(texel, layer), uvec4(floatBitsToUint(slope)));
                if (WRITES_DISTANCES) {
                    imageStore(slopes, ivec3(texel, layer + 1), uvec4(floatBitsToUint(back)));
                }
            }
            if (exists) {
                hull_h[depth] = h;
                hull_step[depth] = float(step - 1);
                hull_rest[depth] = u;
                depth++;
            }
        }
    }
}
