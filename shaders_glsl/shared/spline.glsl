#include "shared/levels.glsl"

// Height of a level at a position in its texels, by its cubic B-spline. The including shader declares
// `height_levels`.
float spline_at(Level level, vec2 place, int width_shift) {
    Taps x = spline_taps(place.x, level.cols);
    Taps y = spline_taps(place.y, level.rows);
    float sum = 0.0;
    for (int r = 0; r < 4; r++) {
        int row = level.first + y.at[r] * level.cols;
        vec4 four = vec4(texelFetch(height_levels, level_texel(row + x.at.x, width_shift), 0).x,
                         texelFetch(height_levels, level_texel(row + x.at.y, width_shift), 0).x,
                         texelFetch(height_levels, level_texel(row + x.at.z, width_shift), 0).x,
                         texelFetch(height_levels, level_texel(row + x.at.w, width_shift), 0).x);
        sum += y.weight[r] * dot(x.weight, four);
    }
    return sum;
}
