// Computes: the levels of an octave of the pyramid of exit radiance as SH series, each from the level an octave finer
// (from the grid points' own for the first octave), as shade_reduce.
// Reads: exit_vectors, vector_source, constants.
// Writes: vector_levels (the same image), shade_table (one texel a level).
// One invocation is one texel of one layer of one level.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
layout(constant_id = 1) const bool FROM_FIELD = false;
layout(constant_id = 2) const bool HALVES = false;

layout(binding = 0) uniform texture2DArray exit_vectors;
layout(binding = 1) uniform texture2DArray vector_source;
// HALVES selects one of these.
layout(binding = 2, rgba32f) uniform writeonly image2DArray vector_levels;
layout(binding = 5, rgba16f) uniform writeonly image2DArray vector_levels_f16;
layout(binding = 3, rgba32ui) uniform writeonly uimage2D shade_table;
layout(binding = 4) uniform textureBuffer constants;

const bool HOLDS_ENDS = true;
#define TEXEL vec4
#include "shared/reduce.glsl"

int layer;

vec4 source_at(int x, int y) {
    if (FROM_FIELD) {
        return texelFetch(exit_vectors, ivec3(x, y, layer), 0);
    }
    return texelFetch(vector_source, ivec3(level_texel(source_first + y * source_cols + x, width_shift), layer), 0);
}

void main() {
    layer = int(gl_GlobalInvocationID.z);
    ivec2 at;
    if (!has_texel(at)) {
        return;
    }
    vec4 mean = reduced(at);
    ivec3 texel = ivec3(level_texel(first + at.y * cols + at.x, width_shift), layer);
    if (HALVES) {
        imageStore(vector_levels_f16, texel, mean);
    } else {
        imageStore(vector_levels, texel, mean);
    }
    if (at == ivec2(0) && layer == 0) {
        Level made = Level(first, cols, rows, per_grid_point);
        imageStore(shade_table, ivec2(number - 1, 0), words_of(made));
    }
}
