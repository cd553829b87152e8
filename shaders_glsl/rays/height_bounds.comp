// Computes: one level of the maximum hierarchy with which rays skip blocks: the highest point of the cells in each
// block of 4^level by 4^level. Minima are not needed: rays start on the surface and stay above it until they hit.
// Reads: cells or heights (level 1), maxima (level - 1).
// Writes: maxima (see level_top in rays/trace.glsl).
// One invocation is one block.
#version 460

#extension GL_EXT_samplerless_texture_functions : require

#include "rays/bounds.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// What a block is made of: the heights, the cells, or the blocks of the level below.
const uint FROM_HEIGHTS = 0u;
const uint FROM_CELLS = 1u;
const uint FROM_BLOCKS = 2u;
layout(constant_id = 0) const uint SOURCE = 0u;

layout(binding = 0, rgba32f) uniform readonly image2D cells;
layout(binding = 1, r32f) uniform image2D maxima;
layout(binding = 2) uniform texture2D heights;

layout(push_constant) uniform HeightBoundsPush {
    int cells_x;
    int cells_y;
    int padded_rows;
    int level;
    vec2 tilt;  // from heights: added for each column and row, as a plane
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
    if (SOURCE == FROM_HEIGHTS) {
        // The corners of its cells; of a field that repeats, those beyond the edge are the first ones again.
        ivec2 size = textureSize(heights, 0);
        for (int i = 0; i < 25; i++) {
            ivec2 corner = min((block << LEVEL_BITS) + ivec2(i % 5, i / 5), parts);
            corner = ivec2(corner.x == size.x ? 0 : corner.x, corner.y == size.y ? 0 : corner.y);
            vec2 on_plane = tilt * vec2(min((block << LEVEL_BITS) + ivec2(i % 5, i / 5), parts));
            highest = max(highest, texelFetch(heights, corner, 0).x + on_plane.x + on_plane.y);
        }
        imageStore(maxima, block + ivec2(0, level_top(level, padded_rows)), vec4(highest));
        return;
    }
    for (int i = 0; i < 1 << (2 * LEVEL_BITS); i++) {
        ivec2 part = (block << LEVEL_BITS) + ivec2(i & ((1 << LEVEL_BITS) - 1), i >> LEVEL_BITS);
        part = min(part, parts - 1);
        if (SOURCE == FROM_CELLS) {
            vec4 corners = imageLoad(cells, part);
            highest = max(highest, max(max(corners.x, corners.y), max(corners.z, corners.w)));
        } else {
            highest = max(highest, imageLoad(maxima, part + ivec2(0, level_top(level - 1, padded_rows))).x);
        }
    }
    imageStore(maxima, block + ivec2(0, level_top(level, padded_rows)), vec4(highest));
}
