// Computes: one more bounce at every node: the radiance of each ring of its visibility cache, filled in the first
// bounce, times the ring's weight.
// Reads: visibility_cache, azimuths, exit_radiance (or exit_grey), node_sum (of the bounce before; A is the divisor, the
// sum for whole hemispheres).
// Writes: bounce_sum (exit radiance for albedo 1).
// One invocation is one node.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// One channel of radiance.
layout(constant_id = 1) const bool GREY = false;
// Grid points from node to node: 4 or 8.
layout(constant_id = 2) const int NODE_STRIDE = 4;
// The same of node_sum: each node here is one of its nodes.
layout(constant_id = 3) const int SUM_STRIDE = 2;

layout(binding = 0, rgba32ui) uniform readonly uimage2DArray visibility_cache;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2, rgba32f) uniform readonly image2D exit_radiance;
layout(binding = 3, r32f) uniform readonly image2D exit_grey;
layout(binding = 4, rgba32f) uniform readonly image2D node_sum;
layout(binding = 5, rgba32f) uniform writeonly image2D bounce_sum;

layout(push_constant) uniform CacheGatherPush {
    int cols;
    int rows;
    uint begin;  // of the azimuths used for bounces
    uint count;
};

#include "shared/sweep.glsl"
#include "shared/nodes.glsl"
#include "bounce/visibility_cache.glsl"

vec3 leaving(ivec2 at) {
    vec3 colour;
    if (GREY) {
        colour = imageLoad(exit_grey, at).xxx;
    } else {
        colour = imageLoad(exit_radiance, at).rgb;
    }
    return colour;
}

// The grid point nearest to a point that many steps away on a grid point's own line.
ivec2 grid_point_at(Azimuth azimuth, ivec2 here, int back) {
    bool by_rows = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    ivec2 swapped_here = here.yx;
    ivec2 own = by_rows ? here : swapped_here;
    ivec2 size = by_rows ? ivec2(cols, rows) : ivec2(rows, cols);
    int lane = (lane_position(azimuth, own.x, size.x) * CELL - back * azimuth.shear + CELL / 2) >> CELL_SHIFT;
    int step = march_position(azimuth, own.y, size.y) - back;
    ivec2 wraps = ivec2(wrapped(lane, size.x), wrapped(step, size.y));
    ivec2 holds = clamp(ivec2(lane, step), ivec2(0), size - 1);
    ivec2 at = BORDER == BORDER_PERIODIC ? wraps : holds;
    ivec2 straight = ivec2(lane_position(azimuth, at.x, size.x), march_position(azimuth, at.y, size.y));
    ivec2 swapped = straight.yx;
    return by_rows ? straight : swapped;
}

void main() {
    ivec2 node = ivec2(gl_GlobalInvocationID.xy);
    if (node.x >= node_count(cols, NODE_STRIDE) || node.y >= node_count(rows, NODE_STRIDE)) {
        return;
    }
    ivec2 here = ivec2(node_place(node.x, cols, NODE_STRIDE), node_place(node.y, rows, NODE_STRIDE));
    vec3 indirect = vec3(0.0);
    for (uint k = 0u; k < count; k++) {
        Azimuth azimuth = azimuth_at(azimuths, begin + k);
        uvec4 kept = imageLoad(visibility_cache, ivec3(node, int(k)));
        ivec4 steps_to = cache_steps(kept);
        vec4 weights = azimuth.wedge_rad * cache_weights(kept);
        for (int ring = 0; ring < 4; ring++) {
            indirect += weights[ring] * leaving(grid_point_at(azimuth, here, steps_to[ring]));
        }
    }
    float whole = imageLoad(node_sum, ivec2(node_of(here.x, SUM_STRIDE), node_of(here.y, SUM_STRIDE))).a;
    imageStore(bounce_sum, node, vec4(indirect / max(whole, 1e-30), whole));
}
