// Computes: picture position and radiance of a vertex of the plinth: walls from the field's edges down to a level base.
// Reads: heights, radiance, voids.
// Writes: the vertex's radiance, and its grid points along the wall.
// One invocation is one vertex of a quadrilateral of two triangles; an instance is a face.
//
// Its light is not computed. A face has a fixed share of the ground's mean luminance, so that it keeps its place in the
// exposure under any light.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(constant_id = 0) const bool IS_GREY = false;
layout(constant_id = 1) const bool HAS_VOIDS = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform texture2D radiance;
// 0 where there is ground.
layout(binding = 2) uniform texture2D voids;

#define PLINTH
#include "view/ground.glsl"

// The mean is of POINTS x POINTS texels.
const int POINTS = 8;
const int BASE = 4;

layout(location = 0) flat out float light;
layout(location = 1) flat out int face;
layout(location = 2) centroid out float along;
invariant gl_Position;

float mean_luminance() {
    float sum = 0.0;
    float ground = 0.0;
    for (int i = 0; i < POINTS * POINTS; i++) {
        ivec2 texel = (2 * ivec2(i % POINTS, i / POINTS) + 1) * ivec2(cols, rows) / (2 * POINTS);
        if (HAS_VOIDS) {
            if (texelFetch(voids, texel, 0).x > 0.0) {
                continue;
            }
        }
        vec3 colour = texelFetch(radiance, texel, 0).rgb;
        sum += IS_GREY ? colour.r : dot(colour, vec3(0.2126, 0.7152, 0.0722));
        ground += 1.0;
    }
    return sum / max(ground, 1.0);
}

void main() {
    face = gl_InstanceIndex;
    float tone = face == BASE ? base_tone : wall_tones[min(face, BASE - 1)];
    ivec2 last = ivec2(cols, rows) - 1;
    // Corners of the two triangles, from 0 to 1 along the face and across it.
    ivec2 corner = ivec2(0x16, 0x34) >> (gl_VertexIndex % 6) & 1;
    int cell = gl_VertexIndex / 6;
    bool is_row = face % 2 == 0;
    int count = is_row ? last.x : last.y;
    // The last grid point is a vertex at any step; cells beyond it have no area.
    int at = min((cell + corner.x) * mesh_step, count);
    ivec2 place = is_row ? ivec2(at, face == 0 ? 0 : last.y) : ivec2(face == 1 ? last.x : 0, at);
    bool is_drawn = tone >= 0.0;
    if (face == BASE) {
        place = corner * last;
        is_drawn = is_drawn && cell == 0;
    }
    float top_m = texelFetch(heights, place, 0).x;
    // Heights that change on the device may lie below the base.
    float low_m = min(base_m, top_m);
    along = float(at);
    light = 0.0;
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    if (is_drawn) {
        light = tone * mean_luminance();
        gl_Position = picture_place(place, face == BASE ? base_m : corner.y == 0 ? top_m : low_m);
        // An orthographic depth range may end before the base.
        gl_Position.z = max(gl_Position.z, 0.0);
    }
}
