#include "shared/half.glsl"

// Heights along the lines of a sweep. The including shader declares `heights`, `lanes`, `steps`,
// `height_scale` and the constants PERIODIC and HULL_PACKED, and sets `azimuth`.

// Height for "no surface": lower than everything, and above every vertex below it on the hull, so that it never
// occludes and is never popped by a height.
const float OUTSIDE = -1e28;
const float UNDER_OUTSIDE = -1e34;

Azimuth azimuth;

float height_at(int lane, int march) {
    int column = lane_position(azimuth, lane, lanes);
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    return texelFetch(heights, by_row ? ivec2(column, march) : ivec2(march, column), 0).x;
}

// Height of the surface where a line at lane position y crosses a march step.
float line_height(int y, int step) {
    if (!PERIODIC && !on_field(y, lanes)) {
        return OUTSIDE;
    }
    int march = march_position(azimuth, PERIODIC ? step % steps : step, steps);
    int cell = PERIODIC ? wrapped(y >> CELL_SHIFT, lanes) : y >> CELL_SHIFT;
    int next = PERIODIC ? wrapped(cell + 1, lanes) : min(cell + 1, lanes - 1);
    float t = float(y & (CELL - 1)) * (1.0 / float(CELL));
    float h = height_at(cell, march);
    precise float rise = t * (height_at(next, march) - h);
    precise float sum = h + rise;
    return sum;
}

// A height after packing.
float kept_height(float h) {
    return HULL_PACKED && h > OUTSIDE ? nearest_f16(h * height_scale) / height_scale : h;
}
