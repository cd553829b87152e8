#include "shared/sweep.glsl"

// The levels of a height pyramid: B-spline coefficients on grids whose first and last texels coincide with the
// field's first and last grid points (on a repeating field the texels divide a period). Level 0 is the field itself;
// the others are stored one after the other, row after row, in one image whose width is a power of two. The including
// shader declares the constant PERIODIC.

struct Level {
    int first;  // texel index
    int cols;
    int rows;
    vec2 per_grid_point;  // texels per grid point
};

// As height_reduce writes it in the table of levels.
Level level_of(uvec4 words) {
    return Level(int(words.x), int(words.y & 0xffffu), int(words.y >> 16), uintBitsToFloat(words.zw));
}

uvec4 words_of(Level level) {
    return uvec4(uint(level.first), uint(level.cols) | uint(level.rows) << 16, floatBitsToUint(level.per_grid_point));
}

ivec2 level_texel(int i, int width_shift) {
    return ivec2(i & ((1 << width_shift) - 1), i >> width_shift);
}

// Four neighbouring texels of an axis and their weights.
struct Taps {
    ivec4 at;
    vec4 weight;
};

// The uniform cubic B-spline at a position (in texels) of an axis of `count`. At the ends of a field that does not
// repeat, coefficients continue by point reflection, so that the spline meets the end texel and a plane stays a
// plane: the weights of texels beyond are folded into existing ones.
Taps spline_taps(float place, int count) {
    int cell = int(floor(place));
    int held = clamp(cell, 0, max(count - 2, 0));
    cell = PERIODIC ? cell : held;
    float t = place - float(cell);
    float s = 1.0 - t;
    vec4 weight = vec4(s * s * s, (3.0 * t - 6.0) * t * t + 4.0, (3.0 * s - 6.0) * s * s + 4.0, t * t * t) * (1.0 / 6.0);
    if (PERIODIC) {
        int before = wrapped(cell - 1, count);
        ivec4 at = before + ivec4(0, 1, 2, 3);
        // A level may have fewer texels than the spline's support.
        at = ivec4(at.x, at.y % count, at.z % count, at.w % count);
        return Taps(at, weight);
    }
    float low = cell == 0 ? weight.x : 0.0;
    float high = cell == count - 2 ? weight.w : 0.0;
    weight += vec4(-low, 2.0 * low - high, 2.0 * high - low, -high);
    return Taps(clamp(cell + ivec4(-1, 0, 1, 2), ivec4(0), ivec4(count - 1)), weight);
}
