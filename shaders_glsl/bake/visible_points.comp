// Computes: for each grid point and direction, the grid point nearest to where the ray hits the surface.
// Reads: cells, maxima, ground, directions (east, north, up).
// Writes: visible_points (see bake/points.glsl).
// One invocation is one grid point and one layer: one direction, or two of a small field.
#version 460

#include "shared/conventions.glsl"
#include "bake/points.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// A field one grid point wide that does not repeat is a line: only rays along it hit it.
layout(constant_id = 1) const bool THIN_ROWS = false;
layout(constant_id = 2) const bool THIN_COLS = false;
// As in path_trace.
layout(constant_id = 3) const int MOST_STEPS = 60000;
// Two directions per word.
layout(constant_id = 4) const bool SMALL = false;

layout(binding = 0, rgba32f) uniform readonly image2D cells;
layout(binding = 1, r32f) uniform readonly image2D maxima;
layout(binding = 2) uniform texture2D ground;
layout(binding = 3) uniform textureBuffer directions;
layout(binding = 4, r32ui) uniform writeonly uimage2DArray visible_points;

#include "rays/land.glsl"

layout(push_constant) uniform VisiblePointsPush {
    LandPush land;
    float highest_m;
    int first_layer;      // of the image
    int first_direction;  // first direction of the image: texel in directions
    int end_direction;    // one past the last
};

#include "rays/trace.glsl"

uint visible_along(int i, ivec2 here, float own, bool alive) {
    vec3 e = texelFetch(directions, min(i, end_direction - 1)).xyz;
    Met met = trace(ray_from(here, vec2(0.0), own, e, vec2(land.cell_x_m, land.cell_y_m)), 1e30, alive && i < end_direction);
    ivec2 size = ivec2(land.cols, land.rows);
    ivec2 near = met.cell + ivec2(floor(met.offset + 0.5));
    near = BORDER == BORDER_PERIODIC ? near - ivec2(near.x >= land.cols ? land.cols : 0, near.y >= land.rows ? land.rows : 0)
                                     : min(near, size - 1);
    uint point = met.what == RAY_HIT ? uint(near.y << 16 | near.x) : POINT_SKY;
    point = met.what == RAY_GROUND ? POINT_GROUND : point;
    return met.what == RAY_LOST ? POINT_LOST : point;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int layer = first_layer + int(gl_WorkGroupID.z);
    bool alive = at.x < land.cols && at.y < land.rows;
    ivec2 here = min(at, ivec2(land.cols, land.rows) - 1);
    float own = texelFetch(ground, here, 0).x;
    uint word = 0u;
    for (int k = 0; k < (SMALL ? 2 : 1); k++) {
        int i = SMALL ? 2 * layer + k : layer;
        word |= word_of(visible_along(first_direction + i, here, own, alive), i, SMALL);
    }
    if (alive) {
        imageStore(visible_points, ivec3(at, layer), uvec4(word));
    }
}
