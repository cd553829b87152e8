// Computes: every level of the height pyramid at the field's own grid points, by its B-spline (Nowrouzezahrai &
// Snyder 2009, section 9: the stack of synthesised levels).
// Reads: height_levels, level_table.
// Writes: height_stack at [level - 1][row][column].
// One invocation is one grid point in one level.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;

layout(binding = 0) uniform texture2D height_levels;
layout(binding = 1) uniform utexture2D level_table;
layout(binding = 2, r32f) uniform writeonly image2DArray height_stack;

#include "shared/spline.glsl"

layout(push_constant) uniform HeightExpandPush {
    int cols;
    int rows;
    int width_shift;
};

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    Level level = level_of(texelFetch(level_table, ivec2(at.z, 0), 0));
    precise vec2 place = vec2(at.xy) * level.per_grid_point;
    imageStore(height_stack, at, vec4(spline_at(level, place, width_shift)));
}
