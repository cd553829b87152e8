// Computes: the exit radiance of a point of the surface, bilinear between the grid points of its cell.
// Reads: radiance, voids.
// Writes: picture.
// One invocation is one pixel of one triangle; triangles with a void corner are holes.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(constant_id = 0) const bool IS_GREY = false;
layout(constant_id = 1) const bool HAS_VOIDS = false;

layout(binding = 1) uniform texture2D radiance;
// 0 where there is ground.
layout(binding = 2) uniform texture2D voids;

#include "view/ground.glsl"

layout(location = 0) centroid in vec2 offset;
layout(location = 1) flat in ivec2 first;
layout(location = 0) out vec4 picture;

void main() {
    ivec2 last = ivec2(cols, rows) - 2;
    ivec2 cell = clamp(first + ivec2(floor(offset)), ivec2(0), last);
    vec2 share = clamp(offset - vec2(cell - first), 0.0, 1.0);
    ivec2 se = cell + 1;
    if (HAS_VOIDS) {
        bool lower = share.y > share.x;
        ivec2 third = mix(ivec2(se.x, cell.y), ivec2(cell.x, se.y), bvec2(lower));
        float any_void = texelFetch(voids, cell, 0).x + texelFetch(voids, se, 0).x + texelFetch(voids, third, 0).x;
        if (any_void > 0.0) {
            discard;
        }
    }
    vec3 north = mix(texelFetch(radiance, cell, 0).rgb, texelFetch(radiance, ivec2(se.x, cell.y), 0).rgb, share.x);
    vec3 south = mix(texelFetch(radiance, ivec2(cell.x, se.y), 0).rgb, texelFetch(radiance, se, 0).rgb, share.x);
    vec3 colour = mix(north, south, share.y);
    if (IS_GREY) {
        colour = colour.rrr;
    }
    picture = vec4(colour, 1.0);
}
