// Computes: the levels of an octave of the pyramid of exit radiance, each from the level an octave finer (from the grid
// points themselves for the first octave). As height_reduce, but clamped to the range of its source, so that light stays
// at or above 0.
// Reads: exit_radiance, shade_levels, constants.
// Writes: shade_levels (R, G, B), shade_table (one texel a level).
// One invocation is one texel of one level.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
layout(constant_id = 1) const bool FROM_FIELD = false;
// One channel of radiance.
layout(constant_id = 2) const bool GREY = false;

layout(binding = 0) uniform texture2D exit_radiance;
layout(binding = 1, rgba32f) uniform image2D shade_levels;
layout(binding = 2, rgba32ui) uniform writeonly uimage2D shade_table;
layout(binding = 3) uniform textureBuffer constants;

const bool HOLDS_ENDS = true;
#define TEXEL vec4
#include "shared/reduce.glsl"

vec4 source_at(int x, int y) {
    if (FROM_FIELD) {
        vec4 texel = texelFetch(exit_radiance, ivec2(x, y), 0);
        return GREY ? texel.xxxx : texel;
    }
    return imageLoad(shade_levels, level_texel(source_first + y * source_cols + x, width_shift));
}

void main() {
    ivec2 at;
    if (!has_texel(at)) {
        return;
    }
    vec4 mean = reduced(at);
    imageStore(shade_levels, level_texel(first + at.y * cols + at.x, width_shift), mean);
    if (at == ivec2(0)) {
        Level made = Level(first, cols, rows, per_grid_point);
        imageStore(shade_table, ivec2(number - 1, 0), words_of(made));
    }
}
