// Computes: horizons by testing every crossing of a grid point's own line with grid lines and diagonals: the baseline
// of every speed-up, and the ground truth on the device. Cost grows with the side of the field.
// Reads: lane_heights, azimuths.
// Writes: slopes (f32 bits) at [layer][step][lane] and, if requested, the march steps to the horizon (f32 bits) in
// the next layer; nodes at their own texels.
// One invocation is one grid point, or node, in one azimuth.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
layout(constant_id = 1) const bool WRITES_DISTANCES = false;
// Grid points from node to node.
layout(constant_id = 2) const int NODE_STRIDE = 1;

#define LANE_WINDOWS
// The image bound as lane_heights is lane_windows.
layout(constant_id = 3) const bool READS_LANE_WINDOWS = false;

layout(binding = 0, rgba32f) uniform restrict readonly image2D lane_heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2, r32ui) uniform writeonly uimage2DArray slopes;

#include "shared/conventions.glsl"

const bool MARCHES_ROWS = false;
const int LANE_STRIDE = 1;
const uint BORDER = PERIODIC ? BORDER_PERIODIC : BORDER_PLANE;

#include "horizon/crossings.glsl"
#include "horizon/march.glsl"
#include "shared/nodes.glsl"

void main() {
    azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    ivec2 node = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first);
    bool exists = node.x < node_count(lanes, NODE_STRIDE) && node.y < node_count(steps, NODE_STRIDE);
    int lane_at = node_place(node.x, lanes, NODE_STRIDE);
    int step_at = node_place(node.y, steps, NODE_STRIDE);
    int lane = lane_position(azimuth, lane_at, lanes);
    int step = march_position(azimuth, step_at, steps);
    float own = height_at(min(lane_at, lanes - 1), min(step_at, steps - 1));
    // Whole steps until the march has left the field.
    int reach = step + warm_up;
    int across = (lane * CELL + azimuth.shear - 1) / max(azimuth.shear, 1);
    bool leaves = !PERIODIC && azimuth.shear > 0;
    reach = leaves ? min(reach, across) : reach;
    vec2 best = vec2(NO_SLOPE, 0.0);
    look_around(azimuth, lane, step, own, ivec2(1, exists ? reach : 0), lanes, steps, best);
    if (!exists) {
        return;
    }
    ivec2 texel = ivec2(lane, step);
    texel = NODE_STRIDE > 1 ? node : texel;
    int layer = int(azimuth.layer);
    imageStore(slopes, ivec3(texel, layer), uvec4(floatBitsToUint(best.x)));
    if (WRITES_DISTANCES) {
        imageStore(slopes, ivec3(texel, layer + 1), uvec4(floatBitsToUint(best.y)));
    }
}
