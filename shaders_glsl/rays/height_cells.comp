// Computes: height and slope of each grid point; if WRITES_CELLS, also the corners of each cell in one texel, as rays read them.
// Optionally initialises the sums of path_trace.
// Reads: heights.
// Writes: cells (north-west, north-east, south-west, south-east, above the base), ground (height, slope towards east,
// slope towards north), batch_mean (0 batches), lost_rays (0).
// One invocation is one grid point and the cell to its south-east.
#version 460

#include "shared/conventions.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
// Of a path tracer.
layout(constant_id = 1) const bool BEGINS_PATHS = false;
// False if no pass traces rays.
layout(constant_id = 2) const bool WRITES_CELLS = true;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1, rgba32f) uniform writeonly image2D cells;
layout(binding = 2, rgba32f) uniform writeonly image2D ground;
layout(binding = 3, rgba32f) uniform writeonly image2D batch_mean;
layout(binding = 4) writeonly buffer LostRays { uint lost_rays[]; };

layout(push_constant) uniform HeightCellsPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
};

// A neighbour along an axis of n grid points: wrapped where the field repeats, else clamped.
int neighbour(int i, int n) {
    int wrapped = i < 0 ? i + n : (i >= n ? i - n : i);
    return PERIODIC ? wrapped : clamp(i, 0, n - 1);
}

void main() {
    int c = int(gl_GlobalInvocationID.x);
    int r = int(gl_GlobalInvocationID.y);
    if (c >= cols || r >= rows) {
        return;
    }
    ivec3 x = ivec3(neighbour(c - 1, cols), c, neighbour(c + 1, cols));
    ivec3 y = ivec3(neighbour(r - 1, rows), r, neighbour(r + 1, rows));
    float nw = texelFetch(heights, ivec2(x.x, y.x), 0).x;
    float n = texelFetch(heights, ivec2(x.y, y.x), 0).x;
    float ne = texelFetch(heights, ivec2(x.z, y.x), 0).x;
    float w = texelFetch(heights, ivec2(x.x, y.y), 0).x;
    float own = texelFetch(heights, ivec2(x.y, y.y), 0).x;
    float e = texelFetch(heights, ivec2(x.z, y.y), 0).x;
    float sw = texelFetch(heights, ivec2(x.x, y.z), 0).x;
    float s = texelFetch(heights, ivec2(x.y, y.z), 0).x;
    float se = texelFetch(heights, ivec2(x.z, y.z), 0).x;
    if (WRITES_CELLS) {
        imageStore(cells, ivec2(c, r), vec4(own, e, s, se));
    }
    // The mean gradient of the adjoining quads: the direction of the sum of their unnormalised normals. Across an
    // axis one grid point wide the slope is 0, and the single line of grid points stands for the quads.
    bool wraps_x = PERIODIC && cols > 1;
    bool wraps_y = PERIODIC && rows > 1;
    float west = wraps_x || c > 0 ? 1.0 : 0.0;
    float east = wraps_x || c < cols - 1 ? 1.0 : 0.0;
    float north = wraps_y || r > 0 ? 1.0 : 0.0;
    float south = wraps_y || r < rows - 1 ? 1.0 : 0.0;
    float both_x = west + east;
    float both_y = north + south;
    vec3 row_weight = both_y > 0.0 ? vec3(north, both_y, south) / (2.0 * both_y) : vec3(0.0, 1.0, 0.0);
    vec3 col_weight = both_x > 0.0 ? vec3(west, both_x, east) / (2.0 * both_x) : vec3(0.0, 1.0, 0.0);
    float rise_x = dot(row_weight, vec3(ne - nw, e - w, se - sw));
    float rise_y = dot(col_weight, vec3(nw - sw, n - s, ne - se));
    float slope_east = both_x > 0.0 ? rise_x / (both_x * cell_x_m) : 0.0;
    float slope_north = both_y > 0.0 ? rise_y / (both_y * cell_y_m) : 0.0;
    imageStore(ground, ivec2(c, r), vec4(own, slope_east, slope_north, 0.0));
    if (BEGINS_PATHS) {
        // The sums of a list of grid points are no larger than the field.
        if (all(lessThan(ivec2(c, r), imageSize(batch_mean)))) {
            imageStore(batch_mean, ivec2(c, r), vec4(0.0));
        }
        if (c == 0 && r == 0) {
            lost_rays[0] = 0u;
        }
    }
}
