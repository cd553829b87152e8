// Computes: the picture position of a grid point of the surface.
// Reads: heights.
// Writes: the vertex's position on the field, in grid points from its tile's first.
// One invocation is one vertex of a tile of 16 × 16 cells of the mesh; an instance is a tile.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(binding = 0) uniform texture2D heights;

#include "view/ground.glsl"

// Vertices per side of a tile.
const int SIDE = 17;

layout(location = 0) centroid out vec2 offset;
layout(location = 1) flat out ivec2 first;
invariant gl_Position;

void main() {
    ivec2 tile = ivec2(gl_InstanceIndex % tiles_across, gl_InstanceIndex / tiles_across);
    ivec2 corner = ivec2(gl_VertexIndex % SIDE, gl_VertexIndex / SIDE);
    first = tile * (SIDE - 1) * mesh_step;
    // The last row and column are vertices at any step; cells beyond them have no area.
    ivec2 place = min(first + corner * mesh_step, ivec2(cols, rows) - 1);
    offset = vec2(place - first);
    gl_Position = picture_place(place, texelFetch(heights, place, 0).x);
}
