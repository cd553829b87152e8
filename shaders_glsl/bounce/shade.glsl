#include "shared/levels.glsl"

// Radiance of a level at a position in its texels, by its cubic B-spline: weights are positive and sum to 1. The
// including shader declares `shade_levels`.
vec3 shade_at(Level level, vec2 place, int width_shift) {
    Taps x = spline_taps(place.x, level.cols);
    Taps y = spline_taps(place.y, level.rows);
    vec3 sum = vec3(0.0);
    for (int r = 0; r < 4; r++) {
        int row = level.first + y.at[r] * level.cols;
        vec3 along = vec3(0.0);
        for (int c = 0; c < 4; c++) {
            along += x.weight[c] * texelFetch(shade_levels, level_texel(row + x.at[c], width_shift), 0).rgb;
        }
        sum += y.weight[r] * along;
    }
    return sum;
}
