// Computes: one level of the height pyramid from the level an octave finer (from the field itself for
// the first octave), each texel the mean of four bilinear samples around its place (Nowrouzezahrai &
// Snyder 2009, section 9: repeated bilinear decimation).
// Reads: heights, height_levels. Writes: height_levels, level_table (one texel for this level).
// One invocation is one texel of the level.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
layout(constant_id = 1) const bool FROM_FIELD = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1, r32f) uniform image2D height_levels;
layout(binding = 2, rgba32ui) uniform writeonly uimage2D level_table;

#include "shared/levels.glsl"

layout(push_constant) uniform HeightReducePush {
    int cols;
    int rows;
    int first;
    int source_cols;
    int source_rows;
    int source_first;
    float ratio_x;  // texels of the source a texel
    float ratio_y;
    float per_sample_x;
    float per_sample_y;
    int level;
    int width_shift;
};

float source_at(int x, int y) {
    if (FROM_FIELD) {
        return texelFetch(heights, ivec2(x, y), 0).x;
    }
    return imageLoad(height_levels, level_texel(source_first + y * source_cols + x, width_shift)).x;
}

// Two neighbouring texels of an axis, and how far between them. Beyond the ends the last two go on
// straight.
struct Between {
    int low;
    int high;
    float t;
};

Between between(float place, int count) {
    int cell = int(floor(place));
    int held = clamp(cell, 0, max(count - 2, 0));
    int before = wrapped(cell, count);
    int after = wrapped(cell + 1, count);
    int next = min(held + 1, count - 1);
    cell = PERIODIC ? cell : held;
    return Between(PERIODIC ? before : held, PERIODIC ? after : next, place - float(cell));
}

float row_at(Between x, int y) {
    float low = source_at(x.low, y);
    return low + x.t * (source_at(x.high, y) - low);
}

float bilinear(Between x, Between y) {
    float low = row_at(x, y.low);
    return low + y.t * (row_at(x, y.high) - low);
}

void main() {
    int x = int(gl_GlobalInvocationID.x);
    int y = int(gl_GlobalInvocationID.y);
    if (x >= cols || y >= rows) {
        return;
    }
    // At ratio 1 all four are the texel itself, at 2 they weigh 1, 2, 1.
    float beside_x = 0.5 * (ratio_x - 1.0);
    float beside_y = 0.5 * (ratio_y - 1.0);
    precise float place_x = float(x) * ratio_x;
    precise float place_y = float(y) * ratio_y;
    Between west = between(place_x - beside_x, source_cols);
    Between east = between(place_x + beside_x, source_cols);
    Between north = between(place_y - beside_y, source_rows);
    Between south = between(place_y + beside_y, source_rows);
    float sum = (bilinear(west, north) + bilinear(east, north)) + (bilinear(west, south) + bilinear(east, south));
    imageStore(height_levels, level_texel(first + y * cols + x, width_shift), vec4(0.25 * sum));
    if (x == 0 && y == 0) {
        Level made = Level(first, cols, rows, vec2(per_sample_x, per_sample_y));
        imageStore(level_table, ivec2(level - 1, 0), words_of(made));
    }
}
