// Computes: every level of the pyramid of exit radiance at the field's own grid points, by its B-spline, as
// height_expand does for heights.
// Reads: shade_levels, shade_table.
// Writes: shade_stack at [level - 1][row][column].
// One invocation is one grid point in one level.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
// One channel of radiance.
layout(constant_id = 1) const bool GREY = false;

layout(binding = 0) uniform texture2D shade_levels;
layout(binding = 1) uniform utexture2D shade_table;
// GREY selects one of these.
layout(binding = 2, rgba32f) uniform writeonly image2DArray shade_stack;
layout(binding = 3, r32f) uniform writeonly image2DArray shade_stack_grey;

#include "bounce/shade.glsl"

layout(push_constant) uniform ShadeExpandPush {
    int cols;
    int rows;
    int width_shift;
};

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    Level level = level_of(texelFetch(shade_table, ivec2(at.z, 0), 0));
    precise vec2 place = vec2(at.xy) * level.per_grid_point;
    vec4 light = vec4(shade_at(level, place, width_shift), 1.0);
    if (GREY) {
        imageStore(shade_stack_grey, at, light);
    } else {
        imageStore(shade_stack, at, light);
    }
}
