#include "shared/conventions.glsl"

// Index of a neighbour along one axis: wrapped where the field repeats, else held at the edge.
int neighbour(int i, int n, uint border) {
    return border == BORDER_PERIODIC ? (i + n) % n : clamp(i, 0, n - 1);
}

// Slope of the surface at a sample towards east and north: the mean over the adjoining quads that
// exist, which is the direction of the sum of their unnormalised normals. Where a field is one
// sample wide there is no quad across it: the slope across is 0.
vec2 field_slope(texture2D heights, ivec2 at, ivec2 size, vec2 cell_m, uint border) {
    bool wraps = border == BORDER_PERIODIC;
    ivec2 low = ivec2(neighbour(at.x - 1, size.x, border), neighbour(at.y - 1, size.y, border));
    ivec2 high = ivec2(neighbour(at.x + 1, size.x, border), neighbour(at.y + 1, size.y, border));
    // How many quads lie to each side: 0 or 1.
    vec2 before = vec2(wraps || at.x > 0, wraps || at.y > 0) * vec2(greaterThan(size, ivec2(1)));
    vec2 after = vec2(wraps || at.x < size.x - 1, wraps || at.y < size.y - 1) * vec2(greaterThan(size, ivec2(1)));
    vec2 both = before + after;
    // Across an axis without quads the one line of samples stands for them.
    vec3 row_weight = both.y > 0.0 ? vec3(before.y, both.y, after.y) / (2.0 * both.y) : vec3(0.0, 1.0, 0.0);
    vec3 col_weight = both.x > 0.0 ? vec3(before.x, both.x, after.x) / (2.0 * both.x) : vec3(0.0, 1.0, 0.0);
    float nw = texelFetch(heights, low, 0).x;
    float n = texelFetch(heights, ivec2(at.x, low.y), 0).x;
    float ne = texelFetch(heights, ivec2(high.x, low.y), 0).x;
    float w = texelFetch(heights, ivec2(low.x, at.y), 0).x;
    float e = texelFetch(heights, ivec2(high.x, at.y), 0).x;
    float sw = texelFetch(heights, ivec2(low.x, high.y), 0).x;
    float s = texelFetch(heights, ivec2(at.x, high.y), 0).x;
    float se = texelFetch(heights, high, 0).x;
    float rise_x = dot(row_weight, vec3(ne - nw, e - w, se - sw));
    float rise_y = dot(col_weight, vec3(nw - sw, n - s, ne - se));
    vec2 run = max(both, vec2(1.0)) * cell_m;
    return vec2(both.x > 0.0 ? rise_x / run.x : 0.0, both.y > 0.0 ? rise_y / run.y : 0.0);
}
