// Computes: one level of the maximum hierarchy with which rays skip blocks: the highest point of the cells in each
// block of 4^level by 4^level. Minima are not needed: rays start on the surface and stay above it until they hit.
// Reads: cells (level 1), maxima (level - 1).
// Writes: maxima (see level_top in rays/trace.glsl).
// One invocation is one block.
#version 460

#extension GL_EXT_samplerless_texture_functions : require

#include "rays/bounds.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform texture2D cells;
layout(binding = 1, r32f) uniform image2D maxima;

layout(push_constant) uniform HeightBoundsPush {
    int cells_x;
    int cells_y;
    int padded_rows;
    int level;
};

void main() {
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    // Existing parts: cells, or blocks of the level below.
    int below = LEVEL_BITS * (level - 1);
    ivec2 parts = (ivec2(cells_x, cells_y) + (1 << below) - 1) >> below;
    ivec2 blocks = (parts + (1 << LEVEL_BITS) - 1) >> LEVEL_BITS;
    if (block.x >= blocks.x || block.y >= blocks.y) {
        return;
    }
    float highest = -1e30;
    for (int i = 0; i < 1 << (2 * LEVEL_BITS); i++) {
        ivec2 part = (block << LEVEL_BITS) + ivec2(i & ((1 << LEVEL_BITS) - 1), i >> LEVEL_BITS);
        part = min(part, parts - 1);
        vec4 corners = texelFetch(cells, part, 0);
        float of_cell = max(max(corners.x, corners.y), max(corners.z, corners.w));
        float of_block = imageLoad(maxima, part + ivec2(0, level_top(max(level - 1, 1), padded_rows))).x;
        highest = max(highest, level == 1 ? of_cell : of_block);
    }
    imageStore(maxima, block + ivec2(0, level_top(level, padded_rows)), vec4(highest));
}
