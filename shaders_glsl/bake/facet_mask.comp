// Computes: visibility of each flat triangle of the field from its centroid, along a set of directions.
// Reads: cells, maxima, directions (east, north, up).
// Writes: facet_mask (see bake/facets.glsl).
// One invocation is one cell and fifteen directions.
#version 460

#include "shared/conventions.glsl"
#include "bake/facets.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// As in path_trace.
layout(constant_id = 1) const int MOST_STEPS = 60000;
// A field one grid point wide that does not repeat has no triangles.
const bool THIN_ROWS = false;
const bool THIN_COLS = false;

layout(binding = 0, rgba32f) uniform readonly image2D cells;
layout(binding = 1, r32f) uniform readonly image2D maxima;
layout(binding = 2) uniform textureBuffer directions;
layout(binding = 3, r32ui) uniform writeonly uimage2DArray facet_mask;

#include "rays/land.glsl"

layout(push_constant) uniform FacetMaskPush {
    LandPush land;
    float highest_m;
    int first_layer;
    int first_direction;  // texel in directions
    int end_direction;    // one past the last
};

#include "rays/trace.glsl"

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int layer = first_layer + int(gl_WorkGroupID.z);
    bool alive = at.x < land.cells_x && at.y < land.cells_y;
    ivec2 here = min(at, ivec2(land.cells_x, land.cells_y) - 1);
    vec4 corners = imageLoad(cells, here);
    uint word = 0u;
    for (int bit = 0; bit < 2 * FACET_DIRECTIONS; bit++) {
        int i = first_direction + FACET_DIRECTIONS * layer + (bit >> 1);
        bool counts = alive && i < end_direction;
        vec3 e = texelFetch(directions, min(i, end_direction - 1)).xyz;
        bool is_south = (bit & 1) == 1;
        vec2 middle = is_south ? vec2(1.0, 2.0) / 3.0 : vec2(2.0, 1.0) / 3.0;
        float third = is_south ? corners.z : corners.y;
        float own = third + ((corners.x - third) + (corners.w - third)) / 3.0;
        Met met = trace(ray_from(here, middle, own, e, vec2(land.cell_x_m, land.cell_y_m)), 1e30, counts);
        word |= counts && met.what == RAY_FREE ? 1u << bit : 0u;
        word |= counts && met.what == RAY_LOST ? FACET_LOST : 0u;
    }
    if (alive) {
        imageStore(facet_mask, ivec3(at, layer), uvec4(word));
    }
}
