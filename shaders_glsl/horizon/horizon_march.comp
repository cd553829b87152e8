// Computes: horizons by testing every crossing of a grid point's own line: the baseline of every speed-up and, with
// all crossings, the ground truth on the device. Cost grows with the side of the field.
// Reads: heights, azimuths.
// Writes: slopes (f32 bits) at [layer][step][lane] and, if requested, the march steps to the horizon (f32 bits) in
// the next layer; nodes at their own texels.
// One invocation is one grid point, or node, in one azimuth.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

#include "horizon/surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// All crossings with grid lines and diagonals, or only those with grid lines across the march.
layout(constant_id = 0) const bool ALL_CROSSINGS = true;
layout(constant_id = 1) const bool PERIODIC = false;
layout(constant_id = 2) const bool WRITES_DISTANCES = false;
// Grid points from node to node.
layout(constant_id = 3) const int NODE_STRIDE = 1;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2) uniform writeonly uimage2DArray slopes;

#include "horizon/march.glsl"
#include "shared/nodes.glsl"

void main() {
    azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    ivec2 node = ivec2(gl_GlobalInvocationID.xy);
    bool exists = node.x < node_count(lanes, NODE_STRIDE) && node.y < node_count(steps, NODE_STRIDE);
    int lane = lane_position(azimuth, node_place(node.x, lanes, NODE_STRIDE), lanes);
    int step = march_position(azimuth, node_place(node.y, steps, NODE_STRIDE), steps);
    bool split_along = splits_along();
    float advance = float(azimuth.shear) * (1.0 / float(CELL));
    float own = height_at(lane, step);
    float slope = NO_SLOPE;
    float met = 0.0;
    int reach = step + warm_up;
    for (int back = 1; back < steps + warm_up; back++) {
        int y = lane * CELL - back * azimuth.shear;
        // Part of the segment that begins here lies on the field.
        bool on = exists && back <= reach
               && (PERIODIC || azimuth.shear == 0 || y + azimuth.shear > 0);
        // All lanes leave together, as in horizon_sweep.
        if (!subgroupAny(on)) {
            break;
        }
        int cell = y >> CELL_SHIFT;
        float f0 = float(y & (CELL - 1)) * (1.0 / float(CELL));
        int at = step - back;
        float h = height_at(cell, at);
        float rise = (h - own) + (f0 > 0.0 ? f0 * (height_at(cell + 1, at) - h) : 0.0);
        float found = rise / (float(back) * azimuth.step_m);
        bool better = on && (PERIODIC || y >= 0) && found > slope;
        met = better ? float(back) : met;
        slope = better ? found : slope;
        if (ALL_CROSSINGS) {
            vec3 places = segment_crossings(f0, advance, split_along);
            for (int c = 0; c < 3; c++) {
                float u = places[c];
                float f = f0 + u * advance;
                int low = f > 1.0 ? cell + 1 : cell;
                f = f > 1.0 ? f - 1.0 : f;
                rise = surface_rise(height_at(low, at), height_at(low, at + 1), height_at(low + 1, at),
                                    height_at(low + 1, at + 1), own, u, f, split_along);
                float distance_steps = float(back) - u;
                found = rise / (distance_steps * azimuth.step_m);
                better = on && u < 1.0 && (PERIODIC || float(y) + u * float(azimuth.shear) >= -0.5) && found > slope;
                met = better ? distance_steps : met;
                slope = better ? found : slope;
            }
        }
    }
    if (!exists) {
        return;
    }
    ivec2 texel = ivec2(lane, step);
    texel = NODE_STRIDE > 1 ? node : texel;
    int layer = int(azimuth.layer);
    imageStore(slopes, ivec3(texel, layer), uvec4(floatBitsToUint(slope)));
    if (WRITES_DISTANCES) {
        imageStore(slopes, ivec3(texel, layer + 1), uvec4(floatBitsToUint(met)));
    }
}
