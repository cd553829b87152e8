// Computes: the levels of an octave of the height pyramid, each from the level an octave finer (from the field itself for
// the first octave). Each texel is the mean of four bilinear samples around its position (Nowrouzezahrai & Snyder 2009,
// section 9: repeated bilinear decimation).
// Reads: heights, height_levels, constants.
// Writes: height_levels, level_table (one texel a level).
// One invocation is one texel of one level.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
layout(constant_id = 1) const bool FROM_FIELD = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1, r32f) uniform image2D height_levels;
layout(binding = 2, rgba32ui) uniform writeonly uimage2D level_table;
layout(binding = 3) uniform textureBuffer constants;

const bool HOLDS_ENDS = false;
#define TEXEL float
#include "shared/reduce.glsl"

float source_at(int x, int y) {
    if (FROM_FIELD) {
        return texelFetch(heights, ivec2(x, y), 0).x;
    }
    return imageLoad(height_levels, level_texel(source_first + y * source_cols + x, width_shift)).x;
}

void main() {
    ivec2 at;
    if (!has_texel(at)) {
        return;
    }
    float sum = reduced(at);
    imageStore(height_levels, level_texel(first + at.y * cols + at.x, width_shift), vec4(sum));
    if (at == ivec2(0)) {
        Level made = Level(first, cols, rows, per_grid_point);
        imageStore(level_table, ivec2(number - 1, 0), words_of(made));
    }
}
